"""What nets pull on the row that holds them: beams, head ropes and piles are sized by it."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from moyai.core.arrays import Array
from moyai.core.headline import Bound, Headline, governing
from moyai.flexible.network import Network
from moyai.structures.network.equilibrium import pulls
from moyai.structures.network.model import NetworkProblem

if TYPE_CHECKING:
    import xarray as xr


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
            # one seed, and one that still drifts, can have more
            bound: Bound = "at least" if int(series.attrs.get("irregular", 0)) or series.attrs.get("unsettled") else ""
            said = f"horizontal {along / 1e3:.3g} kN, downwards {max(-float(np.nanmin(pull[:, 2])), 0.0) / 1e3:.3g} kN"
            if net in widths:
                said += f"; {most / widths[net]:.3g} N per metre of a row of {widths[net]:.3g} m"
            found.append(
                Headline(
                    "held_row_load", "largest pull of a net on the row that holds it", most, "N",
                    ", ".join((net, pieces[2], pieces[0])), where, bound=bound,
                    detail=f"{said}; at the rows of the record",
                )
            )  # fmt: skip
    return governing(found)
