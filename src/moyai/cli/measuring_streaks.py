"""``moyai measure streaks``: pictures of particle streaks to the circulation around a section."""

from __future__ import annotations

import time
from pathlib import Path
from typing import Annotated, Any

import typer

from moyai.cli.console import guard, progress_bars
from moyai.cli.measured import AsJson, Output, Pdf, Quiet, Report, hand_back, print_summary_of


def streaks(
    file: Annotated[
        Path, typer.Argument(metavar="FILE", help="File that describes the pictures (YAML).", show_default=False)
    ],
    output: Output = None,
    as_json: AsJson = False,
    report: Report = True,
    pdf: Pdf = False,
    quiet: Quiet = False,
) -> None:
    """Measure the circulation around a section in waves from pictures of particle streaks.

    Every recording that is done is kept in the folder of the results, so that an interrupted batch continues.
    """
    with guard(as_json):
        from moyai.core.run_folder import prepare_output
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
