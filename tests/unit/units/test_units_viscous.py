"""Eddies along the edges of units: the section's own law, quadrature by hand, energy, frequency against time."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from moyai.floating.viscous import edge_damping, water_measure
from moyai.floating.viscous_section import section_edges
from moyai.sea.dispersion import wave_number
from moyai.sea.environment import Environment
from moyai.structures.units.assembly import RowAtLevel, assemble
from moyai.structures.units.model import Placement
from moyai.structures.units.time.memory import RowMemory
from moyai.structures.units.time.model import RowInTime
from moyai.structures.units.viscous import LinearEddies, eddies_of
from moyai.validation.units import LENGTH, WATER, row

EMPTY = RowMemory(np.zeros(0, dtype=complex), np.zeros((0, 12, 12)), np.zeros((12, 12)), 0.0, 0.0, 0.0)
PLANAR = [0, 2, 4]


def at_rest(heading: float = 0.0) -> RowAtLevel:
    given = replace(row(), viscous_factor=1.0, damping_fraction=np.zeros(6))
    if heading:
        turned = [
            Placement(-place.y * np.sin(heading), place.y * np.cos(heading), heading) for place in given.placements
        ]
        given = replace(given, placements=tuple(turned))
    return assemble(given, Environment(WATER), "SWL", 0.0)


def force(at: RowAtLevel, velocity: np.ndarray) -> np.ndarray:
    found = eddies_of(at)
    assert found is not None
    return found.drag.force(velocity)


def test_sway_heave_and_roll_of_a_unit_are_those_of_its_section() -> None:
    """The strips of a unit that moves in the plane of its section add up to the section times the length."""
    at = at_rest()
    edges = section_edges(at.section)
    centre = (0.0, float(at.centres[0, 2]))
    plane = edge_damping(edges.corners, edges.plates, centre, WATER.density, LENGTH)
    generator = np.random.default_rng(1)
    for _ in range(10):
        speed = generator.normal(size=3) * [1.0, 1.0, 0.2]
        velocity = np.zeros(12)
        # roll about y turns z towards x, as the section's: x = theta z
        velocity[[6, 8, 10]] = speed
        expected = plane.force(np.array([speed[0], speed[1], speed[2]]))
        found = force(at, velocity)
        assert np.allclose(found[[6, 8, 10]], expected, rtol=1e-10, atol=1e-6)
        assert np.abs(found[:6]).max() == 0.0
        # by symmetry nothing along the unit
        assert np.abs(found[[7, 9, 11]]).max() < 1e-9 * np.abs(expected).max() * LENGTH


def test_yaw_and_pitch_by_hand() -> None:
    """|r y| r y y over the length is r^2 l^4 / 32; the sway and heave of the section give the rest."""
    at = at_rest()
    plane = edge_damping((edges := section_edges(at.section)).corners, edges.plates, (0.0, 0.0), WATER.density, 1.0)
    for turn, slide in ((5, 0), (3, 2)):
        velocity, unit = np.zeros(12), np.zeros(3)
        velocity[turn], unit[slide // 2] = 0.1, 1.0
        # pitch and yaw about the centre move the strips alone where their arms have no other part
        per_length = -plane.force(unit)[slide // 2]
        expected = per_length * 0.1**2 * LENGTH**4 / 32.0
        assert -force(at, velocity)[turn] == pytest.approx(expected, rel=0.04)


@pytest.mark.parametrize("heading", [0.0, 0.7])
def test_the_water_at_the_edges_is_that_of_the_wave(heading: float) -> None:
    """The middle strip sees the section's own wave, the others the same with the phase along the row."""
    at = at_rest(heading)
    found = eddies_of(at)
    assert found is not None
    omega, beta = np.array([0.7, 1.4]), 0.5
    moving = found.water_motion(omega[:, None], np.array([beta]), WATER.depth, WATER.gravity)[:, 0].reshape(2, 2, 3, -1)
    k = np.asarray(wave_number(omega, WATER.depth, WATER.gravity))
    edges = section_edges(at.section)
    own = water_measure(edges.corners, edges.plates, omega, k, np.full(2, beta - heading), WATER.depth)
    for unit, place in enumerate(at.row.placements):
        for strip, node in enumerate(np.polynomial.legendre.leggauss(3)[0]):
            x, y, _ = place.to_row(np.array([0.0, 0.5 * LENGTH * node, 0.0]))
            phase = np.exp(1j * k * (x * np.cos(beta) + y * np.sin(beta)))
            assert np.allclose(moving[:, unit, strip], phase[:, None] * own, rtol=1e-10, atol=1e-12)


def test_a_unit_that_goes_with_the_water_sheds_nothing() -> None:
    at = at_rest()
    found = eddies_of(at)
    assert found is not None
    # a very long wave across carries the units with the water at their keel
    omega, heading = np.array([0.02]), np.zeros(1)
    motion = np.zeros((1, 1, 12), dtype=complex)
    k = float(wave_number(omega[0], WATER.depth, WATER.gravity))
    motion[0, 0, [0, 6]] = 1j / np.tanh(k * WATER.depth)
    motion[0, 0, [2, 8]] = 1.0 - 3.0 / WATER.depth
    linear = LinearEddies(found, np.ones(len(found.points)), True)
    water = found.water_motion(omega[:, None], heading, WATER.depth, WATER.gravity)
    moving = linear.measured(omega, water, motion)
    assert np.abs(moving).max() < 0.02 * np.abs(water).max()


@pytest.mark.slow
def test_free_decay_against_an_integrator_of_its_own() -> None:
    """Roll, heave and sway let go with quadratic drag and nothing else."""
    at = at_rest()
    model = RowInTime(at, EMPTY, np.zeros(12), 1.0)
    start = np.zeros(12)
    start[[2, 4, 9, 10]] = 0.4, 0.12, 0.03, -0.1
    step, count = 0.02, 3001
    run = model.run(np.zeros((count, 12)), step, start=start)
    inverse = np.linalg.inv(model.mass)
    drag = eddies_of(at).drag

    def rate(_: float, state: np.ndarray) -> np.ndarray:
        measure = drag.directions @ state[12:]
        pull = -at.hydrostatic @ state[:12] - drag.directions.T @ (drag.coefficients * np.abs(measure) * measure)
        return np.concatenate([state[12:], inverse @ pull])

    found = solve_ivp(rate, (0.0, step * (count - 1)), np.concatenate([start, np.zeros(12)]), rtol=1e-6, atol=1e-8,
                      t_eval=run.time)  # fmt: skip
    exact = found.y[:12].T
    assert np.abs(run.position - exact).max(axis=0)[[2, 4, 9, 10]] == pytest.approx(0.0, abs=3e-3)
    kinetic = 0.5 * np.einsum("ti,ij,tj->t", run.velocity, model.mass, run.velocity)
    total = kinetic + 0.5 * np.einsum("ti,ij,tj->t", run.position, at.hydrostatic, run.position)
    assert np.all(np.diff(total) <= 1e-4 * total[0]) and total[-1] < 0.7 * total[0]
    # what the constraints would bear: nothing is held, so nothing is left over
    assert run.held.shape[1] == 0
