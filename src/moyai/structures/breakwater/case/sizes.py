"""Sizes of a floating breakwater that the numbers of its case are compared with."""

from __future__ import annotations

import math
from typing import Any

from moyai.case.plausible_sizes import Periods, Sizes
from moyai.case.yaml_reader import KeyPath

_DEPTH: KeyPath = ("site", "water_depth")
_DENSITY: KeyPath = ("site", "density")
_GRAVITY: KeyPath = ("site", "gravity")


def add_sizes(model: Any, sizes: Sizes, periods: Periods) -> None:
    """Add the sizes of unit and lines, each with the keys that it follows from."""
    unit, site = model.structure, model.site
    section: KeyPath = ("structure", "section")
    length: KeyPath = ("structure", "length")
    beam, height = _extent(unit.section)
    sides = tuple((*section, name) if hasattr(unit.section, name) else section for name in ("beam", "height"))
    sizes[("structure", "@beam")] = beam, sides[:1]
    sizes[("structure", "@height")] = height, sides[1:]
    sizes[("structure", "@diagonal")] = math.hypot(beam, height), sides
    block = site.density * beam * height * unit.length
    of = (section, length, _DENSITY)
    rate = math.sqrt(site.gravity / beam) if beam > 0.0 else 0.0
    sizes[("structure", "@block")] = block, of
    sizes[("structure", "@block_weight")] = block * site.gravity, (*of, _GRAVITY)
    sizes[("structure", "@frequency")] = rate, (section, _GRAVITY)
    sizes[("structure", "@heave_damping")] = block * rate, (*of, _GRAVITY)
    sizes[("structure", "@roll_inertia")] = block * beam * beam, of
    sizes[("structure", "@roll_damping")] = block * beam * beam * rate, (*of, _GRAVITY)
    waterplane = site.density * site.gravity * beam * unit.length
    sizes[("structure", "@waterplane_stiffness")] = waterplane, (*of, _GRAVITY)
    draught = unit.draught if unit.draught is not None else 0.5 * height
    for index, line in enumerate(model.lines):
        _breakwater_line(line, ("lines", index), draught, site, sizes)


def _breakwater_line(line: Any, base: KeyPath, draught: float, site: Any, sizes: Sizes) -> None:
    segments = getattr(line, "segments", ())
    if not segments:
        return
    rise = site.water_depth - draught + line.fairlead.above_keel - line.anchor.above_bed
    across, along = line.anchor.x - line.fairlead.x, line.anchor.y - line.fairlead.y
    ends = tuple((*base, end, key) for end in ("anchor", "fairlead") for key in ("x", "y"))
    sizes[(*base, "@chord")] = math.sqrt(across**2 + along**2 + rise**2), (*ends, _DEPTH)
    parts = [(part, (*base, "segments", number)) for number, part in enumerate(segments) if hasattr(part, "length")]
    total = sum(part.length for part, _ in parts)
    sizes[(*base, "@length")] = total, tuple((*path, "length") for _, path in parts)
    weight = _weight(parts, site)
    for part, path in parts:
        diameter = getattr(part, "diameter", None)
        if diameter is not None:
            area = 0.25 * math.pi * diameter**2
            key = (*path, "diameter")
            sizes[(*path, "@area")] = area, (key,)
            sizes[(*path, "@water_mass")] = site.density * area, (key, _DENSITY)
            sizes[(*path, "@water_weight")] = site.density * site.gravity * area, (key, _DENSITY, _GRAVITY)
        if getattr(part, "mass", None) is not None:
            sizes[(*path, "@weight_in_air")] = part.mass * site.gravity, ((*path, "mass"), _GRAVITY)
        sizes[(*path, "@weight_of_line")] = weight, tuple((*inner, "length") for _, inner in parts)


def _weight(parts: list[tuple[Any, KeyPath]], site: Any) -> float:
    """Return the weight in water of the segments that state it [N]."""
    total = 0.0
    for part, _ in parts:
        weight = getattr(part, "submerged_weight", None)
        if weight is None and getattr(part, "submerged_mass", None) is not None:
            weight = part.submerged_mass * site.gravity
        total += abs(weight or 0.0) * part.length
    return total


def _extent(section: Any) -> tuple[float, float]:
    """Return beam and height of a section from its keys."""
    if section.shape == "circle":
        return 2.0 * section.radius, 2.0 * section.radius
    if section.shape == "polygon":
        across, up = [point[0] for point in section.points], [point[1] for point in section.points]
        return max(across) - min(across), max(up) - min(up)
    if section.shape == "twin_pontoon":
        return 2.0 * section.pontoon_beam + section.gap, section.height
    if section.shape == "trapezoid":
        return max(section.top_beam, section.bottom_beam), section.height
    return section.beam, section.height + getattr(section, "plate_depth", 0.0)
