"""What interpolation and extrapolation add to a circulation, found on the exact drift in orbits past the section."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from moyai.core.arrays import Array
from moyai.records.streaks.flow import OrbitalFlow, SectionMap, track_particles

#: Instants of a period over which the mean place of a particle is taken, and steps of the path in a period.
_INSTANTS, _STEPS = 40, 160
#: Passes that bring the mean places of the paths to those of the particles, and the circulation to its own bias.
_PLACE_PASSES, _PASSES = 30, 2
#: Part of what is missing by which a start moves, and distance at which the mean place counts as reached, over B.
_SHARE, _NEAR = 0.7, 2e-3
#: Distance beyond which there is no path around a place, over B.
_REACHED = 2e-2


@dataclass(frozen=True, eq=False)
class Orbits:
    """Undisturbed orbits of the water and the section in them."""

    section: SectionMap
    #: Wave period [s].
    period: float
    #: Velocity amplitude along x as in :class:`moyai.records.streaks.flow.OrbitalFlow` [m/s].
    amplitude_x: float
    #: Velocity amplitude along z as in the same, below 0 for waves towards -x [m/s].
    amplitude_z: float

    def drift(self, position: Array, circulation: float) -> tuple[Array, Array]:
        """Return mean positions [m] and drift [m/s] of particles whose mean positions are near the given ones.

        Particles without a path around such a place come back as NaN.
        """
        flow = OrbitalFlow(self.section, self.period, self.amplitude_x, self.amplitude_z, circulation=circulation)
        breadth = self.section.breadth
        times = np.linspace(0.0, self.period, _INSTANTS + 1)
        mean, drift = np.full((2, len(position), 2), np.nan)
        start, nearest = np.array(position), np.full(len(position), np.inf)
        for _ in range(_PLACE_PASSES):
            open_ones = np.flatnonzero((nearest > _NEAR * breadth) & ~self.section.contains(start @ (1.0, 1.0j)))
            if not open_ones.size:
                break
            path = track_particles(flow, start[open_ones], times, steps_per_period=_STEPS)
            middle = 0.5 * (path[:, 1:] + path[:, :-1]).mean(axis=1)
            off = position[open_ones] - middle
            away = np.where(np.isfinite(off).all(axis=1), np.hypot(*off.T), np.inf)
            better = away < nearest[open_ones]
            chosen = open_ones[better]
            nearest[chosen] = away[better]
            mean[chosen], drift[chosen] = middle[better], (path[better, -1] - path[better, 0]) / self.period
            start[open_ones] += _SHARE * np.nan_to_num(off)
        far = nearest > _REACHED * breadth
        mean[far], drift[far] = np.nan, np.nan
        return mean, drift


def orbital_bias(
    orbits: Orbits, position: Array, found: float, estimate: Callable[[NDArray[np.bool_], Array, Array], float]
) -> tuple[float, Array]:
    """Return what an estimate adds to the circulation of particles at these places [eq:streaks-bias], and their drift.

    Parameters
    ----------
    orbits : Orbits
    position : ndarray, shape (particles, 2)
        Mean positions from the centre of the section [m].
    found : float
        The estimate from their measured drift [m2/s].
    estimate : callable
        Receives which particles are left, their mean positions and their exact drift; returns the circulation [m2/s].

    Returns
    -------
    tuple of float and ndarray
        Bias [m2/s], to be taken off ``found``, and the exact drift of the particles [m/s]; NaN without a path.
    """
    bias, drift = 0.0, np.full(position.shape, np.nan)
    for _ in range(_PASSES):
        circulation = found - bias
        mean, drift = orbits.drift(position, circulation)
        known = np.asarray(np.isfinite(mean).all(axis=1))
        bias = estimate(known, mean[known], drift[known]) - circulation
    return bias, drift
