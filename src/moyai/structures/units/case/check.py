"""Checks of a row of units: do they float apart, do connectors make sense, do the panels resolve the waves."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from moyai.case.check_catalogue import SAID_OTHERWISE, line_place
from moyai.case.check_sea import check_file, check_level_names, check_surroundings, check_waves
from moyai.case.findings import Findings, duplicates
from moyai.case.schema_environment import sea_names
from moyai.case.yaml_reader import KeyPath
from moyai.core.arrays import Array
from moyai.core.errors import ConvergenceError, InputError
from moyai.mooring.lines import Line, LineElement
from moyai.mooring.rotations import rotation_from_vector
from moyai.sea.states import RegularSea
from moyai.structures.units.case import schema
from moyai.structures.units.model import ON_HULL

if TYPE_CHECKING:
    from moyai.potential.sections import Hull
    from moyai.sea.water import Water
    from moyai.structures.units.assembly import RowAtLevel
    from moyai.structures.units.model import UnitsProblem

#: A section counts as symmetric when its centre of buoyancy lies within this share of the beam of the centre line
_UPRIGHT = 1e-6


def check(model: schema.UnitsCase, findings: Findings, folder: Path) -> None:
    """Record every fault and warning of a row of units in ``findings``."""
    check_surroundings(model, findings, folder)
    _check_needs(model, findings)
    check_level_names(model, findings)
    _check_numbers(model, findings)
    _check_lines(model, findings)
    _check_map(model, findings)
    hull = _hull(model, findings)
    if hull is not None:
        _check_floating(model, hull, findings)
        _check_joined(model, hull, findings)
        if not findings.faults:
            _check_faces(model, hull, findings)
    _check_by_building(model, findings, folder)


def _check_needs(model: schema.UnitsCase, findings: Findings) -> None:
    unit = model.structure
    for name, key in (("wind", "wind_drag_coefficient"), ("current", "current_drag_coefficient")):
        if getattr(model, name) is not None and getattr(unit, key) is None:
            findings.fault((name,), f"'{name}' needs 'structure.{key}'", remedy="give it, about 1.0 to 2.0 for a box")
    waves = {"frequency", "map"} & set(model.analyses)
    if waves and not model.waves:
        findings.fault(("analyses",), f"the analysis '{sorted(waves)[0]}' needs 'waves'", remedy="give a sea state")
    if "map" in model.analyses and model.map is None:
        findings.fault(("analyses",), "the analysis 'map' needs 'map'", remedy="give its place: map: {x: ..., y: ...}")
    for name in ("map", "time"):
        if name in model.analyses and "frequency" not in model.analyses:
            findings.fault(
                ("analyses",), f"the analysis '{name}' needs 'frequency'",
                remedy="the units move in the waves: request both",
            )  # fmt: skip
    _check_time(model, findings)
    _check_file(model, findings)
    pushed = model.settings.drift or model.wind is not None or model.current is not None
    if not model.lines and pushed and model.waves and waves:
        findings.fault(
            ("analyses",),
            "nothing holds the row against drift, wind or current",
            remedy="give 'lines', or set 'settings.drift: false' and leave 'wind' and 'current' out",
        )
    if unit.gap_damping_lid > 0.0 and len(_places(model)) < 2:
        findings.warn(("structure", "gap_damping_lid"), "a single unit has no gap; the lid does nothing")


def _check_file(model: schema.UnitsCase, findings: Findings) -> None:
    """Refuse what coefficients from a file cannot give."""
    if model.structure.coefficients_file is None:
        return
    if "map" in model.analyses:
        findings.fault(
            ("analyses",), "the analysis 'map' needs the panels of the units, which a file of coefficients lacks",
            remedy="leave 'map' out, or leave 'structure.coefficients_file' out",
        )  # fmt: skip
    if model.structure.gap_damping_lid > 0.0:
        findings.fault(
            ("structure", "gap_damping_lid"), "the damping of the gaps is in the coefficients of the file alone",
            remedy="leave it out, and damp the gaps in the program that computes the file",
        )  # fmt: skip
    if model.settings.panel_size is not None:
        findings.warn(("settings", "panel_size"), "coefficients from a file need no panels", remedy="leave it out")


def _check_time(model: schema.UnitsCase, findings: Findings) -> None:
    for index, entry in enumerate(model.structure.connectors):
        if entry.endurance is not None and "time" not in model.analyses:
            findings.warn(
                ("structure", "connectors", index, "endurance"),
                f"the fatigue of connector '{entry.name}' is counted in the time domain alone",
                remedy="add 'time' to 'analyses'",
            )


def _places(model: schema.UnitsCase) -> tuple[Any, ...]:
    from moyai.structures.units.case.places import placements_of

    return placements_of(model.structure.units)


def _check_numbers(model: schema.UnitsCase, findings: Findings) -> None:
    """Check numbers of units in connectors and lines, and names."""
    count = len(_places(model))
    for index, entry in enumerate(model.structure.connectors):
        path: KeyPath = ("structure", "connectors", index)
        if count < 2:
            findings.fault(path, f"connector '{entry.name}' has a single unit", remedy="give two units or more")
        if isinstance(entry.between, str):
            continue
        for number, pair in enumerate(entry.between):
            for end in pair:
                if end > count:
                    findings.fault((*path, "between", number), f"there is no unit {end}", allowed=f"1 to {count}")
    for index in duplicates([entry.name for entry in model.structure.connectors]):
        name = model.structure.connectors[index].name
        findings.fault(
            ("structure", "connectors", index, "name"), f"two connectors are called '{name}'", remedy="rename one"
        )
    for index, line in enumerate(model.lines):
        if isinstance(line.units, str):
            continue
        for number, unit in enumerate(line.units):
            if unit > count:
                findings.fault(("lines", index, "units", number), f"there is no unit {unit}", allowed=f"1 to {count}")
    for index in duplicates([line.name for line in model.lines]):
        findings.fault(
            ("lines", index, "name"), f"two lines are called '{model.lines[index].name}'", remedy="rename one"
        )


def _check_joined(model: schema.UnitsCase, hull: Hull, findings: Findings) -> None:
    """Refuse connectors between units that do not meet."""
    from moyai.structures.units.faces import between, meeting

    places, length, bounds = _places(model), model.structure.units.length, hull.bounds[:2]
    for index, entry in enumerate(model.structure.connectors):
        path: KeyPath = ("structure", "connectors", index, "between")
        listed = not isinstance(entry.between, str)
        pairs: Any = entry.between if listed else [(unit, unit + 1) for unit in range(1, len(places))]
        for number, pair in enumerate(pairs):
            if max(pair) > len(places) or pair[0] == pair[1]:
                continue
            first, second = sorted(pair)
            met = meeting(places, (first - 1, second - 1), length, bounds)
            other = between(places, met, length, bounds)
            if other is not None:
                reason = f"unit {other + 1} lies between them"
            elif met.distance > length and entry.kind != "chain":
                reason = f"the faces that they turn to each other are {met.distance:.3g} m apart"
            else:
                continue
            findings.fault(
                (*path, number) if listed else path,
                f"connector '{entry.name}' joins units {first} and {second}, which do not meet: {reason}",
                allowed=f"units nearer than {length:g} m with no other between them",
                remedy="list the units in their order, or give the pairs in 'between'",
            )


def _check_faces(model: schema.UnitsCase, hull: Hull, findings: Findings) -> None:
    """Say where a connector stands at a corner, and which units that face each other get none."""
    from moyai.structures.units.faces import gaps_between, meeting

    places, length, bounds = _places(model), model.structure.units.length, hull.bounds[:2]
    facing = {tuple(sorted(gap.pair)) for gap in gaps_between(places, length, bounds)}
    for index, entry in enumerate(model.structure.connectors):
        path: KeyPath = ("structure", "connectors", index, "between")
        in_order = isinstance(entry.between, str)
        listed: Any = [(unit, unit + 1) for unit in range(1, len(places))] if in_order else entry.between
        pairs = {(min(pair) - 1, max(pair) - 1) for pair in listed}
        for first, second in sorted(pairs - facing):
            met = meeting(places, (first, second), length, bounds)
            if met.overlap[1] > met.overlap[0]:
                continue
            near, far = met.joined_at(entry.x)
            x, y = 0.5 * (near + far)
            findings.warn(
                path,
                f"units {first + 1} and {second + 1} have no facing sides, they meet at a corner: connector "
                f"'{entry.name}' is there at x = {x:.3g} m, y = {y:.3g} m of the row",
                remedy="give the pairs that face each other in 'between', or place the units face to face",
            )
        if in_order and (left := sorted(facing - pairs)):
            words = ", ".join(f"{first + 1} and {second + 1}" for first, second in left)
            findings.warn(
                path,
                f"connector '{entry.name}' joins units in the order of the list; {words} face each other and get none",
                remedy="give the pairs in 'between'",
            )


def _check_lines(model: schema.UnitsCase, findings: Findings) -> None:
    for index, line in enumerate(model.lines):
        if getattr(line, "dynamic", False):
            findings.fault(
                ("lines", index, "dynamic"),
                f"line '{line.name}': lines of a row of units are at rest at every instant",
                allowed="false",
                remedy="leave 'dynamic' out; a single unit with lines in motion is a case of kind breakwater",
            )
        if getattr(line, "drag_width", 0.0) > 0.0:
            findings.fault(
                ("lines", index, "drag_width"),
                f"line '{line.name}': the drag of lines is not counted in a row of units",
                remedy="leave it out, or give its damping in 'structure.additional_damping'",
            )
        if math.isinf(model.site.water_depth) and isinstance(line, schema.UnitCatenaryLine):
            findings.fault(
                ("lines", index, "anchor"), f"line '{line.name}' goes to a bed that is infinitely deep",
                remedy="give the water depth, or use a spring to a fixed point",
            )  # fmt: skip
        half = 0.5 * model.structure.units.length
        if abs(line.fairlead.y) > half * (1.0 + 1e-9):
            findings.warn(
                ("lines", index, "fairlead", "y"), f"the fairlead of '{line.name}' lies beyond the end of the unit",
                allowed=f"{-half:g} to {half:g} m from the middle of the unit",
            )  # fmt: skip


def _check_map(model: schema.UnitsCase, findings: Findings) -> None:
    if model.map is None:
        return
    for key in ("x", "y"):
        low, high = getattr(model.map, key)
        if not low < high:
            findings.fault(("map", key), f"the map runs from {low:g} to {high:g} m", allowed="the smaller one first")
    for index in duplicates([point.name for point in model.map.points]):
        findings.fault(
            ("map", "points", index, "name"), f"two points are called '{model.map.points[index].name}'",
            remedy="rename one",
        )  # fmt: skip
    line = model.map.line
    if line is not None and line.start == line.end:
        findings.fault(("map", "line"), "both ends of the line are the same point", remedy="give two points")
    if findings.sound("structure", "map", "waves", "site"):
        _check_named_points(model, findings)
        _check_line_behind(model, findings)


def _check_named_points(model: schema.UnitsCase, findings: Findings) -> None:
    """Refuse named points inside of a unit or on its hull, where there is no water."""
    assert model.map is not None
    half = 0.5 * model.structure.units.length
    try:
        hull = model.structure.section.hull()
    except InputError:
        return  # reported by the checks of the section
    left, right = hull.bounds[0], hull.bounds[1]
    for index, point in enumerate(model.map.points):
        for number, place in enumerate(_places(model)):
            dx, dy = point.x - place.x, point.y - place.y
            cos, sin = math.cos(place.heading), math.sin(place.heading)
            across, lengthwise = dx * cos + dy * sin, dy * cos - dx * sin
            if left - ON_HULL <= across <= right + ON_HULL and abs(lengthwise) <= half + ON_HULL:
                findings.fault(
                    ("map", "points", index),
                    f"the point '{point.name}' at x = {point.x:g} m, y = {point.y:g} m lies inside of unit "
                    f"{number + 1} or on its hull, where there is no water",
                    allowed="points outside of the units", remedy="move it",
                )  # fmt: skip


def _check_line_behind(model: schema.UnitsCase, findings: Findings) -> None:
    """Warn of a line of transmission that a sea meets before the row."""
    from moyai.case.headings import heading_of

    assert model.map is not None
    line, places = model.map.line, _places(model)
    if line is None:
        return
    names = sea_names(model.waves)
    for index, state in enumerate(model.waves):
        try:
            heading = heading_of(state, model.site.x_axis_bearing_deg, f"waves[{index}]")
        except InputError:
            continue
        cos, sin = math.cos(heading), math.sin(heading)
        row = min(place.x * cos + place.y * sin for place in places)
        before = [row - x * cos - y * sin for x, y in (line.start, line.end)]
        if min(before) >= 0.0:
            findings.warn(
                ("map", "line"),
                f"the line lies on the seaward side: '{names[index]}' meets it {min(before):.4g} to "
                f"{max(before):.4g} m before the first unit; its transmission would hold reflected waves",
                allowed="a line behind the row, as the waves travel", remedy="check the sign of its x",
            )  # fmt: skip
            return


def _hull(model: schema.UnitsCase, findings: Findings) -> Hull | None:
    try:
        return model.structure.section.hull()
    except InputError as error:
        key = error.fault.path.split(".")[-1]
        path: KeyPath = ("structure", "section")
        if key in type(model.structure.section).model_fields:
            path = (*path, key)
        findings.fault(path, error.fault.message, allowed=error.fault.allowed, remedy=error.fault.remedy)
        return None


def _check_floating(model: schema.UnitsCase, hull: Hull, findings: Findings) -> None:
    unit, site = model.structure, model.site
    if hull.plates:
        findings.fault(
            ("structure", "section", "plates"), "thin plates are not computed in three dimensions",
            remedy="give plates a thickness (pi_type), or leave them out",
        )  # fmt: skip
    if abs(hull.bottom) > 1e-9 * hull.height:
        findings.fault(
            ("structure", "section"), f"the lowest point of the section is at z = {hull.bottom:g} m",
            allowed="0 m: z is measured from the keel",
        )  # fmt: skip
        return
    if unit.draught >= hull.height:
        findings.fault(
            ("structure", "draught"),
            f"the draught of {unit.draught:g} m is not less than the height of the section, {hull.height:g} m",
            allowed=f"less than {hull.height:g} m",
        )
        return
    for name, level in site.water_levels.items():
        depth = site.water_depth + level
        if 0.0 < depth <= unit.draught:
            findings.fault(
                ("structure", "draught"),
                f"the units are {unit.draught:.4g} m deep in {depth:.4g} m of water at {name}",
                allowed=f"a draught below {depth:.4g} m",
                remedy="they would reach the bed",
            )
    try:
        section = hull.immersed(unit.draught)
    except InputError as error:
        findings.fault(("structure", "draught"), error.fault.message, remedy=error.fault.remedy)
        return
    if abs(section.centroid[0]) > _UPRIGHT * hull.beam:
        findings.fault(
            ("structure", "section"),
            f"the centre of buoyancy lies {section.centroid[0]:.3g} m off the centre line: the units would heel",
            allowed="sections that float upright",
            remedy="move the section so that its centre of buoyancy is at x = 0",
        )
    if any(chain.closed for chain in section.chains):
        findings.fault(
            ("structure", "section"), "a part of the section is wholly under water",
            allowed="outlines that reach the water surface",
        )  # fmt: skip
    if not 0.0 <= unit.centre_of_gravity_above_keel <= hull.height:
        findings.warn(
            ("structure", "centre_of_gravity_above_keel"),
            f"the centre of gravity, {unit.centre_of_gravity_above_keel:g} m above the keel, lies outside the section",
            allowed=f"0 to {hull.height:g} m for a body of one piece",
        )


def _check_by_building(model: schema.UnitsCase, findings: Findings, folder: Path) -> None:
    """Build what is sound: waves against breaking, units against each other, panels against waves and memory."""
    from moyai.structures.units.case.build import build_problem

    if findings.faults:
        return
    given = model.structure.coefficients_file
    if given is not None and not check_file(
        ("structure", "coefficients_file", "path"), given.path, folder, findings,
        folder_allowed=given.program == "nemoh",
    ):  # fmt: skip
        return
    try:
        problem = build_problem(model, folder)
    except InputError as error:
        findings.raised(error, ("structure",))
        return
    check_waves(model, problem.environment, findings, lambda *_: None)
    if not findings.faults:
        _check_step(problem, findings)
        _check_problem(model, problem, findings)


def _check_lines_at_rest(problem: UnitsProblem, at: RowAtLevel, findings: Findings) -> bool:
    """Compare the lines of every unit with their strength and slack; return whether any is impossible."""
    from moyai.mooring.checks import check_line_system

    places = {line.name: index for index, line in enumerate(problem.row.lines)}
    said: set[tuple[str, str]] = set()
    for number, system in enumerate(at.systems):
        for notice in check_line_system(system) if system.lines else ():
            label, _, message = notice.message.partition(": ")
            name = label.removeprefix("lines.")
            line = name if name in places else name.removesuffix(f" {number + 1}")
            if line not in places or notice.code in SAID_OTHERWISE or (line, notice.code) in said:
                continue
            said.add((line, notice.code))
            path = line_place(findings, places[line], notice.code)
            record = findings.fault if notice.severity == "error" else findings.warn
            record(path, f"line '{line}' of unit {number + 1}: {message}", remedy=notice.remedy)
    return bool(findings.faults)


def _placed(
    model: schema.UnitsCase, problem: UnitsProblem, at: RowAtLevel, position: Array
) -> Iterator[tuple[int, Any, LineElement, float]]:
    """Yield the lines of every unit at a position (m,), their place in the case and the depth below their origin."""
    for number, (lines, centre) in enumerate(zip(at.lines, at.centres)):
        own = [index for index, line in enumerate(problem.row.lines) if number in line.units]
        move = position[6 * number : 6 * number + 6]
        for index, line in zip(own, lines, strict=True):
            entry = model.lines[index]
            if isinstance(line, Line):
                x, y, z = (move[:3] + rotation_from_vector(move[3:]) @ np.asarray(line.fairlead)).tolist()
                yield index, entry, replace(line, fairlead=(x, y, z)), at.water.depth + float(centre[2])


def _check_step(problem: UnitsProblem, findings: Findings) -> None:
    step = problem.settings.time.time_step
    if step is None or "time" not in problem.settings.analyses:
        return
    periods = [
        min(sea.periods) if isinstance(sea, RegularSea) else 2.0 * math.pi / float(sea.spectrum.peak_omega)
        for sea in problem.environment.sea_states
    ]
    if periods and step > 0.1 * min(periods):
        findings.fault(
            ("settings", "time", "time_step"),
            f"the step of {step:g} s is more than a tenth of the shortest period, {min(periods):.3g} s",
            allowed=f"up to {0.1 * min(periods):.3g} s",
            remedy="leave it out: auto takes a fortieth",
        )


def _check_longest(model: schema.UnitsCase, water: Water, omega: float, findings: Findings) -> bool:
    """Refuse waves that are too long for the depth, where they are given; return whether there are none."""
    from moyai.structures.units.bem import check_longest

    try:
        check_longest(water, omega)
    except InputError as error:
        path = ("waves",) if model.settings.frequencies == "auto" else ("settings", "frequencies")
        fault = error.fault
        findings.fault(path, fault.message, allowed=fault.allowed, remedy=fault.remedy)
        return False
    return True


def _check_problem(model: schema.UnitsCase, problem: UnitsProblem, findings: Findings) -> None:
    from moyai.case.chain_on_bed import check_chain_on_bed
    from moyai.structures.units.assembly import assemble, level_notices, steady_load, steady_position
    from moyai.structures.units.bem import check_memory
    from moyai.structures.units.coefficients_file import read_row, row_from_file
    from moyai.structures.units.contact import steady_meeting
    from moyai.structures.units.outlines import check_apart
    from moyai.structures.units.run import WITH_WAVES, check_resolution, highest_frequency, row_panels
    from moyai.structures.units.seas import frequencies_of, headings_of

    environment = problem.environment
    omega = frequencies_of(environment, problem.settings)
    said: set[str] = set()
    of_file = None
    bare: set[str] = set()
    for name, level in sorted(environment.water_levels, key=lambda entry: -entry[1]):
        try:
            check_apart(problem.row)
            at = assemble(problem.row, environment, name, level)
            notices = list(level_notices(at))
            if _check_lines_at_rest(problem, at, findings):
                return
            still = steady_position(at, np.zeros(at.size)).position
            check_chain_on_bed(_placed(model, problem, at, still), name, findings, bare)
            wind, current = steady_load(at, environment)
            for notice in steady_meeting(at, steady_position(at, wind + current).position):
                findings.warn(("structure",), notice.message, remedy=notice.remedy)
            if problem.coefficients is not None and WITH_WAVES & set(problem.settings.analyses) and omega.size:
                of_file = read_row(problem.coefficients) if of_file is None else of_file
                notices += row_from_file(of_file, at, omega, headings_of(environment)).notices
            elif WITH_WAVES & set(problem.settings.analyses) and omega.size:
                if not _check_longest(model, at.water, float(omega.min()), findings):
                    return
                panels = row_panels(at, problem.settings, highest_frequency(omega, problem.settings))
                check_memory(panels)
                notices += check_resolution(at, panels, omega)
        except InputError as error:
            findings.raised(error, ("structure",))
            return
        except ConvergenceError as error:
            findings.fault(("structure",), error.fault.message, remedy=error.fault.remedy)
            return
        for notice in notices:
            if notice.code in said or notice.severity == "information":
                continue
            said.add(notice.code)
            path: KeyPath = ("structure",)
            if notice.code == "unstable":
                path = ("structure", "centre_of_gravity_above_keel")
            if notice.code.startswith(("coefficients-", "time-convention", "long-wave-heave")):
                path = ("structure", "coefficients_file")
            if notice.code == "few-panels":
                path = ("settings",)
            record = findings.fault if notice.severity == "error" else findings.warn
            record(path, notice.message, remedy=notice.remedy)
