"""Several loggers on one clock: finding the error of a clock from a signal both loggers saw, and joining records."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from moyai.core.arrays import Array
from moyai.core.errors import InputError
from moyai.core.validity import Notice
from moyai.records.reading.record import Record
from moyai.records.reading.sources import ClockCorrection


@dataclass(frozen=True, eq=False)
class ClockFit:
    """Error of a logger's clock against another; equation [eq:records-clock]."""

    #: What to add to the second logger's time.
    correction: ClockCorrection
    #: Standard errors [s]; NaN where a single window was used.
    offset_error: float
    #: Standard errors [s/s]; NaN where a single window was used.
    drift_error: float
    #: ``times``, ``offsets``, ``correlation``: Middle of each window on the second clock [s], its offset [s] and the
    #: height of its correlation peak [-].
    times: Array
    #: ``times``, ``offsets``, ``correlation``: Middle of each window on the second clock [s], its offset [s] and the
    #: height of its correlation peak [-].
    offsets: Array
    #: ``times``, ``offsets``, ``correlation``: Middle of each window on the second clock [s], its offset [s] and the
    #: height of its correlation peak [-].
    correlation: Array


def fit_clock(
    reference: Record,
    other: Record,
    channel: str,
    other_channel: str,
    *,
    window: float,
    largest_offset: float,
    least_correlation: float = 0.5,
) -> ClockFit:
    """Find offset and drift of ``other``'s clock from a signal that both loggers recorded.

    In every window the normalised cross-correlation is searched within ``largest_offset``; its peak is refined by a
    parabola; offset and drift follow from the windows by weighted least squares [eq:records-clock].

    Parameters
    ----------
    reference, other : Record
    channel, other_channel : str
        The common signal in each.
    window : float
        Length of a window [s], several times ``largest_offset``.
    largest_offset : float
        Largest error of the clock that is looked for [s].
    least_correlation : float
        Windows with a lower peak do not count.

    Returns
    -------
    ClockFit

    Raises
    ------
    InputError
        When no window correlates.
    """
    if not window > 2.0 * largest_offset:
        raise InputError(f"window {window:g} s", parameter="window", allowed=f"more than {2.0 * largest_offset:g} s")
    step = min(reference.step, other.step)
    start = max(reference.time[0], other.time[0] - largest_offset)
    end = min(reference.time[-1], other.time[-1] + largest_offset)
    found: list[tuple[float, float, float]] = []
    span = round(window / step)
    lags = math.ceil(largest_offset / step)
    for begin in np.arange(start + largest_offset, end - largest_offset - window + 0.5 * step, window):
        grid = begin + np.arange(-lags, span + lags) * step
        fixed = _on(reference, channel, grid)
        moved = _on(other, other_channel, begin + np.arange(span) * step)
        if np.isnan(fixed).any() or np.isnan(moved).any() or np.std(moved) == 0.0:
            continue
        peak = _peak(fixed, moved)
        if peak is not None and peak[1] >= least_correlation:
            found.append((begin + 0.5 * window, (peak[0] - lags) * step, peak[1]))
    if not found:
        raise InputError(
            f"no window of {window:g} s in which '{channel}' and '{other_channel}' correlate by {least_correlation:g}",
            parameter="clock",
            remedy="check the channels, widen 'largest_offset', or give the clock's error",
        )
    times, offsets, correlation = (np.array(column) for column in zip(*found))
    origin = float(times[0])
    if times.size == 1:
        correction = ClockCorrection(float(offsets[0]), 0.0, origin)
        return ClockFit(correction, math.nan, math.nan, times, offsets, correlation)
    design = np.column_stack([np.ones_like(times), times - origin])
    weight = correlation
    for _ in range(3):  # one wrong peak must not bend the line
        solution = np.linalg.lstsq(design * weight[:, None], offsets * weight, rcond=None)[0]
        misfit = offsets - design @ solution
        scale = max(1.4826 * float(np.median(np.abs(misfit))), 0.05 * step)
        weight = correlation / np.maximum(np.abs(misfit) / (2.5 * scale), 1.0)
    freedom = max(times.size - 2, 1)
    variance = float(np.sum((weight * misfit) ** 2) / np.mean(weight**2)) / freedom
    covariance = variance * np.linalg.inv((design * weight[:, None] ** 2).T @ design) * float(np.mean(weight**2))
    errors = np.sqrt(np.diag(covariance))
    correction = ClockCorrection(float(solution[0]), float(solution[1]), origin)
    return ClockFit(correction, float(errors[0]), float(errors[1]), times, offsets, correlation)


def _on(record: Record, channel: str, grid: Array) -> Array:
    return interpolate(record.time, record.sound(channel), grid, largest_gap=2.5 * record.step)


def _peak(fixed: Array, moved: Array) -> tuple[float, float] | None:
    """Return place (in steps, refined) and height of the peak of the normalised correlation."""
    size = fixed.size
    a = moved - moved.mean()
    length = 1 << math.ceil(math.log2(size + a.size))
    product = np.fft.irfft(np.fft.rfft(fixed, length) * np.conj(np.fft.rfft(a, length)), length)[: size - a.size + 1]
    sums = np.concatenate([[0.0], np.cumsum(fixed)])
    squares = np.concatenate([[0.0], np.cumsum(fixed**2)])
    total = sums[a.size :] - sums[: size - a.size + 1]
    power = squares[a.size :] - squares[: size - a.size + 1] - total**2 / a.size
    with np.errstate(invalid="ignore", divide="ignore"):
        correlation = product / np.sqrt(np.maximum(power, 0.0) * np.sum(a**2))
    if not np.isfinite(correlation).any():
        return None
    place = int(np.nanargmax(correlation))
    shift = 0.0
    if 0 < place < correlation.size - 1:
        left, here, right = correlation[place - 1 : place + 2]
        bend = left - 2.0 * here + right
        shift = 0.5 * (left - right) / bend if bend < 0.0 else 0.0
    return place + shift, float(correlation[place])


def interpolate(time: ArrayLike, values: ArrayLike, grid: ArrayLike, *, largest_gap: float) -> Array:
    """Return values on another clock by straight lines between neighbours; NaN across gaps and beyond the ends.

    Parameters
    ----------
    time, values : array_like
        Increasing instants [s] and samples; NaN is no sample.
    grid : array_like
        Instants wanted [s].
    largest_gap : float
        Longest distance of two samples between which a line is drawn [s].
    """
    instants, samples = np.asarray(time, float), np.asarray(values, float)
    wanted = np.asarray(grid, float)
    known = np.isfinite(samples)
    t, v = instants[known], samples[known]
    if t.size < 2:
        return np.full(wanted.shape, np.nan)
    out = np.interp(wanted, t, v, left=np.nan, right=np.nan)
    after = np.clip(np.searchsorted(t, wanted, side="left"), 1, t.size - 1)
    broken = (t[after] - t[after - 1] > largest_gap) & (wanted != t[after]) & (wanted != t[after - 1])
    out[broken] = np.nan
    return np.asarray(out)


def join(records: Sequence[Record], *, step: float, largest_gap: float | None = None) -> Record:
    """Join records of several loggers on one evenly stepped clock, over the time that all share.

    Parameters
    ----------
    records : sequence of Record
        With different channels; all dated or none.
    step : float
        Step of the common clock [s].
    largest_gap : float, optional
        Longest distance of samples between which a line is drawn [s]; 1.5 steps of each logger by default.

    Returns
    -------
    Record
        With a notice that tells how much was interpolated and what share is missing.

    Raises
    ------
    InputError
        When names repeat, dated and undated clocks meet, or nothing is shared.
    """
    names = [name for record in records for name in record.names]
    if len(set(names)) < len(names):
        twice = next(name for name in names if names.count(name) > 1)
        raise InputError(f"two loggers have a channel '{twice}'", parameter="channels", remedy="rename one")
    if len({record.dated for record in records}) > 1:
        raise InputError("one logger has dates and another only seconds", parameter="time", remedy="give 'start'")
    start = max(float(record.time[0]) for record in records)
    end = min(float(record.time[-1]) for record in records)
    if end <= start:
        raise InputError(
            "the loggers share no time", parameter="time", remedy="check 'start', 'utc_offset' and 'clock'"
        )
    grid = start + np.arange(math.floor((end - start) / step + 1e-9) + 1) * step
    columns, units = [], []
    for record in records:
        gap = 1.5 * record.step if largest_gap is None else largest_gap
        for name, unit in zip(record.names, record.units):
            columns.append(interpolate(record.time, record.sound(name), grid, largest_gap=gap))
            units.append(unit)
    values = np.column_stack(columns)
    missing = float(np.mean(np.isnan(values)))
    notice = Notice(
        "joined-clocks",
        f"{len(records)} loggers joined by straight lines at {step:g} s; {100.0 * missing:.3g} % of the samples are "
        "missing and were left so",
        severity="information",
    )
    kept = (*(notice for record in records for notice in record.notices), notice)
    source = ", ".join(dict.fromkeys(record.source for record in records))
    clock = np.asarray(grid, dtype=np.float64)
    return Record(clock, values, tuple(names), tuple(units), records[0].dated, source, notices=kept)
