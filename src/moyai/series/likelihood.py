"""Shape and scale of greatest likelihood of Weibull's and the generalised Pareto distribution above a lower end.

Both reduce to one unknown, which is found to rounding: the general fits of :mod:`scipy.stats` search two unknowns to a
loose tolerance and take a thousand times longer, too long for the hundreds of fits behind an interval.
"""

from __future__ import annotations

import math

import numpy as np

from moyai.core.arrays import Array
from moyai.core.errors import ConvergenceError
from moyai.series.intervals import student_quantile

_STEPS = 100


def weibull_likelihood(excess: Array) -> tuple[float, float]:
    """Return shape and scale of ``1 - exp(-(x / scale)^shape)`` [eq:extremes-weibull].

    Parameters
    ----------
    excess : ndarray (n,)
        Values above the lower end, all greater than 0, not all equal.

    Raises
    ------
    ConvergenceError
        Where the likelihood has no maximum: values that are all equal.
    """
    logs = np.log(excess)
    top, mean, spread = float(logs.max()), float(logs.mean()), float(logs.std())
    # The logarithm of Weibull values scatters by pi / sqrt(6) over the shape
    shape = 1.28 / spread if top > float(logs.min()) else 0.0
    for _ in range(_STEPS if shape > 0.0 else 0):
        weight = np.exp(shape * (logs - top))
        total = float(weight.sum())
        first, second = float(weight @ logs) / total, float(weight @ (logs * logs)) / total
        step = (first - 1.0 / shape - mean) / (second - first * first + 1.0 / shape**2)
        shape = max(shape - step, 0.2 * shape)
        if abs(step) <= 1e-12 * shape:
            return shape, math.exp(top + math.log(float(np.mean(np.exp(shape * (logs - top))))) / shape)
    raise ConvergenceError(
        "the likelihood of the Weibull fit has no maximum", parameter="values", remedy="give values that differ"
    )


def pareto_likelihood(excess: Array) -> tuple[float, float]:
    """Return shape and scale of ``1 - (1 + shape x / scale)^(-1 / shape)`` [eq:extremes-pareto].

    Along Grimshaw's (1993) line of one unknown, shape over scale. A shape down to -0.95 is found: below -1 the
    likelihood grows without end as the upper end of the distribution meets the largest value.

    Parameters
    ----------
    excess : ndarray (n,)
        Values above the threshold, all greater than 0, not all equal.

    Raises
    ------
    ConvergenceError
        Where the likelihood has no maximum.
    """
    unit = float(np.mean(excess))
    x = excess / unit
    largest = float(np.max(x))

    def shape_of(theta: float) -> float:
        return float(np.mean(np.log1p(theta * x)))

    def cost(theta: float) -> float:
        # Less the profile likelihood of theta = shape / scale, for each value; the exponential is its limit at zero
        if abs(theta) < 1e-7:
            return math.log(float(np.mean(x))) + 1.0
        shape = shape_of(theta)
        ratio = shape / theta
        return math.log(ratio) + shape + 1.0 if ratio > 0.0 else math.inf

    low = -1.0 / largest * (1.0 - 1e-6)
    grid = np.concatenate([low * np.geomspace(1.0, 1e-4, 60), [0.0], np.geomspace(1e-4, 50.0, 80)])
    shapes = np.log1p(np.outer(grid, x)).mean(axis=1)
    values = np.full(grid.size, math.log(float(np.mean(x))) + 1.0)
    moved = grid != 0.0
    values[moved] = np.log(shapes[moved] / grid[moved]) + shapes[moved] + 1.0
    values[shapes <= -0.95] = math.inf
    best = int(np.argmin(values))
    if not math.isfinite(values[best]) or best == grid.size - 1:
        raise ConvergenceError(
            "the likelihood of the generalised Pareto fit has no maximum",
            parameter="values",
            remedy="choose another threshold, or a Weibull fit",
        )
    from scipy.optimize import minimize_scalar

    lower, upper = grid[max(best - 1, 0)], grid[best + 1]
    found = minimize_scalar(cost, bounds=(lower, upper), method="bounded", options={"xatol": 1e-12})
    theta = float(found.x) if found.fun <= values[best] else float(grid[best])
    if abs(theta) < 1e-7:
        return 0.0, unit
    shape = shape_of(theta)
    return shape, shape / theta * unit


def pareto_level_bounds(excess: Array, probability: float, confidence: float) -> tuple[float, float]:
    """Return the bounds of the excess that is exceeded with a probability, by its profile [eq:extremes-profile].

    Parameters
    ----------
    excess : ndarray (n,)
        Values above the threshold, three or more, not all equal.
    probability : float
        With which a value exceeds the level, between 0 and 1.
    confidence : float
        Of the bounds.

    Raises
    ------
    ConvergenceError
        Where the likelihood has no maximum.
    """
    from scipy.special import lambertw

    shape, scale = pareto_likelihood(excess)
    count, unit = excess.size, float(np.mean(excess))
    x, end = excess / unit, -unit / float(np.max(excess))
    least = -count * (math.log(scale / unit) + shape + 1.0) - 0.5 * student_quantile(confidence, count - 2) ** 2
    # shape over scale, from the end of the distribution at the largest value to a tail that is all but flat
    theta = np.concatenate([end * (1.0 - np.geomspace(1e-9, 1.0 - 1e-5, 1000)), np.geomspace(1e-5, 1e6, 2000)])
    total = np.array([float(np.sum(np.log1p(one * x))) for one in theta])
    # n ln u - u = T, u = total / shape, bounds the shape for each theta
    wanted = -np.exp((least - count * np.log(theta / total) + total) / count) / count
    reached = wanted >= -math.exp(-1.0)
    theta, total, wanted = theta[reached], total[reached], wanted[reached]
    shapes = [np.maximum(total / (-count * lambertw(wanted, branch).real), -1.0) for branch in (0, -1)]
    levels = [np.expm1(-one * math.log(probability)) / theta for one in shapes]
    return unit * float(np.min(levels)), unit * float(np.max(levels))
