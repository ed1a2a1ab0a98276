"""Sums of components over time: Fourier transform, recurrence or direct, whichever fits."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from moyai.sea.kinematics import sum_over_any_time, sum_over_uniform_time

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]

#: Shortest time axis for which looking for a uniform step pays.
_SHORTEST = 8

#: Cost of a point of a Fourier transform, per factor of two of its length, over that of a component at one time.
_FOURIER_COST = 3.0


def uniform_step(time: Array) -> float | None:
    """Return the step of a uniform, increasing time axis [s], or None."""
    if time.size < _SHORTEST:
        return None
    step = float(time[-1] - time[0]) / (time.size - 1)
    if not step > 0.0:
        return None
    straight = time[0] + step * np.arange(time.size)
    # rounding of a grid made by arange or linspace, no more
    allowed = 8.0 * np.finfo(np.float64).eps * max(abs(float(time[0])), abs(float(time[-1])))
    return step if float(np.max(np.abs(time - straight))) <= allowed else None


def _through_fourier(omega: Array, rows: ComplexArray, start: float, steps: int, period: int, step: float) -> Array:
    """Sum components at whole multiples of ``step`` on ``period`` points a repeat period, repeated as needed."""
    number = np.rint(omega / step).astype(np.int64)
    turn = np.exp(-1j * omega * start)
    wanted = np.arange(steps) % period
    out = np.zeros((rows.shape[0], steps))
    half = np.zeros(period // 2 + 1, dtype=np.complex128)
    for row, amplitudes in enumerate(rows):
        if not amplitudes.any():
            continue
        half[:] = 0.0
        np.add.at(half, number, np.conj(amplitudes * turn) * (0.5 * period))
        out[row] = np.fft.irfft(half, n=period)[wanted]
    return out


def sum_over_time(omega: Array, amplitudes: ComplexArray, time: Array, frequency_step: float | None) -> Array:
    """Sum Re(amplitudes e^{-i omega t}) over components at all times.

    Parameters
    ----------
    omega : array, shape (components,)
        Frequencies [rad/s].
    amplitudes : complex array, shape (..., components)
        Complex amplitudes.
    time : array
        Times [s], any shape.
    frequency_step : float or None
        Common step of the frequencies [rad/s], None where there is none.

    Returns
    -------
    ndarray, shape (*time.shape, ...)
        The sums.
    """
    rows = np.ascontiguousarray(amplitudes.reshape(-1, omega.size))
    flat = np.ascontiguousarray(time).reshape(-1)
    step = uniform_step(flat)
    out: Array
    period = 0
    if step is not None and frequency_step is not None:
        exact = 2.0 * math.pi / (frequency_step * step)
        # the mismatch of the grids must stay below rounding over the whole record
        if abs(exact - round(exact)) <= 1e-12 * exact and np.max(omega) < math.pi / step * (1.0 - 1e-9):
            period = round(exact)
    transform = _FOURIER_COST * period * math.log2(max(period, 2))
    if step is not None and frequency_step is not None and period > 0 and transform < max(omega.size * flat.size, 1e6):
        out = _through_fourier(omega, rows, float(flat[0]), flat.size, period, frequency_step)
    else:
        out = np.empty((rows.shape[0], flat.size))
        if step is not None:
            sum_over_uniform_time(omega, rows, float(flat[0]), step, out)
        else:
            sum_over_any_time(omega, rows, flat, out)
    moved = np.moveaxis(out, 0, -1)
    return np.ascontiguousarray(moved).reshape((*time.shape, *amplitudes.shape[:-1]))
