"""Orbits of the water in the plane across a member: amplitudes, sense, Keulegan-Carpenter number.

For harmonic motion two combinations of velocity and acceleration do not change in time, so that the momentary orbit is
known without averaging [eq:morison-orbit].
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from moyai.core.arrays import Array


def orbit_product(velocity: ArrayLike, acceleration: ArrayLike, omega: ArrayLike) -> Array:
    """Return the signed product of the semi-axes of the velocity orbit.

    Parameters
    ----------
    velocity, acceleration : array_like, shape (..., 2)
        Along the first and second axis of the section [m/s], [m/s2].
    omega : array_like
        Angular frequency [rad/s].

    Returns
    -------
    ndarray
        (w du/dt - u dw/dt) / omega [m2/s2]; positive for clockwise orbits, as under waves towards the first axis with
        the second axis up, zero for planar motion [eq:morison-orbit].
    """
    u, a = np.asarray(velocity, dtype=float), np.asarray(acceleration, dtype=float)
    return np.asarray((u[..., 1] * a[..., 0] - u[..., 0] * a[..., 1]) / omega)


def orbit_amplitudes(velocity: ArrayLike, acceleration: ArrayLike, omega: ArrayLike) -> tuple[Array, Array]:
    """Return the larger and the smaller semi-axis of the velocity orbit [m/s] [eq:morison-orbit].

    Shapes as in :func:`orbit_product`. Exact for harmonic motion; for a narrow band of frequencies the envelope.
    """
    u, a = np.asarray(velocity, dtype=float), np.asarray(acceleration, dtype=float)
    square = np.sum(u**2, axis=-1) + np.sum(a**2, axis=-1) / np.asarray(omega) ** 2
    product = np.abs(orbit_product(u, a, omega))
    # (major + minor)^2 and (major - minor)^2
    total, difference = np.sqrt(square + 2.0 * product), np.sqrt(np.maximum(square - 2.0 * product, 0.0))
    return np.asarray(0.5 * (total + difference)), np.asarray(0.5 * (total - difference))


def mean_frequency(velocity: ArrayLike, acceleration: ArrayLike) -> Array:
    """Return the angular frequency [rad/s] that gives velocity and acceleration their mean squares over time.

    Time is the first axis; the mean velocity is taken off. Zero where nothing moves.
    """
    u, a = np.asarray(velocity, dtype=float), np.asarray(acceleration, dtype=float)
    power = np.sum(np.var(u, axis=0), axis=-1)
    rate = np.sum(np.mean(a**2, axis=0), axis=-1)
    return np.asarray(np.sqrt(np.divide(rate, power, out=np.zeros_like(power), where=power > 0.0)))
