"""The study file: a base case, how it is varied, what is kept of every case."""

from __future__ import annotations

from typing import Annotated, Any, ClassVar, Literal

from pydantic import Field

from moyai.case.schema_types import (
    Block,
    Duration,
    FileName,
    KeyGroups,
    Name,
    NonNegativeNumber,
    Number,
    OneOrMany,
    PositiveForce,
    PositiveLength,
    PositiveNumber,
    Range,
    Seed,
    Truth,
    Whole,
)

Value = Any
"""What a key of the case takes: the case's own schema judges it."""


class Spread(Range):
    """Evenly spaced values from one to another."""

    first: Annotated[Value, Field(alias="from", description="First value, as the case file would hold it.")]
    last: Annotated[Value, Field(alias="to", description="Last value.")]


class NamedCaseKeys(Block):
    """One named case of a list."""

    label: Annotated[Name, Field(description="Name of the case in the results.")]
    set: Annotated[dict[str, Value], Field(default_factory=dict, description="Values by their paths.")]
    remove: Annotated[tuple[str, ...], Field(description="Paths that this case leaves out.")] = ()

    at_least_one: ClassVar[KeyGroups] = (("set", "remove"),)


class ListOfCases(Block):
    """Named cases, each with what it changes."""

    name: Annotated[Name, Field(description="Name of the axis in the results.")] = "layout"
    cases: Annotated[tuple[NamedCaseKeys, ...], Field(min_length=1, description="The cases, in the order of the axis.")]


class TableOfCases(Block):
    """Cases from the rows of a CSV file."""

    name: Annotated[Name, Field(description="Name of the axis in the results.")] = "row"
    file: Annotated[FileName, Field(description="CSV with one heading row, relative to this file; a row is a case.")]
    columns: Annotated[
        dict[str, str], Field(min_length=1, description="Path of the case for each column that is used.")
    ]
    units: Annotated[
        dict[str, str], Field(default_factory=dict, description="Unit of a column, where its values carry none.")
    ]


class ReturnPeriods(Block):
    """Waves and currents of several return periods, combined in pairs."""

    name: Annotated[Name, Field(description="Name of the axis in the results.")] = "return_period"
    waves: Annotated[dict[str, dict[str, Value]], Field(min_length=1, description="Values by return period.")]
    current: Annotated[dict[str, dict[str, Value]], Field(min_length=1, description="Values by return period.")]
    pairs: Annotated[
        Literal["automatic"] | tuple[tuple[str, str], ...],
        Field(description="automatic: the rarest waves with the next rarer current, and the reverse."),
    ] = "automatic"


class Scatter(Block):
    """A scatter diagram of sea states with their probabilities."""

    name: Annotated[Name, Field(description="Name of the axis in the results.")] = "sea_state"
    file: Annotated[
        FileName,
        Field(description="CSV, relative to this file: a list of sea states, or a matrix of heights and periods."),
    ]
    significant_height: Annotated[str, Field(description="Path of the significant wave height.")]
    period: Annotated[str, Field(description="Path of the period by which the diagram is sorted.")]
    counts: Annotated[Truth, Field(description="The cells are numbers of sea states, not probabilities.")] = False


class JointDistribution(Block):
    """Joint distribution of significant height and period, fitted elsewhere."""

    location: Annotated[Number, Field(description="Smallest height of the Weibull distribution [m].")]
    scale: Annotated[PositiveNumber, Field(description="Of the Weibull distribution [m].")]
    shape: Annotated[PositiveNumber, Field(description="Of the Weibull distribution [-].")]
    mean_log: Annotated[tuple[Number, Number, Number], Field(description="a0, a1, a2 in a0 + a1 h^a2.")]
    deviation_log: Annotated[tuple[Number, Number, Number], Field(description="b0, b1, b2 in b0 + b1 exp(b2 h).")]


class PairsOfSeas(Block):
    """Pairs of significant height and period from which the joint distribution is fitted."""

    file: Annotated[FileName, Field(description="CSV, a row a sea state.")]
    significant_height: Annotated[str, Field(description="Column [m].")]
    period: Annotated[str, Field(description="Column [s].")]
    location: Annotated[Number, Field(description="Smallest height of the Weibull distribution [m].")]


class ContourKeys(Block):
    """Sea states round an environmental contour (inverse first-order reliability)."""

    name: Annotated[Name, Field(description="Name of the axis in the results.")] = "contour"
    years: Annotated[PositiveNumber, Field(description="Return period [years].")]
    duration: Annotated[Duration, Field(description="Of a sea state.")]
    count: Annotated[int, Field(strict=True, ge=4, le=360, description="Number of sea states on the contour.")] = 24
    joint: Annotated[
        JointDistribution | None,
        Field(description="Joint distribution of significant height and period, fitted elsewhere."),
    ] = None
    pairs: Annotated[
        PairsOfSeas | None, Field(description="File of sea states to which the joint distribution is fitted.")
    ] = None
    significant_height: Annotated[str, Field(description="Path of the significant wave height.")]
    period: Annotated[str, Field(description="Path of the period of the joint distribution.")]
    least_height: Annotated[NonNegativeNumber, Field(description="Calmer points are left out [m].")] = 0.0

    exactly_one: ClassVar[KeyGroups] = (("joint", "pairs"),)


class SpectraOfFile(Block):
    """The spectra of a file of SWAN, WAVEWATCH III, NDBC (or what wavespectra reads), one case a time."""

    name: Annotated[Name, Field(description="Name of the axis in the results.")] = "record"
    file: Annotated[FileName, Field(description="File of spectra, relative to this file.")]
    sea: Annotated[str, Field(description="Path of the sea state that they replace.")]
    place: Annotated[int, Field(strict=True, ge=0, description="Number of the place in the file, counted from 0.")] = 0
    records: Annotated[
        tuple[Annotated[int, Field(strict=True, ge=0)], ...],
        Field(description="Numbers of the times; all when absent."),
    ] = ()
    direction: Annotated[Truth, Field(description="Let the waves come from the mean direction of the file.")] = False


class Distribution(Block):
    """How one value is spread."""

    uniform: Annotated[tuple[Value, Value] | None, Field(description="Smallest and largest value.")] = None
    normal: Annotated[tuple[Value, Value] | None, Field(description="Mean and standard deviation.")] = None
    lognormal: Annotated[tuple[Value, Value] | None, Field(description="Mean and standard deviation.")] = None

    exactly_one: ClassVar[KeyGroups] = (("uniform", "normal", "lognormal"),)


class SampleKeys(Block):
    """Cases drawn from distributions."""

    name: Annotated[Name, Field(description="Name of the axis in the results.")] = "sample"
    method: Annotated[
        Literal["latin_hypercube", "sobol"],
        Field(description="How the samples are spread: Latin hypercube, or the scrambled sequence of Sobol."),
    ] = "latin_hypercube"
    count: Annotated[Whole, Field(description="Number of samples.")]
    seed: Annotated[Seed, Field(description="Of the random numbers; the same seed gives the same samples.")]
    variables: Annotated[
        dict[str, Distribution], Field(min_length=1, description="Distribution of each value, by its path.")
    ]


class Seeds(Block):
    """Repetitions of a random sea."""

    name: Annotated[Name, Field(description="Name of the axis in the results.")] = "seed"
    path: Annotated[str, Field(description="Path of the seed.")]
    count: Annotated[Whole, Field(description="Number of repetitions.")]
    first: Annotated[Seed, Field(description="First seed; the next ones follow by 1.")] = 1


class LinesLost(Block):
    """The structure with all its lines, and with each of them lost."""

    name: Annotated[Name, Field(description="Name of the axis in the results.")] = "lost_line"
    path: Annotated[
        str, Field(description="Path of the list of lines; found by itself where only one list is called so.")
    ] = "lines"
    intact: Annotated[Truth, Field(description="Run the structure with all lines as well.")] = True


class VariationKeys(Block):
    """One way of varying the case; the study is the product of all of them."""

    grid: Annotated[
        dict[str, Annotated[tuple[Value, ...], Field(min_length=1)] | Spread] | None,
        Field(description="Every value of every path with every other."),
    ] = None
    list: Annotated[ListOfCases | None, Field(description="Named cases, each with what it changes.")] = None
    table: Annotated[TableOfCases | None, Field(description="Cases from the rows of a CSV file.")] = None
    return_periods: Annotated[
        ReturnPeriods | None, Field(description="Waves and currents of several return periods, in pairs.")
    ] = None
    scatter: Annotated[
        Scatter | None, Field(description="Sea states of a scatter diagram, with their probabilities.")
    ] = None
    contour: Annotated[ContourKeys | None, Field(description="Sea states round an environmental contour.")] = None
    spectra: Annotated[SpectraOfFile | None, Field(description="Spectra of a file, a case for each time.")] = None
    sample: Annotated[SampleKeys | None, Field(description="Cases drawn from distributions.")] = None
    seeds: Annotated[Seeds | None, Field(description="Repetitions of a random sea.")] = None
    lines_lost: Annotated[
        LinesLost | Truth | None, Field(description="true, or a block: the intact structure, and each line lost.")
    ] = None

    exactly_one: ClassVar[KeyGroups] = (
        ("grid", "list", "table", "return_periods", "scatter", "contour", "spectra", "sample", "seeds", "lines_lost"),
    )


class Response(Block):
    """A value to keep of every case, besides those that are kept by themselves."""

    variable: Annotated[str, Field(description="Group and name in results.nc, such as SWL/rao/mean_drift_force.")]
    reduce: Annotated[
        Literal["maximum", "minimum", "mean", "last", "all", "rainflow", "peaks", "snap_peaks", "other_peaks"],
        Field(
            description="Over its dimensions; rainflow: sum of the ranges to the power of the exponent, a second; "
            "peaks: the largest value between up-crossings of the mean, all or those that follow on slack or not."
        ),
    ]
    over: Annotated[tuple[str, ...], Field(description="Dimensions to reduce; all unlabelled ones when absent.")] = ()
    exponent: Annotated[PositiveNumber | None, Field(description="Of the endurance curve, for rainflow.")] = None


class Condition(Block):
    """A response that must stay below or above a value."""

    response: Annotated[str, Field(description="Group and name in results.nc; the largest entry of an array counts.")]
    at_most: Annotated[Number | None, Field(description="In the SI unit of the response, without a unit.")] = None
    at_least: Annotated[Number | None, Field(description="In the SI unit of the response, without a unit.")] = None

    exactly_one: ClassVar[KeyGroups] = (("at_most", "at_least"),)


class LimitSearch(Block):
    """Up to which value the structure holds, in every case of the study."""

    path: Annotated[str, Field(description="Path of the value that is raised.")]
    first: Annotated[Value, Field(alias="from", description="Value at which the search starts; it should hold.")]
    last: Annotated[Value, Field(alias="to", description="Largest value that is tried.")]
    conditions: Annotated[
        tuple[Condition, ...], OneOrMany(), Field(min_length=1, description="Conditions that hold below the limit.")
    ]
    tolerance: Annotated[PositiveNumber, Field(description="Share of the range within which it is found.")] = 0.01


class TradeOff(Block):
    """A condition tightened step by step, for a curve of what it costs."""

    name: Annotated[Name, Field(description="Name of the axis in the results.")] = "trade_off"
    response: Annotated[str, Field(description="Group and name in results.nc; the largest entry of an array counts.")]
    at_most: Annotated[
        tuple[Number, ...],
        Field(min_length=1, description="Limits of the response, in its SI unit; every one is an optimisation."),
    ]


class Optimisation(Block):
    """The best values of some paths, in every case of the study."""

    variables: Annotated[dict[str, tuple[Value, Value]], Field(min_length=1, description="Range of every path.")]
    minimise: Annotated[str, Field(description="Response; the largest entry of an array counts.")]
    subject_to: Annotated[
        tuple[Condition, ...], OneOrMany(), Field(description="Conditions that the best values keep.")
    ] = ()
    trade_off: Annotated[TradeOff | None, Field(description="A further condition, tightened step by step.")] = None
    starts: Annotated[int, Field(strict=True, ge=1, le=100, description="Starting points spread over the ranges.")] = 3
    evaluations: Annotated[int, Field(strict=True, ge=5, le=10_000, description="Largest number of runs a start.")] = 60
    seed: Annotated[Seed, Field(description="Of the starting points.")] = 1


class LineCodeQuery(Block):
    """A design code that the lines are compared with."""

    name: Annotated[str, Field(description="Code of the table, or a name for values of your own.")]
    analysis: Annotated[Literal["dynamic", "quasi_static", "static"], Field(description="How the tensions were found.")]
    consequence: Annotated[str, Field(description="Class of the code, where it has classes.")] = ""
    confirmed: Annotated[Truth, Field(description="You have held the values against the standard.")] = False
    safety_factor_intact: Annotated[
        PositiveNumber | None, Field(description="Your own factor with all lines, in place of the values of the table.")
    ] = None
    safety_factor_one_lost: Annotated[
        PositiveNumber | None,
        Field(description="Your own factor with one line lost, in place of the values of the table."),
    ] = None


class LineChecks(Block):
    """Lines of every case against design codes."""

    codes: Annotated[
        tuple[LineCodeQuery, ...], OneOrMany(), Field(min_length=1, description="Design codes, each for all lines.")
    ]
    component: Annotated[
        dict[str, Literal["chain", "rope", "wire", "knotted_rope", "shackle", "used_chain"]],
        Field(default_factory=dict, description="Kind of each line, chain where not given."),
    ]
    corrosion_rate: Annotated[NonNegativeNumber, Field(description="Loss of diameter [mm a year].")] = 0.0
    life: Annotated[NonNegativeNumber, Field(description="Years.")] = 0.0
    diameter: Annotated[dict[str, PositiveLength], Field(default_factory=dict, description="Of each line, when new.")]


class AnchorOfLine(Block):
    """The anchor of a line."""

    kind: Annotated[
        Literal["sinker", "drag_anchor"],
        Field(description="A dead weight on the bed, or an anchor that is embedded by its pull."),
    ]
    weight: Annotated[PositiveForce, Field(description="Sinker: submerged; drag anchor: in air.")]
    name: Annotated[str, Field(description="Kind in the table: concrete, steel; stockless, danforth, ...")] = ""
    bed: Annotated[str, Field(description="sand, clay, rubble")] = ""
    coefficient: Annotated[PositiveNumber | None, Field(description="In place of the table's value.")] = None
    safety_factor: Annotated[PositiveNumber, Field(description="Least holding capacity over the pull of the line.")]

    at_least_one: ClassVar[KeyGroups] = (("coefficient", "name"),)


class ExtremesOfSeeds(Block):
    """A distribution fitted to the maxima of the seeds, or to the peaks of their series."""

    response: Annotated[
        str,
        Field(description="gumbel: maximum of every case; otherwise a series along time: group/name[line=...]."),
    ]
    over: Annotated[str, Field(description="Axis of the repetitions.")] = "seed"
    family: Annotated[
        Literal["gumbel", "weibull", "generalised_pareto", "acer"],
        Field(description="gumbel of the maxima; weibull, generalised_pareto or conditional exceedance of the peaks."),
    ] = "gumbel"
    share: Annotated[
        PositiveNumber | None,
        Field(le=1.0, description="Largest share of the peaks that is fitted; weibull all, pareto 0.1 when absent."),
    ] = None
    snaps_apart: Annotated[
        Truth, Field(description="Fit peaks that follow on slack (below a tenth of the mean) apart from the others.")
    ] = False
    order: Annotated[int, Field(strict=True, ge=1, le=20, description="Of acer: peaks that a group spans.")] = 2
    times: Annotated[
        PositiveNumber, Field(ge=1.0, description="The maximum is that of so many simulated sea states in a row.")
    ] = 1.0
    probability: Annotated[
        PositiveNumber, Field(lt=1.0, description="The design value stays above the maximum with this probability.")
    ] = 0.9
    confidence: Annotated[PositiveNumber, Field(lt=1.0, description="Of the interval of the design value.")] = 0.9
    seed: Annotated[Seed, Field(description="Of the bootstrap.")] = 1


class LongTerm(Block):
    """Return levels over a scatter diagram."""

    response: Annotated[str, Field(description="Maximum of a sea state, or its most probable maximum.")]
    over: Annotated[str, Field(description="Axis of the scatter diagram.")] = "sea_state"
    seeds: Annotated[str, Field(description="Axis of the repetitions; the response is exact without one.")] = ""
    duration: Annotated[Duration, Field(description="Of a sea state.")]
    years: Annotated[tuple[PositiveNumber, ...], Field(min_length=1, description="Return periods [years].")]
    waves: Annotated[
        PositiveNumber | None, Field(gt=1.0, description="In a sea state, without seeds; 1000 when absent.")
    ] = None


class Fatigue(Block):
    """Life of the lines by T-N or S-N curves, from rainflow counts of every case."""

    response: Annotated[str, Field(description="Series of tensions in every case: group/name.")]
    curve: Annotated[
        str | dict[str, str], Field(description="Name in the table of endurance curves: for all lines, or by line.")
    ]
    diameter: Annotated[
        dict[str, PositiveLength],
        Field(default_factory=dict, description="Of each line whose curve takes stresses (bar of a chain, rope)."),
    ]
    equivalent_cycles: Annotated[
        PositiveNumber | None,
        Field(description="A year; gives the constant range of tension that does the same damage in so many cycles."),
    ] = None
    over: Annotated[str, Field(description="Axis of the sea states with their probabilities.")] = "sea_state"
    safety_factor: Annotated[PositiveNumber, Field(description="On life.")] = 1.0
    confirmed: Annotated[Truth, Field(description="You have held the curve against the standard.")] = False


class TensionOfLine(Block):
    """Where the results give the tension of a line, for structures that do not list lines by name."""

    maximum: Annotated[str, Field(description="Response; the largest entry of an array counts.")]
    mean: Annotated[str, Field(description="Response, for codes that part mean and dynamic tension.")] = ""
    uplift: Annotated[str, Field(description="Response: vertical pull at the anchor.")] = ""
    breaking_load: Annotated[PositiveForce, Field(description="Minimum breaking load of the line when new.")]


class Assessment(Block):
    """What is made of all cases together."""

    tensions: Annotated[
        dict[str, TensionOfLine],
        Field(default_factory=dict, description="By a name for the line; found by themselves when absent."),
    ]
    lines: Annotated[LineChecks | None, Field(description="Check of the lines against design codes.")] = None
    anchors: Annotated[dict[str, AnchorOfLine], Field(default_factory=dict, description="By line.")]
    extremes: Annotated[
        tuple[ExtremesOfSeeds, ...],
        OneOrMany(),
        Field(description="Design values from the maxima or peaks of repeated seas."),
    ] = ()
    long_term: Annotated[
        tuple[LongTerm, ...], OneOrMany(), Field(description="Return levels over a scatter diagram.")
    ] = ()
    fatigue: Annotated[tuple[Fatigue, ...], OneOrMany(), Field(description="Life of the lines.")] = ()


class StudyBlock(Block):
    """The study."""

    title: Annotated[str, Field(description="Title of the report.")] = "Study"
    base: Annotated[FileName, Field(description="The base case, relative to this file.")]
    set: Annotated[dict[str, Value], Field(default_factory=dict, description="Changes that all cases share.")]
    variations: Annotated[
        tuple[VariationKeys, ...],
        OneOrMany(),
        Field(description="Ways of varying the case; the study is the product of all of them."),
    ] = ()
    responses: Annotated[
        tuple[Response, ...],
        OneOrMany(),
        Field(description="Values to keep of every case, besides those that are always kept."),
    ] = ()
    watch: Annotated[str, Field(description="Variable whose largest and smallest value is shown on the way.")] = ""
    assess: Annotated[Assessment | None, Field(description="Evaluation of all cases together.")] = None
    replays: Annotated[
        Whole | Literal[0], Field(description="Governing cases that are run again with their own report.")
    ] = 3
    limit: Annotated[
        LimitSearch | None, Field(description="Search of the largest value up to which the conditions hold.")
    ] = None
    optimise: Annotated[Optimisation | None, Field(description="Search of the best values of some paths.")] = None
    on_refused: Annotated[
        Literal["stop", "skip"],
        Field(description="stop: cases that the check refuses stop the study; skip: they become rows with the reason."),
    ] = "stop"
    keep: Annotated[Literal["responses", "results"], Field(description="results: also results.nc of every case.")] = (
        "responses"
    )

    at_most_one: ClassVar[KeyGroups] = (("limit", "optimise"),)


class StudyFile(Block):
    """Root of a study file."""

    moyai: Annotated[Literal[1], Field(description="Version of the file format.")]
    study: Annotated[StudyBlock, Field(description="Base case, variations and evaluation.")]
