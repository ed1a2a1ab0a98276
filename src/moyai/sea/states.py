"""Sea states as a case names them: regular waves of several periods, irregular seas by their spectrum."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

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


@dataclass(frozen=True, eq=False)
class ComponentSea:
    """A sea given wave by wave, or by a record of its elevation at the origin; for networks.

    Parameters
    ----------
    name : str
        Label of the sea state.
    omega, amplitude, phase, headings : ndarray (n,)
        Of the waves a cos(k (x cos b + y sin b) - omega t + phase) [rad/s, m, rad, rad].
    duration : float or None
        Of the run [s]; ``None``: the case says it elsewhere.
    period : float
        After which a record repeats [s]; infinite for waves that were given one by one.
    """

    name: str
    omega: NDArray[np.float64]
    amplitude: NDArray[np.float64]
    phase: NDArray[np.float64]
    headings: NDArray[np.float64]
    duration: float | None = None
    period: float = math.inf

    @property
    def heading(self) -> float:
        """Direction of travel of the highest wave [rad]."""
        return float(self.headings[int(np.argmax(self.amplitude))])

    @property
    def peak_period(self) -> float:
        """Period of the highest wave [s]."""
        return 2.0 * math.pi / float(self.omega[int(np.argmax(self.amplitude))])

    @property
    def height(self) -> float:
        """Height of a single wave; of several four standard deviations of the elevation [m]."""
        if self.omega.size == 1:
            return 2.0 * float(self.amplitude[0])
        return 4.0 * math.sqrt(0.5 * float(np.sum(self.amplitude**2)))
