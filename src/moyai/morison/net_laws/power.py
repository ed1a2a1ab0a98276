"""A power law of one's own, as the identification of a towed net gives it: C_D = A Re^-B on the area of the twines."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass
from typing import ClassVar, Literal

import numpy as np
from numpy.typing import ArrayLike

from moyai.core.arrays import Array
from moyai.core.errors import InputError
from moyai.core.options import checks_words
from moyai.morison.net_law_base import NetLaw
from moyai.morison.nets import Net

_NUMBER = r"(\d+(?:\.\d*)?(?:[eE][+-]?\d+)?)"
_TEXT = re.compile(rf"^\s*{_NUMBER}\s*Re\s*\^\s*-\s*{_NUMBER}(?:\s+from\s+{_NUMBER}\s+to\s+{_NUMBER})?\s*$")


@checks_words
@dataclass(frozen=True)
class PowerLawNet(NetLaw):
    """C_D = A Re^-B across a panel, a share of it along the panel [eq:net-components].

    Raises
    ------
    InputError
        For values that are not positive, a range that does not rise, or a share outside 0 to 1.
    """

    name: ClassVar[str] = "power"
    kind: ClassVar[str] = "screen"
    source: ClassVar[str] = "a fit of one's own"
    reynolds_range: ClassVar[tuple[float, float]] = (0.0, math.inf)
    solidity_range: ClassVar[tuple[float, float]] = (0.0, 1.0)
    outside: ClassVar[str] = "below, the power law is extrapolated up to the cap; above, the coefficient is held"
    basis: ClassVar[str] = "one net"
    skin: ClassVar[str] = "no force at zero solidity; the tangential share along the panel"

    #: Factor A of C_D = A Re^-B.
    factor: float
    #: Exponent B of the same law.
    exponent: float
    #: Lowest Re that A and B were found at: below it the power law is extrapolated up to the cap.
    lowest: float = 0.0
    #: Highest Re that A and B were found at: above it C_D is held.
    highest: float = math.inf
    #: Largest C_D on the area of the twines [-].
    cap: float = 3.0
    #: Area of the twines per outline area: the one that the C_D were referred to.
    solidity: Literal["listed", "geometric"] = "listed"
    #: Force along the panel, as a share of C_D [-].
    tangential_share: float = 0.25

    def __post_init__(self) -> None:
        for name in ("factor", "cap"):
            value = getattr(self, name)
            if not (math.isfinite(value) and value > 0.0):
                raise InputError(f"{name} is {value:g}", parameter=name, allowed="greater than 0")
        if not 0.0 <= self.exponent < 1.0:
            raise InputError(f"exponent is {self.exponent:g}", parameter="exponent", allowed="0 to below 1")
        if not 0.0 <= self.lowest < self.highest:
            raise InputError(
                f"the range of Re from {self.lowest:g} to {self.highest:g}",
                parameter="lowest",
                allowed="a range that rises",
            )
        if not 0.0 <= self.tangential_share <= 1.0:
            raise InputError(
                f"tangential_share is {self.tangential_share:g}", parameter="tangential_share", allowed="0 to 1"
            )
        # the range of this law is its own, not that of its class
        object.__setattr__(self, "reynolds_range", (self.lowest, self.highest))

    def twine_drag(self, reynolds: ArrayLike) -> Array:
        """Return C_D on the area of the twines.

        Parameters
        ----------
        reynolds : array_like
            Re = U d / nu.
        """
        number = np.minimum(np.asarray(reynolds, dtype=float), self.highest)
        if self.exponent == 0.0:
            return np.full(number.shape, min(self.factor, self.cap))
        least = (self.factor / self.cap) ** (1.0 / self.exponent)
        return np.where(number > least, self.factor * np.maximum(number, least) ** -self.exponent, self.cap)

    def range_solidity(self, net: Net) -> float:
        """Return the solidity that the law is for."""
        return net.listed if self.solidity == "listed" else net.solidity

    def _coefficients(self, angle: Array, speed: Array, net: Net, kinematic_viscosity: float) -> tuple[Array, Array]:
        """[eq:net-components]."""
        level = self.twine_drag(self.reynolds(speed, net, kinematic_viscosity)) * self.range_solidity(net)
        across, along = np.cos(angle) ** 2, self.tangential_share * np.sin(angle) ** 2
        drag = across * np.cos(angle) + along * np.sin(angle)
        return level * drag, level * (across * np.sin(angle) - along * np.cos(angle))


def read_power_law(text: str) -> dict[str, float] | None:
    """Return the numbers of ``11.4 Re^-0.40`` or ``11.4 Re^-0.40 from 120 to 1100``, ``None`` for another text."""
    match = _TEXT.match(text)
    if match is None:
        return None
    names = ("factor", "exponent", "lowest", "highest")
    return {name: float(number) for name, number in zip(names, match.groups()) if number is not None}
