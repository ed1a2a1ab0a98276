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
GreatestNetTension = Annotated[float | None, QuantityOf(quantities.FORCE_PER_LENGTH, above=0.0, words=NOT_JUDGED)]
GreatestLength = Annotated[float | None, QuantityOf(quantities.LENGTH, above=0.0, words=NOT_JUDGED)]
LeastLength = Annotated[float | None, QuantityOf(quantities.LENGTH, words=NOT_JUDGED)]
LeastSpeed = Annotated[float | None, QuantityOf(quantities.SPEED, above=0.0, words=NOT_JUDGED)]
GreatestAngle = Annotated[float | None, QuantityOf(quantities.ANGLE_DEGREES, above=0.0, most=180.0, words=NOT_JUDGED)]
Share = Annotated[float | None, QuantityOf(quantities.NUMBER, above=0.0, most=1.0, words=NOT_JUDGED)]
SeaShare = Annotated[float, QuantityOf(quantities.NUMBER, above=0.0, most=1.0)]

_OFF = "; 'not_judged' leaves it out"


def _known_code(name: str) -> str:
    if name not in available_codes():
        raise refuse(f"there is no design code '{name}'", allowed=", ".join(available_codes()))
    return name


CodeName = Annotated[str, Field(min_length=1, max_length=80), AfterValidator(_known_code)]


class LineCode(Block):
    """A design code of mooring lines with what it needs to know."""

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


def _word_or_block(value: Any) -> str:
    return "<word>" if isinstance(value, str) else "<block>"


def _sea_form(value: Any) -> str:
    return "<seas>" if isinstance(value, dict) else "<number>"


class LineCriteria(Block):
    """What the lines of a structure have to keep."""

    at_most_one: ClassVar[KeyGroups] = (("line_safety_factor", "code"),)

    line_safety_factor: FactorOfSafety = Field(
        default=None, description="Breaking load over the largest tension, at least" + _OFF + "."
    )
    code: Annotated[
        Annotated[CodeName, Tag("<word>")] | Annotated[LineCode, Tag("<block>")], Discriminator(_word_or_block)
    ] = Field(
        default="",
        description="Design code of the lines in place of a factor: its name, or a block.",
        examples=["ISO 19901-7", {"name": "DNV-OS-E301", "consequence": "1"}],
    )


class BreakwaterCriteria(LineCriteria):
    """What a floating breakwater has to keep."""

    greatest_transmission: Annotated[
        Annotated[Share, Tag("<number>")] | Annotated[dict[Name, SeaShare], Tag("<seas>"), Field(min_length=1)],
        Discriminator(_sea_form),
    ] = Field(
        default=None,
        description="Largest K_T: of the governing sea, or of named ones {name: K_T}" + _OFF + ".",
        examples=[{"storm": 0.5}],
    )
    greatest_offset: GreatestLength = Field(default=None, description="Largest offset from rest" + _OFF + ".")
    greatest_roll_deg: GreatestAngle = Field(default=None, description="Largest roll angle" + _OFF + ".")
    greatest_uplift: GreatestForce = Field(
        default=None, description="Largest upward force on an anchor, or 'none'" + _OFF + "."
    )
    greatest_anchor_load: GreatestForce = Field(
        default=None, description="Largest horizontal force on an anchor, its holding force" + _OFF + "."
    )
    least_freeboard: LeastLength = Field(default=None, description="Freeboard that is left" + _OFF + ".")
    least_metacentric_height: LeastLength = Field(default=None, description="Metacentric height GM" + _OFF + ".")


class CurtainCriteria(Block):
    """What a silt curtain has to keep."""

    cable_safety_factor: FactorOfSafety = Field(
        default=None,
        description="Breaking load of a cable over its tension, at least; as 'settings.safety_factors.cable'"
        + _OFF
        + ".",
    )
    fabric_safety_factor: FactorOfSafety = Field(
        default=None, description="Strength of the sheet over its load; as 'settings.safety_factors.sheet'" + _OFF + "."
    )
    joint_safety_factor: FactorOfSafety = Field(
        default=None, description="Strength of a joint over its load; as 'settings.safety_factors.joint'" + _OFF + "."
    )
    anchor_line_safety_factor: FactorOfSafety = Field(
        default=None,
        description="Breaking load of an anchor line over its tension; as 'settings.safety_factors.anchor_line'"
        + _OFF
        + ".",
    )
    anchor_safety_factor: FactorOfSafety = Field(
        default=None,
        description="Holding force of an anchor over its load; as 'settings.safety_factors.anchor'" + _OFF + ".",
    )
    least_float_reserve: Share = Field(
        default=None, description="Share of the buoyancy that is left; as 'settings.least_float_reserve'" + _OFF + "."
    )
    least_effective_depth: LeastLength = Field(
        default=None, description="Effective depth that is kept; as 'settings.least_effective_depth'" + _OFF + "."
    )
    least_toe_clearance: LeastLength = Field(default=None, description="Gap between toe and bed" + _OFF + ".")
    greatest_anchor_load: GreatestForce = Field(default=None, description="Largest load on an anchor" + _OFF + ".")
    least_limit_current: LeastSpeed = Field(
        default=None, description="Current up to which the curtain has to hold" + _OFF + "."
    )
    least_limit_wave_height: GreatestLength = Field(
        default=None, description="Wave height up to which the curtain has to hold" + _OFF + "."
    )


class CageCriteria(LineCriteria):
    """What a net cage has to keep."""

    least_volume_left: Share = Field(default=None, description="Share of the volume at rest that is left" + _OFF + ".")
    greatest_offset: GreatestLength = Field(default=None, description="Largest offset from rest" + _OFF + ".")
    greatest_drag: GreatestTension = Field(default=None, description="Largest drag of the cage" + _OFF + ".")
    greatest_net_tension: GreatestNetTension = Field(
        default=None, description="Largest tension of the net per width" + _OFF + "."
    )
    greatest_anchor_load: GreatestForce = Field(default=None, description="Largest load on an anchor" + _OFF + ".")


class NetworkCriteria(LineCriteria):
    """What a network has to keep."""

    greatest_tension: GreatestTension = Field(default=None, description="Largest tension of a line" + _OFF + ".")
    greatest_offset: GreatestLength = Field(default=None, description="Largest offset from rest" + _OFF + ".")
    greatest_anchor_load: GreatestForce = Field(default=None, description="Largest load on an anchor" + _OFF + ".")


class MemberCriteria(Block):
    """What a member has to keep."""

    greatest_force: GreatestTension = Field(default=None, description="Largest force on the member" + _OFF + ".")


NoCriteria = Literal["none"]
BreakwaterKeeps = Annotated[
    Annotated[NoCriteria, Tag("<word>")] | Annotated[BreakwaterCriteria, Tag("<block>")], Discriminator(_word_or_block)
]
CurtainKeeps = Annotated[
    Annotated[NoCriteria, Tag("<word>")] | Annotated[CurtainCriteria, Tag("<block>")], Discriminator(_word_or_block)
]
CageKeeps = Annotated[
    Annotated[NoCriteria, Tag("<word>")] | Annotated[CageCriteria, Tag("<block>")], Discriminator(_word_or_block)
]
NetworkKeeps = Annotated[
    Annotated[NoCriteria, Tag("<word>")] | Annotated[NetworkCriteria, Tag("<block>")], Discriminator(_word_or_block)
]
MemberKeeps = Annotated[
    Annotated[NoCriteria, Tag("<word>")] | Annotated[MemberCriteria, Tag("<block>")], Discriminator(_word_or_block)
]

CRITERIA = "What the design has to keep, beside the defaults that 'moyai check' lists; 'none' switches judging off."
"""Description of the key of every structure."""
