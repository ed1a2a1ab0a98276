"""Schema of measured points that any structure's report lays over one of its figures."""

from __future__ import annotations

from typing import Annotated

from pydantic import Field

from moyai.case.schema_types import Block, FileName, Name, OneOrMany, Whole

MEASURED = "Measured points to lay over figures of the report: one set, or a list of them."


class MeasuredPointsKeys(Block):
    """Measured points x, y over one figure of the report."""

    file: FileName = Field(
        description="CSV of x and y, in the units of the axes or with units in its header: 'time [s], force [N]'."
    )
    figure: Annotated[str, Field(min_length=1, max_length=200)] = Field(
        description="Figure as the report names its data, or the end of that name for all levels and seas: 'rao'."
    )
    panel: Whole = Field(default=1, description="Which of the diagrams of the figure, from the top.")
    label: Name | None = Field(default=None, description="Name in the legend; that of the file when absent.")


MeasuredSets = Annotated[tuple[MeasuredPointsKeys, ...], OneOrMany(), Field(max_length=100)]
