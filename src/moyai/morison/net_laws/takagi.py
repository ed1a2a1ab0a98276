"""Twine law of Takagi and others (2004)."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from numpy.typing import ArrayLike

from moyai.core.arrays import Array
from moyai.morison.net_laws.twines import TwineLaw
from moyai.morison.nets import Net

_LIMITS = (10.0, 1e4)


@dataclass(frozen=True)
class Takagi(TwineLaw):
    """C_n = 10^0.7 Re^-0.3 below Re = 200, 1.2 above; no force along the twine.

    The two branches do not meet: 1.02 below and 1.2 above 200, as published.
    """

    name: ClassVar[str] = "takagi"
    source: ClassVar[str] = "Takagi, Shimizu, Suzuki, Hiraishi and Yamamoto (2004), Fisheries Research 66, 83"
    reynolds_range: ClassVar[tuple[float, float]] = _LIMITS
    outside: ClassVar[str] = "the drag of the twine keeps its value of the limit"

    def normal_drag(self, reynolds: ArrayLike, net: Net) -> Array:
        """[eq:net-takagi]."""
        number = np.clip(np.asarray(reynolds, dtype=float), *_LIMITS)
        return np.where(number < 200.0, 10.0**0.7 * number**-0.3, 1.2)
