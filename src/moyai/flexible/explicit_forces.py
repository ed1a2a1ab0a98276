"""Forces of bars and hinges in the explicit scheme."""

from __future__ import annotations

import math
from typing import Any

from moyai.core.compiled import njit
from moyai.flexible.explicit_rows import (
    FAST,
    FX,
    FY,
    FZ,
    LENGTH,
    LIMIT,
    PEAK,
    PULL,
    RIB,
    ROW,
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


@njit(cache=True, error_model="numpy", fastmath=FAST)
def spine_forces(A: Any, count: int) -> None:
    """Write force, tension and highest tension of the spine's bars [eq:flexible-bar]."""
    for i in range(count):
        dx, dy, dz = A[X + i + 1] - A[X + i], A[Y + i + 1] - A[Y + i], A[Z + i + 1] - A[Z + i]
        square = dx * dx + dy * dy + dz * dz + TINY
        inverse = 1.0 / math.sqrt(square)
        along = dx * (A[U + i + 1] - A[U + i]) + dy * (A[V + i + 1] - A[V + i]) + dz * (A[W + i + 1] - A[W + i])
        elastic = A[SPRING + i] * (square * inverse - A[LENGTH + i])
        pull = elastic + A[VISCOUS + i] * along * inverse
        limit = A[LIMIT + i]
        pull = pull if pull > limit else limit
        A[PULL + i] = pull
        A[PEAK + i] = pull if pull > A[PEAK + i] else A[PEAK + i]
        per = pull * inverse
        A[FX + i] = per * dx
        A[FY + i] = per * dy
        A[FZ + i] = per * dz


@njit(cache=True, error_model="numpy", fastmath=FAST)
def rib_forces(A: Any, runs: Any, curves: Any) -> None:
    """Do the same for the ribs and add their forces to the total of the nodes."""
    for r in range(runs.shape[0]):
        a0, b0, k0, count, curve = runs[r, 0], runs[r, 1], runs[r, 2], runs[r, 3], runs[r, 4]
        if curve < 0:
            for i in range(count):
                a, b, k = a0 + i, b0 + i, RIB + k0 + i
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
        else:
            for i in range(count):
                _curved(A, a0 + i, b0 + i, RIB + k0 + i, curves[curve])
        for axis in range(3):
            node, bar = TX + axis * ROW, FX + axis * ROW + RIB + k0
            for i in range(count):
                A[node + a0 + i] += A[bar + i]
            for i in range(count):
                A[node + b0 + i] -= A[bar + i]


@njit(cache=True, error_model="numpy")
def _curved(A: Any, a: int, b: int, k: int, curve: Any) -> None:
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
def bending_forces(A: Any, hinges: Any, stiffness: Any) -> None:
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
