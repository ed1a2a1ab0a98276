"""Dense added mass of sections: the nodes of a column of a sheet feel each other's acceleration through the water."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from moyai.core.arrays import Array, IntArray
from moyai.core.errors import InputError
from moyai.core.options import checks_words
from moyai.flexible import mass_block_kernel as kernel
from moyai.flexible.numbers import numbers_of, whole_numbers


@checks_words
@dataclass(frozen=True, eq=False)
class MassBlocks:
    """Added mass of groups of nodes over local unknowns: normal velocities first, then the vertical ones.

    The normal of a node lies in plan, across the way between its two guides (its neighbours along the cable) and to
    the right of it: with guides along +y the normal is +x. The matrices stay as they are given while the frames turn
    and stretch with the guides.

    Raises
    ------
    InputError
        For shapes that do not fit, a node in two groups, a guide that is the node itself twice, or matrices that are
        not symmetric or give energy back.
    """

    #: Nodes of each group (a section of the sheet), no node twice; shape (g, k).
    nodes: IntArray
    #: Neighbours of each node along the cable, before and behind; shape (g, k, 2).
    guides: IntArray
    #: Symmetric, not negative [kg]; shape (g, 2 k, 2 k).
    added_mass: Array
    #: Whether the forces that follow from turning and stretching frames are kept, so that the energy of the water is
    #: conserved; without them only added mass times acceleration acts, as the papers have it.
    convective: bool = True
    #: Whether the frames follow their guides. Held ones keep the directions and lengths of the start: for motions that
    #: turn the sheet little, and energy is kept whatever the cloth does; then ``convective`` is off.
    turning: bool = True

    def __post_init__(self) -> None:
        if self.convective and not self.turning:
            raise InputError(
                "held frames have no forces of rotation",
                parameter="blocks.convective",
                allowed="false with turning false",
            )
        nodes = np.array(whole_numbers(self.nodes, "blocks.nodes"))
        if nodes.ndim != 2 or nodes.size == 0:
            raise InputError(f"groups of shape {nodes.shape}", parameter="blocks.nodes", allowed="(groups, nodes)")
        groups, count = nodes.shape
        guides = np.array(whole_numbers(self.guides, "blocks.guides"))
        added = numbers_of(self.added_mass, "blocks.added_mass")
        for name, array, shape in (
            ("guides", guides, (groups, count, 2)),
            ("added_mass", added, (groups, 2 * count, 2 * count)),
        ):
            if array.shape != shape:
                raise InputError(f"{name} has shape {array.shape}", parameter=f"blocks.{name}", allowed=str(shape))
        if np.unique(nodes).size != nodes.size:
            raise InputError("a node belongs to two sections", parameter="blocks.nodes", allowed="each node once")
        if np.any(guides[..., 0] == guides[..., 1]):
            raise InputError("both guides of a node are the same", parameter="blocks.guides", allowed="two nodes")
        finite = bool(np.isfinite(added).all())
        if not finite or np.any(
            np.abs(added - added.transpose(0, 2, 1)) > 1e-6 * np.max(np.abs(added), initial=1e-300)
        ):
            raise InputError("an added mass is not symmetric or not finite", parameter="blocks.added_mass")
        added = 0.5 * (added + added.transpose(0, 2, 1))
        least = np.linalg.eigvalsh(added)[:, 0]
        if np.any(least < -1e-6 * np.max(np.abs(added))):
            raise InputError(
                f"the added mass of section {int(np.argmin(least))} has the negative value {least.min():.3g} kg",
                parameter="blocks.added_mass",
                allowed="not negative in any direction",
            )
        for name, array in (("nodes", nodes), ("guides", guides), ("added_mass", added)):
            array.setflags(write=False)
            object.__setattr__(self, name, array)

    def __len__(self) -> int:
        return int(self.nodes.shape[0])


@dataclass(frozen=True, eq=False)
class PackedBlocks:
    """Blocks ready for the kernels."""

    #: Nodes, as in :class:`MassBlocks`.
    nodes: IntArray
    #: Guides, as in :class:`MassBlocks`.
    guides: IntArray
    #: Directions, roots of the stretch and first lengths of the guides, shares of the own mass in the inverse; the
    #: kernels turn them; shape (g, k, 6).
    frames: Array
    #: Added mass and inverse of the whole mass [kg]; zero rows where held; shape (g, 2 k, 2 k).
    added: Array
    #: Added mass and inverse of the whole mass [1/kg]; zero rows where held; shape (g, 2 k, 2 k).
    inverse: Array
    #: One over the own mass of each node, for motion along the cable [1/kg]; zero where held; shape (g, k).
    along: Array
    #: One over the own mass of every node of the network, and over its mass along the normal of its section [1/kg];
    #: that normal in plan, which the kernels turn; shape (4, n).
    light: Array


def no_blocks(light: Array) -> PackedBlocks:
    """Return what a network without blocks hands to the kernels."""
    none = np.zeros((0, 0), dtype=np.int64)
    return PackedBlocks(
        none, np.zeros((0, 0, 2), dtype=np.int64), np.zeros((0, 0, kernel.COLUMNS)), np.zeros((0, 0, 0)),
        np.zeros((0, 0, 0)), np.zeros((0, 0)), light,
    )  # fmt: skip


def pack_blocks(blocks: MassBlocks | None, place: ArrayLike, mass: Array, free: Array) -> PackedBlocks:
    """Return blocks with the inverse of their whole mass.

    Parameters
    ----------
    blocks : MassBlocks or None
        Of the network.
    place : array_like, shape (3, n)
        Where the nodes stand; first lengths of the guides are those here [m].
    mass : ndarray, shape (n,)
        Own mass of the nodes [kg].
    free : ndarray, shape (3, n)
        1 where a component is free.
    """
    own_light = np.where(free.max(axis=0) > 0.0, 1.0 / mass, 0.0)
    light = np.stack([own_light, own_light, np.zeros_like(mass), np.zeros_like(mass)])
    if blocks is None:
        return no_blocks(light)
    groups, count = blocks.nodes.shape
    position = np.ascontiguousarray(place, dtype=np.float64)
    frames = np.zeros((groups, count, kernel.COLUMNS))
    way = position[:2, blocks.guides[..., 1]] - position[:2, blocks.guides[..., 0]]
    frames[..., kernel.LENGTH] = np.hypot(way[0], way[1])
    if np.any(frames[..., kernel.LENGTH] <= 0.0):
        raise InputError("guides of a section are at one place", parameter="blocks.guides", allowed="apart in plan")
    kernel.set_frames(blocks.nodes, blocks.guides, frames, position.ravel(), 0, position.shape[1], False)
    light[2, blocks.nodes], light[3, blocks.nodes] = frames[..., kernel.SIN], -frames[..., kernel.COS]
    own = mass[blocks.nodes]
    # in no state of the frames yet: taken at once
    inverse = np.zeros_like(blocks.added_mass)
    mobile = np.ascontiguousarray(free, dtype=np.float64).ravel()
    room = kernel.room_for(blocks.nodes)
    kernel.refresh_inverse(blocks.nodes, frames, blocks.added_mass, inverse, own, mobile, 0, len(mass), -1.0, room)
    light[1, blocks.nodes] = np.einsum("gii->gi", inverse)[:, :count]
    along = np.where(np.minimum(free[0], free[1])[blocks.nodes] > 0.0, 1.0 / own, 0.0)
    # a node that is both guides of its own turns no frame
    guides = blocks.guides.copy() if blocks.turning else np.repeat(blocks.nodes[..., None], 2, axis=2)
    return PackedBlocks(blocks.nodes.copy(), guides, frames, blocks.added_mass.copy(), inverse, along, light)


__all__ = ["MassBlocks", "PackedBlocks", "no_blocks", "pack_blocks"]
