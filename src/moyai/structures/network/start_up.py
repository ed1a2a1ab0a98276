"""The beginning of a run that peaks and statistics leave out: as asked, or where a motion begins with a jerk."""

from __future__ import annotations

import math
from collections.abc import Iterable

from moyai.structures.network.model import MotionPlan

#: The rule of a beginning that the case requires.
ASKED = "settings.skip"


#: The rule of runs through waves, periods left out and the largest part of the run.
WAVES = "five periods of the waves, which grow from nothing"
_PERIODS, _PART = 5.0, 0.25


def start_up(
    skip: float | None, motions: Iterable[MotionPlan], duration: float, wave_period: float = math.nan
) -> tuple[float, str]:
    """Return the length of the beginning that does not count [s] [eq:flexible-start-up], and its rule in words.

    Lines at rest that are seized by a point at speed carry a jerk of EA v / c, which belongs to the way the run begins
    and not to the motion. One mean period of that motion is left out, at most half the run. Waves that grow within a
    period find the network at rest: five of them are left out, at most a quarter of the run, and a period counts.

    Parameters
    ----------
    skip : float or None
        As asked [s]; ``None``: found here.
    motions : iterable of MotionPlan
        Of the driven points.
    duration : float
        Of the run [s].
    wave_period : float
        Of the waves, of their peak [s]; NaN without waves.
    """
    if skip is not None:
        return skip, ASKED if skip else ""
    found = [(plan, begin) for plan in motions if not math.isnan((begin := plan.beginning(duration)).period)]
    if not found:
        if not math.isfinite(wave_period):
            return 0.0, ""
        # a whole period of the waves counts in any case
        return max(min(_PERIODS * wave_period, _PART * duration, duration - wave_period), 0.0), WAVES
    plan, begin = max(found, key=lambda pair: pair[1].period)
    length = min(begin.period, 0.5 * duration)
    window = "one mean period" if length == begin.period else "half the run, less than a period"
    how = ", in which it grows from nothing" if plan.growth(duration) else ""
    away = f" {begin.away:.3g} m from its place at rest" if begin.away > 0.0 else ""
    return length, f"{window} of the motion '{plan.name}'{how}: it begins{away} at {begin.speed:.3g} m/s"
