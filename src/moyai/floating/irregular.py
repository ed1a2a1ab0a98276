"""Responses to irregular seas by linear theory: spectra, moments, significant and most probable largest values."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike

from moyai.core.arrays import Array, ComplexArray
from moyai.core.errors import InputError
from moyai.floating.arrays import square_matrix
from moyai.floating.coefficients import Hydrodynamics
from moyai.floating.damping import EquivalentDamping, LinearDamping, QuadraticDamping
from moyai.floating.frequency import Motions, dynamic_stiffness, solve_motions, solve_scaled


def integration_weights(omega: ArrayLike) -> Array:
    """Return the weights of the trapezoidal rule on a frequency grid [rad/s]; one frequency has no width."""
    grid = np.atleast_1d(np.asarray(omega, dtype=float))
    if len(grid) < 2:
        raise InputError("an integral over frequency needs two frequencies or more", parameter="omega")
    step = np.diff(grid)
    return 0.5 * np.concatenate([step[:1], step[1:] + step[:-1], step[-1:]])


@dataclass(frozen=True)
class ResponseStatistics:
    """Statistics of Gaussian responses, one entry a response."""

    #: Response spectra [unit^2 s/rad] [eq:floating-response]; shape (n, ...).
    spectrum: Array
    #: m0, m1, m2, m4; shape (4, ...).
    moments: Array
    standard_deviation: Array
    #: Significant double amplitude, 4 sqrt(m0).
    significant: Array
    #: 2 pi sqrt(m0/m2) [s].
    mean_zero_crossing_period: Array

    def most_probable_maximum(self, duration: float) -> Array:
        """Return the most probable largest amplitude in ``duration`` [s], sigma sqrt(2 ln N), N = duration / T_z.

        Rayleigh statistics of a narrow-banded response [eq:floating-extreme]; zero where fewer than one cycle falls
        into the duration.
        """
        with np.errstate(divide="ignore", invalid="ignore"):
            cycles = duration / self.mean_zero_crossing_period
            logarithm = np.where(cycles > 1.0, np.log(np.where(cycles > 1.0, cycles, 1.0)), 0.0)
        return np.asarray(self.standard_deviation * np.sqrt(2.0 * logarithm), dtype=float)


def response_statistics(omega: ArrayLike, transfer: ArrayLike, density: ArrayLike) -> ResponseStatistics:
    """Return spectra and statistics of linear responses.

    Parameters
    ----------
    omega : array_like (n,)
        [rad/s].
    transfer : array_like (n, ...)
        Complex or absolute transfer functions; (n, h, ...) with a directional ``density``.
    density : array_like (n,) or (n, h)
        Wave spectrum [m2 s/rad]; with headings, the part of each of them (already times its angle), so that the sum
        over headings is the frequency spectrum.
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
    return ResponseStatistics(spectrum, moments, deviation, 4.0 * deviation, crossing)


def energy_transmission(omega: ArrayLike, transmission: ArrayLike, density: ArrayLike) -> float:
    """Return the transmission of significant height, sqrt(int |T|^2 S / int S) [eq:floating-transmission].

    Parameters
    ----------
    omega : array_like (n,)
    transmission : array_like (n,) or (n, h)
    density : array_like (n,) or (n, h)
        As in :func:`response_statistics`.
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
        As in :func:`moyai.floating.frequency.solve_motions`.
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
        With a stiffness nearby and the same frequencies, from which the iteration goes on.
    tolerance : float
        Relative change of the standard deviations.
    maximum_iterations : int
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
    rows = np.eye(size) if quadratic is None else np.vstack([np.eye(size), quadratic.directions])
    equivalent, previous = np.zeros((size, size)), np.zeros(len(rows))
    drag = np.zeros((len(omega), ends[-1], size), dtype=np.complex128)
    moving = np.zeros((1, 1, len(rows)), dtype=np.complex128)
    if water_motion is not None and quadratic is not None:
        moving = np.concatenate([np.zeros((*water_motion.shape[:2], size)), water_motion], axis=2)
    goes_on = start is not None
    if start is not None:
        equivalent = start.equivalent_damping
        drag = drag if start.motions.drag_excitation is None else start.motions.drag_excitation
    known = [_fixed_part(part, inertia, stiffness, linear) for part in parts]
    excitation = np.concatenate([part.excitation for part in parts], axis=1)
    weights = integration_weights(omega)
    frequency = omega[:, None, None]
    change, used = math.inf, 0
    while True:
        used += 1
        turning = 1j * frequency * equivalent
        displacement = np.concatenate(
            [
                solve_scaled(np.broadcast_to((fixed - turning)[:, None], (*push.shape, size)), push)[0]
                for fixed, push in zip(known, np.split(excitation + drag, ends[:-1], axis=1), strict=True)
            ],
            axis=1,
        )
        measure: ComplexArray = np.nan_to_num(-1j * frequency * displacement) @ rows.T - moving
        deviation = np.sqrt(weights @ np.einsum("nhk,nh->nk", np.abs(measure) ** 2, wave))
        largest = np.where(np.maximum(deviation, previous) > 0.0, np.maximum(deviation, previous), 1.0)
        change = float(np.max(np.abs(deviation - previous) / largest))
        previous = deviation
        if change <= tolerance or used >= maximum_iterations:
            break
        target = np.zeros((size, size))
        if quadratic is not None:
            target += quadratic.equivalent_irregular(deviation[size:])
            if water_motion is not None:
                carried = quadratic.carried_irregular(deviation[size:], water_motion)
                drag = 0.5 * (drag + carried) if goes_on else carried
        if line_damping is not None:
            crossing = response_statistics(omega, measure, wave).mean_zero_crossing_period
            period = float(np.max(np.where(np.isfinite(crossing), crossing, 0.0)))
            target += line_damping(math.sqrt(2.0) * deviation[:size], 2.0 * math.pi / period if period > 0.0 else 0.0)
        equivalent = 0.5 * (equivalent + target) if goes_on else target
        goes_on = True
    total = LinearDamping(linear.matrix + equivalent, linear.critical_fraction)
    motions = _joined(
        [
            solve_motions(replace(part, excitation=push), inertia, stiffness, damping=total)
            for part, push in zip(parts, np.split(excitation + drag, ends[:-1], axis=1), strict=True)
        ]
    )
    motions = replace(motions, drag_excitation=drag if water_motion is not None else None)
    return SeaMotions(motions, equivalent, deviation[size:], used, change <= tolerance)
