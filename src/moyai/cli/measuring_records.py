"""``moyai measure records``: records of loggers to statistics, quality and a report."""

from __future__ import annotations

import time
from pathlib import Path
from typing import Annotated, Any

import typer

from moyai.cli.console import FAILED, OK, guard, print_json, progress_bars, rich_console, tell


def records(
    file: Annotated[
        Path, typer.Argument(metavar="FILE", help="File that describes the records (YAML).", show_default=False)
    ],
    output: Annotated[
        Path | None, typer.Option("--output", "-o", help="Folder of the results; out/<name of the file> when absent.")
    ] = None,
    as_json: Annotated[bool, typer.Option("--json", help="Print JSON on standard output, faults included.")] = False,
    report: Annotated[bool, typer.Option(help="Write the report and its tables next to results.nc.")] = True,
    pdf: Annotated[bool, typer.Option("--pdf", help="Write the report as PDF too.")] = False,
    quiet: Annotated[bool, typer.Option("--quiet", "-q", help="No progress bars and no summary.")] = False,
) -> None:
    """Read records, control their quality, and work out waves, spectra, currents, tensions and reflection."""
    with guard(as_json):
        from moyai.cli.runner import prepare_output
        from moyai.records.survey.case.build import load_survey
        from moyai.records.survey.run import run_survey

        started = time.perf_counter()
        survey = load_survey(file)
        folder = prepare_output(output if output is not None else Path("out") / file.stem)
        with progress_bars(quiet) as progress:
            result = run_survey(survey, progress)
        files = [result.write(folder / "results.nc")]
        if report:
            from moyai.report.writer import write_report

            files += write_report(result, folder, pdf=pdf)
        seconds = time.perf_counter() - started
        if as_json:
            print_json(_record(result, files, seconds))
        elif not quiet:
            from moyai.cli.tables import print_summary

            print_summary(rich_console(), result, files, seconds)
        elif result.status != "converged":
            tell(f"{result.status}: {result.message}")
        raise typer.Exit(OK if result.status == "converged" else FAILED)


def _record(result: Any, files: list[Path], seconds: float) -> dict[str, Any]:
    from moyai.cli.tables import figure_records, key_figures

    return {
        "status": result.status,
        "message": result.message,
        "title": result.tree.attrs["title"],
        "files": [str(path) for path in files],
        "seconds": round(seconds, 3),
        "key_figures": figure_records(key_figures(result)),
        "notices": [notice.as_dict() for notice in result.notices],
        "faults": [],
    }
