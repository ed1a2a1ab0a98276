"""Kinematics of linear waves: depth functions, sums over components at any points, stretching, Stokes drift.

All kernels take arrays and return arrays and can be called from other compiled kernels. A component is a wave
``a cos(k (x cos b + y sin b) - omega t + phase)``; its orbital motion uses the intrinsic frequency sigma (equal to
omega in still water), while its phase runs with the frequency omega of the fixed frame [eq:sea-elevation].
"""

from __future__ import annotations

import math
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from moyai.core.arrays import Array
from moyai.core.compiled import njit
from moyai.core.errors import InputError
from moyai.sea.vector_kernel import CONTRACT, REORDER, falling_exponential, sine_and_cosine

Stretching = Literal["constant", "linear", "wheeler"]

#: Codes of the treatment above still water, as the kernels take them.
STRETCHING_CODES: dict[str, int] = {"constant": 0, "linear": 1, "wheeler": 2}


def stretching_code(stretching: str) -> int:
    """Return the kernel's code of a stretching name.

    ``"constant"`` freezes the kinematics above still water, ``"linear"`` continues them with their slope at still
    water, ``"wheeler"`` maps the momentary column onto the still-water column [eq:sea-wheeler].

    Raises
    ------
    InputError
        When the name is unknown.
    """
    if stretching not in STRETCHING_CODES:
        raise InputError(
            f"unknown stretching {stretching!r}", parameter="stretching", allowed=", ".join(sorted(STRETCHING_CODES))
        )
    return STRETCHING_CODES[stretching]


@njit(cache=True, error_model="numpy")
def depth_functions_scalar(wave_number: float, water_depth: float, z: float) -> tuple[float, float, float]:
    """Return cosh k(z+h)/sinh kh, sinh k(z+h)/sinh kh, cosh k(z+h)/cosh kh for -h <= z <= 0 [eq:sea-depth-functions].

    Written with e^{kz} and e^{-2k(z+h)}, whose arguments are never positive, and with expm1 where the difference of
    two exponentials would cancel in shallow water.
    """
    if z > 0.0:
        z = 0.0
    elif z < -water_depth:
        z = -water_depth
    if math.isinf(water_depth):
        value = math.exp(wave_number * z)
        return value, value, value
    lift = math.exp(wave_number * z)
    from_bed = -2.0 * wave_number * (z + water_depth)
    whole = -2.0 * wave_number * water_depth
    sinh_part = -math.expm1(from_bed)
    cosh_part = 2.0 - sinh_part
    sinh_whole = -math.expm1(whole)
    return lift * cosh_part / sinh_whole, lift * sinh_part / sinh_whole, lift * cosh_part / (2.0 - sinh_whole)


@njit(cache=True, error_model="numpy")
def wheeler_elevation_scalar(z: float, elevation: float, water_depth: float) -> float:
    """Map a height in the momentary column -h..eta onto the still column -h..0 [eq:sea-wheeler]."""
    if math.isinf(water_depth):
        return z - elevation
    return (z - elevation) * water_depth / (water_depth + elevation)


@njit(cache=True, error_model="numpy", fastmath=CONTRACT)
def turn(
    x: float, y: float, wave_number: Array, cosines: Array, sines: Array, begin: Array, amplitude: Array,
    surface: Array, quarter: Array,
) -> None:  # fmt: skip
    """Write the elevation of each component at a place, and what it is a quarter of a period later."""
    for i in range(surface.size):
        sine, cosine = sine_and_cosine(wave_number[i] * (x * cosines[i] + y * sines[i]) + begin[i])
        surface[i], quarter[i] = amplitude[i] * cosine, amplitude[i] * sine


@njit(cache=True, error_model="numpy", fastmath=REORDER)
def _sum(values: Array) -> float:
    total = 0.0
    for i in range(values.size):
        total += values[i]
    return total


@njit(cache=True, error_model="numpy", fastmath=CONTRACT)
def lift_to(level: float, wave_number: Array, lift: Array) -> None:
    """Write e^{kz} of each component."""
    for i in range(lift.size):
        lift[i] = falling_exponential(wave_number[i] * level)


@njit(cache=True, error_model="numpy", fastmath=REORDER)
def _orbits(
    above: float, wave_number: Array, intrinsic_omega: Array, cosines: Array, sines: Array, shares: Array, back: Array,
    lift: Array, surface: Array, quarter: Array,
) -> tuple[float, float, float, float, float, float]:  # fmt: skip
    """Sum velocity and acceleration of all components; ``shares`` is 1 / (1 - e^{-2kh}) and ``back`` e^{-2kh}."""
    u = v = w = du = dv = dw = 0.0
    for i in range(surface.size):
        # cosh and sinh of k (z + h) over sinh kh: e^{kz} and e^{-k (z + 2h)} [eq:sea-depth-functions]
        k, sigma, down = wave_number[i], intrinsic_omega[i], back[i] / lift[i]
        horizontal, vertical = shares[i] * (lift[i] + down), shares[i] * (lift[i] - down)
        # above still water by the slope of each function at z = 0, k times the other one
        horizontal, vertical = horizontal + above * k * vertical, vertical + above * k * horizontal
        forward, upward = sigma * horizontal * surface[i], sigma * vertical
        across = sigma * sigma * horizontal * quarter[i]
        u += forward * cosines[i]
        v += forward * sines[i]
        w += upward * quarter[i]
        du += across * cosines[i]
        dv += across * sines[i]
        dw -= sigma * upward * surface[i]
    return u, v, w, du, dv, dw


@njit(cache=True, error_model="numpy")
def linear_velocity_acceleration(
    omega: Array,
    intrinsic_omega: Array,
    amplitude: Array,
    phase: Array,
    heading: Array,
    wave_number: Array,
    water_depth: float,
    x: Array,
    y: Array,
    z: Array,
    time: float,
    stretching: int,
    elevation: Array,
    velocity: Array,
    acceleration: Array,
) -> None:
    """Sum elevation, velocity and acceleration of all components at many nodes at one time, into given arrays.

    Parameters
    ----------
    omega, intrinsic_omega, amplitude, phase, heading, wave_number : array, shape (components,)
        The components (SI, rad).
    water_depth : float
        h [m], may be infinite.
    x, y, z : array, shape (nodes,)
        Nodes [m]; they may differ from call to call.
    time : float
        [s].
    stretching : int
        0 constant, 1 linear, 2 Wheeler; see :func:`stretching_code`.
    elevation : array, shape (nodes,), output
        Surface elevation above the node [m].
    velocity, acceleration : array, shape (nodes, 3), output
        Water velocity [m/s] and acceleration following the mean current [m/s2] (the local acceleration in still
        water) [eq:sea-linear-kinematics].
    """
    cosines, sines = np.cos(heading), np.sin(heading)
    # what belongs to the component, not to the node; e^{-2kh} is zero in infinite depth
    shares, back = -1.0 / np.expm1(-2.0 * wave_number * water_depth), np.exp(-2.0 * wave_number * water_depth)
    sum_orbits(
        omega, intrinsic_omega, amplitude, phase, wave_number, cosines, sines, shares, back, water_depth, x, y, z, time,
        stretching, elevation, velocity, acceleration,
    )  # fmt: skip


@njit(cache=True, error_model="numpy")
def sum_orbits(
    omega: Array, intrinsic_omega: Array, amplitude: Array, phase: Array, wave_number: Array, cosines: Array,
    sines: Array, shares: Array, back: Array, water_depth: float, x: Array, y: Array, z: Array, time: float,
    stretching: int, elevation: Array, velocity: Array, acceleration: Array,
) -> None:  # fmt: skip
    """Do what :func:`linear_velocity_acceleration` does, with what belongs to the components found beforehand.

    Parameters
    ----------
    cosines, sines : array, shape (components,)
        Of the heading.
    shares, back : array, shape (components,)
        1 / (1 - e^{-2kh}) and e^{-2kh}.
    """
    count = omega.size
    begin = phase - omega * time
    surface, quarter, lift = np.empty(count), np.empty(count), np.empty(count)
    for node in range(x.size):
        level = z[node]
        turn(x[node], y[node], wave_number, cosines, sines, begin, amplitude, surface, quarter)
        eta = _sum(surface)
        if stretching == 2:
            level = wheeler_elevation_scalar(level, eta, water_depth)
        above = level if (stretching == 1 and level > 0.0) else 0.0
        lift_to(min(max(level, -water_depth), 0.0), wave_number, lift)
        u, v, w, du, dv, dw = _orbits(
            above, wave_number, intrinsic_omega, cosines, sines, shares, back, lift, surface, quarter
        )
        elevation[node] = eta
        velocity[node, 0], velocity[node, 1], velocity[node, 2] = u, v, w
        acceleration[node, 0], acceleration[node, 1], acceleration[node, 2] = du, dv, dw


@njit(cache=True, error_model="numpy")
def sum_orbits_of_seas(
    seas: NDArray[np.float64], water_depth: float, x: Array, y: Array, z: Array, time: float, stretching: int,
    elevation: Array, velocity: Array, acceleration: Array,
) -> None:  # fmt: skip
    """Sum as many seas as ``seas`` (seas, 9, components) holds, each at its own part of the nodes, all of one length.

    The nine rows are those of :func:`sum_orbits`.
    """
    size = x.size // seas.shape[0]
    for number in range(seas.shape[0]):
        sea, first, last = seas[number], number * size, (number + 1) * size
        sum_orbits(
            sea[0], sea[1], sea[2], sea[3], sea[4], sea[5], sea[6], sea[7], sea[8], water_depth, x[first:last],
            y[first:last], z[first:last], time, stretching, elevation[first:last], velocity[first:last],
            acceleration[first:last],
        )  # fmt: skip


@njit(cache=True, error_model="numpy")
def transfer_velocity_acceleration(
    omega: Array,
    intrinsic_omega: Array,
    heading: Array,
    wave_number: Array,
    water_depth: float,
    x: Array,
    y: Array,
    z: Array,
    stretching: int,
    velocity: NDArray[np.complex128],
    acceleration: NDArray[np.complex128],
) -> None:
    """Fill complex velocity and acceleration per unit complex amplitude at fixed nodes, shape (nodes, 3, components).

    The motion is Re(transfer * a e^{i phase} e^{-i omega t}). For nodes that stay where they are this is computed
    once; each time then costs one complex product per entry, or one Fourier transform per row.
    ``stretching`` is 0 (constant) or 1 (linear).
    """
    for node in range(x.size):
        for i in range(omega.size):
            cosine, sine = math.cos(heading[i]), math.sin(heading[i])
            k, sigma = wave_number[i], intrinsic_omega[i]
            horizontal, vertical, _ = depth_functions_scalar(k, water_depth, z[node])
            if stretching == 1 and z[node] > 0.0:
                horizontal, vertical = horizontal + z[node] * k * vertical, vertical + z[node] * k * horizontal
            argument = k * (x[node] * cosine + y[node] * sine)
            turn = complex(math.cos(argument), math.sin(argument))
            velocity[node, 0, i] = sigma * horizontal * cosine * turn
            velocity[node, 1, i] = sigma * horizontal * sine * turn
            velocity[node, 2, i] = -1j * sigma * vertical * turn
            for axis in range(3):
                acceleration[node, axis, i] = -1j * sigma * velocity[node, axis, i]


@njit(cache=True, error_model="numpy")
def sum_over_uniform_time(
    omega: Array, amplitudes: NDArray[np.complex128], start: float, step: float, out: Array
) -> None:
    """Sum Re(amplitudes[row, i] e^{-i omega_i t}) at t = start + n step into ``out[row, n]``, any frequencies.

    Each component turns by a constant factor from step to step; the factor is started anew every 256 steps, which
    keeps the rounding of the recurrence near 1e-14 of the amplitude.
    """
    block = 256
    steps = out.shape[1]
    for row in range(amplitudes.shape[0]):
        for n in range(steps):
            out[row, n] = 0.0
        for i in range(omega.size):
            turn_real, turn_imaginary = math.cos(omega[i] * step), -math.sin(omega[i] * step)
            first = 0
            while first < steps:
                angle = omega[i] * (start + first * step)
                cosine, sine = math.cos(angle), -math.sin(angle)
                real = amplitudes[row, i].real * cosine - amplitudes[row, i].imag * sine
                imaginary = amplitudes[row, i].real * sine + amplitudes[row, i].imag * cosine
                last = min(first + block, steps)
                for n in range(first, last):
                    out[row, n] += real
                    real, imaginary = (
                        real * turn_real - imaginary * turn_imaginary,
                        real * turn_imaginary + imaginary * turn_real,
                    )
                first = last


@njit(cache=True, error_model="numpy")
def sum_over_any_time(omega: Array, amplitudes: NDArray[np.complex128], time: Array, out: Array) -> None:
    """Sum Re(amplitudes[row, i] e^{-i omega_i t}) at arbitrary times into ``out[row, n]``."""
    for n in range(time.size):
        for row in range(amplitudes.shape[0]):
            out[row, n] = 0.0
        for i in range(omega.size):
            cosine, sine = math.cos(omega[i] * time[n]), math.sin(omega[i] * time[n])
            for row in range(amplitudes.shape[0]):
                out[row, n] += amplitudes[row, i].real * cosine + amplitudes[row, i].imag * sine


@njit(cache=True, error_model="numpy")
def _depth_functions(wave_number: Array, water_depth: Array, z: Array, out: Array) -> None:
    for i in range(z.size):
        out[0, i], out[1, i], out[2, i] = depth_functions_scalar(wave_number[i], water_depth[i], z[i])


@njit(cache=True, error_model="numpy")
def stokes_drift_scalar(amplitude: float, omega: float, wave_number: float, water_depth: float, z: float) -> float:
    """Return a^2 omega k cosh 2k(z+h) / (2 sinh^2 kh) [m/s] [eq:sea-stokes-drift]."""
    horizontal, vertical, _ = depth_functions_scalar(wave_number, water_depth, z)
    # cosh 2q = cosh^2 q + sinh^2 q
    return 0.5 * amplitude * amplitude * omega * wave_number * (horizontal * horizontal + vertical * vertical)


@njit(cache=True, error_model="numpy")
def _stokes_drift(amplitude: Array, omega: Array, wave_number: Array, water_depth: float, z: Array, out: Array) -> None:
    for n in range(z.size):
        for i in range(omega.size):
            out[n, i] = stokes_drift_scalar(amplitude[i], omega[i], wave_number[i], water_depth, z[n])


def depth_functions(wave_number: ArrayLike, water_depth: ArrayLike, z: ArrayLike) -> tuple[Array, Array, Array]:
    """Return the depth functions of linear waves.

    Parameters
    ----------
    wave_number : array_like
        k [1/m].
    water_depth : array_like
        h [m], may be infinite.
    z : array_like
        Height above still water [m]; values above 0 or below the bed are taken at those limits.

    Returns
    -------
    horizontal, vertical, pressure : ndarray
        cosh k(z+h)/sinh kh, sinh k(z+h)/sinh kh and cosh k(z+h)/cosh kh, broadcast [eq:sea-depth-functions].
    """
    k, h, level = np.broadcast_arrays(*(np.asarray(item, dtype=np.float64) for item in (wave_number, water_depth, z)))
    out = np.empty((3, k.size))
    _depth_functions(*(np.array(item).reshape(-1) for item in (k, h, level)), out)
    shaped = out.reshape((3, *k.shape))
    return shaped[0], shaped[1], shaped[2]


def wheeler_elevation(z: ArrayLike, elevation: ArrayLike, water_depth: float) -> Array:
    """Return the height in still water at which linear kinematics are taken for a point at ``z`` under ``elevation``.

    Wheeler's stretching z' = h (z - eta) / (h + eta), z' = z - eta in infinite depth [eq:sea-wheeler]. The bed maps
    onto the bed and the surface onto still water. All lengths in metres.
    """
    level, eta = np.asarray(z, dtype=np.float64), np.asarray(elevation, dtype=np.float64)
    if math.isinf(water_depth):
        return np.asarray(level - eta)
    return np.asarray((level - eta) * water_depth / (water_depth + eta))


def stokes_drift(
    amplitude: ArrayLike, omega: ArrayLike, wave_number: ArrayLike, water_depth: float, z: ArrayLike
) -> Array:
    """Return the second-order Stokes drift of each component.

    Parameters
    ----------
    amplitude, omega, wave_number : array_like, shape (components,)
        Amplitude [m], intrinsic frequency [rad/s], wave number [1/m].
    water_depth : float
        h [m], may be infinite.
    z : array_like
        Heights [m], at most 0.

    Returns
    -------
    ndarray, shape (*z.shape, components)
        Drift along the heading of each component [m/s]; the drift of an irregular sea is their vector sum
        [eq:sea-stokes-drift].
    """
    level = np.asarray(z, dtype=np.float64)
    a, w, k = (np.atleast_1d(np.asarray(item, dtype=np.float64)) for item in (amplitude, omega, wave_number))
    a, w, k = (np.ascontiguousarray(item) for item in np.broadcast_arrays(a, w, k))
    out = np.empty((level.size, a.size))
    _stokes_drift(a, w, k, float(water_depth), np.ascontiguousarray(level).reshape(-1), out)
    return out.reshape((*level.shape, a.size))
