"""Schema of the floating row of units."""

from __future__ import annotations

from typing import Annotated, Any, ClassVar, Literal

from pydantic import AfterValidator, BeforeValidator, Discriminator, Field, Tag

from moyai.case.schema_app import APP, AppKeys
from moyai.case.schema_coefficients import word_of
from moyai.case.schema_criteria import CRITERIA
from moyai.case.schema_damping import DampingBeyondWaves
from moyai.case.schema_display import DISPLAY, Display
from moyai.case.schema_environment import SeaState, SiteCurrentKeys, SiteKeys, WindKeys, refuse_no_seas
from moyai.case.schema_lines import CatenaryLine, SpringLineKeys
from moyai.case.schema_measured import MEASURED, MeasuredSets
from moyai.case.schema_sections import Section
from moyai.case.schema_types import (
    LEVEL_NAMES,
    AngularFrequency,
    Auto,
    AutoDuration,
    Block,
    Damping,
    FileName,
    Heading,
    KeyGroups,
    Length,
    LevelNames,
    Name,
    NonNegativeNumber,
    OneOrMany,
    PositiveLength,
    QuantityOf,
    Range,
    RollDamping,
    Truth,
    Whole,
    once_each,
)
from moyai.core import quantities
from moyai.structures.units.case.criteria import UnitsCriteria, UnitsKeeps
from moyai.structures.units.case.schema_connectors import ConnectorEntry

Mode = Literal["sway", "surge", "heave", "pitch", "roll", "yaw"]
Analysis = Literal["statics", "frequency", "map", "time"]


class UnitPlace(Block):
    """Where a unit lies."""

    x: Length = Field(default=0.0, description="Its middle, across the row. Default: 0.")
    y: Length = Field(description="Its middle, along the row.")
    heading_deg: Heading = Field(default=0.0, description="Angle of its axes to those of the row. Default: 0.")


class Units(Block):
    """How many units there are, and where."""

    exactly_one: ClassVar[KeyGroups] = (("count", "places"),)
    at_most_one: ClassVar[KeyGroups] = (("gap", "places"),)

    length: PositiveLength = Field(description="Length of one unit along its axis.")
    count: Annotated[int, Field(strict=True, ge=1, le=60)] | None = Field(
        default=None, description="Number of units one after the other along y, the middle of the row at the origin."
    )
    gap: PositiveLength | None = Field(
        default=None, description="Clear water between two units; a unit alone has none."
    )
    places: Annotated[tuple[UnitPlace, ...], Field(max_length=60)] = Field(
        default=(), description="In place of count and gap: every unit with its place, for L, T and bent rows."
    )

    @classmethod
    def _between_keys(cls, data: dict[str, Any]) -> list[tuple[str, str, str]]:
        faults = super()._between_keys(data)
        if data.get("count", 1) != 1 and "gap" not in data and "places" not in data:
            faults.append(("", "'gap' is missing", "give the clear water between two units"))
        return faults


class UnitDamping(DampingBeyondWaves):
    """Damping beyond wave radiation: computed from the section, a fraction of critical, or both."""

    modes: Annotated[tuple[Mode, ...], Field(min_length=1), AfterValidator(once_each)] | None = Field(
        default=None, description="Motions that the fraction is applied to.", examples=[["sway", "heave", "roll"]]
    )


class AdditionalUnitDamping(Block):
    """Linear damping of a unit beyond wave radiation."""

    sway: Damping = Field(default=0.0, description="Force per velocity along x of the unit.")
    surge: Damping = Field(default=0.0, description="Force per velocity along y.")
    heave: Damping = Field(default=0.0, description="Force per velocity along z.")
    pitch: RollDamping = Field(default=0.0, description="Moment per turning rate about x.")
    roll: RollDamping = Field(default=0.0, description="Moment per turning rate about y.")
    yaw: RollDamping = Field(default=0.0, description="Moment per turning rate about z.")


Point = tuple[Length, Length, Length]


class _RowCoefficients(Block):
    path: FileName = Field(description="File or folder of the program, relative to the case file.")
    bodies: Annotated[tuple[Annotated[str, BeforeValidator(word_of)], ...], Field(max_length=60)] = Field(
        default=(),
        description="Bodies of the file in the order of the units, by name or by number from 1. Default: as in the "
        "file.",
    )
    origin: tuple[Length, Length] = Field(
        default=(0.0, 0.0), description="Origin of the axes of the file in those of the row, [x, y]. Default: [0, 0]."
    )
    x_axis_heading_deg: Heading = Field(
        default=0.0, description="Angle from the x axis of the row to that of the file. Default: 0."
    )


class CapytaineRow(_RowCoefficients):
    """Coefficients computed by Capytaine."""

    program: Literal["capytaine"] = Field(description="NetCDF written by Capytaine.")
    reference_points: tuple[Point, ...] = Field(
        default=(),
        description="Rotation centre [x, y, z] of every body, axes of the file, where it does not give them.",
    )


class WamitRow(_RowCoefficients):
    """Coefficients computed by WAMIT or written in its form."""

    program: Literal["wamit"] = Field(description="WAMIT .1 and .3 files; .8 and .9 for the mean drift.")
    reference_points: tuple[Point, ...] = Field(
        default=(), description="Origin of the axes of every body [x, y, z]; from the .pot file when absent."
    )
    length_scale: PositiveLength | None = Field(default=None, description="ULEN; from the .gdf files when absent.")
    first_column: Literal["period", "angular_frequency", "wave_number"] | None = Field(
        default=None, description="Meaning of the first column; must be given for HAMS."
    )


class NemohRow(_RowCoefficients):
    """Coefficients computed by NEMOH."""

    program: Literal["nemoh"] = Field(description="Folder with Nemoh.cal and Results.")


class BemioRow(_RowCoefficients):
    """Coefficients in the form of BEMIO."""

    program: Literal["bemio"] = Field(description="HDF5 file written by BEMIO.")
    reference_points: Annotated[tuple[Point, ...], Field(min_length=1)] = Field(
        description="Point [x, y, z] that moments of every body are about, axes of the file, which does not give them."
    )


class AqwaRow(_RowCoefficients):
    """Coefficients computed by AQWA."""

    program: Literal["aqwa"] = Field(description=".AH1 file of AQWA.")
    phase_at: Literal["centre_of_gravity", "origin"] | None = Field(
        default=None, description="Where the crest is that phases refer to; needed with bodies off the origin."
    )


RowCoefficientsFile = Annotated[CapytaineRow | WamitRow | NemohRow | BemioRow | AqwaRow, Field(discriminator="program")]


class UnitsStructure(Block):
    """A floating breakwater of several equal units."""

    kind: Literal["units"] = Field(description="Floating row of units.")
    section: Section = Field(description="Shape of the section of every unit.")
    units: Units = Field(description="Number, length and places of the units.")
    draught: PositiveLength = Field(description="Draught at the first water level; the masses follow from it.")
    centre_of_gravity_above_keel: Length = Field(description="Height of the centre of gravity above the keel.")
    pitch_gyradius: PositiveLength = Field(
        description="Radius of gyration about x, across the unit; of an even mass along it length / sqrt(12)."
    )
    roll_gyradius: PositiveLength = Field(description="Radius of gyration about y, along the unit.")
    yaw_gyradius: PositiveLength = Field(description="Radius of gyration about z.")
    connectors: Annotated[tuple[ConnectorEntry, ...], Field(max_length=200)] = Field(
        default=(), description="What joins the units. Default: nothing, they float freely next to each other."
    )
    damping: UnitDamping = Field(
        default_factory=UnitDamping, description="Damping beyond wave radiation. Default: computed from the section."
    )
    additional_damping: AdditionalUnitDamping | None = Field(
        default=None, description="Linear damping beyond wave radiation."
    )
    coefficients_file: RowCoefficientsFile | None = Field(
        default=None,
        description="Coefficients of all units together from the files of another program, in place of the computation "
        "by panels.",
    )
    gap_damping_lid: NonNegativeNumber = Field(
        default=0.0,
        description="Damping of the water surface between neighbours: K becomes K (1 + i lid). Default: 0.",
    )
    wind_drag_coefficient: NonNegativeNumber | None = Field(
        default=None, description="Drag coefficient of the area above water; needed with 'wind'."
    )
    current_drag_coefficient: NonNegativeNumber | None = Field(
        default=None, description="Drag coefficient of the area under water; needed with 'current'."
    )


def _word_or_list(value: Any) -> str:
    return "<word>" if isinstance(value, str) or value is None else "<list>"


UnitNumbers = Annotated[
    Annotated[Literal["all"], Tag("<word>")]
    | Annotated[tuple[Whole, ...], Field(min_length=1), AfterValidator(once_each), Tag("<list>")],
    Discriminator(_word_or_list),
]
_UNITS = "Units that have it, counted from 1; places count from the middle of each. Default: all."


class UnitCatenaryLine(CatenaryLine):
    """Identical lines of chain or rope between the bed and a unit."""

    units: UnitNumbers = Field(default="all", description=_UNITS)


class UnitSpringLine(SpringLineKeys):
    """Identical linear springs between a fixed point and a unit."""

    units: UnitNumbers = Field(default="all", description=_UNITS)


def _line_form(value: Any) -> str:
    if isinstance(value, dict):
        return f"<{value.get('kind', 'catenary')}>"
    return "<spring>" if isinstance(value, SpringLineKeys) else "<catenary>"


UnitLineEntry = Annotated[
    Annotated[UnitCatenaryLine, Tag("<catenary>")] | Annotated[UnitSpringLine, Tag("<spring>")],
    Discriminator(_line_form),
]


class MapPoint(Block):
    """A point that K is given at, such as a berth."""

    name: Name = Field(description="Name of the point in results.")
    x: Length = Field(description="Across the row; waves of heading 0 travel towards +x.")
    y: Length = Field(description="Along the row.")


class LineBehind(Block):
    """The line that transmission is averaged over."""

    start: tuple[Length, Length] = Field(description="One end [x, y].", examples=[["30 m", "-40 m"]])
    end: tuple[Length, Length] = Field(description="The other end [x, y].", examples=[["30 m", "40 m"]])


Cells = Annotated[int, Field(strict=True, ge=2, le=400)]


class MapBlock(Block):
    """Where the waves around the row are computed."""

    x: tuple[Length, Length] = Field(description="From and to, across the row.", examples=[["-40 m", "120 m"]])
    y: tuple[Length, Length] = Field(description="From and to, along the row.", examples=[["-80 m", "80 m"]])
    points_across: Cells = Field(default=33, description="Points of the map along x. Default: 33.")
    points_along: Cells = Field(default=33, description="Points of the map along y. Default: 33.")
    points: Annotated[tuple[MapPoint, ...], Field(max_length=200)] = Field(
        default=(), description="Named points, for instance berths."
    )
    line: LineBehind | None = Field(
        default=None, description="Line behind the row whose mean K is the transmission. Default: none."
    )


class RowFrequencyRange(Range):
    """Evenly spaced angular frequencies."""

    first: AngularFrequency = Field(alias="from", description="First angular frequency.")
    last: AngularFrequency = Field(alias="to", description="Last angular frequency.")


def _form(value: Any) -> str:
    if isinstance(value, str) or value is None:
        return "<word>"
    return "<range>" if isinstance(value, (dict, Range)) else "<list>"


PanelSize = Annotated[float | None, QuantityOf(quantities.LENGTH, above=0.0, words=(("auto", None),))]


class RowTimeSettings(Block):
    """How the time domain is run."""

    duration: AutoDuration = Field(default=None, description="Simulated time in regular waves. Default: auto.")
    ramp: AutoDuration = Field(default=None, description="Length of the ramp of the waves. Default: auto.")
    time_step: AutoDuration = Field(
        default=None,
        description="Time step. Default: auto, a fortieth of the shortest waves, less where connectors come tight.",
    )
    analysed_periods: Whole = Field(
        default=10, description="Whole periods at the end that are analysed in regular waves. Default: 10."
    )
    realisations: Annotated[int, Field(strict=True, ge=1, le=100)] = Field(
        default=5,
        description="Realisations of each irregular sea, the first with its 'seed'; numbers are means over them. "
        "Default: 5.",
    )
    memory_frequencies: Annotated[int, Field(strict=True, ge=8, le=400)] = Field(
        default=24,
        description="Frequencies that the memory of the water is fitted to, those of the seas among them. Default: 24.",
    )


class UnitsSettings(Block):
    """How the analyses are run."""

    panel_size: PanelSize = Field(
        default=None,
        description="Largest step of the panels. Default: auto, an eighth of the shortest wave, at most a sixth of the "
        "beam and an eighth of a unit.",
    )
    frequencies: Annotated[
        Annotated[Auto, Tag("<word>")]
        | Annotated[tuple[AngularFrequency, ...], Field(min_length=1, max_length=1000), Tag("<list>")]
        | Annotated[RowFrequencyRange, Tag("<range>")],
        Discriminator(_form),
    ] = Field(
        default="auto",
        description="Angular frequencies of the coefficients: auto, a list, or {from, to, count}; those of regular "
        "waves are added.",
    )
    frequency_count: Annotated[int, Field(strict=True, ge=4, le=400)] = Field(
        default=20, description="Frequencies over the energy of each irregular sea, with auto. Default: 20."
    )
    drift: Truth = Field(default=True, description="Whether the mean drift force moves the row. Default: true.")
    compare_with_section: Truth = Field(
        default=True, description="Whether the two-dimensional section is computed as well. Default: true."
    )
    time: RowTimeSettings = Field(default_factory=RowTimeSettings, description="How the time domain is run.")
    water_levels: LevelNames = Field(default="all", description=LEVEL_NAMES)


class UnitsCase(Block):
    """A floating row of units from its site to its analyses."""

    moyai: Literal[1] = Field(description="Version of the case file format.")
    title: Annotated[str, Field(min_length=1, max_length=200)] = Field(description="Title of the report.")
    site: SiteKeys = Field(description="The water of the site.")
    waves: Annotated[tuple[SeaState, ...], OneOrMany(), BeforeValidator(refuse_no_seas)] = Field(
        default=(), description="One sea state, or a list of them; each is run."
    )
    wind: WindKeys | None = Field(default=None, description="Steady wind.")
    current: SiteCurrentKeys | None = Field(default=None, description="Steady current.")
    structure: UnitsStructure = Field(description="The row of units.")
    lines: Annotated[tuple[UnitLineEntry, ...], Field(max_length=200)] = Field(
        default=(), description="Mooring lines or springs."
    )
    map: MapBlock | None = Field(default=None, description="Map of the waves; needed with the analysis 'map'.")
    analyses: Annotated[tuple[Analysis, ...], Field(min_length=1), AfterValidator(once_each)] = Field(
        description="What is computed.", examples=[["statics", "frequency", "time", "map"]]
    )
    criteria: UnitsKeeps = Field(default_factory=UnitsCriteria, description=CRITERIA)
    settings: UnitsSettings = Field(default_factory=UnitsSettings, description="How the analyses are run.")
    measured: MeasuredSets = Field(default=(), description=MEASURED)
    display: Display = Field(default_factory=Display, description=DISPLAY)
    app: AppKeys = Field(default_factory=AppKeys, description=APP)
