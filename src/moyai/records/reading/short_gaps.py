"""Short gaps of a block filled by straight lines before a spectrum, by a stated rule, with a bound on the effect."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from moyai.core.arrays import Array
from moyai.core.validity import Notice

LARGEST_SHARE = 0.02
"""Share of a channel that may be filled in a block: the height then changes by less than 5 % (see ``FilledGaps``)."""
LONGEST_GAP = 0.25
"""Longest distance of the samples on both sides of a gap, in the shortest period of the band."""


@dataclass(frozen=True, eq=False)
class FilledGaps:
    """Columns after the filling of short gaps.

    Parameters
    ----------
    values : ndarray, shape (samples, channels)
        NaN stays where a gap is too long, and in a channel that lacks too much.
    share : float
        Largest share of a channel that was filled [-].
    effect : float
        Bound on the relative change of 4 sqrt(m0) by the filling [-]; equation [eq:records-short-gaps].
    """

    values: Array
    share: float
    effect: float

    def notice(self, what: str) -> Notice:
        """Return what was filled, as a notice of the analysis ``what``."""
        message = (
            f"{what}: {100.0 * self.share:.2g} % of the samples of a block are missing in short gaps, filled by "
            f"straight lines; heights change by at most about {100.0 * self.effect:.2g} %"
        )
        return Notice("short-gaps-filled", message, self.share, LARGEST_SHARE, "information")


def fill_short_gaps(step: float, values: Array, highest: float) -> FilledGaps:
    """Fill gaps over which a wave of the highest frequency passes less than a quarter of its period.

    Parameters
    ----------
    step : float
        Time step [s].
    values : ndarray, shape (samples, channels)
        NaN where there is no sample.
    highest : float
        Upper end of the band of heights and periods [Hz].

    Returns
    -------
    FilledGaps
        A channel that lacks more than ``LARGEST_SHARE`` is not filled, nor are gaps at the ends.
    """
    out = np.array(values, dtype=np.float64)
    largest, effect = 0.0, 0.0
    for column in out.T:
        missing = ~np.isfinite(column)
        if not missing.any() or np.mean(missing) > LARGEST_SHARE:
            continue
        edges = np.flatnonzero(np.diff(np.concatenate([[False], missing, [False]]).astype(np.int8)))
        filled, longest = 0, 0
        for first, last in zip(edges[::2], edges[1::2]):
            inside = first > 0 and last < column.size
            if inside and (last - first + 1) * step <= LONGEST_GAP / highest:
                part = np.linspace(column[first - 1], column[last], last - first + 2)
                column[first:last] = part[1:-1]
                filled, longest = filled + int(last - first), max(longest, int(last - first))
        share = filled / column.size
        # Half way across a straight line a wave lacks 1 - cos(pi f d) of its height, d the distance of the ends
        lost = 1.0 - math.cos(math.pi * highest * (longest + 1) * step) if filled else 0.0
        largest, effect = max(largest, share), max(effect, math.sqrt(share) * lost)
    return FilledGaps(out, largest, effect)
