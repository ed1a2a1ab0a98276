"""Interpolation of scattered drift velocities: a smoothing thin-plate spline, or triangles."""

from __future__ import annotations

import math
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from moyai.core.arrays import Array
from moyai.core.compiled import njit

Interpolation = Literal["spline", "triangles"]

_SMOOTHING = np.concatenate([[0.0], 10.0 ** np.arange(-4.0, 3.1, 0.5)])


def trend(points: Array, vectors: Array, deviation: Array, length: float, targets: Array) -> tuple[Array, Array]:
    """Return the mean flow plus vortex plus Stokes drift that fits best, at the particles and at the targets.

    Only what is left over is interpolated, so that the steep rise towards the section is not rounded off.

    Parameters
    ----------
    points, vectors : ndarray, shape (n, 2)
        Positions about the centre [m] and velocities [m/s].
    deviation : ndarray, shape (n,)
        Standard errors, up to a common factor; :func:`robust_deviation` keeps single wrong vectors out.
    length : float
        Breadth of the section [m].
    targets : ndarray, shape (m, 2)

    Returns
    -------
    tuple of ndarray
        Trend at the points and at the targets [m/s].
    """
    basis = _trend_basis(points, length)
    solution = _fitted(basis, vectors, deviation)
    at_points = (basis @ solution).reshape(2, -1).T
    at_targets = (_trend_basis(targets, length) @ solution).reshape(2, -1).T
    return at_points, at_targets


def _fitted(basis: Array, vectors: Array, deviation: Array) -> Array:
    """Return the factors of the columns of a basis that fit the vectors best, weighted by their standard errors."""
    scale = np.tile(1.0 / deviation, 2)
    return np.asarray(np.linalg.lstsq(basis * scale[:, None], vectors.T.ravel() * scale, rcond=None)[0])


def robust_deviation(points: Array, vectors: Array, deviation: Array, length: float) -> Array:
    """Return the standard errors, larger for particles far off the trend (Huber's weights).

    Parameters
    ----------
    points, vectors, deviation, length
        As in :func:`trend`.
    """
    columns, values = np.ascontiguousarray(_trend_basis(points, length).T), vectors.T.ravel()
    robust = deviation = np.asarray(deviation, dtype=np.float64)
    for _ in range(7):
        size = _misfit(columns, values, deviation, robust)
        median = float(np.median(size))
        if median == 0.0:
            break
        # 1.18 medians of a plane error are one standard deviation
        robust = deviation * np.sqrt(np.maximum(1.0, size / (1.5 * 0.85 * median)))
    return robust


@njit(cache=True, error_model="numpy")
def _misfit(columns: Any, values: Any, deviation: Any, robust: Any) -> Any:
    """Return how far the vectors lie off their fit by columns weighted by ``robust``, over their standard errors."""
    count, parts = deviation.size, columns.shape[0]
    left, axes, size = np.empty(2 * count), np.empty((parts, 2 * count)), np.empty(count)
    for i in range(2 * count):
        left[i] = values[i] / robust[i % count]
    for k in range(parts):
        axis = axes[k]
        for i in range(2 * count):
            axis[i] = columns[k, i] / robust[i % count]
        before = _product(axis, axis)
        _take_off(axis, axes, k)
        after = _product(axis, axis)
        # places on a line or a circle leave nothing of a column that the others hold
        scale = 1.0 / math.sqrt(after) if after > 1e-20 * before else 0.0
        for i in range(2 * count):
            axis[i] *= scale
    _take_off(left, axes, parts)
    for i in range(count):
        size[i] = math.sqrt(left[i] ** 2 + left[count + i] ** 2) * robust[i] / deviation[i]
    return size


@njit(cache=True, error_model="numpy")
def _product(one: Any, other: Any) -> float:
    total = 0.0
    for i in range(one.size):
        total += one[i] * other[i]
    return total


@njit(cache=True, error_model="numpy")
def _take_off(vector: Any, axes: Any, count: int) -> None:
    """Take the parts along the first orthonormal axes off a vector, twice for rounding."""
    for _ in range(2):
        for k in range(count):
            part = _product(axes[k], vector)
            for i in range(vector.size):
                vector[i] -= part * axes[k, i]


def _trend_basis(points: Array, length: float) -> Array:
    square = (points**2).sum(axis=1)
    around = np.column_stack([points[:, 1], -points[:, 0]]) / square[:, None]
    steep = around * (0.25 * length**2 / square[:, None]) ** 2
    count = len(points)
    one, none = np.ones(count), np.zeros(count)
    columns = [
        np.concatenate([one, none]),
        np.concatenate([none, one]),
        np.concatenate([around[:, 0], around[:, 1]]),
        np.concatenate([steep[:, 0], steep[:, 1]]),
    ]
    return np.column_stack(columns)


def outliers(
    points: Array, vectors: Array, deviation: Array, length: float, *, limit: float = 5.0
) -> NDArray[np.bool_]:
    """Return which vectors lie off their neighbours: the normalised median test [eq:streaks-outlier].

    Parameters
    ----------
    points, vectors, deviation, length
        As in :func:`trend`, which is taken off first.
    limit : float
        Distance from the median of eight neighbours, over their median distance from it.
    """
    from scipy.spatial import cKDTree

    count = min(8, len(points) - 2)
    if count < 3:
        return np.zeros(len(points), dtype=bool)
    base, _ = trend(points, vectors, robust_deviation(points, vectors, deviation, length), length, points[:1])
    rest = vectors - base
    near = np.asarray(cKDTree(points).query(points, count + 1)[1])[:, 1:]
    middle = np.median(rest[near], axis=1)
    spread = np.median(np.hypot(*(rest[near] - middle[:, None]).transpose(2, 0, 1)), axis=1)
    away = np.hypot(*(rest - middle).T)
    return np.asarray(away > limit * (spread + float(np.median(spread))))


def remainder_smoothing(points: Array, vectors: Array, deviation: Array, length: float) -> float:
    """Return the smoothing of the spline that predicts left-out particles best (by their median).

    Parameters
    ----------
    points, vectors, deviation, length
        As in :func:`trend`.
    """
    base, _ = trend(points, vectors, robust_deviation(points, vectors, deviation, length), length, points[:1])
    rest = vectors - base
    best, smallest = 0.0, np.inf
    for candidate in _SMOOTHING[1:]:
        system = _system(points, deviation, candidate)
        inverse = np.linalg.inv(system)[: len(points), : len(points)]
        left_out = (inverse @ rest) / np.diag(inverse)[:, None]
        size = float(np.median(np.hypot(left_out[:, 0], left_out[:, 1]) / deviation))
        if size < smallest * (1.0 - 1e-3):
            best, smallest = float(candidate), size
    return best


def interpolation_matrix(points: Array, targets: Array, deviation: Array, smoothing: float | None) -> Array:
    """Return the matrix that takes values at the points to values at the targets.

    Parameters
    ----------
    points : ndarray, shape (n, 2)
    targets : ndarray, shape (m, 2)
    deviation : ndarray, shape (n,)
        Standard errors, up to a common factor.
    smoothing : float or None
        Of the thin-plate spline; ``None``: linear between the corners of Delaunay's triangles, NaN outside.

    Returns
    -------
    ndarray, shape (m, n)
    """
    if smoothing is None:
        from scipy.interpolate import LinearNDInterpolator

        return np.asarray(LinearNDInterpolator(points, np.eye(len(points)))(targets))
    count = len(points)
    centre, scale = _normal(points)
    inverse = np.linalg.inv(_system(points, deviation, smoothing))[:, :count]
    rows = np.column_stack([_kernel((targets - centre) / scale, (points - centre) / scale), np.ones(len(targets))])
    rows = np.column_stack([rows, (targets - centre) / scale])
    return np.asarray(rows @ inverse)


def _system(points: Array, deviation: Array, smoothing: float) -> Array:
    """Return the matrix of the spline's coefficients [eq:streaks-spline]."""
    count = len(points)
    centre, scale = _normal(points)
    place = (points - centre) / scale
    relative = (deviation / np.median(deviation)) ** 2
    system = np.zeros((count + 3, count + 3))
    system[:count, :count] = _kernel(place, place) + np.diag((smoothing + 1e-9) * relative)
    system[:count, count] = system[count, :count] = 1.0
    system[:count, count + 1 :] = place
    system[count + 1 :, :count] = place.T
    return system


def _normal(points: Array) -> tuple[Array, float]:
    return points.mean(axis=0), float(np.ptp(points, axis=0).max())


def _kernel(first: Array, second: Array) -> Array:
    square = ((first[:, None, :] - second[None, :, :]) ** 2).sum(axis=-1)
    return np.asarray(0.5 * square * np.log(np.maximum(square, 1e-300)))
