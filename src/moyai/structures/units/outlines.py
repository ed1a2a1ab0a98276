"""How far units stand apart, by the whole outline of their hulls from keel to deck."""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import lru_cache
from itertools import combinations

import numpy as np

from moyai.core.arrays import Array
from moyai.core.errors import InputError
from moyai.potential.sections import Hull
from moyai.structures.units.mesh import clearance
from moyai.structures.units.model import FloatingRow, Placement

#: Difference in height [m] of one height
_LEVEL = 1e-9


@lru_cache(maxsize=16)
def breadths(hull: Hull) -> Array:
    """Return the ends in x (n, 2) [m] of a hull at the heights that tell how near another one of its kind may come.

    A height at which it is narrower on both sides than at another one is left out.
    """
    runs = [np.asarray(item.edges.polyline(), dtype=float) for item in hull.outlines]
    start, end = np.concatenate(runs), np.concatenate([np.roll(run, -1, axis=0) for run in runs])
    level = np.abs(end[:, 1] - start[:, 1]) <= _LEVEL
    heights = np.unique(np.round(start[:, 1], 9))[:, None]
    share = (heights - start[:, 1]) / np.where(level, 1.0, end[:, 1] - start[:, 1])
    x = start[:, 0] + np.clip(share, 0.0, 1.0) * (end[:, 0] - start[:, 0])
    there = ~level & (share > -_LEVEL) & (share < 1.0 + _LEVEL)
    on = level & (np.abs(heights - start[:, 1]) <= _LEVEL)
    left = np.where(on, np.minimum(start[:, 0], end[:, 0]), np.where(there, x, np.inf)).min(axis=1)
    right = np.where(on, np.maximum(start[:, 0], end[:, 0]), np.where(there, x, -np.inf)).max(axis=1)
    ends = np.unique(np.column_stack([left, right]), axis=0)
    inside = (ends[:, None, 0] >= ends[None, :, 0]) & (ends[:, None, 1] <= ends[None, :, 1])
    return np.asarray(ends[inside.sum(axis=1) == 1])


def least_distance(row: FloatingRow, places: Sequence[Placement]) -> tuple[float, tuple[int, int]]:
    """Return the least distance of two units [m], negative where they overlap, and which (from 0).

    Equal units at one draught are compared height by height; a single unit has an infinite distance.

    Parameters
    ----------
    row : FloatingRow
    places : sequence of Placement
        Where its units stand.
    """
    best: tuple[float, tuple[int, int]] = (math.inf, (0, 0))
    half, ends = 0.5 * row.length, breadths(row.hull) if len(places) > 1 else np.zeros((0, 2))
    plans = [
        np.array([place.to_row(np.array([(a, -half, 0.0), (b, -half, 0.0), (b, half, 0.0), (a, half, 0.0)]))
                  for a, b in ends])[..., :2]
        for place in places if len(ends)
    ]  # fmt: skip
    around = math.hypot(half, float(np.abs(ends).max(initial=0.0)))
    for first, second in combinations(range(len(plans)), 2):
        one, other = places[first], places[second]
        if math.hypot(other.x - one.x, other.y - one.y) - 2.0 * around >= best[0]:
            continue
        # an oblique section is wide elsewhere at another height
        least = min(clearance(a, b) for a, b in zip(plans[first], plans[second], strict=True))
        if least < best[0]:
            best = least, (first, second)
    return best


def check_apart(row: FloatingRow) -> None:
    """Refuse units whose hulls lie in one another.

    Raises
    ------
    InputError
        With the two units and by how much.
    """
    least, (first, second) = least_distance(row, row.placements)
    if least <= 0.0:
        raise InputError(
            f"units {first + 1} and {second + 1} overlap by {-least:.3g} m",
            parameter="units",
            remedy="move them apart: 'gap' is the clear water between two units",
        )


__all__ = ["breadths", "check_apart", "least_distance"]
