"""Compiled planar force of all lines on a body for time integration: tables in their windows, exact solver outside."""

from __future__ import annotations

import numpy as np

from moyai.core.arrays import Array, IntArray
from moyai.core.compiled import njit
from moyai.mooring.kernels import solve_single
from moyai.mooring.segments import solve_segments

# columns of ``parameters``, one row a line
KIND, ANCHOR_X, ANCHOR_Y, ANCHOR_Z, FAIRLEAD_X, FAIRLEAD_Y, FAIRLEAD_Z, COUNT = range(8)
LENGTH, AXIAL, WEIGHT, CLEARANCE, FRICTION, RATE, NATURAL, TENSION_ONLY = range(8, 16)
UNIFORM, SEGMENTED, SPRING = 0.0, 1.0, 2.0
# columns of ``index``: -1 in the first where the line has no table
TABLE, XI_COUNT, Z_COUNT, LOOKUP, XI_BINS, Z_BINS, ROWS, ROW_COUNT = range(8)


@njit(cache=True, error_model="numpy")
def table_force(
    x: float,
    z: float,
    start: int,
    xi_count: int,
    z_count: int,
    lookup_start: int,
    xi_bins: int,
    z_bins: int,
    nodes: Array,
    lookup: IntArray,
) -> tuple[float, float, bool]:
    """Return (H, V, inside) by bicubic Hermite interpolation; C1 in x and z ``[eq:mooring-table]``.

    ``nodes`` from ``start``: xi nodes, z nodes, reference distance at the z nodes and its slope, then eight values a
    node: H, H_xi, H_z, H_xi_z, V, V_xi, V_z, V_xi_z. ``lookup`` holds the first cell of every uniform bin.
    """
    z_start = start + xi_count
    z0 = nodes[z_start]
    z1 = nodes[z_start + z_count - 1]
    if not (z >= z0 and z <= z1):
        return 0.0, 0.0, False
    j = lookup[lookup_start + xi_bins + min(int((z - z0) / (z1 - z0) * z_bins), z_bins - 1)]
    while nodes[z_start + j + 1] < z:
        j += 1
    dz = nodes[z_start + j + 1] - nodes[z_start + j]
    t = (z - nodes[z_start + j]) / dz
    u = 1.0 - t
    b0 = u * u * (1.0 + 2.0 * t)
    b1 = t * t * (3.0 - 2.0 * t)
    b2 = t * u * u * dz
    b3 = -t * t * u * dz
    r = z_start + z_count + j
    xi = x - (b0 * nodes[r] + b1 * nodes[r + 1] + b2 * nodes[r + z_count] + b3 * nodes[r + z_count + 1])
    x0 = nodes[start]
    x1 = nodes[start + xi_count - 1]
    if not (xi >= x0 and xi <= x1):
        return 0.0, 0.0, False
    i = lookup[lookup_start + min(int((xi - x0) / (x1 - x0) * xi_bins), xi_bins - 1)]
    while nodes[start + i + 1] < xi:
        i += 1
    dx = nodes[start + i + 1] - nodes[start + i]
    s = (xi - nodes[start + i]) / dx
    q = 1.0 - s
    a0 = q * q * (1.0 + 2.0 * s)
    a1 = s * s * (3.0 - 2.0 * s)
    a2 = s * q * q * dx
    a3 = -s * s * q * dx
    k = z_start + 3 * z_count + 8 * (i * z_count + j)
    m = k + 8 * z_count
    h = (
        b0 * (a0 * nodes[k] + a2 * nodes[k + 1] + a1 * nodes[m] + a3 * nodes[m + 1])
        + b2 * (a0 * nodes[k + 2] + a2 * nodes[k + 3] + a1 * nodes[m + 2] + a3 * nodes[m + 3])
        + b1 * (a0 * nodes[k + 8] + a2 * nodes[k + 9] + a1 * nodes[m + 8] + a3 * nodes[m + 9])
        + b3 * (a0 * nodes[k + 10] + a2 * nodes[k + 11] + a1 * nodes[m + 10] + a3 * nodes[m + 11])
    )
    v = (
        b0 * (a0 * nodes[k + 4] + a2 * nodes[k + 5] + a1 * nodes[m + 4] + a3 * nodes[m + 5])
        + b2 * (a0 * nodes[k + 6] + a2 * nodes[k + 7] + a1 * nodes[m + 6] + a3 * nodes[m + 7])
        + b1 * (a0 * nodes[k + 12] + a2 * nodes[k + 13] + a1 * nodes[m + 12] + a3 * nodes[m + 13])
        + b3 * (a0 * nodes[k + 14] + a2 * nodes[k + 15] + a1 * nodes[m + 14] + a3 * nodes[m + 15])
    )
    return h, v, True


@njit(cache=True, error_model="numpy")
def _exact_segmented(
    x: float, z: float, nodes: Array, first: int, count: int, clearance: float, friction: float, start: float
) -> tuple[float, float]:
    rows = nodes[first : first + 4 * count].reshape((count, 4))
    state = np.empty(11)
    piece = np.empty(6)
    h, _, _, _ = solve_segments(x, z, rows, clearance == 0.0, friction, start, state, piece)
    return h, state[9]


@njit(cache=True, error_model="numpy")
def planar_line_force(
    sway: float,
    heave: float,
    roll: float,
    parameters: Array,
    index: IntArray,
    nodes: Array,
    lookup: IntArray,
    memory: Array,
    force: Array,
    tension: Array,
) -> None:
    """Add the force of all lines to ``force`` (F_x, F_z, M_y about the body origin) for one planar position.

    Parameters
    ----------
    sway, heave, roll : float
        Body position [m, m, rad]; roll positive about +y, finite rotation.
    parameters, index, nodes, lookup : ndarray
        From :class:`moyai.mooring.table.CompiledLines`.
    memory : ndarray (lines,)
        Last horizontal tension of every line, start of the exact solver; zeros at first; changed here.
    force : ndarray (3,)
        Is added to [N, N m]; copies of a line count.
    tension : ndarray (lines,)
        Receives the fairlead tension of one copy [N].
    """
    c = np.cos(roll)
    s = np.sin(roll)
    for i in range(parameters.shape[0]):
        arm_x = parameters[i, FAIRLEAD_X] * c + parameters[i, FAIRLEAD_Z] * s
        arm_z = -parameters[i, FAIRLEAD_X] * s + parameters[i, FAIRLEAD_Z] * c
        dx = sway + arm_x - parameters[i, ANCHOR_X]
        dy = parameters[i, FAIRLEAD_Y] - parameters[i, ANCHOR_Y]
        z = heave + arm_z - parameters[i, ANCHOR_Z]
        if parameters[i, KIND] == SPRING:
            length = np.sqrt(dx * dx + dy * dy + z * z)
            pull = parameters[i, RATE] * (length - parameters[i, NATURAL])
            if parameters[i, TENSION_ONLY] > 0.0 and pull < 0.0:
                pull = 0.0
            tension[i] = pull
            fx = -pull * dx / length
            fz = -pull * z / length
        else:
            x = abs(dx) if dy == 0.0 else np.sqrt(dx * dx + dy * dy)
            inside = False
            h = 0.0
            v = 0.0
            if index[i, TABLE] >= 0:
                h, v, inside = table_force(
                    x,
                    z,
                    index[i, TABLE],
                    index[i, XI_COUNT],
                    index[i, Z_COUNT],
                    index[i, LOOKUP],
                    index[i, XI_BINS],
                    index[i, Z_BINS],
                    nodes,
                    lookup,
                )
            if not inside:
                if parameters[i, KIND] == UNIFORM:
                    h, v, _, _, _, _, _, _, _, _, _ = solve_single(
                        x,
                        z,
                        parameters[i, LENGTH],
                        parameters[i, AXIAL],
                        parameters[i, WEIGHT],
                        parameters[i, CLEARANCE],
                        parameters[i, FRICTION],
                        memory[i],
                    )
                else:
                    h, v = _exact_segmented(
                        x, z, nodes, index[i, ROWS], index[i, ROW_COUNT], parameters[i, CLEARANCE],
                        parameters[i, FRICTION], memory[i],
                    )  # fmt: skip
                memory[i] = h
            tension[i] = np.sqrt(h * h + v * v)
            fx = -h * dx / x if x > 0.0 else 0.0
            fz = -v
        fx *= parameters[i, COUNT]
        fz *= parameters[i, COUNT]
        force[0] += fx
        force[1] += fz
        force[2] += arm_z * fx - arm_x * fz


@njit(cache=True, error_model="numpy")
def planar_line_force_batch(
    positions: Array,
    parameters: Array,
    index: IntArray,
    nodes: Array,
    lookup: IntArray,
    force: Array,
    tension: Array,
) -> None:
    """Evaluate many planar positions (n, 3) one after another."""
    memory = np.zeros(parameters.shape[0])
    for k in range(positions.shape[0]):
        planar_line_force(
            positions[k, 0],
            positions[k, 1],
            positions[k, 2],
            parameters,
            index,
            nodes,
            lookup,
            memory,
            force[k],
            tension[k],
        )


@njit(cache=True, error_model="numpy")
def table_force_batch(x: Array, z: Array, index: IntArray, nodes: Array, lookup: IntArray, out: Array) -> None:
    """Evaluate one table at many points; ``out`` (n, 2) receives H, V, NaN outside the window."""
    for k in range(x.size):
        h, v, inside = table_force(
            x[k], z[k], index[0], index[1], index[2], index[3], index[4], index[5], nodes, lookup
        )
        out[k, 0] = h if inside else np.nan
        out[k, 1] = v if inside else np.nan
