"""Sawaragi, Aoki and Liu (1991), section on the added mass of the skirt: flat, curved and stretching plates.

The paper prints figures only; the numbers are those of vortex-panel and two-domain prototypes of another construction,
to the digits given.
"""

import math

import numpy as np
import pytest

from moyai.potential.modes import Modes, Rigid
from moyai.potential.skirt_modes import stretching_modes
from moyai.potential.solver import solve
from moyai.potential.thin_plate import Plate, hanging_arc, horizontal_motion, solve_plate_limit
from moyai.potential.thin_plate_waves import plate_memory, plate_section
from moyai.potential.vertical_barrier import solve_vertical_barrier
from moyai.sea.water import Water

FLAT = 2.0 / math.pi
CURVED = {
    # s/d: L/d, M_xx/M0, M_xc/M0, M_cc/M0, M_xx/M0(L)
    0.1: (1.4006, 1.312, 0.993, 0.754, 0.669),
    0.2: (1.2820, 1.213, 0.683, 0.388, 0.738),
    0.3: (1.2016, 1.150, 0.481, 0.204, 0.796),
    0.5: (1.1107, 1.080, 0.259, 0.0636, 0.876),
    1.0: (1.0367, 1.026, 0.0846, 0.0072, 0.955),
    2.0: (1.0101, 1.007, 0.0231, 0.0006, 0.987),
}


def stretch(centre_distance):
    """Normal velocity for unit speed of the centre of the circle, edges held: X/r."""
    radius = math.hypot(centre_distance, 0.5)
    return lambda points, _normals: points[:, 0] / radius


def curved_mass(centre_distance, depth=math.inf):
    plate = hanging_arc(1.0, centre_distance)
    modes = (horizontal_motion, stretch(centre_distance))
    return solve_plate_limit(plate, Water(depth, 1.0, 9.81), modes).added_mass / FLAT, plate.length


@pytest.mark.parametrize(
    ("ratio", "expected"),
    [(10.0, 1.0), (4.0, 1.0002), (3.0, 1.0005), (2.0, 1.0030), (1.5, 1.0119), (1.2, 1.0422), (1.05, 1.127)],
)
def test_depth_hardly_matters_above_one_and_a_half_draughts(ratio, expected):
    found = solve_plate_limit(Plate((0, 0), (0, -1)), Water(ratio, 1.0, 9.81)).added_mass[0, 0] / FLAT
    assert found == pytest.approx(expected, abs=3.5e-4)


@pytest.mark.parametrize(("draught", "expected"), [(0.4, 0.6374), (0.6, 0.6411), (0.7, 0.6464), (0.9, 0.6837)])
def test_depth_against_galerkin_on_the_strip(draught, expected):
    found = solve_plate_limit(Plate((0, 0), (0, -1)), Water(1.0 / draught, 1.0, 9.81)).added_mass[0, 0]
    assert found == pytest.approx(expected, abs=6e-5)


@pytest.mark.parametrize("distance", sorted(CURVED))
def test_curved_and_stretching_skirt(distance):
    length, xx, xc, cc, over_arc = CURVED[distance]
    mass, found = curved_mass(distance)
    assert found == pytest.approx(length, abs=6e-5)
    assert mass[0, 0] == pytest.approx(xx, abs=6e-4)
    assert mass[0, 1] == pytest.approx(xc, abs=6e-4)
    assert mass[1, 1] == pytest.approx(cc, abs=6e-4)
    assert mass[0, 0] / found**2 == pytest.approx(over_arc, abs=6e-4)


@pytest.mark.slow
def test_half_circle_about_one_and_a_half_times_the_plate():
    mass, length = curved_mass(0.0)
    assert mass[0, 0] == pytest.approx(1.461, abs=3e-3)
    assert 1.40 < mass[0, 0] < 1.50
    assert np.ptp(mass) < 1e-9  # stretch and translation are one motion there
    assert mass[0, 0] / length**2 == pytest.approx(0.592, abs=1e-3)
    for depth, expected in ((2.67, 1.463), (2.0, 1.468), (1.5, 1.486)):
        assert curved_mass(0.0, depth)[0][0, 0] == pytest.approx(expected, abs=1e-3)


def test_mass_of_stretch_falls_with_the_centre_distance():
    values = [curved_mass(s)[0][0, 1] / curved_mass(s)[1] ** 2 for s in (0.05, 0.1, 0.2, 0.3, 0.5, 1.0, 2.0)]
    assert all(np.diff(values) < 0.0)
    assert values[0] < 0.6
    assert values[-2] < 0.1


# Kd: M/M0 and N/(w M0) for h/d = 10 and for h/d = 3, of a prototype with truncated eigenfunction sums
AT_FREQUENCY = {
    0.1: ((2.7125, 0.0518), (2.7748, 0.1790)),
    0.3: ((3.3762, 0.5178), (3.2294, 0.6342)),
    0.5: ((3.6389, 1.7709), (3.4964, 1.6465)),
    0.7: ((2.6742, 2.9419), (2.7460, 2.8391)),
    1.0: ((0.9909, 2.7650), (1.0148, 2.7876)),
    2.0: ((0.2071, 1.1248), (0.2068, None)),
    4.0: ((0.4335, 0.3693), None),
    10.0: ((0.7618, 0.0628), None),
    30.0: ((0.9258, 0.0070), None),
}
SWAY = Modes(("sway",), (Rigid("sway"),))
WALL = plate_section(Plate((0, 0), (0, -1)))
GRAVITY = 9.81


@pytest.mark.slow
@pytest.mark.parametrize(("ratio", "column"), [(10.0, 0), (3.0, 1)])
def test_added_mass_and_damping_over_frequency(ratio, column):
    """Within 0.25 %, which is the truncation of the prototype: full sums of eigenfunctions agree to 2e-5."""
    chosen = {kd: pair[column] for kd, pair in AT_FREQUENCY.items() if pair[column] is not None}
    kd = np.array(list(chosen))
    omega, water = np.sqrt(GRAVITY * kd), Water(ratio, 1.0, GRAVITY)
    found = solve(WALL, water, omega, modes=SWAY, accuracy=1e-6)
    mass, damping = found.added_mass[:, 0, 0] / FLAT, found.radiation_damping[:, 0, 0] / (omega * FLAT)
    for number, (expected_mass, expected_damping) in enumerate(chosen.values()):
        assert mass[number] == pytest.approx(expected_mass, rel=2.5e-3, abs=1e-4)
        if expected_damping is not None:
            assert damping[number] == pytest.approx(expected_damping, rel=2.5e-3, abs=1e-4)
    reference = solve_vertical_barrier(1.0, water, omega, evanescent_modes=12000, polynomials=20)
    low = kd <= 10.0
    assert np.abs(mass - reference.added_mass / FLAT)[low].max() < 2e-5
    assert np.abs(damping - reference.radiation_damping / (omega * FLAT))[low].max() < 2e-5


@pytest.mark.slow
def test_limits_of_frequency():
    """M to (pi/2)^2 M0 and -(4 rho h^2/pi) ln cos(pi d/2h) when slow, N w^3 to 4 rho g^2 when fast."""
    slow = solve(WALL, Water(10.0, 1.0, GRAVITY), [0.01], modes=SWAY, accuracy=1e-6)
    exact = -400.0 / math.pi * math.log(math.cos(0.05 * math.pi))
    assert slow.added_mass[0, 0, 0] == pytest.approx(exact, rel=1e-4)
    assert slow.zero_frequency_added_mass[0, 0] == pytest.approx(exact, rel=1e-7)
    deep = solve(WALL, Water(math.inf, 1.0, GRAVITY), [0.1, 1.0], modes=SWAY, accuracy=1e-5)
    assert deep.zero_frequency_added_mass[0, 0] / FLAT == pytest.approx((math.pi / 2.0) ** 2, rel=1e-6)
    omega = np.sqrt(GRAVITY * np.array([100.0, 200.0]))
    fast = solve(WALL, Water(3.0, 1.0, GRAVITY), omega, modes=SWAY, accuracy=1e-5)
    assert fast.radiation_damping[:, 0, 0] * omega**3 / (4.0 * GRAVITY**2) == pytest.approx(1.0, abs=1e-3)


def test_mass_tends_to_the_impulsive_one_from_below():
    omega = np.sqrt(GRAVITY * np.array([1.5, 2.0, 3.0, 10.0, 30.0, 100.0]))
    mass = solve(WALL, Water(10.0, 1.0, GRAVITY), omega, modes=SWAY).added_mass[:, 0, 0] / FLAT
    assert mass.argmin() == 1
    assert mass[1] == pytest.approx(0.207, abs=1e-3)
    assert (np.diff(mass[1:]) > 0.0).all()
    assert mass[-1] < 1.0


def test_memory_of_the_plate_over_time():
    """K in units of rho d g at h/d = 2.67."""
    table = {0.0: 1.275, 0.25: 1.100, 0.5: 0.793, 1.0: 0.166, 1.5: -0.272, 2.0: -0.480, 3.0: -0.426, 4.0: -0.147}
    time = np.array(list(table)) / math.sqrt(GRAVITY)
    kernel, mass = plate_memory(1.0, Water(2.67, 1.0, GRAVITY), time)
    assert kernel / GRAVITY == pytest.approx(list(table.values()), abs=1.5e-3)
    assert mass / FLAT == pytest.approx(1.0009, abs=2e-4)


@pytest.mark.parametrize("distance", [0.1, 0.3, 1.0])
def test_curved_skirt_by_the_solver_of_any_frequency(distance):
    _, xx, xc, cc, _ = CURVED[distance]
    arc = hanging_arc(1.0, distance)
    found = solve(plate_section(arc), Water(math.inf, 1.0, GRAVITY), [1.0, 3.0], modes=stretching_modes(arc))
    mass = found.infinite_frequency_added_mass / FLAT
    assert mass[0, 0] == pytest.approx(xx, abs=6e-4)
    assert mass[0, 1] == pytest.approx(xc, abs=6e-4)
    assert mass[1, 1] == pytest.approx(cc, abs=6e-4)
