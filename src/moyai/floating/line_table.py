"""Forces of mooring lines tabulated for the time domain: exact line solver in, smooth table and its measured error out.

A line at rest in its own vertical plane pulls its fairlead with a horizontal force H towards the anchor and a vertical
force V downwards; both depend on span and rise alone. The table runs over chord and slope angle instead, because a line
goes taut at one chord whatever its slope: the sharp bend of the force then lies along a grid line
[eq:floating-line-table].
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from moyai.core.errors import InputError
from moyai.floating.arrays import FloatArray, finite

LineForce = Callable[[FloatArray, FloatArray], "tuple[FloatArray, FloatArray]"]
"""Arrays of span and rise from anchor to fairlead [m] -> horizontal pull towards the anchor and downward pull [N]."""

FIRST_CHORDS, FIRST_ANGLES = 17, 5
LARGEST_CHORDS, LARGEST_ANGLES = 1025, 513


@dataclass(frozen=True)
class LineTable:
    """One line's pull on its fairlead, bicubic in chord and slope angle, with continuous first derivatives.

    Parameters
    ----------
    chord, angle : ndarray (p,), (q,)
        Grid: distance from anchor to fairlead [m], angle of it above the horizontal [rad].
    nodes : ndarray (p, q, 2, 4)
        For H and V [N]: value, derivative by chord, by angle, by both.
    error : float
        Largest difference from the exact solver between the nodes [N].
    relative_error : float
        Largest difference over the tension there plus the reference tension.
    """

    chord: FloatArray
    angle: FloatArray
    nodes: FloatArray
    error: float
    relative_error: float

    def pull(self, span: ArrayLike, rise: ArrayLike) -> tuple[FloatArray, FloatArray]:
        """Return H and V [N] at span and rise [m]; outside the table the edge is continued along its slope."""
        from moyai.floating.kernel import table_pull_many

        across, up = np.broadcast_arrays(np.asarray(span, dtype=float), np.asarray(rise, dtype=float))
        values = table_pull_many(self.chord, self.angle, self.nodes, across.ravel(), up.ravel())
        return values[:, 0].reshape(across.shape), values[:, 1].reshape(across.shape)


def tabulate_line(
    line_force: LineForce,
    *,
    chord_range: tuple[float, float],
    angle_range: tuple[float, float],
    reference_tension: float,
    tolerance: float = 1e-4,
) -> LineTable:
    """Tabulate a line, refining the grid until the error between its nodes is small.

    Parameters
    ----------
    line_force : callable
        Exact solver, batched.
    chord_range : tuple of float
        Smallest and largest distance from anchor to fairlead that will occur [m].
    angle_range : tuple of float
        Smallest and largest slope of the chord above the horizontal [rad].
    reference_tension : float
        Tension that errors of a slack line are held against, for instance that at rest [N].
    tolerance : float
        Largest error, in parts of tension plus ``reference_tension``.

    Returns
    -------
    LineTable
        ``relative_error`` tells what was reached; it exceeds the tolerance only when the grid has grown to its limit.

    Raises
    ------
    InputError
        When a range is empty or the exact solver gives numbers that are not finite.
    """
    if not 0.0 < chord_range[0] < chord_range[1] or not angle_range[0] < angle_range[1]:
        raise InputError(f"empty range: chords {chord_range}, angles {angle_range}", path="chord_range")
    chord = np.linspace(*chord_range, FIRST_CHORDS)
    angle = np.linspace(*angle_range, FIRST_ANGLES)
    while True:
        nodes = _nodes(line_force, chord, angle)
        between_chords, error_chords = _errors(line_force, chord, angle, nodes, True, reference_tension)
        between_angles, error_angles = _errors(line_force, chord, angle, nodes, False, reference_tension)
        split_chords = between_chords > tolerance
        split_angles = between_angles > tolerance
        room = (
            chord.size + int(split_chords.sum()) <= LARGEST_CHORDS
            and angle.size + int(split_angles.sum()) <= LARGEST_ANGLES
        )
        if not (split_chords.any() or split_angles.any()) or not room:
            break
        chord = np.sort(np.concatenate([chord, 0.5 * (chord[1:] + chord[:-1])[split_chords]]))
        angle = np.sort(np.concatenate([angle, 0.5 * (angle[1:] + angle[:-1])[split_angles]]))
    return LineTable(
        chord=chord,
        angle=angle,
        nodes=nodes,
        error=max(error_chords, error_angles),
        relative_error=float(max(between_chords.max(), between_angles.max())),
    )


def _exact(line_force: LineForce, chord: FloatArray, angle: FloatArray) -> FloatArray:
    """Return exact (H, V) along the last axis for broadcast chords and angles."""
    distance, slope = np.broadcast_arrays(chord, angle)
    horizontal, vertical = line_force((distance * np.cos(slope)).ravel(), (distance * np.sin(slope)).ravel())
    values = np.stack([np.asarray(horizontal, dtype=float), np.asarray(vertical, dtype=float)], axis=-1)
    return np.asarray(finite(values.reshape(*distance.shape, 2), "line force"), dtype=float)


def _nodes(line_force: LineForce, chord: FloatArray, angle: FloatArray) -> FloatArray:
    """Return values and derivatives at the grid, derivatives by differences much narrower than a cell."""
    step_chord = 1e-3 * float(np.min(np.diff(chord)))
    step_angle = 1e-3 * float(np.min(np.diff(angle)))
    c, a = chord[:, None], angle[None, :]

    def at(chord_steps: float, angle_steps: float) -> FloatArray:
        return _exact(line_force, c + chord_steps * step_chord, a + angle_steps * step_angle)

    right, left, up, down = at(1, 0), at(-1, 0), at(0, 1), at(0, -1)
    cross = at(1, 1) - at(1, -1) - at(-1, 1) + at(-1, -1)
    return np.stack(
        [
            at(0, 0),
            (right - left) / (2.0 * step_chord),
            (up - down) / (2.0 * step_angle),
            cross / (4.0 * step_chord * step_angle),
        ],
        axis=-1,
    )


def _errors(
    line_force: LineForce, chord: FloatArray, angle: FloatArray, nodes: FloatArray, along_chord: bool, reference: float
) -> tuple[FloatArray, float]:
    """Return the largest relative error in every interval along one axis, and the largest absolute one."""
    from moyai.floating.kernel import table_pull_many

    def thirds(grid: FloatArray) -> FloatArray:
        width = np.diff(grid)
        return (grid[:-1, None] + width[:, None] * np.array([0.21, 0.5, 0.79])).ravel()

    if along_chord:
        c, a = np.meshgrid(thirds(chord), angle, indexing="ij")
    else:
        c, a = np.meshgrid(np.concatenate([chord, 0.5 * (chord[1:] + chord[:-1])]), thirds(angle), indexing="ij")
    exact = _exact(line_force, c, a).reshape(-1, 2)
    table = table_pull_many(chord, angle, nodes, (c * np.cos(a)).ravel(), (c * np.sin(a)).ravel())
    difference = np.max(np.abs(table - exact), axis=1)
    relative = (difference / (np.hypot(exact[:, 0], exact[:, 1]) + reference)).reshape(c.shape)
    worst = relative.max(axis=1) if along_chord else relative.max(axis=0)
    return worst.reshape(-1, 3).max(axis=1), float(difference.max())


@dataclass(frozen=True)
class TabulatedMooring:
    """Lines of a floating body as tables, with the geometry that turns body motion into span and rise.

    Parameters
    ----------
    tables : tuple of LineTable
        Different lines; identical ones share a table.
    table_of_line : tuple of int
        Table of each line.
    fairlead : ndarray (n, 3)
        Fairleads in the body frame about the centre of the modes at rest (x, y, z) [m].
    anchor : ndarray (n, 3)
        Anchors relative to the centre of the modes at rest (x, y, z) [m].
    count : ndarray (n,)
        How many identical lines each stands for; forces on the body are multiplied, line tensions are of one line.
    body : ndarray (n,) of int
        Body that each line holds.
    spatial : bool
        Six modes a body (surge ... yaw) instead of three (sway, heave, roll).
    bodies : int
    """

    tables: tuple[LineTable, ...]
    table_of_line: tuple[int, ...]
    fairlead: FloatArray
    anchor: FloatArray
    count: FloatArray
    body: FloatArray | None = None
    spatial: bool = False
    bodies: int = 1

    @property
    def size(self) -> int:
        """Number of modes of all bodies."""
        return self.bodies * (6 if self.spatial else 3)

    @property
    def lines(self) -> int:
        """Number of lines, identical ones counted once."""
        return len(self.table_of_line)

    def forces(self, position: ArrayLike) -> tuple[FloatArray, FloatArray]:
        """Return the force (m,) on the modes and the pulls (n, 2), H and V of one line each, at a position (m,)."""
        from moyai.floating.kernel import mooring_force

        pulls = np.zeros((self.lines, 2))
        force = np.zeros(self.size)
        mooring_force(np.asarray(position, dtype=float), self.packed(), force, pulls)
        return force, pulls

    def force(self, position: FloatArray) -> FloatArray:
        """Return the force (m,) on the modes."""
        return self.forces(position)[0]

    def stiffness(self, position: FloatArray) -> FloatArray:
        """Return minus the central difference of the force; steps are a thousandth of the smallest table cell."""
        reach = min(float(np.min(np.diff(table.chord))) for table in self.tables)
        arm = max(float(np.max(np.abs(self.fairlead))), 1e-9)
        matrix = np.empty((self.size, self.size))
        per_body = 6 if self.spatial else 3
        for column in range(self.size):
            rotation = column % per_body >= (3 if self.spatial else 2)
            step = np.zeros(self.size)
            step[column] = 1e-3 * reach / (arm if rotation else 1.0)
            ahead, behind = self.force(position + step), self.force(position - step)
            matrix[:, column] = -(ahead - behind) / (2.0 * step[column])
        return matrix

    def packed(self) -> tuple[FloatArray, ...]:
        """Return everything as the flat arrays of the kernel."""
        chords = np.concatenate([table.chord for table in self.tables])
        angles = np.concatenate([table.angle for table in self.tables])
        nodes = np.concatenate([table.nodes.ravel() for table in self.tables])
        sizes = np.array(
            [[table.chord.size, table.angle.size, table.nodes.size] for table in self.tables], dtype=np.int64
        )
        starts = np.vstack([np.zeros((1, 3), dtype=np.int64), np.cumsum(sizes, axis=0)[:-1]])
        layout = np.hstack([starts, sizes])[list(self.table_of_line)]
        body = np.zeros(self.lines, dtype=np.int64) if self.body is None else np.asarray(self.body, dtype=np.int64)
        per_body = 6 if self.spatial else 3
        info = np.column_stack([layout, body * per_body, np.full(self.lines, per_body)]).astype(np.int64)
        return (
            chords,
            angles,
            nodes,
            np.ascontiguousarray(info),
            np.ascontiguousarray(self.fairlead, dtype=float),
            np.ascontiguousarray(self.anchor, dtype=float),
            np.ascontiguousarray(self.count, dtype=float),
        )
