"""The ``moyai fit`` command: values of a case found from observations."""

from __future__ import annotations

import math
import time
from pathlib import Path
from typing import Annotated

import typer

from moyai.cli.console import FAILED, OK, guard, print_json, progress_bars, put, say


def fit(
    file: Annotated[Path, typer.Argument(metavar="FILE", help="Fit file (YAML).", show_default=False)],
    output: Annotated[
        Path | None, typer.Option("--output", "-o", help="Folder of the results; out/<name of the file> when absent.")
    ] = None,
    as_json: Annotated[bool, typer.Option("--json", help="Print JSON on standard output, errors included.")] = False,
    quiet: Annotated[bool, typer.Option("--quiet", "-q", help="No progress bars and no summary.")] = False,
) -> None:
    """Fit values of a case to observations through the model; writes the case that was found."""
    with guard(as_json):
        from moyai.cli.files import write_text
        from moyai.cli.runner import run as run_case
        from moyai.core.run_folder import prepare_output
        from moyai.study.fitting import fitted_text, load_fit, run_fit

        started = time.perf_counter()
        plan = load_fit(file)
        folder = prepare_output(output if output is not None else Path("out") / file.stem)
        with progress_bars(quiet or as_json) as progress:
            result, found = run_fit(plan, run_case, progress)
        case_file = folder / f"{plan.base_path.stem}_fitted.yaml"
        files = [result.write(folder / "fit.nc")]
        write_text(case_file, fitted_text(plan, found), replace=True)
        files.append(case_file)
        from moyai.report.writer import write_report

        files += write_report(result, folder)
        entries = [
            {
                "path": item.name,
                "value": float(value),
                "standard_error": float(error),
                "lower": float(low),
                "upper": float(high),
                "unit": unit,
            }
            for (item, unit), value, error, (low, high) in zip(
                plan.parameters, found.values, found.errors, found.interval
            )
        ]
        if as_json:
            print_json(
                {
                    "status": result.status,
                    "message": result.message,
                    "parameters": entries,
                    "bias": found.bias,
                    "rms": found.rms,
                    "notices": [notice.as_dict() for notice in result.notices],
                    "files": [str(path) for path in files],
                    "faults": [],
                }
            )
        elif not quiet:
            say(f"{plan.title}: {result.message}, {time.perf_counter() - started:.1f} s")
            for entry, error in zip(entries, found.errors):
                unit = f" {entry['unit']}" if entry["unit"] else ""
                if math.isnan(error):
                    say(f"  {entry['path']} = {entry['value']:.6g}{unit}, error not known")
                    continue
                say(
                    f"  {entry['path']} = {entry['value']:.6g}{unit} +- {entry['standard_error']:.2g} "
                    f"(standard error; 95 %: {entry['lower']:.6g} to {entry['upper']:.6g})"
                )
            say(f"  prediction less observation: mean {found.bias:.4g}, root mean square {found.rms:.4g}")
            for notice in result.notices:
                say(f"  {notice.severity}: {notice.message}" + (f"; {notice.remedy}" if notice.remedy else ""))
            for path in files:
                put(f"  {path}")
        raise typer.Exit(OK if result.status == "converged" else FAILED)
