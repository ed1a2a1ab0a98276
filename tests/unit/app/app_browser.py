"""What the tests of the app in a browser share: the app as a process, waiting, words of its pages."""

from __future__ import annotations

import importlib.util
import os
import re
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pytest

from moyai.case.templates import template

pytest.importorskip("starlette")
pytest.importorskip("uvicorn")

_PIPE = Path(__file__).parents[1] / "report" / "chromium_pipe.py"
_spec = importlib.util.spec_from_file_location("chromium_pipe_of_reports", _PIPE)
assert _spec is not None and _spec.loader is not None
pipe = importlib.util.module_from_spec(_spec)
_spec.loader.exec_module(pipe)

NEEDS_CHROMIUM = [
    pytest.mark.browser,
    pytest.mark.skipif(
        pipe.find_chromium() is None, reason="Chromium is not installed (set MOYAI_CHROMIUM to its path)"
    ),
]


KINDS = ("breakwater", "curtain", "cage", "rigid_cage", "network", "member")


@contextmanager
def app_at(start: Path, *options: str) -> Iterator[str]:
    command = [sys.executable, "-m", "moyai", *options, "app", str(start), "--no-browser"]
    process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, env=os.environ)
    assert process.stdout is not None
    found = re.search(r"http://127\.0\.0\.1:\d+/\?token=\S+", process.stdout.readline())
    assert found is not None
    try:
        yield found[0]
        process.send_signal(2)
        out, errors = process.communicate(timeout=15)
    finally:
        process.kill()  # where the test has failed
    assert process.returncode == 0
    assert ("終了した" if options else "has ended") in out and errors == ""


def only(name: str, analyses: str) -> str:
    return re.sub("^analyses:.*$", f"analyses: [{analyses}]", template(name), flags=re.MULTILINE)


def at_one_level(text: str) -> str:
    return text.replace("{HWL: 1.5 m, LWL: 0 m}", "{HWL: 1.5 m}")


def until(page: Any, expression: str, seconds: float = 60.0) -> None:
    end = time.monotonic() + seconds

    def holds() -> bool:
        try:
            return bool(page.evaluate(f"Boolean({expression})"))
        except RuntimeError as error:
            if "navigated" in str(error):
                return False  # asked while the page was loaded again
            raise

    while not holds():
        assert time.monotonic() < end, f"{expression}; errors: {page.errors}"
        time.sleep(0.05)


def sound(page: Any, address: str) -> None:
    """No console error, and nothing asked of another place."""
    outside = [one for one in page.requests if not one.startswith((address.split("?")[0], "data:", "blob:"))]
    assert outside == []
    assert page.errors == []


DRAWN = "Number(document.querySelector('.report')?.dataset.sequence || 0)"
IDLE = "document.querySelector('.state') && !document.querySelector('.state.working')"
TEXT = "document.querySelector('.text-pane').editor.text"
STATE = "document.querySelector('.state').textContent"
TO_DO = """['Undo', 'Save'].map((words) =>
  [...document.querySelectorAll('.toolbar button')].find((one) => one.textContent === words).disabled)"""
ON_SCREEN = "[...MOYAI.figures.values()].filter((one) => MOYAI.isVisible(one.plot)).every((one) => one.drawn)"
FIRST_ERROR = "document.querySelector('.faults .error button')?.textContent"
MOVE = """((value) => {
  const range = document.querySelector('.slider input[type=range]');
  range.value = value ?? Number(range.max) - 2 * Number(range.step);
  range.dispatchEvent(new Event('input', { bubbles: true }));
  range.dispatchEvent(new Event('change', { bubbles: true }));
})"""
FORCES = "JSON.stringify([...MOYAI.figures.values()].map((figure) => figure.plot.data?.map((trace) => [...trace.y])))"
PRESS = "((words) => [...document.querySelectorAll('button')].find((one) => one.textContent === words).click())"
REPORT = "[...document.querySelectorAll('.job-files a')].find((one) => one.textContent === 'Report').click()"
DIAMETER = "document.querySelector('.form [data-path=\"structure.section.diameter\"]')"
SET = """((path, value) => {
  const field = document.querySelector(`.form [data-path="${path}"]`);
  field.value = value;
  field.dispatchEvent(new Event('change', { bubbles: true }));
})"""
WHOLE = "document.querySelector('.report')?.dataset.whole === '1'"
MOVE_ONE = """((path, value) => {
  const label = [...document.querySelectorAll('.slider label')].find((one) => one.title === path);
  const range = document.getElementById(label.getAttribute('for'));
  range.value = value;
  for (const name of ['input', 'change']) range.dispatchEvent(new Event(name, { bubbles: true }));
})"""
