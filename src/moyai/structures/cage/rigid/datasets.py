"""From a rigid cage, its rest and its runs to labelled data."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from moyai.sea.water import Water
from moyai.structures.cage.rigid.lines import CageLine
from moyai.structures.cage.rigid.model import RigidCageProblem
from moyai.structures.cage.rigid.runs import RigidCageRun, realised_height
from moyai.structures.cage.rigid.statics import RigidCageEquilibrium, reserve_buoyancy, size_of, submerged_weight
from moyai.structures.cage.rigid.variables import labelled

if TYPE_CHECKING:
    import xarray as xr

MODES = ["sway", "heave", "roll"]
ENDS = ["cage", "anchor"]


def cage_dataset(problem: RigidCageProblem, water: Water) -> xr.Dataset:
    """Return geometry, masses and net."""
    import xarray as xr

    cage = problem.cage
    length, _, height = cage.extent
    outline = np.array([(-1, 1), (-1, -1), (1, -1), (1, 1)]) * np.array([0.5 * length, 0.5 * height])
    places = np.unique(np.round(cage.floats.points[:, [0, 2]], 12), axis=0)
    return labelled(
        xr.Dataset(
            {
                "mass": cage.mass,
                "mass_without_floats": cage.mass_without_floats,
                "solid_volume": cage.solid_volume,
                "float_volume": cage.float_volume,
                "enclosed_volume": cage.enclosed_volume,
                "centre_of_gravity_x": cage.centre[0],
                "centre_of_gravity_z": cage.centre[1],
                "inertia": cage.inertia,
                "submerged_weight": submerged_weight(cage, water),
                "reserve_buoyancy": reserve_buoyancy(cage, water),
                "net_area": cage.patches.area,
                "solidity": cage.net.solidity,
                "solidity_listed": cage.net.listed,
                "outline_x": ("corner", outline[:, 0]),
                "outline_z": ("corner", outline[:, 1]),
                "float_x": ("float", places[:, 0]),
                "float_z": ("float", places[:, 1]),
                "float_diameter": cage.floats.diameter,
            },
            attrs={
                "law": cage.law.name,
                "shape": cage.outline,
                "float_count": len(cage.floats.points),
                "equations": problem.equations,
            },
        )
    )


def statics_dataset(
    problem: RigidCageProblem,
    lines: tuple[CageLine, ...],
    free: RigidCageEquilibrium,
    rest: RigidCageEquilibrium,
    modes: tuple[np.ndarray, np.ndarray],
) -> xr.Dataset:
    """Return the floating and the moored cage at rest."""
    import xarray as xr

    cage = problem.cage
    rests = [free, rest]
    middle = [item.x - math.cos(item.theta) * cage.centre[0] - math.sin(item.theta) * cage.centre[1] for item in rests]
    periods, shapes = modes
    return labelled(
        xr.Dataset(
            {
                "rest_x": ("situation", np.array(middle)),
                "rest_z": ("situation", np.array([item.middle_z for item in rests])),
                "rest_roll": ("situation", np.array([item.theta for item in rests])),
                "immersion": ("situation", np.array([item.immersion for item in rests])),
                "residual": ("situation", np.array([item.residual for item in rests])),
                "tension_at_rest": ("line", rest.tension),
                "line_length": ("line", np.array([line.length for line in lines])),
                "line_stiffness": ("line", np.array([line.stiffness for line in lines])),
                "attachment_x": ("line", np.array([line.attachment[0] for line in lines])),
                "attachment_z": ("line", np.array([line.attachment[1] for line in lines])),
                "anchor_x": ("line", np.array([line.anchor[0] for line in lines])),
                "anchor_z": ("line", np.array([line.anchor[1] for line in lines])),
                "line_submerged_weight": ("line", np.array([line.submerged_weight for line in lines])),
                "breaking_load": (
                    "line",
                    np.array([np.nan if line.breaking_load is None else line.breaking_load for line in lines]),
                ),
                "stiffness": (("mode", "other_mode"), rest.stiffness),
                "natural_period": ("natural_mode", periods),
                "natural_shape": (("natural_mode", "mode"), shapes),
            },
            coords={
                "situation": ["floating freely", "moored"],
                "line": [line.name for line in lines],
                "mode": MODES,
                "other_mode": MODES,
            },
        )
    )


def sea_dataset(
    problem: RigidCageProblem, water: Water, runs: list[RigidCageRun], lines: tuple[CageLine, ...]
) -> xr.Dataset:
    """Return the numbers of every wave of a sea state."""
    import xarray as xr

    waves = [run.wave for run in runs]
    height = np.array([wave.height for wave in waves])
    number = 2.0 * math.pi / np.array([wave.wavelength for wave in waves])
    ratio = 1.0 / np.tanh(number * water.depth)

    def modal(name: str) -> tuple[tuple[str, str], np.ndarray]:
        return ("wave", "mode"), np.array([getattr(run.numbers, name) for run in runs])

    def pulls(name: str) -> tuple[tuple[str, str, str], np.ndarray]:
        return ("wave", "line", "end"), np.array([getattr(run.numbers, name) for run in runs])

    # of a random sea the significant range, four deviations: a mean over peak periods would be a third less
    regular = waves[0].regular
    ranges = np.array([run.numbers.range if regular else 4.0 * run.numbers.deviation for run in runs])
    data = {
        "wavelength": ("wave", np.array([wave.wavelength for wave in waves])),
        "orbit_ratio": ("wave", ratio),
        **{
            name: modal(name)
            for name in ("range", "largest_range", "mean", "maximum", "minimum", "deviation", "first_harmonic")
        },
        "first_phase": modal("first_phase"),
        "range_ratio": (("wave", "translation"), ranges[:, :2] / height[:, None]),
        "drift_velocity": ("wave", np.array([run.numbers.drift_velocity for run in runs])),
        **{
            name: pulls(name)
            for name in ("line_tension_minimum", "line_tension_mean", "line_tension_maximum", "line_tension_mean_peak")
        },
        "anchor_tension_maximum": (
            ("wave", "line"),
            np.array([run.numbers.line_tension_maximum[:, ENDS.index("anchor")] for run in runs]),
        ),
        "slack_share": (("wave", "line"), np.array([run.numbers.slack_share for run in runs])),
        "steps_per_period": ("wave", np.array([run.march.steps * run.wave.period / run.wave.duration for run in runs])),
    }
    return labelled(
        xr.Dataset(
            data,
            coords={
                "wave": [wave.name for wave in waves],
                "wave_height": ("wave", height),
                "period": ("wave", np.array([wave.period for wave in waves])),
                "mode": MODES,
                "translation": MODES[:2],
                "line": [line.name for line in lines],
                "end": ENDS,
            },
            attrs={"kind": "regular" if waves[0].regular else "irregular", "status": _status(runs)},
        )
    )


def _status(runs: list[RigidCageRun]) -> str:
    for status in ("not_converged", "interrupted"):
        if any(run.march.status == status for run in runs):
            return status
    return "converged"


def time_dataset(problem: RigidCageProblem, run: RigidCageRun, lines: tuple[CageLine, ...]) -> xr.Dataset:
    """Return the time series of one wave."""
    import xarray as xr

    motion = run.march.state[:, :3] - run.rest.place
    ramp = problem.settings.ramp_periods * run.wave.period
    return labelled(
        xr.Dataset(
            {
                "surface_elevation": ("time", run.elevation),
                "sway": ("time", motion[:, 0]),
                "heave": ("time", motion[:, 1]),
                "roll": ("time", motion[:, 2]),
                "tension": (("time", "line", "end"), run.ends),
                "line_tension_peak_since_row": (("time", "line"), run.march.tension_peak),
            },
            coords={"time": run.march.time, "line": [line.name for line in lines], "end": ENDS},
            attrs={
                "wave_height": run.wave.height,
                "period": run.wave.period,
                "wave": run.wave.name,
                "theory": run.wave.theory,
                "wavelength": run.wave.wavelength,
                "rest_x": run.rest.x,
                "rest_z": run.rest.z,
                "rest_roll": run.rest.theta,
                "ramp": ramp,
                "heading": float(run.wave.components.heading[0]),
                "regular": int(run.wave.regular),
                "size": size_of(problem.cage),
                "realised_height": realised_height(problem, run),
                **({} if run.wave.seed is None else {"seed": run.wave.seed}),
            },
        )
    )
