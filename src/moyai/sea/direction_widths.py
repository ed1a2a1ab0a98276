"""Widths of the directions of a spectrum, from the directions themselves: a file may hold a sector only."""

from __future__ import annotations

import numpy as np

from moyai.core.arrays import Array
from moyai.core.errors import InputError

_ROUNDING = 0.1
"""Difference of steps, over their median, that comes from the few digits of a file: they are equal."""


def direction_widths(directions: Array) -> Array:
    """Return the part of the circle that each direction stands for.

    Half the way to the neighbours on either side. A step of more than one and a half times the median is the open side
    of a sector; there the direction reaches as far out as the median step.

    Parameters
    ----------
    directions : ndarray (d,)
        Different directions in any order [degrees].

    Returns
    -------
    ndarray (d,)
        In the order of ``directions`` [degrees]; their sum is 360 where they go all round.

    Raises
    ------
    InputError
        For fewer than two directions, one that is not finite, or one that is given twice.
    """
    angle = np.mod(np.asarray(directions, dtype=float), 360.0)
    if angle.size < 2 or not np.isfinite(angle).all():
        raise InputError("the spectrum has fewer than two finite directions", parameter="file")
    order = np.argsort(angle)
    steps = np.diff(np.append(angle[order], angle[order[0]] + 360.0))
    if steps.min() < 1e-6:
        raise InputError("the spectrum has a direction twice", parameter="file")
    usual = float(np.median(steps))
    within = steps <= 1.5 * usual
    if np.ptp(steps[within]) < _ROUNDING * usual:
        usual = float(steps[within].mean())
        steps = np.full_like(steps, usual)
    steps = np.where(within, steps, usual)
    widths = np.empty_like(steps)
    widths[order] = 0.5 * (steps + np.roll(steps, 1))
    return widths
