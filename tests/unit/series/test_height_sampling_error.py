"""Standard error of Hm0 of a block, held against the scatter of drawn seas."""

import math

import numpy as np
import pytest

from moyai.series.spectra import height_sampling_error


def test_error_is_the_scatter_of_drawn_gaussian_seas():
    random = np.random.default_rng(8)
    duration, step = 600.0, 0.5
    count = int(duration / step) * 40
    frequency = np.fft.rfftfreq(count, step)
    density = np.where(frequency > 0.0, np.exp(-0.5 * ((frequency - 0.12) / 0.015) ** 2), 0.0)
    heights = []
    for _ in range(12):
        level = np.fft.irfft(
            np.sqrt(density) * (random.normal(size=density.size) + 1j * random.normal(size=density.size))
        )
        heights.extend(level.reshape(40, -1).std(axis=1))
    scatter = np.std(heights) / np.mean(heights)
    exact = height_sampling_error(frequency, density, math.inf, duration)
    assert exact == pytest.approx(scatter, rel=0.12)  # 480 blocks leave 3 % of scatter of their own
    # an estimate of 20 degrees of freedom gives the same in the mean
    drawn = [
        height_sampling_error(frequency, density * random.chisquare(20, density.size) / 20, 20.0, duration)
        for _ in range(20)
    ]
    assert np.mean(drawn) == pytest.approx(exact, rel=0.02)
    assert math.isnan(height_sampling_error(frequency, 0.0 * density, 20.0, duration))
