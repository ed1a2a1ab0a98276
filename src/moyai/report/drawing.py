"""Drawings to scale as SVG: a small builder, and the section of a floating body on its lines.

Colours come from CSS classes, so that a drawing follows light and dark on the page; :func:`with_colours` writes the
light colours into the drawing for paper.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from html import escape

import numpy as np

from moyai.core.arrays import Array
from moyai.report.formatting import format_number, trimmed

_PAPER = """
.water{fill:#cfe4f1;stroke:none}.surface{stroke:#1f7ab0;fill:none;stroke-width:1.4}
.bed{fill:#cdbfa9;stroke:none}.bed-line{stroke:#1b2430;stroke-width:1;fill:none}
.hull{fill:#eceff2;stroke:#1b2430;stroke-width:1.5;stroke-linejoin:round}
.mooring{fill:none;stroke:#0b5a8a;stroke-width:1.8}.anchor{fill:#1b2430}
.axis{stroke:#b3261e;fill:none;stroke-width:1.3}.axis-head{fill:#b3261e}.axis-text{fill:#b3261e;font-style:italic}
.sheet{fill:none;stroke:#b4540a;stroke-width:3;stroke-linecap:round;stroke-linejoin:round}
.ghost{fill:none;stroke:#b4540a;stroke-width:1;stroke-dasharray:4 3;opacity:.75}
.buoy{fill:#f2b544;stroke:#1b2430;stroke-width:1}
.flow{stroke:#1f7ab0;fill:none;stroke-width:1.2}.flow-head{fill:#1f7ab0}
.chord{stroke:#5b6775;fill:none;stroke-width:.8;stroke-dasharray:2 3}
.dimension{stroke:#5b6775;fill:none;stroke-width:.8}.dimension-head{fill:#5b6775}
.note{fill:#1b2430}.faint{fill:#5b6775}.marker{fill:#1b2430;stroke:none}.hollow{fill:#fff;stroke:#1b2430;stroke-width:1}
"""


def with_colours(svg: str) -> str:
    """Return a drawing that carries its (light) colours along, for files and paper."""
    start = svg.index(">") + 1
    return f"{svg[:start]}<style>{_PAPER}</style>{svg[start:]}"


class Sketch:
    """Collects the parts of a drawing in metres and writes them in pixels, x to the right and z up.

    Parameters
    ----------
    extent : tuple of float
        x from, x to, z from, z to [m].
    width : float
        Width of the drawing [px]; the height follows from the scale.
    margin : tuple of float
        Left, top, right, bottom [px].
    title : str
        Read out by screen readers.
    """

    def __init__(
        self,
        extent: tuple[float, float, float, float],
        *,
        width: float = 960.0,
        margin: tuple[float, float, float, float] = (10.0, 10.0, 10.0, 10.0),
        title: str = "",
    ) -> None:
        self.x0, x1, self.z0, self.z1 = extent
        self.left, self.top = margin[0], margin[1]
        self.scale = (width - margin[0] - margin[2]) / (x1 - self.x0)
        self.width = width
        self.height = self.scale * (self.z1 - self.z0) + margin[1] + margin[3]
        self.title = title
        self._parts: list[str] = []

    def px(self, x: float) -> float:
        """Pixel of x [m]."""
        return self.left + self.scale * (x - self.x0)

    def pz(self, z: float) -> float:
        """Pixel of z [m]."""
        return self.top + self.scale * (self.z1 - z)

    def path(self, points: Array, style: str, closed: bool = False) -> None:
        """Draw a line or an area through ``points`` of shape (n, 2) [m]."""
        known = points[np.isfinite(points).all(axis=1)]
        if len(known) < 2:
            return
        steps = " ".join(f"{self.px(x):.1f},{self.pz(z):.1f}" for x, z in known)
        self._parts.append(f'<path class="{style}" d="M{steps.replace(" ", " L")}{" Z" if closed else ""}"/>')

    def rectangle(self, x0: float, z1: float, x1: float, z0: float, style: str) -> None:
        """Fill a rectangle between two corners [m]."""
        self._parts.append(
            f'<rect class="{style}" x="{self.px(x0):.1f}" y="{self.pz(z1):.1f}" '
            f'width="{self.scale * (x1 - x0):.1f}" height="{max(self.scale * (z1 - z0), 0.0):.1f}"/>'
        )

    def dot(self, x: float, z: float, radius: float, style: str) -> None:
        """Draw a dot of ``radius`` [px]."""
        self._parts.append(f'<circle class="{style}" cx="{self.px(x):.1f}" cy="{self.pz(z):.1f}" r="{radius}"/>')

    def text(
        self,
        x: float,
        z: float,
        words: str,
        style: str = "note",
        *,
        shift: tuple[float, float] = (0.0, 0.0),
        anchor: str = "middle",
        size: float = 12.0,
    ) -> None:
        """Write ``words`` at a point [m], shifted in pixels."""
        self._parts.append(
            f'<text class="{style}" x="{self.px(x) + shift[0]:.1f}" y="{self.pz(z) + shift[1]:.1f}" '
            f'text-anchor="{anchor}" font-size="{size:g}">{escape(words)}</text>'
        )

    def arrow(self, start: tuple[float, float], end: tuple[float, float], style: str, both: bool = False) -> None:
        """Draw an arrow between two points in pixels."""
        (x0, y0), (x1, y1) = start, end
        self._parts.append(f'<path class="{style}" d="M{x0:.1f},{y0:.1f} L{x1:.1f},{y1:.1f}"/>')
        length = math.hypot(x1 - x0, y1 - y0)
        if length < 1e-9:
            return
        ux, uy = (x1 - x0) / length, (y1 - y0) / length
        self._head(x1, y1, ux, uy, style)
        if both:
            self._head(x0, y0, -ux, -uy, style)

    def _head(self, x: float, y: float, ux: float, uy: float, style: str) -> None:
        size = 7.0 if style == "axis" else 5.5
        bx, by = x - size * ux, y - size * uy
        wx, wy = -0.4 * size * uy, 0.4 * size * ux
        wings = f"L{bx + wx:.1f},{by + wy:.1f} L{bx - wx:.1f},{by - wy:.1f} Z"
        self._parts.append(f'<path class="{style}-head" d="M{x:.1f},{y:.1f} {wings}"/>')

    def turn(self, x: float, z: float, radius: float, style: str) -> None:
        """Draw a clockwise three-quarter arrow about a point: positive roll, the top towards +x."""
        cx, cy = self.px(x), self.pz(z)
        angle = math.radians(-20.0)
        sx, sy = cx - radius * math.cos(angle), cy - radius * math.sin(angle)
        ex, ey = cx + radius * math.cos(math.radians(-40.0)), cy + radius * math.sin(math.radians(-40.0))
        self._parts.append(
            f'<path class="{style}" d="M{sx:.1f},{sy:.1f} A{radius:.1f},{radius:.1f} 0 0 1 {ex:.1f},{ey:.1f}"/>'
        )
        self._head(ex, ey, math.sin(math.radians(40.0)), math.cos(math.radians(40.0)), style)

    def dimension(self, x0: float, z0: float, x1: float, z1: float, words: str, *, offset: float) -> None:
        """Measure from one point to another, horizontally or vertically, ``offset`` [px] away from them."""
        if abs(z1 - z0) <= 1e-12 * (abs(x1 - x0) + 1.0):
            y = self.pz(z0) + offset
            a, b = self.px(x0), self.px(x1)
            for x, z in ((a, z0), (b, z1)):
                self._parts.append(f'<path class="dimension" d="M{x:.1f},{self.pz(z):.1f} L{x:.1f},{y + 4:.1f}"/>')
            self.arrow((a, y), (b, y), "dimension", both=True)
            self._label(0.5 * (a + b), y - 5.0, words, "middle")
            return
        x = self.px(x0) + offset
        a, b = self.pz(z0), self.pz(z1)
        over = 4.0 if offset > 0 else -4.0
        for y, at in ((a, x0), (b, x1)):
            self._parts.append(f'<path class="dimension" d="M{self.px(at):.1f},{y:.1f} L{x + over:.1f},{y:.1f}"/>')
        self.arrow((x, a), (x, b), "dimension", both=abs(a - b) > 14.0)
        self._label(x + 1.5 * over, 0.5 * (a + b) + 4.0, words, "start" if offset > 0 else "end")

    def _label(self, x: float, y: float, words: str, anchor: str) -> None:
        self._parts.append(
            f'<text class="note" x="{x:.1f}" y="{y:.1f}" text-anchor="{anchor}" font-size="12">{escape(words)}</text>'
        )

    def level_mark(self, x: float, z: float) -> None:
        """Draw the triangle of a water level."""
        cx, cy = self.px(x), self.pz(z)
        self._parts.append(
            f'<path class="hollow" d="M{cx:.1f},{cy:.1f} L{cx - 5:.1f},{cy - 8:.1f} L{cx + 5:.1f},{cy - 8:.1f} Z"/>'
        )

    def svg(self) -> str:
        """Return the drawing."""
        return (
            f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {self.width:.0f} {self.height:.0f}" role="img" '
            f'font-family="Segoe UI, Helvetica, Arial, Noto Sans CJK JP, sans-serif">'
            f"<title>{escape(self.title)}</title>{''.join(self._parts)}</svg>"
        )


def _metres(length: float) -> str:
    return f"{trimmed(format_number(length, 4))} m"


@dataclass(frozen=True)
class SectionGeometry:
    """What the drawings of a floating section need, in site axes of the water level [m].

    Parameters
    ----------
    outlines : sequence of ndarray, shape (n, 2)
        Closed outlines of the hull at rest.
    centre_of_gravity : tuple of float
    draught, freeboard, beam, section_height : float
        NaN where not known.
    water_depth : float
        Infinite or NaN: no bed is drawn.
    lines : sequence of (str, ndarray)
        Name and shape at rest from the anchor to the fairlead.
    """

    outlines: Sequence[Array]
    centre_of_gravity: tuple[float, float]
    draught: float
    freeboard: float
    beam: float
    section_height: float
    water_depth: float
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


def mooring_elevation(geometry: SectionGeometry) -> str:
    """Draw the body on its lines, the bed and the water to one scale, with axes and main distances.

    Parameters
    ----------
    geometry : SectionGeometry

    Returns
    -------
    str
        SVG with CSS classes.
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
    wave_x, wave_y = sketch.px(x0 - 0.5 * pad), sketch.pz(max(z1, 0.0)) - 16.0
    sketch.arrow((wave_x, wave_y), (wave_x + 70.0, wave_y), "dimension")
    sketch._label(wave_x + 78.0, wave_y + 4.0, "waves of heading 0°", "start")
    return sketch.svg()


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
    sketch._parts.append(f'<text class="axis-text" x="{x + length + 5:.1f}" y="{y - 4:.1f}" font-size="13">x</text>')
    sketch._parts.append(f'<text class="axis-text" x="{x + 6:.1f}" y="{y - length + 4:.1f}" font-size="13">z</text>')


def section_detail(geometry: SectionGeometry) -> str:
    """Draw the section alone with its dimensions, centre of gravity and the signs of the motions.

    Parameters
    ----------
    geometry : SectionGeometry

    Returns
    -------
    str
        SVG with CSS classes.
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
    return sketch.svg()


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
    sketch._parts.append(f'<text class="axis-text" x="{x + 50:.1f}" y="{y + 4:.1f}" font-size="12">sway +</text>')
    sketch._parts.append(f'<text class="axis-text" x="{x - 14:.1f}" y="{y - 50:.1f}" font-size="12">heave +</text>')
    centre = sketch.x0 + (x + 122.0 - sketch.left) / sketch.scale, sketch.z1 - (y - 10.0 - sketch.top) / sketch.scale
    sketch.turn(centre[0], centre[1], 18.0, "axis")
    sketch._parts.append(
        f'<text class="axis-text" x="{x + 122:.1f}" y="{y - 34:.1f}" text-anchor="middle" font-size="12">roll +</text>'
    )


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
