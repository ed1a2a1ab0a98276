"""Schema of the net cage case: the frame that rigid and flexible cages share, and the rigid cage."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import AfterValidator, BeforeValidator, Field

from moyai.case.schema_app import APP, AppKeys
from moyai.case.schema_criteria import CRITERIA
from moyai.case.schema_display import DISPLAY, Display
from moyai.case.schema_environment import (
    STEEP_THEORY,
    BretschneiderMitsuyasu,
    Jonswap,
    PiersonMoskowitz,
    RegularWavesOfHeights,
    SiteCurrentKeys,
    SiteKeys,
    SpectrumFile,
    SteepTheory,
    Tma,
    refuse_no_seas,
)
from moyai.case.schema_measured import MEASURED, MeasuredSets
from moyai.case.schema_types import (
    LEVEL_NAMES,
    Block,
    Duration,
    LevelNames,
    NonNegativeNumber,
    OneOrMany,
    PositiveNumber,
    QuantityOf,
    Stiffness,
    once_each,
)
from moyai.core import quantities
from moyai.structures.cage.case.criteria import CageCriteria, CageKeeps
from moyai.structures.cage.case.schema_flexible import FlexibleCageSettings, FlexibleCageStructure
from moyai.structures.cage.case.schema_parts import (
    CageMooring,
    RigidFloats,
    RigidFrame,
    RigidNet,
    RigidShape,
    RigidWeight,
    SinkerKeys,
)

Analysis = Literal["statics", "time", "sensitivity"]
Viscosity = Annotated[float, QuantityOf(quantities.VISCOSITY, above=0.0)]
Count = Annotated[int, Field(strict=True, ge=1, le=100_000)]
Patches = Annotated[int, Field(strict=True, ge=1, le=40)]
Samples = Annotated[int, Field(strict=True, ge=16, le=2000)]
Tolerance = Annotated[float, QuantityOf(quantities.NUMBER, least=1e-12, most=1e-3)]


class RigidCageStructure(Block):
    """A rigid net cage that moves in the plane of the waves."""

    kind: Literal["cage"] = Field(description="Net cage.")
    model: Literal["rigid"] = Field(description="Rigid body of three degrees of freedom: sway, heave, rotation.")
    equations: Literal["sound", "literal"] = Field(
        default="sound",
        description="sound: complete rigid-body mechanics; literal: as Matsubara et al. print them, with their errors.",
    )
    kinematic_viscosity: Viscosity = Field(description="Of the water, 1.14e-6 m2/s at 15 degrees Celsius.")
    shape: RigidShape = Field(description="Box or upright cylinder that the nets span.")
    net: RigidNet = Field(description="The net, the same on all faces.")
    frame: RigidFrame = Field(description="Rods along the edges.")
    floats: RigidFloats = Field(description="Spherical floats on the top frame.")
    sinkers: Annotated[tuple[SinkerKeys, ...], OneOrMany(), Field(max_length=100)] = Field(
        default=(), description="Weights fixed to the cage. Default: none."
    )
    weight: RigidWeight | None = Field(
        default=None, description="Weight as the cage was weighed; compared with the sum of its parts."
    )
    mooring: CageMooring | None = Field(default=None, description="Lines; the cage floats freely when absent.")


CageStructure = Annotated[RigidCageStructure | FlexibleCageStructure, Field(discriminator="model")]


class CageRegularWaves(RegularWavesOfHeights):
    """Regular waves: every height with every period."""

    theory: SteepTheory = Field(default="automatic", description=STEEP_THEORY)  # type: ignore[assignment]


CageSeaState = Annotated[
    CageRegularWaves | Jonswap | PiersonMoskowitz | BretschneiderMitsuyasu | Tma | SpectrumFile,
    Field(discriminator="kind"),
]


class RigidCageSettingsKeys(Block):
    """How the rigid cage is computed."""

    patches: Patches = Field(default=3, description="Points of Gauss along each edge of a net face. Default: 3.")
    periods: Count = Field(default=40, description="Wave periods run in regular waves. Default: 40.")
    settled_periods: Count = Field(
        default=20, description="Last periods that amplitudes and extremes are taken from. Default: 20."
    )
    ramp_periods: NonNegativeNumber = Field(
        default=5.0, description="Periods over which the waves grow from nothing. Default: 5."
    )
    samples_per_period: Samples = Field(default=100, description="Rows written in a wave period. Default: 100.")
    stretching: Literal["constant", "wheeler"] = Field(
        default="constant", description="Kinematics above still water: frozen at it, or stretched."
    )
    tolerance: Tolerance = Field(default=1e-6, description="Local error of a time step, relative. Default: 1e-6.")
    fixed_step: Duration | None = Field(
        default=None, description="Runge-Kutta of fourth order with this step instead of adaptive steps."
    )
    realisations: Annotated[int, Field(strict=True, ge=1, le=100)] = Field(
        default=5,
        description="Realisations of an irregular sea, the first with the sea's own seed; largest tensions and "
        "offset are means over them. The literal equations run the first alone. Default: 5.",
    )
    stiffness_factors: Annotated[
        tuple[PositiveNumber, ...], Field(min_length=2, max_length=30), AfterValidator(once_each)
    ] = Field(
        default=(1.0 / 3.0, 1.0, 10.0 / 3.0, 10.0),
        description="Multiples of the line stiffness that `sensitivity` runs. Default: 1/3, 1, 10/3, 10.",
    )
    stiffnesses: Annotated[tuple[Stiffness, ...], Field(max_length=30), AfterValidator(once_each)] = Field(
        default=(), description="Line stiffnesses that `sensitivity` runs instead of the multiples."
    )


class CageSettings(Block):
    """How the analyses are run."""

    rigid: RigidCageSettingsKeys = Field(
        default_factory=RigidCageSettingsKeys, description="Settings of `model: rigid`."
    )
    flexible: FlexibleCageSettings = Field(
        default_factory=FlexibleCageSettings, description="Settings of `model: flexible`."
    )
    water_levels: LevelNames = Field(default="all", description=LEVEL_NAMES)


class CageCase(Block):
    """A net cage from its site to motions and line tensions."""

    moyai: Literal[1] = Field(description="Version of the case file format.")
    title: Annotated[str, Field(min_length=1, max_length=200)] = Field(description="Title of the report.")
    site: SiteKeys = Field(description="The water of the site.")
    waves: Annotated[tuple[CageSeaState, ...], OneOrMany(), BeforeValidator(refuse_no_seas)] = Field(
        default=(), description="One sea state, or a list of them; each is run."
    )
    current: SiteCurrentKeys | None = Field(default=None, description="Steady current.")
    structure: CageStructure = Field(description="The cage.")
    analyses: Annotated[tuple[Analysis, ...], Field(min_length=1), AfterValidator(once_each)] = Field(
        description="What is computed: rest position, motions and tensions over time, what line stiffness changes.",
        examples=[["statics", "time", "sensitivity"]],
    )
    criteria: CageKeeps = Field(default_factory=CageCriteria, description=CRITERIA)
    settings: CageSettings = Field(default_factory=CageSettings, description="How the analyses are run.")
    measured: MeasuredSets = Field(default=(), description=MEASURED)
    display: Display = Field(default_factory=Display, description=DISPLAY)
    app: AppKeys = Field(default_factory=AppKeys, description=APP)
