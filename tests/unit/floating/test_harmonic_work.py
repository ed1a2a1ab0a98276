"""Work of a steady motion by harmonic, against closed forms."""

from __future__ import annotations

import math

import numpy as np
import pytest

from moyai.floating.coefficients import Hydrodynamics
from moyai.floating.damping import QuadraticDamping
from moyai.floating.energy import drag_force, harmonic_work
from moyai.floating.time import Simulation

PERIOD = 2.0
OMEGA = 2.0 * math.pi / PERIOD


def simulation(position, velocity, force):
    time = PERIOD / 80.0 * np.arange(len(position))
    none = np.zeros((len(time), 0))
    return Simulation(time, position, velocity, force, none, np.zeros(len(time)), PERIOD / 80.0, "converged", "")


def water(damping):
    """Return radiation damping ``damping`` (n,) in sway at one, two and three times the wave frequency."""
    matrix = np.zeros((3, 3, 3))
    matrix[:, 0, 0] = damping
    excitation = np.zeros((3, 1, 3), dtype=complex)
    return Hydrodynamics(OMEGA * np.arange(1, 4), np.zeros((3, 3, 3)), matrix, excitation, np.zeros(1), ("x", "z", "r"))


def test_work_of_linear_damping_waves_and_a_line_by_hand():
    """Sway 0.3 cos(wt) + 0.1 cos(2wt); a line of dashpot 5 N s/m; a matrix of damping 7; radiation 11 at 2w."""
    phase = OMEGA * PERIOD / 80.0 * np.arange(80 * 6 + 1)
    position, velocity = np.zeros((2, len(phase), 3))
    position[:, 0] = 0.3 * np.cos(phase) + 0.1 * np.cos(2.0 * phase)
    velocity[:, 0] = -OMEGA * (0.3 * np.sin(phase) + 0.2 * np.sin(2.0 * phase))
    drag = drag_force(QuadraticDamping(np.eye(3)[:1], np.array([4.0])), velocity)
    found = harmonic_work(
        simulation(position, velocity, -5.0 * velocity), PERIOD, 4, np.diag([7.0, 0, 0]), water([0, 11, 0]), drag
    )
    first, second = 0.5 * (0.3 * OMEGA) ** 2, 0.5 * (0.2 * OMEGA) ** 2
    assert found.damping == pytest.approx([7.0 * first, 7.0 * second, 0.0], abs=1e-9)
    assert found.lines == pytest.approx([5.0 * first, 5.0 * second, 0.0], abs=1e-9)
    assert found.lines_in_all == pytest.approx(5.0 * (first + second), rel=1e-9)
    assert math.isnan(found.radiation[0])
    assert found.radiation[1:] == pytest.approx([11.0 * second, 0.0], abs=1e-9)


def test_drag_of_one_harmonic_takes_the_work_of_its_equal_work_equivalent():
    phase = OMEGA * PERIOD / 80.0 * np.arange(80 * 6 + 1)
    velocity = np.zeros((len(phase), 3))
    velocity[:, 2] = 0.4 * np.sin(phase)
    position = np.zeros_like(velocity)
    position[:, 2] = -0.4 / OMEGA * np.cos(phase)
    drag = drag_force(QuadraticDamping(np.eye(3)[2:], np.array([6.0])), velocity)
    found = harmonic_work(
        simulation(position, velocity, 0.0 * velocity), PERIOD, 4, np.zeros((3, 3)), water([0] * 3), drag
    )
    # [eq:floating-equal-work]: mean power 4/(3 pi) c v^3
    assert found.drag[0] == pytest.approx(4.0 / (3.0 * math.pi) * 6.0 * 0.4**3, rel=1e-3)


def test_drag_in_water_that_moves_along_with_the_body_is_none():
    velocity = np.random.default_rng(3).normal(size=(20, 3))
    rows = np.array([[1.0, 0.0, 0.2], [0.0, 1.0, 0.0]])
    quadratic = QuadraticDamping(rows, np.array([3.0, 5.0]))
    assert drag_force(quadratic, velocity, velocity @ rows.T) == pytest.approx(0.0, abs=1e-12)
    # the water belongs to the last rows: the first row is in still water
    alone = drag_force(quadratic, velocity, velocity @ rows[1:].T)
    assert alone == pytest.approx(drag_force(QuadraticDamping(rows[:1], np.array([3.0])), velocity), rel=1e-12)
    assert alone[0] == pytest.approx(QuadraticDamping(rows[:1], np.array([3.0])).force(velocity[0]), rel=1e-12)
