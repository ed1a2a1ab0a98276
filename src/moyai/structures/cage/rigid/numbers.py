"""From time series to numbers: ranges, first harmonics, tensions."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from moyai.core.arrays import Array
from moyai.structures.cage.rigid.time import March


@dataclass(frozen=True, eq=False)
class Numbers:
    """Numbers of one run; arrays over (sway, heave, roll) or over (lines, ends).

    ``range`` is the mean over wave periods of largest less smallest value, the drift within the period taken out.
    """

    range: Array
    largest_range: Array
    mean: Array
    maximum: Array
    minimum: Array
    deviation: Array
    first_harmonic: Array
    first_phase: Array
    drift_velocity: float
    line_tension_minimum: Array
    line_tension_mean: Array
    line_tension_maximum: Array
    line_tension_mean_peak: Array
    slack_share: Array

    def largest_offset(self, at_rest: float) -> float:
        """Return the largest sway either way [m], from a point that the place of rest is ``at_rest`` [m] off."""
        return float(np.abs(at_rest + np.array([self.minimum[0], self.maximum[0]])).max())


def numbers_of(found: March, rest: Array, ends: Array, peak_at_ends: Array, period: float, skip: float) -> Numbers:
    """Return the numbers of a march after ``skip`` seconds.

    Parameters
    ----------
    found : March
    rest : ndarray, shape (3,)
        Place of rest.
    ends : ndarray, shape (rows, lines, 2)
        Tension at the cage and at the anchor [N].
    peak_at_ends : ndarray, shape (rows, lines, 2)
        Largest tension around each row [N].
    period : float
        Wave period, or peak period [s].
    skip : float
        [s].
    """
    keep = found.time >= skip - 1e-9 * period
    time, motion = found.time[keep], found.state[keep][:, :3] - rest
    pulls, peaks = ends[keep], peak_at_ends[keep]
    spacing = found.time[1] - found.time[0]
    count = max(1, round(period / spacing))
    whole = max((len(time) - 1) // count, 0)
    if whole == 0:
        whole, count = 1, max(len(time) - 1, 1)
    ranges = []
    tops = []
    for n in range(whole):
        part = motion[n * count : (n + 1) * count + 1]
        drift = np.linspace(0.0, 1.0, len(part))[:, None] * (part[-1] - part[0])
        ranges.append(np.ptp(part - drift, axis=0))
        tops.append(peaks[n * count : (n + 1) * count + 1].max(axis=0))
    table = np.array(ranges)
    used = slice(0, whole * count + 1)
    harmonic, phase = _first_harmonic(time[used], motion[used], period)
    return Numbers(
        range=table.mean(axis=0),
        largest_range=table.max(axis=0),
        mean=motion.mean(axis=0),
        maximum=motion.max(axis=0),
        minimum=motion.min(axis=0),
        deviation=motion.std(axis=0),
        first_harmonic=harmonic,
        first_phase=phase,
        drift_velocity=float((motion[used][-1, 0] - motion[used][0, 0]) / max(time[used][-1] - time[used][0], 1e-300)),
        line_tension_minimum=pulls.min(axis=0),
        line_tension_mean=pulls.mean(axis=0),
        line_tension_maximum=peaks.max(axis=0),
        line_tension_mean_peak=np.array(tops).mean(axis=0),
        slack_share=(pulls[:, :, 0] <= 0.0).mean(axis=0) if pulls.shape[1] else np.zeros(0),
    )


def _first_harmonic(time: Array, motion: Array, period: float) -> tuple[Array, Array]:
    """Fit mean, drift and the first harmonic; return amplitude and phase after t = 0 [eq:cage-harmonic]."""
    angle = 2.0 * math.pi / period * time
    basis = np.stack([np.ones_like(time), time - time.mean(), np.cos(angle), np.sin(angle)], axis=1)
    weights = np.linalg.lstsq(basis, motion, rcond=None)[0]
    amplitude = weights[2] + 1j * weights[3]
    return np.abs(amplitude), np.angle(amplitude)
