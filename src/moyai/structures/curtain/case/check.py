"""Checks of a curtain case: does it hang, float and fit its water; do its analyses have what they need."""

from __future__ import annotations

import math
from pathlib import Path
from typing import TYPE_CHECKING, Any

from moyai.case.check_sea import (
    LARGEST_USUAL_ANGLE_DEG,
    along,
    check_file,
    check_level_names,
    check_surroundings,
    check_waves,
)
from moyai.case.findings import Findings
from moyai.case.schema_environment import PeriodRange
from moyai.case.yaml_reader import KeyPath
from moyai.core.errors import InputError

if TYPE_CHECKING:
    from moyai.structures.curtain.case.schema import CurtainCase

#: Wave periods of one run of a whole span: a run keeps 20000 rows, and 40 of them draw a period.
MOST_PERIODS = 500
_STRENGTHS: tuple[tuple[str, ...], ...] = (
    ("cables", "upper", "breaking_load"),
    ("cables", "lower", "breaking_load"),
    ("skirt", "strength"),
    ("joints", "strength"),
    ("anchors", "breaking_load"),
    ("anchors", "holding_force"),
)


def check(model: CurtainCase, findings: Findings, folder: Path) -> None:
    """Record every fault and warning of a curtain case in ``findings``."""
    check_surroundings(model, findings, folder)
    _check_needs(model, findings)
    _check_settings(model, findings)
    _check_depths(model, findings)
    _check_slack(model, findings)
    _check_directions(model, findings)
    _check_class(model, findings)
    _check_dynamic(model, findings)
    _check_record(model, findings, folder)
    _check_by_building(model, findings, folder)


def _check_needs(model: CurtainCase, findings: Findings) -> None:
    """Check keys that an analysis or another key makes necessary."""
    asked, unit = set(model.analyses), model.structure
    if "statics" in asked and model.current is None:
        findings.fault(("analyses",), "the analysis 'statics' needs 'current'", remedy="give its speed and heading")
    for name in ("waves", "anchor_loads"):
        if name in asked and not model.waves:
            findings.fault(("analyses",), f"the analysis '{name}' needs 'waves'", remedy="give a sea state")
    if "impact" in asked and model.current is None and model.settings.impact.start_speed is None:
        findings.fault(
            ("analyses",),
            "the analysis 'impact' needs a start speed",
            remedy="give a current, or the start speed of the impact",
        )
    if "anchor_loads" in asked:
        _check_anchor_loads(model, findings)
    if unit.toe.kind == "held" and unit.cables.lower is None:
        findings.fault(
            ("structure", "toe", "kind"), "a held toe needs 'structure.cables.lower'", remedy="give the lower cable"
        )
    for side in ("upper", "lower"):
        cable = getattr(unit.cables, side)
        if cable is not None and cable.axial_stiffness == math.inf and {"impact", "waves"} & asked:
            findings.fault(
                ("structure", "cables", side, "axial_stiffness"),
                "an inextensible cable has no impact tension: the models need its stretch",
                remedy="give EA, or leave the analyses 'impact' and 'waves' out",
            )
    if unit.drag.law == "constant" and unit.drag.blockage is not None:
        findings.warn(
            ("structure", "drag", "blockage"),
            "a constant coefficient does not depend on the blockage, so the values given change nothing",
            remedy="give a law that depends on it (gap_speed, closure, table), or widen 'range'",
        )
    if unit.passing_fraction < 1.0 and unit.drag.law in ("gap_speed", "closure"):
        findings.warn(
            ("structure", "passing_fraction"),
            f"the drag law '{unit.drag.law}' assumes that all of the flow passes under the toe, but only "
            f"{unit.passing_fraction:g} of what is held up goes there",
            allowed="1 with this law",
        )
    if "limits" in asked and not _judged(model):
        findings.warn(
            ("analyses",),
            "the analysis 'limits' has no strength to hold loads against; only floats, depth and breaking limit",
            remedy="give the strengths of the components",
        )


def _judged(model: CurtainCase) -> bool:
    return any(_value(model.structure, keys) is not None for keys in _STRENGTHS) or any(
        getattr(cable, "catalogue", None) for cable in (model.structure.cables.upper, model.structure.cables.lower)
    )


def _check_anchor_loads(model: CurtainCase, findings: Findings) -> None:
    loads = model.settings.anchor_loads
    if model.structure.anchors is None:
        findings.fault(
            ("analyses",), "the analysis 'anchor_loads' needs 'structure.anchors'", remedy="give the anchor lines"
        )
    if loads is None:
        findings.fault(
            ("analyses",),
            "the analysis 'anchor_loads' needs 'settings.anchor_loads' with 'energy_factor' and 'float_mass'",
            remedy="give M and m_B; no value of m_B follows from the paper",
        )
    elif loads.float_mass is None:
        findings.fault(
            ("settings", "anchor_loads", "float_mass"),
            "the key 'float_mass' is missing: m_B, the mass of the float per anchor rope",
            remedy="give it; no value follows from the paper, so there is no default",
        )


def _value(block: Any, keys: tuple[str, ...]) -> Any:
    for key in keys:
        block = getattr(block, key, None)
        if block is None:
            return None
    return block


def _check_settings(model: CurtainCase, findings: Findings) -> None:
    check_level_names(model, findings)
    for key in ("speeds", "heights"):
        values = getattr(model.settings.limits, key)
        if hasattr(values, "first") and values.first >= values.last:
            findings.fault(
                ("settings", "limits", key), "'from' is not below 'to'", remedy="give the lower one under 'from'"
            )
    angle = model.settings.limits.wave_angle_deg
    if angle is not None and abs(angle) > 90.0:
        findings.fault(
            ("settings", "limits", "wave_angle_deg"),
            f"waves at {angle:g} degrees from the normal of the curtain",
            allowed="-90 to 90 degrees",
            remedy="measure the angle from the other side of the curtain",
        )
    for index, state in enumerate(model.waves):
        periods = getattr(state, "periods", None)
        if isinstance(periods, PeriodRange) and periods.first == periods.last:
            path: KeyPath = ("waves", index, "periods")
            path = path if path in findings.document.values else ("waves", "periods")
            findings.fault(path, "'from' and 'to' are equal", remedy="give 'period' alone, or widen the range")


def _levels_run(model: CurtainCase) -> list[str]:
    """Return the water levels that the settings take, all of the site unless they name some."""
    levels, chosen = model.site.water_levels, model.settings.water_levels
    return list(levels) if isinstance(chosen, str) else [name for name in chosen if name in levels]


def _check_depths(model: CurtainCase, findings: Findings) -> None:
    """Check the skirt against the depth of every water level that is run."""
    unit, site = model.structure, model.site
    for name in _levels_run(model):
        depth = site.water_depth + site.water_levels[name]
        if depth <= 0.0 or unit.skirt.length <= depth:
            continue
        if unit.may_lie_on_bed:
            findings.warn(
                ("structure", "skirt", "length"),
                f"the skirt of {unit.skirt.length:g} m lies on the bed at {name}, {depth:g} m deep, unless the current "
                "lifts it: its toe is then taken as held by the bed under the top, without flow under it",
            )
            continue
        findings.fault(
            ("structure", "skirt", "length"),
            f"the skirt of {unit.skirt.length:g} m is longer than the water is deep at {name}, {depth:g} m",
            allowed=f"at most {depth:g} m",
            remedy="shorten the skirt, or set 'may_lie_on_bed: true' in 'structure'",
        )


def _check_slack(model: CurtainCase, findings: Findings) -> None:
    """Check that a curtain whose impact is asked for can be slack, and that one without stretch is long enough."""
    unit = model.structure
    snapping = [name for name in ("impact", "waves") if name in model.analyses]
    if unit.length < unit.span and snapping:
        findings.fault(
            ("structure", "length"),
            f"the curtain of {unit.length:g} m is shorter than its span of {unit.span:g} m: it is never slack, so the "
            f"models A, A2, B and AB of {' and '.join(repr(name) for name in snapping)} have no meaning",
            allowed=f"at least {unit.span:g} m",
            remedy="leave these analyses out: 'statics' takes a shorter curtain as pretension",
        )
    stiff = unit.cables.upper.axial_stiffness == math.inf or (
        unit.toe.kind == "held" and unit.cables.lower is not None and unit.cables.lower.axial_stiffness == math.inf
    )
    if unit.length <= unit.span and stiff:
        findings.fault(
            ("structure", "length"),
            f"a curtain of {unit.length:g} m that does not stretch over a span of {unit.span:g} m",
            allowed=f"more than {unit.span:g} m",
            remedy="give more length, or EA of the cables",
        )
    from moyai.structures.curtain.impact.skirt import LEAST_CHORD

    chord = model.settings.impact.chord
    if chord is not None and chord >= unit.skirt.length:
        findings.fault(
            ("settings", "impact", "chord"),
            f"the chord of {chord:g} m is not shorter than the skirt of {unit.skirt.length:g} m",
            allowed=f"{LEAST_CHORD * unit.skirt.length:.5g} to {unit.skirt.length:g} m, both excluded",
            remedy="the skirt must bulge",
        )


def _check_directions(model: CurtainCase, findings: Findings) -> None:
    """Check that the current flows across the curtain from its upstream side."""
    from moyai.case.headings import heading_of

    if model.current is None or not findings.sound("current", "site"):
        return
    try:
        heading = heading_of(model.current, model.site.x_axis_bearing_deg, "current")
    except InputError:
        return
    angle = math.degrees(math.remainder(heading - math.radians(model.structure.normal_deg), 2.0 * math.pi))
    if abs(angle) <= LARGEST_USUAL_ANGLE_DEG:
        return
    key = next(
        key for key in ("heading_deg", "from_bearing_deg", "to_bearing_deg") if getattr(model.current, key) is not None
    )
    if abs(angle) < 90.0 - 1e-9:
        along(("current", key), "current", angle, "the curtain", findings)
        return
    findings.fault(
        ("current", key),
        f"the current flows {abs(angle):.4g} degrees from the normal of the curtain",
        allowed="less than 90 degrees",
        remedy="turn 'structure.normal_deg' to the downstream side; along the curtain only friction acts",
    )


def _check_dynamic(model: CurtainCase, findings: Findings) -> None:
    """Check what the dynamic analysis needs beyond the others."""
    given, unit = model.settings.dynamic, model.structure
    if "dynamic" not in model.analyses:
        serves = given.by_default and bool({"impact", "waves"} & set(model.analyses))
        if "dynamic" in model.settings.model_fields_set and not serves:
            findings.warn(("settings", "dynamic"), "the analysis 'dynamic' is not asked for; these settings do nothing")
        return
    if not model.waves and model.current is None and model.settings.impact.start_speed is None:
        findings.fault(
            ("analyses",),
            "the analysis 'dynamic' needs 'waves', 'current', or 'settings.impact.start_speed'",
            remedy="give what moves the curtain",
        )
    if unit.skirt.stiffness == math.inf:
        findings.fault(
            ("structure", "skirt", "stiffness"),
            "the analysis 'dynamic' needs a skirt that stretches",
            allowed="modulus times thickness",
        )
    if given.sheet_mass is None and unit.skirt.mass_per_area is None and unit.skirt.film is None:
        findings.fault(
            ("settings", "dynamic"),
            "the analysis 'dynamic' needs the mass of the sheet",
            remedy="give 'settings.dynamic.sheet_mass', or 'mass_per_area' with 'sheet_density' in 'structure.skirt'",
        )
    loads = model.settings.anchor_loads
    if unit.anchors is not None and given.support_mass is None and (loads is None or loads.float_mass is None):
        findings.fault(
            ("settings", "dynamic"),
            "the buoys of anchored supports need 'settings.dynamic.support_mass' or 'settings.anchor_loads.float_mass'",
            remedy="give the mass of one buoy with its added mass, or leave the anchors out for fixed supports",
        )
    if unit.length <= unit.span:
        findings.fault(
            ("structure", "length"),
            f"the curtain of {unit.length:g} m is not longer than its span: the analysis 'dynamic' starts from slack",
            allowed=f"more than {unit.span:g} m",
        )
    for side in ("upper", "lower"):
        cable = getattr(unit.cables, side)
        if cable is not None and cable.axial_stiffness == math.inf:
            findings.fault(
                ("structure", "cables", side, "axial_stiffness"),
                "the analysis 'dynamic' needs cables that stretch",
                remedy="give EA",
            )
    if given.shear_stiffness > 0.0 and given.span_stiffness == 0.0:
        findings.fault(
            ("settings", "dynamic", "shear_stiffness"),
            "a shear stiffness of a sheet without 'span_stiffness'",
            remedy="give both, or neither",
        )
    # rows of a run are counted out; more periods would be kept more coarsely than their snaps
    longest = 1 + given.settled_periods + max(given.analysed_periods, given.wave_count)
    if model.waves and longest > MOST_PERIODS:
        findings.fault(
            ("settings", "dynamic"),
            f"a run of {longest} wave periods",
            allowed=f"at most {MOST_PERIODS}, with the one in which the waves grow",
            remedy="give fewer 'settled_periods' and 'analysed_periods', or a smaller 'wave_count'; the analysis "
            "'waves' takes thousands",
        )
    if given.start == "drifting" and model.current is None and model.settings.impact.start_speed is None:
        findings.fault(
            ("settings", "dynamic", "start"),
            "a drifting start needs a speed",
            remedy="give a current, or the start speed of the impact",
        )
    if given.start == "released" and model.current is None:
        findings.fault(
            ("settings", "dynamic", "start"),
            "a released curtain needs a current to become taut",
            remedy="give 'current', or another start",
        )
    for name in _levels_run(model):
        depth = model.site.water_depth + model.site.water_levels[name]
        if 0.0 < depth <= unit.skirt.length and findings.sound("structure"):
            findings.fault(
                ("analyses",),
                f"the analysis 'dynamic' needs water under the toe; the skirt of {unit.skirt.length:g} m reaches the "
                f"bed at {name}, {depth:g} m deep",
                allowed=f"a skirt shorter than {depth:g} m, or other 'settings.water_levels'",
            )


def _check_class(model: CurtainCase, findings: Findings) -> None:
    from moyai.tables.curtain_classes import curtain_class

    if model.structure.curtain_class is not None:
        try:
            curtain_class(model.structure.curtain_class)
        except InputError as error:
            fault = error.fault
            findings.fault(("structure", "curtain_class"), fault.message, allowed=fault.allowed, remedy=fault.remedy)


def _check_record(model: CurtainCase, findings: Findings, folder: Path) -> None:
    if model.record is None:
        return
    if "impact" not in model.analyses:
        findings.warn(("record",), "the record is compared with the analysis 'impact', which is not requested")
    if check_file(("record", "file"), model.record.file, folder, findings):
        from moyai.structures.curtain.case.build import recorded_snap

        try:
            recorded_snap(model.record, folder)
        except InputError as error:
            findings.raised(error, ("record", "file"))


def _heading_check(normal_deg: float) -> Any:
    def judge(state: Any, heading: float, path: KeyPath, findings: Findings) -> None:
        angle = math.degrees(math.remainder(heading - math.radians(normal_deg), 2.0 * math.pi))
        if abs(angle) <= LARGEST_USUAL_ANGLE_DEG:
            return
        key = "from_bearing_deg" if getattr(state, "from_bearing_deg", None) is not None else "heading_deg"
        if abs(angle) <= 90.0 + 1e-9:
            along((*path, key), "waves", angle, "the curtain", findings)
            return
        findings.fault(
            (*path, key),
            f"the waves travel {abs(angle):.4g} degrees from the normal of the curtain",
            allowed="at most 90 degrees",
            remedy="measure the angle from the other side of the curtain",
        )

    return judge


def _check_by_building(model: CurtainCase, findings: Findings, folder: Path) -> None:
    """Build what is sound: seas against breaking, shapes and catalogues, then the curtain in its water."""
    from moyai.case.build_sea import environment_of
    from moyai.sea.water import Water
    from moyai.structures.curtain.case.build import build_problem, curtain_of
    from moyai.structures.curtain.case.check_water import check_in_water

    water = Water(model.site.water_depth, model.site.density, model.site.gravity)
    levels = any(fault.path.startswith("settings.water_levels") for fault in findings.faults)
    if findings.sound("site", "waves") and not levels:
        calm = model.model_copy(update={"current": None})
        try:
            environment = environment_of(calm, water, folder)
        except InputError as error:
            findings.raised(error, ("waves",))
        else:
            check_waves(model, environment, findings, _heading_check(model.structure.normal_deg))
    if findings.sound("site", "structure", "settings"):
        try:
            curtain_of(model, water)
        except InputError as error:
            findings.raised(error, ("structure",))
    if not findings.faults:
        try:
            problem = build_problem(model, folder)
        except InputError as error:
            findings.raised(error, ("structure",))
        else:
            check_in_water(problem, findings)
