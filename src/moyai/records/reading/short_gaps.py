"""Short gaps of a block filled from their neighbours before a spectrum, by a stated rule, with its effect."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from moyai.core.arrays import Array
from moyai.core.validity import Notice

LARGEST_SHARE = 0.02
"""Share of a channel that may be filled in a block."""
LARGEST_ERROR = 0.3
"""Standard error of a filled sample, in standard deviations of the channel: a longer gap stays a gap."""
_NEIGHBOURS = 12
"""Samples on each side that a filled one is estimated from."""
_FLOOR = 1e-4
"""Noise of a sample, as share of the variance, that keeps the estimate from leaning on the last digits."""


@dataclass(frozen=True, eq=False)
class FilledGaps:
    """Columns after the filling of short gaps."""

    #: NaN stays where a gap is too long, and in a channel that lacks too much; shape (samples, channels).
    values: Array
    #: Largest share of a channel that was filled [-].
    share: float
    #: Bound on the relative change of 4 sqrt(m0) by the filling [-]; equation [eq:records-short-gaps].
    effect: float

    def notice(self, what: str) -> Notice:
        """Return what was filled, as a notice of the analysis ``what``."""
        share, effect = 100.0 * self.share, 100.0 * self.effect
        message = (
            f"{what}: {share:.2g} % of the samples of a block are missing in short gaps, filled from their neighbours "
            f"by the correlation of the block; heights change by at most about {effect:.2g} %"
        )
        return Notice("short-gaps-filled", message, self.share, LARGEST_SHARE, "information")


def fill_short_gaps(values: Array) -> FilledGaps:
    """Fill gaps whose samples follow from their neighbours, by the best linear estimate [eq:records-gap-estimate].

    Parameters
    ----------
    values : ndarray, shape (samples, channels)
        Evenly spaced; NaN where there is no sample.

    Returns
    -------
    FilledGaps
        A channel that lacks more than ``LARGEST_SHARE`` is not filled, nor are gaps at the ends, nor those with a
        sample whose standard error is above ``LARGEST_ERROR`` standard deviations.
    """
    out = np.array(values, dtype=np.float64)
    largest, effect = 0.0, 0.0
    for column in out.T:
        missing = ~np.isfinite(column)
        if not missing.any() or np.mean(missing) > LARGEST_SHARE:
            continue
        lost, filled = _fill(column, missing)
        largest = max(largest, filled / column.size)
        effect = max(effect, math.sqrt(lost / column.size))
    return FilledGaps(out, largest, effect)


def _fill(column: Array, missing: NDArray[np.bool_]) -> tuple[float, int]:
    """Fill a channel in place; return the sum of squared relative errors, and how many samples were filled."""
    edges = np.flatnonzero(np.diff(np.concatenate([[False], missing, [False]]).astype(np.int8)))
    mean = float(np.nanmean(column))
    centred = np.where(missing, 0.0, column - mean)
    reach = 4 * _NEIGHBOURS
    covariance = _covariance(centred, ~missing, reach)
    lost, count = 0.0, 0
    if covariance[0] <= 0.0:  # a silent channel keeps its value
        column[missing] = mean
        return 0.0, int(missing.sum())
    for first, last in zip(edges[::2], edges[1::2]):
        if first == 0 or last == column.size or last - first > _NEIGHBOURS:
            continue
        around = np.arange(max(first - _NEIGHBOURS, 0), min(last + _NEIGHBOURS, column.size))
        known, gap = around[~missing[around]], np.arange(first, last)
        matrix = covariance[np.abs(known[:, None] - known[None, :])]
        matrix[np.diag_indices_from(matrix)] += _FLOOR * covariance[0]
        right = covariance[np.abs(known[:, None] - gap[None, :])]
        weights = np.linalg.solve(matrix, right)
        error = np.clip(1.0 - np.einsum("kg,kg->g", weights, right) / covariance[0], 0.0, 1.0)
        if math.sqrt(float(error.max())) <= LARGEST_ERROR:
            column[first:last] = mean + weights.T @ centred[known]
            lost, count = lost + float(error.sum()), count + int(gap.size)
    return lost, count


def _covariance(centred: Array, known: NDArray[np.bool_], reach: int) -> Array:
    """Return the autocovariance at lags 0 to ``reach`` from the pairs of which both samples are known.

    The mean over the pairs of a lag is weighted by the length of the lag in the record, as in the estimate that gives
    no negative spectrum.
    """
    size = centred.size
    found = np.zeros(reach + 1)
    for lag in range(min(reach, size - 1) + 1):
        pairs = int(np.count_nonzero(known[: size - lag] & known[lag:]))
        if pairs:
            found[lag] = float(centred[: size - lag] @ centred[lag:]) / pairs * (size - lag) / size
    return found
