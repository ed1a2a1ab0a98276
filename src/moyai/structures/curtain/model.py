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
    """Lines that hold the supports; without them the supports are fixed.

    Parameters
    ----------
    length : float
        Of one line [m].
    slope : float or None
        Angle from the horizontal at the float [rad]; None: straight from the surface to the bed.
    stiffness : float
        K = EA/L of a line [N/m]; NaN where it is not known.
    pretension : float or None
        Steady tension for the anchor loads [N]; None: that of the statics.
    """

    length: float
    slope: float | None
    stiffness: float
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
                path="site.water_depth",
                remedy="give the depth, or 'slope_deg' of the lines",
            )
        if not self.length > depth:
            raise InputError(
                f"an anchor line of {self.length:g} m in water of {depth:g} m",
                path="structure.anchors.line_length",
                allowed=f"more than {depth:g} m",
                remedy="lengthen the line, or give 'slope_deg'",
            )
        return math.asin(depth / self.length)


@dataclass(frozen=True)
class Strengths:
    """What the components bear; :data:`UNJUDGED` where the case says nothing.

    Parameters
    ----------
    upper_cable, lower_cable, sheet, joint, anchor_line, anchor : Strength
        Cables, joint, line, holding force of the anchor [N]; sheet [N/m].
    least_reserve : float
        Share of the buoyancy that must be left [-].
    least_depth : float
        Effective depth that must be kept [m].
    """

    upper_cable: Strength = UNJUDGED
    lower_cable: Strength = UNJUDGED
    sheet: Strength = UNJUDGED
    joint: Strength = UNJUDGED
    anchor_line: Strength = UNJUDGED
    anchor: Strength = UNJUDGED
    least_reserve: float = 0.0
    least_depth: float = 0.0


@checks_words
@dataclass(frozen=True)
class Curtain:
    """One span of a hanging curtain between two supports, its neighbours alike.

    Parameters
    ----------
    span, length : float
        Distance of the supports and unstretched length of curtain between them [m].
    normal : float
        Heading of the downstream normal of the span [rad].
    skirt : Skirt
        Sheet with its toe load.
    toe : {"free", "held"}
        Whether a lower cable as long as the upper one keeps the toe under the top.
    toe_chain : float
        Mass of the toe chain per length [kg/m], for the classes; NaN where the toe is given by its weight.
    floats : FloatLine
        What carries it.
    upper_stiffness, lower_stiffness : float
        EA of the cables [N]; the lower one 0 where there is none.
    drag : DragLaw
        Coefficient with range and blockage.
    law : {"normal_velocity", "uniform_normal", "free_streamline"}
        Load law of the section.
    passing_fraction : float
        Share of the held flow that goes under the toe [-].
    may_lie_on_bed : bool
        Whether the skirt may be longer than the water is deep.
    joint_distance : float
        Length of one curtain unit [m].
    anchors : AnchorLines or None
        None: fixed supports.
    strengths : Strengths
        Of the components.
    curtain_class : str
        Class of the tables that is claimed; empty for none.
    toe_range : tuple of float
        Factors (low, high) on the toe's weight that bound what is known.
    """

    span: float
    length: float
    normal: float
    skirt: Skirt
    toe: Literal["free", "held"]
    toe_chain: float
    floats: FloatLine
    upper_stiffness: float
    lower_stiffness: float
    drag: DragLaw
    law: LoadLaw
    passing_fraction: float
    may_lie_on_bed: bool
    joint_distance: float
    anchors: AnchorLines | None
    strengths: Strengths
    curtain_class: str
    toe_range: tuple[float, float] = (0.9, 1.1)


@checks_words
@dataclass(frozen=True)
class ImpactSettings:
    """How the impact is computed.

    Parameters
    ----------
    start : {"current", "slack_phase"}
        Speed at the taut instant: the current's depth mean (the paper), or that of the drift from release.
    start_speed : float or None
        That speed itself [m/s].
    release_position : float
        Of mid-span when the curtain is let go [m], downstream of the line between the supports.
    draught : float or None
        Of the equivalent flat plate [m]; None: the skirt's length.
    chord : float or None
        Straight distance of the skirt's edges when it becomes taut [m], for models whose skirt stretches; None: that of
        the statics with a held toe, and none with a free one.
    cables : {"sum", "one"}
        Whether EA of model A is the sum of both cables or that of one.
    time_step : float or None
        Of the paper's marching [s]; None: omega dt = 0.01.
    """

    start: Literal["current", "slack_phase"] = "current"
    start_speed: float | None = None
    release_position: float = 0.0
    draught: float | None = None
    chord: float | None = None
    cables: Literal["sum", "one"] = "sum"
    time_step: float | None = None


@checks_words
@dataclass(frozen=True)
class WaveSettings:
    """How slack and taut cycles are computed.

    Parameters
    ----------
    settled_periods, analysed_periods : int
        Periods of regular waves that are left out at least (more until periods repeat), and those analysed at least.
    realisations : int
        Of an irregular sea, with the seeds that follow that of the case; the mean of their largest tensions counts.
    time_step : float or None
        [s]; None: chosen by the program.
    velocity : {"skirt_mean", "surface", "wheeler"}
        Water that moves the curtain.
    slowest : float
        Speed at the taut instant below which a contact does not count as a snap [m/s].
    law : {"weibull", "pareto"}
        Law of the exceedance of snaps in an irregular sea.
    hours : float
        Time that the most probable largest snap is given for [h].
    """

    settled_periods: int = 4
    analysed_periods: int = 20
    time_step: float | None = None
    velocity: SkirtVelocity = "skirt_mean"
    slowest: float = 0.0
    law: SnapLaw = "weibull"
    hours: float = 3.0
    realisations: int = 5


@checks_words
@dataclass(frozen=True)
class AnchorLoadSettings:
    """Anchor loads in waves by the energy model.

    Parameters
    ----------
    energy_factor, float_mass, orbital_factor : float
        M [-], m_B [kg] per anchor rope, alpha [-].
    wire_factor, new_type_factor : float
        Tension of the wire over that of the rope, and of the new type over the conventional one [-].
    height_ratio : float
        H_max over H_1/3 [-].
    rule : {"paper", "normal", "none"}
        Direction rule.
    pretension : bool
        Whether the steady tension counts; the paper leaves it out.
    """

    energy_factor: float
    float_mass: float
    orbital_factor: float = 2.0
    wire_factor: float = 0.6
    new_type_factor: float = 0.7
    height_ratio: float = 1.8
    rule: DirectionRule = "paper"
    pretension: bool = True

    def model(self, rope_stiffness: float, line_factor: float = 1.0) -> EnergyModel:
        """Return the energy model of the anchor rope, or of another member by its factor."""
        return EnergyModel(
            self.energy_factor, self.float_mass, rope_stiffness, self.orbital_factor, line_factor, type_factor=1.0
        )


@dataclass(frozen=True)
class LimitSettings:
    """The operating-limit table.

    Parameters
    ----------
    speeds, heights : tuple of float or None
        Surface speeds [m/s] and significant heights [m] of the table; None: chosen by the program.
    highest_speed, highest_height : float
        Up to which limits are sought [m/s], [m].
    period_factor : float
        T = factor sqrt(H) [s/sqrt(m)] where ``period`` is None.
    period : float or None
        One period for all heights [s].
    wave_angle : float
        Of the waves from the normal [rad].
    impact : bool
        Whether the impact counts, where it was asked for.
    rose_step : float or None
        Step of headings and orientations of the limit rose [rad]; None: no rose.
    """

    speeds: tuple[float, ...] | None = None
    heights: tuple[float, ...] | None = None
    highest_speed: float = 3.0
    highest_height: float = 5.0
    period_factor: float = 3.86
    period: float | None = None
    wave_angle: float = 0.0
    impact: bool = True
    rose_step: float | None = None

    def period_of(self, height: float) -> float:
        """Return the wave period [s] that goes with a significant height [m]."""
        return self.period if self.period is not None else self.period_factor * math.sqrt(height)


@checks_words
@dataclass(frozen=True)
class Settings:
    """Which analyses are run and how."""

    analyses: tuple[Analysis, ...] = ANALYSES
    impact: ImpactSettings = field(default_factory=ImpactSettings)
    waves: WaveSettings = field(default_factory=WaveSettings)
    anchor_loads: AnchorLoadSettings | None = None
    limits: LimitSettings = field(default_factory=LimitSettings)
    dynamic: DynamicSettings | None = None

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
    """A flume record and what was found in it.

    Parameters
    ----------
    file : str
        Where it came from.
    release_time, taut_time, peak_time, plateau_start : float
        [s]; the release may be NaN.
    cables : tuple of RecordedCable
        Each cable.
    total : RecordedCable
        Their sum.
    peak_missed : float
        Largest share of the peak that the sampling may have missed [-].
    time, tension : ndarray
        Record without offset and drift: (n,) [s], (cables, n) [N].
    notices : tuple of Notice
        What makes the numbers doubtful.
    """

    file: str
    release_time: float
    taut_time: float
    peak_time: float
    plateau_start: float
    cables: tuple[RecordedCable, ...]
    total: RecordedCable
    peak_missed: float
    time: NDArray[np.float64]
    tension: NDArray[np.float64]
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
    settings: Settings = field(default_factory=Settings)
    record: RecordedSnap | None = None
    case_text: str = ""
    case_hash: str = ""
    criteria: tuple[Criterion, ...] = ()
