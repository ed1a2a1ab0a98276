"""Classes of silt curtains (data/curtain_classes.csv holds the numbers and their sources)."""

from __future__ import annotations

import difflib
import math
from dataclasses import dataclass

from moyai.core.errors import InputError
from moyai.tables.reader import Record, read_table

_FILE = "curtain_classes.csv"


@dataclass(frozen=True)
class CurtainClass:
    """One class; NaN where the source gives no number."""

    #: Letter or numeral.
    name: str
    #: Whose practice.
    practice: str
    #: Largest H_1/3 [m].
    significant_height: float
    #: Largest current [m/s].
    current: float
    #: [m].
    float_diameter: float
    #: Least buoyancy of the floats per length [N/m].
    float_buoyancy: float
    #: Low and high strength of the fabric per width [N/m].
    fabric_strength: tuple[float, float]
    #: Low and high mass of the toe chain per length [kg/m].
    toe_chain: tuple[float, float]
    #: Whether every value was read in the source named; otherwise check before design use.
    confirmed: bool
    #: Where the values come from.
    source: str


def _number(record: Record, key: str) -> float:
    return float(record[key]) if record[key] else math.nan


def _read(record: Record) -> CurtainClass:
    per_metre = 1.0 / 0.03  # strengths are those of strips 3 cm wide
    return CurtainClass(
        name=record["name"],
        practice=record["practice"],
        significant_height=_number(record, "significant_height"),
        current=_number(record, "current"),
        float_diameter=_number(record, "float_diameter"),
        float_buoyancy=_number(record, "float_buoyancy"),
        fabric_strength=(_number(record, "fabric_low") * per_metre, _number(record, "fabric_high") * per_metre),
        toe_chain=(_number(record, "chain_low"), _number(record, "chain_high")),
        confirmed=record["confirmed"] == "true",
        source=record["source"],
    )


def curtain_classes() -> tuple[CurtainClass, ...]:
    """Return all classes."""
    return tuple(_read(record) for record in read_table(_FILE))


def curtain_class(name: str) -> CurtainClass:
    """Return a class by its letter (A to D) or numeral (I to III).

    Raises
    ------
    InputError
        For an unknown name.
    """
    for record in read_table(_FILE):
        if record["name"] == name:
            return _read(record)
    names = [record["name"] for record in read_table(_FILE)]
    near = difflib.get_close_matches(name.upper(), names, 1, 0.3)
    raise InputError(
        f"unknown curtain class {name!r}",
        parameter="curtain_class",
        allowed=", ".join(names),
        remedy=f"did you mean {near[0]!r}?" if near else "",
    )


def mildest_class(significant_height: float, current: float, practice: str = "Japan") -> CurtainClass | None:
    """Return the lightest class that allows a significant height [m] and a current [m/s]; None when none does.

    A class whose source gives no wave height is judged by its current alone.
    """
    fit = [
        entry
        for entry in curtain_classes()
        if entry.practice == practice and current <= entry.current and not significant_height > entry.significant_height
    ]
    return min(fit, key=lambda entry: entry.current, default=None)
