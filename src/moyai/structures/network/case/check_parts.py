"""Checks of single parts of a network case: bodies and coefficients, floats that sink, corners of nets and sheets."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np

from moyai.case.check_sea import check_file
from moyai.case.findings import Findings, duplicates
from moyai.structures.network.case import schema_bodies as bodies
from moyai.structures.network.case import schema_parts as parts
from moyai.structures.network.case.schema import NetworkCase
from moyai.structures.network.case.sizes import places_of

#: Share of its mass by which a body may displace more or less at the draught of its coefficients.
_FAR_FROM_AFLOAT = 0.1
#: Share of the largest distance of two points over which a line is no link any more.
_LONG_BAR = 0.3
#: Heights of a fixed point above the bed over the depth between which it is neither an anchor nor a bollard.
_OVER_BED = (0.02, 0.5)


def _volume(body: bodies.BoxBody | bodies.CylinderBody) -> float:
    if isinstance(body, bodies.BoxBody):
        return math.prod(body.size)
    return math.pi / 4.0 * body.diameter**2 * body.height


def check_bodies(model: NetworkCase, findings: Findings, folder: Path) -> None:
    """Record bodies that sink by their own weight, start in the bed, or do not fit their coefficients."""
    levels = model.site.water_levels.values()
    bed = -(model.site.water_depth + min(levels, default=0.0))
    for name, body in model.structure.bodies.items():
        path = ("structure", "bodies", name)
        turn = _turned([math.radians(angle) for angle in body.rotation_deg])
        for point, place in body.points.items():
            height = body.position[2] + float(turn @ np.array(place))
            # where the bed varies the assembly looks at its level under each point
            if model.structure.bed is not None and (model.structure.bed.grid or model.structure.bed.slope):
                continue
            if height < bed * (1.0 + 1e-9):
                findings.fault(
                    (*path, "points", point),
                    f"'{point}' starts at z = {height:.4g} m above still water, under the bed",
                    allowed=f"at least {bed:.4g} m", remedy="raise the position of the body",
                )  # fmt: skip
        if isinstance(body, bodies.AssembledBody):
            continue
        most = model.site.density * _volume(body)
        if body.mass > most:
            findings.warn(
                (*path, "mass"), f"{body.mass:.4g} kg sink: wholly under water it displaces {most:.4g} kg",
                remedy="check mass and size; only lines from above can hold it",
            )  # fmt: skip
        if body.coefficients_file is not None:
            _check_coefficients(name, body, model.site.density, folder, findings)


def _turned(angles: list[float]) -> np.ndarray:
    """Return the third row of the rotation matrix: heights of places in axes of the body."""
    roll, pitch, _ = angles
    return np.array(
        [-math.sin(pitch), math.cos(pitch) * math.sin(roll), math.cos(pitch) * math.cos(roll)]
    )  # fmt: skip


def _check_coefficients(
    name: str, body: bodies.BoxBody | bodies.CylinderBody, density: float, folder: Path, findings: Findings
) -> None:
    given, path = body.coefficients_file, ("structure", "bodies", name, "coefficients_file")
    assert given is not None
    check_file((*path, "path"), given.path, folder, findings, folder_allowed=given.program == "nemoh")
    box = isinstance(body, bodies.BoxBody)
    height = body.size[2] if isinstance(body, bodies.BoxBody) else body.height
    if given.draught >= height:
        findings.fault(
            (*path, "draught"), f"a draught of {given.draught:g} m submerges a body of {height:g} m",
            allowed=f"less than {height:g} m",
        )  # fmt: skip
        return
    if body.centre_of_gravity[0] != 0.0 or body.centre_of_gravity[1] != 0.0:
        findings.fault(
            ("structure", "bodies", name, "centre_of_gravity"),
            "with coefficients the body floats upright: its centre of gravity is above its middle",
            allowed="x and y of 0",
        )  # fmt: skip
    displaced = density * _volume(body) / height * given.draught
    if abs(displaced / body.mass - 1.0) > _FAR_FROM_AFLOAT:
        shape = "box" if box else "cylinder"
        findings.warn(
            (*path, "draught"),
            f"the {shape} displaces {displaced:.4g} kg at {given.draught:g} m and weighs {body.mass:.4g} kg: unless "
            "its lines carry the difference, it floats far from where its coefficients hold",
        )  # fmt: skip


def check_floats(model: NetworkCase, findings: Findings) -> None:
    """Warn of floats that are heavier than the water they can displace."""
    for name, point in model.structure.points.items():
        if isinstance(point, parts.SphereFloat):
            volume = math.pi / 6.0 * point.diameter**3
        elif isinstance(point, parts.CylinderFloat):
            volume = math.pi / 4.0 * point.diameter**2 * point.height
        else:
            continue
        most = model.site.density * volume
        if point.mass > most:
            findings.warn(
                ("structure", "points", name, "mass"),
                f"the {point.kind} of {point.mass:.4g} kg sinks: wholly under water it displaces {most:.4g} kg",
                remedy="check mass and diameter; a clump weight is a point of kind 'free'",
            )  # fmt: skip


def check_starts(model: NetworkCase, findings: Findings) -> None:
    """Refuse floats that start in the air, higher over the water than they are themselves, without a line upwards."""
    places = {name: place for name, (place, _) in places_of(model.structure, model.site).items()}
    highest = max(model.site.water_levels.values(), default=0.0)
    ends = [(line.start, line.end) for line in model.structure.lines.values()]
    for name, point in model.structure.points.items():
        if not isinstance(point, parts.SphereFloat | parts.CylinderFloat) or "z" in point.held:
            continue
        tall = point.height if isinstance(point, parts.CylinderFloat) else point.diameter
        bottom = places[name][2] - 0.5 * tall
        others = [b if a == name else a for a, b in ends if name in (a, b)]
        # knots of nets and points of turned bodies are not looked for: they may well hold it
        hung = any(other not in places or places[other][2] > places[name][2] for other in others)
        if bottom > highest + tall and not hung:
            findings.fault(
                ("structure", "points", name, "position"),
                f"the {point.kind} '{name}' of {tall:g} m starts {bottom - highest:.4g} m over the highest water and "
                "falls: no line holds it from above",
                allowed=f"z of at most {highest + 1.5 * tall:.4g} m",
                remedy="heights under datum are negative; a float starts about the water level",
            )  # fmt: skip


def check_anchors(model: NetworkCase, findings: Findings) -> None:
    """Warn of fixed points a little over the bed from which all lines lead upwards: anchors lie on it."""
    unit, depth = model.structure, model.site.water_depth
    # without a bed of its own a network knows none, and a bed that varies is looked at under each point
    if not math.isfinite(depth) or unit.bed is None or (unit.bed.slope or unit.bed.grid) is not None:
        return
    places = {name: place for name, (place, _) in places_of(unit, model.site).items()}
    carried = {point for body in unit.bodies.values() for point in body.points}
    ends = [(line.start, line.end) for line in unit.lines.values()]
    for name, point in unit.points.items():
        if not isinstance(point, parts.HeldPoint) or point.z_from == "still_water":
            continue
        height = places[name][2] + depth
        others = [b if a == name else a for a, b in ends if name in (a, b)]
        # a knot of a net may hang lower; points of turned bodies float
        upwards = bool(others) and all(
            places[other][2] > places[name][2] if other in places else other in carried for other in others
        )
        if upwards and _OVER_BED[0] < height / depth < _OVER_BED[1]:
            findings.warn(
                ("structure", "points", name, "position"),
                f"'{name}' is fixed {height:.4g} m above the bed, and its lines lead upwards from there",
                remedy="an anchor has the word bed for z; nothing is wrong where it is fixed to a pile or a wall",
            )  # fmt: skip


def check_bars(model: NetworkCase, findings: Findings) -> None:
    """Warn of long lines of one straight bar: without sag, and with weight and drag at the ends alone."""
    places = [place for place, _ in places_of(model.structure, model.site).values()]
    extent = max((math.dist(a, b) for number, a in enumerate(places) for b in places[:number]), default=0.0)
    for name, line in model.structure.lines.items():
        if line.segments == 1 and line.length is not None and line.length > _LONG_BAR * extent:
            findings.warn(
                ("structure", "lines", name, "segments"),
                f"the line '{name}' of {line.length:g} m is one straight bar: it cannot sag, and its weight and drag "
                "act at its ends",
                allowed=f"one bar up to {_LONG_BAR * extent:.3g} m, {_LONG_BAR:g} of the network; usually 10 or more",
                remedy="give more segments",
            )  # fmt: skip


def check_sheets(model: NetworkCase, findings: Findings) -> None:
    """Refuse sheets that carry nothing."""
    for name, sheet in model.structure.sheets.items():
        if sheet.warp_stiffness == 0.0 and sheet.weft_stiffness == 0.0:
            findings.fault(
                ("structure", "sheets", name, "warp_stiffness"), f"the sheet '{name}' has stiffness neither along warp "
                "nor along weft", allowed="greater than 0 along one of them",
            )  # fmt: skip


def check_corners(model: NetworkCase, findings: Findings) -> None:
    """Refuse corners of nets and sheets that coincide or do not go once around."""
    grids: list[tuple[str, str, Any]] = [("nets", name, net) for name, net in model.structure.nets.items()]
    grids += [("sheets", name, sheet) for name, sheet in model.structure.sheets.items()]
    for group, name, grid in grids:
        path = ("structure", group, name, "corners")
        twice = duplicates([repr(corner) for corner in grid.corners])
        for index in twice:
            findings.fault((*path, index), "two corners are at the same place", remedy="move one")
        if twice:
            continue
        a, b, c, d = (
            np.array([-model.site.water_depth if value is None else value for value in corner], dtype=float)
            for corner in grid.corners
        )
        if not np.isfinite([a, b, c, d]).all():
            continue
        # both rows run the same way, and so do both sides, or two sides cross
        if float((b - a) @ (c - d)) < 0.0 and abs(float((d - a) @ (c - b))) <= abs(float((b - a) @ (c - d))):
            findings.fault(
                path, "the corners do not go once around: first and last row run opposite ways and two sides cross",
                allowed="start and end of the first row, then end and start of the last row",
                remedy="swap the third and the fourth corner",
            )  # fmt: skip
