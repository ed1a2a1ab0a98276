"""How the analyses of a breakwater are run: blocks of the case file that the analyses read as they are, in SI units."""

from __future__ import annotations

from typing import Annotated, Any, Literal

import numpy as np
from pydantic import AfterValidator, Discriminator, Field, Tag

from moyai.case.schema_types import (
    LEVEL_NAMES,
    AngularFrequency,
    Auto,
    AutoDuration,
    Block,
    Fraction,
    Length,
    LevelNames,
    NonNegativeNumber,
    PositiveNumber,
    Range,
    Truth,
    Whole,
    once_each,
)
from moyai.core.arrays import Array

Mode = Literal["sway", "heave", "roll"]
MODES: tuple[Mode, ...] = ("sway", "heave", "roll")
Analysis = Literal["statics", "mooring", "frequency", "time"]
ANALYSES: tuple[Analysis, ...] = ("statics", "mooring", "frequency", "time")


class FrequencyRange(Range):
    """Evenly spaced angular frequencies."""

    first: AngularFrequency = Field(alias="from", description="First angular frequency.")
    last: AngularFrequency = Field(alias="to", description="Last angular frequency.")


class OffsetRange(Range):
    """Evenly spaced offsets."""

    first: Length = Field(alias="from", description="First offset.")
    last: Length = Field(alias="to", description="Last offset.")


def _form(value: Any) -> str:
    if isinstance(value, str) or value is None:
        return "<word>"
    return "<range>" if isinstance(value, (dict, Range)) else "<list>"


def _word_or_number(value: Any) -> str:
    return "<word>" if isinstance(value, str) or value is None else "<number>"


class LineDynamics(Block):
    """When lines are in motion, how they are cut, what the bed takes, and what counts as slack and as snap."""

    mode: Literal["auto", "quasi_static", "dynamic"] = Field(
        default="auto",
        description=(
            "Lines without 'dynamic: true': in motion around the largest events of the line that governs an irregular "
            "sea, and where peaks pass five times the mean (auto), at rest at every instant (quasi_static), "
            "in motion from the start (dynamic)."
        ),
    )
    bars: Annotated[int, Field(strict=True, ge=4, le=2000)] = Field(
        default=30, description="Straight bars that each line is cut into. Default: 30."
    )
    damping_ratio: NonNegativeNumber = Field(
        default=0.1,
        description="Internal damping BA of the material over bar length times sqrt(EA m), at this number of bars.",
    )
    bed_stiffness: PositiveNumber | None = Field(
        default=None,
        description="Stiffness of the bed per contact area, Pa/m. Default: the line sinks a fiftieth of its diameter.",
    )
    bed_damping: NonNegativeNumber | None = Field(
        default=None, description="Normal damping of the bed per contact area, Pa s/m. Default: half of critical."
    )
    slack_fraction: NonNegativeNumber = Field(
        default=0.05, description="Tension over that at rest under which a line is taken as slack. Default: 0.05."
    )
    snap_fraction: PositiveNumber = Field(
        default=3.0, description="Peak over the tension at rest from which a contact is a snap. Default: 3."
    )
    sensitivity: Truth = Field(
        default=False,
        description="Whether each run is repeated with twice the bars, half the step, twice the internal damping.",
    )


class TimeSettings(Block):
    """How the time domain is run."""

    duration: AutoDuration = Field(default=None, description="Simulated time in regular waves. Default: auto.")
    ramp: AutoDuration = Field(default=None, description="Length of the ramp of the waves. Default: auto.")
    time_step: AutoDuration = Field(default=None, description="Time step. Default: auto.")
    analysed_periods: Whole = Field(
        default=10, description="Whole periods at the end that are analysed in regular waves. Default: 10."
    )
    drift: Literal["auto", "ramped", "pulsating", "newman", "none"] = Field(
        default="auto",
        description=(
            "Drift force in time: mean under the ramp, F(1 + cos 2wt), slow drift after Newman, none; auto: newman in "
            "irregular seas, ramped in regular waves."
        ),
    )
    realisations: Annotated[
        Annotated[Auto, Tag("<word>")] | Annotated[int, Field(strict=True, ge=1, le=100), Tag("<number>")],
        Discriminator(_word_or_number),
    ] = Field(
        default="auto",
        description=(
            "Realisations of each irregular sea, the first with its 'seed'; numbers are means over them. Default: "
            "auto, 5, or 1 where lines are in motion from the start."
        ),
    )
    memory: Literal["state_space", "convolution"] = Field(
        default="state_space", description="Wave memory by a rational approximation or by convolution."
    )
    lines: LineDynamics = Field(default_factory=LineDynamics, description="Lines in motion.")


class Sensitivity(Block):
    """Variations that are run in addition to the case."""

    damping_fractions: Annotated[tuple[Fraction, ...], Field(max_length=50), AfterValidator(once_each)] = Field(
        default=(), description="Fractions of critical damping."
    )
    line_slacks: Annotated[tuple[Length, ...], Field(max_length=50), AfterValidator(once_each)] = Field(
        default=(), description="Line length less the chord from anchor to fairlead."
    )
    line_counts: Annotated[tuple[Whole, ...], Field(max_length=50), AfterValidator(once_each)] = Field(
        default=(), description="Total number of lines, shared alike."
    )


class BreakwaterSettings(Block):
    """How the analyses are run."""

    drift: Truth = Field(default=True, description="Whether the mean drift force acts. Default: true.")
    frequencies: Annotated[
        Annotated[Auto, Tag("<word>")]
        | Annotated[tuple[AngularFrequency, ...], Field(min_length=1, max_length=10_000), Tag("<list>")]
        | Annotated[FrequencyRange, Tag("<range>")],
        Discriminator(_form),
    ] = Field(default="auto", description="Angular frequencies of the motions: auto, a list, or {from, to, count}.")
    restoring_offsets: Annotated[
        Annotated[Auto, Tag("<word>")]
        | Annotated[tuple[Length, ...], Field(min_length=2, max_length=10_000), Tag("<list>")]
        | Annotated[OffsetRange, Tag("<range>")],
        Discriminator(_form),
    ] = Field(default="auto", description="Sway offsets of the restoring curve: auto, a list, or {from, to, count}.")
    line_restoring: Literal["tangent", "equivalent"] = Field(
        default="tangent",
        description=(
            "Force of lines in regular waves of the frequency domain: their tangent about the mean offset, or the "
            "first harmonic of lines that are led along the motion (equivalent). Variations keep the tangent. "
            "Default: tangent."
        ),
    )
    time: TimeSettings = Field(default_factory=TimeSettings, description="How the time domain is run.")
    sensitivity: Sensitivity = Field(
        default_factory=Sensitivity, description="Variations that are run in addition to the case."
    )
    water_levels: LevelNames = Field(default="all", description=LEVEL_NAMES)

    def angular_frequencies(self) -> Array | None:
        """Return the user's angular frequencies [rad/s], or ``None``."""
        return _values(self.frequencies)

    def offsets(self) -> Array | None:
        """Return the user's sway offsets of the restoring curve [m], or ``None``."""
        return _values(self.restoring_offsets)


def _values(given: Any) -> Array | None:
    """Return the values of a list or a range, ``None`` for ``auto``."""
    if isinstance(given, str):
        return None
    if isinstance(given, FrequencyRange | OffsetRange):
        given = given.spread(given.first, given.last, given.count)
    return np.asarray(given, dtype=float)
