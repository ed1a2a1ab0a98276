"""The water of the site: depth, density, gravity."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

from moyai.core.errors import InputError


@dataclass(frozen=True)
class Water:
    """Still water of constant depth.

    Parameters
    ----------
    depth : float
        Water depth h [m]; ``math.inf`` for infinite depth.
    density : float
        Density rho [kg/m3].
    gravity : float
        Acceleration of gravity g [m/s2].

    Raises
    ------
    InputError
        When one of them is not positive.
    """

    depth: float
    density: float
    gravity: float

    def __post_init__(self) -> None:
        for name in ("depth", "density", "gravity"):
            value = getattr(self, name)
            if math.isnan(value) or value <= 0.0 or (math.isinf(value) and name != "depth"):
                raise InputError(f"{name} is {value:g}", path=f"water.{name}", allowed="greater than 0")

    def with_depth(self, depth: float) -> Water:
        """Return the same water at another depth."""
        return replace(self, depth=depth)
