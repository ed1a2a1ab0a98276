"""A damped line of bars in any direction is the damped chain of masses: force and damping have no axes of their own."""

import math

import numpy as np
import pytest
from networks_for_tests import NO_GRAVITY
from scipy.linalg import expm

from moyai.flexible.build import NetworkBuilder
from moyai.flexible.elements import BarType
from moyai.flexible.result import State
from moyai.flexible.simulation import simulate

DIRECTIONS = [(0.6, 0.64, 0.48), (-0.48, 0.6, 0.64), (0.0, -1.0, 0.0), (0.28, 0.0, 0.96)]


@pytest.mark.parametrize("method", ["explicit", "tr_bdf2"])
@pytest.mark.parametrize("direction", DIRECTIONS)
def test_axial_vibration_is_that_of_the_damped_chain(method, direction):
    inner, length, stiffness, viscosity, per_length = 3, 3.0, 4e4, 200.0, 1.5
    along, anchor, part = np.array(direction), np.array([2.0, -1.0, -50.0]), length / (inner + 1)
    builder = NetworkBuilder(NO_GRAVITY)
    builder.fixed("anchor", tuple(anchor))
    # stretched, so that no bar is ever pushed and gives way sideways
    builder.fixed("far", tuple(anchor + 1.05 * length * along))
    bar = BarType("bar", per_length, stiffness, 1e-9, viscosity=viscosity, tension_only=False)
    builder.line("line", "anchor", "far", bar, length=length, segments=inner + 1, shape="straight")
    network = builder.build()
    middle = np.argsort((network.nodes.position - anchor) @ along)[1:-1]
    chain = 2.0 * np.eye(inner) - np.eye(inner, k=1) - np.eye(inner, k=-1)
    mass = per_length * part
    system = np.block(
        [
            [np.zeros((inner, inner)), np.eye(inner)],
            [-stiffness / part / mass * chain, -viscosity / part / mass * chain],
        ]
    )
    moved = np.array([0.02, -0.01, 0.015])
    duration = 3.0 * 2.0 * length * math.sqrt(per_length / stiffness)
    rest = anchor + np.outer(1.05 * part * np.arange(1, inner + 1), along)
    start = network.nodes.position.copy()
    start[middle] = rest + np.outer(moved, along)
    found = simulate(
        network, duration=duration, output_step=duration / 200, step=duration / 16000, method=method,
        start=State(0.0, start, np.zeros_like(start)), keep_nodes=middle,
    )  # fmt: skip
    state, step, exact = np.concatenate([moved, np.zeros(inner)]), expm(system * duration / 200), []
    for _ in found.time:
        exact.append(state[:inner])
        state = step @ state
    assert found.time.size == 201
    shift = found.position - rest
    assert shift @ along == pytest.approx(np.array(exact), abs=5e-3 * np.abs(moved).max())
    assert np.max(np.abs(shift - (shift @ along)[..., None] * along)) < 1e-9
