"""Many meshes as one: bars that keep the shaded area, the stiffness, the mass and the volume of the real twines.

One diameter cannot keep all of them, so a grouped bar has several: one that shades, one of the material, and the real
twine's for the Reynolds number [eq:net-grouping].
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from moyai.core.errors import InputError
from moyai.morison.nets import Net


@dataclass(frozen=True)
class GroupedTwine:
    """One bar that stands for several parallel twines of a net."""

    #: Number of twines, also not whole.
    count: float
    #: Width that shades what the twines shade, half of the crossings counted to each family [m].
    projected_diameter: float
    #: Diameter of the round bar that has their section of material [m].
    material_diameter: float
    #: Of one real twine [m].
    reynolds_diameter: float
    #: [kg/m].
    mass_per_length: float
    #: Displaced [m2].
    volume_per_length: float
    #: EA of the bar [N].
    axial_stiffness: float

    def submerged_weight_per_length(self, density: float, gravity: float) -> float:
        """Return the weight in water of ``density`` [kg/m3] under ``gravity`` [m/s2], per length [N/m]."""
        return (self.mass_per_length - density * self.volume_per_length) * gravity


def group_twines(
    net: Net, spacing: float, *, density: float, modulus: float, mass_per_area: float | None = None
) -> GroupedTwine:
    """Return the bar that stands for all twines of one family over a width of panel [eq:net-grouping].

    A panel cut into columns and rows takes bars of the width that belongs to each: half of it along its edges. Then
    sums over the panel of shaded area, material area (so the stiffness of every cut), mass and volume are those of the
    net whatever the number of columns and rows.

    Parameters
    ----------
    net : Net
    spacing : float
        Width of panel that the bar stands for [m].
    density, modulus : float
        Of the twine [kg/m3], [Pa].
    mass_per_area : float, optional
        Mass of the net per outline area, as its maker weighs it, knots included [kg/m2]; by default that of round
        solid twines. Half of it belongs to each family.

    Raises
    ------
    InputError
        For values that are not positive.
    """
    for name, value in (("spacing", spacing), ("density", density), ("modulus", modulus)):
        if not (math.isfinite(value) and value > 0.0):
            raise InputError(f"{name} is {value:g}", parameter=name, allowed="greater than 0")
    if mass_per_area is not None and not (math.isfinite(mass_per_area) and mass_per_area > 0.0):
        raise InputError(
            f"mass_per_area is {mass_per_area:g} kg/m2", parameter="mass_per_area", allowed="greater than 0"
        )
    count = spacing / net.mesh_pitch
    section = math.pi / 4.0 * net.twine_diameter**2
    material = count * section
    mass = density * material if mass_per_area is None else 0.5 * mass_per_area * spacing
    return GroupedTwine(
        count=count,
        projected_diameter=0.5 * net.twine_area_per_area * spacing,
        material_diameter=math.sqrt(count) * net.twine_diameter,
        reynolds_diameter=net.twine_diameter,
        mass_per_length=mass,
        volume_per_length=material if mass_per_area is None else mass / density,
        axial_stiffness=modulus * material,
    )
