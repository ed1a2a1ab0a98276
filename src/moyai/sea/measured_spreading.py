"""Directional spreading as a file of two-dimensional spectra holds it."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from moyai.core.arrays import Array, IntArray
from moyai.core.errors import InputError
from moyai.sea.direction_widths import direction_widths
from moyai.sea.directional import Spreading, wrapped


@dataclass(frozen=True, eq=False)
class MeasuredSpreading(Spreading):
    """Energy of a table of directions, even over the width of each; between frequencies in proportion.

    Frequencies without energy are spread as the whole sea is.
    """

    #: Rising [rad/s]; shape (f,).
    omega: Array
    #: Offsets from the mean heading between which the energy is even, from -pi to pi [rad]; shape (e,).
    edges: Array
    #: Fraction of the energy of a frequency up to each edge [-]; shape (f, e).
    below: Array

    @classmethod
    def of(cls, frequency: Array, directions: Array, energy: Array, mean: float) -> MeasuredSpreading:
        """Return the spreading of one spectrum.

        Parameters
        ----------
        frequency : ndarray (f,)
            Rising [Hz].
        directions : ndarray (d,)
            Where the waves come from, clockwise from north [degrees].
        energy : ndarray (f, d)
            Of every direction, its width included, in any unit.
        mean : float
            Mean direction of the sea, from which offsets count [degrees]; headings turn the other way round than
            bearings.

        Raises
        ------
        InputError
            For a spectrum without energy, or with numbers that are not finite or negative.
        """
        if not (np.isfinite(energy).all() and np.all(energy >= 0.0) and energy.any() and math.isfinite(mean)):
            raise InputError("the spectrum holds no energy by directions", parameter="record")
        half = 0.5 * np.radians(direction_widths(directions))
        middle = wrapped(-np.radians(directions - mean))
        # a direction next to the back of the mean heading has a part on either side of it
        first, last = [], []
        for turn in (-2.0 * math.pi, 0.0, 2.0 * math.pi):
            first.append(np.clip(middle - half + turn, -math.pi, math.pi))
            last.append(np.clip(middle + half + turn, -math.pi, math.pi))
        start, end = np.array(first), np.array(last)
        edges = np.unique(np.concatenate([[-math.pi, math.pi], start.ravel(), end.ravel()]))
        # of each direction the part below each edge (e, d)
        inside = (np.clip(edges[:, None, None], start, end) - start).sum(axis=1) / (2.0 * half)
        total = energy.sum(axis=1, keepdims=True)
        rows = np.where(total > 0.0, energy, energy.sum(axis=0))
        share = rows / rows.sum(axis=1, keepdims=True)
        below = share @ inside.T
        return cls(2.0 * math.pi * frequency, edges, below / below[:, -1:])

    def _rows(self, omega: ArrayLike) -> Array:
        """Return the distribution at frequencies (..., e)."""
        at = np.clip(np.asarray(omega, dtype=float), self.omega[0], self.omega[-1])
        above = np.clip(np.searchsorted(self.omega, at), 1, len(self.omega) - 1)
        part = ((at - self.omega[above - 1]) / (self.omega[above] - self.omega[above - 1]))[..., None]
        return np.asarray((1.0 - part) * self.below[above - 1] + part * self.below[above])

    def _cell(self, offset: ArrayLike, omega: ArrayLike) -> tuple[Array, IntArray, Array, Array]:
        """Return offsets, the edge before each, and the distribution at that edge and the next."""
        angle, at = np.broadcast_arrays(wrapped(offset), np.asarray(omega, dtype=float))
        cell = np.clip(np.searchsorted(self.edges, angle, side="right") - 1, 0, len(self.edges) - 2)
        rows = self._rows(at)
        low, high = (np.take_along_axis(rows, (cell + k)[..., None], axis=-1)[..., 0] for k in (0, 1))
        return angle, np.asarray(cell, dtype=np.int64), low, high

    def density(self, offset: ArrayLike, omega: ArrayLike) -> Array:
        """Return G [1/rad]."""
        _, cell, low, high = self._cell(offset, omega)
        return np.asarray((high - low) / np.diff(self.edges)[cell])

    def cumulative(self, offset: ArrayLike, omega: ArrayLike) -> Array:
        """Return the fraction of the energy up to ``offset`` [rad]."""
        angle, cell, low, high = self._cell(offset, omega)
        part = (angle - self.edges[cell]) / np.diff(self.edges)[cell]
        return np.asarray(low + part * (high - low))

    def quantile(self, fraction: ArrayLike, omega: ArrayLike) -> Array:
        """Return the offset [rad] below which ``fraction`` of the energy lies."""
        wanted, at = np.broadcast_arrays(np.asarray(fraction, dtype=float), np.asarray(omega, dtype=float))
        rows = self._rows(at)
        cell = np.clip((rows < wanted[..., None]).sum(axis=-1) - 1, 0, len(self.edges) - 2)
        low, high = (np.take_along_axis(rows, (cell + k)[..., None], axis=-1)[..., 0] for k in (0, 1))
        part = np.clip((wanted - low) / np.maximum(high - low, 1e-300), 0.0, 1.0)
        return np.asarray(self.edges[cell] + part * np.diff(self.edges)[cell])

    def resultant(self, omega: ArrayLike) -> Array:
        """Return the energy mean of cos(offset) [-]."""
        slope = np.diff(self._rows(omega), axis=-1) / np.diff(self.edges)
        return np.asarray(slope @ np.diff(np.sin(self.edges)))
