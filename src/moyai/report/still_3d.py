"""One moment of a 3-D scene as SVG, for paper: the camera of the player, what is far drawn first."""

from __future__ import annotations

import math
from dataclasses import dataclass
from html import escape

import numpy as np

from moyai.core.arrays import Array
from moyai.report.formatting import display_unit, format_number
from moyai.report.scene_3d import Scene3D, Surface3D, home_view

WIDTH, HEIGHT, TOP, BOTTOM = 960.0, 520.0, 34.0, 34.0
_STOPS = np.array([[134, 170, 200], [84, 120, 180], [110, 76, 160], [176, 48, 116], [214, 48, 31]], dtype=float)
_INK, _MUTED, _WATER, _LINE, _BED, _SHEET, _BUOY = (
    "#1b2430", "#5b6775", "#cfe4f1", "#1f7ab0", "#cdbfa9", "#b4540a", "#f2b544",
)  # fmt: skip


def load_colour(fraction: float) -> str:
    """Return the colour of a tension from 0 to 1, as in the player."""
    place = min(max(fraction, 0.0), 0.9999) * (len(_STOPS) - 1)
    index = int(place)
    red, green, blue = _STOPS[index] + (place - index) * (_STOPS[index + 1] - _STOPS[index])
    return f"#{round(red):02x}{round(green):02x}{round(blue):02x}"


@dataclass(frozen=True, eq=False)
class _Camera:
    """Perspective onto the drawing: x, y in pixels and depth for points (..., 3)."""

    right: Array
    away: Array
    up: Array
    middle: Array
    distance: float
    scale: float = 1.0
    centre: tuple[float, float] = (0.0, 0.0)

    def project(self, points: Array) -> Array:
        relative = points - self.middle
        depth = relative @ self.away
        factor = self.scale * self.distance / np.maximum(self.distance + depth, 0.05 * self.distance)
        x = self.centre[0] + factor * (relative @ self.right)
        y = self.centre[1] - factor * (relative @ self.up)
        return np.stack([x, y, depth], axis=-1)


def display_box(scene: Scene3D) -> tuple[Array, Array, bool, bool]:
    """Return the box that is drawn, and whether surface and bed are in it (as the player decides)."""
    low, high = (np.array(corner) for corner in scene.box())
    size = high - low
    most = float(size.max()) or 1.0
    span = max(size[0], size[1], 0.5 * most)
    for axis in (0, 1):
        room = max(0.1 * span, 0.5 * (0.28 * span - size[axis]))
        low[axis] -= room
        high[axis] += room
    surface = scene.has_water and low[2] - 0.7 * most < 0.0 and -high[2] < 0.8 * most
    bed = scene.bed is not None and low[2] - scene.bed < 0.9 * most
    if surface:
        high[2] = max(high[2], 0.02 * most)
    low[2] = min(scene.bed, low[2]) if bed and scene.bed is not None else low[2] - 0.12 * most
    return low, high, surface, bed


def _camera(low: Array, high: Array, yaw: float, pitch: float) -> _Camera:
    cosine, sine, level, tilt = math.cos(yaw), math.sin(yaw), math.cos(pitch), math.sin(pitch)
    camera = _Camera(
        np.array([cosine, sine, 0.0]),
        np.array([-level * sine, level * cosine, -tilt]),
        np.array([-tilt * sine, tilt * cosine, level]),
        0.5 * (low + high),
        1.6 * float(np.linalg.norm(high - low)),
    )
    corners = np.array([[(low, high)[i >> k & 1][k] for k in range(3)] for i in range(8)])
    shown = camera.project(corners)
    left, right, top, bottom = shown[:, 0].min(), shown[:, 0].max(), shown[:, 1].min(), shown[:, 1].max()
    scale = min((WIDTH - 40.0) / (right - left), (HEIGHT - TOP - BOTTOM) / (bottom - top))
    centre = (0.5 * WIDTH - 0.5 * scale * (left + right), 0.5 * (HEIGHT + TOP - BOTTOM) - 0.5 * scale * (top + bottom))
    return _Camera(camera.right, camera.away, camera.up, camera.middle, camera.distance, scale, centre)


def _path(points: Array, attributes: str, *, closed: bool = False) -> str:
    data = "M" + "L".join(f"{x:.1f} {y:.1f}" for x, y in points[:, :2]) + ("Z" if closed else "")
    return f'<path d="{data}" {attributes}/>'


def surface_elevation(scene: Scene3D, row: int, x: Array, y: Array) -> Array:
    waves = scene.waves
    if waves is None:
        return np.zeros_like(x)
    if isinstance(waves, Surface3D):
        return np.asarray(np.interp(x, waves.x, waves.elevation[row]))
    time = float(scene.time[row])
    grown = 0.5 * (1.0 - math.cos(math.pi * max(time, 0.0) / waves.ramp)) if 0.0 <= time < waves.ramp else 1.0
    total = np.zeros_like(x)
    for a, w, k, b, p in zip(waves.amplitude, waves.omega, waves.wave_number, waves.heading, waves.phase, strict=True):
        total += a * np.cos(k * (x * math.cos(b) + y * math.sin(b)) - w * time + p)
    return grown * total


def still_3d(scene: Scene3D) -> str:
    """Draw the governing moment of a scene.

    Parameters
    ----------
    scene : Scene3D

    Returns
    -------
    str
        SVG that carries its colours.
    """
    row = int(np.argmin(np.abs(scene.time - scene.moment)))
    low, high, surface, bed = display_box(scene)
    camera = _camera(low, high, *home_view(*scene.box()))
    parts: list[str] = []
    if bed and scene.bed is not None:
        parts += _bed(scene.bed, low, high, camera)
    sea: list[str] = []
    if surface:
        walls, sea = _water(scene, row, low, high, camera)
        parts += walls
    things = _things(scene, row, camera)
    depth_of_water = 0.0 if surface else -math.inf
    parts += [text for _, level, text in things if level <= depth_of_water]
    parts += sea
    parts += [text for _, level, text in things if level > depth_of_water]
    parts += _legend(scene, row)
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH:.0f} {HEIGHT:.0f}" font-family="sans-serif" '
        f'font-size="13" stroke-linecap="round" stroke-linejoin="round">{"".join(parts)}</svg>'
    )


def _bed(level: float, low: Array, high: Array, camera: _Camera) -> list[str]:
    corners = np.array([[low[0], low[1], level], [high[0], low[1], level], [high[0], high[1], level],
                        [low[0], high[1], level]])  # fmt: skip
    return [
        _path(camera.project(corners), f'fill="{_BED}" fill-opacity="0.55" stroke="{_MUTED}" stroke-width="0.8"',
              closed=True)
    ]  # fmt: skip


def _water(scene: Scene3D, row: int, low: Array, high: Array, camera: _Camera) -> tuple[list[str], list[str]]:
    """Return the far walls of the water, and its surface with its edge."""
    count = 60
    u = np.linspace(0.0, 1.0, count + 1)
    corners = [(low[0], low[1]), (high[0], low[1]), (high[0], high[1]), (low[0], high[1])]
    normals = [(0.0, -1.0), (1.0, 0.0), (0.0, 1.0), (-1.0, 0.0)]
    edges, walls = [], []
    for side in range(4):
        a, b = np.array(corners[side]), np.array(corners[(side + 1) % 4])
        x, y = ((1.0 - u) * a[k] + u * b[k] for k in (0, 1))
        edge = camera.project(np.stack([x, y, surface_elevation(scene, row, x, y)], axis=1))
        edges.append(edge)
        if normals[side][0] * camera.away[0] + normals[side][1] * camera.away[1] > 1e-6:
            foot = camera.project(np.array([[b[0], b[1], low[2]], [a[0], a[1], low[2]]]))
            walls.append(_path(np.concatenate([edge, foot]), f'fill="{_WATER}" fill-opacity="0.6"', closed=True))
    rim = np.concatenate(edges)
    sheet = [_path(rim, f'fill="{_WATER}" fill-opacity="0.42" stroke="{_LINE}" stroke-width="1.3"', closed=True)]
    for share in np.linspace(0.0, 1.0, 13)[1:-1]:
        for along in (0, 1):
            place = np.full((count + 1, 2), 0.0)
            place[:, along] = low[along] + u * (high[along] - low[along])
            place[:, 1 - along] = low[1 - along] + share * (high[1 - along] - low[1 - along])
            line = np.column_stack([place, surface_elevation(scene, row, place[:, 0], place[:, 1])])
            style = f'fill="none" stroke="{_LINE}" stroke-width="0.5" stroke-opacity="0.25"'
            sheet.append(_path(camera.project(line), style))
    return walls, sheet


def _things(scene: Scene3D, row: int, camera: _Camera) -> list[tuple[float, float, str]]:
    """Return depth, height and drawing of faces, bars, bodies and markers, the farthest first."""
    place = scene.position[row]
    shown = camera.project(place)
    found: list[tuple[float, float, str]] = []
    for faces in scene.faces:
        top = float(np.nanmax(faces.load, initial=0.0)) or 1.0 if faces.load is not None else 1.0
        for number, nodes in enumerate(np.asarray(faces.nodes, dtype=np.int64)):
            load = float(faces.load[row, number]) if faces.load is not None else 0.0
            colour = load_colour(load / top) if load > 0.0 else (_LINE if faces.kind == "net" else _SHEET)
            opacity = 0.16 if faces.kind == "net" else 0.6
            style = f'fill="{colour}" fill-opacity="{opacity}"'
            found.append(
                (float(shown[nodes, 2].mean()), float(place[nodes, 2].mean()), _path(shown[nodes], style, closed=True))
            )
    for number, (i, j) in enumerate(scene.bars):
        pull = float(scene.tension[row, number])
        thin = scene.thin is not None and bool(scene.thin[number])
        fraction = pull / scene.scale
        if pull <= scene.slack_level:
            style = f'stroke="{_MUTED}" stroke-width="{0.7 if thin else 1.2}" stroke-dasharray="3 4"'
        else:
            width = 0.7 + 1.5 * fraction if thin else 1.7 + 2.6 * fraction
            style = f'stroke="{load_colour(fraction)}" stroke-width="{width:.2f}"'
        found.append((float(0.5 * (shown[i, 2] + shown[j, 2])), float(0.5 * (place[i, 2] + place[j, 2])),
                      _path(shown[[i, j]], style)))  # fmt: skip
    for body in scene.bodies:
        points = body.origin[row] + body.vertices @ body.rotation[row].T
        seen = camera.project(points)
        for face in body.faces:
            corners = list(face)
            style = f'fill="#eceff2" fill-opacity="0.92" stroke="{_INK}" stroke-width="1.1"'
            found.append((float(seen[corners, 2].mean()), float(points[corners, 2].mean()),
                          _path(seen[corners], style, closed=True)))  # fmt: skip
    for marker in scene.markers:
        x, y, depth = shown[marker.node]
        swims = 0.3 * marker.diameter if marker.kind == "float" else 0.0
        found.append(
            (
                float(depth) - 1e-6,
                float(place[marker.node, 2]) + swims,
                _sign(marker.kind, x, y, marker.diameter, camera),
            )
        )
    return sorted(found, key=lambda entry: -entry[0])


def _sign(kind: str, x: float, y: float, diameter: float, camera: _Camera) -> str:
    if kind == "anchor":
        return f'<path d="M{x:.1f} {y - 5:.1f}l5 9h-10z" fill="{_INK}"/>'
    if kind == "driven":
        return f'<circle cx="{x:.1f}" cy="{y:.1f}" r="4.5" fill="#fff" stroke="#0b5a8a" stroke-width="2"/>'
    if kind in ("float", "clump"):
        fill = _BUOY if kind == "float" else "#5a626c"
        radius = max(3.5, 0.5 * diameter * camera.scale)
        return f'<circle cx="{x:.1f}" cy="{y:.1f}" r="{radius:.1f}" fill="{fill}" stroke="{_INK}" stroke-width="0.8"/>'
    return f'<circle cx="{x:.1f}" cy="{y:.1f}" r="2.4" fill="{_INK}"/>'


def _legend(scene: Scene3D, row: int) -> list[str]:
    unit = display_unit("N", scene.scale)
    parts = [] if scene.is_still else [f'<text x="12" y="20" fill="{_INK}">t = {scene.time[row]:.2f} s</text>']
    long, x = 160.0, WIDTH - 176.0
    for k in range(40):
        parts.append(f'<rect x="{x + k * long / 40:.1f}" y="10" width="{long / 40 + 0.3:.1f}" height="7" '
                     f'fill="{load_colour(k / 40)}"/>')  # fmt: skip
    most = escape(f"{format_number(scene.scale * unit.factor)} {unit.name}")
    parts += [
        f'<text x="{x:.0f}" y="31" fill="{_MUTED}" font-size="12">0</text>',
        f'<text x="{x + long:.0f}" y="31" fill="{_MUTED}" font-size="12" text-anchor="end">{most}</text>',
        f'<text x="{x - 8:.0f}" y="18" fill="{_INK}" text-anchor="end">tension</text>',
        f'<path d="M{x - 122:.0f} 14h24" stroke="{_MUTED}" stroke-width="1.2" stroke-dasharray="3 4"/>',
        f'<text x="{x - 126:.0f}" y="18" fill="{_INK}" text-anchor="end">slack</text>',
    ]
    return parts
