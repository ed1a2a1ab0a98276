"""Natural period and linear plus quadratic damping from a free decay."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from moyai.core.arrays import Array
from moyai.core.errors import InputError
from moyai.core.options import checks_words


@dataclass(frozen=True)
class Decay:
    """What a free decay shows of one mode."""

    #: Mean damped period [s].
    period: float
    #: zeta of vanishing amplitude, linear part.
    damping_ratio: float
    #: b2 over inertia with added mass [1/m or 1/rad]: quadratic part.
    quadratic_over_inertia: float
    #: Absolute extremes about the mean, in the order of time; shape (n,).
    extremes: Array
    #: [s]; shape (n,).
    extreme_times: Array
    #: Damping ratio of every half cycle; shape (n - 1,).
    ratios: Array
    #: Root-mean-square misfit of ``ratios``.
    remainder: float


@checks_words
def fit_decay(
    time: ArrayLike, position: ArrayLike, *, mean: float = 0.0, smallest: float = 0.02, quadratic: bool = True
) -> Decay:
    """Identify period and damping from the extremes of a free decay [eq:floating-decay].

    Parameters
    ----------
    time, position : array_like (n,)
        Evenly spaced record [s], [m or rad].
    mean : float
        Position where the motion ends, in the unit of ``position``.
    smallest : float
        Extremes below this part of the first are left out.
    quadratic : bool
        Fit both parts (True), or the linear part alone.

    Returns
    -------
    Decay
        Period [s], damping ratio [-], quadratic part over the inertia [1/m or 1/rad], and the extremes that they come
        from.

    Raises
    ------
    InputError
        With fewer than three extremes, or fewer than three above the smallest.

    Notes
    -----
    Each half cycle gives zeta_i from its logarithmic decrement; equal work over the cycle makes it linear in the mean
    amplitude, zeta_i = zeta + 4/(3 pi) (b2/M) a_i.

    Examples
    --------
    >>> import numpy as np
    >>> from moyai.floating import fit_decay
    >>> time = np.arange(0.0, 60.0, 0.05)
    >>> heave = 0.5 * np.exp(-0.05 * 1.2 * time) * np.cos(1.2 * time)    # 5 % of critical damping
    >>> decay = fit_decay(time, heave, quadratic=False)
    >>> round(decay.period, 2), round(decay.damping_ratio, 3)            # [s], [-]
    (5.24, 0.05)
    """
    instants, motion = np.asarray(time, dtype=float), np.asarray(position, dtype=float) - mean
    inner = motion[1:-1]
    turning = np.flatnonzero((inner - motion[:-2]) * (motion[2:] - inner) <= 0.0) + 1
    turning = turning[motion[turning] * (2.0 * motion[turning] - motion[turning - 1] - motion[turning + 1]) > 0.0]
    # Noise or steps of the resolution turn the record twice on one side of rest: the largest is the extreme
    sides = np.split(turning, np.flatnonzero(np.diff(np.sign(motion[turning])) != 0.0) + 1)
    turning = np.array([part[np.argmax(np.abs(motion[part]))] for part in sides if part.size], dtype=np.int64)
    if turning.size < 3:
        raise InputError(f"{turning.size} extremes in the record", parameter="position", allowed="3 or more")
    # Parabola through three rows: the extreme lies between them
    before, here, after = motion[turning - 1], motion[turning], motion[turning + 1]
    curvature = before - 2.0 * here + after
    shift = 0.5 * (before - after) / curvature
    step = instants[1] - instants[0]
    extremes = np.abs(here - 0.25 * (before - after) * shift)
    times = instants[turning] + shift * step
    keep = np.flatnonzero(extremes < smallest * extremes[0])
    last = int(keep[0]) if keep.size else extremes.size
    extremes, times = extremes[:last], times[:last]
    if extremes.size < 3:
        raise InputError(f"{extremes.size} extremes above the smallest", parameter="smallest", allowed="3 or more")
    decrement = np.log(extremes[:-1] / extremes[1:])
    ratios = decrement / np.hypot(math.pi, decrement)
    amplitude = 0.5 * (extremes[:-1] + extremes[1:])
    basis = np.column_stack([np.ones_like(amplitude), 4.0 / (3.0 * math.pi) * amplitude])
    if not quadratic:
        basis = basis[:, :1]
    # Large half cycles are measured best
    weight = amplitude[:, None]
    solution = np.linalg.lstsq(basis * weight, ratios * weight[:, 0], rcond=None)[0]
    misfit = ratios - basis @ solution
    return Decay(
        period=2.0 * float(times[-1] - times[0]) / (len(times) - 1),
        damping_ratio=float(solution[0]),
        quadratic_over_inertia=float(solution[1]) if quadratic else 0.0,
        extremes=extremes,
        extreme_times=times,
        ratios=ratios,
        remainder=float(np.sqrt(np.mean(misfit**2))),
    )
