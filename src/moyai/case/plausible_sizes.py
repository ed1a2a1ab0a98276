"""Sizes that follow from the keys of a case and that its numbers are compared with: ``@beam``, ``@depth``, ``@period``.

Each comes with the keys that it follows from, so that one slip is reported once.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

from moyai.case.yaml_reader import KeyPath
from moyai.core.kinds import structure_kind

Sizes = dict[KeyPath, tuple[float, tuple[KeyPath, ...]]]
Periods = list[tuple[float, KeyPath]]

_DEPTH: KeyPath = ("site", "water_depth")
_DENSITY: KeyPath = ("site", "density")
_GRAVITY: KeyPath = ("site", "gravity")


def derived_sizes(model: Any) -> Sizes:
    """Return the sizes of a case by their path, with the keys that each follows from."""
    sizes: Sizes = {}
    site = model.site
    levels: tuple[KeyPath, ...] = tuple(("site", "water_levels", name) for name in site.water_levels)
    sizes[("@depth",)] = site.water_depth + max(site.water_levels.values()), (_DEPTH, *levels)
    sizes[("structure", "@depth_mass")] = site.density * site.water_depth, (_DENSITY, _DEPTH)
    periods = _seas(model, sizes)
    structure_kind(model.structure.kind).add_sizes(model, sizes, periods)
    if periods:
        shortest, longest = min(periods, key=lambda entry: entry[0]), max(periods, key=lambda entry: entry[0])
        sizes[("@shortest_period",)] = shortest[0], (shortest[1],)
        sizes[("@longest_period",)] = longest[0], (longest[1],)
    return {path: entry for path, entry in sizes.items() if math.isfinite(entry[0]) and entry[0] > 0.0}


def _seas(model: Any, sizes: Sizes) -> Periods:
    """Add period and length of the waves of every sea state; return all periods with their keys."""
    found: Periods = []
    for index, state in enumerate(getattr(model, "waves", ())):
        base: KeyPath = ("waves", index)
        here: Periods = []
        for key in ("period", "peak_period", "significant_period"):
            if getattr(state, key, None) is not None:
                here.append((getattr(state, key), (*base, key)))
        periods = getattr(state, "periods", None)
        if periods is not None and hasattr(periods, "first"):
            here += [(periods.first, (*base, "periods", "from")), (periods.last, (*base, "periods", "to"))]
        elif periods:
            here += [(period, (*base, "periods", number)) for number, period in enumerate(periods)]
        for number, wave in enumerate(getattr(state, "waves", ())):
            if wave.period is not None:
                here.append((wave.period, (*base, "waves", number, "period")))
                length = model.site.gravity * wave.period**2 / (2.0 * math.pi)
                sizes[(*base, "waves", number, "@deep_length")] = length, ((*base, "waves", number, "period"), _GRAVITY)
        if here:
            shortest = min(here, key=lambda entry: entry[0])
            sizes[(*base, "@period")] = shortest[0], (shortest[1],)
            length = model.site.gravity * shortest[0] ** 2 / (2.0 * math.pi)
            sizes[(*base, "@deep_length")] = length, (shortest[1], _GRAVITY)
        found += here
    return found


@dataclass(frozen=True)
class FastestWater:
    """How fast the water moves about at the surface, in deep water."""

    #: [m/s], of the fastest wave and the current.
    speed: float
    #: [m/s2], of that wave.
    acceleration: float
    #: Keys that it follows from.
    of: tuple[KeyPath, ...]


def fastest_water(model: Any, periods: Periods) -> FastestWater | None:
    """Return how fast waves and current move the water; ``None`` for a spectrum from a file."""
    current = getattr(model.current, "speed", None) or 0.0
    found: list[tuple[float, float, tuple[KeyPath, ...]]] = []
    for index, state in enumerate(model.waves):
        key = next((key for key in ("height", "heights", "significant_height") if getattr(state, key, None)), "")
        height = max(getattr(state, key)) if key == "heights" else getattr(state, key, 0.0)
        here = [entry for entry in periods if entry[1][:2] == ("waves", index)]
        if not key or not here:
            return None
        found += [(height, period, (("waves", index, key), path)) for period, path in here]
    if not (found or current):
        return None
    height, period, of = max(found, key=lambda wave: wave[0] / wave[1], default=(0.0, 1.0, ()))
    speed = math.pi * height / period + current
    keys = (*of, *((("current", "speed"),) if current else ()))
    return FastestWater(speed, 2.0 * math.pi**2 * height / period**2, keys)
