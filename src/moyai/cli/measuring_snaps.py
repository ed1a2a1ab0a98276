"""``moyai measure snaps``: release records of a curtain to impact tensions and their similarity numbers."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from moyai.cli.console import guard, progress_bars, put, rich_console, say
from moyai.cli.measured import AsJson, Output, Pdf, Quiet, Report, hand_back

if TYPE_CHECKING:
    from moyai.records.snaps.model import SnapFindings


def snaps(
    file: Annotated[
        Path, typer.Argument(metavar="FILE", help="File that describes the runs (YAML).", show_default=False)
    ],
    output: Output = None,
    as_json: AsJson = False,
    report: Report = True,
    pdf: Pdf = False,
    quiet: Quiet = False,
) -> None:
    """Find impact tensions of released curtains, C_T over Fr, B/l, d/h and C_E, and the models over them."""
    with guard(as_json):
        from moyai.core.run_folder import prepare_output
        from moyai.records.snaps.case.build import load_snaps
        from moyai.records.snaps.result import snap_runs_result
        from moyai.records.snaps.run import measure_snaps

        runs, document = load_snaps(file)
        folder = prepare_output(output if output is not None else Path("out") / file.stem)
        with progress_bars(quiet or as_json) as progress:
            found = measure_snaps(runs, progress)
        result = snap_runs_result(found, text=document.text)
        hand_back(
            result,
            folder,
            record=lambda files: _record(found, result, files),
            summary=lambda files: _print(found, result, files),
            report=report,
            pdf=pdf,
            as_json=as_json,
            quiet=quiet,
        )


def _record(found: SnapFindings, result: Any, files: list[Path]) -> dict[str, Any]:
    from dataclasses import asdict

    from moyai.cli.tables import figure_records, key_figures

    return {
        "status": result.status,
        "message": result.message,
        "origin": found.runs.origin,
        "runs": [
            {
                "run": item.run.name,
                "peak": item.run.record.total.peak,
                "plateau": item.run.record.total.plateau,
                "impact": item.run.record.total.impact,
                "cables": {cable.name: cable.impact for cable in item.run.record.cables},
                **asdict(item.numbers),
                "span_ratio": item.run.impact.span_ratio,
                "depth_ratio": item.run.impact.draught / item.run.impact.water.depth,
                "models": {line.model: line.tension for line in item.comparison.models},
            }
            for item in found.found
        ],
        "key_figures": figure_records(key_figures(result)),
        "agreement": [asdict(row) for row in found.agreements],
        "powers": [
            {key: value if value == value else None for key, value in zip(row.names, row.values)} | {"of": row.of}
            for row in found.exponents
        ],
        "files": [str(path) for path in files],
        "notices": [notice.as_dict() for notice in result.notices],
        "faults": [],
    }


def _print(found: SnapFindings, result: Any, files: list[Path]) -> None:
    from rich import box
    from rich.table import Table

    console = rich_console()
    table = Table(box=box.SIMPLE, pad_edge=False)
    for column in ("run", "impact [N]", "upper", "lower", "C_T", "Fr", "B/l", "d/h", "C_E"):
        table.add_column(column, no_wrap=True)
    for item in found.found:
        record, impact, numbers = item.run.record, item.run.impact, item.numbers
        parts = {cable.name: f"{cable.impact:.3g}" for cable in record.cables}
        table.add_row(
            item.run.name, f"{record.total.impact:.3g}", parts.get("upper", "-"), parts.get("lower", "-"),
            f"{numbers.tension_coefficient:.3g}", f"{numbers.froude_number:.3f}", f"{impact.span_ratio:.3f}",
            f"{impact.draught / impact.water.depth:.3f}", f"{numbers.cauchy_number:.3g}",
        )  # fmt: skip
    console.print(table)
    for row in found.agreements:
        say(f"model {row.model}: {row.ratio:.3f} of the records ({row.low:.3f} to {row.high:.3f}), "
            f"scatter {100.0 * row.scatter:.2g} %")  # fmt: skip
    for fit in found.exponents[:2]:
        powers = ", ".join(
            f"{name} {value:.2f} ({low:.2f} to {high:.2f})"
            for name, value, low, high in zip(fit.names, fit.values, fit.low, fit.high)
        )
        say(f"powers of C_T, {fit.of if fit.of == 'record' else f'model {fit.of}'}: {powers}")
    if found.runs.origin == "generated":
        say("the records were computed, not measured")
    for notice in result.notices:
        say(f"{notice.severity}: {notice.message}" + (f"; {notice.remedy}" if notice.remedy else ""))
    for path in files:
        if path.suffix != ".csv":
            put(f"  {path}")
