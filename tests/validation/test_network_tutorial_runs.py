"""The tutorial of networks does what it says: its case is read, its Python blocks run as they stand."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

PAGE = Path(__file__).parents[2] / "docs" / "tutorial" / "network.md"


def blocks(language: str) -> list[str]:
    return re.findall(rf"```{language}\n(.*?)```", PAGE.read_text(encoding="utf-8"), flags=re.DOTALL)


@pytest.mark.slow
def test_the_tutorial_of_networks_runs(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    case = next(block for block in blocks("yaml") if block.startswith("moyai: 1"))
    Path("buoy.yaml").write_text(case, encoding="utf-8")
    scope: dict = {}
    for block in blocks("python"):
        exec(compile(block, PAGE.name, "exec"), scope)
    said = capsys.readouterr().out
    assert "converged" in said
    assert re.search(r"peak \d+\.\d+ kN, uncertainty \+-\d", said)
    assert "natural periods" in said
    assert (tmp_path / "buoy-report" / "report.html").stat().st_size > 1e5
    assert scope["error"] < 0.1
    page = (tmp_path / "buoy-report" / "report.html").read_text(encoding="utf-8")
    assert '"scene-3d"' in page
