"""Reports in Japanese: no English word is left, every number is that of the English report, no letter is missing."""

from __future__ import annotations

import base64
import io
import re
from dataclasses import replace
from pathlib import Path

import openpyxl
import pytest
from fontTools.ttLib import TTFont
from japanese import compared, drawn_without_boxes
from small_results import curtain, pontoon, without
from typer.testing import CliRunner

import moyai
from moyai.cli.main import app
from moyai.core.errors import InputError
from moyai.core.results import Result
from moyai.report import fonts
from moyai.report.document import Figure, KeyFigure
from moyai.report.html import is_sentence, render_html
from moyai.report.pdf import render_pdf
from moyai.report.word import render_docx
from moyai.report.workbook import render_workbook
from moyai.report.writer import compose_document

JAPANESE = re.compile("[\u3040-\u30ff\u4e00-\u9fff]")
KINDS = {"breakwater": pontoon, "curtain": curtain}


@pytest.fixture(scope="module", params=list(KINDS))
def result(request: pytest.FixtureRequest) -> Result:
    return KINDS[request.param]()


def test_no_english_word_is_left_and_numbers_are_the_same(result: Result) -> None:
    left, count = compared(result)
    assert count > 200
    assert not left, "\n".join(left)


def test_a_report_in_english_is_what_it_was(result: Result) -> None:
    document = compose_document(result)
    assert document.language == "en"
    page = render_html(document)
    assert '<html lang="en">' in page
    assert "moyai-ja" not in page
    heads = re.findall(r"<h[23]>(.*?)</h[23]>|<th[^>]*>(.*?)<", page)
    assert len(heads) > 30
    assert not JAPANESE.search(str(heads))


@pytest.mark.slow
def test_the_page_brings_every_japanese_letter_that_it_shows(result: Result) -> None:
    page = render_html(compose_document(result, language="ja"))
    assert '<html lang="ja">' in page
    data = re.search(r"data:font/woff;base64,([A-Za-z0-9+/=]+)", page)
    assert data
    known = TTFont(io.BytesIO(base64.b64decode(data[1]))).getBestCmap()
    shown = set(JAPANESE.findall(page))
    assert len(shown) > 150
    assert {letter for letter in shown if ord(letter) not in known} == set()
    # drawings name faces of their own, which a rule of the page has to replace
    assert 'body,svg{font-family:"Segoe UI"' in page


@pytest.mark.slow
def test_figures_have_all_their_letters(result: Result) -> None:
    assert drawn_without_boxes(compose_document(result, language="ja")) > 0


@pytest.mark.slow
@pytest.mark.parametrize("result", ["curtain", pytest.param("breakwater", marks=pytest.mark.slow)], indirect=True)
def test_pdf_word_and_workbook_are_written(result: Result) -> None:
    document = compose_document(result, language="ja")
    # two sections with their drawings; whole examples are held in test_every_kind_in_japanese
    first = replace(document, sections=document.sections[:2])
    assert any(isinstance(block, Figure) for block in first.blocks())
    assert render_pdf(first).startswith(b"%PDF")
    assert len(render_docx(first)) > 20_000
    book = openpyxl.load_workbook(io.BytesIO(render_workbook(document)))
    assert book.sheetnames[0] == "要約"
    heads = [str(cell.value) for sheet in book.worksheets[1:-1] for cell in sheet[1] if cell.value]
    assert sum(bool(JAPANESE.search(head)) for head in heads) > 20


def test_without_a_font_a_message_says_what_helps(monkeypatch: pytest.MonkeyPatch) -> None:
    with pytest.raises(InputError, match=r'no font with Japanese letters.*pip install "moyai\[ja\]"'):
        fonts.require_japanese(["DejaVu Sans"])
    monkeypatch.setattr(fonts, "packaged_font", lambda: None)
    assert fonts.embedded_style("漢字") == ""
    assert fonts.font_folders() == []


@pytest.mark.slow
def test_the_command_takes_a_language(tmp_path: Path) -> None:
    without(pontoon(), "/HWL").write(tmp_path / "results.nc")
    before = (tmp_path / "results.nc").read_bytes()
    found = CliRunner().invoke(app, ["report", str(tmp_path / "results.nc"), "--language", "ja"])
    assert found.exit_code == 0, found.output
    assert "計算：収束" in found.output
    assert (tmp_path / "results.nc").read_bytes() == before
    assert '<html lang="ja">' in (tmp_path / "report.html").read_text(encoding="utf-8")
    heads = [path.read_text(encoding="utf-8-sig").splitlines()[0] for path in tmp_path.glob("report_tables/*.csv")]
    assert sum(bool(JAPANESE.search(head)) for head in heads) > 5
    wrong = CliRunner().invoke(app, ["report", str(tmp_path / "results.nc"), "--language", "fr"])
    assert wrong.exit_code == 2
    assert "'fr' is no language of reports" in wrong.output


def test_the_locale_is_taken_where_nothing_else_names_a_language(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("MOYAI_LANGUAGE", "ja")
    missing = CliRunner().invoke(app, ["run", str(tmp_path / "none.yaml")])
    assert missing.exit_code == 2
    assert JAPANESE.search(missing.output)
    english = CliRunner().invoke(app, ["run", str(tmp_path / "none.yaml"), "--language", "en"])
    assert not JAPANESE.search(english.output)
    assert compose_document(without(pontoon(), "/HWL", "/time")).language == "en"


def test_a_case_names_its_language_and_keeps_its_hash() -> None:
    case = moyai.load_case(moyai.template("member"))
    changed = case.replace("display", {"language": "ja"})
    assert changed.model.display.language == "ja"
    assert changed.case_hash == case.case_hash


def test_a_new_file_has_comments_in_japanese_and_the_same_content(tmp_path: Path) -> None:
    english = CliRunner().invoke(app, ["new", "curtain", "--language", "en"]).output
    japanese = CliRunner().invoke(app, ["new", "curtain", "--language", "ja"]).output
    assert japanese != english
    bare = [re.sub(r"\s*#.*", "", text) for text in (english, japanese)]
    assert bare[0] == bare[1]
    assert moyai.load_case(japanese).case_hash == moyai.load_case(english).case_hash


def test_words_in_place_of_a_number_are_shown_smaller_in_both_languages() -> None:
    """A letter of Japanese counts as two: three lines of large print stood where a number stands."""
    assert is_sentence(KeyFigure("not judged", "疲労、索一本の喪失、他の向き", ""))
    assert is_sentence(KeyFigure("not judged", "fatigue, a lost line, other headings", ""))
    assert not is_sentence(KeyFigure("current", "0.508 m/s 以上", "")) and not is_sentence(
        KeyFigure("x", "12.1 tf", "")
    )
