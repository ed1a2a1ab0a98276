"""Several loggers on one clock: samples of one at the instants of another, and joined records."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike

from moyai.core.arrays import Array
from moyai.core.errors import InputError
from moyai.core.validity import Notice
from moyai.records.reading.record import Record


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
        With a notice that gives how much was interpolated and what share is missing.

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
