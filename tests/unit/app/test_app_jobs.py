"""Jobs: one after the other, cancelled within seconds, told when killed, started again."""

from __future__ import annotations

import os
import signal
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from app_runs import deaf_work, quick_work

from moyai.app.job_process import Order
from moyai.app.jobs import GRACE, Job, Jobs


def order(folder: Path, name: str = "case.yaml") -> Order:
    return Order("run", name, folder / name, folder, folder / name, "")


def until(job: Job, *states: str, seconds: float = 15.0) -> float:
    started = time.monotonic()
    while job.state not in states:
        assert time.monotonic() - started < seconds, job
        time.sleep(0.01)
    return time.monotonic() - started


@pytest.fixture
def queue(request: pytest.FixtureRequest) -> Iterator[Any]:
    made: list[Jobs] = []

    def make(target: Any) -> Jobs:
        made.append(Jobs(print, target))
        return made[-1]

    yield make
    for one in made:
        one.close()


def test_jobs_run_one_after_the_other_and_stop_on_request(queue: Any, tmp_path: Path) -> None:
    jobs = queue(quick_work)
    first, second, third = (jobs.add(order(tmp_path, name)) for name in ("wait", "b.yaml", "c.yaml"))
    until(first, "running")
    assert (second.state, third.state) == ("waiting", "waiting")
    assert jobs.cancel(third.key).state == "cancelled"
    while not first.fraction:
        time.sleep(0.01)
    jobs.cancel(first.key)
    assert until(first, "cancelled") < GRACE + 1.0
    assert first.words.startswith("partial results were written")
    until(second, "done")
    record = jobs.records(tmp_path)[1]
    assert record["words"] == "all identities hold; holds"
    assert record["command"] == "moyai run b.yaml --output b.yaml"
    assert third.process is None


def test_a_deaf_job_is_ended_after_two_seconds(queue: Any, tmp_path: Path) -> None:
    jobs = queue(deaf_work)
    job = jobs.add(order(tmp_path))
    until(job, "running")
    while not job.fraction:
        time.sleep(0.01)
    jobs.cancel(job.key)
    assert GRACE - 0.2 < until(job, "cancelled") < GRACE + 1.5
    assert not job.process.is_alive()


@pytest.mark.skipif(not hasattr(signal, "SIGKILL"), reason="no SIGKILL here")
def test_a_killed_process_is_told_and_can_be_started_again(queue: Any, tmp_path: Path) -> None:
    jobs = queue(deaf_work)
    job = jobs.add(order(tmp_path))
    until(job, "running")
    while not job.fraction:
        time.sleep(0.01)
    os.kill(job.process.pid, signal.SIGKILL)
    until(job, "lost", seconds=3.0)
    assert "signal 9" in job.words
    again = jobs.again(job.key)
    until(again, "running")
    assert again.key == job.key and again.order == job.order


def test_results_never_go_where_something_is(queue: Any, tmp_path: Path) -> None:
    jobs = queue(quick_work)
    (tmp_path / "pile").mkdir()
    folder = jobs.folder_for(tmp_path, "pile")
    assert folder.name == "pile_2"
    jobs.add(Order("run", "pile.yaml", folder, tmp_path, tmp_path / "pile.yaml"))
    assert jobs.folder_for(tmp_path, "pile").name == "pile_3"
