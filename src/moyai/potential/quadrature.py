"""Compiled quadrature of the layer potentials over straight, circular and complex-scaled panels.

A panel carries ``p`` Gauss-Legendre nodes in its own parameter t. The point at t is u = x + i z, and v = x - i z is
kept next to it as an independent number: on a free surface that was turned into the complex x-plane the two are not
conjugate any more, and ln r = (ln(u - U) + ln(v - V)) / 2 continues analytically [eq:potential-log-split].

A panel may run cubically into one of its ends (``grade`` -1 or +1): the fractional power of the distance with which a
potential leaves a corner becomes smooth in t. At the free edge of a thin plate it runs quadratically (-2 or +2): the
square root of the distance is a polynomial there. The point of the panel's own parameter at which u = U (three points
with cubic grading, two with quadratic) takes the singularity over, and Legendre polynomials against 1/(t0 - t) and
ln(t0 - t) are Legendre functions of the second kind [eq:potential-legendre-q]; what remains is smooth and left to the
Gauss rule. Derivatives along the normal of the target, which thin plates need, come from the same functions
[eq:plate-finite-part].
"""

from __future__ import annotations

import math

import numpy as np

from moyai.core.arrays import Array, ComplexArray, IntArray
from moyai.core.compiled import njit

# Sum of the distances of t0 from both ends of [-1, 1] below which a target counts as near: Bernstein ellipse rho ~ 3.2
_NEAR_ELLIPSE = 3.5
# The same for derivatives, whose singularity is stronger
_NEAR_SLOPES = 4.5
_TURN = complex(-0.5, math.sqrt(0.75))


@njit(cache=True, error_model="numpy")
def _legendre_q(t0: complex, on_panel: bool, count: int, q: ComplexArray) -> None:
    """Add Q_0 ... Q_count at ``t0`` to ``q``; on the cut the mean of both sides is taken."""
    if on_panel:
        x = t0.real
        low = 0.5 * math.log((1.0 + x) / (1.0 - x)) + 0.0j
    else:
        low = 0.5 * np.log((t0 + 1.0) / (t0 - 1.0))
    q[0] += low
    ellipse = abs(t0 - 1.0) + abs(t0 + 1.0)
    if on_panel or ellipse < 2.3:  # rho < 1.72: the forward recurrence loses at most rho^(2 count)
        high = t0 * low - 1.0
        q[1] += high
        for n in range(1, count):
            new = ((2 * n + 1) * t0 * high - n * low) / (n + 1)
            q[n + 1] += new
            low = high
            high = new
    else:
        extra = 30 if ellipse < 4.0 else 14
        ratios = np.empty(count + 1, np.complex128)
        ratio = 0.0j
        for n in range(count + extra, 0, -1):
            ratio = n / ((2 * n + 1) * t0 - (n + 1) * ratio)
            if n <= count:
                ratios[n] = ratio
        for n in range(1, count + 1):
            low = low * ratios[n]
            q[n] += low


@njit(cache=True, error_model="numpy")
def _preimage(target: complex, start: complex, step: complex, sweep: float, grade: int) -> complex:
    """Return the fraction of the panel, counted from its graded end, at which the panel meets ``target``."""
    if grade > 0:
        linear = (target - (start + step)) / (-step)
        turn = -sweep
    else:
        linear = (target - start) / step
        turn = sweep
    if turn == 0.0:
        return linear
    shifted = linear * (np.exp(1j * turn) - 1.0)
    return -1j * np.log(1.0 + shifted) / turn


@njit(cache=True, error_model="numpy")
def _principal_root(fraction: complex, grade: int) -> complex:
    """Return the parameter t0 that belongs to a fraction of the panel (principal root where it is graded)."""
    if grade == 0:
        return 2.0 * fraction - 1.0
    root = 2.0 * (np.sqrt(fraction) if abs(grade) == 2 else fraction ** (1.0 / 3.0)) - 1.0
    return root if grade < 0 else -root


@njit(cache=True, error_model="numpy")
def _smooth_log(y: complex) -> complex:
    """ln((e^y - 1) / y), which has no singularity near the panel."""
    if abs(y) < 0.3:
        s = y * y
        return 0.5 * y + s * (1.0 / 24.0 - s * (1.0 / 2880.0 - s * (1.0 / 181440.0 - s / 9676800.0)))
    half = 0.5 * y
    return half + np.log(np.sinh(half) / half)


@njit(cache=True, error_model="numpy")
def _smooth_pole(y: complex) -> complex:
    """1 / (1 - e^-y) - 1 / y, which has no singularity near the panel."""
    if abs(y) < 0.3:
        s = y * y
        return 0.5 + y * (1.0 / 12.0 - s * (1.0 / 720.0 - s * (1.0 / 30240.0 - s / 1209600.0)))
    return 1.0 / (1.0 - np.exp(-y)) - 1.0 / y


@njit(cache=True, error_model="numpy")
def _leg(
    fraction: complex,
    sweep: float,
    grade: int,
    own: int,
    t: Array,
    weights: Array,
    projection: Array,
    log_out: ComplexArray,
    pole_out: ComplexArray,
) -> None:
    """Weights of the integrals of f ln((u - U) / (u_end - U)) dt and f du / (u - U) along one of the two legs.

    ``own`` is the number of the node at which the target lies, or -1. Both outputs are overwritten.
    """
    p = t.shape[0]
    q = np.zeros(p + 1, np.complex128)
    on_panel = own >= 0
    t0 = complex(t[own], 0.0) if on_panel else _principal_root(fraction, grade)
    _legendre_q(t0, on_panel, p, q)
    if grade != 0:
        root = 0.5 * (1.0 + t0) if grade < 0 else 0.5 * (1.0 - t0)
        for branch in range(1, 2 if abs(grade) == 2 else 3):
            other = 2.0 * root * _branch(branch, grade) - 1.0
            _legendre_q(other if grade < 0 else -other, False, p, q)
    for k in range(p):
        log_sum = projection[0, k] * 2.0 * (q[1] + q[0])
        pole_sum = projection[0, k] * q[0]
        for n in range(1, p):
            log_sum += projection[n, k] * (2.0 / (2 * n + 1)) * (q[n + 1] - q[n - 1])
            pole_sum += projection[n, k] * q[n]
        log_out[k] = log_sum
        pole_out[k] = -2.0 * pole_sum
    if sweep != 0.0:
        along = _fraction_of(t0, grade)  # from the start of the panel
        end = _smooth_log(1j * sweep * (1.0 - along))
        for k in range(p):
            y = 1j * sweep * (_fraction_of(complex(t[k], 0.0), grade) - along)
            log_out[k] += weights[k] * (_smooth_log(y) - end)
            pole_out[k] += weights[k] * 1j * sweep * _fraction_slope(t[k], grade) * _smooth_pole(y)


@njit(cache=True, error_model="numpy")
def _branch(branch: int, grade: int) -> complex:
    """Factor between the roots of the grading: the two or three parameters at which the panel meets one point."""
    if branch == 0:
        return 1.0 + 0.0j
    if abs(grade) == 2:
        return -1.0 + 0.0j
    return _TURN if branch == 1 else np.conj(_TURN)


@njit(cache=True, error_model="numpy")
def _fraction_of(t: complex, grade: int) -> complex:
    """Fraction of the panel, from its start, at the parameter t."""
    power = 3 if abs(grade) == 1 else 2
    if grade == 0:
        return 0.5 * (1.0 + t)
    if grade < 0:
        return (0.5 * (1.0 + t)) ** power
    return 1.0 - (0.5 * (1.0 - t)) ** power


@njit(cache=True, error_model="numpy")
def _fraction_slope(t: float, grade: int) -> float:
    if grade == 0:
        return 0.5
    root = 0.5 * (1.0 + t) if grade < 0 else 0.5 * (1.0 - t)
    return root if abs(grade) == 2 else 1.5 * root * root


@njit(cache=True, error_model="numpy")
def near_weights(
    target_u: complex,
    target_v: complex,
    both_real: bool,
    own: int,
    j: int,
    panels: tuple,
    t: Array,
    weights: Array,
    projection: Array,
    log_weights: ComplexArray,
    pole_weights: ComplexArray,
    work: ComplexArray,
) -> bool:
    """Weights of f ln r dt and f (normal derivative of ln r) dsigma over panel j; True when the panel is near.

    ``panels`` = (start_u, step_u, start_v, step_v, sweep, grade, real).
    """
    start_u, step_u, start_v, step_v, sweep, grade, real = panels
    p = t.shape[0]
    g = grade[j]
    fraction_u = 0.0j
    fraction_v = 0.0j
    if own < 0:
        fraction_u = _preimage(target_u, start_u[j], step_u[j], sweep[j], g)
        size_u = abs(fraction_u)
        is_near = size_u < 12.0
        if is_near:
            t_u = _principal_root(fraction_u, g)
            is_near = abs(t_u - 1.0) + abs(t_u + 1.0) < _NEAR_ELLIPSE
        if not both_real:
            # A real panel's second leg is the mirror image of its first
            fraction_v = (
                np.conj(_preimage(np.conj(target_v), start_u[j], step_u[j], sweep[j], g))
                if real[j]
                else _preimage(target_v, start_v[j], step_v[j], sweep[j], g)
            )
            if not is_near and abs(fraction_v) < 12.0:
                t_v = _principal_root(fraction_v, g)
                is_near = abs(t_v - 1.0) + abs(t_v + 1.0) < _NEAR_ELLIPSE
        if not is_near:
            return False
    log_u, pole_u, log_v, pole_v = work[0], work[1], work[2], work[3]
    _leg(fraction_u, sweep[j], g, own, t, weights, projection, log_u, pole_u)
    end_u = start_u[j] + step_u[j]
    if both_real:
        end_log = math.log(abs(end_u - target_u))
        for k in range(p):
            log_weights[k] = log_u[k].real + weights[k] * end_log
            pole_weights[k] = pole_u[k].imag
    else:
        _leg(np.conj(fraction_v), sweep[j], g, own, t, weights, projection, log_v, pole_v)
        end_v = start_v[j] + step_v[j]
        end_log_c = 0.5 * np.log((end_u - target_u) * (end_v - target_v))
        for k in range(p):
            log_weights[k] = 0.5 * (log_u[k] + np.conj(log_v[k])) + weights[k] * end_log_c
            pole_weights[k] = -0.5j * (pole_u[k] - np.conj(pole_v[k]))
    return True


@njit(cache=True, error_model="numpy")
def add_rankine(
    targets: tuple,
    own: IntArray,
    panels: tuple,
    nodes: tuple,
    rule: tuple,
    single: ComplexArray,
    double: ComplexArray,
) -> None:
    """Add the influence of every node on every target, kernel ln r, to ``single`` and ``double`` (targets, nodes).

    Parameters
    ----------
    targets : (u, v, real)
        Complex x + i z and x - i z of the targets and whether they are real points.
    own : ndarray of int
        For each target the number of the node that it is, or -1 (also for mirror images).
    panels : tuple
        start_u, step_u, start_v, step_v, sweep, grade, real: one entry for each panel.
    nodes : tuple
        u, v, du/dt, dv/dt, element (dsigma/dt; complex where x is), panel by panel.
    rule : (t, weights, projection)
        Gauss-Legendre rule and the matrix (degree, node) from node values to Legendre coefficients.
    """
    target_u, target_v, target_real = targets
    u, v, du, dv, element = nodes
    t, weights, projection = rule
    panel_real = panels[6]
    p = t.shape[0]
    log_weights = np.empty(p, np.complex128)
    pole_weights = np.empty(p, np.complex128)
    work = np.empty((4, p), np.complex128)
    for i in range(target_u.shape[0]):
        cu = target_u[i]
        cv = target_v[i]
        for j in range(panel_real.shape[0]):
            both_real = target_real[i] and panel_real[j]
            first = j * p
            node = own[i] - first if first <= own[i] < first + p else -1
            if near_weights(
                cu, cv, both_real, node, j, panels, t, weights, projection, log_weights, pole_weights, work
            ):
                for k in range(p):
                    single[i, first + k] += log_weights[k] * element[first + k]
                    double[i, first + k] += pole_weights[k]
            elif both_real:
                for k in range(p):
                    n = first + k
                    x = u[n].real - cu.real
                    z = u[n].imag - cu.imag
                    r2 = x * x + z * z
                    single[i, n] += 0.5 * weights[k] * element[n].real * math.log(r2)
                    double[i, n] += weights[k] * (du[n].imag * x - du[n].real * z) / r2
            else:
                for k in range(p):
                    n = first + k
                    a = u[n] - cu
                    b = v[n] - cv
                    r2 = a * b
                    single[i, n] += 0.5 * weights[k] * element[n] * np.log(r2)
                    double[i, n] += -0.5j * weights[k] * (du[n] * b - dv[n] * a) / r2


@njit(cache=True, error_model="numpy")
def _smooth_pole_slope(y: complex) -> complex:
    """Derivative of :func:`_smooth_pole`."""
    if abs(y) < 0.3:
        s = y * y
        return 1.0 / 12.0 - s * (1.0 / 240.0 - s * (1.0 / 6048.0 - s / 172800.0))
    half = np.sinh(0.5 * y)
    return 1.0 / (y * y) - 0.25 / (half * half)


@njit(cache=True, error_model="numpy")
def _slope_leg(
    fraction: complex,
    step: complex,
    sweep: float,
    grade: int,
    own: int,
    t: Array,
    weights: Array,
    projection: Array,
    pole_out: ComplexArray,
    square_out: ComplexArray,
) -> None:
    """Weights of the integrals of f du / (u - U) and f du / (u - U)^2, on the panel itself as finite parts.

    The second is the derivative of the first with respect to U [eq:plate-finite-part].
    """
    p = t.shape[0]
    on_panel = own >= 0
    t0 = complex(t[own], 0.0) if on_panel else _principal_root(fraction, grade)
    q = np.empty(p + 1, np.complex128)
    pole = np.zeros(p, np.complex128)
    square = np.zeros(p, np.complex128)
    # From the graded end: fraction F = root^power, and U = end + chord * (exp(i turn F) - 1) / (exp(i turn) - 1)
    root = 0.5 * (1.0 - t0) if grade > 0 else 0.5 * (1.0 + t0)
    power = 1 if grade == 0 else 2 if abs(grade) == 2 else 3
    from_end = root**power
    turn = -sweep if grade > 0 else sweep
    chord = -step if grade > 0 else step
    rate = 1.0 / chord
    if sweep != 0.0:
        rate *= (np.exp(1j * turn) - 1.0) / (1j * turn) * np.exp(-1j * turn * from_end)
    for branch in range(power):
        here = root * _branch(branch, grade)
        place = 1.0 - 2.0 * here if grade > 0 else 2.0 * here - 1.0
        if branch == 0:
            place = t0
        moved = 2.0 * rate / (power * here ** (power - 1))
        if grade > 0:
            moved = -moved
        q[:] = 0.0
        _legendre_q(place, on_panel and branch == 0, p, q)
        over = 1.0 / (place * place - 1.0)
        for n in range(p):
            pole[n] -= 2.0 * q[n]
            change = -over if n == 0 else n * (place * q[n] - q[n - 1]) * over
            square[n] -= 2.0 * moved * change
    for k in range(p):
        pole_sum = 0.0j
        square_sum = 0.0j
        for n in range(p):
            pole_sum += projection[n, k] * pole[n]
            square_sum += projection[n, k] * square[n]
        pole_out[k] = pole_sum
        square_out[k] = square_sum
    if sweep != 0.0:
        along = _fraction_of(t0, grade)  # from the start of the panel
        along_rate = -rate if grade > 0 else rate
        for k in range(p):
            y = 1j * sweep * (_fraction_of(complex(t[k], 0.0), grade) - along)
            part = weights[k] * sweep * _fraction_slope(t[k], grade)
            pole_out[k] += 1j * part * _smooth_pole(y)
            square_out[k] += sweep * part * _smooth_pole_slope(y) * along_rate


@njit(cache=True, error_model="numpy")
def add_rankine_slopes(
    targets: tuple,
    own: IntArray,
    panels: tuple,
    nodes: tuple,
    rule: tuple,
    single: ComplexArray,
    double: ComplexArray,
) -> None:
    """Add the derivatives along unit normals of what :func:`add_rankine` gives, at real targets.

    Parameters
    ----------
    targets : (u, normal)
        Targets x + i z and unit normals n_x + i n_z.
    own, panels, nodes, rule, single, double
        As in :func:`add_rankine`. The integrals of 1/r^2 over the panel of the target are finite parts.
    """
    target_u, normal = targets
    u, v, du, dv, element = nodes
    t, weights, projection = rule
    start_u, step_u, start_v, step_v, sweep, grade, real = panels
    p = t.shape[0]
    pole_u = np.empty(p, np.complex128)
    square_u = np.empty(p, np.complex128)
    pole_v = np.empty(p, np.complex128)
    square_v = np.empty(p, np.complex128)
    for i in range(target_u.shape[0]):
        cu = target_u[i]
        cv = np.conj(cu)
        direction = normal[i]
        opposite = np.conj(direction)
        for j in range(real.shape[0]):
            first = j * p
            g = grade[j]
            node = own[i] - first if first <= own[i] < first + p else -1
            near = node >= 0
            fraction_u = 0.0j
            fraction_v = 0.0j
            if not near:
                fraction_u = _preimage(cu, start_u[j], step_u[j], sweep[j], g)
                if abs(fraction_u) < 12.0:
                    t_u = _principal_root(fraction_u, g)
                    near = abs(t_u - 1.0) + abs(t_u + 1.0) < _NEAR_SLOPES
                if not real[j]:
                    fraction_v = _preimage(cv, start_v[j], step_v[j], sweep[j], g)
                    if abs(fraction_v) < 12.0:
                        t_v = _principal_root(fraction_v, g)
                        near = near or abs(t_v - 1.0) + abs(t_v + 1.0) < _NEAR_SLOPES
            if near:
                _slope_leg(fraction_u, step_u[j], sweep[j], g, node, t, weights, projection, pole_u, square_u)
                if real[j]:
                    for k in range(p):
                        n = first + k
                        single[i, n] -= (direction * pole_u[k] / du[n]).real * element[n].real
                        double[i, n] += (direction * square_u[k]).imag
                else:
                    back = np.conj(fraction_v), np.conj(step_v[j])
                    _slope_leg(back[0], back[1], sweep[j], g, node, t, weights, projection, pole_v, square_v)
                    for k in range(p):
                        n = first + k
                        at_v = opposite * np.conj(pole_v[k]) / dv[n]
                        single[i, n] -= 0.5 * element[n] * (direction * pole_u[k] / du[n] + at_v)
                        double[i, n] += -0.5j * (direction * square_u[k] - opposite * np.conj(square_v[k]))
            elif real[j]:
                for k in range(p):
                    n = first + k
                    ratio = direction / (u[n] - cu)
                    single[i, n] -= weights[k] * element[n].real * ratio.real
                    double[i, n] += weights[k] * (ratio * du[n] / (u[n] - cu)).imag
            else:
                for k in range(p):
                    n = first + k
                    at_u = direction / (u[n] - cu)
                    at_v = opposite / (v[n] - cv)
                    single[i, n] -= 0.5 * weights[k] * element[n] * (at_u + at_v)
                    double[i, n] += -0.5j * weights[k] * (du[n] * at_u / (u[n] - cu) - dv[n] * at_v / (v[n] - cv))
