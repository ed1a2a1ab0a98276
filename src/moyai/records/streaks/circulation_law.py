"""The law of circulation over many runs, and what it takes from the inertia coefficient."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import ArrayLike

from moyai.core.arrays import Array
from moyai.core.errors import InputError
from moyai.core.validity import Notice

PUBLISHED = {"Arai": 0.9357, "Otsuka and Ikeda": 1.0, "Chaplin": 0.21 * math.pi**2 / 2.0}
"""Published values of G / (f B^2 KC^2); the last two follow from 2 - C_M of a circle."""
LEAST_KC, MOST_KC = 1.0, 2.0
"""Where the paper's drift measurement holds: weaker flows drift too little, stronger ones shed large vortices."""


@dataclass(frozen=True, eq=False)
class MeasuredCirculationLaw:
    """Circulation = coefficient * f B^2 KC^2."""

    #: Dimensionless coefficient.
    coefficient: float
    #: Standard error of the coefficient; NaN with one run.
    deviation: float
    #: coefficient * f B^2 of each run [m2/s].
    dimensional: Array
    #: Weight of each run; below one where it lies off the others.
    weight: Array
    notices: tuple[Notice, ...] = field(default_factory=tuple)


def fit_circulation_law(
    keulegan_carpenter: ArrayLike, circulation: ArrayLike, frequency: ArrayLike, breadth: ArrayLike
) -> MeasuredCirculationLaw:
    """Fit the law robustly in logarithms with the slope 2 [eq:streaks-law].

    Parameters
    ----------
    keulegan_carpenter : array_like
        KC = V / (f B) of the runs.
    circulation : array_like
        Circulation in the sense of the orbits [m2/s].
    frequency, breadth : array_like
        Wave frequency [Hz] and breadth of the section [m].

    Raises
    ------
    InputError
        When no run has a circulation in the sense of the orbits.
    """
    kc, gamma, f, b = np.broadcast_arrays(
        *(
            np.atleast_1d(np.asarray(item, dtype=float))
            for item in (keulegan_carpenter, circulation, frequency, breadth)
        )
    )
    notices = []
    usable = np.isfinite(gamma) & (gamma > 0.0)
    against = int((np.isfinite(gamma) & (gamma <= 0.0)).sum())
    if against:
        notices.append(
            Notice(
                "circulation-against-orbits",
                f"{against} run(s) circulate against the orbits and are left out of the law",
                value=float(against),
                limit=0.0,
                remedy="check the order in time of the pulses and the direction of the waves",
            )
        )
    if not usable.any():
        raise InputError("no run has a circulation in the sense of the orbits", parameter="runs")
    logs = np.log(gamma[usable] / (f * b**2 * kc**2)[usable])
    centre, weights = float(np.median(logs)), np.ones(logs.size)
    for _ in range(50):
        scale = max(1.4826 * float(np.median(np.abs(logs - centre))), 0.01)
        weights = np.minimum(1.0, 1.345 * scale / np.maximum(np.abs(logs - centre), 1e-300))
        moved = float((weights * logs).sum() / weights.sum())
        if abs(moved - centre) < 1e-12:
            break
        centre = moved
    deviation = math.nan
    if logs.size > 1:
        deviation = math.exp(centre) * math.sqrt(
            float((weights * (logs - centre) ** 2).sum()) / (logs.size - 1) / float(weights.sum())
        )
    weight = np.zeros(kc.shape)
    weight[usable] = weights
    return MeasuredCirculationLaw(math.exp(centre), deviation, math.exp(centre) * f * b**2, weight, tuple(notices))


def inertia_reduction(circulation: ArrayLike, period: ArrayLike, area: ArrayLike) -> Array:
    """Return what a circulation takes from the inertia coefficient [eq:streaks-reduction].

    Parameters
    ----------
    circulation : array_like
        In the sense of the orbits [m2/s].
    period : array_like
        Wave period [s].
    area : array_like
        Area of the section [m2].
    """
    omega = 2.0 * math.pi / np.asarray(period, dtype=float)
    return np.asarray(np.asarray(circulation, dtype=float) / (omega * np.asarray(area, dtype=float)))


def check_amplitude(keulegan_carpenter: float) -> tuple[Notice, ...]:
    """Warn outside the range in which the drift over one period was shown to give the circulation."""
    if LEAST_KC <= keulegan_carpenter <= MOST_KC:
        return ()
    why = (
        "the drift of one period is small against the error of the streaks' ends"
        if keulegan_carpenter < LEAST_KC
        else "vortices of the size of the section make the velocity unlike from period to period"
    )
    limit = LEAST_KC if keulegan_carpenter < LEAST_KC else MOST_KC
    return (
        Notice(
            "streaks-amplitude",
            f"KC = {keulegan_carpenter:.3g} is outside {LEAST_KC:g} to {MOST_KC:g}: {why}",
            value=keulegan_carpenter,
            limit=limit,
            remedy="read the circulation with its interval, and more pictures make it narrower",
            source="Arai, visualisation of the flow",
        ),
    )
