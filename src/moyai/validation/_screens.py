"""Waves on thin rigid screens in a line, through the whole depth: Helmholtz's equation in plan, to seven figures.

The jump of the potential across the screens is a series of sines that meets the square root at their ends; no flow
passes the screens (Galerkin, the hypersingular kernel by parts, its logarithm by the series of cosines).
"""

from __future__ import annotations

import math

import numpy as np
from scipy.special import hankel1

from moyai.core.arrays import Array, ComplexArray

#: Terms a screen; points a term
TERMS, _POINTS = 60, 4


def waves_on_screens(k: float, screens: tuple[tuple[float, float], ...], points: Array) -> ComplexArray:
    """Return the elevation at points (p, 2) for waves e^{ikx} of unit amplitude on screens x = 0, from y to y.

    Parameters
    ----------
    k : float
        [1/m].
    screens : tuple of (float, float)
        Ends of each [m]; up to ten wave lengths long.
    points : ndarray (p, 2)
        [m], none of them on a screen.
    """
    count = _POINTS * TERMS
    angle = (np.arange(count) + 0.5) * math.pi / count
    weight = math.pi / count
    order = np.arange(1, TERMS + 1)
    sines, slopes = np.sin(np.outer(angle, order)), np.cos(np.outer(angle, order)) * order
    halves = [0.5 * (end - start) for start, end in screens]
    places = [0.5 * (start + end) + half * np.cos(angle) for (start, end), half in zip(screens, halves)]
    tests = [sines * np.sin(angle)[:, None] * weight * half for half in halves]
    slopes = slopes * weight
    matrix = np.empty((len(screens), TERMS, len(screens), TERMS), dtype=complex)
    for i, one in enumerate(tests):
        for j, other in enumerate(tests):
            if i == j:
                kernel, logarithm = _own_kernel(k * halves[i], angle)
                matrix[i, :, j] = k**2 * (one.T @ kernel @ one + _by_cosines(one, logarithm, angle))
                matrix[i, :, j] -= slopes.T @ kernel @ slopes + _by_cosines(slopes, logarithm, angle)
            else:
                kernel = 0.25j * hankel1(0, k * np.abs(places[i][:, None] - places[j]))
                matrix[i, :, j] = k**2 * one.T @ kernel @ other - slopes.T @ kernel @ slopes
    size = len(screens) * TERMS
    right = np.concatenate([-1j * k * test.sum(axis=0) for test in tests])
    jump = np.linalg.solve(matrix.reshape(size, size), right).reshape(len(screens), TERMS)
    out = np.exp(1j * k * points[:, 0])
    for terms, place, test in zip(jump, places, tests):
        away = np.hypot(points[:, [0]], points[:, [1]] - place)
        out = out + (0.25j * k * hankel1(1, k * away) * points[:, [0]] / away) @ (test @ terms)
    return np.asarray(out)


def _own_kernel(kh: float, angle: Array) -> tuple[ComplexArray, Array]:
    """Return Green's function of a screen on itself without its logarithm, and the factors of that by cosines."""
    apart = np.abs(np.cos(angle)[:, None] - np.cos(angle))
    np.fill_diagonal(apart, 1.0)
    kernel = 0.25j * hankel1(0, kh * apart) + np.log(apart) / (2.0 * math.pi)
    np.fill_diagonal(kernel, 0.25j - (math.log(0.5 * kh) + np.euler_gamma) / (2.0 * math.pi))
    order = np.arange(1, 2 * TERMS + 4)
    # ln |cos a - cos b| = -ln 2 - sum 2/m cos ma cos mb
    return kernel, np.concatenate([[math.log(2.0)], 2.0 / order]) / (2.0 * math.pi)


def _by_cosines(test: Array, factor: Array, angle: Array) -> Array:
    turned = test.T @ np.cos(np.outer(angle, np.arange(len(factor))))
    return np.asarray((turned * factor) @ turned.T)
