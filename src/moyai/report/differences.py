"""How two results differ: value here, there, difference, per cent, of the first page and of the figures' series."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from moyai.core.arrays import Array
from moyai.core.errors import InputError
from moyai.core.headline import Headline
from moyai.core.results import Result, read_result
from moyai.report.document import Block, Cell, Chapter, Column, Document, Paragraph, Table
from moyai.report.encoding import slug
from moyai.report.formatting import display_unit
from moyai.report.overlay import Pair, figures_of, lay_over

_ROUNDING = 1e-9
DIFFERENCES = "differences"
"""Key of the section of the report."""


@dataclass(frozen=True)
class Other:
    """Another result that a report is compared with."""

    #: As legends and tables call it.
    name: str
    result: Result
    #: Its report, composed.
    document: Document


def read_others(paths: Sequence[Path]) -> tuple[Other, ...]:
    """Read other results and compose their reports, each under a name of its own.

    Parameters
    ----------
    paths : sequence of Path
        Files ``results.nc``; one of that name is called after its folder.

    Raises
    ------
    InputError
        When a file is absent or was not written by moyai.
    """
    from moyai.report.writer import compose_document

    found: list[Other] = []
    for path in paths:
        plain = path.resolve().parent.name if path.stem == "results" else path.stem
        count = sum(other.name.split(" #")[0] == plain for other in found)
        result = read_result(path)
        found.append(Other(f"{plain} #{count + 1}" if count else plain, result, compose_document(result)))
    return tuple(found)


def with_pinned(document: Document, result: Result, others: Sequence[Other]) -> Document:
    """Return a report with other results faint in its figures and the differences of the first page from each.

    Parameters
    ----------
    document : Document
        Report of ``result``, composed, or sections of it.
    result : Result
    others : sequence of Other
        One that has nothing in common with this one is left out.
    """
    for number, other in enumerate(others):
        document, _ = lay_over(document, other.document, other.name, number, faint=True)
    tables = [table for other in others if (table := headline_table(result, other)) is not None]
    return _with_differences(document, tables)


def _with_differences(document: Document, blocks: Sequence[Block]) -> Document:
    """Return a report with a section of differences behind its first."""
    if not blocks or not document.sections:
        return document
    first, *rest = document.sections
    return replace(document, sections=(first, Chapter(DIFFERENCES, "Differences", tuple(blocks)), *rest))


def with_others(document: Document, result: Result, others: Sequence[Other]) -> Document:
    """Return a report with other results in its figures and tables of the differences behind its first section.

    Parameters
    ----------
    document : Document
        Report of ``result``, composed.
    result : Result
    others : sequence of Other

    Raises
    ------
    InputError
        When a result has neither a figure nor a number of the first page in common with this one.
    """
    blocks: list[Block] = []
    known = figures_of(document)
    for number, other in enumerate(others):
        document, pairs = lay_over(document, other.document, other.name, number)
        numbers = headline_table(result, other)
        common = [key for key in figures_of(other.document) if key in known]
        if not common and numbers is None:
            raise InputError(
                f"{other.name} ({_kind(other.result)}) has nothing in common with this result ({_kind(result)})",
                path="--overlay",
                allowed=f"figures here: {', '.join(known) or 'none'}; there: "
                f"{', '.join(figures_of(other.document)) or 'none'}",
            )
        if numbers is not None:
            blocks.append(numbers)
        if pairs:
            blocks.append(series_table(pairs, other.name))
        blocks.append(_paragraph(other.name, len(common), len(known), len(pairs)))
    return _with_differences(document, blocks)


def _paragraph(name: str, common: int, count: int, pairs: int) -> Paragraph:
    return Paragraph(
        f"{name}: laid over {common} of {count} figures; {pairs} series have a partner of the same name.", quiet=True
    )


def _kind(result: Result) -> str:
    return str(result.held.attrs.get("structure", "of no known kind"))


def headline_table(result: Result, other: Other) -> Table | None:
    """Return the numbers of the first page of both results; ``None`` where they share none.

    Numbers are the same by name, unit and sea state. They are found where each is governing, so the places stand with
    them.
    """
    there = {(item.name, item.unit, item.sea): item for item in reversed(other.result.headlines)}
    rows: list[tuple[Cell, ...]] = []
    seen: set[tuple[str, str, str]] = set()
    for item in result.headlines:
        mark = (item.name, item.unit, item.sea)
        if mark not in there or mark in seen or not (math.isfinite(item.value) or math.isfinite(there[mark].value)):
            continue
        seen.add(mark)
        rows.append(_headline_row(item, there[mark]))
    if not rows:
        return None
    words, units, here, values, difference, percent, place, place_there = zip(*rows, strict=True)
    return Table(
        slug("differences", other.name),
        f"First page: here and {other.name}",
        (
            Column("Quantity", words),
            Column("Unit", units),
            *_numbers(here, values, difference, percent, other.name),
            Column("Place here", place),
            Column(f"Place in {other.name}", place_there),
        ),
        note="Difference: here less the other; per cent of the other.",
    )


def _headline_row(here: Headline, there: Headline) -> tuple[Cell, ...]:
    unit = display_unit(here.unit, [here.value, there.value])
    label = f"{here.label} in {here.sea}" if here.sea and not here.shown else here.label
    a, b = here.value * unit.factor, there.value * unit.factor
    return (label, unit.pretty, a, b, _less(a, b), _percent(a, b), here.where, there.where)


def series_table(pairs: Sequence[Pair], name: str) -> Table:
    """Return the largest magnitudes of the series that both results have, and the scatter between their curves."""
    rows: list[tuple[float, ...]] = []
    for pair in pairs:
        own, other = _largest(pair.here), _largest(pair.there)
        rows.append((own, other, _less(own, other), _percent(own, other), _scatter(pair)))
    here, values, difference, percent, scatter = zip(*rows, strict=True)
    return Table(
        slug("series-differences", name),
        f"Figures: here and {name}",
        (
            Column("Figure", [pair.figure for pair in pairs]),
            Column("Series", [pair.label for pair in pairs]),
            Column("Unit", [pair.unit for pair in pairs]),
            *_numbers(here, values, difference, percent, name),
            Column("Between the curves, r.m.s.", scatter, uniform=False),
        ),
        note="Value of the largest magnitude of each series; root mean square over the abscissae that both cover.",
    )


def _numbers(
    here: Sequence[Cell], there: Sequence[Cell], difference: Sequence[Cell], percent: Sequence[Cell], name: str
) -> tuple[Column, ...]:
    return (
        Column("Here", here, digits=4, uniform=False),
        Column(name, there, digits=4, uniform=False),
        Column("Difference", difference, uniform=False),
        Column("Per cent", percent, uniform=False),
    )


def _less(here: float, there: float) -> float:
    """Return here less there; nothing where they differ by rounding alone."""
    return 0.0 if abs(here - there) <= _ROUNDING * max(abs(here), abs(there)) else here - there


def _percent(here: float, there: float) -> float:
    return 100.0 * _less(here, there) / abs(there) if there else math.nan


def _largest(values: Array) -> float:
    known = values[np.isfinite(values)]
    return float(known[np.argmax(np.abs(known))]) if known.size else math.nan


def _scatter(pair: Pair) -> float:
    """Return the root mean square of here less there, NaN where the other is no function of the abscissa."""
    known = np.isfinite(pair.x_there) & np.isfinite(pair.there)
    x, y = pair.x_there[known], pair.there[known]
    own = np.isfinite(pair.x) & np.isfinite(pair.here)
    if x.size < 2 or not np.all(np.diff(x) > 0.0):
        return math.nan
    inside = own & (pair.x >= x[0]) & (pair.x <= x[-1])
    if not inside.any():
        return math.nan
    return float(np.sqrt(np.mean((pair.here[inside] - np.interp(pair.x[inside], x, y)) ** 2)))
