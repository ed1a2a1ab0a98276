"""The pull of nets on the row that holds them on the first page: beams, head ropes and piles are sized by it."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING

import numpy as np

from moyai.core.headline import Band, Bound, Headline, governing
from moyai.structures.network.at_rest import unsettled_mesh
from moyai.structures.network.mesh_band import mesh_and_step
from moyai.structures.network.model import NetworkProblem
from moyai.structures.network.rest_mesh import band_at_rest

if TYPE_CHECKING:
    import xarray as xr

    from moyai.core.arrays import Array

#: What is said of the pull of a net whose mesh was not checked.
NET_UNCHECKED = "mesh of the net not checked: twice the knots give more"


def held_headlines(problem: NetworkProblem, groups: Mapping[str, xr.Dataset], where: str) -> list[Headline]:
    """Return the largest pull of a net on the row that holds it, and of what strip the tension of a bar is.

    Parameters
    ----------
    problem : NetworkProblem
    groups : mapping of str to xarray.Dataset
        Of the result.
    where : str
        Model in words.
    """
    return governing([*_in_time(problem, groups, where), *_at_rest(problem, groups, where)])


def _in_time(problem: NetworkProblem, groups: Mapping[str, xr.Dataset], where: str) -> Iterator[Headline]:
    for path, series in groups.items():
        pieces = path.strip("/").split("/")
        if len(pieces) != 3 or pieces[1] != "time" or "held_pull" not in series:
            continue
        late = series.isel(time=series["time"].values >= series["time"].values[0] + series.attrs["skip"])
        for net in (str(name) for name in late["net"].values):
            pull = late["held_pull"].sel(net=net).values
            if not pull.size or not np.isfinite(pull).any():
                continue
            most = float(np.nanmax(np.linalg.norm(pull, axis=1)))
            band = _band(groups.get(f"/{pieces[0]}/dynamic"), pieces[2], net, most)
            # one seed, one that still drifts, and a net that no finer one was compared with, can have more
            short = int(series.attrs.get("irregular", 0)) or series.attrs.get("unsettled")
            bound: Bound = "at least" if short or band is None else ""
            said = ["at the rows of the record", *([] if band else [NET_UNCHECKED])]
            found = Headline(
                "held_row_load", "largest pull of a net on the row that holds it", most, "N",
                ", ".join((net, pieces[2], pieces[0])), where, band, bound, detail=_said(problem, net, pull, said),
                part=net, bound_by="" if band else NET_UNCHECKED,
            )  # fmt: skip
            if most > 0.0:
                yield found


def _at_rest(problem: NetworkProblem, groups: Mapping[str, xr.Dataset], where: str) -> Iterator[Headline]:
    """Yield the pulls at rest, where nothing was run through time."""
    for path, rest in groups.items():
        level = path.strip("/").split("/")[0]
        if path != f"/{level}/statics" or "held_pull" not in rest or f"/{level}/dynamic" in groups:
            continue
        for condition in (str(name) for name in rest["condition"].values):
            for net in (str(name) for name in rest["net"].values):
                pull = rest["held_pull"].sel(condition=condition, net=net).values
                band, settled = band_at_rest(
                    rest, groups[f"/{level}/network"], "held_pull_of_mesh", condition, net=net
                )  # fmt: skip
                level_band, _ = band_at_rest(
                    rest, groups[f"/{level}/network"], "held_level_pull_of_mesh", condition, net=net
                )  # fmt: skip
                why = [] if settled else unsettled_mesh(band)
                found = Headline(
                    "held_row_load", "pull of a net on the row that holds it at rest", float(np.linalg.norm(pull)),
                    "N", ", ".join((net, condition, level)), where, band, "" if settled else "at least",
                    detail=_said(problem, net, pull[None], why, level_band), part=net, bound_by="; ".join(why),
                )  # fmt: skip
                if found.value > 0.0:
                    yield found


def _said(problem: NetworkProblem, net: str, pull: Array, more: list[str], level: Band | None = None) -> str:
    """Return the parts of a pull, shape (rows, 3), and what it is per metre of its row."""
    along, most = (float(np.nanmax(np.linalg.norm(pull[:, :axes], axis=1))) for axes in (2, 3))
    down = max(-float(np.nanmin(pull[:, 2])), 0.0)
    parts = [f"horizontal {along / 1e3:.3g} kN, downwards {down / 1e3:.3g} kN"]
    if level is not None and level.high > along:
        finer = f"horizontal {along / 1e3:.3g} kN, up to {level.high / 1e3:.3g} kN on finer meshes"
        parts = [f"{finer}, downwards {down / 1e3:.3g} kN"]
    widths = {one.name: math.dist(one.corners[0], one.corners[1]) for one in problem.nets}
    if net in widths:
        parts.append(f"{most / widths[net]:.3g} N per metre of a row of {widths[net]:.3g} m")
    return "; ".join([*parts, *more])


def _band(summary: xr.Dataset | None, run: str, net: str, value: float) -> Band | None:
    """Return what step and a net of twice the knots do to the pull on the row that holds it."""
    if summary is None or "held_pull_of_check" not in summary:
        return None
    values = [float(one) for one in summary["held_pull_of_check"].sel(run=run, net=net).values]
    return mesh_and_step(value, values, nets=True) if all(map(math.isfinite, values[:3])) else None
