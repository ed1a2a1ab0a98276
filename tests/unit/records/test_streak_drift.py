"""Closing the period: cubic and harmonics."""

import math

import numpy as np
import pytest

from moyai.core.errors import InputError
from moyai.records.streaks.drift_velocity import StreakChain, close_period_cubic, fit_drift_harmonics

RANDOM = np.random.default_rng(42)


def chain_of(place, interval, on_time, count, first=0.3):
    start = first + interval * np.arange(count)
    return StreakChain(start, start + on_time, place(start), place(start + on_time))


def random_motion(period, harmonics):
    drift, centre = RANDOM.normal(0.0, 0.01, 2), RANDOM.normal(0.0, 0.05, 2)
    waves = RANDOM.normal(0.0, 0.01, (harmonics, 2, 2)) / np.arange(1, harmonics + 1)[:, None, None] ** 2

    def place(time):
        total = centre + drift * np.asarray(time)[..., None]
        for n, (a, b) in enumerate(waves, start=1):
            phase = 2.0 * math.pi * n * np.asarray(time)[..., None] / period
            total = total + a * np.cos(phase) + b * np.sin(phase)
        return total

    return place, drift


@pytest.mark.parametrize("harmonics", [1, 2, 3])
def test_periodic_velocity_and_drift_are_found_exactly(harmonics):
    period = RANDOM.uniform(0.5, 3.0)
    place, drift = random_motion(period, harmonics)
    chain = chain_of(place, period / 9.6, 0.04 * period, 12)
    found = fit_drift_harmonics(chain, period)
    assert found.velocity == pytest.approx(drift, abs=1e-9)
    assert found.closure == pytest.approx(place(chain.time[0] + period), abs=1e-9)


def test_drift_is_unbiased_and_its_error_is_what_it_says():
    period, noise = 1.1, 2e-4
    place, drift = random_motion(period, 1)
    misses, said = [], []
    for _ in range(150):
        clean = chain_of(place, period / 9.6, 0.05, 12)
        start, end = (item + RANDOM.normal(0.0, noise, item.shape) for item in (clean.start, clean.end))
        found = fit_drift_harmonics(StreakChain(clean.start_time, clean.end_time, start, end), period, harmonics=(1,))
        misses.append(found.velocity - drift)
        said.append(found.deviation)
    misses = np.array(misses)
    assert np.std(misses) == pytest.approx(np.mean(said), rel=0.15)
    assert np.abs(misses.mean(axis=0)).max() < 4.0 * np.mean(said) / math.sqrt(150)


def test_cubic_is_exact_for_a_steady_drift_and_of_high_order_for_an_orbit():
    place, drift = random_motion(1.0, 0)
    steady = close_period_cubic(chain_of(place, 0.11, 0.05, 11), 1.0)
    assert steady.velocity == pytest.approx(drift, abs=1e-12)
    place, _ = random_motion(1.0, 1)
    errors = []
    for count in (10, 20):
        interval = 1.0 / (count - 0.4)
        # Short light: the chord's own error, of second order in the on-time, is not what is looked at
        chain = chain_of(place, interval, 1e-3 * interval, count + 2)
        errors.append(np.hypot(*(close_period_cubic(chain, 1.0).closure - place(chain.time[0] + 1.0))))
    assert errors[1] < errors[0] / 12.0


def test_mean_position_of_the_cubic_is_that_of_the_orbit():
    place, _ = random_motion(1.0, 1)
    chain = chain_of(place, 1.0 / 9.6, 0.02, 12)
    fine = np.linspace(chain.time[0], chain.time[0] + 1.0, 2001)
    expected = place(fine)[:-1].mean(axis=0)
    assert close_period_cubic(chain, 1.0).position == pytest.approx(expected, abs=2e-4)


def test_faults_of_a_chain_are_reported():
    place, _ = random_motion(1.0, 1)
    with pytest.raises(InputError, match="before the period"):
        fit_drift_harmonics(chain_of(place, 0.1, 0.05, 6), 1.0)
    with pytest.raises(InputError, match="too short"):
        close_period_cubic(chain_of(place, 0.4, 0.1, 3), 1.0)
    with pytest.raises(InputError, match="order of time"):
        StreakChain(np.array([0.0, 0.1]), np.array([0.2, 0.3]), np.zeros((2, 2)), np.zeros((2, 2)))


def test_the_number_of_harmonics_is_that_of_the_corrected_criterion_of_akaike():
    """n ln(s^2) + 2 k + 2 k (k + 1) / (n - k - 1) with n data and k unknowns, the variance among them."""
    rng, chosen, plain = np.random.default_rng(5), [], []
    for _ in range(60):
        period, ends = 1.0, 2 * rng.integers(5, 9)
        place, _ = random_motion(period, 2)
        clean = chain_of(place, 2.0 * period / ends, 0.05, ends // 2)
        noise = rng.normal(0.0, 4e-3, (2, *clean.start.shape))
        chain = StreakChain(clean.start_time, clean.end_time, clean.start + noise[0], clean.end + noise[1])
        fits = {
            number: fit_drift_harmonics(chain, period, harmonics=(number,))
            for number in (1, 2, 3)
            if ends >= 2 + 2 * number + 3
        }
        n = 2 * ends  # both components

        def corrected(number, fits=fits, n=n):
            k = 2 * (2 + 2 * number) + 1
            return n * math.log(fits[number].residual ** 2 / 2.0) + 2 * k + 2 * k * (k + 1) / (n - k - 1)

        def without(number, fits=fits, n=n):
            return n * math.log(fits[number].residual ** 2 / 2.0) + 2 * (2 * (2 + 2 * number) + 1)

        best = min(fits, key=corrected)
        chosen.append(best)
        plain.append(min(fits, key=without))
        assert fit_drift_harmonics(chain, period, harmonics=tuple(fits)).residual == fits[best].residual
    # the correction decides some of them
    assert len(set(chosen)) > 1 and chosen != plain
