"""Derived numbers of a row of units: units at rest, panels, waves against panels, what the run costs."""

from __future__ import annotations

import math
from collections.abc import Iterator

from moyai.case.builder import build
from moyai.case.derived import Number
from moyai.case.reader import Case
from moyai.interop.bodies import bodies_of
from moyai.sea.dispersion import wave_number
from moyai.sea.states import IrregularSea
from moyai.structures.units.assembly import RowAtLevel, assemble
from moyai.structures.units.bem import memory_needed
from moyai.structures.units.coefficients_file import read_row
from moyai.structures.units.field import LINE_POINTS
from moyai.structures.units.model import UnitsProblem
from moyai.structures.units.run import WITH_WAVES, highest_frequency, irregular_frequency, row_panels
from moyai.structures.units.seas import frequencies_of, headings_of
from moyai.structures.units.time.band import further_frequencies, memory_band
from moyai.structures.units.time.model import STEPS_OF_WAVE

#: Processor time of a run but for what follows [s]
_FIXED = 4.0
#: Processor time of the waves of two panels [s], of 1/r of two panels, once for all frequencies [s], of the tables of a
#: frequency [s], of one operation of the solver [s], and of a step through time over the square of the degrees of
#: freedom, runs with the ends of assumed damping and what is read of them included [s]
_PER_PAIR, _PER_STEADY_PAIR, _PER_TABLE, _PER_OPERATION, _PER_STEP = 1e-7, 1.2e-6, 0.05, 1.5e-10, 1.2e-7


def derived_numbers(case: Case) -> tuple[Number, ...]:
    """Return the derived numbers of a case."""
    problem: UnitsProblem = build(case)
    numbers: list[Number] = []
    for name, level in problem.environment.water_levels:
        at = assemble(problem.row, problem.environment, name, level)
        numbers.extend(_unit_numbers(name, at))
        numbers.extend(_panel_numbers(name, at, problem))
    return tuple(numbers)


def _unit_numbers(level: str, at: RowAtLevel) -> Iterator[Number]:
    group = "Units at rest"
    yield Number(group, level, "number of units", float(at.row.count))
    yield Number(group, level, "water depth", at.water.depth, "m")
    yield Number(group, level, "draught", at.draught, "m")
    yield Number(group, level, "freeboard", at.freeboard, "m")
    yield Number(group, level, "mass of a unit", float(at.masses.mean()), "t" if at.masses.mean() > 2000.0 else "kg", 5)
    yield Number(group, level, "metacentric height GM of a unit", at.statics.metacentric_height, "m")
    yield Number(group, level, "motions that connectors leave", float(at.free.shape[1]))


def _panel_numbers(level: str, at: RowAtLevel, problem: UnitsProblem) -> Iterator[Number]:
    omega = frequencies_of(problem.environment, problem.settings)
    if not omega.size or not WITH_WAVES & set(problem.settings.analyses):
        return
    if problem.coefficients is not None:
        dataset = read_row(problem.coefficients)
        group, own = "Coefficients of the file", dataset["omega"].values
        yield Number(group, level, "bodies", float(len(bodies_of(dataset)) or 1))
        yield Number(group, level, "frequencies in the file", float(own.size))
        yield Number(group, level, "lowest frequency in the file", float(own[0]), "rad/s", 4)
        yield Number(group, level, "highest frequency in the file", float(own[-1]), "rad/s", 4)
        yield Number(group, level, "headings in the file", float(dataset.sizes["wave_direction"]))
        return
    panels = row_panels(at, problem.settings, highest_frequency(omega, problem.settings))
    group, mesh = "Panels", panels.mesh
    mirrors = len(panels.symmetry.mirrors)
    shortest = 2.0 * math.pi / float(wave_number(float(omega.max()), at.water.depth, at.water.gravity))
    yield Number(group, level, "panels", float(mesh.count))
    yield Number(group, level, "parts of the mesh that mirrors make alike", float(mirrors))
    yield Number(group, level, "longest side of a panel", mesh.longest_side, "m", 3)
    yield Number(group, level, "shortest wave", shortest, "m", 3)
    yield Number(group, level, "panels a shortest wave", shortest / mesh.longest_side, "", 3)
    yield Number(
        group, level, "standing wave inside of a hull, period", 2.0 * math.pi / irregular_frequency(at), "s", 3
    )
    yield Number(group, level, "frequencies", float(omega.size))
    yield Number(group, level, "headings", float(headings_of(problem.environment).size))
    part = mesh.count / mirrors
    solved = omega.size
    if "time" in problem.settings.analyses:
        band = memory_band(omega, panels, at.water)
        solved += further_frequencies(omega, *band, problem.settings.time.memory_frequencies).size
        yield Number(group, level, "frequencies with those of the memory", float(solved))
    pairs = mesh.count * part
    solver = mirrors * 8.0 / 3.0 * part**3 * _PER_OPERATION
    seconds = _FIXED + pairs * _PER_STEADY_PAIR + solved * (pairs * _PER_PAIR + _PER_TABLE + solver)
    if "map" in problem.settings.analyses:
        area = problem.map_area
        points = area.cells[0] * area.cells[1] + len(area.points) + (LINE_POINTS if area.line is not None else 0)
        seconds += points * mesh.count * (_PER_STEADY_PAIR + omega.size * _PER_PAIR)
    if "time" in problem.settings.analyses:
        steps = problem.settings.time.time_step or 2.0 * math.pi / float(omega.max()) / STEPS_OF_WAVE
        lasting = sum(sea.duration for sea in problem.environment.sea_states if isinstance(sea, IrregularSea))
        seconds += problem.settings.time.realisations * lasting / steps * _PER_STEP * (6 * at.row.count) ** 2
    yield Number(group, level, "memory in GiB", memory_needed(mesh.count, mirrors) / 2**30, "", 2)
    yield Number(group, level, "processor time, about", seconds, "s", 2)
