"""Three-dimensional views of a flexible cage: at rest in each current, and in motion."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from moyai.core.arrays import Array, IntArray
from moyai.report.animation_3d import animation_3d
from moyai.report.document import Animation, Block, Choice, Option
from moyai.report.formatting import format_quantity
from moyai.report.reading import Group
from moyai.report.scene_3d import Faces, Marker, Scene3D, Trace, Waves3D, frame_rows
from moyai.structures.cage.report.flexible_figures import design_row
from moyai.structures.cage.report.rigid_reading import CageLevel, key

Parts = tuple[IntArray, NDArray[np.bool_], tuple[Faces, ...], tuple[Marker, ...], tuple[str, ...]]

#: Periods of the window that an animation opens with.
_WINDOW_PERIODS = 4.0


def _parts(level: CageLevel) -> Parts | None:
    """Return bars, which of them are thin, faces, markers and names of the bars."""
    cage = level.part("cage")
    start, end, kind = (cage.array(name, "bar") for name in ("bar_start", "bar_end", "bar_kind"))
    corners = cage.array("panel_corners", "panel", "corner")
    line = cage.array("bar_line", "bar")
    if start is None or end is None or kind is None or corners is None or line is None:
        return None
    words = {0: "net", 1: "collar", 2: "sinker tube", 4: "bracket"}
    lines = cage.labels("line")
    names = tuple(
        lines[number] if number >= 0 else words.get(what, "")
        for number, what in zip(line.astype(int).tolist(), kind.astype(int).tolist(), strict=True)
    )
    quads = corners[corners[:, 3] >= 0].astype(np.int64)
    flat = corners[corners[:, 3] < 0][:, :3].astype(np.int64)
    faces = tuple(
        Faces(nodes, name, "net") for nodes, name in ((quads, "net"), (flat, "net, middle of the bottom")) if len(nodes)
    )
    markers: list[Marker] = []
    for dim, node_name, words_of, what in (
        ("anchor", "anchor_node", "anchor", "anchor"),
        ("buoy", "buoy_node", "buoy", "float"),
        ("sinker", "sinker_node", "sinker", "clump"),
    ):
        nodes = cage.array(node_name, dim)
        for number, node in enumerate(() if nodes is None else nodes.astype(int)):
            markers.append(Marker(int(node), f"{words_of} {number + 1}", what))  # type: ignore[arg-type]
    return np.stack([start, end], axis=1).astype(np.int64), kind == 0, faces, tuple(markers), names


def _current(level: CageLevel, speed: float) -> tuple[float, float]:
    heading = float(level.group.attributes.get("heading", 0.0))
    return speed * math.cos(heading), speed * math.sin(heading)


def _bed(level: CageLevel) -> float:
    return float(level.part("cage").attributes.get("bed", -level.depth))


def _without_anchor_lines(level: CageLevel, count: int) -> tuple[IntArray, IntArray]:
    """Return the bars of all but the anchor lines, and the nodes that they join."""
    cage = level.part("cage")
    line, start, end = (cage.array(name, "bar") for name in ("bar_line", "bar_start", "bar_end"))
    assert line is not None and start is not None and end is not None
    far = np.array([name.startswith("anchor") for name in cage.labels("line")], dtype=bool)
    keep = np.flatnonzero((line < 0) | ~far[np.maximum(line.astype(int), 0)]) if far.size else np.arange(line.size)
    there = np.zeros(count, dtype=bool)
    there[start[keep].astype(int)] = there[end[keep].astype(int)] = True
    return keep, np.flatnonzero(there)


def _near(parts: Parts, keep: IntArray, kept: IntArray) -> Parts:
    """Return the parts of a view that are left with some bars and nodes, renumbered."""
    bars, thin, faces, markers, names = parts
    number = np.full(int(max(bars.max(), kept.max())) + 1, -1)
    number[kept] = np.arange(kept.size)
    left = tuple(Faces(number[np.asarray(face.nodes)], face.name, face.kind) for face in faces)
    shown = tuple(Marker(int(number[mark.node]), mark.name, mark.kind) for mark in markers if number[mark.node] >= 0)
    return number[bars[keep]], thin[keep], left, shown, tuple(names[int(k)] for k in keep)


def rest_views(level: CageLevel) -> Block | None:
    """Return the cage at rest in each current to choose from, ``None`` where there is none."""
    parts, statics = _parts(level), level.part("statics")
    position, tension = statics.array("position", "current", "node", "axis"), statics.array("tension", "current", "bar")
    speed = statics.real("current_speed", "current")
    if parts is None or position is None or tension is None or speed is None:
        return None
    keep, kept = _without_anchor_lines(level, position.shape[1])
    near = _near(parts, keep, kept)
    options = []
    for number, value in enumerate(speed):
        said = format_quantity(float(value), "m/s") if value > 0.0 else "still water"
        options.append(Option(said, (_still(level, near, position[number][kept], tension[number][keep], value, said),)))
    if keep.size < tension.shape[1]:
        last = design_row(level, speed)
        said = f"{format_quantity(float(speed[last]), 'm/s')}, with anchor lines"
        options.append(Option(said, (_still(level, parts, position[last], tension[last], speed[last], said),)))
    return Choice(f"rest-view-{level.name}", "Current", tuple(options), design_row(level, speed), print_all=False)


def _still(level: CageLevel, parts: Parts, place: Array, pull: Array, speed: float, said: str) -> Animation:
    """Return the view of one rest."""
    bars, thin, faces, markers, names = parts
    scene = Scene3D(
        np.array([0.0, 1.0]), np.stack([place] * 2), bars, np.stack([pull] * 2), thin, faces, markers,
        bed=_bed(level) if said.endswith("lines") else None, current=_current(level, float(speed)), maximum=0.0,
        names=names, is_still=True,
    )  # fmt: skip
    return animation_3d(
        key(level, "rest-view", said),
        f"The cage at rest, {said}",
        scene,
        "To scale; colour and breadth grow with the tension, dashed grey is slack.",
    )


def run_view(level: CageLevel, sea: str, run: Group) -> Animation | None:
    """Return the animation of a run, ``None`` where it kept no pictures."""
    parts = _parts(level)
    time = run.real("frame_time", "frame")
    position, tension = run.array("position", "frame", "node", "axis"), run.array("tension", "frame", "bar")
    if parts is None or time is None or position is None or tension is None:
        return None
    good = np.isfinite(position).all(axis=(1, 2))
    if good.sum() < 2:
        return None
    keep, kept = _without_anchor_lines(level, position.shape[1])
    time, position, tension = time[good], position[good][:, kept], tension[good][:, keep]
    bars, thin, faces, markers, names = _near(parts, keep, kept)
    period = float(run.attributes.get("period", math.nan))
    length, moment = _WINDOW_PERIODS * period, float(run.attributes.get("governing_time", math.nan))
    window = (float(time[0]), float(time[-1]))
    if math.isfinite(length) and window[1] - window[0] > length:
        centre = moment if math.isfinite(moment) else window[1]
        start = min(max(centre - 0.5 * length, window[0]), window[1] - length)
        window = (start, start + length)
    rows = frame_rows(time, nodes=position.shape[1], bars=len(bars), window=window, moments=(moment,))
    scene = Scene3D(
        time[rows], position[rows], bars, tension[rows], thin, faces, markers, traces=_traces(level, run, names),
        waves=_waves(run), current=_current(level, float(level.group.attributes.get("current", 0.0))), window=window,
        names=names, maximum=moment,
    )  # fmt: skip
    return animation_3d(
        key(level, sea, run.name, "view"),
        f"The cage in motion: {run.attributes.get('wave', run.name)}",
        scene,
        "To scale, not enlarged, without the anchor lines; colour and breadth grow with the tension, dashed is slack.",
    )


def _traces(level: CageLevel, run: Group, names: tuple[str, ...]) -> tuple[Trace, ...]:
    time, peak = run.real("time", "time"), run.array("line_tension_peak_since_row", "time", "line")
    broken = level.part("cage").real("breaking_load", "line")
    if time is None or peak is None:
        return ()
    return tuple(
        Trace(
            line, time, np.nan_to_num(peak[:, k]), names.index(line) if line in names else -1,
            math.nan if broken is None else float(broken[k]),
        )
        for k, line in enumerate(run.labels("line"))
    )  # fmt: skip


def _waves(run: Group) -> Waves3D | None:
    values = [
        run.attributes.get(f"component_{name}") for name in ("amplitude", "omega", "wave_number", "heading", "phase")
    ]
    if any(value is None for value in values):
        return None
    amplitude, omega, number, heading, phase = (np.atleast_1d(np.asarray(value, dtype=float)) for value in values)
    return Waves3D(amplitude, omega, number, heading, phase, float(run.attributes.get("ramp", 0.0)))
