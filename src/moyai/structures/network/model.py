"""A network as a case states it: points, lines and nets with z above datum, seas, settings."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Literal

from moyai.core.errors import InputError
from moyai.core.headline import Criterion
from moyai.core.options import checks_words
from moyai.flexible.bed import Bed, Ground
from moyai.flexible.elements import BOX, BarType
from moyai.flexible.failures import LineFailure
from moyai.flexible.motion import Beginning, Motion
from moyai.sea.current_field import CurrentField
from moyai.sea.environment import Environment
from moyai.sea.kinematics import Stretching
from moyai.sea.water import Water
from moyai.structures.network.body_plan import BodyPlan

Analysis = Literal["statics", "modes", "dynamic"]
Place = tuple[float, float, float]
Start = Literal["rest", "rest_in_current", "as_built"]


@dataclass(frozen=True)
class Attached:
    """What a point carries."""

    #: [kg].
    mass: float = 0.0
    #: [m3].
    volume: float = 0.0
    #: Vertical extent for partial immersion [m]; 0: always wet.
    height: float = 0.0
    #: ``BOX`` or ``SPHERE``.
    form: int = BOX
    #: Drag coefficient times area [m2].
    drag_area: float = 0.0
    #: On the volume [-].
    added_mass_coefficient: float = 0.0
    #: With the bed [m2].
    contact_area: float = 0.0


@checks_words
@dataclass(frozen=True)
class PointPlan:
    """A named point."""

    name: str
    kind: Literal["fixed", "driven", "free"]
    #: z above datum, or above still water [m]; NaN: on the bed.
    position: Place
    #: Name of the motion of a driven point, empty: held still.
    motion: str = ""
    #: Whether z counts from the still water of each water level.
    floats: bool = False
    attached: Attached = field(default_factory=Attached)
    #: Components that do not move.
    held: tuple[bool, bool, bool] = (False, False, False)
    #: For drawing [m].
    diameter: float = 0.0


@dataclass(frozen=True)
class PartPlan:
    """A length of one material [m], in a number of bars."""

    bar_type: BarType
    length: float
    segments: int
    #: NaN where not known [N].
    breaking_load: float = math.nan


@dataclass(frozen=True)
class RowPlan:
    """Equal bodies spread evenly along a line."""

    count: int
    attached: Attached


@checks_words
@dataclass(frozen=True)
class LinePlan:
    """A line between two points: parts from start to end, with bodies between (one shorter) and along it."""

    name: str
    start: str
    end: str
    parts: tuple[PartPlan, ...]
    #: What hangs between part k and part k + 1.
    between: tuple[Attached | None, ...] = ()
    along: tuple[RowPlan, ...] = ()
    shape: Literal["catenary", "straight"] = "catenary"
    #: Factor on the water velocity.
    flow_factor: float = 1.0
    #: Least of its parts, NaN where not known [N].
    breaking_load: float = math.nan

    @property
    def length(self) -> float:
        """Unstretched length [m]."""
        return sum(part.length for part in self.parts)

    @property
    def strengths(self) -> dict[str, float]:
        """Breaking loads [N] of what is judged by itself: the line, or each of its parts where they differ.

        Of parts whose breaking load is not known there is none.
        """
        own = [part.breaking_load for part in self.parts]
        if math.isfinite(self.breaking_load) and (len(own) < 2 or min(own) == max(own)):
            return {self.name: self.breaking_load}
        return {f"{self.name} part {n}": load for n, load in enumerate(own, start=1) if math.isfinite(load)}

    @property
    def without_strength(self) -> list[str]:
        """What has no breaking load: the line, or some of its parts."""
        known = self.strengths
        if not known or self.name in known:
            return [] if known else [self.name]
        return [name for n in range(len(self.parts)) if (name := f"{self.name} part {n + 1}") not in known]


@checks_words
@dataclass(frozen=True)
class NetPlan:
    """A net between four corners."""

    name: str
    #: Once around: start and end of the first row, end and start of the last.
    corners: tuple[Place, Place, Place, Place]
    #: Rows of knots.
    rows: int
    #: Columns of knots.
    columns: int
    #: Materials of inner and edge bars of the rows.
    along: tuple[BarType, BarType]
    #: Materials of inner and edge bars of the columns.
    across: tuple[BarType, BarType]
    #: Distance of the knots at the start over their unstretched distance [-].
    hanging_ratio: float = 1.0
    first_row: Literal["fixed", "driven", "free"] = "fixed"
    #: Of a driven first row, empty: held still.
    motion: str = ""
    #: Submerged mass per length of the last row [kg/m].
    ballast: float = 0.0
    flow_factor: float = 1.0
    #: Whether z counts from still water.
    floats: bool = False
    #: Width of netting whose twines an inner bar of a row and of a column gathers [m]; None: each bar is a rope.
    strips: tuple[float, float] | None = None


@checks_words
@dataclass(frozen=True)
class SheetPlan:
    """A sheet between four corners, as :class:`NetPlan`; warp runs from row to row, weft along the rows."""

    name: str
    corners: tuple[Place, Place, Place, Place]
    rows: int
    columns: int
    #: Arguments of :class:`moyai.flexible.sheets.Sheets`.
    properties: Mapping[str, float]
    #: Unstretched length over the distance of the corners [-].
    fullness: float = 1.0
    #: Hold of the first row, as in :class:`NetPlan`.
    first_row: Literal["fixed", "driven", "free"] = "free"
    #: Motion of that row, as in :class:`NetPlan`.
    motion: str = ""
    #: Whether it floats, as in :class:`NetPlan`.
    floats: bool = False


@dataclass(frozen=True)
class BedPlan:
    """Stiffness [Pa/m], damping [Pa s/m] and friction [-] of the bed."""

    stiffness: float
    damping: float
    friction: float = 0.0
    #: Its heights above datum, where it varies.
    ground: Ground | None = None

    def at(self, level: float, water: Water) -> Bed:
        """Return the bed in heights above still water that stands at ``level`` above datum [m]."""
        if self.ground is None:
            return Bed(-water.depth, self.stiffness, self.damping, self.friction)
        ground = Ground(self.ground.x, self.ground.y, self.ground.level - level)
        return Bed.on(ground, self.stiffness, self.damping, self.friction)


@checks_words
@dataclass(frozen=True, eq=False)
class MotionPlan:
    """A prescribed motion: its table, made for any duration, its typical period [s] and its last time [s].

    ``ramp`` is the time over which it grows from nothing [s]; ``None``: one mean period where it begins with a jerk.
    """

    name: str
    kind: Literal["harmonic", "circular", "table"]
    period: float
    end: float
    amplitude: Place = (0.0, 0.0, 0.0)
    phase: Place = (0.0, 0.0, 0.0)
    ramp: float | None = 0.0
    table: Motion | None = None

    def over(self, duration: float) -> Motion:
        """Return the motion over a run, grown from nothing where it has a ramp.

        Raises
        ------
        InputError
            When a table ends before the run does.
        """
        given, growth = self._given(duration), self.growth(duration)
        return given if self.table is None or growth == 0.0 else given.grown(growth)

    def beginning(self, duration: float) -> Beginning:
        """Return how a run over a duration begins, before a table is grown."""
        if self.table is None:  # each period is like the others
            duration = min(duration, 3.0 * self.period + (self.ramp or 0.0))
        return self._given(duration).beginning(duration)

    def growth(self, duration: float) -> float:
        """Return the time over which the motion grows from nothing [s]."""
        if self.ramp is not None:
            return self.ramp
        period = self.beginning(duration).period
        return 0.0 if math.isnan(period) else min(period, 0.5 * duration)

    def _given(self, duration: float) -> Motion:
        """Return the motion over a run as it was given.

        Raises
        ------
        InputError
            When a table ends before the run does.
        """
        if self.table is None:
            return Motion.harmonic(
                self.amplitude, self.period, duration=duration, ramp=self.ramp or 0.0, phase=self.phase
            )
        if self.table.start > 1e-9 or self.table.end < duration * (1.0 - 1e-9):
            raise InputError(
                f"the motion '{self.name}' covers {self.table.start:g} to {self.table.end:g} s, the run 0 to "
                f"{duration:g} s",
                parameter=f"motions.{self.name}",
                allowed="a table over the whole run",
                remedy="let its times begin at 0 s"
                if self.table.start > 1e-9
                else f"lengthen the table, or set the duration of the run to {self.table.end:g} s at most",
            )
        return self.table


@checks_words
@dataclass(frozen=True)
class NetworkSettings:
    """How the analyses are run; ``None`` means chosen by the program. See docs/case_file/network.md for each."""

    analyses: tuple[Analysis, ...] = ("statics",)
    duration: float | None = None
    output_step: float | None = None
    ramp: float | None = None
    start: Start | None = None
    resume: Path | None = None
    method: Literal["auto", "explicit", "tr_bdf2", "esdirk4"] = "auto"
    step: float | None = None
    wave_front: bool = False
    tolerance: float = 1e-4
    stretching: Stretching = "wheeler"
    skip: float | None = None
    sensitivity: bool = False
    mesh_check: Literal["auto", "off"] = "auto"
    peak_goal: float = 0.05
    realisations: int | None = None
    slack_level: float = 0.0
    snap_threshold: float | None = None
    modes: int = 6
    stiffness_step: float | None = None


@dataclass(frozen=True, eq=False)
class NetworkProblem:
    """The whole problem as the case file states it."""

    title: str
    points: tuple[PointPlan, ...]
    lines: tuple[LinePlan, ...]
    nets: tuple[NetPlan, ...]
    bed: BedPlan | None
    motions: Mapping[str, MotionPlan]
    #: Water, levels, seas, current.
    environment: Environment
    settings: NetworkSettings = field(default_factory=NetworkSettings)
    bodies: tuple[BodyPlan, ...] = ()
    sheets: tuple[SheetPlan, ...] = ()
    case_text: str = ""
    case_hash: str = ""
    criteria: tuple[Criterion, ...] = ()
    #: Lines that part in runs through time.
    failures: tuple[LineFailure, ...] = ()
    #: A current that changes with time, in runs through time.
    current_field: CurrentField | None = None

    @property
    def start(self) -> Start:
        """Where runs begin: as asked for, else at rest in the current where there is one."""
        default: Start = "rest" if self.environment.current is None else "rest_in_current"
        return self.settings.start or default

    @property
    def strengths(self) -> dict[str, float]:
        """Breaking loads [N] by line, or by part where those of a line differ."""
        return {name: load for line in self.lines for name, load in line.strengths.items()}

    @property
    def gathers_twines(self) -> bool:
        """Whether bars of a net stand for strips of netting."""
        return any(net.strips is not None for net in self.nets)

    @property
    def linear_waves_only(self) -> bool:
        """Whether a body has coefficients of a program, which answer linear waves."""
        return any(body.coefficients is not None or body.loads is not None for body in self.bodies)


#: Name of the motion of driven points that are held still.
STILL = "held still"
