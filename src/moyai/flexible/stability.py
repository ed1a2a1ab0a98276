"""The largest stable step of the explicit scheme, from the bars that meet at each node."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from moyai.core.arrays import Array, IntArray
from moyai.core.compiled import njit
from moyai.flexible.arrays import KernelArrays
from moyai.flexible.sheet_kernel import sheet_stiffness


@njit(cache=True, error_model="numpy")
def _largest_eigenvalue(p: Any, q: Any) -> float:
    """Return the largest eigenvalue of the product of two positive symmetric 3x3 blocks (xx, xy, xz, yy, yz, zz).

    Newton's method on the characteristic polynomial, from the trace, comes down to it from above.
    """
    a = np.empty((3, 3))
    place = ((0, 1, 2), (1, 3, 4), (2, 4, 5))
    for i in range(3):
        for j in range(3):
            total = 0.0
            for k in range(3):
                total += p[place[i][k]] * q[place[k][j]]
            a[i, j] = total
    trace = a[0, 0] + a[1, 1] + a[2, 2]
    if trace <= 0.0:
        return 0.0
    minors = a[0, 0] * a[1, 1] - a[0, 1] * a[1, 0] + a[0, 0] * a[2, 2] - a[0, 2] * a[2, 0]
    minors += a[1, 1] * a[2, 2] - a[1, 2] * a[2, 1]
    whole = (
        a[0, 0] * (a[1, 1] * a[2, 2] - a[1, 2] * a[2, 1])
        - a[0, 1] * (a[1, 0] * a[2, 2] - a[1, 2] * a[2, 0])
        + a[0, 2] * (a[1, 0] * a[2, 1] - a[1, 1] * a[2, 0])
    )
    root = trace
    for _ in range(12):
        slope = (3.0 * root - 2.0 * trace) * root + minors
        value = ((root - trace) * root + minors) * root - whole
        if slope <= 0.0 or value <= 0.0:
            break
        step = value / slope
        root -= step
        if step < 1e-6 * root:
            break
    return root


@njit(cache=True, error_model="numpy")
def _add_sheets(sheets: Any, place: Any, stiff: Any, damp: Any) -> None:
    # of a network without sheets the compiler leaves out their kernel
    if sheets is None:
        return
    sheet_stiffness(sheets[0], sheets[1], place, stiff, damp)


@njit(cache=True, error_model="numpy")
def _limit(
    place: Any, inverse: Any, start: Any, end: Any, spring: Any, viscous: Any, hinges: Any, bending: Any,
    sheets: Any,
) -> tuple[float, int]:  # fmt: skip
    count = place.shape[1]
    stiff, damp, bend = np.zeros((count, 6)), np.zeros((count, 6)), np.zeros(count)
    _add_sheets(sheets, place, stiff, damp)
    for k in range(start.size):
        a, b = start[k], end[k]
        x, y, z = place[0, b] - place[0, a], place[1, b] - place[1, a], place[2, b] - place[2, a]
        size = x * x + y * y + z * z
        per = 1.0 / size if size > 0.0 else 0.0
        outer = (x * x * per, x * y * per, x * z * per, y * y * per, y * z * per, z * z * per)
        for row in range(6):
            # a bar of no length may point anywhere
            part = outer[row] if size > 0.0 else (1.0 if row in (0, 3, 5) else 0.0)
            stiff[a, row] += spring[k] * part
            stiff[b, row] += spring[k] * part
            damp[a, row] += viscous[k] * part
            damp[b, row] += viscous[k] * part
    for h in range(hinges.shape[0]):
        b, turn = hinges[h, 1], bending[h, 1] + bending[h, 2]
        # 16 k / l^2 for equal bars: the highest mode of a fourth difference
        bend[b] += 4.0 * bending[h, 0] * turn * turn * max(inverse[0, b], inverse[3, b], inverse[5, b])
    least, worst = math.inf, 0
    share = np.empty(6)
    for i in range(count):
        share[:] = inverse[:, i]
        fast = 2.0 * _largest_eigenvalue(share, stiff[i]) + bend[i]
        if fast > 0.0:
            slow = 2.0 * _largest_eigenvalue(share, damp[i])
            limit = (math.sqrt(slow * slow + 4.0 * fast) - slow) / fast
            # with lag, viscosity turns the fastest mode into a zigzag from step to step: let it die by a fifth each
            # step
            calm = (math.sqrt(1.265625 * slow * slow + 4.05 * fast) - 1.125 * slow) / fast
            limit = min(limit, calm)
            if limit < least:
                least, worst = limit, i
    return least, worst


def step_limit(
    arrays: KernelArrays,
    position: Array,
    inverse: Array,
    rings: tuple[IntArray, Array] | None = None,
    sheets: tuple[Array, IntArray] | None = None,
) -> tuple[float, int]:
    """Return a step that is stable for central differences in any state of the bars, and the node that sets it.

    Twice the stiffness of the bars at a node bounds the whole matrix from above, block by block, so the largest
    eigenvalue of ``2 M^-1 sum k e e^T`` over the nodes bounds the highest frequency; the same with the viscosities
    bounds the damping. Lagged viscosity then requires ``dt^2 w^2 + 2 dt c <= 4`` to be stable and for
    ``dt^2 w^2 + 2.25 dt c <= 4.05`` to damp the zigzag of the fastest mode by a fifth in every step
    [eq:flexible-step-limit].

    Parameters
    ----------
    arrays : KernelArrays
        The network.
    position : ndarray, shape (3, n)
        Present state.
    inverse : ndarray, shape (6, n)
        Inverse mass blocks (xx, xy, xz, yy, yz, zz), zero where held.
    rings : tuple of ndarray, optional
        Node triples and stiffness of rings (:attr:`moyai.flexible.rings.RingArrays.hinges`), which count as hinges.
    sheets : (ndarray, ndarray of int), optional
        Constants and nodes of triangles.
    """
    hinges, bending = arrays.hinges, arrays.bending
    if rings is not None and len(rings[0]):
        hinges, bending = np.concatenate([hinges, rings[0]]), np.concatenate([bending, rings[1]])
    limit, worst = _limit(
        np.ascontiguousarray(position), np.ascontiguousarray(inverse), arrays.start, arrays.end,
        arrays.greatest_spring, arrays.bar("viscous").copy(), hinges, bending,
        sheets,
    )  # fmt: skip
    return float(limit), int(worst)
