"""Small records of MoorDyn input files: options and the files that stand beside a deck."""

from __future__ import annotations

from dataclasses import dataclass, field

#: Name that MoorDyn gives the profile of a steady current, beside the deck.
CURRENT_FILE = "current_profile.txt"


@dataclass(frozen=True)
class StiffnessTable:
    """Tension over strain, from a file that a line type names in place of EA.

    Parameters
    ----------
    strain : tuple of float
        Rising from 0 [-].
    tension : tuple of float
        Rising from 0 [N].
    file : str
        Name of the file, beside the deck.
    """

    strain: tuple[float, ...]
    tension: tuple[float, ...]
    file: str


@dataclass(frozen=True)
class DeckOption:
    """A row of OPTIONS.

    Parameters
    ----------
    key : str
        In the spelling of MoorDyn v2.
    value : float or str
        As the file has it.
    line : int
        Line of the file.
    """

    key: str
    value: float | str
    line: int = field(default=0, compare=False)


@dataclass(frozen=True)
class DeckCurrent:
    """Steady current over the height, from ``current_profile.txt`` beside the deck.

    Parameters
    ----------
    z : tuple of float
        Heights [m], rising.
    velocity : tuple of (float, float)
        Horizontal components at them [m/s].
    """

    z: tuple[float, ...]
    velocity: tuple[tuple[float, float], ...]
