"""Runs of a row in time: the record around its maximum, and the row in motion."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from moyai.core.arrays import Array, IntArray
from moyai.mooring.rotations import rotation_from_vector, rotation_matrix
from moyai.report.animation_3d import animation_3d
from moyai.report.decimate import focus_indices, window_around
from moyai.report.document import Abscissa, Animation, Block, Figure, Mark, Panel, Series
from moyai.report.encoding import slug
from moyai.report.formatting import format_quantity
from moyai.report.reading import Group, common_scale
from moyai.report.scene_3d import Body3D, Marker, Scene3D, Trace, Waves3D, frame_rows

#: Peak periods of the window that is shown first; stretches of the record outside of it
WINDOW_PERIODS, BINS = 12.0, 200
#: Connectors and lines that are drawn, those with most
MOST_CURVES = 4


@dataclass(frozen=True)
class _Record:
    """A run as arrays: motions in axes of the units, resultants of connectors, tensions."""

    run: Group
    time: Array
    motion: Array
    force: Array
    tension: Array
    elevation: Array
    at: int
    window: tuple[float, float]

    @classmethod
    def of(cls, run: Group) -> _Record | None:
        time, motion = run.real("time", "time"), run.real("position", "time", "unit", "dof")
        elevation = run.real("surface_elevation", "time")
        if time is None or motion is None or elevation is None or time.size < 3:
            return None
        force = run.real("connector_force", "time", "connector", "component")
        resultant = np.zeros((time.size, 0)) if force is None else np.linalg.norm(force, axis=2)
        tension = run.real("tension", "time", "line")
        tension = np.zeros((time.size, 0)) if tension is None else tension
        begin = int(np.searchsorted(time, float(run.attributes.get("analysis_start", 0.0)))) % time.size
        followed = resultant if resultant.shape[1] else tension if tension.shape[1] else np.abs(motion[..., 0])
        at = begin + int(np.argmax(followed[begin:].max(axis=1)))
        omega = run.real("wave_omega", "wave")
        amplitude = run.real("wave_amplitude", "wave")
        period = 10.0
        if omega is not None and amplitude is not None and omega.size:
            period = 2.0 * math.pi / float(np.average(omega, weights=amplitude**2))
        first, last = window_around(time, float(time[at]), WINDOW_PERIODS * period)
        return cls(run, time, motion, resultant, tension, elevation, at, (float(time[first]), float(time[last - 1])))

    @property
    def largest(self) -> float:
        """What the record is opened at."""
        values = self.force if self.force.shape[1] else self.tension
        return float(values[self.at].max()) if values.shape[1] else float(np.abs(self.motion[self.at, :, 0]).max())


def time_blocks(level: Group, sea: Group) -> list[Block | None]:
    """Return the record of every run of a sea, and the row in motion in that of the largest force."""
    records = [record for record in map(_Record.of, sea.children()) if record is not None]
    if not records:
        return []
    highest = max(records, key=lambda record: record.largest)
    return [_scene(level, sea, highest), *(_figure(level, sea, record) for record in records)]


def _figure(level: Group, sea: Group, record: _Record) -> Figure:
    run, units = record.run, record.run.labels("unit")
    first, last = np.searchsorted(record.time, record.window)
    stacked = np.column_stack([record.elevation, record.motion[..., 0], record.force, record.tension])
    keep = focus_indices(stacked, (int(first), int(last) + 1), BINS)
    along = {"time": record.time[keep]}
    panels = [Panel("wave", "m"), Panel("sway", "m"), Panel("heave", "m"), Panel("roll", "deg")]
    series = [Series("wave", along, record.elevation[keep], 0, 0)]
    for panel, (dof, factor) in enumerate(((0, 1.0), (2, 1.0), (4, 180.0 / math.pi)), start=1):
        for number, unit in enumerate(units):
            series.append(Series(f"unit {unit}", along, factor * record.motion[keep, number, dof], panel, number))
    marks = []
    for label, values, names in (
        ("connectors", record.force, run.labels("connector")), ("tension", record.tension, run.labels("line"))
    ):  # fmt: skip
        if not values.shape[1]:
            continue
        scale, shown = common_scale("N", values)
        panels.append(Panel(label, shown, from_zero=True))
        for number in _most(values):
            series.append(Series(names[number], along, scale * values[keep, number], len(panels) - 1, int(number)))
        if values is record.force:
            peak = float(values[record.at].max())
            words = f"max {format_quantity(peak, 'N')}"
            marks.append(Mark(words, x=float(record.time[record.at]), y=scale * peak, panel=len(panels) - 1))
    return Figure(
        slug(level.name, "record", sea.name, run.name), f"Record: {sea.name}, {run.name}",
        (Abscissa("time", "time", "s"),), tuple(panels), tuple(series),
        "The window about the largest force. Wave: incident, at the middle of the row. Forces: resultants, of the "
        f"{MOST_CURVES} connectors and lines with most.",
        tuple(marks), window=record.window, slider=True, height=110 + 92 * len(panels),
    )  # fmt: skip


def _most(values: Array) -> IntArray:
    return np.sort(np.argsort(-values.max(axis=0))[:MOST_CURVES])


def _scene(level: Group, sea: Group, record: _Record) -> Animation | None:
    """Return the row in motion: units as boxes, lines as bars between their ends, coloured by tension."""
    statics, run = level.child("statics"), record.run
    centre = np.stack([statics.require(name, "unit") for name in ("unit_x", "unit_y", "unit_centre_z")], axis=1)
    heading = statics.require("unit_heading", "unit")
    rows = frame_rows(
        record.time, nodes=2 * record.tension.shape[1] + 3 * len(centre), bars=record.tension.shape[1],
        window=record.window, moments=(float(record.time[record.at]),),
    )  # fmt: skip
    turned = rotation_matrix(np.stack([0.0 * heading, 0.0 * heading, heading], axis=1))
    moved = record.motion[rows]
    origin = centre + np.einsum("uij,tuj->tui", turned, moved[..., :3])
    rotation = np.einsum("uij,tujk->tuik", turned, rotation_from_vector(moved[..., 3:]))
    size = [float(statics.attributes[name]) for name in ("beam", "length", "height")]
    low = np.array([-0.5 * size[0], -0.5 * size[1], statics.value("freeboard") - size[2]])
    high = np.array([0.5 * size[0], 0.5 * size[1], statics.value("freeboard")])
    bodies = tuple(
        Body3D.box(
            f"unit {unit}",
            low - [0.0, 0.0, centre[n, 2]],
            high - [0.0, 0.0, centre[n, 2]],
            origin[:, n],
            rotation[:, n],
        )
        for n, unit in enumerate(run.labels("unit"))
    )
    lines = run.labels("line") if record.tension.shape[1] else ()
    position = _line_ends(statics, lines, centre, origin, rotation, turned)
    bars = np.arange(2 * len(lines), dtype=np.int64).reshape(-1, 2)
    load = statics.real("breaking_load", "line")
    traces = tuple(
        Trace(
            name,
            record.time,
            record.tension[:, n],
            n,
            float(load[n]) if load is not None and len(load) > n else math.nan,
        )
        for n, name in enumerate(lines)
    )
    depth = float(level.attributes.get("water_depth", math.inf))
    scene = Scene3D(
        record.time[rows], position, bars, record.tension[rows],
        markers=tuple(Marker(2 * n, f"anchor of {name}", "anchor") for n, name in enumerate(lines)), bodies=bodies,
        traces=traces, waves=_waves(run), bed=-depth if math.isfinite(depth) else None, window=record.window,
        maximum=float(record.time[record.at]), names=tuple(lines),
    )  # fmt: skip
    return animation_3d(
        slug(level.name, "view", sea.name, run.name), f"The row in motion: {sea.name}, {run.name}", scene,
        "To scale, not enlarged; the waves are the incident ones. Lines are drawn straight between their ends, "
        "coloured by tension.",
    )  # fmt: skip


def _line_ends(
    statics: Group, lines: tuple[str, ...], centre: Array, origin: Array, rotation: Array, turned: Array
) -> Array:
    """Return anchors and fairleads by turns (frames, 2 lines, 3); a fairlead moves with the unit next to it."""
    out = np.zeros((len(origin), 2 * len(lines), 3))
    if not lines:
        return out
    anchors, fairleads = (
        np.stack([statics.require(f"{end}_{axis}", "line") for axis in "xyz"], axis=1) for end in ("anchor", "fairlead")
    )
    for number, fairlead in enumerate(fairleads):
        unit = int(np.argmin(np.linalg.norm((centre - fairlead)[:, :2], axis=1)))
        own = turned[unit].T @ (fairlead - centre[unit])
        out[:, 2 * number] = anchors[number]
        out[:, 2 * number + 1] = origin[:, unit] + rotation[:, unit] @ own
    return out


def _waves(run: Group) -> Waves3D | None:
    parts = [run.real(f"wave_{name}", "wave") for name in ("amplitude", "omega", "number", "heading", "phase")]
    amplitude, omega, number, heading, phase = parts
    if amplitude is None or omega is None or number is None or heading is None or phase is None:
        return None
    return Waves3D(amplitude, omega, number, heading, phase, float(run.attributes.get("ramp", 0.0)))
