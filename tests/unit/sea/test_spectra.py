"""Spectra against closed moments, each other, and tables of themselves."""

import math
import pickle

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.special import exp1
from scipy.special import gamma as gamma_function

from moyai.core.errors import InputError
from moyai.sea import dispersion, spectra
from moyai.sea.water import Water

RNG = np.random.default_rng(21)
SEAS = [(float(h), float(t)) for h, t in zip(RNG.uniform(0.05, 12.0, 6), RNG.uniform(0.6, 18.0, 6))]


@pytest.mark.parametrize(("height", "period"), SEAS)
def test_pierson_moskowitz_moments_are_closed(height, period):
    spectrum = spectra.pierson_moskowitz(height, period)
    peak = 2.0 * math.pi / period
    a, b = 5.0 / 16.0 * height**2 * peak**4, 1.25 * peak**4
    for order in (-2.0, -1.0, 0.0, 0.5, 1.0, 2.0, 3.0):
        closed = a / 4.0 * b ** (order / 4.0 - 1.0) * gamma_function(1.0 - order / 4.0)
        # half orders leave a root at infinite frequency, which the panels resolve less well than the whole orders
        assert spectrum.moment(order) == pytest.approx(closed, rel=1e-13 if order != 0.5 else 1e-8)
    assert spectrum.significant_height == pytest.approx(height, rel=1e-13)
    assert spectrum.peak_period == pytest.approx(period, rel=1e-13)
    assert spectrum.mean_period / period == pytest.approx(1.25**-0.25 / gamma_function(0.75), rel=1e-12)
    assert spectrum.zero_crossing_period / period == pytest.approx((1.25 * math.pi) ** -0.25, rel=1e-12)
    assert spectrum.energy_period / period == pytest.approx(gamma_function(1.25) * 1.25**-0.25, rel=1e-12)
    assert spectrum.peakedness == pytest.approx(2.0, rel=1e-12)


@pytest.mark.parametrize(("height", "period"), SEAS)
@pytest.mark.parametrize("enhancement", [1.0, 2.3, 3.3, 7.0, 15.0])
def test_jonswap_is_normalised_by_an_independent_quadrature(height, period, enhancement):
    spectrum = spectra.jonswap(height, period, enhancement)
    peak = 2.0 * math.pi / period
    parts = [
        quad(lambda w: float(spectrum.density_at(w)), a * peak, b * peak, epsabs=0.0, epsrel=1e-11, limit=400)[0]
        for a, b in ((0.2, 0.9), (0.9, 1.0), (1.0, 1.2), (1.2, 3.0), (3.0, 400.0))
    ]
    assert 4.0 * math.sqrt(sum(parts)) == pytest.approx(height, rel=1e-9)
    assert spectrum.peak_period == pytest.approx(period, rel=1e-12)


def test_jonswap_without_enhancement_is_pierson_moskowitz():
    omega = np.linspace(0.1, 5.0, 200)
    a, b = spectra.jonswap(2.0, 7.0, 1.0, omega), spectra.pierson_moskowitz(2.0, 7.0, omega)
    np.testing.assert_allclose(a.density, b.density, rtol=1e-12, atol=0.0)


def test_peak_enhancement_is_the_ratio_at_the_peak():
    plain, sharp = spectra.jonswap(2.0, 7.0, 1.0), spectra.jonswap(2.0, 7.0, 4.0)
    peak = 2.0 * math.pi / 7.0
    ratio = float(sharp.density_at(peak) / plain.density_at(peak)) / (sharp.shapes[0].scale / plain.shapes[0].scale)
    assert ratio == pytest.approx(4.0, rel=1e-12)


def test_goda_forms_are_near_the_quadrature():
    for enhancement in np.linspace(1.0, 7.0, 13):
        plain = spectra.jonswap(3.0, 9.0, enhancement, normalisation="goda")
        assert plain.significant_height == pytest.approx(3.0, rel=0.003)
        zero = spectra.jonswap(3.0, 9.0, enhancement, normalisation="goda_significant")
        expected = math.sqrt(1.094 - 0.01915 * math.log(enhancement))
        assert zero.significant_height / plain.significant_height == pytest.approx(expected, rel=1e-12)
    assert spectra.goda_peak_period(7.0, 3.3) == pytest.approx(7.0 / (1.0 - 0.132 * 3.5**-0.559), rel=1e-14)


def test_bretschneider_mitsuyasu_equals_its_printed_form():
    height, period = 2.4, 6.3
    frequency = np.linspace(0.05, 0.8, 100)
    printed = 0.257 * height**2 * period**-4 * frequency**-5 * np.exp(-1.03 * (period * frequency) ** -4)
    spectrum = spectra.bretschneider_mitsuyasu(height, period)
    np.testing.assert_allclose(spectrum.density_at(2.0 * math.pi * frequency) * 2.0 * math.pi, printed, rtol=1e-12)
    assert spectrum.significant_height / height == pytest.approx(4.0 * math.sqrt(0.257 / 4.12), rel=1e-12)
    assert spectrum.peak_period / period == pytest.approx(0.824**-0.25, rel=1e-12)
    modified = spectra.bretschneider_mitsuyasu(height, period, coefficients="goda")
    printed = 0.205 * height**2 * period**-4 * frequency**-5 * np.exp(-0.75 * (period * frequency) ** -4)
    np.testing.assert_allclose(modified.density_at(2.0 * math.pi * frequency) * 2.0 * math.pi, printed, rtol=1e-12)


def test_fully_developed_sea_of_a_wind():
    spectrum = spectra.pierson_moskowitz_of_wind(15.0, 9.81)
    omega = np.linspace(0.3, 2.0, 50)
    printed = 0.0081 * 9.81**2 * omega**-5 * np.exp(-0.74 * (9.81 / (15.0 * omega)) ** 4)
    np.testing.assert_allclose(spectrum.density_at(omega), printed, rtol=1e-12)
    assert spectrum.significant_height == pytest.approx(
        4.0 * math.sqrt(0.0081 / (4.0 * 0.74)) * 15.0**2 / 9.81, rel=1e-12
    )


def test_depth_function_is_the_ratio_of_wave_number_spectra():
    """phi = (k_deep/k)^3 (dk/domega) / (dk_deep/domega): a wave-number spectrum unchanged by depth (Kitaigorodskii)."""
    omega, depth = np.geomspace(0.01, 6.0, 60), 7.0
    k = dispersion.wave_number(omega, depth, 9.81)
    expected = (omega**2 / 9.81 / k) ** 3 / dispersion.group_velocity(omega, depth, 9.81) * 9.81 / (2.0 * omega)
    np.testing.assert_allclose(spectra.depth_function(omega, depth, 9.81), expected, rtol=1e-12)
    assert float(spectra.depth_function(1e-4, depth, 9.81)) == pytest.approx(1e-8 * depth / 9.81 / 2.0, rel=1e-6)
    np.testing.assert_array_equal(spectra.depth_function(omega, math.inf, 9.81), 1.0)


def test_tma_heights():
    water = Water(6.0, 1025.0, 9.81)
    here = spectra.tma(2.0, 9.0, 3.3, water)
    assert here.significant_height == pytest.approx(2.0, rel=1e-13)
    under = spectra.tma(2.0, 9.0, 3.3, water, height_at="deep water")
    deep = spectra.jonswap(2.0, 9.0, 3.3)
    omega = np.linspace(0.3, 3.0, 40)
    np.testing.assert_allclose(
        under.density_at(omega), deep.density_at(omega) * spectra.depth_function(omega, 6.0, 9.81), rtol=1e-12
    )
    assert under.significant_height < 2.0
    assert here.peak_omega >= deep.peak_omega * (1.0 - 1e-9)
    endless = spectra.tma(2.0, 9.0, 3.3, Water(math.inf, 1025.0, 9.81))
    np.testing.assert_allclose(endless.density_at(omega), deep.density_at(omega), rtol=1e-13)


@pytest.mark.parametrize(
    "spectrum", [spectra.jonswap(1.7, 6.0, 3.3), spectra.tma(1.7, 8.0, 2.0, Water(4.0, 1e3, 9.81))]
)
def test_a_fine_table_agrees_with_the_formula(spectrum):
    omega = np.unique(np.concatenate([np.linspace(0.2, 3.0, 6000), np.geomspace(3.0, 80.0, 6000)]))
    table = spectra.Spectrum(omega, spectrum.density_at(omega), "table")
    assert table.significant_height == pytest.approx(spectrum.significant_height, rel=1e-5)
    assert table.mean_period == pytest.approx(spectrum.mean_period, rel=1e-4)
    assert table.peak_period == pytest.approx(spectrum.peak_period, rel=1e-3)
    fractions = [0.01, 0.3, 0.9, 0.995]
    np.testing.assert_allclose(table.quantile(fractions), spectrum.quantile(fractions), rtol=1e-4)
    assert table.peakedness == pytest.approx(spectrum.peakedness, rel=1e-4)


def test_moments_of_a_table_are_exact():
    omega, density = np.array([0.5, 1.0, 2.5]), np.array([0.0, 2.0, 0.0])
    table = spectra.Spectrum(omega, density, "triangle")
    assert table.moment(0) == pytest.approx(0.5 * 2.0 * 2.0, rel=1e-14)
    # first moment of a triangle: area times the mean of its corners
    assert table.moment(1) == pytest.approx(2.0 * 4.0 / 3.0, rel=1e-14)
    assert table.moment(0, 1.0, 2.5) == pytest.approx(1.5, rel=1e-14)
    assert table.moment(0, 0.0, 0.75) == pytest.approx(0.5 * 0.25 * 1.0, rel=1e-14)
    assert table.moment(-1) == pytest.approx(
        4.0 * (0.5 - 0.5 * math.log(2.0)) + 4.0 / 3.0 * (2.5 * math.log(2.5) - 1.5), rel=1e-12
    )
    np.testing.assert_allclose(table.energy_below([0.0, 0.75, 1.0, 9.0]), [0.0, 0.125, 0.5, 2.0], rtol=1e-14)
    np.testing.assert_allclose(table.energy_below(table.quantile([0.1, 0.25, 0.8])) / 2.0, [0.1, 0.25, 0.8], rtol=1e-12)
    np.testing.assert_array_equal(table.density_at([0.2, 3.0]), 0.0)


def test_energy_below_a_pierson_moskowitz_frequency_is_closed():
    spectrum = spectra.pierson_moskowitz(3.0, 8.0)
    omega = np.array([0.3, 0.6, 0.7853, 1.0, 3.0, 50.0])
    closed = 9.0 / 16.0 * np.exp(-1.25 * (omega * 8.0 / (2.0 * math.pi)) ** -4.0)
    np.testing.assert_allclose(spectrum.energy_below(omega), closed, rtol=1e-12)
    assert spectrum.moment(0, 0.6, 1.0) == pytest.approx(closed[3] - closed[1], rel=1e-12)
    fractions = np.linspace(0.001, 0.999, 25)
    exact = 2.0 * math.pi / 8.0 * (-np.log(fractions) / 1.25) ** -0.25
    np.testing.assert_allclose(spectrum.quantile(fractions), exact, rtol=1e-10)


def test_bands_and_scaling():
    spectrum = spectra.jonswap(2.0, 7.0, 3.3)
    band = spectrum.truncated(0.6, 2.0)
    assert band.moment(0) == pytest.approx(spectrum.moment(0, 0.6, 2.0), rel=1e-13)
    assert float(band.density_at(2.1)) == 0.0
    assert band.moment(4) > 0.0
    np.testing.assert_allclose(spectrum.scaled(3.0).density, 3.0 * spectrum.density)
    with pytest.raises(InputError, match="diverges"):
        spectrum.moment(4)


def test_broadness_of_a_cut_pierson_moskowitz_sea_is_closed():
    spectrum, upper = spectra.pierson_moskowitz(2.0, 7.0), 5.0
    peak = 2.0 * math.pi / 7.0
    a, b = 5.0 / 16.0 * 4.0 * peak**4, 1.25 * peak**4
    m0 = a / (4.0 * b) * math.exp(-b / upper**4)
    m2 = a / 4.0 * math.sqrt(math.pi / b) * math.erfc(math.sqrt(b) / upper**2)
    m4 = a / 4.0 * float(exp1(b / upper**4))
    assert spectrum.moment(4, upper=upper) == pytest.approx(m4, rel=1e-12)
    assert spectrum.broadness(upper=upper) == pytest.approx(math.sqrt(1.0 - m2**2 / (m0 * m4)), rel=1e-10)


def test_superposed_seas_add_their_variance():
    swell, wind = spectra.jonswap(1.0, 14.0, 6.0), spectra.jonswap(2.0, 5.0, 2.0)
    both = spectra.superpose(swell, wind)
    assert both.significant_height == pytest.approx(math.hypot(1.0, 2.0), rel=1e-13)
    assert both.moment(1) == pytest.approx(swell.moment(1) + wind.moment(1), rel=1e-13)
    omega = both.quantile([0.05, 0.5])
    np.testing.assert_allclose(
        both.energy_below(omega), swell.energy_below(omega) + wind.energy_below(omega), rtol=1e-12
    )
    with pytest.raises(InputError, match="tables"):
        spectra.superpose(swell, spectra.from_table([0.1, 0.2], [1.0, 1.0]))


def test_spectra_are_frozen_and_survive_pickling():
    spectrum = spectra.jonswap(2.0, 7.0, 3.3)
    with pytest.raises(ValueError, match="read-only"):
        spectrum.density[0] = 1.0
    with pytest.raises(TypeError):
        spectrum.parameters["peak_period"] = 3.0
    again = pickle.loads(pickle.dumps(spectrum))
    np.testing.assert_array_equal(again.density, spectrum.density)
    assert again.moment(2) == spectrum.moment(2)
    assert dict(again.parameters) == dict(spectrum.parameters)


@pytest.mark.parametrize(
    "make",
    [
        lambda: spectra.jonswap(0.0, 7.0, 3.3),
        lambda: spectra.jonswap(1.0, math.nan, 3.3),
        lambda: spectra.jonswap(1.0, 7.0, 0.5),
        lambda: spectra.jonswap(1.0, 7.0, 3.3, normalisation="dnv"),
        lambda: spectra.pierson_moskowitz(-1.0, 7.0),
        lambda: spectra.bretschneider_mitsuyasu(1.0, 0.0),
        lambda: spectra.tma(1.0, 7.0, 3.3, Water(10.0, 1e3, 9.81), height_at="there"),
        lambda: spectra.Spectrum(np.array([1.0, 0.5]), np.array([1.0, 1.0]), "falling"),
    ],
)
def test_bad_spectra_are_refused(make):
    with pytest.raises(InputError):
        make()
