"""Write a document as a workbook (XLSX): first page, tables and data of figures, a sheet each, numbers as numbers."""

from __future__ import annotations

import io
import math
import re
from collections.abc import Sequence
from dataclasses import replace
from functools import cache
from typing import TYPE_CHECKING, Any

import numpy as np

from moyai.core.arrays import Array
from moyai.language import said, spoken_in, spoken_language
from moyai.language.words import breadth
from moyai.report.decimate import envelope_indices
from moyai.report.document import Block, Cell, Choice, Column, Document, Figure, KeyFigures, Listing, NoticeBlock, Table
from moyai.report.encoding import column_unit, figure_columns, scaled_cell
from moyai.report.formatting import axis_label, read_quantity
from moyai.report.html import badges_of, foot_text, notice_items
from moyai.report.language import for_its_reader, with_label
from moyai.report.systems import UNITS_NOTES

if TYPE_CHECKING:
    from xlsxwriter.format import Format
    from xlsxwriter.worksheet import Worksheet

#: Characters of the name of a sheet, and rows of a sheet, at most
NAME, ROWS = 31, 1_048_576
#: Samples of a series, beyond which extremes alone are written: at most, at least where there are many
LONGEST, SHORTEST = 2000, 400
_COUNT = re.compile("0|[1-9][0-9]{0,8}")
#: Numbers of figures, about, beyond which series are shortened: a workbook takes 3 us a number to write
NUMBERS = 100_000
#: Words with which the name of a sheet does not end
_HANGING = frozenset(("a", "an", "and", "at", "by", "for", "from", "in", "of", "on", "or", "over", "the", "to", "with"))
_WIDEST, _NUMBER = 60, 12  # characters of a column at most, of a number
_A4 = 9  # paper of XLSX
_WIDTHS = (42, 24, 10, 10, 90)  # of the columns of the summary, in characters
_DETAIL = 4  # its column of the longest texts
_LINE = 15.0  # height of a line [pt]


@for_its_reader
def render_workbook(document: Document) -> bytes:
    """Return the report as XLSX.

    Parameters
    ----------
    document : Document

    Returns
    -------
    bytes
        First the sheet ``Summary`` with the governing numbers, the notices and links to all others; then the tables in
        the units that the page shows, the data of the figures, and the case. What is not known is an empty cell.
    """
    from xlsxwriter import Workbook

    stream = io.BytesIO()
    options = {"in_memory": True, "strings_to_formulas": False, "strings_to_urls": False, "strings_to_numbers": False}
    with Workbook(stream, options) as book:
        book.set_properties({"title": document.title, "comments": foot_text(document)})
        _Book(book, document).write()
    return stream.getvalue()


class _Book:
    """The sheets of a document."""

    def __init__(self, book: Any, document: Document) -> None:
        self._book, self._document = book, document
        self._bold = book.add_format({"bold": True, "valign": "top"})
        self._title = book.add_format({"bold": True, "font_size": 14})
        self._head = book.add_format({"bold": True, "bottom": 1, "text_wrap": True, "valign": "top"})
        self._wrapped = book.add_format({"text_wrap": True, "valign": "top"})
        self._top = book.add_format({"valign": "top"})
        self._quiet = book.add_format({"font_color": "#666666"})
        self._row = {
            "emphasised": book.add_format({"bold": True}),
            "failed": book.add_format({"font_color": "#B00020"}),
        }
        self._used: set[str] = set()
        self._sheets: list[tuple[str, str]] = []
        figures = [block for block in document.blocks() if isinstance(block, Figure)]
        numbers = sum(min(len(item.y), LONGEST) for figure in figures for item in figure.series)
        self._longest = max(min(LONGEST, LONGEST * NUMBERS // max(numbers, 1)), SHORTEST)

    def write(self) -> None:
        """Write every sheet, the summary as the first."""
        summary = self._sheet(said("Summary"), "")
        for section in self._document.sections:
            for block in section.blocks:
                self._block(block, section.title)
        self._summary(summary)

    def _sheet(self, title: str, listed: str) -> Worksheet:
        """Return a new sheet with a name that no other has, listed in the summary under a text."""
        plain = " ".join(re.sub(r"[\[\]:*?/\\]", " ", title).split()).strip("'") or "sheet"
        name, count = _shortened(plain, NAME), 2
        while name.lower() in self._used or name.lower() == "history":
            end = f" {count}"
            name, count = _shortened(plain, NAME - len(end)) + end, count + 1
        self._used.add(name.lower())
        if listed:
            self._sheets.append((name, listed))
        sheet = self._book.add_worksheet(name)
        sheet.set_landscape()
        sheet.set_paper(_A4)
        sheet.fit_to_pages(1, 0)  # as wide as a page, as long as it is
        return sheet

    def _block(self, block: Block, place: str) -> None:
        match block:
            case Table():
                self._table(block, place)
            case Figure():
                self._figure(block, place)
            case Listing():
                sheet = self._sheet(block.title, with_label(place, block.title))
                sheet.set_column(0, 0, 120)
                for number, line in enumerate(block.text.splitlines()[:ROWS]):
                    sheet.write_string(number, 0, line)
            case Choice():
                several = len(block.options) > 1
                for option in block.options:
                    for item in option.blocks:
                        self._block(item, f"{place}, {option.label}" if several else place)

    def _table(self, table: Table, place: str) -> None:
        sheet = self._sheet(table.title, with_label(place, table.title))
        marks = dict.fromkeys(table.emphasised, self._row["emphasised"])
        marks |= dict.fromkeys(table.failed, self._row["failed"])
        columns: list[tuple[str, Sequence[Cell] | Array]] = []
        for column in table.columns:
            if column.quantities:
                columns += _parted(column)
                continue
            unit = column_unit(column)
            values = _counted([_scaled(value, unit.factor) for value in column.values])
            columns.append((axis_label(column.label, unit.name), values))
        self._columns(sheet, columns, marks)
        if table.note:
            sheet.write_string(table.row_count + 2, 0, table.note, self._quiet)

    def _figure(self, figure: Figure, place: str) -> None:
        thinned, words = _thinned(figure, self._longest)
        sheet = self._sheet(figure.title, with_label(place, f"{said('data of the figure')} '{figure.title}'{words}"))
        self._columns(sheet, figure_columns(thinned), {})

    def _columns(
        self, sheet: Worksheet, columns: Sequence[tuple[str, Sequence[Cell] | Array]], marks: dict[int, Format]
    ) -> None:
        """Write headed columns; the heads stay in sight."""
        sheet.freeze_panes(1, 0)
        sheet.repeat_rows(0)
        # numbers that are texts among other texts are names and versions
        sheet.ignore_errors({"number_stored_as_text": "A1:XFD1048576"})
        for number, (head, values) in enumerate(columns):
            sheet.write_string(0, number, head, self._head)
            widest = breadth(head) // 2
            if isinstance(values, np.ndarray) and values.dtype.kind == "f" and not marks:
                widest = max(widest, _write_numbers(sheet, number, values[: ROWS - 1]))
            else:
                for row, value in enumerate(values[: ROWS - 1]):
                    widest = max(widest, _write(sheet, row + 1, number, value, marks.get(row)))
            sheet.set_column(number, number, min(max(widest, 10) + 2, _WIDEST))

    def _summary(self, sheet: Worksheet) -> None:
        document = self._document
        for number, width in enumerate(_WIDTHS):
            sheet.set_column(number, number, width)
        sheet.write_string(0, 0, document.title, self._title)
        sheet.write_string(1, 0, document.subtitle)
        sheet.write_string(2, 0, said(UNITS_NOTES.get(document.units, "")), self._quiet)
        row = 3
        for badge in badges_of(document):
            sheet.write_string(row, 0, badge.label or said("Status"), self._top)
            sheet.write_string(row, 1, badge.word, self._bold)
            sheet.write_string(row, _DETAIL, badge.message, self._wrapped)
            _heighten(sheet, row, ("", "", "", "", badge.message))
            row += 1
        row += 1
        for block in document.blocks():
            if isinstance(block, KeyFigures):
                heads = ("Governing number", "Value", "Unit", "Bound", "Where, model and band")
                for column, head in enumerate(heads):
                    sheet.write_string(row, column, said(head), self._head)
                row += 1
                for item in block.items:
                    value, unit, bound = _quantity(item.text)
                    sheet.write_string(row, 0, item.label[:1].upper() + item.label[1:], self._top)
                    _write(sheet, row, 1, value, self._wrapped)
                    for column, text in ((2, unit), (3, bound), (_DETAIL, item.detail)):
                        _write(sheet, row, column, text, self._wrapped)
                    _heighten(sheet, row, (item.label, str(value), unit, bound, item.detail))
                    row += 1
        row += 1
        for block in document.blocks():
            if isinstance(block, NoticeBlock):
                for severity, first, second in notice_items(block):
                    sheet.write_string(row, 0, said(severity.capitalize()), self._top)
                    text = f"{first}\n{second}" if second else first
                    sheet.write_string(row, _DETAIL, text, self._wrapped)
                    _heighten(sheet, row, ("", "", "", "", text))
                    row += 1
        row += 1
        for name, listed in self._sheets:
            quoted = name.replace("'", "''")
            sheet.write_url(row, 0, f"internal:'{quoted}'!A1", string=name)
            sheet.write_string(row, _DETAIL, listed)
            row += 1
        sheet.write_string(row + 1, 0, foot_text(document), self._quiet)


def _heighten(sheet: Worksheet, row: int, texts: Sequence[str]) -> None:
    """Make a row of the summary as high as its longest text; not every program does so when it opens the file."""
    lines = [
        sum(max(math.ceil(breadth(line) / (0.95 * width)), 1) for line in text.split("\n"))
        for text, width in zip(texts, _WIDTHS, strict=True)
    ]
    if max(lines) > 1:
        sheet.set_row(row, _LINE * max(lines))


def _shortened(text: str, length: int) -> str:
    """Return the words of a text that fit into a length, none left hanging; the first may be cut."""
    if len(text) <= length:
        return text
    words = text[: length + 1].split(" ")[:-1]
    while len(words) > 1 and words[-1].lower() in _HANGING:
        words.pop()
    return (" ".join(words) or text[:length]).rstrip(" ,;:'")


def _thinned(figure: Figure, longest: int) -> tuple[Figure, str]:
    """Return a figure with long series thinned, every extreme kept, and words that say so."""
    lengths = {len(item.y) for item in figure.series if len(item.y) > longest}
    if not lengths:
        return figure, ""
    kept = {}
    for length in lengths:
        alike = np.column_stack([np.asarray(item.y, dtype=float) for item in figure.series if len(item.y) == length])
        kept[length] = envelope_indices(alike, max(longest // (2 * alike.shape[1]), 1))
    series = tuple(
        replace(
            item,
            x={key: np.asarray(values)[kept[len(item.y)]] for key, values in item.x.items()},
            y=np.asarray(item.y)[kept[len(item.y)]],
        )
        if len(item.y) in kept
        else item
        for item in figure.series
    )
    most = max(lengths)
    words = said(f", {len(kept[most])} of {most} samples, every extreme kept")
    return replace(figure, series=series), words


def _parted(column: Column) -> list[tuple[str, Sequence[Cell]]]:
    """Return a column of quantities as numbers, with a column of units and one of bounds where it has any."""
    values, units, bounds = zip(*map(_quantity, map(str, column.values)), strict=True)
    found = [
        (column.label, values),
        (with_label(column.label, said("unit")), units),
        (with_label(column.label, said("bound")), bounds),
    ]
    return [found[0], *(item for item in found[1:] if any(item[1]))]


def _quantity(text: str) -> tuple[Cell, str, str]:
    """Return number, unit and bound of a text in the language in force; a text that is no such quantity alone."""
    for before, after in _bounds(spoken_language()):
        if text.startswith(before) and text.endswith(after):
            found = read_quantity(text[len(before) : len(text) - len(after)].strip())
            if found is not None:
                return *found, (before + after).strip()
    return text, "", ""


@cache
def _bounds(language: str) -> tuple[tuple[str, str], ...]:
    """Return what stands before and behind a number of a bound in a language; nothing last."""
    with spoken_in(language):
        texts = [said(f"{bound} 7") for bound in ("at least", "at most")]
    return *((before, after) for before, _, after in (text.partition("7") for text in texts)), ("", "")


def _counted(values: list[Cell]) -> list[Cell]:
    """Return a column that numbers its rows (modes, units, cases) as numbers, any other as it is."""
    if values and all(isinstance(value, str) and _COUNT.fullmatch(value) for value in values):
        return [float(str(value)) for value in values]
    return values


def _scaled(value: Cell, factor: float) -> Cell:
    if isinstance(value, bool | np.bool_):
        return said("yes" if value else "no")
    return scaled_cell(value, factor)


def _write_numbers(sheet: Worksheet, column: int, values: Array) -> int:
    """Write numbers below a head; return the characters that they take."""
    put = sheet.write_number
    for row, value in enumerate(values.tolist(), start=1):
        if math.isfinite(value):
            put(row, column, value)
        else:
            _write(sheet, row, column, value, None)
    return _NUMBER


def _write(sheet: Worksheet, row: int, column: int, value: Cell, style: Format | None) -> int:
    """Write a cell; return the characters that it takes."""
    if isinstance(value, str):
        if value:
            sheet.write_string(row, column, value, style)
        return breadth(value)
    if value is None or math.isnan(value):
        return 0
    if math.isinf(value):
        sheet.write_string(row, column, "inf" if value > 0.0 else "-inf", style)
        return 4
    sheet.write_number(row, column, float(value), style)
    return _NUMBER
