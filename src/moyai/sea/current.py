"""Current profiles over depth: uniform, power law, table; components across a structure and depth means.

A profile gives a horizontal velocity for every height z. Above still water it keeps its surface value. The means over
a part of the depth are exact integrals, not samples [eq:sea-current-mean].
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from moyai.core.arrays import Array
from moyai.core.errors import InputError
from moyai.core.single import plain
from moyai.sea.water import Water, check_water

_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(16)


class CurrentProfile(ABC):
    """A steady horizontal current that depends on height only."""

    @abstractmethod
    def velocity(self, z: ArrayLike) -> Array:
        """Return the velocity (x, y) [m/s] at heights z [m], shape (*z.shape, 2).

        Parameters
        ----------
        z : array_like (...)
            Heights above still water [m].
        """

    @property
    def everywhere(self) -> Array | None:
        """The velocity (x, y) that holds at every height [m/s], ``None`` where it varies."""
        return None

    @abstractmethod
    def _breaks(self, z_bottom: float, z_top: float) -> Array:
        """Return the limits and the heights between which the profile is smooth."""

    def speed(self, z: ArrayLike) -> Any:
        """Return the speed [m/s] at heights z [m], a float for one height.

        Parameters
        ----------
        z : array_like (...)
            Heights above still water [m].
        """
        return plain(np.hypot(*np.moveaxis(self.velocity(z), -1, 0)))

    def component(self, z: ArrayLike, heading: float) -> Any:
        """Return the component along ``heading`` [rad] [m/s]: for a structure, the heading of its normal.

        Parameters
        ----------
        z : array_like (...)
            Heights above still water [m].
        heading : float
            Of the axis, from +x towards +y [rad].
        """
        return plain(self.velocity(z) @ np.array([math.cos(heading), math.sin(heading)]))

    def in_depth(self, water_depth: float) -> CurrentProfile:
        """Return the current at another water level: the same heights below the surface; a power law reaches the bed.

        Parameters
        ----------
        water_depth : float
            [m].
        """
        return self

    def _panels(self, z_bottom: float, z_top: float) -> tuple[Array, Array]:
        _check_range(z_bottom, z_top)
        edges = self._breaks(z_bottom, z_top)
        half = 0.5 * np.diff(edges)
        z = (0.5 * (edges[1:] + edges[:-1]))[:, None] + half[:, None] * _NODES
        return z, half[:, None] * _WEIGHTS / (z_top - z_bottom)

    def depth_mean(self, z_bottom: float, z_top: float) -> Array:
        """Return the mean velocity (x, y) [m/s] between two heights [m].

        Parameters
        ----------
        z_bottom, z_top : float
            Heights above still water [m].

        Raises
        ------
        InputError
            For heights that are not finite, or not one above the other.
        """
        z, weights = self._panels(z_bottom, z_top)
        values: Array = np.einsum("ij,ijk->k", weights, self.velocity(z))
        return values

    def depth_mean_squared(self, z_bottom: float, z_top: float, heading: float | None = None) -> float:
        """Return the mean square [m2/s2] between two heights [m], of the speed or of the component along a heading.

        Parameters
        ----------
        z_bottom, z_top : float
            Heights above still water [m].
        heading : float, optional
            Of the component, from +x towards +y [rad]; the speed when left out.

        Raises
        ------
        InputError
            For heights that are not finite, or not one above the other.
        """
        z, weights = self._panels(z_bottom, z_top)
        values = self.speed(z) if heading is None else self.component(z, heading)
        return float(np.sum(weights * values**2))

    def depth_mean_drag(self, z_bottom: float, z_top: float, heading: float) -> float:
        """Return the mean of u |u| [m2/s2] between two heights [m], u the component along ``heading`` [rad].

        This is what a quadratic load sees when the current turns over the depth.

        Parameters
        ----------
        z_bottom, z_top : float
            Heights above still water [m].
        heading : float
            From +x towards +y [rad].

        Raises
        ------
        InputError
            For heights that are not finite, or not one above the other.
        """
        z, weights = self._panels(z_bottom, z_top)
        values = self.component(z, heading)
        return float(np.sum(weights * values * np.abs(values)))


def _check_range(z_bottom: float, z_top: float) -> None:
    if not (math.isfinite(z_bottom) and math.isfinite(z_top) and z_bottom < z_top):
        raise InputError(
            f"range of heights {z_bottom:g} to {z_top:g} m",
            parameter="z_bottom",
            allowed="z_bottom below z_top, finite",
        )


@dataclass(frozen=True)
class UniformCurrent(CurrentProfile):
    """The same current at every height; see :func:`uniform`.

    Examples
    --------
    >>> import math
    >>> from moyai.sea.current import UniformCurrent
    >>> tide = UniformCurrent(0.5, heading=math.radians(90.0))
    >>> tide.velocity(-3.0).round(3).tolist()                            # towards +y [m/s]
    [0.0, 0.5]
    """

    current_speed: float
    heading: float

    def velocity(self, z: ArrayLike) -> Array:
        """Return the velocity (x, y) [m/s], shape (*z.shape, 2).

        Parameters
        ----------
        z : array_like (...)
            Heights above still water [m]; only their shape counts.
        """
        return np.broadcast_to(self.everywhere, (*np.shape(z), 2)).copy()

    @property
    def everywhere(self) -> Array:
        """The velocity (x, y) at every height [m/s]."""
        return self.current_speed * np.array([math.cos(self.heading), math.sin(self.heading)])

    def _breaks(self, z_bottom: float, z_top: float) -> Array:
        return np.array([z_bottom, z_top])


@dataclass(frozen=True)
class PowerLawCurrent(CurrentProfile):
    """U (1 + z/h)^exponent; see :func:`power_law`.

    Examples
    --------
    >>> from moyai.sea.current import PowerLawCurrent
    >>> tide = PowerLawCurrent(1.0, exponent=1.0 / 7.0, heading=0.0, water_depth=10.0)
    >>> round(tide.speed(-5.0), 3)                                       # 0.5^(1/7) of the surface speed [m/s]
    0.906
    """

    surface_speed: float
    exponent: float
    heading: float
    water_depth: float

    def in_depth(self, water_depth: float) -> CurrentProfile:
        """Return the same power law over another depth [m].

        Parameters
        ----------
        water_depth : float
            Greater than 0 [m].
        """
        return replace(self, water_depth=float(water_depth))

    def _relative(self, z: ArrayLike) -> Array:
        level = np.asarray(z, dtype=np.float64)
        _check_above_bed(level, -self.water_depth)
        return np.clip(1.0 + level / self.water_depth, 0.0, 1.0)

    def velocity(self, z: ArrayLike) -> Array:
        """Return the velocity (x, y) [m/s], shape (*z.shape, 2).

        Parameters
        ----------
        z : array_like (...)
            Heights above still water [m]; above it the surface velocity is kept.

        Raises
        ------
        InputError
            For a height below the bed.
        """
        size = self.surface_speed * self._relative(z) ** self.exponent
        return np.stack([size * math.cos(self.heading), size * math.sin(self.heading)], axis=-1)

    def _breaks(self, z_bottom: float, z_top: float) -> Array:
        return np.array([z_bottom, z_top])

    def _mean_power(self, z_bottom: float, z_top: float, exponent: float) -> float:
        """Return the mean of (1 + z/h)^exponent, in closed form: near the bed no panel resolves a root."""
        _check_range(z_bottom, z_top)
        low, high = (float(self._relative(z)) for z in (z_bottom, z_top))
        above = max(z_top, 0.0) - max(z_bottom, 0.0)
        below = self.water_depth * (high ** (exponent + 1.0) - low ** (exponent + 1.0)) / (exponent + 1.0)
        return float((below + above) / (z_top - z_bottom))

    def depth_mean(self, z_bottom: float, z_top: float) -> Array:
        """Return the mean velocity (x, y) [m/s] between two heights [m].

        Parameters
        ----------
        z_bottom, z_top : float
            Heights above still water [m].

        Raises
        ------
        InputError
            For heights that are not finite, below the bed, or not one above the other.
        """
        size = self.surface_speed * self._mean_power(z_bottom, z_top, self.exponent)
        return size * np.array([math.cos(self.heading), math.sin(self.heading)])

    def depth_mean_squared(self, z_bottom: float, z_top: float, heading: float | None = None) -> float:
        """Return the mean square [m2/s2] between two heights [m], of the speed or of the component along a heading.

        Parameters
        ----------
        z_bottom, z_top : float
            Heights above still water [m].
        heading : float, optional
            Of the component, from +x towards +y [rad]; the speed when left out.

        Raises
        ------
        InputError
            For heights that are not finite, below the bed, or not one above the other.
        """
        part = 1.0 if heading is None else math.cos(self.heading - heading)
        return (self.surface_speed * part) ** 2 * self._mean_power(z_bottom, z_top, 2.0 * self.exponent)

    def depth_mean_drag(self, z_bottom: float, z_top: float, heading: float) -> float:
        """Return the mean of u |u| [m2/s2] between two heights [m].

        Parameters
        ----------
        z_bottom, z_top : float
            Heights above still water [m].
        heading : float
            Of the component u, from +x towards +y [rad].

        Raises
        ------
        InputError
            For heights that are not finite, below the bed, or not one above the other.
        """
        sign = math.copysign(1.0, self.surface_speed * math.cos(self.heading - heading))
        return sign * self.depth_mean_squared(z_bottom, z_top, heading)


@dataclass(frozen=True, eq=False)
class TabulatedCurrent(CurrentProfile):
    """Velocity components linear between given heights; see :func:`table`.

    Examples
    --------
    >>> import numpy as np
    >>> from moyai.sea.current import TabulatedCurrent
    >>> measured = TabulatedCurrent(np.array([-10.0, 0.0]), np.array([[0.2, 0.0], [0.6, 0.0]]))
    >>> round(measured.speed(-5.0), 3)                                   # [m/s]
    0.4
    """

    z: Array
    components: Array

    def velocity(self, z: ArrayLike) -> Array:
        """Return the velocity (x, y) [m/s]: end values are kept above the highest and below the lowest height.

        Parameters
        ----------
        z : array_like (...)
            Heights above still water [m].

        Returns
        -------
        ndarray (..., 2)
            x, y in site axes [m/s].
        """
        level = np.asarray(z, dtype=np.float64)
        return np.stack([np.interp(level, self.z, self.components[:, axis]) for axis in (0, 1)], axis=-1)

    def _breaks(self, z_bottom: float, z_top: float) -> Array:
        inner = self.z[(self.z > z_bottom) & (self.z < z_top)]
        return np.concatenate([[z_bottom], inner, [z_top]])

    def depth_mean_drag(self, z_bottom: float, z_top: float, heading: float) -> float:
        """Return the mean of u |u| [m2/s2] between two heights [m], also where the component changes sign.

        Parameters
        ----------
        z_bottom, z_top : float
            Heights above still water [m].
        heading : float
            Of the component u, from +x towards +y [rad].

        Raises
        ------
        InputError
            For heights that are not finite, or not one above the other.
        """
        _check_range(z_bottom, z_top)
        edges = self._breaks(z_bottom, z_top)
        u = self.component(edges, heading)
        a, b = u[:-1], u[1:]
        # the integral of v |v| over a linear piece is |v|^3/3 taken between its ends, divided by its slope
        with np.errstate(divide="ignore", invalid="ignore"):
            crossing = (np.abs(b) ** 3 - np.abs(a) ** 3) / (3.0 * (b - a))
        straight = np.sign(a + b) * (a * a + a * b + b * b) / 3.0
        pieces = np.where(a * b < 0.0, crossing, straight)
        return float(np.sum(pieces * np.diff(edges)) / (z_top - z_bottom))


def _check_above_bed(z: Array, bed: float) -> None:
    lowest = float(np.min(z)) if z.size else bed
    if lowest < bed * (1.0 + 1e-12):
        raise InputError(f"height z = {lowest:g} m is below the bed", parameter="z", allowed=f"at least {bed:g} m")


def _check_finite(**values: float) -> None:
    for name, value in values.items():
        if not math.isfinite(value):
            raise InputError(f"{name} is {value:g}", parameter=name, allowed="finite")


def uniform(speed: float, heading: float) -> CurrentProfile:
    """Return a current that is the same at every height.

    Parameters
    ----------
    speed : float
        [m/s]; negative means against ``heading``.
    heading : float
        Direction towards which it flows [rad].

    Returns
    -------
    CurrentProfile
        The same velocity [m/s] at all heights z.

    Raises
    ------
    InputError
        When speed or heading is not finite.

    Examples
    --------
    >>> import math
    >>> from moyai.sea import current
    >>> tide = current.uniform(0.5, heading=math.pi / 2.0)
    >>> tide.velocity(-3.0).round(6).tolist()                            # x, y [m/s]
    [0.0, 0.5]
    """
    _check_finite(speed=speed, heading=heading)
    return UniformCurrent(float(speed), float(heading))


def power_law(surface_speed: float, exponent: float, heading: float, water: Water) -> CurrentProfile:
    """Return the power-law profile U (1 + z/h)^exponent [eq:sea-current-power].

    Parameters
    ----------
    surface_speed : float
        Speed at still water [m/s].
    exponent : float
        [-], greater than 0; 1/7 for tidal currents by common practice.
    heading : float
        Direction towards which it flows [rad].
    water : Water
        Depth, finite.

    Returns
    -------
    CurrentProfile
        Velocities [m/s] at heights z, over the depth of ``water``.

    Raises
    ------
    InputError
        When the depth is infinite, the exponent not positive, or speed or heading not finite.

    Examples
    --------
    >>> from moyai.sea import Water, current
    >>> tide = current.power_law(1.0, exponent=1.0 / 7.0, heading=0.0, water=Water(10.0, 1025.0, 9.81))
    >>> round(tide.speed(-5.0), 4), tide.speed(0.0)                      # 0.5^(1/7), at mid-depth and surface [m/s]
    (0.9057, 1.0)
    """
    check_water(water)
    _check_finite(surface_speed=surface_speed, heading=heading)
    if not (math.isfinite(exponent) and exponent > 0.0):
        raise InputError(f"exponent is {exponent:g}", parameter="exponent", allowed="greater than 0, for example 1/7")
    if math.isinf(water.depth):
        raise InputError(
            "a power law needs a finite depth",
            parameter="water",
            remedy="use a uniform current or a table in deep water",
        )
    return PowerLawCurrent(float(surface_speed), float(exponent), float(heading), water.depth)


def table(z: ArrayLike, speed: ArrayLike, heading: ArrayLike) -> CurrentProfile:
    """Return a current that is linear between given heights.

    Parameters
    ----------
    z : array_like
        Heights above still water [m], strictly increasing or strictly decreasing, none above 0.
    speed : array_like
        Speeds [m/s].
    heading : float or array_like
        Directions towards which it flows [rad]; velocity components, not angles, are interpolated.

    Returns
    -------
    CurrentProfile
        Velocities [m/s] at heights z; above the highest and below the lowest height those of the end.

    Raises
    ------
    InputError
        When the table is empty, not monotonic, above still water, of unequal lengths or holds NaN; the message names
        the row (from 1).

    Examples
    --------
    >>> from moyai.sea import current
    >>> tide = current.table(z=[0.0, -10.0], speed=[1.0, 0.4], heading=0.0)
    >>> round(tide.speed(-5.0), 3)                                       # [m/s]
    0.7
    """
    level = np.atleast_1d(np.array(z, dtype=np.float64))
    size = np.atleast_1d(np.array(speed, dtype=np.float64))
    turn = np.array(heading, dtype=np.float64)
    if level.ndim != 1 or level.size == 0 or size.shape != level.shape or turn.shape not in ((), level.shape):
        raise InputError(
            f"current table with {level.size} heights, {size.size} speeds, {turn.size} headings",
            parameter="speed",
            allowed="columns of equal length, at least one row",
        )
    turn = np.broadcast_to(turn, level.shape)
    for name, values in (("z", level), ("speed", size), ("heading", turn)):
        if not np.isfinite(values).all():
            row = int(np.argmin(np.isfinite(values))) + 1
            raise InputError(f"row {row}: {name} is not a number", parameter=name, allowed="finite")
    if (level > 0.0).any():
        row = int(np.argmax(level > 0.0)) + 1
        raise InputError(f"row {row}: z = {level[row - 1]:g} m is above still water", parameter="z", allowed="z <= 0")
    step = np.diff(level)
    rising = level[-1] > level[0] if level.size > 1 else True
    if level.size > 1 and not ((step > 0.0).all() if rising else (step < 0.0).all()):
        wrong = step <= 0.0 if rising else step >= 0.0
        row = int(np.argmax(wrong)) + 2
        raise InputError(
            f"row {row}: z = {level[row - 1]:g} m after {level[row - 2]:g} m",
            parameter="z",
            allowed="heights strictly increasing or strictly decreasing",
        )
    order = slice(None) if rising else slice(None, None, -1)
    components = np.stack([size * np.cos(turn), size * np.sin(turn)], axis=-1)
    ordered, values = level[order].copy(), components[order].copy()
    for array in (ordered, values):
        array.setflags(write=False)
    return TabulatedCurrent(ordered, values)
