"""Schema of how the report of any structure shows its numbers."""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from moyai.case.schema_types import Block

DISPLAY = "How the report shows its numbers; results.nc stays in SI."


class Display(Block):
    """How reports show numbers, and in which language."""

    units: Literal["SI", "tf"] = Field(
        default="SI",
        description="Units of forces, moments and pressures: `SI` (kN, kN m, kPa), or `tf` (tf or kgf, tf m, tf/m2).",
    )
    language: Literal["en", "ja"] | None = Field(
        default=None,
        description="Language of reports and messages: `en` or `ja`; that of the computer when left out.",
    )
