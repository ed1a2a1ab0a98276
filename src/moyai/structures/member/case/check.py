"""Checks of a member case: is it in its water, do its waves break, does its law of the circulation cover them."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from moyai.case.check_sea import LARGEST_USUAL_ANGLE_DEG, along, check_level_names, check_surroundings, wave_path
from moyai.case.findings import Findings
from moyai.case.headings import heading_of
from moyai.case.schema_environment import PeriodRange, SpectrumFile
from moyai.case.yaml_reader import KeyPath
from moyai.core.errors import ConvergenceError, InputError
from moyai.structures.member.case import schema

if TYPE_CHECKING:
    from moyai.structures.member.model import MemberProblem


#: Kinematic viscosity of water from boiling to freezing, salt included, with room [m2/s]
_WATER_VISCOSITY = (2e-7, 3e-6)
#: Roughness over width above which it is no roughness any more
_LARGEST_ROUGHNESS = 0.1
#: Slope from which a member through the surface is a pile or a brace, and up to which it lies flat [deg]
_STEEP_DEG, _FLAT_DEG = 30.0, 20.0
#: Share of such a member in the air that a lost sign explains better than its design
_MUCH_DRY = 0.2
#: Strips below which loads that vary along a member are coarsely summed: four are 3 to 8 % off along a pile in waves
_FEW_STRIPS = 8


def check(model: schema.MemberCase, findings: Findings, folder: Path) -> None:
    """Record every fault and warning of a member case in ``findings``."""
    check_surroundings(model, findings, folder)
    _check_settings(model, findings)
    _check_motion(model, findings)
    _check_current_alone(model, findings)
    if not findings.sound("site", "waves", "structure", "current", "settings"):
        return
    from moyai.structures.member.case.build import build_problem

    try:
        problem = build_problem(model, folder)
    except InputError as error:
        findings.raised(error, ("structure",))
        return
    _check_place(problem, findings)
    _check_support(model, problem, findings)
    _check_lie(model, problem, findings)
    _check_section(problem, findings)
    if findings.sound("structure"):
        _check_waves(model, problem, findings)
        _check_law(model, problem, findings)
    if findings.sound("waves", "structure"):
        _check_existence(model, problem, findings)


def _check_settings(model: schema.MemberCase, findings: Findings) -> None:
    check_level_names(model, findings)
    if model.waves and model.settings.strips < _FEW_STRIPS:
        findings.warn(
            ("settings", "strips"),
            f"the strips are few ({model.settings.strips}): waves vary along each, and forces and moments have no band "
            "for that",
            allowed=f"{_FEW_STRIPS} or more; 40 by default", remedy="give more strips",
        )  # fmt: skip
    for index, state in enumerate(model.waves):
        periods = getattr(state, "periods", None)
        if isinstance(periods, PeriodRange) and periods.first == periods.last:
            findings.fault(wave_path(findings, index, "periods"), "'from' and 'to' are equal", remedy="give 'period'")


def _check_motion(model: schema.MemberCase, findings: Findings) -> None:
    motion = model.structure.motion
    if motion is None:
        return
    regular = [isinstance(state, schema.MemberRegularWaves) for state in model.waves]
    if motion.period is None and not all(regular):
        findings.fault(
            ("structure", "motion"), "in irregular seas the motion has no single period", remedy="give 'period'"
        )
    if motion.period is None:
        return
    for state in model.waves:
        if isinstance(state, schema.MemberRegularWaves) and any(
            abs(period - motion.period) > 1e-9 * period for period in state.all_periods()
        ):
            findings.fault(
                ("structure", "motion", "period"),
                f"the motion of {motion.period:g} s does not repeat itself in the regular waves",
                remedy="leave 'period' out, so that the member moves with each wave, or use an irregular sea",
            )
            return


def _check_current_alone(model: schema.MemberCase, findings: Findings) -> None:
    if model.waves:
        if model.structure.circulation is None:
            findings.fault(
                ("structure",), "the key 'circulation' is missing: how the circulation at small KC is treated",
                allowed="purpose: extreme (left out, the safe side) or response (counted)",
            )  # fmt: skip
        return
    if model.current is None:
        findings.fault((), "neither waves nor a current are given", remedy="give 'waves', 'current' or both")
        return
    if model.structure.motion is not None:
        findings.fault(
            ("structure", "motion"), "a member moves with its waves, and there are none", remedy="give 'waves'"
        )
    drag = model.structure.drag
    if isinstance(drag, schema.DragTable) and drag.law == "stokes_wang":
        findings.fault(
            ("structure", "drag"), "the law 'stokes_wang' is for small orbits; a current alone is steady",
            allowed="steady, dnv_c205, api, or numbers",
        )  # fmt: skip
    if "forces" not in model.analyses:
        findings.fault(("analyses",), "without waves there are forces alone", remedy="add 'forces'")


def _check_place(problem: MemberProblem, findings: Findings) -> None:
    from moyai.structures.member.checks import require_in_water

    for name, level in problem.environment.water_levels:
        try:
            require_in_water(problem.member_at(level), problem.environment.water_at(level), f"water level {name}")
        except InputError as error:
            findings.raised(error, ("structure", "start"))
            return


def _check_support(model: schema.MemberCase, problem: MemberProblem, findings: Findings) -> None:
    """Ask how a member is held that stands on the bed: one that reaches above the surface, or is held at its top."""
    lower, upper = sorted((("start", problem.member.start[2]), ("end", problem.member.end[2])), key=lambda one: one[1])
    name, level = min(problem.environment.water_levels, key=lambda one: one[1])
    depth = problem.environment.water_at(level).depth
    if not math.isfinite(depth) or lower[1] > level - depth + problem.member.placed_section.breadth:
        return
    if "support" in model.structure.model_fields_set:
        if model.structure.support == upper[0] and upper[1] > lower[1]:
            findings.warn(
                ("structure", "support"),
                f"the member is fixed at its upper end and free at its '{lower[0]}', which is on the bed",
                remedy=f"give support: {lower[0]} for a pile fixed in the bed, support: both_ends where its head is "
                "held as well",
            )
        return
    if upper[1] > level:
        findings.warn(
            ("structure",),
            f"the member reaches from the bed to above still water ({name}); both ends are taken as simply supported",
            remedy=f"give support: {lower[0]} for a pile fixed in the bed, support: both_ends where its head is held",
        )


def _check_lie(model: schema.MemberCase, problem: MemberProblem, findings: Findings) -> None:
    """Warn of a flat member with one end in the air, and of waves or a current that run along a flat member."""
    if not findings.sound("structure"):
        return
    member = problem.member
    axis = np.asarray(member.end) - np.asarray(member.start)
    flat = math.hypot(axis[0], axis[1])
    slope = math.degrees(math.atan2(abs(axis[2]), flat))
    levels = [level for _, level in problem.environment.water_levels]
    low, high = sorted((float(member.start[2]), float(member.end[2])))
    dry = (high - max(levels)) / (high - low) if high > low else 0.0
    if slope < _STEEP_DEG and low < min(levels) and dry > _MUCH_DRY:
        key = "start" if member.start[2] > member.end[2] else "end"
        findings.warn(
            ("structure", key, "z"),
            f"one end is {high - max(levels):.4g} m above still water and the other {min(levels) - low:.4g} m "
            f"below it, in a member inclined by {slope:.3g} degrees: {100.0 * dry:.2g} % of it is dry",
            allowed=f"piles and braces rise by {_STEEP_DEG:g} degrees and more",
            remedy="check the sign of z; heights below datum are negative",
        )
    if slope > _FLAT_DEG or flat == 0.0:
        return
    ways: list[tuple[KeyPath, str, Any]] = [
        (wave_path(findings, index), f"waves of '{sea.name}'", state)
        for index, (state, sea) in enumerate(zip(model.waves, problem.seas))
    ]
    ways += [] if model.current is None else [(("current",), "current", model.current)]
    for path, what, entry in ways:
        keys = ("heading_deg", "from_bearing_deg", "to_bearing_deg")
        key = next(key for key in keys if getattr(entry, key, None) is not None)
        heading = heading_of(entry, model.site.x_axis_bearing_deg, ".".join(map(str, path)))
        across = abs(axis[0] * math.sin(heading) - axis[1] * math.cos(heading)) / flat
        angle = math.degrees(math.acos(min(across, 1.0)))
        if angle > LARGEST_USUAL_ANGLE_DEG:
            along((*path, key), what, angle, "the member", findings)


def _check_section(problem: MemberProblem, findings: Findings) -> None:
    from moyai.morison.coefficients import Conditions

    if not _WATER_VISCOSITY[0] <= problem.kinematic_viscosity <= _WATER_VISCOSITY[1]:
        findings.warn(
            ("structure", "kinematic_viscosity"),
            f"{problem.kinematic_viscosity:.3g} m2/s is not the kinematic viscosity of water",
            remedy="water has 0.3e-6 to 2e-6 m2/s",
        )
    width = problem.member.placed_section.breadth
    if problem.roughness > _LARGEST_ROUGHNESS * width:
        findings.fault(
            ("structure", "drag", "roughness"),
            f"{problem.roughness:g} m is no roughness of a member {width:.3g} m wide",
            allowed=f"at most {_LARGEST_ROUGHNESS * width:.3g} m",
            remedy="add growth to the diameter; the roughness is the height of the protrusions",
        )
    try:
        problem.rule.at(problem.member.section, Conditions(1.0, 1e6, 1e5))
    except (InputError, ConvergenceError) as error:
        path: KeyPath = ("structure", error.fault.path) if error.fault.path in ("drag", "inertia") else ("structure",)
        if path not in findings.document.values:
            path = ("structure",)
        findings.fault(path, error.fault.message, allowed=error.fault.allowed, remedy=error.fault.remedy)


def _check_waves(model: schema.MemberCase, problem: MemberProblem, findings: Findings) -> None:
    """Compare every sea state with breaking and the limits of its theory, at every water level."""
    from moyai.sea.validity import check_spectrum, check_wave

    for index, (state, sea) in enumerate(zip(model.waves, problem.seas)):
        said: set[str] = set()
        for name, level in problem.environment.water_levels:
            water = problem.environment.water_at(level)
            pairs: list[tuple[str, Any]] = []
            if isinstance(state, schema.MemberRegularWaves):
                key = "height" if state.height is not None else "heights"
                pairs = [(key, check_wave(state.highest, period, water)) for period in state.all_periods()]
            else:
                key = "file" if isinstance(state, SpectrumFile) else "significant_height"
                pairs = [(key, check_spectrum(sea.spectrum, water))]  # type: ignore[union-attr]
            theory = getattr(state, "theory", "linear")
            for key, notices in pairs:
                for notice in notices:
                    if notice.severity == "information" or notice.code in said:
                        continue
                    if theory != "linear" and notice.severity != "error" and "linear" in notice.message:
                        # the warning is about linear theory, which this state does not use
                        continue
                    said.add(notice.code)
                    record = findings.fault if notice.severity == "error" else findings.warn
                    where = f" (water level {name})" if len(problem.environment.water_levels) > 1 else ""
                    record(wave_path(findings, index, key), f"{notice.message}{where}", remedy=notice.remedy)


def _check_existence(model: schema.MemberCase, problem: MemberProblem, findings: Findings) -> None:
    """Try to make every wave: a current may block it, and a theory may have no solution."""
    from moyai.sea.states import IrregularSea
    from moyai.structures.member.waves import waves_of

    for index, sea in enumerate(problem.seas):
        # a short piece of an irregular sea has the same band of frequencies
        short = (
            replace(sea, duration=min(sea.duration, 20.0 * sea.spectrum.peak_period))
            if isinstance(sea, IrregularSea)
            else sea
        )
        for _, level in problem.environment.water_levels:
            try:
                waves_of(problem, short, problem.environment.water_at(level))
            except (InputError, ConvergenceError) as error:
                fault = error.fault
                path: KeyPath = ("current",) if "current" in fault.path else wave_path(findings, index)
                findings.fault(path, fault.message, allowed=fault.allowed, remedy=fault.remedy)
                break


def _check_law(model: schema.MemberCase, problem: MemberProblem, findings: Findings) -> None:
    """Warn where waves take the member beyond the circulation law, and where a current leaves it without data."""
    law = problem.circulation
    path: KeyPath = ("structure", "circulation")
    if not law.counted:
        return
    if model.current is not None:
        findings.warn((*path, "purpose"), "no measurement shows how a current changes the circulation")
    if law.gamma() > 3.0:
        findings.warn((*path, "strength"), f"gamma = {law.gamma():g} exceeds the laminar 3", remedy="measured: about 1")
    section = problem.member.placed_section
    upright = math.cos(problem.member.inclination) < 1e-6
    smallest = section.inertia.principal[0]
    for index, number in enumerate(largest_numbers(problem)):
        if upright and getattr(problem.seas[index], "spreading", None) is None:
            # long crests move the water to and fro across an upright member: no orbit, no circulation
            continue
        reached = np.linspace(0.0, min(number, law.largest), 81)[1:]
        fall = float(np.max(law.reduction(reached, section.breadth, section.area, law.gamma()), initial=0.0))
        if fall > smallest:
            findings.warn(
                path,
                f"the reduction reaches {fall:.3g} in '{problem.seas[index].name}', more than the inertia coefficient "
                f"{smallest:.3g} of the section",
                remedy="check 'table'; the law was measured on sections of proportions up to 1.9",
            )
        inside = law.table and law.table[0][0] <= number <= law.table[-1][0]
        if number > 2.0 and not inside:
            what = "the reduction of KC = 2 is held" if number <= 3.0 else "no reduction is counted there"
            findings.warn(
                path,
                f"KC reaches about {number:.2g} in '{problem.seas[index].name}', beyond the law's 2; {what}",
                remedy="give 'table' with the reduction for KC 2 to 4, or 'purpose: extreme'",
            )


def largest_numbers(problem: MemberProblem) -> list[float]:
    """Return about the largest Keulegan-Carpenter number of every sea state, by linear theory."""
    from moyai.sea.dispersion import wave_number
    from moyai.sea.kinematics import depth_functions
    from moyai.structures.member.model import MemberWaves

    level = max(value for _, value in problem.environment.water_levels)
    water, member = problem.environment.water_at(level), problem.member_at(level)
    centres = member.strips(problem.settings.strips).centres[:, 2]
    top = float(min(centres.max(), 0.0))
    found = []
    for sea in problem.seas:
        if isinstance(sea, MemberWaves):
            pairs = sea.waves()
        else:
            # amplitude of the harmonic motion of equal variance
            pairs = ((float(sea.spectrum.significant_height) / math.sqrt(2.0), float(sea.spectrum.mean_period)),)
        height, period = np.array([h for h, _ in pairs]), np.array([t for _, t in pairs])
        number = np.array([wave_number(2.0 * math.pi / t, water.depth, water.gravity) for t in period])
        horizontal = depth_functions(number, water.depth, top)[0]
        found.append(float(np.max(math.pi * height * horizontal / problem.member.placed_section.breadth)))
    return found
