"""Harmonics of a steady motion by least squares over whole periods."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from moyai.core.errors import InputError
from moyai.floating.arrays import ComplexArray, FloatArray, positive


@dataclass(frozen=True)
class Harmonics:
    """Mean and harmonics of one or more series.

    Parameters
    ----------
    omega : float
        Fundamental [rad/s].
    mean : ndarray (...)
    amplitude : ndarray (count, ...)
        Complex amplitudes of omega, 2 omega, ..., ``Re(X exp(-i n omega t))`` with t as given.
    periods : int
        Whole periods used.
    remainder : ndarray (...)
        Standard deviation of what the harmonics leave over: unsteadiness or noise.
    """

    omega: float
    mean: FloatArray
    amplitude: ComplexArray
    periods: int
    remainder: FloatArray

    @property
    def first(self) -> ComplexArray:
        """First harmonic."""
        return self.amplitude[0]


def fit_harmonics(
    time: ArrayLike, series: ArrayLike, omega: float, *, periods: int | None = None, count: int = 3
) -> Harmonics:
    """Fit mean and ``count`` harmonics to the end of a series [eq:floating-harmonics].

    Parameters
    ----------
    time : array_like (n,)
        Increasing [s].
    series : array_like (n, ...)
    omega : float
        [rad/s].
    periods : int or None
        Whole periods at the end that are used; ``None`` takes as many as there are.
    count : int
        Number of harmonics.

    Raises
    ------
    InputError
        When the series does not hold the periods, or has too few rows for the harmonics.
    """
    positive(omega, "omega")
    instants, values = np.asarray(time, dtype=float), np.asarray(series, dtype=float)
    period = 2.0 * math.pi / omega
    step = (instants[-1] - instants[0]) / max(len(instants) - 1, 1)
    available = int((instants[-1] - instants[0] + step) / period + 1e-6)
    whole = available if periods is None else periods
    if whole < 1 or whole > available:
        raise InputError(
            f"{whole} whole periods of {period:.4g} s do not fit into {instants[-1] - instants[0]:.4g} s",
            path="periods",
        )
    # The first instant of the window belongs to the period before, so that no phase counts twice
    keep = instants > instants[-1] - whole * period + 1e-6 * step
    if int(keep.sum()) < 2 * count + 1:
        raise InputError(f"{int(keep.sum())} rows for {count} harmonics", path="count")
    used, rows = instants[keep], values[keep]
    phase = omega * used[:, None] * np.arange(1, count + 1)
    basis = np.concatenate([np.ones((len(used), 1)), np.cos(phase), np.sin(phase)], axis=1)
    flat = rows.reshape(len(used), -1)
    weights = np.linalg.lstsq(basis, flat, rcond=None)[0]
    remainder = np.sqrt(np.mean((flat - basis @ weights) ** 2, axis=0))
    shape = values.shape[1:]
    # a cos + b sin = Re((a + i b) exp(-i phase))
    amplitude = weights[1 : count + 1] + 1j * weights[count + 1 :]
    return Harmonics(
        omega=omega,
        mean=weights[0].reshape(shape),
        amplitude=amplitude.reshape(count, *shape),
        periods=whole,
        remainder=remainder.reshape(shape),
    )
