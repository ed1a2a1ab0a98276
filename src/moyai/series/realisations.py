"""Numbers of the realisations of a sea: their band, and what one alone proves."""

from __future__ import annotations

import numpy as np

from moyai.core.arrays import Array
from moyai.core.headline import Band, Bound
from moyai.series.intervals import reach_of_mean


def seeds(scatter: Array, bound: Array | None = None) -> Band | None:
    """Return the band of realisations: they scatter about their mean, which is the number.

    Criteria are judged at the end of the one-sided 95 % interval of that mean (Student), since few realisations leave
    it uncertain; with a bound on each realisation, of the mean of the bounds.
    """
    if scatter.size < 2 or not np.isfinite(scatter).all():
        return None
    upper = scatter if bound is None or bound.size != scatter.size else np.fmax(bound, scatter)
    of = f"{scatter.size} realisations; judged at the 95 % end of their mean"
    ends = (float(scatter.mean()) - reach_of_mean(scatter), float(upper.mean()) + reach_of_mean(upper))
    return Band(float(scatter.min()), float(scatter.max()), of, decides=False, judged=ends)


#: What is said of a number of one realisation.
ALONE = "one realisation: others may give more, ask for three or more"


def alone(scatter: Array) -> Bound:
    """Return ``at least`` for the largest value of one realisation: it can break a limit, it cannot prove one."""
    return "at least" if scatter.size == 1 else ""
