"""How far a study scales on a cluster: a real scheduler, the real adapter, a thousand simulated workers.

    OMP_NUM_THREADS=1 python benchmarks/bench_study_scale.py --workers 10 100 300 1000
    OMP_NUM_THREADS=1 python benchmarks/bench_study_scale.py --workers 1000 --seconds 1 2 5 10

The scheduler (``dask scheduler`` as installed) and the simulated workers (:mod:`simulated_workers`) are processes of
their own; the study runs here as on any cluster. Prints JSON lines: processor time of scheduler and of client a case,
what the heartbeats of idle workers cost, and from which length of the cases on the centre keeps all workers busy. With
``--seconds`` cases last so long, and so is the efficiency on the wall clock: seconds of all cases over those of
all workers.
"""

from __future__ import annotations

import argparse
import json
import math
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import Any

import dask
import psutil
from bench_study import study_of, timed, trivial
from simulated_workers import SETTINGS

HERE = Path(__file__).resolve().parent
PER_PROCESS = 1000
"""Simulated workers a process."""


def real_record(folder: Path) -> Path:
    """Run one sea state of the pontoon and keep its record: what every simulated case gives."""
    from moyai.cli.runner import run
    from moyai.study.work import Task, run_case

    study = study_of(folder, 1, 1)
    record = run_case(Task(study.base, study.base_path.resolve(), study.wanted, None, run), study.cases[0])
    assert record is not None and record.status == "converged"
    file = folder / "record.json"
    file.write_text(record.line(), encoding="utf-8")
    return file


@contextmanager
def scheduler(folder: Path) -> Iterator[tuple[str, psutil.Process]]:
    """Start a scheduler in a process of its own and give its address."""
    file = folder / f"scheduler-{time.monotonic_ns()}.json"
    command = [sys.executable, "-m", "distributed.cli.dask_scheduler", "--host", "127.0.0.1", "--port", "0",
               "--no-dashboard", "--dashboard-address", ":0", "--scheduler-file", str(file)]  # fmt: skip
    process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    try:
        while not file.exists() or not file.read_text(encoding="utf-8").strip():
            time.sleep(0.1)
            assert process.poll() is None, "the scheduler did not start"
        yield json.loads(file.read_text(encoding="utf-8"))["address"], psutil.Process(process.pid)
    finally:
        process.kill()
        process.wait()


@contextmanager
def crew(address: str, count: int, record: Path) -> Iterator[list[subprocess.Popen[str]]]:
    """Start so many simulated workers."""
    with ExitStack() as stack:
        processes = []
        for number in range(0, count, PER_PROCESS):
            size = min(PER_PROCESS, count - number)
            command = [sys.executable, str(HERE / "simulated_workers.py"), address, str(size), str(record)]
            process = subprocess.Popen(command, stdin=subprocess.PIPE, text=True)
            stack.callback(process.wait)
            stack.callback(process.kill)
            processes.append(process)
        yield processes


def used(process: psutil.Process) -> float:
    """Return the processor seconds of a process so far."""
    times = process.cpu_times()
    return float(times.user + times.system)


def share_of_a_core() -> float:
    """Return which part of a core a busy thread gets here now: 1 on an idle machine."""
    wall, cpu = time.perf_counter(), time.process_time()
    while time.perf_counter() - wall < 2.0:
        pass
    return (time.process_time() - cpu) / (time.perf_counter() - wall)


def measure(count: int, lengths: list[float], rounds: int, record: Path, folder: Path) -> None:
    """Print what so many workers cost the centre, idle and at work."""
    from distributed import Client

    with dask.config.set(SETTINGS), scheduler(folder) as (address, centre), Client(address, timeout=60) as client:
        started = time.perf_counter()
        with crew(address, count, record) as processes:
            client.wait_for_workers(count, timeout=400)
            ready, start = time.perf_counter() - started, used(centre)
            time.sleep(3.0)
            before, clock, ours = used(centre), time.perf_counter(), time.process_time()
            time.sleep(12.0)
            passed = time.perf_counter() - clock
            idle, idle_client = (used(centre) - before) / passed, (time.process_time() - ours) / passed
            tell(
                {
                    "what": "idle workers", "workers": count, "start_s": ready, "start_scheduler_s": start,
                    "scheduler_share_of_a_core": idle, "client_share_of_a_core": idle_client,
                    "memory_of_the_scheduler_gb": centre.memory_info().rss / 1e9,
                }
            )  # fmt: skip
            for seconds in lengths:
                for process in processes:
                    assert process.poll() is None and process.stdin is not None, "the simulated workers are gone"
                    process.stdin.write(f"{seconds}\n")
                    process.stdin.flush()
                # Trivial cases: enough to serve every worker twice; others: so many rounds of all workers
                wanted = rounds * count if seconds > 0.0 else max(1000, 2 * count)
                at_work(client, centre, folder, count, seconds, wanted, idle)


def at_work(
    client: Any, centre: psutil.Process, folder: Path, count: int, seconds: float, wanted: int, idle: float
) -> None:
    """Run a study and print what a case cost."""
    study = study_of(folder, 40, math.ceil(wanted / 40))
    share = share_of_a_core()
    cases, before = len(study.cases), used(centre)
    wall, ours = timed(study, trivial, 1, on=client)
    theirs = used(centre) - before
    line = {
        "what": "cases through the scheduler", "workers": count, "seconds_a_case": seconds, "cases": cases,
        "wall_s": wall, "cases_a_second": cases / wall, "share_of_a_core_for_a_busy_thread": share,
        # The heartbeats go on meanwhile; they are reported on their own
        "scheduler_ms_a_case": 1e3 * max(theirs - idle * wall, 0.0) / cases, "client_ms_a_case": 1e3 * ours / cases,
        "memory_of_the_scheduler_gb": centre.memory_info().rss / 1e9,
    }  # fmt: skip
    # Scheduler and client work side by side: the slower one says how many cases a second the centre can serve
    most = min((1.0 - min(idle, 0.99)) / max(line["scheduler_ms_a_case"], 1e-9), 1.0 / line["client_ms_a_case"]) * 1e3
    line |= {"cases_a_second_at_most": most, "least_seconds_a_case_that_keep_them_busy": count / most}
    if seconds > 0.0:
        line["efficiency"] = math.ceil(cases / count) * seconds / wall
    tell(line)


def tell(line: dict[str, Any]) -> None:
    """Print one line of JSON."""
    print(
        json.dumps({key: round(value, 5) if isinstance(value, float) else value for key, value in line.items()}),
        flush=True,
    )


def main() -> None:
    """Run and print."""
    parser = argparse.ArgumentParser(description="How far a study scales on a cluster.")
    parser.add_argument("--workers", type=int, nargs="+", default=[10, 100, 300, 1000])
    parser.add_argument("--seconds", type=float, nargs="+", default=[0.0], help="Length of the cases; 0 is trivial.")
    parser.add_argument("--rounds", type=int, default=4, help="Cases a worker, where they have a length.")
    chosen = parser.parse_args()
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        record = real_record(folder)
        tell({"what": "record of a case", "kilobytes": record.stat().st_size / 1e3})
        for count in chosen.workers:
            measure(count, chosen.seconds, chosen.rounds, record, folder)


if __name__ == "__main__":
    main()
