"""Removal of mean, trend, tide and surge from a record with gaps."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from moyai.core.arrays import Array
from moyai.core.errors import InputError
from moyai.core.options import checks_words


@checks_words
@dataclass(frozen=True)
class Detrend:
    """What is taken off a record."""

    #: ``high_pass`` takes off the slow part that :func:`slow_part` finds: tide, surge, long waves.
    kind: Literal["none", "mean", "linear", "quadratic", "high_pass"] = "mean"
    #: Period above which ``high_pass`` counts as slow [s].
    cutoff: float = math.nan

    def __post_init__(self) -> None:
        if self.kind == "high_pass" and not self.cutoff > 0.0:
            raise InputError("high_pass needs a cut-off period", parameter="cutoff", allowed="greater than 0 s")


def detrended(time: ArrayLike, values: ArrayLike, detrend: Detrend) -> Array:
    """Return a record with its slow part taken off; NaN stays NaN."""
    t, v = np.asarray(time, dtype=float), np.asarray(values, dtype=float)
    return np.asarray(v - trend_of(t, v, detrend))


def trend_of(time: Array, values: Array, detrend: Detrend) -> Array:
    """Return what :func:`detrended` takes off."""
    if detrend.kind == "none":
        return np.zeros_like(values)
    if detrend.kind == "high_pass":
        return slow_part(time, values, detrend.cutoff)
    known = np.isfinite(values)
    degree = {"mean": 0, "linear": 1, "quadratic": 2}[detrend.kind]
    if np.count_nonzero(known) <= degree:
        return np.full_like(values, np.nan)
    middle, half = 0.5 * (time[0] + time[-1]), max(0.5 * (time[-1] - time[0]), 1e-300)
    x = (time - middle) / half
    design = np.column_stack([x**power for power in range(degree + 1)])
    coefficients = np.linalg.lstsq(design[known], values[known], rcond=None)[0]
    return np.asarray(design @ coefficients)


def slow_part(time: ArrayLike, values: ArrayLike, cutoff: float) -> Array:
    """Return the part of a record that varies slower than ``cutoff``; equation [eq:records-slow].

    Local parabolas, fitted under a window of cosine shape whose length is chosen for an amplitude response of one half
    at the cut-off period: no phase shift, straight on to the ends, and gaps weigh nothing instead of being filled.

    Parameters
    ----------
    time : array_like
        Increasing instants [s].
    values : array_like
        NaN where missing.
    cutoff : float
        Period with response one half [s].

    Returns
    -------
    ndarray
        NaN where there are too few samples near.

    Raises
    ------
    InputError
        When the record is shorter than the cut-off period.
    """
    t, v = np.asarray(time, dtype=float), np.asarray(values, dtype=float)
    if t.size < 5:
        raise InputError(f"{t.size} samples", parameter="cutoff", allowed="five or more")
    step = float(np.median(np.diff(t)))
    length = t[-1] - t[0]
    if not 4.0 * step < cutoff <= length:
        raise InputError(
            f"cut-off period {cutoff:.4g} s", parameter="cutoff", allowed=f"between {4.0 * step:.4g} and {length:.4g} s"
        )
    # The slow part needs few points: bins of a fortieth of the period, then a local fit on those
    bin_length = max(step, cutoff / 40.0)
    number = np.floor((t - t[0]) / bin_length).astype(np.int64)
    known = np.isfinite(v)
    count = np.bincount(number[known], minlength=int(number[-1]) + 1).astype(float)
    total = np.bincount(number[known], weights=v[known] - np.nanmean(v), minlength=count.size)
    instants = np.bincount(number[known], weights=t[known] - t[0], minlength=count.size)
    with np.errstate(invalid="ignore", divide="ignore"):
        centre = np.where(count > 0, instants / count, (np.arange(count.size) + 0.5) * bin_length)
        mean = np.where(count > 0, total / count, 0.0)
    half = _HALF_WIDTH * cutoff
    slow = _local_parabolas(centre, mean, count, half)
    out = np.interp(t - t[0], centre, slow)
    lost = np.interp(t - t[0], centre, np.isnan(slow).astype(float)) > 0.0
    out[lost] = np.nan
    return np.asarray(out + np.nanmean(v))


# Half width of the window over the cut-off period: response one half of a local parabola under a squared cosine,
# found by solving the response of equation [eq:records-slow] for 1/2
_HALF_WIDTH = 0.8830072602438066


def _local_parabolas(x: Array, y: Array, weight: Array, half: float) -> Array:
    """Return local quadratic fits at ``x``, NaN where fewer than four bins are near."""
    out = np.full(x.size, np.nan)
    first = np.searchsorted(x, x - half)
    last = np.searchsorted(x, x + half)
    for i in range(x.size):
        part = slice(first[i], last[i])
        d = (x[part] - x[i]) / half
        w = weight[part] * np.cos(0.5 * math.pi * np.clip(d, -1.0, 1.0)) ** 2
        if np.count_nonzero(w > 0.0) < 4:
            continue
        moments = [float(np.sum(w * d**power)) for power in range(5)]
        normal = np.array([moments[0:3], moments[1:4], moments[2:5]])
        right = np.array([float(np.sum(w * d**power * y[part])) for power in range(3)])
        try:
            out[i] = np.linalg.solve(normal, right)[0]
        except np.linalg.LinAlgError:
            continue
    return out


def slow_response(period_ratio: ArrayLike) -> Array:
    """Return the amplitude response of :func:`slow_part` to a wave of ``period / cutoff`` [eq:records-slow]."""
    ratio = np.atleast_1d(np.asarray(period_ratio, dtype=float))
    d, weights = np.polynomial.legendre.leggauss(400)
    w = weights * np.cos(0.5 * math.pi * d) ** 2
    m0, m2, m4 = (float(np.sum(w * d**power)) for power in (0, 2, 4))
    kernel = w * (m4 - m2 * d**2) / (m0 * m4 - m2**2)
    return np.asarray(np.cos(2.0 * math.pi * _HALF_WIDTH / ratio[:, None] * d) @ kernel)
