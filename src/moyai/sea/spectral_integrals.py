"""Integrals over wave spectra, exact to rounding: closed shapes on Gauss panels, tables piecewise.

Shapes decay like exp(-c omega^-4) towards low and like omega^-5 towards high frequencies. In v = 1/omega both ends are
finite and the integrand is smooth between the peaks, so Gauss-Legendre panels in v reach rounding, the infinite tail
included.
"""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from moyai.core.arrays import Array

Density = Callable[[Array], Array]

_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(16)
#: Below this fraction of the peak frequency exp(-1.25 s^-4) is less than 1e-300.
LOWEST = 0.21
#: Frequencies between which an integral is inverted.
_BRACKETS = 200


def shape_edges(peaks: tuple[float, ...], lower: float, upper: float) -> Array:
    """Return panel edges in v = 1/omega, ascending from 1/upper to 1/lower, for peaks at the given frequencies.

    Every peak is an edge, since the width of the JONSWAP peak changes there.
    """
    edges = [np.array([0.0, 1.0 / (LOWEST * min(peaks))])]
    for peak in peaks:
        edges.append(np.linspace(0.0, 1.0, 25) / peak)
        edges.append(1.0 / (peak * np.linspace(1.0, LOWEST, 25)))
    whole = np.unique(np.concatenate(edges))
    low, high = (0.0 if math.isinf(upper) else 1.0 / upper), (math.inf if lower <= 0.0 else 1.0 / lower)
    inner = whole[(whole > low) & (whole < high)]
    last = min(high, float(whole[-1]))
    if last <= low:
        return np.array([low, low])
    return np.unique(np.concatenate([[low], inner, [last]]))


def integrate_shape(function: Density, edges: Array) -> float:
    """Integrate ``function(omega)`` d omega over panels given by their edges in v = 1/omega."""
    half = 0.5 * np.diff(edges)
    v = (0.5 * (edges[1:] + edges[:-1]))[:, None] + half[:, None] * _NODES
    values = function(1.0 / v) / (v * v)
    return float(np.sum(half * (values @ _WEIGHTS)))


def cumulative_shape(density: Density, edges: Array) -> Density:
    """Return the integral of ``density`` from the lowest frequency of the panels, as a function of its upper end."""
    half = 0.5 * np.diff(edges)
    v = (0.5 * (edges[1:] + edges[:-1]))[:, None] + half[:, None] * _NODES
    panels = half * ((density(1.0 / v) / (v * v)) @ _WEIGHTS)
    # energy from each edge (in v) down the panel list to the largest v, which is the lowest frequency
    from_edge = np.concatenate([np.cumsum(panels[::-1])[::-1], [0.0]])

    def cumulative(omega: Array) -> Array:
        with np.errstate(divide="ignore"):
            wanted = np.clip(np.where(omega > 0.0, 1.0 / np.maximum(omega, 1e-300), np.inf), edges[0], edges[-1])
        panel = np.clip(np.searchsorted(edges, wanted, side="right") - 1, 0, edges.size - 2)
        right = edges[panel + 1]
        part = 0.5 * (right - wanted)
        v = (0.5 * (right + wanted))[:, None] + part[:, None] * _NODES
        inside = part * ((density(1.0 / v) / (v * v)) @ _WEIGHTS)
        return np.asarray(from_edge[panel + 1] + inside)

    return cumulative


def integrate_table(omega: Array, density: Array, weight: Density, power: int, lower: float, upper: float) -> float:
    """Integrate density^power weight(omega) over the piecewise-linear table between two limits."""
    low, high = max(lower, float(omega[0])), min(upper, float(omega[-1]))
    if high <= low:
        return 0.0
    nodes = np.unique(np.concatenate([[low], omega[(omega > low) & (omega < high)], [high]]))
    half = 0.5 * np.diff(nodes)
    points = (0.5 * (nodes[1:] + nodes[:-1]))[:, None] + half[:, None] * _NODES
    values = np.interp(points, omega, density) ** power * weight(points)
    return float(np.sum(half * (values @ _WEIGHTS)))


def cumulative_table(omega: Array, density: Array, wanted: Array) -> Array:
    """Return the exact integral of the piecewise-linear table from its first frequency up to each ``wanted``."""
    areas = 0.5 * (density[1:] + density[:-1]) * np.diff(omega)
    below = np.concatenate([[0.0], np.cumsum(areas)])
    place = np.clip(wanted, omega[0], omega[-1])
    interval = np.clip(np.searchsorted(omega, place, side="right") - 1, 0, omega.size - 2)
    step = place - omega[interval]
    mean = 0.5 * (density[interval] + np.interp(place, omega, density))
    return np.asarray(below[interval] + step * mean)


def invert_cumulative(cumulative: Density, density: Density, target: Array, lower: float, upper: float) -> Array:
    """Solve cumulative(omega) = target by Newton's method guarded by bisection, all targets at once."""
    grid = np.geomspace(lower, upper, _BRACKETS) if lower > 0.0 else np.linspace(lower, upper, _BRACKETS)
    above = np.clip(np.searchsorted(cumulative(grid), target, side="right"), 1, _BRACKETS - 1)
    low, high = grid[above - 1], grid[above]
    omega = 0.5 * (low + high)
    rounding = 4.0 * np.finfo(float).eps * np.max(np.abs(target), initial=0.0)
    for _ in range(200):
        excess = cumulative(omega) - target
        high = np.where(excess > 0.0, omega, high)
        low = np.where(excess > 0.0, low, omega)
        slope = density(omega)
        with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
            newton = omega - excess / slope
        inside = np.isfinite(newton) & (newton > low) & (newton < high)
        following = np.where(np.abs(excess) <= rounding, omega, np.where(inside, newton, 0.5 * (low + high)))
        done = np.abs(following - omega) <= 1e-13 * omega
        omega = following
        if done.all():
            break
    return np.asarray(omega)
