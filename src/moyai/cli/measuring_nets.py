"""``moyai measure nets``: towed nets and nets in waves to coefficients and laws of their drag."""

from __future__ import annotations

import math
import time
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from moyai.cli.console import guard, progress_bars, put, rich_console, say
from moyai.cli.measured import AsJson, Output, Pdf, Quiet, Report, hand_back, say_notices

if TYPE_CHECKING:
    from moyai.records.nets.campaign import NetFindings


def nets(
    file: Annotated[
        Path, typer.Argument(metavar="FILE", help="File that describes the runs (YAML).", show_default=False)
    ],
    output: Output = None,
    as_json: AsJson = False,
    report: Report = True,
    pdf: Pdf = False,
    quiet: Quiet = False,
) -> None:
    """Find C_D, C_M and lift of nets from towing and waves, their laws A Re^-B, and tensions of model cages."""
    with guard(as_json):
        from dataclasses import replace

        from moyai.core.run_folder import prepare_output
        from moyai.records.nets.campaign import measure_nets
        from moyai.records.nets.case.build import load_nets
        from moyai.records.nets.result import nets_result

        started = time.perf_counter()
        campaign, document, reported = load_nets(file)
        folder = prepare_output(output if output is not None else Path("out") / file.stem)
        with progress_bars(quiet or as_json) as progress:
            found = measure_nets(campaign, progress)
        found = replace(found, notices=(*reported, *found.notices))
        result = nets_result(found, text=document.text)
        hand_back(
            result,
            folder,
            record=lambda files: _record(found, result, files, time.perf_counter() - started),
            summary=lambda files: _print(found, result, files),
            report=report,
            pdf=pdf,
            as_json=as_json,
            quiet=quiet,
        )


def _known(value: float, known: bool = True) -> float | None:
    return value if known and math.isfinite(value) else None


def _record(found: NetFindings, result: Any, files: list[Path], seconds: float) -> dict[str, Any]:
    from moyai.cli.tables import figure_records, key_figures

    line = found.vibration
    law = found.joint
    return {
        "status": result.status,
        "message": result.message,
        "title": found.campaign.title,
        "vibration": None if line is None else {"frequency": line.frequency, "low": line.low, "high": line.high},
        "towing": [
            {
                "run": item.run,
                "net": item.net,
                "speed": item.speed,
                "reynolds": item.reynolds,
                "drag": item.drag,
                "drag_half_width": item.drag_half_width,
                "lift": _known(item.lift),
            }
            for item in found.towing
        ],
        "waves": [
            {
                "run": item.run,
                "net": item.net,
                "kind": item.kind,
                "reynolds": item.reynolds,
                "keulegan_carpenter": item.keulegan_carpenter,
                # a coefficient that the record does not hold is not printed
                "drag": _known(item.drag, item.drag_known),
                "drag_half_width": item.drag_half_width,
                "inertia": _known(item.inertia, item.inertia_known),
                "inertia_half_width": item.inertia_half_width,
                "lift": _known(item.lift_amplitude),
            }
            for item in found.waves
        ],
        "laws": [
            {
                "net": item.net,
                "factor": item.factor,
                "factor_interval": list(item.factor_interval),
                "exponent": item.exponent,
                "exponent_interval": list(item.exponent_interval),
                "law": item.text,
            }
            for item in found.laws
        ],
        "joint_law": None
        if law is None
        else {
            "coefficients": [float(value) for value in law.coefficients],
            "left_out_error": _known(law.left_out_error),
            "pooled_error": _known(law.pooled_error),
        },
        "tensions": [
            {"run": run, "line": end.line, "end": end.end, "mean": end.mean, "least": end.least, "peak": end.peak,
             "first_harmonic": end.first, "slack": end.slack}
            for run, ends in found.tensions
            for end in ends
        ],
        "files": [str(path) for path in files],
        "seconds": round(seconds, 3),
        "key_figures": figure_records(key_figures(result)),
        "notices": [notice.as_dict() for notice in result.notices],
        "checks": [check.as_dict() for check in result.checks],
        "faults": [],
    }  # fmt: skip


def _print(found: NetFindings, result: Any, files: list[Path]) -> None:
    from rich import box
    from rich.table import Table

    console = rich_console()

    def show(columns: tuple[str, ...], rows: list[tuple[str, ...]]) -> None:
        if not rows:
            return
        table = Table(box=box.SIMPLE, pad_edge=False)
        for column in columns:
            table.add_column(column)
        for row in rows:
            table.add_row(*row)
        console.print(table)

    if found.vibration is not None:
        line = found.vibration
        say(f"vibration at {line.frequency:.3g} Hz, taken out from {line.low:.3g} to {line.high:.3g} Hz")
    show(
        ("run", "net", "U [m/s]", "Re", "C_D", "C_L"),
        [
            (
                item.run,
                item.net,
                f"{item.speed:.3f}",
                f"{item.reynolds:.0f}",
                f"{item.drag:.3f} +- {item.drag_half_width:.3f}",
                "-" if math.isnan(item.lift) else f"{item.lift:.3f}",
            )
            for item in found.towing
        ],
    )
    show(
        ("run", "net", "KC", "Re", "C_D", "C_M"),
        [
            (
                item.run,
                item.net,
                f"{item.keulegan_carpenter:.0f}",
                f"{item.reynolds:.0f}",
                f"{item.drag:.3f} +- {item.drag_half_width:.3f}" if item.drag_known else "not determined",
                f"{item.inertia:.2f} +- {item.inertia_half_width:.2f}" if item.inertia_known else "not determined",
            )
            for item in found.waves
        ],
    )
    show(
        ("net", "A", "B", "runs", "as a law of a case"),
        [(item.net, f"{item.factor:.3g}", f"{item.exponent:.3f}", str(item.count), item.text) for item in found.laws],
    )
    show(
        ("run", "line", "end", "mean [N]", "least", "peak", "first harmonic"),
        [
            (run, end.line, end.end, f"{end.mean:.3g}", f"{end.least:.3g}", f"{end.peak:.3g}", f"{end.first:.3g}")
            for run, ends in found.tensions
            for end in ends
        ],
    )
    if found.towing or found.waves:
        say(f"+- is half of the {100.0 * found.campaign.confidence:g} % interval")
    say_notices(result.notices)
    for path in files:
        if path.suffix != ".csv":
            put(f"  {path}")
