"""Sections of members: contour, widths across the flow, inertia coefficients, common shapes."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike

from moyai.core.errors import InputError
from moyai.morison.contour import Contour
from moyai.morison.inertia import InertiaCoefficients, inertia_coefficients


@dataclass(frozen=True, eq=False)
class MemberSection:
    """The section of a straight member.

    Examples
    --------
    >>> from moyai.morison import sections
    >>> pipe = sections.circle(0.5)
    >>> round(pipe.area, 4), pipe.breadth, pipe.is_circle                # [m2], [m]
    (0.1963, 0.5, True)
    """

    #: Outline in axes of the section: first axis across the member (for a horizontal member along the crests the
    #: direction of the waves), second axis upwards.
    contour: Contour
    #: Shape in words.
    name: str

    @property
    def area(self) -> float:
        """Area A [m2]."""
        return self.contour.area

    @property
    def extents(self) -> tuple[float, float]:
        """Extent along the first and the second axis [m] (B and H of the literature)."""
        left, right, low, high = self.contour.bounds
        return right - left, high - low

    @property
    def drag_widths(self) -> tuple[float, float]:
        """Width that flow along the first and the second axis meets [m]: H for x, B for z."""
        along, up = self.extents
        return up, along

    @property
    def breadth(self) -> float:
        """Larger extent [m]: the length of the Keulegan-Carpenter number of the circulation law."""
        return max(self.extents)

    @cached_property
    def is_circle(self) -> bool:
        """Whether the contour is a circle."""
        first, second = self.extents
        return len(self.contour.vertices) == 2 and abs(first - second) < 1e-9 * first and self.name == "circle"

    @cached_property
    def inertia(self) -> InertiaCoefficients:
        """Ideal inertia coefficients, solved once."""
        return inertia_coefficients(self.contour)

    def turned(self, angle: float) -> MemberSection:
        """Return the section turned counter-clockwise by ``angle`` [rad] (from the first to the second axis).

        Parameters
        ----------
        angle : float
            [rad].
        """
        return MemberSection(self.contour.turned(angle), self.name)


def _positive(**lengths: float) -> None:
    for name, value in lengths.items():
        if not (math.isfinite(value) and value > 0.0):
            raise InputError(f"{name} is {value:g} m", parameter=name, allowed="greater than 0 m")


def circle(diameter: float) -> MemberSection:
    """Return a circular section.

    Parameters
    ----------
    diameter : float
        [m].

    Returns
    -------
    MemberSection
        Its axis at the origin.

    Raises
    ------
    InputError
        For a diameter that is not positive.

    Examples
    --------
    >>> from moyai.morison import sections
    >>> round(sections.circle(1.0).area, 4)                              # pi / 4 [m2]
    0.7854
    """
    _positive(diameter=diameter)
    half = 0.5 * diameter
    return MemberSection(Contour(np.array([(-half, 0.0), (half, 0.0)]), np.array([1.0, 1.0])), "circle")


def rectangle(width: float, height: float) -> MemberSection:
    """Return a rectangle, ``width`` along the first axis, ``height`` along the second.

    Parameters
    ----------
    width, height : float
        [m].

    Returns
    -------
    MemberSection
        Its middle at the origin.

    Raises
    ------
    InputError
        For a side that is not positive.

    Examples
    --------
    >>> from moyai.morison import sections
    >>> sections.rectangle(2.0, 1.0).drag_widths                         # met by flow along both axes [m]
    (1.0, 2.0)
    """
    _positive(width=width, height=height)
    b, h = 0.5 * width, 0.5 * height
    return MemberSection(
        Contour(np.array([(-b, -h), (b, -h), (b, h), (-b, h)])), "square" if width == height else "rectangle"
    )


def rounded_rectangle(width: float, height: float, corner_radius: float) -> MemberSection:
    """Return a rectangle whose four corners are quarter circles.

    Parameters
    ----------
    width, height : float
        [m].
    corner_radius : float
        [m], less than half of the smaller side.

    Returns
    -------
    MemberSection
        Its middle at the origin.

    Raises
    ------
    InputError
        When a size is not positive, or the radius reaches half of the smaller side (then it is a circle or a stadium:
        use slightly less, or arcs through :func:`polygon`).

    Examples
    --------
    >>> from moyai.morison import sections
    >>> round(sections.rounded_rectangle(2.0, 1.0, corner_radius=0.2).area, 4)   # 2 - (4 - pi) 0.2^2 [m2]
    1.9657
    """
    _positive(width=width, height=height, corner_radius=corner_radius)
    b, h, r = 0.5 * width, 0.5 * height, corner_radius
    if not r < min(b, h):
        raise InputError(f"corner_radius is {r:g} m", parameter="corner_radius", allowed=f"less than {min(b, h):g} m")
    quarter = math.tan(math.pi / 8.0)
    points = [(-b + r, -h), (b - r, -h), (b, -h + r), (b, h - r), (b - r, h), (-b + r, h), (-b, h - r), (-b, -h + r)]
    return MemberSection(Contour(np.array(points), np.array([0.0, quarter] * 4)), "rounded rectangle")


def polygon(points: ArrayLike, bulges: ArrayLike | None = None, name: str = "polygon") -> MemberSection:
    """Return a section through ``points`` (n, 2), with arcs where ``bulges`` (tan(sweep / 4)) say so.

    Parameters
    ----------
    points : array_like, shape (n, 2)
        Corners (x, z) [m]: first axis across the member, second upwards.
    bulges : array_like, shape (n,), optional
        tan(sweep / 4) of the edge that leaves each corner.
    name : str
        Shape in words.

    Returns
    -------
    MemberSection
        In the axes of the points.

    Raises
    ------
    InputError
        For points that are no closed contour: NaN, fewer than three corners (two with arcs), corners that coincide, no
        area, or edges that cross.

    Examples
    --------
    >>> from moyai.morison import sections
    >>> sections.polygon([(0.0, 0.0), (2.0, 0.0), (0.0, 1.0)], name="triangle").area   # [m2]
    1.0
    """
    given = None if bulges is None else np.asarray(bulges, dtype=float)
    return MemberSection(Contour(np.asarray(points, dtype=float), given), name)
