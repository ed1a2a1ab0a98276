"""Questions to the results of a study, and cases that the check refused."""

import csv
import io
import json
import math
import sys

import numpy as np
import pytest
import study_cases
import xarray as xr
from typer.testing import CliRunner

from moyai.cli.main import app
from moyai.core.errors import CaseError, InputError
from moyai.report.html import render_html
from moyai.study.execute import run_study
from moyai.study.plan import load_study
from moyai.study.query import StudyTable, read_study_results
from moyai.study.report.page import compose
from moyai.study.responses import find_response, read_response
from moyai.study.zarr_file import write_zarr

VARIATIONS = """
- grid:
    'waves[storm].significant_height': [0.3 m, 60 cm, 0.9 m]
    'waves[storm].peak_period': [4 s, 5 s]
- lines_lost: true
"""


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    place = tmp_path_factory.mktemp("query")
    study = load_study(study_cases.write_text(place, VARIATIONS, watch="SWL/tension"))
    result = run_study(study, place / "out", study_cases.linear_case, workers=1)
    result.write(place / "out" / "study.nc")
    write_zarr(result, place / "out" / "study.zarr")
    return place / "out"


def asked(*words):
    answer = CliRunner().invoke(app, ["query", *map(str, words)])
    return answer.exit_code, answer.output


def tension(height, period):
    return 1000.0 * height**2 * period / 5.0 * (55.0 / 54.5) ** 4


def test_conditions_take_units_labels_and_responses(folder):
    table = read_study_results(folder)
    height = np.repeat([0.3, 0.6, 0.9], 6)
    period = np.tile(np.repeat([4.0, 5.0], 3), 3)
    lost = np.tile([0, 1, 2], 6)
    force = tension(height, period)
    expected = {
        "significant_height > 0.5 m": height > 0.5,
        "significant_height>=60 cm": height >= 0.6,
        "significant_height = 60 cm": height == 0.6,
        "significant_height != 0.6": height != 0.6,
        "peak_period<5": period < 5,
        "lost_line = intact": lost == 0,
        "lost_line != intact": lost > 0,
        "lost_line ~ SEA": lost == 1,
        "status = converged": lost >= 0,
        "tension > 0.5 kN": force > 500.0,
        "SWL/tension[line=seaward] <= 300": force <= 300.0,
        "case >= 10": np.arange(18) >= 10,
    }
    for text, wanted in expected.items():
        assert np.array_equal(table.where(text), wanted), text


def test_the_worst_come_first_and_pivots_show_the_worst_of_the_rest(folder):
    code, text = asked(folder, "--by", "tension", "--top", 3, "--json")
    found = json.loads(text)
    assert code == 0 and found["cases"] == 3 and found["of"] == 18
    at = found["columns"].index("SWL/tension [N]")
    assert [row[at] for row in found["rows"]] == pytest.approx([tension(0.9, 5.0)] * 3)
    code, text = asked(folder, "--by", "cost", "--smallest", "--top", 1, "-w", "significant_height = 0.3 m", "--json")
    assert json.loads(text)["rows"][0][0] == 0
    code, text = asked(folder / "study.zarr", "--pivot", "significant_height, peak_period", "--by", "tension", "--json")
    found = json.loads(text)
    table = np.array([row[1:] for row in found["rows"]])
    assert np.allclose(table, [[tension(h, p) for p in (4.0, 5.0)] for h in (0.3, 0.6, 0.9)])
    assert found["columns"][1:] == ["4 s", "5 s"] and [row[0] for row in found["rows"]] == ["0.3 m", "60 cm", "0.9 m"]


def test_tables_are_written_for_spreadsheets(folder, tmp_path):
    code, text = asked(folder, "-w", "lost_line = intact", "-s", "tension[line=seaward]", "--csv", tmp_path / "a/b.csv")
    assert code == 0 and "6 of 18 cases" in text
    rows = list(csv.DictReader(io.StringIO((tmp_path / "a/b.csv").read_text(encoding="utf-8-sig"))))
    assert [float(row["SWL/tension[line=seaward] [N]"]) for row in rows] == pytest.approx(
        [tension(h, p) for h in (0.3, 0.6, 0.9) for p in (4.0, 5.0)]
    )
    assert rows[0]["significant_height"] == "0.3 m" and rows[0]["lost_line"] == "intact"


def test_alone_it_tells_what_there_is_to_ask(folder):
    code, text = asked(folder)
    assert code == 0
    for word in ("18 cases (18 converged)", "lost_line (3)", "SWL/tension", "--by 'SWL/tension'"):
        assert word in text
    code, text = asked(folder, "--json")
    assert {one["name"] for one in json.loads(text)["responses"]} >= {"SWL/tension", "SWL/cost"}


@pytest.mark.parametrize(
    ("words", "reported"),
    [
        (["-w", "height"], "no condition"),
        (["-w", "hight > 1"], "no axis and no response"),
        (["-w", "tenson > 1"], "did you mean 'tension'"),
        (["-w", "maximum_uplift > 1"], "is called anchor_vertical_tension_maximum_lines_in_motion"),
        (["-w", "lost_line = sea"], "one of seaward"),
        (["-w", "lost_line > 1"], "no order"),
        (["-w", "significant_height > 1 kN"], "is in m"),
        (["-w", "significant_height > much"], "no value"),
        (["-w", "tension[line=west] > 1"], "seaward, shoreward"),
        (["--by", "status"], "no largest"),
        (["--top", "0"], "1 or more"),
        (["--pivot", "peak_period"], "ROWS,COLUMNS"),
        (["--pivot", "peak_period,heading"], "no axis 'heading'"),
        (["--pivot", "peak_period,peak_period"], "twice"),
    ],
)
def test_questions_without_sense_are_answered_with_one_sentence(folder, words, reported):
    code, text = asked(folder, *words)
    assert code == 2 and reported in text and "internal error" not in text


def test_what_holds_no_results_of_a_study_is_reported(tmp_path, folder, monkeypatch):
    for place, reported in ((tmp_path, "no results of a study"), (tmp_path / "none.nc", "no such file")):
        code, text = asked(place)
        assert code == 2 and reported in text
    (tmp_path / "s.yaml").write_text("moyai: 1\n", encoding="utf-8")
    assert "not its results" in asked(tmp_path / "s.yaml")[1]
    (tmp_path / "a.zarr").mkdir()
    assert "no zarr store" in asked(tmp_path / "a.zarr")[1]
    monkeypatch.setitem(sys.modules, "zarr", None)
    assert 'pip install "moyai[zarr]"' in asked(folder / "study.zarr")[1]


def test_zarr_holds_what_netcdf_holds(folder):
    one, two = read_study_results(folder / "study.nc"), read_study_results(folder / "study.zarr")
    assert one.names == two.names and one.status == two.status
    for name, variable in one.responses().items():
        assert np.array_equal(variable.values, two.responses()[name].values, equal_nan=True)
        assert variable.attrs["units"] == two.responses()[name].attrs["units"]


REFUSED = "- grid: {'waves[storm].significant_height': [0.5 m, -1 m, 0.7 m], 'structure.draught': [3 m, 9 m]}"


@pytest.mark.parametrize("workers", [1, pytest.param(2, marks=pytest.mark.slow)])
def test_cases_that_the_check_refuses_stop_the_study_or_become_rows(tmp_path, workers):
    path = study_cases.write_text(tmp_path, REFUSED)
    with pytest.raises(CaseError) as caught:
        load_study(path)
    assert "-1 m is out of range" in str(caught.value) and "on_refused: skip" in str(caught.value)
    study = load_study(study_cases.write_text(tmp_path, REFUSED, on_refused="skip"))
    assert study.refused == (1, 2, 3, 5)
    result = run_study(study, tmp_path / "out", study_cases.fast_case, workers=workers)
    assert result.status == "converged" and "4 refused by the check" in result.message
    status = result.tree["case_status"].values
    assert (status == [["converged", "refused"], ["refused", "refused"], ["converged", "refused"]]).all()
    assert "-1 m is out of range" in str(result.tree["case_message"].values[1, 0])
    assert "base.yaml" not in str(result.tree["case_message"].values[1, 0])
    response = result.tree["SWL"]["response"].values
    assert np.isfinite(response[[0, 2], 0]).all() and math.isnan(response[1, 0])
    page = render_html(compose(result))
    assert "4 refused" in page and "-1 m is out of range" in page
    assert list(np.flatnonzero(StudyTable(result.tree).where("status = refused"))) == [1, 2, 3, 5]


def test_a_study_whose_cases_are_all_refused_is_refused_itself(tmp_path):
    path = study_cases.write_text(tmp_path, "- grid: {'structure.draught': [8 m, 9 m]}", on_refused="skip")
    with pytest.raises(CaseError):
        load_study(path)


@pytest.mark.parametrize(
    ("variation", "reported"),
    [
        ("- lines_lost: {path: structure.anchors}", "no list 'structure.anchors'"),
        ("- lines_lost: {path: mooring}", "no list 'mooring'"),
        ("- lines_lost: {path: structure.section}", "the only line"),
    ],
)
def test_a_structure_without_a_list_of_lines_is_reported_what_can_be_lost(tmp_path, variation, reported):
    with pytest.raises(CaseError) as caught:
        load_study(study_cases.write_text(tmp_path, variation))
    assert reported in str(caught.value)
    if "no list" in reported:
        assert "lines" in str(caught.value) and "'remove'" in str(caught.value)


def test_the_content_of_files_is_part_of_the_study(tmp_path):
    text = "frequency,density\n0.1,0\n0.15,{}\n0.2,2\n0.3,0.1\n"
    table = tmp_path / "sea.csv"
    table.write_text(text.format(1), encoding="utf-8")
    variation = """
- list:
    cases:
      - label: measured
        set:
          waves[0]: {name: storm, kind: spectrum_file, file: sea.csv, heading_deg: 0, duration: 600 s, seed: 1}
      - {label: computed, set: {'waves[0].seed': 2}}
"""
    path = study_cases.write_text(tmp_path, variation)
    before = load_study(path).key
    assert load_study(path).key == before
    table.write_text(text.format(1.5), encoding="utf-8")
    study = load_study(path)
    assert study.key != before
    run_study(study, tmp_path / "out", study_cases.any_case, workers=1)
    table.write_text(text.format(1.7), encoding="utf-8")
    with pytest.raises(InputError, match="another study"):
        run_study(load_study(path), tmp_path / "out", study_cases.any_case, workers=1)


def test_labels_may_hold_brackets_and_slashes(tmp_path):
    optimise = (
        "{variables: {'lines[*].segments[0].length': [54 m, 57 m]}, minimise: SWL/cost,"
        " trade_off: {response: SWL/tension, at_most: [950, 1000]}, starts: 1}"
    )
    study = load_study(study_cases.write_text(tmp_path, "[]", optimise=optimise))
    run_study(study, tmp_path / "out", study_cases.linear_case, workers=1).write(tmp_path / "out" / "study.nc")
    code, text = asked(tmp_path / "out", "-s", "best[variable=lines[*].segments[0].length [m]]", "--json")
    found = json.loads(text)
    assert code == 0 and [row[-1] for row in found["rows"]] == pytest.approx(
        [55.0 * (1000.0 / bound) ** 0.25 for bound in (950.0, 1000.0)], rel=2e-3
    )
    code, text = asked(tmp_path / "out", "-w", "best[variable=lines[*].segments[0].length [m]] > 55.4 m")
    assert code == 0 and "1 of 2 cases" in text and "best[variable" not in text


def test_the_largest_motion_is_one_of_metres_and_roll_is_asked_for_by_its_label():
    words = "significant double amplitude of the motion (roll: rad)"
    motion = xr.DataArray(
        [0.2, 0.4, 3.0], dims="dof", coords={"dof": ["sway", "heave", "roll"]}, attrs={"units": "m", "long_name": words}
    )
    tree = xr.DataTree.from_dict({"/SWL": xr.Dataset({"significant_motion": motion})})
    assert read_response(tree, "SWL/significant_motion") == 0.4
    assert read_response(tree, "SWL/significant_motion[dof=roll]") == 3.0
    roll = find_response(tree, "SWL/significant_motion[dof=roll]")
    assert roll.attrs == {"units": "rad", "long_name": "significant double amplitude of the motion"}


def test_a_study_that_is_cut_off_can_be_asked(tmp_path, monkeypatch):
    """What a study leaves behind that ends without a word: looked at while it runs, after every case."""
    from moyai.study import execute

    monkeypatch.setattr(execute, "_OFTEN", 0.0)
    monkeypatch.setattr(execute, "_COST", 0.0)
    study = load_study(study_cases.write_study(tmp_path, 2, 3))
    left = []

    def look(standing):
        if standing.done > 1:
            table = read_study_results(tmp_path / "out")
            chosen = table.chosen(["seed < 9"], "SWL/response", 1, False)
            left.append((standing.done, table.status.count("converged"), len(chosen)))

    execute.run_study(study, tmp_path / "out", study_cases.fast_case, workers=1, watch=look)
    # the case that just ended comes with the next gathering
    assert left == [(done, done - 1, 1) for done in range(2, 7)]


def test_one_case_is_one_case(tmp_path):
    study = load_study(study_cases.write_study(tmp_path, 1, 1))
    result = run_study(study, tmp_path / "out", study_cases.fast_case, workers=1)
    assert result.message.startswith("1 of 1 case run")
    result.write(tmp_path / "out" / "study.nc")
    assert ": 1 case (1 converged)" in CliRunner().invoke(app, ["query", str(tmp_path / "out")]).output


def test_a_label_may_have_a_comma_in_it():
    from moyai.study.responses import split_response

    assert split_response("SWL/waves/force[wave=H 1.5 m, T 6 s]") == (
        "SWL/waves",
        "force",
        (("wave", "H 1.5 m, T 6 s"),),
    )
    assert split_response("a/b[wave=H 1 m, T 6 s, dof=roll]")[2] == (("wave", "H 1 m, T 6 s"), ("dof", "roll"))
    assert split_response("a/b[line=seaward,dof=roll]")[2] == (("line", "seaward"), ("dof", "roll"))
