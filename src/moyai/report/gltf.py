"""Structures in space over time as glTF 2.0 (``.glb``): a file for slides, viewers and Blender, SI units, y up.

Lines are tubes, a node a bar, moved by translation, rotation and scale; rigid bodies are nodes as well. Sheets, nets
and the water surface are meshes moved by morph targets, one a moment. What is slow in a viewer is thinned: twines of a
net are left to its faces where there are many.
"""

from __future__ import annotations

import json
import math
import struct
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from moyai.core.arrays import Array, IntArray
from moyai.report.document import Animation, Document
from moyai.report.encoding import unique_slugs
from moyai.report.scene_3d import Faces, Scene3D
from moyai.report.still_3d import display_box, load_colour, surface_elevation

#: Moments of a file at most; of meshes that change their shape.
MOMENTS, SHAPES = 240, 60
#: Bars drawn as tubes at most; sides of a tube; squares along an edge of the water.
TUBES, SIDES, SQUARES = 800, 8, 24
#: Classes of tension that have a colour; radius of a tube over the size of the structure.
CLASSES, RADIUS = 8, 0.0025
_FLOAT, _SHORT, _POINTS, _INDICES = 5126, 5125, 34962, 34963
_COLOURS: dict[str, tuple[float, float, float, float]] = {
    "sheet": (0.71, 0.33, 0.04, 0.85), "net": (0.25, 0.49, 0.31, 0.45), "body": (0.8, 0.82, 0.85, 1.0),
    "water": (0.12, 0.48, 0.69, 0.35), "bed": (0.8, 0.75, 0.66, 1.0), "anchor": (0.1, 0.14, 0.19, 1.0),
    "float": (0.95, 0.71, 0.27, 1.0), "clump": (0.36, 0.4, 0.46, 1.0), "joint": (0.36, 0.4, 0.46, 1.0),
    "driven": (0.7, 0.15, 0.12, 1.0),
}  # fmt: skip


def document_gltf(document: Document) -> Iterator[tuple[str, bytes]]:
    """Yield name and content of a file for every structure in space of a document.

    Parameters
    ----------
    document : Document

    Yields
    ------
    str, bytes
        ``<key>.glb``, which plays from the beginning of the part that the page shows first.
    """
    shown = [(block, block.scene_3d) for block in document.blocks() if isinstance(block, Animation)]
    known = [(block, scene) for block, scene in shown if isinstance(scene, Scene3D)]
    for name, (block, scene) in zip(unique_slugs(block.key for block, _ in known), known, strict=True):
        yield f"{name}.glb", scene_glb(scene, block.title)


def scene_glb(scene: Scene3D, title: str = "") -> bytes:
    """Return a scene as binary glTF 2.0.

    Parameters
    ----------
    scene : Scene3D
    title : str

    Notes
    -----
    Colours of tubes are those of the highest tension in the part that is played: a material cannot change in time.
    """
    file = _File()
    rows = _rows(scene)
    low, high, water, bed = display_box(scene)
    clock = None if len(rows) < 2 else file.add(scene.time[rows] - scene.time[rows[0]], "SCALAR")
    _tubes(file, scene, rows, clock, RADIUS * float(np.max(high - low)))
    _bodies(file, scene, rows, clock)
    _marks(file, scene, rows, clock, 0.006 * float(np.max(high - low)))
    shapes = rows[np.unique(np.linspace(0, len(rows) - 1, min(len(rows), SHAPES)).round().astype(int))]
    for faces in scene.faces:
        places, corners = _triangles(scene, faces, shapes)
        file.mesh(faces.name, places, corners, faces.kind, scene.time[shapes] - scene.time[rows[0]])
    if water:
        still = scene.waves is None or scene.is_still
        moments = shapes[:1] if still else shapes
        places, corners = _surface(scene, moments, low, high)
        file.mesh("water", places, corners, "water", scene.time[moments] - scene.time[rows[0]])
    if bed and scene.bed is not None:
        x, y = (low[0], high[0], high[0], low[0]), (low[1], low[1], high[1], high[1])
        places = np.stack([x, y, np.full(4, scene.bed)], axis=1)[None]
        file.mesh("bed", places, np.array([[0, 1, 2], [0, 2, 3]]), "bed", scene.time[:1])
    return file.written(title)


def _rows(scene: Scene3D) -> IntArray:
    """Return the moments that are played: the part that the page shows first, evenly spaced."""
    if scene.is_still:
        return np.zeros(1, dtype=np.int64)
    first, last = scene.window or (float(scene.time[0]), float(scene.time[-1]))
    inside = np.flatnonzero((scene.time >= first - 1e-9) & (scene.time <= last + 1e-9))
    inside = inside if inside.size > 1 else np.arange(len(scene.time))
    chosen = np.linspace(0, inside.size - 1, min(inside.size, MOMENTS)).round().astype(int)
    return np.asarray(inside[np.unique(chosen)], dtype=np.int64)


@dataclass
class _File:
    """The parts of a file as they are added."""

    nodes: list[dict[str, Any]] = field(default_factory=lambda: [{"name": "z up", "children": []}])
    meshes: list[dict[str, Any]] = field(default_factory=list)
    accessors: list[dict[str, Any]] = field(default_factory=list)
    views: list[dict[str, Any]] = field(default_factory=list)
    channels: list[dict[str, Any]] = field(default_factory=list)
    samplers: list[dict[str, Any]] = field(default_factory=list)
    materials: dict[tuple[float, float, float, float], int] = field(default_factory=dict)
    data: bytearray = field(default_factory=bytearray)

    def add(self, values: ArrayLike, kind: str, target: int = 0) -> int:
        """Add numbers and return the index of their accessor."""
        array = np.ascontiguousarray(values, dtype=np.uint32 if target == _INDICES else np.float32)
        view: dict[str, Any] = {"buffer": 0, "byteOffset": len(self.data), "byteLength": array.nbytes}
        self.views.append(view | ({"target": target} if target else {}))
        self.data += array.tobytes()
        flat = array.reshape(len(array), -1) if kind != "SCALAR" else array.reshape(-1, 1)
        self.accessors.append(
            {
                "bufferView": len(self.views) - 1,
                "componentType": _SHORT if target == _INDICES else _FLOAT,
                "count": len(flat),
                "type": kind,
                "min": flat.min(axis=0).tolist(),
                "max": flat.max(axis=0).tolist(),
            }
        )
        return len(self.accessors) - 1

    def material(self, colour: tuple[float, float, float, float]) -> int:
        """Return the index of the material of a colour."""
        return self.materials.setdefault(colour, len(self.materials))

    def node(self, mesh: int, name: str, **place: Any) -> int:
        """Add a part and return its index."""
        self.nodes.append({"mesh": mesh, "name": name, **place})
        self.nodes[0]["children"].append(len(self.nodes) - 1)
        return len(self.nodes) - 1

    def form(self, points: Array, triangles: ArrayLike, material: int) -> int:
        """Add a mesh that keeps its shape and return its index."""
        at = {"POSITION": self.add(points, "VEC3", _POINTS)}
        self.meshes.append({"primitives": [self._primitive(at, triangles, material)]})
        return len(self.meshes) - 1

    def _primitive(self, attributes: dict[str, int], triangles: ArrayLike, material: int) -> dict[str, Any]:
        corners = self.add(np.ravel(triangles), "SCALAR", _INDICES)
        return {"attributes": attributes, "indices": corners, "material": material, "mode": 4}

    def mesh(self, name: str, places: Array, triangles: ArrayLike, kind: str, time: Array) -> None:
        """Add a mesh whose points are given at each moment; shape (moments, n, 3)."""
        at = {"POSITION": self.add(places[0], "VEC3", _POINTS)}
        primitive = self._primitive(at, triangles, self.material(_COLOURS[kind]))
        mesh: dict[str, Any] = {"name": name, "primitives": [primitive]}
        moved = places[1:] - places[0]
        if len(moved):
            primitive["targets"] = [{"POSITION": self.add(step, "VEC3", _POINTS)} for step in moved]
            mesh["weights"] = [0.0] * len(moved)
        self.meshes.append(mesh)
        node = self.node(len(self.meshes) - 1, name)
        if len(moved):
            # at each moment one shape alone: between two of them the points go straight
            weights = np.eye(len(places))[:, 1:]
            self.move(node, "weights", self.add(time, "SCALAR"), self.add(weights.ravel(), "SCALAR"))

    def move(self, node: int, path: str, clock: int, values: int) -> None:
        """Move a node along values at the times of a clock."""
        self.samplers.append({"input": clock, "output": values, "interpolation": "LINEAR"})
        self.channels.append({"sampler": len(self.samplers) - 1, "target": {"node": node, "path": path}})

    def written(self, title: str) -> bytes:
        """Return the file."""
        # z up becomes y up by a turn about x
        self.nodes[0]["rotation"] = [-math.sqrt(0.5), 0.0, 0.0, math.sqrt(0.5)]
        self.data += bytes(-len(self.data) % 4)
        content: dict[str, Any] = {
            "asset": {"version": "2.0", "generator": "moyai"},
            "scene": 0,
            "scenes": [{"name": title, "nodes": [0]}],
            "nodes": self.nodes,
            "meshes": self.meshes,
            "materials": [_material(colour) for colour in self.materials],
            "accessors": self.accessors,
            "bufferViews": self.views,
            "buffers": [{"byteLength": len(self.data)}],
        }
        if self.channels:
            content["animations"] = [{"name": title, "channels": self.channels, "samplers": self.samplers}]
        text = json.dumps(content, separators=(",", ":")).encode("utf-8")
        text += b" " * (-len(text) % 4)
        size = 12 + 8 + len(text) + 8 + len(self.data)
        return b"".join(
            [
                struct.pack("<4sII", b"glTF", 2, size),
                struct.pack("<I4s", len(text), b"JSON"), text,
                struct.pack("<I4s", len(self.data), b"BIN\0"), bytes(self.data),
            ]
        )  # fmt: skip


def _material(colour: tuple[float, float, float, float]) -> dict[str, Any]:
    surface = {"baseColorFactor": list(colour), "metallicFactor": 0.0, "roughnessFactor": 0.8}
    clear = {"alphaMode": "BLEND"} if colour[3] < 1.0 else {}
    return {"pbrMetallicRoughness": surface, "doubleSided": True, **clear}


def _tubes(file: _File, scene: Scene3D, rows: IntArray, clock: int | None, radius: float) -> None:
    """Add every bar as a tube between its ends, coloured by its highest tension."""
    thin = np.zeros(len(scene.bars), dtype=bool) if scene.thin is None else scene.thin
    many = len(thin) > TUBES and bool(scene.faces)
    shown = np.flatnonzero(~thin) if many else np.arange(len(thin))
    shown = shown[np.unique(np.linspace(0, len(shown) - 1, min(len(shown), TUBES)).round().astype(int))]
    names = scene.names or ("bar",) * len(scene.bars)
    highest = np.nan_to_num(scene.tension[rows]).max(axis=0, initial=0.0)
    meshes: dict[tuple[int, bool], int] = {}
    for bar in shown.tolist():
        ends = scene.position[rows][:, scene.bars[bar]]
        class_ = min(int(CLASSES * highest[bar] / scene.scale), CLASSES - 1)
        look = class_, bool(thin[bar])
        if look not in meshes:
            colour = _rgba(load_colour((class_ + 0.5) / CLASSES))
            meshes[look] = file.form(*_tube(0.4 * radius if look[1] else radius), file.material(colour))
        along = ends[:, 1] - ends[:, 0]
        length = np.linalg.norm(along, axis=1)
        turn, size = _turns(along, length), np.stack([np.ones_like(length), np.ones_like(length), length], axis=1)
        place = {"translation": ends[0, 0].tolist(), "rotation": turn[0].tolist(), "scale": size[0].tolist()}
        node = file.node(meshes[look], names[bar], **place)
        if clock is not None:
            for path, values, kind in (
                ("translation", ends[:, 0], "VEC3"), ("rotation", turn, "VEC4"), ("scale", size, "VEC3"),
            ):  # fmt: skip
                file.move(node, path, clock, file.add(values, kind))


def _tube(radius: float) -> tuple[Array, NDArray[np.int64]]:
    """Return points and triangles of an open tube of length 1 along z."""
    angle = 2.0 * math.pi * np.arange(SIDES) / SIDES
    ring = radius * np.stack([np.cos(angle), np.sin(angle), np.zeros(SIDES)], axis=1)
    here, following = np.arange(SIDES), np.roll(np.arange(SIDES), -1)
    lower = np.stack([here, following, following + SIDES], axis=1)
    upper = np.stack([here, following + SIDES, here + SIDES], axis=1)
    return np.concatenate([ring, ring + np.array([0.0, 0.0, 1.0])]), np.concatenate([lower, upper])


def _turns(along: Array, length: Array) -> Array:
    """Return quaternions (x, y, z, w) that turn the z axis along vectors, each on the side of the one before."""
    unit = along / np.maximum(length, 1e-12)[:, None]
    unit[length < 1e-12] = (0.0, 0.0, 1.0)
    # half the way from z: (z x u, 1 + z u); straight down it turns about x
    found = np.stack([-unit[:, 1], unit[:, 0], np.zeros(len(unit)), 1.0 + unit[:, 2]], axis=1)
    found[found[:, 3] < 1e-9] = (1.0, 0.0, 0.0, 0.0)
    return _steady(found / np.linalg.norm(found, axis=1)[:, None])


def _steady(turns: Array) -> Array:
    """Return quaternions whose sign does not jump, so that the way between two is the short one."""
    jumps = np.where(np.sum(turns[1:] * turns[:-1], axis=1) < 0.0, -1.0, 1.0)
    signs: Array = np.concatenate([[1.0], np.cumprod(jumps)])[:, None]
    return np.asarray(turns * signs)


def _bodies(file: _File, scene: Scene3D, rows: IntArray, clock: int | None) -> None:
    from scipy.spatial.transform import Rotation

    for body in scene.bodies:
        corners = [[face[0], face[k], face[k + 1]] for face in body.faces for k in range(1, len(face) - 1)]
        mesh = file.form(np.asarray(body.vertices, dtype=float), corners, file.material(_COLOURS["body"]))
        turn = _steady(Rotation.from_matrix(np.asarray(body.rotation)[rows]).as_quat())
        origin = np.asarray(body.origin)[rows]
        node = file.node(mesh, body.name, translation=origin[0].tolist(), rotation=turn[0].tolist())
        if clock is not None:
            file.move(node, "translation", clock, file.add(origin, "VEC3"))
            file.move(node, "rotation", clock, file.add(turn, "VEC4"))


def _marks(file: _File, scene: Scene3D, rows: IntArray, clock: int | None, least: float) -> None:
    """Add anchors, floats and weights as octahedra, or balls of their size."""
    meshes: dict[str, int] = {}
    for mark in scene.markers:
        if mark.kind == "joint" and mark.diameter <= 0.0:
            continue
        if mark.kind not in meshes:
            meshes[mark.kind] = file.form(*_ball(), file.material(_COLOURS[mark.kind]))
        size = [max(0.5 * mark.diameter, least)] * 3
        way = scene.position[rows, mark.node]
        node = file.node(meshes[mark.kind], mark.name, translation=way[0].tolist(), scale=size)
        if clock is not None and np.ptp(way, axis=0).max() > 0.0:
            file.move(node, "translation", clock, file.add(way, "VEC3"))


def _ball() -> tuple[Array, NDArray[np.int64]]:
    """Return points and triangles of a ball of radius 1."""
    angle, count = np.linspace(0.0, math.pi, 7), 12
    around = 2.0 * math.pi * np.arange(count) / count
    points = np.array(
        [[math.sin(a) * math.cos(b), math.sin(a) * math.sin(b), math.cos(a)] for a in angle for b in around]
    )
    squares = [(r * count + c, r * count + (c + 1) % count) for r in range(6) for c in range(count)]
    triangles = [corner for k, n in squares for corner in ((k, k + count, n), (n, k + count, n + count))]
    return points, np.array(triangles, dtype=np.int64)


def _triangles(scene: Scene3D, faces: Faces, rows: IntArray) -> tuple[Array, NDArray[np.int64]]:
    """Return the points of faces at each moment and their triangles, with the points that they use alone."""
    corners = np.asarray(faces.nodes, dtype=np.int64)
    if corners.shape[1] == 4:
        corners = np.concatenate([corners[:, [0, 1, 2]], corners[:, [0, 2, 3]]])
    used, numbered = np.unique(corners, return_inverse=True)
    return scene.position[rows][:, used], numbered.reshape(corners.shape)


def _surface(scene: Scene3D, rows: IntArray, low: Array, high: Array) -> tuple[Array, NDArray[np.int64]]:
    """Return the water surface at each moment over the box that the page shows."""
    x, y = (np.linspace(low[axis], high[axis], SQUARES + 1) for axis in (0, 1))
    across, along = (grid.ravel() for grid in np.meshgrid(x, y, indexing="ij"))
    places = [np.stack([across, along, surface_elevation(scene, int(row), across, along)], axis=1) for row in rows]
    first = (np.arange(SQUARES)[:, None] * (SQUARES + 1) + np.arange(SQUARES)).ravel()
    step = SQUARES + 1
    lower = np.stack([first, first + step, first + step + 1], axis=1)
    return np.stack(places), np.concatenate([lower, np.stack([first, first + step + 1, first + 1], axis=1)])


def _rgba(colour: str) -> tuple[float, float, float, float]:
    """Return a colour of a page in the linear numbers of glTF."""
    parts = [int(colour[k : k + 2], 16) / 255.0 for k in (1, 3, 5)]
    red, green, blue = (part / 12.92 if part <= 0.04045 else ((part + 0.055) / 1.055) ** 2.4 for part in parts)
    return red, green, blue, 1.0


__all__: Sequence[str] = ["document_gltf", "scene_glb"]
