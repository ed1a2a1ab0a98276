"""The pages of questions: their study files are read as they stand, over the template that they name."""

from __future__ import annotations

import json
import re
from pathlib import Path

import pytest
from typer.testing import CliRunner
from written_tables import DOCS, differences, tables_of

from moyai.case.templates import template
from moyai.cli.main import app
from moyai.study.plan import check_cases, load_study

PAGES = DOCS / "how_to"


@pytest.mark.slow
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
    (table,) = tables_of(PAGES / page).values()
    return table, answers


@pytest.mark.slow
@pytest.mark.parametrize(("page", "kind", "file", "order", "scales"), [
    ("which_chain.md", "breakwater", "chain.yaml", "00 10 20 01 11 21", (1e3, 1.0, 1.0)),
    ("how_deep_skirt.md", "curtain", "skirt.yaml", "00 10 01 11 20 21", (1.0, 1.0, 1e3)),
])  # fmt: skip
def test_the_table_of_the_page_is_what_its_study_answers(tmp_path, page, kind, file, order, scales):
    """``order``: of each number in a row, the query of the page and the column of its answer."""
    table, answers = _study_of(page, file, kind, tmp_path)
    assert len(answers) == 3 and len(table) == 3
    values = [
        [answers[query][number][column] / scales[query] for query, column in (map(int, one) for one in order.split())]
        for number in range(3)
    ]
    assert differences([row[1:] for row in table], values) == []
