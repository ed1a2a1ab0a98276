"""Sizes that follow from the keys of a case and that its numbers are held against: ``@beam``, ``@depth``, ``@period``.

Each comes with the keys that it follows from, so that one slip is told once.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from typing import Any

from moyai.case.yaml_reader import KeyPath

Sizes = dict[KeyPath, tuple[float, tuple[KeyPath, ...]]]

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
    if model.structure.kind in _OF_KIND:
        _OF_KIND[model.structure.kind](model, sizes)
    if model.structure.kind == "network" and not periods:
        for name, motion in model.structure.motions.items():
            if getattr(motion, "period", None) is not None:
                periods.append((motion.period, ("structure", "motions", name, "period")))
    if periods:
        shortest, longest = min(periods, key=lambda entry: entry[0]), max(periods, key=lambda entry: entry[0])
        sizes[("@shortest_period",)] = shortest[0], (shortest[1],)
        sizes[("@longest_period",)] = longest[0], (longest[1],)
    if model.structure.kind == "network":
        _duration(model, sizes)
    return {path: entry for path, entry in sizes.items() if math.isfinite(entry[0]) and entry[0] > 0.0}


def _seas(model: Any, sizes: Sizes) -> list[tuple[float, KeyPath]]:
    """Add period and length of the waves of every sea state; return all periods with their keys."""
    found: list[tuple[float, KeyPath]] = []
    for index, state in enumerate(getattr(model, "waves", ())):
        base: KeyPath = ("waves", index)
        here: list[tuple[float, KeyPath]] = []
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


def _duration(model: Any, sizes: Sizes) -> None:
    """Add the length of a run of a network."""
    settings = model.settings
    lasting: list[tuple[float, KeyPath]] = [
        (state.duration, ("waves", index, "duration"))
        for index, state in enumerate(model.waves)
        if getattr(state, "duration", None) is not None
    ]
    if settings.duration is not None:
        lasting.append((settings.duration, ("settings", "duration")))
    longest = sizes.get(("@longest_period",))
    if lasting:
        value, key = max(lasting, key=lambda entry: entry[0])
        sizes[("@duration",)] = value, (key,)
    elif longest is not None:
        sizes[("@duration",)] = 20.0 * longest[0], longest[1]


def _breakwater(model: Any, sizes: Sizes) -> None:
    unit, site = model.structure, model.site
    section: KeyPath = ("structure", "section")
    length: KeyPath = ("structure", "length")
    beam, height = _extent(unit.section)
    sizes[("structure", "@beam")] = beam, (section,)
    sizes[("structure", "@height")] = height, (section,)
    sizes[("structure", "@diagonal")] = math.hypot(beam, height), (section,)
    block = site.density * beam * height * unit.length
    of = (section, length, _DENSITY)
    rate = math.sqrt(site.gravity / beam) if beam > 0.0 else 0.0
    sizes[("structure", "@block")] = block, of
    sizes[("structure", "@block_weight")] = block * site.gravity, (*of, _GRAVITY)
    sizes[("structure", "@frequency")] = rate, (section, _GRAVITY)
    sizes[("structure", "@heave_damping")] = block * rate, (*of, _GRAVITY)
    sizes[("structure", "@roll_inertia")] = block * beam * beam, of
    sizes[("structure", "@roll_damping")] = block * beam * beam * rate, (*of, _GRAVITY)
    waterplane = site.density * site.gravity * beam * unit.length
    sizes[("structure", "@waterplane_stiffness")] = waterplane, (*of, _GRAVITY)
    draught = unit.draught if unit.draught is not None else 0.5 * height
    for index, line in enumerate(model.lines):
        _breakwater_line(line, ("lines", index), draught, site, sizes)


def _breakwater_line(line: Any, base: KeyPath, draught: float, site: Any, sizes: Sizes) -> None:
    segments = getattr(line, "segments", ())
    if not segments:
        return
    rise = site.water_depth - draught + line.fairlead.above_keel - line.anchor.above_bed
    across, along = line.anchor.x - line.fairlead.x, line.anchor.y - line.fairlead.y
    ends = tuple((*base, end, key) for end in ("anchor", "fairlead") for key in ("x", "y"))
    sizes[(*base, "@chord")] = math.sqrt(across**2 + along**2 + rise**2), (*ends, _DEPTH)
    parts = [(part, (*base, "segments", number)) for number, part in enumerate(segments) if hasattr(part, "length")]
    total = sum(part.length for part, _ in parts)
    sizes[(*base, "@length")] = total, tuple((*path, "length") for _, path in parts)
    weight = _weight(parts, site)
    for part, path in parts:
        diameter = getattr(part, "diameter", None)
        if diameter is not None:
            area = 0.25 * math.pi * diameter**2
            key = (*path, "diameter")
            sizes[(*path, "@area")] = area, (key,)
            sizes[(*path, "@water_mass")] = site.density * area, (key, _DENSITY)
            sizes[(*path, "@water_weight")] = site.density * site.gravity * area, (key, _DENSITY, _GRAVITY)
        if getattr(part, "mass", None) is not None:
            sizes[(*path, "@weight_in_air")] = part.mass * site.gravity, ((*path, "mass"), _GRAVITY)
        sizes[(*path, "@weight_of_line")] = weight, tuple((*inner, "length") for _, inner in parts)


def _weight(parts: list[tuple[Any, KeyPath]], site: Any) -> float:
    """Return the weight in water of the segments that state it [N]."""
    total = 0.0
    for part, _ in parts:
        weight = getattr(part, "submerged_weight", None)
        if weight is None and getattr(part, "submerged_mass", None) is not None:
            weight = part.submerged_mass * site.gravity
        total += abs(weight or 0.0) * part.length
    return total


def _extent(section: Any) -> tuple[float, float]:
    """Return beam and height of a section from its keys."""
    if section.shape == "circle":
        return 2.0 * section.radius, 2.0 * section.radius
    if section.shape == "polygon":
        across, up = [point[0] for point in section.points], [point[1] for point in section.points]
        return max(across) - min(across), max(up) - min(up)
    if section.shape == "twin_pontoon":
        return 2.0 * section.pontoon_beam + section.gap, section.height
    if section.shape == "trapezoid":
        return max(section.top_beam, section.bottom_beam), section.height
    return section.beam, section.height + getattr(section, "plate_depth", 0.0)


def _curtain(model: Any, sizes: Sizes) -> None:
    unit, site = model.structure, model.site
    skirt: KeyPath = ("structure", "skirt", "length")
    span: KeyPath = ("structure", "span")
    depth = unit.skirt.length
    sizes[("structure", "@skirt")] = depth, (skirt,)
    sizes[("structure", "@skirt_mass_scale")] = site.density * depth**2, (skirt, _DENSITY)
    weight = site.density * site.gravity * depth**2
    sizes[("structure", "@skirt_weight_scale")] = weight, (skirt, _DENSITY, _GRAVITY)
    sizes[("structure", "@panel_force")] = weight * unit.span, (skirt, span, _DENSITY, _GRAVITY)
    sizes[("structure", "@panel_mass")] = site.density * depth**2 * unit.span, (skirt, span, _DENSITY)
    sizes[("@time_scale",)] = math.sqrt(unit.span / site.gravity), (span, _GRAVITY)


def _cage(model: Any, sizes: Sizes) -> None:
    unit, site = model.structure, model.site
    if unit.model == "flexible":
        sizes[("structure", "@size")] = unit.size, (("structure", "size"),)
        for key in ("collar", "sinker_tube"):
            pipe = unit.collar.pipe if key == "collar" and unit.collar is not None else unit.sinker_tube
            base: KeyPath = ("structure", key, "pipe") if key == "collar" else ("structure", key)
            if pipe is not None and (key != "collar" or unit.collar is not None):
                mass = site.density * 0.25 * math.pi * pipe.diameter**2
                sizes[(*base, "@displaced_mass")] = mass, ((*base, "diameter"), _DENSITY)
        if unit.collar is not None:
            of: KeyPath = ("structure", "collar", "pipe", "diameter")
            sizes[("structure", "collar", "@pipe_diameter")] = unit.collar.pipe.diameter, (of,)
        if unit.mooring.kind == "grid":
            _grid(unit.mooring, site, sizes)
        return
    shape: KeyPath = ("structure", "shape")
    sides = [getattr(unit.shape, key) for key in ("length", "width", "height", "diameter") if hasattr(unit.shape, key)]
    size = sorted(sides)[len(sides) // 2] if len(sides) > 2 else max(sides)
    across = getattr(unit.shape, "diameter", None)
    volume = math.prod(sides) if across is None else 0.25 * math.pi * across**2 * unit.shape.height
    mass = site.density * volume
    sizes[("structure", "@size")] = size, tuple((*shape, key) for key in ("length", "width", "height", "diameter"))
    sizes[("structure", "@block")] = mass, (shape, _DENSITY)
    sizes[("structure", "@block_weight")] = mass * site.gravity, (shape, _DENSITY, _GRAVITY)
    sizes[("structure", "@area_stiffness")] = site.density * site.gravity * size**2, (shape, _DENSITY, _GRAVITY)
    floats: KeyPath = ("structure", "floats", "diameter")
    sizes[("structure", "floats", "@displaced")] = _sphere(unit.floats.diameter, site), (floats, _DENSITY)


def _grid(grid: Any, site: Any, sizes: Sizes) -> None:
    base: KeyPath = ("structure", "mooring")
    sizes[("structure", "mesh", "@bay")] = grid.bay, ((*base, "bay"),)
    sizes[(*base, "buoys", "@displaced")] = _sphere(grid.buoys.diameter, site), ((*base, "buoys", "diameter"), _DENSITY)
    ropes = [(grid.frame_rope, (*base, "frame_rope")), (grid.bridle, (*base, "bridle"))]
    ropes += [(part, (*base, "anchor_line", index)) for index, part in enumerate(grid.anchor_line)]
    for rope, path in ropes:
        sizes[(*path, "@area")] = 0.25 * math.pi * rope.diameter**2, ((*path, "diameter"),)


def _sphere(diameter: float, site: Any) -> float:
    return float(site.density * math.pi / 6.0 * diameter**3)


def _member(model: Any, sizes: Sizes) -> None:
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


def _network(model: Any, sizes: Sizes) -> None:
    from moyai.case.plausible_network import network_sizes

    network_sizes(model, sizes)


_OF_KIND: dict[str, Callable[[Any, Sizes], None]] = {
    "breakwater": _breakwater,
    "curtain": _curtain,
    "cage": _cage,
    "member": _member,
    "network": _network,
}


def nested(rows: Any, base: KeyPath) -> Iterator[tuple[KeyPath, float]]:
    """Yield every number of nested tuples with its path."""
    for index, row in enumerate(rows):
        if isinstance(row, (tuple, list)):
            yield from nested(row, (*base, index))
        elif row is not None:
            yield (*base, index), float(row)
