"""Compares a report in tonnes-force with that in SI."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator

import pytest

from moyai.core.results import Result
from moyai.core.units import parse_unit
from moyai.report.document import Document, Figure, KeyFigures, Table
from moyai.report.encoding import column_unit
from moyai.report.html import column_texts
from moyai.report.systems import displayed_in
from moyai.report.writer import compose_document

GRAVITY = 9.80665
FORCE = re.compile(r"\b[kMG]?(N|Pa)(?![A-Za-z])")


def numbers(document: Document) -> Iterator[tuple[str, list[str], list[float], str]]:
    """Yield the columns of all tables: name, numbers as shown, numbers in full, unit shown."""
    with displayed_in(document.units):
        for table in document.tables():
            for number, column in enumerate(table.columns):
                unit = column_unit(column)
                values = [
                    float(value) if isinstance(value, int | float) and not isinstance(value, bool) else math.nan
                    for value in column.values
                ]
                yield f"{table.key}/{number}", column_texts(column), [v * unit.factor for v in values], unit.name


def assert_same_numbers(result: Result) -> int:
    """Compare every number of all tables, in full and as shown; return how many were forces by their head."""
    forces = 0
    plain, heavy = (list(numbers(compose_document(result, units))) for units in ("SI", "tf"))
    assert len(plain) == len(heavy)
    for (name, _, si, unit), (other, texts, found, shown) in zip(plain, heavy, strict=True):
        assert name == other
        ratio = float(parse_unit(shown).factor / parse_unit(unit).factor) if unit != shown else 1.0
        for text, one, two in zip(texts, si, found, strict=True):
            if not math.isfinite(one):
                continue
            assert two * ratio == pytest.approx(one, rel=1e-12, abs=0.0) or is_force_of_a_row(one, two), name
            forces += unit != shown
            written = text.replace("\N{MINUS SIGN}", "-")
            if re.fullmatch(r"-?\d+(\.\d+)?", written):
                half = 0.5000001 * 10.0 ** -len(written.partition(".")[2])
                assert float(written) == pytest.approx(two, rel=0.0, abs=half), name
    return forces


def is_force_of_a_row(one: float, two: float) -> bool:
    """Whether both are the same force, of a table that has its unit in the row: N, kN, MN against kgf, tf."""
    return any(two * GRAVITY * 10.0**power == pytest.approx(one, rel=1e-12) for power in (-6, -3, 0, 3, 6))


def left_in_si(document: Document) -> list[str]:
    """Return units of SI forces in heads of tables, governing numbers and axes."""
    found = []
    with displayed_in(document.units):
        for block in document.blocks():
            if isinstance(block, Table):
                found += [f"{block.key}: {c.label} {column_unit(c).name}" for c in block.columns]
            elif isinstance(block, KeyFigures):
                found += [f"{item.label}: {item.text}" for item in block.items]
            elif isinstance(block, Figure):
                found += [f"{block.key}: {axis.unit}" for axis in (*block.abscissae, *block.panels)]
    return [text for text in found if FORCE.search(text.split(": ", 1)[1])]
