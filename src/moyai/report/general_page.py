"""Pages that every structure shares, and a plain report of any result: all groups as tables and curves."""

from __future__ import annotations

import math
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from contextvars import ContextVar
from typing import Any

import numpy as np

from moyai.core.results import Result
from moyai.report.decimate import envelope_indices
from moyai.report.document import (
    Abscissa,
    Block,
    Chapter,
    Column,
    Document,
    Figure,
    Listing,
    NoticeBlock,
    Panel,
    Paragraph,
    Series,
    Table,
)
from moyai.report.formatting import display_unit
from moyai.report.html import STATUS_WORDS
from moyai.report.notices import first_page_notices, value_and_limit
from moyai.report.reading import Group, root_of, walk

MOST_CURVES = 12
_ONLY: ContextVar[Collection[str] | None] = ContextVar("sections", default=None)


def compose(result: Result) -> Document:
    """Compose the report of a structure that has no pages of its own.

    Parameters
    ----------
    result : Result

    Returns
    -------
    Document
    """
    root = root_of(result)
    sections = [Chapter("summary", "Summary", (*notice_blocks(result), case_listing(root)))]
    for path, group in [("/", root), *walk(root)]:
        blocks = group_blocks(group, path)
        if blocks:
            sections.append(Chapter(f"group-{path}", path, blocks))
    return page_of(result, str(root.attributes.get("structure", "")), sections)


def page_of(result: Result, subtitle: str, sections: Iterable[Chapter]) -> Document:
    """Return the report of a result: its sections that have blocks, then its checks and provenance.

    Parameters
    ----------
    result : Result
    subtitle : str
        What the structure is, in a line.
    sections : iterable of Section
    """
    return Document(
        title=report_title(result),
        subtitle=subtitle,
        status=result.status,
        message=result.message,
        sections=(*_with_blocks(tuple(sections)), *((closing_section(result),) if _wanted("checks") else ())),
        provenance=provenance(result),
    )


def report_title(result: Result) -> str:
    """Return the title of a result."""
    for source in (result.held.attrs, result.provenance):
        title = str(source.get("title", "")).strip()
        if title:
            return title
    return "Report"


def provenance(result: Result) -> Mapping[str, Any]:
    """Return the provenance with the hash of the case on top of it."""
    entries = dict(result.provenance)
    if "case_hash" not in entries and result.held.attrs.get("case_hash"):
        entries["case_hash"] = result.held.attrs["case_hash"]
    return entries


def notice_blocks(result: Result) -> tuple[Block, ...]:
    """Return what the reader must know first: partial results, failed checks, warnings and errors."""
    blocks: list[Block] = []
    if result.status in {"interrupted", "failed", "not_converged"}:
        blocks.append(
            Paragraph(f"{STATUS_WORDS[result.status]}. Only what was finished is shown; nothing below is filled in.")
        )
    failed = tuple(check for check in result.checks if not check.passed)
    found = first_page_notices(result)
    if failed or found:
        blocks.append(NoticeBlock(found, failed))
    return tuple(blocks)


def case_listing(root: Group) -> Block:
    """Return the text of the case file, folded away."""
    text = str(root.attributes.get("case_text", "")).rstrip()
    if not text:
        return Paragraph("The result does not contain the text of its case file.", quiet=True)
    return Listing("Case file as it was run", text)


def chapters(*parts: tuple[str, str, Callable[[], Iterable[Block]]]) -> tuple[Chapter, ...]:
    """Return the sections of a report that have something to show.

    Parameters
    ----------
    *parts : tuple
        Key, title and what gives the blocks. Under :func:`composing_only` no others are composed than those that it
        names; the first stays, empty.
    """
    return _with_blocks([Chapter(key, title, tuple(blocks()) if _wanted(key) else ()) for key, title, blocks in parts])


def _wanted(key: str) -> bool:
    only = _ONLY.get()
    return only is None or key in only


def _with_blocks(sections: Sequence[Chapter]) -> tuple[Chapter, ...]:
    """Return the sections that hold something, and the first that a draft leaves empty."""
    return tuple(one for one in sections if one.blocks or (one is sections[0] and not _wanted(one.key)))


@contextmanager
def composing_only(keys: Collection[str] | None) -> Iterator[None]:
    """Compose a part of the report in this block of code: these sections; all for None."""
    token = _ONLY.set(keys)
    try:
        yield
    finally:
        _ONLY.reset(token)


def closing_section(result: Result) -> Chapter:
    """Return identity checks, all notices and the provenance."""
    blocks: list[Block] = (
        [checks_table(result)] if result.checks else [Paragraph("No identity check was carried out.", quiet=True)]
    )
    if result.notices:
        blocks.append(notices_table(result))
    blocks.append(provenance_table(result))
    return Chapter("checks", "Checks and provenance", tuple(blocks))


def checks_table(result: Result) -> Table:
    """Return the identity checks of the run, figure against tolerance."""
    checks = result.checks
    violations = ["no figure" if math.isnan(check.value) else f"{check.value:.2e}" for check in checks]
    return Table(
        "identity-checks",
        "Identity checks",
        (
            Column("Identity", [check.name for check in checks]),
            Column("Violation", violations, quantities=True),
            Column("Tolerance", [f"{check.tolerance:.2e}" for check in checks], quantities=True),
            Column("Met", ["yes" if check.passed else "NO" for check in checks]),
            Column("Meaning", [check.meaning for check in checks]),
        ),
        note="Relations that every correct solution satisfies, checked in this run.",
        failed=tuple(row for row, check in enumerate(checks) if not check.passed),
    )


def notices_table(result: Result) -> Table:
    """Return all notices, also those for information."""
    notices = result.notices
    shown = [value_and_limit(notice) for notice in notices]
    return Table(
        "notices",
        "Notices on the range of validity",
        (
            Column("Kind", [notice.severity for notice in notices]),
            Column("Statement", [notice.message for notice in notices]),
            Column("Found", [value for value, _ in shown], uniform=False),
            Column("Limit", [limit for _, limit in shown], uniform=False),
            Column("Remedy", [notice.remedy for notice in notices]),
            Column("Source", [notice.source for notice in notices]),
        ),
    )


def provenance_table(result: Result) -> Table:
    """Return where the result comes from."""
    names: list[str] = []
    values: list[str] = []
    for key, value in provenance(result).items():
        if key in {"case_text", "title"} or value in (None, "", {}):
            continue
        text = ", ".join(f"{k} {v}" for k, v in value.items()) if isinstance(value, Mapping) else str(value)
        names.append(key.replace("_", " "))
        values.append(text)
    names.append("status")
    values.append(f"{STATUS_WORDS.get(result.status, result.status)}{'. ' + result.message if result.message else ''}")
    return Table("provenance", "Provenance", (Column("Entry", names), Column("Value", values)))


def group_blocks(group: Group, path: str) -> tuple[Block, ...]:
    """Return single numbers of a group as a table and one-dimensional variables as curves."""
    if group.node is None:
        return ()
    names, values, units = [], [], []
    curves: dict[str, list[str]] = {}
    for variable in map(str, group.node.data_vars):
        dims = group.dims(variable)
        if group.variable(variable) is None:
            continue
        if not dims:
            shown = display_unit(group.unit(variable), group.value(variable))
            names.append(group.long_name(variable))
            values.append(group.value(variable) * shown.factor)
            units.append(shown.name)
        elif len(dims) == 1 and group.node.sizes[dims[0]] > 1:
            curves.setdefault(dims[0], []).append(variable)
    blocks: list[Block] = []
    if names:
        blocks.append(
            Table(
                f"numbers-{path}",
                "Numbers",
                (Column("Quantity", names), Column("Value", values, uniform=False), Column("Unit", units)),
            )
        )
    for dim, variables in curves.items():
        figure = _curves(group, path, dim, variables)
        if figure is not None:
            blocks.append(figure)
    return tuple(blocks)


def _curves(group: Group, path: str, dim: str, variables: list[str]) -> Figure | None:
    """Return the variables along one dimension as a figure, one panel a unit."""
    assert group.node is not None
    along = group.real(dim, dim)
    if along is None:
        along = np.arange(group.node.sizes[dim], dtype=float)
    panels: list[str] = []
    series = []
    for tone, variable in enumerate(variables[:MOST_CURVES]):
        values = group.real(variable, dim)
        if values is None or not np.isfinite(values).any():
            continue
        unit = group.unit(variable)
        if unit not in panels:
            panels.append(unit)
        keep = envelope_indices(values, 1000)
        series.append(Series(group.long_name(variable), {dim: along[keep]}, values[keep], panels.index(unit), tone))
    if not series:
        return None
    return Figure(
        f"curves-{path}-{dim}",
        f"Along {dim.replace('_', ' ')}",
        (Abscissa(dim, group.long_name(dim, dim), group.unit(dim)),),
        tuple(Panel(unit or "value", unit) for unit in panels),
        tuple(series),
        height=120 + 200 * len(panels),
    )
