"""Tables of a network: lines, points, runs, snaps, uncertainty of the peaks, natural modes."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from moyai.core.arrays import Array
from moyai.report.document import Column, Table
from moyai.report.encoding import slug
from moyai.report.reading import Group
from moyai.report.realisations import realisations_table
from moyai.structures.network.report.reading import NetworkLevel, texts

#: Rows of tables that a reader goes through; longer ones are folded away, and cut.
FOLDED, MOST_ROWS = 24, 400


def _column(label: str, values: Array | None, unit: str, **options: object) -> Column | None:
    if values is None or not np.isfinite(values).any():
        return None
    return Column(label, [float(value) for value in values], unit, **options)  # type: ignore[arg-type]


def _table(key: str, title: str, columns: Sequence[Column | None], note: str = "", **options: object) -> Table | None:
    known = tuple(column for column in columns if column is not None)
    if len(known) < 2 or not len(known[0].values):
        return None
    rows = len(known[0].values)
    if rows > MOST_ROWS:
        known = tuple(
            Column(c.label, list(c.values)[:MOST_ROWS], c.unit, c.digits, c.fixed, c.uniform, c.trim) for c in known
        )
        note = f"{note} The first {MOST_ROWS} of {rows} rows; results.nc holds all.".strip()
    return Table(key, title, known, note, collapsed=rows > FOLDED, **options)  # type: ignore[arg-type]


def line_table(level: NetworkLevel) -> Table | None:
    """Return what the lines are."""
    net = level.network
    return _table(
        slug(level.name, "lines"),
        "Lines",
        [
            Column("Line", list(net.labels("line"))),
            _column("Length", net.real("line_length", "line"), "m", digits=4),
            _column("Bars", net.real("line_segments", "line"), "", digits=6, trim=True),
            _column("Weight in water", net.array("line_weight", "line"), "N"),
            _column("Wave speed", net.real("wave_speed", "line"), "m/s", digits=4),
            _column("Wave travel time", net.real("travel_time", "line"), "s"),
            _column("Breaking load", net.real("breaking_load", "line"), "N"),
        ],
        "Wave speed and travel time are those of elastic waves along the line.",
    )


def rest_tables(level: NetworkLevel) -> list[Table | None]:
    """Return tensions of the lines at rest, loads on the points, stiffness at driven points."""
    rest, found = level.part("statics"), list[Table | None]()
    for condition in rest.labels("condition"):

        def of(name: str, *dims: str, chosen: str = condition, **choice: str) -> Array | None:
            return rest.array(name, *dims, condition=chosen, **choice)

        found.append(
            _table(
                slug(level.name, condition, "rest-lines"),
                f"Tensions at rest in {condition}",
                [
                    Column("Line", list(rest.labels("line"))),
                    _column("At its start", of("start_tension", "line"), "N"),
                    _column("At its end", of("end_tension", "line"), "N"),
                    _column("Highest", of("line_tension_maximum", "line"), "N"),
                    _column("Lowest", of("line_tension_minimum", "line"), "N"),
                ],
            )
        )
        load = [of("point_load", "point", axis=axis) for axis in "xyz"]
        place = [of("point_position", "point", axis=axis) for axis in "xyz"]
        whole = None
        if all(part is not None for part in load):
            whole = np.sqrt(sum(np.asarray(part) ** 2 for part in load))
        found.append(
            _table(
                slug(level.name, condition, "rest-points"),
                f"Points at rest in {condition}",
                [
                    Column("Point", list(rest.labels("point"))),
                    Column("Kind", list(texts(level.network, "point_kind"))),
                    *(_column(axis, part, "m", digits=4) for axis, part in zip("xyz", place, strict=True)),
                    *(_column(f"pull {axis}", part, "N") for axis, part in zip("xyz", load, strict=True)),
                    _column("pull", whole, "N"),
                ],
                "Pull of the lines on the point; z above still water.",
            )
        )
        found.append(_bodies_at_rest(level, rest, condition))
    stiffness = rest.array("stiffness", "driven", "axis", "direction")
    if stiffness is not None:
        names = [f"{name}, {axis}" for name in rest.labels("driven") for axis in "xyz"]
        rows = stiffness.reshape(-1, 3)
        found.append(
            _table(
                slug(level.name, "stiffness"),
                "Stiffness at driven points",
                [
                    Column("Force that holds", names),
                    *(_column(f"per move {axis}", rows[:, k], "N/m", uniform=False) for k, axis in enumerate("xyz")),
                ],
                "About the place at rest, each point alone.",
            )
        )
    return found


def _bodies_at_rest(level: NetworkLevel, rest: Group, condition: str) -> Table | None:
    place = rest.array("solid_position", "solid", "axis", condition=condition)
    angle = rest.array("solid_angle", "solid", "turn", condition=condition)
    if place is None or angle is None:
        return None
    return _table(
        slug(level.name, condition, "rest-bodies"),
        f"Bodies at rest in {condition}",
        [
            Column("Body", list(rest.labels("solid"))),
            *(_column(axis, place[:, k], "m", digits=4) for k, axis in enumerate("xyz")),
            *(_column(turn, angle[:, k], "rad") for k, turn in enumerate(("roll", "pitch", "yaw"))),
        ],
        "Place of the middle of the body, z above still water.",
    )


def peaks_table(level: NetworkLevel, run: Group) -> Table | None:
    """Return highest, mean and slack of every line in a run."""
    dynamic = level.part("dynamic")
    if run.name not in dynamic.labels("run"):
        return None

    def of(name: str) -> Array | None:
        return dynamic.real(name, "line", run=run.name)

    lines = list(dynamic.labels("line"))
    peak = of("line_tension_maximum")
    governs = (int(np.nanargmax(peak)),) if peak is not None and np.isfinite(peak).any() and len(lines) > 1 else ()
    use = of("utilisation")
    return _table(
        slug(level.name, run.name, "peaks"),
        f"Tensions: {run.name}",
        [
            Column("Line", lines),
            _column("Highest", peak, "N"),
            _column("at", of("peak_time"), "s", digits=4),
            _column("at its start", of("start_peak"), "N"),
            _column("at its end", of("end_peak"), "N"),
            _column("Mean", of("line_tension_mean"), "N"),
            _column("Standard deviation", of("deviation"), "N"),
            _column("of breaking load", None if use is None else 100.0 * use, "%"),
            _column("Slack, share of time", None if (v := of("slack_share")) is None else 100.0 * v, "%"),
            _column("Contacts", of("contact_count"), "", digits=6, trim=True),
            _column("Snaps", of("snap_count"), "", digits=6, trim=True),
            _column("Highest snap", of("largest_snap"), "N"),
            _column("Shortest rise", of("shortest_rise_time"), "s"),
        ],
        "Highest: anywhere along the line; all three peaks are taken at every step. Mean and standard deviation: at "
        "its more loaded end. A contact ends a slack phase; a snap is a contact whose peak exceeds the threshold "
        "(settings.snap_threshold, or the mean of the taut tension).",
        emphasised=governs,
    )  # fmt: skip


def points_table(level: NetworkLevel, run: Group) -> Table | None:
    """Return the largest loads on the points of a run, and how far they go."""
    dynamic = level.part("dynamic")
    if run.name not in dynamic.labels("run"):
        return None

    def of(name: str) -> Array | None:
        return dynamic.real(name, "point", run=run.name)

    return _table(
        slug(level.name, run.name, "points"),
        f"Loads on points: {run.name}",
        [
            Column("Point", list(dynamic.labels("point"))),
            Column("Kind", list(texts(level.network, "point_kind"))),
            _column("Largest pull", of("point_load_maximum"), "N"),
            _column("horizontal", of("point_horizontal_load_maximum"), "N"),
            _column("upwards", of("point_upward_load_maximum"), "N"),
            _column("downwards", of("point_downward_load_maximum"), "N"),
            _column("Excursion", of("point_excursion"), "m"),
        ],
        "Pull of the lines on the point, taken at every step; the largest of each column, not at one time.",
    )


def bodies_table(level: NetworkLevel, run: Group) -> Table | None:
    """Return how far the bodies of a run go and turn."""
    dynamic = level.part("dynamic")
    if run.name not in dynamic.labels("run") or not dynamic.labels("solid"):
        return None

    def of(name: str) -> Array | None:
        return dynamic.real(name, "solid", run=run.name)

    return _table(
        slug(level.name, run.name, "bodies"),
        f"Motions of bodies: {run.name}",
        [
            Column("Body", list(dynamic.labels("solid"))),
            _column("Largest offset", of("largest_offset"), "m"),
            _column("Mean offset", of("mean_offset"), "m"),
            _column("Heave", of("heave_range"), "m"),
            _column("Roll", of("roll_range"), "rad"),
            _column("Pitch", of("pitch_range"), "rad"),
            _column("Yaw", of("yaw_range"), "rad"),
            _column("Largest lean", of("highest_lean"), "rad"),
        ],
        "Offsets are horizontal, from where the run begins; heave, roll, pitch and yaw from lowest to highest.",
    )


def uncertainty_table(level: NetworkLevel) -> Table | None:
    """Return the uncertainty of the peaks: the same run with other step, mesh and viscosity."""
    dynamic = level.part("dynamic")
    names = (
        ("sensitivity_peak", "Peak"), ("half_step", "half the step"), ("double_mesh", "twice the bars"),
        ("damped", "finer and damped"), ("finest", "finest mesh of its event"),
        ("half_viscosity", "half the viscosity"), ("double_viscosity", "twice the viscosity"),
    )  # fmt: skip
    values = [dynamic.real(key, "run") for key, _ in names]
    if values[0] is None:
        return None
    error, effect = dynamic.real("discretisation_error", "run"), dynamic.real("viscosity_effect", "run")
    runs = list(dynamic.labels("run"))
    return _table(
        slug(level.name, "uncertainty"),
        "Accuracy of the peak",
        [
            Column("Run", runs),
            Column("Line", [str(dynamic.attributes.get(f"governing {run}", "")) for run in runs]),
            *(_column(label, value, "N", digits=5) for (_, label), value in zip(names, values, strict=True)),
            _column("step and mesh", None if error is None else 100.0 * error, "%", digits=2, uniform=False),
            _column("viscosity", None if effect is None else 100.0 * effect, "%", digits=2, uniform=False),
        ],
        "The governing line in the same run again. The change with step and mesh is the accuracy of the number; the "
        "change with the viscosity, where it was asked for, shows the effect of an input that is seldom well known.",
    )  # fmt: skip


def largest_of_realisations(level: NetworkLevel, run: Group) -> Table | None:
    """Return the largest tensions of the realisations of a sea."""
    dynamic = level.part("dynamic")
    tension = dynamic.real("line_tension_maximum_of_realisation", "member", "line", run=run.name)
    return realisations_table(slug(level.name, run.name, "realisations"), run.name, dynamic.labels("line"), tension)


def contact_table(level: NetworkLevel, run: Group) -> Table | None:
    """Return every time that a slack line came taut."""
    contacts = run.child("contacts")
    snaps = contacts.array("is_snap", "contact")
    return _table(
        slug(level.name, run.name, "contacts"),
        f"Slack lines that come taut: {run.name}",
        [
            Column("Line", list(texts(contacts, "contact_line"))),
            _column("at", contacts.real("contact_time", "contact"), "s", digits=5),
            _column("slack before", contacts.real("contact_slack", "contact"), "s"),
            _column("highest then", contacts.real("contact_peak", "contact"), "N"),
            _column("rise", contacts.real("contact_rise", "contact"), "s"),
            None if snaps is None else Column("Snap", ["yes" if value else "no" for value in snaps]),
        ],
        "Rise: from a tenth to nine tenths of the peak.",
    )


def mode_table(level: NetworkLevel) -> Table | None:
    """Return the natural periods."""
    modes = level.part("modes")
    period = modes.real("mode_period", "mode")
    if period is None:
        return None
    frequency = modes.real("mode_frequency", "mode")
    return _table(
        slug(level.name, "modes"),
        "Natural periods",
        [
            Column("Mode", [str(number) for number in modes.labels("mode")]),
            _column("Period", np.where(np.isfinite(period), period, math.nan), "s", digits=4, uniform=False),
            _column("Frequency", frequency, "rad/s", digits=4, fixed=True, uniform=False),
        ],
        "About the network at rest; added mass is counted, damping is not.",
    )


def run_table(level: NetworkLevel) -> Table | None:
    """Return how the runs were made."""
    runs = level.runs()
    if not runs:
        return None

    def numbers(name: str) -> Array:
        return np.array([run.number(name) for run in runs])

    return _table(
        slug(level.name, "runs"),
        "Runs through time",
        [
            Column("Run", [run.name for run in runs]),
            _column("H or Hm0", numbers("wave_height"), "m"),
            _column("Period", numbers("period"), "s"),
            _column("Heading", numbers("heading"), "rad"),
            _column("Duration", numbers("duration"), "s", digits=5),
            Column("Method", [str(run.attributes.get("method", "")) for run in runs]),
            _column("Step", numbers("step"), "s", uniform=False),
            _column("Steps", numbers("steps"), "", digits=9, trim=True),
            Column("Status", [str(run.attributes.get("status", "")).replace("_", " ") for run in runs]),
        ],
        "Smallest step, for implicit methods.",
    )
