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

#: Units that are turned against each other by more [rad], or lie further aside [lengths of a unit], do not face.
_FACING = 1e-6


@dataclass(frozen=True, eq=False)
class Gap:
    """The water between two units that face each other.

    Parameters
    ----------
    name : str
        With the numbers of the units, counted from 1.
    width : float
        At rest [m].
    closing : ndarray (corners, m)
        Closing at every corner of the hulls by all motions of all units.
    """

    name: str
    width: float
    closing: Array


def gaps_of(at: RowAtLevel) -> tuple[Gap, ...]:
    """Return the gaps between neighbours, narrower than a unit is long."""
    out = []
    places, length = at.row.placements, at.row.length
    for first, one in enumerate(places):
        for second, other in enumerate(places):
            apart = one.rotation.T @ np.array([other.x - one.x, other.y - one.y, 0.0])
            turned = abs(np.angle(np.exp(1j * (other.heading - one.heading))))
            faces = turned <= _FACING and abs(apart[0]) <= _FACING * length
            if first != second and faces and length < apart[1] < 2.0 * length:
                name = f"gap {first + 1}-{second + 1}"
                out.append(Gap(name, float(apart[1]) - length, _closing(at, first, second)))
    return tuple(out)


def largest_closing(at: RowAtLevel, position: Array, reach: Callable[[Array], Array]) -> Array:
    """Return how far every gap closes at most (gaps,) [m] from its width at rest.

    Parameters
    ----------
    at : RowAtLevel
    position : ndarray (m,)
        Mean position.
    reach : callable
        The largest motion (corners,) about it by the rows (corners, m) of the corners of a gap.
    """
    return np.array([np.max(gap.closing @ position + reach(gap.closing)) for gap in gaps_of(at)])


def _closing(at: RowAtLevel, first: int, second: int) -> Array:
    outline = np.concatenate([item.edges.polyline() for item in at.row.hull.outlines])
    along = at.row.placements[first].rotation[:, 1]
    out = np.zeros((len(outline), at.size))
    for unit, sign in ((first, 1.0), (second, -1.0)):
        place = np.full(len(outline), 0.5 * sign * at.row.length)
        corners = np.column_stack([outline[:, 0], place, outline[:, 1] - at.draught])
        arms = at.row.placements[unit].to_row(corners) - at.centres[unit]
        columns = slice(6 * unit, 6 * unit + 6)
        out[:, columns] = sign * np.array([np.concatenate([along, -along @ cross_matrix(arm)]) for arm in arms])
    return out


__all__ = ["Gap", "gaps_of", "largest_closing"]
