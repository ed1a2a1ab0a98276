"""Curves of connectors: along one direction, or from end to end in space.

A chain is drawn between its two ends wherever the units carry them [eq:units-in-space]. So is rubber where it pulls;
pressed it is a block between two faces, as a fender, and acts along its direction at rest. A ``direction`` of the case
is that of a guide, which chain and rubber then follow. Turns of the units draw their ends in to second order.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace

import numpy as np

from moyai.core.arrays import Array
from moyai.mooring.rotations import cross_matrix
from moyai.structures.units.connectors import UnitJoint, stretch
from moyai.structures.units.model import Curve

#: Which forces a curve carries: it pulls only, it pushes only, both.
PULLS, PUSHES, BOTH = 1.0, -1.0, 0.0
#: Length, over that at rest, below which the force of a line falls to nothing where its ends meet: it has no direction
#: there.
SHORTEST = 0.01


def displacement(motion: Array, arm: Array, bend: float = 1.0) -> Array:
    """Return how far a point at an arm (..., 3) from the centre of its unit moves by motions (..., 6), row axes [m].

    Turns count to second order: a unit that pitches draws its ends in [eq:units-turned]; ``bend`` of 0 leaves it out.
    """
    turn = motion[..., 3:]
    moved = motion[..., :3] + turn @ cross_matrix(arm)
    if bend:
        # w x (w x r) = w (w . r) - r w^2
        moved += (0.5 * bend * (turn @ arm))[..., None] * turn
        moved -= (0.5 * bend * np.einsum("...i,...i->...", turn, turn))[..., None] * arm
    return np.asarray(moved)


def hold_together(joints: tuple[UnitJoint, ...], pair: tuple[int, int]) -> bool:
    """Whether a constraint or a spring holds two units together along their gap.

    Both are of first order: they draw in neither unit, and what lies next to them must not either.
    """
    return any(set(joint.pair) == set(pair) and _holds(joint) for joint in joints)


def _holds(joint: UnitJoint) -> bool:
    spring, axis = joint.connector.stiffness, joint.from_end_to_end
    return bool(joint.held[:, :3].any()) or (spring is not None and float(axis @ spring[:3, :3] @ axis) > 0.0)


@dataclass(frozen=True, eq=False)
class Work:
    """How curves are worked about the mean position."""

    #: Half width [m] that their corners are rounded over at least.
    width: float
    #: Amplitude in regular waves, standard deviation in a sea [m]; empty at rest; shape (links,).
    sizes: Array = field(default_factory=lambda: np.zeros(0))
    regular: bool = False

    def size_of(self, number: int) -> float:
        """Return how far a link is worked; zero at rest."""
        return float(self.sizes[number]) if self.sizes.size else 0.0


@dataclass(frozen=True, eq=False)
class Link:
    """One curve between two ends, in row axes."""

    #: Number of its connector.
    joint: int
    #: Its own.
    number: int
    curve: Curve
    #: ``PULLS``, ``PUSHES`` or ``BOTH``.
    side: float
    #: Of its dashpot [N s/m].
    damping: float
    #: Units that it joins, counted from 0.
    pair: tuple[int, int]
    #: Its ends from the centres of both units [m]; shape (2, 3).
    arms: Array
    #: Direction at rest, from the near end to the far end; shape (3,).
    axis: Array
    #: Distance of the ends at rest [m]; zero of a curve that keeps its direction.
    span: float
    #: From row axes to those of the gap; shape (3, 3).
    frame: Array
    #: 1 where turns count to second order, 0 where units are held together along their gap.
    bend: float

    def _ends(self, position: Array) -> tuple[tuple[float, Array, Array], ...]:
        """Return sign, arm and motions (..., 6) of both ends."""
        return tuple(
            (sign, arm, np.asarray(position)[..., 6 * unit : 6 * unit + 6])
            for sign, unit, arm in zip((-1.0, 1.0), self.pair, self.arms, strict=True)
        )

    def _moved(self, position: Array) -> Array:
        near, far = (displacement(motion, arm, self.bend) for _, arm, motion in self._ends(position))
        return np.asarray(far - near)

    def elongation(self, position: Array) -> Array:
        """Return the elongation (...,) [m] at positions (..., m) of the row."""
        return stretch(self._moved(position), self.axis, self.span)

    def _direction(self, position: Array) -> Array:
        moved = self._moved(position)
        if self.span == 0.0:
            return np.broadcast_to(self.axis, moved.shape)
        apart = self.span * self.axis + moved
        length = np.linalg.norm(apart, axis=-1, keepdims=True)
        return np.asarray(apart / np.maximum(length, SHORTEST * self.span))

    def direction(self, position: Array) -> Array:
        """Return the unit vector (..., 3) that it pulls the near end along, axes of the gap; none where ends meet."""
        return np.asarray(self._direction(position) @ self.frame.T)

    def along(self, position: Array) -> Array:
        """Return the derivative (..., m) of the elongation by all motions."""
        direction, out = self._direction(position), np.zeros(np.shape(position))
        for (sign, arm, motion), unit in zip(self._ends(position), self.pair, strict=True):
            turn = motion[..., 3:]
            part = slice(6 * unit, 6 * unit + 3)
            out[..., part] = sign * direction
            drawn = 0.5 * (turn @ arm)[..., None] * direction
            drawn += 0.5 * np.sum(turn * direction, axis=-1, keepdims=True) * arm - (direction @ arm)[..., None] * turn
            out[..., part.stop : part.stop + 3] = sign * (np.cross(arm, direction) + self.bend * drawn)
        return out

    def rows(self, position: Array) -> Array:
        """Return the derivative (3, m) of the vector from end to end at a position (m,)."""
        out = np.zeros((3, len(position)))
        for (sign, arm, motion), unit in zip(self._ends(position), self.pair, strict=True):
            turn = motion[3:]
            second = 0.5 * ((turn @ arm) * np.eye(3) + np.outer(turn, arm)) - np.outer(arm, turn)
            out[:, 6 * unit : 6 * unit + 3] = sign * np.eye(3)
            out[:, 6 * unit + 3 : 6 * unit + 6] = sign * (self.bend * second - cross_matrix(arm))
        return out

    def bears(self, position: Array, work: Work) -> tuple[float, float]:
        """Return mean force [N] and slope [N/m] at a mean position (m,)."""
        elongation, size = float(self.elongation(position)), work.size_of(self.number)
        if size > work.width:
            return self.curve.worked(elongation, size, work.regular)
        return self.curve.rounded(elongation, work.width)

    def stiffness(self, position: Array, work: Work) -> Array:
        """Return the tangent stiffness (m, m) at a mean position (m,)."""
        force, slope = self.bears(position, work)
        direction, rows = self._direction(position), self.rows(position)
        inner = slope * np.outer(direction, direction)
        if self.span > 0.0:
            length = max(self.span + float(self.elongation(position)), SHORTEST * self.span)
            inner += force / length * (np.eye(3) - np.outer(direction, direction))
        out = rows.T @ inner @ rows
        for (sign, arm, _), unit in zip(self._ends(position), self.pair, strict=True):
            part = slice(6 * unit + 3, 6 * unit + 6)
            bent = 0.5 * (np.outer(direction, arm) + np.outer(arm, direction)) - (direction @ arm) * np.eye(3)
            out[part, part] += sign * self.bend * force * bent
        return np.asarray(out)


def links_of(joints: tuple[UnitJoint, ...], centres: Array) -> tuple[Link, ...]:
    """Return the curves of all connectors, in their order.

    Parameters
    ----------
    joints : tuple of Joint
    centres : ndarray (u, 3)
        Centres of gravity of the units [m], row axes.
    """
    out: list[Link] = []
    for number, joint in enumerate(joints):
        connector = joint.connector
        if connector.curve is None:
            continue
        side = {"chain": PULLS, "fender": PUSHES}.get(connector.kind, BOTH)
        middle = joint.place - centres[list(joint.pair)]
        fixed = Link(
            number, len(out), connector.curve, side, connector.linear_damping, joint.pair, middle,
            joint.frame.T @ joint.axis, 0.0, joint.frame, 0.0 if hold_together(joints, joint.pair) else 1.0,
        )  # fmt: skip
        if not joint.in_space:
            out.append(fixed)
            continue
        half = 0.5 * joint.span * fixed.axis
        drawn = replace(fixed, arms=middle + np.array([-half, half]), span=joint.span)
        if side == PULLS:
            out.append(drawn)
        else:
            parts = (replace(drawn, side=PULLS), replace(fixed, side=PUSHES))
            halves = (replace(part, curve=part_of(part.curve, part.side)) for part in parts)
            for one in halves:
                if any(one.curve.force):
                    out.append(replace(one, number=len(out)))
    return tuple(out)


def part_of(curve: Curve, side: float) -> Curve:
    """Return the part of a curve that pulls (1) or pushes (-1), zero elsewhere; both together are the curve."""
    points = list(zip(curve.elongation, curve.force))
    points = [*_beyond(points[1], points[0])[::-1], *points, *_beyond(points[-2], points[-1])]
    out = points[:1]
    for e, force in points[1:]:
        last, before = out[-1]
        if force * before < 0.0:
            out.append((last + (e - last) * before / (before - force), 0.0))
        out.append((e, force))
    return Curve(tuple(e for e, _ in out), tuple(side * max(side * force, 0.0) for _, force in out))


def _beyond(inner: tuple[float, float], end: tuple[float, float]) -> list[tuple[float, float]]:
    """Return where the last piece of a curve, gone on with, carries nothing, and a point as far again."""
    slope = (end[1] - inner[1]) / (end[0] - inner[0])
    if slope == 0.0 or (end[0] - inner[0]) * end[1] * slope >= 0.0:
        return []
    zero = end[0] - end[1] / slope
    return [(zero, 0.0), (2.0 * zero - end[0], -end[1])]


__all__ = [
    "BOTH", "PULLS", "PUSHES", "SHORTEST", "Link", "Work", "displacement", "hold_together", "links_of", "part_of",
]  # fmt: skip
