"""Natural frequencies and modes of a network about a state, from the tangent of its forces."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from moyai.core.arrays import Array, IntArray
from moyai.core.errors import InputError
from moyai.flexible import force_kernel as kernel
from moyai.flexible.arrays import kernel_arrays, kernel_bed
from moyai.flexible.flow import Flow
from moyai.flexible.network import Network, check_network
from moyai.flexible.parts import network_parts
from moyai.flexible.relaxation import kernel_system
from moyai.flexible.result import State
from moyai.flexible.sheet_kernel import sheet_added_mass

if TYPE_CHECKING:
    from scipy.sparse import csr_array


@dataclass(frozen=True, eq=False)
class NetworkModes:
    """Undamped modes about a state."""

    #: Angular frequencies, rising [rad/s]; 0 where the network may move freely or the state is not stable; shape (k,).
    omega: Array
    #: Modes, largest component 1; shape (k, n, 3).
    shape: Array


def natural_modes(network: Network, state: State, *, count: int = 6, flow: Flow | None = None) -> NetworkModes:
    """Solve K q = omega^2 M q with the tangent stiffness at a state, added mass included [eq:flexible-morison].

    Parameters
    ----------
    network : Network
        The network.
    state : State
        As from :func:`moyai.flexible.statics.solve_equilibrium`.
    count : int
        How many of the lowest.
    flow : Flow, optional
        Steady current; still water when left out.

    Returns
    -------
    NetworkModes
        Angular frequencies [rad/s], rising, shape (k,), and shapes (k, nodes, 3) in site axes, largest component 1.

    Raises
    ------
    InputError
        When nothing can move.

    Examples
    --------
    >>> from moyai.flexible import BarType, NetworkBuilder, natural_modes, solve_equilibrium
    >>> from moyai.sea import Water
    >>> builder = NetworkBuilder(Water(depth=10.0, density=1025.0, gravity=9.81))
    >>> rope = BarType("rope", mass_per_length=10.0, axial_stiffness=1e7, diameter=0.05)
    >>> builder.fixed("left", (0.0, 0.0, -2.0))
    >>> builder.fixed("right", (20.0, 0.0, -2.0))
    >>> builder.line("span", "left", "right", rope, length=21.0, segments=20)
    >>> network = builder.build()
    >>> modes = natural_modes(network, solve_equilibrium(network).state, count=3)
    >>> modes.omega.shape, modes.shape.shape                             # modes; modes, nodes, axes
    ((3,), (3, 21, 3))
    >>> round(float(modes.omega[0]), 2), round(float(abs(modes.shape[0, :, 1]).max()), 6)   # [rad/s], across the span
    (1.86, 1.0)
    """
    check_network(network)
    arrays = kernel_arrays(network)
    place = np.array(state.position)
    nodes = len(network.nodes)
    water = np.ascontiguousarray((flow or Flow()).at(1e300, place.T))
    mass, stiffness = tangent_matrices(network, place, water)
    moves = arrays.nodes[9:12].T.ravel() > 0.0
    if not moves.any():
        raise InputError("nothing in the network can move", parameter="network", allowed="a free node")
    values, vectors = _lowest(stiffness[moves][:, moves], mass[moves][:, moves], min(count, int(moves.sum())))
    shapes = np.zeros((values.size, 3 * nodes))
    shapes[:, moves] = vectors.T
    ordered = shapes.reshape(values.size, nodes, 3)
    largest = np.take_along_axis(
        ordered.reshape(values.size, -1), np.abs(ordered.reshape(values.size, -1)).argmax(axis=1)[:, None], axis=1
    )
    return NetworkModes(np.sqrt(np.maximum(values, 0.0)), ordered / largest[:, :, None])


def tangent_matrices(network: Network, place: Array, water: Array) -> tuple[csr_array, csr_array]:
    """Return mass with added mass and tangent stiffness about a place, (3n, 3n), made symmetric, without drag.

    The added mass of sections is that of their frames at this place.

    Parameters
    ----------
    network : Network
        The network.
    place : ndarray, shape (n, 3)
        Nodes [m].
    water : ndarray, shape (7, n)
        Velocity, acceleration, elevation of the water at the nodes.
    """
    from scipy.sparse import coo_array

    arrays, parts = kernel_arrays(network), network_parts(network)
    system, bed = kernel_system(arrays), kernel_bed(network)
    nodes, bars = len(network.nodes), len(network.bars)
    still, fluid = np.zeros_like(place), np.array([network.water.density, network.water.gravity, 0.0])
    calm = np.zeros_like(water)
    calm[6] = water[6]
    force, mass, tension = np.zeros((nodes, 3)), np.zeros((nodes, 6)), np.zeros(bars)
    kernel.forces(place, still, water, system, fluid, bed, force, tension, mass)
    sheets = network.sheets
    if sheets is not None:
        sheet_added_mass(
            sheets.constants(network.water, network.nodes.position), sheets.triangles,
            np.ascontiguousarray(place).ravel(), 0, 3, 1, water.ravel(), 0, 1, nodes, mass.reshape(-1), 0, 6, 1,
        )  # fmt: skip
    bar_law, node_law = np.zeros((2, bars)), np.zeros((4, nodes))
    kernel.laws(place, still, system, fluid, bed, 0.0, 1.0, bar_law, node_law)
    node_block, bar_block = np.zeros((nodes, 3, 3)), np.zeros((bars, 2, 3, 3))
    whole = np.arange(nodes)
    kernel.blocks(
        place, still, water, system, fluid, bed, mass, np.zeros((2, bars)), np.zeros((4, nodes)), 1.0, 0.0, 0.0, False,
        node_block, bar_block,
    )  # fmt: skip
    inertia = [(whole, whole, node_block.copy()), *_sections(network, place)]
    # exact, so that rods lose what they are pressed with; no velocity, so that no drag turns with them
    kernel.blocks(
        place, still, calm, system, fluid, bed, mass, bar_law, node_law, 0.0, 0.0, 1.0, True, node_block, bar_block
    )  # fmt: skip
    entries = [
        (whole, whole, node_block),
        (arrays.start, arrays.end, bar_block[:, 0]),
        (arrays.end, arrays.start, bar_block[:, 1]),
    ]
    for m in range(3):
        for n in range(3):
            if m != n and len(arrays.hinges):
                turn = np.stack([arrays.bending[:, 1], -arrays.bending[:, 1:].sum(axis=1), arrays.bending[:, 2]])
                scale = arrays.bending[:, 0] * turn[m] * turn[n]
                entries.append((arrays.hinges[:, m], arrays.hinges[:, n], scale[:, None, None] * np.eye(3)))
    for part in parts:
        found = part.blocks(place, still, calm, 1.0)
        for m in range(part.members.shape[1]):
            for n in range(part.members.shape[1]):
                entries.append((part.members[:, m], part.members[:, n], found[:, m, n]))

    def assembled(blocks: list[tuple[IntArray, IntArray, Array]]) -> csr_array:
        rows = np.concatenate([np.repeat(3 * i[:, None] + np.arange(3), 3, axis=1).ravel() for i, _, _ in blocks])
        columns = np.concatenate([np.tile(3 * j[:, None] + np.arange(3), (1, 3)).ravel() for _, j, _ in blocks])
        values = np.concatenate([b.reshape(-1) for _, _, b in blocks])
        return coo_array((values, (rows, columns)), shape=(3 * nodes, 3 * nodes)).tocsr()

    stiffness = assembled(entries)
    return assembled(inertia), (0.5 * (stiffness + stiffness.T)).tocsr()


def _sections(network: Network, place: Array) -> list[tuple[IntArray, IntArray, Array]]:
    """Return the added mass of sections in blocks of node pairs, turned and stretched as their guides are."""
    sections = network.blocks
    if sections is None:
        return []

    def ways(x: Array) -> Array:
        return np.asarray(x[sections.guides[..., 1], :2] - x[sections.guides[..., 0], :2])

    first = ways(network.nodes.position)
    way = ways(place) if sections.turning else first
    size = np.linalg.norm(way, axis=-1)
    root = np.sqrt(size / np.linalg.norm(first, axis=-1)) if sections.convective else np.ones_like(size)
    count = sections.nodes.shape[1]
    # local unknowns: the normal to the right of the way, then the vertical
    lever = np.zeros((*sections.nodes.shape, 2, 3))
    lever[..., 0, 0], lever[..., 0, 1] = root * way[..., 1] / size, -root * way[..., 0] / size
    lever[..., 1, 2] = root
    local = sections.added_mass.reshape(-1, 2, count, 2, count)
    added = np.einsum("gipa,gpiqj,gjqb->gijab", lever, local, lever)
    return [(sections.nodes[:, i], sections.nodes[:, j], added[:, i, j]) for i in range(count) for j in range(count)]


def _lowest(stiffness: csr_array, mass: csr_array, count: int) -> tuple[Array, Array]:
    """Return the lowest eigenvalues and their vectors: dense for small networks, by shift and inversion for others."""
    size = stiffness.shape[0]
    if size <= 600 or count > size // 4:
        from scipy.linalg import eigh

        values, vectors = eigh(stiffness.toarray(), mass.toarray(), subset_by_index=(0, count - 1))
        return np.asarray(values), np.asarray(vectors)
    from scipy.sparse.linalg import eigsh

    # just below the lowest eigenvalue, so that free motions do no harm
    scale = float(np.abs(stiffness.diagonal()).max() / mass.diagonal().min())
    values, vectors = eigsh(stiffness.tocsc(), k=count, M=mass.tocsc(), sigma=-1e-9 * scale, which="LM")
    order = np.argsort(values)
    return np.asarray(values[order]), np.asarray(vectors[:, order])
