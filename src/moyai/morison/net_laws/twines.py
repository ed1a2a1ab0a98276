"""Nets as crossed twines, each with Morison's drag across and along itself: the base of the twine laws."""

from __future__ import annotations

import math
from abc import abstractmethod
from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from numpy.typing import ArrayLike

from moyai.core.arrays import Array
from moyai.core.errors import InputError
from moyai.morison.net_law_base import NetLaw
from moyai.morison.nets import Net


@dataclass(frozen=True)
class TwineLaw(NetLaw):
    """Both families of twines by the cross-flow principle, without shelter of one by another [eq:net-twines].

    Each family holds half of the shaded area, so that crossings count once.
    """

    kind: ClassVar[str] = "twine"
    solidity_range: ClassVar[tuple[float, float]] = (0.0, 0.3)
    skin: ClassVar[str] = "no force at zero solidity; twines across the flow keep their drag on a parallel panel"
    basis: ClassVar[str] = "single twine"

    #: Angle in the panel between the first family of twines and the plane of flow and normal [rad]: 0 for an upright
    #: wall of square meshes in a level current, pi/4 for diamond meshes.
    azimuth: float = 0.0

    def __post_init__(self) -> None:
        if not math.isfinite(self.azimuth):
            raise InputError(f"azimuth is {self.azimuth:g} rad", parameter="azimuth", allowed="a finite angle")

    @abstractmethod
    def normal_drag(self, reynolds: ArrayLike, net: Net) -> Array:
        """Return the drag coefficient across a twine, on its diameter, by Re of the speed across it."""

    def tangential_drag(self, reynolds: ArrayLike, along: ArrayLike, net: Net) -> Array:
        """Return the coefficient along a twine, on its diameter, by Re of the speeds across and along it."""
        return np.zeros(np.broadcast(np.asarray(reynolds), np.asarray(along)).shape)

    def _coefficients(self, angle: Array, speed: Array, net: Net, kinematic_viscosity: float) -> tuple[Array, Array]:
        """[eq:net-twines]."""
        share = 0.5 * net.twine_area_per_area
        number = self.reynolds(speed, net, kinematic_viscosity)
        cosine, sine = np.cos(angle), np.sin(angle)
        drag, lift = np.zeros_like(cosine), np.zeros_like(cosine)
        for turn in (self.azimuth, self.azimuth + 0.5 * math.pi):
            # unit flow = (cosine, sine) in the plane of normal and flow; the twine lies in the panel
            along = sine * math.cos(turn)
            across = np.sqrt(np.maximum(0.0, 1.0 - along**2))
            normal = share * across * self.normal_drag(number * across, net)
            axial = share * np.abs(along) * self.tangential_drag(number * across, number * np.abs(along), net)
            # along the flow: normal part |u_n|^2, axial part u_t^2; across it in the plane: -(e_lift . t)(u . t) each
            drag += normal * across**2 + axial * along**2
            lift += (normal - axial) * along * math.cos(turn) * cosine
        return drag, lift
