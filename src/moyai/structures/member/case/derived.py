"""Derived numbers of a member case: section, inertia coefficients, waves, Keulegan-Carpenter numbers."""

from __future__ import annotations

import math
from collections.abc import Iterator

from moyai.case.builder import build
from moyai.case.derived import Number
from moyai.case.reader import Case
from moyai.sea.dispersion import wave_number
from moyai.structures.member.case.check import largest_numbers
from moyai.structures.member.model import MemberProblem, MemberWaves


def derived_numbers(case: Case) -> tuple[Number, ...]:
    """Return the derived numbers of a member case."""
    problem: MemberProblem = build(case)
    numbers: list[Number] = []
    for name, level in problem.environment.water_levels:
        numbers.extend(_member(problem, name, level))
        numbers.extend(_waves(problem, name, level))
    return tuple(numbers)


def _member(problem: MemberProblem, name: str, level: float) -> Iterator[Number]:
    member = problem.member_at(level)
    section = member.placed_section
    inertia = section.inertia
    yield Number("Member", name, "length", member.length, "m")
    yield Number("Member", name, "inclination to the horizontal", member.inclination, "deg")
    yield Number("Member", name, "highest point above still water", member.highest, "m")
    yield Number("Member", name, "area of the section", section.area, "m2")
    yield Number("Member", name, "inertia coefficient, first axis", float(inertia.tensor[0, 0]), "", 5)
    yield Number("Member", name, "inertia coefficient, second axis", float(inertia.tensor[1, 1]), "", 5)
    if abs(inertia.tensor[0, 1]) > 1e-9:
        yield Number("Member", name, "inertia coefficient, smallest", inertia.principal[0], "", 5)
        yield Number("Member", name, "inertia coefficient, largest", inertia.principal[1], "", 5)
        yield Number("Member", name, "direction of the smallest", inertia.principal_angle, "deg")


def _waves(problem: MemberProblem, name: str, level: float) -> Iterator[Number]:
    water = problem.environment.water_at(level)
    breadth = problem.member.placed_section.breadth
    for sea, number in zip(problem.seas, largest_numbers(problem)):
        group = f"Waves: {sea.name}"
        regular = isinstance(sea, MemberWaves)
        periods = sorted({min(sea.periods), max(sea.periods)}) if regular else [float(sea.spectrum.peak_period)]  # type: ignore[union-attr]
        label = "T" if regular else "Tp"
        for period in periods:
            length = 2.0 * math.pi / float(wave_number(2.0 * math.pi / period, water.depth, water.gravity))
            yield Number(group, name, f"wavelength, {label} = {period:g} s", length, "m")
            yield Number(group, name, f"breadth over wavelength, {label} = {period:g} s", breadth / length, "", 3)
            beta = breadth**2 / (period * problem.kinematic_viscosity)
            yield Number(group, name, f"frequency parameter beta, {label} = {period:g} s", beta)
        yield Number(group, name, "largest KC, about", number, "", 3)
