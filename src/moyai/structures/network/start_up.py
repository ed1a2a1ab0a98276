"""The beginning of a run that peaks and statistics leave out: as asked, or where a motion begins with a jerk."""

from __future__ import annotations

import math
from collections.abc import Iterable

from moyai.structures.network.model import MotionPlan

#: The rule of a beginning that the case asks for.
ASKED = "settings.skip"


def start_up(skip: float | None, motions: Iterable[MotionPlan], duration: float) -> tuple[float, str]:
    """Return the length of the beginning that does not count [s] [eq:flexible-start-up], and its rule in words.

    Lines at rest that are seized by a point at speed bear a jerk of EA v / c, which belongs to the way the run begins
    and not to the motion. One mean period of that motion is left out, at most half the run.

    Parameters
    ----------
    skip : float or None
        As asked [s]; ``None``: found here.
    motions : iterable of MotionPlan
        Of the driven points.
    duration : float
        Of the run [s].
    """
    if skip is not None:
        return skip, ASKED if skip else ""
    found = [(plan, begin) for plan in motions if not math.isnan((begin := plan.beginning(duration)).period)]
    if not found:
        return 0.0, ""
    plan, begin = max(found, key=lambda pair: pair[1].period)
    length = min(begin.period, 0.5 * duration)
    window = "one mean period" if length == begin.period else "half the run, less than a period"
    how = ", in which it grows from nothing" if plan.growth(duration) else ""
    away = f" {begin.away:.3g} m from its place of rest" if begin.away > 0.0 else ""
    return length, f"{window} of the motion '{plan.name}'{how}: it begins{away} at {begin.speed:.3g} m/s"
