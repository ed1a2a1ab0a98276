"""Networks without weight: gravity 0, where elasticity and the water alone act."""

import math

import numpy as np
import pytest

from moyai.core.errors import InputError
from moyai.flexible import BarType, Flow, NetworkBuilder, natural_modes, simulate, solve_equilibrium
from moyai.flexible.statics import _shake
from moyai.sea import Water, wave_number

WATER = Water(10.0, 1025.0, 0.0)


def string(length, **properties):
    builder = NetworkBuilder(WATER)
    rope = BarType("rope", mass_per_length=10.0, axial_stiffness=1e5, diameter=0.05, **properties)
    builder.fixed("left", (0.0, 0.0, -2.0))
    builder.fixed("right", (20.0, 0.0, -2.0))
    builder.line("span", "left", "right", rope, length=length, segments=40)
    return builder.build()


def test_a_taut_string_bears_its_stretch_and_swings_with_it():
    network = string(19.0)
    rest = solve_equilibrium(network)
    tension = 1e5 * (20.0 / 19.0 - 1.0)
    assert np.allclose(rest.tension, tension, rtol=1e-9)
    assert np.abs(rest.state.position[:, 2] + 2.0).max() < 1e-9
    # n pi / L (T / m)^1/2 with the mass of the stretched metre
    expected = math.pi / 20.0 * math.sqrt(tension / (10.0 * 19.0 / 20.0))
    assert natural_modes(network, rest.state, count=2).omega == pytest.approx([expected, expected], rel=2e-3)
    history = simulate(network, {}, duration=0.5, output_step=0.1, start=rest.state)
    assert np.allclose(history.tension, tension, rtol=1e-9)


def test_a_loose_string_hangs_in_the_current():
    network = string(21.0, drag_normal=1.2)
    found = solve_equilibrium(network, flow=Flow(velocity=(0.0, 1.0, 0.0)))
    assert np.abs(found.state.position[:, 2] + 2.0).max() < 1e-6
    place = found.state.position
    sag, slope = place[:, 1].max(), np.diff(place, axis=0)
    # drag across each bar, rho/2 C d u_n |u_n|, half of it on either end
    across = np.cos(np.arctan2(slope[:, 1], slope[:, 0]))
    length = np.linalg.norm(slope, axis=1)
    drag = 0.5 * 1025.0 * 1.2 * 0.05 * float(np.sum(across**3 * length))
    end = slope[0] / length[0]
    assert sag > 2.0
    assert 2.0 * found.tension[0] * end[1] == pytest.approx(drag, rel=0.05)


@pytest.mark.parametrize("gravity", [-9.81, math.nan, math.inf])
def test_what_is_no_gravity_is_refused(gravity):
    with pytest.raises(InputError, match="gravity"):
        Water(10.0, 1025.0, gravity)


def test_there_are_no_waves_without_gravity():
    with pytest.raises(InputError, match="gravity is 0"):
        wave_number(1.0, WATER.depth, WATER.gravity)


def test_shaking_has_a_pace_without_gravity():
    network = string(19.0)
    rest = solve_equilibrium(network).state.position
    moved = rest + np.linspace(0.0, 1.0, len(rest))[:, None] * np.where(np.arange(len(rest)) % 2, 0.01, 0.0)[:, None]
    moved[[0, -1]] = rest[[0, -1]]
    assert np.abs(_shake(network, moved, Flow(), stops=True) - rest).max() < 0.05
