"""Edges of a wetted section: where eddies are shed, found from the outline and the thin plates."""

from __future__ import annotations

import itertools
import math
from dataclasses import dataclass
from typing import Literal

import numpy as np

from moyai.core.arrays import Array
from moyai.core.validity import Notice
from moyai.floating.viscous import CornerEdge, EdgeFace, PlateEdge, rounding_factor
from moyai.potential.edges import Edges
from moyai.potential.sections import Chain, Section
from moyai.tables.edge_damping import EdgeDampingNumbers, edge_damping_numbers

Kind = Literal["end", "hollow", "corner"]

ODD_ANGLE = math.radians(10.0)
"""Turn of a corner beyond 90 degrees, or short of it, that is reported."""


@dataclass(frozen=True)
class SectionEdges:
    """Edges of a section under water, with what there is to say about them."""

    corners: tuple[CornerEdge, ...]
    plates: tuple[PlateEdge, ...]
    notices: tuple[Notice, ...] = ()


@dataclass(frozen=True)
class _Break:
    """Where a face ends: at the still water, at a hollow, or at a corner with its turn and radius."""

    kind: Kind
    point: Array
    turn: float = 0.0
    radius: float = 0.0


def section_edges(section: Section) -> SectionEdges:
    """Find the edges of a section that shed eddies.

    Parameters
    ----------
    section : Section
        Wetted section at rest.

    Returns
    -------
    SectionEdges
        With notices for what no law covers: round sections, bilges too round, corners far from 90 degrees, plates.
    """
    numbers = edge_damping_numbers()
    corners: list[CornerEdge] = []
    plates: list[PlateEdge] = []
    odd: list[float] = []
    smooth = hollows = 0
    for chain in section.chains:
        breaks, rounded_off = _breaks(chain, numbers)
        smooth += rounded_off
        if any(item.kind == "hollow" for item in breaks):
            hollows += 1
            breaks = _bridged(breaks, chain.closed, numbers)
        found = _edges_of_faces(breaks, chain.closed, numbers)
        corners.extend(found[0])
        plates.extend(found[1])
        odd.extend(found[2])
    for plate in section.wetted_plates:
        if not all(plate.joined):
            plates.extend(_plate_pieces(plate.edges, plate.joined, numbers))
    return SectionEdges(tuple(corners), tuple(plates), _notices(corners, plates, odd, smooth, hollows, numbers))


def _directions(edges: Edges) -> tuple[Array, Array, Array]:
    """Return the angles at the start and end of each edge, and how far it turns [rad]."""
    chord = edges.end - edges.start
    middle = np.arctan2(chord[:, 1], chord[:, 0])
    sweep = 4.0 * np.arctan(edges.bulge)
    return middle - 0.5 * sweep, middle + 0.5 * sweep, sweep


def _breaks(chain: Chain, numbers: EdgeDampingNumbers) -> tuple[list[_Break], int]:
    """Return where the faces of a chain end, in its order, and how many bends are too round for a corner."""
    edges, count = chain.edges, len(chain.edges)
    first, last, sweep = _directions(edges)
    least = math.radians(numbers.smallest_turn)
    found: list[_Break] = [] if chain.closed else [_Break("end", edges.start[0])]
    smooth = 0
    for index in range(count):
        if abs(sweep[index]) >= least:
            bend = _round_bend(chain, index, first, last, sweep, numbers)
            smooth += bend is None
            if bend is not None:
                found.append(bend)
        following = (index + 1) % count
        if following == 0 and not chain.closed:
            break
        point = edges.end[index]
        turn = math.remainder(first[following] - last[index], 2.0 * math.pi)
        if turn >= least:
            found.append(_Break("corner", point, turn))
        elif turn <= -least:
            found.append(_Break("hollow", point))
    if not chain.closed:
        found.append(_Break("end", edges.end[-1]))
    return found, smooth


def _bridged(breaks: list[_Break], closed: bool, numbers: EdgeDampingNumbers) -> list[_Break]:
    """Return the breaks of the convex hull: the water in a hollow is taken to move with the section."""

    def turn(a: _Break, b: _Break, c: _Break) -> float:
        first, second = b.point - a.point, c.point - b.point
        return math.atan2(first[0] * second[1] - first[1] * second[0], float(first @ second))

    kept = list(breaks)
    changed = True
    while changed and len(kept) > 3:
        changed = False
        for index in range(len(kept)) if closed else range(1, len(kept) - 1):
            if turn(kept[index - 1], kept[index], kept[(index + 1) % len(kept)]) <= 1e-9:
                del kept[index]
                changed = True
                break
    out = []
    least = math.radians(numbers.smallest_turn)
    for index, item in enumerate(kept):
        if item.kind == "end":
            out.append(item)
            continue
        angle = turn(kept[index - 1], item, kept[(index + 1) % len(kept)])
        if item.kind == "corner" and angle >= least:
            out.append(_Break("corner", item.point, angle, item.radius))
    return out


def _round_bend(
    chain: Chain, index: int, first: Array, last: Array, sweep: Array, numbers: EdgeDampingNumbers
) -> _Break | None:
    """Return the corner that an arc rounds off, or ``None`` for one too large to have a corner."""
    edges, count = chain.edges, len(chain.edges)
    if not chain.closed and index in (0, count - 1):
        return None
    angle = float(sweep[index])
    if angle < 0.0:
        return _Break("hollow", 0.5 * (edges.start[index] + edges.end[index]))
    if angle > math.radians(150.0):
        return None
    chord = float(np.hypot(*(edges.end[index] - edges.start[index])))
    radius = chord / (2.0 * math.sin(0.5 * angle))
    reach = radius * math.tan(0.5 * angle)
    along = np.array([math.cos(first[index]), math.sin(first[index])])
    neighbours = [float(edges.lengths[(index - 1) % count]), float(edges.lengths[(index + 1) % count])]
    if radius > numbers.largest_radius * (min(neighbours) + reach):
        return None
    return _Break("corner", edges.start[index] + reach * along, angle, radius)


def _edges_of_faces(
    breaks: list[_Break], closed: bool, numbers: EdgeDampingNumbers
) -> tuple[list[CornerEdge], list[PlateEdge], list[float]]:
    """Return corners, thin plates and the turns that are far from 90 degrees, from the faces between breaks."""
    count = len(breaks)
    corners: list[CornerEdge] = []
    plates: list[PlateEdge] = []
    odd: list[float] = []
    if count < 2:
        return corners, plates, odd

    def neighbour(index: int, step: int) -> _Break:
        return breaks[(index + step) % count] if closed else breaks[index + step]

    def long(a: _Break, b: _Break) -> float:
        return float(np.hypot(*(b.point - a.point)))

    taken: set[int] = set()
    for index, here in enumerate(breaks):
        if here.kind != "corner" or index in taken:
            continue
        after = neighbour(index, 1)
        before = neighbour(index, -1)
        if after.kind == "corner":
            beyond = neighbour((index + 1) % count if closed else index + 1, 1)
            shorter = min(long(before, here), long(after, beyond))
            if long(here, after) < numbers.thin_plate * shorter:
                tip = 0.5 * (here.point + after.point)
                back = (before.point - here.point) / long(before, here)
                plates.append(_plate(tip + shorter * back, tip, numbers))
                taken.add((index + 1) % count)
                continue
        corner = _corner(before, here, after, numbers)
        if corner is None:
            continue
        corners.append(corner)
        if abs(here.turn - 0.5 * math.pi) > ODD_ANGLE:
            odd.append(math.pi - here.turn)
    return corners, plates, odd


def _corner(before: _Break, here: _Break, after: _Break, numbers: EdgeDampingNumbers) -> CornerEdge | None:
    faces = [_face(before, here, True), _face(after, here, False)]
    if min(face.length for face in faces) <= 0.0:
        return None
    # The steeper face is the side of Ikeda's box, the flatter one half of its bottom
    side, bottom = sorted(faces, key=lambda face: abs(face.normal[1]))
    half = min(max(bottom.length / side.length, numbers.ikeda_half_beam_low), numbers.ikeda_half_beam_high)
    pressure = (
        numbers.edge_pressure
        * min(1.0, here.turn / (0.5 * math.pi))
        * rounding_factor(half, min(here.radius / side.length, half))
    )
    return CornerEdge((float(here.point[0]), float(here.point[1])), faces[0], faces[1], pressure)


def _face(other: _Break, here: _Break, arrives: bool) -> EdgeFace:
    """Return the part of the face from ``other`` that belongs to the corner ``here``: half where both are corners."""
    far = 0.5 * (other.point + here.point) if other.kind == "corner" else other.point
    along = (here.point - far) if arrives else (far - here.point)
    length = float(np.hypot(*along))
    if length == 0.0:
        return EdgeFace((float(far[0]), float(far[1])), 0.0, (0.0, 0.0))
    # The water lies on the right of the outline
    return EdgeFace((float(far[0]), float(far[1])), length, (float(along[1]) / length, -float(along[0]) / length))


def _plate(root: Array, tip: Array, numbers: EdgeDampingNumbers) -> PlateEdge:
    return PlateEdge((float(root[0]), float(root[1])), (float(tip[0]), float(tip[1])), numbers.plate_coefficient)


def _plate_pieces(edges: Edges, joined: tuple[bool, bool], numbers: EdgeDampingNumbers) -> list[PlateEdge]:
    """Return the straight pieces of a thin plate, each from its end nearer to the root."""
    points = np.concatenate([edges.polyline(), edges.end[-1:]])
    if joined[1] and not joined[0]:
        points = points[::-1]
    return [_plate(start, end, numbers) for start, end in itertools.pairwise(points)]


def _notices(
    corners: list[CornerEdge],
    plates: list[PlateEdge],
    odd: list[float],
    smooth: int,
    hollows: int,
    numbers: EdgeDampingNumbers,
) -> tuple[Notice, ...]:
    reported: list[Notice] = []
    if not corners and not plates:
        reported.append(
            Notice(
                "viscous-no-edge",
                "the section has no edge under water that sheds eddies: no viscous damping is computed, and motions "
                "near resonance have that of the waves alone",
                remedy="give the roll damping from a decay test, or a fraction of critical damping",
            )
        )
    elif smooth:
        reported.append(
            Notice(
                "viscous-round",
                f"{smooth} bends of the outline are too round for a corner; no eddies are counted there",
                value=float(smooth),
                severity="information",
                source="bilges beyond half of the shorter face: Ikeda's law for round bilges ends",
            )
        )
    if hollows:
        reported.append(
            Notice(
                "viscous-hollow",
                "the outline is hollow under water: for the damping by eddies the water in the hollow is taken to move "
                "with the section, and no eddies are counted inside",
                value=float(hollows),
                severity="information",
            )
        )
    if odd:
        worst = max(odd, key=lambda angle: abs(angle - 0.5 * math.pi))
        reported.append(
            Notice(
                "viscous-angle",
                f"no law covers corners of {math.degrees(worst):.0f} degrees: the damping of a right angle is used, "
                "in proportion to "
                "the turn of the outline where that is less",
                value=worst,
                limit=0.5 * math.pi,
                severity="information",
                unit="rad",
            )
        )
    if plates:
        reported.append(
            Notice(
                "viscous-plates",
                f"thin plates are given the drag coefficient {numbers.plate_coefficient:.2g} "
                f"(8 KC^(-1/3) at KC = {numbers.plate_keulegan_carpenter:g})",
                value=numbers.plate_coefficient,
                severity="information",
                source="Graham (1980), valid for KC from 1 to 20",
            )
        )
    return tuple(reported)
