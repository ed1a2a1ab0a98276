"""Linear dispersion: wave numbers, evanescent wave numbers, phase and group velocity, Doppler shift.

Every quantity is exact to rounding for any relative depth kh, infinite depth included: exponentials only ever have
negative arguments. The scalar kernels named ``*_scalar`` can be called from other compiled kernels.
"""

from __future__ import annotations

import math
from typing import Any, overload

import numpy as np
from numpy.typing import ArrayLike

from moyai.core.arrays import Array
from moyai.core.compiled import njit
from moyai.core.errors import InputError

_ITERATIONS = 60


@njit(cache=True, error_model="numpy")
def relative_depth_scalar(deep_relative_depth: float) -> float:
    """Solve y tanh y = x for y = kh, given x = omega^2 h / g [eq:sea-dispersion].

    Halley's method on a guess that is within 1 % everywhere (Guo's form); the correction is computed from the
    residual itself, so the last step leaves rounding only.
    """
    x = deep_relative_depth
    if x <= 0.0:
        return 0.0
    y = x * (-math.expm1(-x * math.sqrt(math.sqrt(x)))) ** -0.4 if x > 1e-3 else math.sqrt(x)
    for _ in range(_ITERATIONS):
        t = math.tanh(y)
        # sech^2 as a product: 1 - t*t would be noise in deep water
        bend = (1.0 - t) * (1.0 + t)
        slope = t + y * bend
        residual = y * t - x
        step = residual * slope / (slope * slope - residual * bend * (1.0 - y * t))
        y -= step
        if abs(step) <= 1e-6 * y:
            # third order: what is left after this step is of the order of step^3
            break
    return y


@njit(cache=True, error_model="numpy")
def wave_number_scalar(omega: float, water_depth: float, gravity: float) -> float:
    """Return the wave number k [1/m] of ``omega`` [rad/s]; for use inside other kernels."""
    deep = omega * omega / gravity
    if math.isinf(water_depth):
        return deep
    return relative_depth_scalar(deep * water_depth) / water_depth


@njit(cache=True, error_model="numpy")
def group_ratio_scalar(relative_depth: float) -> float:
    """Return G = 2kh / sinh 2kh, between 1 (shallow) and 0 (deep), without overflow."""
    if relative_depth <= 0.0:
        return 1.0
    if relative_depth > 400.0:
        return 0.0
    four = 4.0 * relative_depth
    return four * math.exp(-0.5 * four) / -math.expm1(-four)


@njit(cache=True, error_model="numpy")
def group_velocity_scalar(wave_number: float, water_depth: float, gravity: float) -> float:
    """Return the group velocity [m/s] of waves of ``wave_number`` [1/m] in still water."""
    if math.isinf(water_depth):
        return 0.5 * math.sqrt(gravity / wave_number)
    y = wave_number * water_depth
    if y <= 0.0:
        return math.sqrt(gravity * water_depth)
    phase_velocity = math.sqrt(gravity * water_depth * math.tanh(y) / y)
    return 0.5 * phase_velocity * (1.0 + group_ratio_scalar(y))


@njit(cache=True, error_model="numpy")
def evanescent_deficit_scalar(deep_relative_depth: float, index: int) -> float:
    """Return delta_n in k_n h = n pi - delta_n, the root of delta = arctan(x / (n pi - delta)).

    The deficit lies in [0, pi/2]; Newton's method on the arctangent form is contracting everywhere and keeps the
    relative accuracy of delta itself, however small [eq:sea-evanescent].
    """
    x = deep_relative_depth
    if x <= 0.0:
        return 0.0
    if math.isinf(x):
        return 0.5 * math.pi
    turn = index * math.pi
    delta = math.atan2(x, turn)
    for _ in range(_ITERATIONS):
        y = turn - delta
        step = (math.atan2(x, y) - delta) / (1.0 - x / (y * y + x * x) if x < 1e100 else 1.0)
        delta += step
        if abs(step) <= 1e-10 * delta:
            break
    return delta


@njit(cache=True, error_model="numpy")
def blocking_scalar(water_depth: float, gravity: float, opposing_speed: float) -> tuple[float, float]:
    """Return wave number and fixed-frame frequency at which an opposing current stops the wave energy.

    The group velocity falls from sqrt(g h) to zero with growing k, so there is one k with c_g = ``opposing_speed``
    (positive). Both are zero when the current is faster than every wave.
    """
    deep = gravity / (4.0 * opposing_speed * opposing_speed)
    if math.isinf(water_depth):
        return deep, math.sqrt(gravity * deep) - deep * opposing_speed
    if opposing_speed * opposing_speed >= gravity * water_depth:
        return 0.0, 0.0
    # in water of finite depth the group velocity exceeds half the phase velocity, so the deep-water value bounds from
    # below only where tanh is near 1: bracket by doubling, then bisect on the logarithm
    lower, upper = 1e-9 / water_depth, max(deep, 1.0 / water_depth)
    while group_velocity_scalar(upper, water_depth, gravity) > opposing_speed:
        upper *= 2.0
    while group_velocity_scalar(lower, water_depth, gravity) < opposing_speed and lower * water_depth > 1e-200:
        lower *= 1e-3
    for _ in range(200):
        middle = math.sqrt(lower) * math.sqrt(upper)
        if group_velocity_scalar(middle, water_depth, gravity) > opposing_speed:
            lower = middle
        else:
            upper = middle
        if upper - lower <= 4e-16 * upper:
            break
    k = 0.5 * (lower + upper)
    return k, math.sqrt(gravity * k * math.tanh(k * water_depth)) - k * opposing_speed


@njit(cache=True, error_model="numpy")
def wave_number_in_current_scalar(omega: float, water_depth: float, gravity: float, current: float) -> float:
    """Solve omega = sqrt(g k tanh kh) + k U for k [1/m]; NaN where an opposing current blocks the wave.

    ``current`` U is the component along the heading of the wave. The function is concave in k, and Newton's method
    started at the wave number of still water approaches the root from its lower side without overshoot
    [eq:sea-doppler].
    """
    k = wave_number_scalar(omega, water_depth, gravity)
    if current == 0.0 or k <= 0.0:
        return k
    if math.isinf(water_depth):
        discriminant = 1.0 + 4.0 * current * omega / gravity
        if discriminant < 0.0:
            return math.nan
        return 4.0 * omega * omega / (gravity * (1.0 + math.sqrt(discriminant)) ** 2)
    if current < 0.0:
        limit, highest = blocking_scalar(water_depth, gravity, -current)
        # at the limit itself the root is double; the margin is the rounding of the subtraction
        if omega > highest:
            return math.nan if omega > highest * (1.0 + 1e-12) else limit
    for _ in range(200):
        intrinsic = math.sqrt(gravity * k * math.tanh(k * water_depth))
        slope = group_velocity_scalar(k, water_depth, gravity) + current
        if slope <= 0.0:
            break
        step = (intrinsic + k * current - omega) / slope
        k -= step
        if abs(step) <= 1e-15 * k:
            break
    return k


@njit(cache=True, error_model="numpy")
def _wave_numbers(omega: Array, depth: Array, gravity: Array, out: Array) -> None:
    for i in range(omega.size):
        out[i] = wave_number_scalar(omega[i], depth[i], gravity[i])


@njit(cache=True, error_model="numpy")
def _wave_numbers_in_current(omega: Array, depth: Array, gravity: Array, current: Array, out: Array) -> None:
    for i in range(omega.size):
        out[i] = wave_number_in_current_scalar(omega[i], depth[i], gravity[i], current[i])


@njit(cache=True, error_model="numpy")
def _group_velocities(wave_number: Array, depth: Array, gravity: Array, out: Array) -> None:
    for i in range(wave_number.size):
        out[i] = group_velocity_scalar(wave_number[i], depth[i], gravity[i])


@njit(cache=True, error_model="numpy")
def _evanescent_deficits(deep_relative_depth: Array, out: Array) -> None:
    for i in range(out.shape[0]):
        for n in range(out.shape[1]):
            out[i, n] = evanescent_deficit_scalar(deep_relative_depth[i], n + 1)


def _check(name: str, value: ArrayLike, *, zero: bool, infinite: bool = False) -> Array:
    array = np.asarray(value, dtype=np.float64)
    bad = np.isnan(array) | (array < 0.0 if zero else array <= 0.0)
    if not infinite:
        bad |= np.isinf(array)
    if bad.any():
        found = float(array[bad].flat[0])
        allowed = ("at least 0" if zero else "greater than 0") + ("" if infinite else ", finite")
        raise InputError(f"{name} is {found:g}", parameter=name, allowed=allowed)
    return array


def _spread(kernel: Any, *arguments: Array) -> Any:
    """Broadcast the arguments, run a compiled loop over them, give the shape back (scalars as float)."""
    arrays = np.broadcast_arrays(*arguments)
    shape = arrays[0].shape
    # copies: numba warns of arrays that broadcasting made, which share their memory
    flat = [np.array(array, dtype=np.float64).reshape(-1) for array in arrays]
    out = np.empty(flat[0].size)
    kernel(*flat, out)
    return float(out[0]) if shape == () else out.reshape(shape)


@overload
def wave_number(omega: float, water_depth: float, gravity: float) -> float: ...
@overload
def wave_number(omega: ArrayLike, water_depth: ArrayLike, gravity: ArrayLike) -> Array: ...
def wave_number(omega: ArrayLike, water_depth: ArrayLike, gravity: ArrayLike) -> Any:
    """Return the wave number of linear waves in still water.

    Parameters
    ----------
    omega : float or array
        Angular frequency [rad/s], zero allowed.
    water_depth : float or array
        Water depth h [m]; ``math.inf`` for infinite depth.
    gravity : float or array
        Acceleration of gravity g [m/s2].

    Returns
    -------
    float or ndarray
        Wave number k [1/m], the positive root of omega^2 = g k tanh kh, exact to rounding for any kh
        [eq:sea-dispersion].

    Raises
    ------
    InputError
        When an argument is negative, NaN, or an infinite frequency.

    Examples
    --------
    >>> import math
    >>> from moyai.sea import wave_number
    >>> k = wave_number(2.0 * math.pi / 6.0, water_depth=10.0, gravity=9.81)
    >>> round(2.0 * math.pi / k, 2)                                  # wavelength of a wave of 6 s [m]
    48.41
    """
    return _spread(
        _wave_numbers,
        _check("omega", omega, zero=True),
        _check("water_depth", water_depth, zero=False, infinite=True),
        _check("gravity", gravity, zero=False),
    )


@overload
def angular_frequency(wave_number: float, water_depth: float, gravity: float) -> float: ...
@overload
def angular_frequency(wave_number: ArrayLike, water_depth: ArrayLike, gravity: ArrayLike) -> Array: ...
def angular_frequency(wave_number: ArrayLike, water_depth: ArrayLike, gravity: ArrayLike) -> Any:
    """Return the angular frequency of waves of a wave number: the inverse of :func:`wave_number` [eq:sea-dispersion].

    Parameters
    ----------
    wave_number : array_like
        k [1/m], 0 or more.
    water_depth : array_like
        [m], greater than 0; infinite is allowed.
    gravity : array_like
        [m/s2].

    Returns
    -------
    float or ndarray
        [rad/s], of the shape of the arguments together.

    Raises
    ------
    InputError
        When an argument is negative or NaN.

    Examples
    --------
    >>> from moyai.sea import angular_frequency
    >>> round(angular_frequency(0.1, water_depth=10.0, gravity=9.81), 4)   # sqrt(0.981 tanh 1) [rad/s]
    0.8644
    """
    k = _check("wave_number", wave_number, zero=True)
    depth = _check("water_depth", water_depth, zero=False, infinite=True)
    g = _check("gravity", gravity, zero=False)
    with np.errstate(invalid="ignore"):
        relative = np.where(k > 0.0, k * depth, 0.0)
    result = np.sqrt(g * k * np.tanh(relative))
    return float(result) if result.ndim == 0 else result


def evanescent_wave_numbers(omega: ArrayLike, water_depth: float, gravity: float, count: int) -> Array:
    """Return the first ``count`` evanescent wave numbers, the real roots of omega^2 = -g k tan kh.

    Parameters
    ----------
    omega : float or array
        Angular frequency [rad/s]; zero gives k_n = n pi / h.
    water_depth : float
        Water depth h [m], finite (in infinite depth the roots form a continuum).
    gravity : float
        Acceleration of gravity [m/s2].
    count : int
        Number of roots.

    Returns
    -------
    ndarray, shape (..., count)
        k_n [1/m] in ((n - 1/2) pi / h, n pi / h], n = 1 ... count, exact to rounding [eq:sea-evanescent].

    Raises
    ------
    InputError
        When the depth is infinite or an argument is out of range.

    See Also
    --------
    evanescent_deficits : n pi - k_n h with full relative accuracy.
    """
    deficits = evanescent_deficits(omega, water_depth, gravity, count)
    return (np.arange(1, count + 1) * math.pi - deficits) / water_depth


def evanescent_deficits(omega: ArrayLike, water_depth: float, gravity: float, count: int) -> Array:
    """Return delta_n = n pi - k_n h in [0, pi/2] [rad], each with full relative accuracy.

    cos(k_n h) = (-1)^n cos(delta_n) and sin(k_n h) = -(-1)^n sin(delta_n) follow without the loss of digits that
    k_n h itself suffers for large n. Arguments and errors as :func:`evanescent_wave_numbers`.
    """
    frequencies = _check("omega", omega, zero=True)
    depth = float(_check("water_depth", water_depth, zero=False, infinite=True))
    g = float(_check("gravity", gravity, zero=False))
    if math.isinf(depth):
        raise InputError(
            "water_depth is infinite",
            parameter="water_depth",
            allowed="finite",
            remedy="there are no discrete roots there",
        )
    if count < 0:
        raise InputError(f"count is {count}", parameter="count", allowed="at least 0")
    shape = frequencies.shape
    flat = np.ascontiguousarray(frequencies).reshape(-1)
    out = np.empty((flat.size, count))
    _evanescent_deficits(flat * flat / g * depth, out)
    return out.reshape((*shape, count))


def phase_velocity(omega: ArrayLike, water_depth: ArrayLike, gravity: ArrayLike) -> Any:
    """Return the phase velocity omega / k in still water [eq:sea-phase-velocity].

    At zero frequency it is the shallow limit sqrt(g h).

    Parameters
    ----------
    omega : array_like
        Angular frequency [rad/s], 0 or more.
    water_depth : array_like
        [m], greater than 0; infinite is allowed.
    gravity : array_like
        [m/s2].

    Returns
    -------
    float or ndarray
        [m/s], of the shape of the arguments together.

    Raises
    ------
    InputError
        When an argument is negative or NaN.

    Examples
    --------
    >>> from moyai.sea import phase_velocity
    >>> round(phase_velocity(1.0, water_depth=float("inf"), gravity=9.81), 3)   # g / omega in deep water [m/s]
    9.81
    """
    k = np.asarray(wave_number(omega, water_depth, gravity))
    frequency, depth, g, k = np.broadcast_arrays(np.asarray(omega, float), water_depth, gravity, k)
    with np.errstate(invalid="ignore", divide="ignore"):
        result = np.where(k > 0.0, frequency / k, np.sqrt(g * depth))
    return float(result) if result.ndim == 0 else result


def group_velocity(omega: ArrayLike, water_depth: ArrayLike, gravity: ArrayLike) -> Any:
    """Return the group velocity d omega / d k [m/s] in still water [eq:sea-group-velocity].

    Parameters
    ----------
    omega, water_depth, gravity : array_like
        As for :func:`wave_number`, broadcast against each other.

    Returns
    -------
    float or ndarray
        Of the broadcast shape.

    Raises
    ------
    InputError
        As :func:`wave_number`.

    Examples
    --------
    >>> from moyai.sea import group_velocity
    >>> round(group_velocity(1.0, water_depth=float("inf"), gravity=9.81), 3)   # g / (2 omega) in deep water [m/s]
    4.905
    """
    k = wave_number(omega, water_depth, gravity)
    return _spread(_group_velocities, np.asarray(k), np.asarray(water_depth, float), np.asarray(gravity, float))


def wave_number_in_current(
    omega: ArrayLike, water_depth: ArrayLike, gravity: ArrayLike, current_along_wave: ArrayLike
) -> Any:
    """Return the wave number of waves whose period is given in the fixed frame, on a uniform current.

    Parameters
    ----------
    omega : float or array
        Angular frequency in the fixed frame [rad/s].
    water_depth, gravity : float or array
        As in :func:`wave_number`.
    current_along_wave : float or array
        Component U of the current along the heading of the wave [m/s]: positive with the wave, negative against it.

    Returns
    -------
    float or ndarray
        Wave number k [1/m] of (omega - k U)^2 = g k tanh kh, the branch that becomes the still-water wave as U -> 0
        [eq:sea-doppler].

    Raises
    ------
    InputError
        When an opposing current blocks the wave: its group velocity cannot overcome the current.

    Examples
    --------
    >>> from moyai.sea import wave_number_in_current
    >>> k = [wave_number_in_current(1.0, float("inf"), 9.81, speed) for speed in (0.0, 1.0, -1.0)]
    >>> [round(value, 4) for value in k]                                 # less with the current, more against it [1/m]
    [0.1019, 0.0853, 0.1302]
    """
    frequency = _check("omega", omega, zero=True)
    depth = _check("water_depth", water_depth, zero=False, infinite=True)
    g = _check("gravity", gravity, zero=False)
    current = np.asarray(current_along_wave, dtype=np.float64)
    if not np.isfinite(current).all():
        raise InputError("current_along_wave is not finite", parameter="current_along_wave", allowed="finite")
    result = _spread(_wave_numbers_in_current, frequency, depth, g, current)
    blocked = np.isnan(result)
    if np.any(blocked):
        frequency, depth, g, current, mask = np.broadcast_arrays(frequency, depth, g, current, blocked)
        first = int(np.flatnonzero(mask)[0])
        speed = -float(current.flat[first])
        _, limit = blocking_scalar(float(depth.flat[first]), float(g.flat[first]), speed)
        period = 2.0 * math.pi / float(frequency.flat[first])
        longest = (
            f"longer than {2.0 * math.pi / limit:.4g} s" if limit > 0.0 else "none: the current outruns every wave"
        )
        raise InputError(
            f"an opposing current of {speed:.4g} m/s blocks waves of period {period:.4g} s",
            parameter="current_along_wave",
            allowed=f"periods {longest}",
            remedy="give a weaker current, a longer period, or another heading",
        )
    return result
