"""Pages in Japanese show the case files of the English tutorials, letter by letter."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

DOCS = Path(__file__).resolve().parents[3] / "docs"


def blocks(path: Path) -> list[str]:
    """Return the blocks of YAML of a page."""
    return re.findall(r"```yaml\n(.*?)```", path.read_text(encoding="utf-8"), re.DOTALL)


@pytest.mark.parametrize("name", ["first_breakwater.md", "first_curtain.md"])
def test_case_files_are_those_of_the_english_page(name: str) -> None:
    japanese = blocks(DOCS / "ja" / name)
    assert len(japanese) >= 2
    assert japanese == blocks(DOCS / "tutorial" / name)
