"""Schema of the file that says what a force record was taken on: for ``moyai measure forces``."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import AfterValidator, Field

from moyai.case.schema_types import (
    AutoDuration,
    Block,
    Density,
    Depth,
    Gravity,
    Length,
    PositiveLength,
    QuantityOf,
    Seed,
    Truth,
    once_each,
)
from moyai.core import quantities
from moyai.structures.member.case.schema import MemberSection

Names = Annotated[tuple[Annotated[str, Field(min_length=1)], ...], Field(min_length=1, max_length=2)]
PhaseError = Annotated[float, QuantityOf(quantities.ANGLE_DEGREES, least=0.0, most=20.0)]
Confidence = Annotated[float, QuantityOf(quantities.NUMBER, least=0.5, below=1.0)]
Harmonic = Annotated[int, Field(strict=True, ge=2, le=20)]
Draws = Annotated[int, Field(strict=True, ge=50, le=100_000)]
Axis = Literal["first", "second"]


class RecordColumns(Block):
    """Columns of the record."""

    time: Annotated[str, Field(min_length=1)] = Field(default="time", description="Column of the time. Default: time.")
    force: Names = Field(description="Columns of the force, one or two components.", examples=[["force_x", "force_z"]])
    velocity: Names | None = Field(
        default=None, description="Columns of the velocity of the water at the axis of the member; or give 'gauge'."
    )
    acceleration: Names | None = Field(
        default=None, description="Columns of the acceleration; found from the velocity when absent."
    )


class WaveGauge(Block):
    """A wave gauge in place of measured velocities: linear theory carries its record to the member."""

    elevation: Annotated[str, Field(min_length=1)] = Field(description="Column of the surface elevation.")
    water_depth: Depth = Field(description="Water depth, or 'infinite'.")
    gravity: Gravity = Field(description="Acceleration of gravity.")
    member_z: Length = Field(description="Height of the axis of the member above still water, negative.")
    distance_to_member: Length = Field(
        default=0.0, description="From the gauge to the member in the direction of the waves. Default: 0."
    )


class ForceRecordFile(Block):
    """What a force record was taken on, and how it is to be read."""

    moyai: Literal[1] = Field(description="Version of the format.")
    title: Annotated[str, Field(min_length=1, max_length=200)] = Field(description="Title of the report.")
    density: Density = Field(description="Density of the water.")
    section: MemberSection = Field(description="Section of the member: gives area, widths and the ideal C_M.")
    length: PositiveLength | None = Field(
        default=None, description="Length that the force was measured on; the force is per length when absent."
    )
    columns: RecordColumns = Field(description="Columns of the record.")
    gauge: WaveGauge | None = Field(default=None, description="Wave gauge, where no velocity was measured.")
    axes: Annotated[tuple[Axis, ...], Field(min_length=1, max_length=2), AfterValidator(once_each)] = Field(
        default=("first", "second"), description="Axis of the section of each component. Default: [first, second]."
    )
    regular: Truth = Field(default=True, description="Whether the waves are regular. Default: true.")
    period: AutoDuration = Field(default=None, description="Period of regular waves; auto finds it. Default: auto.")
    drag_form: Literal["component", "vector"] = Field(default="component", description="Drag u|u|, or u|U|.")
    methods: (
        Annotated[
            tuple[Literal["fourier", "least_squares", "force_weighted", "robust"], ...],
            Field(min_length=1),
            AfterValidator(once_each),
        ]
        | None
    ) = Field(default=None, description="Methods. Default: all four, of irregular records all but fourier.")
    harmonics: Annotated[tuple[Harmonic, ...], AfterValidator(once_each)] = Field(
        default=(), description="Harmonics of the force fitted together with Morison's equation, such as [2, 3]."
    )
    phase_error_deg: PhaseError = Field(description="Standard error of the phase between force and velocity.")
    confidence: Confidence = Field(default=0.95, description="Probability that the intervals cover. Default: 0.95.")
    bootstrap: Draws = Field(default=400, description="Number of bootstrap samples. Default: 400.")
    seed: Seed = Field(default=1, description="Seed of the bootstrap.")
