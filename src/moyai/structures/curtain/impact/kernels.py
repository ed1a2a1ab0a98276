"""Compiled cable spring of the impact models and its energy peak, one parameter set after the other.

Given how far the middle of a just-taut cable has moved downstream, its shape is known, from the shape its stretch and
from the stretch its tension and load: an explicit hardening spring [eq:impact-spring].
"""

from __future__ import annotations

import math

import numpy as np

from moyai.core.arrays import Array
from moyai.core.compiled import njit
from moyai.structures.curtain.statics.closed_forms import sinh_excess

_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(16)
_TIME_NODES, _TIME_WEIGHTS = np.polynomial.legendre.leggauss(32)


@njit(cache=True, error_model="numpy")
def sag_ratio(b: float) -> float:
    """Sag over half the span, (cosh b - 1)/b."""
    half = math.sinh(0.5 * b)
    return 2.0 * half * half / b if b > 0.0 else 0.0


@njit(cache=True, error_model="numpy")
def _sag_slope(b: float) -> float:
    if b < 0.02:
        square = b * b
        return 0.5 + square * (0.125 + square / 144.0)
    return (math.sinh(b) - sag_ratio(b)) / b


@njit(cache=True, error_model="numpy")
def taut_shape(span_ratio: float) -> float:
    """b of the just-taut cable, sinh(b)/b = 1/R; 0 for R = 1."""
    lack = (1.0 - span_ratio) / span_ratio
    if lack <= 0.0:
        return 0.0
    b = min(math.sqrt(6.0 * lack), 2.0 + 2.0 * math.log(1.0 + lack))
    for _ in range(100):
        slope = (math.cosh(b) - 1.0 - sinh_excess(b)) / b
        step = (sinh_excess(b) - lack) / slope
        b = max(b - step, 0.1 * b)
        if abs(step) <= 4e-16 * b:
            break
    return b


@njit(cache=True, error_model="numpy")
def shape_of_sag(sag: float, guess: float) -> float:
    """b of a sag over half the span: (cosh b - 1)/b = sag."""
    b = guess if guess > 0.0 else 2.0 * sag
    for _ in range(100):
        step = (sag_ratio(b) - sag) / _sag_slope(b)
        b = max(b - step, 0.1 * b)
        # Newton squares the error: what is left is below rounding
        if abs(step) <= 1e-9 * b:
            break
    return b


@njit(cache=True, error_model="numpy")
def spring(displacement: float, span: float, span_ratio: float, taut: float, stiffness: float) -> tuple[float, float]:
    """Load per metre and tension of the cable at a displacement of its middle; slack below zero."""
    if displacement <= 0.0:
        return 0.0, 0.0
    b = shape_of_sag(sag_ratio(taut) + 2.0 * displacement / span, taut)
    tension = stiffness * span_ratio * (sinh_excess(b) - sinh_excess(taut))
    return tension * 2.0 * b / span, tension


@njit(cache=True, error_model="numpy")
def _work(b: float, span: float, span_ratio: float, taut: float, stiffness: float) -> float:
    """Integral of the load over the displacement from the just-taut shape to b."""
    half = 0.5 * (b - taut)
    total = 0.0
    for i in range(_NODES.size):
        x = taut + half * (1.0 + _NODES[i])
        load = stiffness * span_ratio * (sinh_excess(x) - sinh_excess(taut)) * 2.0 * x / span
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
        load = stiffness * ratio * (sinh_excess(b) - sinh_excess(taut)) * 2.0 * b / span
        # Newton on the square root of the work, which is nearly straight
        step = 2.0 * (work - math.sqrt(work * energy)) / (load * _sag_slope(b) * 0.5 * span)
        b -= step
        if abs(step) <= 1e-15 * b:
            break
    tension = stiffness * ratio * (sinh_excess(b) - sinh_excess(taut))
    furthest = 0.5 * span * (sag_ratio(b) - sag_ratio(taut))
    # Time by displacement = furthest sin(angle): the speed at the peak vanishes like cos(angle)
    time = 0.0
    guess = taut
    for i in range(_TIME_NODES.size):
        angle = 0.25 * math.pi * (1.0 + _TIME_NODES[i])
        guess = shape_of_sag(sag_ratio(taut) + 2.0 * furthest * math.sin(angle) / span, max(guess, 1e-9))
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
def memory_march(
    span: float,
    length: float,
    stiffness: float,
    speed: float,
    mass: float,
    kernel: Array,
    step: float,
    out: Array,
) -> int:
    """March model A with the memory of the waves [eq:impact-memory]; return the rows filled, one past the peak.

    Rows of ``out``: displacement, speed, load, tension, force of the memory; ``kernel`` at whole steps from 0. The
    displacement goes by Verlet's scheme, the memory by the trapezoidal rule; the newest speed enters linearly and is
    solved for.
    """
    ratio = span / length
    taut = taut_shape(ratio)
    place, velocity, rate = 0.0, speed, 0.0
    own = 0.5 * step * kernel[0]
    for n in range(out.shape[0]):
        if n > 0:
            place += step * (velocity + 0.5 * step * rate)
            past = 0.0
            # the first sample has the speed of the water: nothing remembered
            for j in range(1, n):
                past += kernel[n - j] * (out[j, 1] - speed)
            past *= step
            load, _ = spring(place, span, ratio, taut, stiffness)
            # v = v0 + step (a0 + a)/2 with m a = -load - past - own (v - U0)
            pull = -load - past + own * speed
            velocity = (velocity + 0.5 * step * (rate + pull / mass)) / (1.0 + 0.5 * step * own / mass)
            rate = (pull - own * velocity) / mass
            out[n, 4] = -past - own * (velocity - speed)
        else:
            out[n, 4] = 0.0
        out[n, 0], out[n, 1] = place, velocity
        out[n, 2], out[n, 3] = spring(place, span, ratio, taut, stiffness)
        if n > 1 and out[n - 1, 1] <= 0.0:
            return n + 1
    return out.shape[0]


@njit(cache=True, error_model="numpy")
def _skirt_force(sagitta: float, half: float, unstretched: float, stiffness: float) -> tuple[float, float]:
    """Generalised force on the sagitta and tension of an arc over a chord of 2 ``half`` [eq:impact-skirt-spring]."""
    radius = 0.5 * (half * half / sagitta + sagitta)
    angle = 2.0 * math.atan(sagitta / half)
    tension = stiffness * max(0.0, 2.0 * radius * angle / unstretched - 1.0)
    slope = 0.5 * (1.0 - half * half / (sagitta * sagitta))
    turn = 2.0 * half / (half * half + sagitta * sagitta)
    return tension * 2.0 * (slope * angle + radius * turn), tension


@njit(cache=True, error_model="numpy")
def _both_step(state: Array, h: float, cable: Array, skirt: Array, inverse: Array, new: Array) -> None:
    """One Runge-Kutta step of q, f, q', f' [eq:impact-cable-skirt]."""
    q, f, u, w = state[0], state[1], state[2], state[3]
    sq = sf = su = sw = 0.0
    for stage in range(4):
        load = spring(q, cable[0], cable[1], cable[2], cable[3])[0]
        force = _skirt_force(max(f, 0.25 * skirt[3]), skirt[0], skirt[1], skirt[2])[0]
        du = -(inverse[0, 0] * load + inverse[0, 1] * force)
        dw = -(inverse[1, 0] * load + inverse[1, 1] * force)
        weight = 1.0 if stage in (0, 3) else 2.0
        sq, sf, su, sw = sq + weight * u, sf + weight * w, su + weight * du, sw + weight * dw
        ahead = h if stage == 2 else 0.5 * h
        q, f, u, w = state[0] + ahead * u, state[1] + ahead * w, state[2] + ahead * du, state[3] + ahead * dw
    new[0], new[1] = state[0] + h * sq / 6.0, state[1] + h * sf / 6.0
    new[2], new[3] = state[2] + h * su / 6.0, state[3] + h * sw / 6.0


@njit(cache=True, error_model="numpy")
def cable_and_skirt(cable: Array, skirt: Array, inverse: Array, speed: float, step: float, count: int) -> Array:
    """March model AB; return furthest displacement, its time, furthest sagitta, largest skirt tension.

    ``cable``: span, span ratio, taut shape, stiffness; ``skirt``: half chord, unstretched length, stiffness, sagitta.
    """
    state = np.array([0.0, skirt[3], speed, 0.0])
    new = np.empty(4)
    best = np.array([0.0, 0.0, skirt[3], 0.0])
    for n in range(count):
        _both_step(state, step, cable, skirt, inverse, new)
        if state[2] > 0.0 >= new[2] and max(state[0], new[0]) > 0.9 * best[0]:
            # the top of the displacement, where its speed vanishes
            low, high, h = 0.0, step, step * state[2] / (state[2] - new[2])
            top = new.copy()
            for _ in range(60):
                _both_step(state, h, cable, skirt, inverse, top)
                if top[2] > 0.0:
                    low = h
                else:
                    high = h
                if high - low <= 1e-9 * step or top[2] == 0.0:
                    break
                h = 0.5 * (low + high)
            if top[0] > best[0]:
                best[0], best[1] = top[0], n * step + h
        best[2] = max(best[2], new[1])
        state[:] = new
    best[3] = _skirt_force(best[2], skirt[0], skirt[1], skirt[2])[1]
    return best


@njit(cache=True, error_model="numpy")
def _cubics_of_flow(flow: Array, n: int, out: Array) -> float:
    """Fill the cubics through four samples about step ``n``: of the water's velocity, then of its acceleration.

    They are polynomials of a place counted in steps from the second of the four samples; returns that of sample ``n``.
    """
    last = flow.shape[0] - 1
    out[:] = 0.0
    if last < 3:
        i = min(n, last - 1)
        for column in range(2):
            out[4 * column], out[4 * column + 1] = flow[i, column], flow[i + 1, column] - flow[i, column]
        return float(n - i)
    i = min(max(n, 1), last - 2)
    for column in range(2):
        a, b, c, d = flow[i - 1, column], flow[i, column], flow[i + 1, column], flow[i + 2, column]
        first = 4 * column
        out[first] = b
        out[first + 1] = c - a / 3.0 - b / 2.0 - d / 6.0
        out[first + 2] = 0.5 * (a + c) - b
        out[first + 3] = (d - a) / 6.0 + 0.5 * (b - c)
    return float(n - i)


@njit(cache=True, error_model="numpy")
def load_table(span: float, span_ratio: float, taut: float, stiffness: float, reach: float, out: Array) -> None:
    """Fill ``out`` (n, 9): a displacement, and cubics of the load and of the tension beyond it up to the next one.

    The displacements, from zero to ``reach``, are evenly spaced in the square of their number. Small ones are resolved
    finely: the load of a cable as long as its span starts as a cube. Cubics meet load, tension and their slopes.
    """
    b, last = taut, out.shape[0]
    ends = np.zeros((2, 5))
    for i in range(last + 1):
        ends[0] = ends[1]
        place = reach * (i / last) ** 2
        sag = sag_ratio(taut) + 2.0 * place / span
        b = shape_of_sag(sag, b) if sag > 0.0 else 0.0
        tension = stiffness * span_ratio * (sinh_excess(b) - sinh_excess(taut))
        # d excess/db = (cosh b - 1 - excess)/b = (cosh b - sinh(b)/b)/b
        widening = (math.cosh(b) - 1.0 - sinh_excess(b)) / b if b > 1e-4 else b / 3.0
        # the displacement grows with b by half the span times the slope of the sag
        per_shape, stretching = _sag_slope(b) * 0.5 * span, stiffness * span_ratio * widening
        ends[1, 0] = place
        ends[1, 1], ends[1, 2] = tension * 2.0 * b / span, (stretching * b + tension) * 2.0 / span / per_shape
        ends[1, 3], ends[1, 4] = tension, stretching / per_shape
        if i == 0:
            continue
        out[i - 1, 0] = ends[0, 0]
        width = place - ends[0, 0]
        for column in (1, 3):
            rise = (ends[1, column] - ends[0, column]) / width
            low, high = ends[0, column + 1], ends[1, column + 1]
            first = 1 if column == 1 else 5
            out[i - 1, first], out[i - 1, first + 1] = ends[0, column], low
            out[i - 1, first + 2], out[i - 1, first + 3] = (
                (3.0 * rise - 2.0 * low - high) / width, (low + high - 2.0 * rise) / width**2,
            )  # fmt: skip


@njit(cache=True, error_model="numpy")
def _of_cable(displacement: float, cable: Array, table: Array, first: int) -> float:
    """Load (``first`` 1) or tension (5) by the cubics of the table, exactly beyond it."""
    if displacement <= 0.0:
        return 0.0
    reach, last = cable[5], table.shape[0]
    if displacement >= reach:
        load, tension = spring(displacement, cable[0], cable[1], cable[2], cable[3])
        return load if first == 1 else tension
    i = min(int(math.sqrt(displacement * cable[7]) * last), last - 1)
    x = displacement - table[i, 0]
    return table[i, first] + x * (table[i, first + 1] + x * (table[i, first + 2] + x * table[i, first + 3]))


@njit(cache=True, error_model="numpy")
def _swing(
    y: float, v: float, at: float, h: float, side: int, cable: Array, table: Array, drag: float, flow: Array,
    per_step: float,
) -> tuple[float, float]:  # fmt: skip
    """One Runge-Kutta step of h seconds from place ``at`` of the flow's cubics, taut on ``side`` or slack (0).

    ``drag`` is over the mass that moves, ``per_step`` one over the step of the flow.
    """
    place, speed, sum_y, sum_v = y, v, 0.0, 0.0
    half, sense = 0.5 * h, float(side)
    for stage in range(4):
        if stage != 2:
            # the two stages in the middle share their flow
            s = at + (0.0 if stage == 0 else half if stage == 1 else h) * per_step
            water = flow[0] + s * (flow[1] + s * (flow[2] + s * flow[3]))
            forward = flow[4] + s * (flow[5] + s * (flow[6] + s * flow[7]))
        relative = water - speed
        rate = forward + drag * relative * abs(relative)
        if side != 0:
            rate -= sense * _of_cable(sense * place - cable[4], cable, table, 1) * cable[6]
        weight = 1.0 if stage in (0, 3) else 2.0
        sum_y += weight * speed
        sum_v += weight * rate
        ahead = h if stage == 2 else half
        place, speed = y + ahead * speed, v + ahead * rate
    third = half / 3.0
    return y + third * sum_y, v + third * sum_v


@njit(cache=True, error_model="numpy")
def _locate(
    y: float, v: float, at: float, low: float, high: float, target: int, side: int, cable: Array, table: Array,
    drag: float, flow: Array, per_step: float,
) -> float:  # fmt: skip
    """Return the h within (low, high) at which y reaches ``target`` times the slack sag, or v = 0 for ``target`` 0."""
    first = v if target == 0 else target * y - cable[4]
    if low > 0.0:
        y1, v1 = _swing(y, v, at, low, side, cable, table, drag, flow, per_step)
        first = v1 if target == 0 else target * y1 - cable[4]
    y1, v1 = _swing(y, v, at, high, side, cable, table, drag, flow, per_step)
    last = v1 if target == 0 else target * y1 - cable[4]
    rising = last > first
    h, before, kept = high, 0.0, 0
    if last != first:
        h = min(max(low - first * (high - low) / (last - first), low), high)
    for _ in range(100):
        y1, v1 = _swing(y, v, at, h, side, cable, table, drag, flow, per_step)
        value = v1 if target == 0 else target * y1 - cable[4]
        moved = abs(h - before)
        before = h
        # the straight line through both ends, its older end halved where it stays (Illinois)
        if (value > 0.0) == rising:
            high, last = h, value
            first = 0.5 * first if kept > 0 else first
            kept = 1
        else:
            low, first = h, value
            last = 0.5 * last if kept < 0 else last
            kept = -1
        if min(high - low, moved) * per_step <= 1e-13 or value == 0.0:
            break
        new = low - first * (high - low) / (last - first)
        h = new if low < new < high else 0.5 * (low + high)
    return h


@njit(cache=True, error_model="numpy")
def _over_two_samples(
    y: float, v: float, at: float, side: int, cable: Array, table: Array, drag: float, flow: Array, step: float,
    taut_step: float,
) -> tuple[float, float, bool]:  # fmt: skip
    """Return place and speed two samples on by one step, and whether it stays far from any contact or turn."""
    h, loose = 2.0 * step, cable[4]
    if side != 0 and h > taut_step:
        return y, v, False
    y2, v2 = _swing(y, v, at, h, side, cable, table, drag, flow, 1.0 / step)
    if side == 0:
        return y2, v2, abs(y) + 2.0 * h * (abs(v) + abs(v2)) < loose
    return y2, v2, side * y2 > loose and v * v2 > 0.0


@njit(cache=True, error_model="numpy")
def _write_between(
    y: float, v: float, y2: float, v2: float, step: float, side: int, cable: Array, table: Array, row: Array
) -> None:  # fmt: skip
    """Write the row of the sample between two others, by the cubic through their places and speeds."""
    row[0], row[1] = 0.5 * (y + y2) + 0.25 * step * (v - v2), 0.75 * (y2 - y) / step - 0.25 * (v + v2)
    row[2] = _of_cable(abs(row[0]) - cable[4], cable, table, 5) if side != 0 else 0.0


@njit(cache=True, error_model="numpy")
def slack_taut(
    cable: Array, table: Array, drag: float, flow: Array, step: float, taut_step: float, out: Array, contacts: Array
) -> int:  # fmt: skip
    """March the slack and taut curtain, every contact located in time [eq:impact-slack-taut].

    A step of the classical Runge-Kutta scheme covers two samples of the flow far from contacts and turns, else one;
    taut, it is at most ``taut_step``. Steps end where the cable becomes taut or slack, so that no step crosses the
    corner of the spring.

    ``cable``: span, span ratio, taut shape, stiffness, slack sag, reach of the table, one over the mass and over the
    reach; ``table``: see :func:`load_table`; ``drag`` is rho C_D d / 2 over the mass; ``flow`` (n + 1, 2): velocity and
    acceleration of the water at every step. Rows of ``out`` (n + 1, 3): position and speed of mid-span, tension; the
    first row holds the start. Rows of ``contacts``: begin, speed there, end (NaN where the series ends before), time of
    the peak, tension of the peak, side. Returns the number of contacts that begin, which may be more than there is room
    for.
    """
    loose = cable[4]
    y, v = out[0, 0], out[0, 1]
    side = 0
    if abs(y) > loose:
        side = 1 if y > 0.0 else -1
    count, current = 0, -1
    furthest, when = 0.0, 0.0
    cubics, per_step = np.empty(8), 1.0 / step
    skipped = False
    for n in range(out.shape[0]):
        if skipped:
            skipped = False
            continue
        out[n, 0], out[n, 1] = y, v
        out[n, 2] = _of_cable(abs(y) - loose, cable, table, 5) if side != 0 else 0.0
        if n + 1 == out.shape[0]:
            break
        done, begin = 0.0, _cubics_of_flow(flow, n, cubics)
        if n + 2 < out.shape[0]:
            y2, v2, skipped = _over_two_samples(y, v, begin, side, cable, table, drag, cubics, step, taut_step)
            if skipped:
                _write_between(y, v, y2, v2, step, side, cable, table, out[n + 1])
                y, v = y2, v2
                if side != 0 and side * y > furthest:
                    furthest, when = side * y, (n + 2) * step
                    if 0 <= current < contacts.shape[0]:
                        contacts[current, 3], contacts[current, 4] = when, furthest - loose
                continue
        while done < step * (1.0 - 1e-12):
            at, now = begin + done * per_step, n * step + done
            left = step - done
            h = left if side == 0 else left / math.ceil(left / taut_step - 1e-9)
            y1, v1 = _swing(y, v, at, h, side, cable, table, drag, cubics, per_step)
            turned = 0.0
            # slack, a turn far from the cable hides no contact
            near = side != 0 or abs(y) + 2.0 * h * (abs(v) + abs(v1)) > loose
            if v * v1 < 0.0 and near:
                turned = _locate(y, v, at, 0.0, h, 0, side, cable, table, drag, cubics, per_step)
                top, _ = _swing(y, v, at, turned, side, cable, table, drag, cubics, per_step)
                if side == 0:
                    if abs(y1) <= loose < abs(top):
                        # a short contact would hide between two samples
                        h, y1, v1 = turned, top, 0.0
                    if abs(top) > loose:
                        turned = 0.0
                elif side * top > furthest:
                    furthest, when = side * top, now + turned
            if side == 0:
                if abs(y1) > loose:
                    toward = 1 if y1 > 0.0 else -1
                    h = _locate(y, v, at, turned, h, toward, 0, cable, table, drag, cubics, per_step)
                    _, v1 = _swing(y, v, at, h, 0, cable, table, drag, cubics, per_step)
                    y1, side = toward * loose, toward
                    furthest, when, current = loose, now + h, count
                    if count < contacts.shape[0]:
                        contacts[count, 0], contacts[count, 1], contacts[count, 2] = now + h, v1, np.nan
                        contacts[count, 5] = side
                    count += 1
            else:
                if side * y1 < loose:
                    h = _locate(y, v, at, turned, h, side, side, cable, table, drag, cubics, per_step)
                    _, v1 = _swing(y, v, at, h, side, cable, table, drag, cubics, per_step)
                    if 0 <= current < contacts.shape[0]:
                        contacts[current, 2] = now + h
                    y1, side = side * loose, 0
                elif side * y1 > furthest:
                    furthest, when = side * y1, now + h
                if 0 <= current < contacts.shape[0]:
                    contacts[current, 3], contacts[current, 4] = when, furthest - loose
            y, v = y1, v1
            done += h
    for row in range(min(count, contacts.shape[0])):
        contacts[row, 4] = spring(contacts[row, 4], cable[0], cable[1], cable[2], cable[3])[1]
    return count
