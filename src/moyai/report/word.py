"""Write a document as a Word document (DOCX): text, tables and captions by the styles of a template, figures as images.

Captions are counted by fields ``SEQ`` whose numbers are bookmarks; below the heading of each section a sentence names
its tables and figures by fields ``REF``, so that Word numbers both again when text is added (Ctrl+A, F9).

The styles are those of Word by their English names (``Heading 1``, ``Table Grid``, ``Caption``), so that the template
of an office gives fonts, heads and feet.
"""

from __future__ import annotations

import io
import re
import tempfile
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from moyai.core.errors import InputError
from moyai.language import said
from moyai.language.words import breadth
from moyai.report.document import (
    Animation,
    Block,
    Choice,
    Document,
    Drawing,
    Figure,
    KeyFigures,
    Listing,
    NoticeBlock,
    Paragraph,
    Table,
)
from moyai.report.encoding import column_unit
from moyai.report.figures_static import draw_figure
from moyai.report.fonts import font_folders
from moyai.report.formatting import pretty_unit
from moyai.report.html import badges_of, column_texts, foot_text, is_text_column, notice_items
from moyai.report.language import for_its_reader, stop, with_label

#: What captions count, in the order in which a section names them.
KINDS = ("Table", "Figure")
PAGE, MARGIN = (21.0, 29.7), 2.5  # A4 and its margins [cm], where no template gives a page
WIDTH = PAGE[0] - 2 * MARGIN  # of images and tables [cm], where the page of the template is no narrower
_SHORT_LINE, _LONG_LINE = 10, 60  # letters of a cell that are not broken, that count for the width of its column
_JAPANESE_FACE = "Yu Gothic"
_DOTS = 160  # per inch
_WORD = re.compile("[^\\s\u3000-\u30ff\u4e00-\u9fff\uff00-\uffef]+")  # what does not break over lines


@for_its_reader
def render_docx(document: Document, template: Path | None = None) -> bytes:
    """Return the report as DOCX.

    Parameters
    ----------
    document : Document
        Of choices marked so, the default alone is written, with a line that says it.
    template : Path, optional
        A DOCX whose styles, page, heads and feet are taken; its text stays in front. Word's own when left out.

    Returns
    -------
    bytes

    Raises
    ------
    InputError
        When python-docx is not installed, or the template cannot be read.
    """
    try:
        import docx
    except ImportError:
        raise InputError(
            "Word documents need the package python-docx", path="--docx", remedy='pip install "moyai[docx]"'
        ) from None
    if template is not None and not template.is_file():
        raise InputError(f"no such file: {template}", path="--template")
    try:
        paper = docx.Document(None if template is None else str(template))
    except Exception as error:
        # python-docx raises what its zip and XML readers raise
        raise InputError(f"{template} cannot be read as DOCX: {error}", path="--template") from None
    if template is None:
        _set_page(paper)
    _WordWriter(paper).write(document)
    stream = io.BytesIO()
    paper.save(stream)
    return stream.getvalue()


class _WordWriter:
    """Writes blocks one below the other; counts figures and tables, from those of the template on."""

    def __init__(self, paper: Any) -> None:
        from docx.shared import Cm

        self._paper = paper
        self._known = {style.name for style in paper.styles}
        codes = paper.element.xpath("//w:instrText/text() | //w:fldSimple/@w:instr")
        self._count = {kind: sum(f"SEQ {kind} " in f"{code} " for code in codes) for kind in KINDS}
        page = paper.sections[-1]
        self._width = min(WIDTH, (page.page_width - page.left_margin - page.right_margin) / Cm(1))
        self._marks = max((int(mark) for mark in paper.element.xpath("//w:bookmarkStart/@w:id")), default=0)

    def write(self, document: Document) -> None:
        """Write title, badges, sections and foot."""
        paper = self._paper
        if document.language == "ja":
            _name_japanese_face(paper)
        paper.core_properties.title = document.title
        self._text(document.title, "Title")
        if document.subtitle:
            self._text(document.subtitle, "Subtitle")
        for badge in badges_of(document):
            line = paper.add_paragraph()
            line.add_run(with_label(badge.label, badge.word)).bold = True
            line.add_run(f"{stop()}{badge.message}" if badge.message else "")
        _field(paper.add_paragraph(), r'TOC \o "1-2" \h', said("Contents: press F9 to fill in"))
        for section in document.sections:
            self._heading(section.title, 1)
            line, before = self._text(""), dict(self._count)
            for block in section.blocks:
                self._block(block, 2)
            self._references(line, before)
        self._text(foot_text(document))

    def _text(self, text: str, style: str = "") -> Any:
        return self._paper.add_paragraph(text, style=style if style in self._known else None)

    def _heading(self, text: str, level: int) -> None:
        name = f"Heading {level}"
        line = self._text(text, name)
        if name not in self._known:
            line.runs[0].bold = True

    def _block(self, block: Block, level: int) -> None:
        match block:
            case Figure():
                self._picture(block.title, block.caption, draw_figure(block, image_format="png", width=WIDTH,
                                                                      dots_per_inch=_DOTS))  # fmt: skip
            case Drawing():
                self._picture(block.title, block.caption, _rasterised(block.fixed_svg))
            case Animation():
                if block.still:
                    self._picture(
                        with_label(block.title, said("the governing moment")), block.caption, _rasterised(block.still)
                    )
            case Table():
                self._table(block)
            case KeyFigures():
                rows = [(item.label[:1].upper() + item.label[1:], item.text, item.detail) for item in block.items]
                self._grid((tuple(map(said, ("Governing number", "Value", "Where, model and band"))), *rows))
            case Paragraph():
                self._text(block.text)
            case Listing():
                self._heading(block.title, min(level, 4))
                self._listing(block.text)
            case NoticeBlock():
                for severity, first, second in notice_items(block):
                    line = self._paper.add_paragraph()
                    line.add_run(with_label(said(severity.capitalize()), "")).bold = True
                    line.add_run(f"{first}{stop()}{second}".strip())
            case Choice():
                self._choice(block, level)

    def _choice(self, choice: Choice, level: int) -> None:
        several = len(choice.options) > 1
        options = choice.options if choice.print_all or not several else (choice.options[choice.default],)
        for option in options:
            if several:
                self._heading(with_label(choice.label, option.label), min(level, 4))
            for block in option.blocks:
                self._block(block, level + several)
        if len(options) < len(choice.options):
            others = ", ".join(option.label for option in choice.options if option is not options[0])
            self._text(said(f"Also in the interactive report: {others}."))

    def _caption(self, kind: str, text: str, keep: bool = False) -> None:
        """Write a caption with a number given by Word; the number is a bookmark."""
        from docx.oxml import OxmlElement
        from docx.oxml.ns import qn

        self._count[kind] += 1
        self._marks += 1
        line = self._text(f"{said(kind)} ", "Caption")
        line.paragraph_format.keep_with_next = keep
        start, end = OxmlElement("w:bookmarkStart"), OxmlElement("w:bookmarkEnd")
        start.set(qn("w:name"), _mark(kind, self._count[kind]))
        for element in (start, end):
            element.set(qn("w:id"), str(self._marks))
        line._p.append(start)
        _field(line, f"SEQ {kind} \\* ARABIC", str(self._count[kind]))
        line._p.append(end)
        line.add_run(f". {text}")

    def _references(self, line: Any, before: dict[str, int]) -> None:
        """Name the captions since ``before`` in an empty paragraph, or take it away where there is none."""
        named = [(kind, before[kind] + 1, self._count[kind]) for kind in KINDS if self._count[kind] > before[kind]]
        if not named:
            line._p.getparent().remove(line._p)
            return
        marks = [_mark(kind, number) for kind, first, last in named for number in dict.fromkeys((first, last))]
        sentence = said(f"In this section: {', '.join(_counted(*item) for item in named)}.")
        line.paragraph_format.keep_with_next = True
        for part in re.split(r"(\d+)", sentence):
            if part.isdecimal():
                _field(line, f"REF {marks.pop(0)} \\h", part)
            else:
                line.add_run(part)

    def _picture(self, title: str, caption: str, image: bytes) -> None:
        from docx.shared import Cm

        self._paper.add_picture(io.BytesIO(image), width=Cm(self._width))
        self._paper.paragraphs[-1].paragraph_format.keep_with_next = True
        self._caption("Figure", f"{title}{stop()}{caption}" if caption else title)

    def _table(self, table: Table) -> None:
        self._caption("Table", table.title, keep=True)
        units = [pretty_unit(column_unit(column).name) for column in table.columns]
        heads = [f"{column.label} [{unit}]" if unit else column.label for column, unit in zip(table.columns, units)]
        texts = [column_texts(column) for column in table.columns]
        textual = [is_text_column(column) for column in table.columns]
        self._grid((heads, *zip(*texts, strict=True)), right=[not text for text in textual], bold=table.emphasised)
        if table.note:
            self._text(table.note)

    def _grid(self, rows: Any, *, right: Any = (), bold: tuple[int, ...] = ()) -> None:
        """Write rows of texts, the first as heads that stand on every page; no row breaks over a page."""
        from docx.enum.text import WD_ALIGN_PARAGRAPH
        from docx.oxml import OxmlElement
        from docx.shared import Cm, Pt

        size = Pt(8.5 if len(rows[0]) < 8 else 6.5)
        grid = self._paper.add_table(rows=len(rows), cols=len(rows[0]))
        if "Table Grid" in self._known:
            grid.style = "Table Grid"
        # Word fits columns to what they hold; other programs take the widths of the file
        widths = [Cm(self._width * share) for share in column_shares(list(zip(*rows, strict=True)))]
        for column, width in zip(grid.columns, widths, strict=True):
            column.width = width
        for number, (texts, row) in enumerate(zip(rows, grid.rows)):
            row._tr.get_or_add_trPr().append(OxmlElement("w:cantSplit"))
            for column, (text, cell) in enumerate(zip(texts, row.cells)):
                cell.width = widths[column]
                line = cell.paragraphs[0]
                line.paragraph_format.space_after = Pt(0)
                run = line.add_run(text)
                run.font.size = size
                run.bold = number == 0 or number - 1 in bold
                if number > 0 and right and right[column]:
                    line.alignment = WD_ALIGN_PARAGRAPH.RIGHT
        grid.rows[0]._tr.get_or_add_trPr().append(OxmlElement("w:tblHeader"))
        self._paper.add_paragraph()

    def _listing(self, text: str) -> None:
        from docx.shared import Pt

        line = self._paper.add_paragraph()
        run = line.add_run(text)
        run.font.name, run.font.size = "Consolas", Pt(7.5)


def column_shares(columns: Sequence[Sequence[str]]) -> list[float]:
    """Return the share of the width that each column takes: its longest word at least, the rest by its longest text.

    Parameters
    ----------
    columns : sequence of sequences of str
        Texts of each column, its head included; a letter of Japanese counts as two and may break anywhere.
    """
    words = [max((breadth(word) for text in column for word in _WORD.findall(text)), default=1) for column in columns]
    texts = [min(max(map(breadth, column), default=1), _LONG_LINE) for column in columns]
    least = [min(max(word, _SHORT_LINE), text) + 2 for word, text in zip(words, texts, strict=True)]
    wanted = [max(text + 2, low) for text, low in zip(texts, least, strict=True)]
    room = max(_LONG_LINE + 20.0, float(sum(least)))
    spare, asked = room - sum(least), sum(wanted) - sum(least)
    taken = [low + (want - low) * (min(spare / asked, 1.0) if asked else 0.0) for low, want in zip(least, wanted)]
    total = max(sum(taken), sum(least))
    return [width / total for width in taken]


def _set_page(paper: Any) -> None:
    """Give a document of python-docx, which is on US Letter, a page of A4."""
    from docx.shared import Cm

    for section in paper.sections:
        section.page_width, section.page_height = map(Cm, PAGE)
        section.left_margin = section.right_margin = section.top_margin = section.bottom_margin = Cm(MARGIN)


def _mark(kind: str, number: int) -> str:
    """Return the name of the bookmark of a caption's number; Word hides names that begin with an underscore."""
    return f"_Ref_moyai_{kind}_{number}"


def _counted(kind: str, first: int, last: int) -> str:
    """Return ``Table 3``, ``Tables 3 and 4`` or ``Tables 3 to 6``."""
    if first == last:
        return f"{kind} {first}"
    return f"{kind}s {first} {'and' if last == first + 1 else 'to'} {last}"


def _field(paragraph: Any, code: str, shown: str) -> None:
    """Append a field that Word updates, with what it shows until then."""
    from docx.oxml import OxmlElement
    from docx.oxml.ns import qn

    def part(kind: str) -> Any:
        mark = OxmlElement("w:fldChar")
        mark.set(qn("w:fldCharType"), kind)
        return mark

    instruction = OxmlElement("w:instrText")
    instruction.set(qn("xml:space"), "preserve")
    instruction.text = f" {code} "
    for element in (part("begin"), instruction, part("separate")):
        paragraph.add_run()._r.append(element)
    paragraph.add_run(shown)
    paragraph.add_run()._r.append(part("end"))


def _name_japanese_face(paper: Any) -> None:
    """Name the face of Japanese letters where the template names none; a reader without it takes another."""
    from docx.oxml.ns import qn

    fonts = paper.styles["Normal"].element.get_or_add_rPr().get_or_add_rFonts()
    if fonts.get(qn("w:eastAsia")) is None:
        fonts.set(qn("w:eastAsia"), _JAPANESE_FACE)


def _rasterised(svg: str) -> bytes:
    """Return a drawing as PNG."""
    import typst

    with tempfile.TemporaryDirectory(prefix="moyai-report-") as name:
        folder = Path(name)
        (folder / "drawing.svg").write_text(svg, encoding="utf-8")
        (folder / "drawing.typ").write_text(
            f'#set page(width: auto, height: auto, margin: 0pt)\n#image("drawing.svg", width: {WIDTH}cm)\n',
            encoding="utf-8",
        )
        found = typst.compile(
            str(folder / "drawing.typ"), root=name, format="png", ppi=float(_DOTS), font_paths=font_folders()
        )
        return bytes(found if isinstance(found, bytes) else found[0])
