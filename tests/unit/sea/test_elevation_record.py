"""Waves of a record against its samples, a random sea and Parseval's theorem; what is no record is reported."""

import numpy as np
import pytest

from moyai.core.errors import InputError
from moyai.sea.components import WaveComponents
from moyai.sea.elevation_record import components_of_record


def sea_of(found):
    zero = np.zeros(found.omega.size)
    return WaveComponents(found.omega, found.amplitude, found.phase, zero, zero)


@pytest.mark.parametrize("seed", range(6))
def test_the_waves_give_the_samples_again(seed):
    rng = np.random.default_rng(seed)
    count, step, start = int(rng.integers(8, 300)), rng.uniform(0.05, 2.0), rng.uniform(-50.0, 50.0)
    eta = rng.normal(0.3, 1.0, count)
    found = components_of_record(start + step * np.arange(count), eta, left_out=0.0)
    even = count - count % 2
    time = step * np.arange(even)
    assert found.period == pytest.approx(even * step)
    np.testing.assert_allclose(sea_of(found).elevation(time) + found.mean, eta[:even], atol=1e-9)
    half = found.amplitude**2 * np.where(np.isclose(found.omega, np.pi / step), 1.0, 0.5)
    assert half.sum() == pytest.approx(np.var(eta[:even]))


def test_what_is_left_out_is_small_and_the_rest_exact():
    rng = np.random.default_rng(3)
    omega, time = 2.0 * np.pi * np.arange(5, 60) / 600.0, 0.5 * np.arange(1201)
    amplitude, phase = rng.uniform(0.0, 1.0, omega.size), rng.uniform(-np.pi, np.pi, omega.size)
    eta = (amplitude[:, None] * np.cos(phase[:, None] - omega[:, None] * time)).sum(axis=0)
    found = components_of_record(time, eta)
    assert found.omega.size <= omega.size
    kept = np.searchsorted(omega, found.omega * (1.0 - 1e-9))
    np.testing.assert_allclose(found.amplitude, amplitude[kept], atol=1e-9)
    np.testing.assert_allclose(np.exp(1j * found.phase), np.exp(1j * phase[kept]), atol=1e-6)
    lost = np.sum(amplitude**2) - np.sum(found.amplitude**2)
    assert lost <= 1.1e-8 * np.sum(amplitude**2)


def test_an_uneven_record_is_taken_on_an_even_grid():
    time = np.sort(np.random.default_rng(1).uniform(0.0, 60.0, 4000))
    found = components_of_record(time, np.cos(2.0 * np.pi * time / 6.0), step=0.1)
    assert 2.0 * np.pi / found.omega[np.argmax(found.amplitude)] == pytest.approx(6.0, rel=0.02)
    assert found.amplitude.max() == pytest.approx(1.0, rel=0.05)


@pytest.mark.parametrize(
    ("time", "eta", "step", "words"),
    [
        ([0, 1, 2], [0, 1, 0], None, "3 rows"),
        ([0, 1, 1, 2], [0, 1, 0, 1], None, "1 s follows 1 s"),
        ([0, 1, 2, 3], [0, np.nan, 0, 1], None, "not finite"),
        ([0, 1, 2, 3], [2, 2, 2, 2], None, "does not change"),
        ([0, 1, 2, 3], [0, 1, 0, 1], 2.0, "time step is 2"),
        ([0, 1, 2, 3], [0, 1, 0, 1], -1.0, "time step is -1"),
        ([0, 1, 2, 3], [0, 1, 0, 1], 1e-9, "larger step|steps of 1e-09"),
    ],
)
def test_what_is_no_record_is_reported(time, eta, step, words):
    with pytest.raises(InputError, match=words):
        components_of_record(time, eta, step=step)
