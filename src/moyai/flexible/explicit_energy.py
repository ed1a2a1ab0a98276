"""Energies and work of the explicit scheme."""

from __future__ import annotations

import math

from moyai.core.arrays import Array, IntArray
from moyai.core.compiled import njit
from moyai.flexible.explicit_rows import (
    FAST,
    FREE_X,
    FREE_Y,
    FREE_Z,
    FX,
    LENGTH,
    LIMIT,
    MXX,
    MXY,
    MXZ,
    MYY,
    MYZ,
    MZZ,
    PX,
    PY,
    PZ,
    RIB,
    ROW,
    SPRING,
    STIFF,
    TX,
    U,
    V,
    W,
    X,
    Y,
    Z,
)
from moyai.flexible.ground_kernel import FLAT, ground


@njit(cache=True, error_model="numpy", fastmath=FAST)
def kinetic_energy(A: Array, count: int) -> float:
    """Return the kinetic energy of what is free, with its added mass [J]."""
    kinetic = 0.0
    for i in range(count):
        u, v, w = A[FREE_X + i] * A[U + i], A[FREE_Y + i] * A[V + i], A[FREE_Z + i] * A[W + i]
        kinetic += 0.5 * (A[MXX + i] * u * u + A[MYY + i] * v * v + A[MZZ + i] * w * w)
        kinetic += A[MXY + i] * u * v + A[MXZ + i] * u * w + A[MYZ + i] * v * w
    return kinetic


@njit(cache=True, error_model="numpy")
def elastic_energy(
    A: Array, sizes: IntArray, runs: IntArray, curves: Array, hinges: IntArray, stiffness: Array, bed: Array
) -> float:
    """Return the energy of bars, hinges and bed contact [J]."""
    elastic = 0.0
    for r in range(runs.shape[0] + 1):
        a0, b0, k0, count, curve = 0, 1, 0, sizes[1], -1
        if r > 0:
            a0, b0, k0, count, curve = (
                runs[r - 1, 0],
                runs[r - 1, 1],
                RIB + runs[r - 1, 2],
                runs[r - 1, 3],
                runs[r - 1, 4],
            )
        for i in range(count):
            a, b, k = a0 + i, b0 + i, k0 + i
            dx, dy, dz = A[X + b] - A[X + a], A[Y + b] - A[Y + a], A[Z + b] - A[Z + a]
            stretch = math.sqrt(dx * dx + dy * dy + dz * dz) - A[LENGTH + k]
            if curve < 0:
                if A[SPRING + k] * stretch > A[LIMIT + k]:
                    elastic += 0.5 * A[SPRING + k] * stretch * stretch
            elif stretch > 0.0:
                strain, j, area = stretch / A[LENGTH + k], 0, 0.0
                while j + 2 < curves.shape[2] and strain > curves[curve, 0, j + 1]:
                    area += (
                        0.5
                        * (curves[curve, 1, j] + curves[curve, 1, j + 1])
                        * (curves[curve, 0, j + 1] - curves[curve, 0, j])
                    )
                    j += 1
                rest = strain - curves[curve, 0, j]
                elastic += A[LENGTH + k] * (area + rest * (curves[curve, 1, j] + 0.5 * curves[curve, 2, j] * rest))
    for h in range(hinges.shape[0]):
        a, b, c = hinges[h, 0], hinges[h, 1], hinges[h, 2]
        for axis in range(3):
            p = A[X + axis * ROW + b] - A[X + axis * ROW + a]
            q = A[X + axis * ROW + c] - A[X + axis * ROW + b]
            elastic += 0.5 * stiffness[h, 0] * (q * stiffness[h, 2] - p * stiffness[h, 1]) ** 2
    for i in range(sizes[0] if bed[3] > 0.0 else 0):
        level, up = bed[0], 1.0
        if bed.size > FLAT:
            level, _, _, up = ground(bed, A[X + i], A[Y + i])
        depth = (level - A[Z + i]) * up
        if depth > 0.0 and A[FREE_Z + i] > 0.0:
            elastic += 0.5 * A[STIFF + i] * depth * depth
    return elastic


@njit(cache=True, error_model="numpy")
def node_force(A: Array, node: int, axis: int) -> float:
    """Return the force of bars and hinges on a node (without the loads)."""
    row = axis * ROW + node
    return A[TX + row] - A[PX + row] + A[FX + row] - A[FX + row - 1]


@njit(cache=True, error_model="numpy", fastmath=FAST)
def load_work(A: Array, count: int) -> float:
    """Return the sum of load times position over what is free."""
    work = 0.0
    for i in range(count):
        work += A[FREE_X + i] * A[PX + i] * A[X + i] + A[FREE_Y + i] * A[PY + i] * A[Y + i]
        work += A[FREE_Z + i] * A[PZ + i] * A[Z + i]
    return work


@njit(cache=True, error_model="numpy", fastmath=FAST)
def load_power(A: Array, count: int) -> float:
    """Return the sum of load times velocity over what is free.

    A held load that changes at a time step does so between the velocities half a step before and after: half a step
    times the change of this sum is its work in the energy that leapfrog keeps [eq:flexible-discrete-energy].
    """
    power = 0.0
    for i in range(count):
        power += A[FREE_X + i] * A[PX + i] * A[U + i] + A[FREE_Y + i] * A[PY + i] * A[V + i]
        power += A[FREE_Z + i] * A[PZ + i] * A[W + i]
    return power
