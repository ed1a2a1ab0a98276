"""Sizes of a row of units that the numbers of its case are held against."""

from __future__ import annotations

import math
from typing import Any

from moyai.case.plausible_sizes import Sizes
from moyai.case.yaml_reader import KeyPath


def add_sizes(model: Any, sizes: Sizes) -> None:
    """Add beam, height and weight of a unit, each with the keys that it follows from."""
    unit, site = model.structure, model.site
    section: KeyPath = ("structure", "section")
    length: KeyPath = ("structure", "units", "length")
    try:
        hull = unit.section.hull()
    except ValueError:
        return
    beam, height = hull.beam, hull.height
    sizes[("structure", "@beam")] = beam, (section,)
    sizes[("structure", "@height")] = height, (section,)
    sizes[("structure", "@diagonal")] = math.hypot(beam, height), (section,)
    sizes[("structure", "@unit_length")] = unit.units.length, (length,)
    block = site.density * beam * height * unit.units.length
    sizes[("structure", "@block_weight")] = block * site.gravity, (section, length)
