"""Pulls on fixed points and offsets of a network at rest, where nothing was run through time."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from moyai.core.headline import Band, Headline, all_judged
from moyai.structures.network.rest_mesh import MESH, Reach, band_at_rest

if TYPE_CHECKING:
    import xarray as xr

    from moyai.core.arrays import Array

#: What is said of a rest that no finer mesh was found of, or whose finer meshes go on changing, and what helps.
MESH_UNCHECKED, MESH_MOVES = "mesh not checked", "finer meshes do not settle it"
HEAVY = "bars at the touchdown are heavier than their line can lift"
FINER = "more segments, or knots of nets, show the effect of the mesh"


def unsettled_mesh(band: Band | None) -> list[str]:
    """Say of a number at rest that its mesh leaves it open, by its band, and what helps."""
    return [MESH_UNCHECKED if band is None else MESH_MOVES, FINER]


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
    for condition in (str(name) for name in rest["condition"].values):
        for point in _of_kind(network, "fixed"):
            load = rest["point_load"].sel(condition=condition, point=point).values
            value = float(np.linalg.norm(load))
            band, settled = band_at_rest(rest, network, "point_load_of_mesh", condition, point=point)
            if not (value if band is None else band.high) > 0.0:
                continue
            upwards = float(load[2])
            words = f"horizontal {math.hypot(*load[:2]) / 1e3:.3g} kN, upwards {max(upwards, 0.0) / 1e3:.3g} kN"
            if upwards < 0.0:
                words = f"horizontal {math.hypot(*load[:2]) / 1e3:.3g} kN, downwards {-upwards / 1e3:.3g} kN"
            found = Headline(
                "point_load", "largest pull on a fixed point at rest", value, "N",
                ", ".join(filter(None, (point, condition, level))), model, band, detail=words, part=point,
            )  # fmt: skip
            yield found if settled else _open(found)


def _open(found: Headline) -> Headline:
    """Return a number that finer meshes do not settle: it can break a limit and keeps none."""
    why = "; ".join(unsettled_mesh(found.band))
    return replace(found, bound="at least", detail=f"{found.detail}; {why}", bound_by=why)


def _offsets(
    rest: xr.Dataset, network: xr.Dataset, anchors: Mapping[str, str], level: str, model: str
) -> Iterator[Headline]:
    if "current" not in rest["condition"].values or "still water" not in rest["condition"].values:
        return
    movable = [("point", name) for name in _of_kind(network, "free")]
    movable += [("solid", str(name)) for name in rest["solid"].values] if "solid_position" in rest else []
    for kind, name in movable:
        anchor = anchors.get(name)
        said = "from its place in still water" + (", heave included" if kind == "point" else "")
        if anchor is not None:
            said = f"horizontal distance from its only anchor '{anchor}', round which it swings"
        value = float(_away(rest, "", kind, name, anchor))
        yield Headline(
            "offset", "largest offset of a body or buoy", value, "m",
            ", ".join(filter(None, (name, "current", level))), model, _band(rest, kind, name, anchor), detail=said,
        )  # fmt: skip


def _band(rest: xr.Dataset, kind: str, name: str, anchor: str | None) -> Band | None:
    """Return what finer meshes make of an offset; None where none was run."""
    if f"{kind}_position_of_mesh" not in rest:
        return None
    # tensions tell when meshes are fine enough; places move with them
    reach = Reach.of(_away(rest, "_of_mesh", kind, name, anchor))
    lift = max(float(own[np.isfinite(own)][-1]) for own in rest["lift_of_mesh"].values)
    return Band(max(reach.low - lift, 0.0), reach.high + lift, MESH)


def with_mesh_of_rest(
    found: Headline, groups: Mapping[str, xr.Dataset], level: str, kind: str, name: str, anchor: str | None
) -> Headline:
    """Return an offset of a run through time with what finer meshes make of that at rest added to its band.

    Where bars at the touchdown are too heavy for their line to lift and no finer meshes are at rest, it is a bound.

    Parameters
    ----------
    found : Headline
    groups : mapping of str to xarray.Dataset
        Of the result.
    level : str
    kind : str
        ``point`` or ``solid``.
    name : str
    anchor : str or None
        Only fixed point that holds it.
    """
    rest, network = groups.get(f"/{level}/statics"), groups.get(f"/{level}/network")
    band = None
    if rest is not None and "current" in rest["condition"].values:
        band = _band(rest, kind, name, anchor)
    if band is not None and rest is not None:
        value = float(_away(rest, "", kind, name, anchor))
        # added, as a point that hardly moves at rest would be multiplied by anything
        less, more = max(value - band.low, 0.0), max(band.high - value, 0.0)
        own = found.band or Band(found.value, found.value, "")
        of = "; ".join(filter(None, (own.of, "mesh: as much as finer ones move the offset at rest")))
        judged = None if own.judged is None else (max(own.judged[0] - less, 0.0), own.judged[1] + more)
        settled = None if own.settled is None else own.settled + more
        low, high = max(own.low - less, 0.0), own.high + more
        return replace(found, band=replace(own, low=low, high=high, of=of, judged=judged, settled=settled))
    heavy = network is not None and int(network.attrs.get("heavy_touchdown", 0))
    if heavy or (rest is not None and f"{kind}_position_of_mesh" in rest):
        why = f"{HEAVY}; {FINER}"
        return replace(found, bound="at least", detail=f"{found.detail}; {why}", bound_by=why)
    return found


def _away(rest: xr.Dataset, of_mesh: str, kind: str, name: str, anchor: str | None) -> Array:
    """Return how far a point stands from its place in still water, a body in plan, or from its only anchor."""
    place = rest[f"{kind}_position{of_mesh}"].sel({kind: name})
    now, still = (place.sel(condition=condition).values for condition in ("current", "still water"))
    if anchor is not None:
        still = rest[f"point_position{of_mesh}"].sel(condition="current", point=anchor).values
    axes = 3 if kind == "point" and anchor is None else 2
    return np.asarray(np.linalg.norm((now - still)[..., :axes], axis=-1))


def _of_kind(network: xr.Dataset, kind: str) -> list[str]:
    return [str(n) for n, own in zip(network["point"].values, network["point_kind"].values, strict=True) if own == kind]
