"""How large snaps become: exceedance fitted above a threshold, their rate, the largest in some hours.

Peaks above a threshold come as a Poisson process; their excess follows Weibull's or the generalised Pareto law. All
intervals come from samples drawn from the fit and fitted again, the number of peaks drawn with them.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Literal, get_args

import numpy as np
from numpy.typing import ArrayLike

from moyai.core.arrays import Array
from moyai.core.errors import ConvergenceError, InputError
from moyai.core.options import checks_words
from moyai.core.validity import Notice
from moyai.series.extremes import ExtremeFit, Family, kolmogorov_distance
from moyai.series.intervals import Interval, reflected_interval
from moyai.series.likelihood import pareto_likelihood, weibull_likelihood

SnapLaw = Literal["weibull", "pareto"]

_FEWEST = 10
_FEW = 30
_LAW_WORDS = {"weibull": "Weibull distribution", "pareto": "Pareto distribution"}
_FAMILY: dict[str, Family] = {"weibull": "weibull", "pareto": "generalised_pareto"}


@checks_words
@dataclass(frozen=True, eq=False)
class SnapFit:
    """Law of the peaks above a threshold."""

    #: exp(-(y/a)^c), or (1 + c y/a)^(-1/c), y the excess over the threshold [eq:curtain-snap-exceedance]; one of
    #: "weibull", "pareto".
    law: SnapLaw
    #: [N].
    threshold: float
    #: Shape c of the law [-].
    shape: Interval
    #: Scale a of the law [N].
    scale: Interval
    #: Peaks above the threshold per hour; exact bounds of Poisson's law.
    rate: Interval
    #: Peaks above the threshold, largest first [N].
    peaks: Array
    #: Observed time [h].
    hours: float
    #: Of all intervals.
    confidence: float
    #: Largest difference of empirical and fitted probability (Kolmogorov and Smirnov).
    distance: float
    #: Shape, scale and rate of the samples behind the intervals; shape (n, 3).
    resampled: Array
    #: Where the fit is thin.
    notices: tuple[Notice, ...]

    def exceedance(self, tension: ArrayLike) -> Array:
        """Return the probability that a peak above the threshold exceeds a tension [N]."""
        return self._distribution(self.shape.value, self.scale.value).exceedance(tension)

    @property
    def empirical(self) -> Array:
        """Exceedance i/(n + 1) of :attr:`peaks`."""
        return np.arange(1, self.peaks.size + 1) / (self.peaks.size + 1.0)

    def most_probable_maximum(self, hours: float) -> Interval:
        """Return the most probable largest tension in so many hours [N] [eq:curtain-snap-maximum].

        Raises
        ------
        InputError
            When the time is not positive, or so short that no peak above the threshold is expected.
        """
        _check_hours(hours)
        if self.rate.value * hours < 2.0:
            raise InputError(
                f"{self.rate.value * hours:.3g} peaks above the threshold are expected in {hours:g} h",
                parameter="hours",
                allowed=f"at least {2.0 / self.rate.value:.3g} h",
                remedy="give a longer time, or lower the threshold",
            )
        return self._interval(lambda shape, scale, rate: _mode(self.law, shape, scale, max(rate * hours, 1.0)))

    def _distribution(self, shape: float, scale: float) -> ExtremeFit:
        return ExtremeFit(_FAMILY[self.law], self.threshold, scale, shape, self.peaks.size, math.nan)

    def _interval(self, excess: Callable[[float, float, float], float]) -> Interval:
        values = self.threshold + np.array([excess(*row) for row in self.resampled])
        best = self.threshold + excess(self.shape.value, self.scale.value, self.rate.value)
        return reflected_interval(best, values, self.confidence, base=self.threshold)


def _check_hours(hours: float) -> None:
    if not (math.isfinite(hours) and hours > 0.0):
        raise InputError(f"hours is {hours:g}", parameter="hours", allowed="greater than 0")


def _excess_at(law: SnapLaw, probability: float, shape: float, scale: float) -> float:
    """Return the excess that is exceeded with a probability."""
    if probability >= 1.0:
        return 0.0
    return float(ExtremeFit(_FAMILY[law], 0.0, scale, shape, 0, math.nan).level(probability))


def _mode(law: SnapLaw, shape: float, scale: float, count: float) -> float:
    """Return the most probable excess of the largest of a Poisson number of peaks with mean ``count``."""
    if law == "pareto":
        if shape <= -1.0:
            # the density rises up to the end of the distribution
            return -scale / shape
        # n Q = 1 + c
        return _excess_at(law, min((1.0 + shape) / count, 1.0), shape, scale)
    # n e^-t = 1 - (c - 1)/(c t), t = (y/a)^c
    t = max(math.log(count), 1e-3)
    for _ in range(100):
        right = 1.0 - (shape - 1.0) / (shape * t)
        new = math.log(count) - math.log(right) if right > 0.0 else 0.5 * t
        new = max(new, 1e-6)
        if abs(new - t) <= 1e-12 * t:
            break
        t = new
    return float(scale * t ** (1.0 / shape))


@checks_words
def fit_snaps(
    peaks: ArrayLike,
    hours: float,
    *,
    threshold: float,
    law: SnapLaw = "weibull",
    confidence: float = 0.95,
    resamples: int = 300,
    seed: int = 0,
) -> SnapFit:
    """Fit a law to the peaks above a threshold by greatest likelihood [eq:curtain-snap-exceedance].

    Parameters
    ----------
    peaks : array_like
        One peak for each snap [N].
    hours : float
        Observed time [h].
    threshold : float
        [N]; 0 takes all peaks. The Pareto law is right for high thresholds only.
    law : {"weibull", "pareto"}
        Which law.
    confidence : float
        Of the intervals.
    resamples : int
        Samples drawn for the intervals.
    seed : int
        Of these samples.

    Raises
    ------
    InputError
        When fewer than ten peaks are above the threshold, they are all equal, or a number is out of range.
    ConvergenceError
        Where the likelihood has no maximum.
    """
    _check_hours(hours)
    given = np.asarray(peaks, dtype=np.float64).reshape(-1)
    if not np.isfinite(given).all():
        raise InputError("a peak is not a number", parameter="peaks", allowed="finite tensions")
    if law not in get_args(SnapLaw):
        raise InputError(f"unknown law {law!r}", parameter="law", allowed=", ".join(get_args(SnapLaw)))
    if not 0.5 <= confidence < 1.0:
        raise InputError(f"confidence is {confidence:g}", parameter="confidence", allowed="0.5 to below 1")
    if resamples < 50:
        raise InputError(f"resamples is {resamples}", parameter="resamples", allowed="at least 50")
    if not math.isfinite(threshold):
        raise InputError(f"threshold is {threshold:g} N", parameter="threshold", allowed="finite")
    chosen = np.sort(given[given > threshold])[::-1].copy()
    if chosen.size < _FEWEST or chosen[0] == chosen[-1]:
        raise InputError(
            f"{chosen.size} different peaks above {threshold:g} N",
            parameter="peaks",
            allowed=f"at least {_FEWEST}, not all equal",
            remedy="simulate a longer sea, more seeds, or lower the threshold",
        )
    search = weibull_likelihood if law == "weibull" else pareto_likelihood
    shape, scale = search(chosen - threshold)
    fitted = ExtremeFit(_FAMILY[law], threshold, scale, shape, chosen.size, math.nan)
    rng = np.random.default_rng(seed)
    rows = []
    for count in np.maximum(rng.poisson(chosen.size, resamples), 5):
        sample = replace(fitted, location=0.0).sample(int(count), rng)
        try:
            rows.append((*search(np.maximum(sample, 1e-300)), count / hours))
        except ConvergenceError:
            # A few Pareto peaks may have no likeliest fit
            continue
    if len(rows) < resamples // 2:
        raise ConvergenceError(
            f"only {len(rows)} of {resamples} samples drawn from the {law} fit can be fitted again",
            parameter="peaks",
            remedy="simulate a longer sea, more seeds, or lower the threshold",
        )
    drawn = np.array(rows)
    distance = kolmogorov_distance(fitted, chosen)
    return SnapFit(
        law,
        threshold,
        reflected_interval(shape, drawn[:, 0], confidence, base=0.0 if law == "weibull" else None),
        reflected_interval(scale, drawn[:, 1], confidence, base=0.0),
        poisson_rate(chosen.size, hours, confidence),
        chosen,
        hours,
        confidence,
        distance,
        drawn,
        _check_fit(law, chosen.size, shape, distance),
    )


def poisson_rate(count: int, hours: float, confidence: float = 0.95) -> Interval:
    """Return events per hour with the exact bounds of Poisson's law (Garwood)."""
    from scipy.special import chdtri

    _check_hours(hours)
    tail = 0.5 * (1.0 - confidence)
    low = 0.5 * float(chdtri(2 * count, 1.0 - tail)) if count > 0 else 0.0
    return Interval(count / hours, low / hours, 0.5 * float(chdtri(2 * count + 2, tail)) / hours, confidence)


def dispersion(time: ArrayLike, start: float, duration: float, blocks: int) -> float:
    """Return variance over mean of the number of events in equal blocks of time: 1 for a Poisson process.

    Raises
    ------
    InputError
        For fewer than two blocks, or no events.
    """
    if blocks < 2:
        raise InputError(f"blocks is {blocks}", parameter="blocks", allowed="at least 2")
    counts, _ = np.histogram(np.asarray(time), bins=blocks, range=(start, start + duration))
    if counts.sum() == 0:
        raise InputError("no event is in the blocks", parameter="time", allowed="at least one event")
    return float(counts.var(ddof=1) / counts.mean())


def _check_fit(law: SnapLaw, count: int, shape: float, distance: float) -> tuple[Notice, ...]:
    notices = []
    if count < _FEW:
        notices.append(
            Notice(
                "snap-few",
                f"{count} peaks are used in the fit; the distribution of the largest is poorly determined",
                float(count),
                float(_FEW),
                remedy="simulate a longer sea or more seeds",
                source="width of the intervals",
            )
        )
    # Kolmogorov's bound of 1 %, on the safe side for fitted parameters
    limit = 1.63 / math.sqrt(count)
    if distance > limit:
        notices.append(
            Notice(
                "snap-fit",
                f"The {_LAW_WORDS[law]} differs from the measured distribution by {distance:.3g} in probability",
                distance,
                limit,
                remedy="raise the threshold, or take the other law",
                source="Kolmogorov and Smirnov, 1 %",
            )
        )
    if law == "pareto" and shape > 0.3:
        notices.append(
            Notice(
                "snap-heavy",
                f"A Pareto shape of {shape:.3g} has a heavy tail: extrapolation is not safe",
                shape,
                0.3,
                remedy="raise the threshold or add data",
                source="variance grows without bound towards 0.5",
            )
        )
    return tuple(notices)
