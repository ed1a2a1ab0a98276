"""The longest natural period of a network on the first page."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np

from moyai.core.headline import Band, Headline

if TYPE_CHECKING:
    import xarray as xr

#: What the band of the longest period is of.
MESH = "mesh: twice the segments, and their change extrapolated"


def mode_headlines(groups: Mapping[str, xr.Dataset]) -> list[Headline]:
    """Return the longest natural period over the water levels; of the lines alone where bodies are held."""
    found = []
    for path, modes in groups.items():
        level, *kind = path.strip("/").split("/")
        if kind != ["modes"]:
            continue
        if "mode_period" not in modes or not modes["mode_period"].size:
            continue
        value = float(modes["mode_period"].values[0])
        if not math.isfinite(value):
            continue
        finer = float(modes["longest_period_double_mesh"])
        ends = [value, finer, max(2.0 * finer - value, 0.0)]
        band = Band(min(ends), max(ends), MESH) if math.isfinite(finer) else None
        bodies = int(groups[f"/{level}"].attrs.get("bodies_held", 0))
        label = "longest natural period of the lines, bodies held" if bodies else "longest natural period"
        more = "periods of the bodies are not computed: release them in still water" if bodies else ""
        detail = "; ".join(filter(None, (_motion_of(groups[f"/{level}/network"], modes), "added mass counted", more)))
        found.append(Headline("natural_period", label, value, "s", level, band=band, detail=detail))
    return [max(found, key=lambda item: item.value)] if found else []


def _motion_of(network: xr.Dataset, modes: xr.Dataset) -> str:
    """Say which point or line moves most in the longest mode, and along which axis."""
    shape = np.asarray(modes["mode_shape"].values[0])
    size = np.linalg.norm(shape, axis=1)
    node = int(np.argmax(size))
    if not size[node] > 0.0:
        return ""
    along = "xyz"[int(np.argmax(np.abs(shape[node])))]
    points = dict(zip(network["point_node"].values.astype(int), network["point"].values, strict=True))
    # a point that moves nearly as much as the farthest node is what a reader looks for
    near = [(float(size[place]), str(name)) for place, name in points.items() if size[place] > 0.7 * size[node]]
    if near:
        name = max(near)[1]
        return f"'{name}' moves most, along {along}"
    owners = [
        str(line)
        for line, start, end in zip(
            network["bar_line"].values, network["bar_start"].values, network["bar_end"].values, strict=True
        )
        if node in (int(start), int(end))
    ]
    return f"'{owners[0]}' moves most, along {along}" if owners else f"moves most along {along}"
