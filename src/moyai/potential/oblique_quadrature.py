"""Compiled quadrature of the layer potentials of oblique waves: kernel -K_0(kappa r) over the same panels.

Near a panel the kernel is that of :mod:`moyai.potential.quadrature` times entire functions of the distance squared;
far from it Bessel functions of complex argument stand alone, as a free surface may be turned into the complex plane.
"""

from __future__ import annotations

import math

import numpy as np

from moyai.core.arrays import ComplexArray, IntArray
from moyai.core.compiled import njit
from moyai.potential.quadrature import near_weights

_EULER = 0.5772156649015329
# Trapezoidal rule of K_n(z) = int exp(-z cosh t) cosh(nt) dt; its relative error for |arg z| <= pi/4, 2 < |z| < 16 is
# about exp(-pi^2 / (2 step) + |z| / 5)
_BESSEL_STEP = 0.14
_BESSEL_LARGE = 16.0
_COSH = np.cosh(_BESSEL_STEP * np.arange(1, 40))


@njit(cache=True, error_model="numpy")
def _bessel_k(z: complex) -> tuple:
    """Modified Bessel functions K_0 and K_1 for |arg z| <= pi/4 [eq:potential-bessel]."""
    if abs(z) < 2.0:
        y = 0.25 * z * z
        i0, i0_slope, w, w_slope = _bessel_parts(y)
        log = np.log(0.5 * z)
        # d/dz = (z/2) d/dy
        return w - log * i0, i0 / z - 0.5 * z * (w_slope - log * i0_slope)
    decay = np.exp(-z)
    if abs(z) > _BESSEL_LARGE:
        # Asymptotic series; its smallest term is exp(-2 |z|)
        scale = decay * np.sqrt(0.5 * math.pi / z)
        k0 = 1.0 + 0.0j
        k1 = 1.0 + 0.0j
        term0 = 1.0 + 0.0j
        term1 = 1.0 + 0.0j
        for m in range(1, 16):
            odd = (2 * m - 1) ** 2
            term0 *= -odd / (8.0 * m * z)
            term1 *= (4 - odd) / (8.0 * m * z)
            k0 += term0
            k1 += term1
        return scale * k0, scale * k1
    k0 = 0.5 + 0.0j
    k1 = 0.5 + 0.0j
    for c in _COSH:
        power = z * (c - 1.0)
        if power.real > 30.0:
            break
        term = np.exp(-power)
        k0 += term
        k1 += term * c
    return _BESSEL_STEP * decay * k0, _BESSEL_STEP * decay * k1


@njit(cache=True, error_model="numpy")
def _bessel_parts(y: complex) -> tuple:
    """I_0 and the smooth part W of K_0 = W - ln(z/2) I_0 as functions of y = z^2/4, with their derivatives in y."""
    digamma = -_EULER
    term = 1.0 + 0.0j
    i0 = term
    w = digamma * term
    i0_slope = 0.0j
    w_slope = 0.0j
    for m in range(1, 60):
        slope = term / m  # m y^(m-1) / m!^2
        term = slope * y / m
        digamma += 1.0 / m
        i0 += term
        w += digamma * term
        i0_slope += slope
        w_slope += digamma * slope
        if abs(slope) * digamma < 1e-17 * abs(i0):
            break
    return i0, i0_slope, w, w_slope


@njit(cache=True, error_model="numpy")
def add_helmholtz(
    targets: tuple,
    own: IntArray,
    panels: tuple,
    nodes: tuple,
    rule: tuple,
    kappa: float,
    single: ComplexArray,
    double: ComplexArray,
) -> None:
    """Add influences as ``add_rankine`` does, kernel -K_0(kappa r) [eq:potential-oblique-kernel].

    On near panels -K_0 = I_0 (ln r + ln kappa/2) - W, where I_0 and W are entire functions of r^2 and join the density.
    """
    target_u, target_v, target_real = targets
    u, v, du, dv, element = nodes
    t, weights, projection = rule
    panel_real = panels[6]
    p = t.shape[0]
    log_weights = np.empty(p, np.complex128)
    pole_weights = np.empty(p, np.complex128)
    work = np.empty((4, p), np.complex128)
    constant = math.log(0.5 * kappa)
    quarter = 0.25 * kappa * kappa
    for i in range(target_u.shape[0]):
        cu = target_u[i]
        cv = target_v[i]
        for j in range(panel_real.shape[0]):
            first = j * p
            both_real = target_real[i] and panel_real[j]
            node = own[i] - first if first <= own[i] < first + p else -1
            near = near_weights(
                cu, cv, both_real, node, j, panels, t, weights, projection, log_weights, pole_weights, work
            )
            for k in range(p):
                n = first + k
                a = u[n] - cu
                b = v[n] - cv
                turning = -1j * (b * du[n] - a * dv[n])  # normal derivative of r^2 times dsigma/dt
                if near:
                    i0, i0_slope, w, w_slope = _bessel_parts(quarter * a * b)
                    single[i, n] += element[n] * (log_weights[k] * i0 + weights[k] * (constant * i0 - w))
                    steep = (log_weights[k] + weights[k] * constant) * i0_slope - weights[k] * w_slope
                    double[i, n] += pole_weights[k] * i0 + quarter * steep * turning
                else:
                    r = np.sqrt(a * b)
                    k0, k1 = _bessel_k(kappa * r)
                    single[i, n] -= weights[k] * element[n] * k0
                    double[i, n] += 0.5 * weights[k] * kappa * k1 / r * turning


@njit(cache=True, error_model="numpy")
def _bessel_bends(y: complex) -> tuple:
    """Second derivatives of I_0 and W of :func:`_bessel_parts` in y."""
    digamma = 1.0 - _EULER
    i0_bend = 0.0j
    w_bend = 0.0j
    term = 0.5 + 0.0j  # y^(m-2) / (m! (m-2)!)
    for m in range(2, 60):
        digamma += 1.0 / m
        i0_bend += term
        w_bend += digamma * term
        if abs(term) * digamma < 1e-17 * abs(i0_bend):
            break
        term = term * y / ((m + 1) * (m - 1))
    return i0_bend, w_bend


@njit(cache=True, error_model="numpy")
def add_helmholtz_slopes(
    targets: tuple,
    own: IntArray,
    panels: tuple,
    nodes: tuple,
    rule: tuple,
    kappa: float,
    log_single: ComplexArray,
    log_double: ComplexArray,
    single: ComplexArray,
    double: ComplexArray,
) -> None:
    """Turn the derivatives along unit normals of ln r into those of -K_0(kappa r), at real targets [eq:plate-oblique].

    ``single`` and ``double`` hold what ``add_rankine_slopes`` gives when they come in, ``log_single`` and
    ``log_double`` what ``add_rankine`` gives for the same targets: near panels need them. A panel is near, or far,
    as a whole: the weights of its nodes belong together.
    """
    target_u, normal = targets
    u, v, du, dv, element = nodes
    t, weights, _ = rule
    real = panels[6]
    p = t.shape[0]
    constant = math.log(0.5 * kappa)
    quarter = 0.25 * kappa * kappa
    for i in range(target_u.shape[0]):
        cu = target_u[i]
        cv = np.conj(cu)
        direction = normal[i]
        opposite = np.conj(direction)
        near = False
        for n in range(real.shape[0] * p):
            k = n % p
            if k == 0:
                near = False
                for m in range(n, n + p):
                    near = near or abs(quarter * (u[m] - cu) * (v[m] - cv)) < 4.0
            a = u[n] - cu
            b = v[n] - cv
            size = weights[k] * element[n]
            y = quarter * a * b
            y_target = -quarter * (direction * b + opposite * a)
            y_source = -1j * quarter * (b * du[n] - a * dv[n]) * weights[k]
            y_both = -1j * quarter * (direction * dv[n] - opposite * du[n]) * weights[k]
            if near:
                i0, i0_slope, _, w_slope = _bessel_parts(y)
                i0_bend, w_bend = _bessel_bends(y)
                # Weights of ln r and of its derivative along the target's normal, both with the element of the source
                log, log_rate = log_single[i, n], single[i, n]
                turn, turn_rate = log_double[i, n], double[i, n]
                # The same without the element
                bare = log / element[n] + weights[k] * constant
                bare_rate = log_rate / element[n]
                steep = bare * i0_slope - weights[k] * w_slope
                bend = bare * i0_bend - weights[k] * w_bend
                single[i, n] = i0 * log_rate + steep * y_target * element[n]
                double[i, n] = (
                    i0 * turn_rate
                    + i0_slope * y_target * turn
                    + (bend * y_target + i0_slope * bare_rate) * y_source / weights[k]
                    + steep * y_both / weights[k]
                )
            else:
                z = kappa * np.sqrt(a * b)
                k0, k1 = _bessel_k(z)
                rate = 2.0 * k1 / z
                single[i, n] = rate * y_target * size
                double[i, n] = -4.0 * (k0 + 2.0 * k1 / z) / (z * z) * y_target * y_source + rate * y_both
