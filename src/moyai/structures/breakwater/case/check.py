"""Checks of a breakwater case: does it float, does it fit into its water, do its lines make sense."""

from __future__ import annotations

import math
from pathlib import Path
from typing import TYPE_CHECKING, Any

from moyai.case.chain_on_bed import check_chain_on_bed
from moyai.case.check_catalogue import SAID_OTHERWISE, check_catalogue, line_place
from moyai.case.check_sea import check_file, check_level_names, check_surroundings, check_waves
from moyai.case.findings import Findings, duplicates
from moyai.case.schema_environment import PeriodRange
from moyai.case.schema_lines import CatalogueSegment, CatenaryLine, SpringLineKeys
from moyai.case.yaml_reader import KeyPath
from moyai.core.errors import ConvergenceError, InputError
from moyai.structures.breakwater.case.check_lines import (
    across_the_hull,
    check_sides,
    count_panels,
    off_the_hull,
)
from moyai.structures.breakwater.case.schema import MeasuredColumns

if TYPE_CHECKING:
    from collections.abc import Callable

    from moyai.core.validity import Notice
    from moyai.potential.sections import Hull
    from moyai.structures.breakwater.case.schema import BreakwaterCase
    from moyai.structures.breakwater.model import Breakwater, BreakwaterProblem, Environment


def check(model: BreakwaterCase, findings: Findings, folder: Path) -> None:
    """Record every fault and warning of a breakwater case in ``findings``."""
    check_surroundings(model, findings, folder)
    _check_needs(model, findings)
    _check_settings(model, findings)
    _check_files(model, findings, folder)
    hull = _hull(model, findings)
    if hull is not None:
        draught = _check_floating(model, hull, findings)
        _check_places_of_lines(model, hull, draught, findings)
    _check_catalogue(model, findings)
    _check_lines_in_motion(model, findings)
    _check_by_statics(model, findings, folder)


def _check_needs(model: BreakwaterCase, findings: Findings) -> None:
    """Check keys that another key makes necessary."""
    unit = model.structure
    for name, key in (("wind", "wind_drag_coefficient"), ("current", "current_drag_coefficient")):
        if getattr(model, name) is not None and getattr(unit, key) is None:
            findings.fault((name,), f"'{name}' needs 'structure.{key}'", remedy="give it, about 1.0 to 2.0 for a box")
    if unit.roll_inertia is not None and unit.mass is None:
        findings.fault(
            ("structure", "roll_inertia"), "'roll_inertia' needs 'mass'", remedy="give 'mass' or 'roll_gyradius'"
        )
    if "time" in model.analyses and not model.waves:
        findings.fault(("analyses",), "the analysis 'time' needs 'waves'", remedy="give a sea state")
    pushed = model.settings.drift or model.wind is not None or model.current is not None
    if not model.lines and pushed and model.waves and {"frequency", "time"} & set(model.analyses):
        findings.fault(
            ("analyses",),
            "nothing holds the unit in sway against drift, wind or current",
            remedy="give 'lines', or set 'settings.drift: false' and leave 'wind' and 'current' out",
        )
    if "mooring" in model.analyses and not model.lines:
        findings.warn(("analyses",), "the analysis 'mooring' has no 'lines' to work on")
    if math.isinf(model.site.water_depth):
        for index, line in enumerate(model.lines):
            if isinstance(line, CatenaryLine):
                findings.fault(
                    ("lines", index, "anchor"),
                    f"line '{line.name}' goes to a bed that is infinitely deep",
                    remedy="give the water depth, or use a spring to a fixed point",
                )
    if unit.gap_damping_lid > 0.0 and unit.section.shape not in ("twin_pontoon", "pi_type", "polygon"):
        findings.warn(("structure", "gap_damping_lid"), f"a {unit.section.shape} has no gap; the lid does nothing")
    for index in duplicates([line.name for line in model.lines]):
        findings.fault(
            ("lines", index, "name"), f"two lines are called '{model.lines[index].name}'", remedy="rename one"
        )


def _check_lines_in_motion(model: BreakwaterCase, findings: Findings) -> None:
    """Check what lines in motion need of the rest of the case."""
    every = model.settings.time.lines.mode == "dynamic"
    moving = [
        (index, line)
        for index, line in enumerate(model.lines)
        if isinstance(line, CatenaryLine) and (line.dynamic or every)
    ]
    if not moving:
        return
    index, first = moving[0]
    if "time" not in model.analyses:
        findings.warn(
            ("lines", index, "dynamic"), "lines are in motion in the analysis 'time' alone, which is not asked for"
        )
    if model.settings.time.memory == "convolution":
        findings.fault(
            ("settings", "time", "memory"),
            "lines in motion need the memory of the water as states",
            allowed="state_space",
            remedy="give memory: state_space, or set dynamic: false",
        )
    for other, line in moving[1:]:
        if line.bed_friction != first.bed_friction:
            findings.fault(
                ("lines", other, "bed_friction"),
                f"line '{line.name}' has a bed friction of {line.bed_friction:g}, '{first.name}' "
                f"of {first.bed_friction:g}",
                allowed="one value for all lines in motion",
                remedy="give them the same 'bed_friction', or set dynamic: false",
            )
    for other, line in moving:
        if line.drag_width > 0.0:
            findings.warn(
                ("lines", other, "drag_width"),
                f"'drag_width' of line '{line.name}' is used in the frequency domain only: a line in motion has its "
                "drag",
            )


def _check_settings(model: BreakwaterCase, findings: Findings) -> None:
    check_level_names(model, findings)
    for key in ("frequencies", "restoring_offsets"):
        values = getattr(model.settings, key)
        if hasattr(values, "first") and values.first == values.last:
            findings.fault(("settings", key), "'from' and 'to' are equal", remedy="widen the range")
    for index, state in enumerate(model.waves):
        periods = getattr(state, "periods", None)
        if isinstance(periods, PeriodRange) and periods.first == periods.last:
            path: KeyPath = ("waves", index, "periods")
            path = path if path in findings.document.values else ("waves", "periods")
            findings.fault(path, "'from' and 'to' are equal", remedy="give 'period' alone, or widen the range")


def _check_files(model: BreakwaterCase, findings: Findings, folder: Path) -> None:
    coefficients = model.structure.coefficients_file
    if coefficients is not None:
        path: KeyPath = ("structure", "coefficients_file", "path")
        check_file(path, coefficients.path, folder, findings, folder_allowed=coefficients.program == "nemoh")
    measured = model.measured
    if isinstance(measured, MeasuredColumns) and check_file(("measured", "file"), measured.file, folder, findings):
        from moyai.case.measured import read_points

        try:
            read_points(folder / measured.file, measured.columns, "measured.file")
        except InputError as error:
            findings.raised(error, ("measured", "file"))


def _hull(model: BreakwaterCase, findings: Findings) -> Hull | None:
    try:
        return model.structure.section.hull()
    except InputError as error:
        key = error.fault.path.split(".")[-1]
        path: KeyPath = ("structure", "section")
        if key in type(model.structure.section).model_fields:
            path = (*path, key)
        elif key == "vertices":
            path = (*path, "points")
        findings.fault(path, error.fault.message, allowed=error.fault.allowed, remedy=error.fault.remedy)
        return None


def _check_floating(model: BreakwaterCase, hull: Hull, findings: Findings) -> float | None:
    """Check draught, mass and clearance under the keel; return the draught where there is one."""
    unit, site = model.structure, model.site
    if abs(hull.bottom) > 1e-9 * hull.height:
        findings.fault(
            ("structure", "section"),
            f"the lowest point of the section is at z = {hull.bottom:g} m",
            allowed="0 m: z is measured from the keel",
        )
        return None
    draught = unit.draught
    if draught is not None and draught >= hull.height:
        findings.fault(
            ("structure", "draught"),
            f"the draught of {draught:g} m is not less than the height of the section, {hull.height:g} m",
            allowed=f"less than {hull.height:g} m",
        )
        return None
    if unit.mass is not None:
        from_mass = _draught_of_mass(model, hull, findings)
        draught = draught if draught is not None else from_mass
    if draught is None:
        return None
    for name, level in site.water_levels.items():
        depth = site.water_depth + level
        lowest = max([draught, *(draught - float(plate.edges.bounds()[2]) for plate in hull.plates)])
        if draught < depth <= lowest:
            findings.fault(
                ("structure", "section", "plates"),
                f"a plate reaches {lowest:.4g} m down in {depth:.4g} m of water at {name}",
                allowed=f"less than {depth - draught:.4g} m below the keel",
                remedy="shorten the plate: it would reach the bed",
            )
        if 0.0 < depth <= draught:
            key = "draught" if unit.draught is not None else "mass"
            findings.fault(
                ("structure", key),
                f"the body is {draught:.4g} m deep in {depth:.4g} m of water at {name}",
                allowed=f"a draught below {depth:.4g} m",
                remedy="it would reach the bed",
            )
    if unit.centre_of_gravity_above_keel > hull.height or unit.centre_of_gravity_above_keel < 0.0:
        findings.warn(
            ("structure", "centre_of_gravity_above_keel"),
            f"the centre of gravity, {unit.centre_of_gravity_above_keel:g} m above the keel, lies outside the section",
            allowed=f"0 to {hull.height:g} m for a body of one piece",
        )
    return draught


def _draught_of_mass(model: BreakwaterCase, hull: Hull, findings: Findings) -> float | None:
    """Return the draught at which the body without lines floats upright; record a body that sinks."""
    unit = model.structure
    per_area = model.site.density * unit.length
    whole = per_area * hull.immersed(hull.height * (1.0 - 1e-12)).area
    if unit.mass is None or unit.mass >= whole:
        findings.fault(
            ("structure", "mass"),
            f"the body of {unit.mass:.6g} kg is heavier than the {whole:.6g} kg it displaces when wholly under water",
            allowed=f"less than {whole:.6g} kg",
            remedy="it sinks: lower the mass or enlarge the section",
        )
        return None
    low, high = 0.0, hull.height
    for _ in range(60):
        middle = 0.5 * (low + high)
        try:
            displaced = per_area * hull.immersed(middle).area
        except InputError:
            displaced = 0.0
        low, high = (middle, high) if displaced < unit.mass else (low, middle)
    return 0.5 * (low + high)


def _check_places_of_lines(model: BreakwaterCase, hull: Hull, draught: float | None, findings: Findings) -> None:
    """Check fairleads against the hull, and anchors against the hull and the water."""
    left, right, _, top = hull.bounds
    for index, line in enumerate(model.lines):
        fairlead: KeyPath = ("lines", index, "fairlead")
        outside = off_the_hull(line, hull.bounds)
        if outside:
            findings.warn(
                fairlead,
                f"line '{line.name}': {outside}",
                allowed=f"x from {left:g} to {right:g} m, 0 to {top:g} m above the keel",
            )
        if abs(line.fairlead.y) > 0.5 * model.structure.length * (1.0 + 1e-9):
            findings.warn(
                (*fairlead, "y"),
                f"the fairlead of '{line.name}' lies beyond the end of the unit",
                allowed=f"-{0.5 * model.structure.length:g} to {0.5 * model.structure.length:g} m",
            )
        if draught is not None:
            _check_anchor(model, line, index, hull, draught, findings)


def _check_anchor(model: BreakwaterCase, line: Any, index: int, hull: Hull, draught: float, findings: Findings) -> None:
    from moyai.potential.edges import inside_polygon

    depth = model.site.water_depth
    x = line.anchor.x
    z = line.anchor.z if isinstance(line, SpringLineKeys) else line.anchor.above_bed - depth
    path: KeyPath = ("lines", index, "anchor")
    if not math.isfinite(z) or abs(line.anchor.y) > 0.5 * model.structure.length:
        return
    import numpy as np

    point = np.array([[x, z + draught]])
    if any(bool(inside_polygon(point, outline.edges.polyline())[0]) for outline in hull.outlines):
        findings.fault(
            path,
            f"the anchor of '{line.name}' at x = {x:g} m, z = {z:g} m lies inside the body",
            remedy="move it outside, normally down to the bed",
        )
    elif not isinstance(line, SpringLineKeys) and hull.bounds[0] < x < hull.bounds[1]:
        findings.warn(
            path,
            f"the anchor of '{line.name}' at x = {x:g} m lies under the body",
            allowed=f"usually beyond {hull.bounds[0]:g} or {hull.bounds[1]:g} m",
        )


def _check_catalogue(model: BreakwaterCase, findings: Findings) -> None:
    for index, line in enumerate(model.lines):
        for number, part in enumerate(getattr(line, "segments", ())):
            if isinstance(part, CatalogueSegment):
                check_catalogue(("lines", index, "segments", number), part.catalogue, part.diameter, findings)


def _check_by_statics(model: BreakwaterCase, findings: Findings, folder: Path) -> None:
    """Build what is sound and put it into its water: waves against breaking, lines at rest, balance."""
    from moyai.case.build_sea import environment_of
    from moyai.sea.water import Water
    from moyai.structures.breakwater.case.build import breakwater_of, build_problem

    water = Water(model.site.water_depth, model.site.density, model.site.gravity)
    environment = None
    if findings.sound("site", "waves", "settings"):
        calm = model.model_copy(update={"wind": None, "current": None})
        try:
            environment = environment_of(calm, water, folder)
        except InputError as error:
            findings.raised(error, ("waves",))
        else:
            check_waves(model, environment, findings)
    if environment is not None and findings.sound("site", "structure", "lines"):
        try:
            unit = breakwater_of(model, water, folder)
        except InputError as error:
            findings.raised(error, ("structure",))
        else:
            _check_lines_at_rest(model, unit, environment, findings)
    if not findings.faults:
        _check_balance(model, folder, findings, lambda: build_problem(model, folder))


_RESTS: dict[str, tuple[InputError | None, tuple[Notice, ...]]] = {}
_MOST_RESTS = 256


def _check_balance(
    model: BreakwaterCase, folder: Path, findings: Findings, problem: Callable[[], BreakwaterProblem]
) -> None:
    """Find the rest of the unit at every water level and tell what is odd about it.

    The rest is not attached to the waves; the cases of a study that differ in them alone share one search for it. Where
    files are named it is searched every time, since they may have changed.
    """
    key = f"{folder}|{model.model_dump_json(exclude={'waves', 'title', 'analyses'})}"
    known = None if '"file":"' in key or '"path":"' in key else _RESTS.get(key)
    if known is None:
        known = _rest(problem())
        if len(_RESTS) >= _MOST_RESTS:
            _RESTS.clear()
        _RESTS[key] = known
    error, notices = known
    for notice in notices:
        path: KeyPath = ("structure", "mass") if notice.code == "imbalance" else ("structure",)
        if notice.code == "unstable":
            path = ("structure", "centre_of_gravity_above_keel")
            if not model.structure.allow_unstable:
                findings.fault(
                    path, notice.message, allowed="a metacentric height above 0 m",
                    remedy=f"{notice.remedy}; where lines hold it upright on purpose, give 'allow_unstable: true'",
                )  # fmt: skip
                continue
        findings.warn(path, notice.message, remedy=notice.remedy)
    if error is not None:
        findings.raised(error, ("structure",))


def _rest(problem: BreakwaterProblem) -> tuple[InputError | None, tuple[Notice, ...]]:
    """Return what stands against a rest, and what is odd about it, each once."""
    from moyai.structures.breakwater.assembly import assemble

    said: dict[str, Notice] = {}
    for name, level in problem.environment.water_levels:
        try:
            unit = assemble(problem, name, level)
            if problem.breakwater.coefficients_file is None:
                count_panels(unit)
        except (InputError, ConvergenceError) as error:
            return InputError.of(error.fault), tuple(said.values())
        for notice in unit.notices:
            if notice.severity != "information":
                said.setdefault(notice.code, notice)
    return None, tuple(said.values())


def _check_lines_at_rest(model: BreakwaterCase, unit: Breakwater, environment: Environment, findings: Findings) -> None:
    """Compare each line of the upright unit with its strength and its slack, at every water level."""
    from moyai.floating.statics import body_to_site
    from moyai.mooring.checks import check_line_system
    from moyai.mooring.system import LineSystem
    from moyai.structures.breakwater.assembly import at_level, site_lines

    if not unit.lines:
        return
    draught = unit.draught or _draught_of_mass(model, unit.hull, findings)
    if draught is None:
        return
    check_sides(model, findings)
    places = {line.name: index for index, line in enumerate(model.lines)}
    said: set[tuple[str, str]] = set()
    chains_reported: set[str] = set()
    for name, level in sorted(environment.water_levels, key=lambda entry: -entry[1]):
        water = environment.water_at(level)
        centre = body_to_site(unit.centre_of_gravity, draught, 0.0)
        lines = site_lines(at_level(unit, level), water, centre, draught, 0.0)
        depth = water.depth + centre[1]
        placed = ((index, *pair, depth) for index, pair in enumerate(zip(model.lines, lines)))
        check_chain_on_bed(placed, name, findings, chains_reported)
        for notice in check_line_system(LineSystem(lines, depth)):
            label, _, message = notice.message.partition(": ")
            line = label.removeprefix("lines.")
            if line not in places or notice.code in SAID_OTHERWISE or (line, notice.code) in said:
                continue
            said.add((line, notice.code))
            path = line_place(findings, places[line], notice.code)
            where = f" (water level {name})" if len(environment.water_levels) > 1 else ""
            record = findings.fault if notice.severity == "error" else findings.warn
            remedy, across = notice.remedy, across_the_hull(model.lines[places[line]])
            if across and notice.severity == "error":
                # What the line then does at rest follows from the side of its anchor
                path, message = ("lines", places[line], "anchor"), f"{across}; {message}"
                remedy = "check the sign of the anchor's x; a line meant to cross needs the length for it"
            outside = off_the_hull(model.lines[places[line]], unit.hull.bounds)
            if outside and notice.severity == "error":
                left, right, _, deck = unit.hull.bounds
                path, message = ("lines", places[line], "fairlead"), f"{outside}; {message}"
                remedy = f"check it: x from {left:g} to {right:g} m, 0 to {deck:g} m above the keel are on the hull"
            record(path, f"line '{line}': {message}{where}", remedy=remedy)
