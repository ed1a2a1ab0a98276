"""Uncertainty of the largest value of one random record: mean and scatter over records of the same length."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from moyai.series.intervals import deviations_along

#: Blocks that a record is cut into, at most and at least; a block holds that many periods or more.
MOST_BLOCKS, LEAST_BLOCKS, PERIODS = 20, 6, 4.0
#: Periods below which the largest value of a record shows nothing of a storm.
LEAST_PERIODS = LEAST_BLOCKS * PERIODS


@dataclass(frozen=True)
class Maximum:
    """The largest value of records of one length."""

    #: Largest value of the present record.
    observed: float
    #: Mean over all records of that length, estimated from the maxima of blocks.
    mean: float
    #: Standard deviation over the same records, from the same maxima.
    deviation: float
    blocks: int

    @property
    def range(self) -> tuple[float, float]:
        """Values that 5 and 95 of 100 such records do not pass [eq:extremes-range-of-records].

        Gumbel's law, its scale made larger by what mean and deviation of so few blocks leave open.
        """
        reach = math.sqrt(6.0) / math.pi * math.log(self.blocks)
        scale = self.deviation * math.sqrt(1.0 + deviations_along(reach, self.blocks)) * math.sqrt(6.0) / math.pi
        low, high = (self.mean - scale * (np.euler_gamma + math.log(-math.log(share))) for share in (0.05, 0.95))
        return low, high


def maximum_of(time: ArrayLike, values: ArrayLike, period: float) -> Maximum | None:
    """Estimate mean and scatter of the largest value from the maxima of blocks of one record.

    Maxima of ``N`` blocks follow Gumbel's law with mean ``m`` and deviation ``s``; the largest of ``N`` then has the
    mean ``m + s sqrt(6)/pi ln N`` and the same deviation ``s`` [eq:extremes-of-blocks]. ``None`` for records too short.

    Parameters
    ----------
    time, values : array_like
        Record, start-up left out [s].
    period : float
        Peak period of the sea [s]; a block holds four of them or more, so that its maximum hardly hangs on the next.
    """
    t, x = np.asarray(time, dtype=float), np.asarray(values, dtype=float)
    if t.size < 2 or not np.isfinite(x).all():
        return None
    if too_short(t, period):
        return None
    count = _blocks(t, period)
    highest = np.array([float(part.max()) for part in np.array_split(x, count)])
    mean, deviation = float(highest.mean()), float(highest.std(ddof=1))
    largest = mean + deviation * math.sqrt(6.0) / math.pi * math.log(count)
    return Maximum(float(x.max()), largest, deviation, count)


def too_short(time: ArrayLike, period: float) -> bool:
    """Return whether a record holds fewer than :data:`LEAST_PERIODS` periods: its largest value is one of a few waves.

    Parameters
    ----------
    time : array_like
        Of the record, start-up left out [s].
    period : float
        Peak period of the sea [s].
    """
    t = np.asarray(time, dtype=float)
    return bool(t.size < 2 or _blocks(t, period) < LEAST_BLOCKS)


def _blocks(time: np.ndarray, period: float) -> int:
    return min(MOST_BLOCKS, int((time[-1] - time[0]) / (PERIODS * period)))
