"""Schema of the flexible net cage: collar, net, weights, grid mooring, mesh, settings."""

from __future__ import annotations

from typing import Annotated, ClassVar, Literal

from pydantic import AfterValidator, Field

from moyai.case.schema_types import (
    COMPONENT,
    AddedMass,
    Block,
    Density,
    KeyGroups,
    LineComponent,
    Mass,
    NonNegativeNumber,
    PositiveForce,
    PositiveLength,
    PositiveMassPerLength,
    PositiveNumber,
    QuantityOf,
    Speed,
    Truth,
    once_each,
)
from moyai.core import quantities
from moyai.structures.cage.case.schema_parts import Share, Solidity

Pressure = Annotated[float, QuantityOf(quantities.PRESSURE, above=0.0)]
Viscosity = Annotated[float, QuantityOf(quantities.VISCOSITY, above=0.0)]
Poisson = Annotated[float, QuantityOf(quantities.NUMBER, least=0.0, most=0.5)]
MassPerLength = Annotated[float, QuantityOf(quantities.MASS_PER_LENGTH, least=0.0)]
Around = Annotated[int, Field(strict=True, ge=8, le=400, multiple_of=4)]
Meshes = Annotated[int, Field(strict=True, ge=1, le=200)]
Few = Annotated[int, Field(strict=True, ge=1, le=20)]
Samples = Annotated[int, Field(strict=True, ge=8, le=2000)]
BedStiffness = Annotated[
    float,
    QuantityOf(quantities.QuantityKind("a stiffness of the bed", "Pa/m", "pascals per metre", "1e5 Pa/m"), above=0.0),
]
Ratio = Annotated[float, QuantityOf(quantities.NUMBER, least=0.0, most=1.0)]
Slack = Annotated[float, QuantityOf(quantities.NUMBER, above=-0.2, below=1.0)]


class PipeEntry(Block):
    """A round pipe, of polyethylene for instance."""

    diameter: PositiveLength = Field(description="Outer diameter.")
    wall_thickness: PositiveLength = Field(description="Wall.")
    density: Density = Field(description="Of the wall; polyethylene has 950 to 960 kg/m3.")
    youngs_modulus: Pressure = Field(description="Of the wall; polyethylene has 0.8 to 1.1 GPa.")
    poisson_ratio: Poisson = Field(default=0.42, description="Of the wall. Default: 0.42, polyethylene.")
    drag: NonNegativeNumber = Field(default=1.0, description="C_d of flow across the pipe. Default: 1.")
    drag_along: NonNegativeNumber = Field(default=0.1, description="C_d of flow along the pipe. Default: 0.1.")
    added_mass: NonNegativeNumber = Field(default=1.0, description="C_a of flow across the pipe. Default: 1.")
    extra_mass: MassPerLength = Field(
        default=0.0, description="Mass in the pipe besides its own wall, per length. Default: 0."
    )


class CollarEntry(Block):
    """The floating collar."""

    pipe: PipeEntry = Field(description="Pipe of each ring.")
    rings: Literal[1, 2] = Field(default=1, description="Concentric rings; brackets hold two apart. Default: 1.")
    spacing: PositiveLength | None = Field(default=None, description="Between the axes of two rings.")
    rigid: Truth = Field(
        default=False, description="true: a collar that hardly deforms, bending 300 times as stiff. Default: false."
    )


class Growth(Block):
    """What grows on the net."""

    exactly_one: ClassVar[KeyGroups] = (("diameter_factor", "standard"),)

    diameter_factor: PositiveNumber | None = Field(
        default=None, description="Diameter of the twine with growth over the clean one, 1 or more."
    )
    standard: Annotated[str, Field(min_length=1)] | None = Field(
        default=None, description="Name in the table of growths: ns9415 makes twines half as thick again."
    )
    density: Density = Field(
        default=1100.0, description="Of the growth given by a factor; the table has its own. Default: 1100 kg/m3."
    )


class FlexibleNet(Block):
    """The net: twine, mesh, wall, bottom, law of its forces."""

    exactly_one: ClassVar[KeyGroups] = (("mesh_pitch", "aperture", "solidity"),)

    twine_diameter: PositiveLength = Field(description="Diameter of the twine d.")
    mesh_pitch: PositiveLength | None = Field(
        default=None, description="Twine to twine, centre to centre: the bar length, half of the stretched mesh."
    )
    aperture: PositiveLength | None = Field(default=None, description="Clear opening between two twines.")
    solidity: Solidity | None = Field(
        default=None, description="Geometric solidity: projected twine area over outline area."
    )
    knotted: Truth = Field(default=False, description="Whether the meshes are knotted. Default: false.")
    density: Density = Field(description="Of the twine material; nylon has 1140 kg/m3.")
    youngs_modulus: Pressure = Field(description="Of the twine on its full section.")
    wall_depth: PositiveLength = Field(description="Height of the wall from the collar down.")
    bottom: Literal["none", "flat", "cone"] = Field(description="Net that closes the cage below.")
    cone_depth: PositiveLength | None = Field(default=None, description="Of the middle of a cone under its rim.")
    law: Annotated[str, Field(min_length=1)] = Field(
        description="Law of the net's forces.", examples=["loland", "kristiansen_faltinsen"]
    )
    wake: Literal["none", "loland", "cheng"] = Field(
        description="Law of the shelter behind a net: of the rear half of a cage and of cages downstream."
    )
    added_mass: NonNegativeNumber = Field(default=1.0, description="C_a of a twine across it. Default: 1.")
    growth: Growth | None = Field(default=None, description="Fouling; the net is clean when absent.")
    damping: Ratio = Field(
        default=0.1, description="Damping ratio of the net's elastic waves on the mesh. Default: 0.1."
    )


class SinkerSet(Block):
    """Equal weights around the lower rim."""

    exactly_one: ClassVar[KeyGroups] = (("mass", "submerged_weight"),)

    count: Annotated[int, Field(strict=True, ge=1, le=400)] = Field(description="How many.")
    mass: Mass | None = Field(default=None, description="Mass of each in air.")
    density: Density | None = Field(default=None, description="Of their material, which gives their volume.")
    submerged_weight: PositiveForce | None = Field(default=None, description="Weight of each in water.")
    drag_area: Annotated[float, QuantityOf(quantities.AREA, least=0.0)] = Field(
        default=0.0, description="C_d times area of each. Default: 0."
    )


class RopeEntry(Block):
    """A rope or chain: from the catalogue, or by its own properties."""

    exactly_one: ClassVar[KeyGroups] = (("catalogue", "axial_stiffness"),)
    at_most_one: ClassVar[KeyGroups] = (("catalogue", "component"),)

    catalogue: Annotated[str, Field(min_length=1)] | None = Field(
        default=None, description="Name in the catalogue of lines.", examples=["polyester"]
    )
    diameter: PositiveLength = Field(description="Nominal diameter.")
    axial_stiffness: PositiveForce | None = Field(default=None, description="EA.")
    mass: PositiveMassPerLength | None = Field(default=None, description="Mass in air per length, with EA.")
    breaking_load: PositiveForce | None = Field(default=None, description="Breaking load, with EA.")
    volume: Annotated[float, QuantityOf(quantities.AREA, above=0.0)] | None = Field(
        default=None, description="Displaced volume per length, with EA. That of the diameter when absent."
    )
    drag: NonNegativeNumber | None = Field(default=None, description="C_d across the line, with EA. 1.2 when absent.")
    drag_tangential: NonNegativeNumber | None = Field(
        default=None, description="C_d along the line, with EA. 0.05 when absent."
    )
    added_mass_normal: NonNegativeNumber | None = Field(
        default=None, description="Added mass across over the displaced mass, with EA. 1 when absent."
    )
    added_mass_tangential: NonNegativeNumber | None = Field(
        default=None, description="Added mass along over the displaced mass, with EA. 0 when absent."
    )
    component: LineComponent | None = Field(default=None, description=COMPONENT)


class AnchorSegment(RopeEntry):
    """A segment of the anchor lines."""

    length: PositiveLength = Field(description="Unstretched length.")


class BuoyEntry(Block):
    """Spherical buoys over the corners of the frame."""

    diameter: PositiveLength = Field(description="Diameter.")
    mass: AddedMass = Field(description="Mass.")
    drag: NonNegativeNumber = Field(default=0.6, description="C_d of the sphere. Default: 0.6.")


class GridEntry(Block):
    """A frame of ropes under water, a bay for each cage, with buoys, bridles and anchor lines."""

    kind: Literal["grid"] = Field(description="Grid mooring.")
    rows: Few = Field(default=1, description="Cages along y. Default: 1.")
    columns: Few = Field(default=1, description="Cages along x. Default: 1.")
    bay: PositiveLength = Field(description="Side of a bay of the frame.")
    frame_depth: PositiveLength = Field(description="Depth of the frame.")
    frame_rope: RopeEntry = Field(description="Rope of the frame and of the buoys.")
    buoys: BuoyEntry = Field(description="Buoys over the corners.")
    bridle: RopeEntry = Field(description="Rope of the bridles.")
    bridles_per_corner: Annotated[int, Field(strict=True, ge=1, le=4)] = Field(
        default=2, description="Bridles from every corner of a bay to its cage. Default: 2."
    )
    bridle_length: PositiveLength | None = Field(
        default=None, description="Of every bridle; the straight way times 1 + bridle_slack when absent."
    )
    bridle_slack: Slack = Field(default=0.0, description="Length over the straight way, less 1. Default: 0.")
    anchor_line: Annotated[tuple[AnchorSegment, ...], Field(min_length=1, max_length=10)] = Field(
        description="Segments of each anchor line, from the frame down."
    )
    anchor_distance: PositiveLength = Field(description="Horizontally from the frame's corner to the anchor.")
    lines_per_corner: Literal[1, 2] = Field(
        default=1, description="Anchor lines at the outer corners: one along the diagonal, or two. Default: 1."
    )
    array_wake: Truth = Field(default=True, description="Whether cages shelter those downstream. Default: true.")
    damping: Ratio = Field(
        default=0.1, description="Damping ratio of elastic waves in the ropes on the mesh. Default: 0.1."
    )


class HeldCollar(Block):
    """A collar that is held, as in a flume."""

    kind: Literal["fixed_collar"] = Field(description="The collar does not move.")


CageHold = Annotated[GridEntry | HeldCollar, Field(discriminator="kind")]


class BedEntry(Block):
    """How the bed carries chains."""

    stiffness: Annotated[
        float,
        QuantityOf(
            quantities.QuantityKind("a stiffness of the bed", "Pa/m", "pascals per metre", "1e5 Pa/m"), above=0.0
        ),
    ] = Field(default=1.0e5, description="Pressure per depth of sinking in. Default: 100 kPa/m.")
    friction: NonNegativeNumber = Field(default=0.6, description="Coulomb coefficient. Default: 0.6.")


class MeshEntry(Block):
    """How fine the cage is resolved."""

    around: Around = Field(default=48, description="Knots around the net, a multiple of 4. Default: 48.")
    down: Meshes = Field(default=10, description="Meshes of the wall downwards. Default: 10.")
    bottom: Meshes = Field(default=6, description="Rings of meshes in the bottom. Default: 6.")
    rope_length: PositiveLength | None = Field(
        default=None, description="Length of a bar of the ropes; a tenth of the bay when absent."
    )


class FlexibleCageStructure(Block):
    """A flexible net cage, or several in a grid."""

    kind: Literal["cage"] = Field(description="Net cage.")
    model: Literal["flexible"] = Field(description="Network of grouped twines, panels, pipes and ropes.")
    kinematic_viscosity: Viscosity = Field(description="Of the water, 1.3e-6 m2/s in sea water of 10 degrees Celsius.")
    shape: Literal["circular", "square"] = Field(description="Outline at the collar.")
    size: PositiveLength = Field(description="Diameter of the net at the collar, or side of a square.")
    collar: CollarEntry | None = Field(default=None, description="The floating collar; a held one needs none.")
    net: FlexibleNet = Field(description="The net.")
    sinkers: SinkerSet | None = Field(default=None, description="Weights around the lower rim.")
    sinker_tube: PipeEntry | None = Field(default=None, description="Pipe along the lower rim, filled with water.")
    centre_mass: AddedMass = Field(
        default=0.0, description="Mass less displaced water in the middle of the bottom. Default: 0."
    )
    mooring: CageHold = Field(description="What holds the cage.")
    bed: BedEntry = Field(default_factory=BedEntry, description="The bed under the chains.")
    mesh: MeshEntry = Field(default_factory=MeshEntry, description="The mesh.")


class FlexibleCageSettings(Block):
    """How the flexible cage is computed."""

    current_speeds: Annotated[tuple[Speed, ...], Field(max_length=50), AfterValidator(once_each)] = Field(
        default=(), description="Speeds at the surface for `statics`: the current's profile is scaled to each."
    )
    periods: Annotated[int, Field(strict=True, ge=1, le=1000)] = Field(
        default=8,
        description="Wave periods run in regular waves after the ramp, at least; more until they repeat. Default: 8.",
    )
    most_periods: Annotated[int, Field(strict=True, ge=1, le=1000)] = Field(
        default=40,
        description="Wave periods after the ramp at which a run in regular waves ends, whether they repeat or not; no "
        "fewer than 'periods'. Default: 40.",
    )
    ramp_periods: NonNegativeNumber = Field(
        default=3.0, description="Periods over which the waves grow from nothing. Default: 3."
    )
    rows_per_period: Samples = Field(default=40, description="Rows written in a wave period. Default: 40.")
    frames: Samples = Field(
        default=120,
        description="Pictures kept of a run, twelve a wave period or more about its governing moment. Default: 120.",
    )
    stretching: Literal["constant", "wheeler"] = Field(
        default="wheeler", description="Kinematics above still water: frozen at it, or stretched."
    )
    slack_share: Share = Field(
        default=0.05, description="Share of its mean tension below which a line is slack. Default: 0.05."
    )
    snap_factor: PositiveNumber = Field(
        default=2.0, description="Multiple of the mean tension above which a peak after slack is a snap. Default: 2."
    )
