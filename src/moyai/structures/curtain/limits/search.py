"""Up to where a utilisation holds: the whole range is scanned, then each crossing closed in."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

NOT_REACHED = "not reached"
_STEPS = 60
_CLOSE = 1e-9
#: Steps in which a range is looked at before its crossings are closed in
_PLACES = 24


@dataclass(frozen=True)
class Limit:
    """A limit and what sets it."""

    #: Largest speed [m/s], significant height [m] or span [m] up to which everything holds; 0 when even the smallest is
    #: too much, the end of the range where nothing in it is.
    value: float
    #: Component at its limit, ``no equilibrium``, ``breaking`` or ``not reached``.
    governing: str
    #: All places of the range where holding begins or ends; more than one where it is not one stretch.
    crossings: tuple[float, ...] = ()
    #: End of the range that was searched.
    highest: float = math.nan
    #: Utilisation just beyond the limit [-], at 0 where that is too much; NaN where no limit was found.
    ratio: float = math.nan

    @property
    def reached(self) -> bool:
        """Whether the range holds a limit."""
        return self.governing != NOT_REACHED


def search(
    worst: Callable[[float], tuple[float, str]], high: float, *, start: float = 0.0, first_only: bool = False
) -> Limit:
    """Return up to where a utilisation is at most 1, with every crossing of the range [eq:curtain-limit-search].

    Nothing is taken to rise: the range is looked at in even steps, then each step over whose ends the outcome changes
    is closed in. Stretches narrower than a step can be missed.

    Parameters
    ----------
    worst : callable
        Largest utilisation and what it is of; infinite where there is no state.
    high : float
        End of the range.
    start : float
        Where it begins: just above 0 where there is no state at 0.
    first_only : bool
        End at the first crossing, for which nothing beyond it counts.
    """
    places = [start + (high - start) * k / _PLACES for k in range(_PLACES + 1)]
    found = [worst(places[0])]
    ends: list[tuple[float, str, float]] = []
    for k in range(_PLACES):
        if first_only and (ends or found[0][0] > 1.0):
            break
        found.append(worst(places[k + 1]))
        if (found[k][0] <= 1.0) != (found[k + 1][0] <= 1.0):
            holds, fails = (k, k + 1) if found[k][0] <= 1.0 else (k + 1, k)
            ends.append(_close_in(worst, places[holds], places[fails], found[holds][0], *found[fails]))
    crossings = tuple(place for place, _, _ in ends)
    if found[0][0] > 1.0:
        return Limit(0.0, found[0][1], crossings, high, found[0][0])
    if not ends:
        return Limit(high, NOT_REACHED, (), high)
    value, name, ratio = ends[0]
    return Limit(value, name, crossings, high, ratio)


def _close_in(
    worst: Callable[[float], tuple[float, str]],
    holds: float,
    fails: float,
    held: float,
    failed: float,
    name: str,
) -> tuple[float, str, float]:
    """Return the last place that holds, with what fails beyond it and its utilisation there.

    Secant where both ends have a number, kept off the ends and of the Illinois kind, else halves: a state without
    equilibrium counts as infinite.
    """
    lack, excess, side, beyond = min(held - 1.0, -1e-300), failed - 1.0, 0, failed
    for _ in range(_STEPS):
        share = 0.5
        if math.isfinite(lack) and math.isfinite(excess):
            share = min(max(lack / (lack - excess), 0.01), 0.99)
        middle = holds + share * (fails - holds)
        value, which = worst(middle)
        if value <= 1.0:
            holds, lack = middle, min(value - 1.0, -1e-300)
            excess *= 0.5 if side == -1 else 1.0
            side = -1
        else:
            fails, name, excess, beyond = middle, which, value - 1.0, value
            lack *= 0.5 if side == 1 else 1.0
            side = 1
        if abs(fails - holds) <= _CLOSE * max(abs(fails), abs(holds)):
            break
    return holds, name, beyond
