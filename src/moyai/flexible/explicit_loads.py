"""Loads of water and weight in the explicit scheme, taken every few steps."""

from __future__ import annotations

import math

from moyai.core.arrays import Array, IntArray
from moyai.core.compiled import njit
from moyai.flexible.explicit_forces import SHORT, add, fetch_ends
from moyai.flexible.explicit_rows import (
    ACROSS,
    ADDED,
    ALONG,
    AX,
    AY,
    AZ,
    BX,
    BY,
    BZ,
    CROSS,
    DISPLACED,
    DRAG,
    DXX,
    DXY,
    DXZ,
    DYY,
    DYZ,
    DZZ,
    ETA,
    EX,
    EY,
    EZ,
    FAST,
    FASTEST,
    FASTEST_ATTACHED,
    FIRST_END,
    FORM,
    FREE_X,
    FREE_Y,
    FREE_Z,
    HEIGHT,
    IXX,
    IXY,
    IXZ,
    IYY,
    IYZ,
    IZZ,
    LEAN,
    LIFT,
    LIGHT,
    MASS,
    MXX,
    MXY,
    MXZ,
    MYY,
    MYZ,
    MZZ,
    PX,
    PY,
    PZ,
    QX,
    QY,
    QZ,
    RADIUS,
    RATE,
    RIB,
    ROW,
    SECOND_END,
    SEEN,
    SHARE,
    SKIN,
    TINY,
    TX,
    TY,
    TZ,
    VOLUME,
    WA,
    WB,
    WC,
    WEIGHT,
    WET,
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
from moyai.flexible.explicit_types import Sheets
from moyai.flexible.sheet_kernel import sheet_added_mass
from moyai.flexible.sheet_lanes import sheet_loads


@njit(cache=True, error_model="numpy", fastmath=FAST)
def wetness(A: Array, a0: int, b0: int, k0: int, count: int) -> None:
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
def bar_loads(A: Array, a0: int, b0: int, k0: int, count: int, waves: bool, ahead: float) -> None:
    """Write the loads of the water on both ends of bars and their added mass, half for each end.

    Normal and tangential drag of the relative velocity at each end, buoyancy, and the inertia of the water
    [eq:flexible-morison]; ``RATE`` is the rate at which drag damps the lighter end, or at which the added mass turns
    [1/s], ``FASTEST`` its highest value so far. Where the rate of drag times the interval ``ahead`` comes near 1, drag
    is held back so that its continuation stays stable [eq:flexible-drag-limit].
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
        drag = drag if drag > turn else turn
        A[RATE + k] = drag
        A[FASTEST + k] = A[FASTEST + k] if A[FASTEST + k] > drag else drag
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
def node_loads(A: Array, count: int, spine: int) -> None:
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
def add_ribs(A: Array, runs: IntArray) -> None:
    """Add the loads and added mass of the ribs to their nodes."""
    for r in range(runs.shape[0]):
        a0, b0, k0, count = runs[r, 0], runs[r, 1], RIB + runs[r, 2], runs[r, 3]
        if count < SHORT:
            for i in range(count):
                for axis in range(3):
                    A[QX + axis * ROW + a0 + i] += A[AX + axis * ROW + k0 + i]
                    A[QX + axis * ROW + b0 + i] += A[EX + axis * ROW + k0 + i]
                for row in range(6):
                    A[MXX + row * ROW + a0 + i] += A[DXX + row * ROW + k0 + i]
                    A[MXX + row * ROW + b0 + i] += A[DXX + row * ROW + k0 + i]
        else:
            for axis in range(3):
                node, one, two = QX + axis * ROW, AX + axis * ROW + k0, EX + axis * ROW + k0
                add(A[node + a0 : node + a0 + count], A[one : one + count], 1.0)
                add(A[node + b0 : node + b0 + count], A[two : two + count], 1.0)
            for row in range(6):
                node, bar = MXX + row * ROW, DXX + row * ROW + k0
                mass = A[bar : bar + count]
                add(A[node + a0 : node + a0 + count], mass, 1.0)
                add(A[node + b0 : node + b0 + count], mass, 1.0)


@njit(cache=True, error_model="numpy")
def attached_loads(A: Array, attached: IntArray, rho: float, gravity: float, ahead: float) -> None:
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
        rate = 2.0 * size / (A[MASS + i] + part * A[ADDED + i])
        A[FASTEST_ATTACHED + i] = max(A[FASTEST_ATTACHED + i], rate)
        quick = ahead * rate
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
def invert_blocks(A: Array, count: int) -> None:
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
def add_sheet_loads(A: Array, sheets: Sheets, ahead: float) -> None:
    """Add the loads of the water on sheets and their added mass; see :mod:`moyai.flexible.explicit_parts`."""
    if sheets is None:
        return
    table, triangles, light, gauge, _, packed, room, _ = sheets
    gauge[0] = sheet_loads(A, triangles, packed, room, light, ahead)
    sheet_added_mass(table, triangles, A, X, 1, ROW, A, WU, 1, ROW, A, MXX, 1, ROW)


@njit(cache=True, error_model="numpy")
def loads(
    A: Array, sizes: IntArray, runs: IntArray, attached: IntArray, rho: float, gravity: float, surface: bool,
    waves: bool, ahead: float, sheets: Sheets,
) -> None:  # fmt: skip
    """Write weight, buoyancy, drag and inertia of the water at every node, and the inverse mass blocks."""
    count, spine = sizes[0], sizes[1]
    ribs = fetch_ends(A, runs, SEEN)
    if surface:
        wetness(A, 0, 1, 0, spine)
        wetness(A, FIRST_END, SECOND_END, RIB, ribs)
    bar_loads(A, 0, 1, 0, spine, waves, ahead)
    node_loads(A, count, spine)
    if ribs > 0:
        bar_loads(A, FIRST_END, SECOND_END, RIB, ribs, waves, ahead)
        add_ribs(A, runs)
    if attached.size > 0:
        attached_loads(A, attached, rho, gravity, ahead)
    add_sheet_loads(A, sheets, ahead)
    invert_blocks(A, count)


@njit(cache=True, error_model="numpy", fastmath=FAST)
def extrapolate(A: Array, count: int, ahead: float) -> None:
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
def rate_of_sheets(sheets: Sheets) -> float:
    """Return the fastest rate at which drag damps a sheet, at the last evaluation of the loads [1/s]."""
    if sheets is None:
        return 0.0
    return sheets[3][0]


@njit(cache=True, error_model="numpy")
def rate_of_drag(A: Array, spine: int, runs: IntArray, attached: IntArray, sheets: Sheets) -> float:
    """Return the fastest rate at which drag damps any node, at the last evaluation of the loads [1/s]."""
    rate = rate_of_sheets(sheets)
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
