"""Modes of a hanging skirt: translation, stretching about the centre of its arc, linear shapes of its edges."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from moyai.core.arrays import Array
from moyai.core.errors import InputError
from moyai.potential.modes import Modes, Rigid
from moyai.potential.thin_plate import Plate


@dataclass(frozen=True)
class Stretch:
    """Motion of the centre of the arc of a skirt whose edges stay where they are.

    Per unit of the centre's motion along x a point at the distance X from the chord moves outwards by X / r.
    """

    chord_x: float
    centre_x: float
    centre_z: float
    radius: float

    def __call__(self, points: Array) -> Array:
        """Return the displacement (n, 2) at points (n, 2)."""
        arm = points - np.array([self.centre_x, self.centre_z])
        share = np.abs(points[:, 0] - self.chord_x) / self.radius
        return np.asarray(arm / self.radius * share[:, None])


@dataclass(frozen=True)
class EdgeShape:
    """Displacement along x that is 1 at the level of one edge and falls linearly to 0 at that of the other."""

    level: float
    other: float

    def __call__(self, points: Array) -> Array:
        """Return the displacement (n, 2) at points (n, 2)."""
        along = (points[:, 1] - self.other) / (self.level - self.other)
        return np.stack([along, np.zeros(len(points))], axis=1)


def edge_modes(plate: Plate) -> Modes:
    """Return ``upper`` and ``lower``: linear shapes along x of a plate between two cables.

    Their added masses are the 2 x 2 split of the plate's; both together are its translation.

    Parameters
    ----------
    plate : Plate
        Start above, end below.

    Raises
    ------
    InputError
        When both ends lie at one level.
    """
    top, bottom = plate.start[1], plate.end[1]
    if not top > bottom:
        raise InputError("the plate does not hang: its start is not above its end", parameter="plate.start")
    return Modes(("upper", "lower"), (EdgeShape(top, bottom), EdgeShape(bottom, top)))


def stretching_modes(plate: Plate) -> Modes:
    """Return ``sway`` and ``stretch`` of a skirt that is an arc over an upright chord.

    ``stretch`` is the motion of the centre of the arc along x with both edges fixed. The entry (stretch, stretch) of
    the added mass is its energy, (stretch, sway) the horizontal force per acceleration of the centre.

    Parameters
    ----------
    plate : Plate
        For instance :func:`moyai.potential.thin_plate.hanging_arc`.

    Raises
    ------
    InputError
        When the plate is flat or its chord is not upright.
    """
    if plate.bulge == 0.0:
        raise InputError("a flat skirt has no centre to move", parameter="plate.bulge", allowed="an arc")
    chord = plate.start[1] - plate.end[1]
    if chord <= 0.0 or abs(plate.start[0] - plate.end[0]) > 1e-9 * chord:
        raise InputError(
            "the chord of the skirt is not upright", parameter="plate", allowed="start straight above the end"
        )
    half_angle = 2.0 * math.atan(abs(plate.bulge))
    radius = 0.5 * chord / math.sin(half_angle)
    side = -math.copysign(1.0, plate.bulge)
    centre_x = plate.start[0] - side * radius * math.cos(half_angle)
    stretch = Stretch(plate.start[0], centre_x, 0.5 * (plate.start[1] + plate.end[1]), radius)
    return Modes(("sway", "stretch"), (Rigid("sway"), stretch))
