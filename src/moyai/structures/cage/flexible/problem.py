"""What a run of a flexible cage takes: the cage, the site, the seas, how they are computed."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import ClassVar

from moyai.core.errors import InputError
from moyai.core.headline import Criterion
from moyai.core.options import checks_words
from moyai.sea.environment import Environment
from moyai.sea.kinematics import Stretching
from moyai.sea.states import IrregularSea
from moyai.sea.water import Water
from moyai.structures.cage.flexible.model import FlexibleCage
from moyai.structures.cage.rigid.model import RigidCageWaves


@checks_words
@dataclass(frozen=True)
class FlexibleSettings:
    """How a flexible cage is computed."""

    #: ``statics`` (rest in each current), ``time`` (each sea), ``sensitivity`` (step, mesh and damping behind peaks).
    analyses: tuple[str, ...]
    #: Speeds at the surface that the profile of the current is scaled to for ``statics`` [m/s]; the current as it is
    #: when empty.
    current_speeds: tuple[float, ...] = ()
    #: Whether the rest in the current of the site is found under every law of nets that is valid there.
    other_laws: bool = True
    #: For a draft: an equilibrium continues from one before that is near, to a thousandth of the largest tension.
    nominal: bool = False
    #: Wave periods that are run in regular waves after the ramp, at least; more until they repeat.
    periods: int = 8
    #: Wave periods after the ramp at which a run in regular waves ends, whether they repeat or not.
    most_periods: int = 40
    #: Periods over which the waves grow.
    ramp_periods: float = 3.0
    #: Rows of the result in a wave period (the peak period of a spectrum).
    rows_per_period: int = 40
    #: Pictures kept of a run, twelve a wave period or more about its governing moment.
    frames: int = 120
    #: Kinematics above still water.
    stretching: Stretching = "wheeler"
    #: A line counts as slack below this share of its mean tension.
    slack_share: float = 0.05
    #: A peak after slack counts as a snap above this multiple of the mean tension.
    snap_factor: float = 2.0


@dataclass(frozen=True, eq=False)
class FlexibleCageProblem:
    """A flexible cage with its site, seas and settings."""

    title: str
    #: At the depth of the chart datum; :meth:`at_level` moves it.
    cage: FlexibleCage
    #: Water levels and current.
    environment: Environment
    seas: tuple[RigidCageWaves | IrregularSea, ...]
    settings: FlexibleSettings
    #: Text of the case file, kept with the result.
    case_text: str = ""
    #: Hash of that text.
    case_hash: str = ""
    criteria: tuple[Criterion, ...] = ()
    model: ClassVar[str] = "flexible"

    def __post_init__(self) -> None:
        if self.settings.current_speeds and self.environment.current is None:
            raise InputError(
                "speeds of a current without a current",
                parameter="settings.flexible.current_speeds",
                remedy="give `current`, whose profile and heading they scale",
            )

    def at_level(self, level: float) -> FlexibleCage:
        """Return the cage in the water of a level [m above datum]."""
        water: Water = self.environment.water_at(level)
        return replace(self.cage, water=water, bed=replace(self.cage.bed, level=-water.depth))
