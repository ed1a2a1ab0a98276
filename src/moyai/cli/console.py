"""What the commands share: streams that never fail on a character, JSON, faults, exit codes, progress bars."""

from __future__ import annotations

import json
import math
import os
import sys
import threading
from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager
from contextvars import copy_context
from dataclasses import asdict
from typing import TYPE_CHECKING, Any, NoReturn

import typer

from moyai.core.errors import CaseError, ConvergenceError, Fault, InputError
from moyai.core.progress import Pace, Progress, duration_words, silent
from moyai.language import language_of_the_locale, require_language, said, spoken_in, spoken_language
from moyai.language.faults import fault_text

if TYPE_CHECKING:
    from rich.console import Console

OK, FAILED, BAD_INPUT, NOT_HELD = 0, 1, 2, 3
"""Exit codes: all well; something failed or did not converge; the input is bad; the design does not hold (if asked)."""


class Debug:
    """Whether faults of the program itself show their traceback (``--debug``)."""

    on = False


class Spoken:
    """The language that ``moyai --language`` asks of every command."""

    language: str | None = None


def prepare_streams() -> None:
    """Let the streams replace what the console's encoding cannot show; those that are closed lead to nowhere."""
    if sys.stdout is None:
        sys.stdout = open(os.devnull, "w", encoding="utf-8")  # noqa: SIM115 - as long as the process
    if sys.stderr is None:
        sys.stderr = open(os.devnull, "w", encoding="utf-8")  # noqa: SIM115
    for stream in (sys.stdout, sys.stderr):
        if hasattr(stream, "reconfigure"):
            stream.reconfigure(errors="replace")


def print_json(content: Any) -> None:
    """Print one JSON value on standard output; plain ASCII, and ``null`` where a number is not finite."""
    sys.stdout.write(json.dumps(_finite(content), indent=2, allow_nan=False) + "\n")
    sys.stdout.flush()


def _finite(value: Any) -> Any:
    if isinstance(value, Mapping):
        return {str(key): _finite(item) for key, item in value.items()}
    if isinstance(value, (list, tuple)):
        return [_finite(item) for item in value]
    if isinstance(value, float):
        return value if math.isfinite(value) else None
    if isinstance(value, (str, int, bool)) or value is None:
        return value
    return str(value)


def say(text: str = "") -> None:
    """Print a line on standard output, in the language in force."""
    put(said(text))


def put(text: str) -> None:
    """Print a line on standard output as it is: a file, a name, data."""
    sys.stdout.write(text + "\n")


def tell(text: str) -> None:
    """Print a line on standard error, in the language in force."""
    inform(said(text))


def inform(text: str) -> None:
    """Print a line on standard error as it is."""
    sys.stderr.write(text + "\n")
    sys.stderr.flush()


def complain(fault: Fault, label: str = "") -> None:
    """Print a fault on standard error, in the language in force; keys and values of files stay as they are."""
    text = fault_text(fault)
    sys.stderr.write(f"{said(label)}: {text}\n" if label else f"{text}\n")
    sys.stderr.flush()


def rich_console(*, to_error: bool = False) -> Console:
    """Return a rich console that keeps to plain text where the output is not a terminal."""
    from rich.console import Console

    stream = sys.stderr if to_error else sys.stdout
    width = None if stream.isatty() else 110
    return Console(file=stream, highlight=False, width=width, safe_box=True)


def fault_records(faults: Iterable[Fault]) -> list[dict[str, Any]]:
    """Return faults as JSON-ready records."""
    return [asdict(fault) for fault in faults]


def stop(faults: Iterable[Fault], code: int, *, as_json: bool) -> NoReturn:
    """Print faults where they belong and leave with ``code``."""
    listed = list(faults)
    if as_json:
        print_json({"faults": fault_records(listed)})
    else:
        for fault in listed:
            complain(fault)
        if code == BAD_INPUT and len(listed) > 1:
            tell(f"{len(listed)} errors")
    raise typer.Exit(code)


@contextmanager
def guard(as_json: bool = False, language: str | None = None) -> Iterator[None]:
    """Turn everything that can go wrong in a command into one clear message and an exit code.

    Messages are in the language given, else in that of the locale.
    """
    try:
        asked = language or Spoken.language
        spoken = spoken_in(require_language(asked) if asked else language_of_the_locale())
    except InputError as error:
        stop([error.fault], BAD_INPUT, as_json=as_json)
    with spoken, _guarded(as_json):
        yield


@contextmanager
def _guarded(as_json: bool) -> Iterator[None]:
    try:
        yield
    except CaseError as error:
        stop(error.faults, BAD_INPUT, as_json=as_json)
    except InputError as error:
        stop([error.fault], BAD_INPUT, as_json=as_json)
    except ConvergenceError as error:
        stop([error.fault], FAILED, as_json=as_json)
    except KeyboardInterrupt:
        stop([Fault("interrupted before there was a result")], FAILED, as_json=as_json)
    except BrokenPipeError:
        # The reader of a pipe has left; keep Python from complaining when it flushes at exit
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        raise typer.Exit(FAILED) from None
    except (typer.Exit, typer.Abort):
        raise
    except Exception as error:
        if Debug.on:
            raise
        if type(error).__name__ == "LinAlgError":
            # Numbers of the case that are each allowed, and too far apart for a system of equations
            remedy = "look for a stiffness, mass or damping that is far larger or smaller than the others"
            fault = Fault(f"the equations of the case cannot be solved: {error}", remedy=remedy)
            stop([fault], FAILED, as_json=as_json)
        message = f"internal error, {type(error).__name__}: {error}"
        remedy = "this is a fault of moyai; run again with --debug and report what it prints"
        stop([Fault(message, remedy=remedy)], FAILED, as_json=as_json)


LINE_EVERY = 10.0
"""Seconds between two lines of progress where standard error is no terminal."""


@contextmanager
def progress_bars(quiet: bool) -> Iterator[Progress]:
    """Give a listener that shows every stage with the time left, on standard error.

    Bars on a terminal; in a pipe or a file a line every ten seconds.
    """
    if quiet:
        yield silent
    elif sys.stderr.isatty():
        with _bars() as listen:
            yield listen
    else:
        with _lines(LINE_EVERY) as listen:
            yield listen


@contextmanager
def _bars() -> Iterator[Progress]:
    from rich.progress import BarColumn, ProgressColumn, Task, TaskID, TextColumn
    from rich.progress import Progress as Bars
    from rich.text import Text

    pace, language = Pace(), spoken_language()

    class Left(ProgressColumn):
        """Time left by the rate since the stage began."""

        def render(self, task: Task) -> Text:
            left = pace.left(str(task.fields["stage"]))
            with spoken_in(language):  # bars are drawn by a thread of their own
                return Text(said(f"{duration_words(left)} left") if math.isfinite(left) else "")

    columns = (TextColumn("{task.description}"), BarColumn(), TextColumn("{task.percentage:>3.0f} %"), Left())
    with Bars(*columns, console=rich_console(to_error=True), transient=True) as bars:
        tasks: dict[str, TaskID] = {}

        def listen(what: str, done: float, total: float) -> None:
            pace.tell(what, done, total)
            if what not in tasks:
                tasks[what] = bars.add_task(said(what), total=total, stage=what)
            bars.update(tasks[what], completed=done, total=total, visible=done < total)

        yield listen


@contextmanager
def _lines(every: float) -> Iterator[Progress]:
    """Give a listener that prints a line at most every so many seconds, also while one step takes longer."""
    pace, ended, lock = Pace(), threading.Event(), threading.Lock()

    def listen(what: str, done: float, total: float) -> None:
        with lock:
            pace.tell(what, done, total)

    def print_lines() -> None:
        while not ended.wait(every):
            with lock:
                line = pace.line()
            if line:
                tell(line)

    # a thread begins without the language in force
    printer = threading.Thread(target=copy_context().run, args=(print_lines,), name="progress", daemon=True)
    printer.start()
    try:
        yield listen
    finally:
        ended.set()
        printer.join(1.0)
