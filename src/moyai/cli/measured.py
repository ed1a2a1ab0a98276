"""What the ``moyai measure`` commands share: their options, and how a result is handed back."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Annotated, Any, NoReturn

import typer

from moyai.cli.console import FAILED, OK, print_json, tell

Output = Annotated[
    Path | None, typer.Option("--output", "-o", help="Folder of the results; out/<name of the file> when absent.")
]
AsJson = Annotated[bool, typer.Option("--json", help="Print JSON on standard output, errors included.")]
Report = Annotated[bool, typer.Option(help="Write the report and its tables next to results.nc.")]
Pdf = Annotated[bool, typer.Option("--pdf", help="Write the report as PDF too.")]
TimeUnit = Annotated[
    str, typer.Option("--time-unit", help="Unit of the time where its heading has none: s, ms, min, h, d, excel.")
]
Missing = Annotated[
    list[str] | None, typer.Option("--missing", help="Sign that means 'no value', such as -99; repeat for more.")
]
Quiet = Annotated[bool, typer.Option("--quiet", "-q", help="No progress bars and no summary.")]


def hand_back(
    result: Any,
    folder: Path,
    *,
    record: Callable[[list[Path]], dict[str, Any]],
    summary: Callable[[list[Path]], None],
    report: bool,
    pdf: bool,
    as_json: bool,
    quiet: bool,
) -> NoReturn:
    """Write results and report, print the record or the summary of the files written, and end the command."""
    files = [result.write(folder / "results.nc")]
    if report:
        from moyai.report.writer import write_report

        files += write_report(result, folder, pdf=pdf)
    if as_json:
        print_json(record(files))
    elif not quiet:
        summary(files)
    elif result.status != "converged":
        tell(f"{result.status}: {result.message}")
    raise typer.Exit(OK if result.status == "converged" else FAILED)


def print_summary_of(result: Any, seconds: float, files: list[Path]) -> None:
    """Print the summary that every result has."""
    from moyai.cli.console import rich_console
    from moyai.cli.tables import print_summary

    print_summary(rich_console(), result, files, seconds)
