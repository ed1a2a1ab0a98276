"""Compiled kernels of elastic rings: closed pipes that are curved at rest and bend in and out of their plane.

``rings`` is (nodes, first, rows) of :class:`moyai.flexible.rings.RingArrays`: the nodes of all rings one after the
other, where each begins, and per node EI over the mean bar length, one over the bar before and behind, rest
curvature (angle), GJ over the bar behind, rest angle of the bar behind.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from moyai.core.compiled import njit


@njit(cache=True, error_model="numpy")
def _solve_cyclic(diagonal: Any, off: Any, right: Any, count: int, out: Any, work: Any) -> None:
    """Solve a symmetric cyclic tridiagonal system; ``off[i]`` joins i and i + 1, the last one the end and the start.

    Elimination of an inner chain with two right-hand sides; the unknown 0 is closed last.
    """
    # unknowns 1 .. count-1 form a chain: y = p - q * out[0]
    low, p, q = work[0], work[1], work[2]
    d = diagonal[1]
    low[1] = off[1] / d
    p[1], q[1] = right[1] / d, off[0] / d
    if count == 2:
        q[1] = (off[0] + off[1]) / d
    for i in range(2, count):
        d = diagonal[i] - off[i - 1] * low[i - 1]
        low[i] = off[i] / d
        corner = off[count - 1] if i == count - 1 else 0.0
        p[i] = (right[i] - off[i - 1] * p[i - 1]) / d
        q[i] = (corner - off[i - 1] * q[i - 1]) / d
    for i in range(count - 2, 0, -1):
        p[i] -= low[i] * p[i + 1]
        q[i] -= low[i] * q[i + 1]
    last = count - 1
    first = right[0] - off[0] * p[1] - off[last] * p[last]
    out[0] = first / (diagonal[0] - off[0] * q[1] - off[last] * q[last])
    for i in range(1, count):
        out[i] = p[i] - q[i] * out[0]


@njit(cache=True, error_model="numpy")
def _normal(x: Any, y: Any, z: Any, nodes: Any, a: int, b: int, n: Any) -> float:
    """Write the unit normal of the area that a ring encloses and return its size [eq:cage-ring-normal]."""
    n[0] = n[1] = n[2] = 0.0
    x0, y0, z0 = x[nodes[a]], y[nodes[a]], z[nodes[a]]
    for k in range(a, b):
        i, j = nodes[k], nodes[k + 1] if k + 1 < b else nodes[a]
        px, py, pz = x[i] - x0, y[i] - y0, z[i] - z0
        qx, qy, qz = x[j] - x0, y[j] - y0, z[j] - z0
        n[0] += 0.5 * (py * qz - pz * qy)
        n[1] += 0.5 * (pz * qx - px * qz)
        n[2] += 0.5 * (px * qy - py * qx)
    size = math.sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]) + 1e-300
    for axis in range(3):
        n[axis] /= size
    return size


@njit(cache=True, error_model="numpy")
def _hinges(x: Any, y: Any, z: Any, nodes: Any, rows: Any, a: int, b: int, n: Any, kappa: Any, mean: Any) -> None:
    """Write the curvature (angle) at every node of a ring and the unit vector along it."""
    for k in range(a, b):
        before, behind = nodes[k - 1] if k > a else nodes[b - 1], nodes[k + 1] if k + 1 < b else nodes[a]
        i = nodes[k]
        one, two = rows[k, 1], rows[k, 2]
        e0, e1, e2 = one * (x[i] - x[before]), one * (y[i] - y[before]), one * (z[i] - z[before])
        f0, f1, f2 = two * (x[behind] - x[i]), two * (y[behind] - y[i]), two * (z[behind] - z[i])
        kappa[k - a, 0], kappa[k - a, 1], kappa[k - a, 2] = f0 - e0, f1 - e1, f2 - e2
        t0, t1, t2 = e0 + f0, e1 + f1, e2 + f2
        size = math.sqrt(t0 * t0 + t1 * t1 + t2 * t2) + 1e-300
        mean[k - a, 0], mean[k - a, 1], mean[k - a, 2], mean[k - a, 3] = t0 / size, t1 / size, t2 / size, size


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
    energy = 0.0
    n, gn = np.empty(3), np.empty(3)
    longest = 0
    for r in range(first.size - 1):
        longest = max(longest, first[r + 1] - first[r])
    kappa, mean = np.empty((longest, 3)), np.empty((longest, 4))
    off, diagonal, right, twist = np.empty(longest), np.empty(longest), np.empty(longest), np.empty(longest)
    phi, work = np.empty(longest), np.empty((3, longest))
    for r in range(first.size - 1):
        a, b = first[r], first[r + 1]
        count = b - a
        size = _normal(x, y, z, nodes, a, b, n)
        _hinges(x, y, z, nodes, rows, a, b, n, kappa, mean)
        for h in range(count):
            k = a + h
            i, j = nodes[k], nodes[k + 1] if k + 1 < b else nodes[a]
            slope = rows[k, 2] * (n[0] * (x[j] - x[i]) + n[1] * (y[j] - y[i]) + n[2] * (z[j] - z[i]))
            phi[h] = -rows[k, 5] * slope
            off[h] = -rows[k, 4]
        for h in range(count):
            k, last = a + h, h - 1 if h > 0 else count - 1
            bend = rows[k, 0] * rows[k, 3]
            diagonal[h] = bend * rows[k, 3] - off[last] - off[h]
            along = n[0] * kappa[h, 0] + n[1] * kappa[h, 1] + n[2] * kappa[h, 2]
            right[h] = bend * along - off[last] * phi[last] + off[h] * phi[h]
        _solve_cyclic(diagonal, off, right, count, twist, work)
        gn[0] = gn[1] = gn[2] = 0.0
        for h in range(count):
            k = a + h
            before, i, behind = (
                nodes[k - 1] if k > a else nodes[b - 1],
                nodes[k],
                nodes[k + 1] if k + 1 < b else nodes[a],
            )
            t0, t1, t2, tsize = mean[h, 0], mean[h, 1], mean[h, 2], mean[h, 3]
            m0, m1, m2 = n[1] * t2 - n[2] * t1, n[2] * t0 - n[0] * t2, n[0] * t1 - n[1] * t0
            rest = rows[k, 3]
            q0 = kappa[h, 0] - rest * (m0 + twist[h] * n[0])
            q1 = kappa[h, 1] - rest * (m1 + twist[h] * n[1])
            q2 = kappa[h, 2] - rest * (m2 + twist[h] * n[2])
            energy += 0.5 * rows[k, 0] * (q0 * q0 + q1 * q1 + q2 * q2)
            q0, q1, q2 = rows[k, 0] * q0, rows[k, 0] * q1, rows[k, 0] * q2
            moments[k, 0] = q0 * m0 + q1 * m1 + q2 * m2
            moments[k, 1] = q0 * n[0] + q1 * n[1] + q2 * n[2]
            # the rest curvature turns with the tangent: derivative over the mean direction
            g0, g1, g2 = (
                -rest * (q1 * n[2] - q2 * n[1]),
                -rest * (q2 * n[0] - q0 * n[2]),
                -rest * (q0 * n[1] - q1 * n[0]),
            )
            along = g0 * t0 + g1 * t1 + g2 * t2
            g0, g1, g2 = (g0 - along * t0) / tsize, (g1 - along * t1) / tsize, (g2 - along * t2) / tsize
            one, two = rows[k, 1], rows[k, 2]
            # minus the derivatives over the bar before (e) and behind (f) the node
            e0, e1, e2 = one * (q0 - g0), one * (q1 - g1), one * (q2 - g2)
            f0, f1, f2 = -two * (q0 + g0), -two * (q1 + g1), -two * (q2 + g2)
            fx[before] -= e0
            fy[before] -= e1
            fz[before] -= e2
            fx[i] += e0 - f0
            fy[i] += e1 - f1
            fz[i] += e2 - f2
            fx[behind] += f0
            fy[behind] += f1
            fz[behind] += f2
            gn[0] -= rest * (t1 * q2 - t2 * q1 + twist[h] * q0)
            gn[1] -= rest * (t2 * q0 - t0 * q2 + twist[h] * q1)
            gn[2] -= rest * (t0 * q1 - t1 * q0 + twist[h] * q2)
            turn = (twist[h + 1] if h + 1 < count else twist[0]) - twist[h] - phi[h]
            energy += 0.5 * rows[k, 4] * turn * turn
            torque = rows[k, 4] * turn
            moments[k, 2] = torque
            pull = torque * rows[k, 5] * rows[k, 2]
            fx[behind] -= pull * n[0]
            fy[behind] -= pull * n[1]
            fz[behind] -= pull * n[2]
            fx[i] += pull * n[0]
            fy[i] += pull * n[1]
            fz[i] += pull * n[2]
            gn[0] += pull * (x[behind] - x[i])
            gn[1] += pull * (y[behind] - y[i])
            gn[2] += pull * (z[behind] - z[i])
        # the plane of the ring turns with its nodes
        along = gn[0] * n[0] + gn[1] * n[1] + gn[2] * n[2]
        p0, p1, p2 = (gn[0] - along * n[0]) / size, (gn[1] - along * n[1]) / size, (gn[2] - along * n[2]) / size
        for k in range(a, b):
            before, i, behind = (
                nodes[k - 1] if k > a else nodes[b - 1],
                nodes[k],
                nodes[k + 1] if k + 1 < b else nodes[a],
            )
            c0, c1, c2 = x[behind] - x[before], y[behind] - y[before], z[behind] - z[before]
            fx[i] -= 0.5 * (c1 * p2 - c2 * p1)
            fy[i] -= 0.5 * (c2 * p0 - c0 * p2)
            fz[i] -= 0.5 * (c0 * p1 - c1 * p0)
    return energy


@njit(cache=True, error_model="numpy")
def ring_forces(x: Any, rings: Any, force: Any) -> float:
    """Add the forces of all rings to ``force`` (n, 3); return their energy [J]."""
    moments = np.empty((rings[0].size, 3))
    return ring_loads(x[:, 0], x[:, 1], x[:, 2], rings, force[:, 0], force[:, 1], force[:, 2], moments)
