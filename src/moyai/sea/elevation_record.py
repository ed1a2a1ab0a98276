"""A record of the elevation at one place as a sum of waves that repeats with it."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from moyai.core.arrays import Array
from moyai.core.errors import InputError

#: Part of the variance that the smallest components together may hold and be left out.
LEFT_OUT = 1e-8


@dataclass(frozen=True, eq=False)
class RecordComponents:
    """Waves a cos(phase - omega t) at the place of a record [eq:sea-record]."""

    #: [rad/s]; shape (n,).
    omega: Array
    #: [m]; shape (n,).
    amplitude: Array
    #: [rad]; shape (n,).
    phase: Array
    #: Mean elevation, which no wave carries [m].
    mean: float
    #: After which they repeat [s].
    period: float


def components_of_record(
    time: ArrayLike, elevation: ArrayLike, *, step: float | None = None, left_out: float = LEFT_OUT
) -> RecordComponents:
    """Return the waves of a record by its discrete Fourier transform [eq:sea-record].

    An odd number of samples loses its last one, so that a record that closes on itself repeats without a step.

    Parameters
    ----------
    time : array_like (k,)
        Rising [s]; need not be even, is taken on an even grid by straight lines.
    elevation : array_like (k,)
        [m].
    step : float, optional
        Of the even grid [s]; the smallest step of the record when left out.
    left_out : float
        Part of the variance that the smallest components together may hold and be left out.

    Returns
    -------
    RecordComponents
        The first time of the record is their time 0.

    Raises
    ------
    InputError
        For fewer than four rows, times that do not rise, values that are not finite, a surface that does not move.
    """
    t, eta = np.asarray(time, dtype=float), np.asarray(elevation, dtype=float)
    if t.ndim != 1 or t.shape != eta.shape or t.size < 4:
        raise InputError(f"a record of {t.size} rows", parameter="record", allowed="four rows or more")
    if not (np.isfinite(t).all() and np.isfinite(eta).all()):
        raise InputError("the record holds a value that is not finite", parameter="record", allowed="finite numbers")
    gaps = np.diff(t)
    if not (gaps > 0.0).all():
        row = int(np.argmin(gaps > 0.0)) + 1
        raise InputError(f"the time {t[row]:g} s follows {t[row - 1]:g} s", parameter="record", allowed="rising times")
    grid = float(gaps.min()) if step is None else step
    if not (math.isfinite(grid) and 0.0 < grid <= (t[-1] - t[0]) / 3.0):
        raise InputError(
            f"the time step is {grid:g} s", parameter="record", allowed="above 0, a third of the record or less"
        )
    count = math.floor((t[-1] - t[0]) / grid * (1.0 + 1e-12) + 1e-9) + 1
    if count > 4_000_000:
        raise InputError(
            f"{count} steps of {grid:g} s", parameter="record", allowed="4 000 000 steps", remedy="a larger step"
        )
    count -= count % 2
    samples = np.interp(t[0] + grid * np.arange(count), t, eta)
    sums = np.fft.rfft(samples)
    amplitude = np.abs(sums) * 2.0 / count
    amplitude[-1] *= 0.5
    omega = 2.0 * np.pi * np.arange(sums.size) / (count * grid)
    moving = amplitude[1:]
    if not moving.max() > 1e-12 * (abs(float(sums[0].real)) / count + 1e-300):
        raise InputError(
            "the elevation of the record does not change", parameter="record", remedy="leave the waves out"
        )
    order = np.argsort(moving)
    kept = np.sort(order[np.cumsum(moving[order] ** 2) > left_out * np.sum(moving**2)]) + 1
    # e^{+i w t} of the transform turns into e^{-i w t} of the waves
    return RecordComponents(
        omega[kept], amplitude[kept], -np.angle(sums[kept]), float(sums[0].real) / count, count * grid
    )
