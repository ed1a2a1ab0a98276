"""Drawings, figures and tables of a row of units."""

from __future__ import annotations

import math

import numpy as np

from moyai.core.arrays import Array
from moyai.report.document import Abscissa, Column, Drawing, Figure, Mark, Panel, Series, Table, in_one_unit
from moyai.report.drawing import SectionGeometry, mooring_elevation, outlines_of, section_detail
from moyai.report.encoding import slug
from moyai.report.formatting import format_number, trimmed
from moyai.report.reading import Group, common_scale
from moyai.report.sketch import Sketch

#: Limits of the classes of K on the map
CLASSES = (0.2, 0.4, 0.6, 0.8, 1.0, 1.2, 1.4, 1.6)
#: Cells along the longer side of the map that are drawn; values between points are interpolated
_CELLS = 72
#: Lines whose names the plan shows, at most; angle to the row below which waves of heading 0 run across a unit [rad]
_NAMED, _ALONG = 24, 1e-6
DOFS = ("sway", "surge", "heave", "pitch", "roll", "yaw")
_LEVEL_MOTIONS = DOFS[:3]


def _words(value: float) -> str:
    return trimmed(format_number(value, 3))


def plan(level: Group) -> Drawing | None:
    """Return the row in plan with connectors and lines."""
    statics = level.child("statics")
    corners = _corners(statics)
    if corners is None:
        return None
    parts = [corners.reshape(-1, 2)]
    ends = [_points(statics, name, "line") for name in ("anchor", "fairlead")]
    parts += [item for item in ends if item is not None]
    points = np.concatenate(parts)
    low, high = points.min(axis=0), points.max(axis=0)
    pad = 0.06 * float(np.max(high - low))
    sketch = Sketch(
        (low[0] - pad, high[0] + pad, low[1] - pad, high[1] + pad), width=_width(high - low),
        margin=(10.0, 44.0, 64.0, 40.0), title="The row in plan",
    )  # fmt: skip
    names = statics.labels("line")
    if ends[0] is not None and ends[1] is not None:
        for name, anchor, fairlead in zip(names, ends[0], ends[1]):
            sketch.segment(anchor, fairlead, "mooring")
            x, y = float(anchor[0]), float(anchor[1])
            sketch.dot(x, y, 3.0, "anchor")
            right = x > float(fairlead[0])
            if len(names) <= _NAMED:
                sketch.text(x, y, name, shift=(0.0, -7.0), anchor="end" if right else "start", size=11.0)
    _units(sketch, statics, corners)
    _axes(sketch, low, pad)
    _plan_distances(sketch, corners, (low, high))
    return sketch.drawing(
        slug(level.name, "plan"), "The row in plan", "Units with their numbers, connectors (dots), lines and anchors."
    )


def _plan_distances(sketch: Sketch, corners: Array, box: tuple[Array, Array]) -> None:
    """Measure the row, one unit where the row lies along y, and all with the lines."""
    (x0, y0), (x1, y1) = (find(axis=0) for find in (corners.reshape(-1, 2).min, corners.reshape(-1, 2).max))
    low, high = box
    aside, below = (high[0] - x1) * sketch.scale, (y0 - low[1]) * sketch.scale
    sketch.dimension(x1, y1, x1, y0, f"{_words(y1 - y0)} m", offset=aside + 24.0)
    sketch.dimension(x0, y1, x1, y1, f"{_words(x1 - x0)} m", offset=(y1 - high[1]) * sketch.scale - 24.0)
    first = corners[0]
    if len(corners) > 1 and np.ptp(first[:, 1]) > np.ptp(first[:, 0]):
        a, b = float(first[:, 1].min()), float(first[:, 1].max())
        sketch.dimension(x0, b, x0, a, f"l = {_words(b - a)} m", offset=-24.0)
    if low[0] < x0 or high[0] > x1:
        sketch.dimension(low[0], y0, high[0], y0, f"{_words(high[0] - low[0])} m", offset=below + 24.0)


def sections(level: Group) -> list[Drawing]:
    """Return the section of a unit: on the lines of the first one, and alone with its dimensions."""
    statics = level.child("statics")
    x, z = statics.real("outline_x", "outline_point"), statics.real("outline_z", "outline_point")
    if x is None or z is None:
        return []
    at = [statics.real(name, "unit") for name in ("unit_x", "unit_y", "unit_heading", "unit_centre_z")]
    place_x, place_y, heading, height = (0.0 if values is None else float(values[0]) for values in at)
    owner = statics.array("line_unit", "line")
    shapes = [statics.require(f"mooring_{axis}", "line", "line_point") for axis in "xyz"]
    lines = []
    for number in np.flatnonzero(np.asarray(owner) == 1):
        name = statics.labels("line")[number]
        px, py, pz = (shape[number] for shape in shapes)
        across = (px - place_x) * math.cos(heading) + (py - place_y) * math.sin(heading)
        lines.append((name, np.stack([across, pz], axis=1)))
    facts = statics.attributes
    geometry = SectionGeometry(
        outlines_of(x, z), (0.0, height), statics.value("draught"),
        statics.value("freeboard"), float(facts.get("beam", math.nan)), float(facts.get("height", math.nan)),
        float(level.attributes["water_depth"]), lines,
    )  # fmt: skip
    alone = section_detail(geometry).drawing(
        slug(level.name, "section"), "Section of a unit",
        "To scale. Positive roll turns the top towards +x.",
    )  # fmt: skip
    if not lines:
        return [alone]
    elevation = mooring_elevation(geometry, waves=abs(heading) < _ALONG)
    caption = "To scale, across the unit; lines at rest without wind and current."
    return [elevation.drawing(slug(level.name, "elevation"), "The first unit on its lines", caption), alone]


def _width(span: Array) -> float:
    return float(np.clip(960.0 * min(1.0, 0.75 * span[0] / max(span[1], 1e-9)), 420.0, 960.0))


def _corners(statics: Group) -> Array | None:
    x, y = statics.real("plan_x", "unit", "corner"), statics.real("plan_y", "unit", "corner")
    return None if x is None or y is None else np.stack([x, y], axis=-1)


def _points(group: Group, name: str, dim: str) -> Array | None:
    x, y = group.real(f"{name}_x", dim), group.real(f"{name}_y", dim)
    return None if x is None or y is None or not len(x) else np.stack([x, y], axis=-1)


def _units(sketch: Sketch, statics: Group, corners: Array) -> None:
    for number, shape in enumerate(corners):
        sketch.path(shape, "hull", closed=True)
        middle = shape.mean(axis=0)
        sketch.text(float(middle[0]), float(middle[1]), str(number + 1), shift=(0.0, 4.0))
    places = _points(statics, "connector", "connector")
    for place in () if places is None else places:
        sketch.dot(float(place[0]), float(place[1]), 3.5, "buoy")


def _axes(sketch: Sketch, low: Array, pad: float) -> None:
    x, y = sketch.px(float(low[0]) - 0.5 * pad), sketch.pz(float(low[1]) - 0.5 * pad)
    for end, words in (((x + 36.0, y), "x"), ((x, y - 36.0), "y")):
        sketch.arrow((x, y), end, "axis")
        sketch.label(end[0] + (8.0 if words == "x" else 0.0), end[1] + (4.0 if words == "x" else -6.0), words, "middle",
                     style="axis-text")  # fmt: skip


def wave_map(level: Group, sea: Group, period: int | None) -> Drawing | None:
    """Return the map of K with the row, named points and the line behind."""
    x, y = sea.real("x", "x"), sea.real("y", "y")
    if period is None:
        ratio = sea.real("wave_height_ratio", "y", "x")
    else:
        every = sea.real("wave_height_ratio", "period", "y", "x")
        ratio = None if every is None else every[period]
    statics = level.child("statics")
    corners = _corners(statics)
    if x is None or y is None or ratio is None or corners is None or len(x) < 2 or len(y) < 2:
        return None
    span = np.array([x[-1] - x[0], y[-1] - y[0]])
    sketch = Sketch(
        (x[0], x[-1], y[0], y[-1]),
        width=_width(span),
        margin=(10.0, 10.0, 10.0, 56.0),
        title="Wave height over incident",
    )
    factor = max(1, round(_CELLS / max(len(x), len(y))))
    step = np.array([x[1] - x[0], y[1] - y[0]]) / factor
    across = np.arange(x[0] + 0.5 * step[0], x[-1], step[0])
    along = np.arange(y[0] + 0.5 * step[1], y[-1], step[1])
    for row in along:
        for column in across:
            value = _between(x, y, ratio, float(column), float(row))
            if math.isfinite(value):
                style = f"ratio-{int(np.searchsorted(CLASSES, value, side='right'))}"
                sketch.rectangle(
                    column - 0.505 * step[0],
                    row + 0.505 * step[1],
                    column + 0.505 * step[0],
                    row - 0.505 * step[1],
                    style,
                )
    _inside_units(sketch, statics, corners, x, y)
    line = _points(sea, "line", "station")
    if line is not None:
        sketch.path(line, "chord")
    named = _points(sea, "point", "point")
    values = _of_points(sea, period)
    for number, name in enumerate(sea.labels("point") if named is not None else ()):
        place = named[number]  # type: ignore[index]
        sketch.dot(float(place[0]), float(place[1]), 4.0, "hollow")
        sketch.text(float(place[0]), float(place[1]), f"{name}: {_words(float(values[number]))}", shift=(0.0, -8.0))
    _incident(sketch, float(sea.attributes.get("heading", 0.0)), x, y)
    _legend(sketch)
    when = "" if period is None else f", T = {float(sea.require('period', 'period')[period]):g} s"
    return sketch.drawing(
        slug(level.name, "map", sea.name, "" if period is None else str(period + 1)),
        f"Waves around the row: {sea.name}{when}",
        "K, the wave height over that of the incident sea; values between the computed points are interpolated. The "
        "arrow shows where the waves travel, the dashed line is that of the transmission.",
    )


def _between(x: Array, y: Array, ratio: Array, at_x: float, at_y: float) -> float:
    i, j = min(int(np.searchsorted(x, at_x)) - 1, len(x) - 2), min(int(np.searchsorted(y, at_y)) - 1, len(y) - 2)
    s, t = (at_x - x[i]) / (x[i + 1] - x[i]), (at_y - y[j]) / (y[j + 1] - y[j])
    weights = np.array([[(1 - t) * (1 - s), (1 - t) * s], [t * (1 - s), t * s]])
    values = ratio[j : j + 2, i : i + 2]
    known = np.isfinite(values)
    if not known.any():
        return math.nan
    return float((weights * np.where(known, values, 0.0)).sum() / max(float(weights[known].sum()), 1e-12))


def _inside_units(sketch: Sketch, statics: Group, corners: Array, x: Array, y: Array) -> None:
    low, high = corners.min(axis=(0, 1)), corners.max(axis=(0, 1))
    if low[0] >= x[0] and high[0] <= x[-1] and low[1] >= y[0] and high[1] <= y[-1]:
        _units(sketch, statics, corners)
        return
    for shape in corners:
        sketch.path(np.clip(shape, [x[0], y[0]], [x[-1], y[-1]]), "hull", closed=True)


def _of_points(sea: Group, period: int | None) -> Array:
    if period is None:
        return sea.require("wave_height_ratio_of_point", "point")
    return np.asarray(sea.require("wave_height_ratio_of_point", "period", "point")[period])


def _incident(sketch: Sketch, heading: float, x: Array, y: Array) -> None:
    centre = sketch.px(x[0] + 0.09 * (x[-1] - x[0])), sketch.pz(y[0] + 0.08 * (y[-1] - y[0]))
    reach = 22.0
    dx, dy = reach * math.cos(heading), -reach * math.sin(heading)
    sketch.arrow((centre[0] - dx, centre[1] - dy), (centre[0] + dx, centre[1] + dy), "axis")


def _legend(sketch: Sketch) -> None:
    size = 34.0
    top = sketch.height - 44.0
    for number in range(len(CLASSES) + 1):
        left = 14.0 + number * size
        corners = [sketch.metres(left, top), sketch.metres(left + size, top + 14.0)]
        sketch.rectangle(corners[0][0], corners[0][1], corners[1][0], corners[1][1], f"ratio-{number}")
        if number < len(CLASSES):
            sketch.label(left + size, top + 28.0, f"{CLASSES[number]:g}", "middle", size=11.0)
    sketch.label(14.0 + (len(CLASSES) + 1) * size + 10.0, top + 12.0, "K", "start")


def points_table(level: Group, sea: Group) -> Table | None:
    """Return K at named points and transmission, of a sea or of every period."""
    names = sea.labels("point") if sea.variable("wave_height_ratio_of_point") is not None else ()
    if "period" in sea.dims("wave_height_ratio"):
        period = sea.require("period", "period")
        ratios = sea.require("wave_height_ratio_of_point", "period", "point")
        columns = [Column("Period", list(period), "s")]
        columns += [Column(f"K at {name}", list(ratios[:, number])) for number, name in enumerate(names)]
        columns.append(Column("Transmission, line behind", list(sea.require("transmission_coefficient", "period"))))
        columns.append(Column("Section alone", list(sea.require("section_transmission", "period"))))
        drift = sea.real("section_drift_ratio", "period")
        if drift is not None:
            ratio = sea.require("section_motion_ratio", "period", "section_dof")
            columns += [
                Column(f"{name.capitalize()} of the middle unit / section", list(ratio[:, number]))
                for number, name in enumerate(sea.labels("section_dof"))
            ]
            columns.append(Column("Mean drift / section", list(drift)))
    else:
        values = sea.require("wave_height_ratio_of_point", "point")
        rows = [*(f"K at {name}" for name in names), "Transmission, line behind", "Section alone"]
        numbers = [*values, sea.value("transmission_coefficient"), sea.value("section_transmission")]
        columns = [Column("What", rows), Column("Value", numbers)]
    return Table(
        slug(level.name, "waves", sea.name), f"Wave heights over the incident one: {sea.name}", tuple(columns),
        note="Transmission: root mean square of K along the line behind. The section alone is the two-dimensional "
        "answer, without ends, gaps and connectors.",
    )  # fmt: skip


def _of_period(group: Group, name: str, period: int | None, *dims: str) -> Array | None:
    if period is None:
        return group.real(name, *dims)
    found = group.real(name, "period", *dims)
    return None if found is None else found[period]


def _domain(sea: Group) -> str:
    """Return ``time`` for a group of the time domain, which alone has largest motions."""
    return "time" if sea.variable("maximum_motion") is not None else ""


def _key(level: Group, what: str, sea: Group, period: int | None) -> str:
    parts = [level.name, what, sea.name, _domain(sea), "" if period is None else str(period + 1)]
    return slug(*(part for part in parts if part))


def _said(sea: Group) -> str:
    return ", time domain" if _domain(sea) else ""


def connector_table(level: Group, sea: Group, period: int | None) -> Table | None:
    """Return the loads in every connector, those with most first."""
    names = sea.labels("connector")
    resultant = _of_period(sea, "connector_resultant_largest", period, "connector")
    if not names or resultant is None:
        return None
    statics = level.child("statics")
    force = _of_period(sea, "connector_force_largest", period, "connector", "component")
    moment = _of_period(sea, "connector_moment_largest", period, "connector", "component")
    motion = _of_period(sea, "relative_motion_largest", period, "connector", "component")
    load = statics.real("connector_breaking_load", "connector")
    if force is None or moment is None or motion is None or load is None:
        return None
    use = np.divide(resultant, load, out=np.full_like(load, np.nan), where=np.isfinite(load))
    order = np.argsort(-np.where(np.isfinite(use), use, resultant / max(float(resultant.max()), 1e-300)), kind="stable")
    axes = ("x", "y", "z")
    forces = in_one_unit(
        [Column("Largest force", list(resultant[order]), "N")]
        + [Column(f"Force along {axis}", list(force[order, n]), "N") for n, axis in enumerate(axes)]
    )
    moments = in_one_unit(
        [Column(f"Moment about {axis}", list(moment[order, n]), "N m") for n, axis in enumerate(axes)], "N m"
    )
    columns = [Column("Connector", [names[n] for n in order]), *forces, *moments]
    columns += [Column(f"Motion along {axis}", list(motion[order, n]), "m") for n, axis in enumerate(axes)]
    columns.append(Column("Over breaking load", list(use[order])))
    worn = _of_period(sea, "connector_damage_rate", period, "connector")
    if worn is not None and np.isfinite(worn).any():
        columns.append(Column("Share of life an hour", list(3600.0 * worn[order])))
    when = "" if period is None else f", T = {float(sea.require('period', 'period')[period]):g} s"
    return Table(
        _key(level, "connectors", sea, period),
        f"Connectors: {sea.name}{when}{_said(sea)}", tuple(columns),
        note="Most loaded first. Largest values: "
        + ("of the record, in an irregular sea the mean of its realisations" if _domain(sea) else "mean and waves "
        "together, in an irregular sea the most probable largest in its duration")
        + ". Axes of the gap: x along the faces, y from unit to unit, z up.",
    )  # fmt: skip


def motion_table(level: Group, sea: Group, period: int | None) -> Table | None:
    """Return the motions of every unit."""
    units = sea.labels("unit")
    irregular = period is None
    name = "significant_motion" if irregular else "motion_amplitude"
    motion = _of_period(sea, name, period, "unit", "dof")
    offset = _of_period(sea, "mean_offset", period, "unit", "dof")
    if motion is None or offset is None:
        return None
    columns = [Column("Unit", list(units))]
    for number, dof in enumerate(DOFS):
        columns.append(Column(dof.capitalize(), list(motion[:, number]), "m" if dof in _LEVEL_MOTIONS else "rad"))
    columns.append(Column("Mean sway", list(offset[:, 0]), "m"))
    drift = _of_period(sea, "mean_drift_of_unit", period, "unit", "direction")
    if drift is not None:
        pushed = [Column(f"Mean drift {way}", list(drift[:, n]), "N") for n, way in enumerate(("across", "along"))]
        columns += in_one_unit(pushed)
    when = "" if period is None else f", T = {float(sea.require('period', 'period')[period]):g} s"
    return Table(
        _key(level, "motions", sea, period),
        f"Motions: {sea.name}{when}{_said(sea)}", tuple(columns),
        note=("Significant double amplitudes" if irregular else "Amplitudes")
        + " at the centre of gravity, axes of the unit: sway across, surge along, roll about the long axis.",
    )  # fmt: skip


def line_table(level: Group, sea: Group, period: int | None) -> Table | None:
    """Return the tensions of every line."""
    names = sea.labels("line")
    largest = _of_period(sea, "line_tension_maximum", period, "line")
    mean = _of_period(sea, "line_tension_mean", period, "line")
    load = level.child("statics").real("breaking_load", "line")
    if not names or largest is None or mean is None or load is None:
        return None
    columns = [
        Column("Line", list(names)),
        *in_one_unit([Column("Mean tension", list(mean), "N"), Column("Largest tension", list(largest), "N")]),
        Column("Largest over breaking load", list(largest / load)),
    ]
    when = "" if period is None else f", T = {float(sea.require('period', 'period')[period]):g} s"
    return Table(
        _key(level, "tensions", sea, period),
        f"Lines: {sea.name}{when}{_said(sea)}", tuple(columns),
        note="At rest at every instant."
        if _domain(sea)
        else "At rest at every instant, with the motions of the frequency domain.",
    )  # fmt: skip


def over_period(level: Group, sea: Group) -> Figure | None:
    """Return motions of the units and forces of the connectors over the period of regular waves."""
    period = sea.real("period", "period")
    motion = sea.real("motion_amplitude", "period", "unit", "dof")
    if period is None or motion is None or len(period) < 2:
        return None
    along = {"period": period}
    series = []
    panels = [
        Panel("sway", "m", from_zero=True),
        Panel("heave", "m", from_zero=True),
        Panel("roll", "deg", from_zero=True),
    ]
    for panel, (dof, factor) in enumerate(((0, 1.0), (2, 1.0), (4, 180.0 / math.pi))):
        for number, unit in enumerate(sea.labels("unit")):
            series.append(Series(f"unit {unit}", along, factor * motion[:, number, dof], panel, number, "line+points"))
    force = sea.real("connector_resultant_largest", "period", "connector")
    if force is not None and force.size:
        scale, unit = common_scale("N", force)
        panels.append(Panel("force in connectors", unit, from_zero=True))
        for number, name in enumerate(sea.labels("connector")):
            series.append(Series(name, along, scale * force[:, number], 3, number, "line+points", dash="dash"))
    return Figure(
        slug(level.name, "over-period", sea.name), f"Motions and forces over the period: {sea.name}",
        (Abscissa("period", "wave period T", "s"),), tuple(panels), tuple(series),
        f"Amplitudes of motion and largest resultant force, waves of {_words(sea.value('wave_height'))} m.", height=620,
    )  # fmt: skip


def along_line(level: Group, sea: Group) -> Figure | None:
    """Return K along the line behind the row."""
    line = _points(sea, "line", "station")
    if line is None:
        return None
    distance = np.hypot(*(line - line[0]).T)
    series, marks = [], []
    if "period" in sea.dims("wave_height_ratio_of_line"):
        ratio = sea.require("wave_height_ratio_of_line", "period", "station")
        for number, period in enumerate(sea.require("period", "period")):
            series.append(Series(f"T = {period:g} s", {"distance": distance}, ratio[number], 0, number))
    else:
        series.append(Series("K", {"distance": distance}, sea.require("wave_height_ratio_of_line", "station"), 0, 0))
        alone = sea.value("section_transmission")
        if math.isfinite(alone):
            marks.append(Mark("section alone", y=alone))
    return Figure(
        slug(level.name, "line-behind", sea.name), f"Waves along the line behind: {sea.name}",
        (Abscissa("distance", "distance along the line", "m"),), (Panel("K", from_zero=True),), tuple(series),
        "Wave height over that of the incident sea.", tuple(marks),
    )  # fmt: skip


def rest_table(level: Group) -> Table | None:
    """Return the units at rest."""
    statics = level.child("statics")
    mass = statics.real("unit_mass", "unit")
    offset = statics.real("steady_offset", "unit", "dof")
    if mass is None or offset is None:
        return None
    return Table(
        slug(level.name, "units-at-rest"), "Units at rest",
        (
            Column("Unit", list(statics.labels("unit"))),
            Column("x", list(statics.require("unit_x", "unit")), "m", uniform=False),
            Column("y", list(statics.require("unit_y", "unit")), "m", uniform=False),
            Column("Heading", list(statics.require("unit_heading", "unit")), "rad"),
            Column("Mass", list(mass), "kg", 5),
            Column("Sway under wind and current", list(offset[:, 0]), "m"),
            Column("Roll under wind and current", list(offset[:, 4]), "rad"),
        ),
        note=f"Draught {_words(statics.value('draught'))} m, freeboard {_words(statics.value('freeboard'))} m, GM "
        f"{_words(statics.value('metacentric_height'))} m.",
    )  # fmt: skip
