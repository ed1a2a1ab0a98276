"""Closed contours of member sections: straight and circular edges in the plane across the member.

Points of the plane are complex numbers here, x + i z, where x is the first and z the second axis of the section (for a
horizontal member along the crests: the direction of the waves and upwards).
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from moyai.core.arrays import Array, ComplexArray
from moyai.core.errors import InputError
from moyai.core.remembered import Remembered

#: Distances below this share of the size count as touching
_TOUCH = 1e-9
_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(32)


_SOUND: Remembered[None] = Remembered(64)


@dataclass(frozen=True, eq=False)
class Contour:
    """A closed contour, counter-clockwise; one given clockwise is turned round.

    Raises
    ------
    InputError
        For values that are not finite, fewer than three corners (two with arcs), corners that coincide, no area, or a
        contour that intersects itself.
    """

    #: Corners (x, z) [m]; the last need not repeat the first; shape (n, 2).
    vertices: Array
    #: tan(sweep / 4) of the edge that leaves each corner: 0 (default) is straight, 1 a counter-clockwise half circle;
    #: shape (n,).
    bulges: Array | None = None

    def __post_init__(self) -> None:
        vertices = np.array(self.vertices, dtype=float)
        if vertices.ndim != 2 or vertices.shape[1] != 2:
            raise InputError(f"corners have shape {vertices.shape}", parameter="points", allowed="(n, 2): x, z of each")
        bulges = np.zeros(len(vertices)) if self.bulges is None else np.array(self.bulges, dtype=float)
        if bulges.shape != (len(vertices),):
            raise InputError(
                f"{bulges.size} bulges for {len(vertices)} corners", parameter="bulges", allowed="one a corner"
            )
        if not (np.isfinite(vertices).all() and np.isfinite(bulges).all()):
            raise InputError("a corner or a bulge is not a finite number", parameter="points")
        if len(vertices) > 1 and (vertices[0] == vertices[-1]).all():
            vertices, bulges = vertices[:-1], bulges[:-1]
        if len(vertices) < 2 or (len(vertices) == 2 and not bulges.any()):
            raise InputError(
                f"the section has {len(vertices)} different corners", parameter="points", allowed="at least 3"
            )
        size = float(np.ptp(vertices, axis=0).max())
        steps = np.hypot(*(np.roll(vertices, -1, axis=0) - vertices).T)
        if (steps <= _TOUCH * size).any():
            where = int(np.argmin(steps))
            raise InputError(f"corners {where + 1} and {(where + 1) % len(vertices) + 1} coincide", parameter="points")
        area = _area(vertices, bulges)
        if abs(area) <= 1e-12 * size**2:
            raise InputError(
                "the section encloses no area", parameter="points", remedy="give the corners once around it"
            )
        if area < 0.0:
            vertices, bulges = vertices[::-1], -np.roll(bulges[::-1], -1)
        for name, values in (("vertices", vertices), ("bulges", bulges)):
            fixed = values.copy()
            fixed.flags.writeable = False
            object.__setattr__(self, name, fixed)
        self._refuse_crossing(size)

    def _refuse_crossing(self, size: float) -> None:
        key = self.vertices.tobytes() + np.asarray(self.bulges).tobytes()
        _SOUND.of(key.hex(), lambda: self._search_crossing(size))

    def _search_crossing(self, size: float) -> None:
        line = self.polyline()
        a, b = line, np.roll(line, -1)
        count = len(line)
        for i in range(count):
            others = np.arange(i + 2, count if i else count - 1)
            if others.size == 0:
                continue
            meet = _segments_meet(a[i], b[i], a[others], b[others], _TOUCH * size)
            if meet.any():
                raise InputError(
                    f"the section intersects itself near x = {a[i].real:g} m, z = {a[i].imag:g} m",
                    parameter="points",
                    remedy="list the corners once around the section",
                )

    @property
    def corners(self) -> ComplexArray:
        """Corners x + i z [m]."""
        return np.asarray(self.vertices[:, 0] + 1j * self.vertices[:, 1])

    @property
    def sweeps(self) -> Array:
        """Angle by which each edge turns [rad]."""
        return np.asarray(4.0 * np.arctan(np.asarray(self.bulges)))

    def positions(self, edge: NDArray[np.int64], t: Array) -> ComplexArray:
        """Return points on edges at fractions of their length, x + i z (...) [m].

        Parameters
        ----------
        edge : ndarray of int (...)
            Number of the edge, by the corner that it leaves.
        t : ndarray (...)
            0 to 1 [-].
        """
        start, end = self.corners[edge], np.roll(self.corners, -1)[edge]
        half = 0.5 * self.sweeps[edge]
        ratio = t * np.sinc(half * t / np.pi) / np.sinc(half / np.pi)
        return np.asarray(start + (end - start) * ratio * np.exp(1j * half * (t - 1.0)))

    def slopes(self, edge: NDArray[np.int64], t: Array) -> ComplexArray:
        """Return the derivative of :meth:`positions` with respect to ``t``, x + i z (...) [m].

        Parameters
        ----------
        edge : ndarray of int (...)
            Number of the edge, by the corner that it leaves.
        t : ndarray (...)
            0 to 1 [-].
        """
        start, end = self.corners[edge], np.roll(self.corners, -1)[edge]
        half = 0.5 * self.sweeps[edge]
        return np.asarray((end - start) / np.sinc(half / np.pi) * np.exp(1j * half * (2.0 * t - 1.0)))

    @cached_property
    def lengths(self) -> Array:
        """Length of each edge [m]."""
        edge = np.arange(len(self.vertices))
        return np.asarray(np.abs(self.slopes(edge, np.zeros(edge.size))))

    def polyline(self, largest_turn: float = math.radians(5.0)) -> ComplexArray:
        """Return points along the contour, x + i z [m]; chords of arcs turn at most ``largest_turn``.

        Parameters
        ----------
        largest_turn : float
            [rad].
        """
        pieces = []
        for edge, sweep in enumerate(self.sweeps):
            count = max(1, math.ceil(abs(sweep) / largest_turn))
            pieces.append(self.positions(np.full(count, edge), np.arange(count) / count))
        return np.concatenate(pieces)

    @cached_property
    def area(self) -> float:
        """Enclosed area A [m2], arcs included."""
        return _area(self.vertices, np.asarray(self.bulges))

    @cached_property
    def centroid(self) -> tuple[float, float]:
        """Centroid of the enclosed area [m], arcs included."""
        edge = np.arange(len(self.vertices))
        t, weight = 0.5 * (_NODES + 1.0), 0.5 * _WEIGHTS
        # Green's theorem about the first corner, so that a distant origin costs no digits
        place = self.positions(edge[:, None], t[None, :]) - self.corners[0]
        slope = self.slopes(edge[:, None], t[None, :])
        first = float(np.sum(0.5 * place.real**2 * slope.imag * weight)) / self.area
        second = -float(np.sum(0.5 * place.imag**2 * slope.real * weight)) / self.area
        return float(self.corners[0].real) + first, float(self.corners[0].imag) + second

    @cached_property
    def bounds(self) -> tuple[float, float, float, float]:
        """Smallest and largest x, smallest and largest z [m], arcs included."""
        line = [self.corners]
        for edge, sweep in enumerate(self.sweeps):
            if abs(sweep) > 1e-12:
                # the tangent of an arc turns evenly: it is level or upright at these fractions
                first = float(np.angle(self.slopes(np.array([edge]), np.zeros(1)))[0])
                t = (0.5 * math.pi * np.arange(-10, 11) - first) / sweep
                t = t[(t > 0.0) & (t < 1.0)]
                line.append(self.positions(np.full(t.size, edge), t))
        points = np.concatenate(line)
        return (
            float(points.real.min()), float(points.real.max()), float(points.imag.min()), float(points.imag.max())
        )  # fmt: skip

    def turned(self, angle: float) -> Contour:
        """Return the contour turned counter-clockwise by ``angle`` [rad] about the origin.

        Parameters
        ----------
        angle : float
            [rad].
        """
        if angle == 0.0:
            return self
        c, s = math.cos(angle), math.sin(angle)
        return Contour(self.vertices @ np.array([[c, s], [-s, c]]), self.bulges)


def _area(vertices: Array, bulges: Array) -> float:
    corners = vertices[:, 0] + 1j * vertices[:, 1]
    following = np.roll(corners, -1)
    triangles = 0.5 * np.sum((np.conj(corners - corners[0]) * (following - corners[0])).imag)
    chord, sweep = np.abs(following - corners), 4.0 * np.arctan(bulges)
    with np.errstate(divide="ignore", invalid="ignore"):
        radius = chord / (2.0 * np.sin(0.5 * sweep))
        segments = np.where(np.abs(sweep) > 1e-6, 0.5 * radius**2 * (sweep - np.sin(sweep)), chord**2 * sweep / 12.0)
    return float(triangles + np.sum(segments))


def _segments_meet(a: complex, b: complex, c: ComplexArray, d: ComplexArray, tolerance: float) -> NDArray[np.bool_]:
    """Whether the segment a-b meets each of the segments c-d, touching included."""

    def side(p: complex | ComplexArray, q: complex | ComplexArray, r: complex | ComplexArray) -> Array:
        span = np.asarray(q) - np.asarray(p)
        return np.asarray((np.conj(span) * (np.asarray(r) - np.asarray(p))).imag / np.abs(span))

    first, second = side(a, b, c), side(a, b, d)
    third, fourth = side(c, d, a), side(c, d, b)
    crosses = (np.minimum(first, second) < tolerance) & (np.maximum(first, second) > -tolerance)
    crosses &= (np.minimum(third, fourth) < tolerance) & (np.maximum(third, fourth) > -tolerance)
    return np.asarray(crosses & _boxes_meet(a, b, c, d, tolerance))


def _boxes_meet(a: complex, b: complex, c: ComplexArray, d: ComplexArray, tolerance: float) -> NDArray[np.bool_]:
    """Whether the boxes around the segments overlap: separates parallel segments on one line."""
    out = np.ones(c.shape, dtype=bool)
    for part in (np.real, np.imag):
        low, high = min(part(a), part(b)) - tolerance, max(part(a), part(b)) + tolerance
        out &= (np.maximum(part(c), part(d)) >= low) & (np.minimum(part(c), part(d)) <= high)
    return out
