"""Variation of a quantity over its panels: parabolas through neighbours, areas and Rankine terms that follow from them.

A value a panel stands for its centre. Along both directions of a panel a parabola through the centres of its
neighbours gives how the quantity varies over it [eq:units-parabola]; what that adds to integrals with a smooth factor
are other areas [eq:units-areas], what it adds to the layers of 1/r is computed once for all frequencies
[eq:units-rankine]. Neighbours share a side and turn little: nothing is drawn round a sharp edge.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.sparse import csr_array

from moyai.core.arrays import Array, IntArray
from moyai.core.compiled import njit
from moyai.sea.vector_kernel import REORDER
from moyai.structures.units.mesh import PanelMesh

#: Least cosine between the normals of neighbours
LEAST_COSINE = 0.85
#: Points a direction of Gauss's rule, and the distance over the radius of a panel up to which each is taken
_RULES = ((32, 1.5), (12, 4.0), (4, 10.0), (2, np.inf))
#: Points of the rule for moments of a panel itself
_OF_MOMENTS = 3
#: Rows of the Rankine terms at once
_ROWS = 200


@dataclass(frozen=True, eq=False)
class Variation:
    """How quantities vary over the panels of a mesh."""

    #: Reciprocal of the two directions of every panel [-]: s and t of a point are frame @ (point - centre) [m]; shape
    #: (n, 2, 3).
    frame: Array
    #: Factors of s, t, s^2, t^2 [1/m, 1/m, 1/m2, 1/m2] from the values at the centres.
    slopes: tuple[csr_array, ...]
    #: That give the integral of a smooth quantity from its values at the centres [m2]; shape (n,).
    areas: Array


def neighbours(mesh: PanelMesh) -> IntArray:
    """Return for each side of every panel (n, 4) the panel beyond times four plus its side; -1 where there is none."""
    corners = mesh.corners
    scale = 1e-7 * float(np.ptp(corners.reshape(-1, 3), axis=0).max())
    _, name = np.unique(np.round(corners.reshape(-1, 3) / scale).astype(np.int64), axis=0, return_inverse=True)
    name = name.reshape(-1, 4)
    ends = np.sort(np.stack([name, np.roll(name, -1, axis=1)], axis=-1), axis=-1).reshape(-1, 2)
    out = np.full(len(ends), -1, dtype=np.int64)
    order = np.lexsort(ends.T)
    same = (ends[order[1:]] == ends[order[:-1]]).all(axis=1) & (ends[order[1:], 0] != ends[order[1:], 1])
    # a side of three panels or more joins none of them
    lone = same & ~np.r_[False, same[:-1]] & ~np.r_[same[1:], False]
    one, other = order[:-1][lone], order[1:][lone]
    normal = mesh.normal
    flat = (mesh.part[one // 4] == mesh.part[other // 4]) & (
        np.einsum("ij,ij->i", normal[one // 4], normal[other // 4]) > LEAST_COSINE
    )
    one, other = one[flat], other[flat]
    out[one], out[other] = other, one
    return out.reshape(-1, 4)


def variation_of(mesh: PanelMesh) -> Variation:
    """Return the parabolas of a mesh [eq:units-parabola]."""
    count, centre, corners = mesh.count, mesh.centre, mesh.corners
    beyond = neighbours(mesh)
    across = 0.5 * (corners[:, 1] + corners[:, 2] - corners[:, 0] - corners[:, 3])
    along = 0.5 * (corners[:, 2] + corners[:, 3] - corners[:, 0] - corners[:, 1])
    axes = np.stack([across, along], axis=1)
    axes /= np.linalg.norm(axes, axis=2)[:, :, None]
    frame: Array = np.asarray(np.linalg.pinv(axes).transpose(0, 2, 1), dtype=float)
    slopes: list[csr_array] = [csr_array((count, count))] * 4
    for axis, (front, back) in enumerate(((1, 3), (2, 0))):
        first, far, sign = _chain(beyond, front, back)
        slopes[axis], slopes[axis + 2] = _parabolas(centre, first, far, sign)
    moments = _moments(mesh, frame)
    areas = mesh.area + sum(slope.T @ moment for slope, moment in zip(slopes, moments))
    return Variation(frame, tuple(slopes), np.asarray(areas))


def even_variation(mesh: PanelMesh) -> Variation:
    """Return no variation at all."""
    nothing = csr_array((mesh.count, mesh.count))
    return Variation(np.zeros((mesh.count, 2, 3)), (nothing,) * 4, mesh.area)


def _chain(beyond: IntArray, front: int, back: int) -> tuple[IntArray, IntArray, Array]:
    """Return the neighbour of every panel on one side and the one on the other side or next in line; -1 for none.

    The third is 0 of panels with a neighbour on either side, else the direction in which both lie.
    """
    ahead, behind = beyond[:, front], beyond[:, back]
    lone = (ahead < 0) | (behind < 0)
    first = np.where(ahead < 0, behind, ahead)
    # through the neighbour and out by its opposite side
    opposite = np.where(first < 0, -1, first // 4 * 4 + (first % 4 + 2) % 4)
    next_one = np.where(first < 0, -1, beyond.ravel()[opposite])
    second = np.where(lone, next_one, behind)
    sign = np.where(lone, np.where(ahead < 0, -1.0, 1.0), 0.0)
    return np.where(first < 0, -1, first // 4), np.where(second < 0, -1, second // 4), sign


def _parabolas(centre: Array, first: IntArray, second: IntArray, sign: Array) -> tuple[csr_array, csr_array]:
    """Return the factors of distance and of its square of parabolas through centres; a line through two."""
    count = len(centre)
    own = np.arange(count)
    one = np.linalg.norm(centre[first] - centre, axis=1) * np.where(sign == 0.0, 1.0, sign)
    step = np.linalg.norm(centre[second] - np.where((sign == 0.0)[:, None], centre, centre[first]), axis=1)
    two = np.where(sign == 0.0, -step, one + sign * step)
    three = (first >= 0) & (second >= 0)
    pair = (first >= 0) & (second < 0)
    apart = np.where(three, two - one, 1.0)
    one, two = np.where(first >= 0, one, 1.0), np.where(three, two, 2.0)
    slope_one = np.where(three, two / (one * apart), np.where(pair, 1.0 / one, 0.0))
    slope_two = np.where(three, -one / (two * apart), 0.0)
    bend_one, bend_two = np.where(three, -1.0 / (one * apart), 0.0), np.where(three, 1.0 / (two * apart), 0.0)

    def matrix(of_one: Array, of_two: Array) -> csr_array:
        values = np.concatenate([of_one, of_two, -of_one - of_two])
        columns = np.concatenate([np.where(first < 0, own, first), np.where(second < 0, own, second), own])
        return csr_array((values, (np.tile(own, 3), columns)), shape=(count, count))

    return matrix(slope_one, slope_two), matrix(bend_one, bend_two)


def _rule(points: int) -> tuple[Array, Array]:
    """Return shares of the corners (p, 4) and u, v and weight (p, 3) of Gauss's points on the unit square."""
    node, weight = np.polynomial.legendre.leggauss(points)
    u, v = (0.5 * (item.ravel() + 1.0) for item in np.meshgrid(node, node, indexing="ij"))
    share = np.stack([(1 - u) * (1 - v), u * (1 - v), u * v, (1 - u) * v], axis=1)
    return share, np.stack([u, v, 0.25 * np.outer(weight, weight).ravel()], axis=1)


def gauss_points(corners: Array, points: int) -> tuple[Array, Array]:
    """Return points (n, p, 3) on panels and their areas (n, p)."""
    share, place = _rule(points)
    a, b, c, d = (corners[:, None, index] for index in range(4))
    u, v = place[None, :, 0, None], place[None, :, 1, None]
    one = (1 - v) * (b - a) + v * (c - d)
    other = (1 - u) * (d - a) + u * (c - b)
    area = np.linalg.norm(np.cross(one, other), axis=2) * place[:, 2]
    return np.einsum("pk,nkx->npx", share, corners), area


def _moments(mesh: PanelMesh, frame: Array) -> Array:
    """Return the integrals of s, t, s^2, t^2 over every panel (4, n)."""
    point, area = gauss_points(mesh.corners, _OF_MOMENTS)
    local = np.einsum("nkx,npx->knp", frame, point - mesh.centre[:, None])
    return np.asarray(np.einsum("knp,np->kn", np.concatenate([local, local**2]), area))


@njit(cache=True, error_model="numpy", fastmath=REORDER)
def _add_moments(one: float, two: float, px: float, py: float, pz: float, frame: Any, single: Any, double: Any) -> None:
    """Add two values at a point, from the centre of its panel, to their moments with s, t, s^2, t^2 (4, ...)."""
    s = frame[0, 0] * px + frame[0, 1] * py + frame[0, 2] * pz
    t = frame[1, 0] * px + frame[1, 1] * py + frame[1, 2] * pz
    single[0] += one * s
    single[1] += one * t
    single[2] += one * s * s
    single[3] += one * t * t
    double[0] += two * s
    double[1] += two * t
    double[2] += two * s * s
    double[3] += two * t * t


@njit(cache=True, error_model="numpy", fastmath=True)
def _layers(
    target: Any, image: Any, centre: Any, normal: Any, frame: Any, radius: Any, own: Any,
    near: Any, points: Any, areas: Any, single: Any, double: Any,
) -> None:  # fmt: skip
    """Add the integrals of s, t, s^2, t^2 times 1/r and times its normal derivative over panels (4, rows, n).

    ``image`` is 1 for the source itself, -1 for a mirror of it: a flat panel has no double layer on itself.
    """
    for row in range(target.shape[0]):
        for panel in range(centre.shape[0]):
            x, y, z = target[row, 0], target[row, 1], target[row, 2]
            dx, dy, dz = x - centre[panel, 0], y - centre[panel, 1], z - centre[panel, 2]
            ratio = np.sqrt(dx * dx + dy * dy + dz * dz) / radius[panel]
            rule = 0
            while ratio > near[rule]:
                rule += 1
            place, size = points[rule], areas[rule]
            flat = own[row] == panel and image > 0
            for p in range(place.shape[1]):
                px, py, pz = place[panel, p, 0], place[panel, p, 1], place[panel, p, 2]
                rx, ry, rz = x - px, y - py, z - pz
                square = rx * rx + ry * ry + rz * rz
                one = size[panel, p] / np.sqrt(square)
                two = 0.0
                if not flat:
                    two = one / square * (rx * normal[panel, 0] + ry * normal[panel, 1] + rz * normal[panel, 2])
                px, py, pz = px - centre[panel, 0], py - centre[panel, 1], pz - centre[panel, 2]
                _add_moments(one, two, px, py, pz, frame[panel], single[:, row, panel], double[:, row, panel])


@njit(cache=True, error_model="numpy", fastmath=REORDER)
def _log_layers(
    target: Any, centre: Any, normal: Any, frame: Any, radius: Any, near: Any, points: Any, areas: Any, single: Any,
    double: Any,
) -> None:  # fmt: skip
    """Add the same of ln(r + d), r and d distance from and depth below a mirror of the source in the surface.

    The integrals of 1 stand behind those of s, t, s^2, t^2 (5, rows, n), in the double layer without the part of 1/r.
    """
    for row in range(target.shape[0]):
        for panel in range(centre.shape[0]):
            x, y, z = target[row, 0], target[row, 1], target[row, 2]
            dx, dy, dz = x - centre[panel, 0], y - centre[panel, 1], z - centre[panel, 2]
            ratio = np.sqrt(dx * dx + dy * dy + dz * dz) / radius[panel]
            rule = 0
            while ratio > near[rule]:
                rule += 1
            place, size = points[rule], areas[rule]
            for p in range(place.shape[1]):
                px, py, pz = place[panel, p, 0], place[panel, p, 1], place[panel, p, 2]
                rx, ry, rz = x - px, y - py, z - pz
                r = np.sqrt(rx * rx + ry * ry + rz * rz)
                one = size[panel, p] * np.log(r + rz)
                level = (normal[panel, 0] * rx + normal[panel, 1] * ry) / (r + rz)
                two = -size[panel, p] / r * (level + normal[panel, 2])
                px, py, pz = px - centre[panel, 0], py - centre[panel, 1], pz - centre[panel, 2]
                _add_moments(one, two, px, py, pz, frame[panel], single[:, row, panel], double[:, row, panel])
                single[4, row, panel] += one
                double[4, row, panel] -= size[panel, p] / r * level


def images_of(points: Array, depth: float) -> list[tuple[Array, int]]:
    """Return points (p, 3), 1, and their mirrors in the surface and in a bed at a depth [m], -1."""
    mirrored = points * np.array([1.0, 1.0, -1.0])
    images = [(points, 1), (mirrored, -1)]
    if np.isfinite(depth):
        images.append((mirrored - np.array([0.0, 0.0, 2.0 * depth]), -1))
    return images


def rankine_terms(
    mesh: PanelMesh, part: IntArray, found: Variation, depth: float, constant: Callable[[Array], tuple[Array, Array]]
) -> tuple[Array, Array]:
    """Return single and double layer (q, n) of 1/r and its mirrors on a part of the panels [eq:units-rankine].

    Parameters
    ----------
    mesh : PanelMesh
    part : ndarray (q,) of int
        Panels whose centres are the targets.
    found : Variation
    depth : float
        Of the water [m].
    constant : callable
        Single and double layer of -1/(4 pi r) at points, of even panels.

    Returns
    -------
    tuple of ndarray (q, n)
        Of the source, its mirror in the surface and that in the bed.
    """
    near, places, areas, radius = _rules_of(mesh)
    out = np.empty((2, len(part), mesh.count))
    for start in range(0, len(part), _ROWS):
        own = part[start : start + _ROWS]
        layers = np.zeros((2, 4, len(own), mesh.count))
        even = np.zeros((2, len(own), mesh.count))
        for point, image in images_of(mesh.centre[own], depth):
            _layers(
                point, image, mesh.centre, mesh.normal, found.frame, radius, own, near, places, areas, *layers
            )  # fmt: skip
            even += constant(point)
        out[:, start : start + _ROWS] = even + _varied(layers, found) * (-0.25 / np.pi)
    return out[0], out[1]


def log_terms(
    mesh: PanelMesh, points: Array, found: Variation, constant: Callable[[Array], tuple[Array, Array]]
) -> tuple[Array, Array]:
    """Return single and double layer (q, n) of what grows like a logarithm, over K, at points (q, 3).

    That is ln(r_1 + |z + zeta|) / 2 pi [eq:units-log]; the variation over panels counts, as in [eq:units-rankine].
    ``constant`` as for :func:`rankine_terms`.
    """
    near, places, areas, radius = _rules_of(mesh)
    out = np.empty((2, len(points), mesh.count))
    for start in range(0, len(points), _ROWS):
        mirrored = points[start : start + _ROWS] * np.array([1.0, 1.0, -1.0])
        layers = np.zeros((2, 5, len(mirrored), mesh.count))
        _log_layers(mirrored, mesh.centre, mesh.normal, found.frame, radius, near, places, areas, *layers)
        total = (layers[:, 4] + _varied(layers, found)) * (0.5 / np.pi)
        # its derivative upwards is 1/r, which grows too fast for points
        total[1] += 2.0 * mesh.normal[:, 2] * constant(mirrored)[0]
        out[:, start : start + _ROWS] = total
    return out[0], out[1]


def _rules_of(mesh: PanelMesh) -> tuple[Array, tuple[Array, ...], tuple[Array, ...], Array]:
    """Return up to which distance rules serve, their points and areas, and the radii of the panels."""
    rules = [gauss_points(mesh.corners, points) for points, _ in _RULES]
    radius = np.linalg.norm(mesh.corners - mesh.centre[:, None], axis=2).max(axis=1)
    near = np.array([limit for _, limit in _RULES])
    return near, tuple(item[0] for item in rules), tuple(item[1] for item in rules), radius


def _varied(layers: Array, found: Variation) -> Array:
    """Return what the variation adds to layers (2, q, n) with moments (2, 4 or more, q, n)."""
    out = np.zeros((2, *layers.shape[2:]))
    for number, slope in enumerate(found.slopes):
        transposed = slope.T.tocsr()
        for layer in range(2):
            out[layer] += (transposed @ layers[layer, number].T).T
    return out
