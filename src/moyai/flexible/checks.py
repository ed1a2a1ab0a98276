"""Faults of a network that can be told before any time step."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from moyai.core.errors import InputError

if TYPE_CHECKING:
    from moyai.flexible.network import Network


def name_of_node(network: Network, node: int) -> str:
    """Return a node in words: its number, its name, its place in a line."""
    for name, index in network.points.items():
        if index == node:
            return f"node {node} (point {name!r})"
    for strand in network.strands:
        place = np.flatnonzero(strand.nodes == node)
        if place.size:
            return f"node {node} (node {int(place[0])} of {strand.name!r})"
    return f"node {node}"


def parts(count: int, start: np.ndarray, end: np.ndarray) -> np.ndarray:
    """Return the number of the connected part of every node."""
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components

    graph = coo_array((np.ones(start.size), (start, end)), shape=(count, count))
    return np.asarray(connected_components(graph, directed=False)[1])


def check_network(network: Network) -> None:
    """Raise InputError at the first fault of a network.

    Raises
    ------
    InputError
        See :class:`moyai.flexible.network.Network`.
    """
    from moyai.flexible.network import DRIVEN, FIXED, FREE

    nodes, bars = network.nodes, network.bars
    count = len(nodes)
    if len(bars) and not (min(bars.start.min(), bars.end.min()) >= 0 and max(bars.start.max(), bars.end.max()) < count):
        raise InputError("a bar ends at a node that does not exist", path="bars", allowed=f"nodes 0 to {count - 1}")
    held = nodes.held.all(axis=1) | (nodes.kind != FREE)
    empty = (network.node_mass <= 0.0) & ~held
    if empty.any():
        raise InputError(
            f"{name_of_node(network, int(np.argmax(empty)))} can move but has no mass",
            path="nodes.mass",
            allowed="greater than 0 for free nodes",
            remedy="give the point a mass or connect a bar to it",
        )
    start, end = bars.start, bars.end
    if network.sheets is not None:
        corners = network.sheets.triangles
        if corners.max() >= count:
            raise InputError(
                f"a triangle of a sheet names node {int(corners.max())}, which does not exist",
                path="sheets.triangles",
                allowed=f"nodes 0 to {count - 1}",
            )
        start = np.concatenate([start, corners[:, 0], corners[:, 1]])
        end = np.concatenate([end, corners[:, 1], corners[:, 2]])
    if network.blocks is not None:
        _check_blocks(network)
    part = parts(count, start, end)
    anchored = np.zeros(int(part.max()) + 1, dtype=bool)
    np.logical_or.at(anchored, part, (nodes.kind != FREE) | nodes.held.any(axis=1))
    if not anchored.all() and anchored.any():
        lost = int(np.argmin(anchored[part]))
        raise InputError(
            f"{name_of_node(network, lost)} belongs to a part of {int((part == part[lost]).sum())} nodes "
            "that nothing holds",
            path="bars",
            allowed="every part connected to a fixed or driven point, or no such point at all",
            remedy="connect the part or make one of its points fixed",
        )
    driven = nodes.kind == DRIVEN
    wrong = driven & ((nodes.motion < 0) | (nodes.motion >= len(network.motion_names)))
    if wrong.any():
        raise InputError(
            f"{name_of_node(network, int(np.argmax(wrong)))} is driven but names no motion",
            path="nodes.motion",
            allowed=", ".join(network.motion_names) or "a named motion",
        )
    if network.bed is not None:
        # anchors may lie in the bed; whatever moves may not start deep in it
        deep = (nodes.position[:, 2] < network.bed.level - 0.02 * max(1.0, abs(network.bed.level))) & (
            nodes.kind != FIXED
        )
        if deep.any():
            worst = int(np.argmin(np.where(deep, nodes.position[:, 2], np.inf)))
            raise InputError(
                f"{name_of_node(network, worst)} starts at z = {nodes.position[worst, 2]:g} m, "
                f"under the bed at {network.bed.level:g} m",
                path="nodes.position",
                allowed="on or above the bed",
            )


def _check_blocks(network: Network) -> None:
    from moyai.flexible.network import FREE

    blocks, nodes = network.blocks, network.nodes
    assert blocks is not None
    if max(blocks.nodes.max(), blocks.guides.max()) >= len(nodes) or min(blocks.nodes.min(), blocks.guides.min()) < 0:
        raise InputError(
            "a section of added mass names a node that does not exist",
            path="blocks.nodes",
            allowed=f"nodes 0 to {len(nodes) - 1}",
        )
    bound = blocks.nodes.ravel()[nodes.kind[blocks.nodes.ravel()] != FREE]
    if bound.size:
        raise InputError(
            f"{name_of_node(network, int(bound[0]))} of a section of added mass cannot move",
            path="blocks.nodes",
            allowed="free nodes (hold single components by 'held')",
        )
