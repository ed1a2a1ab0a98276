"""The limit rose: permissible heights over wave direction and curtain orientation, as drawing, figure and tables."""

from __future__ import annotations

import math
from html import escape

import numpy as np

from moyai.core.arrays import Array
from moyai.report.document import Abscissa, Block, Column, Drawing, Figure, Mark, Panel, Series, Table
from moyai.report.formatting import format_number, trimmed
from moyai.report.reading import Group
from moyai.report.sketch import with_colours
from moyai.structures.curtain.report.reading import CurtainLevel, key, texts

_WIDTH, _HEIGHT, _RADIUS = 760.0, 600.0, 225.0
_CENTRE = (0.5 * _WIDTH, 265.0)


def rose_blocks(level: CurtainLevel) -> tuple[Block, ...]:
    """Return the blocks of the rose; none where it was not asked for."""
    group = level.part("limits/rose")
    orientation, heading = group.real("orientation", "orientation"), group.real("wave_heading", "wave_heading")
    height = group.real("rose_height", "orientation", "wave_heading")
    if orientation is None or heading is None or height is None:
        return ()
    blocks: list[Block] = [_drawing(level, group, orientation, heading, height)]
    held = group.real("sea_rose_height", "orientation", "sea")
    if held is not None:
        blocks += [_over_orientation(level, group, orientation, held), _table(level, group, orientation, held)]
    blocks.append(_matrix(level, orientation, heading, height))
    return tuple(blocks)


def _degrees(angle: float, turn: float = 360.0) -> float:
    return round(math.degrees(angle), 6) % turn


def _best(group: Group, orientation: Array) -> int | None:
    """Return the row of the best orientation, ``None`` where no sea chooses one."""
    best = group.number("best_orientation")
    return None if math.isnan(best) else int(np.argmin(np.abs(orientation - best)))


def _xy(radius: float, angle: float) -> tuple[float, float]:
    return _CENTRE[0] + radius * math.cos(angle), _CENTRE[1] - radius * math.sin(angle)


def _line(points: list[tuple[float, float]]) -> str:
    return "M" + " L".join(f"{x:.1f},{y:.1f}" for x, y in points)


def _drawing(level: CurtainLevel, group: Group, orientation: Array, heading: Array, height: Array) -> Drawing:
    """Draw the height held over the heading of the waves: as the curtain lies, and in its best orientation.

    Headings as everywhere: the direction in which waves travel, 0 to the right, counted against the clock.
    """
    sea_height, sea_heading = group.real("sea_height", "sea"), group.real("sea_heading", "sea")
    finite = height[np.isfinite(height)]
    top = max(float(finite.max()) if finite.size else 1.0, 0.0 if sea_height is None else float(sea_height.max()))
    scale = _RADIUS / top if top > 0.0 else _RADIUS
    parts = []
    for share in (0.25, 0.5, 0.75, 1.0):
        x, y = _CENTRE
        parts.append(f'<circle class="chord" cx="{x:.1f}" cy="{y:.1f}" r="{share * _RADIUS:.1f}"/>')
        words = trimmed(format_number(share * top))
        parts.append(
            f'<text class="faint" x="{x + 4:.1f}" y="{y - share * _RADIUS - 3:.1f}" font-size="12">{words} m</text>'
        )
    for degrees in range(0, 360, 30):
        ray = math.radians(degrees)
        parts.append(f'<path class="chord" d="{_line([_CENTRE, _xy(_RADIUS, ray)])}"/>')
        x, y = _xy(_RADIUS + 20.0, ray)
        parts.append(
            f'<text class="note" x="{x:.1f}" y="{y + 4:.1f}" text-anchor="middle" font-size="12">{degrees}°</text>'
        )
    best = _best(group, orientation)
    rows = [(0, "sheet", "as it lies")]
    if best is not None and best != 0:
        rows.append((best, "mooring", "in the orientation of the largest permissible height"))
    for place, (row, style, words) in enumerate(rows):
        values = np.where(np.isfinite(height[row]), height[row], 0.0)
        points = [_xy(scale * float(value), float(angle)) for value, angle in zip(values, heading, strict=True)]
        parts.append(f'<path class="{style}" d="{_line([*points, points[0]])}"/>')
        along = float(orientation[row]) + 0.5 * math.pi
        parts.append(f'<path class="{style}" d="{_line([_xy(22.0, along), _xy(-22.0, along)])}"/>')
        y = _HEIGHT - 40.0 + 20.0 * place
        parts.append(f'<path class="{style}" d="{_line([(60.0, y), (90.0, y)])}"/>')
        turned = trimmed(format_number(_degrees(float(orientation[row]), 180.0)))
        parts.append(
            f'<text class="note" x="98" y="{y + 4:.1f}" font-size="13">{words}: normal at {turned}° (short bar: the '
            "curtain)</text>"
        )
    if sea_height is not None and sea_heading is not None:
        for name, size, angle in zip(group.labels("sea"), sea_height, sea_heading, strict=True):
            x, y = _xy(scale * float(size), float(angle))
            parts.append(f'<circle class="marker" cx="{x:.1f}" cy="{y:.1f}" r="4.5"/>')
            parts.append(f'<text class="note" x="{x + 8:.1f}" y="{y - 6:.1f}" font-size="12">{escape(name)}</text>')
    svg = (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {_WIDTH:.0f} {_HEIGHT:.0f}" role="img" '
        f'font-family="Segoe UI, Helvetica, Arial, Noto Sans CJK JP, sans-serif">'
        f"<title>Height held over the heading of the waves</title>{''.join(parts)}</svg>"
    )
    return Drawing(
        key(level, "limit-rose"),
        "Limit rose",
        svg,
        with_colours(svg),
        "Permissible significant height over the heading to which waves travel, in the current of the case "
        f"and in half of it, the lower of both; sought up to {format_number(group.number('highest_height'))} m. "
        "Dots: the seas of the case. A dot inside a line is permissible.",
    )


def _over_orientation(level: CurtainLevel, group: Group, orientation: Array, held: Array) -> Figure:
    degrees = np.array([_degrees(float(angle), 180.0) for angle in orientation])
    order = np.argsort(degrees)
    x = {"orientation": degrees[order]}
    series = [
        Series(name, x, held[order, place], 0, place + 1, style="line+points")
        for place, name in enumerate(group.labels("sea"))
    ]
    series.append(Series("worst sea", x, group.require("held_ratio", "orientation")[order], 1, 0, style="line+points"))
    best = _best(group, orientation)
    marks = [Mark("as it lies", x=float(degrees[0]), panel=0), Mark("permitted", y=1.0, panel=1)]
    if best is not None and best != 0:
        marks.append(Mark("best orientation", x=float(degrees[best]), panel=0))
    return Figure(
        key(level, "limit-over-orientation"),
        "Permissible height over the orientation of the curtain",
        (Abscissa("orientation", "heading of the normal", "deg"),),
        (Panel("significant height held", "m", from_zero=True), Panel("held over height of the sea", from_zero=True)),
        tuple(series),
        "In waves from the direction of each sea of the case; below 1 the height of a sea is not permitted. A normal "
        "and its "
        "opposite are one orientation.",
        tuple(marks),
        height=440,
    )


def _table(level: CurtainLevel, group: Group, orientation: Array, held: Array) -> Table:
    seas, governing = group.labels("sea"), texts(group, "sea_rose_governing", "orientation", "sea")
    ratio = group.require("held_ratio", "orientation")
    heights = group.require("sea_height", "sea")
    worst = np.argmin(np.where(np.isfinite(held), held / heights, math.inf), axis=1)
    columns = [Column("Heading of the normal", [_degrees(float(a), 180.0) for a in orientation], "deg", fixed=True)]
    columns += [
        Column(f"Held in waves as {name}", [float(value) for value in held[:, place]], "m")
        for place, name in enumerate(seas)
    ]
    columns.append(Column("Held over height, worst sea", [float(value) for value in ratio], uniform=False))
    columns.append(Column("Worst sea", [seas[place] for place in worst]))
    if governing is not None:
        columns.append(Column("Governing there", [str(governing[row, place]) for row, place in enumerate(worst)]))
    best = _best(group, orientation)
    said = "No orientation permits more than the others. " if best is None else (
        f"The best orientation has its normal at {_degrees(float(orientation[best]), 180.0):.3g} degrees: it permits "
        f"{ratio[best]:.2f} times the height of its worst sea, {ratio[0]:.2f} times as it lies. "
    )  # fmt: skip
    return Table(
        key(level, "limit-rose-seas"), "Orientation and permissible height", tuple(columns),
        note=f"{said}First row: as it lies. Where several are alike, the middle of them is taken.",
        emphasised=() if best is None else (best,),
    )  # fmt: skip


def _matrix(level: CurtainLevel, orientation: Array, heading: Array, height: Array) -> Table:
    columns = [Column("Waves travel to", [_degrees(float(angle)) for angle in heading], "deg", fixed=True)]
    columns += [
        Column(f"normal at {_degrees(float(angle), 180.0):g} deg", [float(value) for value in height[row]], "m")
        for row, angle in enumerate(orientation)
    ]
    return Table(
        key(level, "limit-rose-data"), "Numbers of the limit rose", tuple(columns),
        note="Significant height held.", collapsed=True,
    )  # fmt: skip
