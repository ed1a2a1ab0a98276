"""The curtain and its site, the governing steady load with its band, and other steady loads next to it."""

from __future__ import annotations

import math

import numpy as np

from moyai.report.document import Cell, Column, Table
from moyai.report.formatting import display_unit, format_quantity, pretty_unit
from moyai.report.reading import Group
from moyai.structures.curtain.report.reading import CurtainLevel, key, words
from moyai.structures.curtain.report.tables import number_table

_SITE = (
    ("span", "span B", "m"),
    ("unstretched_length", "length of cables and skirt l", "m"),
    ("span_ratio", "B/l", ""),
    ("skirt_length", "skirt, from top to toe", "m"),
    ("surface_speed", "current at the surface", "m/s"),
    ("normal_speed", "mean current over the skirt, along the normal", "m/s"),
    ("flow_angle", "angle of the current from the normal", "rad"),
    ("froude_number", "Froude number", ""),
    ("load_ratio", "load ratio qL/W", ""),
    ("drowning_speed", "current that submerges the floats", "m/s"),
)
_STEADY = (
    ("line_load", "load per length of curtain", "N/m"),
    ("span_load", "load of one span, downstream", "N"),
    ("cable_tension", "tension of all cables", "N"),
    ("upper_tension", "tension of the upper cable", "N"),
    ("lower_tension", "tension of the lower cable", "N"),
    ("sheet_tension", "skirt tension", "N/m"),
    ("anchor_horizontal_tension", "force on an inner anchor", "N"),
    ("end_anchor_horizontal_tension", "force on an end anchor", "N"),
    ("anchor_tension", "tension of an anchor line", "N"),
    ("float_load", "load of the floats, weight and pull", "N/m"),
    ("effective_depth", "effective depth", "m"),
)


def site_table(level: CurtainLevel) -> Table | None:
    """Return what follows from the case before any load is taken."""
    group = level.part("statics")
    table = number_table(level, group, "site", "The curtain and its site", _SITE)
    if table is None:
        return None
    rows = [*_spacing_rows(group), *_flooded_rows(group)]
    if math.isinf(group.value("drowning_speed")):
        rows.insert(0, ("current that submerges the floats", "none up to 10 m/s", ""))
    quantity, value, unit = table.columns
    kept = [n for n, (_, number) in enumerate(zip(quantity.values, value.values, strict=True)) if number != math.inf]
    return Table(
        table.key,
        table.title,
        (
            Column("Quantity", [*(quantity.values[n] for n in kept), *(row[0] for row in rows)]),
            Column("Value", [*(value.values[n] for n in kept), *(row[1] for row in rows)], uniform=False),
            Column("Unit", [*(unit.values[n] for n in kept), *(row[2] for row in rows)]),
        ),
        note="Length of a unit and distance of anchors: at the upper end of the steady load, without waves.",
    )


def _spacing_rows(group: Group) -> list[tuple[str, Cell, str]]:
    """Return the largest length of a unit and distance of anchors, in words where there is no limit."""
    rows: list[tuple[str, Cell, str]] = []
    for name, label in (
        ("joint_spacing", "largest length of a unit for its joints"),
        ("anchor_spacing", "largest distance of anchors for cables, lines and anchors"),
    ):
        variable = group.variable(name)
        value = group.value(name)
        if variable is None or math.isnan(value):
            continue
        searched = float(variable.attrs.get("searched", math.nan))
        if math.isinf(value):
            rows.append((label, f"no limit within the range searched (up to {format_quantity(searched, 'm')})", ""))
        elif value > 0.0:
            rows.append((label, value, "m"))
        else:
            rows.append((label, f"none: {variable.attrs.get('governing', '')} fails at the shortest", ""))
        fixed = str(variable.attrs.get("fails_at_any_distance", ""))
        if fixed:
            rows.append(("fails at any distance of anchors", fixed, ""))
    return rows


def _flooded_rows(group: Group) -> list[tuple[str, Cell, str]]:
    """Return what the flooded curtain does: it floats, or sinks with a weight."""
    net = group.value("flooded_net_weight")
    if math.isnan(net):
        return []
    if net <= 0.0:
        return [("with flooded floats", f"floats, {format_quantity(-net, 'N/m')} of buoyancy left", "")]
    buoyancy = group.value("holding_buoyancy")
    shown = display_unit("N/m", buoyancy)
    return [
        ("with flooded floats", f"sinks, {format_quantity(net, 'N/m')} of weight under water", ""),
        ("air volume needed to refloat it", group.value("air_to_surface"), pretty_unit("m3/m")),
        ("buoyancy that holds it up", buoyancy * shown.factor, pretty_unit(shown.name)),
    ]


def steady_tables(level: CurtainLevel) -> list[Table]:
    """Return the governing steady load with its band, what moves it, other steady loads, and the direction."""
    group = level.part("statics")
    rows = [
        (label, unit, [group.value(f"steady_{name}{end}") for end in ("", "_low", "_high")])
        for name, label, unit in _STEADY
        if group.variable(f"steady_{name}") is not None
    ]
    rows = [row for row in rows if row[2][2] > 0.0]
    if not rows:
        return []
    shown = [display_unit(unit, np.array(values)) for _, unit, values in rows]

    def column(n: int) -> list[Cell]:
        return [values[n] * unit.factor for (_, _, values), unit in zip(rows, shown, strict=True)]

    bound = group.value("steady_load_bound")
    note = (
        "Size for the upper end. Low and high: drag coefficient, toe weight, closing of the gap, load law, friction, "
        "floats."
    )
    if math.isfinite(bound):
        note += (
            f" With a free toe no load normal to the sheet exceeds the {format_quantity(bound, 'N/m')} that toe and "
            "sheet weigh in water, whatever the drag coefficient."
        )
    tables = [
        Table(
            key(level, "steady-load"),
            "The governing steady load",
            (
                Column("Quantity", [label for label, _, _ in rows]),
                Column("Unit", [pretty_unit(unit.name) for unit in shown]),
                Column("Value", column(0), uniform=False),
                Column("Low", column(1), uniform=False),
                Column("High", column(2), uniform=False),
            ),
            note=note,
        )
    ]
    tables += _cause_tables(level, group)
    return tables


def _cause_tables(level: CurtainLevel, group: Group) -> list[Table]:
    def reals(name: str, dim: str) -> list[Cell]:
        values = group.real(name, dim)
        return [] if values is None else [float(value) for value in values]

    causes, models = group.labels("steady_cause"), group.labels("steady_model")
    found = [
        Table(
            key(level, "steady-causes"),
            "What moves the steady load",
            (
                Column("Varied", list(causes)),
                Column("Load per length", reals("cause_line_load", "steady_cause"), "N/m"),
                Column("All cables", reals("cause_cable_tension", "steady_cause"), "N"),
                Column("Inner anchor", reals("cause_anchor_horizontal_tension", "steady_cause"), "N"),
                Column("Effective depth", reals("cause_effective_depth", "steady_cause"), "m"),
            ),
        ),
        Table(
            key(level, "steady-compared"),
            "Other steady loads, and why they differ",
            (
                Column("Model", list(models)),
                Column("Load per length", reals("compared_line_load", "steady_model"), "N/m"),
                Column("Load of a span", reals("compared_span_load", "steady_model"), "N"),
                Column("Over the governing", reals("compared_ratio", "steady_model")),
                Column("Stands for", words(group, "compared_standing", "steady_model", len(models))),
                Column("Why", words(group, "compared_why", "steady_model", len(models))),
            ),
            emphasised=(0,),
        ),
    ]
    angles = group.real("steady_direction", "steady_direction")
    if angles is not None:
        found.append(
            Table(
                key(level, "steady-direction"),
                "Steady load against the direction of the current",
                (
                    Column("From the normal", [math.degrees(float(angle)) for angle in angles], "deg"),
                    Column("Load of a span", reals("direction_span_load", "steady_direction"), "N"),
                    Column("All cables", reals("direction_cable_tension", "steady_direction"), "N"),
                    Column("Inner anchor", reals("direction_anchor_horizontal_tension", "steady_direction"), "N"),
                ),
                collapsed=True,
            )
        )
    return found
