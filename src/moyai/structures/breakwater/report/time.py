"""A time-domain run of a floating breakwater: record around its maximum, statistics, animated side view."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from moyai.core.arrays import Array
from moyai.report.animation import (
    MovingBody,
    MovingLine,
    Surface,
    displaced_line,
    fairlead_motion,
    frame_times,
    side_view,
    tabulated_line,
)
from moyai.report.decimate import focus_indices, mean_crossing_period, window_around
from moyai.report.document import Abscissa, Animation, Block, Column, Figure, Mark, Panel, Series, Table
from moyai.report.drawing import outlines_of, snapshot
from moyai.report.formatting import format_quantity, largest_magnitude
from moyai.report.reading import Group, common_scale
from moyai.report.sketch import with_colours
from moyai.report.waves import travelling_surface
from moyai.structures.breakwater.report.figures import key
from moyai.structures.breakwater.report.lines import in_motion, line_blocks, moving_paths
from moyai.structures.breakwater.report.reading import MODES, BreakwaterLevel, Sea, attribute_number

WINDOW_PERIODS = 12.0
#: Periods before and after the window that the player shows: a storm of hours would fill the page with them.
WAVES_AROUND = 30.0


@dataclass(frozen=True)
class TimeRecord:
    """A run as arrays."""

    run: Group
    #: [s]; shape (samples,).
    time: Array
    #: Sway, heave [m], roll [rad]; shape (samples, 3).
    pose: Array
    #: [N]; no columns where tensions are absent; shape (samples, lines).
    tension: Array
    lines: tuple[str, ...]
    #: Incident wave at x = 0 [m].
    elevation: Array | None
    #: Wave period of the run or mean crossing period [s].
    period: float
    #: First sample that counts in statistics.
    begin: int
    #: Sample of the governing maximum.
    at: int
    #: Line of it, -1 where there are no tensions.
    governing_line: int


def read_record(level: BreakwaterLevel, run: Group) -> TimeRecord | None:
    """Return a run as arrays, ``None`` where it holds no motion."""
    time, pose = run.real("time", "time"), run.real("position", "time", "dof")
    if time is None or pose is None or time.size < 3:
        return None
    names = run.labels("dof")
    if not set(MODES) <= set(names):
        return None
    pose = pose[:, [names.index(mode) for mode in MODES]]
    tension = (
        run.real("line_tension_peak_since_row", "time", "line")
        if in_motion(run)
        else run.real("tension", "time", "line")
    )
    tension = np.zeros((time.size, 0)) if tension is None else tension
    elevation = run.real("surface_elevation", "time")
    good = np.isfinite(pose).all(axis=1)
    if good.sum() < 3:
        return None
    time, pose, tension = time[good], pose[good], tension[good]
    elevation = None if elevation is None else elevation[good]
    period = attribute_number(run, "period")
    if not period > 0.0:
        period = mean_crossing_period(time, pose[:, 0] if elevation is None else elevation)
    begin = _analysis_begin(run, time, period)
    line, at = -1, begin + int(np.argmax(np.abs(pose[begin:, 0])))
    settled = tension[begin:]
    if settled.shape[1] and np.isfinite(settled).any():
        loads = level.group.child("statics").real("breaking_load", "line")
        peaks = np.max(np.where(np.isfinite(settled), settled, -np.inf), axis=0)
        ranked = peaks / loads if loads is not None and loads.size == peaks.size and np.isfinite(loads).all() else peaks
        line = int(np.argmax(ranked))
        at = begin + int(np.nanargmax(settled[:, line]))
    return TimeRecord(
        run, time, pose, tension, run.labels("line") if tension.shape[1] else (), elevation, period, begin, at, line
    )


def _analysis_begin(run: Group, time: Array, period: float) -> int:
    """Return the first sample that counts: as the run gives it, else the last ten periods or what follows the ramp."""
    begin = attribute_number(run, "analysis_start")
    if not math.isfinite(begin):
        begin = attribute_number(run, "ramp")
        if attribute_number(run, "period") > 0.0:
            begin = max(begin if math.isfinite(begin) else -math.inf, float(time[-1]) - 10.0 * period)
    if not begin < time[-1]:  # an interrupted run may end within its ramp
        return 0
    return int(np.searchsorted(time, begin))


def window_of(record: TimeRecord) -> tuple[float, float]:
    """Return start and end [s] of the window about the maximum."""
    length = WINDOW_PERIODS * record.period if record.period > 0.0 else 0.1 * float(np.ptp(record.time))
    first, last = window_around(record.time, float(record.time[record.at]), length)
    return float(record.time[first]), float(record.time[last - 1])


def run_blocks(level: BreakwaterLevel, sea: Sea, record: TimeRecord, animate: bool, bins: int) -> tuple[Block, ...]:
    """Return the blocks of one run: animation, time series, statistics."""
    blocks: list[Block] = []
    if animate:
        scene = animation(level, sea, record)
        if scene is not None:
            blocks.append(scene)
    blocks.append(time_series(level, sea, record, bins))
    blocks.append(statistics(level, sea, record))
    blocks.extend(line_blocks(level, sea, record.run, window_of(record), record.governing_line))
    return tuple(blocks)


def time_series(level: BreakwaterLevel, sea: Sea, record: TimeRecord, bins: int) -> Figure:
    """Return the record: complete in the window about the maximum, its extremes elsewhere."""
    start, end = window_of(record)
    channels: list[tuple[str, str, Array, bool]] = []
    if record.elevation is not None:
        channels.append(("wave", "m", record.elevation, False))
    channels += [(mode, "rad" if mode == "roll" else "m", record.pose[:, n], False) for n, mode in enumerate(MODES)]
    others = [n for n in range(record.tension.shape[1]) if n != record.governing_line]
    order = [*others, record.governing_line] if record.governing_line >= 0 else others
    stacked = np.column_stack([values for _, _, values, _ in channels] + [record.tension])
    first, last = np.searchsorted(record.time, [start, end])
    keep = focus_indices(stacked, (int(first), int(last) + 1), bins)
    x = {"time": record.time[keep]}
    panels, series = [], []
    for tone, (name, unit, values, _) in enumerate(channels):
        factor, shown = common_scale(unit, values)
        panels.append(Panel(name, shown))
        series.append(Series(name, x, values[keep] * factor, tone, 6 if name == "wave" else MODES.index(name)))
    marks = []
    if order:
        factor, shown = common_scale("N", record.tension)
        panels.append(Panel("tension", shown, from_zero=True))
        at = len(panels) - 1
        for number in order:
            series.append(
                Series(
                    record.lines[number],
                    x,
                    record.tension[keep, number] * factor,
                    at,
                    3 + number,
                    faint=number != record.governing_line,
                )
            )
        peak = float(record.tension[record.at, record.governing_line])
        marks.append(
            Mark(f"max {format_quantity(peak, 'N')}", x=float(record.time[record.at]), y=peak * factor, panel=at)
        )
    complete = keep.size == record.time.size
    return Figure(
        key(level, sea.name, record.run.name, "record"),
        "Record of the run",
        (Abscissa("time", "time", "s"),),
        tuple(panels),
        tuple(series),
        "The window about the governing maximum; wave: incident, at x = 0."
        + (
            ""
            if complete
            else f" Outside the window the extremes of {record.time.size} samples are kept; results.nc holds all."
        ),
        tuple(marks),
        window=(start, end),
        slider=True,
        hint="The strip below holds the whole record: drag its frame or edges, double-click for all.",
        height=110 + 92 * len(panels),
    )


def statistics(level: BreakwaterLevel, sea: Sea, record: TimeRecord) -> Table:
    """Return mean, deviation and extremes of each channel, without the start of the run."""
    from_here = slice(record.begin, None)
    time = record.time[from_here]
    channels: list[tuple[str, str, Array]] = []
    if record.elevation is not None:
        channels.append(("wave at x = 0", "m", record.elevation[from_here]))
    for number, mode in enumerate(MODES):
        factor, unit = (180.0 / math.pi, "°") if mode == "roll" else (1.0, "m")
        channels.append((mode, unit, record.pose[from_here, number] * factor))
    if record.tension.shape[1]:
        factor, unit = common_scale("N", record.tension)
        channels += [
            (f"tension {name}", unit, record.tension[from_here, n] * factor) for n, name in enumerate(record.lines)
        ]
    known = [(name, unit, values) for name, unit, values in channels if np.isfinite(values).any()]
    return Table(
        key(level, sea.name, record.run.name, "statistics"),
        "Statistics of the run",
        (
            Column("Channel", [name for name, _, _ in known]),
            Column("Unit", [unit for _, unit, _ in known]),
            Column("Mean", [_mean(values) for _, _, values in known], uniform=False),
            Column("Standard deviation", [float(np.nanstd(values)) for _, _, values in known], uniform=False),
            Column("Minimum", [float(np.nanmin(values)) for _, _, values in known], uniform=False),
            Column("Maximum", [float(np.nanmax(values)) for _, _, values in known], uniform=False),
            Column(
                "Time of maximum", [float(time[int(np.nanargmax(values))]) for _, _, values in known], "s", digits=5
            ),
            Column("Mean up-crossing period", [mean_crossing_period(time, values) for _, _, values in known], "s"),
        ),
        note=f"From t = {time[0]:.4g} s to {time[-1]:.6g} s.",
        emphasised=tuple(
            row
            for row, (name, _, _) in enumerate(known)
            if record.governing_line >= 0 and name == f"tension {record.lines[record.governing_line]}"
        ),
    )


def _mean(values: Array) -> float:
    """Return the mean, zero where only rounding is left of it."""
    mean = float(np.nanmean(values))
    return mean if abs(mean) > 1e-9 * float(np.nanmax(np.abs(values))) else 0.0


def outlines_at_rest(level: BreakwaterLevel) -> tuple[Array, ...]:
    """Return the closed outlines of the hull at rest, shape (n, 2) each."""
    statics = level.group.child("statics")
    x, z = statics.real("outline_x", "outline_point"), statics.real("outline_z", "outline_point")
    if x is None or z is None:
        beam, draught, freeboard = (statics.value(name) for name in ("beam", "draught", "freeboard"))
        if not all(map(math.isfinite, (beam, draught, freeboard))):
            return ()
        half = 0.5 * beam
        return (np.array([[-half, -draught], [half, -draught], [half, freeboard], [-half, freeboard]]),)
    return outlines_of(x, z)


def lines_rest_shapes(level: BreakwaterLevel) -> tuple[tuple[str, Array], ...]:
    """Return name and shape at rest of each line, from the anchor to the fairlead."""
    statics = level.group.child("statics")
    x, z = statics.real("line_x", "line", "line_point"), statics.real("line_z", "line", "line_point")
    names = statics.labels("line")
    ends = [statics.real(name, "line") for name in ("anchor_x", "anchor_z", "fairlead_x", "fairlead_z")]
    shapes = []
    for number, name in enumerate(names):
        if x is not None and z is not None:
            shape = np.stack([x[number], z[number]], axis=1)
            shape = shape[np.isfinite(shape).all(axis=1)]
            if len(shape) > 1:
                shapes.append((name, shape))
                continue
        if all(end is not None for end in ends):
            ax, az, fx, fz = (float(end[number]) for end in ends if end is not None)
            if all(map(math.isfinite, (ax, az, fx, fz))):
                shapes.append((name, np.array([[ax, az], [fx, fz]])))
    return tuple(shapes)


def centre_of_gravity(level: BreakwaterLevel) -> tuple[float, float]:
    """Return x and z of the centre of gravity at rest [m], NaN where not known."""
    statics = level.group.child("statics")
    return statics.value("centre_of_gravity_x"), statics.value("centre_of_gravity_z")


def animation(level: BreakwaterLevel, sea: Sea, record: TimeRecord) -> Animation | None:
    """Return the animated side view of a run, ``None`` where the body's outline is not stored."""
    outlines = outlines_at_rest(level)
    if not outlines:
        return None
    pivot_x, pivot_z = centre_of_gravity(level)
    pivot = (pivot_x if math.isfinite(pivot_x) else 0.0, pivot_z if math.isfinite(pivot_z) else 0.0)
    window, moment = window_of(record), float(record.time[record.at])
    times = frame_times(record.time, window, record.period, (moment,), around=WAVES_AROUND)
    pose = np.column_stack([np.interp(times, record.time, record.pose[:, n]) for n in range(3)])
    bed = -level.depth if math.isfinite(level.depth) else None
    lines = _moving_lines(level, record, times, pose, pivot, bed)
    moving = moving_paths(record.run, record.lines, times)
    lines = tuple(replace(line, path=moving[line.name]) if line.name in moving else line for line in lines)
    extents = _extents(outlines, lines, record, bed)
    surface = _surface(level, record, times, extents)
    scene = side_view(
        times,
        bodies=(MovingBody("body", outlines, pivot, pose),),
        lines=lines,
        surface=surface,
        bed=bed,
        extents=extents,
        window=window,
        maximum=moment,
        period=record.period,
    )
    frame = int(np.argmin(np.abs(times - moment)))
    still = snapshot(
        extents[next(iter(extents))],
        bed=bed,
        surface=None if surface is None else (surface.x, surface.elevation[frame]),
        outlines=outlines,
        pivot=pivot,
        pose=pose[frame],
        lines=[line.path[frame] for line in lines],
        title=f"Side view at t = {moment:.2f} s",
    )
    caption = (
        f"To scale; opened at the governing maximum, t = {moment:.2f} s. The cross is the centre of gravity at rest."
    )
    if times[0] > record.time[0] or times[-1] < record.time[-1]:
        caption += f" Shown from {times[0]:.0f} s to {times[-1]:.0f} s."
    if moving:
        caption += " Lines: in motion, as their nodes were."
    elif lines and level.group.child("statics").variable("line_shape_x") is None:
        caption += " Lines: their shape at rest, led along with the fairlead."
    if surface is not None:
        reflection = level.group.child("rao").array("reflection_coefficient", "omega")
        phased = reflection is not None and np.iscomplexobj(reflection)
        caption += (
            f" Water: far-field waves of linear theory, incident{' and reflected' if phased else ''} before the body, "
        )
        caption += "transmitted behind it."
    return Animation(
        key(level, sea.name, record.run.name, "animation"),
        "Animated side view",
        scene,
        caption,
        picture=with_colours(still),
    )


def _moving_lines(
    level: BreakwaterLevel, record: TimeRecord, times: Array, pose: Array, pivot: tuple[float, float], bed: float | None
) -> tuple[MovingLine, ...]:
    statics = level.group.child("statics")
    loads = statics.real("breaking_load", "line")
    names = statics.labels("line")
    known = dict(zip(names, loads, strict=True)) if loads is not None else {}
    lines = []
    for name, rest in lines_rest_shapes(level):
        arm = (float(rest[-1, 0]) - pivot[0], float(rest[-1, 1]) - pivot[1])
        shift, table = fairlead_motion(pose, arm), _shape_table(statics, name)
        path = displaced_line(rest, shift, bed) if table is None else tabulated_line(*table, shift)
        tension, maximum = np.full(times.size, np.nan), math.nan
        if name in record.lines:
            values = record.tension[:, record.lines.index(name)]
            if np.isfinite(values).any():
                tension, maximum = np.interp(times, record.time, values), float(np.fmax.reduce(values[record.begin :]))
        lines.append(MovingLine(name, path, tension, maximum, float(known.get(name, math.nan))))
    return tuple(lines)


def _shape_table(statics: Group, name: str) -> tuple[Array, Array, Array] | None:
    """Return the stored shapes of a moving line over the displacement of its fairlead, ``None`` where absent."""
    shift_x, shift_z = statics.real("shift_x", "shift_x"), statics.real("shift_z", "shift_z")
    x = statics.real("line_shape_x", "shift_x", "shift_z", "line_point", line=name)
    z = statics.real("line_shape_z", "shift_x", "shift_z", "line_point", line=name)
    if shift_x is None or shift_z is None or x is None or z is None or not np.isfinite(x + z).all():
        return None
    return shift_x, shift_z, np.stack([x, z], axis=-1)


def _extents(
    outlines: tuple[Array, ...], lines: tuple[MovingLine, ...], record: TimeRecord, bed: float | None
) -> dict[str, tuple[float, float, float, float]]:
    """Return the near view of the body and the whole view with the anchors."""
    hull = np.concatenate(outlines)
    width, height = float(np.ptp(hull[:, 0])), float(np.ptp(hull[:, 1]))
    wave = 0.0 if record.elevation is None else largest_magnitude(record.elevation)
    reach = float(np.max(np.abs(record.pose[:, 0])))
    low, high = float(hull[:, 1].min()), float(hull[:, 1].max())
    top = max(high, 0.0) + max(1.2 * wave, 0.25 * height)
    bottom = low - max(0.6 * width, 1.5 * height) if bed is None else bed - 0.04 * abs(bed)
    near_low = max(bottom, low - 1.6 * max(height, 0.5 * width))
    near = (float(hull[:, 0].min()) - 1.1 * width - reach, float(hull[:, 0].max()) + 1.1 * width + reach, near_low, top)
    if not lines:
        return {"Body": near}
    points = np.concatenate([line.path[0] for line in lines])
    left, right = min(float(points[:, 0].min()), near[0]), max(float(points[:, 0].max()), near[1])
    pad = 0.04 * (right - left)
    deepest = min(bottom, float(points[:, 1].min()))
    return {"Whole mooring": (left - pad, right + pad, deepest, top), "Body": near}


def _surface(
    level: BreakwaterLevel, record: TimeRecord, times: Array, extents: dict[str, tuple[float, float, float, float]]
) -> Surface | None:
    if record.elevation is None or not record.period > 0.0:
        return None
    left, right = min(b[0] for b in extents.values()), max(b[1] for b in extents.values())
    x = np.linspace(left, right, 141)
    rao = level.group.child("rao")
    omega, wavelength = rao.real("omega", "omega"), rao.real("wavelength", "omega")
    if omega is None or wavelength is None:
        return None
    elevation = travelling_surface(
        record.time,
        record.elevation,
        x,
        times,
        omega=omega,
        wave_number=2.0 * np.pi / wavelength,
        reflection=rao.array("reflection_coefficient", "omega"),
        transmission=rao.array("transmission_coefficient", "omega"),
    )
    return Surface(x, elevation)
