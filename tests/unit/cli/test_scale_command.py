"""The ``moyai scale`` command: files and figures, what it refuses."""

import json

import pytest
from typer.testing import CliRunner

from moyai.case.reader import load_case
from moyai.case.templates import template
from moyai.cli.main import app

runner = CliRunner()


@pytest.fixture
def case(tmp_path):
    path = tmp_path / "pontoon.yaml"
    path.write_text(template("breakwater"), encoding="utf-8")
    return path


def test_case_to_model_and_back(case, tmp_path):
    model, back = tmp_path / "model.yaml", tmp_path / "back.yaml"
    found = runner.invoke(app, ["scale", str(case), "--scale", "1/26", "--density", "1000", "-o", str(model)])
    assert found.exit_code == 0, found.output
    assert "structure.draught" in found.stdout and "NOT KEPT" in found.stdout and "0.115385 m" in found.stdout
    small = load_case(model).model
    assert small.site.density == 1000.0
    assert small.structure.draught == pytest.approx(3.0 / 26.0, rel=1e-6)
    assert small.lines[0].segments[0].axial_stiffness == pytest.approx(0.854e11 * 0.068**2 / 26**3 / 1.025, rel=1e-6)
    found = runner.invoke(app, ["scale", str(model), "--scale", "26", "--density", "1025", "-o", str(back)])
    assert found.exit_code == 0, found.output
    assert load_case(back).model.structure.draught == pytest.approx(3.0, rel=1e-6)
    again = runner.invoke(app, ["scale", str(case), "--scale", "1/26", "-o", str(model)])
    assert again.exit_code == 2 and "exists" in again.output


def test_single_figures_as_json():
    found = runner.invoke(
        app,
        ["scale", "EA=890 kN", "K=890 kN/m", "--length", "1/20", "--at-hand", "EA=2 kN", "--line-length", "46 m",
         "--speed", "0.5", "--across", "50 mm", "--period", "6 s", "--json"],
    )  # fmt: skip
    assert found.exit_code == 0, found.output
    record = json.loads(found.stdout)
    assert [row["model"] for row in record["quantities"]] == pytest.approx([890 / 8000, 890 / 400])
    assert record["needs"][0]["over"] == pytest.approx(2 / (890 / 8000))
    assert "spring of 51.219 N/m in series with its 2.3 m" in record["needs"][0]["remedy"]
    numbers = {item["name"]: item for item in record["numbers"]["as asked"]}
    assert numbers["Keulegan-Carpenter"]["prototype"] == pytest.approx(60.0)
    assert numbers["Reynolds"]["kept"] is False
    assert record["ratios"]["N"] == 8000.0


def test_back_from_the_model():
    found = runner.invoke(app, ["scale", "T=12.3 N", "--scale", "25", "--json"])
    row = json.loads(found.stdout)["quantities"][0]
    assert (row["model"], row["prototype"]) == pytest.approx((12.3, 12.3 * 25**3))
    found = runner.invoke(
        app, ["scale", "T=12.3 N", "--scale", "25", "--given-density", "1000", "--density", "1025", "--json"]
    )
    assert json.loads(found.stdout)["quantities"][0]["prototype"] == pytest.approx(12.3 * 25**3 * 1.025)


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["EA=3 kN", "--scale", "0"], "the ratio is 0"),
        (["EA=3 kN", "--scale", "-2"], "not a ratio"),
        (["EA=3 kN", "--scale", "1/0"], "not a ratio"),
        (["EA=3 kN", "--scale", "tenth"], "not a ratio"),
        (["EA=3 kX", "--scale", "1/9"], "unknown unit"),
        (["EA=", "--scale", "1/9"], "does not begin with a number"),
        (["=3 kN", "--scale", "1/9"], "not NAME=VALUE"),
        (["EA=3 kN", "EA=4 kN", "--scale", "1/9"], "given twice"),
        (["EA=3 kN", "--scale", "1/9", "--density", "1000"], "--given-density"),
        (["EA=3 kN", "--scale", "1/9", "--given-density", "0", "--density", "1000"], "greater than 0"),
        (["EA=3 kN", "--scale", "1/9", "--at-hand", "EA=4 kN"], "length of the line"),
        (["EA=3 kN", "--scale", "1/9", "--at-hand", "EB=4 kN"], "not among the figures"),
        (["EA=3 kN", "--scale", "1/9", "--at-hand", "EA=4 kg", "--line-length", "3"], "same kind"),
        (["EA=3 kN", "--scale", "1/9", "--speed", "1"], "'--across' is missing"),
        (["EA=3 kN", "--scale", "1/9", "--speed", "-1", "--across", "1"], "greater than 0"),
        (["EA=3 kN", "--scale", "1/9", "-o", "new.yaml"], "no case file to write"),
        (["nothing.yaml", "--scale", "1/9"], "no such file"),
        (["H=2", "--scale", "1/25"], "2 has no unit"),
    ],
)
def test_refusals(arguments, words):
    found = runner.invoke(app, ["scale", *arguments])
    assert found.exit_code == 2, found.output
    assert words in found.output
    assert len(found.output.strip().splitlines()) == 1
