"""Trapezoidal rules along a thin plate that crowd exponentially into both of its ends.

Nodes and targets alternate, so that a principal value is summed as if it were regular, and the fractional powers and
logarithms with which the jump of the potential leaves an end become smooth [eq:plate-grid].
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from moyai.core.arrays import Array

# Below this value of the corner parameter the cusp form of the map is used
_CUSP = 1e-9


@dataclass(frozen=True, eq=False)
class PlateGrid:
    """Nodes with their weights and, half a step before, between and behind them, targets."""

    #: Arc-length fractions of the nodes, the tails beyond the unknowns included; shape (n,).
    fraction: Array
    #: Sums of a function of the arc-length fraction times these are its integral; shape (n,).
    weight: Array
    #: Arc-length fractions at which the equation holds; shape (last - first + 1,).
    target: Array
    #: First node that carries an unknown; those before follow from them.
    first: int
    #: Last node that carries an unknown; those behind follow from them.
    last: int


def plate_grid(corner: float, step: float, cut: tuple[float, float], tail: tuple[float, float]) -> PlateGrid:
    """Return the rule of one plate.

    Parameters
    ----------
    corner : float
        Sine of the angle between the plate and its mirror line at the first end, 1 where there is no mirror; near that
        end the spacing follows the distance between plate and mirror image.
    step : float
        Step of the trapezoidal rule.
    cut : (float, float)
        Arc-length fractions at both ends that hold no unknowns.
    tail : (float, float)
        Shares of the cuts down to which nodes go on; 1 for none.
    """
    low, high = math.log(cut[0] * tail[0]), -math.log(cut[1] * tail[1])
    ends = _stretched(np.array([low, high]), corner)
    count = math.ceil((ends[1] - ends[0]) / step)
    actual = (ends[1] - ends[0]) / count
    wanted = ends[0] + 0.5 * actual * np.arange(2 * count + 1)
    coarse = np.linspace(low, high, 4001)
    y = np.interp(wanted, _stretched(coarse, corner), coarse)
    for _ in range(12):
        q = np.exp(y)
        y = y - (_stretched(y, corner) - wanted) * (corner + q) / (1.0 + q)
    q = np.exp(y)
    fraction = q / (1.0 + q)
    weight = actual * fraction / (1.0 + q) * (corner + q) / (1.0 + q)
    nodes = fraction[1::2]
    first = int(np.searchsorted(nodes, cut[0])) if tail[0] < 1.0 else 0
    last = int(np.searchsorted(nodes, 1.0 - cut[1])) if tail[1] < 1.0 else count
    return PlateGrid(nodes, weight[1::2], fraction[0::2][first : last + 1], first, last)


def _stretched(y: Array, corner: float) -> Array:
    """Parameter of the rule at y = ln(s / (1 - s)): d(tau)/dy = (1 + e^y) / (corner + e^y) [eq:plate-grid]."""
    inverse = np.exp(-y)
    if corner < _CUSP:
        return np.asarray(y - inverse)
    bend = np.log1p(corner * inverse)
    return np.asarray(y + bend - bend / corner)


def with_tails(matrix: Array, grid: PlateGrid, *, joined: bool) -> Array:
    """Fold the columns of the tails into the unknowns.

    At the first end the jump continues as s (a + b ln s) [eq:plate-tail]; where the plate ends on the bed (``joined``)
    the jump is even about its second end and continues as a constant.
    """
    folded = matrix[:, grid.first : grid.last].copy()
    if grid.first > 0:
        s = grid.fraction
        second = int(np.searchsorted(s, 2.0 * s[grid.first]))
        one, two = s[grid.first], s[second]
        # Value at s from the values at the two nodes
        log = np.log(s[: grid.first] / one) / math.log(two / one)
        outer = s[: grid.first] / one * (1.0 - log)
        inner = s[: grid.first] / two * log
        folded[:, 0] += matrix[:, : grid.first] @ outer
        folded[:, second - grid.first] += matrix[:, : grid.first] @ inner
    if joined:
        folded[:, -1] += matrix[:, grid.last :].sum(axis=1)
    return np.asarray(folded)
