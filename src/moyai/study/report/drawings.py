"""Drawings of a study: maps over two axes, all axes at once, roses."""

from __future__ import annotations

import math
from html import escape

import numpy as np
from numpy.typing import NDArray

from moyai.core.arrays import Array
from moyai.report.document import Drawing
from moyai.report.formatting import display_unit, format_number
from moyai.report.sketch import with_colours
from moyai.study.report.reading import AxisLabels, StudyPages

_WIDTH = 960.0
_RAMP = ((0.0, (240, 246, 250)), (0.5, (150, 195, 222)), (1.0, (20, 90, 150)))
_FAILED = "#d9d9d9"


def colour(share: float) -> str:
    """Return a fill between light and dark; grey where nothing is known."""
    if not math.isfinite(share):
        return _FAILED
    stops = [stop for stop, _ in _RAMP]
    parts = [float(np.interp(share, stops, [rgb[n] for _, rgb in _RAMP])) for n in range(3)]
    return "#" + "".join(f"{round(part):02x}" for part in parts)


def _share(values: Array) -> Array:
    known = values[np.isfinite(values)]
    low, high = (float(known.min()), float(known.max())) if known.size else (0.0, 1.0)
    return (values - low) / (high - low) if high > low else np.where(np.isfinite(values), 0.5, math.nan)


def heat_map(pages: StudyPages, name: str, columns: AxisLabels, rows: AxisLabels) -> Drawing | None:
    """Return the largest value of a response over two axes, the others at their worst; ``None`` without response."""
    found = pages.response(name)
    if found is None:
        return None
    flat, unit, label = found
    table = flat.reshape(pages.shape)
    i, j = (pages.axes.index(axis) for axis in (columns, rows))
    others = tuple(place for place in range(table.ndim) if place not in (i, j))
    filled = np.where(np.isfinite(table), table, -math.inf)
    worst = filled.max(axis=others) if others else filled
    worst = np.where(np.isfinite(worst), worst, math.nan)
    if i > j:
        worst = worst.T
    shown = display_unit(unit, worst)
    numbers = worst * shown.factor
    share = _share(worst)
    left, top, cell = 150.0, 24.0, 30.0
    width = (_WIDTH - left - 12.0) / len(columns.labels)
    height = top + cell * len(rows.labels) + 56.0
    parts = []
    for column in range(len(columns.labels)):
        for row in range(len(rows.labels)):
            x, y = left + column * width, top + (len(rows.labels) - 1 - row) * cell
            value = numbers[column, row]
            text = format_number(float(value), 3) if math.isfinite(value) else "no result"
            words = f"{columns.labels[column]}, {rows.labels[row]}: {text} {shown.name}"
            parts.append(
                f'<rect x="{x:.1f}" y="{y:.1f}" width="{width - 1:.1f}" height="{cell - 1:.1f}" '
                f'fill="{colour(float(share[column, row]))}"><title>{escape(words)}</title></rect>'
            )
            if width > 34.0:
                ink = "#ffffff" if share[column, row] > 0.6 else "#1b2430"
                parts.append(
                    f'<text x="{x + width / 2:.1f}" y="{y + cell / 2 + 4:.1f}" text-anchor="middle" font-size="11" '
                    f'fill="{ink}">{escape(text if math.isfinite(value) else "-")}</text>'
                )
    stride = max(1, math.ceil(len(columns.labels) * 60.0 / (_WIDTH - left)))
    for column in range(0, len(columns.labels), stride):
        x = left + (column + 0.5) * width
        parts.append(_text(x, height - 38.0, columns.labels[column], "middle"))
    for row, words in enumerate(rows.labels):
        parts.append(_text(left - 8.0, top + (len(rows.labels) - 0.5 - row) * cell + 4.0, words, "end"))
    parts.append(_text(left + (_WIDTH - left) / 2, height - 12.0, columns.head, "middle", bold=True))
    parts.append(_text(8.0, 12.0, rows.head, "start", bold=True))
    svg = _svg(height, parts, f"{label} over {columns.words} and {rows.words}")
    worst_of = ", ".join(pages.axes[place].words for place in others)
    caption = f"{label}{f' [{shown.name}]' if shown.name else ''}" + (f"; worst over {worst_of}" if others else "")
    key = f"map-{name}-{columns.name}-{rows.name}".replace("/", "-").replace(" ", "-")
    title = f"{label}: over {columns.words} and {rows.words}"
    return Drawing(key, title, svg, with_colours(svg), caption + ". Grey: no result.")


def parallel_coordinates(pages: StudyPages, names: tuple[str, ...]) -> Drawing | None:
    """Return every case as a line through its place on every axis and its responses."""
    found = [(name, item) for name in names if (item := pages.response(name)) is not None]
    if not found or len(pages.axes) + len(found) < 2:
        return None
    count = len(pages.status)
    chosen = np.arange(count) if count <= 600 else np.unique(np.linspace(0, count - 1, 600).astype(int))
    places = np.array(np.unravel_index(chosen, pages.shape))
    columns: list[tuple[str, Array, list[str]]] = []
    for number, axis in enumerate(pages.axes):
        size = max(len(axis.labels) - 1, 1)
        ends = [axis.labels[0], axis.labels[-1]]
        columns.append((axis.head, places[number] / size, ends))
    last: Array = np.zeros(len(chosen))
    for _, (flat, unit, label) in found:
        values = flat[chosen]
        shown = display_unit(unit, values)
        known = values[np.isfinite(values)] * shown.factor
        low, high = (float(known.min()), float(known.max())) if known.size else (0.0, 0.0)
        last = _share(values)
        suffix = f" {shown.name}" if shown.name else ""
        ends = [format_number(low, 3) + suffix, format_number(high, 3) + suffix]
        columns.append((label, last, ends))
    top, bottom, height = 36.0 + 14.0 * len(found), 34.0, 380.0
    step = (_WIDTH - 200.0) / (len(columns) - 1)
    xs = [100.0 + step * number for number in range(len(columns))]
    order = np.argsort(np.where(np.isfinite(last), last, -1.0))
    parts = []
    for at in order:
        points = [
            (x, height - bottom - float(share[at]) * (height - top - bottom))
            for x, (_, share, _) in zip(xs, columns)
            if math.isfinite(share[at])
        ]
        path = " ".join(f"{x:.1f},{y:.1f}" for x, y in points)
        stroke = colour(0.25 + 0.75 * float(last[at])) if math.isfinite(last[at]) else _FAILED
        parts.append(f'<polyline points="{path}" fill="none" stroke="{stroke}" stroke-width="1.1" opacity="0.75"/>')
    for number, (x, (label, _, ends)) in enumerate(zip(xs, columns)):
        parts.append(f'<line class="dimension" x1="{x:.1f}" y1="{top}" x2="{x:.1f}" y2="{height - bottom}"/>')
        if number < len(pages.axes):
            parts.append(_text(x, 16.0, label, "middle", bold=True))
        else:  # long words, each in a row of its own, on the side that has room
            row = 30.0 + 14.0 * (number - len(pages.axes))
            parts.append(_text(x, row, label, "start" if x <= _WIDTH / 2 else "end", bold=True))
        parts.append(_text(x, top - 4.0, ends[1], "middle"))
        parts.append(_text(x, height - bottom + 16.0, ends[0], "middle"))
    svg = _svg(height, parts, "All cases over all axes")
    caption = f"Every line is a case{'' if count <= 600 else f' (600 of {count})'}; darker: {columns[-1][0]} larger."
    return Drawing("parallel-coordinates", "All cases at once", svg, with_colours(svg), caption)


def rose(pages: StudyPages, name: str, axis: AxisLabels) -> Drawing | None:
    """Return the largest value of a response by heading (``None`` where the axis is no angle)."""
    found = pages.response(name)
    if found is None or axis.values is None or len(axis.labels) < 3:
        return None
    flat, unit, label = found
    table = flat.reshape(pages.shape)
    place = pages.axes.index(axis)
    moved = np.moveaxis(table, place, 0).reshape(len(axis.labels), -1)
    worst = np.where(np.isfinite(moved), moved, -math.inf).max(axis=1)
    worst = np.where(np.isfinite(worst), worst, math.nan)
    shown = display_unit(unit, worst)
    degrees = axis.values if axis.unit in ("1", "", "deg") else np.degrees(axis.values)
    order, closed = _round(degrees)
    centre, radius = (_WIDTH / 2, 210.0), 170.0
    largest = float(np.nanmax(worst)) if np.isfinite(worst).any() else 1.0
    parts = []
    for share in (0.25, 0.5, 0.75, 1.0):
        circle = f'<circle class="dimension" cx="{centre[0]}" cy="{centre[1]}" r="{radius * share:.1f}" fill="none"/>'
        parts.append(circle)
        text = format_number(share * largest * shown.factor, 3)
        parts.append(_text(centre[0] + 4, centre[1] - radius * share - 3, text, "start"))
    points = []
    for at in order:
        if not math.isfinite(worst[at]):
            continue
        angle = math.radians(float(degrees[at]))
        reach = radius * float(worst[at]) / largest if largest > 0 else 0.0
        x, y = centre[0] + reach * math.cos(angle), centre[1] - reach * math.sin(angle)
        points.append(f"{x:.1f},{y:.1f}")
        parts.append(f'<circle cx="{x:.1f}" cy="{y:.1f}" r="3.5" fill="#0b5a8a"/>')
        tip = radius + 18.0
        where = (centre[0] + tip * math.cos(angle), centre[1] - tip * math.sin(angle) + 4.0)
        parts.append(_text(*where, f"{degrees[at]:g}°", "middle"))
    shape = "polygon" if closed else "polyline"
    parts.insert(0, f'<{shape} points="{" ".join(points)}" fill="none" stroke="#0b5a8a" stroke-width="2"/>')
    svg = _svg(420.0, parts, f"{label} by heading")
    caption = f"{label}{f' [{shown.name}]' if shown.name else ''}, worst of all other axes; headings from +x to +y."
    key = f"rose-{name}".replace("/", "-").replace(" ", "-")
    return Drawing(key, f"{label} by {axis.words}", svg, with_colours(svg), caption)


def _round(degrees: Array) -> tuple[NDArray[np.intp], bool]:
    """Return the order of headings round the circle, its widest gap last, and whether that gap may be bridged."""
    turned = np.mod(degrees, 360.0)
    order = np.argsort(turned)
    gaps = np.diff(np.append(turned[order], turned[order][0] + 360.0))
    widest = int(np.argmax(gaps))
    return np.roll(order, -(widest + 1)), bool(gaps[widest] <= 91.0)


def _text(x: float, y: float, words: str, anchor: str, *, bold: bool = False) -> str:
    style = 'font-size="11"' + (' font-weight="600"' if bold else "")
    return f'<text class="note" x="{x:.1f}" y="{y:.1f}" text-anchor="{anchor}" {style}>{escape(words)}</text>'


def _svg(height: float, parts: list[str], title: str) -> str:
    return (
        f'<svg viewBox="0 0 {_WIDTH:g} {height:g}" width="100%" role="img" aria-label="{escape(title)}" '
        f'xmlns="http://www.w3.org/2000/svg" font-family="inherit">' + "".join(parts) + "</svg>"
    )
