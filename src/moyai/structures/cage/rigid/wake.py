"""Shelter within a rigid cage: what the net behind the upstream wall misses of the current."""

from __future__ import annotations

import math

import numpy as np

from moyai.core.arrays import Array
from moyai.morison.net_wake import wake_factor
from moyai.sea.current import CurrentProfile
from moyai.sea.water import Water
from moyai.structures.cage.rigid.parts import RigidCage


def shelter(cage: RigidCage, current: CurrentProfile, water: Water, kinematic_viscosity: float) -> Array:
    """Return the current at every patch of net over the undisturbed one [-] [eq:cage-rigid-wake].

    The half of the cage downstream of its middle lies behind the wall that the current met first, patches at the
    middle half so. Without a net on the sides nothing is sheltered.

    Parameters
    ----------
    cage : RigidCage
        Its ``wake`` names the law.
    current : CurrentProfile
        Along x.
    water : Water
    kinematic_viscosity : float
        [m2/s].
    """
    points = cage.patches.points
    walls = np.abs(cage.patches.normals[:, 2]) < 0.5
    if cage.wake == "none" or not walls.any():
        return np.ones(len(points))
    deepest = -water.depth if math.isfinite(water.depth) else -100.0
    # the top of the cage about at the surface; the height only finds the speed that the law of the wake requires
    heights = np.clip(points[:, 2] - 0.5 * cage.extent[2], deepest, 0.0)
    speed = current.in_depth(water.depth).velocity(heights)[:, 0]
    angle = np.zeros(len(points))
    if cage.outline == "cylinder":
        angle = np.arcsin(np.clip(np.abs(points[:, 1]) / (0.5 * cage.extent[0]), 0.0, 1.0))
    factor = wake_factor(cage.wake, cage.law, cage.net, angle, speed=np.abs(speed), viscosity=kinematic_viscosity)
    downstream = points[:, 0] * np.sign(speed)
    near = 1e-9 * cage.extent[0]
    share = np.where(downstream > near, 1.0, np.where(downstream < -near, 0.0, 0.5))
    return np.asarray(1.0 + share * (factor - 1.0))
