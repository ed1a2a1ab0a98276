"""A folder of results holds one run, alone at work in it."""

import contextlib
import os

import pytest

from moyai.core.errors import InputError
from moyai.core.run_folder import alone_in, keeping_results, put_in_place, staged_outputs


def outputs(folder, run, tables):
    (folder / "report_tables").mkdir(parents=True)
    for name in ("results.nc", "report.html", *(f"report_tables/{table}.csv" for table in tables)):
        (folder / name).write_text(run)
    return [folder / "results.nc"]


def test_outputs_replace_those_of_another_run_whole(tmp_path):
    outputs(tmp_path, "first", ("motion", "tension"))
    (tmp_path / "report.pdf").write_text("first")
    (tmp_path / "notes.txt").write_text("mine")
    with staged_outputs(tmp_path) as staged:
        files = put_in_place(staged, tmp_path, outputs(staged, "second", ("motion",)))
    assert files == [tmp_path / "results.nc"]
    held = {str(path.relative_to(tmp_path)): path.read_text() for path in tmp_path.rglob("*") if path.is_file()}
    assert held == {
        "notes.txt": "mine", "results.nc": "second", "report.html": "second", "report_tables/motion.csv": "second"
    }  # fmt: skip


@pytest.mark.parametrize("steps", range(7))
def test_wherever_it_ends_results_and_report_are_of_one_run(tmp_path, monkeypatch, steps):
    """Each step that changes the folder is where the process may end."""
    outputs(tmp_path, "first", ("motion",))
    left, replace = [steps], os.replace

    def counted(*paths):
        left[0] -= 1
        if left[0] < 0:
            raise SystemExit
        replace(*paths)

    with staged_outputs(tmp_path) as staged:
        files = outputs(staged, "second", ("motion",))
        monkeypatch.setattr(os, "replace", counted)
        with contextlib.suppress(SystemExit):
            put_in_place(staged, tmp_path, files)
    report = tmp_path / "report.html"
    assert not report.exists() or report.read_text() == (tmp_path / "results.nc").read_text()


def test_what_ended_runs_left_is_removed_and_nothing_else(tmp_path):
    (tmp_path / ".run.partial").mkdir()
    (tmp_path / ".run.partial" / "results.nc").write_text("half")
    for name in ("results.nc.ab12_xyz.partial", "mine.partial"):
        (tmp_path / name).write_text("half")
    with staged_outputs(tmp_path) as staged:
        assert not list(staged.iterdir())
    assert [path.name for path in tmp_path.iterdir()] == ["mine.partial"]


def test_the_second_run_in_a_folder_is_refused_until_the_first_ends(tmp_path):
    with alone_in(tmp_path), pytest.raises(InputError, match="another run is at work in"), alone_in(tmp_path):
        pass
    with alone_in(tmp_path):
        pass


def test_results_stay_where_their_report_does_not_come_to_its_end(tmp_path):
    outputs(tmp_path, "first", ("motion",))
    with contextlib.suppress(KeyboardInterrupt), staged_outputs(tmp_path) as staged:
        outputs(staged, "second", ("motion",))
        with keeping_results(staged, tmp_path):
            raise KeyboardInterrupt
    assert [path.name for path in tmp_path.iterdir()] == ["results.nc"]
    assert (tmp_path / "results.nc").read_text() == "second"
