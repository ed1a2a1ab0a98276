"""Figures of a floating breakwater in its sea states: both domains, measured points, sensitivities."""

from __future__ import annotations

import numpy as np

from moyai.core.arrays import Array
from moyai.report.document import Abscissa, Figure, Mark, Panel, Series
from moyai.report.formatting import largest_magnitude
from moyai.report.reading import Group, common_scale
from moyai.structures.breakwater.report.figures import DASHES, breaking_marks, key, wave_axes, within
from moyai.structures.breakwater.report.reading import MODES, BreakwaterLevel, Sea

FREQUENCY_WORDS, TIME_WORDS, MEASURED_WORDS = "frequency domain", "time domain", "measured"
RATIO_LABELS = {"sway": "sway |x|/(H/2)", "heave": "heave |z|/(H/2)", "roll": "roll |θ|B/H"}


def _both_domains(level: BreakwaterLevel, sea: Sea) -> list[tuple[str, Group, tuple[Abscissa, ...], dict[str, Array]]]:
    found = []
    for words, group in ((FREQUENCY_WORDS, sea.frequency), (TIME_WORDS, sea.time)):
        axes, values = wave_axes(level, group, "period")
        if axes:
            found.append((words, group, axes, values))
    return found


def _curves(
    level: BreakwaterLevel, sea: Sea, wanted: tuple[tuple[str, dict[str, str], str], ...], measured: Group | None = None
) -> tuple[tuple[Abscissa, ...], list[Panel], list[Series]]:
    """Return one panel for each wanted variable with both domains and measured points in it."""
    panels: list[Panel] = []
    series: list[Series] = []
    axes: tuple[Abscissa, ...] = ()
    for name, choice, words in wanted:
        tables = [
            (domain, group, these, values, found)
            for domain, group, these, values in _both_domains(level, sea)
            if (found := group.real(name, "period", **choice)) is not None and np.isfinite(found).any()
        ]
        if not tables:
            continue
        unit = tables[0][1].unit(name)
        if choice.get("dof") == "roll" or choice.get("influenced_dof") == "roll":
            unit = {"m": "rad", "m/m": "rad/m", "N/m": "N m/rad"}.get(unit, unit)
        factor, shown = common_scale(unit, *(entry[4] for entry in tables))
        panels.append(Panel(words, shown, from_zero=name != "mean_offset"))
        for domain, _, these, values, found in tables:
            axes = axes if len(axes) > 0 and len(axes) <= len(these) else these
            in_time = domain == TIME_WORDS
            x, y = within(values, found * factor)
            series.append(
                Series(
                    domain,
                    x,
                    y,
                    len(panels) - 1,
                    1 if in_time else 0,
                    "line+points" if in_time else "line",
                    "dash" if in_time else "solid",
                )
            )
        points = _measured_points(measured, name, choice, factor, tuple(entry.key for entry in axes))
        if points is not None:
            series.append(Series(MEASURED_WORDS, points[0], points[1], len(panels) - 1, 2, "points"))
    return axes, panels, series


_MEASURED_NAMES = {
    "reflection_coefficient": ("reflection_coefficient", "K_R", "C_R", "reflection"),
    "transmission_coefficient": ("transmission_coefficient", "K_T", "C_T", "transmission"),
    "dissipation": ("dissipation", "loss"),
    "drift_coefficient": ("drift_coefficient", "F_star"),
    "mean_drift_force": ("mean_drift_force",),
    "mean_offset": ("mean_offset",),
}


def _measured_points(
    measured: Group | None, name: str, choice: dict[str, str], factor: float, axes: tuple[str, ...]
) -> tuple[dict[str, Array], Array] | None:
    """Return measured points for a variable, by the names that people give their columns."""
    if measured is None or not measured.exists:
        return None
    mode = choice.get("dof", "")
    names = (
        (f"motion_ratio_{mode}", f"{mode}_ratio", mode)
        if name == "motion_ratio"
        else _MEASURED_NAMES.get(name, (name,))
    )
    found = next((entry for candidate in names if (entry := measured.real(candidate, "point")) is not None), None)
    if found is None:
        return None
    x = {}
    for axis, candidates in (
        ("period", ("period", "T")),
        ("ratio", ("wavelength_over_beam", "L_over_B", "L/B")),
        ("omega", ("omega",)),
    ):
        along = next(
            (entry for candidate in candidates if (entry := measured.real(candidate, "point")) is not None), None
        )
        if along is not None and axis in axes:
            x[axis] = along
    if "period" not in x and "omega" in x:
        x["period"] = 2.0 * np.pi / x["omega"]
    if "period" in x and "omega" in axes:
        x.setdefault("omega", 2.0 * np.pi / x["period"])
    return (x, found * factor) if x else None


def _regular_figure(
    level: BreakwaterLevel,
    sea: Sea,
    name: str,
    title: str,
    caption: str,
    wanted: tuple[tuple[str, dict[str, str], str], ...],
    measured: Group | None = None,
    panel_height: int = 130,
) -> Figure | None:
    axes, panels, series = _curves(level, sea, wanted, measured)
    if not series:
        return None
    computed = [set(entry.x) for entry in series if entry.label != MEASURED_WORDS]
    if not computed:
        return None
    keys = set.intersection(*computed)
    axes = tuple(axis for axis in axes if axis.key in keys)
    return Figure(
        key(level, sea.name, name),
        title,
        axes,
        tuple(panels),
        tuple(series),
        caption,
        height=110 + max(panel_height * len(panels), 180),
    )


def regular_motions(level: BreakwaterLevel, sea: Sea, measured: Group | None) -> Figure | None:
    """Motion ratios in regular waves, both domains, with measured points."""
    return _regular_figure(
        level,
        sea,
        "motions",
        "Motions in regular waves",
        "Amplitude over wave amplitude; roll as the vertical motion of the edge of the beam.",
        tuple(("motion_ratio", {"dof": mode}, RATIO_LABELS[mode]) for mode in MODES),
        measured,
    )


def regular_coefficients(level: BreakwaterLevel, sea: Sea, measured: Group | None) -> Figure | None:
    """Reflection, transmission and loss in regular waves."""
    return _regular_figure(
        level,
        sea,
        "wave-coefficients",
        "Transmission, reflection and energy loss in regular waves",
        "Time domain: first harmonic of the simulated motion in the linear expressions.",
        (
            ("transmission_coefficient", {}, "transmission K_T"),
            ("reflection_coefficient", {}, "reflection K_R"),
            ("dissipation", {}, "energy loss"),
        ),
        measured,
    )


def regular_drift(level: BreakwaterLevel, sea: Sea, measured: Group | None) -> Figure | None:
    """Drift coefficient, mean drift force and mean offset in regular waves."""
    return _regular_figure(
        level,
        sea,
        "drift",
        "Drift in regular waves",
        "Mean drift force and offset of the whole unit.",
        (
            ("drift_coefficient", {}, "drift coefficient F*"),
            ("mean_drift_force", {}, "mean drift force"),
            ("mean_offset", {"dof": "sway"}, "mean offset"),
        ),
        measured,
    )


def stiffness_under_drift(level: BreakwaterLevel, sea: Sea) -> Figure | None:
    """Tangent stiffness of the mooring about the mean offset, with its value at rest."""
    group = sea.frequency
    axes, values = wave_axes(level, group, "period")
    stiffness = group.real("mooring_stiffness", "period", "influenced_dof", "radiating_dof")
    if not axes or stiffness is None:
        return None
    rest = level.group.child("statics").array("mooring_stiffness", "influenced_dof", "radiating_dof")
    panels, series, marks = [], [], []
    for number, mode in enumerate(MODES):
        factor, unit = common_scale("N m/rad" if mode == "roll" else "N/m", stiffness[:, number, number])
        panels.append(Panel(f"K{number + 1}{number + 1} {mode}", unit))
        x, y = within(values, stiffness[:, number, number] * factor)
        series.append(Series(f"K{number + 1}{number + 1} {mode}", x, y, number, number, "line+points"))
        if rest is not None:
            marks.append(Mark("at rest", y=float(rest[number, number]) * factor, panel=number))
    return Figure(
        key(level, sea.name, "stiffness"),
        "Mooring stiffness about the mean offset under drift",
        axes,
        tuple(panels),
        tuple(series),
        "Tangent stiffness of all lines, whole unit.",
        tuple(marks),
        height=110 + 130 * len(panels),
    )


def regular_tension(level: BreakwaterLevel, sea: Sea) -> Figure | None:
    """Largest tension of each line against the period, both domains."""
    panels, series, marks = [], [], []
    axes: tuple[Abscissa, ...] = ()
    tables = []
    for words, group, these, values in _both_domains(level, sea):
        names = ("line_tension_maximum",)
        found = next((e for name in names if (e := group.real(name, "period", "line")) is not None), None)
        if found is not None:
            tables.append((words, group, values, found))
            axes = these
    if not tables:
        return None
    factor, unit = common_scale("N", *(entry[3] for entry in tables))
    panels.append(Panel("largest tension at fairlead", unit, from_zero=True))
    for words, group, values, found in tables:
        in_time = words == TIME_WORDS
        for number, name in enumerate(group.labels("line")):
            x, y = within(values, found[:, number] * factor)
            series.append(
                Series(
                    f"{name}, {words}",
                    x,
                    y,
                    0,
                    number,
                    "line+points" if in_time else "line",
                    "dash" if in_time else "solid",
                )
            )
    if not series:
        return None
    marks = breaking_marks(level, tables[0][1].labels("line"), np.concatenate([e[3] for e in tables]), factor, 0)
    keys = set.intersection(*(set(entry.x) for entry in series))
    return Figure(
        key(level, sea.name, "tension"),
        "Line tension in regular waves",
        tuple(axis for axis in axes if axis.key in keys),
        tuple(panels),
        tuple(series),
        "One line of each kind. Frequency domain: mean under drift plus linear amplitude.",
        tuple(marks),
        height=330,
    )


def spectra(level: BreakwaterLevel, sea: Sea) -> Figure | None:
    """Wave, transmitted and response spectra of an irregular sea."""
    group = sea.frequency
    omega, wave = group.real("omega", "omega"), group.real("wave_spectrum", "omega")
    if omega is None or wave is None:
        return None
    x = {"omega": omega, "frequency": omega / (2.0 * np.pi)}
    panels = [Panel("wave spectrum", "m2 s/rad", from_zero=True)]
    series = [Series("incident waves", x, wave, 0, 6)]
    transmitted = group.real("transmitted_spectrum", "omega")
    if transmitted is not None:
        series.append(Series("transmitted waves", x, transmitted, 0, 5, dash="dash"))
    response = group.real("response_spectrum", "omega", "dof")
    if response is not None:
        for number, mode in enumerate(group.labels("dof")):
            turning = mode in {"roll", "pitch", "yaw"}
            factor = (180.0 / np.pi) ** 2 if turning else 1.0
            panels.append(Panel(mode, "deg2 s/rad" if turning else "m2 s/rad", from_zero=True))
            series.append(Series(mode, x, response[:, number] * factor, len(panels) - 1, number))
    energy = np.cumsum(np.nan_to_num(wave))
    last = (
        omega[min(int(np.searchsorted(energy, 0.998 * energy[-1])) + 1, omega.size - 1)]
        if energy[-1] > 0
        else omega[-1]
    )
    return Figure(
        key(level, sea.name, "spectra"),
        "Spectra of waves and motions",
        (Abscissa("omega", "angular frequency ω", "rad/s"), Abscissa("frequency", "frequency f", "Hz")),
        tuple(panels),
        tuple(series),
        "Transmitted waves and motions by linear theory. Densities are per rad/s on either abscissa.",
        window=(0.0, float(last)),
        height=120 + 105 * len(panels),
    )


def tension_bars(level: BreakwaterLevel) -> Figure | None:
    """Tension at rest and largest tension of each line in every sea state, against the breaking load."""
    statics = level.group.child("statics")
    lines = statics.labels("line")
    rest = statics.real("fairlead_tension", "line")
    entries: list[tuple[str, Array]] = [] if rest is None else [("at rest", rest)]
    for name in level.sea_names():
        sea = level.sea(name)
        for domain, words in (("frequency", FREQUENCY_WORDS), ("time", TIME_WORDS)):
            group = sea.domain(domain)
            lines = lines or group.labels("line")
            found = None
            for variable in ("line_tension_maximum", "most_probable_maximum_tension"):
                found = group.real(variable, "period", "line")
                found = np.fmax.reduce(found, axis=0) if found is not None else group.real(variable, "line")
                if found is not None:
                    break
            if found is not None and found.size == len(lines):
                entries.append((f"{name}, {words}", found))
    if not lines or all(words == "at rest" for words, _ in entries):
        return None
    factor, unit = common_scale("N", *(values for _, values in entries))
    panels = [Panel("largest tension", unit, from_zero=True)]
    series = [Series(words, {}, values * factor, 0, tone, "bar") for tone, (words, values) in enumerate(entries)]
    loads = statics.real("breaking_load", "line")
    marks = []
    if loads is not None and np.isfinite(loads).any() and loads.size == len(lines):
        panels.append(Panel("of breaking load", "%", from_zero=True))
        for tone, (words, values) in enumerate(entries):
            series.append(Series(words, {}, 100.0 * values / loads, 1, tone, "bar"))
        if max(largest_magnitude(values / loads) for _, values in entries) > 0.5:
            marks.append(Mark("breaking load", y=100.0, panel=1))
    return Figure(
        key(level, "tension-bars"),
        "Tension against breaking load" if len(panels) > 1 else "Largest line tensions",
        (Abscissa("line", "line"),),
        tuple(panels),
        tuple(series),
        "Largest tension of one line at its fairlead in each sea state."
        + ("" if len(panels) > 1 else " Breaking loads are not given in the case."),
        tuple(marks),
        categories=lines,
        height=110 + 125 * len(panels),
    )


def sensitivity(level: BreakwaterLevel, group: Group) -> Figure | None:
    """Motions and transmission for several values of one parameter."""
    parameter = group.name
    dim = {"damping": "damping_fraction"}.get(parameter, parameter)
    axes, values = wave_axes(level, group, "period")
    steps = group.real(dim, dim)
    if steps is None and dim == "line_count":
        dim = "number_of_lines"
        steps = group.real(dim, dim)
    if not axes or steps is None:
        return None
    words = {"damping_fraction": "ζ =", "line_slack": "slack", "line_count": "lines:", "number_of_lines": "lines:"}.get(
        dim, dim.replace("_", " ")
    )
    unit = {"line_slack": " m"}.get(dim, "")
    panels, series = [], []
    wanted = [("motion_ratio", {"dof": mode}, RATIO_LABELS[mode]) for mode in MODES]
    wanted += [("transmission_coefficient", {}, "transmission K_T"), ("line_tension_maximum", {}, "largest tension")]
    for name, choice, label in wanted:
        found = group.real(name, dim, "period", **choice)
        if found is None and name == "line_tension_maximum":
            by_line = group.real(name, dim, "period", "line")
            found = None if by_line is None else by_line.max(axis=2)
        if found is None or not np.isfinite(found).any():
            continue
        factor, shown = common_scale(group.unit(name), found) if name == "line_tension_maximum" else (1.0, "")
        panels.append(Panel(label, shown, from_zero=True))
        for number, step in enumerate(steps):
            x, y = within(values, found[number] * factor)
            series.append(Series(f"{words} {step:g}{unit}", x, y, len(panels) - 1, number, dash=DASHES[number % 4]))
    if not series:
        return None
    titles = {"damping": "damping", "line_slack": "chain slack", "line_count": "number of lines"}
    return Figure(
        key(level, "sensitivity", parameter),
        f"Sensitivity to {titles.get(parameter, parameter.replace('_', ' '))}",
        axes,
        tuple(panels),
        tuple(series),
        height=110 + 125 * len(panels),
    )
