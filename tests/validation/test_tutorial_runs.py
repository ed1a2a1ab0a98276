"""The tutorial does what it says: its case is read, its Python blocks run as they stand."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

PAGE = Path(__file__).parents[2] / "docs" / "tutorial" / "first_breakwater.md"


def blocks(language: str) -> list[str]:
    return re.findall(rf"```{language}\n(.*?)```", PAGE.read_text(encoding="utf-8"), flags=re.DOTALL)


@pytest.mark.slow
def test_first_breakwater(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    case = next(block for block in blocks("yaml") if block.startswith("moyai: 1"))
    # three minutes of storm, once, on quasi-static lines show the page's words and take less of a test's time
    assert "settings:" not in case
    quick = "settings: {time: {realisations: 1, lines: {mode: quasi_static}}}\n"
    Path("harbour.yaml").write_text(case.replace("duration: 20 min", "duration: 3 min") + quick, encoding="utf-8")
    scope: dict = {}
    for block in blocks("python"):
        exec(compile(block, PAGE.name, "exec"), scope)
    said = capsys.readouterr().out
    assert "converged" in said and "K_T" in said and "kN" in said
    assert (tmp_path / "harbour-report" / "report.html").stat().st_size > 1e6


def test_variation_of_the_tutorial_is_understood(tmp_path):
    from moyai.case.reader import load_case

    case, variation = (block for block in blocks("yaml"))
    file = tmp_path / "harbour.yaml"
    file.write_text(case + variation, encoding="utf-8")
    assert load_case(file).kind == "breakwater"


@pytest.mark.slow
def test_case_of_the_tutorial_without_lines_has_a_report(tmp_path):
    import moyai

    text = next(block for block in blocks("yaml") if block.startswith("moyai: 1"))
    text = text[: text.index("lines:")] + "analyses: [statics, frequency]\nsettings: {drift: false}\n"
    file = tmp_path / "harbour.yaml"
    file.write_text(text, encoding="utf-8")
    result = moyai.run(moyai.load_case(file))
    assert result.status == "converged", result.message
    assert moyai.write_report(result, tmp_path / "report")
