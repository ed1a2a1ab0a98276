"""What a floating breakwater has to keep: the block of its case, and the defaults with their source."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Annotated, Any

from pydantic import Discriminator, Field, Tag

from moyai.case.criteria import CASE, DEFAULT_CODE, UPLIFT_SOURCE, given_criteria, line_criteria, plain_criterion
from moyai.case.line_code import make_of
from moyai.case.schema_criteria import (
    OFF,
    GreatestAngle,
    GreatestForce,
    GreatestLength,
    LeastLength,
    LineCriteria,
    NoCriteria,
    SeaShare,
    Share,
    sea_form,
    word_or_block,
)
from moyai.case.schema_types import Name
from moyai.core.headline import UNCONFIRMED, Criterion

AFLOAT_SOURCE = "default of moyai: upright and afloat"
#: Metacentric height over draught that Japanese practice asks of caissons afloat.
STABLE_SHARE = 0.05
STABLE_SOURCE = (
    f"default of moyai: 5 % of the draught, as Japanese port practice requires of floating caissons, {UNCONFIRMED}"
)


class BreakwaterCriteria(LineCriteria):
    """What a floating breakwater has to keep."""

    greatest_transmission: Annotated[
        Annotated[Share, Tag("<number>")] | Annotated[dict[Name, SeaShare], Tag("<seas>"), Field(min_length=1)],
        Discriminator(sea_form),
    ] = Field(
        default=None,
        description="Largest K_T in every sea and period of the case, or in named seas {name: K_T}" + OFF + ".",
        examples=[{"storm": 0.5}],
    )
    greatest_offset: GreatestLength = Field(default=None, description="Largest offset from rest" + OFF + ".")
    greatest_roll_deg: GreatestAngle = Field(default=None, description="Largest roll angle" + OFF + ".")
    greatest_uplift: GreatestForce = Field(
        default=None, description="Largest upward force on an anchor, or 'none'" + OFF + "."
    )
    greatest_anchor_load: GreatestForce = Field(
        default=None,
        description="Largest horizontal force on an anchor: its holding force over its factor of safety" + OFF + ".",
    )
    least_freeboard: LeastLength = Field(default=None, description="Freeboard that is left" + OFF + ".")
    least_metacentric_height: LeastLength = Field(default=None, description="Metacentric height GM" + OFF + ".")


BreakwaterKeeps = Annotated[
    Annotated[NoCriteria, Tag("<word>")] | Annotated[BreakwaterCriteria, Tag("<block>")], Discriminator(word_or_block)
]


def criteria(model: Any, given: Any) -> Iterator[Criterion]:
    """Yield what the headlines are judged against: the block of the case, else the defaults with their source."""
    moored = [line for line in model.lines if line.kind == "catenary"]
    # Whether lines run in motion is decided by the run: each number is judged by the factor of its own analysis
    yield from line_criteria(
        given,
        DEFAULT_CODE if moored else "",
        "",
        [make_of(part) for line in moored for part in line.segments if not hasattr(part, "clump")],
    )
    if given.greatest_uplift is None and moored:
        yield plain_criterion("greatest_uplift", 0.0, UPLIFT_SOURCE)
    yield from given_criteria(given, {"greatest_anchor_load": "anchor_horizontal_tension"})
    yield from _transmission(given.greatest_transmission)
    if "statics" not in model.analyses:
        return
    draught = model.structure.draught
    if given.least_metacentric_height is None and draught is not None:
        yield plain_criterion("least_metacentric_height", STABLE_SHARE * draught, STABLE_SOURCE)
    elif given.least_metacentric_height is None:
        yield plain_criterion("least_metacentric_height", 0.0, AFLOAT_SOURCE)
    if given.least_freeboard is None:
        yield plain_criterion("least_freeboard", 0.0, AFLOAT_SOURCE)


def _transmission(limit: Any) -> Iterator[Criterion]:
    """Yield the limits on K_T; one without a sea holds in every sea, so that no further sea can make a design hold."""
    seas = limit if isinstance(limit, dict) else {} if limit is None else {"": limit}
    for sea, value in seas.items():
        yield Criterion("greatest_transmission", "transmission", value, "at most", CASE, "transmission K_T", sea=sea)
