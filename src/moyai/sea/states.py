"""Sea states as a case names them: regular waves of several periods, irregular seas by their spectrum."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from moyai.core.errors import InputError
from moyai.sea.spectrum import Spectrum


@dataclass(frozen=True)
class RegularSea:
    """Regular waves of one height and one or more periods.

    Parameters
    ----------
    name : str
        Label of the sea state.
    height : float
        Wave height H [m].
    periods : tuple of float
        Wave periods T [s] in the fixed frame.
    heading : float
        Direction of travel [rad], 0 along +x (normal to the breakwater).
    """

    name: str
    height: float
    periods: tuple[float, ...]
    heading: float = 0.0

    def __post_init__(self) -> None:
        if not self.periods:
            raise InputError("no wave period given", path="waves.periods", allowed="at least one period")
        if self.height < 0.0 or not all(period > 0.0 for period in self.periods):
            raise InputError("wave height and periods must be positive", path="waves")


@dataclass(frozen=True)
class IrregularSea:
    """An irregular sea by its spectrum.

    Parameters
    ----------
    name : str
        Label of the sea state.
    spectrum : Spectrum
        Frequency spectrum [m2 s/rad].
    heading : float
        Mean direction of travel [rad].
    spreading : object or None
        Directional spreading of :mod:`moyai.sea`, ``None`` for long crests.
    duration : float
        Length of the time-domain realisation [s].
    seed : int
        Seed of the random phases.
    """

    name: str
    spectrum: Spectrum
    heading: float = 0.0
    spreading: Any = None
    duration: float = 10800.0
    seed: int = 1


SeaState = RegularSea | IrregularSea
