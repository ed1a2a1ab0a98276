"""Compiled kernels of elastic rings: closed pipes that are curved at rest and bend in and out of their plane.

``rings`` is (nodes, first, rows) of :class:`moyai.flexible.rings.RingArrays`: the nodes of all rings one after the
other, where each begins, and per node EI over the mean bar length, one over the bar before and behind, rest
curvature (angle), GJ over the bar behind, rest angle of the bar behind.

One ring at a time stands in the rows of ``S``, its nodes from 1 to ``count``, the last one once more before the first
and the first one behind the last.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from moyai.core.arrays import PLAIN
from moyai.core.compiled import njit

#: Rows: place (3), force (3), curvature (3), unit vector along (3) and one over its size before, rest twist of the bar
#: behind, twist; work of the solution.
_X, _F, _K, _T, _PER, _PHI, _TWIST, _WORK, _ROWS = 0, 3, 6, 9, 12, 13, 14, 15, 21


@njit(cache=True, error_model="numpy")
def _solve_cyclic(diagonal: Any, off: Any, right: Any, count: int, out: Any, low: Any, p: Any, q: Any) -> None:
    """Solve a symmetric cyclic tridiagonal system; ``off[i]`` joins i and i + 1, the last one the end and the start.

    Elimination of an inner chain with two right-hand sides; the unknown 1 is closed last.
    """
    # unknowns 2 .. count form a chain: y = p - q * out[1]
    per = 1.0 / diagonal[2]
    low[2] = off[2] * per
    p[2], q[2] = right[2] * per, off[1] * per
    if count == 2:
        q[2] = (off[1] + off[2]) * per
    for i in range(3, count + 1):
        before = off[i - 1]
        per = 1.0 / (diagonal[i] - before * low[i - 1])
        low[i] = off[i] * per
        corner = off[count] if i == count else 0.0
        p[i] = (right[i] - before * p[i - 1]) * per
        q[i] = (corner - before * q[i - 1]) * per
    for i in range(count - 1, 1, -1):
        p[i] -= low[i] * p[i + 1]
        q[i] -= low[i] * q[i + 1]
    closed = right[1] - off[1] * p[2] - off[count] * p[count]
    closed /= diagonal[1] - off[1] * q[2] - off[count] * q[count]
    out[1] = closed
    for i in range(2, count + 1):
        out[i] = p[i] - q[i] * closed


@njit(cache=True, error_model="numpy")
def _gather(x: Any, y: Any, z: Any, at: Any, count: int, S: Any) -> None:
    """Write the places of a ring and no forces yet."""
    at[0], at[count + 1] = at[count], at[1]
    for h in range(count + 2):
        i = at[h] & PLAIN
        S[_X, h], S[_X + 1, h], S[_X + 2, h] = x[i], y[i], z[i]
        S[_F, h] = S[_F + 1, h] = S[_F + 2, h] = 0.0


@njit(cache=True, error_model="numpy")
def _normal(S: Any, count: int) -> tuple[float, float, float, float]:
    """Return the unit normal of the area that a ring encloses and its size [eq:cage-ring-normal]."""
    x, y, z = S[_X], S[_X + 1], S[_X + 2]
    n0, n1, n2, x0, y0, z0 = 0.0, 0.0, 0.0, x[1], y[1], z[1]
    for h in range(1, count + 1):
        px, py, pz = x[h] - x0, y[h] - y0, z[h] - z0
        qx, qy, qz = x[h + 1] - x0, y[h + 1] - y0, z[h + 1] - z0
        n0 += 0.5 * (py * qz - pz * qy)
        n1 += 0.5 * (pz * qx - px * qz)
        n2 += 0.5 * (px * qy - py * qx)
    size = math.sqrt(n0 * n0 + n1 * n1 + n2 * n2) + 1e-300
    return n0 / size, n1 / size, n2 / size, size


@njit(cache=True, error_model="numpy")
def _hinges(S: Any, rows: Any, a: int, count: int) -> None:
    """Write the curvature (angle) at every node of a ring and the unit vector along it."""
    for h in range(1, count + 1):
        one, two, square = rows[a + h - 1, 1], rows[a + h - 1, 2], 0.0
        for axis in range(3):
            x = S[_X + axis, h]
            e, f = one * (x - S[_X + axis, h - 1]), two * (S[_X + axis, h + 1] - x)
            S[_K + axis, h], S[_T + axis, h] = f - e, e + f
            square += (e + f) * (e + f)
        per = 1.0 / (math.sqrt(square) + 1e-300)
        S[_PER, h] = per
        for axis in range(3):
            S[_T + axis, h] *= per


@njit(cache=True, error_model="numpy")
def _twist(S: Any, rows: Any, a: int, count: int, n0: float, n1: float, n2: float) -> None:
    """Write the twist of the pipe at every node, at which the energy is least, and that of the bars behind at rest."""
    x, y, z, phi = S[_X], S[_X + 1], S[_X + 2], S[_PHI]
    diagonal, off, right, low, p, q = S[_WORK], S[_WORK + 1], S[_WORK + 2], S[_WORK + 3], S[_WORK + 4], S[_WORK + 5]
    for h in range(1, count + 1):
        k = a + h - 1
        slope = n0 * (x[h + 1] - x[h]) + n1 * (y[h + 1] - y[h]) + n2 * (z[h + 1] - z[h])
        phi[h], off[h] = -rows[k, 5] * rows[k, 2] * slope, -rows[k, 4]
    phi[0], off[0] = phi[count], off[count]
    for h in range(1, count + 1):
        k = a + h - 1
        bend = rows[k, 0] * rows[k, 3]
        diagonal[h] = bend * rows[k, 3] - off[h - 1] - off[h]
        along = n0 * S[_K, h] + n1 * S[_K + 1, h] + n2 * S[_K + 2, h]
        right[h] = bend * along - off[h - 1] * phi[h - 1] + off[h] * phi[h]
    _solve_cyclic(diagonal, off, right, count, S[_TWIST], low, p, q)
    S[_TWIST, count + 1] = S[_TWIST, 1]


@njit(cache=True, error_model="numpy")
def _bend(
    S: Any, rows: Any, a: int, count: int, n0: float, n1: float, n2: float, moments: Any
) -> tuple[float, float, float, float]:  # fmt: skip
    """Add the forces of bending and torsion; return the energy and its slope over the normal with the sign turned."""
    energy, v0, v1, v2 = 0.0, 0.0, 0.0, 0.0
    x, y, z, u, v, w, twist = S[_X], S[_X + 1], S[_X + 2], S[_F], S[_F + 1], S[_F + 2], S[_TWIST]
    for h in range(1, count + 1):
        k = a + h - 1
        t0, t1, t2, per = S[_T, h], S[_T + 1, h], S[_T + 2, h], S[_PER, h]
        m0, m1, m2 = n1 * t2 - n2 * t1, n2 * t0 - n0 * t2, n0 * t1 - n1 * t0
        stiff, one, two, rest, turned = rows[k, 0], rows[k, 1], rows[k, 2], rows[k, 3], twist[h]
        q0 = S[_K, h] - rest * (m0 + turned * n0)
        q1 = S[_K + 1, h] - rest * (m1 + turned * n1)
        q2 = S[_K + 2, h] - rest * (m2 + turned * n2)
        energy += 0.5 * stiff * (q0 * q0 + q1 * q1 + q2 * q2)
        q0, q1, q2 = stiff * q0, stiff * q1, stiff * q2
        moments[k, 0] = q0 * m0 + q1 * m1 + q2 * m2
        moments[k, 1] = q0 * n0 + q1 * n1 + q2 * n2
        # the rest curvature turns with the tangent: derivative over the mean direction
        g0, g1, g2 = -rest * (q1 * n2 - q2 * n1), -rest * (q2 * n0 - q0 * n2), -rest * (q0 * n1 - q1 * n0)
        along = g0 * t0 + g1 * t1 + g2 * t2
        g0, g1, g2 = (g0 - along * t0) * per, (g1 - along * t1) * per, (g2 - along * t2) * per
        # minus the derivatives over the bar before (e) and behind (f) the node
        e0, e1, e2 = one * (q0 - g0), one * (q1 - g1), one * (q2 - g2)
        f0, f1, f2 = -two * (q0 + g0), -two * (q1 + g1), -two * (q2 + g2)
        turn = twist[h + 1] - turned - S[_PHI, h]
        torque = rows[k, 4] * turn
        energy += 0.5 * torque * turn
        moments[k, 2] = torque
        pull = torque * rows[k, 5] * two
        # the bar behind pulls at both its ends along the normal
        f0, f1, f2 = f0 - pull * n0, f1 - pull * n1, f2 - pull * n2
        u[h - 1], v[h - 1], w[h - 1] = u[h - 1] - e0, v[h - 1] - e1, w[h - 1] - e2
        u[h], v[h], w[h] = u[h] + e0 - f0, v[h] + e1 - f1, w[h] + e2 - f2
        u[h + 1], v[h + 1], w[h + 1] = u[h + 1] + f0, v[h + 1] + f1, w[h + 1] + f2
        v0 += pull * (x[h + 1] - x[h]) - rest * (t1 * q2 - t2 * q1 + turned * q0)
        v1 += pull * (y[h + 1] - y[h]) - rest * (t2 * q0 - t0 * q2 + turned * q1)
        v2 += pull * (z[h + 1] - z[h]) - rest * (t0 * q1 - t1 * q0 + turned * q2)
    return energy, v0, v1, v2


@njit(cache=True, error_model="numpy")
def ring_loads(
    x: Any, y: Any, z: Any, rings: Any, fx: Any, fy: Any, fz: Any, moments: Any
) -> float:  # fmt: skip
    """Add the forces of bending and torsion of all rings to fx, fy, fz; write the moments; return the energy [J].

    The twist of the pipe follows at once: for given places of the nodes it minimises the energy
    [eq:cage-ring-twist]. ``moments`` (all ring nodes, 3): bending in the plane and out of it at the node, torsion in
    the bar behind [N m].
    """
    nodes, first, rows = rings
    energy, longest = 0.0, 0
    for r in range(first.size - 1):
        longest = max(longest, first[r + 1] - first[r])
    S, at = np.empty((_ROWS, longest + 2)), np.empty(longest + 2, np.int64)
    for r in range(first.size - 1):
        a, count = first[r], first[r + 1] - first[r]
        for h in range(count):
            at[h + 1] = nodes[a + h]
        _gather(x, y, z, at, count, S)
        n0, n1, n2, size = _normal(S, count)
        _hinges(S, rows, a, count)
        _twist(S, rows, a, count, n0, n1, n2)
        part, v0, v1, v2 = _bend(S, rows, a, count, n0, n1, n2, moments)
        energy += part
        # the plane of the ring turns with its nodes
        along, half = v0 * n0 + v1 * n1 + v2 * n2, 0.5 / size
        p0, p1, p2 = half * (v0 - along * n0), half * (v1 - along * n1), half * (v2 - along * n2)
        for axis in range(3):
            S[_F + axis, count] += S[_F + axis, 0]
            S[_F + axis, 1] += S[_F + axis, count + 1]
        for h in range(1, count + 1):
            i = at[h] & PLAIN
            c0, c1 = S[_X, h + 1] - S[_X, h - 1], S[_X + 1, h + 1] - S[_X + 1, h - 1]
            c2 = S[_X + 2, h + 1] - S[_X + 2, h - 1]
            fx[i] += S[_F, h] - (c1 * p2 - c2 * p1)
            fy[i] += S[_F + 1, h] - (c2 * p0 - c0 * p2)
            fz[i] += S[_F + 2, h] - (c0 * p1 - c1 * p0)
    return energy


@njit(cache=True, error_model="numpy")
def ring_forces(x: Any, rings: Any, force: Any) -> float:
    """Add the forces of all rings to ``force`` (n, 3); return their energy [J]."""
    moments = np.empty((rings[0].size, 3))
    return ring_loads(x[:, 0], x[:, 1], x[:, 2], rings, force[:, 0], force[:, 1], force[:, 2], moments)
