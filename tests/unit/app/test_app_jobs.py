"""Jobs: one after the other, cancelled within seconds, reported when killed, started again."""

from __future__ import annotations

import json
import os
import shlex
import signal
import subprocess
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from app_runs import deaf_work, quick_work

from moyai.app.folder import Folder
from moyai.app.job_process import Order, work
from moyai.app.job_records import NAME, kept_jobs
from moyai.app.jobs import GRACE, Job, Jobs
from moyai.core.run_folder import alone_in


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


@pytest.mark.slow
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


@pytest.mark.slow
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
def test_a_killed_process_is_reported_and_can_be_started_again(queue: Any, tmp_path: Path) -> None:
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


@pytest.mark.skipif(os.name == "nt", reason="quoted for cmd.exe there")
@pytest.mark.parametrize("name", ["a.yaml", "a b.yaml", "$(touch x) `y`.yaml", 'it\'s "z".yaml', "浮 & 沈.yaml"])
def test_the_command_line_names_the_file_to_a_shell(tmp_path: Path, name: str) -> None:
    command = Job("job1", order(tmp_path, name)).record(tmp_path)["command"]
    assert shlex.split(command) == ["moyai", "run", name, "--output", name]
    shell = ["sh", "-c", f"printf '%s|' {command.partition(' ')[2]}"]
    said = subprocess.run(shell, capture_output=True, text=True, cwd=tmp_path)
    assert said.stdout == f"run|{name}|--output|{name}|"


def test_results_that_cannot_be_written_are_reported_in_plain_words(queue: Any, tmp_path: Path) -> None:
    (tmp_path / "out").write_text("a file stands here")
    job = queue(work).add(Order("run", "a.yaml", tmp_path / "out" / "a", tmp_path, tmp_path / "a.yaml"))
    until(job, "failed")
    assert "cannot write to" in job.words and "internal error" not in job.words and "Errno" not in job.words


def test_a_job_that_cannot_begin_holds_up_no_other(queue: Any, tmp_path: Path, monkeypatch: Any) -> None:
    jobs = queue(quick_work)
    make, refused = jobs._context.Event, []

    def event() -> Any:
        if not refused:
            refused.append(True)
            raise OSError(28, "No space left on device")
        return make()

    monkeypatch.setattr(jobs._context, "Event", event)
    first, second = jobs.add(order(tmp_path, "a.yaml")), jobs.add(order(tmp_path, "b.yaml"))
    until(second, "done")
    assert first.state == "failed" and "No space left" in first.words


def test_results_never_go_where_something_is(queue: Any, tmp_path: Path) -> None:
    jobs = queue(quick_work)
    (tmp_path / "pile").mkdir()
    folder = jobs.folder_for(tmp_path, "pile")
    assert folder.name == "pile_2"
    jobs.add(Order("run", "pile.yaml", folder, tmp_path, tmp_path / "pile.yaml"))
    assert jobs.folder_for(tmp_path, "pile").name == "pile_3"


@pytest.mark.slow
def test_an_app_that_starts_later_lists_the_jobs(queue: Any, tmp_path: Path) -> None:
    root = tmp_path.resolve()
    output = root / "out"
    jobs = queue(quick_work)
    done = jobs.add(Order("run", "a.yaml", output / "a", root, root / "a.yaml", "moyai: 1", False, "ja"))
    running = jobs.add(Order("study", "wait", output / "wait", root, root / "wait"))
    waiting = jobs.add(Order("paper", "tabata", output / "tabata", root, root / "tabata"))
    until(done, "done")
    until(running, "running")
    jobs.close()

    later = Jobs(print, quick_work, Folder(root, output))
    try:
        first, second, third = (later[job.key] for job in (done, running, waiting))
        assert (first.state, first.words, first.order) == ("done", "all identities hold; holds", done.order)
        assert second.state == third.state == "lost"
        assert "the app ended before this job did" in second.words and "continues from the cases" in second.words
        assert "before this job began" in third.words
        assert second.order == running.order and third.order == waiting.order
        until(later.again(third.key), "done")
    finally:
        later.close()
    assert [one.state for one in kept_jobs(Folder(root, output))] == ["done", "lost", "done"]


def test_a_job_at_which_another_app_works_is_not_listed(queue: Any, tmp_path: Path) -> None:
    root = tmp_path.resolve()
    jobs = queue(quick_work)
    until(jobs.add(Order("run", "wait", root / "out" / "a", root, root / "wait")), "running")
    with alone_in(root / "out" / "a"):
        assert kept_jobs(Folder(root, root / "out")) == []
    assert len(kept_jobs(Folder(root, root / "out"))) == 1


@pytest.mark.slow
@pytest.mark.parametrize(
    "changes",
    [
        {"file": "../outside.yaml"}, {"file": "/etc/passwd"}, {"kind": "shell"}, {"moyai_job": 2}, {"ordered": "x"},
        {"state": None, "seconds": {}},
    ],
)  # fmt: skip
def test_what_is_no_job_of_this_folder_is_left_out(queue: Any, tmp_path: Path, changes: dict[str, Any]) -> None:
    root = tmp_path.resolve()
    folder = Folder(root / "cases", root / "cases" / "out")
    jobs = queue(quick_work)
    place = folder.output / "a"
    until(jobs.add(Order("run", "a", place, folder.root, folder.root / "a.yaml")), "done")
    assert len(kept_jobs(folder)) == 1
    for _ in range(500):  # the file is written once more when the job has ended
        content = json.loads((place / NAME).read_text())
        if content["state"] == "done":
            break
        time.sleep(0.02)
    assert content["state"] == "done"
    (place / NAME).write_text(json.dumps(content | changes))
    assert kept_jobs(folder) == []
    for text in ("", "[]", "[" * 5000, "{}", "null"):
        (place / NAME).write_text(text)
        assert kept_jobs(folder) == []
    (place / NAME).unlink()
    (root / "job.json").write_text(json.dumps(content))
    (place / NAME).symlink_to(root / "job.json")
    assert kept_jobs(folder) == []
