"""Circulation of scattered drift velocities along contours similar to the section, and its limit at the section."""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import ArrayLike, NDArray

from moyai.core.arrays import Array
from moyai.core.errors import InputError
from moyai.core.options import checks_words
from moyai.core.progress import Progress, silent
from moyai.core.validity import Notice
from moyai.records.streaks.drift_interpolation import (
    Interpolation,
    interpolation_matrix,
    outliers,
    remainder_smoothing,
    robust_deviation,
    trend,
)
from moyai.records.streaks.orbital_bias import Orbits, orbital_bias


@dataclass(frozen=True, eq=False)
class ContourCirculation:
    """Circulation around a section, about +y (clockwise with x to the right, z up)."""

    #: Sizes Bc/B of the contours.
    size_ratio: Array
    #: Circulation of each contour [m2/s]; NaN where the contour leaves the cloud of particles.
    value: Array
    #: Its standard error from drawn clouds [m2/s]; NaN at the same contours.
    deviation: Array
    #: Circulation G without the Stokes drift [m2/s].
    limit: float
    #: Confidence interval of G [m2/s].
    limit_interval: tuple[float, float]
    #: The c of G + c (B/Bc)^4 [m2/s].
    stokes_term: float
    #: Straight line through all contours at Bc/B = 1, as the paper does [m2/s].
    linear: float
    #: Confidence interval of that value [m2/s].
    linear_interval: tuple[float, float]
    #: Level of the intervals.
    confidence: float
    #: Circulation of the drawn clouds [m2/s]; shape (samples, contours).
    samples: Array
    #: Particles left out because they lie off their neighbours; shape (particles,).
    outlier: NDArray[np.bool_]
    #: What interpolation and extrapolation add, taken off ``limit`` and its interval [m2/s]; NaN where unknown.
    bias: float = math.nan
    notices: tuple[Notice, ...] = field(default_factory=tuple)


def contour_points(outline: Array, size_ratio: float, count: int = 96) -> Array:
    """Return points along a contour similar to the section, evenly spaced, the first one repeated at the end.

    Parameters
    ----------
    outline : ndarray, shape (n, 2)
        Closed outline about the centre of the section [m].
    size_ratio : float
        Bc/B.
    count : int
        Number of intervals.
    """
    closed = np.asarray(outline, dtype=float)
    if not np.allclose(closed[0], closed[-1]):
        closed = np.vstack([closed, closed[:1]])
    length = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(closed, axis=0).T))])
    # Corners stay points of the contour, so that no length is cut off
    along = np.union1d(np.linspace(0.0, length[-1], count + 1), length if len(closed) <= 12 else length[[0, -1]])
    return size_ratio * np.column_stack([np.interp(along, length, closed[:, axis]) for axis in (0, 1)])


def line_integral(points: Array, velocity: Array) -> float:
    """Return the circulation about +y by the trapezoidal rule [eq:streaks-circulation].

    Parameters
    ----------
    points : ndarray, shape (n, 2)
        Closed contour in either sense [m].
    velocity : ndarray, shape (n, 2)
        Velocity at the points [m/s].
    """
    step = np.diff(points, axis=0)
    total = float((0.5 * (velocity[1:] + velocity[:-1]) * step).sum())
    x, z = points[:, 0], points[:, 1]
    doubled_area = float((x[:-1] * z[1:] - x[1:] * z[:-1]).sum())
    # A contour of positive area runs from x to z, which is negative about +y
    return -math.copysign(total, total * doubled_area)


def extrapolate_stokes(
    size_ratio: ArrayLike, circulation: ArrayLike, *, least: float = 1.5, weights: ArrayLike | None = None
) -> tuple[float, float]:
    """Fit G + c (B/Bc)^4 to contours of Bc/B >= ``least`` [eq:streaks-extrapolation].

    The power is that of the Stokes drift around a circle [eq:streaks-stokes].

    Parameters
    ----------
    size_ratio, circulation : array_like
        Bc/B and circulation [m2/s]; unknown ones (NaN) are left out.
    least : float
        Smallest contour that takes part.
    weights : array_like, optional
        Inverse variances.

    Returns
    -------
    tuple of float
        G and c [m2/s].

    Raises
    ------
    InputError
        When fewer than two contours are left.
    """
    ratio, value, weight = _usable(size_ratio, circulation, weights, least)
    if ratio.size < 2:
        raise InputError(
            f"{ratio.size} contour(s) of Bc/B >= {least:g} with a circulation are left: the fit needs two",
            parameter="contours",
            remedy="choose larger contours, or give pictures of a larger field",
        )
    basis = np.column_stack([np.ones_like(ratio), ratio**-4.0])
    root = np.sqrt(weight)[:, None]
    solution = np.linalg.lstsq(basis * root, value * root[:, 0], rcond=None)[0]
    return float(solution[0]), float(solution[1])


def extrapolate_linear(size_ratio: ArrayLike, circulation: ArrayLike, *, weights: ArrayLike | None = None) -> float:
    """Return a straight line through all contours at Bc/B = 1, the way of the paper [m2/s].

    Raises
    ------
    InputError
        When fewer than two contours have a circulation.
    """
    ratio, value, weight = _usable(size_ratio, circulation, weights, 0.0)
    if ratio.size < 2:
        raise InputError(f"{ratio.size} contour(s) have a circulation: a line needs two", parameter="contours")
    root = np.sqrt(weight)
    slope, base = np.polyfit(ratio - 1.0, value, 1, w=root)
    return float(base) if math.isfinite(slope) else math.nan


def _usable(
    size_ratio: ArrayLike, circulation: ArrayLike, weights: ArrayLike | None, least: float
) -> tuple[Array, Array, Array]:
    ratio, value = np.asarray(size_ratio, dtype=float), np.asarray(circulation, dtype=float)
    weight = np.ones_like(ratio) if weights is None else np.asarray(weights, dtype=float)
    kept = np.isfinite(value) & np.isfinite(weight) & (ratio >= least - 1e-12)
    return ratio[kept], value[kept], weight[kept]


@checks_words
def measure_circulation(
    position: ArrayLike,
    drift: ArrayLike,
    outline: ArrayLike,
    size_ratio: ArrayLike,
    *,
    deviation: ArrayLike | None = None,
    method: Interpolation = "spline",
    least_ratio: float = 1.5,
    resamples: int = 200,
    confidence: float = 0.95,
    seed: int = 0,
    orbits: Orbits | None = None,
    progress: Progress = silent,
) -> ContourCirculation:
    """Measure the circulation around a section from scattered drift velocities.

    Parameters
    ----------
    position, drift : array_like, shape (particles, 2)
        Mean positions relative to the centre of the section [m] and drift velocities [m/s], settling and mass
        transport taken off.
    outline : array_like, shape (n, 2)
        Outline of the section about its centre [m].
    size_ratio : array_like
        Sizes Bc/B of the contours, at least two.
    deviation : array_like, optional
        Standard error of every drift velocity [m/s], for weights; all alike when absent.
    method : {"spline", "triangles"}
        Smoothing thin-plate spline over the trend of a vortex, or plain linear interpolation between neighbours.
    least_ratio : float
        Smallest contour for the fit with the Stokes term.
    resamples : int
        Number of drawn clouds behind the intervals; 0 for none.
    confidence : float
        Level of the intervals.
    seed : int
        Of the resampling.
    orbits : Orbits, optional
        The waves past the section: what the estimate adds on their exact drift is taken off [eq:streaks-bias].
    progress : Progress

    Returns
    -------
    ContourCirculation

    Raises
    ------
    InputError
        When there are too few particles, or no contour lies within their cloud.
    """
    points = np.asarray(position, dtype=float)
    vectors = np.asarray(drift, dtype=float)
    ratio = np.asarray(size_ratio, dtype=float)
    shape = np.asarray(outline, dtype=float)
    if len(points) < 12:
        raise InputError(
            f"{len(points)} drift velocities are too few for a circulation", parameter="drift", allowed="at least 12"
        )
    if ratio.size < 2 or np.any(ratio < 1.0):
        raise InputError("give at least two contours, none smaller than the section", parameter="contours")
    error = np.ones(len(points)) if deviation is None else np.asarray(deviation, dtype=float)
    length = float(np.ptp(shape[:, 0]))
    outlier = outliers(points, vectors, error, length)
    if orbits is not None:
        # a place that no orbit leads around cannot be compared with the exact drift
        outlier = outlier | np.isnan(orbits.drift(points, 0.0)[0]).any(axis=1)
    points, vectors, error = points[~outlier], vectors[~outlier], error[~outlier]
    contours = [contour_points(shape, item) for item in ratio]
    targets = np.vstack(contours)
    smoothing = remainder_smoothing(points, vectors, error, length) if method == "spline" else None

    def evaluate(place: Array, value: Array, spread: Array, robust: Array, matrix: Array | None = None) -> Array:
        if matrix is None:
            matrix = interpolation_matrix(place, targets, spread, smoothing)
        if smoothing is None:
            return _along(contours, matrix @ value)
        base, at_targets = trend(place, value, robust, length, targets)
        return _along(contours, at_targets + matrix @ (value - base))

    inside = _covered(points, contours)
    robust = robust_deviation(points, vectors, error, length)
    value = np.where(inside, evaluate(points, vectors, error, robust), np.nan)
    if not np.isfinite(value).any():
        raise InputError(
            "no contour lies within the cloud of particles",
            parameter="contours",
            remedy="choose sizes Bc/B within the pictures",
        )
    bias, exact = 0.0, np.full_like(points, np.nan)
    if orbits is not None:

        def limit_of(known: NDArray[np.bool_], place: Array, drift: Array) -> float:
            # smoothed and weighted as the measured drift is: the estimate is linear then, errors do not shift its mean
            values = np.where(inside, evaluate(place, drift, error[known], robust[known]), np.nan)
            return extrapolate_stokes(ratio, values, least=least_ratio)[0]

        bias, exact = orbital_bias(orbits, points, extrapolate_stokes(ratio, value, least=least_ratio)[0], limit_of)
    generator = np.random.default_rng(seed)
    known = np.isfinite(exact).all(axis=1)
    # drawn misfits leave the places where they are
    matrix = interpolation_matrix(points[known], targets, error[known], smoothing) if known.any() else None
    samples = np.full((resamples, ratio.size), np.nan)
    for index in range(resamples):
        progress("circulation", index, resamples)
        drawn = _resampled(points, vectors, error, exact, generator)
        samples[index] = np.where(inside, evaluate(*drawn, robust_deviation(*drawn, length), matrix), np.nan)
    if resamples:
        progress("circulation", resamples, resamples)
    summary = _summary(ratio, value, samples, least_ratio, confidence, inside, outlier)
    if orbits is None:
        return summary
    low, high = summary.limit_interval
    return replace(summary, limit=summary.limit - bias, limit_interval=(low - bias, high - bias), bias=bias)


def _resampled(
    points: Array, vectors: Array, error: Array, exact: Array, generator: np.random.Generator
) -> tuple[Array, Array, Array]:
    """Return places, drift and standard errors of a drawn cloud.

    With the exact drift known, its misfits are drawn and the places stay. Without it, particles are drawn, some twice:
    the interval then counts the error of an interpolation that misses a third of the places, and is too wide.
    """
    known = np.isfinite(exact).all(axis=1)
    if known.any():
        misfit = ((vectors - exact) / error[:, None])[known]
        drawn = misfit[generator.integers(0, len(misfit), len(misfit))]
        return points[known], exact[known] + error[known, None] * drawn, error[known]
    weight = np.bincount(generator.integers(0, len(points), len(points)), minlength=len(points)).astype(float)
    chosen = weight > 0.0
    return points[chosen], vectors[chosen], error[chosen] / np.sqrt(weight[chosen])


def _along(contours: list[Array], velocity: Array) -> Array:
    """Return the circulation along contours from the velocity at their points, one contour after the other."""
    limits = np.cumsum([0, *(len(item) for item in contours)])
    return np.array([
        line_integral(item, velocity[begin:end])
        for item, begin, end in zip(contours, limits[:-1], limits[1:], strict=True)
    ])  # fmt: skip


def _summary(
    ratio: Array,
    value: Array,
    samples: Array,
    least: float,
    confidence: float,
    inside: NDArray[np.bool_],
    outlier: NDArray[np.bool_],
) -> ContourCirculation:
    spread = np.full(ratio.size, np.nan)
    if len(samples) > 2:
        spread[inside] = samples[:, inside].std(axis=0, ddof=1)
    limit, term = extrapolate_stokes(ratio, value, least=least)
    line = extrapolate_linear(ratio, value)
    tails = (50.0 * (1.0 - confidence), 50.0 * (1.0 + confidence))
    limit_interval = line_interval = (math.nan, math.nan)
    if len(samples) > 2:
        limits = [extrapolate_stokes(ratio, item, least=least)[0] for item in samples]
        lines = [extrapolate_linear(ratio, item) for item in samples]
        limit_interval = (float(np.percentile(limits, tails[0])), float(np.percentile(limits, tails[1])))
        line_interval = (float(np.percentile(lines, tails[0])), float(np.percentile(lines, tails[1])))
    notices = []
    if not inside.all():
        left = ", ".join(f"{item:g}" for item in ratio[~inside])
        notices.append(
            Notice(
                "contour-outside-particles",
                f"contours of Bc/B = {left} leave the cloud of particles and are left out",
                value=float(ratio[~inside].min()),
                limit=float(ratio[inside].max()),
                remedy="choose smaller contours, or give pictures of a larger field",
            )
        )
    used = ratio[inside & (ratio >= least - 1e-12)]
    if used.size < 3:
        notices.append(
            Notice(
                "contours-few",
                f"{used.size} contours of Bc/B >= {least:g} give the circulation at the section: two unknowns are "
                "fitted to two values, so that no misfit shows",
                value=float(used.size),
                limit=3.0,
                remedy="choose more contours beyond this size, or give pictures of a larger field",
            )
        )
    return ContourCirculation(
        ratio,
        value,
        spread,
        limit,
        limit_interval,
        term,
        line,
        line_interval,
        confidence,
        samples,
        outlier,
        notices=tuple(notices),
    )


def _covered(points: Array, contours: list[Array]) -> NDArray[np.bool_]:
    """Whether each contour lies within the hull of the particles."""
    from scipy.spatial import Delaunay, QhullError

    try:
        hull = Delaunay(points)
    except QhullError:
        raise InputError("the particles lie on one line", parameter="drift") from None
    return np.array([bool(np.all(hull.find_simplex(item) >= 0)) for item in contours])
