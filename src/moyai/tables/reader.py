"""Reader of the data files of this package: CSV with its sources as comments on top, numbers as numbers."""

from __future__ import annotations

import csv
from functools import cache
from importlib import resources

Record = dict[str, str]


@cache
def read_table(name: str) -> tuple[Record, ...]:
    """Return the rows of ``data/<name>`` as records of text; lines that start with ``#`` are sources and notes."""
    text = resources.files("moyai.tables").joinpath("data", name).read_text(encoding="utf-8")
    rows = [line for line in text.splitlines() if line.strip() and not line.startswith("#")]
    return tuple(csv.DictReader(rows))


@cache
def read_notes(name: str) -> str:
    """Return the comment lines on top of ``data/<name>``: meaning of the columns and sources."""
    text = resources.files("moyai.tables").joinpath("data", name).read_text(encoding="utf-8")
    return "\n".join(line.lstrip("# ").rstrip() for line in text.splitlines() if line.startswith("#"))
