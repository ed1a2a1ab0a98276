"""Flags of the channels over time: one lane a channel, a coloured span for each stretch that was flagged."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from html import escape

import numpy as np

from moyai.report.document import Drawing
from moyai.report.sketch import with_colours

#: Colours of the kinds of flags, which the colour-blind can distinguish.
COLOURS = ("#0072b2", "#d55e00", "#009e73", "#b5609a", "#b98500", "#4aa3d8", "#5a5f66", "#b3261e")
_WIDTH, _LANE, _THINNEST = 960.0, 26.0, 2.0
_LETTER = 6.6


@dataclass(frozen=True)
class Span:
    """A flagged stretch of a channel [s]."""

    channel: str
    kind: str
    start: float
    end: float


def flag_lanes(
    channels: Sequence[str], spans: Sequence[Span], begin: float, end: float, words: Callable[[float], str]
) -> Drawing:
    """Draw the flags of a record over time.

    Parameters
    ----------
    channels : sequence of str
        One lane each, flagged or not; others of the spans follow.
    spans : sequence of Span
    begin, end : float
        Of the record [s].
    words : callable
        Writes an instant.
    """
    lanes = list(dict.fromkeys([*channels, *(span.channel for span in spans)]))
    kinds = list(dict.fromkeys(span.kind for span in spans))
    left = 16.0 + _LETTER * max(len(name) for name in lanes)
    wide = _WIDTH - left - 20.0

    def at(instant: float) -> float:
        return left + wide * float(np.clip((instant - begin) / (end - begin), 0.0, 1.0))

    parts = []
    for row, name in enumerate(lanes):
        top = 8.0 + _LANE * row
        parts.append(
            f'<text class="note" x="{left - 8:.1f}" y="{top + 17:.1f}" text-anchor="end">{escape(name)}</text>'
        )
        parts.append(
            f'<rect x="{left:.1f}" y="{top + 3:.1f}" width="{wide:.1f}" height="{_LANE - 6:.1f}" '
            'style="fill:#8a96a3;fill-opacity:.18"/>'
        )
        for span in (span for span in spans if span.channel == name):
            x, last = at(span.start), at(span.end)
            title = f"{name}: {span.kind}, {words(span.start)} to {words(span.end)}"
            parts.append(
                f'<rect x="{min(x, left + wide - _THINNEST):.1f}" y="{top + 3:.1f}" '
                f'width="{max(last - x, _THINNEST):.1f}" height="{_LANE - 6:.1f}" '
                f'style="fill:{COLOURS[kinds.index(span.kind) % len(COLOURS)]}"><title>{escape(title)}</title></rect>'
            )
    foot = 8.0 + _LANE * len(lanes)
    for share, anchor in ((0.0, "start"), (0.5, "middle"), (1.0, "end")):
        instant = begin + share * (end - begin)
        parts.append(
            f'<text class="faint" x="{at(instant):.1f}" y="{foot + 14:.1f}" text-anchor="{anchor}">'
            f"{escape(words(instant))}</text>"
        )
    x, y = left, foot + 38.0
    for number, kind in enumerate(kinds):
        step = 34.0 + _LETTER * len(kind)
        if x + step > _WIDTH and x > left:
            x, y = left, y + 20.0
        parts.append(
            f'<rect x="{x:.1f}" y="{y - 10:.1f}" width="12" height="12" '
            f'style="fill:{COLOURS[number % len(COLOURS)]}"/><text class="note" x="{x + 18:.1f}" y="{y:.1f}">'
            f"{escape(kind)}</text>"
        )
        x += step
    title = "Flags of the channels over time"
    svg = (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {_WIDTH:.0f} {y + 10:.0f}" role="img" '
        f'aria-label="{title}" font-size="12">{"".join(parts)}</svg>'
    )
    caption = "Grey: sound. Stretches too short to be seen are drawn two pixels wide."
    return Drawing("flags", title, svg, with_colours(svg), caption)
