"""Responses to irregular seas by linear theory: spectra, moments, significant and most probable largest values."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from moyai.core.arrays import Array, ComplexArray
from moyai.core.errors import InputError
from moyai.core.mixing import Mixing
from moyai.core.options import checks_words
from moyai.core.single import plain
from moyai.floating.arrays import square_matrix
from moyai.floating.coefficients import Hydrodynamics
from moyai.floating.damping import EquivalentDamping, LinearDamping, QuadraticDamping
from moyai.floating.frequency import Motions, dynamic_stiffness, solve_motions, solve_scaled

#: Of a logarithm's step: exact where motion goes with the root of damping. Deviation of what does not move.
_PART, _LEAST = 2.0 / 3.0, 1e-100


def integration_weights(omega: ArrayLike) -> Array:
    """Return the weights of the trapezoidal rule on a frequency grid [rad/s]; one frequency has no width."""
    grid = np.atleast_1d(np.asarray(omega, dtype=float))
    if len(grid) < 2:
        raise InputError("an integral over frequency needs two frequencies or more", parameter="omega")
    step = np.diff(grid)
    return 0.5 * np.concatenate([step[:1], step[1:] + step[:-1], step[-1:]])


@dataclass(frozen=True)
class ResponseStatistics:
    """Statistics of Gaussian responses, one entry a response; of a single response, floats."""

    #: Response spectra [unit^2 s/rad] [eq:floating-response]; shape (n, ...).
    spectrum: Array
    #: m0, m1, m2, m4; shape (4, ...).
    moments: Array
    standard_deviation: Array
    #: Significant double amplitude, 4 sqrt(m0).
    significant: Array
    #: 2 pi sqrt(m0/m2) [s].
    mean_zero_crossing_period: Array

    def most_probable_maximum(self, duration: float) -> Any:
        """Return the most probable largest amplitude in ``duration`` [s], sigma sqrt(2 ln N), N = duration / T_z.

        Rayleigh statistics of a narrow-banded response [eq:floating-extreme]; zero where fewer than one cycle falls
        into the duration.

        Parameters
        ----------
        duration : float
            Of the sea state [s].

        Returns
        -------
        float or ndarray
            In the unit and shape of the standard deviation.
        """
        with np.errstate(divide="ignore", invalid="ignore"):
            cycles = duration / self.mean_zero_crossing_period
            logarithm = np.where(cycles > 1.0, np.log(np.where(cycles > 1.0, cycles, 1.0)), 0.0)
        return plain(self.standard_deviation * np.sqrt(2.0 * logarithm))


def response_statistics(omega: ArrayLike, transfer: ArrayLike, density: ArrayLike) -> ResponseStatistics:
    """Return spectra and statistics of linear responses [eq:floating-response].

    Parameters
    ----------
    omega : array_like (n,)
        [rad/s].
    transfer : array_like (n, ...)
        Complex or absolute transfer functions; (n, h, ...) with a directional ``density``.
    density : array_like (n,) or (n, h)
        Wave spectrum [m2 s/rad]; with headings, the part of each of them (already times its angle), so that the sum
        over headings is the frequency spectrum.

    Returns
    -------
    ResponseStatistics
        Spectra (n, ...), moments (4, ...), standard deviations, significant double amplitudes and mean periods (...),
        in units of the response and s.

    Raises
    ------
    InputError
        For fewer than two frequencies.

    Examples
    --------
    >>> import numpy as np
    >>> from moyai.floating import response_statistics
    >>> omega = np.linspace(0.2, 3.0, 141)
    >>> spectrum = np.exp(-(((omega - 1.0) / 0.1) ** 2))                 # m0 = 0.1 sqrt(pi) [m2 s/rad]
    >>> found = response_statistics(omega, 2.0 * np.ones(141), spectrum)   # 2 m of motion for 1 m of wave
    >>> round(float(found.standard_deviation), 3)                        # 2 sqrt(0.1 sqrt(pi)) [m]
    0.842
    """
    grid = np.asarray(omega, dtype=float)
    power = np.abs(np.asarray(transfer)) ** 2
    wave = np.asarray(density, dtype=float)
    if wave.ndim == 2:
        spectrum = np.einsum("nh...,nh->n...", power, wave)
    else:
        spectrum = power * wave.reshape(wave.shape + (1,) * (power.ndim - 1))
    weights = integration_weights(grid)
    moments = np.array([np.tensordot(weights * grid**order, spectrum, axes=(0, 0)) for order in (0, 1, 2, 4)])
    deviation = np.sqrt(np.maximum(moments[0], 0.0))
    with np.errstate(divide="ignore", invalid="ignore"):
        crossing = np.where(
            moments[2] > 0.0, 2.0 * math.pi * np.sqrt(moments[0] / np.maximum(moments[2], 1e-300)), np.inf
        )
    return ResponseStatistics(spectrum, moments, plain(deviation), plain(4.0 * deviation), plain(crossing))


def energy_transmission(omega: ArrayLike, transmission: ArrayLike, density: ArrayLike) -> float:
    """Return the transmission of significant height, sqrt(int |T|^2 S / int S) [eq:floating-transmission].

    Parameters
    ----------
    omega : array_like (n,)
        [rad/s].
    transmission : array_like (n,) or (n, h)
        Transmission coefficient, complex or its absolute value [-].
    density : array_like (n,) or (n, h)
        Wave spectrum [m2 s/rad], as in :func:`response_statistics`.

    Returns
    -------
    float
        Transmitted over incident significant height [-].

    Raises
    ------
    InputError
        For fewer than two frequencies, and a spectrum without energy.

    Examples
    --------
    >>> from moyai.floating import energy_transmission
    >>> share = energy_transmission([0.5, 1.0, 1.5], [1.0, 0.8, 0.4], [0.0, 2.0, 1.0])
    >>> round(share**2, 4)                                               # (0.64 x 2 + 0.16 x 0.5) / 2.5
    0.544
    """
    weights = integration_weights(omega)
    wave = np.asarray(density, dtype=float)
    power = np.abs(np.asarray(transmission)) ** 2 * wave
    if power.ndim == 2:
        power, wave = power.sum(axis=1), np.broadcast_to(wave, power.shape).sum(axis=1)
    total = float(weights @ wave)
    if total <= 0.0:
        raise InputError("the wave spectrum holds no energy", parameter="density")
    return math.sqrt(float(weights @ power) / total)


@checks_words
@dataclass(frozen=True)
class SeaMotions:
    """Motions with quadratic damping linearised for one sea."""

    motions: Motions
    #: What the quadratic terms amount to in this sea; shape (m, m).
    equivalent_damping: Array
    #: Standard deviation of each measure J_k v; shape (k,).
    measure_deviation: Array
    iterations: int
    converged: bool
    #: What the linearisation was found at; a sea or stiffness nearby continues from it.
    state: Array


@dataclass(frozen=True)
class _Linearised:
    """Quadratic terms of one sea, linear at a state: deviations of what they depend on, all above zero."""

    omega: Array
    #: Spectrum of each heading; shape (n, h).
    wave: Array
    size: int
    quadratic: QuadraticDamping | None
    line_damping: EquivalentDamping | None
    water_motion: ComplexArray | None

    def state_of(self, velocity: ComplexArray) -> Array:
        """Return the state of velocities (n, h, m): of lines frequency and velocities, then measures of drag."""
        measure = velocity[..., :0]
        if self.quadratic is not None:
            measure = velocity @ self.quadratic.directions.T
            measure = measure if self.water_motion is None else measure - self.water_motion
        weights = integration_weights(self.omega)
        deviation = _above_zero(np.sqrt(weights @ np.einsum("nhk,nh->nk", np.abs(measure) ** 2, self.wave)))
        if self.line_damping is None:
            return deviation
        moving = response_statistics(self.omega, np.concatenate([velocity, measure], axis=2), self.wave)
        crossing = moving.mean_zero_crossing_period
        period = float(np.max(np.where(np.isfinite(crossing), crossing, 0.0)))
        frequency = 2.0 * math.pi / period if period > 0.0 else _LEAST
        return np.concatenate([[frequency], _above_zero(moving.standard_deviation[: self.size]), deviation])

    def equivalents(self, state: Array | None) -> tuple[Array, ComplexArray]:
        """Return damping (m, m) and drag of moving water (n, h, m) at a state; nothing at none."""
        damping, drag = np.zeros((self.size, self.size)), np.zeros((*self.wave.shape, self.size), dtype=np.complex128)
        if state is None:
            return damping, drag
        if self.quadratic is not None:
            deviation = state[len(state) - self.quadratic.count :]
            damping = damping + self.quadratic.equivalent_irregular(deviation)
            if self.water_motion is not None:
                drag = self.quadratic.carried_irregular(deviation, self.water_motion)
        if self.line_damping is not None:
            damping = damping + self.line_damping(math.sqrt(2.0) * state[1 : 1 + self.size], float(state[0]))
        return damping, drag


def _solved(matrix: ComplexArray, push: ComplexArray) -> ComplexArray:
    """Return the displacements (n, h, m), NaN where the body is at an undamped resonance."""
    try:
        return np.asarray(np.swapaxes(np.linalg.solve(matrix, np.swapaxes(push, 1, 2)), 1, 2), dtype=np.complex128)
    except np.linalg.LinAlgError:
        return solve_scaled(np.broadcast_to(matrix[:, None], (*push.shape, push.shape[-1])), push)[0]


def _above_zero(deviation: Array) -> Array:
    return np.asarray(np.maximum(deviation, max(1e-12 * float(np.max(deviation, initial=0.0)), _LEAST)))


def _mixed(mixing: Mixing, state: Array, found: Array) -> Array:
    """Return the next state between or near two: logarithms are mixed, deviations being near powers of the damping."""
    here, asked = np.log(state), np.log(found / state)
    step = mixing.step(here, asked, _PART)
    if np.any(step < np.minimum(asked, 0.0) - math.log(2.0)) or np.any(step > np.maximum(asked, 0.0) + math.log(2.0)):
        # a mixture far from what it is mixed from is none
        mixing.forget()
        step = _PART * asked
    return np.asarray(np.exp(here + step))


def _joined(parts: list[Motions]) -> Motions:
    """Put motions of several headings side by side."""
    if len(parts) == 1:
        return parts[0]
    return replace(
        parts[0],
        heading=np.concatenate([part.heading for part in parts]),
        displacement=np.concatenate([part.displacement for part in parts], axis=1),
        damping=np.concatenate([part.damping for part in parts], axis=1),
        wave_amplitude=np.concatenate([part.wave_amplitude for part in parts], axis=1),
        notices=tuple(notice for part in parts for notice in part.notices),
    )


def _fixed_part(part: Hydrodynamics, inertia: ArrayLike, stiffness: ArrayLike, linear: LinearDamping) -> ComplexArray:
    """Return the dynamic stiffness (n, m, m) without what quadratic damping amounts to."""
    mass = square_matrix(inertia, part.size, "inertia")
    restoring = square_matrix(stiffness, part.size, "stiffness")
    constant = part.radiation_damping + linear.at(mass, part.added_mass, restoring)
    return dynamic_stiffness(part.omega, mass + part.added_mass, constant, restoring)


def linearised_in_sea(
    hydrodynamics: Hydrodynamics | Sequence[Hydrodynamics],
    inertia: ArrayLike,
    stiffness: ArrayLike,
    density: ArrayLike,
    *,
    quadratic: QuadraticDamping | None = None,
    line_damping: EquivalentDamping | None = None,
    damping: LinearDamping | None = None,
    water_motion: ComplexArray | None = None,
    start: SeaMotions | None = None,
    tolerance: float = 1e-10,
    maximum_iterations: int = 200,
) -> SeaMotions:
    """Solve the motions in an irregular sea with stochastic linearisation [eq:floating-stochastic].

    Parameters
    ----------
    hydrodynamics : Hydrodynamics or sequence of Hydrodynamics
        Several where the radiation is another for each heading, as along a unit in oblique waves; in the order of the
        headings of ``density``, all at the same frequencies.
    inertia, stiffness, damping
        As in :func:`moyai.floating.frequency.solve_motions`, of the whole unit.
    density : array_like (n,) or (n, h)
        Wave spectrum at the frequencies of the coefficients, as in :func:`response_statistics`.
    quadratic : QuadraticDamping or None
        b_eq = sqrt(8/pi) sigma b2, the same at all frequencies.
    line_damping : callable or None
        Equivalent damping of lines at sqrt(2) times the standard deviations of the velocities and their mean
        zero-crossing frequency.
    water_motion : ndarray (n, h, k) or None
        What the water does in the measures of ``quadratic``, per unit wave amplitude; still water when absent.
    start : SeaMotions or None
        With a stiffness nearby and the same frequencies, from which the iteration continues.
    tolerance : float
        Relative change of the standard deviations.
    maximum_iterations : int
        Rounds of the linearisation at most.

    Returns
    -------
    SeaMotions
        Motions per unit wave amplitude [m/m, rad/m], the equivalent damping of the quadratic terms, standard deviations
        of their velocities, and whether the iteration converged.

    Raises
    ------
    InputError
        When the headings of spectrum and coefficients differ, or matrices have another shape.

    Examples
    --------
    >>> import numpy as np
    >>> from moyai.floating import Hydrodynamics, QuadraticDamping, linearised_in_sea
    >>> omega = np.linspace(0.5, 2.0, 31)
    >>> one = np.ones((31, 1, 1))
    >>> heave = Hydrodynamics(omega, 1e5 * one, 5e3 * one, 5e5 * one.astype(complex), np.zeros(1), ("heave",))
    >>> drag = QuadraticDamping(directions=np.eye(1), coefficients=np.array([4e4]))
    >>> spectrum = np.exp(-(((omega - 1.2) / 0.2) ** 2))                 # [m2 s/rad]
    >>> found = linearised_in_sea(heave, [[2e5]], [[4e5]], spectrum, quadratic=drag)
    >>> found.converged, found.motions.displacement.shape                # frequency, heading, mode
    (True, (31, 1, 1))
    >>> deviation = found.measure_deviation[0]                           # of the heave velocity [m/s]
    >>> round(float(found.equivalent_damping[0, 0] / (np.sqrt(8.0 / np.pi) * deviation * 4e4)), 6)
    1.0
    """
    parts = [hydrodynamics] if isinstance(hydrodynamics, Hydrodynamics) else list(hydrodynamics)
    omega, size = parts[0].omega, parts[0].size
    linear = LinearDamping.none(size) if damping is None else damping
    wave = np.asarray(density, dtype=float)
    if wave.ndim == 1:
        wave = wave[:, None]
    ends = np.cumsum([len(part.heading) for part in parts])
    if wave.shape[1] != ends[-1]:
        raise InputError(
            f"the spectrum has {wave.shape[1]} headings, the coefficients {ends[-1]}",
            parameter="density",
        )
    known = [_fixed_part(part, inertia, stiffness, linear) for part in parts]
    excitation = np.concatenate([part.excitation_force for part in parts], axis=1)
    sea = _Linearised(omega, wave, size, quadratic, line_damping, water_motion if quadratic is not None else None)
    state = sea.state_of(np.zeros_like(excitation)) if sea.water_motion is not None else None
    state, mixing, turn = state if start is None else start.state, Mixing(), 1j * omega[:, None, None]
    used = 0
    while used < maximum_iterations:
        used += 1
        equivalent, drag = sea.equivalents(state)
        displacement = np.concatenate(
            [
                _solved(fixed - turn * equivalent, push)
                for fixed, push in zip(known, np.split(excitation + drag, ends[:-1], axis=1), strict=True)
            ],
            axis=1,
        )
        found = sea.state_of(np.nan_to_num(-turn * displacement))
        change = math.inf if state is None else float(np.max(np.abs(found - state) / found, initial=0.0))
        if not found.size or change <= tolerance:
            change = 0.0
            break
        state = found if state is None else _mixed(mixing, state, found)
    total = LinearDamping(linear.matrix + equivalent, linear.critical_fraction)
    motions = _joined(
        [
            solve_motions(replace(part, excitation_force=push), inertia, stiffness, damping=total)
            for part, push in zip(parts, np.split(excitation + drag, ends[:-1], axis=1), strict=True)
        ]
    )
    motions = replace(motions, drag_excitation=drag if water_motion is not None else None)
    measured = 0 if quadratic is None else quadratic.count
    return SeaMotions(motions, equivalent, found[len(found) - measured :], used, change <= tolerance, found)
