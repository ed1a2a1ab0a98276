"""The rigid cage of a case: body, lines as planned, waves, settings."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import ClassVar, Literal

from moyai.core.errors import InputError
from moyai.core.headline import Criterion
from moyai.core.options import checks_words
from moyai.sea.environment import Environment
from moyai.sea.regular_theory import RegularTheory
from moyai.sea.states import IrregularSea
from moyai.structures.cage.rigid.parts import RigidCage

Analysis = Literal["statics", "time", "sensitivity"]
Equations = Literal["sound", "literal"]
Setting = Literal["pull_down", "pretension", "slack", "length"]


@checks_words
@dataclass(frozen=True)
class RigidLinePlan:
    """A line before its length is known."""

    name: str
    #: x, z from the middle of the cage [m].
    attachment: tuple[float, float]
    #: x of the anchor [m].
    anchor_x: float
    #: Height of the anchor above the bed [m].
    anchor_above_bed: float
    #: What fixes the length, with ``value``: how far the lines pull the cage under [m], tension at rest [N], length
    #: beyond the span of the freely floating cage [m], unstretched length [m]. Lines of ``pull_down`` share one
    #: tension. One of "pull_down", "pretension", "slack", "length".
    setting: Setting
    value: float
    #: Of line and gauge together [N/m]; ``None``: from EA.
    stiffness: float | None
    #: EA [N].
    axial_stiffness: float | None = None
    #: [N/m], rigid when absent.
    gauge_stiffness: float | None = None
    #: [N s/m].
    damping: float = 0.0
    #: [N/m].
    submerged_weight: float = 0.0
    #: [N].
    breaking_load: float | None = None


@checks_words
@dataclass(frozen=True)
class RigidCageWaves:
    """Regular waves along +x (heading 0) or -x (pi): every height with every period, SI."""

    name: str
    heights: tuple[float, ...]
    periods: tuple[float, ...]
    heading: float = 0.0
    theory: RegularTheory = "linear"

    def waves(self) -> tuple[tuple[float, float], ...]:
        """Return every height with every period [m], [s]: all periods of the first height, then those of the next."""
        return tuple((height, period) for height in self.heights for period in self.periods)


CageSea = RigidCageWaves | IrregularSea


@checks_words
@dataclass(frozen=True)
class RigidCageSettings:
    """How a rigid cage is computed."""

    analyses: tuple[Analysis, ...] = ("statics", "time", "sensitivity")
    #: Wave periods that are run.
    periods: int = 40
    #: Last wave periods, that numbers are taken from.
    settled_periods: int = 20
    #: Periods over which the waves grow.
    ramp_periods: float = 5.0
    #: Rows written in a wave period (peak period of irregular seas).
    samples_per_period: int = 100
    stretching: Literal["constant", "wheeler"] = "constant"
    #: Local error of a step.
    tolerance: float = 1e-6
    #: Step of the fourth-order method [s] that takes the place of the adaptive one.
    fixed_step: float | None = None
    #: Of an irregular sea, the first with its own seed; largest values are means over them.
    realisations: int = 5
    #: Multiples of the line stiffness of ``sensitivity`` [-].
    stiffness_factors: tuple[float, ...] = (1.0 / 3.0, 1.0, 10.0 / 3.0, 10.0)
    #: Line stiffnesses of ``sensitivity`` that take the place of the multiples [N/m].
    stiffnesses: tuple[float, ...] = ()

    def __post_init__(self) -> None:
        if self.settled_periods + self.ramp_periods > self.periods:
            raise InputError(
                f"{self.ramp_periods:g} periods of growing waves and {self.settled_periods} settled ones exceed the "
                f"{self.periods} periods of the run",
                parameter="settings.rigid.periods",
                allowed=f"at least {math.ceil(self.settled_periods + self.ramp_periods)}",
            )


@checks_words
@dataclass(frozen=True)
class RigidCageProblem:
    """The whole problem as the case file states it."""

    model: ClassVar[str] = "rigid"

    title: str
    cage: RigidCage
    plans: tuple[RigidLinePlan, ...]
    #: [m2/s].
    kinematic_viscosity: float
    #: Water, levels, current; its sea states are those of ``seas``.
    environment: Environment
    seas: tuple[CageSea, ...] = ()
    #: One of "sound", "literal".
    equations: Equations = "sound"
    settings: RigidCageSettings = field(default_factory=RigidCageSettings)
    case_text: str = ""
    case_hash: str = ""
    criteria: tuple[Criterion, ...] = ()

    def __post_init__(self) -> None:
        if not (math.isfinite(self.kinematic_viscosity) and self.kinematic_viscosity > 0.0):
            raise InputError(
                f"kinematic_viscosity is {self.kinematic_viscosity:g} m2/s",
                parameter="kinematic_viscosity",
                allowed="> 0",
            )
        if self.plans and math.isinf(self.environment.water.depth):
            raise InputError(
                "lines need a bed to be held at", parameter="water_depth", remedy="give the water depth in metres"
            )
        for sea in self.seas:
            if abs(math.sin(sea.heading)) > 1e-9:
                raise InputError(
                    f"the waves of '{sea.name}' travel at {math.degrees(sea.heading):.4g} degrees to +x",
                    parameter="waves.heading",
                    allowed="0 or 180 degrees: the rigid cage moves in the plane of the waves",
                    remedy="turn the x axis, or use 'model: flexible'",
                )
            if getattr(sea, "spreading", None) is not None:
                raise InputError(
                    f"the sea '{sea.name}' has spread directions",
                    parameter="waves.spreading",
                    allowed="long crests: the rigid cage moves in the plane of the waves",
                    remedy="leave 'spreading' out, or use 'model: flexible'",
                )
