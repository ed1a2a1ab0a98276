"""The page of a reproduced paper again from its results alone."""

import re

import numpy as np
import pytest
from kept_papers import take_kept_paper

from moyai.cli.main import app
from moyai.core.results import read_result
from moyai.report.document import Abscissa, Disc, Drawing, Panel, Stroke
from moyai.report.html import render_html
from moyai.report.writer import compose_document
from moyai.reproduce import Reproduction, as_result, paper
from moyai.reproduce.drawing import curve, figure
from moyai.reproduce.model import FilledInput, Finding, PaperFigure, Statement
from moyai.reproduce.points import Agreement, Points
from moyai.reproduce.reproduction import StatementRow


def found():
    kc = np.linspace(0.0, 3.0, 7)
    drawn = figure(
        "2", "inertia", (Abscissa("kc", "KC"),), Panel("C_M", limits=(0.0, 2.0)),
        [curve("circle", {"kc": kc}, 2.0 - kc / 3.0), curve("held", {"kc": kc[:2]}, np.array([np.nan, 1.0]), 1)],
        "A caption of the figure.",
    )  # fmt: skip
    section = Drawing(
        "figure-1", "Figure 1: section", "<svg></svg>", "<svg></svg>", "To scale.",
        (Stroke("hull", np.array([[0.0, 0.0], [1.0, 0.5]]), True), Disc("buoy", (0.0, 1.0), 0.25)),
    )  # fmt: skip
    findings = (Finding("1.2", "agrees"), Finding("0.8", "differs", "laminar"), Finding("-", "open", "no numbers"))
    return Reproduction(
        paper("arai"),
        True,
        tuple(
            StatementRow(Statement(f"s{n}", f"Fig. {n}", f"Claim {n}.", lambda _: None), f)
            for n, f in enumerate(findings)
        ),
        (PaperFigure("1", section), PaperFigure("2", drawn, "thin lines"), PaperFigure("3", None, "a photograph")),
        (FilledInput("viscosity", "1.0e-6 m2/s", "1.3e-6", "2 %"),),
        ((Points("2", "own.csv", kc[:3], kc[:3]), (Agreement("circle", 3, 0.1, float("nan"), 0.2),)),),
    )


@pytest.mark.slow
@pytest.mark.parametrize("language", ["en", "ja"])
def test_the_page_of_the_results_is_that_of_the_run(tmp_path, language):
    result = as_result(found())
    page = render_html(compose_document(result, language=language))
    again = compose_document(read_result(result.write(tmp_path / "results.nc")), language=language)
    assert render_html(again) == page
    assert [section.key for section in again.sections] == [
        "summary", "statements", "figures", "equations", "filled", "inputs",
    ]  # fmt: skip
    assert {table.key for table in again.tables()} >= {
        "statements", "equations", "filled-in", "points-2-1", "figures-not-drawn",
    }  # fmt: skip
    (section,) = (block for block in again.blocks() if isinstance(block, Drawing))
    np.testing.assert_array_equal(section.shapes[0].points, [[0.0, 0.0], [1.0, 0.5]])
    assert section.shapes[1] == Disc("buoy", (0.0, 1.0), 0.25)
    assert again.badges[0].label == "Statements"


@pytest.mark.slow
def test_report_after_reproduce_in_the_language_of_the_run(tmp_path, monkeypatch):
    from typer.testing import CliRunner

    take_kept_paper("arai", monkeypatch)
    ran = CliRunner().invoke(app, ["--language", "ja", "reproduce", "arai", "--quick", "-q", "-o", str(tmp_path)])
    assert ran.exit_code == 0, ran.output
    first = (tmp_path / "report.html").read_text(encoding="utf-8")
    assert re.search(r"<html[^>]* lang=\"?ja", first)
    again = CliRunner().invoke(app, ["report", str(tmp_path), "-q", "-o", str(tmp_path / "again")])
    assert again.exit_code == 0, again.output
    assert (tmp_path / "again" / "report.html").read_text(encoding="utf-8") == first
