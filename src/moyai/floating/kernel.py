"""Compiled kernels of the time domain: arrays in, arrays out.

Method [eq:floating-etd]: the classical fourth-order Runge-Kutta method for position and velocity joined with its
exponential form (Cox and Matthews 2002, ETDRK4) for the states of the memory, so that fast memory poles neither limit
the step nor lose their steady value.

The pull of the lines comes from :mod:`moyai.mooring.planar_kernel`.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from moyai.core.compiled import njit
from moyai.mooring.planar_kernel import planar_line_force

RUNNING, DIVERGED = 0, 1


@njit(cache=True, error_model="numpy")
def mooring_force(position: Any, lines: Any, force: Any, tension: Any) -> None:
    """Add the pull of all lines on the body of the first three modes to ``force``; write the ``tension`` of each.

    ``lines`` is (parameters, index, nodes, lookup, rest pose, starts of the exact solver) [eq:floating-lines].
    """
    parameters, index, nodes, lookup, rest, starts = lines
    planar_line_force(
        rest[0] + position[0],
        rest[1] + position[1],
        rest[2] + position[2],
        parameters,
        index,
        nodes,
        lookup,
        starts,
        force,
        tension,
    )


@njit(cache=True, error_model="numpy")
def _draw(position: Any, lines: Any, drawn: Any, pulls: Any) -> None:
    """Write the pull of all lines on the body and the tension of each."""
    if lines[0].shape[0] > 0:
        for i in range(drawn.size):
            drawn[i] = 0.0
        mooring_force(position, lines, drawn, pulls)


@njit(cache=True, error_model="numpy")
def _acceleration(
    q: Any, v: Any, memory: Any, external: Any, body: Any, drawn: Any, rest: Any, work: Any, result: Any
) -> None:
    """Write the acceleration: inverse inertia times the sum of all forces, ``drawn`` by lines [eq:floating-cummins]."""
    inverse, damping, stiffness, rows, quadratic = body
    m = q.size
    for i in range(m):
        total = external[i] - memory[i] - rest[i]
        for j in range(m):
            total -= damping[i, j] * v[j] + stiffness[i, j] * q[j]
        work[i] = total + drawn[i]
    # Columns beyond the modes are the motion of the water in the measures of the last rows
    still = quadratic.size - (external.size - m)
    for k in range(quadratic.size):
        measure = -external[m + k - still] if k >= still else 0.0
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


@njit(cache=True, error_model="numpy", pointer=True)
def run_state_space(
    q: Any, v: Any, z: Any, first: int, steps: int, h: float, force: Any, body: Any, lines: Any, rest: Any,
    exponential: Any, inputs: Any, outputs: Any, limit: Any, every: int, saved: Any,
) -> tuple[int, int]:  # fmt: skip
    """Advance ``steps`` steps from step number ``first``; q, v, z change in place.

    ``force`` (2 n + 1, m + w) holds the external force at half steps, and the motion of the water in the measures of
    the last w rows of the quadratic damping. ``exponential`` holds exp(h L/2), exp(h L) and the weights Q, f1, f2, f3
    of ETDRK4. ``saved`` is (position, velocity, mooring force, pulls), rows at every ``every``-th step, then force (m,)
    and pulls of the lines at the present state, which a call leaves to the next. Returns the status and the number of
    good steps.
    """
    half, full, weight_q, f1, f2, f3 = exponential
    m, n = q.size, z.size
    work, drawn, now, pulls = np.empty(m), np.zeros(m), saved[4], saved[5]
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
    if first == 0:
        _draw(q, lines, now, pulls)
    for step in range(steps):
        row = 2 * (first + step)
        _memory_output(outputs, z, memory)
        _acceleration(q, v, memory, force[row], body, now, rest, work, a1)
        _memory_input(inputs, v, n1)
        for k in range(n):
            z_a[k] = half[k] * z[k] + weight_q[k] * n1[k]
        for i in range(m):
            q_stage[i] = q[i] + 0.5 * h * v[i]
            v2[i] = v[i] + 0.5 * h * a1[i]
        _memory_output(outputs, z_a, memory)
        _draw(q_stage, lines, drawn, pulls)
        _acceleration(q_stage, v2, memory, force[row + 1], body, drawn, rest, work, a2)
        _memory_input(inputs, v2, n2)
        for k in range(n):
            z_stage[k] = half[k] * z[k] + weight_q[k] * n2[k]
        for i in range(m):
            q_stage[i] = q[i] + 0.5 * h * v2[i]
            v3[i] = v[i] + 0.5 * h * a2[i]
        _memory_output(outputs, z_stage, memory)
        _draw(q_stage, lines, drawn, pulls)
        _acceleration(q_stage, v3, memory, force[row + 1], body, drawn, rest, work, a3)
        _memory_input(inputs, v3, n3)
        for k in range(n):
            z_stage[k] = half[k] * z_a[k] + weight_q[k] * (2.0 * n3[k] - n1[k])
        for i in range(m):
            q_stage[i] = q[i] + h * v3[i]
            v4[i] = v[i] + h * a3[i]
        _memory_output(outputs, z_stage, memory)
        _draw(q_stage, lines, drawn, pulls)
        _acceleration(q_stage, v4, memory, force[row + 2], body, drawn, rest, work, a4)
        _memory_input(inputs, v4, n4)
        for k in range(n):
            z_new[k] = full[k] * z[k] + f1[k] * n1[k] + 2.0 * f2[k] * (n2[k] + n3[k]) + f3[k] * n4[k]
        for i in range(m):
            q_new[i] = q[i] + h / 6.0 * (v[i] + 2.0 * v2[i] + 2.0 * v3[i] + v4[i])
            v_new[i] = v[i] + h / 6.0 * (a1[i] + 2.0 * a2[i] + 2.0 * a3[i] + a4[i])
        if _lost(q_new, v_new, limit):
            return DIVERGED, step
        q[:], v[:], z[:] = q_new, v_new, z_new
        keep = _is_kept(first + step + 1, every, saved)
        if saved[0].shape[0] > 0:
            # the next step begins with it, also that of the next call; a step that keeps nothing is tried alone
            _draw(q, lines, now, pulls)
        if keep:
            _save((first + step + 1) // every, q, v, saved)
    return RUNNING, steps


@njit(cache=True, error_model="numpy")
def _is_kept(number: int, every: int, saved: Any) -> bool:
    return number % every == 0 and number // every < saved[0].shape[0]


@njit(cache=True, error_model="numpy")
def _save(row: int, q: Any, v: Any, saved: Any) -> None:
    """Write a state that is kept, with what lines then draw."""
    position, velocity, force, tension, now, pulls = saved
    position[row] = q
    velocity[row] = v
    if pulls.size > 0:
        force[row] = now
        tension[row] = pulls


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
    work, drawn, now, pulls = np.empty(m), np.zeros(m), saved[4], saved[5]
    a1, a2, a3, a4 = np.empty(m), np.empty(m), np.empty(m), np.empty(m)
    q_stage, v2, v3, v4, memory = np.empty(m), np.empty(m), np.empty(m), np.empty(m), np.empty(m)
    start, middle, end = np.empty(m), np.empty(m), np.empty(m)
    q_new, v_new = np.empty(m), np.empty(m)
    if first == 0:
        _draw(q, lines, now, pulls)
    for step in range(steps):
        number = first + step
        row = 2 * number
        history[number % length] = v
        start[:], middle[:], end[:] = 0.0, 0.0, 0.0
        for back in range(min(number + 1, length - 1)):
            past = history[(number - back) % length]
            last = 0.5 if number - back == 0 or back == length - 2 else 1.0
            for i in range(m):
                for j in range(m):
                    if back > 0:
                        start[i] += last * kernel[2 * back, i, j] * past[j]
                        middle[i] += last * kernel[2 * back + 1, i, j] * past[j]
                    elif number > 0:
                        start[i] += 0.5 * kernel[0, i, j] * past[j]
                        middle[i] += 0.75 * kernel[1, i, j] * past[j]
                    else:
                        middle[i] += 0.25 * kernel[1, i, j] * past[j]
                    end[i] += last * kernel[2 * back + 2, i, j] * past[j]
        for i in range(m):
            memory[i] = h * start[i]
        _acceleration(q, v, memory, force[row], body, now, rest, work, a1)
        for i in range(m):
            q_stage[i] = q[i] + 0.5 * h * v[i]
            v2[i] = v[i] + 0.5 * h * a1[i]
        for i in range(m):
            memory[i] = h * middle[i]
            for j in range(m):
                memory[i] += 0.25 * h * kernel[0, i, j] * v2[j]
        _draw(q_stage, lines, drawn, pulls)
        _acceleration(q_stage, v2, memory, force[row + 1], body, drawn, rest, work, a2)
        for i in range(m):
            q_stage[i] = q[i] + 0.5 * h * v2[i]
            v3[i] = v[i] + 0.5 * h * a2[i]
        for i in range(m):
            memory[i] = h * middle[i]
            for j in range(m):
                memory[i] += 0.25 * h * kernel[0, i, j] * v3[j]
        _draw(q_stage, lines, drawn, pulls)
        _acceleration(q_stage, v3, memory, force[row + 1], body, drawn, rest, work, a3)
        for i in range(m):
            q_stage[i] = q[i] + h * v3[i]
            v4[i] = v[i] + h * a3[i]
        for i in range(m):
            memory[i] = h * end[i]
            for j in range(m):
                memory[i] += 0.5 * h * kernel[0, i, j] * v4[j]
        _draw(q_stage, lines, drawn, pulls)
        _acceleration(q_stage, v4, memory, force[row + 2], body, drawn, rest, work, a4)
        for i in range(m):
            q_new[i] = q[i] + h / 6.0 * (v[i] + 2.0 * v2[i] + 2.0 * v3[i] + v4[i])
            v_new[i] = v[i] + h / 6.0 * (a1[i] + 2.0 * a2[i] + 2.0 * a3[i] + a4[i])
        if _lost(q_new, v_new, limit):
            return DIVERGED, step
        q[:], v[:] = q_new, v_new
        keep = _is_kept(number + 1, every, saved)
        if saved[0].shape[0] > 0:
            _draw(q, lines, now, pulls)
        if keep:
            _save((number + 1) // every, q, v, saved)
    return RUNNING, steps
