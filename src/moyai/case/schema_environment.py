"""Schema of the surroundings: site, waves, wind, current. Shared by every structure."""

from __future__ import annotations

import itertools
from typing import Annotated, Any, ClassVar, Literal

from pydantic import AfterValidator, Discriminator, Field, Tag, model_validator

from moyai.case.schema_types import (
    Block,
    Density,
    Depth,
    Duration,
    FileName,
    Gravity,
    Heading,
    KeyGroups,
    Length,
    Name,
    PeakEnhancement,
    PositiveLength,
    PositiveNumber,
    Range,
    Seed,
    SignedSpeed,
    Speed,
    SpreadAngle,
    holds_key,
    once_each,
    refuse,
)

_WATER_LEVELS_EXAMPLE = {"HWL": "1.2 m", "LWL": "0 m"}


class SiteKeys(Block):
    """The water of the site."""

    water_depth: Depth = Field(description="Water depth at datum, or 'infinite'.")
    water_levels: Annotated[dict[Name, Length], Field(min_length=1, max_length=20)] = Field(
        default={"SWL": 0.0},
        description="Names and heights of the water levels above datum; each is run. Default: SWL at datum.",
        examples=[_WATER_LEVELS_EXAMPLE],
    )
    density: Density = Field(description="Density of the water.")
    gravity: Gravity = Field(description="Acceleration of gravity.")
    x_axis_bearing_deg: Heading | None = Field(
        default=None,
        description="Compass bearing that the x axis points to, clockwise from north; needed for bearings of waves, "
        "wind or current.",
    )
    return_period_years: PositiveNumber | None = Field(
        default=None, description="Return period of the seas and currents in years; stated with the results, not used."
    )


class _FromBearing(Block):
    exactly_one: ClassVar[KeyGroups] = (("heading_deg", "from_bearing_deg"),)

    heading_deg: Heading | None = Field(
        default=None, description="Direction of travel: 0 along +x (normal to the structure), 90 along +y."
    )
    from_bearing_deg: Heading | None = Field(
        default=None,
        description="Compass bearing that it comes from, clockwise from north; needs site.x_axis_bearing_deg.",
    )


class PeriodRange(Range):
    """Evenly spaced wave periods."""

    first: Duration = Field(alias="from", description="First period.")
    last: Duration = Field(alias="to", description="Last period.")

    def values(self) -> tuple[float, ...]:
        """Return the periods [s]."""
        return self.spread(self.first, self.last, self.count)


def _no_repeats(values: tuple[float, ...]) -> tuple[float, ...]:
    if len(values) > 1 and all(after < before for before, after in itertools.pairwise(values)):
        rising = ", ".join(f"{value:g}" for value in values[::-1][:12]) + (", ..." if len(values) > 12 else "")
        raise refuse(
            f"the list runs backwards, from {values[0]:g} to {values[-1]:g}",
            allowed="short periods first",
            remedy=f"write [{rising}]",
        )
    if len(set(values)) < len(values):
        twice = next(value for index, value in enumerate(values) if value in values[:index])
        raise refuse(f"{twice:g} is given twice in the list", remedy="remove one")
    return values


def _list_or_block(value: Any) -> str:
    return "<range>" if isinstance(value, (dict, PeriodRange)) else "<list>"


Periods = Annotated[
    Annotated[tuple[Duration, ...], Field(min_length=1, max_length=10_000), AfterValidator(_no_repeats), Tag("<list>")]
    | Annotated[PeriodRange, Tag("<range>")],
    Discriminator(_list_or_block),
]


class _SeaState(_FromBearing):
    name: Name | None = Field(default=None, description="Label of the sea state in results; made up when absent.")


class RegularWavesKeys(_SeaState):
    """Regular waves of one height and one or more periods."""

    exactly_one: ClassVar[KeyGroups] = (*_FromBearing.exactly_one, ("period", "periods"))

    kind: Literal["regular"] = Field(description="Regular waves.")
    height: PositiveLength = Field(description="Wave height H, crest to trough.")
    period: Duration | None = Field(default=None, description="Wave period T.")
    periods: Periods | None = Field(
        default=None, description="Wave periods: a list, or evenly spaced {from, to, count}; each is run."
    )
    theory: Literal["linear"] = Field(default="linear", description="Wave theory of the loads.")

    def all_periods(self) -> tuple[float, ...]:
        """Return every period [s]."""
        if self.period is not None:
            return (self.period,)
        return self.periods.values() if isinstance(self.periods, PeriodRange) else tuple(self.periods or ())


class RegularWavesOfHeights(RegularWavesKeys):
    """Regular waves: every height with every period."""

    exactly_one: ClassVar[KeyGroups] = (*RegularWavesKeys.exactly_one, ("height", "heights"))

    height: PositiveLength | None = Field(default=None, description="Wave height H, crest to trough.")  # type: ignore[assignment]
    heights: Annotated[tuple[PositiveLength, ...], Field(min_length=1, max_length=1000), AfterValidator(once_each)] = (
        Field(default=(), description="Wave heights: a list; the first is run with every period, then the next.")
    )

    def all_heights(self) -> tuple[float, ...]:
        """Return every height [m]."""
        return (self.height,) if self.height is not None else tuple(self.heights)

    @property
    def highest(self) -> float:
        """Largest height [m]."""
        return max(self.all_heights())


SteepTheory = Literal["automatic", "linear", "stream_function"]
STEEP_THEORY = (
    "Wave theory: linear or stream function; automatic takes linear waves where their second harmonic is below 1 % of "
    "the first, else the stream function. Bodies with coefficients and rigid cages take linear waves only."
)


class SteepRegularWaves(RegularWavesKeys):
    """Regular waves for structures whose loads include waves of finite height."""

    theory: SteepTheory = Field(default="automatic", description=STEEP_THEORY)  # type: ignore[assignment]


class CosineTwoSKeys(Block):
    """cos^(2s) spreading, the same at every frequency."""

    kind: Literal["cosine_2s"] = Field(description="cos^(2s) of half the angle from the mean direction.")
    exponent: PositiveNumber = Field(description="Exponent s.")


class MitsuyasuSpreading(Block):
    """Mitsuyasu's spreading, narrowest at the peak frequency."""

    kind: Literal["mitsuyasu"] = Field(description="cos^(2s) with an exponent that falls away from the peak.")
    maximum_exponent: PositiveNumber = Field(
        description="s_max at the peak: 10 wind sea, 25 young swell, 75 old swell (Goda and Suzuki)."
    )


class CosinePowerKeys(Block):
    """cos^n spreading."""

    kind: Literal["cosine_power"] = Field(description="cos^n of the angle from the mean direction, zero beyond 90.")
    exponent: PositiveNumber = Field(description="Exponent n.")


class WrappedNormalKeys(Block):
    """Normal distribution of directions."""

    kind: Literal["wrapped_normal"] = Field(description="Normal distribution around the mean direction.")
    standard_deviation_deg: SpreadAngle = Field(description="Standard deviation of the direction.")


Spreading = Annotated[
    CosineTwoSKeys | MitsuyasuSpreading | CosinePowerKeys | WrappedNormalKeys, Field(discriminator="kind")
]


class _Irregular(_SeaState):
    spreading: Spreading | None = Field(default=None, description="Directional spreading; long crests when absent.")
    seed: Seed = Field(default=1, description="Seed of the random phases.")
    duration: Duration = Field(default=10800.0, description="Length of the time-domain realisation. Default: 3 h.")


class Jonswap(_Irregular):
    """JONSWAP spectrum."""

    exactly_one: ClassVar[KeyGroups] = (*_SeaState.exactly_one, ("peak_period", "significant_period"))

    kind: Literal["jonswap"] = Field(description="JONSWAP spectrum.")
    significant_height: PositiveLength = Field(description="Significant wave height Hm0.")
    peak_period: Duration | None = Field(default=None, description="Peak period Tp.")
    significant_period: Duration | None = Field(default=None, description="Significant period T1/3.")
    peak_enhancement: PeakEnhancement = Field(description="Peak enhancement factor gamma, 3.3 on average.")


class PiersonMoskowitz(_Irregular):
    """Pierson-Moskowitz spectrum."""

    kind: Literal["pierson_moskowitz"] = Field(description="Pierson-Moskowitz spectrum.")
    significant_height: PositiveLength = Field(description="Significant wave height Hm0.")
    peak_period: Duration = Field(description="Peak period Tp.")


class BretschneiderMitsuyasu(_Irregular):
    """Bretschneider spectrum with Mitsuyasu's coefficients."""

    kind: Literal["bretschneider_mitsuyasu"] = Field(description="Bretschneider-Mitsuyasu spectrum.")
    significant_height: PositiveLength = Field(description="Significant wave height H1/3.")
    significant_period: Duration = Field(description="Significant period T1/3.")


class Tma(_Irregular):
    """TMA spectrum: JONSWAP limited by the water depth."""

    kind: Literal["tma"] = Field(description="TMA spectrum, JONSWAP in water of finite depth.")
    significant_height: PositiveLength = Field(description="Significant wave height Hm0.")
    peak_period: Duration = Field(description="Peak period Tp.")
    peak_enhancement: PeakEnhancement = Field(description="Peak enhancement factor gamma, 3.3 on average.")


Column = Annotated[
    Annotated[int, Field(strict=True, ge=1, le=1000), Tag("<number>")] | Annotated[str, Tag("<name>")],
    Discriminator(lambda value: "<number>" if isinstance(value, int) else "<name>"),
]


class FileSpreading(Block):
    """Spreading of the file itself."""

    kind: Literal["file"] = Field(
        description="As the two-dimensional spectrum of the file is spread about its mean direction, which travels "
        "along the heading; needs 'record'."
    )


SpreadingOfFile = Annotated[
    CosineTwoSKeys | MitsuyasuSpreading | CosinePowerKeys | WrappedNormalKeys | FileSpreading,
    Field(discriminator="kind"),
]


class SpectrumFile(_Irregular):
    """A measured or computed frequency spectrum."""

    kind: Literal["spectrum_file"] = Field(description="Spectrum from a file.")
    file: FileName = Field(
        description="Text table of frequency [Hz] and density [m2/Hz], comma, semicolon, tab or blank separated, or a "
        "file of SWAN, WAVEWATCH III or NDBC (others with the extra wavespectra); relative to the case file."
    )
    record: Annotated[int, Field(strict=True, ge=0, le=10_000_000)] | None = Field(
        default=None, description="Number of the time in a file of several spectra, from 0."
    )
    place: Annotated[int, Field(strict=True, ge=0, le=1_000_000)] = Field(
        default=0, description="Number of the place in such a file, from 0."
    )
    frequency_column: Column = Field(default=1, description="Column of the frequency: number from 1, or its name.")
    density_column: Column = Field(default=2, description="Column of the density: number from 1, or its name.")
    spreading: SpreadingOfFile | None = Field(  # type: ignore[assignment]
        default=None, description="Directional spreading; long crests when absent."
    )


SeaState = Annotated[
    RegularWavesKeys | Jonswap | PiersonMoskowitz | BretschneiderMitsuyasu | Tma | SpectrumFile,
    Field(discriminator="kind"),
]


class WindKeys(_FromBearing):
    """Steady wind on the part above water."""

    speed: Speed = Field(description="Wind speed.")
    density: Density = Field(description="Density of the air, 1.225 kg/m3 at 15 degrees Celsius.")


class PowerLawKeys(Block):
    """Current that falls with depth by a power law."""

    power_law: PositiveNumber = Field(description="Exponent of ((z + h)/h)^exponent; 1/7 = 0.143 is common.")


def _rising(rows: tuple[tuple[float, float], ...]) -> tuple[tuple[float, float], ...]:
    for below, above in itertools.pairwise(rows):
        if not above[0] > below[0]:
            raise refuse(
                f"the heights do not rise: {above[0]:g} m follows {below[0]:g} m",
                allowed="heights z from the bed up, each above the one before",
            )
    return rows


class SpeedTable(Block):
    """Current from a table."""

    table: Annotated[
        tuple[tuple[Length, SignedSpeed], ...], Field(min_length=2, max_length=10_000), AfterValidator(_rising)
    ] = Field(
        description="Rows [z, speed] from the bed up; z from still water, negative under it.",
        examples=[[["-10 m", "0.1 m/s"], ["0 m", "0.4 m/s"]]],
    )


def _profile_form(value: Any) -> str:
    if isinstance(value, dict):
        return "<table>" if holds_key(value, "table") and not holds_key(value, "power_law") else "<power_law>"
    if isinstance(value, SpeedTable):
        return "<table>"
    return "<power_law>" if isinstance(value, PowerLawKeys) else "<word>"


Profile = Annotated[
    Annotated[Literal["uniform"], Tag("<word>")]
    | Annotated[PowerLawKeys, Tag("<power_law>")]
    | Annotated[SpeedTable, Tag("<table>")],
    Discriminator(_profile_form),
]


class SiteCurrentKeys(Block):
    """Steady current."""

    exactly_one: ClassVar[KeyGroups] = (("heading_deg", "from_bearing_deg", "to_bearing_deg"),)

    speed: Speed | None = Field(default=None, description="Speed at the surface; left out with a table.")
    heading_deg: Heading | None = Field(default=None, description="Direction of flow: 0 along +x, 90 along +y.")
    from_bearing_deg: Heading | None = Field(default=None, description="Compass bearing that it comes from.")
    to_bearing_deg: Heading | None = Field(default=None, description="Compass bearing that it flows to.")
    profile: Profile = Field(
        default="uniform", description="'uniform', {power_law: exponent} or {table: [[z, speed], ...]}."
    )

    @model_validator(mode="after")
    def _speed_or_table(self) -> SiteCurrentKeys:
        if isinstance(self.profile, SpeedTable):
            if self.speed is not None:
                raise refuse("'speed' and a table of speeds exclude each other", remedy="keep one")
        elif self.speed is None:
            raise refuse("'speed' is missing", remedy="give the speed at the surface")
        return self


def sea_names(states: tuple[Any, ...]) -> tuple[str, ...]:
    """Return the name of every sea state; unnamed ones are called by kind, and by number where there are several."""
    names: list[str] = []
    kinds = [state.kind for state in states if state.name is None]
    for index, state in enumerate(states):
        name = state.name or (state.kind if kinds.count(state.kind) == 1 else f"{state.kind} {index + 1}")
        names.append(name)
    return tuple(names)


def refuse_no_seas(value: Any) -> Any:
    """Refuse an empty list of sea states."""
    if isinstance(value, list) and not value:
        raise refuse("the list of sea states is empty", remedy="give one, or leave 'waves' out")
    return value
