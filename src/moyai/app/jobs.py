"""Jobs: full runs in processes of their own, one after the other; cancelled within seconds, started again when lost."""

from __future__ import annotations

import contextlib
import itertools
import multiprocessing
import threading
import time
from collections.abc import Callable
from multiprocessing.connection import wait
from pathlib import Path
from typing import Any

from moyai.app.folder import Folder
from moyai.app.job import Job
from moyai.app.job_process import Order, work
from moyai.app.job_records import ENDED, kept_jobs
from moyai.app.pins import Run

GRACE = 2.0
"""Seconds between the flag that asks a job to stop and the end of its process."""


class Jobs:
    """The queue of jobs.

    Parameters
    ----------
    run : callable
        Runs a case; a function of a module.
    target : callable
        What the process does; ``work`` but for tests.
    folder : Folder, optional
        Whose jobs of apps before this one are listed.
    """

    def __init__(self, run: Run, target: Callable[..., None] = work, folder: Folder | None = None) -> None:
        self._run = run
        self._target = target
        self._context = multiprocessing.get_context("spawn")
        self._jobs: dict[str, Job] = {}
        self._numbers = itertools.count(1)
        for one in kept_jobs(folder) if folder is not None else ():
            job = Job(f"job{next(self._numbers)}", one.order, one)
            self._jobs[job.key] = job
        self._changed = threading.Condition()
        self._closed = False
        self._thread = threading.Thread(target=self._serve, name="jobs", daemon=True)
        self._thread.start()

    def __getitem__(self, key: str) -> Job:
        return self._jobs[key]

    def records(self, root: Path) -> list[dict[str, Any]]:
        """Return all jobs, the newest first."""
        with self._changed:
            return [job.record(root) for job in reversed(self._jobs.values())]

    def folder_for(self, output: Path, name: str) -> Path:
        """Return a folder of results that neither exists nor belongs to a job."""
        taken = {job.order.folder for job in self._jobs.values()}
        folder, count = output / name, 2
        while folder in taken or folder.exists():
            folder, count = output / f"{name}_{count}", count + 1
        return folder

    def add(self, order: Order) -> Job:
        """Put a job at the end of the queue."""
        with self._changed:
            job = Job(f"job{next(self._numbers)}", order)
            self._jobs[job.key] = job
            job.keep()
            self._changed.notify_all()
        return job

    def again(self, key: str) -> Job:
        """Start an ended job again, with the coefficients or the cases of a study that it has kept in its folder."""
        with self._changed:
            job = self._jobs[key]
            if job.state in ENDED:
                fresh = Job(job.key, job.order)
                self._jobs[key] = job = fresh
                job.keep()
                self._changed.notify_all()
        return job

    def cancel(self, key: str) -> Job:
        """Ask a job to stop; after :data:`GRACE` seconds its process is ended."""
        with self._changed:
            job = self._jobs[key]
            if job.state == "waiting":
                job.state, job.words = "cancelled", "cancelled before it began"
                job.keep()
            elif job.state == "running":
                job.state, job.asked = "cancelling", time.monotonic()
                if job.stop is not None:
                    job.stop.set()
        return job

    def close(self) -> None:
        """End all processes and the queue."""
        with self._changed:
            self._closed = True
            self._changed.notify_all()
        for job in list(self._jobs.values()):
            if job.process is not None and job.process.is_alive():
                job.process.kill()
        self._thread.join(5.0)

    def _next(self) -> Job | None:
        with self._changed:
            while True:
                if self._closed:
                    return None
                for job in self._jobs.values():
                    if job.state == "waiting":
                        job.state, job.started = "running", time.monotonic()
                        job.keep()
                        return job
                self._changed.wait()

    def _serve(self) -> None:
        while (job := self._next()) is not None:
            try:
                self._follow(job)
            except Exception as error:
                with self._changed:
                    job.state, job.words = "failed", f"the process could not be started: {error}"
            job.ended = time.monotonic()
            if not self._closed:  # else it is reported as ended with the app when the next one starts
                job.keep()

    def _follow(self, job: Job) -> None:
        with self._changed:
            job.stop = self._context.Event()
            if job.asked:
                job.stop.set()
        pipe, far = self._context.Pipe()
        job.process = self._context.Process(target=self._target, args=(far, job.stop, job.order, self._run))
        job.process.start()
        far.close()
        outcome: tuple[Any, ...] | None = None
        try:
            while outcome is None:
                ready = wait([pipe], timeout=0.1)
                if job.asked and time.monotonic() - job.asked > GRACE:
                    break
                if not ready:
                    if self._closed:
                        break
                    continue
                heard = pipe.recv()
                if heard[0] == "progress":
                    _, job.stage, job.fraction, job.left = heard
                else:
                    outcome = heard
        except (EOFError, OSError):
            pass
        finally:
            pipe.close()
            _end(job.process, 5.0 if outcome else 0.0)
        with self._changed:
            _conclude(job, outcome)


def _end(process: Any, patience: float) -> None:
    process.join(patience)
    for how in (process.terminate, process.kill):
        if process.is_alive():
            how()
            process.join(0.3)
    with contextlib.suppress(Exception):
        process.join(0.5)


def _conclude(job: Job, outcome: tuple[Any, ...] | None) -> None:
    if outcome is not None and outcome[0] == "done":
        _, status, message, verdict = outcome
        partial = status == "interrupted" or job.asked > 0.0
        job.state = "cancelled" if partial else "done"
        words = "partial results were written" if partial else message or status.replace("_", " ")
        job.words, job.fraction = "; ".join(filter(None, (words, verdict))), 1.0
    elif job.asked:
        kept = "; the cases that ended are kept, and it continues from there" if job.order.kind == "study" else ""
        job.state, job.words = "cancelled", f"cancelled before there was a result{kept}"
    elif outcome is not None:
        job.state, job.words = "failed", str(outcome[1])
    else:
        code = job.process.exitcode
        how = f"signal {-code}" if isinstance(code, int) and code < 0 else f"exit code {code}"
        job.state, job.words = "lost", f"the process of this job was ended from outside ({how}); start it again"
