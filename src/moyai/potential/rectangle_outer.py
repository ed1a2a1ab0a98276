"""The water next to a rectangle: its response to horizontal velocity on the line of the side wall.

The kernel is the Green function of the quarter plane next to the wall, integrated on a ray of the complex plane
that passes below the pole of the outgoing wave; no sum over slowly converging modes is left.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from scipy.special import digamma, gamma, gammaln, gammasgn

from moyai.core.arrays import Array, ComplexArray
from moyai.potential.rectangle_basis import GapBasis

_ROTATION = np.exp(-0.25j * np.pi)
#: Nodes and weights over a side of a triangle, and over a piece of the wall.
_TRIANGLE, _WALL = np.polynomial.legendre.leggauss(14), np.polynomial.legendre.leggauss(24)


@dataclass(frozen=True)
class OuterMatrices:
    """Moments of the kernel next to the wall; the potential there is minus kernel times velocity.

    ``gap_gap`` (q, q), ``gap_side`` (q, 2) and ``side_side`` (2, 2): basis functions in the gap, the functions 1 and z
    on the wall. ``wave_gap`` (q,), ``wave_side`` (2,): moments of the wave mode of unit norm; ``wave_surface`` its
    value at the surface; ``wave_corner`` at the corner.
    """

    gap_gap: ComplexArray
    gap_side: ComplexArray
    side_side: ComplexArray
    wave_gap: Array
    wave_side: Array
    wave_surface: float
    wave_corner: float


def _panels(smallest: float, largest: float, order: int = 14) -> tuple[Array, Array]:
    """Gauss points and weights on 0 .. smallest and on doubling panels up to largest."""
    x, w = np.polynomial.legendre.leggauss(order)
    edges = np.concatenate([[0.0], smallest * 2.0 ** np.arange(0, int(np.ceil(np.log2(largest / smallest))) + 1)])
    half = np.diff(edges) / 2.0
    middle = (edges[1:] + edges[:-1]) / 2.0
    return (middle[:, None] + half[:, None] * x).ravel(), (half[:, None] * w).ravel()


def log_matrix(basis: GapBasis, reference: float) -> Array:
    """Return the moments (q, q) of -(ln|y - y'| + ln|y + y'|)/pi + 2 ln(reference)/pi, [eq:reference-log-kernel].

    The integrals of products of Bessel functions are those of Weber and Schafheitlin.
    """
    index, degree, scale = basis.index, basis.degree, basis.scale
    first, second = index[:, None], index[None, :]
    mu, nu = degree[:, None] + first, degree[None, :] + second
    sigma = first + second + 1.0
    lowest = (degree[:, None] == 0) & (degree[None, :] == 0)
    top = np.where(lowest, 1.0, (mu + nu - sigma + 1.0) / 2.0)
    lower = (nu - mu + sigma + 1.0) / 2.0
    upper = (mu - nu + sigma + 1.0) / 2.0
    outer = (mu + nu + sigma + 1.0) / 2.0
    sign = gammasgn(lower) * gammasgn(upper)
    exponent = gammaln(sigma) + gammaln(top) - sigma * np.log(2.0) - gammaln(lower) - gammaln(upper) - gammaln(outer)
    values = sign * np.exp(exponent)
    # Lowest pairs: finite part of the logarithm that is left when exp(-x reference)/x is taken away
    at_zero = 0.5 ** (first + second + 1.0) / (gamma(first + 1.0) * gamma(second + 1.0))
    slope = -digamma(sigma) + np.log(2.0) + 0.5 * (digamma(second + 1.0) + digamma(first + 1.0) + digamma(sigma))
    finite = at_zero * (2.0 * slope + np.euler_gamma + 2.0 * np.log(reference))
    integrals: Array = (2.0 / np.pi) * scale[:, None] * scale[None, :] * np.where(lowest, finite, values)
    return integrals


@lru_cache(maxsize=8)
def _real_axis_table(pairs: int) -> tuple[Array, Array, Array, float]:
    """Points, weights and transforms on the real axis for the correction of oblique waves."""
    last = 2400.0
    near, near_weight = _panels(1e-12, 2.0, 10)
    edges = np.arange(near_weight.sum(), last, 2.0)
    x, w = np.polynomial.legendre.leggauss(10)
    far = (edges[:-1, None] + 1.0 + x).ravel()
    points = np.concatenate([near, far])
    weights = np.concatenate([near_weight, np.tile(w, len(edges) - 1)])
    return points, weights, GapBasis(pairs).cosine_transform(points), float(edges[-1])


def oblique_correction(basis: GapBasis, along: float, reference: float) -> Array:
    """Return the moments of (K0(along |y - y'|) + K0(along (y + y'))) / pi less :func:`log_matrix`.

    See [eq:reference-oblique].
    """
    points, weights, table, last = _real_axis_table(basis.pairs)
    oblique = 1.0 / np.hypot(points, along)
    zero = basis.at_zero()
    out = (table * (weights * (oblique - 1.0 / points))) @ table.T
    # The logarithmic divergence sits in the product of the two integrals alone
    out += np.outer(zero, zero) * np.sum(weights * np.exp(-points * reference) / points)
    # Beyond the last point the product of two Bessel functions is replaced by its mean
    order = basis.index + basis.degree
    mean = np.cos(0.5 * np.pi * (order[:, None] - order[None, :])) / np.pi
    power = basis.index[:, None] + basis.index[None, :] + 1.0
    t, w = np.polynomial.legendre.leggauss(20)
    x = last / (0.5 * (t + 1.0))
    jacobian = 0.5 * w * x**2 / last
    difference = 1.0 / np.hypot(x, along) - 1.0 / x
    tail = np.sum(jacobian * difference * x ** -power[..., None], axis=-1)
    out += basis.scale[:, None] * basis.scale[None, :] * mean * tail
    return (2.0 / np.pi) * out


@dataclass(frozen=True)
class OuterKernel:
    """Nodes of the ray and all moments that do not depend on frequency.

    Lengths are in gap heights; ``depth`` = h/s, ``draught`` = d/s.
    """

    basis: GapBasis
    depth: float
    draught: float
    along: float
    free: Array
    gamma: ComplexArray
    weight: ComplexArray
    gap: ComplexArray
    last: complex

    def matrices(self, surface_number: float, wave_number: float) -> OuterMatrices:
        """Return the moments at one frequency.

        Parameters
        ----------
        surface_number : float
            omega^2/g times the gap height; ``inf`` gives the problem with phi = 0 on the surface.
        wave_number : float
            Wave number of the progressive wave times the gap height (not used when ``surface_number`` is infinite).
        """
        alpha, beta = (0.0, 1.0) if np.isinf(surface_number) else (1.0, surface_number)
        g, w, depth, draught = self.gamma, self.weight, self.depth, self.draught
        fall = np.exp(-2.0 * g * depth)
        # 2 exp(-gamma h) (alpha gamma sinh - beta cosh) / 2 without overflow
        resonance = 0.5 * (alpha * g * (1.0 - fall) - beta * (1.0 + fall))
        smooth = (alpha * g + beta) * np.exp(-2.0 * g * draught) / (g * resonance)
        gap_gap = (self.gap * (w * smooth)) @ self.gap.T
        if self.along == 0.0:
            zero = self.basis.at_zero()
            gap_gap = gap_gap + np.outer(zero, zero) * np.sum(w * np.exp(-g * depth) / g)
        wall = _wall_moments(g, alpha, beta, draught)
        gap_side = (self.gap * (w / (g * resonance))) @ wall.T
        pair = _wall_pairs(g, alpha, beta, depth, draught)
        side_side = np.einsum("k,kij->ij", w, pair)
        # Beyond the last node the kernel of the wall is that of a source at itself, 1/gamma^2
        norm = np.array([[draught, -(draught**2) / 2.0], [-(draught**2) / 2.0, draught**3 / 3.0]])
        tail = norm / self.last
        factor = 2.0 / np.pi
        gap_gap, gap_side, side_side = factor * gap_gap + self.free, factor * gap_side, factor * (side_side + tail)
        if np.isfinite(surface_number):
            return OuterMatrices(gap_gap, gap_side, side_side, *self._wave(wave_number))
        # Without waves the kernel is real
        parts = [np.asarray(part.real, dtype=complex) for part in (gap_gap, gap_side, side_side)]
        return OuterMatrices(parts[0], parts[1], parts[2], np.zeros(self.basis.size), np.zeros(2), 0.0, 0.0)

    def _wave(self, k: float) -> tuple[Array, Array, float, float]:
        """Moments of the progressive mode cosh k(z + h), scaled to unit norm over the depth."""
        depth, draught = self.depth, self.draught
        norm = np.sqrt(0.125 * ((1.0 - np.exp(-4.0 * k * depth)) / k + 4.0 * depth * np.exp(-2.0 * k * depth)))
        gap = np.real(self.basis.hyperbolic_transform(np.array([k + 0j]))[:, 0]) * np.exp(-k * draught) / norm
        surface = 0.5 * (1.0 + np.exp(-2.0 * k * depth)) / norm
        corner = 0.5 * np.exp(-k * draught) * (1.0 + np.exp(-2.0 * k)) / norm
        x, w = _WALL
        # Wall: split where the mode has decayed, so that short waves on a deep draught are still integrated exactly
        reach = min(draught, 40.0 / k)
        pieces = max(1, int(np.ceil(k * reach / 4.0)))
        edges = -reach * np.linspace(0.0, 1.0, pieces + 1)
        z = (edges[:-1, None] + np.diff(edges)[:, None] * 0.5 * (x + 1.0)).ravel()
        weights = (np.abs(np.diff(edges))[:, None] * 0.5 * w).ravel()
        mode = 0.5 * (np.exp(k * z) + np.exp(-k * (z + 2.0 * depth))) / norm
        wall = np.array([np.sum(weights * mode), np.sum(weights * z * mode)])
        return gap, wall, float(surface), float(corner)


def outer_kernel(
    basis: GapBasis, depth: float, draught: float, along: float, surface_numbers: Array, wave_numbers: Array
) -> OuterKernel:
    """Prepare the ray for all the given frequencies, [eq:reference-ray]."""
    free = log_matrix(basis, depth)
    if along > 0.0:
        free = free + oblique_correction(basis, along, depth)
    scales = [1.0 / depth, 1.0, *np.atleast_1d(wave_numbers[np.isfinite(wave_numbers)])]
    scales += list(np.atleast_1d(surface_numbers[np.isfinite(surface_numbers)]))
    if along > 0.0:
        scales.append(along)
    smallest = 0.25 * min(scales)
    largest = 1e9 * max(1.0 / draught, 1.0)
    points, weights = _panels(smallest, largest)
    mu = points * _ROTATION
    g = np.sqrt(mu**2 + along**2) if along > 0.0 else mu
    # exp(-gamma) is kept apart from the transform of the gap: the kernel brings exp(-2 gamma draught) along
    gap = basis.hyperbolic_transform(g)
    last = complex(_ROTATION * weights.sum())
    return OuterKernel(basis, depth, draught, along, free, g, weights * _ROTATION, gap, last)


def _wall_moments(g: ComplexArray, alpha: float, beta: float, draught: float) -> ComplexArray:
    """Return exp(-gamma d) times the wall moments (2, k) of alpha gamma cosh gamma t - beta sinh gamma t, t = -z."""
    x = g * draught
    out = np.empty((2, g.size), dtype=complex)
    small = np.abs(x) < 2.0
    node, weight = _TRIANGLE
    t = draught * 0.5 * (node + 1.0)
    near = g[small][:, None]
    profile = np.exp(-near * draught) * (alpha * near * np.cosh(near * t) - beta * np.sinh(near * t))
    out[0, small] = profile @ (0.5 * draught * weight)
    out[1, small] = profile @ (-0.5 * draught * weight * t)
    gl, xl = g[~small], x[~small]
    fall = np.exp(-2.0 * xl)
    cosh, sinh, one = 0.5 * (1.0 + fall), 0.5 * (1.0 - fall), np.exp(-xl)
    out[0, ~small] = alpha * sinh - beta * (cosh - one) / gl
    with_cosh = -(draught * sinh / gl - (cosh - one) / gl**2)
    with_sinh = -(draught * cosh / gl - sinh / gl**2)
    out[1, ~small] = alpha * gl * with_cosh - beta * with_sinh
    return out


def _wall_pairs(g: ComplexArray, alpha: float, beta: float, depth: float, draught: float) -> ComplexArray:
    """Double moments (k, 2, 2) over the wall of the vertical Green function, functions 1 and z."""
    out = np.empty((g.size, 2, 2), dtype=complex)
    small = np.abs(g) * draught < 2.0
    out[small] = _wall_pairs_by_quadrature(g[small], alpha, beta, depth, draught)
    out[~small] = _wall_pairs_closed(g[~small], alpha, beta, depth, draught)
    return out


def _wall_pairs_by_quadrature(g: ComplexArray, alpha: float, beta: float, depth: float, draught: float) -> ComplexArray:
    """Gauss quadrature over the two triangles in which the Green function is smooth."""
    node, weight = _TRIANGLE
    u, wu = 0.5 * (node + 1.0), 0.5 * weight
    # upper point z (nearer to the surface), lower point z' between z and the corner
    upper = -draught * (1.0 - u)[:, None]
    lower = -draught + (upper + draught) * u[None, :]
    area = wu[:, None] * draught * wu[None, :] * (upper + draught)
    k = g[:, None, None]
    twice = 2.0 * k * upper
    fall = np.exp(-2.0 * k * depth)
    denominator = k * (alpha * k * (1.0 - fall) - beta * (1.0 + fall))
    surface = (alpha * k * (1.0 + np.exp(twice)) + beta * np.expm1(twice)) * (0.5 / denominator)
    kernel = np.exp(k * (lower - upper)) * (1.0 + np.exp(-2.0 * k * (lower + depth))) * surface
    moments = np.stack([2.0 * area, area * (upper + lower), 2.0 * area * upper * lower], axis=-1)
    found = kernel.reshape(g.size, area.size) @ moments.reshape(area.size, 3)
    return found[:, [0, 1, 1, 2]].reshape(g.size, 2, 2)


def _wall_pairs_closed(g: ComplexArray, alpha: float, beta: float, depth: float, draught: float) -> ComplexArray:
    """Solve the ordinary differential equation of the wall for a source of 1 and of z, and integrate the answer."""
    fall = np.exp(-g * draught)
    turn = np.tanh(g * (depth - draught))
    a11, a12 = -(1.0 + turn), fall * (1.0 - turn)
    a21, a22 = -fall * (alpha * g + beta), alpha * g - beta
    determinant = a11 * a22 - a12 * a21
    # Moments of exp(-gamma t) and exp(-gamma (d - t)), t from the corner upwards, with 1 and with z = t - d
    low = np.array([(1.0 - fall) / g, (1.0 - fall) / g**2 - draught / g])
    high = np.array([(1.0 - fall) / g, -(1.0 - fall) / g**2 + draught * fall / g])
    norm = np.array([[draught, -(draught**2) / 2.0], [-(draught**2) / 2.0, draught**3 / 3.0]])
    out = np.empty((g.size, 2, 2), dtype=complex)
    for column, (corner, slope, surface) in enumerate(((1.0, 0.0, 1.0), (-draught, 1.0, 0.0))):
        b1 = turn * corner / g**2 - slope / g**3
        b2 = (beta * surface - alpha * slope) / g**2
        lower = (b1 * a22 - a12 * b2) / determinant
        upper = (a11 * b2 - a21 * b1) / determinant
        for row in range(2):
            out[:, row, column] = norm[row, column] / g**2 + lower * low[row] + upper * high[row]
    return out
