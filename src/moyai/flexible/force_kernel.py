"""Compiled kernels of bars, hinges, bed and water: forces, mass blocks, energy, and the derivatives of the forces.

Arrays run over nodes first (n, 3). ``system`` is (nodes, bars, start, end, curve, curves, hinges, bending, attached) of
:class:`moyai.flexible.arrays.KernelArrays`.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from moyai.core.compiled import njit
from moyai.flexible.ground_kernel import FLAT, curving, ground, ground_shape, held


@njit(cache=True, error_model="numpy")
def elastic_pull(bars: Any, k: int, size: float, curve: int, curves: Any) -> tuple[float, float]:
    """Return elastic tension and its slope over the length of one bar (before the cut at slack)."""
    if curve < 0:
        return bars[1, k] * (size - bars[0, k]), bars[1, k]
    strain, j = size / bars[0, k] - 1.0, 0
    while j + 2 < curves.shape[2] and strain > curves[curve, 0, j + 1]:
        j += 1
    return curves[curve, 1, j] + curves[curve, 2, j] * (strain - curves[curve, 0, j]), curves[curve, 2, j] / bars[0, k]


@njit(cache=True, error_model="numpy")
def cut(pull: float, least: float, soft: float) -> tuple[float, float]:
    """Return the larger of ``pull`` and ``least`` and its slope, rounded over a width ``soft`` [N] (0: sharp)."""
    if soft <= 0.0 or least < 0.0:
        return (pull, 1.0) if pull > least else (least, 0.0)
    root = math.sqrt(pull * pull + soft * soft)
    # written so that a slack bar keeps its digits
    value = 0.5 * (pull + root) if pull > 0.0 else 0.5 * soft * soft / (root - pull)
    return value, value / root


@njit(cache=True, error_model="numpy")
def _wet_part(x: Any, water: Any, a: int, b: int, radius: float) -> tuple[float, float, float]:
    """Return the immersed part of a bar, its slope over height, and the lean of its lift [eq:flexible-immersion]."""
    ha, hb = x[a, 2] - water[6, a], x[b, 2] - water[6, b]
    low, high = min(ha, hb) - radius, max(ha, hb) + radius
    if high <= 0.0:
        return 1.0, 0.0, 0.0
    if low >= 0.0:
        return 0.0, 0.0, 0.0
    part, steep = -low / (high - low), 1.0 / (high - low)
    return part, steep, (hb - ha) * steep


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
    ``bed`` is the array of :mod:`moyai.flexible.ground_kernel`.
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
        elastic, _ = elastic_pull(bars, k, size, curve[k], curves)
        pull, _ = cut(elastic + bars[2, k] * rate, bars[3, k], fluid[2])
        tension[k] = pull
        wet, _, lean = _wet_part(x, water, a, b, bars[10, k])
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
            force[node, 2] += wet * bars[8, k] * (1.0 + (1.0 - wet) * (lean if side == 0 else -lean))
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
        bend(x, hinges[h, 0], hinges[h, 1], hinges[h, 2], bending[h], force)
    if bed[3] > 0.0:
        for i in range(x.shape[0]):
            level, nx, ny, nz = bed[0], 0.0, 0.0, 1.0
            if bed.size > FLAT:
                level, nx, ny, nz = ground(bed, x[i, 0], x[i, 1])
            depth = (level - x[i, 2]) * nz
            if depth > 0.0 or fluid[2] > 0.0:
                out = nx * v[i, 0] + ny * v[i, 1] + nz * v[i, 2]
                push, _ = cut(nodes[5, i] * depth - nodes[6, i] * out, 0.0, fluid[2])
                ex, ey, ez = held(bed, nx, ny, nz)
                force[i, 0] += ex * push
                force[i, 1] += ey * push
                force[i, 2] += ez * push
                if bed[1] > 0.0:
                    u[0], u[1], u[2] = v[i, 0] - nx * out, v[i, 1] - ny * out, v[i, 2] - nz * out
                    speed = math.sqrt(u[0] * u[0] + u[1] * u[1] + u[2] * u[2] + bed[2] * bed[2])
                    for axis in range(3):
                        force[i, axis] -= bed[1] * push * u[axis] / speed


@njit(cache=True, error_model="numpy")
def bend(x: Any, a: int, b: int, c: int, stiffness: Any, force: Any) -> None:
    """Add the force of one hinge [eq:flexible-bending]."""
    one, two = stiffness[1], stiffness[2]
    for axis in range(3):
        turn = stiffness[0] * ((x[c, axis] - x[b, axis]) * two - (x[b, axis] - x[a, axis]) * one)
        force[a, axis] -= turn * one
        force[b, axis] += turn * (one + two)
        force[c, axis] -= turn * two


@njit(cache=True, error_model="numpy")
def laws(
    x: Any, v: Any, system: Any, fluid: Any, bed: Any, by_rate: float, by_place: float, bar_law: Any, node_law: Any
) -> None:  # fmt: skip
    """Write pull and stiffness along the bar of every bar, stiffness of the bed along and across its normal.

    The third row of ``node_law`` (4, n) stays free for :func:`moyai.flexible.equilibrium_kernel.mixed_laws`; the fourth
    is the push of the bed, which turns with the place where the bed is curved.
    """
    nodes, bars, start, end, curve, curves, _, _, _ = system
    u = np.empty(3)
    for k in range(start.size):
        a, b = start[k], end[k]
        size = rate = 0.0
        for axis in range(3):
            t = x[b, axis] - x[a, axis]
            size += t * t
            rate += t * (v[b, axis] - v[a, axis])
        size = max(math.sqrt(size), 1e-100)
        elastic, slope = elastic_pull(bars, k, size, curve[k], curves)
        pull, share = cut(elastic + bars[2, k] * rate / size, bars[3, k], fluid[2])
        bar_law[0, k] = pull if share > 0.0 else 0.0
        bar_law[1, k] = share * (by_place * slope + by_rate * bars[2, k])
    for i in range(x.shape[0]):
        node_law[0, i] = node_law[1, i] = node_law[2, i] = node_law[3, i] = 0.0
        if bed[3] == 0.0:
            continue
        level, nx, ny, nz = bed[0], 0.0, 0.0, 1.0
        if bed.size > FLAT:
            level, nx, ny, nz = ground(bed, x[i, 0], x[i, 1])
        depth = (level - x[i, 2]) * nz
        if depth > 0.0 or fluid[2] > 0.0:
            out = nx * v[i, 0] + ny * v[i, 1] + nz * v[i, 2]
            push, part = cut(nodes[5, i] * depth - nodes[6, i] * out, 0.0, fluid[2])
            node_law[0, i] = part * (by_place * nodes[5, i] + by_rate * nodes[6, i])
            if bed[1] > 0.0:
                u[0], u[1], u[2] = v[i, 0] - nx * out, v[i, 1] - ny * out, v[i, 2] - nz * out
                speed = math.sqrt(u[0] * u[0] + u[1] * u[1] + u[2] * u[2] + bed[2] * bed[2])
                node_law[1, i] = by_rate * bed[1] * push / speed
            node_law[3, i] = push


@njit(cache=True, error_model="numpy")
def blocks(
    x: Any, v: Any, water: Any, system: Any, fluid: Any, bed: Any, mass: Any, bar_law: Any, node_law: Any,
    by_mass: float, by_rate: float, by_place: float, exact: bool, node_block: Any, bar_block: Any,
) -> None:  # fmt: skip
    """Write ``by_mass M + by_rate C + by_place K`` in 3x3 blocks, C and K the derivatives of minus the force.

    ``bar_law`` and ``node_law`` come from :func:`laws` (or :func:`mixed_laws`).
    ``node_block`` (n, 3, 3) stands on the diagonal, ``bar_block`` (m, 2, 3, 3) couples start to end and end to start;
    hinges, whose stiffness does not change, are left to :func:`to_fronts` next to the diagonal.
    ``exact`` adds how drag turns with the bars and how the loads change with the immersed part (not symmetric) and
    keeps the destabilising part of compressed rods.
    """
    nodes, bars, start, end, _, _, hinges, bending, attached = system
    t, u, part_of = np.empty(3), np.empty(3), np.empty(3)
    turn, wide = np.empty((3, 3)), np.empty((3, 3))
    for i in range(x.shape[0]):
        node_block[i, 0, 0], node_block[i, 0, 1], node_block[i, 0, 2] = mass[i, 0], mass[i, 1], mass[i, 2]
        node_block[i, 1, 0], node_block[i, 1, 1], node_block[i, 1, 2] = mass[i, 1], mass[i, 3], mass[i, 4]
        node_block[i, 2, 0], node_block[i, 2, 1], node_block[i, 2, 2] = mass[i, 2], mass[i, 4], mass[i, 5]
        for p in range(3):
            for q in range(3):
                node_block[i, p, q] *= by_mass
    for k in range(start.size):
        a, b = start[k], end[k]
        size = 0.0
        for axis in range(3):
            t[axis] = x[b, axis] - x[a, axis]
            size += t[axis] * t[axis]
        size = max(math.sqrt(size), 1e-100)
        for axis in range(3):
            t[axis] /= size
        # compression of a rod destabilises; without its geometric part the matrix stays positive
        side = (bar_law[0, k] if exact else max(bar_law[0, k], 0.0)) / size * by_place
        straight = bar_law[1, k] - side
        for p in range(3):
            for q in range(3):
                value = straight * t[p] * t[q] + (side if p == q else 0.0)
                node_block[a, p, q] += value
                node_block[b, p, q] += value
                bar_block[k, 0, p, q] = bar_block[k, 1, p, q] = -value
        wet, steep, lean = _wet_part(x, water, a, b, bars[10, k])
        if wet <= 0.0:
            continue
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
            if by_rate != 0.0 and (across > 0.0 or along != 0.0):
                normal, skin = wet * bars[4, k] * by_rate, 2.0 * wet * bars[5, k] * abs(along) * by_rate
                for p in range(3):
                    for q in range(3):
                        value = skin * t[p] * t[q] + normal * across * ((1.0 if p == q else 0.0) - t[p] * t[q])
                        if across > 0.0:
                            value += normal * u[p] * u[q] / across
                        node_block[node, p, q] += value
            if not exact:
                node_block[node, 2, 2] += by_place * bars[8, k] * steep
                if steep > 0.0:
                    tilt = by_place * bars[8, k] * wet * (1.0 - wet) * 2.0 * bars[10, k] * steep * steep
                    node_block[node, 2, 2] += tilt
                    bar_block[k, side_node, 2, 2] -= tilt
                continue
            normal, skin = bars[4, k] * across, bars[5, k] * abs(along)
            if across > 0.0 or along != 0.0:
                # derivative of both drags by the direction of the bar ...
                for p in range(3):
                    for q in range(3):
                        whole = u[q] + along * t[q]
                        value = -normal * (t[p] * whole + (along if p == q else 0.0))
                        if across > 0.0:
                            value -= bars[4, k] * along / across * u[p] * u[q]
                        turn[p, q] = value + skin * (2.0 * t[p] * whole + (along if p == q else 0.0))
                # ... and of the direction by the places of its ends
                for p in range(3):
                    toward = turn[p, 0] * t[0] + turn[p, 1] * t[1] + turn[p, 2] * t[2]
                    for q in range(3):
                        wide[p, q] = by_place * wet / size * (turn[p, q] - toward * t[q])
                sign = 1.0 if side_node == 0 else -1.0
                for p in range(3):
                    for q in range(3):
                        node_block[node, p, q] += sign * wide[p, q]
                        bar_block[k, side_node, p, q] -= sign * wide[p, q]
            if steep > 0.0:
                low, high = x[a, 2] - water[6, a], x[b, 2] - water[6, b]
                upside = low > high
                if upside:
                    low, high = high, low
                low, high = low - bars[10, k], high + bars[10, k]
                # what the lower and the upper end take from the immersed part when they rise
                by_low, by_high = high * steep * steep, -low * steep * steep
                mine = by_low if (side_node == 0) != upside else by_high
                for axis in range(3):
                    part_of[axis] = normal * u[axis] + skin * along * t[axis]
                part_of[2] += bars[8, k] * (1.0 + (1.0 - 2.0 * wet) * (lean if side_node == 0 else -lean))
                tilt = by_place * bars[8, k] * wet * (1.0 - wet) * 2.0 * bars[10, k] * steep * steep
                node_block[node, 2, 2] += tilt
                bar_block[k, side_node, 2, 2] -= tilt
                for p in range(3):
                    node_block[node, p, 2] += by_place * part_of[p] * mine
                    bar_block[k, side_node, p, 2] += by_place * part_of[p] * (steep - mine)
    for n in range(attached.size):
        i = attached[n]
        part, steep = _float_part(x, water, nodes, i)
        speed = 0.0
        for axis in range(3):
            u[axis] = water[axis, i] - v[i, axis]
            speed += u[axis] * u[axis]
        speed = math.sqrt(speed)
        if speed > 0.0:
            for p in range(3):
                for q in range(3):
                    value = by_rate * part * nodes[3, i] * (u[p] * u[q] / speed + (speed if p == q else 0.0))
                    node_block[i, p, q] += value
                if exact:
                    node_block[i, p, 2] += by_place * steep * nodes[3, i] * speed * u[p]
        node_block[i, 2, 2] += by_place * steep * fluid[0] * fluid[1] * nodes[2, i]
    for h in range(hinges.shape[0]):
        for m in range(3):
            value = by_place * bending[h, 0] * turn_part(bending, h, m) ** 2
            for p in range(3):
                node_block[hinges[h, m], p, p] += value
    if bed.size == FLAT:
        for i in range(x.shape[0]):
            node_block[i, 0, 0] += node_law[1, i]
            node_block[i, 1, 1] += node_law[1, i]
            node_block[i, 2, 2] += node_law[0, i]
    else:
        for i in range(x.shape[0]):
            if node_law[0, i] > 0.0 or node_law[1, i] > 0.0 or node_law[3, i] > 0.0:
                _add_ground(x, bed, node_law, i, by_place, exact, node_block[i])


@njit(cache=True, error_model="numpy")
def _add_ground(x: Any, bed: Any, node_law: Any, i: int, by_place: float, exact: bool, block: Any) -> None:
    """Add the stiffness of a bed that varies to the block of one node [eq:flexible-ground]."""
    n, turn = np.empty(3), np.empty(6)
    _, n[0], n[1], n[2] = ground(bed, x[i, 0], x[i, 1])
    if bed[1] < 0.0:
        # what friction holds is pushed upwards wherever it goes, by its depth along the normal
        ex, ey, ez = held(bed, n[0], n[1], n[2])
        for q in range(3):
            block[0, q] += node_law[0, i] * ex * n[q]
            block[1, q] += node_law[0, i] * ey * n[q]
            block[2, q] += node_law[0, i] * ez * n[q]
        return
    curving(ground_shape(bed, x[i, 0], x[i, 1]), by_place * node_law[3, i], exact, turn)
    row = 0
    for p in range(3):
        for q in range(p, 3):
            value = (node_law[0, i] - node_law[1, i]) * n[p] * n[q] + (node_law[1, i] if p == q else 0.0) + turn[row]
            block[p, q] += value
            if q > p:
                block[q, p] += value
            row += 1


@njit(cache=True, error_model="numpy")
def turn_part(bending: Any, h: int, m: int) -> float:
    """Return how the turn of a hinge depends on its node m."""
    return bending[h, 1] if m == 0 else (-bending[h, 1] - bending[h, 2] if m == 1 else bending[h, 2])


@njit(cache=True, error_model="numpy")
def accelerate(nodes: Any, mass: Any, result: Any) -> None:
    """Turn the forces in ``result`` into the acceleration of what is free."""
    for i in range(result.shape[0]):
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
def kinetic_energy(v: Any, mass: Any, nodes: Any) -> float:
    """Return the kinetic energy of what is free [J]."""
    kinetic = 0.0
    for i in range(v.shape[0]):
        p, q, s = nodes[9, i] * v[i, 0], nodes[10, i] * v[i, 1], nodes[11, i] * v[i, 2]
        kinetic += 0.5 * (mass[i, 0] * p * p + mass[i, 3] * q * q + mass[i, 5] * s * s)
        kinetic += mass[i, 1] * p * q + mass[i, 2] * p * s + mass[i, 4] * q * s
    return kinetic


@njit(cache=True, error_model="numpy")
def energies(x: Any, v: Any, mass: Any, system: Any) -> tuple[float, float]:
    """Return kinetic energy of what is free and elastic energy of bars and hinges [J]."""
    nodes, bars, start, end, curve, curves, hinges, bending, _ = system
    elastic = 0.0
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
    return kinetic_energy(v, mass, nodes), elastic
