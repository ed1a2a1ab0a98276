"""The incident wave on a section: potential, its gradient, and what carries its energy.

Potentials here have unit amplitude at still water, phi_0 = exp(i k cos(beta) x) Z(z) with
Z = cosh k(z + h) / cosh kh; a wave of unit elevation has the potential -(i g / omega) phi_0 [eq:potential-incident].
"""

from __future__ import annotations

import math

import numpy as np

from moyai.core.arrays import Array, ComplexArray


def depth_profile(z: Array, wave_number: Array, depth: float) -> tuple[Array, Array]:
    """Return Z and dZ/dz; exponentials have negative arguments only, so that no kh is too large."""
    rise = np.exp(wave_number * z)
    if math.isinf(depth):
        return rise, wave_number * rise
    below = np.exp(-2.0 * wave_number * (z + depth))
    scale = rise / (1.0 + np.exp(-2.0 * wave_number * depth))
    return scale * (1.0 + below), wave_number * scale * (1.0 - below)


def incident_wave(points: Array, wave_number: Array, along: Array, depth: float) -> tuple[ComplexArray, ComplexArray]:
    """Return phi_0 (waves, n) and its gradient (waves, n, 2) in the plane of the section.

    Parameters
    ----------
    points : ndarray, shape (n, 2)
        x, z [m].
    wave_number, along : ndarray, shape (waves,)
        k and its component k cos(beta) along x [1/m].
    depth : float
        Water depth [m].
    """
    profile, slope = depth_profile(points[None, :, 1], wave_number[:, None], depth)
    phase = np.exp(1j * along[:, None] * points[None, :, 0])
    potential = phase * profile
    gradient = np.stack([1j * along[:, None] * potential, phase * slope], axis=-1)
    return potential, gradient


def depth_integral(wave_number: Array, depth: float, deep_wave_number: Array) -> Array:
    """Return the integral of Z^2 over the depth, tanh(kh) (1 + 2kh / sinh 2kh) / 2k [m]."""
    if math.isinf(depth):
        return np.asarray(0.5 / wave_number)
    product = wave_number * depth
    with np.errstate(over="ignore"):
        ratio = np.where(product < 350.0, 2.0 * product / np.sinh(np.minimum(2.0 * product, 700.0)), 0.0)
    return np.asarray(0.5 * deep_wave_number / wave_number**2 * (1.0 + ratio))


def far_field(
    potential: ComplexArray,
    flux: ComplexArray,
    wave: ComplexArray,
    wave_flux: ComplexArray,
    weight: Array,
) -> ComplexArray:
    """Return the integral of phi d(psi)/dn - psi dphi/dn over the body [eq:potential-kochin].

    Shapes: ``potential`` and ``flux`` (waves, n, problems), ``wave`` and ``wave_flux`` (waves, n), ``weight`` (n,).
    """
    return np.asarray(
        np.einsum("wn,wnr->wr", weight * wave_flux, potential) - np.einsum("wn,wnr->wr", weight * wave, flux)
    )
