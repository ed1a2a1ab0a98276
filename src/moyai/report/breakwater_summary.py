"""The first page of the report of a floating breakwater: what governs."""

from __future__ import annotations

import math
from typing import Literal

import numpy as np

from moyai.core.results import Result
from moyai.report import breakwater_tables as tables
from moyai.report.breakwater_reading import DOMAIN_WORDS, Level, SeaNumbers, decisive, governing
from moyai.report.document import Block, KeyFigure, KeyFigures, Paragraph
from moyai.report.formatting import DASH, format_number, format_percent, format_quantity
from moyai.report.general_page import notice_blocks

MOST_KEY_FIGURES = 8


def summary_blocks(
    result: Result, levels: tuple[Level, ...], numbers: tuple[SeaNumbers, ...], decides: SeaNumbers | None
) -> tuple[Block, ...]:
    """Return the governing numbers: warnings first, then key figures, then the table by sea state.

    Parameters
    ----------
    result : Result
    levels : tuple of Level
    numbers : tuple of SeaNumbers
        Of every water level, sea state and domain.
    decides : SeaNumbers or None
        The entry with the decisive line tension.

    Returns
    -------
    tuple of Block
    """
    blocks: list[Block] = [*notice_blocks(result)]
    sentence = _governing_sentence(decides)
    if sentence:
        blocks.insert(0, Paragraph(sentence))
    decisive_numbers = decisive(numbers)
    items = [
        *_tension_figures(levels, decides),
        *_offset_figures(decisive_numbers),
        *_transmission_figure(decisive_numbers),
        *_motion_figure(decisive_numbers),
        *_uplift_figure(decisive_numbers),
        *_statics_figures(levels, decisive_numbers),
    ]
    if items:
        blocks.append(KeyFigures(tuple(items[:MOST_KEY_FIGURES])))
    else:
        blocks.append(Paragraph("The result holds no governing numbers."))
    blocks += tables.governing_tables(numbers, decides)
    if decides is not None and decides.domain == "time" and any(entry.domain == "frequency" for entry in numbers):
        blocks.append(
            Paragraph(
                "Where a sea state was run in both domains the time domain decides, since it carries the non-linear "
                "lines; both stand in the table.",
                quiet=True,
            )
        )
    return tuple(blocks)


def _governing_sentence(decides: SeaNumbers | None) -> str:
    """Say in one sentence what governs."""
    if decides is None:
        return ""
    at = f" at T = {format_quantity(decides.tension_period, 's')}" if math.isfinite(decides.tension_period) else ""
    share = ""
    if math.isfinite(decides.utilisation):
        share = f", {format_percent(decides.utilisation)} of its breaking load"
    where = f"water level {decides.level}, sea state {decides.sea}{at} ({DOMAIN_WORDS[decides.domain]})"
    return f"Line {decides.line} governs: {format_quantity(decides.tension, 'N')}{share}; {where}."


def _tension_figures(levels: tuple[Level, ...], decides: SeaNumbers | None) -> list[KeyFigure]:
    if decides is None:
        return _tension_at_rest(levels)
    at = f", T = {format_quantity(decides.tension_period, 's')}" if math.isfinite(decides.tension_period) else ""
    items = [
        KeyFigure(
            "Largest line tension", format_quantity(decides.tension, "N"), f"line {decides.line}: {decides.words}{at}"
        )
    ]
    used = decides.utilisation
    if math.isfinite(used):
        items.append(
            KeyFigure(
                "Utilisation of the breaking load",
                format_percent(used, 3),
                f"breaking load {format_quantity(decides.breaking_load, 'N')}, "
                f"factor of safety {format_number(1.0 / used)}",
                used,
                "bad" if used > 1.0 else "",
            )
        )
    else:
        items.append(KeyFigure("Utilisation of the breaking load", DASH, "breaking load not given in the case"))
    return items


def _tension_at_rest(levels: tuple[Level, ...]) -> list[KeyFigure]:
    best: tuple[float, str] = (math.nan, "")
    for level in levels:
        statics = level.group.child("statics")
        found = statics.real("fairlead_tension", "line")
        if found is not None and np.isfinite(found).any() and not float(np.nanmax(found)) <= best[0]:
            best = (
                float(np.nanmax(found)),
                f"line {statics.labels('line')[int(np.nanargmax(found))]}: {level.name}, no waves run",
            )
    return [KeyFigure("Line tension at rest", format_quantity(best[0], "N"), best[1])] if math.isfinite(best[0]) else []


def _offset_figures(numbers: tuple[SeaNumbers, ...]) -> list[KeyFigure]:
    largest, mean = governing(numbers, "largest_offset"), governing(numbers, "mean_offset")
    items = []
    if largest is not None:
        items.append(KeyFigure("Largest offset in sway", format_quantity(largest.largest_offset, "m"), largest.words))
    if mean is not None:
        items.append(KeyFigure("Mean offset in sway", format_quantity(mean.mean_offset, "m"), mean.words))
    return items


def _transmission_figure(numbers: tuple[SeaNumbers, ...]) -> list[KeyFigure]:
    entry = governing(tuple(e for e in numbers if not e.regular), "transmission") or governing(numbers, "transmission")
    if entry is None:
        return []
    where = (
        "energy-weighted" if not entry.regular else f"largest, at T = {format_quantity(entry.transmission_period, 's')}"
    )
    reflected = f", K_R {format_number(entry.reflection)}" if math.isfinite(entry.reflection) else ""
    return [KeyFigure("Wave transmission K_T", format_number(entry.transmission), f"{where}{reflected}: {entry.words}")]


def _motion_figure(numbers: tuple[SeaNumbers, ...]) -> list[KeyFigure]:
    best = None
    for entry in numbers:
        roll = entry.motions.get("roll", math.nan)
        if math.isfinite(roll) and (best is None or roll > best.motions["roll"]):
            best = entry
    if best is None:
        return []
    others = ", ".join(
        f"{mode} {format_quantity(best.motions[mode], 'm')}"
        for mode in ("sway", "heave")
        if math.isfinite(best.motions.get(mode, math.nan))
    )
    kind = "Roll amplitude" if best.regular else "Significant roll (double amplitude)"
    return [
        KeyFigure(
            kind, format_quantity(best.motions["roll"], "rad"), f"{others}: {best.words}" if others else best.words
        )
    ]


def _uplift_figure(numbers: tuple[SeaNumbers, ...]) -> list[KeyFigure]:
    entry = governing(numbers, "uplift")
    if entry is None:
        return []
    if entry.uplift <= 0.0:
        return [KeyFigure("Uplift at the anchors", "none", "part of every line stays on the bed")]
    return [KeyFigure("Uplift at the anchors", format_quantity(entry.uplift, "N"), entry.words, judgement="caution")]


def _statics_figures(levels: tuple[Level, ...], numbers: tuple[SeaNumbers, ...]) -> list[KeyFigure]:
    """Return freeboard (with overtopping), stability and natural periods."""
    items = []
    least = _least(levels, "freeboard")
    if least is not None:
        freeboard, level = least
        draught = level.group.child("statics").value("draught")
        words = f"{level.name}, draught {format_quantity(draught, 'm')}"
        over = governing(numbers, "overtopping")
        if over is not None and over.overtopping > 0.0:
            words += f"; exceeded by {format_percent(over.overtopping)} of the waves in {over.sea} at {over.level}"
        items.append(
            KeyFigure("Freeboard", format_quantity(freeboard, "m"), words, judgement="bad" if freeboard <= 0.0 else "")
        )
    least = _least(levels, "metacentric_height")
    if least is not None:
        judgement: Literal["", "bad"] = "bad" if least[0] <= 0.0 else ""
        height = KeyFigure("Metacentric height GM", format_quantity(least[0], "m"), least[1].name, judgement=judgement)
        if judgement:
            items.insert(0, height)  # an unstable body comes before everything that rests on it
        else:
            items.append(height)
    return [*items, *_natural_period(levels)]


def _least(levels: tuple[Level, ...], name: str) -> tuple[float, Level] | None:
    """Return the least value of a number at rest over the water levels."""
    known = [(level.group.child("statics").value(name), level) for level in levels]
    known = [(value, level) for value, level in known if math.isfinite(value)]
    return min(known, key=lambda entry: entry[0]) if known else None


def _natural_period(levels: tuple[Level, ...]) -> list[KeyFigure]:
    for level in levels:
        group = level.group.child("statics")
        periods = group.real("natural_period", "mode")
        if periods is None or not np.isfinite(periods).any():
            continue
        by_mode = dict(zip(group.labels("mode"), map(float, periods), strict=True))
        words = ", ".join(
            f"{mode} {format_quantity(value, 's')}" for mode, value in by_mode.items() if math.isfinite(value)
        )
        longest = max(value for value in by_mode.values() if math.isfinite(value))
        shown, label = longest, "Longest natural period"
        if math.isfinite(by_mode.get("roll", math.nan)):
            shown, label = by_mode["roll"], "Natural period of roll"
        return [KeyFigure(label, format_quantity(shown, "s"), f"{level.name}: {words}")]
    return []
