"""A structure in space as drawings to scale: in space, in plan and in elevation, each part by the role it plays."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from moyai.core.arrays import Array
from moyai.report.document import Disc, Drawing, Shape, Stroke, Words
from moyai.report.formatting import format_number, trimmed
from moyai.report.scene_3d import Marker, Scene3D
from moyai.report.sketch import Sketch

#: Roles of what a cage calls its parts; other names are those of lines
_ROLES = {"net": "net", "collar": "buoy", "bracket": "buoy", "sinker tube": "weight"}
_SIGNS = {"anchor": "anchor", "float": "buoy", "clump": "weight", "driven": "marker", "joint": "marker"}
#: Names that are written next to their lines, at most
_LABELS = 40
#: Radius of the sign of a point, and height of the words in space, over the size of the structure
_SIGN, _LETTERS = 0.004, 0.015
#: Floats, weights and joints whose names are written, at most
_FEW = 12
#: Half the sign of an anchor, and the shortest line that carries its name [px]
_SQUARE, _SHORTEST = 4.0, 70.0


@dataclass(frozen=True, eq=False)
class _Chain:
    """Bars of one line that follow each other."""

    name: str
    style: str
    points: Array


def _chains(scene: Scene3D) -> list[_Chain]:
    """Return the bars joined to lines as far as they follow each other."""
    names = scene.names or ("",) * len(scene.bars)
    thin = np.zeros(len(scene.bars), dtype=bool) if scene.thin is None else scene.thin
    found: list[tuple[str, str, list[int]]] = []
    for (start, end), name, fine in zip(scene.bars.tolist(), names, thin.tolist(), strict=True):
        style = _ROLES.get(name, "net" if fine else "mooring")
        if found and found[-1][:2] == (name, style) and found[-1][2][-1] == start:
            found[-1][2].append(end)
        else:
            found.append((name, style, [start, end]))
    place = scene.position[0]
    return [_Chain(name, style, place[nodes]) for name, style, nodes in found]


def _surfaces(scene: Scene3D) -> Iterator[tuple[str, str, Array]]:
    """Yield style, name and corners of every face of sheets, nets and bodies."""
    for faces in scene.faces:
        style = "net" if faces.kind == "net" else "sheet"
        for corners in np.asarray(faces.nodes, dtype=np.int64):
            yield style, faces.name, scene.position[0][corners]
    for body in scene.bodies:
        corners = body.vertices @ body.rotation[0].T + body.origin[0]
        for face in body.faces:
            yield "hull", body.name, corners[list(face)]


def _box(scene: Scene3D) -> tuple[Array, Array]:
    """Return the lowest and highest corner at rest, with a little around, bed and water."""
    points = [scene.position[0], *(corners for _, _, corners in _surfaces(scene))]
    every = np.concatenate(points)
    low, high = every.min(axis=0), every.max(axis=0)
    high[2] = max(high[2], 0.0)
    if scene.bed is not None:
        low[2] = min(low[2], scene.bed)
    pad = 0.06 * float(np.max(high - low))
    aside = np.array([pad, pad, 0.0])
    return low - aside, high + aside


def space_shapes(scene: Scene3D) -> tuple[Shape, ...]:
    """Return what is there at the first moment in space, with water level, bed and the names of points.

    Parameters
    ----------
    scene : Scene3D
    """
    found: list[Shape] = [Stroke(chain.style, chain.points, name=chain.name) for chain in _chains(scene)]
    found += [Stroke(style, corners, True, name) for style, name, corners in _surfaces(scene)]
    low, high = _box(scene)
    levels = [("surface", 0.0)] if scene.has_water else []
    levels += [] if scene.bed is None else [("bed-line", scene.bed)]
    for style, level in levels:
        corners = [
            (x, y, level) for x, y in ((low[0], low[1]), (high[0], low[1]), (high[0], high[1]), (low[0], high[1]))
        ]
        found.append(Stroke(style, np.array(corners), True))
    size = float(np.max(high - low))
    for mark in scene.markers:
        at = tuple(map(float, scene.position[0][mark.node]))
        found.append(Disc(_SIGNS[mark.kind], at, max(0.5 * mark.diameter, _SIGN * size)))
        found.append(Words("note", at, mark.name, _LETTERS * size, "start"))
    return tuple(found)


def plan_and_elevation(scene: Scene3D, key: str, title: str) -> tuple[Drawing, Drawing]:
    """Return the structure at its first moment seen from above and from the side, to scale.

    Parameters
    ----------
    scene : Scene3D
    key, title : str
        Of the view in space.

    Returns
    -------
    tuple of Drawing
        Plan (x to the right, y up) and elevation along the longer side, z up.
    """
    low, high = _box(scene)
    along = 0 if high[0] - low[0] >= high[1] - low[1] else 1
    return (
        _view(scene, (0, 1), f"{key}-plan", f"{title}: plan"),
        _view(scene, (along, 2), f"{key}-section", f"{title}: elevation along {'xy'[along]}"),
    )


def _view(scene: Scene3D, axes: tuple[int, int], key: str, title: str) -> Drawing:
    low, high = (corner[list(axes)] for corner in _box(scene))
    side = axes[1] == 2
    # words are as high as the width allows: a slender structure gets room at its sides
    room = 0.5 * max(0.75 * float(high[1] - low[1]) - float(high[0] - low[0]), 0.0)
    low[0], high[0] = low[0] - room, high[0] + room
    span = float(high[0] - low[0])
    under, over = (0.02 * span, 0.03 * span) if side else (0.0, 0.0)
    extent = (float(low[0]), float(high[0]), float(low[1]) - under, float(high[1]) + over)
    sketch = Sketch(extent, margin=(60.0, 30.0, 60.0, 50.0), title=title)
    if side:
        _levels(sketch, scene, extent)
    for style, _, corners in _surfaces(scene):
        sketch.path(corners[:, list(axes)], style, closed=True)
    chains = _chains(scene)
    for chain in chains:
        sketch.path(chain.points[:, list(axes)], chain.style)
    _signs(sketch, scene.markers, scene.position[0][:, list(axes)])
    _names(sketch, chains, axes)
    _overall(sketch, scene, axes, extent)
    _axes(sketch, "xyz"[axes[0]], "xyz"[axes[1]])
    sketch.label(20.0, 16.0, title, "start", size=14.0)
    return sketch.drawing(key, title)


def _levels(sketch: Sketch, scene: Scene3D, extent: tuple[float, float, float, float]) -> None:
    x0, x1 = extent[:2]
    if scene.has_water:
        sketch.path(np.array([[x0, 0.0], [x1, 0.0]]), "surface")
        sketch.level_mark(x1 - 0.03 * (x1 - x0), 0.0)
    if scene.bed is not None:
        sketch.path(np.array([[x0, scene.bed], [x1, scene.bed]]), "bed-line")


def _signs(sketch: Sketch, markers: Sequence[Marker], places: Array) -> None:
    half = _SQUARE / sketch.scale
    few = sum(mark.kind != "anchor" for mark in markers) <= _FEW
    for mark in markers:
        x, y = map(float, places[mark.node])
        style = _SIGNS[mark.kind]
        if mark.kind == "anchor":
            sketch.rectangle(x - half, y + half, x + half, y - half, style)
            sketch.text(x, y, mark.name, shift=(0.0, 16.0))
        elif mark.kind != "joint" or mark.diameter > 0.0:
            sketch.dot(x, y, max(0.5 * mark.diameter * sketch.scale, 3.0), style)
            if few:
                sketch.text(x, y, mark.name, shift=(8.0, -8.0), anchor="start")


def _names(sketch: Sketch, chains: Sequence[_Chain], axes: tuple[int, int]) -> None:
    """Write the name of each line once, at the middle of its longest part."""
    longest: dict[str, Array] = {}
    for chain in chains:
        if chain.style == "mooring" and chain.name and len(chain.points) >= len(longest.get(chain.name, ())):
            longest[chain.name] = chain.points
    for name, points in list(longest.items())[:_LABELS]:
        if float(np.max(np.ptp(points[:, list(axes)], axis=0))) * sketch.scale < _SHORTEST:
            continue
        half = len(points) // 2
        middle = points[half] if len(points) > 2 else points.mean(axis=0)
        sketch.text(float(middle[axes[0]]), float(middle[axes[1]]), name, shift=(6.0, -5.0), anchor="start", size=10.0)


def _overall(sketch: Sketch, scene: Scene3D, axes: tuple[int, int], extent: tuple[float, float, float, float]) -> None:
    """Measure the structure over all, and the depth."""
    every = np.concatenate([scene.position[0], *(corners for _, _, corners in _surfaces(scene))])[:, list(axes)]
    (left, low), (right, high) = every.min(axis=0), every.max(axis=0)
    below = (extent[2] - low) * sketch.scale
    sketch.dimension(float(left), float(low), float(right), float(low), _metres(right - left), offset=25.0 - below)
    if axes[1] == 2 and scene.bed is not None:
        sketch.dimension(extent[0], 0.0, extent[0], scene.bed, f"h = {_metres(-scene.bed)}", offset=-12.0)
        if low < scene.bed + 0.02 * (high - scene.bed):
            return
    if high - low > 0.01 * (right - left):
        beyond = (extent[1] - right) * sketch.scale
        sketch.dimension(float(right), float(high), float(right), float(low), _metres(high - low), offset=beyond + 10.0)


def _axes(sketch: Sketch, across: str, up: str) -> None:
    x, y = 14.0, sketch.height - 14.0
    for end, words in (((x + 34.0, y), across), ((x, y - 34.0), up)):
        sketch.arrow((x, y), end, "axis")
        sketch.label(end[0] + 6.0, end[1] + 4.0, words, "start", style="axis-text")


def _metres(length: float) -> str:
    return f"{trimmed(format_number(float(length), 4))} m"
