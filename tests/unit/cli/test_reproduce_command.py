"""The reproduce command: the list, unknown names, and a page from end to end with points of the reader."""

import json

import pytest
from kept_papers import take_kept_paper
from typer.testing import CliRunner

from moyai.cli.main import app
from moyai.core.results import read_result

RUN = CliRunner()
PAPERS = ("nakamura", "tabata", "arai", "sawaragi", "matsubara")


def test_papers_are_listed():
    found = RUN.invoke(app, ["reproduce"])
    assert found.exit_code == 0
    assert [line.split()[0] for line in found.output.splitlines()[:5]] == list(PAPERS)
    listed = json.loads(RUN.invoke(app, ["reproduce", "--json"]).output)["papers"]
    assert [one["key"] for one in listed] == list(PAPERS)
    assert all(one["authors"] and one["title"] and one["line"] for one in listed)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["reproduce", "nakamra"], "no paper 'nakamra'"),
        (["validate", "--paper", "nobody"], "no paper 'nobody'"),
        (["reproduce", "arai", "--points", "99=points.csv"], "no figure '99' takes points"),
        (["reproduce", "arai", "--points", "2a=absent.csv"], "absent.csv cannot be read"),
    ],
)
def test_what_does_not_exist_is_one_line(tmp_path, monkeypatch, arguments, message):
    monkeypatch.chdir(tmp_path)
    found = RUN.invoke(app, [*arguments, "--json"])
    (fault,) = json.loads(found.output)["faults"]
    assert found.exit_code == 2
    assert message in fault["message"] and fault["allowed"]
    assert not list(tmp_path.iterdir())  # no folder is left behind


@pytest.mark.slow
def test_a_page_with_points_from_end_to_end(tmp_path, monkeypatch):
    take_kept_paper("sawaragi", monkeypatch)
    points = tmp_path / "own.csv"
    points.write_text("Fr, C_T\n0.1, 3.0\n0.2, 1.5\n", encoding="utf-8")
    folder = tmp_path / "page"
    found = RUN.invoke(app, ["reproduce", "sawaragi", "--quick", "--points", f"17={points}", "-o", str(folder)])
    assert found.exit_code == 0, found.output
    assert "figure 17, own.csv, model A, fishing line: 2 points, bias" in found.output
    page = (folder / "report.html").read_text(encoding="utf-8")
    assert "points laid over: own.csv" in page and "http://" not in page.replace("http://www.w3.org", "")
    assert (folder / "figures" / "figure_17.csv").exists() and (folder / "tables" / "statements.csv").exists()
    assert (folder / "cases" / "flume.yaml").exists()
    assert "figure_17" in read_result(folder / "results.nc").tree.children
