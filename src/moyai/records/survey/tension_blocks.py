"""The chain of Tabata et al. over a record of waves, current and tensions: blocks of 20 minutes, one row for each.

Tension = steady + fluctuating, the largest fluctuation in the time of each single wave, sorted into T_max, T_1/10,
T_1/3 and T_mean. Arrays in, numbers out.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from moyai.core.arrays import Array
from moyai.core.errors import InputError
from moyai.core.options import checks_words
from moyai.core.progress import Progress, silent
from moyai.core.validity import Notice
from moyai.records.survey.tensions import SteadyRule, find_delay, split_tension, tension_statistics, wave_maxima
from moyai.series.zero_crossing import Waves, split_waves

_SOURCE = "Tabata et al., field observation of mooring forces of a new-type silt curtain"
# Rise of a snap: what a logger must resolve
_SLOWEST_RATE = 10.0


@dataclass(frozen=True, eq=False)
class SingleWaves:
    """Every wave of a campaign with the tension in its time; rows are waves."""

    #: Row of :class:`Blocks` that the wave belongs to.
    block: NDArray[np.int64]
    #: Own height [m].
    height: Array
    #: Own period [s].
    period: Array
    #: Largest fluctuating tension, between the samples [N]; NaN where there is none; shape (waves, lines).
    top: Array


@dataclass(frozen=True, eq=False)
class Blocks:
    """Waves, current and tensions of all blocks of a campaign; rows are blocks."""

    #: Of each block [s].
    start: Array
    #: H_max [m].
    maximum_height: Array
    #: H_1/3 [m].
    significant_height: Array
    #: T_1/3 [s].
    significant_period: Array
    #: Waves.
    wave_count: Array
    #: Of the waves from the normal of the curtain [rad], folded to 0 .. pi/2; NaN where not given.
    angle: Array
    #: Mean component of the current along the normal [m/s]; NaN where not given.
    current_normal: Array
    #: Mean of the steady part [N]; shape (blocks, lines).
    steady: Array
    #: Largest of the fluctuating maxima [N]; shape (blocks, lines).
    maximum: Array
    #: Mean of the highest tenth [N]; shape (blocks, lines).
    tenth: Array
    #: Mean of the highest third [N]; shape (blocks, lines).
    third: Array
    #: Mean of all of them [N]; shape (blocks, lines).
    mean: Array
    #: Waves with a maximum; shape (blocks, lines).
    matched: Array
    #: Waves with a double peak; shape (blocks, lines).
    double: Array
    #: [s]; shape (blocks, lines).
    delay: Array
    #: Root mean square of the samples below the steady level about it [N]: pulls only add, so what lies below is noise
    #: of the gauge and slow motion; shape (blocks, lines).
    noise: Array
    waves: SingleWaves
    #: How tensions were split.
    steady_rule: str
    #: What makes the numbers doubtful.
    notices: tuple[Notice, ...]

    def __len__(self) -> int:
        return int(self.start.size)

    @checks_words
    def averaged(self, name: Literal["steady", "maximum", "tenth", "third", "mean"]) -> Array:
        """Return a column averaged over the lines, as the paper averages its two anchors [N]."""
        return np.asarray(getattr(self, name).mean(axis=1))


@checks_words
def analyse_blocks(
    time: ArrayLike,
    elevation: ArrayLike,
    tension: ArrayLike,
    *,
    block: float = 1200.0,
    rule: SteadyRule = "median",
    cutoff: float = 30.0,
    wave_heading: ArrayLike | None = None,
    current: ArrayLike | None = None,
    normal_heading: float = 0.0,
    longest_delay: float | None = None,
    least_waves: int = 20,
    progress: Progress = silent,
) -> Blocks:
    """Run the whole chain over a record.

    Parameters
    ----------
    time : array_like, shape (n,)
        Uniform [s].
    elevation : array_like, shape (n,)
        [m].
    tension : array_like, shape (n,) or (lines, n)
        [N].
    block : float
        Length of a block [s], 20 minutes in the paper; what is left over at the end is dropped.
    rule, cutoff
        See :func:`split_tension`.
    wave_heading : array_like, optional
        Mean direction in which the waves travel [rad], a number, one for each sample, or one for each block.
    current : array_like, shape (n, 2), optional
        Current along x and y [m/s].
    normal_heading : float
        Direction of the curtain's normal [rad].
    longest_delay : float, optional
        Bound of the delay between waves and tension [s]; none is sought by default.
    least_waves : int
        Blocks with fewer waves are left out.
    progress : Progress
        Called after each block.

    Raises
    ------
    InputError
        When times are uneven, a block does not fit, or lists differ in length.
    """
    t, eta, lines, step = _checked(time, elevation, tension)
    size = round(block / step)
    if not 10 <= size <= t.size:
        raise InputError(
            f"blocks of {block:g} s in a record of {t.size * step:g} s",
            parameter="block",
            allowed=f"{10 * step:g} to {t.size * step:g} s",
        )
    number = t.size // size
    heading = _per_block(wave_heading, t.size, size, number)
    flow = None if current is None else np.asarray(current, dtype=np.float64)
    if flow is not None and flow.shape != (t.size, 2):
        raise InputError(f"current has shape {flow.shape}", parameter="current", allowed=f"({t.size}, 2)")
    rows: list[tuple[float, ...]] = []
    columns: list[Array] = []
    single: list[Array] = []
    lost = 0
    for k in range(number):
        part = slice(k * size, (k + 1) * size)
        progress("blocks", k, number)
        if not (np.isfinite(eta[part]).all() and np.isfinite(lines[:, part]).all()):
            lost += 1
            continue
        cycles = split_waves(t[part], eta[part], parabolic=True)
        if len(cycles) < least_waves:
            lost += 1
            continue
        normal = math.nan
        if flow is not None:
            drift = flow[part].mean(axis=0)
            normal = float(drift[0] * math.cos(normal_heading) + drift[1] * math.sin(normal_heading))
        rows.append(
            (
                float(t[part][0]),
                float(cycles.height.max()),
                cycles.significant_height(),
                cycles.significant_period(),
                float(len(cycles)),
                _folded(heading(k) - normal_heading),
                normal,
            )
        )
        found = [_line(t[part], eta[part], row[part], cycles, rule, cutoff, longest_delay) for row in lines]
        columns.append(np.array([numbers for numbers, _ in found]))
        own = np.full(len(cycles), float(len(rows) - 1))
        single.append(np.column_stack([own, cycles.height, cycles.period, *(tops for _, tops in found)]))
    progress("blocks", number, number)
    if not rows:
        raise InputError(
            f"no block of {block:g} s is left of {number}: gaps, or fewer than {least_waves} waves each",
            parameter="block",
            allowed="blocks without gaps and with waves enough",
            remedy="fill short gaps before, or take longer blocks",
        )
    table = np.array(rows).reshape(-1, 7)
    values = np.array(columns).reshape(len(rows), len(lines), 9)
    start, highest, significant_height, period, count, angle, across = table.T.copy()
    steady, maximum, tenth, high, mean, matched, double, delay, noise = np.moveaxis(values, 2, 0).copy()
    waves = np.concatenate(single)
    return Blocks(
        start,
        highest,
        significant_height,
        period,
        count,
        angle,
        across,
        steady,
        maximum,
        tenth,
        high,
        mean,
        matched,
        double,
        delay,
        noise,
        SingleWaves(waves[:, 0].astype(np.int64), waves[:, 1].copy(), waves[:, 2].copy(), waves[:, 3:].copy()),
        rule,
        _check_blocks(values, lost, number, step),
    )


def _line(
    t: Array, eta: Array, row: Array, cycles: Waves, rule: SteadyRule, cutoff: float, longest: float | None
) -> tuple[tuple[float, ...], Array]:
    """Return steady, maximum, tenth, third, mean, matched, double, delay, noise of a line; the top of each wave."""
    split = split_tension(t, row, rule, cutoff=cutoff)
    delay = 0.0
    if longest is not None and np.ptp(split.fluctuating) > 0.0:
        delay = find_delay(t, eta, split.fluctuating, longest=longest)
    found = wave_maxima(t, split.fluctuating, cycles.start, cycles.period, delay=delay)
    numbers = tension_statistics(found.maximum)
    below = split.fluctuating[split.fluctuating < 0.0]
    values = (
        split.level,
        numbers.maximum,
        numbers.tenth,
        numbers.third,
        numbers.mean,
        float(found.matched),
        float(found.double.sum()),
        delay,
        float(np.sqrt(np.mean(below**2))) if below.size else 0.0,
    )
    return values, found.top


def _checked(time: ArrayLike, elevation: ArrayLike, tension: ArrayLike) -> tuple[Array, Array, Array, float]:
    t, eta = np.asarray(time, dtype=np.float64), np.asarray(elevation, dtype=np.float64)
    lines = np.atleast_2d(np.asarray(tension, dtype=np.float64))
    if t.ndim != 1 or t.size < 20 or eta.shape != t.shape or lines.ndim != 2 or lines.shape[1] != t.size:
        raise InputError(
            f"times {t.shape}, elevations {eta.shape}, tensions {lines.shape}",
            parameter="tension",
            allowed="(n,), (n,) and (lines, n), n at least 20",
        )
    steps = np.diff(t)
    step = float(steps.mean())
    if not (step > 0.0 and float(np.abs(steps - step).max()) < 0.01 * step):
        raise InputError("times are not uniform", parameter="time", allowed="equal steps", remedy="resample the record")
    return t, eta, lines, step


def _per_block(value: ArrayLike | None, samples: int, size: int, number: int) -> Callable[[int], float]:
    if value is None:
        return lambda _k: math.nan
    given = np.asarray(value, dtype=np.float64).reshape(-1)
    if given.size == 1:
        return lambda _k: float(given[0])
    if given.size == number:
        return lambda k: float(given[k])
    if given.size != samples:
        raise InputError(
            f"{given.size} headings", parameter="wave_heading", allowed=f"1, {number} (blocks) or {samples} (samples)"
        )

    def mean(k: int) -> float:
        part = given[k * size : (k + 1) * size]
        return math.atan2(float(np.sin(part).mean()), float(np.cos(part).mean()))

    return mean


def _folded(angle: float) -> float:
    """Return the angle between a line and the normal, 0 .. pi/2: waves from behind count as from the front."""
    return math.nan if math.isnan(angle) else math.acos(min(1.0, abs(math.cos(angle))))


def _check_blocks(values: Array, lost: int, number: int, step: float) -> tuple[Notice, ...]:
    notices = []
    if lost:
        notices.append(
            Notice(
                "tensions-lost",
                f"{lost} of {number} blocks are left out: gaps or too few waves",
                float(lost),
                0.0,
                severity="information",
                remedy="fill short gaps before",
                source=_SOURCE,
            )
        )
    if 1.0 / step < _SLOWEST_RATE * (1.0 - 1e-9):
        notices.append(
            Notice(
                "tensions-sampling",
                f"{1.0 / step:.3g} samples a second do not resolve snaps, which rise in 0.01 to 0.1 s: their peaks are "
                "cut",
                1.0 / step,
                _SLOWEST_RATE,
                remedy="record tensions at 100 Hz, or read maxima as lower bounds",
                source="half a sine sampled at random",
            )
        )
    if len(values):
        share = float(values[:, :, 6].sum() / max(values[:, :, 5].sum(), 1.0))
        if share > 0.2:
            notices.append(
                Notice(
                    "tensions-double",
                    f"{100.0 * share:.3g} % of the waves have two peaks of tension; one maximum is kept for each",
                    share,
                    0.2,
                    severity="information",
                    remedy="look at a piece of the record: bounces of a taut line, or waves cut in two",
                    source=_SOURCE,
                )
            )
    return tuple(notices)
