"""The curtain tutorial does what it says: its case is read, its Python blocks run as they stand."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from moyai.case.reader import load_case
from moyai.core.errors import CaseError

PAGE = Path(__file__).parents[2] / "docs" / "tutorial" / "first_curtain.md"


def blocks(language: str) -> list[str]:
    return re.findall(rf"```{language}\n(.*?)```", PAGE.read_text(encoding="utf-8"), flags=re.DOTALL)


@pytest.mark.slow
def test_first_curtain(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    case = next(block for block in blocks("yaml") if block.startswith("moyai: 1"))
    Path("dredging.yaml").write_text(case, encoding="utf-8")
    scope: dict = {}
    for block in blocks("python"):
        exec(compile(block, PAGE.name, "exec"), scope)
    said = capsys.readouterr().out
    assert "converged" in said and "governs:" in said and "effective depth" in said
    assert re.search(r"0\.20 m/s: waves up to \d", said)
    assert (tmp_path / "dredging-report" / "report.html").stat().st_size > 1e5


def test_mistakes_of_the_curtain_tutorial_are_reported(tmp_path):
    case = next(block for block in blocks("yaml") if block.startswith("moyai: 1"))
    file = tmp_path / "dredging.yaml"
    file.write_text(case.replace("span: 15 m", "span: 17 m"), encoding="utf-8")
    with pytest.raises(CaseError, match="takes a shorter curtain as pretension"):
        load_case(file)
    small = case.replace("buoyancy: 980 N/m", "buoyancy: 500 N/m").replace("speed: 0.2 m/s", "speed: 0.6 m/s")
    small = small.replace("line_length: 30 m", "line_length: 10 m")
    file.write_text(small, encoding="utf-8")
    with pytest.raises(CaseError, match=r"submerges the floats.*less than 0\.\d+ m/s"):
        load_case(file)


def test_record_of_the_curtain_tutorial_is_understood(tmp_path):
    case, record, _ = (block for block in blocks("yaml"))
    file = tmp_path / "dredging.yaml"
    file.write_text(case + record, encoding="utf-8")
    with pytest.raises(CaseError, match=r"there is no file 'record.csv'"):
        load_case(file)


def test_span_in_motion_of_the_curtain_tutorial_is_understood(tmp_path):
    case, _, motion = (block for block in blocks("yaml"))
    file = tmp_path / "dredging.yaml"
    with_motion = case.replace("limits]", "limits, dynamic]").rstrip("\n") + "\n" + motion
    file.write_text(with_motion, encoding="utf-8")
    assert "dynamic" in load_case(file).model.analyses
