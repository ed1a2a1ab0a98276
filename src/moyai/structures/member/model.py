"""The member of a case: geometry, coefficients, circulation, waves, motion, settings."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Literal

import numpy as np

from moyai.core.errors import InputError
from moyai.core.headline import Criterion
from moyai.core.options import checks_words
from moyai.morison.circulation import CirculationLaw
from moyai.morison.coefficients import CoefficientRule
from moyai.morison.forces import DragForm
from moyai.morison.members import StraightMember
from moyai.sea.environment import Environment
from moyai.sea.kinematics import Stretching
from moyai.sea.states import IrregularSea
from moyai.structures.member.supports import Support

Analysis = Literal["sweep", "forces", "surface"]
WaveTheory = Literal["automatic", "linear", "stokes", "stream_function"]


@checks_words
@dataclass(frozen=True)
class RegularWaves:
    """Regular waves: every height with every period.

    Parameters
    ----------
    name : str
        Label of the sea state.
    heights, periods : tuple of float
        Wave heights H [m], periods T in the fixed frame [s].
    heading : float
        Direction of travel [rad].
    theory : {"automatic", "linear", "stokes", "stream_function"}
        ``automatic``: linear where it neglects harmonics below one per cent of the first, else the stream function.
    """

    name: str
    heights: tuple[float, ...]
    periods: tuple[float, ...]
    heading: float = 0.0
    theory: WaveTheory = "automatic"

    def waves(self) -> tuple[tuple[float, float], ...]:
        """Return every height with every period."""
        return tuple((height, period) for period in self.periods for height in self.heights)


MemberSea = RegularWaves | IrregularSea


@dataclass(frozen=True)
class Motion:
    """A harmonic translation of the whole member, Re(amplitude e^{i phase} e^{-i omega t}).

    Parameters
    ----------
    amplitude : tuple of three float
        Along x, y, z [m].
    phase : tuple of three float
        [rad].
    period : float or None
        [s]; ``None`` moves with the period of each regular wave.
    """

    amplitude: tuple[float, float, float]
    phase: tuple[float, float, float] = (0.0, 0.0, 0.0)
    period: float | None = None

    def derivatives(self, time: np.ndarray, omega: float) -> tuple[np.ndarray, np.ndarray]:
        """Return velocity and acceleration at times [s], shape (times, 3) [m/s], [m/s2]."""
        turn = np.exp(-1j * omega * np.asarray(time))[:, None]
        place = np.asarray(self.amplitude) * np.exp(1j * np.asarray(self.phase)) * turn
        return (-1j * omega * place).real, (-(omega**2) * place).real


@checks_words
@dataclass(frozen=True)
class Settings:
    """How the analyses are run.

    Parameters
    ----------
    analyses : tuple of str
        ``sweep`` over KC, ``forces`` in the seas, ``surface``: what the free surface changes.
    strips : int
        Strips along the member.
    stretching : {"wheeler", "linear", "constant"}
        Linear kinematics above still water.
    steps_per_period : int
        Time steps in a period of regular waves.
    irregular_steps : int
        Time steps in the peak period of an irregular sea.
    realisations : int
        Realisations of an irregular sea; largest forces are means over them.
    periods : int or None
        Periods shown of regular waves; ``None``: one when the circulation is settled, eight relaxation times from calm.
    """

    analyses: tuple[Analysis, ...] = ("sweep", "forces", "surface")
    strips: int = 40
    stretching: Stretching = "wheeler"
    steps_per_period: int = 200
    irregular_steps: int = 40
    realisations: int = 5
    periods: int | None = None


@checks_words
@dataclass(frozen=True)
class MemberProblem:
    """The whole problem as the case file states it.

    Parameters
    ----------
    title : str
    member : StraightMember
        z above datum.
    rule : CoefficientRule
        Where the coefficients come from.
    kinematic_viscosity : float
        nu [m2/s].
    environment : Environment
        Water, levels, current; its sea states are those of ``seas``.
    seas : tuple of RegularWaves or IrregularSea
    circulation : CirculationLaw
    form : {"component", "vector"}
        Drag by component or with the common speed.
    roughness : float
        Height of the roughness k [m].
    motion : Motion or None
    support : {"both_ends", "start", "end"}
        Where it is held: simply at both ends, or fixed at one.
    """

    title: str
    member: StraightMember
    rule: CoefficientRule
    kinematic_viscosity: float
    environment: Environment
    seas: tuple[MemberSea, ...] = ()
    circulation: CirculationLaw = field(default_factory=CirculationLaw)
    form: DragForm = "component"
    roughness: float = 0.0
    motion: Motion | None = None
    support: Support = "both_ends"
    settings: Settings = field(default_factory=Settings)
    case_text: str = ""
    case_hash: str = ""
    criteria: tuple[Criterion, ...] = ()

    def __post_init__(self) -> None:
        if not (math.isfinite(self.kinematic_viscosity) and self.kinematic_viscosity > 0.0):
            raise InputError(
                f"kinematic_viscosity is {self.kinematic_viscosity:g} m2/s", path="kinematic_viscosity", allowed="> 0"
            )

    def member_at(self, level: float) -> StraightMember:
        """Return the member with z above the still water of a water level [m above datum]."""
        return self.member.shifted(-level)
