"""The numbers that matter by structure: where they stand in the case, and the range over which they are tried."""

from __future__ import annotations

import math
from dataclasses import asdict, dataclass
from typing import Any

from moyai.app.edits import number_at
from moyai.case.yaml_reader import Document
from moyai.language import said

_MOST = 12


@dataclass(frozen=True)
class Slider:
    """A number of the case that can be moved."""

    path: str
    #: Unit as the file writes it.
    label: str
    #: Unit as the file writes it.
    unit: str
    #: In that unit.
    value: float
    #: In that unit.
    low: float
    #: In that unit.
    high: float
    #: In that unit.
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

PATHS: dict[str, tuple[tuple[str, str], ...]] = {
    "breakwater": (
        ("structure.section.beam", "Beam"),
        ("structure.draught", "Draught"),
        ("structure.mass", "Mass"),
        ("structure.length", "Length of a unit"),
        ("structure.centre_of_gravity_above_keel", "Centre of gravity above keel"),
        ("structure.roll_gyradius", "Gyradius of roll"),
        ("lines[0].segments[0].length", "Line length, first line"),
        ("lines[1].segments[0].length", "Line length, second line"),
        ("lines[0].segments[0].diameter", "Chain diameter, first line"),
        ("lines[0].anchor.x", "Anchor, first line"),
        *_SITE,
        *_SEAS[:1],
        ("wind.speed", "Wind speed"),
        *_CURRENT[:1],
        *_SEAS[1:],
    ),
    "units": (
        ("structure.centre_of_gravity_above_keel", "Centre of gravity above keel"),
        ("structure.roll_gyradius", "Gyradius of roll"),
        ("structure.pitch_gyradius", "Gyradius of pitch"),
        ("structure.damping.fraction_of_critical", "Damping, share of critical"),
        ("structure.connectors[0].above_keel", "Height of the first connector"),
        ("structure.connectors[0].stiffness", "Stiffness of the first connector"),
        ("structure.connectors[0].slack", "Slack of the first connector"),
        ("lines[0].segments[0].length", "Line length, first line"),
        ("lines[0].segments[0].diameter", "Chain diameter, first line"),
        ("structure.section.beam", "Beam"),
        ("structure.draught", "Draught"),
        *_SITE,
        ("wind.speed", "Wind speed"),
        *_CURRENT[:1],
        *_SEAS,
    ),
    "curtain": (
        ("structure.skirt.length", "Depth of the skirt"),
        ("structure.span", "Span"),
        ("structure.length", "Length of the curtain"),
        ("structure.toe.chain_mass", "Chain at the toe"),
        ("structure.skirt.submerged_weight", "Weight of the sheet under water"),
        ("structure.floats.buoyancy", "Buoyancy of the floats"),
        ("structure.drag.coefficient", "Drag coefficient"),
        ("structure.passing_fraction", "Share of flow under the toe"),
        *_CURRENT,
        *_SITE,
        *_SEAS,
    ),
    "cage": (
        ("structure.size", "Diameter or side"),
        ("structure.net.wall_depth", "Depth of the net wall"),
        ("structure.net.cone_depth", "Depth of the cone"),
        ("structure.net.twine_diameter", "Twine diameter"),
        ("structure.net.mesh_pitch", "Mesh pitch"),
        ("structure.net.aperture", "Aperture"),
        ("structure.sinkers.mass", "Mass of a sinker"),
        ("structure.mooring.anchor_distance", "Anchor distance"),
        ("structure.mooring.anchor_line[0].length", "Rope of the anchor line"),
        ("structure.mooring.pull_down", "Pull down"),
        ("structure.mooring.stiffness", "Stiffness of a line"),
        ("structure.weight.mass", "Mass as weighed"),
        *_CURRENT,
        *_SITE,
        *_SEAS,
    ),
    "network": (
        ("structure.points.buoy.diameter", "Diameter of the buoy"),
        ("structure.points.buoy.mass", "Mass of the buoy"),
        ("structure.lines.mooring.length", "Length of the line"),
        ("structure.line_types.chain.diameter", "Diameter of the chain"),
        *_CURRENT,
        *_SITE,
        *_SEAS,
    ),
    "member": (
        ("structure.section.diameter", "Diameter"),
        ("structure.section.side", "Side"),
        ("structure.section.width", "Width"),
        ("structure.section.height", "Height of the section"),
        ("structure.start.z", "Level of the start"),
        ("structure.end.z", "Level of the end"),
        ("structure.section_angle_deg", "Turn of the section"),
        ("structure.drag.roughness", "Roughness"),
        *_CURRENT,
        *_SITE,
        *_SEAS,
    ),
}
"""Paths that are looked for in a case, by kind, the most wanted first; those that a case lacks are left out."""


def sliders_of(document: Document, kind: str, drawn: Any = None) -> list[dict[str, Any]]:
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
    for path, label in own or PATHS.get(kind, (*_SITE, *_CURRENT, *_SEAS)):
        written = number_at(document, path)
        # A sea that stands as a block alone answers to several paths
        if written is None or written.start in found or not (own or _is_drawn(document.data, drawn, path)):
            continue
        name, label = _sea_name(document.data, path), said(label)
        found[written.start] = slider(path, f"{label}, {name}" if name else label, written.unit, written.value)
        if len(found) == _MOST and not own:
            break
    return [asdict(item) for item in found.values()]


def _own(data: Any) -> list[tuple[str, str]]:
    """Return path and label of the numbers that a case names under ``app.sliders``."""
    block = data.get("app") if isinstance(data, dict) else None
    paths = block.get("sliders") if isinstance(block, dict) else None
    labels = {path: label for table in PATHS.values() for path, label in table}
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
