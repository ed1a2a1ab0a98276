"""What a silt curtain has to keep: the block of its case, and the defaults with their source."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Annotated, Any

from pydantic import Discriminator, Field, Tag

from moyai.case.criteria import CASE, given_criteria
from moyai.case.schema_criteria import (
    OFF,
    FactorOfSafety,
    GreatestForce,
    GreatestLength,
    LeastLength,
    LeastSpeed,
    NoCriteria,
    Share,
    word_or_block,
)
from moyai.case.schema_types import Block
from moyai.core.errors import InputError
from moyai.core.headline import Criterion

CURTAIN_SOURCE = "default of moyai: practice of silt curtains, rope 3, sheet and belts 3 to 5, anchor 1.2 to 2; no code"

AFLOAT_SOURCE = "default of moyai: afloat"

CURTAIN_FACTORS = {
    "cable": ("cable_utilisation", "factor of safety of the cables", 3.0),
    "sheet": ("fabric_utilisation", "factor of safety of the sheet", 4.0),
    "joint": ("joint_utilisation", "factor of safety of the joints", 3.0),
    "anchor_line": ("anchor_line_utilisation", "factor of safety of the anchor lines", 3.0),
    "anchor": ("anchor_utilisation", "factor of safety of the anchors", 1.5),
}
"""Of ``settings.safety_factors``: headline, words, default."""
_CURTAIN_KEYS = {"sheet": "fabric_safety_factor"}


class CurtainCriteria(Block):
    """What a silt curtain has to keep."""

    cable_safety_factor: FactorOfSafety = Field(
        default=None,
        description="Breaking load of a cable over its tension, at least; as 'settings.safety_factors.cable'"
        + OFF
        + ".",
    )
    fabric_safety_factor: FactorOfSafety = Field(
        default=None, description="Strength of the sheet over its load; as 'settings.safety_factors.sheet'" + OFF + "."
    )
    joint_safety_factor: FactorOfSafety = Field(
        default=None, description="Strength of a joint over its load; as 'settings.safety_factors.joint'" + OFF + "."
    )
    anchor_line_safety_factor: FactorOfSafety = Field(
        default=None,
        description="Breaking load of an anchor line over its tension; as 'settings.safety_factors.anchor_line'"
        + OFF
        + ".",
    )
    anchor_safety_factor: FactorOfSafety = Field(
        default=None,
        description="Holding force of an anchor over its load; as 'settings.safety_factors.anchor'" + OFF + ".",
    )
    least_float_reserve: Share = Field(
        default=None, description="Share of the buoyancy that is left; as 'settings.least_float_reserve'" + OFF + "."
    )
    least_effective_depth: LeastLength = Field(
        default=None, description="Effective depth that is kept; as 'settings.least_effective_depth'" + OFF + "."
    )
    least_toe_clearance: LeastLength = Field(default=None, description="Gap between toe and bed" + OFF + ".")
    greatest_anchor_load: GreatestForce = Field(default=None, description="Largest load on an anchor" + OFF + ".")
    least_limit_current: LeastSpeed = Field(
        default=None, description="Current up to which the curtain has to hold" + OFF + "."
    )
    least_limit_wave_height: GreatestLength = Field(
        default=None, description="Wave height up to which the curtain has to hold" + OFF + "."
    )


CurtainKeeps = Annotated[
    Annotated[NoCriteria, Tag("<word>")] | Annotated[CurtainCriteria, Tag("<block>")], Discriminator(word_or_block)
]


def criteria(model: Any, given: Any) -> Iterator[Criterion]:
    """Yield what the headlines are judged against: the block of the case, else the defaults with their source."""
    for part, (headline, words, _) in CURTAIN_FACTORS.items():
        factor, source = curtain_factor(model, part)
        if source != CASE and not _has_strength(model.structure, part):
            continue
        yield Criterion(
            curtain_key(part), headline, 1.0 / factor, "at most", source, words, as_factor=True, assumed=source != CASE
        )
    for key, headline, unit, words in (
        ("least_effective_depth", "effective_depth", "m", "effective depth"),
        ("least_float_reserve", "float_reserve", "%", "reserve of the floats"),
    ):
        limit = curtain_limit(model, key)
        asked = None if isinstance(model.criteria, str) else getattr(model.criteria, key)
        if limit > 0.0:
            yield Criterion(key, headline, limit, "at least", CASE, words, unit)
        elif key == "least_float_reserve" and asked is None:
            yield Criterion(key, headline, 0.0, "at least", AFLOAT_SOURCE, words, unit, assumed=True)
    yield from given_criteria(given)


def curtain_key(part: str) -> str:
    """Return the key of ``criteria`` that says the same as ``settings.safety_factors.<part>``."""
    return _CURTAIN_KEYS.get(part, f"{part}_safety_factor")


def curtain_factor(model: Any, part: str) -> tuple[float, str]:
    """Return a factor of safety of a curtain (NaN where it is not judged) and its source.

    Parameters
    ----------
    model : CurtainCase
    part : str
        Key of ``settings.safety_factors``.
    """
    if isinstance(model.criteria, str):
        asked = None
    else:
        asked = getattr(model.criteria, curtain_key(part))
    old = getattr(model.settings.safety_factors, part)
    if asked is not None and old is not None and asked != old:
        raise InputError(
            f"'{curtain_key(part)}' and 'settings.safety_factors.{part}' ({old:g}) contradict each other",
            path=f"criteria.{curtain_key(part)}",
            remedy="keep one of them",
        )
    if asked is not None or old is not None:
        return (asked if asked is not None else old), CASE
    return CURTAIN_FACTORS[part][2], CURTAIN_SOURCE


def curtain_limit(model: Any, key: str) -> float:
    """Return ``least_effective_depth`` [m] or ``least_float_reserve`` [-] from either of their places; 0 for none."""
    old = float(getattr(model.settings, key))
    asked = None if isinstance(model.criteria, str) else getattr(model.criteria, key)
    if asked is None or math.isnan(asked):
        return old if asked is None else 0.0
    if old > 0.0 and old != asked:
        raise InputError(
            f"'{key}' is {old:g} under 'settings' and {asked:g} here",
            path=f"criteria.{key}",
            remedy="keep one of them",
        )
    return float(asked)


def _has_strength(unit: Any, part: str) -> bool:
    if part == "cable":
        cables = [cable for cable in (unit.cables.upper, unit.cables.lower) if cable is not None]
        return any(cable.breaking_load is not None or cable.catalogue is not None for cable in cables)
    value = {
        "sheet": unit.skirt.strength,
        "joint": getattr(unit.joints, "strength", None),
        "anchor_line": getattr(unit.anchors, "breaking_load", None),
        "anchor": getattr(unit.anchors, "holding_force", None),
    }[part]
    return value is not None
