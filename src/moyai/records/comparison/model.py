"""Compare a model with observations: bias, scatter, skill, by sea state, and the error of the field paper."""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from moyai.core.arrays import Array
from moyai.core.errors import InputError


@dataclass(frozen=True)
class ModelAgreement:
    """Figures of a model against observations; equation [eq:records-agreement]."""

    #: Pairs.
    count: int
    #: Mean of model minus observation.
    bias: float
    #: Root mean square of the difference.
    rms: float
    #: RMS after taking off the bias, over the mean magnitude of the observations [-].
    scatter_index: float
    correlation: float
    #: Of the line through the origin, model over observation, by least squares of both directions (principal axis).
    slope: float
    #: 1 - sum of squared differences over that of the observations about their mean (Nash and Sutcliffe) [-].
    skill: float
    #: Willmott's d [-].
    index_of_agreement: float
    #: Mean of (model - observation)/model, the error of Tabata et al. [-].
    paper_error: float
    #: Root mean square of (model - observation)/model [-].
    paper_error_spread: float


def agreement(model: ArrayLike, observed: ArrayLike) -> ModelAgreement:
    """Return the figures of pairs; those with a missing value do not count [eq:records-agreement].

    Raises
    ------
    InputError
        For arrays of different shape or fewer than two pairs.
    """
    m, o = np.asarray(model, dtype=float).reshape(-1), np.asarray(observed, dtype=float).reshape(-1)
    if m.shape != o.shape:
        raise InputError(f"{m.size} model values for {o.size} observations", parameter="model")
    known = np.isfinite(m) & np.isfinite(o)
    m, o = m[known], o[known]
    if m.size < 2:
        raise InputError(f"{m.size} pairs of values", parameter="observed", allowed="two or more")
    difference = m - o
    bias, rms = float(difference.mean()), math.sqrt(float(np.mean(difference**2)))
    magnitude = float(np.mean(np.abs(o)))
    about = o - o.mean()
    total = float(np.sum(about**2))
    both = float(np.std(m) * np.std(o))
    correlation = float(np.mean((m - m.mean()) * about)) / both if both > 0.0 else math.nan
    potential = float(np.sum((np.abs(m - o.mean()) + np.abs(about)) ** 2))
    squares = float(np.sum(difference**2))
    nonzero = m != 0.0
    relative = difference[nonzero] / m[nonzero]
    return ModelAgreement(
        int(m.size),
        bias,
        rms,
        math.sqrt(max(rms**2 - bias**2, 0.0)) / magnitude if magnitude > 0.0 else math.nan,
        correlation,
        _slope(m, o),
        1.0 - squares / total if total > 0.0 else math.nan,
        1.0 - squares / potential if potential > 0.0 else math.nan,
        float(relative.mean()) if relative.size else math.nan,
        math.sqrt(float(np.mean(relative**2))) if relative.size else math.nan,
    )


def _slope(m: Array, o: Array) -> float:
    mm, oo, mo = float(m @ m), float(o @ o), float(m @ o)
    if mo == 0.0:
        return math.nan
    return (mm - oo + math.copysign(1.0, mo) * math.hypot(mm - oo, 2.0 * mo)) / (2.0 * mo)


@dataclass(frozen=True)
class ClassAgreement:
    """Agreement within one class of sea states; ``lower <= state < upper``."""

    lower: float
    upper: float
    agreement: ModelAgreement | None
    count: int


def agreement_by_state(
    model: ArrayLike, observed: ArrayLike, state: ArrayLike, edges: Sequence[float]
) -> tuple[ClassAgreement, ...]:
    """Return the agreement by classes of a sea state, for instance of H1/3.

    Parameters
    ----------
    model, observed, state : array_like
        Of equal shape.
    edges : sequence of float
        Increasing borders of the classes; a class with fewer than two pairs has no figures.
    """
    m, o, s = (np.asarray(values, dtype=float).reshape(-1) for values in (model, observed, state))
    if not m.shape == o.shape == s.shape:
        raise InputError(f"{m.size}, {o.size} and {s.size} values", parameter="state", allowed="equal numbers")
    borders = np.asarray(edges, dtype=float)
    if borders.size < 2 or not np.all(np.diff(borders) > 0.0):
        raise InputError("borders of the classes", parameter="edges", allowed="two or more, increasing")
    out = []
    for lower, upper in itertools.pairwise(borders):
        inside = (s >= lower) & (s < upper) & np.isfinite(m) & np.isfinite(o)
        count = int(np.count_nonzero(inside))
        out.append(
            ClassAgreement(float(lower), float(upper), agreement(m[inside], o[inside]) if count > 1 else None, count)
        )
    return tuple(out)


@dataclass(frozen=True, eq=False)
class Overlay:
    """A model's series and an observed one on common instants."""

    #: Instants of the observation inside the model's time [s].
    time: Array
    #: Values of the model; NaN in gaps.
    model: Array
    #: Values observed; NaN in gaps.
    observed: Array
    #: Seconds by which the model was moved.
    lag: float
    agreement: ModelAgreement


def overlay(
    model_time: ArrayLike,
    model: ArrayLike,
    observed_time: ArrayLike,
    observed: ArrayLike,
    *,
    largest_lag: float = 0.0,
) -> Overlay:
    """Bring two series together on the instants of the observation.

    Parameters
    ----------
    model_time, observed_time : array_like
        Increasing [s].
    model, observed : array_like
        NaN where missing.
    largest_lag : float
        The model may be moved by so much in time to fit best [s]; 0 leaves it where it is.

    Raises
    ------
    InputError
        When the series share no time.
    """
    from moyai.records.reading.clocks import interpolate

    mt, mv = np.asarray(model_time, dtype=float), np.asarray(model, dtype=float)
    ot, ov = np.asarray(observed_time, dtype=float), np.asarray(observed, dtype=float)
    if mt.size < 2 or ot.size < 2:
        raise InputError(f"{mt.size} and {ot.size} instants", parameter="time", allowed="two or more each")
    gap = 2.5 * float(np.median(np.diff(mt)))

    def moved(lag: float) -> Array:
        return interpolate(mt + lag, mv, ot, largest_gap=max(gap, 0.0))

    lag = 0.0
    if largest_lag > 0.0:
        step = min(float(np.median(np.diff(mt))), float(np.median(np.diff(ot))))
        lags = np.arange(-math.floor(largest_lag / step), math.floor(largest_lag / step) + 1) * step
        costs = [_cost(moved(float(candidate)), ov) for candidate in lags]
        best = int(np.argmin(costs))
        lag = float(lags[best])
        if 0 < best < lags.size - 1:
            left, here, right = costs[best - 1 : best + 2]
            bend = left - 2.0 * here + right
            if math.isfinite(bend) and bend > 0.0:
                lag += 0.5 * (left - right) / bend * step
    values = moved(lag)
    shared = np.isfinite(values) & np.isfinite(ov)
    if np.count_nonzero(shared) < 2:
        raise InputError(
            f"model ({mt[0]:.6g} to {mt[-1]:.6g} s) and record ({ot[0]:.6g} to {ot[-1]:.6g} s) share no time",
            parameter="time",
            remedy="give the start of the record, or shift it",
        )
    first, last = np.flatnonzero(shared)[[0, -1]]
    part = slice(int(first), int(last) + 1)
    return Overlay(ot[part], values[part], ov[part], lag, agreement(values[part], ov[part]))


def _cost(model: Array, observed: Array) -> float:
    known = np.isfinite(model) & np.isfinite(observed)
    if np.count_nonzero(known) < 0.5 * observed.size:
        return math.inf
    return float(np.mean((model[known] - observed[known]) ** 2))
