"""Tables of the report of a curtain at rest and in the impact."""

from __future__ import annotations

import math

import numpy as np

from moyai.report.document import Cell, Column, Table
from moyai.report.formatting import DASH, display_unit, format_number, pretty_unit
from moyai.report.reading import Group
from moyai.structures.curtain.report.reading import CurtainLevel, components, governing_component, key, words

# Name, words, unit of the statics that follow the drag coefficient
_BY_DRAG = (
    ("drag_coefficient", "drag coefficient C_D", ""),
    ("blockage", "blockage, depth reached over water depth", ""),
    ("effective_depth", "effective depth", "m"),
    ("flare", "flare", "m"),
    ("toe_gap", "toe gap", "m"),
    ("toe_speed", "mean speed under the toe", "m/s"),
    ("toe_speed_undisturbed", "mean undisturbed current between toe and bed", "m/s"),
    ("toe_speed_ratio", "speed under the toe over that undisturbed current", ""),
    ("section_load", "load of the section", "N/m"),
    ("top_load", "of it on the upper cable", "N/m"),
    ("toe_hold", "of it on the toe", "N/m"),
    ("top_pull", "downward pull on the floats", "N/m"),
    ("sheet_tension", "skirt tension", "N/m"),
    ("cable_tension", "tension of both cables", "N"),
    ("upper_tension", "tension of the upper cable", "N"),
    ("lower_tension", "tension of the lower cable", "N"),
    ("sag", "sag of the plan", "m"),
    ("strain", "strain of the cables", ""),
    ("end_angle", "angle of the cable at the support", "rad"),
    ("anchor_horizontal_tension", "force on an inner anchor", "N"),
    ("end_anchor_horizontal_tension", "force on an end anchor", "N"),
    ("anchor_tension", "tension of an anchor line", "N"),
    ("float_reserve", "reserve of the floats", "N/m"),
    ("float_reserve_ratio", "reserve over buoyancy", ""),
)
_IMPACT = (
    ("start_speed", "speed when taut", "m/s"),
    ("draught", "draught of the plate", "m"),
    ("added_mass", "added mass M0 in deep water", "kg/m"),
    ("added_mass_in_depth", "added mass in this depth", "kg/m"),
    ("taut_sag", "sag of the just-taut shape", "m"),
    ("shape_number", "shape number b", ""),
    ("cable_stiffness", "EA of both cables", "N"),
    ("tension_coefficient", "C_T", ""),
    ("cauchy_number", "elastic number C_E", ""),
    ("froude_number", "Froude number", ""),
    ("rise_ratio", "rise time over √(d/g)", ""),
    ("relative_step", "ω dt of the marching", ""),
    ("time_step", "time step", "s"),
    ("both_cables_plateau_tension", "plateau by drag", "N"),
    ("spread", "largest over smallest of all but model B literal", ""),
    ("design_tension", "tension taken for design", "N"),
)
_PAPER = (
    ("paper_shape_number", "shape number b (6)", ""),
    ("paper_cable_tension_inextensible", "cable tension, inextensible (6)", "N"),
    ("paper_cable_tension", "cable tension with stretch (4)", "N"),
    ("paper_sag", "sag (5)", "m"),
    ("paper_skirt_tension", "skirt tension (2)", "N/m"),
    ("paper_edge_load", "load on each cable (3)", "N/m"),
    ("paper_skirt_radius", "radius of the skirt", "m"),
    ("paper_skirt_sagitta", "sagitta of the skirt", "m"),
    ("chord", "chord of the skirt", "m"),
)


def load_tables(level: CurtainLevel) -> list[Table]:
    """Return the loads of each component split into steady, wave, impact, governing, and where they come from."""
    found = components(level)
    if not found:
        return []
    shown = [display_unit(entry.unit, entry.loads["governing"]) for entry in found]

    def loads(part: str) -> list[Cell]:
        return [entry.loads[part] * unit.factor for entry, unit in zip(found, shown, strict=True)]

    highs = level.part("loads").real("steady_high", "component")
    upper: list[Cell] = [] if highs is None else [float(v) * u.factor for v, u in zip(highs, shown, strict=True)]
    # only where whole spans were run
    moving = any(math.isfinite(entry.loads["dynamic"]) for entry in found)
    return [
        Table(
            key(level, "loads"),
            "Loads of each component",
            (
                Column("Component", [entry.name for entry in found]),
                Column("Unit", [unit.name for unit in shown]),
                Column("Steady", loads("steady"), uniform=False),
                *((Column("Steady, upper end", upper, uniform=False),) if upper else ()),
                Column("Added by waves", loads("wave"), uniform=False),
                Column("Added by the impact", loads("impact"), uniform=False),
                *((Column("Whole span", loads("dynamic"), uniform=False),) if moving else ()),
                Column("Governing", loads("governing"), uniform=False),
                Column("Governed by", [entry.governing for entry in found]),
                Column(
                    "Capacity",
                    [entry.capacity * unit.factor for entry, unit in zip(found, shown, strict=True)],
                    uniform=False,
                ),
                Column("Safety factor", [entry.safety_factor for entry in found]),
                Column("Utilisation", [entry.utilisation for entry in found]),
            ),
            note="Governing: the steady load with the larger of what waves or impact add"
            + (", or the highest tension of the whole span through time where that is higher" if moving else "")
            + ". Utilisation: governing load times safety factor over capacity; a dash where the case gives no "
            "strength.",
            emphasised=_worst(level),
            failed=tuple(row for row, entry in enumerate(found) if entry.utilisation > 1.0),
        ),
        Table(
            key(level, "load-sources"),
            "Where the loads come from",
            (
                Column("Component", [entry.name for entry in found]),
                Column("Waves", [entry.sources[0] or DASH for entry in found]),
                Column("Impact", [entry.sources[1] or DASH for entry in found]),
                *((Column("Whole span", [entry.sources[2] or DASH for entry in found]),) if moving else ()),
            ),
            collapsed=True,
        ),
    ]


def _worst(level: CurtainLevel) -> tuple[int, ...]:
    worst = governing_component((level,))
    names = [entry.name for entry in components(level)]
    return () if worst is None else (names.index(worst[1].name),)


def number_table(
    level: CurtainLevel, group: Group, name: str, title: str, rows: tuple[tuple[str, str, str], ...]
) -> Table | None:
    """Return single numbers of a group as rows of a table."""
    known = [
        (label, group.value(variable), unit) for variable, label, unit in rows if group.variable(variable) is not None
    ]
    if not known:
        return None
    shown = [display_unit(unit, value) for _, value, unit in known]
    return Table(
        key(level, name),
        title,
        (
            Column("Quantity", [label for label, _, _ in known]),
            Column("Value", [v * unit.factor for (_, v, _), unit in zip(known, shown, strict=True)], uniform=False),
            Column("Unit", [pretty_unit(unit.name) for unit in shown]),
        ),
    )


def statics_table(level: CurtainLevel) -> Table | None:
    """Return the statics at the drag coefficient as given and at the ends of its range."""
    group = level.part("statics")
    cases = group.labels("drag_case")
    rows = [
        (label, unit, values)
        for name, label, unit in _BY_DRAG
        if (values := group.real(name, "drag_case")) is not None and np.isfinite(values).any()
    ]
    if not rows or not cases:
        return None
    heads = {"low": "Low drag", "given": "As given", "high": "High drag"}
    shown = [display_unit(unit, values) for _, unit, values in rows]
    return Table(
        key(level, "statics"),
        "At rest in the current",
        (
            Column("Quantity", [label for label, _, _ in rows]),
            Column("Unit", [pretty_unit(unit.name) for unit in shown]),
            *(
                Column(
                    heads.get(case, case),
                    [float(values[n]) * unit.factor for (_, _, values), unit in zip(rows, shown, strict=True)],
                    uniform=False,
                )
                for n, case in enumerate(cases)
            ),
        ),
        note="Low and high: ends of the range of the drag coefficient.",
    )


def law_tables(level: CurtainLevel) -> list[Table]:
    """Return the load laws side by side, of the section and of the plan."""
    group = level.part("statics_laws")
    specified = (
        (
            "section_law",
            "Load laws of the section",
            (
                ("law_effective_depth", "Effective depth", "m"),
                ("law_flare", "Flare", "m"),
                ("law_top_tension", "Tension at the top", "N/m"),
                ("law_horizontal_load", "Horizontal load", "N/m"),
                ("law_top_angle", "Angle at the top", "rad"),
            ),
        ),
        (
            "plan_law",
            "Load laws of the plan",
            (
                ("law_plan_tension", "Tension of both cables", "N"),
                ("law_sag", "Sag", "m"),
                ("law_downstream_end_force", "End force downstream", "N"),
                ("law_inward_end_force", "End force inwards", "N"),
            ),
        ),
    )
    tables = []
    for dim, title, columns in specified:
        names = group.labels(dim)
        found = [
            Column(label, [float(value) for value in values], unit)
            for name, label, unit in columns
            if (values := group.real(name, dim)) is not None
        ]
        if names and found:
            tables.append(Table(key(level, dim), title, (Column("Law", list(names)), *found)))
    return tables


def paper_table(level: CurtainLevel) -> Table | None:
    """Return equations (2) to (6) of the impact paper on this curtain."""
    return number_table(
        level, level.part("statics_paper"), "paper-statics", "Equations (2) to (6) of the impact paper", _PAPER
    )


def counted_spread(level: CurtainLevel) -> float:
    """Return the largest over the smallest tension of the impact models that count, NaN where there are not two."""
    group = level.part("impact")
    tension, counts = group.real("both_cables_impact_tension", "impact_model"), group.real("counts", "impact_model")
    if tension is None:
        return math.nan
    known = tension[
        np.isfinite(tension)
        & (tension > 0.0)
        & (np.ones(tension.size) if counts is None else counts > 0.0).astype(bool)
    ]
    return float(known.max() / known.min()) if known.size > 1 else math.nan


def impact_tables(level: CurtainLevel) -> list[Table]:
    """Return all impact models in one table, and the numbers that they rest on."""
    group = level.part("impact")
    names, tension = group.labels("impact_model"), group.real("both_cables_impact_tension", "impact_model")
    if not names or tension is None:
        return []

    def column(name: str) -> list[Cell]:
        values = group.real(name, "impact_model")
        return [math.nan] * len(names) if values is None else [float(value) for value in values]

    counts = group.real("counts", "impact_model")
    design = str(group.attributes.get("design_model", ""))
    spread = counted_spread(level)
    note = "Sum of both cables, above the drag. "
    if math.isfinite(spread):
        note += f"The largest of the models used for design is {format_number(spread)} times the smallest."
    columns = [
        Column("Model", list(names)),
        Column("Tension", [float(value) for value in tension], "N", uniform=False),
        Column("Over model A", column("impact_ratio"), uniform=False),
        Column("Upper cable", column("impact_upper_tension"), "N", uniform=False),
        Column("Lower cable", column("impact_lower_tension"), "N", uniform=False),
        Column("Skirt", column("impact_skirt_tension"), "N/m", uniform=False),
        Column("Taut to peak", column("impact_time"), "s", uniform=False),
        Column("Assumption", words(group, "assumption", "impact_model", len(names))),
    ]
    for name, label in (("record_ratio", "Over the record"), ("record_time_ratio", "Its time over the record's")):
        if group.real(name, "impact_model") is not None:
            columns.insert(-1, Column(label, column(name), uniform=False))
    if counts is not None:
        columns.insert(1, Column("Counts", ["yes" if value > 0.0 else "no" for value in counts]))
    tables = [
        Table(
            key(level, "impact-models-table"),
            "Impact models",
            tuple(columns),
            note=note,
            emphasised=tuple(row for row, name in enumerate(names) if name == design),
        )
    ]
    numbers = number_table(level, group, "impact-numbers", "Assumptions of the impact", _IMPACT)
    source = str(group.attributes.get("start_speed_source", ""))
    if numbers is not None:
        said = [f"Start speed: {source}." if source else "", f"Design: model {design}." if design else ""]
        tables.append(Table(numbers.key, numbers.title, numbers.columns, note=" ".join(filter(None, said))))
    return tables


def record_tables(root: Group) -> list[Table]:
    """Return the instants of a flume record, and peak, plateau and impact of each cable and of their sum."""
    group = root.child("record")
    names = group.labels("cable")
    if not names:
        return []
    rows = (("peak", "Peak"), ("plateau", "Plateau"), ("impact", "Impact"))
    columns = [
        Column(label, [*(float(value) for value in values), group.value(f"both_cables_{name}_tension")], "N")
        for name, label in rows
        if (values := group.real(f"cable_{name}_tension", "cable")) is not None
    ]
    noise = group.real("cable_noise", "cable")
    if noise is not None and columns:
        columns.append(Column("Noise", [*(float(value) for value in noise), math.nan], "N"))
    tables = []
    if columns:
        cables = Column("Cable", [*names, "sum"])
        tables.append(
            Table(
                "flume-readings", "Readings of the flume record", (cables, *columns), note="Impact: peak less plateau."
            )
        )
    instants = [
        (words, group.value(name))
        for name, words in (
            ("release_time", "release"),
            ("taut_time", "taut"),
            ("peak_time", "peak"),
            ("plateau_start", "plateau from"),
            ("rise_time", "rise, taut to peak"),
            ("peak_missed", "share of the peak that the sampling may miss"),
        )
        if group.variable(name) is not None
    ]
    if instants:
        tables.append(
            Table(
                "flume-instants",
                "Instants of the flume record",
                (
                    Column("What", [words for words, _ in instants]),
                    Column("Value", [value for _, value in instants], uniform=False),
                    Column("Unit", ["" if words.startswith("share") else "s" for words, _ in instants]),
                ),
            )
        )
    return tables
