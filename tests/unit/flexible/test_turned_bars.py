"""One damped bar in any direction is the damped oscillator: force, damping and slack have no axes of their own."""

import math

import numpy as np
import pytest
from networks_for_tests import NO_GRAVITY

from moyai.flexible.build import NetworkBuilder
from moyai.flexible.network import BarType
from moyai.flexible.result import State
from moyai.flexible.simulation import simulate

DIRECTIONS = [(0.6, 0.64, 0.48), (-0.48, 0.6, 0.64), (0.0, -1.0, 0.0), (0.28, 0.0, 0.96)]


@pytest.mark.parametrize("method", ["explicit", "tr_bdf2"])
@pytest.mark.parametrize("direction", DIRECTIONS)
def test_axial_vibration_decays_as_the_damped_oscillator(method, direction):
    length, mass, stiffness, viscosity = 3.0, 5.0, 4e4, 600.0
    along = np.array(direction)
    anchor = np.array([2.0, -1.0, -50.0])
    builder = NetworkBuilder(NO_GRAVITY)
    builder.fixed("anchor", tuple(anchor))
    builder.free("bob", tuple(anchor + length * along), mass=mass)
    bar = BarType("bar", 1e-9, stiffness, 1e-9, viscosity=viscosity, tension_only=False)
    builder.line("bar", "anchor", "bob", bar, length=length, segments=1)
    omega = math.sqrt(stiffness / length / mass)
    ratio = viscosity / length / (2.0 * mass * omega)
    damped = omega * math.sqrt(1.0 - ratio**2)
    duration = 3.0 * 2.0 * math.pi / damped
    begin = State(0.0, np.array([anchor, anchor + 1.01 * length * along]), np.zeros((2, 3)))
    found = simulate(
        builder.build(), duration=duration, output_step=duration / 300, step=duration / 12000, start=begin,
        method=method, keep_nodes=[1],
    )  # fmt: skip
    stretch = (found.position[:, 0] - anchor) @ along - length
    t = found.time
    turn = np.cos(damped * t) + ratio * omega / damped * np.sin(damped * t)
    exact = 0.01 * length * np.exp(-ratio * omega * t) * turn
    assert stretch == pytest.approx(exact, abs=2e-3 * 0.01 * length)
    aside = (found.position[:, 0] - anchor) - np.outer((found.position[:, 0] - anchor) @ along, along)
    assert np.max(np.abs(aside)) < 1e-9
