"""3-D scenes of a network: at rest, a run through time, its natural modes."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from moyai.core.arrays import Array, IntArray
from moyai.report.animation_3d import animation_3d
from moyai.report.document import Animation, Block, Choice, Option
from moyai.report.encoding import slug
from moyai.report.formatting import format_quantity
from moyai.report.reading import Group
from moyai.report.scene_3d import Body3D, Faces, Marker, Scene3D, Trace, Waves3D, frame_rows
from moyai.structures.network.report.reading import NetworkLevel, peak_of_run, texts

#: Periods that are played at first, and a length of run that is played whole [s].
WINDOW_PERIODS, WHOLE = 8.0, 45.0
FRAMES_OF_A_MODE = 32


def _bars(level: NetworkLevel) -> tuple[IntArray, NDArray[np.bool_], tuple[str, ...]] | None:
    network = level.network
    start, end = network.array("bar_start", "bar"), network.array("bar_end", "bar")
    thin = network.array("bar_thin", "bar")
    if start is None or end is None:
        return None
    flags = np.zeros(start.size, dtype=bool) if thin is None else thin.astype(bool)
    return np.stack([start, end], axis=1).astype(np.int64), flags, texts(network, "bar_line")


def _markers(level: NetworkLevel, kept: IntArray) -> tuple[Marker, ...]:
    """Return anchors, driven points, floats and weights among the nodes that are kept."""
    network, found = level.network, []
    place = {int(node): number for number, node in enumerate(kept)}
    nodes, diameters = network.array("point_node", "point"), network.real("point_diameter", "point")
    bodies, volume, mass = (network.array(name, "body") for name in ("body_node", "body_volume", "body_mass"))
    density = 1000.0
    carried = {} if bodies is None or volume is None or mass is None else {
        int(node): (float(v), float(m)) for node, v, m in zip(bodies, volume, mass, strict=True)
    }  # fmt: skip
    named: set[int] = set()
    if nodes is not None and diameters is not None:
        for name, kind, node, diameter in zip(
            network.labels("point"), texts(network, "point_kind"), nodes, diameters, strict=True
        ):
            named.add(int(node))
            if int(node) not in place:
                continue
            load = carried.get(int(node), (0.0, 0.0))
            sign = {"fixed": "anchor", "driven": "driven"}.get(kind, "joint")
            if sign == "joint" and max(load) > 0.0:
                sign = "float" if density * load[0] > load[1] else "clump"
            found.append(Marker(place[int(node)], name, sign, float(diameter)))  # type: ignore[arg-type]
    heaviest = max((m for _, m in carried.values()), default=0.0)
    for node, (v, m) in carried.items():
        # sinkers of nets are many and small: the line along the bottom shows them
        if node in named or node not in place or (len(carried) > 60 and m < 0.2 * heaviest):
            continue
        found.append(
            Marker(place[node], "float" if density * v > m else "weight", "float" if density * v > m else "clump",
                   (6.0 * v / math.pi) ** (1.0 / 3.0))
        )  # fmt: skip
    return tuple(found)


def _faces(level: NetworkLevel, place: dict[int, int], load: Array | None = None) -> tuple[Faces, ...]:
    """Return the triangles of sheets, coloured by their tension where it is known."""
    corners = level.network.array("sheet_nodes", "triangle", "corner")
    if corners is None:
        return ()
    whole = np.array([all(int(node) in place for node in row) for row in corners])
    known = np.array([[place[int(node)] for node in row] for row in corners[whole]], dtype=np.int64)
    if not len(known):
        return ()
    return (Faces(known, "sheet", load=None if load is None else load[:, whole]),)


def _through_kept(bars: IntArray, thin: NDArray[np.bool_], names: tuple[str, ...], kept: IntArray, tension: Array,
                  count: int) -> tuple[IntArray, NDArray[np.bool_], tuple[str, ...], Array]:  # fmt: skip
    """Return bars between kept nodes; where nodes were left out their bars join up, with the highest tension."""
    place = np.full(count, -1, dtype=np.int64)
    place[kept] = np.arange(kept.size)
    if kept.size == count:
        return bars, thin, names, tension
    made: list[tuple[int, int]] = []
    rows: list[tuple[int, Array]] = []
    begin, pull = -1, None
    for k, (a, b) in enumerate(bars):
        if place[a] >= 0:
            begin, pull = int(place[a]), tension[:, k]
        elif pull is not None:
            pull = np.maximum(pull, tension[:, k])
        if place[b] >= 0 and begin >= 0 and pull is not None:
            made.append((begin, int(place[b])))
            rows.append((k, pull))
            begin, pull = -1, None
    index = [k for k, _ in rows]
    return (
        np.array(made, dtype=np.int64), thin[index], tuple(names[k] for k in index) if names else (),
        np.stack([values for _, values in rows], axis=1),
    )  # fmt: skip


def run_animation(level: NetworkLevel, run: Group) -> Animation | None:
    """Return the animated view of a run, ``None`` where the result holds no frames."""
    frames, bars = run.child("frames"), _bars(level)
    time, position = frames.real("frame", "frame"), frames.real("position", "frame", "node", "axis")
    tension, kept = frames.real("tension", "frame", "bar"), frames.array("node", "node")
    built = level.network.real("node_position", "node", "axis")
    if bars is None or time is None or position is None or tension is None or kept is None or built is None:
        return None
    good: NDArray[np.bool_] = np.asarray(np.isfinite(position).all(axis=(1, 2)))
    if good.sum() < 2:
        return None
    time, position, tension = time[good], position[good], tension[good]
    found = peak_of_run(level, run)
    moment = found.time if found is not None else float(time[-1])
    period = run.number("period")
    length = WINDOW_PERIODS * period if period > 0.0 else WHOLE
    window = (float(time[0]), float(time[-1]))
    if window[1] - window[0] > max(WHOLE, length):
        begin = min(max(moment - 0.6 * length, window[0]), window[1] - length)
        window = (begin, begin + length)
    pairs, thin, names, pull = _through_kept(*bars, kept.astype(np.int64), tension, len(built))
    rows = frame_rows(time, nodes=position.shape[1], bars=len(pairs), window=window, moments=(moment,))
    place = {int(node): number for number, node in enumerate(kept)}
    cloth = frames.real("sheet_tension", "frame", "triangle")
    current = (level.network.number("current_x"), level.network.number("current_y"))
    bed = level.network.number("bed")
    depth = level.group.number("water_depth")
    scene = Scene3D(
        time[rows], position[rows], pairs, pull[rows], thin,
        _faces(level, place, None if cloth is None else cloth[good][rows]), _markers(level, kept),
        bodies=_solids(level, frames, good, rows), traces=_traces(level, run, pairs, names), waves=_waves(frames),
        bed=bed if math.isfinite(bed) else (-depth if math.isfinite(depth) else None),
        current=(current[0] if math.isfinite(current[0]) else 0.0, current[1] if math.isfinite(current[1]) else 0.0),
        slack_level=max(level.network.number("slack_level"), 0.0), window=window, maximum=moment, names=names,
    )  # fmt: skip
    said = ""
    if found is not None:
        said = (
            f" Opened at the highest tension, {format_quantity(found.peak, 'N')} in {found.line}, t = {moment:.2f} s."
        )
    return animation_3d(
        slug(level.name, run.name, "view"),
        f"The network in motion: {run.name}",
        scene,
        f"To scale, not enlarged; colour and breadth grow with the tension, dashed grey is slack.{said}",
    )


def _solids(level: NetworkLevel, frames: Group, good: NDArray[np.bool_], rows: IntArray) -> tuple[Body3D, ...]:
    """Return the rigid bodies of a run."""
    place = frames.array("solid_position", "frame", "solid", "axis")
    turn = frames.array("solid_rotation", "frame", "solid", "axis", "body_axis")
    size, shapes = level.network.array("solid_size", "solid", "axis"), texts(level.network, "solid_shape")
    if place is None or turn is None or size is None:
        return ()
    place, turn = place[good][rows], turn[good][rows]
    found = []
    for number, (name, shape) in enumerate(zip(frames.labels("solid"), shapes, strict=True)):
        if shape == "assembly":
            found += _rods(level, number, name, place[:, number], turn[:, number])
            continue
        made = Body3D.box if shape == "box" else Body3D.cylinder
        found.append(made(name, -0.5 * size[number], 0.5 * size[number], place[:, number], turn[:, number]))
    return tuple(found)


def _rods(
    level: NetworkLevel, number: int, name: str, place: NDArray[np.float64], turn: NDArray[np.float64]
) -> list[Body3D]:
    """Return the parts of an assembled body, each a cylinder about a z axis of its own."""
    owner = level.network.real("solid_part_solid", "solid_part")
    start, end = (level.network.array(f"solid_part_{key}", "solid_part", "axis") for key in ("start", "end"))
    diameter = level.network.real("solid_part_diameter", "solid_part")
    if owner is None or start is None or end is None or diameter is None:
        return []
    found = []
    for row in np.flatnonzero(owner == number):
        along = end[row] - start[row]
        length, half = float(np.linalg.norm(along)), 0.5 * float(diameter[row])
        z = along / length
        x = np.cross(np.eye(3)[int(np.argmin(np.abs(z)))], z)
        x /= np.linalg.norm(x)
        own = np.stack([x, np.cross(z, x), z], axis=1)
        found.append(
            Body3D.cylinder(
                name, (-half, -half, 0.0), (half, half, length),
                place + np.einsum("kij,j->ki", turn, start[row]), turn @ own,
            )
        )  # fmt: skip
    return found


def _traces(level: NetworkLevel, run: Group, pairs: IntArray, names: tuple[str, ...]) -> tuple[Trace, ...]:
    time = run.real("time", "time")
    if time is None or time.size < 2:
        return ()
    found = []
    breaking = level.network.real("breaking_load", "line")
    for number, line in enumerate(run.labels("line")):
        record = run.real("line_tension_peak_since_row", "time", line=line)
        if record is not None and np.isfinite(record).any():
            load = float(breaking[number]) if breaking is not None else math.nan
            bar = names.index(line) if line in names else -1
            found.append(Trace(line, time, np.nan_to_num(record), bar, load))
    for net in run.labels("net"):
        record = run.real("net_tension", "time", net=net)
        if record is not None and np.isfinite(record).any():
            found.append(Trace(net, time, np.nan_to_num(record)))
    return tuple(found)


def _waves(frames: Group) -> Waves3D | None:
    parts = [
        frames.real(name, "wave")
        if name == "wave_amplitude"
        else (None if (v := frames.array(name, "wave")) is None else np.asarray(v, dtype=float))
        for name in ("wave_amplitude", "wave_omega", "wave_number", "wave_heading", "wave_phase")
    ]
    if any(part is None for part in parts):
        return None
    ramp = frames.number("ramp")
    amplitude, omega, number, heading, phase = (np.asarray(part) for part in parts)
    return Waves3D(amplitude, omega, number, heading, phase, ramp if math.isfinite(ramp) else 0.0)


def rest_animation(level: NetworkLevel) -> Animation | None:
    """Return the view of a network at rest, ``None`` where there is none."""
    rest, bars = level.part("statics"), _bars(level)
    position, tension = rest.real("position", "condition", "node", "axis"), rest.real("tension", "condition", "bar")
    signed = rest.array("position", "condition", "node", "axis")
    if position is None or tension is None or bars is None or signed is None:
        return None
    conditions = rest.labels("condition")
    last = signed[-1]
    pairs, thin, names = bars
    current = level.network.number("current_x"), level.network.number("current_y")
    bed, depth = level.network.number("bed"), level.group.number("water_depth")
    kept = np.arange(last.shape[0])
    shown = "current" in conditions
    scene = Scene3D(
        np.array([0.0, 1.0]), np.stack([last, last]), pairs, np.stack([tension[-1], tension[-1]]), thin,
        _faces(level, {int(node): int(node) for node in kept}), _markers(level, kept),
        bed=bed if math.isfinite(bed) else (-depth if math.isfinite(depth) else None),
        current=(current[0], current[1]) if shown else (0.0, 0.0), maximum=0.0, names=names, is_still=True,
    )  # fmt: skip
    return animation_3d(
        slug(level.name, "rest-view"),
        f"The network at rest in {conditions[-1]}",
        scene,
        "To scale; colour and breadth grow with the tension, dashed grey is slack.",
    )


def mode_animations(level: NetworkLevel) -> Block | None:
    """Return the lowest modes to choose from, enlarged, ``None`` where there are none."""
    modes, rest, bars = level.part("modes"), level.part("statics"), _bars(level)
    shape = modes.array("mode_shape", "mode", "node", "axis")
    period = modes.real("mode_period", "mode")
    places = rest.array("position", "condition", "node", "axis")
    tension = rest.real("tension", "condition", "bar")
    if shape is None or period is None or places is None or bars is None or tension is None:
        return None
    base = places[-1]
    size = float(np.max(np.ptp(base, axis=0)))
    bed, depth = level.network.number("bed"), level.group.number("water_depth")
    options = []
    for number in range(shape.shape[0]):
        cycle = float(period[number]) if math.isfinite(period[number]) else 1.0
        time = np.linspace(0.0, cycle, FRAMES_OF_A_MODE + 1)
        swing = np.sin(2.0 * np.pi * time / cycle)[:, None, None] * shape[number] * 0.06 * size
        scene = Scene3D(
            time, base + swing, bars[0], np.repeat(tension[-1:], time.size, axis=0), bars[1],
            markers=_markers(level, np.arange(base.shape[0])),
            bed=bed if math.isfinite(bed) else (-depth if math.isfinite(depth) else None),
            maximum=0.25 * cycle, names=bars[2],
        )  # fmt: skip
        said = f"{format_quantity(cycle, 's')}" if math.isfinite(period[number]) else "free to move"
        options.append(
            Option(
                f"{number + 1}: {said}",
                (
                    animation_3d(
                        slug(level.name, "mode", str(number + 1)), f"Mode {number + 1}, {said}", scene,
                        "Shape of the motion, enlarged; added mass counted, no damping. Colours: tension at rest.",
                    ),
                ),
            )
        )  # fmt: skip
    return Choice(f"mode-{level.name}", "Mode", tuple(options), print_all=False) if options else None
