"""The app in a real browser: a case opens, a slider redraws its figures, nothing foreign is asked for, no error."""

from __future__ import annotations

import importlib.util
import os
import re
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from app_runs import MEMBER

pytest.importorskip("starlette")
pytest.importorskip("uvicorn")

_PIPE = Path(__file__).parents[1] / "report" / "chromium_pipe.py"
_spec = importlib.util.spec_from_file_location("chromium_pipe_of_reports", _PIPE)
assert _spec is not None and _spec.loader is not None
pipe = importlib.util.module_from_spec(_spec)
_spec.loader.exec_module(pipe)

pytestmark = [
    pytest.mark.browser,
    pytest.mark.skipif(
        pipe.find_chromium() is None, reason="Chromium is not installed (set MOYAI_CHROMIUM to its path)"
    ),
]


@pytest.fixture
def address(tmp_path: Path) -> Iterator[str]:
    (tmp_path / "pile.yaml").write_text(MEMBER)
    command = [sys.executable, "-m", "moyai", "app", str(tmp_path / "pile.yaml"), "--no-browser"]
    process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, env=os.environ)
    assert process.stdout is not None
    found = re.search(r"http://127\.0\.0\.1:\d+/\?token=\S+", process.stdout.readline())
    assert found is not None
    yield found[0]
    process.send_signal(2)
    out, errors = process.communicate(timeout=15)
    assert process.returncode == 0
    assert "has ended" in out and errors == ""


def until(page: Any, expression: str, seconds: float = 60.0) -> None:
    end = time.monotonic() + seconds
    while page.evaluate(f"Boolean({expression})") is not True:
        assert time.monotonic() < end, f"{expression}; errors: {page.errors}"
        time.sleep(0.05)


DRAWN = "Number(document.querySelector('.report')?.dataset.sequence || 0)"
MOVE = """(() => {
  const range = document.querySelector('.slider input[type=range]');
  range.value = 80;
  range.dispatchEvent(new Event('input', { bubbles: true }));
  range.dispatchEvent(new Event('change', { bubbles: true }));
})()"""
FORCES = "JSON.stringify([...MOYAI.figures.values()].map((figure) => figure.plot.data?.map((trace) => [...trace.y])))"


def test_a_slider_redraws_the_figures(address: str) -> None:
    with pipe.Chromium(str(pipe.find_chromium()), 1280, 900) as page:
        page.send("Page.navigate", url=address)
        until(page, f"{DRAWN} > 0")
        assert page.evaluate("location.href.includes('token')") is False
        assert "httponly" not in page.evaluate("document.cookie").lower() and page.evaluate("document.cookie") == ""
        until(page, "[...MOYAI.figures.values()].filter((one) => MOYAI.isVisible(one.plot)).every((one) => one.drawn)")
        before, number = page.evaluate(FORCES), page.evaluate(DRAWN)
        page.evaluate(MOVE)
        until(page, f"{DRAWN} > {number}")
        until(page, f"{FORCES} !== {before!r}")
        assert page.evaluate("document.querySelector('textarea').value") == MEMBER.replace("100 cm", "80 cm")

        page.evaluate("[...document.querySelectorAll('button')].find((one) => one.textContent === 'Undo').click()")
        until(page, f"{FORCES} === {before!r}")
        assert page.evaluate("document.querySelector('textarea').value") == MEMBER

        page.evaluate("""(() => {
          const area = document.querySelector('textarea');
          area.value = area.value.replace('water_depth', 'water_dept');
          area.dispatchEvent(new Event('input', { bubbles: true }));
        })()""")
        until(page, "document.querySelector('.gutter .error')?.textContent === '5'")
        page.evaluate("location.reload()")
        until(page, "document.querySelector('.gutter .error')?.textContent === '5'")

        for width in (390, 1280):
            page.resize(width, 900)
            assert page.evaluate("document.documentElement.scrollWidth <= innerWidth + 1"), width
        outside = [one for one in page.requests if not one.startswith((address.split("?")[0], "data:", "blob:"))]
        assert outside == []
        assert page.errors == []
