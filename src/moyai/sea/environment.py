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
