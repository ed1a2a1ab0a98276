"""Sections of added mass against Lagrange's equations with complex-step derivatives and scipy's DOP853.

Heavy nodes, sections that gather to a fifth of their first length, and components that are held.
"""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from moyai.flexible.elements import FIXED, Bars, BarType, Nodes
from moyai.flexible.mass_blocks import MassBlocks
from moyai.flexible.network import Network
from moyai.flexible.result import State
from moyai.flexible.simulation import simulate
from moyai.sea.water import Water

NO_WEIGHT = Water(20.0, 1000.0, 1e-9)
SECTIONS = np.array([[1, 6], [2, 7], [3, 8]])


def two_strings(rng: np.random.Generator, own: float, water: float, held: list[tuple[int, int]]) -> Network:
    """Return two strings of three heavy nodes each, joined in three sections of two nodes."""
    rope = BarType("rope", 1e-6, 200.0, 0.0, volume_per_length=0.0, tension_only=False)
    place, kind = np.zeros((10, 3)), np.zeros(10, dtype=int)
    place[:, 1] = np.tile(np.linspace(0.0, 4.0, 5), 2)
    place[:, 0] = 0.5 * np.sin(math.pi * place[:, 1] / 4.0)
    place[5:, 2] = -1.0
    place[:, :2] += 0.05 * rng.normal(size=(10, 2))
    kind[[0, 4, 5, 9]] = FIXED
    first, last = np.array([0, 1, 2, 3, 5, 6, 7, 8, 1, 2, 3]), np.array([1, 2, 3, 4, 6, 7, 8, 9, 6, 7, 8])
    length = np.linalg.norm(place[last] - place[first], axis=1) * rng.uniform(0.99, 1.005, 11)
    half = rng.normal(size=(3, 4, 4))
    blocks = MassBlocks(
        SECTIONS, np.stack([SECTIONS - 1, SECTIONS + 1], axis=-1), water * half @ half.transpose(0, 2, 1)
    )
    mass, stays = np.zeros(10), np.zeros((10, 3), dtype=bool)
    mass[SECTIONS.ravel()] = own * rng.uniform(0.5, 2.0, 6)
    for node, axis in held:
        stays[node, axis] = True
    bars = Bars(first, last, length, np.zeros(11, dtype=int), (rope,))
    return Network(Nodes(place, kind, stays, mass=mass), bars, NO_WEIGHT, blocks=blocks)


def whole_mass(network: Network, place: np.ndarray) -> np.ndarray:
    """Return the mass matrix at (complex) places: own mass and the water's in the frames of the sections."""
    blocks, built = network.blocks, network.nodes.position
    assert blocks is not None
    out = np.diag(np.repeat(network.node_mass, 3)).astype(place.dtype)
    for nodes, guides, added in zip(blocks.nodes, blocks.guides, blocks.added_mass, strict=True):
        local = np.zeros((2 * nodes.size, place.size), dtype=place.dtype)
        for i, node in enumerate(nodes):
            dx, dy = (place[guides[i, 1]] - place[guides[i, 0]])[:2]
            size = np.sqrt(dx * dx + dy * dy)
            root = np.sqrt(size / math.hypot(*(built[guides[i, 1]] - built[guides[i, 0]])[:2]))
            local[i, 3 * node], local[i, 3 * node + 1] = root * dy / size, -root * dx / size
            local[nodes.size + i, 3 * node + 2] = root
        out = out + local.T @ added @ local
    return out


@pytest.mark.slow
@pytest.mark.parametrize(
    ("seed", "own", "water", "speed", "held", "gathered"),
    [
        (0, 5.0, 0.5, 1.5, [], 0.5),
        (0, 20.0, 0.1, 1.5, [], 0.2),
        pytest.param(1, 0.05, 5.0, 0.5, [], 0.9, marks=pytest.mark.slow),
        (2, 5.0, 2.0, 1.0, [(1, 1), (6, 1)], 0.9),
        (3, 5.0, 2.0, 1.0, [(2, 0), (7, 0), (3, 0), (7, 2)], 0.9),
    ],
)
def test_heavy_gathered_and_held_sections(
    seed: int, own: float, water: float, speed: float, held: list[tuple[int, int]], gathered: float
) -> None:
    rng = np.random.default_rng(seed)
    network = two_strings(rng, own, water, held)
    place, count = np.array(network.nodes.position), len(network.nodes)
    velocity = np.zeros((count, 3))
    velocity[SECTIONS.ravel()] = speed * rng.normal(size=(6, 3))
    velocity[[1, 6], 1] += 2.0 * speed
    velocity[[3, 8], 1] -= 2.0 * speed
    velocity[network.nodes.held] = 0.0
    free = np.flatnonzero(((network.nodes.kind == 0)[:, None] & ~network.nodes.held).ravel())
    bars = network.bars

    def rate(_time: float, state: np.ndarray) -> np.ndarray:
        q, v, force = place.copy(), np.zeros(3 * count), np.zeros((count, 3))
        q.ravel()[free], v[free] = state[: free.size], state[free.size :]
        way = q[bars.end] - q[bars.start]
        size = np.linalg.norm(way, axis=1)
        pull = (200.0 * (size / bars.length - 1.0) / size)[:, None] * way
        np.add.at(force, bars.start, pull)
        np.add.at(force, bars.end, -pull)
        push = force.ravel()
        for index in free:
            moved = q.astype(complex)
            moved.ravel()[index] += 1e-30j
            slope = whole_mass(network, moved).imag * 1e30
            push[index] += 0.5 * v @ slope @ v
            push -= v[index] * (slope @ v)
        mass = whole_mass(network, q)[np.ix_(free, free)]
        return np.concatenate([v[free], np.linalg.solve(mass, push[free])])

    start = np.concatenate([place.ravel()[free], velocity.ravel()[free]])
    last = 0.5
    exact = solve_ivp(rate, (0.0, last), start, "DOP853", rtol=1e-7, atol=1e-9).y[:, -1]
    history = simulate(
        network, duration=last, output_step=last / 20, start=State(0.0, place, velocity), step=last / 4000
    )
    moved = np.max(np.abs(exact[: free.size] - start[: free.size]))
    assert np.max(np.abs(history.final.position.ravel()[free] - exact[: free.size])) < 1e-4 * moved
    energy = history.kinetic_energy + history.elastic_energy
    assert np.max(np.abs(energy / energy[0] - 1.0)) < 2e-4
    # the case does gather as far as its name says
    path = history.position[:, SECTIONS + 1, :2] - history.position[:, SECTIONS - 1, :2]
    stretch = np.linalg.norm(path, axis=-1)
    assert float(np.min(stretch / stretch[0])) < gathered
