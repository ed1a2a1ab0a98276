"""Tables of a curtain in waves: slack and taut cycles, snaps, anchor loads."""

from __future__ import annotations

import numpy as np

from moyai.report.document import Column, Table
from moyai.report.formatting import display_unit, format_number, format_quantity, pretty_unit
from moyai.report.reading import Group
from moyai.structures.curtain.report.reading import CurtainLevel, key

MOST_CONTACTS = 12


def regular_table(level: CurtainLevel, sea: Group) -> Table | None:
    """Return what each period of regular waves gave."""
    period = sea.real("period", "period")
    if period is None:
        return None
    rows = (
        ("velocity_amplitude", "Velocity amplitude", "m/s"),
        ("water_excursion", "Excursion", "m"),
        ("threshold_water_excursion", "Excursion that pulls taut", "m"),
        ("both_cables_tension_maximum", "Tension", "N"),
        ("both_cables_tension_maximum_low", "From", "N"),
        ("both_cables_tension_maximum_high", "To", "N"),
        ("lower_wave_tension", "In lower waves", "N"),
        ("lower_wave_height", "of height", "m"),
        ("judged_tension", "Judged at", "N"),
        ("periods_left_out", "Periods left out", ""),
        ("periods_analysed", "Analysed", ""),
        ("repeats_after", "Repeats after", ""),
        ("both_cables_tension_mean", "Mean tension", "N"),
        ("first_contact_tension", "First contacts", "N"),
        ("later_contact_tension", "Later contacts", "N"),
        ("largest_contact_speed", "Speed when taut", "m/s"),
        ("contact_count", "Contacts", ""),
        ("first_contact_count", "First of them", ""),
        ("closed_form_tension", "Closed form", "N"),
    )
    columns = [
        Column(label, [float(value) for value in values], unit)
        for name, label, unit in rows
        if (values := sea.real(name, "period")) is not None
    ]
    if not columns:
        return None
    tension = sea.real("both_cables_tension_maximum", "period")
    worst = () if tension is None or not np.isfinite(tension).any() else (int(np.nanargmax(tension)),)
    return Table(
        key(level, sea.name, "regular"),
        "Slack and taut in regular waves",
        (Column("Period", [float(value) for value in period], "s", uniform=False), *columns),
        note="Tension of both cables: the largest that repeats within 1 %; where periods never repeat, the mean of the "
        "largest of 100 periods, with the least and the largest of these. Lower waves: of half to nine tenths of the "
        "height, since snaps may lock into a gentle motion in a higher one; the larger is used. Judged at: the end of "
        "the 95 % interval of a mean. First: the first on a side since the other.",
        emphasised=worst,
    )


def irregular_table(level: CurtainLevel, sea: Group) -> Table | None:
    """Return the counts and the fit of an irregular sea."""
    rows = (
        ("significant_height", "significant wave height", "m"),
        ("both_cables_tension_maximum", "largest tension of both cables, mean of the realisations", "N"),
        ("both_cables_tension_maximum_low", "of the realisations, from", "N"),
        ("both_cables_tension_maximum_high", "to", "N"),
        ("realisations", "realisations", ""),
        ("left_out", "left out at the start of each", "s"),
        ("most_probable_maximum", "most probable maximum", "N"),
        ("most_probable_maximum_low", "its range, from", "N"),
        ("most_probable_maximum_high", "to", "N"),
        ("later_contact_tension", "largest of later contacts", "N"),
        ("both_cables_tension_mean", "mean tension", "N"),
        ("taut_share", "share of the time that it is taut", ""),
        ("analysed_hours", "hours analysed", ""),
        ("contact_count", "contacts", ""),
        ("first_contact_count", "first contacts of a side", ""),
        ("contacts_per_hour", "contacts per hour", ""),
        ("snaps_per_hour", "snaps per hour", ""),
        ("weibull_shape", "shape of the fitted Weibull law", ""),
        ("weibull_scale", "its scale", "N"),
        ("weibull_threshold", "its threshold", "N"),
    )
    known = [(label, sea.value(name), unit) for name, label, unit in rows if sea.variable(name) is not None]
    if not known or sea.real("period", "period") is not None:
        return None
    shown = [display_unit(unit, value) for _, value, unit in known]
    return Table(
        key(level, sea.name, "irregular"),
        "Snaps of the sea state",
        (
            Column("Quantity", [label for label, _, _ in known]),
            Column("Value", [v * unit.factor for (_, v, _), unit in zip(known, shown, strict=True)], uniform=False),
            Column("Unit", [pretty_unit(unit.name) for unit in shown]),
        ),
    )


def weaker_table(level: CurtainLevel) -> Table | None:
    """Return slack and taut cycles of the seas in weaker currents than that of the case."""
    group = level.part("weaker_currents")
    names, speed = group.labels("sea"), group.real("weaker_current", "weaker_current")
    tops, judged = (
        group.real(name, "sea", "weaker_current") for name in ("both_cables_tension_maximum", "judged_tension")
    )
    if speed is None or tops is None or judged is None:
        return None
    columns = [Column("Current", [float(value) for value in speed], "m/s")]
    for row, name in enumerate(names):
        columns.append(Column(f"Tension in {name}", [float(value) for value in tops[row]], "N"))
        columns.append(Column("Judged at", [float(value) for value in judged[row]], "N"))
    return Table(
        key(level, "weaker currents"),
        "Slack and taut in weaker currents",
        tuple(columns),
        note="Tension of both cables: the mean over the realisations of a sea, or that of regular waves. Weaker "
        "currents come with every stronger one, twice a tide. The sheet hangs straighter in them and takes more of "
        "the same tension.",
    )


def contact_table(level: CurtainLevel, sea: Group, run: Group) -> Table | None:
    """Return the largest snaps of a run."""
    tension, time = run.real("contact_tension", "contact"), run.real("contact_time", "contact")
    if tension is None or time is None or not tension.size:
        return None
    order = np.argsort(tension)[::-1][:MOST_CONTACTS]
    columns = [
        Column("Time", [float(time[n]) for n in order], "s", digits=5),
        Column("Tension", [float(tension[n]) for n in order], "N"),
    ]
    speed, side, first = (run.real(f"contact_{name}", "contact") for name in ("speed", "side", "first"))
    if speed is not None:
        columns.append(Column("Speed when taut", [float(speed[n]) for n in order], "m/s"))
    if side is not None:
        columns.append(Column("Side", ["downstream" if side[n] > 0.0 else "upstream" for n in order]))
    if first is not None:
        columns.append(Column("First of the side", ["yes" if first[n] > 0.0 else "no" for n in order]))
    return Table(
        key(level, sea.name, run.name, "contacts"),
        "Largest snaps",
        tuple(columns),
        note=f"The {order.size} largest of {tension.size}.",
        collapsed=True,
    )


def anchor_tables(level: CurtainLevel) -> list[Table]:
    """Return the anchor loads of every sea state, and by each direction rule."""
    group = level.part("anchor_loads")
    names = group.labels("sea")
    if not names:
        return []
    rows = (
        ("significant_height", "Significant height", "m"),
        ("wave_period", "Period", "s"),
        ("wave_angle", "Angle from the normal", "rad"),
        ("effective_height", "Acting height", "m"),
        ("squared_velocity", "Squared velocity", "m2/s2"),
        ("float_speed", "Float speed", "m/s"),
        ("rope_tension", "Rope, rise", "N"),
        ("rope_tension_pretensioned", "Rope, rise above pretension", "N"),
        ("total_rope_tension", "Rope, total", "N"),
        ("wire_tension", "Tension wire, rise", "N"),
        ("conventional_tension", "Conventional type, rise", "N"),
    )
    columns = [
        Column(label, [float(value) for value in values], unit)
        for name, label, unit in rows
        if (values := group.real(name, "sea")) is not None
    ]
    tables = [
        Table(
            key(level, "anchor-loads"),
            "Anchor loads by the energy model",
            (Column("Sea state", list(names)), *columns),
            note=_model_words(group),
        )
    ]
    load = group.real("rule_tension", "sea", "direction_rule")
    if load is not None:
        rules = group.labels("direction_rule")
        tables.append(
            Table(
                key(level, "anchor-rules"),
                "Rope tension by each direction rule",
                (
                    Column("Sea state", list(names)),
                    *(Column(f"Rule '{rule}'", [float(v) for v in load[:, n]], "N") for n, rule in enumerate(rules)),
                ),
                note="'paper': height times cos²; 'normal': height times cos; 'none': no reduction.",
            )
        )
    return tables


def _model_words(group: Group) -> str:
    parts = [
        f"{words} {format_quantity(group.value(name), unit) if unit else format_number(group.value(name))}"
        for name, words, unit in (
            ("energy_factor", "M", ""),
            ("float_mass", "float mass", "kg"),
            ("rope_stiffness", "rope stiffness", "N/m"),
            ("pretension", "pretension", "N"),
            ("response_time", "response time", "s"),
        )
        if group.variable(name) is not None
    ]
    return ", ".join(parts) + "." if parts else ""
