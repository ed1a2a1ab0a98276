"""Figures of a flexible cage: volume and drag over the current, stress around the collar, tensions over time."""

from __future__ import annotations

import math
from typing import Literal

import numpy as np

from moyai.report.document import Abscissa, Figure, Mark, Panel, Series
from moyai.report.reading import Group, common_scale
from moyai.structures.cage.report.rigid_reading import CageLevel, key


def design_mark(level: CageLevel, panel: int = 0) -> tuple[Mark, ...]:
    """Return the mark of the current of the site, the design point of a sweep of currents."""
    speed = float(level.group.attributes.get("current", 0.0))
    return (Mark("current of the site", x=speed, panel=panel),) if speed > 0.0 else ()


def design_row(level: CageLevel, speed: np.ndarray) -> int:
    """Return the row of the current of the site in a sweep."""
    return int(np.argmin(np.abs(speed - float(level.group.attributes.get("current", 0.0)))))


def volume_figure(level: CageLevel) -> Figure | None:
    """Return the remaining volume and the lift of the bottom over the current."""
    statics = level.part("statics")
    speed = statics.real("current_speed", "current")
    share, lift = statics.array("volume_share", "current", "cage"), statics.array("bottom_lift", "current", "cage")
    if speed is None or share is None or lift is None or len(speed) < 2:
        return None
    x = {"speed": speed}
    factor, unit = common_scale("m", lift)
    cages = statics.labels("cage")
    series = []
    for k, name in enumerate(cages):
        said = name if len(cages) > 1 else "volume"
        series.append(Series(said, x, 100.0 * share[:, k], 0, k, style="line+points"))
        series.append(
            Series(f"bottom{', ' + name if len(cages) > 1 else ''}", x, factor * lift[:, k], 1, k, style="line+points")
        )
    return Figure(
        key(level, "volume"),
        "Remaining volume against current",
        (Abscissa("speed", "current at the surface", "m/s"),),
        (Panel("remaining volume", "%", from_zero=True), Panel("lift of the deepest knot", unit)),
        tuple(series),
        "Volume inside the net over that as built; the lift is counted from still water. The summary holds the numbers "
        "at the current of the site.",
        marks=design_mark(level),
        height=430,
    )


def drag_figure(level: CageLevel) -> Figure | None:
    """Return the drag split over the current, and what it would be if it grew as the square of the speed."""
    statics = level.part("statics")
    speed, total = statics.real("current_speed", "current"), statics.array("total_drag", "current")
    split = statics.array("drag_along", "current", "part")
    if speed is None or total is None or split is None or (speed > 0.0).sum() < 2:
        return None
    factor, unit = common_scale("N", total)
    x = {"speed": speed}
    series = [Series("all parts", x, factor * total, 0, 0, style="line+points")]
    for k, name in enumerate(statics.labels("part")):
        if np.abs(split[:, k]).max() > 0.002 * np.abs(total).max():
            # the palette ends after the sum and six parts
            dash: Literal["solid", "dot"] = "dot" if k >= 6 else "solid"
            series.append(Series(name, x, factor * split[:, k], 0, k + 1, style="line+points", dash=dash))
    first = int(np.argmax(speed > 0.0))
    square = total[first] * (speed / speed[first]) ** 2
    series.append(Series("growing as the square", x, factor * square, 0, 0, dash="dash", faint=True))
    moving = speed > 0.0
    area = total[moving] / speed[moving] ** 2
    series.append(
        Series("drag over speed squared", {"speed": speed[moving]}, area / area[0], 1, 0, style="line+points")
    )
    return Figure(
        key(level, "drag"),
        "Drag and its split",
        (Abscissa("speed", "current at the surface", "m/s"),),
        (Panel("drag along the current", unit, from_zero=True), Panel("over U², first = 1", "", from_zero=True)),
        tuple(series),
        "Drag grows more slowly than the square of the speed where the net deforms.",
        marks=design_mark(level),
        height=480,
    )


def collar_figure(level: CageLevel) -> Figure | None:
    """Return stress, bending and axial force around the collar's ring in the current of the site."""
    statics = level.part("statics")
    stress = statics.array("collar_stress", "current", "cage", "ring", "around")
    parts = [
        statics.array(f"collar_{name}", "current", "cage", "ring", "around")
        for name in ("in_plane", "out_of_plane", "axial")
    ]
    speed = statics.real("current_speed", "current")
    if stress is None or speed is None or any(part is None for part in parts):
        return None
    row = design_row(level, speed)
    cage = int(np.unravel_index(int(np.argmax(stress[row])), stress[row].shape)[0])
    around = np.arange(stress.shape[3] + 1) * 360.0 / stress.shape[3]
    x = {"angle": around}

    def closed(values: np.ndarray) -> np.ndarray:
        return np.append(values, values[0])

    inside, out, axial = (np.asarray(part) for part in parts)
    series, names = [], ("inner ring", "outer ring") if stress.shape[2] == 2 else ("collar",)
    m_factor, m_unit = common_scale("N m", np.concatenate([inside[row, cage], out[row, cage]]))
    a_factor, a_unit = common_scale("N", axial[row, cage])
    s_factor, s_unit = common_scale("Pa", stress[row, cage])
    for ring, name in enumerate(names):
        series += [
            Series(name, x, s_factor * closed(stress[row, cage, ring]), 0, ring),
            Series(f"in plane, {name}", x, m_factor * closed(inside[row, cage, ring]), 1, ring),
            Series(f"out of plane, {name}", x, m_factor * closed(out[row, cage, ring]), 1, ring, dash="dash"),
            Series(f"axial, {name}", x, a_factor * closed(axial[row, cage, ring]), 2, ring),
        ]
    return Figure(
        key(level, "collar"),
        f"Around the collar of {statics.labels('cage')[cage]} at {speed[row]:.3g} m/s",
        (Abscissa("angle", "angle around the collar, from +x (square: from its first corner)", "°"),),
        (Panel("von Mises stress", s_unit, from_zero=True), Panel("bending moment", m_unit), Panel("axial", a_unit)),
        tuple(series),
        "Stress of the outermost fibre: axial, bending in and out of the plane, torsion.",
        height=560,
    )


def run_figures(level: CageLevel, sea: str, run: Group) -> list[Figure]:
    """Return tensions and volume over time of one run, and the spread of its drag."""
    time = run.real("time", "time")
    pull, volume = run.array("line_tension", "time", "line"), run.array("volume_share", "time", "cage")
    surface, stress = run.array("wave_elevation", "time"), run.array("collar_stress_largest", "time", "cage")
    if time is None or volume is None:
        return []
    period = float(run.attributes.get("period", math.nan))
    window = (float(time[-1]) - 6.0 * period, float(time[-1])) if time[-1] > 6.0 * period else None
    x = {"time": time}
    panels: list[Panel] = []
    series: list[Series] = []
    if surface is not None:
        factor, unit = common_scale("m", surface)
        series.append(Series("surface", x, factor * surface, len(panels), 0))
        panels.append(Panel("wave", unit))
    if pull is not None and pull.shape[1]:
        factor, unit = common_scale("N", pull)
        lines, maximum = run.labels("line"), run.real("line_tension_maximum", "line")
        order = np.argsort(-(maximum if maximum is not None else pull.max(axis=0)))[:5]
        for tone, k in enumerate(order):
            series.append(Series(lines[int(k)], x, factor * pull[:, int(k)], len(panels), tone + 1))
        panels.append(Panel("tension, upper end", unit))
    for k, name in enumerate(run.labels("cage")):
        series.append(Series(f"volume, {name}", x, 100.0 * volume[:, k], len(panels), k))
    panels.append(Panel("volume", "%"))
    marks = [Mark("waves fully grown", x=float(run.attributes.get("ramp", 0.0)), panel=0)]
    if stress is not None:
        factor, unit = common_scale("Pa", stress)
        for k, name in enumerate(run.labels("cage")):
            series.append(Series(f"stress, {name}", x, factor * stress[:, k], len(panels), k))
        panels.append(Panel("collar stress", unit))
    figure = Figure(
        key(level, sea, run.name, "time"),
        f"Over time: {run.attributes.get('wave', run.name)}",
        (Abscissa("time", "time", "s"),),
        tuple(panels),
        tuple(series),
        "The five lines of the highest tensions.",
        tuple(marks),
        window=window,
        slider=True,
        height=150 + 150 * len(panels),
    )
    return [figure]
