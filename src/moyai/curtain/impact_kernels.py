"""Compiled cable spring of the impact models and its energy peak, one parameter set after the other.

Given how far the middle of a just-taut cable has moved downstream, its shape is known, from the shape its stretch and
from the stretch its tension and load: an explicit hardening spring [eq:impact-spring].
"""

from __future__ import annotations

import math

import numpy as np
from numba import njit
from numpy.typing import NDArray

Array = NDArray[np.float64]

_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(16)
_TIME_NODES, _TIME_WEIGHTS = np.polynomial.legendre.leggauss(32)


@njit(cache=True, error_model="numpy")
def _excess(b: float) -> float:
    """sinh(b)/b - 1."""
    if b > 1.0:
        return math.sinh(b) / b - 1.0
    square = b * b
    total = 0.0
    for n in range(10, 0, -1):
        total = square / ((2 * n) * (2 * n + 1)) * (1.0 + total)
    return total


@njit(cache=True, error_model="numpy")
def _sag(b: float) -> float:
    """Sag over half the span, (cosh b - 1)/b."""
    half = math.sinh(0.5 * b)
    return 2.0 * half * half / b if b > 0.0 else 0.0


@njit(cache=True, error_model="numpy")
def _sag_slope(b: float) -> float:
    if b < 0.02:
        square = b * b
        return 0.5 + square * (0.125 + square / 144.0)
    return (math.sinh(b) - _sag(b)) / b


@njit(cache=True, error_model="numpy")
def taut_shape(span_ratio: float) -> float:
    """b of the just-taut cable, sinh(b)/b = 1/R; 0 for R = 1."""
    lack = (1.0 - span_ratio) / span_ratio
    if lack <= 0.0:
        return 0.0
    b = min(math.sqrt(6.0 * lack), 2.0 + 2.0 * math.log(1.0 + lack))
    for _ in range(100):
        slope = (math.cosh(b) - 1.0 - _excess(b)) / b
        step = (_excess(b) - lack) / slope
        b = max(b - step, 0.1 * b)
        if abs(step) <= 4e-16 * b:
            break
    return b


@njit(cache=True, error_model="numpy")
def shape_of_sag(sag: float, guess: float) -> float:
    """b of a sag over half the span: (cosh b - 1)/b = sag."""
    b = guess if guess > 0.0 else 2.0 * sag
    for _ in range(100):
        step = (_sag(b) - sag) / _sag_slope(b)
        b = max(b - step, 0.1 * b)
        if abs(step) <= 4e-16 * b:
            break
    return b


@njit(cache=True, error_model="numpy")
def spring(displacement: float, span: float, span_ratio: float, taut: float, stiffness: float) -> tuple[float, float]:
    """Load per metre and tension of the cable at a displacement of its middle; slack below zero."""
    if displacement <= 0.0:
        return 0.0, 0.0
    b = shape_of_sag(_sag(taut) + 2.0 * displacement / span, taut)
    tension = stiffness * span_ratio * (_excess(b) - _excess(taut))
    return tension * 2.0 * b / span, tension


@njit(cache=True, error_model="numpy")
def _work(b: float, span: float, span_ratio: float, taut: float, stiffness: float) -> float:
    """Integral of the load over the displacement from the just-taut shape to b."""
    half = 0.5 * (b - taut)
    total = 0.0
    for i in range(_NODES.size):
        x = taut + half * (1.0 + _NODES[i])
        load = stiffness * span_ratio * (_excess(x) - _excess(taut)) * 2.0 * x / span
        total += _WEIGHTS[i] * load * _sag_slope(x)
    return total * half * 0.5 * span


@njit(cache=True, error_model="numpy")
def energy_peak(
    span: float, length: float, stiffness: float, speed: float, mass: float
) -> tuple[float, float, float, float]:
    """Tension [N], displacement [m], time [s] of the peak of model A, and its load [N/m] [eq:impact-energy]."""
    ratio = span / length
    taut = taut_shape(ratio)
    energy = 0.5 * mass * speed * speed
    # The root of the energy from above: the work is convex in b beyond the taut shape
    b = taut + 0.1
    while _work(b, span, ratio, taut, stiffness) < energy:
        b = taut + 2.0 * (b - taut)
    for _ in range(100):
        work = _work(b, span, ratio, taut, stiffness)
        load = stiffness * ratio * (_excess(b) - _excess(taut)) * 2.0 * b / span
        # Newton on the square root of the work, which is nearly straight
        step = 2.0 * (work - math.sqrt(work * energy)) / (load * _sag_slope(b) * 0.5 * span)
        b -= step
        if abs(step) <= 1e-15 * b:
            break
    tension = stiffness * ratio * (_excess(b) - _excess(taut))
    furthest = 0.5 * span * (_sag(b) - _sag(taut))
    # Time by displacement = furthest sin(angle): the speed at the peak vanishes like cos(angle)
    time = 0.0
    guess = taut
    for i in range(_TIME_NODES.size):
        angle = 0.25 * math.pi * (1.0 + _TIME_NODES[i])
        guess = shape_of_sag(_sag(taut) + 2.0 * furthest * math.sin(angle) / span, max(guess, 1e-9))
        left = energy - _work(guess, span, ratio, taut, stiffness)
        time += _TIME_WEIGHTS[i] * math.cos(angle) / math.sqrt(2.0 * max(left, 1e-300) / mass)
    return tension, furthest, time * 0.25 * math.pi * furthest, tension * 2.0 * b / span


@njit(cache=True, error_model="numpy")
def energy_peaks(span: Array, length: Array, stiffness: Array, speed: Array, mass: Array, out: Array) -> None:
    """Fill ``out`` (n, 4) with :func:`energy_peak` of every parameter set."""
    for i in range(span.size):
        out[i, 0], out[i, 1], out[i, 2], out[i, 3] = energy_peak(span[i], length[i], stiffness[i], speed[i], mass[i])


@njit(cache=True, error_model="numpy")
def march(
    span: float, length: float, stiffness: float, speed: float, mass: float, step: float, count: int, out: Array
) -> None:
    """March model A as the paper does [eq:impact-march]; rows of ``out``: time, displacement, speed, load, tension.

    Within a step the load of the cable and the deceleration must agree; their difference grows steadily with the
    displacement, and the root is found by Newton's method between brackets.
    """
    ratio = span / length
    taut = taut_shape(ratio)
    place = 0.0
    for n in range(count):
        # At the end of free drift the water still has to be slowed down; at rest where nothing moves nothing is loaded
        low, high = min(0.0, -place), 0.0
        high = max(speed * step, 0.0)
        low = min(low, speed * step) - 1e-300
        rate = 2.0 * mass / (step * step)
        x = 0.5 * (low + high)
        for _ in range(200):
            load, tension = spring(place + x, span, ratio, taut, stiffness)
            value = load + rate * (x - speed * step)
            if value > 0.0:
                high = x
            else:
                low = x
            small = 1e-7 * (abs(place) + abs(x)) + 1e-15
            ahead, _ = spring(place + x + small, span, ratio, taut, stiffness)
            new = x - value / ((ahead - load) / small + rate)
            if not (low < new < high):
                new = 0.5 * (low + high)
            if abs(new - x) <= 1e-15 * (abs(place) + abs(x)):
                x = new
                break
            x = new
        acceleration = 2.0 * (x - speed * step) / (step * step)
        place += x
        speed += acceleration * step
        load, tension = spring(place, span, ratio, taut, stiffness)
        out[n, 0] = (n + 1) * step
        out[n, 1] = place
        out[n, 2] = speed
        out[n, 3] = load
        out[n, 4] = tension


@njit(cache=True, error_model="numpy")
def slack_taut(
    span: float, length: float, stiffness: float, mass: float, drag: float, flow: Array, step: float, out: Array
) -> None:
    """March the slack and taut curtain by the classical Runge-Kutta scheme [eq:impact-slack-taut].

    ``flow`` (2 n + 1, 2) holds velocity and acceleration of the water at every half step, ``drag`` is rho C_D d / 2;
    rows of ``out`` (n + 1, 3): position and speed of mid-span, tension. The first row is the start.
    """
    ratio = span / length
    taut = taut_shape(ratio)
    loose = 0.5 * span * _sag(taut)
    y, v = out[0, 0], out[0, 1]
    for n in range(out.shape[0]):
        side = abs(y) - loose
        out[n, 0] = y
        out[n, 1] = v
        out[n, 2] = spring(side, span, ratio, taut, stiffness)[1]
        if n + 1 == out.shape[0]:
            break
        place, speed, sum_y, sum_v = y, v, 0.0, 0.0
        for stage in range(4):
            at = 2 * n + (0 if stage == 0 else 2 if stage == 3 else 1)
            load = spring(abs(place) - loose, span, ratio, taut, stiffness)[0]
            relative = flow[at, 0] - speed
            rate = flow[at, 1] + (drag * relative * abs(relative) - math.copysign(load, place)) / mass
            weight = 1.0 if stage in (0, 3) else 2.0
            sum_y += weight * speed
            sum_v += weight * rate
            ahead = step if stage == 2 else 0.5 * step
            place, speed = y + ahead * speed, v + ahead * rate
        y += step * sum_y / 6.0
        v += step * sum_v / 6.0
