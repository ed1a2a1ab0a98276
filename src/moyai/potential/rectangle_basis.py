"""Functions for the velocity under the edge of a rectangle, and the sums over the modes below it.

The horizontal velocity in the gap between the corner and the bed is the unknown of :mod:`moyai.potential.rectangle`.
Lengths are divided by the height of the gap here: ``y`` runs from 0 at the bed to 1 at the corner.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.special import gamma, gammaln, ive, jv, roots_gegenbauer

from moyai.core.arrays import Array, ComplexArray

#: Exponents of the velocity at a corner of 270 degrees are -1/3 and +1/3 plus whole numbers: Gegenbauer index minus 1/2
CORNER_INDICES = (1.0 / 6.0, 5.0 / 6.0)

_FEWEST_MODES = 512


@dataclass(frozen=True)
class GapBasis:
    """Even functions of y with the corner singularities of the exact velocity, [eq:reference-gap-basis]."""

    #: Functions of each of the two corner families; one constant is added to them.
    pairs: int

    @property
    def index(self) -> Array:
        """Gegenbauer index of every function; 1/2 is the constant."""
        families = [np.full(self.pairs, index) for index in CORNER_INDICES]
        return np.concatenate([*families, [0.5]])

    @property
    def degree(self) -> Array:
        """Even polynomial degree of every function."""
        orders = 2.0 * np.arange(self.pairs)
        return np.concatenate([orders, orders, [0.0]])

    @property
    def scale(self) -> Array:
        """Scale of every function that keeps the matrix of the log kernel near unit diagonal."""
        return np.maximum(self.degree / 2.0, 1.0) ** (self.index + 0.5)

    @property
    def size(self) -> int:
        """Number of functions."""
        return 2 * self.pairs + 1

    def at_zero(self) -> Array:
        """Return the integral of every function over 0 < y < 1."""
        index = self.index
        return np.where(self.degree == 0.0, self.scale * 0.5**index / gamma(index + 1.0), 0.0)

    def cosine_transform(self, argument: Array) -> Array:
        """Return the integrals of every function times cos(argument y) over 0 < y < 1, [eq:reference-gap-transform].

        Parameters
        ----------
        argument : ndarray (k,)
            Not negative.

        Returns
        -------
        ndarray (size, k)
        """
        x = np.asarray(argument, dtype=float)
        out = np.empty((self.size, x.size))
        safe = np.where(x > 0.0, x, 1.0)
        for row, (index, degree, scale) in enumerate(zip(self.index, self.degree, self.scale, strict=True)):
            out[row] = scale * jv(degree + index, safe) / safe**index
        out[:, x == 0.0] = self.at_zero()[:, None]
        return out

    def hyperbolic_transform(self, argument: ComplexArray) -> ComplexArray:
        """Return exp(-argument) times the integrals with cosh(argument y), real part of the argument positive."""
        x = np.asarray(argument)
        out = np.empty((self.size, x.size), dtype=complex)
        # The library refuses very large complex arguments; four terms of the asymptotic series are exact there
        far = np.abs(x) > 1e7
        near = np.where(far, 1.0, x)
        # ive carries exp(-|Re x|); exp(-x) needs the phase of the imaginary part as well
        phase = np.exp(-1j * np.imag(x)) if np.iscomplexobj(x) else 1.0
        for row, (index, degree, scale) in enumerate(zip(self.index, self.degree, self.scale, strict=True)):
            sign = 1.0 - 2.0 * (int(degree) // 2 % 2)
            out[row] = scale * sign * np.where(far, 0.0, ive(degree + index, near) * phase) / x**index
            four = 4.0 * (degree + index) ** 2
            leading = 1.0 - (four - 1.0) / (8.0 * x) * (
                1.0 - (four - 9.0) / (16.0 * x) * (1.0 - (four - 25.0) / (24.0 * x))
            )
            out[row] += np.where(far, scale * sign * leading / np.sqrt(2.0 * np.pi * x) / x**index, 0.0)
        return out

    def moment_rules(self) -> tuple[Array, Array]:
        """Return points (3, q) of y and weights (size, q) that integrate basis functions times smooth even ones."""
        points: list[Array] = []
        rows: list[Array] = []
        count = 2 * self.pairs + 48
        for row, (index, degree, scale) in enumerate(zip(self.index, self.degree, self.scale, strict=True)):
            y, w, polynomials = _gegenbauer_rule(float(index), count, int(self.degree.max()))
            n = int(degree)
            factor = np.exp(gammaln(n + 1) + gammaln(index) - gammaln(n + 2 * index)) * 2.0**index / np.pi
            sign = 1.0 - 2.0 * (n // 2 % 2)
            rows.append(scale * sign * factor * w * polynomials[n] / 2.0)
            if row in (0, self.pairs, 2 * self.pairs):
                points.append(y)
        return np.array(points), np.array(rows)

    def moments(self, function_values: NDArray[Any]) -> NDArray[Any]:
        """Return integrals over 0 < y < 1 of basis times a function given (3, q) at :meth:`moment_rules`."""
        _, weights = self.moment_rules()
        family = np.concatenate([np.zeros(self.pairs, int), np.ones(self.pairs, int), [2]])
        values: NDArray[Any] = np.einsum("iq,iq->i", weights, np.asarray(function_values)[family])
        return values


@lru_cache(maxsize=32)
def _gegenbauer_rule(index: float, count: int, highest: int) -> tuple[Array, Array, Array]:
    """Gauss rule of the weight (1 - y^2)^(index - 1/2) on (-1, 1) and the Gegenbauer polynomials at its points."""
    y, w = roots_gegenbauer(count, index)
    polynomials = np.empty((highest + 2, count))
    polynomials[0] = 1.0
    polynomials[1] = 2.0 * index * y
    for n in range(2, highest + 2):
        polynomials[n] = (
            2.0 * y * (n + index - 1.0) * polynomials[n - 1] - (n + 2.0 * index - 2.0) * polynomials[n - 2]
        ) / n
    return y, w, polynomials


@lru_cache(maxsize=8)
def _table_at_multiples(pairs: int, count: int) -> Array:
    """Cosine transforms at pi, 2 pi, ..., count pi."""
    return GapBasis(pairs).cosine_transform(np.asarray(np.pi * np.arange(1, count + 1), dtype=float))


@lru_cache(maxsize=8)
def _tail_rule(pairs: int, count: int) -> tuple[Array, Array, Array]:
    """Points, weights and envelopes that sum over all m > count, [eq:reference-tail-sum]."""
    node, weight = np.polynomial.legendre.leggauss(12)
    # The midpoint rule backwards: the sum is the integral from count + 1/2 and a 24th of the slope there
    start = count + 0.5
    edges = start * 1.6 ** np.arange(72)
    half = 0.5 * np.diff(edges)
    points = np.concatenate([(edges[:-1, None] + half[:, None] * (node + 1.0)).ravel(), [count, count + 1.0]])
    weights = np.concatenate([(half[:, None] * weight).ravel(), [-1.0 / 24.0, 1.0 / 24.0]])
    return points, weights, _envelope(GapBasis(pairs), points)


def _envelope(basis: GapBasis, m: Array) -> Array:
    """Cosine transforms at m pi less the factor (-1)^m, by Hankel's expansion: smooth functions of m."""
    x = np.pi * m
    out = np.empty((basis.size, m.size))
    for row, (index, degree, scale) in enumerate(zip(basis.index, basis.degree, basis.scale, strict=True)):
        order = degree + index
        term, even, odd = np.ones_like(x), np.zeros_like(x), np.zeros_like(x)
        for k in range(12):
            sign = -1.0 if k // 2 % 2 else 1.0
            if k % 2:
                odd += sign * term
            else:
                even += sign * term
            term = term * (4.0 * order**2 - (2 * k + 1) ** 2) / ((k + 1) * 8.0 * x)
        shift = 0.5 * np.pi * order + 0.25 * np.pi
        wave = np.cos(shift) * even + np.sin(shift) * odd
        out[row] = scale * np.sqrt(2.0 / (np.pi * x)) * wave / x**index
    return out


@dataclass(frozen=True)
class InnerSums:
    """Sums over the modes m >= 1 below the body, lengths in gap heights.

    ``matrix`` = 2 sum U U / (kappa T), ``vector`` = 2 sum U w / (kappa T), ``scalar`` = 2 sum w w / (kappa T).
    """

    matrix: Array
    vector: Array
    scalar: float


def inner_sums(basis: GapBasis, half_beam: float, along: float, symmetric: bool) -> InnerSums:
    """Return the sums over the modes below the body, [eq:reference-inner-kernel], for one parity.

    Parameters
    ----------
    basis : GapBasis
        Functions of the velocity.
    half_beam, along : float
        Half the beam over the gap height; wave number along the crest times the gap height.
    symmetric : bool
        Heave (cosh) or sway and roll (sinh).

    Notes
    -----
    w is the cosine transform of the edge velocity of the particular solution of roll; that of heave is constant.
    """
    # Hankel's expansion holds to rounding once m pi exceeds the square of the highest degree by far
    count = _FEWEST_MODES
    while count < basis.degree.max() ** 2:
        count *= 2
    m = np.arange(1, count + 1)
    table = _table_at_multiples(basis.pairs, count)
    points, tail_weights, envelope = _tail_rule(basis.pairs, count)
    weight, roll = _mode_weights(m.astype(float), half_beam, along, symmetric)
    far_weight, far_roll = _mode_weights(points, half_beam, along, symmetric)
    far_weight = far_weight * tail_weights
    roll = roll * (-1.0) ** m
    return InnerSums(
        matrix=(table * weight) @ table.T + (envelope * far_weight) @ envelope.T,
        vector=table @ (weight * roll) + envelope @ (far_weight * far_roll),
        scalar=float(np.sum(weight * roll**2) + np.sum(far_weight * far_roll**2)),
    )


def _mode_weights(m: Array, half_beam: float, along: float, symmetric: bool) -> tuple[Array, Array]:
    """2/(kappa T) and the transform of the roll velocity at the edge without its factor (-1)^m."""
    kappa = np.hypot(np.pi * m, along)
    reach = np.tanh(kappa * half_beam)
    if symmetric:
        return 2.0 / (kappa * reach), np.zeros_like(kappa)
    return 2.0 * reach / kappa, -1.0 / kappa**2
