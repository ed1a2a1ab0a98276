"""Schema of the network case: points, lines and nets in free arrangement, at rest and in motion."""

from __future__ import annotations

from typing import Annotated, ClassVar, Literal

from pydantic import AfterValidator, BeforeValidator, Field

from moyai.case.schema_app import APP, AppKeys
from moyai.case.schema_criteria import CRITERIA
from moyai.case.schema_display import DISPLAY, Display
from moyai.case.schema_environment import (
    BretschneiderMitsuyasu,
    Jonswap,
    PiersonMoskowitz,
    SiteCurrentKeys,
    SiteKeys,
    SpectrumFile,
    SteepRegularWaves,
    Tma,
    _FromBearing,
    refuse_no_seas,
)
from moyai.case.schema_measured import MEASURED, MeasuredSets
from moyai.case.schema_types import (
    LEVEL_NAMES,
    AngularFrequency,
    AutoDuration,
    Block,
    Duration,
    FileName,
    KeyGroups,
    LevelNames,
    Name,
    OneOrMany,
    PositiveForce,
    PositiveLength,
    QuantityOf,
    Truth,
    Whole,
    once_each,
)
from moyai.core import quantities
from moyai.structures.network.case.criteria import NetworkCriteria, NetworkKeeps
from moyai.structures.network.case.schema_bodies import NetworkBody
from moyai.structures.network.case.schema_parts import (
    NetworkBed,
    NetworkLine,
    NetworkLineType,
    NetworkNet,
    NetworkPoint,
    NetworkSheet,
    NonNegativeDuration,
    PointMotion,
)

NetworkAnalysis = Literal["statics", "modes", "dynamic"]
Share = Annotated[float, QuantityOf(quantities.NUMBER, above=0.0, most=1.0)]
Slack = Annotated[float, QuantityOf(quantities.FORCE, least=0.0)]
Phase = Annotated[float, QuantityOf(quantities.ANGLE_DEGREES)]
Tolerance = Annotated[float, QuantityOf(quantities.NUMBER, above=0.0, below=1.0)]


class LineFails(Block):
    """A line that parts from the point at one of its ends, at a time or a tension, whichever comes first."""

    at_least_one: ClassVar[KeyGroups] = (("time", "tension"),)

    line: Name = Field(description="Name of the line.")
    at: Literal["start", "end"] = Field(description="End of the line at which it parts.")
    time: NonNegativeDuration | None = Field(default=None, description="When it parts.")
    tension: PositiveForce | None = Field(default=None, description="Tension at that end at which it parts.")


class NetworkStructure(Block):
    """Points joined by lines and nets."""

    at_least_one: ClassVar[KeyGroups] = (("lines", "nets", "sheets", "bodies"),)

    kind: Literal["network"] = Field(description="Network of lines and nets.")
    line_types: dict[Name, NetworkLineType] = Field(default={}, description="Materials, by name.", max_length=500)
    motions: dict[Name, PointMotion] = Field(
        default={}, description="Prescribed motions that driven points follow, by name.", max_length=500
    )
    points: dict[Name, NetworkPoint] = Field(default={}, description="Points, by name.", max_length=20_000)
    lines: dict[Name, NetworkLine] = Field(default={}, description="Lines between points, by name.", max_length=20_000)
    nets: dict[Name, NetworkNet] = Field(
        default={},
        description="Nets, by name; their knots are points called 'name[row,column]', counted from 0.",
        max_length=50,
    )
    sheets: dict[Name, NetworkSheet] = Field(
        default={},
        description="Sheets, by name; their knots are points called 'name[row,column]', counted from 0.",
        max_length=50,
    )
    bodies: dict[Name, NetworkBody] = Field(
        default={},
        description="Rigid bodies in six degrees of freedom, by name; lines meet their points.",
        max_length=50,
    )
    bed: NetworkBed | None = Field(default=None, description="Contact with the bed; none when left out.")
    failures: Annotated[tuple[LineFails, ...], Field(max_length=1000)] = Field(
        default=(), description="Lines that part in the course of a run."
    )


class SingleWave(_FromBearing):
    """One wave of a sea."""

    exactly_one: ClassVar[KeyGroups] = (*_FromBearing.exactly_one, ("period", "angular_frequency"))

    amplitude: PositiveLength = Field(description="Amplitude.")
    period: Duration | None = Field(default=None, description="Period.")
    angular_frequency: AngularFrequency | None = Field(default=None, description="Angular frequency.")
    phase_deg: Phase = Field(default=0.0, description="Phase at the origin at the time 0; 0 is a crest. Default: 0.")


class WavesOneByOne(Block):
    """A sea given wave by wave."""

    kind: Literal["components"] = Field(description="A sum of linear waves, each with its phase.")
    name: Name | None = Field(default=None, description="Label of the sea state in results; made up when absent.")
    waves: Annotated[tuple[SingleWave, ...], Field(min_length=1, max_length=10_000)] = Field(
        description="Its waves, amplitude cos(k (x cos b + y sin b) - omega t + phase)."
    )


class ElevationRecord(_FromBearing):
    """A sea whose elevation at the origin was recorded."""

    kind: Literal["elevation_record"] = Field(description="A record of the elevation at the origin, long-crested.")
    name: Name | None = Field(default=None, description="Label of the sea state in results; made up when absent.")
    file: FileName = Field(
        description="Text file of time [s] and elevation [m], comma, semicolon, tab or blank separated; a heading is "
        "allowed. Its first row is the time 0; past its end it repeats."
    )
    time_step: Duration | None = Field(
        default=None, description="Even step that the record is taken at. Default: its smallest."
    )


NetworkSea = Annotated[
    SteepRegularWaves | Jonswap | PiersonMoskowitz | BretschneiderMitsuyasu | Tma | SpectrumFile | WavesOneByOne
    | ElevationRecord,
    Field(discriminator="kind"),
]  # fmt: skip


class CurrentInTime(Block):
    """A current that changes with time, place or direction, from a file in a form of MoorDyn."""

    file: FileName = Field(description="Text file, relative to the case file.")
    form: Literal["profile", "grid", "steady"] = Field(
        description="profile: velocities over the height at several times (current_profile_dynamic.txt of MoorDyn); "
        "grid: on a grid of x, y, z and time (current_profile_4d.txt); steady: over the height, whose direction may "
        "turn (current_profile.txt)."
    )


class NetworkSettingsKeys(Block):
    """How the analyses are run."""

    duration: AutoDuration = Field(
        default=None,
        description="Length of a run in still water or regular waves; 'auto': twenty periods of the waves or motions. "
        "Irregular seas have their own.",
    )
    output_step: AutoDuration = Field(
        default=None, description="Time between two rows of the results; 'auto': a hundredth of the shortest period."
    )
    ramp: NonNegativeDuration | None = Field(
        default=None, description="Time over which waves and current grow. Default: one period of the waves, or 0."
    )
    start: Literal["rest", "rest_in_current", "as_built"] | None = Field(
        default=None,
        description="Where a run begins: at rest in still water, at rest in the current (which is then there from the "
        "start), or as built. Default: rest_in_current where there is a steady current, else rest.",
    )
    resume: FileName | None = Field(
        default=None,
        description="results.nc of an interrupted run of this case, whose runs continue from their last state.",
    )
    method: Literal["auto", "explicit", "tr_bdf2", "esdirk4"] = Field(
        default="auto",
        description="explicit: steps at the pace of the elastic wave; tr_bdf2, esdirk4: implicit, steps by their "
        "error, and often quicker with sheets; auto: explicit.",
    )
    step: AutoDuration = Field(default=None, description="Time step; 'auto': the largest that is safe.")
    wave_front: Truth = Field(
        default=False, description="Explicit steps exactly at the pace of the elastic wave, for a sharp front."
    )
    tolerance: Tolerance = Field(default=1e-4, description="Error of one implicit step. Default: 1e-4.")
    stretching: Literal["wheeler", "linear", "constant"] = Field(
        default="wheeler", description="Kinematics of the waves above still water."
    )
    skip: NonNegativeDuration | None = Field(
        default=None,
        description="Beginning of each run that peaks and statistics leave out. Default: one mean period of a motion "
        "that swings and begins displaced or at speed; five periods of waves, at most a quarter of the run; else 0; "
        "where what floats drifts longer to its mean place, until it has reached it, at most half of the run.",
    )
    sensitivity: Truth = Field(
        default=False,
        description="Run again with half the step, half the bars, half and twice the viscosity, for the "
        "accuracy of the peak.",
    )
    mesh_check: Literal["auto", "off"] = Field(
        default="auto",
        description="auto: run again with half the step and with twice the segments where that takes little time, or "
        "where snaps, fronts or few segments make the peak doubtful; off: do not.",
    )
    peak_goal: Tolerance = Field(
        default=0.05,
        description="Change of the highest tension with half the step or twice the segments above which a run is not "
        "converged. Default: 0.05.",
    )
    realisations: Annotated[int, Field(strict=True, ge=1, le=100)] | None = Field(
        default=None,
        description="Realisations of each irregular sea, the first with its 'seed'; highest tensions, pulls and "
        "offsets are means over them. Default: 4 to 20, as many as take little time, where lines alone are run; "
        "else 1.",
    )
    slack_level: Slack = Field(default=0.0, description="Tension at or below which a line is slack. Default: 0.")
    snap_threshold: PositiveForce | None = Field(
        default=None, description="Peak above which a contact is a snap; the mean of the taut tension when left out."
    )
    modes: Whole = Field(default=6, description="Number of natural modes. Default: 6.")
    stiffness_step: Annotated[float, QuantityOf(quantities.LENGTH, above=0.0)] | None = Field(
        default=None, description="Displacement that the stiffness at driven points is taken over; 1 mm to 1 cm."
    )
    water_levels: LevelNames = Field(default="all", description=LEVEL_NAMES)


class NetworkCase(Block):
    """A network from its site to its tensions."""

    moyai: Literal[1] = Field(description="Version of the case file format.")
    title: Annotated[str, Field(min_length=1, max_length=200)] = Field(description="Title of the report.")
    site: SiteKeys = Field(description="The water of the site.")
    waves: Annotated[tuple[NetworkSea, ...], OneOrMany(), BeforeValidator(refuse_no_seas)] = Field(
        default=(), description="One sea state, or a list of them; each is run. Still water when left out."
    )
    current: SiteCurrentKeys | None = Field(default=None, description="Steady current.")
    current_field: CurrentInTime | None = Field(
        default=None, description="A current that changes with time, in place of 'current'; it acts in 'dynamic'."
    )
    structure: NetworkStructure = Field(description="The network.")
    analyses: Annotated[tuple[NetworkAnalysis, ...], Field(min_length=1), AfterValidator(once_each)] = Field(
        description="What is computed.", examples=[["statics", "modes", "dynamic"]]
    )
    plausibility: Literal["refuse", "warn"] = Field(
        default="refuse",
        description="What is done with impossible numbers; cases made from decks are warned. Default: refuse.",
    )
    criteria: NetworkKeeps = Field(default_factory=NetworkCriteria, description=CRITERIA)
    settings: NetworkSettingsKeys = Field(default_factory=NetworkSettingsKeys, description="How the analyses are run.")
    measured: MeasuredSets = Field(default=(), description=MEASURED)
    display: Display = Field(default_factory=Display, description=DISPLAY)
    app: AppKeys = Field(default_factory=AppKeys, description=APP)
