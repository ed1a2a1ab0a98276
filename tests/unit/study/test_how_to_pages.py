"""The pages of questions: their study files are read as they stand, over the template that they name."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from moyai.case.templates import template
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
