"""What a study costs besides its cases: overhead, two processes, a scheduler.

Prints JSON lines. Everything is a ratio within this run: to the cases themselves, or to the rate that a thousand
workers would ask for.

    OMP_NUM_THREADS=1 python benchmarks/bench_study.py

What a thousand workers ask of a scheduler is measured by bench_study_scale.py.
"""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import Any

import xarray as xr

from moyai.core.results import Result
from moyai.study.definition import Study
from moyai.study.execute import run_study
from moyai.study.plan import load_study

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


def from_the_command(folder: Path, temporary: str) -> float:
    """Return the seconds that pass for a study of 12 sea states on two processes, kernels compiled."""
    study_of(folder, 12, 1)
    (folder / temporary).mkdir(exist_ok=True)
    command = [sys.executable, "-m", "moyai", "study", str(folder / "study.yaml"), "-q", "--workers", "2"]
    began = time.perf_counter()
    subprocess.run([*command, "-o", str(folder / "out" / temporary)], check=True, stdout=subprocess.DEVNULL,
                   env=os.environ | {"TMPDIR": str(folder / temporary)})  # fmt: skip
    return time.perf_counter() - began


def main() -> None:
    """Run and print."""
    folder = Path(tempfile.mkdtemp())
    study = study_of(folder, 40, 25)
    _, cpu = timed(study, trivial, 1)
    each = cpu / len(study.cases)
    print(json.dumps({"what": "processor time a case next to the case itself, one process", "milliseconds": 1e3 * each,
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
    # workers are forked where the folder of temporary files has a short name, on Linux; else each imports by itself
    from_the_command(folder, "first")
    forked, spawned = (from_the_command(folder, name) for name in ("t", "t" * 80))
    print(json.dumps({"what": "12 sea states from the command line, two processes", "forked_s": forked,
                      "spawned_s": spawned, "ratio": forked / spawned}))  # fmt: skip
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
