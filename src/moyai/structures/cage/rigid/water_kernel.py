"""Compiled kinematics of the water about a rigid cage: current, waves one by one, waves as a series about the cage."""

from __future__ import annotations

import math
from typing import NamedTuple

from moyai.core.arrays import Array
from moyai.core.compiled import njit


class PackedCage(NamedTuple):
    """A cage, its lines and its water as flat arrays (SI); columns as the ``*_COLUMNS`` of ``pack.py`` say."""

    spheres: Array
    patches: Array
    rods: Array
    blocks: Array
    lines: Array
    body: Array
    water: Array
    current: Array
    components: Array
    normal_table: Array
    tangential_table: Array
    table_axis: Array
    series: Array
    centre: Array
    depth_parts: Array
    summed_at: Array
    summed: Array


@njit(cache=True, error_model="numpy", inline="always")
def current_at(current: Array, z: float) -> float:
    """Interpolate the current [m/s] over rising heights; constant beyond the ends."""
    last = current.shape[1] - 1
    if last == 0 or z <= current[0, 0]:
        return current[1, 0]
    if z >= current[0, last]:
        return current[1, last]
    i = 0
    while current[0, i + 1] < z:
        i += 1
    share = (z - current[0, i]) / (current[0, i + 1] - current[0, i])
    return current[1, i] + share * (current[1, i + 1] - current[1, i])


@njit(cache=True, error_model="numpy")
def water_at(p: PackedCage, t: float, x: float, z: float, out: Array) -> None:
    """Fill elevation, velocity and acceleration of the waves at a point [eq:cage-water].

    Kinematics above still water are those at still water (code 0) or stretched (code 2).
    """
    depth, ramp, stretching = p.water[2], p.water[3], p.water[4]
    grown = 1.0
    if ramp > 0.0 and t < ramp:
        grown = 0.5 * (1.0 - math.cos(math.pi * max(t, 0.0) / ramp))
    c = p.components
    count = c.shape[1]
    out[:] = 0.0
    if grown == 0.0 or count == 0:
        return
    level = z
    if stretching == 2.0:
        eta = 0.0
        for i in range(count):
            eta += c[2, i] * math.cos(c[6, i] * c[4, i] * x - c[0, i] * t + c[3, i])
        eta *= grown
        level = z - eta if math.isinf(depth) else (z - eta) * depth / (depth + eta)
    if level > 0.0:
        level = 0.0
    if level < -depth:
        level = -depth
    for i in range(count):
        number, sigma = c[4, i], c[1, i]
        angle = c[6, i] * number * x - c[0, i] * t + c[3, i]
        amplitude = grown * c[2, i]
        real, imaginary = amplitude * math.cos(angle), amplitude * math.sin(angle)
        lift = math.exp(number * level)
        # c[5] = e^{-2kh}: cosh and sinh of k(z + h) over sinh kh without growing exponentials
        below = c[5, i] / lift
        across, upward = (lift + below) / (1.0 - c[5, i]), (lift - below) / (1.0 - c[5, i])
        sense = c[6, i]
        out[0] += real
        out[1] += sense * sigma * across * real
        out[2] += sigma * upward * imaginary
        out[3] += sense * sigma * sigma * across * imaginary
        out[4] -= sigma * sigma * upward * real


@njit(cache=True, error_model="numpy")
def _centre_waves(p: PackedCage, x: float, z: float) -> None:
    """Move the middle of the series to a point: depth functions of every wave there, and nothing summed yet."""
    depth = p.water[2]
    z = min(max(z, -depth), 0.0)
    p.centre[0], p.centre[1] = x, z
    c = p.components
    for i in range(c.shape[1]):
        lift = math.exp(c[4, i] * z)
        below = c[5, i] / lift
        p.depth_parts[0, i] = (lift + below) / (1.0 - c[5, i])
        p.depth_parts[1, i] = (lift - below) / (1.0 - c[5, i])
    p.summed_at[:] = math.inf


@njit(cache=True, error_model="numpy")
def _sum_waves(p: PackedCage, number: float, out: Array) -> None:
    """Sum the waves at a time of the grid into the coefficients of their series [eq:cage-series-of-waves].

    Rows of ``out``: elevation, velocity u - i w (real, imaginary), acceleration (real, imaginary); then their rates.
    """
    reach, step = p.series[0], p.series[1]
    t = number * step
    c = p.components
    terms = out.shape[1]
    out[:] = 0.0
    for i in range(c.shape[1]):
        sense, sigma, omega = c[6, i], c[1, i], c[0, i]
        angle = sense * c[4, i] * p.centre[0] - omega * t + c[3, i]
        cosine, sine = c[2, i] * math.cos(angle), c[2, i] * math.sin(angle)
        across, upward = p.depth_parts[0, i], p.depth_parts[1, i]
        # cosine and sine of the complex phase s k (x + i (z + h)) - omega t + eps, over sinh kh
        c_real, c_imaginary = across * cosine, -sense * upward * sine
        s_real, s_imaginary = across * sine, sense * upward * cosine
        factor = 1.0
        speed = sense * sigma
        for n in range(terms):
            out[0, n] += factor * cosine
            out[1, n] += factor * speed * c_real
            out[2, n] += factor * speed * c_imaginary
            out[3, n] += factor * speed * sigma * s_real
            out[4, n] += factor * speed * sigma * s_imaginary
            out[5, n] += factor * omega * sine
            out[6, n] += factor * speed * omega * s_real
            out[7, n] += factor * speed * omega * s_imaginary
            out[8, n] -= factor * speed * sigma * omega * c_real
            out[9, n] -= factor * speed * sigma * omega * c_imaginary
            # next derivative along x + i z: cosine to minus sine, sine to cosine
            cosine, sine = -sine, cosine
            c_real, s_real = -s_real, c_real
            c_imaginary, s_imaginary = -s_imaginary, c_imaginary
            factor *= sense * c[4, i] * reach / (n + 1.0)


@njit(cache=True, error_model="numpy")
def fill_series(p: PackedCage, t: float, x: float, z: float, out: Array) -> None:
    """Fill the coefficients at a time for a cage at a place, between two times of the grid by Hermite's cubic."""
    step, margin, ramp = p.series[1], p.series[2], p.water[3]
    if not math.hypot(x - p.centre[0], min(max(z, -p.water[2]), 0.0) - p.centre[1]) <= margin:
        _centre_waves(p, x, z)
    slots = p.summed_at.size
    first = math.floor(t / step)
    for number in (first, first + 1):
        slot = int(number) % slots
        if p.summed_at[slot] != number:
            _sum_waves(p, float(number), p.summed[slot])
            p.summed_at[slot] = number
    low, high = p.summed[int(first) % slots], p.summed[int(first + 1) % slots]
    grown = 1.0
    if ramp > 0.0 and t < ramp:
        grown = 0.5 * (1.0 - math.cos(math.pi * max(t, 0.0) / ramp))
    s = t / step - first
    rest = 1.0 - s
    a, b = grown * rest * rest * (1.0 + 2.0 * s), grown * s * s * (3.0 - 2.0 * s)
    d, e = grown * step * s * rest * rest, -grown * step * s * s * rest
    for row in range(5):
        for n in range(out.shape[1]):
            out[row, n] = a * low[row, n] + b * high[row, n] + d * low[row + 5, n] + e * high[row + 5, n]


@njit(cache=True, error_model="numpy")
def _from_series(p: PackedCage, x: float, z: float, series: Array, out: Array) -> None:
    """Evaluate the series of the waves at a point."""
    reach, depth = p.series[0], p.water[2]
    terms = series.shape[1]
    along = (x - p.centre[0]) / reach
    eta = 0.0
    for n in range(terms - 1, -1, -1):
        eta = eta * along + series[0, n]
    level = z
    if p.water[4] == 2.0:
        level = z - eta if math.isinf(depth) else (z - eta) * depth / (depth + eta)
    up = (min(max(level, -depth), 0.0) - p.centre[1]) / reach
    u, w, first, second = 0.0, 0.0, 0.0, 0.0
    for n in range(terms - 1, -1, -1):
        u, w = u * along - w * up + series[1, n], u * up + w * along + series[2, n]
        first, second = first * along - second * up + series[3, n], first * up + second * along + series[4, n]
    out[0] = eta
    out[1], out[2], out[3], out[4] = u, -w, first, -second


@njit(cache=True, error_model="numpy", inline="always")
def water_motion(p: PackedCage, t: float, x: float, z: float, series: Array, out: Array) -> None:
    """Fill elevation, velocity and acceleration at a point, wave by wave or from their series."""
    if series.shape[1] > 0:
        _from_series(p, x, z, series, out)
    else:
        water_at(p, t, x, z, out)
