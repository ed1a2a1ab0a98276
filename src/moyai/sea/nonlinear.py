"""Regular waves of finite height: Airy, Stokes to fifth order, stream function, behind one interface.

Stokes coefficients come from the library raschii (Fenton 1985). Stream-function waves come from our own Newton solver,
which continues where raschii's stops (long waves, waves near breaking, given periods at no extra cost), or from raschii
itself as an independent solution. The period is that of the fixed frame; the waves may ride on a uniform current.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np

from moyai.core.arrays import Array
from moyai.core.errors import ConvergenceError, InputError
from moyai.core.options import checks_words
from moyai.sea import dispersion
from moyai.sea.breaking import highest_steady_wave
from moyai.sea.permanent_wave import RESIDUAL, NonlinearWave, Theory
from moyai.sea.stream_function import StreamFunctionProblem, StreamFunctionSolution, solve_stream_function
from moyai.sea.water import Water, check_water

__all__ = ["NonlinearWave", "Theory", "nonlinear_wave", "stokes_coefficients"]


#: At three wavelengths of depth tanh kh is 1 to rounding: deeper water is passed to raschii as this.
_DEEP_IN_WAVELENGTHS = 3.0
#: Number of stream-function components tried in turn when the caller names no order.
_ORDERS = (6, 9, 13, 19, 28, 40, 60)
#: Residual above which the answer is refused: the series has not found a wave, or the wave is about to break.
_REFUSED = 1e-3


@dataclass(frozen=True)
class _Solution:
    """Coefficients of one wave of given length: harmonics of elevation, velocity at crest level, celerity."""

    elevation: Array
    crest_velocities: Array
    celerity: float


def _model(name: str) -> Any:
    import raschii

    found = raschii.get_wave_model(name)
    # a class alone in old releases, a pair of wave and air model since
    return found[0] if isinstance(found, tuple) else found


def _computing_depth(water: Water, wavelength: float) -> float:
    return min(water.depth, _DEEP_IN_WAVELENGTHS * wavelength)


def stokes_coefficients(height: float, wavelength: float, water: Water, order: int) -> Any:
    """Return raschii's Stokes wave of given length; ``.data`` holds Fenton's coefficients A_ij, B_ij, C_i."""
    depth = _computing_depth(water, wavelength)
    return _model("Stokes")(height=height, depth=depth, length=wavelength, N=order, g=water.gravity)


def _solve_stokes(height: float, wavelength: float, water: Water, order: int) -> _Solution:
    wave = stokes_coefficients(height, wavelength, water, order)
    data, k = wave.data, 2.0 * math.pi / wavelength
    depth, eps = _computing_depth(water, wavelength), 0.5 * k * height
    elevation = (
        np.array(
            [
                eps + eps**3 * data["B31"] - eps**5 * (data["B53"] + data["B55"]),
                eps**2 * data["B22"] + eps**4 * data["B42"],
                -(eps**3) * data["B31"] + eps**5 * data["B53"],
                eps**4 * data["B44"],
                eps**5 * data["B55"],
            ]
        )[:order]
        / k
    )
    crest = float(np.sum(elevation))
    scale = data["C0"] * math.sqrt(water.gravity / k)
    velocities = np.zeros(order)
    for i in range(1, order + 1):
        for j in range(1, i + 1):
            velocities[j - 1] += eps**i * j * data.get(f"A{i}{j}", 0.0) * math.cosh(j * k * (crest + depth))
    return _Solution(elevation, scale * velocities, float(wave.c))


def _solve_with_raschii(height: float, wavelength: float, water: Water, order: int) -> _Solution:
    depth = _computing_depth(water, wavelength)
    wave = _model("Fenton")(height=height, depth=depth, length=wavelength, N=order, g=water.gravity, relax=1.0)
    k = 2.0 * math.pi / wavelength
    surface = k * (np.asarray(wave.data["eta"], dtype=np.float64) - depth)
    elevation = StreamFunctionSolution(surface, np.zeros(order), 0.0, 0.0, 0.0, k).elevation_harmonics() / k
    amplitudes = np.asarray(wave.data["B"], dtype=np.float64)[1:] * np.arange(1, order + 1) * k
    return _Solution(elevation, _raised_to_crest(amplitudes, elevation, k, depth), float(wave.c))


def _raised_to_crest(amplitudes: Array, elevation: Array, wave_number: float, depth: float) -> Array:
    """Turn velocity amplitudes that go with cosh jk(z+h)/cosh jkh into amplitudes at crest level."""
    crest = float(np.sum(elevation))
    jk = wave_number * np.arange(1, amplitudes.size + 1)
    ratio = np.exp(jk * crest)
    if not math.isinf(depth):
        ratio *= (1.0 + np.exp(-2.0 * jk * (crest + depth))) / (1.0 + np.exp(-2.0 * jk * depth))
    return np.asarray(amplitudes * ratio)


def _guarded(solve: Callable[[float], _Solution], length: float) -> _Solution:
    """Turn every way in which raschii can fail into one error."""
    from raschii.common import NonConvergenceError

    # the base of raschii's errors changed its spelling between releases
    failures = (NonConvergenceError, *NonConvergenceError.__bases__, np.linalg.LinAlgError, ArithmeticError, ValueError)
    try:
        with np.errstate(all="ignore"):
            solution = solve(length)
    except failures as error:
        raise ConvergenceError(
            f"no wave of length {length:.4g} m found: {error}",
            parameter="height",
            remedy="check breaking, change order",
        ) from error
    if not (math.isfinite(solution.celerity) and solution.celerity > 0.0):
        raise ConvergenceError(
            f"no wave of length {length:.4g} m found: celerity {solution.celerity:g}",
            parameter="height",
            remedy="check breaking and the Ursell number, change theory",
        )
    return solution


def _solve_length(
    solve: Callable[[float], _Solution], period: float, current: float, depth: float, first: float
) -> tuple[float, _Solution]:
    """Find the wavelength whose celerity fits the period, from a first estimate upwards.

    A higher wave runs faster than the linear one, so its wavelength lies above the linear one; the bracket grows
    until the wave is too long, then the regula falsi (Illinois) closes it.
    """

    def excess(length: float) -> tuple[float, _Solution]:
        solution = _guarded(solve, length)
        return (solution.celerity + current) * period - length, solution

    low, high = first, 1.04 * first
    low_value, _ = excess(low)
    high_value, solution = excess(high)
    while low_value * high_value > 0.0:
        low, low_value = high, high_value
        high *= 1.04
        if high > 4.0 * first:
            raise ConvergenceError(
                f"no wave of period {period:g} s found up to a length of {high:.4g} m",
                parameter="period",
                remedy=f"the highest steady wave of the linear length is {highest_steady_wave(first, depth):.4g} m",
            )
        high_value, solution = excess(high)
    length = high
    for _ in range(80):
        if high_value == low_value:
            break
        length = high - high_value * (high - low) / (high_value - low_value)
        value, solution = excess(length)
        if abs(value) <= 1e-13 * length or abs(high - low) <= 1e-14 * length:
            break
        if value * high_value < 0.0:
            low, low_value = high, high_value
        else:
            low_value *= 0.5
        high, high_value = length, value
    return length, solution


@checks_words
def nonlinear_wave(
    theory: Theory,
    *,
    height: float,
    water: Water,
    period: float | None = None,
    wavelength: float | None = None,
    order: int | None = None,
    heading: float = 0.0,
    current_along_wave: float = 0.0,
    solver: Literal["newton", "raschii"] = "newton",
) -> NonlinearWave:
    """Return a regular wave of finite height by the theory named.

    Parameters
    ----------
    theory : {"airy", "stokes", "stream_function"}
        Linear theory, Stokes expansion of Fenton (1985), stream function of Rienecker and Fenton (1981).
    height : float
        Wave height H, crest to trough [m].
    water : Water
        Depth (may be infinite), density, gravity.
    period, wavelength : float
        Period in the fixed frame [s] or wavelength [m]: exactly one.
    order : int, optional
        Stokes: 1 to 5 (5 when not given). Stream function: number of components; when not given it is raised until
        the free-surface conditions between the collocation points hold to 1e-5 of g H, or 60 is reached; a wave that
        misses them says so in :meth:`NonlinearWave.notices`.
    heading : float
        Direction of travel [rad].
    current_along_wave : float
        Uniform current along the heading [m/s]; the mean Eulerian velocity of the wave itself is zero
        (Stokes' first definition of celerity).
    solver : {"newton", "raschii"}
        Who solves the stream function: this package, or raschii (needs ``order``).

    Returns
    -------
    NonlinearWave
        Elevation, velocity, acceleration, pressure and the residuals of the free surface.

    Raises
    ------
    InputError
        When an argument is out of range.
    ConvergenceError
        When no such wave is found, for instance above the breaking height.

    Examples
    --------
    >>> from moyai.sea import Water, nonlinear_wave
    >>> water = Water(depth=10.0, density=1025.0, gravity=9.81)
    >>> wave = nonlinear_wave("stream_function", height=2.0, water=water, period=6.0)
    >>> round(float(wave.elevation(0.0, 0.0, 0.0)), 2)               # the crest is higher than half the height [m]
    1.12
    """
    check_water(water)
    _check_arguments(theory, height, period, wavelength, order, current_along_wave, solver)

    def finish(solution: _Solution, length: float, number: int) -> NonlinearWave:
        speed = solution.celerity + current_along_wave
        if speed <= 0.0:
            raise InputError(
                f"the current of {current_along_wave:g} m/s is faster than the wave against it",
                parameter="current_along_wave",
            )
        for array in (solution.elevation, solution.crest_velocities):
            array.setflags(write=False)
        return NonlinearWave(
            theory=theory,
            order=number,
            height=height,
            period=length / speed if period is None else period,
            wavelength=length,
            heading=heading,
            water=water,
            current_along_wave=current_along_wave,
            elevation_harmonics=solution.elevation,
            crest_velocities=solution.crest_velocities,
            relative_celerity=solution.celerity,
        )

    if theory == "stream_function" and solver == "newton" and height > 0.0:
        return _raise_order(height, water, period, wavelength, order, current_along_wave, finish)
    number = 1 if theory == "airy" else (order or 5)

    def solve(length: float) -> _Solution:
        if theory == "stream_function" and height > 0.0:
            return _solve_with_raschii(height, length, water, number)
        return _solve_stokes(height, length, water, number if theory != "stream_function" else 1)

    if wavelength is not None:
        return finish(_guarded(solve, wavelength), wavelength, number)
    assert period is not None
    omega = 2.0 * math.pi / period
    k = float(dispersion.wave_number_in_current(omega, water.depth, water.gravity, current_along_wave))
    length, solution = _solve_length(solve, period, current_along_wave, water.depth, 0.999 * 2.0 * math.pi / k)
    return finish(solution, length, number)


def _raise_order(
    height: float,
    water: Water,
    period: float | None,
    wavelength: float | None,
    order: int | None,
    current: float,
    finish: Callable[[_Solution, float, int], NonlinearWave],
) -> NonlinearWave:
    """Solve the stream function with more and more components until its free surface is right between the nodes."""
    nan = math.nan
    problem = StreamFunctionProblem(
        height=height,
        water=water,
        omega=nan if period is None else 2.0 * math.pi / period,
        wave_number=nan if wavelength is None else 2.0 * math.pi / wavelength,
        current=current,
    )
    if period is not None:
        # gives blocking by the current before any iteration
        dispersion.wave_number_in_current(problem.omega, water.depth, water.gravity, current)
    found: StreamFunctionSolution | None = None
    wave: NonlinearWave | None = None
    failure: ConvergenceError | None = None
    for number in _ORDERS if order is None else (order,):
        try:
            found = solve_stream_function(problem, number, found)
        except ConvergenceError as error:
            # a long or steep wave may need more components than these to exist at all
            failure = error
            continue
        k = found.wave_number
        elevation = found.elevation_harmonics() / k
        amplitudes = found.coefficients * np.arange(1, number + 1) * math.sqrt(water.gravity / k)
        velocities = _raised_to_crest(amplitudes, elevation, k, water.depth)
        solution = _Solution(elevation, velocities, found.celerity * math.sqrt(water.gravity / k))
        tried = finish(solution, 2.0 * math.pi / k, number)
        # near breaking more components may be worse: the best is kept
        if wave is None or max(tried.surface_residuals()) < max(wave.surface_residuals()):
            wave = tried
        if max(wave.surface_residuals()) < RESIDUAL:
            break
    if wave is None:
        raise failure or ConvergenceError("no wave found", parameter="height")
    worst, crest_speed = max(wave.surface_residuals()), float(np.sum(wave.crest_velocities))
    if (order is None and worst > _REFUSED) or crest_speed >= wave.relative_celerity:
        limit = highest_steady_wave(wave.wavelength, water.depth)
        raise ConvergenceError(
            f"no steady wave of height {height:.4g} m found: free-surface residual {worst:.2g} of g H with "
            f"{wave.order} components",
            parameter="height",
            remedy=f"the highest steady wave of this length is about {limit:.4g} m",
        )
    return wave


def _check_arguments(
    theory: str,
    height: float,
    period: float | None,
    wavelength: float | None,
    order: int | None,
    current: float,
    solver: str,
) -> None:
    if theory not in ("airy", "stokes", "stream_function"):
        raise InputError(f"unknown theory {theory!r}", parameter="theory", allowed="airy, stokes, stream_function")
    if not (math.isfinite(height) and height >= 0.0):
        raise InputError(f"wave height is {height:g} m", parameter="height", allowed="at least 0 m")
    if (period is None) == (wavelength is None):
        raise InputError("give period or wavelength, exactly one", parameter="period")
    given = period if wavelength is None else wavelength
    if given is None or not (math.isfinite(given) and given > 0.0):
        raise InputError(f"period or wavelength is {given}", parameter="period", allowed="greater than 0")
    if not math.isfinite(current):
        raise InputError(f"current is {current:g} m/s", parameter="current_along_wave", allowed="finite")
    if order is not None:
        highest = {"airy": 1, "stokes": 5, "stream_function": 100}[theory]
        lowest = 3 if theory == "stream_function" else 1
        if not lowest <= order <= highest:
            raise InputError(f"order is {order}", parameter="order", allowed=f"{lowest} to {highest} for {theory}")
    if solver not in ("newton", "raschii"):
        raise InputError(f"unknown solver {solver!r}", parameter="solver", allowed="newton, raschii")
    if solver == "raschii" and theory == "stream_function" and order is None:
        raise InputError("raschii needs an order", parameter="order", allowed="3 to 100")
