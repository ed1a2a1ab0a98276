"""Workers of a Dask cluster that only speak: hundreds of them in one process, to see what a scheduler can serve.

A worker registers, listens at an address of its own, keeps its stream and its heartbeats, holds the results until they
are let go, and gives them to whoever asks: all messages of a worker of the installed ``distributed``, with the content
of a real one. What it does not do is compute: a case is answered after the seconds that it is said to last, with one
and the same record. For whoever talks to it (scheduler, client) there is no difference.

    python benchmarks/simulated_workers.py tcp://127.0.0.1:8786 250 record.json

Lines on standard input say how many seconds a case lasts from then on; the end of it ends the workers.
"""

from __future__ import annotations

import asyncio
import json
import os
import pickle
import sys
import time
from collections import deque
from dataclasses import replace
from pathlib import Path
from typing import Any

import dask
from distributed.batched import BatchedSend
from distributed.comm import CommClosedError, connect, listen
from distributed.protocol import to_serialize
from distributed.versions import get_versions

from moyai.study import on_dask
from moyai.study.ledger import LedgerRecord

SETTINGS = {"distributed.comm.timeouts.connect": "120s", "distributed.comm.timeouts.tcp": "300s"}
"""A machine that simulates a thousand others is slow to answer; nothing else differs from a cluster as installed."""


class SimulatedWorker:
    """One worker of one thread.

    Parameters
    ----------
    scheduler : str
        Its address.
    name : str
    record : Record
        What a case gives, its number set case by case.
    crew : dict
        What all workers of the process share; ``seconds`` is how long a case lasts.
    """

    def __init__(self, scheduler: str, name: str, record: LedgerRecord, crew: dict[str, float]) -> None:
        self.scheduler, self.name, self.record, self.crew = scheduler, name, record, crew
        self.stream = BatchedSend(interval="2ms")
        self.waiting: deque[dict[str, Any]] = deque()
        self.running: Any = None
        self.data: dict[Any, Any] = {}
        self.rest = 1.0
        self.address = ""

    async def work(self) -> None:
        """Register and answer until the scheduler is gone."""
        listener = await listen("tcp://127.0.0.1:0", self._serve)
        self.address = listener.contact_address
        comm = await connect(self.scheduler)
        await comm.write(
            {
                "op": "register-worker", "reply": False, "address": self.address, "status": "running", "nthreads": 1,
                "name": self.name, "now": time.time(), "resources": {}, "memory_limit": 4_000_000_000,
                "local_directory": f"/scratch/{self.name}", "services": {"dashboard": 8787}, "nanny": None,
                "pid": os.getpid(), "versions": VERSIONS, "metrics": self._metrics(), "extra": {},
                "stimulus_id": f"worker-connect-{time.time()}", "server_id": f"Worker-{self.name}",
            },
            serializers=["msgpack"],
        )  # fmt: skip
        answer = await comm.read(deserializers=["msgpack"])
        if answer["status"] != "OK":
            raise RuntimeError(f"the scheduler refused a simulated worker: {answer}")
        self.rest = answer["heartbeat-interval"]
        self.stream.start(comm)
        beating = asyncio.create_task(self._beat())
        try:
            while True:
                for message in await comm.read():
                    self._hear(message)
        except CommClosedError:
            pass
        finally:
            beating.cancel()
            listener.stop()

    def _hear(self, message: dict[str, Any]) -> None:
        """Follow one word of the scheduler on the stream."""
        what = message["op"]
        if what == "compute-task":
            missing = [key for key in message["who_has"] if key not in self.data]
            if missing:
                # A real worker fetches the common part of the cases from another one, once, and tells the scheduler
                self.data.update(dict.fromkeys(missing))
                self._say({"op": "add-keys", "keys": missing, "stimulus_id": f"fetched-{time.time()}"})
            self.waiting.append(message)
            self._next()
        elif what in ("free-keys", "remove-replicas"):
            for key in message["keys"]:
                self.data.pop(key, None)
            self.waiting = deque(task for task in self.waiting if task["key"] not in message["keys"])
        elif what == "steal-request":
            self._yield(message["key"], message["stimulus_id"])
        elif what == "close":
            raise CommClosedError("closed by the scheduler")

    def _next(self) -> None:
        """Begin the next case, if there is one and nothing else is at work."""
        if self.running is not None or not self.waiting:
            return
        self.running = self.waiting.popleft()
        started = time.time()
        loop = asyncio.get_running_loop()
        if self.crew["seconds"] > 0.0:
            loop.call_later(self.crew["seconds"], self._finish, started)
        else:
            loop.call_soon(self._finish, started)

    def _finish(self, started: float) -> None:
        """Say that the case is done."""
        task, self.running = self.running, None
        # As the adapter submits it: what all cases have in common, the case
        study, case = task["run_spec"].args
        record = replace(self.record, index=case.index)
        self.data[task["key"]] = record
        self._say({"op": "log-event", "topic": study.name, "msg": (case.index, on_dask._letter(record))})
        self._say(
            {
                "op": "task-finished", "key": task["key"], "run_id": task["run_id"], "status": "OK", "nbytes": 10_000,
                "type": TYPE, "typename": "moyai.study.ledger.Record", "metadata": {}, "thread": 1,
                "startstops": [{"action": "compute", "start": started, "stop": time.time()}],
                "stimulus_id": f"task-finished-{time.time()}",
            }
        )  # fmt: skip
        self._next()

    def _yield(self, key: Any, stimulus: str) -> None:
        """Give a case that was not begun back to the scheduler, for a worker with less to do."""
        held = [task for task in self.waiting if task["key"] == key]
        if held:
            self.waiting.remove(held[0])
            state: str | None = "ready"
        else:
            state = "executing" if self.running is not None and self.running["key"] == key else None
        self._say({"op": "steal-response", "key": key, "state": state, "stimulus_id": stimulus})

    def _say(self, message: dict[str, Any]) -> None:
        if not self.stream.closed():
            self.stream.send(message)

    async def _serve(self, comm: Any) -> None:
        """Answer whoever connects, question by question."""
        try:
            while True:
                asked = await comm.read()
                what = asked.pop("op")
                if what == "get_data":
                    data = {key: to_serialize(self.data[key]) for key in asked["keys"] if key in self.data}
                    await comm.write({"status": "OK", "data": data})
                    assert await comm.read() == "OK"
                    continue
                if what == "update_data":
                    self.data.update(asked["data"])
                    answer: Any = {"status": "OK", "nbytes": dict.fromkeys(asked["data"], 10000)}
                elif what == "gather":
                    # The copies that are sent from worker to worker cost neither scheduler nor client anything
                    self.data.update(dict.fromkeys(asked["who_has"]))
                    answer = {"status": "OK"}
                else:
                    answer = {"status": "OK"}
                if asked.get("reply", True):
                    await comm.write(answer)
        except (CommClosedError, OSError):
            pass

    async def _beat(self) -> None:
        """Send heartbeats as often as the scheduler wants them."""
        comm = await connect(self.scheduler)
        while True:
            await asyncio.sleep(self.rest)
            executing = {} if self.running is None else {self.running["key"]: 0.1}
            await comm.write(
                {
                    "op": "heartbeat_worker", "reply": True, "address": self.address, "now": time.time(),
                    "metrics": self._metrics(), "executing": executing, "extensions": {},
                }
            )  # fmt: skip
            self.rest = (await comm.read())["heartbeat-interval"]

    def _metrics(self) -> dict[str, Any]:
        """Return what a worker tells of itself; the figures mean nothing, their number is that of a real one."""
        return {
            "task_counts": {"memory": len(self.data), "executing": int(self.running is not None)},
            "bandwidth": {"total": 100_000_000, "workers": {}, "types": {}},
            "digests_total_since_heartbeat": {
                "latency": 0.01, "tick-duration": 1.0,
                ("execute", "_run", "thread-cpu", "seconds"): 0.5, ("execute", "_run", "thread-noncpu", "seconds"): 0.1,
                ("get-data", "memory-read", "count"): 1, ("get-data", "memory-read", "bytes"): 10_000,
                ("get-data", "network", "seconds"): 0.01, ("get-data", "serialize", "seconds"): 0.01,
            },
            "managed_bytes": 10_000, "spilled_bytes": {"memory": 0, "disk": 0},
            "transfer": {
                "incoming_bytes": 0, "incoming_count": 0, "incoming_count_total": 0, "outgoing_bytes": 0,
                "outgoing_count": 0, "outgoing_count_total": 0,
            },
            "event_loop_interval": 0.02, "cpu": 99.0, "memory": 300_000_000, "time": time.time(),
            "host_net_io": {"read_bps": 1000.0, "write_bps": 1000.0},
            "host_disk_io": {"read_bps": 0.0, "write_bps": 0.0}, "num_fds": 40,
        }  # fmt: skip


VERSIONS = get_versions()
TYPE = pickle.dumps(LedgerRecord)


async def crew_of(scheduler: str, count: int, record: LedgerRecord) -> None:
    """Be so many workers until standard input ends."""
    crew = {"seconds": 0.0}
    workers = [SimulatedWorker(scheduler, f"{os.getpid()}-{number}", record, crew) for number in range(count)]
    tasks = []
    for worker in workers:
        tasks.append(asyncio.create_task(worker.work()))
        # One after the other, as a queue of a cluster lets them in, not all in one moment
        await asyncio.sleep(0.005)
    lines = asyncio.StreamReader()
    await asyncio.get_running_loop().connect_read_pipe(lambda: asyncio.StreamReaderProtocol(lines), sys.stdin)
    while line := await lines.readline():
        crew["seconds"] = float(line)
        for task in tasks:
            if task.done() and task.exception() is not None:
                raise task.exception()  # type: ignore[misc]
    for task in tasks:
        task.cancel()


if __name__ == "__main__":
    with dask.config.set(SETTINGS):
        asyncio.run(
            crew_of(
                sys.argv[1], int(sys.argv[2]), LedgerRecord(**json.loads(Path(sys.argv[3]).read_text(encoding="utf-8")))
            )
        )
