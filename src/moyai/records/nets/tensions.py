"""Tensions at both ends of the mooring lines of a model cage: mean, least, peak, first harmonic, share of slack."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from moyai.core.arrays import Array
from moyai.core.errors import InputError
from moyai.core.validity import Notice
from moyai.records.forces.record import period_of
from moyai.series.harmonics import fit_harmonics

#: Share of the peak below which a line counts as slack
SLACK_SHARE = 0.02
#: Samples that the sharpest rise needs at least
_LEAST_RISE = 3


@dataclass(frozen=True, eq=False)
class EndRecord:
    """Tension at one end of a line."""

    #: Name of the line, for instance ``shore``.
    line: str
    #: Name of its end, for instance ``cage``.
    end: str
    #: [N]; shape (samples,).
    tension: Array


@dataclass(frozen=True, eq=False)
class CageRecord:
    """Tensions of a cage in regular waves.

    Raises
    ------
    InputError
        For gaps, uneven steps, or an end that is given twice.
    """

    name: str
    #: [s]; shape (samples,).
    time: Array
    ends: tuple[EndRecord, ...]
    #: Of the waves [s]; found from the tension that varies most when absent.
    period: float | None = None
    #: Part to use [s].
    window: tuple[float, float] | None = None

    def __post_init__(self) -> None:
        time = np.asarray(self.time, dtype=float)
        if time.size < 32 or not np.isfinite(time).all() or not (np.diff(time) > 0.0).all():
            raise InputError(
                f"run {self.name}: time does not rise or has gaps", parameter="time", allowed="rising seconds"
            )
        if not self.ends:
            raise InputError(f"run {self.name}: no tension was given", parameter="tensions")
        seen: set[tuple[str, str]] = set()
        for end in self.ends:
            if (end.line, end.end) in seen:
                raise InputError(
                    f"run {self.name}: line {end.line} has the end '{end.end}' twice", parameter="tensions"
                )
            seen.add((end.line, end.end))
            if end.tension.shape != time.shape or not np.isfinite(end.tension).all():
                raise InputError(
                    f"run {self.name}: tension {end.line} {end.end} has gaps or another length than time",
                    parameter="tensions",
                    remedy="fill short gaps or cut the record",
                )


@dataclass(frozen=True)
class EndTension:
    """What one end of a line carries."""

    line: str
    end: str
    #: Mean over the whole window, as recorded [N].
    mean: float
    #: Lowest value of the whole window, as recorded [N].
    least: float
    #: Highest value of the whole window, as recorded [N].
    peak: float
    #: Mean of the peaks of single periods [N].
    mean_peak: float
    #: Standard deviation of the peaks of single periods [N].
    peak_deviation: float
    #: Amplitude of the first harmonic, Re(X e^{-i omega t}) about the start of the window [N].
    first: float
    #: Phase of the first harmonic [rad].
    first_phase: float
    #: Share of the time below 2 % of the peak [-].
    slack: float
    periods: int


def measure_tensions(record: CageRecord) -> tuple[tuple[EndTension, ...], tuple[Notice, ...]]:
    """Return the tension at every end of every line.

    Parameters
    ----------
    record : CageRecord

    Raises
    ------
    InputError
        When the window holds less than one period.
    """
    time = np.asarray(record.time, dtype=float)
    part = np.ones(time.size, dtype=bool)
    if record.window is not None:
        part = (time >= record.window[0]) & (time <= record.window[1])
    if int(part.sum()) < 32:
        raise InputError(
            f"run {record.name}: {int(part.sum())} samples in the window", parameter="window", allowed="32"
        )
    t = time[part]
    channels = np.column_stack([end.tension[part] for end in record.ends])
    period = record.period if record.period is not None else period_of(t, channels)
    found, notices = [], []
    step = float(np.median(np.diff(t)))
    for end, values in zip(record.ends, channels.T):
        harmonic = fit_harmonics(t, values, 2.0 * math.pi / period, count=1)
        inside = (t >= harmonic.start) & (t < harmonic.end)
        index = np.minimum((t[inside] - harmonic.start) // period, harmonic.periods - 1).astype(int)
        peaks = np.array([values[inside][index == k].max() for k in range(harmonic.periods)])
        first = complex(harmonic.first) * np.exp(-1j * 2.0 * math.pi / period * t[0])
        peak = float(values.max())
        found.append(
            EndTension(
                line=end.line,
                end=end.end,
                mean=float(harmonic.mean),
                least=float(values.min()),
                peak=peak,
                mean_peak=float(peaks.mean()),
                peak_deviation=float(peaks.std(ddof=1)) if peaks.size > 1 else math.nan,
                first=abs(first),
                first_phase=float(np.angle(first)),
                slack=float(np.mean(values < SLACK_SHARE * peak)) if peak > 0.0 else 1.0,
                periods=harmonic.periods,
            )
        )
        notices.extend(_rise_notice(record.name, end, values, step))
    notices.extend(_end_notices(record.name, found))
    return tuple(found), tuple(notices)


def _rise_notice(name: str, end: EndRecord, values: Array, step: float) -> list[Notice]:
    peak = float(values.max())
    # every rise from a tenth to nine tenths of the peak, in steps
    high = np.flatnonzero((values[1:] >= 0.9 * peak) & (values[:-1] < 0.9 * peak)) + 1
    low = np.flatnonzero(values <= 0.1 * peak)
    last = np.searchsorted(low, high) - 1
    rises = high[last >= 0] - low[last[last >= 0]]
    if peak <= 0.0 or rises.size == 0:
        return []
    rise = int(rises.min())
    if rise >= _LEAST_RISE:
        return []
    return [
        Notice(
            "cage-tension-sampling",
            f"run {name}: a peak of {end.line} {end.end} rises within {rise} steps of {1e3 * step:.3g} ms; "
            "the true peak may be higher",
            float(rise),
            float(_LEAST_RISE),
            "warning",
            "sample faster",
        )
    ]


def _end_notices(name: str, found: Sequence[EndTension]) -> list[Notice]:
    notices = []
    for line in sorted({end.line for end in found}):
        ends = [end for end in found if end.line == line]
        if len(ends) == 1:
            notices.append(
                Notice(
                    "cage-one-end",
                    f"run {name}: line {line} was measured at one end only, {ends[0].end}",
                    severity="information",
                    remedy="measure both ends to find the part of weight and drag of the line",
                )
            )
    return notices
