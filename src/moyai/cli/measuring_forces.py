"""``moyai measure forces``: coefficients of Morison's equation from a record of force and velocity."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from moyai.cli.console import FAILED, OK, guard, print_json, put, rich_console, say
from moyai.cli.measured import say_notices

if TYPE_CHECKING:
    from moyai.records.forces.identification import Identification


def forces(
    record: Annotated[
        Path, typer.Argument(metavar="RECORD", help="CSV with names and units in its header.", show_default=False)
    ],
    config: Annotated[
        Path, typer.Option("--config", "-c", help="What the record was taken on (YAML).", show_default=False)
    ],
    output: Annotated[
        Path | None, typer.Option("--output", "-o", help="Folder; out/<name of the record> when absent.")
    ] = None,
    report: Annotated[bool, typer.Option(help="Write the report and its tables next to results.nc.")] = True,
    as_json: Annotated[bool, typer.Option("--json", help="Print JSON on standard output, errors included.")] = False,
) -> None:
    """Find C_M and C_D from a record of force and velocity, with intervals, and state what cannot be determined."""
    with guard(as_json):
        from moyai.core.run_folder import prepare_output
        from moyai.records.forces.case.build import load_force_record, record_of, setup_of
        from moyai.records.forces.identification import identify
        from moyai.records.forces.result import identification_result

        document, model = load_force_record(config)
        setup = setup_of(model, document)
        found = identify(record_of(record, model), setup)
        folder = prepare_output(output if output is not None else Path("out") / record.stem)
        result = identification_result(found, title=model.title, text=document.text, source=record.name)
        files = [result.write(folder / "results.nc")]
        if report:
            from moyai.report.writer import write_report

            files += write_report(result, folder)
        if as_json:
            print_json(_as_record(found, result, files))
        else:
            _print(found, result, files)
        raise typer.Exit(OK if result.status == "converged" else FAILED)


def _rows(found: Identification) -> list[dict[str, Any]]:
    rows = []
    for fit in found.fits:
        for name, item in (("C_M", fit.inertia), ("C_D", fit.drag)):
            rows.append(
                {
                    "method": fit.method,
                    "component": fit.component + 1,
                    "coefficient": name,
                    # digits that the record does not hold are not printed
                    "value": item.value if item.known else None,
                    "half_width": item.uncertainty,
                    "known": item.known,
                    "text": item.text,
                    "change_per_degree": item.phase_sensitivity * 0.017453292519943295,
                }
            )
    return rows


def _as_record(found: Identification, result: Any, files: list[Path]) -> dict[str, Any]:
    return {
        "status": result.status,
        "message": result.message,
        "period": found.period,
        "blocks": found.blocks,
        "keulegan_carpenter": list(found.keulegan_carpenter),
        "coefficients": _rows(found),
        "notices": [notice.as_dict() for notice in result.notices],
        "files": [str(path) for path in files],
        "faults": [],
    }


def _print(found: Identification, result: Any, files: list[Path]) -> None:
    from rich import box
    from rich.table import Table

    table = Table(box=box.SIMPLE, pad_edge=False)
    for title in ("component", "method", "C_M", "C_D", "explained"):
        table.add_column(title)
    for fit in found.fits:
        table.add_row(
            str(fit.component + 1),
            fit.method.replace("_", " "),
            fit.inertia.text,
            fit.drag.text,
            f"{100.0 * fit.explained:.2f} %",
        )
    console = rich_console()
    numbers = ", ".join(f"{number:.3g}" for number in found.keulegan_carpenter)
    say(f"period {found.period:.5g} s, {found.blocks} blocks, KC {numbers}")
    console.print(table)
    say(f"+- is half of the {100.0 * found.setup.confidence:g} % interval")
    say_notices(result.notices)
    for path in files:
        if path.suffix != ".csv":
            put(f"  {path}")
