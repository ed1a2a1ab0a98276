"""Schema of the parts of a network: line types, motions, points, lines, nets, sheets, the bed; bodies stand apart."""

from __future__ import annotations

import itertools
from typing import Annotated, Any, ClassVar, Literal

from pydantic import AfterValidator, Discriminator, Field, Tag

from moyai.case.schema_types import (
    COMPONENT,
    AddedMass,
    Block,
    Duration,
    FileName,
    Heading,
    KeyGroups,
    Length,
    LineComponent,
    Name,
    NonNegativeLength,
    NonNegativeNumber,
    PositiveForce,
    PositiveLength,
    PositiveMassPerLength,
    PositiveNumber,
    QuantityOf,
    Volume,
    Whole,
    holds_key,
    once_each,
    refuse,
)
from moyai.core import quantities

Height = Annotated[float | None, QuantityOf(quantities.LENGTH, words=(("bed", None),))]
Place = tuple[Length, Length, Height]
Shift = tuple[Length, Length, Length]
MembraneStiffness = Annotated[float, QuantityOf(quantities.FORCE_PER_LENGTH, least=0.0)]
MassPerArea = Annotated[float, QuantityOf(quantities.MASS_PER_AREA, above=0.0)]
AddedMassPerArea = Annotated[float, QuantityOf(quantities.MASS_PER_AREA, least=0.0)]
Angles = tuple[Heading, Heading, Heading]
Viscosity = Annotated[
    float, QuantityOf(quantities.QuantityKind("a viscosity", "N s", "newton seconds", "1e4 N s"), least=0.0)
]
BendingStiffness = Annotated[float, QuantityOf(quantities.BENDING_STIFFNESS, least=0.0)]
Area = Annotated[float, QuantityOf(quantities.AREA, least=0.0)]
NonNegativeDuration = Annotated[float, QuantityOf(quantities.TIME, least=0.0)]
Strain = Annotated[float, QuantityOf(quantities.NUMBER, least=0.0)]
Pull = Annotated[float, QuantityOf(quantities.FORCE, least=0.0)]
Modulus = Annotated[float, QuantityOf(quantities.PRESSURE, above=0.0)]
MaterialDensity = Annotated[float, QuantityOf(quantities.DENSITY, above=0.0)]
Ratio = Annotated[float, QuantityOf(quantities.NUMBER, least=0.0, most=10.0)]
BedStiffness = Annotated[
    float,
    QuantityOf(quantities.QuantityKind("a stiffness of the bed", "Pa/m", "pascals per metre", "3e5 Pa/m"), above=0.0),
]
BedDamping = Annotated[
    float,
    QuantityOf(
        quantities.QuantityKind("a damping of the bed", "Pa s/m", "pascal seconds per metre", "3e4 Pa s/m"), least=0.0
    ),
]
Segments = Annotated[int, Field(strict=True, ge=1, le=20_000)]
Axis = Literal["x", "y", "z"]


# ---- materials
def _curve_rows(rows: tuple[tuple[float, float], ...]) -> tuple[tuple[float, float], ...]:
    if rows and rows[0] != (0.0, 0.0):
        raise refuse("the first row is not [0, 0]", remedy="a rope without strain has no tension: begin with [0, 0]")
    for below, above in itertools.pairwise(rows):
        if not (above[0] > below[0] and above[1] > below[1]):
            raise refuse(
                f"[{above[0]:g}, {above[1]:g}] follows [{below[0]:g}, {below[1]:g}]",
                allowed="strain and tension both rise from row to row",
            )
    return rows


class RopeTable(Block):
    """Tension of a rope over its strain."""

    exactly_one: ClassVar[KeyGroups] = (("table", "file"),)

    table: Annotated[tuple[tuple[Strain, Pull], ...], Field(min_length=2, max_length=10_000),
                     AfterValidator(_curve_rows)] | None = Field(
        default=None,
        description="Rows [strain, tension] from [0, 0] up, joined by straight lines.",
        examples=[[[0, 0], [0.05, "40 kN"], [0.1, "150 kN"]]],
    )  # fmt: skip
    file: FileName | None = Field(
        default=None,
        description="Text file with the same two columns, strain [-] and tension [N]; a heading is allowed.",
    )


class _Internal(Block):
    viscosity: Viscosity | None = Field(
        default=None, description="Internal damping BA: force per rate of strain, a property of the material."
    )
    damping_ratio: Ratio | None = Field(
        default=None,
        description="Internal damping as a part of the critical damping of one bar; depends on the mesh, so a "
        "viscosity is better.",
    )


class CatalogueType(_Internal):
    """A chain or rope of the catalogue."""

    exactly_one: ClassVar[KeyGroups] = (("viscosity", "damping_ratio"),)

    catalogue: str = Field(description="Name in the catalogue.", examples=["studless_chain_R3"], min_length=1)
    diameter: PositiveLength = Field(description="Nominal diameter.")
    curve: RopeTable | None = Field(default=None, description="Tension over strain in place of the catalogue's EA.")
    bending_stiffness: BendingStiffness = Field(default=0.0, description="EI. Default: 0.")


class SlowStretchKeys(Block):
    """A spring parallel to a dashpot, in series with the quick stiffness."""

    static_stiffness: PositiveForce = Field(description="EA of the whole rope under a load that stays.")
    viscosity: Viscosity = Field(description="Of the dashpot parallel to the slow spring: force per rate of strain.")
    growth: NonNegativeNumber = Field(
        default=0.0, description="Quick stiffness per tension at rest that it grows with. Default: 0."
    )


class WornRopeKeys(Block):
    """A polyester rope whose stiffness depends on its highest mean tension (Syrope); its curve is for the new rope."""

    form: Literal["linear", "quadratic", "exponential"] = Field(description="Shape of the working curve at rest.")
    k1: NonNegativeNumber = Field(
        description="Strain left without tension over the strain at the highest tension; above 1 the stiffness of a "
        "linear working curve [N]."
    )
    k2: NonNegativeNumber = Field(default=1.0, description="Exponent of the exponential. Default: 1.")
    quick_stiffness: PositiveForce = Field(description="EA of quick changes without tension.")
    growth: NonNegativeNumber = Field(default=0.0, description="Quick stiffness per mean tension. Default: 0.")
    viscosity: Viscosity = Field(description="Of the dashpot parallel to the slow spring: force per rate of strain.")
    highest_mean_tension: Pull = Field(default=0.0, description="Highest mean tension so far. Default: 0, a new rope.")


class OwnType(_Internal):
    """A line with its own properties."""

    exactly_one: ClassVar[KeyGroups] = (("viscosity", "damping_ratio"), ("axial_stiffness", "curve"))

    diameter: PositiveLength = Field(description="Diameter of the drag and of the contact with the bed.")
    mass: PositiveMassPerLength = Field(description="Mass in air per length.")
    axial_stiffness: PositiveForce | None = Field(default=None, description="EA.")
    curve: RopeTable | None = Field(default=None, description="Tension over strain in place of EA.")
    slow_stretch: SlowStretchKeys | None = Field(
        default=None,
        description="Creep of a synthetic rope under lasting loads; axial_stiffness then is that of quick changes.",
    )
    worn_rope: WornRopeKeys | None = Field(
        default=None,
        description="How the stiffness of a polyester rope depends on its highest mean tension; needs 'curve'.",
    )
    volume: Annotated[float, QuantityOf(quantities.AREA, least=0.0)] | None = Field(
        default=None, description="Displaced volume per length. Default: that of the diameter."
    )
    drag_normal: NonNegativeNumber = Field(description="Drag coefficient across, on the diameter.")
    drag_tangential: NonNegativeNumber = Field(description="Drag coefficient along, on the diameter.")
    added_mass_normal: NonNegativeNumber = Field(description="Added-mass coefficient across, on the volume.")
    added_mass_tangential: NonNegativeNumber = Field(
        default=0.0, description="Added-mass coefficient along, on the volume. Default: 0."
    )
    bending_stiffness: BendingStiffness = Field(default=0.0, description="EI. Default: 0.")
    bears_compression: Annotated[bool, Field(strict=True)] = Field(
        default=False, description="Whether it carries compression instead of going slack. Default: no."
    )
    breaking_load: PositiveForce | None = Field(default=None, description="Breaking load; shows the utilisation.")
    component: LineComponent | None = Field(default=None, description=COMPONENT)


def _type_form(value: Any) -> str:
    if isinstance(value, dict):
        return "<catalogue>" if holds_key(value, "catalogue") else "<own>"
    return "<catalogue>" if isinstance(value, CatalogueType) else "<own>"


NetworkLineType = Annotated[
    Annotated[CatalogueType, Tag("<catalogue>")] | Annotated[OwnType, Tag("<own>")], Discriminator(_type_form)
]


# ---- motions
class HarmonicMotionKeys(Block):
    """To and fro."""

    kind: Literal["harmonic"] = Field(description="amplitude sin(2 pi t / period + phase).")
    amplitude: Shift = Field(description="Along x, y, z.")
    period: Duration = Field(description="Period.")
    phase_deg: Angles = Field(default=(0.0, 0.0, 0.0), description="Phase of each component. Default: 0.")
    ramp: NonNegativeDuration = Field(
        default=0.0, description="Time over which it grows from nothing, half a cosine. Default: 0."
    )


class CircularMotion(Block):
    """Round and round."""

    kind: Literal["circular"] = Field(description="A circle in one plane.")
    radius: PositiveLength = Field(description="Radius.")
    period: Duration = Field(description="Time of one turn.")
    plane: Literal["xz", "yz", "xy"] = Field(default="xz", description="Plane of the circle. Default: xz.")
    turns: Literal["with_waves", "against_waves"] = Field(
        default="with_waves",
        description="with_waves: from the second axis (upwards) to the first, as water under waves towards it.",
    )
    ramp: NonNegativeDuration = Field(default=0.0, description="Time over which it grows from nothing. Default: 0.")


class TableMotion(Block):
    """A recorded or computed motion."""

    kind: Literal["table"] = Field(description="From a file or rows.")
    exactly_one: ClassVar[KeyGroups] = (("file", "rows"),)

    file: FileName | None = Field(
        default=None,
        description="Text file of time [s] and displacement x, y, z [m], comma, semicolon, tab or blank separated; a "
        "heading is allowed.",
    )
    rows: Annotated[tuple[tuple[NonNegativeDuration, Length, Length, Length], ...], Field(min_length=2)] | None = Field(
        default=None, description="Rows [time, x, y, z].", examples=[[["0 s", 0, 0, 0], ["10 s", 1, 0, 0]]]
    )
    ramp: NonNegativeDuration | None = Field(
        default=None,
        description="Time over which it grows from nothing. Default: one mean period of a motion that swings and "
        "begins displaced or at speed, else 0.",
    )


PointMotion = Annotated[HarmonicMotionKeys | CircularMotion | TableMotion, Field(discriminator="kind")]


# ---- points
ZFrom = Annotated[
    Literal["datum", "still_water"],
    Field(
        description="What z counts from: datum, or the still water of each water level (a point on a floating body).",
    ),
]


class HeldPoint(Block):
    """A point that does not move."""

    kind: Literal["fixed"] = Field(description="An anchor or another fixed point.")
    position: Place = Field(description="x, y, z; z may be the word bed.", examples=[[0, 0, "bed"], [0, 0, "-9.5 m"]])
    z_from: ZFrom = Field(default="datum", description="datum, or still_water. Default: datum.")


class DrivenPoint(Block):
    """A point that follows a prescribed motion."""

    kind: Literal["driven"] = Field(description="A fairlead, a towing point.")
    position: Place = Field(description="x, y, z while the motion is zero.")
    motion: Name | None = Field(default=None, description="Name in 'motions'; held still when left out.")
    z_from: ZFrom = Field(default="datum", description="datum, or still_water. Default: datum.")


_CONTACT = (
    "Area of contact with the bed. Default: that of its cross section seen from above, of a sphere where no shape is "
    "given; without a volume that of a sphere of steel of its mass."
)


class _Moving(Block):
    position: Place = Field(description="Where it starts: x, y, z.")
    held: Annotated[tuple[Axis, ...], Field(max_length=3), AfterValidator(once_each)] = Field(
        default=(), description="Components that do not move. Default: none."
    )
    bed_contact_area: Area | None = Field(default=None, description=_CONTACT)


_Height = Annotated[float, QuantityOf(quantities.LENGTH, least=0.0)]
_HEIGHT = (
    "Vertical extent of a box that comes out of the water; 0 keeps it wholly wet wherever it is. Default: a sphere of "
    "the volume."
)


class FreePoint(_Moving):
    """A joint, or a small body."""

    kind: Literal["free"] = Field(description="A joint, clump weight or small buoy.")
    mass: AddedMass = Field(default=0.0, description="Mass in air. Default: 0.")
    volume: Volume = Field(default=0.0, description="Displaced volume when wholly wet. Default: 0.")
    height: _Height | None = Field(default=None, description=_HEIGHT)
    drag_area: Area = Field(default=0.0, description="Drag coefficient times area. Default: 0.")
    added_mass_coefficient: NonNegativeNumber = Field(default=0.0, description="On the volume. Default: 0.")


class SphereFloat(_Moving):
    """A spherical float."""

    kind: Literal["sphere"] = Field(description="A spherical float or buoy, partly immersed at the surface.")
    diameter: PositiveLength = Field(description="Diameter.")
    mass: AddedMass = Field(description="Mass in air.")
    drag_coefficient: NonNegativeNumber = Field(description="On the cross section of the sphere.")
    added_mass_coefficient: NonNegativeNumber = Field(description="On the volume; 0.5 for a sphere.")


class CylinderFloat(_Moving):
    """An upright cylinder."""

    kind: Literal["cylinder"] = Field(description="A cylinder that stays upright, partly immersed at the surface.")
    diameter: PositiveLength = Field(description="Diameter.")
    height: PositiveLength = Field(description="Height.")
    mass: AddedMass = Field(description="Mass in air.")
    drag_coefficient: NonNegativeNumber = Field(description="On diameter times height.")
    added_mass_coefficient: NonNegativeNumber = Field(description="On the volume.")


NetworkPoint = Annotated[HeldPoint | DrivenPoint | FreePoint | SphereFloat | CylinderFloat, Field(discriminator="kind")]


# ---- lines
class Weight(Block):
    """A clump weight or float on a line."""

    mass: AddedMass = Field(description="Mass in air.")
    volume: Volume = Field(default=0.0, description="Displaced volume. Default: 0.")
    height: _Height | None = Field(default=None, description=_HEIGHT)
    drag_area: Area = Field(default=0.0, description="Drag coefficient times area. Default: 0.")
    added_mass_coefficient: NonNegativeNumber = Field(default=0.0, description="On the volume. Default: 0.")
    bed_contact_area: Area | None = Field(default=None, description=_CONTACT)


class LinePartKeys(Block):
    """A length of one type."""

    type: Name = Field(description="Name in 'line_types'.")
    length: PositiveLength = Field(description="Unstretched length.")
    segments: Segments = Field(description="Number of bars.")


class WeightEntry(Block):
    """A clump weight or float between two parts."""

    clump: Weight = Field(description="Weight or float between the parts before and after it.")


def _part_form(value: Any) -> str:
    if isinstance(value, dict):
        return "<clump>" if holds_key(value, "clump") else "<part>"
    return "<clump>" if isinstance(value, WeightEntry) else "<part>"


PartEntry = Annotated[
    Annotated[LinePartKeys, Tag("<part>")] | Annotated[WeightEntry, Tag("<clump>")], Discriminator(_part_form)
]


def _clumps_between(entries: tuple[Any, ...]) -> tuple[Any, ...]:
    kinds = [isinstance(entry, WeightEntry) for entry in entries]
    if kinds[0] or kinds[-1]:
        raise refuse("a clump is at the end of the line", allowed="clumps between two parts",
                     remedy="give the end point its mass instead")  # fmt: skip
    if any(a and b for a, b in itertools.pairwise(kinds)):
        raise refuse("two clumps follow each other", remedy="join them into one")
    return entries


class RowOfWeights(Weight):
    """Equal floats or weights along a line."""

    exactly_one: ClassVar[KeyGroups] = (("count", "spacing"),)

    count: Whole | None = Field(default=None, description="How many, evenly spaced.")
    spacing: PositiveLength | None = Field(default=None, description="Distance between two.")


class NetworkLine(Block):
    """A line between two points."""

    exactly_one: ClassVar[KeyGroups] = (("parts", "type"),)

    start: Name = Field(description="Point at its start.")
    end: Name = Field(description="Point at its end.")
    type: Name | None = Field(default=None, description="Name in 'line_types', for a line of one type.")
    length: PositiveLength | None = Field(default=None, description="Unstretched length of a line of one type.")
    segments: Segments | None = Field(default=None, description="Number of bars of a line of one type.")
    parts: Annotated[tuple[PartEntry, ...], Field(min_length=1, max_length=200), AfterValidator(_clumps_between)] | (
        None
    ) = Field(default=None, description="From start to end: parts of different types, with clumps between them.")
    along: tuple[RowOfWeights, ...] = Field(
        default=(), description="Floats or weights spread along it, each put on the nearest node.", max_length=50
    )
    shape: Literal["catenary", "straight"] = Field(
        default="catenary", description="Where its nodes start: on the catenary at rest, or on the chord."
    )
    flow_factor: NonNegativeNumber = Field(
        default=1.0, description="Factor on the velocity of the water at it; less than 1 in a wake. Default: 1."
    )


# ---- nets
class Twine(Block):
    """The netting: bars of the mesh, gathered into fewer bars of the model."""

    exactly_one: ClassVar[KeyGroups] = (("viscosity", "damping_ratio"),)

    diameter: PositiveLength = Field(description="Diameter of the twine.")
    mesh_pitch: PositiveLength = Field(description="Bar length of the mesh, from knot to knot.")
    density: MaterialDensity = Field(description="Density of the twine, nylon 1140, polyethylene 950 kg/m3.")
    modulus: Modulus = Field(description="Axial modulus of the twine, on its solid section.")
    drag_normal: NonNegativeNumber = Field(description="Drag coefficient of a twine across the flow.")
    drag_tangential: NonNegativeNumber = Field(description="Drag coefficient of a twine along the flow.")
    added_mass_normal: NonNegativeNumber = Field(default=1.0, description="On the volume of the twines. Default: 1.")
    viscosity: Viscosity | None = Field(default=None, description="Internal damping BA of one twine.")
    damping_ratio: Ratio | None = Field(default=None, description="Part of the critical damping of one bar.")


class NetworkNet(Block):
    """A net of rectangular meshes between four corners."""

    exactly_one: ClassVar[KeyGroups] = (("type", "twine"),)

    corners: tuple[Place, Place, Place, Place] = Field(
        description="Start and end of the first row, then end and start of the last row: once around the net."
    )
    rows: Annotated[int, Field(strict=True, ge=2, le=1000)] = Field(description="Knots from the first to the last row.")
    columns: Annotated[int, Field(strict=True, ge=2, le=1000)] = Field(description="Knots along a row.")
    type: Name | None = Field(default=None, description="Name in 'line_types' of every bar of the model, as it is.")
    twine: Twine | None = Field(
        default=None,
        description="Twines of a mesh: each bar of the model gathers those of its strip and keeps their projected "
        "area, mass, volume and stiffness.",
    )
    hanging_ratio: Annotated[float, QuantityOf(quantities.NUMBER, above=0.0, most=2.0)] = Field(
        default=1.0, description="Distance of the knots at the start over their unstretched distance. Default: 1."
    )
    first_row: Literal["fixed", "driven", "free"] = Field(description="What holds the first row.")
    motion: Name | None = Field(default=None, description="Motion of a driven first row; held still when left out.")
    ballast: PositiveMassPerLength | None = Field(
        default=None, description="Sinker line along the last row, mass in water per length of it."
    )
    flow_factor: NonNegativeNumber = Field(default=1.0, description="Factor on the water velocity. Default: 1.")
    z_from: ZFrom = Field(default="datum", description="datum, or still_water. Default: datum.")


class NetworkSheet(Block):
    """A sheet between four corners: cloth that wrinkles instead of bearing compression."""

    corners: tuple[Place, Place, Place, Place] = Field(
        description="Start and end of the first row, then end and start of the last row: once around the sheet."
    )
    rows: Annotated[int, Field(strict=True, ge=2, le=500)] = Field(description="Knots from the first to the last row.")
    columns: Annotated[int, Field(strict=True, ge=2, le=500)] = Field(description="Knots along a row.")
    warp_stiffness: MembraneStiffness = Field(description="Modulus times thickness from row to row.")
    weft_stiffness: MembraneStiffness = Field(description="Modulus times thickness along the rows.")
    shear_stiffness: MembraneStiffness = Field(
        description="Shear modulus times thickness; with 0 the threads can rotate."
    )
    mass: MassPerArea = Field(description="Mass per area.")
    thickness: NonNegativeLength = Field(description="Displaced volume per area.")
    drag_normal: NonNegativeNumber = Field(description="Drag coefficient across, on its area.")
    drag_tangential: NonNegativeNumber = Field(description="Drag coefficient along, on its area.")
    added_mass: AddedMassPerArea | None = Field(
        default=None,
        description="Water that the wet sheet takes along across its directions as built, per area; a strip of depth d "
        "that moves as a whole takes pi/4 times density times d. None is taken along when left out.",
    )
    damping_time: NonNegativeDuration = Field(
        default=0.0, description="Internal damping: time that multiplies the rate of strain. Default: 0."
    )
    fullness: Annotated[float, QuantityOf(quantities.NUMBER, above=0.0, most=5.0)] = Field(
        default=1.0,
        description="Unstretched length over the distance of the corners; above 1 it hangs loose. Default: 1.",
    )
    first_row: Literal["fixed", "driven", "free"] = Field(description="What holds the first row.")
    motion: Name | None = Field(default=None, description="Motion of a driven first row; held still when left out.")
    z_from: ZFrom = Field(default="datum", description="datum, or still_water. Default: datum.")


class BedGrid(Block):
    """Depths on a rectangular grid."""

    file: FileName = Field(
        description="Text file of x, y [m] and depth below datum [m], one row a crossing of the grid lines in any "
        "order, comma, semicolon, tab or blank separated; a heading is allowed. Bilinear between the lines, flat "
        "beyond the outer ones."
    )
    form: Literal["depths", "seafloor"] = Field(
        default="depths",
        description="depths: rows of x, y, depth; seafloor: the grid file of MoorDyn, whose rows are x, y and height "
        "above still water. Default: depths.",
    )


class BedSlope(Block):
    """A plane bed, as deep as site.water_depth at x = y = 0."""

    rise: PositiveNumber = Field(description="Rise over run.", examples=[0.05])
    towards_deg: Heading = Field(description="Direction in which it rises.", examples=[180])


class NetworkBed(Block):
    """The bed that carries lines."""

    at_most_one: ClassVar[KeyGroups] = (("grid", "slope"),)

    stiffness: BedStiffness = Field(description="Spring per contact area; a line of diameter d sinks w/(k d).")
    damping: BedDamping = Field(description="Dashpot per contact area.")
    friction: PositiveNumber | Literal[0] = Field(default=0, description="Coulomb coefficient. Default: 0.")
    grid: BedGrid | None = Field(default=None, description="Depths that vary; site.water_depth when left out.")
    slope: BedSlope | None = Field(default=None, description="A plane that rises; level when left out.")
