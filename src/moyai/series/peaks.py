"""Peaks of a response, those of snaps distinguished from the others, and the maximum of peaks of several kinds.

Theory in docs/theory/extremes.md.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from moyai.core.arrays import Array
from moyai.core.curves import crossing
from moyai.core.errors import ConvergenceError, InputError
from moyai.series.extremes import ExtremeFit, refit
from moyai.series.intervals import Interval, reflected_interval
from moyai.series.zero_crossing import split_waves

SLACK_SHARE = 0.1
"""Share of the mean tension below which a line counts as slack: lifting slings are kept above a tenth of their static
tension so that no snap follows (DNV-RP-N103)."""


def peaks_of(series: ArrayLike, *, slack_share: float = SLACK_SHARE) -> tuple[Array, NDArray[np.bool_]]:
    """Return the largest value between successive up-crossings of the mean, and which of them follow on slack.

    Parameters
    ----------
    series : array_like (n,)
        Of any unit.
    slack_share : float
        A peak is that of a snap when the series fell below this share of its mean since the peak before.

    Returns
    -------
    peaks : ndarray (k,)
        In the order of time.
    after_slack : ndarray of bool (k,)

    Raises
    ------
    InputError
        For NaN or infinite values.
    """
    x = np.asarray(series, dtype=float).ravel()
    if not np.isfinite(x).all():
        raise InputError("the series holds NaN or infinity", parameter="series")
    nothing = np.empty(0), np.empty(0, dtype=bool)
    if x.size < 3:
        return nothing
    mean = float(np.mean(x))
    waves = split_waves(np.arange(x.size, dtype=float), x, mean_level=mean)
    if not len(waves):
        return nothing
    # The trough that a peak rises from lies in the wave before it; before the first wave, in what goes before it
    before = float(x[: math.ceil(waves.start[0])].min())
    troughs = np.concatenate([[before], mean + waves.trough[:-1]])
    return mean + waves.crest, troughs < slack_share * mean


@dataclass(frozen=True)
class PeakKind:
    """Peaks of one kind."""

    #: Distribution of those above its location.
    fitted: ExtremeFit
    #: How many of them come in the time that the maximum is meant for.
    count: float


def maximum_of_kinds(kinds: Sequence[PeakKind], probability: float) -> float:
    """Return the level that the maximum of peaks of several kinds stays below with ``probability``.

    Parameters
    ----------
    kinds : sequence of Kind
    probability : float

    Returns
    -------
    float
        Of the unit of the peaks [eq:extremes-kinds].

    Raises
    ------
    InputError
        For a probability out of range, or so few peaks that there may be none above the locations.
    """
    if not 0.0 < probability < 1.0:
        raise InputError("a probability lies between 0 and 1", parameter="probability")
    wanted = -math.log(probability)

    def excess(level: float) -> float:
        total = 0.0
        for one in kinds:
            exceeds = min(float(one.fitted.exceedance(level)), 1.0 - 1e-16)
            total -= one.count * math.log1p(-exceeds)
        return math.log(max(total, 1e-300) / wanted)

    return _falling_root(excess, kinds)


def most_probable_of_kinds(kinds: Sequence[PeakKind]) -> float:
    """Return the level that one peak exceeds on the average, of all kinds together."""

    def excess(level: float) -> float:
        total = sum(one.count * float(one.fitted.exceedance(level)) for one in kinds)
        return math.log(max(total, 1e-300))

    return _falling_root(excess, kinds)


def _falling_root(excess: object, kinds: Sequence[PeakKind]) -> float:
    assert callable(excess)
    low = min(one.fitted.location if one.fitted.threshold is None else one.fitted.threshold for one in kinds)
    step = max(one.fitted.scale for one in kinds)
    if excess(low) <= 0.0:
        raise InputError(
            "there are too few peaks for a maximum", parameter="times", remedy="give a longer time or a larger share"
        )
    high = low + step
    for _ in range(200):
        if excess(high) < 0.0:
            return crossing(excess, low, high, tolerance=1e-13 * max(abs(low), abs(high)))
        low, high = high, high + 2.0 * (high - low)
    raise ConvergenceError("the level of the maximum lies beyond any bound", parameter="peaks")


def interval_of_kinds(
    kinds: Sequence[PeakKind], probability: float, *, seed: int, confidence: float = 0.9, repetitions: int = 200
) -> Interval:
    """Return :func:`maximum_of_kinds` with its confidence interval.

    Parameters
    ----------
    kinds : sequence of Kind
    probability : float
    seed : int
        Of the parametric bootstrap: as many peaks of every kind are drawn as were fitted, as if independent of each
        other. Peaks that come in groups count less; average conditional exceedance counts groups.
    confidence : float
    repetitions : int
    """
    value = maximum_of_kinds(kinds, probability)
    base = min(one.fitted.location for one in kinds)
    generator = np.random.default_rng(seed)
    found = []
    for _ in range(repetitions):
        again = []
        try:
            for one in kinds:
                drawn = one.fitted.sample(one.fitted.count, generator)
                again.append(PeakKind(refit(one.fitted, drawn), one.count))
            found.append(maximum_of_kinds(again, probability))
        except (InputError, ConvergenceError):
            continue
    if len(found) < repetitions // 2:
        return Interval(value, math.nan, math.nan, confidence)
    return reflected_interval(value, found, confidence, base=base)
