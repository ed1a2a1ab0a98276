"""Lines of several segments with clump weights or buoys between them: exact, by the two forces at the fairlead.

The state of a line is fixed by its horizontal tension H and a number q: the vertical tension at the anchor when the
line is lifted (q >= 0), or minus the reaction of the bed when the line rests on it (q < 0). Walking up from the anchor
gives the position of the fairlead and its derivatives in closed form ``[eq:mooring-segments]``. Z grows with q at fixed
H, and X grows with H when q follows Z, so that two nested bracketed Newton searches find the one solution from any
start.

Columns of ``data`` (one row a segment, from the anchor): unstretched length [m], EA [N], submerged weight [N/m], weight
of the clump at its upper end [N] (negative: buoy; not used for the last segment).
"""

from __future__ import annotations

import numpy as np

from moyai.core.arrays import Array, IntArray
from moyai.core.compiled import njit
from moyai.mooring.kernels import (
    BELOW_BED,
    GROUNDED,
    INVALID,
    NOT_CONVERGED,
    SLACK_ON_BED,
    SLACK_VERTICAL,
    SLACK_WEIGHTLESS,
    STRAIGHT,
    STRETCHED,
    SUSPENDED,
    TAUT_VERTICAL,
    TOUCHES_BETWEEN,
    UNREACHABLE,
)

_NEUTRAL = 1e-6  # share of the mean weight given to neutrally buoyant segments of slack lines
_X, _Z, _F11, _F12, _F21, _F22, _GROUND, _H_ANCHOR, _V_ANCHOR, _V_FAIRLEAD, _LOWEST = range(11)


@njit(cache=True, error_model="numpy")
def hanging_piece(h: float, v: float, w: float, axial: float, s: float, out: Array) -> None:
    """Write (dx, dz, f11, f12, f22, lowest) of a piece of unstretched length s with vertical force v at its lower end.

    ``lowest`` is the height of its lowest inner point relative to its lower end (0 when it is an end).
    """
    sign = 1.0 if w >= 0.0 else -1.0  # a buoyant piece is the mirror image of a heavy one
    low = sign * v
    up = low + sign * w * s
    t0 = np.hypot(h, low)
    t1 = np.hypot(h, up)
    total = t0 + t1
    mean = 0.5 * (low + up)
    load = sign * w * s
    out[5] = 0.0
    if total == 0.0:
        out[0] = 0.0
        out[1] = 0.0
        out[2] = np.inf
        out[3] = 0.0
        out[4] = np.inf
        return
    out[1] = sign * mean * s * (2.0 / total + 1.0 / axial)
    if h == 0.0:
        out[0] = 0.0
        out[2] = np.inf
        out[3] = 0.0
        out[4] = s / axial + ((np.sign(up) - np.sign(low)) * s / load if load > 0.0 else 0.0)
    elif load < 1e-14 * total:  # straight
        tension = 0.5 * total
        out[0] = h * s * (1.0 / tension + 1.0 / axial)
        out[2] = s * (1.0 / axial + mean * mean / tension**3)
        out[3] = -sign * h * mean * s / tension**3
        out[4] = s * (1.0 / axial + h * h / tension**3)
    else:
        p = t0 + low if low > 0.0 else h * h / (t0 - low)
        q = t1 - up if up < 0.0 else h * h / (t1 + up)
        angle = np.log1p(2.0 * load / (p + q))
        out[0] = h * s * (angle / load + 1.0 / axial)
        product = t0 * t1
        if angle > 0.5:
            sines = up / t1 - low / t0
            curved = angle - sines
        else:
            sinh = 2.0 * total * load / ((p + q) * (total + load))
            sines = sinh * h * h / product
            squares = (h * h * (up * up + low * low) + up * up * low * low) / (product + h * h)
            n = angle * angle
            curved = sinh * squares / product - angle * n / 6.0 * (
                1.0 + n / 20.0 * (1.0 + n / 42.0 * (1.0 + n / 72.0 * (1.0 + n / 110.0)))
            )
        out[2] = s * (1.0 / axial + curved / load)
        out[3] = -sign * 2.0 * h * mean * s / (total * product)
        out[4] = s * (1.0 / axial + sines / load)
    if w > 0.0 and low < 0.0 and up > 0.0:
        out[5] = -low * low / w * (1.0 / (t0 + h) + 0.5 / axial)


@njit(cache=True, error_model="numpy")
def walk(h: float, q: float, data: Array, bed: bool, friction: float, state: Array, piece: Array) -> None:
    """Walk from anchor to fairlead at (H, q) and write position, flexibility and ends into ``state``."""
    n = data.shape[0]
    for i in range(state.size):
        state[i] = 0.0
    reaction = -q if (bed and q < 0.0) else 0.0
    v = 0.0 if reaction > 0.0 else q
    last = -1  # segment that holds the touchdown
    rest = 0.0  # grounded part of it
    partial_clump = False
    for i in range(n):
        if reaction <= 0.0:
            break
        last = i
        w = data[i, 2]
        rest = min(data[i, 0], reaction / w) if w > 0.0 else 0.0
        reaction -= rest * w
        if rest < data[i, 0]:
            reaction = 0.0
            break
        if i < n - 1 and data[i, 3] > 0.0:
            carried = min(data[i, 3], reaction)
            reaction -= carried
            if reaction <= 0.0:  # the clump rests on the bed in part
                partial_clump = True
                v = data[i, 3] - carried
                break
        elif i < n - 1:
            v = 0.0
    x = 0.0
    z = 0.0
    lowest = 0.0
    if last >= 0:
        _add_bed(h, last, rest, partial_clump, v, data, friction, state)
        x = state[_X]
    first = 0 if last < 0 else last
    for i in range(first, n):
        s = data[i, 0]
        if i == last:
            s -= rest
            if s <= 0.0:
                s = 0.0
        if s > 0.0:
            hanging_piece(h, v, data[i, 2], data[i, 1], s, piece)
            lowest = min(lowest, z + piece[5])
            x += piece[0]
            z += piece[1]
            state[_F11] += piece[2]
            state[_F12] += piece[3]
            state[_F21] += piece[3]
            state[_F22] += piece[4]
            v += data[i, 2] * s
            lowest = min(lowest, z)
        if i < n - 1 and not (i == last and partial_clump):
            v += data[i, 3]
    state[_X] = x
    state[_Z] = z
    state[_V_FAIRLEAD] = v
    state[_LOWEST] = lowest
    if last < 0:
        state[_H_ANCHOR] = h
        state[_V_ANCHOR] = q


@njit(cache=True, error_model="numpy")
def _add_bed(
    h: float,
    last: int,
    rest: float,
    partial_clump: bool,
    v: float,
    data: Array,
    friction: float,
    state: Array,
) -> None:
    """Add the part on the bed, from the touchdown down to the anchor, with friction ``[eq:mooring-friction]``."""
    tension = h
    by_h = 1.0
    by_q = 0.0
    x = 0.0
    ground = 0.0
    for j in range(last + 1):
        i = last - j
        w = data[i, 2]
        axial = data[i, 1]
        clump = data[i, 3] if (i < data.shape[0] - 1 and data[i, 3] > 0.0) else 0.0
        if i < last:
            tension -= friction * clump
        elif partial_clump:
            tension -= friction * (clump - v)
            by_q = friction
        if tension <= 0.0:
            tension = 0.0
            by_h = 0.0
            by_q = 0.0
        length = rest if i == last else data[i, 0]
        ground += length
        x += length
        partial = i == last and not partial_clump
        drop = friction * w * length
        if tension >= drop:
            x += length * (tension - 0.5 * drop) / axial
            state[_F11] += length / axial * by_h
            state[_F12] += length / axial * by_q
            if partial and w > 0.0:
                state[_F12] -= (tension - drop) / (axial * w)
            tension -= drop
        else:
            x += 0.5 * tension * tension / (friction * w * axial)
            state[_F11] += tension / (friction * w * axial) * by_h
            state[_F12] += tension / (friction * w * axial) * by_q
            tension = 0.0
            by_h = 0.0
            by_q = 0.0
        if partial and w > 0.0:
            # lifting shortens the bed part by dq / w and lengthens the hanging part at its horizontal lower end
            state[_F12] += h / (axial * w)
            if tension > 0.0 or friction == 0.0:
                by_q = friction
    state[_X] = x
    state[_GROUND] = ground
    state[_H_ANCHOR] = tension
    state[_V_ANCHOR] = 0.0


@njit(cache=True, error_model="numpy")
def _match_height(
    h: float,
    z: float,
    q: float,
    floor: float,
    scale: float,
    span: float,
    accuracy: float,
    data: Array,
    bed: bool,
    friction: float,
    state: Array,
    piece: Array,
) -> float:
    """Return q that puts the fairlead at height z for a given H; ``floor`` is the lowest q allowed."""
    low = floor
    high = np.inf
    q = max(q, floor)
    reach = scale
    for k in range(200):
        walk(h, q, data, bed, friction, state, piece)
        off = state[_Z] - z
        if abs(off) <= accuracy * span:
            return q
        if off > 0.0:
            high = q
        else:
            low = q
        step = -off / state[_F22]
        new = q + step
        if k > 40 or not (new > low and new < high):
            if low > -np.inf and high < np.inf:
                new = 0.5 * (low + high)
            elif high < np.inf:
                new = high - reach
                reach *= 4.0
            else:
                new = low + reach
                reach *= 4.0
        if new == q or (high < np.inf and low > -np.inf and high - low <= 1e-16 * (abs(high) + abs(low))):
            return q
        if abs(new - q) <= 1e-16 * scale and abs(off) < 1e-13 * span:
            return q
        q = new
    return q


@njit(cache=True, error_model="numpy")
def _quick(
    x: float,
    z: float,
    data: Array,
    bed: bool,
    friction: float,
    start: float,
    floor: float,
    scale: float,
    span: float,
    state: Array,
    piece: Array,
) -> tuple[float, float, float, bool]:
    """Newton in both unknowns from a guess of H; gives up at the first sign of trouble. (H, q, residual, success)."""
    h = start
    q = _match_height(h, z, 0.0, floor, scale, span, 1e-3, data, bed, friction, state, piece)
    before = np.inf
    for _ in range(12):
        walk(h, q, data, bed, friction, state, piece)
        off_x = state[_X] - x
        off_z = state[_Z] - z
        miss = max(abs(off_x), abs(off_z)) / span
        if not miss < 2.0 * before:
            break
        determinant = state[_F11] * state[_F22] - state[_F12] * state[_F21]
        dh = -(off_x * state[_F22] - off_z * state[_F12]) / determinant
        dq = -(off_z * state[_F11] - off_x * state[_F21]) / determinant
        if miss < 1e-15 or (miss < 1e-13 and miss > 0.2 * before):
            return h, q, miss, True
        before = miss
        if not (dh > -0.8 * h and dh < 4.0 * h and q + dq > floor):
            break
        h += dh
        q += dq
    return h, q, np.inf, False


@njit(cache=True, error_model="numpy")
def solve_segments(
    x: float,
    z: float,
    data: Array,
    bed: bool,
    friction: float,
    start: float,
    state: Array,
    piece: Array,
) -> tuple[float, float, float, int]:
    """Solve one line of several segments; returns (H, q, residual over length, regime), the rest is left in ``state``.

    ``start`` is a guess of H [N] (that of a uniform line of the mean properties serves well).
    """
    n = data.shape[0]
    span = 0.0
    scale = 0.0
    floor = 0.0
    open_floor = True
    for i in range(n):
        if not (data[i, 0] > 0.0 and data[i, 1] > 0.0 and np.isfinite(data[i, 2])):
            return np.nan, np.nan, np.nan, INVALID
        span += data[i, 0]
        scale += abs(data[i, 2]) * data[i, 0]
        if open_floor and data[i, 2] > 0.0:
            floor -= data[i, 2] * data[i, 0]
        else:
            open_floor = False
        if i < n - 1:
            scale += abs(data[i, 3])
            if open_floor and data[i, 3] > 0.0:
                floor -= data[i, 3]
            elif data[i, 3] < 0.0:
                open_floor = False
    if not bed:
        floor = -np.inf
    if bed:
        if z < -1e-9 * span:
            return np.nan, np.nan, np.nan, BELOW_BED
        z = max(z, 1e-12 * span)
    chord = np.hypot(x, z)
    if scale == 0.0:
        return _weightless(x, z, chord, span, data, state)
    if start > 0.0 and x > 0.0:
        h, q, miss, found = _quick(x, z, data, bed, friction, start, floor, scale, span, state, piece)
        if found:
            return h, q, miss, GROUNDED if state[_GROUND] > 0.0 else (STRETCHED if chord > span else SUSPENDED)
    q = _match_height(0.0, z, 0.0, floor, scale, span, 1e-15, data, bed, friction, state, piece)
    ground = state[_GROUND]
    if x <= ground + 1e-16 * span:
        taut = abs(z) > span and ground == 0.0
        if taut:
            _vertical_flexibility(q, data, state)
        else:
            state[_F11] = np.inf
            state[_F12] = 0.0
            state[_F21] = 0.0
        off = abs(state[_Z] - z) / span
        code = SLACK_ON_BED if ground > 0.0 else (TAUT_VERTICAL if taut else SLACK_VERTICAL)
        return 0.0, q, off, code if off < 1e-9 else NOT_CONVERGED
    h = start if start > 0.0 else scale
    low = 0.0
    high = np.inf
    best = np.inf
    converged = False
    for k in range(200):
        q = _match_height(h, z, q, floor, scale, span, 1e-15, data, bed, friction, state, piece)
        off = state[_X] - x
        if off > 0.0:
            high = h
        else:
            low = h
        slope = state[_F11] - state[_F12] * state[_F21] / state[_F22]
        step = -off / slope
        best = abs(off)
        if best <= 2e-15 * span:
            converged = True
            break
        new = h + step if off < 0.0 and step < h else h * np.exp(min(max(step / h, -6.0), 6.0))
        if abs(step) <= 2e-16 * h:
            converged = True
            break
        if (k > 12 and k % 3 == 0) or not (new > low and new < high):
            if low > 0.0 and high < np.inf:
                new = np.sqrt(low * high)
            elif high < np.inf:
                new = 1e-3 * high
            else:
                new = 50.0 * low
            if high < np.inf and high - low <= 4e-16 * high:
                converged = True
                break
        q -= state[_F21] / state[_F22] * (new - h)
        h = new
    code = GROUNDED if state[_GROUND] > 0.0 else (STRETCHED if chord > span else SUSPENDED)
    return h, q, max(best, abs(state[_Z] - z)) / span, code if converged else NOT_CONVERGED


@njit(cache=True, error_model="numpy")
def _vertical_flexibility(q: float, data: Array, state: Array) -> None:
    """Transverse flexibility of a stretched vertical line (H = 0): the sum of the integrals of 1/T and 1/EA."""
    total = 0.0
    v = q
    for i in range(data.shape[0]):
        s = data[i, 0]
        w = data[i, 2]
        up = v + w * s
        total += s / data[i, 1]
        if v * up <= 0.0:
            total = np.inf
        else:
            total += abs(np.log(up / v) / w) if abs(w * s) > 1e-12 * abs(v) else s / abs(v)
        v = up + (data[i, 3] if i < data.shape[0] - 1 else 0.0)
    state[_F11] = total
    state[_F12] = 0.0
    state[_F21] = 0.0


@njit(cache=True, error_model="numpy")
def _weightless(
    x: float, z: float, chord: float, span: float, data: Array, state: Array
) -> tuple[float, float, float, int]:
    """Line without any weight: straight elastic bars in series, or nothing."""
    for i in range(state.size):
        state[i] = 0.0
    if chord <= span:
        state[_F11] = np.inf
        state[_F22] = np.inf
        return 0.0, 0.0, 0.0, SLACK_WEIGHTLESS
    soft = 0.0
    for i in range(data.shape[0]):
        soft += data[i, 0] / data[i, 1]
    if soft == 0.0:
        return np.inf, np.inf, np.nan, UNREACHABLE
    tension = (chord - span) / soft
    c = x / chord
    s = z / chord
    across = span / tension + soft
    state[_X] = x
    state[_Z] = z
    state[_F11] = soft * c * c + across * s * s
    state[_F12] = (soft - across) * c * s
    state[_F21] = state[_F12]
    state[_F22] = soft * s * s + across * c * c
    state[_H_ANCHOR] = tension * c
    state[_V_ANCHOR] = tension * s
    state[_V_FAIRLEAD] = tension * s
    return tension * c, tension * s, 0.0, STRAIGHT


@njit(cache=True, error_model="numpy")
def solve_segments_batch(
    x: Array,
    z: Array,
    data: Array,
    clearance: float,
    friction: float,
    start: Array,
    out: Array,
    regime: IntArray,
) -> None:
    """Solve one line at many fairlead positions; ``out`` (n, 11): as :func:`kernels.solve_single`, then q."""
    state = np.empty(11)
    piece = np.empty(6)
    bed = clearance == 0.0
    span = 0.0
    scale = 0.0
    for i in range(data.shape[0]):
        span += data[i, 0]
        scale += abs(data[i, 2]) * data[i, 0] + (abs(data[i, 3]) if i < data.shape[0] - 1 else 0.0)
    ballasted = data.copy()
    for i in range(data.shape[0]):
        if abs(data[i, 2]) < _NEUTRAL * scale / span:
            ballasted[i, 2] = _NEUTRAL * scale / span
    for k in range(x.size):
        h, q, residual, code = solve_segments(x[k], z[k], data, bed, friction, start[k], state, piece)
        if not residual < 1e-11 and code <= NOT_CONVERGED:
            # a slack neutrally buoyant segment has no shape of its own: give it a trace of weight
            h, q, residual, code = solve_segments(x[k], z[k], ballasted, bed, friction, start[k], state, piece)
        f11, f12, f21, f22 = state[_F11], state[_F12], state[_F21], state[_F22]
        if not residual < 1e-8 and code < NOT_CONVERGED and code != UNREACHABLE:
            code = NOT_CONVERGED
        if clearance >= 0.0 and code <= NOT_CONVERGED and state[_LOWEST] < -clearance - 1e-9 * span:
            code = TOUCHES_BETWEEN
        out[k, 0] = h
        out[k, 1] = state[_V_FAIRLEAD]
        out[k, 2] = state[_H_ANCHOR]
        out[k, 3] = state[_V_ANCHOR]
        out[k, 4] = state[_GROUND]
        if np.isinf(f11):
            out[k, 5], out[k, 6], out[k, 7] = 0.0, 0.0, 0.0
            out[k, 8] = 1.0 / f22
        else:
            determinant = f11 * f22 - f12 * f21
            out[k, 5] = f22 / determinant
            out[k, 6] = -f12 / determinant
            out[k, 7] = -f21 / determinant
            out[k, 8] = f11 / determinant
        out[k, 9] = residual
        out[k, 10] = q
        regime[k] = code
