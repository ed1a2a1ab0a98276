"""Plausible ranges: what a key of a case file, or a ratio between keys, usually is and can be, each with its source."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass
from functools import cache

from moyai.tables.reader import Record, read_notes, read_table

_FILE = "plausible_ranges.csv"
_STEP = re.compile(r"(?P<sign>^| \* | / )(?P<key>[^\s^]+)(?:\^(?P<power>\d+))?")


@dataclass(frozen=True)
class Factor:
    """One key of a quantity."""

    #: Steps of its path; ``*`` stands for one index or name, ``**`` at the front for any way to the key.
    steps: tuple[str, ...]
    #: Its exponent in the quantity.
    power: int
    #: Whether the steps start at the block of the first key.
    relative: bool


@dataclass(frozen=True)
class PlausibleRange:
    """What a quantity usually is and what it can be, as magnitudes."""

    #: Kind of structure, ``*`` for all, ``kind`` for the bounds of a kind of quantity.
    structure: str
    #: As the table writes it.
    quantity: str
    #: The keys that it is made of.
    factors: tuple[Factor, ...]
    #: SI unit of a single key; ratios have none.
    unit: str
    #: Closed range outside of which it is an error.
    possible: tuple[float, float]
    #: Closed range outside of which it is a warning.
    usual: tuple[float, float]
    #: The quantity in words.
    what: str
    #: Letter of the source.
    source: str


@cache
def plausible_ranges(structure: str) -> tuple[PlausibleRange, ...]:
    """Return the ranges for a kind of structure: single keys first, then ratios, each in the table's order."""
    rows = [_range(row) for row in read_table(_FILE) if row["structure"] in ("*", structure)]
    return tuple(sorted(rows, key=lambda row: len(row.factors) > 1))


@cache
def kind_bounds() -> dict[str, tuple[float, float]]:
    """Return smallest and largest magnitude of each kind of quantity, wherever it stands."""
    return {row["quantity"]: _range(row).possible for row in read_table(_FILE) if row["structure"] == "kind"}


def all_ranges() -> tuple[PlausibleRange, ...]:
    """Return every row of the table."""
    return tuple(_range(row) for row in read_table(_FILE))


@cache
def range_sources() -> dict[str, str]:
    """Return the sources by their letter."""
    found = re.findall(r"^([A-Z])  (.+)$", read_notes(_FILE), re.MULTILINE)
    return {letter: text.rstrip(".") for letter, text in found}


def _range(row: Record) -> PlausibleRange:
    def limit(name: str, absent: float) -> float:
        return float(row[name]) if row[name] else absent

    low, high = limit("impossible_below", 0.0), limit("impossible_above", math.inf)
    usual = max(limit("unusual_below", low), low), min(limit("unusual_above", high), high)
    factors = () if row["structure"] == "kind" else _factors(row["quantity"])
    return PlausibleRange(
        row["structure"], row["quantity"], factors, row["unit"], (low, high), usual, row["what"], row["source"]
    )


def _factors(text: str) -> tuple[Factor, ...]:
    factors = []
    for match in _STEP.finditer(text):
        key, power = match["key"], int(match["power"] or 1)
        relative = key.startswith(".")
        steps = tuple(key.removeprefix(".").split("."))
        factors.append(Factor(steps, -power if match["sign"] == " / " else power, relative))
    return tuple(factors)
