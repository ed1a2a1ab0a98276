"""The bed under a network: flat, or with levels on a grid."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike

from moyai.core.arrays import Array, BoolArray
from moyai.core.errors import InputError
from moyai.flexible.ground_kernel import ROUNDING, levels


def _require(ok: bool, message: str, path: str, allowed: str) -> None:
    if not ok:
        raise InputError(message, parameter=path, allowed=allowed)


@dataclass(frozen=True, eq=False)
class Ground:
    """Levels of a bed on a rectangular grid: bilinear between its lines, flat beyond the outer ones.

    The slope does not jump at a grid line: it turns over a twenty-fifth of the shorter cell next to it
    [eq:flexible-ground].

    Raises
    ------
    InputError
        For fewer than two lines, lines that do not grow, or levels that are not finite or do not fit.
    """

    #: Grid lines along x [m]; shape (m,).
    x: Array
    #: Grid lines along y [m]; shape (n,).
    y: Array
    #: Height of the bed at their crossings [m]; shape (m, n).
    level: Array

    def __post_init__(self) -> None:
        for key in ("x", "y", "level"):
            given = np.array(getattr(self, key), dtype=np.float64)
            given.setflags(write=False)
            object.__setattr__(self, key, given)
        for key in ("x", "y"):
            lines = getattr(self, key)
            _require(
                lines.ndim == 1 and lines.size >= 2 and bool(np.isfinite(lines).all() and np.all(np.diff(lines) > 0.0)),
                f"the grid lines along {key} do not grow", f"bed.ground.{key}", "two or more finite, growing numbers",
            )  # fmt: skip
        _require(
            self.level.shape == (self.x.size, self.y.size) and bool(np.isfinite(self.level).all()),
            f"levels of shape {self.level.shape} on a grid of {self.x.size} by {self.y.size} lines",
            "bed.ground.level", "a finite level at every crossing",
        )  # fmt: skip

    @classmethod
    def of_rows(cls, rows: Array) -> Ground:
        """Return the ground of rows x, y, level [m], one a crossing of the grid lines, in any order.

        Raises
        ------
        InputError
            When a crossing is named twice or left out.
        """
        x, i = np.unique(rows[:, 0], return_inverse=True)
        y, j = np.unique(rows[:, 1], return_inverse=True)
        known = np.zeros((x.size, y.size), dtype=np.int64)
        np.add.at(known, (i, j), 1)
        odd = np.argwhere(known != 1)
        if odd.size:
            a, b = odd[0]
            said = "twice" if known[a, b] > 1 else "nowhere"
            raise InputError(
                f"x = {x[a]:g} m, y = {y[b]:g} m is given {said} in a grid of {x.size} by {y.size} lines",
                parameter="bed.ground", allowed="every crossing of the grid lines once",
            )  # fmt: skip
        level = np.empty(known.shape)
        level[i, j] = rows[:, 2]
        return cls(x, y, level)

    def beyond(self, place: Array) -> BoolArray:
        """Whether places (n, 2 or 3) stand outside the grid."""
        x, y = place[:, 0], place[:, 1]
        return np.asarray((x < self.x[0]) | (x > self.x[-1]) | (y < self.y[0]) | (y > self.y[-1]))

    @property
    def rounding(self) -> float:
        """By how much the turn of the slopes at grid lines moves the bed at most [m]."""
        most = 0.0
        for lines, level in ((self.x, self.level), (self.y, self.level.T)):
            cell = np.diff(lines)[:, None]
            turn = np.abs(np.diff(np.diff(level, axis=0) / cell, axis=0, prepend=0.0, append=0.0))
            size = np.minimum(np.pad(cell, ((1, 0), (0, 0)), mode="edge"), np.pad(cell, ((0, 1), (0, 0)), mode="edge"))
            most += 0.25 * ROUNDING * float(np.max(turn * size))
        return most

    @property
    def steepest(self) -> float:
        """The steepest slope [-]."""
        along = np.abs(np.diff(self.level, axis=0) / np.diff(self.x)[:, None]).max()
        across = np.abs(np.diff(self.level, axis=1) / np.diff(self.y)).max()
        return float(np.hypot(along, across))


def plane_ground(level: float, slope: tuple[float, float], reach: float) -> Ground:
    """Return a plane through ``level`` [m] at the origin that rises by ``slope`` along x and y [-], to +-``reach`` [m].

    Examples
    --------
    >>> plane_ground(-10.0, (0.1, 0.0), 100.0).level[:, 0]     # at x = -100 m and 100 m [m]
    array([-20.,   0.])
    """
    lines = np.array([-reach, reach])
    return Ground(lines, lines, level + slope[0] * lines[:, None] + slope[1] * lines)


@dataclass(frozen=True, eq=False)
class Bed:
    """A bed that carries nodes: spring and dashpot per contact area along its normal, Coulomb friction across it.

    The contact area of a node is half the unstretched length of its bars times their diameter; attached bodies add
    their own contact area. The bed pushes and never pulls [eq:flexible-bed].

    Raises
    ------
    InputError
        For a negative value or a stiffness of zero.

    Examples
    --------
    >>> from moyai.flexible import Bed
    >>> bed = Bed(level=-10.0, stiffness=1e6, friction=0.5)
    >>> bed.level, bed.friction                                          # [m], [-]
    (-10.0, 0.5)
    """

    #: Height of the bed [m]; where it varies, at the origin.
    level: float
    #: Normal stiffness per contact area [Pa/m].
    stiffness: float
    #: Normal damping per contact area [Pa s/m].
    damping: float = 0.0
    #: Coulomb coefficient [-].
    friction: float = 0.0
    #: How its height varies; flat when left out.
    ground: Ground | None = None

    @classmethod
    def on(cls, ground: Ground, stiffness: float, damping: float = 0.0, friction: float = 0.0) -> Bed:
        """Return a bed that varies; arguments as the attributes.

        Parameters
        ----------
        ground : Ground
            Levels of the bed [m].
        stiffness : float
            Normal stiffness per contact area [Pa/m].
        damping : float
            Normal damping per contact area [Pa s/m].
        friction : float
            Coulomb coefficient [-].

        Raises
        ------
        InputError
            For a negative value or a stiffness of zero.
        """
        bed = cls(0.0, stiffness, damping, friction, ground)
        return replace(bed, level=float(bed.level_at(np.zeros(3))))

    def numbers(self, fade: float = 1e-5) -> Array:
        """Return the array of :mod:`moyai.flexible.ground_kernel`, friction faded below the speed ``fade`` [m/s].

        Parameters
        ----------
        fade : float
            [m/s].
        """
        head = [self.level, self.friction, fade, 1.0]
        if self.ground is None:
            return np.array(head)
        ground = self.ground
        return np.concatenate(
            [[*head, ground.x.size, ground.y.size, ground.steepest], ground.x, ground.y, ground.level.ravel()]
        )

    def contact_at(self, place: ArrayLike) -> Array:
        """Return depth in the bed along its normal [m] and the normal at places (n, 3), shape (n, 4).

        Parameters
        ----------
        place : array_like (n, 3)
            x, y, z in site axes [m]; one place may be given as (3,).
        """
        where = np.ascontiguousarray(np.atleast_2d(np.asarray(place, dtype=np.float64)))
        out = np.empty((len(where), 4))
        if self.ground is None:
            out[:, 0], out[:, 1:] = self.level - where[:, 2], (0.0, 0.0, 1.0)
            return out
        levels(self.numbers(), where, out)
        return out

    def level_at(self, place: ArrayLike) -> Array:
        """Return the height of the bed under places (..., 2 or 3) [m].

        Parameters
        ----------
        place : array_like (..., 2 or 3)
            x, y and perhaps z in site axes [m].
        """
        where = np.asarray(place, dtype=np.float64)
        if self.ground is None:
            return np.full(where.shape[:-1], self.level)
        flat = np.zeros((where[..., 0].size, 3))
        flat[:, :2] = where[..., :2].reshape(-1, 2)
        found = self.contact_at(flat)
        return np.asarray(found[:, 0] / found[:, 3]).reshape(where.shape[:-1])

    @property
    def tolerance(self) -> float:
        """How far under it a point may stand that is meant to stand on it [m]."""
        return 1e-9 * abs(self.level) + (0.0 if self.ground is None else self.ground.rounding)

    def level_for(self, low: Array) -> float:
        """Return the height of the flat bed on which the first guess of a line with this lower end hangs [m].

        Parameters
        ----------
        low : ndarray (3,)
            Lower end of the line, site axes [m].
        """
        return self.level if self.ground is None else min(float(self.level_at(low)), float(low[2]))

    def carried(self, points: Array) -> Array:
        """Return points of a first guess (n, 3) on or above a bed that varies [m].

        Parameters
        ----------
        points : ndarray (n, 3)
            Site axes [m].
        """
        if self.ground is None:
            return points
        return np.column_stack([points[:, :2], np.maximum(points[:, 2], self.level_at(points))])

    def __post_init__(self) -> None:
        _require(math.isfinite(self.level), f"bed level is {self.level:g}", "bed.level", "a finite height")
        _require(
            math.isfinite(self.stiffness) and self.stiffness > 0.0,
            f"bed stiffness is {self.stiffness:g}", "bed.stiffness", "greater than 0",
        )  # fmt: skip
        for key in ("damping", "friction"):
            value = getattr(self, key)
            _require(math.isfinite(value) and value >= 0.0, f"bed {key} is {value:g}", f"bed.{key}", "0 or more")
