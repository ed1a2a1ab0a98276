"""The app in a real browser: a case opens, a slider redraws its figures, nothing foreign is asked for, no error."""

from __future__ import annotations

import json
import re
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from app_browser import (
    DIAMETER,
    DRAWN,
    FIRST_ERROR,
    FORCES,
    IDLE,
    MOVE,
    MOVE_ONE,
    NEEDS_CHROMIUM,
    ON_SCREEN,
    PRESS,
    SET,
    STATE,
    TEXT,
    TO_DO,
    WHOLE,
    app_at,
    at_one_level,
    only,
    pipe,
    sound,
    until,
)
from app_runs import MEMBER, words_of_files

from moyai.language.words import latin_words

pytest.importorskip("starlette")
pytest.importorskip("uvicorn")

pytestmark = NEEDS_CHROMIUM


@pytest.fixture
def address(tmp_path: Path) -> Iterator[str]:
    (tmp_path / "pile.yaml").write_text(MEMBER)
    with app_at(tmp_path / "pile.yaml") as found:
        yield found


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
        assert page.evaluate(STATE).startswith("Draft of forces"), "what is shown is announced, even at once"
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
    (tmp_path / "curtain.yaml").write_text(at_one_level(only("curtain", "statics, impact")))
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
        until(page, "document.getElementById('announcement').textContent.includes('is saved')")
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


@pytest.mark.slow
def test_what_is_typed_last_is_kept_when_the_page_is_left(address: str) -> None:
    with pipe.Chromium(str(pipe.find_chromium()), 1280, 900) as page:
        page.send("Page.navigate", url=address)
        until(page, f"{DRAWN} > 0 && {IDLE}")
        case = page.evaluate("location.hash")
        for leave in ("location.hash = '#/jobs'", "location.reload()"):
            typed = MEMBER.replace("Quick", f"Typed before {leave[:13]}")
            page.evaluate(f"window.old = true; {TEXT.removesuffix('.text')}.type({typed!r}); {leave}")
            until(page, "!window.old || document.querySelector('.jobs')")
            page.evaluate(f"location.hash = {case!r}")
            until(page, f"document.querySelector('.text-pane') && {TEXT} === {typed!r}", 15.0)
            assert page.evaluate(TEXT) == typed


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
