"""Reports of every kind in Japanese: no English word left, numbers those of the English report, no letter missing."""

from __future__ import annotations

import os
import re
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from fontTools.ttLib import TTFont
from japanese import (
    compared_document,
    drawn_without_boxes,
    letters_missing_in_figure,
    missing_in_page,
    without_boxes,
    words_of,
)
from kept_runs import kept_paper, kept_run
from small_results import pontoon
from typer.testing import CliRunner

from moyai.case.reader import Case, load_case
from moyai.case.templates import template
from moyai.cli.main import app
from moyai.core.results import Result, read_result
from moyai.language.catalogue import catalogue
from moyai.report import fonts
from moyai.report.document import Document, Figure
from moyai.report.html import render_html
from moyai.report.writer import compose_document

EXAMPLES = Path(__file__).resolve().parents[3] / "examples"


def examples(head: str) -> list[Path]:
    """Return the examples with a head; the folders of the papers are links, which rglob does not follow."""
    files = (Path(folder) / name for folder, _, names in os.walk(EXAMPLES, followlinks=True) for name in names)
    found = sorted(
        path for path in files if path.suffix == ".yaml" and re.search(f"(?m)^{head}:", path.read_text("utf-8"))
    )
    # a structure of another package is known where that is installed
    return [path for path in found if "new_structure" not in path.parts]


CASES, STUDIES = examples("structure"), examples("study")
TEMPLATES = ("member", "network", "rigid_cage", "curtain", "breakwater", "cage", "units")
#: Shorter seas and coarser meshes, with which a report has the same words.
COARSE = {"around": 16, "down": 3, "bottom": 3, "rope_length": "14 m"}
ONE_SPEED = {"current_speeds": ["0.25 m/s"], "periods": 2}
TYPHOON = {
    "name": "typhoon 9918", "kind": "bretschneider_mitsuyasu", "significant_height": "3.06 m",
    "significant_period": "6.75 s", "heading_deg": 60, "duration": "4 min",
}  # fmt: skip
FEW_POINTS = {
    "map.points_across": 5, "map.points_along": 5, "settings.time": {"realisations": 2, "memory_frequencies": 12},
}  # fmt: skip
SHORTER: dict[str, dict[str, Any]] = {
    "breakwater": {
        "waves[0].periods": [3.0, 5.0, 8.0], "waves[1].duration": "10 min",
        "settings.time": {"realisations": 3, "analysed_periods": 4},
    },
    "curtain": {
        "waves[0].periods": ["3 s", "5 s"], "waves[1].duration": "4 min",
        "settings.waves": {"settled_periods": 2, "analysed_periods": 5, "realisations": 2},
        "settings.limits": {"speeds": ["0.25 m/s", "1.5 m/s"], "highest_speed": "1.5 m/s", "highest_height": "1 m"},
    },
    "cage": {"structure.mesh": COARSE, "settings.flexible": ONE_SPEED},
    "member": {"waves[1].duration": "4 min"},
    "units": FEW_POINTS | {
        "settings.panel_size": "4 m", "settings.frequencies.count": 4,
        "waves[0].periods": ["5 s"], "waves[1].duration": "8 min",
    },
    "breakwater/dynamic_lines": {
        "waves[0].periods": [4.6], "waves[1].duration": "1 min",
        "settings.time": {"lines": {"bars": 12, "damping_ratio": 0.1, "snap_fraction": 3}, "realisations": 2},
    },
    "cage/circular_50m": {"structure.mesh": COARSE, "settings.flexible": ONE_SPEED},
    "cage/grid_2x2": {"structure.mesh": COARSE, "structure.mooring.rows": 1, "settings.flexible": ONE_SPEED},
    "curtain/dynamic": {"settings.dynamic.cells_along": 12, "settings.dynamic.cells_down": 4},
    "curtain/tidal_channel": {
        "waves[0].duration": "90 s", "settings.waves": {"settled_periods": 2, "analysed_periods": 5, "realisations": 2},
    },
    "matsubara/taut": {
        "waves[0].periods": [1.0, 1.5], "waves[1].heights": ["2.2 cm", "3.3 cm"],
        "settings.rigid.stiffnesses": ["1 kN/m", "10 kN/m"],
    },
    "member/inclined_brace": {"waves[0].duration": "2 min"},
    "nakamura/tank_model": {
        "waves.periods": [0.6, 1.0],
        "settings.sensitivity": {"damping_fractions": [0, 0.15], "line_slacks": ["3.16 cm"], "line_counts": [2, 4]},
    },
    "network/flume_box": {
        "settings": {"duration": "8 s", "output_step": "25 ms", "ramp": "2 s", "skip": "4 s"},
        **{f"structure.lines.{side} {hand}.segments": 8 for side in ("seaward", "lee") for hand in ("left", "right")},
    },
    "network/buoy": {"waves[0].duration": "1 min", "settings.realisations": 3},
    "network/net_in_current": {"settings.duration": "20 s"},
    "network/skirt": {
        **{f"structure.sheets.skirt.{name}": count for name, count in {"rows": 4, "columns": 7}.items()},
        **{f"structure.lines.rope {n}.end": f"skirt[3,{6 * n - 6}]" for n in (1, 2)},
        **{f"structure.lines.rope {n}.segments": 6 for n in (1, 2)},
        "settings.duration": "5 s", "settings.skip": "1 s",
    },
    "network/turning_rod": {"settings.duration": "30 s", "structure.lines.rope.segments": 8},
    "tabata/kansai": {
        "waves": [TYPHOON],
        "settings.waves": {"realisations": 2}, "settings.limits": {"highest_speed": "1 m/s", "highest_height": "3 m"},
        "settings.dynamic.by_default": False,
    },
    "sawaragi/flume": {"waves[0].periods": ["2 s"], "settings.dynamic": {"cells_along": 8, "cells_down": 4}},
    "units/two_pontoons": FEW_POINTS
    | {
        "settings.panel_size": "3 m", "settings.frequencies.count": 5,
        "waves[0].periods": ["3.1 s"], "waves[1].duration": "8 min",
    },
}  # fmt: skip

#: Fewer cases of studies, with which a report has the same words.
FEWER = {
    "best_line": {"[0.2, 0.3, 0.4]": "[0.2, 0.4]", "evaluations: 20": "evaluations: 8"},
    "sea_states": {"[0.5 m, 0.8 m]": "[0.8 m]", "count: 3": "count: 2"},
}


def assert_japanese(case: Case, least: int, name: str = "", *, on_paper: bool = True) -> None:
    """Run a case, shorter where its name is in the list, and hold its report in Japanese against that in English."""
    hold(kept_run(case.replace(SHORTER[name]) if name in SHORTER else case), least, on_paper=on_paper)


def hold(result: Result, least: int, file: str = "", *, on_paper: bool = True) -> None:
    """Hold the report of a result in Japanese against that in English; its letters in PDF and Word where asked for."""
    document = compose_document(result, language="ja")
    left, count = compared_document(document, words_of(result, file))
    assert count > least
    assert not left, "\n".join(left)
    assert drawn_without_boxes(document, most=1) > 0
    assert_letters(document, on_paper)


def assert_letters(document: Document, on_paper: bool = True) -> None:
    """Look for letters that no font of page and figures has, and of PDF and Word, which have the same texts."""
    if fonts.packaged_font() is None:
        pytest.skip("moyai[ja] is not installed: there is no font to hold the letters against")
    if not on_paper:
        figures = [block for block in document.blocks() if isinstance(block, Figure)]
        assert not [figure.title for figure in figures if letters_missing_in_figure(figure)]
        assert missing_in_page(render_html(document)) == set()
        return
    assert without_boxes(document) == {"page": set(), "PDF": set(), "Word": set()}


@pytest.mark.slow
def test_a_network_that_snaps() -> None:
    assert_japanese(load_case(EXAMPLES / "network" / "snap.yaml"), least=300)


@pytest.mark.slow
@pytest.mark.parametrize("kind", TEMPLATES)
def test_templates(kind: str) -> None:
    assert_japanese(load_case(template(kind)), 250, kind)


def test_every_example_is_held() -> None:
    names = {path.parent.name for path in CASES}
    assert names >= {"arai", "matsubara", "nakamura", "sawaragi", "tabata", "cage", "network", "flume_section"}
    assert len(CASES) > 20 and len(STUDIES) >= 4
    assert {*TEMPLATES, *(f"{path.parent.name}/{path.stem}" for path in CASES)} >= set(SHORTER)


@pytest.mark.slow
@pytest.mark.parametrize("path", CASES, ids=lambda path: f"{path.parent.name}-{path.stem}")
def test_examples(path: Path) -> None:
    # the plain net has few notices
    least = 150 if path.stem == "net_in_current" else 250
    # the templates of all kinds are held on paper
    assert_japanese(load_case(path), least, f"{path.parent.name}/{path.stem}", on_paper=False)


@pytest.mark.slow
@pytest.mark.parametrize("path", STUDIES, ids=lambda path: path.stem)
def test_studies(path: Path, tmp_path: Path) -> None:
    text = path.read_text(encoding="utf-8")
    for many, few in FEWER.get(path.stem, {}).items():
        assert many in text
        text = text.replace(many, few)
    text = re.sub(r"base: (\S+)", lambda found: f"base: {(path.parent / found[1]).resolve()}", text)
    (tmp_path / path.name).write_text(text, encoding="utf-8")
    command = ["--language", "ja", "study", str(tmp_path / path.name), "-o", str(tmp_path / "out")]
    found = CliRunner().invoke(app, command)
    assert found.exit_code == 0, found.output
    page = (tmp_path / "out" / "report.html").read_text(encoding="utf-8")
    assert '<html lang="ja">' in page and missing_in_page(page) == set()
    hold(read_result(tmp_path / "out" / "study.nc"), 100, text)


@pytest.mark.slow
@pytest.mark.parametrize("paper", ["arai", "matsubara", "nakamura", "sawaragi", "tabata"])
def test_papers(paper: str) -> None:
    from moyai.reproduce import as_result, compose

    found = kept_paper(paper, quick=True)
    document = replace(compose(found, as_result(found)), language="ja")
    left, count = compared_document(document)
    assert count > 200
    assert not left, "\n".join(left)
    assert_letters(document, on_paper=paper == "tabata")


@pytest.mark.slow
@pytest.mark.parametrize("letter", ["\U0001f9ff", "\U0002a6d6"])
def test_a_letter_that_no_font_has_is_found(letter: str) -> None:
    """So that the tests above can fail."""
    if fonts.packaged_font() is None:
        pytest.skip("moyai[ja] is not installed")
    document = compose_document(pontoon(), language="ja")
    document = replace(document, title=f"試験{letter}", sections=document.sections[:1])
    found = without_boxes(document)
    assert found["page"] == {letter} and found["Word"] == {letter}
    assert len(found["PDF"]) == 1


@pytest.mark.slow
@pytest.mark.parametrize("letter", ["\U0001f9ff", "\U0002a6d6"])
def test_a_letter_that_no_face_of_figures_has_is_found(letter: str) -> None:
    figure = next(block for block in compose_document(pontoon(), language="ja").blocks() if isinstance(block, Figure))
    assert letters_missing_in_figure(figure) == set()
    named = replace(figure.series[0], label=f"線{letter}₂")
    assert letters_missing_in_figure(replace(figure, series=(named, *figure.series[1:]))) == {letter}


def test_the_font_has_every_letter_of_the_catalogue() -> None:
    """Pages, figures, PDF and Word take their Japanese letters from this font or one that has more."""
    file = fonts.packaged_font()
    if file is None:
        pytest.skip("moyai[ja] is not installed")
    known = TTFont(file).getBestCmap()
    letters = {letter for text in catalogue("ja").values() for letter in text if ord(letter) > 0x2E7F}
    assert len(letters) > 900
    assert {letter for letter in letters if ord(letter) not in known} == set()
