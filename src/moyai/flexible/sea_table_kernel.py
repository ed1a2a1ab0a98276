"""Compiled linear kinematics of all components at the nodes of lines, spread over few frequencies."""

from __future__ import annotations

from typing import Any

import numpy as np

from moyai.core.compiled import njit
from moyai.sea.kinematics import lift_to, turn

COLUMNS = 14
"""Velocity, acceleration and elevation of a frequency: real and imaginary part of each."""


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
    out : ndarray (n, frequencies, COLUMNS)
        Is added to.
    """
    amplitude, phase, omega, wave_number, cosine, sine = sea
    count = amplitude.size
    surface, quarter, lift = np.empty(count), np.empty(count), np.empty(count)
    shares_of_bed, back = -1.0 / np.expm1(-2.0 * wave_number * depth), np.exp(-2.0 * wave_number * depth)
    for i in range(nodes.shape[0]):
        found = out[i]
        turn(nodes[i, 0], nodes[i, 1], wave_number, cosine, sine, phase, amplitude, surface, quarter)
        lift_to(level[i], wave_number, lift)
        for j in range(count):
            real, imaginary, down = surface[j], quarter[j], back[j] / lift[j]
            rate = omega[j] * shares_of_bed[j]
            along, up = rate * (lift[j] + down), rate * (lift[j] - down)
            u, v, w = along * cosine[j] * real, along * sine[j] * real, up * imaginary
            u_turned, v_turned, w_turned = along * cosine[j] * imaginary, along * sine[j] * imaginary, -up * real
            for q in range(shares.shape[1]):
                share, at = shares[j, q], first[j] + q
                found[at, 0] += share * u
                found[at, 1] += share * u_turned
                found[at, 2] += share * v
                found[at, 3] += share * v_turned
                found[at, 4] += share * w
                found[at, 5] += share * w_turned
                # the rate that the water feels: the wave passes it with its intrinsic frequency
                share *= omega[j]
                found[at, 6] += share * u_turned
                found[at, 7] -= share * u
                found[at, 8] += share * v_turned
                found[at, 9] -= share * v
                found[at, 10] += share * w_turned
                found[at, 11] -= share * w
                found[at, 12] += shares[j, q] * real
                found[at, 13] += shares[j, q] * imaginary
