"""Drift velocity of particles from chains of streaks a little longer than a wave period.

A chain holds the two ends of every streak of one particle and their instants. Two estimates close the period: the cubic
through the last two and the first two velocities shifted by the period (Arai), and a least-squares fit of a straight
drift with harmonics of the period through all ends.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from moyai.core.arrays import Array
from moyai.core.errors import InputError


@dataclass(frozen=True, eq=False)
class StreakChain:
    """Streaks of one particle in the order of time."""

    #: Instants at which the light is switched on [s]; shape (streaks,).
    start_time: Array
    #: Instants at which the light is switched off [s]; shape (streaks,).
    end_time: Array
    #: Positions x, z when the light is switched on [m]; shape (streaks, 2).
    start: Array
    #: Positions x, z when the light is switched off [m]; shape (streaks, 2).
    end: Array

    def __post_init__(self) -> None:
        count = len(self.start_time)
        if len(self.end_time) != count or self.start.shape != (count, 2) or self.end.shape != (count, 2):
            raise InputError("a chain needs two instants and two positions for every streak", parameter="chain")
        if np.any(self.end_time <= self.start_time) or np.any(self.start_time[1:] < self.end_time[:-1]):
            raise InputError("the streaks of a chain are not in the order of time", parameter="chain")

    @property
    def time(self) -> Array:
        """Middle of every streak's on-time [s]."""
        return 0.5 * (self.start_time + self.end_time)

    @property
    def position(self) -> Array:
        """Midpoint of every streak [m]."""
        return 0.5 * (self.start + self.end)

    @property
    def velocity(self) -> Array:
        """Length over on-time, in the direction of time [m/s]."""
        return (self.end - self.start) / (self.end_time - self.start_time)[:, None]

    @property
    def span(self) -> float:
        """From the first light to the last [s]."""
        return float(self.end_time[-1] - self.start_time[0]) if len(self.start_time) else 0.0


@dataclass(frozen=True, eq=False)
class ParticleDrift:
    """Drift of one particle."""

    #: Mean over time of one orbit, where the drift counts [m]; shape (2,).
    position: Array
    #: Displacement in one period over the period [m/s]; shape (2,).
    velocity: Array
    #: Where the particle is one period after the middle of its first streak [m]; shape (2,).
    closure: Array
    #: Standard error of each component of the velocity [m/s]; NaN where the method gives none.
    deviation: float = math.nan
    #: Root mean square distance of the ends from the fit [m]; NaN where nothing is left over.
    residual: float = math.nan


def close_period_cubic(chain: StreakChain, period: float) -> ParticleDrift:
    """Close the period by the cubic through four velocities [eq:streaks-cubic].

    Parameters
    ----------
    chain : StreakChain
        At least four streaks over most of a period.
    period : float
        Wave period [s].

    Raises
    ------
    InputError
        When the chain ends long before the period does.
    """
    _require_period(chain, period, least=4)
    time, position, velocity = chain.time, chain.position, chain.velocity
    target = time[0] + period
    last = int(np.searchsorted(time, target, side="right")) - 1
    if target - time[last] < 1e-9 * period:
        closure = position[last]
    else:
        nodes = np.array([time[last - 1], time[last], target, time[1] + period])
        values = np.stack([velocity[last - 1], velocity[last], velocity[0], velocity[1]])
        # Powers of time from the last streak, in units of the step, keep the small system well conditioned
        unit = target - time[last]
        powers = np.linalg.solve(np.vander((nodes - time[last]) / unit, 4, increasing=True), values)
        closure = position[last] + unit * (powers / np.arange(1, 5)[:, None]).sum(axis=0)
    times = np.append(time[: last + 1], target) if target - time[last] >= 1e-9 * period else time[: last + 1]
    places = np.vstack([position[: last + 1], closure])[: len(times)]
    speeds = np.vstack([velocity[: last + 1], velocity[:1]])[: len(times)]
    step = np.diff(times)[:, None]
    # Trapezoid with the correction of its ends by the velocities (Hermite), exact for cubics
    integral = (0.5 * step * (places[1:] + places[:-1]) + step**2 / 12.0 * (speeds[:-1] - speeds[1:])).sum(axis=0)
    return ParticleDrift(integral / (times[-1] - times[0]), (closure - position[0]) / period, closure)


def fit_drift_harmonics(chain: StreakChain, period: float, *, harmonics: Sequence[int] = (1, 2, 3, 4)) -> ParticleDrift:
    """Fit a straight drift and harmonics of the period to all ends of a chain [eq:streaks-harmonic].

    Parameters
    ----------
    chain : StreakChain
        Longer than about 0.9 periods.
    period : float
        Wave period [s].
    harmonics : sequence of int
        Numbers of harmonics that are tried; the corrected information criterion of Akaike chooses.

    Raises
    ------
    InputError
        When the chain is too short.
    """
    _require_period(chain, period, least=4)
    time = np.concatenate([chain.start_time, chain.end_time])
    place = np.vstack([chain.start, chain.end])
    middle = 0.5 * (chain.start_time[0] + chain.end_time[-1])
    phase = (time - middle) / period
    count = time.size
    best: tuple[float, Array, Array, float, int] | None = None
    for number in harmonics:
        unknowns = 2 + 2 * number
        if count < unknowns + 3:
            continue
        basis = _basis(phase, number)
        inverse, coefficients, misfit = _least_squares(basis, place)
        squares = float((misfit**2).sum())
        # Both components share the error, so that each end counts twice and the variance once
        freedom = 2 * count - 2 * unknowns - 2
        criterion = 2 * count * math.log(max(squares, 1e-300) / (2 * count)) + 2.0 * (2 * unknowns + 1) * (
            2 * count / freedom
        )
        if best is None or criterion < best[0]:
            deviation = math.sqrt(squares / (2 * (count - unknowns)) * inverse[1, 1]) / period
            best = (criterion, coefficients, misfit, deviation, number)
    if best is None:
        raise InputError(
            f"a chain of {len(chain.start_time)} streaks is too short for a fit",
            parameter="chain",
            allowed="at least 4",
        )
    _, coefficients, misfit, deviation, number = best
    first = _basis(np.array([(chain.time[0] - middle) / period + 1.0]), number) @ coefficients
    residual = math.sqrt(float((misfit**2).sum()) / count)
    return ParticleDrift(coefficients[0], coefficients[1] / period, first[0], deviation, residual)


def _basis(phase: Array, number: int) -> Array:
    columns = [np.ones_like(phase), phase]
    for n in range(1, number + 1):
        columns += [np.cos(2.0 * math.pi * n * phase), np.sin(2.0 * math.pi * n * phase)]
    return np.column_stack(columns)


def _least_squares(basis: Array, values: Array) -> tuple[Array, Array, Array]:
    inverse = np.asarray(np.linalg.pinv(basis.T @ basis), dtype=float)
    coefficients = inverse @ (basis.T @ values)
    return inverse, coefficients, values - basis @ coefficients


def _require_period(chain: StreakChain, period: float, *, least: int) -> None:
    count = len(chain.start_time)
    if count < least:
        raise InputError(
            f"a chain of {count} streaks is too short", parameter="chain", allowed=f"at least {least} streaks"
        )
    if not period > 0.0:
        raise InputError(f"a period of {period:g} s is not positive", parameter="period")
    gap = period - (chain.time[-1] - chain.time[0])
    step = float(np.median(np.diff(chain.time)))
    if gap > 1.01 * step:
        raise InputError(
            f"a chain of {chain.span:.3g} s ends {gap:.3g} s before the period of {period:.3g} s does",
            parameter="chain",
            allowed="a last streak within one step of the end of the period",
        )
