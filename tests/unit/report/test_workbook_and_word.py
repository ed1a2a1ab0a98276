"""The report as workbook and as Word document, read by programs of other people: openpyxl and python-docx."""

from __future__ import annotations

import io
import math
import re
import warnings
from dataclasses import replace

import docx
import numpy as np
import openpyxl
import pytest
from docx.shared import Cm
from typer.testing import CliRunner

from moyai.cli.main import app
from moyai.core.errors import InputError
from moyai.core.validity import Notice
from moyai.report.document import (
    Abscissa,
    Badge,
    Chapter,
    Choice,
    Column,
    Document,
    Drawing,
    Figure,
    KeyFigure,
    KeyFigures,
    Listing,
    NoticeBlock,
    Option,
    Panel,
    Paragraph,
    Series,
    Table,
)
from moyai.report.formatting import DASH, MINUS, display_unit, format_quantity, read_quantity
from moyai.report.word import column_shares, render_docx
from moyai.report.workbook import LONGEST, NAME, NUMBERS, _shortened, render_workbook

SVG = '<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 40 20"><rect width="40" height="20"/></svg>'


def _table(title: str = "Lines [at rest]: a table with a long name") -> Table:
    return Table(
        "lines",
        title,
        (
            Column("Line", ["=1+1", "seaward"]),
            Column("Tension", [12345.678, math.nan], "N"),
            Column("Holds", [True, False]),
            Column("Reserve", [math.inf, -0.25], "1"),
        ),
        note="a note",
        emphasised=(1,),
    )


def _figure(count: int) -> Figure:
    time = np.linspace(0.0, 10.0, count)
    level = np.sin(time)
    level[count // 3] = 7.0
    series = (Series("gauge", {"t": time}, level), Series("model", {"t": time}, -level, dash="dash"))
    return Figure("record", "Record", (Abscissa("t", "time", "s"),), (Panel("level", "m"),), series)


def _document(count: int = 50) -> Document:
    choice = Choice("level", "Water level", (Option("HWL", (_table(),)), Option("LWL", (_table(),))))
    blocks = (
        KeyFigures((KeyFigure("largest tension", "12.3 kN", "line seaward"),)),
        NoticeBlock((Notice("steep", "the wave is steep", 0.2, 0.14, remedy="take a lower one"),)),
        choice,
        _figure(count),
        Drawing("section", "Chapter", SVG, SVG, "to scale"),
        Listing("Case", "moyai: 1\n=a\n"),
    )
    badge = Badge("Design", "Holds", "all criteria hold", "good")
    return Document("A title", "under it", "converged", "", (Chapter("all", "All", blocks),), {}, (badge,))


def _read(document: Document) -> openpyxl.Workbook:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        return openpyxl.load_workbook(io.BytesIO(render_workbook(document)))


def test_a_sheet_a_table_with_units_in_the_heads_and_numbers_as_numbers():
    book = _read(_document())
    names = book.sheetnames
    assert names[0] == "Summary" and len(set(map(str.lower, names))) == len(names)
    assert all(len(name) <= NAME for name in names)
    sheet = book[names[1]]
    rows = list(sheet.iter_rows(values_only=True))
    assert rows[0][:4] == ("Line", "Tension [kN]", "Holds", "Reserve")
    # a text that looks like a formula stays a text; what is not known is empty
    assert rows[1][:4] == ("=1+1", pytest.approx(12.345678), "yes", "inf") and sheet["A2"].data_type == "s"
    assert rows[2][:4] == ("seaward", None, "no", -0.25)
    assert sheet["A3"].font.bold and not sheet["A2"].font.bold


def test_the_summary_has_badges_governing_numbers_notices_and_a_link_to_every_sheet():
    book = _read(_document())
    cells = [cell for row in book["Summary"].iter_rows() for cell in row if cell.value is not None]
    texts = [str(cell.value) for cell in cells]
    for wanted in ("A title", "Holds", "Largest tension", "kN", "Warning"):
        assert wanted in texts
    assert [cell.value for cell in cells if cell.data_type == "n"] == [12.3]
    targets = {cell.hyperlink.location.rpartition("!")[0].strip("'") for cell in cells if cell.hyperlink}
    assert targets == set(book.sheetnames[1:])
    assert any("LWL: Lines [at rest]" in text for text in texts)


@pytest.mark.parametrize("language", ["en", "ja"])
def test_numbers_of_the_first_page_and_of_criteria_are_numbers_with_unit_and_bound_next_to_it(language):
    texts = (
        "6.14 tf",
        "at least 4.57°",
        f"{MINUS}0.0152",
        "at most 2.50×10⁻⁵ kN·m/rad",
        "∞",
        "DN 300",
        DASH,
        "36.5 %",
    )
    wanted = [
        (6.14, "tf", None),
        (4.57, "°", ("at least", "以上")),
        (-0.0152, None, None),
        (2.5e-5, "kN·m/rad", ("at most", "以下")),
        ("inf", None, None),
        ("DN 300", None, None),
        (None, None, None),
        (36.5, "%", None),
    ]
    rows = [(value, unit, bound and bound[language == "ja"]) for value, unit, bound in wanted]
    criteria = Table(
        "criteria",
        "Criteria",
        (
            Column("Criterion", [f"number {row}" for row in range(len(texts))]),
            Column("Limit", texts, quantities=True),
            Column("Found", ["1.46e-05"] * len(texts), quantities=True),
        ),
    )
    numbers = KeyFigures(tuple(KeyFigure(f"label {row}", text, "detail") for row, text in enumerate(texts)))
    book = _read(Document("T", "", "converged", "", (Chapter("s", "S", (numbers, criteria)),), language=language))
    summary = list(book.worksheets[0].iter_rows(values_only=True))
    found = [row[1:4] for row in summary if str(row[0]).startswith("Label ")]
    sheet = list(book.worksheets[1].iter_rows(min_row=2, values_only=True))
    assert found == rows
    assert [row[1:4] for row in sheet] == rows and {row[4] for row in sheet} == {1.46e-5}
    heads = [cell.value for cell in book.worksheets[1][1] if cell.value]
    assert len(heads) == len(set(heads)) == 5 and heads[2].startswith(heads[1])


@pytest.mark.parametrize("unit", ["N", "m", "rad", "1", "N m/rad", "kg/m3", "m3/s"])
def test_a_quantity_is_read_as_it_was_written(unit):
    for value in (1.5e-9, 0.0, -0.031234, 7.0, 123.456, -98765.4, 4.2e9, math.inf, -math.inf):
        shown = display_unit(unit, value)
        number, name = read_quantity(format_quantity(value, unit, digits=9))
        assert number == pytest.approx(value * shown.factor, rel=1e-8) and name == shown.pretty
    assert math.isnan(read_quantity(format_quantity(math.nan, unit))[0])


@pytest.mark.parametrize(
    "text", ["", "A 3", "2 of 3", "1.2 to 1.4 m", "0.2.0", "3/4", "1 m, 2 m", "5–6 m", "1.8～2.3", "12 h 5"]
)
def test_other_texts_are_no_quantity(text):
    assert read_quantity(text) is None


def test_long_figures_keep_their_extremes_and_say_so():
    book = _read(_document(10 * LONGEST))
    rows = list(book["Record"].iter_rows(values_only=True))
    values = np.array([row[1] for row in rows[1:]], dtype=float)
    assert rows[0] == ("time [s]", "gauge [m]", "model [m]")
    assert len(values) <= LONGEST + 2 and values.max() == 7.0
    assert any("every extreme kept" in str(row[4]) for row in book["Summary"].iter_rows(values_only=True))
    short = list(_read(_document(50))["Record"].iter_rows(values_only=True))
    assert len(short) == 51


@pytest.mark.slow
def test_many_long_records_are_shortened_to_what_is_written_in_a_second():
    time = np.linspace(0.0, 600.0, 5000)
    records = []
    for number in range(60):
        values = np.sin(time + number)
        values[1234 + number] = 9.0 + number
        series = tuple(Series(f"s{k}", {"t": time}, values * (k + 1)) for k in range(5))
        records.append(Figure(f"record-{number}", f"Record {number}", (Abscissa("t", "time"),), (Panel("y"),), series))
    book = _read(Document("t", "", "converged", "", (Chapter("a", "A", tuple(records)),)))
    rows = [list(book[f"Record {number}"].iter_rows(min_row=2, values_only=True)) for number in range(60)]
    assert sum(len(one) * 6 for one in rows) < 1.3 * NUMBERS
    assert all(max(row[1] for row in one) == 9.0 + number for number, one in enumerate(rows))
    assert all(one[0][0] == 0.0 and one[-1][0] == 600.0 for one in rows)


@pytest.mark.parametrize(
    ("title", "name"),
    [
        ("Wave heights over the incident one: ferry wash", "Wave heights over the incident"),
        ("Notices on the range of validity of it", "Notices on the range"),
        ("Motions and forces over the period: x", "Motions and forces"),
        ("Pneumonoultramicroscopicsilicovolcanoconiosis", "Pneumonoultramicroscopicsilicov"),
    ],
)
def test_names_of_sheets_end_with_a_word_that_says_something(title, name):
    assert _shortened(title, NAME) == name


def test_word_has_headings_counted_captions_tables_and_images():
    paper = docx.Document(io.BytesIO(render_docx(_document())))
    styles = [line.style.name for line in paper.paragraphs]
    assert styles[0] == "Title" and "Heading 1" in styles and "Heading 2" in styles
    captions = [line for line in paper.paragraphs if line.style.name == "Caption"]
    assert [line.text.split(".")[0] for line in captions] == ["Table 1", "Table 2", "Figure 1", "Figure 2"]
    assert "SEQ Figure" in captions[2]._p.xml
    grid = paper.tables[1]
    assert [cell.text for cell in grid.rows[0].cells] == ["Line", "Tension [kN]", "Holds", "Reserve"]
    assert len(paper.inline_shapes) == 2


def _fields(paper) -> list[tuple[str, str]]:
    """Return code and cached text of every field, in order."""
    found, code, text, state = [], "", "", ""
    for part in paper.element.xpath("//w:fldChar | //w:instrText | //w:r[not(w:instrText)]/w:t"):
        if part.tag.endswith("fldChar"):
            state = part.get(part.tag.replace("fldChar", "fldCharType"))
            if state == "begin":
                code = text = ""
            elif state == "end":
                found.append((code.strip(), text))
        elif part.tag.endswith("instrText"):
            code += part.text
        elif state == "separate":
            text += part.text
    return found


def _bookmarks(paper) -> dict[str, str]:
    """Return the text from each bookmark's start to its end, as Word takes it for a field REF."""
    found = {}
    for start in paper.element.xpath("//w:bookmarkStart"):
        name, key = (start.get(start.tag.replace("bookmarkStart", entry)) for entry in ("name", "id"))
        assert name not in found
        text = ""
        for node in start.itersiblings():
            if node.tag.endswith("bookmarkEnd") and node.get(node.tag.replace("bookmarkEnd", "id")) == key:
                break
            text += "".join(node.xpath(".//w:t/text()"))
        else:
            raise AssertionError(f"{name} does not end")
        found[name] = text
    return found


def _read_references(paper, wanted: list[str]) -> None:
    """Check the sentences of the text, and that each of their numbers is that of the caption which it names."""
    sentences = [line.text for line in paper.paragraphs if line._p.xpath(".//w:instrText[contains(., 'REF ')]")]
    assert sentences == wanted
    marks, fields = _bookmarks(paper), _fields(paper)
    references = [(code.split(), text) for code, text in fields if code.startswith("REF ")]
    assert references
    for (_, name, switch), text in references:
        assert marks[name] == text and switch == "\\h"
    kinds = [name.split("_")[-2] for (_, name, _), _ in references]
    assert kinds == sorted(kinds, reverse=True)  # tables, then figures
    for kind in ("Table", "Figure"):
        counted = [text for code, text in fields if code.startswith(f"SEQ {kind} ")]
        assert counted == [str(number + 1) for number in range(len(counted))]
        assert len(counted) == sum(f"_{kind}_" in name for name in marks)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("blocks", "wanted", "japanese"),
    [
        (("table",), "In this section: Table 1.", "この章：表 1。"),
        (("figure", "table"), "In this section: Table 1, Figure 1.", "この章：表 1、図 1。"),
        (
            ("table",) * 2 + ("figure",) * 4,
            "In this section: Tables 1 and 2, Figures 1 to 4.",
            "この章：表 1 と 2、図 1～4。",
        ),
        (("figure",) * 2, "In this section: Figures 1 and 2.", "この章：図 1 と 2。"),
        (("table",) * 12, "In this section: Tables 1 to 12.", "この章：表 1～12。"),
    ],
)
@pytest.mark.parametrize("language", ["en", "ja"])
def test_word_names_the_tables_and_figures_of_a_section_by_fields(blocks, wanted, japanese, language):
    drawing = Drawing("section", "Chapter", SVG, SVG)
    parts = tuple(_table() if kind == "table" else drawing for kind in blocks)
    sections = (Chapter("all", "All", parts), Chapter("text", "Text", (Paragraph("no caption here"),)))
    document = Document("A title", "", "converged", "", sections, language=language)
    paper = docx.Document(io.BytesIO(render_docx(document)))
    _read_references(paper, [wanted if language == "en" else japanese])
    heading = next(place for place, line in enumerate(paper.paragraphs) if line.style.name == "Heading 1")
    assert paper.paragraphs[heading + 1].text.startswith("In this section" if language == "en" else "この章")


@pytest.mark.slow
def test_word_goes_on_counting_where_a_template_has_captions_or_no_style_for_them(tmp_path):
    first = Document("A title", "", "converged", "", (Chapter("all", "All", (_table(), _table())),))
    (tmp_path / "office.docx").write_bytes(render_docx(first))
    again = docx.Document(io.BytesIO(render_docx(_document(), tmp_path / "office.docx")))
    _read_references(again, ["In this section: Tables 1 and 2.", "In this section: Tables 3 and 4, Figures 1 and 2."])
    ids = again.element.xpath("//w:bookmarkStart/@w:id")
    assert len(ids) == len(set(ids)) == 6
    bare = docx.Document()
    caption = bare.styles["Caption"].element
    caption.getparent().remove(caption)
    bare.save(tmp_path / "bare.docx")
    paper = docx.Document(io.BytesIO(render_docx(_document(), tmp_path / "bare.docx")))
    _read_references(paper, ["In this section: Tables 1 and 2, Figures 1 and 2."])


def test_word_takes_the_styles_of_a_template(tmp_path):
    office = docx.Document()
    office.add_paragraph("Letterhead of the office")
    office.styles["Heading 1"].font.name = "Courier New"
    office.save(tmp_path / "office.docx")
    paper = docx.Document(io.BytesIO(render_docx(_document(), tmp_path / "office.docx")))
    assert paper.paragraphs[0].text == "Letterhead of the office"
    assert paper.styles["Heading 1"].font.name == "Courier New"
    (tmp_path / "bad.docx").write_text("no zip", encoding="utf-8")
    with pytest.raises(InputError, match="cannot be read as DOCX"):
        render_docx(_document(), tmp_path / "bad.docx")


def test_word_stands_on_a4_and_nothing_is_wider_than_the_text():
    """Programs other than Word take the widths of the file: columns of one breadth broke numbers and wasted pages."""
    paper = docx.Document(io.BytesIO(render_docx(_document())))
    page = paper.sections[-1]
    room = page.page_width - page.left_margin - page.right_margin
    assert (round(page.page_width.cm, 1), round(page.page_height.cm, 1)) == (21.0, 29.7)
    assert all(shape.width <= room for shape in paper.inline_shapes)
    for grid in paper.tables:
        widths = [column.width for column in grid.columns]
        assert sum(widths) <= room + len(widths)  # each is rounded
        assert [cell.width for cell in grid.rows[-1].cells] == widths
        assert all(row._tr.xpath("w:trPr/w:cantSplit") for row in grid.rows)


def test_word_keeps_to_the_page_of_a_template(tmp_path):
    office = docx.Document()
    page = office.sections[0]
    page.page_width, page.left_margin, page.right_margin = Cm(14.8), Cm(2.0), Cm(2.0)  # A5
    office.save(tmp_path / "office.docx")
    paper = docx.Document(io.BytesIO(render_docx(_document(), tmp_path / "office.docx")))
    assert paper.sections[-1].page_width.cm == pytest.approx(14.8, abs=0.01)
    assert max(shape.width.cm for shape in paper.inline_shapes) == pytest.approx(10.8, abs=0.01)
    assert all(sum(column.width.cm for column in grid.columns) < 10.9 for grid in paper.tables)


@pytest.mark.parametrize(
    ("columns", "wide"),
    [
        ((("a",), ("0.000123",), ("a long text in which many words stand side by side",)), 2),
        ((("索",), ("0.000123",), ("多くの語からなる長い文章は幅の大部分を占める",)), 2),
        ((("unbreakable_name_of_a_key_of_the_file",), ("two words",)), 0),
    ],
)
def test_columns_take_the_width_of_what_they_hold(columns, wide):
    shares = column_shares(columns)
    assert sum(shares) == pytest.approx(1.0)
    assert max(shares) == shares[wide]
    letters = 100.0 * np.array(shares)  # of small print on a line of 16 cm
    needed = [min(len(text) for text in column) if len(column[0].split()) == 1 else 1 for column in columns]
    assert all(letters >= needed)


def test_short_japanese_columns_do_not_stand_on_end():
    """Japanese breaks anywhere, so that no word keeps a column broad: one letter a line was left."""
    shares = column_shares([["支配要因", "衝撃"], *([["単位", "0.000"]] * 12)])
    assert shares[0] >= 8 / 13 / 12


def test_marks_between_label_and_text_are_those_of_the_language():
    document = _document()
    for language, colon, stop in (("en", "Warning: ", "Design: Holds. all"), ("ja", "警告：", "設計：満足する。")):
        paper = docx.Document(io.BytesIO(render_docx(replace(document, language=language))))
        texts = [line.text for line in paper.paragraphs]
        assert any(text.startswith(colon) for text in texts)
        assert any(text.startswith(stop) for text in texts), texts


def test_sheets_print_on_one_page_across_with_their_heads():
    book = _read(_document())
    for sheet in book.worksheets:
        assert sheet.page_setup.orientation == "landscape" and str(sheet.page_setup.paperSize) == "9"
        assert sheet.sheet_properties.pageSetUpPr.fitToPage
        assert int(sheet.page_setup.fitToHeight) == 0
    assert book.worksheets[1].print_title_rows == "$1:$1"


@pytest.mark.parametrize(("detail", "lines"), [("short", 1), ("a word " * 40, 4), ("長い説明" * 30, 3)])
def test_rows_of_the_summary_are_as_high_as_their_text(detail, lines):
    """LibreOffice keeps the height of one line where the file names none, and texts lay over each other."""
    blocks = (KeyFigures((KeyFigure("largest tension", "12.3 kN", detail.strip()),)),)
    document = Document("t", "s", "converged", "", (Chapter("all", "All", blocks),), {})
    sheet = _read(document).worksheets[0]
    row = next(cell.row for cell in sheet["A"] if cell.value == "Largest tension")
    assert (sheet.row_dimensions[row].height or 15.0) == 15.0 * lines


@pytest.mark.slow
def test_the_report_is_written_again_from_the_results(tmp_path):
    runner = CliRunner()
    case = tmp_path / "member.yaml"
    assert runner.invoke(app, ["new", "member", "-o", str(case)]).exit_code == 0
    text, storms = re.subn(r"(?ms)^  - name: storm.*?(?=^(#|structure:))", "", case.read_text(encoding="utf-8"))
    assert storms == 1
    case.write_text(text, encoding="utf-8")
    assert runner.invoke(app, ["run", str(case), "-o", str(tmp_path / "run"), "-q"]).exit_code == 0
    first = (tmp_path / "run" / "report.html").read_text(encoding="utf-8")
    done = runner.invoke(app, ["report", str(tmp_path / "run" / "results.nc"), "-o", str(tmp_path / "again"), "--docx"])
    assert done.exit_code == 0, done.output
    assert (tmp_path / "again" / "report.html").read_text(encoding="utf-8") == first
    book = openpyxl.load_workbook(tmp_path / "again" / "report.xlsx")
    shown = {row[0]: row for row in book["Summary"].iter_rows(values_only=True) if row[0]}
    start = list(shown).index("Governing number")
    assert sum(isinstance(row[1], float | int) for row in list(shown.values())[start:]) >= 3
    heads, *rows = book["Identity checks"].iter_rows(values_only=True)
    for label in ("Violation", "Tolerance"):
        values = [row[heads.index(label)] for row in rows if row[0] and row[1]]
        assert values and all(isinstance(value, float | int) or value in ("inf", "no figure") for value in values)
    tables = list((tmp_path / "again" / "report_tables").glob("*.csv"))
    assert len(book.sheetnames) > len(tables) and (tmp_path / "again" / "report.docx").exists()
    assert runner.invoke(app, ["report", str(tmp_path / "none.nc")]).exit_code == 2


def test_numbers_of_rows_are_numbers_and_names_are_not() -> None:
    """Of modes, units and cases; a column with one word in it, or with zeros in front, holds names."""
    table = Table("modes", "Modes", (Column("Mode", ["1", "2", "10"]), Column("Unit", ["1", "2", "all"]),
                                     Column("Deck", ["01", "02", "03"])))  # fmt: skip
    sheet = _read(Document("t", "", "converged", "", (Chapter("one", "One", (table,)),)))["Modes"]
    rows = [[cell.value for cell in row] for row in sheet.iter_rows(min_row=2, max_row=4)]
    assert [row[0] for row in rows] == [1, 2, 10]
    assert [row[1] for row in rows] == ["1", "2", "all"]
    assert [row[2] for row in rows] == ["01", "02", "03"]
