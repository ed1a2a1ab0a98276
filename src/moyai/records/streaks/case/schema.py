"""Schema of a file of ``moyai measure streaks``: pictures of particle streaks, how they were lit and calibrated."""

from __future__ import annotations

from typing import Annotated, Any, ClassVar, Literal

from pydantic import BeforeValidator, Field

from moyai.case.schema_types import (
    Block,
    Duration,
    FileName,
    Fraction,
    KeyGroups,
    Length,
    Name,
    NonNegativeLength,
    Number,
    OneOrMany,
    PositiveLength,
    PositiveNumber,
    QuantityOf,
    Seed,
    SignedSpeed,
    Speed,
    Truth,
)
from moyai.core import quantities

Index = Annotated[float, QuantityOf(quantities.NUMBER, least=1.0, most=3.0)]
Confidence = Annotated[float, QuantityOf(quantities.NUMBER, least=0.5, below=1.0)]
SizeRatio = Annotated[float, QuantityOf(quantities.NUMBER, least=1.0, most=20.0)]
PositiveSpeed = Annotated[float, QuantityOf(quantities.SPEED, above=0.0)]
Pulses = Annotated[int, Field(strict=True, ge=4, le=2000)]
Count = Annotated[int, Field(strict=True, ge=0, le=100_000)]


def _as_list(value: Any) -> Any:
    return [value] if isinstance(value, (str, int, float)) and not isinstance(value, bool) else value


class StreakCircle(Block):
    """Circular section."""

    kind: Literal["circle"] = Field(description="Circle.")
    diameter: PositiveLength = Field(description="Diameter.")


class StreakRectangle(Block):
    """Rectangular section, a square included."""

    kind: Literal["rectangle"] = Field(description="Rectangle.")
    breadth: PositiveLength = Field(description="Size along x.")
    height: PositiveLength = Field(description="Size along z.")


class StreakPolygon(Block):
    """Any other section."""

    kind: Literal["polygon"] = Field(description="Polygon.")
    corners: Annotated[tuple[tuple[Length, Length], ...], Field(min_length=3, max_length=1000)] = Field(
        description="Corners [x, z] about the centre of the section, in order."
    )


StreakSection = Annotated[StreakCircle | StreakRectangle | StreakPolygon, Field(discriminator="kind")]


class PlaceKeys(Block):
    """A point in the light sheet."""

    x: Length = Field(description="Along the tank.")
    z: Length = Field(description="Upwards.")


class RefractionBlock(Block):
    """Wall and water between camera and light sheet."""

    camera_to_wall: PositiveLength = Field(description="From the lens to the outside of the wall.")
    wall_thickness: NonNegativeLength = Field(description="Thickness of the wall.")
    wall_index: Index = Field(description="Refractive index of the wall: glass 1.52, acrylic 1.49.")
    sheet_distance: PositiveLength = Field(description="From the inside of the wall to the light sheet.")
    water_index: Index = Field(default=1.333, description="Refractive index of the water. Default: 1.333.")


class CalibrationBlock(Block):
    """From pixels to the light sheet."""

    model: Literal["homography", "rays"] = Field(
        default="homography", description="Homography through the targets, or exact rays. Default: homography."
    )
    targets: FileName = Field(
        description="CSV with the columns column, row (pixels from the centre of the upper left one), x [mm], z [mm]."
    )
    dry: Truth = Field(
        default=False, description="Targets were photographed in the empty tank; needs refraction. Default: false."
    )
    refraction: RefractionBlock | None = Field(default=None, description="Wall and water; needed for rays and dry.")


class TimingFrames(Block):
    """One picture a pulse."""

    kind: Literal["frames"] = Field(description="One picture a pulse, in the order of time.")
    interval: Duration = Field(description="From the start of one pulse to the next.")
    on_time: Duration = Field(description="How long the light is on in a picture.")


class TimingExposure(Block):
    """One picture of all pulses."""

    kind: Literal["exposure"] = Field(description="One picture of all pulses; on-times or powers give the order.")
    interval: Duration = Field(description="From the start of one pulse to the next.")
    on_time: Annotated[tuple[Duration, ...], BeforeValidator(_as_list), Field(min_length=1, max_length=200)] = Field(
        description="On-times, a pattern that repeats, such as [50 ms, 30 ms, 20 ms]."
    )
    power: Annotated[tuple[PositiveNumber, ...], BeforeValidator(_as_list), Field(min_length=1, max_length=200)] = (
        Field(
            default=(1.0,), description="Relative powers, a pattern that repeats, such as [1, 0.65, 0.4]. Default: [1]."
        )
    )
    count: Pulses = Field(description="Number of pulses while the shutter is open: more than period / interval + 1.")


Timing = Annotated[TimingFrames | TimingExposure, Field(discriminator="kind")]


class RecordingBlock(Block):
    """Pictures taken in one go."""

    pictures: Annotated[tuple[FileName, ...], Field(min_length=1, max_length=2000)] = Field(
        description="Files in the order of time; a name with * means all that match, sorted."
    )


Recordings = Annotated[tuple[RecordingBlock, ...], OneOrMany(), Field(min_length=1, max_length=2000)]


class RunBlock(Block):
    """One wave."""

    exactly_one: ClassVar[KeyGroups] = (("keulegan_carpenter", "velocity_amplitude"),)

    name: Name = Field(description="Label of the run.")
    period: Duration = Field(description="Wave period.")
    keulegan_carpenter: PositiveNumber | None = Field(default=None, description="KC = V T / B at the centre.")
    velocity_amplitude: PositiveSpeed | None = Field(
        default=None, description="Horizontal velocity amplitude of the undisturbed orbit at the centre."
    )
    vertical_ratio: PositiveNumber = Field(
        default=1.0, description="Vertical over horizontal velocity amplitude. Default: 1, deep water."
    )
    recordings: Recordings = Field(description="One recording or several of the same wave.")
    no_model: Recordings | None = Field(
        default=None, description="The same wave without the section: settling and mass transport."
    )
    measured_reduction: Number | None = Field(
        default=None, description="Reduction of the inertia coefficient found from forces, for comparison."
    )


class NoModelBlock(Block):
    """The same waves without the section: settling and mass transport."""

    period: Duration = Field(description="Wave period.")
    recordings: Recordings = Field(description="Pictures without the model.")


class BackgroundBlock(Block):
    """Settling and mass transport known from elsewhere."""

    mass_transport: SignedSpeed = Field(description="Mean drift along +x at the level of the centre.")
    mass_transport_gradient: Annotated[
        float, QuantityOf(quantities.QuantityKind("a rate", "1/s", "per second", "0.01 1/s"))
    ] = Field(default=0.0, description="Its growth with z. Default: 0.")
    settling: Speed = Field(description="Speed at which the particles sink.")


class DetectionBlock(Block):
    """How streaks are distinguished from noise."""

    threshold: PositiveNumber = Field(default=7.0, description="Standard deviations of the noise. Default: 7.")
    edge_threshold: PositiveNumber = Field(default=3.5, description="The same for the rim of a streak. Default: 3.5.")
    least_length: PositiveNumber = Field(default=4.0, description="Shortest streak in pixels. Default: 4.")
    background_block: Annotated[int, Field(strict=True, ge=8, le=512)] = Field(
        default=32, description="Pixels over which the background is even. Default: 32."
    )
    most_overlap: Annotated[int, Field(strict=True, ge=1, le=4)] = Field(
        default=3, description="Most streaks that one bright region is taken apart into. Default: 3."
    )
    mask_margin: NonNegativeLength = Field(default=6e-4, description="Left out around the section. Default: 0.6 mm.")


class LinkingBlock(Block):
    """How streaks are joined to chains, and chains become drift."""

    relative: Fraction = Field(default=0.2, description="Miss allowed, as a share of the way. Default: 0.2.")
    absolute: NonNegativeLength = Field(default=3e-4, description="Further miss allowed. Default: 0.3 mm.")
    missing: Annotated[int, Field(strict=True, ge=0, le=3)] = Field(
        default=1, description="Most pulses in a row that a chain may lack. Default: 1."
    )
    closing: Literal["harmonics", "cubic"] = Field(
        default="harmonics", description="Least squares with harmonics, or the paper's cubic. Default: harmonics."
    )
    most_residual: PositiveLength = Field(
        default=8e-4, description="Largest roughness of a chain that is used. Default: 0.8 mm."
    )


class CirculationBlock(Block):
    """Contours, interpolation and intervals."""

    size_ratios: Annotated[tuple[SizeRatio, ...], Field(min_length=2, max_length=100)] = Field(
        default=(1.25, 1.5, 1.75, 2.0, 2.25, 2.5, 2.75, 3.0), description="Sizes Bc/B of the contours."
    )
    least_ratio: SizeRatio = Field(default=1.5, description="Smallest contour of the fit. Default: 1.5.")
    interpolation: Literal["spline", "triangles"] = Field(
        default="spline", description="Smoothing spline, or linear between neighbours. Default: spline."
    )
    resamples: Count = Field(default=200, description="Resampled clouds behind the intervals. Default: 200.")
    confidence: Confidence = Field(default=0.95, description="Level of the intervals. Default: 0.95.")
    seed: Seed = Field(default=0, description="Seed of the resampling. Default: 0.")


class StreaksFile(Block):
    """A file of ``moyai measure streaks``."""

    at_most_one: ClassVar[KeyGroups] = (("no_model", "background"),)

    moyai: Literal[1] = Field(description="Version of the format.")
    measure: Literal["streaks"] = Field(description="What is measured: streaks.")
    title: Annotated[str, Field(min_length=1, max_length=200)] = Field(description="Title of the report.")
    section: StreakSection = Field(description="Section of the member.")
    centre: PlaceKeys = Field(description="Centre of the section in the coordinates of the targets.")
    waves_towards: Literal["+x", "-x"] = Field(default="+x", description="Direction of the waves. Default: +x.")
    calibration: CalibrationBlock = Field(description="From pixels to the light sheet.")
    timing: Timing = Field(description="When the light was on.")
    no_model: NoModelBlock | None = Field(default=None, description="Run without model, for the background drift.")
    background: BackgroundBlock | None = Field(default=None, description="Background drift where it is known.")
    runs: Annotated[tuple[RunBlock, ...], Field(min_length=1, max_length=1000)] = Field(description="Runs.")
    detection: DetectionBlock = Field(default_factory=DetectionBlock, description="How streaks are found.")
    linking: LinkingBlock = Field(default_factory=LinkingBlock, description="How streaks are linked.")
    circulation: CirculationBlock = Field(default_factory=CirculationBlock, description="Contours and intervals.")
