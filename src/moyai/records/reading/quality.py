"""Quality control: gaps, spikes, flat lines, clipping, drift, unit slips - found, flagged, reported, never filled.

Every limit is an option with its meaning next to it. Spikes are off where a channel may jump by nature (a snap load is
no fault).
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from moyai.core.arrays import Array
from moyai.core.compiled import njit
from moyai.core.errors import InputError
from moyai.core.validity import Notice
from moyai.core.wording import counted
from moyai.records.reading import record as bits
from moyai.records.reading.record import Record, instant_text


@dataclass(frozen=True)
class QualityOptions:
    """Limits of the quality control of one channel."""

    #: A time step longer than so many usual steps is a gap.
    gap_steps: float = 1.5
    #: A sample that differs from the median of its neighbourhood by more than so many robust standard deviations of
    #: these differences is a spike; infinite looks for none [eq:records-spike].
    spike_scale: float = 8.0
    #: Longest spike [samples]; the neighbourhood holds twice as many plus one, at least five.
    spike_samples: int = 2
    #: Smaller differences are none [unit of the channel].
    spike_least: float = 0.0
    #: Identical values for longer are a flat line [s]; infinite looks for none.
    flat_seconds: float = 10.0
    #: So many identical values in a row at the highest or lowest value of the block, met at least twice there, are
    #: clipped; 0 looks for none.
    clip_samples: int = 3
    #: Look for clipping at the lowest value too; not where a channel rests there by nature (a slack line).
    clip_lowest: bool = True
    #: Lower end of the instrument's range [unit of the channel].
    lowest: float = -math.inf
    #: Upper end of it [unit of the channel].
    highest: float = math.inf
    #: A trend of the block means over the record, beyond its own uncertainty, that exceeds this share of the channel's
    #: standard deviation is a drift; infinite looks for none.
    drift_share: float = math.inf
    #: Look for a sudden change of scale by a factor between units.
    unit_slips: bool = True

    def __post_init__(self) -> None:
        if self.gap_steps <= 1.0:
            raise InputError(f"gap_steps is {self.gap_steps:g}", parameter="gap_steps", allowed="greater than 1")
        if self.spike_scale <= 0.0 or self.spike_samples < 1:
            raise InputError("spike_scale and spike_samples", parameter="spike_scale", allowed="greater than 0")
        if self.lowest >= self.highest:
            raise InputError(
                f"range {self.lowest:g} to {self.highest:g}", parameter="range", allowed="the lower limit first"
            )


@dataclass(frozen=True)
class DoubtfulStretch:
    """One stretch of doubtful samples."""

    channel: str
    kind: str
    #: First instant [s].
    start: float
    #: Last instant [s].
    end: float
    #: Samples.
    count: int
    detail: str = ""


@dataclass(frozen=True, eq=False)
class Quality:
    """What was found in a record."""

    #: The record with its flags.
    record: Record
    findings: tuple[DoubtfulStretch, ...]
    #: Samples by channel and kind.
    counts: Mapping[str, Mapping[str, int]]
    #: First missing instant and duration of each gap in the clock [s].
    gaps: tuple[tuple[float, float], ...]
    #: Samples that the gaps lack.
    missing_samples: int

    def share(self, channel: str) -> float:
        """Return the share of samples without any flag, those of gaps counted as lacking."""
        assert self.record.flags is not None
        sound = int(np.count_nonzero(self.record.flags[:, self.record.index(channel)] == 0))
        return sound / max(len(self.record) + self.missing_samples, 1)


@njit(cache=True, error_model="numpy")
def _median_distance(values: Array, half: int, out: Array) -> None:
    """Fill ``out`` with each sample's distance from the median of its neighbourhood; NaN neighbours do not count."""
    size = values.size
    window = np.empty(2 * half + 1)
    for i in range(size):
        if np.isnan(values[i]):
            out[i] = np.nan
            continue
        count = 0
        for j in range(max(i - half, 0), min(i + half + 1, size)):
            value = values[j]
            if np.isnan(value):
                continue
            place = count
            while place > 0 and window[place - 1] > value:
                window[place] = window[place - 1]
                place -= 1
            window[place] = value
            count += 1
        middle = count // 2
        median = window[middle] if count % 2 else 0.5 * (window[middle - 1] + window[middle])
        out[i] = values[i] - median


def find_spikes(values: Array, options: QualityOptions) -> NDArray[np.bool_]:
    """Return where a sample stands out of its neighbourhood [eq:records-spike]."""
    spikes = np.zeros(values.size, dtype=bool)
    if not math.isfinite(options.spike_scale) or values.size < 5:
        return spikes
    distance = np.empty(values.size)
    _median_distance(values, max(options.spike_samples, 2), distance)
    # Every so many samples are enough for a scale
    thin = slice(None, None, max(values.size // 3000, 1))
    known = np.abs(distance[thin])
    known = known[np.isfinite(known)]
    if known.size == 0:
        return spikes
    # A smooth record is monotone between its crests, where the distances vanish: the usual step from sample to sample
    # and the larger distances keep the scale from vanishing too
    steps = np.abs(np.diff(values)[thin])
    steps = steps[np.isfinite(steps)]
    scale = max(
        1.4826 * float(np.median(known)),
        float(np.quantile(known, 0.9)) / 1.6449,
        0.7413 * float(np.median(steps)) if steps.size else 0.0,
    )
    limit = max(options.spike_scale * scale, options.spike_least)
    if limit == 0.0:
        return spikes
    with np.errstate(invalid="ignore"):
        spikes = np.abs(distance) > limit
    return spikes


def _runs(same: NDArray[np.bool_]) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Return first and one past the last index of every stretch of True."""
    edges = np.flatnonzero(np.diff(np.concatenate([[False], same, [False]]).astype(np.int8)))
    return edges[0::2], edges[1::2]


def find_flat(values: Array, step: float, options: QualityOptions) -> NDArray[np.bool_]:
    """Return where identical values last longer than ``flat_seconds``."""
    flat = np.zeros(values.size, dtype=bool)
    if not math.isfinite(options.flat_seconds) or values.size < 2:
        return flat
    least = max(math.floor(options.flat_seconds / step + 1e-9) + 1, 3)
    first, last = _runs(values[1:] == values[:-1])
    for begin, end in zip(first, last):
        if end - begin + 1 >= least:
            flat[begin : end + 1] = True
    return flat


def find_clipped(values: Array, options: QualityOptions) -> NDArray[np.bool_]:
    """Return where the record stands at its limit: plateaus at its highest or lowest value, twice or more."""
    clipped = np.zeros(values.size, dtype=bool)
    if options.clip_samples < 1 or not np.isfinite(values).any():
        return clipped
    for level in (np.nanmax(values), np.nanmin(values))[: 2 if options.clip_lowest else 1]:
        first, last = _runs(values == level)
        long = (last - first) >= options.clip_samples
        if int(long.sum()) >= 2:
            for begin, end in zip(first[long], last[long]):
                clipped[begin:end] = True
    return clipped


def check_record(
    record: Record, options: QualityOptions | Mapping[str, QualityOptions], *, step: float | None = None
) -> Quality:
    """Flag the doubtful samples of a record or of a block of one.

    Parameters
    ----------
    record : Record
    options : QualityOptions or mapping of them by channel
    step : float, optional
        Usual time step [s]; the median by default.

    Returns
    -------
    Quality
    """
    usual = record.step if step is None else step
    flags = np.zeros(record.values.shape, dtype=np.uint8)
    if record.flags is not None:
        flags |= record.flags
    findings: list[DoubtfulStretch] = []
    counts: dict[str, dict[str, int]] = {}
    gaps, lacking = find_gaps(record.time, usual, _option(options, record.names[0]).gap_steps)
    for place, name in enumerate(record.names):
        chosen = _option(options, name)
        values = record.values[:, place]
        found = {
            bits.MISSING: ~np.isfinite(values),
            bits.RANGE: (values < chosen.lowest) | (values > chosen.highest),
            bits.FLAT: find_flat(values, usual, chosen) if usual > 0.0 else np.zeros(values.size, bool),
            bits.CLIPPED: find_clipped(values, chosen),
            bits.SPIKE: np.zeros(values.size, bool),
        }
        # Values far out of range would hide the spikes among the rest
        inside = np.where(found[bits.RANGE], np.nan, values)
        found[bits.SPIKE] = find_spikes(inside, chosen)
        counts[name] = {}
        for bit, where in found.items():
            if where.any():
                flags[where, place] |= bit
                kind = bits.FLAG_NAMES[int(bit)]
                counts[name][kind] = int(where.sum())
                findings.extend(_stretches(name, kind, record.time, values, where))
    return Quality(replace(record, flags=flags), tuple(findings), counts, gaps, lacking)


def _option(options: QualityOptions | Mapping[str, QualityOptions], name: str) -> QualityOptions:
    return options if isinstance(options, QualityOptions) else options.get(name, QualityOptions())


def _stretches(
    name: str, kind: str, time: Array, values: Array, where: NDArray[np.bool_], most: int = 50
) -> list[DoubtfulStretch]:
    first, last = _runs(where)
    out = []
    for begin, end in zip(first[:most], last[:most]):
        value = values[begin]
        detail = f"value {value:.6g}" if kind in ("spike", "flat line", "clipped", "out of range") else ""
        out.append(DoubtfulStretch(name, kind, float(time[begin]), float(time[end - 1]), int(end - begin), detail))
    if first.size > most:
        rest = int((last[most:] - first[most:]).sum())
        out.append(
            DoubtfulStretch(
                name, kind, float(time[first[most]]), float(time[last[-1] - 1]), rest, f"{first.size - most} more"
            )
        )
    return out


def find_gaps(time: Array, step: float, gap_steps: float) -> tuple[tuple[tuple[float, float], ...], int]:
    """Return the gaps of a clock (first missing instant, duration) [s] and how many samples they lack."""
    if time.size < 2 or not step > 0.0:
        return (), 0
    steps = np.diff(time)
    where = np.flatnonzero(steps > gap_steps * step)
    gaps = tuple((float(time[i] + step), float(steps[i] - step)) for i in where)
    return gaps, int(np.sum(np.rint(steps[where] / step) - 1.0))


# ------------------------------------------------------------------------- over the blocks of a long record


SLIP_FACTORS = (10.0, 100.0, 1000.0, 9.80665, 9806.65, 57.29578)
"""Factors between units that people mix: powers of ten, kgf and N, deg and rad.

Smaller ones (ft and m, kn and m/s) are left out: weather changes a block as much.
"""
_SMALLEST_JUMP = 0.6  # decades: seas grow fourfold from one block to the next
_NEAREST, _FARTHEST = 0.02, 0.1  # decades: bounds of the distance from a factor that counts as near
_WEATHER = 1.3  # decades: a calm and a storm may differ so much, and then all that they move changes with them


@dataclass(frozen=True)
class BlockMoments:
    """Mean, standard deviation and robust scale of one channel in one block."""

    index: int
    middle: float
    mean: float
    deviation: float
    scale: float


def moments_of(index: int, record: Record, name: str) -> BlockMoments:
    """Return the moments of a channel in a block, flagged samples left out."""
    values = record.sound(name)
    values = values[np.isfinite(values)]
    middle = 0.5 * float(record.time[0] + record.time[-1])
    if values.size < 2:
        return BlockMoments(index, middle, math.nan, math.nan, math.nan)
    part = values[:: max(values.size // 2000, 1)]
    low, high = np.partition(part, (part.size // 10, part.size - 1 - part.size // 10))[
        [part.size // 10, part.size - 1 - part.size // 10]
    ]
    return BlockMoments(index, middle, float(values.mean()), float(values.std()), float(high - low) / 2.5631)


@dataclass(frozen=True)
class Slip:
    """A sudden change of scale: from which block to which, by which factor, and the factor between units."""

    channel: str
    first: int
    last: int
    factor: float
    unit_factor: float


def find_slips(
    moments: Sequence[BlockMoments], channel: str, *, others: Iterable[Sequence[BlockMoments]] = ()
) -> tuple[Slip, ...]:
    """Find stretches of blocks that are in another unit than those before and after [eq:records-slip].

    Parameters
    ----------
    moments : sequence of BlockMoments
        Of the channel, in the order of time.
    channel : str
    others : iterable of sequences of BlockMoments
        Of the other channels: what changes in several of them is weather, not a unit.

    Notes
    -----
    A jump of the scale counts when it stands out of the jumps of the other blocks, lies as near to a factor between
    units as those jumps allow, and the mean, where it is larger than the fluctuation, jumps with it.
    """
    known = [entry for entry in moments if entry.scale > 0.0]
    if len(known) < 3:
        return ()
    scale = np.log10([entry.scale for entry in known])
    jumps = np.diff(scale)
    spread = 1.4826 * float(np.median(np.abs(jumps - np.median(jumps))))
    stands_out = max(_SMALLEST_JUMP, 5.0 * spread)
    sizes = [_by_block(other) for other in others]
    edges = [0]
    edges += [
        i + 1
        for i, jump in enumerate(jumps)
        if abs(jump) > stands_out
        and _near_factor(jump, spread, 2.0 * _FARTHEST) > 0.0
        and _mean_follows(known[i], known[i + 1], float(jump))
        and not _weather(sizes, known[i].index, known[i + 1].index, float(jump))
    ]
    edges.append(len(known))
    if len(edges) == 2:
        return ()
    pieces = list(itertools.pairwise(edges))
    levels = [float(np.median(scale[a:b])) for a, b in pieces]
    longest = max(range(len(pieces)), key=lambda i: pieces[i][1] - pieces[i][0])
    slips: list[Slip] = []
    for place, (a, b) in enumerate(pieces):
        ends = [jumps[a - 1] if a else None, -jumps[b - 1] if b < len(known) else None]
        found = [jump for jump in ends if jump is not None]
        factor = float(np.mean(found))
        same_sign = all(np.sign(jump) == np.sign(factor) for jump in found)
        usual = _near_factor(factor, spread / math.sqrt(len(found)), _FARTHEST)
        event = b - a == 1 and abs(factor) < _WEATHER  # a ship, a squall
        away = abs(levels[place] - levels[longest])
        # Without a way back the record has to stay where it jumped to; a storm dies down
        stays = away >= 0.3 if len(found) == 2 else abs(away - abs(factor)) < 0.3
        if place == longest or usual == 0.0 or not same_sign or not stays or event:
            continue
        slips.append(
            Slip(channel, known[a].index, known[b - 1].index, 10.0**factor, usual if factor > 0 else 1 / usual)
        )
    return tuple(slips)


def _near_factor(jump: float, spread: float, farthest: float) -> float:
    """Return the factor between units that a jump [decades] lies near, within what others scatter; 0 for none."""
    reach = min(max(2.5 * spread, _NEAREST), farthest)
    distance, factor = min((abs(abs(jump) - math.log10(factor)), factor) for factor in SLIP_FACTORS)
    return factor if distance <= reach else 0.0


def _mean_follows(before: BlockMoments, after: BlockMoments, jump: float) -> bool:
    """Whether the mean changed by the factor of the scale; true where the mean is too small to say."""
    if min(abs(before.mean) - before.deviation, abs(after.mean) - after.deviation) <= 0.0:
        return True
    return abs(math.log10(abs(after.mean) / abs(before.mean)) - jump) < 0.3


def _by_block(moments: Sequence[BlockMoments]) -> dict[int, float]:
    return {entry.index: math.log10(entry.scale) for entry in moments if entry.scale > 0.0}


def _weather(others: Sequence[Mapping[int, float]], before: int, after: int, jump: float) -> bool:
    """Whether another channel changes at that block by half of a jump as weather can make."""
    if abs(jump) > _WEATHER:
        return False
    changes = [other[after] - other[before] for other in others if before in other and after in other]
    return any(change / jump > 0.5 for change in changes)


@dataclass(frozen=True)
class ChannelDrift:
    """Trend of a channel's block means."""

    channel: str
    #: Change per second [unit/s].
    rate: float
    #: Standard error of the rate [unit/s].
    error: float
    #: Change over the record [unit].
    change: float
    #: ``|change|`` over the typical standard deviation inside a block.
    share: float

    @property
    def significant(self) -> bool:
        """Whether the trend exceeds three standard errors."""
        return abs(self.rate) > 3.0 * self.error


def find_drift(moments: Sequence[BlockMoments], channel: str) -> ChannelDrift | None:
    """Return the trend of the block means by Theil and Sen's median of slopes [eq:records-drift].

    Its error allows for the correlation from block to block. A tide in a short record is a trend too: remove it first.
    """
    known = [entry for entry in moments if math.isfinite(entry.mean)]
    if len(known) < 6:
        return None
    time = np.array([entry.middle for entry in known])
    mean = np.array([entry.mean for entry in known])
    chosen = np.linspace(0, time.size - 1, min(time.size, 300)).astype(int)
    t, m = time[chosen], mean[chosen]
    upper = np.triu_indices(t.size, 1)
    rate = float(np.median((m[upper[1]] - m[upper[0]]) / (t[upper[1]] - t[upper[0]])))
    rest = mean - rate * (time - time.mean())
    rest -= np.median(rest)
    # Blocks in a wrong unit must not hide a drift of the others
    reach = 4.0 * 1.4826 * float(np.median(np.abs(rest)))
    rest = np.clip(rest, -reach, reach)
    variance = float(np.mean(rest**2))
    lag = float(np.mean(rest[1:] * rest[:-1]) / variance) if variance > 0.0 else 0.0
    lag = min(max(lag, 0.0), 0.99)
    effective = max(time.size * (1.0 - lag) / (1.0 + lag), 2.0)
    error = math.sqrt(variance / effective / float(np.var(time)))
    change = rate * float(time[-1] - time[0])
    typical = float(np.nanmedian([entry.deviation for entry in known]))
    return ChannelDrift(channel, rate, error, change, abs(change) / typical if typical > 0.0 else math.inf)


def _percent(count: int, samples: int) -> str:
    share = 100.0 * count / max(samples, 1)
    return f"{share:.3g} %" if share >= 10.0 else f"{share:.2g} %"


def quality_notices(
    quality: Mapping[str, Mapping[str, int]], samples: int, gaps: Sequence[tuple[float, float]], dated: bool
) -> tuple[Notice, ...]:
    """Return what a reader must know about the quality of a record."""
    notices = []
    if gaps:
        start, duration = max(gaps, key=lambda gap: gap[1])
        notices.append(
            Notice(
                "record-gaps",
                f"{counted(len(gaps), 'gap')}, the longest {duration:.4g} s from {instant_text(start, dated)}; "
                "only short ones are filled for spectra, with a notice",
                float(len(gaps)),
            )
        )
    for channel, kinds in quality.items():
        for kind, count in kinds.items():
            notices.append(
                Notice(
                    "record-quality",
                    f"{channel}: {counted(count, 'sample')} ({_percent(count, samples)}) flagged as "
                    f"{kind}; values were left as they are",
                    float(count),
                )
            )
    return tuple(notices)
