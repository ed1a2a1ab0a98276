"""Small records of MoorDyn input files: options and the files that stand next to a deck."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Literal

import numpy as np

from moyai.core.options import checks_words
from moyai.flexible.bed import Ground

#: Name that MoorDyn gives the profile of a steady current, next to the deck.
CURRENT_FILE = "current_profile.txt"


@dataclass(frozen=True)
class StiffnessTable:
    """Tension over strain, from a file that a line type names in place of EA."""

    #: Rising from 0 [-].
    strain: tuple[float, ...]
    #: Rising from 0 [N].
    tension: tuple[float, ...]
    #: Name of the file, next to the deck.
    file: str


@dataclass(frozen=True)
class DeckSlowStretch:
    """Numbers parted by | in a line type: static stiffness and damping of a viscoelastic rope."""

    #: EA_s [N], BA_s [N s].
    stiffness: float
    damping: float
    #: EA_D_Lm, by which the dynamic stiffness grows with the mean load [-].
    growth: float = 0.0


@checks_words
@dataclass(frozen=True)
class DeckSyrope:
    """What a polyester rope has besides its curve: shape of its working curves, quick stiffness, history."""

    #: LINEAR, QUADRATIC or EXP.
    form: Literal["LINEAR", "QUADRATIC", "EXP"]
    #: First parameter of the shape.
    k1: float
    #: Second parameter of the shape.
    k2: float
    #: Quick stiffness without tension [N], and per tension [-].
    alpha: float
    #: Quick stiffness per mean tension [-].
    beta: float
    #: BA_s of the slow stretch [N s].
    damping: float
    #: Highest mean tension so far, 0 for a new rope, and mean tension at the start [N].
    highest: float = 0.0
    #: Mean tension at the start [N].
    mean: float = 0.0
    #: Curve of the new rope.
    original: StiffnessTable | None = None


@dataclass(frozen=True)
class DeckSeafloor:
    """Heights of the bed on a rectangular grid, from a file of their own."""

    #: x, y, z above still water [m], one a crossing of the grid lines.
    rows: tuple[tuple[float, float, float], ...]
    #: Name of the file.
    file: str = field(default="", compare=False)
    #: Folder that the file stands in.
    folder: str = field(default="", compare=False)

    @property
    def flat_depth(self) -> float | None:
        """Depth where all heights are the same [m]."""
        levels = {z for _, _, z in self.rows}
        return -levels.pop() if len(levels) == 1 else None

    @property
    def deepest(self) -> float:
        """Greatest depth [m]."""
        return -min(z for _, _, z in self.rows)

    @property
    def ground(self) -> Ground | None:
        """The bed where it varies."""
        return None if self.flat_depth is not None else Ground.of_rows(np.array(self.rows))


@dataclass(frozen=True)
class DeckFailure:
    """A row of FAILURE: a line that parts from a point."""

    number: int
    #: ID of a point, or end of a rod such as ``R1A``.
    point: int | str
    #: ID of the line.
    line_number: int
    #: [s], 0 for none.
    time: float
    #: [N], 0 for none.
    tension: float
    #: Line of the file.
    line: int = field(default=0, compare=False)


@dataclass(frozen=True)
class DeckOption:
    """A row of OPTIONS."""

    #: In the spelling of MoorDyn v2.
    key: str
    #: As the file has it.
    value: float | str
    #: Line of the file.
    line: int = field(default=0, compare=False)


@dataclass(frozen=True)
class DeckCurrent:
    """Steady current over the height, from ``current_profile.txt`` next to the deck."""

    #: Heights [m], rising.
    z: tuple[float, ...]
    #: Horizontal components at them [m/s].
    velocity: tuple[tuple[float, float], ...]
    #: Where the file stands, empty for a table within another file.
    file: str = field(default="", compare=False)


@checks_words
@dataclass(frozen=True)
class DeckCurrentField:
    """A current that changes with time, in a file next to the deck."""

    #: Name of the file.
    file: str
    #: ``profile`` over the height, or ``grid`` in space.
    form: Literal["profile", "grid"]
    #: Where the file stands.
    folder: str = field(default="", compare=False)


#: Names that MoorDyn gives the files of waves, next to the deck.
FREQUENCY_FILE, ELEVATION_FILE = "wave_frequencies.txt", "wave_elevation.txt"


@dataclass(frozen=True)
class DeckWaves:
    """Waves of the files next to a deck, as the rows of ``wave_frequencies.txt`` for WaveKin 7.

    The elevation at the origin is the sum of Im((real + i imaginary) e^{i omega t}) = real sin + imaginary cos.
    """

    #: [rad/s].
    omega: tuple[float, ...]
    #: Real parts [m].
    real: tuple[float, ...]
    #: Imaginary parts [m].
    imaginary: tuple[float, ...]
    #: Of travel, from +x towards +y [rad].
    direction: tuple[float, ...]
    #: Record of the elevation that they come from, empty for waves given one by one.
    file: str = field(default="", compare=False)
    #: That the record is taken at [s].
    time_step: float | None = field(default=None, compare=False)
    #: After which the record repeats [s].
    period: float | None = field(default=None, compare=False)
