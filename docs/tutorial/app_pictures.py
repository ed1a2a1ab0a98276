"""Make the pictures of the tutorial of the app: ``python docs/tutorial/app_pictures.py FOLDER [--all]``.

Starts the app on templates in a temporary folder and photographs it in headless Chromium; with ``--all`` every
structure, wide and narrow, light and dark, to be looked at; with ``--language ja`` all in Japanese.
"""

from __future__ import annotations

import argparse
import importlib.util
import re
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import Any

from moyai.case.templates import template
from moyai.language import said, speak
from moyai.language.catalogue import page_catalogue
from moyai.language.comments import with_comments

KINDS = ("breakwater", "curtain", "cage", "rigid_cage", "network", "member", "units")
DRAWN = (
    "document.querySelector('.state') && !document.querySelector('.state.working') && "
    "Number(document.querySelector('.report')?.dataset.sequence || 0) > 0"
)
STUDY = """\
moyai: 1
study:
  title: Diameter of the member and water depth
  base: member.yaml
  set: {analyses: [forces]}
  variations:
    - grid:
        structure.section.diameter: [0.3 m, 0.5 m, 0.7 m]
        site.water_depth: [15 m, 20 m]
  replays: 0
"""


def chromium() -> Any:
    """Return the module that drives Chromium, which stands with the tests of the reports."""
    path = Path(__file__).parents[2] / "tests" / "unit" / "report" / "chromium_pipe.py"
    spec = importlib.util.spec_from_file_location("chromium_pipe", path)
    assert spec is not None and spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def until(page: Any, expression: str, seconds: float = 180.0) -> None:
    """Wait for an expression of the page to hold."""
    end = time.monotonic() + seconds
    while page.evaluate(f"Boolean({expression})") is not True:
        if time.monotonic() > end:
            raise TimeoutError(f"{expression}: {page.errors}")
        time.sleep(0.1)


def press(page: Any, words: str, language: str) -> None:
    """Press the button with these words, in English."""
    words = page_catalogue(language).get(words, words)
    page.evaluate(f"[...document.querySelectorAll('button')].find((one) => one.textContent === {words!r}).click()")


def show(page: Any, tab: str) -> None:
    """Show one of the ways to change a case."""
    page.evaluate(f"document.querySelector('[data-tab={tab}][role=tab]').click()")
    time.sleep(0.6)


def open_case(page: Any, start: str, file: str) -> None:
    """Open a case file from the first page and wait for its figures."""
    page.evaluate("location.hash = '#/'")
    named = f"one.querySelector('.card-detail').textContent === {file!r}"
    card = f"[...document.querySelectorAll('.card')].find((one) => {named})"
    until(page, card)
    page.evaluate(f"{card}.click()")
    until(page, DRAWN)
    time.sleep(1.5)


def main() -> None:
    """Photograph the app."""
    options = argparse.ArgumentParser(description=__doc__)
    options.add_argument("folder", type=Path)
    options.add_argument("--all", action="store_true")
    options.add_argument("--only", default="")
    options.add_argument("--language", default="en")
    given = options.parse_args()
    given.folder.mkdir(parents=True, exist_ok=True)
    speak(given.language)
    driver = chromium()
    with tempfile.TemporaryDirectory() as held:
        for kind in KINDS:
            text = with_comments(template(kind))
            if kind == "units":  # at rest: the waves around a row take minutes
                text = re.sub("^analyses:.*$", "analyses: [statics]", text, flags=re.MULTILINE)
            Path(held, f"{kind}.yaml").write_text(text, encoding="utf-8")
        Path(held, "study.yaml").write_text(STUDY, encoding="utf-8")
        command = [sys.executable, "-m", "moyai", "--language", given.language, "app", held, "--no-browser"]
        process = subprocess.Popen(command, stdout=subprocess.PIPE, text=True)
        try:
            assert process.stdout is not None
            found = re.search(r"http://127\.0\.0\.1:\d+/\?token=\S+", process.stdout.readline())
            assert found is not None
            with driver.Chromium(driver.find_chromium(), 1400, 900) as page:
                page.send("Page.navigate", url=found[0])
                until(page, "document.querySelector('.card')")
                if given.all:
                    everything(page, found[0], given)
                else:
                    tutorial(page, found[0], given.folder, given.language)
                if page.errors:
                    raise RuntimeError("\n".join(page.errors))
        finally:
            process.terminate()
            process.wait(20)


def tutorial(page: Any, address: str, folder: Path, language: str) -> None:
    """Photograph what the tutorial shows."""
    # The folder of these pictures has no name that says anything
    page.evaluate("document.querySelector('.subtitle').textContent = " + repr(said("cases")))
    page.screenshot(folder / "app_cases.png", whole=False)
    open_case(page, address, "breakwater.yaml")
    for steps in (8, 8):
        press(page, "Pin", language)
        page.evaluate(f"""(() => {{ const range = document.querySelectorAll('.slider input[type=range]')[1];
          range.value = Number(range.value) + {steps} * Number(range.step);
          for (const name of ['input', 'change']) range.dispatchEvent(new Event(name, {{ bubbles: true }})); }})()""")
        time.sleep(1.0)
        until(page, DRAWN)
    until(page, "document.querySelector('.report').dataset.whole === '1' && document.getElementById('response')")
    page.evaluate("document.getElementById('response').scrollIntoView({ behavior: 'instant' })")
    time.sleep(4.0)
    page.screenshot(folder / "app_case.png", whole=False)
    page.evaluate("scrollTo(0, 0)")
    press(page, "Form", language)
    until(page, "document.querySelector('.form .field')")
    time.sleep(0.5)
    page.screenshot(folder / "app_form.png", whole=False)
    study(page, folder / "app_study.png", said("study"))


def study(page: Any, path: Path, word: str) -> None:
    """Start the study and photograph its page when it has ended."""
    page.evaluate("location.hash = '#/'")
    ends = f"{word}: study.yaml"
    card = f"[...document.querySelectorAll('.card')].find((one) => one.textContent.endsWith({ends!r}))"
    until(page, card)
    page.evaluate(f"{card}.click()")
    until(page, "document.querySelectorAll('.study tbody tr').length === 6 && !document.querySelector('iframe').hidden")
    until(page, "document.querySelector('iframe').src.endsWith('report.html')")
    time.sleep(3.0)
    page.screenshot(path, whole=False)


def everything(page: Any, address: str, given: argparse.Namespace) -> None:
    """Photograph every structure: wide and narrow, light and dark, with numbers, form and text."""
    for scheme in ("light", "dark"):
        page.prefer(scheme)
        page.resize(1400, 900)
        page.evaluate("location.hash = '#/'")
        until(page, "document.querySelector('.card')")
        page.screenshot(given.folder / f"gallery_{scheme}.png", whole=False)
        for kind in KINDS:
            if given.only and kind != given.only:
                continue
            page.resize(1400, 900)
            open_case(page, address, f"{kind}.yaml")
            page.screenshot(given.folder / f"{kind}_{scheme}.png", whole=False)
            if scheme == "light":
                show(page, "form")
                page.screenshot(given.folder / f"{kind}_form.png", whole=False)
            page.resize(390, 844)
            for tab in ("form", "written", "numbers"):
                show(page, tab)
                page.screenshot(given.folder / f"{kind}_{scheme}_{tab}_390.png", whole=False)


if __name__ == "__main__":
    main()
