"""Tables of a rigid cage: the cage, its rest and lines, motions and tensions of every wave."""

from __future__ import annotations

import math

import numpy as np

from moyai.report.document import Block, Column, Table
from moyai.report.formatting import display_unit
from moyai.report.reading import Group
from moyai.report.realisations import realisations_figure, realisations_table
from moyai.structures.cage.report.rigid_reading import ENDS, CageLevel, key

_CAGE = (
    "mass",
    "mass_without_floats",
    "solid_volume",
    "float_volume",
    "enclosed_volume",
    "submerged_weight",
    "reserve_buoyancy",
    "centre_of_gravity_z",
    "inertia",
    "net_area",
    "solidity",
    "solidity_listed",
    "float_diameter",
)


def _listing(table_key: str, title: str, rows: list[tuple[str, float, str]], note: str = "") -> Table:
    return Table(
        table_key,
        title,
        tuple(
            Column(name, [row[n] for row in rows], digits=4, uniform=False)
            for n, name in enumerate(("Quantity", "Value", "Unit"))
        ),
        note=note,
    )


def _row(group: Group, name: str, words: str = "", **choice: str) -> tuple[str, float, str] | None:
    found = group.array(name, **choice)
    if found is None:
        return None
    unit = group.unit(name)
    if unit == "rad":
        return words or group.long_name(name), math.degrees(float(found)), "°"
    shown = display_unit(unit, float(found))
    return words or group.long_name(name), float(found) * shown.factor, shown.name


def cage_table(level: CageLevel) -> Table | None:
    """Return masses, volumes and net."""
    group = level.part("cage")
    rows = [row for name in _CAGE if (row := _row(group, name)) is not None]
    if not rows:
        return None
    law = str(group.attributes.get("law", ""))
    return _listing(key(level, "cage"), "Cage", rows, note=f"Net law: {law}." if law else "")


def rest_table(level: CageLevel) -> Table | None:
    """Return the cage at rest, floating freely and moored."""
    group = level.part("statics")
    situations = group.labels("situation")
    entries = (("rest_x", "m"), ("rest_z", "m"), ("rest_roll", "rad"), ("immersion", "1"))
    columns: list[Column] = [Column("Situation", list(situations))]
    for name, unit in entries:
        values = group.array(name, "situation")
        if values is None:
            return None
        label = {"rest_x": "middle x", "rest_z": "middle z", "rest_roll": "rotation", "immersion": "floats in water"}[
            name
        ]
        if unit == "rad":
            columns.append(Column(label, list(np.where(np.abs(values) < 1e-9, 0.0, np.degrees(values))), "°"))
        elif name == "immersion":
            columns.append(Column(label, list(100.0 * values), "%"))
        else:
            clean = np.where(np.abs(values) < 1e-9, 0.0, values)
            columns.append(Column(label, list(clean), unit, digits=4))
    return Table(key(level, "rest"), "At rest", tuple(columns), note="z from still water.")


def line_table(level: CageLevel) -> Table | None:
    """Return the lines."""
    group = level.part("statics")
    names = group.labels("line")
    if not names:
        return None
    columns = [Column("Line", list(names))]
    for name, label in (
        ("attachment_x", "attached at x"),
        ("attachment_z", "attached at z"),
        ("anchor_x", "anchor x"),
        ("anchor_z", "anchor z"),
        ("line_length", "length"),
        ("line_stiffness", "stiffness"),
        ("tension_at_rest", "tension at rest"),
    ):
        values = group.array(name, "line")
        if values is not None:
            columns.append(Column(label, list(values), group.unit(name), digits=4))
    return Table(
        key(level, "lines"), "Lines", tuple(columns), note="Attachments from the middle of the cage; z of anchors from "
        "still water; lengths unstretched.",
    )  # fmt: skip


def modes_table(level: CageLevel) -> Table | None:
    """Return natural periods and shapes."""
    group = level.part("statics")
    periods = group.array("natural_period", "natural_mode")
    shapes = group.array("natural_shape", "natural_mode", "mode")
    if periods is None or shapes is None:
        return None
    known = [n for n in range(len(periods)) if math.isfinite(periods[n])]
    if not known:
        return None
    return Table(
        key(level, "modes"),
        "Natural periods at rest",
        (
            Column("Mode", [n + 1 for n in known]),
            Column("Period", [float(periods[n]) for n in known], "s"),
            *(
                Column(f"{name} part", [float(shapes[n, m]) for n in known])
                for m, name in enumerate(("sway", "heave", "rotation"))
            ),
        ),
        note="Undamped, for small motions with lines that stay taut; added mass of the water included. Parts: sway and "
        "heave over the size of the cage, rotation in radians.",
    )


def _waves(sea: Group) -> list[Column]:
    height, period = sea.real("wave_height", "wave"), sea.real("period", "wave")
    assert height is not None and period is not None
    regular = str(sea.attributes.get("kind", "regular")) == "regular"
    return [
        Column("H" if regular else "Hs", list(height), "m", digits=3),
        Column("T" if regular else "Tp", list(period), "s", digits=3),
    ]


def motion_table(level: CageLevel, sea: Group) -> Table | None:
    """Return the motions of every wave."""
    ratio = sea.array("range_ratio", "wave", "translation")
    if ratio is None:
        return None
    columns = _waves(sea)
    regular = str(sea.attributes.get("kind", "regular")) == "regular"
    for n, name in enumerate(("sway", "heave")):
        columns.append(Column(f"{name} range / H" if regular else f"{name} 4σ / Hs", list(ratio[:, n])))
    turned = sea.array("range", "wave", "mode")
    top, low = sea.array("maximum", "wave", mode="roll"), sea.array("minimum", "wave", mode="roll")
    mean = sea.array("mean", "wave", "mode")
    if turned is not None:
        columns.append(Column("rotation ±", list(np.degrees(0.5 * turned[:, 2])), "°"))
    if top is not None and low is not None:
        columns.append(Column("rotation max", list(np.degrees(top)), "°"))
        columns.append(Column("rotation min", list(np.degrees(low)), "°"))
    if regular:
        first, phase = sea.array("first_harmonic", "wave", "mode"), sea.array("first_phase", "wave", "mode")
        if first is not None and phase is not None:
            height = np.asarray(columns[0].values, dtype=float)
            for n, name in enumerate(("sway", "heave")):
                columns.append(Column(f"{name} 1st harmonic, 2a/H", list(2.0 * first[:, n] / height)))
            columns.append(Column("rotation 1st harmonic", list(np.degrees(first[:, 2])), "°"))
            turn = np.degrees(np.angle(np.exp(1j * (phase[:, 0] - phase[:, 1]))))
            columns.append(Column("sway after heave", list(turn), "°"))
    else:
        spread = sea.array("deviation", "wave", "mode")
        if spread is not None:
            columns.append(Column("sway deviation", list(spread[:, 0]), "m"))
            columns.append(Column("heave deviation", list(spread[:, 1]), "m"))
            columns.append(Column("rotation deviation", list(np.degrees(spread[:, 2])), "°"))
    if mean is not None:
        columns.append(Column("mean sway", list(mean[:, 0]), "m"))
    ratio_water = sea.array("orbit_ratio", "wave")
    if ratio_water is not None and regular:
        columns.append(Column("water orbit x / z", list(ratio_water)))
    return Table(
        key(level, sea.name, "motions"),
        f"Motions: {sea.name}",
        tuple(columns),
        note="Centre of gravity; ranges are means over wave periods, drift within a period taken out. Water orbit: "
        "at still water, coth kh."
        if regular
        else "Centre of gravity; rotation ±: half the mean range over peak periods. σ: standard deviation.",
    )


def tension_table(level: CageLevel, sea: Group) -> Table | None:
    """Return the tensions of every wave and line at both ends."""
    peak = sea.require("line_tension_maximum", "wave", "line", "end")
    if peak.shape[1] == 0:
        return None
    lines, size = sea.labels("line"), peak.shape[0]
    at = [(w, n) for w in range(size) for n in range(len(lines))]
    columns = [
        Column(column.label, [column.values[w] for w, _ in at], column.unit, digits=column.digits)
        for column in _waves(sea)
    ]
    columns.append(Column("Line", [lines[n] for _, n in at]))
    parted = not np.allclose(peak[:, :, 0], peak[:, :, 1])
    for e, end in enumerate(ENDS if parted else ENDS[:1]):
        for name, words in (
            ("line_tension_minimum", "min"),
            ("line_tension_mean", "mean"),
            ("line_tension_maximum", "peak"),
        ):
            values = sea.array(name, "wave", "line", "end")
            if values is not None:
                label = f"{words} at the {end}" if parted else words
                columns.append(Column(label, [float(values[w, n, e]) for w, n in at], "N"))
    tops, slack = sea.array("line_tension_mean_peak", "wave", "line", "end"), sea.array("slack_share", "wave", "line")
    if tops is not None:
        columns.append(Column("mean peak", [float(tops[w, n, 0]) for w, n in at], "N"))
    if slack is not None:
        columns.append(Column("time slack", [100.0 * float(slack[w, n]) for w, n in at], "%"))
    governing = int(np.argmax([peak[w, n, 0] for w, n in at]))
    return Table(
        key(level, sea.name, "tensions"),
        f"Line tensions: {sea.name}",
        tuple(columns),
        note=("" if parted else "The lines have no weight: both ends have the same tension. ")
        + "Peaks are found within the time steps. They grow with the stiffness of the lines.",
        emphasised=(governing,) if peak[:, :, 0].max() > 0.0 else (),
    )


def realisations_blocks(level: CageLevel, sea: Group) -> tuple[Block | None, ...]:
    """Return the largest tensions at the cage of the realisations of a sea, as a table and as a figure."""
    tension = sea.real("line_tension_maximum_of_realisation", "realisation", "line", end=ENDS[0])
    given = key(level, sea.name, "realisations"), sea.name, sea.labels("line"), tension
    return realisations_table(*given), realisations_figure(*given)
