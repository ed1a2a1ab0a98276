"""Schema of a file of ``moyai measure records``: loggers, their columns and clocks, and what to work out."""

from __future__ import annotations

import math
from typing import Annotated, Any, ClassVar, Literal

from pydantic import AfterValidator, Field

from moyai.case.schema_types import (
    Block,
    Density,
    Depth,
    Duration,
    FileName,
    Gravity,
    Heading,
    KeyGroups,
    Length,
    Name,
    NonNegativeLength,
    Number,
    PositiveLength,
    PositiveNumber,
    QuantityOf,
    Truth,
    Whole,
    refuse,
)
from moyai.core import quantities
from moyai.core.errors import InputError
from moyai.core.units import parse_unit

Frequency = Annotated[float, QuantityOf(quantities.FREQUENCY, above=0.0)]
"""A frequency; plain numbers are hertz."""
SignedDuration = Annotated[float, QuantityOf(quantities.TIME)]
Row = Annotated[int, Field(strict=True, ge=0, le=1_000_000)]
Column = Annotated[int, Field(strict=True, ge=1, le=100_000)] | Annotated[str, Field(min_length=1, max_length=200)]
Share = Annotated[float, QuantityOf(quantities.NUMBER, least=0.0, most=0.9)]
DriftShare = Annotated[float, QuantityOf(quantities.NUMBER, above=0.0, words=(("never", math.inf),))]
PositiveForceOrNone = Annotated[float, QuantityOf(quantities.FORCE, above=0.0)]


def _unit(text: str) -> str:
    if text in ("", "1", "-"):
        return "1"
    try:
        parse_unit(text)
    except InputError as error:
        raise refuse(error.fault.message, remedy=error.fault.remedy) from None
    return text


UnitText = Annotated[str, AfterValidator(_unit)]


class TimeColumn(Block):
    """Where the instants of a logger come from."""

    at_least_one: ClassVar[KeyGroups] = (("column", "columns", "rate"),)
    at_most_one: ClassVar[KeyGroups] = (("column", "columns"),)

    column: Column | None = Field(default=None, description="Heading, number from 1, or variable of the time.")
    columns: tuple[Column, Column] | None = Field(default=None, description="Two columns: date and time of day.")
    format: str | None = Field(
        default=None,
        min_length=2,
        description="'iso', or a pattern such as '%Y/%m/%d %H:%M:%S.%f'; absent: the time is a number.",
    )
    unit: Literal["s", "ms", "us", "ns", "min", "h", "d", "datenum", "excel"] | None = Field(
        default=None,
        description="Unit of a number; 'datenum' are MATLAB's days, 'excel' the days of a spreadsheet; absent: the one "
        "the heading states, else seconds.",
    )
    start: str | None = Field(
        default=None, description="Date and time of zero, UTC unless it names its offset: 1999-09-23T00:00:00+09:00."
    )
    rate: Frequency | None = Field(
        default=None, description="Sampling rate; with stamps to the whole second, samples are spread at this rate."
    )
    utc_offset: SignedDuration = Field(default=0.0, description="Local time of the stamps minus UTC, '9 h' for Japan.")
    order: Literal["strict", "drop"] = Field(
        default="strict", description="Rows whose time does not increase are an error, or are left out and reported."
    )


class ClockKeys(Block):
    """Error of the logger's clock."""

    offset: SignedDuration = Field(default=0.0, description="Seconds to add to the logger's time.")
    drift: Number = Field(default=0.0, description="Seconds to add per second of the logger after the reference.")
    reference: str | None = Field(
        default=None, description="Date at which the offset holds; the first sample if absent."
    )


class QualityKeys(Block):
    """Limits of the quality control; keys of a channel go before those of the file."""

    gap_steps: Annotated[float, QuantityOf(quantities.NUMBER, above=1.0)] = Field(
        default=1.5, description="A time step longer than so many usual steps is a gap."
    )
    spikes: Truth | None = Field(
        default=None, description="Whether spikes are looked for; absent: everywhere but in tensions and forces."
    )
    spike_scale: PositiveNumber = Field(
        default=8.0, description="Robust standard deviations from the median of the neighbours that make a spike."
    )
    spike_samples: Whole = Field(default=2, description="Longest spike, in samples.")
    flat: Annotated[float | None, QuantityOf(quantities.TIME, above=0.0, words=(("never", None),))] = Field(
        default=10.0, description="Identical values for longer are a flat line, or 'never'."
    )
    clip_samples: Row = Field(
        default=3,
        description="So many identical values in a row at the extreme of a block, twice, are clipped; 0: never.",
    )
    drift_share: DriftShare | None = Field(
        default=None,
        description="A trend over the record that exceeds this share of the standard deviation is a drift, or 'never'; "
        "absent: 1 for elevations and motions, 'never' for what tides and lines change.",
    )
    unit_slips: Truth = Field(
        default=True, description="Whether sudden changes of scale by a unit's factor are reported."
    )


class ChannelEntry(Block):
    """One column of a logger."""

    name: Name = Field(description="Name of the channel in the results.")
    column: Column = Field(description="Heading (with or without its unit), number from 1, or variable: vel[0,3].")
    kind: Literal[
        "elevation", "pressure", "velocity_x", "velocity_y", "velocity_z", "slope_x", "slope_y", "displacement_x",
        "displacement_y", "acceleration_z", "speed", "direction", "tension", "force", "motion", "rotation", "other",
    ] = Field(description="What it measures; its unit must fit.")  # fmt: skip
    unit: UnitText = Field(default="", description="Unit in the file; absent: the one the file states; '1' for none.")
    scale: Number = Field(default=1.0, description="Factor on the numbers of the file, before the unit.")
    offset: Number = Field(
        default=0.0, description="Added to the numbers of the file after the factor, before the unit."
    )
    missing: tuple[float | str, ...] = Field(
        default=(), max_length=20, description="Numbers and words that mean 'no value': [-9999, '****', 欠測]."
    )
    x: Length = Field(default=0.0, description="Position.")
    y: Length = Field(default=0.0, description="Position.")
    z: Length = Field(default=0.0, description="Height above the mean water level, negative below.")
    lowest: Number | None = Field(default=None, description="Lowest value the instrument can give, in the SI unit.")
    highest: Number | None = Field(default=None, description="Highest value the instrument can give, in the SI unit.")
    quality: QualityKeys | None = Field(default=None, description="Limits for this channel.")


class LoggerKeys(Block):
    """One logger and its files."""

    name: Name = Field(description="Name for messages.")
    exactly_one: ClassVar[KeyGroups] = (("file", "files"),)
    file: FileName | None = Field(default=None, description="One file, or a pattern such as 'waves_*.csv'.")
    files: tuple[FileName, ...] | None = Field(default=None, description="Files in the order of time.")
    format: Literal["auto", "csv", "mat", "netcdf", "parquet"] = Field(
        default="auto", description="Format; 'auto' goes by the ending."
    )
    encoding: str = Field(default="auto", description="'auto' tries UTF-8 and Shift-JIS; else a name such as cp932.")
    delimiter: str = Field(default="auto", min_length=1, description="'auto', 'whitespace', 'tab' or the character.")
    decimal: Literal[".", ","] = Field(default=".", description="Decimal sign.")
    header_row: Row | Literal["auto"] = Field(
        default="auto", description="Line of the headings from 1, 0 for none; 'auto': the first that is no comment."
    )
    first_row: Row = Field(default=0, description="Line of the first sample; 0: the line after the headings.")
    comment: str = Field(default="#", max_length=1, description="Sign that opens a comment.")
    time: TimeColumn = Field(description="Where the time comes from.")
    clock: ClockKeys = Field(default=ClockKeys(), description="Error of the clock.")
    channels: Annotated[tuple[ChannelEntry, ...], Field(min_length=1, max_length=200)] = Field(
        description="Columns to read."
    )


class RecordSite(Block):
    """The water of the site."""

    water_depth: Depth = Field(description="Mean depth during the record, or 'infinite'.")
    density: Density = Field(description="Density of the water.")
    gravity: Gravity = Field(description="Acceleration of gravity.")
    x_axis_bearing_deg: Heading | None = Field(default=None, description="Compass bearing that +x points to.")


class BlockKeys(Block):
    """Blocks of time that are processed one by one."""

    length: Duration = Field(description="Length of a block, '20 min'.")
    start: str | None = Field(default=None, description="Date at which a block begins; absent: whole multiples.")


class WaveKeys(Block):
    """How records are cut into waves."""

    channels: Annotated[tuple[Name, ...], Field(min_length=1)] = Field(
        description="Elevations, or pressures and vertical motions that linear theory carries to the surface."
    )
    crossing: Literal["up", "down"] = Field(default="up", description="Zero crossing that opens a wave.")
    detrend: Literal["none", "mean", "linear", "quadratic", "high_pass"] = Field(
        default="linear", description="What is taken off each block; 'high_pass' takes tide and surge off."
    )
    cutoff: Duration | None = Field(default=None, description="Period above which 'high_pass' takes a motion as slow.")
    dead_band: NonNegativeLength = Field(
        default=0.0,
        description="The surface must leave this band about the mean on both sides for a crossing to count.",
    )
    crest: Literal["sample", "parabola"] = Field(default="parabola", description="Crests: highest sample, or parabola.")
    share: Literal["nearest", "down", "up"] = Field(default="nearest", description="Rounding of N/3 and N/10.")
    shortest: Annotated[float, QuantityOf(quantities.TIME, least=0.0)] = Field(
        default=0.0, description="Waves with shorter periods are left out."
    )
    longest: Duration | None = Field(default=None, description="Waves with longer periods are left out.")


class SpectrumKeys(Block):
    """How spectra are taken (Welch)."""

    segment: Duration | None = Field(default=None, description="Length of a segment; absent: the whole block.")
    overlap: Share = Field(default=0.5, description="Share that a segment has in common with the next.")
    window: Literal["hann", "rectangular", "cosine_tenth"] = Field(default="hann", description="Taper.")
    detrend: Literal["none", "mean", "linear"] = Field(default="linear", description="Taken off each segment.")
    bands: Whole = Field(default=1, description="Neighbouring frequencies averaged.")
    lowest: Frequency = Field(description="Lower end of the band of heights and periods.")
    highest: Frequency = Field(description="Upper end of the band.")


class DirectionKeys(Block):
    """Directional analysis."""

    channels: Annotated[tuple[Name, ...], Field(min_length=3, max_length=20)] = Field(
        description="A vertical quantity, one along x, one along y; or an array of any."
    )
    estimator: Literal["moments", "entropy"] = Field(
        default="moments", description="'moments': first Fourier coefficients of a triplet; 'entropy': whole spectrum."
    )


class CurrentKeys(Block):
    """Currents: velocities along x and y, or speed and direction."""

    exactly_one: ClassVar[KeyGroups] = (("velocity", "polar"),)
    velocity: tuple[Name, Name] | None = Field(default=None, description="Channels along x and y.")
    polar: tuple[Name, Name] | None = Field(default=None, description="Channels of speed and direction.")
    direction: Literal["bearing", "heading"] = Field(
        default="bearing", description="Whether the direction is a compass bearing (towards) or a heading in site axes."
    )


class TensionEntry(Block):
    """One tension channel."""

    channel: Name = Field(description="Channel.")
    group: Name = Field(default="all", description="Type of structure or anchor: types are compared.")


class TensionKeys(Block):
    """How tensions are split and matched to waves."""

    lines: Annotated[tuple[TensionEntry, ...], Field(min_length=1, max_length=100)] = Field(description="The channels.")
    waves: Name = Field(description="Wave channel whose waves they are matched to.")
    steady: Literal["mean", "median", "low_pass"] = Field(default="median", description="Steady part of a block.")
    cutoff: Duration = Field(default=30.0, description="Period of the low pass.")
    lag: SignedDuration = Field(default=0.0, description="Travel time of the waves from the gauge to the float.")
    largest_lag: Annotated[float, QuantityOf(quantities.TIME, least=0.0)] = Field(
        default=0.0, description="How far the lag may be refined by correlation."
    )
    curtain_depth: PositiveLength | None = Field(
        default=None, description="Depth of a curtain: tensions are also set against the squared velocity over it."
    )
    direction_rule: Literal["paper", "normal", "none"] = Field(
        default="paper", description="How the angle lowers the wave height in that: cos^2, cos, not."
    )
    height_ratio: PositiveNumber = Field(default=1.8, description="Height in that over H1/3.")
    snap_limit: PositiveForceOrNone | None = Field(default=None, description="Rise of a snap event.")


class ResponseKeys(Block):
    """Response of motions (or tensions, forces) to the waves."""

    wave: Name = Field(description="Elevation that drives.")
    channels: Annotated[tuple[Name, ...], Field(min_length=1, max_length=50)] = Field(description="What answers.")
    least_coherence: Annotated[float, QuantityOf(quantities.NUMBER, least=0.0, most=1.0)] = Field(
        default=0.0, description="Frequencies with less coherence are left out, besides those that chance would give."
    )


class GaugeEntry(Block):
    """A wave gauge of the reflection analysis."""

    channel: Name = Field(description="Channel of an elevation.")
    x: Length = Field(description="Position along the waves.")


class ReflectionKeys(Block):
    """Incident, reflected and transmitted waves."""

    front: Annotated[tuple[GaugeEntry, ...], Field(min_length=2, max_length=50)] = Field(
        description="Two gauges or more in front of the structure."
    )
    behind: tuple[GaugeEntry, ...] = Field(default=(), max_length=50, description="Gauges behind it.")


class RecordsFile(Block):
    """A file of ``moyai measure records``."""

    moyai: Literal[1] = Field(description="Version of the file format.")
    title: str = Field(default="Records", max_length=200, description="Title of the report.")
    loggers: Annotated[tuple[LoggerKeys, ...], Field(min_length=1, max_length=50)] = Field(description="The loggers.")
    blocks: BlockKeys = Field(description="Blocks of time.")
    site: RecordSite | None = Field(default=None, description="Water; needed for directions, pressures and reflection.")
    structure_normal_deg: Heading | None = Field(default=None, description="Heading of the structure's normal.")
    quality: QualityKeys = Field(default=QualityKeys(), description="Limits of the quality control.")
    waves: WaveKeys | None = Field(default=None, description="Waves by zero crossing.")
    spectrum: SpectrumKeys | None = Field(default=None, description="Spectra.")
    directions: DirectionKeys | None = Field(default=None, description="Directions.")
    current: CurrentKeys | None = Field(default=None, description="Currents.")
    tensions: TensionKeys | None = Field(default=None, description="Tensions.")
    responses: ResponseKeys | None = Field(default=None, description="Response functions with coherence.")
    reflection: ReflectionKeys | None = Field(default=None, description="Reflection and transmission.")

    @classmethod
    def _between_keys(cls, data: dict[str, Any]) -> list[tuple[str, str, str]]:
        faults = list(super()._between_keys(data))
        for key, needs in (
            ("directions", ("site", "spectrum")),
            ("reflection", ("site", "spectrum")),
            ("tensions", ("waves",)),
            ("responses", ("spectrum",)),
        ):
            for other in needs:
                if data.get(key) is not None and data.get(other) is None:
                    faults.append((key, f"'{key}' needs '{other}'", f"give '{other}'"))
        return faults
