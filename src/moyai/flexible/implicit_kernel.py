"""Compiled kernels of statics and of the implicit schemes: forces, their tangent, a banded solver, Newton's method.

Arrays run over nodes first (n, 3). Unknowns stand in the order of ``rank`` (reverse Cuthill-McKee), so that the
matrix of a
line is block tridiagonal and that of a net has the band of its narrow side. ``system`` is (nodes, bars, start, end,
curve,
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

    ``fluid`` is density, gravity and the width over which slack and taut are rounded into each other (0: not at all)
    [N];
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
            if depth > 0.0 or fluid[2] > 0.0:
                push, _ = _cut(nodes[5, i] * depth - nodes[6, i] * v[i, 2], 0.0, fluid[2])
                force[i, 2] += push
                if bed[1] > 0.0:
                    speed = math.sqrt(v[i, 0] ** 2 + v[i, 1] ** 2 + bed[2] * bed[2])
                    force[i, 0] -= bed[1] * push * v[i, 0] / speed
                    force[i, 1] -= bed[1] * push * v[i, 1] / speed


@njit(cache=True, error_model="numpy")
def _bend(x: Any, a: int, b: int, c: int, stiffness: Any, force: Any) -> None:
    """Add the force of one hinge [eq:flexible-bending]."""
    one, two = stiffness[1], stiffness[2]
    for axis in range(3):
        turn = stiffness[0] * ((x[c, axis] - x[b, axis]) * two - (x[b, axis] - x[a, axis]) * one)
        force[a, axis] -= turn * one
        force[b, axis] += turn * (one + two)
        force[c, axis] -= turn * two


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
        _bend_tangent(hinges[h, 0], hinges[h, 1], hinges[h, 2], bending[h], by_place, rank, band)
    if bed[3] > 0.0:
        for i in range(x.shape[0]):
            depth = bed[0] - x[i, 2]
            if depth > 0.0 or fluid[2] > 0.0:
                block[:] = 0.0
                push, part = _cut(nodes[5, i] * depth - nodes[6, i] * v[i, 2], 0.0, fluid[2])
                if part > 0.0:
                    block[2, 2] = part * (by_place * nodes[5, i] + by_rate * nodes[6, i])
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
def _bend_tangent(a: int, b: int, c: int, stiffness: Any, scale: float, rank: Any, band: Any) -> None:
    """Add the stiffness of a hinge, which does not change."""
    nodes = (a, b, c)
    parts = (stiffness[1], -stiffness[1] - stiffness[2], stiffness[2])
    same = np.eye(3)
    for m in range(3):
        for n in range(3):
            if rank[nodes[m]] > rank[nodes[n]] or m == n:
                _add(band, rank, nodes[m], nodes[n], same, scale * stiffness[0] * parts[m] * parts[n])


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

    [eq:flexible-relaxation]. ``pace`` is the first pseudo time step [s], ``reach`` the furthest that a node may go in
    one
    step [m], ``noise`` the rounding of the forces [N]. Returns the number of steps, the largest force left over the
    largest force at work, and its node.
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


@njit(cache=True, error_model="numpy")
def _driven_place(x: Any, v: Any, driving: Any, now: float) -> None:
    """Put driven nodes at their place and velocity of ``now``."""
    driven, rest, tables, start, step = driving
    last = tables.shape[1] - 1
    place = (now - start) / step
    row = int(place)
    row = 0 if row < 0 else (last - 1 if row > last - 1 else row)
    s = place - row
    for d in range(driven.shape[0]):
        node, table = driven[d, 0], driven[d, 1]
        for axis in range(3):
            p0, p1 = tables[table, row, axis], tables[table, row + 1, axis]
            v0, v1 = tables[table, row, 3 + axis] * step, tables[table, row + 1, 3 + axis] * step
            bend, twist = 3.0 * (p1 - p0) - 2.0 * v0 - v1, v0 + v1 - 2.0 * (p1 - p0)
            x[node, axis] = rest[d, axis] + p0 + s * (v0 + s * (bend + s * twist))
            v[node, axis] = (v0 + s * (2.0 * bend + 3.0 * s * twist)) / step


@njit(cache=True, error_model="numpy")
def _water_at(water: Any, base: Any, rate: Any, ahead: float, moving: bool) -> None:
    if moving:
        for r in range(7):
            for i in range(water.shape[1]):
                water[r, i] = base[r, i] + ahead * rate[r, i]


@njit(cache=True, error_model="numpy")
def _measure(change: Any, x: Any, start: Any, end: Any, spring: Any, length: float, pull: float) -> float:
    """Return a change of place in units of what is allowed: [m] for nodes, [N] of tension for bars."""
    most = 0.0
    for i in range(change.shape[0]):
        for axis in range(3):
            size = abs(change[i, axis]) / length
            if not size <= most:
                most = size
    for k in range(start.size):
        a, b = start[k], end[k]
        size = dot = 0.0
        for axis in range(3):
            t = x[b, axis] - x[a, axis]
            size += t * t
            dot += t * (change[b, axis] - change[a, axis])
        value = abs(dot) / max(math.sqrt(size), 1e-100) * spring[k] / pull
        if not value <= most:
            most = value
    return most


@njit(cache=True, error_model="numpy")
def _mass_times(mass: Any, u: Any, nodes: Any, out: Any, sign: float) -> None:
    for i in range(u.shape[0]):
        out[i, 0] += sign * (mass[i, 0] * u[i, 0] + mass[i, 1] * u[i, 1] + mass[i, 2] * u[i, 2])
        out[i, 1] += sign * (mass[i, 1] * u[i, 0] + mass[i, 3] * u[i, 1] + mass[i, 4] * u[i, 2])
        out[i, 2] += sign * (mass[i, 2] * u[i, 0] + mass[i, 4] * u[i, 1] + mass[i, 5] * u[i, 2])
        for axis in range(3):
            out[i, axis] *= nodes[9 + axis, i]


@njit(cache=True, error_model="numpy")
def _pack(values: Any, rank: Any, out: Any) -> None:
    for i in range(values.shape[0]):
        for axis in range(3):
            out[3 * rank[i] + axis] = values[i, axis]


@njit(cache=True, error_model="numpy")
def acceleration(
    x: Any, v: Any, water: Any, system: Any, fluid: Any, bed: Any, rank: Any, tension: Any, mass: Any, result: Any
) -> None:
    """Write the acceleration of what is free."""
    nodes = system[0]
    forces(x, v, water, system, fluid, bed, result, tension, mass)
    for i in range(x.shape[0]):
        fx, fy, fz = nodes[9, i] * result[i, 0], nodes[10, i] * result[i, 1], nodes[11, i] * result[i, 2]
        px, py, pz = nodes[9, i], nodes[10, i], nodes[11, i]
        a, b, c = mass[i, 0], mass[i, 1] * px * py, mass[i, 2] * px * pz
        d, e, f = mass[i, 3], mass[i, 4] * py * pz, mass[i, 5]
        p, q, s = d * f - e * e, c * e - b * f, b * e - c * d
        whole = 1.0 / (a * p + b * q + c * s)
        result[i, 0] = whole * (p * fx + q * fy + s * fz)
        result[i, 1] = whole * (q * fx + (a * f - c * c) * fy + (b * c - a * e) * fz)
        result[i, 2] = whole * (s * fx + (b * c - a * e) * fy + (a * d - b * b) * fz)


@njit(cache=True, error_model="numpy")
def _stage(
    h: float, gain: float, ahead: Any, across: Any, guess: Any, system: Any, fluid: Any, bed: Any, rank: Any, band: Any,
    fresh: bool, water: Any, driving: Any, now: float, limits: Any, place: Any, speed: Any, mass: Any, tension: Any,
    force: Any, right: Any, change: Any, counts: Any,
) -> int:  # fmt: skip
    """Solve one stage for its acceleration ``guess`` by Newton's method; 0 when solved, 1 when not.

    ``limits`` is allowed error of place, allowed error of tension. The factor in ``band`` is kept as long as it serves.
    """
    nodes, start, end = system[0], system[2], system[3]
    spring = system[1][1]
    count = guess.shape[0]
    last = math.inf
    for _ in range(12):
        for i in range(count):
            for axis in range(3):
                speed[i, axis] = across[i, axis] + gain * guess[i, axis]
                place[i, axis] = ahead[i, axis] + gain * speed[i, axis]
        _driven_place(place, speed, driving, now)
        forces(place, speed, water, system, fluid, bed, force, tension, mass)
        counts[0] += 1
        _mass_times(mass, guess, nodes, force, -1.0)
        if fresh:
            tangent(place, speed, water, system, fluid, bed, mass, rank, 1.0, gain, gain * gain, band)
            counts[1] += 1
            if not factor(band):
                return 1
            fresh = False
        _pack(force, rank, right)
        solve(band, right)
        for i in range(count):
            for axis in range(3):
                step = right[3 * rank[i] + axis] * nodes[9 + axis, i]
                guess[i, axis] += step
                # a short step must not hide an error of the velocity behind its own square
                change[i, axis] = gain * max(gain, 0.02) * step
        size = _measure(change, place, start, end, spring, limits[0], limits[1])
        if not size < 1e12:
            return 1
        if size <= 0.02:
            for i in range(count):
                for axis in range(3):
                    speed[i, axis] = across[i, axis] + gain * guess[i, axis]
                    place[i, axis] = ahead[i, axis] + gain * speed[i, axis]
            _driven_place(place, speed, driving, now)
            return 0
        # a bar that turned slack or taut wants a new tangent
        if size > 0.3 * last:
            fresh = True
        last = size
    return 1


@njit(cache=True, error_model="numpy")
def _energies(x: Any, v: Any, mass: Any, system: Any) -> tuple[float, float]:
    """Return kinetic energy of what is free and elastic energy of bars and hinges [J]."""
    nodes, bars, start, end, curve, curves, hinges, bending, _ = system
    kinetic = elastic = 0.0
    for i in range(x.shape[0]):
        p, q, s = nodes[9, i] * v[i, 0], nodes[10, i] * v[i, 1], nodes[11, i] * v[i, 2]
        kinetic += 0.5 * (mass[i, 0] * p * p + mass[i, 3] * q * q + mass[i, 5] * s * s)
        kinetic += mass[i, 1] * p * q + mass[i, 2] * p * s + mass[i, 4] * q * s
    for k in range(start.size):
        size = 0.0
        for axis in range(3):
            size += (x[end[k], axis] - x[start[k], axis]) ** 2
        stretch = math.sqrt(size) - bars[0, k]
        if curve[k] < 0:
            if bars[1, k] * stretch > bars[3, k]:
                elastic += 0.5 * bars[1, k] * stretch * stretch
        elif stretch > 0.0:
            strain, j, area, table = stretch / bars[0, k], 0, 0.0, curves[curve[k]]
            while j + 2 < table.shape[1] and strain > table[0, j + 1]:
                area += 0.5 * (table[1, j] + table[1, j + 1]) * (table[0, j + 1] - table[0, j])
                j += 1
            rest = strain - table[0, j]
            elastic += bars[0, k] * (area + rest * (table[1, j] + 0.5 * table[2, j] * rest))
    for h in range(hinges.shape[0]):
        for axis in range(3):
            p = x[hinges[h, 1], axis] - x[hinges[h, 0], axis]
            q = x[hinges[h, 2], axis] - x[hinges[h, 1], axis]
            elastic += 0.5 * bending[h, 0] * (q * bending[h, 2] - p * bending[h, 1]) ** 2
    return kinetic, elastic


@njit(cache=True, error_model="numpy")
def _powers(x: Any, v: Any, force: Any, system: Any, fluid: Any, own: Any, tension: Any, result: Any) -> None:
    """Write the power of the loads on what is free and of the driven points on the bars [W]."""
    nodes, bars, start, end, curve, curves, hinges, bending, _ = system
    own[:] = 0.0
    for k in range(start.size):
        a, b = start[k], end[k]
        size = rate = 0.0
        for axis in range(3):
            t = x[b, axis] - x[a, axis]
            size += t * t
            rate += t * (v[b, axis] - v[a, axis])
        size = max(math.sqrt(size), 1e-100)
        elastic, _ = _elastic(bars, k, size, curve[k], curves)
        pull, _ = _cut(elastic + bars[2, k] * rate / size, bars[3, k], fluid[2])
        for axis in range(3):
            t = (x[b, axis] - x[a, axis]) / size
            own[a, axis] += pull * t
            own[b, axis] -= pull * t
    for h in range(hinges.shape[0]):
        _bend(x, hinges[h, 0], hinges[h, 1], hinges[h, 2], bending[h], own)
    result[0] = result[1] = 0.0
    for i in range(x.shape[0]):
        for axis in range(3):
            if nodes[9 + axis, i] > 0.0:
                result[0] += (force[i, axis] - own[i, axis]) * v[i, axis]
            else:
                result[1] -= own[i, axis] * v[i, axis]


@njit(cache=True, error_model="numpy")
def implicit_march(
    x: Any, v: Any, a: Any, system: Any, rank: Any, band: Any, fluid: Any, bed: Any, water: Any, driving: Any,
    method: Any, control: Any, timing: Any, ledger: Any, saved: Any, counts: Any,
) -> tuple[int, int, float, int]:  # fmt: skip
    """Advance by rows of the result with an error-controlled implicit Runge-Kutta method [eq:flexible-dirk].

    ``water`` is (now, at the start, rate, moving); ``method`` is (stages, embedded, exponent); ``control`` is 0 step, 1
    smallest step, 2 largest step, 3 tolerance, 4 length for the error of place, 5 largest tension so far, 6 fixed
    step (1) or
    not (0), 7 whether ``a`` is known; ``counts`` is force evaluations, factorisations, steps, rejected steps. Returns
    status,
    good rows, time reached, node of the largest acceleration.
    """
    nodes, start, end = system[0], system[2], system[3]
    spring = system[1][1]
    stages, embedded, exponent = method
    now_water, base, rate, moving = water
    time, interval, rows, first_row = timing
    places, pulls, peaks, energy, keep_nodes, keep_bars = saved
    count, many = x.shape[0], stages.shape[0]
    gamma = stages[1, 1]
    vs, accelerations = np.zeros((many, count, 3)), np.zeros((many, count, 3))
    ahead, across, place, speed = np.empty((count, 3)), np.empty((count, 3)), np.empty((count, 3)), np.empty((count, 3))
    force, change, own = np.empty((count, 3)), np.empty((count, 3)), np.empty((count, 3))
    mass, old_mass, right = np.empty((count, 6)), np.empty((count, 6)), np.empty(3 * count)
    tension, peak = np.zeros(start.size), np.full(start.size, -1e300)
    limits, powers, before = np.empty(2), np.zeros(2), np.zeros(2)
    begin = time
    _water_at(now_water, base, rate, 0.0, moving)
    acceleration(x, v, now_water, system, fluid, bed, rank, tension, mass, a)
    old_mass[:] = mass
    forces(x, v, now_water, system, fluid, bed, force, tension, mass)
    _powers(x, v, force, system, fluid, own, tension, before)
    for row in range(rows):
        target = begin + (row + 1) * interval
        while time < target - 1e-9 * interval:
            h = control[0]
            remaining = target - time
            h = remaining / math.ceil(remaining / h * (1.0 - 1e-9))
            limits[0], limits[1] = control[3] * control[4], control[3] * control[5]
            gain = gamma * h
            vs[0], accelerations[0] = v, a
            bad, fresh = 0, True
            for s in range(1, many):
                part = 0.0
                for j in range(s + 1):
                    part += stages[s, j]
                for i in range(count):
                    for axis in range(3):
                        p, q = x[i, axis], v[i, axis]
                        for j in range(s):
                            p += h * stages[s, j] * vs[j, i, axis]
                            q += h * stages[s, j] * accelerations[j, i, axis]
                        ahead[i, axis], across[i, axis] = p, q
                        accelerations[s, i, axis] = accelerations[s - 1, i, axis]
                _water_at(now_water, base, rate, time + part * h - begin, moving)
                bad = _stage(
                    h, gain, ahead, across, accelerations[s], system, fluid, bed, rank, band, fresh, now_water, driving,
                    time + part * h, limits, place, speed, mass, tension, force, right, change, counts,
                )  # fmt: skip
                if bad > 0:
                    break
                fresh = False
                vs[s] = speed
            error = math.inf
            if bad == 0:
                for i in range(count):
                    for axis in range(3):
                        total = 0.0
                        for j in range(many):
                            total += (stages[many - 1, j] - embedded[j]) * vs[j, i, axis]
                        change[i, axis] = h * total * nodes[9 + axis, i]
                # the stiff part of the estimate is filtered by the matrix of the step
                own[:] = 0.0
                _mass_times(mass, change, nodes, own, 1.0)
                _pack(own, rank, right)
                solve(band, right)
                for i in range(count):
                    for axis in range(3):
                        change[i, axis] = right[3 * rank[i] + axis]
                error = _measure(change, place, start, end, spring, limits[0], limits[1])
            if control[6] > 0.0:
                if bad > 0:
                    return STUCK, row, time, 0
            elif not error <= 1.0:
                counts[3] += 1
                control[0] = h * (0.25 if bad > 0 or not error < 1e6 else max(0.2, 0.9 * error**-exponent))
                if control[0] < control[1]:
                    _, worst = _masked_norm(force, nodes)
                    return STUCK, row, time, worst
                continue
            x[:], v[:], a[:] = place, speed, accelerations[many - 1]
            time += h
            counts[2] += 1
            forces(x, v, now_water, system, fluid, bed, force, tension, mass)
            for k in range(start.size):
                peak[k] = max(peak[k], tension[k])
                control[5] = max(control[5], abs(tension[k]))
            _powers(x, v, force, system, fluid, own, tension, powers)
            ledger[0] += 0.5 * h * (powers[0] + before[0])
            ledger[1] += 0.5 * h * (powers[1] + before[1])
            before[:] = powers
            new, _ = _energies(x, v, mass, system)
            old, _ = _energies(x, v, old_mass, system)
            ledger[2] += new - old
            old_mass[:] = mass
            if control[6] == 0.0:
                control[0] = min(control[2], h * min(4.0, 0.9 * max(error, 1e-8) ** -exponent))
        kinetic, elastic = _energies(x, v, mass, system)
        out = first_row + row
        energy[out, 0], energy[out, 1], energy[out, 2] = kinetic, elastic, ledger[0] + ledger[1] + ledger[2]
        for j in range(keep_nodes.size):
            for axis in range(3):
                places[out, j, axis] = x[keep_nodes[j], axis]
        for j in range(keep_bars.size):
            pulls[out, j] = tension[keep_bars[j]]
            peaks[out, j] = peak[keep_bars[j]]
        peak[:] = tension
        if not (kinetic + elastic < np.inf):
            return NOT_FINITE, row, time, 0
    return GOOD, rows, time, 0
