"""What a net cage has to keep: the block of its case, and the defaults with their source."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Annotated, Any

from pydantic import Discriminator, Field, Tag

from moyai.case.criteria import given_criteria, line_criteria
from moyai.case.line_code import make_of
from moyai.case.schema_criteria import (
    OFF,
    GreatestForce,
    GreatestLength,
    GreatestNetTension,
    GreatestTension,
    LineCriteria,
    NoCriteria,
    Share,
    word_or_block,
)
from moyai.core.headline import Criterion

CAGE_CODE = "NS 9415"


class CageCriteria(LineCriteria):
    """What a net cage has to keep."""

    least_volume_left: Share = Field(
        default=None, description="Share of the volume as built that is left, also for moments in the sea" + OFF + "."
    )
    greatest_offset: GreatestLength = Field(default=None, description="Largest offset from rest" + OFF + ".")
    greatest_drag: GreatestTension = Field(
        default=None, description="Largest drag of the cage, also for moments in the sea" + OFF + "."
    )
    greatest_net_tension: GreatestNetTension = Field(
        default=None, description="Largest tension of the net over its width" + OFF + "."
    )
    greatest_anchor_load: GreatestForce = Field(default=None, description="Largest load on an anchor" + OFF + ".")


CageKeeps = Annotated[
    Annotated[NoCriteria, Tag("<word>")] | Annotated[CageCriteria, Tag("<block>")], Discriminator(word_or_block)
]


def criteria(model: Any, given: Any) -> Iterator[Criterion]:
    """Yield what the headlines are judged against: the block of the case, else the defaults with their source."""
    mooring = model.structure.mooring
    ropes: list[Any] = []
    own = getattr(mooring, "kind", "") == "lines"
    if getattr(mooring, "kind", "") == "grid":
        ropes = [mooring.frame_rope, mooring.bridle, *mooring.anchor_line]
    elif own:
        ropes = [line for line in mooring.lines if line.breaking_load is not None]
    elif getattr(mooring, "breaking_load", None) is not None:
        ropes = [mooring]
    yield from line_criteria(
        given,
        CAGE_CODE if ropes else "",
        "dynamic" if "time" in model.analyses else "static",
        # a line of its own does not say what it is made of: the strictest factor
        [None if own else make_of(rope) or "rope" for rope in ropes],
    )
    yield from given_criteria(given)
