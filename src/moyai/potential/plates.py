"""Thin plates of a section: open lines of straight and circular edges, alone, under a hull or on it.

A plate that touches a hull or another plate with its end is joined there; the edge that it touches is cut at the
joint, so that a corner of the potential lies between panels.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from moyai.core.arrays import Array, ComplexArray
from moyai.core.errors import InputError
from moyai.potential.edges import Edges, arc_position, as_complex, as_points, inside_polygon, segments_meet

if TYPE_CHECKING:
    from moyai.potential.thin_plate import Plate

# An end this close to another edge, in terms of the size of all, is joined to it
_JOIN = 1e-6
# Share of a plate next to its joints that is left out when crossings are looked for: arcs are held as chords there
_BESIDE_JOINT = 5e-3


@dataclass(frozen=True, eq=False)
class PlateLine:
    """An open line of straight and circular edges without thickness.

    Raises
    ------
    InputError
        For fewer than two points, points that are not finite or coincide, or a line that intersects itself.
    """

    #: x, z [m] of both ends and of every corner between, in the frame of the hull or of the site; shape (n, 2).
    points: Array
    #: tan(sweep / 4) of each edge: 0 (default) straight, positive turns counter-clockwise, 1 half circle; shape (n -
    #: 1,).
    bulges: Array | None = None

    def __post_init__(self) -> None:
        points = np.array(self.points, dtype=float)
        if points.ndim != 2 or points.shape[1] != 2 or len(points) < 2:
            raise InputError(
                f"the plate has points of shape {points.shape}", parameter="plates", allowed="(2 or more, 2)"
            )
        bulges = np.zeros(len(points) - 1) if self.bulges is None else np.array(self.bulges, dtype=float)
        if bulges.shape != (len(points) - 1,):
            raise InputError(
                f"the plate has {bulges.size} bulges for {len(points) - 1} edges",
                parameter="plates",
                allowed="one per edge",
            )
        if not (np.isfinite(points).all() and np.isfinite(bulges).all()):
            raise InputError("a point or a bulge of the plate is not a finite number", parameter="plates")
        steps = np.hypot(*np.diff(points, axis=0).T)
        size = float(np.ptp(points, axis=0).max())
        if size == 0.0 or (steps <= 1e-9 * size).any():
            raise InputError("the plate, or an edge of it, has no length", parameter="plates", allowed="points apart")
        points.flags.writeable = bulges.flags.writeable = False
        object.__setattr__(self, "points", points)
        object.__setattr__(self, "bulges", bulges)
        line = _chords(self.edges)
        first, second = np.triu_indices(len(line) - 1, 2)
        if segments_meet(line[first], line[first + 1], line[second], line[second + 1], 1e-9 * size).any():
            raise InputError("the plate intersects itself", parameter="plates", remedy="make several plates of it")

    @classmethod
    def of(cls, plate: Plate) -> PlateLine:
        """Return a single straight or circular plate as a line.

        Parameters
        ----------
        plate : Plate
            Straight or circular.
        """
        return cls(np.array([plate.start, plate.end]), np.array([plate.bulge]))

    @property
    def edges(self) -> Edges:
        """The edges from the first point to the last."""
        bulges = np.zeros(len(self.points) - 1) if self.bulges is None else self.bulges
        return Edges(self.points[:-1], self.points[1:], bulges)

    @property
    def length(self) -> float:
        """Length along the plate [m]."""
        return float(self.edges.lengths.sum())

    @property
    def outline(self) -> Array:
        """Points (n, 2) along the plate for drawings, x, z [m], arcs as chords."""
        return as_points(_chords(self.edges))

    def moved(self, shift: tuple[float, float] = (0.0, 0.0), heel: float = 0.0) -> PlateLine:
        """Return the plate turned by ``heel`` [rad] (top towards +x) about the origin and then shifted [m].

        Parameters
        ----------
        shift : (float, float)
            Along x and z, after the turn [m].
        heel : float
            Turn about the origin, top towards +x [rad].
        """
        cosine, sine = math.cos(heel), math.sin(heel)
        turned = self.points @ np.array([[cosine, -sine], [sine, cosine]])
        return PlateLine(turned + np.asarray(shift, dtype=float), self.bulges)


@dataclass(frozen=True, eq=False)
class WettedPlate:
    """The part of a plate that is under water."""

    #: One after the other.
    edges: Edges
    #: Whether the first and the last point lie on the still water, a hull or another plate; a free edge does not.
    joined: tuple[bool, bool]
    #: Number of the body that it moves with.
    body: int


def _chords(edges: Edges) -> ComplexArray:
    return np.concatenate([as_complex(edges.polyline()), as_complex(edges.end[-1:])])


def wet_plates(plates: Sequence[PlateLine], first_body: int) -> list[WettedPlate]:
    """Cut plates at the still water and keep what is below; number ``first_body`` and up, one for each plate."""
    found = []
    for number, plate in enumerate(plates):
        edges = plate.edges.cut_at_level(1e-9 * float(np.ptp(plate.points)))
        wet = edges.points(0.5)[:, 0, 1] < 0.0
        run: list[int] = []
        for index in range(len(edges)):
            if wet[index]:
                run.append(index)
            ends = index + 1 == len(edges) or not wet[index + 1] or edges.end[index, 1] == 0.0
            if run and ends:
                part = edges.taken(np.array(run))
                surface = part.start[0, 1] == 0.0, part.end[-1, 1] == 0.0
                found.append(WettedPlate(part, surface, first_body + number))
                run = []
    return found


def _place_on(edges: Edges, number: int, point: complex) -> tuple[float, float]:
    """Return the arc-length fraction of the point of an edge next to ``point``, and the distance from it."""
    start, end = as_complex(edges.start[number]), as_complex(edges.end[number])
    bulge = edges.bulge[number]
    sweep = 4.0 * math.atan(bulge)
    ratio = complex((point - start) / (end - start))
    if abs(sweep) < 1e-9:
        fraction = ratio.real
    else:
        fraction = float((np.log(1.0 + ratio * (np.exp(1j * sweep) - 1.0)) / (1j * sweep)).real)
    fraction = min(1.0, max(0.0, fraction))
    nearest = complex(arc_position(start, end, bulge, fraction))
    return fraction, abs(nearest - point)


def _cut(edges: Edges, number: int, fraction: float) -> Edges:
    """Split an edge at an arc-length fraction."""
    start, end, bulge = as_complex(edges.start[number]), as_complex(edges.end[number]), edges.bulge[number]
    middle = arc_position(start, end, bulge, fraction)
    points = as_points(np.array([start, middle, end]))
    parts = np.tan(math.atan(bulge) * np.array([fraction, 1.0 - fraction]))
    return Edges(
        np.concatenate([edges.start[:number], points[:2], edges.start[number + 1 :]]),
        np.concatenate([edges.end[:number], points[1:], edges.end[number + 1 :]]),
        np.concatenate([edges.bulge[:number], parts, edges.bulge[number + 1 :]]),
    )


def _with_end(edges: Edges, last: bool, point: Array) -> Edges:
    start, end = edges.start.copy(), edges.end.copy()
    if last:
        end[-1] = point
    else:
        start[0] = point
    return Edges(start, end, edges.bulge)


def join_plates(
    chains: Sequence[tuple[Edges, int]], plates: Sequence[WettedPlate]
) -> tuple[list[Edges], list[WettedPlate]]:
    """Join ends of plates to the edges that they touch; return the edges of the chains and the plates, cut there.

    Parameters
    ----------
    chains : sequence of (Edges, int)
        Wetted boundaries of the hulls and the numbers of their bodies.
    plates : sequence of WettedPlate
        The plates.
    """
    lines = [edges for edges, _ in chains] + [plate.edges for plate in plates]
    owner = [body for _, body in chains] + [plate.body for plate in plates]
    count = len(chains)
    every = np.concatenate([np.concatenate([edges.start, edges.end]) for edges in lines])
    tolerance = _JOIN * float(np.ptp(every, axis=0).max())
    joined = [list(plate.joined) for plate in plates]
    links: list[tuple[int, int]] = []
    for index in range(len(plates)):
        for last in (False, True):
            own = lines[count + index]
            point = complex(*(own.end[-1] if last else own.start[0]))
            best = _touched(lines, count + index, point, tolerance)
            if best is None:
                continue
            line, edge, fraction = best
            joined[index][last] = True
            length = lines[line].lengths[edge]
            if min(fraction, 1.0 - fraction) * length > tolerance:
                lines[line] = _cut(lines[line], edge, fraction)
                point_there = lines[line].end[edge]
            else:
                point_there = (lines[line].end if fraction > 0.5 else lines[line].start)[edge]
            if not (plates[index].joined[last] and point_there[1] != 0.0):
                lines[count + index] = _with_end(lines[count + index], last, point_there)
            if (line, count + index) not in links:
                links.append((count + index, line))
    _refuse_loops(links, len(lines), count)
    # What hangs together moves together, with a hull if there is one
    for _ in links:
        for one, other in links:
            shared = min(owner[one], owner[other])
            for number in (one, other):
                owner[number] = shared if number >= count else owner[number]
    return lines[:count], [
        WettedPlate(lines[count + index], (bool(joined[index][0]), bool(joined[index][1])), owner[count + index])
        for index in range(len(plates))
    ]


def _refuse_loops(links: Sequence[tuple[int, int]], lines: int, hulls: int) -> None:
    """Refuse plates that enclose water together with each other or a hull: its potential is anything plus a constant.

    Raises
    ------
    InputError
        With the number of the plate that closes the ring.
    """
    group = list(range(lines))
    for plate, other in links:
        if group[plate] == group[other]:
            raise InputError(
                f"plate {plate - hulls + 1} closes a ring around water",
                parameter="plates",
                allowed="plates that leave every part of the water open to the rest",
                remedy="draw the enclosed part as a closed outline, or leave a gap",
            )
        old = group[plate]
        group = [group[other] if item == old else item for item in group]


def _touched(lines: Sequence[Edges], own: int, point: complex, tolerance: float) -> tuple[int, int, float] | None:
    """Return line, edge and fraction of what lies at a point, other than the line itself.

    The first line counts (hulls stand before plates), on it a corner before the middle of an edge.
    """
    for number, edges in enumerate(lines):
        found: tuple[int, int, float] | None = None
        for edge in range(len(edges) if number != own else 0):
            fraction, distance = _place_on(edges, edge, point)
            if distance <= tolerance:
                if min(fraction, 1.0 - fraction) * float(edges.lengths[edge]) <= tolerance:
                    return number, edge, fraction
                found = found or (number, edge, fraction)
        if found:
            return found
    return None


def check_plates(outlines: Sequence[Array], plates: Sequence[PlateLine]) -> None:
    """Refuse plates that cross a hull or each other, lie on one another or run inside a hull.

    Parameters
    ----------
    outlines : sequence of ndarray, shape (n, 2)
        Closed outlines of the hulls.
    plates : sequence of PlateLine
        The plates.

    Raises
    ------
    InputError
        With the numbers of the two that clash.
    """
    lines = [_chords(plate.edges) for plate in plates]
    for number, line in enumerate(lines):
        inner = _inner(line)
        for other, outline in enumerate(outlines):
            ring = as_complex(np.concatenate([outline, outline[:1]]))
            if bool(inside_polygon(as_points(inner), outline).any()) or _meets(inner, ring):
                raise InputError(
                    f"plate {number + 1} crosses or enters outline {other + 1}",
                    parameter="plates",
                    allowed="plates outside the hulls; they may end on them",
                    remedy="cut the plate where it meets the hull",
                )
        for other in range(number + 1, len(lines)):
            if _meets(inner, _inner(lines[other])):
                raise InputError(
                    f"plates {number + 1} and {other + 1} cross or lie on each other",
                    parameter="plates",
                    allowed="plates apart; the end of one may lie on the other",
                    remedy="cut one plate in two where they meet",
                )


def _inner(line: ComplexArray) -> ComplexArray:
    """Return the line without its two ends."""
    steps = np.abs(np.diff(line))
    place = np.concatenate([[0.0], np.cumsum(steps)])
    wanted = place[-1] * np.concatenate([[_BESIDE_JOINT], np.linspace(0.02, 0.98, 49), [1.0 - _BESIDE_JOINT]])
    wanted = np.unique(np.concatenate([wanted, place[1:-1]]))
    wanted = wanted[np.diff(wanted, prepend=-1.0) > 1e-9 * place[-1]]  # no two in one place
    return np.asarray(np.interp(wanted, place, line.real) + 1j * np.interp(wanted, place, line.imag))


def _meets(inner: ComplexArray, other: ComplexArray) -> bool:
    size = max(float(np.ptp(other.real)), float(np.ptp(other.imag)), abs(inner[-1] - inner[0]))
    a, b, c, d = inner[:-1, None], inner[1:, None], other[None, :-1], other[None, 1:]
    if segments_meet(a, b, c, d, 1e-9 * size).any():
        return True
    chord = d - c
    along = np.clip(((inner[:, None] - c) / chord).real, 0.0, 1.0)
    touching = (np.abs(c + along * chord - inner[:, None]) < _JOIN * size).any(axis=1)
    # A single point is where the end of one lies on the other
    return int(touching.sum()) > 2
