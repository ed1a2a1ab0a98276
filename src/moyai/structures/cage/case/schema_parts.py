"""Schema of the parts of a rigid net cage: shape, net, frame, floats, sinkers, weight, mooring lines."""

from __future__ import annotations

from typing import Annotated, ClassVar, Literal

from pydantic import Field

from moyai.case.schema_types import (
    AddedMass,
    Block,
    Damping,
    Density,
    Force,
    KeyGroups,
    Length,
    Mass,
    Name,
    NonNegativeLength,
    NonNegativeNumber,
    PositiveForce,
    PositiveLength,
    QuantityOf,
    Stiffness,
    Truth,
    Volume,
    WeightPerLength,
)
from moyai.core import quantities

Solidity = Annotated[float, QuantityOf(quantities.NUMBER, above=0.0, below=1.0)]
MassPerArea = Annotated[float, QuantityOf(quantities.MASS_PER_AREA, least=0.0)]
Share = Annotated[float, QuantityOf(quantities.NUMBER, least=0.0, most=1.0)]
Several = Annotated[int, Field(strict=True, ge=1, le=1000)]


class BoxShape(Block):
    """A box, two faces of it across the waves."""

    kind: Literal["box"] = Field(description="Box.")
    length: PositiveLength = Field(description="Along x, the way the waves run.")
    width: PositiveLength = Field(description="Along y.")
    height: PositiveLength = Field(description="Upwards, from the bottom net to the top frame.")


class CylinderShape(Block):
    """An upright cylinder."""

    kind: Literal["cylinder"] = Field(description="Upright cylinder.")
    diameter: PositiveLength = Field(description="Diameter.")
    height: PositiveLength = Field(description="Upwards, from the bottom net to the top ring.")


RigidShape = Annotated[BoxShape | CylinderShape, Field(discriminator="kind")]


class NetDrag(Block):
    """Drag of the net by a law of the literature."""

    law: Annotated[str, Field(min_length=1)] = Field(
        description="Name of the law; `matsubara` is C_d = 9.84 Re^-0.36 of the net's projected area.",
        examples=["matsubara"],
    )
    solidity: Literal["listed", "geometric"] | None = Field(
        default=None, description="Which solidity `matsubara` takes; listed when absent, as its authors did."
    )
    tangential_share: Share | None = Field(
        default=None, description="Of `matsubara`: drag of flow along the net over that across it; 0.25 when absent."
    )
    cap: NonNegativeNumber | None = Field(
        default=None, description="Of `matsubara`: largest C_d, below its range; 3 when absent."
    )


class RigidNet(Block):
    """The net: twine, mesh, mass, drag."""

    exactly_one: ClassVar[KeyGroups] = (("mesh_pitch", "aperture", "solidity"),)

    faces: Annotated[tuple[Literal["sides", "bottom", "top"], ...], Field(min_length=1)] = Field(
        default=("sides", "bottom"), description="Faces that carry net. Default: sides and bottom."
    )
    twine_diameter: PositiveLength = Field(description="Diameter of the twine d.")
    mesh_pitch: PositiveLength | None = Field(default=None, description="Twine to twine, centre to centre.")
    aperture: PositiveLength | None = Field(default=None, description="Clear opening between two twines.")
    solidity: Solidity | None = Field(
        default=None, description="Geometric solidity: projected twine area over outline area."
    )
    solidity_listed: Solidity | None = Field(
        default=None, description="Solidity as a paper lists it, for its law; geometric when absent."
    )
    knotted: Truth = Field(default=False, description="Whether the meshes are knotted. Default: false.")
    mass_per_area: MassPerArea = Field(description="Mass in air per outline area; 0 for a net without mass.")
    density: Density | None = Field(
        default=None, description="Density of the twine material; gives the solid volume from the mass."
    )
    added_mass: NonNegativeNumber = Field(default=1.0, description="C_a of twine. Default: 1.")
    drag: NetDrag = Field(description="Drag law.")
    wake: Literal["none", "loland", "cheng"] = Field(
        default="none",
        description="Shelter behind the upstream wall from the current (not from waves). loland: r = 1 - 0.46 C_D. "
        "Default: none.",
    )


class RigidFrame(Block):
    """Round rods along all edges of the shape."""

    at_most_one: ClassVar[KeyGroups] = (("density", "mass"),)

    diameter: NonNegativeLength = Field(description="Diameter of the rods; 0 for none.")
    density: Density | None = Field(default=None, description="Density of the rods, which gives their mass.")
    mass: AddedMass | None = Field(
        default=None, description="Mass of all rods; what `weight` leaves over when neither is given."
    )
    drag: NonNegativeNumber = Field(default=1.2, description="C_d of flow across a rod. Default: 1.2.")
    added_mass: NonNegativeNumber = Field(default=1.0, description="C_a of flow across a rod. Default: 1.")


class RigidFloats(Block):
    """Spheres on the top frame."""

    exactly_one: ClassVar[KeyGroups] = (("per_side", "count"),)

    diameter: PositiveLength = Field(description="Diameter of a float.")
    mass: AddedMass = Field(description="Mass of one float.")
    per_side: Several | None = Field(
        default=None, description="Floats on every side of a box, each in the middle of its share of the side."
    )
    count: Several | None = Field(default=None, description="Floats around the top ring of a cylinder, evenly.")
    above_top: Length = Field(default=0.0, description="Height of their centres above the top frame. Default: 0.")
    drag: NonNegativeNumber = Field(default=0.6, description="C_d of a float. Default: 0.6.")
    added_mass: NonNegativeNumber = Field(default=0.5, description="C_a of a float. Default: 0.5, a sphere.")


class SinkerKeys(Block):
    """A weight fixed to the cage, mirrored about the plane of the waves."""

    name: Name | None = Field(default=None, description="Label.")
    x: Length = Field(default=0.0, description="From the middle of the cage. Default: 0.")
    z: Length = Field(description="Height above the middle of the cage, negative under it.")
    mass: Mass = Field(description="Mass in air.")
    volume: Volume = Field(description="Displaced volume.")
    drag: NonNegativeNumber = Field(default=0.6, description="C_d of a sphere of that volume. Default: 0.6.")
    added_mass: NonNegativeNumber = Field(default=0.5, description="C_a of a sphere of that volume. Default: 0.5.")


class RigidWeight(Block):
    """The weight of the cage as somebody weighed it."""

    mass: Mass = Field(description="Mass in air, sinkers left out.")
    floats_included: Truth = Field(description="Whether the figure includes the floats.")


class _Elastic(Block):
    exactly_one: ClassVar[KeyGroups] = (("stiffness", "axial_stiffness"),)

    stiffness: Stiffness | None = Field(default=None, description="Of line and gauge together, force per length.")
    axial_stiffness: Annotated[float, QuantityOf(quantities.FORCE, above=0.0)] | None = Field(
        default=None, description="EA of the line; its stiffness is EA over its length."
    )
    gauge_stiffness: Stiffness | None = Field(
        default=None, description="Of the tension gauge, in series with EA; rigid when absent."
    )
    damping: Damping = Field(default=0.0, description="Force over speed of lengthening of a taut line. Default: 0.")
    submerged_weight: WeightPerLength = Field(
        default=0.0,
        description="Weight in water per length; sets the tension of one end against the other. Default: 0.",
    )
    breaking_load: PositiveForce | None = Field(default=None, description="Breaking load, for the utilisation.")


class PairMooring(_Elastic):
    """Two lines, mirror images of each other at rest."""

    exactly_one: ClassVar[KeyGroups] = (
        *_Elastic.exactly_one,
        ("pull_down", "pretension", "slack", "length"),
    )

    kind: Literal["crossed_top", "outward_bottom", "outward_middle", "outward_top"] = Field(
        description="crossed_top: from the top corners to the opposite anchors; outward_...: from corners or middles "
        "of the sides to the anchors on the same side."
    )
    anchor_distance: PositiveLength = Field(description="Distance of each anchor from the middle of the cage at rest.")
    anchor_above_bed: NonNegativeLength = Field(default=0.0, description="Height of the anchors. Default: 0.")
    pull_down: PositiveLength | None = Field(
        default=None, description="How far the lines pull the cage under its free floating position."
    )
    pretension: PositiveForce | None = Field(default=None, description="Tension of each line at rest.")
    slack: NonNegativeLength | None = Field(
        default=None, description="Length of the lines beyond the distance they span when the cage floats freely."
    )
    length: PositiveLength | None = Field(default=None, description="Unstretched length of each line.")


class CagePoint(Block):
    """A point of the cage."""

    x: Length = Field(description="From the middle of the cage.")
    z: Length = Field(description="Height above the middle of the cage, negative under it.")


class BedPoint(Block):
    """Where a line is held."""

    x: Length = Field(description="From the middle of the cage at rest.")
    above_bed: NonNegativeLength = Field(default=0.0, description="Height above the bed. Default: 0.")


class OwnLine(_Elastic):
    """One line."""

    exactly_one: ClassVar[KeyGroups] = (*_Elastic.exactly_one, ("pretension", "slack", "length"))

    name: Name = Field(description="Name of the line in results.")
    attachment: CagePoint = Field(description="Where it meets the cage.")
    anchor: BedPoint = Field(description="Where it meets the bed.")
    pretension: Force | None = Field(default=None, description="Tension at rest.")
    slack: NonNegativeLength | None = Field(
        default=None, description="Length beyond the distance it spans when the cage floats freely."
    )
    length: PositiveLength | None = Field(default=None, description="Unstretched length.")


class LinesMooring(Block):
    """Any lines."""

    kind: Literal["lines"] = Field(description="Lines given one by one.")
    lines: Annotated[tuple[OwnLine, ...], Field(min_length=1, max_length=20)] = Field(description="The lines.")


CageMooring = Annotated[PairMooring | LinesMooring, Field(discriminator="kind")]
