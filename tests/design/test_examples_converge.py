"""Every example and template comes to an answer: what a user starts from converges inside its range."""

from __future__ import annotations

from pathlib import Path

import pytest
from kept_runs import kept_run

ROOT = Path(__file__).resolve().parents[2]
#: A structure of another package, records and studies are no cases that this package runs.
FILES = sorted(
    path
    for folder in (ROOT / "examples", ROOT / "src" / "moyai" / "structures")
    for path in folder.rglob("*.yaml")
    if "new_structure" not in path.parts and "\nstructure:" in path.read_text(encoding="utf-8")
)


@pytest.mark.slow
@pytest.mark.parametrize("file", FILES, ids=lambda path: path.relative_to(ROOT).as_posix())
def test_it_converges(file: Path) -> None:
    result = kept_run(file)
    assert result.status == "converged", result.message
    assert all(check.passed for check in result.checks)
