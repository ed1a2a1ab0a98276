"""The reaction of a lumped mass on the body that carries it, over one step, against its exact mean and tilt."""

import numpy as np
import pytest

from moyai.coupled.planar_kernel import _reaction
from moyai.flexible.explicit_rows import LEDGER, MXX, ROW, TOTAL_ROWS


@pytest.mark.parametrize("seed", range(3))
def test_acceleration_linear_in_time_gives_mean_and_tilt(seed):
    rng = np.random.default_rng(seed)
    h, points = rng.uniform(0.01, 0.1), 2
    array = np.zeros(TOTAL_ROWS * ROW)
    nodes = np.array([3, 7])
    half = rng.uniform(-1.0, 1.0, (points, 3, 3))
    masses = half @ half.transpose(0, 2, 1) + 2.0 * np.eye(3)
    for p, node in enumerate(nodes):
        upper = masses[p][np.triu_indices(3)]
        for row in range(6):
            array[MXX + row * ROW + node] = upper[row]
    # a(t) = first + rate t from place x and velocity v
    x, v, first, rate = rng.uniform(-1.0, 1.0, (4, points, 3))
    now = np.array([x, v])
    then = np.array([x + v * h + first * h**2 / 2 + rate * h**3 / 6, v + first * h + rate * h**2 / 2])
    # a force of the network on the points, linear too: impulse and moment of the impulse about the start
    push, growth = rng.uniform(-50.0, 50.0, (2, points, 3))
    ledger = np.zeros(LEDGER + 6 * points)
    slots = np.array([1, 0])
    for p in range(points):
        ledger[LEDGER + 6 * slots[p] : LEDGER + 6 * slots[p] + 3] = push[p] * h + growth[p] * h**2 / 2
        ledger[LEDGER + 6 * slots[p] + 3 : LEDGER + 6 * slots[p] + 6] = push[p] * h**2 / 2 + growth[p] * h**3 / 3
    answer = np.zeros((2, points, 3))
    _reaction(array, nodes, slots, ledger, now, then, h, answer)
    for p in range(points):
        middle = push[p] + growth[p] * h / 2 - masses[p] @ (first[p] + rate[p] * h / 2)
        end = push[p] + growth[p] * h - masses[p] @ (first[p] + rate[p] * h)
        assert answer[0, p] == pytest.approx(middle, rel=1e-9, abs=1e-9)
        assert answer[1, p] == pytest.approx(end - middle, rel=1e-5, abs=1e-8)
