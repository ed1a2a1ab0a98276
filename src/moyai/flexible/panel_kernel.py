"""Compiled kernels of net panels: the loads of a screen law on the knots of a net.

A panel meets the water with the relative velocity w of its middle. With its normal n the law says
``F = (a w + b n (n.w)) |w| rho A / 2 = S w`` [eq:cage-panel-force]; the symmetric matrix S is shared equally by the
corners, each of which meets the water with its own velocity, so that the whole is S w and unequal motion of the
corners is damped as well. ``panels`` is (corners, rows, table, grid) of
:class:`moyai.flexible.panels.PanelArrays`.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from moyai.core.arrays import PLAIN
from moyai.core.compiled import njit


@njit(cache=True, error_model="numpy")
def _coefficients(table: Any, grid: Any, law: int, cosine: float, speed: float) -> tuple[float, float]:
    """Return the coefficients (a, b) of a law at an angle and a speed, linear between the points of its table."""
    columns, lines = table.shape[2], table.shape[1]
    place = cosine * (columns - 1)
    j = min(int(place), columns - 2)
    s = place - j
    if lines == 1:
        one, two = table[law, 0, j], table[law, 0, j + 1]
        return one[0] + s * (two[0] - one[0]), one[1] + s * (two[1] - one[1])
    height = (math.log10(max(speed, 1e-30)) - grid[law, 0]) * grid[law, 1]
    height = min(max(height, 0.0), lines - 1.0)
    i = min(int(height), lines - 2)
    r = height - i
    low, high = table[law, i], table[law, i + 1]
    a = (1.0 - r) * (low[j, 0] + s * (low[j + 1, 0] - low[j, 0])) + r * (high[j, 0] + s * (high[j + 1, 0] - high[j, 0]))
    b = (1.0 - r) * (low[j, 1] + s * (low[j + 1, 1] - low[j, 1])) + r * (high[j, 1] + s * (high[j + 1, 1] - high[j, 1]))
    return a, b


@njit(cache=True, error_model="numpy")
def _matrix(
    x0: float, x1: float, x2: float, y0: float, y1: float, y2: float, low: float, high: float,
    w0: float, w1: float, w2: float, area: float, table: Any, grid: Any, law: int, half_density: float, faster: float,
) -> tuple[float, float, float, float, float, float]:  # fmt: skip
    """Return S of one panel (xx, xy, xz, yy, yz, zz) from its diagonals x and y, its span of heights over the surface
    and the relative velocity w, which counts ``faster`` times.

    Of a triangle the diagonals are two of its edges.
    """
    n0, n1, n2 = x1 * y2 - x2 * y1, x2 * y0 - x0 * y2, x0 * y1 - x1 * y0
    twice = math.sqrt(n0 * n0 + n1 * n1 + n2 * n2)
    speed = math.sqrt(w0 * w0 + w1 * w1 + w2 * w2)
    if twice <= 0.0 or speed <= 0.0 or low >= 0.0:
        return 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    n0, n1, n2 = n0 / twice, n1 / twice, n2 / twice
    wet = 1.0 if high <= 0.0 else -low / (high - low)
    cosine = min(abs(n0 * w0 + n1 * w1 + n2 * w2) / speed, 1.0)
    speed *= faster
    a, b = _coefficients(table, grid, law, cosine, speed)
    scale = half_density * (area if area > 0.0 else 0.5 * twice) * wet * speed
    a, b = scale * a, scale * b
    return a + b * n0 * n0, b * n0 * n1, b * n0 * n2, a + b * n1 * n1, b * n1 * n2, a + b * n2 * n2


@njit(cache=True, error_model="numpy")
def screen_loads(
    x: Any, y: Any, z: Any, u: Any, v: Any, w: Any, wu: Any, wv: Any, ww: Any, wa: Any, wb: Any, wc: Any, eta: Any,
    panels: Any, half_density: float, ahead: float, out: Any, speeds: Any, onward: float,
) -> None:  # fmt: skip
    """Write what panels do to their nodes as force = R - C velocity, rows 0-5 (C) and 6-8 (R) of ``out`` (12, n).

    Held over an interval ``ahead``: the velocity of the water is taken in its middle, along its acceleration
    [eq:cage-panel-implicit]. ``speeds`` are the relative speeds of all panels when they were last asked for, of which
    the change since counts ``onward`` times; those of now take their place. Not above 0: nothing is known of them.
    """
    corners, rows, table, grid = panels
    half = 0.5 * ahead
    # where the change of the relative speed is known the water need not be led on
    lead = 0.0 if onward > 0.0 else half
    # by node: what a corner takes then lies in one place
    sums = np.zeros((out.shape[1], 9))
    for p in range(corners.shape[0]):
        count = 4 if corners[p, 3] >= 0 else 3
        a, b, c = corners[p, 0] & PLAIN, corners[p, 1] & PLAIN, corners[p, 2] & PLAIN
        d = corners[p, count - 1] & PLAIN
        share = 1.0 / count
        factor, s0, s1, s2 = rows[p, 1], rows[p, 2], rows[p, 3], rows[p, 4]
        w0 = w1 = w2 = 0.0
        low, high = 1e300, -1e300
        for k in range(count):
            i = corners[p, k] & PLAIN
            w0 += factor * (wu[i] + lead * wa[i]) - u[i]
            w1 += factor * (wv[i] + lead * wb[i]) - v[i]
            w2 += factor * (ww[i] + lead * wc[i]) - w[i]
            over = z[i] - eta[i]
            low, high = min(low, over), max(high, over)
        e, f = (c, a) if count == 4 else (b, a)
        g, h = (d, b) if count == 4 else (c, a)
        w0, w1, w2 = share * w0 - s0, share * w1 - s1, share * w2 - s2
        speed, faster = math.sqrt(w0 * w0 + w1 * w1 + w2 * w2), 1.0
        if onward > 0.0 and speed > 0.0:
            faster = min(max(1.0 + onward * (speed - speeds[p]) / speed, 0.95), 1.05)
        speeds[p] = speed
        xx, xy, xz, yy, yz, zz = _matrix(
            x[e] - x[f], y[e] - y[f], z[e] - z[f], x[g] - x[h], y[g] - y[h], z[g] - z[h], low, high,
            w0, w1, w2, rows[p, 0], table, grid, int(rows[p, 5]), half_density, faster,
        )  # fmt: skip
        if xx + yy + zz <= 0.0:
            continue
        xx, xy, xz, yy, yz, zz = share * xx, share * xy, share * xz, share * yy, share * yz, share * zz
        for k in range(count):
            i = corners[p, k] & PLAIN
            own = sums[i]
            f0 = factor * (wu[i] + half * wa[i]) - s0
            f1 = factor * (wv[i] + half * wb[i]) - s1
            f2 = factor * (ww[i] + half * wc[i]) - s2
            own[0] += xx
            own[1] += xy
            own[2] += xz
            own[3] += yy
            own[4] += yz
            own[5] += zz
            own[6] += xx * f0 + xy * f1 + xz * f2
            own[7] += xy * f0 + yy * f1 + yz * f2
            own[8] += xz * f0 + yz * f1 + zz * f2
    for row in range(9):
        for i in range(out.shape[1]):
            out[row, i] = sums[i, row]


@njit(cache=True, error_model="numpy")
def _on_one(p: int, xl: Any, vl: Any, water: Any, panels: Any, half_density: float, S: Any, fl: Any) -> None:
    """Write the force of panel p on its corners, whose places and velocities are given apart from the network."""
    corners, rows, table, grid = panels
    count = 4 if corners[p, 3] >= 0 else 3
    share = 1.0 / count
    factor = rows[p, 1]
    w0 = w1 = w2 = 0.0
    low, high = 1e300, -1e300
    for k in range(count):
        i = corners[p, k]
        w0 += factor * water[0, i] - vl[k, 0]
        w1 += factor * water[1, i] - vl[k, 1]
        w2 += factor * water[2, i] - vl[k, 2]
        over = xl[k, 2] - water[6, i]
        low, high = min(low, over), max(high, over)
    e, f, g, h = (2, 0, 3, 1) if count == 4 else (1, 0, 2, 0)
    S[0], S[1], S[2], S[3], S[4], S[5] = _matrix(
        xl[e, 0] - xl[f, 0], xl[e, 1] - xl[f, 1], xl[e, 2] - xl[f, 2],
        xl[g, 0] - xl[h, 0], xl[g, 1] - xl[h, 1], xl[g, 2] - xl[h, 2], low, high,
        share * w0 - rows[p, 2], share * w1 - rows[p, 3], share * w2 - rows[p, 4], rows[p, 0], table, grid,
        int(rows[p, 5]), half_density, 1.0,
    )  # fmt: skip
    for k in range(count):
        i = corners[p, k]
        f0 = share * (factor * water[0, i] - rows[p, 2] - vl[k, 0])
        f1 = share * (factor * water[1, i] - rows[p, 3] - vl[k, 1])
        f2 = share * (factor * water[2, i] - rows[p, 4] - vl[k, 2])
        fl[k, 0] = S[0] * f0 + S[1] * f1 + S[2] * f2
        fl[k, 1] = S[1] * f0 + S[3] * f1 + S[4] * f2
        fl[k, 2] = S[2] * f0 + S[4] * f1 + S[5] * f2


@njit(cache=True, error_model="numpy")
def panel_forces(x: Any, v: Any, water: Any, panels: Any, half_density: float, force: Any, each: Any) -> None:
    """Add the forces of all panels to ``force`` (n, 3) and write the force of each panel to ``each`` (p, 3).

    ``water`` is velocity, acceleration and elevation at the nodes (7, n).
    """
    corners = panels[0]
    xl, vl, fl, S = np.empty((4, 3)), np.empty((4, 3)), np.empty((4, 3)), np.empty(6)
    for p in range(corners.shape[0]):
        count = 4 if corners[p, 3] >= 0 else 3
        for k in range(count):
            for axis in range(3):
                xl[k, axis], vl[k, axis] = x[corners[p, k], axis], v[corners[p, k], axis]
        _on_one(p, xl, vl, water, panels, half_density, S, fl)
        for axis in range(3):
            each[p, axis] = 0.0
            for k in range(count):
                force[corners[p, k], axis] += fl[k, axis]
                each[p, axis] += fl[k, axis]


@njit(cache=True, error_model="numpy")
def panel_tangent(x: Any, v: Any, water: Any, panels: Any, half_density: float, width: float, blocks: Any) -> None:
    """Write the derivative of minus the force on corner i over the place of corner j, ``blocks`` (p, 4, 4, 3, 3).

    Central differences over ``width`` [m]; rows and columns of an absent fourth corner are zero.
    """
    corners = panels[0]
    xl, vl, S = np.empty((4, 3)), np.empty((4, 3)), np.empty(6)
    plus, minus = np.empty((4, 3)), np.empty((4, 3))
    for p in range(corners.shape[0]):
        count = 4 if corners[p, 3] >= 0 else 3
        for k in range(count):
            for axis in range(3):
                xl[k, axis], vl[k, axis] = x[corners[p, k], axis], v[corners[p, k], axis]
        for i in range(4):
            for j in range(4):
                for one in range(3):
                    for two in range(3):
                        blocks[p, i, j, one, two] = 0.0
        for j in range(count):
            for axis in range(3):
                keep = xl[j, axis]
                xl[j, axis] = keep + width
                _on_one(p, xl, vl, water, panels, half_density, S, plus)
                xl[j, axis] = keep - width
                _on_one(p, xl, vl, water, panels, half_density, S, minus)
                xl[j, axis] = keep
                for i in range(count):
                    for one in range(3):
                        blocks[p, i, j, one, axis] = 0.5 * (minus[i, one] - plus[i, one]) / width
