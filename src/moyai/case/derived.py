"""The numbers that follow from a case before anything is run: shown by ``moyai check``."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from html import escape
from typing import Any

from moyai.core.errors import Fault
from moyai.core.units import parse_unit


@dataclass(frozen=True)
class Number:
    """One derived number."""

    #: What it belongs to: the unit, its lines, a sea state.
    group: str
    #: Water level that it holds at.
    column: str
    label: str
    #: SI.
    value: float
    #: Unit that it is shown in.
    unit: str = ""
    #: Significant digits shown.
    digits: int = 4

    @property
    def text(self) -> str:
        """The value in its unit, as shown."""
        if not math.isfinite(self.value):
            return "infinite" if self.value > 0.0 else str(self.value)
        shown = parse_unit(self.unit).from_si(self.value) if self.unit else self.value
        text = f"{shown:.{self.digits}g}"
        return f"{float(text):.0f}" if "e+" in text and abs(float(text)) < 1e7 else text

    def as_dict(self) -> dict[str, Any]:
        """Return a JSON-ready record with the SI value."""
        return {
            "group": self.group,
            "water_level": self.column,
            "label": self.label,
            "value_si": self.value,
            "shown": f"{self.text} {self.unit}".strip(),
        }


def force_unit(force: float) -> str:
    """Return the unit in which a force [N] is shown: N, kN or MN."""
    size = abs(force)
    if size >= 1e6:
        return "MN"
    return "kN" if size >= 1e3 else "N"


def case_html(title: str, place: str, warnings: Sequence[Fault], numbers: Sequence[Number], text: str) -> str:
    """Return a case as a piece of HTML for a notebook; nothing is loaded.

    Parameters
    ----------
    title : str
    place : str
        Kind of the structure and file of the case.
    warnings : sequence of Fault
    numbers : sequence of Number
        That follow from the case.
    text : str
        Content of the file.
    """
    parts = [f"<strong>{escape(title)}</strong>", f"<div>{escape(place)}</div>"]
    parts += [f"<div>warning: {escape(str(fault))}</div>" for fault in warnings]
    for group in dict.fromkeys(number.group for number in numbers):
        own = [number for number in numbers if number.group == group]
        levels = tuple(dict.fromkeys(number.column for number in own))
        rows = [_row("th", (group, *levels, ""))]
        for label, unit in dict.fromkeys((number.label, number.unit) for number in own):
            texts = {number.column: number.text for number in own if (number.label, number.unit) == (label, unit)}
            rows.append(_row("td", (label, *(texts.get(level, "") for level in levels), unit)))
        parts.append(f"<table>{''.join(rows)}</table>")
    parts.append(f"<details><summary>case file</summary><pre>{escape(text)}</pre></details>")
    return f'<div class="moyai-case">{"".join(parts)}</div>'


def _row(tag: str, cells: tuple[str, ...]) -> str:
    return f"<tr>{''.join(f'<{tag}>{escape(cell)}</{tag}>' for cell in cells)}</tr>"
