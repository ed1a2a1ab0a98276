"""Schema of the silt curtain case."""

from __future__ import annotations

import itertools
import math
from typing import Annotated, Any, ClassVar, Literal

from pydantic import AfterValidator, BeforeValidator, Discriminator, Field, Tag

from moyai.case.schema_app import APP, AppKeys
from moyai.case.schema_criteria import CRITERIA
from moyai.case.schema_display import DISPLAY, Display
from moyai.case.schema_environment import SeaState, SiteCurrentKeys, SiteKeys, refuse_no_seas
from moyai.case.schema_measured import MEASURED, MeasuredSets
from moyai.case.schema_types import (
    LEVEL_NAMES,
    Auto,
    AutoDuration,
    AxialStiffness,
    Block,
    Duration,
    FileName,
    Heading,
    KeyGroups,
    Length,
    LevelNames,
    Mass,
    OneOrMany,
    PositiveForce,
    PositiveLength,
    PositiveMassPerLength,
    PositiveNumber,
    QuantityOf,
    Range,
    Speed,
    Stiffness,
    Truth,
    Whole,
    once_each,
    refuse,
)
from moyai.core import quantities
from moyai.core.quantities import QuantityKind
from moyai.structures.curtain.case.criteria import CurtainCriteria, CurtainKeeps

STEEL_DENSITY = 7850.0  # kg/m3
_WEIGHT_PER_AREA = QuantityKind("a weight per area", "N/m2", "newtons per square metre", "8 N/m2")

Analysis = Literal["statics", "impact", "waves", "anchor_loads", "limits", "dynamic"]
WeightPerArea = Annotated[float, QuantityOf(_WEIGHT_PER_AREA)]
WeightPerLength = Annotated[float, QuantityOf(quantities.FORCE_PER_LENGTH, above=0.0)]
LiftPerLength = Annotated[float, QuantityOf(quantities.FORCE_PER_LENGTH, least=0.0)]
SheetStiffness = Annotated[
    float, QuantityOf(quantities.FORCE_PER_LENGTH, above=0.0, words=(("inextensible", math.inf),))
]
SheetStrength = Annotated[float, QuantityOf(quantities.FORCE_PER_LENGTH, above=0.0)]
Modulus = Annotated[float, QuantityOf(quantities.PRESSURE, above=0.0)]
MassPerArea = Annotated[float, QuantityOf(quantities.MASS_PER_AREA, above=0.0)]
Density = Annotated[float, QuantityOf(quantities.DENSITY, above=0.0)]
Slope = Annotated[float, QuantityOf(quantities.ANGLE_DEGREES, least=0.0, below=90.0)]
SafetyFactor = Annotated[float, QuantityOf(quantities.NUMBER, least=1.0)]
Share = Annotated[float, QuantityOf(quantities.NUMBER, least=0.0, most=1.0)]
OpenShare = Annotated[float, QuantityOf(quantities.NUMBER, least=0.0, below=1.0)]
LowFactor = Annotated[float, QuantityOf(quantities.NUMBER, above=0.0, most=1.0)]
HighFactor = Annotated[float, QuantityOf(quantities.NUMBER, least=1.0)]
Contraction = Annotated[float, QuantityOf(quantities.NUMBER, above=0.5, most=1.0)]
Blockage = Annotated[float, QuantityOf(quantities.NUMBER, least=0.0, below=1.0)]
Instant = Annotated[float, QuantityOf(quantities.TIME)]
_VISCOSITY = QuantityKind("a viscosity", "N s", "newton seconds", "40 N s")
CableViscosity = Annotated[float, QuantityOf(_VISCOSITY, least=0.0)]
SkirtDampingTime = Annotated[float, QuantityOf(quantities.TIME, least=0.0)]
SpanStiffness = Annotated[float, QuantityOf(quantities.FORCE_PER_LENGTH, least=0.0)]
CellsAlong = Annotated[int, Field(ge=8, le=400)]
CellsDown = Annotated[int, Field(ge=4, le=100)]
PositiveSpeed = Annotated[float, QuantityOf(quantities.SPEED, above=0.0)]


class Film(Block):
    """A film of the catalogue of flume materials."""

    material: str = Field(description="Name in the catalogue.", examples=["polyethylene_film"], min_length=1)
    thickness: PositiveLength = Field(description="Thickness of the film.")
    modulus: Modulus | None = Field(default=None, description="Young's modulus; the middle of the catalogue's range.")


class SkirtEntry(Block):
    """The sheet of the curtain."""

    exactly_one: ClassVar[KeyGroups] = (("stiffness", "film"),)
    at_most_one: ClassVar[KeyGroups] = (("submerged_weight", "mass_per_area"),)

    length: PositiveLength = Field(description="Depth-wise, unstretched, from the top load line to the toe.")
    stiffness: SheetStiffness | None = Field(
        default=None, description="Young's modulus times thickness, per length of curtain, or 'inextensible'."
    )
    film: Film | None = Field(default=None, description="A film of the catalogue, in place of stiffness and weight.")
    submerged_weight: WeightPerArea | None = Field(
        default=None, description="Weight in water per area of sheet; negative for a buoyant one."
    )
    mass_per_area: MassPerArea | None = Field(
        default=None, description="Mass per area, with 'sheet_density' in place of 'submerged_weight'."
    )
    sheet_density: Density | None = Field(default=None, description="Density of the sheet's material.")
    strength: SheetStrength | None = Field(
        default=None, description="Strength per width; without it the sheet is not judged."
    )


class Toe(Block):
    """The lower edge."""

    exactly_one: ClassVar[KeyGroups] = (("weight", "chain_mass"),)

    kind: Literal["free", "held"] = Field(
        description="'free' swings; 'held' has a lower cable as long as the upper one, which keeps it under the top."
    )
    weight: WeightPerLength | None = Field(
        default=None, description="Weight in water of chain, ballast and lower cable, per length."
    )
    chain_mass: PositiveMassPerLength | None = Field(
        default=None,
        description="Mass in air of a chain, per length; its weight in water follows with 'chain_density'.",
    )
    chain_density: Density | None = Field(
        default=None, description="Of the chain of 'chain_mass'; that of steel, 7850 kg/m3, where it is left out."
    )
    range: tuple[LowFactor, HighFactor] = Field(
        default=(0.9, 1.1),
        description="Factors [low, high] on the toe's weight in water for the band of the steady load: wear and "
        "tolerance of the chain, silt that it holds.",
        examples=[[0.8, 1.1]],
    )


class Cable(Block):
    """A cable along the span."""

    exactly_one: ClassVar[KeyGroups] = (("axial_stiffness", "catalogue"),)

    axial_stiffness: AxialStiffness | None = Field(default=None, description="EA, or 'inextensible'.")
    catalogue: str | None = Field(
        default=None,
        description="Name of a rope, wire or flume material of the catalogues, with 'diameter'.",
        examples=["wire_6x19_wire_core", "nylon_monofilament"],
    )
    diameter: PositiveLength | None = Field(default=None, description="Nominal diameter of the catalogue's line.")
    breaking_load: PositiveForce | None = Field(
        default=None, description="Breaking load; from the catalogue of ropes when absent, else not judged."
    )


class Cables(Block):
    """The cables along the span."""

    upper: Cable = Field(description="Top load line or tension wire.")
    lower: Cable | None = Field(default=None, description="Cable at the toe; needed with a held toe.")


class FloatsKeys(Block):
    """What carries the curtain, per length."""

    buoyancy: WeightPerLength = Field(description="Upward force of the wholly submerged floats, before their weight.")
    weight: LiftPerLength = Field(description="Weight in air of floats, top cable and fittings.")
    flooded_buoyancy: LiftPerLength | None = Field(
        default=None, description="Upward force left when flooded (float-and-sink type); absent: cannot be flooded."
    )


class Joints(Block):
    """Connections of the curtain units."""

    distance: PositiveLength = Field(description="Length of one curtain unit.")
    strength: PositiveForce | None = Field(default=None, description="Of one connection; without it not judged.")


class Anchors(Block):
    """The lines that hold each support."""

    exactly_one: ClassVar[KeyGroups] = (("line_stiffness", "axial_stiffness"),)

    line_length: PositiveLength = Field(description="Length of one anchor line.")
    slope_deg: Slope | None = Field(
        default=None, description="Angle of the line from the horizontal; absent: straight from surface to bed."
    )
    line_stiffness: Stiffness | None = Field(default=None, description="K = EA/L of a line.")
    axial_stiffness: PositiveForce | None = Field(default=None, description="EA of a line, in place of its stiffness.")
    breaking_load: PositiveForce | None = Field(default=None, description="Of a line; without it not judged.")
    holding_force: PositiveForce | None = Field(
        default=None, description="Horizontal force that the anchor holds; without it not judged."
    )
    pretension: Annotated[float, QuantityOf(quantities.FORCE, least=0.0)] | None = Field(
        default=None,
        description="Tension of every line without a load, lines on both sides; absent: none, and for the anchor loads "
        "in waves that of the statics.",
    )


class _Drag(Block):
    range: tuple[LowFactor, HighFactor] = Field(
        default=(1.0, 1.0),
        description="Factors [low, high] on the coefficient that bound what is known; the results are spread over it.",
        examples=[[0.8, 1.4]],
    )
    blockage: Blockage | tuple[Blockage, Blockage, Blockage] | None = Field(
        default=None,
        description="Share of the stream that the curtain blocks, or [low, middle, high]; absent: its depth over the "
        "water's.",
    )


class ConstantDrag(_Drag):
    """A coefficient that blockage does not change."""

    law: Literal["constant"] = Field(description="The flow can go round the ends.")
    coefficient: PositiveNumber = Field(description="C_D on the skirt's depth and the undisturbed speed; 1.2 to 2.0.")


class GapSpeedDrag(_Drag):
    """A coefficient on the speed under the toe."""

    law: Literal["gap_speed"] = Field(description="From bank to bank: C_D/(1 - blockage)^2.")
    coefficient: PositiveNumber = Field(description="C_D on the mean speed in the gap.")


class ClosureDrag(_Drag):
    """The load of a closure from bank to bank."""

    law: Literal["closure"] = Field(description="From bank to bank: head loss of the expanding jet.")
    contraction: Contraction = Field(description="Of the jet under the toe: 0.61 for a sharp edge, to 1.")


class TableDrag(_Drag):
    """Measured coefficients."""

    law: Literal["table"] = Field(description="Points of the coefficient over the blockage.")
    points: Annotated[tuple[tuple[Blockage, PositiveNumber], ...], Field(min_length=1, max_length=1000)] = Field(
        description="Rows [blockage, C_D], blockage rising; linear between, constant outside.",
        examples=[[[0.2, 1.4], [0.5, 2.6]]],
    )


Drag = Annotated[ConstantDrag | GapSpeedDrag | ClosureDrag | TableDrag, Field(discriminator="law")]


class CurtainStructure(Block):
    """A silt curtain: one span between two supports, its neighbours alike."""

    kind: Literal["curtain"] = Field(description="Hanging silt curtain.")
    span: PositiveLength = Field(description="Distance of the supports B.")
    length: PositiveLength = Field(description="Unstretched length of curtain between the supports l.")
    normal_deg: Heading = Field(
        default=0.0, description="Heading of the downstream normal of the span. Default: 0, the span lies along y."
    )
    skirt: SkirtEntry = Field(description="The sheet.")
    toe: Toe = Field(description="The lower edge.")
    cables: Cables = Field(description="The cables along the span.")
    floats: FloatsKeys = Field(description="What carries the curtain.")
    joints: Joints | None = Field(default=None, description="Connections of the curtain units.")
    anchors: Anchors | None = Field(default=None, description="Anchor lines; absent: fixed supports.")
    drag: Drag = Field(description="Drag coefficient.")
    load_law: Literal["normal_velocity", "uniform_normal", "free_streamline"] = Field(
        default="normal_velocity",
        description="Load of the section: velocity normal to the sheet (cos^2), the full pressure everywhere, or "
        "that of an oblique plate in separated flow, between the two.",
    )
    passing_fraction: Share = Field(
        default=1.0, description="Share of the held flow that goes under the toe; 1 from bank to bank. Default: 1."
    )
    may_lie_on_bed: Truth = Field(
        default=False, description="Whether the skirt may be longer than the water is deep. Default: false."
    )
    curtain_class: str | None = Field(
        default=None, description="Class that the curtain is checked against.", examples=["A", "II"]
    )


class Factors(Block):
    """Safety factors on strength; the same keys are under 'criteria'."""

    cable: SafetyFactor | None = Field(default=None, description="Of the cables. Default: 3.")
    sheet: SafetyFactor | None = Field(default=None, description="Of the sheet, 3 to 5 in practice. Default: 4.")
    joint: SafetyFactor | None = Field(default=None, description="Of the joints. Default: 3.")
    anchor_line: SafetyFactor | None = Field(default=None, description="Of the anchor line. Default: 3.")
    anchor: SafetyFactor | None = Field(
        default=None, description="Of the anchor's holding force, 1.2 to 2 in practice. Default: 1.5."
    )


class ImpactKeys(Block):
    """How the impact is computed."""

    at_most_one: ClassVar[KeyGroups] = (("start", "start_speed"),)

    start: Literal["current", "slack_phase"] = Field(
        default="current",
        description="Speed when the curtain becomes taut: the current's (the paper), or that of a drift from release.",
    )
    start_speed: PositiveSpeed | None = Field(default=None, description="That speed itself, in place of 'start'.")
    release_position: Length | None = Field(
        default=None,
        description="Mid-span when the curtain is released, downstream of the line between the supports; absent: on "
        "that "
        "line, and the band of the impact reaches up to the speed of the current.",
    )
    draught: PositiveLength | None = Field(
        default=None, description="Of the equivalent flat plate; absent: the skirt's length."
    )
    chord: PositiveLength | None = Field(
        default=None,
        description="Straight distance of the skirt's edges when it becomes taut, for models whose skirt stretches.",
    )
    cables: Literal["sum", "one"] = Field(
        default="sum", description="EA of model A: the sum of both cables, or that of one. Default: sum."
    )
    time_step: AutoDuration = Field(default=None, description="Step of the marching scheme. Default: auto.")


class Cycles(Block):
    """How slack and taut cycles in waves are computed."""

    settled_periods: Whole = Field(
        default=4,
        description="Periods of regular waves left out at the start, at least; more until periods repeat within 1 %. "
        "Default: 4.",
    )
    analysed_periods: Whole = Field(
        default=20, description="Periods of regular waves over which they must repeat, at least. Default: 20."
    )
    realisations: Annotated[int, Field(ge=1, le=100)] = Field(
        default=5,
        description="Realisations of an irregular sea, with the seeds that follow the sea's own; the mean of their "
        "largest tensions is used, their spread is its band. Default: 5.",
    )
    time_step: AutoDuration = Field(default=None, description="Time step. Default: auto.")
    velocity: Literal["skirt_mean", "surface", "wheeler"] = Field(
        default="skirt_mean",
        description="Water that moves the curtain: mean over the skirt, at the surface, or stretched with the surface.",
    )
    slowest_contact: Speed = Field(
        default=0.0, description="Contacts that begin slower than this do not count as snaps. Default: 0."
    )
    exceedance: Literal["weibull", "pareto"] = Field(
        default="weibull", description="Law fitted to the snaps of an irregular sea. Default: weibull."
    )
    hours: Annotated[float, QuantityOf(quantities.HOURS, above=0.0)] = Field(
        default=3.0, description="Hours that the most probable largest snap is given for. Default: 3."
    )


class AnchorLoads(Block):
    """Anchor loads in waves by the energy model."""

    energy_factor: PositiveNumber = Field(description="M, share of the float's energy that stretches the rope.")
    float_mass: Mass | None = Field(default=None, description="m_B, mass of the float per anchor rope; must be given.")
    orbital_factor: PositiveNumber = Field(
        default=2.0, description="alpha on the wave's velocity. Default: 2, the paper's."
    )
    wire_factor: PositiveNumber = Field(
        default=0.6, description="Tension of the wire over that of the rope. Default: 0.6, the paper's."
    )
    new_type_factor: PositiveNumber = Field(
        default=0.7, description="Tension of the new type over the conventional one. Default: 0.7, the paper's."
    )
    height_ratio: PositiveNumber = Field(default=1.8, description="H_max over H_1/3. Default: 1.8, the paper's.")
    direction_rule: Literal["paper", "normal", "none"] = Field(
        default="paper", description="Height by cos^2 of the angle (paper), cos (normal), or not reduced."
    )
    pretension: Truth = Field(
        default=True, description="Whether the steady tension is included; the paper leaves it out. Default: true."
    )


class SpeedRange(Range):
    """Evenly spaced speeds."""

    first: Speed = Field(alias="from", description="First speed.")
    last: Speed = Field(alias="to", description="Last speed.")


class HeightRange(Range):
    """Evenly spaced heights."""

    first: Annotated[float, QuantityOf(quantities.LENGTH, least=0.0)] = Field(alias="from", description="First height.")
    last: PositiveLength = Field(alias="to", description="Last height.")


def _form(value: Any) -> str:
    if isinstance(value, str) or value is None:
        return "<word>"
    return "<range>" if isinstance(value, (dict, Range)) else "<list>"


def _sorted(values: tuple[float, ...]) -> tuple[float, ...]:
    for before, after in itertools.pairwise(values):
        if not after > before:
            raise refuse(f"the values do not rise: {after:g} follows {before:g}", allowed="each above the one before")
    return values


class Limits(Block):
    """The operating-limit table."""

    at_most_one: ClassVar[KeyGroups] = (("period", "period_factor"),)

    speeds: Annotated[
        Annotated[Auto, Tag("<word>")]
        | Annotated[tuple[Speed, ...], Field(min_length=1, max_length=200), AfterValidator(_sorted), Tag("<list>")]
        | Annotated[SpeedRange, Tag("<range>")],
        Discriminator(_form),
    ] = Field(default="auto", description="Surface speeds of the current: auto, a list, or {from, to, count}.")
    heights: Annotated[
        Annotated[Auto, Tag("<word>")]
        | Annotated[
            tuple[Annotated[float, QuantityOf(quantities.LENGTH, least=0.0)], ...],
            Field(min_length=1, max_length=200),
            AfterValidator(_sorted),
            Tag("<list>"),
        ]
        | Annotated[HeightRange, Tag("<range>")],
        Discriminator(_form),
    ] = Field(default="auto", description="Significant wave heights: auto, a list, or {from, to, count}.")
    highest_speed: PositiveSpeed = Field(default=3.0, description="Up to which a limit is sought. Default: 3 m/s.")
    highest_height: PositiveLength = Field(default=5.0, description="Up to which a limit is sought. Default: 5 m.")
    period: Duration | None = Field(default=None, description="One wave period for all heights.")
    period_factor: PositiveNumber | None = Field(
        default=None, description="T = factor times the root of the height in metres; 3.86 when neither is given."
    )
    impact: Truth = Field(
        default=True, description="Whether the impact is included in the table, where it was requested. Default: true."
    )
    wave_angle_deg: Annotated[float, QuantityOf(quantities.ANGLE_DEGREES)] | None = Field(
        default=None, description="Of the waves from the normal. Default: 0, which loads a curtain most."
    )
    rose_step_deg: Literal[5, 10, 15, 30, 45] | None = Field(
        default=None,
        description="Step of the limit rose, the permissible heights over wave heading and its own orientation; "
        "absent: "
        "no rose.",
    )


class Dynamic(Block):
    """The whole span through time: cables, skirt, floats, ballast and anchor lines as a flexible network."""

    cells_along: CellsAlong = Field(default=24, description="Cells along the span, 8 to 400. Default: 24.")
    cells_down: CellsDown = Field(default=8, description="Cells over the skirt, 4 to 100. Default: 8.")
    sheet_mass: MassPerArea | None = Field(
        default=None, description="Mass per area of the sheet; absent: that of 'structure.skirt', where it is given."
    )
    span_stiffness: SpanStiffness = Field(
        default=0.0,
        description="Modulus times thickness of the sheet along the span; 0: slack along the span. Default: 0.",
    )
    shear_stiffness: SpanStiffness = Field(
        default=0.0, description="Shear modulus times thickness, with 'span_stiffness'. Default: 0."
    )
    ballast_density: Density = Field(
        default=STEEL_DENSITY,
        description="Of lower cable, chain and ballast, for their mass. Default: 7850 kg/m3, steel.",
    )
    float_height: PositiveLength | None = Field(
        default=None, description="Height of the floats; absent: of a round float with the buoyancy given."
    )
    support_mass: Mass | None = Field(
        default=None,
        description="Of the buoy at a support with its added mass; needed with 'structure.anchors'. Default: "
        "'settings.anchor_loads.float_mass', where that is given.",
    )
    start: Literal["auto", "at_rest", "drifting", "released"] = Field(
        default="auto",
        description="At rest in water that begins to move, drifting and just taut, or (without waves) released in the "
        "current, gathered on the line between the supports. Default: at rest in waves, else drifting.",
    )
    start_profile: Literal["uniform", "sag"] = Field(
        default="uniform", description="Speed of a drifting start over the span: the same, or as the sag."
    )
    settled_periods: Annotated[int, Field(ge=0)] = Field(
        default=6,
        description="Periods left out after the ramp of one period, in which the skirt swings out of its start; peak "
        "periods of an irregular sea. Default: 6.",
    )
    analysed_periods: Whole = Field(default=10, description="Periods of regular waves that count. Default: 10.")
    wave_count: Annotated[int, Field(ge=2, le=2000)] = Field(
        default=8, description="Peak periods that count around the highest crest of an irregular sea. Default: 8."
    )
    duration: Duration | None = Field(
        default=None,
        description="Of the run without waves; absent: four times the rise of model A, doubled while the highest "
        "tension is in its second half.",
    )
    cable_viscosity: CableViscosity | None = Field(
        default=None, description="Internal damping of the cables in N s; absent: 5 % of critical on the mesh."
    )
    skirt_damping_time: SkirtDampingTime | None = Field(
        default=None, description="Time by which the rate of strain of the skirt is multiplied; absent: likewise."
    )
    sensitivity: Truth = Field(
        default=True,
        description="Whether runs with half the step, half the cells and twice the viscosity follow. Default: true.",
    )
    slack_level: Annotated[float, QuantityOf(quantities.FORCE, least=0.0)] | None = Field(
        default=None, description="Tension up to which a line is taken as slack; absent: 1 % of its highest."
    )
    snap_threshold: PositiveForce | None = Field(
        default=None, description="Peak above which a contact is a snap; absent: twice the mean of the taut times."
    )
    by_default: Truth = Field(
        default=True,
        description="Whether runs on 8 by 3 and 12 by 4 cells (or two thirds of the cells given and those) give the "
        "peaks where 'dynamic' is not among the analyses and an upright plate only bounds them. Default: true.",
    )


class CurtainSettingsKeys(Block):
    """How the analyses are run."""

    impact: ImpactKeys = Field(default_factory=ImpactKeys, description="Impact when the curtain becomes taut.")
    waves: Cycles = Field(default_factory=Cycles, description="Slack and taut cycles in waves.")
    anchor_loads: AnchorLoads | None = Field(default=None, description="Anchor loads in waves by the energy model.")
    limits: Limits = Field(default_factory=Limits, description="The operating-limit table.")
    dynamic: Dynamic = Field(default_factory=Dynamic, description="The whole span through time.")
    safety_factors: Factors = Field(default_factory=Factors, description="Safety factors on strength.")
    least_float_reserve: OpenShare = Field(
        default=0.0, description="Share of the buoyancy that must be left. Default: 0."
    )
    least_effective_depth: Annotated[float, QuantityOf(quantities.LENGTH, least=0.0)] = Field(
        default=0.0, description="Effective depth that must be kept. Default: 0."
    )
    water_levels: LevelNames = Field(default="all", description=LEVEL_NAMES)


class RecordKeys(Block):
    """A flume record of a snap to hold the impact models against."""

    file: FileName = Field(description="CSV, names and units in its header: 'time [s], upper [N], lower [N]'.")
    time: Annotated[str, Field(min_length=1)] = Field(default="time", description="Column of the time.")
    upper: Annotated[str, Field(min_length=1)] = Field(
        default="upper", description="Column of the tension of the upper cable, or of both together."
    )
    lower: Annotated[str, Field(min_length=1)] | None = Field(
        default=None, description="Column of the tension of the lower cable."
    )
    unloaded: Annotated[tuple[tuple[Instant, Instant], ...], Field(min_length=1, max_length=100)] = Field(
        description="Intervals [from, to] in which the cables have no tension; two or more take off a drift as well.",
        examples=[[["0 s", "1.9 s"], ["22 s", "23 s"]]],
    )
    window: tuple[Instant, Instant] | None = Field(
        default=None, description="Interval in which the snap is sought; the whole record when absent."
    )
    release_time: Instant | None = Field(
        default=None, description="When the curtain was released, from a trigger; found in the record when absent."
    )


class CurtainCase(Block):
    """A silt curtain from its site to its analyses."""

    moyai: Literal[1] = Field(description="Version of the case file format.")
    title: Annotated[str, Field(min_length=1, max_length=200)] = Field(description="Title of the report.")
    site: SiteKeys = Field(description="The water of the site.")
    waves: Annotated[tuple[SeaState, ...], OneOrMany(), BeforeValidator(refuse_no_seas)] = Field(
        default=(), description="One sea state, or a list of them; each is run."
    )
    current: SiteCurrentKeys | None = Field(default=None, description="Steady current.")
    structure: CurtainStructure = Field(description="The curtain.")
    analyses: Annotated[tuple[Analysis, ...], Field(min_length=1), AfterValidator(once_each)] = Field(
        description="What is computed.",
        examples=[["statics", "impact", "waves", "anchor_loads", "limits"], ["dynamic"]],
    )
    record: RecordKeys | None = Field(default=None, description="A flume record to hold the impact models against.")
    criteria: CurtainKeeps = Field(default_factory=CurtainCriteria, description=CRITERIA)
    settings: CurtainSettingsKeys = Field(default_factory=CurtainSettingsKeys, description="How the analyses are run.")
    measured: MeasuredSets = Field(default=(), description=MEASURED)
    display: Display = Field(default_factory=Display, description=DISPLAY)
    app: AppKeys = Field(default_factory=AppKeys, description=APP)
