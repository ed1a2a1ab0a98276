"""Forces of bars and hinges in the explicit scheme."""

from __future__ import annotations

import math

from moyai.core.arrays import Array, IntArray
from moyai.core.compiled import njit
from moyai.flexible.explicit_rows import (
    FAST,
    FIRST_END,
    FX,
    FY,
    FZ,
    LENGTH,
    LIMIT,
    MOTION,
    PEAK,
    PULL,
    RIB,
    ROW,
    SECOND_END,
    SPRING,
    TINY,
    TX,
    VISCOUS,
    U,
    V,
    W,
    X,
    Y,
    Z,
)

#: Ribs of a run up to which loops over its rows cost more than what they do.
SHORT = 8


@njit(cache=True, error_model="numpy")
def _copy(target: Array, source: Array) -> None:
    for i in range(target.size):
        target[i] = source[i]


@njit(cache=True, error_model="numpy")
def add(target: Array, source: Array, factor: float) -> None:
    """Add a factor times values to a stretch of a row.

    Of a stretch the compiler knows that no index is negative, of a sum of offsets it does not, and then takes one
    number after the other.
    """
    for i in range(target.size):
        target[i] += factor * source[i]


@njit(cache=True, error_model="numpy")
def fetch_ends(A: Array, runs: IntArray, rows: int) -> int:
    """Copy the first ``rows`` rows of nodes to the ends of the ribs, in their order; return the number of ribs."""
    last = 0
    for r in range(runs.shape[0]):
        a0, b0, k0, count = runs[r, 0], runs[r, 1], runs[r, 2], runs[r, 3]
        last = k0 + count
        if count < SHORT:
            for i in range(count):
                for row in range(rows):
                    A[FIRST_END + row * ROW + k0 + i] = A[row * ROW + a0 + i]
                    A[SECOND_END + row * ROW + k0 + i] = A[row * ROW + b0 + i]
        else:
            for row in range(rows):
                one, two, node = FIRST_END + row * ROW + k0, SECOND_END + row * ROW + k0, row * ROW
                _copy(A[one : one + count], A[node + a0 : node + a0 + count])
                _copy(A[two : two + count], A[node + b0 : node + b0 + count])
    return last


@njit(cache=True, error_model="numpy", fastmath=FAST)
def bar_pulls(A: Array, a0: int, b0: int, k0: int, count: int) -> None:
    """Write force, tension and highest tension of straight bars from nodes a0, b0 on [eq:flexible-bar]."""
    for i in range(count):
        a, b, k = a0 + i, b0 + i, k0 + i
        dx, dy, dz = A[X + b] - A[X + a], A[Y + b] - A[Y + a], A[Z + b] - A[Z + a]
        square = dx * dx + dy * dy + dz * dz + TINY
        inverse = 1.0 / math.sqrt(square)
        along = dx * (A[U + b] - A[U + a]) + dy * (A[V + b] - A[V + a]) + dz * (A[W + b] - A[W + a])
        elastic = A[SPRING + k] * (square * inverse - A[LENGTH + k])
        pull = elastic + A[VISCOUS + k] * along * inverse
        limit = A[LIMIT + k]
        pull = pull if pull > limit else limit
        A[PULL + k] = pull
        A[PEAK + k] = pull if pull > A[PEAK + k] else A[PEAK + k]
        per = pull * inverse
        A[FX + k] = per * dx
        A[FY + k] = per * dy
        A[FZ + k] = per * dz


@njit(cache=True, error_model="numpy")
def spine_forces(A: Array, count: int) -> None:
    """Write force, tension and highest tension of the spine's bars."""
    bar_pulls(A, 0, 1, 0, count)


@njit(cache=True, error_model="numpy")
def rib_forces(A: Array, runs: IntArray, curves: Array) -> None:
    """Do the same for the ribs and add their forces to the total of the nodes."""
    if runs.shape[0] == 0:
        return
    fetch_ends(A, runs, MOTION)
    # ribs that follow a rope curve come last
    straight = 0
    for r in range(runs.shape[0]):
        if runs[r, 4] < 0:
            straight = runs[r, 2] + runs[r, 3]
    bar_pulls(A, FIRST_END, SECOND_END, RIB, straight)
    for r in range(runs.shape[0]):
        a0, b0, k0, count, curve = runs[r, 0], runs[r, 1], runs[r, 2], runs[r, 3], runs[r, 4]
        if curve >= 0:
            for i in range(count):
                _curved(A, a0 + i, b0 + i, RIB + k0 + i, curves[curve])
        for axis in range(3):
            node, bar = TX + axis * ROW, FX + axis * ROW + RIB + k0
            force = A[bar : bar + count]
            add(A[node + a0 : node + a0 + count], force, 1.0)
            add(A[node + b0 : node + b0 + count], force, -1.0)


@njit(cache=True, error_model="numpy")
def _curved(A: Array, a: int, b: int, k: int, curve: Array) -> None:
    """Write the force of one rib whose tension follows a rope curve (rows: strain, tension, slope)."""
    dx, dy, dz = A[X + b] - A[X + a], A[Y + b] - A[Y + a], A[Z + b] - A[Z + a]
    size = math.sqrt(dx * dx + dy * dy + dz * dz + TINY)
    strain = size / A[LENGTH + k] - 1.0
    j = 0
    while j + 2 < curve.shape[1] and strain > curve[0, j + 1]:
        j += 1
    elastic = curve[1, j] + curve[2, j] * (strain - curve[0, j])
    rate = (dx * (A[U + b] - A[U + a]) + dy * (A[V + b] - A[V + a]) + dz * (A[W + b] - A[W + a])) / size
    pull = max(elastic + A[VISCOUS + k] * rate, A[LIMIT + k])
    A[PULL + k] = pull
    A[PEAK + k] = max(A[PEAK + k], pull)
    A[FX + k], A[FY + k], A[FZ + k] = pull / size * dx, pull / size * dy, pull / size * dz


@njit(cache=True, error_model="numpy")
def bending_forces(A: Array, hinges: IntArray, stiffness: Array) -> None:
    """Add the forces of the bending energy of every hinge to the total [eq:flexible-bending]."""
    for h in range(hinges.shape[0]):
        a, b, c = hinges[h, 0], hinges[h, 1], hinges[h, 2]
        one, two = stiffness[h, 1], stiffness[h, 2]
        for axis in range(3):
            row = axis * ROW
            turn = (A[X + row + c] - A[X + row + b]) * two - (A[X + row + b] - A[X + row + a]) * one
            turn *= stiffness[h, 0]
            A[TX + row + a] -= turn * one
            A[TX + row + b] += turn * (one + two)
            A[TX + row + c] -= turn * two
