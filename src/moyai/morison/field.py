"""Potential flow with circulation around a circular member: where the water runs fast, phase by phase."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike

from moyai.core.arrays import Array
from moyai.core.errors import InputError


def circle_velocity(points: ArrayLike, radius: float, stream: ArrayLike, circulation: float) -> Array:
    """Return the velocity around a circle in a stream with circulation [eq:circulation-field].

    Parameters
    ----------
    points : array_like, shape (..., 2)
        Along the first and second axis from the centre [m], none inside.
    radius : float
        a [m].
    stream : array_like, shape (2,)
        Undisturbed velocity [m/s].
    circulation : float
        Gamma [m2/s], positive clockwise.

    Returns
    -------
    ndarray, shape (..., 2)
        [m/s].

    Raises
    ------
    InputError
        When a point lies inside the circle.
    """
    place = np.asarray(points, dtype=float)
    z = place[..., 0] + 1j * place[..., 1]
    if (np.abs(z) < radius * (1.0 - 1e-12)).any():
        raise InputError(
            "a point lies inside the circle", parameter="points", allowed=f"at least {radius:g} m from its axis"
        )
    u, w = (float(value) for value in np.asarray(stream, dtype=float))
    # conjugate velocity: stream, doublet, clockwise vortex
    conjugate = (u - 1j * w) - (u + 1j * w) * (radius / z) ** 2 + 1j * circulation / (2.0 * math.pi * z)
    return np.stack([conjugate.real, -conjugate.imag], axis=-1)


def circle_surface_speed(angle: ArrayLike, radius: float, stream: ArrayLike, circulation: float) -> Array:
    """Return the speed of the water along the surface of a circle [m/s] at angles from the first axis [rad]."""
    turn = np.asarray(angle, dtype=float)
    points = radius * np.stack([np.cos(turn), np.sin(turn)], axis=-1)
    return np.asarray(np.linalg.norm(circle_velocity(points, radius, stream, circulation), axis=-1))
