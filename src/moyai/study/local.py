"""Processes on this machine: one thread each, replaced when they die."""

from __future__ import annotations

import contextlib
import os
import signal
from collections import deque
from collections.abc import Iterator
from multiprocessing.connection import wait
from typing import Any

from moyai.core.errors import InputError
from moyai.core.kinds import kind_named, structure_kind
from moyai.core.processes import Starter, collect_rarely, die_with_parent
from moyai.core.progress import Progress, silent
from moyai.study.axes import Combination
from moyai.study.ledger import LedgerRecord
from moyai.study.work import Task, run_case

THREADS = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "NUMBA_NUM_THREADS", "MOYAI_THREADS")
"""What keeps a worker to one thread."""

_DEATHS = 2
_GRACE = 3.0
_STARTED = "started"


def run_here(task: Task, cases: tuple[Combination, ...], progress: Progress = silent) -> Iterator[LedgerRecord]:
    """Run the cases in this process, telling the steps of each."""
    for combination in cases:
        record = run_case(task, combination, progress=progress)
        if record is None:
            raise KeyboardInterrupt
        yield record


def run_processes(task: Task, cases: tuple[Combination, ...], workers: int) -> Iterator[LedgerRecord]:
    """Run the cases in worker processes; records come in the order in which they finish.

    A worker that dies (killed, out of memory) is replaced and its case tried once more; a case that kills two workers
    becomes a failed record. Leaving the loop early, by an exception or Ctrl-C, ends the workers.

    Parameters
    ----------
    task : Task
    cases : tuple of Combination
    workers : int
        Number of processes.

    Raises
    ------
    InputError
        When workers cannot be started at all.
    """
    kind = kind_named(task.base.data)
    starter = Starter("moyai.study.warm", *([f"{structure_kind(kind).package}.run"] if kind else []))
    cancel = starter.context.Event()
    waiting = deque((combination, 0) for combination in cases)
    crew: list[_Worker] = []
    with _one_thread():
        try:
            crew = [_Worker(starter, task, cancel) for _ in range(min(workers, len(cases)))]
            while waiting or any(worker.busy for worker in crew):
                for worker in crew:
                    if waiting and not worker.busy:
                        worker.give(*waiting.popleft())
                ready = wait([worker.pipe for worker in crew if worker.busy], timeout=1.0)
                for worker in tuple(crew):
                    if worker.pipe not in ready:
                        continue
                    answer = worker.take()
                    if answer == _STARTED:
                        continue
                    job, worker.job = worker.job, None
                    assert job is not None
                    if answer is not None:
                        yield answer
                        continue
                    # The pipe is closed: the worker died
                    combination, deaths = job
                    if not worker.started and deaths:
                        raise InputError(
                            "the worker processes do not start",
                            path="workers",
                            remedy="run with --workers 1, or from a script guarded by if __name__ == '__main__'",
                        )
                    if deaths + 1 >= _DEATHS:
                        message = f"the worker process died twice on this case (exit code {worker.exit_code()})"
                        yield LedgerRecord(combination.index, "failed", message, 0.0, {})
                    else:
                        waiting.append((combination, deaths + 1))
                    worker.end()
                    crew.remove(worker)
                    if waiting:
                        crew.append(_Worker(starter, task, cancel))
        finally:
            cancel.set()
            for worker in crew:
                worker.end()


class _Worker:
    """One process with its pipe."""

    def __init__(self, starter: Starter, task: Task, cancel: Any) -> None:
        self.pipe, far = starter.context.Pipe()
        self.process = starter.start(_serve, far, task, cancel)
        far.close()
        self.job: tuple[Combination, int] | None = None
        self.started = False

    @property
    def busy(self) -> bool:
        return self.job is not None

    def give(self, combination: Combination, deaths: int) -> None:
        self.job = (combination, deaths)
        # A dead worker is found out when its answer is fetched
        with contextlib.suppress(OSError):
            self.pipe.send(combination)

    def take(self) -> Any:
        """What the worker sent: ``_STARTED`` first, then records; None when it is dead."""
        try:
            answer = self.pipe.recv()
        except (EOFError, OSError):
            return None
        self.started = True
        return answer

    def exit_code(self) -> int | None:
        self.process.join(timeout=1.0)
        found: int | None = self.process.exitcode
        return found

    def end(self) -> None:
        with contextlib.suppress(OSError):
            if not self.busy:
                self.pipe.send(None)
        self.process.join(timeout=_GRACE if not self.busy else 0.5)
        if self.process.is_alive():
            self.process.kill()
            self.process.join()
        self.pipe.close()


class _one_thread:
    """Let processes started inside begin with one thread each: they read it when they import numpy."""

    def __enter__(self) -> None:
        self.before = {name: os.environ.get(name) for name in THREADS}
        os.environ.update(dict.fromkeys(THREADS, "1"))

    def __exit__(self, *_: object) -> None:
        for name, value in self.before.items():
            if value is None:
                os.environ.pop(name, None)
            else:
                os.environ[name] = value


def _serve(pipe: Any, task: Task, cancel: Any) -> None:
    """Run what comes through the pipe until nothing more comes."""
    # Ctrl-C reaches every process of the terminal; the parent decides what happens then
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    die_with_parent()
    collect_rarely()
    # Tells a case that kills its worker from a worker that cannot start
    with contextlib.suppress(OSError):
        pipe.send(_STARTED)
    while True:
        try:
            combination = pipe.recv()
        except (EOFError, OSError):
            return
        if combination is None:
            return
        record = run_case(task, combination, cancel.is_set)
        if record is None:
            return
        try:
            pipe.send(record)
        except OSError:
            return


__all__ = ["run_here", "run_processes"]
