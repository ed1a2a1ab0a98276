"""The page of a paper: statements first, then equations, figures, the inputs that were filled in and the case files."""

from __future__ import annotations

import math
from pathlib import Path

from moyai.core.files import write_whole
from moyai.core.results import Result
from moyai.language import spoken_in
from moyai.report.document import (
    Badge,
    Block,
    Chapter,
    Column,
    Document,
    Figure,
    KeyFigure,
    KeyFigures,
    Listing,
    Paragraph,
    Table,
)
from moyai.report.encoding import figure_csv, slug, table_csv
from moyai.report.language import in_the_language
from moyai.reproduce.inputs import case_files
from moyai.reproduce.reproduction import Reproduction, StatementRow

LOOPS = "the points are laid over; a path has no value at a place to hold them against"


def compose(found: Reproduction, result: Result) -> Document:
    """Compose the page of a paper.

    Parameters
    ----------
    found : Reproduction
        From :func:`reproduce`.
    result : Result
        The same as numbers, for its provenance.

    Returns
    -------
    Document
        Summary, statements, figures, equations, what the paper leaves out, and the case files.

    Examples
    --------
    >>> from moyai.reproduce import Reproduction, as_result, compose, paper
    >>> from moyai.reproduce.model import Finding
    >>> from moyai.reproduce.reproduction import StatementRow
    >>> tabata = paper("tabata")
    >>> row = StatementRow(tabata.statements[0], Finding("as the paper says", "agrees"))
    >>> found = Reproduction(tabata, True, (row,), (), ())
    >>> [section.key for section in compose(found, as_result(found)).sections][:3]
    ['summary', 'statements', 'figures']
    """
    paper = found.paper
    sections = (
        Chapter("summary", "Summary", _summary(found)),
        Chapter("statements", "Statements", (_statements(found.rows),)),
        Chapter("figures", "Figures", _figures(found)),
        Chapter("equations", "Equations", (_equations(found),)),
        Chapter("filled", "What the paper leaves out", (_filled(found),)),
        Chapter("inputs", "Case files", _inputs(paper.key)),
    )
    agree, differ, open_ = (found.count(verdict) for verdict in ("agrees", "differs", "open"))
    badge = Badge(
        "Statements",
        f"{agree} agree, {differ} differ, {open_} open",
        f"{len(found.rows)} statements of the text, each judged from this run",
        "caution" if differ else "good",
    )
    return Document(
        title=paper.title,
        subtitle=f"{paper.authors} ({paper.year}), {paper.journal}",
        status=result.status,
        message=result.message,
        sections=sections,
        provenance=result.provenance,
        badges=(badge,),
    )


def _summary(found: Reproduction) -> tuple[Block, ...]:
    paper = found.paper
    drawn = sum(one.drawn is not None for one in found.figures)
    items = (
        KeyFigure("Statements that agree", f"{found.count('agrees')} of all {len(found.rows)}"),
        KeyFigure("Statements that differ", str(found.count("differs")), "each with its reason in the table"),
        KeyFigure("Statements left open", str(found.count("open")), "measured points that only figures show"),
        KeyFigure("Figures drawn again", f"{drawn} of all {len(found.figures)}"),
        KeyFigure("Equations in the code", str(len(paper.equations))),
    )
    mode = "Quick run: fewer waves, coarser variations. " if found.quick else ""
    return (
        Paragraph(paper.line[:1].upper() + paper.line[1:] + "."),
        KeyFigures(items),
        Paragraph(
            f"{mode}Every number on this page was computed by this run from the case files below. The paper's text is "
            "given in words of our own.",
            quiet=True,
        ),
    )


def _statements(rows: tuple[StatementRow, ...]) -> Table:
    verdicts = [
        row.finding.verdict + (f": {row.finding.why}" if row.finding.verdict != "agrees" and row.finding.why else "")
        for row in rows
    ]
    return Table(
        "statements",
        "What the paper says and what we find",
        (
            Column("Place", [row.statement.place for row in rows]),
            Column("Statement", [row.statement.text for row in rows]),
            Column("What we find", [row.finding.found for row in rows]),
            Column("Verdict", verdicts),
        ),
        failed=tuple(index for index, row in enumerate(rows) if row.finding.verdict == "differs"),
        emphasised=tuple(index for index, row in enumerate(rows) if row.finding.verdict == "open"),
        note="Red: differs. Bold: open.",
    )


def _equations(found: Reproduction) -> Table:
    equations = found.paper.equations
    return Table(
        "equations",
        "Numbered equations",
        (
            Column("Number", [f"({one.number})" for one in equations]),
            Column("Gives", [one.subject for one in equations]),
            Column("In the code", [", ".join(one.places) for one in equations]),
            Column("Note on the print", [one.note or "sound" for one in equations]),
        ),
    )


def _figures(found: Reproduction) -> tuple[Block, ...]:
    blocks: list[Block] = []
    for one in found.figures:
        if one.drawn is None:
            continue
        blocks.append(one.drawn)
        if one.note:
            blocks.append(Paragraph(f"Figure {one.number}: {one.note}.", quiet=True))
        blocks += [_agreement(found, number) for number, (points, _) in enumerate(found.laid)
                   if points.figure == one.number]  # fmt: skip
    left = [one for one in found.figures if one.drawn is None]
    if left:
        columns = (Column("Figure", [one.number for one in left]), Column("Why", [one.note for one in left]))
        blocks.append(Table("figures-not-drawn", "Figures that are not drawn again", columns))
    return tuple(blocks)


def _agreement(found: Reproduction, number: int) -> Block:
    points, rows = found.laid[number]
    if not rows:
        return Paragraph(f"Figure {points.figure}, {points.source}: {LOOPS}.", quiet=True)
    return Table(
        f"points-{points.figure}-{number + 1}",
        f"Figure {points.figure}: curves against {points.source}",
        (
            Column("Curve", [row.curve for row in rows]),
            Column("Points", [row.count for row in rows]),
            Column("Bias, curve less point", [row.bias for row in rows], uniform=False),
            Column("Scatter", [row.scatter for row in rows], uniform=False),
            Column("Relative difference", [row.relative for row in rows], uniform=False),
        ),
        note="In units of the axis; scatter is the standard deviation of curve less point, relative difference the "
        "root mean square over that of the points.",
    )


def _filled(found: Reproduction) -> Table:
    rows = found.filled
    return Table(
        "filled-in",
        "Inputs that were filled in, and how far the answer moves",
        (
            Column("Input", [row.name for row in rows]),
            Column("Taken", [row.value for row in rows]),
            Column("Varied to", [row.varied for row in rows]),
            Column("Effect", [row.effect for row in rows]),
        ),
    )


def _inputs(key: str) -> tuple[Block, ...]:
    return tuple(Listing(path.name, path.read_text(encoding="utf-8").rstrip()) for path in case_files(key))


def write(found: Reproduction, result: Result, folder: Path) -> list[Path]:
    """Write page, data and case files of a paper.

    Parameters
    ----------
    found : Reproduction
    result : Result
    folder : Path

    Returns
    -------
    list of Path
        The page, results.nc, then tables and figures as CSV, then the case files.
    """
    from moyai.report.html import render_html
    from moyai.report.writer import compose_document

    document = compose_document(result)
    written = [write_whole(folder / "report.html", render_html(document).encode("utf-8"))]
    written.append(result.write(folder / "results.nc"))
    with spoken_in(document.language):
        tables = in_the_language(document).tables()
    for table in tables:
        content = table_csv(table).encode("utf-8-sig")
        written.append(write_whole(folder / "tables" / f"{slug(table.key)}.csv", content))
    for one in found.figures:
        if isinstance(one.drawn, Figure):
            content = figure_csv(one.drawn).encode("utf-8-sig")
            written.append(write_whole(folder / "figures" / f"figure_{one.number}.csv", content))
    for path in case_files(found.paper.key):
        written.append(write_whole(folder / "cases" / path.name, path.read_bytes()))
    return written


def agreement_words(found: Reproduction) -> list[str]:
    """Return bias and scatter of the points that were laid over figures, a line each."""
    return [
        f"figure {points.figure}, {points.source}, {row.curve}: {row.count} points, bias {row.bias:.4g}, "
        f"scatter {'not known' if math.isnan(row.scatter) else format(row.scatter, '.4g')}"
        for points, rows in found.laid
        for row in rows
    ] + [f"figure {points.figure}, {points.source}: {LOOPS}" for points, rows in found.laid if not rows]
