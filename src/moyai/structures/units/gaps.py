"""The gap between two units: how far their hulls close it, corner against corner.

A connector may hold the middle of a gap open while decks or keels meet. Every corner of the face of one hull stands
before the face of the other; they touch where it closes its own clearance [eq:units-gap]. Faces that are turned or
moved aside have corners of different clearance: the one that uses most of its own counts.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from moyai.core.arrays import Array
from moyai.mooring.rotations import cross_matrix
from moyai.structures.units.assembly import RowAtLevel
from moyai.structures.units.faces import Meeting, UnitFace, gaps_between
from moyai.structures.units.links import hold_together


@dataclass(frozen=True, eq=False)
class Gap:
    """The water between two units that face each other."""

    #: With the numbers of the units, counted from 1.
    name: str
    #: Units, counted from 0.
    pair: tuple[int, int]
    #: Least clearance of a corner at rest [m].
    width: float
    #: From the first unit to the second, row axes; shape (corners, 3).
    along: Array
    #: Points that touch, from the centres of their units [m], row axes; shape (2, corners, 3).
    arms: Array
    #: Width over the clearance of a corner: closings are those of a gap of this width; shape (corners,).
    weight: Array
    #: 1 where turns count to second order, 0 where the units are held together along their gap.
    bend: float

    def rows(self, size: int) -> Array:
        """Return the closing (corners, m) by small motions of all units."""
        out = np.zeros((len(self.weight), size))
        for unit, sign, arms in zip(self.pair, (1.0, -1.0), self.arms, strict=True):
            columns = slice(6 * unit, 6 * unit + 6)
            out[:, columns] = sign * np.array(
                [
                    weight * np.concatenate([along, -along @ cross_matrix(arm)])
                    for weight, along, arm in zip(self.weight, self.along, arms, strict=True)
                ]
            )
        return out

    def largest(self, position: Array) -> float:
        """Return the largest closing of any corner [m] over positions (n, m) of the row."""
        closing = position @ self.rows(position.shape[1]).T
        if self.bend:
            # the second order of moyai.structures.units.links.displacement, along the gap
            for unit, sign, arms in zip(self.pair, (1.0, -1.0), self.arms, strict=True):
                turn = position[:, 6 * unit + 3 : 6 * unit + 6]
                bent = (turn @ arms.T) * (turn @ self.along.T)
                bent -= np.einsum("ni,ni->n", turn, turn)[:, None] * np.einsum("ci,ci->c", arms, self.along)
                closing += 0.5 * self.bend * sign * self.weight * bent
        return float(closing.max())


@lru_cache(maxsize=16)
def gaps_of(at: RowAtLevel) -> tuple[Gap, ...]:
    """Return the gaps between neighbours, narrower than a unit is long."""
    out = []
    for met in gaps_between(at.row.placements, at.row.length, at.row.hull.bounds[:2]):
        clearance, along, arms = _corners(at, met)
        if not clearance.size or not clearance.min() > 0.0:
            continue
        bend = 0.0 if hold_together(at.joints, met.pair) else 1.0
        first, second = sorted(met.pair)
        name, width = f"gap {first + 1}-{second + 1}", float(clearance.min())
        out.append(Gap(name, met.pair, width, along, arms, width / clearance, bend))
    return tuple(out)


def _corners(at: RowAtLevel, met: Meeting) -> tuple[Array, Array, Array]:
    """Return clearance (n,) [m], direction (n, 3) and arms (2, n, 3) of the corners of both faces before the other."""
    clearances: list[float] = []
    along: list[Array] = []
    arms: list[tuple[Array, Array]] = []
    known: set[tuple[float, ...]] = set()
    for own, other, sign in ((met.far, met.near, 1.0), (met.near, met.far, -1.0)):
        towards = np.array([*other.normal, 0.0])
        for corner in _outline(at, own):
            apart = float(other.before(corner[:2]))
            pair = (corner - apart * towards, corner)[:: int(sign)]
            # a corner that stands right before another one is both of them
            place = tuple(np.round(np.concatenate(pair), 6).tolist())
            if place in known or not other.holds(corner[:2]):
                continue
            known.add(place)
            clearances.append(apart)
            along.append(sign * towards)
            arms.append(pair)
    points = np.array(arms).reshape(-1, 2, 3).swapaxes(0, 1)
    return np.array(clearances), np.array(along), points - at.centres[list(met.pair)][:, None]


def _outline(at: RowAtLevel, face: UnitFace) -> Array:
    """Return the corners (n, 3) of the hull on a face [m], row axes."""
    outline = np.concatenate([item.edges.polyline() for item in at.row.hull.outlines])
    left, right = at.row.hull.bounds[:2]
    half, place = 0.5 * at.row.length, at.row.placements[face.unit]
    if face.is_end:
        points = [(x, half if face.kind == 0 else -half, z) for x, z in outline]
    else:
        middle, side = 0.5 * (left + right), 1.0 if face.kind == 1 else -1.0
        points = [(x, y, z) for x, z in outline if side * (x - middle) >= 0.0 for y in (-half, half)]
    return place.to_row(np.array(points) - np.array([0.0, 0.0, at.draught]))


def largest_closing(at: RowAtLevel, position: Array, reach: Callable[[Array], Array]) -> Array:
    """Return how far every gap closes at most (gaps,) [m] from its width at rest, turns to first order.

    Parameters
    ----------
    at : RowAtLevel
    position : ndarray (m,)
        Mean position.
    reach : callable
        The largest motion (corners,) about it by the rows (corners, m) of the corners of a gap.
    """
    rows = [gap.rows(at.size) for gap in gaps_of(at)]
    return np.array([np.max(row @ position + reach(row)) for row in rows])


__all__ = ["Gap", "gaps_of", "largest_closing"]
