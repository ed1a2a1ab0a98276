"""Splines through points, and where a function passes zero, for what every command computes.

They give what scipy's ``make_interp_spline`` and ``brentq`` give; loading those takes a third of a second, a fifth of a
whole check.
"""

from __future__ import annotations

from collections.abc import Callable
from math import perm
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from moyai.core.arrays import Array

_EPSILON = float(np.finfo(float).eps)


class Spline:
    """Spline through points; the first and the last pieces span several intervals ("not a knot").

    Through fewer points than its degree requires it is the polynomial of them. Outside the points its end pieces go on.

    Parameters
    ----------
    x : array (n,)
        Increasing; at least two.
    values : array (n, ...)
        Real or complex.
    degree : int
        Odd.

    Raises
    ------
    ValueError
        When there are fewer than two points or they do not increase.
    """

    def __init__(self, x: Array, values: NDArray[Any], degree: int = 3) -> None:
        if len(x) < 2 or not (np.diff(x) > 0.0).all():
            raise ValueError("a spline goes through two points or more that increase")
        size, degree = len(x), min(degree, len(x) - 1)
        skipped = (degree + 1) // 2
        #: Ends of the pieces; shape (size - degree + 1,).
        self.knots: Array = np.concatenate([x[:1], x[skipped : skipped + size - degree - 1], x[-1:]])
        basis = _basis(self.knots, degree)
        piece, beyond = _places(self.knots, x)
        at_points = sum(basis[:, power, piece] * beyond**power for power in range(degree + 1))
        system = np.zeros((size, size))
        system[np.arange(size), piece + np.arange(degree + 1)[:, None]] = at_points
        weights = np.linalg.solve(system, values.reshape(size, -1))
        count = len(self.knots) - 1
        powers = sum(basis[one, :, :, None] * weights[one : one + count] for one in range(degree + 1))
        #: Powers of the distance from the left end of each piece, lowest first; shape (degree + 1, pieces, ...).
        self.powers: NDArray[Any] = np.asarray(powers).reshape(degree + 1, count, *values.shape[1:])

    def __call__(self, x: ArrayLike, derivative: int = 0) -> NDArray[Any]:
        """Return values, or derivatives of them, at points (...,), shape (..., *those of one value)."""
        return in_pieces(self.knots, self.powers, x, derivative)


def in_pieces(knots: Array, powers: NDArray[Any], x: ArrayLike, derivative: int = 0) -> NDArray[Any]:
    """Return a function that is a polynomial in each interval.

    Parameters
    ----------
    knots : array (n + 1,)
        Ends of the intervals.
    powers : array (m, n, ...)
        Coefficients of the powers of the distance from the left end of each, lowest first.
    x : array_like
        Points of any shape; beyond the intervals the end ones go on.
    derivative : int
    """
    at = np.asarray(x, dtype=float)
    piece, beyond = _places(knots, at)
    beyond = np.reshape(beyond, (*at.shape, *[1] * (powers.ndim - 2)))
    total: NDArray[Any] = np.zeros((*at.shape, *powers.shape[2:]), powers.dtype)
    for power in range(len(powers) - 1, derivative - 1, -1):
        total = total * beyond + perm(power, derivative) * powers[power, piece]
    return total


def _places(knots: Array, x: Array) -> tuple[NDArray[np.intp], Array]:
    """Return the interval of each point and its distance from the left end of it."""
    piece = np.clip(np.searchsorted(knots, x, side="right") - 1, 0, len(knots) - 2)
    return piece, x - knots[piece]


def _basis(knots: Array, degree: int) -> Array:
    """Return the B-splines that are not zero in each piece by their powers, (degree + 1, degree + 1, pieces).

    Cox-de Boor recursion over the degrees, in powers of the distance from the left end of the piece.
    """
    left, count = knots[:-1], len(knots) - 1
    every = np.concatenate([np.repeat(knots[:1], degree), knots, np.repeat(knots[-1:], degree)])
    basis = np.ones((1, 1, count))
    for order in range(1, degree + 1):
        raised = np.zeros((order + 1, order + 1, count))
        for one, lower in enumerate(basis):
            first = degree - order + 1 + one
            start, end = every[first : first + count] - left, every[first + order : first + order + count] - left
            share = lower / (end - start)
            raised[one + 1, 1:] += share
            raised[one + 1, :-1] -= start * share
            raised[one, :-1] += end * share
            raised[one, 1:] -= share
        basis = raised
    return basis


def crossing(function: Callable[[float], float], low: float, high: float, *, tolerance: float) -> float:
    """Return where a continuous function passes zero between two points at which its signs differ.

    Parameters
    ----------
    function : callable
    low, high : float
    tolerance : float
        Of the place, absolute.

    Raises
    ------
    ValueError
        Where the signs are the same, or a value is none.

    Notes
    -----
    Chandrupatla (1997): inverse quadratic interpolation where it can be trusted, halving elsewhere.
    """
    a, b = high, low
    at_a, at_b = function(a), function(b)
    if at_a == 0.0 or at_b == 0.0:
        return a if at_a == 0.0 else b
    if (at_a < 0.0) == (at_b < 0.0) or at_a != at_a or at_b != at_b:
        raise ValueError(f"{at_b:g} at {low:g} and {at_a:g} at {high:g} have the same sign")
    share = 0.5
    while True:
        new = a + share * (b - a)
        at_new = function(new)
        if (at_new < 0.0) == (at_a < 0.0):
            c, at_c = a, at_a
        else:
            c, b, at_c, at_b = b, a, at_b, at_a
        a, at_a = new, at_new
        best = a if abs(at_a) < abs(at_b) else b
        least = (2.0 * _EPSILON * abs(best) + 0.5 * tolerance) / abs(b - a)
        if least > 0.5 or at_a == 0.0 or at_b == 0.0:
            return best
        xi, phi = (a - b) / (c - b), (at_a - at_b) / (at_c - at_b)
        share = 0.5
        if phi**2 < xi and (1.0 - phi) ** 2 < 1.0 - xi:
            share = at_a / (at_b - at_a) * at_c / (at_b - at_c)
            share += (c - a) / (b - a) * at_a / (at_c - at_a) * at_b / (at_c - at_b)
        share = min(max(share, least), 1.0 - least)
