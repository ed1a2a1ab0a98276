"""Whether the periods of a cage in regular waves repeat, and what is still to come where they do not yet."""

from __future__ import annotations

import math

import numpy as np

from moyai.core.arrays import Array

#: Periods of a block, and blocks that are compared.
BLOCK, BLOCKS = 3, 3
#: The same of runs that go on under another law of nets.
LAW_BLOCK = 2
#: Part that a number may still rise by when a run ends, and beyond which it is called a bound.
ENOUGH, OPEN = 0.03, 0.05
#: Part by which the periods of a motion that repeats may differ about their trend.
SCATTER = 0.05
#: Largest ratio of two changes that is believed: it leaves nineteen times the last one.
_SLOWEST = 0.95
#: The same of blocks of which each has but one value: it leaves four times the last change.
_SLOWEST_BLOCK = 0.8


def by_period(time: Array, series: Array, period: float, begin: float) -> Array:
    """Return the largest value of every whole period after ``begin``.

    Parameters
    ----------
    time, series : ndarray
        Rows [s], values.
    period, begin : float
        [s].
    """
    number = np.floor((time - begin) / period + 1e-6).astype(np.int64)
    last = math.floor((float(time[-1]) - begin) / period + 1e-6) if time.size else 0
    inside = (number >= 0) & (number < last)
    if not inside.any():
        return np.zeros(0)
    out = np.full(last, -np.inf)
    np.maximum.at(out, number[inside], series[inside])
    known: Array = out[np.isfinite(out)]
    return known


def still_to_come(values: Array) -> float:
    """Return by how much the largest values of periods will still change; NaN for fewer than nine periods.

    The means of the last three blocks of three periods are taken for an approach whose changes shrink at one ratio
    [eq:cage-settling]; where they turn about or grow, as much again as the last change.

    Parameters
    ----------
    values : ndarray
        Of every period.
    """
    if values.size < BLOCK * BLOCKS:
        return math.nan
    blocks = np.asarray(values[-BLOCK * BLOCKS :]).reshape(BLOCKS, BLOCK).mean(axis=1)
    before, change = float(blocks[1] - blocks[0]), float(blocks[2] - blocks[1])
    if before * change <= 0.0:
        return change
    ratio = min(change / before, _SLOWEST)
    left = change * ratio / (1.0 - ratio) - float(values[-1] - blocks[2])
    # the last period may lie beyond the limit by chance: nothing is left then
    return left if left * change > 0.0 else 0.0


def limit_of(blocks: Array) -> Array:
    """Return where three rows of numbers lead whose changes shrink at one ratio; the last where they do not.

    A twentieth away at most: what leads further cannot be seen from so few periods.

    Parameters
    ----------
    blocks : ndarray, shape (3, n)
        Largest values of three blocks of periods, one after the other.
    """
    before, change = blocks[1] - blocks[0], blocks[2] - blocks[1]
    with np.errstate(divide="ignore", invalid="ignore"):
        ratio = np.where(before * change > 0.0, np.minimum(change / before, _SLOWEST_BLOCK), 0.0)
    most = OPEN * np.abs(blocks[2])
    found: Array = blocks[2] + np.clip(change * ratio / (1.0 - ratio), -most, most)
    return found


def is_settled(values: Array, scale: float) -> bool:
    """Return whether the largest values of periods repeat and rise by no more than a twentieth of ``scale``."""
    return bool(still_to_come(values) <= OPEN * scale) and not scatters(values, scale)


def scatters(values: Array, scale: float) -> bool:
    """Return whether the last periods differ about their trend as those of a motion that never repeats.

    Parameters
    ----------
    values : ndarray
        Of every period.
    scale : float
        What the differences are parts of, in the unit of the values.
    """
    last = np.asarray(values[-BLOCK * BLOCKS :])
    if last.size < BLOCK * BLOCKS:
        return False
    place = np.arange(last.size)
    about = last - np.polyval(np.polyfit(place, last, 1), place)
    return bool(np.ptp(about) > SCATTER * scale)


def may_reach(values: Array, limit: float) -> bool:
    """Return whether periods that never repeat may reach a limit: their highest, and once more their range above it."""
    last = np.asarray(values[-BLOCK * BLOCKS :])
    return bool(last.max() + np.ptp(last) >= limit)


def change_per_period(values: Array) -> float:
    """Return the change of the last periods in one period, the mean over the last two blocks."""
    blocks = np.asarray(values[-2 * BLOCK :])
    if blocks.size < 2:
        return math.nan
    half = blocks.size // 2
    return float(blocks[-half:].mean() - blocks[:half].mean()) / half
