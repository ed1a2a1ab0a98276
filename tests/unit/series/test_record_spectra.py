"""Welch spectra: energy is kept, degrees of freedom are what repeated sampling shows, moments are exact for lines."""

import math

import numpy as np
import pytest

from moyai.core.errors import InputError
from moyai.sea import spectra as sea_spectra
from moyai.sea.irregular import synthesise
from moyai.sea.water import Water
from moyai.series.spectra import MeasuredSpectrum, WelchOptions, cross_spectra, degrees_of_freedom, spectrum_of


@pytest.mark.parametrize("size", [100, 101, 1024])
def test_energy_of_the_whole_record_is_kept(size):
    """Parseval: a rectangular window over everything keeps the variance to rounding."""
    values = np.random.default_rng(size).normal(size=size)
    options = WelchOptions(window="rectangular", overlap=0.0, detrend="mean")
    found = spectrum_of(0.37, values, options)
    assert found.moment(0) == pytest.approx(values.var(), rel=1e-12)


@pytest.mark.slow
@pytest.mark.parametrize("window", ["hann", "rectangular", "cosine_tenth"])
@pytest.mark.parametrize("overlap", [0.0, 0.5, 0.75])
def test_degrees_of_freedom_by_repetition(window, overlap):
    """White noise many times over: 2 mean^2 / variance of an estimate is its degrees of freedom."""
    random = np.random.default_rng(1)
    options = WelchOptions(segment=64.0, overlap=overlap, window=window, detrend="none")
    densities = []
    for _ in range(400):
        found = spectrum_of(1.0, random.normal(size=512), options)
        densities.append(found.density[4:28])
    densities = np.array(densities)
    shown = 2.0 * densities.mean() ** 2 / densities.var(axis=0).mean()
    assert found.degrees_of_freedom == pytest.approx(shown, rel=0.08)
    low, high = found.interval(0.9)
    inside = np.mean((densities * low < 2.0) & (densities * high > 2.0))
    assert inside == pytest.approx(0.9, abs=0.02)


def test_freedom_of_three_bands_under_a_hann_window_by_hand():
    """Transform of the squared window over its mean: 1, 2/3 one band off, 1/6 two bands off; of their squares
    1 + 2 (2/3 4/9 + 1/3 1/36) goes together."""
    size = 64
    window = 0.5 - 0.5 * np.cos(2.0 * np.pi * np.arange(size) / size)
    shares = 1.0 + 2.0 * (2.0 / 3.0 * 4.0 / 9.0 + 1.0 / 3.0 / 36.0)
    assert degrees_of_freedom(window, size, 1, bands=3) == pytest.approx(2.0 * 3.0 / shares, rel=1e-12)
    assert degrees_of_freedom(window, size, 5, bands=3) == pytest.approx(2.0 * 15.0 / shares, rel=1e-12)


def test_bands_add_degrees_of_freedom():
    random = np.random.default_rng(2)
    for window in ("rectangular", "hann"):
        options = WelchOptions(window=window, detrend="none", bands=8)
        runs = np.array([spectrum_of(1.0, random.normal(size=1024), options).density[5:40] for _ in range(200)])
        shown = 2.0 * runs.mean() ** 2 / runs.var(axis=0).mean()
        assert spectrum_of(1.0, random.normal(size=1024), options).degrees_of_freedom == pytest.approx(shown, rel=0.1)


@pytest.mark.parametrize("seed", range(4))
def test_a_synthetic_sea_gives_its_spectrum_back(seed):
    random = np.random.default_rng(seed)
    height, period = random.uniform(0.5, 4.0), random.uniform(4.0, 12.0)
    target = sea_spectra.jonswap(height, period, 3.3)
    water = Water(depth=20.0, density=1025.0, gravity=9.81)
    sea = synthesise(target, water, duration=7200.0, seed=seed, time_step=0.5)
    time = np.arange(14400) * 0.5
    found = spectrum_of(0.5, sea.elevation(time), WelchOptions(segment=256.0))
    figures = found.figures(highest=0.8)
    assert figures["spectral_height"] == pytest.approx(4.0 * math.sqrt(sea.variance), rel=0.03)
    assert figures["smooth_peak_period"] == pytest.approx(period, rel=0.06)
    m = [target.moment(n) / (2.0 * math.pi) ** n for n in range(3)]
    assert figures["period_m01"] == pytest.approx(m[0] / m[1], rel=0.05)
    assert figures["period_m02"] == pytest.approx(math.sqrt(m[0] / m[2]), rel=0.05)


def test_moments_of_two_lines():
    """Two cosines on lines of the transform: every moment by hand."""
    time = np.arange(1000) * 0.1
    values = 2.0 * np.cos(2.0 * np.pi * 0.10 * time) + 1.0 * np.cos(2.0 * np.pi * 0.25 * time + 0.3)
    found = spectrum_of(0.1, values, WelchOptions(window="rectangular", detrend="none"))
    figures = found.figures()
    m0, m1, m2, mm = 2.5, 2.0 * 0.1 + 0.5 * 0.25, 2.0 * 0.01 + 0.5 * 0.0625, 2.0 / 0.1 + 0.5 / 0.25
    assert figures["spectral_height"] == pytest.approx(4.0 * math.sqrt(m0), rel=1e-9)
    assert figures["period_m01"] == pytest.approx(m0 / m1, rel=1e-9)
    assert figures["period_m02"] == pytest.approx(math.sqrt(m0 / m2), rel=1e-9)
    assert figures["period_energy"] == pytest.approx(mm / m0, rel=1e-9)
    assert figures["peak_period"] == pytest.approx(10.0, rel=1e-6)


@pytest.mark.parametrize("seed", range(3))
def test_phase_convention_and_coherence(seed):
    """A channel that lags: phases follow Re(X exp(-i omega t)); noise lowers the coherence as it must."""
    random = np.random.default_rng(seed)
    noise = random.normal(size=40000)
    lag, level = 3, random.uniform(0.5, 2.0)
    late = np.roll(noise, lag) + level * random.normal(size=40000)
    found = cross_spectra(0.5, np.column_stack([late, noise]), WelchOptions(segment=64.0))
    inner = slice(3, 60)
    phase = np.unwrap(np.angle(found.matrix[inner, 0, 1]))
    expected = 2.0 * np.pi * found.frequency[inner] * lag * 0.5
    assert np.abs(phase - expected).max() < 0.3
    assert found.coherence(0, 1)[inner].mean() == pytest.approx(1.0 / (1.0 + level**2), abs=0.03)


def test_segments_with_a_gap_are_left_out():
    values = np.random.default_rng(3).normal(size=1000)
    values[510] = np.nan
    found = spectrum_of(1.0, values, WelchOptions(segment=100.0, overlap=0.0))
    assert (found.segments, found.left_out) == (9, 1)
    assert found.notices[0].code == "spectrum-segments"
    with pytest.raises(InputError, match="every segment"):
        spectrum_of(1.0, np.full(100, np.nan), WelchOptions())
    with pytest.raises(InputError, match="segments of"):
        spectrum_of(1.0, values, WelchOptions(segment=5000.0))
    with pytest.raises(InputError, match="overlap"):
        WelchOptions(overlap=1.0)


def test_figures_of_two_lines_are_those_by_hand():
    """Energies 3 and 1 at 0.1 and 0.2 Hz: m_n = 3 * 0.1^n + 0.2^n."""
    frequency, density = np.arange(0.0, 0.51, 0.01), np.zeros(51)
    density[[10, 20]] = 300.0, 100.0
    found = MeasuredSpectrum(frequency, density, 2.0).figures()
    m0, m1, m2, m4, below = (3.0 * 0.1**n + 0.2**n for n in (0, 1, 2, 4, -1))
    assert found["spectral_height"] == pytest.approx(4.0 * math.sqrt(m0), rel=1e-12)
    assert found["period_m01"] == pytest.approx(m0 / m1, rel=1e-12)
    assert found["period_m02"] == pytest.approx(math.sqrt(m0 / m2), rel=1e-12)
    assert found["period_energy"] == pytest.approx(below / m0, rel=1e-12)
    assert found["spectral_width"] == pytest.approx(math.sqrt(1.0 - m2**2 / (m0 * m4)), rel=1e-12)
    weight = (1.0 / 3.0) ** 4
    assert found["smooth_peak_period"] == pytest.approx((1.0 + weight) / (0.1 + 0.2 * weight), rel=1e-12)
