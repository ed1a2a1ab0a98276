"""Compiled kernels of statics and of the implicit schemes: forces, their tangent, a banded solver, Newton's method.

Arrays run over nodes first (n, 3). Unknowns stand in the order of ``rank`` (reverse Cuthill-McKee), so that the matrix of a
line is block tridiagonal and that of a net has the band of its narrow side. ``system`` is (nodes, bars, start, end, curve,
curves, hinges, bending, attached) of :class:`moyai.flexible.arrays.KernelArrays`.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numba import njit

#: Outcomes of a march.
GOOD, STUCK, NOT_FINITE = 0, 1, 2


@njit(cache=True, error_model="numpy")
def _elastic(bars: Any, k: int, size: float, curve: int, curves: Any) -> tuple[float, float]:
    """Return elastic tension and its slope over the length of one bar (before the cut at slack)."""
    if curve < 0:
        return bars[1, k] * (size - bars[0, k]), bars[1, k]
    strain, j = size / bars[0, k] - 1.0, 0
    while j + 2 < curves.shape[2] and strain > curves[curve, 0, j + 1]:
        j += 1
    return curves[curve, 1, j] + curves[curve, 2, j] * (strain - curves[curve, 0, j]), curves[curve, 2, j] / bars[0, k]


@njit(cache=True, error_model="numpy")
def _cut(pull: float, least: float, soft: float) -> tuple[float, float]:
    """Return the larger of ``pull`` and ``least`` and its slope, rounded over a width ``soft`` [N] (0: sharp)."""
    if soft <= 0.0 or least < 0.0:
        return (pull, 1.0) if pull > least else (least, 0.0)
    root = math.sqrt(pull * pull + soft * soft)
    # written so that a slack bar keeps its digits
    value = 0.5 * (pull + root) if pull > 0.0 else 0.5 * soft * soft / (root - pull)
    return value, value / root


@njit(cache=True, error_model="numpy")
def _wet_part(x: Any, water: Any, a: int, b: int, radius: float) -> tuple[float, float]:
    """Return the immersed part of a bar and its slope over height [eq:flexible-immersion]."""
    ha, hb = x[a, 2] - water[6, a], x[b, 2] - water[6, b]
    low, high = min(ha, hb) - radius, max(ha, hb) + radius
    if high <= 0.0:
        return 1.0, 0.0
    if low >= 0.0:
        return 0.0, 0.0
    return -low / (high - low), 1.0 / (high - low)


@njit(cache=True, error_model="numpy")
def _float_part(x: Any, water: Any, nodes: Any, i: int) -> tuple[float, float]:
    """Return the immersed part of an attached body and its slope over height."""
    if nodes[7, i] <= 0.0:
        return 1.0, 0.0
    part = 0.5 - (x[i, 2] - water[6, i]) / nodes[7, i]
    if part <= 0.0 or part >= 1.0:
        return min(max(part, 0.0), 1.0), 0.0
    if nodes[8, i] == 1.0:
        return part * part * (3.0 - 2.0 * part), 6.0 * part * (1.0 - part) / nodes[7, i]
    return part, 1.0 / nodes[7, i]


@njit(cache=True, error_model="numpy")
def forces(x: Any, v: Any, water: Any, system: Any, fluid: Any, bed: Any, force: Any, tension: Any, mass: Any) -> None:
    """Write the force on every node, the tension of every bar and the mass blocks (xx, xy, xz, yy, yz, zz).

    ``fluid`` is density, gravity and the width over which slack and taut are rounded into each other (0: not at all) [N];
    ``bed`` is level, friction, speed below which friction fades, 1 where there is a bed.
    """
    nodes, bars, start, end, curve, curves, hinges, bending, attached = system
    rho, gravity = fluid[0], fluid[1]
    for i in range(x.shape[0]):
        force[i, 0], force[i, 1], force[i, 2] = 0.0, 0.0, -nodes[1, i]
        mass[i, 0] = mass[i, 3] = mass[i, 5] = nodes[0, i]
        mass[i, 1] = mass[i, 2] = mass[i, 4] = 0.0
    t, u = np.empty(3), np.empty(3)
    for k in range(start.size):
        a, b = start[k], end[k]
        size = rate = 0.0
        for axis in range(3):
            t[axis] = x[b, axis] - x[a, axis]
            size += t[axis] * t[axis]
        size = max(math.sqrt(size), 1e-100)
        for axis in range(3):
            t[axis] /= size
            rate += t[axis] * (v[b, axis] - v[a, axis])
        elastic, _ = _elastic(bars, k, size, curve[k], curves)
        pull, _ = _cut(elastic + bars[2, k] * rate, bars[3, k], fluid[2])
        tension[k] = pull
        wet, _ = _wet_part(x, water, a, b, bars[10, k])
        for axis in range(3):
            force[a, axis] += pull * t[axis]
            force[b, axis] -= pull * t[axis]
        even, more = wet * bars[6, k], wet * (bars[7, k] - bars[6, k])
        for side in range(2):
            node = a if side == 0 else b
            along = across = still = 0.0
            for axis in range(3):
                u[axis] = bars[9, k] * water[axis, node] - v[node, axis]
                along += u[axis] * t[axis]
                still += water[3 + axis, node] * t[axis]
            for axis in range(3):
                u[axis] -= along * t[axis]
                across += u[axis] * u[axis]
            across = wet * bars[4, k] * math.sqrt(across)
            slide = wet * bars[5, k] * abs(along) * along
            whole = wet * bars[12, k] + even
            for axis in range(3):
                force[node, axis] += across * u[axis] + slide * t[axis]
                force[node, axis] += whole * water[3 + axis, node] + more * still * t[axis]
            force[node, 2] += wet * bars[8, k]
            mass[node, 0] += even + more * t[0] * t[0]
            mass[node, 1] += more * t[0] * t[1]
            mass[node, 2] += more * t[0] * t[2]
            mass[node, 3] += even + more * t[1] * t[1]
            mass[node, 4] += more * t[1] * t[2]
            mass[node, 5] += even + more * t[2] * t[2]
    for n in range(attached.size):
        i = attached[n]
        part, _ = _float_part(x, water, nodes, i)
        speed = 0.0
        for axis in range(3):
            u[axis] = water[axis, i] - v[i, axis]
            speed += u[axis] * u[axis]
        drag = part * nodes[3, i] * math.sqrt(speed)
        for axis in range(3):
            force[i, axis] += drag * u[axis] + part * (nodes[4, i] + rho * nodes[2, i]) * water[3 + axis, i]
        force[i, 2] += part * rho * gravity * nodes[2, i]
        for row in (0, 3, 5):
            mass[i, row] += part * nodes[4, i]
    for h in range(hinges.shape[0]):
        _bend(x, hinges[h, 0], hinges[h, 1], hinges[h, 2], bending[h], force)
    if bed[3] > 0.0:
        for i in range(x.shape[0]):
            depth = bed[0] - x[i, 2]
            if depth > 0.0:
                push = max(nodes[5, i] * depth - nodes[6, i] * v[i, 2], 0.0)
                force[i, 2] += push
                if bed[1] > 0.0:
                    speed = math.sqrt(v[i, 0] ** 2 + v[i, 1] ** 2 + bed[2] * bed[2])
                    force[i, 0] -= bed[1] * push * v[i, 0] / speed
                    force[i, 1] -= bed[1] * push * v[i, 1] / speed


@njit(cache=True, error_model="numpy")
def _bend(x: Any, a: int, b: int, c: int, stiffness: float, force: Any) -> None:
    """Add the force of one hinge of energy EI/l (1 - t1 . t2) [eq:flexible-bending]."""
    one = two = dot = 0.0
    for axis in range(3):
        p, q = x[b, axis] - x[a, axis], x[c, axis] - x[b, axis]
        one, two, dot = one + p * p, two + q * q, dot + p * q
    one, two = math.sqrt(one), math.sqrt(two)
    cosine = dot / (one * two)
    for axis in range(3):
        p, q = (x[b, axis] - x[a, axis]) / one, (x[c, axis] - x[b, axis]) / two
        first, second = stiffness / one * (q - cosine * p), stiffness / two * (p - cosine * q)
        force[a, axis] -= first
        force[b, axis] += first - second
        force[c, axis] += second


@njit(cache=True, error_model="numpy")
def _add(band: Any, rank: Any, i: int, j: int, block: Any, scale: float) -> None:
    """Add a 3x3 block to the lower band; row r holds columns r - width ... r."""
    width = band.shape[1] - 1
    for p in range(3):
        row = 3 * rank[i] + p
        for q in range(3):
            column = 3 * rank[j] + q
            if column <= row:
                band[row, width - row + column] += scale * block[p, q]


@njit(cache=True, error_model="numpy")
def tangent(
    x: Any, v: Any, water: Any, system: Any, fluid: Any, bed: Any, mass: Any, rank: Any, by_mass: float, by_rate: float,
    by_place: float, band: Any,
) -> None:  # fmt: skip
    """Write ``by_mass M + by_rate C + by_place K`` in its lower band, C and K the derivatives of minus the force.

    The change of drag and added mass with the direction of the bars is left out (it is not symmetric and small);
    Newton's method then converges linearly at a rate far below one. What is held gets a unit row and column.
    """
    nodes, bars, start, end, curve, curves, hinges, bending, attached = system
    band[:] = 0.0
    block, t, u = np.zeros((3, 3)), np.empty(3), np.empty(3)
    for i in range(x.shape[0]):
        block[0, 0], block[0, 1], block[0, 2] = mass[i, 0], mass[i, 1], mass[i, 2]
        block[1, 0], block[1, 1], block[1, 2] = mass[i, 1], mass[i, 3], mass[i, 4]
        block[2, 0], block[2, 1], block[2, 2] = mass[i, 2], mass[i, 4], mass[i, 5]
        _add(band, rank, i, i, block, by_mass)
    for k in range(start.size):
        a, b = start[k], end[k]
        size = rate = 0.0
        for axis in range(3):
            t[axis] = x[b, axis] - x[a, axis]
            size += t[axis] * t[axis]
        size = max(math.sqrt(size), 1e-100)
        for axis in range(3):
            t[axis] /= size
            rate += t[axis] * (v[b, axis] - v[a, axis])
        elastic, slope = _elastic(bars, k, size, curve[k], curves)
        pull, share = _cut(elastic + bars[2, k] * rate, bars[3, k], fluid[2])
        if share > 0.0:
            # compression of a rod destabilises; without its geometric part the matrix stays positive
            side = max(pull, 0.0) / size * by_place
            straight = share * (by_place * slope + by_rate * bars[2, k]) - side
            for p in range(3):
                for q in range(3):
                    block[p, q] = straight * t[p] * t[q] + (side if p == q else 0.0)
            _add(band, rank, a, a, block, 1.0)
            _add(band, rank, b, b, block, 1.0)
            if rank[a] > rank[b]:
                _add(band, rank, a, b, block, -1.0)
            else:
                _add(band, rank, b, a, block, -1.0)
        wet, steep = _wet_part(x, water, a, b, bars[10, k])
        for side_node in range(2):
            node = a if side_node == 0 else b
            along = across = 0.0
            for axis in range(3):
                u[axis] = bars[9, k] * water[axis, node] - v[node, axis]
                along += u[axis] * t[axis]
            for axis in range(3):
                u[axis] -= along * t[axis]
                across += u[axis] * u[axis]
            across = math.sqrt(across)
            normal, skin = wet * bars[4, k] * by_rate, 2.0 * wet * bars[5, k] * abs(along) * by_rate
            for p in range(3):
                for q in range(3):
                    block[p, q] = skin * t[p] * t[q] + normal * across * ((1.0 if p == q else 0.0) - t[p] * t[q])
                    if across > 0.0:
                        block[p, q] += normal * u[p] * u[q] / across
            block[2, 2] += by_place * bars[8, k] * steep
            _add(band, rank, node, node, block, 1.0)
    for n in range(attached.size):
        i = attached[n]
        part, steep = _float_part(x, water, nodes, i)
        speed = 0.0
        for axis in range(3):
            u[axis] = water[axis, i] - v[i, axis]
            speed += u[axis] * u[axis]
        speed = math.sqrt(speed)
        for p in range(3):
            for q in range(3):
                block[p, q] = 0.0
                if speed > 0.0:
                    block[p, q] = by_rate * part * nodes[3, i] * (u[p] * u[q] / speed + (speed if p == q else 0.0))
        block[2, 2] += by_place * steep * fluid[0] * fluid[1] * nodes[2, i]
        _add(band, rank, i, i, block, 1.0)
    for h in range(hinges.shape[0]):
        _bend_tangent(x, hinges[h, 0], hinges[h, 1], hinges[h, 2], bending[h] * by_place, rank, band)
    if bed[3] > 0.0:
        for i in range(x.shape[0]):
            depth = bed[0] - x[i, 2]
            if depth > 0.0:
                block[:] = 0.0
                push = nodes[5, i] * depth - nodes[6, i] * v[i, 2]
                if push > 0.0:
                    block[2, 2] = by_place * nodes[5, i] + by_rate * nodes[6, i]
                    speed = math.sqrt(v[i, 0] ** 2 + v[i, 1] ** 2 + bed[2] * bed[2])
                    for p in range(2):
                        block[p, p] = by_rate * bed[1] * push / speed
                _add(band, rank, i, i, block, 1.0)
    width = band.shape[1] - 1
    for i in range(x.shape[0]):
        for axis in range(3):
            if nodes[9 + axis, i] == 0.0:
                row = 3 * rank[i] + axis
                for column in range(width):
                    band[row, column] = 0.0
                for below in range(1, width + 1):
                    if row + below < band.shape[0]:
                        band[row + below, width - below] = 0.0
                band[row, width] = 1.0


@njit(cache=True, error_model="numpy")
def _bend_tangent(x: Any, a: int, b: int, c: int, stiffness: float, rank: Any, band: Any) -> None:
    """Add the positive part of the stiffness of a hinge: that of a stiffness against the turn, k (dt2 - dt1)^2 / 2."""
    one = two = 0.0
    p, q = np.empty(3), np.empty(3)
    for axis in range(3):
        p[axis], q[axis] = x[b, axis] - x[a, axis], x[c, axis] - x[b, axis]
        one, two = one + p[axis] ** 2, two + q[axis] ** 2
    one, two = math.sqrt(one), math.sqrt(two)
    left, right = np.empty((3, 3)), np.empty((3, 3))
    for i in range(3):
        for j in range(3):
            same = 1.0 if i == j else 0.0
            left[i, j] = (same - p[i] * p[j] / one**2) / one
            right[i, j] = (same - q[i] * q[j] / two**2) / two
    # dt1 = left (xb - xa), dt2 = right (xc - xb): the turn is left xa - (left + right) xb + right xc
    nodes = (a, b, c)
    parts = (left, -(left + right), right)
    for m in range(3):
        for n in range(3):
            if rank[nodes[m]] > rank[nodes[n]] or m == n:
                _add(band, rank, nodes[m], nodes[n], parts[m].T @ parts[n], stiffness)


@njit(cache=True, error_model="numpy", fastmath={"contract", "reassoc"})
def factor(band: Any) -> bool:
    """Cholesky's factor of a banded matrix in place; False when it is not positive."""
    size, width = band.shape[0], band.shape[1] - 1
    for row in range(size):
        first = max(0, row - width)
        for column in range(first, row):
            start = max(first, column - width)
            total = band[row, width - row + column]
            left, right = width - row, width - column
            for k in range(start, column):
                total -= band[row, left + k] * band[column, right + k]
            band[row, width - row + column] = total * band[column, width]
        total = band[row, width]
        for k in range(width - row + first, width):
            total -= band[row, k] * band[row, k]
        if not total > 0.0:
            return False
        # the diagonal keeps one over the root
        band[row, width] = 1.0 / math.sqrt(total)
    return True


@njit(cache=True, error_model="numpy", fastmath={"contract", "reassoc"})
def solve(band: Any, right: Any) -> None:
    """Solve with the factor, in place."""
    size, width = band.shape[0], band.shape[1] - 1
    for row in range(size):
        total = right[row]
        for column in range(max(0, row - width), row):
            total -= band[row, width - row + column] * right[column]
        right[row] = total * band[row, width]
    for row in range(size - 1, -1, -1):
        value = right[row] * band[row, width]
        right[row] = value
        for column in range(max(0, row - width), row):
            right[column] -= band[row, width - row + column] * value


@njit(cache=True, error_model="numpy")
def _largest_step(change: Any) -> float:
    most = 0.0
    for i in range(change.size):
        most = max(most, abs(change[i]))
    return most


@njit(cache=True, error_model="numpy")
def _masked_norm(force: Any, nodes: Any) -> tuple[float, int]:
    """Return the largest force on a free component and its node."""
    most, worst = 0.0, 0
    for i in range(force.shape[0]):
        for axis in range(3):
            size = abs(force[i, axis]) * nodes[9 + axis, i]
            if not size <= most:
                most, worst = size, i
    return most, worst


@njit(cache=True, error_model="numpy")
def relax(
    x: Any, water: Any, system: Any, fluid: Any, bed: Any, rank: Any, band: Any, pace: float, reach: float,
    tolerance: float, noise: float, most: int, tension: Any,
) -> tuple[int, float, int]:  # fmt: skip
    """Bring a network to rest: implicit steps of growing length whose velocity is dropped, ending in Newton's method.

    [eq:flexible-relaxation]. ``pace`` is the first pseudo time step [s], ``reach`` the furthest that a node may go in one
    step [m], ``noise`` the rounding of the forces [N]. Returns the number of steps, the largest force left over the largest force at work, and its node.
    """
    nodes = system[0]
    count = x.shape[0]
    force, trial, v = np.empty((count, 3)), np.empty((count, 3)), np.zeros((count, 3))
    mass, change = np.empty((count, 6)), np.empty(3 * count)
    scale = 1e-300
    for i in range(count):
        scale = max(scale, nodes[1, i] + fluid[0] * fluid[1] * nodes[2, i])
    fluid[2] = scale
    forces(x, v, water, system, fluid, bed, force, tension, mass)
    left, worst = _masked_norm(force, nodes)
    for step in range(most):
        for k in range(tension.size):
            scale = max(scale, abs(tension[k]))
        enough = max(tolerance * scale, noise)
        if left <= enough:
            if fluid[2] <= 0.1 * enough:
                return step, left / scale, worst
            fluid[2] = 0.1 * enough
            forces(x, v, water, system, fluid, bed, force, tension, mass)
            left, worst = _masked_norm(force, nodes)
        tangent(x, v, water, system, fluid, bed, mass, rank, 1.0 / (pace * pace), 1.0 / pace, 1.0, band)
        if not factor(band):
            pace *= 0.25
            continue
        for i in range(count):
            for axis in range(3):
                change[3 * rank[i] + axis] = force[i, axis] * nodes[9 + axis, i]
        solve(band, change)
        longest = _largest_step(change)
        if not longest < np.inf:
            pace *= 0.25
            continue
        cut = min(1.0, reach / longest) if longest > 0.0 else 1.0
        for i in range(count):
            for axis in range(3):
                trial[i, axis] = x[i, axis] + cut * change[3 * rank[i] + axis]
        before = left
        forces(trial, v, water, system, fluid, bed, force, tension, mass)
        left, worst = _masked_norm(force, nodes)
        if not left < 1e3 * max(before, 1e-6 * scale) and pace > 1e-6:
            pace *= 0.25
            forces(x, v, water, system, fluid, bed, force, tension, mass)
            left, worst = _masked_norm(force, nodes)
            continue
        x[:] = trial
        # switched evolution: the pseudo time grows as the force falls, and shrinks faster where it rises
        growth = before / max(left, 1e-300)
        growth = min(1.3 * growth, 10.0) if growth >= 1.0 else max(0.5 * growth, 0.1)
        pace = min(pace * (growth if cut == 1.0 else min(growth, 1.0)), 1e8)
        if 0.3 * left < fluid[2]:
            # slack and taut are told apart the more sharply the nearer the rest
            fluid[2] = max(0.3 * left, 0.05 * enough)
            forces(x, v, water, system, fluid, bed, force, tension, mass)
            left, worst = _masked_norm(force, nodes)
    return most, left / scale, worst
