"""Place a network in the one array of the explicit kernels: spine, ribs, and where each bar went."""

from __future__ import annotations

import mmap
from dataclasses import dataclass

import numpy as np

from moyai.core.arrays import Array, IntArray
from moyai.core.errors import InputError
from moyai.flexible import explicit_rows as rows_of
from moyai.flexible.arrays import KernelArrays

#: Loops run over whole vectors of this many numbers.
_LANES = 8


@dataclass(frozen=True, eq=False)
class Packed:
    """A network in the array of the kernels."""

    #: The array; its rows are named in :mod:`moyai.flexible.explicit_rows`.
    memory: Array
    #: Nodes and spine bars that the loops run over (filled up to whole vectors).
    sizes: IntArray
    #: Runs of ribs; shape (r, 5).
    runs: IntArray
    #: Where each bar of the network lies, relative to a row of bars; shape (m,).
    place: IntArray
    #: Number of nodes of the network.
    nodes: int

    def node_rows(self, first: int, rows: int) -> Array:
        """Return a view of ``rows`` rows of nodes from row ``first``, shape (rows, n)."""
        whole = self.memory[first : first + rows * rows_of.ROW].reshape(rows, rows_of.ROW)
        return whole[:, : self.nodes]

    def bar_row(self, row: int) -> Array:
        """Return a copy of a row of bars in the order of the network."""
        return self.memory[row + self.place]


def _runs(start: IntArray, end: IntArray, curve: IntArray) -> IntArray:
    if start.size == 0:
        return np.zeros((0, 5), dtype=np.int64)
    broken = (np.diff(start) != 1) | (np.diff(end) != 1) | (np.diff(curve) != 0)
    first = np.concatenate([[0], np.flatnonzero(broken) + 1])
    size = np.diff(np.concatenate([first, [start.size]]))
    return np.ascontiguousarray(np.stack([start[first], end[first], first, size, curve[first]], axis=1))


def _untouched(size: int) -> Array:
    """Return zeros of which the system provides only the small pages that are used."""
    if hasattr(mmap, "MADV_NOHUGEPAGE"):
        block = mmap.mmap(-1, 8 * size)
        block.madvise(mmap.MADV_NOHUGEPAGE)
        return np.frombuffer(block, dtype=np.float64)
    return np.zeros(size)


def pack(arrays: KernelArrays) -> Packed:
    """Place a network.

    Raises
    ------
    InputError
        When it has more nodes or bars than a row holds.
    """
    count, bars = arrays.nodes.shape[1], arrays.start.size
    if max(count, bars) + 2 * _LANES > rows_of.ROW:
        raise InputError(
            f"{max(count, bars)} nodes or bars",
            parameter="network",
            allowed=f"up to {rows_of.ROW - 2 * _LANES} in the explicit scheme",
        )
    memory = _untouched(rows_of.ROWS_IN_MEMORY * rows_of.ROW)
    # a bar between neighbours continues the spine, the first one for each pair; its direction may be reversed
    low = np.minimum(arrays.start, arrays.end)
    neighbours = (np.abs(arrays.end - arrays.start) == 1) & (arrays.curve < 0)
    spine = np.zeros(bars, dtype=bool)
    candidates = np.flatnonzero(neighbours)
    spine[candidates[np.unique(low[candidates], return_index=True)[1]]] = True
    rest = np.flatnonzero(~spine)
    order = rest[np.lexsort((arrays.start[rest], arrays.end[rest] - arrays.start[rest], arrays.curve[rest]))]
    place = np.empty(bars, dtype=np.int64)
    place[spine] = low[spine]
    place[order] = rows_of.RIB + np.arange(order.size)
    sizes = np.array([-(-count // _LANES) * _LANES, -(-(count - 1) // _LANES) * _LANES], dtype=np.int64)
    for row, name in enumerate(
        ("MASS", "WEIGHT", "VOLUME", "DRAG", "ADDED", "STIFF", "DAMP", "HEIGHT", "FORM", "FREE_X", "FREE_Y", "FREE_Z")
    ):
        first = getattr(rows_of, name)
        memory[first : first + count] = arrays.nodes[row]
    memory[rows_of.MASS + count : rows_of.MASS + sizes[0]] = 1.0
    fill = np.arange(sizes[1] + 1 - count + 1)
    memory[rows_of.X + count : rows_of.X + count + fill.size] = fill
    memory[rows_of.LENGTH : rows_of.LENGTH + sizes[1]] = 1.0
    memory[rows_of.RADIUS : rows_of.RADIUS + sizes[1]] = 1.0
    for row in range(arrays.bars.shape[0]):
        memory[rows_of.LENGTH + row * rows_of.ROW + place] = arrays.bars[row]
    memory[rows_of.WET + place] = 1.0
    return Packed(memory, sizes, _runs(arrays.start[order], arrays.end[order], arrays.curve[order]), place, count)
