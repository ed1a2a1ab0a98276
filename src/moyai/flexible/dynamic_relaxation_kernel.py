"""Compiled kernel of dynamic relaxation: towards rest with masses of the mind, stopped at every peak of the motion.

It works on the array of :mod:`moyai.flexible.explicit_rows`, whose velocities stay zero: loads are those of a
network at rest in a current.
"""

from __future__ import annotations

import math
from typing import Any

from moyai.core.compiled import njit
from moyai.flexible.explicit_forces import bending_forces, rib_forces, spine_forces
from moyai.flexible.explicit_loads import loads
from moyai.flexible.explicit_parts import add_ring_forces, add_sheet_forces, room_for_speeds, screens
from moyai.flexible.explicit_rows import FREE_X, FX, QX, ROW, STIFF, TX, X, Y, Z
from moyai.flexible.ground_kernel import FLAT, ground, held


@njit(cache=True, error_model="numpy")
def add_screen_loads(A: Any, panels: Any) -> None:
    """Add the loads of net panels in still motion to those of the nodes."""
    if panels is None:
        return
    screen = panels[1]
    for axis in range(3):
        for i in range(screen.shape[1]):
            A[QX + axis * ROW + i] += screen[6 + axis, i]


@njit(cache=True, error_model="numpy")
def relax(
    A: Any, sizes: Any, runs: Any, curves: Any, hinges: Any, bending: Any, attached: Any, fluid: Any, surface: bool,
    parts: Any, bed: Any, mass: Any, pace: Any, steps: int, every: int, goal: float, keep: float,
) -> tuple[int, float, int]:  # fmt: skip
    """Move the nodes towards rest; return the steps taken, the largest force left and its node.

    ``mass`` (n) is chosen so that a pseudo step of 1 is stable [eq:cage-relaxation]; ``pace`` (3, n) keeps the pseudo
    velocities from call to call. Loads are taken anew every ``every`` steps. Ends when no force exceeds ``goal``.
    ``keep`` is the part of its pseudo velocity that a node keeps in a step: below 1 it calms slack net that flutters
    in its own lift.
    """
    count, nodes = sizes[0], mass.size
    panels, rings, sheets, _ = parts
    speeds = room_for_speeds(panels)
    energy, left, worst = 0.0, math.inf, 0
    for it in range(steps):
        if it % every == 0:
            loads(A, sizes, runs, attached, fluid[0], fluid[1], surface, False, 0.0, sheets)
            screens(A, count, panels, 0.5 * fluid[0], 0.0, 0.0, True, speeds, 0.0)
            add_screen_loads(A, panels)
        for axis in range(3):
            for i in range(count):
                A[TX + axis * ROW + i] = A[QX + axis * ROW + i]
        rib_forces(A, runs, curves)
        bending_forces(A, hinges, bending)
        add_sheet_forces(A, sheets)
        add_ring_forces(A, rings)
        spine_forces(A, sizes[1])
        now, left = 0.0, 0.0
        for i in range(nodes):
            part = push = nx = ny = nz = 0.0
            for axis in range(3):
                row = axis * ROW + i
                free = A[FREE_X + row]
                force = A[TX + row] + A[FX + row] - A[FX + row - 1]
                if bed[3] > 0.0:
                    if axis == 0:
                        level, nx, ny, nz = bed[0], 0.0, 0.0, 1.0
                        if bed.size > FLAT:
                            level, nx, ny, nz = ground(bed, A[X + i], A[Y + i])
                        push = max(A[STIFF + i] * (level - A[Z + i]) * nz, 0.0)
                        nx, ny, nz = held(bed, nx, ny, nz)
                    force += push * (nx if axis == 0 else (ny if axis == 1 else nz))
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
