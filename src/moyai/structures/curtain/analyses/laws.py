"""The load laws of section and plan side by side, on the curtain of a run."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from moyai.core.arrays import Array
from moyai.structures.curtain.assembly import LevelCurtain
from moyai.structures.curtain.statics.load_laws import PlanLaw, SectionLaw, plan_laws, section_laws
from moyai.structures.curtain.variables import labelled

if TYPE_CHECKING:
    import xarray as xr

_LAW_POINTS = 61


def laws_dataset(unit: LevelCurtain) -> xr.Dataset:
    """Return all load laws: of the section by the mean square, of the plan by the section's load."""
    import xarray as xr

    curtain, drag = unit.curtain, unit.statics.section.drag_coefficient
    square = (unit.unit_normal_speed * unit.surface_speed) ** 2
    pressure = 0.5 * unit.water.density * drag * square
    # the plan's laws share the load that the section really has; that of an upright plate stands in the comparison
    line = unit.statics.section.load
    sections = section_laws(unit.depth, curtain.skirt.toe_load, pressure, curtain.skirt.stiffness)
    data: dict[str, Any] = {"pressure": ((), pressure), "line_load": ((), line)}
    for name in ("effective_depth", "flare", "top_tension", "horizontal_load", "top_angle"):
        data[f"law_{name}"] = ("section_law", [getattr(law, name) for law in sections])
    points = [_section_points(law, curtain.skirt.toe_load / pressure) for law in sections]
    data["law_section_x"] = (("section_law", "law_point"), [part[0] for part in points])
    data["law_section_z"] = (("section_law", "law_point"), [part[1] for part in points])
    coords: dict[str, Any] = {"section_law": [law.name for law in sections]}
    if curtain.length > curtain.span:
        plans = plan_laws(curtain.span, curtain.length, line, unit.hanging.axial_stiffness)
        coords["plan_law"] = [law.name for law in plans]
        for ours, theirs in (
            ("law_plan_tension", "tension"),
            ("law_sag", "sag"),
            ("law_downstream_end_force", "downstream_end_force"),
            ("law_inward_end_force", "inward_end_force"),
        ):
            data[ours] = ("plan_law", [getattr(law, theirs) for law in plans])
        along = np.linspace(0.0, curtain.span, _LAW_POINTS)
        data["law_plan_x"] = (("plan_law", "law_point"), [_plan_points(law, along, line) for law in plans])
        data["law_plan_y"] = (("plan_law", "law_point"), [along for _ in plans])
    return labelled(xr.Dataset(data, coords=coords))


def _section_points(law: SectionLaw, radius: float) -> tuple[Array, Array]:
    """Return the section of a law, x downstream and z below its top, evenly spaced in the angle or the length."""
    if math.isnan(law.effective_depth):
        return np.full(_LAW_POINTS, math.nan), np.full(_LAW_POINTS, math.nan)
    share = np.linspace(0.0, 1.0, _LAW_POINTS)
    if law.name == "rigid":
        return law.flare * share, -law.effective_depth * share
    if law.name == "circular":
        turn = law.top_angle * (1.0 - share)
        x, z = radius * (1.0 - np.cos(turn)), radius * np.sin(turn)
    else:
        # from the toe: height a arsinh(s/a), flare sqrt(a^2 + s^2) - a
        s = radius * np.tan(law.top_angle) * (1.0 - share)
        x, z = s * s / (np.hypot(radius, s) + radius), radius * np.arcsinh(s / radius)
    return law.flare - x, z - law.effective_depth


def _plan_points(law: PlanLaw, along: Array, line_load: float) -> Array:
    """Return the deflection of a plan law at places along the span."""
    span = along[-1]
    if law.name == "rigid" or law.tension == 0.0:
        return np.zeros_like(along)
    centred = along - 0.5 * span
    values: Array
    if law.name == "circular":
        radius = law.tension / line_load
        values = np.sqrt(np.maximum(radius**2 - centred**2, 0.0)) - (radius - law.sag)
        return values
    if law.name == "small sag":
        values = law.sag * (1.0 - (2.0 * centred / span) ** 2)
        return values
    a = law.tension / line_load
    values = 2.0 * a * np.sinh(0.5 * (0.5 * span + centred) / a) * np.sinh(0.5 * (0.5 * span - centred) / a)
    return values
