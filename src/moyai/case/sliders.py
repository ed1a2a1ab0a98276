"""The numbers that matter by structure: where they stand in the case, and the range over which they are tried."""

from __future__ import annotations

import math
from dataclasses import asdict, dataclass
from typing import Any

from moyai.case.text_numbers import number_at
from moyai.case.yaml_reader import CaseDocument
from moyai.core.kinds import structure_kind, structure_kinds
from moyai.language import said

_MOST = 12


@dataclass(frozen=True)
class Slider:
    """A number of the case that can be moved."""

    path: str
    #: What the slider is called on the page.
    label: str
    #: Unit as the file writes it.
    unit: str
    #: Value in the file, in that unit.
    value: float
    #: Lower end, in that unit.
    low: float
    #: Upper end, in that unit.
    high: float
    #: Step, in that unit.
    step: float
    #: Digits behind the point that the step needs.
    decimals: int


_SITE = (("site.water_depth", "Water depth"),)
_SEA = (
    ("waves[{}].height", "Wave height"),
    ("waves[{}].period", "Wave period"),
    ("waves[{}].heading_deg", "Wave heading"),
    ("waves[{}].significant_height", "Significant height"),
    ("waves[{}].peak_period", "Peak period"),
    ("waves[{}].significant_period", "Significant period"),
)
_SEAS = tuple((path.format(number), label) for number in range(8) for path, label in _SEA)
_CURRENT = (("current.speed", "Current speed"), ("current.heading_deg", "Current heading"))

COMMON = (*_CURRENT, *_SITE, *_SEAS)
"""Paths and names of the numbers that any structure may have."""


def sliders_of(document: CaseDocument, kind: str, drawn: Any = None) -> list[dict[str, Any]]:
    """Return the sliders of a case: those that it names itself, else those that matter for its structure.

    Parameters
    ----------
    document : Document
    kind : str
        Kind of structure; one that is not known has those of site, current and sea.
    drawn : mapping, optional
        Content of the case as a draft takes it: seas that it leaves out have no sliders of their own accord.
    """
    found: dict[int, Slider] = {}
    own = _own(document.data)
    for path, label in own or (*_numbers_of(kind), *COMMON):
        written = number_at(document, path)
        # A sea that stands as a block alone answers to several paths
        if written is None or written.start in found or not (own or _is_drawn(document.data, drawn, path)):
            continue
        name, label = _sea_name(document.data, path), said(label)
        found[written.start] = slider(path, f"{label}, {name}" if name else label, written.unit, written.value)
        if len(found) == _MOST and not own:
            break
    return [asdict(item) for item in found.values()]


def _numbers_of(kind: str) -> tuple[tuple[str, str], ...]:
    return structure_kind(kind).numbers if kind in structure_kinds() else ()


def _own(data: Any) -> list[tuple[str, str]]:
    """Return path and label of the numbers that a case names under ``app.sliders``."""
    block = data.get("app") if isinstance(data, dict) else None
    paths = block.get("sliders") if isinstance(block, dict) else None
    labels = {path: label for kind in structure_kinds() for path, label in (*_numbers_of(kind), *COMMON)}
    named = [path for path in paths if isinstance(path, str)] if isinstance(paths, list) else []
    return [(path, labels.get(path) or _label(path)) for path in named]


def _label(path: str) -> str:
    """Return ``Length of segments[0]`` for ``lines[0].segments[0].length``."""
    *blocks, key = path.split(".")
    words = key.removesuffix("_deg").replace("_", " ")
    return words[:1].upper() + words[1:] + (f" of {blocks[-1].replace('_', ' ')}" if blocks else "")


def _is_drawn(data: Any, drawn: Any, path: str) -> bool:
    seas, kept = (None if one is None else one.get("waves") for one in (data, drawn))
    if not path.startswith("waves[") or not isinstance(seas, list) or not isinstance(kept, list):
        return True
    number = int(path[6 : path.index("]")])
    return number < len(seas) and any(seas[number] is one for one in kept)


def _sea_name(data: Any, path: str) -> str:
    """Return the name of the sea state of a path, empty where there is only one."""
    seas = data.get("waves") if path.startswith("waves[") else None
    if not isinstance(seas, list) or len(seas) < 2:
        return ""
    number = path[6 : path.index("]")]
    if not number.isdecimal():
        return number
    sea = seas[int(number)]
    return str(sea.get("name", "")) if isinstance(sea, dict) else ""


def slider(path: str, label: str, unit: str, value: float) -> Slider:
    """Return a slider whose range follows from the value: from a half to one and a half; angles have a range of 45."""
    if path.endswith("_deg"):
        unit = "°"
        low, high, step = value - 45.0, value + 45.0, 0.5
    else:
        size = abs(value) if value else 1.0
        step = _nice(size / 100.0)
        low, high = sorted((step * round(0.5 * value / step), step * round(1.5 * value / step)))
        low, high = (0.0, 100 * step) if not value else (low, high)
    decimals = max(0, -math.floor(math.log10(step) + 1e-9))
    return Slider(path, label, unit, value, round(low, 12), round(high, 12), step, decimals)


def _nice(width: float) -> float:
    """Return the largest of 1, 2, 5 times a power of ten that is at most ``width``."""
    power = 10.0 ** math.floor(math.log10(width))
    return next(factor * power for factor in (5.0, 2.0, 1.0) if factor * power <= width * (1.0 + 1e-9))
