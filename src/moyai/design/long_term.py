"""From short seas to the long term: return levels over a scatter diagram, and environmental contours.

Theory in docs/theory/extremes.md.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike
from scipy.optimize import brentq, curve_fit
from scipy.special import ndtr, ndtri

from moyai.core.arrays import Array
from moyai.core.errors import InputError
from moyai.series.extremes import ExtremeFit, fit

YEAR = 365.25 * 86400.0
"""Seconds of a year."""


def long_term_exceedance(
    level: ArrayLike, probability: ArrayLike, short_term: Sequence[Callable[[Array], Array]], duration: float
) -> Array:
    """Return how often a year the maximum of a sea state exceeds a level.

    Parameters
    ----------
    level : array_like
        Of the unit of the response.
    probability : array_like (n,)
        Share of the time of each sea state; sums to one.
    short_term : sequence of callable
        Probability that the maximum of each sea state exceeds a level.
    duration : float
        Of a sea state [s].

    Returns
    -------
    ndarray
        Sea states a year whose maximum exceeds the level [eq:extremes-long-term].

    Raises
    ------
    InputError
        When the probabilities do not sum to one.
    """
    share = np.asarray(probability, dtype=float)
    if abs(share.sum() - 1.0) > 1e-3 or np.any(share < 0.0):
        raise InputError(f"the probabilities sum to {share.sum():.6g}, not to 1", parameter="probability")
    if share.size != len(short_term):
        raise InputError(f"{share.size} probabilities for {len(short_term)} sea states", parameter="probability")
    levels = np.atleast_1d(np.asarray(level, dtype=float))
    rate = np.zeros_like(levels)
    for weight, exceeds in zip(share, short_term):
        # ln of the survival of every sea state, added up: independent sea states of a year
        rate += weight * -np.log1p(-np.clip(np.asarray(exceeds(levels), dtype=float), 0.0, 1.0 - 1e-16))
    return rate * YEAR / duration


def return_level(
    years: float,
    probability: ArrayLike,
    short_term: Sequence[Callable[[Array], Array]],
    duration: float,
    bracket: tuple[float, float],
) -> float:
    """Return the level of a mean return period [eq:extremes-long-term].

    Parameters
    ----------
    years : float
        Mean return period [years].
    probability : array_like (n,)
        Share of the time of every sea state; sums to one.
    short_term : sequence of callable
        Of every sea state, the probability that the maximum within it exceeds a level.
    duration : float
        Of a sea state [s].
    bracket : tuple of float
        Levels between which it lies.

    Returns
    -------
    float
        In the unit of the levels.

    Raises
    ------
    InputError
        For years that are not positive, probabilities that do not sum to one, and a bracket that does not hold the
        level.

    Examples
    --------
    >>> import numpy as np
    >>> from moyai.design import return_level
    >>> calm, storm = (lambda level, scale=scale: -np.expm1(-np.exp(5.0 - level / scale)) for scale in (10.0, 20.0))
    >>> round(return_level(50.0, [0.99, 0.01], [calm, storm], duration=10800.0, bracket=(50.0, 1000.0)))   # [kN]
    246
    """
    if not years > 0.0:
        raise InputError(f"a return period of {years:g} years", parameter="years", allowed="above 0")

    def residual(level: float) -> float:
        rate = long_term_exceedance(level, probability, short_term, duration)[0]
        return math.log(max(rate, 1e-300) * years)

    low, high = residual(bracket[0]), residual(bracket[1])
    if low < 0.0 or high > 0.0:
        raise InputError(
            f"the level of {years:g} years is not between {bracket[0]:g} and {bracket[1]:g}",
            parameter="bracket",
            remedy="widen it",
        )
    return float(brentq(residual, *bracket, xtol=1e-12 * abs(bracket[1]), rtol=1e-12))


@dataclass(frozen=True)
class JointSea:
    """Joint distribution of significant height and period: Weibull, and lognormal given the height.

    Notes
    -----
    The conditional model of DNV-RP-C205 [eq:extremes-joint].
    """

    #: Weibull of the significant height [m].
    height: ExtremeFit
    #: ``a0 + a1 h^a2``, mean of the logarithm of the period.
    mean_log: tuple[float, float, float]
    #: ``b0 + b1 exp(b2 h)``, standard deviation of the logarithm of the period.
    deviation_log: tuple[float, float, float]

    def period(self, height: ArrayLike, normal: ArrayLike) -> Array:
        """Return the period [s] at a height whose conditional quantile is that of a standard normal value.

        Parameters
        ----------
        height : array_like (...)
            Significant wave height [m].
        normal : array_like (...)
            Standard normal value [-].
        """
        h = np.asarray(height, dtype=float)
        a0, a1, a2 = self.mean_log
        b0, b1, b2 = self.deviation_log
        mean = a0 + a1 * h**a2
        deviation = b0 + b1 * np.exp(b2 * h)
        return np.asarray(np.exp(mean + deviation * np.asarray(normal, dtype=float)))


def environmental_contour(sea: JointSea, years: float, duration: float, count: int = 180) -> tuple[Array, Array]:
    """Return the contour of significant height and period of a return period [eq:extremes-contour].

    Parameters
    ----------
    sea : JointSea
        From :func:`fit_joint_sea`.
    years : float
        Return period [years].
    duration : float
        Of a sea state [s].
    count : int
        Points of the contour.

    Returns
    -------
    significant_height, period : ndarray (count,)
        [m], [s]; closed when the first point is appended.

    Raises
    ------
    InputError
        For times that are not positive, and a return period of two sea states or less.

    References
    ----------
    S. R. Winterstein and others (1993), Environmental parameters for extreme response: inverse FORM with omission
    factors, ICOSSAR, Innsbruck.

    Examples
    --------
    >>> import numpy as np
    >>> from moyai.design import environmental_contour, fit_joint_sea
    >>> generator = np.random.default_rng(1)
    >>> height = 0.5 + generator.weibull(1.5, 5000)
    >>> period = np.exp(1.5 + 0.3 * np.sqrt(height) + 0.1 * generator.normal(size=5000))
    >>> sea = fit_joint_sea(height, period, lower_end=0.5)
    >>> heights, periods = environmental_contour(sea, years=50.0, duration=3600.0)
    >>> heights.shape, bool(height.max() < heights.max() < 8.0)          # [m]
    ((180,), True)
    """
    beta = reliability_index(years, duration)
    angle = np.linspace(0.0, 2.0 * math.pi, count, endpoint=False)
    first, second = beta * np.cos(angle), beta * np.sin(angle)
    exceeds = np.clip(ndtr(-first), 1e-300, 1.0 - 1e-16)
    height = sea.height.level(exceeds)
    return height, sea.period(height, second)


def reliability_index(years: float, duration: float) -> float:
    """Return the distance from the origin of the standard normal space that is exceeded once in ``years``."""
    if not years > 0.0 or not duration > 0.0:
        raise InputError("return period and duration are above zero", parameter="years")
    states = years * YEAR / duration
    if states <= 2.0:
        raise InputError(
            f"{years:g} years hold only {states:.2g} sea states", parameter="years", allowed="more than two sea states"
        )
    return float(-ndtri(1.0 / states))


def fit_joint_sea(significant_height: ArrayLike, period: ArrayLike, *, lower_end: float, classes: int = 12) -> JointSea:
    """Fit the joint distribution to pairs of significant height and period [eq:extremes-joint].

    Parameters
    ----------
    significant_height, period : array_like (n,)
        [m], [s]; for instance hourly values of years.
    lower_end : float
        Smallest significant height of the Weibull distribution [m].
    classes : int
        Classes of equal number by height, within which the period's mean and deviation are found.

    Returns
    -------
    JointSea
        Weibull distribution of the height [m] and lognormal one of the period [s] that depends on it.

    Raises
    ------
    InputError
        For fewer than 30 values a class, or periods that are not positive.

    Examples
    --------
    >>> import numpy as np
    >>> from moyai.design import fit_joint_sea
    >>> generator = np.random.default_rng(1)
    >>> height = 0.5 + generator.weibull(1.5, 5000)
    >>> period = np.exp(1.5 + 0.3 * np.sqrt(height) + 0.1 * generator.normal(size=5000))
    >>> sea = fit_joint_sea(height, period, lower_end=0.5)
    >>> median = float(sea.period(np.array([1.0]), np.array([0.0]))[0])
    >>> bool(abs(median / np.exp(1.8) - 1.0) < 0.02)                     # of the periods at a height of 1 m
    True
    """
    height, value = (np.asarray(one, dtype=float).ravel() for one in (significant_height, period))
    if height.size != value.size or height.size < 30 * classes:
        raise InputError(
            f"{height.size} heights and {value.size} periods",
            parameter="period",
            allowed=f"at least {30 * classes} pairs",
        )
    if np.any(value <= 0.0):
        raise InputError("a period is not above zero", parameter="period")
    order = np.argsort(height)
    groups = np.array_split(order, classes)
    middle = np.array([height[group].mean() for group in groups])
    logs = [np.log(value[group]) for group in groups]
    mean, deviation = np.array([log.mean() for log in logs]), np.array([log.std(ddof=1) for log in logs])

    def mean_of(h: Array, a0: float, a1: float, a2: float) -> Array:
        return np.asarray(a0 + a1 * h**a2)

    def deviation_of(h: Array, b0: float, b1: float, b2: float) -> Array:
        return np.asarray(b0 + b1 * np.exp(b2 * h))

    a, _ = curve_fit(
        mean_of, middle, mean, p0=[mean[0], mean[-1] - mean[0], 0.5], maxfev=20000,
        bounds=([-5.0, -5.0, 0.05], [10.0, 10.0, 3.0]),
    )  # fmt: skip
    b, _ = curve_fit(
        deviation_of, middle, deviation, p0=[deviation.min(), np.ptp(deviation) + 1e-3, -0.5], maxfev=20000,
        bounds=([0.0, 0.0, -5.0], [2.0, 2.0, 0.0]),
    )  # fmt: skip
    return JointSea(fit(height, "weibull", location=lower_end), tuple(map(float, a)), tuple(map(float, b)))  # type: ignore[arg-type]
