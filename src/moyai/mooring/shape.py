"""The shape of a line at rest for drawing, and the tension along it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from moyai.core.arrays import Array
from moyai.mooring import kernels
from moyai.mooring.lines import Line, LineElement


@dataclass(frozen=True)
class LineShape:
    """Points along a line from anchor to fairlead."""

    #: Positions (x, y, z) [m], site axes; shape (n, 3).
    points: Array
    #: Unstretched length from the anchor [m]; shape (n,).
    arc_length: Array
    #: [N]; shape (n,).
    tension: Array
    #: Distance from the anchor in the line's own vertical plane [m]; shape (n,).
    horizontal: Array
    #: Height above the anchor [m]; shape (n,).
    height: Array


def _hanging(h: float, v: float, w: float, axial: float, s: Array) -> tuple[Array, Array, Array]:
    """Return (dx, dz, tension) at unstretched lengths s above a point with vertical force v ``[eq:mooring-piece]``."""
    sign = 1.0 if w >= 0.0 else -1.0
    low = sign * v
    up = low + sign * w * s
    t0, t1 = np.hypot(h, low), np.hypot(h, up)
    total = np.maximum(t0 + t1, 1e-300)
    dz = sign * 0.5 * (low + up) * s * (2.0 / total + 1.0 / axial)
    load = sign * w * s
    if h == 0.0:
        return np.zeros_like(s), dz, t1
    p = t0 + low if low > 0.0 else h * h / (t0 - low)
    q = np.where(up < 0.0, t1 - up, h * h / (t1 + up))
    angle = np.log1p(2.0 * load / (p + q))
    straight = load < 1e-14 * total
    per_load = np.where(straight, 2.0 / total, angle / np.where(straight, 1.0, load))
    return h * s * (per_load + 1.0 / axial), dz, t1


def _on_bed(
    h: float, v0: float, rows: Array, ground: float, friction: float
) -> list[tuple[float, float, float, float]]:
    """Split the bed part into (length, EA, tension at its lower end, rise of tension per length), from the anchor."""
    parts = []
    left = ground
    for length, axial, weight, clump in rows:
        if left <= 1e-12 * ground:
            break
        piece = length if abs(length - left) <= 1e-12 * ground else min(length, left)
        parts.append([piece, axial, friction * weight, friction * max(clump, 0.0) if piece == length else 0.0])
        left -= piece
    tension = h
    if parts and len(parts) < len(rows) and parts[-1][0] == rows[len(parts) - 1, 0]:
        # the touchdown stands at a clump: only what it does not lift rests on the bed
        parts[-1][3] = friction * max(rows[len(parts) - 1, 3] - v0, 0.0)
    out = []
    for piece, axial, rate, jump in reversed(parts):
        tension = max(tension - jump, 0.0)
        lower = tension - rate * piece
        out.append((piece, axial, lower, rate))
        tension = max(lower, 0.0)
    return out[::-1]


def line_shape(line: Line, fairlead: ArrayLike, water_depth: float, points: int = 60) -> LineShape:
    """Draw a line for one position of its fairlead [eq:mooring-piece].

    Parameters
    ----------
    line : Line
        The line.
    fairlead : array_like (3,)
        Position of the fairlead [m], site axes.
    water_depth : float
        Depth of the bed below still water [m].
    points : int
        About how many points; ends, touchdown and junctions are always among them.

    Returns
    -------
    LineShape
        Positions [m], lengths from the anchor [m] and tensions [N] of n points. The part on the bed is drawn straight,
        also where a slack line has more length there than distance.

    Raises
    ------
    InputError
        For an anchor under the bed.

    Examples
    --------
    >>> from moyai.mooring import Line, LineType, Segment, line_shape
    >>> chain = Segment(LineType("chain", submerged_weight=1000.0, axial_stiffness=5e8), length=55.0)
    >>> line = Line("left", anchor=(-50.0, 0.0, -10.0), fairlead=(0.0, 0.0, 0.0), segments=[chain])
    >>> shape = line_shape(line, fairlead=(0.0, 0.0, 0.0), water_depth=10.0, points=20)
    >>> shape.points[0].tolist()                                         # the anchor [m]
    [-50.0, 0.0, -10.0]
    >>> round(float(shape.tension[-1]) / 1000.0, 2)                      # at the fairlead [kN]
    16.04
    """
    end = np.asarray(fairlead, dtype=float)
    span = end - np.asarray(line.anchor)
    reach = float(np.hypot(span[0], span[1]))
    out, regime = line.solve_plane(np.array([reach]), np.array([span[2]]), water_depth)
    h, ground = float(out[0, 0]), float(out[0, 4])
    if regime[0] in (kernels.SLACK_WEIGHTLESS, kernels.UNREACHABLE, kernels.INVALID):
        fraction = np.linspace(0.0, 1.0, 2)
        tension = np.full(2, h if np.isfinite(h) else np.nan)
        return _place(line, span, reach, fraction * line.length, fraction * reach, fraction * span[2], tension)
    rows = line.table
    total = rows[:, 0].sum()
    s_all, x_all, z_all, t_all = [np.zeros(1)], [np.zeros(1)], [np.zeros(1)], []
    s = x = z = 0.0
    v = float(out[0, 3])
    clearance = line.bed_clearance(water_depth)
    lead = -v / rows[0, 2] if (clearance > 0.0 and ground > 0.0) else 0.0  # hangs from a raised anchor to the bed
    skip = ground + lead
    if lead > 0.0:
        steps = np.linspace(0.0, lead, max(3, int(points * lead / total)))
        dx, dz, t = _hanging(h, v, rows[0, 2], rows[0, 1], steps)
        s_all, x_all, z_all, t_all = [steps], [dx], [dz], [t]
        s, x, z, v = lead, float(dx[-1]), float(dz[-1]), 0.0
    if ground > 0.0:
        lifted_from = 0.0
        if lead == 0.0 and not line.is_uniform:
            lifted_from = _vertical_at_touchdown(out[0], rows, ground)
        pieces = (
            _on_bed(h, lifted_from, rows, ground, line.bed_friction) if lead == 0.0 else [(ground, rows[0, 1], h, 0.0)]
        )
        scale = 1.0
        if h == 0.0:
            scale = reach / ground  # slack: more length than distance
        for length, axial, lower, rate in pieces:
            steps = np.linspace(0.0, length, max(2, int(points * length / total)))
            t = np.maximum(lower + rate * steps, 0.0)
            first = max(lower, 0.0)
            stretch = (t**2 - first**2) / (2.0 * rate * axial) if rate > 0.0 else t * steps / axial
            if not t_all:
                t_all.append(t[:1])
            s_all.append(s + steps[1:])
            x_all.append(x + scale * (steps + stretch)[1:])
            z_all.append(np.full(len(steps) - 1, z))
            t_all.append(t[1:])
            s, x = s + length, float(x_all[-1][-1])
        v = lifted_from
    for length, axial, weight, clump in rows:
        free = max(length - skip, 0.0)
        skip = max(skip - length, 0.0)
        if free <= 1e-12 * total:  # on the bed; a clump at its upper end is counted in the force at the touchdown
            continue
        steps = np.linspace(0.0, free, max(3, int(points * free / total)))
        dx, dz, t = _hanging(h, v, weight, axial, steps)
        if not t_all:
            t_all.append(t[:1])
        s_all.append(s + steps[1:])
        x_all.append(x + dx[1:])
        z_all.append(z + dz[1:])
        t_all.append(t[1:])
        s, x, z, v = s + free, x + float(dx[-1]), z + float(dz[-1]), v + weight * free + clump
    columns = [np.concatenate(values) for values in (s_all, x_all, z_all, t_all)]
    return _place(line, span, reach, *columns)


def _vertical_at_touchdown(solution: Array, rows: Array, ground: float) -> float:
    """Return the vertical force just above the touchdown: zero, or the lifted share of a clump standing on the bed."""
    ends = np.cumsum(rows[:, 0])
    at_clump = np.flatnonzero(np.isclose(ends[:-1], ground, rtol=1e-11, atol=0.0))
    if at_clump.size == 0:
        return 0.0
    i = int(at_clump[0])
    above = float((rows[i + 1 :, 0] * rows[i + 1 :, 2]).sum() + rows[i + 1 : -1, 3].sum())
    return max(float(solution[1]) - above, 0.0)


def _place(line: Line, span: Array, reach: float, s: Array, x: Array, z: Array, tension: Array) -> LineShape:
    direction = span[:2] / reach if reach > 0.0 else np.array([1.0, 0.0])
    points = np.column_stack([x * direction[0], x * direction[1], z]) + np.asarray(line.anchor)
    return LineShape(points=points, arc_length=s, tension=tension, horizontal=x, height=z)


def element_shape(element: LineElement, fairlead: ArrayLike, water_depth: float, points: int = 60) -> LineShape:
    """Draw any member of a line system; springs are straight."""
    if isinstance(element, Line):
        return line_shape(element, fairlead, water_depth, points)
    end = np.asarray(fairlead, dtype=float)
    span = end - np.asarray(element.anchor)
    reach = float(np.hypot(span[0], span[1]))
    tension = float(element.solve(end[None, :], water_depth).tension_fairlead[0])
    length = float(np.linalg.norm(span))
    fraction = np.linspace(0.0, 1.0, 2)
    return LineShape(
        points=np.asarray(element.anchor) + fraction[:, None] * span,
        arc_length=fraction * length,
        tension=np.full(2, tension),
        horizontal=fraction * reach,
        height=fraction * span[2],
    )


def even_points(element: LineElement, fairlead: ArrayLike, water_depth: float, count: int = 60) -> Array:
    """Return a member of a line system as evenly spaced points from its anchor to its fairlead; shape (count, 3) [m].

    Parameters
    ----------
    element : LineElement
    fairlead : array_like
        Place of its fairlead, in the axes of its anchor [m].
    water_depth : float
        [m].
    count : int
        Number of points.
    """
    points = element_shape(element, fairlead, water_depth).points
    along = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))])
    even = np.linspace(0.0, along[-1], count)
    return np.stack([np.interp(even, along, column) for column in points.T], axis=1)
