"""Drawings of a rigid cage to scale: the section on its lines, the orbits of its waves."""

from __future__ import annotations

import math

import numpy as np

from moyai.core.arrays import Array
from moyai.report.document import Drawing
from moyai.report.formatting import format_quantity
from moyai.report.sketch import Sketch
from moyai.structures.cage.report.rigid_reading import CageLevel, CageSection, RigidRecord, key, line_path, section_of

NET_LINES = 5


def circle(x: float, z: float, radius: float, count: int = 25) -> Array:
    """Return a closed circle."""
    angle = np.linspace(0.0, 2.0 * math.pi, count)
    return np.column_stack([x + radius * np.cos(angle), z + radius * np.sin(angle)])


def net_lines(outline: Array) -> list[Array]:
    """Return lines that hint at the net between the corners of the section."""
    a, b, c, d = outline  # upper left, lower left, lower right, upper right
    found = []
    for n in range(1, NET_LINES):
        share = n / NET_LINES
        found.append(np.array([a + share * (b - a), d + share * (c - d)]))
        found.append(np.array([a + share * (d - a), b + share * (c - b)]))
    return found


def elevation_drawing(level: CageLevel) -> Drawing | None:
    """Return the cage at rest on its lines, with water and bed, to scale."""
    section = section_of(level)
    if section is None:
        return None
    points = np.concatenate([section.outline, section.floats, *[ends for _, ends in section.lines]])
    left, right = float(points[:, 0].min()), float(points[:, 0].max())
    size = float(np.ptp(section.outline[:, 0]))
    bed = -level.depth if math.isfinite(level.depth) and section.lines else None
    low = float(points[:, 1].min()) if bed is None else bed
    pad = max(0.6 * size, 0.12 * (right - left))
    top = max(0.25 * size, float(points[:, 1].max()) + 0.15 * size)
    floor = low - (0.15 * size if bed is None else 0.06 * size)
    # a page is wider than high
    half = max(0.5 * (right - left) + pad, 1.1 * (top - floor))
    middle = 0.5 * (left + right)
    extent = (middle - half, middle + half, floor, top)
    sketch = Sketch(extent, width=920.0, margin=(10.0, 12.0, 10.0, 34.0), title="Cage in equilibrium on its lines")
    sketch.rectangle(extent[0], 0.0, extent[1], low if bed is not None else floor, "water")
    if bed is not None:
        sketch.rectangle(extent[0], bed, extent[1], floor, "bed")
        sketch.path(np.array([[extent[0], bed], [extent[1], bed]]), "bed-line")
    sketch.path(np.array([[extent[0], 0.0], [extent[1], 0.0]]), "surface")
    for (name, ends), length in zip(section.lines, section.lengths):
        sketch.path(line_path(ends[0], ends[1][None, :], length)[0], "mooring")
        half_box = 4.0 / sketch.scale
        ax, az = ends[0]
        sketch.rectangle(ax - half_box, az + half_box, ax + half_box, az - half_box, "anchor")
        inward = 1.0 if ax < middle else -1.0
        sketch.text(ax, az, name, shift=(-10.0 * inward, -8.0), anchor="end" if inward > 0 else "start")
    _cage(sketch, section)
    for _, ends in section.lines:
        sketch.dot(float(ends[1][0]), float(ends[1][1]), 3.5, "hollow")
    gx, gz = section.centre
    sketch.dot(gx, gz, 3.5, "marker")
    sketch.text(gx, gz, "G", shift=(8.0, -6.0), anchor="start")
    _measures(sketch, section, level, extent, bed)
    return sketch.drawing(
        key(level, "elevation"),
        "Cage at rest",
        "To scale; G: centre of gravity. Waves of heading 0 come from the left (offshore).",
    )


def _cage(sketch: Sketch, section: CageSection) -> None:
    for line in net_lines(section.outline):
        sketch.path(line, "chord")
    sketch.path(section.outline, "sheet", closed=True)
    for x, z in section.floats:
        sketch.path(circle(float(x), float(z), 0.5 * section.diameter), "buoy", closed=True)


def _measures(
    sketch: Sketch, section: CageSection, level: CageLevel, extent: tuple[float, float, float, float], bed: float | None
) -> None:
    low = float(section.outline[:, 1].min())
    left, right = float(section.outline[:, 0].min()), float(section.outline[:, 0].max())
    sketch.dimension(left, low, right, low, format_quantity(right - left, "m"), offset=20.0)
    high = float(section.outline[:, 1].max())
    sketch.dimension(right, high, right, low, format_quantity(high - low, "m"), offset=46.0)
    sketch.level_mark(extent[1] - 0.06 * (extent[1] - extent[0]), 0.0)
    if bed is None:
        return
    at = extent[0] + 0.03 * (extent[1] - extent[0])
    sketch.dimension(at, 0.0, at, bed, f"h = {format_quantity(level.depth, 'm')}", offset=0.001)
    anchors = sorted({float(ends[0][0]) for _, ends in section.lines})
    if len(anchors) > 1:
        sketch.dimension(anchors[0], bed, anchors[-1], bed, format_quantity(anchors[-1] - anchors[0], "m"), offset=24.0)


def orbit_drawing(level: CageLevel, sea: str, records: list[RigidRecord]) -> Drawing | None:
    """Return the orbits of the centre of gravity next to that of a float at the surface, one scale for all."""
    shown = [record for record in records if record.regular][:12]
    if not shown:
        return None
    loops = [_loop(record) for record in shown]
    reach = max(max(float(np.ptp(loop, axis=0).max()) for loop in loops), max(record.height for record in shown))
    cell, columns = 1.35 * reach, min(4, len(shown))
    rows = math.ceil(len(shown) / columns)
    label = 0.2 * cell
    extent = (0.0, columns * cell, -rows * (cell + label), 0.0)
    sketch = Sketch(extent, width=min(920.0, 230.0 * columns + 20.0), title="Orbits")
    for number, (record, loop) in enumerate(zip(shown, loops)):
        cx = (number % columns + 0.5) * cell
        cz = -(number // columns) * (cell + label) - label - 0.5 * cell
        half = 0.5 * cell * 0.94
        sketch.path(np.array([[cx - half, cz], [cx + half, cz]]), "chord")
        sketch.path(np.array([[cx, cz - half], [cx, cz + half]]), "chord")
        sketch.path(circle(cx, cz, 0.5 * record.height, 61), "flow")
        middle = 0.5 * (loop.max(axis=0) + loop.min(axis=0))
        placed = loop - middle + np.array([cx, cz])
        sketch.path(placed, "mooring")
        sketch.dot(float(placed[0, 0]), float(placed[0, 1]), 4.0, "marker")
        words = f"H {format_quantity(record.height, 'm')}, T {format_quantity(record.period, 's')}"
        sketch.text(cx, cz + 0.5 * cell, words, shift=(0.0, -4.0), size=12.0)
    return sketch.drawing(
        key(level, sea, "orbits"),
        f"Orbits of the cage: {sea}",
        "Centre of gravity over the last wave periods, x to the right, z up, one scale; thin circle: diameter H. The "
        "dot is the place when the crest passes x = 0.",
    )


def _loop(record: RigidRecord) -> Array:
    """Return the orbit over the last three periods, drift within them taken out, from a crest at x = 0."""
    step = float(record.time[1] - record.time[0])
    count = max(1, round(record.period / step))
    periods = max(1, min(3, (record.time.size - 1) // count))
    last = record.time.size - 1
    # rows of the run begin with a crest and repeat every count rows
    end = last - last % count
    part = record.pose[end - periods * count : end + 1, :2]
    drift = np.linspace(0.0, 1.0, len(part))[:, None] * (part[-1] - part[0])
    return np.asarray(part - drift)
