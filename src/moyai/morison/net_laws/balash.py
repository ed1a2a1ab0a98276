"""Law of Balash and others (2009) for plane nets: a cylinder's drag times a polynomial of the solidity."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from moyai.core.arrays import Array
from moyai.morison.net_law_base import NetLaw
from moyai.morison.nets import Net

_LIMITS = (1.0, 2e5)


@dataclass(frozen=True)
class Balash(NetLaw):
    """C_D = C_cyl (0.12 - 0.74 S + 8.03 S^2) cos^3 t with C_cyl = 1 + 10 Re^(-2/3); no lift.

    Cross flow gives the third power of the cosine for the drag of a force along the normal. A published code multiplies
    by the third power of the angle itself, which would vanish at normal flow: a slip of the pen.
    """

    name: ClassVar[str] = "balash"
    kind: ClassVar[str] = "screen"
    source: ClassVar[str] = "Balash, Colbourne, Bose and Raman-Nair (2009), Aquacultural Engineering 41, 151"
    reynolds_range: ClassVar[tuple[float, float]] = _LIMITS
    solidity_range: ClassVar[tuple[float, float]] = (0.05, 0.45)
    outside: ClassVar[str] = "the drag of the cylinder keeps its value of the limit"
    skin: ClassVar[str] = "0.12 C_cyl is left at zero solidity, and the polynomial falls below it up to 0.09"

    def _coefficients(self, angle: Array, speed: Array, net: Net, kinematic_viscosity: float) -> tuple[Array, Array]:
        """[eq:net-balash]."""
        s = net.solidity
        number = np.clip(self.reynolds(speed, net, kinematic_viscosity), *_LIMITS)
        ahead = (1.0 + 10.0 * number ** (-2.0 / 3.0)) * (0.12 - 0.74 * s + 8.03 * s**2)
        return ahead * np.cos(angle) ** 3, np.zeros_like(angle)
