"""Compiled kernels of statics: bars and bed with tensions and pushes as unknowns next to the places."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from moyai.core.compiled import njit
from moyai.flexible.force_kernel import elastic_pull
from moyai.flexible.ground_kernel import ground, held


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
        elastic, slope = elastic_pull(bars, k, size, curve[k], curves)
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
        node_law[0, i] = node_law[1, i] = node_law[2, i] = node_law[3, i] = 0.0
        if bed[3] > 0.0 and nodes[5, i] > 0.0:
            level, nx, ny, nz = ground(bed, x[i, 0], x[i, 1])
            square = 0.25 * soft * soft / pushes[i]
            share = pushes[i] / (pushes[i] + square)
            gap = share * (nodes[5, i] * (level - x[i, 2]) * nz - pushes[i] + square)
            node_law[0, i], node_law[2, i], node_law[3, i] = share * nodes[5, i], gap, pushes[i] + gap
            most = max(most, abs(gap) * nodes[11, i])
            nx, ny, nz = held(bed, nx, ny, nz)
            force[i, 0] += nx * (pushes[i] + gap)
            force[i, 1] += ny * (pushes[i] + gap)
            force[i, 2] += nz * (pushes[i] + gap)
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
            _, nx, ny, nz = ground(bed, x[i, 0], x[i, 1])
            change = node_law[2, i] - node_law[0, i] * (nx * step[i, 0] + ny * step[i, 1] + nz * step[i, 2])
            new_pushes[i] = max(pushes[i] + part * change, 0.1 * pushes[i])
            _, nx, ny, nz = ground(bed, new_x[i, 0], new_x[i, 1])
            nx, ny, nz = held(bed, nx, ny, nz)
            force[i, 0] += nx * new_pushes[i]
            force[i, 1] += ny * new_pushes[i]
            force[i, 2] += nz * new_pushes[i]
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
