"""Peaks, snaps and loads of every run of a network, and every time that a slack line came taut."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from moyai.core.arrays import Array
from moyai.structures.network.assembly import Assembly
from moyai.structures.network.bodies import lean_of
from moyai.structures.network.equilibrium import MEASURES, named_points
from moyai.structures.network.model import NetworkProblem
from moyai.structures.network.noise import without_noise
from moyai.structures.network.series import utilisations
from moyai.structures.network.variables import labelled

if TYPE_CHECKING:
    import xarray as xr

    from moyai.structures.network.dynamics import NetworkRun


#: Loads on points in the summary, in the order of :func:`moyai.structures.network.equilibrium.highest_pulls`.
LOADS = (
    "point_load_maximum",
    "point_horizontal_load_maximum",
    "point_upward_load_maximum",
    "point_downward_load_maximum",
)
#: Highest pulls on fixed points in the runs that check the mesh, and where they are found there.
LOADS_AGAIN = {
    "point_load_half_step": "half_step", "point_load_double_mesh": "double_mesh", "point_load_damped": "damped",
    "point_load_finest": "finest",
}  # fmt: skip
#: Runs that check the mesh, and where their peaks are found.
CHECKS = {"the run itself": "peak", **{key: key for key in LOADS_AGAIN.values()}}
#: Largest values of realisations in the summary, by their names in :class:`Realisations`, and their dimensions.
OF_REALISATIONS = {
    "seeds": ("seed_of_realisation", ()),
    "tension": ("line_tension_maximum_of_realisation", ("line",)),
    "part_tension": ("part_tension_maximum_of_realisation", ("part",)),
    "net_tension": ("net_tension_maximum_of_realisation", ("net",)),
    "load": ("point_load_maximum_of_realisation", ("point", "measure")),
    "excursion": ("point_excursion_of_realisation", ("point",)),
    "reach": ("distance_from_anchor_of_realisation", ("point",)),
}  # fmt: skip
#: Motions of bodies in the summary.
SOLID = ("largest_offset", "mean_offset", "heave_range", "roll_range", "pitch_range", "yaw_range", "highest_lean")


def summary_dataset(
    problem: NetworkProblem,
    assembly: Assembly,
    runs: list[NetworkRun],
    rest: Array | None,
    solids_at_rest: Array | None = None,
) -> xr.Dataset:
    """Return peaks, snaps and loads of every run.

    Parameters
    ----------
    problem, assembly
    runs : list of Run
    rest : ndarray, shape (points, 3), or None
        Places of the points at rest in still water, from which excursions count [m].
    solids_at_rest : ndarray, shape (bodies, 3), or None
        The same of bodies; where they begin when left out.
    """
    import xarray as xr

    lines, (names, _) = list(assembly.lines), named_points(assembly)
    data: dict[str, Any] = {}
    rows: dict[str, list[Any]] = {}
    by_part: dict[str, list[Any]] = {}
    for item in runs:
        for key, value in _line_summary(problem, item, lines).items():
            rows.setdefault(key, []).append(value)
        for key, of_parts in _part_summary(item).items():
            by_part.setdefault(key, []).append(of_parts)
        for key, value in _point_summary(item, names, rest).items():
            data.setdefault(key, []).append(value)
    out: dict[str, Any] = {key: (("run", "line"), np.array(value)) for key, value in rows.items() if lines}
    out |= {key: (("run", "part"), np.array(value)) for key, value in by_part.items()}
    out |= {key: (("run", "point"), np.array(value)) for key, value in data.items() if names}
    solids = [body.name for body in problem.bodies]
    for item in runs if solids else ():
        for key, found in _solid_summary(item, solids_at_rest).items():
            out.setdefault(key, (("run", "solid"), []))[1].append(found)
    known = [item for item in runs if item.sensitivity is not None]
    if known:
        for key in (
            "peak", "half_step", "double_mesh", "half_viscosity", "double_viscosity", "discretisation_error",
            "viscosity_effect", "damped", "finest",
        ):  # fmt: skip
            label = "sensitivity_peak" if key == "peak" else key
            values = [getattr(item.sensitivity, key) if item.sensitivity else math.nan for item in runs]
            out[label] = ("run", np.array(values))
        for label, key in LOADS_AGAIN.items() if names else ():
            pulls: list[dict[str, Any]] = [dict(item.sensitivity.pulls) if item.sensitivity else {} for item in runs]
            values = [[getattr(own.get(name), key, math.nan) for name in names] for own in pulls]
            out[label] = (("run", "point"), np.array(values))
        out |= _of_checks(runs, {"line": lines, "part": list(assembly.parts), "net": list(assembly.net_bars)})
    out |= _of_realisations(runs)
    if rest is not None and names:
        out["still_place"] = (("point", "axis"), np.asarray(rest))
    if solids_at_rest is not None and solids:
        out["still_place_of_solid"] = (("solid", "axis"), np.asarray(solids_at_rest)[:, :3])
    coords: dict[str, Any] = {"run": [item.plan.name for item in runs], "line": lines, "point": names}
    if solids:
        coords["solid"] = solids
    if assembly.parts:
        coords["part"] = list(assembly.parts)
    if any("check" in dims for dims, _ in out.values()):
        coords["check"] = list(CHECKS)
    if "point_load_maximum_of_realisation" in out:
        coords["measure"] = MEASURES
    if {"net_tension_maximum_of_realisation", "net_tension_of_check", "held_pull_of_check"} & out.keys():
        coords["net"] = list(assembly.net_bars)
    made = labelled(xr.Dataset(out, coords=coords))
    made.attrs |= {f"governing {item.plan.name}": item.governing for item in runs}
    made.attrs |= {f"doubt {item.plan.name}": item.doubt for item in runs}
    made.attrs["finer_nets"] = int(problem.gathers_twines)
    made.attrs |= {f"few {name}": said for item in runs for name, said in item.few_bars.items()}
    return made


def _of_checks(runs: list[NetworkRun], names: dict[str, list[str]]) -> dict[str, Any]:
    """Return the highest tension of every line and net in the runs that check the mesh; not a number where none did."""
    out: dict[str, Any] = {}
    for kind, of_kind in names.items():
        values = np.full((len(runs), len(of_kind), len(CHECKS)), math.nan)
        for row, item in enumerate(runs):
            for column, name in enumerate(of_kind):
                found = None if item.sensitivity is None else item.sensitivity.lines.get(name)
                if found is not None:
                    values[row, column] = [getattr(found, key) for key in CHECKS.values()]
        if np.isfinite(values).any():
            out[f"{kind}_tension_of_check"] = (("run", kind, "check"), values)
    held = np.full((len(runs), len(names["net"]), len(CHECKS)), math.nan)
    for row, item in enumerate(runs):
        for name, one in item.sensitivity.held.items() if item.sensitivity is not None else ():
            held[row, names["net"].index(name)] = [getattr(one, key) for key in CHECKS.values()]
    if np.isfinite(held).any():
        out["held_pull_of_check"] = (("run", "net", "check"), held)
    return out


def _of_realisations(runs: list[NetworkRun]) -> dict[str, Any]:
    """Return the largest values of the realisations of every sea; not a number where there are fewer."""
    most = max((item.realisations.seeds.size for item in runs if item.realisations is not None), default=0)
    if not most:
        return {}
    out: dict[str, Any] = {}
    for key, (name, dims) in OF_REALISATIONS.items():
        shape = next(getattr(item.realisations, key).shape[1:] for item in runs if item.realisations is not None)
        values = np.full((len(runs), most, *shape), np.nan)
        for row, item in enumerate(runs):
            if item.realisations is not None:
                values[row, : item.realisations.seeds.size] = getattr(item.realisations, key)
        if values.size:
            out[name] = (("run", "member", *dims), values)
    return out


def _counted(item: NetworkRun) -> NDArray[np.bool_]:
    time = item.series["time"].values
    return np.asarray(time >= time[0] + item.series.attrs["skip"])


def _line_summary(problem: NetworkProblem, item: NetworkRun, lines: list[str]) -> dict[str, list[float]]:
    chosen = _counted(item)
    keys = (
        "line_tension_maximum", "peak_time", "start_peak", "end_peak", "line_tension_mean", "deviation", "utilisation",
        "slack_time", "slack_share", "contact_count", "snap_count", "snap_threshold", "largest_snap",
        "shortest_rise_time",
    )  # fmt: skip
    out: dict[str, list[float]] = {key: [] for key in keys}
    time = item.series["time"].values[chosen]
    used = utilisations(problem, item.series, chosen)
    for name in lines:
        record = (
            item.series["line_tension_peak_since_row"].sel(line=name).values[chosen] if chosen.any() else np.zeros(0)
        )
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
            "line_tension_maximum": float(record[at]), "peak_time": float(time[at]),
            "start_peak": float(np.nanmax(most["start_highest"])), "end_peak": float(np.nanmax(most["end_highest"])),
            "line_tension_mean": float(np.nanmean(pull)), "deviation": float(np.nanstd(pull)),
            "utilisation": used[name],
        }  # fmt: skip
        if snaps is not None:
            peaks = [contact.peak for contact in snaps.snaps]
            values |= {
                "slack_time": snaps.slack_time, "slack_share": snaps.slack_time / max(float(np.ptp(time)), 1e-300),
                "contact_count": float(len(snaps.contacts)), "snap_count": float(len(peaks)),
                "snap_threshold": snaps.threshold, "largest_snap": max(peaks, default=math.nan),
                "shortest_rise_time": min((contact.rise_time for contact in snaps.snaps), default=math.nan),
            }  # fmt: skip
        for key in keys:
            out[key].append(values.get(key, math.nan))
    return out


def _part_summary(item: NetworkRun) -> dict[str, Array]:
    """Return the highest tension of parts that differ in strength, its time and the mean over time."""
    chosen = _counted(item)
    if "part_tension_peak_since_row" not in item.series or not chosen.any():
        return {}
    record = np.nan_to_num(item.series["part_tension_peak_since_row"].values[chosen], nan=-math.inf)
    at = record.argmax(axis=0)
    return {
        "part_tension_maximum": record.max(axis=0),
        "part_peak_time": item.series["time"].values[chosen][at],
        "part_tension_mean": record.mean(axis=0),
    }


def _point_summary(item: NetworkRun, names: list[str], rest: Array | None) -> dict[str, list[float]]:
    chosen = _counted(item)
    out: dict[str, list[float]] = {key: [] for key in (*LOADS, "point_excursion")}
    for number, name in enumerate(names):
        load = item.series["point_load_peak_since_row"].sel(point=name).values[chosen]
        place = item.series["point_position"].sel(point=name).values[chosen]
        if load.size == 0 or not np.isfinite(load).any():
            for key in out:
                out[key].append(math.nan)
            continue
        for key, highest in zip(LOADS, np.nanmax(load, axis=0), strict=True):
            out[key].append(float(highest))
        origin = rest[number] if rest is not None else place[0]
        out["point_excursion"].append(float(np.nanmax(np.linalg.norm(place - origin, axis=1))))
    return out


def _solid_summary(item: NetworkRun, rest: Array | None) -> dict[str, Array]:
    """Return how far the bodies go from their rest, and turn from where the run begins."""
    chosen = _counted(item)
    place, angle = (item.series[key].values for key in ("solid_position", "solid_angle"))
    if not chosen.any():
        return dict.fromkeys(SOLID, np.full(place.shape[1], np.nan))
    size = max(1.0, float(np.nanmax(np.abs(place[0]), initial=0.0)))
    origin = place[0] if rest is None else rest
    moved, turned = without_noise(place - origin, size)[chosen], without_noise(angle - angle[0], 1.0)[chosen]
    offset = np.linalg.norm(moved[..., :2], axis=2)
    values = (
        offset.max(axis=0), np.linalg.norm(moved[..., :2].mean(axis=0), axis=1), np.ptp(moved[..., 2], axis=0),
        *(np.ptp(turned[..., k], axis=0) for k in range(3)), lean_of(angle[chosen]).max(axis=0),
    )  # fmt: skip
    return dict(zip(SOLID, values, strict=True))


def contacts_dataset(item: NetworkRun) -> xr.Dataset | None:
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
