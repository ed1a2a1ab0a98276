"""Independent parts of a run on all cores, in threads: kernels and array operations leave the interpreter free."""

from __future__ import annotations

import os
import threading
from collections.abc import Callable, Iterator, Sequence
from contextvars import copy_context
from queue import Empty, SimpleQueue
from typing import TypeVar

from moyai.core.progress import Progress, silent

#: Seconds between two looks for Ctrl-C while the parts report nothing.
_LOOK = 0.1
#: Items a core that are done before they are taken.
_AHEAD = 4
Item = TypeVar("Item")
Found = TypeVar("Found")


class _Cores:
    """The cores of a run, one for each part at work; a part that waits for parts of its own leaves its core to them."""

    def __init__(self, count: int) -> None:
        self.count, self.free = count, threading.Semaphore(count)


class _Thread(threading.local):
    """What a thread works with: the cores of the run of which it does a part."""

    cores: _Cores | None = None


_THREAD = _Thread()


def threads() -> int:
    """Return how many parts may run at a time: the cores that this process may use, or ``MOYAI_THREADS``.

    Parts of parts share the same cores; in a thread that does no part it is 1.
    """
    if _THREAD.cores is not None:
        return _THREAD.cores.count
    if threading.current_thread() is not threading.main_thread():
        return 1
    given = os.environ.get("MOYAI_THREADS", "")
    if given.isdigit():
        return max(1, int(given))
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def at_once(work: Callable[[int, Progress], None], count: int, progress: Progress) -> None:
    """Do ``count`` parts, so many at a time as there are cores.

    The listener is called from the thread that calls this. Where it raises, or Ctrl-C comes, every part is stopped by
    a KeyboardInterrupt out of its own listener, and the exception continues when all have ended.

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
    reports: SimpleQueue[tuple[str, float, float] | None] = SimpleQueue()  # None: a thread has ended
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

    cores, is_part = _THREAD.cores or _Cores(threads()), _THREAD.cores is not None
    size = min(count, cores.count)

    def go() -> None:
        _THREAD.cores = cores
        while True:
            with guard:
                number = next(waiting, None)
            if number is None:
                reports.put(None)
                return
            try:
                with cores.free:
                    if not stopped[number].is_set():
                        work(number, heard(number))
            except BaseException as error:
                failed[number] = error
                stop(number + 1)

    pool = [
        threading.Thread(target=copy_context().run, args=(go,), name="part of a run", daemon=True) for _ in range(size)
    ]
    if is_part:
        cores.free.release()
    try:
        for each in pool:
            each.start()
        running = size
        while running:
            try:
                report = reports.get(timeout=_LOOK)
            except Empty:
                continue
            if report is None:
                running -= 1
            else:
                progress(*report)
    except BaseException:
        stop(0)
        for each in pool:
            if each.ident is not None:
                each.join()
        raise
    finally:
        if is_part:
            cores.free.acquire()
    if failed:
        raise failed[min(failed)]


def each_at_once(
    work: Callable[[Item, Progress], Found], items: Sequence[Item], progress: Progress = silent
) -> list[Found]:
    """Return what ``work`` gives for every item, in their order; see :func:`at_once`.

    Parameters
    ----------
    work : callable
        Takes an item and its listener.
    items : sequence
    progress : Progress
    """
    if len(items) < 2 or threads() < 2:
        return [work(item, progress) for item in items]
    found: dict[int, Found] = {}

    def one(number: int, heard: Progress) -> None:
        found[number] = work(items[number], heard)

    at_once(one, len(items), progress)
    return [found[number] for number in range(len(items))]


def one_after_the_other(
    work: Callable[[Item, Progress], Found], items: Sequence[Item], words: str, progress: Progress = silent
) -> Iterator[Found]:
    """Yield what ``work`` gives for every item, in their order, so many items at a time as there are cores.

    What ended before a run is stopped, or before an item fails, is yielded; then the exception continues.

    Parameters
    ----------
    work : callable
        Takes an item and its listener.
    items : sequence
    words : str
        What is counted.
    progress : Progress
        Called with the number of items that are done.
    """
    progress(words, 0, len(items))
    if len(items) < 2 or threads() < 2:
        for number, item in enumerate(items, 1):
            yield work(item, progress)
            progress(words, number, len(items))
        return
    # what is not taken yet is held: not all of many
    size = _AHEAD * threads()
    for first in range(0, len(items), size):
        found: dict[int, Found] = {}
        failed: BaseException | None = None

        def one(number: int, heard: Progress, first: int = first, found: dict[int, Found] = found) -> None:
            found[number] = work(items[first + number], heard)
            heard(words, first + len(found), len(items))

        try:
            at_once(one, min(size, len(items) - first), progress)
        except BaseException as error:
            failed = error
        for number in range(len(found)):
            if number not in found:
                break
            yield found[number]
        if failed is not None:
            raise failed


def each_counted(
    words: str, work: Callable[[Item, Progress], Found], items: Sequence[Item], progress: Progress = silent
) -> list[Found]:
    """Return what ``work`` gives for every item, see :func:`each_at_once`, and report how many are done.

    Parameters
    ----------
    words : str
        What is counted.
    work : callable
        Takes an item and its listener.
    items : sequence
    progress : Progress
    """
    done, guard = iter(range(1, len(items) + 1)), threading.Lock()

    def one(item: Item, heard: Progress) -> Found:
        found = work(item, heard)
        with guard:
            heard(words, next(done), len(items))
        return found

    progress(words, 0, len(items))
    return each_at_once(one, items, progress)
