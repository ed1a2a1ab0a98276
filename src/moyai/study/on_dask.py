"""A thin adapter to a Dask cluster: the same study, unchanged, on other machines."""

from __future__ import annotations

import gc
import pickle
import uuid
import zlib
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from functools import lru_cache
from itertools import islice
from typing import Any

from moyai.core.errors import InputError
from moyai.study.axes import Combination
from moyai.study.ledger import LedgerRecord
from moyai.study.local import THREADS
from moyai.study.work import Task, run_case

_FLIGHT = 4
_CONNECT = 10.0
_ASK = 1.0
_ASKS = 100.0
"""Every task asks the scheduler once a second whether the study was stopped; many of them more rarely, so that no more
than a hundred questions come a second."""
_LOST = frozenset({"ClosedClientError", "CommClosedError", "FutureCancelledError", "FuturesCancelledError"})
"""Errors of the client whose scheduler is gone; their modules differ between versions of dask."""
_POST = 100_000
"""Bytes of a record above which it is fetched from its worker instead of being posted by the scheduler."""


def run_on_dask(task: Task, cases: tuple[Combination, ...], on: Any) -> Iterator[LedgerRecord]:
    """Run the cases on a cluster; records come in the order in which they finish.

    Only a few cases a worker are in flight at a time, so that neither the scheduler nor this process ever holds the
    whole study. A case whose worker died is tried again by the scheduler; one that kills its worker again and again
    becomes a failed record.

    Parameters
    ----------
    task : Task
    cases : tuple of Combination
    on : str or dask cluster or client
        ``dask://host:port``, a cluster object, or a client.

    Raises
    ------
    InputError
        When dask.distributed is absent, nobody answers at the address, or there is no worker.
    """
    with _client(on) as client:
        from distributed import Event, as_completed

        name = f"moyai-{uuid.uuid4().hex[:12]}"
        cancel = Event(f"{name}-cancel", client=client)
        threads = max(1, sum(client.nthreads().values()))
        room, pause = _FLIGHT * threads, max(_ASK, threads / _ASKS)
        # In every case, not scattered: cases that hang on common data crowd onto the workers that hold them, and
        # each worker would have to be brought a copy by a connection of its own before the first case
        study = _Study(_packed(task), name, pause)
        waiting = iter(cases)
        jobs: dict[Any, Combination] = {}
        posted: dict[int, bytes] = {}
        client.subscribe_topic(name, lambda event: posted.__setitem__(*event[1]))

        def submit(count: int) -> list[Any]:
            chosen = list(islice(waiting, count))
            if not chosen:
                return []
            # One graph for all of them, one group: the scheduler keeps those that no worker has room for itself
            keys = [(name, case.index) for case in chosen]
            jobs.update(zip(keys, chosen, strict=True))
            return list(client.map(_run, [study] * len(chosen), chosen, key=keys, pure=False, retries=0))

        futures = as_completed(submit(room), loop=client.loop)
        # Records are many small objects, kept: each time their number has grown by a quarter, everything that was
        # imported would be searched for garbage too, which takes longer than to read them
        gc.freeze()
        try:
            for ready in futures.batches():
                # No more than one a worker at once, so that little is lost when this process ends meanwhile
                for start in range(0, len(ready), threads):
                    batch = ready[start : start + threads]
                    futures.update(submit(len(batch)))
                    yield from _records(client, [(future, jobs.pop(future.key)) for future in batch], posted)
        finally:
            gc.unfreeze()
            # Cancelling a future does not stop a task that runs: the tasks look at this flag
            try:
                if jobs:
                    cancel.set()
                    client.cancel(list(jobs), force=True)
                client.unsubscribe_topic(name)
            except Exception:
                # The scheduler itself may be gone; there is nothing left to cancel then
                pass


@dataclass(frozen=True)
class _Study:
    """What goes to the workers with every case: the packed task, the name of the run, the pause between questions."""

    packed: bytes
    name: str
    pause: float


def _packed(task: Task) -> bytes:
    # As dask does it: by value, too, what workers cannot import
    from distributed.protocol.pickle import dumps

    return zlib.compress(dumps(task), 1)


@lru_cache(maxsize=4)
def _task(packed: bytes) -> Task:
    """Return the task, unpacked once a worker."""
    task = pickle.loads(zlib.decompress(packed))
    assert isinstance(task, Task)
    return task


def _records(client: Any, ended: list[tuple[Any, Combination]], posted: dict[int, bytes]) -> Iterator[LedgerRecord]:
    """Return the records of cases that ended: as posted, and what did not come by post from the workers themselves."""
    missing = [future for future, case in ended if future.status == "finished" and case.index not in posted]
    found = client.gather({future.key: future for future in missing}, errors="skip") if missing else {}
    for future, combination in ended:
        letter = posted.pop(combination.index, None)
        record = found.get(future.key) if letter is None else pickle.loads(letter)
        if record is not None:
            yield record
        elif future.status in ("cancelled", "lost"):
            # The case did not fail: whoever knew of it is gone. Without a record it is run again
            raise _lost_scheduler()
        elif future.status != "finished":
            yield LedgerRecord(combination.index, "failed", f"the cluster gave it up: {future.exception()}", 0.0, {})
    # All of them in the client's own thread: from here each would wake it up once
    client.loop.add_callback(_release, [future for future, _ in ended])


def _release(futures: list[Any]) -> None:
    for future in futures:
        future.release()


def _run(study: _Study, combination: Combination) -> LedgerRecord | None:
    """Run one case on a worker of the cluster."""
    import os

    # One thread a task, whatever the cluster's environment says; read by numpy only where it is not loaded yet
    for name in THREADS:
        os.environ.setdefault(name, "1")
    record = run_case(_task(study.packed), combination, _flag(f"{study.name}-cancel", study.pause))
    if record is not None:
        _post(study.name, record)
    return record


def _post(name: str, record: LedgerRecord) -> None:
    """Send a record on the stream that the worker has to the scheduler anyway, which hands it on at once.

    To fetch results from a thousand workers costs a connection to each of them; only what is too large for the post,
    or got lost in it, is fetched.
    """
    from distributed import get_worker

    letter = _letter(record)
    if len(letter) <= _POST:
        get_worker().log_event(name, (record.index, letter))


def _letter(record: LedgerRecord) -> bytes:
    """Return a record as it is posted: not compressed, since a thousand workers pack, but one process unpacks."""
    return pickle.dumps(record)


def _flag(name: str, pause: float) -> Any:
    """Return a function that asks the scheduler at most once in ``pause`` seconds whether the study was stopped."""
    import time

    from distributed import Event, get_client

    state: dict[str, Any] = {"asked": time.monotonic(), "set": False, "event": None}

    def cancelled() -> bool:
        now = time.monotonic()
        if not state["set"] and now - state["asked"] > pause:
            state["asked"] = now
            # Short cases never ask: neither a client nor a word to the scheduler for them
            if state["event"] is None:
                state["event"] = Event(name, client=get_client())
            state["set"] = bool(state["event"].is_set())
        return bool(state["set"])

    return cancelled


@contextmanager
def _client(on: Any) -> Iterator[Any]:
    """Give a client of the cluster, closed afterwards if it was made here."""
    try:
        from distributed import Client
    except ImportError:
        raise InputError(
            "running on a cluster needs dask.distributed", path="on", remedy='pip install "moyai[cluster]"'
        ) from None
    if isinstance(on, Client):
        client, ours = on, False
    else:
        address = _address(on) if isinstance(on, str) else on
        try:
            client, ours = Client(address, timeout=_CONNECT, set_as_default=False), True
        except (OSError, TimeoutError) as error:
            raise InputError(
                f"no scheduler answers at {on}: {type(error).__name__}",
                path="on",
                remedy="start one with 'dask scheduler --host HOST' (127.0.0.1 on one machine) and workers with "
                "'dask worker tcp://HOST:8786 --nthreads 1'",
            ) from None
    try:
        # Not the client's own note of the scheduler: it is renewed next to, without the workers
        if not client.nthreads():
            raise InputError(
                "the cluster has no workers",
                path="on",
                remedy="start some with 'dask worker tcp://HOST:8786 --nthreads 1'",
            )
        yield client
    except Exception as error:
        if type(error).__name__ in _LOST:
            raise _lost_scheduler() from error
        raise
    finally:
        if ours:
            client.close(timeout=5)


def _lost_scheduler() -> InputError:
    return InputError(
        "the connection to the scheduler of the cluster was lost",
        path="on",
        remedy="start the scheduler and its workers and give the same command again: it continues with the cases left",
    )


def _address(text: str) -> str:
    """Return the scheduler's address of ``dask://host:port``."""
    if not text.startswith("dask://") or ":" not in text[len("dask://") :]:
        raise InputError(f"'{text}' is no cluster", path="on", allowed="dask://host:port")
    host, _, port = text[len("dask://") :].rpartition(":")
    if not host or not port.isdecimal() or not 0 < int(port) < 65536:
        raise InputError(f"'{port}' is no port of a cluster", path="on", allowed="dask://host:port, such as :8786")
    return f"tcp://{host}:{port}"
