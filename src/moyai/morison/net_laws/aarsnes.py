"""Screen law of Aarsnes, Rudi and Loland (1990): polynomials in the solidity, no Reynolds number."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from moyai.core.arrays import Array
from moyai.morison.net_law_base import NetLaw
from moyai.morison.nets import Net


@dataclass(frozen=True)
class Aarsnes(NetLaw):
    """C_D = 0.04 + (-0.04 + S - 1.24 S^2 + 13.7 S^3) cos t; C_L = (0.57 S - 3.54 S^2 + 10.1 S^3) sin 2t."""

    name: ClassVar[str] = "aarsnes"
    kind: ClassVar[str] = "screen"
    source: ClassVar[str] = "Aarsnes, Rudi and Loland (1990), Current forces on cage, net deflection, Telford, London"
    reynolds_range: ClassVar[tuple[float, float]] = (0.0, math.inf)
    solidity_range: ClassVar[tuple[float, float]] = (0.13, 0.32)
    skin: ClassVar[str] = "no force across a panel of zero solidity; 0.04 of its outline area along it"

    def _coefficients(self, angle: Array, speed: Array, net: Net, kinematic_viscosity: float) -> tuple[Array, Array]:
        """[eq:net-aarsnes]."""
        s = net.solidity
        drag = 0.04 + (-0.04 + s - 1.24 * s**2 + 13.7 * s**3) * np.cos(angle)
        return drag, (0.57 * s - 3.54 * s**2 + 10.1 * s**3) * np.sin(2.0 * angle)
