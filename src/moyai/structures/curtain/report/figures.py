"""Figures of the report of a curtain at rest and in the impact: utilisation, load laws, models, records."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from moyai.core.arrays import Array
from moyai.report.decimate import envelope_indices
from moyai.report.document import Abscissa, Figure, Mark, Panel, Series
from moyai.report.formatting import format_quantity, largest_magnitude
from moyai.report.reading import Group, common_scale
from moyai.structures.curtain.report.reading import CurtainLevel, components, curve, key

_BINS = 700  # stretches of a long record whose extremes are drawn
_SHARES = (("steady", "steady load", 0), ("wave", "added by waves", 2), ("impact", "added by the impact", 1),
           ("dynamic", "whole span through time", 4))  # fmt: skip


def _thinned(values: Array) -> NDArray[np.int64]:
    return envelope_indices(values, _BINS)


def utilisation_bars(level: CurtainLevel) -> Figure | None:
    """Return the utilisation of each component and the parts that steady load, waves and impact have in it."""
    judged = [entry for entry in components(level) if math.isfinite(entry.utilisation)]
    if not judged:
        return None
    names = tuple(entry.name for entry in judged)
    series = [Series("governing", {}, np.array([entry.utilisation for entry in judged]), tone=3, style="bar")]
    for part, words, tone in _SHARES:
        values = np.array([entry.share(part) for entry in judged])
        if np.isfinite(values).any():
            series.append(Series(words, {}, values, tone=tone, style="bar", faint=True))
    return Figure(
        key(level, "utilisation"),
        "Utilisation of each component",
        (Abscissa("component", "component"),),
        (Panel("load times safety factor over capacity", from_zero=True),),
        tuple(series),
        "Governing: the steady load with the larger of what waves or impact add, or the tension of the whole span. "
        "Components without a strength in the case are left out.",
        (Mark("limit", y=1.0),),
        categories=names,
        height=330,
    )


def section_laws(level: CurtainLevel) -> Figure | None:
    """Return the section by each load law."""
    return _laws(
        level,
        ("section", "section_law", "law_section_x", "law_section_z"),
        "Section by each load law",
        (Abscissa("x", "downstream of the float", "m"), Panel("height", "m")),
    )


def plan_laws(level: CurtainLevel) -> Figure | None:
    """Return the plan by each load law."""
    return _laws(
        level,
        ("plan", "plan_law", "law_plan_y", "law_plan_x"),
        "Plan by each load law",
        (Abscissa("y", "along the span", "m"), Panel("downstream of the supports", "m")),
    )


def _laws(
    level: CurtainLevel, names: tuple[str, str, str, str], title: str, axes: tuple[Abscissa, Panel]
) -> Figure | None:
    group = level.part("statics_laws")
    which, dim, x, y = names
    dashes = ("solid", "dash", "dashdot", "dot")
    series = []
    for tone, law in enumerate(group.labels(dim)):
        points = curve(group, x, y, "law_point", **{dim: law})
        if points is not None:
            series.append(
                Series(law, {axes[0].key: points[:, 0]}, points[:, 1], tone=tone, dash=dashes[tone % 4])  # type: ignore[arg-type]
            )
    if not series:
        return None
    pressure, load = group.value("pressure"), group.value("line_load")
    parts = [
        text
        for value, text in (
            (pressure, f"pressure {format_quantity(pressure, 'Pa')}"),
            (load, f"line load {format_quantity(load, 'N/m')}"),
        )
        if math.isfinite(value)
    ]
    return Figure(
        key(level, "laws", which),
        title,
        (axes[0],),
        (axes[1],),
        tuple(series),
        "All laws share " + " and ".join(parts) + "; their spread is the uncertainty of the choice of the law."
        if parts
        else "Axes are not to one scale.",
        height=330,
    )


def impact_bars(level: CurtainLevel) -> Figure | None:
    """Return the tension of each impact model side by side."""
    group = level.part("impact")
    names, values = group.labels("impact_model"), group.real("both_cables_impact_tension", "impact_model")
    if not names or values is None:
        return None
    factor, unit = common_scale("N", values)
    counts = group.real("counts", "impact_model")
    counted = np.ones(len(names), bool) if counts is None else counts > 0.0
    series = [Series("counts", {}, np.where(counted, values, np.nan) * factor, tone=0, style="bar")]
    if not counted.all():
        apart = np.where(counted, np.nan, values) * factor
        series.append(Series("does not count", {}, apart, tone=6, style="bar", faint=True))
    marks = [Mark("design", y=group.value("design_tension") * factor)]
    plateau = group.value("both_cables_plateau_tension")
    marks.append(Mark("plateau by drag", y=plateau * factor))
    return Figure(
        key(level, "impact-models"),
        "Tension of both cables by each impact model",
        (Abscissa("model", "model"),),
        (Panel("largest tension", unit, from_zero=True),),
        tuple(series),
        "Impact alone, without the drag that follows.",
        tuple(mark for mark in marks if mark.known),
        categories=names,
        height=330,
    )


def impact_series(level: CurtainLevel) -> Figure | None:
    """Return the spike over time of the models that are marched."""
    group = level.part("impact")
    runs = [
        (child, time, tension)
        for child in group.children()
        if child.name != "snap"
        and (time := child.real("time", "time")) is not None
        and (tension := child.real("tension", "time")) is not None
    ]
    if not runs:
        return None
    factor, unit = common_scale("N", *(tension for _, _, tension in runs))
    parts: dict[str, Array] = {}
    series = []
    labels = {"A": "model A, marched", "A2": "model A2, sum", "memory": "with the memory of waves"}
    for tone, (child, time, tension) in enumerate(runs):
        keep = _thinned(tension)
        x = {"time": 1e3 * time[keep]}
        series.append(Series(labels.get(child.name, child.name), x, tension[keep] * factor, tone=tone))
        for which, dash in (("upper", "dash"), ("lower", "dot")):
            values = child.real(f"{which}_tension", "time")
            if values is not None:
                label = f"{labels.get(child.name, child.name).split(',')[0]}, {which} cable"
                series.append(Series(label, x, values[keep] * factor, tone=tone, dash=dash, faint=True))  # type: ignore[arg-type]
        moved = child.real("displacement", "time")
        if moved is not None:
            parts[child.name] = moved
            series.append(
                Series(labels.get(child.name, child.name), x, moved[keep] * 1e3, panel=1, tone=tone, faint=True)
            )
    panels = [Panel("tension", unit, from_zero=True)]
    if parts:
        panels.append(Panel("displacement of mid-span", "mm"))
    return Figure(
        key(level, "impact-series"),
        "Spike of the tension",
        (Abscissa("time", "time from the taut instant", "ms"),),
        tuple(panels),
        tuple(series),
        "Without drag; from the just-taut shape.",
        height=200 + 150 * len(panels),
    )


def march_errors(level: CurtainLevel) -> Figure | None:
    """Return the error of the paper's marching scheme against the steps to the peak."""
    group = level.part("impact")
    steps, error = group.real("steps_to_peak", "march_step"), group.real("march_error", "march_step")
    if steps is None or error is None:
        return None
    x = {"steps": steps}
    series = [Series("error of the peak", x, 100.0 * error, tone=0, style="line+points")]
    predicted = group.real("march_predicted_error", "march_step")
    if predicted is not None:
        series.append(Series("first order, π/8 ω dt", x, 100.0 * predicted, tone=1, dash="dash"))
    caption = "Against the energy form. The scheme comes from below: coarse steps under-predict."
    for name, words in (("forward", "as printed"), ("reverse", "from displacement to load")):
        met = group.real(f"{name}_iteration_converges", "march_step")
        if met is not None:
            good = [f"{step:g}" for step, ok in zip(steps, met, strict=True) if ok > 0.0]
            caption += f" Iteration {words} converges at {', '.join(good) + ' steps' if good else 'none of the steps'}."
    return Figure(
        key(level, "march-error"),
        "Error of marching in time",
        (Abscissa("steps", "steps from taut to peak", log=True),),
        (Panel("error of the peak tension", "%"),),
        tuple(series),
        caption,
        height=280,
    )


def snap_record(level: CurtainLevel) -> Figure | None:
    """Return the record of a released curtain: slack, spike, plateau."""
    snap = level.part("impact").child("snap")
    time, tension = snap.real("time", "time"), snap.real("tension", "time")
    if time is None or tension is None or time.size < 3:
        return None
    position, speed = snap.real("position", "time"), snap.real("speed", "time")
    keep = _thinned(np.column_stack([tension, tension if position is None else position]))
    factor, unit = common_scale("N", tension)
    x = {"time": time[keep]}
    panels, series = (
        [Panel("tension", unit, from_zero=True)],
        [Series("tension", x, tension[keep] * factor, tone=1)],
    )
    for values, words, shown, tone in ((position, "mid-span", "m", 0), (speed, "speed", "m/s", 2)):
        if values is not None:
            panels.append(Panel(words, shown))
            series.append(Series(words, x, values[keep], panel=len(panels) - 1, tone=tone))
    peak = int(np.nanargmax(tension))
    marks = [
        Mark(
            f"spike {format_quantity(float(tension[peak]), 'N')}", x=float(time[peak]), y=float(tension[peak]) * factor
        ),
        Mark("taut", x=snap.number("taut_time")),
    ]
    plateau = level.part("impact").value("both_cables_plateau_tension")
    if math.isfinite(plateau):
        marks.append(Mark(f"plateau {format_quantity(plateau, 'N')}", y=plateau * factor))
    return Figure(
        key(level, "snap-record"),
        "Release in the current",
        (Abscissa("time", "time from release", "s"),),
        tuple(panels),
        tuple(series),
        "Tension of both cables, mid-span downstream of the supports and its speed. Let go at 0, with drag, until "
        "its level is reached.",
        tuple(mark for mark in marks if mark.known),
        window=_about(time, float(time[peak]), snap.number("taut_time")),
        slider=True,
        hint="The strip below holds the whole record: drag its frame or edges, double-click for all.",
        height=120 + 110 * len(panels),
    )


def _about(time: Array, peak: float, taut: float) -> tuple[float, float]:
    """Return the part of a record shown at first: the slack phase and as much again behind the spike."""
    taut = taut if math.isfinite(taut) else peak
    first, last = float(time[0]), float(time[-1])
    after = max(0.35 * (taut - first), 8.0 * (peak - taut))
    return max(first, taut - 0.35 * (taut - first)), min(last, peak + after)


def record_over_models(level: CurtainLevel, root: Group) -> Figure | None:
    """Return the flume record about its taut instant with every model laid over it."""
    group, record = level.part("impact"), root.child("record")
    time, tension = record.real("time", "time"), record.real("record_tension", "cable", "time")
    taut, peak_time = record.value("taut_time"), record.value("peak_time")
    names, peaks, rises = (
        group.labels("impact_model"),
        group.real("both_cables_impact_tension", "impact_model"),
        group.real("impact_time", "impact_model"),
    )
    if time is None or tension is None or peaks is None or not math.isfinite(taut):
        return None
    total = tension.sum(axis=0)
    rise = peak_time - taut if peak_time > taut else 0.02 * float(np.ptp(time))
    shown = (time > taut - 0.6 * rise) & (time < taut + 6.0 * rise)
    counts = group.real("counts", "impact_model")
    factor, unit = common_scale("N", total[shown], peaks if counts is None else peaks[counts > 0.0])
    keep = np.flatnonzero(shown)[_thinned(total[shown])]
    series = [Series("record, both cables", {"time": 1e3 * (time[keep] - taut)}, total[keep] * factor, tone=6)]
    labels = {"A": "model A, marched", "A2": "model A2, sum", "memory": "with the memory of waves"}
    for tone, name in enumerate(labels):
        run = group.child(name)
        x, y = run.real("time", "time"), run.real("tension", "time")
        if x is not None and y is not None:
            thin = _thinned(y)
            series.append(Series(labels[name], {"time": 1e3 * x[thin]}, y[thin] * factor, tone=tone))
    snap = group.child("snap")
    x, y, start = snap.real("time", "time"), snap.real("tension", "time"), snap.number("taut_time")
    if x is not None and y is not None and math.isfinite(start):
        part = (x >= start) & (x < start + 6.0 * rise)
        if part.sum() > 2:
            series.append(Series("with drag", {"time": 1e3 * (x[part] - start)}, y[part] * factor, tone=3, dash="dash"))
    if rises is not None:
        for number, name in enumerate(names):
            known = np.isfinite(rises[number]) and (counts is None or counts[number] > 0.0)
            if known and name not in ("A", "A marched", "A2"):
                at = np.array([rises[number]])
                series.append(
                    Series(f"peak of {name}", {"time": 1e3 * at}, peaks[[number]] * factor, tone=number, style="points")
                )
    return Figure(
        key(level, "record-models"),
        "Models over the flume record",
        (Abscissa("time", "time from the taut instant", "ms"),),
        (Panel("tension of both cables", unit, from_zero=True),),
        tuple(series),
        "Models start at the taut instant of the record and include no drag, except where it is named; nothing is "
        "fitted. "
        "Models that do not count are left out.",
        (Mark("plateau of the record", y=record.value("both_cables_plateau_tension") * factor),),
        height=360,
    )


def flume_record(root: Group) -> Figure | None:
    """Return the record of a flume that was given with the case, with the readings of each cable."""
    group = root.child("record")
    time, tension = group.real("time", "time"), group.real("record_tension", "cable", "time")
    if time is None or tension is None:
        return None
    factor, unit = common_scale("N", tension)
    series = []
    for tone, name in enumerate(group.labels("cable")):
        if np.isfinite(tension[tone]).any():
            keep = _thinned(tension[tone])
            series.append(Series(name, {"time": time[keep]}, tension[tone, keep] * factor, tone=tone))
    total = tension.sum(axis=0)
    if tension.shape[0] > 1 and np.isfinite(total).any():
        keep = _thinned(total)
        series.append(Series("sum", {"time": time[keep]}, total[keep] * factor, tone=6))
    marks = [
        Mark(words, x=group.value(name))
        for name, words in (("release_time", "release"), ("taut_time", "taut"), ("plateau_start", "plateau"))
    ]
    marks.append(Mark("plateau of the sum", y=group.value("both_cables_plateau_tension") * factor))
    if not series:
        return None
    return Figure(
        "flume-record",
        "Record of the flume",
        (Abscissa("time", "time", "s"),),
        (Panel("tension", unit, from_zero=largest_magnitude(tension) > 0.0),),
        tuple(series),
        "Offset and drift removed. Impact is the peak less the plateau.",
        tuple(mark for mark in marks if mark.known),
        slider=True,
        height=330,
    )
