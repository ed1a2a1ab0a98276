"""Twine law of Wan and others (2002): one constant."""

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
class Wan(TwineLaw):
    """C_n = 1.3 across the twine, no force along it [eq:net-constant-twine]."""

    name: ClassVar[str] = "wan"
    source: ClassVar[str] = "Wan, Hu, Tokai and Matuda (2002), Fisheries Science 68, 124"
    reynolds_range: ClassVar[tuple[float, float]] = (100.0, math.inf)
    outside: ClassVar[str] = "the coefficient is a constant, too small for slow flow"

    def normal_drag(self, reynolds: ArrayLike, net: Net) -> Array:
        """Return 1.3."""
        return np.full(np.shape(reynolds), 1.3)
