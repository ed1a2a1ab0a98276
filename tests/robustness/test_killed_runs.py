"""``moyai run`` killed at random times: what stands in the folder is whole and of one run."""

from __future__ import annotations

import math
import random
import re
import subprocess
import sys
import time

import pytest

from moyai.core.results import read_result


def _cases(folder):
    import moyai

    # One regular wave: most of a run is its start and its files, which is where it is to be killed
    wave = {"name": "swell", "kind": "regular", "height": "1 m", "periods": [6.0], "heading_deg": 0}
    case = moyai.load_case(moyai.template("member")).replace("waves", wave)
    for title in ("first", "second"):
        (folder / f"{title}.yaml").write_text(case.replace("title", f"killed {title}").text, encoding="utf-8")


def _start(folder, title):
    command = [sys.executable, "-m", "moyai", "run", str(folder / f"{title}.yaml"), "-q", "-o", str(folder / "out")]
    return subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)


@pytest.mark.slow
def test_results_and_report_are_of_one_run_after_every_kill(tmp_path):
    seed = 5
    print(f"seed {seed}")
    drawn = random.Random(seed)
    _cases(tmp_path)
    whole = math.inf
    for _ in range(2):  # the first may compile
        began = time.monotonic()
        assert _start(tmp_path, "first").wait() == 0
        whole = min(whole, time.monotonic() - began)
    out, ended = tmp_path / "out", 0
    for number in range(16):
        running = _start(tmp_path, ("second", "first")[number % 2])
        # Most kills fall into the second half, where files are written
        began = time.monotonic()
        try:
            running.wait(timeout=whole * drawn.uniform(0.5 if number % 3 else 0.0, 1.05))
            whole = min(whole, time.monotonic() - began)  # a machine that has become faster
        except subprocess.TimeoutExpired:
            running.kill()
        ended += running.wait() != 0
        title = re.search(r"killed (first|second)", read_result(out / "results.nc").provenance["title"])[1]
        if (out / "report.html").exists():
            found = set(re.findall(r"killed (first|second)", (out / "report.html").read_text(encoding="utf-8")))
            assert found == {title}, number
    assert ended >= 8
    assert _start(tmp_path, "first").wait() == 0
    assert not list(out.rglob("*.partial"))
