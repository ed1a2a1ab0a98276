"""The section solver against matched eigenfunctions at random rectangles, depths, frequencies, headings; and the
table of floating boxes found by the same method (three modes, 800 to 1600 terms, converged to 2e-4)."""

import math

import numpy as np
import pytest

from moyai.potential import shapes
from moyai.potential.modes import rigid_modes
from moyai.potential.rectangle import solve_rectangle
from moyai.potential.solver import solve
from moyai.sea.water import Water

GRAVITY = 9.81


@pytest.mark.slow
@pytest.mark.parametrize("seed", [2, 3, *(pytest.param(s, marks=pytest.mark.slow) for s in (0, 1, *range(4, 10)))])
def test_random_rectangles(seed):
    rng = np.random.default_rng(seed)
    depth = 10.0 ** rng.uniform(-0.5, 1.5)
    draught = depth * rng.uniform(0.05, 0.95)
    beam = depth * 10.0 ** rng.uniform(-1.0, 0.6)
    number = np.sort(10.0 ** rng.uniform(-1.0, 1.0, 4)) / beam
    omega = np.sqrt(GRAVITY * number * np.tanh(number * depth))
    centre = (float(rng.uniform(-0.2, 0.2) * beam), float(-rng.uniform(0.0, 1.0) * draught))
    heading = [0.0, float(rng.uniform(0.1, 1.3))]
    water = Water(depth, 1025.0, GRAVITY)
    section = shapes.rectangle(beam, 1.4 * draught).immersed(draught)
    found = solve(section, water, omega, modes=rigid_modes(centre), heading=heading)
    exact = solve_rectangle(beam, draught, water, omega, centre=centre, heading=heading)
    for name in ("added_mass", "radiation_damping"):
        a, b = getattr(found, name), getattr(exact, name)
        size = np.sqrt(np.einsum("wii->wi", b).max(axis=0))
        assert (np.abs(a - b).max(axis=0) / np.outer(size, size)).max() < 2e-4, name
    for name in ("infinite_frequency_added_mass", "zero_frequency_added_mass"):
        a, b = getattr(found, name), getattr(exact, name)
        size = np.sqrt(np.diag(b))
        assert (np.abs(a - b) / np.outer(size, size)).max() < 2e-5, name
    a, b = found.excitation_force, exact.excitation_force
    assert (np.abs(a - b).max(axis=(0, 1)) / np.abs(b).max(axis=(0, 1))).max() < 2e-4
    assert found.dataset.Froude_Krylov_force.values == pytest.approx(
        exact.froude_krylov_force, rel=1e-5, abs=1e-5 * np.abs(b).max()
    )
    assert np.abs(found.radiated_wave - exact.radiated_wave).max() < 2e-4 * np.abs(exact.radiated_wave).max()
    assert np.abs(found.reflection_coefficient - exact.reflection_coefficient).max() < 2e-4
    assert np.abs(found.transmission_coefficient - exact.transmission_coefficient).max() < 2e-4


#: L/B, KT of the fixed box, KT, |x|/a, |z|/a, |theta| B/2a of the free one: h = B = 0.38 m, d = 0.113 m, zg = -0.027 m,
#: gyradius 0.101 m, no damping, no mooring
FLOATING_BOX = [
    (2.0, 0.0735, 0.4061, 0.3546, 0.1753, 0.2140),
    (3.0, 0.2386, 0.2766, 0.5072, 0.7816, 1.4315),
    (3.5, 0.3337, 0.9461, 0.2197, 1.2753, 9.091),
    (4.0, 0.4243, 0.8419, 0.7552, 1.4974, 2.1445),
    (5.0, 0.5751, 0.9728, 0.8961, 1.3460, 0.9239),
    (8.0, 0.8109, 0.9993, 1.3467, 1.0979, 0.4316),
]


def test_table_of_the_floating_box():
    beam, depth, draught, centre = 0.38, 0.38, 0.113, -0.027
    table = np.array(FLOATING_BOX)
    number = 2.0 * math.pi / (table[:, 0] * beam)
    omega = np.sqrt(GRAVITY * number * np.tanh(number * depth))
    section = shapes.rectangle(beam, 0.17).immersed(draught)
    found = solve(section, Water(depth, 1000.0, GRAVITY), omega, modes=rigid_modes((0.0, centre)))
    assert np.abs(found.transmission_coefficient[:, 0]) == pytest.approx(table[:, 1], abs=1.5e-4)
    mass = 1000.0 * section.area * np.diag([1.0, 1.0, 0.101**2])
    metacentre = section.waterplane_second_moment / section.area + section.centroid[1] - centre
    stiffness = 1000.0 * GRAVITY * np.diag([0.0, beam, section.area * metacentre])
    part = found.normal
    for index, row in enumerate(table):
        o = omega[index]
        matrix = -(o**2) * (mass + part.added_mass[index].T) - 1j * o * part.radiation_damping[index].T + stiffness
        motion = np.linalg.solve(matrix, part.excitation_force[index])
        transmitted = part.transmission_coefficient[index] - 1j * o * motion @ part.radiated_wave[index, :, 1]
        values = [abs(transmitted), *np.abs(motion * [1.0, 1.0, beam / 2.0])]
        # roll at its undamped resonance (L/B = 3.5) multiplies every digit of the input by forty
        assert values == pytest.approx(row[2:], rel=2e-3 if row[0] == 3.5 else 3e-4, abs=2e-4)


def test_koutandos_fixed_box():
    """Box of 2 m in 2 m of water, draught 0.5 m: 0.317, 0.696, 0.844, 0.936 at T = 2.04, 3, 4, 6 s (same method)."""
    omega = 2.0 * math.pi / np.array([2.04, 3.0, 4.0, 6.0])
    found = solve(
        shapes.rectangle(2.0, 1.5).immersed(0.5), Water(2.0, 1000.0, GRAVITY), omega, modes=rigid_modes((0, 0))
    )
    assert np.abs(found.transmission_coefficient[:, 0]) == pytest.approx([0.317, 0.696, 0.844, 0.936], abs=6e-4)
