"""Inertia coefficients of a section in ideal fluid: a boundary integral equation for the stream function.

The perturbed stream function is the real part of a Cauchy integral of a real density over the contour; its far field is
a doublet whose strength is the inertia of the fluid [eq:morison-inertia-integral] [eq:morison-inertia-doublet]. Panels
shrink geometrically towards corners, and close panels are integrated exactly, so that any polygon is resolved.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from moyai.core.arrays import Array, ComplexArray
from moyai.core.errors import ConvergenceError
from moyai.core.options import check_kind
from moyai.core.validity import IdentityCheck
from moyai.morison.contour import Contour

#: Unknowns that a matrix may have; beyond it panels are coarsened
_MOST_UNKNOWNS = 3000
#: Sum of distances to both ends, in half lengths, below which a panel is integrated exactly (an ellipse about it)
_NEAR = 3.2
#: Angle that a panel of an arc may turn to be taken for straight there [rad]
_STRAIGHT = 0.02


@dataclass(frozen=True, eq=False)
class InertiaCoefficients:
    """Ideal inertia coefficients of a section."""

    #: C_M in axes of the section: force per length rho A C_M a for an acceleration a of the fluid; shape (2, 2).
    tensor: Array
    #: Largest change of the tensor on refinement, over its largest entry: an estimate of its error.
    error: float
    #: Symmetry of the tensor, which the computation does not impose.
    checks: tuple[IdentityCheck, ...]

    @property
    def added_mass(self) -> Array:
        """Added mass over displaced mass, C_M - I [-]."""
        return np.asarray(self.tensor - np.eye(2))

    @property
    def principal(self) -> tuple[float, float]:
        """Smallest and largest principal inertia coefficient [-]."""
        values = np.linalg.eigvalsh(self.tensor)
        return float(values[0]), float(values[1])

    @property
    def principal_angle(self) -> float:
        """Angle of the axis of the smallest coefficient from the first axis [rad], in (-pi/2, pi/2].

        Zero where both principal coefficients agree to rounding, as for a circle or a square.
        """
        (xx, xz), (_, zz) = self.tensor
        if math.hypot(xx - zz, 2.0 * xz) < 1e-7 * (xx + zz):
            return 0.0
        angle = 0.5 * math.atan2(2.0 * xz, xx - zz) + 0.5 * math.pi
        return math.remainder(angle, math.pi) if abs(math.remainder(angle, math.pi)) > 1e-12 else 0.0


def inertia_coefficients(contour: Contour, *, accuracy: float = 1e-7) -> InertiaCoefficients:
    """Return the ideal inertia coefficients of any closed contour [eq:morison-inertia-integral].

    Parameters
    ----------
    contour : Contour
        Straight and circular edges, any corners, any slenderness.
    accuracy : float
        Aim relative to the largest coefficient; contours of many corners stop where the matrix would grow too large,
        which ``error`` shows.

    Returns
    -------
    InertiaCoefficients
        Tensor C_M [-], shape (2, 2), its error and the check of its symmetry.

    Raises
    ------
    InputError
        For what is no contour, a section for instance.
    ConvergenceError
        When the tensor changes by more than a tenth of a per cent on refinement or is not symmetric to that.

    Examples
    --------
    >>> from moyai.morison import inertia_coefficients, sections
    >>> circle = inertia_coefficients(sections.circle(1.0).contour)
    >>> circle.tensor.diagonal().round(6).tolist()                   # C_M = 2 in every direction
    [2.0, 2.0]
    """
    check_kind(contour, Contour, "contour", "take the contour of the section: section.contour")
    bulges = np.asarray(contour.bulges, dtype=float)
    return _remembered(contour.vertices.tobytes(), bulges.tobytes(), accuracy)


@lru_cache(maxsize=256)
def _remembered(vertices: bytes, bulges: bytes, accuracy: float) -> InertiaCoefficients:
    """Solve a contour given by its numbers once: a case needs its section at every step from check to report."""
    contour = Contour(np.frombuffer(vertices).reshape(-1, 2), np.frombuffer(bulges))
    levels, order = _resolution(contour, accuracy)
    coarse = _solve(contour, np.maximum(levels - 3, min(1, int(levels.min()))), max(order - 2, 4))
    tensor = _solve(contour, levels, order)
    scale = float(np.abs(tensor).max())
    error = max(float(np.abs(tensor - coarse).max()) / scale, 4e-15)
    skew = abs(tensor[0, 1] - tensor[1, 0]) / scale
    if not (error < 1e-3 and skew < 1e-3):
        raise ConvergenceError(
            f"inertia coefficients of the section change by {error:.2g} on refinement",
            parameter="section",
            remedy="draw it with fewer corners or less extreme proportions",
        )
    check = IdentityCheck(
        "symmetry of the inertia coefficients", skew, 1e-3, "C_M,xz = C_M,zx, two separate solutions (reciprocity)"
    )
    symmetric = 0.5 * (tensor + tensor.T)
    symmetric.flags.writeable = False
    return InertiaCoefficients(symmetric, error, (check,))


def _resolution(contour: Contour, accuracy: float) -> tuple[NDArray[np.int64], int]:
    """Return how often panels are halved towards each corner, and the Gauss order.

    Next to a corner the density behaves like r^(pi/angle) with the angle of the fluid, and an unresolved length r costs
    its square in the doublet; a corner that hardly turns costs in proportion to its turn.
    """
    count = len(contour.vertices)
    edge = np.arange(count)
    arriving = contour.slopes(np.roll(edge, 1), np.ones(count))
    leaving = contour.slopes(edge, np.zeros(count))
    turn = np.angle(leaving / arriving)
    exponent = math.pi / np.clip(math.pi + turn, 0.2, 2.0 * math.pi)
    order = 10 if count <= 40 else 6
    aim = accuracy
    while True:
        strength = np.maximum(np.abs(turn) / math.pi, 1e-16)
        levels = np.ceil(np.log2(np.maximum(strength / aim, 1.0)) / (2.0 * np.minimum(exponent, 2.0))).astype(np.int64)
        levels = np.clip(levels, 0 if count > 60 else 1, 40)
        unknowns = order * int(np.sum(np.maximum(levels + np.roll(levels, -1), 1)))
        if unknowns <= _MOST_UNKNOWNS or aim > 1e-2:
            return levels, order
        aim *= 4.0


def _panels(contour: Contour, levels: NDArray[np.int64]) -> tuple[NDArray[np.int64], Array, Array]:
    """Return edge, start and end fraction of every panel: halved towards corners, arcs further where needed."""
    count = len(contour.vertices)
    edges: list[int] = []
    starts: list[float] = []
    ends: list[float] = []
    for edge in range(count):
        here, there = int(levels[edge]), int(levels[(edge + 1) % count])
        cuts = [0.0, *(0.5 ** np.arange(here, 0, -1)), *(1.0 - 0.5 ** np.arange(2, there + 1)), 1.0]
        edges += [edge] * (len(cuts) - 1)
        starts += cuts[:-1]
        ends += cuts[1:]
    edge_of, start, end = np.array(edges), np.array(starts), np.array(ends)
    for _ in range(14):
        split = _arcs_too_long(contour, edge_of, start, end)
        if not split.any() or len(edge_of) + split.sum() > _MOST_UNKNOWNS // 6:
            break
        half = 0.5 * (start[split] + end[split])
        edge_of = np.concatenate([edge_of[~split], edge_of[split], edge_of[split]])
        start, end = (
            np.concatenate([start[~split], start[split], half]),
            np.concatenate([end[~split], half, end[split]]),
        )
    return edge_of, start, end


def _arcs_too_long(contour: Contour, edge_of: NDArray[np.int64], start: Array, end: Array) -> NDArray[np.bool_]:
    """Tell which panels of arcs turn too far or lie too close to another edge for Gauss's rule."""
    split = np.abs(contour.sweeps[edge_of]) * (end - start) > 1.6
    arcs = np.flatnonzero(np.abs(contour.sweeps[edge_of]) > 1e-12)
    if arcs.size == 0:
        return split
    count = len(contour.vertices)
    samples = np.concatenate([contour.positions(edge_of, start + f * (end - start)) for f in (0.0, 0.25, 0.5, 0.75)])
    sample_edge = np.tile(edge_of, 4)
    middle = contour.positions(edge_of, 0.5 * (start + end))
    length = contour.lengths[edge_of] * (end - start)
    for number in arcs:
        own = edge_of[number]
        skip = sample_edge == own
        # panels that end in a corner are small already
        skip |= (start[number] == 0.0) & (sample_edge == (own - 1) % count)
        skip |= (end[number] == 1.0) & (sample_edge == (own + 1) % count)
        if not skip.all():
            split[number] |= length[number] > 1.5 * np.abs(samples[~skip] - middle[number]).min()
    return split


def _near_rows(
    contour: Contour, edge: NDArray[np.int64], start: Array, end: Array, z: ComplexArray, order: int
) -> tuple[NDArray[np.int64], NDArray[np.int64], Array]:
    """Return target, panel and what to add to Gauss's weights for panels that lie close to points of other edges.

    The density is a Legendre series on the panel, and its Cauchy integral a sum of Legendre functions of the second
    kind [eq:morison-inertia-panel]: exact on straight panels however close the point is, so that slender sections need
    no more panels. The tiny panels of an arc at its corners are taken for straight in the difference to Gauss's rule.
    """
    nodes, weights = np.polynomial.legendre.leggauss(order)
    first, last = contour.positions(edge, start), contour.positions(edge, end)
    middle, half = 0.5 * (first + last), 0.5 * (last - first)
    straight = np.abs(contour.sweeps[edge]) * (end - start) <= _STRAIGHT
    place = (z[:, None] - middle[None, :]) / half[None, :]
    near = (np.abs(place - 1.0) + np.abs(place + 1.0) < _NEAR) & straight[None, :]
    near &= np.repeat(edge, order)[:, None] != edge[None, :]
    target, panel = np.nonzero(near)
    at = place[target, panel]
    before = np.asarray(0.5 * np.log((at + 1.0) / (at - 1.0)), dtype=np.complex128)
    now = np.asarray(at * before - 1.0, dtype=np.complex128)
    legendre = np.polynomial.legendre.legvander(nodes, order - 1)
    total = np.zeros((at.size, order))
    for k in range(order):
        total -= (2 * k + 1) * before.imag[:, None] * (legendre[:, k] * weights)[None, :]
        before, now = now, ((2 * k + 3) * at * now - (k + 1) * before) / (k + 2)
    total -= (weights / (nodes - at[:, None])).imag
    return target, panel, total / (2.0 * math.pi)


def _solve(contour: Contour, levels: NDArray[np.int64], order: int) -> Array:
    """Solve the stream function of both streams [eq:morison-inertia-integral] and return the tensor."""
    edge, start, end = _panels(contour, levels)
    nodes, weights = np.polynomial.legendre.leggauss(order)
    span = (end - start)[:, None]
    t = (start[:, None] + 0.5 * span * (1.0 + nodes)).ravel()
    weight = (0.5 * span * weights).ravel()
    edges = np.repeat(edge, order)
    z = contour.positions(edges, t)
    element = contour.slopes(edges, t) * weight
    distance = z[None, :] - z[:, None]
    np.fill_diagonal(distance, 1.0)
    matrix = (element[None, :] / distance).imag / (2.0 * math.pi)
    # on a straight edge the kernel vanishes, on an arc it is half the angle swept
    same = edges[None, :] == edges[:, None]
    swept = contour.sweeps[edges] * weight / (4.0 * math.pi)
    matrix = np.where(same, swept[None, :], matrix)
    target, panel, row = _near_rows(contour, edge, start, end, z, order)
    matrix[target[:, None], panel[:, None] * order + np.arange(order)] += row
    length = np.abs(element)
    # the last term fixes the constant of the density and gives the stream function on the contour
    matrix -= length[None, :] / length.sum()
    np.fill_diagonal(matrix, np.diagonal(matrix) - 0.5)
    root = np.sqrt(length)
    right = np.stack([-z.imag, z.real], axis=1)
    density = np.linalg.solve(matrix * root[:, None] / root[None, :], right * root[:, None]) / root[:, None]
    doublet = -(element @ density) / contour.area
    return np.array([[doublet[0].real, doublet[1].real], [doublet[0].imag, doublet[1].imag]])
