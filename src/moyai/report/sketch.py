"""A builder of drawings to scale: SVG for the page, and the same strokes in metres for drawing programs.

Colours come from CSS classes, so that a drawing follows light and dark on the page; :func:`with_colours` writes the
light colours into the drawing for paper.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from contextlib import contextmanager
from html import escape

import numpy as np

from moyai.core.arrays import Array
from moyai.report.document import Disc, Distance, Drawing, Shape, Stroke, Words

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
.wave{stroke:#1f7ab0;fill:none;stroke-width:1.4}.wave-head{fill:#1f7ab0}
.net{fill:none;stroke:#3f7d4e;stroke-width:.6}.weight{fill:#5b6775;stroke:none}
.chord{stroke:#5b6775;fill:none;stroke-width:.8;stroke-dasharray:2 3}
.dimension{stroke:#5b6775;fill:none;stroke-width:.8}.dimension-head{fill:#5b6775}
.ratio-0{fill:#08519c;stroke:none;shape-rendering:crispEdges}.ratio-1{fill:#3182bd;stroke:none;shape-rendering:crispEdges}.ratio-2{fill:#6baed6;stroke:none;shape-rendering:crispEdges}.ratio-3{fill:#9ecae1;stroke:none;shape-rendering:crispEdges}.ratio-4{fill:#deebf7;stroke:none;shape-rendering:crispEdges}
.ratio-5{fill:#fee6ce;stroke:none;shape-rendering:crispEdges}.ratio-6{fill:#fdae6b;stroke:none;shape-rendering:crispEdges}.ratio-7{fill:#e6550d;stroke:none;shape-rendering:crispEdges}.ratio-8{fill:#a63603;stroke:none;shape-rendering:crispEdges}
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
        self._shapes: list[Shape] = []

    def px(self, x: float) -> float:
        """Pixel of x [m]."""
        return self.left + self.scale * (x - self.x0)

    def pz(self, z: float) -> float:
        """Pixel of z [m]."""
        return self.top + self.scale * (self.z1 - z)

    def metres(self, px: float, py: float) -> tuple[float, float]:
        """Point [m] of a pixel."""
        return self.x0 + (px - self.left) / self.scale, self.z1 - (py - self.top) / self.scale

    def path(self, points: Array, style: str, closed: bool = False) -> None:
        """Draw a line or an area through ``points`` of shape (n, 2) [m]."""
        known = points[np.isfinite(points).all(axis=1)]
        if len(known) < 2:
            return
        self._shapes.append(Stroke(style, known, closed))
        steps = " ".join(f"{self.px(x):.1f},{self.pz(z):.1f}" for x, z in known)
        self._parts.append(f'<path class="{style}" d="M{steps.replace(" ", " L")}{" Z" if closed else ""}"/>')

    def segment(self, start: tuple[float, float], end: tuple[float, float], style: str) -> None:
        """Draw a straight line between two points [m]."""
        self.path(np.array([start, end]), style)

    def rectangle(self, x0: float, z1: float, x1: float, z0: float, style: str) -> None:
        """Fill a rectangle between two corners [m]."""
        self._shapes.append(Stroke(style, np.array([[x0, z0], [x1, z0], [x1, z1], [x0, z1]]), True))
        self._parts.append(
            f'<rect class="{style}" x="{self.px(x0):.1f}" y="{self.pz(z1):.1f}" '
            f'width="{self.scale * (x1 - x0):.1f}" height="{max(self.scale * (z1 - z0), 0.0):.1f}"/>'
        )

    def dot(self, x: float, z: float, radius: float, style: str) -> None:
        """Draw a dot of ``radius`` [px]."""
        self._shapes.append(Disc(style, (x, z), radius / self.scale))
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
        self.label(self.px(x) + shift[0], self.pz(z) + shift[1], words, anchor, style=style, size=size)

    def label(self, x: float, y: float, words: str, anchor: str, *, style: str = "note", size: float = 12.0) -> None:
        """Write ``words`` at a point in pixels."""
        self._shapes.append(Words(style, self.metres(x, y), words, size / self.scale, anchor))
        self._parts.append(
            f'<text class="{style}" x="{x:.1f}" y="{y:.1f}" text-anchor="{anchor}" font-size="{size:g}">'
            f"{escape(words)}</text>"
        )

    def arrow(self, start: tuple[float, float], end: tuple[float, float], style: str, both: bool = False) -> None:
        """Draw an arrow between two points in pixels."""
        (x0, y0), (x1, y1) = start, end
        self._shapes.append(Stroke(style, np.array([self.metres(*start), self.metres(*end)])))
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
        corners = ((x, y), (bx + wx, by + wy), (bx - wx, by - wy))
        self._shapes.append(Stroke(f"{style}-head", np.array([self.metres(*corner) for corner in corners]), True))
        wings = f"L{bx + wx:.1f},{by + wy:.1f} L{bx - wx:.1f},{by - wy:.1f} Z"
        self._parts.append(f'<path class="{style}-head" d="M{x:.1f},{y:.1f} {wings}"/>')

    def turn(self, x: float, z: float, radius: float, style: str) -> None:
        """Draw a clockwise three-quarter arrow about a point: positive roll, the top towards +x."""
        cx, cy = self.px(x), self.pz(z)
        angle = math.radians(-20.0)
        way = np.radians(np.linspace(200.0, 40.0, 25))
        arc = [self.metres(cx + radius * math.cos(a), cy - radius * math.sin(a)) for a in way]
        self._shapes.append(Stroke(style, np.array(arc)))
        sx, sy = cx - radius * math.cos(angle), cy - radius * math.sin(angle)
        ex, ey = cx + radius * math.cos(math.radians(-40.0)), cy + radius * math.sin(math.radians(-40.0))
        self._parts.append(
            f'<path class="{style}" d="M{sx:.1f},{sy:.1f} A{radius:.1f},{radius:.1f} 0 0 1 {ex:.1f},{ey:.1f}"/>'
        )
        self._head(ex, ey, math.sin(math.radians(40.0)), math.cos(math.radians(40.0)), style)

    def dimension(self, x0: float, z0: float, x1: float, z1: float, words: str, *, offset: float) -> None:
        """Measure from one point to another, horizontally or vertically, ``offset`` [px] away from them."""
        kept = len(self._shapes)
        self._draw_dimension((x0, z0), (x1, z1), words, offset)
        # a drawing program draws the arrows and the text of a dimension itself
        self._shapes[kept:] = [Distance((x0, z0), (x1, z1), words, offset / self.scale, 12.0 / self.scale)]

    def _draw_dimension(self, start: tuple[float, float], end: tuple[float, float], words: str, offset: float) -> None:
        (x0, z0), (x1, z1) = start, end
        if abs(z1 - z0) <= 1e-12 * (abs(x1 - x0) + 1.0):
            y = self.pz(z0) + offset
            a, b = self.px(x0), self.px(x1)
            for x, z in ((a, z0), (b, z1)):
                self._parts.append(f'<path class="dimension" d="M{x:.1f},{self.pz(z):.1f} L{x:.1f},{y + 4:.1f}"/>')
            self.arrow((a, y), (b, y), "dimension", both=True)
            self.label(0.5 * (a + b), y - 5.0, words, "middle")
            return
        x = self.px(x0) + offset
        a, b = self.pz(z0), self.pz(z1)
        over = 4.0 if offset > 0 else -4.0
        for y, at in ((a, x0), (b, x1)):
            self._parts.append(f'<path class="dimension" d="M{self.px(at):.1f},{y:.1f} L{x + over:.1f},{y:.1f}"/>')
        self.arrow((x, a), (x, b), "dimension", both=abs(a - b) > 14.0)
        self.label(x + 1.5 * over, 0.5 * (a + b) + 4.0, words, "start" if offset > 0 else "end")

    def level_mark(self, x: float, z: float) -> None:
        """Draw the triangle of a water level."""
        cx, cy = self.px(x), self.pz(z)
        corners = ((cx, cy), (cx - 5, cy - 8), (cx + 5, cy - 8))
        self._shapes.append(Stroke("hollow", np.array([self.metres(*corner) for corner in corners]), True))
        self._parts.append(
            f'<path class="hollow" d="M{cx:.1f},{cy:.1f} L{cx - 5:.1f},{cy - 8:.1f} L{cx + 5:.1f},{cy - 8:.1f} Z"/>'
        )

    @contextmanager
    def on_the_page_alone(self) -> Iterator[None]:
        """Draw what drawing programs do not get, such as a line that the page cuts."""
        kept = len(self._shapes)
        yield
        del self._shapes[kept:]

    @contextmanager
    def off_the_page(self) -> Iterator[None]:
        """Draw for drawing programs what the page has no room for."""
        kept = len(self._parts)
        yield
        del self._parts[kept:]

    def svg(self) -> str:
        """Return the drawing."""
        return (
            f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {self.width:.0f} {self.height:.0f}" role="img" '
            f'font-family="Segoe UI, Helvetica, Arial, Noto Sans CJK JP, sans-serif">'
            f"<title>{escape(self.title)}</title>{''.join(self._parts)}</svg>"
        )

    def drawing(self, key: str, title: str, caption: str = "") -> Drawing:
        """Return the block of a report."""
        svg = self.svg()
        return Drawing(key, title, svg, with_colours(svg), caption, tuple(self._shapes))
