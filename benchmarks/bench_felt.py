"""What a person waits for: processor seconds and elapsed time of the commands, first run (nothing compiled) and warm.

    python benchmarks/bench_felt.py
    python benchmarks/bench_felt.py --only pontoon curtain/dynamic --warm --keep folder
    python benchmarks/bench_felt.py --against benchmarks.json
    python -m moyai.core.shipped_kernels kernels examples/pontoon.yaml
    python benchmarks/bench_felt.py --kernels kernels

Every command runs in a process of its own, its children counted (user and system time). The first run has a fresh
folder for compiled kernels, the warm one is the second or a later run with that folder; "wheel" is the first run of a
wheel that brings its kernels. Seconds are shown, and their
ratio to a yardstick timed around each command (a fixed sum in plain Python, about a second), which takes out how busy
the machine is. ``--json`` writes the rows; ``--against`` prints them next to those of such a file.
"""

from __future__ import annotations

import argparse
import json
import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parents[1]
TEMPLATES = ROOT / "src" / "moyai" / "structures"
CASES = {
    "pontoon": ROOT / "examples" / "pontoon.yaml",
    "breakwater/dynamic_lines": ROOT / "examples" / "breakwater" / "dynamic_lines.yaml",
    "curtain/template": TEMPLATES / "curtain" / "template.yaml",
    "curtain/tidal_channel": ROOT / "examples" / "curtain" / "tidal_channel.yaml",
    "curtain/dynamic": ROOT / "examples" / "curtain" / "dynamic.yaml",
    "member/template": TEMPLATES / "member" / "template.yaml",
    "member/inclined_brace": ROOT / "examples" / "member" / "inclined_brace.yaml",
    "network/snap": ROOT / "examples" / "network" / "snap.yaml",
    "network/buoy": ROOT / "examples" / "network" / "buoy.yaml",
    "network/flume_box": ROOT / "examples" / "network" / "flume_box.yaml",
    "cage/flume_cage": ROOT / "examples" / "cage" / "flume_cage.yaml",
    "cage/circular_50m": ROOT / "examples" / "cage" / "circular_50m.yaml",
    "cage/grid_2x2": ROOT / "examples" / "cage" / "grid_2x2.yaml",
    "units/template": TEMPLATES / "units" / "template.yaml",
}
MOYAI = [sys.executable, "-m", "moyai"]
MEGABYTE = 1e6


def yardstick() -> float:
    """Return the processor time of a fixed sum [s]."""
    begin, total = time.process_time(), 0
    for number in range(12_000_000):
        total += number & 7
    return time.process_time() - begin


def timed(command: list[str], cache: Path, kernels: Path | None = None) -> tuple[float, float, float, int]:
    """Return processor time with children [s], elapsed time [s], largest memory [MB] and exit code of a command."""
    environment = {"OMP_NUM_THREADS": "1", **os.environ, "NUMBA_CACHE_DIR": str(cache), "MPLBACKEND": "Agg"}
    if kernels is not None:
        environment["MOYAI_COMPILED_KERNELS"] = str(kernels)
    begin = time.perf_counter()
    process = subprocess.Popen(command, env=environment, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    _, status, usage = os.wait4(process.pid, 0)
    process.returncode = os.waitstatus_to_exitcode(status)
    elapsed = time.perf_counter() - begin
    return usage.ru_utime + usage.ru_stime, elapsed, usage.ru_maxrss * 1024 / MEGABYTE, process.returncode


def measured(name: str, command: list[str], cache: Path, state: str, kernels: Path | None = None) -> dict[str, Any]:
    """Run a command between two yardsticks and return its row."""
    before = yardstick()
    seconds, elapsed, memory, code = timed(command, cache, kernels)
    unit = 0.5 * (before + yardstick())
    return {
        "command": name,
        "state": state,
        "seconds": round(seconds, 2),
        "elapsed": round(elapsed, 2),
        "ratio": round(seconds / unit, 2),
        "yardstick": round(unit, 3),
        "memory": round(memory),
        "exit": code,
    }


def rows(names: list[str], states: list[str], keep: Path, cache: Path | None, kernels: Path | None) -> Any:
    """Give a row for every command and state."""
    for name in names:
        file, folder = CASES[name], keep / name.replace("/", "_")
        run = [*MOYAI, "run", str(file), "--quiet", "-o", str(folder)]
        with tempfile.TemporaryDirectory() as fresh:
            place = cache if cache is not None else Path(fresh)
            for state in states:
                row = measured(name, run, place, state)
                page = folder / "report.html"
                yield {**row, "page": round(page.stat().st_size / MEGABYTE, 1) if page.is_file() else None}
            if kernels is not None:
                with tempfile.TemporaryDirectory() as empty:
                    yield measured(name, run, Path(empty), "wheel", kernels)
            if states == ["first", "warm"] and name == "pontoon":
                yield measured("check pontoon", [*MOYAI, "check", str(file)], place, "warm")
                yield measured("--help", [*MOYAI, "--help"], place, "warm")


def main() -> None:
    """Run and print."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--only", nargs="+", choices=list(CASES), default=list(CASES))
    parser.add_argument("--warm", action="store_true", help="warm runs alone, with the cache of the environment")
    parser.add_argument("--keep", type=Path, help="folder of the results")
    parser.add_argument("--cache", type=Path, help="folder of compiled kernels, used for warm runs alone")
    parser.add_argument(
        "--kernels", type=Path, help="folder of moyai.core.shipped_kernels: first runs of a wheel that brings it too"
    )
    parser.add_argument("--json", type=Path, help="file to write the rows to")
    parser.add_argument("--against", type=Path, help="rows of an earlier run on this machine")
    given = parser.parse_args()
    earlier = {}
    if given.against:
        earlier = {(row["command"], row["state"]): row for row in json.loads(given.against.read_text("utf-8"))}
    found = []
    head = f"{'command':<26}{'state':<7}{'seconds':>9}{'elapsed':>9}{'ratio':>8}{'memory':>9}{'page':>7}"
    print(head + (f"{'before':>9}{'ratio':>8}{'times':>7}" if earlier else ""), flush=True)
    with tempfile.TemporaryDirectory() as folder:
        states = ["warm"] if given.warm else ["first", "warm"]
        cache = given.cache if given.warm else None
        for row in rows(given.only, states, given.keep or Path(folder), cache, given.kernels):
            found.append(row)
            page = "" if row.get("page") is None else f"{row['page']:.1f}"
            line = (
                f"{row['command']:<26}{row['state']:<7}{row['seconds']:>9.2f}{row['elapsed']:>9.2f}{row['ratio']:>8.2f}"
            )
            line += f"{row['memory']:>9.0f}{page:>7}"
            if old := earlier.get((row["command"], row["state"])):
                line += f"{old['seconds']:>9.2f}{old['ratio']:>8.2f}{old['ratio'] / row['ratio']:>7.2f}"
            print(line + (f"  exit {row['exit']}" if row["exit"] else ""), flush=True)
    if given.json:
        given.json.write_text(json.dumps(found, indent=1), encoding="utf-8")


if __name__ == "__main__":
    main()
