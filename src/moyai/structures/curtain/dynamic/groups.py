"""Result groups of a run of a span: series, peaks, snaps, and the frames of its moving view."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from moyai.flexible.sheets import sheet_stress
from moyai.structures.curtain.dynamic.peak_uncertainty import BOTH, PeakUncertainties, PeakUncertainty
from moyai.structures.curtain.dynamic.plans import Plan
from moyai.structures.curtain.dynamic.runs import DynamicRun, DynamicSettings
from moyai.structures.curtain.variables import TRIALS, labelled

if TYPE_CHECKING:
    import xarray as xr

#: Frames kept for the moving picture.
_FRAMES = 240


def run_dataset(
    run: DynamicRun, settings: DynamicSettings, uncertainty: PeakUncertainties | None, plan: Plan
) -> tuple[xr.Dataset, dict[str, float]]:
    """Return the group of a run, and its row in the table of all runs."""
    import xarray as xr

    history = run.history
    names = list(run.names)
    peaks = np.stack([run.tension(name) for name in names])
    data: dict[str, Any] = {
        "line_tension_peak_since_row": (("line", "time"), peaks),
        "both_cables_tension_peak_since_row": ("time", run.both),
        "kinetic_energy": ("time", history.kinetic_energy),
        "elastic_energy": ("time", history.elastic_energy),
        "energy_balance": ("time", history.energy_balance),
    }
    middle = run.built.grid[run.built.mesh.along // 2]
    data["mid_span_x"] = ("time", history.position[:, middle[0], 0])
    data["mid_toe_x"] = ("time", history.position[:, middle[-1], 0])
    data["mid_toe_z"] = ("time", history.position[:, middle[-1], 2])
    highest = [run.peak(name) for name in names]
    data["line_tension_maximum"] = ("line", [value for value, _ in highest])
    data["line_peak_time"] = ("line", [when for _, when in highest])
    stats = [run.snaps(name, settings.slack_level, settings.threshold) for name in names]
    length = max(float(history.time[-1] - run.from_time), 1e-300)
    data["slack_share"] = ("line", [record.slack_time / length for record in stats])
    data["contact_count"] = ("line", [len(record.contacts) for record in stats])
    data["snap_count"] = ("line", [len(record.snaps) for record in stats])
    data["slack_level"] = ("line", [record.slack_level for record in stats])
    data["snap_threshold"] = ("line", [record.threshold for record in stats])
    rises = [[c.rise_time for c in record.snaps] for record in stats]
    data["median_rise_time"] = ("line", [float(np.median(r)) if r else math.nan for r in rises])
    nothing = PeakUncertainty(math.nan)
    for key in TRIALS:
        data[f"line_{key}"] = (
            "line",
            [getattr(uncertainty.of[name] if uncertainty else nothing, key) for name in names],
        )
    total = uncertainty.of[BOTH] if uncertainty else nothing
    both, when = run.peak("both")
    row = int(np.argmin(np.abs(history.time - when)))
    near = np.arange(max(0, row - 100), min(history.time.size, row + 101))
    rows = np.unique(np.concatenate([near, np.linspace(0, history.time.size - 1, 200).astype(int)]))
    skirt = float(np.max(run.skirt_tension(rows)))
    summary = {
        "both_cables_tension_maximum": both, "both_cables_peak_time": when, "upper_peak": highest[0][0],
        "lower_peak": run.peak("lower cable")[0] if "lower cable" in names else 0.0,
        "anchor_line_tension_maximum": max(
            (value for (value, _), name in zip(highest, names, strict=True) if name.startswith("anchor")),
            default=math.nan,
        ),
        "skirt_peak": skirt,
        **{f"{key}_peak": getattr(total, key) for key in TRIALS},
    }  # fmt: skip
    if history.status == "not_converged":
        # the last instants of a run that had to stop are no motion of the span: nobody shall design with them
        summary = dict.fromkeys(summary, math.nan)
        for name in ("line_tension_maximum", "line_peak_time"):
            data[name] = ("line", [math.nan] * len(names))
    attributes = {
        "status": history.status, "time_step": history.step, "steps": history.steps, "counted_from": run.from_time,
        "period": plan.period, "cells_along": run.built.mesh.along, "cells_down": run.built.mesh.down,
        "regular": int(plan.regular), "random": int(plan.random),
    }  # fmt: skip
    return labelled(xr.Dataset(data, coords={"time": history.time, "line": names}, attrs=attributes)), summary


def run_frames(run: DynamicRun, plan: Plan) -> xr.Dataset:
    """Return what a moving picture needs: places, tensions and skirt stresses at a few hundred moments."""
    import xarray as xr

    history, network = run.history, run.built.network
    size = history.time.size
    when = run.peak("both")[1]
    rows = np.unique(np.concatenate([np.linspace(0, size - 1, _FRAMES).astype(int),
                                     [int(np.argmin(np.abs(history.time - when)))]]))  # fmt: skip
    sheets = network.sheets
    assert sheets is not None
    # what keeps columns of the skirt in order belongs to no cable and is not shown
    shown = np.concatenate([strand.bars for strand in network.strands])
    stress = np.stack([sheet_stress(sheets, history.position[row]).first for row in rows])
    data: dict[str, Any] = {
        "node_position": (("frame", "node", "axis"), history.position[rows].astype(np.float32)),
        "bar_tension": (("frame", "bar"), history.tension[rows][:, shown].astype(np.float32)),
        "triangle_tension": (("frame", "triangle"), stress.astype(np.float32)),
        "bar_nodes": (("bar", "end"), np.stack([network.bars.start, network.bars.end], axis=1)[shown]),
        "triangle_nodes": (("triangle", "corner"), sheets.triangles),
    }
    waves = run.flow.waves
    if waves is not None:
        for key in ("amplitude", "omega", "wave_number", "heading", "phase"):
            data[f"wave_{key}"] = ("component", np.asarray(getattr(waves, key)))
    names = [strand.name for strand in network.strands for _ in strand.bars]
    coords = {"frame_time": ("frame", history.time[rows]), "bar_line": ("bar", names)}
    attributes = {"wave_ramp": max(run.flow.ramp, run.flow.wave_ramp), "peak_time": when}
    return labelled(xr.Dataset(data, coords=coords, attrs=attributes))


__all__ = ["run_dataset", "run_frames"]
