"""Compiled search for the largest sample in the time of each wave: arrays in, arrays out."""

from __future__ import annotations

import math
from typing import Any

from moyai.core.compiled import njit


@njit(cache=True, error_model="numpy")
def _second_peak(values: Any, low: int, high: int, place: int, share: float) -> bool:
    """Return whether another peak near the first stands behind a valley of less than half of it."""
    top = values[place]
    if not top > 0.0:
        return False
    for side in (-1, 1):
        valley = False
        k = place + side
        while low <= k < high:
            valley = valley or values[k] < 0.5 * top
            if valley and values[k] > share * top:
                return True
            k += side
    return False


@njit(cache=True, error_model="numpy")
def largest_of_waves(values: Any, low: Any, high: Any, share: float, place: Any, double: Any) -> None:
    """Write where the largest of ``values[low:high]`` stands for each wave, and whether a second peak follows.

    A sample that is no number is the largest; a window without samples leaves its entries as they are. ``share``: part
    of the first peak from which on another one is a second.
    """
    for i in range(low.size):
        if high[i] <= low[i]:
            continue
        best = low[i]
        for k in range(low[i], high[i]):
            if math.isnan(values[k]):
                best = k
                break
            if values[k] > values[best]:
                best = k
        place[i] = best
        double[i] = _second_peak(values, low[i], high[i], best, share)


__all__ = ["largest_of_waves"]
