"""Straight members in space: axes across them, strips, wetted share."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike

from moyai.core.arrays import Array
from moyai.core.errors import InputError
from moyai.morison.sections import MemberSection


@dataclass(frozen=True, eq=False)
class StraightMember:
    """A straight member between two points.

    Raises
    ------
    InputError
        When an end is not finite or both coincide.

    Examples
    --------
    >>> from moyai.morison import StraightMember, sections
    >>> member = StraightMember(start=(0.0, 0.0, -4.0), end=(3.0, 0.0, 0.0), section=sections.circle(0.5))
    >>> member.length, member.lowest                                     # [m]
    (5.0, -4.15)
    """

    #: One end (x, y, z) [m], z above the reference level of the caller.
    start: tuple[float, float, float]
    #: The other end (x, y, z) [m], z above the same level.
    end: tuple[float, float, float]
    #: In axes of the section; see :attr:`axes`.
    section: MemberSection
    #: Angle by which the section is turned about the member, from the first towards the second axis [rad].
    section_angle: float = 0.0

    def __post_init__(self) -> None:
        for name in ("start", "end"):
            point = tuple(float(value) for value in getattr(self, name))
            if len(point) != 3 or not all(math.isfinite(value) for value in point):
                raise InputError(f"{name} of the member is {point}", parameter=name, allowed="three finite numbers")
            object.__setattr__(self, name, point)
        if self.length <= 0.0:
            raise InputError("both ends of the member coincide", parameter="end")
        if not math.isfinite(self.section_angle):
            raise InputError(f"section_angle is {self.section_angle}", parameter="section_angle", allowed="finite")

    @property
    def length(self) -> float:
        """Length l [m]."""
        return math.dist(self.start, self.end)

    @property
    def inclination(self) -> float:
        """Angle between the member and the horizontal [rad], 0 to pi/2."""
        return math.asin(min(1.0, abs(self.end[2] - self.start[2]) / self.length))

    @cached_property
    def axes(self) -> Array:
        """Unit vectors (3, 3): first axis, second axis, member axis, in site axes [-].

        The second axis is the direction across the member closest to upwards; the first one is horizontal and leans
        towards +x (towards +y for a member along x). An upright member has its first axis along +x, the second along
        -y. Neither depends on which end is named first.
        """
        along = (np.asarray(self.end) - np.asarray(self.start)) / self.length
        if math.hypot(along[0], along[1]) < 1e-9:
            first = np.array([1.0, 0.0, 0.0])
            along = np.array([0.0, 0.0, 1.0])
            return np.stack([first, np.cross(first, along), along])
        second = np.array([0.0, 0.0, 1.0]) - along[2] * along
        second /= np.linalg.norm(second)
        first = np.cross(along, second)
        if first[0] < -1e-12 or (abs(first[0]) <= 1e-12 and first[1] < 0.0):
            first, along = -first, -along
        return np.stack([first, second, along])

    @cached_property
    def placed_section(self) -> MemberSection:
        """Section turned by ``section_angle``, in the axes of :attr:`axes`."""
        return self.section.turned(self.section_angle)

    def strips(self, count: int) -> Strips:
        """Cut the member into equal strips.

        Parameters
        ----------
        count : int
            At least 1.

        Raises
        ------
        InputError
            For fewer than one strip.
        """
        if count < 1:
            raise InputError(f"{count} strips", parameter="strips", allowed="at least 1")
        share = (np.arange(count) + 0.5) / count
        start, end = np.asarray(self.start), np.asarray(self.end)
        first, second, along = self.axes
        aside = self.placed_section.contour.centroid
        # the outline of a section need not be drawn about its centroid, where the water pushes
        centres = start + share[:, None] * (end - start) + aside[0] * first + aside[1] * second
        low, high = self._reach
        half = 0.5 * abs(along[2]) * self.length / count + 0.5 * (high - low)
        return Strips(centres, self.length / count, half, 0.5 * (high + low) - float(aside[1] * second[2]))

    @property
    def _reach(self) -> tuple[float, float]:
        """Heights of the lowest and the highest point of the section above the axis [m]."""
        # the first axis is level; of an upright member the second one is too
        _, _, low, high = self.placed_section.contour.bounds
        rise = max(0.0, float(self.axes[1][2]))
        return rise * low, rise * high

    def shifted(self, height: float) -> StraightMember:
        """Return the member moved upwards by ``height`` [m].

        Parameters
        ----------
        height : float
            Positive upwards [m].
        """
        return StraightMember(
            (self.start[0], self.start[1], self.start[2] + height),
            (self.end[0], self.end[1], self.end[2] + height),
            self.section,
            self.section_angle,
        )

    @property
    def highest(self) -> float:
        """Highest point, section included [m]."""
        return max(self.start[2], self.end[2]) + self._reach[1]

    @property
    def lowest(self) -> float:
        """Lowest point, section included [m]."""
        return min(self.start[2], self.end[2]) + self._reach[0]


@dataclass(frozen=True, eq=False)
class Strips:
    """Equal strips of a member."""

    #: Centroids of the section in the middle of each strip [m]; shape (strips, 3).
    centres: Array
    #: Of one strip [m].
    length: float
    #: Half of the vertical extent of a strip, section included [m].
    half_height: float
    #: Height of the middle of that extent above the centroid [m].
    middle: float = 0.0

    def wet_share(self, elevation: ArrayLike) -> Array:
        """Return the share of each strip below the momentary surface, 0 to 1 [eq:morison-wet-share].

        Parameters
        ----------
        elevation : array_like, shape (times, strips)
            Surface above each strip [m].
        """
        eta = np.asarray(elevation, dtype=float)
        level = self.centres[:, 2] + self.middle
        if self.half_height <= 0.0:
            return (eta >= level).astype(float)
        share = (eta - level + self.half_height) / (2.0 * self.half_height)
        return np.asarray(np.clip(share, 0.0, 1.0))
