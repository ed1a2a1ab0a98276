"""Pictures of the documentation: every example in the gallery, drawings of reports in the language of their page."""

from __future__ import annotations

import re
import sys
from concurrent.futures import Future
from pathlib import Path
from xml.etree import ElementTree

import pytest
from small_results import pontoon

from moyai.core.kinds import structure_kinds

pytest.importorskip("sphinx")
ROOT = Path(__file__).resolve().parents[3]
sys.path.insert(0, str(ROOT / "docs"))
import computed_ahead  # noqa: E402 - stands with the pages
import gallery  # noqa: E402
import report_pictures  # noqa: E402

JAPANESE = re.compile("[\u3040-\u30ff\u4e00-\u9fff]")


def test_the_gallery_has_every_example() -> None:
    commands = [gallery.command_of(path) for path in gallery.examples()]
    names = {word for command in commands for word in command.split() if word.startswith("examples/")}
    tracked = {path.relative_to(ROOT).as_posix() for path in (ROOT / "examples").rglob("*.yaml")}
    assert names >= tracked - {"examples/new_structure/moyai_spar/template.yaml"}
    assert names >= {
        f"examples/papers/{one}" for one in ("tabata/kansai.yaml", "matsubara/taut.yaml", "arai/circle.yaml")
    }
    assert "moyai measure nets examples/nets/nets.yaml" in commands
    assert "moyai measure snaps examples/curtain/flume/snaps.yaml" in commands
    assert sum(command.startswith("moyai study examples/study/") for command in commands) == 4
    assert sum("moyai new spar" in command for command in commands) == 1
    assert len(commands) == len(set(commands))


def test_every_picture_that_a_page_asks_for_is_known() -> None:
    asked = [
        name
        for page in (*(ROOT / "docs").glob("tutorial/*.md"), *(ROOT / "docs").glob("ja/*.md"))
        for name in re.findall(r"^:of: (\S+)$", page.read_text(encoding="utf-8"), re.MULTILINE)
    ]
    assert set(asked) == {*report_pictures.RUNS, "add_a_structure"}


@pytest.mark.slow
def test_pictures_are_those_of_the_report_in_both_languages() -> None:
    result = pontoon()
    english, japanese = (report_pictures.pictures_of(result, language) for language in ("en", "ja"))
    assert list(english) == list(japanese) and len(english) > 5
    for key, (title, svg) in japanese.items():
        assert JAPANESE.search(title) and not JAPANESE.search(english[key][0])
        ElementTree.fromstring(svg[svg.index("<svg") :])


def test_the_spar_hangs_on_its_chain() -> None:
    """The chain ends at the keel, in the middle of the spar, and starts at the bed."""
    with report_pictures.spar_installed():
        drawn = ElementTree.fromstring(report_pictures.spar_at_work())
    spar = next(one for one in drawn if one.attrib.get("stroke") == "#33414d").attrib
    line = next(one for one in drawn if one.tag.endswith("polyline")).attrib["points"].split()
    bed = max(float(one.attrib["y"]) for one in drawn if "y" in one.attrib)
    start, end = (tuple(map(float, line[index].split(","))) for index in (0, -1))
    keel = float(spar["x"]) + 0.5 * float(spar["width"]), float(spar["y"]) + float(spar["height"])
    assert end == pytest.approx(keel, abs=2e-3)
    assert start[1] == pytest.approx(bed, abs=2e-3)
    assert "spar" not in structure_kinds()


def test_what_pages_ask_for_is_computed_ahead(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    """The jobs of all pages are what the directives ask for, each once, and a job that was started is waited for."""
    pages = (page for page in (ROOT / "docs").rglob("*.md") if "adr" not in page.parts)
    text = "\n".join(page.read_text(encoding="utf-8") for page in pages)
    found = list(computed_ahead.jobs(tmp_path, text, quick=True))
    asked = [(function.__name__, *arguments[:1]) for function, arguments, _ in found]
    assert len(asked) == len(set(asked))
    assert asked[0] == ("computed", tmp_path / "validation")
    assert {place for name, place in asked if name == "card"} == set(gallery.examples())
    assert sum(name == "compute" for name, _ in asked) == 5 and ("kept_picture", tmp_path / "_images") in asked
    pictures = {run for name, run in asked if name == "kept_pictures"}
    assert pictures == {*report_pictures.RUNS, "add_a_structure"}
    assert list(computed_ahead.jobs(tmp_path, "# A page of words", quick=True)) == []

    def card(path: Path, folder: Path, *, quick: bool) -> str:
        return f"{path} {quick}"

    started: Future[str] = Future()
    started.set_result("from the other process")
    monkeypatch.setitem(computed_ahead._started, computed_ahead._key(card, (ROOT, tmp_path), {"quick": True}), started)
    assert computed_ahead.ahead(card, ROOT, tmp_path, quick=True) == "from the other process"
    assert computed_ahead.ahead(card, ROOT, tmp_path, quick=False) == f"{ROOT} False"
