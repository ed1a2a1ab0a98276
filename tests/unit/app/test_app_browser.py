"""The app in a real browser: a case opens, a slider redraws its figures, nothing foreign is asked for, no error."""

from __future__ import annotations

import importlib.util
import json
import os
import random
import re
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pytest
from app_runs import MEMBER, words_of_files

from moyai.app.stages import stages_of
from moyai.case.reader import case_of
from moyai.case.templates import template
from moyai.case.yaml_reader import parse_yaml
from moyai.cli.runner import run
from moyai.language.words import latin_words

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


@pytest.fixture
def address(tmp_path: Path) -> Iterator[str]:
    (tmp_path / "pile.yaml").write_text(MEMBER)
    with app_at(tmp_path / "pile.yaml") as found:
        yield found


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


@pytest.mark.slow
def test_a_slider_redraws_the_figures(address: str) -> None:
    with pipe.Chromium(str(pipe.find_chromium()), 1280, 900) as page:
        page.send("Page.navigate", url=address)
        until(page, f"{DRAWN} > 0")
        assert page.evaluate("location.href.includes('token')") is False
        assert "httponly" not in page.evaluate("document.cookie").lower() and page.evaluate("document.cookie") == ""
        until(page, f"{ON_SCREEN} && {IDLE}")
        assert page.evaluate(TO_DO) == [True, True], "nothing to undo or to save yet"
        before, number = page.evaluate(FORCES), page.evaluate(DRAWN)
        page.evaluate(f"{MOVE}(80)")
        until(page, f"{DRAWN} > {number}")
        until(page, f"{FORCES} !== {before!r} && {IDLE}")
        assert page.evaluate(TEXT) == MEMBER.replace("100 cm", "80 cm")
        time.sleep(0.5)
        assert page.evaluate(STATE).startswith("Draft of forces"), "what is shown is told, also when it came at once"
        assert page.evaluate(TO_DO) == [False, False]

        page.evaluate(f"{PRESS}('Undo')")
        until(page, f"{FORCES} === {before!r}")
        assert page.evaluate(TEXT) == MEMBER

        page.evaluate(f"{TEXT.removesuffix('.text')}.type({MEMBER.replace('water_depth', 'water_dept')!r})")
        until(page, f"{FIRST_ERROR} === 'line 5'")
        assert page.evaluate("Boolean(document.querySelector('.cm-lint-marker-error'))")
        page.evaluate("location.reload()")
        until(page, f"{FIRST_ERROR} === 'line 5'")

        for width in (390, 1280):
            page.resize(width, 900)
            until(page, f"innerWidth === {width} && document.documentElement.scrollWidth <= innerWidth + 1", 10.0)
        sound(page, address)


@pytest.mark.slow
def test_a_narrow_figure_keeps_its_plot_under_a_long_legend(tmp_path: Path) -> None:
    """Bars of four kinds and those of a pinned state: eight entries on 390 pixels; the list names what is looked at."""
    (tmp_path / "curtain.yaml").write_text(_only("curtain", "statics, impact"))
    with app_at(tmp_path / "curtain.yaml") as address, pipe.Chromium(str(pipe.find_chromium()), 390, 844) as page:
        page.send("Page.navigate", url=address)
        until(page, f"{WHOLE} && {IDLE}", 120.0)
        page.evaluate(f"{PRESS}('Pin')")
        until(page, f"{PINS}.length === 1")
        page.evaluate(f"{MOVE_ONE}('structure.skirt.length', 6.5)")
        until(page, f"{WHOLE} && {IDLE} && {TEXT}.includes('6.5 m')", 120.0)
        page.evaluate("document.querySelector('.figure').scrollIntoView({ behavior: 'instant' })")
        until(page, "document.querySelector('.figure').querySelectorAll('.legend .traces').length === 8", 20.0)
        assert page.evaluate("document.querySelector('.figure .nsewdrag').getBoundingClientRect().height") > 130
        listed = "document.querySelector('.top select').value"
        assert page.evaluate(f"document.getElementById({listed}).contains(document.querySelector('.figure'))")
        sound(page, address)


@pytest.mark.slow
def test_two_tabs_share_one_case(address: str) -> None:
    """What one tab moves is in the other, at the next look or the next move; both at once keep both numbers."""
    executable = str(pipe.find_chromium())
    with pipe.Chromium(executable, 1280, 900) as page, pipe.Chromium(executable, 1280, 900) as other:
        for one in (page, other):
            one.send("Page.navigate", url=address)
            until(one, f"{DRAWN} > 0 && {IDLE}")
        other.evaluate(f"{MOVE_ONE}('site.water_depth', 22)")
        until(other, f"{TEXT}.includes('depth: 22 m') && {IDLE}")
        page.evaluate(f"{MOVE}(90)")
        until(page, f"{TEXT}.includes('90 cm') && {TEXT}.includes('depth: 22 m') && {IDLE}", 20.0)
        until(other, f"{TEXT}.includes('90 cm') && {IDLE}", 20.0)
        for number in (1, 2, 3):
            page.evaluate(f"{MOVE}({90 + number})")
            other.evaluate(f"{MOVE_ONE}('site.water_depth', {22 + number})")
            both = f"{TEXT}.includes('{90 + number} cm') && {TEXT}.includes('depth: {22 + number} m')"
            for one in (page, other):
                until(one, f"{both} && {IDLE} && {WHOLE} && {STATE}.startsWith('Draft of')", 20.0)
            force = "document.querySelector('.report').headlines[0].value"
            assert page.evaluate(force) == other.evaluate(force)
        for one in (page, other):
            sound(one, address)


@pytest.mark.slow
def test_a_file_that_another_program_changes(address: str, tmp_path: Path) -> None:
    """Its text is taken where the page has no changes of its own; else the page asks, and nothing is lost."""
    file = tmp_path / "pile.yaml"
    with pipe.Chromium(str(pipe.find_chromium()), 1280, 900) as page:
        page.send("Page.navigate", url=address)
        until(page, f"{DRAWN} > 0 && {IDLE}")
        number = page.evaluate(DRAWN)
        file.write_text(MEMBER.replace("100 cm", "70 cm"))
        until(page, f"{TEXT}.includes('70 cm') && {DRAWN} > {number} && {IDLE}", 20.0)
        page.evaluate(f"{MOVE}(80)")
        until(page, f"{TEXT}.includes('80 cm') && {IDLE}")
        asked = "!document.querySelector('.file-notice').hidden"
        for words, found in (("Keep this text", "80 cm"), ("Take the file", "60 cm")):
            file.write_text(MEMBER.replace("100 cm", "60 cm") + f"# {words}\n")
            until(page, asked, 20.0)
            page.evaluate(f"{PRESS}({words!r})")
            until(page, f"!({asked}) && {TEXT}.includes('{found}') && {IDLE}")
        page.evaluate(f"{PRESS}('Undo')")
        until(page, f"{TEXT}.includes('80 cm') && {IDLE}")
        # typed and saved within the pause after typing
        page.evaluate(f"{TEXT.removesuffix('.text')}.type({MEMBER.replace('Quick', 'Typed')!r}); {PRESS}('Save')")
        until(page, "document.getElementById('told').textContent.includes('is saved')")
        assert file.read_text() == MEMBER.replace("Quick", "Typed") == page.evaluate(TEXT)
        sound(page, address)


@pytest.mark.slow
def test_form_and_text_are_one_document(address: str) -> None:
    with pipe.Chromium(str(pipe.find_chromium()), 1280, 900) as page:
        page.send("Page.navigate", url=address)
        until(page, f"{DRAWN} > 0")
        page.evaluate(f"{PRESS}('Form')")
        until(page, f"{DIAMETER}")
        assert page.evaluate(f"{DIAMETER}.value") == "100 cm"
        page.evaluate(f"{SET}('structure.section.diameter', '1.2 m')")
        until(page, f"{TEXT}.includes('diameter: 1.2 m}}   # outer')")
        assert page.evaluate(TEXT) == MEMBER.replace("100 cm", "1.2 m")
        page.evaluate(f"{SET}('+', 'current')")
        until(page, f"{TEXT} !== {MEMBER.replace('100 cm', '1.2 m')!r}")
        page.evaluate(f"{PRESS}('Undo')")
        until(page, f"{TEXT} === {MEMBER.replace('100 cm', '1.2 m')!r}")
        page.evaluate(f"{TEXT.removesuffix('.text')}.type({MEMBER.replace('100 cm', '90 cm')!r})")
        until(page, f"{DIAMETER}.value === '90 cm'")
        page.evaluate(f"{SET}('structure.section.diameter', '-2 m')")
        until(page, "document.querySelector('.field input[aria-invalid]')")
        assert "range" in page.evaluate("document.querySelector('.field:has([aria-invalid]) .field-fault').textContent")
        for _ in range(3):
            page.evaluate(f"{PRESS}('Undo')")
            time.sleep(0.3)
        until(page, f"{TEXT} === {MEMBER!r}")
        sound(page, address)


@pytest.mark.slow
def test_without_the_script_of_the_editor_there_is_a_text_area(address: str) -> None:
    with pipe.Chromium(str(pipe.find_chromium()), 1280, 900) as page:
        page.send("Network.setBlockedURLs", urls=["*codemirror.js*"])
        page.send("Page.navigate", url=address)
        until(page, f"{DRAWN} > 0")
        assert page.evaluate("document.querySelector('textarea').value") == MEMBER
        page.evaluate(f"{TEXT.removesuffix('.text')}.type({MEMBER.replace('water_depth', 'water_dept')!r})")
        until(page, "document.querySelector('.gutter .error')?.textContent === '5'")


SHOWN = """(() => {
  const found = [], own = 'code, .report, .cm-content, .card-detail, .subtitle, h1';
  for (const one of document.querySelectorAll('body *:not(script)')) {
    if (one.closest(own)) continue;
    found.push(...[...one.childNodes].filter((node) => node.nodeType === 3).map((node) => node.data));
    found.push(...['title', 'aria-label', 'placeholder'].map((name) => one.getAttribute(name)));
  }
  return JSON.stringify(found.filter((text) => text && text.trim()));
})()"""


@pytest.mark.slow  # every sentence of the scripts is held against the catalogue in test_app_language
def test_the_page_in_japanese_shows_no_english(tmp_path: Path) -> None:
    (tmp_path / "pile.yaml").write_text(MEMBER)
    with (
        app_at(tmp_path / "pile.yaml", "--language", "ja") as address,
        pipe.Chromium(str(pipe.find_chromium()), 1280, 900) as page,
    ):
        page.send("Page.navigate", url=address)
        until(page, f"{DRAWN} > 0 && {IDLE}")
        keys = words_of_files() | set(re.findall(r"[a-z]+", MEMBER)) | {"Alt", "Quick", "pile", "out"}
        for step, ready in (
            ("0", "document.querySelector('.slider')"),
            (f"{PRESS}('入力欄')", "document.querySelector('.form .field')"),
            (f"{TEXT.removesuffix('.text')}.type({MEMBER.replace('water_depth', 'water_dept')!r})", FIRST_ERROR),
            ("location.hash = '#/jobs'", "document.querySelector('.jobs')"),
            ("location.hash = '#/'", "document.querySelector('.cards')"),
        ):
            page.evaluate(step)
            until(page, ready)
            shown = json.loads(page.evaluate(SHOWN))
            assert len(shown) >= 5
            assert {word for text in shown for word in latin_words(text)} - keys == set(), step
        sound(page, address)


LABELS = "[...MOYAI.figures.values()].flatMap((one) => one.drawn ? one.plot.data.map((trace) => trace.name) : [])"
PINS = "[...document.querySelectorAll('.pins input')].map((one) => one.value)"
FULL = "document.querySelector('.figure .full').click()"


@pytest.mark.slow
def test_pins_are_named_drawn_and_taken_away(address: str) -> None:
    def has(name: str) -> str:
        return f"{LABELS}.some((one) => one.endswith('({name})'))".replace("endswith", "endsWith")

    with pipe.Chromium(str(pipe.find_chromium()), 1280, 900) as page:
        page.send("Page.navigate", url=address)
        until(page, f"{DRAWN} > 0 && {IDLE}")
        for value, names in ((80, ["state 1"]), (120, ["state 1", "Diameter 80 cm"])):
            page.evaluate(f"{PRESS}('Pin')")
            until(page, f"JSON.stringify({PINS}) === {json.dumps(json.dumps(names, separators=(',', ':')))}")
            page.evaluate(f"{MOVE}({value})")
            until(page, f"{TEXT}.includes('{value} cm') && {IDLE}")
        page.evaluate("document.querySelector('.figure').scrollIntoView()")
        until(page, f"{has('state 1')} && {has('Diameter 80 cm')}")
        assert page.evaluate("document.querySelectorAll('#differences table').length") == 2
        page.evaluate("""(() => {
          const name = document.querySelector('.pins input');
          name.value = 'as built';
          name.dispatchEvent(new Event('change', { bubbles: true }));
        })()""")
        until(page, f"{has('as built')} && !{has('state 1')}")
        page.evaluate("window.old = true; location.reload()")
        until(page, f"!window.old && {DRAWN} > 0 && {IDLE} && {PINS}.length === 2 && {has('as built')}")
        page.evaluate("document.querySelector('.pins .remove').click()")
        until(page, f"{PINS}.join() === 'Diameter 80 cm' && {IDLE} && !{has('as built')} && {has('Diameter 80 cm')}")
        page.resize(390, 900)
        until(page, "document.documentElement.scrollWidth <= innerWidth + 1", 10.0)
        page.resize(1280, 900)
        page.send("Runtime.evaluate", expression=FULL, userGesture=True)
        until(page, "document.fullscreenElement?.querySelector('.plot').offsetHeight > 600")
        page.send("Runtime.evaluate", expression=FULL, userGesture=True)
        until(page, "!document.fullscreenElement && document.querySelector('.figure .plot').offsetHeight < 600")
        sound(page, address)


KEYS = {
    "Tab": 9, "Enter": 13, "Escape": 27, " ": 32, "ArrowLeft": 37, "ArrowUp": 38, "ArrowRight": 39, "ArrowDown": 40,
    "z": 90,
}  # fmt: skip
ALT, CONTROL, SHIFT = 1, 2, 8
FOCUS = "document.activeElement"


def press(page: Any, key: str, modifiers: int = 0) -> None:
    """Press and release a key as a keyboard does."""
    code = f"Key{key.upper()}" if len(key) == 1 and key.isalpha() else {" ": "Space"}.get(key, key)
    written = {"Enter": "\r", " ": " "}.get(key, key if len(key) == 1 and not modifiers else "")
    how = {"key": key, "code": code, "windowsVirtualKeyCode": KEYS[key], "modifiers": modifiers}
    page.send("Input.dispatchKeyEvent", type="keyDown", **how, **({"text": written} if written else {}))
    page.send("Input.dispatchKeyEvent", type="keyUp", **how)


def tab_to(page: Any, wanted: str, back: bool = False, most: int = 80) -> None:
    """Press Tab until an element with the focus fulfils an expression of ``one``."""
    for _ in range(most):
        press(page, "Tab", SHIFT if back else 0)
        if page.evaluate(f"((one) => Boolean({wanted}))({FOCUS})"):
            return
    raise AssertionError(f"no Tab reaches {wanted}; the focus is on {page.evaluate(f'{FOCUS}.outerHTML')[:200]}")


@pytest.mark.parametrize("leave", ["location.hash = '#/jobs'", "location.reload()"])
@pytest.mark.slow
def test_what_is_typed_last_is_kept_when_the_page_is_left(address: str, leave: str) -> None:
    typed = MEMBER.replace("Quick", "Typed")
    with pipe.Chromium(str(pipe.find_chromium()), 1280, 900) as page:
        page.send("Page.navigate", url=address)
        until(page, f"{DRAWN} > 0 && {IDLE}")
        case = page.evaluate("location.hash")
        page.evaluate(f"window.old = true; {TEXT.removesuffix('.text')}.type({typed!r}); {leave}")
        until(page, "!window.old || document.querySelector('.jobs')")
        page.evaluate(f"location.hash = {case!r}")
        until(page, f"document.querySelector('.text-pane') && {TEXT} === {typed!r}", 15.0)


@pytest.mark.slow
def test_a_file_is_opened_by_its_name(address: str, tmp_path: Path) -> None:
    deep = tmp_path / "a" / "b" / "c" / "d" / "e"
    deep.mkdir(parents=True)
    (deep / "deep.yaml").write_text(MEMBER.replace("Quick", "Deep"))
    with pipe.Chromium(str(pipe.find_chromium()), 390, 844) as page:
        page.send("Page.navigate", url=address)
        until(page, f"{DRAWN} > 0 && {IDLE}")
        page.evaluate("location.hash = '#/'")
        until(page, "document.querySelector('.open-file')")
        assert "deep.yaml" not in page.evaluate("document.querySelector('.cards').textContent")
        page.evaluate("document.querySelector('.open-file input').focus()")
        page.send("Input.insertText", text="a/b/c/d/e/deep.yaml")
        press(page, "Enter")
        until(page, f"location.hash.startsWith('#/case') && {DRAWN} > 0 && {TEXT}.includes('Deep member')")
        assert page.evaluate("document.documentElement.scrollWidth <= innerWidth + 1")
        sound(page, address)


@pytest.mark.slow
def test_a_session_by_keyboard_alone(address: str) -> None:
    """From a card to a run with no pointer: slider, form, text, undo, pin, full screen, jobs and back."""
    with pipe.Chromium(str(pipe.find_chromium()), 1280, 900) as page:
        page.send("Page.navigate", url=address)
        until(page, f"{DRAWN} > 0 && {IDLE}")
        tab_to(page, "one.classList.contains('skip')")
        press(page, "Enter")
        tab_to(page, "one.textContent === 'Cases'", back=True)
        press(page, "Enter")
        until(page, "document.querySelector('.card')")
        tab_to(page, "one.matches('.card') && one.textContent.includes('pile')")
        press(page, "Enter")
        until(page, f"location.hash.startsWith('#/case') && {DRAWN} > 0 && {IDLE}")

        tab_to(page, "one.type === 'range' && one.closest('.slider').textContent.includes('Diameter')")
        assert page.evaluate(f"{FOCUS}.matches(':focus-visible') && getComputedStyle({FOCUS}).outlineStyle !== 'none'")
        press(page, "ArrowRight")
        until(page, f"{TEXT} !== {MEMBER!r} && {IDLE}")
        assert page.evaluate(f"{FOCUS}.type") == "range", "the slider keeps the focus when the page is drawn anew"
        tab_to(page, "one.textContent === 'Pin'", back=True)
        press(page, " ")
        until(page, f"{PINS}.length === 1")
        press(page, "z", ALT)
        until(page, f"{TEXT} === {MEMBER!r} && {IDLE}")

        tab_to(page, "one.role === 'tab'")
        press(page, "ArrowRight")
        until(page, f"{FOCUS}.textContent === 'Form' && {DIAMETER}")
        for _ in range(40):
            press(page, "Tab")
            if page.evaluate(f"{FOCUS}.matches('summary') && !{FOCUS}.parentElement.open"):
                press(page, "Enter")
            if page.evaluate(f"{FOCUS} === {DIAMETER}"):
                break
        assert page.evaluate(f"{FOCUS} === {DIAMETER}"), "the field is reached"
        page.evaluate(f"{FOCUS}.select()")
        page.send("Input.insertText", text="90 cm")
        press(page, "Tab")
        until(page, f"{TEXT} === {MEMBER.replace('100 cm', '90 cm')!r} && {IDLE}")

        tab_to(page, "one.matches('.cm-content')")
        press(page, "Tab")
        assert page.evaluate(f"{FOCUS}.closest('.cm-content')") is None, "Tab leaves the text"
        tab_to(page, "one.matches('.full')")
        press(page, "Enter")
        until(page, "document.fullscreenElement")
        press(page, "Enter")
        until(page, "!document.fullscreenElement")

        tab_to(page, "one.textContent === 'Run'", back=True)
        press(page, "Enter")
        until(page, "document.querySelector('.job')?.dataset.state === 'done'", 120.0)
        tab_to(page, "one.matches('.job-files a') && one.textContent === 'Report'")
        press(page, "Enter")
        until(page, "document.querySelector('iframe')?.src.endsWith('report.html')")
        sound(page, address)


@pytest.mark.slow
def test_figures_are_taken_away(address: str) -> None:
    """CSV, SVG and PNG of a figure are of what is drawn now, after a move as well."""
    take = "((what) => document.querySelector(`.figure [data-do=${what}]`).click())"
    with pipe.Chromium(str(pipe.find_chromium()), 1280, 900) as page:
        page.send("Page.navigate", url=address)
        until(page, f"{DRAWN} > 0 && {IDLE}")
        page.evaluate("document.querySelector('.figure').scrollIntoView({ behavior: 'instant' })")
        name = page.evaluate("document.querySelector('.figure').dataset.figure")
        drawn = f"MOYAI.figures.get({name!r})"
        until(page, f"{drawn}.drawn")
        contents = []
        for value in (100, 80):
            page.evaluate(f"{MOVE}({value})")
            until(page, f"{TEXT}.includes('{value} cm') && {IDLE}")
            page.evaluate(f"{take}('csv')")
            lines = page.wait_download(f"{name}.csv").decode("utf-8-sig").splitlines()
            (page.downloads / f"{name}.csv").unlink()
            columns = list(zip(*(line.split(",") for line in lines[1:])))
            shown = json.loads(page.evaluate(f"JSON.stringify([...{drawn}.plot.data[0].y])"))
            found = [[float(cell) for cell in column if cell] for column in columns]
            assert any(len(one) == len(shown) and one == pytest.approx(shown, rel=1e-3) for one in found)
            contents.append(lines)
        assert contents[0] != contents[1]
        page.evaluate(f"{take}('svg')")
        drawing = page.wait_download(f"{name}.svg").decode("utf-8")
        assert drawing.startswith("<svg") and "</svg>" in drawing and len(drawing) > 5000
        page.evaluate(f"{take}('png')")
        assert page.wait_download(f"{name}.png").startswith(b"\x89PNG\r\n")
        sound(page, address)


@pytest.mark.slow
@pytest.mark.parametrize("kind", (*KINDS, "units"))
def test_every_structure_opens_and_follows_a_slider(kind: str, tmp_path: Path) -> None:
    # The waves around a row take minutes
    (tmp_path / f"{kind}.yaml").write_text(_only("units", "statics") if kind == "units" else template(kind))
    with app_at(tmp_path / f"{kind}.yaml") as address, pipe.Chromium(str(pipe.find_chromium()), 1400, 900) as page:
        page.send("Page.navigate", url=address)
        until(page, f"{DRAWN} > 0 && {IDLE}", 120.0)
        until(page, ON_SCREEN)
        number = page.evaluate(DRAWN)
        text = page.evaluate(TEXT)
        page.evaluate(f"{MOVE}()")
        until(page, f"{DRAWN} > {number} && {IDLE}", 120.0)
        until(page, ON_SCREEN)
        assert page.evaluate(TEXT) != text
        page.evaluate(f"{PRESS}('Form')")
        until(page, "document.querySelectorAll('.form .field').length > 10")
        page.resize(390, 844)
        until(page, "innerWidth === 390 && document.documentElement.scrollWidth <= innerWidth + 1", 15.0)
        sound(page, address)


def _settled(page: pipe.Chromium) -> list[str]:
    """Return data and drawing once two looks three seconds apart agree: figures out of sight are drawn one by one."""
    found: list[str] = []
    for _ in range(10):
        time.sleep(3.0)
        now = [page.evaluate("JSON.stringify(MOYAI.data.figures)"), page.evaluate(FORCES)]
        if now == found:
            break
        found = now
    return found


@pytest.mark.slow
def test_moves_in_a_hurry_end_with_the_last_one(address: str) -> None:
    """Sixty moves without waiting: drawn answers only go forward, and the last drawing is that of the last number."""
    with pipe.Chromium(str(pipe.find_chromium()), 1280, 900) as page:
        page.send("Page.navigate", url=address)
        until(page, f"{DRAWN} > 0 && {IDLE}")
        page.evaluate("""(() => {
          window.drawnOnes = [];
          new MutationObserver(() => drawnOnes.push(Number(document.querySelector('.report').dataset.sequence)))
            .observe(document.querySelector('.report'), { attributes: true, attributeFilter: ['data-sequence'] });
        })()""")
        chance = random.Random(3)
        values = [chance.randrange(60, 140) for _ in range(60)]
        for value in values:
            page.evaluate(f"{MOVE}({value})")
            time.sleep(chance.choice((0.0, 0.02, 0.2)))
        wanted = MEMBER.replace("100 cm", f"{values[-1]} cm")
        until(page, f"{TEXT} === {wanted!r} && {IDLE}")
        drawn = page.evaluate("drawnOnes")
        assert drawn == sorted(drawn) and len(drawn) >= 2
        until(page, ON_SCREEN)
        last = _settled(page)
        page.evaluate("location.reload()")
        until(page, f"!window.drawnOnes && {DRAWN} > 0 && {IDLE}")
        until(page, ON_SCREEN)
        found = _settled(page)
        assert [one == other for one, other in zip(found, last, strict=True)] == [True, True]
        sound(page, address)


def _only(name: str, analyses: str) -> str:
    return re.sub("^analyses:.*$", f"analyses: [{analyses}]", template(name), flags=re.MULTILINE)


PLACE = "Math.round(document.getElementById('response').getBoundingClientRect().top)"


@pytest.mark.slow
def test_a_draft_keeps_place_sections_and_choices(tmp_path: Path) -> None:
    """What is looked at stays where it is; sections and water levels that a draft leaves out stay too."""
    (tmp_path / "case.yaml").write_text(_only("breakwater", "statics, mooring, frequency"))
    with app_at(tmp_path / "case.yaml") as address, pipe.Chromium(str(pipe.find_chromium()), 1280, 900) as page:
        page.send("Page.navigate", url=address)
        until(page, f"{WHOLE} && {IDLE}", 120.0)
        sections = "[...document.querySelectorAll('.report section')].map((one) => one.id).join()"
        chosen = "document.querySelector('#response .chooser [aria-pressed=true]').textContent"
        names, level = page.evaluate(sections), page.evaluate(chosen)
        page.evaluate("document.getElementById('response').scrollIntoView({ behavior: 'instant' })")
        time.sleep(1.0)
        place = page.evaluate(PLACE)
        page.evaluate("""(() => {
          window.seen = [];
          new MutationObserver(() => seen.push(document.querySelector('.report').dataset.whole))
            .observe(document.querySelector('.report'), { attributes: true, attributeFilter: ['data-whole'] });
        })()""")
        page.evaluate(f"{MOVE_ONE}('structure.roll_gyradius', 2.8)")
        until(page, "seen.filter((one) => one === '').length >= 2", 60.0)
        for _ in range(2):
            assert abs(page.evaluate(PLACE) - place) <= 2
            assert (page.evaluate(sections), page.evaluate(chosen)) == (names, level)
            until(page, f"{WHOLE} && {IDLE}", 120.0)
        sound(page, address)


WHOLE = "document.querySelector('.report')?.dataset.whole === '1'"
MOVE_ONE = """((path, value) => {
  const label = [...document.querySelectorAll('.slider label')].find((one) => one.title === path);
  const range = document.getElementById(label.getAttribute('for'));
  range.value = value;
  for (const name of ['input', 'change']) range.dispatchEvent(new Event(name, { bubbles: true }));
})"""
SLIDERS = """JSON.stringify([...document.querySelectorAll('.slider')].map((one) => {
  const range = one.querySelector('input[type=range]');
  return [one.querySelector('label').title, Number(range.min), Number(range.max), Number(range.step)];
}))"""
FAULTY = "Boolean(document.querySelector('.faults .error, .report.old'))"


@pytest.mark.slow
@pytest.mark.parametrize(
    ("text", "moves", "reach"),
    [
        (MEMBER, 220, 0.2),
        (_only("rigid_cage", "statics"), 80, 0.2),
        (_only("network", "statics"), 80, 0.2),
        (_only("curtain", "statics, impact"), 20, 0.2),
        (_only("breakwater", "statics, mooring, frequency"), 24, 0.02),
        (_only("cage", "statics"), 20, 0.2),
    ],
    ids=["member", "rigid cage", "network", "curtain", "breakwater", "cage"],
)
def test_random_moves_end_with_the_numbers_of_a_fresh_run(text: str, moves: int, reach: float, tmp_path: Path) -> None:
    """Four hundred moves, most of them in a hurry; when the page rests its numbers are those of a run of its text."""
    (tmp_path / "case.yaml").write_text(text)
    chance, compared = random.Random(moves), 0
    with app_at(tmp_path / "case.yaml") as address, pipe.Chromium(str(pipe.find_chromium()), 1280, 900) as page:
        page.send("Page.navigate", url=address)
        until(page, f"{WHOLE} && {IDLE}", 120.0)
        for move in range(moves):
            path, low, high, step = chance.choice(json.loads(page.evaluate(SLIDERS)))
            middle, most = round(0.5 * (high - low) / step), max(1, round(reach * (high - low) / step))
            value = low + step * (middle + chance.randint(-most, most))
            page.evaluate(f"{MOVE_ONE}({path!r}, {value!r})")
            if chance.random() < 0.7 and move < moves - 1:
                time.sleep(chance.choice((0.0, 0.02, 0.1)))
                continue
            until(page, f"{IDLE} && ({WHOLE} || {FAULTY})", 180.0)
            if page.evaluate(FAULTY):
                # a number went too far
                page.evaluate(f"{TEXT.removesuffix('.text')}.type({text!r})")
                until(page, f"{IDLE} && {WHOLE} && {TEXT} === {text!r} && !{FAULTY}", 180.0)
                continue
            document = parse_yaml(page.evaluate(TEXT))
            draft = stages_of(document, document.data["structure"]["kind"])[-1]
            fresh = [one.as_dict() for one in run(case_of(draft, tmp_path / "case.yaml")).headlines]
            shown = json.loads(page.evaluate("JSON.stringify(document.querySelector('.report').headlines)"))
            assert [(one["name"], one["where"]) for one in shown] == [(one["name"], one["where"]) for one in fresh]
            for one, wanted in zip(shown, (item["value"] for item in fresh), strict=True):
                number = isinstance(wanted, float)
                assert one["value"] == (pytest.approx(wanted, rel=1e-12, abs=0.0) if number else wanted), one["name"]
            compared += 1
        sound(page, address)
    assert compared > 0.1 * moves


@pytest.mark.slow
def test_a_job_a_reload_and_two_tabs(address: str) -> None:
    executable = str(pipe.find_chromium())
    with pipe.Chromium(executable, 1280, 900) as page, pipe.Chromium(executable, 390, 844) as other:
        page.send("Page.navigate", url=address)
        until(page, f"{DRAWN} > 0 && {IDLE}")
        page.evaluate(f"{PRESS}('Run')")
        until(page, "location.hash === '#/jobs' && document.querySelector('.job')")
        page.evaluate("location.reload()")
        other.send("Page.navigate", url=address)
        until(other, f"{DRAWN} > 0 && {IDLE}")
        other.evaluate(f"{MOVE}(90)")
        until(other, f"{TEXT}.includes('90 cm') && {IDLE}")
        other.evaluate("location.hash = '#/jobs'")
        for one in (page, other):
            until(one, "document.querySelector('.job')?.dataset.state === 'done'", 120.0)
            assert "moyai run pile.yaml" in one.evaluate("document.querySelector('.command code').textContent")
        page.evaluate(REPORT)
        until(page, "document.querySelector('iframe')?.src.endsWith('report.html')")
        page.evaluate("history.go(-2)")
        until(page, f"location.hash.startsWith('#/case') && {DRAWN} > 0")
        assert "90 cm" in page.evaluate(TEXT), "the change of the other tab"
        for one in (page, other):
            sound(one, address)


@pytest.mark.slow
def test_a_paper_is_computed_again(address: str) -> None:
    with pipe.Chromium(str(pipe.find_chromium()), 1280, 900) as page:
        page.send("Page.navigate", url=address)
        until(page, f"{DRAWN} > 0")
        page.evaluate("location.hash = '#/'")
        papers = "[...document.querySelectorAll('section')].find((one) => one.textContent.startsWith('Papers'))"
        until(page, papers)
        page.evaluate(f"{papers}.querySelectorAll('.card')[0].click()")
        until(page, "document.querySelector('.job')?.dataset.state === 'done'", 400.0)
        page.evaluate(REPORT)
        until(page, "document.querySelector('iframe')?.src.endsWith('report.html')")
        sound(page, address)
