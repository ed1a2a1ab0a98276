"""Forcing with the motion of the water next to it, for quadratic drag against moving water."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from moyai.core.arrays import Array, ComplexArray
from moyai.floating.forcing import Forcing, cosine_ramp
from moyai.floating.sums import real_sum


@dataclass(frozen=True)
class MovingWater:
    """A forcing and what its waves do in the measures of quadratic damping [eq:viscous-water]."""

    #: Forces on the body.
    forcing: Forcing
    #: Of the wave components [rad/s]; shape (n,).
    omega: Array
    #: Complex [m]; shape (n,).
    amplitude: ComplexArray
    #: Motion of the water per unit amplitude in the last w measures of the quadratic damping; shape (n, w).
    water: ComplexArray
    #: Of the waves [s].
    ramp: float

    @property
    def shortest_period(self) -> float:
        """That of the forcing [s]."""
        return self.forcing.shortest_period

    @property
    def longest_step(self) -> float:
        """That of the forcing [s]."""
        return self.forcing.longest_step

    def fitted_step(self, time_step: float) -> float:
        """Return the step that suits the forcing [s]."""
        return self.forcing.fitted_step(time_step)

    def sample(self, step: float, count: int) -> tuple[Array, Array]:
        """Return forces with the motion of the water in further columns (count, m + w), and the elevation."""
        force, elevation = self.forcing.sample(step, count)
        shape = cosine_ramp(step * np.arange(count), self.ramp)
        moved = real_sum(self.omega, self.amplitude[:, None] * self.water, step, count)
        return np.concatenate([force, shape[:, None] * moved], axis=1), elevation
