"""The animated snap of a curtain: section at mid-span and plan, from release over the slack phase to the spike."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from moyai.core.arrays import Array
from moyai.report.animation import encode_track
from moyai.report.document import Animation
from moyai.report.encoding import encode_array
from moyai.report.formatting import display_unit, format_quantity
from moyai.report.reading import Group
from moyai.report.sketch import Sketch, with_colours
from moyai.structures.curtain.report.reading import CurtainLevel, key


def _shapes(snap: Group, view: str) -> Array | None:
    """Return the frames of a shape, first and second coordinate side by side (frames, 2 points); ``None`` if absent."""
    second = "y" if view == "plan" else "z"
    parts = [snap.real(f"frame_{view}_{axis}", "frame", f"{view}_point") for axis in ("x", second)]
    if any(part is None for part in parts):
        return None
    joined = np.concatenate([part for part in parts if part is not None], axis=1)
    return joined if np.isfinite(joined).all() else None


def snap_animation(level: CurtainLevel) -> Animation | None:
    """Return the animation, ``None`` where the result holds no frames."""
    snap = level.part("impact").child("snap")
    times, tension = snap.real("frame_time", "frame"), snap.real("frame_tension", "frame")
    plan = _shapes(snap, "plan")
    if times is None or tension is None or plan is None or times.size < 3 or not np.isfinite(tension).all():
        return None
    section = _shapes(snap, "section")
    position = snap.real("frame_position", "frame")
    if section is not None and position is not None:
        section = _carried(section, position)
    at = int(np.argmax(tension))
    boxes = {"plan": _plan_box(plan), "section": None if section is None else _section_box(section, level.depth)}
    peak, taut = float(times[at]), snap.number("taut_time")
    window = _window(times, peak, taut)
    unit = display_unit("N", float(np.max(tension)))
    plan_size = boxes["plan"][3] - boxes["plan"][2] if boxes["plan"] else 1.0
    scene: dict[str, Any] = {
        "kind": "curtain-snap",
        "times": encode_array(times),
        "tension": encode_array(tension),
        "position": None if position is None else encode_array(position),
        "taut_position": float(np.interp(taut, times, position))
        if position is not None and math.isfinite(taut)
        else None,
        "plan": encode_track(plan, plan_size / 800.0),
        "section": None if section is None else encode_track(section, _height(section) / 800.0),
        "plan_box": boxes["plan"],
        "section_box": boxes["section"],
        "bed": -level.depth if math.isfinite(level.depth) else None,
        "factor": unit.factor,
        "unit": unit.name,
        "extents": {
            name: [] for name in (("Section and plan", "Section", "Plan") if section is not None else ("Plan",))
        },
        "window": list(window),
        "start": peak,
        "maximum": peak,
        "speed": 0.25 if window[1] - window[0] < 8.0 else 1.0,
    }
    still = _still(plan[at], None if section is None else section[at], boxes, level)
    return Animation(
        key(level, "snap-animation"),
        "Animated snap",
        scene,
        f"Release in the current, to scale; opened at the spike, t = {peak:.2f} s, "
        f"{format_quantity(float(tension[at]), 'N')}. "
        "The colour grows with the tension of both cables, grey is slack; displacements are not enlarged.",
        picture=with_colours(still),
    )


def _carried(section: Array, position: Array) -> Array:
    """Return sections that stand where mid-span is; sections stored from their own float are moved there."""
    points = section.shape[1] // 2
    if np.ptp(section[:, 0]) > 1e-9 * max(float(np.ptp(position)), 1e-12):
        return section
    moved = section.copy()
    moved[:, :points] += (position - section[:, 0])[:, None]
    return moved


def _height(section: Array) -> float:
    return max(float(np.ptp(section[:, section.shape[1] // 2 :])), 1e-6)


def _plan_box(plan: Array) -> list[float]:
    """Return y from, y to, -x from, -x to of all frames, with room for arrows above."""
    points = plan.shape[1] // 2
    y, x = plan[:, points:], plan[:, :points]
    span = max(float(np.ptp(y)), 1e-6)
    return [
        float(y.min()) - 0.06 * span,
        float(y.max()) + 0.06 * span,
        -max(float(x.max()), 0.0) - 0.08 * span,
        max(-float(x.min()), 0.0) + 0.16 * span,
    ]


def _section_box(section: Array, depth: float) -> list[float]:
    points = section.shape[1] // 2
    x, z = section[:, :points], section[:, points:]
    height = depth if math.isfinite(depth) else 1.3 * float(-z.min())
    width = max(float(np.ptp(x)), 0.3 * height)
    middle = 0.5 * float(x.max() + x.min())
    return [middle - 0.75 * width, middle + 0.75 * width, -1.06 * height, 0.14 * height]


def _window(times: Array, peak: float, taut: float) -> tuple[float, float]:
    """Return the part that is played at first: the end of the slack phase, the spike and what follows."""
    first, last = float(times[0]), float(times[-1])
    if not math.isfinite(taut):
        return first, last
    rise = max(peak - taut, 1e-3)
    before = max(0.1 * (taut - first), 2.0 * rise)
    return max(first, taut - before), min(last, peak + max(before, 8.0 * rise))


def _still(plan: Array, section: Array | None, boxes: dict[str, list[float] | None], level: CurtainLevel) -> str:
    """Draw the moment of the spike for paper: section on the left, plan on the right."""
    plan_box, section_box = boxes["plan"], boxes["section"]
    assert plan_box is not None
    points = plan.size // 2
    top = Sketch(
        (plan_box[0], plan_box[1], plan_box[2], plan_box[3]),
        width=620.0,
        margin=(4, 4, 4, 4),
        title="Plan at the spike",
    )
    top.rectangle(plan_box[0], plan_box[3], plan_box[1], plan_box[2], "water")
    turned = np.column_stack([plan[points:], -plan[:points]])
    top.path(turned[[0, -1]], "chord")
    top.path(turned, "sheet")
    for x, y in turned[[0, -1]]:
        top.dot(float(x), float(y), 5.0, "buoy")
    if section is None or section_box is None:
        return top.svg()
    side = Sketch(
        (section_box[0], section_box[1], section_box[2], section_box[3]),
        width=330.0,
        margin=(4, 4, 4, 4),
        title="Section at the spike",
    )
    side.rectangle(section_box[0], 0.0, section_box[1], max(section_box[2], -level.depth), "water")
    if math.isfinite(level.depth):
        side.rectangle(section_box[0], -level.depth, section_box[1], section_box[2], "bed")
    side.path(np.array([[section_box[0], 0.0], [section_box[1], 0.0]]), "surface")
    n = section.size // 2
    side.path(np.column_stack([section[:n], section[n:]]), "sheet")
    side.dot(float(section[0]), float(section[n]), 6.0, "buoy")
    side.dot(float(section[n - 1]), float(section[-1]), 4.0, "marker")
    return side_by_side(side, top)


def side_by_side(left: Sketch, right: Sketch, gap: float = 10.0) -> str:
    """Return two drawings side by side as one, the taller one setting the height."""

    def inner(sketch: Sketch) -> str:
        svg = sketch.svg()
        return svg[svg.index(">") + 1 : svg.rindex("</svg>")]

    height = max(left.height, right.height)
    width = left.width + gap + right.width
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width:.0f} {height:.0f}" role="img" '
        f'font-family="Segoe UI, Helvetica, Arial, Noto Sans CJK JP, sans-serif">{inner(left)}'
        f'<g transform="translate({left.width + gap:.1f} 0)">{inner(right)}</g></svg>'
    )
