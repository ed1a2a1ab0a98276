"""Compiled kernels of the sparse direct solver: numbers into the fronts of a plan, elimination, solution.

The fronts are those of :mod:`moyai.flexible.sparse`; those of a line are a few nodes each.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from moyai.core.compiled import njit
from moyai.flexible.force_kernel import turn_part


@njit(cache=True, error_model="numpy")
def to_fronts(
    node_block: Any, bar_block: Any, system: Any, by_place: float, own: Any, bar_pairs: Any, hinge_pairs: Any,
    numbers: Any,
) -> None:  # fmt: skip
    """Write the blocks in the fronts of a :class:`moyai.flexible.sparse.SparsePlan`."""
    nodes, _, start, end, _, _, hinges, bending, _ = system
    numbers[:] = 0.0
    for i in range(node_block.shape[0]):
        place, row = own[i, 0], own[i, 1]
        for p in range(3):
            for q in range(3):
                numbers[place + p * row + q] = node_block[i, p, q] * nodes[9 + p, i] * nodes[9 + q, i]
            if nodes[9 + p, i] == 0.0:
                numbers[place + p * row + p] = 1.0
    for k in range(start.size):
        for turned in range(2):
            a, b = (start[k], end[k]) if turned == 0 else (end[k], start[k])
            place, row = bar_pairs[k, turned, 1 - turned, 0], bar_pairs[k, turned, 1 - turned, 1]
            for p in range(3):
                for q in range(3):
                    value = bar_block[k, turned, p, q] * nodes[9 + p, a] * nodes[9 + q, b]
                    numbers[place + p * row + q] += value
    for h in range(hinges.shape[0]):
        for m in range(3):
            for n in range(3):
                if m != n:
                    a, b = hinges[h, m], hinges[h, n]
                    value = by_place * bending[h, 0] * turn_part(bending, h, m) * turn_part(bending, h, n)
                    place, row = hinge_pairs[h, m, n, 0], hinge_pairs[h, m, n, 1]
                    for p in range(3):
                        numbers[place + p * row + p] += value * nodes[9 + p, a] * nodes[9 + p, b]


@njit(cache=True, error_model="numpy")
def add_elements(element: Any, members: Any, pairs: Any, free: Any, scale: float, numbers: Any) -> None:
    """Add ``scale`` times the blocks (e, k, k, 3, 3) of a family of elements to the fronts."""
    for e in range(members.shape[0]):
        for i in range(members.shape[1]):
            for j in range(members.shape[1]):
                place, row = pairs[e, i, j, 0], pairs[e, i, j, 1]
                for p in range(3):
                    for q in range(3):
                        value = element[e, i, j, p, q] * free[p, members[e, i]] * free[q, members[e, j]]
                        numbers[place + p * row + q] += scale * value


@njit(cache=True, error_model="numpy", fastmath={"contract", "reassoc"})
def factor_fronts(numbers: Any, fronts: Any, target: Any, strict: bool) -> bool:
    """Factor all fronts in place, L U without exchanging rows; False at a pivot of zero or, if ``strict``, below it.

    A matrix whose symmetric part is positive has positive pivots only; one of drag may lack it and still be that of a
    stable rest.
    """
    for s in range(fronts.shape[0]):
        own, dim = 3 * fronts[s, 1], 3 * (fronts[s, 1] + fronts[s, 2])
        front = numbers[fronts[s, 4] : fronts[s, 4] + dim * dim].reshape(dim, dim)
        for k in range(0, own, 3):
            # three pivots at a time: their rows first, then everything below and right of them
            for q in range(3):
                pivot = front[k + q, k + q]
                if not (pivot > 0.0 or (pivot < 0.0 and not strict)):
                    return False
                inverse = 1.0 / pivot
                for i in range(k + q + 1, k + 3):
                    scale = front[i, k + q] * inverse
                    front[i, k + q] = scale
                    for j in range(k + q + 1, dim):
                        front[i, j] -= scale * front[k + q, j]
                front[k + q, k + q] = inverse
            first, second, third = front[k], front[k + 1], front[k + 2]
            for i in range(k + 3, dim):
                line = front[i]
                a = line[k] * first[k]
                b = (line[k + 1] - a * first[k + 1]) * second[k + 1]
                c = (line[k + 2] - a * first[k + 2] - b * second[k + 2]) * third[k + 2]
                line[k], line[k + 1], line[k + 2] = a, b, c
                for j in range(k + 3, dim):
                    line[j] -= a * first[j] + b * second[j] + c * third[j]
        parent = fronts[s, 5]
        if parent >= 0:
            wide = 3 * (fronts[parent, 1] + fronts[parent, 2])
            base = fronts[parent, 4]
            for i in range(fronts[s, 2]):
                for p in range(3):
                    row = base + (3 * target[fronts[s, 3] + i] + p) * wide
                    line = front[own + 3 * i + p]
                    for j in range(fronts[s, 2]):
                        place = row + 3 * target[fronts[s, 3] + j]
                        numbers[place] += line[own + 3 * j]
                        numbers[place + 1] += line[own + 3 * j + 1]
                        numbers[place + 2] += line[own + 3 * j + 2]
    return True


@njit(cache=True, error_model="numpy", fastmath={"contract", "reassoc"})
def solve_fronts(numbers: Any, fronts: Any, later: Any, order: Any, right: Any) -> None:
    """Solve with the factors, in place; ``right`` is (n, 3)."""
    most = 0
    for s in range(fronts.shape[0]):
        most = max(most, fronts[s, 1] + fronts[s, 2])
    local = np.empty(3 * most)
    for s in range(fronts.shape[0]):
        first, pivots, rest = fronts[s, 0], fronts[s, 1], fronts[s, 2]
        own, dim = 3 * pivots, 3 * (pivots + rest)
        front = numbers[fronts[s, 4] : fronts[s, 4] + dim * dim].reshape(dim, dim)
        for i in range(pivots):
            for p in range(3):
                local[3 * i + p] = right[order[first + i], p]
        for i in range(own):
            total = local[i]
            for k in range(i):
                total -= front[i, k] * local[k]
            local[i] = total
            right[order[first + i // 3], i % 3] = total
        for i in range(rest):
            node = order[later[fronts[s, 3] + i]]
            for p in range(3):
                total, line = right[node, p], front[own + 3 * i + p]
                for k in range(own):
                    total -= line[k] * local[k]
                right[node, p] = total
    for s in range(fronts.shape[0] - 1, -1, -1):
        first, pivots, rest = fronts[s, 0], fronts[s, 1], fronts[s, 2]
        own, dim = 3 * pivots, 3 * (pivots + rest)
        front = numbers[fronts[s, 4] : fronts[s, 4] + dim * dim].reshape(dim, dim)
        for i in range(rest):
            node = order[later[fronts[s, 3] + i]]
            for p in range(3):
                local[own + 3 * i + p] = right[node, p]
        for i in range(own - 1, -1, -1):
            total, line = right[order[first + i // 3], i % 3], front[i]
            for k in range(i + 1, dim):
                total -= line[k] * local[k]
            local[i] = total * line[i]
            right[order[first + i // 3], i % 3] = local[i]
