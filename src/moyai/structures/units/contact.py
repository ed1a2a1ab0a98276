"""Where connectors that bear one way keep contact, and where hulls meet: what the linear answer then still knows.

A fender that is pressed at rest is a spring both ways in the linear answer; it holds its units only as long as no wave
lifts it off. Hulls that meet push each other, which neither domain computes.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from moyai.core.arrays import Array
from moyai.core.validity import Notice
from moyai.structures.units.assembly import RowAtLevel
from moyai.structures.units.doubts import meeting_notice
from moyai.structures.units.gaps import gaps_of, largest_closing
from moyai.structures.units.model import Curve, Placement
from moyai.structures.units.outlines import least_distance
from moyai.structures.units.seas import SeaAnswer

#: Travel [m] and force [N] that are rounding.
_NO_TRAVEL, _NO_FORCE = 1e-9, 1e-6
#: Least over largest slope of a curve on its way, below which it lets go there: a tie that hardly pulls holds nothing.
_LETS_GO = 0.05
#: Stiffness over that of the lines of a unit from which slow drift no longer parts two units by more than a tenth more.
_HOLDS = 100.0
Flags = NDArray[np.bool_]


def touches(curve: Curve, low: float, high: float) -> tuple[bool, bool, float]:
    """Return whether a connector bears from one elongation to another [m], whether it lets go there, its least slope.

    It lets go where its curve is flat over a stretch, or hardly rises beside another one; the slope is in N/m.
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
    return bears, bears and float(slopes.min()) < _LETS_GO * float(slopes.max()), max(float(slopes.min()), 0.0)


def measured_ends(curve: Curve, kind: str) -> tuple[float, float]:
    """Return the ends [m] between which a curve was measured; NaN where it has none or bears nothing beyond it."""
    ends = np.array([curve.elongation[0], curve.elongation[-1]])
    force = np.array(curve.force)
    idle = [not force[:2].any(), not force[-2:].any()]
    found = np.where(idle, np.nan, ends) if kind == "rubber" else np.full(2, np.nan)
    return float(found[0]), float(found[1])


def contact_of(at: RowAtLevel, answer: SeaAnswer, low: Array, high: Array) -> tuple[Flags, Flags, Flags, Flags]:
    """Return of every connector whether its units are held and whether contact is lost; of every gap the same.

    Units are held by a constraint, or by what is much stiffer than the lines of a unit and never lets go. Where one
    connector bears and lets go in one motion, its impacts go through the whole row: contact is lost for all.

    Parameters
    ----------
    at : RowAtLevel
    answer : SeaAnswer
    low, high : ndarray (joints,)
        Elongations that connectors with a curve are worked between [m].
    """
    lines = at.line_stiffness(answer.rest.position).diagonal().reshape(-1, 6)[:, :2].max(initial=0.0)
    holds, lets_go = np.zeros(len(at.joints), dtype=bool), np.zeros(len(at.joints), dtype=bool)
    for number, joint in enumerate(at.joints):
        spring, axis, curve = joint.connector.stiffness, joint.from_end_to_end, joint.connector.curve
        own = 0.0 if spring is None else float(axis @ spring[:3, :3] @ axis)
        if curve is not None:
            _, lets_go[number], slope = touches(curve, float(low[number]), float(high[number]))
            own += slope
        holds[number] = joint.held[:, :3].any() or own > _HOLDS * lines

    def held(pair: tuple[int, int]) -> bool:
        return any(there and set(joint.pair) == set(pair) for joint, there in zip(at.joints, holds, strict=True))

    joints = np.array([held(joint.pair) for joint in at.joints], dtype=bool)
    gaps = np.array([held(gap.pair) for gap in gaps_of(at)], dtype=bool)
    lost = bool(lets_go.any())
    return joints, np.full(len(joints), lost), gaps, np.full(len(gaps), lost)


def contact_variables(at: RowAtLevel, answers: Sequence[SeaAnswer], low: Array, high: Array) -> dict[str, Array]:
    """Return the flags of :func:`contact_of` (n, joints or gaps), by the names of results."""
    names = ("connector_joins", "connector_loses_contact", "gap_joined", "gap_loses_contact")
    rows = [contact_of(at, *each) for each in zip(answers, low, high, strict=True)]
    return {name: np.array([row[number] for row in rows]).astype(np.int8) for number, name in enumerate(names)}


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
    "contact_of", "contact_variables", "distance_at", "measured_ends", "meeting_variables", "steady_meeting", "touches",
]  # fmt: skip
