"""The ``moyai reproduce`` command: a paper computed again, on one page."""

from __future__ import annotations

import time
from pathlib import Path
from typing import Annotated, Any

import typer

from moyai.cli.console import OK, Spoken, guard, print_json, progress_bars, say


def reproduce(
    paper: Annotated[
        str | None, typer.Argument(metavar="PAPER", help="Paper; without it the papers are listed.", show_default=False)
    ] = None,
    output: Annotated[
        Path | None, typer.Option("--output", "-o", help="Folder of the page; out/<paper> when absent.")
    ] = None,
    quick: Annotated[bool, typer.Option("--quick", help="Fewer waves and coarser variations, under 30 s.")] = False,
    points: Annotated[
        list[str] | None,
        typer.Option("--points", metavar="FIG=FILE", help="Your own points (CSV of x and y) over a figure."),
    ] = None,
    as_json: Annotated[bool, typer.Option("--json", help="Print JSON on standard output, errors included.")] = False,
    quiet: Annotated[bool, typer.Option("--quiet", "-q", help="No progress bars and no summary.")] = False,
) -> None:
    """Compute a published paper again: equations, figures and every statement of its text on one page."""
    with guard(as_json):
        from moyai.core.run_folder import prepare_output
        from moyai.reproduce import as_result, papers
        from moyai.reproduce import paper as described
        from moyai.reproduce import reproduce as run_paper
        from moyai.reproduce.points import read_points

        if paper is None:
            _list(papers(), as_json)
            raise typer.Exit(OK)
        started = time.perf_counter()
        wanted = described(paper)
        for option in points or ():
            read_points(option, wanted.plotted)
        folder = prepare_output(output if output is not None else Path("out") / paper)
        with progress_bars(quiet or as_json) as progress:
            found = run_paper(paper, quick=quick, points=tuple(points or ()), progress=progress)
            progress("page", 0, 1)
            from moyai.report.views import with_views
            from moyai.reproduce.page import agreement_words, write

            result = as_result(found)
            if Spoken.language is not None:
                result = with_views(result).said_in(Spoken.language)
            files = write(found, result, folder)
            progress("page", 1, 1)
        if as_json:
            print_json(
                {
                    "paper": found.paper.key,
                    "statements": [row.as_dict() for row in found.rows],
                    "files": [str(path) for path in files],
                    "seconds": round(time.perf_counter() - started, 3),
                    "faults": [],
                }
            )
        elif not quiet:
            say(f"{found.paper.authors} ({found.paper.year}): {result.message}")
            for row in found.rows:
                if row.finding.verdict != "agrees":
                    say(f"  {row.finding.verdict}: {row.statement.text} {row.finding.found}; {row.finding.why}")
            for line in agreement_words(found):
                say(f"  {line}")
            say(f"  {files[0]} ({time.perf_counter() - started:.0f} s)")
        raise typer.Exit(OK)


def print_statements(paper: str, *, as_json: bool, quiet: bool) -> None:
    """Run a paper quickly and print every statement with its verdict, one row each.

    Parameters
    ----------
    paper : str
        Key of the paper.
    as_json, quiet : bool
        As in the commands.
    """
    from moyai.reproduce import reproduce as run_paper

    with progress_bars(quiet or as_json) as progress:
        found = run_paper(paper, quick=True, progress=progress)
    if as_json:
        print_json({"paper": found.paper.key, "statements": [row.as_dict() for row in found.rows], "faults": []})
        return
    for row in found.rows:
        why = f" [{row.finding.why}]" if row.finding.why else ""
        say(f"{row.finding.verdict:8} {row.statement.place}: {row.statement.text} {row.finding.found}{why}")


def _list(listed: tuple[Any, ...], as_json: bool) -> None:
    if as_json:
        print_json(
            {
                "papers": [
                    {"key": one.key, "authors": one.authors, "year": one.year, "title": one.title, "line": one.line}
                    for one in listed
                ],
                "faults": [],
            }
        )
        return
    width = max(len(one.key) for one in listed)
    for one in listed:
        say(f"{one.key:{width}}  {one.authors} ({one.year}): {one.line}")
    say("next: moyai reproduce " + listed[0].key)
