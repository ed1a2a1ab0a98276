"""Derived numbers of a breakwater case: waves against depth and beam, balance, natural periods, lines at rest."""

from __future__ import annotations

import math
from collections.abc import Iterator

from moyai.case.builder import build
from moyai.case.derived import Number, force_unit
from moyai.case.reader import Case
from moyai.sea.dispersion import wave_number
from moyai.sea.water import Water
from moyai.structures.breakwater.assembly import FloatingUnit, assemble
from moyai.structures.breakwater.model import BreakwaterProblem, RegularSea


def derived_numbers(case: Case) -> tuple[Number, ...]:
    """Return the derived numbers of a breakwater case."""
    problem: BreakwaterProblem = build(case)
    environment = problem.environment
    numbers: list[Number] = []
    for name, level in environment.water_levels:
        unit = assemble(problem, name, level)
        numbers.extend(_unit_numbers(name, unit, problem))
        numbers.extend(_line_numbers(name, unit))
    deepest = max(environment.water_levels, key=lambda entry: entry[1])
    shallowest = min(environment.water_levels, key=lambda entry: entry[1])
    for name, level in dict.fromkeys((deepest, shallowest)):
        numbers.extend(_wave_numbers(name, environment.water_at(level), problem))
    return tuple(numbers)


def _unit_numbers(level: str, unit: FloatingUnit, problem: BreakwaterProblem) -> Iterator[Number]:
    breakwater = problem.breakwater
    yield Number("Unit at rest", level, "water depth", unit.water.depth, "m")
    yield Number("Unit at rest", level, "draught", unit.draught, "m")
    yield Number("Unit at rest", level, "freeboard", unit.freeboard, "m")
    yield Number("Unit at rest", level, "mass of the unit", unit.mass, "t" if unit.mass > 2000.0 else "kg", 5)
    displaced = unit.statics.displaced_mass
    yield Number("Unit at rest", level, "displaced mass", displaced, "t" if displaced > 2000.0 else "kg", 5)
    if unit.lines:
        yield Number("Unit at rest", level, "downward pull of the lines", unit.line_pull, force_unit(unit.line_pull))
    if breakwater.mass is not None and breakwater.draught is not None:
        yield Number("Unit at rest", level, "imbalance of mass and draught", 0.01 * unit.imbalance, "%", 3)
    if abs(unit.heel) > 1e-9:
        yield Number("Unit at rest", level, "heel at rest", unit.heel, "deg", 3)
    yield Number("Unit at rest", level, "metacentric height GM", unit.statics.metacentric_height, "m")
    yield from _natural_periods(level, unit, problem)


def _natural_periods(level: str, unit: FloatingUnit, problem: BreakwaterProblem) -> Iterator[Number]:
    if problem.breakwater.coefficients_file is not None:
        # Coefficients of another program are fetched by the run itself
        return
    from moyai.floating.modes import natural_modes
    from moyai.structures.breakwater.hydrodynamics import coefficients_in_calm

    hydro = coefficients_in_calm(unit, problem)
    stiffness = unit.statics.stiffness + unit.mooring_stiffness
    for label, period in zip(("sway", "heave", "roll"), natural_modes(hydro, unit.inertia, stiffness).period):
        if math.isfinite(period) and period > 0.0:
            yield Number("Unit at rest", level, f"natural period, {label}", float(period), "s")


def _line_numbers(level: str, unit: FloatingUnit) -> Iterator[Number]:
    import numpy as np

    for line in unit.lines:
        state = line.solve(np.array([line.fairlead]), unit.water.depth + unit.centre[1])
        tension = float(state.tension_fairlead[0])
        yield Number("Lines at rest", level, f"{line.name}: tension at the fairlead", tension, force_unit(tension))
        if math.isfinite(line.breaking_load):
            yield Number(
                "Lines at rest", level, f"{line.name}: share of the breaking load", tension / line.breaking_load, "%", 3
            )
        grounded = float(state.grounded_length[0])
        if grounded > 0.0:
            yield Number("Lines at rest", level, f"{line.name}: length on the bed", grounded, "m")


def _wave_numbers(level: str, water: Water, problem: BreakwaterProblem) -> Iterator[Number]:
    beam = problem.breakwater.hull.beam
    for sea in problem.environment.sea_states:
        group = f"Waves: {sea.name}"
        if isinstance(sea, RegularSea):
            periods, height, label = sorted({min(sea.periods), max(sea.periods)}), sea.height, "T"
        else:
            periods, height, label = [sea.spectrum.peak_period], sea.spectrum.significant_height, "Tp"
            yield Number(group, level, "significant height Hm0", height, "m")
        for period in periods:
            number = float(wave_number(2.0 * math.pi / period, water.depth, water.gravity))
            length = 2.0 * math.pi / number
            case = f"{label} = {period:g} s"
            yield Number(group, level, f"wavelength, {case}", length, "m")
            if math.isfinite(water.depth):
                yield Number(group, level, f"relative depth kh, {case}", number * water.depth)
            yield Number(group, level, f"wavelength over beam, {case}", length / beam)
            yield Number(group, level, f"steepness H/L, {case}", height / length, "", 3)
