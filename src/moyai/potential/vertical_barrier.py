"""Vertical thin barrier by matched eigenfunctions: an independent reference for plates at any frequency.

The disturbance is odd in x, so that its potential vanishes in the gap under the barrier. On x > 0 it is a sum over the
eigenfunctions of the depth; the velocity through the gap, singular at the edge, is expanded in Chebyshev polynomials
with that singularity as their weight, and their integrals are Bessel functions [eq:plate-gap].
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike
from scipy.special import ive, jv

from moyai.core.arrays import Array, ComplexArray
from moyai.core.errors import InputError
from moyai.sea.dispersion import evanescent_wave_numbers
from moyai.sea.dispersion import wave_number as linear_wave_number
from moyai.sea.water import Water, check_water


@dataclass(frozen=True, eq=False)
class VerticalBarrier:
    """Sway coefficients and scattering of a vertical barrier that hangs from the still water, per metre."""

    #: [rad/s]; shape (n,).
    omega: Array
    #: Added mass of motion along x [kg/m]; shape (n,).
    added_mass: Array
    #: Radiation damping of motion along x [kg/(m s)]; shape (n,).
    radiation_damping: Array
    #: Reflection coefficient of the barrier held fixed, phase at the barrier; shape (n,).
    reflection_coefficient: ComplexArray
    #: Transmission coefficient of the barrier held fixed, phase at the barrier; shape (n,).
    transmission_coefficient: ComplexArray


def solve_vertical_barrier(
    draught: float, water: Water, omega: ArrayLike, *, polynomials: int = 14, evanescent_modes: int = 4000
) -> VerticalBarrier:
    """Solve a vertical barrier in water of finite depth [eq:plate-gap].

    Parameters
    ----------
    draught : float
        Depth of the lower edge [m].
    water : Water
        Finite depth, density, gravity.
    omega : array_like
        [rad/s].
    polynomials, evanescent_modes : int
        Chebyshev polynomials in the gap and evanescent modes; the sum beyond the last mode is added in the mean.

    Returns
    -------
    VerticalBarrier
        Added mass [kg/m] and damping [kg/(m s)] of sway, reflection and transmission [-]; each of shape (n,).

    Raises
    ------
    InputError
        For infinite depth, or a draught that is not between 0 and the depth.

    Examples
    --------
    >>> from moyai.potential import solve_vertical_barrier
    >>> from moyai.sea import Water
    >>> water = Water(depth=10.0, density=1025.0, gravity=9.81)
    >>> found = solve_vertical_barrier(2.0, water, [1.5])
    >>> round(float(abs(found.transmission_coefficient[0])), 3)
    0.933
    >>> energy = abs(found.transmission_coefficient[0]) ** 2 + abs(found.reflection_coefficient[0]) ** 2
    >>> round(float(energy), 6)
    1.0
    """
    check_water(water)
    depth = water.depth
    if not math.isfinite(depth):
        raise InputError(
            "matched eigenfunctions need a finite depth", parameter="water.depth", allowed="a finite depth"
        )
    if not 0.0 < draught < depth:
        raise InputError(
            f"draught is {draught:g} m in water {depth:g} m deep",
            parameter="draught",
            allowed=f"greater than 0, less than {depth:g} m",
        )
    frequencies = np.atleast_1d(np.asarray(omega, dtype=float))
    parts = np.array([_one(draught, water, float(value), polynomials, evanescent_modes) for value in frequencies])
    return VerticalBarrier(
        frequencies,
        parts[:, 0].real,
        parts[:, 0].imag * frequencies,
        parts[:, 1],
        parts[:, 2],
    )


def _one(draught: float, water: Water, omega: float, count: int, modes: int) -> tuple[complex, complex, complex]:
    """Complex added mass, R and T at one frequency."""
    h, gap = water.depth, water.depth - draught
    k = float(linear_wave_number(omega, h, water.gravity))
    rates = np.asarray(evanescent_wave_numbers(omega, h, water.gravity, modes))
    order = 2 * np.arange(count)
    sign = (-1.0) ** np.arange(count)

    # Travelling mode over cosh kh, so that no exponential is large
    decay, twice = math.exp(-k * draught), math.exp(-2.0 * k * h)
    low = decay * (1.0 + math.exp(-2.0 * k * gap)) / (1.0 + twice)  # cosh kg / cosh kh
    slow = decay * (1.0 - math.exp(-2.0 * k * gap)) / (1.0 + twice)  # sinh kg / cosh kh
    tanh = (1.0 - twice) / (1.0 + twice)
    norm0 = 0.5 * (h * (1.0 - tanh**2) + tanh / k)  # integral of Z^2
    norms = 0.5 * h * (1.0 + np.sin(2.0 * rates * h) / (2.0 * rates * h))
    below = 0.5 * (gap * (1.0 - tanh**2) + low * slow / k)  # the same over the gap

    # Integrals over the plate of 1 and of Z against the modes, over the gap of the Chebyshev functions
    plate_one = np.concatenate([[(tanh - slow) / k], (np.sin(rates * h) - np.sin(rates * gap)) / rates])
    cross = -(k * slow * np.cos(rates * gap) + rates * low * np.sin(rates * gap)) / (k**2 + rates**2)
    plate_wave = np.concatenate([[norm0 - below], cross])
    scaled = 0.5 * math.pi * gap
    travelling = scaled * ive(order, k * gap) * decay * 2.0 / (1.0 + twice)
    through = np.hstack([travelling[:, None], scaled * sign[:, None] * jv(order[:, None], rates[None, :] * gap)])

    factor = np.concatenate([[1.0 / (1j * k * norm0)], -1.0 / (rates * norms)])
    matrix = (through * factor) @ through.T
    # J_2p J_2q (-1)^(p+q) falls like 1 / (pi k g) in the mean
    last = modes + 0.5
    matrix -= scaled**2 * (2.0 / h) / (math.pi * gap) * (h / math.pi) ** 2 / last
    given = np.stack([plate_one.astype(complex), -1j * k * plate_wave])
    strength = np.linalg.solve(matrix, -(through * factor) @ given.T)
    velocity = given + strength.T @ through
    mass = -2.0 * water.density * complex((factor * velocity[0] * plate_one).sum())
    # The sum over sin^2(k g) / k^3 beyond the last mode
    mass += 2.0 * water.density * (0.5 * 2.0 / h) * (h / math.pi) ** 3 * 0.5 / last**2
    outward = complex(factor[0] * velocity[1, 0])
    return mass, -outward, 1.0 + outward
