"""Exit codes keep computation and design apart; progress in a pipe is a line every so often."""

from __future__ import annotations

import json
import time

import pytest
from click.testing import Result
from typer.testing import CliRunner

from moyai.cli import console
from moyai.cli.console import FAILED, NOT_HELD, OK
from moyai.cli.main import app, exit_code
from moyai.core.collected import Collected
from moyai.core.headline import Criterion, Headline
from moyai.core.validity import IdentityCheck, Notice
from moyai.core.vocabulary import Vocabulary

DEPTH = Criterion("least_effective_depth", "effective_depth", 4.0, "at least", "case file", "effective depth", "m")


def result(depth: float, *notices: Notice, failure: str = "", violation: float = 0.0):
    collected = Collected()
    collected.notices.extend(notices)
    collected.failures.extend([failure] if failure else [])
    collected.checks.append(IdentityCheck("balance", violation, 1e-6))
    headlines = (Headline("effective_depth", "Effective depth", depth, "m"),)
    attributes = {"title": "t", "case_hash": "h", "structure": "curtain"}
    return collected.close(Vocabulary.of("curtain", {}), attributes, headlines=headlines, criteria=(DEPTH,))


OUTSIDE = Notice("range", "the wave breaks", severity="error")


@pytest.mark.parametrize(
    ("found", "plain", "asked"),
    [
        (result(5.0), OK, OK),
        (result(1.99), OK, NOT_HELD),
        (result(5.0, OUTSIDE), OK, NOT_HELD),
        (result(1.99, OUTSIDE), OK, NOT_HELD),
        (result(5.0, failure="no equilibrium"), FAILED, FAILED),
        (result(5.0, violation=1.0), FAILED, FAILED),
    ],
)
def test_exit_codes(found, plain, asked):
    assert exit_code(found, require_hold=False) == plain
    assert exit_code(found, require_hold=True) == asked


def test_a_pipe_gets_lines_while_a_long_step_runs(capsys):
    with console._lines(0.05) as listen:
        listen("time domain", 0, 4)
        listen("time domain", 1, 4)
        time.sleep(0.3)
    lines = capsys.readouterr().err.splitlines()
    assert 2 <= len(lines) <= 7
    assert all(line.startswith("time domain: 25 %") for line in lines)


def test_quiet_gets_none(capsys):
    with console.progress_bars(True) as listen:
        listen("time domain", 0, 4)
    assert capsys.readouterr().err == ""


def test_run_and_check_say_verdict_and_criteria(tmp_path, monkeypatch):
    text = """\
moyai: 1
title: Pontoon
site: {water_depth: 10 m, density: 1025 kg/m3, gravity: 9.81 m/s2}
structure:
  kind: breakwater
  length: 21 m
  section: {shape: rectangle, beam: 10 m, height: 4.5 m}
  draught: 3 m
  centre_of_gravity_above_keel: 2.29 m
  roll_gyradius: 2.67 m
criteria: {least_freeboard: 2 m}
analyses: [statics]
"""
    (tmp_path / "case.yaml").write_text(text, encoding="utf-8")

    monkeypatch.chdir(tmp_path)

    def moyai(*arguments: str) -> Result:
        return CliRunner().invoke(app, list(arguments))

    reported = json.loads(moyai("check", "case.yaml", "--json").stdout)
    limits = {item["name"]: item["limit"] for item in reported["criteria"]}
    assert limits == {"least_freeboard": 2.0, "least_metacentric_height": pytest.approx(0.05 * 3.0)}
    assert "Freeboard" in moyai("check", "case.yaml").stdout
    done = moyai("run", "case.yaml", "--json", "--no-report", "--require-hold")
    record = json.loads(done.stdout)
    # whatever of it is found: a freeboard of 1.5 m never holds against 2 m
    assert record["status"] == "converged" and record["verdict"]["outcome"] != "holds"
    assert done.exit_code == NOT_HELD
    assert moyai("run", "case.yaml", "--no-report", "--quiet").exit_code == OK
