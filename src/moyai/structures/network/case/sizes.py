"""Sizes of a network that its numbers are compared with: distances of points, volumes of floats and bodies."""

from __future__ import annotations

import math
from typing import Any

from moyai.case.plausible_sizes import Periods, Sizes
from moyai.case.yaml_reader import KeyPath

Place = tuple[float, float, float]

_DENSITY: KeyPath = ("site", "density")
_DEPTH: KeyPath = ("site", "water_depth")


def add_sizes(model: Any, sizes: Sizes, periods: Periods) -> None:
    """Add the sizes of a network with the keys that they follow from; without waves, driven points give periods."""
    _places_and_parts(model, sizes)
    if not periods:
        for name, motion in model.structure.motions.items():
            if getattr(motion, "period", None) is not None:
                periods.append((motion.period, ("structure", "motions", name, "period")))
    _duration(model, sizes, periods)


def _places_and_parts(model: Any, sizes: Sizes) -> None:
    unit, site = model.structure, model.site
    places = places_of(unit, site)
    chords: list[float] = []
    for name, line in unit.lines.items():
        base: KeyPath = ("structure", "lines", name)
        if line.start in places and line.end in places:
            (a, of_a), (b, of_b) = places[line.start], places[line.end]
            sizes[(*base, "@chord")] = math.dist(a, b), (*of_a, *of_b)
        parts = [(part.length, (*base, "parts", index, "length"))
                 for index, part in enumerate(line.parts or ()) if hasattr(part, "length")]  # fmt: skip
        if parts:
            sizes[(*base, "@length")] = sum(length for length, _ in parts), tuple(key for _, key in parts)
        chords.append(line.length or sum(length for length, _ in parts))
    corners = [_middle_of(grid.corners, site) for grid in (*unit.nets.values(), *unit.sheets.values())]
    bodies = [max(_sides(body)) for body in unit.bodies.values() if _sides(body)]
    lengths = sorted(length for length in (*chords, *corners, *bodies) if length > 0.0)
    if lengths:
        # The median: one slip does not move it where there are several lines
        sizes[("structure", "@size")] = lengths[len(lengths) // 2], ()
        for name in unit.points:
            sizes[("structure", "points", name, "@others")] = lengths[len(lengths) // 2], ()
    stiff = [kind.axial_stiffness for kind in unit.line_types.values() if getattr(kind, "axial_stiffness", None)]
    if stiff:
        sizes[("@smallest_stiffness",)] = min(stiff), ()
    for name, kind in unit.line_types.items():
        base = ("structure", "line_types", name)
        sizes[(*base, "@area")] = 0.25 * math.pi * kind.diameter**2, ((*base, "diameter"),)
    _floats(unit, site, sizes)
    for group in ("nets", "sheets"):
        for name, grid in getattr(unit, group).items():
            sizes[("structure", group, name, "@middle")] = _middle_of(grid.corners, site), ()
    for name, body in unit.bodies.items():
        _body(body, ("structure", "bodies", name), site, sizes)


def _duration(model: Any, sizes: Sizes, periods: Periods) -> None:
    """Add the length of a run of a network."""
    settings = model.settings
    lasting: list[tuple[float, KeyPath]] = [
        (state.duration, ("waves", index, "duration"))
        for index, state in enumerate(model.waves)
        if getattr(state, "duration", None) is not None
    ]
    if settings.duration is not None:
        lasting.append((settings.duration, ("settings", "duration")))
    if lasting:
        value, key = max(lasting, key=lambda entry: entry[0])
        sizes[("@duration",)] = value, (key,)
    elif periods:
        period, key = max(periods, key=lambda entry: entry[0])
        sizes[("@duration",)] = 20.0 * period, (key,)


def places_of(unit: Any, site: Any) -> dict[str, tuple[Place, tuple[KeyPath, ...]]]:
    """Return every point, knots at corners among them, with the keys of its place."""
    depth = site.water_depth if math.isfinite(site.water_depth) else 0.0
    places: dict[str, tuple[Place, tuple[KeyPath, ...]]] = {}
    for name, point in unit.points.items():
        x, y, z = point.position
        base: KeyPath = ("structure", "points", name, "position")
        of = tuple((*base, index) for index in range(3)) + ((_DEPTH,) if z is None else ())
        places[name] = (x, y, -depth if z is None else z), of
    for group in ("nets", "sheets"):
        for name, grid in getattr(unit, group).items():
            corners = [(x, y, -depth if z is None else z) for x, y, z in grid.corners]
            last, right = grid.rows - 1, grid.columns - 1
            knots = [(0, 0), (0, right), (last, right), (last, 0)]
            of = (("structure", group, name, "corners"),)
            places.update({f"{name}[{i},{j}]": (corner, of) for (i, j), corner in zip(knots, corners)})
    for name, body in unit.bodies.items():
        base = ("structure", "bodies", name)
        for key, shift in body.points.items():
            if any(body.rotation_deg):
                continue
            place = tuple(a + b for a, b in zip(body.position, shift))
            places[key] = place, ((*base, "position"), (*base, "points", key))
    return places


def _middle_of(corners: Any, site: Any) -> float:
    """Return the middle one of the sides and diagonals between four corners [m]."""
    depth = site.water_depth if math.isfinite(site.water_depth) else 0.0
    points = [(x, y, -depth if z is None else z) for x, y, z in corners]
    apart = sorted(math.dist(a, b) for index, a in enumerate(points) for b in points[:index])
    return apart[len(apart) // 2]


def _floats(unit: Any, site: Any, sizes: Sizes) -> None:
    for name, point in unit.points.items():
        base: KeyPath = ("structure", "points", name)
        diameter = getattr(point, "diameter", None)
        if diameter is not None:
            high = getattr(point, "height", None)
            volume = math.pi / 6.0 * diameter**3 if high is None else 0.25 * math.pi * diameter**2 * high
            sizes[(*base, "@displaced")] = site.density * volume, ((*base, "diameter"), _DENSITY)


def _sides(body: Any) -> tuple[float, ...]:
    if body.shape == "box":
        return tuple(body.size)
    return (body.diameter, body.height) if body.shape == "cylinder" else ()


def _body(body: Any, base: KeyPath, site: Any, sizes: Sizes) -> None:
    sides = _sides(body)
    if sides:
        keys = tuple((*base, key) for key in ("size", "diameter", "height"))
        volume = math.prod(sides) if body.shape == "box" else 0.25 * math.pi * sides[0] ** 2 * sides[1]
        sizes[(*base, "@displaced")] = site.density * volume, (*keys, _DENSITY)
        sizes[(*base, "@largest")] = max(sides), keys
        sizes[(*base, "@middle")] = sorted(sides)[len(sides) // 2], ()
        sizes[(*base, "coefficients_file", "@height")] = sides[-1], keys
    for index, rod in enumerate(getattr(body, "rods", ())):
        path: KeyPath = (*base, "rods", index)
        sizes[(*path, "@length")] = math.dist(rod.start, rod.end), ((*path, "start"), (*path, "end"))
        sizes[(*path, "@area")] = 0.25 * math.pi * rod.diameter**2, ((*path, "diameter"),)
    for index, part in enumerate(getattr(body, "volumes", ())):
        path = (*base, "volumes", index)
        sizes[(*path, "@face")] = float(part.volume) ** (2.0 / 3.0), ((*path, "volume"),)
