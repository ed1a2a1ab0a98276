"""Schema of the submerged member case."""

from __future__ import annotations

import itertools
from typing import Annotated, Any, Literal

from pydantic import AfterValidator, BeforeValidator, Discriminator, Field, Tag

from moyai.case.schema_app import APP, AppKeys
from moyai.case.schema_criteria import CRITERIA
from moyai.case.schema_display import DISPLAY, Display
from moyai.case.schema_environment import (
    BretschneiderMitsuyasu,
    Jonswap,
    PiersonMoskowitz,
    RegularWavesOfHeights,
    SiteCurrentKeys,
    SiteKeys,
    SpectrumFile,
    Tma,
    refuse_no_seas,
)
from moyai.case.schema_measured import MEASURED, MeasuredSets
from moyai.case.schema_types import (
    LEVEL_NAMES,
    Block,
    Duration,
    Heading,
    Length,
    LevelNames,
    NonNegativeLength,
    NonNegativeNumber,
    OneOrMany,
    PositiveLength,
    PositiveNumber,
    QuantityOf,
    Whole,
    holds_key,
    once_each,
    refuse,
)
from moyai.core import quantities
from moyai.structures.member.case.criteria import MemberCriteria, MemberKeeps

Analysis = Literal["sweep", "forces", "surface"]
Viscosity = Annotated[float, QuantityOf(quantities.VISCOSITY, above=0.0)]
Strips = Annotated[int, Field(strict=True, ge=1, le=2000)]
Steps = Annotated[int, Field(strict=True, ge=16, le=10_000)]


class CircularMember(Block):
    """A circular cylinder."""

    shape: Literal["circle"] = Field(description="Circle.")
    diameter: PositiveLength = Field(description="Diameter.")


class RectangularMember(Block):
    """A sharp rectangle."""

    shape: Literal["rectangle"] = Field(description="Rectangle with sharp corners.")
    width: PositiveLength = Field(description="Side along the first axis (of a member along the crests: of the waves).")
    height: PositiveLength = Field(description="Side along the second axis (upwards).")


class SquareMember(Block):
    """A sharp square."""

    shape: Literal["square"] = Field(description="Square with sharp corners.")
    width: PositiveLength = Field(description="Side.")


class RoundedMember(Block):
    """A rectangle with round corners."""

    shape: Literal["rounded_rectangle"] = Field(description="Rectangle with quarter circles at its corners.")
    width: PositiveLength = Field(description="Side along the first axis.")
    height: PositiveLength = Field(description="Side along the second axis.")
    corner_radius: PositiveLength = Field(description="Radius of the corners, less than half of the smaller side.")


class PolygonMember(Block):
    """Any closed outline of straight edges."""

    shape: Literal["polygon"] = Field(description="Closed outline through given points.")
    points: Annotated[tuple[tuple[Length, Length], ...], Field(min_length=3, max_length=500)] = Field(
        description="Corners [first axis, second axis] from the axis of the member, in order around it, either way.",
        examples=[[["-1 m", "0 m"], ["1 m", "0 m"], ["0 m", "1.5 m"]]],
    )


MemberSection = Annotated[
    CircularMember | RectangularMember | SquareMember | RoundedMember | PolygonMember, Field(discriminator="shape")
]


class End(Block):
    """One end of the axis of the member."""

    x: Length = Field(default=0.0, description="x. Default: 0.")
    y: Length = Field(default=0.0, description="y. Default: 0.")
    z: Length = Field(description="Height above datum, negative under it.")


class DragTable(Block):
    """Drag from a law of the literature."""

    law: Literal["dnv_c205", "api", "stokes_wang", "steady"] = Field(
        description="dnv_c205: circle by KC and roughness; api: circle in storm waves; stokes_wang: laminar circle; "
        "steady: steady flow, circle or rectangle."
    )
    roughness: NonNegativeLength = Field(default=0.0, description="Height of the roughness k. Default: 0, smooth.")


def _rising(rows: tuple[Any, ...]) -> tuple[Any, ...]:
    values = [row[0] for row in rows]
    if any(b <= a for a, b in itertools.pairwise(values)):
        raise refuse("the first column does not rise", allowed="rows in rising order")
    return rows


KcRow = (
    Annotated[tuple[NonNegativeNumber, NonNegativeNumber], Tag("<two>")]
    | Annotated[tuple[NonNegativeNumber, NonNegativeNumber, NonNegativeNumber], Tag("<three>")]
)


class OverKeuleganCarpenter(Block):
    """Coefficients of your own over the Keulegan-Carpenter number."""

    table: Annotated[
        tuple[
            Annotated[
                KcRow,
                Discriminator(lambda row: "<three>" if isinstance(row, list | tuple) and len(row) == 3 else "<two>"),
            ],
            ...,
        ],
        Field(min_length=2, max_length=1000),
        AfterValidator(_rising),
    ] = Field(
        description="Rows [KC, coefficient] or [KC, first axis, second axis], KC rising.",
        examples=[[[0.5, 1.8], [4, 1.4]]],
    )


def _drag_form(value: Any) -> str:
    if isinstance(value, OverKeuleganCarpenter) or (isinstance(value, dict) and holds_key(value, "table")):
        return "<table>"
    if isinstance(value, (dict, DragTable)):
        return "<law>"
    return "<pair>" if isinstance(value, (list, tuple)) else "<number>"


def _inertia_form(value: Any) -> str:
    if isinstance(value, (dict, OverKeuleganCarpenter)):
        return "<table>"
    if isinstance(value, str) and not value.strip()[:1].isdigit():
        return "<law>"
    return "<pair>" if isinstance(value, (list, tuple)) else "<number>"


Drag = Annotated[
    Annotated[DragTable, Tag("<law>")]
    | Annotated[OverKeuleganCarpenter, Tag("<table>")]
    | Annotated[tuple[NonNegativeNumber, NonNegativeNumber], Tag("<pair>")]
    | Annotated[NonNegativeNumber, Tag("<number>")],
    Discriminator(_drag_form),
]
Inertia = Annotated[
    Annotated[Literal["ideal", "dnv_c205", "api", "stokes_wang"], Tag("<law>")]
    | Annotated[OverKeuleganCarpenter, Tag("<table>")]
    | Annotated[tuple[NonNegativeNumber, NonNegativeNumber], Tag("<pair>")]
    | Annotated[NonNegativeNumber, Tag("<number>")],
    Discriminator(_inertia_form),
]


Rows = Annotated[tuple[tuple[PositiveNumber, NonNegativeNumber], ...], Field(max_length=1000), AfterValidator(_rising)]


def _strength_form(value: Any) -> str:
    return "<name>" if isinstance(value, str) and not value.strip()[:1].isdigit() else "<number>"


class CirculationKeys(Block):
    """The circulation of orbital flow at small KC, which lowers the inertia force."""

    purpose: Literal["extreme", "response"] = Field(
        description="extreme: the reduction is left out (safe side); response: it is counted (motions, fatigue)."
    )
    strength: Annotated[
        Annotated[Literal["arai", "otsuka", "chaplin"], Tag("<name>")] | Annotated[NonNegativeNumber, Tag("<number>")],
        Discriminator(_strength_form),
    ] = Field(
        default="arai", description="gamma of Gamma = gamma vx vy T: arai 0.936, otsuka 1, chaplin 1.036, or a number."
    )
    relaxation_periods: PositiveNumber = Field(
        default=5.0, description="Wave periods that the circulation takes to relax. Default: 5."
    )
    start: Literal["settled", "calm"] = Field(
        default="settled", description="Whether the circulation is there from the start or grows from calm."
    )
    table: Annotated[Rows, Field(max_length=1000)] = Field(
        default=(), description="Rows [KC, reduction of C_M] of your own for KC 2 to 4; they replace the law there."
    )
    beta_table: Rows = Field(default=(), description="Rows [beta, gamma] that replace 'strength'.")


class MemberMotion(Block):
    """A harmonic translation of the whole member."""

    x: NonNegativeLength = Field(default=0.0, description="Amplitude along x. Default: 0.")
    y: NonNegativeLength = Field(default=0.0, description="Amplitude along y. Default: 0.")
    z: NonNegativeLength = Field(default=0.0, description="Amplitude along z. Default: 0.")
    phase_x_deg: Heading = Field(default=0.0, description="Phase of x: amplitude cos(phase - omega t). Default: 0.")
    phase_y_deg: Heading = Field(default=0.0, description="Phase of y. Default: 0.")
    phase_z_deg: Heading = Field(default=0.0, description="Phase of z. Default: 0.")
    period: Duration | None = Field(
        default=None, description="Period; that of each regular wave when absent, needed in irregular seas."
    )


class MemberStructure(Block):
    """A straight submerged member."""

    kind: Literal["member"] = Field(description="Submerged member.")
    section: MemberSection = Field(description="Shape of the section.")
    section_angle_deg: Heading = Field(
        default=0.0, description="Angle by which the section is turned about the member. Default: 0."
    )
    start: End = Field(description="One end of the axis.")
    end: End = Field(description="The other end of the axis.")
    inertia: Inertia = Field(
        default="ideal",
        description="C_M: ideal (from the section), a law, a number, two along the axes, or {table: rows}.",
    )
    drag: Drag = Field(description="C_D: a number, two along the axes of the section, {law: name} or {table: rows}.")
    drag_form: Literal["component", "vector"] = Field(
        default="vector",
        description="Drag u|U| with the speed across the member, the same whichever way the axes lie; or u|u| along "
        "each axis by itself, as coefficients of a flow to and fro along one axis are found. Default: vector.",
    )
    kinematic_viscosity: Viscosity = Field(description="Of the water, 1.14e-6 m2/s at 15 degrees Celsius.")
    circulation: CirculationKeys | None = Field(
        default=None, description="What is done about the circulation at small KC; needed with waves."
    )
    support: Literal["both_ends", "start", "end"] = Field(
        default="both_ends",
        description="Where it is held: resting simply on both ends, or fixed at its start or its end and free at the "
        "other (a pile). Default: both_ends.",
    )
    motion: MemberMotion | None = Field(default=None, description="Motion of the member; drag is relative to it.")


class MemberRegularWaves(RegularWavesOfHeights):
    """Regular waves: every height with every period."""

    theory: Literal["automatic", "linear", "stokes", "stream_function"] = Field(  # type: ignore[assignment]
        default="automatic",
        description="Wave theory: linear, Stokes of fifth order, or stream function; automatic takes linear waves "
        "where their second harmonic is below 1 % of the first, else the stream function.",
    )


MemberSeaState = Annotated[
    MemberRegularWaves | Jonswap | PiersonMoskowitz | BretschneiderMitsuyasu | Tma | SpectrumFile,
    Field(discriminator="kind"),
]


class MemberSettingsKeys(Block):
    """How the analyses are run."""

    strips: Strips = Field(default=40, description="Strips along the member. Default: 40.")
    stretching: Literal["wheeler", "linear", "constant"] = Field(
        default="wheeler", description="Linear kinematics above still water."
    )
    steps_per_period: Steps = Field(default=200, description="Time steps in a period of regular waves. Default: 200.")
    irregular_steps: Steps = Field(
        default=40, description="Time steps in the peak period of irregular seas. Default: 40."
    )
    realisations: Annotated[int, Field(ge=1, le=100)] = Field(
        default=5,
        description="Realisations of an irregular sea, the first with the sea's own seed; largest forces are means "
        "over them. Default: 5.",
    )
    periods: Whole | None = Field(
        default=None, description="Periods shown of regular waves; chosen by the start of the circulation when absent."
    )
    water_levels: LevelNames = Field(default="all", description=LEVEL_NAMES)


class MemberCase(Block):
    """A submerged member from its site to its forces."""

    moyai: Literal[1] = Field(description="Version of the case file format.")
    title: Annotated[str, Field(min_length=1, max_length=200)] = Field(description="Title of the report.")
    site: SiteKeys = Field(description="The water of the site.")
    waves: Annotated[tuple[MemberSeaState, ...], OneOrMany(), BeforeValidator(refuse_no_seas)] = Field(
        default=(), description="One sea state, or a list of them; each is run. Without any the current runs alone."
    )
    current: SiteCurrentKeys | None = Field(default=None, description="Steady current.")
    structure: MemberStructure = Field(description="The member.")
    analyses: Annotated[tuple[Analysis, ...], Field(min_length=1), AfterValidator(once_each)] = Field(
        description="What is computed: sweep over KC, forces, what the surface changes.",
        examples=[["sweep", "forces", "surface"]],
    )
    criteria: MemberKeeps = Field(default_factory=MemberCriteria, description=CRITERIA)
    settings: MemberSettingsKeys = Field(default_factory=MemberSettingsKeys, description="How the analyses are run.")
    measured: MeasuredSets = Field(default=(), description=MEASURED)
    display: Display = Field(default_factory=Display, description=DISPLAY)
    app: AppKeys = Field(default_factory=AppKeys, description=APP)
