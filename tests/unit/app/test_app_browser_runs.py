"""Runs of the app in a real browser: sliders of all structures, moves in a hurry, drafts, jobs, papers."""

from __future__ import annotations

import json
import random
import time
from collections.abc import Iterator
from pathlib import Path

import pytest
from app_browser import (
    DRAWN,
    FORCES,
    IDLE,
    KINDS,
    MOVE,
    MOVE_ONE,
    NEEDS_CHROMIUM,
    ON_SCREEN,
    PRESS,
    REPORT,
    TEXT,
    WHOLE,
    app_at,
    at_one_level,
    only,
    pipe,
    sound,
    until,
)
from app_runs import MEMBER

from moyai.app.stages import stages_of
from moyai.case.reader import case_of
from moyai.case.templates import template
from moyai.case.yaml_reader import parse_yaml
from moyai.cli.runner import run

pytest.importorskip("starlette")
pytest.importorskip("uvicorn")

pytestmark = NEEDS_CHROMIUM

PLACE = "Math.round(document.getElementById('response').getBoundingClientRect().top)"
SLIDERS = """JSON.stringify([...document.querySelectorAll('.slider')].map((one) => {
  const range = one.querySelector('input[type=range]');
  return [one.querySelector('label').title, Number(range.min), Number(range.max), Number(range.step)];
}))"""
FAULTY = "Boolean(document.querySelector('.faults .error, .report.old'))"


@pytest.fixture
def address(tmp_path: Path) -> Iterator[str]:
    (tmp_path / "pile.yaml").write_text(MEMBER)
    with app_at(tmp_path / "pile.yaml") as found:
        yield found


@pytest.mark.slow
@pytest.mark.parametrize("kind", (*KINDS, "units"))
def test_every_structure_opens_and_follows_a_slider(kind: str, tmp_path: Path) -> None:
    # Moves below wait for the stages after the equilibrium
    (tmp_path / f"{kind}.yaml").write_text(template(kind) if kind == "member" else only(kind, "statics"))
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


@pytest.mark.slow
def test_a_draft_keeps_place_sections_and_choices(tmp_path: Path) -> None:
    """What is looked at stays where it is; sections and water levels that a draft leaves out stay too."""
    (tmp_path / "case.yaml").write_text(only("breakwater", "statics, mooring, frequency"))
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


@pytest.mark.slow
@pytest.mark.parametrize(
    ("text", "moves", "reach"),
    [
        (MEMBER, 80, 0.2),
        (only("network", "statics"), 16, 0.2),
        (at_one_level(only("curtain", "statics, impact")), 5, 0.2),
        (at_one_level(only("breakwater", "statics, mooring, frequency")), 6, 0.02),
    ],
    ids=["member", "network", "curtain", "breakwater"],
)
def test_random_moves_end_with_the_numbers_of_a_fresh_run(text: str, moves: int, reach: float, tmp_path: Path) -> None:
    """Moves, most of them in a hurry; when the page rests its numbers are those of a run of its text."""
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
        # the one that takes least
        cards = f"[...{papers}.querySelectorAll('.card')]"
        page.evaluate(f"{cards}.find((one) => one.textContent.includes('Arai')).click()")
        until(page, "document.querySelector('.job')?.dataset.state === 'done'", 400.0)
        assert page.evaluate("document.querySelector('.job').dataset.state") == "done"
        page.evaluate(REPORT)
        until(page, "document.querySelector('iframe')?.src.endsWith('report.html')")
        sound(page, address)
