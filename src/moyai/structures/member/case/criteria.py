"""What a member has to keep: the block of its case, and the defaults with their source."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Annotated, Any

from pydantic import Discriminator, Field, Tag

from moyai.case.criteria import given_criteria
from moyai.case.schema_criteria import (
    OFF,
    GreatestMoment,
    GreatestTension,
    NoCriteria,
    word_or_block,
)
from moyai.case.schema_types import Block
from moyai.core.headline import Criterion


class MemberCriteria(Block):
    """What a member has to keep."""

    greatest_force: GreatestTension = Field(default=None, description="Largest force on the member" + OFF + ".")
    greatest_bending_moment: GreatestMoment = Field(
        default=None, description="Largest bending moment of waves and current in the member" + OFF + "."
    )


MemberKeeps = Annotated[
    Annotated[NoCriteria, Tag("<word>")] | Annotated[MemberCriteria, Tag("<block>")], Discriminator(word_or_block)
]


def criteria(model: Any, given: Any) -> Iterator[Criterion]:
    """Yield what the headlines are judged against: the block of the case, else the defaults with their source."""
    yield from given_criteria(given)
