"""The curtain problem: what the case file says, in SI units and radians, frozen.

Axes of the site; the span lies across ``normal``, downstream of which the curtain bulges. What depends on the
water level is worked out in :mod:`moyai.structures.curtain.assembly`.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from moyai.core.errors import InputError
from moyai.core.headline import Criterion
from moyai.core.options import checks_words
from moyai.core.validity import Notice
from moyai.sea.environment import Environment
from moyai.series.snap_statistics import SnapLaw
from moyai.structures.curtain.dynamic.runs import DynamicSettings
from moyai.structures.curtain.limits.utilisation import Strength
from moyai.structures.curtain.seas.anchor_energy import EnergyModel
from moyai.structures.curtain.seas.squared_velocity import DirectionRule
from moyai.structures.curtain.snaps.flow import SkirtVelocity
from moyai.structures.curtain.statics.drag import DragLaw
from moyai.structures.curtain.statics.hanging import FloatLine
from moyai.structures.curtain.statics.section import LoadLaw, Skirt

Analysis = Literal["statics", "impact", "waves", "anchor_loads", "limits", "dynamic"]
ANALYSES: tuple[Analysis, ...] = ("statics", "impact", "waves", "anchor_loads", "limits")
COMPONENTS = ("upper cable", "lower cable", "skirt", "joint", "float", "anchor line", "anchor")
#: What is not known to have a strength is never judged
UNJUDGED = Strength(math.inf, 1.0)


@dataclass(frozen=True)
class AnchorLines:
    """Lines that hold the supports; without them the supports are fixed."""

    #: Of one line [m].
    length: float
    #: Angle from the horizontal at the float [rad]; None: straight from the surface to the bed.
    slope: float | None
    #: K = EA/L of a line [N/m]; NaN where it is not known.
    stiffness: float
    #: Steady tension for the anchor loads [N]; None: that of the statics.
    pretension: float | None = None

    def slope_in(self, depth: float) -> float:
        """Return the angle from the horizontal [rad] in a depth [m].

        Raises
        ------
        InputError
            When the line does not reach the bed.
        """
        if self.slope is not None:
            return self.slope
        if math.isinf(depth):
            raise InputError(
                "anchor lines in water of infinite depth reach no bed",
                parameter="water_depth",
                remedy="give the depth, or the slope of the lines",
            )
        if not self.length > depth:
            raise InputError(
                f"an anchor line of {self.length:g} m in water of {depth:g} m",
                parameter="anchors.length",
                allowed=f"more than {depth:g} m",
                remedy="lengthen the line, or give its slope",
            )
        return math.asin(depth / self.length)


@dataclass(frozen=True)
class Strengths:
    """What the components carry; :data:`UNJUDGED` where the case says nothing."""

    #: Of the upper cable [N].
    upper_cable: Strength = UNJUDGED
    #: Of the lower cable [N].
    lower_cable: Strength = UNJUDGED
    #: Of the sheet [N/m].
    sheet: Strength = UNJUDGED
    #: Of the joint [N].
    joint: Strength = UNJUDGED
    #: Of the anchor line [N].
    anchor_line: Strength = UNJUDGED
    #: Holding force of the anchor [N].
    anchor: Strength = UNJUDGED
    #: Share of the buoyancy that must be left [-].
    least_reserve: float = 0.0
    #: Effective depth that must be kept [m].
    least_depth: float = 0.0


@checks_words
@dataclass(frozen=True)
class Curtain:
    """One span of a hanging curtain between two supports, its neighbours alike."""

    #: Distance of the supports [m].
    span: float
    #: Unstretched length of curtain between the supports [m].
    length: float
    #: Heading of the downstream normal of the span [rad].
    normal: float
    #: Sheet with its toe load.
    skirt: Skirt
    #: Whether a lower cable as long as the upper one keeps the toe under the top.
    toe: Literal["free", "held"]
    #: Mass of the toe chain per length [kg/m], for the classes; NaN where the toe is given by its weight.
    toe_chain: float
    #: What carries it.
    floats: FloatLine
    #: EA of the upper cable [N].
    upper_stiffness: float
    #: EA of the lower cable [N]; 0 where there is none.
    lower_stiffness: float
    #: Coefficient with range and blockage.
    drag: DragLaw
    #: Load law of the section; one of "normal_velocity", "uniform_normal", "free_streamline".
    law: LoadLaw
    #: Share of the held flow that goes under the toe [-].
    passing_fraction: float
    #: Whether the skirt may be longer than the water is deep.
    may_lie_on_bed: bool
    #: Length of one curtain unit [m].
    joint_distance: float
    #: None: fixed supports.
    anchors: AnchorLines | None
    #: Of the components.
    strengths: Strengths
    #: Class of the tables that is claimed; empty for none.
    curtain_class: str
    #: Factors (low, high) on the toe's weight that bound what is known.
    toe_range: tuple[float, float] = (0.9, 1.1)


@checks_words
@dataclass(frozen=True)
class ImpactSettings:
    """How the impact is computed."""

    #: Speed at the taut instant: the current's depth mean (the paper), or that of the drift from release.
    start: Literal["current", "slack_phase"] = "current"
    #: That speed itself [m/s].
    start_speed: float | None = None
    #: Of mid-span when the curtain is let go [m], downstream of the line between the supports; None: not known, taken
    #: on that line, and the band reaches to a curtain that drifts with the current.
    release_position: float | None = None
    #: Of the equivalent flat plate [m]; None: the skirt's length.
    draught: float | None = None
    #: Straight distance of the skirt's edges when it becomes taut [m], for models whose skirt stretches; None: that of
    #: the statics with a held toe, and none with a free one.
    chord: float | None = None
    #: Whether EA of model A is the sum of both cables or that of one.
    cables: Literal["sum", "one"] = "sum"
    #: Of the paper's marching [s]; None: omega dt = 0.01.
    time_step: float | None = None


@checks_words
@dataclass(frozen=True)
class WaveSettings:
    """How slack and taut cycles are computed."""

    #: Periods of regular waves that are left out at least; more until periods repeat.
    settled_periods: int = 4
    #: Periods of regular waves that are analysed at least.
    analysed_periods: int = 20
    #: [s]; None: chosen by the program.
    time_step: float | None = None
    #: Water that moves the curtain; one of "skirt_mean", "surface", "wheeler".
    velocity: SkirtVelocity = "skirt_mean"
    #: Speed at the taut instant below which a contact does not count as a snap [m/s].
    slowest: float = 0.0
    #: Law of the exceedance of snaps in an irregular sea; one of "weibull", "pareto".
    law: SnapLaw = "weibull"
    #: Time that the most probable largest snap is given for [h].
    hours: float = 3.0
    #: Of an irregular sea, with the seeds that follow that of the case; the mean of their largest tensions counts.
    realisations: int = 5


@checks_words
@dataclass(frozen=True)
class AnchorLoadSettings:
    """Anchor loads in waves by the energy model."""

    #: M [-].
    energy_factor: float
    #: m_B [kg] per anchor rope.
    float_mass: float
    #: Alpha [-].
    orbital_factor: float = 2.0
    #: Tension of the wire over that of the rope [-].
    wire_factor: float = 0.6
    #: Tension of the new type over that of the conventional one [-].
    new_type_factor: float = 0.7
    #: H_max over H_1/3 [-].
    height_ratio: float = 1.8
    #: Direction rule; one of "paper", "normal", "none".
    rule: DirectionRule = "paper"
    #: Whether the steady tension is included; the paper leaves it out.
    pretension: bool = True

    def model(self, rope_stiffness: float, line_factor: float = 1.0) -> EnergyModel:
        """Return the energy model of the anchor rope, or of another member by its factor."""
        return EnergyModel(
            self.energy_factor, self.float_mass, rope_stiffness, self.orbital_factor, line_factor, type_factor=1.0
        )


@checks_words
@dataclass(frozen=True)
class LimitSettings:
    """The operating-limit table."""

    #: Surface speeds of the table [m/s]; None: chosen by the program.
    speeds: tuple[float, ...] | None = None
    #: Significant heights of the table [m]; None: chosen by the program.
    heights: tuple[float, ...] | None = None
    #: Up to which limits are sought [m/s].
    highest_speed: float = 3.0
    #: Up to which limits are sought [m].
    highest_height: float = 5.0
    #: T = factor sqrt(H) [s/sqrt(m)] where ``period`` is None.
    period_factor: float = 3.86
    #: One period for all heights [s].
    period: float | None = None
    #: Of the waves from the normal [rad].
    wave_angle: float = 0.0
    #: Whether the impact counts, where it was asked for.
    impact: bool = True
    #: Step of headings and orientations of the limit rose [rad]; None: no rose.
    rose_step: float | None = None

    def period_of(self, height: float) -> float:
        """Return the wave period [s] that goes with a significant height [m]."""
        return self.period if self.period is not None else self.period_factor * math.sqrt(height)


@checks_words
@dataclass(frozen=True)
class CurtainSettings:
    """Which analyses are run and how."""

    analyses: tuple[Analysis, ...] = ANALYSES
    impact: ImpactSettings = field(default_factory=ImpactSettings)
    waves: WaveSettings = field(default_factory=WaveSettings)
    anchor_loads: AnchorLoadSettings | None = None
    limits: LimitSettings = field(default_factory=LimitSettings)
    dynamic: DynamicSettings | None = None
    #: Leave out what only gives how far the statics vary: ends of the drag, band of the steady load, largest spacing.
    nominal: bool = False

    @property
    def direction(self) -> tuple[DirectionRule, float]:
        """Direction rule and H_max/H_1/3 in use; those of the paper where the anchor loads say nothing."""
        given = self.anchor_loads
        return ("paper", 1.8) if given is None else (given.rule, given.height_ratio)


@dataclass(frozen=True)
class RecordedCable:
    """Peak, plateau and noise [N] of one cable of a record, or of their sum, above the unloaded level."""

    name: str
    peak: float
    plateau: float
    noise: float

    @property
    def impact(self) -> float:
        """Peak above the plateau [N]."""
        return self.peak - self.plateau


@dataclass(frozen=True, eq=False)
class RecordedSnap:
    """A flume record and what was found in it."""

    #: Where it came from.
    file: str
    #: Release [s]; may be NaN.
    release_time: float
    #: When the cables become taut [s].
    taut_time: float
    #: When the tension is largest [s].
    peak_time: float
    #: Start of the plateau [s].
    plateau_start: float
    #: Each cable.
    cables: tuple[RecordedCable, ...]
    #: Their sum.
    total: RecordedCable
    #: Largest share of the peak that the sampling may have missed [-].
    peak_missed: float
    #: Record without offset and drift: (n,) [s].
    time: NDArray[np.float64]
    #: (cables, n) [N].
    tension: NDArray[np.float64]
    #: What makes the numbers doubtful.
    notices: tuple[Notice, ...]

    @property
    def rise_time(self) -> float:
        """From taut to peak [s]."""
        return self.peak_time - self.taut_time


@dataclass(frozen=True)
class CurtainProblem:
    """The whole problem as the case file states it."""

    title: str
    curtain: Curtain
    environment: Environment
    settings: CurtainSettings = field(default_factory=CurtainSettings)
    record: RecordedSnap | None = None
    case_text: str = ""
    case_hash: str = ""
    criteria: tuple[Criterion, ...] = ()
