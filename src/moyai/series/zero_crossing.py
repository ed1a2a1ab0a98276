"""Individual waves of a series by zero crossing: of records with every choice explicit, of simulations in one call."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from moyai.core.arrays import Array
from moyai.core.compiled import njit
from moyai.core.errors import InputError
from moyai.core.options import check_kind, checks_words
from moyai.core.validity import Notice
from moyai.core.wording import counted
from moyai.series.detrend import Detrend, detrended

Rounding = Literal["nearest", "down", "up"]


@checks_words
@dataclass(frozen=True)
class WaveOptions:
    """How a record is cut into waves.

    Examples
    --------
    >>> from moyai.series.zero_crossing import WaveOptions
    >>> options = WaveOptions(crossing="down", dead_band=0.02)
    >>> options.crossing, options.crest
    ('down', 'parabola')
    """

    #: A wave begins where the surface rises, or falls, through the mean level.
    crossing: Literal["up", "down"] = "up"
    #: What is taken off before.
    detrend: Detrend = field(default_factory=Detrend)
    #: A crossing counts when the surface has been so far below the level and then rises so far above it [unit of the
    #: record]; 0 counts every crossing.
    dead_band: float = 0.0
    #: The highest sample, or the top of the parabola through it and its neighbours.
    crest: Literal["sample", "parabola"] = "parabola"
    #: How N/3 and N/10 are rounded to whole waves (at least one); one of "nearest", "down", "up".
    share: Rounding = "nearest"
    #: Waves with shorter periods are left out of the statistics [s].
    shortest: float = 0.0
    #: Waves with longer periods are left out of the statistics [s].
    longest: float = math.inf

    def __post_init__(self) -> None:
        if not self.dead_band >= 0.0:
            raise InputError(f"dead band {self.dead_band:g}", parameter="dead_band", allowed="at least 0")
        if not 0.0 <= self.shortest < self.longest:
            raise InputError(
                f"periods {self.shortest:g} to {self.longest:g} s",
                parameter="shortest",
                allowed="0 <= shortest < longest",
            )


@dataclass(frozen=True, eq=False)
class Waves:
    """Waves of a record."""

    #: Opening crossing [s].
    start: Array
    #: Duration [s].
    period: Array
    #: Height [unit of the record].
    height: Array
    #: Highest value about the level [unit of the record].
    crest: Array
    #: Lowest value about the level, negative [unit of the record].
    trough: Array
    options: WaveOptions
    notices: tuple[Notice, ...] = ()

    def __len__(self) -> int:
        return int(self.height.size)

    def highest(self, fraction: float) -> tuple[float, float]:
        """Return mean height and mean period [s] of the highest ``fraction`` of the waves.

        Parameters
        ----------
        fraction : float
            Of the number of waves, for instance 1/3 [-].

        Returns
        -------
        (float, float)
            In the unit of the record, and [s]; NaN without waves.
        """
        if len(self) == 0:
            return math.nan, math.nan
        number = share_of(len(self), fraction, self.options.share)
        order = np.argsort(-self.height, kind="stable")[:number]
        return float(self.height[order].mean()), float(self.period[order].mean())

    @property
    def end(self) -> Array:
        """Closing crossing of each wave [s]."""
        return self.start + self.period

    def significant_height(self) -> float:
        """Return the mean height of the highest third; NaN where there is no wave."""
        return self.highest(1.0 / 3.0)[0]

    def significant_period(self) -> float:
        """Return the mean period of the waves with the highest third of heights [s]; NaN where there is no wave."""
        return self.highest(1.0 / 3.0)[1]

    def statistics(self) -> dict[str, float]:
        """Return the usual statistics; NaN where there is no wave.

        Returns
        -------
        dict
            ``count``, ``maximum_height``, ``maximum_period``, ``tenth_height`` (H1/10), ``tenth_period``,
            ``third_height`` (H1/3), ``third_period`` (T1/3), ``mean_height``, ``mean_period``, ``rms_height``,
            ``maximum_crest``, ``minimum_trough``.
        """
        if len(self) == 0:
            return {"count": 0.0, **dict.fromkeys(STATISTICS[1:], math.nan)}
        top = int(np.argmax(self.height))
        tenth, third = self.highest(0.1), self.highest(1.0 / 3.0)
        values = (
            float(len(self)),
            float(self.height[top]),
            float(self.period[top]),
            *tenth,
            *third,
            float(self.height.mean()),
            float(self.period.mean()),
            math.sqrt(float(np.mean(self.height**2))),
            float(self.crest.max()),
            float(self.trough.min()),
        )
        return dict(zip(STATISTICS, values))


STATISTICS = (
    "count",
    "maximum_height",
    "maximum_period",
    "tenth_height",
    "tenth_period",
    "third_height",
    "third_period",
    "mean_height",
    "mean_period",
    "rms_height",
    "maximum_crest",
    "minimum_trough",
)


@checks_words
def share_of(count: int, fraction: float, rounding: Rounding = "nearest") -> int:
    """Return how many of ``count`` waves make up ``fraction``: at least one.

    Parameters
    ----------
    count : int
    fraction : float
        For instance 1/3.
    rounding : {"nearest", "down", "up"}
        Halves are rounded up by ``nearest``.
    """
    exact = count * fraction
    if rounding == "down":
        number = math.floor(exact + 1e-9)
    elif rounding == "up":
        number = math.ceil(exact - 1e-9)
    else:
        number = math.floor(exact + 0.5 + 1e-9)
    return max(number, 1)


@njit(cache=True, error_model="numpy")
def _find_waves(values: Array, times: Array, band: float, parabola: bool, gap: float, out: Array) -> int:
    """Fill ``out[:, wave]`` with start, period, crest, trough; return the number of waves.

    A NaN, and a step longer than ``gap``, end the present wave without counting it.
    """
    count = 0
    open_wave = False
    armed = False  # the surface has been below the dead band
    pending = False  # it has crossed upwards and is not yet above the band
    start = crossing = crest = trough = next_crest = 0.0
    for i in range(values.size):
        now = values[i]
        if np.isnan(now) or (i > 0 and times[i] - times[i - 1] > gap):
            open_wave = armed = pending = False
            if np.isnan(now):
                continue
        peak = now
        inner = 0 < i < values.size - 1
        if parabola and inner and times[i] - times[i - 1] <= gap and times[i + 1] - times[i] <= gap:
            left, right = values[i - 1], values[i + 1]
            if (now >= left and now > right) or (now <= left and now < right):
                bend = left - 2.0 * now + right
                if bend != 0.0:
                    peak = now - (right - left) ** 2 / (8.0 * bend)
        if i > 0 and values[i - 1] < 0.0 <= now and armed:
            # The last upward crossing before the surface leaves the band is the one that counts
            if pending:
                crest = max(crest, next_crest)
            crossing = times[i - 1] + (times[i] - times[i - 1]) * (-values[i - 1] / (now - values[i - 1]))
            pending = True
            next_crest = 0.0
        if pending and now < -band:
            pending = False
            crest = max(crest, next_crest)
        if pending and now >= band:
            if open_wave:
                out[0, count], out[1, count] = start, crossing - start
                out[2, count], out[3, count] = crest, trough
                count += 1
            open_wave = True
            pending = armed = False
            start, crest, trough = crossing, next_crest, 0.0
        if pending:
            next_crest = max(next_crest, peak)
            trough = min(trough, peak)
        else:
            crest, trough = max(crest, peak), min(trough, peak)
        if now < -band:
            armed = True
    return count


def find_waves(time: ArrayLike, values: ArrayLike, options: WaveOptions, *, gap: float | None = None) -> Waves:
    """Cut a record into waves.

    Waves that touch a missing sample (NaN) or a gap of the clock are left out and counted in a notice; crossings are
    interpolated linearly.

    Parameters
    ----------
    time : array_like
        Increasing instants [s], evenly stepped but for gaps.
    values : array_like
        Surface elevation or any other oscillating quantity; NaN where missing.
    options : WaveOptions
        Crossing, detrending, dead band, shortest and longest wave.
    gap : float, optional
        Longer steps are gaps [s]; 1.5 median steps by default.

    Returns
    -------
    Waves
        Start [s], period [s], height, crest and trough (unit of ``values``) of each wave, and notices.

    Raises
    ------
    InputError
        Lengths that differ, instants that do not increase, fewer than three samples, or none that is a number.

    Examples
    --------
    >>> import numpy as np
    >>> from moyai.series import find_waves
    >>> from moyai.series.zero_crossing import WaveOptions
    >>> time = np.arange(0.0, 61.0, 0.1)
    >>> waves = find_waves(time, 0.5 * np.sin(2.0 * np.pi / 6.0 * (time - 1.0)), WaveOptions())
    >>> len(waves), waves.height.round(2).max().item(), waves.period.round(2).max().item()   # [m], [s]
    (9, 1.0, 6.0)
    """
    check_kind(options, WaveOptions, "options", "give WaveOptions(crossing=...)")
    t = np.ascontiguousarray(time, dtype=np.float64)
    v = np.ascontiguousarray(values, dtype=np.float64)
    if t.ndim != 1 or t.shape != v.shape:
        raise InputError(f"{v.shape} values for {t.shape} instants", parameter="values", allowed="equal, 1-D")
    if t.size < 3 or np.count_nonzero(np.isfinite(v)) < 3:
        raise InputError(f"{np.count_nonzero(np.isfinite(v))} samples are no record of waves", parameter="values")
    if not np.all(np.diff(t) > 0.0):
        raise InputError("the instants must increase", parameter="time")
    step = float(np.median(np.diff(t)))
    level = detrended(t, v, options.detrend)
    if options.crossing == "down":
        level = -level
    origin = t[0]  # dates are large numbers: crossings keep their digits as differences
    out = np.empty((4, t.size))
    limit = 1.5 * step if gap is None else gap
    count = _find_waves(level, t - origin, float(options.dead_band), options.crest == "parabola", limit, out)
    start, period, crest, trough = (out[row, :count].copy() for row in range(4))
    if options.crossing == "down":
        crest, trough = -trough, -crest
    kept = (period >= options.shortest) & (period <= options.longest)
    notices = _notices(v, t, kept, count, limit, options)
    return Waves(
        start[kept] + origin,
        period[kept],
        (crest - trough)[kept],
        crest[kept],
        trough[kept],
        options,
        notices,
    )


def _notices(
    values: Array, time: Array, kept: NDArray[np.bool_], count: int, gap: float, options: WaveOptions
) -> tuple[Notice, ...]:
    notices = []
    missing = int(np.count_nonzero(~np.isfinite(values)))
    broken = int(np.count_nonzero(np.diff(time) > gap))
    if missing or broken:
        message = (
            f"missing: {counted(missing, 'sample')}"
            + (f" and {broken} stretch{'es' if broken > 1 else ''} of the clock" if broken else "")
            + "; waves that touch them are left out"
        )
        notices.append(Notice("waves-broken", message, float(missing + broken), 0.0))
    dropped = count - int(kept.sum())
    if dropped:
        notices.append(
            Notice(
                "waves-periods",
                f"{counted(dropped, 'wave')} outside {options.shortest:g} to {options.longest:g} s left out",
                float(dropped),
                0.0,
                severity="information",
            )
        )
    if kept.sum() < 50:
        notices.append(
            Notice(
                "few-waves",
                f"only {counted(int(kept.sum()), 'wave')} in the block: statistics of so few are uncertain",
                float(kept.sum()),
                50.0,
            )
        )
    return tuple(notices)


@checks_words
def split_waves(
    time: ArrayLike, values: ArrayLike, *, mean_level: float | None = None, parabolic: bool = False
) -> Waves:
    """Split a series without gaps, such as a simulated one, into the waves between its up-crossings.

    Parts before the first and after the last crossing are left out; crossings are interpolated linearly.

    Parameters
    ----------
    time : array_like
        Times [s], increasing (uniform for ``parabolic``).
    values : array_like
        The series, of any unit.
    mean_level : float, optional
        Level whose crossings count; by default the mean of the series.
    parabolic : bool
        Refine crests and troughs by a parabola through three samples.

    Returns
    -------
    Waves
        Start, period, height, crest and trough of every wave, arrays (n,).

    Raises
    ------
    InputError
        When lengths differ, times do not increase, or a value is NaN.

    Examples
    --------
    >>> import numpy as np
    >>> from moyai.series import split_waves
    >>> time = np.arange(0.0, 30.0, 0.01)
    >>> waves = split_waves(time, 0.5 * np.sin(2.0 * np.pi * (time - 1.0) / 5.0), mean_level=0.0)
    >>> waves.height.round(3).tolist(), waves.period.round(3).tolist()
    ([1.0, 1.0, 1.0, 1.0, 1.0], [5.0, 5.0, 5.0, 5.0, 5.0])
    """
    t = np.ascontiguousarray(time, dtype=np.float64)
    v = np.ascontiguousarray(values, dtype=np.float64)
    if t.ndim != 1 or t.shape != v.shape or t.size < 2:
        raise InputError(
            f"series of shape {v.shape} over times of shape {t.shape}", parameter="values", allowed="equal, 1-D"
        )
    for name, array in (("time", t), ("values", v)):
        if not np.isfinite(array).all():
            place = int(np.argmin(np.isfinite(array)))
            raise InputError(f"{name}[{place}] is not a number", parameter=name, remedy="fill or cut gaps before")
    if (np.diff(t) <= 0.0).any():
        raise InputError("times do not increase", parameter="time", allowed="strictly increasing")
    level = float(np.mean(v)) if mean_level is None else float(mean_level)
    out = np.empty((4, t.size))
    count = _find_waves(v - level, t, 0.0, parabolic, math.inf, out)
    start, period, crest, trough = (out[row, :count].copy() for row in range(4))
    options = WaveOptions(
        detrend=Detrend("mean" if mean_level is None else "none"), crest="parabola" if parabolic else "sample"
    )
    return Waves(start, period, crest - trough, crest, trough, options)
