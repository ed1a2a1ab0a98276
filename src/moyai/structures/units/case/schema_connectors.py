"""Schema of the connectors between floating units."""

from __future__ import annotations

import itertools
import math
from typing import Annotated, Any, Literal

from pydantic import AfterValidator, Discriminator, Field, Tag

from moyai.case.schema_types import (
    Block,
    Length,
    Name,
    NonNegativeLength,
    Number,
    PositiveForce,
    PositiveNumber,
    QuantityOf,
    Stiffness,
    Whole,
    refuse,
)
from moyai.case.schema_types import Damping as DampingPerSpeed
from moyai.core import quantities

NonNegativeStiffness = Annotated[float, QuantityOf(quantities.STIFFNESS, least=0.0)]
RotationalStiffness = Annotated[float, QuantityOf(quantities.ROTATIONAL_STIFFNESS, least=0.0)]
RotationalDamping = Annotated[float, QuantityOf(quantities.ROTATIONAL_DAMPING, least=0.0)]
ForceOfCurve = Annotated[float, QuantityOf(quantities.FORCE)]


def _pair(value: tuple[int, int]) -> tuple[int, int]:
    if value[0] == value[1]:
        raise refuse(f"unit {value[0]} is joined to itself", remedy="name two units")
    return value


Pair = Annotated[tuple[Whole, Whole], AfterValidator(_pair)]


def _word_or_list(value: Any) -> str:
    return "<word>" if isinstance(value, str) else "<list>"


def _length_of(vector: tuple[float, float, float]) -> tuple[float, float, float]:
    if math.hypot(*vector) == 0.0:
        raise refuse("the direction has no length", allowed="three numbers, not all of them 0")
    return vector


Direction = Annotated[
    Annotated[Literal["x", "y", "z"], Tag("<word>")]
    | Annotated[tuple[Number, Number, Number], AfterValidator(_length_of), Tag("<list>")],
    Discriminator(_word_or_list),
]


_Slope = Annotated[float, QuantityOf(quantities.NUMBER, above=0.0, most=30.0)]


class Endurance(Block):
    """Curve of endurance: N = cycles (range / force)^-exponent."""

    range: PositiveForce = Field(description="Range of force that the connector withstands 'cycles' times.")
    cycles: PositiveNumber = Field(description="Number of cycles at that range.", examples=[1000000])
    exponent: _Slope = Field(description="Inverse slope m of the curve: 3 to 5 of steel, to 20 of ropes.", examples=[3])


class ConnectorBlock(Block):
    """What all connectors share."""

    name: Name = Field(description="Name of the connector in results.")
    between: Annotated[
        Annotated[Literal["all"], Tag("<word>")] | Annotated[tuple[Pair, ...], Field(min_length=1), Tag("<list>")],
        Discriminator(_word_or_list),
    ] = Field(
        default="all",
        description="all: every unit and the next; or pairs of units, counted from 1. Default: all.",
        examples=[[[1, 2], [3, 4]]],
    )
    x: Length = Field(
        default=0.0,
        description="Across, from the centre line of the unit before the gap; on a side, along it. Default: 0.",
    )
    above_keel: Length = Field(description="Height above the keel; along, it is in the middle of the gap.")
    breaking_load: PositiveForce | None = Field(
        default=None, description="Its strength; without it no utilisation is shown."
    )
    endurance: Endurance | None = Field(
        default=None,
        description="Cycles that it withstands; without it no fatigue is computed, which needs the time domain.",
    )


class RigidConnector(ConnectorBlock):
    """Holds all relative motion."""

    kind: Literal["rigid"] = Field(description="Rigid.")


class BallConnector(ConnectorBlock):
    """Holds the ends together and lets them turn."""

    kind: Literal["ball"] = Field(description="Ball joint.")


class HingeConnector(ConnectorBlock):
    """Holds all relative motion but the turn about its axis."""

    kind: Literal["hinge"] = Field(description="Hinge.")
    axis: Direction = Field(
        description="Axis: x (along the faces of the gap), y (from unit to unit), z (upright), or three numbers."
    )


class SpringConnector(ConnectorBlock):
    """Springs and dashpots on all six relative motions."""

    kind: Literal["spring"] = Field(description="Springs and dashpots.")
    stiffness: tuple[NonNegativeStiffness, NonNegativeStiffness, NonNegativeStiffness] = Field(
        description="Along x (the faces of the gap), y (from unit to unit), z (up).",
        examples=[["1 MN/m", "5 MN/m", "1 MN/m"]],
    )
    rotational_stiffness: tuple[RotationalStiffness, RotationalStiffness, RotationalStiffness] = Field(
        default=(0.0, 0.0, 0.0), description="About x, y, z. Default: none."
    )
    damping: tuple[DampingPerSpeed, DampingPerSpeed, DampingPerSpeed] = Field(
        default=(0.0, 0.0, 0.0), description="Along x, y, z. Default: none."
    )
    rotational_damping: tuple[RotationalDamping, RotationalDamping, RotationalDamping] = Field(
        default=(0.0, 0.0, 0.0), description="About x, y, z. Default: none."
    )


def _rising(rows: tuple[tuple[float, float], ...]) -> tuple[tuple[float, float], ...]:
    if any(after[0] <= before[0] for before, after in itertools.pairwise(rows)):
        raise refuse("the elongation does not rise from row to row", allowed="rows in rising order")
    return rows


class _Damped(ConnectorBlock):
    damping: DampingPerSpeed = Field(default=0.0, description="Force per rate of elongation. Default: none.")


class _EndToEnd(_Damped):
    direction: Direction | None = Field(
        default=None,
        description="Direction of a guide that it works in, as 'axis' of a hinge; motion across is then not resisted. "
        "Default: from its end on the one unit to that on the other, wherever these are.",
    )


class RubberConnector(_EndToEnd):
    """A curve of force over elongation; without a direction it is drawn from end to end and pressed along the row."""

    kind: Literal["rubber"] = Field(description="Curve of force over elongation.")
    curve: Annotated[
        tuple[tuple[Length, ForceOfCurve], ...], Field(min_length=2, max_length=1000), AfterValidator(_rising)
    ] = Field(
        description="Rows [elongation, force], elongation rising, pull positive; straight between and beyond.",
        examples=[[["-0.1 m", "-80 kN"], ["0 m", "0 kN"], ["0.2 m", "60 kN"]]],
    )


class ChainConnector(_EndToEnd):
    """Pulls when it is taut, without force before."""

    kind: Literal["chain"] = Field(description="Chain or rope with slack.")
    stiffness: Stiffness = Field(description="When it is taut.")
    slack: NonNegativeLength = Field(default=0.0, description="Elongation at which it is taut. Default: 0.")


class FenderConnector(_Damped):
    """Pushes when it is pressed, without force before."""

    direction: Direction = Field(
        default="y", description="Direction that it pushes in, as 'axis' of a hinge. Default: y, along the row."
    )
    kind: Literal["fender"] = Field(description="Fender.")
    stiffness: Stiffness = Field(description="When it is pressed.")
    clearance: NonNegativeLength = Field(default=0.0, description="Closing at which it is pressed. Default: 0.")


ConnectorEntry = Annotated[
    RigidConnector
    | HingeConnector
    | BallConnector
    | SpringConnector
    | RubberConnector
    | ChainConnector
    | FenderConnector,
    Field(discriminator="kind"),
]
