"""Mooring tensions next to waves: steady and fluctuating part, one maximum for every wave, their statistics.

Steps of the chain of Tabata et al.; :mod:`moyai.records.survey.tension_blocks` runs it over a record. Arrays in,
numbers out.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from moyai.core.arrays import Array
from moyai.core.errors import InputError
from moyai.core.options import checks_words
from moyai.records.survey.tension_kernel import largest_of_waves
from moyai.series.detrend import slow_part
from moyai.series.wave_statistics import significant

SteadyRule = Literal["median", "mean", "low_pass"]

# A second maximum of one wave counts as a double peak above this share of the first
_DOUBLE = 0.7


@checks_words
@dataclass(frozen=True, eq=False)
class SplitTension:
    """A tension as steady plus fluctuating part."""

    #: At each sample [N]; one value throughout for ``median`` and ``mean``.
    steady: Array
    #: [N].
    fluctuating: Array
    #: How it was split; one of "median", "mean", "low_pass".
    rule: SteadyRule

    @property
    def level(self) -> float:
        """Mean of the steady part [N]."""
        return float(np.mean(self.steady))


@checks_words
def split_tension(
    time: ArrayLike, tension: ArrayLike, rule: SteadyRule = "median", *, cutoff: float = 30.0
) -> SplitTension:
    """Split a tension into steady and fluctuating part [eq:tensions-split].

    Parameters
    ----------
    time, tension : array_like
        [s], [N], of one block.
    rule : {"median", "mean", "low_pass"}
        ``mean``: of the block, as the paper; it absorbs the spikes and comes out too high by their share of the time.
        ``median``: of the block, which spikes hardly move. ``low_pass``: what varies slower than ``cutoff``, which
        follows the tide but absorbs spikes as the mean does.
    cutoff : float
        Period of response one half of ``low_pass`` [s].

    Raises
    ------
    InputError
        For another rule, gaps, or a block shorter than the cut-off.
    """
    t, values = np.asarray(time, dtype=np.float64), np.asarray(tension, dtype=np.float64)
    if t.ndim != 1 or t.shape != values.shape or t.size < 5:
        raise InputError(
            f"times {t.shape} and tensions {values.shape}", parameter="tension", allowed="equal lists, 5 or more"
        )
    if not np.isfinite(values).all():
        raise InputError("the tension has gaps", parameter="tension", remedy="cut or fill gaps before")
    if rule == "low_pass":
        steady = slow_part(t, values, cutoff)
    else:
        steady = np.full(t.size, float(np.median(values) if rule == "median" else np.mean(values)))
    return SplitTension(steady, values - steady, rule)


@dataclass(frozen=True, eq=False)
class WaveTensions:
    """Largest fluctuating tension in the time of each wave."""

    #: [N], in the order of the waves; NaN where a wave has no sample, or lacks more than a tenth of them.
    maximum: Array
    #: Top of the parabola through the largest sample and its neighbours [N]: what samples miss of a smooth pull.
    top: Array
    #: When [s].
    time: Array
    #: Whether a second, separate peak comes near the first (bounces, or two lines).
    double: NDArray[np.bool_]
    #: By which the windows were shifted against the waves [s].
    delay: float

    @property
    def matched(self) -> int:
        """Waves with a maximum."""
        return int(np.isfinite(self.maximum).sum())


def wave_maxima(
    time: ArrayLike, fluctuating: ArrayLike, start: ArrayLike, period: ArrayLike, *, delay: float = 0.0
) -> WaveTensions:
    """Find the largest tension in the time of every wave [eq:tensions-waves].

    Parameters
    ----------
    time, fluctuating : array_like
        [s], [N].
    start, period : array_like
        Opening crossing and duration of the waves [s].
    delay : float
        Of the tension behind the waves [s]: the way from gauge to float, or from :func:`find_delay`.

    Raises
    ------
    InputError
        When lists differ in length or the delay is no number.
    """
    t, values = np.asarray(time, dtype=np.float64), np.asarray(fluctuating, dtype=np.float64)
    first, last = np.asarray(start, dtype=np.float64), np.asarray(start, dtype=np.float64) + np.asarray(period)
    if t.shape != values.shape or first.shape != last.shape:
        raise InputError("lists differ in length", parameter="fluctuating", allowed="equal lengths")
    if not math.isfinite(delay):
        raise InputError(f"delay is {delay:g} s", parameter="delay", allowed="finite")
    low, high = np.searchsorted(t, first + delay), np.searchsorted(t, last + delay)
    count = first.size
    usual = float(np.median(np.diff(t))) if t.size > 1 else math.inf
    maximum, top, when = (np.full(count, np.nan) for _ in range(3))
    place, double = np.zeros(count, dtype=np.int64), np.zeros(count, dtype=bool)
    largest_of_waves(values, low, high, _DOUBLE, place, double)
    # a wave whose window is cut by the end of the record is no wave of this record
    whole = (high - low >= 2) & (last + delay <= t[-1]) & (first + delay >= t[0] - 1e-9)
    # where samples lack, the largest may be among them
    whole &= high - low >= 0.9 * (last - first) / usual - 2.0
    found = place[whole]
    maximum[whole], when[whole], top[whole] = values[found], t[found], _tops(values, found)
    double &= whole
    return WaveTensions(maximum, top, when, double, delay)


def _tops(values: Array, place: NDArray[np.int64]) -> Array:
    """Return tops of parabolas through largest samples and their neighbours; the sample where there is none."""
    middle = values[place]
    left, right = values[np.maximum(place - 1, 0)], values[np.minimum(place + 1, values.size - 1)]
    bend = left - 2.0 * middle + right
    bent = (place > 0) & (place < values.size - 1) & (bend < 0.0) & (np.maximum(left, right) <= middle)
    return np.where(bent, middle - (right - left) ** 2 / (8.0 * np.where(bent, bend, 1.0)), middle)


def find_delay(time: ArrayLike, elevation: ArrayLike, fluctuating: ArrayLike, *, longest: float) -> float:
    """Return the delay of the tension behind the waves [s] within bounds, by the largest correlation.

    Positive parts are correlated (crests against pulls), the top is refined by a parabola. A delay looks like
    one of a wave period more: keep ``longest`` below half a period, about the way that waves take from gauge to float.

    Parameters
    ----------
    time, elevation, fluctuating : array_like
        Uniform [s], [m], [N].
    longest : float
        Bound of the delay on both sides [s].

    Raises
    ------
    InputError
        When the bound is below one sample or beyond a quarter of the record, or a series does not vary.
    """
    t = np.asarray(time, dtype=np.float64)
    eta = np.asarray(elevation, dtype=np.float64)
    one = np.maximum(eta - eta.mean(), 0.0)
    two = np.maximum(np.asarray(fluctuating, dtype=np.float64), 0.0)
    step = float(t[1] - t[0])
    reach = int(longest / step + 1e-9)
    if not 1 <= reach <= t.size // 4:
        raise InputError(
            f"longest is {longest:g} s", parameter="longest", allowed=f"{step:g} to {0.25 * t.size * step:g} s"
        )
    one, two = one - one.mean(), two - two.mean()
    if not (one.any() and two.any()):
        raise InputError("a series does not vary", parameter="fluctuating", allowed="waves and tensions")
    score = np.array(
        [
            float(one[max(0, -k) : t.size - max(0, k)] @ two[max(0, k) : t.size - max(0, -k)]) / (t.size - abs(k))
            for k in range(-reach, reach + 1)
        ]
    )
    best = int(np.argmax(score))
    shift = 0.0
    if 0 < best < score.size - 1:
        a, m, c = score[best - 1 : best + 2]
        bend = a - 2.0 * m + c
        shift = 0.5 * (a - c) / bend if bend < 0.0 else 0.0
    return (best - reach + shift) * step


@dataclass(frozen=True)
class TensionStatistics:
    """Statistics of the maxima of one block."""

    #: Largest maximum [N].
    maximum: float
    #: Mean of the highest tenth [N].
    tenth: float
    #: Mean of the highest third [N].
    third: float
    #: Mean of all [N].
    mean: float
    #: Maxima.
    count: int


def tension_statistics(maxima: ArrayLike) -> TensionStatistics:
    """Return T_max, T_1/10, T_1/3, T_mean of maxima [N], ranked by themselves; NaN left out."""
    values = np.asarray(maxima, dtype=np.float64)
    values = values[np.isfinite(values)]
    if values.size == 0:
        return TensionStatistics(math.nan, math.nan, math.nan, math.nan, 0)
    return TensionStatistics(
        float(values.max()), significant(values, 0.1), significant(values), float(values.mean()), int(values.size)
    )
