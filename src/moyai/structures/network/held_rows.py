"""What nets pull on the row that holds them: beams, head ropes and piles are sized by it."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from moyai.core.arrays import Array
from moyai.core.headline import Band, Bound, Headline, governing
from moyai.flexible.network import Network
from moyai.flexible.result import History
from moyai.structures.network.assembly import Assembly
from moyai.structures.network.equilibrium import pulls
from moyai.structures.network.mesh_band import mesh_and_step
from moyai.structures.network.model import NetworkProblem

if TYPE_CHECKING:
    import xarray as xr

#: What is said of the pull of a net whose mesh was not checked.
NET_UNCHECKED = "mesh of the net not checked: twice the knots give more"


def held_pulls(
    network: Network, net_bars: Mapping[str, NDArray[np.int64]], position: Array, tension: Array
) -> Array | None:
    """Return the pull of every net on its fixed or driven knots together; ``None`` where no net has such knots.

    Parameters
    ----------
    network : Network
    net_bars : mapping of str to ndarray of int
        Bars of each net.
    position : ndarray, shape (rows, nodes, 3)
        [m]
    tension : ndarray, shape (rows, bars)
        [N]

    Returns
    -------
    ndarray, shape (rows, nets, 3), or None
        [N]; zero for a net that nothing holds.
    """
    bars, kinds = network.bars, network.nodes.kind
    held = []
    for own in net_bars.values():
        knots = np.unique(np.concatenate([bars.start[own], bars.end[own]]))
        held.append(knots[kinds[knots] != 0])
    if not any(knots.size for knots in held):
        return None
    out = np.zeros((len(position), len(held), 3))
    for column, (knots, own) in enumerate(zip(held, net_bars.values(), strict=True)):
        alone = np.zeros_like(tension)
        alone[:, own] = tension[:, own]
        if knots.size:
            out[:, column] = pulls(network, knots, position, alone).sum(axis=1)
    return out


def held_of_run(assembly: Assembly, history: History, after: float) -> dict[str, float]:
    """Return the largest pull [N] of each net on the row that holds it, at the rows of a run after a time [s]."""
    network, counted = history.network, history.time - history.time[0] >= after
    place = np.full((int(counted.sum()), len(network.nodes), 3), np.nan)
    place[:, history.nodes] = history.position[counted]
    tension = np.full((place.shape[0], len(network.bars)), np.nan)
    tension[:, history.bars] = history.tension[counted]
    found = held_pulls(network, assembly.net_bars, place, tension)
    if found is None or not counted.any():
        return {}
    size = np.linalg.norm(found, axis=2).max(axis=0)
    return {name: float(own) for name, own in zip(assembly.net_bars, size, strict=True) if own > 0.0}


def held_knots(assembly: Assembly) -> NDArray[np.int64]:
    """Return the knots of nets that are held, and those next to them."""
    bars = assembly.network.bars
    own = np.concatenate([np.zeros(0, dtype=np.int64), *assembly.net_bars.values()])
    held = assembly.network.nodes.kind != 0
    near = own[held[bars.start[own]] | held[bars.end[own]]]
    return np.unique(np.concatenate([bars.start[near], bars.end[near]]))


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
