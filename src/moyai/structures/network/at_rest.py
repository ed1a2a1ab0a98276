"""Pulls on fixed points and offsets of a network at rest, where nothing was run through time."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING

import numpy as np

from moyai.core.headline import Band, Headline, all_judged

if TYPE_CHECKING:
    import xarray as xr

#: Segments of a line up to which the pull on its anchor moves with the mesh as its tension does, and more than that.
COARSE = 12
#: What the band of a number at rest is of.
MESH = "mesh: twice the segments, and their change continued"
#: What is said of a rest whose mesh was not checked, and what helps.
MESH_UNCHECKED, FINER = "mesh not checked", "more segments, or knots of nets, tell what the mesh does"


def rest_headlines(groups: Mapping[str, xr.Dataset], anchors: Mapping[str, str], model: str) -> list[Headline]:
    """Return the largest pull on a fixed point and the largest offset of a network at rest.

    Parameters
    ----------
    groups : mapping of str to xarray.Dataset
        Of the result.
    anchors : mapping of str to str
        Only fixed point that holds a point, by the point.
    model : str
        Model in words.
    """
    levels = [path.strip("/").split("/")[0] for path in groups if path.endswith("/statics")]
    pulls, offsets = [], []
    for level in levels:
        said = level if len(levels) > 1 else ""
        pulls += list(_pulls(groups[f"/{level}/statics"], groups[f"/{level}/network"], said, model))
        offsets += list(_offsets(groups[f"/{level}/statics"], groups[f"/{level}/network"], anchors, said, model))
    return [*all_judged(pulls), *all_judged(offsets)]


def _pulls(rest: xr.Dataset, network: xr.Dataset, level: str, model: str) -> Iterator[Headline]:
    few = "double_mesh" in rest and bool((network["line_segments"].values <= COARSE).any())
    for condition in (str(name) for name in rest["condition"].values):
        for point in _of_kind(network, "fixed"):
            load = rest["load"].sel(condition=condition, point=point).values
            value = float(np.linalg.norm(load))
            if not value > 0.0:
                continue
            detail = f"horizontal {math.hypot(*load[:2]) / 1e3:.3g} kN, upwards {max(float(load[2]), 0.0) / 1e3:.3g} kN"
            band = _band(rest, condition, point, value, few)
            yield Headline(
                "anchor_load", "largest pull on a fixed point at rest", value, "N",
                ", ".join(filter(None, (point, condition, level))), model, band,
                "" if band else "at least", detail=detail if band else f"{detail}; {MESH_UNCHECKED}; {FINER}",
                part=point, bound_by="" if band else f"{MESH_UNCHECKED}; {FINER}",
            )  # fmt: skip


def _band(rest: xr.Dataset, condition: str, point: str, value: float, few: bool) -> Band | None:
    """Return what twice the segments do to a pull, and their change continued to bars of no length."""
    if "load_double_mesh" not in rest:
        return None
    finer = float(rest["load_double_mesh"].sel(condition=condition, point=point))
    ends = [value, finer, max(2.0 * finer - value, 0.0)]
    if few:
        # where a coarse line meets the bed hangs on its nodes: twice of them may change the pull little by chance
        own, cut = (rest[key].sel(condition=condition).values for key in ("line_tension_maximum", "double_mesh"))
        usable = np.isfinite(own) & np.isfinite(cut) & (own > 0.0)
        ends += [value * max(float(change), 0.0) for change in 2.0 * cut[usable] / own[usable] - 1.0]
    return Band(min(ends), max(ends), MESH) if math.isfinite(finer) else None


def _offsets(
    rest: xr.Dataset, network: xr.Dataset, anchors: Mapping[str, str], level: str, model: str
) -> Iterator[Headline]:
    if "current" not in rest["condition"].values or "still water" not in rest["condition"].values:
        return
    place = rest["point_position"]
    now, still = (place.sel(condition=condition) for condition in ("current", "still water"))
    for point in _of_kind(network, "free"):
        anchor = anchors.get(point)
        if anchor is None:
            value = float(np.linalg.norm(now.sel(point=point).values - still.sel(point=point).values))
            said = "from its place in still water, heave included"
        else:
            value = float(np.linalg.norm((now.sel(point=point).values - now.sel(point=anchor).values)[:2]))
            said = f"horizontal distance from its only anchor '{anchor}', round which it swings"
        yield Headline(
            "offset", "largest offset of a body or buoy", value, "m",
            ", ".join(filter(None, (point, "current", level))), model, detail=said,
        )  # fmt: skip


def _of_kind(network: xr.Dataset, kind: str) -> list[str]:
    return [str(n) for n, own in zip(network["point"].values, network["point_kind"].values, strict=True) if own == kind]
