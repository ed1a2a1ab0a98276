"""Where connectors that carry one way keep contact, and where hulls meet: what is then valid of the linear answer.

A fender that is pressed at rest is a spring both ways in the linear answer; it holds its units only as long as no wave
lifts it off. Hulls that meet push each other, which neither domain computes.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from moyai.core.arrays import Array
from moyai.core.validity import Notice
from moyai.structures.units.assembly import RowAtLevel
from moyai.structures.units.doubts import meeting_notice
from moyai.structures.units.gaps import gaps_of, largest_closing
from moyai.structures.units.model import Curve, Placement
from moyai.structures.units.outlines import least_distance

#: Travel [m] and force [N] that are rounding.
_NO_TRAVEL, _NO_FORCE = 1e-9, 1e-6
#: Least over largest slope of a curve on its way, below which it lets go there: a tie that hardly pulls holds nothing.
_LETS_GO = 0.05


def touches(curve: Curve, low: float, high: float) -> tuple[bool, bool]:
    """Return whether a connector carries from one elongation to another [m], and whether it lets go there.

    It lets go where its curve is flat over a stretch, or hardly rises next to another one.
    """
    nodes = np.array(curve.elongation)
    if high - low < _NO_TRAVEL:
        low, high = low - _NO_TRAVEL, high + _NO_TRAVEL
        nodes = np.zeros(0)
    e = np.concatenate([[low], nodes[(nodes > low) & (nodes < high)], [high]])
    e = e[np.concatenate([[True], np.diff(e) >= _NO_TRAVEL])]
    force = curve.at(e)
    slopes = np.diff(force) / np.diff(e)
    bears = bool(np.any(np.abs(force) > _NO_FORCE))
    return bears, bears and float(slopes.min()) < _LETS_GO * float(slopes.max())


def measured_ends(curve: Curve, kind: str) -> tuple[float, float]:
    """Return the ends [m] between which a curve was measured; NaN where it has none or carries nothing beyond it."""
    ends = np.array([curve.elongation[0], curve.elongation[-1]])
    force = np.array(curve.force)
    idle = [not force[:2].any(), not force[-2:].any()]
    found = np.where(idle, np.nan, ends) if kind == "rubber" else np.full(2, np.nan)
    return float(found[0]), float(found[1])


def loses_contact(at: RowAtLevel, low: Array, high: Array) -> bool:
    """Return whether any connector that is worked between elongations (joints,) [m] carries and lets go.

    Its impacts go through the whole row.
    """
    return any(
        touches(joint.connector.curve, float(ends[0]), float(ends[1]))[1]
        for joint, ends in zip(at.joints, zip(low, high, strict=True), strict=True)
        if joint.connector.curve is not None
    )


def distance_at(at: RowAtLevel, position: Array) -> float:
    """Return the least distance [m] of two units in plan at a position (m,) of the row; negative where they overlap."""
    moved = [
        Placement(place.x + float(move[0]), place.y + float(move[1]), place.heading + float(move[5]))
        for place, move in zip(at.row.placements, position.reshape(-1, 6), strict=True)
    ]
    return least_distance(at.row, moved)[0]


def meeting_variables(at: RowAtLevel, position: Array, closing: Array) -> dict[str, Any]:
    """Return the distance of the units in their mean position (m,), and whether hulls meet there or by their motion.

    Parameters
    ----------
    at : RowAtLevel
    position : ndarray (m,)
    closing : ndarray (gaps,)
        Largest of every gap [m].
    """
    width, least = np.array([gap.width for gap in gaps_of(at)]), distance_at(at, position)
    meet = bool(np.any(closing >= width)) or least <= 0.0
    return {"least_distance": np.asarray(least), "hulls_meet": np.asarray(meet, dtype=np.int8)}


def steady_meeting(at: RowAtLevel, position: Array) -> Iterator[Notice]:
    """Say that hulls meet under lines, wind and current alone, at their position (m,)."""
    width = np.array([gap.width for gap in gaps_of(at)])
    closing = largest_closing(at, position, lambda corners: np.zeros(len(corners)))
    yield from meeting_notice(f"{at.name}, without waves", closing / width, width, distance_at(at, position))


__all__ = [
    "distance_at", "loses_contact", "measured_ends", "meeting_variables", "steady_meeting", "touches",
]  # fmt: skip
