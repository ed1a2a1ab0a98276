"""Runs of a network through time: series of lines and points, snaps, what the peaks are worth, frames to look at."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from moyai.core.errors import ConvergenceError, InputError
from moyai.core.progress import Progress, silent
from moyai.core.validity import IdentityCheck, Notice
from moyai.flexible.result import History, State
from moyai.flexible.sensitivity import PeakSensitivity, peak_sensitivity
from moyai.flexible.sheets import sheet_stress
from moyai.flexible.simulate import simulate
from moyai.flexible.snap import SnapRecord, find_snaps
from moyai.network.assembly import Assembly
from moyai.network.bodies import CoupledRest, CoupledRun, coupled_sensitivity, run_coupled
from moyai.network.model import NetworkProblem
from moyai.network.rest import AXES, MEASURES, TURNS, highest_pulls, line_numbers, named_points, pulls
from moyai.network.resume import Earlier, joined, last_good_state
from moyai.network.runs import RunPlan, motions_of
from moyai.network.variables import labelled

if TYPE_CHECKING:
    import xarray as xr

Array = NDArray[np.float64]

#: Values that a run may hold in memory, and those of the frames that it keeps.
MOST_VALUES, MOST_FRAME_VALUES = 80_000_000, 6_000_000
#: Highest tension over that at the ends of its line, from which a run says that it stands inside.
INSIDE = 1.2
#: Loads on points in the summary, in the order of the measures of :func:`moyai.network.rest.highest_pulls`.
LOADS = ("load_peak", "load_horizontal", "load_upwards", "load_downwards")


@dataclass(frozen=True, eq=False)
class Run:
    """A run and what is told of it.

    Parameters
    ----------
    plan : RunPlan
    history : History
    series, frames : xarray.Dataset
        Time series of lines and points; places of all nodes and tensions of all bars at fewer times.
    snaps : mapping of str to SnapRecord
        By line.
    sensitivity : PeakSensitivity or None
        Of the line with the highest tension.
    governing : str
        That line.
    notices, checks : tuple
    """

    plan: RunPlan
    history: History
    series: xr.Dataset
    frames: xr.Dataset
    snaps: Mapping[str, SnapRecord]
    sensitivity: PeakSensitivity | None
    governing: str
    notices: tuple[Notice, ...]
    checks: tuple[IdentityCheck, ...]


def options_of(problem: NetworkProblem, plan: RunPlan) -> dict[str, Any]:
    """Return the arguments of :func:`moyai.flexible.simulate.simulate` for a run."""
    settings = problem.settings
    method = "explicit" if settings.method == "auto" else settings.method
    return {
        "duration": plan.duration,
        "output_step": plan.output_step,
        "flow": plan.flow,
        "method": method,
        "step": settings.step,
        "safety": 1.0 if settings.wave_front and method == "explicit" else None,
        "tolerance": settings.tolerance,
    }


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


def run(
    problem: NetworkProblem,
    assembly: Assembly,
    plan: RunPlan,
    begin: State,
    progress: Progress = silent,
    earlier: Earlier | None = None,
    hung: CoupledRest | None = None,
) -> Run:
    """Run a network through time and gather what is told of it.

    Parameters
    ----------
    problem : NetworkProblem
    assembly : Assembly
    plan : RunPlan
    begin : State
        Where it starts.
    progress : Progress
    earlier : Earlier, optional
        Rows of the same run up to ``begin``.
    hung : CoupledRest, optional
        Bodies and network at rest, where a run with bodies starts; as built when left out.

    Raises
    ------
    InputError
        When a table of motion ends before the run.
    """
    network = assembly.network
    motions = motions_of(problem, plan.duration)
    nodes = kept_nodes(assembly, round(plan.duration / plan.output_step) + 1)

    def told(what: str, done: float, total: float) -> None:
        progress(plan.name, done, total)

    options = {**options_of(problem, plan), "duration": plan.duration - begin.time}
    coupled: CoupledRun | None = None
    if problem.bodies:
        options = _of_bodies(options)
        coupled = run_coupled(problem, network, hung, told, motions=motions, keep_nodes=nodes, **options)
        history = coupled.history
    else:
        history = simulate(network, motions, start=begin, progress=told, keep_nodes=nodes, **options)
    progress(plan.name, 1.0, 1.0)
    if history.status == "not_converged":
        history = sound_rows(history)
    series, frames = _series(assembly, plan, history), _frames(plan, history)
    if coupled is not None:
        series, frames = _with_bodies(series, frames, coupled)
    series.attrs["skip"] = problem.settings.skip
    if earlier is not None:
        series, frames = joined(earlier.series, series, "time"), joined(earlier.frames, frames, "frame")
    snaps = _snaps(problem, series)
    governing, worst = _governing(assembly, history, problem.settings.skip)
    sensitivity, notices = None, [*history.notices, *_run_notices(problem, history, plan, snaps)]
    notices += _inside(assembly, series, governing, worst)
    if problem.settings.sensitivity and history.status == "converged" and worst >= 0 and earlier is None:
        try:
            if coupled is not None:
                counted = history.time >= history.time[0] + problem.settings.skip
                peak = float(np.nanmax(history.peak_at(worst)[counted]))
                sensitivity = coupled_sensitivity(
                    problem, network, hung, worst, problem.settings.skip, peak, history.step, told, motions=motions,
                    **options,
                )  # fmt: skip
            else:
                sensitivity = _sensitivity(problem, assembly, plan, begin, worst, progress)
            notices += list(sensitivity.notices())
        except (ConvergenceError, InputError) as error:
            notices.append(
                Notice("sensitivity-failed", f"{plan.name}: {error.fault.message}", remedy=error.fault.remedy)
            )
    prefix = f"{plan.name}: "
    return Run(
        plan, history, series, frames, snaps, sensitivity, governing,
        tuple(replace(notice, message=f"{prefix}{notice.message}") for notice in notices),
        tuple(replace(check, name=f"{prefix}{check.name}") for check in history.checks),
    )  # fmt: skip


def sound_rows(history: History) -> History:
    """Return a run that blew up without what came after its last good state: no peak may be told from there."""
    good = int(np.count_nonzero(history.time <= last_good_state(history).time * (1.0 + 1e-12)))
    rows = ("time", "position", "tension", "tension_peak", "kinetic_energy", "elastic_energy", "work")
    cut = {name: getattr(history, name)[: max(good, 1)] for name in rows}
    return replace(history, **cut)


def _of_bodies(options: dict[str, Any]) -> dict[str, Any]:
    """Return the options that runs with bodies know: they have one method and a tolerance of their own."""
    return {key: value for key, value in options.items() if key not in ("method", "tolerance")}


def _with_bodies(series: xr.Dataset, frames: xr.Dataset, coupled: CoupledRun) -> tuple[xr.Dataset, xr.Dataset]:
    """Add places and angles of the bodies to the rows, and their axes to the frames."""
    names, found = list(coupled.bodies), list(coupled.bodies.values())
    place = np.stack([body.position for body in found], axis=1)
    angle = np.stack([body.angles for body in found], axis=1)
    turn = np.stack([body.rotation for body in found], axis=1)
    rows = np.searchsorted(series["time"].values, frames["frame"].values).clip(0, place.shape[0] - 1)
    series = series.assign(
        {"solid_position": (("time", "solid", "axis"), place), "solid_angle": (("time", "solid", "turn"), angle)}
    ).assign_coords(solid=names, turn=TURNS)
    frames = frames.assign(
        {"solid_position": (("frame", "solid", "axis"), place[rows]),
         "solid_rotation": (("frame", "solid", "axis", "body_axis"), turn[rows])}
    ).assign_coords(solid=names, body_axis=AXES)  # fmt: skip
    return labelled(series), labelled(frames)


def _sensitivity(
    problem: NetworkProblem, assembly: Assembly, plan: RunPlan, begin: State, bar: int, progress: Progress
) -> PeakSensitivity:
    def told(what: str, done: float, total: float) -> None:
        progress(f"{plan.name}, what the peak is worth", done, total)

    # built anew, the finer network may drop what its materials gathered: the plain call refines the network itself
    return peak_sensitivity(
        assembly.network, motions_of(problem, plan.duration), bar=bar, after=problem.settings.skip, start=begin,
        progress=told, **options_of(problem, plan),
    )  # fmt: skip


def _governing(assembly: Assembly, history: History, skip: float) -> tuple[str, int]:
    """Return the line or net with the highest tension, and its bar."""
    chosen = history.time >= history.time[0] + skip
    if not chosen.any() or history.tension_peak.shape[1] == 0:
        return "", -1
    peaks = np.nan_to_num(history.tension_peak[chosen], nan=-np.inf).max(axis=0)
    bar = int(history.bars[int(np.argmax(peaks))])
    for name, strand in assembly.lines.items():
        if bar in strand.bars:
            return name, bar
    for name, bars in assembly.net_bars.items():
        if bar in bars:
            return name, bar
    return "", bar


def _series(assembly: Assembly, plan: RunPlan, history: History) -> xr.Dataset:
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
        "load": (("time", "point", "axis"), pulls(network, nodes, position, history.tension)),
        "highest_load": (
            ("time", "point", "measure"), highest_pulls(network, nodes, position, history.tension, highest)
        ),
    }  # fmt: skip
    numbers = line_numbers(assembly, history.tension)
    if numbers:
        strands = list(assembly.lines.values())
        numbers["line_tension"] = np.stack([highest[:, s.bars].max(axis=1) for s in strands], axis=1)
        numbers["start_highest"] = np.stack([highest[:, s.bars[0]] for s in strands], axis=1)
        numbers["end_highest"] = np.stack([highest[:, s.bars[-1]] for s in strands], axis=1)
    for key, values in numbers.items():
        data[key] = (("time", "line"), values)
    if assembly.net_bars:
        data["net_tension"] = (
            ("time", "net"),
            np.stack([history.tension_peak[:, bars].max(axis=1) for bars in assembly.net_bars.values()], axis=1),
            {"units": "N", "long_name": "highest tension in the net since the row before"},
        )
    if plan.waves is not None:
        data["surface_elevation"] = ("time", plan.waves.elevation(time) * _grown(plan, time))
    out = labelled(
        xr.Dataset(
            data,
            coords={
                "time": time, "point": names, "line": list(assembly.lines), "axis": AXES,
                "net": list(assembly.net_bars), "measure": MEASURES,
            },
        )
    )  # fmt: skip
    out.attrs |= {
        "status": history.status, "message": history.message, "method": history.method, "step": history.step,
        "steps": history.steps, "period": plan.period, "wave_height": plan.wave_height, "heading": plan.heading,
        "irregular": int(plan.irregular), "seed": plan.seed, "duration": plan.duration,
    }  # fmt: skip
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


def _frames(plan: RunPlan, history: History) -> xr.Dataset:
    """Return places and tensions at as many evenly spaced times as are worth storing, the moment of the peak among
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


def _snaps(problem: NetworkProblem, series: xr.Dataset) -> dict[str, SnapRecord]:
    """Find slack and snaps of every line from its least and its highest tension."""
    if "line_tension" not in series:
        return {}
    settings, found = problem.settings, {}
    time = series["time"].values
    chosen = time >= time[0] + settings.skip
    if chosen.sum() < 2:
        return {}
    for name in series["line"].values:
        highest = series["line_tension"].sel(line=name).values[chosen]
        # the more loaded end tells whether the line is slack; the other one may lie on the bed
        ends = [series[key].sel(line=name).values[chosen] for key in ("start_tension", "end_tension")]
        record = max(ends, key=lambda values: float(np.nanmean(values)))
        if not (np.isfinite(highest).all() and np.isfinite(record).all()):
            continue
        taut = record[record > settings.slack_level]
        threshold = settings.snap_threshold or (float(taut.mean()) if taut.size else 1.0)
        found[str(name)] = find_snaps(
            time[chosen], record, slack_level=settings.slack_level, threshold=max(threshold, settings.slack_level),
            peaks=highest,
        )  # fmt: skip
    return found


def _run_notices(
    problem: NetworkProblem, history: History, plan: RunPlan, snaps: Mapping[str, SnapRecord]
) -> list[Notice]:
    notices = []
    rise = min((contact.rise_time for record in snaps.values() for contact in record.snaps), default=math.inf)
    if rise < 3.0 * plan.output_step:
        notices.append(
            Notice("rows-too-far-apart", "slack, contacts and rise times are found at the rows, too far apart for "
                   "the shortest rise; peaks are taken at every step", plan.output_step, rise / 3.0, "warning",
                   "shorten settings.output_step")
        )  # fmt: skip
    if history.nodes.size < len(history.network.nodes):
        notices.append(
            Notice(
                "nodes-left-out",
                f"{history.nodes.size} of {len(history.network.nodes)} nodes were kept; the view draws those",
                severity="information",
                remedy="a shorter run or a longer output step keeps all",
            )
        )
    if problem.settings.skip >= plan.duration:
        notices.append(
            Notice("nothing-counted", f"settings.skip of {problem.settings.skip:g} s leaves nothing of the run",
                   problem.settings.skip, plan.duration, "warning", "lower settings.skip")
        )  # fmt: skip
    return notices


def _inside(assembly: Assembly, series: xr.Dataset, name: str, bar: int) -> list[Notice]:
    """Say when the highest tension stands inside a line whose ends bear much less."""
    if name not in assembly.lines:
        return []
    time = series["time"].values
    own = series.sel(line=name).isel(time=time >= time[0] + series.attrs["skip"])
    peak = float(np.nanmax(own["line_tension"]))
    ends = [float(np.nanmax(own[key])) for key in ("start_highest", "end_highest")]
    if not peak > INSIDE * max(ends):
        return []
    strand = assembly.lines[name]
    lengths = assembly.network.bars.length[strand.bars]
    row = int(np.flatnonzero(strand.bars == bar)[0])
    place = float(np.sum(lengths[:row]) + 0.5 * lengths[row])
    return [
        Notice(
            "peak-inside", f"the highest tension of '{name}' stands {place:.4g} m from its start, a slack stretch that "
            f"is pulled straight or falls on the bed: {peak:.4g} N there, {ends[0]:.4g} N at its start and "
            f"{ends[1]:.4g} N at its end", peak, INSIDE * max(ends), "warning",
            "take the tension at the ends for anchors and fairleads; so short an impact hangs on the internal damping: "
            "see settings.sensitivity",
        )
    ]  # fmt: skip


def summary_dataset(problem: NetworkProblem, assembly: Assembly, runs: list[Run], rest: Array | None) -> xr.Dataset:
    """Return peaks, snaps and loads of every run.

    Parameters
    ----------
    problem, assembly
    runs : list of Run
    rest : ndarray, shape (points, 3), or None
        Places of the points at rest, from which excursions count [m].
    """
    import xarray as xr

    lines, (names, _) = list(assembly.lines), named_points(assembly)
    data: dict[str, Any] = {}
    rows: dict[str, list[Any]] = {}
    for item in runs:
        for key, value in _line_summary(problem, item, lines).items():
            rows.setdefault(key, []).append(value)
        for key, value in _point_summary(problem, item, names, rest).items():
            data.setdefault(key, []).append(value)
    out: dict[str, Any] = {key: (("run", "line"), np.array(value)) for key, value in rows.items() if lines}
    out |= {key: (("run", "point"), np.array(value)) for key, value in data.items() if names}
    known = [item for item in runs if item.sensitivity is not None]
    if known:
        for key in (
            "peak", "half_step", "double_mesh", "half_viscosity", "double_viscosity", "discretisation_error",
            "viscosity_effect",
        ):  # fmt: skip
            label = "sensitivity_peak" if key == "peak" else key
            values = [getattr(item.sensitivity, key) if item.sensitivity else math.nan for item in runs]
            out[label] = ("run", np.array(values))
    coords = {"run": [item.plan.name for item in runs], "line": lines, "point": names}
    made = labelled(xr.Dataset(out, coords=coords))
    made.attrs |= {f"governing {item.plan.name}": item.governing for item in runs}
    return made


def _counted(problem: NetworkProblem, item: Run) -> NDArray[np.bool_]:
    time = item.series["time"].values
    return np.asarray(time >= time[0] + problem.settings.skip)


def _line_summary(problem: NetworkProblem, item: Run, lines: list[str]) -> dict[str, list[float]]:
    chosen = _counted(problem, item)
    breaking = {line.name: line.breaking_load for line in problem.lines}
    keys = (
        "peak", "peak_time", "start_peak", "end_peak", "mean", "deviation", "utilisation", "slack_time", "slack_share",
        "contacts", "snaps", "snap_threshold", "largest_snap", "shortest_rise",
    )  # fmt: skip
    out: dict[str, list[float]] = {key: [] for key in keys}
    time = item.series["time"].values[chosen]
    for name in lines:
        record = item.series["line_tension"].sel(line=name).values[chosen] if chosen.any() else np.zeros(0)
        snaps = item.snaps.get(name)
        if record.size == 0 or not np.isfinite(record).any():
            for key in keys:
                out[key].append(math.nan)
            continue
        at = int(np.nanargmax(record))
        ends = [item.series[key].sel(line=name).values[chosen] for key in ("start_tension", "end_tension")]
        pull = max(ends, key=lambda values: float(np.nanmean(values)))
        most = {key: item.series[key].sel(line=name).values[chosen] for key in ("start_highest", "end_highest")}
        values = {
            "peak": float(record[at]), "peak_time": float(time[at]),
            "start_peak": float(np.nanmax(most["start_highest"])), "end_peak": float(np.nanmax(most["end_highest"])),
            "mean": float(np.nanmean(pull)), "deviation": float(np.nanstd(pull)),
            "utilisation": float(record[at]) / breaking[name],
        }  # fmt: skip
        if snaps is not None:
            peaks = [contact.peak for contact in snaps.snaps]
            values |= {
                "slack_time": snaps.slack_time, "slack_share": snaps.slack_time / max(float(np.ptp(time)), 1e-300),
                "contacts": float(len(snaps.contacts)), "snaps": float(len(peaks)),
                "snap_threshold": snaps.threshold, "largest_snap": max(peaks, default=math.nan),
                "shortest_rise": min((contact.rise_time for contact in snaps.snaps), default=math.nan),
            }  # fmt: skip
        for key in keys:
            out[key].append(values.get(key, math.nan))
    return out


def _point_summary(problem: NetworkProblem, item: Run, names: list[str], rest: Array | None) -> dict[str, list[float]]:
    chosen = _counted(problem, item)
    out: dict[str, list[float]] = {key: [] for key in (*LOADS, "excursion")}
    for number, name in enumerate(names):
        load = item.series["highest_load"].sel(point=name).values[chosen]
        place = item.series["point_position"].sel(point=name).values[chosen]
        if load.size == 0 or not np.isfinite(load).any():
            for key in out:
                out[key].append(math.nan)
            continue
        for key, highest in zip(LOADS, np.nanmax(load, axis=0), strict=True):
            out[key].append(float(highest))
        origin = rest[number] if rest is not None else place[0]
        out["excursion"].append(float(np.nanmax(np.linalg.norm(place - origin, axis=1))))
    return out


def contacts_dataset(item: Run) -> xr.Dataset | None:
    """Return every time that a slack line came taut in a run, ``None`` where none did."""
    import xarray as xr

    rows = [(name, contact) for name, record in item.snaps.items() for contact in record.contacts]
    if not rows:
        return None
    return labelled(
        xr.Dataset(
            {
                "contact_line": ("contact", np.array([name for name, _ in rows], dtype=object)),
                "contact_time": ("contact", np.array([contact.time for _, contact in rows])),
                "contact_slack": ("contact", np.array([contact.slack_before for _, contact in rows])),
                "contact_peak": ("contact", np.array([contact.peak for _, contact in rows])),
                "contact_rise": ("contact", np.array([contact.rise_time for _, contact in rows])),
                "is_snap": (
                    "contact", np.array([contact.is_snap for _, contact in rows]),
                    {"units": "1", "long_name": "whether the peak exceeds the threshold"},
                ),
            },
            coords={"contact": np.arange(1, len(rows) + 1)},
        )
    )  # fmt: skip
