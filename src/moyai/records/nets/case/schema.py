"""Schema of a file of ``moyai measure nets``: nets, their runs, the frame that carried them, cages with lines."""

from __future__ import annotations

from typing import Annotated, Any, ClassVar, Literal

from pydantic import BeforeValidator, Field

from moyai.case.schema_types import (
    Block,
    Density,
    Depth,
    Duration,
    FileName,
    Gravity,
    KeyGroups,
    Length,
    Name,
    PositiveLength,
    QuantityOf,
    Seed,
    Truth,
)
from moyai.core import quantities

Area = Annotated[float, QuantityOf(quantities.AREA, above=0.0)]
Solidity = Annotated[float, QuantityOf(quantities.NUMBER, above=0.0, below=1.0)]
Viscosity = Annotated[float, QuantityOf(quantities.VISCOSITY, above=0.0)]
Frequency = Annotated[float, QuantityOf(quantities.FREQUENCY, above=0.0)]
PositiveSpeed = Annotated[float, QuantityOf(quantities.SPEED, above=0.0)]
Confidence = Annotated[float, QuantityOf(quantities.NUMBER, least=0.5, below=1.0)]
Share = Annotated[float, QuantityOf(quantities.NUMBER, least=0.0, below=0.5)]
PhaseError = Annotated[float, QuantityOf(quantities.ANGLE_DEGREES, least=0.0, most=20.0)]
Instant = Annotated[float, QuantityOf(quantities.TIME)]
Window = Annotated[tuple[Instant, ...], Field(min_length=2, max_length=2)]
Band = Annotated[tuple[Frequency, ...], Field(min_length=2, max_length=2)]
Draws = Annotated[int, Field(strict=True, ge=50, le=100_000)]
Heading = Annotated[str, Field(min_length=1)]


def _table_net(value: Any) -> Any:
    return value.strip().upper() if isinstance(value, str) else value


class NetSpecimen(Block):
    """One net as it was towed."""

    exactly_one: ClassVar[KeyGroups] = (("aperture", "mesh_pitch", "table"),)

    name: Name = Field(description="Name of the net.")
    table: Annotated[Literal["A", "B", "C", "D", "E", "F", "G", "H", "I", "J"] | None, BeforeValidator(_table_net)] = (
        Field(
            default=None,
            description="One of the ten wire nets of Matsubara and others, A to J, as printed.",
        )
    )
    twine_diameter: PositiveLength | None = Field(default=None, description="Diameter of the twine.")
    aperture: PositiveLength | None = Field(default=None, description="Clear opening between twines.")
    mesh_pitch: PositiveLength | None = Field(
        default=None, description="From centre to centre of twines (bar length), in place of the aperture."
    )
    solidity_listed: Solidity | None = Field(
        default=None, description="Solidity as listed, crossings perhaps counted twice. Default: 2 d over pitch."
    )
    solidity_measured: Solidity | None = Field(
        default=None, description="Measured solidity, crossings counted once. Default: by the geometry."
    )
    knotted: Truth = Field(default=False, description="Whether the crossings are knots. Default: false.")
    projected_area: Area | None = Field(
        default=None, description="Area of the twines that C_D refers to. Default: listed solidity times panel area."
    )
    panel_area: Area | None = Field(default=None, description="Outline of this panel, where it differs.")


class RunColumns(Block):
    """Columns of a run's file."""

    time: Heading = Field(default="time", description="Column of the time. Default: time.")
    force: Heading | None = Field(default="force", description="Force along the water's motion. Default: force.")
    lift: Heading | None = Field(default=None, description="Force across it.")
    speed: Heading | None = Field(default=None, description="Measured speed of the carriage, or of the water past it.")
    velocity: Heading | None = Field(default=None, description="Water past the panel, by a meter on the carriage.")
    elevation: Heading | None = Field(default=None, description="Surface at a gauge that moves with the carriage.")
    acceleration: Heading | None = Field(default=None, description="Acceleration of the carriage.")


class NetRunBlock(Block):
    """One run of a net, or of the bare frame."""

    name: Name = Field(description="Name of the run.")
    net: Name | Literal["none"] = Field(description="Net that was towed; none for the bare frame.")
    kind: Literal["still_water", "towing_waves", "waves"] = Field(
        description="Towing in still water, towing through waves, or waves alone."
    )
    file: FileName = Field(description="CSV with names and units in its header.")
    columns: RunColumns | None = Field(default=None, description="Columns of this file, where they differ.")
    speed: PositiveSpeed | None = Field(default=None, description="Speed of towing; needed without its column.")
    period: Duration | None = Field(default=None, description="Period of regular waves as at rest.")
    regular: Truth = Field(default=True, description="Whether the waves are regular. Default: true.")
    following: Truth = Field(default=False, description="Whether waves run with the carriage. Default: false.")
    gauge_to_panel: Length = Field(
        default=0.0, description="From the wave gauge to the panel in the direction of the waves. Default: 0."
    )
    window: Window | None = Field(default=None, description="Part to use, such as [8 s, 20 s]. Default: found.")
    zero_window: Window | None = Field(default=None, description="Part in which the force is nothing; taken off.")
    frame: Name | None = Field(default=None, description="Run of the bare frame to subtract. Default: by conditions.")


class TensionColumn(Block):
    """Tension at one end of a line."""

    line: Name = Field(description="Name of the line, such as shore.")
    end: Name = Field(description="Which end, such as cage or anchor.")
    column: Heading = Field(description="Column of the tension.")


class CageRunBlock(Block):
    """Tensions of a moored cage in regular waves."""

    name: Name = Field(description="Name of the run.")
    file: FileName = Field(description="CSV with names and units in its header.")
    time: Heading = Field(default="time", description="Column of the time. Default: time.")
    tensions: Annotated[tuple[TensionColumn, ...], Field(min_length=1, max_length=100)] = Field(
        description="Ends of lines."
    )
    period: Duration | None = Field(default=None, description="Period of the waves. Default: found.")
    window: Window | None = Field(default=None, description="Part to use. Default: all.")


class VibrationBlock(Block):
    """Vibration of the carriage."""

    remove: Truth = Field(default=True, description="Whether it is taken out. Default: true.")
    search: Band = Field(
        default=(1.5, 20.0), description="Where the still-water runs are searched for it. Default: [1.5 Hz, 20 Hz]."
    )
    band: Band | None = Field(default=None, description="Band to take out, in place of the search.")


class NetsFile(Block):
    """Runs of nets, and how they are read."""

    at_least_one: ClassVar[KeyGroups] = (("runs", "cages"),)

    moyai: Literal[1] = Field(description="Version of the format.")
    title: Annotated[str, Field(min_length=1, max_length=200)] = Field(description="Title of the report.")
    density: Density | None = Field(default=None, description="Density of the water; needed for runs of nets.")
    kinematic_viscosity: Viscosity | None = Field(default=None, description="Kinematic viscosity; needed for nets.")
    gravity: Gravity | None = Field(default=None, description="Acceleration of gravity; needed for nets.")
    water_depth: Depth | None = Field(default=None, description="Water depth, or 'infinite'; needed for nets.")
    panel_z: Length | None = Field(default=None, description="Height of the panel's centre, negative; needed for nets.")
    panel_area: Area | None = Field(default=None, description="Outline of the panels.")
    nets: tuple[NetSpecimen, ...] = Field(default=(), description="Nets.")
    columns: RunColumns = Field(default_factory=RunColumns, description="Columns of the runs' files.")
    runs: tuple[NetRunBlock, ...] = Field(default=(), description="Runs of nets and of the bare frame.")
    cages: tuple[CageRunBlock, ...] = Field(default=(), description="Runs of a moored cage with line tensions.")
    reverse_force: Truth = Field(
        default=False,
        description="Whether the gauge has its positive direction against the water's motion. Default: false.",
    )
    vibration: VibrationBlock = Field(default_factory=VibrationBlock, description="Vibration of the carriage.")
    law_solidity: Literal["geometric", "listed"] = Field(
        default="geometric", description="Solidity that A and B are functions of. Default: geometric."
    )
    calibration_error: Share = Field(default=0.0, description="Relative standard error of the force gauge. Default: 0.")
    phase_error_deg: PhaseError = Field(
        default=0.0, description="Standard error of the phase between force and velocity. Default: 0."
    )
    confidence: Confidence = Field(default=0.95, description="Probability that the intervals cover. Default: 0.95.")
    bootstrap: Draws = Field(default=200, description="Number of bootstrap samples. Default: 200.")
    seed: Seed = Field(default=1, description="Seed of the bootstrap. Default: 1.")
