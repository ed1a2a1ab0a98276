"""What the ``moyai measure`` commands share: their options, and how a result is handed back."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, NoReturn

import typer

from moyai.cli.console import FAILED, OK, print_json, say, tell

if TYPE_CHECKING:
    from moyai.core.validity import Notice
    from moyai.records.reading.record import Record
    from moyai.records.reading.sources import LoggerSource

Output = Annotated[
    Path | None, typer.Option("--output", "-o", help="Folder of the results; out/<name of the file> when absent.")
]
AsJson = Annotated[bool, typer.Option("--json", help="Print JSON on standard output, errors included.")]
Report = Annotated[bool, typer.Option(help="Write the report and its tables next to results.nc.")]
Pdf = Annotated[bool, typer.Option("--pdf", help="Write the report as PDF too.")]
TimeUnit = Annotated[
    str, typer.Option("--time-unit", help="Unit of the time where its heading has none: s, ms, min, h, d, excel.")
]
Missing = Annotated[
    list[str] | None, typer.Option("--missing", help="Sign that means 'no value', such as -99; repeat for more.")
]
Quiet = Annotated[bool, typer.Option("--quiet", "-q", help="No progress bars and no summary.")]


#: What a remedy says of the keys of a file of records, and what the commands of one record have in their place
_IN_OPTIONS = (
    ("'decimal: ", "add --decimal , where a comma is the decimal sign"),
    ("under 'missing'", "name signs that mean 'no value' by --missing, and look at --decimal"),
    ("'time.format'", "write the time in numbers; dates such as 2024-05-01 06:10 need --dates, which 'tide' has"),
    ("%Y/%m/%d", "write dates such as 2024-05-01 06:10"),
    ("'order: drop'", "sort or cut the file"),
    ("give 'unit'", "add --unit, or write the unit into the heading"),
    ("give the unit of the time", "add --time-unit, or correct the heading"),
    ("leave the unit of the time out", "leave --time-unit out, or correct the heading if it is wrong"),
    ("leave 'unit' out", "leave --unit out, or correct the heading if it is wrong"),
    ("give 'encoding'", "save the file as UTF-8"),
)


def sound_record(source: LoggerSource) -> Record:
    """Read a record of one file whole, with notices of samples that are doubtful.

    Raises
    ------
    InputError
        Where a number seems to mean 'no value': one of them makes every result wrong.
    """
    from moyai.core.errors import InputError
    from moyai.records.reading.doubts import STAND_IN, doubtful_samples
    from moyai.records.reading.reader import read_record, row_of_sample

    try:
        record = read_record(source)
    except InputError as error:
        remedy = next((ours for words, ours in _IN_OPTIONS if words in error.fault.remedy), error.fault.remedy)
        raise InputError.of(replace(error.fault, remedy=remedy)) from None
    for notice in record.notices:
        if notice.code == STAND_IN:
            remedy = f"add --missing {notice.value:g}, or take it out of the file"
            raise InputError(notice.message, path="--missing", remedy=remedy)
    doubts = doubtful_samples(record, lambda row: row_of_sample(source.files[0], source, row))
    return replace(record, notices=(*record.notices, *doubts))


def say_notices(notices: Iterable[Notice]) -> None:
    """Print notices with what can be done about them."""
    for notice in notices:
        say(f"{notice.severity}: {notice.message}" + (f"; {notice.remedy}" if notice.remedy else ""))


def hand_back(
    result: Any,
    folder: Path,
    *,
    record: Callable[[list[Path]], dict[str, Any]],
    summary: Callable[[list[Path]], None],
    report: bool,
    pdf: bool,
    as_json: bool,
    quiet: bool,
) -> NoReturn:
    """Write results and report, print the record or the summary of the files written, and end the command."""
    files = [result.write(folder / "results.nc")]
    if report:
        from moyai.report.writer import write_report

        files += write_report(result, folder, pdf=pdf)
    if as_json:
        print_json(record(files))
    elif not quiet:
        summary(files)
    elif result.status != "converged":
        tell(f"{result.status}: {result.message}")
    raise typer.Exit(OK if result.status == "converged" else FAILED)


def print_summary_of(result: Any, seconds: float, files: list[Path]) -> None:
    """Print the summary that every result has."""
    from moyai.cli.console import rich_console
    from moyai.cli.tables import print_summary

    print_summary(rich_console(), result, files, seconds)
