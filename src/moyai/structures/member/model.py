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
class MemberWaves:
    """Regular waves: every height with every period."""

    #: Label of the sea state.
    name: str
    #: Wave heights H [m].
    heights: tuple[float, ...]
    #: Periods T in the fixed frame [s].
    periods: tuple[float, ...]
    #: Direction of travel [rad].
    heading: float = 0.0
    #: ``automatic``: linear where it neglects harmonics below one per cent of the first, else the stream function; one
    #: of "automatic", "linear", "stokes", "stream_function".
    theory: WaveTheory = "automatic"

    def waves(self) -> tuple[tuple[float, float], ...]:
        """Return every height with every period [m], [s]: all periods of the first height, then those of the next."""
        return tuple((height, period) for height in self.heights for period in self.periods)


MemberSea = MemberWaves | IrregularSea


@dataclass(frozen=True)
class HarmonicMotion:
    """A harmonic translation of the whole member, Re(amplitude e^{i phase} e^{-i omega t})."""

    #: Along x, y, z [m].
    amplitude: tuple[float, float, float]
    #: [rad].
    phase: tuple[float, float, float] = (0.0, 0.0, 0.0)
    #: [s]; ``None`` moves with the period of each regular wave.
    period: float | None = None

    def derivatives(self, time: np.ndarray, omega: float) -> tuple[np.ndarray, np.ndarray]:
        """Return velocity and acceleration at times [s], shape (times, 3) [m/s], [m/s2]."""
        turn = np.exp(-1j * omega * np.asarray(time))[:, None]
        place = np.asarray(self.amplitude) * np.exp(1j * np.asarray(self.phase)) * turn
        return (-1j * omega * place).real, (-(omega**2) * place).real


@checks_words
@dataclass(frozen=True)
class MemberSettings:
    """How the analyses are run."""

    #: ``sweep`` over KC, ``forces`` in the seas, ``surface``: what the free surface changes.
    analyses: tuple[Analysis, ...] = ("sweep", "forces", "surface")
    #: Strips along the member.
    strips: int = 40
    #: Linear kinematics above still water; one of "wheeler", "linear", "constant".
    stretching: Stretching = "wheeler"
    #: Time steps in a period of regular waves.
    steps_per_period: int = 200
    #: Time steps in the peak period of an irregular sea.
    irregular_steps: int = 40
    #: Realisations of an irregular sea; largest forces are means over them.
    realisations: int = 5
    #: Periods shown of regular waves; ``None``: one when the circulation is settled, eight relaxation times from calm.
    periods: int | None = None


@checks_words
@dataclass(frozen=True)
class MemberProblem:
    """The whole problem as the case file states it."""

    title: str
    #: z above datum.
    member: StraightMember
    #: Where the coefficients come from.
    rule: CoefficientRule
    #: nu [m2/s].
    kinematic_viscosity: float
    #: Water, levels, current; its sea states are those of ``seas``.
    environment: Environment
    seas: tuple[MemberSea, ...] = ()
    circulation: CirculationLaw = field(default_factory=CirculationLaw)
    #: Drag with the common speed or by component; one of "vector", "component".
    form: DragForm = "vector"
    #: Height of the roughness k [m].
    roughness: float = 0.0
    motion: HarmonicMotion | None = None
    #: Where it is held: simply at both ends, or fixed at one; one of "both_ends", "start", "end".
    support: Support = "both_ends"
    settings: MemberSettings = field(default_factory=MemberSettings)
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

    def member_at(self, level: float) -> StraightMember:
        """Return the member with z above the still water of a water level [m above datum]."""
        return self.member.shifted(-level)
