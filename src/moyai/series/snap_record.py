"""A snap in a record of cable tensions: release, taut instant, peak, plateau, rise time, impact = peak - plateau.

Arrays in, numbers out. A curtain (or any line) is held, let go, drifts while its tension rises slowly, becomes taut,
and the spike falls to a steady level. The peak is the top of a parabola through the samples about it, the taut instant
that of a slow line and a quarter sine fitted to the flank, the plateau a median.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from moyai.core.arrays import Array
from moyai.core.errors import InputError
from moyai.core.validity import Notice
from moyai.series.plateaus import find_plateaus

_FEWEST_IN_RISE = 5
# Peak above the noise below which no snap is distinguished from it
_LOUDEST_NOISE = 6.0
_PLATEAU_SHARE = 0.5
_SOURCE = "Sawaragi, Aoki and Liu (1991): the impact tension is the peak less the drag level"


@dataclass(frozen=True)
class CableSnap:
    """The snap of one cable, or of the sum."""

    #: Of the cable.
    name: str
    #: Largest tension above the unloaded level [N].
    peak: float
    #: When the tension is largest [s].
    peak_time: float
    #: Steady level after the spike [N].
    plateau: float
    #: Standard error of the plateau [N], from the scatter of blocks; that of the zero level there included.
    plateau_error: float
    #: Level that was taken off, at the first sample [N].
    offset: float
    #: Slope that was taken off [N/s].
    drift: float
    #: Standard deviation of the noise [N].
    noise: float

    @property
    def impact(self) -> float:
        """Peak above the plateau [N]."""
        return self.peak - self.plateau


@dataclass(frozen=True, eq=False)
class MeasuredSnap:
    """What a record says about a snap."""

    #: When the tension begins to rise [s]; NaN where noise hides it.
    release_time: float
    #: When the cables become taut [s].
    taut_time: float
    #: When the tension is largest [s].
    peak_time: float
    #: From when on the summed tension stays within a tenth of the impact of the plateau [s].
    plateau_start: float
    #: Of the sum of all cables.
    sum: CableSnap
    #: Each cable.
    cables: tuple[CableSnap, ...]
    #: [s].
    sampling_step: float
    #: Instants of the record [s]; shape (n,).
    time: Array
    #: Tensions without offset and drift [N]; shape (cables, n).
    tension: Array
    #: What makes the numbers doubtful.
    notices: tuple[Notice, ...]

    @property
    def rise_time(self) -> float:
        """From taut to peak [s]."""
        return self.peak_time - self.taut_time

    @property
    def samples_in_rise(self) -> float:
        """Rise time over the sampling step."""
        return self.rise_time / self.sampling_step

    @property
    def impact(self) -> float:
        """Peak of the sum above its plateau [N]."""
        return self.sum.impact

    @property
    def peak_lag(self) -> float:
        """Between the earliest and the latest peak of the cables [s]."""
        times = [cable.peak_time for cable in self.cables]
        return max(times) - min(times)


def sampling_loss(samples_in_rise: float) -> tuple[float, float]:
    """Return mean and largest share of a peak that sampling misses, of a spike like half a sine [eq:snap-sampling].

    Parameters
    ----------
    samples_in_rise : float
        Rise time over the sampling step.
    """
    if not samples_in_rise > 0.0:
        raise InputError(
            f"samples_in_rise is {samples_in_rise:g}", parameter="samples_in_rise", allowed="greater than 0"
        )
    turn = 0.25 * math.pi / samples_in_rise
    # the nearest sample lies evenly within half a step of the top
    return 1.0 - math.sin(min(turn, math.pi)) / min(turn, math.pi), 1.0 - math.cos(min(turn, 0.5 * math.pi))


def read_snap(
    time: ArrayLike,
    tension: ArrayLike,
    *,
    unloaded: Sequence[tuple[float, float]],
    names: Sequence[str] = (),
    release_time: float | None = None,
    window: tuple[float, float] | None = None,
) -> MeasuredSnap:
    """Find release, taut instant, peak, plateau and impact in a record.

    Parameters
    ----------
    time : array_like, shape (n,)
        Uniform [s].
    tension : array_like, shape (n,) or (cables, n)
        [N].
    unloaded : sequence of (float, float)
        Intervals [s] in which the cables have no tension: one gives the zero level, two or more (before and after the
        test) its drift as well.
    names : sequence of str, optional
        Of the cables.
    release_time : float, optional
        From a trigger [s]; found in the record by default.
    window : (float, float), optional
        Interval [s] in which the snap is sought; the whole record by default.

    Returns
    -------
    MeasuredSnap
        With notices for too few samples in the rise, noise, drift, and a plateau that is not level.

    Raises
    ------
    InputError
        For gaps, uneven times, an unloaded interval without samples, or a record without a snap.
    """
    t, values = _checked(time, tension)
    labels = tuple(names) or tuple(f"cable {i + 1}" for i in range(len(values)))
    if len(labels) != len(values):
        raise InputError(
            f"{len(labels)} names for {len(values)} cables", parameter="names", allowed="one for each cable"
        )
    quiet = _intervals(t, unloaded)
    fits = [_zero(t, row, quiet) for row in (*values, values.sum(axis=0))]
    levelled = np.array([row - offset - drift * (t - t[0]) for row, (offset, drift, _) in zip(values, fits)])
    total = levelled.sum(axis=0)
    noise = fits[-1][2]
    step = float(t[-1] - t[0]) / (t.size - 1)
    low, high = (t[0], t[-1]) if window is None else window
    inside = np.flatnonzero((t >= low) & (t <= high))
    if inside.size < 10:
        raise InputError(f"{inside.size} samples in the window", parameter="window", allowed="at least 10")
    largest = int(inside[np.argmax(total[inside])])
    if total[largest] < _LOUDEST_NOISE * noise or total[largest] <= 0.0:
        raise InputError(
            f"the largest tension, {total[largest]:.4g} N, does not exceed the noise of {noise:.3g} N",
            parameter="tension",
            allowed=f"above {_LOUDEST_NOISE:g} standard deviations",
            remedy="check the intervals called unloaded, and the sign of the gauge",
        )
    if largest + 10 > inside[-1] or largest < inside[0] + 5:
        raise InputError(
            "the peak lies at the end of the record",
            parameter="window",
            allowed="peak and plateau inside",
            remedy="widen it",
        )
    rough = _flank(total, largest)
    last = int(inside[-1])
    plateau, error, slope = _level(t, total, largest, last)
    # the level is that of the later half of what follows the peak
    when = float(t[last] - 0.5 * _PLATEAU_SHARE * (t[last] - t[largest]))
    zero_errors = [_zero_error(t, row, quiet, when) for row in (*values, values.sum(axis=0))]
    peak, peak_time = _top(t, total, largest, rough, noise)
    if plateau < -0.1 * peak - 4.0 * noise:
        raise InputError(
            f"the plateau of {plateau:.4g} N is negative, for a peak of {peak:.4g} N",
            parameter="tension",
            allowed="tensions positive",
            remedy="turn the sign of the gauge, check the unloaded intervals, or record on to the plateau",
        )
    taut = _taut(t, total, largest, peak_time, rough, inside[0])
    start = _plateau_start(t, total, largest, last, plateau, peak, noise)
    released = _release(t, total, taut, noise, inside[0]) if release_time is None else float(release_time)
    snaps = []
    for label, row, (offset, drift, own), zero_error in zip(labels, levelled, fits, zero_errors):
        near = slice(max(largest - rough, 0), largest + rough + 1)
        own_top = near.start + int(np.argmax(row[near]))
        own_peak, own_time = _top(t, row, own_top, rough, own)
        level, level_error, _ = _level(t, row, largest, last)
        level_error = math.hypot(level_error, zero_error)
        snaps.append(CableSnap(label, own_peak, own_time, level, level_error, offset, drift, own))
    offset, drift, _ = fits[-1]
    both = CableSnap("sum", peak, peak_time, plateau, math.hypot(error, zero_errors[-1]), offset, drift, noise)
    found = MeasuredSnap(released, taut, peak_time, start, both, tuple(snaps), step, t, levelled, ())
    notices = (*_saturated(snaps, values), *_check(found, slope, len(quiet), float(t[last])))
    return MeasuredSnap(released, taut, peak_time, start, both, tuple(snaps), step, t, levelled, notices)


def _checked(time: ArrayLike, tension: ArrayLike) -> tuple[Array, Array]:
    t = np.array(time, dtype=np.float64)
    values = np.atleast_2d(np.array(tension, dtype=np.float64))
    if t.ndim != 1 or t.size < 20 or values.ndim != 2 or values.shape[1] != t.size:
        raise InputError(
            f"times {t.shape} and tensions {values.shape}",
            parameter="tension",
            allowed="(n,) and (cables, n), n at least 20",
        )
    for name, array in (("time", t), ("tension", values)):
        bad = ~np.isfinite(array)
        if bad.any():
            place = int(np.argmax(bad.any(axis=0) if array.ndim == 2 else bad))
            raise InputError(
                f"sample {place + 1} of {name} is no number", parameter=name, remedy="fill or cut gaps before"
            )
    steps = np.diff(t)
    mean = float(steps.mean())
    if not (mean > 0.0 and float(np.abs(steps - mean).max()) < 0.01 * mean):
        raise InputError("times are not uniform", parameter="time", allowed="equal steps", remedy="resample the record")
    return t, values


def _intervals(t: Array, unloaded: Sequence[tuple[float, float]]) -> list[NDArray[np.intp]]:
    if not unloaded:
        raise InputError("no unloaded interval", parameter="unloaded", allowed="one at least: it gives the zero level")
    found = []
    for low, high in unloaded:
        chosen = np.flatnonzero((t >= low) & (t <= high))
        if chosen.size < 5:
            raise InputError(
                f"{chosen.size} samples between {low:g} and {high:g} s", parameter="unloaded", allowed="at least 5"
            )
        found.append(chosen)
    return found


def _zero(t: Array, row: Array, quiet: list[NDArray[np.intp]]) -> tuple[float, float, float]:
    """Return level at the first sample, slope, and the deviation of the noise."""
    chosen = np.concatenate(quiet)
    since = t[chosen] - t[0]
    drift = float(np.polyfit(since, row[chosen], 1)[0]) if len(quiet) > 1 else 0.0
    left = row[chosen] - drift * since
    offset = float(np.median(left))
    # 1.4826 times the median deviation: a stray spike does not count
    return offset, drift, 1.4826 * float(np.median(np.abs(left - offset)))


def _zero_error(t: Array, row: Array, quiet: list[NDArray[np.intp]], when: float) -> float:
    """Return the standard error of the zero level at a time, from the scatter of blocks [eq:snap-zero-error]."""
    sizes = [max(2, round(10 * chosen.size / sum(one.size for one in quiet))) for chosen in quiet]
    pieces = [piece for chosen, size in zip(quiet, sizes) for piece in np.array_split(chosen, size)]
    middle = np.array([t[piece].mean() for piece in pieces])
    level = np.array([np.median(row[piece]) for piece in pieces])
    shape = np.stack([np.ones_like(middle), middle - when], axis=1)[:, : 1 if len(quiet) == 1 else 2]
    left = level - shape @ np.linalg.lstsq(shape, level, rcond=None)[0]
    variance = float(left @ left) / max(level.size - shape.shape[1], 1)
    return math.sqrt(variance * float(np.linalg.inv(shape.T @ shape)[0, 0]))


def _flank(total: Array, largest: int) -> int:
    """Return how many samples before the peak the tension passes half of it, at least one."""
    below = np.flatnonzero(total[:largest] < 0.5 * total[largest])
    return max(1, largest - int(below[-1])) if below.size else max(1, largest)


def _top(t: Array, row: Array, largest: int, rough: int, noise: float) -> tuple[float, float]:
    """Return top and time of a parabola through the samples about the peak.

    From half height to the top a sine takes two thirds of its rise; the parabola spans a third of the rise to each
    side where noise requires it, and three samples otherwise.
    """
    reach = 1 if noise < 1e-3 * row[largest] else max(1, round(0.45 * rough))
    reach = min(reach, largest, len(row) - 1 - largest)
    if reach < 1:
        return float(row[largest]), float(t[largest])
    near = slice(largest - reach, largest + reach + 1)
    step = float(t[1] - t[0])
    x = (t[near] - t[largest]) / step
    a, b, c = np.polyfit(x, row[near], 2)
    if a >= 0.0 or abs(0.5 * b / a) > reach:
        return float(row[largest]), float(t[largest])
    place = -0.5 * b / a
    return float(c + 0.5 * b * place), float(t[largest] + place * step)


def _level(t: Array, row: Array, largest: int, last: int) -> tuple[float, float, float]:
    """Return plateau, its standard error and its slope, from the later half of what follows the peak."""
    begin = largest + int((last - largest) * (1.0 - _PLATEAU_SHARE))
    part, when = row[begin : last + 1], t[begin : last + 1]
    blocks = [float(np.median(piece)) for piece in np.array_split(part, min(10, max(2, part.size // 5)))]
    slope = float(np.polyfit(when - when[0], part, 1)[0])
    return float(np.median(part)), float(np.std(blocks, ddof=1) / math.sqrt(len(blocks))), slope


def _taut(t: Array, total: Array, largest: int, peak_time: float, rough: int, first: int) -> float:
    """Return the taut instant: a slow line before it, a quarter sine from it to the peak, least squares."""
    from scipy.optimize import minimize_scalar

    # half height to top is two thirds of a quarter sine; as much again and more stands before it
    begin = max(int(first), largest - 6 * rough - 6)
    chosen = slice(begin, largest + 1)
    when, row = t[chosen], total[chosen]

    def misfit(start: float) -> float:
        swing = np.sin(0.5 * math.pi * np.clip((when - start) / (peak_time - start), 0.0, 1.0))
        slow = np.minimum(when - start, 0.0)
        table = np.stack([np.ones_like(when), slow, swing], axis=1)
        answer = np.linalg.lstsq(table, row, rcond=None)[0]
        return float(np.sum((table @ answer - row) ** 2))

    step = float(t[1] - t[0])
    trial = np.linspace(float(when[0]) + step, peak_time - 0.5 * step, 120)
    best = int(np.argmin([misfit(float(start)) for start in trial]))
    low, high = float(trial[max(best - 1, 0)]), float(trial[min(best + 1, trial.size - 1)])
    return float(minimize_scalar(misfit, bounds=(low, high), method="bounded", options={"xatol": 1e-4 * step}).x)


def _plateau_start(t: Array, total: Array, largest: int, last: int, plateau: float, peak: float, noise: float) -> float:
    """Return when the tension enters for good the band of a tenth of the impact about the plateau."""
    band = max(0.1 * (peak - plateau), 4.0 * noise)
    outside = np.flatnonzero(np.abs(total[largest : last + 1] - plateau) > band)
    return float(t[min(largest + int(outside[-1]) + 1, last)])


def _release(t: Array, total: Array, taut: float, noise: float, first: int) -> float:
    """Return where the slow rise begins: nothing before it, a line or a parabola after, least squares."""
    chosen = slice(int(first), int(np.searchsorted(t, taut)))
    when, row = t[chosen], total[chosen]
    if when.size < 10 or float(np.mean(row[-max(3, when.size // 20) :])) < 3.0 * noise:
        return math.nan
    best = (math.inf, math.nan)
    # a coarse grid, then a fine one about its best
    for low, high in ((float(when[0]), float(when[-3])), (0.0, 0.0)):
        if high == low:
            width = (float(when[-3]) - float(when[0])) / 60.0
            low, high = best[1] - width, best[1] + width
        for start in np.linspace(low, high, 61):
            since = np.maximum(when - start, 0.0)
            for power in (1, 2):
                shape = since**power
                total_square = float(shape @ shape)
                if total_square == 0.0:
                    continue
                misfit = float(np.sum((row - shape * float(shape @ row) / total_square) ** 2))
                if misfit < best[0]:
                    best = (misfit, float(start))
    return best[1]


def _saturated(snaps: Sequence[CableSnap], values: Array) -> list[Notice]:
    """Return a notice of each load cell that stands at its highest value."""
    tops = ((snap.name, plateau) for snap, row in zip(snaps, values) for plateau in find_plateaus(row) if plateau.top)
    return [
        Notice(
            "snap-saturated",
            f"{name}: {plateau.longest} samples in a row stand at the highest value, {plateau.level:.4g} N: the peak "
            "may be higher",
            float(plateau.longest),
            remedy="use a load cell or an amplifier of a wider range",
            source="samples at the extreme of a smooth record",
        )
        for name, plateau in tops
    ]


def _check(found: MeasuredSnap, slope: float, intervals: int, end: float) -> tuple[Notice, ...]:
    notices = []
    total = found.sum
    samples = found.samples_in_rise
    if samples < _FEWEST_IN_RISE:
        mean, worst = sampling_loss(samples)
        notices.append(
            Notice(
                "snap-sampling",
                f"{samples:.2g} samples in the rise: the sampled peak is {100.0 * mean:.2g} % too low on the average, "
                f"{100.0 * worst:.2g} % at worst",
                samples,
                float(_FEWEST_IN_RISE),
                remedy=f"sample faster than {_FEWEST_IN_RISE / found.rise_time:.4g} Hz",
                source="half a sine sampled at random",
            )
        )
    if total.noise > 0.05 * total.impact:
        notices.append(
            Notice(
                "snap-noise",
                f"The noise is {100.0 * total.noise / total.impact:.2g} % of the impact",
                total.noise / total.impact,
                0.05,
                remedy="filter with a corner far above the rise, or use a stiffer gauge",
                source=_SOURCE,
            )
        )
    length = end - found.peak_time
    if abs(slope) * 0.5 * length > 0.1 * abs(total.impact) + 4.0 * total.noise:
        notices.append(
            Notice(
                "snap-plateau",
                f"The plateau changes by {slope * 0.5 * length:.3g} N over its length",
                slope * 0.5 * length,
                0.1 * total.impact,
                remedy="record longer, or give two unloaded intervals where the gauge drifts",
                source=_SOURCE,
            )
        )
    if abs(total.drift) * (end - found.time[0]) > 0.02 * total.peak:
        notices.append(
            Notice(
                "snap-drift",
                f"The zero drifts by {total.drift * (end - found.time[0]):.3g} N over the record; taken off as a line",
                total.drift * (end - found.time[0]),
                0.02 * total.peak,
                severity="information",
                remedy="check the gauges",
                source="unloaded intervals",
            )
        )
    elif intervals == 1:
        notices.append(
            Notice(
                "snap-zero",
                "One unloaded interval gives the zero level; a drift of the gauge would pass for tension",
                severity="information",
                remedy="give an unloaded interval after the test as well",
                source="unloaded intervals",
            )
        )
    if math.isnan(found.release_time):
        notices.append(
            Notice(
                "snap-release",
                "The release is not detected: the slow rise does not exceed the noise",
                severity="information",
                remedy="give release_time from a trigger",
                source="three standard deviations",
            )
        )
    if found.plateau_start >= end - found.sampling_step:
        notices.append(
            Notice(
                "snap-short",
                "The record ends before the tension settles: the plateau is a guess",
                found.plateau_start,
                end,
                remedy="record longer",
                source=_SOURCE,
            )
        )
    return tuple(notices)
