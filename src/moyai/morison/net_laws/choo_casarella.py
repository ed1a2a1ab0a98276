"""Twine law of Choo and Casarella (1971): drag across and along a cable by the Reynolds number."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from numpy.typing import ArrayLike

from moyai.core.arrays import Array
from moyai.morison.net_laws.twines import TwineLaw
from moyai.morison.nets import Net

_LIMITS = (1e-2, 2.33e5)
_EULER = 0.077215665


@dataclass(frozen=True)
class ChooCasarella(TwineLaw):
    """Four branches across the twine; along it, friction in proportion to the speed along it."""

    name: ClassVar[str] = "choo_casarella"
    source: ClassVar[str] = "Choo and Casarella (1971), Journal of Hydronautics 5, 126"
    reynolds_range: ClassVar[tuple[float, float]] = _LIMITS
    outside: ClassVar[str] = "the drag of the twine keeps its value of the limit"

    def normal_drag(self, reynolds: ArrayLike, net: Net) -> Array:
        """[eq:net-choo-normal]."""
        number = np.clip(np.asarray(reynolds, dtype=float), *_LIMITS)
        slow = np.log(8.0 / np.minimum(number, 1.0)) - _EULER
        creeping = 8.0 * math.pi / (np.minimum(number, 1.0) * slow) * (1.0 - 0.87 / slow**2)
        middle = 1.45 + 8.55 * number**-0.9
        values: Array = np.where(number <= 1.0, creeping, np.where(number < 30.0, middle, 1.1 + 4.0 * number**-0.5))
        return values

    def tangential_drag(self, reynolds: ArrayLike, along: ArrayLike, net: Net) -> Array:
        """[eq:net-choo-tangential]: pi mu (0.55 Re^(1/2) + 0.084 Re^(2/3)) u_t per length, on rho/2 d u_t^2."""
        across, axial = np.asarray(reynolds, dtype=float), np.asarray(along, dtype=float)
        friction = 2.0 * math.pi * (0.55 * np.sqrt(across) + 0.084 * across ** (2.0 / 3.0))
        values: Array = friction / np.maximum(axial, 1e-12)
        return values
