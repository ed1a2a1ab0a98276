"""Sawaragi, Aoki and Liu (1991), section on the added mass of the skirt: flat, curved and stretching plates.

The paper prints figures only; the numbers are those of vortex-panel and two-domain prototypes of another construction,
to the digits given.
"""

import math

import numpy as np
import pytest

from moyai.potential.thin_plate import Plate, hanging_arc, horizontal_motion, solve_plate_limit
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
