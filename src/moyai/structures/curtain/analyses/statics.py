"""The curtain at rest: shape, forces, load laws side by side, the paper's equations, practice."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from moyai.core.arrays import Array
from moyai.core.errors import InputError
from moyai.core.validity import IdentityCheck, Notice
from moyai.sea.current import CurrentProfile
from moyai.structures.curtain.analyses.laws import laws_dataset
from moyai.structures.curtain.analyses.steady import steady_variables
from moyai.structures.curtain.assembly import LevelCurtain
from moyai.structures.curtain.checks import check_class, check_site_class, check_statics
from moyai.structures.curtain.limits.search import Limit
from moyai.structures.curtain.limits.utilisation import anchor_spacing, fixed_failures, joint_spacing
from moyai.structures.curtain.model import UNJUDGED
from moyai.structures.curtain.statics.closed_forms import solve_cable, solve_skirt_arc
from moyai.structures.curtain.statics.drag import sample_pressure
from moyai.structures.curtain.statics.hanging import CurtainStatics, submerged_state
from moyai.structures.curtain.statics.on_bed import check_on_bed
from moyai.structures.curtain.statics.planning import itopf_load, us_navy_load
from moyai.structures.curtain.variables import labelled
from moyai.tables.curtain_classes import curtain_class, mildest_class

if TYPE_CHECKING:
    import xarray as xr

#: Difference of two blockages up to which they are the same
_LIKE_BLOCKAGE = 0.05
DRAG_CASES = ("low", "given", "high")
#: Distance of the anchors up to which a limit is sought, over the span of the case [-]
_LONGEST_SPANS = 3.0
_SECTION_POINTS = 61


def drag_cases(unit: LevelCurtain) -> tuple[CurtainStatics, CurtainStatics, CurtainStatics]:
    """Return the statics with the drag coefficient at the low end of its range, as given, and at the high end.

    Raises
    ------
    InputError
        When one of them has no equilibrium.
    """
    if unit.nominal:
        return unit.statics, unit.statics, unit.statics
    law = unit.hanging.drag
    low, high = (
        unit.site.statics(replace(unit.hanging, drag=law.scaled(factor)), unit.surface_speed) for factor in law.range
    )
    return low, unit.statics, high


def statics_groups(unit: LevelCurtain, significant_height: float) -> dict[str, xr.Dataset]:
    """Return the groups ``statics``, ``statics_laws``, ``statics_paper``, ``section`` and ``plan`` of a level.

    Parameters
    ----------
    unit : LevelCurtain
        With a current.
    significant_height : float
        Largest of the sea states [m], for the classes; 0 without waves.
    """
    cases = drag_cases(unit)
    return {
        "statics": _statics(unit, cases, significant_height),
        "statics_laws": laws_dataset(unit),
        "statics_paper": _paper(unit),
        "section": _section(unit, cases),
        "plan": _plan(unit, cases),
    }


def _statics(unit: LevelCurtain, cases: tuple[CurtainStatics, ...], significant_height: float) -> xr.Dataset:
    import xarray as xr

    curtain, water, given = unit.curtain, unit.water, unit.statics
    deep = math.isinf(water.depth)
    rows: dict[str, list[float]] = {
        "drag_coefficient": [case.section.drag_coefficient for case in cases],
        "blockage": [case.section.blockage for case in cases],
        "hanging_length": [case.section.skirt.length for case in cases],
        "effective_depth": [case.section.effective_depth for case in cases],
        "flare": [case.section.flare for case in cases],
        "toe_depth": [case.section.toe_depth for case in cases],
        "toe_gap": [math.nan if deep else case.toe_gap for case in cases],
        "toe_speed": [case.toe_speed for case in cases],
        "toe_speed_ratio": [case.toe_speed_ratio for case in cases],
        "toe_speed_undisturbed": [case.toe_speed / case.toe_speed_ratio for case in cases],
        "section_load": [case.section.load for case in cases],
        "top_load": [case.section.top_load for case in cases],
        "toe_hold": [case.section.toe_hold for case in cases],
        "top_pull": [case.section.top_pull for case in cases],
        "sheet_tension": [case.section.sheet_tension for case in cases],
        "cable_tension": [case.plan.tension for case in cases],
        "upper_tension": [case.upper_tension for case in cases],
        "lower_tension": [case.lower_tension for case in cases],
        "sag": [case.plan.sag for case in cases],
        "strain": [case.plan.strain for case in cases],
        "end_angle": [float(np.max(np.abs(case.plan.angle))) for case in cases],
        "anchor_horizontal_tension": [case.anchor_horizontal_tension for case in cases],
        "end_anchor_horizontal_tension": [case.end_anchor_horizontal_tension for case in cases],
        "anchor_tension": [case.anchor_tension for case in cases],
        "float_reserve": [case.float_reserve for case in cases],
        "float_reserve_ratio": [case.reserve_ratio for case in cases],
    }
    sunk = submerged_state(unit.hanging, water)
    spacing = _anchor_spacing(unit)
    pressure = 0.5 * water.density * given.section.drag_coefficient * unit.normal_speed**2
    joint, highest = curtain.strengths.joint, unit.steady.band("line_load")[1]
    scalars: dict[str, float] = {
        "span": curtain.span,
        "unstretched_length": curtain.length,
        "span_ratio": curtain.span / curtain.length,
        "skirt_length": curtain.skirt.length,
        "surface_speed": unit.surface_speed,
        "normal_speed": unit.normal_speed,
        "flow_angle": unit.flow_angle,
        "froude_number": 0.0 if deep else unit.normal_speed / math.sqrt(water.gravity * water.depth),
        "load_ratio": pressure * curtain.skirt.length / curtain.skirt.toe_load,
        "drowning_speed": unit.drowning_speed,
        "joint_spacing": math.nan if joint is UNJUDGED else joint_spacing(highest, joint, curtain.span),
        "anchor_spacing": spacing.value if spacing.reached else math.inf,
        **_at_slack_water(unit),
        "flooded_net_weight": sunk.net_weight,
        "flooded_sinks": float(sunk.sinks),
        "air_to_surface": sunk.air_to_surface,
        "holding_buoyancy": sunk.holding_buoyancy,
    }
    area = curtain.span * given.section.effective_depth
    formulas = [formula(area, abs(unit.normal_speed), water.density) for formula in (us_navy_load, itopf_load)]
    lightest = mildest_class(significant_height, unit.surface_speed)
    more, coords = steady_variables(unit)
    data = xr.Dataset(
        {
            **more,
            **{name: ("drag_case", values) for name, values in rows.items()},
            **{name: ((), value) for name, value in scalars.items()},
            "planning_load": ("planning_formula", [formula.force for formula in formulas]),
            "planning_drag_coefficient": ("planning_formula", [formula.drag_coefficient for formula in formulas]),
            "planning_confirmed": ("planning_formula", [float(formula.confirmed) for formula in formulas]),
        },
        coords={
            **coords,
            "drag_case": list(DRAG_CASES),
            "planning_formula": [formula.name for formula in formulas],
        },
        attrs={
            "curtain_class": curtain.curtain_class,
            "class_for_site": "none" if lightest is None else lightest.name,
        },
    )
    data = labelled(data)
    data["anchor_spacing"].attrs |= {
        "governing": spacing.governing,
        "searched": _LONGEST_SPANS * curtain.span,
        "fails_at_any_distance": ", ".join(fixed_failures(given, unit.requirements)),
    }
    data["joint_spacing"].attrs["searched"] = curtain.span
    return data


def _at_slack_water(unit: LevelCurtain) -> dict[str, float]:
    """Return toe clearance and float reserve of a curtain that hangs straight down without a current.

    The flared skirt of a curtain in its current stands higher, and the load carries part of its weight: both numbers
    are on the favourable side there. Its ends are those of the range of the toe's weight; of a held toe it is as if the
    lower cable bore nothing of it.
    """
    hanging, depth = unit.hanging, unit.water.depth
    skirt, floats = hanging.skirt, hanging.floats
    gap = math.nan if math.isinf(depth) else max(depth - skirt.length, 0.0)
    name = "slack_float_reserve_ratio"
    lightest, heaviest = unit.curtain.toe_range
    left = {
        end: 1.0 - unit.slack_float_load(factor) / floats.buoyancy
        for end, factor in (("", 1.0), ("_low", max(heaviest, 1.0)), ("_high", min(lightest, 1.0)))
    }
    return {"slack_toe_gap": gap} | {f"{name}{end}": value for end, value in left.items()}


def _anchor_spacing(unit: LevelCurtain) -> Limit:
    strengths = unit.curtain.strengths
    if all(part is UNJUDGED for part in (strengths.upper_cable, strengths.anchor_line, strengths.anchor)):
        return Limit(math.nan, "no strength given")
    if unit.nominal:
        return Limit(math.nan, "left out of a draft")
    return anchor_spacing(
        unit.hanging,
        unit.site,
        unit.requirements,
        speed=unit.surface_speed,
        longest=_LONGEST_SPANS * unit.curtain.span,
        wave_tension=0.0,
        load_factor=unit.steady.factor,
    )


def _paper(unit: LevelCurtain) -> xr.Dataset:
    """Return equations (2) to (6) with the load of the general solution."""
    import xarray as xr

    curtain, statics = unit.curtain, unit.statics
    load, stiffness = statics.section.load, unit.hanging.axial_stiffness
    cable = solve_cable(curtain.span, curtain.length, load, stiffness)
    # a cable that does not stretch must be longer than its span
    rigid = (
        float(solve_cable(curtain.span, curtain.length, load).tension) if curtain.length > curtain.span else math.nan
    )
    out = {
        "paper_cable_tension_inextensible": rigid,
        "paper_cable_tension": float(cable.tension),
        "paper_sag": float(cable.sag),
        "paper_shape_number": float(cable.shape_number),
    }
    names = ("chord", "paper_skirt_tension", "paper_edge_load", "paper_skirt_radius", "paper_skirt_sagitta")
    out |= dict.fromkeys(names, math.nan)
    chord = math.hypot(statics.section.effective_depth, statics.section.flare)
    length = statics.section.skirt.length
    if unit.curtain.toe == "held" and (chord < length or math.isfinite(curtain.skirt.stiffness)):
        arc = solve_skirt_arc(chord, length, load / chord, curtain.skirt.stiffness)
        found = (chord, arc.tension, arc.edge_load, arc.radius, arc.sagitta)
        out |= {name: float(np.asarray(value)) for name, value in zip(names, found)}
    return labelled(xr.Dataset({name: ((), value) for name, value in out.items()}))


def _even(values: tuple[Array, ...], along: Array, count: int) -> tuple[Array, ...]:
    even = np.linspace(along[0], along[-1], count)
    return tuple(np.interp(even, along, value) for value in values)


def _section(unit: LevelCurtain, cases: tuple[CurtainStatics, ...]) -> xr.Dataset:
    import xarray as xr

    parts = [
        _even((c.section.x, c.section.z, c.section.tension, c.section.angle), c.section.arc, _SECTION_POINTS)
        for c in cases
    ]
    names = ("section_x", "section_z", "section_tension", "section_angle")
    data: dict[str, Any] = {
        name: (("drag_case", "section_point"), [part[k] for part in parts]) for k, name in enumerate(names)
    }
    low = -unit.water.depth if math.isfinite(unit.water.depth) else -2.0 * unit.curtain.skirt.length
    z = np.linspace(low, 0.0, 81)
    data["profile_z"] = ("profile_point", z)
    data["profile_speed"] = ("profile_point", unit.site.current(unit.surface_speed).component(z, unit.curtain.normal))
    laid = unit.curtain.skirt.length - unit.statics.section.skirt.length
    if laid > 0.0:
        # which way the slack part lies is not known; drawn downstream
        start = unit.statics.section.flare
        data["on_bed_x"] = ("bed_point", np.array([start, start + laid]))
        data["on_bed_z"] = ("bed_point", np.full(2, -unit.water.depth))
    return labelled(xr.Dataset(data, coords={"drag_case": list(DRAG_CASES)}))


def _plan(unit: LevelCurtain, cases: tuple[CurtainStatics, ...]) -> xr.Dataset:
    import xarray as xr

    data: dict[str, Any] = {
        "plan_x": (("drag_case", "plan_point"), [case.plan.x for case in cases]),
        "plan_y": (("drag_case", "plan_point"), [case.plan.y for case in cases]),
        "plan_angle": (("drag_case", "plan_point"), [case.plan.angle for case in cases]),
    }
    anchors = unit.curtain.anchors
    if anchors is not None:
        slope = unit.hanging.anchor_slope
        plan = unit.statics.plan
        down = sum(plan.downstream_end_forces)
        along = plan.inward_end_forces[0] - plan.inward_end_forces[1]
        size = math.hypot(down, along)
        # the line of an inner support pulls against the resultant of both its spans
        reach = anchors.length * math.cos(slope)
        drop = min(anchors.length * math.sin(slope), unit.water.depth)
        supports = np.array([0.0, unit.curtain.span])
        data["float_x"], data["float_y"] = ("anchor", np.zeros(2)), ("anchor", supports)
        data["float_z"] = ("anchor", np.zeros(2))
        data["anchor_x"] = ("anchor", np.full(2, -reach * down / size))
        data["anchor_y"] = ("anchor", supports - reach * along / size)
        data["anchor_z"] = ("anchor", np.full(2, -drop))
    return labelled(xr.Dataset(data, coords={"drag_case": list(DRAG_CASES)}))


def _given_blockage(unit: LevelCurtain) -> list[Notice]:
    """Tell which of two blockages governs: that of the case, or that of the skirt as it hangs."""
    given, found = unit.curtain.drag.given_blockage, unit.statics.section.blockage
    if math.isnan(given) or abs(given - found) <= _LIKE_BLOCKAGE * given:
        return []
    why = "its skirt flares" if found < given else "its skirt is longer than that"
    return [
        Notice(
            "curtain-blockage-given",
            f"the blockage of the case, {given:.3g}, governs the drag coefficient; the curtain in equilibrium fills "
            f"{found:.3g} of the depth, since {why}",
            found, given, "information", "leave the blockage of the drag out to take that of the equilibrium",
        )
    ]  # fmt: skip


def statics_notices(unit: LevelCurtain, significant_height: float) -> tuple[Notice, ...]:
    """Return where the curtain at rest leaves practice, its class, or the range of its formulas."""
    statics, curtain = unit.statics, unit.curtain
    notices = list(check_statics(statics, abs(unit.normal_speed), unit.water))
    if curtain.drag.name != "constant":
        # the coefficient was taken at a blockage that the case gives
        notices = [notice for notice in notices if notice.code != "curtain-blockage"]
    notices += _given_blockage(unit)
    if unit.site.on_bed:
        notices += check_on_bed(statics, unit.water)
    if curtain.curtain_class:
        strength = curtain.strengths.sheet
        notices += check_class(
            curtain_class(curtain.curtain_class),
            significant_height,
            unit.surface_speed,
            statics,
            curtain.toe_chain if math.isfinite(curtain.toe_chain) else curtain.skirt.toe_load / unit.water.gravity,
            strength.capacity,
        )
    notices += check_site_class(significant_height, unit.surface_speed)
    return tuple(notices)


def statics_checks(unit: LevelCurtain) -> tuple[IdentityCheck, ...]:
    """Return the identities of the curtain at rest: equilibrium in section and plan, length, top."""
    statics = unit.statics
    section, plan = statics.section, statics.plan
    current = unit.site.current(unit.surface_speed)
    name = unit.name
    checks = [
        IdentityCheck(
            f"{name}: the section hangs from its top", section.residual, 1e-9, "height of the top, over the length"
        ),
        IdentityCheck(
            f"{name}: equilibrium of the section",
            _section_miss(unit, current),
            2e-3,
            "load of the current over the drawn shape = forces at top and toe",
        ),
        IdentityCheck(
            f"{name}: length of the curtain in plan",
            abs(float(plan.arc[-1]) / (plan.length * (1.0 + plan.strain)) - 1.0),
            1e-4,
            "arc of the drawn shape = l (1 + T/EA); a load law that bends within a piece costs digits",
        ),
        IdentityCheck(
            f"{name}: the curtain ends at its supports",
            math.hypot(float(plan.x[-1]), float(plan.y[-1]) - plan.span) / plan.span,
            1e-4,
            "last point of the drawn shape = second support",
        ),
        IdentityCheck(f"{name}: equilibrium of the floats", _float_miss(statics), 1e-12, "sum of vertical forces = 0"),
    ]
    return tuple(checks)


def _section_miss(unit: LevelCurtain, current: CurrentProfile) -> float:
    """Integrate the load of the current over the drawn section and compare with what top and toe hold."""
    section = unit.statics.section
    x, z = section.x, section.z
    pressure = section.drag_coefficient * sample_pressure(
        current, unit.statics.section_heading, np.maximum(0.5 * (z[1:] + z[:-1]), -unit.water.depth), unit.water.density
    )
    step = np.hypot(np.diff(x), np.diff(z))
    down = -np.diff(z) / step
    share = {
        "normal_velocity": down * np.abs(down),
        "uniform_normal": np.ones_like(down),
        "free_streamline": (4.0 + math.pi) * down / (4.0 + math.pi * np.abs(down)),
    }[unit.curtain.law]
    load = pressure * step * share
    # normal to the sheet, downstream
    return abs(float(np.sum(load * down)) / section.load - 1.0)


def _float_miss(statics: CurtainStatics) -> float:
    curtain = statics.curtain
    lines = max(statics.anchor_tension, 2.0 * curtain.pretension) * math.sin(curtain.anchor_slope) / curtain.span
    total = curtain.floats.weight + statics.section.top_pull + lines + statics.float_reserve
    return abs(total / curtain.floats.buoyancy - 1.0)


def require_current(unit: LevelCurtain) -> None:
    """Refuse what only a current gives.

    Raises
    ------
    InputError
        Without a current.
    """
    if unit.surface_speed == 0.0:
        raise InputError("there is no current", parameter="current", remedy="give its speed and heading")
