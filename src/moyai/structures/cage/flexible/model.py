"""The flexible net cage as data: collar, net, weights, grid mooring, mesh and the seas it meets."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal

from moyai.core.errors import InputError
from moyai.core.options import checks_words
from moyai.flexible.bed import Bed
from moyai.morison.net_law_names import Net, NetLaw
from moyai.sea.water import Water
from moyai.structures.cage.flexible.collar import Collar, Pipe
from moyai.structures.cage.flexible.grid_mooring import GridMooring

Shape = Literal["circular", "square"]
Bottom = Literal["none", "flat", "cone"]
WakeName = Literal["none", "loland", "cheng"]


def _positive(value: float, path: str, unit: str) -> None:
    if not (math.isfinite(value) and value > 0.0):
        raise InputError(f"{path} is {value:g} {unit}", parameter=path, allowed=f"greater than 0 {unit}")


def _not_negative(value: float, path: str, unit: str) -> None:
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
    #: Twine that bears, without growth [m]; that of ``net`` when left out.
    clean_diameter: float | None = None
    #: Of the growth between the clean twine and the twine of ``net`` [kg/m3].
    growth_density: float = 0.0
    #: Damping ratio of the net's elastic waves on the mesh [-]: it calms the mesh and hardly touches the motion.
    damping: float = 0.1

    def __post_init__(self) -> None:
        _positive(self.wall_depth, "net.wall_depth", "m")
        _positive(self.density, "net.density", "kg/m3")
        _positive(self.youngs_modulus, "net.youngs_modulus", "Pa")
        for key in ("cone_depth", "added_mass", "growth_density", "damping"):
            _not_negative(getattr(self, key), f"net.{key}", "")
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
        _positive(self.mass, "sinkers.mass", "kg")
        for key in ("volume", "drag_area", "added_mass"):
            _not_negative(getattr(self, key), f"sinkers.{key}", "")


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
        _positive(self.size, "cage.size", "m")
        _not_negative(self.centre_weight, "cage.centre_weight", "kg")
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


@dataclass(frozen=True)
class CageMesh:
    """How fine a cage is resolved."""

    #: Knots around the net; a multiple of 4.
    around: int
    #: Meshes of the wall from the collar down.
    down: int
    #: Rings of meshes from the rim of the bottom to its middle.
    bottom: int
    #: Length of a bar of the ropes, at most [m].
    rope_length: float

    def __post_init__(self) -> None:
        if self.around < 8 or self.around % 4:
            raise InputError(
                f"{self.around} knots around a cage", parameter="mesh.around", allowed="a multiple of 4, 8 or more"
            )
        if self.down < 1 or self.bottom < 1:
            raise InputError(
                f"{self.down} meshes down, {self.bottom} in the bottom", parameter="mesh", allowed="1 or more"
            )
        _positive(self.rope_length, "mesh.rope_length", "m")


@checks_words
@dataclass(frozen=True)
class FixedCollar:
    """A collar that is held: cages in a towing tank or flume."""

    kind: Literal["fixed"] = "fixed"


@dataclass(frozen=True)
class FlexibleCage:
    """One cage, or several in rows and columns, with what holds them."""

    #: The same for all.
    design: CageDesign
    mooring: GridMooring | FixedCollar
    water: Water
    bed: Bed
    mesh: CageMesh
    #: [m2/s].
    kinematic_viscosity: float
    #: ``rows``, ``columns``: Cages along y and along x.
    rows: int = 1
    #: See ``rows``.
    columns: int = 1
    #: Whether cages shelter those downstream of them.
    array_wake: bool = True

    def __post_init__(self) -> None:
        _positive(self.kinematic_viscosity, "kinematic_viscosity", "m2/s")
        if self.rows < 1 or self.columns < 1:
            raise InputError(f"{self.rows} x {self.columns} cages", parameter="mooring.rows", allowed="1 x 1 or more")
        depth = self.design.net.wall_depth + self.design.net.cone_depth
        if depth >= self.water.depth:
            raise InputError(
                f"a net of {depth:g} m in water of {self.water.depth:g} m",
                parameter="net.wall_depth",
                allowed="less than the water depth",
            )
        from moyai.structures.cage.flexible.checks import check_cage

        check_cage(self)

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the cages, row by row."""
        if self.rows * self.columns == 1:
            return ("cage",)
        return tuple(f"cage {r + 1}-{c + 1}" for r in range(self.rows) for c in range(self.columns))

    @property
    def spacing(self) -> float:
        """Between the middles of neighbouring cages [m]."""
        return self.mooring.spacing if isinstance(self.mooring, GridMooring) else 3.0 * self.design.size

    @property
    def centres(self) -> tuple[tuple[float, float], ...]:
        """Middles of the cages (x, y), row by row [m]."""
        return tuple(
            (self.spacing * (c - 0.5 * (self.columns - 1)), self.spacing * (r - 0.5 * (self.rows - 1)))
            for r in range(self.rows)
            for c in range(self.columns)
        )


__all__ = [
    "Bottom", "CageDesign", "CageMesh", "CageNet", "FixedCollar", "FlexibleCage", "GridMooring", "Shape",
    "Sinkers", "WakeName",
]  # fmt: skip
