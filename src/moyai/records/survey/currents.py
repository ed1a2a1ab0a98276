"""Currents: block means, profiles, the component normal to a structure, the principal axis."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from moyai.core.arrays import Array
from moyai.core.errors import InputError


def components(speed: ArrayLike, heading: ArrayLike) -> tuple[Array, Array]:
    """Return velocities along x and y [m/s] of a speed and a direction of travel [rad]."""
    s, angle = np.asarray(speed, dtype=float), np.asarray(heading, dtype=float)
    return np.asarray(s * np.cos(angle)), np.asarray(s * np.sin(angle))


def heading_of_bearing(bearing: ArrayLike, x_axis_bearing: float, *, coming_from: bool) -> Array:
    """Return headings [rad] of compass bearings [rad], clockwise from north.

    Parameters
    ----------
    bearing : array_like
        [rad].
    x_axis_bearing : float
        Bearing towards which +x points [rad].
    coming_from : bool
        Whether the bearing names where the waves or the wind come from (True) or where the current goes (False).
    """
    angle = x_axis_bearing - np.asarray(bearing, dtype=float) + (math.pi if coming_from else 0.0)
    return np.asarray((angle + math.pi) % (2.0 * math.pi) - math.pi)


@dataclass(frozen=True, eq=False)
class MeanCurrents:
    """Currents by block."""

    #: [s]; shape (blocks,).
    start: Array
    #: Samples in each.
    count: Array
    #: Vector mean along x [m/s]; NaN in blocks with too few samples.
    x: Array
    #: Vector mean along y [m/s]; NaN in blocks with too few samples.
    y: Array
    #: Mean of the speed [m/s].
    scalar_speed: Array
    #: Root of the mean squared departure from the vector mean [m/s].
    deviation: Array

    @property
    def speed(self) -> Array:
        """Speed of the vector mean [m/s]."""
        return np.hypot(self.x, self.y)

    @property
    def heading(self) -> Array:
        """Direction of travel of the vector mean [rad]."""
        return np.arctan2(self.y, self.x)

    def normal(self, heading: float) -> Array:
        """Return the component along ``heading`` [rad], for instance the normal of a structure [m/s]."""
        return np.asarray(self.x * math.cos(heading) + self.y * math.sin(heading))


def block_means(
    time: ArrayLike, x: ArrayLike, y: ArrayLike, *, length: float, origin: float | None = None, least: int = 1
) -> MeanCurrents:
    """Return vector means over blocks of equal length.

    Parameters
    ----------
    time : array_like
        Increasing instants [s].
    x, y : array_like
        Velocities [m/s]; NaN where missing.
    length : float
        Of a block [s].
    origin : float, optional
        Start of a block [s]; the first instant by default.
    least : int
        Blocks with fewer samples are NaN.
    """
    t = np.asarray(time, dtype=float)
    u, v = np.asarray(x, dtype=float), np.asarray(y, dtype=float)
    if not length > 0.0 or t.size == 0:
        raise InputError(f"blocks of {length:g} s over {t.size} samples", parameter="length", allowed="greater than 0")
    start = float(t[0]) if origin is None else origin
    number = np.floor((t - start) / length + 1e-9).astype(np.int64)
    first = int(number[0])
    number -= first
    known = np.isfinite(u) & np.isfinite(v)
    size = int(number[-1]) + 1
    count = np.bincount(number[known], minlength=size).astype(float)
    enough = count >= max(least, 1)

    def mean(values: Array) -> Array:
        total = np.bincount(number[known], weights=values[known], minlength=size)
        with np.errstate(invalid="ignore", divide="ignore"):
            return np.where(enough, total / count, np.nan)

    mx, my = mean(u), mean(v)
    squares = mean(u**2 + v**2)
    deviation = np.sqrt(np.maximum(squares - mx**2 - my**2, 0.0))
    starts = np.asarray(start + (first + np.arange(size)) * length, dtype=np.float64)
    return MeanCurrents(starts, count, mx, my, mean(np.hypot(u, v)), deviation)


@dataclass(frozen=True)
class PrincipalAxis:
    """Axis along which a current varies most."""

    #: Of the axis, in (-pi/2, pi/2] [rad].
    heading: float
    #: Standard deviation along the axis [m/s].
    major: float
    #: Standard deviation across the axis [m/s].
    minor: float


def principal_axis(x: ArrayLike, y: ArrayLike) -> PrincipalAxis:
    """Return the principal axis of a current record; NaN samples do not count."""
    u, v = np.asarray(x, dtype=float).reshape(-1), np.asarray(y, dtype=float).reshape(-1)
    known = np.isfinite(u) & np.isfinite(v)
    if np.count_nonzero(known) < 3:
        raise InputError(f"{np.count_nonzero(known)} samples", parameter="x", allowed="3 or more")
    values, vectors = np.linalg.eigh(np.cov(u[known], v[known]))
    heading = math.atan2(vectors[1, 1], vectors[0, 1])
    if heading <= -math.pi / 2.0:
        heading += math.pi
    elif heading > math.pi / 2.0:
        heading -= math.pi
    return PrincipalAxis(heading, math.sqrt(max(values[1], 0.0)), math.sqrt(max(values[0], 0.0)))


@dataclass(frozen=True, eq=False)
class Profile:
    """Mean profile of an acoustic profiler."""

    #: Heights of the bins above the bed or depths, as given [m].
    z: Array
    #: Mean velocity along x [m/s].
    x: Array
    #: Mean velocity along y [m/s].
    y: Array
    #: Share of samples that were good in each bin.
    share: Array
    #: Of the power law ``speed = surface_speed (z / top)^exponent`` of the speed along the mean direction; NaN where
    #: the profile does not allow it.
    exponent: float
    #: Speed of that law at the surface [m/s]; NaN where there is none.
    surface_speed: float
    #: Standard error of the exponent [-]; NaN where there is none.
    exponent_error: float
    #: Mean over the profiled height (x, y) [m/s].
    depth_mean: tuple[float, float]


def mean_profile(z: ArrayLike, x: ArrayLike, y: ArrayLike, *, top: float, least_share: float = 0.5) -> Profile:
    """Average profiles and fit a power law; equation [eq:records-power-law].

    Parameters
    ----------
    z : array_like, shape (bins,)
        Heights above the bed [m].
    x, y : array_like, shape (bins, profiles)
        Velocities [m/s]; NaN where bad.
    top : float
        Height of the surface above the bed [m]: bins above it are left out.
    least_share : float
        Bins with a smaller share of good samples are left out.
    """
    heights = np.asarray(z, dtype=float)
    u, v = np.atleast_2d(np.asarray(x, dtype=float)), np.atleast_2d(np.asarray(y, dtype=float))
    if u.shape != v.shape or u.shape[0] != heights.size:
        raise InputError(f"velocities of shape {u.shape} for {heights.size} bins", parameter="x")
    good = np.isfinite(u) & np.isfinite(v)
    share = good.mean(axis=1)
    kept = (share >= least_share) & (heights <= top) & (heights > 0.0)
    if not kept.any():
        raise InputError("no bin has enough good samples below the surface", parameter="least_share")
    with np.errstate(invalid="ignore", divide="ignore"):
        mx = np.where(kept, np.where(good, u, 0.0).sum(axis=1) / good.sum(axis=1), np.nan)
        my = np.where(kept, np.where(good, v, 0.0).sum(axis=1) / good.sum(axis=1), np.nan)
    depth_mean = (float(np.trapezoid(mx[kept], heights[kept])), float(np.trapezoid(my[kept], heights[kept])))
    span = float(heights[kept][-1] - heights[kept][0])
    depth_mean = (
        (depth_mean[0] / span, depth_mean[1] / span) if span > 0.0 else (float(mx[kept][0]), float(my[kept][0]))
    )
    along = mx * math.cos(a := math.atan2(depth_mean[1], depth_mean[0])) + my * math.sin(a)
    fit = kept & (along > 0.0)
    exponent = surface = error = math.nan
    if np.count_nonzero(fit) >= 3:
        design = np.column_stack([np.ones(np.count_nonzero(fit)), np.log(heights[fit] / top)])
        solution, *_ = np.linalg.lstsq(design, np.log(along[fit]), rcond=None)
        rest = np.log(along[fit]) - design @ solution
        variance = float(rest @ rest) / max(rest.size - 2, 1)
        error = math.sqrt(variance * float(np.linalg.inv(design.T @ design)[1, 1]))
        surface, exponent = math.exp(solution[0]), float(solution[1])
    return Profile(heights, mx, my, share, exponent, surface, error, depth_mean)
