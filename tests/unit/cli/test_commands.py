"""The commands: what they print, what they write, how they end."""

import json
import subprocess
import sys

import pytest
from typer.testing import CliRunner

from moyai.case.templates import template
from moyai.cli import main as command_line
from moyai.cli.main import app
from moyai.core.errors import ConvergenceError
from moyai.core.kinds import templates

runner = CliRunner()

QUICK = (
    template("breakwater")
    .replace("analyses: [statics, mooring, frequency, time]", "analyses: [statics, mooring]")
    .replace("water_levels: {HWL: 1.5 m, LWL: 0 m} ", "water_levels: {MSL: 0.5 m} ")
)


@pytest.fixture
def case(tmp_path):
    path = tmp_path / "pontoon.yaml"
    path.write_text(QUICK, encoding="utf-8")
    return path


def moyai(*arguments, **options):
    """Run the installed command as a user does."""
    command = [sys.executable, "-m", "moyai.cli.main", *map(str, arguments)]
    return subprocess.run(command, capture_output=True, timeout=300, **options)


def test_the_entry_point_imports_nothing_heavy():
    code = (
        "import sys, moyai.cli.main; "
        "print([name for name in ('numpy', 'scipy', 'numba', 'xarray', 'pydantic', 'yaml', 'rich.table') "
        "if name in sys.modules])"
    )
    found = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert found.stdout.strip() == "[]"


def test_help_lists_the_commands():
    found = runner.invoke(app, ["--help"])
    assert found.exit_code == 0
    for name in ("new", "check", "schema", "run", "validate"):
        assert name in found.stdout


def test_version():
    from moyai import __version__

    assert runner.invoke(app, ["--version"]).stdout == f"moyai {__version__}\n"


def test_new_prints_the_template_and_writes_it(tmp_path):
    assert runner.invoke(app, ["new", "breakwater"]).stdout == template("breakwater")
    target = tmp_path / "deep" / "mine.yaml"
    assert runner.invoke(app, ["new", "breakwater", "--output", str(target)]).exit_code == 0
    assert target.read_text(encoding="utf-8") == template("breakwater")
    assert [path.name for path in target.parent.iterdir()] == ["mine.yaml"]
    refused = runner.invoke(app, ["new", "breakwater", "-o", str(target)])
    assert (refused.exit_code, "exists" in refused.stderr) == (2, True)
    assert runner.invoke(app, ["new", "breakwater", "-o", str(target), "--force"]).exit_code == 0


def test_new_of_an_unknown_kind():
    found = runner.invoke(app, ["new", "breakwatr"])
    assert found.exit_code == 2
    allowed = ", ".join(templates())
    assert found.stderr.strip() == (
        f"KIND: there is no file of kind 'breakwatr'; allowed: {allowed}; did you mean 'breakwater'?"
    )
    assert found.stdout == ""


def test_check_prints_the_derived_numbers(case):
    found = runner.invoke(app, ["check", str(case)])
    assert found.exit_code == 0, found.output
    for words in ("draught", "natural period, heave", "relative depth kh", "MSL", "no errors"):
        assert words in found.stdout


def test_check_as_json_agrees_with_hand_calculation(case):
    found = json.loads(runner.invoke(app, ["check", str(case), "--json"]).stdout)
    numbers = {record["label"]: record["value_si"] for record in found["derived"]}
    assert found["valid"] is True
    assert len(found["case_hash"]) == 64
    assert numbers["displaced mass"] == pytest.approx(1025.0 * 10.0 * 3.0 * 21.0)
    assert numbers["freeboard"] == pytest.approx(1.5)
    # GM of a box from BM = B^2/12d, KB = d/2 and KG
    assert numbers["metacentric height GM"] == pytest.approx(100.0 / 36.0 + 1.5 - 2.29, rel=1e-6)
    # deep-water limit of the shortest wave, 3 s: L = g T^2/2 pi to 1e-4 at kh = 4.7
    assert numbers["wavelength, T = 3 s"] == pytest.approx(9.81 * 9.0 / 6.283185307, rel=2e-4)
    assert numbers["relative depth kh, T = 3 s"] == pytest.approx(
        6.283185307 * 10.5 / numbers["wavelength, T = 3 s"], rel=1e-6
    )


def test_check_tells_every_fault_and_ends_with_two(case):
    case.write_text(QUICK.replace("draught: 3 m ", "draugth: 3 m ").replace("gravity: 9.81 m/s2", "gravity: 9.81 m/s"))
    found = runner.invoke(app, ["check", str(case)])
    assert found.exit_code == 2
    lines = found.stderr.splitlines()
    assert lines[0].startswith(f"{case}:17:12: site.gravity: expected an acceleration")
    assert "did you mean 'draught'?" in lines[1]
    assert lines[2] == "2 errors"
    assert found.stdout == ""


def test_faults_as_json(case):
    case.write_text(QUICK.replace("draught: 3 m ", "draugth: 3 m "))
    for command in ("check", "run"):
        found = runner.invoke(app, [command, str(case), "--json"])
        assert found.exit_code == 2
        (fault,) = json.loads(found.stdout)["faults"]
        assert fault["path"] == "structure.draugth"
        assert fault["file"] == str(case)
        assert fault["line"] > 0
        assert fault["remedy"] == "did you mean 'draught'?"


def test_missing_file_and_folder(tmp_path):
    assert "no such file" in runner.invoke(app, ["check", str(tmp_path / "none.yaml")]).stderr
    assert runner.invoke(app, ["run", str(tmp_path)]).exit_code == 2


@pytest.mark.slow
def test_schema_is_json(tmp_path):
    from moyai.case.schema import json_schema

    assert json.loads(runner.invoke(app, ["schema"]).stdout) == json_schema()
    target = tmp_path / "moyai.schema.json"
    assert runner.invoke(app, ["schema", "--output", str(target)]).exit_code == 0
    assert json.loads(target.read_text(encoding="utf-8")) == json_schema()


def test_run_writes_results_and_says_what_governs(case, tmp_path):
    from moyai.core.results import read_result

    out = tmp_path / "out"
    found = runner.invoke(app, ["run", str(case), "--output", str(out)])
    assert found.exit_code == 0, found.output
    assert {path.name for path in out.iterdir()} >= {"results.nc", "report.html"}
    assert not list(out.rglob("*.partial"))
    assert "identity checks passed" in found.stdout
    assert "converged" in found.stdout
    assert read_result(out / "results.nc").status == "converged"


def test_run_as_json_without_report(case, tmp_path):
    out = tmp_path / "out"
    found = runner.invoke(app, ["run", str(case), "--output", str(out), "--json", "--no-report"])
    record = json.loads(found.stdout)
    assert found.exit_code == 0
    assert record["status"] == "converged"
    assert record["files"] == [str(out / "results.nc")]
    assert [path.name for path in out.iterdir()] == ["results.nc"]
    assert all(check["passed"] for check in record["checks"])
    assert found.stderr == ""


def test_run_from_python_takes_the_same_road(case):
    import moyai

    result = moyai.run(moyai.load_case(case))
    assert result.status == "converged"
    assert "MSL" in result.tree


@pytest.mark.parametrize("place", ["file", "below a file"])
def test_unwritable_output_is_reported_before_the_work_starts(case, tmp_path, monkeypatch, place):
    def never(*arguments):
        raise AssertionError("the work was started")

    monkeypatch.setattr("moyai.cli.runner.run", never)
    blocker = tmp_path / "taken"
    blocker.write_text("mine")
    target = blocker if place == "file" else blocker / "below"
    found = runner.invoke(app, ["run", str(case), "--output", str(target)])
    assert found.exit_code == 2
    assert found.stderr.splitlines()[-1].startswith("output: ")
    assert blocker.read_text() == "mine"


def test_bad_input_makes_no_folder(case, tmp_path):
    case.write_text("moyai: 1\n")
    assert runner.invoke(app, ["run", str(case), "--output", str(tmp_path / "out")]).exit_code == 2
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize(
    ("error", "code", "words"),
    [
        (ConvergenceError("residual 1e-3 after 50 steps", path="frequency"), 1, "frequency: residual 1e-3"),
        (RuntimeError("odd"), 1, "internal error, RuntimeError: odd; this is a fault of moyai; run again with --debug"),
        (KeyboardInterrupt(), 1, "interrupted before there was a result"),
        (MemoryError(), 1, "internal error, MemoryError"),
    ],
)
def test_whatever_goes_wrong_is_one_message_without_traceback(case, tmp_path, monkeypatch, error, code, words):
    def fail(*arguments, **options):
        raise error

    monkeypatch.setattr("moyai.cli.runner.run", fail)
    found = runner.invoke(app, ["run", str(case), "--output", str(tmp_path / "out"), "--quiet"])
    assert found.exit_code == code
    assert words in found.stderr
    assert "Traceback" not in found.output
    assert not (tmp_path / "out" / "results.nc").exists()


def test_debug_shows_the_traceback(case, tmp_path, monkeypatch):
    def fail(*arguments, **options):
        raise RuntimeError("odd")

    monkeypatch.setattr("moyai.cli.runner.run", fail)
    monkeypatch.setattr(command_line.Debug, "on", True)
    found = runner.invoke(app, ["run", str(case), "--output", str(tmp_path / "out")])
    assert isinstance(found.exception, RuntimeError)


def test_a_result_that_did_not_converge_ends_with_one(case, tmp_path, monkeypatch):
    from dataclasses import replace

    from moyai.cli import runner as runs

    whole = runs.run

    def worse(*arguments, **options):
        return replace(whole(*arguments, **options), status="not_converged", message="residual 0.1")

    monkeypatch.setattr(runs, "run", worse)
    arguments = ["run", str(case), "--output", str(tmp_path / "out"), "--no-report", "--quiet"]
    found = runner.invoke(app, arguments)
    assert found.exit_code == 1
    assert found.stderr.splitlines()[-1] == "not_converged: residual 0.1"


def test_wrong_usage_ends_with_two():
    for arguments in (["run"], ["nonsense"], ["check", "a.yaml", "--nonsense"]):
        assert runner.invoke(app, arguments).exit_code == 2


@pytest.mark.slow
@pytest.mark.parametrize("encoding", ["cp932", pytest.param("cp1252", marks=pytest.mark.slow)])
def test_no_console_encoding_stops_a_command(tmp_path, encoding):
    """Windows consoles: a title that the code page cannot show is printed with replacements."""
    path = tmp_path / "浮防波堤.yaml"
    path.write_text(QUICK.replace("title: Floating breakwater", "title: 浮防波堤 caf\xe9 \u2764"), encoding="utf-8")
    environment = {"PYTHONIOENCODING": f"{encoding}:strict", "PYTHONUTF8": "0"}
    import os

    for arguments, code in ((["check", path], 0), (["check", tmp_path / "無.yaml"], 2)):
        found = moyai(*arguments, env={**os.environ, **environment})
        assert found.returncode == code, found.stderr
        assert b"Traceback" not in found.stderr
        found.stdout.decode(encoding)


def test_debug_is_understood_anywhere(tmp_path):
    found = moyai("check", tmp_path / "none.yaml", "--debug")
    assert found.returncode == 2
    assert b"no such file" in found.stderr
