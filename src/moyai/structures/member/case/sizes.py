"""Sizes of a member that the numbers of its case are held against."""

from __future__ import annotations

import math
from typing import Any

from moyai.case.plausible_sizes import Periods, Sizes
from moyai.case.yaml_reader import KeyPath


def add_sizes(model: Any, sizes: Sizes, periods: Periods) -> None:
    """Add width, length and scale of the loads of a member, each with the keys that it follows from."""
    unit = model.structure
    section: KeyPath = ("structure", "section")
    shape = unit.section
    width = getattr(shape, "diameter", None) or getattr(shape, "width", None)
    if width is None:
        across = [point[0] for point in shape.points]
        width = max(across) - min(across)
    sizes[("structure", "@width")] = width, (section,)
    ends = tuple(("structure", end, key) for end in ("start", "end") for key in ("x", "y", "z"))
    pairs = [(getattr(unit.start, key), getattr(unit.end, key)) for key in ("x", "y", "z")]
    sizes[("structure", "@length")] = math.dist([a for a, _ in pairs], [b for _, b in pairs]), ends
    _loads(model, sizes, periods)


def _loads(model: Any, sizes: Sizes, periods: Periods) -> None:
    """Add drag and inertia of the fastest wave with the current at the surface, and that force at the whole length."""
    current = getattr(model.current, "speed", None) or 0.0
    found: list[tuple[float, float, tuple[KeyPath, ...]]] = []
    for index, state in enumerate(model.waves):
        key = next((key for key in ("height", "heights", "significant_height") if getattr(state, key, None)), "")
        height = max(getattr(state, key)) if key == "heights" else getattr(state, key, 0.0)
        here = [entry for entry in periods if entry[1][:2] == ("waves", index)]
        if not key or not here:
            return  # a spectrum from a file
        found += [(height, period, (("waves", index, key), path)) for period, path in here]
    if model.structure.motion is not None or not (found or current):
        return
    height, period, of = max(found, key=lambda wave: wave[0] / wave[1], default=(0.0, 1.0, ()))
    speed = math.pi * height / period + current
    acceleration = 2.0 * math.pi**2 * height / period**2
    (width, of_width), (length, of_length) = sizes[("structure", "@width")], sizes[("structure", "@length")]
    force = model.site.density * length * (width * speed**2 + width**2 * acceleration)
    keys = (*of, *((("current", "speed"),) if current else ()), *of_width, *of_length)
    sizes[("structure", "@wave_force")] = force, keys
    sizes[("structure", "@wave_moment")] = force * length, keys
