"""Pictures of a moving curtain for a player: when to draw, and the plan at a position of mid-span."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from moyai.core.arrays import Array


def frame_times(taut: float, peak: float, end: float, counts: tuple[int, int, int]) -> Array:
    """Return the times of pictures [s]: of the slack phase, dense about the spike, and of what follows.

    Parameters
    ----------
    taut, peak, end : float
        When the curtain becomes taut, when the tension is largest, when the series ends [s].
    counts : tuple of int
        Pictures of the three parts.
    """
    spike_end = min(taut + 6.0 * (peak - taut), end)
    return np.concatenate(
        [
            np.linspace(0.0, taut, counts[0], endpoint=False),
            np.linspace(taut, spike_end, counts[1], endpoint=False),
            np.linspace(spike_end, end, counts[2]),
        ]
    )


def plan_frames(
    span: float, position: ArrayLike, taut_sag: float, taut_shape: float, count: int
) -> tuple[Array, Array]:
    """Return the plan at positions of mid-span, x downstream and y along the span (position, point) [m].

    Parameters
    ----------
    span : float
        Distance of the supports [m].
    position : array_like
        Of mid-span, downstream of the line between the supports [m].
    taut_sag, taut_shape : float
        Sag [m] and shape number b of the just-taut cable.
    count : int
        Points.

    Notes
    -----
    A taut cable is the catenary of its sag [eq:curtain-cable-shape]. A slack one has no definite shape; the just-taut
    one is drawn, flatter.
    """
    place = np.atleast_1d(np.asarray(position, dtype=np.float64))
    ratio = np.maximum(np.abs(place), taut_sag) / span
    # sag over span (cosh b - 1)/2b, turned round by interpolation: a picture needs no more
    grid = np.linspace(max(0.5 * taut_shape, 1e-4), max(2.0 * taut_shape, 0.5), 4000)
    while (2.0 * np.sinh(0.5 * grid[-1]) ** 2) / (2.0 * grid[-1]) < ratio.max():
        grid = np.linspace(grid[0], 1.5 * grid[-1], 4000)
    b = np.interp(ratio, np.sinh(0.5 * grid) ** 2 / grid, grid)[:, None]
    centred = np.linspace(-1.0, 1.0, count)[None, :]
    shape = np.sinh(0.5 * b * (1.0 + centred)) * np.sinh(0.5 * b * (1.0 - centred)) / np.sinh(0.5 * b) ** 2
    x = place[:, None] * shape
    y = np.repeat(0.5 * span * (1.0 + centred), place.size, axis=0)
    return x, y
