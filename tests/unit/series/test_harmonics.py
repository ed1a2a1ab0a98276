"""Harmonics of records whose content is known."""

import math

import numpy as np
import pytest

from moyai.core.errors import InputError
from moyai.series.harmonics import fit_harmonics, fit_last_periods, sliding_fits


@pytest.mark.parametrize("seed", range(6))
def test_exact_for_a_sum_of_harmonics_at_any_clock(seed):
    rng = np.random.default_rng(seed)
    omega, start = rng.uniform(0.4, 9.0), rng.uniform(-1e5, 1e5)
    time = start + np.arange(4000) * rng.uniform(0.005, 0.02)
    count, channels = int(rng.integers(1, 4)), int(rng.integers(1, 4))
    mean = rng.normal(size=channels)
    amplitudes = rng.normal(size=(count, channels)) + 1j * rng.normal(size=(count, channels))
    values = mean + sum(np.real(amplitudes[n] * np.exp(-1j * (n + 1) * omega * time[:, None])) for n in range(count))
    fit = fit_harmonics(time, values, omega, count=count)
    # A clock of 1e5 s leaves about 1e-10 of a radian to rounding
    np.testing.assert_allclose(fit.mean, mean, atol=1e-10)
    np.testing.assert_allclose(fit.amplitude, amplitudes, atol=1e-8)
    assert np.all(fit.residual < 1e-9)


def test_whole_periods_only():
    time = np.arange(1000) * 0.01
    omega = 2.0 * math.pi / 0.7
    fit = fit_harmonics(time, np.cos(omega * time), omega, count=1, start=1.0, end=9.0)
    assert fit.periods == 11
    assert fit.end == pytest.approx(1.0 + 11 * 0.7)
    assert fit.first == pytest.approx(1.0)


def test_residual_is_the_noise():
    rng = np.random.default_rng(7)
    time = np.arange(20000) * 0.01
    noise = 0.3 * rng.normal(size=time.size)
    fit = fit_harmonics(time, 2.0 * np.cos(3.0 * time - 0.5) + noise, 3.0, count=2)
    assert fit.residual == pytest.approx(0.3, rel=0.03)
    # Standard error sqrt(2 / n) sigma = 0.003; four of them
    assert abs(fit.first - 2.0 * np.exp(0.5j)) < 0.012


def test_sliding_shows_the_drift_and_only_that():
    time = np.arange(6000) * 0.01
    omega = 2.0 * math.pi / 1.7
    steady = sliding_fits(time, np.cos(omega * time), omega, count=1, start=2.0, end=20.1)
    drifting = sliding_fits(time, (1.0 + 0.01 * time) * np.cos(omega * time), omega, count=1, start=2.0, end=20.1)
    assert max(abs(fit.first - steady[3].first) for fit in steady) < 1e-9
    moved = drifting[-1].start - drifting[0].start
    # The product of trend and carrier holds a second harmonic that moves the fit by up to rate / (2 omega) at each end
    assert abs(drifting[-1].first) - abs(drifting[0].first) == pytest.approx(0.01 * moved, abs=0.01 / omega)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"end": 0.5}, "shorter than one period"),
        ({"count": 0}, "must be positive"),
        ({"time": np.r_[np.arange(999), 5.0]}, "must increase"),
        ({"values": np.full(1000, np.nan)}, "not finite"),
    ],
)
def test_refusals(arguments, message):
    given = {"time": np.arange(1000) * 0.01, "values": np.ones(1000), "omega": 3.0, "count": 1, **arguments}
    with pytest.raises(InputError, match=message):
        fit_harmonics(**given)


def test_last_periods_leave_the_transient_out():
    omega = 2.0 * math.pi / 0.7
    time = np.arange(1, 2001) * 0.007
    values = np.cos(omega * time) + np.where(time < 5.0, 3.0, 0.0)
    fit = fit_last_periods(time, values, omega, periods=10)
    assert fit.periods == 10
    assert fit.end - fit.start == pytest.approx(7.0)
    assert type(fit.mean) is float and fit.amplitude.shape == (3,)
    assert fit.first == pytest.approx(1.0) and fit.residual < 1e-12
    with pytest.raises(InputError, match="do not fit"):
        fit_last_periods(time, values, omega, periods=21)
