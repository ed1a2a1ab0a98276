"""What regular and irregular seas share in time: runs, compiled lines, damping."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from moyai.breakwater.assembly import FloatingUnit
from moyai.breakwater.frequency_model import FrequencyModel
from moyai.breakwater.model import MODES
from moyai.breakwater.variables import labelled
from moyai.core.validity import Notice
from moyai.floating.forcing import Forcing
from moyai.floating.lines import PlanarMooring
from moyai.floating.time import CumminsModel, Simulation, simulate

if TYPE_CHECKING:
    import xarray as xr

Array = NDArray[np.float64]

MOST_ROWS = 120_000  # rows of a stored time series


@dataclass(frozen=True)
class TimeRun:
    """One simulation with what it was made for.

    Parameters
    ----------
    name : str
        Name of its group in the result.
    simulation : Simulation
    attributes : dict
    """

    name: str
    simulation: Simulation
    attributes: dict

    def dataset(self, unit: FloatingUnit) -> xr.Dataset:
        """Return the time series, thinned to at most :data:`MOST_ROWS` rows."""
        import xarray as xr

        run = self.simulation
        every = max(1, math.ceil(len(run.time) / MOST_ROWS))
        data = xr.Dataset(
            {
                "position": (("time", "dof"), run.position[::every]),
                "tension": (("time", "line"), run.tension[::every]),
                "surface_elevation": ("time", run.elevation[::every]),
            },
            coords={"time": run.time[::every], "dof": list(MODES), "line": [line.name for line in unit.lines]},
            attrs={**self.attributes, "time_step": run.time_step, "status": run.status, "message": run.message},
        )
        return labelled(data)


@dataclass(frozen=True)
class TimeResult:
    """Summary of a sea in time, its runs, and what they have to say."""

    dataset: xr.Dataset
    runs: tuple[TimeRun, ...]
    notices: tuple[Notice, ...] = ()
    status: str = "converged"


def compiled_lines(unit: FloatingUnit, reach: Array) -> PlanarMooring | None:
    """Prepare the lines of the unit for the time domain.

    Tables serve within motions of ``reach`` [m, m, rad] about rest, the exact solver beyond.
    """
    if not unit.lines:
        return None
    return PlanarMooring.of(unit.mooring.planar.system, rest=(0.0, 0.0, 0.0), centre=(0.0, 0.0), motion_range=reach)


def linear_damping(model: FrequencyModel, added_mass: Array, stiffness: Array) -> Array:
    return np.asarray(model.damping.at(model.unit.inertia, added_mass, stiffness), dtype=float)


def run_with_lines(
    model: FrequencyModel, cummins: CumminsModel, forcing: Forcing, expected: Array, **options: Any
) -> Simulation:
    """Simulate with line tables for twice the expected motion (at least a thousandth of the beam, or of a radian)."""
    unit = model.unit
    reach = np.maximum(2.0 * np.nan_to_num(expected), 1e-3 * np.array([unit.breakwater.hull.beam] * 2 + [1.0]))
    return simulate(
        replace(cummins, mooring=compiled_lines(unit, reach)),
        forcing,
        expected_motion=np.nan_to_num(expected),
        **options,
    )
