"""``moyai measure streaks``: pictures of particle streaks to the circulation around a section."""

from __future__ import annotations

import time
from pathlib import Path
from typing import Annotated, Any

import typer

from moyai.cli.console import FAILED, OK, guard, print_json, progress_bars, rich_console, tell


def streaks(
    file: Annotated[
        Path, typer.Argument(metavar="FILE", help="File that describes the pictures (YAML).", show_default=False)
    ],
    output: Annotated[
        Path | None, typer.Option("--output", "-o", help="Folder of the results; out/<name of the file> when absent.")
    ] = None,
    as_json: Annotated[bool, typer.Option("--json", help="Print JSON on standard output, faults included.")] = False,
    report: Annotated[bool, typer.Option(help="Write the report and its tables next to results.nc.")] = True,
    pdf: Annotated[bool, typer.Option("--pdf", help="Write the report as PDF too.")] = False,
    quiet: Annotated[bool, typer.Option("--quiet", "-q", help="No progress bars and no summary.")] = False,
) -> None:
    """Measure the circulation around a section in waves from pictures of particle streaks.

    Every recording that is done is kept in the folder of the results, so that an interrupted batch goes on.
    """
    with guard(as_json):
        from moyai.cli.runner import prepare_output
        from moyai.core.store import DatasetStore
        from moyai.records.streaks.campaign import measure_campaign
        from moyai.records.streaks.case.build import load_streaks

        started = time.perf_counter()
        campaign, document = load_streaks(file)
        folder = prepare_output(output if output is not None else Path("out") / file.stem)
        with progress_bars(quiet or as_json) as progress:
            result = measure_campaign(
                campaign,
                store=DatasetStore(folder / "recordings"),
                attributes={"case_text": document.text},
                progress=progress,
            )
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

    runs = result.tree.children["runs"].children if "runs" in result.tree.children else {}
    law = result.tree.children["law"].attrs if "law" in result.tree.children else {}
    return {
        "status": result.status,
        "message": result.message,
        "title": result.tree.attrs["title"],
        "runs": [
            {
                "name": name,
                "keulegan_carpenter": float(node.attrs["keulegan_carpenter"]),
                "particles": int(node.sizes["particle"]),
                "circulation": float(node.attrs["limit"]),
                "interval": [float(side) for side in node.attrs["limit_interval"]],
                "circulation_linear": float(node.attrs["linear"]),
            }
            for name, node in runs.items()
        ],
        "law_coefficient": float(law["coefficient"]) if law else None,
        "files": [str(path) for path in files],
        "seconds": round(seconds, 3),
        "key_figures": figure_records(key_figures(result)),
        "notices": [notice.as_dict() for notice in result.notices],
        "checks": [check.as_dict() for check in result.checks],
        "faults": [],
    }
