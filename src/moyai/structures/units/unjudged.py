"""What the first page of a row of units does not judge."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from moyai.core.headline import Headline
from moyai.structures.units.model import SNAP_RATIO

if TYPE_CHECKING:
    import xarray as xr

Seas = list[tuple[str, "xr.Dataset"]]


def not_judged(seas: Seas) -> Headline:
    """Return what the first page says nothing about."""
    timed = [data for path, data in seas if in_time(path)]
    words, detail = [], []
    if len(timed) < len(seas) or not seas:
        words.append("time domain, slow drift")
        detail.append("no impacts and snaps in time, no slow drift about the mean")
    if any(_snaps(data) for data in timed):
        words.append("lines in motion")
        detail.append("no snaps of lines")
    if not any(np.isfinite(data["connector_damage_rate"].values).any() for data in timed):
        words.append("fatigue")
        detail.append("no fatigue of connectors and lines")
    if any(np.nan_to_num(data["connector_moment_largest"].values).any() for _, data in seas):
        words.append("moments in connectors")
        detail.append("the moment in a connector is a number of the page, no strength of the case is compared with it")
    if alone := _without_gap(seas):
        words.append("contact of hulls")
        numbers = ", ".join(str(unit) for unit in alone)
        detail.append(f"no face of another unit is opposite these units, no gap of theirs is followed: {numbers}")
    if any(
        np.isfinite(data["anchor_horizontal_tension_maximum"].values).any()
        for _, data in seas
        if "anchor_horizontal_tension_maximum" in data
    ):
        words.append("the holding of an anchor in its soil")
        detail.append("loads of anchors are numbers of the page, no soil is compared with them")
    words += ["one line lost", "other directions of waves and current"]
    detail.append("no row with a line or a connector lost, no directions but those of the seas of the case")
    return Headline("not_judged", "Not judged", math.nan, "1", text=", ".join(words), detail="; ".join(detail))


def not_judged_at_rest(rests: Seas) -> Headline:
    """Return what the first page says nothing about where no sea was run."""
    words = ["waves"]
    if any(data.sizes.get("connector", 0) for _, data in rests):
        words.append("forces in connectors")
    if any(data.sizes.get("gap", 0) for _, data in rests):
        words.append("closing of gaps")
    if _without_gap(rests):
        words.append("contact of hulls")
    words += ["one line lost", "other directions of wind and current"]
    detail = "no sea was run: tensions and offsets are those of wind and current alone, waves and drift add to them"
    return Headline("not_judged", "Not judged", math.nan, "1", text=", ".join(words), detail=detail)


def _without_gap(seas: Seas) -> list[int]:
    """Return the units of a row, counted from 1, that no gap is followed of."""
    _, data = seas[0] if seas else ("", None)
    if data is None or data.sizes.get("unit", 1) < 2:
        return []
    names = [str(name) for name in data["gap"].values] if "gap" in data.coords else []
    known = {int(number) for name in names for number in name.split(" ", 1)[1].split("-")}
    return [unit for unit in range(1, data.sizes["unit"] + 1) if unit not in known]


def _snaps(data: xr.Dataset) -> bool:
    """Whether lines at rest are pulled beyond their range, and none was set in motion."""
    beyond = data["line_tension_maximum"].values > SNAP_RATIO * data["line_tension_mean"].values
    return bool(beyond.any()) and "lines_in_motion" not in data


def in_time(path: str) -> bool:
    """Whether a group of results is of the time domain."""
    return path.split("/")[2] == "time"
