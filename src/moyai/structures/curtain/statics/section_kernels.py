"""Compiled parts of the section of a curtain: the climb along the skirt and the searches for its lower end."""

from __future__ import annotations

import math

from moyai.core.arrays import Array
from moyai.core.compiled import njit

_MOST_STEPS = 12


@njit(cache=True, error_model="numpy")
def _pressure_at(z: float, low: float, step: float, pressure: Array) -> float:
    place = (z - low) / step
    if place <= 0.0:
        return pressure[0]
    i = int(place)
    if i >= pressure.size - 1:
        return pressure[pressure.size - 1]
    part = place - i
    return pressure[i] * (1.0 - part) + pressure[i + 1] * part


@njit(cache=True, error_model="numpy")
def _slopes(
    z: float,
    along: float,
    up: float,
    low: float,
    step: float,
    pressure: Array,
    scale: float,
    weight: float,
    flexibility: float,
    law: float,
    friction: float,
) -> tuple[float, float, float, float]:
    """Derivatives of x, z, F_x, F_z along the unstretched skirt, upwards [eq:curtain-section]."""
    tension = math.sqrt(along * along + up * up)
    tx, tz = along / tension, up / tension
    stretch = 1.0 + tension * flexibility
    head = _pressure_at(z, low, step, pressure) * stretch
    load = scale * head
    if law == 0.0:
        load *= tz * abs(tz)
    elif law == 2.0:
        load *= (4.0 + math.pi) * tz / (4.0 + math.pi * abs(tz))
    drag = friction * head * tx * abs(tx)
    return stretch * tx, stretch * tz, -load * tz - drag * tx, weight + load * tx - drag * tz


@njit(cache=True, error_model="numpy")
def climb(
    toe_height: float,
    hold: float,
    toe_load: float,
    nodes: Array,
    low: float,
    step: float,
    pressure: Array,
    data: Array,
    path: Array,
) -> None:
    """Follow the skirt from the toe at x = 0 to its top by Runge and Kutta's fourth order; fills ``path`` (n+1, 4).

    ``data``: drag coefficient, weight of the sheet, flexibility, code of the load law, friction.
    """
    scale, weight, flexibility, law, friction = data[0], data[1], data[2], data[3], data[4]
    x, z, along, up = 0.0, toe_height, hold, toe_load
    path[0, 0], path[0, 1], path[0, 2], path[0, 3] = x, z, along, up
    for i in range(path.shape[0] - 1):
        h = nodes[i + 1] - nodes[i]
        half, sixth = 0.5 * h, h / 6.0
        a0, a1, a2, a3 = _slopes(z, along, up, low, step, pressure, scale, weight, flexibility, law, friction)
        b0, b1, b2, b3 = _slopes(
            z + half * a1, along + half * a2, up + half * a3,
            low, step, pressure, scale, weight, flexibility, law, friction,
        )  # fmt: skip
        c0, c1, c2, c3 = _slopes(
            z + half * b1, along + half * b2, up + half * b3,
            low, step, pressure, scale, weight, flexibility, law, friction,
        )  # fmt: skip
        d0, d1, d2, d3 = _slopes(
            z + h * c1, along + h * c2, up + h * c3, low, step, pressure, scale, weight, flexibility, law, friction
        )
        x += sixth * (a0 + 2.0 * b0 + 2.0 * c0 + d0)
        z += sixth * (a1 + 2.0 * b1 + 2.0 * c1 + d1)
        along += sixth * (a2 + 2.0 * b2 + 2.0 * c2 + d2)
        up += sixth * (a3 + 2.0 * b3 + 2.0 * c3 + d3)
        path[i + 1, 0], path[i + 1, 1], path[i + 1, 2], path[i + 1, 3] = x, z, along, up


@njit(cache=True, error_model="numpy")
def hang(
    top_height: float,
    reach: float,
    hold: float,
    toe_load: float,
    nodes: Array,
    low: float,
    step: float,
    pressure: Array,
    data: Array,
    path: Array,
    guess: float,
) -> float:
    """Find the height of the toe whose skirt ends at ``top_height``; returns the miss [m], NaN without a solution.

    ``guess`` is the height in a load nearby, or NaN.
    """
    a, b = top_height - reach, top_height
    length = nodes[nodes.size - 1]
    if a < guess < b:
        # secants from nearby take a third of the climbs; what they do not find is left to the bracket
        c, last, old = guess, math.nan, math.nan
        for _ in range(8):
            climb(c, hold, toe_load, nodes, low, step, pressure, data, path)
            f = path[-1, 1] - top_height
            if abs(f) <= 1e-13 * length:
                return f
            # the top moves with the toe where nothing else is known
            move = -f if math.isnan(old) else -f * (c - last) / (f - old)
            last, old = c, f
            c += move
            if not a < c < b:
                break
    climb(a, hold, toe_load, nodes, low, step, pressure, data, path)
    fa = path[-1, 1] - top_height
    climb(b, hold, toe_load, nodes, low, step, pressure, data, path)
    fb = path[-1, 1] - top_height
    if not (fa <= 0.0 <= fb):
        return math.nan
    side = 0
    f = fb
    for _ in range(200):
        c = (fa * b - fb * a) / (fa - fb)
        if not a < c < b:
            c = 0.5 * (a + b)
        climb(c, hold, toe_load, nodes, low, step, pressure, data, path)
        f = path[-1, 1] - top_height
        if abs(f) <= 1e-13 * length or b - a <= 1e-15 * length:
            break
        # Illinois: an end that stays twice loses half of its weight
        if f > 0.0:
            b, fb = c, f
            if side == 1:
                fa *= 0.5
            side = 1
        else:
            a, fa = c, f
            if side == -1:
                fb *= 0.5
            side = -1
    return f


@njit(cache=True, error_model="numpy")
def hang_held(
    start: Array,
    turned: Array,
    top_height: float,
    reach: float,
    toe_load: float,
    nodes: Array,
    low: float,
    step: float,
    pressure: Array,
    data: Array,
    path: Array,
) -> float:
    """Find height of the toe and hold whose skirt ends under nothing but its top; returns the miss [m], NaN if none.

    Newton's steps; the derivatives come from differences at the start where ``turned`` holds NaN, and follow by
    Broyden's updates. A skirt that turns over anywhere is no solution here. ``start`` (height, hold per toe load) and
    ``turned`` (the inverse of the derivatives, per length and toe load) are those of the solution afterwards.
    """
    length = nodes[nodes.size - 1]
    toe, hold = start[0], start[1]
    if math.isnan(turned[0, 0]):
        climb(toe, hold * toe_load, toe_load, nodes, low, step, pressure, data, path)
        x, z = path[-1, 0], path[-1, 1]
        by = 1e-6 * max(abs(hold), 1e-3)
        climb(toe, (hold + by) * toe_load, toe_load, nodes, low, step, pressure, data, path)
        xh, zh = (path[-1, 0] - x) / by / length, (path[-1, 1] - z) / by / length
        climb(toe + 1e-6 * length, hold * toe_load, toe_load, nodes, low, step, pressure, data, path)
        xt, zt = (path[-1, 0] - x) / (1e-6 * length), (path[-1, 1] - z) / (1e-6 * length)
        whole = xt * zh - xh * zt
        turned[0, 0], turned[0, 1], turned[1, 0], turned[1, 1] = zh / whole, -xh / whole, -zt / whole, xt / whole
    old_x, old_z, move_toe, move_hold = 0.0, 0.0, 0.0, 0.0
    for count in range(_MOST_STEPS):
        climb(toe, hold * toe_load, toe_load, nodes, low, step, pressure, data, path)
        x, z = path[-1, 0] / length, (path[-1, 1] - top_height) / length
        if not (abs(x) < 10.0 and abs(z) < 10.0):
            return math.nan
        if count > 0:
            # Broyden: the inverse takes in what this step did, by Sherman and Morrison
            dx, dz = x - old_x, z - old_z
            p, q = turned[0, 0] * dx + turned[0, 1] * dz, turned[1, 0] * dx + turned[1, 1] * dz
            size = move_toe * p + move_hold * q
            if size != 0.0:
                left = move_toe * turned[0, 0] + move_hold * turned[1, 0]
                right = move_toe * turned[0, 1] + move_hold * turned[1, 1]
                turned[0, 0] += (move_toe - p) * left / size
                turned[0, 1] += (move_toe - p) * right / size
                turned[1, 0] += (move_hold - q) * left / size
                turned[1, 1] += (move_hold - q) * right / size
        if abs(x) <= 1e-12 and abs(z) <= 1e-13:
            for i in range(path.shape[0]):
                if not path[i, 3] > 0.0:
                    return math.nan
            start[0], start[1] = toe, hold
            return path[-1, 1] - top_height
        old_x, old_z = x, z
        move_toe, move_hold = -turned[0, 0] * x - turned[0, 1] * z, -turned[1, 0] * x - turned[1, 1] * z
        toe, hold = toe + move_toe * length, hold + move_hold
        if not (top_height - reach < toe < top_height and math.isfinite(hold)):
            return math.nan
    return math.nan
