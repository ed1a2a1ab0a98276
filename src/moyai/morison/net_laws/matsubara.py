"""Power law of Matsubara, Noda and Nishihira for wire nets, on the area of the twines as they list it."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import ClassVar, Literal

import numpy as np
from numpy.typing import ArrayLike

from moyai.core.arrays import Array
from moyai.core.errors import InputError
from moyai.core.options import checks_words
from moyai.morison.net_law_base import NetLaw
from moyai.morison.nets import Net

#: C_D = FACTOR Re^-EXPONENT
FACTOR, EXPONENT = 9.84, 0.36


@checks_words
@dataclass(frozen=True)
class Matsubara(NetLaw):
    """C_D = 9.84 Re^-0.36 on the area of the twines, across a panel; a share of it along the panel.

    Below Re = 84, where the measured values scatter, the power continues up to a cap; above 1800, the largest number
    towed, the coefficient is held.

    Raises
    ------
    InputError
        For a cap that is not positive or a share outside 0 to 1.
    """

    name: ClassVar[str] = "matsubara"
    kind: ClassVar[str] = "screen"
    source: ClassVar[str] = "Matsubara, Noda and Nishihira, dynamic response of an offshore fish cage, equation 2"
    reynolds_range: ClassVar[tuple[float, float]] = (84.0, 1800.0)
    solidity_range: ClassVar[tuple[float, float]] = (0.22, 0.687)
    outside: ClassVar[str] = "below, the power law is extrapolated up to the cap; above, the coefficient is held"
    skin: ClassVar[str] = "no force at zero solidity; the tangential share along the panel"
    basis: ClassVar[str] = "wire nets"
    confirmed: ClassVar[bool] = True

    #: Largest C_D on the area of the twines [-].
    cap: float = 3.0
    #: Area of the twines per outline area. ``listed`` reproduces the paper, whose areas count the crossings twice;
    #: ``geometric`` counts them once, and then the same law gives less than the paper measured.
    solidity: Literal["listed", "geometric"] = "listed"
    #: Force along the panel: this share of C_D, on the speed along the panel [-]. Not from the paper, which towed its
    #: nets perpendicular to the flow.
    tangential_share: float = 0.25

    def __post_init__(self) -> None:
        if not (math.isfinite(self.cap) and self.cap > 0.0):
            raise InputError(f"cap is {self.cap:g}", parameter="cap", allowed="greater than 0")
        if not 0.0 <= self.tangential_share <= 1.0:
            raise InputError(
                f"tangential_share is {self.tangential_share:g}", parameter="tangential_share", allowed="0 to 1"
            )

    def twine_drag(self, reynolds: ArrayLike) -> Array:
        """Return C_D on the area of the twines [eq:net-matsubara].

        Parameters
        ----------
        reynolds : array_like
            Re = U d / nu.
        """
        number = np.minimum(np.asarray(reynolds, dtype=float), self.reynolds_range[1])
        # the number at which the cap is met: below it nothing diverges
        least = (FACTOR / self.cap) ** (1.0 / EXPONENT)
        return np.where(number > least, FACTOR * np.maximum(number, least) ** -EXPONENT, self.cap)

    def range_solidity(self, net: Net) -> float:
        """Return the solidity that the law is for."""
        return net.listed if self.solidity == "listed" else net.solidity

    def _coefficients(self, angle: Array, speed: Array, net: Net, kinematic_viscosity: float) -> tuple[Array, Array]:
        """[eq:net-components]."""
        level = self.twine_drag(self.reynolds(speed, net, kinematic_viscosity)) * self.range_solidity(net)
        across, along = np.cos(angle) ** 2, self.tangential_share * np.sin(angle) ** 2
        drag = across * np.cos(angle) + along * np.sin(angle)
        return level * drag, level * (across * np.sin(angle) - along * np.cos(angle))
