"""When the light was on: pulses, the pictures they fall into, and whether their order in time can be reported."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from moyai.core.arrays import Array
from moyai.core.errors import InputError

LIGHT_SCATTER = 0.15
"""Standard deviation of the logarithm of a streak's light about its particle's own (measured on rendered pictures)."""
TREND_SCATTER = 0.04
"""Standard deviation per pulse of a slow change of that light, as particles wander through the sheet."""
LEAST_EVIDENCE = 5.0
"""Difference of log-likelihood that a direction needs."""


@dataclass(frozen=True, eq=False)
class PulseTrain:
    """Pulses of light while the shutter is open, or over the frames of a film."""

    #: Instants at which the light is switched on [s]; shape (pulses,).
    start: Array
    #: On-times [s]; shape (pulses,).
    duration: Array
    #: Relative brightness of the light; shape (pulses,).
    power: Array

    def __post_init__(self) -> None:
        if len(self.start) < 2 or len(self.duration) != len(self.start) or len(self.power) != len(self.start):
            raise InputError("a train of pulses needs at least two, each with on-time and power", parameter="pulses")
        if np.any(self.duration <= 0.0) or np.any(self.power <= 0.0):
            raise InputError("on-times and powers of pulses must be positive", parameter="pulses")
        if np.any(self.start[1:] - (self.start + self.duration)[:-1] <= 0.0):
            raise InputError(
                "a pulse begins before the one before it has ended",
                parameter="pulses",
                remedy="make the on-times shorter than the interval",
            )

    @property
    def count(self) -> int:
        """Number of pulses."""
        return len(self.start)

    @property
    def end(self) -> Array:
        """Instants at which the light goes off [s]."""
        return self.start + self.duration

    @property
    def light(self) -> Array:
        """Logarithm of power times on-time: the light of a streak whatever the speed [eq:streaks-light]."""
        return np.log(self.power * self.duration)


def regular_pulses(interval: float, on_times: ArrayLike, powers: ArrayLike, count: int) -> PulseTrain:
    """Return ``count`` pulses at one interval, on-times and powers repeating.

    Parameters
    ----------
    interval : float
        From the start of one pulse to the next [s].
    on_times, powers : array_like
        Patterns that repeat [s, -].
    count : int
    """
    index = np.arange(count)
    duration = np.resize(np.atleast_1d(np.asarray(on_times, dtype=float)), count)
    power = np.resize(np.atleast_1d(np.asarray(powers, dtype=float)), count)
    return PulseTrain(np.asarray(interval * index, dtype=float), duration, power)


def direction_evidence(light: Array, steps: NDArray[np.int64], train: PulseTrain) -> tuple[float, int, bool]:
    """Tell the direction of a chain from the light of its streaks [eq:streaks-order].

    Parameters
    ----------
    light : ndarray
        Logarithm of the light of each streak along the chain.
    steps : ndarray, dtype int
        Pulses between neighbours along the chain: 1, or 2 where a streak is missing.
    train : PulseTrain

    Returns
    -------
    evidence : float
        Difference of log-likelihood between the better and the other direction.
    first : int
        Pulse of the earliest streak.
    forward : bool
        Whether the chain as given runs with time.
    """
    place = np.concatenate([[0], np.cumsum(steps)]).astype(int)
    best: list[tuple[float, int]] = []
    for forward in (True, False):
        order = place if forward else place[-1] - place[::-1]
        seen = light if forward else light[::-1]
        scores = [
            (_misfit(seen - train.light[first + order], order), first)
            for first in range(max(train.count - int(order[-1]), 0))
        ]
        best.append(min(scores) if scores else (math.inf, 0))
    with_time, against = best
    if not (math.isfinite(with_time[0]) or math.isfinite(against[0])):
        return 0.0, 0, True
    forward = with_time[0] <= against[0]
    return abs(with_time[0] - against[0]), (with_time if forward else against)[1], forward


def _misfit(rest: Array, order: NDArray[np.int64]) -> float:
    """Return minus the log-likelihood of what is left of the light: a constant, a slow trend and scatter."""
    along = order - order.mean()
    centred = rest - np.median(rest)
    # The trend that is most likely under its own small scatter
    slope = float((along * centred).sum()) / (float((along**2).sum()) + (LIGHT_SCATTER / TREND_SCATTER) ** 2)
    size = np.abs(centred - centred.mean() - slope * along) / LIGHT_SCATTER
    # Huber: a streak spoiled by a neighbour must not decide
    cost = np.where(size < 2.0, 0.5 * size**2, 2.0 * size - 2.0)
    return float(cost.sum()) + 0.5 * (slope / TREND_SCATTER) ** 2


def require_time_order(train: PulseTrain, least_streaks: int) -> None:
    """Refuse pulses whose order in time cannot be found from one picture.

    Parameters
    ----------
    train : PulseTrain
        All within one picture.
    least_streaks : int
        Streaks of the shortest chain that is of use.

    Raises
    ------
    InputError
        When a chain of that length looks alike forwards and backwards.
    """
    if train.count < least_streaks:
        raise InputError(
            f"{train.count} pulses in one picture do not cover a period: {least_streaks} are needed",
            parameter="timing.count",
            remedy="open the shutter for longer, or chop the light faster",
        )
    steps = np.ones(least_streaks - 1, dtype=np.int64)
    evidence = [
        direction_evidence(train.light[first : first + least_streaks], steps, train)[0]
        for first in range(train.count - least_streaks + 1)
    ]
    if min(evidence) < LEAST_EVIDENCE:
        raise InputError(
            "the order in time of the streaks is missing: the pulses look alike forwards and backwards",
            parameter="timing",
            allowed="pulses of unequal on-time or power in an unsymmetrical pattern, such as powers [1, 0.65, 0.4], or "
            "one pulse a frame",
            remedy="state the pattern that the chopper makes; without one the direction of flow is unknown",
        )
