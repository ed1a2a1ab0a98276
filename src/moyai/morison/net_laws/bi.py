"""Law of Bi and others (2014), fitted to one net: the angle alone."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from moyai.core.arrays import Array
from moyai.morison.net_law_base import NetLaw
from moyai.morison.nets import Net


@dataclass(frozen=True)
class Bi(NetLaw):
    """C_D = 0.04 + 0.4921 c + 0.1873 c^2, c = cos t; C_L = 0.4159 s - 0.169 s^2, s = sin 2t."""

    name: ClassVar[str] = "bi"
    kind: ClassVar[str] = "screen"
    source: ClassVar[str] = "Bi, Zhao, Dong and others (2014), Journal of Fluids and Structures 45, 87"
    reynolds_range: ClassVar[tuple[float, float]] = (0.0, math.inf)
    # the law holds no solidity: it was fitted to one net, of about a quarter by twine and mesh as reported elsewhere
    solidity_range: ClassVar[tuple[float, float]] = (0.2, 0.3)
    skin: ClassVar[str] = "the law does not depend on solidity: its force does not vanish with it; 0.04 along the panel"
    basis: ClassVar[str] = "one net"

    def _coefficients(self, angle: Array, speed: Array, net: Net, kinematic_viscosity: float) -> tuple[Array, Array]:
        """[eq:net-bi]."""
        cosine, sine = np.cos(angle), np.sin(2.0 * angle)
        return 0.04 + 0.4921 * cosine + 0.1873 * cosine**2, 0.4159 * sine - 0.169 * sine**2
