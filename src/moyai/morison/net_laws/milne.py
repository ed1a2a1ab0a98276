"""Twine law of Milne (1972): constants that grow with the closeness of the meshes."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from numpy.typing import ArrayLike

from moyai.core.arrays import Array
from moyai.morison.net_laws.twines import TwineLaw
from moyai.morison.nets import Net


@dataclass(frozen=True)
class Milne(TwineLaw):
    """C_n = 1 + 2.73 d/a + 3.12 (d/a)^2 of knotless nets, 1 + 3.77 d/a + 9.37 (d/a)^2 of knotted, a the bar length."""

    name: ClassVar[str] = "milne"
    source: ClassVar[str] = "Milne (1972), Fish and Shellfish Farming in Coastal Waters, Fishing News Books"
    reynolds_range: ClassVar[tuple[float, float]] = (100.0, math.inf)
    basis: ClassVar[str] = "nets"
    outside: ClassVar[str] = "the coefficient does not depend on Re and is too small for slow flow"

    def normal_drag(self, reynolds: ArrayLike, net: Net) -> Array:
        """[eq:net-milne]."""
        ratio = net.twine_diameter / net.mesh_pitch
        first, second = (3.77, 9.37) if net.knotted else (2.73, 3.12)
        return np.full(np.shape(reynolds), 1.0 + first * ratio + second * ratio**2)
