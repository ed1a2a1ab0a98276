"""The rigid cage of a case: body, lines as planned, waves, settings."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import ClassVar, Literal

from moyai.core.errors import InputError
from moyai.core.headline import Criterion
from moyai.core.options import checks_words
from moyai.sea.environment import Environment
from moyai.sea.states import IrregularSea
from moyai.structures.cage.rigid.parts import RigidCage

Analysis = Literal["statics", "time", "sensitivity"]
Equations = Literal["sound", "literal"]
Setting = Literal["pull_down", "pretension", "slack", "length"]


@checks_words
@dataclass(frozen=True)
class LinePlan:
    """A line before its length is known.

    Parameters
    ----------
    name : str
    attachment : tuple of float
        x, z from the middle of the cage [m].
    anchor_x, anchor_above_bed : float
        [m].
    setting : {"pull_down", "pretension", "slack", "length"}
        What fixes the length, with ``value``: how far the lines pull the cage under [m], tension at rest [N], length
        beyond the span of the freely floating cage [m], unstretched length [m]. Lines of ``pull_down`` share one
        tension.
    value : float
    stiffness : float or None
        Of line and gauge together [N/m]; ``None``: from EA.
    axial_stiffness, gauge_stiffness : float or None
        EA [N]; [N/m], rigid when absent.
    damping, submerged_weight : float
        [N s/m], [N/m].
    breaking_load : float or None
        [N].
    """

    name: str
    attachment: tuple[float, float]
    anchor_x: float
    anchor_above_bed: float
    setting: Setting
    value: float
    stiffness: float | None
    axial_stiffness: float | None = None
    gauge_stiffness: float | None = None
    damping: float = 0.0
    submerged_weight: float = 0.0
    breaking_load: float | None = None


@dataclass(frozen=True)
class RegularWaves:
    """Regular waves along +x (heading 0) or -x (pi): every height with every period, SI."""

    name: str
    heights: tuple[float, ...]
    periods: tuple[float, ...]
    heading: float = 0.0

    def waves(self) -> tuple[tuple[float, float], ...]:
        """Return every height with every period."""
        return tuple((height, period) for height in self.heights for period in self.periods)


CageSea = RegularWaves | IrregularSea


@checks_words
@dataclass(frozen=True)
class Settings:
    """How a rigid cage is computed.

    Parameters
    ----------
    analyses : tuple of str
    periods, settled_periods : int
        Wave periods that are run, and the last ones that numbers are taken from.
    ramp_periods : float
        Periods over which the waves grow.
    samples_per_period : int
        Rows written in a wave period (peak period of irregular seas).
    stretching : {"constant", "wheeler"}
    tolerance : float
        Local error of a step.
    fixed_step : float or None
        Step of the fourth-order method [s] that takes the place of the adaptive one.
    stiffness_factors, stiffnesses : tuple of float
        Line stiffnesses of ``sensitivity``: multiples, or values [N/m] that take their place.
    """

    analyses: tuple[Analysis, ...] = ("statics", "time", "sensitivity")
    periods: int = 40
    settled_periods: int = 20
    ramp_periods: float = 5.0
    samples_per_period: int = 100
    stretching: Literal["constant", "wheeler"] = "constant"
    tolerance: float = 1e-6
    fixed_step: float | None = None
    stiffness_factors: tuple[float, ...] = (1.0 / 3.0, 1.0, 10.0 / 3.0, 10.0)
    stiffnesses: tuple[float, ...] = ()

    def __post_init__(self) -> None:
        if self.settled_periods + self.ramp_periods > self.periods:
            raise InputError(
                f"{self.ramp_periods:g} periods of growing waves and {self.settled_periods} settled ones exceed the "
                f"{self.periods} periods of the run",
                path="settings.rigid.periods",
                allowed=f"at least {math.ceil(self.settled_periods + self.ramp_periods)}",
            )


@checks_words
@dataclass(frozen=True)
class RigidCageProblem:
    """The whole problem as the case file states it.

    Parameters
    ----------
    title : str
    cage : RigidCage
    plans : tuple of LinePlan
    kinematic_viscosity : float
        [m2/s].
    environment : Environment
        Water, levels, current; its sea states are those of ``seas``.
    seas : tuple
    equations : {"sound", "literal"}
    settings : Settings
    """

    model: ClassVar[str] = "rigid"

    title: str
    cage: RigidCage
    plans: tuple[LinePlan, ...]
    kinematic_viscosity: float
    environment: Environment
    seas: tuple[CageSea, ...] = ()
    equations: Equations = "sound"
    settings: Settings = field(default_factory=Settings)
    case_text: str = ""
    case_hash: str = ""
    criteria: tuple[Criterion, ...] = ()

    def __post_init__(self) -> None:
        if not (math.isfinite(self.kinematic_viscosity) and self.kinematic_viscosity > 0.0):
            raise InputError(
                f"kinematic_viscosity is {self.kinematic_viscosity:g} m2/s", path="kinematic_viscosity", allowed="> 0"
            )
        if self.plans and math.isinf(self.environment.water.depth):
            raise InputError(
                "lines need a bed to be held at", path="site.water_depth", remedy="give the water depth in metres"
            )
        for sea in self.seas:
            if abs(math.sin(sea.heading)) > 1e-9:
                raise InputError(
                    f"the waves of '{sea.name}' travel at {math.degrees(sea.heading):.4g} degrees to +x",
                    path="waves.heading_deg",
                    allowed="0 or 180 degrees: the rigid cage moves in the plane of the waves",
                    remedy="turn the x axis, or use 'model: flexible'",
                )
            if getattr(sea, "spreading", None) is not None:
                raise InputError(
                    f"the sea '{sea.name}' has spread directions",
                    path="waves.spreading",
                    allowed="long crests: the rigid cage moves in the plane of the waves",
                    remedy="leave 'spreading' out, or use 'model: flexible'",
                )
