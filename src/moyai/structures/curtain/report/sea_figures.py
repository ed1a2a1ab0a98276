"""Figures of a curtain in waves: slack and taut cycles, exceedance of snaps, anchor loads."""

from __future__ import annotations

import math

import numpy as np

from moyai.report.decimate import focus_indices, window_around
from moyai.report.document import Abscissa, Figure, Mark, Panel, Series
from moyai.report.formatting import format_quantity
from moyai.report.reading import Group, common_scale
from moyai.structures.curtain.report.reading import CurtainLevel, key

_PERIODS_SHOWN = 6.0
_BINS = 900
_DEGREES = 180.0 / math.pi


def regular_tension(level: CurtainLevel, sea: Group) -> Figure | None:
    """Return tension and excursion of regular waves over the period."""
    period, tension = sea.real("period", "period"), sea.real("both_cables_tension_maximum", "period")
    if period is None or tension is None:
        return None
    found = {
        words: sea.real(name, "period")
        for words, name in (
            ("governing tension", "both_cables_tension_maximum"),
            ("first contacts", "first_contact_tension"),
            ("later contacts", "later_contact_tension"),
            ("closed form of the impact", "closed_form_tension"),
        )
    }
    factor, unit = common_scale("N", *found.values())
    x = {"period": period}
    series = []
    for tone, (words, values) in enumerate(found.items()):
        if values is not None and np.isfinite(values).any():
            style = "line" if words.startswith("closed") else "line+points"
            dash = "dash" if words.startswith("closed") else "solid"
            series.append(Series(words, x, values * factor, tone=tone, style=style, dash=dash))  # type: ignore[arg-type]
    panels = [Panel("tension of both cables", unit, from_zero=True)]
    excursion, threshold = sea.real("water_excursion", "period"), sea.real("threshold_water_excursion", "period")
    if excursion is not None:
        panels.append(Panel("excursion of the water", "m", from_zero=True))
        series.append(Series("excursion 2u/ω", x, excursion, panel=1, tone=4, style="line+points"))
        if threshold is not None:
            series.append(Series("twice the sag: taut without current", x, threshold, panel=1, tone=6, dash="dot"))
    return Figure(
        key(level, sea.name, "wave-tension"),
        "Slack and taut in regular waves",
        (Abscissa("period", "wave period T", "s"),),
        tuple(panels),
        tuple(series),
        "First contacts are those on a side since the other side, later ones bounces.",
        height=200 + 130 * len(panels),
    )


def exceedance(level: CurtainLevel, sea: Group) -> Figure | None:
    """Return the snaps of an irregular sea by their probability of exceedance, with the fitted law."""
    load, share = sea.real("contact_tension_sorted", "snap"), sea.real("exceedance", "snap")
    if load is None or share is None or load.size < 2:
        return None
    factor, unit = common_scale("N", load)
    series = [Series("snaps", {"share": share}, load * factor, tone=0, style="points")]
    fitted = sea.real("fitted_exceedance", "snap")
    if fitted is not None:
        known = np.isfinite(fitted) & (fitted > 0.2 / load.size)
        if known.sum() > 1:
            order = np.argsort(fitted[known])
            series.append(Series("fit", {"share": fitted[known][order]}, (load[known] * factor)[order], tone=1))
    shape, scale, threshold = (sea.value(f"weibull_{name}") for name in ("shape", "scale", "threshold"))
    caption = f"{load.size} snaps."
    probable = sea.value("most_probable_maximum")
    marks = (Mark(f"most probable maximum {format_quantity(probable, 'N')}", y=probable * factor),)
    if math.isfinite(shape):
        caption += (
            f" Fit: three-parameter Weibull law, shape {shape:.3g}, scale {format_quantity(scale, 'N')}, "
            f"threshold {format_quantity(threshold, 'N')}."
        )
    return Figure(
        key(level, sea.name, "exceedance"),
        "Exceedance of the snaps",
        (Abscissa("share", "share of the contacts that is larger", log=True),),
        (Panel("tension of both cables", unit, from_zero=True),),
        tuple(series),
        caption,
        tuple(mark for mark in marks if mark.known),
        height=330,
    )


def run_record(level: CurtainLevel, sea: Group, run: Group) -> Figure | None:
    """Return flow, position and tension about the largest snap of a run."""
    time, tension = run.real("time", "time"), run.real("tension", "time")
    if time is None or tension is None or time.size < 3 or not np.isfinite(tension).any():
        return None
    channels = [
        (words, unit, values)
        for words, unit, name in (
            ("flow", "m/s", "flow_speed"),
            ("mid-span", "m", "position"),
            ("its speed", "m/s", "speed"),
        )
        if (values := run.real(name, "time")) is not None
    ]
    peak = int(np.nanargmax(tension))
    period = _number(run, "period")
    length = _PERIODS_SHOWN * period if period > 0.0 else 0.1 * float(np.ptp(time))
    first, last = window_around(time, float(time[peak]), length)
    stacked = np.column_stack([*(values for _, _, values in channels), tension])
    keep = focus_indices(stacked, (first, last), _BINS)
    x = {"time": time[keep]}
    panels, series = [], []
    for tone, (words, unit, values) in enumerate(channels):
        panels.append(Panel(words, unit))
        series.append(Series(words, x, values[keep], panel=tone, tone=tone))
    factor, unit = common_scale("N", tension)
    panels.append(Panel("tension", unit, from_zero=True))
    series.append(Series("tension", x, tension[keep] * factor, panel=len(panels) - 1, tone=3))
    mark = Mark(
        f"largest {format_quantity(float(tension[peak]), 'N')}",
        x=float(time[peak]),
        y=float(tension[peak]) * factor,
        panel=len(panels) - 1,
    )
    marks = (mark,) if tension[peak] > 0.0 else ()
    return Figure(
        key(level, sea.name, run.name, "record"),
        "Record about the largest snap" if marks else "Record: the cable stays slack",
        (Abscissa("time", "time", "s"),),
        tuple(panels),
        tuple(series),
        "Flow along the normal, mid-span and tension of both cables; complete in the window shown, elsewhere the "
        "extremes of each stretch.",
        marks,
        window=(float(time[first]), float(time[last - 1])),
        slider=True,
        hint="The strip below holds the whole record: drag its frame or edges, double-click for all.",
        height=110 + 92 * len(panels),
    )


def _number(group: Group, name: str) -> float:
    value = group.attributes.get(name)
    return float(value) if isinstance(value, (int, float, np.integer, np.floating)) else math.nan


def anchor_against_height(level: CurtainLevel) -> Figure | None:
    """Return the rope tension over the significant height of every sea state."""
    group = level.part("anchor_loads")
    load = group.real("height_tension", "sea", "height_step")
    height = group.real("height", "sea", "height_step")
    if load is None or height is None:
        return None
    factor, unit = common_scale("N", load)
    series = [
        Series(name, {"height": height[row]}, load[row] * factor, tone=row)
        for row, name in enumerate(group.labels("sea"))
        if np.isfinite(load[row]).any()
    ]
    own, at = group.real("rope_tension_pretensioned", "sea"), group.real("significant_height", "sea")
    if own is not None and at is not None and np.isfinite(own).any():
        series.append(Series("the sea states", {"height": at}, own * factor, tone=6, style="points"))
    return (
        Figure(
            key(level, "anchor-height"),
            "Rope tension by waves against their height",
            (Abscissa("height", "significant wave height", "m"),),
            (Panel("rise above the pretension", unit, from_zero=True),),
            tuple(series),
            "Energy model, above the pretension; period and direction of each sea state kept.",
            height=310,
        )
        if series
        else None
    )


def anchor_against_direction(level: CurtainLevel) -> Figure | None:
    """Return the rope tension over the angle of the waves by each direction rule, of the sea with the largest."""
    group = level.part("anchor_loads")
    load, angle = group.real("angle_tension", "sea", "direction_rule", "angle"), group.real("angle", "angle")
    if load is None or angle is None or not np.isfinite(load).any():
        return None
    row = int(np.nanargmax(np.nanmax(load, axis=(1, 2))))
    factor, unit = common_scale("N", load[row])
    rules = {"paper": "height times cos²", "normal": "height times cos", "none": "no reduction"}
    series = [
        Series(rules.get(rule, rule), {"angle": angle * _DEGREES}, load[row, number] * factor, tone=number)
        for number, rule in enumerate(group.labels("direction_rule"))
    ]
    own = group.real("wave_angle", "sea")
    marks = () if own is None else (Mark("direction of the case", x=abs(float(own[row])) * _DEGREES),)
    return Figure(
        key(level, "anchor-direction"),
        "Rope tension against the direction of the waves",
        (Abscissa("angle", "angle from the normal of the curtain", "deg"),),
        (Panel("rise above the pretension", unit, from_zero=True),),
        tuple(series),
        f"Sea state {group.labels('sea')[row]}.",
        tuple(mark for mark in marks if mark.known),
        height=310,
    )


def anchor_against_velocity(level: CurtainLevel) -> Figure | None:
    """Return the rope tension over the squared velocity: along the height of each sea state, and as they are."""
    group = level.part("anchor_loads")
    load, square = (
        group.real("height_tension", "sea", "height_step"),
        group.real("height_squared_velocity", "sea", "height_step"),
    )
    own, at = group.real("rope_tension_pretensioned", "sea"), group.real("squared_velocity", "sea")
    if (load is None or square is None) and (own is None or at is None or own.size < 2):
        return None
    factor, unit = common_scale("N", load, own)
    series = []
    if load is not None and square is not None:
        series = [
            Series(name, {"square": square[row]}, load[row] * factor, tone=row)
            for row, name in enumerate(group.labels("sea"))
            if np.isfinite(square[row] + load[row]).any()
        ]
    if own is not None and at is not None and np.isfinite(own).any():
        series.append(Series("the sea states", {"square": at}, own * factor, tone=6, style="points"))
    return Figure(
        key(level, "anchor-velocity"),
        "Rope tension against squared velocity",
        (Abscissa("square", "squared velocity over the curtain's depth, at the crest", "m2/s2"),),
        (Panel("rise above the pretension", unit, from_zero=True),),
        tuple(series),
        "Energy model; period and direction of each sea state kept, its height varied.",
        height=310,
    )
