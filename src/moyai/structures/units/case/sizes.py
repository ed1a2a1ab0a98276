"""Sizes of a row of units that the numbers of its case are compared with."""

from __future__ import annotations

import math
from typing import Any

from moyai.case.plausible_sizes import Periods, Sizes
from moyai.case.yaml_reader import KeyPath


def add_sizes(model: Any, sizes: Sizes, periods: Periods) -> None:
    """Add beam, height and weight of a unit, each with the keys that it follows from."""
    unit, site = model.structure, model.site
    section: KeyPath = ("structure", "section")
    length: KeyPath = ("structure", "units", "length")
    try:
        hull = unit.section.hull()
    except ValueError:
        return
    beam, height = hull.beam, hull.height
    sides = tuple((*section, name) if hasattr(unit.section, name) else section for name in ("beam", "height"))
    sizes[("structure", "@beam")] = beam, sides[:1]
    sizes[("structure", "@height")] = height, sides[1:]
    sizes[("structure", "@diagonal")] = math.hypot(beam, height), sides
    sizes[("structure", "@unit_length")] = unit.units.length, (length,)
    count = unit.units.count or max(len(unit.units.places), 1)
    sizes[("structure", "@row_length")] = count * unit.units.length, (length,)
    rate = math.sqrt(site.gravity / beam) if beam > 0.0 else 0.0
    sizes[("structure", "@frequency")] = rate, (section,)
    waterplane = site.density * site.gravity * beam * unit.units.length
    sizes[("structure", "@waterplane_stiffness")] = waterplane, (section, length)
    if rate > 0.0:
        sizes[("structure", "@waterplane_damping")] = waterplane / rate, (section, length)
    for index, line in enumerate(model.lines):
        _line(line, ("lines", index), unit.draught, site, sizes)
    block = site.density * beam * height * unit.units.length
    sizes[("structure", "@block_weight")] = block * site.gravity, (section, length)


def _line(line: Any, base: KeyPath, draught: float, site: Any, sizes: Sizes) -> None:
    segments = getattr(line, "segments", ())
    if not segments or math.isinf(site.water_depth):
        return
    rise = site.water_depth - draught + line.fairlead.above_keel - line.anchor.above_bed
    across, along = line.anchor.x - line.fairlead.x, line.anchor.y - line.fairlead.y
    ends = tuple((*base, end, key) for end in ("anchor", "fairlead") for key in ("x", "y"))
    sizes[(*base, "@chord")] = math.sqrt(across**2 + along**2 + rise**2), (*ends, ("site", "water_depth"))
    parts = [(part, (*base, "segments", n, "length")) for n, part in enumerate(segments) if hasattr(part, "length")]
    sizes[(*base, "@length")] = sum(part.length for part, _ in parts), tuple(path for _, path in parts)
