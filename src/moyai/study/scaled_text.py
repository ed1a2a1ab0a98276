"""Change values in the text of a YAML file and leave everything else as it was written."""

from __future__ import annotations

import re
from typing import Any

import yaml

from moyai.core.units import parse_unit

# Units of one quantity, from large to small: a value that became small or large is written in the next that suits
_FAMILIES = (
    ("km", "m", "mm"),
    ("t", "kg", "g"),
    ("MN", "kN", "N", "mN"),
    ("MN/m", "kN/m", "N/m", "mN/m"),
    ("t/m", "kg/m", "g/m"),
    ("GPa", "MPa", "kPa", "Pa"),
    ("h", "min", "s", "ms"),
    ("MN m", "kN m", "N m", "mN m"),
    ("MN*m", "kN*m", "N*m", "mN*m"),
    ("m/s", "mm/s"),
)
_MOST_SHOWN = 4
_PROPERTIES = re.compile(r"(?:[&!]\S*\s+)+")
_HEADER = re.compile(r"^# (Model|Prototype) of '.*', made by 'moyai scale'")
_REMARK = re.compile(r"  (?:\[[^][]*\((?:1/|times )[0-9.e+]+\)[^][]*\]|# [^#]*\((?:1/|times )[0-9.e+]+\)[^#]*)$")


def number_text(value: float, digits: int = 6) -> str:
    """Return a number for a YAML file: shortest form with ``digits`` significant digits."""
    text = f"{value:.{digits}g}"
    return text if float(text) != value or len(text) <= len(repr(value)) else repr(value)


def written_in(value: float, unit: str, digits: int = 6) -> str:
    """Return a value with its unit, or with a larger or smaller one of its family where that reads better.

    Parameters
    ----------
    value : float
        In ``unit``.
    unit : str
        As the user wrote it; empty for a number.
    digits : int
        Significant digits.
    """
    family = next((names for names in _FAMILIES if unit in names), None)
    most = 1e4 if "min" in (family or ()) else 1e3
    if family is not None and value != 0.0 and not 0.1 <= abs(value) < most:
        size = abs(value) * float(parse_unit(unit).factor)
        unit_now = next((name for name in family if size >= float(parse_unit(name).factor)), family[-1])
        value = value * float(parse_unit(unit).factor / parse_unit(unit_now).factor)
        unit = unit_now
    return f"{number_text(value, digits)} {unit}".rstrip()


def without_remarks(text: str) -> str:
    """Return a file without the remarks that an earlier scaling put into it."""
    lines = text.split("\n")
    if lines and _HEADER.search(lines[0]):
        while lines and lines[0].startswith("#"):
            lines.pop(0)
        if lines and not lines[0].strip():
            lines.pop(0)
    return "\n".join(_REMARK.sub("", line) for line in lines)


class Edits:
    """Changes to a text, gathered and then carried out from the back.

    Parameters
    ----------
    text : str
        The file.
    """

    def __init__(self, text: str) -> None:
        self._text = text
        self._changes: dict[tuple[int, int], str] = {}
        self._remarks: dict[int, list[str]] = {}

    def replace(self, node: Any, new: str, remark: str, *, quote: bool = True) -> bool:
        """Put ``new`` in place of a scalar; ``False`` where it was replaced by something else before."""
        start, end = node.start_mark.index, node.end_mark.index
        properties = _PROPERTIES.match(self._text, start, end)  # an anchor stays for its aliases
        span = (properties.end() if properties else start, end)
        if quote and node.style in ("'", '"'):
            new = f"{node.style}{new}{node.style}"
        if span in self._changes:
            return self._changes[span] == new
        self._changes[span] = new
        self._remark(span[1], remark)
        return True

    def replace_entry(self, node: Any, key: str, entries: list[str], remark: str) -> None:
        """Put other keys in place of one key and its value."""
        for name, value in node.value:
            if name.value != key:
                continue
            last = value
            while isinstance(last, yaml.CollectionNode) and not last.flow_style and last.value:
                last = last.value[-1][1] if isinstance(last, yaml.MappingNode) else last.value[-1]
            span = (name.start_mark.index, last.end_mark.index)
            if span not in self._changes:
                between = ", " if node.flow_style else "\n" + " " * name.start_mark.column
                self._changes[span] = between.join(entries)
                self._remark(span[1], remark)

    def add_keys(self, node: Any, keys: list[str], remark: str) -> None:
        """Write further keys before the first one of a block."""
        if not isinstance(node, yaml.MappingNode) or not node.value:
            return
        first = node.value[0][0].start_mark
        span = (first.index, first.index)
        if span in self._changes:
            return
        if node.flow_style:
            self._changes[span] = "".join(f"{key}, " for key in keys)
        else:
            indent = " " * first.column
            self._changes[span] = "".join(f"{key}  # {remark}\n{indent}" for key in keys)

    def _remark(self, position: int, remark: str) -> None:
        if remark:
            end = self._text.find("\n", position)
            self._remarks.setdefault(len(self._text) if end < 0 else end, []).append(remark)

    def text(self) -> str:
        """Return the changed text."""
        changes = [(start, end, new) for (start, end), new in self._changes.items()]
        for end, remarks in self._remarks.items():
            shown = remarks[:_MOST_SHOWN]
            if len(remarks) > _MOST_SHOWN:
                shown.append(f"and {len(remarks) - _MOST_SHOWN} more")
            line = self._text[self._text.rfind("\n", 0, end) + 1 : end]
            written = "; ".join(shown)
            # A '#' inside quotes is taken for a comment here; the remark is then only spaced differently
            changes.append((end, end, f"  [{written}]" if " #" in line else f"  # {written}"))
        text = self._text
        for start, end, new in sorted(changes, key=lambda change: (change[0], change[1]), reverse=True):
            text = text[:start] + new + text[end:]
        return text
