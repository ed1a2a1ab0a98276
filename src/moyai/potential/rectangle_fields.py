"""Matched solution for the surface-piercing rectangle at one frequency and one wave number along the crest.

Works in gap heights s = h - d: lengths over s, velocities 1, potentials over s. Roll turns about the point where the
vertical centre line meets the still water; :mod:`moyai.potential.rectangle` moves the centre and puts the units back.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.special import spherical_jn

from moyai.core.arrays import Array, ComplexArray
from moyai.potential.rectangle_basis import GapBasis, InnerSums, inner_sums
from moyai.potential.rectangle_outer import OuterKernel, OuterMatrices

_POINTS = 64
#: Directions of the scaled system below this share of its largest singular value are rounding noise
_CUT = 1e-13


@dataclass(frozen=True)
class InnerRegion:
    """All that the water below the body contributes and that does not depend on frequency, [eq:reference-inner].

    ``particular`` and ``edge_slope`` are moments of the particular solutions of heave (first) and roll (second).
    """

    basis: GapBasis
    half_beam: float
    along: float
    heave: InnerSums
    roll: InnerSums
    edge_constant: tuple[float, float]
    right_side: Array
    constant: Array


def inner_region(basis: GapBasis, half_beam: float, along: float) -> InnerRegion:
    """Prepare the region below the body."""
    even = inner_sums(basis, half_beam, along, symmetric=True)
    odd = inner_sums(basis, half_beam, along, symmetric=False)
    nodes, weights = np.polynomial.legendre.leggauss(_POINTS)
    gap = 0.5 * (nodes + 1.0)
    gap_weight = 0.5 * weights
    beam = 0.5 * half_beam * (nodes + 1.0)
    beam_weight = half_beam * weights  # both halves of the bottom
    rule, _ = basis.moment_rules()
    edge = np.full_like(rule, half_beam)
    one = np.ones_like
    heave_moment = basis.moments(_heave(edge, np.abs(rule), along))
    roll_moment = basis.moments(_roll(edge, np.abs(rule), along))
    edge_gap = np.full_like(gap, half_beam)
    heave_slope, roll_slope = _heave_slope(edge_gap, along), _roll_slope(edge_gap, gap, along)
    constant = np.zeros(2)
    # - integral of phi_p W over the bottom + 2 <phi_p, phi_p,x> at the edge - 2 sum w w / (kappa T)
    constant[0] = -np.sum(beam_weight * _heave(beam, one(beam), along))
    constant[0] += 2.0 * np.sum(gap_weight * _heave(edge_gap, gap, along) * heave_slope)
    constant[1] = np.sum(beam_weight * _roll(beam, one(beam), along) * beam)
    constant[1] += 2.0 * np.sum(gap_weight * _roll(edge_gap, gap, along) * roll_slope) - 2.0 * odd.scalar
    edge_constant = (float(np.sum(gap_weight * heave_slope)), float(np.sum(gap_weight * roll_slope)))
    right = np.array([heave_moment, roll_moment - odd.vector])
    return InnerRegion(basis, half_beam, along, even, odd, edge_constant, right, constant)


def _plain(along: float) -> bool:
    """Whether the particular solution is used without the term that keeps it finite for waves along x."""
    return along > 1.0


def _heave(x: Array, y: Array, along: float) -> Array:
    """Solution with unit upward velocity at y = 1 and none at y = 0."""
    if along == 0.0:
        return 0.5 * (y**2 - x**2)
    values: Array
    if _plain(along):
        values = np.exp(along * (y - 1.0)) * (1.0 + np.exp(-2.0 * along * y)) / (along * -np.expm1(-2.0 * along))
        return values
    values = 2.0 * (np.sinh(0.5 * along * y) ** 2 - np.sinh(0.5 * along * x) ** 2) / (along * np.sinh(along))
    return values


def _heave_slope(x: Array, along: float) -> Array:
    """Horizontal velocity of :func:`_heave`; it does not depend on y."""
    if along == 0.0:
        return -x
    return np.zeros_like(x) if _plain(along) else -np.sinh(along * x) / np.sinh(along)


def _roll(x: Array, y: Array, along: float) -> Array:
    """Solution with upward velocity -x at y = 1 and none at y = 0."""
    if along == 0.0:
        return -0.5 * x * y**2 + x**3 / 6.0
    if _plain(along):
        return -x * _heave(x, y, along)
    excess = 2.0 * x * np.sinh(0.5 * along * y) ** 2 - _sinh_excess(along * x) / along
    values: Array = -excess / (along * np.sinh(along))
    return values


def _roll_slope(x: Array, y: Array, along: float) -> Array:
    """Horizontal velocity of :func:`_roll`."""
    if along == 0.0:
        return 0.5 * (x**2 - y**2)
    if _plain(along):
        return -_heave(x, y, along)
    values: Array = -2.0 * (np.sinh(0.5 * along * y) ** 2 - np.sinh(0.5 * along * x) ** 2) / (along * np.sinh(along))
    return values


def _sinh_excess(u: Array) -> Array:
    """sinh u - u without cancellation."""
    series = u**3 / 6.0 * (1.0 + u**2 / 20.0 * (1.0 + u**2 / 42.0 * (1.0 + u**2 / 72.0 * (1.0 + u**2 / 110.0))))
    return np.where(np.abs(u) < 0.5, series, np.sinh(u) - u)


@dataclass(frozen=True)
class Fields:
    """Solution at one frequency, modes sway, heave, roll about the middle of the waterline."""

    #: Integral of phi_j n_i over the wetted surface for unit velocity, over the gap height squared (one more power for
    #: every roll index); shape (3, 3).
    potential_moment: ComplexArray
    #: The same integral for a wave of unit potential amplitude (norm 1 over the depth) from -x, body held; shape (3,).
    exciting_moment: ComplexArray
    #: The part of the undisturbed wave in it; shape (3,).
    incident_moment: ComplexArray
    #: Amplitude of the wave mode at x > 0, phase referred to x = 0; shape (3,).
    radiated: ComplexArray
    #: Of the body held fixed, phase referred to x = 0.
    reflection_coefficient: complex
    #: Of the body held fixed, phase referred to x = 0.
    transmission_coefficient: complex
    #: Value of the wave mode at the surface.
    surface: float


def _solve(matrix: ComplexArray, right: ComplexArray) -> ComplexArray:
    """Solve the symmetric system; the two corner families are nearly dependent at high degree, which does no harm."""
    scale = np.ones(len(matrix))  # the last row is the flux condition; its diagonal vanishes for waves along x
    scale[:-1] /= np.sqrt(np.abs(np.diag(matrix)[:-1]))
    solution, *_ = np.linalg.lstsq(scale[:, None] * matrix * scale[None, :], scale[:, None] * right, rcond=_CUT)
    return scale[:, None] * solution


def solve_fields(inner: InnerRegion, kernel: OuterKernel, surface_number: float, wave_number: float) -> Fields:
    """Solve radiation in all modes and diffraction; see [eq:reference-system].

    Parameters
    ----------
    inner : InnerRegion
        Water below the body.
    kernel : OuterKernel
        Water next to it.
    surface_number, wave_number : float
        omega^2 s/g and k s; an infinite ``surface_number`` gives the phi = 0 problem (no waves).
    """
    outer = kernel.matrices(surface_number, wave_number)
    waves = bool(np.isfinite(surface_number))
    normal = np.sqrt((wave_number - inner.along) * (wave_number + inner.along)) if waves else 0.0
    zero, b, along = inner.basis.at_zero(), inner.half_beam, inner.along
    reach = along * np.tanh(along * b)
    counter = along / np.tanh(along * b) if along > 0.0 else 1.0 / b
    size = inner.basis.size
    potential = np.zeros((3, 3), dtype=complex)
    # Even problem: heave; odd problem: sway and roll. Columns: radiation modes, then a wave from outside
    columns = {True: (1,), False: (0, 2)}
    outgoing = np.zeros(3, dtype=complex)
    exciting = np.zeros(3, dtype=complex)
    mirror = {}
    for symmetric, modes in columns.items():
        sums, edge = (inner.heave, reach) if symmetric else (inner.roll, counter)
        matrix = np.zeros((size + 1, size + 1), dtype=complex)
        matrix[:size, :size] = outer.gap_gap + sums.matrix
        matrix[:size, size] = matrix[size, :size] = zero
        matrix[size, size] = -edge
        right = np.zeros((size + 1, len(modes) + 1), dtype=complex)
        wall_wave = np.zeros(len(modes))
        for column, mode in enumerate(modes):
            if mode != 1:
                side = 0 if mode == 0 else 1
                right[:size, column] -= outer.gap_side[:, side]
                wall_wave[column] = outer.wave_side[side]
            if mode != 0:
                right[:size, column] -= inner.right_side[mode // 2]
                right[size, column] = inner.edge_constant[mode // 2]
        right[:size, -1] = 2.0 * outer.wave_gap
        solution = _solve(matrix, right)
        moment = 2.0 * right.T @ solution
        for row, influenced in enumerate(modes):
            for column, mode in enumerate(modes):
                potential[influenced, mode] = moment[row, column] + _constant(inner, outer, influenced, mode)
            exciting[influenced] = moment[row, -1] + 4.0 * wall_wave[row]
        if waves:
            flux = outer.wave_gap @ solution[:size]
            amplitude = -1j / normal * (flux + np.append(wall_wave, 0.0))
            shift = np.exp(-1j * normal * b)
            outgoing[list(modes)] = amplitude[:-1] * shift
            mirror[symmetric] = shift**2 * (1.0 + amplitude[-1])
            exciting[list(modes)] *= (0.5 if symmetric else -0.5) * shift
    if not waves:
        nothing = np.zeros(3, dtype=complex)
        return Fields(potential, nothing, nothing, outgoing, 0j, 0j, 0.0)
    return Fields(
        potential_moment=potential,
        exciting_moment=exciting,
        incident_moment=_incident(inner, outer, normal),
        radiated=outgoing,
        reflection_coefficient=complex(0.5 * (mirror[True] + mirror[False])),
        transmission_coefficient=complex(0.5 * (mirror[True] - mirror[False])),
        surface=outer.wave_surface,
    )


def _constant(inner: InnerRegion, outer: OuterMatrices, influenced: int, mode: int) -> complex:
    """Part of the potential moment that does not pass through the unknown velocity."""
    value = 0j
    if influenced != 1 and mode != 1:
        value -= 2.0 * outer.side_side[influenced // 2, mode // 2]
    if influenced == mode and mode != 0:
        value += inner.constant[mode // 2]
    return value


def _incident(inner: InnerRegion, outer: OuterMatrices, normal: float) -> ComplexArray:
    """Integrals of the undisturbed wave times the normals over the wetted surface."""
    b = inner.half_beam
    u = normal * b
    across = 2j * np.sin(u)
    sway = across * outer.wave_side[0]
    heave = -2.0 * b * np.sinc(u / np.pi) * outer.wave_corner
    roll = across * outer.wave_side[1] + 2j * b**2 * spherical_jn(1, u) * outer.wave_corner
    return np.array([sway, heave, roll])
