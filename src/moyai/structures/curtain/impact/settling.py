"""Slack and taut cycles in regular waves after the start has died out: repeating, or steady in the mean.

A curtain that is let go slack snaps once because it was let go. What a daily wave does to it day after day is what is
left when periods repeat. Stiff cables throw the skirt back, so that it may repeat every second or eighth period, or
never: then only what is steady in the mean is reported, the mean of the largest of a hundred periods with its scatter.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Literal

import numpy as np

from moyai.core.arrays import Array
from moyai.core.options import checks_words
from moyai.series.intervals import reach_of_mean
from moyai.structures.curtain.impact.cable import Impact
from moyai.structures.curtain.impact.cycles import CableContact, SlackTautMotion, slack_sag, slack_taut_motion

Kind = Literal["repeating", "chaotic", "not steady"]

#: Change of the largest tension (over the highest) and of the place at a period's start (over the slack sag) up to
#: which two periods count as equal [-].
TOLERANCE = 0.01
#: Most periods after which the motion may repeat, and times that a repetition must be seen.
MOST_MULTIPLE, _SEEN = 16, 3
#: Periods run, one length after the other until periods repeat.
_LENGTHS = (60, 240)
#: Periods left out of, and analysed in, a motion that never repeats; of these the largest of each hundred counts.
_LEFT_OUT, _BLOCK, _BLOCKS = 100, 100, 6
#: Difference of the means of both halves, over its standard error, beyond which a motion is not steady.
_STEADY = 3.0


@checks_words
@dataclass(frozen=True, eq=False)
class SettledCycles:
    """A motion in regular waves and the part of it that counts."""

    #: From the start on.
    motion: SlackTautMotion
    #: Of the waves [s].
    period: float
    #: ``chaotic``: no repetition, but steady in the mean; ``not steady``: neither; one of "repeating", "chaotic", "not
    #: steady".
    kind: Kind
    #: Periods after which it repeats; 0 where it does not.
    multiple: int
    #: Periods left out.
    first: int
    #: Periods that count.
    count: int
    #: Largest tension of each period that counts, both cables together [N].
    peaks: Array

    @property
    def begin(self) -> float:
        """When what counts begins [s]."""
        return self.first * self.period

    @property
    def end(self) -> float:
        """When it ends [s]."""
        return (self.first + self.count) * self.period

    @property
    def tension(self) -> float:
        """The tension to design with [N]: the largest that repeats, or the mean of the largest of 100 periods."""
        return self.level(self.peaks)

    @property
    def scatter(self) -> tuple[float, float]:
        """Least and largest of the largest of 100 periods [N]; both the tension itself where it repeats."""
        if self.kind == "repeating":
            return self.tension, self.tension
        blocks = _blocks(self.peaks)
        return float(blocks.min()), float(blocks.max())

    @property
    def judged(self) -> float:
        """Tension at which limits are judged [N]: of a mean, the end of its one-sided 95 % interval."""
        return self.tension if self.kind == "repeating" else self.tension + reach_of_mean(_blocks(self.peaks))

    def level(self, values: Array) -> float:
        """Return the number that stands for one value of each period that counts."""
        return float(values.max()) if self.kind == "repeating" else float(_blocks(values).mean())

    def of_contacts(self, contacts: Iterable[CableContact]) -> float:
        """Return that number for the tensions of contacts; periods without one have none."""
        values = np.zeros(self.count)
        for contact in contacts:
            row = int((contact.time - self.begin) / self.period)
            if 0 <= row < self.count:
                values[row] = max(values[row], contact.tension)
        return self.level(values)

    @property
    def typical(self) -> int:
        """Number of the period, from the start on, whose largest tension is nearest to :attr:`tension`."""
        return self.first + int(np.argmin(np.abs(self.peaks - self.tension)))


def settled_cycles(
    impact: Impact,
    *,
    drag_coefficient: float,
    current: float,
    velocity_amplitude: float,
    period: float,
    least_settled: int,
    least_analysed: int,
    time_step: float | None = None,
) -> SettledCycles:
    """Run slack and taut cycles until periods repeat, or until they are steady in the mean [eq:curtain-settled].

    The run starts just taut downstream in a current along the normal, which takes the drift from a release away, and
    in the line between the supports without one.

    Parameters
    ----------
    impact, drag_coefficient, current, velocity_amplitude, period, time_step
        As :func:`moyai.structures.curtain.impact.cycles.slack_taut_motion`.
    least_settled, least_analysed : int
        Periods left out at least, and periods over which the repetition must hold at least.
    """
    start = (math.copysign(slack_sag(impact), current) if current != 0.0 else 0.0, 0.0)
    lengths = [length + least_settled + least_analysed for length in _LENGTHS]
    never = max(_LEFT_OUT, least_settled) + _BLOCK * max(_BLOCKS, math.ceil(least_analysed / _BLOCK))
    motion: SlackTautMotion | None = None
    for length in (*lengths, never):
        motion = slack_taut_motion(
            impact,
            drag_coefficient=drag_coefficient,
            current=current,
            velocity_amplitude=velocity_amplitude,
            period=period,
            duration=length * period,
            start=start,
            time_step=time_step,
        )
        peaks, places = _by_period(motion, period, length)
        found = _repetition(peaks, places, slack_sag(impact), least_settled, least_analysed)
        if found is not None:
            multiple, first = found
            return SettledCycles(motion, period, "repeating", multiple, first, length - first, peaks[first:])
    assert motion is not None
    first = max(_LEFT_OUT, least_settled)
    peaks = peaks[first:]
    return SettledCycles(motion, period, "chaotic" if _steady(peaks) else "not steady", 0, first, peaks.size, peaks)


def _by_period(motion: SlackTautMotion, period: float, count: int) -> tuple[Array, Array]:
    """Return the largest tension of each period and the place at its start."""
    row = np.minimum((motion.time / period * (1.0 + 1e-12)).astype(int), count - 1)
    peaks = np.zeros(count)
    np.maximum.at(peaks, row, motion.tension)
    for contact in motion.contacts:
        # a contact peaks between the samples
        when = contact.peak_time if math.isfinite(contact.peak_time) else contact.time
        number = min(int(when / period), count - 1)
        peaks[number] = max(peaks[number], contact.tension)
    return peaks, np.interp(period * np.arange(count), motion.time, motion.position)


def _repetition(
    peaks: Array, places: Array, sag: float, least_settled: int, least_analysed: int
) -> tuple[int, int] | None:
    """Return after how many periods a motion repeats, and from which period on; None where it does not."""
    top = max(float(peaks[least_settled:].max()), 1e-300)
    length = max(sag, 1e-300)
    for multiple in range(1, MOST_MULTIPLE + 1):
        change = np.maximum(
            np.abs(peaks[multiple:] - peaks[:-multiple]) / top, np.abs(places[multiple:] - places[:-multiple]) / length
        )
        off = np.flatnonzero(change > TOLERANCE)
        first = max(int(off[-1]) + 1 if off.size else 0, least_settled)
        if peaks.size - first >= max(least_analysed, (_SEEN + 1) * multiple):
            return multiple, first
    return None


def _blocks(values: Array) -> Array:
    """Return the largest of each hundred periods; what is left over belongs to the last."""
    blocks = max(1, values.size // _BLOCK)
    return np.array([part.max() for part in np.array_split(values, blocks)])


def _steady(peaks: Array) -> bool:
    """Whether the halves of a series have the same mean, by the scatter of the means of short stretches."""
    half = peaks.size // 2
    parts = [np.array([part.mean() for part in np.array_split(one, 5)]) for one in (peaks[:half], peaks[half:])]
    error = math.sqrt(sum(float(part.var(ddof=1)) / part.size for part in parts))
    gap = abs(float(parts[0].mean() - parts[1].mean()))
    return gap <= max(_STEADY * error, TOLERANCE * float(peaks.max()))


__all__ = ["MOST_MULTIPLE", "TOLERANCE", "SettledCycles", "settled_cycles"]
