"""What the time domain found: numbers of every run, means over realisations, the record that is kept."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from moyai.core.arrays import Array
from moyai.design.fatigue import damage
from moyai.sea.states import IrregularSea, RegularSea
from moyai.series.rainflow import count_cycles
from moyai.structures.units.across import stretch_across
from moyai.structures.units.anchors import AT_REST, TENSION, loads_of_record
from moyai.structures.units.assembly import RowAtLevel
from moyai.structures.units.contact import meeting_variables
from moyai.structures.units.datasets import coords_of
from moyai.structures.units.gaps import gaps_of
from moyai.structures.units.time.memory import RowMemory
from moyai.structures.units.time.seas import PARTS, SeaRun
from moyai.structures.units.variables import labelled

if TYPE_CHECKING:
    import xarray as xr

#: Rows of a stored time series
MOST_ROWS = 20_000
#: Rows of a run that are summed side by side
_SIDE_BY_SIDE = 128
#: Of a mean that is taken over realisations: also kept one by one
_SCATTER = (
    "connector_resultant_largest", "connector_moment_largest", "connector_moment_resultant_largest",
    "line_tension_maximum", "largest_offset", "gap_motion_largest", "gap_closing_largest", "connector_damage_rate",
    "maximum_motion", *AT_REST, TENSION,
)  # fmt: skip
_LOWEST = ("elongation_lowest", "least_distance")
_HIGHEST = ("elongation_highest", "stretch_across", "hulls_meet")
Numbers = dict[str, tuple[tuple[str, ...], Array]]
_CONNECTOR, _COMPONENT = ("connector",), ("connector", "component")


def memory_dataset(at: RowAtLevel, memory: RowMemory, omega: Array) -> xr.Dataset:
    """Return poles, residues and the coefficients that they give."""
    import xarray as xr

    added, damping = memory.coefficients(omega)
    names = [f"unit {number + 1} {dof}" for number in range(at.row.count) for dof in _dofs(at)]
    pair = ("influenced_dof", "radiating_dof")
    data = xr.Dataset(
        {
            "memory_pole": ("pole", memory.poles),
            "memory_residue": (("pole", *pair), memory.residues),
            "infinite_frequency_added_mass": (pair, memory.infinite_added_mass),
            "added_mass": (("omega", *pair), added),
            "radiation_damping": (("omega", *pair), damping),
        },
        coords={
            "pole": np.arange(1, len(memory.poles) + 1), "omega": omega, "influenced_dof": names,
            "radiating_dof": names,
        },
    )  # fmt: skip
    data.attrs |= {"fit_error": memory.error, "fit_error_outside": memory.error_outside}
    return labelled(data)


def _dofs(at: RowAtLevel) -> list[str]:
    return list(coords_of(at)["dof"])


def run_numbers(given: SeaRun) -> Numbers:
    """Return the numbers of one run after its ramp, by their names."""
    run, part = given.run, given.kept
    at = run.model.at
    motions = run.position[part]
    motion = at.in_unit_axes(motions)
    mean, moves = _mean_and_reach(motion)
    loads = run.joint_loads[part]
    moved = np.array([_mean_and_reach(run.relative(joint)[part])[1] for joint in at.joints]).reshape(-1, 6)
    low, high = np.full(len(at.joints), np.nan), np.full(len(at.joints), np.nan)
    for link in at.links:
        elongation = link.elongation(motions)
        low[link.joint] = np.fmin(low[link.joint], elongation.min())
        high[link.joint] = np.fmax(high[link.joint], elongation.max())
    stretch = stretch_across(at.joints, moved[:, :3], high, in_time=True)
    tension = run.tension[part]
    closing = np.array([gap.largest(motions) for gap in gaps_of(at)])
    mean_loads = _mean(loads)
    most = np.maximum(_over_time(np.maximum, loads), -_over_time(np.minimum, loads))
    out: Numbers = {
        "mean_offset": (("unit", "dof"), mean),
        "largest_offset": (("unit",), _longest(motion[..., :2])),
        "maximum_motion": (("unit", "dof"), moves),
        "connector_force_mean": (_COMPONENT, mean_loads[:, :3]),
        "connector_moment_mean": (_COMPONENT, mean_loads[:, 3:]),
        "connector_force_largest": (_COMPONENT, most[:, :3]),
        "connector_moment_largest": (_COMPONENT, most[:, 3:]),
        "connector_resultant_largest": (_CONNECTOR, _longest(loads[..., :3])),
        "connector_moment_resultant_largest": (_CONNECTOR, _longest(loads[..., 3:])),
        "connector_damage_rate": (_CONNECTOR, _damage(at, run.time[part], loads)),
        "elongation_lowest": (_CONNECTOR, low),
        "elongation_highest": (_CONNECTOR, high),
        "stretch_across": (_CONNECTOR, stretch),
        "relative_motion_largest": (_COMPONENT, moved[:, :3]),
        "relative_turn_largest": (_COMPONENT, moved[:, 3:]),
        "gap_motion_largest": (_CONNECTOR, moved[:, 1]),
        "gap_closing_largest": (("gap",), closing),
        "line_tension_mean": (("line",), _mean(tension)),
        "line_tension_maximum": (("line",), _over_time(np.maximum, tension)),
        "line_tension_minimum": (("line",), _over_time(np.minimum, tension)),
        **{name: (("line",), values) for name, values in loads_of_record(at, motions, tension).items()},
    }
    out |= {name: ((), value) for name, value in meeting_variables(at, _mean(motions), closing).items()}
    if given.seed >= 0:
        out["significant_motion"] = (("unit", "dof"), 4.0 * motion.std(axis=0))
        out["significant_height"] = ((), np.asarray(4.0 * given.elevation[part].std()))
    else:
        turned = np.exp(1j * given.omega * run.time[part][:-1])
        harmonic = 2.0 * np.mean(motion[:-1] * turned[:, None, None], axis=0)
        out["motion_amplitude"] = (("unit", "dof"), np.abs(harmonic))
    return out


def _over_time(operation: np.ufunc, values: Array) -> Array:
    """Return a sum or an extreme over the first axis, many rows side by side: numpy goes slowly through short rows."""
    width = math.prod(values.shape[1:])
    if width == 0:
        return np.zeros(values.shape[1:])
    whole = len(values) // _SIDE_BY_SIDE * _SIDE_BY_SIDE
    folded = operation.reduce(values[:whole].reshape(-1, _SIDE_BY_SIDE * width), axis=0) if whole else []
    rows = np.concatenate([np.reshape(folded, (-1, *values.shape[1:])), values[whole:]])
    return np.asarray(operation.reduce(rows, axis=0))


def _mean(values: Array) -> Array:
    return _over_time(np.add, values) / len(values)


def _mean_and_reach(values: Array) -> tuple[Array, Array]:
    """Return the means over time, and how far values go from them either way."""
    mean = _mean(values)
    return mean, np.maximum(_over_time(np.maximum, values) - mean, mean - _over_time(np.minimum, values))


def _longest(vectors: Array) -> Array:
    """Return the greatest length over time of vectors (n, ..., k)."""
    return np.asarray(np.sqrt(np.einsum("n...k,n...k->n...", vectors, vectors).max(axis=0)))


def _damage(at: RowAtLevel, time: Array, loads: Array) -> Array:
    """Return the share of life (joints,) that a second of the run takes; NaN of connectors without endurance.

    Cycles of the component of force that varies most.
    """
    out = np.full(len(at.joints), np.nan)
    for number, joint in enumerate(at.joints):
        curve = joint.connector.endurance
        if curve is None:
            continue
        varied = loads[:, number, :3] - loads[:, number, :3].mean(axis=0)
        direction = np.linalg.eigh(varied.T @ varied)[1][:, -1]
        ranges, _, counts = count_cycles(loads[:, number, :3] @ direction)
        out[number] = damage(ranges, counts, curve) / (time[-1] - time[0])
    return out


@dataclass(frozen=True)
class KeptRun:
    """What is kept of a run: its numbers, its record, how it ended."""

    #: As :func:`run_numbers` gives them, means over the parts of a motion that does not repeat.
    numbers: Numbers
    series: xr.Dataset
    seed: int
    status: str
    message: str
    #: As of :class:`moyai.structures.units.time.seas.SeaRun`.
    contacts: bool
    #: Change of a regular motion by when it repeats, over its size, as of
    #: :class:`moyai.structures.units.time.seas.SeaRun`.
    change: float
    #: Growth of that change a period, 0 where it falls, as of the same.
    growth: float
    #: Numbers of each part of a motion that does not repeat; none of others.
    parts: tuple[Numbers, ...]

    @classmethod
    def of(cls, given: SeaRun) -> KeptRun:
        """Take the numbers and the record of a run."""
        run, parts = given.run, tuple(run_numbers(part) for part in given.parts)
        return cls(
            _together(parts), series_dataset(run.model.at, given), given.seed, run.status, run.message,
            given.contacts, given.change, given.growth, parts if len(parts) > 1 else (),
        )  # fmt: skip


def _together(members: Sequence[Numbers]) -> Numbers:
    """Return the mean of every number over runs, or the end of those that are bounds."""
    out = {}
    for name, (dims, _) in members[0].items():
        values = np.array([item[name][1] for item in members])
        over = values.min if name in _LOWEST else values.max if name in _HIGHEST else values.mean
        out[name] = (dims, np.asarray(over(axis=0)))
    return out


def regular_time_dataset(at: RowAtLevel, sea: RegularSea, runs: list[KeptRun]) -> xr.Dataset:
    """Return the numbers of regular waves, one entry a period."""
    import xarray as xr

    out = {
        name: (("period", *dims), np.array([item.numbers[name][1] for item in runs]))
        for name, (dims, _) in runs[0].numbers.items()
    }
    if any(item.parts for item in runs):
        for name in (name for name in _SCATTER if name in runs[0].numbers):
            blank = [runs[0].numbers[name][1] * np.nan] * PARTS
            values = [[part[name][1] for part in item.parts] if item.parts else blank for item in runs]
            dims = ("member", "period", *runs[0].numbers[name][0])
            out[f"{name}_of_realisation"] = (dims, np.swapaxes(np.array(values, dtype=float), 0, 1))
    coords = coords_of(at) | {"period": np.array(sea.periods[: len(runs)])}
    data = labelled(xr.Dataset(out, coords=coords))
    data.attrs |= {"kind": "regular", "heading": sea.heading, "status": status_of(runs)}
    return data


def irregular_time_dataset(at: RowAtLevel, sea: IrregularSea, runs: list[KeptRun]) -> xr.Dataset:
    """Return means over the realisations with what each gave."""
    import xarray as xr

    out: dict[str, Any] = dict(_together([item.numbers for item in runs]))
    for name in (name for name in _SCATTER if name in out):
        values = np.array([item.numbers[name][1] for item in runs])
        out[f"{name}_of_realisation"] = (("member", *out[name][0]), values)
    out["seed_of_realisation"] = ("member", np.array([item.seed for item in runs], dtype=np.int64))
    data = labelled(xr.Dataset(out, coords=coords_of(at)))
    data.attrs |= {
        "kind": "irregular", "heading": sea.heading, "duration": sea.duration, "realisations": len(runs),
        "seed": sea.seed, "shown_seed": runs[shown_run(runs)].seed, "status": status_of(runs),
    }  # fmt: skip
    return data


def status_of(runs: list[KeptRun]) -> str:
    """Return the worst status of the runs as results have it."""
    found = {item.status for item in runs}
    return "interrupted" if "interrupted" in found else "not_converged" if "diverged" in found else "converged"


def shown_run(runs: list[KeptRun]) -> int:
    """Return the number of the run whose largest load of a connector (tension, sway) is nearest to the mean."""

    def followed(item: KeptRun) -> float:
        for name in ("connector_resultant_largest", "line_tension_maximum", "largest_offset"):
            if item.numbers[name][1].size:
                return float(item.numbers[name][1].max())
        return 0.0

    values = np.array([followed(item) for item in runs])
    return int(np.abs(values - values.mean()).argmin())


def series_dataset(at: RowAtLevel, given: SeaRun) -> xr.Dataset:
    """Return the record of a run, thinned."""
    import xarray as xr

    run = given.run
    every = max(1, math.ceil(len(run.time) / MOST_ROWS))
    # rows of their own: a view would keep the whole run
    kept = np.arange(0, len(run.time), every)
    loads = run.joint_loads[kept]
    data = labelled(
        xr.Dataset(
            {
                "position": (("time", "unit", "dof"), at.in_unit_axes(run.position[kept])),
                "connector_force": (("time", "connector", "component"), loads[..., :3]),
                "connector_moment": (("time", "connector", "component"), loads[..., 3:]),
                "tension": (("time", "line"), run.tension[kept]),
                "surface_elevation": ("time", given.elevation[kept]),
                "wave_amplitude": ("wave", given.waves.amplitude),
                "wave_omega": ("wave", given.waves.omega),
                "wave_number": ("wave", given.waves.wave_number),
                "wave_heading": ("wave", given.waves.heading),
                "wave_phase": ("wave", given.waves.phase),
            },
            coords=coords_of(at) | {"time": run.time[kept]},
        )
    )
    data.attrs |= {"time_step": run.time_step, "status": run.status, "message": run.message, "seed": given.seed,
                   "analysis_start": given.begin, "ramp": given.ramp}  # fmt: skip
    return data
