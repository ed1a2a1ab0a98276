"""Compiled kernels of the explicit scheme: bar forces every step, loads of water and weight every few steps.

Central differences in leapfrog form [eq:flexible-leapfrog]. Everything lies in one array whose rows are ``ROW``
apart, a
constant: the compiler then knows that rows do not overlap and turns every loop into vector instructions, also for
lines of a dozen bars. ``ROW`` is no power of two, so that rows fall on different lines of the cache.

Bars between neighbours in memory form the *spine*: bar i joins nodes i and i + 1, and gaps hold bars without
stiffness. All
others are *ribs*, in runs (a, b, first, count, curve): rib first + i joins nodes a + i and b + i. Of a rib the same
rows hold its constants, shifted by ``RIB``.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from moyai.core.compiled import njit
from moyai.flexible.mass_block_kernel import STALE, block_energy, block_loads, kick_blocks, refresh_inverse, set_frames
from moyai.flexible.panel_kernel import screen_loads
from moyai.flexible.ring_kernel import ring_loads
from moyai.flexible.sheet_kernel import (
    PRESSURE,
    pressure_forces,
    sheet_added_mass,
    sheet_energy,
    sheet_forces,
    sheet_loads,
)

#: Which re-orderings the compiler may make: none that assumes the absence of NaN, which marks a blow-up.
FAST: Any = {"contract", "arcp", "nsz", "reassoc"}

#: Keeps the direction of bars without stiffness finite where their nodes coincide.
TINY = 1e-200
#: Distance of rows; networks of up to about this many nodes fit. Memory that is not touched costs nothing.
ROW = 65536 + 24
#: Rows by name. Nodes: position, velocity, force in use, new load, load before, inverse mass, mass block.
X, Y, Z, U, V, W = 0 * ROW, 1 * ROW, 2 * ROW, 3 * ROW, 4 * ROW, 5 * ROW
PX, PY, PZ, QX, QY, QZ = 6 * ROW, 7 * ROW, 8 * ROW, 9 * ROW, 10 * ROW, 11 * ROW
BX, BY, BZ = 12 * ROW, 13 * ROW, 14 * ROW
IXX, IXY, IXZ, IYY, IYZ, IZZ = 15 * ROW, 16 * ROW, 17 * ROW, 18 * ROW, 19 * ROW, 20 * ROW
MXX, MXY, MXZ, MYY, MYZ, MZZ = 21 * ROW, 22 * ROW, 23 * ROW, 24 * ROW, 25 * ROW, 26 * ROW
#: Nodes: what does not change, and the water (velocity, acceleration, elevation).
MASS, WEIGHT, VOLUME, DRAG, ADDED, STIFF, DAMP, HEIGHT, FORM = (row * ROW for row in range(27, 36))
FREE_X, FREE_Y, FREE_Z = 36 * ROW, 37 * ROW, 38 * ROW
WU, WV, WW, WA, WB, WC, ETA = (row * ROW for row in range(39, 46))
TX, TY, TZ = 46 * ROW, 47 * ROW, 48 * ROW
#: Bars: constants, force on the first node, tension, its highest value, loads of the water on both ends, added mass.
LENGTH, SPRING, VISCOUS, LIMIT, ACROSS, SKIN, CROSS, ALONG, LIFT, SHARE, RADIUS, LIGHT, DISPLACED = (
    row * ROW for row in range(49, 62)
)
FX, FY, FZ, PULL, PEAK, WET, RATE = (row * ROW for row in range(62, 69))
AX, AY, AZ, EX, EY, EZ = (row * ROW for row in range(69, 75))
DXX, DXY, DXZ, DYY, DYZ, DZZ = (row * ROW for row in range(75, 81))
#: Difference of the lifts of both ends of a bar that crosses the surface, over the whole.
LEAN = 81 * ROW
ROWS_OF_NODES, ROWS = 49, 82
#: Length of the ledger of a run; behind it stand, for each driven point, the impulse of the network on it (three
#: numbers, N s) and the moment of that impulse about the start of the call (three numbers, N s2).
LEDGER = 6
#: Ribs repeat the rows of bars, from here on.
RIB = (ROWS - ROWS_OF_NODES) * ROW
TOTAL_ROWS = ROWS + ROWS - ROWS_OF_NODES


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


@njit(cache=True, error_model="numpy", fastmath=FAST)
def kick_and_drift(A: Any, count: int, push: float, move: float) -> None:
    """Advance velocities by ``push`` times inverse mass times force, positions by ``move`` times velocity.

    The element before the first of a force row belongs to the unused end of another row and is zero.
    """
    for i in range(count):
        fx = push * (A[TX + i] + A[FX + i] - A[FX + i - 1])
        fy = push * (A[TY + i] + A[FY + i] - A[FY + i - 1])
        fz = push * (A[TZ + i] + A[FZ + i] - A[FZ + i - 1])
        u = A[U + i] + A[IXX + i] * fx + A[IXY + i] * fy + A[IXZ + i] * fz
        v = A[V + i] + A[IXY + i] * fx + A[IYY + i] * fy + A[IYZ + i] * fz
        w = A[W + i] + A[IXZ + i] * fx + A[IYZ + i] * fy + A[IZZ + i] * fz
        A[U + i], A[V + i], A[W + i] = u, v, w
        A[X + i] += move * u
        A[Y + i] += move * v
        A[Z + i] += move * w


@njit(cache=True, error_model="numpy", fastmath=FAST)
def kick_contact_and_drift(A: Any, count: int, level: float, time: float, move: float) -> None:
    """Do what :func:`kick_and_drift` does, with the impulses of a smooth bed in between.

    Implicit spring and dashpot [eq:flexible-bed], without branches, for whole vectors.
    """
    for i in range(count):
        share = A[IZZ + i]
        fx = time * (A[TX + i] + A[FX + i] - A[FX + i - 1])
        fy = time * (A[TY + i] + A[FY + i] - A[FY + i - 1])
        fz = time * (A[TZ + i] + A[FZ + i] - A[FZ + i - 1])
        u = A[U + i] + A[IXX + i] * fx + A[IXY + i] * fy + A[IXZ + i] * fz
        v = A[V + i] + A[IXY + i] * fx + A[IYY + i] * fy + A[IYZ + i] * fz
        w = A[W + i] + A[IXZ + i] * fx + A[IYZ + i] * fy + share * fz
        depth = level - A[Z + i]
        # depth - time w replaces depth: a stiff bed then needs no smaller step
        grip = A[STIFF + i] * time + A[DAMP + i]
        push = time * (A[STIFF + i] * depth - grip * w) / (1.0 + time * grip * share)
        # contact is told by where the node would end: a hard bed stops it at its face instead of throwing it back
        push = push if depth > time * w else 0.0
        push = push if push > 0.0 else 0.0
        u += A[IXZ + i] * push
        v += A[IYZ + i] * push
        w += share * push
        A[U + i], A[V + i], A[W + i] = u, v, w
        A[X + i] += move * u
        A[Y + i] += move * v
        A[Z + i] += move * w


@njit(cache=True, error_model="numpy", fastmath=FAST)
def kick_rub_and_drift(A: Any, count: int, level: float, friction: float, time: float, move: float) -> None:
    """Do the same on a rough bed: Coulomb friction that sticks.

    The body is repeated from :func:`kick_contact_and_drift`: a shared function in the loop would hinder the compiler,
    and the
    roots and divisions of friction cost as much as all the rest.
    """
    for i in range(count):
        share = A[IZZ + i]
        fx = time * (A[TX + i] + A[FX + i] - A[FX + i - 1])
        fy = time * (A[TY + i] + A[FY + i] - A[FY + i - 1])
        fz = time * (A[TZ + i] + A[FZ + i] - A[FZ + i - 1])
        u = A[U + i] + A[IXX + i] * fx + A[IXY + i] * fy + A[IXZ + i] * fz
        v = A[V + i] + A[IXY + i] * fx + A[IYY + i] * fy + A[IYZ + i] * fz
        w = A[W + i] + A[IXZ + i] * fx + A[IYZ + i] * fy + share * fz
        depth = level - A[Z + i]
        # depth - time w replaces depth: a stiff bed then needs no smaller step
        grip = A[STIFF + i] * time + A[DAMP + i]
        push = time * (A[STIFF + i] * depth - grip * w) / (1.0 + time * grip * share)
        # contact is told by where the node would end: a hard bed stops it at its face instead of throwing it back
        push = push if depth > time * w else 0.0
        push = push if push > 0.0 else 0.0
        u += A[IXZ + i] * push
        v += A[IYZ + i] * push
        w += share * push
        light = A[IXX + i] if A[IXX + i] > A[IYY + i] else A[IYY + i]
        # the impulse that stops the node, or the one that friction can give
        speed, bound = math.sqrt(u * u + v * v) + TINY, friction * push
        stop = speed / (light + TINY)
        hold = (stop if stop < bound else bound) / speed
        px, py = hold * u, hold * v
        u, v = u - A[IXX + i] * px - A[IXY + i] * py, v - A[IXY + i] * px - A[IYY + i] * py
        A[U + i], A[V + i], A[W + i] = u, v, w
        A[X + i] += move * u
        A[Y + i] += move * v
        A[Z + i] += move * w


@njit(cache=True, error_model="numpy", fastmath=FAST)
def drive(A: Any, driven: Any, rest: Any, tables: Any, start: float, step: float, now: float, time: float) -> None:
    """Put driven nodes at their place at ``now``; their velocity is the mean over the last ``time``."""
    last = tables.shape[1] - 1
    place = (now - start) / step
    row = int(place)
    row = 0 if row < 0 else (last - 1 if row > last - 1 else row)
    s = place - row
    # cubic through displacement and velocity at both ends of the interval
    h1 = s * s * (3.0 - 2.0 * s)
    h2, h3 = s * (1.0 - s) * (1.0 - s) * step, s * s * (s - 1.0) * step
    per = 1.0 / time if time > 0.0 else 0.0
    for d in range(driven.shape[0]):
        node, table = driven[d, 0], driven[d, 1]
        for axis in range(3):
            p0, p1 = tables[table, row, axis], tables[table, row + 1, axis]
            v0, v1 = tables[table, row, 3 + axis], tables[table, row + 1, 3 + axis]
            target = rest[d, axis] + p0 + h1 * (p1 - p0) + h2 * v0 + h3 * v1
            if time > 0.0:
                # The step has carried the node on with its last velocity already: what is missing corrects it
                A[U + axis * ROW + node] += (target - A[X + axis * ROW + node]) * per
            A[X + axis * ROW + node] = target


@njit(cache=True, error_model="numpy", fastmath=FAST)
def wetness(A: Any, a0: int, b0: int, k0: int, count: int) -> None:
    """Write immersed part and lean of the lift of bars, cut by the surface over them [eq:flexible-immersion]."""
    for i in range(count):
        a, b, k = a0 + i, b0 + i, k0 + i
        ha, hb = A[Z + a] - A[ETA + a], A[Z + b] - A[ETA + b]
        low = (ha if ha < hb else hb) - A[RADIUS + k]
        high = (hb if ha < hb else ha) + A[RADIUS + k]
        part = -low / (high - low)
        part = part if part < 1.0 else 1.0
        part = part if part > 0.0 else 0.0
        A[WET + k] = part
        A[LEAN + k] = part * (1.0 - part) * (hb - ha) / (high - low)


@njit(cache=True, error_model="numpy", fastmath=FAST)
def bar_loads(A: Any, a0: int, b0: int, k0: int, count: int, waves: bool, ahead: float) -> None:
    """Write the loads of the water on both ends of bars and their added mass, half for each end.

    Normal and tangential drag of the relative velocity at each end, buoyancy, and the inertia of the water
    [eq:flexible-morison]; ``RATE`` is the rate at which drag damps the lighter end, or at which the added mass turns
    [1/s]. Where the rate of drag times the interval ``ahead`` comes near 1, drag is held back so that its continuation
    stays stable [eq:flexible-drag-limit].
    """
    for i in range(count):
        a, b, k = a0 + i, b0 + i, k0 + i
        tx, ty, tz = A[X + b] - A[X + a], A[Y + b] - A[Y + a], A[Z + b] - A[Z + a]
        inverse = 1.0 / math.sqrt(tx * tx + ty * ty + tz * tz + TINY)
        tx, ty, tz = tx * inverse, ty * inverse, tz * inverse
        wet, share = A[WET + k], A[SHARE + k]
        across, skin, lift = wet * A[ACROSS + k], wet * A[SKIN + k], wet * A[LIFT + k]
        more, even = wet * (A[ALONG + k] - A[CROSS + k]), wet * A[CROSS + k]
        # inverse masses across and along: light bars take much more water along across themselves
        own = 1.0 / A[LIGHT + k] - A[CROSS + k]
        light, lighter = 1.0 / (own + even), 1.0 / (own + even + more)
        A[DXX + k] = even + more * tx * tx
        A[DXY + k] = more * tx * ty
        A[DXZ + k] = more * tx * tz
        A[DYY + k] = even + more * ty * ty
        A[DYZ + k] = more * ty * tz
        A[DZZ + k] = even + more * tz * tz
        ux, uy, uz = share * A[WU + a] - A[U + a], share * A[WV + a] - A[V + a], share * A[WW + a] - A[W + a]
        along = ux * tx + uy * ty + uz * tz
        ux, uy, uz = ux - along * tx, uy - along * ty, uz - along * tz
        size = across * math.sqrt(ux * ux + uy * uy + uz * uz)
        slide = skin * abs(along)
        fast = 2.0 * (size * light + slide * lighter)
        quick = ahead * fast
        held = 1.0 / (1.0 + 0.4 * quick * quick * quick * quick)
        size, slide = held * size, held * slide * along
        A[AX + k] = size * ux + slide * tx
        A[AY + k] = size * uy + slide * ty
        lean = A[LEAN + k] * A[LIFT + k]
        A[AZ + k] = size * uz + slide * tz + lift + lean
        ux, uy, uz = share * A[WU + b] - A[U + b], share * A[WV + b] - A[V + b], share * A[WW + b] - A[W + b]
        along = ux * tx + uy * ty + uz * tz
        ux, uy, uz = ux - along * tx, uy - along * ty, uz - along * tz
        other = across * math.sqrt(ux * ux + uy * uy + uz * uz)
        slide = skin * abs(along)
        faster = 2.0 * (other * light + slide * lighter)
        quick = ahead * faster
        held = 1.0 / (1.0 + 0.4 * quick * quick * quick * quick)
        other, slide = held * other, held * slide * along
        A[EX + k] = other * ux + slide * tx
        A[EY + k] = other * uy + slide * ty
        A[EZ + k] = other * uz + slide * tz + lift - lean
        # added mass that is held while its bar turns would give energy: thrice weighted, by its part of the inertia
        du, dv, dw = A[U + b] - A[U + a], A[V + b] - A[V + a], A[W + b] - A[W + a]
        along = du * tx + dv * ty + dw * tz
        square = du * du + dv * dv + dw * dw - along * along
        turn = math.sqrt(square if square > 0.0 else 0.0) * inverse * 3.0 * abs(more) * light
        drag = fast if fast > faster else faster
        A[RATE + k] = drag if drag > turn else turn
    if waves:
        for i in range(count):
            a, b, k = a0 + i, b0 + i, k0 + i
            whole = A[WET + k] * A[DISPLACED + k]
            xx, xy, xz, yy, yz, zz = A[DXX + k], A[DXY + k], A[DXZ + k], A[DYY + k], A[DYZ + k], A[DZZ + k]
            p, q, s = A[WA + a], A[WB + a], A[WC + a]
            A[AX + k] += whole * p + xx * p + xy * q + xz * s
            A[AY + k] += whole * q + xy * p + yy * q + yz * s
            A[AZ + k] += whole * s + xz * p + yz * q + zz * s
            p, q, s = A[WA + b], A[WB + b], A[WC + b]
            A[EX + k] += whole * p + xx * p + xy * q + xz * s
            A[EY + k] += whole * q + xy * p + yy * q + yz * s
            A[EZ + k] += whole * s + xz * p + yz * q + zz * s


@njit(cache=True, error_model="numpy", fastmath=FAST)
def node_loads(A: Any, count: int, spine: int) -> None:
    """Sum weight and the loads and added mass of the spine at the nodes."""
    for i in range(count):
        A[QX + i] = A[AX + i] + A[EX + i - 1]
        A[QY + i] = A[AY + i] + A[EY + i - 1]
        A[QZ + i] = A[AZ + i] + A[EZ + i - 1] - A[WEIGHT + i]
    for i in range(count):
        A[MXX + i] = A[MASS + i] + A[DXX + i] + A[DXX + i - 1]
        A[MXY + i] = A[DXY + i] + A[DXY + i - 1]
        A[MXZ + i] = A[DXZ + i] + A[DXZ + i - 1]
        A[MYY + i] = A[MASS + i] + A[DYY + i] + A[DYY + i - 1]
        A[MYZ + i] = A[DYZ + i] + A[DYZ + i - 1]
        A[MZZ + i] = A[MASS + i] + A[DZZ + i] + A[DZZ + i - 1]


@njit(cache=True, error_model="numpy", fastmath=FAST)
def add_ribs(A: Any, runs: Any) -> None:
    """Add the loads and added mass of the ribs to their nodes."""
    for r in range(runs.shape[0]):
        a0, b0, k0, count = runs[r, 0], runs[r, 1], RIB + runs[r, 2], runs[r, 3]
        for axis in range(3):
            node, one, two = QX + axis * ROW, AX + axis * ROW + k0, EX + axis * ROW + k0
            for i in range(count):
                A[node + a0 + i] += A[one + i]
            for i in range(count):
                A[node + b0 + i] += A[two + i]
        for row in range(6):
            node, bar = MXX + row * ROW, DXX + row * ROW + k0
            for i in range(count):
                A[node + a0 + i] += A[bar + i]
            for i in range(count):
                A[node + b0 + i] += A[bar + i]


@njit(cache=True, error_model="numpy")
def attached_loads(A: Any, attached: Any, rho: float, gravity: float, ahead: float) -> None:
    """Add the loads on attached floats and weights, partly immersed [eq:flexible-immersion], and their added mass."""
    for n in range(attached.size):
        i = attached[n]
        part = 1.0
        if A[HEIGHT + i] > 0.0:
            part = min(max(0.5 - (A[Z + i] - A[ETA + i]) / A[HEIGHT + i], 0.0), 1.0)
            if A[FORM + i] == 1.0:
                part = part * part * (3.0 - 2.0 * part)
        ux, uy, uz = A[WU + i] - A[U + i], A[WV + i] - A[V + i], A[WW + i] - A[W + i]
        size = part * A[DRAG + i] * math.sqrt(ux * ux + uy * uy + uz * uz)
        quick = 2.0 * ahead * size / (A[MASS + i] + part * A[ADDED + i])
        size /= 1.0 + 0.4 * quick * quick * quick * quick
        inertia = part * (A[ADDED + i] + rho * A[VOLUME + i])
        A[QX + i] += size * ux + inertia * A[WA + i]
        A[QY + i] += size * uy + inertia * A[WB + i]
        A[QZ + i] += size * uz + inertia * A[WC + i] + part * rho * gravity * A[VOLUME + i]
        more = part * A[ADDED + i]
        A[MXX + i] += more
        A[MYY + i] += more
        A[MZZ + i] += more


@njit(cache=True, error_model="numpy", fastmath=FAST)
def invert_blocks(A: Any, count: int) -> None:
    """Invert the symmetric mass blocks; components that are held get rows and columns of zero."""
    for i in range(count):
        mx, my, mz = A[FREE_X + i], A[FREE_Y + i], A[FREE_Z + i]
        # a held component loses its coupling before and its own term after the inversion
        a, b, c = A[MXX + i], A[MXY + i] * mx * my, A[MXZ + i] * mx * mz
        d, e, f = A[MYY + i], A[MYZ + i] * my * mz, A[MZZ + i]
        p, q, s = d * f - e * e, c * e - b * f, b * e - c * d
        whole = 1.0 / (a * p + b * q + c * s)
        A[IXX + i] = mx * p * whole
        A[IXY + i] = mx * my * q * whole
        A[IXZ + i] = mx * mz * s * whole
        A[IYY + i] = my * (a * f - c * c) * whole
        A[IYZ + i] = my * mz * (b * c - a * e) * whole
        A[IZZ + i] = mz * (a * d - b * b) * whole


@njit(cache=True, error_model="numpy")
def kick_sections(A: Any, blocks: Any, push: float, level: float) -> None:
    """Advance the velocities of the nodes of dense mass blocks; the rows of the new load hold their forces meanwhile.

    Their own inverse blocks are zero, so that the kick of all nodes passes them by.
    """
    nodes, _, frames, _, inverse, along, own, _ = blocks
    for g in range(nodes.shape[0]):
        for i in range(nodes.shape[1]):
            node = nodes[g, i]
            for axis in range(3):
                row = axis * ROW + node
                A[QX + row] = A[TX + row] + A[FX + row] - A[FX + row - 1]
    kick_blocks(nodes, frames, inverse, along, own, A, U, QX, ROW, X, push, level, STIFF, DAMP, FREE_X)


@njit(cache=True, error_model="numpy")
def section_loads(A: Any, blocks: Any, moving: bool, light: Any) -> None:
    """Turn the frames of dense mass blocks, add their loads, and take their nodes out of the kick of all nodes."""
    nodes, guides, frames, added, inverse, _, own, whole = blocks
    set_frames(nodes, guides, frames, A, X, ROW, whole)
    refresh_inverse(nodes, frames, added, inverse, own, A, FREE_X, ROW, STALE)
    block_loads(nodes, guides, frames, added, A, U, WU, QX, ROW, moving, whole)
    for g in range(nodes.shape[0]):
        for i in range(nodes.shape[1]):
            node = nodes[g, i]
            for row in range(6):
                A[IXX + row * ROW + node] = 0.0
                A[MXX + row * ROW + node] = 0.0
            A[MXX + node] = A[MYY + node] = A[MZZ + node] = own[g, i]
            light[2, node], light[3, node] = frames[g, i, 1], -frames[g, i, 0]


@njit(cache=True, error_model="numpy")
def loads(
    A: Any, sizes: Any, runs: Any, attached: Any, rho: float, gravity: float, surface: bool, waves: bool, ahead: float,
    sheets: Any,
) -> None:  # fmt: skip
    """Write weight, buoyancy, drag and inertia of the water at every node, and the inverse mass blocks."""
    count, spine = sizes[0], sizes[1]
    if surface:
        wetness(A, 0, 1, 0, spine)
        for r in range(runs.shape[0]):
            wetness(A, runs[r, 0], runs[r, 1], RIB + runs[r, 2], runs[r, 3])
    bar_loads(A, 0, 1, 0, spine, waves, ahead)
    node_loads(A, count, spine)
    if runs.shape[0] > 0:
        for r in range(runs.shape[0]):
            bar_loads(A, runs[r, 0], runs[r, 1], RIB + runs[r, 2], runs[r, 3], waves, ahead)
        add_ribs(A, runs)
    if attached.size > 0:
        attached_loads(A, attached, rho, gravity, ahead)
    table, triangles, light, gauge, _ = sheets
    if triangles.shape[0] > 0:
        gauge[0] = sheet_loads(table, triangles, A, X, A, U, A, WU, A, QX, 1, ROW, light, ahead)
        sheet_added_mass(table, triangles, A, X, 1, ROW, A, WU, 1, ROW, A, MXX, 1, ROW)
    invert_blocks(A, count)


@njit(cache=True, error_model="numpy")
def screens(A: Any, count: int, panels: Any, half_density: float, screen: Any, ahead: float, step: float) -> None:
    """Write the loads of net panels as R - C velocity and inverse mass blocks that hold half a step of C.

    The step then takes the damping at the mean of its velocities, so that light nets in fast water ask for no shorter
    step [eq:cage-panel-implicit].
    """
    x, y, z, u, v, w = A[X : X + count], A[Y : Y + count], A[Z : Z + count], A[U : U + count], A[V : V + count], A[W:]
    screen_loads(
        x, y, z, u, v, w, A[WU:], A[WV:], A[WW:], A[WA:], A[WB:], A[WC:], A[ETA:], panels, half_density, ahead, screen
    )
    half = 0.5 * step
    for row in range(6):
        for i in range(screen.shape[1]):
            A[MXX + row * ROW + i] += half * screen[row, i]
    invert_blocks(A, count)
    for row in range(6):
        for i in range(screen.shape[1]):
            A[MXX + row * ROW + i] -= half * screen[row, i]


@njit(cache=True, error_model="numpy", fastmath=FAST)
def screen_forces(A: Any, screen: Any) -> None:
    """Add the forces of the panels at the present velocity to the total and keep that velocity."""
    for i in range(screen.shape[1]):
        u, v, w = A[U + i], A[V + i], A[W + i]
        screen[9, i], screen[10, i], screen[11, i] = u, v, w
        A[TX + i] += screen[6, i] - screen[0, i] * u - screen[1, i] * v - screen[2, i] * w
        A[TY + i] += screen[7, i] - screen[1, i] * u - screen[3, i] * v - screen[4, i] * w
        A[TZ + i] += screen[8, i] - screen[2, i] * u - screen[4, i] * v - screen[5, i] * w


@njit(cache=True, error_model="numpy", fastmath=FAST)
def screen_work(A: Any, screen: Any, time: float) -> float:
    """Return the work of the panels over the last kick of ``time``, at the mean of the velocities around it [J]."""
    work = 0.0
    for i in range(screen.shape[1]):
        u, v, w = 0.5 * (A[U + i] + screen[9, i]), 0.5 * (A[V + i] + screen[10, i]), 0.5 * (A[W + i] + screen[11, i])
        work += u * (screen[6, i] - screen[0, i] * u - screen[1, i] * v - screen[2, i] * w)
        work += v * (screen[7, i] - screen[1, i] * u - screen[3, i] * v - screen[4, i] * w)
        work += w * (screen[8, i] - screen[2, i] * u - screen[4, i] * v - screen[5, i] * w)
    return time * work


@njit(cache=True, error_model="numpy", fastmath=FAST)
def extrapolate(A: Any, count: int, ahead: float) -> None:
    """Take the loads in the middle of the coming interval: straight continuation of the last two.

    ``ahead`` is half the coming interval over the one before.
    """
    for i in range(count):
        A[PX + i] = A[QX + i] + ahead * (A[QX + i] - A[BX + i])
        A[PY + i] = A[QY + i] + ahead * (A[QY + i] - A[BY + i])
        A[PZ + i] = A[QZ + i] + ahead * (A[QZ + i] - A[BZ + i])
        A[BX + i], A[BY + i], A[BZ + i] = A[QX + i], A[QY + i], A[QZ + i]
    for i in range(count):
        A[TX + i], A[TY + i], A[TZ + i] = A[PX + i], A[PY + i], A[PZ + i]


@njit(cache=True, error_model="numpy")
def rate_of_drag(A: Any, spine: int, runs: Any, attached: Any, gauge: float) -> float:
    """Return the fastest rate at which drag damps any node, at the last evaluation of the loads [1/s]."""
    rate = gauge
    for i in range(spine):
        rate = max(rate, A[RATE + i])
    for r in range(runs.shape[0]):
        first = RATE + RIB + runs[r, 2]
        for i in range(runs[r, 3]):
            rate = max(rate, A[first + i])
    for n in range(attached.size):
        i = attached[n]
        u, v, w = A[WU + i] - A[U + i], A[WV + i] - A[V + i], A[WW + i] - A[W + i]
        size = 2.0 * A[DRAG + i] * math.sqrt(u * u + v * v + w * w)
        rate = max(rate, size / (A[MASS + i] + A[ADDED + i]))
    return rate


@njit(cache=True, error_model="numpy", fastmath=FAST)
def kinetic_energy(A: Any, count: int) -> float:
    """Return the kinetic energy of what is free, with its added mass [J]."""
    kinetic = 0.0
    for i in range(count):
        u, v, w = A[FREE_X + i] * A[U + i], A[FREE_Y + i] * A[V + i], A[FREE_Z + i] * A[W + i]
        kinetic += 0.5 * (A[MXX + i] * u * u + A[MYY + i] * v * v + A[MZZ + i] * w * w)
        kinetic += A[MXY + i] * u * v + A[MXZ + i] * u * w + A[MYZ + i] * v * w
    return kinetic


@njit(cache=True, error_model="numpy")
def elastic_energy(A: Any, sizes: Any, runs: Any, curves: Any, hinges: Any, stiffness: Any, level: float) -> float:
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
    for i in range(sizes[0]):
        depth = level - A[Z + i]
        if depth > 0.0 and A[FREE_Z + i] > 0.0:
            elastic += 0.5 * A[STIFF + i] * depth * depth
    return elastic


@njit(cache=True, error_model="numpy")
def _touching(A: Any, count: int, level: float, ahead: float) -> bool:
    """Whether a free node can reach the bed within ``ahead`` seconds at twice the greatest vertical speed."""
    fastest, lowest = 0.0, math.inf
    for i in range(count):
        fastest = max(fastest, abs(A[W + i]))
        lowest = min(lowest, A[Z + i] if A[FREE_Z + i] > 0.0 else math.inf)
    return lowest - 2.0 * ahead * fastest < level + 1e-3


@njit(cache=True, error_model="numpy")
def _node_force(A: Any, node: int, axis: int) -> float:
    """Return the force of bars and hinges on a node (without the loads)."""
    row = axis * ROW + node
    return A[TX + row] - A[PX + row] + A[FX + row] - A[FX + row - 1]


@njit(cache=True, error_model="numpy", fastmath=FAST)
def _load_work(A: Any, count: int, sign: float) -> float:
    """Return the sum of load times position over what is free."""
    work = 0.0
    for i in range(count):
        work += A[FREE_X + i] * A[PX + i] * A[X + i] + A[FREE_Y + i] * A[PY + i] * A[Y + i]
        work += A[FREE_Z + i] * A[PZ + i] * A[Z + i]
    return sign * work


@njit(cache=True, error_model="numpy")
def _pressure_work(A: Any, count: int, table: Any, triangles: Any, push: Any) -> float:
    """Return half the work of pressure along the way since the last look, with the push then and with that of now.

    ``push`` (6, n) holds that push and the places then; those of now take their place.
    """
    work = 0.0
    for turn in range(2):
        for axis in range(3):
            for i in range(count):
                gone = A[X + axis * ROW + i] - push[3 + axis, i]
                work += 0.5 * A[FREE_X + axis * ROW + i] * push[axis, i] * gone
        if turn == 0:
            pressure_forces(table, triangles, A, X, ROW, push[:3])
    for axis in range(3):
        for i in range(count):
            push[3 + axis, i] = A[X + axis * ROW + i]
    return work


@njit(cache=True, error_model="numpy")
def survey(
    A: Any, count: int, arrays: Any, start: Any, end: Any, place: Any, water: Any, gauge: float, drive: float,
    lift: float, reach: float, ahead: float, inverse: Any,
) -> tuple[float, bool]:  # fmt: skip
    """Return the rate that bounds the load interval and whether a bar may cross the surface; write inverse masses.

    The rate is the fastest at which drag damps or floats bob, thrice weighted, anywhere [1/s]; ``drive`` is the
    greatest speed of what drives the network, which the bars may not have yet, ``lift`` density times gravity. The
    surface is near when a node may reach it within ``ahead`` seconds, 5 m/s faster than twice the present speed.
    ``inverse`` (6, n) becomes the inverse mass blocks, without added mass for what may fall dry.
    """
    nodes, bars = arrays
    rate, top, low, fastest, thickest = gauge, -math.inf, math.inf, drive, 0.0
    for i in range(count):
        top = max(top, A[Z + i])
        low = min(low, water[6, i])
        fastest = max(fastest, abs(A[W + i]))
        u, v, w = water[0, i] - A[U + i], water[1, i] - A[V + i], water[2, i] - A[W + i]
        speed = math.sqrt(u * u + v * v + w * w)
        rate = max(rate, 2.0 * nodes[3, i] * speed / (nodes[0, i] + nodes[4, i]))
        if nodes[7, i] > 0.0:
            rate = max(rate, 3.0 * math.sqrt(1.5 * lift * nodes[2, i] / nodes[7, i] / nodes[0, i]))
    for k in range(start.size):
        thickest = max(thickest, bars[10, k])
    near = top + thickest > low - reach - ahead * (2.0 * fastest + 5.0)
    bobs = top + thickest > low - reach
    for k in range(start.size):
        rate = max(rate, A[RATE + place[k]], drive * 2.0 * bars[4, k] * bars[11, k])
        za, zb = A[Z + start[k]], A[Z + end[k]]
        if bobs and max(za, zb) > low - 1.0:
            # a bar that crosses the surface steeply bobs over its height, a floating one over its diameter
            flat = bars[10, k] / (bars[10, k] + 0.5 * abs(za - zb))
            rate = max(rate, 3.0 * math.sqrt(bars[8, k] / bars[10, k] * bars[11, k] * flat))
    for i in range(count):
        dry = A[Z + i] > low - reach
        for row in range(6):
            inverse[row, i] = 0.0 if dry else A[IXX + row * ROW + i]
        if dry:
            inverse[0, i], inverse[3, i] = nodes[9, i] / nodes[0, i], nodes[10, i] / nodes[0, i]
            inverse[5, i] = nodes[11, i] / nodes[0, i]
    return rate, near


@njit(cache=True, error_model="numpy")
def read_gauges(A: Any, bars: Any, gauges: Any) -> None:
    """Keep the highest rise of the tension of some bars within two blocks of steps, and their highest tension.

    A gauge holds: lowest tension in the block before, in this block, steps of this block, steps of a block, highest
    rise, highest tension.
    """
    for g in range(bars.size):
        pull = A[PULL + bars[g]]
        gauges[g, 1] = min(gauges[g, 1], pull)
        gauges[g, 4] = max(gauges[g, 4], pull - min(gauges[g, 0], gauges[g, 1]))
        gauges[g, 5] = max(gauges[g, 5], pull)
        gauges[g, 2] += 1.0
        if gauges[g, 2] >= gauges[g, 3]:
            gauges[g, 0], gauges[g, 1], gauges[g, 2] = gauges[g, 1], pull, 0.0


@njit(cache=True, error_model="numpy")
def note_landings(A: Any, level: float, falls: Any) -> None:
    """Keep the highest speed with which each node came down on the bed [eq:flexible-landing].

    ``falls`` (2, n) holds the speed down of what is over the bed, and the highest at a landing.
    """
    for i in range(falls.shape[1]):
        if A[Z + i] > level:
            falls[0, i] = -A[W + i]
        elif falls[0, i] > 0.0:
            falls[1, i] = max(falls[1, i], falls[0, i])
            falls[0, i] = 0.0


@njit(cache=True, error_model="numpy", fastmath=FAST)
def march(
    A: Any, sizes: Any, runs: Any, curves: Any, hinges: Any, bending: Any, attached: Any, fluid: Any, waves: Any,
    driving: Any, bed: Any, timing: Any, ledger: Any, saved: Any, nets: Any, sheets: Any, blocks: Any, watch: Any,
) -> int:  # fmt: skip
    """Advance by whole rows of the result; the array ``A`` and the ledger change in place.

    ``waves`` is (water moves, part may be dry, water at the start (7, n), its rate, time of the start); ``timing`` is
    (time of the state, step, steps per load interval, load intervals per row, rows, first row, time of the row that is
    gone already). ``ledger`` holds: 0
    work of the loads, 1 work at driven points, 2 turn of the added mass, 3 the last load interval, 4 whether loads are
    known, 5 whether the velocities stand half a step behind, and from ``LEDGER`` on the impulses on driven points.
    ``saved`` is (position
    (rows, nodes, 3), tension (rows, bars), highest tension since the last row, energies and work (rows, 3), kept nodes,
    kept bars as places in ``A``). ``nets`` is (panels, their matrices (12, n), rings, their moments). ``watch`` is
    (bars with gauges, gauges, falls on the bed, steps done of a row that was broken off or -1, bounds of the rate of
    drag times the load interval and times the step). Returns the number of good rows, fewer than asked for when values
    are no longer finite, and negative when drag has outrun the step, which has to be chosen anew before the march goes
    on: at the end of that row, or within it, which then does not count as good.

    Load intervals shrink by themselves while drag is faster than at the start: loads that are held while nodes move to
    and fro would give them energy.
    """
    count, spine = sizes[0], sizes[1]
    driven, rest, tables, table_start, table_step = driving
    level, friction, has_bed = bed
    moving, surface, water, water_rate, water_time = waves
    start, step, per_load, per_row, rows, first_row, before = timing
    places, pulls, peaks, energy, keep_nodes, keep_bars = saved
    table, triangles, _, _, sheet_peak = sheets
    cloth, dense = triangles.shape[0] > 0, blocks[0].shape[0] > 0
    floor = level if has_bed else -1e300
    gauge_bars, gauges, falls, broken, most, bear = watch
    broken[0] = -1
    panels, screen, rings, ring_moments = nets
    screened, ringed = panels[0].shape[0] > 0, rings[0].size > 0
    pressed = cloth and np.any(table[:, PRESSURE] != 0.0)
    blown = np.zeros((6, count if pressed else 0))
    spare = np.zeros((3, screen.shape[1]))
    loose = runs.shape[0] > 0 or hinges.shape[0] > 0 or screened or ringed or cloth
    moved, drawn = np.zeros((driven.shape[0], 3)), np.zeros((driven.shape[0], 3))
    keep = np.empty((3, count))
    total = per_row * per_load
    rate = rate_of_drag(A, spine, runs, attached, sheets[3][0])
    if pressed:
        # the places of now; there is no way yet
        _pressure_work(A, count, table, triangles, blown)
    for row in range(rows):
        done = 0
        while done < total:
            # one step at first, then at most twice the interval before: what is let go soon flies fast
            size = min(per_load, total - done, max(1, int(2.0 * ledger[3] / step + 0.5)))
            if rate * step * size > most:
                size = max(1, int(most / (rate * step)))
            index = row * total + done
            now = start + index * step
            if moving:
                for r in range(7):
                    for i in range(water.shape[1]):
                        A[WU + r * ROW + i] = water[r, i] + (now - water_time) * water_rate[r, i]
            turning = kinetic_energy(A, count) + block_energy(blocks[0], blocks[2], blocks[3], A, U, ROW)
            loads(A, sizes, runs, attached, fluid[0], fluid[1], surface, moving, size * step, sheets)
            if screened:
                screens(A, count, panels, 0.5 * fluid[0], screen, size * step, step)
            rate = rate_of_drag(A, spine, runs, attached, sheets[3][0])
            if rate * step * size > 1.5 * most:
                size = max(1, int(most / (rate * step)))
            if dense:
                section_loads(A, blocks, moving, sheets[2])
            if ledger[4] == 0.0:
                for axis in range(3):
                    for i in range(count):
                        A[BX + axis * ROW + i] = A[QX + axis * ROW + i]
                ledger[3], ledger[4] = size * step, 1.0
            else:
                ledger[2] += kinetic_energy(A, count) - turning
                ledger[2] += block_energy(blocks[0], blocks[2], blocks[3], A, U, ROW)
            # beyond that the values are on their way to infinity: the end of the row says so
            if bear < rate * step < 1e4:
                broken[0] = done
                break
            extrapolate(A, count, min(0.5 * size * step / ledger[3], 1.0))
            ledger[3] = size * step
            ledger[0] += _load_work(A, count, -1.0)
            touching = has_bed and _touching(A, count, level, size * step)
            if touching:
                note_landings(A, level, falls)
            for inner in range(size):
                if loose:
                    for axis in range(3):
                        for i in range(count):
                            A[TX + axis * ROW + i] = A[PX + axis * ROW + i]
                    rib_forces(A, runs, curves)
                    bending_forces(A, hinges, bending)
                    if screened:
                        screen_forces(A, screen)
                    if cloth:
                        sheet_forces(table, triangles, A, X, A, U, A, TX, 1, ROW, sheet_peak)
                    if ringed:
                        ring_loads(A[X:], A[Y:], A[Z:], rings, A[TX:], A[TY:], A[TZ:], ring_moments)
                spine_forces(A, spine)
                read_gauges(A, gauge_bars, gauges)
                for d in range(driven.shape[0]):
                    node = driven[d, 0]
                    for axis in range(3):
                        # work against the bars, by the trapezoidal rule over the path
                        pull = -_node_force(A, node, axis)
                        ledger[1] += 0.5 * (pull + drawn[d, axis]) * moved[d, axis]
                        drawn[d, axis] = pull
                        moved[d, axis] = A[X + axis * ROW + node]
                        # impulse of bars (half a step at both ends of a row) and of loads, and its moment about start
                        share = (0.5 if done + inner == 0 else 1.0) * step
                        gone = before + (index + inner) * step
                        ledger[LEDGER + 6 * d + axis] += step * A[PX + axis * ROW + node] - share * pull
                        ledger[LEDGER + 6 * d + 3 + axis] += (
                            step * (gone + 0.5 * step) * A[PX + axis * ROW + node] - share * gone * pull
                        )
                push = step
                if ledger[5] == 0.0:
                    push = 0.5 * step
                    ledger[5] = 1.0
                if dense:
                    kick_sections(A, blocks, push, floor)
                if touching and friction > 0.0:
                    kick_rub_and_drift(A, count, level, friction, push, step)
                elif touching:
                    kick_contact_and_drift(A, count, level, push, step)
                else:
                    kick_and_drift(A, count, push, step)
                drive(A, driven, rest, tables, table_start, table_step, start + (index + inner + 1) * step, step)
                for d in range(driven.shape[0]):
                    for axis in range(3):
                        moved[d, axis] = A[X + axis * ROW + driven[d, 0]] - moved[d, axis]
                if screened:
                    ledger[0] += screen_work(A, screen, push)
            ledger[0] += _load_work(A, count, 1.0)
            if pressed:
                ledger[0] += _pressure_work(A, count, table, triangles, blown)
            done += size
        if broken[0] == 0:
            return -(row + 1)
        # the state at the time of the row: forces here, half a kick
        if loose:
            for axis in range(3):
                for i in range(count):
                    A[TX + axis * ROW + i] = A[PX + axis * ROW + i]
            rib_forces(A, runs, curves)
            bending_forces(A, hinges, bending)
            if screened:
                screen_forces(A, screen)
            if cloth:
                sheet_forces(table, triangles, A, X, A, U, A, TX, 1, ROW, sheet_peak)
            if ringed:
                ring_loads(A[X:], A[Y:], A[Z:], rings, A[TX:], A[TY:], A[TZ:], ring_moments)
        spine_forces(A, spine)
        gone = before + (row * total + done) * step
        for d in range(driven.shape[0]):
            for axis in range(3):
                pull = -_node_force(A, driven[d, 0], axis)
                ledger[1] += 0.5 * (pull + drawn[d, axis]) * moved[d, axis]
                drawn[d, axis] = pull
                moved[d, axis] = 0.0
                ledger[LEDGER + 6 * d + axis] -= 0.5 * step * pull
                ledger[LEDGER + 6 * d + 3 + axis] -= 0.5 * step * gone * pull
        if broken[0] > 0:
            return -(row + 1)
        for axis in range(3):
            for i in range(count):
                keep[axis, i] = A[U + axis * ROW + i]
        if dense:
            kick_sections(A, blocks, 0.5 * step, -1e300)
        kick_and_drift(A, count, 0.5 * step, 0.0)
        kinetic = kinetic_energy(A, count) + block_energy(blocks[0], blocks[2], blocks[3], A, U, ROW)
        # the product of the velocities half a step before and after: with it leapfrog keeps the energy of linear motion
        # exactly, at any step [eq:flexible-discrete-energy]
        for axis in range(3):
            for i in range(count):
                A[U + axis * ROW + i] -= keep[axis, i]
        kinetic -= kinetic_energy(A, count) + block_energy(blocks[0], blocks[2], blocks[3], A, U, ROW)
        for axis in range(3):
            for i in range(count):
                A[U + axis * ROW + i] = keep[axis, i]
        elastic = elastic_energy(A, sizes, runs, curves, hinges, bending, floor)
        elastic += sheet_energy(table, triangles, A, X, 1, ROW)
        if ringed:
            elastic += ring_loads(A[X:], A[Y:], A[Z:], rings, spare[0], spare[1], spare[2], ring_moments)
        out = first_row + row
        energy[out, 0], energy[out, 1], energy[out, 2] = kinetic, elastic, ledger[0] + ledger[1] + ledger[2]
        for j in range(keep_nodes.size):
            for axis in range(3):
                places[out, j, axis] = A[X + axis * ROW + keep_nodes[j]]
        for j in range(keep_bars.size):
            pulls[out, j] = A[PULL + keep_bars[j]]
            peaks[out, j] = A[PEAK + keep_bars[j]]
        for i in range(spine):
            A[PEAK + i] = A[PULL + i]
        for r in range(runs.shape[0]):
            for i in range(runs[r, 3]):
                k = RIB + runs[r, 2] + i
                A[PEAK + k] = A[PULL + k]
        if not (kinetic + elastic < np.inf):
            return row
        if rate * step > most and row + 1 < rows:
            return -(row + 1)
    return rows
