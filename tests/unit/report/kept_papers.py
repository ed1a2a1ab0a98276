"""Lets ``moyai reproduce`` take a paper that is kept, for tests of what the command makes of it."""

from dataclasses import replace
from typing import Any

import pytest
from kept_runs import kept_paper

from moyai.reproduce import reproduction, stored


def take_kept_paper(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """Let the command find the quick run of a paper done; points are laid over and the page is made as always."""
    found = kept_paper(name, quick=True)

    def run(quick: bool, progress: Any) -> Any:
        assert quick
        progress("parts of the paper", 1, 1)
        return found

    paper = replace(found.paper, run=run, figures=lambda runs: runs.figures, filled=lambda runs: runs.filled)
    for module in (reproduction, stored):
        monkeypatch.setattr(module, "paper", {name: paper}.__getitem__)
    monkeypatch.setattr(reproduction, "rows_of", lambda _, runs: runs.rows)
