"""Is the mooring sound? Each finding with its number, its limit and what to do."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike

from moyai.core.validity import Notice
from moyai.mooring import kernels
from moyai.mooring.lines import Line, LineElement, LineState
from moyai.mooring.shape import line_shape
from moyai.mooring.system import LineSystem

BoxCorners = tuple[tuple[float, float, float], tuple[float, float, float]]


def check_line_system(
    system: LineSystem,
    position: ArrayLike = (0.0,) * 6,
    *,
    body_box: BoxCorners | None = None,
    initial: bool = True,
    still_water: float = 0.0,
    path: str = "lines",
) -> tuple[Notice, ...]:
    """Check every line of a system at one body position.

    Parameters
    ----------
    system : LineSystem
        The lines.
    position : array_like (6,)
        Body position.
    body_box : pair of corners, optional
        Lowest and highest corner (x, y, z) [m] of the body at rest, site axes: anchors inside it are faults.
    initial : bool
        Whether the position is the one of installation (words of the findings).
    still_water : float
        z of the still water in the axes of the system [m], for systems whose origin is elsewhere.
    path : str
        Path of the lines in the case, for the messages.

    Returns
    -------
    tuple of Notice
        Severity ``error`` for what makes the mooring impossible.
    """
    where = "at rest" if initial else "at this position"
    points = system.fairleads(np.asarray(position, dtype=float))
    notices: list[Notice] = []
    for line, point in zip(system.lines, points):
        label = f"{path}.{line.name}"
        if point[2] < -system.water_depth * (1.0 + 1e-9):
            notices.append(_below_bed(label, point[2], system.water_depth))
            continue
        state = line.solve(point[None, :], system.water_depth)
        notices += _strength(line, state, label, where)
        notices += _anchor_in_body(line, body_box, label)
        if point[2] > still_water:
            notices.append(
                Notice(
                    "mooring-fairlead-dry",
                    f"{label}: the fairlead is {point[2] - still_water:.3g} m above the still water; the weight in "
                    "water is taken for the whole line",
                    float(point[2] - still_water),
                    0.0,
                    "information",
                )
            )
        if isinstance(line, Line):
            notices += _geometry(line, point, state, system.water_depth, still_water, label, where)
    return tuple(notices)


def _below_bed(label: str, height: float, depth: float) -> Notice:
    return Notice(
        "mooring-fairlead-below-bed",
        f"{label}: the fairlead lies at z = {height:.4g} m, under the bed at {-depth:.4g} m",
        height,
        -depth,
        "error",
        "raise the fairlead or deepen the water",
    )


def _strength(line: LineElement, state: LineState, label: str, where: str) -> list[Notice]:
    tension = float(max(state.tension_fairlead[0], state.tension_anchor[0]))
    if state.regime[0] == kernels.UNREACHABLE:
        return [
            Notice(
                "mooring-line-unreachable",
                f"{label}: inextensible and shorter than the distance between its ends",
                severity="error",
                remedy="lengthen the line or give its axial stiffness",
            )
        ]
    if not math.isfinite(line.breaking_load) or not tension > line.breaking_load:
        return []
    return [
        Notice(
            "mooring-line-breaks",
            f"{label}: tension {tension / 1e3:.4g} kN {where} exceeds its breaking load of "
            f"{line.breaking_load / 1e3:.4g} kN",
            tension,
            line.breaking_load,
            "error",
            "lengthen the line, bring the anchor nearer or choose a stronger line",
        )
    ]


def _anchor_in_body(line: LineElement, box: BoxCorners | None, label: str) -> list[Notice]:
    if box is None:
        return []
    low, high = np.asarray(box[0]), np.asarray(box[1])
    anchor = np.asarray(line.anchor)
    if not np.all((anchor >= low) & (anchor <= high)):
        return []
    return [
        Notice(
            "mooring-anchor-in-body",
            f"{label}: the anchor ({anchor[0]:.4g}, {anchor[1]:.4g}, {anchor[2]:.4g}) m lies inside the body",
            severity="error",
            remedy="move the anchor outside the body, normally to the bed",
        )
    ]


def _geometry(
    line: Line, point: np.ndarray, state: LineState, depth: float, still_water: float, label: str, where: str
) -> list[Notice]:
    notices = []
    regime = int(state.regime[0])
    reach = math.hypot(point[0] - line.anchor[0], point[1] - line.anchor[1])
    rise = abs(float(point[2] - line.anchor[2]))
    clearance = line.bed_clearance(depth)
    slack = (kernels.SLACK_ON_BED, kernels.SLACK_VERTICAL, kernels.SLACK_WEIGHTLESS)
    if regime in slack:
        notices.append(
            Notice(
                "mooring-line-heap",
                f"{label}: {line.length:.5g} m of line lie folded {where}: horizontal and vertical distance "
                f"together are {reach + rise:.5g} m, so the line has no tension",
                line.length,
                reach + rise,
                "error",
                f"shorten the line below {reach + rise:.4g} m or move the anchor away",
            )
        )
    if clearance > 0.0:
        notices.append(
            Notice(
                "mooring-anchor-above-bed",
                f"{label}: the anchor is {clearance:.4g} m above the bed",
                clearance,
                0.0,
                "warning",
                f"set its z to {-depth:.6g} m unless it is fixed to a structure",
            )
        )
    uplift = float(state.vertical_tension_anchor[0])
    if clearance == 0.0 and uplift > 0.0 and regime not in slack:
        angle = math.degrees(float(state.anchor_uplift_angle[0]))
        notices.append(
            Notice(
                "mooring-anchor-uplift",
                f"{label}: the line pulls its anchor upwards with {uplift / 1e3:.4g} kN at {angle:.3g} degrees {where}",
                uplift,
                0.0,
                "information",
                "check that the anchor type resists uplift, or lengthen the line",
            )
        )
    buoyant = any(row[2] < 0.0 or row[3] < 0.0 for row in line.table)
    if buoyant and regime not in slack:
        highest = float(line_shape(line, point, depth).points[:, 2].max()) - still_water
        if highest > max(float(point[2]) - still_water, 0.0) + 1e-6 * line.length:
            notices.append(
                Notice(
                    "mooring-buoy-above-water",
                    f"{label}: a buoyant part would be {highest:.4g} m above the still water {where}; its full "
                    "buoyancy is too large",
                    highest,
                    0.0,
                    "warning",
                    "reduce its buoyancy to what holds it at the surface, or shorten the line below it",
                )
            )
    if regime in (kernels.TOUCHES_BETWEEN, kernels.NOT_CONVERGED):
        notices.append(
            Notice(
                "mooring-touches-between",
                f"{label}: a part between buoyant elements meets the bed a second time; this is not solved",
                severity="error",
                remedy="reduce the buoyancy or its distance from the anchor, or use dynamic lines",
            )
        )
    return notices
