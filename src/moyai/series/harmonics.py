"""Mean and harmonics of a periodic series by least squares over whole periods.

Complex amplitudes follow ``Re(X exp(-i n omega t))``, so that measured ones compare with computed ones without a change
of sign.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from moyai.core.arrays import Array, ComplexArray
from moyai.core.errors import InputError
from moyai.core.single import plain


@dataclass(frozen=True, eq=False)
class Harmonics:
    """Mean and harmonics of one or more channels; equation [eq:harmonic-model]."""

    #: Angular frequency of the first harmonic [rad/s].
    omega: float
    #: Mean value, in the unit of the channel; the shape of one row of the series, a float for one channel; shape (...).
    mean: Array
    #: Complex amplitudes X_1, X_2, ... of ``Re(X_n exp(-i n omega t))``. Shape (harmonics, ...).
    amplitude: ComplexArray
    #: Root mean square of what mean and harmonics leave unexplained: unsteadiness or noise; shaped as the mean.
    residual: Array
    #: Number of whole periods that were used.
    periods: int
    #: First instant used [s].
    start: float
    #: Instant one step after the last one used [s].
    end: float

    @property
    def first(self) -> ComplexArray:
        """Complex amplitude of the first harmonic."""
        values: ComplexArray = self.amplitude[0]
        return values


def fit_harmonics(
    time: ArrayLike,
    values: ArrayLike,
    omega: float,
    *,
    count: int,
    start: float | None = None,
    end: float | None = None,
) -> Harmonics:
    """Fit mean and ``count`` harmonics over as many whole periods as fit into the window [eq:harmonic-model].

    Whole periods keep the mean and the harmonics nearly orthogonal, so that a slow drift
    of the record disturbs them least; least squares, and not a discrete Fourier transform, because a period is seldom
    a whole number of samples.

    Parameters
    ----------
    time : array_like, shape (samples,)
        Increasing instants [s]; steps may be unequal.
    values : array_like, shape (samples, ...)
        Series of one or more channels, any unit, without gaps.
    omega : float
        Angular frequency of the first harmonic [rad/s].
    count : int
        Number of harmonics.
    start, end : float, optional
        Window [s]; the whole series when absent. The periods are counted from its start.

    Returns
    -------
    Harmonics
        Mean, complex amplitudes (count, ...) of ``Re(a exp(-i n omega t))`` and residual, in the unit of ``values``.

    Raises
    ------
    InputError
        When the window holds less than one whole period, too few samples, or values that are not finite.

    Examples
    --------
    >>> import numpy as np
    >>> from moyai.series import fit_harmonics
    >>> time = np.arange(0.0, 40.0, 0.1)
    >>> found = fit_harmonics(time, 2.0 + 3.0 * np.cos(time) + 0.5 * np.cos(2.0 * time), omega=1.0, count=2)
    >>> round(float(found.mean), 3), np.abs(found.amplitude).round(3).tolist(), found.periods
    (2.0, [3.0, 0.5], 6)
    """
    instants, channels = _checked(time, values, omega, count)
    step = float(np.median(np.diff(instants)))
    first = float(instants[0] if start is None else max(float(start), float(instants[0])))
    last = instants[-1] + step if end is None else min(float(end), float(instants[-1]) + step)
    period = 2.0 * math.pi / omega
    # A millionth of a period forgives the rounding of the time column
    periods = math.floor((last - first) / period + 1e-6)
    if periods < 1:
        raise InputError(
            f"the window of {last - first:.4g} s is shorter than one period of {period:.4g} s",
            parameter="start, end",
            remedy="widen the window or check the period",
        )
    stop = first + periods * period
    chosen = (instants >= first - 1e-9 * period) & (instants < stop - 1e-3 * step)
    return _least_squares(instants, channels, chosen, omega, count, periods, (first, stop))


def fit_last_periods(
    time: ArrayLike, values: ArrayLike, omega: float, *, periods: int | None = None, count: int = 3
) -> Harmonics:
    """Fit mean and ``count`` harmonics to the last whole periods of a series, where a simulation is steadiest.

    Equation [eq:harmonic-model]; the same least squares as :func:`fit_harmonics`.

    Parameters
    ----------
    time, values, omega, count
        As in :func:`fit_harmonics`.
    periods : int, optional
        Whole periods at the end; as many as there are when absent.

    Returns
    -------
    Harmonics

    Raises
    ------
    InputError
        When the series does not hold the periods, has too few samples, or values that are not finite.
    """
    instants, channels = _checked(time, values, omega, count)
    period = 2.0 * math.pi / omega
    duration = float(instants[-1] - instants[0])
    step = duration / (len(instants) - 1)
    available = math.floor((duration + step) / period + 1e-6)
    whole = available if periods is None else periods
    if whole < 1 or whole > available:
        raise InputError(
            f"{whole} whole periods of {period:.4g} s do not fit into {duration:.4g} s",
            parameter="periods",
            allowed=f"at most {available}",
            remedy="simulate longer or analyse fewer periods",
        )
    # The first instant of the window belongs to the period before, so that no phase counts twice
    chosen = instants > instants[-1] - whole * period + 1e-6 * step
    window = (float(instants[chosen][0]), float(instants[-1] + step))
    return _least_squares(instants, channels, chosen, omega, count, whole, window)


def _checked(time: ArrayLike, values: ArrayLike, omega: float, count: int) -> tuple[Array, Array]:
    instants, channels = np.asarray(time, dtype=float), np.asarray(values, dtype=float)
    if instants.ndim != 1 or channels.ndim < 1 or len(channels) != instants.size:
        raise InputError(f"values of shape {channels.shape} for {instants.size} instants", parameter="values")
    if not (math.isfinite(omega) and omega > 0.0) or count < 1:
        raise InputError("the angular frequency and the number of harmonics must be positive", parameter="omega")
    if instants.size < 2 or not np.all(np.diff(instants) > 0.0):
        raise InputError(
            "the instants must increase", parameter="time", remedy="sort the record or cut it at the reset"
        )
    return instants, channels


def _least_squares(
    instants: Array,
    channels: Array,
    chosen: NDArray[np.bool_],
    omega: float,
    count: int,
    periods: int,
    window: tuple[float, float],
) -> Harmonics:
    t, y = instants[chosen], channels[chosen]
    # Twice as many samples as unknowns: with fewer the residual says nothing
    if t.size < 4 * count + 2:
        raise InputError(f"{t.size} samples are too few for {count} harmonics", parameter="count")
    if not np.all(np.isfinite(y)):
        raise InputError(
            "the window holds values that are not finite", parameter="values", remedy="choose a window without gaps"
        )
    # Phases are counted from the middle of the window, which keeps the matrix well conditioned at large clock times
    middle = 0.5 * (t[0] + t[-1])
    angles = omega * (t - middle)[:, None] * np.arange(1, count + 1)
    design = np.column_stack([np.ones_like(t), np.cos(angles), np.sin(angles)])
    flat = y.reshape(t.size, -1)
    solution, *_ = np.linalg.lstsq(design, flat, rcond=None)
    residual = np.sqrt(np.mean((flat - design @ solution) ** 2, axis=0))
    order = np.arange(1, count + 1)[:, None]
    # a cos + b sin = Re((a + i b) exp(-i phase))
    amplitude = (solution[1 : count + 1] + 1j * solution[count + 1 :]) * np.exp(1j * order * omega * middle)
    shape = channels.shape[1:]
    return Harmonics(
        omega,
        plain(solution[0].reshape(shape)),
        amplitude.reshape(count, *shape),
        plain(residual.reshape(shape)),
        periods,
        *window,
    )


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
        raise InputError(f"{shifts} positions", parameter="shifts", allowed="an odd number")
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
