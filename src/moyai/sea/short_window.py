"""Sums of many components within a short window of time, by way of few frequencies."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from moyai.core.arrays import Array, IntArray

#: Frequencies that each component is spread over, and how many times finer than the window asks they lie: an error of
#: 1e-7 of the sum of amplitudes.
_WIDTH, _FINER = 8, 2.0
_SHAPE = math.pi * math.sqrt((_WIDTH / _FINER) ** 2 * (_FINER - 0.5) ** 2 - 0.8)


@dataclass(frozen=True, eq=False)
class ShortWindow:
    """Where components go among few frequencies, and what these are at the times of a window [eq:sea-short-window].

    Within a window of length T frequencies closer than 1/T cannot be separated. Components are spread over
    neighbouring frequencies with a Kaiser-Bessel function, and the sum of these is divided by its transform
    (Fessler and Sutton 2003, Beatty et al. 2005).
    """

    #: First of the frequencies over which each component is spread; shape (n,).
    first: IntArray
    #: Their shares; shape (n, width).
    shares: Array
    #: What real and imaginary part of each frequency add at the times; shape (2 m, times).
    waves: Array
    #: Middle of the window [s], to which the phases of the components are brought first.
    middle: float

    @classmethod
    def of(cls, omega: Array, time: Array) -> ShortWindow:
        """Return the window of some times.

        Parameters
        ----------
        omega : ndarray (n,)
            Of the components [rad/s].
        time : ndarray (times,)
            Increasing [s].
        """
        middle, spacing = 0.5 * float(time[0] + time[-1]), frequency_spacing(time)
        place = (omega - float(omega.min())) / spacing
        first = np.ceil(place).astype(np.int64)
        # half the width lies below the lowest frequency
        away = (first - 0.5 * _WIDTH - place)[:, None] + np.arange(_WIDTH)
        shares = np.i0(_SHAPE * np.sqrt(np.maximum(1.0 - (2.0 * away / _WIDTH) ** 2, 0.0)))
        grid = float(omega.min()) + spacing * (np.arange(first.max() + _WIDTH) - 0.5 * _WIDTH)
        since = time - middle
        root = np.sqrt(_SHAPE**2 - (0.5 * _WIDTH * spacing * since) ** 2)
        turns = np.outer(grid, since)
        waves = np.stack([np.cos(turns), np.sin(turns)], axis=1) * (root / (_WIDTH * np.sinh(root)))
        return cls(first, shares, waves.reshape(-1, time.size), middle)

    @property
    def count(self) -> int:
        """How many frequencies there are."""
        return int(self.waves.shape[0]) // 2


def frequency_spacing(time: Array) -> float:
    """Return the distance of the frequencies of a window [rad/s]."""
    return 2.0 * math.pi / (_FINER * float(time[-1] - time[0]))
