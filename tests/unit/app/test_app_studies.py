"""Studies and fits as jobs: run, shown while they run, cancelled, killed and gone on with, any case opened."""

from __future__ import annotations

import os
import signal
import time
import zipfile
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from app_runs import MEMBER, run_slowly

from moyai.app.folder import Folder
from moyai.app.job_process import Order
from moyai.app.jobs import Job, Jobs
from moyai.app.study_jobs import refuse_foreign_base
from moyai.case.yaml_reader import parse_yaml
from moyai.cli.runner import run
from moyai.core.errors import CaseError, InputError
from moyai.report.on_demand import made, makeable, so_far
from moyai.study.cases_so_far import case_text, table_of

STUDY = """\
moyai: 1
study:
  title: Heights and diameters
  base: pile.yaml
  set: {title: One of a study}
  variations:
    - grid:
        waves[regular].height: [0.5 m, 1 m, 1.5 m]
        structure.section.diameter: [80 cm, 120 cm]
  replays: 0
"""
FIT = """\
moyai: 1
fit:
  title: Drag
  base: pile.yaml
  parameters:
    structure.drag: {from: 0.5, to: 2.0}
  observations:
    file: observed.csv
    columns: {D: structure.section.diameter}
    observed: force
    response: SWL/waves/regular/maximum_total_force
"""


@pytest.fixture
def root(tmp_path: Path) -> Path:
    (tmp_path / "pile.yaml").write_text(MEMBER)
    (tmp_path / "study.yaml").write_text(STUDY)
    return tmp_path.resolve()


@pytest.fixture
def queue() -> Iterator[Any]:
    made_: list[Jobs] = []

    def make(how: Any) -> Jobs:
        made_.append(Jobs(how))
        return made_[-1]

    yield make
    for one in made_:
        one.close()


def order(root: Path) -> Order:
    return Order("study", "study.yaml", root / "out" / "study", root, root / "study.yaml")


def until(job: Job, *states: str, seconds: float = 120.0) -> None:
    started = time.monotonic()
    while job.state not in states:
        assert time.monotonic() - started < seconds, (job.state, job.words)
        time.sleep(0.02)


@pytest.mark.slow
def test_a_study_runs_and_its_cases_are_opened(queue: Any, root: Path) -> None:
    jobs = queue(run)
    job = jobs.add(order(root))
    until(job, "done", "failed", "lost")
    assert job.state == "done", job.words
    found = table_of(job.order.folder)
    assert (found["ended"], found["total"], len(found["rows"])) == (6, 6, 6)
    assert len(found["columns"]) == 6 and all(len(row["values"]) == 6 for row in found["rows"])
    record = job.record(root)
    assert {"report.html", "study.nc", "study.csv", "report.pdf", "tables.zip"} <= set(record["files"])
    assert record["command"] == "moyai study study.yaml --output out/study"

    text, base = case_text(job.order.folder, root, 5)
    assert base == root / "pile.yaml"
    assert text == MEMBER.replace("Quick member", "One of a study").replace("height: 1 m", "height: 1.5 m").replace(
        "100 cm", "120 cm"
    )
    assert parse_yaml(text).data["waves"]["height"] == "1.5 m"
    with pytest.raises(KeyError):
        case_text(job.order.folder, root, 6)
    with pytest.raises(InputError, match="outside"):
        case_text(job.order.folder, root / "elsewhere", 0)

    archive = made(job.order.folder, "tables.zip")
    with zipfile.ZipFile(archive) as held:
        assert held.namelist() and all(name.endswith(".csv") for name in held.namelist())
    assert made(job.order.folder, "report.docx").read_bytes()[:2] == b"PK"
    assert "<html" in so_far(job.order.folder)
    assert makeable(root) == []


@pytest.mark.slow  # jobs that are killed: test_app_jobs; studies that go on: test_study_execution
@pytest.mark.skipif(not hasattr(signal, "SIGKILL"), reason="no SIGKILL here")
def test_a_study_that_was_killed_or_cancelled_goes_on(queue: Any, root: Path) -> None:
    (root / "study.yaml").write_text(STUDY.replace("One of a study", "slow"))
    (root / "pile.yaml").write_text(MEMBER)
    jobs = queue(run_slowly)
    job = jobs.add(order(root))
    folder = job.order.folder

    def ended() -> int:
        return int(table_of(folder)["ended"])

    started = time.monotonic()
    while ended() < 1:
        assert time.monotonic() - started < 120.0 and job.state in ("waiting", "running"), job.words
        time.sleep(0.05)
    os.kill(job.process.pid, signal.SIGKILL)
    until(job, "lost")
    kept = ended()
    assert 1 <= kept < 6
    first = _done(folder)
    job = jobs.again(job.key)
    while ended() <= kept:
        assert job.state in ("waiting", "running"), job.words
        time.sleep(0.05)
    started = time.monotonic()
    jobs.cancel(job.key)
    until(job, "cancelled")
    assert time.monotonic() - started < 4.0
    assert ended() > kept and first <= _done(folder)


def _done(folder: Path) -> set[str]:
    """Lines of the diary: cases are not run twice."""
    return set((folder / "study.jsonl").read_text().splitlines())


def test_study_files_are_listed_and_kept_inside(root: Path) -> None:
    folder = Folder(root, root / "out")
    assert {"file": "study.yaml", "kind": "study", "title": "Heights and diameters"} in folder.case_files()
    assert refuse_foreign_base(folder, root / "study.yaml") == "study"
    for text, error in (
        (STUDY.replace("pile.yaml", "../pile.yaml"), InputError),
        (STUDY.replace("pile.yaml", "/etc/passwd"), InputError),
        (STUDY + "  assess: {file: ../x.csv}\n", CaseError),
        ("a: 1\n", InputError),
        ("a: [", CaseError),
    ):
        (root / "bad.yaml").write_text(text)
        with pytest.raises(error):
            refuse_foreign_base(folder, root / "bad.yaml")


@pytest.mark.slow
def test_a_fit_runs(queue: Any, root: Path) -> None:
    rows = "".join(f"{diameter},{_force(root, diameter)!r}\n" for diameter in (0.1, 0.2, 0.3))
    (root / "observed.csv").write_text(f"D [m],force [N]\n{rows}")
    (root / "fit.yaml").write_text(FIT)
    jobs = queue(run)
    job = jobs.add(Order("fit", "fit.yaml", root / "out" / "fit", root, root / "fit.yaml"))
    until(job, "done", "failed", "lost")
    assert job.state == "done", job.words
    assert {"report.html", "fit.nc", "case.yaml"} <= set(job.record(root)["files"])
    assert made(root / "out" / "fit", "report.pdf").read_bytes().startswith(b"%PDF")
    fitted = parse_yaml((root / "out" / "fit" / "case.yaml").read_text()).data
    assert abs(float(fitted["structure"]["drag"]) - 1.0) < 0.02, "the forces were computed with a coefficient of 1"


def _force(root: Path, diameter: float) -> float:
    from moyai.case.reader import case_of

    text = MEMBER.replace("100 cm", f"{diameter} m")
    result = run(case_of(parse_yaml(text), root / "pile.yaml"))
    return float(result.tree["SWL/waves/regular"]["maximum_total_force"].values[0])
