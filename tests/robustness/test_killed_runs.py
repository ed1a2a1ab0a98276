"""``moyai run`` killed while it writes: what stands in the folder is whole and of one run."""

from __future__ import annotations

import random
import re
import subprocess
import sys
import time

import pytest

from moyai.core.results import read_result


def _cases(folder):
    import moyai

    # One regular wave: most of a run is its start and its files
    wave = {"name": "swell", "kind": "regular", "height": "1 m", "periods": [6.0], "heading_deg": 0}
    case = moyai.load_case(moyai.template("member")).replace("waves", wave)
    for title in ("first", "second"):
        (folder / f"{title}.yaml").write_text(case.replace("title", f"killed {title}").text, encoding="utf-8")


def _start(folder, title):
    command = [sys.executable, "-m", "moyai", "run", str(folder / f"{title}.yaml"), "-q", "-o", str(folder / "out")]
    return subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)


def _written(out):
    """Return what stands in the folder and when it was written."""
    return {(file.name, file.stat().st_mtime_ns) for file in out.iterdir()} if out.is_dir() else set()


def _until_files_change(running, out):
    """Wait until a run begins to write, or ends."""
    before = _written(out)
    while running.poll() is None:
        try:
            if _written(out) != before:
                return
        except FileNotFoundError:  # a file was renamed between the two looks
            return
        time.sleep(1e-3)


@pytest.mark.slow
def test_results_and_report_are_of_one_run_after_every_kill(tmp_path):
    seed = 5
    print(f"seed {seed}")
    drawn = random.Random(seed)
    _cases(tmp_path)
    out, ended, number = tmp_path / "out", 0, 0
    running = _start(tmp_path, "first")
    _until_files_change(running, out)
    began = time.monotonic()
    assert running.wait() == 0
    writing = time.monotonic() - began
    while ended < 3:
        assert number < 12, "of twelve runs fewer than three were still at work when they were killed"
        running = _start(tmp_path, ("second", "first")[number % 2])
        _until_files_change(running, out)
        began = time.monotonic()
        try:
            running.wait(timeout=writing * drawn.uniform(ended / 4.0, (ended + 2) / 4.0))
            writing = time.monotonic() - began  # the machine has become quicker
        except subprocess.TimeoutExpired:
            running.kill()
        ended += running.wait() != 0
        title = re.search(r"killed (first|second)", read_result(out / "results.nc").provenance["title"])[1]
        if (out / "report.html").exists():
            found = set(re.findall(r"killed (first|second)", (out / "report.html").read_text(encoding="utf-8")))
            assert found == {title}, number
        number += 1
    assert _start(tmp_path, "first").wait() == 0
    assert not list(out.rglob("*.partial"))
