"""One event of an irregular sea with lines in motion, where lines at rest at every instant do not serve.

The rerun starts shortly before the event from the motion that the unit has with lines at rest, its lines at rest in
that place, on the same waves. What the start leaves out is the motion of the lines themselves, which their drag takes
away within a few waves. The whole sea with lines in motion would take a hundred times longer.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from moyai.core.arrays import Array
from moyai.core.progress import Progress, silent
from moyai.floating.forcing import IrregularForcing
from moyai.floating.memory import StateSpaceMemory
from moyai.floating.time import CumminsModel, Simulation
from moyai.structures.breakwater.assembly import FloatingUnit
from moyai.structures.breakwater.frequency.model import FrequencyModel
from moyai.structures.breakwater.lines.motion import BodyStart, run_on_lines
from moyai.structures.breakwater.lines.network import LineNetwork, line_network
from moyai.structures.breakwater.model import MooringLine
from moyai.structures.breakwater.responses import SNAP_RATIO
from moyai.structures.breakwater.settings import TimeSettings
from moyai.structures.breakwater.time.lines import lines_at_rest, motion_summary
from moyai.structures.breakwater.time.model import SeaOfRun, TimeRun, compiled_lines
from moyai.structures.breakwater.viscous_damping import in_moving_water

SETTLING_PERIODS = 4.0  # peak periods from the start of a window to where it counts, at least
MOST_LEAD = 600.0  # [s] from the start of a window to its event
PERIODS_AROUND = 4.0  # peak periods before and after the event that count
FADED = 12.0  # time constants of the slowest state of the memory that its start looks back over


def with_lines_in_motion(model: FrequencyModel) -> FrequencyModel:
    """Return the model with every line in motion of which enough is known."""
    breakwater = model.unit.breakwater
    lines = tuple(
        replace(line, dynamic=True) if isinstance(line, MooringLine) and line.can_move else line
        for line in breakwater.lines
    )
    return replace(model, unit=replace(model.unit, breakwater=replace(breakwater, lines=lines)))


def movable(unit: FloatingUnit) -> NDArray[np.bool_]:
    """Return which lines may be set in motion and are not in motion yet."""
    return np.array(
        [isinstance(line, MooringLine) and line.can_move and not line.dynamic for line in unit.breakwater.lines],
        dtype=bool,
    )


def out_of_range(unit: FloatingUnit, largest: Array, mean: Array) -> NDArray[np.bool_]:
    """Return which lines at rest at every instant have peaks that such lines do not give (no springs).

    Parameters
    ----------
    unit : FloatingUnit
    largest, mean : ndarray (..., lines)
        Tensions [N]; one passing value over the leading axes is enough.
    """
    kinds = len(unit.lines)
    passing = np.nan_to_num(largest).reshape(-1, kinds) > SNAP_RATIO * np.nan_to_num(mean).reshape(-1, kinds)
    chains = np.array([isinstance(line, MooringLine) for line in unit.breakwater.lines], dtype=bool)
    return np.asarray(passing.any(axis=0) & chains & lines_at_rest(unit))


@dataclass(frozen=True)
class EventSettings:
    """What the reruns of a sea share."""

    model: FrequencyModel
    cummins: CumminsModel
    #: Shape (3,).
    expected: Array
    settings: TimeSettings
    #: [s].
    peak_period: float
    #: Natural period of sway [s]; 0 where it is not known.
    slow_period: float

    @cached_property
    def moving(self) -> FrequencyModel:
        """The model with every line in motion of which enough is known."""
        return with_lines_in_motion(self.model)

    @cached_property
    def network(self) -> LineNetwork | None:
        """Its lines at rest."""
        return line_network(self.moving.unit, self.settings.lines)

    @property
    def lead(self) -> float:
        """Time from the start of a window to its event [s]."""
        slow = self.slow_period if math.isfinite(self.slow_period) else 0.0
        return min(PERIODS_AROUND * self.peak_period + max(slow, SETTLING_PERIODS * self.peak_period), MOST_LEAD)


def run_event(
    given: EventSettings,
    forcing: IrregularForcing,
    sea: SeaOfRun,
    whole: Simulation,
    line: int,
    event: float,
    progress: Progress = silent,
) -> TimeRun:
    """Run the unit on lines in motion around an event.

    Parameters
    ----------
    given : EventSettings
    forcing : IrregularForcing
        Of the whole realisation.
    sea : SeaOfRun
        Its waves and current.
    whole : Simulation
        The realisation with lines at rest at every instant.
    line : int
        Whose tension the event is.
    event : float
        Its time in the realisation [s].
    progress : Progress
    """
    model = given.moving
    row = int(np.searchsorted(whole.time, event - given.lead))
    # An event soon after the ramp of the sea is run from the beginning, ramp included
    row = row if whole.time[row] >= sea.ramp else 0
    start, ramp = float(whole.time[row]), 0.0 if row else sea.ramp
    around = PERIODS_AROUND * given.peak_period
    duration = min(event + around, float(whole.time[-1])) - start
    begin = max(event - start - around, 0.0)
    turned = replace(forcing, amplitude=forcing.amplitude * np.exp(-1j * forcing.omega * start), ramp=ramp)
    waves = sea.waves
    if waves is not None:
        waves = replace(waves, phase=waves.phase - waves.omega * start)
    unit = model.unit
    reach = np.maximum(2.0 * given.expected, 1e-3 * np.array([unit.breakwater.hull.beam] * 2 + [1.0]))
    moved = in_moving_water(unit, turned, waves.heading if waves is not None else np.zeros(1))
    moving, lines = run_on_lines(
        model, given.cummins, moved, given.expected, given.settings.lines,
        static_lines=compiled_lines(unit, reach, at_rest_only=True), waves=waves, current=sea.current, ramp=ramp,
        duration=duration, time_step=given.settings.time_step, begin=begin, period=given.peak_period, progress=progress,
        start=_motion_at(given.cummins, whole, row), lines=given.network,
    )  # fmt: skip
    attributes = {
        "kind": "irregular", "ramp": ramp, "analysis_start": begin, "starts_at": start, "event": event,
        "line": given.model.unit.lines[line].name,
    }  # fmt: skip
    return TimeRun("event", moving, attributes, lines, _part(whole, start, duration))


def _motion_at(cummins: CumminsModel, whole: Simulation, row: int) -> BodyStart | None:
    """Return the motion of the unit at a row of its run with lines at rest; ``None`` at the beginning."""
    memory = cummins.memory
    if row == 0:
        return None
    assert isinstance(memory, StateSpaceMemory)
    slowest = float(np.min(-memory.poles.real)) if len(memory.poles) else math.inf
    # What lies further back has faded from the slowest state
    first = int(np.searchsorted(whole.time, whole.time[row] - FADED / max(slowest, 1e-12)))
    states = memory.states_after(whole.time[first : row + 1], whole.velocity[first : row + 1])
    return BodyStart(whole.position[row], whole.velocity[row], states)


def event_numbers(unit: FloatingUnit, run: TimeRun) -> dict[str, Array]:
    """Return what counts of an event of a unit on lines in motion: their largest tensions, and what they add."""
    begin = float(run.attributes["analysis_start"])
    window = run.simulation.time >= begin
    assert run.lines is not None
    anchor, uplift = run.lines.anchor[window], run.lines.uplift[window]
    level = np.sqrt(np.maximum(anchor**2 - uplift**2, 0.0))
    return {
        "line_tension_maximum": run.peaks[window].max(axis=0),
        "anchor_vertical_tension_maximum": uplift.max(axis=0),
        "anchor_horizontal_tension_maximum": level.max(axis=0),
        **motion_summary(unit, run, window, begin),
    }


def event_offsets(run: TimeRun) -> Array:
    """Return the largest offset in the part of an event that counts, lines in motion and at rest, (2, dof)."""
    begin = float(run.attributes["analysis_start"])
    assert run.at_rest is not None
    pair = (run.simulation, run.at_rest)
    return np.array([np.abs(one.position[one.time >= begin]).max(axis=0) for one in pair])


def _part(whole: Simulation, start: float, duration: float) -> Simulation:
    rows = (whole.time >= start) & (whole.time <= start + duration)
    return replace(
        whole, time=whole.time[rows] - start, position=whole.position[rows], velocity=whole.velocity[rows],
        mooring_force=whole.mooring_force[rows], tension=whole.tension[rows], elevation=whole.elevation[rows],
    )  # fmt: skip
