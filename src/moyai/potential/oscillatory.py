"""Integrals of piecewise polynomials and of inverse powers times cos and sin, exact for any time."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from moyai.core.arrays import Array, ComplexArray
from moyai.core.compiled import njit

_SMALL_PHASE = 4.0
_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(12)


@njit(cache=True, error_model="numpy")
def _fourier_kernel(knots: Any, coefficients: Any, time: Any, nodes: Any, weights: Any, out: Any) -> None:
    """Add the integrals of p(x) exp(i x t); local powers, lowest first, ``coefficients[power, interval, column]``."""
    powers, intervals, columns = coefficients.shape
    factor = np.empty(powers, np.complex128)
    for i in range(time.size):
        t = time[i]
        for j in range(intervals):
            left, width = knots[j], knots[j + 1] - knots[j]
            # The weights of the local powers: moments of (x - left)^power exp(i x t)
            factor[:] = 0.0
            if width * t < _SMALL_PHASE:
                for q in range(nodes.size):
                    s = 0.5 * width * (nodes[q] + 1.0)
                    phase = np.exp(1j * (left + s) * t) * (0.5 * width * weights[q])
                    for power in range(powers):
                        factor[power] += phase
                        phase *= s
            else:
                # By parts: M_0 = (e_1 - e_0)/(i t), M_p = (w^p e_1 - p M_(p-1))/(i t); stable while w t exceeds p
                end = np.exp(1j * (left + width) * t)
                factor[0] = (end - np.exp(1j * left * t)) / (1j * t)
                top = 1.0
                for power in range(1, powers):
                    top *= width
                    factor[power] = (top * end - power * factor[power - 1]) / (1j * t)
            for column in range(columns):
                total = 0.0 + 0.0j
                for power in range(powers):
                    total += factor[power] * coefficients[power, j, column]
                out[i, column] += total


def fourier_integral(knots: Array, coefficients: Array, time: ArrayLike) -> ComplexArray:
    """Return integrals of a piecewise polynomial times exp(i x t) over all its intervals, [eq:memory-filon].

    Parameters
    ----------
    knots : ndarray (n + 1,)
        Ends of the intervals.
    coefficients : ndarray (p, n, ...)
        Coefficients of (x - left end)^0, ^1, ..., at most of the fifth power.
    time : array_like (t,)
        Not negative.

    Returns
    -------
    ndarray (t, ...)
    """
    instants = np.ascontiguousarray(np.atleast_1d(np.asarray(time, dtype=float)))
    flat = np.ascontiguousarray(coefficients.reshape(*coefficients.shape[:2], -1), dtype=float)
    out = np.zeros((len(instants), flat.shape[2]), dtype=np.complex128)
    _fourier_kernel(np.ascontiguousarray(knots, dtype=float), flat, instants, _NODES, _WEIGHTS, out)
    return out.reshape(len(instants), *coefficients.shape[2:])


def power_tail(exponent: float, phase: ArrayLike) -> ComplexArray:
    """Return the integral of u^-exponent exp(i u phase) over u > 1, [eq:memory-tail].

    The path is turned into the upper half plane, where the integrand decays without oscillation.

    Parameters
    ----------
    exponent : float
        Greater than 1, any real number.
    phase : array_like (t,)
        Not negative.
    """
    z = np.atleast_1d(np.asarray(phase, dtype=float))
    # Doubling panels from the size of 1/largest phase to where the power itself has fallen below rounding
    first = 0.25 / max(1.0, float(z.max(initial=0.0)))
    last = 10.0 ** min(16.0 / (exponent - 1.0), 14.0)
    edges = np.concatenate([[0.0], first * 2.0 ** np.arange(2 + int(np.ceil(np.log2(last / first))))])
    half = 0.5 * np.diff(edges)
    y = (edges[:-1, None] + half[:, None] * (_NODES + 1.0)).ravel()
    w = (half[:, None] * _WEIGHTS).ravel()
    weights = w * np.exp(-exponent * np.log1p(1j * y))
    out = np.empty(z.size, dtype=complex)
    # Blocks of times bound the memory
    for start in range(0, z.size, 512):
        block = z[start : start + 512]
        decay = np.exp(-block[:, None] * y)
        out[start : start + 512] = decay @ weights.real + 1j * (decay @ weights.imag)
    result = 1j * np.exp(1j * z) * out
    return np.asarray(np.where(z == 0.0, 1.0 / (exponent - 1.0), result), dtype=complex)
