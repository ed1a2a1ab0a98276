"""Compiled kinematics of the water about a rigid cage: current, waves one by one, waves as a series about the cage."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from moyai.core.arrays import Array
from moyai.core.compiled import njit

#: Points whose water is found together, and where their numbers begin: elevation, velocity, acceleration, place.
TILE, POINT_ROWS = 64, 7
ETA, U, W, DU, DW, X, Z = (row * TILE for row in range(POINT_ROWS))


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
    powers: Array


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
    A derivative along x + i z turns cosine into minus sine and sine into cosine: terms of even order are sums of the
    quantity itself, those of odd order of its neighbour, with the same sign twice.
    """
    step = p.series[1]
    t = number * step
    c = p.components
    terms = out.shape[1]
    half = p.powers.shape[2]
    sums = np.zeros((2, 10, half))
    own, next_ = np.empty(10), np.empty(10)
    for i in range(c.shape[1]):
        sense, sigma, omega = c[6, i], c[1, i], c[0, i]
        angle = sense * c[4, i] * p.centre[0] - omega * t + c[3, i]
        cosine, sine = c[2, i] * math.cos(angle), c[2, i] * math.sin(angle)
        across, upward = p.depth_parts[0, i], p.depth_parts[1, i]
        # cosine and sine of the complex phase s k (x + i (z + h)) - omega t + eps, over sinh kh
        speed = sense * sigma
        c_real, c_imaginary = speed * across * cosine, -speed * sense * upward * sine
        s_real, s_imaginary = speed * across * sine, speed * sense * upward * cosine
        own[0], next_[0] = cosine, -sine
        own[1], next_[1] = c_real, -s_real
        own[2], next_[2] = c_imaginary, -s_imaginary
        own[3], next_[3] = sigma * s_real, sigma * c_real
        own[4], next_[4] = sigma * s_imaginary, sigma * c_imaginary
        own[5], next_[5] = omega * sine, omega * cosine
        own[6], next_[6] = omega * s_real, omega * c_real
        own[7], next_[7] = omega * s_imaginary, omega * c_imaginary
        own[8], next_[8] = -omega * sigma * c_real, omega * sigma * s_real
        own[9], next_[9] = -omega * sigma * c_imaginary, omega * sigma * s_imaginary
        for row in range(10):
            even, odd = own[row], next_[row]
            for n in range(half):
                sums[0, row, n] += even * p.powers[0, i, n]
            for n in range(half):
                sums[1, row, n] += odd * p.powers[1, i, n]
    for row in range(10):
        for n in range(terms):
            out[row, n] = sums[n % 2, row, n // 2]


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
def _from_series(p: PackedCage, series: Array, points: Array, count: int) -> None:
    """Evaluate the series of the waves at points, side by side so that they fill the registers of a processor."""
    reach, depth = p.series[0], p.water[2]
    terms = series.shape[1]
    for i in range(count):
        points[X + i] = (points[X + i] - p.centre[0]) / reach
        points[ETA + i] = 0.0
        points[U + i] = points[W + i] = points[DU + i] = points[DW + i] = 0.0
    for n in range(terms - 1, -1, -1):
        term = series[0, n]
        for i in range(count):
            points[ETA + i] = points[ETA + i] * points[X + i] + term
    for i in range(count):
        level = points[Z + i]
        if p.water[4] == 2.0:
            here = points[ETA + i]
            level = level - here if math.isinf(depth) else (level - here) * depth / (depth + here)
        points[Z + i] = (min(max(level, -depth), 0.0) - p.centre[1]) / reach
    for n in range(terms - 1, -1, -1):
        a, b, c, d = series[1, n], series[2, n], series[3, n], series[4, n]
        for i in range(count):
            x, z = points[X + i], points[Z + i]
            v, h = points[U + i], points[W + i]
            points[U + i], points[W + i] = v * x - h * z + a, v * z + h * x + b
            v, h = points[DU + i], points[DW + i]
            points[DU + i], points[DW + i] = v * x - h * z + c, v * z + h * x + d
    for i in range(count):
        points[W + i], points[DW + i] = -points[W + i], -points[DW + i]


@njit(cache=True, error_model="numpy")
def water_motion(p: PackedCage, t: float, points: Array, count: int, series: Array) -> None:
    """Fill elevation, velocity and acceleration at up to ``TILE`` points, wave by wave or from their series.

    ``points`` holds rows of ``TILE`` numbers: the five that come back, then x and z, which change.
    """
    if series.shape[1] > 0:
        _from_series(p, series, points, count)
        return
    out = np.empty(5)
    for i in range(count):
        water_at(p, t, points[X + i], points[Z + i], out)
        for row in range(5):
            points[row * TILE + i] = out[row]
