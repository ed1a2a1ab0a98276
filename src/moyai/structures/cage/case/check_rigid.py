"""Checks of a rigid cage case: does it float, do its lines reach, do its weights agree, does its law cover it."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from moyai.case.check_sea import wave_path
from moyai.case.faults import did_you_mean
from moyai.case.findings import Findings, duplicates
from moyai.case.yaml_reader import KeyPath
from moyai.core.errors import ConvergenceError, InputError
from moyai.structures.cage.case import schema
from moyai.structures.cage.case.schema_parts import LinesMooring

if TYPE_CHECKING:
    from moyai.structures.cage.rigid.model import RigidCageProblem

#: Kinematic viscosity of water from boiling to freezing, salt included, with room [m2/s]
_WATER_VISCOSITY = (2e-7, 3e-6)


def check_law_and_water(path: KeyPath, law: str, viscosity: float, findings: Findings) -> None:
    """Record a net law that is not known, and a viscosity that water does not have."""
    from moyai.morison.net_law_names import available_net_laws, known_net_law

    if not known_net_law(law):
        findings.fault(
            path,
            f"there is no net law '{law}'",
            allowed=", ".join(available_net_laws()),
            remedy=did_you_mean(law, available_net_laws()),
        )
    if not _WATER_VISCOSITY[0] <= viscosity <= _WATER_VISCOSITY[1]:
        findings.warn(
            ("structure", "kinematic_viscosity"),
            f"{viscosity:.3g} m2/s is not the kinematic viscosity of water",
            remedy="water has 0.3e-6 to 2e-6 m2/s",
        )


def check(model: schema.CageCase, findings: Findings, folder: Path) -> None:
    """Record every fault and warning of a rigid cage case in ``findings``."""
    from moyai.structures.cage.case.build_rigid import build_problem
    from moyai.structures.cage.rigid.statics import require_floating

    unit = model.structure
    assert isinstance(unit, schema.RigidCageStructure)
    check_law_and_water(("structure", "net", "drag", "law"), unit.net.drag.law, unit.kinematic_viscosity, findings)
    if isinstance(unit.mooring, LinesMooring):
        for index in duplicates([line.name for line in unit.mooring.lines]):
            name = unit.mooring.lines[index].name
            findings.fault(
                ("structure", "mooring", "lines", index, "name"), f"two lines are called '{name}'", remedy="rename one"
            )
    _check_analyses(model, findings)
    if not findings.sound("structure", "settings", "analyses"):
        return
    try:
        problem = build_problem(model, folder)
        for _, level in problem.environment.water_levels:
            require_floating(problem.cage, problem.environment.water_at(level))
    except InputError as error:
        findings.raised(error, ("structure",))
        return
    _check_parts(model, problem, findings)
    if _check_rest(problem, findings):
        _check_waves(problem, findings)


def _check_analyses(model: schema.CageCase, findings: Findings) -> None:
    needs = [name for name in ("time", "sensitivity") if name in model.analyses]
    if needs and not model.waves:
        findings.fault(
            ("analyses", model.analyses.index(needs[0])),
            f"'{needs[0]}' needs waves",
            remedy="give 'waves', or leave it out",
        )
    if "sensitivity" in model.analyses and len(model.settings.rigid.stiffnesses) == 1:
        findings.fault(
            ("settings", "rigid", "stiffnesses"),
            "one stiffness shows no sensitivity",
            allowed="at least 2 stiffnesses",
            remedy="give another, or leave 'stiffnesses' out",
        )
    # a faulty mooring is left out for these checks, but the file has one
    moored = "mooring" in findings.document.data["structure"]
    unit = model.structure
    assert isinstance(unit, schema.RigidCageStructure)
    if "sensitivity" in model.analyses and not moored:
        findings.fault(
            ("analyses", model.analyses.index("sensitivity")),
            "'sensitivity' varies the stiffness of lines, and the cage has none",
            remedy="give 'structure.mooring', or leave it out",
        )
    if not moored and unit.equations == "literal":
        findings.warn(
            ("structure", "equations"),
            "the literal equations hold no restoring force: without lines the cage leaves its place",
        )


def _check_parts(model: schema.CageCase, problem: RigidCageProblem, findings: Findings) -> None:
    """Warn where the twine's solid volume and its mass disagree, and where the frame's density is odd."""
    cage, unit = problem.cage, model.structure
    assert isinstance(unit, schema.RigidCageStructure)
    if unit.net.density is not None and cage.net_volume > 0.0:
        round_volume = cage.net.volume_per_area
        ratio = cage.net_volume / round_volume
        if not 1.0 / 3.0 <= ratio <= 3.0:
            findings.warn(
                ("structure", "net", "mass_per_area"),
                f"{cage.net_mass:.4g} kg/m2 make {ratio:.3g} times the volume of round twine of that mesh",
                remedy="check mass, density, twine and mesh",
            )
    volume = sum(rod.volume for rod in cage.rods)
    mass = sum(rod.mass for rod in cage.rods)
    if unit.frame.density is None and volume > 0.0 and unit.frame.mass is None:
        density = mass / volume
        if not 500.0 <= density <= 12000.0:
            findings.warn(
                ("structure", "weight", "mass"),
                f"the weight leaves {mass * 1e3:.4g} g for the frame, a density of {density:.4g} kg/m3",
                remedy="check whether the weight includes the floats",
            )
    low, high = cage.law.solidity_range
    number = cage.law.range_solidity(cage.net)
    if not low <= number <= high:
        findings.warn(
            ("structure", "net", "drag", "law"),
            f"the solidity {number:.3g} is outside {low:g} to {high:g}, the range of '{cage.law.name}'",
        )


def _check_rest(problem: RigidCageProblem, findings: Findings) -> bool:
    """Try to lay the cage at rest at every water level; ``False`` where the current does not suit the model."""
    from moyai.structures.cage.rigid.checks import level_notices
    from moyai.structures.cage.rigid.setup import at_level, lines_of
    from moyai.structures.cage.rigid.statics import equilibrium_with_lines, free_floating
    from moyai.structures.cage.rigid.waves import current_along

    viscosity = problem.kinematic_viscosity
    try:
        current_along(problem, problem.environment.water)
    except InputError as error:
        findings.raised(error, ("current",))
        return False
    try:
        lines = lines_of(problem)
        for name, level in problem.environment.water_levels:
            water = problem.environment.water_at(level)
            here = at_level(lines, level)
            free = free_floating(problem.cage, water, viscosity)
            current = problem.environment.current
            rest = equilibrium_with_lines(problem.cage, here, water, viscosity, current) if here else free
            for notice in level_notices(name, problem, here, water, free, rest):
                if notice.severity == "information":
                    continue
                record = findings.fault if notice.severity == "error" else findings.warn
                path = ("structure", "mooring") if here else ("structure",)
                record(path, notice.message, remedy=notice.remedy)
    except InputError as error:
        findings.raised(error, ("structure", "mooring"))
    except ConvergenceError as error:
        findings.fault(("structure", "mooring"), error.fault.message, remedy=error.fault.remedy)
    return True


def _check_waves(problem: RigidCageProblem, findings: Findings) -> None:
    """Try to make every wave, and compare the speeds it brings with the range of the net law."""
    from moyai.sea.states import IrregularSea
    from moyai.structures.cage.rigid.waves import current_along, waves_of

    said: set[str] = set()
    if not problem.seas and problem.plans and problem.environment.current is not None:
        speed = abs(current_along(problem, problem.environment.water))
        for notice in problem.cage.law.check(problem.cage.net, (speed, speed), problem.kinematic_viscosity):
            if notice.code == "net-reynolds-range":
                findings.warn(("current",), notice.message, remedy=notice.remedy)
    for index, sea in enumerate(problem.seas):
        short = replace(sea, duration=10.0 * float(sea.spectrum.peak_period)) if isinstance(sea, IrregularSea) else sea
        for _, level in problem.environment.water_levels:
            water = problem.environment.water_at(level)
            try:
                waves = waves_of(problem, short, water)
            except (InputError, ConvergenceError) as error:
                fault = error.fault
                path = ("current",) if "current" in fault.path else wave_path(findings, index)
                findings.fault(path, fault.message, allowed=fault.allowed, remedy=fault.remedy)
                break
            # a moored cage meets the current too
            flow = abs(current_along(problem, water)) if problem.plans else 0.0
            speed = flow + max(math.pi * wave.height / wave.period for wave in waves)
            slow = min(math.pi * wave.height / wave.period for wave in waves)
            for notice in problem.cage.law.check(problem.cage.net, (0.3 * slow, speed), problem.kinematic_viscosity):
                if notice.code == "net-reynolds-range" and notice.message not in said:
                    said.add(notice.message)
                    findings.warn(wave_path(findings, index), notice.message, remedy=notice.remedy)
