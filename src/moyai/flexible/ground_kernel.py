"""Compiled kernel of the bed: level, slope and curvature at a place.

A bed is one array: 0 level where it is flat, 1 friction, less than none for what is at rest, 2 speed below which
friction fades, 3 one where there is a bed; where it varies there follow 4 and 5 the numbers of grid lines along x and
y, 6 the steepest slope, the grid lines along x and along y, and the levels, row by row along x [eq:flexible-ground].
"""

from __future__ import annotations

import math
from typing import Any

from moyai.core.compiled import njit

#: Numbers of a flat bed, and those before the grid lines of one that varies.
FLAT, HEAD = 4, 7
#: Half the width over which the slope turns at a grid line, over the shorter of the cells next to it.
ROUNDING = 0.02


@njit(cache=True, error_model="numpy")
def _line(bed: Any, first: int, count: int, x: float) -> tuple[int, float, float, float, float, float, float]:
    """Return the nearest grid line, and weight, slope and curvature of the one before it and of the one after it.

    They weigh the differences of the levels there from the level at the nearest line.
    """
    low, high = 0, count - 1
    while high - low > 1:
        middle = (low + high) // 2
        if bed[first + middle] <= x:
            low = middle
        else:
            high = middle
    i = low if 2.0 * x < bed[first + low] + bed[first + high] else high
    t = x - bed[first + i]
    # beyond the outer lines the bed is flat
    before = 1.0 / (bed[first + i] - bed[first + i - 1]) if i > 0 else 0.0
    after = 1.0 / (bed[first + i + 1] - bed[first + i]) if i + 1 < count else 0.0
    r = ROUNDING / max(before, after)
    # the ramp of the change of slope, rounded over 2 r
    ramp, steep, bent = (0.0, 0.0, 0.0) if t < 0.0 else (t, 1.0, 0.0)
    if abs(t) < r:
        ramp, steep, bent = (t + r) * (t + r) / (4.0 * r), (t + r) / (2.0 * r), 0.5 / r
    return i, (ramp - t) * before, (steep - 1.0) * before, bent * before, ramp * after, steep * after, bent * after


@njit(cache=True, error_model="numpy")
def ground_shape(bed: Any, x: float, y: float) -> tuple[float, float, float, float, float, float]:
    """Return level, slopes along x and y, and curvatures xx, xy, yy of the bed at a place."""
    nx, ny = int(bed[4]), int(bed[5])
    i, w0, s0, c0, w1, s1, c1 = _line(bed, HEAD, nx, x)
    j, u0, p0, q0, u1, p1, q1 = _line(bed, HEAD + nx, ny, y)
    left, right = max(j - 1, 0), min(j + 1, ny - 1)
    level = along = across = xx = xy = yy = middle = slope = bend = 0.0
    # the row at the nearest line first: the others count by their difference from it
    for k in range(3):
        row = i if k == 0 else (max(i - 1, 0) if k == 1 else min(i + 1, nx - 1))
        at = HEAD + nx + ny + row * ny
        low, here, high = bed[at + left], bed[at + j], bed[at + right]
        value = here + u0 * (low - here) + u1 * (high - here)
        side = p0 * (low - here) + p1 * (high - here)
        turn = q0 * (low - here) + q1 * (high - here)
        if k == 0:
            level, across, yy = value, side, turn
            middle, slope, bend = value, side, turn
        else:
            w, s, c = (w0, s0, c0) if k == 1 else (w1, s1, c1)
            level += w * (value - middle)
            along += s * (value - middle)
            across += w * (side - slope)
            xx += c * (value - middle)
            xy += s * (side - slope)
            yy += w * (turn - bend)
    return level, along, across, xx, xy, yy


@njit(cache=True, error_model="numpy")
def _grid_ground(bed: Any, x: float, y: float) -> tuple[float, float, float, float]:
    level, along, across, _, _, _ = ground_shape(bed, x, y)
    up = 1.0 / math.sqrt(1.0 + along * along + across * across)
    return level, -along * up, -across * up, up


@njit(cache=True, error_model="numpy")
def ground(bed: Any, x: float, y: float) -> tuple[float, float, float, float]:
    """Return the level of the bed and its unit normal at a place.

    Loops over all nodes ask for it only where the bed is not flat: the call costs more than the rest of the contact.
    """
    return (bed[0], 0.0, 0.0, 1.0) if bed.size == FLAT else _grid_ground(bed, x, y)


@njit(cache=True, error_model="numpy")
def held(bed: Any, nx: float, ny: float, nz: float) -> tuple[float, float, float]:
    """Return what the bed gives what lies at rest on it per push along its normal [eq:flexible-held].

    Up the slope friction holds its weight, as far as its coefficient allows: the push is upright on slopes up to it.
    """
    steep = math.sqrt(nx * nx + ny * ny)
    if not (bed[1] < 0.0 and steep > 0.0):
        return nx, ny, nz
    slope = steep / nz
    part = min(1.0, -bed[1] / slope)
    return (1.0 - part) * nx, (1.0 - part) * ny, nz * (1.0 + part * slope * slope)


@njit(cache=True, error_model="numpy")
def levels(bed: Any, place: Any, out: Any) -> None:
    """Write the depth of places (n, 3) in the bed along its normal, and the normal, (n, 4)."""
    for i in range(place.shape[0]):
        level, p, q, up = ground(bed, place[i, 0], place[i, 1])
        out[i, 0], out[i, 1], out[i, 2], out[i, 3] = (level - place[i, 2]) * up, p, q, up


@njit(cache=True, error_model="numpy")
def curving(shape: Any, push: float, both: bool, out: Any) -> None:
    """Write the stiffness (xx, xy, xz, yy, yz, zz) of a push whose direction turns with the place.

    ``shape`` is that of :func:`ground_shape`; without ``both`` only hollows count, which hold what lies in them.
    """
    xx, xy, yy = shape[3], shape[4], shape[5]
    up = 1.0 / math.sqrt(1.0 + shape[1] * shape[1] + shape[2] * shape[2])
    if not both:
        # the part of the curvature with eigenvalues that are not negative
        mean, half = 0.5 * (xx + yy), math.sqrt(0.25 * (xx - yy) * (xx - yy) + xy * xy)
        high, low = max(mean + half, 0.0), max(mean - half, 0.0)
        if half > 0.0:
            even, odd = 0.5 * (high + low), 0.5 * (high - low) / half
            xx, xy, yy = even + 0.5 * odd * (xx - yy), odd * xy, even - 0.5 * odd * (xx - yy)
        else:
            xx = yy = high
    # projection of the curvature on the plane of the bed, times the push along its normal
    n = (-shape[1] * up, -shape[2] * up, up)
    along = (n[0] * xx + n[1] * xy, n[0] * xy + n[1] * yy)
    twice = n[0] * along[0] + n[1] * along[1]
    scale, row = push * up, 0
    for p in range(3):
        for q in range(p, 3):
            value = twice * n[p] * n[q]
            value -= n[p] * (along[q] if q < 2 else 0.0) + n[q] * (along[p] if p < 2 else 0.0)
            if q < 2:
                value += xx if p == 0 and q == 0 else (xy if p == 0 else yy)
            out[row] = scale * value
            row += 1
