"""The carriage's vibration: found where it is, taken out without phases, the mean and its uncertainty."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest
from scipy.signal import lfilter

from moyai.core.errors import InputError
from moyai.records.nets.steady import correlated_covariance, correlated_mean, steady_window
from moyai.records.nets.synthesis import Rig
from moyai.records.nets.vibration import Vibration, find_vibration, low_pass, remove_band, shaken_mass


def slow(size: int, keep: float, rng: np.random.Generator) -> np.ndarray:
    out = np.empty(size)
    out[0] = rng.normal()
    for k in range(1, size):
        out[k] = keep * out[k - 1] + np.sqrt(1.0 - keep**2) * rng.normal()
    return out


@pytest.mark.parametrize(("frequency", "rate"), [(2.2, 40.0), (3.05, 50.0), (4.7, 100.0), (9.3, 60.0)])
def test_line_is_found_where_it_is(frequency, rate):
    rng = np.random.default_rng(round(100 * frequency))
    rig = Rig(rate=rate, vibration_frequency=frequency, vibration_damping=0.015)
    forces = [2.0 + rig.shaking(900, rng) + rig.noise(900, rng) for _ in range(4)]
    found = find_vibration([1.0 / rate] * 4, forces).found
    assert found is not None
    assert found.frequency == pytest.approx(frequency, rel=0.03)
    assert found.low < frequency < found.high
    assert found.amplitude == pytest.approx(0.15, rel=0.2)


def test_noise_alone_shows_no_line():
    rng = np.random.default_rng(3)
    rig = Rig(vibration_force=0.0)
    for _ in range(30):
        search = find_vibration([0.02] * 3, [rig.noise(1000, rng) for _ in range(3)])
        assert search.found is None
        assert search.density.size == search.background.size


def test_searches_that_cannot_be():
    with pytest.raises(InputError, match="no still-water run"):
        find_vibration([], [])
    with pytest.raises(InputError, match="too short"):
        find_vibration([0.02], [np.random.default_rng(1).normal(size=100)])
    with pytest.raises(InputError, match="Nyquist"):
        find_vibration([0.5], [np.random.default_rng(1).normal(size=1000)])
    with pytest.raises(InputError, match="low < line < high"):
        Vibration(3.0, 3.3, 2.8)


def test_filters_shift_no_phase_and_leave_what_lies_outside():
    """A chirp-free check: sines in and out of the band, at random phases and frequencies."""
    rng = np.random.default_rng(7)
    step, time = 0.02, 0.02 * np.arange(1500)
    line = Vibration(3.0, 2.7, 3.4)
    middle = slice(250, 1250)
    for _ in range(12):
        outside = rng.choice([rng.uniform(0.3, 2.6), rng.uniform(3.5, 8.0)])
        inside = rng.uniform(2.95, 3.1)
        kept = np.cos(2 * np.pi * outside * time + rng.uniform(0, 7))
        gone = np.cos(2 * np.pi * inside * time + rng.uniform(0, 7))
        trend = 0.5 + 0.03 * time
        out = remove_band(step, kept + gone + trend, line)
        # the band is narrow, so that its answer rings 1/(pi n) far from the mirrored ends
        assert np.abs(out - kept - trend)[middle].max() < 0.07
        # a phase shift of two degrees would show
        basis = np.exp(2j * np.pi * outside * time[middle])
        shift = np.angle((basis @ out[middle]) / (basis @ (kept + trend)[middle]))
        assert abs(shift) < 0.03
    ramp = 2.0 + 0.1 * time
    assert low_pass(step, ramp, 1.0) == pytest.approx(ramp, abs=1e-10)
    assert remove_band(step, ramp, line) == pytest.approx(ramp, abs=1e-10)
    with pytest.raises(InputError, match="too few"):
        low_pass(step, np.ones(4), 1.0)


def test_filter_is_symmetric_in_time():
    rng = np.random.default_rng(2)
    values = rng.normal(size=700)
    line = Vibration(3.0, 2.6, 3.5)
    assert remove_band(0.02, values[::-1], line)[::-1] == pytest.approx(remove_band(0.02, values, line), abs=1e-10)


@pytest.mark.parametrize("mass", [0.6, 1.9, -1.1])
def test_mass_of_what_shakes(mass):
    rng = np.random.default_rng(5)
    rig = Rig()
    shaken = rig.shaking(2000, rng)
    force = shaken + 0.03 * rng.normal(size=2000)
    found = shaken_mass(0.02, force, shaken / mass, Vibration(3.0, 2.5, 3.5))
    assert found.mass == pytest.approx(mass, abs=4.0 * found.error)
    assert found.error < 0.05 * abs(mass)
    assert found.coherence > 0.95
    with pytest.raises(InputError, match="shows nothing"):
        shaken_mass(0.02, force, np.zeros(2000), Vibration(3.0, 2.5, 3.5))


@pytest.mark.slow
@pytest.mark.parametrize("keep", [0.0, 0.8, 0.97])
def test_interval_of_a_correlated_mean_covers(keep):
    rng = np.random.default_rng(11)
    hits, widths = 0, []
    for _ in range(120):
        found = correlated_mean(3.0 + slow(1500, keep, rng))
        hits += abs(found.value - 3.0) < found.half_width
        widths.append(found.error)
    assert hits >= 106
    # variance of the mean of an AR(1) process
    assert np.mean(widths) == pytest.approx(np.sqrt((1.0 + keep) / (1.0 - keep) / 1500.0), rel=0.2)


@pytest.mark.slow
def test_covariance_of_coefficients_under_slow_noise():
    """Long-run variance of linear estimates against their spread over many records."""
    rng = np.random.default_rng(13)
    time = np.arange(1500)
    design = np.column_stack([np.ones(1500), np.cos(2 * np.pi * time / 60.0), np.sin(2 * np.pi * time / 60.0)])
    gain = np.linalg.pinv(design)
    values, covariances = [], []
    for _ in range(150):
        noise = slow(1500, 0.97, rng)
        values.append(gain @ noise)
        covariances.append(correlated_covariance(gain, noise - design @ values[-1], 240.0)[0])
    spread = np.std(values, axis=0)
    found = np.sqrt(np.mean([np.diagonal(item) for item in covariances], axis=0))
    assert found == pytest.approx(spread, rel=0.2)


def test_steady_window_by_speed_and_by_force():
    time = np.arange(0.0, 20.0, 0.02)
    course = np.clip(np.minimum(time / 4.0, (20.0 - time) / 2.0), 0.0, 1.0)
    for is_speed in (True, False):
        first, last = steady_window(time, 0.6 * course, is_speed=is_speed)
        assert 4.0 < first < 6.5
        assert 15.5 < last < 18.0
    # the sign of the force does not matter; a record steady throughout is used whole
    assert steady_window(time, -2.0 * np.ones(time.size), is_speed=False) == (time[0], time[-1])
    with pytest.raises(InputError, match="does not move"):
        steady_window(time, np.zeros(time.size), is_speed=True)
    with pytest.raises(InputError, match="no steady stretch"):
        steady_window(time, np.random.default_rng(1).normal(size=time.size), is_speed=True)
    with pytest.raises(InputError, match="at least 16"):
        correlated_mean(np.ones(5))
    assert correlated_mean(np.ones(50)).error == 0.0
    assert dataclasses.is_dataclass(Rig())


@pytest.mark.parametrize("memory", [0.8, 0.9, 0.95])
def test_degrees_of_freedom_of_a_mean_with_correlated_errors(memory: float) -> None:
    """Errors of order one: the autocorrelation is followed to six of its times tau; 1.5 n over 12 tau is n / 8 tau."""
    count = 200_000
    noise = lfilter([1.0], [1.0, -memory], np.random.default_rng(1).standard_normal(count))
    covariance, freedom = correlated_covariance(np.full((1, count), 1.0 / count), noise - noise.mean(), 1.0)
    tau = 0.5 + memory / (1.0 - memory)
    assert freedom * tau / count == pytest.approx(1.0 / 8.0, rel=0.05)
    # the variance of the mean is that of white noise over (1 - memory)^2
    assert covariance[0, 0] * count * (1.0 - memory) ** 2 == pytest.approx(1.0, rel=0.06)


def test_errors_that_turn_their_sign_count_as_independent_ones() -> None:
    """Their time falls below a half, that of white noise, which stands in its place: three samples are followed."""
    count = 50_000
    noise = lfilter([1.0], [1.0, 0.3], np.random.default_rng(2).standard_normal(count))
    _, freedom = correlated_covariance(np.full((1, count), 1.0 / count), noise - noise.mean(), 1.0)
    assert freedom == pytest.approx(1.5 * count / 6.0, rel=1e-12)
