"""Bodies of a network as the case states them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any, Literal

import numpy as np

from moyai.core.options import checks_words
from moyai.coupled.assembly import BodyAssembly, RodPart, VolumePart
from moyai.coupled.hulls import box_hull, cylinder_hull
from moyai.coupled.rigid import RigidBody
from moyai.coupled.wave_loads import WaveLoads
from moyai.mooring.rotations import rotation_matrix
from moyai.sea.water import Water


@checks_words
@dataclass(frozen=True)
class BodyCoefficients:
    """Where the loads of the waves on a body are."""

    program: Literal["capytaine", "wamit", "nemoh"]
    #: File or folder.
    path: Path
    #: Of the upright body that they were computed for [m].
    draught: float
    #: Origin of the axes of the file, x and y from the middle of the body [m].
    origin: tuple[float, float] = (0.0, 0.0)
    #: Whether the damping becomes a memory.
    memory: bool = True
    #: Of the reader.
    options: Mapping[str, Any] = field(default_factory=dict)


Triple = tuple[float, float, float]


@checks_words
@dataclass(frozen=True)
class BodyPlan:
    """A box, an upright cylinder (their axes start at the middle), or an assembly of rods and volumes in its axes."""

    name: str
    shape: Literal["box", "cylinder", "assembly"]
    #: Along its axes; of a cylinder diameter, diameter, height [m].
    size: Triple
    #: Of an assembly without its parts [kg].
    mass: float
    #: About the centre of gravity, roll, pitch, yaw [kg m2].
    inertia: Triple
    #: From the middle [m].
    centre_of_gravity: Triple
    #: Of the middle at the start, z above still water [m].
    position: Triple
    #: Roll, pitch, yaw at the start [rad].
    rotation: Triple
    #: Points that lines meet, from the middle [m].
    points: Mapping[str, Triple]
    #: Drag coefficients along its axes [-].
    drag: Triple
    #: Added-mass coefficients along its axes [-].
    added_mass: Triple
    #: Along and about its axes [N s/m, N m s].
    linear_damping: tuple[float, ...] = (0.0,) * 6
    #: Surge, sway, heave, roll, pitch, yaw.
    free: tuple[bool, ...] = (True,) * 6
    #: Of an assembly.
    parts: tuple[RodPart | VolumePart, ...] = ()
    #: Place in its axes that stays where it is at the start [m].
    pin: Triple | None = None
    #: Drag coefficient times area times arm squared about its axes [m5].
    turning_drag: Triple = (0.0, 0.0, 0.0)
    #: File with the loads of the waves on it in place of ``added_mass``.
    coefficients: BodyCoefficients | None = None
    #: What was read from there.
    loads: WaveLoads | None = None

    def body(self, water: Water) -> RigidBody:
        """Return the body of :mod:`moyai.coupled`.

        Raises
        ------
        InputError
            For an assembly without mass or inertia, and for rods that lean from its axes.
        """
        if self.shape == "assembly":
            return self._assembled(water)
        bottom = -0.5 * self.size[2]
        if self.shape == "box":
            lumps = box_hull(
                self.size, bottom=bottom, drag=self.drag, added_mass=self.added_mass, density=water.density
            )
        else:
            lumps = cylinder_hull(
                self.size[0], self.size[2], bottom=bottom, drag=(self.drag[0], self.drag[2]),
                added_mass=(self.added_mass[0], self.added_mass[2]), density=water.density,
            )  # fmt: skip
        if self.loads is not None:
            # buoyancy and inertia of the water come with the coefficients; drag stays
            lumps = replace(lumps, volume=np.zeros(len(lumps)), added_mass=np.zeros((len(lumps), 3)))
        return RigidBody(
            self.name, self.mass, np.array(self.inertia), np.array(self.centre_of_gravity), np.array(self.position),
            np.array(self.rotation), dict(self.points), lumps, linear_damping=np.array(self.linear_damping),
            loads=self.loads, free=self.free, pin=self.pin,
        )  # fmt: skip

    def _assembled(self, water: Water) -> RigidBody:
        made = BodyAssembly(water.density)
        made.add_mass(self.mass, self.centre_of_gravity, np.diag(self.inertia))
        for part in self.parts:
            made.add(part, self.name)
        turning = 0.5 * water.density * np.array(self.turning_drag)
        return made.body(
            self.name, self.position, rotation_matrix(self.rotation),
            {name: np.array(place) for name, place in self.points.items()},
            linear_damping=np.array(self.linear_damping), quadratic_damping=np.concatenate([np.zeros(3), turning]),
            free=self.free, pin=self.pin,
        )  # fmt: skip
