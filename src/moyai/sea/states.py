"""Sea states as a case names them: regular waves of several periods, irregular seas by their spectrum."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from moyai.core.errors import InputError
from moyai.core.options import checks_words
from moyai.sea.regular_theory import RegularTheory
from moyai.sea.spectrum import Spectrum


@checks_words
@dataclass(frozen=True)
class RegularSea:
    """Regular waves of one height and one or more periods."""

    #: Label of the sea state.
    name: str
    #: Wave height H [m].
    height: float
    #: Wave periods T [s] in the fixed frame.
    periods: tuple[float, ...]
    #: Direction of travel [rad], 0 along +x (normal to the breakwater).
    heading: float = 0.0
    #: Of structures that know more than linear waves.
    theory: RegularTheory = "linear"

    def __post_init__(self) -> None:
        if not self.periods:
            raise InputError("no wave period given", parameter="periods", allowed="at least one period")
        if self.height < 0.0 or not all(period > 0.0 for period in self.periods):
            raise InputError("wave height and periods must be positive", parameter="waves")


@dataclass(frozen=True)
class IrregularSea:
    """An irregular sea by its spectrum."""

    #: Label of the sea state.
    name: str
    #: Frequency spectrum [m2 s/rad].
    spectrum: Spectrum
    #: Mean direction of travel [rad].
    heading: float = 0.0
    #: Directional spreading of :mod:`moyai.sea`, ``None`` for long crests.
    spreading: Any = None
    #: Length of the time-domain realisation [s].
    duration: float = 10800.0
    #: Seed of the random phases.
    seed: int = 1


SeaState = RegularSea | IrregularSea


@dataclass(frozen=True, eq=False)
class ComponentSea:
    """A sea given wave by wave, or by a record of its elevation at the origin; for networks."""

    #: Label of the sea state.
    name: str
    #: Angular frequency of the waves a cos(k (x cos b + y sin b) - omega t + phase) [rad/s]; shape (n,).
    omega: NDArray[np.float64]
    #: Their amplitude a [m]; shape (n,).
    amplitude: NDArray[np.float64]
    #: Their phase [rad]; shape (n,).
    phase: NDArray[np.float64]
    #: Their heading b [rad]; shape (n,).
    headings: NDArray[np.float64]
    #: Of the run [s]; ``None``: the case says it elsewhere.
    duration: float | None = None
    #: After which a record repeats [s]; infinite for waves that were given one by one.
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
