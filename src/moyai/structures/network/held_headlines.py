"""The pull of nets on the row that holds them on the first page: beams, head ropes and piles are sized by it."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np

from moyai.core.headline import Band, Bound, Headline, governing
from moyai.structures.network.mesh_band import mesh_and_step
from moyai.structures.network.model import NetworkProblem

if TYPE_CHECKING:
    import xarray as xr

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
    widths = {net.name: math.dist(net.corners[0], net.corners[1]) for net in problem.nets}
    found = []
    for path, series in groups.items():
        pieces = path.strip("/").split("/")
        if len(pieces) != 3 or pieces[1] != "time" or "held_pull" not in series:
            continue
        late = series.isel(time=series["time"].values >= series["time"].values[0] + series.attrs["skip"])
        for net in (str(name) for name in late["net"].values):
            pull = late["held_pull"].sel(net=net).values
            if not pull.size or not np.isfinite(pull).any():
                continue
            size = np.linalg.norm(pull, axis=1)
            most, along = float(np.nanmax(size)), float(np.nanmax(np.hypot(pull[:, 0], pull[:, 1])))
            if most == 0.0:
                continue
            band = _band(groups.get(f"/{pieces[0]}/dynamic"), pieces[2], net, most)
            # one seed, one that still drifts, and a net that no finer one was held against, can have more
            short = int(series.attrs.get("irregular", 0)) or series.attrs.get("unsettled")
            bound: Bound = "at least" if short or band is None else ""
            said = f"horizontal {along / 1e3:.3g} kN, downwards {max(-float(np.nanmin(pull[:, 2])), 0.0) / 1e3:.3g} kN"
            if net in widths:
                said += f"; {most / widths[net]:.3g} N per metre of a row of {widths[net]:.3g} m"
            found.append(
                Headline(
                    "held_row_load", "largest pull of a net on the row that holds it", most, "N",
                    ", ".join((net, pieces[2], pieces[0])), where, band, bound,
                    detail=f"{said}; at the rows of the record" + ("" if band else f"; {NET_UNCHECKED}"),
                    part=net, bound_by="" if band else NET_UNCHECKED,
                )
            )  # fmt: skip
    return governing(found)


def _band(summary: xr.Dataset | None, run: str, net: str, value: float) -> Band | None:
    """Return what step and a net of twice the knots do to the pull on the row that holds it."""
    if summary is None or "held_pull_of_check" not in summary:
        return None
    values = [float(one) for one in summary["held_pull_of_check"].sel(run=run, net=net).values]
    return mesh_and_step(value, values, nets=True) if all(map(math.isfinite, values[:3])) else None
