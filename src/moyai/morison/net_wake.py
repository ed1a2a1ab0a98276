"""How much slower the water is behind a net: factors on the speed that meets the next one."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from moyai.core.arrays import Array
from moyai.core.errors import InputError
from moyai.morison.net_law_base import NetLaw
from moyai.morison.nets import Net

WakeName = Literal["none", "loland", "cheng"]


def loland_wake(law: NetLaw, net: Net, angle: ArrayLike, speed: ArrayLike, viscosity: float) -> Array:
    """Return r = 1 - 0.46 C_D with the drag of the panel by a law, at least 0 [eq:net-wake-loland].

    Loland (1991), from the free wake of a screen. A published code's comment writes 0.14; 0.46 is what it computes.
    """
    drag, _ = law.coefficients(angle, speed, net, viscosity)
    return np.asarray(np.maximum(0.0, 1.0 - 0.46 * drag))


def cheng_wake(law: NetLaw, net: Net, angle: ArrayLike, speed: ArrayLike, viscosity: float) -> Array:
    """Return r = max(0, (c + 0.05 - 0.38 S) / (c + 0.05)), c = cos of the angle [eq:net-wake-cheng].

    Cheng, Li, Aarsaether and Ong (2020), Aquacultural Engineering 90, 102070. Falls with the obliquity, and is 0 where
    the panel is seen edge on: c + 0.05 below 0.38 S.
    """
    c = np.abs(np.cos(np.asarray(angle, dtype=float))) + 0.05
    both = np.broadcast(c, np.asarray(speed)).shape
    return np.asarray(np.broadcast_to(np.maximum(0.0, (c - 0.38 * net.solidity) / c), both))


def no_wake(law: NetLaw, net: Net, angle: ArrayLike, speed: ArrayLike, viscosity: float) -> Array:
    """Return 1: no shelter."""
    return np.ones(np.broadcast(np.asarray(angle), np.asarray(speed)).shape)


WAKE_LAWS: dict[str, Callable[[NetLaw, Net, ArrayLike, ArrayLike, float], Array]] = {
    "loland": loland_wake,
    "cheng": cheng_wake,
    "none": no_wake,
}


def wake_factor(
    name: str, law: NetLaw, net: Net, angle: ArrayLike = 0.0, *, speed: ArrayLike, viscosity: float
) -> Array:
    """Return the speed behind a panel over the speed before it.

    Parameters
    ----------
    name : {"loland", "cheng", "none"}
    law : NetLaw
        Law of the panel's drag.
    net : Net
    angle : array_like
        Between flow and normal of the panel [rad].
    speed : array_like
        Before the panel [m/s].
    viscosity : float
        Kinematic [m2/s].

    Raises
    ------
    InputError
        For an unknown name.
    """
    if name not in WAKE_LAWS:
        raise InputError(f"unknown wake law '{name}'", parameter="wake", allowed=", ".join(WAKE_LAWS))
    return WAKE_LAWS[name](law, net, angle, speed, viscosity)


def speed_through(
    name: str, law: NetLaw, nets: Sequence[Net], angles: Sequence[float], *, speed: float, viscosity: float
) -> tuple[float, ...]:
    """Return the speed before each of several panels in a row and behind the last [m/s] [eq:net-wake-row].

    Parameters
    ----------
    name : str
        Law of the wake.
    law : NetLaw
    nets : sequence of Net
        In the order in which the water meets them.
    angles : sequence of float
        One each [rad].
    speed : float
        Before the first [m/s].
    viscosity : float
        Kinematic [m2/s].
    """
    if len(nets) != len(angles):
        raise InputError(f"{len(angles)} angles for {len(nets)} nets", parameter="angles", allowed="one each")
    speeds = [float(speed)]
    for net, angle in zip(nets, angles):
        speeds.append(speeds[-1] * float(wake_factor(name, law, net, angle, speed=speeds[-1], viscosity=viscosity)))
    return tuple(speeds)
