"""Results kept for pages and tests: each case is run once, and what is read is what was computed."""

from __future__ import annotations

from pathlib import Path

import kept_runs
import pytest

import moyai

SHORT = {"name": "swell", "kind": "regular", "height": "1 m", "periods": [6.0], "heading_deg": 0}


@pytest.fixture
def runs(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> list[str]:
    """Return the list that every run of a case goes into."""
    found: list[str] = []
    real = moyai.run

    def run(case):
        found.append(case.title)
        return real(case)

    monkeypatch.setattr(moyai, "run", run)
    monkeypatch.setenv(kept_runs.FOLDER, str(tmp_path))
    return found


@pytest.mark.slow
def test_a_case_is_run_once_and_read_as_it_was(runs: list[str], monkeypatch: pytest.MonkeyPatch) -> None:
    case = moyai.load_case(moyai.template("member")).replace("waves", SHORT)
    first, second = (kept_runs.kept_run(case) for _ in range(2))
    assert runs == [case.title]
    monkeypatch.delenv(kept_runs.FOLDER)
    fresh = kept_runs.kept_run(case)
    assert runs == [case.title] * 2
    for found in (first, second):
        assert repr((found.headlines, found.verdict)) == repr((fresh.headlines, fresh.verdict))
        loads = [one.tree["SWL/waves/swell"].to_dataset() for one in (found, fresh)]
        assert len(loads[0]) > 5 and loads[0].identical(loads[1])


def test_a_value_is_computed_once_for_each_name(runs: list[str], monkeypatch: pytest.MonkeyPatch) -> None:
    for name in ("one", "one", "other"):
        assert kept_runs.kept_value(name, lambda name=name: runs.append(name) or name) == name
    assert runs == ["one", "other"]
    monkeypatch.delenv(kept_runs.FOLDER)
    assert kept_runs.kept_value("one", lambda: "fresh") == "fresh"


@pytest.mark.slow
def test_another_case_and_another_package_are_run(runs: list[str], monkeypatch: pytest.MonkeyPatch) -> None:
    case = moyai.load_case(moyai.template("member")).replace("waves", SHORT)
    kept_runs.kept_run(case)
    kept_runs.kept_run(case.replace("waves.height", "1.1 m"))
    assert len(runs) == 2
    monkeypatch.setattr(kept_runs, "package_stamp", lambda: "another")
    kept_runs.kept_run(case)
    assert len(runs) == 3
