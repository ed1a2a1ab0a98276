"""Sheets on a finer mesh: every triangle cut in four by the middles of its edges."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import fields

import numpy as np
from numpy.typing import NDArray

from moyai.core.arrays import IntArray
from moyai.flexible.elements import FREE, Nodes
from moyai.flexible.sheets import Sheets

#: Two nodes, the lower number first.
Edge = tuple[int, int]


def edge_of(one: int, two: int) -> Edge:
    """Return the edge between two nodes."""
    return (one, two) if one < two else (two, one)


def sheet_edges(sheets: Sheets | None) -> dict[Edge, int]:
    """Return every edge of the triangles with the number of triangles that share it."""
    edges: dict[Edge, int] = {}
    if sheets is None:
        return edges
    for corners in sheets.triangles.tolist():
        for one, two in zip(corners, corners[1:] + corners[:1], strict=True):
            edge = edge_of(one, two)
            edges[edge] = edges.get(edge, 0) + 1
    return edges


def cut_in_four(sheets: Sheets, number: Callable[[int], int], middle: Mapping[Edge, int]) -> Sheets:
    """Return the sheets with four triangles for each.

    Parameters
    ----------
    sheets : Sheets
        The coarse mesh.
    number : callable
        New number of an old node.
    middle : mapping of edge to int
        New number of the node in the middle of each edge, named by old nodes.
    """
    triangles: list[list[int]] = []
    for a, b, c in sheets.triangles.tolist():
        ab, bc, ca = middle[edge_of(a, b)], middle[edge_of(b, c)], middle[edge_of(c, a)]
        triangles += [[number(a), ab, ca], [ab, number(b), bc], [ca, bc, number(c)], [ab, bc, ca]]
    p, q, r = (sheets.rest[:, corner] for corner in range(3))
    pq, qr, rp = 0.5 * (p + q), 0.5 * (q + r), 0.5 * (r + p)
    rest = np.stack(
        [np.stack([p, pq, rp], 1), np.stack([pq, q, qr], 1), np.stack([rp, qr, r], 1), np.stack([pq, qr, rp], 1)], 1
    )
    values = {
        entry.name: np.repeat(getattr(sheets, entry.name), 4)
        for entry in fields(Sheets)
        if entry.name not in ("triangles", "rest", "tension_field")
    }
    return Sheets(
        np.array(triangles, dtype=np.int64), rest.reshape(-1, 3, 2), tension_field=sheets.tension_field, **values
    )


def held_middles(
    nodes: Nodes, first: IntArray, second: IntArray, border: NDArray[np.bool_]
) -> tuple[IntArray, NDArray[np.bool_], IntArray]:
    """Return kind, held components and motion of the nodes in the middle of edges of sheets.

    On a border between two nodes that stay, or follow the same motion, the middle does so too; a component that is held
    at both ends of an edge is held in its middle.
    """
    alike = border & (nodes.kind[first] == nodes.kind[second]) & (nodes.motion[first] == nodes.motion[second])
    kind = np.where(alike, nodes.kind[first], FREE)
    # the end of an edge that does not move at all is held in every component
    held = (nodes.held[first] | (nodes.kind[first] != FREE)[:, None]) & (
        nodes.held[second] | (nodes.kind[second] != FREE)[:, None]
    )
    both_bound = (nodes.kind[first] != FREE) & (nodes.kind[second] != FREE)
    held[both_bound] = False
    return kind, held, np.where(alike, nodes.motion[first], -1)


__all__ = ["Edge", "cut_in_four", "edge_of", "held_middles", "sheet_edges"]
