"""Loland's screen law (1991): polynomials in the solidity, no Reynolds number."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from moyai.core.arrays import Array
from moyai.morison.net_law_base import NetLaw
from moyai.morison.nets import Net


@dataclass(frozen=True)
class Loland(NetLaw):
    """C_D = 0.04 + (-0.04 + 0.33 S + 6.54 S^2 - 4.88 S^3) cos t; C_L = (-0.05 S + 2.3 S^2 - 1.76 S^3) sin 2t."""

    name: ClassVar[str] = "loland"
    kind: ClassVar[str] = "screen"
    source: ClassVar[str] = "Loland (1991), Current forces on and flow through fish farms, NTH Trondheim"
    reynolds_range: ClassVar[tuple[float, float]] = (0.0, math.inf)
    solidity_range: ClassVar[tuple[float, float]] = (0.13, 0.32)
    skin: ClassVar[str] = "no force across a panel of zero solidity; 0.04 of its outline area along it"

    def _coefficients(self, angle: Array, speed: Array, net: Net, kinematic_viscosity: float) -> tuple[Array, Array]:
        """[eq:net-loland]."""
        s = net.solidity
        drag = 0.04 + (-0.04 + 0.33 * s + 6.54 * s**2 - 4.88 * s**3) * np.cos(angle)
        return drag, (-0.05 * s + 2.3 * s**2 - 1.76 * s**3) * np.sin(2.0 * angle)
