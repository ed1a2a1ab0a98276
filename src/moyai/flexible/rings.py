"""Elastic rings: closed pipes, round or with corners at rest, such as the collar and the sinker tube of a net cage."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from moyai.core.arrays import Array, IntArray
from moyai.core.errors import InputError
from moyai.flexible.numbers import numbers_of, whole_numbers


@dataclass(frozen=True, eq=False)
class Ring:
    """A closed pipe through nodes of a network; its axial stiffness, mass and loads belong to the bars between them.

    Raises
    ------
    InputError
        For fewer than four nodes, nodes that repeat, a rest shape that is not plane or encloses nothing, or a
        stiffness that is not positive.
    """

    #: For results.
    name: str
    #: Around the ring; shape (k,).
    nodes: IntArray
    #: Places of the nodes in the stress-free shape, anywhere in space; that shape has to be plane [m]; shape (k, 3).
    rest: Array
    #: EI, the same in all directions [N m2].
    bending_stiffness: float
    #: GJ [N m2].
    torsional_stiffness: float

    def __post_init__(self) -> None:
        nodes = np.array(whole_numbers(self.nodes, f"rings.{self.name}.nodes"))
        rest = numbers_of(self.rest, f"rings.{self.name}.rest")
        if nodes.ndim != 1 or nodes.size < 4 or np.unique(nodes).size != nodes.size:
            raise InputError(
                f"ring {self.name!r} goes through {nodes.size} node(s), {np.unique(nodes).size} of them different",
                parameter=f"rings.{self.name}.nodes",
                allowed="four or more different nodes",
            )
        if rest.shape != (nodes.size, 3) or not np.isfinite(rest).all():
            raise InputError(
                f"rest shape of ring {self.name!r} has the shape {rest.shape}",
                parameter=f"rings.{self.name}.rest",
                allowed=f"({nodes.size}, 3), finite",
            )
        for key in ("bending_stiffness", "torsional_stiffness"):
            value = getattr(self, key)
            if not (isinstance(value, int | float) and math.isfinite(value) and value > 0.0):
                raise InputError(f"{key} of ring {self.name!r} is {value!r}", parameter=key, allowed="greater than 0")
        spread = np.linalg.svd(rest - rest.mean(axis=0), compute_uv=False)
        if spread[2] > 1e-6 * spread[0]:
            raise InputError(
                f"rest shape of ring {self.name!r} is not plane",
                parameter=f"rings.{self.name}.rest",
                allowed="plane points",
            )
        way = np.linalg.norm(np.roll(rest, -1, axis=0) - rest, axis=1)
        size = float(np.linalg.norm(np.sum(np.cross(rest - rest[0], np.roll(rest, -1, axis=0) - rest[0]), axis=0)))
        if way.min() <= 1e-9 * way.sum() or size <= 1e-6 * way.sum() ** 2:
            raise InputError(
                f"rest shape of ring {self.name!r} has two neighbours in one place, or encloses nothing",
                parameter=f"rings.{self.name}.rest",
                allowed="points apart around an area",
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
    """Rings for the kernels."""

    #: Nodes of all rings, one after the other.
    nodes: IntArray
    #: Where each begins; shape (rings + 1,).
    first: IntArray
    #: EI over the mean length at the node [N m], one over the bar before and behind [1/m], rest curvature times that
    #: length (chord of the unit vectors) [-], GJ over the bar behind [N m], rest angle of the bar behind [rad]; shape
    #: (nodes, 6).
    rows: Array
    #: Stress-free places [m]; shape (nodes, 3).
    rest: Array

    @property
    def system(self) -> tuple[IntArray, IntArray, Array]:
        """What the kernels take."""
        return self.nodes, self.first, self.rows

    @cached_property
    def hinges(self) -> tuple[IntArray, Array]:
        """Node triples and (EI over mean length, 1/l1, 1/l2) of all rings, for bounds of their stiffness.

        EI is raised where a coarse ring that is much stiffer in torsion than in bending requires it
        [eq:cage-ring-step].
        """
        triples, stiffness = [np.zeros((0, 3), np.int64)], [np.zeros((0, 3))]
        for r in range(self.first.size - 1):
            a, b = int(self.first[r]), int(self.first[r + 1])
            own = self.nodes[a:b]
            triples.append(np.stack([np.roll(own, 1), own, np.roll(own, -1)], axis=1))
            raised = self.rows[a:b, :3].copy()
            raised[:, 0] *= self._excess(a, b)
            stiffness.append(raised)
        return np.concatenate(triples), np.concatenate(stiffness)

    def _excess(self, a: int, b: int) -> float:
        """Return the stiffness of a ring at rest over the bound that its hinges give, 1 or more."""
        from moyai.flexible.ring_kernel import ring_forces

        count, rest = b - a, self.rest[a:b]
        system = (np.arange(count), np.array([0, count]), np.ascontiguousarray(self.rows[a:b]))
        width, matrix = 1e-6 / float(self.rows[a, 2]), np.empty((3 * count, 3 * count))
        for column in range(3 * count):
            pull = np.zeros((2, count, 3))
            for side, sign in enumerate((1.0, -1.0)):
                place = rest.copy()
                place.ravel()[column] += sign * width
                ring_forces(place, system, pull[side])
            matrix[:, column] = (pull[1] - pull[0]).ravel() / (2.0 * width)
        bound = 4.0 * self.rows[a:b, 0] * (self.rows[a:b, 1] + self.rows[a:b, 2]) ** 2
        root = np.repeat(1.0 / np.sqrt(bound), 3)
        whole = 0.5 * (matrix + matrix.T) * root[:, None] * root
        return max(1.0, 1.02 * float(np.linalg.eigvalsh(whole)[-1]))

    @classmethod
    def of(cls, rings: tuple[Ring, ...]) -> RingArrays:
        """Flatten rings."""
        nodes, rows, first = [np.zeros(0, np.int64)], [np.zeros((0, 6))], [0]
        rest = np.concatenate([np.zeros((0, 3)), *(ring.rest for ring in rings)])
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
        return cls(
            np.concatenate(nodes), np.array(first, dtype=np.int64), np.ascontiguousarray(np.concatenate(rows)), rest
        )


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
