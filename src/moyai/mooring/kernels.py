"""Compiled kernel of the exact elastic catenary of one uniform line, every regime; callable from other compiled code.

Lengths are divided by the unstretched length L, forces by the weight W = |w| L, and e = W / EA. Two scalar equations,
each monotone in its unknown, cover the plane: ``[eq:mooring-suspended]`` in u (half the difference of the slope
parameters of the ends) for a line clear of the bed, and ``[eq:mooring-grounded]`` in H / W for a line that rests on it
in part. Newton steps in a variable that makes the equation almost straight, held inside a bracket, cannot fail.
"""

from __future__ import annotations

import numpy as np

from moyai.core.arrays import Array, IntArray
from moyai.core.compiled import njit

# Regime codes, given back by every solver of this package.
GROUNDED = 0  # part of the line on the bed, H > 0
SUSPENDED = 1  # clear of the bed
STRETCHED = 2  # clear of the bed, unstretched length shorter than the chord
SLACK_ON_BED = 3  # H = 0: the line hangs vertically and the rest lies on the bed
ALONG_BED = 4  # fairlead on the bed
SLACK_VERTICAL = 5  # both ends on one vertical, the line hangs as a fold
TAUT_VERTICAL = 6  # both ends on one vertical, the line is stretched
STRAIGHT = 7  # weight negligible against the stretch: straight elastic bar
SLACK_WEIGHTLESS = 8  # no weight and longer than the chord: no force, no defined shape
UNREACHABLE = 9  # inextensible line shorter than its chord
BELOW_BED = 10  # an end lies under the bed: solved as if there were no bed
NOT_CONVERGED = 11
INVALID = 12  # NaN or a sign that has no meaning
TOUCHES_BETWEEN = 13  # several segments: the suspended part passes under the bed (solved as if it could)

REGIME_NAMES = (
    "grounded",
    "suspended",
    "stretched",
    "slack on the bed",
    "along the bed",
    "slack vertical",
    "taut vertical",
    "straight",
    "slack weightless",
    "unreachable",
    "below the bed",
    "not converged",
    "invalid",
    "touches the bed between",
)

NO_BED = -1.0  # value of ``clearance`` for a line without bed
_MAX_ITERATIONS = 200
_TINY = 1e-300
_NO_WEIGHT = 1e-25  # W/EA below which a stretched line is a straight bar to all digits


@njit(cache=True, error_model="numpy")
def _angle_minus_tanh(angle: float) -> float:
    """Return psi - tanh(psi) without cancellation."""
    if angle > 0.15:
        return angle - np.tanh(angle)
    q = angle * angle
    return angle * q * (1 / 3 - q * (2 / 15 - q * (17 / 315 - q * (62 / 2835 - q * 1382 / 155925))))


@njit(cache=True, error_model="numpy")
def _suspended_guess(x: float, z: float, e: float) -> float:
    """Return a first u: small-u cubic near taut and stretched, ``sinh(u)/u`` inverse for slack lines."""
    square = x * x + z * z
    chord = np.sqrt(square)
    if chord > 1.2:
        return 0.5 * e / (chord - 1.0)
    if square < 1.0:
        fold = z / (1.0 + 0.5 * e)
        ratio = np.sqrt(max(1.0 - fold * fold, _TINY)) / x
        if ratio >= 3.0:
            u = np.log(2.0 * ratio)
            return u + np.log(u)
        u = np.sqrt(10.0 * (np.sqrt(1.0 + 1.2 * max(ratio - 1.0, 0.0)) - 1.0))
        if u >= 1.0 or e == 0.0:
            return u
    else:
        u = 0.0
    # x^2 u^3 / 3 + (l^2 - 1) u = l^2 e: balance of sag, length and stretch; Newton from above is monotone
    cubic = x * x / 3.0
    linear = square - 1.0
    u = max(u, (square * e / cubic) ** (1.0 / 3.0))
    if linear < 0.0:
        u = max(u, np.sqrt(-linear / cubic))
    for _ in range(4):
        u -= (u * (cubic * u * u + linear) - square * e) / (3.0 * cubic * u * u + linear)
    if linear > 0.0:
        u = min(u, 0.5 * e / (chord - 1.0))
    return u


@njit(cache=True, error_model="numpy")
def _suspended_parameter(x: float, z: float, e: float, start: float) -> tuple[float, bool]:
    """Solve ``[eq:mooring-suspended]`` for u > 0 (x > 0, e > 0 or chord < 1); returns u and whether it converged."""
    u = start if start > 0.0 else _suspended_guess(x, z, e)
    # x sinh(u) / (u + e / 2) <= 1 at the root
    u = min(u, np.log(4.0 * (1.0 + e) / x) + 6.0) if u > 0.0 else 1.0
    gap = (np.sqrt(x * x + z * z) - 1.0) * (np.sqrt(x * x + z * z) + 1.0)
    half = 0.5 * e
    low = 0.0
    high = np.inf
    last = False
    for _ in range(_MAX_ITERATIONS):
        q = u * u
        if u < 0.3:  # series keep sinh(u) - u exact where it is small against u
            excess = u * q / 6.0 * (1.0 + q / 20.0 * (1.0 + q / 42.0 * (1.0 + q / 72.0 * (1.0 + q / 110.0))))
            sinh = u + excess
            cosh = np.sqrt(1.0 + sinh * sinh)
        else:
            grow = np.exp(min(u, 700.0))
            sinh = 0.5 * (grow - 1.0 / grow)
            cosh = sinh + 1.0 / grow
            excess = sinh - u
        tanh = sinh / cosh
        rise = tanh / (tanh + half)
        run = sinh / (u + half)
        if x * run > 100.0:  # far above the root: ln(x run) grows by less than 1 per unit of u
            high = u
            u -= np.log(x * run) + max(u - 700.0, 0.0)
            continue
        # f - 1, each term without the leading 1
        residual = (
            gap - z * z * half / (tanh + half) * (rise + 1.0) + x * x * (excess - half) / (u + half) * (run + 1.0)
        )
        if last or residual == 0.0:
            return u, True
        slope = 2.0 * (
            z * z * rise * rise * rise * half * u / (sinh * sinh) + x * x * run * u * (cosh - run) / (u + half)
        )
        if residual > 0.0:
            high = u
        else:
            low = u
        value = residual + 1.0
        if abs(residual) < 0.05:
            logarithm = residual * (1.0 - residual * (0.5 - residual / 3.0))
        else:
            logarithm = np.log(max(value, 1e-30))
        step = -logarithm * value / slope  # Newton for ln f over ln u
        if not (step > -4.0 and step < 4.0):
            step = -4.0 if residual > 0.0 else 4.0
        if abs(step) < 0.02:
            new = u * (1.0 + step * (1.0 + step * (0.5 + step / 6.0)))
        else:
            new = u * np.exp(step)
        if abs(step) < 3e-9:
            last = True
        elif not (new > low and new < high):
            new = np.sqrt(low * high) if (low > 0.0 and high < np.inf) else (1e-3 * high if low == 0.0 else 1e3 * low)
            if high < np.inf and high - low <= 4e-16 * high:
                return u, True
        u = new
    return u, False


@njit(cache=True, error_model="numpy")
def _hanging_part(height: float, e: float, eta: float) -> tuple[float, float, float, float]:
    """Return (s, t, psi, d) of a part that leaves the bed tangentially and rises by ``height`` under H/W = ``eta``.

    s is its unstretched length, t = T/W at its top, psi = asinh(s / eta), d = t - eta ``[eq:mooring-rise]``.
    """
    a = 1.0 + e * eta
    d = 2.0 * height / (a + np.sqrt(a * a + 2.0 * e * height))
    t = eta + d
    s = np.sqrt(d * (t + eta))
    return s, t, np.log1p((s + d) / eta), d


@njit(cache=True, error_model="numpy")
def _grounded_guess(gap: float, near: float, far: float, e: float) -> float:
    """Return a first H/W of a line that rests on the bed in part; ``gap`` is 1 - x."""
    height = near + far
    share = gap / height
    if share > 0.3:
        q = max(1.0 - share, 1e-300)
        h = q / (1.0 - np.log(q))
        return height * h * (1.0 + 2.0 * h)
    # e y^3 + gap y = k with y = sqrt(H/W): taut limit, k = sqrt(2)/3 (height^1.5)
    k = np.sqrt(2.0) / 3.0 * (near * np.sqrt(near) + far * np.sqrt(far))
    if e == 0.0:
        return (k / gap) ** 2
    y = (k / e) ** (1.0 / 3.0)
    if gap > 0.0:
        y = min(y, k / gap)
    else:
        y += np.sqrt(-gap / e)
    for _ in range(5):
        y -= (y * (gap + e * y * y) - k) / (gap + 3.0 * e * y * y)
    return y * y


@njit(cache=True, error_model="numpy")
def _bed_stretch(eta: float, ground: float, e: float, friction: float) -> tuple[float, float, float]:
    """Return the stretch g of the grounded length with friction, dg/d(eta), dg/d(ground) ``[eq:mooring-friction]``."""
    if eta >= friction * ground:
        return e * ground * (eta - 0.5 * friction * ground), e * ground, e * (eta - friction * ground)
    return 0.5 * e * eta * eta / friction, e * eta / friction, 0.0


@njit(cache=True, error_model="numpy")
def _grounded_tension(
    gap: float, rise: float, drop: float, e: float, friction: float, highest: float, start: float
) -> tuple[float, bool]:
    """Solve ``[eq:mooring-grounded]`` for H/W; ``rise``, ``drop``: heights of fairlead and anchor over the bed."""
    eta = start if start > 0.0 else _grounded_guess(gap, rise, drop, e)
    if not eta > 0.0:
        eta = rise + drop
    eta = min(eta, highest)
    slack_side = gap > 0.5 * (rise + drop)
    taut_side = gap < 0.0
    low = 0.0
    high = highest
    last = False
    for _ in range(_MAX_ITERATIONS):
        s, t, psi, d = _hanging_part(rise, e, eta)
        residual = s - eta * psi - gap
        back = 0.0 if s == 0.0 else (d / t) / (s / t + e * s)  # ds/d(eta) at a fixed height
        slope = -(psi - s / t) + (d / t) * back
        if drop > 0.0:
            s2, t2, psi2, d2 = _hanging_part(drop, e, eta)
            residual += s2 - eta * psi2
            slope += -(psi2 - s2 / t2) + (d2 / t2) * (d2 / t2) / (s2 / t2 + e * s2)
        if friction > 0.0:
            ground = max(1.0 - s, 0.0)
            g, by_tension, by_ground = _bed_stretch(eta, ground, e, friction)
            residual -= g + e * eta * s
            slope -= by_tension + e * s + (e * eta - by_ground) * back
        else:
            residual -= e * eta
            slope -= e
        if last or residual == 0.0:
            return eta, True
        if residual < 0.0:
            high = eta
        else:
            low = eta
        if slack_side or taut_side:
            step = -residual / (slope * eta)
            new = eta * (1.0 + step)
        else:  # the suspended share falls as eta^(-1/2)
            step = 0.5 * residual / (slope * eta)
            factor = 1.0 + step
            new = eta / (factor * factor) if factor > 0.0 else np.inf
        if abs(step) < 3e-9:
            last = True
        elif not (new > low and new < high):
            new = np.sqrt(low * high) if (low > 0.0 and high < np.inf) else (0.05 * high if low == 0.0 else 20.0 * low)
            if high < np.inf and high - low <= 4e-16 * high:
                return eta, True
        eta = new
    return eta, False


@njit(cache=True, error_model="numpy")
def _suspended_outputs(x: float, z: float, e: float, h: float, v: float) -> tuple[float, float, float, float, float]:
    """Return flexibility (3 entries) and residuals of x, z of a suspended line ``[eq:mooring-flexibility]``.

    ``h`` is H/W, ``v`` the mean vertical force over W; everything is formed without cancellation.
    """
    upper = v + 0.5
    lower = v - 0.5
    t_upper = np.sqrt(h * h + upper * upper)
    t_lower = np.sqrt(h * h + lower * lower)
    total = t_upper + t_lower
    p = t_lower + lower if lower > 0.0 else h * h / (t_lower - lower)
    q = t_upper - upper if upper < 0.0 else h * h / (t_upper + upper)
    difference = np.log1p(2.0 / (p + q))  # asinh(upper/h) - asinh(lower/h)
    product = t_upper * t_lower
    f12 = -2.0 * h * v / (total * product)
    if difference > 0.5:
        sines = upper / t_upper - lower / t_lower
        f11 = e + difference - sines
    else:
        # (S - 1)(S + 1) with S - 1 = p + q
        sinh = 2.0 * total / ((p + q) * (total + 1.0))
        sines = sinh * h * h / product
        squares = (h * h * (upper * upper + lower * lower) + upper * upper * lower * lower) / (product + h * h)
        n = difference * difference
        deficit = difference * n / 6.0 * (1.0 + n / 20.0 * (1.0 + n / 42.0 * (1.0 + n / 72.0 * (1.0 + n / 110.0))))
        f11 = e - deficit + sinh * squares / product
    f22 = e + sines
    return f11, f12, f22, h * (difference + e) - x, v * (2.0 / total + e) - z


@njit(cache=True, error_model="numpy")
def _inverse(f11: float, f12: float, f21: float, f22: float) -> tuple[float, float, float, float]:
    determinant = f11 * f22 - f12 * f21
    return f22 / determinant, -f12 / determinant, -f21 / determinant, f11 / determinant


@njit(cache=True, error_model="numpy")
def solve_single(
    horizontal: float,
    vertical: float,
    length: float,
    axial_stiffness: float,
    weight: float,
    clearance: float,
    friction: float,
    start: float,
) -> tuple[float, float, float, float, float, float, float, float, float, float, int]:
    """Solve one uniform line exactly.

    Parameters
    ----------
    horizontal, vertical : float
        Distances from anchor to fairlead [m]; horizontal >= 0.
    length, axial_stiffness, weight : float
        Unstretched length [m], EA [N] (inf allowed), submerged weight per unstretched metre [N/m] (negative: buoyant).
    clearance : float
        Height of the anchor over the bed [m]; negative for no bed.
    friction : float
        Friction coefficient of the bed, acting against a pull from the fairlead.
    start : float
        A guess of the horizontal tension [N], for instance that of the last step; 0 for none.

    Returns
    -------
    tuple
        (H fairlead, V fairlead, H anchor, V anchor, grounded length, dH/dX, dH/dZ, dV/dX, dV/dZ, residual / length,
        regime). H, V at the fairlead are the force of the body on the line; the line pulls the anchor with H towards
        the fairlead and V upwards.
    """
    nan = np.nan
    if not (horizontal >= 0.0 and length > 0.0 and axial_stiffness > 0.0 and friction >= 0.0) or not np.isfinite(
        horizontal + vertical + length + weight
    ):
        return nan, nan, nan, nan, nan, nan, nan, nan, nan, nan, INVALID
    x = horizontal / length
    sign = 1.0 if weight >= 0.0 else -1.0
    z = sign * vertical / length
    total = sign * weight * length  # W
    e = total / axial_stiffness
    chord = np.sqrt(x * x + z * z)
    if total == 0.0 or (e < _NO_WEIGHT and chord > 1.0):
        return _solve_weightless(x, z, chord, length, axial_stiffness, sign)
    scale = total / length
    rise = z + clearance / length
    drop = clearance / length
    bed = clearance >= 0.0 and sign > 0.0
    solved = False
    h, v, k11, k12, k22, residual, code = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, SUSPENDED
    if bed and rise >= -1e-9:
        if drop > 0.0:
            # most lines from a raised anchor hang clear of the bed
            h, v, k11, k12, k22, residual, code = _solve_clear(x, z, chord, e, start / total)
            solved = not _sags_below(h, v, e, drop)
        if not solved:
            rest = _solve_with_bed(x, max(rise, 1e-12), drop, e, friction, start / total)
            if rest[10] >= 0:
                code = rest[10]
                if code == GROUNDED and rise <= 1e-12:
                    code = ALONG_BED
                return (
                    total * rest[0],
                    total * rest[1],
                    total * rest[2],
                    total * rest[3],
                    length * rest[4],
                    scale * rest[5],
                    scale * rest[6],
                    scale * rest[7],
                    scale * rest[8],
                    rest[9],
                    code,
                )
    if not solved:
        h, v, k11, k12, k22, residual, code = _solve_clear(x, z, chord, e, start / total)
    if bed and rise < -1e-9 and code == SUSPENDED:
        code = BELOW_BED
    return (
        total * h,
        total * sign * (v + 0.5),
        total * h,
        total * sign * (v - 0.5),
        0.0,
        scale * k11,
        scale * sign * k12,
        scale * sign * k12,
        scale * k22,
        residual,
        code,
    )


@njit(cache=True, error_model="numpy")
def _solve_weightless(
    x: float, z: float, chord: float, length: float, axial_stiffness: float, sign: float
) -> tuple[float, float, float, float, float, float, float, float, float, float, int]:
    """Straight elastic bar, or nothing when longer than its chord."""
    if chord <= 1.0:
        return 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, SLACK_WEIGHTLESS
    if not np.isfinite(axial_stiffness):
        return np.inf, np.inf, np.inf, np.inf, 0.0, np.nan, np.nan, np.nan, np.nan, np.nan, UNREACHABLE
    tension = axial_stiffness * (chord - 1.0)
    cosine = x / chord
    sine = sign * z / chord
    along = axial_stiffness / length
    across = tension / (chord * length)
    k11 = along * cosine * cosine + across * sine * sine
    k12 = (along - across) * cosine * sine
    k22 = along * sine * sine + across * cosine * cosine
    h = tension * cosine
    v = tension * sine
    return h, v, h, v, 0.0, k11, k12, k12, k22, 0.0, STRAIGHT


@njit(cache=True, error_model="numpy")
def _solve_clear(
    x: float, z: float, chord: float, e: float, start: float
) -> tuple[float, float, float, float, float, float, int]:
    """Line clear of the bed: (H, mean V, k11, k12, k22) over W and W/L, residual, regime."""
    if e == 0.0 and chord >= 1.0:
        return np.inf, np.inf, np.nan, np.nan, np.nan, np.nan, UNREACHABLE
    if x < 1e-200:  # vertical
        if abs(z) > 1.0 + 0.5 * e:
            v = (abs(z) - 1.0) / e
            difference = np.log((v + 0.5) / (v - 0.5))
            residual = v * e + 1.0 - abs(z)
            v = v if z > 0.0 else -v
            return 0.0, v, 1.0 / (e + difference), 0.0, 1.0 / e, residual, TAUT_VERTICAL
        v = z / (2.0 + e)
        return 0.0, v, 0.0, 0.0, 1.0 / (2.0 + e), 0.0, SLACK_VERTICAL
    u, converged = _suspended_parameter(x, abs(z), e, 0.5 * (x / start - e) if start > 0.0 else 0.0)
    h = x / (2.0 * u + e)
    v = z / (2.0 * np.tanh(u) + e)
    f11, f12, f22, off_x, off_z = _suspended_outputs(x, z, e, h, v)
    k11, k12, _, k22 = _inverse(f11, f12, f12, f22)
    residual = max(abs(off_x), abs(off_z))
    regime = STRETCHED if chord > 1.0 else SUSPENDED
    return h, v, k11, k12, k22, residual, regime if converged else NOT_CONVERGED


@njit(cache=True, error_model="numpy")
def _solve_with_bed(
    x: float, rise: float, drop: float, e: float, friction: float, start: float
) -> tuple[float, float, float, float, float, float, float, float, float, float, int]:
    """Line with a bed: forces over W, grounded share, stiffness over W/L, residual, regime (-1: clear of the bed)."""
    nothing = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, -1)
    gap = 1.0 - x
    free = 2.0 * rise / (1.0 + np.sqrt(1.0 + 2.0 * e * rise))  # hanging length at H = 0
    free_drop = 2.0 * drop / (1.0 + np.sqrt(1.0 + 2.0 * e * drop))
    if free + free_drop >= 1.0:
        # too short to reach the bed even when it hangs vertically at both ends
        return nothing
    if gap >= free + free_drop - 1e-16:
        k22 = 1.0 / (1.0 + e * free)
        ground = max(1.0 - free - free_drop, 0.0)
        return 0.0, free, 0.0, -free_drop, ground, 0.0, 0.0, 0.0, k22, 0.0, SLACK_ON_BED
    highest = np.inf
    if drop == 0.0:
        # lifted when the line that just leaves the bed at its anchor spans less than x
        tangent = rise - 0.5 * e
        if tangent >= 1.0:
            return nothing
        if tangent > 0.0:
            cosine2 = (1.0 - tangent) * (1.0 + tangent)
            if x >= (np.arctanh(tangent) + 0.5 * e) * cosine2 / tangent:
                return nothing
            highest = 0.5 * cosine2 / tangent * (1.0 + 1e-12)
    eta, converged = _grounded_tension(gap, rise, drop, e, friction if drop == 0.0 else 0.0, highest, start)
    s, t, psi, d = _hanging_part(rise, e, eta)
    off = gap - s + eta * psi
    f11 = _angle_minus_tanh(psi) + e * s
    f12 = -d / t
    f21 = f12
    f22 = s / t + e * s
    ground = max(1.0 - s, 0.0)
    v_anchor = 0.0
    h_anchor = eta
    if drop > 0.0:
        s2, t2, psi2, d2 = _hanging_part(drop, e, eta)
        ground = max(ground - s2, 0.0)
        off += eta * psi2 - s2 + e * eta
        f11 += _angle_minus_tanh(psi2) - (d2 / t2) * (d2 / t2) / (s2 / t2 + e * s2) + e * (1.0 - s)
        v_anchor = -s2
    elif friction > 0.0:
        g, by_tension, by_ground = _bed_stretch(eta, ground, e, friction)
        off += g + e * eta * s
        f11 += by_tension
        f12 += e * eta - by_ground
        h_anchor = max(eta - friction * ground, 0.0)
    else:
        off += e * eta
        f11 += e * ground
    k11, k12, k21, k22 = _inverse(f11, f12, f21, f22)
    code = GROUNDED if converged else NOT_CONVERGED
    return eta, s, h_anchor, v_anchor, ground, k11, k12, k21, k22, abs(off), code


@njit(cache=True, error_model="numpy")
def _sags_below(h: float, v: float, e: float, drop: float) -> bool:
    """Whether a line that hangs free with H/W = ``h``, mean V/W = ``v`` sags by more than ``drop`` below its anchor."""
    lower = v - 0.5
    upper = v + 0.5
    if not (lower < 0.0 and upper > 0.0):
        return False
    t = np.sqrt(h * h + lower * lower)
    return lower * lower / (t + h) + 0.5 * e * lower * lower > drop


@njit(cache=True, error_model="numpy")
def solve_batch(
    horizontal: Array,
    vertical: Array,
    length: Array,
    axial_stiffness: Array,
    weight: Array,
    clearance: Array,
    friction: Array,
    out: Array,
    regime: IntArray,
) -> None:
    """Solve many lines; ``out`` is (n, 10) in the order of :func:`solve_single`, ``regime`` (n,)."""
    for i in range(horizontal.size):
        r = solve_single(
            horizontal[i], vertical[i], length[i], axial_stiffness[i], weight[i], clearance[i], friction[i], 0.0
        )
        out[i, 0], out[i, 1], out[i, 2], out[i, 3], out[i, 4] = r[0], r[1], r[2], r[3], r[4]
        out[i, 5], out[i, 6], out[i, 7], out[i, 8], out[i, 9] = r[5], r[6], r[7], r[8], r[9]
        regime[i] = r[10]


@njit(cache=True, error_model="numpy")
def solve_line_batch(
    horizontal: Array,
    vertical: Array,
    length: float,
    axial_stiffness: float,
    weight: float,
    clearance: float,
    friction: float,
    out: Array,
    regime: IntArray,
) -> None:
    """Solve one line at many fairlead positions; ``out`` is (n, 11): :func:`solve_single`, then q.

    q is the vertical tension at the anchor, or minus the reaction of the bed where the line rests on it.
    """
    for i in range(horizontal.size):
        r = solve_single(horizontal[i], vertical[i], length, axial_stiffness, weight, clearance, friction, 0.0)
        out[i, 0], out[i, 1], out[i, 2], out[i, 3], out[i, 4] = r[0], r[1], r[2], r[3], r[4]
        out[i, 5], out[i, 6], out[i, 7], out[i, 8], out[i, 9] = r[5], r[6], r[7], r[8], r[9]
        out[i, 10] = -weight * r[4] if (r[4] > 0.0 and clearance == 0.0) else r[3]
        regime[i] = r[10]


@njit(cache=True, error_model="numpy")
def plane_to_space(span: Array, plane: Array, count: int, force: Array, stiffness: Array) -> None:
    """Turn (H, V) and their stiffness (columns of :func:`solve_single`) into force on the body and 3x3 stiffness.

    ``span`` (n, 3) leads from anchor to fairlead; ``force`` (n, 3), ``stiffness`` (n, 3, 3): all copies, site axes.
    """
    for i in range(span.shape[0]):
        reach = np.sqrt(span[i, 0] * span[i, 0] + span[i, 1] * span[i, 1])
        h = plane[i, 0]
        # a line whose ends stand on one vertical has no direction; its sideways stiffness is the same all round
        c, s, across = 1.0, 0.0, plane[i, 5]
        if reach > 0.0:
            c = span[i, 0] / reach
            s = span[i, 1] / reach
            if reach > 1e-12 * abs(span[i, 2]):
                across = h / reach
        force[i, 0] = -count * h * c if h > 0.0 else 0.0
        force[i, 1] = -count * h * s if h > 0.0 else 0.0
        force[i, 2] = -count * plane[i, 1]
        stiffness[i, 0, 0] = count * (plane[i, 5] * c * c + across * s * s)
        stiffness[i, 0, 1] = count * (plane[i, 5] - across) * c * s
        stiffness[i, 1, 0] = stiffness[i, 0, 1]
        stiffness[i, 1, 1] = count * (plane[i, 5] * s * s + across * c * c)
        stiffness[i, 0, 2] = count * plane[i, 6] * c
        stiffness[i, 1, 2] = count * plane[i, 6] * s
        stiffness[i, 2, 0] = count * plane[i, 7] * c
        stiffness[i, 2, 1] = count * plane[i, 7] * s
        stiffness[i, 2, 2] = count * plane[i, 8]
