"""The numbers that follow from a case before anything is run: shown by ``moyai check``."""

from __future__ import annotations

import math
from dataclasses import dataclass
from html import escape
from typing import TYPE_CHECKING, Any

from moyai.core.kinds import structure_kind
from moyai.core.units import parse_unit

if TYPE_CHECKING:
    from moyai.case.reader import Case


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


def derived_numbers(case: Case) -> tuple[Number, ...]:
    """Return the numbers that follow from a case.

    Parameters
    ----------
    case : Case
        From :func:`moyai.case.reader.load_case`.

    Returns
    -------
    tuple of Number
        Each with its value in SI units, and the unit that it is shown in.

    Raises
    ------
    InputError
        When a file that the case names has changed or become unreadable since it was checked.

    Examples
    --------
    >>> import moyai
    >>> from moyai.case import derived_numbers
    >>> numbers = derived_numbers(moyai.load_case(moyai.template("member")))
    >>> numbers[0].label, numbers[0].value, numbers[0].unit
    ('length', 20.0, 'm')
    """
    numbers: tuple[Number, ...] = structure_kind(case.kind).derived(case)
    return numbers


def case_html(case: Case) -> str:
    """Return a case as a piece of HTML for a notebook; nothing is loaded.

    Parameters
    ----------
    case : Case
    """
    parts = [f"<strong>{escape(case.title)}</strong>", f"<div>{escape(case.kind)}, {escape(str(case.path))}</div>"]
    parts += [f"<div>warning: {escape(str(fault))}</div>" for fault in case.warnings]
    numbers = derived_numbers(case)
    for group in dict.fromkeys(number.group for number in numbers):
        own = [number for number in numbers if number.group == group]
        levels = tuple(dict.fromkeys(number.column for number in own))
        rows = [_row("th", (group, *levels, ""))]
        for label, unit in dict.fromkeys((number.label, number.unit) for number in own):
            texts = {number.column: number.text for number in own if (number.label, number.unit) == (label, unit)}
            rows.append(_row("td", (label, *(texts.get(level, "") for level in levels), unit)))
        parts.append(f"<table>{''.join(rows)}</table>")
    parts.append(f"<details><summary>case file</summary><pre>{escape(case.text)}</pre></details>")
    return f'<div class="moyai-case">{"".join(parts)}</div>'


def _row(tag: str, cells: tuple[str, ...]) -> str:
    return f"<tr>{''.join(f'<{tag}>{escape(cell)}</{tag}>' for cell in cells)}</tr>"
