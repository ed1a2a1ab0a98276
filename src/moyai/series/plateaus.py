"""Plateaus of a record at its highest or lowest value: a gauge at the end of its range."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from moyai.core.arrays import Array

#: Equal samples at an extreme from which on a gauge may be at its limit
_LEAST = 4


@dataclass(frozen=True)
class Plateau:
    """Samples at an extreme of a record that a smooth record rounded to the steps of its gauge would not show."""

    #: Whether at the highest value.
    top: bool
    #: That value, in the unit of the record.
    level: float
    #: Samples of the longest one.
    longest: int
    #: How many there are.
    count: int
    #: First sample of the first one, from 0.
    first: int

    @property
    def word(self) -> str:
        """``top`` or ``bottom``."""
        return "top" if self.top else "bottom"


def find_plateaus(values: Array) -> list[Plateau]:
    """Return the plateaus at the highest and at the lowest value that are longer than a smooth record makes them.

    A sine of amplitude a that is read in steps of q stands within one step of its crest for ``T acos(1 - q/a) / pi``;
    twice as many samples and two more are a plateau.

    Parameters
    ----------
    values : ndarray, shape (samples,)
        Evenly spaced; missing ones are NaN.
    """
    known = values[np.isfinite(values)]
    span = float(np.ptp(known)) if known.size else 0.0
    if span == 0.0:
        return []
    # the step of the gauge: no two different readings lie closer; rounding of the text is not a step
    gaps = np.diff(np.sort(known))
    quantum = float(gaps[gaps > 1e-9 * span].min())
    mean = float(known.mean())
    crossings = int(np.count_nonzero(np.diff(np.signbit(known - mean))))
    period = 2.0 * known.size / max(crossings, 1)
    found = []
    for sign in (1.0, -1.0):
        extreme = float((sign * known).max())
        with np.errstate(invalid="ignore"):
            flat = sign * values >= extreme - 1e-12 * span
        edges = np.flatnonzero(np.diff(np.concatenate([[0], flat.astype(int), [0]])))
        runs = edges[1::2] - edges[::2]
        amplitude = float(np.maximum(abs(sign * extreme - mean), quantum))
        # how long a sine stays within one step of the gauge at its crest
        natural = period / math.pi * math.acos(1.0 - quantum / amplitude)
        long = (runs >= _LEAST) & (runs > 2.0 * natural + 2.0)
        if long.any():
            first = int(edges[::2][long][0])
            found.append(Plateau(sign > 0.0, sign * extreme, int(runs.max()), int(long.sum()), first))
    return found
