"""What a network carries while its run starts, on the first page."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np

from moyai.core.headline import Headline
from moyai.structures.network.start_up import ASKED, WAVES

if TYPE_CHECKING:
    import xarray as xr


def start_headlines(groups: Mapping[str, xr.Dataset], highest: float) -> list[Headline]:
    """Return the highest tension of the beginning that does not count: the program chose it, or it is the larger.

    ``highest`` is that of what counts [N].
    """
    best: tuple[float, str, str] | None = None
    for path, series in groups.items():
        pieces = path.strip("/").split("/")
        if len(pieces) != 3 or pieces[1] != "time" or "line_tension_peak_since_row" not in series:
            continue
        skip, rule = float(series.attrs["skip"]), str(series.attrs["skip_rule"])
        time = series["time"].values
        early = series["line_tension_peak_since_row"].isel(time=time < time[0] + skip)
        if not rule or not early.size or not np.isfinite(early.values).any():
            continue
        row, line = np.unravel_index(int(np.nanargmax(early.values)), early.shape)
        value = float(early.values[row, line])
        if (rule in (ASKED, WAVES) and value <= highest) or (best is not None and value <= best[0]):
            continue
        at = f"{early['line'].values[line]}, {pieces[2]}, t = {time[row]:.2f} s"
        best = (value, at, f"not in the highest tension: the first {skip:.3g} s are left out ({rule})")
    if best is None:
        return []
    return [
        Headline(
            "start_up_tension", "tension while the run starts", best[0], "N", best[1], "run through time",
            detail=best[2], condition=True,
        )
    ]  # fmt: skip
