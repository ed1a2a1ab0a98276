"""Small records of MoorDyn input files: options and the files that stand next to a deck."""

from __future__ import annotations

from dataclasses import dataclass, field

#: Name that MoorDyn gives the profile of a steady current, next to the deck.
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
        Name of the file, next to the deck.
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
    """Steady current over the height, from ``current_profile.txt`` next to the deck.

    Parameters
    ----------
    z : tuple of float
        Heights [m], rising.
    velocity : tuple of (float, float)
        Horizontal components at them [m/s].
    """

    z: tuple[float, ...]
    velocity: tuple[tuple[float, float], ...]


#: Names that MoorDyn gives the files of waves, next to the deck.
FREQUENCY_FILE, ELEVATION_FILE = "wave_frequencies.txt", "wave_elevation.txt"


@dataclass(frozen=True)
class DeckWaves:
    """Waves of the files next to a deck, as the rows of ``wave_frequencies.txt`` for WaveKin 7.

    The elevation at the origin is the sum of Im((real + i imaginary) e^{i omega t}) = real sin + imaginary cos.

    Parameters
    ----------
    omega : tuple of float
        [rad/s].
    real, imaginary : tuple of float
        [m].
    direction : tuple of float
        Of travel, from +x towards +y [rad].
    file : str
        Record of the elevation that they come from, empty for waves given one by one.
    time_step : float, optional
        That the record is taken at [s].
    period : float, optional
        After which the record repeats [s].
    """

    omega: tuple[float, ...]
    real: tuple[float, ...]
    imaginary: tuple[float, ...]
    direction: tuple[float, ...]
    file: str = field(default="", compare=False)
    time_step: float | None = field(default=None, compare=False)
    period: float | None = field(default=None, compare=False)
