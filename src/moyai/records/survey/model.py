"""A survey: loggers whose records are processed block by block. What is to be done, frozen and checked."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Literal

from moyai.core.arrays import Array
from moyai.core.errors import InputError
from moyai.core.options import checks_words
from moyai.core.quantities import ACCELERATION, ANGLE, FORCE, LENGTH, PRESSURE, SPEED
from moyai.records.reading.quality import QualityOptions
from moyai.records.reading.sensors import Sensor
from moyai.records.reading.sources import LoggerSource
from moyai.sea.water import Water
from moyai.series.spectra import WelchOptions
from moyai.series.zero_crossing import WaveOptions

ChannelKind = Literal[
    "elevation", "pressure", "velocity_x", "velocity_y", "velocity_z", "slope_x", "slope_y", "displacement_x",
    "displacement_y", "acceleration_z", "speed", "direction", "tension", "force", "motion", "rotation", "other",
]  # fmt: skip

QUANTITIES_OF_KINDS = {
    "elevation": LENGTH, "pressure": PRESSURE, "velocity_x": SPEED, "velocity_y": SPEED, "velocity_z": SPEED,
    "displacement_x": LENGTH, "displacement_y": LENGTH, "acceleration_z": ACCELERATION, "speed": SPEED,
    "direction": ANGLE, "tension": FORCE, "force": FORCE, "motion": LENGTH, "rotation": ANGLE,
}  # fmt: skip
"""What a channel of each kind is by its unit; kinds that are absent may have any."""


@checks_words
@dataclass(frozen=True)
class ChannelUse:
    """What a channel is and where."""

    name: str
    kind: ChannelKind
    #: For quantities of waves.
    sensor: Sensor | None
    quality: QualityOptions


@dataclass(frozen=True)
class Spectral:
    """How spectra are taken, and in which band [Hz] their values."""

    options: WelchOptions
    lowest: float
    highest: float


@dataclass(frozen=True)
class Directions:
    """Channels of the directional analysis; ``entropy`` fits the whole spectrum in every block."""

    channels: tuple[str, ...]
    entropy: bool = False


@dataclass(frozen=True)
class CurrentUse:
    """Channels of the current: velocities along x and y, or speed and direction."""

    #: Channel of the velocity along x, or of the speed where ``polar``.
    x: str
    #: Channel of the velocity along y, or of the direction where ``polar``.
    y: str
    polar: bool = False
    #: Whether the direction is a compass bearing (towards which the current goes).
    bearing: bool = False
    #: Heading of the structure's normal [rad], NaN where there is none.
    normal_heading: float = math.nan


@checks_words
@dataclass(frozen=True)
class TensionUse:
    """A tension channel and how it is split."""

    channel: str
    #: Type of structure or of anchor it belongs to.
    group: str
    steady: Literal["mean", "median", "low_pass"] = "median"
    #: Period of the low pass [s].
    cutoff: float = 30.0
    #: Rise over the steady part that counts as a snap [N]; infinite counts none.
    snap_limit: float = math.inf


LoadMeasure = Callable[[Array, Array, Array, Array], Array]
"""From wave height, period, angle and current of the blocks to what loads the structure."""


@dataclass(frozen=True)
class ReflectionUse:
    """Gauges in front of and behind a structure, with their positions along the waves [m]."""

    front: tuple[str, ...]
    front_positions: tuple[float, ...]
    rear: tuple[str, ...] = ()
    rear_positions: tuple[float, ...] = ()


@dataclass(frozen=True)
class ResponseUse:
    """Motions (or any channels) whose response to a wave channel is wanted."""

    wave: str
    channels: tuple[str, ...]
    least_coherence: float = 0.0


@dataclass(frozen=True)
class Survey:
    """Everything that ``moyai measure records`` does."""

    title: str
    loggers: tuple[LoggerSource, ...]
    #: Of all loggers.
    channels: tuple[ChannelUse, ...]
    #: [s].
    block_length: float
    #: An instant at which a block begins [s]; NaN: whole multiples of the length (dated), or the first sample.
    block_start: float = math.nan
    water: Water | None = None
    #: Compass bearing of +x [rad], NaN where unknown.
    x_axis_bearing: float = math.nan
    #: Channels that are cut into waves.
    waves: tuple[str, ...] = ()
    wave_options: WaveOptions = field(default_factory=WaveOptions)
    spectral: Spectral | None = None
    directions: Directions | None = None
    current: CurrentUse | None = None
    tensions: tuple[TensionUse, ...] = ()
    #: Wave channel whose waves the tensions are matched to.
    wave_of_tensions: str = ""
    #: Travel time from the gauge to the float [s].
    tension_lag: float = 0.0
    #: How far the lag may be refined by correlation [s].
    largest_lag: float = 0.0
    #: Heading of the structure's normal [rad].
    normal_heading: float = math.nan
    reflection: ReflectionUse | None = None
    #: From H1/3 [m], T1/3 [s], angle from the normal [rad] and normal current [m/s] to the squared velocity that loads
    #: a curtain [m2/s2].
    load_measure: LoadMeasure | None = None
    responses: ResponseUse | None = None
    case_text: str = ""
    case_hash: str = ""

    def __post_init__(self) -> None:
        names = [column.name for logger in self.loggers for column in logger.columns]
        twice = next((name for name in names if names.count(name) > 1), None)
        if twice is not None:
            raise InputError(f"two channels are named '{twice}'", parameter="loggers", remedy="rename one")
        known = {channel.name for channel in self.channels}
        wanted = {
            "waves.channels": self.waves,
            "directions.channels": self.directions.channels if self.directions else (),
            "current": (self.current.x, self.current.y) if self.current else (),
            "tensions": tuple(entry.channel for entry in self.tensions),
            "reflection": (*self.reflection.front, *self.reflection.rear) if self.reflection else (),
            "responses": (self.responses.wave, *self.responses.channels) if self.responses else (),
            "tensions.waves": (self.wave_of_tensions,) if self.wave_of_tensions else (),
        }
        for path, channels in wanted.items():
            absent = next((name for name in channels if name not in known), None)
            if absent is not None:
                raise InputError(f"there is no channel '{absent}'", parameter=path, allowed=", ".join(sorted(known)))
        if not self.block_length > 0.0:
            raise InputError(f"blocks of {self.block_length:g} s", parameter="blocks.length", allowed="greater than 0")

    def use_of(self, name: str) -> ChannelUse:
        """Return what a channel of this name is.

        Parameters
        ----------
        name : str
            Of the channel.

        Raises
        ------
        StopIteration
            When there is none.
        """
        return next(channel for channel in self.channels if channel.name == name)
