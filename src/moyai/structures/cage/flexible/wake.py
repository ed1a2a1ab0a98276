"""Shelter in and behind cages: what each panel of net misses of the current."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike, NDArray

from moyai.core.arrays import Array
from moyai.flexible.flow import Current
from moyai.flexible.network import Network
from moyai.morison.net_wake import wake_factor
from moyai.structures.cage.flexible.model import FlexibleCage
from moyai.structures.cage.flexible.parts import CageNetwork


def _walls_passed(model: FlexibleCage, lateral: Array, heading: float, speed: Array) -> Array:
    """Return the factor of one passed wall for water that meets a cage ``lateral`` metres off its middle."""
    design = model.design
    net = design.net
    if design.shape == "circular":
        sine = np.clip(lateral / (0.5 * design.size), -1.0, 1.0)
        angle = np.arcsin(np.abs(sine))
    else:
        # the wall that is met there: the square's faces stand along x and y
        half = 0.5 * design.size
        turned = (heading + math.pi / 4.0) % (math.pi / 2.0) - math.pi / 4.0
        # lateral place of the corner between the two faces that meet the current
        edge = half * (math.cos(turned) - math.sin(abs(turned)))
        beyond = lateral < -edge if turned >= 0.0 else lateral > edge
        angle = np.where(beyond & (abs(turned) > 1e-9), math.pi / 2.0 - abs(turned), abs(turned))
    return np.asarray(wake_factor(net.wake, net.law, net.net, angle, speed=speed, viscosity=model.kinematic_viscosity))


def panel_middles(corners: NDArray[np.int64], position: Array) -> Array:
    """Return the mean of the corners of panels (p, 3) [m]."""
    there = corners >= 0
    points = position[np.where(there, corners, 0)] * there[:, :, None]
    return np.asarray(points.sum(axis=1) / there.sum(axis=1)[:, None])


def half_width(model: FlexibleCage, heading: float) -> float:
    """Return half the breadth of a cage across a current of this heading [m]."""
    half = 0.5 * model.design.size
    if model.design.shape == "circular":
        return half
    return half * (abs(math.cos(heading)) + abs(math.sin(heading)))


def flow_factors(model: FlexibleCage, built: CageNetwork, current: Current | None) -> Array:
    """Return the speed of the current at each panel over the undisturbed one [-] [eq:cage-wake].

    The rear half of every cage lies behind its front wall; a cage downstream of others lies behind both walls of
    each. A panel finds the walls that its streamline passed by its place across the current.
    """
    panels = built.network.panels
    assert panels is not None
    factor = np.ones(len(panels))
    if current is None or model.design.net.wake == "none":
        return factor
    middle = panel_middles(panels.corners, built.network.nodes.position)
    velocity = current.velocity(middle[:, 2])
    speed = np.hypot(velocity[:, 0], velocity[:, 1])
    if not np.any(speed > 0.0):
        return factor
    leading = int(np.argmax(speed))
    heading = math.atan2(velocity[leading, 1], velocity[leading, 0])
    along, across = np.array([math.cos(heading), math.sin(heading)]), np.array([-math.sin(heading), math.cos(heading)])
    wide = half_width(model, heading)
    for cage in built.cages:
        own = np.concatenate([cage.wall_panels, cage.bottom_panels])
        place = middle[own, :2] - np.array(cage.centre)
        side, forward = place @ across, place @ along
        met = np.ones(own.size)
        for other in built.cages if model.array_wake else ():
            gap = np.array(cage.centre) - np.array(other.centre)
            offset = side + float(gap @ across)
            if other is cage or float(gap @ along) < 0.5 * model.design.size:
                continue
            hit = np.abs(offset) < wide
            met = np.where(hit, met * _walls_passed(model, offset, heading, speed[own]) ** 2, met)
        rear = forward > 1e-9 * model.design.size
        passed = _walls_passed(model, np.clip(side, -wide, wide), heading, met * speed[own])
        factor[own] = met * np.where(rear, passed, 1.0)
    return factor


def sheltered(model: FlexibleCage, built: CageNetwork, current: Current | None) -> Network:
    """Return the network whose panels miss what the current has lost upstream; waves are not sheltered."""
    panels = built.network.panels
    assert panels is not None
    factor = flow_factors(model, built, current)
    if current is None or np.all(factor == 1.0):
        return built.network
    velocity = current.velocity(panel_middles(panels.corners, built.network.nodes.position)[:, 2])
    lost = np.zeros((len(panels), 3))
    lost[:, :2] = (1.0 - factor)[:, None] * velocity
    return replace(built.network, panels=replace(panels, shadow=lost))


@dataclass(frozen=True)
class ScaledCurrent:
    """A current profile times a factor."""

    #: What is scaled.
    profile: Current
    #: [-].
    factor: float

    def velocity(self, z: ArrayLike) -> Array:
        """Return the velocity (..., 2) at heights z [m/s]."""
        return np.asarray(self.factor * self.profile.velocity(z))
