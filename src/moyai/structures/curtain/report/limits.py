"""Up to which current and wave height a curtain holds: map of the utilisation, curves of the limit."""

from __future__ import annotations

import math
from html import escape

import numpy as np
from numpy.typing import NDArray

from moyai.core.arrays import Array
from moyai.report.document import Abscissa, Column, Drawing, Figure, Mark, Panel, Series, Table
from moyai.report.formatting import DASH, format_fixed, format_number, format_quantity, pretty_unit, trimmed
from moyai.report.reading import Group
from moyai.report.sketch import with_colours
from moyai.structures.curtain.report.reading import CurtainLevel, key, texts, words

_WIDTH, _LEFT, _TOP, _BOTTOM, _CELL = 960.0, 70.0, 16.0, 92.0, 34.0
# Light to dark below one, reds above; numbers stand in the cells, so that the reading is not attached to colour
_STOPS = ((0.0, (237, 245, 250)), (0.5, (168, 206, 228)), (1.0, (84, 150, 196)))
_OVER = ((1.0, (246, 198, 160)), (1.5, (232, 128, 92)), (3.0, (178, 48, 38)))


def colour(value: float) -> str:
    """Return the fill of a cell by its utilisation."""
    stops = _STOPS if value <= 1.0 else _OVER
    levels = [level for level, _ in stops]
    parts = [float(np.interp(value, levels, [rgb[n] for _, rgb in stops])) for n in range(3)]
    return "#" + "".join(f"{round(part):02x}" for part in parts)


def _ink(value: float) -> str:
    return "#ffffff" if value > 2.0 else "#1b2430"


def _codes(names: list[str]) -> dict[str, str]:
    """Return a short mark of each component: first letters, longer where two would be the same."""
    found: dict[str, str] = {}
    for name in names:
        parts = name.split() or ["?"]
        for length in range(1, 9):
            code = "".join(part[:length] for part in parts) if len(parts) > 1 else name[: length + 1]
            if code not in found.values():
                break
        found[name] = code
    return found


def operating_map(level: CurtainLevel) -> Drawing | None:
    """Return the map of the largest utilisation over current and wave height, ``None`` where it was not computed."""
    group = level.part("limits")
    speed, height = group.real("speed", "speed"), group.real("height", "height")
    used = group.real("limit_factored_utilisation", "speed", "height")
    if speed is None or height is None or used is None or min(used.shape) < 2:
        return None
    names = texts(group, "limit_component", "speed", "height")
    svg = _map(group, speed, height, used, names)
    return Drawing(
        key(level, "operating-map"),
        "Operating limit",
        svg,
        with_colours(svg),
        "Largest utilisation of all components over current and wave height, with the component that governs; "
        f"1 is the limit, orange and red are beyond it. Line: height held in currents up to each.{_considered(group)}",
    )


def _considered(group: Group) -> str:
    """Say which loads the map takes besides the steady ones."""
    words = {
        "with_impact": "impact",
        "with_snaps": "snaps in waves",
        "with_energy_model": "energy model of the anchors",
    }
    known = [name for name in words if name in group.attributes]
    if not known:
        return ""
    taken = [words[name] for name in known if float(group.attributes[name]) > 0.0]
    said = f" With the steady load: {', '.join(taken) if taken else 'nothing'}."
    role = str(group.attributes.get("plate_role", ""))
    if role == "bound":
        return f"{said} Impact and snaps are those of an upright plate, a bound: the limits that they set are at least."
    if role in ("comparison", "out of range"):
        return f"{said} Impact and snaps of an upright plate set no limit here ({role})."
    return said


def _map(group: Group, speed: Array, height: Array, used: Array, names: NDArray[np.str_] | None) -> str:
    columns, rows = used.shape
    cell = (_WIDTH - _LEFT - 16.0) / columns
    total = _TOP + rows * _CELL + _BOTTOM
    known = [] if names is None else list(dict.fromkeys(str(name) for name in names.ravel() if str(name)))
    codes = _codes(known)
    parts = []
    for i in range(columns):
        for j in range(rows):
            value, x, y = float(used[i, j]), _LEFT + i * cell, _TOP + (rows - 1 - j) * _CELL
            name = "" if names is None else str(names[i, j])
            reported = (
                f"current {format_quantity(float(speed[i]), 'm/s')}, height {format_quantity(float(height[j]), 'm')}: "
                f"{format_number(value)}" + (f", {name}" if name else "")
            )
            fill = colour(value) if math.isfinite(value) else "#d8d8d8"
            parts.append(
                f'<rect x="{x:.1f}" y="{y:.1f}" width="{cell - 1:.1f}" height="{_CELL - 1:.1f}" fill="{fill}">'
                f"<title>{escape(reported)}</title></rect>"
            )
            shown = format_fixed(value, 2) if value < 10.0 else (">9" if math.isfinite(value) else "–")
            label = f"{shown} {codes.get(name, '')}".strip() if cell > 52.0 else shown
            if cell > 26.0:
                parts.append(
                    f'<text x="{x + 0.5 * cell:.1f}" y="{y + 0.5 * _CELL + 4:.1f}" text-anchor="middle" font-size="11" '
                    f'fill="{_ink(value)}" pointer-events="none">{escape(label)}</text>'
                )
    parts.append(_limit_line(group, speed, height, cell, rows))
    parts += _axes(speed, height, cell, rows)
    legend = ", ".join(f"{code} {name}" for name, code in codes.items())
    if legend and cell > 52.0:
        parts.append(f'<text class="faint" x="{_LEFT:.1f}" y="{total - 12:.1f}" font-size="12">{escape(legend)}</text>')
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {_WIDTH:.0f} {total:.0f}" role="img" '
        f'font-family="Segoe UI, Helvetica, Arial, Noto Sans CJK JP, sans-serif">'
        f"<title>Utilisation over current and wave height</title>{''.join(parts)}</svg>"
    )


def _place(grid: Array, value: float) -> float:
    """Return where a value stands among the cells of a grid, in cells from the first centre."""
    return float(np.interp(value, grid, np.arange(grid.size)))


def _limit_line(group: Group, speed: Array, height: Array, cell: float, rows: int) -> str:
    limit = group.real("limit_height", "speed")
    if limit is None:
        return ""
    points = []
    for i, value in enumerate(limit):
        if math.isfinite(value) and value <= height[-1]:
            y = _TOP + (rows - 1 - _place(height, float(value)) + 0.5) * _CELL
            points.append(f"{_LEFT + (i + 0.5) * cell:.1f},{y:.1f}")
        if value <= 0.0:
            break  # from here on the current alone is too much
    if len(points) < 2:
        return ""
    return f'<path d="M{" L".join(points)}" fill="none" stroke="#1b2430" stroke-width="2.2"/>'


def _axes(speed: Array, height: Array, cell: float, rows: int) -> list[str]:
    parts = []
    every = max(1, math.ceil(44.0 / cell))
    bottom = _TOP + rows * _CELL
    for i in range(0, speed.size, every):
        parts.append(
            f'<text class="note" x="{_LEFT + (i + 0.5) * cell:.1f}" y="{bottom + 16:.1f}" text-anchor="middle" '
            f'font-size="12">{trimmed(format_number(float(speed[i])))}</text>'
        )
    for j, value in enumerate(height):
        y = _TOP + (rows - 1 - j + 0.5) * _CELL + 4.0
        parts.append(
            f'<text class="note" x="{_LEFT - 8:.1f}" y="{y:.1f}" text-anchor="end" font-size="12">'
            f"{trimmed(format_number(float(value)))}</text>"
        )
    middle = _TOP + 0.5 * rows * _CELL
    parts.append(
        f'<text class="note" x="{_LEFT + 0.5 * cell * speed.size:.1f}" y="{bottom + 38:.1f}" text-anchor="middle" '
        f'font-size="13">current at the surface [{pretty_unit("m/s")}]</text>'
    )
    parts.append(
        f'<text class="note" x="16" y="{middle:.1f}" text-anchor="middle" font-size="13" '
        f'transform="rotate(-90 16 {middle:.1f})">significant wave height [m]</text>'
    )
    return parts


def limit_curve(level: CurtainLevel) -> Figure | None:
    """Return the height that each component allows over the current: where its utilisation is 1."""
    group = level.part("limits")
    speed, limit = group.real("speed", "speed"), group.real("limit_height", "speed")
    if speed is None or limit is None or not np.isfinite(limit).any():
        return None
    x = {"speed": speed}
    series = [Series("limit of all, in currents up to each", x, limit, tone=0, style="line+points")]
    height, parts = (
        group.real("height", "height"),
        group.real("component_factored_utilisation", "speed", "height", "component"),
    )
    if height is not None and parts is not None:
        for tone, name in enumerate(group.labels("component")):
            each = np.array([_crossing(height, parts[i, :, tone]) for i in range(speed.size)])
            if np.isfinite(each).any():
                series.append(Series(name, x, each, tone=tone + 1, dash="dash", faint=True))
    marks = [Mark("floats drown", x=group.value("drowning_speed")), Mark("speed limit", x=group.value("speed_limit"))]
    inside = tuple(mark for mark in marks if mark.known and mark.x is not None and mark.x <= 1.05 * float(speed[-1]))
    return Figure(
        key(level, "limit-height"),
        "Wave height that the curtain holds",
        (Abscissa("speed", "current at the surface", "m/s"),),
        (Panel("significant wave height", "m", from_zero=True),),
        tuple(series),
        "Components: where their utilisation is 1, between the heights of the map.",
        inside,
    )


def _crossing(height: Array, used: Array) -> float:
    """Return the height at which a rising utilisation is 1, 0 where it is above it already, NaN beyond the map."""
    if not np.isfinite(used).all():
        return math.nan
    above = np.flatnonzero(used > 1.0)
    if not above.size:
        return math.nan
    n = int(above[0])
    if n == 0:
        return 0.0
    return float(height[n - 1] + (1.0 - used[n - 1]) / (used[n] - used[n - 1]) * (height[n] - height[n - 1]))


def limit_table(level: CurtainLevel) -> Table | None:
    """Return current, height that it allows, and what governs there."""
    group = level.part("limits")
    speed, limit = group.real("speed", "speed"), group.real("limit_height", "speed")
    if speed is None or limit is None:
        return None
    alone = group.real("limit_height_alone", "speed")
    bounds, notes = (words(group, name, "speed", speed.size) for name in ("limit_bound", "limit_note"))
    columns = [
        Column("Current at the surface", [float(value) for value in speed], "m/s", uniform=False),
        Column("Significant height held in currents up to it", [float(value) for value in limit], "m"),
        Column("Governing", words(group, "limit_governing", "speed", speed.size)),
    ]
    if any(bounds):
        columns.insert(1, Column("Bound", [bound or DASH for bound in bounds]))
    if alone is not None and np.any(alone > limit):
        columns.append(Column("In this current alone", [float(value) for value in alone], "m"))
    if any(notes):
        columns.append(Column("In words", [note or DASH for note in notes]))
    return Table(
        key(level, "operating-limits"), "Operating limits", tuple(columns), note=" ".join(filter(None, _why(group)))
    )


def _why(group: Group) -> tuple[str, ...]:
    said = str(group.attributes.get("limit_not_monotone", ""))
    bounds = (group.attributes.get("design_limit_bound", ""), *_bounds(group))
    return (
        "A height of 0: the current alone is beyond the limit.",
        f"{said[0].upper()}{said[1:]}." if said else "",
        "At least: an upright plate, only a bound of the load, sets this limit." if "at least" in bounds else "",
        "At most: no snap is counted." if "at most" in bounds else "",
    )


def _bounds(group: Group) -> list[str]:
    speed = group.real("speed", "speed")
    return [] if speed is None else words(group, "limit_bound", "speed", speed.size)


def map_table(level: CurtainLevel) -> Table | None:
    """Return the numbers of the map, one row a pair of current and height."""
    group = level.part("limits")
    speed, height = group.real("speed", "speed"), group.real("height", "height")
    used = group.real("limit_factored_utilisation", "speed", "height")
    if speed is None or height is None or used is None:
        return None
    names = texts(group, "limit_component", "speed", "height")
    u, h = (grid.ravel() for grid in np.meshgrid(speed, height, indexing="ij"))
    columns = [
        Column("Current at the surface", [float(value) for value in u], "m/s", uniform=False),
        Column("Significant height", [float(value) for value in h], "m", uniform=False),
        Column("Largest utilisation", [float(value) for value in used.ravel()], uniform=False),
    ]
    if names is not None:
        columns.append(Column("Component", [str(name) for name in names.ravel()]))
    parts = group.real("component_factored_utilisation", "speed", "height", "component")
    if parts is not None:
        for number, name in enumerate(group.labels("component")):
            columns.append(Column(name, [float(value) for value in parts[:, :, number].ravel()], uniform=False))
    return Table(key(level, "operating-map-data"), "Numbers of the operating map", tuple(columns), collapsed=True)
