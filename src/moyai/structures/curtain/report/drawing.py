"""Drawings of a curtain to scale: section with floats, toe and current, plan with anchors, an anchor line."""

from __future__ import annotations

import math

import numpy as np

from moyai.core.arrays import Array
from moyai.report.document import Drawing
from moyai.report.formatting import format_number, format_quantity, trimmed
from moyai.report.sketch import Sketch
from moyai.structures.curtain.report.reading import GIVEN, CurtainLevel, curve, key

_FLOW_ARROWS = 9
_OBLIQUE = 0.05  # [rad] from the normal
_MOST_UPSTREAM = 0.55  # of the span: anchor lines that reach farther are cut, or the plan would not fit a page


def metres(length: float) -> str:
    """Return a length for a dimension line."""
    return f"{trimmed(format_number(length, 3))} m"


def section_curve(level: CurtainLevel, drag_case: str = GIVEN) -> Array | None:
    """Return the section of a curtain from the float to the toe, x downstream and z [m]."""
    return curve(level.part("section"), "section_x", "section_z", "section_point", drag_case=drag_case)


def plan_curve(level: CurtainLevel, drag_case: str = GIVEN) -> Array | None:
    """Return the plan of a curtain between the supports, x downstream and y [m]."""
    return curve(level.part("plan"), "plan_x", "plan_y", "plan_point", drag_case=drag_case)


def anchor_lines(level: CurtainLevel) -> list[tuple[Array, Array]]:
    """Return float and anchor (3,) [m] of every anchor line; none where the supports are fixed."""
    plan = level.part("plan")
    ends = [[plan.real(f"{end}_{axis}", "anchor") for axis in ("x", "y", "z")] for end in ("float", "anchor")]
    if any(values is None for end in ends for values in end):
        return []
    floats, anchors = (np.column_stack([v for v in end if v is not None]) for end in ends)
    good = np.isfinite(floats).all(axis=1) & np.isfinite(anchors).all(axis=1)
    return list(zip(floats[good], anchors[good], strict=True))


def drawings(level: CurtainLevel) -> list[Drawing]:
    """Return section, plan and, with anchors, the section with the anchor lines; absent where shapes are unknown."""
    found = []
    for name, title, sketch, caption in (
        (
            "section-drawing",
            "Section where the span faces the current most" if _oblique(level) else "Section at mid-span",
            section_drawing(level),
            "To scale, drag coefficient as given; dashes: ends of its range. Blue: current along the normal.",
        ),
        (
            "plan-drawing",
            "Plan",
            plan_drawing(level),
            "To scale, seen from above; y along the span, x downstream. Long anchor lines are cut.",
        ),
        ("anchor-drawing", "Section with an anchor line", anchor_drawing(level), "To scale; the line drawn straight."),
    ):
        if sketch is not None:
            found.append(sketch.drawing(key(level, name), title, caption))
    return found


def _oblique(level: CurtainLevel) -> bool:
    """Whether the current comes so far from the side that the most loaded section need not be at mid-span."""
    return abs(level.part("statics").value("flow_angle")) > _OBLIQUE


def section_drawing(level: CurtainLevel) -> Sketch | None:
    """Draw the section from the still water to the bed with effective depth, flare, toe gap and the current."""
    shape = section_curve(level)
    depth = level.depth
    if shape is None or not math.isfinite(depth):
        return None
    others = [other for case in ("low", "high") if (other := section_curve(level, case)) is not None]
    width = max(float(np.ptp(np.concatenate([shape, *others])[:, 0])), 0.25 * depth)
    left, right = -0.95 * max(width, 0.55 * depth), float(shape[:, 0].max()) + 0.9 * max(width, 0.5 * depth)
    # a deep narrow section would fill the page: widen the drawing to a third more than its height
    missing = 1.05 * depth * 1.35 - (right - left)
    if missing > 0.0:
        left, right = left - 0.5 * missing, right + 0.5 * missing
    sketch = Sketch(
        (left, right, -1.05 * depth, 0.1 * depth),
        width=820.0,
        margin=(10.0, 26.0, 10.0, 14.0),
        title="Section of the curtain with the current",
    )
    sketch.rectangle(left, 0.0, right, -depth, "water")
    sketch.rectangle(left, -depth, right, -1.05 * depth, "bed")
    sketch.path(np.array([[left, -depth], [right, -depth]]), "bed-line")
    sketch.path(np.array([[left, 0.0], [right, 0.0]]), "surface")
    sketch.level_mark(right - 0.06 * (right - left), 0.0)
    _profile(sketch, level, left)
    for other in others:
        sketch.path(other, "ghost")
    sketch.path(shape, "sheet")
    on_bed = curve(level.part("section"), "on_bed_x", "on_bed_z", "bed_point")
    if on_bed is not None:
        sketch.path(on_bed, "sheet")
    toe_x, toe_z = float(shape[-1, 0]), float(shape[-1, 1])
    sketch.dot(float(shape[0, 0]), float(shape[0, 1]), 9.0, "buoy")
    sketch.text(float(shape[0, 0]), float(shape[0, 1]), "float, upper cable", shift=(0.0, -14.0))
    sketch.dot(toe_x, toe_z, 5.0, "marker")
    words = {"held": "toe with lower cable", "on the bed": "toe on the bed"}.get(level.toe, "toe, ballast")
    sketch.text(toe_x, toe_z, words, shift=(-12.0, 4.0 if toe_z + depth > 0.05 * depth else -8.0), anchor="end")
    _section_dimensions(sketch, level, (toe_x, toe_z), right)
    return sketch


def _section_dimensions(sketch: Sketch, level: CurtainLevel, toe: tuple[float, float], right: float) -> None:
    toe_x, toe_z = toe
    effective, gap = level.given("effective_depth"), level.given("toe_gap")
    at = toe_x + 0.25 * (right - toe_x)
    roomy = gap * sketch.scale > 90.0
    if math.isfinite(effective) and effective > 0.0:
        low, high = level.spread("effective_depth")
        words = f"effective depth {metres(effective)}"
        if high - low > 0.005 * effective:
            words += f" ({trimmed(format_number(low, 3))} to {metres(high)})"
        sketch.dimension(at, 0.0, at, -effective, words, offset=0.001)
    if math.isfinite(gap) and gap > 0.01 * level.depth:
        sketch.dimension(at, toe_z, at, -level.depth, f"toe gap {metres(gap)}", offset=0.001)
    speed = level.given("toe_speed")
    if math.isfinite(speed) and math.isfinite(gap) and gap > 0.03 * level.depth:
        y = sketch.pz(-level.depth + 0.5 * gap)
        x = sketch.px(toe_x)
        sketch.arrow((x - 28.0, y), (x + 28.0, y), "flow")
        words = f"{format_quantity(speed, 'm/s')} under the toe"
        if roomy:
            sketch.label(x, y + 18.0, words, "middle")
        else:
            sketch.label(x - 34.0, y + 4.0, words, "end")
    if abs(toe_x) > 0.05 * level.depth:
        sketch.dimension(0.0, toe_z, toe_x, toe_z, f"flare {metres(abs(toe_x))}", offset=34.0 if roomy else -22.0)
    left = sketch.x0 + 0.05 * (right - sketch.x0)
    sketch.dimension(left, 0.0, left, -level.depth, f"h = {metres(level.depth)}", offset=0.001)


def _profile(sketch: Sketch, level: CurtainLevel, left: float) -> None:
    """Draw the current as arrows over the depth, the longest to a fixed length."""
    group = level.part("section")
    profile = curve(group, "profile_speed", "profile_z", "profile_point")
    if profile is None or not np.abs(profile[:, 0]).max() > 0.0:
        return
    profile = profile[np.argsort(profile[:, 1])]
    heights = np.linspace(-0.97 * level.depth, -0.03 * level.depth, _FLOW_ARROWS)
    speeds = np.interp(heights, profile[:, 1], profile[:, 0])
    room = -left * sketch.scale * 0.36
    start = left + 0.32 * -left
    for z, speed in zip(heights, speeds, strict=True):
        y = sketch.pz(float(z))
        x = sketch.px(start)
        sketch.arrow((x, y), (x + room * float(speed) / float(np.abs(profile[:, 0]).max()), y), "flow")
    ends = np.column_stack([start + room / sketch.scale * speeds / np.abs(profile[:, 0]).max(), heights])
    sketch.path(ends, "flow")
    largest = float(profile[np.argmax(np.abs(profile[:, 0])), 0])
    sketch.text(
        start, 0.0, f"current, {format_quantity(largest, 'm/s')} at most", "note", shift=(0.0, -8.0), anchor="start"
    )


def _across(points: Array) -> Array:
    """Return plan points (x, y) as seen from above: y to the right, downstream downwards."""
    return np.column_stack([points[:, 1], -points[:, 0]])


def plan_drawing(level: CurtainLevel) -> Sketch | None:
    """Draw the plan between the supports with sag, anchors and the direction of the current."""
    shape = plan_curve(level)
    if shape is None:
        return None
    others = [other for case in ("low", "high") if (other := plan_curve(level, case)) is not None]
    lines = anchor_lines(level)
    span = float(np.ptp(shape[:, 1]))
    tops = [_cut(_across(np.array(pair)[:, :2]), _MOST_UPSTREAM * span) for pair in lines]
    everything = np.concatenate([_across(np.concatenate([shape, *others])), *(ends for ends, _ in tops)])
    pad = 0.09 * span
    box = (
        float(everything[:, 0].min()) - 2.2 * pad,
        float(everything[:, 0].max()) + 2.2 * pad,
        float(everything[:, 1].min()) - pad,
        max(float(everything[:, 1].max()), 0.0) + 2.6 * pad,
    )
    sketch = Sketch(box, margin=(10.0, 14.0, 10.0, 44.0), title="Plan of the curtain between its supports")
    sketch.rectangle(box[0], box[3], box[1], box[2], "water")
    for (ends, whole), (start, end) in zip(tops, lines, strict=True):
        if whole:
            _anchor_in_plan(sketch, ends)
            continue
        x, y = float(ends[1, 0]), float(ends[1, 1])
        reach = float(math.hypot(*(end[:2] - start[:2])))
        with sketch.on_the_page_alone():
            sketch.path(ends, "mooring")
            sketch.text(x, y, f"to its anchor, {metres(reach)} from the float", shift=(0.0, -8.0))
        with sketch.off_the_page():
            _anchor_in_plan(sketch, _across(np.array([start, end])[:, :2]), f"anchor, {metres(reach)} from the float")
    chord = _across(shape[[0, -1]])
    sketch.path(chord, "chord")
    for other in others:
        sketch.path(_across(other), "ghost")
    sketch.path(_across(shape), "sheet")
    for x, y in chord:
        sketch.dot(float(x), float(y), 7.0, "buoy")
    _plan_dimensions(sketch, level, shape, box)
    return sketch


def _anchor_in_plan(sketch: Sketch, ends: Array, words: str = "anchor") -> None:
    x, y = float(ends[1, 0]), float(ends[1, 1])
    size = 5 / sketch.scale
    sketch.path(ends, "mooring")
    sketch.rectangle(x - size, y + size, x + size, y - size, "anchor")
    sketch.text(x, y, words, shift=(0.0, -10.0))


def _cut(ends: Array, most: float) -> tuple[Array, bool]:
    """Return an anchor line as far as it fits the drawing, and whether that is all of it."""
    away = float(np.abs(ends[1, 1] - ends[0, 1]))
    if away <= most:
        return ends, True
    return np.array([ends[0], ends[0] + (ends[1] - ends[0]) * most / away]), False


def _plan_dimensions(sketch: Sketch, level: CurtainLevel, shape: Array, box: tuple[float, float, float, float]) -> None:
    first, last = shape[0], shape[-1]
    at = int(np.argmax(np.abs(shape[:, 0])))
    sag, where = float(shape[at, 0]), float(shape[at, 1])
    lowest = min(-float(shape[:, 0].max()), 0.0)
    sketch.dimension(
        float(first[1]), lowest, float(last[1]), lowest, f"span {metres(abs(float(last[1] - first[1])))}", offset=36.0
    )
    if abs(sag) > 0.02 * abs(float(last[1] - first[1])):
        sketch.dimension(where, 0.0, where, -sag, f"sag {metres(abs(sag))}", offset=0.001)
    angle = level.part("statics").value("flow_angle")
    angle = 0.0 if not math.isfinite(angle) else angle
    speed = level.part("statics").value("surface_speed")
    # the flow runs along (cos, sin) in (x, y); seen from above x points down and y to the right
    direction = (math.sin(angle), math.cos(angle))
    length = 58.0
    for share in (0.15, 0.5, 0.85):
        x = sketch.px(float(first[1]) + share * float(last[1] - first[1]))
        y = sketch.pz(max(0.0, box[3] - 0.35 * (box[3] - 0.0)))
        sketch.arrow((x - 0.5 * length * direction[0], y - 0.5 * length * direction[1]),
                     (x + 0.5 * length * direction[0], y + 0.5 * length * direction[1]), "flow")  # fmt: skip
    words = "current"
    if math.isfinite(speed):
        words += f" {format_quantity(speed, 'm/s')} at the surface"
    if abs(angle) > 1e-9:
        words += f", {format_quantity(abs(angle), 'rad')} from the normal"
    sketch.label(sketch.px(box[0]) + 10.0, sketch.pz(box[3]) + 18.0, words, "start")
    x, y = sketch.px(box[1]) - 64.0, sketch.pz(box[3]) + 22.0
    sketch.arrow((x, y), (x + 40.0, y), "axis")
    sketch.arrow((x, y), (x, y + 40.0), "axis")
    sketch.label(x + 45, y + 4, "y", "start", style="axis-text", size=13.0)
    sketch.label(x + 5, y + 46, "x", "start", style="axis-text", size=13.0)


def anchor_drawing(level: CurtainLevel) -> Sketch | None:
    """Draw one anchor line from its float to the bed, next to the curtain, seen along the span."""
    lines, shape, depth = anchor_lines(level), section_curve(level), level.depth
    if not lines or shape is None or not math.isfinite(depth):
        return None
    start, end = lines[0]
    reach = float(math.hypot(*(end[:2] - start[:2])))
    side = -1.0 if end[0] <= start[0] else 1.0
    x0, x1 = min(side * reach, 0.0), max(side * reach, float(shape[:, 0].max()), 0.0)
    pad = 0.07 * (x1 - x0)
    low = -depth - 0.03 * (x1 - x0)
    sketch = Sketch(
        (x0 - pad, x1 + pad, low, 0.06 * (x1 - x0)),
        margin=(10.0, 12.0, 10.0, 40.0),
        title="Anchor line in its own plane",
    )
    sketch.rectangle(x0 - pad, 0.0, x1 + pad, -depth, "water")
    sketch.rectangle(x0 - pad, -depth, x1 + pad, low, "bed")
    sketch.path(np.array([[x0 - pad, -depth], [x1 + pad, -depth]]), "bed-line")
    sketch.path(np.array([[x0 - pad, 0.0], [x1 + pad, 0.0]]), "surface")
    line = np.array([[0.0, float(start[2])], [side * reach, float(end[2])]])
    sketch.path(line, "mooring")
    sketch.path(shape, "sheet")
    sketch.dot(0.0, float(start[2]), 8.0, "buoy")
    size = 5 / sketch.scale
    sketch.rectangle(side * reach - size, float(end[2]) + size, side * reach + size, float(end[2]) - size, "anchor")
    sketch.dimension(min(0.0, side * reach), -depth, max(0.0, side * reach), -depth, metres(reach), offset=28.0)
    slope = math.degrees(math.atan2(float(start[2] - end[2]), reach)) if reach > 0.0 else 90.0
    length = float(np.linalg.norm(end - start))
    middle = line.mean(axis=0)
    sketch.text(
        float(middle[0]),
        float(middle[1]),
        f"{metres(length)}, {slope:.1f}° to the horizontal",
        shift=(12.0 * side, -8.0),
        anchor="end" if side < 0.0 else "start",
    )
    return sketch
