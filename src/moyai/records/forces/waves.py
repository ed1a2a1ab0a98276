"""Velocity and acceleration of the water at a member from the record of a wave gauge, by linear theory."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike

from moyai.core.arrays import Array
from moyai.core.errors import InputError
from moyai.sea.dispersion import wave_number
from moyai.sea.kinematics import depth_functions

#: Harmonics of a regular elevation that are carried along as bound to the first
_BOUND = 3


def orbital_motion(
    time: ArrayLike,
    elevation: ArrayLike,
    *,
    water_depth: float,
    gravity: float,
    height: float,
    distance: float = 0.0,
    period: float | None = None,
) -> tuple[Array, Array]:
    """Return velocity and acceleration across a member from the elevation at a gauge [eq:identification-gauge].

    Parameters
    ----------
    time : array_like
        Evenly spaced [s].
    elevation : array_like
        Surface at the gauge [m]; its mean does not matter.
    water_depth, gravity : float
        [m], may be infinite; [m/s2].
    height : float
        z of the axis of the member above still water, negative [m].
    distance : float
        From the gauge to the member in the direction of the waves [m].
    period : float, optional
        Of regular waves [s]: mean and three bound harmonics are fitted. None takes the whole record as a sum of free
        waves by a Fourier transform, which repeats itself: a period or two at its ends are spoilt.

    Returns
    -------
    velocity, acceleration : ndarray, shape (samples, 2)
        Horizontal in the direction of the waves, and vertical [m/s], [m/s2].

    Raises
    ------
    InputError
        For gaps, or a member that is not between bed and still water.
    """
    t, eta = np.asarray(time, dtype=float), np.asarray(elevation, dtype=float)
    if t.shape != eta.shape or t.ndim != 1 or t.size < 12:
        raise InputError(
            f"{eta.size} elevations for {t.size} instants", parameter="elevation", allowed="equal, at least 12"
        )
    if not (np.isfinite(eta).all() and np.isfinite(t).all()):
        row = int(np.argmin(np.isfinite(eta) & np.isfinite(t))) + 1
        raise InputError(f"elevation is not a number in sample {row}", parameter="elevation", remedy="fill the gap")
    if not -water_depth <= height < 0.0:
        raise InputError(
            f"the axis of the member is at z = {height:g} m",
            parameter="member_z",
            allowed=f"{-water_depth:g} to below 0 m",
        )
    if period is not None:
        return _regular(t, eta, water_depth, gravity, height, distance, 2.0 * math.pi / period)
    return _irregular(t, eta, water_depth, gravity, height, distance)


def _regular(
    t: Array, eta: Array, depth: float, gravity: float, height: float, distance: float, omega: float
) -> tuple[Array, Array]:
    orders = np.arange(1, _BOUND + 1)
    middle = t - t.mean()
    angle = omega * middle[:, None] * orders
    design = np.column_stack([np.ones_like(t), np.cos(angle), np.sin(angle)])
    fit, *_ = np.linalg.lstsq(design, eta, rcond=None)
    # eta = Re sum E e^{-i n omega t}
    amplitude = fit[1 : _BOUND + 1] + 1j * fit[_BOUND + 1 :]
    k = float(wave_number(omega, depth, gravity))
    horizontal, vertical, _ = depth_functions(orders * k, depth, height)
    moved = amplitude * np.exp(1j * orders * k * distance) * orders * omega
    parts = np.stack([horizontal * moved, -1j * vertical * moved])
    turn = np.exp(-1j * angle)
    return (turn @ parts.T).real, (turn @ (-1j * orders * omega * parts).T).real


def _irregular(
    t: Array, eta: Array, depth: float, gravity: float, height: float, distance: float
) -> tuple[Array, Array]:
    step = (t[-1] - t[0]) / (t.size - 1)
    omega = 2.0 * math.pi * np.fft.rfftfreq(t.size, step)
    spectrum = np.fft.rfft(eta - eta.mean())
    k = np.zeros_like(omega)
    k[1:] = wave_number(omega[1:], depth, gravity)
    horizontal, vertical = np.zeros_like(omega), np.zeros_like(omega)
    horizontal[1:], vertical[1:], _ = depth_functions(k[1:], depth, height)
    # the transform turns with e^{+i omega t}: signs of the phase are those of the conjugate
    moved = spectrum * np.exp(-1j * k * distance) * omega
    parts = np.stack([horizontal * moved, 1j * vertical * moved], axis=1)
    rate = 1j * omega[:, None] * parts
    if t.size % 2 == 0:
        # the highest frequency has no phase
        parts[-1] = rate[-1] = 0.0
    return np.fft.irfft(parts, t.size, axis=0), np.fft.irfft(rate, t.size, axis=0)
