"""Compiled linear kinematics of all components at the nodes of lines, spread over few frequencies."""

from __future__ import annotations

from typing import Any

import numpy as np

from moyai.core.compiled import njit
from moyai.sea.kinematics import lift_to, turn
from moyai.sea.vector_kernel import REORDER

COLUMNS = 14
"""Velocity, acceleration and elevation of a frequency at a node: real and imaginary part of each."""
#: Components whose kinematics at all nodes are held at a time: they stay in the cache of the processor.
BLOCK = 64


@njit(cache=True, error_model="numpy")
def spread_kinematics(nodes: Any, level: Any, sea: Any, depth: float, first: Any, shares: Any, out: Any) -> None:
    """Add velocity, acceleration and elevation of all components to their frequencies [eq:sea-linear-kinematics].

    Parameters
    ----------
    nodes : ndarray (n, 3)
        [m].
    level : ndarray (n,)
        At which the orbits have decayed, still water at most [m].
    sea : tuple of ndarray (k,)
        Amplitude and phase [m, rad], intrinsic frequency [rad/s], wave number [1/m], cosine and sine of the heading.
    depth : float
        [m].
    first, shares : ndarray (k,), (k, width)
        From :class:`moyai.sea.short_window.ShortWindow`.
    out : ndarray (frequencies, n COLUMNS)
        Is added to.
    """
    amplitude, phase, omega, wave_number, cosine, sine = sea
    surface, quarter, lift = np.empty(BLOCK), np.empty(BLOCK), np.empty(BLOCK)
    values = np.empty((BLOCK, nodes.shape[0] * COLUMNS))
    bed, back = -1.0 / np.expm1(-2.0 * wave_number * depth), np.exp(-2.0 * wave_number * depth)
    for begin in range(0, amplitude.size, BLOCK):
        end = min(begin + BLOCK, amplitude.size)
        own, count = slice(begin, end), end - begin
        for i in range(nodes.shape[0]):
            turn(
                nodes[i, 0], nodes[i, 1], wave_number[own], cosine[own], sine[own], phase[own], amplitude[own],
                surface[:count], quarter[:count],
            )  # fmt: skip
            lift_to(level[i], wave_number[own], lift[:count])
            for j in range(count):
                k = begin + j
                real, imaginary, down, rate = surface[j], quarter[j], back[k] / lift[j], omega[k] * bed[k]
                along, w = rate * (lift[j] + down), rate * (lift[j] - down)
                u, v = along * cosine[k], along * sine[k]
                value = values[j, COLUMNS * i : COLUMNS * (i + 1)]
                value[0], value[1], value[2], value[3] = u * real, u * imaginary, v * real, v * imaginary
                value[4], value[5] = w * imaginary, -w * real
                # the rate that the water feels: the wave passes it with its intrinsic frequency
                for axis in range(3):
                    value[6 + 2 * axis] = omega[k] * value[1 + 2 * axis]
                    value[7 + 2 * axis] = -omega[k] * value[2 * axis]
                value[12], value[13] = real, imaginary
        _spread(first[own], shares[own], values, out)


@njit(cache=True, error_model="numpy", fastmath=REORDER)
def _spread(first: Any, shares: Any, values: Any, out: Any) -> None:
    """Add the rows of components to those of their frequencies, four at a time where neighbours share these."""
    j = 0
    while j < first.size:
        at, together = first[j], 1
        while together < 4 and j + together < first.size and first[j + together] == at:
            together += 1
        for q in range(shares.shape[1]):
            row = out[at + q]
            if together == 4:
                a, b, c, d = shares[j, q], shares[j + 1, q], shares[j + 2, q], shares[j + 3, q]
                for i in range(row.size):
                    row[i] += a * values[j, i] + b * values[j + 1, i] + c * values[j + 2, i] + d * values[j + 3, i]
            else:
                for k in range(j, j + together):
                    for i in range(row.size):
                        row[i] += shares[k, q] * values[k, i]
        j += together
