"""Drawings to scale of a floating body: on its lines, its section, one moment of its motion."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from moyai.core.arrays import Array
from moyai.report.formatting import format_number, trimmed
from moyai.report.sketch import Sketch


def _metres(length: float) -> str:
    return f"{trimmed(format_number(length, 4))} m"


@dataclass(frozen=True)
class SectionGeometry:
    """What the drawings of a floating section need, in site axes of the water level [m]."""

    #: Closed outlines of the hull at rest; shape (n, 2).
    outlines: Sequence[Array]
    centre_of_gravity: tuple[float, float]
    #: Draught; NaN where not known.
    draught: float
    #: Freeboard; NaN where not known.
    freeboard: float
    #: Beam; NaN where not known.
    beam: float
    #: Height of the section; NaN where not known.
    section_height: float
    #: Infinite or NaN: no bed is drawn.
    water_depth: float
    #: Name and shape at rest from the anchor to the fairlead.
    lines: Sequence[tuple[str, Array]]

    def box(self, with_lines: bool) -> tuple[float, float, float, float]:
        """Return x from, x to, z from, z to of the body, with its lines if asked."""
        parts = [*self.outlines, *([shape for _, shape in self.lines] if with_lines else [])]
        points = np.concatenate(parts) if parts else np.array([[-1.0, -1.0], [1.0, 1.0]])
        points = points[np.isfinite(points).all(axis=1)]
        return (
            float(points[:, 0].min()),
            float(points[:, 0].max()),
            float(points[:, 1].min()),
            float(points[:, 1].max()),
        )


def outlines_of(x: Array, z: Array) -> tuple[Array, ...]:
    """Return closed outlines, shape (n, 2) each, of points that NaN parts.

    Parameters
    ----------
    x, z : ndarray, shape (n,)
        [m].
    """
    parts = np.split(np.stack([x, z], axis=1), np.flatnonzero(~np.isfinite(x)))
    cleaned = [part[np.isfinite(part).all(axis=1)] for part in parts]
    return tuple(part for part in cleaned if len(part) >= 3)


def mooring_elevation(geometry: SectionGeometry, waves: bool = True) -> Sketch:
    """Draw the body on its lines, the bed and the water to one scale, with axes and main distances.

    Parameters
    ----------
    geometry : SectionGeometry
    waves : bool
        Whether waves of heading 0 travel to the right, and an arrow shows it.

    Returns
    -------
    Sketch
    """
    x0, x1, z0, z1 = geometry.box(with_lines=True)
    depth = geometry.water_depth
    bottom = -depth if math.isfinite(depth) else min(z0, 0.0) - 0.15 * (x1 - x0)
    span = x1 - x0
    pad = 0.06 * span
    sketch = Sketch(
        (x0 - pad, x1 + pad, bottom - 0.012 * span, max(z1, 0.0) + 0.02 * span),
        margin=(10.0, 40.0, 10.0, 40.0),
        title="Body, mooring lines, water and bed to scale",
    )
    sketch.rectangle(x0 - pad, 0.0, x1 + pad, bottom, "water")
    if math.isfinite(depth):
        sketch.rectangle(x0 - pad, bottom, x1 + pad, bottom - 0.012 * span, "bed")
        sketch.path(np.array([[x0 - pad, bottom], [x1 + pad, bottom]]), "bed-line")
    sketch.path(np.array([[x0 - pad, 0.0], [x1 + pad, 0.0]]), "surface")
    for _, shape in geometry.lines:
        sketch.path(shape, "mooring")
        ax, az = shape[0]
        sketch.rectangle(
            ax - 4 / sketch.scale, az + 4 / sketch.scale, ax + 4 / sketch.scale, az - 4 / sketch.scale, "anchor"
        )
    for outline in geometry.outlines:
        sketch.path(outline, "hull", closed=True)
    _line_labels(sketch, geometry, bottom)
    if math.isfinite(depth):
        at = x0 - 0.6 * pad
        sketch.dimension(at, 0.0, at, bottom, f"h = {_metres(depth)}", offset=0.001)
    sketch.level_mark(x1 + 0.7 * pad, 0.0)
    _axes(sketch, (0.0, 0.0), 46.0)
    if waves:
        wave_x, wave_y = sketch.px(x0 - 0.5 * pad), sketch.pz(max(z1, 0.0)) - 16.0
        sketch.arrow((wave_x, wave_y), (wave_x + 70.0, wave_y), "wave")
        sketch.label(wave_x + 78.0, wave_y + 4.0, "waves of heading 0°", "start")
    return sketch


def _line_labels(sketch: Sketch, geometry: SectionGeometry, bottom: float) -> None:
    body = geometry.box(with_lines=False)
    centre = 0.5 * (body[0] + body[1])
    rows: list[tuple[float, int]] = []
    for name, shape in geometry.lines:
        ax, az = float(shape[0, 0]), float(shape[0, 1])
        right = ax > centre
        near = [row for at, row in rows if abs(at - ax) * sketch.scale < 90.0]
        row = max(near, default=-1) + 1
        rows.append((ax, row))
        sketch.text(ax, az, name, shift=(-9.0 if right else 9.0, -9.0 - 14.0 * row), anchor="end" if right else "start")
    for right in (False, True):
        ends = [shape for _, shape in geometry.lines if (float(shape[0, 0]) > centre) == right]
        if not ends:
            continue
        far = max(ends, key=lambda shape: abs(float(shape[0, 0]) - float(shape[-1, 0])))
        a, f = float(far[0, 0]), float(far[-1, 0])
        sketch.dimension(min(a, f), bottom, max(a, f), bottom, _metres(abs(a - f)), offset=30.0)


def _axes(sketch: Sketch, origin: tuple[float, float], length: float) -> None:
    x, y = sketch.px(origin[0]), sketch.pz(origin[1])
    sketch.arrow((x, y), (x + length, y), "axis")
    sketch.arrow((x, y), (x, y - length), "axis")
    sketch.label(x + length + 5, y - 4, "x", "start", style="axis-text", size=13.0)
    sketch.label(x + 6, y - length + 4, "z", "start", style="axis-text", size=13.0)


def section_detail(geometry: SectionGeometry) -> Sketch:
    """Draw the section alone with its dimensions, centre of gravity and the signs of the motions.

    Parameters
    ----------
    geometry : SectionGeometry

    Returns
    -------
    Sketch
    """
    x0, x1, z0, z1 = geometry.box(with_lines=False)
    width, height = x1 - x0, max(z1, 0.0) - z0
    top = max(z1, 0.0) + max(0.35 * height, 0.14 * width)
    low = z0 - max(0.22 * height, 0.08 * width)
    if math.isfinite(geometry.water_depth):
        low = max(low, -geometry.water_depth)
    sketch = Sketch(
        (x0 - 0.55 * width, x1 + 0.55 * width, low, top),
        width=960.0,
        margin=(10.0, 10.0, 10.0, 10.0),
        title="Section with dimensions and signs of the motions",
    )
    sketch.rectangle(x0 - 0.55 * width, 0.0, x1 + 0.55 * width, low, "water")
    sketch.path(np.array([[x0 - 0.55 * width, 0.0], [x1 + 0.55 * width, 0.0]]), "surface")
    for _, shape in geometry.lines:
        near = shape[(np.abs(shape[:, 0] - 0.5 * (x0 + x1)) < 1.02 * width) & (shape[:, 1] > low)]
        sketch.path(_clipped(shape, near, sketch, low), "mooring")
    for outline in geometry.outlines:
        sketch.path(outline, "hull", closed=True)
    for _, shape in geometry.lines:
        sketch.dot(float(shape[-1, 0]), float(shape[-1, 1]), 3.5, "hollow")
    sketch.level_mark(x1 + 0.45 * width, 0.0)
    gx, gz = geometry.centre_of_gravity
    _dimensions(sketch, geometry, (x0, x1, z0, z1))
    _motion_signs(sketch, (x0, x1, z0, z1), top)
    if math.isfinite(gz):
        sketch.dot(gx, gz, 4.5, "marker")
        sketch.text(gx, gz, f"G, z = {_metres(gz)}", shift=(10.0, 15.0), anchor="start")
    _axes(sketch, (0.0, 0.0), 60.0)
    return sketch


def _clipped(shape: Array, near: Array, sketch: Sketch, low: float) -> Array:
    """Return the part of a line near the body, cut where it leaves the drawing."""
    limit = 0.5 * sketch.width / sketch.scale
    keep = [shape[-1]]
    for a, b in zip(shape[::-1][:-1], shape[::-1][1:], strict=True):
        share = 1.0
        if b[1] < low:
            share = min(share, (a[1] - low) / (a[1] - b[1]))
        middle = sketch.x0 + limit
        if abs(b[0] - middle) > limit and abs(b[0] - a[0]) > 0:
            share = min(share, (limit - abs(a[0] - middle)) / (abs(b[0] - middle) - abs(a[0] - middle)))
        keep.append(a + share * (b - a))
        if share < 1.0:
            break
    return np.array(keep)


def _dimensions(sketch: Sketch, geometry: SectionGeometry, box: tuple[float, float, float, float]) -> None:
    x0, x1, z0, z1 = box
    if math.isfinite(geometry.beam):
        sketch.dimension(x0, z0, x1, z0, f"B = {_metres(geometry.beam)}", offset=26.0)
    if math.isfinite(geometry.draught) and z0 < 0:
        sketch.dimension(x1, 0.0, x1, z0, f"d = {_metres(geometry.draught)}", offset=44.0)
    if math.isfinite(geometry.freeboard) and z1 > 0:
        sketch.dimension(x1, z1, x1, 0.0, f"freeboard {_metres(geometry.freeboard)}", offset=44.0)
    if math.isfinite(geometry.section_height):
        sketch.dimension(x0, z1, x0, z0, f"D = {_metres(geometry.section_height)}", offset=-44.0)


def _motion_signs(sketch: Sketch, box: tuple[float, float, float, float], top: float) -> None:
    """Show positive sway, heave and roll in the upper left corner."""
    x, y = sketch.left + 26.0, sketch.top + 74.0
    sketch.arrow((x, y), (x + 44.0, y), "axis")
    sketch.arrow((x, y), (x, y - 44.0), "axis")
    sketch.label(x + 50, y + 4, "sway +", "start", style="axis-text", size=12.0)
    sketch.label(x - 14, y - 50, "heave +", "start", style="axis-text", size=12.0)
    centre = sketch.x0 + (x + 122.0 - sketch.left) / sketch.scale, sketch.z1 - (y - 10.0 - sketch.top) / sketch.scale
    sketch.turn(centre[0], centre[1], 18.0, "axis")
    sketch.label(x + 122, y - 34, "roll +", "middle", style="axis-text")


def snapshot(
    extent: tuple[float, float, float, float],
    *,
    bed: float | None,
    surface: tuple[Array, Array] | None,
    outlines: Sequence[Array],
    pivot: tuple[float, float],
    pose: Array,
    lines: Sequence[Array],
    title: str,
) -> str:
    """Draw one moment of a side view, for paper.

    Parameters
    ----------
    extent : tuple of float
        x from, x to, z from, z to [m].
    bed : float or None
        Elevation of the bed [m].
    surface : tuple of ndarray or None
        x and elevation of the water [m].
    outlines, pivot, pose
        Body at rest, point that moves, sway, heave [m] and roll [rad].
    lines : sequence of ndarray, shape (points, 2)
    title : str

    Returns
    -------
    str
        SVG with CSS classes.
    """
    x0, x1, z0, _ = extent
    sketch = Sketch(extent, title=title)
    level = np.array([[x0, 0.0], [x1, 0.0]])
    if surface is not None:
        inside = (surface[0] >= x0) & (surface[0] <= x1)
        level = np.stack([surface[0][inside], surface[1][inside]], axis=1)
        level = np.concatenate([[[x0, level[0, 1]]], level, [[x1, level[-1, 1]]]])
    floor = z0 if bed is None else bed
    sketch.path(np.concatenate([level, [[x1, floor], [x0, floor]]]), "water", closed=True)
    sketch.path(level, "surface")
    if bed is not None:
        sketch.rectangle(x0, bed, x1, z0, "bed")
    for line in lines:
        sketch.path(line, "mooring")
    cosine, sine = math.cos(pose[2]), math.sin(pose[2])
    for outline in outlines:
        rx, rz = outline[:, 0] - pivot[0], outline[:, 1] - pivot[1]
        moved = np.stack(
            [pivot[0] + pose[0] + rx * cosine + rz * sine, pivot[1] + pose[1] + rz * cosine - rx * sine], axis=1
        )
        sketch.path(moved, "hull", closed=True)
    return sketch.svg()
