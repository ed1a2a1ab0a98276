"""Reflection, transmission, loss and mean drift of the moving section, from its motions and what it radiates."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from moyai.core.arrays import Array, ComplexArray
from moyai.core.errors import InputError
from moyai.core.validity import IdentityCheck
from moyai.floating.coefficients import Hydrodynamics
from moyai.floating.frequency import Motions
from moyai.sea import dispersion
from moyai.sea.water import Water


@dataclass(frozen=True)
class FarField:
    """Waves far from the moving section and what they cost, per frequency and heading."""

    #: Complex reflection coefficient of the moving body; shape (n, h).
    reflection_coefficient: ComplexArray
    #: Complex transmission coefficient of the moving body; shape (n, h).
    transmission_coefficient: ComplexArray
    #: E_L = 1 - |R|^2 - |T|^2; shape (n, h).
    loss: Array
    #: F* = |R|^2 + E_L / 2; shape (n, h).
    drift_coefficient: Array


def far_field(hydrodynamics: Hydrodynamics, displacement: ComplexArray) -> FarField:
    """Add the radiated waves to those of the body held fixed [eq:floating-far-field].

    Parameters
    ----------
    hydrodynamics : Hydrodynamics
        With reflection, transmission and radiated waves.
    displacement : ndarray (n, h, m)
        Complex motion per unit wave amplitude; from the frequency domain, or first harmonics of the time domain (P3).

    Raises
    ------
    InputError
        When the coefficients hold no far field (a body of finite length).
    """
    reflection, transmission, radiated = (
        hydrodynamics.reflection_coefficient,
        hydrodynamics.transmission_coefficient,
        hydrodynamics.radiated_wave,
    )
    if reflection is None or transmission is None or radiated is None:
        raise InputError(
            "reflection and transmission need the far field of a section",
            parameter="hydrodynamics",
            remedy="use coefficients of a two-dimensional section",
        )
    velocity = -1j * hydrodynamics.omega[:, None, None] * displacement
    waves = np.einsum("nhm,nms->nhs", velocity, radiated)
    moving_reflection = reflection + waves[..., 0]
    moving_transmission = transmission + waves[..., 1]
    loss = 1.0 - np.abs(moving_reflection) ** 2 - np.abs(moving_transmission) ** 2
    return FarField(
        reflection_coefficient=moving_reflection,
        transmission_coefficient=moving_transmission,
        loss=loss,
        drift_coefficient=np.abs(moving_reflection) ** 2 + 0.5 * loss,
    )


def energy_velocity(omega: ArrayLike, water: Water) -> tuple[Array, Array]:
    """Return group velocity and phase velocity [m/s]."""
    group = np.asarray(dispersion.group_velocity(omega, water.depth, water.gravity), dtype=float)
    phase = np.asarray(dispersion.phase_velocity(omega, water.depth, water.gravity), dtype=float)
    return group, phase


def drift_force_per_amplitude_squared(
    far: FarField, omega: Array, heading: Array, water: Water, length: float
) -> Array:
    """Return the mean force along x over the square of the wave amplitude [N/m2], (n, h).

    Implements P3 equation (4), F_x = E (C_g / C) (2 C_R^2 + E_L) [eq:floating-drift], for oblique waves times
    cos^2(heading): the flux of momentum along x of waves that go on and back at the same angle.

    Parameters
    ----------
    far : FarField
    omega, heading : ndarray (n,), (h,)
        [rad/s], [rad].
    water : Water
    length : float
        Length of the structure [m].
    """
    group, phase = energy_velocity(omega, water)
    energy = 0.5 * water.density * water.gravity
    flux = energy * (group / phase)[:, None] * np.cos(heading) ** 2 * np.sign(np.cos(heading)) * length
    values: Array = 2.0 * flux * far.drift_coefficient
    return values


def dissipated_fraction(
    omega: Array, heading: Array, velocity: ComplexArray, damping: Array, water: Water, length: float
) -> Array:
    """Return the work of the damping beyond radiation over the incident energy flux, (n, h) [eq:floating-energy].

    Parameters
    ----------
    omega, heading : ndarray (n,), (h,)
    velocity : ndarray (n, h, m)
        Complex velocities per unit wave amplitude.
    damping : ndarray (..., m, m)
        C, broadcast over (n, h).
    water : Water
    length : float
        Length that the damping belongs to [m].
    """
    group, _ = energy_velocity(omega, water)
    power = (
        0.5
        * np.einsum(
            "nhi,nhij,nhj->nh",
            velocity.conj(),
            np.broadcast_to(damping, (*velocity.shape, velocity.shape[-1])),
            velocity,
        ).real
    )
    flux = 0.5 * water.density * water.gravity * group[:, None] * np.abs(np.cos(heading)) * length
    values: Array = power / flux
    return values


def _driven_fraction(motions: Motions, water: Water, length: float) -> Array:
    """Return the work of moving water through linearised drag over the incident energy flux, (n, h)."""
    assert motions.drag_excitation is not None
    group, _ = energy_velocity(motions.omega, water)
    power = 0.5 * np.sum(motions.velocity.conj() * motions.drag_excitation, axis=2).real
    flux = 0.5 * water.density * water.gravity * group[:, None] * np.abs(np.cos(motions.heading)) * length
    return np.asarray(power / flux)


def energy_check(
    far: FarField, motions: Motions, water: Water, length: float, tolerance: float = 1e-6
) -> IdentityCheck:
    """Compare the loss of the far field with the work of the damping: both must be E_L [eq:floating-energy]."""
    work = dissipated_fraction(motions.omega, motions.heading, motions.velocity, motions.damping, water, length)
    if motions.drag_excitation is not None:
        work = work - _driven_fraction(motions, water, length)
    difference = np.abs(far.loss - work)
    good = np.isfinite(difference)
    return IdentityCheck(
        name="energy balance of the moving section",
        value=float(np.max(difference[good])) if np.any(good) else float("nan"),
        tolerance=tolerance,
        meaning="1 - |R|^2 - |T|^2 equals the work of the damping beyond radiation over the incident energy flux",
    )
