"""Lines in motion around the events of a sea where lines at rest at every instant do not serve.

The fairlead of one line moves as it does with all lines at rest; the pull of a line hardly moves a unit within a snap.
The line starts at rest in the place of its fairlead some periods before the event and is carried into the motion.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from moyai.core.arrays import Array
from moyai.core.at_once import each_at_once
from moyai.core.errors import ConvergenceError, InputError
from moyai.core.progress import Progress, silent
from moyai.flexible.build import NetworkBuilder
from moyai.flexible.mooring_line import add_mooring_line, bed_under, carried_along, end_tensions, joined
from moyai.flexible.motion import Motion
from moyai.flexible.network import Network
from moyai.flexible.result import State
from moyai.flexible.sea_table import sea_of_lines
from moyai.flexible.simulation import simulate
from moyai.flexible.statics import solve_equilibrium
from moyai.floating.forcing import cosine_ramp
from moyai.mooring.lines import Line
from moyai.mooring.rotations import rotation_from_vector
from moyai.sea.components import WaveComponents
from moyai.structures.units.assembly import RowAtLevel
from moyai.structures.units.model import SNAP_RATIO, UnitLine

#: Peak periods from the start of a rerun to its event, around it that count, and of the ramp into the motion
LEAD, AROUND, RAMP = 8.0, 2.0, 2.0
#: Events of one realisation that are rerun for one line; those of equal waves differ by less than this factor
MOST_EVENTS, _SAME = 4, 1.001
#: Bars of a line at first and at most, internal damping of a bar, tension at rest against the exact line
BARS, MOST_BARS, DAMPING, AT_REST = 30, 120, 0.1, 0.02


@dataclass(frozen=True, eq=False)
class Carried:
    """What a rerun needs of a run with lines at rest."""

    #: Shape (n,).
    time: Array
    #: Motions that the constraints leave, and their velocity; shape (n, r).
    reduced: Array
    velocity: Array
    #: All motions of each of them; shape (m, r).
    free: Array
    #: Shape (n, lines).
    tension: Array
    waves: WaveComponents
    #: Begin of the analysis [s].
    begin: float
    #: Period of the peak [s].
    period: float

    def motion(self, unit: int, rows: slice) -> tuple[Array, Array]:
        """Return position and velocity (k, 6) of a unit."""
        free = self.free[6 * unit : 6 * unit + 6].T
        return self.reduced[rows] @ free, self.velocity[rows] @ free


@dataclass(frozen=True, eq=False)
class DynamicLine:
    """A line as a network at rest."""

    network: Network
    rest: State
    line: Line
    unit: int


@dataclass(frozen=True)
class Reruns:
    """What reruns gave: largest tension in motion (members, lines), NaN where none; bound of what was not rerun."""

    tension: Array
    bound: Array
    count: int

    @property
    def moved(self) -> NDArray[np.bool_]:
        """Which lines were set in motion in every member."""
        return np.array([bool(np.isfinite(column).all()) for column in self.tension.T], dtype=bool)


def movable(at: RowAtLevel) -> list[UnitLine | None]:
    """Return for every line what it is made of, ``None`` of springs and of lines that do not give enough."""
    found: list[UnitLine | None] = []
    for number in range(at.row.count):
        for line in at.row.lines:
            if number in line.units:
                found.append(line if len(line.bar_types) == len(line.segments) > 0 else None)
    return found


def moving_line(at: RowAtLevel, number: int) -> DynamicLine:
    """Return a line of the row as a network, cut so that its tension at rest is that of the exact line.

    Raises
    ------
    InputError
        When it finds no equilibrium.
    """
    unit = [n for n, lines in enumerate(at.lines) for _ in lines][number]
    line = [line for lines in at.lines for line in lines][number]
    given = movable(at)[number]
    assert isinstance(line, Line) and given is not None
    exact = float(at.tensions(np.zeros(at.size))[number])
    bars = BARS
    while True:
        bed = bed_under(given.bar_types, at.water, line.bed_friction, None, None)
        builder = NetworkBuilder(at.water, bed)
        add_mooring_line(
            builder, line, given.bar_types, given.clump_bodies, at.centres[unit], at.water, bars, DAMPING
        )  # fmt: skip
        network = joined(builder.build(), [line.name])
        try:
            rest = solve_equilibrium(network)
        except ConvergenceError as error:
            raise InputError(
                f"line '{line.name}' in motion finds no equilibrium: {error.fault.message}", parameter="lines",
                remedy=error.fault.remedy,
            ) from error  # fmt: skip
        found = float(end_tensions(network, line.name, rest.state.position[None], rest.tension[None])[0][0])
        if abs(found - exact) <= AT_REST * exact or bars >= MOST_BARS:
            return DynamicLine(network, rest.state, line, unit)
        bars *= 2


def rerun(
    at: RowAtLevel, moving: DynamicLine, given: Carried, event: float, progress: Progress = silent
) -> float:  # fmt: skip
    """Return the largest tension [N] of a line in motion around an event.

    Raises
    ------
    ConvergenceError
        When the rerun does not come to its end.
    KeyboardInterrupt
        When it is stopped.
    """
    step = float(given.time[1] - given.time[0])
    first = max(int(np.searchsorted(given.time, event - LEAD * given.period)), 0)
    last = min(int(np.searchsorted(given.time, event + AROUND * given.period)), len(given.time) - 1)
    position, speed = given.motion(moving.unit, slice(first, last + 1))
    place = fairlead(moving.line, position)
    start = place[0]
    turned = rotation_from_vector(position[:, 3:])
    arm = np.einsum("tij,j->ti", turned, np.asarray(moving.line.fairlead, dtype=float))
    rate = speed[:, :3] + np.cross(speed[:, 3:], arm)
    time = step * np.arange(len(place))
    ramp = RAMP * given.period
    shape = cosine_ramp(time, ramp)[:, None]
    slope = np.where(time < ramp, 0.5 * math.pi / ramp * np.sin(math.pi * np.minimum(time / ramp, 1.0)), 0.0)[:, None]
    rest = np.asarray(moving.line.fairlead, dtype=float)
    motion = Motion(
        0.0, step, start - rest + shape * (place - start), shape * rate + slope * (place - start)
    )  # fmt: skip
    begun = float(given.time[first])
    waves = replace(given.waves, phase=given.waves.phase - given.waves.omega * begun)
    state = carried_along(moving.network, moving.rest, {moving.line.name: at.centres[moving.unit] + start})
    duration = float(time[-1])
    flow = sea_of_lines(waves, None, 0.0, state.position, duration + step, step)
    counted_from = event - begun - AROUND * given.period
    history = simulate(
        moving.network, {moving.line.name: motion}, duration=duration, output_step=step, flow=flow, start=state,
        counted_from=counted_from, progress=progress,
    )  # fmt: skip
    if history.status == "interrupted":
        raise KeyboardInterrupt
    if history.status != "converged":
        raise ConvergenceError(f"line '{moving.line.name}' in motion: {history.message}")
    ends = end_tensions(moving.network, moving.line.name, history.position, history.tension_peak)
    counts = history.time >= counted_from
    return float(np.maximum(ends[0], ends[1])[counts].max())


def fairlead(line: Line, position: Array) -> Array:
    """Return the fairlead (n, 3) [m] of a line about the place of its unit at rest, for motions (n, 6)."""
    turned = rotation_from_vector(position[:, 3:])
    return np.asarray(position[:, :3] + np.einsum("tij,j->ti", turned, np.asarray(line.fairlead, dtype=float)))


def events_of(given: Carried, line: int) -> list[tuple[float, float]]:
    """Return time [s] and tension [N] of the highest peaks of a line, each apart from higher ones."""
    kept = given.time >= given.begin
    time, tension = given.time[kept], given.tension[kept, line]
    inner = np.flatnonzero((tension[1:-1] >= tension[:-2]) & (tension[1:-1] > tension[2:])) + 1
    tops = inner if inner.size else np.array([int(np.argmax(tension))])
    found: list[tuple[float, float]] = []
    for row in tops[np.argsort(-tension[tops], kind="stable")]:
        if all(abs(time[row] - earlier) > 2.0 * AROUND * given.period for earlier, _ in found):
            found.append((float(time[row]), float(tension[row])))
        if len(found) > MOST_EVENTS:
            break
    return found


def rerun_events(at: RowAtLevel, members: Sequence[Carried], progress: Progress, name: str) -> Reruns | None:
    """Rerun the events of the lines that may govern, in every realisation; ``None`` where lines at rest serve.

    The line of the highest utilisation comes first. Its events are rerun in the order of their tensions with lines at
    rest until the next of them, times the largest ratio of motion over rest that any rerun gave (one at least), stays
    under the largest in motion [eq:units-events]. Further lines follow as long as theirs could pass it.

    Raises
    ------
    InputError, ConvergenceError
        When a line finds no equilibrium, or a rerun does not come to its end.
    """
    largest = np.array([item.tension[item.time >= item.begin].max(axis=0) for item in members])
    mean = np.array([item.tension[item.time >= item.begin].mean(axis=0) for item in members])
    known = np.array([item is not None for item in movable(at)], dtype=bool)
    passing = (largest > SNAP_RATIO * mean).any(axis=0) & known
    if not passing.any():
        return None
    load = np.where(np.isfinite(at.breaking_load), at.breaking_load, 1.0)
    out = np.full(largest.shape, np.nan)
    bound = np.full(largest.shape, np.nan)
    best, ratio, count = 0.0, 1.0, 0
    order = sorted(np.flatnonzero(passing), key=lambda number: -float(np.mean(largest[:, number]) / load[number]))
    for line in order:
        if float(np.mean(largest[:, line]) / load[line]) * ratio <= best:
            break
        events = [events_of(item, int(line)) for item in members]
        found, ratio = _largest_in_motion(at, int(line), members, events, ratio, f"lines in motion{name}", progress)
        count += sum(map(len, found))
        for number in range(len(members)):
            out[number, line] = max(found[number])
            left = events[number][len(found[number])][1] if len(found[number]) < len(events[number]) else 0.0
            bound[number, line] = max(out[number, line], left * ratio)
        best = max(best, float(np.mean(bound[:, line]) / load[line]))
    progress(f"lines in motion{name}", 1, 1)
    return Reruns(out, bound, count)


def _largest_in_motion(
    at: RowAtLevel, line: int, members: Sequence[Carried], events: list[list[tuple[float, float]]], ratio: float,
    words: str, progress: Progress,
) -> tuple[list[list[float]], float]:  # fmt: skip
    """Rerun the events of a line, one of each realisation at a time; return their tensions and the largest ratio.

    ``events`` are those of each realisation, the highest first, ``ratio`` what reruns of other lines gave.
    """
    moving = moving_line(at, line)
    found: list[list[float]] = [[] for _ in members]
    going = list(range(len(members)))
    while going:
        progress(words, len(members) - len(going), len(members))
        due = [events[number][len(found[number])] for number in going]
        pairs = [(members[number], event) for number, (event, _) in zip(going, due, strict=True)]
        tensions = each_at_once(lambda pair, heard: rerun(at, moving, *pair, heard), pairs, progress)
        for number, tension, (_, still) in zip(going, tensions, due, strict=True):
            found[number].append(tension)
            # the ratio is that of the whole sea, and only grows
            ratio = max(ratio, tension / still)
        going = [
            number
            for number, (tops, own) in enumerate(zip(events, found, strict=True))
            if len(own) < min(len(tops), MOST_EVENTS) and tops[len(own)][1] * ratio > _SAME * max(own)
        ]
    return found, ratio
