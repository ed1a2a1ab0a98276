"""Schema of what a design has to keep: one block per structure, each key judged on a number of the first page."""

from __future__ import annotations

import math
from typing import Annotated, Any, ClassVar, Literal

from pydantic import AfterValidator, Discriminator, Field, Tag

from moyai.case.schema_types import Block, KeyGroups, Name, QuantityOf, refuse
from moyai.core import quantities
from moyai.tables.design_codes import available_codes

NOT_JUDGED = (("not_judged", math.nan),)
"""Word that switches one criterion off; its limit is then NaN."""

_FORCE_WORDS = (("none", 0.0), *NOT_JUDGED)

FactorOfSafety = Annotated[float | None, QuantityOf(quantities.NUMBER, least=1.0, words=NOT_JUDGED)]
GreatestForce = Annotated[float | None, QuantityOf(quantities.FORCE, least=0.0, words=_FORCE_WORDS)]
GreatestTension = Annotated[float | None, QuantityOf(quantities.FORCE, above=0.0, words=NOT_JUDGED)]
GreatestMoment = Annotated[float | None, QuantityOf(quantities.MOMENT, above=0.0, words=NOT_JUDGED)]
GreatestNetTension = Annotated[float | None, QuantityOf(quantities.FORCE_PER_LENGTH, above=0.0, words=NOT_JUDGED)]
GreatestLength = Annotated[float | None, QuantityOf(quantities.LENGTH, above=0.0, words=NOT_JUDGED)]
LeastLength = Annotated[float | None, QuantityOf(quantities.LENGTH, words=NOT_JUDGED)]
LeastSpeed = Annotated[float | None, QuantityOf(quantities.SPEED, above=0.0, words=NOT_JUDGED)]
GreatestAngle = Annotated[float | None, QuantityOf(quantities.ANGLE_DEGREES, above=0.0, most=180.0, words=NOT_JUDGED)]
Share = Annotated[float | None, QuantityOf(quantities.NUMBER, above=0.0, most=1.0, words=NOT_JUDGED)]
SeaShare = Annotated[float, QuantityOf(quantities.NUMBER, above=0.0, most=1.0)]

OFF = "; 'not_judged' leaves it out"


def _known_code(name: str) -> str:
    if name not in available_codes():
        raise refuse(f"there is no design code '{name}'", allowed=", ".join(available_codes()))
    return name


CodeName = Annotated[str, Field(min_length=1, max_length=80), AfterValidator(_known_code)]


class LineCodeKeys(Block):
    """A design code of mooring lines with its options."""

    name: CodeName = Field(description="Name of the code in the tables.", examples=["DNV-OS-E301"])
    consequence: Name | None = Field(default=None, description="Consequence class, for codes that have classes.")
    analysis: Literal["dynamic", "quasi_static", "static"] | None = Field(
        default=None, description="How the tensions were found; absent: as the case computes them."
    )
    component: Literal["chain", "rope", "wire", "knotted_rope", "shackle", "used_chain"] | None = Field(
        default=None, description="What the lines are made of; absent: the strictest of the lines' materials."
    )
    confirmed: tuple[CodeName, ...] = Field(
        default=(), description="Codes whose values were compared with the standard itself."
    )


def word_or_block(value: Any) -> str:
    """Return the form of a key that is a word or a block."""
    return "<word>" if isinstance(value, str) else "<block>"


def sea_form(value: Any) -> str:
    """Return the form of a key that is one number or one for each sea."""
    return "<seas>" if isinstance(value, dict) else "<number>"


class LineCriteria(Block):
    """What the lines of a structure have to keep."""

    at_most_one: ClassVar[KeyGroups] = (("line_safety_factor", "code"),)

    line_safety_factor: FactorOfSafety = Field(
        default=None, description="Breaking load over the largest tension, at least" + OFF + "."
    )
    code: Annotated[
        Annotated[CodeName, Tag("<word>")] | Annotated[LineCodeKeys, Tag("<block>")], Discriminator(word_or_block)
    ] = Field(
        default="",
        description="Design code of the lines in place of a factor: its name, or a block.",
        examples=["ISO 19901-7", {"name": "DNV-OS-E301", "consequence": "1"}],
    )


NoCriteria = Literal["none"]
CRITERIA = "What the design has to keep, besides the defaults that 'moyai check' lists; 'none' switches judging off."
"""Description of the key of every structure."""
