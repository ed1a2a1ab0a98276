"""Reports of records in Japanese: no English word left, every number that of the English report, no letter missing."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest
from japanese import compared_document, drawn_without_boxes, without_boxes, words_of
from test_net_campaign import EXAMPLE as NETS
from test_net_campaign import folder as net_folder
from test_net_campaign import reduced
from test_snap_runs import write_set
from test_streak_chain import changed
from test_streak_chain import folder as streak_folder
from test_survey_page import survey
from typer.testing import CliRunner

from moyai.cli.main import app
from moyai.core.results import Result, read_result
from moyai.report.fonts import packaged_font
from moyai.report.writer import compose_document

__all__ = ["net_folder", "streak_folder"]


def measured(kind: str, file: Path, *more: str) -> Result:
    """Return the result of ``moyai measure``, whose page is written in Japanese."""
    folder = file.parent / "page"
    found = CliRunner().invoke(app, ["--language", "ja", "measure", kind, str(file), "-o", str(folder), *more])
    assert found.exit_code == 0, found.output
    assert '<html lang="ja">' in (folder / "report.html").read_text(encoding="utf-8")
    return read_result(folder / "results.nc")


def assert_japanese(result: Result, least: int) -> None:
    """Hold the report of a result in Japanese against that in English."""
    document = compose_document(result, language="ja")
    left, count = compared_document(document, words_of(result))
    assert count > least
    assert not left, "\n".join(left)
    assert drawn_without_boxes(document, most=1) == 1
    if packaged_font() is not None:  # there is a font to hold the letters against
        found = without_boxes(document)
        assert found == {"page": set(), "PDF": set(), "Word": set()}


@pytest.mark.slow
def test_a_survey_of_waves(tmp_path: Path) -> None:
    assert_japanese(survey(tmp_path, 15.0), least=200)


@pytest.mark.slow
def test_impacts_of_curtains(tmp_path: Path) -> None:
    assert_japanese(measured("snaps", write_set(tmp_path)), least=150)


@pytest.mark.slow
def test_towed_nets(net_folder: tuple[Path, object], tmp_path: Path) -> None:
    place = net_folder[0]
    shutil.copytree(place / "records", tmp_path / "records")
    (tmp_path / "few.yaml").write_text(reduced(place), encoding="utf-8")
    assert_japanese(measured("nets", tmp_path / "few.yaml"), least=150)


@pytest.mark.slow
def test_all_runs_of_towed_nets(net_folder: tuple[Path, object]) -> None:
    assert NETS.is_dir()
    assert_japanese(measured("nets", net_folder[0] / "nets.yaml"), least=700)


@pytest.mark.slow
def test_streaks_of_particles(streak_folder: Path) -> None:
    fewer = changed(streak_folder, "fewer", ("run_*.png", "run_0.png, run_1.png"))
    assert_japanese(measured("streaks", fewer), least=100)
