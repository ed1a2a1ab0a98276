"""Dense mass blocks against Lagrange's equations integrated by other means, symmetries, faults."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from moyai.core.errors import InputError
from moyai.flexible.elements import FIXED, Bars, BarType, Nodes
from moyai.flexible.mass_block_kernel import COS, LENGTH, ROOT, SIN, block_loads, room_for
from moyai.flexible.mass_blocks import MassBlocks
from moyai.flexible.network import Network
from moyai.flexible.result import State
from moyai.flexible.simulation import simulate
from moyai.sea.water import Water

WATER = Water(20.0, 1000.0, 1e-9)


def small_network(rng: np.random.Generator, convective: bool, turn: float = 0.0) -> tuple[Network, np.ndarray]:
    """Return two strings of three moving nodes each, one above the other, joined in sections of two nodes."""
    rope = BarType("rope", 0.4, 300.0, 0.0, volume_per_length=0.0, tension_only=False)
    y = np.linspace(0.0, 4.0, 5)
    place = np.zeros((10, 3))
    place[:5, 1], place[5:, 1] = y, y
    place[:5, 0] = place[5:, 0] = 0.4 * np.sin(math.pi * y / 4.0)
    place[5:, 2] = -1.0
    place[:, 0] += 0.05 * rng.normal(size=10)
    c, s = math.cos(turn), math.sin(turn)
    spin = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
    place = place @ spin.T
    kind = np.zeros(10, dtype=int)
    kind[[0, 4, 5, 9]] = FIXED
    first = np.array([0, 1, 2, 3, 5, 6, 7, 8, 1, 2, 3])
    last = np.array([1, 2, 3, 4, 6, 7, 8, 9, 6, 7, 8])
    length = np.linalg.norm(place[last] - place[first], axis=1) * rng.uniform(0.99, 1.005, first.size)
    nodes = np.array([[1, 6], [2, 7], [3, 8]])
    guides = np.stack([nodes - 1, nodes + 1], axis=-1)
    half = rng.normal(size=(3, 4, 4))
    # more than the own mass, as water around a sheet has: own mass in a stretching frame is exact to first order only
    blocks = MassBlocks(nodes, guides, 5.0 * half @ half.transpose(0, 2, 1), convective)
    bars = Bars(first, last, length, np.zeros(first.size, dtype=int), (rope,))
    speed = np.zeros((10, 3))
    speed[nodes.ravel()] = 0.5 * rng.normal(size=(6, 3)) @ spin.T
    return Network(Nodes(place, kind), bars, WATER, blocks=blocks), speed


def matrix(network: Network, place: np.ndarray) -> np.ndarray:
    """Return the mass matrix of all nodes, own mass and blocks in their frames."""
    blocks, built = network.blocks, network.nodes.position
    assert blocks is not None
    count = len(network.nodes)
    whole = np.diag(np.repeat(network.node_mass, 3))
    for nodes, guides, added in zip(blocks.nodes, blocks.guides, blocks.added_mass, strict=True):
        spread = np.zeros((2 * nodes.size, 3 * count))
        for i, node in enumerate(nodes):
            way = (place[guides[i, 1]] - place[guides[i, 0]])[:2]
            first = np.linalg.norm((built[guides[i, 1]] - built[guides[i, 0]])[:2])
            size = np.linalg.norm(way)
            root = math.sqrt(size / first) if blocks.convective else 1.0
            spread[i, 3 * node : 3 * node + 2] = root * np.array([way[1], -way[0]]) / size
            spread[nodes.size + i, 3 * node + 2] = root
        whole += spread.T @ added @ spread
    return whole


def bar_forces(network: Network, place: np.ndarray) -> np.ndarray:
    bars, out = network.bars, np.zeros_like(place)
    way = place[bars.end] - place[bars.start]
    size = np.linalg.norm(way, axis=1)
    pull = ((size / bars.length - 1.0) * bars.of_type("axial_stiffness") / size)[:, None] * way
    np.add.at(out, bars.start, pull)
    np.add.at(out, bars.end, -pull)
    return out


def test_water_that_goes_along_with_all_nodes_presses_as_water_at_rest() -> None:
    """Only the velocity of nodes in the water counts: one that both have changes nothing, along any axis."""
    rng = np.random.default_rng(5)
    axis = 6
    nodes = np.array([[1, 4]])
    guides = np.array([[[0, 2], [3, 5]]])
    frames = np.zeros((1, 2, 1 + max(COS, SIN, ROOT, LENGTH)))
    frames[..., COS], frames[..., SIN], frames[..., ROOT], frames[..., LENGTH] = 0.6, 0.8, 1.1, 2.0
    half = rng.normal(size=(4, 4))
    velocity, water = 0, 3 * axis
    force = 9 * axis
    start = np.concatenate([rng.normal(size=9 * axis), np.zeros(3 * axis)])
    along = start.copy()
    for k, speed in enumerate((0.7, -0.4, 1.3)):
        for place in (velocity, water):
            along[place + k * axis : place + (k + 1) * axis] += speed
    for state in (start, along):
        block_loads(
            nodes, guides, frames, (half @ half.T)[None], state, velocity, water, force, axis, False, True,
            room_for(nodes),
        )  # fmt: skip
    assert np.abs(start[force:]).min(where=start[force:] != 0.0, initial=1.0) > 1e-3
    assert np.count_nonzero(start[force:]) >= 6
    np.testing.assert_allclose(along[force:], start[force:], rtol=0.0, atol=1e-12)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("seed", "convective"),
    [(0, True), (0, False), (3, False), *(pytest.param(s, True, marks=pytest.mark.slow) for s in (1, 2))],
)
def test_motion_by_lagranges_equations(seed: int, convective: bool) -> None:
    """The same small system by Lagrange's equations, mass matrix and its derivatives by differences, and DOP853."""
    network, speed = small_network(np.random.default_rng(seed), convective)
    place = np.array(network.nodes.position)
    free = np.flatnonzero(np.repeat(network.nodes.kind == 0, 3))

    def rate(_time: float, state: np.ndarray) -> np.ndarray:
        q, v = place.copy(), np.zeros(place.size)
        q.ravel()[free], v[free] = state[: free.size], state[free.size :]
        force = bar_forces(network, q).ravel()
        if convective:
            step = 1e-6
            for index in free:
                moved = q.copy()
                moved.ravel()[index] += step
                high = matrix(network, moved)
                moved.ravel()[index] -= 2.0 * step
                slope = (high - matrix(network, moved)) / (2.0 * step)
                force[index] += 0.5 * v @ slope @ v
                force -= v[index] * (slope @ v)
        mass = matrix(network, q)[np.ix_(free, free)]
        return np.concatenate([v[free], np.linalg.solve(mass, force[free])])

    start = np.concatenate([place.ravel()[free], speed.ravel()[free]])
    last = 0.12
    wanted = solve_ivp(rate, (0.0, last), start, "RK45", rtol=1e-6, atol=1e-9).y[:, -1]
    history = simulate(
        network, duration=last, output_step=last / 10, start=State(0.0, place, speed), step=last / 4000
    )  # fmt: skip
    found = history.final.position.ravel()[free]
    moved = np.max(np.abs(wanted[: free.size] - start[: free.size]))
    assert np.max(np.abs(found - wanted[: free.size])) < 2e-4 * moved


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(3))
def test_energy_is_kept_and_the_problem_may_be_turned(seed: int) -> None:
    network, speed = small_network(np.random.default_rng(seed), True)
    run = {"duration": 1.0, "output_step": 0.02, "step": 5e-5}
    history = simulate(network, start=State(0.0, np.array(network.nodes.position), speed), **run)
    total = history.kinetic_energy + history.elastic_energy
    assert np.max(np.abs(total / total[0] - 1.0)) < 2e-3
    assert np.max(np.abs(history.work)) < 2e-3 * total[0]
    other, turned = small_network(np.random.default_rng(seed), True, 1.1)
    again = simulate(other, start=State(0.0, np.array(other.nodes.position), turned), **run)
    assert again.tension_peak == pytest.approx(history.tension_peak, rel=1e-3, abs=1e-3 * history.tension_peak.max())


def test_frozen_frames_lose_energy_that_turning_ones_keep() -> None:
    """Added mass times acceleration alone, as the papers have it, does not conserve the energy of a turning section."""
    drift = []
    for convective in (True, False):
        network, speed = small_network(np.random.default_rng(4), convective)
        history = simulate(
            network, duration=1.0, output_step=0.02, step=1e-4,
            start=State(0.0, np.array(network.nodes.position), 3.0 * speed),
        )  # fmt: skip
        total = history.kinetic_energy + history.elastic_energy
        drift.append(float(np.max(np.abs(total / total[0] - 1.0))))
    assert drift[0] < 0.01 < drift[1]


def test_faults() -> None:
    nodes, guides = [[1]], [[[0, 2]]]
    good = np.array([[[1.0, 0.0], [0.0, 1.0]]])
    cases = (
        ({"nodes": [1]}, "groups of shape"),
        ({"guides": [[[0, 0]]]}, "same"),
        ({"added_mass": good[:, :1]}, "added_mass has shape"),
        ({"added_mass": np.array([[[1.0, 0.5], [0.0, 1.0]]])}, "not symmetric"),
        ({"added_mass": -good}, "negative value"),
        ({"nodes": [[1], [1]], "guides": guides * 2, "added_mass": np.repeat(good, 2, axis=0)}, "two sections"),
    )
    for change, words in cases:
        with pytest.raises(InputError, match=words):
            MassBlocks(**{"nodes": nodes, "guides": guides, "added_mass": good, **change})
    rope = BarType("rope", 0.4, 300.0, 0.0)
    place = [[0.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 2.0, 0.0]]
    bars = Bars([0, 1], [1, 2], [1.0, 1.0], [0, 0], (rope,))
    with pytest.raises(InputError, match="cannot move"):
        Network(Nodes(place, [FIXED] * 3), bars, WATER, blocks=MassBlocks(nodes, guides, good))
    with pytest.raises(InputError, match="does not exist"):
        Network(Nodes(place, [FIXED, 0, FIXED]), bars, WATER, blocks=MassBlocks([[7]], guides, good))
