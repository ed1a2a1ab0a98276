"""Compiled force of lines in space on several bodies for time integration: tables inside their windows, exact outside.

The exact solver starts from the last horizontal tension of a line, so that a step along a path takes few iterations.
"""

from __future__ import annotations

import numpy as np

from moyai.core.arrays import Array, IntArray
from moyai.core.compiled import njit
from moyai.mooring import planar_kernel as pk
from moyai.mooring.kernels import solve_single
from moyai.mooring.planar_kernel import _exact_segmented, table_force

# as globals of this file, which compiled code can read
_KIND, _COUNT, _RATE, _NATURAL, _TENSION_ONLY = pk.KIND, pk.COUNT, pk.RATE, pk.NATURAL, pk.TENSION_ONLY
_LENGTH, _AXIAL, _WEIGHT, _CLEARANCE, _FRICTION = pk.LENGTH, pk.AXIAL, pk.WEIGHT, pk.CLEARANCE, pk.FRICTION
_ANCHOR, _FAIRLEAD, _ROWS, _ROW_COUNT = pk.ANCHOR_X, pk.FAIRLEAD_X, pk.ROWS, pk.ROW_COUNT
_UNIFORM, _SPRING = pk.UNIFORM, pk.SPRING
_TABLE, _XI_COUNT, _Z_COUNT = pk.TABLE, pk.XI_COUNT, pk.Z_COUNT
_LOOKUP, _XI_BINS, _Z_BINS = pk.LOOKUP, pk.XI_BINS, pk.Z_BINS


@njit(cache=True, error_model="numpy")
def _shares(square: float) -> tuple[float, float]:
    """Return sin(t)/t and (1 - cos(t))/t^2 for the square of an angle t, by their series where it is small."""
    if square < 0.04:
        sine = 1.0 - square / 6.0 * (1.0 - square / 20.0 * (1.0 - square / 42.0 * (1.0 - square / 72.0)))
        rest = 0.5 - square / 24.0 * (1.0 - square / 30.0 * (1.0 - square / 56.0 * (1.0 - square / 90.0)))
        return sine, rest
    angle = np.sqrt(square)
    return np.sin(angle) / angle, (1.0 - np.cos(angle)) / square


@njit(cache=True, error_model="numpy")
def space_line_force(
    position: Array,
    body: IntArray,
    parameters: Array,
    index: IntArray,
    nodes: Array,
    lookup: IntArray,
    memory: Array,
    force: Array,
    tension: Array,
) -> None:
    """Add the force of all lines to ``force`` for one position of all bodies.

    Parameters
    ----------
    position : ndarray (6 b,)
        x, y, z [m] and the vector of the turn [rad] of every body: along its axis, as long as its angle. The same
        motion has the same components in turned axes, which angles one after the other have not.
    body : ndarray (lines,) of int
        That a line holds; lines of one body stand together.
    parameters, index, nodes, lookup : ndarray
        From :class:`moyai.mooring.table.CompiledLines`.
    memory : ndarray (lines,)
        Last horizontal tension of every line; zeros at first; changed here.
    force : ndarray (6 b,)
        Is added to [N, N m], moments about the origin of each body; copies of a line count.
    tension : ndarray (lines,)
        Receives the fairlead tension of one copy [N].
    """
    holder, roll, pitch, yaw, sine, rest = -1, 0.0, 0.0, 0.0, 1.0, 0.5
    for i in range(parameters.shape[0]):
        first = 6 * body[i]
        row = parameters[i]
        if body[i] != holder:
            holder = body[i]
            roll, pitch, yaw = position[first + 3], position[first + 4], position[first + 5]
            sine, rest = _shares(roll * roll + pitch * pitch + yaw * yaw)
        arm_x, arm_y, arm_z = row[_FAIRLEAD], row[_FAIRLEAD + 1], row[_FAIRLEAD + 2]
        # Rodrigues: r + sin(t)/t (t x r) + (1 - cos(t))/t^2 (t x (t x r))
        ax, ay, az = pitch * arm_z - yaw * arm_y, yaw * arm_x - roll * arm_z, roll * arm_y - pitch * arm_x
        arm_x += sine * ax + rest * (pitch * az - yaw * ay)
        arm_y += sine * ay + rest * (yaw * ax - roll * az)
        arm_z += sine * az + rest * (roll * ay - pitch * ax)
        dx = position[first] + arm_x - row[_ANCHOR]
        dy = position[first + 1] + arm_y - row[_ANCHOR + 1]
        dz = position[first + 2] + arm_z - row[_ANCHOR + 2]
        level = np.sqrt(dx * dx + dy * dy)
        if row[_KIND] == _SPRING:
            length = np.sqrt(level * level + dz * dz)
            pull = row[_RATE] * (length - row[_NATURAL])
            if row[_TENSION_ONLY] > 0.0 and pull < 0.0:
                pull = 0.0
            tension[i] = pull
            h, v = pull * level / length, pull * dz / length
        else:
            h, v, inside = 0.0, 0.0, False
            if index[i, _TABLE] >= 0:
                h, v, inside = table_force(
                    level, dz, index[i, _TABLE], index[i, _XI_COUNT], index[i, _Z_COUNT], index[i, _LOOKUP],
                    index[i, _XI_BINS], index[i, _Z_BINS], nodes, lookup,
                )  # fmt: skip
            if not inside:
                if row[_KIND] == _UNIFORM:
                    h, v, _, _, _, _, _, _, _, _, _ = solve_single(
                        level, dz, row[_LENGTH], row[_AXIAL], row[_WEIGHT], row[_CLEARANCE], row[_FRICTION], memory[i]
                    )
                else:
                    h, v = _exact_segmented(
                        level, dz, nodes, index[i, _ROWS], index[i, _ROW_COUNT], row[_CLEARANCE], row[_FRICTION],
                        memory[i],
                    )  # fmt: skip
                memory[i] = h
            tension[i] = np.sqrt(h * h + v * v)
        fx = -row[_COUNT] * h * dx / level if level > 0.0 else 0.0
        fy = -row[_COUNT] * h * dy / level if level > 0.0 else 0.0
        fz = -row[_COUNT] * v
        force[first] += fx
        force[first + 1] += fy
        force[first + 2] += fz
        force[first + 3] += arm_y * fz - arm_z * fy
        force[first + 4] += arm_z * fx - arm_x * fz
        force[first + 5] += arm_x * fy - arm_y * fx
