"""The ``moyai`` command. Thin: it reads arguments, calls one function, prints.

Imports of the numerical packages stand inside the commands, so that ``moyai --help`` answers at once.
"""

from __future__ import annotations

import gc
import os
import re
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import asdict, replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from moyai.cli.app import app as app_command
from moyai.cli.compare import compare
from moyai.cli.compiling import compile_command
from moyai.cli.console import (
    BAD_INPUT,
    FAILED,
    NOT_HELD,
    OK,
    Debug,
    Spoken,
    complain,
    fault_records,
    guard,
    prepare_streams,
    print_json,
    progress_bars,
    put,
    rich_console,
    say,
    stop,
    tell,
)
from moyai.cli.convert import Depth, Duration, Motion, case_of_deck, convert
from moyai.cli.fit import fit
from moyai.cli.help_pages import SpokenGroup
from moyai.cli.measuring import measure
from moyai.cli.query import query
from moyai.cli.report import Language, ReportCommand, Units
from moyai.cli.report import report as report_command
from moyai.cli.reproduce import reproduce
from moyai.cli.scale import scale
from moyai.cli.study import study
from moyai.core.errors import Fault
from moyai.core.interrupts import held_back, ignore, listen
from moyai.core.version import VERSION
from moyai.core.wording import counted
from moyai.language import said, speak
from moyai.language.comments import with_comments

if TYPE_CHECKING:
    from moyai.core.results import Result
    from moyai.report.document import Document

# Small matrices by the thousand: threads of the linear algebra cost more than they give. Numpy, imported inside the
# commands, reads these at its import; whoever sets them keeps his own.
for _threads in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ.setdefault(_threads, "1")


app = typer.Typer(
    name="moyai",
    cls=SpokenGroup,
    no_args_is_help=True,
    add_completion=False,
    pretty_exceptions_enable=False,
    rich_markup_mode=None,
    help="How moored floating and flexible coastal structures respond to waves and currents.",
)
app.command("app")(app_command)
app.command()(study)
app.command()(query)
app.command()(fit)
app.add_typer(measure)
app.command()(compare)
app.command("report", cls=ReportCommand)(report_command)
app.command()(convert)
app.command()(scale)
app.command()(reproduce)
app.command("compile")(compile_command)

CaseFile = Annotated[Path, typer.Argument(metavar="FILE", help="Case file (YAML).", show_default=False)]
AsJson = Annotated[bool, typer.Option("--json", help="Print JSON on standard output, errors included.")]
Quiet = Annotated[bool, typer.Option("--quiet", "-q", help="No progress bars and no summary.")]


def _version(wanted: bool) -> None:
    if wanted:
        say(f"moyai {VERSION}")
        raise typer.Exit(OK)


@app.callback()
def _options(
    version: Annotated[
        bool, typer.Option("--version", callback=_version, is_eager=True, help="Print the version.")
    ] = False,
    debug: Annotated[bool, typer.Option("--debug", help="Show the traceback of an internal error.")] = False,
    language: Annotated[
        str | None,
        typer.Option("--language", metavar="en|ja", help="Language of reports and messages, of any command."),
    ] = None,
) -> None:
    Debug.on = Debug.on or debug
    Spoken.language = language


@app.command()
def new(
    kind: Annotated[
        str | None, typer.Argument(metavar="KIND", help="Kind of file; left out, all are listed.", show_default=False)
    ] = None,
    output: Annotated[
        Path | None, typer.Option("--output", "-o", help="File to write; standard output when absent.")
    ] = None,
    force: Annotated[bool, typer.Option("--force", help="Replace a file that exists.")] = False,
    language: Language = None,
    as_json: AsJson = False,
) -> None:
    """Print a commented file to start from.

    Kinds: breakwater, units, curtain, cage, rigid_cage, network, member; records, nets, streaks, forces, snaps;
    study, fit.
    """
    with guard(as_json, language):
        from moyai.case.templates import kinds_of_files, next_command, template

        if kind is None:
            known = kinds_of_files()
            if as_json:
                print_json({"kinds": [{"kind": name, "file": words} for name, words in known]})
            else:
                for name, words in known:
                    put(f"  {name:<12} {said(words)}")
                say("for instance: moyai new breakwater -o breakwater.yaml")
            return
        text = with_comments(template(kind))
        if output is not None:
            _write_text(output, text, force)
        if as_json:
            print_json({"kind": kind, "file": None if output is None else str(output), "text": text})
        elif output is None:
            put(text.rstrip("\n"))
        else:
            tell(f"wrote {output}; next: {next_command(kind, output)}")


@app.command()
def check(file: CaseFile, units: Units = None, language: Language = None, as_json: AsJson = False) -> None:
    """Report all errors of a case file at once, and the numbers that follow from it."""
    with guard(as_json, language):
        from moyai.case.criteria import criteria_of
        from moyai.case.reader import derived_numbers, load_case

        case = load_case(file)
        _speak_as(case, language)
        numbers = derived_numbers(case)
        criteria = criteria_of(case.model)
        if as_json:
            record = {
                "valid": True,
                "file": str(file),
                "title": case.title,
                "structure": case.kind,
                "case_hash": case.case_hash,
                "faults": [],
                "warnings": fault_records(case.warnings),
                "derived": [number.as_dict() for number in numbers],
                "criteria": [asdict(criterion) for criterion in criteria],
            }
            print_json(record)
            return
        from moyai.cli.tables import print_criteria, print_derived
        from moyai.report.systems import displayed_in, words_in_system

        with displayed_in(units or str(getattr(getattr(case.model, "display", None), "units", "SI"))):
            for warning in case.warnings:
                complain(replace(warning, message=words_in_system(warning.message)), "warning")
            print_derived(rich_console(), case.title, numbers)
            print_criteria(rich_console(), criteria)
        count = len(case.warnings)
        say(f"{file}: no errors" + (f", {counted(count, 'warning')}" if count else ""))


@app.command()
def schema(
    kind: Annotated[
        str | None,
        typer.Argument(metavar="KIND", help="Kind of file; left out, the cases of all structures.", show_default=False),
    ] = None,
    output: Annotated[
        Path | None, typer.Option("--output", "-o", help="File to write; standard output when absent.")
    ] = None,
    as_json: AsJson = False,
) -> None:
    """Print the JSON Schema of case files, for completion and checks in an editor.

    Kinds of other files: records, nets, streaks, forces, snaps; study, fit.
    """
    with guard(as_json):
        import json

        from moyai.case.schema import file_json_schema, json_schema

        text = json.dumps(json_schema() if kind is None else file_json_schema(kind), indent=2)
        if output is None:
            put(text)
        else:
            _write_text(output, text + "\n", force=True)
            tell(f"wrote {output}")


@app.command()
def run(
    file: CaseFile,
    output: Annotated[
        Path | None, typer.Option("--output", "-o", help="Folder of the results; out/<name of the file> when absent.")
    ] = None,
    as_json: AsJson = False,
    report: Annotated[bool, typer.Option(help="Write the report and its tables next to results.nc.")] = True,
    pdf: Annotated[bool, typer.Option("--pdf", help="Write the report as PDF too.")] = False,
    require_hold: Annotated[
        bool, typer.Option("--require-hold", help="Leave with exit code 3 unless the design holds.")
    ] = False,
    units: Units = None,
    language: Language = None,
    quiet: Quiet = False,
    motion: Motion = None,
    duration: Duration = None,
    depth: Depth = None,
    overlay: Annotated[
        list[Path] | None,
        typer.Option(
            "--overlay",
            metavar="RESULTS",
            help="results.nc of another run, laid over the figures of the report; may be repeated.",
        ),
    ] = None,
) -> None:
    """Run a case, or a deck of MoorDyn: results.nc, report.html and tables as CSV.

    Exit code 0 when it was computed, whether the design holds or not; 1 when it did not converge or was interrupted;
    2 for errors of the case; with --require-hold 3 unless the design holds.
    """
    with guard(as_json, language):
        from moyai.case.reader import load_case
        from moyai.cli.runner import run as run_case
        from moyai.core.run_folder import alone_in, prepare_output, staged_outputs
        from moyai.report.systems import require_system

        started = time.perf_counter()
        folder = output if output is not None else Path("out") / file.stem
        file = _deck_or_case(file, folder, motion or [], duration, depth)
        with _compiling(_kind_in(file), quiet):
            case = load_case(file)
            _speak_as(case, language)
            others = _others(overlay, report)
            if units is not None:
                require_system(units)
            folder = prepare_output(folder)
            if not as_json and not quiet:
                count = len(case.warnings)
                if count:
                    tell(f"{counted(count, 'warning')} on the case, see below")
            with alone_in(folder), staged_outputs(folder) as staged:
                with progress_bars(quiet) as progress:
                    result = run_case(case, progress, keep=folder / "coefficients")
                if units is not None:
                    result = result.shown_in(units)
                if (asked := language or Spoken.language) is not None:
                    result = result.said_in(asked)
                document, files = _written(
                    result, staged, folder, others, report=report, pdf=pdf, quiet=quiet, as_json=as_json
                )
        if document is not None and getattr(case.model, "measured", None):
            from moyai.report.overlay import misplaced_points

            for line in misplaced_points(document):
                tell(f"measured: {line}")
        seconds = time.perf_counter() - started
        from moyai.cli.tables import key_figures, print_summary

        if as_json:
            print_json(_run_record(case, result, files, seconds, key_figures(result, document)))
        elif not quiet:
            print_summary(rich_console(), result, files, seconds, document)
        else:
            if result.status != "converged":
                tell(f"{result.status}: {result.message}")
            if result.verdict.outcome == "does not hold":
                tell(f"design does not hold: {result.verdict.message}")
        raise typer.Exit(exit_code(result, require_hold=require_hold))


def _speak_as(case: Any, language: str | None) -> None:
    """Go on in the language that a case names, unless the command names one."""
    display = getattr(case.model, "display", None)
    if (language or Spoken.language) is None and display is not None and display.language is not None:
        speak(display.language)


def _kind_in(file: Path) -> str:
    """Return the kind of structure that a file seems to hold, before it is read; what is wrong is found by reading."""
    text = file.read_text(encoding="utf-8", errors="replace") if file.is_file() else ""
    found = re.search(r"^structure:(?:.|\n)*?\bkind:\s*(\w+)", text, re.MULTILINE)
    return found[1] if found else ""


@contextmanager
def _compiling(kind: str, quiet: bool) -> Iterator[None]:
    """Compile what a kind of structure needs in further processes, and say so, where it was never compiled."""
    from moyai.core.compile_ahead import compiling_ahead, expected_seconds
    from moyai.core.compiled import when_compiling

    def say_once() -> None:
        seconds = expected_seconds(kind)
        if not quiet:
            tell(f"compiling numerical kernels, once after an installation{f': about {seconds:.0f} s' * (seconds > 5)}")

    with when_compiling(say_once), compiling_ahead(kind):
        yield


def _written(
    result: Result, staged: Path, folder: Path, others: tuple[Any, ...], *, report: bool, pdf: bool, quiet: bool,
    as_json: bool,
) -> tuple[Document | None, list[Path]]:  # fmt: skip
    """Write results and report, and put them in place; results that are complete stay where it is interrupted."""
    from moyai.core.run_folder import RESULTS, keeping_results, put_in_place

    document, files = None, list[Path]()
    try:
        with keeping_results(staged, folder):
            with held_back():
                files = [result.write(staged / RESULTS)]
            if report:
                document, pages = _report(result, staged, others, pdf=pdf, quiet=quiet)
                files += pages
            with held_back():
                files = put_in_place(staged, folder, files)
                # what comes from here on changes nothing of the results
                ignore()
    except KeyboardInterrupt:
        if not files:
            raise
        place = folder / RESULTS
        fault = Fault(f"interrupted while results were written; {place} is complete")
        if report:
            fault = Fault(
                f"the report was interrupted; {place} is complete", remedy=f"'moyai report {place}' writes it"
            )
        stop([fault], FAILED, as_json=as_json)
    return document, files


def _report(
    result: Result, folder: Path, others: tuple[Any, ...], *, pdf: bool, quiet: bool
) -> tuple[Document, list[Path]]:
    """Write the report into a folder; return its document and files."""
    from moyai.report.writer import compose_document, write_report

    with progress_bars(quiet) as progress:
        progress("report", 0, 1)
        document = compose_document(result)
        if others:
            from moyai.report.differences import with_others
            from moyai.report.systems import displayed_in

            with displayed_in(document.units):
                document = with_others(document, result, others)
        return document, write_report(result, folder, pdf=pdf, document=document)


def _others(paths: list[Path] | None, report: bool) -> tuple[Any, ...]:
    """Read the results that the report is compared with, before the run, so that a bad file costs no run."""
    if not paths:
        return ()
    if not report:
        from moyai.core.errors import InputError

        raise InputError("other results are laid over the report", path="--overlay", remedy="leave out --no-report")
    from moyai.report.differences import read_others

    return read_others(paths)


def exit_code(result: Result, *, require_hold: bool) -> int:
    """Return the exit code of a run.

    Parameters
    ----------
    result : Result
    require_hold : bool
        Whether a design that does not hold, or is not judged, has a code of its own.
    """
    failed = any(not identity.passed for identity in result.checks)
    if failed or result.status not in ("converged", "outside_validity"):
        return FAILED
    return NOT_HELD if require_hold and result.verdict.outcome != "holds" else OK


def _deck_or_case(file: Path, folder: Path, motions: list[str], duration: float | None, depth: float | None) -> Path:
    """Return the case file: FILE itself, or that of a deck of MoorDyn, written into the folder of the results."""
    deck = False
    if file.suffix.lower() not in (".yaml", ".yml"):
        # decks are read by half the package, which most cases do not need
        from moyai.interop.moordyn_case import is_deck

        deck = is_deck(file)
    if deck:
        return case_of_deck(file, folder / "case.yaml", motions, duration, None, replace=True, depth=depth)
    if motions or duration is not None or depth is not None:
        from moyai.core.errors import InputError

        raise InputError("a case file has its motions, durations and depth in itself", path="--motion, --duration")
    return file


def _run_record(case: Any, result: Any, files: list[Path], seconds: float, figures: list[Any]) -> dict[str, Any]:
    from moyai.cli.tables import figure_records

    return {
        "status": result.status,
        "message": result.message,
        "headlines": [headline.as_dict() for headline in result.headlines],
        "verdict": result.verdict.as_dict(),
        "title": case.title,
        "structure": case.kind,
        "case_hash": case.case_hash,
        "files": [str(path) for path in files],
        "seconds": round(seconds, 3),
        "key_figures": figure_records(figures),
        "checks": [identity.as_dict() for identity in result.checks],
        "notices": [notice.as_dict() for notice in result.notices],
        "faults": [],
    }


@app.command()
def validate(
    as_json: AsJson = False,
    only: Annotated[
        list[str] | None, typer.Option("--only", metavar="TOPIC", help="Topic to validate; may be repeated.")
    ] = None,
    paper: Annotated[
        str | None, typer.Option("--paper", metavar="PAPER", help="Statements of one paper in place of the topics.")
    ] = None,
    quiet: Quiet = False,
) -> None:
    """Compute every case with a reference again: value, reference, error, and where the reference is from.

    A reference is exact (closed form, identity, planted value), published, measured, of another program, or of a second
    program of our own; each row states which. Rows come as the cases end.
    """
    with guard(as_json):
        if paper is not None:
            from moyai.cli.reproduce import print_statements

            print_statements(paper, as_json=as_json, quiet=quiet)
            raise typer.Exit(OK)
        from moyai.validation import choose, compute

        with progress_bars(quiet) as progress:
            from moyai.cli.tables import outcome_line, print_outcome_count

            def ended(outcome: Any) -> None:
                if not as_json and not (quiet and outcome.passed):
                    put(outcome_line(outcome))
                    sys.stdout.flush()

            outcomes = compute(choose(only or ()), progress, ended)
        passed = all(outcome.passed for outcome in outcomes)
        if as_json:
            print_json({"cases": [outcome.as_dict() for outcome in outcomes]})
        else:
            print_outcome_count(outcomes)
        raise typer.Exit(OK if passed else FAILED)


def _write_text(path: Path, text: str, force: bool) -> None:
    from moyai.cli.files import write_text

    write_text(path, text, replace=force)


def main() -> None:
    """Entry point of the ``moyai`` command."""
    prepare_streams()
    # Imports and the compiler make a million objects that live on: the search for garbage among them costs a tenth
    gc.set_threshold(100_000, 50, 50)
    listen()
    arguments = sys.argv[1:]
    if "--debug" in arguments:
        # Accepted at any place, since it is wanted after the fact
        Debug.on = True
        arguments = [argument for argument in arguments if argument != "--debug"]
    try:
        app(args=arguments, prog_name="moyai")
    except KeyboardInterrupt:
        tell("interrupted")
        sys.exit(FAILED)


__all__ = ["BAD_INPUT", "app", "main"]

if __name__ == "__main__":
    main()
