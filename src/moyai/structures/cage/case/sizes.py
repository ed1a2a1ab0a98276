"""Sizes of a net cage that the numbers of its case are compared with."""

from __future__ import annotations

import math
from typing import Any

from moyai.case.plausible_sizes import Periods, Sizes, fastest_water
from moyai.case.yaml_reader import KeyPath

_DENSITY: KeyPath = ("site", "density")
_GRAVITY: KeyPath = ("site", "gravity")


def add_sizes(model: Any, sizes: Sizes, periods: Periods) -> None:
    """Add the sizes of cage, floats and ropes, each with the keys that it follows from."""
    unit, site = model.structure, model.site
    if unit.model == "flexible":
        sizes[("structure", "@size")] = unit.size, (("structure", "size"),)
        for key in ("collar", "sinker_tube"):
            pipe = unit.collar.pipe if key == "collar" and unit.collar is not None else unit.sinker_tube
            base: KeyPath = ("structure", key, "pipe") if key == "collar" else ("structure", key)
            if pipe is not None and (key != "collar" or unit.collar is not None):
                mass = site.density * 0.25 * math.pi * pipe.diameter**2
                sizes[(*base, "@displaced_mass")] = mass, ((*base, "diameter"), _DENSITY)
        if unit.collar is not None:
            of: KeyPath = ("structure", "collar", "pipe", "diameter")
            sizes[("structure", "collar", "@pipe_diameter")] = unit.collar.pipe.diameter, (of,)
        if (water := fastest_water(model, periods)) is not None:
            of_net: tuple[KeyPath, ...] = (("structure", "size"), ("structure", "net", "wall_depth"))
            wall = unit.size * unit.net.wall_depth
            sizes[("structure", "@flow_force")] = site.density * wall * water.speed**2, (*water.of, *of_net, _DENSITY)
        if unit.mooring.kind == "grid":
            _grid(unit.mooring, site, sizes)
        return
    shape: KeyPath = ("structure", "shape")
    sides = [getattr(unit.shape, key) for key in ("length", "width", "height", "diameter") if hasattr(unit.shape, key)]
    size = sorted(sides)[len(sides) // 2] if len(sides) > 2 else max(sides)
    across = getattr(unit.shape, "diameter", None)
    volume = math.prod(sides) if across is None else 0.25 * math.pi * across**2 * unit.shape.height
    mass = site.density * volume
    sizes[("structure", "@size")] = size, tuple((*shape, key) for key in ("length", "width", "height", "diameter"))
    sizes[("structure", "@block")] = mass, (shape, _DENSITY)
    sizes[("structure", "@block_weight")] = mass * site.gravity, (shape, _DENSITY, _GRAVITY)
    sizes[("structure", "@area_stiffness")] = site.density * site.gravity * size**2, (shape, _DENSITY, _GRAVITY)
    floats: KeyPath = ("structure", "floats", "diameter")
    sizes[("structure", "floats", "@displaced")] = _sphere(unit.floats.diameter, site), (floats, _DENSITY)


def _grid(grid: Any, site: Any, sizes: Sizes) -> None:
    base: KeyPath = ("structure", "mooring")
    sizes[("structure", "mesh", "@bay")] = grid.bay, ((*base, "bay"),)
    sizes[(*base, "buoys", "@displaced")] = _sphere(grid.buoys.diameter, site), ((*base, "buoys", "diameter"), _DENSITY)
    ropes = [(grid.frame_rope, (*base, "frame_rope")), (grid.bridle, (*base, "bridle"))]
    ropes += [(part, (*base, "anchor_line", index)) for index, part in enumerate(grid.anchor_line)]
    for rope, path in ropes:
        sizes[(*path, "@area")] = 0.25 * math.pi * rope.diameter**2, ((*path, "diameter"),)


def _sphere(diameter: float, site: Any) -> float:
    return float(site.density * math.pi / 6.0 * diameter**3)
