"""Rounding noise does not reach tables and pages."""

from __future__ import annotations

import numpy as np

from moyai.structures.network.noise import NOISE, without_noise


def test_only_what_is_far_below_the_size_becomes_zero() -> None:
    draw = np.random.default_rng(5)
    size = 37.0
    values = size * 10.0 ** draw.uniform(-20.0, 0.0, 400) * draw.choice([-1.0, 1.0], 400)
    shown = without_noise(values, size)
    small = np.abs(values) < NOISE * size
    assert small.any() and (~small).any()
    assert not shown[small].any() and np.array_equal(shown[~small], values[~small])
    assert np.isnan(without_noise(np.array([np.nan]), size)).all()
