"""What the process of a job does: a full run, a study, a fit, or a paper computed again, into a folder of its own."""

from __future__ import annotations

import math
import os
import signal
import sys
import threading
import time
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from moyai.app.pins import Run
from moyai.core.errors import CaseError, MoyaiError, system_words
from moyai.core.processes import collect_rarely, die_with_parent
from moyai.core.progress import Pace, duration_words
from moyai.core.run_folder import prepare_output
from moyai.language import speak
from moyai.language.faults import fault_text

_EVERY = 0.2


@dataclass(frozen=True)
class Order:
    """What a job is to do."""

    #: ``run``, ``study``, ``fit`` or ``paper``.
    kind: str
    #: Name of the file, or key of the paper.
    name: str
    #: Of the results.
    folder: Path
    #: The chosen folder.
    root: Path
    #: Where the case stands, from which it names other files.
    file: Path
    #: The case; empty for all but a run.
    text: str = ""
    #: Whether ``file`` holds this text; else the command line that does the same takes the copy next to the results.
    saved: bool = True
    #: Of the report, where the case names none.
    language: str = "en"


def work(pipe: Any, stop: Any, order: Order, run: Run) -> None:
    """Do an order and report over the pipe: ``("progress", ...)``, then ``("done", ...)`` or ``("failed", text)``."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    signal.signal(signal.SIGTERM, signal.SIG_DFL)
    sys.stdout = sys.stderr = open(os.devnull, "w")  # noqa: SIM115 - as long as the process
    speak(order.language)
    die_with_parent()
    collect_rarely()
    pace, reported = Pace(), [0.0]

    def listen(what: str, done: float, total: float) -> None:
        pace.tell(what, done, total)
        if stop.is_set():
            raise KeyboardInterrupt
        now = time.monotonic()
        if now - reported[0] >= _EVERY:
            reported[0] = now
            left = pace.left(what)
            pipe.send(
                (
                    "progress",
                    what,
                    done / total if total > 0.0 else 0.0,
                    duration_words(left) if math.isfinite(left) else "",
                )
            )

    try:
        prepare_output(order.folder)
        pipe.send(("done", *_done(order, run, listen, stop)))
    except KeyboardInterrupt:
        pipe.send(("failed", "cancelled before there was a result"))
    except CaseError as error:
        pipe.send(("failed", "\n".join(map(fault_text, error.faults))))
    except MoyaiError as error:
        pipe.send(("failed", fault_text(error.fault)))
    except OSError as error:
        pipe.send(("failed", system_words(error)))
    except Exception as error:
        pipe.send(("failed", f"internal error, {type(error).__name__}: {error}"))


def _done(order: Order, run: Run, listen: Any, stop: Any) -> tuple[str, str, str]:
    from moyai.app.study_jobs import run_fit_job, run_study_job

    if order.kind == "run":
        return _run(order, run, listen)
    if order.kind == "paper":
        return _paper(order, listen)
    # A study waits for its workers and looks at no flag meanwhile: it is interrupted as by Ctrl-C, and keeps its cases
    signal.signal(signal.SIGINT, signal.default_int_handler)
    threading.Thread(target=_interrupt_when, args=(stop,), daemon=True).start()
    return (run_study_job if order.kind == "study" else run_fit_job)(order.file, order.folder, run, listen)


def _interrupt_when(stop: Any) -> None:
    stop.wait()
    if hasattr(signal, "pthread_kill"):
        signal.pthread_kill(threading.main_thread().ident or 0, signal.SIGINT)


def _run(order: Order, run: Run, listen: Any) -> tuple[str, str, str]:
    from moyai.app.folder import refuse_foreign_files
    from moyai.case.reader import case_of
    from moyai.case.yaml_reader import parse_yaml
    from moyai.core.compile_ahead import compiling_ahead
    from moyai.core.files import write_whole
    from moyai.core.run_folder import RESULTS, alone_in, keeping_results, put_in_place, staged_outputs
    from moyai.report.writer import compose_document, write_report

    document = parse_yaml(order.text, order.file.name)
    refuse_foreign_files(order.root, order.file.parent, document)
    case = case_of(document, order.file)
    with compiling_ahead(case.kind), alone_in(order.folder), staged_outputs(order.folder) as staged:
        write_whole(order.folder / "case.yaml", order.text.encode("utf-8"))
        result = run(case, listen, keep=order.folder / "coefficients")
        with keeping_results(staged, order.folder):
            files = [result.write(staged / RESULTS)]
            files += write_report(result, staged, document=compose_document(result))
            files = put_in_place(staged, order.folder, files)
    return result.status, result.message, result.verdict.message


def _paper(order: Order, listen: Any) -> tuple[str, str, str]:
    from moyai.core.run_folder import alone_in
    from moyai.reproduce import as_result, reproduce
    from moyai.reproduce.page import write

    with alone_in(order.folder):
        found = reproduce(order.name, quick=True, progress=listen)
        result = as_result(found)
        write(found, result, order.folder)
    return result.status, result.message, ""
