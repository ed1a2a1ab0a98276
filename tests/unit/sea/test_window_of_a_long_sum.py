"""A short window of a long record: Bluestein's sum against the components summed one by one."""

import numpy as np
import pytest

from moyai.floating.sums import complex_sum
from moyai.sea.time_sum import sum_in_window, sum_over_time, window_pays


@pytest.mark.parametrize("first", [0, 37])
def test_window_is_the_sum_of_its_components(first):
    random = np.random.default_rng(3)
    number = first + np.arange(0, 900, 3)
    rows = random.normal(size=(2, number.size)) + 1j * random.normal(size=(2, number.size))
    count, period = 150, 50_000
    assert window_pays(number, count, period)
    at = np.arange(count)
    direct = rows @ np.exp(-2j * np.pi * np.outer(number, at) / period)
    scale = np.abs(rows).sum(axis=1).max()
    assert np.max(np.abs(sum_in_window(number, rows, count, period) - direct)) < 1e-12 * scale


def test_waves_and_forces_of_a_window_are_those_of_the_whole_record():
    random = np.random.default_rng(4)
    step, period = 0.05, 40_000
    base = 2.0 * np.pi / (period * step)
    omega = base * np.arange(200, 1400)
    amplitude = random.normal(size=omega.size) * np.exp(2j * np.pi * random.random(omega.size))
    time = step * np.arange(300)
    direct = (np.exp(-1j * np.outer(time, omega)) * amplitude).sum(axis=1)
    scale = np.abs(amplitude).sum()
    assert np.max(np.abs(complex_sum(omega, amplitude[:, None], step, 300)[:, 0] - direct)) < 1e-9 * scale
    # a start far into the record: the rounding of the phases there is that of the direct sum too
    late = time + 1234.5
    found = sum_over_time(omega, amplitude[None], late, base)[:, 0]
    assert np.max(np.abs(found - (np.exp(-1j * np.outer(late, omega)) * amplitude).sum(axis=1).real)) < 1e-9 * scale
