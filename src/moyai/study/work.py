"""Run one case of a study: in this process, in another one, or on a cluster."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from moyai.case.yaml_reader import CaseDocument
from moyai.core.errors import CaseError, InputError, MoyaiError
from moyai.core.progress import Progress, silent
from moyai.study.axes import Combination, varied
from moyai.study.definition import RunCase
from moyai.study.ledger import LedgerRecord
from moyai.study.responses import Wanted, kept

_POLL = 0.2


@dataclass(frozen=True)
class Task:
    """What all cases of a study have in common; small enough to be sent to a worker."""

    #: The base case.
    base: CaseDocument
    #: Its file, from which it names others.
    base_path: Path
    wanted: tuple[Wanted, ...]
    #: Where results.nc of every case goes.
    results_folder: Path | None
    #: ``run(case, progress)``: must be importable by the workers.
    run: RunCase


def run_case(
    task: Task,
    combination: Combination,
    cancelled: Callable[[], bool] | None = None,
    progress: Progress = silent,
) -> LedgerRecord | None:
    """Run one case and return what is kept of it, ``None`` when it was cancelled.

    Whatever goes wrong in the case becomes its record; nothing is raised but what ends the process.

    Parameters
    ----------
    task : Task
    combination : Combination
    cancelled : callable, optional
        Asked a few times a second whether to stop.
    progress : Progress
        Called with the steps of the case.
    """
    from moyai.case.reader import case_of

    started, verdict = time.perf_counter(), ""
    try:
        case = case_of(varied(task.base, combination), task.base_path)
    except (CaseError, InputError) as error:
        faults = error.faults[:3] if isinstance(error, CaseError) else (error.fault,)
        message = "; ".join(str(replace(fault, file="", line=0, column=0)) for fault in faults)
        return LedgerRecord(combination.index, "refused", message, time.perf_counter() - started, {})
    try:
        options = dict(combination.options)
        run = task.run.bind(options) if options else task.run  # type: ignore[attr-defined]
        result = run(case, _listener(cancelled, progress))
        if cancelled is not None and cancelled():
            return None
        if task.results_folder is not None:
            result.write(task.results_folder / f"{combination.index:06d}" / "results.nc")
        values = kept(result.held, task.wanted)
        status, message = result.status, result.message
        verdict = result.verdict.outcome if result.verdict.message else ""
        failed = [check.name for check in result.checks if not check.passed]
        if failed and status == "converged":
            status, message = "outside_validity", f"identities missed: {', '.join(failed)}"
    except KeyboardInterrupt:
        return None
    except CaseError as error:
        status, message, values = "failed", "; ".join(str(fault) for fault in error.faults[:3]), {}
    except MoyaiError as error:
        status, message, values = "failed", str(error), {}
    except Exception as error:
        # A fault of the program in one case must not cost the others
        status, message, values = "failed", f"internal error, {type(error).__name__}: {error}", {}
    return LedgerRecord(combination.index, status, message, time.perf_counter() - started, values, verdict)


def _listener(cancelled: Callable[[], bool] | None, progress: Progress) -> Progress:
    asked = time.monotonic()

    def listen(what: str, done: float, total: float) -> None:
        nonlocal asked
        progress("this case", done, total)
        now = time.monotonic()
        if cancelled is not None and now - asked > _POLL:
            asked = now
            if cancelled():
                raise KeyboardInterrupt

    return listen


__all__: list[Any] = ["Task", "run_case"]
