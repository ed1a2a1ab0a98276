"""The ``moyai query`` command: questions to the results of a study."""

from __future__ import annotations

import csv
import io
import math
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from moyai.cli.console import OK, guard, print_json, rich_console, say
from moyai.core.errors import InputError
from moyai.core.files import write_whole
from moyai.core.wording import counted

if TYPE_CHECKING:
    from moyai.study.query import StudyTable

_MOST_ROWS = 40


def query(
    results: Annotated[
        Path, typer.Argument(metavar="RESULTS", help="Folder of a study's results, study.nc or study.zarr.")
    ],
    where: Annotated[
        list[str] | None,
        typer.Option("--where", "-w", help="Condition, such as 'significant_height > 0.6 m'; all given ones hold."),
    ] = None,
    by: Annotated[
        str | None, typer.Option("--by", help="Response that the cases are sorted by, largest first.")
    ] = None,
    top: Annotated[int | None, typer.Option("--top", "-n", help="Show so many cases at most.")] = None,
    smallest: Annotated[bool, typer.Option("--smallest", help="The smallest first.")] = False,
    show: Annotated[
        list[str] | None, typer.Option("--show", "-s", help="Response or axis to show; may be repeated.")
    ] = None,
    pivot: Annotated[
        str | None, typer.Option("--pivot", metavar="ROWS,COLUMNS", help="Worst value of --by over two axes.")
    ] = None,
    output: Annotated[Path | None, typer.Option("--csv", help="Write the table to this file.")] = None,
    as_json: Annotated[bool, typer.Option("--json", help="Print JSON on standard output.")] = False,
) -> None:
    """Query the results of a study: cases, the worst of them, tables over two axes; alone: what can be queried."""
    with guard(as_json):
        from moyai.study.query import read_study_results

        if top is not None and top < 1:
            raise InputError(f"the top {top} of the cases", path="--top", allowed="1 or more")
        table = read_study_results(results)
        if not any((where, by, top, show, pivot, output, smallest)):
            _overview(table, as_json)
            raise typer.Exit(OK)
        index = table.chosen(where or [], by, top, smallest)
        if pivot is not None:
            header, rows = _pivoted(table, pivot, by, index, smallest)
        else:
            header, rows = _listed(table, index, by, show or [])
        if output is not None:
            _write(output, header, rows)
        if as_json:
            print_json({"columns": header, "rows": rows, "cases": len(index), "of": table.count})
        else:
            _print(
                _short(header), rows, None if output is not None or top is not None or pivot is not None else _MOST_ROWS
            )
            say(
                f"{len(index)} of {counted(table.count, 'case')}"
                + (f"; written to {output}" if output is not None else "")
            )
        raise typer.Exit(OK)


def _listed(table: StudyTable, index: Any, by: str | None, show: list[str]) -> tuple[list[str], list[list[Any]]]:
    names = [*([by] if by is not None else []), *show] or table.varying()
    columns = [table.column(name) for name in ("case", *table.names, "status", *names)]
    columns = list({column.name: column for column in columns}.values())
    if any(table.message[at] and table.status[at] != "converged" for at in index):
        columns.append(table.column("message"))
    header = [_heading(column.name, column.unit, column.name in table.names) for column in columns]
    rows = []
    for at in index:
        row: list[Any] = []
        for column in columns:
            axis = column.values is None or column.name in table.names
            row.append(column.texts[at] if axis else float(column.values[at]))  # type: ignore[index]
        row[0] = int(at)
        rows.append(row)
    return header, rows


def _heading(name: str, unit: str, axis: bool) -> str:
    return name if axis or unit in ("1", "") else f"{name} [{unit}]"


def _short(header: list[str]) -> list[str]:
    """Return the ends of the names of responses, where they tell them apart."""
    ends = []
    for name in header:
        # Labels in brackets may hold slashes of their own
        word, bracket, labels = name.partition("[")
        ends.append(name if ":" in name else word.rpartition("/")[2] + bracket + labels)
    return [end if ends.count(end) == 1 else name for end, name in zip(ends, header)]


def _pivoted(
    table: StudyTable, pivot: str, by: str | None, index: Any, smallest: bool
) -> tuple[list[str], list[list[Any]]]:
    names = [part.strip() for part in pivot.split(",")]
    if len(names) != 2:
        raise InputError(f"'{pivot}' names {len(names)} axes", path="--pivot", allowed="ROWS,COLUMNS")
    response = by or next(iter(table.varying()), None)
    if response is None:
        raise InputError("there is no response to show", path="--by")
    values = table.pivot(names[0], names[1], response, index, smallest)
    axes = {axis["name"]: axis["labels"] for axis in table.axes}
    column = table.column(response)
    header = [f"{_heading(column.name, column.unit, False)}: {names[0]} \\ {names[1]}", *map(str, axes[names[1]])]
    rows = [[str(label), *map(float, row)] for label, row in zip(axes[names[0]], values)]
    return header, rows


def _overview(table: StudyTable, as_json: bool) -> None:
    import numpy as np

    counts = {status: table.status.count(status) for status in dict.fromkeys(table.status)}
    reported = []
    for name, variable in table.responses().items():
        values = table.column(name).values
        known = values[np.isfinite(values)] if values is not None else np.empty(0)
        ends = (float(known.min()), float(known.max())) if known.size else (math.nan, math.nan)
        labels = [str(dim) for dim in variable.dims if str(dim) not in table.names]
        reported.append((name, str(variable.attrs.get("units", "1")), *ends, ", ".join(labels)))
    if as_json:
        keys = ("name", "unit", "smallest", "largest", "labels")
        print_json(
            {
                "title": table.title,
                "cases": table.count,
                "status": counts,
                "axes": [{"name": axis["name"], "labels": axis["labels"]} for axis in table.axes],
                "responses": [dict(zip(keys, one)) for one in reported],
            }
        )
        return
    stand = ", ".join(f"{number} {word}" for word, number in counts.items())
    say(f"{table.title}: {counted(table.count, 'case')} ({stand})")
    for axis in table.axes:
        labels = [str(label) for label in axis["labels"]]
        text = ", ".join(labels) if len(labels) <= 8 else f"{', '.join(labels[:3])}, ... {labels[-1]}"
        say(f"  {axis['name']} ({len(labels)}): {text}")
    rows = [[name, _number(low), _number(high), "" if unit == "1" else unit, labels]
            for name, unit, low, high, labels in reported]  # fmt: skip
    _print(["response", "smallest", "largest", "unit", "by label"], rows, None)
    first = table.varying(1)
    say(f"for instance: moyai query RESULTS --by '{first[0] if first else 'RESPONSE'}' --top 5")


def _number(value: Any) -> str:
    if isinstance(value, float):
        return f"{value:.5g}" if math.isfinite(value) else "-"
    return str(value)


def _print(header: list[str], rows: list[list[Any]], most: int | None) -> None:
    from rich.markup import escape
    from rich.table import Table

    grid = Table(box=None, pad_edge=False)
    for number, name in enumerate(header):
        right = all(isinstance(row[number], (int, float)) for row in rows[:50]) and bool(rows)
        # Words of a response are not broken: they are copied into the next question
        grid.add_column(escape(name), justify="right" if right else "left", overflow="fold", no_wrap=name == "response")
    for row in rows[:most]:
        grid.add_row(*(escape(_number(value)) for value in row))
    rich_console().print(grid)
    if most is not None and len(rows) > most:
        say(f"... {len(rows) - most} more; --top, --csv or --json")


def _write(path: Path, header: list[str], rows: list[list[Any]]) -> None:
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\r\n")
    writer.writerow(header)
    for row in rows:
        writer.writerow(["" if isinstance(value, float) and not math.isfinite(value) else value for value in row])
    write_whole(path, text.getvalue().encode("utf-8-sig"), named="--csv")


__all__ = ["query"]
