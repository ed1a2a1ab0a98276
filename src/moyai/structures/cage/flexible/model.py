"""The flexible net cage as data: its design, grid mooring, water, bed and mesh."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from moyai.core.errors import InputError
from moyai.core.options import checks_words
from moyai.flexible.bed import Bed
from moyai.sea.water import Water
from moyai.structures.cage.flexible.afloat import check_moored
from moyai.structures.cage.flexible.design import CageDesign, positive
from moyai.structures.cage.flexible.grid_mooring import GridMooring


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
        positive(self.rope_length, "mesh.rope_length", "m")


@checks_words
@dataclass(frozen=True)
class FixedCollar:
    """A collar that is held: cages in a towing tank or flume."""

    kind: Literal["fixed"] = "fixed"


@checks_words
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
    #: Cages along y.
    rows: int = 1
    #: Cages along x.
    columns: int = 1
    #: Whether cages shelter those downstream of them.
    array_wake: bool = True

    def __post_init__(self) -> None:
        positive(self.kinematic_viscosity, "kinematic_viscosity", "m2/s")
        if self.rows < 1 or self.columns < 1:
            raise InputError(f"{self.rows} x {self.columns} cages", parameter="mooring.rows", allowed="1 x 1 or more")
        depth = self.design.net.wall_depth + self.design.net.cone_depth
        if depth >= self.water.depth:
            raise InputError(
                f"a net of {depth:g} m in water of {self.water.depth:g} m",
                parameter="net.wall_depth",
                allowed="less than the water depth",
            )
        if isinstance(self.mooring, GridMooring):
            check_moored(self.design, self.mooring, self.water, self.bed)
        elif self.rows * self.columns > 1:
            raise InputError("several cages with held collars", parameter="mooring.rows", allowed="1 x 1")

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
