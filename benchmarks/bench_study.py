"""What a study costs besides its cases: overhead, two processes, a scheduler of a thousand workers.

Prints JSON lines. Everything is a ratio within this run: to the cases themselves, or to the rate that a thousand
workers would ask for.

    OMP_NUM_THREADS=1 python benchmarks/bench_study.py
    OMP_NUM_THREADS=1 python benchmarks/bench_study.py --workers 2 10 100 200

With ``--workers`` only the scheduler is measured: so many worker objects, all in one other process, connect to it as
workers on other machines would, and are given trivial cases. What they compute does not count; what scheduler and
client need does. Every worker holds a dozen sockets: some hundreds fit into one process on an idle machine.
"""

from __future__ import annotations

import argparse
import json
import resource
import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import Any

import xarray as xr

from moyai.core.results import Result
from moyai.study.execute import run_study
from moyai.study.plan import Study, load_study

ROOT = Path(__file__).resolve().parents[1]

TEXT = """\
moyai: 1
study:
  title: benchmark
  base: {base}
  set: {{analyses: [frequency], site.water_levels: {{SWL: 0 m}}}}
  variations:
    - grid: {{'waves[design storm].significant_height': {heights}}}
    - seeds: {{path: 'waves[design storm].seed', count: {seeds}}}
"""


def study_of(folder: Path, heights: int, seeds: int) -> Study:
    """Return a study of the pontoon with so many cases."""
    path = folder / "study.yaml"
    values = [f"{0.3 + 0.5 * number / heights:.6f} m" for number in range(heights)]
    path.write_text(TEXT.format(base=ROOT / "examples" / "pontoon.yaml", heights=values, seeds=seeds), encoding="utf-8")
    return load_study(path)


def _result() -> Result:
    return Result(xr.DataTree.from_dict({"/": xr.Dataset(), "/SWL": xr.Dataset({"x": ((), 1.0, {"units": "1"})})}))


def trivial(case: Any, progress: Any) -> Result:
    """Do nothing."""
    return _result()


def busy(case: Any, progress: Any) -> Result:
    """Use a second of processor time."""
    until = time.process_time() + 1.0
    while time.process_time() < until:
        pass
    return _result()


def timed(study: Study, run: Any, workers: int, on: Any = None) -> tuple[float, float]:
    """Return wall and processor seconds of a study, its folder new."""
    folder = Path(tempfile.mkdtemp())
    wall, cpu = time.perf_counter(), time.process_time()
    result = run_study(study, folder, run, workers=workers, on=on)
    assert result.status == "converged", result.message
    out = time.perf_counter() - wall, time.process_time() - cpu
    shutil.rmtree(folder)
    return out


_CALM = {f"distributed.worker.memory.{word}": False for word in ("target", "spill", "pause", "terminate")} | {
    "distributed.worker.profile.enabled": False,
    "distributed.admin.system-monitor.interval": "60s",
    "distributed.comm.timeouts.connect": "120s",
    "distributed.scheduler.worker-ttl": None,
}


def serve(address: str, count: int) -> None:
    """Be so many workers of a scheduler, until it is gone."""
    import asyncio

    import dask
    from distributed import Worker

    async def work() -> None:
        crew = [Worker(address, nthreads=1, memory_limit=0, dashboard=False) for _ in range(count)]
        for start in range(0, count, 50):
            await asyncio.gather(*crew[start : start + 50])
        await asyncio.gather(*(one.finished() for one in crew))

    with dask.config.set(_CALM):
        asyncio.run(work())


def scale(counts: list[int]) -> None:
    """Run trivial cases through a scheduler with growing numbers of workers and print what each costs centrally."""
    import dask
    from distributed import Client, LocalCluster

    folder = Path(tempfile.mkdtemp())
    for count in counts:
        # Enough cases for every worker to be served twice or more
        study = study_of(folder, 40, max(25, count // 20))
        with (
            dask.config.set(_CALM),
            LocalCluster(n_workers=0, dashboard_address=None, processes=True) as cluster,
            Client(cluster) as client,
        ):
            address = cluster.scheduler_address
            started = time.perf_counter()
            crew = subprocess.Popen([sys.executable, __file__, "--serve", address, str(count)])
            try:
                client.wait_for_workers(count, timeout=400)
                ready = time.perf_counter() - started
                cpu = time.process_time()
                time.sleep(10.0)
                idle = (time.process_time() - cpu) / 10.0
                # Scheduler and client alone live in this process: what it uses is what every case costs centrally
                wall, used = timed(study, trivial, 1, on=client)
            finally:
                crew.terminate()
                crew.wait()
        each = used / len(study.cases)
        print(
            json.dumps(
                {
                    "what": "trivial cases through a scheduler", "workers": count, "cases": len(study.cases),
                    "wall_s": wall, "central_ms_a_case": 1e3 * each, "idle_share_of_a_core": idle,
                    "least_seconds_a_case_that_keep_them_busy": count * each / (1.0 - min(idle, 0.99)),
                    "start_of_the_workers_s": ready,
                    "memory_of_scheduler_and_client_gb": resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1e6,
                }
            ),
            flush=True,
        )  # fmt: skip


def main() -> None:
    """Run and print."""
    parser = argparse.ArgumentParser(description="What a study costs besides its cases.")
    parser.add_argument("--workers", type=int, nargs="+", help="Measure the scheduler with so many workers instead.")
    parser.add_argument("--serve", nargs=2, metavar=("ADDRESS", "COUNT"), help=argparse.SUPPRESS)
    chosen = parser.parse_args()
    if chosen.serve:
        serve(chosen.serve[0], int(chosen.serve[1]))
        return
    if chosen.workers:
        scale(chosen.workers)
        return
    folder = Path(tempfile.mkdtemp())
    study = study_of(folder, 40, 25)
    _, cpu = timed(study, trivial, 1)
    each = cpu / len(study.cases)
    print(json.dumps({"what": "processor time a case beside the case itself, one process", "milliseconds": 1e3 * each,
                      "share_of_a_case_of_one_second": each}))  # fmt: skip
    wall, cpu = timed(study, trivial, 2)
    print(json.dumps({"what": "trivial cases through two processes", "cases_a_second": len(study.cases) / wall,
                      "milliseconds_of_the_parent_a_case": 1e3 * cpu / len(study.cases),
                      "least_seconds_a_case_that_keep_1000_processes_busy": 1e3 * cpu / len(study.cases)}))  # fmt: skip
    small = study_of(folder, 6, 4)
    hundred = study_of(folder, 20, 5)
    one, _ = timed(hundred, busy, 1)
    two, _ = timed(hundred, busy, 2)
    print(json.dumps({"what": "100 cases of one second", "one_process_s": one, "two_processes_s": two,
                      "efficiency": one / (2 * two), "note": "start of the processes included"}))  # fmt: skip
    try:
        from distributed import LocalCluster
    except ImportError:
        print(json.dumps({"what": "dask", "skipped": "dask.distributed is not installed"}))
    else:
        # The scheduler and the client live in this process, the workers in others: its processor time is what every
        # case costs centrally, however many workers there are
        with LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as cluster:
            timed(small, trivial, 1, on=cluster)
            _, cpu = timed(study, trivial, 1, on=cluster)
        central = cpu / len(study.cases)
        print(json.dumps({"what": "trivial cases through a Dask scheduler", "central_ms_a_case": 1e3 * central,
                          "cases_a_second_at_most": 1.0 / central,
                          "least_seconds_a_case_that_keep_1000_workers_busy": 1000.0 * central}))  # fmt: skip
    from moyai.cli.runner import run

    seas = study_of(folder, 12, 1)
    timed(seas, run, 1)
    _, cpu = timed(seas, run, 1)
    each = cpu / len(seas.cases)
    print(json.dumps({"what": "sea state of the pontoon, frequency domain", "seconds_a_case": each,
                      "minutes_for_10000_on_two_processes": each * 10_000 / 2 / 60}))  # fmt: skip


if __name__ == "__main__":
    main()
