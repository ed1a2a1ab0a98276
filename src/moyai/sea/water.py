"""The water of the site: depth, density, gravity."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

from moyai.core.errors import InputError
from moyai.core.options import check_kind


@dataclass(frozen=True)
class Water:
    """Still water of constant depth.

    Raises
    ------
    InputError
        When one of them is not positive (gravity: negative).

    Examples
    --------
    >>> from moyai.sea import Water
    >>> water = Water(depth=10.0, density=1025.0, gravity=9.81)
    >>> water.with_depth(12.0).depth                                     # at a higher water level [m]
    12.0
    """

    #: Water depth h [m]; ``math.inf`` for infinite depth.
    depth: float
    #: Density rho [kg/m3].
    density: float
    #: Acceleration of gravity g [m/s2]; 0 leaves weight and buoyancy out of a network, and has no waves.
    gravity: float

    def __post_init__(self) -> None:
        for name in ("depth", "density", "gravity"):
            value = getattr(self, name)
            weightless = name == "gravity" and value == 0.0
            if not (value > 0.0 or weightless) or (math.isinf(value) and name != "depth"):
                allowed = "0 or more" if name == "gravity" else "greater than 0"
                raise InputError(f"{name} is {value:g}", parameter=f"water.{name}", allowed=allowed)

    def with_depth(self, depth: float) -> Water:
        """Return the same water at another depth.

        Parameters
        ----------
        depth : float
            Greater than 0, or infinite [m].

        Raises
        ------
        InputError
            For a depth that is not positive.
        """
        return replace(self, depth=depth)


def check_water(water: object) -> None:
    """Refuse what is not :class:`Water`, a depth alone for instance.

    Raises
    ------
    InputError
        With what is to be given.
    """
    check_kind(water, Water, "water", "give Water(depth=..., density=..., gravity=...)")
