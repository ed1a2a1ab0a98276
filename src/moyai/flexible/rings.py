"""Elastic rings: closed pipes, round or with corners at rest, such as the collar and the sinker tube of a net cage."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from moyai.core.errors import InputError

Array = NDArray[np.float64]
IntArray = NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class Ring:
    """A closed pipe through nodes of a network; its axial stiffness, mass and loads belong to the bars between them.

    Parameters
    ----------
    name : str
        For results.
    nodes : array_like of int, shape (k,)
        Around the ring.
    rest : array_like, shape (k, 3)
        Places of the nodes in the stress-free shape, anywhere in space; that shape has to be plane [m].
    bending_stiffness : float
        EI, the same in all directions [N m2].
    torsional_stiffness : float
        GJ [N m2].

    Raises
    ------
    InputError
        For fewer than four nodes, nodes that repeat, a rest shape that is not plane, or a stiffness that is not
        positive.
    """

    name: str
    nodes: IntArray
    rest: Array
    bending_stiffness: float
    torsional_stiffness: float

    def __post_init__(self) -> None:
        nodes, rest = np.array(self.nodes, dtype=np.int64), np.array(self.rest, dtype=np.float64)
        if nodes.size < 4 or np.unique(nodes).size != nodes.size:
            raise InputError(
                f"ring {self.name!r} goes through {nodes.size} node(s), {np.unique(nodes).size} of them different",
                path=f"rings.{self.name}.nodes",
                allowed="four or more different nodes",
            )
        if rest.shape != (nodes.size, 3) or not np.isfinite(rest).all():
            raise InputError(
                f"rest shape of ring {self.name!r} has the shape {rest.shape}",
                path=f"rings.{self.name}.rest",
                allowed=f"({nodes.size}, 3), finite",
            )
        for key in ("bending_stiffness", "torsional_stiffness"):
            value = getattr(self, key)
            if not (math.isfinite(value) and value > 0.0):
                raise InputError(f"{key} of ring {self.name!r} is {value:g}", path=key, allowed="greater than 0")
        spread = np.linalg.svd(rest - rest.mean(axis=0), compute_uv=False)
        if spread[2] > 1e-6 * spread[0]:
            raise InputError(
                f"rest shape of ring {self.name!r} is not plane", path=f"rings.{self.name}.rest", allowed="plane points"
            )
        for key, array in (("nodes", nodes), ("rest", rest)):
            array.setflags(write=False)
            object.__setattr__(self, key, array)

    @property
    def lengths(self) -> Array:
        """Unstretched length from each node to the next [m]."""
        return np.asarray(np.linalg.norm(np.roll(self.rest, -1, axis=0) - self.rest, axis=1))


@dataclass(frozen=True, eq=False)
class RingArrays:
    """Rings for the kernels.

    Parameters
    ----------
    nodes : ndarray of int
        Nodes of all rings, one after the other.
    first : ndarray of int, shape (rings + 1,)
        Where each begins.
    rows : ndarray, shape (nodes, 6)
        EI over the mean length at the node [N m], one over the bar before and behind [1/m], rest curvature times that
        length (chord of the unit vectors) [-], GJ over the bar behind [N m], rest angle of the bar behind [rad].
    """

    nodes: IntArray
    first: IntArray
    rows: Array

    @property
    def system(self) -> tuple[IntArray, IntArray, Array]:
        """What the kernels take."""
        return self.nodes, self.first, self.rows

    @property
    def hinges(self) -> tuple[IntArray, Array]:
        """Node triples and (EI over mean length, 1/l1, 1/l2) of all rings, for bounds of their stiffness."""
        triples = []
        for r in range(self.first.size - 1):
            own = self.nodes[self.first[r] : self.first[r + 1]]
            triples.append(np.stack([np.roll(own, 1), own, np.roll(own, -1)], axis=1))
        return (np.concatenate(triples) if triples else np.zeros((0, 3), np.int64)), self.rows[:, :3].copy()

    @classmethod
    def of(cls, rings: tuple[Ring, ...]) -> RingArrays:
        """Flatten rings."""
        nodes, rows, first = [np.zeros(0, np.int64)], [np.zeros((0, 6))], [0]
        for ring in rings:
            length = ring.lengths
            before = np.roll(length, 1)
            ahead = (np.roll(ring.rest, -1, axis=0) - ring.rest) / length[:, None]
            turn = ahead - np.roll(ahead, 1, axis=0)
            chord = np.linalg.norm(turn, axis=1)
            normal = np.sum(np.cross(ring.rest, np.roll(ring.rest, -1, axis=0)), axis=0)
            # a corner that turns outwards is curved the other way round
            side = np.sign(np.einsum("ij,j->i", np.cross(np.roll(ahead, 1, axis=0), ahead), normal))
            angle = side * 2.0 * np.arcsin(np.minimum(0.5 * chord, 1.0))
            rows.append(
                np.stack(
                    [
                        ring.bending_stiffness / (0.5 * (before + length)),
                        1.0 / before,
                        1.0 / length,
                        side * chord,
                        ring.torsional_stiffness / length,
                        0.5 * (angle + np.roll(angle, -1)),
                    ],
                    axis=1,
                )
            )
            nodes.append(ring.nodes)
            first.append(first[-1] + ring.nodes.size)
        return cls(np.concatenate(nodes), np.array(first, dtype=np.int64), np.ascontiguousarray(np.concatenate(rows)))


def ring_moments(rings: tuple[Ring, ...], position: Array) -> list[Array]:
    """Return bending in the plane, bending out of it, and torsion in the bar behind, at the nodes of each ring [N m].

    Parameters
    ----------
    rings : tuple of Ring
    position : ndarray, shape (n, 3)
        Nodes of the network [m].
    """
    from moyai.flexible.ring_kernel import ring_loads

    arrays = RingArrays.of(rings)
    x = np.ascontiguousarray(position.T)
    force, moments = np.zeros_like(x), np.zeros((arrays.nodes.size, 3))
    ring_loads(x[0], x[1], x[2], arrays.system, force[0], force[1], force[2], moments)
    return [moments[a:b] for a, b in zip(arrays.first[:-1], arrays.first[1:], strict=True)]
