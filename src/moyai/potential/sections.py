"""Closed outlines of straight and circular edges, hulls made of them, and the section that a hull shows to the water.

Lengths in metres. An outline is given in the body frame: x from the centre of the body, z upwards from the keel. A hull
set into still water becomes a :class:`Section` in the frame of the site, where z = 0 is the still water.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from moyai.core.arrays import Array
from moyai.core.errors import InputError
from moyai.potential.edges import Edges, inside_polygon, polygon_clash, segments_meet
from moyai.potential.edges import as_complex as _as_complex
from moyai.potential.plates import PlateLine, WettedPlate, check_plates, join_plates, wet_plates

# Distances below this share of the size of an outline count as touching
_TOUCH = 1e-9


@dataclass(frozen=True, eq=False)
class Outline:
    """A closed outline, counter-clockwise; one given clockwise is turned round.

    Raises
    ------
    InputError
        For NaN, fewer than three corners (two with arcs), repeated corners, no area, or intersections.
    """

    #: Corners (x, z) [m] in the body frame; the last one need not repeat the first; shape (n, 2).
    vertices: Array
    #: tan(sweep / 4) of the edge that leaves each corner: 0 (default) is straight, 1 a counter-clockwise half circle;
    #: shape (n,).
    bulges: Array | None = None

    def __post_init__(self) -> None:
        vertices = np.array(self.vertices, dtype=float)
        if vertices.ndim != 2 or vertices.shape[1] != 2:
            raise InputError(
                f"vertices have shape {vertices.shape}", parameter="vertices", allowed="(n, 2): x, z of each corner"
            )
        bulges = np.zeros(len(vertices)) if self.bulges is None else np.array(self.bulges, dtype=float)
        if bulges.shape != (len(vertices),):
            raise InputError(
                f"{bulges.size} bulges for {len(vertices)} vertices", parameter="bulges", allowed="one per vertex"
            )
        if not (np.isfinite(vertices).all() and np.isfinite(bulges).all()):
            raise InputError("a corner or a bulge of the outline is not a finite number", parameter="vertices")
        if len(vertices) > 1 and (vertices[0] == vertices[-1]).all():
            vertices, bulges = vertices[:-1], bulges[:-1]
        if len(vertices) < 2 or (len(vertices) == 2 and not bulges.any()):
            raise InputError(
                f"the outline has {len(vertices)} different corners",
                parameter="vertices",
                allowed="at least 3, or 2 with arcs",
            )
        size = float(np.ptp(vertices, axis=0).max())
        steps = np.hypot(*(np.roll(vertices, -1, axis=0) - vertices).T)
        if size == 0.0 or (steps <= _TOUCH * size).any():
            where = int(np.argmin(steps))
            raise InputError(
                f"corners {where + 1} and {(where + 1) % len(vertices) + 1} of the outline coincide",
                parameter="vertices",
            )
        area = Edges(vertices, np.roll(vertices, -1, axis=0), bulges).moments()[0]
        if abs(area) <= 1e-12 * size**2:
            raise InputError("the outline encloses no area", parameter="vertices")
        if area < 0.0:
            vertices, bulges = vertices[::-1], -np.roll(bulges[::-1], -1)
        edges = Edges(vertices, np.roll(vertices, -1, axis=0), bulges)
        clash = polygon_clash(edges.polyline(), _TOUCH * size)
        if clash is not None:
            raise InputError(
                f"the outline intersects itself near x = {clash[0]:g} m, z = {clash[1]:g} m",
                parameter="vertices",
                remedy="list the corners once around the section",
            )
        object.__setattr__(self, "vertices", edges.start)
        object.__setattr__(self, "bulges", edges.bulge)
        object.__setattr__(self, "_edges", edges)

    @property
    def edges(self) -> Edges:
        """The edges, counter-clockwise."""
        edges: Edges = self.__dict__["_edges"]
        return edges

    @cached_property
    def area(self) -> float:
        """Enclosed area [m2]."""
        return self.edges.moments()[0]

    @cached_property
    def bounds(self) -> tuple[float, float, float, float]:
        """Smallest and largest x, smallest and largest z [m]."""
        return self.edges.bounds()

    def moved(self, shift: tuple[float, float] = (0.0, 0.0), heel: float = 0.0) -> Outline:
        """Return the outline turned by ``heel`` [rad] (top towards +x) about the origin and then shifted [m]."""
        start = _turned(self.edges.start, heel) + np.asarray(shift, dtype=float)
        edges = Edges(start, np.roll(start, -1, axis=0), self.edges.bulge)
        # what was found of this outline holds of the moved one
        moved = object.__new__(Outline)
        for name, value in (("vertices", edges.start), ("bulges", edges.bulge), ("_edges", edges)):
            object.__setattr__(moved, name, value)
        return moved


def _turned(points: Array, heel: float) -> Array:
    cosine, sine = math.cos(heel), math.sin(heel)
    values: Array = points @ np.array([[cosine, -sine], [sine, cosine]])
    return values


@dataclass(frozen=True, eq=False)
class Hull:
    """One or several closed outlines and thin plates that float together, in the body frame.

    Raises
    ------
    InputError
        When there is neither outline nor plate, two outlines overlap or touch, or plates cross what they may not.

    Examples
    --------
    >>> from moyai.potential import shapes
    >>> hull = shapes.rectangle(beam=4.0, height=2.0)
    >>> hull.beam, hull.height, hull.immersed(draught=1.0).area          # [m], [m], [m2]
    (4.0, 2.0, 4.0)
    """

    #: They may not overlap. None at all is a structure of plates alone.
    outlines: tuple[Outline, ...]
    #: For messages and plots.
    name: str = "hull"
    #: Plates of no thickness: keel plates that end on an outline, a curtain under the hull, a barrier.
    plates: tuple[PlateLine, ...] = ()

    def __post_init__(self) -> None:
        outlines, plates = tuple(self.outlines), tuple(self.plates)
        if not outlines and not plates:
            raise InputError("the hull has no outline", parameter="outlines")
        object.__setattr__(self, "outlines", outlines)
        object.__setattr__(self, "plates", plates)
        lines = [outline.edges.polyline() for outline in outlines]
        for i in range(len(lines)):
            for j in range(i + 1, len(lines)):
                if _overlap(lines[i], lines[j]):
                    raise InputError(
                        f"outlines {i + 1} and {j + 1} of {self.name} overlap or touch", parameter="outlines"
                    )
        check_plates(lines, plates)

    def with_plates(self, *plates: PlateLine) -> Hull:
        """Return the hull with thin plates added, in the body frame.

        Parameters
        ----------
        *plates : PlateLine
            Added to those of the hull; x, z in the body frame [m].
        """
        return replace(self, plates=self.plates + plates)

    @cached_property
    def bounds(self) -> tuple[float, float, float, float]:
        """Smallest and largest x, smallest and largest z of the outlines [m]; of the plates where there are no others.

        Plates may reach beyond: beam, height and bottom are those of the body they hang on.
        """
        parts = [outline.bounds for outline in self.outlines] or [plate.edges.bounds() for plate in self.plates]
        every = np.array(parts)
        return float(every[:, 0].min()), float(every[:, 1].max()), float(every[:, 2].min()), float(every[:, 3].max())

    @property
    def beam(self) -> float:
        """Largest breadth [m]."""
        return self.bounds[1] - self.bounds[0]

    @property
    def height(self) -> float:
        """Height from the lowest to the highest point [m]."""
        return self.bounds[3] - self.bounds[2]

    @property
    def bottom(self) -> float:
        """Lowest z in the body frame [m]; 0 when z is counted from the keel."""
        return self.bounds[2]

    def immersed(self, draught: float, heel: float = 0.0, offset: float = 0.0) -> Section:
        """Set the hull into still water.

        Parameters
        ----------
        draught : float
            Depth [m] of the origin of the body frame (x = 0 at the keel) below still water.
        heel : float
            Angle [rad] by which the hull is turned about that origin, top towards +x.
        offset : float
            Place x [m] of that origin at the site.

        Returns
        -------
        Section
            Exactly cut at the still water.

        Raises
        ------
        InputError
            When no part is under water, or the hull holds a basin of water of its own.
        """
        for name, value in (("draught", draught), ("heel", heel), ("offset", offset)):
            if not math.isfinite(value):
                raise InputError(f"{name} is {value}", parameter=name, allowed="a finite number")
        outlines = tuple(outline.moved((offset, -draught), heel) for outline in self.outlines)
        plates = tuple(plate.moved((offset, -draught), heel) for plate in self.plates)
        return Section(outlines, draught=draught, heel=heel, offset=offset, name=self.name, plates=plates)


def _overlap(first: Array, second: Array) -> bool:
    size = max(float(np.ptp(first)), float(np.ptp(second)))
    a, c = _as_complex(first), _as_complex(second)
    b, d = np.roll(a, -1), np.roll(c, -1)
    if segments_meet(a[:, None], b[:, None], c[None, :], d[None, :], _TOUCH * size).any():
        return True
    return bool(inside_polygon(first[:1], second)[0] or inside_polygon(second[:1], first)[0])


@dataclass(frozen=True, eq=False)
class Chain:
    """A connected piece of wetted boundary, fluid on its right."""

    #: From the left waterline point under the body to the right one, or all around a submerged outline.
    edges: Edges
    #: Whether it is wholly under water.
    closed: bool
    #: Number of the outline it belongs to.
    body: int


@dataclass(frozen=True, eq=False)
class Section:
    """The section that a hull shows to the water: wetted boundary and displaced area, z = 0 at still water.

    Made by :meth:`Hull.immersed`. Areas and moments are per metre of structure and exact, arcs included.

    Raises
    ------
    InputError
        When no part is under water, an outline touches the still water from below, or holds a basin of its own.

    Examples
    --------
    >>> from moyai.potential import shapes
    >>> section = shapes.rectangle(beam=4.0, height=2.0).immersed(draught=1.0)
    >>> section.area, section.bottom, section.waterlines                 # [m2], [m], [m]
    (4.0, -1.0, ((-2.0, 2.0),))
    """

    #: Whole outlines in the frame of the site.
    outlines: tuple[Outline, ...]
    #: Draught that the hull was set to [m].
    draught: float
    #: Heel that the hull was set to [rad].
    heel: float = 0.0
    #: Sideways shift of the hull [m].
    offset: float = 0.0
    #: For messages and plots.
    name: str = "section"
    #: Thin plates in the frame of the site.
    plates: tuple[PlateLine, ...] = ()

    def __post_init__(self) -> None:
        chains = [chain for body, outline in enumerate(self.outlines) for chain in _wetted(outline, body)]
        plates = wet_plates(self.plates, len(self.outlines))
        if not chains and not plates:
            raise InputError(
                f"{self.name} does not reach the water at a draught of {self.draught:g} m", parameter="draught"
            )
        for chain in chains:
            left, right = chain.edges.start[0, 0], chain.edges.end[-1, 0]
            if not chain.closed and right <= left:
                raise InputError(
                    f"{self.name} encloses water or touches still water from below near x = {left:g} m",
                    parameter="draught",
                    remedy="draw the tank as a solid, or change the draught",
                )
        if plates:
            edges, plates = join_plates([(chain.edges, chain.body) for chain in chains], plates)
            chains = [replace(chain, edges=cut) for chain, cut in zip(chains, edges, strict=True)]
        object.__setattr__(self, "_chains", tuple(chains))
        object.__setattr__(self, "_wetted_plates", tuple(plates))

    def drawn(self) -> Array:
        """Return what to draw, outlines closed and parted by NaN; a plate runs there and back; shape (n, 2) [m]."""
        gap = np.full((1, 2), np.nan)
        pieces = []
        for outline in self.outlines:
            points = outline.edges.polyline()
            pieces += [points, points[:1], gap]
        for plate in self.plates:
            pieces += [plate.outline, plate.outline[-2::-1], gap]
        return np.concatenate(pieces[:-1])

    @property
    def wetted_plates(self) -> tuple[WettedPlate, ...]:
        """The parts of the plates that are under water, joined to what they touch.

        A plate that ends on an outline moves with it; the others are bodies of their own, numbered after the outlines.
        """
        plates: tuple[WettedPlate, ...] = self.__dict__["_wetted_plates"]
        return plates

    @property
    def chains(self) -> tuple[Chain, ...]:
        """The wetted boundary."""
        chains: tuple[Chain, ...] = self.__dict__["_chains"]
        return chains

    @cached_property
    def _moments(self) -> Array:
        values: Array = np.sum([chain.edges.moments() for chain in self.chains] + [(0.0, 0.0, 0.0)], axis=0)
        return values

    @property
    def area(self) -> float:
        """Displaced area [m2]."""
        return float(self._moments[0])

    @property
    def centroid(self) -> tuple[float, float]:
        """Centre of buoyancy (x, z) [m]; NaN for plates alone, which displace nothing."""
        area, first_x, first_z = self._moments
        if area == 0.0:
            return math.nan, math.nan
        return float(first_x / area), float(first_z / area)

    @cached_property
    def waterlines(self) -> tuple[tuple[float, float], ...]:
        """Left and right x [m] of each cut with the still water, from left to right; equal for a thin plate."""
        cuts = [
            (float(chain.edges.start[0, 0]), float(chain.edges.end[-1, 0])) for chain in self.chains if not chain.closed
        ]
        taken = {x for cut in cuts for x in cut}
        for plate in self.wetted_plates:
            for point in (plate.edges.start[0], plate.edges.end[-1]):
                if point[1] == 0.0 and float(point[0]) not in taken:
                    taken.add(float(point[0]))
                    cuts.append((float(point[0]), float(point[0])))
        return tuple(sorted(cuts))

    @property
    def waterplane_breadth(self) -> float:
        """Sum of the breadths of the waterlines [m]."""
        return sum(right - left for left, right in self.waterlines)

    @property
    def waterplane_first_moment(self) -> float:
        """Integral of x over the waterlines [m2], about x = 0."""
        return sum((right**2 - left**2) / 2.0 for left, right in self.waterlines)

    @property
    def waterplane_second_moment(self) -> float:
        """Integral of x^2 over the waterlines [m3], about x = 0."""
        return sum((right**3 - left**3) / 3.0 for left, right in self.waterlines)

    @cached_property
    def bounds(self) -> tuple[float, float, float, float]:
        """Smallest and largest x, smallest and largest z of the wetted boundary, plates included [m]."""
        lines = [chain.edges for chain in self.chains] + [plate.edges for plate in self.wetted_plates]
        every = np.array([edges.bounds() for edges in lines])
        return float(every[:, 0].min()), float(every[:, 1].max()), float(every[:, 2].min()), float(every[:, 3].max())

    @property
    def bottom(self) -> float:
        """Lowest z of the wetted boundary [m]."""
        return self.bounds[2]

    @property
    def keel(self) -> float:
        """Lowest z of the wetted outlines without plates [m]; of the plates where there are no outlines."""
        lines = [chain.edges for chain in self.chains] or [plate.edges for plate in self.wetted_plates]
        return min(edges.bounds()[2] for edges in lines)

    @property
    def surface_piercing(self) -> bool:
        """Whether any outline is cut by the still water."""
        return bool(self.waterlines)

    def symmetry_axis(self) -> float | None:
        """Return x [m] of the upright line about which the wetted boundary is its own mirror image, or None."""
        axis = 0.5 * (self.bounds[0] + self.bounds[1])
        size = max(self.bounds[1] - self.bounds[0], -self.bottom)

        def alone(lines: Sequence[Chain | WettedPlate], either_way: bool) -> bool:
            if not lines:
                return True
            pieces = [np.concatenate([c.edges.start, c.edges.end, c.edges.points(0.5)[:, 0]], axis=1) for c in lines]
            every = np.concatenate(pieces)
            mirrored = every[:, [2, 3, 0, 1, 4, 5]]
            mirrored[:, ::2] = 2.0 * axis - mirrored[:, ::2]
            if either_way:
                mirrored = np.concatenate([mirrored, mirrored[:, [2, 3, 0, 1, 4, 5]]])
            apart = np.abs(every[:, None, :] - mirrored[None, :, :]).max(axis=2).min(axis=1)
            return bool((apart < 1e-9 * size).all())

        # A plate on the axis, or across it, is not halved
        for plate in self.wetted_plates:
            low, high = plate.edges.bounds()[:2]
            if low < axis + 1e-6 * size and high > axis - 1e-6 * size:
                return None
        return axis if alone(self.chains, False) and alone(self.wetted_plates, True) else None


def _wetted(outline: Outline, body: int) -> Sequence[Chain]:
    """Cut one outline at the still water and gather its wetted edges into chains."""
    x_min, x_max, z_min, z_max = outline.bounds
    tolerance = _TOUCH * max(x_max - x_min, z_max - z_min)
    edges = outline.edges.cut_at_level(tolerance)
    wet = edges.points(0.5)[:, 0, 1] < -0.1 * tolerance
    if not wet.any():
        return ()
    # A break lies before every edge that starts on the still water or follows a dry edge
    breaks = np.flatnonzero(wet & ((edges.start[:, 1] == 0.0) | ~np.concatenate([wet[-1:], wet[:-1]])))
    if breaks.size == 0:
        return (Chain(edges, closed=True, body=body),)
    chains = []
    count = len(edges)
    for first in breaks:
        length = 1
        while wet[(first + length) % count] and edges.start[(first + length) % count, 1] != 0.0:
            length += 1
        chains.append(Chain(edges.taken((first + np.arange(length)) % count), closed=False, body=body))
    return chains
