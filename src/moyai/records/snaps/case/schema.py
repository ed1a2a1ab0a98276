"""Schema of a file of ``moyai measure snaps``: the flume, cables, and runs of a curtain that snaps taut."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from moyai.case.schema_types import (
    Block,
    Density,
    Gravity,
    Name,
    NonNegativeNumber,
    PositiveForce,
    PositiveLength,
    QuantityOf,
    Truth,
)
from moyai.core import quantities
from moyai.structures.curtain.case.schema import RecordKeys

PositiveSpeed = Annotated[float, QuantityOf(quantities.SPEED, above=0.0)]
SheetStiffness = Annotated[float, QuantityOf(quantities.FORCE_PER_LENGTH, above=0.0)]
Chord = Annotated[float, QuantityOf(quantities.NUMBER, above=0.0, below=1.0)]


class CablePair(Block):
    """The material of the two cables."""

    name: Name = Field(description="Name of the material.", examples=["fishing line"])
    upper: PositiveForce = Field(description="Axial stiffness EA of the upper cable.")
    lower: PositiveForce = Field(description="Axial stiffness EA of the lower cable.")


class Sheet(Block):
    """The skirt, where models that let it stretch are wanted."""

    stiffness: SheetStiffness = Field(description="Young's modulus times thickness.")
    chord_ratio: Chord = Field(
        description="Straight distance of the edges over the skirt's depth when it becomes taut."
    )


class SnapRunBlock(RecordKeys):
    """One release: its record, and what was varied."""

    name: Name = Field(description="Name of the run.")
    current: PositiveSpeed = Field(description="Speed of the steady current.")
    draught: PositiveLength = Field(description="Depth d of the skirt.")
    length: PositiveLength = Field(description="Unstretched length l of cables and skirt along the span.")
    cable: Name = Field(description="Material of the cables, by its name.")
    span: PositiveLength | None = Field(default=None, description="Distance B of the supports, where the run differs.")
    water_depth: PositiveLength | None = Field(default=None, description="Water depth, where the run differs.")


class SnapRunsFile(Block):
    """A file of ``moyai measure snaps``."""

    moyai: Literal[1] = Field(description="Version of the format.")
    title: Annotated[str, Field(min_length=1, max_length=200)] = Field(description="Title of the report.")
    origin: Literal["measured", "generated"] = Field(
        description="Whether the records were measured or computed; the report states it."
    )
    density: Density = Field(description="Density of the water.")
    gravity: Gravity = Field(description="Acceleration of gravity.")
    water_depth: PositiveLength = Field(description="Water depth h.")
    span: PositiveLength = Field(description="Distance B of the supports.")
    drag_coefficient: NonNegativeNumber | None = Field(
        default=None,
        description="C_D of the skirt: models start with the speed that the drift of the slack curtain reaches, not "
        "with that of the current.",
    )
    skirt: Sheet | None = Field(default=None, description="Skirt; adds the models in which it stretches.")
    memory: Truth = Field(default=True, description="Whether to run the model with the waves it makes. Default: true.")
    cables: Annotated[tuple[CablePair, ...], Field(min_length=1, max_length=20)] = Field(description="Cables.")
    runs: Annotated[tuple[SnapRunBlock, ...], Field(min_length=3, max_length=1000)] = Field(description="Releases.")
