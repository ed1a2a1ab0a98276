"""Schema of the floating breakwater case."""

from __future__ import annotations

from typing import Annotated, Any, ClassVar, Literal

from pydantic import AfterValidator, BeforeValidator, Discriminator, Field, Tag

from moyai.case.schema_app import APP, AppKeys
from moyai.case.schema_coefficients import OfCapytaine, OfNemoh, OfWamit
from moyai.case.schema_criteria import CRITERIA
from moyai.case.schema_damping import DampingBeyondWaves
from moyai.case.schema_display import DISPLAY, Display
from moyai.case.schema_environment import SeaState, SiteCurrentKeys, SiteKeys, WindKeys, refuse_no_seas
from moyai.case.schema_lines import LineEntry
from moyai.case.schema_measured import MEASURED, MeasuredSets
from moyai.case.schema_sections import Section
from moyai.case.schema_types import (
    AddedInertia,
    AddedMass,
    Block,
    Damping,
    FileName,
    Inertia,
    KeyGroups,
    Length,
    Mass,
    NonNegativeNumber,
    OneOrMany,
    PositiveLength,
    PositiveNumber,
    RollDamping,
    RollQuadraticDamping,
    Truth,
    once_each,
)
from moyai.structures.breakwater.case.criteria import BreakwaterCriteria, BreakwaterKeeps
from moyai.structures.breakwater.settings import Analysis, BreakwaterSettings, Mode


class DampingTerms(DampingBeyondWaves):
    """Damping beyond wave radiation: computed from the section, a fraction of critical, or both."""

    modes: Annotated[tuple[Mode, ...], Field(min_length=1), AfterValidator(once_each)] | None = Field(
        default=None,
        description="Motions that the fraction is applied to.",
        examples=[["sway", "heave", "roll"]],
    )
    band: tuple[PositiveNumber, PositiveNumber] | None = Field(
        default=None,
        description="Factors on this damping for the band of transmission and motion. Default: [0.5, 2].",
    )


class RollDampingTerms(Block):
    """Measured or estimated roll damping of the whole unit."""

    linear: RollDamping = Field(default=0.0, description="b1 in b1 theta' + b2 |theta'| theta'.")
    quadratic: RollQuadraticDamping = Field(default=0.0, description="b2 in b1 theta' + b2 |theta'| theta'.")


class AdditionalMass(Block):
    """Mass that moves in one motion only, such as a rig of a model test."""

    sway: AddedMass = Field(default=0.0, description="Moves in sway only.")
    heave: AddedMass = Field(default=0.0, description="Moves in heave only.")
    roll: AddedInertia = Field(default=0.0, description="Moves in roll only.")


class AdditionalDamping(Block):
    """Linear damping of the whole unit beyond wave radiation."""

    sway: Damping = Field(default=0.0, description="Force per sway velocity.")
    heave: Damping = Field(default=0.0, description="Force per heave velocity.")
    roll: RollDamping = Field(default=0.0, description="Moment per roll velocity.")


class _Coefficients(Block):
    path: FileName = Field(description="File or folder of the program, relative to the case file.")
    sea: Literal["beam", "head"] = Field(
        description="'beam': this +x is the body's +y in the file; 'head': it is the body's +x."
    )
    origin: tuple[Length, Length] = Field(
        default=(0.0, 0.0), description="Axes of the file: [x, y] of this origin. Default: [0, 0]."
    )


class CapytaineCoefficients(OfCapytaine, _Coefficients):
    """Coefficients computed by Capytaine."""


class WamitCoefficients(OfWamit, _Coefficients):
    """Coefficients computed by WAMIT or written in its form."""


class NemohCoefficients(OfNemoh, _Coefficients):
    """Coefficients computed by NEMOH."""


CoefficientsFile = Annotated[
    CapytaineCoefficients | WamitCoefficients | NemohCoefficients, Field(discriminator="program")
]


class BreakwaterStructure(Block):
    """A floating breakwater: one unit of constant section."""

    at_least_one: ClassVar[KeyGroups] = (("draught", "mass"),)
    exactly_one: ClassVar[KeyGroups] = (("roll_gyradius", "roll_inertia"),)

    kind: Literal["breakwater"] = Field(description="Floating breakwater.")
    length: PositiveLength = Field(description="Length of the unit along its crest.")
    section: Section = Field(description="Shape of the section.")
    draught: PositiveLength | None = Field(
        default=None, description="Draught at the first water level; with 'mass' as well the imbalance is reported."
    )
    mass: Mass | None = Field(default=None, description="Mass of the unit without its lines.")
    centre_of_gravity_above_keel: Length = Field(description="Height of the centre of gravity above the keel.")
    centre_of_gravity_x: Length = Field(
        default=0.0, description="Centre of gravity from the centre line, positive along +x. Default: 0."
    )
    roll_gyradius: PositiveLength | None = Field(
        default=None, description="Roll radius of gyration about the centre of gravity."
    )
    roll_inertia: Inertia | None = Field(
        default=None, description="Roll moment of inertia of the unit about its centre of gravity; needs 'mass'."
    )
    allow_unstable: Truth = Field(
        default=False,
        description="Whether a metacentric height of 0 m or less is meant: lines hold it upright. Default: false.",
    )
    damping: DampingTerms | None = Field(
        default=None,
        description="Damping beyond wave radiation. Default: computed from the section, unless roll_damping is given.",
    )
    roll_damping: RollDampingTerms | None = Field(default=None, description="Linear and quadratic roll damping.")
    additional_mass: AdditionalMass | None = Field(
        default=None, description="Mass that moves in one motion only (rigs of model tests)."
    )
    additional_damping: AdditionalDamping | None = Field(
        default=None, description="Linear damping of the whole unit beyond wave radiation."
    )
    wind_drag_coefficient: NonNegativeNumber | None = Field(
        default=None, description="Drag coefficient of the area above water; needed with 'wind'."
    )
    current_drag_coefficient: NonNegativeNumber | None = Field(
        default=None, description="Drag coefficient of the area under water; needed with 'current'."
    )
    gap_damping_lid: NonNegativeNumber = Field(
        default=0.0, description="Damping lid in the gaps of twin pontoons: K becomes K (1 + i lid). Default: 0."
    )
    coefficients_file: CoefficientsFile | None = Field(
        default=None, description="Coefficients of a 3-D program for the whole unit in place of the section."
    )


class MeasuredColumns(Block):
    """Measured points that find their figures by the names of their columns."""

    file: FileName = Field(description="CSV, names and units in its header: 'period [s], transmission_coefficient'.")
    columns: dict[str, Annotated[str, Field(min_length=1)]] = Field(
        default_factory=dict, description="Names of columns in the file and what they are called in the results."
    )


def _columns_or_figures(value: Any) -> str:
    given = isinstance(value, (list, tuple)) or (isinstance(value, dict) and "figure" in value)
    return "<figures>" if given else "<columns>"


Measured = Annotated[
    Annotated[MeasuredColumns, Tag("<columns>")] | Annotated[MeasuredSets, Tag("<figures>")],
    Discriminator(_columns_or_figures),
]


class BreakwaterCase(Block):
    """A floating breakwater from its site to its analyses."""

    moyai: Literal[1] = Field(description="Version of the case file format.")
    title: Annotated[str, Field(min_length=1, max_length=200)] = Field(description="Title of the report.")
    site: SiteKeys = Field(description="The water of the site.")
    waves: Annotated[tuple[SeaState, ...], OneOrMany(), BeforeValidator(refuse_no_seas)] = Field(
        default=(), description="One sea state, or a list of them; each is run."
    )
    wind: WindKeys | None = Field(default=None, description="Steady wind.")
    current: SiteCurrentKeys | None = Field(default=None, description="Steady current.")
    structure: BreakwaterStructure = Field(description="The floating unit.")
    lines: tuple[LineEntry, ...] = Field(default=(), description="Mooring lines or springs.", max_length=200)
    analyses: Annotated[tuple[Analysis, ...], Field(min_length=1), AfterValidator(once_each)] = Field(
        description="What is computed.", examples=[["statics", "mooring", "frequency", "time"]]
    )
    criteria: BreakwaterKeeps = Field(default_factory=BreakwaterCriteria, description=CRITERIA)
    settings: BreakwaterSettings = Field(default_factory=BreakwaterSettings, description="How the analyses are run.")
    measured: Measured | None = Field(default=None, description=MEASURED)
    display: Display = Field(default_factory=Display, description=DISPLAY)
    app: AppKeys = Field(default_factory=AppKeys, description=APP)
