"""Curves of connectors: along one direction, or from end to end in space.

A chain is drawn between its two ends wherever the units carry them [eq:units-in-space]. So is rubber where it pulls;
pressed it is a block between two faces, as a fender, and acts along its direction at rest. A ``direction`` of the case
is that of a guide, which chain and rubber then follow.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from moyai.core.arrays import Array
from moyai.structures.units.connectors import Joint, stretch
from moyai.structures.units.model import Curve

#: Which forces a curve bears: it pulls only, it pushes only, both.
PULLS, PUSHES, BOTH = 1.0, -1.0, 0.0


@dataclass(frozen=True, eq=False)
class Link:
    """One curve between two ends; lengths in axes of the unit before it.

    Parameters
    ----------
    joint : int
        Number of its connector.
    curve : Curve
    side : float
        ``PULLS``, ``PUSHES`` or ``BOTH``.
    damping : float
        Of its dashpot [N s/m].
    ends : ndarray (3, m)
        Motion of the far end less that of the near end, by all motions of all units.
    axis : ndarray (3,)
        Direction at rest, from the near end to the far end.
    span : float
        Distance of the ends at rest [m]; zero of a curve that keeps its direction.
    """

    joint: int
    curve: Curve
    side: float
    damping: float
    ends: Array
    axis: Array
    span: float

    def elongation(self, position: Array) -> Array:
        """Return the elongation (...,) [m] at positions (..., m) of the row."""
        return stretch(np.asarray(position) @ self.ends.T, self.axis, self.span)

    def direction(self, position: Array) -> Array:
        """Return the unit vector (..., 3) that it pulls the near end along."""
        moved = np.asarray(position) @ self.ends.T
        if self.span == 0.0:
            return np.broadcast_to(self.axis, moved.shape)
        apart = self.span * self.axis + moved
        return np.asarray(apart / np.linalg.norm(apart, axis=-1, keepdims=True))

    def along(self, position: Array) -> Array:
        """Return the derivative (..., m) of the elongation by all motions."""
        return np.asarray(self.direction(position) @ self.ends)

    def stiffness(self, position: Array, width: float) -> Array:
        """Return the tangent stiffness (m, m) at a position (m,), corners rounded over ``width`` [m]."""
        force, slope = self.curve.rounded(float(self.elongation(position)), width)
        direction = self.direction(position)
        inner = slope * np.outer(direction, direction)
        if self.span > 0.0:
            length = self.span + float(self.elongation(position))
            inner += force / length * (np.eye(3) - np.outer(direction, direction))
        return np.asarray(self.ends.T @ inner @ self.ends)


def links_of(joints: tuple[Joint, ...]) -> tuple[Link, ...]:
    """Return the curves of all connectors, in their order."""
    out: list[Link] = []
    for number, joint in enumerate(joints):
        connector = joint.connector
        if connector.curve is None:
            continue
        side = {"chain": PULLS, "fender": PUSHES}.get(connector.kind, BOTH)
        fixed = Link(number, connector.curve, side, connector.linear_damping, joint.relative[:3], joint.axis, 0.0)
        if not joint.in_space:
            out.append(fixed)
            continue
        drawn = replace(fixed, ends=joint.ends, span=joint.span)
        if side == PULLS:
            out.append(drawn)
        else:
            parts = (replace(drawn, side=PULLS), replace(fixed, side=PUSHES))
            halves = (replace(part, curve=part_of(part.curve, part.side)) for part in parts)
            out.extend(half for half in halves if any(half.curve.force))
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
    """Return where the last piece of a curve, gone on with, bears nothing, and a point as far again."""
    slope = (end[1] - inner[1]) / (end[0] - inner[0])
    if slope == 0.0 or (end[0] - inner[0]) * end[1] * slope >= 0.0:
        return []
    zero = end[0] - end[1] / slope
    return [(zero, 0.0), (2.0 * zero - end[0], -end[1])]


__all__ = ["BOTH", "PULLS", "PUSHES", "Link", "links_of", "part_of"]
