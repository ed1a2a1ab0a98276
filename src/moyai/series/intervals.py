"""Confidence intervals: of draws from a fitted distribution, and by Student's distribution."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from moyai.core.errors import InputError

#: ``GUMBEL_SKEWNESS``, ``GUMBEL_KURTOSIS``: Of Gumbel's law.
GUMBEL_SKEWNESS, GUMBEL_KURTOSIS = 1.1395, 5.4


@dataclass(frozen=True)
class Interval:
    """An estimate with its confidence interval."""

    #: Estimate, in the unit of the data.
    value: float
    #: Lower end of its interval.
    lower: float
    #: Upper end of its interval.
    upper: float
    #: Probability that the interval covers.
    confidence: float


def reflected_interval(value: float, drawn: ArrayLike, confidence: float, *, base: float | None = None) -> Interval:
    """Return the basic bootstrap interval: draws reflected at the estimate, which takes their bias off, not doubles it.

    Parameters
    ----------
    value : float
        The estimate.
    drawn : array_like
        Estimates from samples that were drawn from what was fitted.
    confidence : float
    base : float, optional
        Lower end of the values: the logarithmic distance from it is reflected, so that the interval never falls below
        it. The values themselves are reflected when absent, or where estimate or draws do not lie above it.
    """
    found, tail = np.asarray(drawn, dtype=float), 50.0 * (1.0 - confidence)
    low, high = (float(bound) for bound in np.percentile(found, [tail, 100.0 - tail]))
    if base is None or value <= base or low <= base:
        return Interval(value, 2.0 * value - high, 2.0 * value - low, confidence)
    reach = value - base
    distance = np.log(np.maximum(found - base, 1e-300) / reach)
    low, high = (float(bound) for bound in np.percentile(distance, [tail, 100.0 - tail]))
    return Interval(value, base + reach * math.exp(-high), base + reach * math.exp(-low), confidence)


def student_quantile(confidence: float, freedom: float) -> float:
    """Return the half width of a two-sided interval over the standard error, by Student's distribution.

    Parameters
    ----------
    confidence : float
        Between 0 and 1; for a one-sided bound at probability ``p`` give ``2 p - 1``.
    freedom : float
        Degrees of freedom; fewer than one count as one.

    Raises
    ------
    InputError
        For a confidence out of range.
    """
    from scipy.special import stdtrit

    if not 0.0 < confidence < 1.0:
        raise InputError(f"confidence is {confidence:g}", parameter="confidence", allowed="between 0 and 1")
    return float(stdtrit(max(freedom, 1.0), 0.5 + 0.5 * confidence))


def reach_of_mean(values: ArrayLike, probability: float = 0.95, *, alike: ArrayLike = ()) -> float:
    """Return how far the one-sided interval of a mean of largest values reaches above it [eq:extremes-mean-reach].

    Student's interval covers the mean of five largest values in 90 of 100 draws, since they are skewed; with the term
    of Johnson (1978) for the skewness of Gumbel's law it is 95.

    Parameters
    ----------
    values : array_like
        Independent largest values; 0 is returned for fewer than two.
    probability : float
        That the mean of very many samples lies below the end of the interval.
    alike : array_like
        More values whose scatter over their mean is that of the first, such as those of another mesh: the larger of
        both scatters counts, known as well as the larger sample gives.

    Raises
    ------
    InputError
        For a probability of one half or less, or of one.
    """
    found, others = np.asarray(values, dtype=np.float64), np.asarray(alike, dtype=np.float64)
    if found.size < 2:
        return 0.0
    scatter, freedom = float(np.std(found, ddof=1)), found.size - 1
    if others.size > found.size and others.mean() != 0.0:
        scatter = max(scatter, abs(float(np.std(others, ddof=1) * found.mean() / others.mean())))
        freedom = others.size - 1
    error = scatter / math.sqrt(found.size)
    quantile = student_quantile(2.0 * probability - 1.0, freedom)
    return (quantile + GUMBEL_SKEWNESS / (6.0 * math.sqrt(found.size)) * (1.0 + 2.0 * quantile**2)) * error


def scatter_of_end(values: ArrayLike, probability: float = 0.95) -> float:
    """Return the standard deviation, over sets of such values, of their mean with :func:`reach_of_mean` on top.

    Mean and deviation of values by Gumbel's law vary together, as in [eq:extremes-range-of-records]. With five values
    it is about the deviation of a single one.

    Parameters
    ----------
    values : array_like
        Independent largest values; 0 is returned for fewer than two.
    probability : float
        Of the interval of the mean.
    """
    found = np.asarray(values, dtype=np.float64)
    deviation = float(np.std(found, ddof=1)) if found.size > 1 else 0.0
    if not deviation > 0.0:
        return 0.0
    reach = reach_of_mean(found, probability) / deviation
    return deviation * math.sqrt(deviations_along(reach, found.size))


def deviations_along(reach: float, count: int) -> float:
    """Return the variance, over that of one value, of the mean of values by Gumbel's law plus ``reach`` deviations."""
    return (1.0 + GUMBEL_SKEWNESS * reach + 0.25 * (GUMBEL_KURTOSIS - 1.0) * reach**2) / count
