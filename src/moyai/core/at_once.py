"""Independent parts of a run on all cores, in threads: kernels and array operations leave the interpreter free."""

from __future__ import annotations

import os
import threading
from collections.abc import Callable
from contextvars import copy_context
from queue import Empty, SimpleQueue

from moyai.core.progress import Progress

#: Seconds between two looks at parts that report nothing.
_LOOK = 0.1


def threads() -> int:
    """Return how many parts run at a time: the cores that this process may use, or ``MOYAI_THREADS``; 1 in a thread."""
    if threading.current_thread() is not threading.main_thread():
        return 1
    given = os.environ.get("MOYAI_THREADS", "")
    if given.isdigit():
        return max(1, int(given))
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def at_once(work: Callable[[int, Progress], None], count: int, progress: Progress) -> None:
    """Do ``count`` parts, so many at a time as there are cores.

    The listener is called from the thread that calls this. Where it raises, or Ctrl-C comes, every part is stopped by
    a KeyboardInterrupt out of its own listener, and the exception goes on when all have ended.

    Parameters
    ----------
    work : callable
        Takes the number of a part and its listener.
    count : int
        Number of parts.
    progress : Progress
        Called with what the parts report.

    Raises
    ------
    Exception
        What the first of the parts raised, in their order; parts behind it are stopped.
    """
    reports: SimpleQueue[tuple[str, float, float]] = SimpleQueue()
    failed: dict[int, BaseException] = {}
    stopped = [threading.Event() for _ in range(count)]
    waiting, guard = iter(range(count)), threading.Lock()

    def stop(first: int) -> None:
        for event in stopped[first:]:
            event.set()

    def heard(number: int) -> Progress:
        def listen(what: str, done: float, total: float) -> None:
            if stopped[number].is_set():
                raise KeyboardInterrupt
            reports.put((what, done, total))

        return listen

    def go() -> None:
        while True:
            with guard:
                number = next(waiting, None)
            if number is None:
                return
            try:
                work(number, heard(number))
            except BaseException as error:
                failed[number] = error
                stop(number + 1)

    pool = [
        threading.Thread(target=copy_context().run, args=(go,), name="part of a run", daemon=True)
        for _ in range(min(count, threads()))
    ]
    for each in pool:
        each.start()
    try:
        while any(each.is_alive() for each in pool):
            try:
                progress(*reports.get(timeout=_LOOK))
            except Empty:
                continue
        while not reports.empty():
            progress(*reports.get())
    except BaseException:
        stop(0)
        for each in pool:
            each.join()
        raise
    if failed:
        raise failed[min(failed)]
