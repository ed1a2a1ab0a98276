"""Half-immersed circle in infinite depth: Ursell's multipole expansion (Q. J. Mech. Appl. Math. 2, 1949), and the
submerged circle that reflects nothing (Dean, Proc. Camb. Phil. Soc. 44, 1948; Ursell, ibid. 46, 1950)."""

import math

import numpy as np
import pytest

from moyai.potential import shapes
from moyai.potential.modes import rigid_modes
from moyai.potential.multipole_circle import half_immersed_circle, submerged_circle
from moyai.potential.solver import solve
from moyai.sea.water import Water
from moyai.validation.potential import CASES, half_circle

GRAVITY = 9.81
RADIUS = 1.3
OF_THE_LIST = [case for case in CASES if case.name.startswith("potential: half circle")]


@pytest.mark.slow
@pytest.mark.parametrize("case", OF_THE_LIST, ids=[case.name for case in OF_THE_LIST])
def test_cases_of_the_list(case):
    assert case.error(case.compute()) <= case.tolerance


@pytest.mark.slow
@pytest.mark.parametrize("relative", [0.05, 0.25, 0.6, 1.0, 1.7, 3.0, 6.0])
def test_half_immersed_circle_against_multipoles(relative):
    """Default accuracy: a thousandth; the expansion itself is good to ten digits."""
    mass, damping, wave = half_circle(relative)
    for index, mode in enumerate(("sway", "heave")):
        exact = half_immersed_circle(relative, mode)
        assert mass[index] == pytest.approx(exact.added_mass, rel=2e-5)
        assert damping[index] == pytest.approx(exact.radiation_damping, rel=2e-4)
        assert wave[index] == pytest.approx(exact.wave_ratio, rel=1e-4)


def test_half_immersed_circle_with_more_accuracy_asked():
    mass, damping, _ = half_circle(1.1, accuracy=1e-7)
    for index, mode in enumerate(("sway", "heave")):
        exact = half_immersed_circle(1.1, mode)
        assert mass[index] == pytest.approx(exact.added_mass, rel=1e-8)
        assert damping[index] == pytest.approx(exact.radiation_damping, rel=1e-7)


@pytest.mark.parametrize("submergence", [1.05, 1.25, 2.0, 4.0])
def test_submerged_circle_reflects_nothing(submergence):
    """In infinite depth |R| = 0 and |T| = 1 exactly at every frequency; the phase of T, A and B by multipoles."""
    relative = np.array([0.1, 0.4, 0.9, 1.6])
    omega = np.sqrt(relative * GRAVITY / RADIUS)
    section = shapes.circle(RADIUS).immersed((1.0 + submergence) * RADIUS)
    centre = (0.0, -submergence * RADIUS)
    solution = solve(section, Water(math.inf, 1000.0, GRAVITY), omega, modes=rigid_modes(centre))
    assert np.abs(solution.reflection_coefficient).max() < 2e-6
    assert np.abs(solution.transmission_coefficient) == pytest.approx(1.0, abs=1e-4)
    area = 1000.0 * math.pi * RADIUS**2
    for index, item in enumerate(relative):
        exact = submerged_circle(float(item), submergence)
        for mode in (0, 1):
            assert solution.added_mass[index, mode, mode] / area == pytest.approx(exact.added_mass, rel=1e-3, abs=1e-4)
            damping = solution.radiation_damping[index, mode, mode] / (area * omega[index])
            assert damping == pytest.approx(exact.radiation_damping, rel=1e-3, abs=1e-6)
        assert solution.transmission_coefficient[index, 0] == pytest.approx(exact.transmission_coefficient, abs=1e-4)


def test_submerged_circle_in_finite_depth_reflects_a_little():
    section = shapes.circle(RADIUS).immersed(3.0 * RADIUS)
    depths = (3.5 * RADIUS, 5.0 * RADIUS, 12.0 * RADIUS)
    reflected = [
        abs(
            solve(section, Water(h, 1000.0, GRAVITY), [1.5], modes=rigid_modes((0.0, 0.0))).reflection_coefficient[0, 0]
        )
        for h in depths
    ]
    assert 0.5 > reflected[0] > reflected[1] > reflected[2] and reflected[2] < 1e-2
