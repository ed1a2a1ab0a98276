"""Cycles of a series by the rainflow method."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from moyai.core.arrays import Array
from moyai.core.errors import InputError


def count_cycles(series: ArrayLike) -> tuple[Array, Array, Array]:
    """Count rainflow cycles of a record (ASTM E1049).

    Parameters
    ----------
    series : array_like (n,)
        Tension or stress.

    Returns
    -------
    ranges, means, counts : ndarray
        Of the unit of the series; counts are 1 or 0.5.

    Raises
    ------
    InputError
        For a record with NaN or fewer than three values.

    Examples
    --------
    >>> from moyai.series import count_cycles
    >>> ranges, means, counts = count_cycles([0.0, 2.0, -1.0, 3.0, 0.0])
    >>> ranges.tolist(), counts.tolist()
    ([2.0, 3.0, 4.0, 3.0], [0.5, 0.5, 0.5, 0.5])
    """
    import rainflow

    data = np.asarray(series, dtype=float).ravel()
    if data.size < 3 or not np.isfinite(data).all():
        raise InputError("a record to count has at least three finite values", parameter="series")
    cycles = [(size, mean, count) for size, mean, count, _, _ in rainflow.extract_cycles(data)]
    if not cycles:
        return np.empty(0), np.empty(0), np.empty(0)
    ranges, means, counts = (np.array(column, dtype=float) for column in zip(*cycles))
    return ranges, means, counts
