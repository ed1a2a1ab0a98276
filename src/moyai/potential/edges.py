"""Straight and circular edges: position, slope, exact cuts at the still water, moments, clashes.

Points of the plane are complex numbers x + i z here; everything is vectorised over edges.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import ArrayLike, NDArray

from moyai.core.arrays import Array, ComplexArray

# Integrates the moments of an arc (trigonometric polynomials of degree 3 over at most one turn) to rounding
_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(32)


def as_complex(points: ArrayLike) -> ComplexArray:
    """Return points (..., 2) as x + i z."""
    values = np.asarray(points, dtype=float)
    return values[..., 0] + 1j * values[..., 1]


def as_points(position: ArrayLike) -> Array:
    """Return x + i z as points (..., 2)."""
    values = np.asarray(position, dtype=complex)
    return np.stack([values.real, values.imag], axis=-1)


def arc_position(start: ComplexArray, end: ComplexArray, bulge: Array, t: Array | float) -> ComplexArray:
    """Position at the arc-length fraction ``t`` (0..1) of edges with bulge tan(sweep / 4); all broadcast."""
    if not np.any(bulge):
        straight: ComplexArray = start + (end - start) * (t + 0.0 * bulge)
        return straight
    half_sweep = 2.0 * np.arctan(bulge)
    ratio = t * np.sinc(half_sweep * t / np.pi) / np.sinc(half_sweep / np.pi)
    values: ComplexArray = start + (end - start) * ratio * np.exp(1j * half_sweep * (t - 1.0))
    return values


def arc_slope(start: ComplexArray, end: ComplexArray, bulge: Array, t: Array | float) -> ComplexArray:
    """Derivative of :func:`arc_position` with respect to ``t``; its modulus is the length of the edge."""
    if not np.any(bulge):
        straight: ComplexArray = end - start + 0.0 * bulge * t
        return straight
    half_sweep = 2.0 * np.arctan(bulge)
    values: ComplexArray = (end - start) / np.sinc(half_sweep / np.pi) * np.exp(1j * half_sweep * (2.0 * t - 1.0))
    return values


@dataclass(frozen=True, eq=False)
class Edges:
    """A run of straight and circular edges, one after the other."""

    #: Start (x, z) of each edge [m]; shape (n, 2).
    start: Array
    #: End (x, z) of each edge [m]; shape (n, 2).
    end: Array
    #: tan(sweep / 4) of each edge: 0 is straight, positive turns counter-clockwise, 1 is a half circle; shape (n,).
    bulge: Array

    def __post_init__(self) -> None:
        for name in ("start", "end", "bulge"):
            values = np.array(getattr(self, name), dtype=float)
            values.flags.writeable = False
            object.__setattr__(self, name, values)

    def __len__(self) -> int:
        return len(self.bulge)

    @property
    def lengths(self) -> Array:
        """Length of each edge [m]."""
        return np.asarray(np.abs(arc_slope(as_complex(self.start), as_complex(self.end), self.bulge, 0.0)))

    def points(self, t: ArrayLike) -> Array:
        """Return points (n, m, 2) at the arc-length fractions ``t`` (m,), 0 at the start, 1 at the end of each edge."""
        fractions = np.atleast_1d(np.asarray(t, dtype=float))
        start, end = as_complex(self.start)[:, None], as_complex(self.end)[:, None]
        return as_points(arc_position(start, end, self.bulge[:, None], fractions[None, :]))

    def polyline(self, largest_turn: float = math.radians(2.5)) -> Array:
        """Return points (n, 2) along the run but the last; chords turn at most ``largest_turn`` [rad]."""
        pieces = []
        for start, end, bulge in zip(as_complex(self.start), as_complex(self.end), self.bulge):
            count = max(1, math.ceil(abs(4.0 * math.atan(bulge)) / largest_turn))
            pieces.append(arc_position(start, end, bulge, np.arange(count) / count))
        return as_points(np.concatenate(pieces))

    def moments(self) -> tuple[float, float, float]:
        """Return the integrals of x dz, x^2/2 dz and x z dz (area and first moments of what the run encloses)."""
        t = 0.5 * (1.0 + _NODES)
        start, end, bulge = as_complex(self.start)[:, None], as_complex(self.end)[:, None], self.bulge[:, None]
        position, slope = arc_position(start, end, bulge, t), arc_slope(start, end, bulge, t)
        x, z, dz = position.real, position.imag, 0.5 * _WEIGHTS * slope.imag
        return float((x * dz).sum()), float((0.5 * x * x * dz).sum()), float((x * z * dz).sum())

    def bounds(self) -> tuple[float, float, float, float]:
        """Return smallest x, largest x, smallest z, largest z [m], bulging arcs included."""
        start, end = as_complex(self.start), as_complex(self.end)
        found = [start, end]
        curved = np.abs(self.bulge) > 1e-12
        if curved.any():
            # The tangent of an arc turns evenly: it is level or upright at these fractions
            a, b, bulge = start[curved], end[curved], self.bulge[curved]
            sweep = 4.0 * np.arctan(bulge)
            first = np.angle(np.asarray(arc_slope(a, b, bulge, 0.0), dtype=complex))
            quarter = 0.5 * np.pi * np.arange(-10, 11)
            t = (quarter[None, :] - first[:, None]) / sweep[:, None]
            position = arc_position(a[:, None], b[:, None], bulge[:, None], np.clip(t, 0.0, 1.0))
            found.append(position.ravel())
        every = np.concatenate(found)
        return float(every.real.min()), float(every.real.max()), float(every.imag.min()), float(every.imag.max())

    def taken(self, chosen: slice | NDArray[np.bool_] | NDArray[np.intp]) -> Edges:
        """Return the chosen edges."""
        return Edges(self.start[chosen], self.end[chosen], self.bulge[chosen])

    def cut_at_level(self, tolerance: float) -> Edges:
        """Return the run with every edge split where it crosses z = 0 and end points within ``tolerance`` put on it."""
        starts: list[complex] = []
        ends: list[complex] = []
        bulges: list[float] = []
        lengths = self.lengths.tolist()
        for start, end, bulge, length in zip(
            as_complex(self.start).tolist(), as_complex(self.end).tolist(), self.bulge.tolist(), lengths, strict=True
        ):
            fractions = [t for t in _level_crossings(start, end, bulge) if min(t, 1.0 - t) * length > tolerance]
            limits = [0.0, *sorted(fractions), 1.0]
            inner = [complex(arc_position(start, end, bulge, t)).real for t in limits[1:-1]]
            corners = [start, *(complex(x) for x in inner), end]
            corners = [complex(one.real) if abs(one.imag) <= tolerance else one for one in corners]
            starts.extend(corners[:-1])
            ends.extend(corners[1:])
            bulges.extend(math.tan(math.atan(bulge) * (b - a)) for a, b in pairwise(limits))
        return Edges(as_points(starts), as_points(ends), np.array(bulges))

    def right_of(self, x: float, tolerance: float) -> Edges:
        """Return the edges to the right of the upright line at ``x``, cut where they cross it."""
        quarter = 1j * (as_complex(self.start) - x), 1j * (as_complex(self.end) - x)
        turned = Edges(as_points(quarter[0]), as_points(quarter[1]), self.bulge).cut_at_level(tolerance)
        back = Edges(
            as_points(x - 1j * as_complex(turned.start)), as_points(x - 1j * as_complex(turned.end)), turned.bulge
        )
        return back.taken(back.points(0.5)[:, 0, 0] > x)


def _level_crossings(start: complex, end: complex, bulge: float) -> list[float]:
    """Arc-length fractions in (0, 1) at which an edge crosses z = 0.

    On the circle through both ends, the point with weights tau and (1 - tau) exp(i sweep / 2) runs along the arc, so
    that its level is a quadratic in tau that stays well conditioned when the arc becomes straight.
    """
    half_sweep = 2.0 * math.atan(bulge)
    turn = complex(math.cos(half_sweep), math.sin(half_sweep))
    chord = end - start
    # z(tau) |den|^2 = z0 |den|^2 + Im(chord tau conj(den)), den = tau + (1 - tau) turn = turn + tau (1 - turn)
    gap = 1.0 - turn
    quadratic = start.imag * abs(gap) ** 2 + (chord * gap.conjugate()).imag
    linear = 2.0 * start.imag * (turn * gap.conjugate()).real + (chord * turn.conjugate()).imag
    constant = start.imag
    if abs(quadratic) < 1e-14 * (abs(linear) + abs(constant)):
        roots = [-constant / linear] if linear != 0.0 else []
    else:
        discriminant = linear * linear - 4.0 * quadratic * constant
        if discriminant <= 0.0:
            return []
        larger = -0.5 * (linear + math.copysign(math.sqrt(discriminant), linear))
        roots = [larger / quadratic] + ([constant / larger] if larger != 0.0 else [])
    fractions = []
    for tau in roots:
        if 0.0 < tau < 1.0:
            if abs(half_sweep) < 1e-9:
                fractions.append(tau)
            else:
                angle = math.atan2(tau * math.sin(half_sweep), (1.0 - tau) + tau * math.cos(half_sweep))
                fractions.append(angle / half_sweep)
    return fractions


def polygon_clash(points: Array, tolerance: float) -> tuple[float, float] | None:
    """Return a point where a closed polygon crosses, touches or folds back on itself, or None."""
    a = as_complex(points)
    b = np.roll(a, -1)
    count = len(a)
    turn = np.angle(np.roll(b - a, -1) / (b - a))
    folded = np.flatnonzero(np.abs(np.abs(turn) - np.pi) < 1e-9)
    if folded.size:
        corner = b[folded[0]]
        return float(corner.real), float(corner.imag)
    first, second = np.triu_indices(count, 2)
    apart = ~((first == 0) & (second == count - 1))
    first, second = first[apart], second[apart]
    found = segments_meet(a[first], b[first], a[second], b[second], tolerance)
    if not found.any():
        return None
    where = a[first[np.flatnonzero(found)[0]]]
    return float(where.real), float(where.imag)


def segments_meet(
    a: ComplexArray, b: ComplexArray, c: ComplexArray, d: ComplexArray, tolerance: float
) -> NDArray[np.bool_]:
    """Tell which segments a-b and c-d cross or come closer than ``tolerance`` (arrays broadcast)."""

    def side(p: ComplexArray, q: ComplexArray, r: ComplexArray) -> Array:
        return np.asarray(((q - p).conj() * (r - p)).imag)

    crossing = (side(a, b, c) * side(a, b, d) < 0.0) & (side(c, d, a) * side(c, d, b) < 0.0)

    def distance(p: ComplexArray, q: ComplexArray, r: ComplexArray) -> Array:
        with np.errstate(invalid="ignore", divide="ignore"):
            t = np.clip(np.nan_to_num(((r - p) / (q - p)).real), 0.0, 1.0)
        return np.asarray(np.abs(p + t * (q - p) - r))

    nearest = np.minimum.reduce([distance(a, b, c), distance(a, b, d), distance(c, d, a), distance(c, d, b)])
    return np.asarray(crossing | (nearest < tolerance))


def inside_polygon(points: Array, polygon: Array) -> NDArray[np.bool_]:
    """Tell which points (n, 2) lie within the closed polygon (m, 2), by the winding of its sides."""
    p = as_complex(points)[:, None]
    a = as_complex(polygon)[None, :]
    b = np.roll(a, -1, axis=1)
    with np.errstate(invalid="ignore", divide="ignore"):
        turn = np.angle((b - p) / (a - p)).sum(axis=1)
    return np.asarray(np.abs(turn) > np.pi)
