"""Slow drift in the frequency domain: its force spectrum, the slow sway, and extremes with the waves' own motion."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from scipy.interpolate import CubicSpline

from moyai.core.arrays import Array, ComplexArray
from moyai.floating.damping import LinearDamping
from moyai.floating.irregular import integration_weights
from moyai.floating.modes import added_mass_function, damping_function, natural_modes
from moyai.series.realisations import OF_STORMS
from moyai.structures.breakwater.assembly import FloatingUnit
from moyai.structures.breakwater.frequency.about_rest import natural_added_mass
from moyai.structures.breakwater.frequency.model import FrequencyModel

WAVE_POINTS = 600  # frequencies of the waves over which the force spectrum is integrated
REACH = 4.0  # difference frequencies up to so many natural frequencies of sway
POINTS_PER_WIDTH = 12  # difference frequencies in the width of the resonance
LEAST_CYCLES = 25.0  # natural periods of sway in a record, for its largest slow excursion to be near its most probable
SIGNIFICANT = 2.0  # significant amplitude over standard deviation of a narrow-banded response


def force_spectrum(omega: Array, directional: Array, drift: Array, difference: Array) -> Array:
    """Return the spectrum of the slowly varying drift force [eq:breakwater-slow-force], [N2 s/rad].

    Pinkster's sum over pairs of waves with Newman's approximation by the arithmetic mean of the two mean drifts, the
    same that the time domain uses; pairs of different headings included.

    Parameters
    ----------
    omega : ndarray (n,)
        [rad/s].
    directional : ndarray (n, h)
        Wave spectrum of each heading, times its angle [m2 s/rad].
    drift : ndarray (n, h)
        Mean drift force over amplitude squared [N/m2].
    difference : ndarray (k,)
        Difference frequencies [rad/s].
    """
    grid = np.linspace(float(omega[0]), float(omega[-1]), WAVE_POINTS)
    step = grid[1] - grid[0]
    moments = np.array([np.sum(directional * drift**order, axis=1) for order in (0, 1, 2)])
    zero, one, two = (np.interp(grid, omega, row) for row in moments)
    pairs = [np.correlate(later, first, "full") for later, first in ((zero, two), (2.0 * one, one), (two, zero))]
    at_steps = 2.0 * step * np.sum(pairs, axis=0)[WAVE_POINTS - 1 :]
    within = np.asarray(difference) <= step * (WAVE_POINTS - 1)
    # as smooth over the difference as the spectrum is over frequency: splines between steps cost no accuracy
    return np.where(within, CubicSpline(step * np.arange(WAVE_POINTS), at_steps)(difference), 0.0)


@dataclass(frozen=True)
class SlowDrift:
    """Slow sway of a sea; a mooring without stiffness in sway has none."""

    #: Standard deviation of sway, heave [m], roll [rad]; shape (3,).
    deviation: Array
    #: Mean zero-crossing period of the slow sway [s].
    crossing_period: float
    #: Of sway with the stiffness of the mean offset [s].
    natural_period: float
    #: All linear and linearised damping over critical at that period: radiation, lines, what the case gives.
    damping_ratio: float
    #: Standard deviation of sway with half that damping [m].
    half_damping: float
    #: Standard deviation of sway with twice that damping [m].
    double_damping: float
    #: [rad/s]; shape (k,)
    difference: Array
    #: Spectrum of the force [N2 s/rad]; shape (k,).
    force: Array
    #: Complex motion per unit force in sway [m/N, rad/N]; shape (k, 3).
    transfer: ComplexArray

    def probable_factor(self, duration: float) -> float:
        """Return the most probable largest amplitude over the standard deviation in ``duration`` [s]."""
        cycles = duration / self.crossing_period if self.crossing_period > 0.0 else 0.0
        return math.sqrt(2.0 * math.log(cycles)) if cycles > math.e else math.sqrt(2.0)


def slow_drift(
    model: FrequencyModel,
    omega: Array,
    directional: Array,
    drift: Array,
    mooring_stiffness: Array,
    damping: LinearDamping,
) -> SlowDrift | None:
    """Return the slow drift motion about the mean offset, ``None`` where sway has no restoring.

    Parameters
    ----------
    model : FrequencyModel
    omega, directional, drift
        As in :func:`force_spectrum`.
    mooring_stiffness : ndarray (3, 3)
        At the mean offset.
    damping : LinearDamping
        Beyond radiation, quadratic terms linearised for the sea.

    Notes
    -----
    The slow motion is not in the linearisation of quadratic damping, nor is wave-drift damping counted: both would
    lessen it.
    """
    unit, hydro = model.unit, model.hydro.unit
    stiffness = unit.statics.stiffness + mooring_stiffness
    modes = natural_modes(hydro, model.inertia, stiffness)
    natural = float(modes.omega[0])
    if not (math.isfinite(natural) and natural > 0.0):
        return None
    added, radiation = added_mass_function(hydro), damping_function(hydro)
    extra = np.asarray(damping.at(model.inertia, natural_added_mass(model, hydro), stiffness), dtype=float)
    shape = modes.shape[0]
    mass = float(shape @ (model.inertia + added(natural)) @ shape)
    ratio = float(shape @ (radiation(natural) + extra) @ shape) / (2.0 * natural * mass)
    step = max(ratio, 0.005) * natural / POINTS_PER_WIDTH
    reach = min(REACH * natural, float(omega[-1] - omega[0]))
    difference = np.arange(step, reach, step)
    if len(difference) < 3:
        return None
    force = force_spectrum(omega, directional, drift, difference)
    weights = integration_weights(difference)

    mu = difference[:, None, None]
    restoring = stiffness - mu**2 * (model.inertia + added(difference))
    losses = radiation(difference) + extra

    def transfer(factor: float) -> ComplexArray:
        matrix = restoring - 1j * mu * factor * losses
        return np.asarray(np.linalg.solve(matrix, np.array([[1.0], [0.0], [0.0]]))[..., 0])

    def deviation(found: ComplexArray) -> Array:
        return np.asarray(np.sqrt((weights * force) @ np.abs(found) ** 2), dtype=float)

    here = transfer(1.0)
    spectrum = weights * force * np.abs(here[:, 0]) ** 2
    second = float(np.sum(spectrum * difference**2))
    crossing = 2.0 * math.pi * math.sqrt(float(np.sum(spectrum)) / second) if second > 0.0 else 2.0 * math.pi / natural
    return SlowDrift(
        deviation(here), crossing, 2.0 * math.pi / natural, ratio, float(deviation(transfer(0.5))[0]),
        float(deviation(transfer(2.0))[0]), difference, force, here,
    )  # fmt: skip


@dataclass(frozen=True)
class CombinedExtremes:
    """Largest of each line, mean, slow drift and waves together, the line on its exact shape."""

    #: Tension at the fairlead [N]; shape (lines,).
    tension: Array
    #: Uplift at the anchor [N]; shape (lines,).
    anchor_vertical: Array
    #: Horizontal tension at the anchor [N]; shape (lines,).
    anchor_horizontal: Array
    #: Length on the bed at that instant [m]; shape (lines,).
    grounded: Array
    #: Largest sway from rest [m].
    offset: float
    #: Uplift and horizontal tension at the anchor [N] where the line pulls as it does at the low end, the mean and the
    #: high end of the largest of storms alike; shape (lines, 3).
    vertical_of_storms: Array
    horizontal_of_storms: Array


def combined_extremes(
    unit: FloatingUnit,
    offset: Array,
    displacement: ComplexArray,
    tension: ComplexArray,
    directional: Array,
    omega: Array,
    slow: SlowDrift | None,
    factors: tuple[Array, Array],
    duration: float,
) -> CombinedExtremes:
    """Return the extremes of lines and sway by the rule of DNV-OS-E301 [eq:breakwater-combined-extreme].

    The larger of: largest slow part with the significant part of the waves, and significant slow part with the largest
    part of the waves. For each line the position that most probably goes with its largest linear tension is taken
    (the covariances of motion and tension over the deviation of tension), and the exact line is solved there.

    Parameters
    ----------
    unit : FloatingUnit
    offset : ndarray (3,)
        Mean [m, rad].
    displacement : ndarray (n, h, 3)
        Motions per wave amplitude.
    tension : ndarray (n, h, lines)
        Linear tension per wave amplitude.
    directional : ndarray (n, h)
    omega : ndarray (n,)
    slow : SlowDrift or None
    factors : (ndarray (3,), ndarray (lines,))
        Most probable largest over deviation, of motions and of tensions, from the waves.
    duration : float
        [s].
    """
    weights = integration_weights(omega)[:, None] * directional
    motion = np.nan_to_num(displacement)
    sway = math.sqrt(float(np.sum(weights * np.abs(motion[..., 0]) ** 2)))
    slow_sway = 0.0 if slow is None else float(slow.deviation[0])
    probable = 0.0 if slow is None else slow.probable_factor(duration)
    pairs = ((probable, SIGNIFICANT), (min(SIGNIFICANT, probable), math.nan))  # of slow drift and waves; NaN: probable
    mean = float(offset[0])
    excursion = max(
        slow_factor * slow_sway + (float(factors[0][0]) if math.isnan(wave) else wave) * sway
        for slow_factor, wave in pairs
    )
    count = len(unit.lines)
    out = {name: np.full(count, math.nan) for name in ("tension", "vertical", "horizontal", "grounded")}
    vertical, horizontal = np.full((count, len(OF_STORMS)), math.nan), np.full((count, len(OF_STORMS)), math.nan)
    if count:
        slope = _slopes(unit, offset)
        pulls = np.nan_to_num(tension)
        for line in range(count):
            variance = float(np.sum(weights * np.abs(pulls[..., line]) ** 2))
            first = np.einsum("nh,nhm,nh->m", weights, motion, pulls[..., line].conj()).real
            first = first / math.sqrt(variance) if variance > 0.0 else np.zeros(3)
            second = _slow_direction(slow, slope[:, line])
            positions = []
            for slow_factor, wave in pairs:
                factor = float(factors[1][line]) if math.isnan(wave) else wave
                positions.append(offset + factor * first + slow_factor * second)
            state = list(unit.mooring.planar.states(np.array(positions)).values())[line]
            at = int(np.argmax(state.tension_fairlead))
            out["tension"][line] = state.tension_fairlead[at]
            out["vertical"][line] = state.vertical_tension_anchor[at]
            out["horizontal"][line] = state.horizontal_tension[at]
            out["grounded"][line] = state.grounded_length[at]
            most = float(factors[1][line])
            if most > 1.0:
                way = positions[at] - offset
                reach = np.array([1.0 + reduced / most**2 for reduced in OF_STORMS])
                storm = list(unit.mooring.planar.states(offset + reach[:, None] * way).values())[line]
                vertical[line], horizontal[line] = storm.vertical_tension_anchor, storm.horizontal_tension
    return CombinedExtremes(
        out["tension"], out["vertical"], out["horizontal"], out["grounded"], abs(mean) + excursion, vertical, horizontal
    )


def _slopes(unit: FloatingUnit, offset: Array) -> Array:
    """Return the change of the tensions with each motion (3, lines)."""
    steps = np.diag([1e-4 * unit.breakwater.hull.beam, 1e-4 * unit.breakwater.hull.beam, 1e-4])
    pull = unit.mooring.planar.tensions(np.concatenate([offset + steps, offset - steps]))
    return np.asarray((pull[:3] - pull[3:]) / (2.0 * np.diag(steps))[:, None])


def _slow_direction(slow: SlowDrift | None, slope: Array) -> Array:
    """Return the slow motion (3,) that goes with one standard deviation of the slow tension of a line."""
    if slow is None:
        return np.zeros(3)
    power = integration_weights(slow.difference) * slow.force
    pull = slow.transfer @ slope
    variance = float(power @ np.abs(pull) ** 2)
    if variance <= 0.0:
        return np.zeros(3)
    return np.asarray((power @ (slow.transfer * pull.conj()[:, None])).real / math.sqrt(variance))


__all__ = ["LEAST_CYCLES", "CombinedExtremes", "SlowDrift", "combined_extremes", "force_spectrum", "slow_drift"]
