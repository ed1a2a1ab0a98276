"""Average conditional exceedance rates: extremes of correlated peaks without assuming a distribution.

Naess and Gaidai (2009); theory in docs/theory/extremes.md.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from moyai.core.arrays import Array
from moyai.core.errors import InputError
from moyai.series.intervals import Interval


@dataclass(frozen=True)
class ExceedanceRates:
    """Rates at which peaks exceed levels, given that the peaks before did not."""

    #: Of the unit of the peaks; shape (m,).
    level: Array
    #: Average conditional exceedance rate, per peak; shape (m,).
    rate: Array
    #: Standard deviation of the rate: between realisations where there are five and more, never below the binomial one;
    #: shape (m,).
    deviation: Array
    #: Number of peaks that the condition spans, the one itself counted.
    order: int
    #: Number of peaks.
    count: int


@dataclass(frozen=True)
class AcerFit:
    """The tail ``q exp(-a (level - b)^c)`` fitted to rates."""

    q: float
    a: float
    b: float
    c: float
    #: Level above which it was fitted.
    tail_from: float
    rates: ExceedanceRates

    def rate(self, level: ArrayLike) -> Array:
        """Return the rate of a level, per peak [eq:extremes-acer-tail].

        Parameters
        ----------
        level : array_like (...)
            In the unit of the data.
        """
        excess = np.maximum(np.asarray(level, dtype=float) - self.b, 0.0)
        return np.asarray(self.q * np.exp(-self.a * excess**self.c))

    def maximum_level(self, count: float, probability: float) -> float:
        """Return the level that the maximum of ``count`` peaks stays below with ``probability``.

        Parameters
        ----------
        count : float
            Number of peaks.
        probability : float
            Between 0 and 1 [-].

        Returns
        -------
        float
            In the unit of the data.

        Raises
        ------
        InputError
            When the level is outside the fitted tail.
        """
        wanted = -math.log(probability) / count
        return _level_of(self, wanted)

    def most_probable_maximum(self, count: float) -> float:
        """Return the level whose rate is one in ``count`` peaks.

        Parameters
        ----------
        count : float
            Number of peaks.

        Returns
        -------
        float
            In the unit of the data.

        Raises
        ------
        InputError
            When the level is outside the fitted tail.
        """
        return _level_of(self, 1.0 / count)


def _level_of(tail: AcerFit, rate: float) -> float:
    if not 0.0 < rate < tail.q:
        raise InputError(
            "the number of peaks is too small for the tail", parameter="count", remedy="choose a rarer level"
        )
    return float(tail.b + (math.log(tail.q / rate) / tail.a) ** (1.0 / tail.c))


def exceedance_rates(realisations: list[ArrayLike], *, order: int, levels: int = 60) -> ExceedanceRates:
    """Return the average conditional exceedance rates of peaks [eq:extremes-acer].

    Parameters
    ----------
    realisations : list of array_like
        The peaks of each realisation (seed), in the order of time; any unit.
    order : int
        1 counts every exceedance; 2 only those whose peak before did not exceed; higher orders span more.
    levels : int
        Number of levels from the median to the largest peak.

    Returns
    -------
    ExceedanceRates
        Levels, rates and their deviations [eq:extremes-acer-error], shape (levels,).

    Raises
    ------
    InputError
        For fewer than 20 peaks or an order below 1.

    Examples
    --------
    >>> import numpy as np
    >>> from moyai.series import exceedance_rates
    >>> generator = np.random.default_rng(1)
    >>> rates = exceedance_rates([generator.rayleigh(100.0, 2000) for _ in range(5)], order=2)
    >>> rates.level.shape, rates.count
    ((60,), 10000)
    >>> bool(0.4 < rates.rate[0] < 0.6)                                  # at the median
    True
    """
    series = [np.asarray(one, dtype=float).ravel() for one in realisations]
    if order < 1:
        raise InputError(f"the order {order} spans no peak", parameter="order", allowed="1 or more")
    total = sum(one.size for one in series)
    if total < 20 or not all(np.isfinite(one).all() for one in series):
        raise InputError(
            f"{total} peaks are too few, or not all are finite", parameter="realisations", allowed="at least 20"
        )
    everything = np.concatenate(series)
    level = np.linspace(np.median(everything), np.max(everything), levels, endpoint=False)
    each, all_chances = [], np.zeros(levels)
    for one in series:
        above = one[None, :] > level[:, None]
        quiet = np.ones_like(above)
        for back in range(1, order):
            shifted = np.zeros_like(above)
            shifted[:, back:] = above[:, :-back]
            quiet &= ~shifted
        used = slice(order - 1, None)
        events, chances = (above & quiet)[:, used].sum(axis=1), quiet[:, used].sum(axis=1)
        each.append(events / np.maximum(chances, 1))
        all_chances += chances
    weight = np.array([one.size for one in series], dtype=float)
    table = np.array(each)
    rate = np.average(table, axis=0, weights=weight)
    # few realisations may have equal counts at a level by chance: that does not make it known without error
    deviation = np.sqrt(rate * (1.0 - rate) / np.maximum(all_chances, 1.0))
    if len(series) >= 5:
        scatter = np.average((table - rate) ** 2, axis=0, weights=weight) / (len(series) - 1)
        deviation = np.maximum(deviation, np.sqrt(scatter))
    return ExceedanceRates(level, rate, deviation, order, total)


def fit_tail(rates: ExceedanceRates, *, tail_from: float | None = None) -> AcerFit:
    """Fit the tail of exceedance rates by weighted least squares of their logarithm [eq:extremes-acer-tail].

    Parameters
    ----------
    rates : ExceedanceRates
        From :func:`exceedance_rates`.
    tail_from : float, optional
        Level above which the rates are fitted; where a tenth of the peaks exceed when absent.

    Returns
    -------
    AcerFit
        The tail and its levels, in the unit of the peaks.

    Raises
    ------
    InputError
        When fewer than six levels are left.

    Examples
    --------
    >>> import numpy as np
    >>> from moyai.series import exceedance_rates, fit_tail
    >>> generator = np.random.default_rng(1)
    >>> rates = exceedance_rates([generator.rayleigh(100.0, 2000) for _ in range(5)], order=1)
    >>> tail = fit_tail(rates)
    >>> exact = 100.0 * np.sqrt(2.0 * np.log(2000.0))                    # most probable largest of 2000 peaks
    >>> bool(abs(tail.most_probable_maximum(2000.0) / exact - 1.0) < 0.1)
    True
    """
    start = tail_from
    if start is None:
        below = np.flatnonzero(rates.rate < 0.1)
        start = float(rates.level[below[0]]) if below.size else float(rates.level[0])
    return _fit(rates, rates.rate, start)


def _fit(rates: ExceedanceRates, rate: Array, start: float) -> AcerFit:
    # Levels whose scatter is as large as their rate say nothing
    known = (rates.deviation > 0.0) & (rates.deviation < 0.7 * rates.rate)
    used = (rates.level >= start) & (rate > 0.0) & known
    if used.sum() < 6:
        raise InputError(
            "too few levels are left for the tail",
            parameter="tail_from",
            remedy="lower it, or run more seeds",
        )
    level, log = rates.level[used], np.log(rate[used])
    weight = rates.rate[used] / rates.deviation[used]
    weight = weight / weight.max()
    spread = float(np.ptp(level)) or 1.0

    def linear(b: float, c: float) -> tuple[float, float, Array]:
        basis = ((level - b) / spread) ** c
        mean_x, mean_y = np.average(basis, weights=weight**2), np.average(log, weights=weight**2)
        centred = basis - mean_x
        slope = -float(np.sum(weight**2 * centred * (log - mean_y)) / np.sum(weight**2 * centred**2))
        slope = max(slope, 1e-6)
        offset = float(mean_y + slope * mean_x)
        return offset, slope, weight * (log - offset + slope * basis)

    def residual(free: Array) -> Array:
        return linear(level[0] - spread * math.exp(free[0]), math.exp(free[1]))[2]

    from scipy.optimize import least_squares

    best = min(
        (
            least_squares(residual, [first, second], bounds=([-12.0, -0.7], [2.5, 1.6]))
            for first in (-6.0, -1.0, 1.0)
            for second in (0.0, 0.6)
        ),
        key=lambda one: one.cost,
    )
    b, c = level[0] - spread * math.exp(best.x[0]), math.exp(best.x[1])
    offset, slope, _ = linear(b, c)
    return AcerFit(math.exp(offset), slope / spread**c, float(b), c, start, rates)


def acer_interval(tail: AcerFit, count: float, probability: float, *, confidence: float = 0.9) -> Interval:
    """Return the level of :meth:`AcerFit.maximum_level` with its confidence interval [eq:extremes-acer-tail].

    The tail is fitted again to the lower and upper bounds of the rates, as Naess and Gaidai propose.

    Parameters
    ----------
    tail : AcerFit
        From :func:`fit_tail`.
    count : float
        Number of peaks whose maximum is meant.
    probability : float
        With which the maximum stays below the level, between 0 and 1.
    confidence : float
        Of the interval.

    Returns
    -------
    Interval
        Level with its lower and upper bound, in the unit of the peaks.

    Raises
    ------
    InputError
        When the number of peaks is too small for the tail, or too few levels are left to fit it again.

    References
    ----------
    A. Naess and O. Gaidai (2009), Estimation of extreme values from sampled time series, Structural Safety 31, 325-334.

    Examples
    --------
    >>> import numpy as np
    >>> from moyai.series import acer_interval, exceedance_rates, fit_tail
    >>> generator = np.random.default_rng(1)
    >>> peaks = [generator.rayleigh(100.0, 2000) for _ in range(5)]      # five records, tension peaks [kN]
    >>> found = acer_interval(fit_tail(exceedance_rates(peaks, order=1)), count=2000.0, probability=0.5)
    >>> bool(found.lower < found.value < found.upper)
    True
    >>> exact = 100.0 * np.sqrt(2.0 * np.log(2000.0 / np.log(2.0)))      # median of the largest of 2000
    >>> bool(abs(found.value / exact - 1.0) < 0.1)
    True
    """
    from scipy.special import ndtri

    value = tail.maximum_level(count, probability)
    reach = float(ndtri(0.5 + confidence / 2.0)) * tail.rates.deviation
    bounds = []
    for sign in (-1.0, 1.0):
        shifted = np.maximum(tail.rates.rate + sign * reach, 0.05 * tail.rates.rate)
        bounds.append(_fit(tail.rates, shifted, tail.tail_from).maximum_level(count, probability))
    return Interval(value, min(*bounds, value), max(*bounds, value), confidence)


__all__ = ["AcerFit", "ExceedanceRates", "acer_interval", "exceedance_rates", "fit_tail"]
