"""Which events of an irregular sea are rerun with lines in motion, and how far the largest of them can still lie.

The largest event with lines at rest need not be the largest in motion. The events of a realisation are therefore rerun
in the order of their tensions with lines at rest, until the next of them, times the largest ratio of motion over rest
that any rerun gave (one at least), stays under the largest in motion. What is left open by the limit on their number is
kept as a bound on the tension [eq:breakwater-events].
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

import numpy as np

from moyai.core.arrays import Array
from moyai.core.at_once import each_at_once
from moyai.core.errors import ConvergenceError
from moyai.core.progress import Progress, silent
from moyai.floating.forcing import IrregularForcing
from moyai.floating.time import Simulation
from moyai.structures.breakwater.lines.events import (
    PERIODS_AROUND,
    EventSettings,
    event_numbers,
    event_offsets,
    run_event,
)
from moyai.structures.breakwater.time.model import SeaOfRun, TimeRun

if TYPE_CHECKING:
    import xarray as xr


MOST_EVENTS = 8  # of one realisation that are rerun
#: Change of the two highest tensions with twice the bars under which the bars resolve the line.
_RESOLVED = 0.01


@dataclass(frozen=True)
class Realisation:
    """One realisation with lines at rest at every instant, and its numbers."""

    seed: int
    run: TimeRun
    forcing: IrregularForcing
    around: SeaOfRun
    summary: xr.Dataset


@dataclass(frozen=True)
class EventsInMotion:
    """What the reruns of one realisation give for one line."""

    #: The rerun with the largest tension.
    run: TimeRun
    #: Over all reruns: largest of what is largest, least of what is least; slack and snap of the largest event; shape
    #: (lines,).
    numbers: dict[str, Array]
    #: Reruns.
    count: int
    #: Largest offset from rest in each rerun, with its lines in motion and at rest; shape (reruns, 2, dof) [m, m, rad].
    offsets: Array
    #: Tension of the line that no event passes, if none multiplies its tension with lines at rest by more than the
    #: largest ratio found [N].
    bound: float


def events_in_order(simulation: Simulation, line: int, begin: float, apart: float) -> list[tuple[float, float]]:
    """Return time [s] and tension [N] of the peaks of a line, the highest first, each ``apart`` [s] from higher ones.

    Parameters
    ----------
    simulation : Simulation
    line : int
    begin : float
        Where statistics begin [s].
    apart : float
        [s].
    """
    kept = simulation.time >= begin
    time, tension = simulation.time[kept], simulation.tension[kept, line]
    inner = np.flatnonzero((tension[1:-1] >= tension[:-2]) & (tension[1:-1] > tension[2:])) + 1
    tops = inner if inner.size else np.array([int(np.argmax(tension))])
    found: list[tuple[float, float]] = []
    for row in tops[np.argsort(-tension[tops], kind="stable")]:
        if all(abs(time[row] - earlier) > apart for earlier, _ in found):
            found.append((float(time[row]), float(tension[row])))
        if len(found) > MOST_EVENTS:
            break
    return found


@dataclass
class _RerunSearch:
    """The reruns of one realisation so far."""

    member: Realisation
    events: list[tuple[float, float]]
    numbers: list[dict[str, Array]] = field(default_factory=list)
    offsets: list[Array] = field(default_factory=list)
    tensions: list[float] = field(default_factory=list)
    #: The rerun with the largest tension; the others are not kept, they are large.
    run: TimeRun | None = None

    @property
    def best(self) -> float:
        return max(self.tensions, default=0.0)

    @property
    def next(self) -> float:
        """Tension with lines at rest of the event that comes next [N], 0 after the last."""
        return self.events[len(self.tensions)][1] if len(self.tensions) < len(self.events) else 0.0

    def take(self, run: TimeRun, numbers: dict[str, Array], tension: float) -> None:
        if self.run is None or tension > self.best:
            self.run = run
        self.numbers.append(numbers)
        self.offsets.append(event_offsets(run))
        self.tensions.append(tension)

    def ratio(self) -> float:
        pairs = zip(self.tensions, self.events, strict=False)
        return max((tension / still for tension, (_, still) in pairs), default=1.0)


def events_in_motion(
    given: EventSettings,
    members: Sequence[Realisation],
    line: int,
    floor: float = 0.0,
    progress: Progress = silent,
) -> list[EventsInMotion]:
    """Rerun the events of every realisation that may hold the largest tension of a line in motion.

    Parameters
    ----------
    given : EventSettings
    members : sequence of Realisation
    line : int
    floor : float
        Tension under which the line cannot govern: events that stay under it are not rerun, save the largest of each
        realisation [N].
    progress : Progress

    Raises
    ------
    InputError
        When the lines find no equilibrium.
    ConvergenceError
        When a rerun does not come to its end.
    KeyboardInterrupt
        When it is stopped.
    """
    apart = PERIODS_AROUND * given.peak_period
    searches = [
        _RerunSearch(one, events_in_order(one.run.simulation, line, one.around.begin, apart)) for one in members
    ]
    words = f"lines in motion, {given.model.unit.name}"
    open_ones = searches
    while open_ones:
        progress(words, len(searches) - len(open_ones), len(searches))
        each_at_once(lambda search, heard: _rerun(given, search, line, heard), open_ones, progress)
        # The ratio is that of the whole sea, and only grows: what one realisation gives holds for all
        ratio = _ratio(searches)
        open_ones = [search for search in searches if _is_open(search, ratio, floor)]
    progress(words, len(searches), len(searches))
    ratio = _ratio(searches)
    return [_answer(search, ratio) for search in searches]


def change_on_finer_lines(
    given: EventSettings,
    members: Sequence[Realisation],
    found: Sequence[EventsInMotion],
    line: int,
    progress: Progress = silent,
) -> float:
    """Return the change of the mean largest tension with twice the bars, where the line goes slack; NaN elsewhere.

    A line that comes taut from slack ends in a wave of tension that its bars carry as far as they are short. Where the
    two highest of all hardly change the others are not run again.

    Parameters
    ----------
    given : EventSettings
    members : sequence of Realisation
    found : sequence of EventsInMotion
        Of each realisation, of this line; the event of its largest tension is run again.
    line : int
    progress : Progress

    Raises
    ------
    InputError
        When the lines find no equilibrium.
    ConvergenceError
        When a rerun does not come to its end.
    KeyboardInterrupt
        When it is stopped.
    """
    if not any(item.numbers["slack_time"][line] > 0.0 for item in found):
        return math.nan
    lines = given.settings.lines
    # the internal damping is one of the material: more bars keep it
    finer = lines.changed(bars=2 * lines.bars, damping_ratio=2.0 * lines.damping_ratio, sensitivity=False)
    fine = replace(given, settings=given.settings.changed(lines=finer))
    events = [[(float(item.run.attributes["event"]), 1.0)] for item in found]
    searches = [_RerunSearch(one, event) for one, event in zip(members, events, strict=True)]
    before = np.array([item.numbers["line_tension_maximum"][line] for item in found])
    highest = np.argsort(-before)[:2]
    each_at_once(lambda search, heard: _rerun(fine, search, line, heard), [searches[at] for at in highest], progress)
    changes = np.array([searches[at].best / before[at] - 1.0 for at in highest])
    if np.all(np.abs(changes) < _RESOLVED):
        return float(changes.mean())
    others = [search for search in searches if not search.tensions]
    each_at_once(lambda search, heard: _rerun(fine, search, line, heard), others, progress)
    return float(np.mean([search.best for search in searches]) / before.mean() - 1.0)


def _ratio(searches: list[_RerunSearch]) -> float:
    return max(1.0, *(search.ratio() for search in searches))


def _is_open(search: _RerunSearch, ratio: float, floor: float) -> bool:
    return len(search.tensions) < MOST_EVENTS and search.next * ratio > max(search.best, floor)


def _rerun(given: EventSettings, search: _RerunSearch, line: int, progress: Progress) -> None:
    one = search.member
    event = search.events[len(search.tensions)][0]
    run = run_event(given, one.forcing, one.around, one.run.simulation, line, event, progress)
    if run.simulation.status == "interrupted":
        raise KeyboardInterrupt
    if run.simulation.status != "converged":
        raise ConvergenceError(f"lines in motion: {run.simulation.message}")
    numbers = event_numbers(given.moving.unit, run)
    search.take(run, numbers, float(numbers["line_tension_maximum"][line]))


def _answer(search: _RerunSearch, ratio: float) -> EventsInMotion:
    at = int(np.argmax(search.tensions))
    combined = dict(search.numbers[at])
    for name in combined:
        stack = np.array([numbers[name] for numbers in search.numbers])
        if name.startswith("maximum_"):
            combined[name] = stack.max(axis=0)
        elif name.startswith("least_grounded"):
            combined[name] = stack.min(axis=0)
    assert search.run is not None
    bound = max(search.best, search.next * ratio)
    return EventsInMotion(search.run, combined, len(search.tensions), np.array(search.offsets), bound)
