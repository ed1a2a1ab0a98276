"""What only some networks have in the explicit scheme: net panels, rings, sheets and dense blocks of added mass.

A network without one of them has ``None`` in its place. The compiler then leaves out the whole kernel: the first run of
a mooring line does not wait for those of sheets and nets.

Panels are (their system, matrices and velocities (12, n)); rings are (their system, moments, room for forces (3, n));
sheets are (constants, triangles, rows of the light side (4, n), rate of drag (1), highest stress, the constants block
by block, room for a block and its triangles); blocks are (nodes, guides, frames, added, inverse, along, own mass,
whether convective, rows of the light side, room).
"""

from __future__ import annotations

from typing import Any

import numpy as np

from moyai.core.arrays import PLAIN, Array
from moyai.core.compiled import njit
from moyai.flexible.explicit_loads import invert_blocks
from moyai.flexible.explicit_rows import (
    DAMP,
    ETA,
    FAST,
    FREE_X,
    FX,
    IXX,
    MXX,
    MYY,
    MZZ,
    QX,
    ROW,
    STIFF,
    TX,
    TY,
    TZ,
    WA,
    WB,
    WC,
    WU,
    WV,
    WW,
    U,
    V,
    W,
    X,
    Y,
    Z,
)
from moyai.flexible.explicit_types import Blocks, Panels, Rings, Sheets
from moyai.flexible.mass_block_kernel import STALE, block_energy, block_loads, kick_blocks, refresh_inverse, set_frames
from moyai.flexible.panel_kernel import screen_loads
from moyai.flexible.ring_kernel import ring_loads
from moyai.flexible.sheet_kernel import PRESSURE, pressure_forces, sheet_energy
from moyai.flexible.sheet_lanes import sheet_forces


@njit(cache=True, error_model="numpy")
def kick_sections(A: Array, blocks: Blocks, push: float, level: float) -> None:
    """Advance the velocities of the nodes of dense mass blocks; the rows of the new load hold their forces meanwhile.

    Their own inverse blocks are zero, so that the kick of all nodes passes them by.
    """
    if blocks is None:
        return
    nodes, _, frames, _, inverse, along, own, _, _, room = blocks
    for g in range(nodes.shape[0]):
        for i in range(nodes.shape[1]):
            node = nodes[g, i] & PLAIN
            for axis in range(3):
                row = axis * ROW + node
                A[QX + row] = A[TX + row] + A[FX + row] - A[FX + row - 1]
    kick_blocks(nodes, frames, inverse, along, own, A, U, QX, ROW, X, push, level, STIFF, DAMP, FREE_X, room)


@njit(cache=True, error_model="numpy")
def section_loads(A: Array, blocks: Blocks, moving: bool) -> None:
    """Turn the frames of dense mass blocks, add their loads, and take their nodes out of the kick of all nodes."""
    if blocks is None:
        return
    nodes, guides, frames, added, inverse, _, own, whole, light, room = blocks
    set_frames(nodes, guides, frames, A, X, ROW, whole)
    refresh_inverse(nodes, frames, added, inverse, own, A, FREE_X, ROW, STALE, room)
    block_loads(nodes, guides, frames, added, A, U, WU, QX, ROW, moving, whole, room)
    for g in range(nodes.shape[0]):
        for i in range(nodes.shape[1]):
            node = nodes[g, i] & PLAIN
            for row in range(6):
                A[IXX + row * ROW + node] = 0.0
                A[MXX + row * ROW + node] = 0.0
            A[MXX + node] = A[MYY + node] = A[MZZ + node] = own[g, i]
            light[2, node], light[3, node] = frames[g, i, 1], -frames[g, i, 0]


@njit(cache=True, error_model="numpy")
def section_energy(A: Array, blocks: Blocks) -> float:
    """Return the kinetic energy of the water of the blocks [J]."""
    if blocks is None:
        return 0.0
    return block_energy(blocks[0], blocks[2], blocks[3], A, U, ROW, blocks[9])


@njit(cache=True, error_model="numpy")
def screens(
    A: Array, count: int, panels: Panels, half_density: float, ahead: float, step: float, due: bool, speeds: Array,
    onward: float,
) -> float:  # fmt: skip
    """Write the loads of net panels as R - C velocity and inverse mass blocks that hold half a step of C.

    The step then takes the damping at the mean of its velocities, so that light nets in fast water require no shorter
    step [eq:cage-panel-implicit]. R and C are found where they are ``due``, for an interval ``ahead``; ``speeds`` and
    ``onward`` as in :func:`moyai.flexible.panel_kernel.screen_loads`. Returns the fastest rate at which panels damp a
    node then [1/s].
    """
    rate = 0.0
    if panels is None:
        return rate
    system, screen = panels
    if due:
        x, y, z, u, v, w = A[X : X + count], A[Y : Y + count], A[Z:], A[U : U + count], A[V : V + count], A[W:]
        screen_loads(
            x, y, z, u, v, w, A[WU:], A[WV:], A[WW:], A[WA:], A[WB:], A[WC:], A[ETA:], system, half_density, ahead,
            screen, speeds, onward,
        )  # fmt: skip
        for i in range(screen.shape[1]):
            mass = A[MXX + i] + A[MYY + i] + A[MZZ + i]
            rate = max(rate, (screen[0, i] + screen[3, i] + screen[5, i]) / mass)
    half = 0.5 * step
    for row in range(6):
        for i in range(screen.shape[1]):
            A[MXX + row * ROW + i] += half * screen[row, i]
    invert_blocks(A, count)
    for row in range(6):
        for i in range(screen.shape[1]):
            A[MXX + row * ROW + i] -= half * screen[row, i]
    return rate


@njit(cache=True, error_model="numpy")
def room_for_speeds(panels: Panels) -> Any:
    """Return room for the relative speeds of all panels."""
    if panels is None:
        return np.zeros(0)
    return np.zeros(panels[0][0].shape[0])


@njit(cache=True, error_model="numpy", fastmath=FAST)
def screen_forces(A: Array, panels: Panels) -> None:
    """Add the forces of the panels at the present velocity to the total and keep that velocity."""
    if panels is None:
        return
    screen = panels[1]
    for i in range(screen.shape[1]):
        u, v, w = A[U + i], A[V + i], A[W + i]
        screen[9, i], screen[10, i], screen[11, i] = u, v, w
        A[TX + i] += screen[6, i] - screen[0, i] * u - screen[1, i] * v - screen[2, i] * w
        A[TY + i] += screen[7, i] - screen[1, i] * u - screen[3, i] * v - screen[4, i] * w
        A[TZ + i] += screen[8, i] - screen[2, i] * u - screen[4, i] * v - screen[5, i] * w


@njit(cache=True, error_model="numpy", fastmath=FAST)
def screen_work(A: Array, panels: Panels, time: float) -> float:
    """Return the work of the panels over the last kick of ``time``, at the mean of the velocities around it [J]."""
    if panels is None:
        return 0.0
    screen, work = panels[1], 0.0
    for i in range(screen.shape[1]):
        u, v, w = 0.5 * (A[U + i] + screen[9, i]), 0.5 * (A[V + i] + screen[10, i]), 0.5 * (A[W + i] + screen[11, i])
        work += u * (screen[6, i] - screen[0, i] * u - screen[1, i] * v - screen[2, i] * w)
        work += v * (screen[7, i] - screen[1, i] * u - screen[3, i] * v - screen[4, i] * w)
        work += w * (screen[8, i] - screen[2, i] * u - screen[4, i] * v - screen[5, i] * w)
    return time * work


@njit(cache=True, error_model="numpy")
def add_sheet_forces(A: Array, sheets: Sheets) -> None:
    """Add the stresses of sheets to the total of the nodes."""
    if sheets is None:
        return
    _, triangles, _, _, peak, packed, room, which = sheets
    sheet_forces(A, triangles, packed, room, which, peak)


@njit(cache=True, error_model="numpy")
def elastic_energy_of_sheets(A: Array, sheets: Sheets) -> float:
    """Return the energy of the stresses of sheets [J]."""
    if sheets is None:
        return 0.0
    return sheet_energy(sheets[0], sheets[1], A, X, 1, ROW)


@njit(cache=True, error_model="numpy")
def pressure_work(A: Array, count: int, sheets: Sheets, push: Any) -> float:
    """Return half the work of pressure along the way since the last look, with the push then and with that of now.

    ``push`` (6, n) holds that push and the places then; those of now take their place. Of no nodes, there is no work.
    """
    if sheets is None:
        return 0.0
    work = 0.0
    if push.shape[1] == 0:
        return work
    for turn in range(2):
        for axis in range(3):
            for i in range(count):
                gone = A[X + axis * ROW + i] - push[3 + axis, i]
                work += 0.5 * A[FREE_X + axis * ROW + i] * push[axis, i] * gone
        if turn == 0:
            pressure_forces(sheets[0], sheets[1], A, X, ROW, push[:3])
    for axis in range(3):
        for i in range(count):
            push[3 + axis, i] = A[X + axis * ROW + i]
    return work


@njit(cache=True, error_model="numpy")
def first_push(A: Array, count: int, sheets: Sheets) -> Any:
    """Return the push of pressure on sheets and the places now (6, n), of no nodes where nothing is under pressure."""
    push = np.zeros((6, 0))
    if sheets is None:
        return push
    if np.any(sheets[0][:, PRESSURE] != 0.0):
        push = np.zeros((6, count))
        # the places of now; there is no way yet
        pressure_work(A, count, sheets, push)
    return push


@njit(cache=True, error_model="numpy")
def add_ring_forces(A: Array, rings: Rings) -> None:
    """Add the forces of rings to the total of the nodes."""
    if rings is None:
        return
    ring_loads(A[X:], A[Y:], A[Z:], rings[0], A[TX:], A[TY:], A[TZ:], rings[1])


@njit(cache=True, error_model="numpy")
def ring_energy(A: Array, rings: Rings) -> float:
    """Return the energy of rings [J]."""
    if rings is None:
        return 0.0
    system, moments, spare = rings
    return ring_loads(A[X:], A[Y:], A[Z:], system, spare[0], spare[1], spare[2], moments)


@njit(cache=True, error_model="numpy")
def has_further_forces(panels: Panels, rings: Rings, sheets: Sheets) -> bool:
    """Whether anything but bars and hinges pulls at the nodes."""
    return not (panels is None and rings is None and sheets is None)
