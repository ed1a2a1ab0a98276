"""Compiled kernels of sheets in the explicit scheme: triangles side by side, in the vector registers of a processor.

What :mod:`moyai.flexible.sheet_kernel` finds for one triangle after the other, block by block of ``LANES`` triangles:
corners are gathered into the rows of a small array, all arithmetic goes along these rows, forces are added to the nodes
in the order of the triangles. Rows lie at distances that the compiler knows, so that it sees that none overlaps.
"""

from __future__ import annotations

import math

import numpy as np

from moyai.core.arrays import PLAIN, Array, IntArray
from moyai.core.compiled import njit
from moyai.flexible.explicit_rows import ETA, FAST, QX, ROW, TX, WA, WU, U, X, Z
from moyai.flexible.sheet_kernel import (
    ACROSS,
    ADDED,
    AREA,
    BEND,
    C11,
    C12,
    C22,
    C33,
    COLUMNS,
    DAMPING,
    DISPLACED,
    E11,
    E12,
    E21,
    E22,
    FACE,
    FIELD,
    LAW,
    LIFT,
    LINEAR,
    MOST_STEPS,
    NEAR,
    PRESSURE,
    SHARE,
    SKIN,
    SMALL,
    THREADS,
    WARP,
    WEFT,
)

#: Triangles of a block.
LANES = 64
_UP = 2 * ROW
#: Constants of a block by name, as :func:`packed_constants` lays them.
_E11, _E12, _E21, _E22, _AREA, _DAMPING = (LANES * k for k in (E11, E12, E21, E22, AREA, DAMPING))
_C11, _C12, _C22, _C33, _WARP, _WEFT, _BEND = (LANES * k for k in (C11, C12, C22, C33, WARP, WEFT, BEND))
_LAW, _PRESSURE, _SHARE, _FACE, _ADDED = (LANES * k for k in (LAW, PRESSURE, SHARE, FACE, ADDED))
_DISPLACED, _LIFT, _ACROSS, _SKIN = (LANES * k for k in (DISPLACED, LIFT, ACROSS, SKIN))
#: Rows of the room: edges from the first corner to the second (3) and the third (3).
_P, _R = 0, 3 * LANES
#: Of forces: rates of the edges (6), strain (3), stress (3).
_PU, _RU, _E, _S = 6 * LANES, 9 * LANES, 12 * LANES, 15 * LANES
#: Of wrinkled triangles, one behind the other: roots of the stiffness of the threads, strain in stretched axes as half
#: and turn, what bends the compliance, its product with the mean; of the secular equation the first and the second
#: part, the gap, the root, its last change; the mean.
_ROOTS, _HALF, _TURN, _MORE, _SHIFT = (LANES * k for k in (18, 20, 21, 22, 23))
_FIRST, _SECOND, _GAP, _ROOT, _STEP, _MEAN = (LANES * k for k in (24, 25, 26, 27, 28, 29))
#: Of loads: heights over the surface (3); of the triangle its normal (3), drag across and along, inertia taken along,
#: displaced, lift; of one corner relative velocity (3), acceleration of the water (3), the light side of its node (4),
#: the rate at which drag damps it.
_HIGH, _NORMAL, _WET = 6 * LANES, 9 * LANES, 12 * LANES
_REL, _ACC, _LIGHT, _RATE = 17 * LANES, 20 * LANES, 23 * LANES, 27 * LANES
#: Of both: forces on the corners (9), or on one of them (3).
_OUT, ROWS = 31 * LANES, 40
_SIXTH = 1.0 / 6.0


def packed_constants(table: Array) -> Array:
    """Return the constants of triangles block by block, each column of a block in one piece.

    Parameters
    ----------
    table : ndarray, shape (t, 24)
        Of :meth:`moyai.flexible.sheets.Sheets.constants`.
    """
    blocks = -(-len(table) // LANES)
    packed = np.zeros((blocks * LANES, COLUMNS))
    packed[: len(table)] = table
    return np.ascontiguousarray(packed.reshape(blocks, LANES, COLUMNS).transpose(0, 2, 1)).ravel()


@njit(cache=True, error_model="numpy")
def _gather(A: Array, triangles: IntArray, first: int, count: int, S: Array) -> None:
    """Write the edges of a block and their rates."""
    for n in range(count):
        t = first + n
        i, j, k = triangles[t, 0] & PLAIN, triangles[t, 1] & PLAIN, triangles[t, 2] & PLAIN
        for axis in range(3):
            row, to = axis * ROW, axis * LANES + n
            x, u = A[X + row + i], A[U + row + i]
            S[_P + to], S[_R + to] = A[X + row + j] - x, A[X + row + k] - x
            S[_PU + to], S[_RU + to] = A[U + row + j] - u, A[U + row + k] - u


@njit(cache=True, error_model="numpy", fastmath=FAST)
def _elastic(K: Array, k0: int, S: Array, count: int) -> None:
    """Write Green's strain with the damping times its rate, and the stress of the elastic law."""
    for n in range(count):
        k = k0 + n
        a, b, c, d = K[_E11 + k], K[_E12 + k], K[_E21 + k], K[_E22 + k]
        p0, p1, p2 = S[_P + n], S[_P + LANES + n], S[_P + 2 * LANES + n]
        r0, r1, r2 = S[_R + n], S[_R + LANES + n], S[_R + 2 * LANES + n]
        u0, u1, u2 = S[_PU + n], S[_PU + LANES + n], S[_PU + 2 * LANES + n]
        w0, w1, w2 = S[_RU + n], S[_RU + LANES + n], S[_RU + 2 * LANES + n]
        f0, f1, f2 = p0 * a + r0 * c, p1 * a + r1 * c, p2 * a + r2 * c
        s0, s1, s2 = p0 * b + r0 * d, p1 * b + r1 * d, p2 * b + r2 * d
        g0, g1, g2 = u0 * a + w0 * c, u1 * a + w1 * c, u2 * a + w2 * c
        h0, h1, h2 = u0 * b + w0 * d, u1 * b + w1 * d, u2 * b + w2 * d
        damping = K[_DAMPING + k]
        e11 = 0.5 * (f0 * f0 + f1 * f1 + f2 * f2 - 1.0) + damping * (f0 * g0 + f1 * g1 + f2 * g2)
        e22 = 0.5 * (s0 * s0 + s1 * s1 + s2 * s2 - 1.0) + damping * (s0 * h0 + s1 * h1 + s2 * h2)
        shear = f0 * s0 + f1 * s1 + f2 * s2
        shear += damping * (f0 * h0 + s0 * g0 + (f1 * h1 + s1 * g1) + (f2 * h2 + s2 * g2))
        S[_E + n], S[_E + LANES + n], S[_E + 2 * LANES + n] = e11, e22, shear
        S[_S + n] = K[_C11 + k] * e11 + K[_C12 + k] * e22
        S[_S + LANES + n] = K[_C12 + k] * e11 + K[_C22 + k] * e22
        S[_S + 2 * LANES + n] = K[_C33 + k] * shear


@njit(cache=True, error_model="numpy")
def _wrinkled(K: Array, k0: int, S: Array, count: int, which: IntArray) -> int:
    """Write zero for slack triangles, the threads' own pull for threads; list wrinkled ones and return their number."""
    found = 0
    for n in range(count):
        k = k0 + n
        law = K[_LAW + k]
        s11, s22, s12 = S[_S + n], S[_S + LANES + n], S[_S + 2 * LANES + n]
        if law == LINEAR or (law == FIELD and s11 + s22 >= 0.0 and s11 * s22 >= s12 * s12):
            continue
        if law == THREADS:
            S[_S + n], S[_S + LANES + n], S[_S + 2 * LANES + n] = max(s11, 0.0), max(s22, 0.0), 0.0
            continue
        e11, e22, shear = S[_E + n], S[_E + LANES + n], 0.5 * S[_E + 2 * LANES + n]
        if e11 + e22 <= 0.0 and e11 * e22 >= shear * shear:
            S[_S + n] = S[_S + LANES + n] = S[_S + 2 * LANES + n] = 0.0
            continue
        S[_ROOTS + found], S[_ROOTS + LANES + found], S[_MORE + found] = K[_WARP + k], K[_WEFT + k], K[_BEND + k]
        S[_MEAN + found], S[_HALF + found], S[_TURN + found] = e11, e22, shear
        which[found] = n
        found += 1
    return found


@njit(cache=True, error_model="numpy", fastmath=FAST)
def _begin(S: Array, found: int) -> None:
    """Write the strains of wrinkled triangles in stretched axes and begin with their secular equation."""
    for n in range(found):
        warp, weft, more = S[_ROOTS + n], S[_ROOTS + LANES + n], S[_MORE + n]
        e11, e22 = warp * S[_MEAN + n], weft * S[_HALF + n]
        mean, half, turn = 0.5 * (e11 + e22), 0.5 * (e11 - e22), math.sqrt(warp * weft) * S[_TURN + n]
        S[_MEAN + n], S[_HALF + n], S[_TURN + n], S[_SHIFT + n] = mean, half, turn, more * mean
        small = SMALL * (abs(mean) + abs(half) + abs(turn))
        even, odd, shift = (1.0 + more) * abs(half) + small, abs(turn) + small, more * mean
        first, second = even if shift >= 0.0 else odd, odd if shift >= 0.0 else even
        S[_FIRST + n], S[_SECOND + n], S[_GAP + n] = first, second, abs(shift)
        S[_ROOT + n] = max(first, second - abs(shift))


@njit(cache=True, error_model="numpy", fastmath=FAST)
def _newton(S: Array, found: int) -> None:
    """Take a step to the roots of the secular equations [eq:flexible-wrinkle-direction]."""
    for n in range(found):
        root, gap = S[_ROOT + n], S[_GAP + n]
        one, two = 1.0 / root, 1.0 / (root + gap)
        x, y = S[_FIRST + n] * one, S[_SECOND + n] * two
        square = x * x + y * y
        step = square * (math.sqrt(square) - 1.0) / (x * x * one + y * y * two)
        S[_ROOT + n] = root + step
        S[_STEP + n] = abs(step) - NEAR * root


@njit(cache=True, error_model="numpy", fastmath=FAST)
def _pulls(S: Array, found: int) -> None:
    """Write the stresses of wrinkled triangles in place of their steps."""
    for n in range(found):
        root, half, turn, more = S[_ROOT + n], S[_HALF + n], S[_TURN + n], S[_MORE + n]
        x, y = S[_FIRST + n] / root, S[_SECOND + n] / (root + S[_GAP + n])
        c, s = x if S[_SHIFT + n] >= 0.0 else y, y if S[_SHIFT + n] >= 0.0 else x
        c, s = c if half >= 0.0 else -c, s if turn >= 0.0 else -s
        pull = 0.5 * (S[_MEAN + n] + half * c + turn * s) / (1.0 + more * s * s)
        warp, weft = S[_ROOTS + n], S[_ROOTS + LANES + n]
        S[_FIRST + n], S[_SECOND + n] = warp * pull * (1.0 + c), weft * pull * (1.0 - c)
        S[_STEP + n] = math.sqrt(warp * weft) * pull * s


@njit(cache=True, error_model="numpy")
def _tension_field(K: Array, k0: int, S: Array, count: int, which: IntArray) -> None:
    """Take the nearest tensile stress in place of the elastic one where that pushes [eq:flexible-tension-field]."""
    found = _wrinkled(K, k0, S, count, which)
    if found == 0:
        return
    _begin(S, found)
    for _ in range(MOST_STEPS):
        _newton(S, found)
        worst = -1.0
        for n in range(found):
            worst = max(worst, S[_STEP + n])
        if worst < 0.0:
            break
    _pulls(S, found)
    for n in range(found):
        to = _S + which[n]
        S[to], S[to + LANES], S[to + 2 * LANES] = S[_FIRST + n], S[_SECOND + n], S[_STEP + n]


@njit(cache=True, error_model="numpy", fastmath=FAST)
def _on_corners(K: Array, k0: int, S: Array, count: int, peak: Array) -> None:
    """Write what stress and pressure do on the corners [N]; keep the highest principal pull [N/m]."""
    for n in range(count):
        k = k0 + n
        s11, s22, s12 = S[_S + n], S[_S + LANES + n], S[_S + 2 * LANES + n]
        mean, half = 0.5 * (s11 + s22), 0.5 * (s11 - s22)
        pull = mean + math.sqrt(half * half + s12 * s12)
        peak[n] = pull if pull > peak[n] else peak[n]
        a, b, c, d, area = K[_E11 + k], K[_E12 + k], K[_E21 + k], K[_E22 + k], K[_AREA + k]
        px, py, pz = S[_P + n], S[_P + LANES + n], S[_P + 2 * LANES + n]
        rx, ry, rz = S[_R + n], S[_R + LANES + n], S[_R + 2 * LANES + n]
        push = _SIXTH * K[_PRESSURE + k]
        x, y, z = push * (py * rz - pz * ry), push * (pz * rx - px * rz), push * (px * ry - py * rx)
        one, two = px * a + rx * c, px * b + rx * d
        along, across = area * (one * s11 + two * s12), area * (one * s12 + two * s22)
        gx, hx = -(along * a + across * b), -(along * c + across * d)
        one, two = py * a + ry * c, py * b + ry * d
        along, across = area * (one * s11 + two * s12), area * (one * s12 + two * s22)
        gy, hy = -(along * a + across * b), -(along * c + across * d)
        one, two = pz * a + rz * c, pz * b + rz * d
        along, across = area * (one * s11 + two * s12), area * (one * s12 + two * s22)
        gz, hz = -(along * a + across * b), -(along * c + across * d)
        S[_OUT + n], S[_OUT + LANES + n], S[_OUT + 2 * LANES + n] = x - (gx + hx), y - (gy + hy), z - (gz + hz)
        S[_OUT + 3 * LANES + n], S[_OUT + 4 * LANES + n], S[_OUT + 5 * LANES + n] = x + gx, y + gy, z + gz
        S[_OUT + 6 * LANES + n], S[_OUT + 7 * LANES + n], S[_OUT + 8 * LANES + n] = x + hx, y + hy, z + hz


@njit(cache=True, error_model="numpy")
def _scatter(A: Array, to: int, triangles: IntArray, first: int, count: int, S: Array) -> None:
    """Add the forces on the corners to the nodes, in the order of the triangles."""
    for n in range(count):
        t = first + n
        i, j, k = to + (triangles[t, 0] & PLAIN), to + (triangles[t, 1] & PLAIN), to + (triangles[t, 2] & PLAIN)
        for axis in range(3):
            row, at = axis * ROW, _OUT + axis * LANES + n
            A[i + row] += S[at]
            A[j + row] += S[at + 3 * LANES]
            A[k + row] += S[at + 6 * LANES]


@njit(cache=True, error_model="numpy")
def sheet_forces(A: Array, triangles: IntArray, K: Array, S: Array, which: IntArray, peak: Array) -> None:
    """Add the stresses of all triangles to the total of the nodes; keep the highest principal pull of each [N/m].

    ``K`` holds the constants of the triangles block by block (:func:`packed_constants`), ``S`` has room for ``ROWS``
    rows of a block, ``which`` for its triangles.
    """
    for first in range(0, triangles.shape[0], LANES):
        count, k0 = min(LANES, triangles.shape[0] - first), first * COLUMNS
        _gather(A, triangles, first, count, S)
        _elastic(K, k0, S, count)
        _tension_field(K, k0, S, count, which)
        _on_corners(K, k0, S, count, peak[first:])
        _scatter(A, TX, triangles, first, count, S)


@njit(cache=True, error_model="numpy")
def _gather_heights(A: Array, triangles: IntArray, first: int, count: int, S: Array) -> bool:
    """Write the edges of a block and the heights of its corners over the surface; whether any may be wet."""
    lowest = math.inf
    for n in range(count):
        t = first + n
        i, j, k = triangles[t, 0] & PLAIN, triangles[t, 1] & PLAIN, triangles[t, 2] & PLAIN
        for axis in range(3):
            row, to = axis * ROW, axis * LANES + n
            x = A[X + row + i]
            S[_P + to], S[_R + to] = A[X + row + j] - x, A[X + row + k] - x
        one, two, three = A[Z + i] - A[ETA + i], A[Z + j] - A[ETA + j], A[Z + k] - A[ETA + k]
        S[_HIGH + n], S[_HIGH + LANES + n], S[_HIGH + 2 * LANES + n] = one, two, three
        lowest = min(lowest, one, two, three)
    return lowest < 0.0


@njit(cache=True, error_model="numpy")
def _gather_corner(
    A: Array, triangles: IntArray, first: int, count: int, corner: int, K: Array, k0: int, light: Array, S: Array
) -> None:  # fmt: skip
    """Write relative velocity, acceleration of the water and light side of the node at a corner of each triangle."""
    for n in range(count):
        point, share = triangles[first + n, corner] & PLAIN, K[_SHARE + k0 + n]
        for axis in range(3):
            row, to = axis * ROW + point, axis * LANES + n
            S[_REL + to], S[_ACC + to] = share * A[WU + row] - A[U + row], A[WA + row]
        for side in range(4):
            S[_LIGHT + side * LANES + n] = light[side, point]


@njit(cache=True, error_model="numpy", fastmath=FAST)
def _wetted(K: Array, k0: int, S: Array, count: int) -> None:
    """Write the normal of each triangle, and its drag, inertia and lift with the part of it under the surface.

    That part is one where its highest corner is under it, zero where the lowest is over it, else a function of the
    heights that is either of two, by the middle one.
    """
    for n in range(count):
        k = k0 + n
        a, b, c = S[_HIGH + n], S[_HIGH + LANES + n], S[_HIGH + 2 * LANES + n]
        low, high = min(a, min(b, c)), max(a, max(b, c))
        middle = max(min(a, b), min(max(a, b), c))
        sunk = 1.0 - high * high / ((high - low) * (high - middle))
        risen = low * low / ((middle - low) * (high - low))
        wet = sunk if middle <= 0.0 else risen
        wet = 0.0 if low >= 0.0 else wet
        wet = 1.0 if high <= 0.0 else wet
        px, py, pz = S[_P + n], S[_P + LANES + n], S[_P + 2 * LANES + n]
        rx, ry, rz = S[_R + n], S[_R + LANES + n], S[_R + 2 * LANES + n]
        nx, ny, nz = py * rz - pz * ry, pz * rx - px * rz, px * ry - py * rx
        size = math.sqrt(nx * nx + ny * ny + nz * nz)
        per = 1.0 / size
        per = per if size > 0.0 else 0.0
        S[_NORMAL + n], S[_NORMAL + LANES + n], S[_NORMAL + 2 * LANES + n] = nx * per, ny * per, nz * per
        area = _SIXTH * wet * size
        S[_WET + n], S[_WET + LANES + n] = area * K[_ACROSS + k], area * K[_SKIN + k]
        S[_WET + 2 * LANES + n] = 2.0 * _SIXTH * wet * K[_ADDED + k] * K[_AREA + k]
        S[_WET + 3 * LANES + n], S[_WET + 4 * LANES + n] = wet * K[_DISPLACED + k], wet * K[_LIFT + k]


@njit(cache=True, error_model="numpy", fastmath=FAST)
def _at_corner(K: Array, k0: int, S: Array, count: int, ahead: float) -> None:
    """Write the loads of the water at a corner of each triangle, and the rate at which its drag damps the node."""
    for n in range(count):
        k = k0 + n
        nx, ny, nz = S[_NORMAL + n], S[_NORMAL + LANES + n], S[_NORMAL + 2 * LANES + n]
        ux, uy, uz = S[_REL + n], S[_REL + LANES + n], S[_REL + 2 * LANES + n]
        ax, ay, az = S[_ACC + n], S[_ACC + LANES + n], S[_ACC + 2 * LANES + n]
        fx, fy, fz = K[_FACE + k], K[_FACE + LANES + k], K[_FACE + 2 * LANES + k]
        along = ux * nx + uy * ny + uz * nz
        ux, uy, uz = ux - along * nx, uy - along * ny, uz - along * nz
        hold, slide = S[_WET + n] * abs(along), S[_WET + LANES + n] * math.sqrt(ux * ux + uy * uy + uz * uz)
        facing = nx * S[_LIGHT + 2 * LANES + n] + ny * S[_LIGHT + 3 * LANES + n]
        own = S[_LIGHT + n]
        part = own + (S[_LIGHT + LANES + n] - own) * facing * facing
        one, other = hold * part, slide * own
        rate = 2.0 * (one if one > other else other)
        quick = ahead * rate
        held = 1.0 / (1.0 + 0.4 * quick * quick * quick * quick)
        rise = S[_WET + 2 * LANES + n] * (ax * fx + ay * fy + az * fz)
        push, pull, displaced = held * hold * along, held * slide, S[_WET + 3 * LANES + n]
        S[_OUT + n] = push * nx + pull * ux + rise * fx + displaced * ax
        S[_OUT + LANES + n] = push * ny + pull * uy + rise * fy + displaced * ay
        S[_OUT + 2 * LANES + n] = push * nz + pull * uz + rise * fz + displaced * az + S[_WET + 4 * LANES + n]
        S[_RATE + n] = rate


@njit(cache=True, error_model="numpy")
def sheet_loads(A: Array, triangles: IntArray, K: Array, S: Array, light: Array, ahead: float) -> float:
    """Add buoyancy, drag and inertia of moving water; return the fastest rate at which drag damps a node [1/s].

    As :func:`moyai.flexible.sheet_kernel.sheet_loads` [eq:flexible-sheet-drag] [eq:flexible-sheet-inertia].
    """
    fastest = 0.0
    for first in range(0, triangles.shape[0], LANES):
        count, k0 = min(LANES, triangles.shape[0] - first), first * COLUMNS
        if not _gather_heights(A, triangles, first, count, S):
            continue
        _wetted(K, k0, S, count)
        for corner in range(3):
            _gather_corner(A, triangles, first, count, corner, K, k0, light, S)
            _at_corner(K, k0, S, count, ahead)
            for n in range(count):
                point = QX + (triangles[first + n, corner] & PLAIN)
                A[point] += S[_OUT + n]
                A[point + ROW] += S[_OUT + LANES + n]
                A[point + _UP] += S[_OUT + 2 * LANES + n]
                fastest = max(fastest, S[_RATE + n])
    return fastest
