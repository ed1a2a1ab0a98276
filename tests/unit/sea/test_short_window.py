"""Components merged for a short window of time, against the sum of all of them."""

import numpy as np
import pytest

from moyai.sea.short_window import ShortWindow


@pytest.mark.parametrize(("begin", "length"), [(0.0, 62.0), (3000.0, 20.0), (-5.0, 10.0)])
def test_merged_components_are_their_sum(begin, length):
    random = np.random.default_rng(8)
    omega = random.uniform(0.4, 7.0, 3000)
    amplitude = random.normal(size=omega.size) * np.exp(2j * np.pi * random.random(omega.size))
    time = np.linspace(begin, begin + length, 400)
    window = ShortWindow.of(omega, time)
    assert window.count < 0.6 * omega.size
    merged = np.zeros((window.count, 2))
    turned = amplitude * np.exp(-1j * omega * window.middle)
    for j, first in enumerate(window.first):
        merged[first : first + window.shares.shape[1], 0] += window.shares[j] * turned[j].real
        merged[first : first + window.shares.shape[1], 1] += window.shares[j] * turned[j].imag
    direct = (np.exp(-1j * np.outer(time, omega)) @ amplitude).real
    assert np.max(np.abs(merged.reshape(-1) @ window.waves - direct)) < 1e-7 * np.abs(amplitude).sum()
