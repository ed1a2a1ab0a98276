"""The largest stable step of the explicit scheme, from the bars that meet at each node."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from moyai.flexible.arrays import KernelArrays

Array = NDArray[np.float64]


def step_limit(arrays: KernelArrays, position: Array, inverse: Array) -> tuple[float, int]:
    """Return a step that central differences bear in any state of the bars, and the node that sets it.

    Twice the stiffness of the bars at a node bounds the whole matrix from above, block by block, so the largest
    eigenvalue of ``2 M^-1 sum k e e^T`` over the nodes bounds the highest frequency; the same with the viscosities
    bounds the damping. Lagged viscosity then asks for ``dt^2 w^2 + 2 dt c <= 4`` [eq:flexible-step-limit].

    Parameters
    ----------
    arrays : KernelArrays
        The network.
    position : ndarray, shape (3, n)
        Present state.
    inverse : ndarray, shape (6, n)
        Inverse mass blocks (xx, xy, xz, yy, yz, zz), zero where held.
    """
    count = position.shape[1]
    unit = position[:, arrays.end] - position[:, arrays.start]
    size = np.linalg.norm(unit, axis=0)
    # a bar of no length may point anywhere
    outer = np.einsum("ik,jk->kij", unit, unit) / np.maximum(size, 1e-300)[:, None, None] ** 2
    outer[size == 0.0] = np.eye(3)
    share = np.zeros((count, 3, 3))
    for row, (i, j) in enumerate(((0, 0), (0, 1), (0, 2), (1, 1), (1, 2), (2, 2))):
        share[:, i, j] = share[:, j, i] = inverse[row]
    largest = []
    for slope in (arrays.greatest_spring, arrays.bar("viscous")):
        block = np.zeros((count, 3, 3))
        for nodes in (arrays.start, arrays.end):
            np.add.at(block, nodes, slope[:, None, None] * outer)
        largest.append(2.0 * np.max(np.abs(np.linalg.eigvals(share @ block)), axis=1))
    fast, damp = largest
    if len(arrays.hinges):
        a, b = arrays.hinges[:, 0], arrays.hinges[:, 1]
        side = np.linalg.norm(position[:, b] - position[:, a], axis=0)
        np.add.at(fast, b, 16.0 * arrays.bending / side**2 * np.max(np.abs(inverse[:, b]), axis=0))
    with np.errstate(divide="ignore", invalid="ignore"):
        limit = np.where(fast > 0.0, (np.sqrt(damp**2 + 4.0 * fast) - damp) / fast, np.inf)
    worst = int(np.argmin(limit))
    return float(limit[worst]), worst
