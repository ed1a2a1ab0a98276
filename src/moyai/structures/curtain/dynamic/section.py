"""Dense added mass of a skirt's section over the nodes of a mesh: the link between thin plates and moving sheets."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from moyai.core.arrays import Array
from moyai.core.errors import InputError
from moyai.potential.thin_plate import Plate, hanging_arc, solve_plate_limit
from moyai.sea.water import Water
from moyai.structures.curtain.statics.closed_forms import arc_half_angle


@dataclass(frozen=True, eq=False)
class SectionMesh:
    """Nodes of a skirt's section and what they feel of each other through the water."""

    #: Downstream, from the upper edge down [m]; shape (k,).
    x: Array
    #: Up, from the upper edge down [m]; shape (k,).
    z: Array
    #: Per metre of span: normal (downstream) unknowns first, then vertical ones [kg/m]; shape (2 k, 2 k).
    added_mass: Array

    @property
    def rigid_mass(self) -> float:
        """Added mass of the section that moves as a whole downstream [kg/m]."""
        count = self.x.size
        return float(np.sum(self.added_mass[:count, :count]))


@lru_cache(maxsize=32)
def section_mesh(length: float, chord: float, cells: int, depth: float, density: float) -> SectionMesh:
    """Return the mesh of a skirt between its edges, with hat functions along and the plate's added mass between them.

    The water is without waves: infinite frequency, zero potential at the surface [eq:curtain-section-mass].

    Parameters
    ----------
    length : float
        Of the skirt along itself [m].
    chord : float
        Straight distance of its edges [m]; ``length`` for a flat skirt.
    cells : int
        Between the edges, equally long.
    depth, density : float
        Of the water [m], [kg/m3].

    Raises
    ------
    InputError
        For a chord beyond the length, no cells, or a skirt that reaches the bed.
    """
    if cells < 1:
        raise InputError(f"a skirt of {cells} cells", parameter="cells", allowed="1 or more")
    if not 0.0 < chord <= length:
        raise InputError(f"chord is {chord:g} m", parameter="chord", allowed=f"above 0, at most {length:g} m")
    if not length < depth:
        raise InputError(
            f"a skirt of {length:g} m in water {depth:g} m deep",
            parameter="skirt.length",
            allowed=f"less than {depth:g} m",
            remedy="sections of added mass end above the bed",
        )
    steps = np.linspace(0.0, 1.0, cells + 1)
    if chord < length * (1.0 - 1e-9):
        half_angle = float(arc_half_angle(chord / length))
        centre = 0.5 * chord / math.tan(half_angle)
        plate = hanging_arc(chord, centre)
    else:
        half_angle, centre = 0.0, math.inf
        plate = Plate((0.0, 0.0), (0.0, -length))

    def fraction(points: Array) -> Array:
        if half_angle == 0.0:
            return np.asarray(-points[:, 1] / length)
        angle = np.arctan2(points[:, 1] + 0.5 * chord, points[:, 0] + centre)
        return np.asarray(0.5 * (1.0 - angle / half_angle))

    def mode(node: int, axis: int):  # type: ignore[no-untyped-def]
        hat = np.eye(cells + 1)[node]
        return lambda points, normals: np.interp(fraction(points), steps, hat) * normals[:, axis]

    modes = [mode(node, axis) for axis in (0, 1) for node in range(cells + 1)]
    given = solve_plate_limit(plate, Water(depth, density, 9.81), modes).added_mass
    values, vectors = np.linalg.eigh(0.5 * (given + given.T))
    mass = (vectors * np.maximum(values, 0.0)) @ vectors.T
    places = plate.position(steps)
    for array in (mass,):
        array.setflags(write=False)
    return SectionMesh(np.asarray(places.real), np.asarray(places.imag), mass)
