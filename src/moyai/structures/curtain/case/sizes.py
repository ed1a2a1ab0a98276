"""Sizes of a silt curtain that the numbers of its case are compared with."""

from __future__ import annotations

import math
from typing import Any

from moyai.case.plausible_sizes import Periods, Sizes
from moyai.case.yaml_reader import KeyPath

_DENSITY: KeyPath = ("site", "density")
_GRAVITY: KeyPath = ("site", "gravity")


def add_sizes(model: Any, sizes: Sizes, periods: Periods) -> None:
    """Add the sizes of skirt and span, each with the keys that it follows from."""
    unit, site = model.structure, model.site
    skirt: KeyPath = ("structure", "skirt", "length")
    span: KeyPath = ("structure", "span")
    depth = unit.skirt.length
    sizes[("structure", "@skirt")] = depth, (skirt,)
    sizes[("structure", "@skirt_mass_scale")] = site.density * depth**2, (skirt, _DENSITY)
    weight = site.density * site.gravity * depth**2
    sizes[("structure", "@skirt_weight_scale")] = weight, (skirt, _DENSITY, _GRAVITY)
    sizes[("structure", "@panel_force")] = weight * unit.span, (skirt, span, _DENSITY, _GRAVITY)
    sizes[("structure", "@panel_mass")] = site.density * depth**2 * unit.span, (skirt, span, _DENSITY)
    sizes[("@time_scale",)] = math.sqrt(unit.span / site.gravity), (span, _GRAVITY)
