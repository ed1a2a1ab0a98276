"""Statistics of a time series by zero-up-crossing: cycles, significant values, exceedance, Rayleigh expectations.

For the results of time-domain runs: elevation, motion, tension. A cycle begins where the series rises through its
mean level, the crossing being interpolated linearly; parts before the first and after the last crossing are left out.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numba import njit
from numpy.typing import ArrayLike, NDArray

from moyai.core.errors import InputError

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Cycles:
    """Cycles of a series between zero-up-crossings.

    Parameters
    ----------
    start : ndarray
        Time of the up-crossing that opens each cycle [s].
    period : ndarray
        Duration [s].
    height : ndarray
        Highest minus lowest value [unit of the series].
    crest, trough : ndarray
        Highest and lowest value above the mean level.
    mean_level : float
        Level that was crossed.
    """

    start: Array
    period: Array
    height: Array
    crest: Array
    trough: Array
    mean_level: float

    def __len__(self) -> int:
        return int(self.height.size)

    def significant_height(self) -> float:
        """Return the mean height of the highest third (NaN where there is no cycle)."""
        return significant(self.height)

    def significant_period(self) -> float:
        """Return the mean period of the cycles with the highest third of heights [s]."""
        if len(self) == 0:
            return math.nan
        number = _share(len(self), 1.0 / 3.0)
        return float(np.mean(self.period[np.argsort(-self.height, kind="stable")[:number]]))


@njit(cache=True, error_model="numpy")
def zero_crossing_kernel(values: Array, times: Array, parabolic: bool, out: Array) -> int:
    """Fill ``out[:, cycle]`` with start, period, crest, trough of every cycle; return the number of cycles.

    ``values`` have their mean level removed. ``parabolic`` refines crests and troughs by a parabola through the
    extreme sample and its neighbours (uniform steps).
    """
    count = 0
    open_cycle = False
    start = crest = trough = 0.0
    for i in range(1, values.size):
        before, now = values[i - 1], values[i]
        if open_cycle:
            value = before
            # a cycle is open only after two samples, so values[i - 2] exists
            if parabolic:
                left, right = values[i - 2], now
                if (before >= left and before > right) or (before <= left and before < right):
                    bend = left - 2.0 * before + right
                    if bend != 0.0:
                        value = before - (right - left) ** 2 / (8.0 * bend)
            crest, trough = max(crest, value), min(trough, value)
        if before < 0.0 <= now:
            crossing = times[i - 1] + (times[i] - times[i - 1]) * (-before / (now - before))
            if open_cycle:
                out[0, count], out[1, count] = start, crossing - start
                out[2, count], out[3, count] = crest, trough
                count += 1
            open_cycle = True
            start, crest, trough = crossing, 0.0, 0.0
    return count


def zero_crossing(
    time: ArrayLike, values: ArrayLike, *, mean_level: float | None = None, parabolic: bool = False
) -> Cycles:
    """Split a series into cycles by zero-up-crossing.

    Parameters
    ----------
    time : array_like
        Times [s], increasing (uniform for ``parabolic``).
    values : array_like
        The series.
    mean_level : float, optional
        Level whose crossings count; by default the mean of the series.
    parabolic : bool
        Refine crests and troughs by a parabola through three samples.

    Returns
    -------
    Cycles
        Start, period, height, crest and trough of every cycle, arrays (n,).

    Raises
    ------
    InputError
        When lengths differ, times do not increase, or a value is NaN.

    Examples
    --------
    >>> import numpy as np
    >>> from moyai.sea import zero_crossing
    >>> time = np.arange(0.0, 30.0, 0.01)
    >>> waves = zero_crossing(time, 0.5 * np.sin(2.0 * np.pi * (time - 1.0) / 5.0), mean_level=0.0)
    >>> waves.height.round(3).tolist(), waves.period.round(3).tolist()
    ([1.0, 1.0, 1.0, 1.0, 1.0], [5.0, 5.0, 5.0, 5.0, 5.0])
    """
    t = np.ascontiguousarray(time, dtype=np.float64)
    v = np.ascontiguousarray(values, dtype=np.float64)
    if t.ndim != 1 or t.shape != v.shape or t.size < 2:
        raise InputError(
            f"series of shape {v.shape} over times of shape {t.shape}", path="values", allowed="equal, 1-D"
        )
    for name, array in (("time", t), ("values", v)):
        if not np.isfinite(array).all():
            place = int(np.argmin(np.isfinite(array)))
            raise InputError(f"{name}[{place}] is not a number", path=name, remedy="fill or cut gaps before")
    if (np.diff(t) <= 0.0).any():
        raise InputError("times do not increase", path="time", allowed="strictly increasing")
    level = float(np.mean(v)) if mean_level is None else float(mean_level)
    out = np.empty((4, t.size))
    count = zero_crossing_kernel(v - level, t, parabolic, out)
    start, period, crest, trough = (out[row, :count].copy() for row in range(4))
    return Cycles(start, period, crest - trough, crest, trough, level)


def _share(count: int, fraction: float) -> int:
    """Return how many of ``count`` values make up ``fraction``: rounded to the nearest, at least one."""
    return max(1, math.floor(count * fraction + 0.5))


def significant(values: ArrayLike, fraction: float = 1.0 / 3.0) -> float:
    """Return the mean of the highest ``fraction`` of the values, 1/3 for the significant value.

    The number of values is rounded to the nearest whole number, at least one. NaN for no values.
    """
    if not 0.0 < fraction <= 1.0:
        raise InputError(f"fraction is {fraction:g}", path="fraction", allowed="greater than 0, at most 1")
    array = np.sort(np.asarray(values, dtype=np.float64).reshape(-1))[::-1]
    if array.size == 0:
        return math.nan
    return float(np.mean(array[: _share(array.size, fraction)]))


def exceedance(values: ArrayLike) -> tuple[Array, Array]:
    """Return sorted values (largest first) and their exceedance probabilities i / (N + 1)."""
    array = np.sort(np.asarray(values, dtype=np.float64).reshape(-1))[::-1]
    return array, np.arange(1, array.size + 1) / (array.size + 1.0)


def rayleigh_exceedance(values: ArrayLike, significant_value: float) -> Array:
    """Return exp(-(value / rms)^2) for Rayleigh-distributed heights of given significant value [eq:sea-rayleigh]."""
    rms = significant_value / rayleigh_significant(1.0 / 3.0)
    return np.asarray(np.exp(-((np.asarray(values, dtype=np.float64) / rms) ** 2)))


def rayleigh_significant(fraction: float) -> float:
    """Return the mean of the highest ``fraction`` of Rayleigh heights over their root mean square [-].

    sqrt(ln 1/p) + sqrt(pi)/(2p) erfc(sqrt(ln 1/p)); 1.41573 for p = 1/3 [eq:sea-rayleigh].
    """
    if not 0.0 < fraction <= 1.0:
        raise InputError(f"fraction is {fraction:g}", path="fraction", allowed="greater than 0, at most 1")
    root = math.sqrt(-math.log(fraction))
    return root + 0.5 * math.sqrt(math.pi) / fraction * math.erfc(root)


def rayleigh_expected_maximum(count: int) -> float:
    """Return the expected largest of ``count`` independent Rayleigh heights over their significant value [-].

    The integral of 1 - (1 - exp(-x^2))^N over x by Gauss panels; 1.5974, 1.7030, 1.9259 for N = 100, 200, 1000
    [eq:sea-rayleigh].
    """
    if count < 1:
        raise InputError(f"count is {count}", path="count", allowed="at least 1")
    points, weights = np.polynomial.legendre.leggauss(20)
    edges = np.linspace(0.0, math.sqrt(math.log(count) + 45.0), 60)
    half = 0.5 * np.diff(edges)
    x = (0.5 * (edges[1:] + edges[:-1]))[:, None] + half[:, None] * points
    integrand = -np.expm1(count * np.log1p(-np.exp(-x * x)))
    return float(np.sum(half * (integrand @ weights))) / rayleigh_significant(1.0 / 3.0)


def rayleigh_maximum_quantile(count: int, probability: float) -> float:
    """Return the height over the significant value that the largest of ``count`` waves stays below [-].

    ``probability`` (between 0 and 1) is that of staying below: sqrt(-ln(1 - P^(1/N))) / 1.41573.
    """
    if count < 1 or not 0.0 < probability < 1.0:
        raise InputError(f"count {count}, probability {probability:g}", path="probability", allowed="between 0 and 1")
    single = -math.expm1(math.log(probability) / count)
    return math.sqrt(-math.log(single)) / rayleigh_significant(1.0 / 3.0)
