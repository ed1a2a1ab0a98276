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

import numpy as np

from moyai.core.errors import InputError
from moyai.core.headline import Criterion
from moyai.core.options import checks_words
from moyai.flexible.network import BarType
from moyai.mooring.lines import Clump, Segment
from moyai.potential.sections import Hull
from moyai.sea.environment import Environment as Environment
from moyai.sea.environment import Wind as Wind
from moyai.sea.states import IrregularSea as IrregularSea
from moyai.sea.states import RegularSea as RegularSea
from moyai.sea.states import SeaState as SeaState

Mode = Literal["sway", "heave", "roll"]
MODES: tuple[Mode, ...] = ("sway", "heave", "roll")
DriftLaw = Literal["auto", "ramped", "pulsating", "newman", "none"]
LineMode = Literal["auto", "quasi_static", "dynamic"]

DEFAULT_REALISATIONS = 5  # the mean of so many maxima is known to about half the scatter of one


@checks_words
@dataclass(frozen=True)
class Damping:
    """Damping beyond wave radiation.

    Parameters
    ----------
    fraction_of_critical : float
        zeta of P3: C_jj = 2 zeta sqrt((M + mu)_jj (K_H + K_M)_jj).
    modes : tuple of str
        Modes that it is applied to.
    linear : tuple of three float
        Additional linear damping, sway [N s/m], heave [N s/m], roll [N m s], of the whole unit.
    roll_quadratic : float
        Coefficient b2 of b2 |theta'| theta' [N m s2], of the whole unit.
    viscous : bool
        Whether damping by eddies at the edges is computed from the section (the default of a case file).
    viscous_factor : float
        What the computed damping is multiplied with.
    band : tuple of two float
        Factors on the unit's own damping that transmission and motions are given a band for.
    """

    fraction_of_critical: float = 0.0
    modes: tuple[Mode, ...] = MODES
    linear: tuple[float, float, float] = (0.0, 0.0, 0.0)
    roll_quadratic: float = 0.0
    viscous: bool = False
    viscous_factor: float = 1.0
    band: tuple[float, float] = (1.0, 1.0)


@dataclass(frozen=True)
class MooringLine:
    """Identical lines between the bed and the body.

    Parameters
    ----------
    name : str
    count : int
        Number of identical lines (they share one computation).
    fairlead : tuple of three float
        x from the centre line, y along the unit, z above the keel [m].
    anchor : tuple of three float
        x, y from the centre of the unit, z above the bed [m].
    segments : tuple of Segment
        From the anchor to the fairlead.
    clumps : tuple of Clump
        Weights or buoys between segments.
    bed_friction : float
        Coulomb coefficient of the line on the bed.
    drag_width : float
        Drag coefficient across the line times its drag diameter [m]; 0 leaves the drag of the line out, of a line in
        motion in time it takes that of its segments.
    dynamic : bool
        Whether the line is in motion in the time domain from the start, with drag, inertia and slack.
    bar_types : tuple of BarType
        What each segment is made of, for a line in motion; its internal damping is chosen later. Empty where the
        segments do not tell enough: the line then stays at rest at every instant.
    clump_bodies : tuple of (float, float)
        Mass [kg] and volume [m3] of each clump, for a line in motion.
    """

    name: str
    count: int
    fairlead: tuple[float, float, float]
    anchor: tuple[float, float, float]
    segments: tuple[Segment, ...]
    clumps: tuple[Clump, ...] = ()
    bed_friction: float = 0.0
    drag_width: float = 0.0
    dynamic: bool = False
    bar_types: tuple[BarType, ...] = ()
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
    """One floating unit of constant section.

    Parameters
    ----------
    hull : Hull
        Section outline, keel to deck.
    length : float
        Length along the crest l [m].
    roll_gyradius : float
        Roll radius of gyration about the centre of gravity r [m].
    centre_of_gravity : tuple of two float
        x from the centre line and z above the keel [m].
    mass : float or None
        Mass of the unit [kg]; ``None`` when the draught is given instead.
    draught : float or None
        Draught d [m]; ``None`` when the mass is given instead. Both: the imbalance is reported.
    additional_mass : tuple of three float
        Mass that moves in one mode only (rigs of model tests): sway, heave [kg], roll [kg m2].
    wind_drag_coefficient, current_drag_coefficient : float or None
        On the area above and below water; needed where there is wind or current.
    gap_damping_lid : float
        Damping lid of the gaps between pontoons, fraction epsilon in K (1 + i epsilon).
    """

    hull: Hull
    length: float
    roll_gyradius: float
    centre_of_gravity: tuple[float, float]
    mass: float | None = None
    draught: float | None = None
    damping: Damping = field(default_factory=Damping)
    additional_mass: tuple[float, float, float] = (0.0, 0.0, 0.0)
    wind_drag_coefficient: float | None = None
    current_drag_coefficient: float | None = None
    gap_damping_lid: float = 0.0
    lines: tuple[MooringLine | MooringSpring, ...] = ()
    coefficients_file: CoefficientsFile | None = None

    def __post_init__(self) -> None:
        if self.mass is None and self.draught is None:
            raise InputError("neither mass nor draught is given", path="structure", remedy="give one of them")


@checks_words
@dataclass(frozen=True)
class LineDynamics:
    """How lines in motion are cut and what the bed and the material take; ``None``: chosen from the line.

    Parameters
    ----------
    bars : int
        Straight bars that one line is cut into.
    damping_ratio : float
        Internal damping of a bar, BA = ratio times bar length times sqrt(EA m).
    bed_stiffness, bed_damping : float or None
        Of the bed per contact area [Pa/m], [Pa s/m].
    slack_fraction : float
        Tension over that at rest under which a line counts as slack.
    snap_fraction : float
        Peak over the tension at rest above which a contact counts as a snap.
    sensitivity : bool
        Whether every run is repeated with twice the bars, half the step and twice the internal damping.
    mode : {"auto", "quasi_static", "dynamic"}
        Whether lines that are not in motion from the start are set in motion around the events of the line that
        governs an irregular sea, and where their peaks pass the range of lines at rest (``auto``), never, or from the
        start.
    """

    bars: int = 30
    damping_ratio: float = 0.1
    bed_stiffness: float | None = None
    bed_damping: float | None = None
    slack_fraction: float = 0.05
    snap_fraction: float = 3.0
    sensitivity: bool = False
    mode: LineMode = "auto"


@checks_words
@dataclass(frozen=True)
class TimeSettings:
    """How the time domain is run; ``None`` means that the program chooses and says why.

    Parameters
    ----------
    duration : float or None
        Simulated time of regular waves [s] (irregular seas carry their own).
    ramp : float or None
        Length of the cosine ramp [s].
    time_step : float or None
    analysed_periods : int
        Whole periods at the end that are analysed in regular waves.
    drift : {"auto", "ramped", "pulsating", "newman", "none"}
        ``auto``: the mean under the ramp in regular waves, slow drift by Newman's approximation in irregular seas.
    memory : {"state_space", "convolution"}
    lines : LineDynamics
        For lines that are in motion.
    realisations : int or None
        Realisations of every irregular sea; ``None``: :data:`DEFAULT_REALISATIONS`, or one where lines are in motion
        from the start.
    """

    duration: float | None = None
    ramp: float | None = None
    time_step: float | None = None
    analysed_periods: int = 10
    drift: DriftLaw = "auto"
    memory: Literal["state_space", "convolution"] = "state_space"
    lines: LineDynamics = field(default_factory=LineDynamics)
    realisations: int | None = None


@dataclass(frozen=True)
class Sensitivity:
    """Variations that redraw the figures of P3: damping fractions, chain slacks [m], number of lines."""

    damping_fractions: tuple[float, ...] = ()
    line_slacks: tuple[float, ...] = ()
    line_counts: tuple[int, ...] = ()


@checks_words
@dataclass(frozen=True)
class Settings:
    """Which analyses are run and how."""

    analyses: tuple[Literal["statics", "mooring", "frequency", "time"], ...] = (
        "statics",
        "mooring",
        "frequency",
        "time",
    )
    drift: bool = True
    frequencies: tuple[float, ...] | None = None
    restoring_offsets: tuple[float, ...] | None = None
    time: TimeSettings = field(default_factory=TimeSettings)
    sensitivity: Sensitivity = field(default_factory=Sensitivity)

    def angular_frequencies(self) -> np.ndarray | None:
        """Return the user's angular frequencies [rad/s], or ``None``."""
        return None if self.frequencies is None else np.asarray(self.frequencies, dtype=float)


@dataclass(frozen=True)
class MeasuredPoints:
    """Measured points to show with the results: one record per column name."""

    file: str
    columns: Mapping[str, tuple[float, ...]]


@dataclass(frozen=True)
class BreakwaterProblem:
    """The whole problem as the case file states it."""

    title: str
    breakwater: Breakwater
    environment: Environment
    settings: Settings = field(default_factory=Settings)
    measured: MeasuredPoints | None = None
    case_text: str = ""
    case_hash: str = ""
    criteria: tuple[Criterion, ...] = ()
