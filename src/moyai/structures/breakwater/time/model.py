"""What regular and irregular seas share in time: runs, compiled lines, damping."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from moyai.core.arrays import Array
from moyai.core.progress import Progress, silent
from moyai.core.validity import IdentityCheck, Notice
from moyai.floating.forcing import Forcing
from moyai.floating.lines import PlanarMooring
from moyai.floating.memory import StateSpaceMemory
from moyai.floating.time import CumminsModel, Simulation, simulate
from moyai.floating.together import simulate_together
from moyai.structures.breakwater.assembly import FloatingUnit
from moyai.structures.breakwater.frequency.model import FrequencyModel
from moyai.structures.breakwater.lines.motion import LinesInMotion, has_dynamic_lines, run_on_lines
from moyai.structures.breakwater.model import MooringLine
from moyai.structures.breakwater.settings import MODES, TimeSettings
from moyai.structures.breakwater.variables import labelled

if TYPE_CHECKING:
    import xarray as xr

    from moyai.flexible.flow import Current
    from moyai.sea.components import WaveComponents


MOST_ROWS = 120_000  # rows of a stored time series


@dataclass(frozen=True)
class TimeRun:
    """One simulation with what it was made for."""

    #: Name of its group in the result.
    name: str
    simulation: Simulation
    attributes: dict[str, Any]
    #: Of lines that are in motion.
    lines: LinesInMotion | None = None
    #: The same with lines at rest at every instant, next to lines in motion.
    at_rest: Simulation | None = None

    def dataset(self, unit: FloatingUnit) -> xr.Dataset:
        """Return the time series, thinned to at most :data:`MOST_ROWS` rows."""
        import xarray as xr

        run = self.simulation
        every = max(1, math.ceil(len(run.time) / MOST_ROWS))
        # copies: rows of several seas are views of one array, which results would keep
        data = xr.Dataset(
            {
                "position": (("time", "dof"), run.position[::every].copy()),
                "tension": (("time", "line"), run.tension[::every].copy()),
                "surface_elevation": ("time", run.elevation[::every].copy()),
            },
            coords={"time": run.time[::every].copy(), "dof": list(MODES), "line": [line.name for line in unit.lines]},
            attrs={**self.attributes, "time_step": run.time_step, "status": run.status, "message": run.message},
        )
        if self.lines is not None:
            data = data.assign(self.lines.variables(unit, every)).assign_coords(shape_time=self.lines.shape_time)
            data.attrs |= {
                "lines": "in motion",
                "network_step": self.lines.network_step,
                "network_nodes": self.lines.nodes_in_all,
                "network_passes": self.lines.passes,
            }
        if self.at_rest is not None and len(self.at_rest.time) > 1:
            data = data.assign(self._compared(data.time.values))
        return labelled(data)

    def _compared(self, time: Array) -> dict[str, Any]:
        """Return position and tension of the run with lines at rest, at the times of this run."""
        other = self.at_rest
        assert other is not None

        def at(values: Array) -> Array:
            columns = [np.interp(time, other.time, column) for column in values.T]
            found = np.array(columns).T.reshape(len(time), -1)
            # the two steps differ, and so may the last row; a run that ended early leaves the rest open
            found[time > other.time[-1] + 2.0 * max(other.time_step, self.simulation.time_step)] = np.nan
            return found

        return {
            "position_lines_at_rest": (("time", "dof"), at(other.position)),
            "tension_lines_at_rest": (("time", "line"), at(other.tension)),
        }

    @property
    def peaks(self) -> Array:
        """Tensions whose maxima count: the highest since the row before for lines in motion."""
        return self.simulation.tension if self.lines is None else self.lines.peak


@dataclass(frozen=True)
class TimeResult:
    """Summary of a sea in time, its runs, and what they have to say."""

    dataset: xr.Dataset
    runs: tuple[TimeRun, ...]
    notices: tuple[Notice, ...] = ()
    status: str = "converged"
    checks: tuple[IdentityCheck, ...] = ()


def compiled_lines(unit: FloatingUnit, reach: Array, *, at_rest_only: bool = False) -> PlanarMooring | None:
    """Prepare the lines of the unit for the time domain.

    Tables serve within motions of ``reach`` [m, m, rad] about rest, the exact solver beyond. ``at_rest_only`` leaves
    out lines that are in motion.
    """
    system = unit.mooring.planar.system
    if at_rest_only:
        kept = [
            line
            for line, given in zip(unit.lines, unit.breakwater.lines, strict=True)
            if not (isinstance(given, MooringLine) and given.dynamic)
        ]
        system = replace(system, lines=tuple(kept))
    if not system.lines:
        return None
    return PlanarMooring.of(system, rest=(0.0, 0.0, 0.0), centre=(0.0, 0.0), motion_range=reach)


def linear_damping(model: FrequencyModel, added_mass: Array, stiffness: Array) -> Array:
    return np.asarray(model.damping.at(model.inertia, added_mass, stiffness), dtype=float)


@dataclass(frozen=True)
class SeaOfRun:
    """What a run needs of its sea next to the forces on the unit."""

    waves: WaveComponents | None
    current: Current | None
    #: Ramp [s].
    ramp: float
    #: Begin of the analysis [s].
    begin: float
    #: Typical wave period [s].
    period: float


def run_seeds(
    attributes: Sequence[dict[str, Any]],
    model: FrequencyModel,
    cummins: CumminsModel,
    forcings: Sequence[Forcing],
    expected: Array,
    settings: TimeSettings,
    seas: Sequence[SeaOfRun],
    duration: float,
    progress: Progress = silent,
) -> list[TimeRun]:
    """Simulate realisations of one sea: side by side, or one after the other where lines are in motion."""
    if has_dynamic_lines(model.unit):
        return [
            run_with_lines("realisation", said, model, cummins, forcing, expected, settings, sea, duration, progress)
            for said, forcing, sea in zip(attributes, forcings, seas, strict=True)
        ]
    expected = np.nan_to_num(expected)
    runs = simulate_together(
        replace(cummins, mooring=compiled_lines(model.unit, _reach(model.unit, expected))), forcings,
        expected_motion=expected, duration=duration, time_step=settings.time_step, progress=progress,
    )  # fmt: skip
    return [TimeRun("realisation", run, said) for said, run in zip(attributes, runs)]


def _reach(unit: FloatingUnit, expected: Array) -> Array:
    return np.maximum(2.0 * expected, 1e-3 * np.array([unit.breakwater.hull.beam] * 2 + [1.0]))


def run_with_lines(
    name: str,
    attributes: dict[str, Any],
    model: FrequencyModel,
    cummins: CumminsModel,
    forcing: Forcing,
    expected: Array,
    settings: TimeSettings,
    sea: SeaOfRun,
    duration: float,
    progress: Progress = silent,
) -> TimeRun:
    """Simulate with line tables for twice the expected motion (at least a thousandth of the beam, or of a radian).

    Lines in motion are run in their own time; the run with all lines at rest is then made next to it, to compare.
    """
    unit = model.unit
    expected = np.nan_to_num(expected)
    reach = _reach(unit, expected)
    simulation = simulate(
        replace(cummins, mooring=compiled_lines(unit, reach)),
        forcing,
        expected_motion=expected,
        duration=duration,
        time_step=settings.time_step,
        progress=progress,
    )
    if not has_dynamic_lines(unit) or simulation.status == "interrupted":
        return TimeRun(name, simulation, attributes)
    if not isinstance(cummins.memory, StateSpaceMemory):
        reported = Notice(
            "lines-at-rest",
            f"{unit.name}, {name}: the memory of the water has no states, which lines in motion need; the lines are at "
            "rest at every instant",
            remedy="give a damping lid where water resonates between hulls",
        )
        return TimeRun(name, replace(simulation, notices=(*simulation.notices, reported)), attributes)
    moving, lines = run_on_lines(
        model, cummins, forcing, expected, settings.lines,
        static_lines=compiled_lines(unit, reach, at_rest_only=True), waves=sea.waves, current=sea.current,
        ramp=sea.ramp, duration=duration, time_step=settings.time_step, begin=sea.begin, period=sea.period,
        progress=progress,
    )  # fmt: skip
    return TimeRun(name, moving, attributes, lines, simulation)
