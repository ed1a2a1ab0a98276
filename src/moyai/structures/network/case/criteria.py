"""What a network has to keep: the block of its case, and the defaults with their source."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Annotated, Any

from pydantic import Discriminator, Field, Tag

from moyai.case.criteria import DEFAULT_CODE, given_criteria, line_criteria
from moyai.case.line_code import make_of
from moyai.case.schema_criteria import (
    OFF,
    GreatestForce,
    GreatestLength,
    GreatestNetTension,
    GreatestTension,
    LineCriteria,
    NoCriteria,
    word_or_block,
)
from moyai.core.headline import Criterion


class NetworkCriteria(LineCriteria):
    """What a network has to keep."""

    greatest_tension: GreatestTension = Field(default=None, description="Largest tension of a line" + OFF + ".")
    greatest_net_tension: GreatestNetTension = Field(
        default=None, description="Largest tension of the net over its width" + OFF + "."
    )
    greatest_offset: GreatestLength = Field(default=None, description="Largest offset from rest" + OFF + ".")
    greatest_anchor_load: GreatestForce = Field(default=None, description="Largest load on an anchor" + OFF + ".")


NetworkKeeps = Annotated[
    Annotated[NoCriteria, Tag("<word>")] | Annotated[NetworkCriteria, Tag("<block>")], Discriminator(word_or_block)
]


def criteria(model: Any, given: Any) -> Iterator[Criterion]:
    """Yield what the headlines are judged against: the block of the case, else the defaults with their source."""
    types = model.structure.line_types.values()
    strong = [kind for kind in types if getattr(kind, "catalogue", None) or getattr(kind, "breaking_load", None)]
    yield from line_criteria(
        given,
        DEFAULT_CODE if strong and model.structure.lines else "",
        "dynamic" if "dynamic" in model.analyses else "quasi_static",
        [make_of(kind) for kind in types],
    )
    yield from given_criteria(given, {"greatest_anchor_load": "point_load"})
