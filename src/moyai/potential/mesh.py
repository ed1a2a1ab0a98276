"""Where panels go: graded towards corners and waterlines, finer in narrow places and where waves are short.

The free surface outside the bodies runs on a ray into the complex x-plane, x = X0 + s exp(i pi/4) to the right and its
mirror image to the left: an outgoing wave exp(ikx) and the local disturbance exp(-kx) both die out along it
[eq:potential-ray].
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from moyai.core.arrays import Array, ComplexArray
from moyai.core.errors import InputError
from moyai.potential.edges import Edges, arc_position, arc_slope, as_complex
from moyai.potential.panels import BODY, GAP, OPEN, PLATE, RAY, RAY_DIRECTION, Panels, Piece, make_panels
from moyai.potential.sections import Chain, Section

# No panel becomes shorter than this share of its edge
_SHORTEST = 1e-9
# Places along a panel at which the gap to other edges is looked at
_SAMPLES = np.linspace(0.0, 1.0, 7)
# Largest length of a panel times the wave number along the crest
_LARGEST_CREST = 4.0
# Largest turn of a circular panel [rad]
_LARGEST_TURN = 0.3 * math.pi
# exp(-_SHADE) is what is left of a wave where its short length no longer matters
_SHADE = 7.0
#: Most panels of one problem: a run at this bound takes some 6 GB; ordinary sections have 20 to 90
MOST_PANELS = 300
# Rays that serve all frequencies of an oblique heading are never solved as a whole: each frequency has shorter ones
_MOST_ON_A_RAY = 4000


@dataclass(frozen=True)
class Resolution:
    """How fine the panels are."""

    #: Gauss-Legendre nodes per panel.
    order: int = 8
    #: Largest panel length times wave number.
    wave: float = 3.0
    #: Largest panel at a corner, in terms of the local scale there.
    corner: float = 1.0
    #: Largest length of a panel, in terms of its distance from the corner.
    growth: float = 1.0
    #: Wave number times length of the ray: a wave has fallen to exp(-reach / sqrt 2) at its end.
    reach: float = 14.0
    #: In deep water the local disturbance dies out like 1/x^2 only: longer rays, by this factor.
    deep_reach: float = 8.0

    @classmethod
    def for_accuracy(cls, accuracy: float) -> Resolution:
        """Return the resolution that meets an error relative to the band maximum, by experience with a margin."""
        digits = max(0.0, -math.log10(accuracy) - 3.0)
        return cls(
            order=8 + math.ceil(1.5 * digits),
            reach=4.0 - math.sqrt(2.0) * math.log(accuracy),
            deep_reach=8.0 * 10.0 ** (0.5 * digits),
        )

    def refined(self) -> Resolution:
        """Return a finer resolution."""
        return Resolution(
            self.order + 2, 0.8 * self.wave, 0.7 * self.corner, self.growth, self.reach + 4.0, 4.0 * self.deep_reach
        )


@dataclass(frozen=True, eq=False)
class EdgeRun:
    """Edges one after the other, fluid on their right, with the places where the potential is singular."""

    #: The edges.
    edges: Edges
    #: Whether there is a corner (or the still water) before the first edge, between two, after the last; shape (n +
    #: 1,).
    corner: NDArray[np.bool_]
    #: Number of the outline.
    body: int
    #: BODY or PLATE.
    kind: int = BODY
    #: Whether the run starts and ends at a free edge of a plate.
    tips: tuple[bool, bool] = (False, False)


def all_runs(section: Section, depth: float, axis: float | None) -> list[EdgeRun]:
    """Return wetted boundary and plates as runs; only the part right of ``axis`` when it is given."""
    runs = body_runs(section, axis)
    joints = [
        complex(*point)
        for plate in section.wetted_plates
        for point, joined in zip((plate.edges.start[0], plate.edges.end[-1]), plate.joined)
        if joined
    ]
    runs = [replace(run, corner=run.corner | _at_points(run.edges, joints)) for run in runs]
    for plate in section.wetted_plates:
        if axis is not None and plate.edges.bounds()[1] <= axis:
            continue
        corner = _corners(plate.edges, False) | _at_points(plate.edges, joints)
        ends = plate.edges.start[0, 1], plate.edges.end[-1, 1]
        # An edge on the bed is not free: the jump of the potential continues in the mirror image
        tips = [not joined and z + depth > 1e-6 * -z for joined, z in zip(plate.joined, ends)]
        runs.append(EdgeRun(plate.edges, corner, plate.body, PLATE, (tips[0], tips[1])))
    return runs


def _at_points(edges: Edges, points: Sequence[complex]) -> NDArray[np.bool_]:
    """Tell which ends of edges (n + 1,) lie at one of the points."""
    ends = np.concatenate([as_complex(edges.start), as_complex(edges.end[-1:])])
    near = np.abs(ends[:, None] - np.array(points, dtype=complex)[None, :]) < 1e-9 * np.abs(ends).max()
    return np.asarray(near.any(axis=1))


def body_runs(section: Section, axis: float | None) -> list[EdgeRun]:
    """Return the wetted boundary as runs; only the part right of ``axis`` when it is given."""
    if axis is None:
        return [EdgeRun(chain.edges, _corners(chain.edges, chain.closed), chain.body) for chain in section.chains]
    size = max(section.bounds[1] - section.bounds[0], -section.bottom)
    runs: list[EdgeRun] = []
    for chain in section.chains:
        half = chain.edges.right_of(axis, 1e-9 * size)
        if len(half):
            runs.extend(_half_runs(half, axis, chain, 1e-9 * size))
    return runs


def _half_runs(half: Edges, axis: float, chain: Chain, tolerance: float) -> list[EdgeRun]:
    """Split the right half of a chain where it is interrupted; on the axis only a kink is a corner."""
    start, end = as_complex(half.start), as_complex(half.end)
    broken = np.abs(np.roll(start, -1) - end) > tolerance
    if not broken.any():
        return [EdgeRun(half, _corners(half, True), chain.body)]
    order = np.roll(np.arange(len(half)), -int(np.flatnonzero(broken)[0]) - 1)
    half, limits = half.taken(order), np.flatnonzero(broken[order]) + 1
    runs = []
    for lower, upper in itertools.pairwise([0, *limits]):
        edges = half.taken(np.arange(lower, upper))
        corner = _corners(edges, False)
        level = np.abs(_slopes(edges, np.array([0.0, 1.0])).imag) < 1e-3 * edges.lengths[:, None]
        if abs(edges.start[0, 0] - axis) < tolerance:
            corner[0] = not level[0, 0]
        if abs(edges.end[-1, 0] - axis) < tolerance:
            corner[-1] = not level[-1, 1]
        runs.append(EdgeRun(edges, corner, chain.body))
    return runs


def _slopes(edges: Edges, t: Array) -> ComplexArray:
    start, end = as_complex(edges.start)[:, None], as_complex(edges.end)[:, None]
    return arc_slope(start, end, edges.bulge[:, None], t[None, :])


def _corners(edges: Edges, closed: bool) -> NDArray[np.bool_]:
    slopes = _slopes(edges, np.array([0.0, 1.0]))
    turn = np.abs(np.angle(np.roll(slopes[:, 0], -1) / slopes[:, 1])) > 1e-3
    corner = np.concatenate([turn[-1:], turn])
    if not closed:
        corner[0] = corner[-1] = True
    return corner


class Surroundings:
    """What lies around a point: bed, still water, other edges and their mirror images; and how short the waves are."""

    def __init__(
        self, runs: Sequence[EdgeRun], depth: float, axis: float | None, wave_number: float, longest: float = math.inf
    ) -> None:
        self.longest = longest
        self.depth = depth
        self._wave_number = wave_number
        first, last, owner = [], [], []
        for number, run in enumerate(runs):
            for edge in range(len(run.edges)):
                line = run.edges.taken(np.array([edge])).polyline(math.radians(10.0))
                points = np.concatenate([as_complex(line), as_complex(run.edges.end[edge : edge + 1])])
                first.append(points[:-1])
                last.append(points[1:])
                owner += [(number, edge)] * (len(points) - 1)
        a, b, tags = np.concatenate(first), np.concatenate(last), np.array(owner)
        if axis is not None:
            a = np.concatenate([a, 2.0 * axis - a.conj()])
            b = np.concatenate([b, 2.0 * axis - b.conj()])
            tags = np.concatenate([tags, tags - np.array([len(runs), 0])])
        self._first, self._chord, self._owner = a, b - a, tags
        self._runs = tuple(runs)
        every = np.concatenate([a, b])
        self.size = float(max(np.ptp(every.real), -every.imag.min()))
        self._axis = axis
        self._joined = _joined_edges(runs, 1e-9 * self.size)

    def clearance(self, points: ComplexArray, run: int = -1, edge: int = -1) -> Array:
        """Distance of points from all edges but their own and its neighbours; the bed counts with its mirror image."""
        others = np.ones(len(self._first), dtype=bool)
        if run >= 0:
            edges = self._runs[run].edges
            apart = np.abs(self._owner[:, 1] - edge)
            others &= ~((self._owner[:, 0] == run) & ((apart <= 1) | (apart == len(edges) - 1)))
            for joined in self._joined.get((run, edge), ()):
                others &= ~(self._owner == np.array(joined)).all(axis=1)
            if self._axis is not None:
                # An edge that ends on the axis continues in its own mirror image
                ends = np.array([edges.start[edge, 0], edges.end[edge, 0]])
                if np.abs(ends - self._axis).min() < 1e-9 * np.ptp(ends):
                    others &= ~((self._owner[:, 0] == run - len(self._runs)) & (apart == 0))
        best = np.full(len(points), math.inf)
        bed = 2.0 * (self.depth + points.imag)
        if run >= 0 and self._runs[run].kind == PLATE:
            edges = self._runs[run].edges
            if min(edges.start[edge, 1], edges.end[edge, 1]) + self.depth < 1e-6 * self.size:
                bed = best  # a plate that stands on the bed continues in its mirror image
        if others.any():
            offset = points[:, None] - self._first[None, others]
            chord = self._chord[None, others]
            along = np.clip((offset / chord).real, 0.0, 1.0)
            best = np.abs(offset - along * chord).min(axis=1)
        values: Array = np.minimum(best, bed)
        return values

    def corner_scale(self, run: int, edge: int, place: int) -> float:
        """Local length at the start (0) or end (1) of an edge: its neighbour, other edges, bed, still water."""
        edges = self._runs[run].edges
        point = (edges.end if place else edges.start)[edge]
        scale = float(self.clearance(as_complex(point[None, :]), run, edge)[0])
        neighbour = edge + (1 if place else -1)
        closed = bool(np.abs(edges.start[0] - edges.end[-1]).max() < 1e-12 * np.abs(edges.start).max())
        if closed or 0 <= neighbour < len(edges):
            scale = min(scale, float(edges.lengths[neighbour % len(edges)]))
        for other_run, other_edge in self._joined.get((run, edge), ()):
            other = self._runs[other_run].edges
            ends = np.stack([other.start[other_edge], other.end[other_edge]])
            if np.abs(ends - point).max(axis=1).min() < 1e-9 * self.size:
                scale = min(scale, float(other.lengths[other_edge]))
        return min(scale, -float(point[1])) if point[1] < 0.0 else scale

    def surface_scale(self, x: float) -> float:
        """Local length at a point of the still water: the nearest end of an edge below it, or the depth."""
        ends = np.concatenate([self._first, self._first + self._chord])
        distance = np.abs(ends - x)
        return min(float(distance[distance > 1e-9 * np.abs(ends).max()].min()), self.depth)

    def wave_length_scale(self, level: float) -> float:
        """Inverse of the largest wave number that is still felt at the depth of ``level``."""
        return max(1.0 / self._wave_number, -level / _SHADE)


def _joined_edges(runs: Sequence[EdgeRun], tolerance: float) -> dict[tuple[int, int], list[tuple[int, int]]]:
    """Return the edges of other runs that share an end with an edge: plates on hulls and on plates."""
    if not any(run.kind == PLATE for run in runs):
        return {}
    tags = [(number, edge) for number, run in enumerate(runs) for edge in range(len(run.edges))]
    ends = np.concatenate([np.stack([as_complex(run.edges.start), as_complex(run.edges.end)], axis=1) for run in runs])
    meet = (np.abs(ends[:, None, :, None] - ends[None, :, None, :]) < tolerance).any(axis=(2, 3))
    return {
        tag: [other for index, other in enumerate(tags) if meet[number, index] and other[0] != tag[0]]
        for number, tag in enumerate(tags)
    }


def _cut(
    length: float,
    graded: tuple[bool, bool],
    scales: tuple[float, float],
    resolution: Resolution,
    enough: Callable[[float, float], bool],
) -> list[tuple[float, float, int]]:
    """Halve a line until its parts suit its graded ends and ``enough``; returns (low, high, grade) in order."""
    first, last = graded

    def fine(low: float, high: float) -> bool:
        size = (high - low) * length
        if low == 0.0 and first and ((high == 1.0 and last) or size > resolution.corner * scales[0]):
            return False
        if high == 1.0 and last and size > resolution.corner * scales[1]:
            return False
        if first and low > 0.0 and size > 1.001 * resolution.growth * low * length:
            return False
        if last and high < 1.0 and size > 1.001 * resolution.growth * (1.0 - high) * length:
            return False
        return enough(low, high)

    parts: list[tuple[float, float, int]] = []
    stack = [(0.0, 1.0)]
    while stack:
        low, high = stack.pop()
        if len(parts) + len(stack) > MOST_PANELS:
            raise too_many_panels()
        if high - low < _SHORTEST or fine(low, high):
            parts.append((low, high, -1 if low == 0.0 and first else 1 if high == 1.0 and last else 0))
        else:
            middle = 0.5 * (low + high)
            stack += [(middle, high), (low, middle)]
    return parts


def require_memory(layout: Layout) -> None:
    """Refuse panels whose dense matrices memory does not hold.

    Raises
    ------
    InputError
        For more than :data:`MOST_PANELS`.
    """
    if len(layout.panels.pieces) > MOST_PANELS:
        raise too_many_panels()


def too_many_panels() -> InputError:
    """Return the error of a section that no reasonable number of panels resolves."""
    return InputError(
        f"the section in its water needs more than {MOST_PANELS} panels on one side",
        parameter="section",
        allowed=f"at most {MOST_PANELS} panels",
        remedy="its largest length is far beyond its smallest gap, edge or draught, or beyond the shortest wave: check "
        "the units of beam, draught, points and periods",
    )


def _body_pieces(runs: Sequence[EdgeRun], around: Surroundings, resolution: Resolution) -> list[Piece]:
    """Cut the wetted boundary into panels."""
    pieces: list[Piece] = []
    for number, run in enumerate(runs):
        for edge, length in enumerate(run.edges.lengths):
            start, end = as_complex(run.edges.start[edge]), as_complex(run.edges.end[edge])
            bulge = run.edges.bulge[edge]
            sweep = 4.0 * math.atan(bulge)

            def enough(low: float, high: float) -> bool:
                size = (high - low) * length  # noqa: B023 - used within this turn of the loop only
                points = arc_position(start, end, bulge, low + (high - low) * _SAMPLES)  # noqa: B023
                if abs(sweep) * (high - low) > _LARGEST_TURN:  # noqa: B023
                    return False
                if size > min(around.longest, resolution.wave * around.wave_length_scale(float(points.imag.max()))):
                    return False
                gap = around.clearance(points, number, edge)  # noqa: B023
                return _wide_enough(size, gap)

            graded = bool(run.corner[edge]), bool(run.corner[edge + 1])
            scales = around.corner_scale(number, edge, 0), around.corner_scale(number, edge, 1)
            for low, high, grade in _cut(float(length), graded, scales, resolution, enough):
                a, b = arc_position(start, end, bulge, np.array([low, high]))
                first, last = edge == 0 and run.tips[0], edge == len(run.edges) - 1 and run.tips[1]
                if (grade < 0 and first) or (grade > 0 and last):
                    grade = 2 * grade  # the square root of a free edge
                pieces.append(Piece(complex(a), complex(b - a), sweep * (high - low), grade, run.kind, run.body))
            if len(pieces) > MOST_PANELS:
                raise too_many_panels()
    return pieces


def _wide_enough(size: float, gap: Array) -> bool:
    """Whether a panel suits the gap along it: short against it, or the gap hardly varies."""
    return size <= 3.0 * float(gap.min()) or float(gap.max()) < 1.3 * float(gap.min())


def _surface_pieces(
    section: Section, around: Surroundings, axis: float | None, band: tuple[float, float], resolution: Resolution
) -> list[Piece]:
    """Cut the free surface into panels from left to right: rays outside, real between; only x > axis if given."""
    left, right = section.bounds[0], section.bounds[1]
    edges = [x for line in section.waterlines for x in line]
    limits = [left, *edges, right]
    pieces: list[Piece] = []
    if axis is None:
        outward = _ray(left, left in edges, around, band, resolution)
        pieces += [
            piece._replace(start=2.0 * left - piece.start - piece.step, grade=-piece.grade) for piece in outward[::-1]
        ]
    for number, (low, high) in enumerate(zip(limits[::2], limits[1::2])):
        kind = GAP if 0 < number < len(edges) // 2 else OPEN
        begin = low if axis is None else max(low, axis)
        if high - begin > 1e-9 * (right - left):
            pieces += _real_surface(begin, high, (begin in edges, high in edges), kind, around, resolution)
    return pieces + _ray(right, right in edges, around, band, resolution)


def _ray(
    x: float, graded: bool, around: Surroundings, band: tuple[float, float], resolution: Resolution
) -> list[Piece]:
    """Panels of a ray to the right, each as long as its distance from ``x`` times the growth."""
    size = min(resolution.corner * around.surface_scale(x), resolution.wave / band[1])
    pieces: list[Piece] = []
    s = 0.0
    reach = _ray_length(around, band[0], resolution)
    while s < reach:
        grade = -1 if graded and not pieces else 0
        pieces.append(Piece(x + s * RAY_DIRECTION, size * RAY_DIRECTION, 0.0, grade, RAY, -1))
        s += size
        size = min(resolution.growth * s, around.longest)
        if len(pieces) > _MOST_ON_A_RAY:
            raise too_many_panels()
    return pieces


def _ray_length(around: Surroundings, along: float, resolution: Resolution) -> float:
    """Length [m] at which the wave has died out and the local disturbance as well.

    The disturbance falls algebraically, first with the size of the bodies, then with the wave length, until the bed (or
    the kernel of an oblique wave) cuts it off exponentially.
    """
    reach = resolution.reach
    wave = reach / along
    disturbance = resolution.deep_reach * max(wave, 0.6 * reach * around.size)
    return max(wave, min(disturbance, 0.4 * reach * around.depth, around.longest * reach / _LARGEST_CREST))


def _real_surface(
    low: float, high: float, graded: tuple[bool, bool], kind: int, around: Surroundings, resolution: Resolution
) -> list[Piece]:
    """Panels of the real free surface between bodies or above them."""
    length = high - low

    def enough(a: float, b: float) -> bool:
        size = (b - a) * length
        if size > min(around.longest, resolution.wave * around.wave_length_scale(0.0)):
            return False
        if (a == 0.0 and graded[0]) or (b == 1.0 and graded[1]):
            return True  # in the wedge between body and surface the grading does the work
        x = low + length * (a + (b - a) * _SAMPLES)
        return _wide_enough(size, around.clearance(x.astype(complex)))

    scales = around.surface_scale(low), around.surface_scale(high)
    return [
        Piece(complex(low + a * length), complex((b - a) * length), 0.0, grade, kind, -1)
        for a, b, grade in _cut(length, graded, scales, resolution, enough)
    ]


@dataclass(frozen=True, eq=False)
class Layout:
    """Panels of one problem: the body first, then the free surface."""

    #: Only the half to the right of ``axis`` where the section is symmetric.
    panels: Panels
    #: Number of nodes on the body.
    body_count: int
    #: Axis of symmetry [m].
    axis: float | None

    @property
    def whole_body(self) -> Panels:
        """Panels of the whole body; the mirrored half comes first, in reversed order."""
        return self._whole(slice(0, self.body_count // self.panels.order))

    @property
    def whole_surface(self) -> Panels:
        """Panels of the whole free surface, the mirrored half first, in reversed order."""
        return self._whole(slice(self.body_count // self.panels.order, None))

    def _whole(self, part: slice) -> Panels:
        pieces = self.panels.pieces[part]
        if self.axis is None:
            return make_panels(pieces, self.panels.order)
        return make_panels([_mirrored(piece, self.axis) for piece in pieces[::-1]] + list(pieces), self.panels.order)


def _mirrored(piece: Piece, axis: float) -> Piece:
    """Mirror image of a piece about the axis, traversed so that the fluid stays on its right."""
    last = piece.start + piece.step
    if piece.kind in (BODY, PLATE):
        return piece._replace(start=2.0 * axis - last.conjugate(), step=piece.step.conjugate(), grade=-piece.grade)
    return piece._replace(start=2.0 * axis - last, grade=-piece.grade)


def lay_out(
    section: Section,
    depth: float,
    band: tuple[float, float],
    resolution: Resolution,
    *,
    crest_wave_number: float = 0.0,
    body: Layout | None = None,
) -> Layout:
    """Put panels on a section in water of ``depth``.

    Parameters
    ----------
    section : Section
        The wetted boundary.
    depth : float
        Water depth [m].
    band : (float, float)
        Lowest wave number across the section (it makes the rays long) and highest wave number [1/m].
    resolution : Resolution
        How fine.
    crest_wave_number : float
        Wave number along the crest; the kernel dies out over its inverse, and no panel is much longer than that.
    body : Layout, optional
        Take the panels of the body from there.
    """
    axis = section.symmetry_axis()
    runs = all_runs(section, depth, axis)
    longest = _LARGEST_CREST / crest_wave_number if crest_wave_number > 0.0 else math.inf
    around = Surroundings(runs, depth, axis, band[1], longest)
    if body is None:
        pieces = _body_pieces(runs, around, resolution)
    else:
        pieces = list(body.panels.pieces[: body.body_count // body.panels.order])
    surface = _surface_pieces(section, around, axis, band, resolution)
    return Layout(make_panels(pieces + surface, resolution.order), len(pieces) * resolution.order, axis)
