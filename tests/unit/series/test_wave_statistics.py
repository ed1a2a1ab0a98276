"""Zero-crossing statistics on series whose cycles are known, and Rayleigh expectations."""

import math

import numpy as np
import pytest
from scipy import stats
from scipy.special import comb

from moyai.core.errors import InputError
from moyai.sea import irregular, spectra
from moyai.sea.water import Water
from moyai.series import wave_statistics
from moyai.series.zero_crossing import split_waves


def test_cycles_of_a_sine():
    time = np.arange(0.0, 100.0, 0.01)
    cycles = split_waves(time, 3.0 + 2.0 * np.sin(2.0 * math.pi * (time - 0.3) / 8.0), mean_level=3.0)
    assert len(cycles) == 12
    np.testing.assert_allclose(cycles.period, 8.0, atol=1e-4)
    np.testing.assert_allclose(cycles.start, 0.3 + 8.0 * np.arange(12), atol=1e-4)
    np.testing.assert_allclose(cycles.height, 4.0, atol=1e-4)
    np.testing.assert_allclose(cycles.crest, 2.0, atol=1e-4)


def test_planted_waves_are_found_again():
    """Triangular waves of random heights and periods, corners on the grid."""
    rng = np.random.default_rng(61)
    pieces, heights, periods = [np.array([0.0])], [], []
    for _ in range(300):
        crest, trough, quarter = rng.uniform(0.2, 3.0), rng.uniform(0.2, 3.0), int(rng.integers(3, 12))
        up = np.linspace(0.0, crest, quarter + 1)[1:]
        down = np.linspace(crest, -trough, 2 * quarter + 1)[1:]
        back = np.linspace(-trough, 0.0, quarter + 1)[1:]
        pieces += [up, down, back]
        heights.append(crest + trough)
        periods.append(4 * quarter * 0.5)
    # one more cycle of descent opens the first and closes the last crossing
    series = np.concatenate([[-0.5], *pieces, [0.5]])
    cycles = split_waves(np.arange(series.size) * 0.5, series, mean_level=0.0)
    np.testing.assert_allclose(cycles.height, heights, rtol=1e-12)
    np.testing.assert_allclose(cycles.period, periods, rtol=1e-12)
    order = np.sort(heights)[::-1]
    assert cycles.significant_height() == pytest.approx(order[:100].mean(), rel=1e-12)
    top = np.argsort(heights)[::-1][:100]
    assert cycles.significant_period() == pytest.approx(np.array(periods)[top].mean(), rel=1e-12)


def test_parabolic_crests_recover_what_sampling_lost():
    time = np.arange(0.0, 200.0, 0.5)
    series = np.cos(2.0 * math.pi * time / 5.3 + 0.2)
    plain = split_waves(time, series, mean_level=0.0)
    fine = split_waves(time, series, mean_level=0.0, parabolic=True)
    assert abs(fine.height.mean() - 2.0) < 0.1 * abs(plain.height.mean() - 2.0)


def test_significant_values_and_exceedance():
    values = np.arange(1.0, 10.0)
    assert wave_statistics.significant(values) == 8.0
    assert wave_statistics.significant(values, 1.0) == 5.0
    assert wave_statistics.significant([2.0]) == 2.0
    assert math.isnan(wave_statistics.significant([]))
    ordered, probability = wave_statistics.exceedance([1.0, 3.0, 2.0])
    np.testing.assert_array_equal(ordered, [3.0, 2.0, 1.0])
    np.testing.assert_allclose(probability, [0.25, 0.5, 0.75])


def test_rayleigh_constants():
    assert wave_statistics.rayleigh_significant(1.0 / 3.0) == pytest.approx(1.41573, abs=5e-6)
    assert wave_statistics.rayleigh_significant(0.1) == pytest.approx(1.79992, abs=5e-6)
    assert wave_statistics.rayleigh_significant(1.0) == pytest.approx(math.sqrt(math.pi) / 2.0, rel=1e-14)
    for count, expected in ((100, 1.5974), (200, 1.7030), (500, 1.8333), (1000, 1.9259)):
        assert wave_statistics.rayleigh_expected_maximum(count) == pytest.approx(expected, abs=6e-5)
    # the alternating sum is exact for few waves
    for count in (1, 2, 5, 12):
        total = sum((-1) ** (n + 1) * comb(count, n) / math.sqrt(n) for n in range(1, count + 1))
        exact = 0.5 * math.sqrt(math.pi) * total / wave_statistics.rayleigh_significant(1.0 / 3.0)
        assert wave_statistics.rayleigh_expected_maximum(count) == pytest.approx(exact, rel=1e-10)


def test_likelihoods_of_height_fits_are_those_of_scipy():
    heights = np.random.default_rng(6).rayleigh(0.7, 300)
    rayleigh = wave_statistics.fit_rayleigh(heights)
    expected = stats.rayleigh.logpdf(heights, scale=rayleigh.scale / math.sqrt(2.0)).sum()
    assert rayleigh.fitted.log_likelihood == pytest.approx(expected, rel=1e-12)
    weibull = wave_statistics.fit_weibull(heights)
    expected = stats.weibull_min.logpdf(heights, weibull.shape, scale=weibull.scale).sum()
    assert weibull.fitted.log_likelihood == pytest.approx(expected, rel=1e-10)
    # one parameter more is never less likely
    assert weibull.fitted.log_likelihood >= rayleigh.fitted.log_likelihood


def test_narrow_sea_has_rayleigh_heights():
    omega = np.linspace(0.75, 0.85, 60)
    narrow = spectra.Spectrum(omega, 1.0 - ((omega - 0.8) / 0.05) ** 2 + 1e-12, "narrow")
    sea = irregular.synthesise(narrow, Water(math.inf, 1025.0, 9.81), duration=80000.0, time_step=0.5, seed=4)
    time = np.arange(160000) * 0.5
    cycles = split_waves(time, sea.elevation(time), parabolic=True)
    assert cycles.significant_height() == pytest.approx(4.0043 * math.sqrt(narrow.variance), rel=0.01)
    assert cycles.period.mean() == pytest.approx(narrow.zero_crossing_period, rel=1e-3)


@pytest.mark.parametrize(
    ("time", "values", "message"),
    [
        ([0.0, 1.0], [1.0], "1-D"),
        ([0.0, 1.0, 2.0], [1.0, math.nan, 1.0], r"values\[1\]"),
        ([0.0, 2.0, 1.0], [1.0, 0.0, 1.0], "increase"),
    ],
)
def test_bad_series_are_named(time, values, message):
    with pytest.raises(InputError, match=message):
        split_waves(time, values)


def test_a_series_without_cycles():
    cycles = split_waves(np.arange(10.0), np.arange(10.0))
    assert len(cycles) == 0
    assert math.isnan(cycles.significant_height())
    assert math.isnan(cycles.significant_period())
    with pytest.raises(InputError, match="fraction"):
        wave_statistics.significant([1.0], 0.0)
