"""``moyai compare``: a result against a record, or against another result."""

from __future__ import annotations

import math
import time
from pathlib import Path
from typing import Annotated, Any

import typer

from moyai.cli.console import OK, guard, print_json, progress_bars, put, rich_console
from moyai.cli.files import decimal_sign
from moyai.core.errors import InputError


def compare(
    result: Annotated[Path, typer.Argument(metavar="RESULTS", help="results.nc of a run.", show_default=False)],
    record: Annotated[
        Path,
        typer.Argument(
            metavar="RECORD", help="Record with headings (CSV), or results.nc of another run.", show_default=False
        ),
    ],
    pair: Annotated[
        list[str] | None,
        typer.Option("--pair", metavar="VARIABLE=COLUMN", help="Which belongs to which; by equal names when absent."),
    ] = None,
    along: Annotated[
        str, typer.Option("--along", metavar="COLUMN", help="Column of the time or other coordinate.")
    ] = "",
    select: Annotated[
        list[str] | None, typer.Option("--select", metavar="DIMENSION=ENTRY", help="Entry along another dimension.")
    ] = None,
    shift: Annotated[float, typer.Option("--shift", help="Added to the record's coordinate.")] = 0.0,
    lag: Annotated[float, typer.Option("--lag", help="How far the model may be moved to fit best.")] = 0.0,
    by: Annotated[
        str, typer.Option("--by", metavar="COLUMN[=EDGES]", help="Sea state whose classes are reported: H13=0,1,2,3.")
    ] = "",
    decimal: Annotated[str, typer.Option("--decimal", help="Decimal sign of the record.")] = ".",
    output: Annotated[
        Path | None, typer.Option("--output", "-o", help="Folder of the comparison; out/compare_<record> when absent.")
    ] = None,
    as_json: Annotated[bool, typer.Option("--json", help="Print JSON on standard output, errors included.")] = False,
    pdf: Annotated[bool, typer.Option("--pdf", help="Write the report as PDF too.")] = False,
    report: Annotated[
        bool, typer.Option("--report", help="Of two results, write the report of the first with both in its figures.")
    ] = False,
) -> None:
    """Compare a result with a record (overlay, scatter, bias, RMS, skill, by sea state) or with another result."""
    with guard(as_json):
        if record.suffix == ".nc":
            options = {"--pair": pair, "--along": along, "--select": select, "--shift": shift, "--lag": lag, "--by": by}
            _refuse([name for name, value in options.items() if value])
            _two_results(result, record, output, as_json=as_json, pdf=pdf, report=report or pdf)
            raise typer.Exit(OK)
        from moyai.core.results import read_result
        from moyai.core.run_folder import prepare_output
        from moyai.records.comparison.run import compare_result, pairing_of
        from moyai.report.writer import write_report

        started = time.perf_counter()
        held = read_result(result)
        pairs = [pairing_of(entry, held) for entry in pair or ()]
        state, edges = _state(by)
        found = compare_result(
            held,
            record,
            pairs,
            coordinate=along,
            select=dict(_split(entry, "select") for entry in select or ()),
            start=shift,
            largest_lag=lag,
            state=state,
            edges=edges,
            decimal=decimal_sign(decimal),
        )
        folder = prepare_output(output if output is not None else Path("out") / f"compare_{record.stem}")
        files = [found.write(folder / "results.nc")]
        with progress_bars(True):
            files += write_report(found, folder, pdf=pdf)
        seconds = time.perf_counter() - started
        if as_json:
            print_json(_as_record(found, files))
        else:
            from moyai.cli.tables import print_summary

            print_summary(rich_console(), found, files, seconds)
        raise typer.Exit(OK)


def _refuse(options: list[str]) -> None:
    if options:
        raise InputError(
            "these options compare a result with a record",
            path=", ".join(options),
            remedy="leave them out for two results",
        )


def _two_results(here: Path, there: Path, output: Path | None, *, as_json: bool, pdf: bool, report: bool) -> None:
    """Print the table of differences of two results; with ``report`` write the page of the first with both in it."""
    from moyai.core.results import read_result
    from moyai.core.run_folder import prepare_output
    from moyai.report.differences import DIFFERENCES, read_others, with_others
    from moyai.report.document import Table
    from moyai.report.writer import compose_document, write_report

    result = read_result(here)
    document = with_others(compose_document(result), result, read_others([there]))
    files = []
    if report:
        folder = prepare_output(output if output is not None else Path("out") / f"compare_{_name(here)}_{_name(there)}")
        with progress_bars(True):
            files = write_report(result, folder, pdf=pdf, document=document)
    blocks = next(section.blocks for section in document.sections if section.key == DIFFERENCES)
    tables = [block for block in blocks if isinstance(block, Table)]
    if as_json:
        print_json({"tables": [_table_record(table) for table in tables], "files": list(map(str, files)), "faults": []})
        return
    from moyai.cli.tables import print_table

    for table in tables:
        print_table(rich_console(), table)
    for path in files:
        if path.suffix != ".csv":
            put(f"  {path}")


def _name(path: Path) -> str:
    return path.resolve().parent.name if path.stem == "results" else path.stem


def _table_record(table: Any) -> dict[str, Any]:
    rows = zip(*(column.values for column in table.columns), strict=True)
    names = [column.label for column in table.columns]
    return {"title": table.title, "rows": [dict(zip(names, map(_plain, row), strict=True)) for row in rows]}


def _plain(value: Any) -> Any:
    """Return a cell that JSON can hold: a number that is not known becomes nothing."""
    return None if isinstance(value, float) and not math.isfinite(value) else value


def _split(entry: str, option: str) -> tuple[str, str]:
    first, sign, second = entry.partition("=")
    if not sign or not first.strip() or not second.strip():
        raise InputError(f"'{entry}' has no '='", path=f"--{option}", allowed="name=name")
    return first.strip(), second.strip()


def _state(text: str) -> tuple[str, tuple[float, ...]]:
    # Names may hold the sign too: the edges follow the last one
    name, sign, numbers = text.rpartition("=")
    if not sign:
        return numbers.strip(), ()
    try:
        return name.strip(), tuple(float(part) for part in numbers.split(","))
    except ValueError:
        raise InputError(f"'{numbers}' are no numbers", path="--by", allowed="H13=0,1,2,3") from None


def _as_record(result: Any, files: list[Path]) -> dict[str, Any]:
    pairs = []
    for name in result.tree.children:
        group = result.tree[name]
        words = [str(value) for value in group["figure"].values]
        pairs.append(
            {
                "pair": str(group.attrs["label"]),
                "lag": float(group.attrs["lag"]),
                "agreement": dict(zip(words, (float(value) for value in group["agreement"].values), strict=True)),
            }
        )
    return {
        "status": result.status,
        "message": result.message,
        "pairs": pairs,
        "files": [str(path) for path in files],
        "notices": [notice.as_dict() for notice in result.notices],
        "faults": [],
    }
