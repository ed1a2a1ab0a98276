"""Current profiles: values, exact means against quadrature, faults of tables."""

import math
from itertools import pairwise

import numpy as np
import pytest
from scipy.integrate import quad

from moyai.core.errors import InputError
from moyai.sea import current
from moyai.sea.water import Water

WATER = Water(12.0, 1025.0, 9.81)
RNG = np.random.default_rng(51)
Z_TABLE = np.sort(RNG.uniform(-12.0, 0.0, 7))
PROFILES = [
    current.uniform(0.7, 0.4),
    current.power_law(1.1, 1.0 / 7.0, -2.0, WATER),
    current.power_law(0.8, 0.5, 1.0, WATER),
    current.table(Z_TABLE, RNG.uniform(0.0, 1.5, 7), RNG.uniform(-3.0, 3.0, 7)),
]


@pytest.mark.parametrize("profile", PROFILES, ids=lambda p: type(p).__name__)
@pytest.mark.parametrize("limits", [(-12.0, 0.0), (-5.3, -1.1), (-3.0, 0.8), (-12.0, -11.0)])
def test_depth_means_are_integrals(profile, limits):
    low, high = limits
    breaks = [z for z in (*Z_TABLE, 0.0) if low < z < high]

    def mean(function):
        edges = [low, *breaks, high]
        total = sum(quad(function, a, b, epsabs=1e-13, epsrel=1e-12, limit=400)[0] for a, b in pairwise(edges))
        return total / (high - low)

    direction = 0.9
    np.testing.assert_allclose(
        profile.depth_mean(low, high), [mean(lambda z, i=i: profile.velocity(z)[i]) for i in (0, 1)], atol=1e-9
    )
    assert profile.depth_mean_squared(low, high) == pytest.approx(
        mean(lambda z: float(profile.speed(z)) ** 2), rel=1e-9
    )
    along = mean(lambda z: float(profile.component(z, direction)) ** 2)
    assert profile.depth_mean_squared(low, high, direction) == pytest.approx(along, rel=1e-9)
    drag = mean(lambda z: float(profile.component(z, direction)) * abs(float(profile.component(z, direction))))
    assert profile.depth_mean_drag(low, high, direction) == pytest.approx(drag, rel=1e-7, abs=1e-9)


def test_values():
    np.testing.assert_allclose(current.uniform(0.5, math.pi / 2).velocity(-3.0), [0.0, 0.5], atol=1e-15)
    law = current.power_law(1.0, 1.0 / 7.0, 0.0, WATER)
    np.testing.assert_allclose(law.speed([0.0, -6.0, -12.0, 1.0]), [1.0, 0.5 ** (1.0 / 7.0), 0.0, 1.0])
    # the mean of a 1/7 profile is 7/8 of the surface value, of its square 7/9
    np.testing.assert_allclose(law.depth_mean(-12.0, 0.0), [7.0 / 8.0, 0.0], atol=1e-14)
    assert law.depth_mean_squared(-12.0, 0.0) == pytest.approx(7.0 / 9.0, rel=1e-14)
    table = current.table([0.0, -4.0, -12.0], [1.0, 0.5, 0.1], 0.3)
    np.testing.assert_allclose(table.speed([0.5, 0.0, -2.0, -12.0, -13.0]), [1.0, 1.0, 0.75, 0.1, 0.1])
    assert table.component(-2.0, 0.3 + math.pi / 3.0) == pytest.approx(0.375)
    assert current.uniform(0.5, 0.0).velocity(np.zeros((2, 3))).shape == (2, 3, 2)


def test_a_current_that_turns_over_the_depth():
    table = current.table([-10.0, 0.0], [1.0, 1.0], [0.0, math.pi])
    assert table.depth_mean_drag(-10.0, 0.0, 0.0) == pytest.approx(0.0, abs=1e-12)
    assert table.depth_mean_squared(-10.0, 0.0, 0.0) == pytest.approx(1.0 / 3.0, rel=1e-12)
    assert table.depth_mean_drag(-10.0, -5.0, 0.0) == pytest.approx(1.0 / 3.0, rel=1e-12)


@pytest.mark.parametrize(
    ("z", "speed", "heading", "message"),
    [
        ([], [], [], "at least one row"),
        ([0.0, -1.0], [1.0], 0.0, "equal length"),
        ([0.0, -5.0, -3.0], [1.0, 1.0, 1.0], 0.0, "row 3: z = -3 m after -5 m"),
        ([-5.0, -3.0, -3.0], [1.0, 1.0, 1.0], 0.0, "row 3"),
        ([0.0, -5.0], [1.0, math.nan], 0.0, "row 2: speed is not a number"),
        ([0.0, -5.0], [1.0, 1.0], [0.0, math.inf], "row 2: heading is not a number"),
        ([0.5, -5.0], [1.0, 1.0], 0.0, "row 1: z = 0.5 m is above still water"),
    ],
)
def test_faulty_tables_are_named_by_row(z, speed, heading, message):
    with pytest.raises(InputError, match=message):
        current.table(z, speed, heading)


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: current.power_law(1.0, 0.0, 0.0, WATER), "exponent"),
        (lambda: current.power_law(1.0, 0.1, 0.0, Water(math.inf, 1025.0, 9.81)), "finite depth"),
        (lambda: current.uniform(math.nan, 0.0), "speed"),
        (lambda: PROFILES[1].velocity(-12.5), "below the bed"),
        (lambda: PROFILES[1].depth_mean(-12.5, 0.0), "below the bed"),
        (lambda: PROFILES[0].depth_mean(0.0, -1.0), "z_bottom"),
    ],
)
def test_bad_profiles_are_refused(make, message):
    with pytest.raises(InputError, match=message):
        make()
