"""A thin adapter to a Dask cluster: the same study, unchanged, on other machines."""

from __future__ import annotations

import uuid
from collections.abc import Iterator
from contextlib import contextmanager
from itertools import islice
from typing import Any

from moyai.core.errors import InputError
from moyai.study.axes import Combination
from moyai.study.ledger import Record
from moyai.study.local import THREADS
from moyai.study.work import Task, run_case

_FLIGHT = 4
_CONNECT = 10.0
_ASK = 1.0
_ASKS = 100.0
"""Every task asks the scheduler once a second whether the study was stopped; many of them more rarely, so that no more
than a hundred questions come a second."""


def run_on_dask(task: Task, cases: tuple[Combination, ...], on: Any) -> Iterator[Record]:
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

        cancel = Event(f"moyai-cancel-{uuid.uuid4().hex[:12]}", client=client)
        # To every worker: the scheduler gives cases first to workers that hold what they need
        shared = client.scatter(task, broadcast=True, hash=False)
        waiting = iter(cases)
        jobs: dict[str, Combination] = {}

        threads = max(1, sum(client.nthreads().values()))
        room, pause = _FLIGHT * threads, max(_ASK, threads / _ASKS)

        def submit(combination: Combination) -> Any:
            future = client.submit(_run, shared, combination, cancel.name, pause, pure=False, retries=0)
            jobs[future.key] = combination
            return future

        futures = as_completed([submit(case) for case in islice(waiting, room)], loop=client.loop)
        try:
            for ready in futures.batches():
                # No more than one a worker at once, so that little is lost when this process ends meanwhile
                for start in range(0, len(ready), threads):
                    batch = ready[start : start + threads]
                    following = [submit(case) for case in islice(waiting, len(batch))]
                    futures.update(following)
                    yield from _records(client, [(future, jobs.pop(future.key)) for future in batch])
        finally:
            # Cancelling a future does not stop a task that runs: the tasks look at this flag
            if jobs:
                try:
                    cancel.set()
                    client.cancel(list(jobs), force=True)
                except Exception:
                    # The scheduler itself may be gone; there is nothing left to cancel then
                    pass


def _records(client: Any, ended: list[tuple[Any, Combination]]) -> Iterator[Record]:
    """Fetch the records of cases that ended in one go, since every question to the scheduler takes its way there."""
    finished = {future.key: future for future, _ in ended if future.status == "finished"}
    found = client.gather(finished, errors="skip") if finished else {}
    for future, combination in ended:
        record = found.get(future.key)
        if record is not None:
            yield record
        elif future.status != "finished":
            yield Record(combination.index, "failed", f"the cluster gave it up: {future.exception()}", 0.0, {})
        future.release()


def _run(task: Task, combination: Combination, flag: str, pause: float = _ASK) -> Record | None:
    """Run one case on a worker of the cluster."""
    import os

    # One thread a task, whatever the cluster's environment says; read by numpy only where it is not loaded yet
    for name in THREADS:
        os.environ.setdefault(name, "1")
    return run_case(task, combination, _flag(flag, pause))


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
                remedy="start one with 'dask scheduler' and workers with 'dask worker tcp://HOST:8786 --nthreads 1'",
            ) from None
    try:
        # Not the client's own note of the scheduler: it is renewed beside, without the workers
        if not client.nthreads():
            raise InputError(
                "the cluster has no workers",
                path="on",
                remedy="start some with 'dask worker tcp://HOST:8786 --nthreads 1'",
            )
        yield client
    finally:
        if ours:
            client.close(timeout=5)


def _address(text: str) -> str:
    """Return the scheduler's address of ``dask://host:port``."""
    if not text.startswith("dask://") or ":" not in text[len("dask://") :]:
        raise InputError(f"'{text}' is no cluster", path="on", allowed="dask://host:port")
    host, _, port = text[len("dask://") :].rpartition(":")
    if not host or not port.isdecimal() or not 0 < int(port) < 65536:
        raise InputError(f"'{port}' is no port of a cluster", path="on", allowed="dask://host:port, such as :8786")
    return f"tcp://{host}:{port}"
