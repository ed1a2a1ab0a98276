"""Keys of files with the coefficients of other programs, the same for every structure that takes them."""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from moyai.case.schema_types import Block, Length, PositiveLength


class OfCapytaine(Block):
    """What a file of Capytaine asks for."""

    program: Literal["capytaine"] = Field(description="NetCDF written by Capytaine.")
    reference_point: tuple[Length, Length, Length] | None = Field(
        default=None, description="Rotation centre [x, y, z] where the file does not say it."
    )
    body: str | None = Field(default=None, description="Body to take from a file with several.")


class OfWamit(Block):
    """What files of WAMIT, or in its form, ask for."""

    program: Literal["wamit"] = Field(description="WAMIT .1 and .3 files (HAMS writes them too).")
    reference_point: tuple[Length, Length, Length] | None = Field(
        default=None, description="Origin of the body axes [x, y, z]; from the .pot file when absent."
    )
    length_scale: PositiveLength | None = Field(default=None, description="ULEN; from the .gdf file when absent.")
    first_column: Literal["period", "angular_frequency", "wave_number"] | None = Field(
        default=None, description="Meaning of the first column; must be given for HAMS."
    )


class OfNemoh(Block):
    """What a folder of NEMOH asks for."""

    program: Literal["nemoh"] = Field(description="Folder with Nemoh.cal and Results.")
