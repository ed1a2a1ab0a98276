"""Compiled kernels of statics and of the implicit schemes: forces, their tangent, a sparse solver, Newton's method.

Arrays run over nodes first (n, 3). Matrices are eliminated in the fronts of :mod:`moyai.flexible.sparse`: those of a
line are a few nodes each. ``system`` is (nodes, bars, start, end,
curve,
curves, hinges, bending, attached) of :class:`moyai.flexible.arrays.KernelArrays`.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numba import njit

#: How much smaller the error of a step must be in which a bar turns slack or taut.
AT_EVENTS = 10.0
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
def laws(
    x: Any, v: Any, system: Any, fluid: Any, bed: Any, by_rate: float, by_place: float, bar_law: Any, node_law: Any
) -> None:  # fmt: skip
    """Write pull and stiffness along the bar of every bar, stiffness of the bed upwards and sideways of every node."""
    nodes, bars, start, end, curve, curves, _, _, _ = system
    for k in range(start.size):
        a, b = start[k], end[k]
        size = rate = 0.0
        for axis in range(3):
            t = x[b, axis] - x[a, axis]
            size += t * t
            rate += t * (v[b, axis] - v[a, axis])
        size = max(math.sqrt(size), 1e-100)
        elastic, slope = _elastic(bars, k, size, curve[k], curves)
        pull, share = _cut(elastic + bars[2, k] * rate / size, bars[3, k], fluid[2])
        bar_law[0, k] = pull if share > 0.0 else 0.0
        bar_law[1, k] = share * (by_place * slope + by_rate * bars[2, k])
    for i in range(x.shape[0]):
        node_law[0, i] = node_law[1, i] = 0.0
        depth = bed[0] - x[i, 2]
        if bed[3] > 0.0 and (depth > 0.0 or fluid[2] > 0.0):
            push, part = _cut(nodes[5, i] * depth - nodes[6, i] * v[i, 2], 0.0, fluid[2])
            node_law[0, i] = part * (by_place * nodes[5, i] + by_rate * nodes[6, i])
            if bed[1] > 0.0:
                speed = math.sqrt(v[i, 0] ** 2 + v[i, 1] ** 2 + bed[2] * bed[2])
                node_law[1, i] = by_rate * bed[1] * push / speed


@njit(cache=True, error_model="numpy")
def blocks(
    x: Any, v: Any, water: Any, system: Any, fluid: Any, mass: Any, bar_law: Any, node_law: Any, by_mass: float,
    by_rate: float, by_place: float, exact: bool, node_block: Any, bar_block: Any,
) -> None:  # fmt: skip
    """Write ``by_mass M + by_rate C + by_place K`` in 3x3 blocks, C and K the derivatives of minus the force.

    ``bar_law`` and ``node_law`` come from :func:`laws` (or :func:`mixed_laws`).
    ``node_block`` (n, 3, 3) stands on the diagonal, ``bar_block`` (m, 2, 3, 3) couples start to end and end to start;
    hinges, whose stiffness does not change, are left to :func:`to_fronts` beside the diagonal.
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
            value = by_place * bending[h, 0] * _turn_part(bending, h, m) ** 2
            for p in range(3):
                node_block[hinges[h, m], p, p] += value
    for i in range(x.shape[0]):
        node_block[i, 0, 0] += node_law[1, i]
        node_block[i, 1, 1] += node_law[1, i]
        node_block[i, 2, 2] += node_law[0, i]


@njit(cache=True, error_model="numpy")
def mixed_laws(
    x: Any, system: Any, bed: Any, soft: float, pulls: Any, pushes: Any, bar_law: Any, node_law: Any, force: Any,
) -> float:  # fmt: skip
    """Linearise bars and bed about tensions and pushes that are unknowns of their own [eq:flexible-mixed].

    Writes ``bar_law`` and ``node_law`` as :func:`laws` does, adds to ``force`` (n, 3) what bars and bed give after the
    linear step, and returns the largest difference between the law and the unknown [N].
    """
    nodes, bars, start, end, curve, curves, _, _, _ = system
    t = np.empty(3)
    most = 0.0
    for k in range(start.size):
        a, b = start[k], end[k]
        size = 0.0
        for axis in range(3):
            t[axis] = x[b, axis] - x[a, axis]
            size += t[axis] * t[axis]
        size = max(math.sqrt(size), 1e-100)
        elastic, slope = _elastic(bars, k, size, curve[k], curves)
        share, gap = 1.0, elastic - pulls[k]
        if bars[3, k] == 0.0:
            # the tension of a bar that only pulls stays positive: pull (pull - elastic) = (soft / 2)^2
            square = 0.25 * soft * soft / pulls[k]
            share = pulls[k] / (pulls[k] + square)
            gap += square
        bar_law[0, k], bar_law[1, k], bar_law[2, k] = pulls[k], share * slope, share * gap
        most = max(most, abs(share * gap))
        for axis in range(3):
            value = (pulls[k] + share * gap) * t[axis] / size
            force[a, axis] += value
            force[b, axis] -= value
    for i in range(x.shape[0]):
        node_law[0, i] = node_law[1, i] = node_law[2, i] = 0.0
        if bed[3] > 0.0 and nodes[5, i] > 0.0:
            square = 0.25 * soft * soft / pushes[i]
            share = pushes[i] / (pushes[i] + square)
            gap = share * (nodes[5, i] * (bed[0] - x[i, 2]) - pushes[i] + square)
            node_law[0, i], node_law[2, i] = share * nodes[5, i], gap
            most = max(most, abs(gap) * nodes[11, i])
            force[i, 2] += pushes[i] + gap
    return most


@njit(cache=True, error_model="numpy")
def mixed_step(
    x: Any, step: Any, part: float, system: Any, bed: Any, bar_law: Any, node_law: Any, pulls: Any, pushes: Any,
    new_x: Any, new_pulls: Any, new_pushes: Any, force: Any,
) -> None:  # fmt: skip
    """Take ``part`` of a linear step of places, tensions and pushes; add bars and bed at its end to ``force``.

    What may not change sign keeps at least a tenth of what it was.
    """
    nodes, bars, start, end, _, _, _, _, _ = system
    for i in range(x.shape[0]):
        for axis in range(3):
            new_x[i, axis] = x[i, axis] + part * step[i, axis]
        if bed[3] > 0.0 and nodes[5, i] > 0.0:
            change = node_law[2, i] - node_law[0, i] * step[i, 2]
            new_pushes[i] = max(pushes[i] + part * change, 0.1 * pushes[i])
            force[i, 2] += new_pushes[i]
    for k in range(start.size):
        a, b = start[k], end[k]
        size = along = new = 0.0
        for axis in range(3):
            t = x[b, axis] - x[a, axis]
            size += t * t
            along += t * (step[b, axis] - step[a, axis])
            new += (new_x[b, axis] - new_x[a, axis]) ** 2
        value = pulls[k] + part * (bar_law[2, k] + bar_law[1, k] * along / max(math.sqrt(size), 1e-100))
        new_pulls[k] = max(value, 0.1 * pulls[k]) if bars[3, k] == 0.0 else value
        value = new_pulls[k] / max(math.sqrt(new), 1e-100)
        for axis in range(3):
            force[a, axis] += value * (new_x[b, axis] - new_x[a, axis])
            force[b, axis] -= value * (new_x[b, axis] - new_x[a, axis])


@njit(cache=True, error_model="numpy")
def _turn_part(bending: Any, h: int, m: int) -> float:
    """Return how the turn of a hinge depends on its node m."""
    return bending[h, 1] if m == 0 else (-bending[h, 1] - bending[h, 2] if m == 1 else bending[h, 2])


@njit(cache=True, error_model="numpy")
def to_fronts(
    node_block: Any, bar_block: Any, system: Any, by_place: float, own: Any, bar_pairs: Any, hinge_pairs: Any,
    numbers: Any,
) -> None:  # fmt: skip
    """Write the blocks in the fronts of a :class:`moyai.flexible.sparse.SparsePlan`."""
    nodes, _, start, end, _, _, hinges, bending, _ = system
    numbers[:] = 0.0
    for i in range(node_block.shape[0]):
        place, row = own[i, 0], own[i, 1]
        for p in range(3):
            for q in range(3):
                numbers[place + p * row + q] = node_block[i, p, q] * nodes[9 + p, i] * nodes[9 + q, i]
            if nodes[9 + p, i] == 0.0:
                numbers[place + p * row + p] = 1.0
    for k in range(start.size):
        for turned in range(2):
            a, b = (start[k], end[k]) if turned == 0 else (end[k], start[k])
            place, row = bar_pairs[k, turned, 1 - turned, 0], bar_pairs[k, turned, 1 - turned, 1]
            for p in range(3):
                for q in range(3):
                    value = bar_block[k, turned, p, q] * nodes[9 + p, a] * nodes[9 + q, b]
                    numbers[place + p * row + q] += value
    for h in range(hinges.shape[0]):
        for m in range(3):
            for n in range(3):
                if m != n:
                    a, b = hinges[h, m], hinges[h, n]
                    value = by_place * bending[h, 0] * _turn_part(bending, h, m) * _turn_part(bending, h, n)
                    place, row = hinge_pairs[h, m, n, 0], hinge_pairs[h, m, n, 1]
                    for p in range(3):
                        numbers[place + p * row + p] += value * nodes[9 + p, a] * nodes[9 + p, b]


@njit(cache=True, error_model="numpy")
def add_elements(element: Any, members: Any, pairs: Any, free: Any, scale: float, numbers: Any) -> None:
    """Add ``scale`` times the blocks (e, k, k, 3, 3) of a family of elements to the fronts."""
    for e in range(members.shape[0]):
        for i in range(members.shape[1]):
            for j in range(members.shape[1]):
                place, row = pairs[e, i, j, 0], pairs[e, i, j, 1]
                for p in range(3):
                    for q in range(3):
                        value = element[e, i, j, p, q] * free[p, members[e, i]] * free[q, members[e, j]]
                        numbers[place + p * row + q] += scale * value


@njit(cache=True, error_model="numpy", fastmath={"contract", "reassoc"})
def factor_fronts(numbers: Any, fronts: Any, target: Any, strict: bool) -> bool:
    """Factor all fronts in place, L U without exchanging rows; False at a pivot of zero or, if ``strict``, below it.

    A matrix whose symmetric part is positive has positive pivots only; one of drag may lack it and still be that of a
    stable rest.
    """
    for s in range(fronts.shape[0]):
        own, dim = 3 * fronts[s, 1], 3 * (fronts[s, 1] + fronts[s, 2])
        front = numbers[fronts[s, 4] : fronts[s, 4] + dim * dim].reshape(dim, dim)
        for k in range(0, own, 3):
            # three pivots at a time: their rows first, then everything below and right of them
            for q in range(3):
                pivot = front[k + q, k + q]
                if not (pivot > 0.0 or (pivot < 0.0 and not strict)):
                    return False
                inverse = 1.0 / pivot
                for i in range(k + q + 1, k + 3):
                    scale = front[i, k + q] * inverse
                    front[i, k + q] = scale
                    for j in range(k + q + 1, dim):
                        front[i, j] -= scale * front[k + q, j]
                front[k + q, k + q] = inverse
            first, second, third = front[k], front[k + 1], front[k + 2]
            for i in range(k + 3, dim):
                line = front[i]
                a = line[k] * first[k]
                b = (line[k + 1] - a * first[k + 1]) * second[k + 1]
                c = (line[k + 2] - a * first[k + 2] - b * second[k + 2]) * third[k + 2]
                line[k], line[k + 1], line[k + 2] = a, b, c
                for j in range(k + 3, dim):
                    line[j] -= a * first[j] + b * second[j] + c * third[j]
        parent = fronts[s, 5]
        if parent >= 0:
            wide = 3 * (fronts[parent, 1] + fronts[parent, 2])
            base = fronts[parent, 4]
            for i in range(fronts[s, 2]):
                for p in range(3):
                    row = base + (3 * target[fronts[s, 3] + i] + p) * wide
                    line = front[own + 3 * i + p]
                    for j in range(fronts[s, 2]):
                        place = row + 3 * target[fronts[s, 3] + j]
                        numbers[place] += line[own + 3 * j]
                        numbers[place + 1] += line[own + 3 * j + 1]
                        numbers[place + 2] += line[own + 3 * j + 2]
    return True


@njit(cache=True, error_model="numpy", fastmath={"contract", "reassoc"})
def solve_fronts(numbers: Any, fronts: Any, later: Any, order: Any, right: Any) -> None:
    """Solve with the factors, in place; ``right`` is (n, 3)."""
    most = 0
    for s in range(fronts.shape[0]):
        most = max(most, fronts[s, 1] + fronts[s, 2])
    local = np.empty(3 * most)
    for s in range(fronts.shape[0]):
        first, pivots, rest = fronts[s, 0], fronts[s, 1], fronts[s, 2]
        own, dim = 3 * pivots, 3 * (pivots + rest)
        front = numbers[fronts[s, 4] : fronts[s, 4] + dim * dim].reshape(dim, dim)
        for i in range(pivots):
            for p in range(3):
                local[3 * i + p] = right[order[first + i], p]
        for i in range(own):
            total = local[i]
            for k in range(i):
                total -= front[i, k] * local[k]
            local[i] = total
            right[order[first + i // 3], i % 3] = total
        for i in range(rest):
            node = order[later[fronts[s, 3] + i]]
            for p in range(3):
                total, line = right[node, p], front[own + 3 * i + p]
                for k in range(own):
                    total -= line[k] * local[k]
                right[node, p] = total
    for s in range(fronts.shape[0] - 1, -1, -1):
        first, pivots, rest = fronts[s, 0], fronts[s, 1], fronts[s, 2]
        own, dim = 3 * pivots, 3 * (pivots + rest)
        front = numbers[fronts[s, 4] : fronts[s, 4] + dim * dim].reshape(dim, dim)
        for i in range(rest):
            node = order[later[fronts[s, 3] + i]]
            for p in range(3):
                local[own + 3 * i + p] = right[node, p]
        for i in range(own - 1, -1, -1):
            total, line = right[order[first + i // 3], i % 3], front[i]
            for k in range(i + 1, dim):
                total -= line[k] * local[k]
            local[i] = total * line[i]
            right[order[first + i // 3], i % 3] = local[i]


@njit(cache=True, error_model="numpy")
def step_matrix(
    x: Any, v: Any, water: Any, system: Any, fluid: Any, bed: Any, mass: Any, by_mass: float, by_rate: float,
    by_place: float, plan: Any,
) -> bool:  # fmt: skip
    """Write and factor ``by_mass M + by_rate C + by_place K`` without its unsymmetric part.

    The change of drag and added mass with the direction of the bars is left out: over a step it is small, and Newton's
    method converges linearly at a rate far below one. ``plan`` is (own, pairs of bars, pairs of hinges, numbers,
    fronts, target, later, order) of :class:`moyai.flexible.sparse.SparsePlan`.
    """
    node_block, bar_block = np.empty((x.shape[0], 3, 3)), np.empty((system[2].size, 2, 3, 3))
    bar_law, node_law = np.empty((2, system[2].size)), np.empty((2, x.shape[0]))
    laws(x, v, system, fluid, bed, by_rate, by_place, bar_law, node_law)
    blocks(
        x, v, water, system, fluid, mass, bar_law, node_law, by_mass, by_rate, by_place, False, node_block, bar_block
    )
    to_fronts(node_block, bar_block, system, by_place, plan[0], plan[1], plan[2], plan[3])
    return factor_fronts(plan[3], plan[4], plan[5], True)


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
def acceleration(
    x: Any, v: Any, water: Any, system: Any, fluid: Any, bed: Any, tension: Any, mass: Any, result: Any
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
    h: float, gain: float, ahead: Any, across: Any, guess: Any, system: Any, fluid: Any, bed: Any, plan: Any,
    fresh: bool, water: Any, driving: Any, now: float, limits: Any, place: Any, speed: Any, mass: Any, tension: Any,
    force: Any, change: Any, counts: Any,
) -> int:  # fmt: skip
    """Solve one stage for its acceleration ``guess`` by Newton's method; 0 when solved, 1 when not.

    ``limits`` is allowed error of place and of tension, force left at the last look and its node. The factors in
    ``plan`` are kept as long as they serve.
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
        limits[2], limits[3] = _masked_norm(force, nodes)
        if fresh:
            counts[1] += 1
            if not step_matrix(place, speed, water, system, fluid, bed, mass, 1.0, gain, gain * gain, plan):
                return 1
            fresh = False
        solve_fronts(plan[3], plan[4], plan[6], plan[7], force)
        for i in range(count):
            for axis in range(3):
                step = force[i, axis] * nodes[9 + axis, i]
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
def _rises(x: Any, v: Any, a: Any, system: Any, tension: Any, rises: Any) -> None:
    """Write the rate of every tension [N/s], without the turn of the bars."""
    _, bars, start, end, curve, curves, _, _, _ = system
    for k in range(start.size):
        size = stretching = quickening = 0.0
        for axis in range(3):
            t = x[end[k], axis] - x[start[k], axis]
            size += t * t
            stretching += t * (v[end[k], axis] - v[start[k], axis])
            quickening += t * (a[end[k], axis] - a[start[k], axis])
        size = max(math.sqrt(size), 1e-100)
        _, slope = _elastic(bars, k, size, curve[k], curves)
        rises[k] = (slope * stretching + bars[2, k] * quickening) / size if tension[k] > bars[3, k] else 0.0


@njit(cache=True, error_model="numpy")
def _top(first: float, last: float, rise: float, fall: float) -> float:
    """Return the top of the cubic through both ends of a step, with the changes that their rates would give."""
    if not (rise > 0.0 and fall < 0.0):
        return max(first, last)
    a, b = 6.0 * (first - last) + 3.0 * (rise + fall), -6.0 * (first - last) - 4.0 * rise - 2.0 * fall
    s = 2.0 * rise / (-b + math.sqrt(max(b * b - 4.0 * a * rise, 0.0)))
    s = min(max(s, 0.0), 1.0)
    r = 1.0 - s
    value = r * r * ((1.0 + 2.0 * s) * first + s * rise) + s * s * ((1.0 + 2.0 * r) * last - r * fall)
    return max(first, last, value)


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
    x: Any, v: Any, a: Any, system: Any, plan: Any, fluid: Any, bed: Any, water: Any, driving: Any,
    method: Any, control: Any, timing: Any, ledger: Any, saved: Any, counts: Any,
) -> tuple[int, int, float, int]:  # fmt: skip
    """Advance by rows of the result with an error-controlled implicit Runge-Kutta method [eq:flexible-dirk].

    ``water`` is (now, at the start, rate, moving); ``method`` is (stages, embedded, exponent); ``control`` is 0 step, 1
    smallest step, 2 largest step, 3 tolerance, 4 length for the error of place, 5 largest tension so far, 6 fixed step
    (1) or not (0), 7 force left at a failure [N]; ``counts`` is force evaluations, factorisations, steps, rejected
    steps. Returns status, good rows, time reached, node of the largest force left.
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
    mass, old_mass = np.empty((count, 6)), np.empty((count, 6))
    tension, peak, pulled = np.zeros(start.size), np.full(start.size, -1e300), np.zeros(start.size)
    limits, powers, before = np.zeros(4), np.zeros(2), np.zeros(2)
    begin = time
    _water_at(now_water, base, rate, 0.0, moving)
    acceleration(x, v, now_water, system, fluid, bed, tension, mass, a)
    old_mass[:] = mass
    forces(x, v, now_water, system, fluid, bed, force, tension, mass)
    _powers(x, v, force, system, fluid, own, tension, before)
    pulled[:] = tension
    rises, risen = np.zeros(start.size), np.zeros(start.size)
    _rises(x, v, a, system, tension, risen)
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
                    h, gain, ahead, across, accelerations[s], system, fluid, bed, plan, fresh, now_water, driving,
                    time + part * h, limits, place, speed, mass, tension, force, change, counts,
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
                solve_fronts(plan[3], plan[4], plan[6], plan[7], own)
                for i in range(count):
                    for axis in range(3):
                        change[i, axis] = own[i, axis]
                error = _measure(change, place, start, end, spring, limits[0], limits[1])
                # across slack and taut the estimate is one of a smooth motion no more: it must be the smaller
                for k in range(start.size):
                    if (tension[k] > 0.0) != (pulled[k] > 0.0):
                        error *= AT_EVENTS
                        break
            if control[6] > 0.0:
                if bad > 0:
                    control[7] = limits[2]
                    return STUCK, row, time, int(limits[3])
            elif not error <= 1.0:
                counts[3] += 1
                control[0] = h * (0.25 if bad > 0 or not error < 1e6 else max(0.2, 0.9 * error**-exponent))
                if control[0] < control[1]:
                    control[7] = limits[2]
                    return STUCK, row, time, int(limits[3])
                continue
            x[:], v[:], a[:] = place, speed, accelerations[many - 1]
            time += h
            counts[2] += 1
            forces(x, v, now_water, system, fluid, bed, force, tension, mass)
            _rises(x, v, a, system, tension, rises)
            for k in range(start.size):
                # peaks fall between long steps
                peak[k] = max(peak[k], _top(pulled[k], tension[k], h * risen[k], h * rises[k]))
                control[5] = max(control[5], abs(tension[k]))
            _powers(x, v, force, system, fluid, own, tension, powers)
            pulled[:] = tension
            risen[:] = rises
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
