"""The offset of a unit is its horizontal distance from rest, and a row is tilted by pitch as by roll."""

from __future__ import annotations

import numpy as np

from moyai.structures.units.datasets import _farthest


def test_distance_over_a_period_is_that_of_the_path() -> None:
    """A circle about a mean of 3 and 4 m: five and its radius; motions in one line: mean and amplitude."""
    offset = np.zeros((1, 2, 6))
    offset[0, 0, :2], offset[0, 1, 1] = (3.0, 4.0), -0.5
    motion = np.zeros((1, 2, 6), dtype=complex)
    motion[0, 0, :2], motion[0, 1, 1] = (2.0, 2.0j), 1.5 * np.exp(0.3j)
    np.testing.assert_allclose(_farthest(offset, motion), [[7.0, 2.0]], rtol=2e-4)
