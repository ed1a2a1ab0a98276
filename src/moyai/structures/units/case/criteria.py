"""What a row of units has to keep: the block of its case, and the defaults with their source."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Annotated, Any

from pydantic import Discriminator, Field, Tag

from moyai.case.criteria import (
    CASE,
    DEFAULT_CODE,
    UPLIFT_SOURCE,
    given_criteria,
    line_criteria,
    plain_criterion,
)
from moyai.case.line_code import make_of
from moyai.case.schema_criteria import (
    OFF,
    FactorOfSafety,
    GreatestAngle,
    GreatestForce,
    GreatestLength,
    GreatestTension,
    LeastLength,
    LineCriteria,
    NoCriteria,
    SeaShare,
    Share,
    sea_form,
    word_or_block,
)
from moyai.case.schema_types import Name, QuantityOf
from moyai.core import quantities
from moyai.core.headline import UNCONFIRMED, Criterion
from moyai.structures.units.case.places import placements_of
from moyai.structures.units.faces import gaps_between

AFLOAT_SOURCE = "default of moyai: upright and afloat"
#: Metacentric height over draught that Japanese practice asks of caissons afloat.
STABLE_SHARE = 0.05
STABLE_SOURCE = (
    f"default of moyai: 5 % of the draught, as Japanese port practice requires of floating caissons, {UNCONFIRMED}"
)
#: Breaking load over the largest force of a connector, where the case gives nothing.
CONNECTOR_FACTOR = 2.0
CONNECTOR_SOURCE = "default of moyai: 2 on the breaking load of a connector; no code"
TOUCH_SOURCE = "default of moyai: hulls do not touch"
GreatestRatio = Annotated[float | None, QuantityOf(quantities.NUMBER, above=0.0)]


class UnitsCriteria(LineCriteria):
    """What a row of units has to keep."""

    connector_safety_factor: FactorOfSafety = Field(
        default=None, description="Breaking load over the largest force of a connector, at least" + OFF + "."
    )
    greatest_connector_force: GreatestTension = Field(
        default=None, description="Largest force in a connector" + OFF + "."
    )
    greatest_transmission: Annotated[
        Annotated[Share, Tag("<number>")] | Annotated[dict[Name, SeaShare], Tag("<seas>"), Field(min_length=1)],
        Discriminator(sea_form),
    ] = Field(
        default=None,
        description="Largest transmission over the line behind: of the governing sea, or of named ones" + OFF + ".",
        examples=[{"storm": 0.5}],
    )
    greatest_berth_ratio: GreatestRatio = Field(
        default=None, description="Largest wave height at a named point over the incident one."
    )
    greatest_gap_motion: GreatestLength = Field(
        default=None, description="Largest opening and closing of a gap" + OFF + "."
    )
    greatest_gap_closing: Share = Field(
        default=None,
        description="Largest share of a gap that closes at a corner of the hulls; at 1 they touch" + OFF + ".",
    )
    greatest_connector_damage: Share = Field(
        default=None,
        description="Largest share of the life of a connector that a sea takes; needs 'endurance' and the time domain"
        + OFF
        + ".",
    )
    greatest_offset: GreatestLength = Field(
        default=None, description="Largest horizontal distance from rest" + OFF + "."
    )
    greatest_uplift: GreatestForce = Field(
        default=None, description="Largest upward force on an anchor, or 'none'" + OFF + "."
    )
    greatest_anchor_load: GreatestForce = Field(
        default=None,
        description="Largest horizontal force on an anchor: its holding force over its factor of safety" + OFF + ".",
    )
    greatest_roll_deg: GreatestAngle = Field(
        default=None, description="Largest roll or pitch, double amplitude" + OFF + "."
    )
    least_freeboard: LeastLength = Field(default=None, description="Freeboard that is left" + OFF + ".")
    least_metacentric_height: LeastLength = Field(default=None, description="Metacentric height GM" + OFF + ".")


UnitsKeeps = Annotated[
    Annotated[NoCriteria, Tag("<word>")] | Annotated[UnitsCriteria, Tag("<block>")], Discriminator(word_or_block)
]

_OWN = {
    "greatest_connector_force": ("connector_force", "N", "force in the connectors"),
    "greatest_berth_ratio": ("berth_wave_height", "1", "wave height at the named points"),
    "greatest_connector_damage": ("connector_damage", "1", "share of the life of the connectors"),
    "greatest_gap_motion": ("gap_motion", "m", "motion of the gaps"),
    "greatest_gap_closing": ("gap_closing", "1", "closing of the gaps"),
}


def criteria(model: Any, given: Any) -> Iterator[Criterion]:
    """Yield what the headlines are judged against: the block of the case, else the defaults with their source."""
    moored = [line for line in model.lines if line.kind == "catenary"]
    computed = bool(model.waves) and bool({"frequency", "map", "time"} & set(model.analyses))
    yield from line_criteria(
        given,
        DEFAULT_CODE if moored else "",
        "" if "time" in model.analyses else "quasi_static" if computed else "static",
        [make_of(part) for line in moored for part in line.segments if not hasattr(part, "clump")],
    )
    asked, given_loads = given.connector_safety_factor, [one.breaking_load for one in model.structure.connectors]
    if asked is not None or (computed and any(given_loads)):
        yield Criterion(
            "connector_safety_factor", "connector_utilisation", 1.0 / (asked or CONNECTOR_FACTOR), "at most",
            CASE if asked is not None else CONNECTOR_SOURCE, "factor of safety of the connectors", as_factor=True,
            assumed=asked is None,
        )  # fmt: skip
    for key, (headline, unit, words) in _OWN.items():
        if getattr(given, key) is not None:
            yield Criterion(key, headline, getattr(given, key), "at most", CASE, words, unit)
    limit = given.greatest_transmission
    seas = limit if isinstance(limit, dict) else {} if limit is None else {"": limit}
    for sea, value in seas.items():
        yield Criterion("greatest_transmission", "transmission", value, "at most", CASE, "transmission", sea=sea)
    if given.greatest_gap_closing is None and computed and _has_gaps(model):
        headline, unit, words = _OWN["greatest_gap_closing"]
        yield Criterion(
            "greatest_gap_closing", headline, 1.0, "at most", TOUCH_SOURCE, words, unit, assumed=True
        )  # fmt: skip
    if given.greatest_uplift is None and moored:
        yield plain_criterion("greatest_uplift", 0.0, UPLIFT_SOURCE)
    yield from given_criteria(given, {"greatest_anchor_load": "anchor_horizontal_tension"})
    if given.least_metacentric_height is None:
        yield plain_criterion("least_metacentric_height", STABLE_SHARE * model.structure.draught, STABLE_SOURCE)
    if given.least_freeboard is None:
        yield plain_criterion("least_freeboard", 0.0, AFLOAT_SOURCE)


def _has_gaps(model: Any) -> bool:
    units = model.structure.units
    return bool(gaps_between(placements_of(units), units.length, model.structure.section.hull().bounds[:2]))
