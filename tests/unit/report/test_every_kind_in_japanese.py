"""Reports of every kind in Japanese: no English word left, numbers those of the English report, no letter missing."""

from __future__ import annotations

import re
from dataclasses import replace
from pathlib import Path

import pytest
from fontTools.ttLib import TTFont
from japanese import compared, compared_document, drawn_without_boxes

import moyai
from moyai.case.templates import template
from moyai.language.catalogue import catalogue
from moyai.report import fonts
from moyai.report.pdf import render_pdf
from moyai.report.word import render_docx
from moyai.report.writer import compose_document

EXAMPLES = Path(__file__).resolve().parents[3] / "examples"
CASES = sorted(
    path
    for path in EXAMPLES.rglob("*.yaml")
    # a structure of another package is known where that is installed
    if "new_structure" not in path.parts and re.search(r"(?m)^structure:", path.read_text("utf-8"))
)
HEAVY = {"circular_50m", "grid_2x2", "pontoon", "skirt", "buoy", "moored_box", "dynamic", "dynamic_lines"}
"""Examples of minutes: their pages have the words of the lighter ones of their kind."""


def assert_japanese(case: str | Path, least: int) -> None:
    """Run a case and hold its report in Japanese against that in English."""
    result = moyai.run(moyai.load_case(case))
    left, count = compared(result)
    assert count > least
    assert not left, "\n".join(left)
    assert drawn_without_boxes(result, most=2) > 0
    document = compose_document(result, language="ja")
    assert render_pdf(document).startswith(b"%PDF")
    assert len(render_docx(document)) > 20_000


def test_a_network_that_snaps() -> None:
    assert_japanese(EXAMPLES / "network" / "snap.yaml", least=300)


@pytest.mark.slow
@pytest.mark.parametrize("kind", ["member", "network", "rigid_cage", "curtain", "breakwater", "cage", "units"])
def test_templates(kind: str) -> None:
    if kind == "units":
        pytest.importorskip("capytaine")
    assert_japanese(template(kind), least=250)


@pytest.mark.slow
@pytest.mark.parametrize("path", [path for path in CASES if path.stem not in HEAVY], ids=lambda path: path.stem)
def test_examples(path: Path) -> None:
    if path.parent.name == "units":
        pytest.importorskip("capytaine")
    assert_japanese(path, least=250)


@pytest.mark.slow
@pytest.mark.parametrize("paper", ["arai", "matsubara", "nakamura", "sawaragi", "tabata"])
def test_papers(paper: str) -> None:
    from moyai.reproduce import as_result, compose, reproduce

    found = reproduce(paper, quick=True)
    left, count = compared_document(replace(compose(found, as_result(found)), language="ja"))
    assert count > 200
    assert not left, "\n".join(left)


def test_the_font_has_every_letter_of_the_catalogue() -> None:
    """Pages, figures, PDF and Word take their Japanese letters from this font or one that has more."""
    file = fonts.packaged_font()
    if file is None:
        pytest.skip("moyai[ja] is not installed")
    known = TTFont(file).getBestCmap()
    letters = {letter for text in catalogue("ja").values() for letter in text if ord(letter) > 0x2E7F}
    assert len(letters) > 900
    assert {letter for letter in letters if ord(letter) not in known} == set()
