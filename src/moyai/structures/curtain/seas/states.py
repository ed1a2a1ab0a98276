"""What the sea states of a case mean for a curtain: height, period and angle of the waves that load it."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from moyai.core.options import checks_words
from moyai.sea.spectra import goda_peak_period
from moyai.sea.states import IrregularSea, RegularSea, SeaState
from moyai.structures.curtain.seas.squared_velocity import DirectionRule, effective_height


@dataclass(frozen=True)
class DesignWave:
    """One wave that a sea state stands for."""

    #: Of the sea state, with the period where it has several.
    name: str
    #: H_1/3 of an irregular sea, the height of a regular one [m].
    significant_height: float
    #: T_1/3 or the regular period [s].
    period: float
    #: Direction of travel from the normal of the span [rad].
    angle: float
    #: Whether the highest wave of the sea counts, ratio times H_1/3.
    irregular: bool

    @checks_words
    def effective_height(self, rule: DirectionRule, height_ratio: float) -> float:
        """Return the height that acts on the curtain [m]: of the highest wave of an irregular sea."""
        ratio = height_ratio if self.irregular else 1.0
        return float(effective_height(self.significant_height, self.angle, rule, ratio))


def significant_period(sea: IrregularSea) -> float:
    """Return T_1/3 [s] of an irregular sea: as given, or from the peak period by Goda's relation."""
    known = sea.spectrum.parameters
    if "significant_period" in known:
        return float(known["significant_period"])
    gamma = float(known.get("peak_enhancement", 3.3))
    return sea.spectrum.peak_period / goda_peak_period(1.0, gamma)


def design_waves(sea: SeaState, normal: float) -> tuple[DesignWave, ...]:
    """Return the waves that a sea state stands for: one a regular period, one an irregular sea.

    Parameters
    ----------
    sea : RegularSea or IrregularSea
    normal : float
        Heading of the downstream normal of the span [rad].
    """
    angle = math.remainder(sea.heading - normal, 2.0 * math.pi)
    if isinstance(sea, IrregularSea):
        height = significant_height(sea)
        return (DesignWave(sea.name, height, significant_period(sea), angle, True),)
    several = len(sea.periods) > 1
    return tuple(
        DesignWave(f"{sea.name}, {period:g} s" if several else sea.name, sea.height, period, angle, False)
        for period in sea.periods
    )


def significant_height(sea: SeaState) -> float:
    """Return the significant height [m], of regular waves their height."""
    if isinstance(sea, RegularSea):
        return sea.height
    # H_1/3 of a spectrum made from it differs a little from 4 sqrt(m0)
    return float(sea.spectrum.parameters.get("significant_height", sea.spectrum.significant_height))


def longest_sea(seas: Sequence[SeaState]) -> float | None:
    """Return the duration of the longest irregular sea [s]; None without one."""
    return max((sea.duration for sea in seas if isinstance(sea, IrregularSea)), default=None)
