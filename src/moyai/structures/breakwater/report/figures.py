"""Figures of a floating breakwater, each from one group of the result; ``None`` where the group does not hold it."""

from __future__ import annotations

from typing import Literal

import numpy as np

from moyai.core.arrays import Array
from moyai.report.document import Abscissa, Figure, Mark, Panel, Series
from moyai.report.encoding import slug
from moyai.report.formatting import largest_magnitude
from moyai.report.reading import Group, common_scale
from moyai.structures.breakwater.report.reading import BreakwaterLevel

DASHES: tuple[Literal["solid", "dash", "dot", "dashdot"], ...] = ("solid", "dash", "dot", "dashdot")


def key(level: BreakwaterLevel, *parts: str) -> str:
    """Return the key of a figure or table at a water level."""
    return slug(level.name, *parts)


def wave_axes(level: BreakwaterLevel, group: Group, dim: str) -> tuple[tuple[Abscissa, ...], dict[str, Array]]:
    """Return the ways to plot against the wave: period, wavelength over beam, angular frequency.

    Parameters
    ----------
    level : Level
    group : Group
        Group that holds ``dim``.
    dim : {"omega", "period"}

    Returns
    -------
    abscissae, values
        Values are keyed as the abscissae.
    """
    along = group.real(dim, dim)
    if along is None:
        return (), {}
    with np.errstate(divide="ignore"):
        other = 2.0 * np.pi / along
    period, omega = (along, other) if dim == "period" else (other, along)
    axes = [Abscissa("period", "wave period T", "s")]
    values = {"period": period}
    ratio = group.real("wavelength_over_beam", dim)
    if ratio is None:
        ratio = _wavelength_over_beam(level, period)
    if ratio is not None:
        axes.append(Abscissa("ratio", "wavelength over beam L/B"))
        values["ratio"] = ratio
    axes.append(Abscissa("omega", "angular frequency ω", "rad/s"))
    values["omega"] = omega
    return tuple(axes), values


def _wavelength_over_beam(level: BreakwaterLevel, period: Array) -> Array | None:
    """Interpolate L/B between the periods of the response operators; ``None`` where they do not reach."""
    rao = level.group.child("rao")
    known_omega, known = rao.real("omega", "omega"), rao.real("wavelength_over_beam", "omega")
    if known_omega is None or known is None or known_omega.size < 2:
        return None
    known_period = 2.0 * np.pi / known_omega
    order = np.argsort(known_period)
    inside = (period >= known_period[order[0]] - 1e-9) & (period <= known_period[order[-1]] + 1e-9)
    if not inside.all():
        return None
    return np.interp(period, known_period[order], known[order])


def window_of_interest(level: BreakwaterLevel, values: dict[str, Array]) -> tuple[float, float] | None:
    """Return the periods that the sea states reach, with a margin; ``None`` where all are shown anyway.

    Parameters
    ----------
    level : Level
    values : dict
        Abscissae of a figure, with ``period`` [s].

    Returns
    -------
    tuple of float or None
    """
    longest = []
    for name in level.sea_names():
        sea = level.sea(name)
        periods = [group.real("period", "period") for group in (sea.frequency, sea.time)]
        longest += [float(np.max(entry)) for entry in periods if entry is not None and entry.size]
        omega, density = sea.frequency.real("omega", "omega"), sea.frequency.real("wave_spectrum", "omega")
        if omega is not None and density is not None and largest_magnitude(density) > 0.0:
            longest.append(2.0 * np.pi / float(omega[int(np.nanargmax(density))]))
    known = values["period"][np.isfinite(values["period"])]
    if not longest or known.size < 2 or 1.7 * max(longest) >= known.max():
        return None
    return float(known.min()), float(1.7 * max(longest))


def within(values: dict[str, Array], y: Array) -> tuple[dict[str, Array], Array]:
    """Sort along the first abscissa and drop points without an abscissa (omega = 0)."""
    first = next(iter(values.values()))
    keep = np.isfinite(first)
    order = np.argsort(first[keep], kind="stable")
    return {name: entry[keep][order] for name, entry in values.items()}, y[keep][order]


def restoring(level: BreakwaterLevel) -> Figure | None:
    """Horizontal restoring force and line tensions against the offset."""
    group = level.group.child("mooring")
    offset, force = group.real("offset", "offset"), group.real("restoring_force", "offset")
    if offset is None or (force is None and group.real("line_tension", "line", "offset") is None):
        return None
    x = {"offset": offset}
    panels, series, marks = [], [], []
    if force is not None:
        vertical = group.real("vertical_force", "offset")
        factor, unit = common_scale("N", force, vertical)
        panels.append(Panel("force on the body", unit))
        series.append(Series("horizontal force", x, force * factor, 0, 0))
        if vertical is not None:
            series.append(Series("vertical force", x, vertical * factor, 0, 6, dash="dash"))
    tension = group.real("line_tension", "line", "offset")
    if tension is not None:
        factor, unit = common_scale("N", tension)
        panels.append(Panel("tension at fairlead", unit, from_zero=True))
        at = len(panels) - 1
        names = group.labels("line")
        for number, name in enumerate(names):
            series.append(Series(name, x, tension[number] * factor, at, 1 + number, dash=DASHES[number % 4]))
        marks += breaking_marks(level, names, tension, factor, at)
    steady = level.group.child("statics").value("steady_offset", dof="sway")
    if np.isfinite(steady) and abs(steady) > 1e-3 * float(np.ptp(offset)):
        marks.append(Mark("steady offset", x=steady))
    return Figure(
        key(level, "restoring"),
        "Mooring: restoring force and line tension against offset",
        (Abscissa("offset", "offset in sway from rest", "m"),),
        tuple(panels),
        tuple(series),
        "Force that the lines exert on the body, all lines together; tension of one line at its fairlead.",
        tuple(marks),
        height=230 + 190 * (len(panels) - 1),
    )


def breaking_marks(
    level: BreakwaterLevel, names: tuple[str, ...], tension: Array, factor: float, panel: int
) -> list[Mark]:
    """Return the breaking loads that lie within sight of the curves."""
    statics = level.group.child("statics")
    loads = statics.real("breaking_load", "line")
    if loads is None:
        return []
    known = dict(zip(statics.labels("line"), loads, strict=True))
    seen = {float(known[name]) for name in names if name in known and np.isfinite(known[name])}
    top = float(np.nanmax(tension)) if np.isfinite(tension).any() else 0.0
    return [Mark("breaking load", y=load * factor, panel=panel) for load in sorted(seen) if load < 1.6 * top]


def response_operators(level: BreakwaterLevel) -> tuple[Figure, ...]:
    """Amplitude and phase of the motions per metre of wave amplitude."""
    group = level.group.child("rao")
    axes, values = wave_axes(level, group, "omega")
    operator = group.array("rao", "omega", "dof")
    if not axes or operator is None:
        return ()
    modes = group.labels("dof")
    panels, amplitude, phase = [], [], []
    for number, mode in enumerate(modes):
        turning = mode in {"roll", "pitch", "yaw"}
        factor, unit = (180.0 / np.pi, "deg/m") if turning else (1.0, "m/m")
        panels.append(Panel(mode, unit, from_zero=True))
        x, y = within(values, np.abs(operator[:, number]) * factor)
        amplitude.append(Series(mode, x, y, number, number))
        x, y = within(values, np.angle(operator[:, number], deg=True))
        phase.append(Series(mode, x, y, 0, number, dash=DASHES[number % 4]))
    figures = [
        Figure(
            key(level, "rao"),
            "Motion response amplitude per metre of wave amplitude",
            axes,
            tuple(panels),
            tuple(amplitude),
            "Linear response about rest, wave of heading 0 unless the sea state says otherwise.",
            window=window_of_interest(level, values),
            height=120 + 125 * len(panels),
        )
    ]
    if np.iscomplexobj(operator):
        figures.append(
            Figure(
                key(level, "rao-phase"),
                "Phase of the motions",
                axes,
                (Panel("phase", "deg", limits=(-180.0, 180.0)),),
                tuple(phase),
                "Motion Re(X exp(−iωt)) against the undisturbed crest at x = 0; positive: the motion lags.",
                window=window_of_interest(level, values),
                height=280,
            )
        )
    return tuple(figures)


def wave_coefficients(level: BreakwaterLevel) -> Figure | None:
    """Reflection, transmission and loss of the moored body over frequency, with screening formulas."""
    group = level.group.child("rao")
    axes, values = wave_axes(level, group, "omega")
    if not axes:
        return None
    series = []
    for tone, (name, words) in enumerate(
        (
            ("transmission_coefficient", "transmission K_T"),
            ("reflection_coefficient", "reflection K_R"),
            ("dissipation", "energy loss"),
        )
    ):
        found = group.real(name, "omega")
        if found is not None:
            x, y = within(values, found)
            series.append(Series(words, x, y, 0, tone, dash=DASHES[tone]))
    if not series:
        return None
    for number, (name, words) in enumerate(
        (
            ("transmission_macagno", "K_T Macagno"),
            ("transmission_wiegel", "K_T Wiegel"),
            ("transmission_ruol", "K_T Ruol"),
        )
    ):
        found = group.real(name, "omega")
        if found is not None:
            x, y = within(values, found)
            series.append(Series(words, x, y, 0, 3 + number, dash=DASHES[1 + number], faint=True))
    return Figure(
        key(level, "coefficients"),
        "Reflection, transmission and energy loss",
        axes,
        (Panel("coefficient", "", limits=(0.0, 1.05)),),
        tuple(series),
        "Moored body in linear theory. Energy loss is 1 − K_R² − K_T². Thin lines: screening formulas for K_T.",
        window=window_of_interest(level, values),
        height=380,
    )


def drift(level: BreakwaterLevel) -> Figure | None:
    """Mean drift force over frequency."""
    group = level.group.child("rao")
    axes, values = wave_axes(level, group, "omega")
    coefficient = group.real("drift_coefficient", "omega")
    names = ("mean_drift_force_per_amplitude_squared", "mean_drift_force")
    name = next((entry for entry in names if group.real(entry, "omega") is not None), names[0])
    force = group.real(name, "omega")
    if not axes or (coefficient is None and force is None):
        return None
    panels, series = [], []
    if coefficient is not None:
        x, y = within(values, coefficient)
        panels.append(Panel("drift coefficient F*", "", from_zero=True))
        series.append(Series("drift coefficient F*", x, y, 0, 0))
    if force is not None:
        unit = group.unit(name, "N/m2")
        factor, shown = common_scale(unit, force)
        x, y = within(values, force * factor)
        panels.append(Panel("force per amplitude²", shown, from_zero=True))
        series.append(Series("force per amplitude²", x, y, len(panels) - 1, 1))
    return Figure(
        key(level, "drift"),
        "Mean drift force",
        axes,
        tuple(panels),
        tuple(series),
        "F* = K_R² + loss/2, the mean force over ρg(H/2)²·C_g/C; force on the whole unit per squared wave amplitude.",
        window=window_of_interest(level, values),
        height=120 + 150 * len(panels),
    )


def hydrodynamic_coefficients(level: BreakwaterLevel) -> tuple[Figure, ...]:
    """Added mass, radiation damping and excitation of the section, per metre."""
    group = level.group.child("hydrodynamics")
    axes, values = wave_axes(level, group, "omega")
    if not axes:
        return ()
    figures = []
    for name, title in (("added_mass", "Added mass"), ("radiation_damping", "Wave radiation damping")):
        found = group.real(name, "omega", "radiating_dof", "influenced_dof")
        if found is None:
            continue
        modes = group.labels("influenced_dof")
        limits = (
            group.array("infinite_frequency_added_mass", "radiating_dof", "influenced_dof")
            if name == "added_mass"
            else None
        )
        panels, series, marks = [], [], []
        for number, mode in enumerate(modes):
            unit = _coefficient_unit(name, mode)
            factor, shown = common_scale(unit, found[:, number, number])
            panels.append(Panel(mode, f"{shown} per m"))
            x, y = within(values, found[:, number, number] * factor)
            series.append(Series(mode, x, y, number, number))
            if limits is not None and np.isfinite(limits[number, number]):
                marks.append(Mark("ω → ∞", y=float(limits[number, number]) * factor, panel=number))
        figures.append(
            Figure(
                key(level, name),
                title,
                axes,
                tuple(panels),
                tuple(series),
                "Per metre of the unit, diagonal terms.",
                tuple(marks),
                window=window_of_interest(level, values),
                height=120 + 115 * len(panels),
            )
        )
    excitation = _excitation(level, group, axes, values)
    return (*figures, *([excitation] if excitation else []))


def _coefficient_unit(name: str, mode: str) -> str:
    turning = mode in {"roll", "pitch", "yaw"}
    if name == "added_mass":
        return "kg m2" if turning else "kg"
    return "N m s" if turning else "N s/m"


def _excitation(
    level: BreakwaterLevel, group: Group, axes: tuple[Abscissa, ...], values: dict[str, Array]
) -> Figure | None:
    found = group.variable("excitation_force")
    if found is None or "influenced_dof" not in found.dims or "omega" not in found.dims:
        return None
    if "wave_direction" in found.dims:
        found = found.isel(wave_direction=0)
    force = np.abs(np.asarray(found.transpose("omega", "influenced_dof").values))
    panels, series = [], []
    for number, mode in enumerate(group.labels("influenced_dof")):
        factor, shown = common_scale("N m" if mode in {"roll", "pitch", "yaw"} else "N", force[:, number])
        panels.append(Panel(mode, f"{shown} per m per m", from_zero=True))
        x, y = within(values, force[:, number] * factor)
        series.append(Series(mode, x, y, number, number))
    return Figure(
        key(level, "excitation"),
        "Wave excitation",
        axes,
        tuple(panels),
        tuple(series),
        "Modulus per metre of the unit and metre of wave amplitude, body held fixed.",
        window=window_of_interest(level, values),
        height=120 + 115 * len(panels),
    )
