"""Extremes of a response: distributions fitted to peaks and maxima, with their uncertainty.

Theory in docs/theory/extremes.md.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from moyai.core.arrays import Array
from moyai.core.curves import crossing
from moyai.core.errors import ConvergenceError, InputError
from moyai.core.options import checks_words
from moyai.core.validity import Notice
from moyai.series.intervals import Interval, reflected_interval
from moyai.series.likelihood import pareto_level_bounds, pareto_likelihood, weibull_likelihood

Family = Literal["gumbel", "weibull", "generalised_pareto"]

_LEAST = {"gumbel": 5, "weibull": 5, "generalised_pareto": 10}


@checks_words
@dataclass(frozen=True)
class ExtremeFit:
    """A distribution of peaks or maxima."""

    #: ``gumbel`` (maxima of blocks), ``weibull`` (peaks above a location), ``generalised_pareto`` (peaks above a
    #: threshold).
    family: Family
    #: Of the unit of the data: mode of the Gumbel, lower end of the others.
    location: float
    #: Of the unit of the data.
    scale: float
    #: Weibull exponent, or Pareto shape (positive: heavy tail); 0 for the Gumbel.
    shape: float
    #: Number of values.
    count: int
    #: Of the values under the fit.
    log_likelihood: float
    #: Weibull of a tail: the distribution is that of values above it [eq:extremes-weibull-tail].
    threshold: float | None = None

    def __post_init__(self) -> None:
        for name in ("location", "scale", "shape", "log_likelihood"):
            object.__setattr__(self, name, float(getattr(self, name)))

    @property
    def _start(self) -> float:
        """``((threshold - location) / scale)^shape``, zero where the whole Weibull is meant."""
        return 0.0 if self.threshold is None else ((self.threshold - self.location) / self.scale) ** self.shape

    def exceedance(self, level: ArrayLike) -> Array:
        """Return the probability that a value exceeds ``level``; accurate also where it is tiny.

        Parameters
        ----------
        level : array_like (...)
            In the unit of the data.
        """
        y = (np.asarray(level, dtype=float) - self.location) / self.scale
        if self.family == "gumbel":
            return np.asarray(-np.expm1(-np.exp(-y)))
        y = np.maximum(y, 0.0)
        if self.family == "weibull":
            return np.asarray(np.exp(-np.maximum(y**self.shape - self._start, 0.0)))
        if abs(self.shape) < 1e-9:
            return np.asarray(np.exp(-y))
        return np.asarray(np.maximum(1.0 + self.shape * y, 0.0) ** (-1.0 / self.shape))

    def level(self, exceedance: ArrayLike) -> Array:
        """Return the level that is exceeded with the given probability.

        Parameters
        ----------
        exceedance : array_like (...)
            Between 0 and 1, both excluded [-].

        Returns
        -------
        ndarray (...)
            In the unit of the data.

        Raises
        ------
        InputError
            For a probability that is not between 0 and 1.
        """
        p = np.asarray(exceedance, dtype=float)
        if np.any((p <= 0.0) | (p >= 1.0)):
            raise InputError("a probability of exceedance lies between 0 and 1", parameter="exceedance")
        if self.family == "gumbel":
            return np.asarray(self.location - self.scale * np.log(-np.log1p(-p)))
        if self.family == "weibull":
            return np.asarray(self.location + self.scale * (self._start - np.log(p)) ** (1.0 / self.shape))
        if abs(self.shape) < 1e-9:
            return np.asarray(self.location - self.scale * np.log(p))
        return np.asarray(self.location + self.scale * np.expm1(-self.shape * np.log(p)) / self.shape)

    def most_probable_maximum(self, count: float) -> float:
        """Return the level that is exceeded once in ``count`` values on the average: the mode of their maximum.

        Parameters
        ----------
        count : float
            Number of values, more than 1.

        Returns
        -------
        float
            In the unit of the data.

        Raises
        ------
        InputError
            For a count of 1 or less.
        """
        if not count > 1.0:
            raise InputError(f"the maximum of {count:g} values has no mode", parameter="count", allowed="more than 1")
        if self.family == "gumbel":
            return self.location + self.scale * math.log(count)
        return float(self.level(1.0 / count))

    def maximum_level(self, count: float, probability: float) -> float:
        """Return the level that the maximum of ``count`` values stays below with ``probability``.

        Parameters
        ----------
        count : float
            Number of values.
        probability : float
            Between 0 and 1, both excluded [-].

        Returns
        -------
        float
            In the unit of the data.

        Raises
        ------
        InputError
            For a probability that is not between 0 and 1.
        """
        if not 0.0 < probability < 1.0:
            raise InputError("a probability lies between 0 and 1", parameter="probability")
        # 1 - probability**(1 / count), without cancellation for many values
        return float(self.level(-math.expm1(math.log(probability) / count)))

    def sample(self, count: int, generator: np.random.Generator) -> Array:
        """Draw values of the distribution, (count,), in the unit of the data.

        Parameters
        ----------
        count : int
            How many.
        generator : numpy.random.Generator
            Draws the probabilities.
        """
        return self.level(np.clip(generator.random(count), 1e-300, 1.0 - 1e-16))


@checks_words
def fit(
    values: ArrayLike, family: Family, *, location: float | None = None, threshold: float | None = None
) -> ExtremeFit:
    """Fit a distribution by maximum likelihood.

    Parameters
    ----------
    values : array_like (n,)
        Maxima of blocks (Gumbel), peaks (Weibull, generalised Pareto).
    family : str
        See :class:`ExtremeFit`.
    location : float
        Lower end of the Weibull (0 for peaks above a mean) or threshold of the Pareto; values below it are left out.
        Not for the Gumbel.
    threshold : float, optional
        Weibull only: fit the tail above it, by the likelihood of values that are known to exceed it.

    Returns
    -------
    ExtremeFit
        The distribution, its parameters in the unit of the data, and its log-likelihood.

    Raises
    ------
    InputError
        For too few or equal values, or a location that is missing or in the way.
    ConvergenceError
        Where the likelihood has no maximum.

    Notes
    -----
    Coles (2001), ch. 3 and 4 [eq:extremes-gumbel] [eq:extremes-weibull] [eq:extremes-pareto]; the equations of the
    Gumbel and Weibull reduce to one unknown, that of the Pareto to a search along one (Grimshaw 1993).

    Examples
    --------
    >>> import numpy as np
    >>> from moyai.series import fit
    >>> fitted = fit(np.random.default_rng(1).gumbel(100.0, 10.0, 2000), "gumbel")
    >>> round(float(fitted.location)), round(float(fitted.scale))
    (100, 10)
    """
    data = np.asarray(values, dtype=float).ravel()
    if not np.isfinite(data).all():
        raise InputError("the values hold NaN or infinity", parameter="values", remedy="leave them out knowingly")
    if family == "gumbel":
        if location is not None:
            raise InputError(
                "the location of a Gumbel distribution is fitted", parameter="location", remedy="leave it out"
            )
        _require(data, family)
        return _gumbel(data)
    if location is None:
        raise InputError(
            f"a {family} fit needs the lower end of the values",
            parameter="location",
            remedy="give the threshold, or 0 for peaks above the mean",
        )
    if threshold is not None:
        if family != "weibull" or threshold < location:
            raise InputError(
                "only the tail of a Weibull distribution has a threshold, no less than its location",
                parameter="threshold",
            )
        above = data[data > threshold]
        _require(above, family)
        return _weibull_tail(above, location, threshold)
    above = data[data > location]
    _require(above, family)
    return _weibull(above, location) if family == "weibull" else _pareto(above, location)


def _require(data: Array, family: Family) -> None:
    if data.size < _LEAST[family]:
        raise InputError(
            f"{data.size} values are too few for a {family} fit",
            parameter="values",
            allowed=f"at least {_LEAST[family]}",
            remedy="run more seeds or longer seas, or lower the threshold",
        )
    if np.ptp(data) <= 1e-12 * np.max(np.abs(data)):
        raise InputError("all values are equal: there is nothing to fit", parameter="values")


def _gumbel(data: Array) -> ExtremeFit:
    mean, spread = float(np.mean(data)), float(np.std(data))
    x = (data - mean) / spread

    def residual(scale: float) -> float:
        # Weights of the smallest value would overflow; only differences matter
        weight = np.exp(-(x - x.min()) / scale)
        return float(scale - np.mean(x) + np.sum(x * weight) / np.sum(weight))

    scale = crossing(residual, 1e-3, 20.0, tolerance=1e-14)
    location = x.min() - scale * math.log(np.mean(np.exp(-(x - x.min()) / scale)))
    y = (x - location) / scale
    likelihood = float(-x.size * math.log(scale * spread) - np.sum(y) - np.sum(np.exp(-y)))
    return ExtremeFit("gumbel", mean + spread * location, spread * scale, 0.0, data.size, likelihood)


def _weibull(data: Array, location: float) -> ExtremeFit:
    shape, scale = weibull_likelihood(data - location)
    y = (data - location) / scale
    likelihood = float(data.size * math.log(shape / scale) + (shape - 1.0) * np.sum(np.log(y)) - np.sum(y**shape))
    return ExtremeFit("weibull", location, scale, shape, data.size, likelihood)


def _weibull_tail(data: Array, location: float, threshold: float) -> ExtremeFit:
    unit = float(np.max(data)) - location
    log = np.log((data - location) / unit)
    start = (threshold - location) / unit
    mean_log = float(np.mean(log))

    def power(shape: float) -> float:
        return float(np.mean(np.exp(shape * log))) - (start**shape if start > 0.0 else 0.0)

    def minus_likelihood(log_shape: float) -> float:
        # The scale that fits best follows from the shape: scale^shape is the mean of what power() holds
        shape = math.exp(log_shape)
        rest = power(shape)
        return math.inf if rest <= 0.0 else math.log(rest) - math.log(shape) - (shape - 1.0) * mean_log + 1.0

    grid = np.linspace(math.log(0.1), math.log(30.0), 60)
    values = np.array([minus_likelihood(one) for one in grid])
    best = int(np.argmin(values))
    if best in (0, grid.size - 1) or not math.isfinite(values[best]):
        raise ConvergenceError(
            "the likelihood of the tail of the Weibull fit has no maximum",
            parameter="values",
            remedy="fit a larger share of the peaks, or choose another family",
        )
    from scipy.optimize import minimize_scalar

    found = minimize_scalar(
        minus_likelihood, bounds=(grid[best - 1], grid[best + 1]), method="bounded", options={"xatol": 1e-10}
    )
    shape = math.exp(float(found.x))
    scale = power(shape) ** (1.0 / shape) * unit
    likelihood = -data.size * (float(found.fun) + math.log(unit))
    return ExtremeFit("weibull", location, scale, shape, data.size, likelihood, threshold)


def _pareto(data: Array, location: float) -> ExtremeFit:
    shape, scale = pareto_likelihood(data - location)
    # The mean of log(1 + shape y / scale) is the shape itself; the mean excess is the scale of the exponential
    likelihood = -data.size * (math.log(scale) + shape + 1.0)
    return ExtremeFit("generalised_pareto", location, scale, shape, data.size, likelihood)


def refit(fitted: ExtremeFit, values: ArrayLike) -> ExtremeFit:
    """Return the same kind of fit to other values: same family, lower end and threshold."""
    location = None if fitted.family == "gumbel" else fitted.location
    return fit(values, fitted.family, location=location, threshold=fitted.threshold)


def maximum_interval(
    fitted: ExtremeFit,
    count: float,
    *,
    seed: int,
    probability: float | None = None,
    confidence: float = 0.9,
    repetitions: int = 400,
    values: ArrayLike | None = None,
) -> Interval:
    """Return the most probable maximum of ``count`` values with its confidence interval.

    Parameters
    ----------
    fitted : Fit
        From :func:`fit`.
    count : float
        Number of values whose maximum is meant: peaks in the storm, or 1 block for a quantile of block maxima.
    seed : int
        Of the parametric bootstrap.
    probability : float, optional
        Give the level that the maximum stays below with this probability, instead of its mode.
    confidence : float
        Of the interval [-].
    repetitions : int
        Fits to samples drawn from ``fitted``.
    values : array_like, optional
        What a generalised Pareto was fitted to: the interval is that of the profile likelihood then
        [eq:extremes-profile], since few fits to samples cover too little of its tail.

    Returns
    -------
    Interval
        Level with its lower and upper bound, in the unit of the data: basic bootstrap of the logarithmic distance from
        the location, so that it never falls below the location.

    Raises
    ------
    InputError
        For a probability outside 0 to 1.

    References
    ----------
    A. C. Davison and D. V. Hinkley (1997), Bootstrap Methods and their Application, Cambridge University Press, ch. 5.

    Examples
    --------
    >>> import numpy as np
    >>> from moyai.series import fit, maximum_interval
    >>> fitted = fit(np.random.default_rng(1).gumbel(100.0, 10.0, 200), "gumbel")
    >>> found = maximum_interval(fitted, 1, seed=1, probability=0.9, repetitions=100)
    >>> found.lower < found.value < found.upper
    True
    """

    def level(one: ExtremeFit) -> float:
        return one.most_probable_maximum(count) if probability is None else one.maximum_level(count, probability)

    if fitted.family == "generalised_pareto" and values is not None:
        excess = np.asarray(values, dtype=float).ravel() - fitted.location
        exceeded = 1.0 / count if probability is None else -math.expm1(math.log(probability) / count)
        low, high = pareto_level_bounds(excess[excess > 0.0], exceeded, confidence)
        return Interval(level(fitted), fitted.location + low, fitted.location + high, confidence)
    generator = np.random.default_rng(seed)
    found = []
    for _ in range(repetitions):
        drawn = fitted.sample(fitted.count, generator)
        try:
            again = refit(fitted, drawn)
        except (InputError, ConvergenceError):
            continue
        found.append(level(again))
    value = level(fitted)
    base = None if fitted.family == "gumbel" else fitted.location
    return reflected_interval(value, found, confidence, base=base)


def kolmogorov_distance(fitted: ExtremeFit, values: ArrayLike) -> float:
    """Return the largest difference of the empirical and the fitted distribution [-]."""
    data = np.sort(np.asarray(values, dtype=float).ravel())
    below = 1.0 - fitted.exceedance(data)
    steps = np.arange(data.size + 1) / data.size
    return float(max(np.max(steps[1:] - below), np.max(below - steps[:-1])))


def check_fit(fitted: ExtremeFit, values: ArrayLike) -> tuple[Notice, ...]:
    """Return notices about the quality of a fit: distance from the data, few values, heavy tail.

    The distance is that of Anderson and Darling, which weighs the tails; above 2.5 a fit is doubtful at the 5 % level
    where the parameters are known, and well above it where they were fitted.
    """
    notices = []
    data = np.sort(np.asarray(values, dtype=float).ravel())
    lower_end = fitted.location if fitted.threshold is None else fitted.threshold
    data = data[data > lower_end] if fitted.family != "gumbel" else data
    n = data.size
    above = np.clip(fitted.exceedance(data), 1e-300, 1.0 - 1e-16)
    order = np.arange(1, n + 1)
    distance = float(-n - np.sum((2 * order - 1) * (np.log1p(-above) + np.log(above[::-1]))) / n)
    if distance > 2.5:
        notices.append(
            Notice(
                "extremes-distance",
                f"the {fitted.family} fit is far from the data (Anderson-Darling distance {distance:.2f}, limit 2.5)",
                distance,
                2.5,
                remedy="choose another family or threshold; fit snap peaks apart from the others",
                source="Anderson and Darling (1954)",
            )
        )
    if n < 20:
        notices.append(
            Notice(
                "extremes-few",
                f"{n} values are used in the fit; below 20 its interval is rough",
                float(n),
                20.0,
                remedy="run more seeds",
            )
        )
    if fitted.family == "generalised_pareto" and fitted.shape > 0.5:
        notices.append(
            Notice(
                "extremes-heavy-tail",
                f"the tail is so heavy (shape {fitted.shape:.2f}, limit 0.5) that its variance does not exist",
                fitted.shape,
                0.5,
                remedy="look for peaks of two kinds in the data, and fit them apart",
            )
        )
    return tuple(notices)
