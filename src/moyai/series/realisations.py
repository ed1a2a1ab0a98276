"""Numbers of the realisations of a sea: their band, and what one alone proves."""

from __future__ import annotations

import math

import numpy as np

from moyai.core.arrays import Array
from moyai.core.headline import Band, Bound
from moyai.series.intervals import reach_of_mean

#: Key of breakwaters and rows of units for more of them.
MORE = "settings.time.realisations"


def seeds(scatter: Array, bound: Array | None = None, more: str = MORE) -> Band | None:
    """Return the band of realisations: they scatter about their mean, which is the number.

    Criteria are judged at the end of the one-sided 95 % interval of that mean, since few realisations leave
    it uncertain; with a bound on each realisation, of the mean of the bounds. ``more`` is the key for more.
    """
    if scatter.size < 2 or not np.isfinite(scatter).all():
        return None
    upper = scatter if bound is None or bound.size != scatter.size else np.fmax(bound, scatter)
    of = f"{scatter.size} realisations; judged at the 95 % end of their mean"
    ends = (float(scatter.mean()) - reach_of_mean(scatter), float(upper.mean()) + reach_of_mean(upper))
    return Band(
        float(scatter.min()), float(scatter.max()), of, decides=False, judged=ends,
        realisations=scatter.size, more=more, settled=float(upper.mean()),
    )  # fmt: skip


#: Reduced variate of Gumbel's law at the low end, the mean and the high end of the largest of storms alike.
OF_STORMS = (-math.log(-math.log(0.05)), float(np.euler_gamma), -math.log(-math.log(0.95)))
_STORMS = "90 of 100 such storms, peaks by Rayleigh; judged at the mean of their largest"


def storms(value: float, mean: float, factor: float) -> Band | None:
    """Return the band of a most probable largest value over storms alike [eq:extremes-of-storms].

    The largest of a narrow-banded response follows Gumbel's law about its mode ``m`` standard deviations with the scale
    ``1/m``. Criteria are judged at its mean, as those of realisations are; None for a factor that is not above one.

    Parameters
    ----------
    value : float
        Most probable largest value, the mean over time in it.
    mean : float
        Mean over time, of the same sign.
    factor : float
        ``m``, most probable largest over standard deviation of what varies.
    """
    if not factor > 1.0:
        return None
    low, expected, high = (mean + (value - mean) * (1.0 + reduced / factor**2) for reduced in OF_STORMS)
    return Band(low, high, _STORMS, decides=False, judged=(value, expected))


def storm_ends(value: float, ends: Array) -> Band | None:
    """Return the same of a number that was found anew at these ends, as an uplift is that begins at a corner.

    Parameters
    ----------
    value : float
        Most probable largest value.
    ends : ndarray (3,)
        At the low end, the mean and the high end of :func:`storms`; ``None`` comes back where one is not known.
    """
    if ends.size != len(OF_STORMS) or not np.isfinite(ends).all():
        return None
    low, expected, high = (float(end) for end in ends)
    return Band(low, high, _STORMS, decides=False, judged=(value, expected))


#: What is said of a number of one realisation.
ALONE = "one realisation: others may give more, run three or more"


def alone(scatter: Array) -> Bound:
    """Return ``at least`` for the largest value of one realisation: it can break a limit, it cannot prove one."""
    return "at least" if scatter.size == 1 else ""
