"""Mean and harmonics of a periodic record by least squares over whole periods.

Complex amplitudes follow ``Re(X exp(-i n omega t))``, so that they compare with computed ones without a change of sign.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from moyai.core.errors import InputError

FloatArray = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]


@dataclass(frozen=True, eq=False)
class Harmonics:
    """Mean and harmonics of one or more channels; equation [eq:harmonic-model].

    Parameters
    ----------
    omega : float
        Angular frequency of the first harmonic [rad/s].
    mean : ndarray, shape (channels,)
        Mean value, in the unit of the channel.
    amplitudes : ndarray, shape (harmonics, channels)
        Complex amplitudes X_1, X_2, ... of ``Re(X_n exp(-i n omega t))``.
    residual : ndarray, shape (channels,)
        Root mean square of what mean and harmonics leave unexplained.
    periods : int
        Number of whole periods that were used.
    start, end : float
        First instant used and the instant one step after the last [s].
    """

    omega: float
    mean: FloatArray
    amplitudes: ComplexArray
    residual: FloatArray
    periods: int
    start: float
    end: float

    @property
    def first(self) -> ComplexArray:
        """Complex amplitudes of the first harmonic."""
        return self.amplitudes[0]


def fit_harmonics(
    time: ArrayLike,
    values: ArrayLike,
    omega: float,
    *,
    count: int,
    start: float | None = None,
    end: float | None = None,
) -> Harmonics:
    """Fit mean and ``count`` harmonics over as many whole periods as fit between ``start`` and ``end``.

    Equation [eq:harmonic-model]. Whole periods keep the mean and the harmonics nearly orthogonal, so that a slow drift
    of the record disturbs them least; least squares, and not a discrete Fourier transform, because a period is seldom
    a whole number of samples.

    Parameters
    ----------
    time : array_like, shape (samples,)
        Increasing instants [s]; steps may be unequal.
    values : array_like, shape (samples,) or (samples, channels)
        Record, any unit, without gaps.
    omega : float
        Angular frequency of the first harmonic [rad/s].
    count : int
        Number of harmonics.
    start, end : float, optional
        Window [s]; the whole record when absent.

    Returns
    -------
    Harmonics

    Raises
    ------
    InputError
        When the window holds less than one whole period, too few samples, or values that are not finite.
    """
    instants = np.asarray(time, dtype=float)
    channels = np.asarray(values, dtype=float)
    channels = channels[:, None] if channels.ndim == 1 else channels
    if instants.ndim != 1 or channels.shape[0] != instants.size:
        raise InputError(f"{channels.shape[0]} rows of values for {instants.size} instants", path="values")
    if not (math.isfinite(omega) and omega > 0.0) or count < 1:
        raise InputError("the angular frequency and the number of harmonics must be positive", path="omega")
    if instants.size < 2 or not np.all(np.diff(instants) > 0.0):
        raise InputError("the instants must increase", path="time", remedy="sort the record or cut it at the reset")
    step = float(np.median(np.diff(instants)))
    first = instants[0] if start is None else max(float(start), float(instants[0]))
    last = instants[-1] + step if end is None else min(float(end), float(instants[-1]) + step)
    period = 2.0 * math.pi / omega
    # A millionth of a period forgives the rounding of the time column
    periods = math.floor((last - first) / period + 1e-6)
    if periods < 1:
        raise InputError(
            f"the window of {last - first:.4g} s is shorter than one period of {period:.4g} s",
            path="start, end",
            remedy="widen the window or check the period",
        )
    stop = first + periods * period
    chosen = (instants >= first - 1e-9 * period) & (instants < stop - 1e-3 * step)
    t, y = instants[chosen], channels[chosen]
    if t.size < 4 * count + 2:
        raise InputError(f"{t.size} samples are too few for {count} harmonics", path="count")
    if not np.all(np.isfinite(y)):
        raise InputError(
            "the window holds values that are not finite", path="values", remedy="choose a window without gaps"
        )
    # Phases are counted from the middle of the window, which keeps the matrix well conditioned at large clock times
    middle = 0.5 * (t[0] + t[-1])
    angles = omega * (t - middle)[:, None] * np.arange(1, count + 1)
    design = np.column_stack([np.ones_like(t), np.cos(angles), np.sin(angles)])
    solution, *_ = np.linalg.lstsq(design, y, rcond=None)
    residual = np.sqrt(np.mean((y - design @ solution) ** 2, axis=0))
    order = np.arange(1, count + 1)[:, None]
    amplitudes = (solution[1 : count + 1] + 1j * solution[count + 1 :]) * np.exp(1j * order * omega * middle)
    return Harmonics(omega, solution[0], amplitudes, residual, periods, float(first), float(stop))


def sliding_fits(
    time: ArrayLike, values: ArrayLike, omega: float, *, count: int, start: float, end: float, shifts: int = 7
) -> tuple[Harmonics, ...]:
    """Fit whole periods in several positions between ``start`` and ``end``; the middle one is the answer.

    A window seldom holds a whole number of periods. The remainder lets the fit slide; what changes while it slides is
    an honest uncertainty of a record that is not quite steady. With less than a tenth of a period to slide, one period
    is given up to make room.

    Parameters
    ----------
    time, values, omega, count, start, end
        As in :func:`fit_harmonics`.
    shifts : int
        Odd number of positions.

    Returns
    -------
    tuple of Harmonics
        From the earliest to the latest position, ``shifts`` of them.
    """
    if shifts < 1 or shifts % 2 == 0:
        raise InputError(f"{shifts} positions", path="shifts", allowed="an odd number")
    period = 2.0 * math.pi / omega
    periods = math.floor((end - start) / period + 1e-6)
    if (end - start) - periods * period < 0.1 * period and periods > 1:
        periods -= 1
    length = periods * period
    offsets = np.linspace(0.0, max((end - start) - length, 0.0), shifts)
    return tuple(
        fit_harmonics(time, values, omega, count=count, start=start + offset, end=start + offset + length)
        for offset in offsets
    )
