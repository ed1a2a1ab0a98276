"""Regressions of measured loads with their confidence: lines, powers, cosines of the direction, classes.

Least squares throughout; bounds by Student's t on the covariance, or by drawing observations again.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from moyai.core.arrays import Array
from moyai.core.errors import InputError
from moyai.core.options import checks_words
from moyai.series.intervals import student_quantile


@dataclass(frozen=True)
class Estimate:
    """A fitted number."""

    #: Estimate.
    value: float
    #: Standard error.
    error: float
    #: Lower bound.
    low: float
    #: Upper bound.
    high: float

    def holds(self, value: float) -> bool:
        """Return whether a value lies within the bounds."""
        return self.low <= value <= self.high


@dataclass(frozen=True, eq=False)
class Regression:
    """A fitted relation of y to x."""

    #: In words.
    form: str
    #: By name.
    parameters: dict[str, Estimate]
    #: R^2 about the mean of y; negative where a constant fits better.
    determination: float
    #: Standard deviation of the residuals [unit of y].
    deviation: float
    #: Observed less fitted.
    residual: Array
    #: Of the parameters, in their order.
    covariance: Array
    #: The relation.
    predict: Callable[[ArrayLike], Array]

    def __getitem__(self, name: str) -> Estimate:
        return self.parameters[name]


def _pairs(x: ArrayLike, y: ArrayLike, least: int) -> tuple[Array, Array]:
    one, two = np.asarray(x, dtype=np.float64).reshape(-1), np.asarray(y, dtype=np.float64).reshape(-1)
    if one.size != two.size:
        raise InputError(f"{one.size} and {two.size} values", parameter="y", allowed="equal lists")
    known = np.isfinite(one) & np.isfinite(two)
    if int(known.sum()) < least:
        raise InputError(f"{int(known.sum())} pairs of numbers", parameter="y", allowed=f"at least {least}")
    return one[known], two[known]


def _result(
    form: str,
    names: Sequence[str],
    values: Array,
    jacobian: Array,
    y: Array,
    predict: Callable[[ArrayLike], Array],
    fitted: Array,
    confidence: float,
) -> Regression:
    residual = y - fitted
    freedom = y.size - values.size
    variance = float(residual @ residual) / freedom
    covariance: Array = np.asarray(variance * np.linalg.pinv(jacobian.T @ jacobian), dtype=np.float64)
    reach = student_quantile(confidence, freedom)
    errors = np.sqrt(np.diag(covariance))
    about = float(np.sum((y - y.mean()) ** 2))
    return Regression(
        form,
        {
            name: Estimate(float(value), float(error), float(value - reach * error), float(value + reach * error))
            for name, value, error in zip(names, values, errors)
        },
        1.0 - float(residual @ residual) / about if about > 0.0 else math.nan,
        math.sqrt(variance),
        residual,
        covariance,
        predict,
    )


@checks_words
def fit_line(x: ArrayLike, y: ArrayLike, *, through_origin: bool = False, confidence: float = 0.95) -> Regression:
    """Fit y = slope x (+ intercept); pairs with a NaN are left out.

    Parameters
    ----------
    x, y : array_like
        Observations.
    through_origin : bool
        Whether there is no intercept.
    confidence : float
        Of the bounds.

    Raises
    ------
    InputError
        For fewer than three pairs, or x that does not vary.
    """
    one, two = _pairs(x, y, 3)
    columns = one[:, None] if through_origin else np.stack([one, np.ones_like(one)], axis=1)
    if float(np.ptp(one)) == 0.0 and not (through_origin and one[0] != 0.0):
        raise InputError(f"x is {one[0]:g} throughout", parameter="x", allowed="values that differ")
    values: Array = np.asarray(np.linalg.lstsq(columns, two, rcond=None)[0], dtype=np.float64)
    slope, intercept = float(values[0]), 0.0 if through_origin else float(values[1])

    def predict(at: ArrayLike) -> Array:
        return np.asarray(slope * np.asarray(at, dtype=np.float64) + intercept)

    names = ("slope",) if through_origin else ("slope", "intercept")
    return _result("y = slope x" + ("" if through_origin else " + intercept"), names, values, columns, two, predict,
                   columns @ values, confidence)  # fmt: skip


def fit_power(x: ArrayLike, y: ArrayLike, *, confidence: float = 0.95) -> Regression:
    """Fit y = factor x^exponent by least squares in y [eq:regression-power].

    The error belongs to y itself: a floor of noise under small y, which bends a fit of logarithms, hardly counts.

    Raises
    ------
    InputError
        For fewer than three pairs, or x that is not positive or does not vary.
    """
    one, two = _pairs(x, y, 3)
    if not np.all(one > 0.0):
        raise InputError(f"x is {one.min():g}", parameter="x", allowed="greater than 0")
    return _power("y = factor x^exponent", one, two, confidence, lambda at: np.asarray(at, dtype=np.float64))


def fit_cosine(angle: ArrayLike, y: ArrayLike, *, confidence: float = 0.95) -> Regression:
    """Fit y = factor cos^exponent(angle) by least squares in y [eq:regression-power].

    Parameters
    ----------
    angle : array_like
        From the normal [rad], at most a right angle; 0 is normal incidence.
    y : array_like
        Loads, or loads over the largest.
    confidence : float
        Of the bounds.

    Raises
    ------
    InputError
        For angles beyond 90 degrees, fewer than three pairs, or one angle only.
    """
    beta, two = _pairs(angle, y, 3)
    if np.any(np.abs(beta) > 0.5 * math.pi * (1.0 + 1e-12)):
        raise InputError(
            f"an angle of {math.degrees(float(np.abs(beta).max())):.4g} degrees",
            parameter="angle",
            allowed="at most 90 degrees from the normal",
        )

    def cosine(at: ArrayLike) -> Array:
        return np.maximum(np.cos(np.asarray(at, dtype=np.float64)), 1e-12)

    return _power("y = factor cos^exponent(angle)", beta, two, confidence, cosine)


def _power(form: str, x: Array, y: Array, confidence: float, base: Callable[[ArrayLike], Array]) -> Regression:
    logs = np.log(base(x))
    if float(np.ptp(logs)) == 0.0:
        raise InputError("x does not vary", parameter="x", allowed="values that differ")

    def factor_of(exponent: float) -> tuple[float, float]:
        shape = np.exp(exponent * logs - (exponent * logs).max())
        factor = float(shape @ y) / float(shape @ shape)
        return factor * math.exp(-float((exponent * logs).max())), float(np.sum((y - factor * shape) ** 2))

    from scipy.optimize import minimize_scalar

    trial = np.linspace(-2.0, 10.0, 121)
    best = int(np.argmin([factor_of(float(value))[1] for value in trial]))
    low, high = float(trial[max(best - 1, 0)]), float(trial[min(best + 1, trial.size - 1)])
    exponent = float(minimize_scalar(lambda n: factor_of(n)[1], bounds=(low, high), method="bounded",
                                     options={"xatol": 1e-10}).x)  # fmt: skip
    factor, _ = factor_of(exponent)

    def predict(at: ArrayLike) -> Array:
        return np.asarray(factor * base(at) ** exponent)

    shape = np.exp(exponent * logs)
    jacobian = np.stack([shape, factor * shape * logs], axis=1)
    # columns of like size: loads in newtons next to an exponent would spoil the inverse
    size = np.linalg.norm(jacobian, axis=0)
    found = _result(form, ("factor", "exponent"), np.array([factor * size[0], exponent * size[1]]), jacobian / size, y,
                    predict, factor * shape, confidence)  # fmt: skip
    scaled = {
        name: Estimate(item.value / s, item.error / s, item.low / s, item.high / s)
        for (name, item), s in zip(found.parameters.items(), size)
    }
    covariance = np.asarray(found.covariance / np.outer(size, size), dtype=np.float64)
    return Regression(form, scaled, found.determination, found.deviation, found.residual, covariance, predict)


def correlation(x: ArrayLike, y: ArrayLike, *, confidence: float = 0.95) -> Estimate:
    """Return Pearson's correlation with Fisher's bounds.

    Raises
    ------
    InputError
        For fewer than four pairs, or a list that does not vary.
    """
    one, two = _pairs(x, y, 4)
    if float(np.ptp(one)) == 0.0 or float(np.ptp(two)) == 0.0:
        raise InputError("a list does not vary", parameter="x", allowed="values that differ")
    r = float(np.corrcoef(one, two)[0, 1])
    from scipy.special import ndtri

    reach = float(ndtri(0.5 + 0.5 * confidence)) / math.sqrt(one.size - 3)
    centre = math.atanh(min(max(r, -1.0 + 1e-15), 1.0 - 1e-15))
    return Estimate(r, (1.0 - r * r) / math.sqrt(one.size - 1), math.tanh(centre - reach), math.tanh(centre + reach))


def type_ratio(reference: ArrayLike, other: ArrayLike, *, confidence: float = 0.95) -> tuple[Regression, Estimate]:
    """Return how the loads of one type follow those of another measured next to it.

    Parameters
    ----------
    reference, other : array_like
        Loads of both types in the same blocks, for instance conventional and new.
    confidence : float
        Of the bounds.

    Returns
    -------
    Regression
        other = slope reference, by least squares: lowered by the scatter of the reference.
    Estimate
        Ratio of the means, which scatter on both sides leaves where it is; bounds by the jackknife.
    """
    one, two = _pairs(reference, other, 3)
    line = fit_line(one, two, through_origin=True, confidence=confidence)
    if one.sum() == 0.0:
        raise InputError("the reference loads sum to 0", parameter="reference", allowed="loads")
    ratio = float(two.sum() / one.sum())
    left = (two.sum() - two) / (one.sum() - one)
    error = math.sqrt((one.size - 1) / one.size * float(np.sum((left - left.mean()) ** 2)))
    reach = student_quantile(confidence, one.size - 1) * error
    return line, Estimate(ratio, error, ratio - reach, ratio + reach)


@dataclass(frozen=True, eq=False)
class ClassFit:
    """A class of directions against the line of all observations."""

    #: Lower bound of the class [rad].
    low: float
    #: Upper bound of the class [rad].
    high: float
    #: Observations.
    count: int
    #: Line of the class alone; None with fewer than three observations.
    fit: Regression | None
    #: Mean residual from the common line, as a share of the mean load; None with fewer than three observations.
    departure: Estimate | None

    @property
    def leaves_the_line(self) -> bool:
        """Whether the mean residual differs from zero within its bounds."""
        return self.departure is not None and not self.departure.holds(0.0)


def fit_by_direction(
    x: ArrayLike, y: ArrayLike, angle: ArrayLike, edges: ArrayLike, *, confidence: float = 0.95
) -> tuple[Regression, tuple[ClassFit, ...]]:
    """Fit one line through the origin to all observations and tell which directions leave it.

    Parameters
    ----------
    x, y, angle : array_like
        For instance H_1/3, T_1/10 and the angle from the normal [rad].
    edges : array_like
        Bounds of the classes [rad], increasing; an angle on the last one belongs to the last class.
    confidence : float
        Of the bounds.

    Raises
    ------
    InputError
        When edges do not increase, or there are fewer than three observations.
    """
    bounds = np.asarray(edges, dtype=np.float64)
    if bounds.ndim != 1 or bounds.size < 2 or np.any(np.diff(bounds) <= 0.0):
        raise InputError("edges do not increase", parameter="edges", allowed="two or more, increasing")
    one, two, beta = (np.asarray(item, dtype=np.float64).reshape(-1) for item in (x, y, angle))
    if not one.size == two.size == beta.size:
        raise InputError("lists differ in length", parameter="angle", allowed="equal lists")
    known = np.isfinite(one) & np.isfinite(two) & np.isfinite(beta)
    one, two, beta = one[known], two[known], beta[known]
    common = fit_line(one, two, through_origin=True, confidence=confidence)
    classes = []
    for k, (low, high) in enumerate(itertools.pairwise(bounds)):
        chosen = (beta >= low) & ((beta < high) | ((k == bounds.size - 2) & (beta <= high)))
        count = int(chosen.sum())
        fit, departure = None, None
        if count >= 3 and float(np.ptp(one[chosen])) > 0.0:
            fit = fit_line(one[chosen], two[chosen], through_origin=True, confidence=confidence)
            off = (two[chosen] - common.predict(one[chosen])) / float(two[chosen].mean())
            error = float(off.std(ddof=1)) / math.sqrt(count)
            reach = student_quantile(confidence, count - 1) * error
            mean = float(off.mean())
            departure = Estimate(mean, error, mean - reach, mean + reach)
        classes.append(ClassFit(float(low), float(high), count, fit, departure))
    return common, tuple(classes)


def resampled(
    function: Callable[..., float], *columns: ArrayLike, resamples: int = 500, seed: int = 0, confidence: float = 0.95
) -> Estimate:
    """Return a number of observations with bounds from drawing observations again (percentiles).

    Parameters
    ----------
    function : callable
        From columns to a number.
    *columns : array_like
        Equal lists; one observation is a row.
    resamples, seed : int
        Draws and their seed.
    confidence : float
        Of the bounds.

    Raises
    ------
    InputError
        For lists that differ or fewer than three observations.
    """
    lists = [np.asarray(column, dtype=np.float64) for column in columns]
    count = lists[0].shape[0] if lists else 0
    if count < 3 or any(column.shape[0] != count for column in lists):
        raise InputError(
            f"lists of {[len(column) for column in lists]}", parameter="columns", allowed="equal, 3 or more"
        )
    rng = np.random.default_rng(seed)
    draws = np.array(
        [function(*(column[rows] for column in lists)) for rows in rng.integers(0, count, (resamples, count))]
    )
    tail = 50.0 * (1.0 - confidence)
    low, high = np.percentile(draws, [tail, 100.0 - tail])
    return Estimate(float(function(*lists)), float(draws.std(ddof=1)), float(low), float(high))
