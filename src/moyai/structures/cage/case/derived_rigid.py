"""Derived numbers of a rigid cage case: masses, rest, natural periods, lines, waves."""

from __future__ import annotations

import math
from collections.abc import Iterator

from moyai.case.builder import build
from moyai.case.derived import Number
from moyai.case.reader import Case
from moyai.sea.states import IrregularSea
from moyai.structures.cage.rigid.lines import CageLine
from moyai.structures.cage.rigid.model import RigidCageProblem
from moyai.structures.cage.rigid.modes import natural_modes
from moyai.structures.cage.rigid.pack import pack
from moyai.structures.cage.rigid.setup import at_level, drowning_depth, lines_of
from moyai.structures.cage.rigid.statics import (
    equilibrium_with_lines,
    free_floating,
    reserve_buoyancy,
    size_of,
    submerged_weight,
)
from moyai.structures.cage.rigid.waves import waves_of


def derived_numbers(case: Case) -> tuple[Number, ...]:
    """Return the derived numbers of a rigid cage case."""
    problem: RigidCageProblem = build(case)
    lines = lines_of(problem)
    numbers: list[Number] = []
    for name, level in problem.environment.water_levels:
        numbers.extend(_body(problem, name, level))
        numbers.extend(_rest(problem, at_level(lines, level), name, level))
        numbers.extend(_waves(problem, name, level))
    return tuple(numbers)


def _body(problem: RigidCageProblem, name: str, level: float) -> Iterator[Number]:
    cage, water = problem.cage, problem.environment.water_at(level)
    yield Number("Cage", name, "mass in air", cage.mass, "g" if cage.mass < 10.0 else "kg")
    small = cage.mass < 10.0
    mass, volume, force = ("g", "cm3", "gf") if small else ("kg", "m3", "N")
    yield Number("Cage", name, "mass in air without floats", cage.mass_without_floats, mass)
    yield Number("Cage", name, "solid volume of net, frame, weights", cage.solid_volume, volume)
    frame = sum(rod.volume for rod in cage.rods)
    if frame > 0.0:
        yield Number("Cage", name, "density of the frame", sum(rod.mass for rod in cage.rods) / frame, "kg/m3")
    yield Number("Cage", name, "volume of the floats", cage.float_volume, volume)
    yield Number("Cage", name, "weight in water without floats", submerged_weight(cage, water), force)
    yield Number("Cage", name, "reserve of buoyancy", reserve_buoyancy(cage, water), force)
    yield Number("Cage", name, "centre of gravity above the middle", cage.centre[1], "mm" if small else "m")
    yield Number("Cage", name, "moment of inertia", cage.inertia, "kg m2")
    yield Number("Cage", name, "solidity of the net, geometric", cage.net.solidity, "")
    yield Number("Cage", name, "solidity of the net, listed", cage.net.listed, "")


def _rest(problem: RigidCageProblem, lines: tuple[CageLine, ...], name: str, level: float) -> Iterator[Number]:
    cage, water = problem.cage, problem.environment.water_at(level)
    viscosity = problem.kinematic_viscosity
    free = free_floating(cage, water, viscosity)
    rest = equilibrium_with_lines(cage, lines, water, viscosity, problem.environment.current) if lines else free
    length, force = ("mm", "gf") if cage.mass < 10.0 else ("m", "N")
    group = "At rest"
    yield Number(group, name, "middle of the cage, floating freely", free.middle_z, length)
    yield Number(group, name, "floats in water, floating freely", 100.0 * free.immersion, "", 3)
    yield Number(group, name, "pull that submerges the floats", drowning_depth(cage, free), length, 3)
    if lines:
        yield Number(group, name, "middle of the cage, moored", rest.middle_z, length)
        yield Number(group, name, "floats in water, moored", 100.0 * rest.immersion, "", 3)
    for line, tension in zip(lines, rest.tension):
        yield Number(group, name, f"{line.name}: length", line.length, "m")
        yield Number(group, name, f"{line.name}: tension", float(tension), force)
    packed = pack(cage, lines, water, viscosity)
    periods, _ = natural_modes(packed, rest, size_of(cage))
    for number, period in enumerate(periods):
        yield Number(
            group, name, f"natural period {number + 1}", float(period), "s" if math.isfinite(period) else "", 3
        )


def _waves(problem: RigidCageProblem, name: str, level: float) -> Iterator[Number]:
    water = problem.environment.water_at(level)
    twine = problem.cage.net.twine_diameter
    for sea in problem.seas:
        if isinstance(sea, IrregularSea):
            period = float(sea.spectrum.peak_period)
            yield Number(f"Waves: {sea.name}", name, "peak period", period, "s")
            continue
        for wave in waves_of(problem, sea, water):
            group = f"Waves: {sea.name}"
            kh = 2.0 * math.pi / wave.wavelength * water.depth
            yield Number(group, name, f"wavelength, {wave.name}", wave.wavelength, "m")
            yield Number(group, name, f"orbit at the surface, x over z, {wave.name}", 1.0 / math.tanh(kh), "", 3)
            speed = math.pi * wave.height / wave.period / math.tanh(kh)
            number = speed * twine / problem.kinematic_viscosity
            yield Number(group, name, f"Reynolds number of the twine, {wave.name}", number, "", 3)
