"""``moyai measure records``: records of loggers to statistics, quality and a report."""

from __future__ import annotations

import time
from pathlib import Path
from typing import Annotated, Any

import typer

from moyai.cli.console import guard, progress_bars
from moyai.cli.measured import AsJson, Output, Pdf, Quiet, Report, hand_back, print_summary_of


def records(
    file: Annotated[
        Path, typer.Argument(metavar="FILE", help="File that describes the records (YAML).", show_default=False)
    ],
    output: Output = None,
    as_json: AsJson = False,
    report: Report = True,
    pdf: Pdf = False,
    quiet: Quiet = False,
) -> None:
    """Read records, control their quality, and work out waves, spectra, currents, tensions and reflection."""
    with guard(as_json):
        from moyai.core.run_folder import prepare_output
        from moyai.records.survey.case.build import load_survey
        from moyai.records.survey.run import run_survey

        started = time.perf_counter()
        survey = load_survey(file)
        folder = prepare_output(output if output is not None else Path("out") / file.stem)
        with progress_bars(quiet) as progress:
            result = run_survey(survey, progress)
        hand_back(
            result,
            folder,
            record=lambda files: _record(result, files, time.perf_counter() - started),
            summary=lambda files: print_summary_of(result, time.perf_counter() - started, files),
            report=report,
            pdf=pdf,
            as_json=as_json,
            quiet=quiet,
        )


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
