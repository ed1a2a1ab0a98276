"""What a run of a network leaves behind: series of its lines and points, frames to look at, snaps of its lines."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from moyai.core.arrays import Array
from moyai.flexible.result import History
from moyai.flexible.sheets import sheet_stress
from moyai.series.snaps import SnapRecord, find_snaps
from moyai.structures.network.assembly import Assembly
from moyai.structures.network.bodies import CoupledRun
from moyai.structures.network.equilibrium import AXES, MEASURES, TURNS, highest_pulls, line_numbers, named_points, pulls
from moyai.structures.network.held_rows import held_pulls
from moyai.structures.network.model import NetworkProblem
from moyai.structures.network.noise import without_noise
from moyai.structures.network.resume import last_good_state
from moyai.structures.network.runs import RunPlan
from moyai.structures.network.variables import labelled

if TYPE_CHECKING:
    import xarray as xr


#: Values that a run may hold in memory, and those of the frames that it keeps.
MOST_VALUES, MOST_FRAME_VALUES = 80_000_000, 6_000_000


def kept_nodes(assembly: Assembly, rows: int) -> NDArray[np.int64]:
    """Return the nodes whose places a run keeps: all, or as many as fit besides the points and their neighbours.

    Long runs of large networks would fill the memory; lines are then drawn through fewer nodes.
    """
    network = assembly.network
    count = len(network.nodes)
    if rows * (3 * count + 2 * len(network.bars)) <= MOST_VALUES:
        return np.arange(count)
    _, points = named_points(assembly)
    near = np.isin(network.bars.start, points) | np.isin(network.bars.end, points)
    must = np.unique(np.concatenate([points, network.bars.start[near], network.bars.end[near]]))
    room = max(0, MOST_VALUES // (3 * rows) - must.size)
    rest = np.setdiff1d(np.arange(count), must)
    step = max(1, math.ceil(rest.size / max(room, 1)))
    return np.union1d(must, rest[::step]) if room else must


def series_of(assembly: Assembly, plan: RunPlan, history: History) -> xr.Dataset:
    import xarray as xr

    network, time = assembly.network, history.time
    names, nodes = named_points(assembly)
    place = np.searchsorted(history.nodes, nodes)
    position = _whole(network.nodes.position.shape[0], history)
    # the first row has no time before it
    highest = np.fmax(history.tension_peak, history.tension)
    data: dict[str, Any] = {
        "kinetic_energy": ("time", history.kinetic_energy),
        "elastic_energy": ("time", history.elastic_energy),
        "work": ("time", history.work),
        "point_position": (("time", "point", "axis"), history.position[:, place]),
        "point_load": (("time", "point", "axis"), pulls(network, nodes, position, history.tension)),
        "point_load_peak_since_row": (
            ("time", "point", "measure"), highest_pulls(network, nodes, position, history.tension, highest)
        ),
    }  # fmt: skip
    numbers = line_numbers(assembly, history.tension)
    if numbers:
        strands = list(assembly.lines.values())
        del numbers["line_tension_maximum"]  # of the rows alone
        numbers["line_tension_peak_since_row"] = np.stack([highest[:, s.bars].max(axis=1) for s in strands], axis=1)
        numbers["start_highest"] = np.stack([highest[:, s.bars[0]] for s in strands], axis=1)
        numbers["end_highest"] = np.stack([highest[:, s.bars[-1]] for s in strands], axis=1)
    for key, values in numbers.items():
        data[key] = (("time", "line"), values)
    if assembly.parts:
        own = [highest[:, strand.bars].max(axis=1) for strand in assembly.parts.values()]
        data["part_tension_peak_since_row"] = (("time", "part"), np.stack(own, axis=1))
    stretches = stretches_of(assembly)
    if stretches:
        own = [highest[:, bars].max(axis=1) for bars in stretches.values()]
        data["stretch_tension"] = (("time", "stretch"), np.stack(own, axis=1))
    if assembly.net_bars:
        data["net_tension"] = (
            ("time", "net"),
            np.stack([own.max(axis=1) for own in assembly.net_tensions(history.tension_peak)], axis=1),
            {"units": "N", "long_name": "highest tension in the net since the row before"},
        )
        held = held_pulls(network, assembly.net_bars, position, history.tension)
        if held is not None:
            data["held_pull"] = (("time", "net", "axis"), held)
    if plan.waves is not None:
        data["surface_elevation"] = ("time", plan.waves.elevation(time) * _grown(plan, time))
    out = labelled(
        xr.Dataset(
            data,
            coords={
                "time": time, "point": names, "line": list(assembly.lines), "axis": AXES,
                "net": list(assembly.net_bars), "measure": MEASURES,
                **({"part": list(assembly.parts)} if assembly.parts else {}),
                **({"stretch": list(stretches)} if stretches else {}),
            },
        )
    )  # fmt: skip
    out.attrs |= {
        "status": history.status, "message": history.message, "method": history.method, "step": history.step,
        "steps": history.steps, "period": plan.period, "wave_height": plan.wave_height, "heading": plan.heading,
        "irregular": int(plan.irregular), "theory": plan.theory, "seed": plan.seed, "duration": plan.duration,
        "growth": plan.growth,
    }  # fmt: skip
    return out


def stretches_of(assembly: Assembly) -> dict[str, NDArray[np.int64]]:
    """Return the bars of the stretches of one type of lines that have several, in order along the line."""
    out: dict[str, NDArray[np.int64]] = {}
    for name, strand in assembly.lines.items():
        changes = np.flatnonzero(np.diff(assembly.network.bars.kind[strand.bars])) + 1
        if changes.size:
            own = np.split(strand.bars, changes)
            out |= {f"{name} stretch {number}": bars for number, bars in enumerate(own, 1)}
    return out


def _grown(plan: RunPlan, time: Array) -> Array:
    ramp = plan.flow.ramp or plan.flow.wave_ramp
    return np.where(time < ramp, 0.5 * (1.0 - np.cos(np.pi * time / ramp)), 1.0) if ramp > 0.0 else np.ones_like(time)


def _whole(count: int, history: History) -> Array:
    """Return places with a column for every node; those that were not kept are not a number."""
    if history.nodes.size == count:
        return history.position
    out = np.full((history.time.size, count, 3), np.nan)
    out[:, history.nodes] = history.position
    return out


def frames_of(plan: RunPlan, history: History) -> xr.Dataset:
    """Return places and tensions at as many evenly spaced times as should be stored, the moment of the peak among
    them."""
    import xarray as xr

    rows, per_row = history.time.size, 3 * history.nodes.size + history.bars.size
    step = max(1, math.ceil(rows * per_row / MOST_FRAME_VALUES))
    chosen = np.arange(0, rows, step)
    if history.tension.size:
        highest = np.nan_to_num(history.tension_peak).max(axis=1)
        chosen = np.union1d(chosen, [int(np.argmax(highest)), rows - 1])
    last = last_good_state(history)
    # the highest since the row before: a snap between two rows must show
    shown = np.maximum(history.tension, np.nan_to_num(history.tension_peak))
    with np.errstate(over="ignore"):  # of a run that blew up
        places, pulled = history.position[chosen].astype(np.float32), shown[chosen].astype(np.float32)
    data: dict[str, Any] = {
        "position": (("frame", "node", "axis"), places),
        "tension": (("frame", "bar"), pulled),
        "final_position": (("every_node", "axis"), last.position, {"units": "m", "long_name": "last state"}),
        "final_velocity": (
            ("every_node", "axis"), last.velocity, {"units": "m/s", "long_name": "velocity of the last state"},
        ),
    }  # fmt: skip
    coords: dict[str, Any] = {"frame": history.time[chosen], "axis": AXES, "node": history.nodes, "bar": history.bars}
    sheets = history.network.sheets
    if sheets is not None and history.nodes.size == len(history.network.nodes):
        first = np.array([sheet_stress(sheets, place).first for place in history.position[chosen]])
        data["sheet_tension"] = (("frame", "triangle"), np.maximum(first, 0.0).astype(np.float32))
    waves = plan.waves
    if waves is not None:
        for name, values in (
            ("wave_amplitude", waves.amplitude), ("wave_omega", waves.omega), ("wave_number", waves.wave_number),
            ("wave_heading", waves.heading), ("wave_phase", waves.phase),
        ):  # fmt: skip
            data[name] = ("wave", np.asarray(values))
    out = labelled(xr.Dataset(data, coords=coords))
    out.attrs |= {"final_time": last.time, "ramp": plan.flow.ramp or plan.flow.wave_ramp}
    return out


def with_bodies(series: xr.Dataset, frames: xr.Dataset, coupled: CoupledRun) -> tuple[xr.Dataset, xr.Dataset]:
    """Add places and angles of the bodies to the rows, and their axes to the frames."""
    names, found = list(coupled.bodies), list(coupled.bodies.values())
    # a run that blew up keeps its sound rows alone
    size = series.sizes["time"]
    place = np.stack([body.position for body in found], axis=1)[:size]
    angle = np.stack([body.angles for body in found], axis=1)[:size]
    turn = np.stack([body.rotation for body in found], axis=1)[:size]
    first = float(np.nanmax(np.abs(frames["position"].values[0]), initial=0.0))
    place, angle = without_noise(place, first), without_noise(angle, 1.0)
    rows = np.searchsorted(series["time"].values, frames["frame"].values).clip(0, place.shape[0] - 1)
    series = series.assign(
        {"solid_position": (("time", "solid", "axis"), place), "solid_angle": (("time", "solid", "turn"), angle)}
    ).assign_coords(solid=names, turn=TURNS)
    frames = frames.assign(
        {"solid_position": (("frame", "solid", "axis"), place[rows]),
         "solid_rotation": (("frame", "solid", "axis", "body_axis"), turn[rows])}
    ).assign_coords(solid=names, body_axis=AXES)  # fmt: skip
    return labelled(series), labelled(frames)


def snaps_of(problem: NetworkProblem, series: xr.Dataset) -> dict[str, SnapRecord]:
    """Find slack and snaps of every line from its least and its highest tension."""
    if "line_tension_peak_since_row" not in series:
        return {}
    settings, found = problem.settings, {}
    time = series["time"].values
    chosen = time >= time[0] + series.attrs["skip"]
    if chosen.sum() < 2:
        return {}
    for name in series["line"].values:
        highest = series["line_tension_peak_since_row"].sel(line=name).values[chosen]
        # the more loaded end shows whether the line is slack; the other one may lie on the bed
        ends = [series[key].sel(line=name).values[chosen] for key in ("start_tension", "end_tension")]
        record = max(ends, key=lambda values: float(np.nanmean(values)))
        # a heavy end stays taut over a light stretch that goes slack
        held = [series["stretch_tension"].sel(stretch=own).values[chosen] for own in _own_stretches(series, str(name))]
        slackest = min(held, key=lambda values: float(values.min()), default=record)
        if float(slackest.min()) <= settings.slack_level < float(record.min()):
            record = slackest
        if not (np.isfinite(highest).all() and np.isfinite(record).all()):
            continue
        taut = record[record > settings.slack_level]
        threshold = settings.snap_threshold or (float(taut.mean()) if taut.size else 1.0)
        found[str(name)] = find_snaps(
            time[chosen], record, slack_level=settings.slack_level, threshold=max(threshold, settings.slack_level),
            peaks=highest,
        )  # fmt: skip
    return found


def _own_stretches(series: xr.Dataset, line: str) -> list[str]:
    names = [] if "stretch_tension" not in series else [str(name) for name in series["stretch"].values]
    return [name for name in names if name.rpartition(" stretch ")[0] == line]


def utilisations(problem: NetworkProblem, series: xr.Dataset, chosen: NDArray[np.bool_]) -> dict[str, float]:
    """Return the highest tension over the breaking load by line: of parts that differ in strength, the worst.

    Not a number where a breaking load is not known.
    """
    out = {}
    for line in problem.lines:
        uses = [math.nan]
        for name, load in line.strengths.items() if chosen.any() else ():
            kind = "line" if name == line.name else "part"
            record = series[f"{kind}_tension_peak_since_row"].sel({kind: name}).values[chosen]
            uses.append(float(np.fmax.reduce(record)) / load)
        out[line.name] = float(np.fmax.reduce(uses))
    return out
