"""Order and plan of the sparse direct solver: nested dissection of a network and the fronts of its elimination.

A network is cut in two by a small set of nodes, each half again, and so on; the cuts are eliminated last. A line then
costs a fixed effort per node, a net of N knots N^1.5. Every cut (and every last rest of a few nodes) is one *front*: a
small dense matrix of its own nodes and of those later ones that they touch. The numbers are worked on in
:mod:`moyai.flexible.front_kernel`.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from moyai.core.arrays import IntArray
from moyai.core.compiled import njit

#: Nodes that are left together without a further cut.
_LEAF = 4


@dataclass(frozen=True, eq=False)
class SparsePlan:
    """How the matrix of a network is stored, filled and eliminated."""

    #: Nodes in the order of their elimination; shape (n,).
    order: IntArray
    #: First pivot node (place in ``order``), pivot nodes, later nodes touched, where its list of later nodes begins,
    #: where its numbers begin, front that takes its rest (-1: none); shape (f, 6).
    fronts: IntArray
    #: Places (in ``order``) of the later nodes of every front, rising.
    later: IntArray
    #: For each entry of ``later``: its local place in the front that takes the rest.
    target: IntArray
    #: Numbers in all fronts.
    size: int
    #: Where the diagonal block of a node begins, and the length of a row there; shape (n, 2).
    own: IntArray
    #: The same for every pair of nodes of every element, one array per family of elements; shape (e, k, k, 2).
    pairs: tuple[IntArray, ...]


@njit(cache=True, error_model="numpy")
def _breadth_first(first: int, nodes: Any, low: int, high: int, part: Any, begin: Any, other: Any, level: Any) -> int:
    """Write the distance from ``first`` within a part of the graph; return the node reached last."""
    tag = part[first]
    queue = np.empty(high - low, dtype=np.int64)
    for place in range(low, high):
        level[nodes[place]] = -1
    queue[0], level[first] = first, 0
    head, tail = 0, 1
    while head < tail:
        node = queue[head]
        head += 1
        for j in range(begin[node], begin[node + 1]):
            near = other[j]
            if part[near] == tag and level[near] < 0:
                level[near] = level[node] + 1
                queue[tail] = near
                tail += 1
    return queue[tail - 1]


@njit(cache=True, error_model="numpy")
def _sort(values: Any, start: int, end: int) -> None:
    """Sort a stretch of numbers in place, by a heap: compiled in a fraction of the time of numpy's sort."""
    size = end - start
    root, last = size // 2, size
    while last > 1:
        if root > 0:
            root -= 1
            moved = values[start + root]
        else:
            last -= 1
            moved = values[start + last]
            values[start + last] = values[start]
        place, child = root, 2 * root + 1
        while child < last:
            if child + 1 < last and values[start + child + 1] > values[start + child]:
                child += 1
            if not values[start + child] > moved:
                break
            values[start + place] = values[start + child]
            place, child = child, 2 * child + 1
        values[start + place] = moved


@njit(cache=True, error_model="numpy")
def _cut(key: Any, nodes: Any, low: int, high: int, side: Any, begin: Any, other: Any) -> int:
    """Set ``side`` to 0, 1 or 2 (the cut) by a key; return the size of the cut, or all when a half came out small."""
    size = high - low
    values = np.empty(size)
    for place in range(size):
        values[place] = key[nodes[low + place]]
    ranked = values
    _sort(ranked, 0, size)
    # where the key jumps most between 0.4 and 0.6, so that a row of a net is not cut in two
    half, best = size // 2, -1.0
    for place in range(max(1, int(0.4 * size)), min(size - 1, int(0.6 * size) + 1)):
        jump = ranked[place] - ranked[place - 1]
        if jump > best * (1.0 + 1e-9) + 1e-300 or (
            jump > 0.999 * best and abs(place - size // 2) < abs(half - size // 2)
        ):
            best, half = max(jump, best), place
    border = 0.5 * (ranked[half - 1] + ranked[half]) if ranked[half] > ranked[half - 1] else ranked[half]
    first = second = 0
    for place in range(low, high):
        node = nodes[place]
        side[node] = 0 if key[node] < border else 1
        first += 1 - side[node]
    second = size - first
    cut = 0
    for place in range(low, high):
        node = nodes[place]
        if side[node] == 1:
            for j in range(begin[node], begin[node + 1]):
                if side[other[j]] == 0:
                    side[node] = 2
                    cut += 1
                    break
    if min(first, second - cut) < 0.15 * size:
        return size
    return cut


@njit(cache=True, error_model="numpy")
def _dissect(begin: Any, other: Any, place: Any, leaf: int) -> tuple[Any, Any]:
    """Return nodes in the order of elimination and where each set of them begins."""
    count = begin.size - 1
    nodes = np.arange(count)
    part, side, level = np.zeros(count, dtype=np.int64), np.full(count, -1, dtype=np.int64), np.empty(count, np.int64)
    key, held = np.empty(count), np.empty(count, dtype=np.int64)
    starts = np.zeros(count + 1, dtype=np.int64)
    stack = np.empty((2 * count + 8, 2), dtype=np.int64)
    stack[0, 0], stack[0, 1] = 0, count
    depth, sets, tag = 1, 0, 0
    while depth > 0:
        depth -= 1
        low, high = stack[depth, 0], stack[depth, 1]
        size = high - low
        if size <= 0:
            continue
        if size <= leaf:
            starts[sets] = low
            sets += 1
            continue
        tag += 1
        for i in range(low, high):
            part[nodes[i]] = tag
        least, chosen = size, -1
        for choice in range(4):
            if choice == 0:
                far = _breadth_first(nodes[low], nodes, low, high, part, begin, other, level)
                far = _breadth_first(far, nodes, low, high, part, begin, other, level)
                for i in range(low, high):
                    node = nodes[i]
                    # what is not connected goes to the far side
                    key[node] = level[node] if level[node] >= 0 else 2.0 * size
            else:
                for i in range(low, high):
                    key[nodes[i]] = place[nodes[i], choice - 1]
            found = _cut(key, nodes, low, high, side, begin, other)
            for i in range(low, high):
                if found < least:
                    held[nodes[i]] = side[nodes[i]]
                side[nodes[i]] = -1
            if found < least:
                least, chosen = found, choice
            if choice == 0 and least <= 2:
                break
        if chosen < 0:
            starts[sets] = low
            sets += 1
            continue
        sorted_nodes = np.empty(size, dtype=np.int64)
        fill, bounds = 0, np.zeros(4, dtype=np.int64)
        for which in range(3):
            for i in range(low, high):
                if held[nodes[i]] == which:
                    sorted_nodes[fill] = nodes[i]
                    fill += 1
            bounds[which + 1] = fill
        for i in range(size):
            nodes[low + i] = sorted_nodes[i]
            part[sorted_nodes[i]] = -1
        if bounds[3] > bounds[2]:
            starts[sets] = low + bounds[2]
            sets += 1
        stack[depth, 0], stack[depth, 1] = low, low + bounds[1]
        stack[depth + 1, 0], stack[depth + 1, 1] = low + bounds[1], low + bounds[2]
        depth += 2
    _sort(starts, 0, sets)
    return nodes, starts[:sets].copy()


@njit(cache=True, error_model="numpy")
def _fronts(order: Any, begins: Any, begin: Any, other: Any) -> tuple[Any, Any, Any, int]:
    """Return the table of fronts, their later nodes, the local targets of these, and how many numbers they hold."""
    count, sets = order.size, begins.size
    rank, owner = np.empty(count, dtype=np.int64), np.empty(count, dtype=np.int64)
    fronts = np.zeros((sets, 6), dtype=np.int64)
    for s in range(sets):
        end = begins[s + 1] if s + 1 < sets else count
        fronts[s, 0], fronts[s, 1], fronts[s, 5] = begins[s], end - begins[s], -1
        for p in range(begins[s], end):
            rank[order[p]], owner[p] = p, s
    later = np.empty(max(16, 8 * count), dtype=np.int64)
    seen = np.full(count, -1, dtype=np.int64)
    child, sibling = np.full(sets, -1, dtype=np.int64), np.full(sets, -1, dtype=np.int64)
    used = size = 0
    for s in range(sets):
        first, own = fronts[s, 0], fronts[s, 1]
        if used + count > later.size:
            more = np.empty(2 * later.size + count, dtype=np.int64)
            for j in range(used):
                more[j] = later[j]
            later = more
        start = used
        for p in range(first, first + own):
            node = order[p]
            for j in range(begin[node], begin[node + 1]):
                q = rank[other[j]]
                if q >= first + own and seen[q] != s:
                    seen[q] = s
                    later[used] = q
                    used += 1
        c = child[s]
        while c >= 0:
            for j in range(fronts[c, 3], fronts[c, 3] + fronts[c, 2]):
                q = later[j]
                if q >= first + own and seen[q] != s:
                    seen[q] = s
                    later[used] = q
                    used += 1
            c = sibling[c]
        _sort(later, start, used)
        fronts[s, 2], fronts[s, 3], fronts[s, 4] = used - start, start, size
        size += (3 * (own + used - start)) ** 2
        if used > start:
            parent = owner[later[start]]
            fronts[s, 5] = parent
            sibling[s], child[parent] = child[parent], s
    target = np.empty(used, dtype=np.int64)
    for s in range(sets):
        parent = fronts[s, 5]
        for j in range(fronts[s, 3], fronts[s, 3] + fronts[s, 2]):
            target[j] = _local(later[j], parent, fronts, later)
    return fronts, later[:used].copy(), target, size


@njit(cache=True, error_model="numpy")
def _local(place: int, front: int, fronts: Any, later: Any) -> int:
    """Return the local place of a node in a front."""
    if place < fronts[front, 0] + fronts[front, 1]:
        return place - fronts[front, 0]
    low, high = fronts[front, 3], fronts[front, 3] + fronts[front, 2] - 1
    while low < high:
        middle = (low + high) // 2
        if later[middle] < place:
            low = middle + 1
        else:
            high = middle
    return fronts[front, 1] + low - fronts[front, 3]


@njit(cache=True, error_model="numpy")
def _addresses(nodes: Any, order: Any, fronts: Any, later: Any) -> Any:
    """Return where the block of every pair of nodes of every element begins, and the length of a row there."""
    rank, owner = np.empty(order.size, dtype=np.int64), np.empty(order.size, dtype=np.int64)
    for s in range(fronts.shape[0]):
        for p in range(fronts[s, 0], fronts[s, 0] + fronts[s, 1]):
            rank[order[p]], owner[p] = p, s
    count, many = nodes.shape
    found = np.empty((count, many, many, 2), dtype=np.int64)
    for e in range(count):
        for i in range(many):
            for j in range(many):
                p, q = rank[nodes[e, i]], rank[nodes[e, j]]
                s = owner[min(p, q)]
                row = 3 * (fronts[s, 1] + fronts[s, 2])
                found[e, i, j, 0] = (
                    fronts[s, 4] + 3 * _local(p, s, fronts, later) * row + 3 * _local(q, s, fronts, later)
                )
                found[e, i, j, 1] = row
    return found


def make_plan(place: ArrayLike, families: Sequence[IntArray]) -> SparsePlan:
    """Plan the elimination of a network.

    Parameters
    ----------
    place : array_like, shape (n, 3)
        Where the nodes are [m]; cuts along the axes are tried as well as cuts by distance in the graph.
    families : sequence of ndarray of int, shape (e, k)
        Nodes of the elements that couple them, one array per family.
    """
    given = np.ascontiguousarray(place, dtype=np.float64)
    count = len(given)
    pairs = [np.zeros((0, 2), dtype=np.int64)]
    for family in families:
        for i in range(family.shape[1]):
            for j in range(family.shape[1]):
                if i != j:
                    pairs.append(family[:, [i, j]])
    edges = np.concatenate(pairs)
    edges = edges[edges[:, 0] != edges[:, 1]]
    code = np.unique(edges[:, 0] * count + edges[:, 1])
    begin = np.searchsorted(code // count, np.arange(count + 1)).astype(np.int64)
    other = (code % count).astype(np.int64)
    order, begins = _dissect(begin, other, given, _LEAF)
    fronts, later, target, size = _fronts(order, begins, begin, other)
    own = _addresses(np.arange(count, dtype=np.int64)[:, None], order, fronts, later)[:, 0, 0]
    found = tuple(_addresses(np.ascontiguousarray(family), order, fronts, later) for family in families)
    return SparsePlan(order, fronts, later, target, int(size), np.ascontiguousarray(own), found)
