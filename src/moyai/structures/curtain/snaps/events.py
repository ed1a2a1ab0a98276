"""Snaps of a curtain in an irregular sea: found, distinguished, counted."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from moyai.core.arrays import Array
from moyai.core.errors import InputError
from moyai.core.validity import Notice
from moyai.structures.curtain.impact.cable import Impact
from moyai.structures.curtain.impact.cycles import SlackTautMotion, simulate_in_flow, slack_sag
from moyai.structures.curtain.snaps.flow import SkirtFlow

Flags = NDArray[np.bool_]

# Peak of a snap over sqrt(d/g) beyond which the mass of infinite frequency is too simple
_SHORT_RISE = 0.6


@dataclass(frozen=True, eq=False)
class SeaSnaps:
    """Contacts of a curtain in a sea, after the start has died out."""

    #: The whole series.
    motion: SlackTautMotion
    #: Of each contact: taut instant [s].
    time: Array
    #: Speed there [m/s].
    speed: Array
    #: Largest tension [N].
    tension: Array
    #: Time to it [s].
    rise_time: Array
    #: 1 downstream, -1 upstream.
    side: NDArray[np.int64]
    #: First contact of its half wave; the others are bounces.
    first: Flags
    #: Whether the speed reaches the slowest that counts.
    fast: Flags
    #: Of the analysed part [s].
    duration: float
    #: Speed below which a contact does not count as a snap [m/s].
    slowest: float
    #: Where the model leaves its range.
    notices: tuple[Notice, ...]

    @property
    def counted(self) -> Flags:
        """First contacts that are fast enough: the snaps."""
        return self.first & self.fast

    @property
    def snap_tension(self) -> Array:
        """Largest tensions of the snaps [N]."""
        return self.tension[self.counted]

    @property
    def later_tension(self) -> Array:
        """Largest tensions of the bounces [N]."""
        return self.tension[~self.first]

    @property
    def hours(self) -> float:
        """Analysed time [h]."""
        return self.duration / 3600.0

    @property
    def snaps_per_hour(self) -> float:
        """Counted snaps over the analysed time [1/h]."""
        return float(self.counted.sum()) / self.hours

    @property
    def taut_share(self) -> float:
        """Share of the samples of the series in which the cable is taut."""
        return float(np.mean(self.motion.tension > 0.0))


def snaps_in_sea(
    impact: Impact,
    flow: SkirtFlow,
    *,
    drag_coefficient: float,
    slowest: float,
    transient: float,
    start: tuple[float, float] | None = None,
    mass: float | None = None,
    taut_step: float | None = None,
) -> SeaSnaps:
    """Run the slack and taut curtain through a sea and list its snaps [eq:impact-slack-taut].

    Parameters
    ----------
    impact : Impact
        The span; its speed does not enter.
    flow : SkirtFlow
        Water along the normal, from :func:`moyai.structures.curtain.snaps.flow.flow_over_skirt`.
    drag_coefficient : float
        C_D of the skirt, on d per metre of span.
    slowest : float
        Slowest speed at the taut instant that counts as a snap [m/s].
    transient : float
        Time after the start that is left out [s].
    start : (float, float), optional
        Position [m] and speed [m/s] of mid-span; in the line between the supports, moving with the water, by default
        (let go at rest in moving water it would keep a drift that drag takes away slowly).
    mass : float, optional
        Added mass [kg/m], M0 of the paper by default.
    taut_step : float, optional
        Longest step while taut [s]; a 25th of the rise of model A by default.

    Raises
    ------
    InputError
        When a number is out of range or nothing is left after the transient.
    """
    if not (math.isfinite(slowest) and slowest >= 0.0):
        raise InputError(f"slowest is {slowest:g} m/s", parameter="slowest", allowed="0 or more")
    last = float(flow.time[-1])
    if not 0.0 <= transient < last:
        raise InputError(f"transient is {transient:g} s", parameter="transient", allowed=f"0 to less than {last:g} s")
    motion = simulate_in_flow(
        impact,
        drag_coefficient,
        flow.table,
        flow.time_step,
        (0.0, float(flow.speed[0])) if start is None else start,
        mass=mass,
        mean_speed=flow.current,
        taut_step=taut_step,
    )
    chosen = [contact for contact in motion.contacts if contact.time >= transient]
    speed = np.array([abs(contact.speed) for contact in chosen])
    tension = np.array([contact.tension for contact in chosen])
    rise = np.array([contact.rise_time for contact in chosen])
    fast = speed >= slowest
    return SeaSnaps(
        motion,
        np.array([contact.time for contact in chosen]),
        speed,
        tension,
        rise,
        np.array([contact.side for contact in chosen], dtype=np.int64),
        np.array([contact.first for contact in chosen], dtype=bool),
        fast,
        last - transient,
        slowest,
        _check(impact, flow, rise[fast], tension),
    )


def _check(impact: Impact, flow: SkirtFlow, rise: Array, tension: Array) -> tuple[Notice, ...]:
    notices = []
    if rise.size:
        middle = float(np.median(rise)) / math.sqrt(impact.draught / impact.water.gravity)
        if middle > _SHORT_RISE:
            notices.append(
                Notice(
                    "snap-slow",
                    f"Half of the snaps have a rise time of more than {middle:.3g} √(d/g); the added mass of "
                    "infinite "
                    f"frequency is valid below {_SHORT_RISE}",
                    middle,
                    _SHORT_RISE,
                    remedy="correct the peaks by the ratio of the impact model with memory",
                    source="Cummins form: 2 % at 0.64, 26 % at 1.86",
                )
            )
    if tension.size == 0:
        reach = _excursion(flow)
        sag = slack_sag(impact)
        notices.append(
            Notice(
                "snap-none",
                f"Nothing becomes taut: the water swings {reach:.3g} m, the slack is {2.0 * sag:.3g} m",
                reach,
                2.0 * sag,
                severity="information",
                source="without current nothing is taut while the excursion is within twice the sag",
            )
        )
    return tuple(notices)


def _excursion(flow: SkirtFlow) -> float:
    """Return the range of the water's displacement about its mean motion [m]."""
    wave = flow.speed - flow.speed.mean()
    way = np.concatenate([[0.0], np.cumsum(0.5 * (wave[1:] + wave[:-1]))]) * flow.time_step
    return float(np.ptp(way))


@dataclass(frozen=True)
class StepError:
    """Change of the results from a fine run to a coarse one.

    A stiff cable throws the skirt back, and small differences grow from bounce to bounce: two runs of one sea part
    after some contacts, however fine the steps. Then single snaps mean nothing, and counts, means and fitted laws do.
    """

    #: Of the number of snaps; slow contacts about the limit come and go.
    count_change: int
    #: Relative change of the largest tension [-].
    largest_change: float
    #: Relative change of the mean of all snaps [-].
    mean_change: float
    #: When the runs part: first contact that is off by more than half of its rise [s]; infinite where they do not.
    parted: float


def compare_steps(coarse: SeaSnaps, fine: SeaSnaps) -> StepError:
    """Return how two runs of one sea with other steps differ."""
    one, two = coarse.snap_tension, fine.snap_tension
    common = min(coarse.time.size, fine.time.size)
    off = np.abs(coarse.time[:common] - fine.time[:common]) > 0.5 * fine.rise_time[:common]
    parted = float(fine.time[int(np.argmax(off))]) if off.any() else math.inf
    if one.size == 0 or two.size == 0:
        change = 0.0 if one.size == two.size else math.inf
        return StepError(one.size - two.size, change, change, parted)
    return StepError(
        one.size - two.size,
        float(one.max() / two.max() - 1.0),
        float(one.mean() / two.mean() - 1.0),
        parted,
    )


def suggested_time_step(peak_period: float) -> float:
    """Return a step of the flow [s] that resolves waves up to six times the peak frequency: a 160th of the period.

    Contacts need no finer one; they are located in time and stepped through by the oscillator.
    """
    if not (math.isfinite(peak_period) and peak_period > 0.0):
        raise InputError(f"peak_period is {peak_period:g} s", parameter="peak_period", allowed="greater than 0")
    return peak_period / 160.0
