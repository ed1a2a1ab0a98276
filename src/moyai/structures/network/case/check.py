"""Checks of a network case: names, motions over the run, the network itself, seas, what a run would cost."""

from __future__ import annotations

import math
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from moyai.case.check_catalogue import check_catalogue
from moyai.case.check_sea import check_file, check_level_names, check_surroundings, check_waves, wave_path
from moyai.case.faults import did_you_mean
from moyai.case.findings import Findings
from moyai.core.errors import InputError
from moyai.structures.network.case import schema_parts as parts
from moyai.structures.network.case.check_parts import (
    check_anchors,
    check_bars,
    check_bodies,
    check_corners,
    check_floats,
    check_sheets,
    check_starts,
)
from moyai.structures.network.case.schema import NetworkCase

if TYPE_CHECKING:
    from moyai.flexible.motion import Motion
    from moyai.flexible.network import Network
    from moyai.structures.network.model import NetworkProblem

#: Nodes with which a case still answers in a sitting, and rows of results that a run may reasonably have.
_MANY_NODES, _MANY_ROWS = 20_000, 2_000_000
#: Nodes times steps of a run, some ten days of computing.
_MOST_NODE_STEPS = 5e12
#: Longest run [s], two days: motions are tabulated over the whole run.
_LONGEST_RUN = 172_800.0


def check(model: NetworkCase, findings: Findings, folder: Path) -> None:
    """Record every fault and warning of a network case in ``findings``."""
    check_surroundings(model, findings, folder)
    _check_names(model, findings)
    _check_lines(model, findings)
    _check_nets(model, findings)
    check_bodies(model, findings, folder)
    check_floats(model, findings)
    check_starts(model, findings)
    check_anchors(model, findings)
    check_bars(model, findings)
    check_corners(model, findings)
    check_sheets(model, findings)
    _check_files(model, findings, folder)
    _check_settings(model, findings, folder)
    if getattr(model.criteria, "line_safety_factor", None) is not None and not model.structure.lines:
        findings.fault(
            ("criteria", "line_safety_factor"), "the case has no lines, and bars of nets have no breaking load",
            remedy="give 'greatest_net_tension' in its place",
        )  # fmt: skip
    if not findings.sound("site", "waves", "structure", "current", "settings"):
        return
    lines = model.structure.lines.values()
    if not all(line.parts is not None or None not in (line.length, line.segments) for line in lines):
        return  # what is missing was reported already
    from moyai.structures.network.assembly import assemble
    from moyai.structures.network.case.build import build_problem

    try:
        problem = build_problem(model, folder)
        for _, level in problem.environment.water_levels:
            assemble(problem, level)
    except InputError as error:
        _raised(error, findings)
        return
    if problem.linear_waves_only:
        for index, state in enumerate(model.waves):
            if getattr(state, "theory", "") == "stream_function":
                findings.fault(
                    wave_path(findings, index, "theory"), "the coefficients of a body answer linear waves only",
                    allowed="automatic, linear", remedy="remove 'theory', or give the body added_mass in their place",
                )  # fmt: skip
    check_waves(model, problem.environment, findings, lambda *_: None)
    if not findings.sound("waves"):
        return
    _check_runs(problem, findings)
    _check_places(model, problem, findings)


def _raised(error: InputError, findings: Findings) -> None:
    """Record an error of the package that builds networks, at the point or line that it names."""
    fault = error.fault
    known: Any = findings.document.values
    for kind in ("points", "lines", "nets", "bodies"):
        for path in list(known):
            if len(path) == 3 and path[:2] == ("structure", kind) and f"'{path[2]}'" in fault.message:
                findings.fault(path, fault.message, allowed=fault.allowed, remedy=fault.remedy)
                return
    path = findings.path_of(fault.path) or ("structure",)
    findings.fault(path, fault.message, allowed=fault.allowed, remedy=fault.remedy)


def _check_names(model: NetworkCase, findings: Findings) -> None:
    unit = model.structure
    for group in ("points", "lines", "nets", "sheets", "bodies"):
        for name in getattr(unit, group):
            if any(letter in name for letter in "[],"):
                findings.fault(
                    ("structure", group, name), f"'{name}' holds a bracket or comma, which knots of nets are named by",
                    remedy="use letters, digits and blanks",
                )  # fmt: skip
    for group, others in (("nets", unit.lines), ("sheets", {**unit.lines, **unit.nets})):
        for name in getattr(unit, group):
            if name in others:
                findings.fault(("structure", group, name), f"a line or net is called '{name}' too", remedy="rename one")
    moved: list[tuple[tuple[str, ...], str | None]] = [
        (("structure", "points", name, "motion"), point.motion)
        for name, point in unit.points.items()
        if isinstance(point, parts.DrivenPoint)
    ]
    moved += [(("structure", "nets", name, "motion"), net.motion) for name, net in unit.nets.items()]
    moved += [(("structure", "sheets", name, "motion"), sheet.motion) for name, sheet in unit.sheets.items()]
    for path, motion in moved:
        if motion is not None and motion not in unit.motions:
            findings.fault(
                path, f"there is no motion '{motion}'", allowed=", ".join(unit.motions) or "a name in 'motions'",
                remedy=did_you_mean(motion, unit.motions),
            )  # fmt: skip
    rows: list[tuple[str, str, Any]] = [("nets", name, net) for name, net in unit.nets.items()]
    rows += [("sheets", name, sheet) for name, sheet in unit.sheets.items()]
    for group, name, net in rows:
        if net.motion is not None and net.first_row != "driven":
            findings.fault(
                ("structure", group, name, "motion"), f"the first row is {net.first_row} and follows no motion",
                remedy="set first_row: driven",
            )  # fmt: skip
    carried = [(body, point) for body, entry in unit.bodies.items() for point in entry.points]
    for number, (body, point) in enumerate(carried):
        if point in unit.points or point in unit.motions or point in [other for _, other in carried[:number]]:
            findings.fault(
                ("structure", "bodies", body, "points", point), f"another point or motion is called '{point}'",
                remedy="rename one",
            )  # fmt: skip
    used = {motion for _, motion in moved}
    for name in unit.motions:
        if name not in used:
            findings.warn(("structure", "motions", name), f"no point follows the motion '{name}'")
    every = [part for line in unit.lines.values() for part in line.parts or ()]
    types = {part.type for part in every if isinstance(part, parts.LinePartKeys)}
    types |= {line.type for line in unit.lines.values() if line.type is not None}
    types |= {net.type for net in unit.nets.values() if net.type is not None}
    for name in unit.line_types:
        if name not in types:
            findings.warn(("structure", "line_types", name), f"no line is made of '{name}'")


def _check_lines(model: NetworkCase, findings: Findings) -> None:
    unit = model.structure
    for name, entry in unit.line_types.items():
        if isinstance(entry, parts.CatalogueType):
            check_catalogue(("structure", "line_types", name), entry.catalogue, entry.diameter, findings)
    grids: list[tuple[str, Any]] = [*unit.nets.items(), *unit.sheets.items()]
    knots = {f"{name}[{i},{j}]" for name, grid in grids for i in range(grid.rows) for j in range(grid.columns)}
    known = [*unit.points, *(point for body in unit.bodies.values() for point in body.points)]
    for name, line in unit.lines.items():
        for key in ("start", "end"):
            point = getattr(line, key)
            if point not in known and point not in knots:
                findings.fault(
                    ("structure", "lines", name, key), f"there is no point '{point}'",
                    allowed=", ".join([*known[:12], *_knots(grids)]) or "a name in 'points'",
                    remedy=did_you_mean(point, known),
                )  # fmt: skip
        if line.start == line.end:
            findings.fault(("structure", "lines", name, "end"), f"the line starts and ends at '{line.end}'")
        named = [(("structure", "lines", name, "type"), line.type)] if line.type is not None else []
        named += [
            (("structure", "lines", name, "parts", index, "type"), part.type)  # type: ignore[misc]
            for index, part in enumerate(line.parts or ())
            if isinstance(part, parts.LinePartKeys)
        ]
        for path, kind in named:
            if kind not in unit.line_types:
                findings.fault(
                    path, f"there is no line type '{kind}'",
                    allowed=", ".join(unit.line_types) or "a name in 'line_types'",
                    remedy=did_you_mean(str(kind), unit.line_types),
                )  # fmt: skip
        if line.type is not None:
            for key in ("length", "segments"):
                # one that is there and out of range was reported already
                if getattr(line, key) is None and ("structure", "lines", name, key) not in findings.document.values:
                    findings.fault(
                        ("structure", "lines", name), f"'{key}' is missing",
                        remedy="a line of one type has a length and a number of segments",
                    )  # fmt: skip
        for key in ("length", "segments"):
            if line.parts is not None and getattr(line, key) is not None:
                findings.fault(
                    ("structure", "lines", name, key), f"'{key}' and 'parts' exclude each other", remedy="remove it"
                )


def _knots(grids: list[tuple[str, Any]]) -> list[str]:
    """Return the first and the last knot of nets and sheets, as they are named."""
    return [f"'{name}[0,0]' to '{name}[{grid.rows - 1},{grid.columns - 1}]'" for name, grid in grids[:3]]


def _check_nets(model: NetworkCase, findings: Findings) -> None:
    unit = model.structure
    for name, net in unit.nets.items():
        path = ("structure", "nets", name)
        if net.type is not None and net.type not in unit.line_types:
            findings.fault(
                (*path, "type"), f"there is no line type '{net.type}'",
                allowed=", ".join(unit.line_types) or "a name in 'line_types'",
                remedy=did_you_mean(net.type, unit.line_types),
            )  # fmt: skip
        if net.twine is not None and net.twine.mesh_pitch <= net.twine.diameter:
            findings.fault(
                (*path, "twine", "mesh_pitch"),
                f"meshes of {net.twine.mesh_pitch:g} m are closed by twines of {net.twine.diameter:g} m",
                allowed="greater than the diameter",
            )  # fmt: skip


def _check_files(model: NetworkCase, findings: Findings, folder: Path) -> None:
    unit = model.structure
    for name, motion in unit.motions.items():
        if isinstance(motion, parts.TableMotion) and motion.file is not None:
            check_file(("structure", "motions", name, "file"), motion.file, folder, findings)
    for name, kind in unit.line_types.items():
        if kind.curve is not None and kind.curve.file is not None:
            check_file(("structure", "line_types", name, "curve", "file"), kind.curve.file, folder, findings)
    if model.settings.resume is not None:
        check_file(("settings", "resume"), model.settings.resume, folder, findings)


def _check_settings(model: NetworkCase, findings: Findings, folder: Path) -> None:
    settings = model.settings
    check_level_names(model, findings)
    if settings.wave_front and settings.method not in ("auto", "explicit"):
        findings.fault(("settings", "wave_front"), "only explicit steps go at the pace of the wave",
                       remedy="set method: explicit")  # fmt: skip
    if settings.snap_threshold is not None and settings.snap_threshold < settings.slack_level:
        findings.fault(("settings", "snap_threshold"), "the threshold of a snap lies under the slack level",
                       allowed=f"at least {settings.slack_level:g} N")  # fmt: skip
    for index, item in enumerate(model.structure.failures):
        path = ("structure", "failures", index)
        if item.line not in model.structure.lines:
            lines = ", ".join(model.structure.lines) or "none"
            findings.fault((*path, "line"), f"there is no line '{item.line}'", allowed=lines)
        if model.structure.bodies:
            findings.fault(path, "lines that part are not run next to bodies", remedy="leave the failure or bodies out")
        if settings.resume is not None:
            findings.fault(path, "a resumed run has no record of which lines have parted", remedy="run it whole")
        if "dynamic" not in model.analyses:
            findings.warn(path, "lines part in 'dynamic' alone")
    if model.current_field is not None:
        if model.current is not None:
            findings.fault(("current_field",), "'current' and 'current_field' exclude each other", remedy="keep one")
        if "dynamic" not in model.analyses:
            findings.warn(("current_field",), "a current that changes with time acts in 'dynamic' alone")
    if settings.start == "rest_in_current" and model.current is None:
        findings.fault(("settings", "start"), "there is no current to rest in", remedy="give 'current', or start: rest")
    if model.structure.bed is not None and math.isinf(model.site.water_depth):
        findings.fault(("structure", "bed"), "a bed needs a finite water depth", remedy="remove 'bed'")
    if model.structure.bodies and settings.method not in ("auto", "explicit"):
        findings.fault(("settings", "method"), "networks with bodies run by explicit steps", allowed="auto, explicit")
    dynamic = "dynamic" in model.analyses
    if model.waves and not dynamic:
        findings.warn(("analyses",), "the waves are not used: they need the analysis 'dynamic'")
    if dynamic and settings.duration is not None and (settings.skip or 0.0) >= settings.duration:
        findings.fault(("settings", "skip"), f"{settings.skip:g} s leave nothing of the run",
                       allowed=f"less than {settings.duration:g} s")  # fmt: skip


def _check_runs(problem: NetworkProblem, findings: Findings) -> None:
    """Make every run's water and motions once: a table may be short, a current may stop the waves."""
    if "dynamic" not in problem.settings.analyses:
        return
    from moyai.structures.network.runs import motions_of, run_plans

    for _, level in problem.environment.water_levels:
        try:
            plans = run_plans(problem, problem.environment.water_at(level))
            _check_steps(problem, level, max(plan.duration for plan in plans), findings)
            for plan in plans:
                if plan.duration > _LONGEST_RUN:
                    findings.fault(
                        ("settings", "duration"), f"the run '{plan.name}' of {plan.duration:g} s never ends",
                        allowed=f"at most {_LONGEST_RUN:g} s", remedy="run shorter pieces",
                    )  # fmt: skip
                    return
                if (problem.settings.skip or 0.0) >= plan.duration:
                    findings.fault(
                        ("settings", "skip"),
                        f"{problem.settings.skip:g} s leave nothing of the run '{plan.name}' of {plan.duration:g} s",
                        allowed=f"less than {plan.duration:g} s", remedy="shorten 'skip', or run longer",
                    )  # fmt: skip
                    return
                if plan.output_step > plan.duration:
                    findings.fault(
                        ("settings", "output_step"),
                        f"rows every {plan.output_step:g} s leave nothing of the run '{plan.name}'",
                        allowed=f"at most {plan.duration:g} s",
                    )  # fmt: skip
                    return
                _check_depth(problem, level, motions_of(problem, plan.duration), findings)
                if plan.duration / plan.output_step > _MANY_ROWS:
                    findings.fault(
                        ("settings", "output_step"),
                        f"the run '{plan.name}' of {plan.duration:g} s would have "
                        f"{plan.duration / plan.output_step:.3g} rows",
                        allowed=f"at most {_MANY_ROWS}", remedy="lengthen output_step",
                    )  # fmt: skip
        except InputError as error:
            fault = error.fault
            settings = ("settings",) if ("settings",) in findings.document.values else ("analyses",)
            path = ("current",) if fault.path == "current_along_wave" else findings.path_of(fault.path) or settings
            findings.fault(path, fault.message, allowed=fault.allowed, remedy=fault.remedy)
            return


def _check_depth(problem: NetworkProblem, level: float, motions: Mapping[str, Motion], findings: Findings) -> None:
    """Refuse motions that drive a point under the bed."""
    import numpy as np

    from moyai.structures.network.assembly import assemble

    network = assemble(problem, level).network
    flat = -problem.environment.water_at(level).depth
    for point in problem.points:
        if point.kind != "driven" or not point.motion:
            continue
        path = network.nodes.position[network.points[point.name]] + motions[point.motion].displacement
        levels = np.full(len(path), flat) if network.bed is None else network.bed.level_at(path)
        worst = int(np.argmin(path[:, 2] - levels))
        lowest, bed = float(path[worst, 2]), float(levels[worst])
        if lowest < bed - (1e-9 * abs(bed) if network.bed is None else network.bed.tolerance):
            findings.fault(
                ("structure", "points", point.name, "motion"),
                f"the motion '{point.motion}' drives '{point.name}' down to z = {lowest:.4g} m above still water",
                allowed=f"at least {bed:.4g} m, the bed",
            )  # fmt: skip


def _check_places(model: NetworkCase, problem: NetworkProblem, findings: Findings) -> None:
    """Warn of what is allowed and odd: lines over-stretched as built, free points in the air, nets of many nodes."""
    import numpy as np

    from moyai.flexible.elements import FREE
    from moyai.structures.network.assembly import assemble

    _, level = problem.environment.water_levels[0]
    assembly = assemble(problem, level)
    network = assembly.network
    for line in problem.lines:
        strand = assembly.lines[line.name]
        distance = float(np.linalg.norm(np.diff(network.nodes.position[strand.nodes[[0, -1]]], axis=0)))
        strain = distance / line.length - 1.0
        if strain > 0.2:
            findings.warn(
                ("structure", "lines", line.name),
                f"its ends are {distance:.4g} m apart, {100 * strain:.0f} % more than its length",
                remedy="check the length and the places of its points",
            )  # fmt: skip
    if network.bed is not None and network.bed.ground is not None:
        _check_ground(network, problem.environment.water_at(level).depth, findings)
    if problem.bed is None and math.isfinite(problem.environment.water.depth):
        free = network.nodes.kind == FREE
        lowest = float(network.nodes.position[free, 2].min()) if free.any() else 0.0
        if lowest < -problem.environment.water_at(level).depth * (1.0 - 1e-6):
            findings.warn(("structure",), "there is no 'bed', and nodes reach the bed: they will sink into it",
                          remedy="give structure.bed")  # fmt: skip
    if len(network.nodes) > _MANY_NODES:
        findings.warn(("structure",), f"{len(network.nodes)} nodes take long")


def _check_ground(network: Network, depth: float, findings: Findings) -> None:
    """Warn of points beyond the grid of the bed, and of a bed deeper than the water of waves and current."""
    bed = network.bed
    assert bed is not None and bed.ground is not None
    levels = bed.level_at(network.nodes.position)
    for name, node in network.points.items():
        height = float(network.nodes.position[node, 2])
        if height < levels[node] - bed.tolerance:
            findings.fault(
                ("structure",), f"'{name}' starts at z = {height:.4g} m above still water, under the bed",
                allowed=f"at least {levels[node]:.4g} m", remedy="raise it, or correct the depths of the bed",
            )  # fmt: skip
    beyond = bed.ground.beyond(network.nodes.position)
    if beyond.any():
        named = [name for name, node in network.points.items() if beyond[node]]
        one = named[0] if named else network.strands[0].name
        findings.warn(
            ("structure", "bed"),
            f"{int(beyond.sum())} nodes of the network, some of '{one}' among them, are beyond the grid of the bed, "
            "which is flat there",
            remedy="give a grid that covers the network",
        )
    lowest = float(levels.min())
    if lowest < -depth * 1.05:
        findings.warn(
            ("site", "water_depth"),
            f"under the network the bed lies down to {-lowest:.4g} m below still water; waves and current are those of "
            f"{depth:.4g} m",
            remedy="give the greatest depth under the network",
        )  # fmt: skip


def _check_steps(problem: NetworkProblem, level: float, longest: float, findings: Findings) -> None:
    """Refuse runs of so many steps that they never end: bars of next to no length, meshes of next to no mass."""
    import numpy as np

    from moyai.structures.network.assembly import assemble

    assembly = assemble(problem, level)
    bars = assembly.network.bars
    if not len(bars) or problem.settings.step is not None or problem.settings.method not in ("auto", "explicit"):
        return
    # the pace of the elastic wave along the shortest bar; water, bends and bed only slow it down
    crossing = bars.length * np.sqrt(bars.of_type("mass_per_length") / bars.of_type("axial_stiffness"))
    quickest = int(np.argmin(crossing))
    steps = longest / float(crossing[quickest])
    if steps * len(assembly.network.nodes) < _MOST_NODE_STEPS:
        return
    owner = next((name for name, strand in assembly.lines.items() if quickest in strand.bars), "")
    path = ("structure", "lines", owner) if owner else ("structure",)
    findings.fault(
        path,
        f"bars of {bars.length[quickest]:.3g} m ask for steps of {crossing[quickest]:.2g} s: {steps:.2g} steps of "
        f"{len(assembly.network.nodes)} nodes for a run of {longest:g} s never end",
        allowed=f"{_MOST_NODE_STEPS:g} nodes times steps",
        remedy="give it fewer segments or more length, or another method",
    )  # fmt: skip
