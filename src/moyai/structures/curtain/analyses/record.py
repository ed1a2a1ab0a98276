"""A flume record next to the impact models: what was found in it, and each model over it."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from moyai.core.validity import Notice
from moyai.structures.curtain.analyses.impact import ImpactAnswer
from moyai.structures.curtain.impact.record import compare_record
from moyai.structures.curtain.model import RecordedSnap
from moyai.structures.curtain.variables import labelled

if TYPE_CHECKING:
    import xarray as xr

_MOST_POINTS = 4000


def record_dataset(record: RecordedSnap) -> xr.Dataset:
    """Return the group ``record``: the series without offset and drift, and the numbers found in it."""
    import xarray as xr

    keep = _kept(record)
    times = {
        "release_time": record.release_time,
        "taut_time": record.taut_time,
        "peak_time": record.peak_time,
        "plateau_start": record.plateau_start,
        "rise_time": record.rise_time,
        "both_cables_peak_tension": record.total.peak,
        "both_cables_plateau_tension": record.total.plateau,
        "both_cables_impact_tension": record.total.impact,
        "peak_missed": record.peak_missed,
    }
    data: dict[str, Any] = {
        "record_tension": (("cable", "time"), record.tension[:, keep]),
        "cable_peak_tension": ("cable", [cable.peak for cable in record.cables]),
        "cable_plateau_tension": ("cable", [cable.plateau for cable in record.cables]),
        "cable_impact_tension": ("cable", [cable.impact for cable in record.cables]),
        "cable_noise": ("cable", [cable.noise for cable in record.cables]),
        **{name: ((), value) for name, value in times.items()},
    }
    coords = {"time": record.time[keep], "cable": [cable.name for cable in record.cables]}
    return labelled(xr.Dataset(data, coords=coords, attrs={"file": record.file}))


def _kept(record: RecordedSnap) -> NDArray[np.int64]:
    """Return samples that show the whole record and every sample about the spike."""
    time = record.time
    every = np.arange(0, time.size, max(1, math.ceil(time.size / _MOST_POINTS)))
    rise = record.rise_time
    near = np.flatnonzero((time > record.taut_time - 2.0 * rise) & (time < record.peak_time + 6.0 * rise))
    return np.unique(np.concatenate([every, near]))


def record_ratios(record: RecordedSnap, answer: ImpactAnswer) -> tuple[xr.Dataset, tuple[Notice, ...]]:
    """Return each model over the record, tension and rise time, as variables of the group ``impact``.

    The impact of the record is its peak less its plateau; nothing is fitted.
    """
    import xarray as xr

    by_name = {cable.name: cable.impact for cable in record.cables}
    found = compare_record(
        answer.comparison,
        impact_tension=record.total.impact,
        rise_time=record.rise_time,
        upper_impact=by_name.get("upper") if len(by_name) > 1 else None,
        lower_impact=by_name.get("lower"),
        peak_missed=record.peak_missed,
    )
    lines = {line.model: line for line in found.lines}
    models = [item.model for item in answer.comparison.models]
    data: dict[str, Any] = {
        "record_ratio": ("impact_model", [lines[model].tension_ratio for model in models]),
        "record_time_ratio": ("impact_model", [lines[model].time_ratio for model in models]),
    }
    for side in ("upper", "lower"):
        line = lines.get(f"A2 {side}")
        data[f"record_{side}_ratio"] = ((), math.nan if line is None else line.tension_ratio)
    return labelled(xr.Dataset(data, coords={"impact_model": models})), found.notices
