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
def _flow_at(flow: Array, place: float) -> tuple[float, float]:
    """Velocity and acceleration of the water at a place counted in steps, by cubics through four samples."""
    last = flow.shape[0] - 1
    if last < 3:
        i = min(int(place), last - 1)
        s = place - i
        return flow[i, 0] + s * (flow[i + 1, 0] - flow[i, 0]), flow[i, 1] + s * (flow[i + 1, 1] - flow[i, 1])
    i = min(max(int(place), 1), last - 2)
    s = place - i
    a, b = -s * (s - 1.0) * (s - 2.0) / 6.0, (s + 1.0) * (s - 1.0) * (s - 2.0) / 2.0
    c, d = -(s + 1.0) * s * (s - 2.0) / 2.0, (s + 1.0) * s * (s - 1.0) / 6.0
    return (
        a * flow[i - 1, 0] + b * flow[i, 0] + c * flow[i + 1, 0] + d * flow[i + 2, 0],
        a * flow[i - 1, 1] + b * flow[i, 1] + c * flow[i + 1, 1] + d * flow[i + 2, 1],
    )


@njit(cache=True, error_model="numpy")
def load_table(span: float, span_ratio: float, taut: float, stiffness: float, out: Array) -> None:
    """Fill ``out`` (n, 5): displacement (given), load, its slope, tension, its slope.

    The rows are evenly spaced in the square of their number. Small displacements are resolved finely: the load of a
    cable as long as its span starts as a cube.
    """
    b = taut
    for i in range(out.shape[0]):
        sag = sag_ratio(taut) + 2.0 * out[i, 0] / span
        b = shape_of_sag(sag, b) if sag > 0.0 else 0.0
        tension = stiffness * span_ratio * (sinh_excess(b) - sinh_excess(taut))
        # d excess/db = (cosh b - 1 - excess)/b = (cosh b - sinh(b)/b)/b
        widening = (math.cosh(b) - 1.0 - sinh_excess(b)) / b if b > 1e-4 else b / 3.0
        # the displacement grows with b by half the span times the slope of the sag
        per_shape, stretching = _sag_slope(b) * 0.5 * span, stiffness * span_ratio * widening
        out[i, 1], out[i, 2] = tension * 2.0 * b / span, (stretching * b + tension) * 2.0 / span / per_shape
        out[i, 3], out[i, 4] = tension, stretching / per_shape


@njit(cache=True, error_model="numpy")
def _of_cable(displacement: float, cable: Array, table: Array, column: int) -> float:
    """Load (column 1) or tension (column 3) by cubics between the rows of the table, exactly beyond it."""
    if displacement <= 0.0:
        return 0.0
    last = table.shape[0] - 1
    if displacement >= table[last, 0]:
        load, tension = spring(displacement, cable[0], cable[1], cable[2], cable[3])
        return load if column == 1 else tension
    i = min(int(math.sqrt(displacement / table[last, 0]) * last), last - 1)
    if displacement < table[i, 0]:
        i -= 1
    elif displacement > table[i + 1, 0]:
        i += 1
    width = table[i + 1, 0] - table[i, 0]
    s = (displacement - table[i, 0]) / width
    far = 1.0 - s
    return far * far * ((1.0 + 2.0 * s) * table[i, column] + s * width * table[i, column + 1]) + s * s * (
        (3.0 - 2.0 * s) * table[i + 1, column] - far * width * table[i + 1, column + 1]
    )


@njit(cache=True, error_model="numpy")
def _swing(
    y: float,
    v: float,
    at: float,
    h: float,
    side: int,
    cable: Array,
    table: Array,
    drag: float,
    mass: float,
    flow: Array,
    step: float,
) -> tuple[float, float]:
    """One Runge-Kutta step of h seconds from time ``at``, the cable taut on ``side`` or slack (0)."""
    place, speed, sum_y, sum_v = y, v, 0.0, 0.0
    for stage in range(4):
        if stage != 2:
            # the two stages in the middle share their flow
            share = 0.0 if stage == 0 else 0.5 if stage == 1 else 1.0
            water, forward = _flow_at(flow, (at + share * h) / step)
        relative = water - speed
        force = drag * relative * abs(relative)
        if side != 0:
            force -= side * _of_cable(side * place - cable[4], cable, table, 1)
        rate = forward + force / mass
        weight = 1.0 if stage in (0, 3) else 2.0
        sum_y += weight * speed
        sum_v += weight * rate
        ahead = h if stage == 2 else 0.5 * h
        place, speed = y + ahead * speed, v + ahead * rate
    return y + h * sum_y / 6.0, v + h * sum_v / 6.0


@njit(cache=True, error_model="numpy")
def _locate(
    y: float,
    v: float,
    at: float,
    low: float,
    high: float,
    target: int,
    side: int,
    cable: Array,
    table: Array,
    drag: float,
    mass: float,
    flow: Array,
    step: float,
) -> float:
    """Return the h within (low, high) at which y reaches ``target`` times the slack sag, or v = 0 for ``target`` 0."""
    first = v if target == 0 else target * y - cable[4]
    if low > 0.0:
        y1, v1 = _swing(y, v, at, low, side, cable, table, drag, mass, flow, step)
        first = v1 if target == 0 else target * y1 - cable[4]
    y1, v1 = _swing(y, v, at, high, side, cable, table, drag, mass, flow, step)
    last = v1 if target == 0 else target * y1 - cable[4]
    rising = last > first
    h, before, kept = high, 0.0, 0
    if last != first:
        h = min(max(low - first * (high - low) / (last - first), low), high)
    for _ in range(100):
        y1, v1 = _swing(y, v, at, h, side, cable, table, drag, mass, flow, step)
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
        if min(high - low, moved) <= 1e-13 * step or value == 0.0:
            break
        new = low - first * (high - low) / (last - first)
        h = new if low < new < high else 0.5 * (low + high)
    return h


@njit(cache=True, error_model="numpy")
def slack_taut(
    cable: Array,
    table: Array,
    mass: float,
    drag: float,
    flow: Array,
    step: float,
    taut_step: float,
    out: Array,
    contacts: Array,
) -> int:
    """March the slack and taut curtain, every contact located in time [eq:impact-slack-taut].

    Slack, a step of the classical Runge-Kutta scheme covers the samples of the flow; taut, it is at most
    ``taut_step``. Steps end where the cable becomes taut or slack, so that no step crosses the corner of the spring.

    ``cable``: span, span ratio, taut shape, stiffness, slack sag; ``table``: see :func:`load_table`; ``flow``
    (n + 1, 2): velocity and acceleration of the water at every step; ``drag`` is rho C_D d / 2. Rows of ``out``
    (n + 1, 3): position and speed of mid-span, tension; the first row holds the start. Rows of ``contacts``: begin,
    speed there, end (NaN where the series ends before), time of the peak, tension of the peak, side. Returns the
    number of contacts that begin, which may be more than there is room for.
    """
    loose = cable[4]
    y, v = out[0, 0], out[0, 1]
    side = 0
    if abs(y) > loose:
        side = 1 if y > 0.0 else -1
    count, current = 0, -1
    furthest, when = 0.0, 0.0
    for n in range(out.shape[0]):
        out[n, 0], out[n, 1] = y, v
        out[n, 2] = _of_cable(abs(y) - loose, cable, table, 3) if side != 0 else 0.0
        if n + 1 == out.shape[0]:
            break
        done = 0.0
        while done < step * (1.0 - 1e-12):
            at = n * step + done
            left = step - done
            h = left if side == 0 else left / math.ceil(left / taut_step - 1e-9)
            y1, v1 = _swing(y, v, at, h, side, cable, table, drag, mass, flow, step)
            turned = 0.0
            if v * v1 < 0.0:
                turned = _locate(y, v, at, 0.0, h, 0, side, cable, table, drag, mass, flow, step)
                top, _ = _swing(y, v, at, turned, side, cable, table, drag, mass, flow, step)
                if side == 0:
                    if abs(y1) <= loose < abs(top):
                        # a short contact would hide between two samples
                        h, y1, v1 = turned, top, 0.0
                    if abs(top) > loose:
                        turned = 0.0
                elif side * top > furthest:
                    furthest, when = side * top, at + turned
            if side == 0:
                if abs(y1) > loose:
                    toward = 1 if y1 > 0.0 else -1
                    h = _locate(y, v, at, turned, h, toward, 0, cable, table, drag, mass, flow, step)
                    _, v1 = _swing(y, v, at, h, 0, cable, table, drag, mass, flow, step)
                    y1, side = toward * loose, toward
                    furthest, when, current = loose, at + h, count
                    if count < contacts.shape[0]:
                        contacts[count, 0], contacts[count, 1], contacts[count, 2] = at + h, v1, np.nan
                        contacts[count, 5] = side
                    count += 1
            else:
                if side * y1 < loose:
                    h = _locate(y, v, at, turned, h, side, side, cable, table, drag, mass, flow, step)
                    _, v1 = _swing(y, v, at, h, side, cable, table, drag, mass, flow, step)
                    if 0 <= current < contacts.shape[0]:
                        contacts[current, 2] = at + h
                    y1, side = side * loose, 0
                elif side * y1 > furthest:
                    furthest, when = side * y1, at + h
                if 0 <= current < contacts.shape[0]:
                    contacts[current, 3], contacts[current, 4] = when, furthest - loose
            y, v = y1, v1
            done += h
    for row in range(min(count, contacts.shape[0])):
        contacts[row, 4] = spring(contacts[row, 4], cable[0], cable[1], cable[2], cable[3])[1]
    return count
