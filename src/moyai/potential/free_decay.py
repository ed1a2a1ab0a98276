"""Free decay of a linear floating body in three independent ways: frequency integral, states, convolution.

Released from rest at an offset in still water. The frequency integral uses A(omega) and B(omega) alone and no memory
function, so that it shows whether a memory is right at long times, [eq:memory-decay].
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike
from scipy.interpolate import BSpline, make_interp_spline

from moyai.core.arrays import Array
from moyai.core.errors import InputError
from moyai.potential.damping_model import DampingModel
from moyai.potential.oscillatory import fourier_integral
from moyai.potential.state_space import StateSpace

_FIFTH = 5
_ROUNDS = 14


def decay_by_frequency(
    time: ArrayLike,
    offset: ArrayLike,
    mass: ArrayLike,
    stiffness: ArrayLike,
    model: DampingModel,
    infinite_frequency_added_mass: ArrayLike,
    *,
    points: int = 300,
    tolerance: float = 1e-8,
) -> Array:
    """Return the motion (t, m) by the inverse Fourier transform of the transfer function.

    Parameters
    ----------
    time : array_like (t,)
        [s].
    offset : array_like (m,)
        Position at release [m or rad].
    mass, stiffness : array_like (m, m)
        Of the body without added mass; hydrostatic and other restoring, positive definite.
    model : DampingModel
        Damping at every frequency; the added mass comes from its Hilbert transform.
    infinite_frequency_added_mass : array_like (m, m)
    points : int
        Frequencies to begin with.
    tolerance : float
        Frequencies are added until the integrand is interpolated to this share of its largest value.
    """
    x0, m, c = (np.asarray(item, dtype=float) for item in (offset, mass, stiffness))
    infinite = np.asarray(infinite_frequency_added_mass, dtype=float)
    if m.shape != c.shape or m.shape != infinite.shape or x0.shape != m.shape[:1]:
        raise InputError("offset, mass, stiffness and added mass do not belong together", parameter="mass")

    def density(frequency: Array) -> Array:
        w = frequency[:, None, None]
        impedance = c - w**2 * (m + infinite + model.added_mass_excess(frequency)) + 1j * w * model.damping(frequency)
        right = np.broadcast_to(-(c @ x0)[None, :, None], (len(frequency), len(x0), 1))
        return np.asarray(np.linalg.solve(impedance, right)[..., 0].imag / frequency[:, None])

    omega = 3.0 * model.knots[-1] * np.linspace(0.0, 1.0, points + 1)[1:] ** 2
    values = density(omega)
    for _ in range(_ROUNDS):
        # halve the intervals in which the spline misses the middle: lightly damped resonances are narrow
        middle = 0.5 * (np.concatenate([[0.0], omega[:-1]]) + omega)
        exact = density(middle)
        miss = np.abs(_even_spline(omega, values)(middle) - exact).max(axis=1)
        poor = miss > tolerance * np.abs(values).max()
        if not poor.any():
            break
        grown = np.concatenate([omega, middle[poor]])
        order = np.argsort(grown)
        omega, values = grown[order], np.concatenate([values, exact[poor]])[order]
    spline = _even_spline(omega, values)
    knots = np.concatenate([[0.0], omega])
    pieces = np.empty((6, len(omega), len(x0)))
    factor = 1.0
    for power in range(6):
        factor *= max(power, 1)
        # the fifth derivative jumps at the knots
        pieces[power] = spline(0.5 * (knots[:-1] + knots[1:]) if power == _FIFTH else knots[:-1], power) / factor
    return np.asarray(2.0 / np.pi * fourier_integral(knots, pieces, time).real)


def _even_spline(omega: Array, values: Array) -> BSpline:
    """Spline of fifth degree; the data are even in frequency and mirrored, which fixes the start."""
    x = np.concatenate([-omega[::-1], omega])
    return make_interp_spline(x, np.concatenate([values[::-1], values]), k=_FIFTH)


def decay_by_states(
    time: ArrayLike,
    offset: ArrayLike,
    mass: ArrayLike,
    stiffness: ArrayLike,
    states: StateSpace,
    infinite_frequency_added_mass: ArrayLike,
) -> Array:
    """Return the motion (t, m) of body and memory states, exact in time by the eigenvectors of the whole system."""
    x0, m, c = (np.asarray(item, dtype=float) for item in (offset, mass, stiffness))
    size, order = len(x0), states.order
    inverse = np.linalg.inv(m + np.asarray(infinite_frequency_added_mass, dtype=float))
    whole = np.zeros((2 * size + order, 2 * size + order))
    whole[:size, size : 2 * size] = np.eye(size)
    whole[size : 2 * size, :size] = -inverse @ c
    whole[size : 2 * size, 2 * size :] = -inverse @ states.c
    whole[2 * size :, size : 2 * size] = states.b
    whole[2 * size :, 2 * size :] = states.a
    values, vectors = np.linalg.eig(whole)
    start = np.zeros(len(whole))
    start[:size] = x0
    parts = vectors[:size] * np.linalg.solve(vectors, start)
    t = np.atleast_1d(np.asarray(time, dtype=float))
    return np.real(np.exp(values * t[:, None]) @ parts.T)


def decay_by_convolution(
    time_step: float,
    steps: int,
    offset: ArrayLike,
    mass: ArrayLike,
    stiffness: ArrayLike,
    velocity_kernel: Array,
    infinite_frequency_added_mass: ArrayLike,
    steady_rest: ArrayLike | None = None,
) -> Array:
    """Return the motion (steps + 1, m) by the trapezoidal rule for body and convolution (second order).

    Parameters
    ----------
    time_step : float
        [s].
    steps : int
    offset, mass, stiffness, infinite_frequency_added_mass
        As in :func:`decay_by_frequency`.
    velocity_kernel : ndarray (n, m, m)
        K at multiples of the step; its length is the length of the memory.
    steady_rest : array_like (m, m), optional
        Dashpot for the part of D(0) that the cut memory leaves out.
    """
    x0, m, c = (np.asarray(item, dtype=float) for item in (offset, mass, stiffness))
    size, length = len(x0), len(velocity_kernel)
    inertia = m + np.asarray(infinite_frequency_added_mass, dtype=float)
    rest = np.zeros((size, size)) if steady_rest is None else np.asarray(steady_rest, dtype=float)
    x, v, a = (np.zeros((steps + 1, size)) for _ in range(3))
    x[0] = x0
    a[0] = np.linalg.solve(inertia, -c @ x0)
    h = time_step
    # implicit part of a(n+1): inertia + h/2 (dashpot + h/2 K(0)) + h^2/4 c
    system = inertia + 0.5 * h * (rest + 0.5 * h * velocity_kernel[0]) + 0.25 * h**2 * c
    flat = np.ascontiguousarray(velocity_kernel.transpose(1, 0, 2))
    for n in range(1, steps + 1):
        count = min(n, length - 1)
        weights = np.ones(count)
        weights[-1] = 0.5 if count in (n, length - 1) else 1.0
        past = v[n - count : n][::-1]
        history = h * np.einsum("ikj,kj->i", flat[:, 1 : count + 1], past * weights[:, None])
        v_known, x_known = v[n - 1] + 0.5 * h * a[n - 1], x[n - 1] + h * v[n - 1] + 0.25 * h**2 * a[n - 1]
        force = -history - (rest + 0.5 * h * velocity_kernel[0]) @ v_known - c @ x_known
        a[n] = np.linalg.solve(system, force)
        v[n] = v_known + 0.5 * h * a[n]
        x[n] = x_known + 0.25 * h**2 * a[n]
    return x
