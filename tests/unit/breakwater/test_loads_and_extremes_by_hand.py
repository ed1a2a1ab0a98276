"""Steady wind on a pontoon and the extreme of a line under waves, held against sums by hand."""

import math
from dataclasses import replace

import numpy as np
import pytest

from moyai.floating.irregular import integration_weights
from moyai.sea.environment import Wind
from moyai.structures.breakwater.assembly import assemble
from moyai.structures.breakwater.loads import steady_forces
from moyai.structures.breakwater.slow_drift import combined_extremes


@pytest.mark.parametrize("heading", [0.0, math.pi])
def test_wind_pushes_at_half_the_freeboard(pontoon_problem, heading):
    wind = Wind(20.0, heading, 1.25)
    problem = replace(
        pontoon_problem,
        breakwater=replace(pontoon_problem.breakwater, wind_drag_coefficient=1.1),
        environment=replace(pontoon_problem.environment, wind=wind),
    )
    unit = assemble(problem, "SWL", 0.0)
    force, current = steady_forces(unit, problem.environment)
    freeboard = 0.17 - unit.draught
    push = 0.5 * 1.25 * 1.1 * 0.986 * freeboard * 20.0**2 * math.cos(heading)
    # the centre of gravity lies 0.086 m above the keel
    lever = 0.5 * freeboard - (0.086 - unit.draught)
    np.testing.assert_allclose(force, [push, 0.0, push * lever], rtol=1e-9)
    assert not current.any()


def test_a_line_is_solved_where_its_largest_linear_tension_takes_the_unit(pontoon_problem):
    """A tension that goes with sway alone: the unit stands the largest sway away, where the line pulls."""
    unit = assemble(pontoon_problem, "SWL", 0.0)
    omega = np.linspace(4.0, 8.0, 41)
    directional = np.exp(-(((omega - 6.0) / 0.5) ** 2))[:, None] * 1e-4
    motion = np.zeros((omega.size, 1, 3), dtype=complex)
    motion[..., 0] = 0.8 * np.exp(0.4j)
    seaward, shoreward = 50.0, -50.0
    tension = np.stack([seaward * motion[..., 0], shoreward * motion[..., 0]], axis=-1)
    largest = 3.5
    found = combined_extremes(
        unit, np.zeros(3), motion, tension, directional, omega, None, (np.full(3, largest), np.full(2, largest)), 1e4
    )
    sway = 0.8 * math.sqrt(float(np.sum(integration_weights(omega)[:, None] * directional)))
    for line, side in enumerate((1.0, -1.0)):
        place = np.array([[side * largest * sway, 0.0, 0.0]])
        state = list(unit.mooring.planar.states(place).values())[line]
        assert found.tension[line] == pytest.approx(float(state.tension_fairlead[0]), rel=1e-9)
        other = list(unit.mooring.planar.states(-place).values())[line]
        assert found.tension[line] > 1.05 * float(other.tension_fairlead[0])
    assert found.offset == pytest.approx(largest * sway, rel=1e-9)


def test_the_anchor_is_loaded_as_the_line_at_the_mean_of_storms_is(pontoon_problem):
    """The largest of storms alike is, on average, the most probable one of a storm so much longer."""
    unit = assemble(pontoon_problem, "SWL", 0.0)
    omega = np.linspace(4.0, 8.0, 41)
    directional = np.exp(-(((omega - 6.0) / 0.5) ** 2))[:, None] * 2e-4
    motion = np.zeros((omega.size, 1, 3), dtype=complex)
    motion[..., 0] = 0.8 * np.exp(0.4j)
    tension = np.stack([50.0 * motion[..., 0], -50.0 * motion[..., 0]], axis=-1)

    def extremes(largest):
        factors = np.full(3, largest), np.full(2, largest)
        return combined_extremes(unit, np.zeros(3), motion, tension, directional, omega, None, factors, 1e4)

    found, longer = extremes(3.5), extremes(3.5 + np.euler_gamma / 3.5)
    assert found.vertical_of_storms[:, 1] == pytest.approx(longer.anchor_vertical, rel=1e-9)
    assert found.horizontal_of_storms[:, 1] == pytest.approx(longer.anchor_horizontal, rel=1e-9)
    assert (np.diff(found.horizontal_of_storms, axis=1) > 0.0).all()
    # of a factor that is not above one there are no storms
    assert np.isnan(extremes(0.9).vertical_of_storms).all()
