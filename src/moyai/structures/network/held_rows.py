"""What nets pull on the row that holds them."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from moyai.core.arrays import Array
from moyai.flexible.network import Network
from moyai.flexible.result import History
from moyai.structures.network.assembly import Assembly
from moyai.structures.network.equilibrium import pulls
from moyai.structures.network.variables import labelled

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


def nets_at_rest(dataset: xr.Dataset, assembly: Assembly) -> xr.Dataset:
    """Return the dataset of a network at rest with the highest tension in each net and its pull on what holds it."""
    if not assembly.net_bars:
        return dataset
    tension, position = dataset["tension"].values, dataset["position"].values
    highest = np.stack([own.max(axis=1) for own in assembly.net_tensions(tension)], axis=1)
    data: dict[str, object] = {"net_tension_maximum": (("condition", "net"), highest)}
    held = held_pulls(assembly.network, assembly.net_bars, position, tension)
    if held is not None:
        data["held_pull"] = (("condition", "net", "axis"), held)
    return labelled(dataset.assign(data).assign_coords(net=list(assembly.net_bars)))


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
