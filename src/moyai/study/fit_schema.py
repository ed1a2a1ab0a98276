"""The file of a fit: a case, what of it is unknown, and what was observed."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import Field

from moyai.case.schema_types import Block, FileName, PositiveNumber, Seed, Whole

Value = Any


class Unknown(Block):
    """A value to be found."""

    first: Annotated[Value, Field(alias="from", description="Smallest value.")]
    last: Annotated[Value, Field(alias="to", description="Largest value.")]
    start: Annotated[Value, Field(description="First guess; the case's own value when absent.")] = None


class Observations(Block):
    """What was measured: a row a case."""

    file: Annotated[FileName, Field(description="CSV, relative to this file.")]
    columns: Annotated[
        dict[str, str], Field(default_factory=dict, description="Path of the case that each column sets.")
    ]
    units: Annotated[dict[str, str], Field(default_factory=dict, description="Unit of a column without one.")]
    observed: Annotated[str, Field(description="Column of the observation, in the unit of the response.")]
    response: Annotated[str, Field(description="Response of the case that it represents; the largest entry is used.")]
    error: Annotated[str, Field(description="Column of the standard error of the observation.")] = ""
    group: Annotated[str, Field(description="Column of the storm or test: left out one by one.")] = ""


class FitBlock(Block):
    """The fit."""

    title: Annotated[str, Field(description="Title of the report.")] = "Fit"
    base: Annotated[FileName, Field(description="The case, relative to this file.")]
    set: Annotated[dict[str, Value], Field(default_factory=dict, description="Changes that all rows share.")]
    parameters: Annotated[dict[str, Unknown], Field(min_length=1, description="By path.")]
    observations: Annotated[Observations, Field(description="The file of what was measured.")]
    bootstrap: Annotated[
        Whole | Literal[0], Field(description="Draws; each costs a whole fit. 0: intervals of the covariance.")
    ] = 0
    seed: Annotated[Seed, Field(description="Of the bootstrap.")] = 1
    step: Annotated[PositiveNumber, Field(description="Relative change by which slopes are found.")] = 1e-4


class FitFile(Block):
    """Root of a fit file."""

    moyai: Annotated[Literal[1], Field(description="Version of the file format.")]
    fit: Annotated[FitBlock, Field(description="Case, unknown values and observations.")]
