"""Panels with their Gauss-Legendre nodes, on the wetted boundary and on the free surface."""

from __future__ import annotations

import cmath
import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from moyai.core.arrays import Array, ComplexArray, IntArray

# Wetted boundary; free surface enclosed between bodies; other real free surface; free surface on a ray; thin plate,
# whose potential is the jump over it: the value where its normal points minus that behind
BODY, GAP, OPEN, RAY, PLATE = 0, 1, 2, 3, 4

#: Direction of the free-surface ray in the complex x-plane
RAY_DIRECTION = cmath.exp(0.25j * math.pi)


@dataclass(frozen=True, eq=False)
class Rule:
    """Gauss-Legendre rule of one panel with the matrices that go with it."""

    #: Nodes of the rule on [-1, 1]; shape (p,).
    nodes: Array
    #: Weights of the rule; shape (p,).
    weights: Array
    #: Legendre coefficients (rows) from node values; shape (p, p).
    projection: Array
    #: d/dt at the nodes from node values; shape (p, p).
    derivative: Array
    #: Value at t = -1 from node values; shape (p,).
    first: Array
    #: Value at t = 1 from node values; shape (p,).
    last: Array


@lru_cache(maxsize=16)
def gauss_rule(order: int) -> Rule:
    """Return the rule with ``order`` nodes."""
    nodes, weights = np.polynomial.legendre.leggauss(order)
    degree = np.arange(order)
    projection = (2 * degree[:, None] + 1) / 2.0 * np.polynomial.legendre.legvander(nodes, order - 1).T * weights
    slopes = np.polynomial.legendre.legval(nodes, np.polynomial.legendre.legder(np.eye(order))).T
    return Rule(nodes, weights, projection, slopes @ projection, (-1.0) ** degree @ projection, projection.sum(axis=0))


class Piece(NamedTuple):
    """One panel: first point u, chord, sweep [rad], grading, kind and number of the body.

    Grading: 0 none, -1 cubic into the start, 1 into the end, -2 and 2 the same quadratically.
    """

    start: complex
    step: complex
    sweep: float
    grade: int
    kind: int
    body: int


@dataclass(frozen=True, eq=False)
class Panels:
    """Panels and their nodes; those of a panel follow each other in the direction that has the fluid on its right."""

    #: The panels.
    pieces: tuple[Piece, ...]
    #: Nodes per panel.
    order: int
    #: x + i z; shape (nodes,).
    u: ComplexArray
    #: x - i z, the conjugate of u where x is real; shape (nodes,).
    v: ComplexArray
    #: Derivative of u with respect to the parameter t of the panel.
    du: ComplexArray
    #: Derivative of v with respect to t.
    dv: ComplexArray
    #: dsigma/dt: the speed on bodies, dx/dt on the free surface.
    element: ComplexArray
    #: ``element`` times the Gauss weight: sums over it are integrals along the boundary.
    weight: ComplexArray
    #: Kind of each node.
    kind: IntArray
    #: Body of each node.
    body: IntArray

    @property
    def kernel_panels(self) -> tuple[NDArray[Any], ...]:
        """The panels as the compiled quadrature wants them."""
        start = np.array([piece.start for piece in self.pieces], dtype=complex)
        step = np.array([piece.step for piece in self.pieces], dtype=complex)
        sweep = np.array([piece.sweep for piece in self.pieces], dtype=float)
        grade = np.array([piece.grade for piece in self.pieces], dtype=np.int64)
        kind = np.array([piece.kind for piece in self.pieces], dtype=np.int64)
        on_body = (kind == BODY) | (kind == PLATE)
        mirrored = np.where(on_body, start.conj(), start), np.where(on_body, step.conj(), step)
        return start, step, *mirrored, sweep, grade, kind != RAY

    @property
    def kernel_nodes(self) -> tuple[ComplexArray, ...]:
        """The nodes as the compiled quadrature wants them."""
        return self.u, self.v, self.du, self.dv, self.element

    @property
    def normal(self) -> Array:
        """Unit normals (nodes, 2) into the fluid; only for bodies."""
        out = -1j * self.du / np.abs(self.du)
        return np.stack([out.real, out.imag], axis=1)

    @property
    def points(self) -> Array:
        """Real parts x, z (nodes, 2)."""
        return np.stack([self.u.real, self.u.imag], axis=1)


def make_panels(pieces: Sequence[Piece], order: int) -> Panels:
    """Put ``order`` nodes on every piece."""
    rule = gauss_rule(order)
    start = np.array([piece.start for piece in pieces], dtype=complex)[:, None]
    step = np.array([piece.step for piece in pieces], dtype=complex)[:, None]
    half = 0.5 * np.array([piece.sweep for piece in pieces], dtype=float)[:, None]
    grade = np.array([piece.grade for piece in pieces], dtype=np.int64)[:, None]
    up, down = 0.5 * (1.0 + rule.nodes), 0.5 * (1.0 - rule.nodes)
    root = np.where(grade > 0, down, up)
    square = np.abs(grade) == 2
    from_end = np.where(grade == 0, root, np.where(square, root**2, root**3))
    fraction = np.where(grade > 0, 1.0 - from_end, from_end)
    slope = np.where(grade == 0, 0.5, np.where(square, root, 1.5 * root**2))
    # Position and slope of an arc, as in moyai.potential.edges
    ratio = fraction * np.sinc(half * fraction / np.pi) / np.sinc(half / np.pi) * np.exp(1j * half * (fraction - 1.0))
    change = np.exp(1j * half * (2.0 * fraction - 1.0)) / np.sinc(half / np.pi) * slope
    u = (start + step * ratio).ravel()
    du = (step * change).ravel()
    kind = np.repeat(np.array([piece.kind for piece in pieces], dtype=np.int64), order)
    solid = (kind == BODY) | (kind == PLATE)
    element = np.where(solid, np.abs(du), du).astype(complex)
    return Panels(
        pieces=tuple(pieces),
        order=order,
        u=u,
        v=np.where(solid, u.conj(), u),
        du=du,
        dv=np.where(solid, du.conj(), du),
        element=element,
        weight=np.tile(rule.weights, len(pieces)) * element,
        kind=kind,
        body=np.repeat(np.array([piece.body for piece in pieces], dtype=np.int64), order),
    )
