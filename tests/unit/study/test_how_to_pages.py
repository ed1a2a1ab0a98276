"""The pages of questions: their study files are read as they stand, over the template that they name."""

from __future__ import annotations

import json
import re
from pathlib import Path

import pytest
from typer.testing import CliRunner

from moyai.case.templates import template
from moyai.cli.main import app
from moyai.study.plan import check_cases, load_study

PAGES = Path(__file__).parents[3] / "docs" / "how_to"


@pytest.mark.parametrize(("page", "kind", "file", "count"), [
    ("which_chain.md", "breakwater", "chain.yaml", 6), ("how_deep_skirt.md", "curtain", "skirt.yaml", 6),
])  # fmt: skip
def test_the_study_of_the_page_is_sound(tmp_path, page, kind, file, count):
    text = (PAGES / page).read_text(encoding="utf-8")
    assert f"moyai new {kind} --output {kind}.yaml" in text and f"moyai study {file}" in text
    (block,) = (one for one in re.findall(r"```yaml\n(.*?)```", text, flags=re.DOTALL) if one.startswith("moyai: 1"))
    (tmp_path / f"{kind}.yaml").write_text(template(kind), encoding="utf-8")
    (tmp_path / file).write_text(block, encoding="utf-8")
    study = load_study(tmp_path / file)
    assert len(study.cases) == count
    assert check_cases(study)[1] == ()


def _study_of(page: str, file: str, kind: str, folder: Path) -> tuple[list[list[str]], list[list[list[float]]]]:
    """Run the study of a page; return the rows of its table and, a query of the page each, the rows that it answers."""
    text = (PAGES / page).read_text(encoding="utf-8")
    (block,) = (one for one in re.findall(r"```yaml\n(.*?)```", text, flags=re.DOTALL) if one.startswith("moyai: 1"))
    (folder / f"{kind}.yaml").write_text(template(kind), encoding="utf-8")
    (folder / file).write_text(block, encoding="utf-8")
    runner, answers = CliRunner(), []
    ran = runner.invoke(app, ["study", str(folder / file), "-o", str(folder / "out"), "-q"])
    assert ran.exit_code == 0, ran.output
    for words in re.findall(r"^moyai query \S+ (.*)$", text, flags=re.MULTILINE):
        found = json.loads(runner.invoke(app, ["query", str(folder / "out"), *words.split(), "--json"]).stdout)
        answers.append([row[1:] for row in found["rows"]])
    table = [
        [cell.strip() for cell in line.strip("| \n").split("|")] for line in text.splitlines() if line[:3] != "|--"
    ]
    return [row for row in table if len(row) > 1][1:], answers


def _written(texts: list[str]) -> list[tuple[float, float]]:
    """Return the numbers of cells and half a unit of their last digit."""
    numbers = re.findall(r"none|\d[\d.]*", ", ".join(texts))
    return [(0.0, 0.5) if one == "none" else (float(one), 0.5 * 10.0 ** -len(one.partition(".")[2])) for one in numbers]


@pytest.mark.slow
@pytest.mark.parametrize(("page", "kind", "file", "order", "scales"), [
    ("which_chain.md", "breakwater", "chain.yaml", "00 10 20 01 11 21", (1e3, 1.0, 1.0)),
    ("how_deep_skirt.md", "curtain", "skirt.yaml", "00 10 01 11 20 21", (1.0, 1.0, 1e3)),
])  # fmt: skip
def test_the_table_of_the_page_is_what_its_study_answers(tmp_path, page, kind, file, order, scales):
    """``order``: of each number in a row, the query of the page and the column of its answer."""
    table, answers = _study_of(page, file, kind, tmp_path)
    assert len(answers) == 3 and len(table) == 3
    for number, row in enumerate(table):
        asked = [(int(query), int(column)) for query, column in order.split()]
        values = [answers[query][number][column] / scales[query] for query, column in asked]
        written = _written(row[1:])
        assert len(written) == len(values)
        for value, (shown, half) in zip(values, written, strict=True):
            assert abs(value - shown) <= 1.01 * half, f"{row}: {values}"
