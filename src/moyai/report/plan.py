"""A floating unit on its lines seen from above, to scale."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from moyai.report.formatting import format_number, trimmed
from moyai.report.sketch import Sketch


def _metres(length: float) -> str:
    return f"{trimmed(format_number(length, 4))} m"


@dataclass(frozen=True)
class LineInPlan:
    """Alike lines of a unit: how many, and where they lead across it [m]."""

    name: str
    count: int
    anchor_x: float
    fairlead_x: float


@dataclass(frozen=True)
class UnitInPlan:
    """What the plan of a unit needs, x across and y along its crest [m]."""

    #: Sides of the unit.
    x_from: float
    x_to: float
    length: float
    lines: Sequence[LineInPlan]
    #: Ways in which the waves travel [rad].
    headings: Sequence[float]


def unit_plan(unit: UnitInPlan) -> Sketch:
    """Draw the unit from above with its lines, anchors, main distances and the waves.

    Alike lines are drawn evenly along the unit: their places along the crest do not enter the computation.

    Parameters
    ----------
    unit : UnitInPlan

    Returns
    -------
    Sketch
    """
    half = 0.5 * unit.length
    ends = [unit.x_from, unit.x_to, *(line.anchor_x for line in unit.lines)]
    x0, x1 = min(ends), max(ends)
    pad = 0.06 * max(x1 - x0, unit.length)
    # words need a drawing that is wider than high
    room = 0.5 * max(1.5 * unit.length - (x1 - x0), 0.0)
    extent = (x0 - pad - room, x1 + pad + room, -half - pad, half + pad)
    sketch = Sketch(extent, margin=(60.0, 70.0, 60.0, 60.0), title="Unit and mooring lines in plan, to scale")
    sketch.rectangle(extent[0], extent[3], extent[1], extent[2], "water")
    box = 4.0 / sketch.scale
    for line in unit.lines:
        for number in range(line.count):
            y = -half + (number + 0.5) * unit.length / line.count
            sketch.segment((line.anchor_x, y), (line.fairlead_x, y), "mooring")
            sketch.rectangle(line.anchor_x - box, y + box, line.anchor_x + box, y - box, "anchor")
            if number == line.count - 1:
                right = line.anchor_x > line.fairlead_x
                words = line.name if line.count == 1 else f"{line.count} x {line.name}"
                anchor = "end" if right else "start"
                sketch.text(line.anchor_x, y, words, shift=(-9.0 if right else 9.0, -9.0), anchor=anchor)
    sketch.rectangle(unit.x_from, half, unit.x_to, -half, "hull")
    for line in unit.lines:
        for number in range(line.count):
            y = -half + (number + 0.5) * unit.length / line.count
            sketch.dot(line.fairlead_x, y, 3.5, "hollow")
    _distances(sketch, unit, extent)
    _waves(sketch, unit.headings)
    x, y = 16.0, sketch.height - 16.0
    for end, words in (((x + 36.0, y), "x"), ((x, y - 36.0), "y")):
        sketch.arrow((x, y), end, "axis")
        sketch.label(end[0] + 6.0, end[1] + 4.0, words, "start", style="axis-text")
    return sketch


def _distances(sketch: Sketch, unit: UnitInPlan, extent: tuple[float, float, float, float]) -> None:
    half = 0.5 * unit.length
    sketch.dimension(unit.x_from, half, unit.x_to, half, f"B = {_metres(unit.x_to - unit.x_from)}", offset=-14.0)
    sketch.dimension(unit.x_to, half, unit.x_to, -half, f"l = {_metres(unit.length)}", offset=26.0)
    below = (-half - extent[2]) * sketch.scale
    for side in (-1.0, 1.0):
        lines = [line for line in unit.lines if side * (line.anchor_x - line.fairlead_x) > 0.0]
        if lines:
            far = max(lines, key=lambda line: abs(line.anchor_x - line.fairlead_x))
            a, b = sorted((far.anchor_x, far.fairlead_x))
            sketch.dimension(a, -half, b, -half, _metres(b - a), offset=below + 18.0)


def _waves(sketch: Sketch, headings: Sequence[float]) -> None:
    """Show the ways of the waves above the drawing."""
    for number, heading in enumerate(sorted({round(value, 6) for value in headings})):
        x, y = 80.0 + 190.0 * number, 36.0
        dx, dy = 26.0 * math.cos(heading), -26.0 * math.sin(heading)
        sketch.arrow((x - dx, y - dy), (x + dx, y + dy), "wave")
        degrees = trimmed(format_number(math.degrees(heading), 4))
        sketch.label(x + 36.0, y + 4.0, f"waves of heading {degrees}°", "start")
