"""Factors of design codes, endurance curves and anchor holding (the CSV files in data/ hold numbers and sources)."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, fields
from typing import Any, Literal

from moyai.core.errors import InputError
from moyai.core.options import checks_words
from moyai.tables.reader import Record, read_table

_CODES, _CURVES, _ANCHORS = "design_codes.csv", "endurance_curves.csv", "anchor_friction.csv"
_FACTORS = "anchor_factors.csv"

Component = Literal["chain", "rope", "wire", "knotted_rope", "shackle", "used_chain"]
Analysis = Literal["dynamic", "quasi_static", "static"]
RuleName = Literal["safety_factor", "partial_mean", "partial_dynamic", "load_factor", "material_factor", "share"]


@checks_words
@dataclass(frozen=True)
class CodeRule:
    """One value of a design code."""

    #: Name of the code.
    code: str
    #: Edition of the code.
    edition: str
    #: ``intact``, ``one_lost`` or ``any``.
    condition: Literal["intact", "one_lost", "any"]
    #: ``dynamic``, ``quasi_static``, ``static`` or ``any``.
    analysis: Literal["dynamic", "quasi_static", "static", "any"]
    #: Class of the code, or ``any``.
    consequence: str
    #: What a line is made of, or ``any``.
    component: Literal["chain", "rope", "wire", "knotted_rope", "shackle", "used_chain", "any"]
    #: ``safety_factor``, ``partial_mean``, ``partial_dynamic``, ``load_factor``, ``material_factor`` or ``share``.
    rule: RuleName
    value: float
    #: Whether it was compared with the standard itself.
    confirmed: bool
    source: str


@checks_words
@dataclass(frozen=True)
class EnduranceData:
    """An endurance curve of the table; see :class:`moyai.design.fatigue.EnduranceCurve`."""

    name: str
    exponent: float
    capacity: float
    #: By how much log10 of the capacity falls with the mean tension over the breaking load.
    mean_term: float
    unit: str
    confirmed: bool
    source: str


@dataclass(frozen=True)
class HoldingData:
    """Friction of a sinker, or holding power of a drag anchor."""

    #: ``sinker`` or ``drag_anchor``.
    kind: str
    name: str
    bed: str
    #: Friction coefficient, or holding power over weight in air.
    value: float
    confirmed: bool
    source: str


@dataclass(frozen=True)
class AnchorFactor:
    """Safety factor on the pull of an anchor in one direction."""

    kind: str
    direction: str
    value: float
    confirmed: bool
    source: str


def available_codes() -> tuple[str, ...]:
    """Return the names of the design codes.

    Returns
    -------
    tuple of str
        Names that :func:`moyai.design.design_code` takes.

    Examples
    --------
    >>> from moyai.tables import available_codes
    >>> "ISO 19901-7" in available_codes()
    True
    """
    return tuple(dict.fromkeys(record["code"] for record in read_table(_CODES)))


def code_rules(code: str) -> tuple[CodeRule, ...]:
    """Return every rule of a code.

    Raises
    ------
    InputError
        For an unknown code.
    """
    found = tuple(_rule(record) for record in read_table(_CODES) if record["code"] == code)
    if not found:
        raise InputError(f"unknown code '{code}'", parameter="code", allowed=", ".join(available_codes()))
    return found


def applicable_rule(
    rules: Iterable[CodeRule], rule: str, *, condition: str, analysis: str, consequence: str, component: str
) -> CodeRule | None:
    """Return the value of a code that applies, the most special first; ``None`` when the code has none.

    Parameters
    ----------
    rules : iterable of CodeRule
    rule, condition, analysis, consequence, component : str
        As in :class:`CodeRule`.
    """
    found = [
        one
        for one in rules
        if one.rule == rule
        and one.condition in (condition, "any")
        and one.analysis in (analysis, "any")
        and one.consequence in (consequence, "any")
        and one.component in (component, "any")
    ]
    return min(found, key=lambda one: [one.component == "any", one.analysis == "any"], default=None)


def _rule(record: Record) -> CodeRule:
    values: dict[str, Any] = {name: record[name] for name in (field.name for field in fields(CodeRule))}
    return CodeRule(**{**values, "value": float(values["value"]), "confirmed": values["confirmed"] == "yes"})


def available_endurance_curves() -> tuple[str, ...]:
    """Return the names of the endurance curves."""
    return tuple(record["name"] for record in read_table(_CURVES))


def endurance_data(name: str) -> EnduranceData:
    """Return an endurance curve of the table.

    Raises
    ------
    InputError
        For an unknown name.
    """
    for record in read_table(_CURVES):
        if record["name"] == name:
            return EnduranceData(
                name, float(record["exponent"]), float(record["capacity"]), float(record["mean_term"]),
                record["unit"], record["confirmed"] == "yes", record["source"],
            )  # fmt: skip
    raise InputError(
        f"unknown endurance curve '{name}'", parameter="curve", allowed=", ".join(available_endurance_curves())
    )


def holding_data(kind: str, name: str, bed: str) -> HoldingData:
    """Return friction or holding power of an anchor on a bed.

    Raises
    ------
    InputError
        When the table has no such pair.
    """
    rows = [record for record in read_table(_ANCHORS) if record["kind"] == kind]
    for record in rows:
        if (record["name"], record["bed"]) == (name, bed):
            return HoldingData(kind, name, bed, float(record["value"]), record["confirmed"] == "yes", record["source"])
    pairs = ", ".join(f"{record['name']} on {record['bed']}" for record in rows)
    raise InputError(f"no {kind} '{name}' on '{bed}' in the table", parameter="anchor", allowed=pairs)


def anchor_factor(kind: str, direction: str) -> AnchorFactor:
    """Return the safety factor on the pull of an anchor.

    Parameters
    ----------
    kind : str
        ``drag_anchor`` or ``gravity_anchor``.
    direction : str
        ``horizontal`` or ``vertical``.

    Raises
    ------
    InputError
        When the table has no such pair.
    """
    rows = read_table(_FACTORS)
    for record in rows:
        if (record["kind"], record["direction"]) == (kind, direction):
            value = float(record["value"])
            return AnchorFactor(kind, direction, value, record["confirmed"] == "yes", record["source"])
    pairs = ", ".join(f"{record['kind']} {record['direction']}" for record in rows)
    raise InputError(f"no factor for '{kind}' {direction}", parameter="anchor", allowed=pairs)
