"""Thin out long records without losing an extreme value."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from moyai.series.zero_crossing import split_waves


def envelope_indices(values: ArrayLike, bins: int) -> NDArray[np.int64]:
    """Return the indices of the smallest and the largest value in each of ``bins`` stretches of a record.

    Parameters
    ----------
    values : array_like, shape (samples,) or (samples, channels)
        The record; NaN is passed over.
    bins : int
        Number of stretches of equal length.

    Returns
    -------
    ndarray
        Sorted indices, at most ``2 * bins * channels + 2``; first and last sample included. All indices when the
        record is not longer than that.
    """
    record = np.asarray(values, dtype=float)
    record = record[:, None] if record.ndim == 1 else record
    samples, channels = record.shape
    if samples <= 2 * bins * channels + 2 or bins < 1:
        return np.arange(samples, dtype=np.int64)
    length = -(-samples // bins)
    padding = bins * length - samples
    chosen = [np.array([0, samples - 1], dtype=np.int64)]
    starts = np.arange(bins, dtype=np.int64) * length
    for channel in record.T:
        low = np.concatenate([np.where(np.isnan(channel), np.inf, channel), np.full(padding, np.inf)])
        high = np.concatenate([np.where(np.isnan(channel), -np.inf, channel), np.full(padding, -np.inf)])
        chosen.append(starts + low.reshape(bins, length).argmin(axis=1))
        chosen.append(starts + high.reshape(bins, length).argmax(axis=1))
    indices = np.unique(np.concatenate(chosen))
    kept: NDArray[np.int64] = indices[indices < samples]
    return kept


def focus_indices(
    values: ArrayLike, window: tuple[int, int], bins: int, window_budget: int = 4000
) -> NDArray[np.int64]:
    """Return indices that keep every sample in a window and the extremes of the record outside it.

    Parameters
    ----------
    values : array_like, shape (samples,) or (samples, channels)
        The record.
    window : tuple of int
        First index and one past the last of the window.
    bins : int
        Stretches over the whole record outside the window.
    window_budget : int
        Samples of the window kept at most; a longer one is thinned by its extremes too.

    Returns
    -------
    ndarray
        Sorted indices.
    """
    record = np.asarray(values, dtype=float)
    record = record[:, None] if record.ndim == 1 else record
    start, stop = max(window[0], 0), min(window[1], record.shape[0])
    inside = np.arange(start, stop, dtype=np.int64)
    if inside.size > window_budget:
        inside = start + envelope_indices(record[start:stop], max(window_budget // (2 * record.shape[1]), 1))
    outside = envelope_indices(record, bins)
    outside = outside[(outside < start) | (outside >= stop)]
    return np.unique(np.concatenate([outside, inside]))


def window_around(time: ArrayLike, centre: float, length: float) -> tuple[int, int]:
    """Return the index range of a window of ``length`` [s] about ``centre`` [s], shifted to lie within the record.

    Parameters
    ----------
    time : array_like
        Increasing times [s].
    centre, length : float
        Middle and length of the window [s].

    Returns
    -------
    tuple of int
        First index and one past the last.
    """
    times = np.asarray(time, dtype=float)
    start = min(max(centre - 0.5 * length, times[0]), max(times[-1] - length, times[0]))
    first = int(np.searchsorted(times, start, side="left"))
    last = int(np.searchsorted(times, start + length, side="right"))
    return first, max(last, min(first + 2, times.size))


def mean_crossing_period(time: ArrayLike, values: ArrayLike) -> float:
    """Return the mean up-crossing period [s] of a record about its mean, NaN when it crosses less than twice.

    Parameters
    ----------
    time : array_like
        Times [s].
    values : array_like
        The record.

    Returns
    -------
    float
    """
    times, record = np.asarray(time, dtype=float), np.asarray(values, dtype=float)
    known = np.isfinite(record)
    times, record = times[known], record[known]
    if record.size < 3:
        return float("nan")
    waves = split_waves(times, record)
    return float(waves.period.mean()) if len(waves) else float("nan")
