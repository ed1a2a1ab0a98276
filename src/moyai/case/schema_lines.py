"""Schema of mooring lines: chains and ropes of several segments, and the springs of laboratory moorings."""

from __future__ import annotations

import itertools
from typing import Annotated, Any, ClassVar, Literal

from pydantic import AfterValidator, Discriminator, Field, Tag

from moyai.case.schema_types import (
    COMPONENT,
    AddedMass,
    AxialStiffness,
    Block,
    Force,
    KeyGroups,
    Length,
    LineComponent,
    MassPerLength,
    Name,
    NonNegativeLength,
    NonNegativeNumber,
    PositiveForce,
    PositiveLength,
    PositiveMassPerLength,
    Stiffness,
    Truth,
    Volume,
    WeightPerLength,
    Whole,
    holds_key,
    refuse,
)


class Fairlead(Block):
    """Where a line meets the body, in body axes."""

    x: Length = Field(description="From the centre line of the section, positive along +x.")
    above_keel: Length = Field(description="Height above the keel.")
    y: Length = Field(default=0.0, description="Along the unit, from its middle. Default: 0.")


class Anchor(Block):
    """Where a line meets the bed."""

    x: Length = Field(description="From the centre line of the body at rest, positive along +x.")
    y: Length = Field(default=0.0, description="Along the unit, from its middle. Default: 0.")
    above_bed: NonNegativeLength = Field(default=0.0, description="Height above the bed. Default: 0.")


class FixedPoint(Block):
    """Where a spring is held."""

    x: Length = Field(description="From the centre line of the body at rest, positive along +x.")
    y: Length = Field(default=0.0, description="Along the unit, from its middle. Default: 0.")
    z: Length = Field(description="Height from still water at datum, negative under it.")


class CatalogueSegment(Block):
    """A length of chain or rope from the catalogue."""

    catalogue: str = Field(
        description="Name of the line type in the catalogue.", examples=["studless_chain_R3"], min_length=1
    )
    diameter: PositiveLength = Field(description="Nominal diameter.")
    length: PositiveLength = Field(description="Unstretched length.")


class OwnSegment(Block):
    """A length of line with its own properties."""

    exactly_one: ClassVar[KeyGroups] = (("submerged_weight", "submerged_mass"),)

    length: PositiveLength = Field(description="Unstretched length.")
    submerged_weight: WeightPerLength | None = Field(
        default=None, description="Weight in water per length; negative for a buoyant rope."
    )
    submerged_mass: MassPerLength | None = Field(
        default=None, description="Weight in water over gravity, per length; negative for a buoyant rope."
    )
    mass: PositiveMassPerLength | None = Field(
        default=None, description="Mass in air per length; lines at rest do not need it."
    )
    axial_stiffness: AxialStiffness = Field(description="EA, or 'inextensible'.")
    breaking_load: PositiveForce | None = Field(
        default=None, description="Minimum breaking load; without it no utilisation is shown."
    )
    diameter: PositiveLength | None = Field(
        default=None, description="Nominal diameter; the drag and the contact with the bed of a line in motion need it."
    )
    drag_normal: NonNegativeNumber | None = Field(
        default=None, description="Drag coefficient across the line on its diameter; a line in motion needs it."
    )
    drag_tangential: NonNegativeNumber | None = Field(
        default=None, description="Drag coefficient along the line on its diameter; a line in motion needs it."
    )
    added_mass_normal: NonNegativeNumber | None = Field(
        default=None, description="Added mass across the line over the displaced mass; a line in motion needs it."
    )
    added_mass_tangential: NonNegativeNumber = Field(
        default=0.0, description="Added mass along the line over the displaced mass. Default: 0."
    )
    name: Name | None = Field(default=None, description="Name of the material in reports.")
    component: LineComponent | None = Field(default=None, description=COMPONENT)


class ClumpKeys(Block):
    """A weight or buoy between two segments."""

    mass: AddedMass = Field(description="Mass in air.")
    volume: Volume = Field(description="Displaced volume; a buoy displaces more than it weighs.")


class ClumpEntry(Block):
    """A weight or buoy between two segments."""

    clump: ClumpKeys = Field(description="Weight or buoy between the segments before and after it.")


def _segment_form(value: Any) -> str:
    if isinstance(value, dict):
        return next((f"<{form}>" for form in ("catalogue", "clump") if holds_key(value, form)), "<own>")
    if isinstance(value, CatalogueSegment):
        return "<catalogue>"
    return "<clump>" if isinstance(value, ClumpEntry) else "<own>"


SegmentEntry = Annotated[
    Annotated[CatalogueSegment, Tag("<catalogue>")]
    | Annotated[ClumpEntry, Tag("<clump>")]
    | Annotated[OwnSegment, Tag("<own>")],
    Discriminator(_segment_form),
]


def _clumps_between(entries: tuple[Any, ...]) -> tuple[Any, ...]:
    kinds = [isinstance(entry, ClumpEntry) for entry in entries]
    if kinds[0] or kinds[-1]:
        raise refuse("a clump is at the end of the line", allowed="clumps between two segments")
    if any(a and b for a, b in itertools.pairwise(kinds)):
        raise refuse("two clumps follow each other", remedy="join them into one")
    return entries


class CatenaryLine(Block):
    """Identical lines of chain or rope between the bed and the body."""

    kind: Literal["catenary"] = Field(default="catenary", description="Chain or rope; this is the default.")
    name: Name = Field(description="Name of the line in results.")
    count: Whole = Field(default=1, description="Number of identical lines. Default: 1.")
    fairlead: Fairlead = Field(description="Where the line meets the body.")
    anchor: Anchor = Field(description="Where the line meets the bed.")
    segments: Annotated[
        tuple[SegmentEntry, ...], Field(min_length=1, max_length=100), AfterValidator(_clumps_between)
    ] = Field(description="From the anchor to the fairlead: segments, with clumps between them.")
    bed_friction: NonNegativeNumber = Field(
        default=0.0, description="Coulomb coefficient of the line on the bed. Default: 0."
    )
    drag_width: NonNegativeLength = Field(
        default=0.0,
        description=(
            "Drag coefficient across the line times its drag diameter, for the damping that the drag of the line gives "
            "the unit; chain about 2.4 nominal diameters. A line with dynamic: true takes that of its segments where "
            "none is given. Default: 0, none."
        ),
    )
    dynamic: Truth = Field(
        default=False,
        description=(
            "Whether the line is in motion in the analysis 'time': mass, drag, slack and snap. Segments of their own "
            "then need mass, diameter, drag_normal, drag_tangential, added_mass_normal. Default: false, at rest at "
            "every instant."
        ),
    )


class SpringLineKeys(Block):
    """Identical linear springs between a fixed point and the body."""

    kind: Literal["spring"] = Field(description="Linear spring, as in laboratory moorings.")
    name: Name = Field(description="Name of the spring in results.")
    count: Whole = Field(default=1, description="Number of identical springs. Default: 1.")
    fairlead: Fairlead = Field(description="Where the spring meets the body.")
    anchor: FixedPoint = Field(description="Where the spring is held.")
    stiffness: Stiffness = Field(description="Spring constant.")
    pretension: Force = Field(description="Tension at rest.")


def _line_form(value: Any) -> str:
    if isinstance(value, dict):
        return f"<{value.get('kind', 'catenary')}>"
    return "<spring>" if isinstance(value, SpringLineKeys) else "<catenary>"


LineEntry = Annotated[
    Annotated[CatenaryLine, Tag("<catenary>")] | Annotated[SpringLineKeys, Tag("<spring>")], Discriminator(_line_form)
]
