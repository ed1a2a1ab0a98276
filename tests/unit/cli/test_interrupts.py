"""Ctrl-C leaves a readable partial result and the exit code 1."""

import os
import signal
import subprocess
import sys
import time

import pytest

from moyai.case.reader import load_case
from moyai.case.templates import template
from moyai.cli.runner import run
from moyai.core.results import read_result


@pytest.fixture
def case_file(tmp_path):
    path = tmp_path / "pontoon.yaml"
    path.write_text(template("breakwater"), encoding="utf-8")
    return path


@pytest.mark.slow
@pytest.mark.parametrize("stop_after", [1, 3])
def test_an_interrupt_hands_back_what_there_is(case_file, tmp_path, stop_after):
    steps = []

    def listen(what, done, total):
        steps.append((what, done, total))
        assert total > 0
        if len(steps) > stop_after:
            raise KeyboardInterrupt

    result = run(load_case(case_file), listen)
    assert result.status == "interrupted"
    again = read_result(result.write(tmp_path / "results.nc"))
    assert again.status == "interrupted"
    assert again.provenance["title"] == "Floating breakwater"


@pytest.mark.slow
@pytest.mark.skipif(sys.platform == "win32", reason="signals of another process differ there")
@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_signals_end_a_long_run_with_a_partial_result(case_file, tmp_path, number):
    """A run of many long seas is stopped in the middle; what was finished can be read."""
    text = template("breakwater").replace(
        "periods: {from: 3 s, to: 8 s, count: 11}", "periods: {from: 3 s, to: 8 s, count: 400}"
    )
    case_file.write_text(text, encoding="utf-8")
    out = tmp_path / "out"
    command = [sys.executable, "-m", "moyai.cli.main", "run", str(case_file), "--output", str(out), "--no-report"]
    # a suite that runs in the background of a shell hands down interrupts as ignored
    process = subprocess.Popen(
        command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, env=dict(os.environ),
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL),
    )  # fmt: skip
    deadline = time.monotonic() + 120.0
    while not out.exists() and time.monotonic() < deadline:
        time.sleep(0.1)
    time.sleep(6.0)
    process.send_signal(number)
    output, errors = process.communicate(timeout=120)
    assert process.returncode == 1, errors
    assert b"Traceback" not in errors
    assert b"interrupted" in output
    assert read_result(out / "results.nc").status == "interrupted"
    assert [path.name for path in out.iterdir()] == ["results.nc"]


@pytest.mark.slow
@pytest.mark.parametrize("closing", [pytest.param(">&-", marks=pytest.mark.slow), ">&- 2>&-", "| true"])
@pytest.mark.parametrize(
    "command",
    [
        "new",
        pytest.param("new breakwater --json", marks=pytest.mark.slow),
        pytest.param("schema", marks=pytest.mark.slow),
    ],
)
def test_closed_standard_output_ends_without_a_traceback(tmp_path, command, closing):
    line = f"{sys.executable} -m moyai {command} 2>{tmp_path / 'errors'} {closing}"
    subprocess.run(["/bin/sh", "-c", line], check=False)
    errors = (tmp_path / "errors").read_text(encoding="utf-8")
    assert "Traceback" not in errors and "internal error" not in errors


@pytest.mark.skipif(sys.platform == "win32", reason="signals to oneself differ there")
def test_an_interrupt_waits_for_an_import(tmp_path):
    (tmp_path / "half.py").write_text(
        "import os, signal, time\nos.kill(os.getpid(), signal.SIGINT)\ntime.sleep(0.1)\ncomplete = 'complete'\n",
        encoding="utf-8",
    )
    program = (
        "import signal, time\n"
        "from moyai.core.interrupts import interrupt\n"
        "signal.signal(signal.SIGINT, interrupt)\n"
        "try:\n"
        "    import half\n"
        "    time.sleep(20.0)\n"
        "except KeyboardInterrupt:\n"
        "    print(half.complete)\n"
    )
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, cwd=tmp_path, timeout=60.0)
    assert done.stdout.strip() == "complete", done.stderr


@pytest.mark.skipif(sys.platform == "win32", reason="signals to oneself differ there")
def test_an_interrupt_waits_for_an_object_that_is_given_up():
    """Python drops what is raised there."""
    program = (
        "import os, signal, time\n"
        "from moyai.core.interrupts import interrupt\n"
        "signal.signal(signal.SIGINT, interrupt)\n"
        "class Given:\n"
        "    def __del__(self):\n"
        "        os.kill(os.getpid(), signal.SIGINT)\n"
        "        time.sleep(0.1)\n"
        "try:\n"
        "    one = Given()\n"
        "    del one\n"
        "    time.sleep(20.0)\n"
        "except KeyboardInterrupt:\n"
        "    print('heard')\n"
    )
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, timeout=60.0)
    assert done.stdout.strip() == "heard" and not done.stderr, done.stderr


@pytest.mark.skipif(sys.platform == "win32", reason="signals to oneself differ there")
@pytest.mark.parametrize("when", ["results", "report", "twice"])
def test_results_stay_whenever_the_writing_is_interrupted(tmp_path, when):
    """A second Ctrl-C while the first is answered changes nothing."""
    folder = tmp_path / "out"
    folder.mkdir()
    (folder / "results.nc").write_text("old", encoding="utf-8")
    (folder / "report.html").write_text("old", encoding="utf-8")
    program = (
        "import os, signal, sys\n"
        "from pathlib import Path\n"
        "from moyai.core import run_folder as it\n"
        "from moyai.core.interrupts import held_back, interrupt\n"
        "signal.signal(signal.SIGINT, interrupt)\n"
        "folder, when = Path(sys.argv[1]), sys.argv[2]\n"
        "call = lambda: os.kill(os.getpid(), signal.SIGINT)\n"
        "removed = it._remove\n"
        "try:\n"
        "    with it.staged_outputs(folder) as staged, it.keeping_results(staged, folder):\n"
        "        with held_back():\n"
        "            if when == 'results':\n"
        "                call()\n"
        "            (staged / 'results.nc').write_text('new', encoding='utf-8')\n"
        "        (staged / 'report.html').write_text('half', encoding='utf-8')\n"
        "        if when == 'twice':\n"
        "            it._remove = lambda path: (call(), removed(path))\n"
        "        call()\n"
        "        import time; time.sleep(5.0)\n"
        "except KeyboardInterrupt:\n"
        "    print('heard')\n"
    )
    done = subprocess.run(
        [sys.executable, "-c", program, str(folder), when], capture_output=True, text=True, timeout=60.0
    )
    assert done.stdout.strip().startswith("heard"), done.stderr
    assert (folder / "results.nc").read_text(encoding="utf-8") == "new"
    assert not (folder / "report.html").exists()
