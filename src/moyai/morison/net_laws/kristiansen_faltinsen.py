"""Screen law of Kristiansen and Faltinsen (2012): the drag of a cylinder in the speed between the twines."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import ClassVar, Literal

import numpy as np
from numpy.typing import ArrayLike

from moyai.core.arrays import Array
from moyai.core.options import checks_words
from moyai.morison.net_law_base import NetLaw
from moyai.morison.nets import Net

#: Polynomial of the drag of a smooth circular cylinder in log10 Re, constant first
_CYLINDER = (-78.46675, 254.73873, -327.8864, 223.64577, -87.92234, 20.00769, -2.44894, 0.12479)
_LIMITS = (10.0**1.5, 1e4)


def cylinder_drag(reynolds: ArrayLike) -> Array:
    """Return the drag coefficient of a smooth circular cylinder [eq:net-cylinder].

    Parameters
    ----------
    reynolds : array_like
        Re; outside 10^1.5 to 10^4 the value of the limit is kept.
    """
    x = np.log10(np.clip(np.asarray(reynolds, dtype=float), *_LIMITS))
    return np.asarray(np.polynomial.polynomial.polyval(x, _CYLINDER))


@checks_words
@dataclass(frozen=True)
class KristiansenFaltinsen(NetLaw):
    """Drag and lift by two harmonics of the angle, scaled at 0 and at 45 degrees."""

    name: ClassVar[str] = "kristiansen_faltinsen"
    kind: ClassVar[str] = "screen"
    source: ClassVar[str] = "Kristiansen and Faltinsen (2012), Journal of Fluids and Structures 34, 218"
    reynolds_range: ClassVar[tuple[float, float]] = _LIMITS
    solidity_range: ClassVar[tuple[float, float]] = (0.0, 0.5)
    reynolds_name: ClassVar[str] = "Re = U d / (nu (1 - S))"
    outside: ClassVar[str] = "the drag of the cylinder keeps its value of the limit"
    basis: ClassVar[str] = "round twines"
    skin: ClassVar[str] = "no force at zero solidity, none along a panel parallel to the flow"

    #: Normal force coefficient at 45 degrees behind the tangential force: by cross flow it is C_D0 / 2, the same as in
    #: the rest of the law; ``solidity`` takes C_cyl S / (2 (1 - S)^2), as one published code does. The two meet at zero
    #: solidity; the second lowers the lift, by a tenth at a solidity of 0.3.
    normal_at_45: Literal["cross_flow", "solidity"] = "cross_flow"

    def reynolds(self, speed: ArrayLike, net: Net, kinematic_viscosity: float) -> Array:
        """Return the Reynolds number in the speed between the twines."""
        return super().reynolds(speed, net, kinematic_viscosity) / (1.0 - net.solidity)

    def _coefficients(self, angle: Array, speed: Array, net: Net, kinematic_viscosity: float) -> tuple[Array, Array]:
        """[eq:net-screen]."""
        s = net.solidity
        cylinder = cylinder_drag(self.reynolds(speed, net, kinematic_viscosity))
        ahead = cylinder * s * (2.0 - s) / (2.0 * (1.0 - s) ** 2)
        normal = 0.5 * ahead if self.normal_at_45 == "cross_flow" else cylinder * s / (2.0 * (1.0 - s) ** 2)
        # Loland's tangential force at t = pi/4: t 4 C_N / (8 + C_N)
        tangential = math.pi * normal / (8.0 + normal)
        aside = (0.5 * ahead - tangential) / math.sqrt(2.0)
        drag = ahead * (0.9 * np.cos(angle) + 0.1 * np.cos(3.0 * angle))
        return drag, aside * (np.sin(2.0 * angle) + 0.1 * np.sin(4.0 * angle))
