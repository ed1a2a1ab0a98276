"""Compiled kernels of sheets, net panels and elastic rings for the implicit schemes, modes and statics.

Forces, energies and derivatives on arrays that run over nodes first (n, 3). ``parts`` is what
:func:`moyai.flexible.parts.kernel_parts` returns, or ``None`` for a network of bars alone: (constants of the
triangles, the same without pressure, triangles, their highest pulls, zeros (4, n)), (panels, half the density, forces
of each), rings, addresses of their blocks in the fronts.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from moyai.core.compiled import njit
from moyai.flexible import sheet_kernel as sheet
from moyai.flexible.front_kernel import add_elements
from moyai.flexible.panel_kernel import _on_one, panel_forces
from moyai.flexible.ring_kernel import ring_loads
from moyai.flexible.sheet_kernel import (
    _strain,
    sheet_added_mass,
    sheet_energy,
    sheet_forces,
    sheet_loads,
    tensile_stress,
    wet_share,
)


@njit(cache=True, error_model="numpy")
def part_forces(x: Any, v: Any, water: Any, parts: Any, inner: bool, force: Any) -> None:
    """Add the forces of all parts to ``force``; those of stress alone (no pressure, no water) if ``inner``."""
    (table, dry, triangles, peak, light), (panels, half_density, each), rings, _ = parts
    if panels[0].shape[0] > 0 and not inner:
        panel_forces(x, v, water, panels, half_density, force, each)
    if triangles.shape[0] == 0 and rings[0].size == 0:
        return
    count = x.shape[0]
    place, speed, total = np.empty((3, count)), np.empty((3, count)), np.zeros((3, count))
    for i in range(count):
        for axis in range(3):
            place[axis, i], speed[axis, i] = x[i, axis], v[i, axis]
    if triangles.shape[0] > 0:
        # views of one row after the other, as the explicit scheme has them
        flat, fast, out = place.reshape(3 * count), speed.reshape(3 * count), total.reshape(3 * count)
        sheet_forces(dry if inner else table, triangles, flat, 0, fast, 0, out, 0, 1, count, peak)
        if not inner:
            sheet_loads(table, triangles, flat, 0, fast, 0, water.reshape(7 * count), 0, out, 0, 1, count, light, 0.0)
    if rings[0].size > 0:
        moments = np.empty((rings[0].size, 3))
        ring_loads(place[0], place[1], place[2], rings, total[0], total[1], total[2], moments)
    for i in range(count):
        for axis in range(3):
            force[i, axis] += total[axis, i]


@njit(cache=True, error_model="numpy")
def part_masses(x: Any, water: Any, parts: Any, mass: Any) -> None:
    """Add the water that sheets take along to the mass blocks of the nodes."""
    (table, _, triangles, _, _), _, _, _ = parts
    count = x.shape[0]
    if triangles.shape[0] > 0:
        sheet_added_mass(
            table, triangles, x.reshape(3 * count), 0, 3, 1, water.reshape(7 * count), 0, 1, count,
            mass.reshape(6 * count), 0, 6, 1,
        )  # fmt: skip


@njit(cache=True, error_model="numpy")
def part_energy(x: Any, parts: Any) -> float:
    """Return the elastic energy of sheets and rings [J]."""
    (table, _, triangles, _, _), _, rings, _ = parts
    energy, count = 0.0, x.shape[0]
    if triangles.shape[0] > 0:
        energy += sheet_energy(table, triangles, x.reshape(3 * count), 0, 3, 1)
    if rings[0].size > 0:
        place, spare = np.empty((3, count)), np.zeros((3, count))
        for i in range(count):
            for axis in range(3):
                place[axis, i] = x[i, axis]
        moments = np.empty((rings[0].size, 3))
        energy += ring_loads(place[0], place[1], place[2], rings, spare[0], spare[1], spare[2], moments)
    return energy


@njit(cache=True, error_model="numpy")
def stress_slope(C: Any, t: int, e11: float, e22: float, shear: float, D: Any) -> tuple[float, float, float, int]:
    """Write the derivative (3, 3) of the stresses over the strains (E11, E22, 2 E12); return stresses and state.

    The energy of a wrinkled triangle is the largest over all directions of the pull: its second derivative follows
    from that of the direction [eq:flexible-wrinkle-slope].
    """
    s11, s22, s12, _, state = tensile_stress(C, t, e11, e22, shear)
    for i in range(3):
        for j in range(3):
            D[i, j] = 0.0
    law = C[t, sheet.LAW]
    if law == sheet.THREADS:
        D[0, 0] = C[t, sheet.C11] if s11 > 0.0 else 0.0
        D[1, 1] = C[t, sheet.C22] if s22 > 0.0 else 0.0
    elif state == 2:
        D[0, 0], D[1, 1], D[0, 1], D[1, 0], D[2, 2] = (
            C[t, sheet.C11],
            C[t, sheet.C22],
            C[t, sheet.C12],
            C[t, sheet.C12],
            C[t, sheet.C33],
        )
    elif state == 1 and s11 + s22 > 0.0:
        # in stretched axes, in which both families of threads are as stiff
        warp, weft, more = C[t, sheet.WARP], C[t, sheet.WEFT], C[t, sheet.BEND]
        stretch = (warp, weft, math.sqrt(warp * weft))
        first, second = s11 / warp, s22 / weft
        pull = first + second
        c, s = (first - second) / pull, 2.0 * s12 / stretch[2] / pull
        half, turn = 0.5 * (warp * e11 - weft * e22), 0.5 * stretch[2] * shear
        soft, softest = 1.0 + more * s * s, 2.0 * more * (c * c - s * s)
        rise, bend = turn * c - half * s, -half * c - turn * s
        falls = -(rise * rise / soft + pull * bend - 0.5 * pull * pull * softest)
        along = (0.5 * (1.0 + c), 0.5 * (1.0 - c), 0.5 * s)
        by = -rise / soft
        aside = (by * along[0] - 0.5 * pull * s, by * along[1] + 0.5 * pull * s, by * along[2] + 0.5 * pull * c)
        for i in range(3):
            for j in range(3):
                D[i, j] = stretch[i] * stretch[j] * along[i] * along[j] / soft
                if falls > 0.0:
                    D[i, j] += stretch[i] * stretch[j] * aside[i] * aside[j] / falls
    return s11, s22, s12, state


@njit(cache=True, error_model="numpy")
def _positive(s11: float, s22: float, s12: float) -> tuple[float, float, float]:
    """Return the part of a plane stress that pulls."""
    mean, half = 0.5 * (s11 + s22), 0.5 * (s11 - s22)
    size = math.sqrt(half * half + s12 * s12)
    if mean - size >= 0.0:
        return s11, s22, s12
    if mean + size <= 0.0:
        return 0.0, 0.0, 0.0
    c, s = half / size, s12 / size
    pull = mean + size
    return 0.5 * pull * (1.0 + c), 0.5 * pull * (1.0 - c), 0.5 * pull * s


@njit(cache=True, error_model="numpy")
def sheet_blocks(
    C: Any, triangles: Any, x: Any, v: Any, water: Any, by_rate: float, by_place: float, exact: bool, width: float,
    blocks: Any,
) -> None:  # fmt: skip
    """Write ``by_rate C + by_place K`` of every triangle, (t, 3, 3, 3, 3), C and K the derivatives of minus its force.

    ``exact`` adds the turn of the drag with the triangle (by central differences over ``width`` [m], where the water
    moves past it) and keeps the destabilising part of a stress that pushes.
    """
    p, q, D = np.empty(6), np.empty(6), np.empty((3, 3))
    f, r, g = np.empty((2, 3)), np.empty((2, 3)), np.empty((3, 2))
    B, G = np.empty((3, 9)), np.empty((3, 9))
    for t in range(triangles.shape[0]):
        i, j, k = triangles[t, 0], triangles[t, 1], triangles[t, 2]
        for axis in range(3):
            p[axis], p[3 + axis] = x[j, axis] - x[i, axis], x[k, axis] - x[i, axis]
            q[axis], q[3 + axis] = v[j, axis] - v[i, axis], v[k, axis] - v[i, axis]
        damping, area = C[t, sheet.DAMPING], C[t, sheet.AREA]
        e11, e22, shear = _strain(C, t, p, q, damping)
        s11, s22, s12, _ = stress_slope(C, t, e11, e22, shear, D)
        a, b, c, d = C[t, sheet.E11], C[t, sheet.E12], C[t, sheet.E21], C[t, sheet.E22]
        g[0, 0], g[0, 1], g[1, 0], g[1, 1], g[2, 0], g[2, 1] = -a - c, -b - d, a, b, c, d
        for axis in range(3):
            f[0, axis], f[1, axis] = p[axis] * a + p[3 + axis] * c, p[axis] * b + p[3 + axis] * d
            r[0, axis], r[1, axis] = q[axis] * a + q[3 + axis] * c, q[axis] * b + q[3 + axis] * d
        whole, slow = by_place + by_rate * damping, by_place * damping
        for m in range(3):
            for axis in range(3):
                col = 3 * m + axis
                B[0, col], B[1, col] = g[m, 0] * f[0, axis], g[m, 1] * f[1, axis]
                B[2, col] = g[m, 0] * f[1, axis] + g[m, 1] * f[0, axis]
                G[0, col] = whole * B[0, col] + slow * g[m, 0] * r[0, axis]
                G[1, col] = whole * B[1, col] + slow * g[m, 1] * r[1, axis]
                G[2, col] = whole * B[2, col] + slow * (g[m, 0] * r[1, axis] + g[m, 1] * r[0, axis])
        if not exact and C[t, sheet.LAW] == sheet.LINEAR:
            s11, s22, s12 = _positive(s11, s22, s12)
        for m in range(3):
            for n in range(3):
                side = g[m, 0] * g[n, 0] * s11 + g[m, 1] * g[n, 1] * s22
                side = by_place * area * (side + (g[m, 0] * g[n, 1] + g[m, 1] * g[n, 0]) * s12)
                for one in range(3):
                    row = 3 * m + one
                    d0 = B[0, row] * D[0, 0] + B[1, row] * D[1, 0] + B[2, row] * D[2, 0]
                    d1 = B[0, row] * D[0, 1] + B[1, row] * D[1, 1] + B[2, row] * D[2, 1]
                    d2 = B[0, row] * D[0, 2] + B[1, row] * D[1, 2] + B[2, row] * D[2, 2]
                    for two in range(3):
                        col = 3 * n + two
                        blocks[t, m, n, one, two] = area * (d0 * G[0, col] + d1 * G[1, col] + d2 * G[2, col])
                    blocks[t, m, n, one, one] += side
        if C[t, sheet.PRESSURE] != 0.0:
            push = by_place * C[t, sheet.PRESSURE] / 6.0
            for one in range(3):
                m, n = (one + 1) % 3, (one + 2) % 3
                for node in range(3):
                    # the normal is the product of both edges
                    blocks[t, node, 1, one, m] -= push * p[3 + n]
                    blocks[t, node, 1, one, n] += push * p[3 + m]
                    blocks[t, node, 2, one, n] -= push * p[m]
                    blocks[t, node, 2, one, m] += push * p[n]
                    blocks[t, node, 0, one, m] += push * (p[3 + n] - p[n])
                    blocks[t, node, 0, one, n] -= push * (p[3 + m] - p[m])
        _water_on_triangle(C, t, triangles, x, v, water, p, by_rate, by_place, exact, width, blocks)


@njit(cache=True, error_model="numpy")
def _water_on_triangle(
    C: Any, t: int, triangles: Any, x: Any, v: Any, water: Any, p: Any, by_rate: float, by_place: float, exact: bool,
    width: float, blocks: Any,
) -> None:  # fmt: skip
    """Add drag over velocity and buoyancy over height of one triangle; ``exact``: drag over place as well."""
    over, u, n = np.empty(3), np.empty(3), np.empty(3)
    for corner in range(3):
        over[corner] = x[triangles[t, corner], 2] - water[6, triangles[t, corner]]
    wet = wet_share(over[0], over[1], over[2])
    if wet == 0.0:
        return
    n[0], n[1], n[2] = p[1] * p[5] - p[2] * p[4], p[2] * p[3] - p[0] * p[5], p[0] * p[4] - p[1] * p[3]
    size = math.sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2])
    per, moves = 1.0 / size if size > 0.0 else 0.0, False
    for corner in range(3):
        node = triangles[t, corner]
        along = 0.0
        for axis in range(3):
            u[axis] = C[t, sheet.SHARE] * water[axis, node] - v[node, axis]
            along += u[axis] * n[axis] * per
            moves = moves or u[axis] != 0.0
        slide = 0.0
        for axis in range(3):
            u[axis] -= along * n[axis] * per
            slide += u[axis] * u[axis]
        slide = math.sqrt(slide)
        across = by_rate * wet * C[t, sheet.ACROSS] * size / 6.0 * 2.0 * abs(along)
        skin = by_rate * wet * C[t, sheet.SKIN] * size / 6.0
        for one in range(3):
            for two in range(3):
                flat = n[one] * n[two] * per * per
                value = across * flat + skin * slide * ((1.0 if one == two else 0.0) - flat)
                if slide > 0.0:
                    value += skin * u[one] * u[two] / slide
                blocks[t, corner, corner, one, two] += value
    if exact and moves:
        _loads_over_place(C, t, triangles, x, v, water, by_place, width, blocks)
    elif wet < 1.0:
        for corner in range(3):
            kept = over[corner]
            over[corner] = kept + width
            high = wet_share(over[0], over[1], over[2])
            over[corner] = kept - width
            slope = 0.5 * (wet_share(over[0], over[1], over[2]) - high) / width
            over[corner] = kept
            for node in range(3):
                blocks[t, node, corner, 2, 2] += by_place * C[t, sheet.LIFT] * slope


@njit(cache=True, error_model="numpy")
def _loads_over_place(
    C: Any, t: int, triangles: Any, x: Any, v: Any, water: Any, by_place: float, width: float, blocks: Any
) -> None:
    """Add central differences of the loads of the water on one triangle over the places of its corners."""
    place, speed, flow = np.empty(9), np.empty(9), np.empty(21)
    pull = np.empty((2, 9))
    one, light = np.array([[0, 1, 2]]), np.zeros((4, 3))
    for corner in range(3):
        node = triangles[t, corner]
        for row in range(7):
            flow[3 * row + corner] = water[row, node]
        for axis in range(3):
            place[3 * axis + corner], speed[3 * axis + corner] = x[node, axis], v[node, axis]
    for column in range(9):
        kept = place[column]
        for side in range(2):
            place[column] = kept + (width if side == 0 else -width)
            pull[side, :] = 0.0
            sheet_loads(C[t : t + 1], one, place, 0, speed, 0, flow, 0, pull[side], 0, 1, 3, light, 0.0)
        place[column] = kept
        for row in range(9):
            value = 0.5 * (pull[1, row] - pull[0, row]) / width
            blocks[t, row % 3, column % 3, row // 3, column // 3] += by_place * value


@njit(cache=True, error_model="numpy")
def panel_rate_blocks(
    x: Any, v: Any, water: Any, panels: Any, half_density: float, by_rate: float, blocks: Any
) -> None:
    """Write ``by_rate`` times the derivative of minus the forces of panels over the velocities of their corners.

    The coefficients are held: they change with the angle of the flow, not with its speed.
    """
    corners, rows = panels[0], panels[1]
    xl, vl, fl = np.empty((4, 3)), np.empty((4, 3)), np.empty((4, 3))
    S, w = np.empty(6), np.empty(3)
    for p in range(corners.shape[0]):
        count = 4 if corners[p, 3] >= 0 else 3
        share = 1.0 / count
        w[0], w[1], w[2] = -rows[p, 2], -rows[p, 3], -rows[p, 4]
        for k in range(count):
            for axis in range(3):
                xl[k, axis], vl[k, axis] = x[corners[p, k], axis], v[corners[p, k], axis]
                w[axis] += share * (rows[p, 1] * water[axis, corners[p, k]] - vl[k, axis])
        _on_one(p, xl, vl, water, panels, half_density, S, fl)
        square = w[0] * w[0] + w[1] * w[1] + w[2] * w[2]
        for i in range(4):
            for j in range(4):
                for one in range(3):
                    for two in range(3):
                        value = 0.0
                        if i < count and j < count and square > 0.0:
                            value = share * fl[i, one] * w[two] / square
                            if i == j:
                                low, high = min(one, two), max(one, two)
                                value += share * S[high + (0, 2, 3)[low]]
                        blocks[p, i, j, one, two] = by_rate * value


@njit(cache=True, error_model="numpy")
def ring_stiffness(x: Any, rings: Any, r: int, width: float, matrix: Any) -> None:
    """Write the stiffness (3 k, 3 k) of ring r by central differences of its forces, made symmetric.

    The twist of the pipe follows its nodes at once and couples them all.
    """
    nodes, first, rows = rings
    a, count = first[r], first[r + 1] - first[r]
    own, bounds = np.zeros(count, np.int64), np.array([0, count])
    for number in range(count):
        own[number] = number
    system = (own, bounds, rows[a : a + count])
    place, pull, moments = np.empty((3, count)), np.zeros((2, 3, count)), np.empty((count, 3))
    for k in range(count):
        for axis in range(3):
            place[axis, k] = x[nodes[a + k], axis]
    for k in range(count):
        for axis in range(3):
            kept = place[axis, k]
            for side in range(2):
                place[axis, k] = kept + (width if side == 0 else -width)
                pull[side, :, :] = 0.0
                ring_loads(place[0], place[1], place[2], system, pull[side, 0], pull[side, 1], pull[side, 2], moments)
            place[axis, k] = kept
            for m in range(count):
                for one in range(3):
                    matrix[3 * m + one, 3 * k + axis] = 0.5 * (pull[1, one, m] - pull[0, one, m]) / width
    for i in range(3 * count):
        for j in range(i):
            matrix[i, j] = matrix[j, i] = 0.5 * (matrix[i, j] + matrix[j, i])


@njit(cache=True, error_model="numpy")
def part_tangent(
    x: Any, v: Any, water: Any, parts: Any, by_rate: float, by_place: float, nodes: Any, numbers: Any
) -> None:
    """Add ``by_rate C + by_place K`` of all parts to the fronts, without how drag turns with them."""
    (table, _, triangles, _, _), (panels, half_density, _), rings, pairs = parts
    free = nodes[9:12]
    if triangles.shape[0] > 0:
        width = 1e-6 * math.sqrt(table[0, sheet.AREA])
        blocks = np.empty((triangles.shape[0], 3, 3, 3, 3))
        sheet_blocks(table, triangles, x, v, water, by_rate, by_place, False, width, blocks)
        add_elements(blocks, triangles, pairs[0], free, 1.0, numbers)
    if panels[0].shape[0] > 0:
        blocks = np.empty((panels[0].shape[0], 4, 4, 3, 3))
        panel_rate_blocks(x, v, water, panels, half_density, by_rate, blocks)
        add_elements(blocks, pairs[2], pairs[1], free, 1.0, numbers)
    begin, (ring_nodes, first, rows) = 0, rings
    for r in range(first.size - 1):
        a, count = first[r], first[r + 1] - first[r]
        matrix = np.empty((3 * count, 3 * count))
        ring_stiffness(x, rings, r, 1e-6 / rows[a, 2], matrix)
        for i in range(count):
            for j in range(count):
                place, row = pairs[3][begin + i * count + j, 0], pairs[3][begin + i * count + j, 1]
                for p in range(3):
                    for q in range(3):
                        value = by_place * free[p, ring_nodes[a + i]] * free[q, ring_nodes[a + j]]
                        numbers[place + p * row + q] += value * matrix[3 * i + p, 3 * j + q]
        begin += count * count


@njit(cache=True, error_model="numpy")
def part_measure(change: Any, x: Any, parts: Any, most: float, pull: float) -> float:
    """Return the larger of ``most`` and the change of the pull of any triangle [N] over ``pull``."""
    (C, _, triangles, _, _), _, _, _ = parts
    for t in range(triangles.shape[0]):
        i, j, k = triangles[t, 0], triangles[t, 1], triangles[t, 2]
        e11 = e22 = shear = 0.0
        for axis in range(3):
            p, q = x[j, axis] - x[i, axis], x[k, axis] - x[i, axis]
            r, s = change[j, axis] - change[i, axis], change[k, axis] - change[i, axis]
            f1, f2 = p * C[t, sheet.E11] + q * C[t, sheet.E21], p * C[t, sheet.E12] + q * C[t, sheet.E22]
            g1, g2 = r * C[t, sheet.E11] + s * C[t, sheet.E21], r * C[t, sheet.E12] + s * C[t, sheet.E22]
            e11 += f1 * g1
            e22 += f2 * g2
            shear += f1 * g2 + f2 * g1
        one, two = (
            abs(C[t, sheet.C11] * e11 + C[t, sheet.C12] * e22),
            abs(C[t, sheet.C12] * e11 + C[t, sheet.C22] * e22),
        )
        value = max(one, two, abs(C[t, sheet.C33] * shear)) * math.sqrt(2.0 * C[t, sheet.AREA]) / pull
        if not value <= most:
            most = value
    return most


@njit(cache=True, error_model="numpy")
def part_pulls(x: Any, v: Any, parts: Any, slack: Any) -> tuple[float, bool]:
    """Return the highest pull of any triangle [N] and whether one turned slack or taut since the last look."""
    (C, _, triangles, _, _), _, _, _ = parts
    p, q, highest, turned = np.empty(6), np.empty(6), 0.0, False
    for t in range(triangles.shape[0]):
        for axis in range(3):
            a, b, c = triangles[t, 0], triangles[t, 1], triangles[t, 2]
            p[axis], p[3 + axis] = x[b, axis] - x[a, axis], x[c, axis] - x[a, axis]
            q[axis], q[3 + axis] = v[b, axis] - v[a, axis], v[c, axis] - v[a, axis]
        e11, e22, shear = _strain(C, t, p, q, C[t, sheet.DAMPING])
        s11, s22, s12, _, state = tensile_stress(C, t, e11, e22, shear)
        half = 0.5 * (s11 - s22)
        pull = 0.5 * (s11 + s22) + math.sqrt(half * half + s12 * s12)
        highest = max(highest, pull * math.sqrt(2.0 * C[t, sheet.AREA]))
        loose = state == 0
        turned = turned or loose != slack[t]
        slack[t] = loose
    return highest, turned
