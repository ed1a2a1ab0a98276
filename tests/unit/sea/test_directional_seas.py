"""Spreading functions against their own integrals, and the seas drawn from them."""

import math

import numpy as np
import pytest

from moyai.core.errors import InputError
from moyai.sea import directional, irregular, spectra
from moyai.sea.water import Water

RNG = np.random.default_rng(31)
FUNCTIONS = [directional.CosineTwoS(float(s)) for s in RNG.uniform(0.3, 90.0, 4)]
FUNCTIONS += [directional.CosinePower(float(n)) for n in RNG.uniform(0.5, 20.0, 3)]
FUNCTIONS += [directional.WrappedNormal(float(s)) for s in RNG.uniform(0.05, 3.0, 4)]
FUNCTIONS += [directional.Mitsuyasu(float(s), 0.9) for s in (10.0, 25.0, 75.0)]
# panels between the ends and the edges of cos^n, where the density has a kink
EDGES = np.concatenate(
    [
        np.linspace(-math.pi, -math.pi / 2, 40),
        np.linspace(-math.pi / 2, math.pi / 2, 80)[1:],
        np.linspace(math.pi / 2, math.pi, 40)[1:],
    ]
)
POINTS, WEIGHTS = np.polynomial.legendre.leggauss(12)
HALF = 0.5 * np.diff(EDGES)[:, None]
ANGLE = (0.5 * (EDGES[1:] + EDGES[:-1])[:, None] + HALF * POINTS).ravel()
WEIGHT = (HALF * WEIGHTS).ravel()


@pytest.mark.parametrize("function", FUNCTIONS, ids=repr)
@pytest.mark.parametrize("omega", [0.6, 0.9, 1.7])
def test_spreading_integrates_to_one_and_has_its_moments(function, omega):
    density = function.density(ANGLE, omega)
    # roots at the ends of cos^n limit the panels when n is below one
    rough = isinstance(function, directional.CosinePower) and function.exponent < 2.0
    tolerance = 1e-4 if rough else 1e-7
    assert np.sum(WEIGHT * density) == pytest.approx(1.0, abs=tolerance)
    assert np.sum(WEIGHT * density * np.cos(ANGLE)) == pytest.approx(float(function.resultant(omega)), abs=tolerance)
    assert float(function.spread(omega)) == pytest.approx(math.sqrt(2.0 - 2.0 * float(function.resultant(omega))))
    for limit in (-1.2, 0.0, 0.4):
        below = np.sum((WEIGHT * density)[limit > ANGLE])
        assert float(function.cumulative(limit, omega)) == pytest.approx(below, abs=0.04 * float(density.max()))


@pytest.mark.parametrize("function", FUNCTIONS, ids=repr)
def test_quantile_inverts_the_distribution(function):
    fractions = np.array([1e-4, 0.1, 0.37, 0.5, 0.9, 0.9999])
    offsets = function.quantile(fractions, 1.1)
    np.testing.assert_allclose(function.cumulative(offsets, 1.1), fractions, rtol=1e-9)
    slope = (function.cumulative(offsets + 1e-6, 1.1) - function.cumulative(offsets - 1e-6, 1.1)) / 2e-6
    np.testing.assert_allclose(slope, function.density(offsets, 1.1), rtol=1e-4, atol=1e-9)


def test_mitsuyasu_exponent():
    function = directional.Mitsuyasu(10.0, 0.8)
    np.testing.assert_allclose(function.exponent_at([0.4, 0.8, 1.6]), [10.0 / 32.0, 10.0, 10.0 * 2.0**-2.5])
    np.testing.assert_allclose(function.density(0.3, 0.8), directional.CosineTwoS(10.0).density(0.3, 0.8), rtol=1e-14)


def test_angles_are_wrapped():
    function = directional.CosineTwoS(5.0)
    np.testing.assert_allclose(function.density(0.3 + 4.0 * math.pi, 1.0), function.density(0.3, 1.0), rtol=1e-12)
    np.testing.assert_allclose(directional.wrapped([0.1, 7.0, -7.0]), [0.1, 7.0 - 2 * math.pi, -7.0 + 2 * math.pi])


def test_headings_of_a_sea_follow_the_spreading_in_every_band():
    spectrum = spectra.jonswap(2.0, 9.0, 3.3)
    function = directional.Mitsuyasu(20.0, spectrum.peak_omega)
    sea = irregular.synthesise(
        spectrum, Water(30.0, 1025.0, 9.81), duration=10800.0, seed=5, heading=0.7, spreading=function
    )
    offset = directional.wrapped(sea.heading - 0.7)
    for first in range(0, len(sea) - 400, 400):
        part = slice(first, first + 400)
        expected = float(np.mean(function.resultant(sea.omega[part])))
        assert np.mean(np.cos(offset[part])) == pytest.approx(expected, abs=0.01)
        assert np.mean(np.sin(offset[part])) == pytest.approx(0.0, abs=0.01)
        rank = np.sort(function.cumulative(offset[part], sea.omega[part]))
        # Kolmogorov distance; random draws would give about 0.05
        assert np.abs(rank - (np.arange(400) + 0.5) / 400).max() < 0.01


def test_single_summation_is_the_same_sea_everywhere_and_double_is_not():
    spectrum, water = spectra.jonswap(2.0, 8.0, 3.3), Water(25.0, 1025.0, 9.81)
    points = np.linspace(0.0, 400.0, 9)

    def variances(summation):
        sea = irregular.synthesise(
            spectrum,
            water,
            duration=1800.0,
            seed=8,
            spreading=directional.CosineTwoS(10.0),
            summation=summation,
            heading_count=15,
            time_step=0.5,
        )
        assert sea.significant_height == pytest.approx(2.0, rel=1e-12)
        time = np.arange(round(sea.repeat_period / 0.5)) * 0.5
        return np.var(sea.elevation(time, 0.0, points), axis=0)

    single, double = variances("single"), variances("double")
    np.testing.assert_allclose(single, spectrum.variance, rtol=1e-9)
    assert np.std(double) / spectrum.variance > 0.02


def test_long_and_short_crested_seas_share_their_phases():
    spectrum, water = spectra.jonswap(2.0, 8.0, 3.3), Water(25.0, 1025.0, 9.81)
    long = irregular.synthesise(spectrum, water, duration=600.0, seed=8)
    short = irregular.synthesise(spectrum, water, duration=600.0, seed=8, spreading=directional.CosinePower(4.0))
    np.testing.assert_array_equal(long.phase, short.phase)
    time = np.linspace(0.0, 100.0, 50)
    np.testing.assert_allclose(long.elevation(time), short.elevation(time), atol=1e-12)


@pytest.mark.parametrize(
    "make",
    [
        lambda: directional.CosineTwoS(0.0),
        lambda: directional.CosinePower(-1.0),
        lambda: directional.WrappedNormal(math.nan),
        lambda: directional.Mitsuyasu(10.0, 0.0),
    ],
)
def test_bad_spreading_is_refused(make):
    with pytest.raises(InputError, match="greater than 0"):
        make()
