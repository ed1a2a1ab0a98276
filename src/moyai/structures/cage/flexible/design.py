"""The design of one flexible cage as data: collar, net, weights."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal

from moyai.core.errors import InputError
from moyai.core.options import checks_words
from moyai.morison.net_law_names import Net, NetLaw
from moyai.morison.net_wake import WakeName
from moyai.structures.cage.flexible.collar import Collar, Pipe

Shape = Literal["circular", "square"]
Bottom = Literal["none", "flat", "cone"]


def positive(value: float, path: str, unit: str) -> None:
    """Raise InputError for a value that is not above nothing."""
    if not (math.isfinite(value) and value > 0.0):
        raise InputError(f"{path} is {value:g} {unit}", parameter=path, allowed=f"greater than 0 {unit}")


def not_negative(value: float, path: str, unit: str) -> None:
    """Raise InputError for a value below nothing."""
    if not (math.isfinite(value) and value >= 0.0):
        raise InputError(f"{path} is {value:g} {unit}", parameter=path, allowed=f"0 or more {unit}")


@checks_words
@dataclass(frozen=True)
class CageNet:
    """The net of a cage."""

    #: Twine and mesh, with their growth where there is any.
    net: Net
    #: Law of the forces of its panels.
    law: NetLaw
    #: Law of the shelter behind it; one of "none", "loland", "cheng".
    wake: WakeName
    #: Height of the wall from the collar down, unstretched [m].
    wall_depth: float
    #: Net that closes it below; one of "none", "flat", "cone".
    bottom: Bottom
    #: Of the twine's material [kg/m3].
    density: float
    #: Of the twine's material [Pa].
    youngs_modulus: float
    #: How far the middle of the bottom lies under its rim [m].
    cone_depth: float = 0.0
    #: C_a of a twine across it [-].
    added_mass: float = 1.0
    #: Twine that carries, without growth [m]; that of ``net`` when left out.
    clean_diameter: float | None = None
    #: Of the growth between the clean twine and the twine of ``net`` [kg/m3].
    growth_density: float = 0.0
    #: Damping ratio of the net's elastic waves on the mesh [-]: it calms the mesh and hardly touches the motion.
    damping: float = 0.1

    def __post_init__(self) -> None:
        positive(self.wall_depth, "net.wall_depth", "m")
        positive(self.density, "net.density", "kg/m3")
        positive(self.youngs_modulus, "net.youngs_modulus", "Pa")
        for key in ("cone_depth", "added_mass", "growth_density", "damping"):
            not_negative(getattr(self, key), f"net.{key}", "")
        if self.bottom == "cone" and self.cone_depth <= 0.0:
            raise InputError("a cone of no depth", parameter="net.cone_depth", allowed="greater than 0 m")
        if self.clean_diameter is not None and not 0.0 < self.clean_diameter <= self.net.twine_diameter:
            raise InputError(
                f"clean twine of {self.clean_diameter:g} m in a net of {self.net.twine_diameter:g} m",
                parameter="net.clean_diameter",
                allowed="above 0, at most the diameter of the net's twine",
            )

    @property
    def bearing_area(self) -> float:
        """Section of one twine without growth [m2]."""
        return math.pi / 4.0 * (self.clean_diameter or self.net.twine_diameter) ** 2

    @property
    def twine_volume(self) -> float:
        """Displaced volume of a twine per length, with growth [m2]."""
        return math.pi / 4.0 * self.net.twine_diameter**2

    @property
    def twine_mass(self) -> float:
        """Mass of a twine per length, with growth [kg/m]."""
        return self.density * self.bearing_area + self.growth_density * (self.twine_volume - self.bearing_area)

    @property
    def mass_per_area(self) -> float:
        """Mass of the net per outline area [kg/m2]."""
        return 2.0 / self.net.mesh_pitch * self.twine_mass


@dataclass(frozen=True)
class Sinkers:
    """Equal weights, evenly around the lower rim of the net."""

    #: How many.
    count: int
    #: In air, each [kg].
    mass: float
    #: Displaced, each [m3].
    volume: float
    #: C_d A of each [m2].
    drag_area: float = 0.0
    #: Of each [kg].
    added_mass: float = 0.0

    def __post_init__(self) -> None:
        if self.count < 1:
            raise InputError(f"{self.count} sinkers", parameter="sinkers.count", allowed="1 or more")
        positive(self.mass, "sinkers.mass", "kg")
        for key in ("volume", "drag_area", "added_mass"):
            not_negative(getattr(self, key), f"sinkers.{key}", "")


@checks_words
@dataclass(frozen=True)
class CageDesign:
    """One cage."""

    #: Outline of the net at the collar; one of "circular", "square".
    shape: Shape
    #: Diameter, or side of a square [m].
    size: float
    collar: Collar
    net: CageNet
    sinkers: Sinkers | None = None
    #: Sinker tube along the lower rim.
    bottom_ring: Pipe | None = None
    #: Mass less displaced water at the middle of the bottom [kg].
    centre_weight: float = 0.0

    def __post_init__(self) -> None:
        positive(self.size, "cage.size", "m")
        not_negative(self.centre_weight, "cage.centre_weight", "kg")
        if self.centre_weight > 0.0 and self.net.bottom == "none":
            raise InputError(
                "a weight at the middle of a bottom that is not there", parameter="cage.centre_weight", allowed="0"
            )

    @property
    def rim(self) -> float:
        """Length of the collar's (inner) ring [m]."""
        return math.pi * self.size if self.shape == "circular" else 4.0 * self.size

    @property
    def volume(self) -> float:
        """Volume inside the net as designed [m3]."""
        base = math.pi / 4.0 * self.size**2 if self.shape == "circular" else self.size**2
        return base * (self.net.wall_depth + (self.net.cone_depth / 3.0 if self.net.bottom == "cone" else 0.0))
