"""Twin hulls: every mode of the water between them is found, and the memory carries its sharp resonance."""

import math
from dataclasses import replace

import numpy as np
import pytest

from moyai.core.progress import silent
from moyai.potential import shapes
from moyai.potential.memory import pair_measure
from moyai.sea.spectra import jonswap
from moyai.structures.breakwater.assembly import assemble
from moyai.structures.breakwater.hydrodynamics import (
    _solve_band,
    band,
    section_frequencies,
    sloshing_frequencies,
    spectrum_band,
    wide_band,
)
from moyai.structures.breakwater.memory_model import _functions, _states
from moyai.structures.breakwater.model import BreakwaterProblem, IrregularSea

GAP = 0.3


@pytest.fixture
def twin(pontoon_problem: BreakwaterProblem) -> BreakwaterProblem:
    hull = shapes.twin_pontoon(pontoon_beam=0.25, height=0.4, gap=GAP)
    unit = replace(
        pontoon_problem.breakwater, hull=hull, mass=None, draught=0.15, lines=(), centre_of_gravity=(0.0, 0.1),
        gap_damping_lid=0.02,
    )  # fmt: skip
    return replace(pontoon_problem, breakwater=unit)


def test_modes_of_the_water_between_hulls_are_looked_at(twin):
    name, level = twin.environment.water_levels[0]
    unit = assemble(twin, name, level)
    found = np.sort(sloshing_frequencies(unit, float(band(unit).omega[-1])))
    depth, gravity = unit.water.depth, unit.water.gravity
    for order in (1, 2, 3):
        k = order * math.pi / GAP
        assert np.min(np.abs(found / math.sqrt(gravity * k * math.tanh(k * depth)) - 1.0)) < 1e-9
    # the band ends a quarter behind an even mode
    k = found[-1] ** 2 / gravity
    assert (k * GAP / math.pi) % 2.0 == pytest.approx(0.25, abs=1e-3)
    # a hull alone has none
    assert not sloshing_frequencies(assemble(replace(twin, breakwater=replace(
        twin.breakwater, hull=shapes.rectangle(0.8, 0.4), gap_damping_lid=0.0)), name, level), 10.0).size  # fmt: skip


@pytest.mark.slow
def test_the_memory_carries_the_resonance_between_the_points_of_its_fit(twin):
    name, level = twin.environment.water_levels[0]
    unit = assemble(twin, name, level)
    solution = _solve_band(unit, np.sort(np.concatenate([wide_band(unit), section_frequencies(unit, twin)])), silent)
    functions, _ = _functions(unit, solution[1][0])
    states, fault = _states(functions)
    assert states is not None, fault
    omega = np.linspace(0.5, float(functions.model.knots[-1]), 6000)
    exact = functions.model.response(omega)
    error = np.abs(states.response(omega) - exact) / pair_measure(np.abs(exact))
    assert float(error.max()) < 3.0 * max(states.error, 1e-3)


def test_seas_of_near_periods_share_their_frequencies_unless_the_hull_is_very_wide(pontoon_problem):
    """Few states of a scatter diagram move the ends; splines could not follow the phase along a very wide hull."""

    def frequencies(period, beam):
        hull = shapes.rectangle(beam, 0.4)
        unit = replace(pontoon_problem.breakwater, hull=hull, mass=None, draught=0.15, lines=())
        sea = IrregularSea("storm", jonswap(0.02, period, 3.3))
        problem = replace(
            pontoon_problem,
            breakwater=unit,
            environment=replace(pontoon_problem.environment, sea_states=(sea,)),
        )
        name, level = problem.environment.water_levels[0]
        return section_frequencies(assemble(problem, name, level), problem), spectrum_band(sea)

    periods = np.linspace(1.0, 1.5, 21)
    assert len({frequencies(period, 0.5)[0].tobytes() for period in periods}) <= 7
    solved, band_of_sea = frequencies(1.0, 20.0)
    assert np.isin(np.round(band_of_sea, 9), np.round(solved, 9)).mean() > 0.99 and len(solved) < 500
