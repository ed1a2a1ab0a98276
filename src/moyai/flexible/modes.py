"""Natural frequencies and modes of a network about a state, from the tangent of its forces."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from moyai.core.errors import InputError
from moyai.flexible import implicit_kernel as kernel
from moyai.flexible.arrays import kernel_arrays
from moyai.flexible.flow import Flow
from moyai.flexible.network import Network
from moyai.flexible.result import State
from moyai.flexible.statics import kernel_bed, kernel_system, order_of_unknowns

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Modes:
    """Undamped modes about a state.

    Parameters
    ----------
    omega : ndarray, shape (k,)
        Angular frequencies, rising [rad/s]; 0 where the network may move freely.
    shape : ndarray, shape (k, n, 3)
        Modes, largest component 1.
    """

    omega: Array
    shape: Array


def natural_modes(network: Network, state: State, *, count: int = 6, flow: Flow | None = None) -> Modes:
    """Solve K q = omega^2 M q with the tangent stiffness at a state, added mass included.

    Parameters
    ----------
    network, state
        As from :func:`moyai.flexible.statics.solve_equilibrium`.
    count : int
        How many of the lowest.
    flow : Flow, optional
        Steady current.

    Raises
    ------
    InputError
        When nothing can move.
    """
    from scipy.linalg import eigh

    arrays = kernel_arrays(network)
    rank, width = order_of_unknowns(arrays)
    place = np.array(state.position)
    nodes, still = len(network.nodes), np.zeros_like(place)
    water = (flow or Flow()).at(1e300, place.T)
    system, fluid = kernel_system(arrays), np.array([network.water.density, network.water.gravity, 0.0])
    force, mass, tension = np.zeros((nodes, 3)), np.zeros((nodes, 6)), np.zeros(len(network.bars))
    kernel.forces(place, still, water, system, fluid, kernel_bed(network), force, tension, mass)
    dense = []
    for by_mass, by_place in ((1.0, 0.0), (0.0, 1.0)):
        band = np.zeros((3 * nodes, width + 1))
        kernel.tangent(
            place, still, water, system, fluid, kernel_bed(network), mass, rank, by_mass, 0.0, by_place, band
        )
        matrix = np.zeros((3 * nodes, 3 * nodes))
        for below in range(width + 1):
            rows = np.arange(below, 3 * nodes)
            matrix[rows, rows - below] = matrix[rows - below, rows] = band[below:, width - below]
        dense.append(matrix)
    moves = np.empty(3 * nodes, dtype=bool)
    for axis, name in enumerate(("free_x", "free_y", "free_z")):
        moves[3 * rank + axis] = arrays.node(name) > 0.0
    if not moves.any():
        raise InputError("nothing in the network can move", path="network", allowed="a free node")
    size = int(moves.sum())
    values, vectors = eigh(
        dense[1][np.ix_(moves, moves)], dense[0][np.ix_(moves, moves)], subset_by_index=(0, min(count, size) - 1)
    )
    shapes = np.zeros((values.size, 3 * nodes))
    shapes[:, moves] = vectors.T
    ordered = np.stack([shapes[:, 3 * rank + axis] for axis in range(3)], axis=2)
    largest = np.take_along_axis(
        ordered.reshape(values.size, -1), np.abs(ordered.reshape(values.size, -1)).argmax(axis=1)[:, None], axis=1
    )
    return Modes(np.sqrt(np.maximum(values, 0.0)), ordered / largest[:, :, None])
