"""The tutorial of records does what it says: its file is read, its Python blocks run as they stand."""

import re
from pathlib import Path

import pytest

PAGE = Path(__file__).parents[2] / "docs" / "tutorial" / "records_to_model.md"


@pytest.mark.slow
def test_records_to_model(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    text = PAGE.read_text(encoding="utf-8")
    survey = re.search(r"```yaml\n(.*?)```", text, flags=re.DOTALL)[1]
    Path("storm.yaml").write_text(survey, encoding="utf-8")
    scope: dict = {}
    for block in re.findall(r"```python\n(.*?)```", text, flags=re.DOTALL):
        exec(compile(block, PAGE.name, "exec"), scope)
    said = capsys.readouterr().out
    assert "18 blocks" in said and "flagged as missing" in said
    product = float(re.search(r"M m_B = (\d+)", said)[1])
    assert abs(product / scope["laws"].mass_product - 1.0) < 0.25
    assert "bias, model minus record: -0.04" in said
    assert (tmp_path / "storm-report" / "report.html").stat().st_size > 1e5
