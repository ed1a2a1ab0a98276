"""Ends and sides of units, and which of them face each other, in whatever order the units are listed.

A unit has four faces in plan: two ends and two sides. Two units meet at the pair of faces that stand nearest and most
squarely to each other [eq:units-faces]. The axes of what stands there halve the angle between both faces
[eq:units-gap-axes]: y across the gap from the near unit to the far one, x along it, z up; in a straight row they are
those of the units. Which unit is the near one turns x and y about and nothing else.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import combinations, product

import numpy as np

from moyai.core.arrays import Array
from moyai.structures.units.model import Placement

#: Faces that are turned from each other by more than this do not face [cosine of 45 degrees, with rounding].
_SQUARE = math.cos(math.radians(45.0)) - 1e-9
#: What a side counts for against an end, in beams: where both are as near, ends meet.
_SIDE = 0.25
#: Lateral distance up to which a point counts as in front of a face [of the beam].
_EDGE = 1e-6


@dataclass(frozen=True, eq=False)
class UnitFace:
    """An end or a side of a unit in plan, row axes."""

    #: Counted from 0.
    unit: int
    #: 0: the end at +y, 1: the side at +x, 2: the side at -x, 3: the end at -y.
    kind: int
    #: On the axis of the unit [m]; shape (2,).
    middle: Array
    #: Outward; shape (2,).
    normal: Array
    #: Along the face, so that (along, normal, up) is right-handed; shape (2,).
    along: Array
    #: Where it begins along ``along`` from ``middle`` [m].
    low: float
    #: Where it ends along ``along`` from ``middle`` [m].
    high: float

    @property
    def is_end(self) -> bool:
        """Whether it is an end of the unit."""
        return self.kind in (0, 3)

    def at(self, offset: float) -> Array:
        """Return the point (2,) [m] at an offset along it."""
        return np.asarray(self.middle + offset * self.along)

    def offset(self, points: Array) -> Array:
        """Return offsets (...) [m] of points (..., 2) along it."""
        return np.asarray((points - self.middle) @ self.along)

    def before(self, points: Array) -> Array:
        """Return how far points (..., 2) stand in front of it [m]."""
        return np.asarray((points - self.middle) @ self.normal)

    def holds(self, points: Array) -> Array:
        """Whether points (..., 2) stand in front of it, edges included."""
        offset, margin = self.offset(points), _EDGE * (self.high - self.low)
        return np.asarray((offset >= self.low - margin) & (offset <= self.high + margin))

    def is_faced_by(self, other: UnitFace) -> bool:
        """Whether a part of another face stands in front of it, more than its edge."""
        ends = self.offset(other.corners())
        return min(self.high, float(ends.max())) > max(self.low, float(ends.min()))

    def corners(self) -> Array:
        """Return both ends (2, 2) [m]."""
        return np.array([self.at(self.low), self.at(self.high)])


@dataclass(frozen=True, eq=False)
class Meeting:
    """Two faces that face each other, and the points in plan where a connector on their axes stands."""

    #: Face that the gap leads from.
    near: UnitFace
    #: Face that the gap leads to.
    far: UnitFace
    #: Point on the near face [m]; shape (2,).
    start: Array
    #: Point on the far face [m]; shape (2,).
    end: Array

    @property
    def pair(self) -> tuple[int, int]:
        """Units of both faces."""
        return self.near.unit, self.far.unit

    @property
    def distance(self) -> float:
        """Between both points [m]."""
        return float(np.linalg.norm(self.end - self.start))

    @property
    def frame(self) -> Array:
        """Matrix (3, 3) from row axes to (along the gap, across it, up) [eq:units-gap-axes]."""
        x, y = _axes(self.near, self.far)
        return np.array([[*x, 0.0], [*y, 0.0], [0.0, 0.0, 1.0]])

    @property
    def overlap(self) -> tuple[float, float]:
        """Where along the gap, row axes, both faces stand [m]; empty where they stand aside of each other."""
        return _overlap(self.near, self.far)

    @property
    def encloses_water(self) -> bool:
        """Whether a part of either face stands in front of the other."""
        return self.near.is_faced_by(self.far) or self.far.is_faced_by(self.near)

    def joined_at(self, across: float) -> tuple[Array, Array]:
        """Return the two points (2,) of a connector that stands ``across`` from the centre line of the near unit."""
        own = across if self.near.kind < 3 else -across
        return self.start + own * self.near.along, self.end - own * self.far.along

    def facing_points(self, along: Array) -> tuple[Array, Array]:
        """Return the points (..., 2) of both faces at places (...) along the gap, as :attr:`overlap` gives them [m]."""
        x = _axes(self.near, self.far)[0]
        return _at_place(self.near, x, along), _at_place(self.far, x, along)


def _axes(near: UnitFace, far: UnitFace) -> tuple[Array, Array]:
    """Return the directions (2,) along and across a gap, which halve the angle between its faces."""
    across = near.normal - far.normal
    across = across / np.linalg.norm(across)
    return np.array([across[1], -across[0]]), across


def _overlap(near: UnitFace, far: UnitFace) -> tuple[float, float]:
    places = np.sort(np.stack([near.corners(), far.corners()]) @ _axes(near, far)[0], axis=1)
    return float(places[:, 0].max()), float(places[:, 1].min())


def _at_place(face: UnitFace, direction: Array, place: Array) -> Array:
    """Return the points (..., 2) of a face at places (...) along a direction [m], its nearest corner beyond it."""
    offset = np.clip((place - face.middle @ direction) / float(face.along @ direction), face.low, face.high)
    return np.asarray(face.middle + offset[..., None] * face.along)


def faces_of(place: Placement, unit: int, length: float, bounds: tuple[float, float]) -> tuple[UnitFace, ...]:
    """Return the four faces of a unit.

    Parameters
    ----------
    place : Placement
    unit : int
        Its number.
    length : float
        [m].
    bounds : tuple of two float
        Least and largest x of its section [m].
    """
    x, y = place.rotation[:2, 0], place.rotation[:2, 1]
    centre, half = np.array([place.x, place.y]), 0.5 * length
    left, right = bounds
    return (
        UnitFace(unit, 0, centre + half * y, y, x, left, right),
        UnitFace(unit, 1, centre + right * x, x, -y, -half, half),
        UnitFace(unit, 2, centre + left * x, -x, y, -half, half),
        UnitFace(unit, 3, centre - half * y, -y, -x, -right, -left),
    )


def meeting(places: Sequence[Placement], pair: tuple[int, int], length: float, bounds: tuple[float, float]) -> Meeting:
    """Return where two units meet; the order of the pair does not matter, nor which end of a unit is its first.

    Between two ends or two sides the near face is that of the lower number, the first unit's where they are alike; an
    end is nearer than a side.

    Parameters
    ----------
    places : sequence of Placement
    pair : tuple of (int, int)
    length, bounds
        See :func:`faces_of`.
    """
    first, second = (faces_of(places[unit], unit, length, bounds) for unit in sorted(pair))
    beam = bounds[1] - bounds[0]
    best: tuple[float, Meeting] | None = None
    # of pairs that are equal: ends first, then ends of the unit that is listed first
    for one, other in product(*(sorted(faces, key=lambda face: not face.is_end) for faces in (first, second))):
        square = float(one.normal @ other.normal)
        if square > -_SQUARE:
            continue
        ordered = (not one.is_end, one.kind) <= (not other.is_end, other.kind)
        found = _met(*((one, other) if ordered else (other, one)))
        behind = max(-float(found.near.before(found.end)), -float(found.far.before(found.start)), 0.0)
        sides = (not one.is_end) + (not other.is_end)
        cost = found.distance + 4.0 * behind + beam * (1.0 + square + _SIDE * sides)
        if best is None or cost < best[0] - 1e-9 * length:
            best = cost, found
    assert best is not None  # two rectangles have faces within 45 degrees of each other, whatever their turn
    return best[1]


def _met(near: UnitFace, far: UnitFace) -> Meeting:
    """Return where two faces meet: at the axes of ends, across from an end on a side, in the middle of two sides."""
    if near.is_end and far.is_end:
        return Meeting(near, far, near.middle, far.middle)
    if near.is_end:
        offset = min(max(float(far.offset(near.middle)), far.low), far.high)
        return Meeting(near, far, near.middle, far.at(offset))
    x, middle = _axes(near, far)[0], np.array(0.5 * sum(_overlap(near, far)))
    return Meeting(near, far, _at_place(near, x, middle), _at_place(far, x, middle))


def gaps_between(places: Sequence[Placement], length: float, bounds: tuple[float, float]) -> tuple[Meeting, ...]:
    """Return where neighbours face each other, nearer than a unit is long and with no other unit between them.

    Parameters
    ----------
    places, length, bounds
        See :func:`meeting`.
    """
    found = []
    for pair in combinations(range(len(places)), 2):
        one = meeting(places, pair, length, bounds)
        if one.distance < length and one.encloses_water and between(places, one, length, bounds) is None:
            found.append(one)
    return tuple(found)


def between(places: Sequence[Placement], met: Meeting, length: float, bounds: tuple[float, float]) -> int | None:
    """Return a unit that lies between two others where they meet, counted from 0; None where none does."""
    steps = np.linspace(0.0, 1.0, 101)[:, None]
    points = met.start + steps * (met.end - met.start)
    for unit, place in enumerate(places):
        if unit in met.pair:
            continue
        own = (points - np.array([place.x, place.y])) @ place.rotation[:2, :2]
        inside = (np.abs(own[:, 1]) < 0.5 * length) & (own[:, 0] > bounds[0]) & (own[:, 0] < bounds[1])
        if inside.any():
            return unit
    return None


__all__ = ["Meeting", "UnitFace", "between", "faces_of", "gaps_between", "meeting"]
