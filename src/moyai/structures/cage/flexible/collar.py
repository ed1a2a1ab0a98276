"""Pipes of a net cage: the floating collar and the sinker tube, their stiffness and their stress."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from moyai.core.arrays import Array
from moyai.core.errors import InputError
from moyai.core.options import checks_words


@checks_words
@dataclass(frozen=True)
class Pipe:
    """A round pipe.

    Raises
    ------
    InputError
        For measures that are no pipe.
    """

    #: Outer diameter [m].
    diameter: float
    #: Thickness of the wall [m].
    wall_thickness: float
    #: Of the wall [kg/m3].
    density: float
    #: [Pa].
    youngs_modulus: float
    #: [-].
    poisson_ratio: float
    #: Drag coefficient across, on the outer diameter [-].
    drag_normal: float
    #: Drag coefficient along, on the outer diameter [-].
    drag_tangential: float
    #: Added-mass coefficient, on the displaced volume [-].
    added_mass: float
    #: What the pipe carries or holds: brackets, walkway, ballast, water inside [kg/m].
    extra_mass_per_length: float = 0.0
    #: Whether water fills it: only the wall displaces water then, and the water inside moves with it.
    flooded: bool = False

    def __post_init__(self) -> None:
        for key in ("diameter", "wall_thickness", "density", "youngs_modulus"):
            value = getattr(self, key)
            if not (math.isfinite(value) and value > 0.0):
                raise InputError(f"{key} of a pipe is {value:g}", parameter=key, allowed="greater than 0")
        if self.wall_thickness > 0.5 * self.diameter:
            raise InputError(
                f"a wall of {self.wall_thickness:g} m does not fit a pipe of {self.diameter:g} m",
                parameter="wall_thickness",
                allowed=f"at most {0.5 * self.diameter:g} m",
            )
        if not -1.0 < self.poisson_ratio <= 0.5:
            raise InputError(f"poisson_ratio is {self.poisson_ratio:g}", parameter="poisson_ratio", allowed="0 to 0.5")
        for key in ("drag_normal", "drag_tangential", "added_mass", "extra_mass_per_length"):
            value = getattr(self, key)
            if not (math.isfinite(value) and value >= 0.0):
                raise InputError(f"{key} of a pipe is {value:g}", parameter=key, allowed="0 or more")

    @property
    def wall_area(self) -> float:
        """Area of the wall [m2]."""
        return math.pi * self.wall_thickness * (self.diameter - self.wall_thickness)

    @property
    def second_moment(self) -> float:
        """Second moment of area I [m4]."""
        return math.pi / 64.0 * (self.diameter**4 - (self.diameter - 2.0 * self.wall_thickness) ** 4)

    @property
    def axial_stiffness(self) -> float:
        """EA [N]."""
        return self.youngs_modulus * self.wall_area

    @property
    def bending_stiffness(self) -> float:
        """EI [N m2]."""
        return self.youngs_modulus * self.second_moment

    @property
    def torsional_stiffness(self) -> float:
        """GJ of the closed round section, EI / (1 + Poisson's ratio) [N m2]."""
        return self.bending_stiffness / (1.0 + self.poisson_ratio)

    def mass_per_length(self, water_density: float) -> float:
        """Mass that moves with the pipe [kg/m]."""
        inside = math.pi / 4.0 * (self.diameter - 2.0 * self.wall_thickness) ** 2 if self.flooded else 0.0
        return self.density * self.wall_area + self.extra_mass_per_length + water_density * inside

    @property
    def volume_per_length(self) -> float:
        """Volume of the pipe's outer cylinder [m2] (the water in a flooded one counts as its own mass)."""
        return math.pi / 4.0 * self.diameter**2

    def stress(self, axial_force: Array, moment_in_plane: Array, moment_out_of_plane: Array, torsion: Array) -> Array:
        """Return the largest von Mises stress of the section [Pa] [eq:cage-collar-stress].

        Parameters
        ----------
        axial_force : array_like
            Tension positive [N].
        moment_in_plane, moment_out_of_plane, torsion : array_like
            [N m].
        """
        bending = np.hypot(moment_in_plane, moment_out_of_plane) * 0.5 * self.diameter / self.second_moment
        direct = np.abs(np.asarray(axial_force)) / self.wall_area + bending
        shear = np.abs(np.asarray(torsion)) * 0.5 * self.diameter / (2.0 * self.second_moment)
        return np.asarray(np.sqrt(direct**2 + 3.0 * shear**2))


@checks_words
@dataclass(frozen=True)
class Collar:
    """The floating collar: one pipe, or two concentric ones held apart by brackets."""

    #: Of each ring.
    pipe: Pipe
    #: Number of rings; the net hangs from the inner one, bridles hold the outer one; one of 1, 2.
    rings: int = 1
    #: Between the axes of two rings [m].
    spacing: float = 0.0
    #: A collar that hardly deforms: bending and torsion :data:`RIGID_FACTOR` times as stiff. Its stress is left out.
    rigid: bool = False

    def __post_init__(self) -> None:
        if self.rings not in (1, 2):
            raise InputError(f"a collar of {self.rings} rings", parameter="collar.rings", allowed="1 or 2")
        if self.rings == 2 and not self.spacing > self.pipe.diameter:
            raise InputError(
                f"two rings {self.spacing:g} m apart",
                parameter="collar.spacing",
                allowed=f"above {self.pipe.diameter:g} m",
            )

    @property
    def bending_stiffness(self) -> float:
        """EI of a ring as it is computed [N m2]."""
        return self.pipe.bending_stiffness * (RIGID_FACTOR if self.rigid else 1.0)

    @property
    def torsional_stiffness(self) -> float:
        """GJ of a ring as it is computed [N m2]."""
        return self.pipe.torsional_stiffness * (RIGID_FACTOR if self.rigid else 1.0)


#: How much stiffer a rigid collar is than its pipe.
RIGID_FACTOR = 300.0
