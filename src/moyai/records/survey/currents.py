"""Currents: block means and the component normal to a structure."""

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
    #: ``x``, ``y``: Vector means [m/s]; NaN in blocks with too few samples.
    x: Array
    #: See ``x``.
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
