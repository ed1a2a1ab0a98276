"""The gap between two units: how far their hulls close it, corner against corner.

A connector may hold the middle of a gap open while decks or keels meet. Every corner of the end of one hull stands
against the same corner of the next; they touch where they close the gap by its width [eq:units-gap].
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from moyai.core.arrays import Array
from moyai.mooring.rotations import cross_matrix
from moyai.structures.units.assembly import RowAtLevel
from moyai.structures.units.links import displacement, hold_together
from moyai.structures.units.model import facing


@dataclass(frozen=True, eq=False)
class Gap:
    """The water between two units that face each other.

    Parameters
    ----------
    name : str
        With the numbers of the units, counted from 1.
    pair : tuple of (int, int)
        Units, counted from 0.
    width : float
        At rest [m].
    along : ndarray (3,)
        From the first unit to the second, row axes.
    arms : ndarray (2, corners, 3)
        Corners of both ends from the centres of their units [m], row axes.
    bend : float
        1 where turns count to second order, 0 where the units are held together along their gap.
    """

    name: str
    pair: tuple[int, int]
    width: float
    along: Array
    arms: Array
    bend: float

    def rows(self, size: int) -> Array:
        """Return the closing (corners, m) by small motions of all units."""
        out = np.zeros((self.arms.shape[1], size))
        for unit, sign, arms in zip(self.pair, (1.0, -1.0), self.arms, strict=True):
            columns = slice(6 * unit, 6 * unit + 6)
            out[:, columns] = sign * np.array(
                [np.concatenate([self.along, -self.along @ cross_matrix(arm)]) for arm in arms]
            )
        return out

    def largest(self, position: Array) -> float:
        """Return the largest closing of any corner [m] over positions (n, m) of the row."""
        most = np.full(len(position), -np.inf)
        for near, far in zip(*self.arms, strict=True):
            one, other = (
                displacement(position[:, 6 * unit : 6 * unit + 6], arm, self.bend)
                for unit, arm in zip(self.pair, (near, far), strict=True)
            )
            most = np.maximum(most, (one - other) @ self.along)
        return float(most.max())


def gaps_of(at: RowAtLevel) -> tuple[Gap, ...]:
    """Return the gaps between neighbours, narrower than a unit is long."""
    out = []
    places, length = at.row.placements, at.row.length
    outline = np.concatenate([item.edges.polyline() for item in at.row.hull.outlines])
    for first, second, width in facing(places, length):
        arms = []
        for unit, end in ((first, 0.5 * length), (second, -0.5 * length)):
            corners = np.column_stack([outline[:, 0], np.full(len(outline), end), outline[:, 1] - at.draught])
            arms.append(places[unit].to_row(corners) - at.centres[unit])
        bend = 0.0 if hold_together(at.joints, (first, second)) else 1.0
        name = f"gap {first + 1}-{second + 1}"
        out.append(Gap(name, (first, second), width, places[first].rotation[:, 1], np.array(arms), bend))
    return tuple(out)


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
