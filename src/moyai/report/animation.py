"""Scenes for the canvas player: motions packed small, frames dense about the maximum and coarse elsewhere."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from moyai.core.arrays import Array
from moyai.report.encoding import QUANTA, encode_array, encode_quantised
from moyai.report.formatting import display_unit

FRAMES_PER_PERIOD_FINE = 40
FRAMES_PER_PERIOD_COARSE = 8


@dataclass(frozen=True)
class MovingBody:
    """A rigid body of the scene."""

    name: str
    #: Closed outlines at rest, x and z in site axes [m]; shape (points, 2).
    outlines: tuple[Array, ...]
    #: Point that ``pose`` moves and turns about [m].
    pivot: tuple[float, float]
    #: Sway and heave [m], roll [rad], relative to rest; shape (frames, 3).
    pose: Array


@dataclass(frozen=True)
class MovingLine:
    """A line of the scene."""

    name: str
    #: x and z from the anchor to the fairlead [m]; shape (frames, points, 2).
    path: Array
    #: Tension at the fairlead [N]; shape (frames,).
    tension: Array
    #: Largest tension of the whole record [N].
    maximum: float
    #: NaN where not known [N].
    breaking_load: float = float("nan")


@dataclass(frozen=True)
class Surface:
    """Water surface: ``x`` [m] and ``elevation`` [m] of shape (frames, x)."""

    x: Array
    elevation: Array


def encode_track(values: Array, tolerance: float, *, everywhere: bool = True) -> dict[str, Any]:
    """Pack many coordinates over many frames as mean + basis x coefficients.

    The principal directions of the motion are kept until the error is within ``tolerance``. Water and mooring lines
    move in few ways, so that hundreds of coordinates become a few.

    Parameters
    ----------
    values : ndarray, shape (frames, coordinates)
        Finite.
    tolerance : float
        Error allowed, in the unit of the values.
    everywhere : bool
        Whether the tolerance holds for every coordinate of every frame, or as root mean square over all.

    Returns
    -------
    dict
        ``mean``, ``basis`` and ``coefficients`` for ``Track`` in ``player.js``.
    """
    mean = values.mean(axis=0)
    centred = values - mean
    # singular vectors through the small Gram matrix: coordinates are few, frames are many
    _, vectors = np.linalg.eigh(centred.T @ centred)
    vectors = vectors[:, ::-1]
    coefficients = centred @ vectors
    rest = centred
    count = 1
    for count in range(1, vectors.shape[1] + 1):
        rest = rest - np.outer(coefficients[:, count - 1], vectors[:, count - 1])
        error = np.abs(rest).max() if everywhere else np.sqrt(np.mean(rest**2))
        if error <= 0.5 * tolerance:
            break
    kept, basis = coefficients[:, :count], vectors[:, :count]
    # half the tolerance is left for the rounding of the coefficients; roundings of several columns add as squares
    steps = np.ptp(kept, axis=0) / QUANTA[8]
    if everywhere:
        rounding = 0.5 * np.sqrt(((steps * np.abs(basis).max(axis=0)) ** 2).sum())
    else:
        # evenly spread within half a step, over columns of unit length
        rounding = np.sqrt((steps**2).sum() / 12.0 / len(mean))
    return {
        "mean": encode_array(mean),
        "basis": [encode_array(column) for column in basis.T],
        "coefficients": encode_quantised(kept, 8 if rounding <= 0.5 * tolerance else 16),
    }


def plain_track(values: Array) -> dict[str, Any]:
    """Pack a few coordinates as they are (the pose of a body)."""
    identity = np.eye(values.shape[1])
    return {
        "mean": encode_array(np.zeros(values.shape[1])),
        "basis": [encode_array(row) for row in identity],
        "coefficients": encode_quantised(values),
    }


def frame_times(
    time: Array,
    window: tuple[float, float],
    period: float,
    moments: Sequence[float] = (),
    budget: int = 12000,
    around: float = math.inf,
) -> Array:
    """Return the times of the frames: dense in the window, coarse elsewhere, with ``moments`` hit exactly.

    Parameters
    ----------
    time : ndarray
        Times of the record [s].
    window : tuple of float
        Start and end of the dense part [s].
    period : float
        Typical wave period [s]; NaN: a fiftieth of the record.
    moments : sequence of float
        Times to hit exactly, such as that of the maximum [s].
    budget : int
        Frames outside the window at most.
    around : float
        Periods before and after the window beyond which there are no frames.

    Returns
    -------
    ndarray
        Increasing times within the record.
    """
    first, last = float(time[0]), float(time[-1])
    if not period > 0.0:
        period = max((last - first) / 50.0, 1e-9)
    first, last = max(first, window[0] - around * period), min(last, window[1] + around * period)
    fine = np.arange(window[0], window[1], period / FRAMES_PER_PERIOD_FINE)
    outside = (last - first) - (window[1] - window[0])
    coarse_step = max(period / FRAMES_PER_PERIOD_COARSE, outside / budget)
    before = np.arange(first, window[0], coarse_step)
    after = np.arange(window[1], last, coarse_step)
    hit = [moment for moment in moments if first <= moment <= last]
    times = np.unique(np.concatenate([before, fine, after, [first, last], hit]))
    # moments may stand so near to a frame that the interpolation between the two would overshoot
    keep = np.concatenate([[True], np.diff(times) > 1e-3 * period]) | np.isin(times, [*hit, last])
    return times[keep]


def side_view(
    times: Array,
    *,
    bodies: Sequence[MovingBody],
    lines: Sequence[MovingLine],
    surface: Surface | None,
    bed: float | None,
    extents: dict[str, tuple[float, float, float, float]],
    window: tuple[float, float],
    maximum: float,
    period: float,
) -> dict[str, Any]:
    """Return the JSON-ready scene of a side view.

    Parameters
    ----------
    times : ndarray
        Times of the frames [s].
    bodies, lines, surface
        What moves.
    bed : float or None
        Elevation of the bed [m], ``None`` for infinite depth.
    extents : dict
        Name of a view: x from, x to, z from, z to [m]; the first is shown at first.
    window : tuple of float
        Start and end of the part that is played at first [s].
    maximum : float
        Time of the governing maximum [s], where the player stands at first.
    period : float
        Typical wave period [s], chooses the speed at first.

    Returns
    -------
    dict
    """
    height = min(bounds[3] - bounds[2] for bounds in extents.values())
    tolerance = height / 800.0  # half a pixel of a tall view
    shown_lines = []
    for line in lines:
        unit = display_unit("N", line.maximum)
        coordinates = np.concatenate([line.path[:, :, 0], line.path[:, :, 1]], axis=1)
        shown_lines.append(
            {
                "name": line.name,
                "path": encode_track(coordinates, tolerance),
                "tension": encode_array(line.tension),
                "maximum": float(line.maximum) if np.isfinite(line.maximum) else None,
                "breaking": float(line.breaking_load) if np.isfinite(line.breaking_load) else None,
                "unit": unit.name,
                "factor": unit.factor,
            }
        )
    slowed = next((speed for speed in (0.1, 0.25, 0.5) if speed >= 0.4 * period), 1.0)
    return {
        "kind": "side-view",
        "times": encode_array(times),
        "bodies": [
            {
                "name": body.name,
                "outlines": [[encode_array(o[:, 0]), encode_array(o[:, 1])] for o in body.outlines],
                "pivot": [float(body.pivot[0]), float(body.pivot[1])],
                "pose": plain_track(body.pose),
            }
            for body in bodies
        ],
        "lines": shown_lines,
        "surface": None
        if surface is None
        else {"x": encode_array(surface.x), "elevation": encode_track(surface.elevation, tolerance, everywhere=False)},
        "bed": bed,
        "extents": {name: [float(bound) for bound in bounds] for name, bounds in extents.items()},
        "window": [float(window[0]), float(window[1])],
        "start": float(maximum),
        "maximum": float(maximum),
        "speed": slowed,
    }


def displaced_line(rest: Array, fairlead_shift: Array, bed: float | None) -> Array:
    """Return line shapes for drawing when the fairlead moves: the hanging part of the rest shape is carried along.

    The grounded part stays, the hanging part moves in proportion to its distance along the line. Exact at both ends
    only; where a result stores the shapes of the moving line, :func:`tabulated_line` draws them.

    Parameters
    ----------
    rest : ndarray, shape (points, 2)
        Shape at rest from the anchor to the fairlead [m].
    fairlead_shift : ndarray, shape (frames, 2)
        Motion of the fairlead [m].
    bed : float or None
        Elevation of the bed [m].

    Returns
    -------
    ndarray, shape (frames, points, 2)
    """
    along = _distance(rest)
    touchdown = 0.0
    if bed is not None:
        height = max(float(np.ptp(rest[:, 1])), 1e-12)
        lying = np.flatnonzero(rest[:, 1] <= bed + 1e-4 * height)
        if lying.size and lying[0] == 0:
            touchdown = float(along[lying[-1]])
    weight = np.clip((along - touchdown) / max(along[-1] - touchdown, 1e-12), 0.0, 1.0)
    values: Array = rest[None, :, :] + weight[None, :, None] * fairlead_shift[:, None, :]
    return values


def _distance(points: Array) -> Array:
    """Return the distance along a polyline, from its first point."""
    return np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))])


def tabulated_line(shift_x: Array, shift_z: Array, shapes: Array, fairlead_shift: Array) -> Array:
    """Return line shapes when the fairlead moves, between shapes stored over a grid of fairlead positions.

    Parameters
    ----------
    shift_x, shift_z : ndarray
        Increasing displacements of the fairlead from rest [m].
    shapes : ndarray, shape (shift_x, shift_z, points, 2)
        x and z from the anchor to the fairlead [m].
    fairlead_shift : ndarray, shape (frames, 2)
        Motion of the fairlead [m]; beyond the grid the nearest shapes are taken and led to the fairlead.

    Returns
    -------
    ndarray, shape (frames, points, 2)
    """

    def place(grid: Array, wanted: Array) -> tuple[NDArray[np.int64], Array]:
        if grid.size == 1:
            return np.zeros(wanted.size, dtype=np.int64), np.zeros(wanted.size)
        inside = np.clip(wanted, grid[0], grid[-1])
        cell = np.clip(np.searchsorted(grid, inside, side="right") - 1, 0, grid.size - 2)
        return cell, (inside - grid[cell]) / (grid[cell + 1] - grid[cell])

    (i, u), (j, v) = place(shift_x, fairlead_shift[:, 0]), place(shift_z, fairlead_shift[:, 1])
    right, up = np.minimum(i + 1, shift_x.size - 1), np.minimum(j + 1, shift_z.size - 1)
    u, v = u[:, None, None], v[:, None, None]
    path = (1 - u) * ((1 - v) * shapes[i, j] + v * shapes[i, up]) + u * (
        (1 - v) * shapes[right, j] + v * shapes[right, up]
    )
    # the end of the drawn line must meet the body also beyond the grid: what is missing there is led in
    origin = shapes[:, :, -1, :] - np.stack(np.meshgrid(shift_x, shift_z, indexing="ij"), axis=-1)
    missing = origin.reshape(-1, 2).mean(axis=0) + fairlead_shift - path[:, -1, :]
    weight = np.linspace(0.0, 1.0, shapes.shape[2])
    values: Array = path + weight[None, :, None] * missing[:, None, :]
    return values


def fairlead_motion(pose: Array, arm: tuple[float, float]) -> Array:
    """Return the motion of a body point, exact for any roll angle.

    Parameters
    ----------
    pose : ndarray, shape (frames, 3)
        Sway, heave [m] and roll [rad].
    arm : tuple of float
        The point relative to the pivot at rest [m].

    Returns
    -------
    ndarray, shape (frames, 2)
    """
    cosine, sine = np.cos(pose[:, 2]), np.sin(pose[:, 2])
    x = pose[:, 0] + arm[0] * (cosine - 1.0) + arm[1] * sine
    z = pose[:, 1] + arm[1] * (cosine - 1.0) - arm[0] * sine
    return np.stack([x, z], axis=1)
