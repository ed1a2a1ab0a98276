"""Figures of a rigid cage: motions and peaks over period and height, what line stiffness changes."""

from __future__ import annotations

import numpy as np

from moyai.report.document import Abscissa, Column, Figure, Mark, Panel, Series, Table
from moyai.report.reading import Group, common_scale
from moyai.structures.cage.report.rigid_reading import CageLevel, key


def response_figure(level: CageLevel, sea: Group) -> Figure | None:
    """Return ranges over H, rotation and peak tensions over the period, or over the height where that varies."""
    period, height = sea.real("period", "wave"), sea.real("wave_height", "wave")
    ratio, turned = sea.array("range_ratio", "wave", "translation"), sea.array("range", "wave", "mode")
    if period is None or height is None or ratio is None or turned is None:
        return None
    periods, heights = np.unique(period), np.unique(height)
    if len(periods) < 2 and len(heights) < 2:
        return None
    over_period = len(periods) >= 2
    factor, unit = common_scale("m", height)
    group_values = heights if over_period else periods
    abscissa = Abscissa("period", "wave period T", "s") if over_period else Abscissa("height", "wave height H", unit)
    series: list[Series] = []
    peak = sea.array("line_tension_maximum", "wave", "line", "end")
    lines = sea.labels("line")
    scale, force = common_scale("N", peak) if peak is not None else (1.0, "N")
    water = sea.array("orbit_ratio", "wave")
    for value in group_values:
        rows = np.flatnonzero((height if over_period else period) == value)
        rows = rows[np.argsort((period if over_period else height)[rows])]
        x = {abscissa.key: period[rows] if over_period else factor * height[rows]}
        said = ""
        if len(group_values) > 1:
            said = f", H {value * factor:.3g} {unit}" if over_period else f", T {value:.3g} s"
        several = bool(value != group_values[0])
        for tone, name in enumerate(("sway", "heave")):
            series.append(Series(f"{name}{said}", x, ratio[rows, tone], 0, tone, style="line+points", faint=several))
        if not several and water is not None and over_period:
            series.append(Series("water at the surface, x", x, water[rows], 0, 7, dash="dot", faint=True))
        series.append(
            Series(f"rotation{said}", x, np.degrees(0.5 * turned[rows, 2]), 1, 2, style="line+points", faint=several)
        )
        if peak is not None:
            for n, line in enumerate(lines):
                series.append(
                    Series(f"{line}{said}", x, scale * peak[rows, n, 0], 2, 3 + n, style="line+points", faint=several)
                )
    panels = [Panel("range / H", "", from_zero=True), Panel("rotation ±", "°", from_zero=True)]
    if peak is not None and peak.shape[1]:
        panels.append(Panel("peak tension", force, from_zero=True))
    return Figure(
        key(level, sea.name, "response"),
        f"Motions and peak tensions: {sea.name}",
        (abscissa,),
        tuple(panels),
        tuple(item for item in series if item.panel < len(panels)),
        "Mean ranges over the settled periods; centre of gravity.",
        height=170 + 170 * len(panels),
    )


def sensitivity_blocks(level: CageLevel, sea: Group) -> tuple[Figure | Table, ...]:
    """Return peaks and motions over line stiffness, as figure and table."""
    stiffness = sea.real("varied_stiffness", "varied_stiffness")
    peak = sea.array("line_tension_maximum", "varied_stiffness", "line")
    motion = sea.array("range", "varied_stiffness", "mode")
    if stiffness is None or peak is None or motion is None:
        return ()
    own = float(sea.attributes.get("own_stiffness", np.nan))
    kfactor, kunit = common_scale("N/m", stiffness)
    factor, unit = common_scale("N", peak)
    lines = sea.labels("line")
    x = {"stiffness": kfactor * stiffness}
    series = [Series(name, x, factor * peak[:, n], 0, 3 + n, style="line+points") for n, name in enumerate(lines)]
    worst = int(np.argmax(peak.max(axis=0)))
    reference = int(np.argmin(np.abs(np.log(stiffness / own)))) if np.isfinite(own) else 0
    root = peak[reference, worst] * np.sqrt(stiffness / stiffness[reference])
    series.append(Series("as the root of the stiffness", x, factor * root, 0, 7, dash="dash", faint=True))
    for n, mode in enumerate(("sway", "heave", "rotation")):
        base = motion[reference, n]
        if base > 0.0:
            series.append(Series(mode, x, 100.0 * (motion[:, n] / base - 1.0), 1, n, style="line+points"))
    wave = str(sea.attributes.get("wave", ""))
    figure = Figure(
        key(level, sea.name, "stiffness"),
        f"What line stiffness changes: {sea.name}",
        (Abscissa("stiffness", "stiffness of each line", kunit, log=True),),
        (Panel("peak tension", unit, from_zero=True), Panel("change of the range", "%")),
        tuple(series),
        f"{wave}. The tension at rest is that of the case in every variant. Peaks follow the stiffness of line and "
        f"gauge; the motions are compared with those at {kfactor * stiffness[reference]:.3g} {kunit}.",
        (Mark("this case", x=kfactor * own),) if np.isfinite(own) else (),
        height=480,
    )
    columns = [Column("Stiffness", list(stiffness), "N/m")]
    columns += [Column(f"peak, {name}", list(peak[:, n]), "N") for n, name in enumerate(lines)]
    columns += [
        Column("sway range", list(motion[:, 0]), "m"),
        Column("heave range", list(motion[:, 1]), "m"),
        Column("rotation ±", list(np.degrees(0.5 * motion[:, 2])), "°"),
    ]
    if len(stiffness) > 1:
        growth = np.diff(np.log(peak.max(axis=1))) / np.diff(np.log(stiffness))
        columns.append(Column("exponent of the peak", [float("nan"), *growth]))
    table = Table(
        key(level, sea.name, "stiffness-table"),
        f"Peak tension over line stiffness: {sea.name}",
        tuple(columns),
        note="Exponent: growth of the larger peak from the row above, 0.5 for a body that is stopped by a spring.",
    )
    return figure, table
