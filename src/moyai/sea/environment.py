"""Everything around a structure: water and its levels, seas, wind, current."""

from __future__ import annotations

import math
from dataclasses import dataclass

from moyai.sea.current import CurrentProfile
from moyai.sea.states import SeaState
from moyai.sea.water import Water


@dataclass(frozen=True)
class Wind:
    """Steady wind: speed [m/s], heading [rad], air density [kg/m3]."""

    speed: float
    heading: float
    density: float


@dataclass(frozen=True)
class Environment:
    """Everything around the structure."""

    #: Water at datum (level 0): depth [m] or infinite, density, gravity.
    water: Water
    #: Names and elevations above datum [m]; each is run.
    water_levels: tuple[tuple[str, float], ...] = (("SWL", 0.0),)
    #: Those of networks may be of `ComponentSea` too. Waves; may be empty.
    sea_states: tuple[SeaState, ...] = ()
    wind: Wind | None = None
    current: CurrentProfile | None = None

    def water_at(self, level: float) -> Water:
        """Return the water when its surface stands ``level`` [m] above datum."""
        if math.isinf(self.water.depth):
            return self.water
        return self.water.with_depth(self.water.depth + level)

    def mean_current(self, water: Water) -> tuple[float, float]:
        """Return the current along x and y averaged over the depth of ``water``, on which waves ride [m/s].

        In infinite depth the mean over the upper part that waves of the longest period reach cannot be known
        beforehand; the surface value is taken.

        Parameters
        ----------
        water : Water
            Of the water level.
        """
        if self.current is None:
            return 0.0, 0.0
        current = self.current.in_depth(water.depth)
        found = current.velocity(0.0) if math.isinf(water.depth) else current.depth_mean(-water.depth, 0.0)
        return float(found[0]), float(found[1])
