"""Tables of a floating breakwater."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from moyai.report.document import Column, Table
from moyai.report.formatting import display_unit
from moyai.report.reading import Group
from moyai.structures.breakwater.report.figures import key
from moyai.structures.breakwater.report.reading import (
    DOMAIN_WORDS,
    MODES,
    BreakwaterLevel,
    Sea,
    SeaNumbers,
    breaking_loads,
    ratios_beyond_range,
)


def _useful(column: Column) -> bool:
    """Whether a column says anything: a text, or a number that is known."""
    return any(
        bool(value) if isinstance(value, str) else value is not None and math.isfinite(float(value))
        for value in column.values
    )


def useful_table(
    name: str,
    title: str,
    columns: Sequence[Column],
    *,
    always: int = 1,
    note: str = "",
    collapsed: bool = False,
    emphasised: tuple[int, ...] = (),
) -> Table | None:
    """Return a table without its empty columns; ``None`` when only the first ``always`` would remain."""
    kept = [column for number, column in enumerate(columns) if number < always or _useful(column)]
    if len(kept) <= always or not kept[0].values:
        return None
    return Table(name, title, tuple(kept), note, emphasised, collapsed=collapsed)


def range_words(ratio: float) -> str:
    """Say that a tension is out of the range of lines at rest; empty where it is not."""
    return f"OUT OF RANGE: {ratio:.1f} times the mean" if math.isfinite(ratio) else ""


def sway_words(domain: str, regular: bool) -> str:
    """Say which parts a motion about its mean holds."""
    if regular:
        return "waves"
    return "waves and slow drift" if domain == "time" else "waves alone"


def governing_tables(numbers: tuple[SeaNumbers, ...], governs: SeaNumbers | None) -> tuple[Table, ...]:
    """Governing numbers of every water level, sea state and domain, the decisive row in bold."""
    many_levels = len({entry.level for entry in numbers}) > 1

    def column(label: str, values: list[float], unit: str = "", uniform: bool = True) -> Column:
        return Column(label, values, unit, uniform=uniform)

    def motion(mode: str) -> list[float]:
        return [entry.motions.get(mode, math.nan) for entry in numbers]

    heads = [Column("Water level", [entry.level for entry in numbers])] if many_levels else []
    heads += [
        Column("Sea state", [entry.sea for entry in numbers]),
        Column("Domain", [DOMAIN_WORDS[entry.domain].removesuffix(" domain") for entry in numbers]),
    ]
    emphasised = tuple(row for row, entry in enumerate(numbers) if entry is governs)
    loads = useful_table(
        "governing-tensions-and-offsets",
        "Tensions and offsets by sea state",
        [
            *heads,
            column("Largest tension", [entry.tension for entry in numbers], "N", uniform=False),
            Column("Range of the line model", [range_words(entry.beyond_range) for entry in numbers]),
            Column("Line", [entry.line for entry in numbers]),
            column("at T", [entry.tension_period for entry in numbers], "s"),
            column("Utilisation", [100.0 * entry.utilisation for entry in numbers], "%", uniform=False),
            column("Uplift at anchor", [entry.uplift for entry in numbers], "N", uniform=False),
            column("Mean drift force", [entry.drift for entry in numbers], "N", uniform=False),
            column("Mean offset", [entry.mean_offset for entry in numbers], "m"),
            column("Largest offset", [entry.largest_offset for entry in numbers], "m"),
        ],
        always=len(heads),
        note="Tension of one line at its fairlead; utilisation: tension over breaking load. Regular waves: largest "
        "over the periods.",
        emphasised=emphasised,
    )
    waves = useful_table(
        "governing-motions-and-waves",
        "Motions and waves by sea state",
        [
            *heads,
            column("Sway", motion("sway"), "m"),
            Column("Sway holds", [sway_words(entry.domain, entry.regular) for entry in numbers]),
            column("Heave", motion("heave"), "m"),
            column("Roll", motion("roll"), "rad"),
            column("Transmission K_T", [entry.transmission for entry in numbers]),
            column("at T", [entry.transmission_period for entry in numbers], "s"),
            column("Reflection K_R", [entry.reflection for entry in numbers]),
            column("Waves over deck", [100.0 * entry.overtopping for entry in numbers], "%", uniform=False),
        ],
        always=len(heads),
        note="Motions: amplitude in regular waves, significant double amplitude in irregular seas. Transmission: "
        "largest over the periods with the reflection there, energy-weighted in irregular seas.",
    )
    return tuple(table for table in (loads, waves) if table is not None)


_STATICS = (
    ("draught", "Draught d", "m"),
    ("freeboard", "Freeboard", "m"),
    ("beam", "Beam B", "m"),
    ("section_height", "Section height D", "m"),
    ("unit_length", "Length of the unit l", "m"),
    ("body_mass", "Mass of the body", "kg"),
    ("displaced_mass", "Displaced mass of water", "kg"),
    ("line_vertical_pull", "Vertical pull of the lines", "N"),
    ("imbalance", "Imbalance of weight, buoyancy and lines", "%"),
    ("centre_of_gravity_x", "Centre of gravity x", "m"),
    ("centre_of_gravity_z", "Centre of gravity z", "m"),
    ("metacentric_height", "Metacentric height GM", "m"),
    ("heel", "Heel at rest", "rad"),
)


def derived_numbers(levels: Sequence[BreakwaterLevel]) -> Table | None:
    """Numbers that follow from the case, one column a water level."""
    rows: list[tuple[str, str, list[float]]] = [
        ("Water level above datum", "m", [level.elevation for level in levels]),
        ("Water depth h", "m", [level.depth for level in levels]),
    ]
    groups = [level.group.child("statics") for level in levels]
    known = {name for name, _, _ in _STATICS}
    for name, words, unit in _STATICS:
        rows.append((words, groups[0].unit(name, unit) if groups else unit, [group.value(name) for group in groups]))
    for name in (
        str(name)
        for group in groups[:1]
        if group.node is not None
        for name in group.node.data_vars
        if str(name) not in known
    ):
        if not groups[0].dims(name) and groups[0].variable(name) is not None:
            rows.append((groups[0].long_name(name), groups[0].unit(name), [group.value(name) for group in groups]))
    rows += [
        (
            f"Steady {mode} under wind and current",
            _turn(mode, "m", "rad"),
            [_settled(g.value("steady_offset", dof=mode)) for g in groups],
        )
        for mode in MODES
    ]
    rows = [row for row in rows if any(math.isfinite(value) or math.isinf(value) for value in row[2])]
    if not rows:
        return None
    shown = [display_unit(unit, values) for _, unit, values in rows]
    columns = [Column("Quantity", [row[0] for row in rows]), Column("Unit", [unit.pretty for unit in shown])]
    for number, level in enumerate(levels):
        columns.append(
            Column(
                level.name,
                [row[2][number] * unit.factor for row, unit in zip(rows, shown, strict=True)],
                digits=4,
                uniform=False,
                trim=True,
            )
        )
    return Table("derived-numbers", "Body and water at rest", tuple(columns))


def _settled(value: float) -> float:
    """Take an offset below a hundredth of a millimetre for what a solver leaves over."""
    return 0.0 if abs(value) < 1e-5 else value


def _turn(mode: str, straight: str, turning: str) -> str:
    return turning if mode in {"roll", "pitch", "yaw"} else straight


def lines_at_rest(level: BreakwaterLevel) -> Table | None:
    """The lines as they hang at rest."""
    group = level.group.child("statics")
    names = group.labels("line")
    if not names:
        return None

    def column(name: str, words: str, unit: str, digits: int = 3) -> Column:
        found = group.real(name, "line")
        return Column(words, [math.nan] * len(names) if found is None else [float(v) for v in found], unit, digits)

    utilisation = group.real("utilisation", "line")
    return useful_table(
        key(level, "lines-at-rest"),
        "Lines at rest",
        [
            Column("Line", names),
            Column("Count", _whole(group, "line_count", len(names))),
            column("fairlead_x", "Fairlead x", "m"),
            column("fairlead_z", "Fairlead z", "m"),
            column("anchor_x", "Anchor x", "m", 4),
            column("anchor_z", "Anchor z", "m", 4),
            column("unstretched_length", "Length", "m", 4),
            column("grounded_length", "On the bed", "m"),
            column("fairlead_tension", "Tension at fairlead", "N"),
            column("anchor_horizontal_tension", "Horizontal", "N"),
            column("fairlead_vertical_tension", "Vertical at fairlead", "N"),
            column("anchor_vertical_tension", "Vertical at anchor", "N"),
            column("breaking_load", "Breaking load", "N"),
            Column(
                "Utilisation",
                [math.nan] * len(names) if utilisation is None else [100.0 * float(v) for v in utilisation],
                "%",
            ),
        ],
        note="Values of one line; Count gives how many are equal.",
    )


def _whole(group: Group, name: str, count: int) -> list[float]:
    found = group.real(name, "line")
    return [math.nan] * count if found is None else [float(value) for value in found]


def natural_periods(level: BreakwaterLevel) -> Table | None:
    """Natural periods with their mode shapes."""
    group = level.group.child("statics")
    with_lines, without = group.real("natural_period", "mode"), group.real("natural_period_without_lines", "mode")
    if with_lines is None and without is None:
        return None
    names = group.labels("mode")
    shape = group.array("mode_shape", "mode", "dof")
    columns = [Column("Mode", names)]
    if with_lines is not None:
        columns.append(Column("Natural period", [float(v) for v in with_lines], "s"))
    if without is not None:
        columns.append(Column("Without lines", [float(v) for v in without], "s"))
    if shape is not None:
        for number, mode in enumerate(group.labels("dof")):
            unit = _turn(mode, "m", "rad")
            columns.append(Column(f"Shape: {mode}", [float(np.real(v)) for v in shape[:, number]], unit, fixed=True))
    return Table(
        key(level, "natural-periods"),
        "Natural periods",
        tuple(columns),
        note="A dash or ∞: no restoring force, no natural period.",
    )


def stiffness_matrices(level: BreakwaterLevel) -> Table | None:
    """Hydrostatic and mooring stiffness and inertia at rest."""
    group = level.group.child("statics")
    rows: list[tuple[str, str, list[float], str]] = []
    modes = group.labels("influenced_dof")
    for name, words in (
        ("inertia_matrix", "Inertia"),
        ("hydrostatic_stiffness", "Hydrostatic stiffness"),
        ("mooring_stiffness", "Mooring stiffness"),
    ):
        matrix = group.real(name, "influenced_dof", "radiating_dof")
        if matrix is None:
            continue
        units = ("kg", "kg m", "kg m2") if name == "inertia_matrix" else ("N/m", "N/rad", "N m/rad")
        # the smallest unit of each, so that all terms of a row have one factor
        shown = [display_unit(unit, 0.0) for unit in units]
        unit = ", ".join(item.name for item in shown)
        for number, mode in enumerate(modes):
            rows.append((words, mode, [float(v) * shown[0].factor for v in matrix[number]], unit))
    if not rows:
        return None
    columns = [
        Column("Matrix", [row[0] for row in rows]),
        Column("Force in", [row[1] for row in rows]),
        *(
            Column(f"by {mode}", [row[2][number] for row in rows], digits=4, uniform=False)
            for number, mode in enumerate(modes)
        ),
        Column("Units", [row[3] for row in rows]),
    ]
    return Table(key(level, "matrices"), "Inertia and stiffness at rest, whole unit", tuple(columns), collapsed=True)


def regular_tables(level: BreakwaterLevel, sea: Sea) -> tuple[Table, ...]:
    """Motions with tensions, and waves with drift, for each period of regular waves; the time domain unfolded."""
    found = []
    for domain in ("time", "frequency"):
        folded = domain == "frequency" and sea.time.exists
        found += [_regular_motions(level, sea, domain, folded), _regular_waves(level, sea, domain, folded)]
    return tuple(table for table in found if table is not None)


def _period_column(group: Group, name: str, words: str, unit: str, **choice: str) -> Column:
    found = group.real(name, "period", **choice)
    count = len(group.labels("period"))
    return Column(words, [math.nan] * count if found is None else [float(value) for value in found], unit)


def _regular_motions(level: BreakwaterLevel, sea: Sea, domain: str, folded: bool) -> Table | None:
    group = sea.domain(domain)
    columns = [
        _period_column(group, "period", "T", "s"),
        *(_period_column(group, "motion_amplitude", mode, _turn(mode, "m", "rad"), dof=mode) for mode in MODES),
        _period_column(group, "mean_offset", "Mean offset", "m", dof="sway"),
    ]
    for name in ("line_tension_maximum",):
        found = group.real(name, "period", "line")
        if found is not None:
            columns += [
                Column(f"Largest tension {line}", [float(value) for value in found[:, number]], "N", digits=4)
                for number, line in enumerate(group.labels("line"))
            ]
            break
    ratios = ratios_beyond_range(level, group, domain)
    outside = None if ratios is None or not np.isfinite(ratios).any() else np.atleast_2d(ratios)
    if outside is not None:
        worst = [float(np.nanmax(row)) if np.isfinite(row).any() else math.nan for row in outside]
        columns.append(Column("Range of the line model", [range_words(value) for value in worst]))
    return useful_table(
        key(level, sea.name, domain, "motions"),
        f"Motions and tensions in regular waves, {DOMAIN_WORDS[domain]}",
        columns,
        note="Amplitudes of the motions about the mean; tension of one line at its fairlead."
        + ("" if outside is None else " OUT OF RANGE: lines at rest, largest tension over the mean."),
        collapsed=folded,
    )


def _regular_waves(level: BreakwaterLevel, sea: Sea, domain: str, folded: bool) -> Table | None:
    group = sea.domain(domain)
    radiated = group.real("harmonic_radiation", "period", "harmonic")
    higher = (
        []
        if radiated is None
        else [
            Column(f"Radiated by harmonic {name}", [float(value) for value in radiated[:, number]], "")
            for number, name in enumerate(group.labels("harmonic"))
        ]
    )
    columns = [
        _period_column(group, "period", "T", "s"),
        _period_column(group, "wavelength_over_beam", "L/B", ""),
        *(_period_column(group, "motion_ratio", f"{mode} ratio", "", dof=mode) for mode in MODES),
        _period_column(group, "transmission_coefficient", "K_T", ""),
        _period_column(group, "reflection_coefficient", "K_R", ""),
        _period_column(group, "dissipation", "Energy loss", ""),
        _period_column(group, "damping_work", "Work of damping", ""),
        _period_column(group, "energy_to_harmonics", "To other harmonics", ""),
        *higher,
        _period_column(group, "drift_coefficient", "F*", ""),
        _period_column(group, "mean_drift_force", "Drift force", "N"),
    ]
    return useful_table(
        key(level, sea.name, domain, "waves"),
        f"Waves and drift in regular waves, {DOMAIN_WORDS[domain]}",
        columns,
        note="Ratios: |x|/(H/2), |z|/(H/2), |θ|B/H. Drift force of the whole unit."
        + (
            ""
            if domain == "frequency"
            else " Energy of the first harmonic over the incident flux: its loss is the work "
            "of the damping, or lines transfer the difference into other harmonics and K_T is not that of the whole "
            "wave."
        ),
        collapsed=folded,
    )


def _domains(sea: Sea) -> list[tuple[str, Group]]:
    return [(words, group) for words, group in (("frequency", sea.frequency), ("time", sea.time)) if group.exists]


def irregular_motions(level: BreakwaterLevel, sea: Sea) -> Table | None:
    """Motions of an irregular sea, a row for each mode and domain."""
    holds = {"frequency": sway_words("frequency", False), "time": sway_words("time", False)}
    rows = [(mode, f"{words}: {holds[words]}", group) for mode in MODES for words, group in _domains(sea)]

    def column(name: str, label: str) -> Column:
        return Column(
            label, [group.value(name, dof=mode) * _turn_factor(mode) for mode, _, group in rows], uniform=False
        )

    return useful_table(
        key(level, sea.name, "irregular-motions"),
        "Motions in the irregular sea",
        [
            Column("Motion", [mode for mode, _, _ in rows]),
            Column("Unit", [_turn(mode, "m", "°") for mode, _, _ in rows]),
            Column("Domain", [words for _, words, _ in rows]),
            column("mean_offset", "Mean"),
            column("significant_motion", "Significant, double amplitude"),
            column("most_probable_maximum_motion", "Most probable maximum"),
            column("maximum_motion", "Maximum of the run"),
        ],
        always=3,
        note="Mean from rest; maxima are single amplitudes from the mean. Slow drift is in the motions in time "
        "and not in those of the frequency domain, which gives it separately as a standard deviation.",
    )


def _turn_factor(mode: str) -> float:
    return 180.0 / math.pi if mode in {"roll", "pitch", "yaw"} else 1.0


def irregular_tensions(level: BreakwaterLevel, sea: Sea) -> Table | None:
    """Tensions of an irregular sea, a row for each line and domain."""
    names = sea.time.labels("line") or sea.frequency.labels("line")
    rows = [(number, words, group) for number in range(len(names)) for words, group in _domains(sea)]

    def values(name: str) -> list[float]:
        found = [(group.real(name, "line"), number) for number, _, group in rows]
        return [math.nan if table is None or number >= table.size else float(table[number]) for table, number in found]

    outside = []
    for number, words, group in rows:
        ratios = ratios_beyond_range(level, group, words)
        outside.append(range_words(math.nan if ratios is None else float(np.ravel(ratios)[number])))
    probable, largest = values("most_probable_maximum_tension"), values("line_tension_maximum")
    loads = breaking_loads(level)
    broken = [loads.get(names[number], math.nan) for number, _, _ in rows]
    decisive = [most if math.isfinite(most) else likely for likely, most in zip(probable, largest, strict=True)]
    return useful_table(
        key(level, sea.name, "irregular-tensions"),
        "Line tension in the irregular sea",
        [
            Column("Line", [names[number] for number, _, _ in rows]),
            Column("Domain", [words for _, words, _ in rows]),
            Column("Mean", values("line_tension_mean"), "N"),
            Column("Significant, double amplitude", values("significant_tension"), "N"),
            Column("Most probable maximum, waves alone", probable, "N"),
            Column("Largest", largest, "N"),
            Column("Range of the line model", outside),
            Column("Breaking load", broken, "N"),
            Column("Utilisation", [100.0 * t / load for t, load in zip(decisive, broken, strict=True)], "%"),
        ],
        always=2,
        note="Tension of one line at its fairlead. Largest: mean of the realisations in time; in the frequency domain "
        "waves and slow drift together.",
    )


def irregular_waves(level: BreakwaterLevel, sea: Sea) -> Table | None:
    """Waves on both sides, drift force."""
    rows: list[tuple[str, str, str]] = [
        ("significant_height", "Significant wave height, incident", "m"),
        ("transmitted_significant_height", "Significant wave height, transmitted", "m"),
        ("transmission_coefficient", "Transmission K_T, energy-weighted", ""),
        ("reflection_coefficient", "Reflection K_R, energy-weighted", ""),
        ("mean_drift_force", "Mean drift force, whole unit", "N"),
    ]
    kept, frequency, time, units = [], [], [], []
    for name, words, unit in rows:
        pair = [group.value(name) for group in (sea.frequency, sea.time)]
        if any(map(math.isfinite, pair)):
            shown = display_unit(unit, pair)
            kept.append(words)
            units.append(shown.pretty)
            frequency.append(pair[0] * shown.factor)
            time.append(pair[1] * shown.factor)
    return useful_table(
        key(level, sea.name, "irregular-waves"),
        "Waves and drift",
        [
            Column("Quantity", kept),
            Column("Unit", units),
            Column("Frequency domain", frequency, uniform=False),
            Column("Time domain", time, uniform=False),
        ],
        always=2,
    )
