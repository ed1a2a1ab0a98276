"""Compiled kernels of the time domain: arrays in, arrays out. One call graph, so one file.

Method [eq:floating-etd]: the classical fourth-order Runge-Kutta method for position and velocity joined with its
exponential form (Cox and Matthews 2002, ETDRK4) for the states of the memory, so that fast memory poles neither limit
the step nor lose their steady value.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numba import njit

RUNNING, DIVERGED = 0, 1


@njit(cache=True, error_model="numpy")
def _interval(grid: Any, start: int, size: int, value: float) -> int:
    """Return i with grid[start + i] <= value < grid[start + i + 1], the end intervals outside."""
    low, high = 0, size - 1
    while high - low > 1:
        middle = (low + high) // 2
        if grid[start + middle] <= value:
            low = middle
        else:
            high = middle
    return low


@njit(cache=True, error_model="numpy")
def _table_pull(
    chords: Any, angles: Any, nodes: Any, c0: int, a0: int, n0: int, p: int, q: int, span: float, rise: float
) -> tuple[float, float]:
    """Return H and V of a bicubic Hermite table at span and rise; beyond its edges the edge value and slope go on."""
    chord = np.sqrt(span * span + rise * rise)
    angle = np.arctan2(rise, span)
    c = min(max(chord, chords[c0]), chords[c0 + p - 1])
    a = min(max(angle, angles[a0]), angles[a0 + q - 1])
    i, j = _interval(chords, c0, p, c), _interval(angles, a0, q, a)
    dc, da = chords[c0 + i + 1] - chords[c0 + i], angles[a0 + j + 1] - angles[a0 + j]
    s, t = (c - chords[c0 + i]) / dc, (a - angles[a0 + j]) / da
    beyond_c, beyond_a = chord - c, angle - a
    horizontal = vertical = 0.0
    for side_c in range(2):
        if side_c == 0:
            value_c, slope_c = (1.0 + 2.0 * s) * (1.0 - s) ** 2, s * (1.0 - s) ** 2 * dc
        else:
            value_c, slope_c = s * s * (3.0 - 2.0 * s), s * s * (s - 1.0) * dc
        for side_a in range(2):
            if side_a == 0:
                value_a, slope_a = (1.0 + 2.0 * t) * (1.0 - t) ** 2, t * (1.0 - t) ** 2 * da
            else:
                value_a, slope_a = t * t * (3.0 - 2.0 * t), t * t * (t - 1.0) * da
            k = n0 + ((i + side_c) * q + j + side_a) * 8
            w0, w1, w2, w3 = value_c * value_a, slope_c * value_a, value_c * slope_a, slope_c * slope_a
            horizontal += w0 * nodes[k] + w1 * nodes[k + 1] + w2 * nodes[k + 2] + w3 * nodes[k + 3]
            vertical += w0 * nodes[k + 4] + w1 * nodes[k + 5] + w2 * nodes[k + 6] + w3 * nodes[k + 7]
    if beyond_c != 0.0 or beyond_a != 0.0:
        # At an edge s or t is 0 or 1: the slopes there are those of the nearest nodes, blended along the edge
        for side_c in range(2):
            for side_a in range(2):
                weight = (s if side_c == 1 else 1.0 - s) * (t if side_a == 1 else 1.0 - t)
                k = n0 + ((i + side_c) * q + j + side_a) * 8
                horizontal += weight * (beyond_c * nodes[k + 1] + beyond_a * nodes[k + 2])
                vertical += weight * (beyond_c * nodes[k + 5] + beyond_a * nodes[k + 6])
    return horizontal, vertical


@njit(cache=True, error_model="numpy")
def table_pull_many(chord: Any, angle: Any, nodes: Any, span: Any, rise: Any) -> Any:
    """Return H and V (n, 2) of one table (nodes (p, q, 2, 4)) at spans and rises (n,)."""
    flat = nodes.ravel()
    values = np.empty((span.size, 2))
    for i in range(span.size):
        values[i, 0], values[i, 1] = _table_pull(chord, angle, flat, 0, 0, 0, chord.size, angle.size, span[i], rise[i])
    return values


@njit(cache=True, error_model="numpy")
def mooring_force(position: Any, lines: Any, force: Any, pulls: Any) -> None:
    """Add the pull of all lines to ``force`` (m,) and write H and V of one line each into ``pulls`` (n, 2).

    Planar bodies [eq:floating-fairlead]: a positive roll turns z towards x. Spatial bodies: yaw after pitch after roll.
    """
    chords, angles, nodes, info, fairlead, anchor, count = lines
    for line in range(info.shape[0]):
        c0, a0, n0, p, q = info[line, 0], info[line, 1], info[line, 2], info[line, 3], info[line, 4]
        first, per_body = info[line, 6], info[line, 7]
        x, y, z = fairlead[line, 0], fairlead[line, 1], fairlead[line, 2]
        if per_body == 3:
            cosine, sine = np.cos(position[first + 2]), np.sin(position[first + 2])
            rx, ry, rz = x * cosine + z * sine, y, -x * sine + z * cosine
            px, py, pz = position[first] + rx, ry, position[first + 1] + rz
        else:
            cr, sr = np.cos(position[first + 3]), np.sin(position[first + 3])
            cp, sp = np.cos(position[first + 4]), np.sin(position[first + 4])
            cy, sy = np.cos(position[first + 5]), np.sin(position[first + 5])
            y1, z1 = cr * y - sr * z, sr * y + cr * z
            x2, rz = cp * x + sp * z1, -sp * x + cp * z1
            rx, ry = cy * x2 - sy * y1, sy * x2 + cy * y1
            px, py, pz = position[first] + rx, position[first + 1] + ry, position[first + 2] + rz
        to_x, to_y = anchor[line, 0] - px, anchor[line, 1] - py
        span = np.sqrt(to_x * to_x + to_y * to_y)
        horizontal, vertical = _table_pull(chords, angles, nodes, c0, a0, n0, p, q, span, pz - anchor[line, 2])
        pulls[line, 0], pulls[line, 1] = horizontal, vertical
        along = count[line] * horizontal / span if span > 0.0 else 0.0
        fx, fy, fz = along * to_x, along * to_y, -count[line] * vertical
        if per_body == 3:
            force[first] += fx
            force[first + 1] += fz
            force[first + 2] += fx * rz - fz * rx
        else:
            force[first] += fx
            force[first + 1] += fy
            force[first + 2] += fz
            force[first + 3] += ry * fz - rz * fy
            force[first + 4] += rz * fx - rx * fz
            force[first + 5] += rx * fy - ry * fx


@njit(cache=True, error_model="numpy")
def _acceleration(
    q: Any, v: Any, memory: Any, external: Any, body: Any, lines: Any, rest: Any, work: Any, pulls: Any, result: Any
) -> None:
    """Write the acceleration: inverse inertia times the sum of all forces [eq:floating-cummins]."""
    inverse, damping, stiffness, rows, quadratic = body
    m = q.size
    for i in range(m):
        total = external[i] - memory[i] - rest[i]
        for j in range(m):
            total -= damping[i, j] * v[j] + stiffness[i, j] * q[j]
        work[i] = total
    if lines[3].shape[0] > 0:
        mooring_force(q, lines, work, pulls)
    for k in range(quadratic.size):
        measure = 0.0
        for j in range(m):
            measure += rows[k, j] * v[j]
        drag = quadratic[k] * abs(measure) * measure
        for j in range(m):
            work[j] -= rows[k, j] * drag
    for i in range(m):
        total = 0.0
        for j in range(m):
            total += inverse[i, j] * work[j]
        result[i] = total


@njit(cache=True, error_model="numpy")
def _memory_input(inputs: Any, v: Any, result: Any) -> None:
    for k in range(result.size):
        total = 0.0j
        for j in range(v.size):
            total += inputs[k, j] * v[j]
        result[k] = total


@njit(cache=True, error_model="numpy")
def _memory_output(outputs: Any, z: Any, result: Any) -> None:
    for i in range(result.size):
        total = 0.0
        for k in range(z.size):
            total += outputs[i, k].real * z[k].real - outputs[i, k].imag * z[k].imag
        result[i] = total


@njit(cache=True, error_model="numpy")
def _lost(q: Any, v: Any, limit: Any) -> bool:
    lost = False
    for i in range(q.size):
        # Written so that NaN is lost too
        lost = lost or not (abs(q[i]) <= limit[i]) or not np.isfinite(v[i])
    return lost


@njit(cache=True, error_model="numpy")
def run_state_space(
    q: Any, v: Any, z: Any, first: int, steps: int, h: float, force: Any, body: Any, lines: Any, rest: Any,
    exponential: Any, inputs: Any, outputs: Any, limit: Any, every: int, saved: Any,
) -> tuple[int, int]:  # fmt: skip
    """Advance ``steps`` steps from step number ``first``; q, v, z change in place.

    ``force`` (2 n + 1, m) holds the external force at half steps. ``exponential`` holds exp(h L/2), exp(h L) and the
    weights Q, f1, f2, f3 of ETDRK4. ``saved`` is (position, velocity, mooring force, pulls), rows at every ``every``-th
    step. Returns the status and the number of good steps.
    """
    half, full, weight_q, f1, f2, f3 = exponential
    m, n = q.size, z.size
    work, pulls = np.empty(m), np.zeros((lines[3].shape[0], 2))
    a1, a2, a3, a4 = np.empty(m), np.empty(m), np.empty(m), np.empty(m)
    q_stage, v2, v3, v4, memory = np.empty(m), np.empty(m), np.empty(m), np.empty(m), np.empty(m)
    n1, n2, n3, n4 = (
        np.empty(n, np.complex128),
        np.empty(n, np.complex128),
        np.empty(n, np.complex128),
        np.empty(n, np.complex128),
    )
    z_a, z_stage = np.empty(n, np.complex128), np.empty(n, np.complex128)
    q_new, v_new, z_new = np.empty(m), np.empty(m), np.empty(n, np.complex128)
    for step in range(steps):
        row = 2 * (first + step)
        _memory_output(outputs, z, memory)
        _acceleration(q, v, memory, force[row], body, lines, rest, work, pulls, a1)
        _memory_input(inputs, v, n1)
        for k in range(n):
            z_a[k] = half[k] * z[k] + weight_q[k] * n1[k]
        for i in range(m):
            q_stage[i] = q[i] + 0.5 * h * v[i]
            v2[i] = v[i] + 0.5 * h * a1[i]
        _memory_output(outputs, z_a, memory)
        _acceleration(q_stage, v2, memory, force[row + 1], body, lines, rest, work, pulls, a2)
        _memory_input(inputs, v2, n2)
        for k in range(n):
            z_stage[k] = half[k] * z[k] + weight_q[k] * n2[k]
        for i in range(m):
            q_stage[i] = q[i] + 0.5 * h * v2[i]
            v3[i] = v[i] + 0.5 * h * a2[i]
        _memory_output(outputs, z_stage, memory)
        _acceleration(q_stage, v3, memory, force[row + 1], body, lines, rest, work, pulls, a3)
        _memory_input(inputs, v3, n3)
        for k in range(n):
            z_stage[k] = half[k] * z_a[k] + weight_q[k] * (2.0 * n3[k] - n1[k])
        for i in range(m):
            q_stage[i] = q[i] + h * v3[i]
            v4[i] = v[i] + h * a3[i]
        _memory_output(outputs, z_stage, memory)
        _acceleration(q_stage, v4, memory, force[row + 2], body, lines, rest, work, pulls, a4)
        _memory_input(inputs, v4, n4)
        for k in range(n):
            z_new[k] = full[k] * z[k] + f1[k] * n1[k] + 2.0 * f2[k] * (n2[k] + n3[k]) + f3[k] * n4[k]
        for i in range(m):
            q_new[i] = q[i] + h / 6.0 * (v[i] + 2.0 * v2[i] + 2.0 * v3[i] + v4[i])
            v_new[i] = v[i] + h / 6.0 * (a1[i] + 2.0 * a2[i] + 2.0 * a3[i] + a4[i])
        if _lost(q_new, v_new, limit):
            return DIVERGED, step
        q[:], v[:], z[:] = q_new, v_new, z_new
        _save(first + step + 1, every, q, v, lines, saved, work, pulls)
    return RUNNING, steps


@njit(cache=True, error_model="numpy")
def _save(number: int, every: int, q: Any, v: Any, lines: Any, saved: Any, work: Any, pulls: Any) -> None:
    """Write the state of step ``number`` when it is one of those that are kept."""
    if number % every != 0 or number // every >= saved[0].shape[0]:
        return
    row = number // every
    saved[0][row] = q
    saved[1][row] = v
    if lines[3].shape[0] > 0:
        work[:] = 0.0
        mooring_force(q, lines, work, pulls)
        saved[2][row] = work
        saved[3][row] = pulls


@njit(cache=True, error_model="numpy")
def run_convolution(
    q: Any, v: Any, history: Any, first: int, steps: int, h: float, force: Any, body: Any, lines: Any, rest: Any,
    kernel: Any, limit: Any, every: int, saved: Any,
) -> tuple[int, int]:  # fmt: skip
    """Advance with the memory as a convolution: second order, cost grows with the memory; for comparison.

    ``kernel`` (2 l + 1, m, m) at half steps; ``history`` (l + 1, m) velocities of past steps, a ring by step number.
    The rest as in :func:`run_state_space`.
    """
    m, length = q.size, history.shape[0]
    work, pulls = np.empty(m), np.zeros((lines[3].shape[0], 2))
    a1, a2, a3, a4 = np.empty(m), np.empty(m), np.empty(m), np.empty(m)
    q_stage, v2, v3, v4, memory = np.empty(m), np.empty(m), np.empty(m), np.empty(m), np.empty(m)
    now, middle, end = np.empty(m), np.empty(m), np.empty(m)
    q_new, v_new = np.empty(m), np.empty(m)
    for step in range(steps):
        number = first + step
        row = 2 * number
        history[number % length] = v
        now[:], middle[:], end[:] = 0.0, 0.0, 0.0
        for back in range(min(number + 1, length - 1)):
            past = history[(number - back) % length]
            last = 0.5 if number - back == 0 or back == length - 2 else 1.0
            for i in range(m):
                for j in range(m):
                    if back > 0:
                        now[i] += last * kernel[2 * back, i, j] * past[j]
                        middle[i] += last * kernel[2 * back + 1, i, j] * past[j]
                    elif number > 0:
                        now[i] += 0.5 * kernel[0, i, j] * past[j]
                        middle[i] += 0.75 * kernel[1, i, j] * past[j]
                    else:
                        middle[i] += 0.25 * kernel[1, i, j] * past[j]
                    end[i] += last * kernel[2 * back + 2, i, j] * past[j]
        for i in range(m):
            memory[i] = h * now[i]
        _acceleration(q, v, memory, force[row], body, lines, rest, work, pulls, a1)
        for i in range(m):
            q_stage[i] = q[i] + 0.5 * h * v[i]
            v2[i] = v[i] + 0.5 * h * a1[i]
        for i in range(m):
            memory[i] = h * middle[i]
            for j in range(m):
                memory[i] += 0.25 * h * kernel[0, i, j] * v2[j]
        _acceleration(q_stage, v2, memory, force[row + 1], body, lines, rest, work, pulls, a2)
        for i in range(m):
            q_stage[i] = q[i] + 0.5 * h * v2[i]
            v3[i] = v[i] + 0.5 * h * a2[i]
        for i in range(m):
            memory[i] = h * middle[i]
            for j in range(m):
                memory[i] += 0.25 * h * kernel[0, i, j] * v3[j]
        _acceleration(q_stage, v3, memory, force[row + 1], body, lines, rest, work, pulls, a3)
        for i in range(m):
            q_stage[i] = q[i] + h * v3[i]
            v4[i] = v[i] + h * a3[i]
        for i in range(m):
            memory[i] = h * end[i]
            for j in range(m):
                memory[i] += 0.5 * h * kernel[0, i, j] * v4[j]
        _acceleration(q_stage, v4, memory, force[row + 2], body, lines, rest, work, pulls, a4)
        for i in range(m):
            q_new[i] = q[i] + h / 6.0 * (v[i] + 2.0 * v2[i] + 2.0 * v3[i] + v4[i])
            v_new[i] = v[i] + h / 6.0 * (a1[i] + 2.0 * a2[i] + 2.0 * a3[i] + a4[i])
        if _lost(q_new, v_new, limit):
            return DIVERGED, step
        q[:], v[:] = q_new, v_new
        _save(number + 1, every, q, v, lines, saved, work, pulls)
    return RUNNING, steps
