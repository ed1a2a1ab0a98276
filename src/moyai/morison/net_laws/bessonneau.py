"""Twine law of Bessonneau and Marichal (1998): constant coefficients."""

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
class Bessonneau(TwineLaw):
    """C_n = 1.2 across and C_t = 0.1 along the twine [eq:net-constant-twine]."""

    name: ClassVar[str] = "bessonneau"
    source: ClassVar[str] = "Bessonneau and Marichal (1998), Ocean Engineering 25, 563"
    reynolds_range: ClassVar[tuple[float, float]] = (100.0, math.inf)
    outside: ClassVar[str] = "the coefficients are constants, too small for slow flow"

    def normal_drag(self, reynolds: ArrayLike, net: Net) -> Array:
        """Return 1.2."""
        return np.full(np.shape(reynolds), 1.2)

    def tangential_drag(self, reynolds: ArrayLike, along: ArrayLike, net: Net) -> Array:
        """Return 0.1."""
        return np.full(np.broadcast(np.asarray(reynolds), np.asarray(along)).shape, 0.1)
