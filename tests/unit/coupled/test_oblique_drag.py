"""Drag of parts of a body in oblique flow: exact terminal velocities, and no hold on the axes that a body was given."""

from __future__ import annotations

import numpy as np
import pytest
from bodies_for_tests import SEA

from moyai.coupled.hulls import Lumps, volume_lump
from moyai.coupled.rigid import RigidBody
from moyai.mooring.rotations import rotation_from_vector

DENSITY, VOLUME, AREA = SEA.density, 0.01, 0.3


def terminal_velocity(lumps: Lumps, force: np.ndarray, rotation: np.ndarray | None = None) -> np.ndarray:
    """Pull a part that floats in equilibrium until its velocity is steady."""
    body = RigidBody(
        "part",
        DENSITY * VOLUME,
        (1.0, 1.0, 1.0),
        lumps=lumps,
        force=(*force, 0.0, 0.0, 0.0),
    )
    carrier = body.carrier(SEA)
    carrier.place_body((0.0, 0.0, -25.0), np.eye(3) if rotation is None else rotation)
    none = np.zeros((2, len(body.points), 3))
    for number in range(1, 4001):
        carrier.try_step(0.005 * number, none)
        carrier.accept()
    return carrier.state[7:10].copy()


@pytest.mark.parametrize("seed", [*range(2), *(pytest.param(s, marks=pytest.mark.slow) for s in range(2, 4))])
def test_a_compact_part_moves_along_the_pull_however_its_axes_lie(seed: int) -> None:
    """rho/2 CdA |v| v = F: the speed is sqrt(2 F / (rho CdA)) along F for every direction and every rotation."""
    random = np.random.default_rng(seed)
    force = random.normal(size=3)
    force *= 120.0 / np.linalg.norm(force)
    part = volume_lump((0.0, 0.0, 0.0), VOLUME, drag_area=(AREA, AREA, AREA))
    found = terminal_velocity(part, force, rotation_from_vector(random.normal(size=3)))
    exact = np.sqrt(2.0 * 120.0 / (DENSITY * AREA)) * force / 120.0
    assert np.allclose(found, exact, rtol=0, atol=1e-9)


@pytest.mark.parametrize("axis", (0, 1, 2))
def test_a_slender_part_obeys_the_cross_flow_principle(axis: int) -> None:
    """Across: rho/2 CdA |v_across| v_across; along its axis: rho/2 CdA_end |v| v; neither knows of the other."""
    force = np.array([70.0, -40.0, 55.0])
    area = np.full(3, AREA)
    area[axis] = 0.05
    part = Lumps(np.zeros((1, 3)), np.array([VOLUME]), np.zeros(1), area[None, :], np.zeros((1, 3)), axis)
    found = terminal_velocity(part, force)
    across = np.delete(np.arange(3), axis)
    pull = np.linalg.norm(force[across])
    exact = np.empty(3)
    exact[across] = np.sqrt(2.0 * pull / (DENSITY * AREA)) * force[across] / pull
    exact[axis] = np.sign(force[axis]) * np.sqrt(2.0 * abs(force[axis]) / (DENSITY * 0.05))
    assert np.allclose(found, exact, rtol=0, atol=1e-9)
