"""Figures of a submerged member: C_M and circulation over KC, forces over time, coefficients and forces along it."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from moyai.core.arrays import Array
from moyai.report.decimate import focus_indices, window_around
from moyai.report.document import Abscissa, Column, Drawing, Figure, Mark, Panel, Series, Table
from moyai.report.encoding import slug
from moyai.report.formatting import format_quantity
from moyai.report.reading import Group, common_scale
from moyai.report.sketch import Sketch

AXES = ("first", "second")
COMPONENTS = ("x", "y", "z")
CURVES = (
    ("inertia_coefficient", "this case", "solid", 0),
    ("arai_inertia_coefficient", "Arai et al., γ = 0.936", "dash", 1),
    ("otsuka_inertia_coefficient", "Otsuka and Ikeda, γ = 1", "dot", 2),
    ("chaplin_inertia_coefficient", "Chaplin, γ = 1.036", "dashdot", 3),
    ("planar_inertia_coefficient", "planar flow, laminar theory held (not measured)", "solid", 4),
    ("laminar_inertia_coefficient", "laminar ceiling, γ = 3", "dot", 5),
)
POINTS_OF_A_CURVE = 3000
WINDOW_PERIODS = 20.0


def over_keulegan_carpenter(level: Group) -> tuple[Figure, ...]:
    """Return C_M of both axes and the circulation over KC, with the published curves and the waves of the case."""
    group = level.child("sweep")
    number = group.real("keulegan_carpenter", "keulegan_carpenter")
    if number is None:
        return ()
    along = (Abscissa("kc", "Keulegan-Carpenter number KC"),)
    figures = []
    series: list[Series] = []
    for panel, axis in enumerate(AXES):
        for name, label, dash, tone in CURVES:
            values = group.real(name, "keulegan_carpenter", axis=axis)
            if values is None:
                continue
            # curves far below the axis say nothing
            shown = np.where(values > -0.25, values, np.nan)
            series.append(
                Series(label, {"kc": number}, shown, panel, tone, dash=dash, faint=name.startswith("laminar"))  # type: ignore[arg-type]
            )
        series.extend(_points(level, "effective_inertia_coefficient", panel, axis))
    figures.append(
        Figure(
            slug(level.name, "inertia-over-kc"),
            "Inertia coefficient over KC",
            along,
            tuple(Panel(f"C_M, {axis} axis", from_zero=True) for axis in AXES),
            tuple(series),
            "Curves: circular orbit at the frequency of the first sea. Points: waves of this case at the strip of the "
            "largest KC, as the forces were computed. Beyond KC = 2 the law was not measured.",
            (Mark("end of the law", x=2.0),),
            height=560,
        )
    )
    names = (
        ("circulation", "this case", 0),
        ("arai_circulation", "Arai et al.", 1),
        ("otsuka_circulation", "Otsuka", 2),
        ("chaplin_circulation", "Chaplin", 3),
        ("laminar_circulation", "laminar edge, 3 V²T", 5),
    )
    curves = []
    for name, label, tone in names:
        values = group.real(name, "keulegan_carpenter")
        if values is not None:
            curves.append(Series(label, {"kc": number}, values, 0, tone, dash="solid" if tone == 0 else "dash"))
    curves.extend(_points(level, "settled_circulation", 0, ""))
    figures.append(
        Figure(
            slug(level.name, "circulation-over-kc"),
            "Circulation over KC",
            along,
            (Panel("circulation Γ", "m2/s"),),
            tuple(curves),
            "Circulation in the sense of the orbit. Points: what the law gives for the waves of this case, whether it "
            "is counted or not.",
            (Mark("end of the law", x=2.0),),
        )
    )
    angle, speeds = (
        group.real("surface_angle", "surface_angle"),
        group.real("surface_speed_ratio", "phase", "surface_angle"),
    )
    if angle is not None and speeds is not None:
        degrees = np.degrees(angle)
        figures.append(
            Figure(
                slug(level.name, "surface-speed"),
                "Where the water runs fast",
                (Abscissa("angle", "angle around the circle from its first axis", "deg"),),
                (Panel("speed over that of the stream", from_zero=True),),
                tuple(
                    Series(phase, {"angle": degrees}, speeds[n], 0, n) for n, phase in enumerate(group.labels("phase"))
                ),
                "Potential flow with circulation in a circular orbit at KC = 1.5, waves towards the first axis: the "
                "fast region is above (+90°) at the crest, below (−90°) at the trough, and turns clockwise "
                "with the wave.",
            )
        )
    return tuple(figures)


def _points(level: Group, name: str, panel: int, axis: str) -> list[Series]:
    found = []
    for tone, sea in enumerate(level.child("waves").children()):
        number = sea.real("keulegan_carpenter", "wave")
        values = sea.real(name, "wave", axis=axis) if axis else sea.real(name, "wave")
        if number is None or values is None:
            continue
        keep = number <= 4.0
        if keep.any():
            found.append(Series(sea.name, {"kc": number[keep]}, values[keep], panel, 6 + tone % 2, style="points"))
    return found


def force_over_time(level: Group, sea: Group, run: Group) -> Figure | None:
    """Return forces by direction and cause, circulation and surface over time."""
    time = run.real("time", "time")
    force = run.array("force", "time", "component")
    if time is None or force is None or math.isnan(float(run.attributes.get("period", 0.0) or 0.0)):
        return None
    causes = [(name, run.array(f"{name}_force", "time", "component")) for name in ("inertia", "drag", "magnus")]
    factor, unit = common_scale("N", force)
    largest = float(np.abs(force).max())
    used = [k for k in range(3) if float(np.abs(force[:, k]).max()) > 1e-6 * largest] or [0]
    period = float(run.attributes.get("period", 0.0) or 0.0)
    peak = float(time[int(np.argmax(np.linalg.norm(force, axis=1)))])
    whole = period <= 0.0 or time[-1] - time[0] <= 1.5 * WINDOW_PERIODS * period
    shown = (0, time.size) if whole else window_around(time, peak, WINDOW_PERIODS * period)

    def kept(values: Array) -> NDArray[np.int64]:
        if values.size <= POINTS_OF_A_CURVE:
            return np.arange(values.size)
        return np.asarray(focus_indices(values, shown, POINTS_OF_A_CURVE // 4))

    panels = [Panel(f"force along {COMPONENTS[k]}", unit) for k in used]
    series = []
    for panel, k in enumerate(used):
        for tone, (label, values) in enumerate([("total", force), *causes]):
            if values is None or not np.abs(values[:, k]).max() > 1e-9 * largest:
                continue
            curve = values[:, k] * factor
            keep = kept(curve)
            series.append(Series(label, {"time": time[keep]}, curve[keep], panel, tone, faint=tone > 0))
    for name, words in (("surface_elevation", "surface"), ("circulation", "circulation")):
        found = run.real(name, "time")
        if found is None or not np.abs(found).max() > 0.0:
            continue
        scale, unit_of = (
            (1e4, "cm2/s") if name == "circulation" and np.abs(found).max() < 0.1 else (1.0, run.unit(name))
        )
        keep = kept(found)
        series.append(Series(words, {"time": time[keep]}, scale * found[keep], len(panels), 7))
        panels.append(Panel(words, unit_of))
    window = None if whole else (float(time[shown[0]]), float(time[shown[1] - 1]))
    return Figure(
        slug(level.name, sea.name, run.name, "force"),
        f"Force on the member: {run.attributes.get('wave', run.name)}",
        (Abscissa("time", "time", "s"),),
        tuple(panels),
        tuple(series),
        "Whole member by direction; inertia, drag and Magnus force with their sum.",
        window=window,
        slider=window is not None,
        height=140 + 150 * len(panels),
    )


def along_member(level: Group, sea: Group) -> Figure | None:
    """Return the largest force per length and KC along the member."""
    place = sea.real("strip", "strip")
    force = sea.array("maximum_strip_force", "wave", "strip", "axis")
    number = sea.real("strip_keulegan_carpenter", "wave", "strip")
    wet = sea.real("wet_share", "wave", "strip")
    if place is None or force is None or number is None or place.size < 2:
        return None
    factor, unit = common_scale("N/m", force)
    loaded = [axis for axis in range(2) if force[:, :, axis].max() > 1e-9 * force.max()] or [0]
    moving = not bool(np.isnan(number).all())
    last = len(loaded) + moving
    series = []
    for tone, (wave, name) in enumerate(_few(sea.labels("wave"))):
        for panel, axis in enumerate(loaded):
            series.append(Series(name, {"s": place}, force[wave, :, axis] * factor, panel, tone))
        if moving:
            series.append(Series(name, {"s": place}, number[wave], last - 1, tone))
        if wet is not None and wet.min() < 1.0:
            series.append(Series(name, {"s": place}, wet[wave], last, tone))
    panels = [Panel(f"largest force, {AXES[axis]} axis", unit, from_zero=True) for axis in loaded]
    panels += [Panel("KC", from_zero=True)] * moving
    if wet is not None and wet.min() < 1.0:
        panels.append(Panel("wetted share", from_zero=True))
    return Figure(
        slug(level.name, sea.name, "along"),
        f"Along the member: {sea.name}",
        (Abscissa("s", "distance from the start of the member", "m"),),
        tuple(panels),
        tuple(series),
        "Largest force per length over time, exposure to the surface included.",
        height=140 + 150 * len(panels),
    )


def bending_along(level: Group, sea: Group) -> Figure | None:
    """Return the largest bending moment along the member."""
    place = sea.real("station", "station")
    moment = sea.real("maximum_bending_moment_along", "wave", "station")
    if place is None or moment is None or place.size < 3:
        return None
    factor, unit = common_scale("N m", moment)
    return Figure(
        slug(level.name, sea.name, "bending"),
        f"Bending moment along the member: {sea.name}",
        (Abscissa("s", "distance from the start of the member", "m"),),
        (Panel("largest bending moment", unit, from_zero=True),),
        tuple(
            Series(name, {"s": place}, moment[wave] * factor, 0, tone)
            for tone, (wave, name) in enumerate(_few(sea.labels("wave")))
        ),
        "Largest over time at each place, of waves and current alone; as the member is held.",
        height=290,
    )


def _few(waves: Sequence[str]) -> list[tuple[int, str]]:
    """Return at most four waves, or the first, the middle one and the last of more."""
    chosen = range(len(waves)) if len(waves) <= 4 else (0, len(waves) // 2, len(waves) - 1)
    return [(index, waves[index]) for index in chosen]


def _columns(sea: Group, entries: tuple[tuple[str, str, str, dict[str, str]], ...]) -> list[Column]:
    """Return columns over the waves of a sea: label, variable, unit, choice of labels."""
    found = []
    for label, name, unit, choice in entries:
        values = sea.real(name, "wave", **choice)
        # a current alone has no height, no period, no KC
        if values is not None and not np.isnan(values).all():
            found.append(Column(label, [float(value) for value in values], unit))
    return found


_WAVE: tuple[tuple[str, str, str, dict[str, str]], ...] = (
    ("H", "wave_height", "m", {}),
    ("T", "period", "s", {}),
    ("KC", "keulegan_carpenter", "", {}),
)


def coefficient_table(level: Group, sea: Group) -> Table | None:
    """Return the coefficients of every wave."""
    if not sea.labels("wave"):
        return None
    entries = (
        *_WAVE,
        ("Re", "reynolds", "", {}),
        ("β", "beta", "", {}),
        *((f"C_M, {axis}", "plain_inertia_coefficient", "", {"axis": axis}) for axis in AXES),
        *((f"with Γ, {axis}", "effective_inertia_coefficient", "", {"axis": axis}) for axis in AXES),
        *((f"C_D, {axis}", "drag_coefficient", "", {"axis": axis}) for axis in AXES),
        ("Γ counted", "circulation", "m2/s", {}),
        ("Γ by the law", "settled_circulation", "m2/s", {}),
    )
    return Table(
        slug(level.name, sea.name, "coefficients"),
        f"Coefficients: {sea.name}",
        tuple(_columns(sea, entries)),
        note="At the strip of the largest KC; of irregular seas significant height and peak period.",
    )


def force_table(level: Group, sea: Group) -> Table | None:
    """Return the forces of every wave."""
    if not sea.exists:
        return None
    values = sea.require("maximum_total_force", "wave")
    seeds = sea.real("seed_of_realisation", "realisation")
    count = 0 if seeds is None else seeds.size
    said = (
        f" Largest values are means over {count} realisations; the rest is that nearest to the mean."
        if count > 1
        else ""
    )
    entries = (
        *_WAVE,
        *((f"largest F_{name}", "maximum_force", "N", {"component": name}) for name in COMPONENTS),
        ("largest force", "maximum_total_force", "N", {}),
        *((f"mean F_{name}", "mean_force", "N", {"component": name}) for name in COMPONENTS),
        *((f"largest at the {end}", "maximum_end_force", "N", {"end": end}) for end in ("start", "end")),
        ("largest bending moment", "maximum_bending_moment", "N m", {}),
    )
    return Table(
        slug(level.name, sea.name, "forces"),
        f"Forces on the member: {sea.name}",
        tuple(_columns(sea, entries)),
        note="Whole member; loads at its ends and bending moment as it is held, of waves and current alone." + said,
        emphasised=(int(values.argmax()),) if values.size > 1 else (),
    )


def surface_table(level: Group) -> Table | None:
    """Return what the free surface changes."""
    rows = []
    for sea in level.child("surface").children():
        period = sea.real("period", "period")
        for axis in AXES:
            inertia = sea.real("near_surface_inertia_coefficient", "period", axis=axis)
            change = sea.real("near_surface_change", "period", axis=axis)
            radiation = sea.real("radiation_ratio", "period", axis=axis)
            if period is None or inertia is None or change is None or radiation is None:
                continue
            for n in range(period.size):
                rows.append((sea.name, axis, period[n], inertia[n], 100.0 * change[n], 100.0 * radiation[n]))
    if not rows:
        return None
    titles = ("Sea", "Axis", "T [s]", "C_M under the surface", "change [%]", "wave damping over ωρA [%]")
    return Table(
        slug(level.name, "surface"),
        "What the free surface changes",
        tuple(Column(title, [row[k] for row in rows]) for k, title in enumerate(titles)),
        note="Two-dimensional potential theory with surface and bed; above 2 % the coefficients of deep water are "
        "warned about.",
    )


def section_drawing(level: Group) -> Drawing | None:
    """Return the outline of the section, to scale."""
    group = level.child("member")
    x, z = group.real("outline_x", "outline_point"), group.real("outline_z", "outline_point")
    if x is None or z is None or not (np.ptp(x) > 0.0 and np.ptp(z) > 0.0):
        return None
    width, height = float(np.ptp(x)), float(np.ptp(z))
    # Pixels a metre, so that the section fits into both directions of the page
    scale = min(640.0 / width, 240.0 / height)
    middle_x, middle_z = 0.5 * float(x.max() + x.min()), 0.5 * float(z.max() + z.min())
    half_x, half_z = 0.5 * 900.0 / scale, 0.5 * (height + 110.0 / scale)
    extent = (middle_x - half_x, middle_x + half_x, middle_z - half_z, middle_z + half_z)
    sketch = Sketch(extent, width=920.0, title="Section of the member")
    sketch.path(np.column_stack([x, z]), "hull", closed=True)
    ends = (float(x.min()), float(x.max()), float(z.min()), float(z.max()))
    sketch.dimension(ends[0], ends[2], ends[1], ends[2], format_quantity(width, "m"), offset=32.0)
    sketch.dimension(ends[1], ends[2], ends[1], ends[3], format_quantity(height, "m"), offset=32.0)
    sketch.dot(0.0, 0.0, 3.0, "marker")
    caption = "To scale; first axis level, second axis upwards. Dot: the axis of the member."
    return sketch.drawing(slug(level.name, "section"), "Section", caption)


def member_table(level: Group) -> Table | None:
    """Return geometry and ideal inertia coefficients."""
    group = level.child("member")
    tensor = group.array("ideal_inertia_coefficient", "axis", "other_axis")
    if tensor is None:
        return None
    names = ("length", "inclination", "area", "width", "height")
    labels = [group.long_name(name) for name in names]
    values: list[float] = [group.value(name) for name in names]
    units = [group.unit(name) for name in names]
    from moyai.report.formatting import display_unit

    shown = [display_unit(unit, value) for unit, value in zip(units, values)]
    rows = [(label, value * unit.factor, unit.name) for label, value, unit in zip(labels, values, shown)]
    for i, first in enumerate(AXES):
        for j, second in enumerate(AXES[i:], i):
            value = float(tensor[i, j])
            rows.append((f"ideal C_M, {first} axis by {second}", value if abs(value) > 1e-9 else 0.0, ""))
    rows.append(("estimated relative error of C_M", group.value("inertia_error"), ""))
    return Table(
        slug(level.name, "member"),
        "Member",
        tuple(
            Column(title, [row[k] for row in rows], digits=5, uniform=False)
            for k, title in enumerate(("Quantity", "Value", "Unit"))
        ),
    )
