"""Sums of components over time: Fourier transform, recurrence or direct, whichever fits."""

from __future__ import annotations

import math
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from moyai.core.arrays import Array, ComplexArray
from moyai.sea.kinematics import sum_over_any_time, sum_over_uniform_time

#: Shortest time axis for which looking for a uniform step pays.
_SHORTEST = 8

#: Cost of a point of a Fourier transform, per factor of two of its length, over that of a component at one time.
_FOURIER_COST = 3.0

#: Rows whose transforms fill the registers of a processor side by side.
_TOGETHER = 16

#: Points of transforms that a window takes, over those of its components and times.
_WINDOW_COST = 6


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


def sum_in_window(number: NDArray[np.int64], rows: ComplexArray, count: int, period: int) -> ComplexArray:
    """Return ``sum_i rows_i exp(-2 pi i number_i k / period)`` (r, count) for the first ``count`` of all k.

    Bluestein's algorithm: a short window of a long record costs transforms as long as its components and times.

    Parameters
    ----------
    number : ndarray of int (n,)
        Whole frequencies of the components.
    rows : ndarray (r, n)
        Amplitudes.
    count, period : int
        Times asked, times of a full repetition.
    """
    from scipy.fft import fft, ifft

    first, width = int(number.min()), int(np.ptp(number)) + 1
    chirp, back, ahead = _window(first, width, count, period)
    place = number - first
    spread = np.zeros((rows.shape[0], back.size), dtype=np.complex128)
    if np.bincount(place).max() == 1:
        spread[:, place] = rows * chirp[place]
    else:
        for row, amplitudes in zip(spread, rows * chirp[place], strict=True):
            np.add.at(row, place, amplitudes)
    found = fft(spread, axis=1, overwrite_x=True)
    found *= back
    found = ifft(found, axis=1, overwrite_x=True)[:, :count]
    found *= ahead
    return np.asarray(found)


@lru_cache(maxsize=4)
def _window(first: int, width: int, count: int, period: int) -> tuple[ComplexArray, ComplexArray, ComplexArray]:
    """Return the factors of Bluestein's algorithm: of the components, of their transform, and of the times."""
    from scipy.fft import fft, next_fast_len

    along = np.arange(max(width, count), dtype=np.int64)
    chirp = np.exp(-1j * math.pi / period * (along * along % (2 * period)))
    size = next_fast_len(width + count - 1)
    back = np.zeros(size, dtype=np.complex128)
    back[:count] = chirp[:count].conj()
    back[size - width + 1 :] = chirp[1:width][::-1].conj()
    turns = np.exp(-2j * math.pi / period * (first * along[:count] % period))
    return chirp[:width], fft(back), chirp[:count] * turns


def window_pays(number: NDArray[np.int64], count: int, period: int) -> bool:
    """Whether a window of ``count`` times is cheaper through :func:`sum_in_window` than by a transform of it all."""
    return _WINDOW_COST * (int(number.max() - number.min()) + count) < period


def _through_fourier(omega: Array, rows: ComplexArray, start: float, steps: int, period: int, step: float) -> Array:
    """Sum components at whole multiples of ``step`` on ``period`` points a repeat period, repeated as needed."""
    number = np.rint(omega / step).astype(np.int64)
    turn = np.exp(-1j * omega * start)
    out = np.zeros((rows.shape[0], steps))
    if window_pays(number, steps, period):
        some = rows.any(axis=1)
        out[some] = sum_in_window(number, rows[some] * turn, steps, period).real
        return out
    from scipy.fft import irfft

    wanted = slice(steps) if steps <= period else np.arange(steps) % period
    known = np.flatnonzero(rows.any(axis=1))
    for first in range(0, known.size, _TOGETHER):
        chosen = known[first : first + _TOGETHER]
        half = np.zeros((chosen.size, period // 2 + 1), dtype=np.complex128)
        for line, amplitudes in zip(half, np.conj(rows[chosen] * turn) * (0.5 * period), strict=True):
            np.add.at(line, number, amplitudes)
        out[chosen] = irfft(half, n=period, axis=1, overwrite_x=True)[:, wanted]
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
    out = sum_rows_over_time(omega, rows, np.ascontiguousarray(time).reshape(-1), frequency_step)
    moved = np.moveaxis(out, 0, -1)
    return np.ascontiguousarray(moved).reshape((*time.shape, *amplitudes.shape[:-1]))


def sum_rows_over_time(omega: Array, rows: ComplexArray, flat: Array, frequency_step: float | None) -> Array:
    """Return the sums of :func:`sum_over_time` for rows of amplitudes (r, n) at times (t,), shape (r, t)."""
    step = uniform_step(flat)
    out: Array
    period = 0
    if step is not None and frequency_step is not None:
        exact = 2.0 * math.pi / (frequency_step * step)
        # the mismatch of the grids must stay below rounding over the whole record
        if abs(exact - round(exact)) <= 1e-12 * exact and np.max(omega) < math.pi / step * (1.0 - 1e-9):
            period = round(exact)
    points = period
    if period and frequency_step is not None:
        number = np.rint(omega / frequency_step).astype(np.int64)
        if window_pays(number, flat.size, period):
            points = _WINDOW_COST * (int(np.ptp(number)) + flat.size)
    transform = _FOURIER_COST * points * math.log2(max(points, 2))
    if step is not None and frequency_step is not None and period > 0 and transform < max(omega.size * flat.size, 1e6):
        out = _through_fourier(omega, rows, float(flat[0]), flat.size, period, frequency_step)
    else:
        out = np.empty((rows.shape[0], flat.size))
        if step is not None:
            sum_over_uniform_time(omega, rows, float(flat[0]), step, out)
        else:
            sum_over_any_time(omega, rows, flat, out)
    return out
