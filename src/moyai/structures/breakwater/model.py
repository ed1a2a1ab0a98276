"""The floating breakwater problem: what the case file says, in SI units and radians, frozen.

Positions on the body are given in the body frame of the section, x from its centre line and z above the keel, so
that they hold for every draught and water level. Anchors are given above the bed. Both become site coordinates only
when a water level is chosen.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Literal

from moyai.core.errors import InputError
from moyai.core.headline import Criterion
from moyai.core.options import checks_words
from moyai.flexible.elements import BarType
from moyai.mooring.lines import Clump, Segment
from moyai.potential.sections import Hull
from moyai.sea.environment import Environment as Environment
from moyai.sea.environment import Wind as Wind
from moyai.sea.states import IrregularSea as IrregularSea
from moyai.sea.states import RegularSea as RegularSea
from moyai.sea.states import SeaState as SeaState
from moyai.structures.breakwater.settings import ANALYSES, MODES, Analysis, BreakwaterSettings, Mode

DEFAULT_REALISATIONS = 5  # the mean of so many maxima is known to about half the scatter of one


@checks_words
@dataclass(frozen=True)
class Damping:
    """Damping beyond wave radiation."""

    #: zeta of P3: C_jj = 2 zeta sqrt((M + mu)_jj (K_H + K_M)_jj).
    fraction_of_critical: float = 0.0
    #: Modes that it is applied to.
    modes: tuple[Mode, ...] = MODES
    #: Additional linear damping, sway [N s/m], heave [N s/m], roll [N m s], of the whole unit.
    linear: tuple[float, float, float] = (0.0, 0.0, 0.0)
    #: Coefficient b2 of b2 |theta'| theta' [N m s2], of the whole unit.
    roll_quadratic: float = 0.0
    #: Whether damping by eddies at the edges is computed from the section (the default of a case file).
    viscous: bool = False
    #: What the computed damping is multiplied with.
    viscous_factor: float = 1.0
    #: Factors on the unit's own damping that transmission and motions are given a band for.
    band: tuple[float, float] = (1.0, 1.0)


@checks_words
@dataclass(frozen=True)
class MooringLine:
    """Identical lines between the bed and the body."""

    name: str
    #: Number of identical lines (they share one computation).
    count: int
    #: x from the centre line, y along the unit, z above the keel [m].
    fairlead: tuple[float, float, float]
    #: x, y from the centre of the unit, z above the bed [m].
    anchor: tuple[float, float, float]
    #: From the anchor to the fairlead.
    segments: tuple[Segment, ...]
    #: Weights or buoys between segments.
    clumps: tuple[Clump, ...] = ()
    #: Coulomb coefficient of the line on the bed.
    bed_friction: float = 0.0
    #: Drag coefficient across the line times its drag diameter [m]; 0 leaves the drag of the line out, of a line in
    #: motion in time it takes that of its segments.
    drag_width: float = 0.0
    #: Whether the line is in motion in the time domain from the start, with drag, inertia and slack.
    dynamic: bool = False
    #: What each segment is made of, for a line in motion; its internal damping is chosen later. Empty where the
    #: segments do not give enough: the line then stays at rest at every instant.
    bar_types: tuple[BarType, ...] = ()
    #: Mass [kg] and volume [m3] of each clump, for a line in motion.
    clump_bodies: tuple[tuple[float, float], ...] = ()

    @property
    def can_move(self) -> bool:
        """Whether enough is known of the line to set it in motion."""
        return bool(self.bar_types) and len(self.bar_types) == len(self.segments)


@dataclass(frozen=True)
class MooringSpring:
    """Identical linear springs between a fixed point and the body (laboratory moorings).

    ``anchor`` is (x, y, z) with z from still water [m]; ``stiffness`` [N/m]; ``pretension`` [N].
    """

    name: str
    count: int
    fairlead: tuple[float, float, float]
    anchor: tuple[float, float, float]
    stiffness: float
    pretension: float


@checks_words
@dataclass(frozen=True)
class CoefficientsFile:
    """Coefficients of a 3-D program in place of the section: program name and path of its file or folder."""

    program: Literal["capytaine", "wamit", "nemoh"]
    path: Path
    options: Mapping[str, Any] = field(default_factory=dict)


@dataclass(frozen=True)
class Breakwater:
    """One floating unit of constant section."""

    #: Section outline, keel to deck.
    hull: Hull
    #: Length along the crest l [m].
    length: float
    #: Roll radius of gyration about the centre of gravity r [m].
    roll_gyradius: float
    #: x from the centre line and z above the keel [m].
    centre_of_gravity: tuple[float, float]
    #: Mass of the unit [kg]; ``None`` when the draught is given instead.
    mass: float | None = None
    #: Draught d [m]; ``None`` when the mass is given instead. Both: the imbalance is reported.
    draught: float | None = None
    damping: Damping = field(default_factory=Damping)
    #: Mass that moves in one mode only (rigs of model tests): sway, heave [kg], roll [kg m2].
    additional_mass: tuple[float, float, float] = (0.0, 0.0, 0.0)
    #: On the area above water [-]; needed where there is wind.
    wind_drag_coefficient: float | None = None
    #: On the area below water [-]; needed where there is current.
    current_drag_coefficient: float | None = None
    #: Damping lid of the gaps between pontoons, fraction epsilon in K (1 + i epsilon).
    gap_damping_lid: float = 0.0
    lines: tuple[MooringLine | MooringSpring, ...] = ()
    coefficients_file: CoefficientsFile | None = None

    def __post_init__(self) -> None:
        if self.mass is None and self.draught is None:
            raise InputError("neither mass nor draught is given", parameter="draught", remedy="give one of them")


@dataclass(frozen=True)
class MeasuredPoints:
    """Measured points to show with the results: one record per column name."""

    file: str
    columns: Mapping[str, tuple[float, ...]]


@checks_words
@dataclass(frozen=True)
class BreakwaterProblem:
    """The whole problem as the case file states it."""

    title: str
    breakwater: Breakwater
    environment: Environment
    analyses: tuple[Analysis, ...] = ANALYSES
    settings: BreakwaterSettings = field(default_factory=BreakwaterSettings)
    measured: MeasuredPoints | None = None
    #: Water level that is run alone, for a draft; all of them where it is empty.
    only_level: str = ""
    #: For a draft: coefficients of the nearest round draught and heel, without the second way to the drift.
    nominal: bool = False
    #: Whether response operators are computed; a draft that shows none leaves them out.
    operators: bool = True
    case_text: str = ""
    case_hash: str = ""
    criteria: tuple[Criterion, ...] = ()
