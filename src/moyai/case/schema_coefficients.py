"""Keys of files with the coefficients of other programs, the same for every structure that takes them."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import BeforeValidator, Field

from moyai.case.schema_types import Block, Length, PositiveLength

_BODY = (
    "Body to take from a file with several, by name or by number from 1; the others are then held, their coupling is "
    "left out."
)


def word_of(value: Any) -> Any:
    """Return a number of a body as a word, anything else as it is."""
    return str(value) if isinstance(value, int) and not isinstance(value, bool) else value


BodyOfFile = Annotated[str | None, BeforeValidator(word_of)]


class OfCapytaine(Block):
    """What a file of Capytaine asks for."""

    program: Literal["capytaine"] = Field(description="NetCDF written by Capytaine.")
    reference_point: tuple[Length, Length, Length] | None = Field(
        default=None, description="Rotation centre [x, y, z] where the file does not give it."
    )
    body: BodyOfFile = Field(default=None, description=_BODY)


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
    body: BodyOfFile = Field(default=None, description=_BODY)


class OfNemoh(Block):
    """What a folder of NEMOH asks for."""

    program: Literal["nemoh"] = Field(description="Folder with Nemoh.cal and Results.")
    body: BodyOfFile = Field(default=None, description=_BODY)
