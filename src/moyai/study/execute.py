"""Run a study: the diary in front, the workers behind, and the same command continues where it was stopped."""

from __future__ import annotations

import contextlib
import difflib
import math
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from moyai.core.errors import InputError
from moyai.core.options import checks_words
from moyai.core.progress import Progress, silent
from moyai.core.results import Result
from moyai.study.axes import Combination
from moyai.study.definition import RunCase, Study
from moyai.study.ledger import Ledger, LedgerRecord
from moyai.study.local import run_here, run_processes
from moyai.study.plan import with_search
from moyai.study.table import study_result
from moyai.study.tensions import response
from moyai.study.work import Task

Backend = Callable[[Task, tuple[Combination, ...]], Iterator[LedgerRecord]]


@dataclass(frozen=True)
class Standing:
    """How far a study is, for whoever watches."""

    #: Cases done.
    done: int
    #: Cases in all.
    total: int
    #: Cases that failed; refused ones count.
    failed: int
    #: Estimated from the rate so far, NaN at the start [s].
    seconds_left: float
    #: Largest value of the watched response, and number of the case.
    largest: tuple[float, int] | None
    #: Smallest value of the watched response, and number of the case.
    smallest: tuple[float, int] | None
    #: The case that ended last.
    latest: LedgerRecord | None = None
    #: Of the watched response.
    unit: str = "1"


Watcher = Callable[[Standing], None]
RESULTS = "study.nc"
"""Name of the results of a study in its folder."""
_OFTEN = 2.0
"""Least time between two gatherings of a study that runs [s]."""
_COST = 20.0
"""Least time between two gatherings over the time that one takes [-]."""


@checks_words
def run_study(
    study: Study,
    folder: Path,
    run: RunCase,
    *,
    workers: int,
    on: Any = None,
    retry_failed: bool = False,
    progress: Progress = silent,
    watch: Watcher | None = None,
) -> Result:
    """Run what is left of a study and gather everything.

    Parameters
    ----------
    study : Study
        As :func:`moyai.study.load_study` reads it.
    folder : Path
        Folder of the results; the same folder and study go on where they were stopped.
    run : callable
        ``run(case, progress)``; importable by name, since workers import it.
    workers : int
        Processes on this machine; 1 runs in this process. Without meaning when ``on`` is given.
    on : str or dask cluster or client, optional
        ``dask://host:port``, or an object of dask.distributed.
    retry_failed : bool
        Run cases again that failed before.
    progress : Progress
        Called within the cases.
    watch : callable, optional
        Called with the standing after every case.

    Returns
    -------
    Result
        Status ``interrupted`` when it was stopped; the same call continues.

    Raises
    ------
    InputError
        When the folder holds another study, the disk is full, the cluster is out of reach, or the first case that
        ends keeps no response of the name that is watched; cases that ended are kept.

    Examples
    --------
    >>> from pathlib import Path
    >>> from tempfile import mkdtemp
    >>> import moyai
    >>> from moyai.study import load_study, run_study
    >>> folder = Path(mkdtemp())
    >>> _ = (folder / "base.yaml").write_text(moyai.template("network"), encoding="utf-8")
    >>> text = "{base: base.yaml, set: {analyses: [statics]}, variations: [{grid: {current.speed: [0.5, 1.0]}}]}"
    >>> _ = (folder / "study.yaml").write_text(f"moyai: 1\\nstudy: {text}\\n", encoding="utf-8")
    >>> result = run_study(load_study(folder / "study.yaml"), folder / "out", moyai.run, workers=1)
    >>> result.status
    'converged'
    """
    ledger = Ledger(folder, study.key, study.title)
    try:
        known = {
            record.index: record for record in ledger.records() if not (retry_failed and record.status == "failed")
        }
        left = tuple(case for case in study.cases if case.index not in known)
        results_folder = folder / "cases" if study.keep_results else None
        base = replace(study.base, text="")
        task = Task(base, study.base_path.resolve(), study.wanted, results_folder, with_search(study, run))
        stopped = False
        if left:
            kept = _require_watched(study, known)
            watching = _Reporting(study, known, watch, progress)
            so_far = _SoFar(study, folder)
            records = _backend(on, workers, progress)(task, left)
            try:
                for record in records:
                    ledger.add(record)
                    known[record.index] = record
                    watching.tell(record)
                    so_far.keep(known)
                    kept = kept or _require_watched(study, known)
            except KeyboardInterrupt:
                stopped = True
            finally:
                close = getattr(records, "close", None)
                if close is not None:
                    close()
            ledger.settle()
    finally:
        ledger.close()
    return study_result(study, known.values(), interrupted=stopped)


def _require_watched(study: Study, known: dict[int, LedgerRecord]) -> bool:
    """Require that cases which ended keep the response that is watched; False while none has kept any."""
    ended = [record for record in known.values() if record.values]
    if not study.watch or study.search is not None or not ended:
        return not study.watch or study.search is not None
    so_far = study_result(study, ended, interrupted=True)
    try:
        response(so_far, study.watch)
    except InputError as error:
        names = [
            f"{node.path.strip('/')}/{name}"
            for node in so_far.tree.subtree
            if node.path != "/"
            for name in node.data_vars
        ]
        near = difflib.get_close_matches(study.watch, names, n=6, cutoff=0.4)
        raise InputError(
            f"no case keeps the response '{study.watch}' that is watched",
            path="study.watch",
            allowed=", ".join(near) or error.fault.allowed,
            remedy=error.fault.remedy
            or "name one that is kept, or request this one under 'responses' with its reduction; cases that ended "
            "are kept, and the same command continues",
        ) from None
    return True


def _backend(on: Any, workers: int, progress: Progress) -> Backend:
    if on is not None:
        from moyai.study.on_dask import run_on_dask

        return lambda task, cases: run_on_dask(task, cases, on)
    if workers < 1:
        raise InputError(f"{workers} workers cannot run anything", path="workers", allowed="1 or more")
    if workers == 1:
        return lambda task, cases: run_here(task, cases, progress)
    return lambda task, cases: run_processes(task, cases, workers)


class _SoFar:
    """Gathers the cases that ended into ``study.nc`` while the study runs, so that one that is killed can be asked.

    Written after a case, but no oftener than every two seconds nor in more than a twentieth of the time.
    """

    def __init__(self, study: Study, folder: Path) -> None:
        self.study, self.path = study, folder / RESULTS
        self.next = time.monotonic() + _OFTEN

    def keep(self, known: dict[int, LedgerRecord]) -> None:
        begun = time.monotonic()
        if begun < self.next or len(known) == len(self.study.cases):
            return
        # The diary holds every case: what goes wrong here is reported where the study ends
        with contextlib.suppress(InputError, OSError):
            study_result(self.study, known.values(), interrupted=True).write(self.path)
        self.next = time.monotonic() + max(_OFTEN, _COST * (time.monotonic() - begun))


class _Reporting:
    """Counts, the time left, the largest and smallest watched response."""

    def __init__(self, study: Study, known: dict[int, LedgerRecord], watch: Watcher | None, progress: Progress) -> None:
        self.study, self.watch, self.progress = study, watch, progress
        self.done, self.total = len(known), len(study.cases)
        self.failed = sum(record.status in ("failed", "refused") for record in known.values())
        self.before = self.done
        self.started = time.monotonic()
        self.extremes: list[tuple[float, int]] = []
        self.unit = "1"
        for record in known.values():
            self._look(record)

    def _look(self, record: LedgerRecord) -> None:
        item = record.values.get(self.study.watch)
        if item is None:
            return
        values = np.asarray(item["values"], dtype=float)
        if np.isfinite(values).any():
            entry = (float(np.nanmax(values)), record.index)
            self.unit = str(item["units"])
            self.extremes = [min([*self.extremes, entry]), max([*self.extremes, entry])]

    def tell(self, record: LedgerRecord) -> None:
        self.done += 1
        self.failed += record.status in ("failed", "refused")
        self._look(record)
        self.progress("cases", self.done, self.total)
        if self.watch is not None:
            rate = (self.done - self.before) / max(time.monotonic() - self.started, 1e-9)
            left = (self.total - self.done) / rate if rate > 0 else math.nan
            smallest, largest = (self.extremes[0], self.extremes[-1]) if self.extremes else (None, None)
            self.watch(Standing(self.done, self.total, self.failed, left, largest, smallest, record, self.unit))
