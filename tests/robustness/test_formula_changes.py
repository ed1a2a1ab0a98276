"""The list of changed formulas: every line that it changes stands in the package, and the change can be read."""

from __future__ import annotations

import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "benchmarks"))

from mutate_formulas import listed  # noqa: E402


def test_every_change_of_the_list_applies() -> None:
    changes = listed()
    assert len(changes) == len(set(changes)) == 100
    for change in changes:
        path = ROOT / "src" / "moyai" / change.file
        text = path.read_text(encoding="utf-8")
        found = change.applied(text)
        assert found != text and len(found.split("\n")) == len(text.split("\n")), change
        compile(found, change.file, "exec")
