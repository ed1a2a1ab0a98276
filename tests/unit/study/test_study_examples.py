"""The studies that stand in the repository name only what their cases tell."""

import json
from pathlib import Path

import pytest
from typer.testing import CliRunner

from moyai.cli.main import app

FOLDER = Path(__file__).parents[3] / "examples" / "study"


@pytest.mark.slow
@pytest.mark.parametrize("name", sorted(path.name for path in FOLDER.glob("*.yaml")))
def test_an_example_passes_its_trial(name):
    done = CliRunner().invoke(app, ["study", str(FOLDER / name), "--check", "--json"])
    assert done.exit_code == 0, done.output
    reported = json.loads(done.stdout)
    assert reported["trial_status"] == "converged" and reported["expected_seconds"] > 0.0
