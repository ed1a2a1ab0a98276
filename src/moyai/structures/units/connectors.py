"""Connectors between units: what they hold, what they give way to, and the loads in them.

The relative motion of a connector is that of the unit after it less that of the unit before it, at its place, in axes
of the gap: x along it, y across it, z up [eq:units-relative]. The order in which a pair is listed does not matter
[eq:units-faces]. Held components are constraints; the others carry by springs, dashpots,
curves.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from moyai.core.arrays import Array
from moyai.core.errors import InputError
from moyai.mooring.rotations import cross_matrix
from moyai.structures.units.faces import meeting
from moyai.structures.units.model import Connector, FloatingRow

_RANK = 1e-9


@dataclass(frozen=True, eq=False)
class UnitJoint:
    """One connector at one place."""

    #: Of the connector with its units, counted from 1.
    name: str
    connector: Connector
    pair: tuple[int, int]
    #: [m], row axes; shape (3,).
    place: Array
    #: Relative motion of all motions of all units; shape (6, m).
    relative: Array
    #: Directions of the relative motion that are held; shape (c, 6).
    held: Array
    #: Distance of its ends at rest [m].
    span: float
    #: From row axes to those of the gap; shape (3, 3).
    frame: Array
    #: Unit vector from the near end to the far end at rest, the same axes; zero where they meet; shape (3,).
    from_end_to_end: Array

    @property
    def in_space(self) -> bool:
        """Whether it is drawn from end to end, wherever the units carry them."""
        return self.connector.end_to_end and self.span > 0.0

    @property
    def axis(self) -> Array:
        """Direction of a curve at rest (3,), axes of the gap."""
        return self.from_end_to_end if self.in_space else np.asarray(self.connector.axis, dtype=float)

    @property
    def along(self) -> Array:
        """Elongation of a curve by small motions (m,)."""
        return np.asarray(self.axis @ self.relative[:3])

    def elongation(self, position: Array) -> float:
        """Return the elongation of a curve [m] at a position (m,) of the row, turns to first order."""
        moved = self.relative[:3] @ position
        return float(stretch(moved, self.axis, self.span if self.in_space else 0.0))


def stretch(moved: Array, axis: Array, span: float) -> Array:
    """Return the elongation (...,) [m] of a line as its far end moves by (..., 3) [eq:units-in-space].

    ``axis`` is its direction at rest, ``span`` its length there; zero for a line that keeps its direction.
    """
    along = moved @ axis
    if span == 0.0:
        return np.asarray(along)
    # without the difference of two nearly equal lengths
    change = 2.0 * span * along + np.sum(moved**2, axis=-1)
    return np.asarray(change / (np.sqrt(np.maximum(span**2 + change, 0.0)) + span))


def joints_of(row: FloatingRow, centres: Array, draught: float) -> tuple[UnitJoint, ...]:
    """Return every connector at every place.

    Parameters
    ----------
    row : FloatingRow
    centres : ndarray (u, 3)
        Centres of gravity [m], row axes.
    draught : float
        [m].
    """
    joints, bounds = [], row.hull.bounds[:2]
    for connector in row.connectors:
        for listed in connector.pairs:
            met = meeting(row.placements, listed, row.length, bounds)
            first, second = met.pair
            near, far = (np.array([*point, connector.above_keel - draught]) for point in met.joined_at(connector.x))
            place, frame = 0.5 * (near + far), met.frame
            relative = np.zeros((6, 6 * row.count))
            for unit, sign in ((first, -1.0), (second, 1.0)):
                columns = slice(6 * unit, 6 * unit + 6)
                arm = cross_matrix(place - centres[unit])
                relative[:3, columns] = sign * np.concatenate([frame, -frame @ arm], axis=1)
                relative[3:, columns.start + 3 : columns.stop] = sign * frame
            name = connector.name if len(connector.pairs) == 1 else f"{connector.name} {listed[0] + 1}-{listed[1] + 1}"
            apart = frame @ (far - near)
            span = float(np.linalg.norm(apart))
            axis = apart / span if span > 0.0 else apart
            joints.append(
                UnitJoint(name, connector, (first, second), place, relative, _held(connector), span, frame, axis)
            )
    return tuple(joints)


def _held(connector: Connector) -> Array:
    if connector.kind == "rigid":
        return np.eye(6)
    if connector.kind == "ball":
        return np.eye(6)[:3]
    if connector.kind == "hinge":
        axis = np.asarray(connector.axis, dtype=float)
        across = np.linalg.svd(axis[None, :])[2][1:]
        held = np.zeros((5, 6))
        held[:3, :3] = np.eye(3)
        held[3:, 3:] = across
        return held
    return np.zeros((0, 6))


def constraints(joints: tuple[UnitJoint, ...], count: int) -> Array:
    """Return the constraint matrix G (c, m) of G q = 0 [eq:units-constraint].

    Raises
    ------
    InputError
        Where a connector holds what others hold already: how they share the load is then not determined.
    """
    rows: list[Array] = []
    rank = 0
    for joint in joints:
        if not len(joint.held):
            continue
        own = joint.held @ joint.relative
        together = np.concatenate([*rows, own]) if rows else own
        now = _rank(together)
        if now < rank + len(own):
            raise InputError(
                f"connector '{joint.name}' holds {rank + len(own) - now} relative motion(s) that connectors before it "
                "hold already",
                parameter="connectors",
                remedy="their share of the load is not determined: make one of them a spring, or take it out",
            )
        rows.append(own)
        rank = now
    return np.concatenate(rows) if rows else np.zeros((0, count))


def _rank(matrix: Array) -> int:
    size = np.linalg.norm(matrix, axis=0)
    scaled = matrix / np.where(size > 0.0, size, 1.0)
    values = np.linalg.svd(scaled, compute_uv=False)
    return int((values > _RANK * values[0]).sum())


def null_space(matrix: Array) -> Array:
    """Return an orthonormal basis (m, m - c) of the motions that the constraints leave."""
    if not len(matrix):
        return np.eye(matrix.shape[1])
    values, vectors = np.linalg.svd(matrix)[1:]
    return np.asarray(vectors[int((values > _RANK * values[0]).sum()) :].T)


def spring_matrices(joints: tuple[UnitJoint, ...], count: int) -> tuple[Array, Array]:
    """Return stiffness and damping (m, m) of springs, dashpots and of the dashpots of curves [eq:units-spring]."""
    stiffness, damping = np.zeros((count, count)), np.zeros((count, count))
    for joint in joints:
        connector = joint.connector
        if connector.stiffness is not None:
            stiffness += joint.relative.T @ connector.stiffness @ joint.relative
        if connector.damping is not None:
            damping += joint.relative.T @ connector.damping @ joint.relative
        if connector.curve is not None and connector.linear_damping:
            damping += connector.linear_damping * np.outer(joint.along, joint.along)
    return stiffness, damping
