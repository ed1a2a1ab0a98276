"""What the commands print for people: derived numbers, the summary of a run, validation."""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, get_args

from moyai.cli.console import put, say
from moyai.core.validation import ReferenceKind
from moyai.language import said

if TYPE_CHECKING:
    from rich.console import Console
    from rich.table import Table

    from moyai.case.derived import Number
    from moyai.core.headline import Criterion
    from moyai.core.results import Result
    from moyai.report.document import Document
    from moyai.report.document import Table as ReportTable
    from moyai.validation import Outcome


def _table(*columns: tuple[str, str]) -> Table:
    from rich import box
    from rich.table import Table

    table = Table(box=box.SIMPLE, pad_edge=False)
    for title, justify in columns:
        table.add_column(said(title), justify=justify, overflow="fold")  # type: ignore[arg-type]
    return table


def print_derived(console: Console, title: str, numbers: Sequence[Number]) -> None:
    """Print the numbers that follow from a case, by group."""
    console.print(title, style="bold", markup=False)
    for group in dict.fromkeys(number.group for number in numbers):
        members = [number for number in numbers if number.group == group]
        levels = tuple(dict.fromkeys(number.column for number in members))
        table = _table((group, "left"), *((level, "right") for level in levels), ("", "left"))
        for label, unit in dict.fromkeys((number.label, number.unit) for number in members):
            row = [number for number in members if (number.label, number.unit) == (label, unit)]
            texts, shown = _in_system(row)
            table.add_row(said(label), *(texts.get(level, "") for level in levels), shown)
        console.print(table)


def _in_system(row: Sequence[Number]) -> tuple[dict[str, str], str]:
    """Return the texts of one number at each water level and their unit, in the system of units that is shown."""
    from moyai.report.systems import in_tonnes_force

    stored = re.sub(r"\b[kMG](?=(N|Pa)\b)", "", row[0].unit)
    largest = max((abs(number.value) for number in row if math.isfinite(number.value)), default=0.0)
    found = in_tonnes_force(stored, largest)
    if found is None:
        return {number.column: number.text for number in row}, row[0].unit
    unit, factor = found
    return {item.column: replace(item, value=item.value * factor, unit="").text for item in row}, unit


def print_table(console: Console, table: ReportTable) -> None:
    """Print a table of a report with its title."""
    from moyai.report.formatting import format_number

    console.print(said(table.title), style="bold", markup=False)
    shown = _table(
        *(
            (column.label, "left" if any(isinstance(v, str) for v in column.values) else "right")
            for column in table.columns
        )
    )
    for number in range(table.row_count):
        cells = [(column.values[number], column.digits) for column in table.columns]
        shown.add_row(
            *(
                format_number(float(v), digits) if isinstance(v, int | float) else said(str(v or ""))
                for v, digits in cells
            )
        )
    console.print(shown)


def key_figures(result: Result, document: Document | None = None) -> list[Any]:
    """Return the governing numbers as the report's first page shows them, from its document where there is one."""
    from moyai.report.document import KeyFigures
    from moyai.report.writer import compose_document

    try:
        document = document or compose_document(result)
    except Exception:
        # An interrupted result may hold too little for a summary; its files are written all the same
        if result.status != "interrupted":
            raise
        return []
    blocks = [block for section in document.sections for block in section.blocks]
    return [item for block in blocks if isinstance(block, KeyFigures) for item in block.items]


def figure_records(figures: Sequence[Any]) -> list[dict[str, str]]:
    """Return key figures as they stand in JSON."""
    return [{"label": item.label, "text": item.text, "detail": item.detail} for item in figures]


def print_summary(
    console: Console, result: Result, files: Sequence[Path], seconds: float, document: Document | None = None
) -> None:
    """Print what a run gave: numbers, criteria, what limits them (each kind once), both badges, files."""
    from moyai.report.first_page import badges, units_of
    from moyai.report.notices import first_page_notices, grouped
    from moyai.report.systems import UNITS_NOTES, displayed_in, words_in_system

    figures = key_figures(result, document)
    if figures:
        table = _table(("", "left"), ("", "right"), ("", "left"))
        for item in figures:
            table.add_row(said(item.label), said(item.text), said(item.detail))
        console.print(table)
    print_judgements(console, result)
    with displayed_in(units_of(result)):
        notices = [(group, words_in_system(group.notice.message)) for group in grouped(first_page_notices(result))]
    for group, message in notices:
        where = f" ({group.where})" if group.where else ""
        console.print(said(f"{group.severity}: {message}{where}"), markup=False, soft_wrap=True)
    failed = [check for check in result.checks if not check.passed]
    for check in failed:
        text = f"failed check: {check.name}: {check.value:.2e} > {check.tolerance:.2e}"
        console.print(said(text), markup=False)
    if result.checks:
        console.print(said(f"{len(result.checks) - len(failed)} of {len(result.checks)} identity checks passed"))
    if units := UNITS_NOTES.get(units_of(result)):
        console.print(said(units), markup=False, soft_wrap=True)
    with displayed_in(units_of(result)):
        shown_badges = badges(result)
    for badge in shown_badges:
        line = f"{badge.label}: {badge.word.lower()}" + (f": {badge.message}" if badge.message else "")
        console.print(said(line), markup=False, soft_wrap=True)
    console.print(f"{seconds:.1f} s", markup=False)
    shown = [path for path in files if path.suffix not in (".csv", ".vtp")]
    tables = sum(path.suffix == ".csv" and path.parent == files[-1].parent for path in files)
    for path in shown:
        console.print(f"  {path}", markup=False, soft_wrap=True)
    if tables:
        console.print(f"  {files[-1].parent} ({said(f'{tables} tables')})", markup=False, soft_wrap=True)


def print_judgements(console: Console, result: Result) -> None:
    """Print the criteria of a result with their outcome, the failing ones first."""
    from moyai.report.first_page import criteria_table, units_of, without_limit
    from moyai.report.systems import displayed_in

    with displayed_in(units_of(result)):
        found = criteria_table(result)
    if found is None:
        return
    shown = ("Criterion", "Limit", "Found", "Outcome", "Where", "Source")
    table = _table(*((name, "right" if name == "Found" else "left") for name in shown))
    columns = {column.label: column.values for column in found.columns}
    for row in zip(*(columns[name] for name in shown), strict=True):
        table.add_row(*(said(str(cell)) for cell in row))
    console.print(table)
    if missing := without_limit(result):
        console.print(said(missing), markup=False, soft_wrap=True)


def print_criteria(console: Console, criteria: Sequence[Criterion]) -> None:
    """Print what a design will be judged by, before it is run."""
    from moyai.core.headline import Judgement
    from moyai.report.first_page import limit_and_found, sentence

    if not criteria:
        console.print(said("No criteria: the design will not be judged."), markup=False)
        return
    table = _table(("Criteria", "left"), ("Limit", "left"), ("Source", "left"))
    for criterion in criteria:
        limit, _ = limit_and_found(Judgement(criterion, math.nan, "not judged"))
        table.add_row(*map(said, (sentence(criterion.words), limit, criterion.source)))
    console.print(table)


def outcome_line(outcome: Outcome) -> str:
    """Return a case of ``moyai validate`` as one line: verdict, numbers, kind of the reference and its source.

    In the language in force; ``moyai validate --json`` has the names as the pages look for them.
    """
    case = outcome.case
    numbers = said(
        f"{_number(outcome.value)} against {_number(case.reference)}, error "
        f"{_error(outcome.error, case.relative)} of {_error(case.tolerance, case.relative)} allowed"
    )
    failure = f" ({said(outcome.failure)})" if outcome.failure else ""
    verdict = said("ok" if outcome.passed else "FAILED")
    return f"{verdict:6}  {said(case.name)}: {numbers}{failure}  |  {said(case.kind)}  |  {said(case.source)}"


def print_outcome_count(outcomes: Sequence[Outcome]) -> None:
    """Print how many cases passed, in all and by the kind of their reference."""
    good = sum(outcome.passed for outcome in outcomes)
    say(f"{good} of {len(outcomes)} cases passed")
    for kind in get_args(ReferenceKind):
        own = [outcome.passed for outcome in outcomes if outcome.case.kind == kind]
        if own:
            put("  " + said(kind) + ": " + said(f"passed: {sum(own)} of {len(own)}"))


def _number(value: float) -> str:
    return "-" if math.isnan(value) else f"{value:.6g}"


def _error(value: float, relative: bool) -> str:
    if not math.isfinite(value):
        return "-"
    return f"{100.0 * value:.2g} %" if relative else f"{value:.2g}"
