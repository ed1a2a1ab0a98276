"""March a rigid cage through its waves: adaptive steps with events, or a fixed step for comparison."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from moyai.core.arrays import Array
from moyai.core.errors import InputError
from moyai.core.progress import Progress, silent
from moyai.structures.cage.rigid import load_kernel, march_kernel
from moyai.structures.cage.rigid.water_kernel import PackedCage

#: Rows between two calls of the compiled marcher: progress and interruption
_CHUNK = 4000


@dataclass(frozen=True, eq=False)
class March:
    """Motion of a cage over time."""

    #: [s]; shape (rows,).
    time: Array
    #: x, z of the centre of gravity [m], rotation [rad], and their rates; shape (rows, 6).
    state: Array
    #: At the attachment, at the time of the row [N]; shape (rows, lines).
    tension: Array
    #: Largest tension around the row, found within the steps [N]; shape (rows, lines).
    tension_peak: Array
    #: Steps taken.
    steps: int
    #: Steps refused.
    refused: int
    #: Events found.
    events: int
    #: Evaluations of the forces.
    evaluations: int
    #: ``converged``, ``not_converged`` or ``interrupted``.
    status: str


def scales(packed: PackedCage, size: float) -> Array:
    """Return the natural size of every state: that of the cage, and the speed of free fall over it."""
    rate = math.sqrt(float(packed.water[1]) / size)
    return np.array([size, size, 1.0, size * rate, size * rate, rate])


def longest_steps(packed: PackedCage, state: Array, period: float) -> tuple[float, float]:
    """Return the longest step with slack and with taut lines [s] [eq:cage-longest].

    A twentieth of the period; with taut lines no longer than explicit steps allow without feeding an oscillation on
    the lines, one radian of it. Six places within every step are looked at, so that no bounce goes unseen.
    """
    longest = period / 20.0
    if not len(packed.lines):
        return longest, longest
    force, mass, work = np.empty(3), np.empty((3, 3)), np.empty(6)
    load_kernel.loads(packed, 0.0, state, np.full(len(packed.lines), -1.0), force, mass, work)
    elastic = np.zeros((3, 3))
    cosine, sine = math.cos(state[2]), math.sin(state[2])
    for line in packed.lines:
        arm = np.array([cosine * line[0] + sine * line[1], -sine * line[0] + cosine * line[1]])
        away = state[:2] + arm - line[2:4]
        unit = away / float(np.hypot(*away))
        growth = np.array([unit[0], unit[1], unit[0] * arm[1] - unit[1] * arm[0]])
        elastic += line[5] * np.outer(growth, growth)
    factor = np.linalg.inv(np.linalg.cholesky(mass))
    fastest = math.sqrt(float(np.linalg.eigvalsh(factor @ elastic @ factor.T)[-1]))
    return min(longest, 2.0 / fastest), min(longest, 0.9 / fastest)


def march(
    packed: PackedCage,
    start: Array,
    *,
    duration: float,
    spacing: float,
    size: float,
    period: float,
    tolerance: float = 1e-6,
    progress: Progress = silent,
    label: str = "march",
    longest: float | None = None,
) -> March:
    """March adaptively; a Dormand-Prince pair that lands on every change between taut and slack [eq:cage-pair].

    Parameters
    ----------
    packed : Packed
    start : ndarray, shape (6,)
        State at time 0.
    duration, spacing : float
        Length of the record and distance of its rows [s].
    size : float
        Length of the cage [m].
    period : float
        Typical wave period [s].
    tolerance : float
        Local error of a step, relative to the natural size of each state.
    progress : Progress
    label : str
        For the progress.
    longest : float or None
        Longest step [s]; chosen when absent.

    Raises
    ------
    InputError
        For durations that are not positive.
    """
    if not (duration > 0.0 and spacing > 0.0 and math.isfinite(duration)):
        raise InputError(
            f"duration {duration:g} s, spacing {spacing:g} s", parameter="duration", allowed="greater than 0 s"
        )
    count = round(duration / spacing) + 1
    lines = len(packed.lines)
    rows, tension = np.full((count, 6), np.nan), np.full((count, lines), np.nan)
    peak = np.zeros((count, lines))
    counts = np.zeros(4, dtype=np.int64)
    state = np.array(start, dtype=float)
    slack, taut = longest_steps(packed, state, period) if longest is None else (longest, longest)
    step, now, status = 0.1 * taut, 0.0, "converged"
    scale = scales(packed, size)
    rows[0] = state
    try:
        for first in range(0, count, _CHUNK):
            progress(label, first, count)
            end = min(first + _CHUNK, count - 1) * spacing
            if end <= now:
                break
            now, step = march_kernel.march(
                packed, now, end, state, step, slack, taut, tolerance, scale, 0.0, spacing, rows, tension, peak, counts
            )
            if now < end * (1.0 - 1e-12) or not np.isfinite(state).all():
                status = "not_converged"
                break
    except KeyboardInterrupt:
        status = "interrupted"
    progress(label, count, count)
    kept = int(np.isfinite(rows).all(axis=1).argmin()) if not np.isfinite(rows).all() else count
    keep = slice(0, max(kept, 1))
    work = np.empty(6)
    for i in range(lines):
        tension[0, i] = load_kernel.tension_of(packed, i, np.array(start, dtype=float), work)
    steps, refused, events, evaluations = (int(value) for value in counts)
    time: Array = np.asarray(np.arange(count)[keep] * spacing, dtype=np.float64)
    peaks = np.maximum(peak[keep], tension[keep])
    return March(time, rows[keep], tension[keep], peaks, steps, refused, events, evaluations, status)


def march_fixed(
    packed: PackedCage, start: Array, *, duration: float, step: float, every: int = 1, progress: Progress = silent,
    label: str = "march",
) -> March:  # fmt: skip
    """March with the classical Runge-Kutta method of fourth order at a fixed step.

    Parameters
    ----------
    packed : Packed
    start : ndarray, shape (6,)
    duration, step : float
        [s].
    every : int
        Write every how-manieth state.
    progress : Progress
    label : str
        For the progress.
    """
    count = round(duration / step)
    size, lines = count // every + 1, len(packed.lines)
    rows, tension, peak = np.full((size, 6), np.nan), np.zeros((size, lines)), np.zeros((size, lines))
    state = np.array(start, dtype=float)
    rows[0], written, status = state, 1, "converged"
    try:
        for first in range(0, max(count, 1), _CHUNK):
            progress(label, first, count)
            written = march_kernel.march_fixed(
                packed, state, step, first, min(_CHUNK, count - first), every, rows, tension, peak
            )
            if written < 0:
                status = "not_converged"
                break
    except KeyboardInterrupt:
        status = "interrupted"
    keep = slice(0, abs(written))
    time: Array = np.asarray(np.arange(size)[keep] * step * every, dtype=np.float64)
    return March(time, rows[keep], tension[keep], peak[keep], count, 0, 0, 4 * count, status)
