"""A current that changes with time, and from place to place: velocities on a grid of times and places."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from moyai.core.arrays import Array
from moyai.core.errors import InputError


@dataclass(frozen=True, eq=False)
class CurrentField:
    """Velocities on a grid, joined by straight lines; beyond its ends that of the nearest grid point holds.

    Equation [eq:current-field].

    Raises
    ------
    InputError
        For times or places that do not rise, or velocities of another shape or not finite.
    """

    #: [s]; shape (t,).
    time: Array
    #: Places along x [m]; shape (a,).
    x: Array
    #: Places along y [m]; shape (b,).
    y: Array
    #: Places from still water upwards [m]; shape (c,).
    z: Array
    #: [m/s]; shape (t, a, b, c, 3).
    velocity: Array

    def __post_init__(self) -> None:
        for name in ("time", "x", "y", "z", "velocity"):
            values = np.array(getattr(self, name), dtype=float)
            values.setflags(write=False)
            object.__setattr__(self, name, values)
            if name != "velocity" and (values.ndim != 1 or not values.size or np.any(np.diff(values) <= 0.0)):
                raise InputError(f"{name} of the current does not rise", parameter=f"current.{name}")
        shape = (self.time.size, self.x.size, self.y.size, self.z.size, 3)
        if self.velocity.shape != shape or not np.isfinite(self.velocity).all():
            raise InputError(
                f"velocities of the current have the shape {self.velocity.shape}", parameter="current.velocity",
                allowed=f"{shape}, all finite",
            )  # fmt: skip

    @property
    def interval(self) -> float:
        """Time over which the velocity at a place is a straight line, a quarter of it at most [s]."""
        return 0.25 * float(np.diff(self.time).min()) if self.time.size > 1 else np.inf

    def at(self, time: float, position: Array) -> tuple[Array, Array]:
        """Return velocity [m/s] and its rate [m/s2], shape (3, n), at places (3, n) [m]."""
        first, part = _place(self.time, np.array([time]))
        step = int(first[0])
        early = self._in_space(step, position)
        if self.time.size == 1:
            return early, np.zeros_like(early)
        rate = (self._in_space(step + 1, position) - early) / (self.time[step + 1] - self.time[step])
        inside = self.time[0] <= time <= self.time[-1]
        past = part[0] * (self.time[step + 1] - self.time[step])
        return np.asarray(early + past * rate), np.asarray(rate if inside else np.zeros_like(rate))

    def _in_space(self, step: int, position: Array) -> Array:
        places = [_place(axis, values) for axis, values in zip((self.x, self.y, self.z), position)]
        out = np.zeros((3, position.shape[1]))
        for corner in np.ndindex(2, 2, 2):
            weight = np.ones(position.shape[1])
            index = []
            for side, (first, part), axis in zip(corner, places, (self.x, self.y, self.z)):
                weight = weight * (part if side else 1.0 - part)
                index.append(np.minimum(first + side, axis.size - 1))
            out += weight * self.velocity[step, index[0], index[1], index[2]].T
        return out


def _place(axis: Array, values: Array) -> tuple[np.ndarray, Array]:
    """Return the cell of each value and how far into it, the ends held."""
    if axis.size == 1:
        return np.zeros(len(values), dtype=int), np.zeros(len(values))
    held = np.clip(values, axis[0], axis[-1])
    first = np.clip(np.searchsorted(axis, held, side="right") - 1, 0, axis.size - 2)
    return first, np.asarray((held - axis[first]) / (axis[first + 1] - axis[first]))
