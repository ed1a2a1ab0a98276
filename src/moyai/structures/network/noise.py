"""Rounding noise in what is shown of a network."""

from __future__ import annotations

import numpy as np

from moyai.core.arrays import Array

#: Part of the size of a problem below which a number is rounding.
NOISE = 1e-12


def without_noise(values: Array, size: float) -> Array:
    """Return the values with those far below the size of the problem as exact zeros.

    A body that hangs in the middle of two equal lines stands at y = 0, not at 3e-30 m.

    Parameters
    ----------
    values : ndarray
    size : float
        Of the problem, in the unit of the values.
    """
    return np.where(np.abs(values) < NOISE * size, 0.0, values)
