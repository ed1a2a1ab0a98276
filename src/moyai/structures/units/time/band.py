"""Frequencies that the memory of the water is fitted to, and their coefficients."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from moyai.core.arrays import Array
from moyai.core.progress import Progress, silent
from moyai.core.store import DatasetStore
from moyai.sea.dispersion import angular_frequency, group_velocity, wave_number
from moyai.sea.water import Water
from moyai.structures.units.bem import LEAST_DEPTH, MeshPanels
from moyai.structures.units.hydrodynamics import RowHydrodynamics, solve_row

#: Ends of the band over the lowest and the highest frequency of the seas
BELOW, ABOVE = 0.35, 1.6
#: Frequencies of half a swing of the coefficients of two units, and most frequencies of the fit
STEPS_OF_A_SWING, MOST_FREQUENCIES = 3.0, 160
#: Shortest wave over the longest side of a panel
LEAST_PANELS = 4.0


def memory_band(omega: Array, panels: MeshPanels, water: Water) -> tuple[float, float]:
    """Return the ends [rad/s] of the band: as far beyond the seas as the Green function and the panels reach."""
    lowest = 0.0
    if math.isfinite(water.depth):
        lowest = float(angular_frequency(1.02 * LEAST_DEPTH / water.depth, water.depth, water.gravity))
    k = 2.0 * math.pi / (LEAST_PANELS * panels.mesh.longest_side)
    highest = float(angular_frequency(k, water.depth, water.gravity))
    low = max(BELOW * float(omega.min()), lowest)
    return min(low, float(omega.min())), max(min(ABOVE * float(omega.max()), highest), float(omega.max()))


def further_frequencies(omega: Array, low: float, high: float, count: int) -> Array:
    """Return frequencies [rad/s] that fill a band evenly next to those that are there."""
    step = (high - low) / max(count - 1, 1)
    even = np.round(np.linspace(low, high, max(count, 2)), 9)
    apart = np.abs(even[:, None] - omega[None, :]).min(axis=1)
    return np.asarray(even[apart > 0.5 * step])


def wide_coefficients(
    hydro: RowHydrodynamics, count: int, *, store: DatasetStore | None = None, progress: Progress = silent
) -> RowHydrodynamics:
    """Return coefficients over the band of the memory: those of the seas and further ones between and beyond.

    Of a file all its frequencies.
    """
    if hydro.panels is None:
        return hydro.band or hydro
    low, high = memory_band(hydro.omega, hydro.panels, hydro.water)
    further = further_frequencies(hydro.omega, low, high, count)
    if not len(further):
        return hydro
    added = solve_row(hydro.panels, hydro.water, hydro.centres, further, hydro.headings, store=store, progress=progress)
    every = sorted((*hydro.solutions, *added.solutions), key=lambda item: item.omega)
    return replace(hydro, solutions=tuple(every))


def dense_coefficients(hydro: RowHydrodynamics) -> tuple[Array, Array, Array]:
    """Return frequencies, added mass and damping as close as waves along the whole row ask for.

    Coefficients of two units swing once while a wave from the one to the other takes up a further period: a fit would
    do as it likes between frequencies that do not resolve this.
    """
    omega, water = hydro.omega, hydro.water
    longest = float(hydro.reach.max())
    speed = float(group_velocity(float(np.sqrt(omega[0] * omega[-1])), water.depth, water.gravity))
    step = math.pi / (STEPS_OF_A_SWING * longest / speed) if longest > 0.0 else math.inf
    count = min(math.ceil((omega[-1] - omega[0]) / step) + 1, MOST_FREQUENCIES)
    if count <= len(omega):
        return omega, hydro.added_mass, hydro.damping
    every = np.sort(np.concatenate([omega, further_frequencies(omega, float(omega[0]), float(omega[-1]), count)]))
    k = np.array([float(wave_number(value, water.depth, water.gravity)) for value in every])
    added, damping, _ = hydro.at(every, k)
    return every, added, damping


def doubtful_gaps(solved: Array, dense: Array, error: Array, least: float, most: int) -> Array:
    """Return the middles [rad/s] of the gaps between solved frequencies in which a fit misses what was interpolated.

    Parameters
    ----------
    solved, dense : ndarray
        Frequencies that were solved and all that were fitted, increasing [rad/s].
    error : ndarray
        Of the fit at the dense ones.
    least : float
        Error below which a gap is no matter.
    most : int
        Number of gaps at most, the worst first.
    """
    gap = np.clip(np.searchsorted(solved, dense, side="right") - 1, 0, len(solved) - 2)
    worst = np.zeros(len(solved) - 1)
    np.maximum.at(worst, gap, error)
    chosen = [number for number in np.argsort(-worst)[:most] if worst[number] > least]
    return np.asarray(np.sort([0.5 * (solved[n] + solved[n + 1]) for n in chosen]))


__all__ = ["dense_coefficients", "doubtful_gaps", "further_frequencies", "memory_band", "wide_coefficients"]
