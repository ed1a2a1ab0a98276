"""A run of a rigid cage over time: animated section, motions and tensions of both lines."""

from __future__ import annotations

import math

import numpy as np

from moyai.core.arrays import Array
from moyai.report.animation import MovingBody, MovingLine, Surface, fairlead_motion, frame_times, side_view
from moyai.report.decimate import focus_indices
from moyai.report.document import Abscissa, Animation, Block, Figure, Mark, Panel, Series
from moyai.report.drawing import snapshot
from moyai.report.formatting import format_quantity
from moyai.report.reading import common_scale
from moyai.report.sketch import with_colours
from moyai.report.waves import travelling_surface
from moyai.structures.cage.report.rigid_drawing import circle, net_lines
from moyai.structures.cage.report.rigid_reading import CageLevel, CageSection, RigidRecord, key, line_path, section_of


def run_blocks(level: CageLevel, sea: str, record: RigidRecord, animate: bool, bins: int) -> tuple[Block, ...]:
    """Return the blocks of one run."""
    blocks: list[Block] = []
    if animate:
        scene = animation(level, sea, record)
        if scene is not None:
            blocks.append(scene)
    blocks.append(history(level, sea, record, bins))
    return tuple(blocks)


def history(level: CageLevel, sea: str, record: RigidRecord, bins: int) -> Figure:
    """Return wave, motions and tensions; complete in the window, their extremes elsewhere."""
    first, last = np.searchsorted(record.time, record.window)
    flat = record.tension.reshape(record.time.size, -1)
    stacked = np.column_stack([record.elevation, record.pose, flat])
    keep = focus_indices(stacked, (int(first), min(int(last) + 1, record.time.size)), bins)
    x = {"time": record.time[keep]}
    panels: list[Panel] = []
    series: list[Series] = []
    factor, unit = common_scale("m", record.elevation, record.pose[:, 0], record.pose[:, 1])
    panels.append(Panel("wave, sway, heave", unit))
    series.append(Series("wave at x = 0", x, factor * record.elevation[keep], 0, 6, faint=True))
    for n, name in enumerate(("sway", "heave")):
        series.append(Series(name, x, factor * record.pose[keep, n], 0, n))
    panels.append(Panel("rotation", "°"))
    series.append(Series("rotation", x, np.degrees(record.pose[keep, 2]), 1, 2))
    marks: list[Mark] = []
    if record.lines:
        force, name_of = common_scale("N", record.peak)
        parted = not np.allclose(record.tension[:, :, 0], record.tension[:, :, 1])
        # one diagram for each line, as tensions of different size hide each other
        for n, line in enumerate(record.lines):
            panels.append(Panel(line, name_of, from_zero=True))
            at = len(panels) - 1
            series.append(Series(f"{line}, at the cage", x, force * record.tension[keep, n, 0], at, 3 + n))
            if parted:
                label = f"{line}, at the anchor"
                series.append(Series(label, x, force * record.tension[keep, n, 1], at, 3 + n, dash="dot", faint=True))
        worst = int(np.argmax(record.peak[record.at])) if record.peak.shape[1] else 0
        peak = float(record.peak[record.at, worst])
        if peak > 0.0:
            words = f"peak {format_quantity(peak, 'N')}"
            marks.append(Mark(words, x=float(record.time[record.at]), y=force * peak, panel=2 + worst))
    complete = keep.size == record.time.size
    return Figure(
        key(level, sea, record.run.name, "history"),
        f"Motion and tensions: {record.label}",
        (Abscissa("time", "time", "s"),),
        tuple(panels),
        tuple(series),
        "Centre of gravity from rest; rotation positive with the top towards +x."
        + (
            ""
            if complete
            else f" Outside the window the extremes of {record.time.size} rows are kept; results.nc holds all."
        ),
        tuple(marks),
        window=record.window,
        slider=True,
        hint="The strip below holds the whole record: drag its frame or edges, double-click for all.",
        height=130 + 120 * len(panels),
    )


def animation(level: CageLevel, sea: str, record: RigidRecord) -> Animation | None:
    """Return the animated section with water and lines."""
    section = section_of(level)
    if section is None:
        return None
    moment = float(record.time[record.at])
    window = record.window
    if not window[0] <= moment <= window[1]:
        # the peak of a steady motion recurs; show the one within the window
        part = record.shown
        values = record.peak[part].max(axis=1) if record.peak.shape[1] else np.abs(record.pose[part, 2])
        moment = float(record.time[part][int(np.argmax(values))])
    times = frame_times(record.time, window, record.period, (moment,), budget=1500)
    pose = np.column_stack([np.interp(times, record.time, record.pose[:, n]) for n in range(3)])
    bed = -level.depth if math.isfinite(level.depth) else None
    lines = _lines(record, section, times, pose)
    extents = _extents(section, record, bed)
    surface = _surface(level, record, times, extents)
    outlines = _outlines(section)
    scene = side_view(
        times,
        bodies=(MovingBody("cage", outlines, section.centre, pose),),
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
        next(iter(extents.values())),
        bed=bed,
        surface=(surface.x, surface.elevation[frame]),
        outlines=outlines,
        pivot=section.centre,
        pose=pose[frame],
        lines=[line.path[frame] for line in lines],
        title=f"Section at t = {moment:.2f} s",
    )
    what = "largest tension" if lines else "largest rotation"
    return Animation(
        key(level, sea, record.run.name, "animation"),
        f"Animated section: {record.label}",
        scene,
        f"To scale; opened at the {what}, t = {moment:.2f} s. Water: undisturbed linear wave. Slack lines are drawn "
        "sagging.",
        picture=with_colours(still),
    )


def _outlines(section: CageSection) -> tuple[Array, ...]:
    """Return frame, net and floats as closed outlines."""
    # lines there and back: an area would hide what runs behind the net
    corners = section.outline
    edges = [np.array([corners[n], corners[(n + 1) % len(corners)]]) for n in range(len(corners))]
    net = tuple(np.concatenate([line, line[::-1]]) for line in (*edges, *net_lines(corners)))
    floats = tuple(circle(float(x), float(z), 0.5 * section.diameter, 17)[:-1] for x, z in section.floats)
    return (*net, *floats)


def _lines(record: RigidRecord, section: CageSection, times: Array, pose: Array) -> tuple[MovingLine, ...]:
    found = []
    for (name, ends), length in zip(section.lines, section.lengths):
        if name not in record.lines:
            continue
        arm = (float(ends[1][0]) - section.centre[0], float(ends[1][1]) - section.centre[1])
        moved = ends[1] + fairlead_motion(pose, arm)
        number = record.lines.index(name)
        tension = np.interp(times, record.time, record.tension[:, number, 0])
        found.append(MovingLine(name, line_path(ends[0], moved, length), tension, float(record.peak[:, number].max())))
    return tuple(found)


def _extents(
    section: CageSection, record: RigidRecord, bed: float | None
) -> dict[str, tuple[float, float, float, float]]:
    outline = section.outline
    size = max(float(np.ptp(outline[:, 0])), float(np.ptp(outline[:, 1])))
    wave = float(np.abs(record.elevation).max())
    travel = record.pose[:, 0]
    left = float(outline[:, 0].min()) + min(float(travel.min()), 0.0) - 0.8 * size
    right = float(outline[:, 0].max()) + max(float(travel.max()), 0.0) + 0.8 * size
    top = max(1.6 * wave, float(section.floats[:, 1].max()) + section.diameter) + 0.25 * size
    low = float(outline[:, 1].min()) - 0.5 * size
    if bed is not None:
        low = max(low, bed - 0.05 * size)
    near = (left, right, low, top)
    if not section.lines or bed is None:
        return {"Cage": near}
    anchors = [float(ends[0][0]) for _, ends in section.lines]
    return {
        "Whole mooring": (
            min(left, min(anchors) - 0.3 * size),
            max(right, max(anchors) + 0.3 * size),
            bed - 0.08 * size,
            top,
        ),
        "Cage": near,
    }


def _surface(
    level: CageLevel, record: RigidRecord, times: Array, extents: dict[str, tuple[float, float, float, float]]
) -> Surface:
    left, right = min(bounds[0] for bounds in extents.values()), max(bounds[1] for bounds in extents.values())
    x = np.linspace(left, right, 121)
    sense = 1.0 if math.cos(float(record.run.attributes.get("heading", 0.0))) > 0.0 else -1.0
    if record.regular:
        delay = sense * x / record.wavelength * record.period
        inside = np.clip(times[:, None] - delay[None, :], record.time[0], record.time[-1])
        # a steady wave continues beyond the end of its record
        beyond = times[:, None] - delay[None, :] > record.time[-1]
        inside = np.where(beyond, times[:, None] - delay[None, :] - record.period, inside)
        return Surface(x, np.interp(inside.reshape(-1), record.time, record.elevation).reshape(inside.shape))
    from moyai.sea.dispersion import wave_number

    omega = 2.0 * math.pi / record.period * np.geomspace(0.2, 8.0, 60)
    number = np.array([float(wave_number(w, level.depth, 9.81)) for w in omega])
    values = travelling_surface(record.time, record.elevation, sense * x, times, omega=omega, wave_number=number)
    return Surface(x, values)
