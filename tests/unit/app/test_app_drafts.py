"""Drafts: numbers of a fresh run, stale ones dropped, a killed process reported, hostile texts refused."""

from __future__ import annotations

import asyncio
import base64
import json
import os
import re
import signal
import time
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from app_runs import MEMBER, run_slowly

from moyai.app.draft import Drafts
from moyai.app.messages import Wish
from moyai.app.pins import MOST, Pin, renamed, with_pin
from moyai.app.stages import stages_of
from moyai.app.worker import DraftWorker
from moyai.case.builder import build
from moyai.case.reader import case_of
from moyai.case.sliders import sliders_of
from moyai.case.templates import template
from moyai.case.yaml_reader import parse_yaml
from moyai.cli.runner import run
from moyai.core.errors import InputError
from moyai.core.kinds import structure_kind
from moyai.core.progress import silent
from moyai.report.document import Figure
from moyai.report.writer import compose_document


def wish(folder: Path, text: str, **more: Any) -> Wish:
    return Wish(text, folder / "case.yaml", folder, **more)


def only(name: str, analyses: str) -> str:
    return re.sub("^analyses:.*$", f"analyses: [{analyses}]", template(name), flags=re.MULTILINE)


def decoded(coded: Any) -> np.ndarray:
    return np.asarray(coded if isinstance(coded, list) else np.frombuffer(base64.b64decode(coded["f4"]), "<f4"), float)


@pytest.mark.slow
@pytest.mark.parametrize(("name", "kind"), [("network", "network"), ("rigid_cage", "cage"), ("quick", "member")])
def test_numbers_are_those_of_a_fresh_run(tmp_path: Path, name: str, kind: str) -> None:
    text = MEMBER if name == "quick" else template(name)
    drafts = Drafts(run, tmp_path / "kept")
    numbers = ("2.5", "2.75") if name == "rigid_cage" else ("1.5", "1.25")
    for number in numbers:
        checked, drawn = drafts.answer(wish(tmp_path, text, edits={"waves[0].height": number}), silent)
        text = checked["text"]
        assert checked["faults"] == [] and drawn["message"] == "drawn" and drawn["last"]
        draft = stages_of(parse_yaml(text), kind)[-1]
        fresh = run(case_of(draft, tmp_path / "case.yaml"))
        found = [(item["name"], repr(float(item["value"]))) for item in drawn["headlines"]]
        assert found == [(item.name, repr(float(item.value))) for item in fresh.headlines]
        assert found


@pytest.mark.slow
def test_nominal_numbers_come_first_and_are_marked(tmp_path: Path) -> None:
    """The same values without their bands, then the whole answer of a fresh run."""
    text = re.sub("^  water_levels:.*\n", "", only("curtain", "statics"), flags=re.MULTILINE)
    _, nominal, whole = Drafts(run, tmp_path / "kept").answer(wish(tmp_path, text), silent)
    assert (nominal["nominal"], nominal["last"]) == (True, False) and (whole["nominal"], whole["last"]) == (False, True)
    fresh = run(case_of(stages_of(parse_yaml(text), "curtain")[-1], tmp_path / "case.yaml"))
    found = [(item["name"], repr(float(item["value"])), item.get("band")) for item in whole["headlines"]]
    assert found == [(item.name, repr(float(item.value)), item.as_dict().get("band")) for item in fresh.headlines]
    # the end of a band may make another water level the worst
    places = {(item["name"], item["where"]): item["value"] for item in whole["headlines"] if item["shown"]}
    alike = [item for item in nominal["headlines"] if item["shown"] and (item["name"], item["where"]) in places]
    assert len(alike) >= len(places) - 2
    for item in alike:
        assert repr(item["value"]) == repr(places[item["name"], item["where"]]), item["name"]
    assert not any(item.get("band") for item in nominal["headlines"]) and any(one[2] for one in found)
    assert "nominal numbers only" in nominal["html"] and "nominal numbers only" not in whole["html"]


@pytest.mark.slow
@pytest.mark.parametrize("chosen", ["", "HWL (+1.50 m)", "LWL (0.00 m)", "elsewhere"])
def test_the_first_draft_has_the_water_level_on_the_screen(tmp_path: Path, chosen: str) -> None:
    text = only("curtain", "statics")
    _, first, whole = Drafts(run, tmp_path / "kept").answer(wish(tmp_path, text, level=chosen), silent)
    level = "LWL" if chosen.startswith("LWL") else "HWL"
    other = "HWL" if level == "LWL" else "LWL"
    assert f'data-option="{level} (' in first["html"] and f'data-option="{other} (' not in first["html"]
    assert all(f'data-option="{name} (' in whole["html"] for name in (level, other))
    assert first["nominal"] and not first["last"] and whole["last"]
    places = {(item["name"], item["where"]): item["value"] for item in whole["headlines"] if item["shown"]}
    alike = [item for item in first["headlines"] if (item["name"], item["where"]) in places]
    assert alike and all(item["value"] == places[item["name"], item["where"]] for item in alike)


@pytest.mark.slow
def test_the_first_draft_has_what_is_on_the_screen(tmp_path: Path) -> None:
    """Statics at the top of the page, waves at once where they are looked at, and no other section."""
    text = only("breakwater", "statics, mooring, frequency")
    drafts = Drafts(run, tmp_path / "kept")
    drawn = [one["analyses"] for one in drafts.answer(wish(tmp_path, text), silent) if one["message"] == "drawn"]
    assert drawn == [["statics", "mooring"], *[["statics", "mooring", "frequency"]] * 2]
    drawn = [one for one in drafts.answer(wish(tmp_path, text, shown=("seas",)), silent) if one["message"] == "drawn"]
    assert [(one["nominal"], one["last"]) for one in drawn] == [(True, False), (False, True)]
    assert [one["analyses"] for one in drawn] == [["statics", "frequency"], ["statics", "mooring", "frequency"]]
    sections = [re.findall('<section id="([^"]+)"', one["html"]) for one in drawn]
    assert sections[0] == ["seas"] and set(sections[1]) > {"summary", "rest", "response", "seas"}
    assert drawn[0]["data"]["figures"].keys() < drawn[1]["data"]["figures"].keys(), "of the same names"
    figures = [name for name in drawn[1]["data"]["figures"] if name.startswith("hwl-") and name.endswith("-rao")]
    drawn = list(drafts.answer(wish(tmp_path, text, shown=("response", *figures), level="hwl"), silent))
    assert figures and drawn[1]["analyses"][-1] == "frequency" and set(figures) <= drawn[1]["data"]["figures"].keys()


@pytest.mark.parametrize("name", ["network", "rigid_cage", "member"])
def test_kinds_without_bands_have_no_nominal_problem(tmp_path: Path, name: str) -> None:
    case = case_of(parse_yaml(template(name)), tmp_path / "case.yaml")
    assert structure_kind(case.kind).nominal(build(case)) is None


def test_edits_keep_comments_and_units(tmp_path: Path) -> None:
    edits = {"structure.section.diameter": "80", "waves[0].height": "1.2"}
    checked, _ = Drafts(run, tmp_path).answer(wish(tmp_path, MEMBER, edits=edits), silent)
    assert checked["text"] == MEMBER.replace("100 cm", "80 cm").replace("height: 1 m", "height: 1.2 m")
    units = {one["path"]: (one["value"], one["unit"]) for one in checked["sliders"]}
    assert units["structure.section.diameter"] == (80.0, "cm")


def test_a_number_that_went_too_far_can_be_moved_back(tmp_path: Path) -> None:
    drafts = Drafts(run, tmp_path)
    edits = {"structure.section.diameter": "-5"}
    (checked,) = drafts.answer(wish(tmp_path, MEMBER, edits=edits), silent)
    assert checked["faults"] and "-5 cm" in checked["text"]
    assert any(one["value"] == -5.0 for one in checked["sliders"])
    back = {"structure.section.diameter": "100"}
    checked, _ = drafts.answer(wish(tmp_path, checked["text"], edits=back), silent)
    assert checked["text"] == MEMBER


def test_pinned_states_lie_under_the_live_one(tmp_path: Path) -> None:
    pins: tuple[Pin, ...] = ()
    for name, size in (("slender", "80 cm"), ("stout", "120 cm"), ("no case", "none")):
        pins = with_pin(pins, name, MEMBER.replace("100 cm", size))
    drafts = Drafts(run, tmp_path)
    _, drawn = drafts.answer(wish(tmp_path, MEMBER, pins=pins), silent)
    for name in ("slender", "stout"):
        assert f"First page: here and {name}" in drawn["html"]
    fresh = run(case_of(stages_of(parse_yaml(MEMBER.replace("100 cm", "80 cm")), "member")[-1], tmp_path / "p.yaml"))
    whole = compose_document(fresh)
    for figure in drawn["data"]["figures"].values():
        own = [one for one in figure["series"] if not one["label"].endswith(("(slender)", "(stout)"))]
        under = {one["label"]: one for one in figure["series"] if one not in own}
        assert under.keys() == {f"{one['label']} ({name})" for one in own for name in ("slender", "stout")}
        for one in own:
            pair = [under[f"{one['label']} ({name})"] for name in ("slender", "stout")]
            assert all(pinned["faint"] and pinned["tone"] == one["tone"] for pinned in pair), "faint, in their colours"
            assert len({one["dash"], *(pinned["dash"] for pinned in pair)}) == 3
    forces = next(block for block in whole.blocks() if isinstance(block, Figure))
    shown = next(one for one in drawn["data"]["figures"].values() if one["title"] == forces.title)
    pinned = next(one for one in shown["series"] if one["label"] == f"{forces.series[0].label} (slender)")
    assert decoded(shown["arrays"][pinned["y"]]) == pytest.approx(forces.series[0].y, rel=1e-6)
    _, drawn = drafts.answer(wish(tmp_path, MEMBER, pins=pins[1:]), silent)
    assert "slender" not in drawn["html"]


def test_pins_have_names_of_their_own_and_an_end() -> None:
    pins: tuple[Pin, ...] = ()
    for _ in range(MOST):
        pins = with_pin(pins, "a " * 40, "")
    assert len({pin.name for pin in pins}) == MOST
    with pytest.raises(InputError, match="states are pinned"):
        with_pin(pins, "one more", "")
    assert renamed(pins, pins[1].key, pins[0].name)[1].name != pins[0].name


BOMB = "a0: &a0 [x, x, x, x, x, x, x, x, x]\n" + "".join(
    f"a{n}: &a{n} [{', '.join([f'*a{n - 1}'] * 9)}]\n" for n in range(1, 12)
)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        (BOMB, "aliases expand"),
        ("[" * 5000, "nested more than"),
        ("a: !!python/object/apply:os.system ['true']", "is not allowed"),
        ("a: 1\n---\nb: 1", "second document"),
        ("x" * 2_000_001, "longer than"),
        (MEMBER + "\nmeasured: {file: ../../etc/passwd}\n", "outside the folder"),
        ("", "empty"),
    ],
)
def test_hostile_texts_are_refused_quickly(tmp_path: Path, text: str, words: str) -> None:
    started = time.perf_counter()
    (checked,) = Drafts(run, tmp_path).answer(wish(tmp_path, text), silent)
    assert any(words in fault["message"] for fault in checked["faults"]), checked["faults"][:3]
    assert time.perf_counter() - started < 5.0


async def answers(worker: DraftWorker, name: str, asked: Wish) -> list[dict[str, Any]]:
    return [json.loads(line) async for line in worker.ask(name, lambda: asked)]


def kinds(said: list[dict[str, Any]]) -> list[str]:
    return [one["message"] for one in said]


@pytest.mark.slow
def test_stale_drafts_are_given_up_and_a_killed_process_is_reported(tmp_path: Path) -> None:
    slow = MEMBER.replace("Quick", "slow")

    async def scenario() -> None:
        worker = DraftWorker(run_slowly)
        try:
            warm = await answers(worker, "one", wish(tmp_path, MEMBER))
            assert kinds(warm) == ["checked", "drawn"]

            first = asyncio.create_task(answers(worker, "one", wish(tmp_path, slow)))
            await asyncio.sleep(0.3)
            second = asyncio.create_task(answers(worker, "one", wish(tmp_path, slow)))
            third = asyncio.create_task(answers(worker, "one", wish(tmp_path, MEMBER.replace("100", "90"))))
            started = time.monotonic()
            assert "drawn" not in kinds(await first)
            assert kinds(await second) == ["stale"]
            newest = await third
            assert kinds(newest) == ["checked", "drawn"]
            assert "90 cm" in newest[0]["text"]
            assert time.monotonic() - started < 4.0

            running = asyncio.create_task(answers(worker, "two", wish(tmp_path, slow)))
            await asyncio.sleep(0.5)
            os.kill(worker.process_id or 0, signal.SIGTERM)
            assert kinds(await running)[-1] == "lost"
            assert kinds(await answers(worker, "two", wish(tmp_path, MEMBER))) == ["checked", "drawn"]
        finally:
            worker.close()

    asyncio.run(scenario())


@pytest.mark.slow
def test_two_pages_take_turns_and_no_answer_is_lost(tmp_path: Path) -> None:
    """A page in haste goes before another one's draft; a patient page waits, and neither is given the other's."""
    slow = MEMBER.replace("Quick", "slow")

    async def scenario() -> None:
        worker = DraftWorker(run_slowly)

        async def ask(name: str, text: str, patient: bool = False) -> list[dict[str, Any]]:
            given = wish(tmp_path, text)
            return [json.loads(line) async for line in worker.ask(name, lambda: given, patient=patient)]

        try:
            await ask("one", MEMBER)
            started = time.monotonic()
            long = asyncio.create_task(ask("one", slow))
            await asyncio.sleep(0.3)
            waiting = asyncio.create_task(ask("three", MEMBER, patient=True))
            await asyncio.sleep(0.1)
            assert kinds(await ask("two", MEMBER)) == ["checked", "drawn"]
            assert time.monotonic() - started < 4.0
            assert kinds(await long) == ["checked", "stale"]
            assert kinds(await waiting) == ["stale"], "a page in haste was before it"
            assert kinds(await ask("three", MEMBER, patient=True)) == ["checked", "drawn"]
        finally:
            worker.close()

    asyncio.run(scenario())


@pytest.mark.slow
@pytest.mark.parametrize(("name", "kind", "count"), [("quick", "member", 100), ("network", "network", 12)])
def test_random_moves_of_sliders_give_the_numbers_of_fresh_runs(
    tmp_path: Path, name: str, kind: str, count: int
) -> None:
    rng = np.random.default_rng(7)
    text = MEMBER if name == "quick" else template(name)
    original, drafts, drawn_count = text, Drafts(run, tmp_path / "kept"), 0
    sliders = sliders_of(parse_yaml(text), kind)
    for move in range(count):
        # a network that has been moved for long is none that anybody would build, and takes long to come to rest
        text = original if kind == "network" and move % 6 == 0 else text
        one = sliders[rng.integers(len(sliders))]
        number = f"{rng.uniform(one['low'], one['high']):.{one['decimals']}f}"
        checked, *further = drafts.answer(wish(tmp_path, text, edits={one["path"]: number}), silent)
        text = original if checked["faults"] else checked["text"]
        if checked["faults"] or further[-1]["message"] != "drawn":
            continue
        drawn_count += 1
        fresh = run(case_of(stages_of(parse_yaml(text), kind)[-1], tmp_path / "case.yaml"))
        found = [(item["name"], repr(float(item["value"]))) for item in further[-1]["headlines"]]
        assert found == [(item.name, repr(float(item.value))) for item in fresh.headlines]
    assert drawn_count > 0.7 * count
    assert [line.partition("#")[2] for line in text.splitlines()] == [
        line.partition("#")[2] for line in original.splitlines()
    ]


@pytest.mark.slow
def test_rows_of_units_are_drawn_at_rest_then_in_waves_with_kept_coefficients(tmp_path: Path, monkeypatch: Any) -> None:
    """What does not touch the water takes the coefficients that are kept; the numbers are those of a fresh run."""
    from moyai.structures.units import hydrodynamics

    text = template("units").replace("panel_size: 2 m", "panel_size: 4.5 m").replace("count: 8", "count: 3")
    drafts = Drafts(run, tmp_path / "kept")
    _, rest, _, _ = drafts.answer(wish(tmp_path, text), silent)
    assert rest["analyses"] == ["statics"] and not rest["last"]

    def refuse(*_: Any) -> None:
        raise AssertionError("coefficients are computed again")

    computed = hydrodynamics.solve_frequency
    monkeypatch.setattr(hydrodynamics, "solve_frequency", refuse)
    edits = {
        "structure.roll_gyradius": "2.75", "structure.connectors[0].above_keel": "2.8",
        "lines[0].segments[0].length": "58.4", "waves[1].significant_height": "1.4", "waves[0].height": "0.9",
    }  # fmt: skip
    checked, _, nominal, whole = drafts.answer(wish(tmp_path, text, edits=edits), silent)
    assert checked["faults"] == [] and all(number in checked["text"] for number in edits.values())
    assert nominal["nominal"] and whole["last"] and whole["analyses"] == ["statics", "frequency"]
    monkeypatch.setattr(hydrodynamics, "solve_frequency", computed)
    draft = stages_of(parse_yaml(checked["text"]), "units")[-1]
    fresh = run(case_of(draft, tmp_path / "case.yaml"))
    found = [(item["name"], float(item["value"])) for item in whole["headlines"]]
    assert found == [(item.name, pytest.approx(float(item.value), rel=1e-9, nan_ok=True)) for item in fresh.headlines]


def test_drafts_of_rows_share_round_frequencies_from_sea_to_sea() -> None:
    from moyai.structures.units.seas import frequencies_of

    text = template("units").replace("frequencies: {from: 0.7, to: 2.0, count: 8}", "frequencies: auto")
    found = []
    for period in ("6 s", "6.2 s"):
        case = case_of(parse_yaml(text.replace("peak_period: 6 s", f"peak_period: {period}")), Path("case.yaml"))
        nominal = structure_kind("units").nominal(build(case))
        found.append(set(np.round(frequencies_of(nominal.environment, nominal.settings), 9)))
    assert len(found[0] & found[1]) >= len(found[0]) - 2
