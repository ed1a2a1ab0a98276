"""Schema of rigid bodies in a network: boxes, cylinders, bodies of rods and volumes, with their coefficients."""

from __future__ import annotations

from typing import Annotated, ClassVar, Literal

from pydantic import AfterValidator, Field

from moyai.case.schema_coefficients import OfCapytaine, OfNemoh, OfWamit
from moyai.case.schema_types import (
    AddedInertia,
    AddedMass,
    Block,
    FileName,
    Inertia,
    KeyGroups,
    Length,
    Mass,
    Name,
    NonNegativeNumber,
    PositiveLength,
    QuantityOf,
    Truth,
    Volume,
    once_each,
)
from moyai.core import quantities
from moyai.structures.network.case.schema_parts import Angles, Area, Shift

Moments = tuple[Inertia, Inertia, Inertia]
Coefficients = tuple[NonNegativeNumber, NonNegativeNumber, NonNegativeNumber]
BodyMotion = Literal["surge", "sway", "heave", "roll", "pitch", "yaw"]


class _BodyCoefficients(Block):
    path: FileName = Field(description="File or folder of the program, relative to the case file.")
    draught: PositiveLength = Field(
        description="Draught of the upright body for which they were computed; displaced volume and hydrostatics are "
        "those of its shape there."
    )
    origin: tuple[Length, Length] = Field(
        default=(0.0, 0.0), description="Origin of the axes of the file, x and y from the middle. Default: [0, 0]."
    )
    memory: Truth = Field(
        default=True, description="Whether what the body radiated still pushes at it; false: it radiates nothing."
    )


class CapytaineBody(OfCapytaine, _BodyCoefficients):
    """Coefficients computed by Capytaine."""


class WamitBody(OfWamit, _BodyCoefficients):
    """Coefficients computed by WAMIT or written in its form."""


class NemohBody(OfNemoh, _BodyCoefficients):
    """Coefficients computed by NEMOH."""


BodyCoefficients = Annotated[CapytaineBody | WamitBody | NemohBody, Field(discriminator="program")]


class _BodyKeys(Block):
    exactly_one: ClassVar[KeyGroups] = (("inertia", "gyration_radii"), ("added_mass", "coefficients_file"))

    mass: Mass = Field(description="Mass.")
    inertia: Moments | None = Field(
        default=None, description="Moments of inertia about the centre of gravity: roll, pitch, yaw."
    )
    gyration_radii: tuple[PositiveLength, PositiveLength, PositiveLength] | None = Field(
        default=None, description="Radii of gyration about the centre of gravity: roll, pitch, yaw."
    )
    centre_of_gravity: Shift = Field(default=(0.0, 0.0, 0.0), description="From the middle of the body. Default: 0.")
    position: Shift = Field(description="Of its middle at the start: x, y, z above still water.")
    rotation_deg: Angles = Field(default=(0.0, 0.0, 0.0), description="Roll, pitch, yaw at the start. Default: 0.")
    points: Annotated[dict[Name, Shift], Field(min_length=1, max_length=1000)] = Field(
        description="Points that lines meet, by name, from the middle of the body.",
        examples=[{"bow": ["10 m", 0, "-1 m"]}],
    )
    drag: Coefficients = Field(description="Drag coefficients along its axes x, y, z, on its faces.")
    added_mass: Coefficients | None = Field(
        default=None,
        description="Added-mass coefficients along its axes, on the displaced mass: loads of a body that is small "
        "in addition to the waves, under the moving surface.",
    )
    coefficients_file: BodyCoefficients | None = Field(
        default=None,
        description="Coefficients of a 3-D program in their place: diffraction, radiation with its memory, linear "
        "hydrostatics.",
    )
    held: Annotated[tuple[BodyMotion, ...], Field(max_length=5), AfterValidator(once_each)] = Field(
        default=(), description="Motions that are held. Default: none."
    )


class BoxBody(_BodyKeys):
    """A box."""

    shape: Literal["box"] = Field(description="A box, partly immersed at the surface.")
    size: tuple[PositiveLength, PositiveLength, PositiveLength] = Field(description="Along x, y, z of the body.")


class CylinderBody(_BodyKeys):
    """An upright cylinder."""

    shape: Literal["cylinder"] = Field(description="A cylinder about its z axis, partly immersed at the surface.")
    diameter: PositiveLength = Field(description="Diameter.")
    height: PositiveLength = Field(description="Height.")


ThreeAreas = tuple[Area, Area, Area]
TurningDrag = Annotated[
    float, QuantityOf(quantities.QuantityKind("a drag of turns", "m^5", "metres to the fifth", "2 m^5"), least=0.0)
]


class BodyRod(Block):
    """A round rod along one of the axes of its body, of even mass."""

    start: Shift = Field(description="One end, in the axes of the body.")
    end: Shift = Field(description="The other end; along x, y or z from the start.")
    diameter: PositiveLength = Field(description="Diameter.")
    mass: Annotated[float, QuantityOf(quantities.MASS_PER_LENGTH, least=0.0)] = Field(
        description="Mass in air per length."
    )
    drag_normal: NonNegativeNumber = Field(description="Drag coefficient across, on the diameter.")
    added_mass_normal: NonNegativeNumber = Field(description="Added-mass coefficient across, on the volume.")
    drag_end: NonNegativeNumber = Field(default=0.0, description="Drag coefficient of each end, on its face.")
    added_mass_end: NonNegativeNumber = Field(
        default=0.0, description="Added-mass coefficient of each end, on half a sphere of water. Default: 0."
    )
    slices: Annotated[int, Field(strict=True, ge=1, le=10_000)] = Field(
        default=24, description="Slices of the body for loads of the water; at least 24. Default: 24."
    )


class BodyVolume(Block):
    """A mass and a volume at one place of a body, wet wherever it is."""

    position: Shift = Field(default=(0.0, 0.0, 0.0), description="In the axes of the body. Default: their origin.")
    mass: AddedMass = Field(default=0.0, description="Mass in air. Default: 0.")
    volume: Volume = Field(default=0.0, description="Displaced volume. Default: 0.")
    drag_area: ThreeAreas = Field(
        default=(0.0, 0.0, 0.0), description="Drag coefficient times area along x, y, z of the body. Default: 0."
    )
    added_mass_coefficient: Coefficients = Field(
        default=(0.0, 0.0, 0.0), description="On the volume, along x, y, z of the body. Default: 0."
    )


class AssembledBody(Block):
    """A body put together from rods and volumes; all places in its own axes, whose origin may be anywhere in it."""

    shape: Literal["assembly"] = Field(description="An assembly of rods and volumes.")
    mass: AddedMass = Field(default=0.0, description="Mass without rods and volumes. Default: 0.")
    inertia: tuple[AddedInertia, AddedInertia, AddedInertia] | None = Field(
        default=None, description="Moments of inertia of that mass about its centre: roll, pitch, yaw. Default: 0."
    )
    centre_of_gravity: Shift = Field(default=(0.0, 0.0, 0.0), description="Centre of that mass. Default: the origin.")
    position: Shift = Field(description="Of the origin at the start: x, y, z above still water.")
    rotation_deg: Angles = Field(default=(0.0, 0.0, 0.0), description="Roll, pitch, yaw at the start. Default: 0.")
    points: Annotated[dict[Name, Shift], Field(max_length=1000)] = Field(
        default={}, description="Points that lines meet, by name. Default: none."
    )
    rods: tuple[BodyRod, ...] = Field(default=(), description="Rods.", max_length=1000)
    volumes: tuple[BodyVolume, ...] = Field(default=(), description="Masses and volumes.", max_length=1000)
    turning_drag: tuple[TurningDrag, TurningDrag, TurningDrag] = Field(
        default=(0.0, 0.0, 0.0),
        description="Drag of turns about its axes: coefficient times area times arm squared. Default: 0.",
    )
    pin: Shift | None = Field(default=None, description="Place that stays where it is: the body turns about it.")
    held: Annotated[tuple[BodyMotion, ...], Field(max_length=5), AfterValidator(once_each)] = Field(
        default=(), description="Motions that are held. Default: none."
    )


NetworkBody = Annotated[BoxBody | CylinderBody | AssembledBody, Field(discriminator="shape")]
