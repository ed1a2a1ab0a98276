"""Added mass of a flat, curved and stretching skirt at infinite frequency, ready for the impact models."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import ArrayLike

from moyai.core.arrays import Array
from moyai.core.errors import InputError
from moyai.potential.thin_plate import Plate, hanging_arc, horizontal_motion, solve_plate_limit
from moyai.sea.water import Water

# Largest sagitta over chord of the table; a half circle has 0.5
LARGEST_SAGITTA = 0.44
_TERMS = 20


@dataclass(frozen=True)
class PlateMass:
    """Added mass of a flat skirt per metre of span and its parts by linear edge shapes [kg/m]."""

    #: M_uu: force on the upper edge per acceleration of the upper edge.
    upper: float
    #: M_ul: force on one edge per acceleration of the other.
    cross: float
    #: M_ll: force on the lower edge per acceleration of the lower edge.
    lower: float

    @property
    def total(self) -> float:
        """M0, the mass of a skirt that moves as a whole [kg/m]."""
        return self.upper + 2.0 * self.cross + self.lower

    @property
    def matrix(self) -> Array:
        """The 2x2 matrix, upper edge first."""
        return np.array([[self.upper, self.cross], [self.cross, self.lower]])


@lru_cache(maxsize=256)
def flat_skirt_mass(draught: float, water: Water) -> PlateMass:
    """Return the impulsive added mass of a flat skirt of a draught [m], both faces wetted [eq:impact-split].

    Raises
    ------
    InputError
        When the skirt is deeper than the water.
    """

    def upper(points: Array, normals: Array) -> Array:
        return np.asarray(normals[:, 0] * (1.0 + points[:, 1] / draught))

    def lower(points: Array, normals: Array) -> Array:
        return np.asarray(-normals[:, 0] * points[:, 1] / draught)

    if not (math.isfinite(draught) and draught > 0.0):
        raise InputError(f"draught is {draught:g} m", parameter="draught", allowed="greater than 0")
    found = solve_plate_limit(Plate((0.0, 0.0), (0.0, -draught)), water, (upper, lower)).added_mass
    return PlateMass(float(found[0, 0]), 0.5 * float(found[0, 1] + found[1, 0]), float(found[1, 1]))


@dataclass(frozen=True, eq=False)
class ArcMass:
    """Added mass of a skirt curved to a circular arc between held edges, as a function of its sagitta f.

    The skirt moves as a whole (x) or stretches (f: its middle moves at unit speed, the edges stay) [eq:impact-stretch].
    """

    #: Straight distance d0 of the edges [m].
    chord: float
    #: Chebyshev coefficients of M_xx, M_xf, M_ff [kg/m] over 0 <= f <= 0.44 d0; shape (3, n).
    coefficients: Array

    def at(self, sagitta: ArrayLike) -> Array:
        """Return M_xx, M_xf, M_ff (3, ...) [kg/m] at sagittas [m].

        Raises
        ------
        InputError
            Beyond 0.44 chords.
        """
        f = np.asarray(sagitta, dtype=float) / self.chord
        if np.any(f < 0.0) or np.any(f > LARGEST_SAGITTA) or not np.all(np.isfinite(f)):
            raise InputError(
                f"sagitta over chord is {np.max(f):.3g}", parameter="sagitta", allowed=f"0 to {LARGEST_SAGITTA}"
            )
        return np.asarray(np.polynomial.chebyshev.chebval(2.0 * f / LARGEST_SAGITTA - 1.0, self.coefficients.T))

    def slope(self, sagitta: float) -> Array:
        """Return the derivatives of :meth:`at` with respect to f [kg/m2]."""
        derivative = np.polynomial.chebyshev.chebder(self.coefficients.T)
        scale = 2.0 / (LARGEST_SAGITTA * self.chord)
        x = 2.0 * sagitta / (LARGEST_SAGITTA * self.chord) - 1.0
        return np.asarray(scale * np.polynomial.chebyshev.chebval(x, derivative))


@lru_cache(maxsize=64)
def arc_skirt_mass(chord: float, water: Water) -> ArcMass:
    """Return the added masses of a skirt between edges ``chord`` [m] apart, the upper one at the still water.

    Raises
    ------
    InputError
        When the chord is not positive or deeper than the water.
    """
    if not (math.isfinite(chord) and chord > 0.0):
        raise InputError(f"chord is {chord:g} m", parameter="chord", allowed="greater than 0")
    if chord >= water.depth:
        raise InputError(
            f"the skirt's chord is {chord:g} m in water {water.depth:g} m deep",
            parameter="chord",
            allowed=f"less than {water.depth:g} m",
            remedy="the impact models take a skirt that is clear of the bed",
        )
    scaled = Water(water.depth / chord, 1.0, water.gravity)
    x = np.cos(math.pi * (np.arange(_TERMS) + 0.5) / _TERMS)
    values = np.empty((3, _TERMS))
    for number, sagitta in enumerate(0.5 * LARGEST_SAGITTA * (x + 1.0)):
        # f = r - s and r^2 = s^2 + 1/4
        arc = hanging_arc(1.0, 0.125 / sagitta - 0.5 * sagitta)

        def stretch(points: Array, _normals: Array, size: float = float(sagitta)) -> Array:
            return np.asarray(points[:, 0] / size)

        mass = solve_plate_limit(arc, scaled, (horizontal_motion, stretch)).added_mass
        values[:, number] = mass[0, 0], 0.5 * (mass[0, 1] + mass[1, 0]), mass[1, 1]
    series = np.polynomial.chebyshev.chebfit(x, values.T, _TERMS - 1).T
    return ArcMass(chord, np.asarray(water.density * chord**2 * series, dtype=np.float64))
