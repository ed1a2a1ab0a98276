"""Sizes of a member that the numbers of its case are compared with."""

from __future__ import annotations

import math
from typing import Any

from moyai.case.plausible_sizes import Periods, Sizes, fastest_water
from moyai.case.yaml_reader import KeyPath


def add_sizes(model: Any, sizes: Sizes, periods: Periods) -> None:
    """Add width, length and scale of the loads of a member, each with the keys that it follows from."""
    unit = model.structure
    section: KeyPath = ("structure", "section")
    shape = unit.section
    width = getattr(shape, "diameter", None) or getattr(shape, "width", None)
    if width is None:
        across = [point[0] for point in shape.points]
        width = max(across) - min(across)
    sizes[("structure", "@width")] = width, (section,)
    ends = tuple(("structure", end, key) for end in ("start", "end") for key in ("x", "y", "z"))
    pairs = [(getattr(unit.start, key), getattr(unit.end, key)) for key in ("x", "y", "z")]
    sizes[("structure", "@length")] = math.dist([a for a, _ in pairs], [b for _, b in pairs]), ends
    if unit.motion is None and (water := fastest_water(model, periods)) is not None:
        (width, of_width), (length, of_length) = sizes[("structure", "@width")], sizes[("structure", "@length")]
        force = model.site.density * length * (width * water.speed**2 + width**2 * water.acceleration)
        keys = (*water.of, *of_width, *of_length)
        sizes[("structure", "@wave_force")] = force, keys
        sizes[("structure", "@wave_moment")] = force * length, keys
