"""Compiled linear kinematics of all components at the nodes of lines, spread over few frequencies."""

from __future__ import annotations

import math
from typing import Any

from moyai.core.compiled import njit

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
    for i in range(nodes.shape[0]):
        x, y, z, found = nodes[i, 0], nodes[i, 1], level[i], out[i]
        for j in range(amplitude.size):
            k = wave_number[j]
            turn = phase[j] + k * (x * cosine[j] + y * sine[j])
            real, imaginary = amplitude[j] * math.cos(turn), amplitude[j] * math.sin(turn)
            # deep water where the bed is out of reach
            rate, back, whole = omega[j] * math.exp(k * z), 0.0, 1.0
            if k * depth < 20.0:
                back, whole = math.exp(-2.0 * k * (z + depth)), -math.expm1(-2.0 * k * depth)
            along, up = rate * (1.0 + back) / whole, rate * (1.0 - back) / whole
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
