"""``moyai report``: a folder, switches without words, and what is missing for one kind of file."""

from __future__ import annotations

import json
import re
import sys
from pathlib import Path

import pytest
from small_results import pontoon, without
from typer.testing import CliRunner

from moyai.cli.main import app
from moyai.core.errors import CaseError
from moyai.report.writer import write_report

RUN = CliRunner()


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with the results of a run."""
    place = tmp_path_factory.mktemp("run")
    without(pontoon(), "/time").write(place / "results.nc")
    return place


@pytest.mark.slow
@pytest.mark.parametrize("words", [["--dxf"], ["--dxf", "m"]])
def test_a_folder_is_enough_and_metres_need_no_word(folder: Path, tmp_path: Path, words: list[str]) -> None:
    ran = RUN.invoke(app, ["report", str(folder), "-q", "-o", str(tmp_path), *words])
    assert ran.exit_code == 0, ran.output
    drawings = list((tmp_path / "report_drawings").glob("*.dxf"))
    assert drawings and (tmp_path / "report.html").exists()
    # INSUNITS 6: metres
    assert all(re.search(r"\$INSUNITS\s+70\s+6\s", path.read_text(encoding="utf-8")) for path in drawings)


def test_a_bare_switch_before_the_file_leaves_the_file(folder: Path, tmp_path: Path) -> None:
    ran = RUN.invoke(app, ["report", "--dxf", str(folder / "results.nc"), "-q", "-o", str(tmp_path)])
    assert ran.exit_code == 0, ran.output
    assert (tmp_path / "report_drawings").is_dir()


@pytest.mark.slow
def test_a_unit_is_no_folder_of_that_name(folder: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A folder ``m`` next to the results was taken for the file behind a bare ``--dxf``."""
    (tmp_path / "m").mkdir()
    monkeypatch.chdir(tmp_path)
    ran = RUN.invoke(app, ["report", str(folder), "--dxf", "m", "-q", "-o", "out"])
    assert ran.exit_code == 0, ran.output
    assert list((tmp_path / "out" / "report_drawings").glob("*.dxf"))


@pytest.mark.parametrize(
    ("name", "message"),
    [
        ("empty", "no results.nc in the folder"),
        ("case.yaml", "case.yaml is a case file, no result; run it first: moyai run"),
        ("absent.nc", "no such file"),
    ],
)
def test_what_is_no_result_is_said_in_its_words(tmp_path: Path, name: str, message: str) -> None:
    (tmp_path / "empty").mkdir()
    (tmp_path / "case.yaml").write_text("structure: {kind: curtain}\n", encoding="utf-8")
    for command in (["report"], ["convert", "--to", "wamit"]):
        ran = RUN.invoke(app, [*command, str(tmp_path / name), "--json"])
        (fault,) = json.loads(ran.output)["faults"]
        assert ran.exit_code == 2
        assert message in f"{fault['message']}; {fault['remedy']}"


@pytest.mark.slow
def test_all_switches_together_write_what_can_be_written(
    folder: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, "docx", None)  # as if it were not installed
    switches = ["--pdf", "--docx", "--xlsx", "--vtk", "--gltf", "--dxf", "mm", "--json"]
    ran = RUN.invoke(app, ["report", str(folder), "-o", str(tmp_path), *switches])
    assert ran.exit_code == 2
    faults = json.loads(ran.stdout)["faults"]
    assert [fault["path"] for fault in faults] == ["--docx"]
    names = {path.name for path in tmp_path.iterdir()}
    assert names >= {"report.html", "report.pdf", "report.xlsx", "report_tables"} and "report.docx" not in names
    # a wrong unit is a slip of the command: nothing is written
    slip = RUN.invoke(app, ["report", str(folder), "-o", str(tmp_path / "none"), "--dxf", "inch", "--json"])
    assert slip.exit_code == 2 and json.loads(slip.stdout)["faults"][0]["path"] == "--dxf"
    assert not (tmp_path / "none").exists()
    with pytest.raises(CaseError, match="'inch' is no unit"):
        write_report(without(pontoon(), "/time"), tmp_path / "again", docx=True, dxf="inch")
    assert (tmp_path / "again" / "report_tables").is_dir()


def test_a_template_that_is_not_there_is_said_so(folder: Path, tmp_path: Path) -> None:
    words = ["report", str(folder), "-o", str(tmp_path), "--docx", "--template", "absent.docx", "--json"]
    ran = RUN.invoke(app, words)
    (fault,) = json.loads(ran.stdout)["faults"]
    assert ran.exit_code == 2 and fault["message"] == "no such file: absent.docx"
    assert (tmp_path / "report.xlsx").exists()
