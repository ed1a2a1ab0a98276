"""A rigid body put together from rods, volumes and point masses, in its own axes."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from moyai.core.arrays import Array
from moyai.core.errors import InputError
from moyai.coupled.hulls import Lumps, volume_lump
from moyai.coupled.rigid import RigidBody
from moyai.mooring.rotations import roll_pitch_yaw

Triple = tuple[float, float, float]

#: Slices of a rod at least; an inclined rod that crosses the surface is followed slice by slice.
SLICES = 24
#: How far a rod may lean from an axis of its body, where its coefficients are reported axis by axis.
ALIGNED = 1e-6


@dataclass(frozen=True)
class RodPart:
    """A round rod along one of the axes of its body."""

    #: One end [m].
    start: Triple
    #: The other end [m].
    end: Triple
    #: Diameter [m].
    diameter: float
    #: Of a solid cylinder [kg/m].
    mass_per_length: float
    #: Drag coefficient across it, on the diameter [-].
    drag_normal: float
    #: Added-mass coefficient across it, on the volume [-].
    added_mass_normal: float
    #: Drag coefficient of each end along it, on the face [-].
    drag_end: float
    #: Added-mass coefficient of each end along it, on half a sphere of water [-].
    added_mass_end: float
    #: That the water meets one by one; 24 at least are taken.
    slices: int = SLICES

    @property
    def length(self) -> float:
        """Distance of its ends [m]."""
        return math.dist(self.start, self.end)

    @property
    def lean(self) -> float:
        """How far its direction is from the nearest axis [-]; NaN for a rod of no length."""
        along = np.abs(np.subtract(self.end, self.start))
        size = float(np.linalg.norm(along))
        return float(np.linalg.norm(np.delete(along, int(np.argmax(along))))) / size if size > 0.0 else math.nan


@dataclass(frozen=True)
class VolumePart:
    """A mass and a volume at one place, wet wherever it is."""

    #: [m].
    place: Triple
    #: [kg].
    mass: float = 0.0
    #: [m3].
    volume: float = 0.0
    #: Drag coefficient times area along the axes of the body [m2].
    drag_area: Triple = (0.0, 0.0, 0.0)
    #: On the volume along them [-].
    added_mass_coefficient: Triple = (0.0, 0.0, 0.0)


class BodyAssembly:
    """Adds up mass, inertia and lumps of parts.

    Parameters
    ----------
    density : float
        Of the water [kg/m3].
    """

    def __init__(self, density: float) -> None:
        self.density, self.mass = density, 0.0
        self.moment, self.inertia = np.zeros(3), np.zeros((3, 3))
        self.lumps: list[Lumps] = []

    def add_mass(self, mass: float, place: ArrayLike, inertia: ArrayLike = ((0.0,) * 3,) * 3) -> None:
        """Add a mass [kg] with its inertia about its own centre [kg m2]; the sum counts about the origin."""
        x = np.asarray(place, dtype=float)
        self.mass += mass
        self.moment = self.moment + mass * x
        self.inertia = self.inertia + np.asarray(inertia) + mass * (x @ x * np.eye(3) - np.outer(x, x))

    def add(self, part: RodPart | VolumePart, name: str = "body") -> None:
        """Add a part.

        Raises
        ------
        InputError
            For a rod of no length, or one that leans from the axes of its body.
        """
        if isinstance(part, RodPart):
            self._add_rod(part, name)
            return
        self.add_mass(part.mass, part.place)
        if part.volume > 0.0 or any(part.drag_area):
            added = self.density * part.volume * np.array(part.added_mass_coefficient)
            self.lumps.append(volume_lump(part.place, part.volume, drag_area=part.drag_area, added_mass=added))

    def _add_rod(self, rod: RodPart, name: str) -> None:
        if not rod.lean <= ALIGNED:
            what = "has no length" if not rod.length > 0.0 else "leans from the axes of the body"
            raise InputError(
                f"a rod of '{name}' {what}", parameter="rod", allowed="a rod along the x, y or z axis of its body",
                remedy="turn the axes of the body so that one of them lies along the rod",
            )  # fmt: skip
        start, end = np.array(rod.start, dtype=float), np.array(rod.end, dtype=float)
        length, d = rod.length, rod.diameter
        axis = int(np.argmax(np.abs(end - start)))
        across = [k for k in range(3) if k != axis]
        mass = rod.mass_per_length * length
        own = np.eye(3) * mass * (length**2 / 12.0 + d**2 / 16.0)
        own[axis, axis] = mass * d**2 / 8.0
        self.add_mass(mass, 0.5 * (start + end), own)
        count = max(SLICES, rod.slices)
        volume = 0.25 * math.pi * d**2 * length / count
        # extent along z: that of the slice, or the side of the square of the same area for a rod that lies
        height = length / count if axis == 2 else math.sqrt(0.25 * math.pi) * d
        place = start + (np.arange(count)[:, None] + 0.5) / count * (end - start)
        drag, added = np.zeros((count, 3)), np.zeros((count, 3))
        drag[:, across] = rod.drag_normal * d * length / count
        added[:, across] = rod.added_mass_normal * self.density * volume
        # the ends: their faces, and half a sphere of water each
        drag[[0, -1], axis] = rod.drag_end * 0.25 * math.pi * d**2
        added[[0, -1], axis] = rod.added_mass_end * self.density * math.pi / 12.0 * d**3
        self.lumps.append(Lumps(place, np.full(count, volume), np.full(count, height), drag, added, axis))

    def body(
        self, name: str, position: ArrayLike, rotation: Array, points: dict[str, Array], **options: object
    ) -> RigidBody:
        """Return the rigid body; ``rotation`` is its matrix at the start, ``options`` are those of `RigidBody`."""
        centre = self.moment / self.mass if self.mass > 0.0 else np.zeros(3)
        inertia = self.inertia - self.mass * (centre @ centre * np.eye(3) - np.outer(centre, centre))
        lumps = None
        for part in self.lumps:
            lumps = part if lumps is None else lumps + part
        return RigidBody(
            name, self.mass, inertia, centre, np.asarray(position, dtype=float), roll_pitch_yaw(rotation),
            dict(points), lumps, **options,  # type: ignore[arg-type]
        )  # fmt: skip
