"""The march of :mod:`moyai.floating.kernel` for several records side by side, a record a vector lane.

Every lane does the same operations in the same order as a run by itself, whatever the others do: the results are the
same to the last bit.
"""

from __future__ import annotations

import numpy as np

from moyai.core.arrays import Array, BoolArray, ComplexArray, IntArray
from moyai.core.compiled import njit
from moyai.mooring.planar_kernel import planar_line_force

#: Records side by side.
LANES = 8


@njit(cache=True, error_model="numpy")
def _output(outputs: ComplexArray, real: Array, imaginary: Array, memory: Array) -> None:
    """Write the force of the memory."""
    for i in range(memory.shape[0]):
        for lane in range(LANES):
            memory[i, lane] = 0.0
        for k in range(real.shape[0]):
            a, b = outputs[i, k].real, outputs[i, k].imag
            for lane in range(LANES):
                memory[i, lane] += a * real[k, lane] - b * imaginary[k, lane]


@njit(cache=True, error_model="numpy")
def _input(inputs: ComplexArray, v: Array, real: Array, imaginary: Array) -> None:
    """Write what drives the states of the memory."""
    for k in range(real.shape[0]):
        for lane in range(LANES):
            real[k, lane], imaginary[k, lane] = 0.0, 0.0
        for j in range(v.shape[0]):
            a, b = inputs[k, j].real, inputs[k, j].imag
            for lane in range(LANES):
                real[k, lane] += a * v[j, lane]
                imaginary[k, lane] += b * v[j, lane]


@njit(cache=True, error_model="numpy")
def _half_step(
    half: ComplexArray, weight: ComplexArray, real: Array, imaginary: Array, driven: Array, turned: Array, ahead: Array,
    across: Array,
) -> None:  # fmt: skip
    """Write the states half a step ahead under what drives them, real and imaginary parts apart."""
    for k in range(real.shape[0]):
        a, b, c, d = half[k].real, half[k].imag, weight[k].real, weight[k].imag
        for lane in range(LANES):
            ahead[k, lane] = (a * real[k, lane] - b * imaginary[k, lane]) + (c * driven[k, lane] - d * turned[k, lane])
            across[k, lane] = (a * imaginary[k, lane] + b * real[k, lane]) + (c * turned[k, lane] + d * driven[k, lane])


@njit(cache=True, error_model="numpy")
def _draw(
    q: Array, lines: tuple[Array, IntArray, Array, IntArray, Array], starts: Array, going: BoolArray, force: Array,
    drawn: Array, pulls: Array,
) -> None:  # fmt: skip
    """Write the pull of all lines into the first three rows of ``drawn``, lane by lane; ``force`` (3,) is room."""
    parameters, index, nodes, lookup, pose = lines
    if parameters.shape[0] == 0:
        return
    for lane in range(LANES):
        if going[lane]:
            for i in range(3):
                force[i] = 0.0
            planar_line_force(
                pose[0] + q[0, lane], pose[1] + q[1, lane], pose[2] + q[2, lane], parameters, index, nodes, lookup,
                starts[lane], force, pulls[lane],
            )  # fmt: skip
            for i in range(3):
                drawn[i, lane] = force[i]


@njit(cache=True, error_model="numpy")
def _acceleration(
    q: Array, v: Array, memory: Array, force: Array, row: int, body: tuple[Array, Array, Array, Array, Array],
    drawn: Array, rest: Array, measure: Array, work: Array, result: Array,
) -> None:  # fmt: skip
    """Write the accelerations of all lanes, ``drawn`` by lines [eq:floating-cummins]; ``measure`` (lanes,) is room."""
    inverse, damping, stiffness, rows, quadratic = body
    m, columns, last = q.shape[0], force.shape[2], force.shape[0] - 1  # lanes beyond the last record are not kept
    for i in range(m):
        for lane in range(LANES):
            work[i, lane] = force[min(lane, last), row, i] - memory[i, lane] - rest[i]
        for j in range(m):
            a, b = damping[i, j], stiffness[i, j]
            for lane in range(LANES):
                work[i, lane] -= a * v[j, lane] + b * q[j, lane]
        for lane in range(LANES):
            work[i, lane] += drawn[i, lane]
    still = quadratic.size - (columns - m)
    for k in range(quadratic.size):
        for lane in range(LANES):
            measure[lane] = -force[min(lane, last), row, m + k - still] if k >= still else 0.0
        for j in range(m):
            a = rows[k, j]
            for lane in range(LANES):
                measure[lane] += a * v[j, lane]
        for lane in range(LANES):
            measure[lane] = quadratic[k] * abs(measure[lane]) * measure[lane]
        for j in range(m):
            a = rows[k, j]
            for lane in range(LANES):
                work[j, lane] -= a * measure[lane]
    for i in range(m):
        for lane in range(LANES):
            result[i, lane] = 0.0
        for j in range(m):
            a = inverse[i, j]
            for lane in range(LANES):
                result[i, lane] += a * work[j, lane]


@njit(cache=True, error_model="numpy")
def run_lanes(
    q: Array, v: Array, real: Array, imaginary: Array, first: int, steps: int, h: float, force: Array,
    body: tuple[Array, Array, Array, Array, Array], lines: tuple[Array, IntArray, Array, IntArray, Array],
    starts: Array, rest: Array,
    exponential: tuple[ComplexArray, ComplexArray, ComplexArray, ComplexArray, ComplexArray, ComplexArray],
    inputs: ComplexArray, outputs: ComplexArray, limit: Array, every: int,
    saved: tuple[Array, Array, Array, Array, Array, Array], good: IntArray, going: BoolArray,
) -> None:  # fmt: skip
    """Advance all lanes that are going; see :func:`moyai.floating.kernel.run_state_space`.

    ``q``, ``v`` (m, lanes) and the states of the memory (n, lanes) change in place; ``force`` is (records, 2 n + 1,
    m + w); ``saved`` as there, records first, force (m, lanes) and pulls (lanes, lines) of
    the present state. ``good`` counts the good steps of each lane; one that is lost stops
    ``going``.
    """
    half, full, weight, f1, f2, f3 = exponential
    m, n = q.shape[0], real.shape[0]
    work, memory, drawn = np.empty((m, LANES)), np.empty((m, LANES)), np.zeros((m, LANES))
    measure, pull = np.empty(LANES), np.empty(3)
    positions, velocities, forces, tensions, now, pulls = saved
    a1, a2, a3, a4 = np.empty((m, LANES)), np.empty((m, LANES)), np.empty((m, LANES)), np.empty((m, LANES))
    place, v2, v3, v4 = np.empty((m, LANES)), np.empty((m, LANES)), np.empty((m, LANES)), np.empty((m, LANES))
    r1, r2, r3, r4 = np.empty((n, LANES)), np.empty((n, LANES)), np.empty((n, LANES)), np.empty((n, LANES))
    i1, i2, i3, i4 = np.empty((n, LANES)), np.empty((n, LANES)), np.empty((n, LANES)), np.empty((n, LANES))
    ra, ia, rs, js = np.empty((n, LANES)), np.empty((n, LANES)), np.empty((n, LANES)), np.empty((n, LANES))
    if first == 0:
        _draw(q, lines, starts, going, pull, now, pulls)
    for step in range(steps):
        row = 2 * (first + step)
        _output(outputs, real, imaginary, memory)
        _acceleration(q, v, memory, force, row, body, now, rest, measure, work, a1)
        _input(inputs, v, r1, i1)
        _half_step(half, weight, real, imaginary, r1, i1, ra, ia)
        for i in range(m):
            for lane in range(LANES):
                place[i, lane] = q[i, lane] + 0.5 * h * v[i, lane]
                v2[i, lane] = v[i, lane] + 0.5 * h * a1[i, lane]
        _output(outputs, ra, ia, memory)
        _draw(place, lines, starts, going, pull, drawn, pulls)
        _acceleration(place, v2, memory, force, row + 1, body, drawn, rest, measure, work, a2)
        _input(inputs, v2, r2, i2)
        _half_step(half, weight, real, imaginary, r2, i2, rs, js)
        for i in range(m):
            for lane in range(LANES):
                place[i, lane] = q[i, lane] + 0.5 * h * v2[i, lane]
                v3[i, lane] = v[i, lane] + 0.5 * h * a2[i, lane]
        _output(outputs, rs, js, memory)
        _draw(place, lines, starts, going, pull, drawn, pulls)
        _acceleration(place, v3, memory, force, row + 1, body, drawn, rest, measure, work, a3)
        _input(inputs, v3, r3, i3)
        for k in range(n):
            a, b, c, d = half[k].real, half[k].imag, weight[k].real, weight[k].imag
            for lane in range(LANES):
                x, y = 2.0 * r3[k, lane] - r1[k, lane], 2.0 * i3[k, lane] - i1[k, lane]
                rs[k, lane] = (a * ra[k, lane] - b * ia[k, lane]) + (c * x - d * y)
                js[k, lane] = (a * ia[k, lane] + b * ra[k, lane]) + (c * y + d * x)
        for i in range(m):
            for lane in range(LANES):
                place[i, lane] = q[i, lane] + h * v3[i, lane]
                v4[i, lane] = v[i, lane] + h * a3[i, lane]
        _output(outputs, rs, js, memory)
        _draw(place, lines, starts, going, pull, drawn, pulls)
        _acceleration(place, v4, memory, force, row + 2, body, drawn, rest, measure, work, a4)
        _input(inputs, v4, r4, i4)
        for k in range(n):
            a, b = full[k].real, full[k].imag
            c, d = f1[k].real, f1[k].imag
            e, f = 2.0 * f2[k].real, 2.0 * f2[k].imag
            g, p = f3[k].real, f3[k].imag
            for lane in range(LANES):
                x, y = r2[k, lane] + r3[k, lane], i2[k, lane] + i3[k, lane]
                rs[k, lane] = (
                    (a * real[k, lane] - b * imaginary[k, lane]) + (c * r1[k, lane] - d * i1[k, lane]) + (e * x - f * y)
                ) + (g * r4[k, lane] - p * i4[k, lane])
                js[k, lane] = (
                    (a * imaginary[k, lane] + b * real[k, lane]) + (c * i1[k, lane] + d * r1[k, lane]) + (e * y + f * x)
                ) + (g * i4[k, lane] + p * r4[k, lane])
        for i in range(m):
            for lane in range(LANES):
                place[i, lane] = q[i, lane] + h / 6.0 * (
                    v[i, lane] + 2.0 * v2[i, lane] + 2.0 * v3[i, lane] + v4[i, lane]
                )
                a1[i, lane] = v[i, lane] + h / 6.0 * (a1[i, lane] + 2.0 * a2[i, lane] + 2.0 * a3[i, lane] + a4[i, lane])
        for lane in range(LANES):
            for i in range(m):
                # written so that NaN is lost too
                if not (abs(place[i, lane]) <= limit[i]) or not np.isfinite(a1[i, lane]):
                    going[lane] = False
        for i in range(m):
            q[i], v[i] = place[i], a1[i]
        for k in range(n):
            real[k], imaginary[k] = rs[k], js[k]
        number = first + step + 1
        keep = number % every == 0 and number // every < positions.shape[1]
        # the next step begins with it, also that of the next call
        _draw(q, lines, starts, going, pull, now, pulls)
        for lane in range(LANES):
            if not going[lane]:
                continue
            good[lane] = number
            if keep:
                out = number // every
                positions[lane, out], velocities[lane, out] = q[:, lane], v[:, lane]
                if lines[0].shape[0] > 0:
                    forces[lane, out], tensions[lane, out] = now[:, lane], pulls[lane]
