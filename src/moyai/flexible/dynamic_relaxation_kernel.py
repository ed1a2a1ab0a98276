"""Compiled kernel of dynamic relaxation: towards rest with masses of the mind, stopped at every peak of the motion.

It works on the array of :mod:`moyai.flexible.explicit_kernel`, whose velocities stay zero: loads are those of a
network at rest in a current.
"""

from __future__ import annotations

import math
from typing import Any

from moyai.core.compiled import njit
from moyai.flexible.explicit_kernel import (
    FREE_X,
    FX,
    QX,
    ROW,
    STIFF,
    TX,
    TY,
    TZ,
    U,
    X,
    Y,
    Z,
    bending_forces,
    loads,
    rib_forces,
    screens,
    spine_forces,
)
from moyai.flexible.ring_kernel import ring_loads
from moyai.flexible.sheet_kernel import sheet_forces


@njit(cache=True, error_model="numpy")
def relax(
    A: Any, sizes: Any, runs: Any, curves: Any, hinges: Any, bending: Any, attached: Any, fluid: Any, surface: bool,
    nets: Any, sheets: Any, level: float, mass: Any, pace: Any, steps: int, every: int, goal: float, keep: float,
) -> tuple[int, float, int]:  # fmt: skip
    """Move the nodes towards rest; return the steps taken, the largest force left and its node.

    ``mass`` (n) is chosen so that a pseudo step of 1 is stable [eq:cage-relaxation]; ``pace`` (3, n) keeps the pseudo
    velocities from call to call. Loads are taken anew every ``every`` steps. Ends when no force exceeds ``goal``.
    ``keep`` is the part of its pseudo velocity that a node keeps in a step: below 1 it calms slack net that flutters
    in its own lift.
    """
    count, nodes = sizes[0], mass.size
    panels, screen, rings, moments = nets
    table, triangles, _, _, peak = sheets
    energy, left, worst = 0.0, math.inf, 0
    for it in range(steps):
        if it % every == 0:
            loads(A, sizes, runs, attached, fluid[0], fluid[1], surface, False, 0.0, sheets)
            if panels[0].shape[0] > 0:
                screens(A, count, panels, 0.5 * fluid[0], screen, 0.0, 0.0)
                for axis in range(3):
                    for i in range(nodes):
                        A[QX + axis * ROW + i] += screen[6 + axis, i]
        for axis in range(3):
            for i in range(count):
                A[TX + axis * ROW + i] = A[QX + axis * ROW + i]
        rib_forces(A, runs, curves)
        bending_forces(A, hinges, bending)
        if triangles.shape[0] > 0:
            sheet_forces(table, triangles, A, X, A, U, A, TX, 1, ROW, peak)
        if rings[0].size > 0:
            ring_loads(A[X:], A[Y:], A[Z:], rings, A[TX:], A[TY:], A[TZ:], moments)
        spine_forces(A, sizes[1])
        now, left = 0.0, 0.0
        for i in range(nodes):
            part = 0.0
            for axis in range(3):
                row = axis * ROW + i
                free = A[FREE_X + row]
                force = A[TX + row] + A[FX + row] - A[FX + row - 1]
                if axis == 2:
                    force += max(A[STIFF + i] * (level - A[Z + i]), 0.0)
                force *= free
                part += force * force
                pace[axis, i] = keep * pace[axis, i] + force / mass[i]
                now += mass[i] * pace[axis, i] * pace[axis, i]
            if not part <= left:
                left, worst = part, i
        left = math.sqrt(left)
        if left <= goal or not now < math.inf:
            return it + 1, left, worst
        if now < energy:
            # past the peak: stop everything
            for axis in range(3):
                for i in range(nodes):
                    pace[axis, i] = 0.0
            energy = 0.0
            continue
        energy = now
        for axis in range(3):
            for i in range(nodes):
                A[X + axis * ROW + i] += pace[axis, i]
    return steps, left, worst
