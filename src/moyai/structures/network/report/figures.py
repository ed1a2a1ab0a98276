"""Figures of a network: tensions and places over time, exceedance of snaps, energies."""

from __future__ import annotations

import numpy as np

from moyai.core.arrays import Array
from moyai.report.decimate import focus_indices, window_around
from moyai.report.document import Abscissa, Figure, Mark, Panel, Series
from moyai.report.encoding import slug
from moyai.report.reading import Group, common_scale
from moyai.report.realisations import realisations_figure
from moyai.structures.network.report.reading import NetworkLevel, peak_of_run, texts

MOST_LINES, MOST_POINTS, WINDOW_PERIODS, BINS = 6, 4, 12.0, 700


def _window(run: Group, time: Array, moment: float) -> tuple[int, int]:
    period = run.number("period")
    length = WINDOW_PERIODS * period if period > 0.0 else 0.1 * (time[-1] - time[0])
    if time[-1] - time[0] <= 1.5 * length:
        return 0, time.size
    return window_around(time, moment, length)


def tension_figure(level: NetworkLevel, run: Group) -> Figure | None:
    """Return tensions of the most loaded lines and the surface over time."""
    time = run.real("time", "time")
    found = peak_of_run(level, run)
    if time is None or time.size < 3 or found is None:
        return None
    span = _window(run, time, found.time)
    series: list[Series] = []
    records = [(line, run.real("line_tension_peak_since_row", "time", line=line)) for line in run.labels("line")]
    records += [(net, run.real("net_tension", "time", net=net)) for net in run.labels("net")]
    known = [(name, values) for name, values in records if values is not None and np.isfinite(values).any()]
    known.sort(key=lambda item: -float(np.nanmax(item[1])))
    factor, unit = common_scale("N", *(values for _, values in known))
    panels = [Panel("tension", unit, from_zero=True)]
    for tone, (name, values) in enumerate(known[:MOST_LINES]):
        keep = focus_indices(values, span, BINS)
        series.append(Series(name, {"time": time[keep]}, factor * values[keep], 0, tone))
    surface = run.array("surface_elevation", "time")
    if surface is not None:
        keep = focus_indices(surface, span, BINS)
        series.append(Series("surface", {"time": time[keep]}, surface[keep], len(panels), 5, faint=True))
        panels.append(Panel("surface at the origin", "m"))
    shown = None if span == (0, time.size) else (float(time[span[0]]), float(time[span[1] - 1]))
    left_out = f" The {len(known) - MOST_LINES} less loaded lines are left out." if len(known) > MOST_LINES else ""
    return Figure(
        slug(level.name, run.name, "tension"),
        f"Tensions over time: {run.name}",
        (Abscissa("time", "time", "s"),),
        tuple(panels),
        tuple(series),
        f"Highest tension along each line since the row before, so that no peak is lost between rows.{left_out}",
        (Mark("highest", x=found.time, y=factor * found.peak),),
        window=shown,
        slider=shown is not None,
        height=150 + 170 * len(panels),
    )


def places_figure(level: NetworkLevel, run: Group) -> Figure | None:
    """Return where the driven and free points are over time, a panel for each direction in which they move."""
    time = run.real("time", "time")
    if time is None or time.size < 3:
        return None
    found = peak_of_run(level, run)
    span = _window(run, time, found.time if found is not None else float(time[0]))
    kinds = dict(zip(level.network.labels("point"), texts(level.network, "point_kind"), strict=False))
    moving = [name for name in run.labels("point") if kinds.get(name) != "fixed"]
    panels: list[Panel] = []
    series: list[Series] = []
    for column, axis in enumerate("xyz"):
        records = [(name, run.array("point_position", "time", "axis", point=name)) for name in moving[:MOST_POINTS]]
        curves = [(name, values[:, column]) for name, values in records if values is not None]
        largest = max((float(np.nanmax(values) - np.nanmin(values)) for _, values in curves), default=0.0)
        if not largest > 1e-4:
            continue
        for tone, (name, values) in enumerate(curves):
            keep = focus_indices(values, span, BINS)
            series.append(Series(name, {"time": time[keep]}, values[keep], len(panels), tone))
        panels.append(Panel(axis, "m"))
    if not panels:
        return None
    shown = None if span == (0, time.size) else (float(time[span[0]]), float(time[span[1] - 1]))
    left_out = f" The first {MOST_POINTS} of {len(moving)} moving points." if len(moving) > MOST_POINTS else ""
    return Figure(
        slug(level.name, run.name, "places"),
        f"Places of points over time: {run.name}",
        (Abscissa("time", "time", "s"),),
        tuple(panels),
        tuple(series),
        f"Along the axes of the site; directions in which no point moves are left out.{left_out}",
        window=shown,
        slider=shown is not None,
        height=150 + 150 * len(panels),
    )


def bed_figure(level: NetworkLevel) -> Figure | None:
    """Return the lines at rest over a bed that varies, each along its own way in plan; ``None`` on a flat bed."""
    rest, lines = level.part("statics"), np.array(texts(level.network, "bar_line"))
    places, grounds = rest.array("position", "condition", "node", "axis"), rest.real("bed_level", "condition", "node")
    start, end = level.network.array("bar_start", "bar"), level.network.array("bar_end", "bar")
    if places is None or grounds is None or start is None or end is None:
        return None
    place, ground = places[-1], grounds[-1]
    names = list(dict.fromkeys(name for name in lines if name))
    series: list[Series] = []
    for tone, name in enumerate(names[:MOST_LINES]):
        own = np.flatnonzero(lines == name)
        nodes = np.append(start[own], end[own[-1]]).astype(np.int64)
        way = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(place[nodes, :2], axis=0), axis=1))])
        series.append(Series(name, {"way": way}, place[nodes, 2], 0, tone))
        series.append(Series(f"bed under {name}", {"way": way}, ground[nodes], 0, tone, faint=True))
    left_out = f" The first {MOST_LINES} of {len(names)} lines." if len(names) > MOST_LINES else ""
    return Figure(
        slug(level.name, "bed"),
        f"The bed under the lines at rest in {rest.labels('condition')[-1]}",
        (Abscissa("way", "way in plan from the start of the line", "m"),),
        (Panel("height above still water", "m"),),
        tuple(series),
        f"Each line along its own way in plan, its bed pale.{left_out}",
    )


def exceedance_figure(level: NetworkLevel, run: Group) -> Figure | None:
    """Return how many of the snaps of a line reach how high."""
    contacts = run.child("contacts")
    peaks, snap = contacts.real("contact_peak", "contact"), contacts.array("is_snap", "contact")
    names = texts(contacts, "contact_line")
    if peaks is None or snap is None or not names:
        return None
    series: list[Series] = []
    factor, unit = common_scale("N", peaks)
    for tone, name in enumerate(dict.fromkeys(names)):
        own = np.array([entry == name for entry in names]) & snap.astype(bool)
        if own.sum() < 4 or len(series) >= MOST_LINES:
            continue
        values = np.sort(peaks[own])[::-1]
        rank = np.arange(1, values.size + 1) / (values.size + 1.0)
        series.append(Series(name, {"peak": factor * values}, rank, 0, tone, style="line+points"))
    if not series:
        return None
    return Figure(
        slug(level.name, run.name, "exceedance"),
        f"Snaps that reach a load: {run.name}",
        (Abscissa("peak", "peak of the snap", unit),),
        (Panel("part of the snaps", limits=(0.0, 1.0)),),
        tuple(series),
        "Weibull positions r / (n + 1) of all snaps of the run.",
    )


def largest_of_realisations(level: NetworkLevel, run: Group) -> Figure | None:
    """Return the share of the realisations whose highest tension passes a value, with the interval of chance."""
    dynamic = level.part("dynamic")
    tension = dynamic.real("line_tension_maximum_of_realisation", "member", "line", run=run.name)
    return realisations_figure(slug(level.name, run.name, "realisations"), run.name, dynamic.labels("line"), tension)


def energy_figure(level: NetworkLevel, run: Group) -> Figure | None:
    """Return kinetic and elastic energy, the work done, and what was lost."""
    time = run.real("time", "time")
    parts = [run.array(name, "time") for name in ("kinetic_energy", "elastic_energy", "work")]
    if time is None or time.size < 3 or any(part is None for part in parts):
        return None
    kinetic, elastic, work = (np.asarray(part) for part in parts)
    total = kinetic + elastic
    lost = (work - work[0]) - (total - total[0])
    keep = np.unique(np.linspace(0, time.size - 1, min(time.size, 1500)).astype(int))
    curves = (("kinetic", kinetic, 0), ("elastic", elastic, 1))
    return Figure(
        slug(level.name, run.name, "energy"),
        f"Energy: {run.name}",
        (Abscissa("time", "time", "s"),),
        (Panel("energy", "J"), Panel("since the start", "J")),
        (
            *(Series(name, {"time": time[keep]}, values[keep], 0, tone) for name, values, tone in curves),
            Series("work done", {"time": time[keep]}, (work - work[0])[keep], 1, 2),
            Series("dissipated by viscosity, bed and time stepping", {"time": time[keep]}, lost[keep], 1, 3),
        ),
        "Work of weight, water and driven points. The dissipated energy cannot decrease in a correct run.",
        height=420,
    )


def body_figures(level: NetworkLevel, run: Group) -> list[Figure]:
    """Return how the rigid bodies move over time: places and angles."""
    time = run.real("time", "time")
    found = peak_of_run(level, run)
    if time is None or time.size < 3 or not run.labels("solid"):
        return []
    span = _window(run, time, found.time if found is not None else float(time[0]))
    shown = None if span == (0, time.size) else (float(time[span[0]]), float(time[span[1] - 1]))
    figures = []
    for body in run.labels("solid"):
        place = run.array("solid_position", "time", "axis", solid=body)
        angle = run.array("solid_angle", "time", "turn", solid=body)
        if place is None or angle is None:
            continue
        series = []
        for panel, (values, labels, factor) in enumerate(
            ((place - place[0], ("surge", "sway", "heave"), 1.0), (angle, ("roll", "pitch", "yaw"), 180.0 / np.pi))
        ):
            for tone, label in enumerate(labels):
                keep = focus_indices(values[:, tone], span, BINS)
                series.append(Series(label, {"time": time[keep]}, factor * values[keep, tone], panel, tone + 3 * panel))
        figures.append(
            Figure(
                slug(level.name, run.name, body, "motion"),
                f"Motion of {body}: {run.name}",
                (Abscissa("time", "time", "s"),),
                (Panel("from its start", "m"), Panel("angle", "deg")),
                tuple(series),
                "Place of the middle of the body from where the run begins, along axes of the site.",
                window=shown,
                slider=shown is not None,
                height=480,
            )
        )
    return figures
