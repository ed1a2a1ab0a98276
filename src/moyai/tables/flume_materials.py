"""Materials of curtain models: wire, monofilament, film (data/flume_materials.csv holds numbers and sources)."""

from __future__ import annotations

import difflib
import math
from dataclasses import dataclass

from moyai.core.errors import InputError
from moyai.tables.reader import read_table

_FILE = "flume_materials.csv"


@dataclass(frozen=True)
class FlumeMaterial:
    """A material with the range of its properties."""

    #: Catalogue name.
    name: str
    #: What it is.
    material: str
    #: Low and high modulus E [Pa].
    modulus: tuple[float, float]
    #: [kg/m3].
    density: float
    #: Low and high tensile strength [Pa].
    strength: tuple[float, float]
    #: Whether every value was read in the source named; otherwise measure the line given.
    confirmed: bool
    #: Where the values come from.
    source: str

    def line_stiffness(self, diameter: float) -> tuple[float, float]:
        """Return low and high EA [N] of a round line of a diameter [m]."""
        area = math.pi / 4.0 * _positive("diameter", diameter) ** 2
        return self.modulus[0] * area, self.modulus[1] * area

    def line_mass(self, diameter: float) -> float:
        """Return the mass per length [kg/m] of a round line of a diameter [m]."""
        return self.density * math.pi / 4.0 * _positive("diameter", diameter) ** 2

    def sheet_stiffness(self, thickness: float) -> tuple[float, float]:
        """Return low and high stiffness per width [N/m] of a sheet of a thickness [m]."""
        size = _positive("thickness", thickness)
        return self.modulus[0] * size, self.modulus[1] * size

    def sheet_submerged_weight(self, thickness: float, water_density: float, gravity: float) -> float:
        """Return the weight per area in water [N/m2] of a sheet, negative when it floats."""
        return (self.density - water_density) * gravity * _positive("thickness", thickness)


def _positive(name: str, value: float) -> float:
    if not (math.isfinite(value) and value > 0.0):
        raise InputError(f"{name} is {value:g} m", parameter=name, allowed="greater than 0")
    return value


def available_flume_materials() -> tuple[str, ...]:
    """Return the names of the catalogue."""
    return tuple(record["name"] for record in read_table(_FILE))


def flume_material(name: str) -> FlumeMaterial:
    """Return a material by its name.

    Raises
    ------
    InputError
        For an unknown name.
    """
    for record in read_table(_FILE):
        if record["name"] == name:
            return FlumeMaterial(
                name=name,
                material=record["material"],
                modulus=(float(record["modulus_low"]), float(record["modulus_high"])),
                density=float(record["density"]),
                strength=(float(record["strength_low"]), float(record["strength_high"])),
                confirmed=record["confirmed"] == "true",
                source=record["source"],
            )
    near = difflib.get_close_matches(name, available_flume_materials(), 1, 0.3)
    raise InputError(
        f"unknown material {name!r}",
        parameter="material",
        allowed=", ".join(available_flume_materials()),
        remedy=f"did you mean {near[0]!r}?" if near else "",
    )
