"""Scenes for the 3-D player: nodes and bars coloured by tension, sheets, bodies, the water and the bed, over time.

A structure fills a :class:`Scene3D` with plain arrays; :func:`moyai.report.animation_3d.animation_3d` turns it into a
block of the report, with a still of the governing moment for paper (:mod:`moyai.report.still_3d`).
"""

from __future__ import annotations

import base64
import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from moyai.core.arrays import Array, IntArray
from moyai.core.errors import InputError
from moyai.core.options import checks_words
from moyai.report.decimate import envelope_indices
from moyai.report.encoding import encode_array, encode_quantised
from moyai.report.formatting import display_unit

#: Size of the motion in the page [bytes before base64], fewest and most frames, points of a trace of tension.
BYTES_OF_MOTION, FEWEST_FRAMES, MOST_FRAMES, POINTS_OF_A_TRACE = 4_000_000, 40, 1500, 1600
#: Wave components kept for the moving surface, and lines whose tension is traced.
MOST_COMPONENTS, MOST_TRACES = 60, 6


@checks_words
@dataclass(frozen=True, eq=False)
class Faces:
    """Faces between nodes: a skirt, a membrane, net panels."""

    #: Corners; shape (t, 3) or (t, 4).
    nodes: ArrayLike
    name: str = "sheet"
    #: Cloth that hides what is behind it, or netting that lets it through.
    kind: Literal["sheet", "net"] = "sheet"
    #: What colours the faces, for instance the larger principal tension; no colour when left out; shape (frames, t).
    load: Array | None = None
    #: Stored unit of ``load``.
    load_unit: str = "N/m"


@checks_words
@dataclass(frozen=True)
class Marker:
    """A named node that is drawn."""

    node: int
    name: str
    kind: Literal["anchor", "driven", "float", "clump", "joint"] = "joint"
    #: To scale [m]; 0: a small sign.
    diameter: float = 0.0


@dataclass(frozen=True, eq=False)
class Body3D:
    """A rigid body."""

    name: str
    #: In its own axes [m]; shape (v, 3).
    vertices: Array
    #: Corners of its faces.
    faces: Sequence[Sequence[int]]
    #: Where the origin of its axes is [m]; shape (frames, 3).
    origin: Array
    #: From its axes to those of the site; shape (frames, 3, 3).
    rotation: Array

    @classmethod
    def box(cls, name: str, low: ArrayLike, high: ArrayLike, origin: Array, rotation: Array) -> Body3D:
        """Return a box between two corners in its own axes."""
        a, b = np.asarray(low, dtype=float), np.asarray(high, dtype=float)
        corners = np.array([[(a, b)[i][0], (a, b)[j][1], (a, b)[k][2]] for k in (0, 1) for j in (0, 1) for i in (0, 1)])
        faces = ((0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5))
        return cls(name, corners, faces, origin, rotation)

    @classmethod
    def cylinder(cls, name: str, low: ArrayLike, high: ArrayLike, origin: Array, rotation: Array) -> Body3D:
        """Return a cylinder about the z axis that fills a box between two corners."""
        a, b, count = np.asarray(low, dtype=float), np.asarray(high, dtype=float), 24
        angle = 2.0 * math.pi * np.arange(count) / count
        middle, half = 0.5 * (a + b), 0.5 * (b - a)
        ring = np.stack([middle[0] + half[0] * np.cos(angle), middle[1] + half[1] * np.sin(angle)], axis=1)
        corners = np.concatenate([np.column_stack([ring, np.full(count, level)]) for level in (a[2], b[2])])
        sides = [[k, (k + 1) % count, count + (k + 1) % count, count + k] for k in range(count)]
        return cls(name, corners, [list(range(count))[::-1], list(range(count, 2 * count)), *sides], origin, rotation)


@dataclass(frozen=True, eq=False)
class Trace:
    """Tension of one line over the whole record, under the picture."""

    name: str
    #: [s]; shape (k,).
    time: Array
    #: [N]; best the highest since the row before, so that no peak is lost; shape (k,).
    tension: Array
    #: Bar that it belongs to, -1 for none.
    bar: int = -1
    #: NaN where not known [N].
    breaking_load: float = math.nan


@dataclass(frozen=True, eq=False)
class Waves3D:
    """Surface of a sum of linear waves, A cos(k (x cos b + y sin b) - w t + phase), grown over ``ramp`` seconds."""

    #: [m]; shape (c,).
    amplitude: Array
    #: [rad/s]; shape (c,).
    omega: Array
    #: [1/m]; shape (c,).
    wave_number: Array
    #: Headings [rad]; shape (c,).
    heading: Array
    #: Phases [rad]; shape (c,).
    phase: Array
    #: Half a cosine from the time 0 [s].
    ramp: float = 0.0


@dataclass(frozen=True, eq=False)
class Surface3D:
    """Water surface over time that does not change along y: ``x`` [m], ``elevation`` [m] of shape (frames, x)."""

    x: Array
    elevation: Array


@dataclass(frozen=True, eq=False)
class Scene3D:
    """What is shown."""

    #: Increasing [s]; shape (frames,).
    time: Array
    #: Nodes, z up from still water [m]; shape (frames, n, 3).
    position: Array
    #: Nodes that they join; shape (m, 2).
    bars: IntArray
    #: [N]; shape (frames, m).
    tension: Array
    #: Bars drawn thin (twines of a net, edges of a sheet); shape (m,).
    thin: NDArray[np.bool_] | None = None
    #: Faces besides the bars.
    faces: tuple[Faces, ...] = ()
    #: Markers besides the bars.
    markers: tuple[Marker, ...] = ()
    #: Bodies besides the bars.
    bodies: tuple[Body3D, ...] = ()
    #: Tensions of lines over time, under the picture; the highest are kept.
    traces: tuple[Trace, ...] = ()
    #: Moving surface; still water when left out.
    waves: Waves3D | Surface3D | None = None
    #: Elevation of the bed [m]; none when left out.
    bed: float | None = None
    #: Whether the water is drawn at all.
    has_water: bool = True
    #: Velocity at the surface along x and y [m/s], for an arrow.
    current: tuple[float, float] = (0.0, 0.0)
    #: Tension at or below which a bar is drawn slack [N].
    slack_level: float = 0.0
    #: Tension of the last colour [N]; NaN: the highest of bars and traces.
    full_scale: float = math.nan
    #: Part that is played at first [s].
    window: tuple[float, float] | None = None
    #: Time of the governing maximum [s]; NaN: that of the traces, or of the bars.
    maximum: float = math.nan
    #: Line that each bar belongs to, shown under the pointer.
    names: tuple[str, ...] = field(default=())
    #: Nothing moves: no transport is shown.
    is_still: bool = False

    def __post_init__(self) -> None:
        frames, nodes = len(self.time), self.position.shape[1] if self.position.ndim == 3 else -1
        for name, good in (
            ("time", frames >= 2 and bool(np.all(np.diff(self.time) > 0.0))),
            ("position", self.position.shape == (frames, nodes, 3) and bool(np.isfinite(self.position).all())),
            ("bars", self.bars.shape == (self.tension.shape[1], 2)),
            ("tension", self.tension.shape[0] == frames),
            ("names", len(self.names) in (0, len(self.bars))),
        ):
            if not good:
                raise InputError(f"the scene has no proper {name}", path=name, allowed="two frames or more, finite")

    @property
    def scale(self) -> float:
        """Tension of the last colour [N]."""
        if math.isfinite(self.full_scale):
            return self.full_scale
        highest = [float(np.nanmax(self.tension, initial=0.0)), *(float(np.nanmax(t.tension)) for t in self.traces)]
        return max(highest) or 1.0

    @property
    def moment(self) -> float:
        """Time of the governing maximum [s]."""
        if math.isfinite(self.maximum):
            return self.maximum
        if self.traces:
            best = max(self.traces, key=lambda trace: float(np.nanmax(trace.tension)))
            return float(best.time[int(np.nanargmax(best.tension))])
        if self.tension.size:
            return float(self.time[int(np.nanargmax(np.nanmax(self.tension, axis=1)))])
        return float(self.time[0])

    def box(self) -> tuple[Array, Array]:
        """Return the lowest and highest corner of all that ever is there [m]."""
        parts = [self.position.reshape(-1, 3)]
        for body in self.bodies:
            reach = float(np.max(np.linalg.norm(body.vertices, axis=1)))
            parts += [body.origin - reach, body.origin + reach]
        every = np.concatenate(parts)
        return every.min(axis=0), every.max(axis=0)


def frame_rows(
    time: Array, *, nodes: int, bars: int, window: tuple[float, float] | None = None, moments: Sequence[float] = ()
) -> IntArray:
    """Return the rows of a record that become frames: evenly spaced, two thirds of them in the window.

    Parameters
    ----------
    time : ndarray
        Of the rows [s].
    nodes, bars : int
        How much a frame holds; the fewer frames the more it holds.
    window : tuple of float, optional
        Part that is shown first [s].
    moments : sequence of float
        Times whose nearest rows must be among the frames [s].
    """
    rows = time.size
    budget = int(np.clip(BYTES_OF_MOTION / max(6 * nodes + bars, 1), FEWEST_FRAMES, MOST_FRAMES))
    if rows <= budget:
        return np.arange(rows, dtype=np.int64)
    chosen = [np.array([0, rows - 1])]
    if window is None:
        chosen.append(np.linspace(0, rows - 1, budget))
    else:
        first, last = np.searchsorted(time, window).clip(0, rows - 1)
        inside = min(2 * budget // 3, last - first + 1)
        chosen += [np.linspace(first, last, inside), np.linspace(0, rows - 1, budget - inside)]
    chosen.append(np.array([int(np.argmin(np.abs(time - moment))) for moment in moments if math.isfinite(moment)]))
    return np.unique(np.rint(np.concatenate(chosen)).astype(np.int64))


def _levels(values: Array, slack: float, scale: float) -> dict[str, Any]:
    """Pack loads as 0 for slack and 1 to 255 for the rest."""
    taut = 1.0 + 254.0 * np.clip(np.nan_to_num(values) / scale, 0.0, 1.0)
    levels = np.where(values > slack, np.rint(taut), 0.0).astype(np.uint8)
    return {"u1": base64.b64encode(levels.tobytes()).decode("ascii"), "columns": max(values.shape[1], 1)}


def _names(names: tuple[str, ...]) -> dict[str, Any]:
    """Return the different names, and which of them each bar has."""
    place = {name: number for number, name in enumerate(dict.fromkeys(names))}
    return {"names": list(place), "named": [place[name] for name in names]}


def _trace(trace: Trace) -> dict[str, Any]:
    keep = envelope_indices(trace.tension, POINTS_OF_A_TRACE // 2)
    return {
        "name": trace.name,
        "time": encode_array(trace.time[keep]),
        "tension": encode_array(trace.tension[keep]),
        "bar": int(trace.bar),
        "maximum": float(np.nanmax(trace.tension)),
        "breaking": float(trace.breaking_load) if math.isfinite(trace.breaking_load) else None,
    }


def _waves(waves: Waves3D | Surface3D | None) -> dict[str, Any] | None:
    if waves is None:
        return None
    if isinstance(waves, Surface3D):
        return {"x": encode_array(waves.x), "elevation": encode_quantised(waves.elevation)}
    keep = np.argsort(-np.abs(waves.amplitude))[:MOST_COMPONENTS]
    # what is left out would flatten the surface: the kept components carry its energy
    lost = float(np.sum(waves.amplitude**2)) / max(float(np.sum(waves.amplitude[keep] ** 2)), 1e-300)
    return {
        "amplitude": encode_array(waves.amplitude[keep] * math.sqrt(lost)),
        **{name: encode_array(getattr(waves, name)[keep]) for name in ("omega", "wave_number", "heading", "phase")},
        "ramp": waves.ramp,
    }


def home_view(low: Array, high: Array) -> tuple[float, float]:
    """Return yaw and pitch of the first view: across the longer horizontal side, from a little above [rad]."""
    size = high - low
    flat = min(size[0], size[1]) < 0.05 * max(size[0], size[1], 1e-12)
    turn = 0.42 if flat else 0.62
    along_y = size[1] > 1.5 * size[0]
    return (0.5 * math.pi - turn if along_y else -turn), (0.22 if flat else 0.36)


def scene_3d(scene: Scene3D) -> dict[str, Any]:
    """Return the JSON-ready scene for the player.

    Parameters
    ----------
    scene : Scene3D

    Returns
    -------
    dict
        For :class:`moyai.report.document.Animation`.
    """
    frames, nodes = scene.position.shape[:2]
    low, high = scene.box()
    unit = display_unit("N", scene.scale)
    yaw, pitch = home_view(low, high)
    traces = sorted(scene.traces, key=lambda trace: -float(np.nanmax(trace.tension)))[:MOST_TRACES]
    span = scene.window or (float(scene.time[0]), float(scene.time[-1]))
    length = span[1] - span[0]
    # one pass through the first part in about twenty seconds, never quicker than life by more than twice
    speed = next((value for value in (2.0, 1.0, 0.5, 0.25, 0.1, 0.05, 0.02) if length / value >= 14.0), 0.02)
    return {
        "kind": "scene-3d",
        "times": encode_array(scene.time),
        "nodes": {**encode_quantised(scene.position.reshape(frames * nodes, 3)), "count": nodes},
        "bars": [int(k) for k in scene.bars.ravel()],
        "thin": None if scene.thin is None else [int(k) for k in scene.thin],
        "tension": _levels(scene.tension, scene.slack_level, scene.scale),
        "scale": scene.scale,
        **_names(scene.names),
        "unit": unit.name,
        "factor": unit.factor,
        "faces": [_faces(faces) for faces in scene.faces],
        "markers": [
            {"node": marker.node, "name": marker.name, "kind": marker.kind, "diameter": marker.diameter}
            for marker in scene.markers
        ],
        "bodies": [
            {
                "name": body.name,
                "vertices": encode_array(body.vertices),
                "faces": [[int(k) for k in face] for face in body.faces],
                "pose": encode_quantised(np.concatenate([body.origin, body.rotation.reshape(frames, 9)], axis=1)),
            }
            for body in scene.bodies
        ],
        "traces": [_trace(trace) for trace in traces],
        "waves": _waves(scene.waves),
        "water": scene.has_water,
        "current": [float(value) for value in scene.current],
        "bed": scene.bed,
        "box": [[float(value) for value in low], [float(value) for value in high]],
        "home": [yaw, pitch],
        "extents": {"3-D": [], "Side": [], "End": [], "Plan": []},
        "window": [float(span[0]), float(span[1])],
        "start": scene.moment,
        "maximum": scene.moment,
        "speed": speed,
        "still": scene.is_still,
    }


def _faces(faces: Faces) -> dict[str, Any]:
    corners = np.asarray(faces.nodes, dtype=np.int64)
    load = None
    if faces.load is not None and faces.load.size:
        most = float(np.nanmax(faces.load, initial=0.0)) or 1.0
        unit = display_unit(faces.load_unit, most)
        load = {"levels": _levels(faces.load, 0.0, most), "scale": most, "unit": unit.name, "factor": unit.factor}
    return {
        "name": faces.name,
        "kind": faces.kind,
        "corners": int(corners.shape[1]),
        "nodes": [int(k) for k in corners.ravel()],
        "load": load,
    }
