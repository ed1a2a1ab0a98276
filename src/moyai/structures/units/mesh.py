"""Panels of a row of floating units: hulls, lids inside of them, lids in the gaps between them.

The long side of a unit is cut with panels that grow from its ends and corners to its middle, by cosines
[eq:units-cosine]. Lengths in metres, frame of the row: x across, y along, z from still water. A panel has four corners,
counter-clockwise seen from the water; one of three repeats its first.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from itertools import combinations, pairwise

import numpy as np

from moyai.core.arrays import Array, IntArray
from moyai.core.errors import InputError
from moyai.potential.sections import Section
from moyai.structures.units.faces import Meeting, gaps_between
from moyai.structures.units.model import Placement

HULL, LID, GAP = 0, 1, 2
#: Share of cosine spacing in the cuts; the rest is even
REFINEMENT = 1.0
#: Least number of steps on a straight edge of the section that takes a twelfth of the girth or more: roll needs them
LEAST_STEPS = 6
_LONG_EDGE = 0.08
#: Largest turn of the chords of an arc [deg]: 0.7 % of the area of a circle
_LARGEST_TURN = 12.0
#: Most panels of a row
MOST_PANELS = 50_000
#: Width over the length of a unit beyond which two faces enclose no gap
_OPEN = 0.5
#: Least width of a gap over the size of a panel
LEAST_GAP = 0.1


@dataclass(frozen=True, eq=False)
class PanelMesh:
    """Panels of all units."""

    #: [m]; shape (n, 4, 3).
    corners: Array
    #: Unit that a panel belongs to; of a lid in a gap the unit before it; shape (n,).
    unit: IntArray
    #: ``HULL``, ``LID`` (still water inside of a hull) or ``GAP`` (water surface between two units); shape (n,).
    part: IntArray

    @property
    def count(self) -> int:
        """Number of panels."""
        return len(self.unit)

    @cached_property
    def area_vector(self) -> Array:
        """Normal times area (n, 3) [m2], half the cross product of the diagonals."""
        first, second = self.corners[:, 2] - self.corners[:, 0], self.corners[:, 3] - self.corners[:, 1]
        return 0.5 * np.cross(first, second)

    @cached_property
    def area(self) -> Array:
        """Areas (n,) [m2]."""
        return np.asarray(np.linalg.norm(self.area_vector, axis=1))

    @cached_property
    def normal(self) -> Array:
        """Unit normals (n, 3), into the water; of lids downward."""
        return self.area_vector / self.area[:, None]

    @cached_property
    def centre(self) -> Array:
        """Centroids (n, 3) [m]: of the two triangles of a panel, by their areas."""
        a, b, c, d = (self.corners[:, index] for index in range(4))
        first = np.linalg.norm(np.cross(b - a, c - a), axis=1)[:, None]
        second = np.linalg.norm(np.cross(c - a, d - a), axis=1)[:, None]
        return np.asarray((first * (a + b + c) + second * (a + c + d)) / (3.0 * (first + second)))

    @property
    def longest_side(self) -> float:
        """Longest edge of a hull panel [m]."""
        wet = self.corners[self.part == HULL]
        return float(np.linalg.norm(np.roll(wet, -1, axis=1) - wet, axis=2).max())

    def joined(self, other: PanelMesh) -> PanelMesh:
        """Return the panels of both."""
        return PanelMesh(
            np.concatenate([self.corners, other.corners]),
            np.concatenate([self.unit, other.unit]),
            np.concatenate([self.part, other.part]),
        )


def cuts(length: float, size: float, *, even: bool = False, refined: tuple[bool, bool] = (True, True)) -> Array:
    """Return stations from 0 to ``length`` [m], closer at its ends, at most ``size`` apart [eq:units-cosine].

    Parameters
    ----------
    length, size : float
        [m].
    even : bool
        Whether the number of steps is even, so that a plane of symmetry falls on a station.
    refined : tuple of bool
        Whether steps shrink to the start and to the end.
    """
    share = REFINEMENT if any(refined) else 0.0
    count = max(1, math.ceil(length / size * (1.0 - share + share * 0.5 * math.pi) - 1e-9))
    if even and count % 2:
        count += 1
    t = np.linspace(0.0, 1.0, count + 1)
    if all(refined):
        if count <= 2:
            return np.asarray(length * t)
        stations = (1.0 - share) * t + share * 0.5 * (1.0 - np.cos(math.pi * t))
        return np.asarray(length * 0.5 * (stations + 1.0 - stations[::-1]))
    stations = (1.0 - share) * t + share * (1.0 - np.cos(0.5 * math.pi * t))
    return np.asarray(length * (stations if refined[0] else 1.0 - stations[::-1]))


def _girth(section: Section, chain: int, size: float) -> Array:
    """Return points (n, 2) along one wetted chain, left waterline to right, each edge cut by itself."""
    edges = section.chains[chain].edges
    points = [edges.start[:1]]
    whole = float(edges.lengths.sum())
    for number in range(len(edges)):
        one = edges.taken(np.array([number]))
        length = float(one.lengths[0])
        straight = abs(float(edges.bulge[number])) < 1e-12
        level = straight and abs(float(edges.start[number, 1] - edges.end[number, 1])) < 1e-9
        # chords of an arc turn little
        turn = abs(4.0 * math.atan(float(edges.bulge[number])))
        step = size if straight else min(size, length / max(2.0, turn / math.radians(_LARGEST_TURN)))
        if straight and length >= _LONG_EDGE * whole:
            step = min(size, length / LEAST_STEPS * (1.0 - REFINEMENT + REFINEMENT * 0.5 * math.pi))
        # no closer at the surface, where nothing is sharp
        dry = abs(float(edges.start[number, 1])) < 1e-9, abs(float(edges.end[number, 1])) < 1e-9
        refined = straight and not dry[0], straight and not dry[1]
        fractions = cuts(length, step, even=level or not straight, refined=refined) / length
        points.append(one.points(fractions[1:])[0])
    return np.concatenate(points)


def unit_mesh(
    section: Section, length: float, size: float, *, lid: bool, even: bool = True, end_size: float | None = None
) -> PanelMesh:
    """Return the panels of one unit in its own axes: middle of its length at y = 0.

    Parameters
    ----------
    section : Section
        Wetted section at rest, surface piercing, without thin plates.
    length : float
        [m].
    size : float
        Largest step of the panels [m].
    lid : bool
        Whether the still water inside of the hull gets a lid.
    even : bool
        Whether the middle of the unit falls on a station.
    end_size : float or None
        Of the panels on the ends across, where a gap requires smaller ones [m].
    """
    along = cuts(length, size, even=even) - 0.5 * length
    pieces: list[Array] = []
    lids: list[Array] = []
    for chain in range(len(section.chains)):
        girth = _girth(section, chain, size)
        pieces.append(_shell(girth, along))
        pieces.append(_ends(girth, end_size or size, length))
        if lid:
            left, right = float(girth[0, 0]), float(girth[-1, 0])
            across = left + cuts(right - left, 1.5 * size, even=True, refined=(False, False))
            lids.append(_grid(across, cuts(length, 1.5 * size, even=even, refined=(False, False)) - 0.5 * length))
    hull = np.concatenate(pieces)
    corners = np.concatenate([hull, *lids])
    part = np.full(len(corners), LID)
    part[: len(hull)] = HULL
    return PanelMesh(corners, np.zeros(len(corners), dtype=int), part)


def _shell(girth: Array, along: Array) -> Array:
    """Panels of the long side (n, 4, 3): the chain runs counter-clockwise in x-z, water on its right."""
    panels = []
    for (x0, z0), (x1, z1) in pairwise(girth):
        for y0, y1 in pairwise(along):
            panels.append([(x0, y0, z0), (x0, y1, z0), (x1, y1, z1), (x1, y0, z1)])
    return np.array(panels)


def _ends(girth: Array, size: float, length: float) -> Array:
    """Panels of both ends (n, 4, 3): level bands between the heights of the girth, each cut across."""
    low, high = girth[:-1], girth[1:]
    levels = np.unique(np.round(girth[:, 1], 9))
    panels = []
    for bottom, top in pairwise(levels):
        middle = 0.5 * (bottom + top)
        crossing = np.flatnonzero((low[:, 1] - middle) * (high[:, 1] - middle) < 0.0)
        sides = [
            [low[n, 0] + (z - low[n, 1]) * (high[n, 0] - low[n, 0]) / (high[n, 1] - low[n, 1]) for z in (bottom, top)]
            for n in crossing
        ]
        sides.sort(key=sum)
        for left, right in zip(sides[::2], sides[1::2]):
            width = max(right[0] - left[0], right[1] - left[1])
            t = cuts(1.0, min(1.0, size / width), even=True)
            for s0, s1 in pairwise(t):
                quad = [
                    (left[k] + s * (right[k] - left[k]), z)
                    for s, k, z in ((s0, 0, bottom), (s1, 0, bottom), (s1, 1, top), (s0, 1, top))
                ]
                panels.append(_closed(np.array(quad)))
    flat = np.array(panels)
    out = []
    for y, direction in ((-0.5 * length, -1.0), (0.5 * length, 1.0)):
        solid = np.stack([flat[..., 0], np.full(flat.shape[:2], y), flat[..., 1]], axis=-1)
        out.append(_outward(solid, np.array([0.0, direction, 0.0])))
    return np.concatenate(out)


def _closed(quad: Array) -> Array:
    """Return four corners; a triangle repeats its first."""
    apart = np.hypot(*(quad - np.roll(quad, 1, axis=0)).T) > 1e-9
    if apart.all():
        return quad
    three = quad[apart]
    return np.concatenate([three, three[:1]])


def turned_round(corners: Array) -> Array:
    """Return panels (n, 4, 3) with their corners the other way round; triangles go on to repeat their first."""
    out = corners[:, [0, 3, 2, 1]]
    three = np.linalg.norm(out[:, 1] - out[:, 0], axis=1) < 1e-12
    out[three] = out[three][:, [0, 2, 3, 0]]
    return out


def _outward(corners: Array, direction: Array) -> Array:
    """Turn panels round whose normal points against a direction."""
    first, second = corners[:, 2] - corners[:, 0], corners[:, 3] - corners[:, 1]
    wrong = np.cross(first, second) @ direction < 0.0
    out = corners.copy()
    out[wrong] = turned_round(corners[wrong])
    return out


def _grid(across: Array, along: Array) -> Array:
    """Level panels (n, 4, 3) at still water, normals down."""
    panels = [
        [(x0, y0, 0.0), (x0, y1, 0.0), (x1, y1, 0.0), (x1, y0, 0.0)]
        for x0, x1 in pairwise(across)
        for y0, y1 in pairwise(along)
    ]
    return np.array(panels)


def row_mesh(
    section: Section,
    length: float,
    placements: tuple[Placement, ...],
    size: float,
    *,
    lid: bool,
    gap_lid: bool,
) -> PanelMesh:
    """Return the panels of all units.

    Parameters
    ----------
    section : Section
        Wetted section of every unit.
    length : float
        Of every unit [m].
    placements : tuple of Placement
        Middle and heading of every unit.
    size : float
        Largest step of the panels [m].
    lid : bool
        Whether the still water inside of the hulls gets lids.
    gap_lid : bool
        Whether the water between neighbours gets lids.

    Raises
    ------
    InputError
        Where two units overlap or a gap is narrower than a tenth of a panel.
    """
    check_gaps(section, length, placements, size)
    _check_count(section, length, len(placements), size)
    narrow = gap_size(section, length, placements, size)
    one = unit_mesh(section, length, size, lid=lid, end_size=narrow)
    parts = [
        PanelMesh(place.to_row(one.corners), np.full(one.count, number), one.part)
        for number, place in enumerate(placements)
    ]
    if gap_lid:
        parts += _gap_lids(section, length, placements, narrow)
    mesh = parts[0]
    for part in parts[1:]:
        mesh = mesh.joined(part)
    return mesh


def gap_size(section: Section, length: float, placements: tuple[Placement, ...], size: float) -> float:
    """Return the size of panels that face each other in a gap [m]: its width, a quarter of the others at least."""
    plans = [waterplane(section, length, place) for place in placements]
    narrowest = min((clearance(one, other) for one, other in combinations(plans, 2)), default=size)
    return min(size, max(narrowest, 0.25 * size))


def _check_count(section: Section, length: float, units: int, size: float) -> None:
    """Refuse panels by the hundred thousand before they are drawn."""
    girth = sum(float(chain.edges.lengths.sum()) for chain in section.chains)
    count = units * girth * length / size**2
    if count > MOST_PANELS:
        raise InputError(
            f"panels of {size:.3g} m would be about {count:.2g}",
            parameter="settings.panel_size",
            allowed=f"at least {math.sqrt(units * girth * length / MOST_PANELS):.3g} m",
            remedy="give larger panels",
        )


def _gap_lids(section: Section, length: float, placements: tuple[Placement, ...], size: float) -> list[PanelMesh]:
    bounds = section.waterlines[0][0], section.waterlines[-1][1]
    lids = []
    for met in gaps_between(placements, length, bounds):
        if not met.overlap[1] > met.overlap[0]:
            continue  # a corner before a face that turns away from it
        near, far = _edges(met, size)
        width = float(np.linalg.norm(far - near, axis=1).max())
        if width > _OPEN * length:
            continue  # open water
        t = cuts(1.0, min(1.0, size / width), even=True, refined=(False, False))
        nodes = near[:, None] + t[None, :, None] * (far - near)[:, None]
        panels = [
            [nodes[i, j], nodes[i, j + 1], nodes[i + 1, j + 1], nodes[i + 1, j]]
            for i in range(len(near) - 1)
            for j in range(len(t) - 1)
        ]
        corners = _outward(np.array(panels), np.array([0.0, 0.0, -1.0]))
        lids.append(PanelMesh(corners, np.full(len(panels), met.near.unit), np.full(len(panels), GAP)))
    return lids


def _edges(met: Meeting, size: float) -> tuple[Array, Array]:
    """Return the points (n, 3) of a lid on both faces: from corner to corner of ends, across from each other else."""
    near, far = met.near, met.far
    if near.is_end and far.is_end:
        offsets = cuts(near.high - near.low, size, even=True)[:, None]
        start, end = near.at(near.low) + offsets * near.along, far.at(far.high) - offsets * far.along
    else:
        low, high = met.overlap
        start, end = met.facing_points(low + cuts(high - low, size, even=True))
    level = np.zeros((len(start), 1))
    return np.hstack([start, level]), np.hstack([end, level])


def waterplane(section: Section, length: float, place: Placement) -> Array:
    """Return the four corners (4, 2) of a unit in plan [m], counter-clockwise."""
    left, right = section.bounds[0], section.bounds[1]
    half = 0.5 * length
    plan = np.array([(left, -half, 0.0), (right, -half, 0.0), (right, half, 0.0), (left, half, 0.0)])
    return place.to_row(plan)[:, :2]


def clearance(first: Array, second: Array) -> float:
    """Return the distance [m] of two convex quadrilaterals (4, 2); negative where they overlap (separating axes)."""
    best = -math.inf
    for shape in (first, second):
        for a, b in zip(shape, np.roll(shape, -1, axis=0)):
            outward = np.array([b[1] - a[1], a[0] - b[0]])
            outward = outward / np.hypot(*outward)
            best = max(best, float((second @ outward).min() - (first @ outward).max()),
                       float((first @ outward).min() - (second @ outward).max()))  # fmt: skip
    if best <= 0.0:
        return best
    return min(_point_to_edges(first, second), _point_to_edges(second, first))


def _point_to_edges(points: Array, shape: Array) -> float:
    least = math.inf
    for a, b in zip(shape, np.roll(shape, -1, axis=0)):
        along = b - a
        t = np.clip(((points - a) @ along) / (along @ along), 0.0, 1.0)
        least = min(least, float(np.hypot(*(points - a - t[:, None] * along).T).min()))
    return least


def check_gaps(section: Section, length: float, placements: tuple[Placement, ...], size: float) -> None:
    """Refuse units that overlap and gaps that no panel resolves.

    Raises
    ------
    InputError
        With the two units and the least gap.
    """
    plans = [waterplane(section, length, place) for place in placements]
    for i in range(len(plans)):
        for j in range(i + 1, len(plans)):
            gap = clearance(plans[i], plans[j])
            if gap <= 0.0:
                raise InputError(
                    f"units {i + 1} and {j + 1} overlap by {-gap:.3g} m",
                    parameter="units",
                    remedy="move them apart: 'gap' is the clear water between two units",
                )
            if gap < LEAST_GAP * size:
                raise InputError(
                    f"the gap of {gap:.3g} m between units {i + 1} and {j + 1} is under a tenth of a panel "
                    f"({size:.3g} m)",
                    parameter="units",
                    allowed=f"at least {LEAST_GAP * size:.3g} m with these panels",
                    remedy="widen the gap or give smaller panels",
                )
