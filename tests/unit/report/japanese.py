"""Holds a report in Japanese against the same in English, and looks for letters that no font has."""

from __future__ import annotations

import base64
import io
import re
import warnings
import zipfile
import zlib
from collections.abc import Collection, Iterator
from dataclasses import fields, is_dataclass, replace
from functools import cache
from html import unescape
from typing import Any
from unittest.mock import patch

from fontTools.ttLib import TTFont
from matplotlib import font_manager

from moyai.core.results import Result
from moyai.language import spoken_in
from moyai.language.words import latin_words, numbers
from moyai.report.document import Chapter, Choice, Document, Figure, Listing, NoticeBlock, Option, Table
from moyai.report.figures_static import draw_figure
from moyai.report.fonts import JAPANESE, matplotlib_families, packaged_font
from moyai.report.formatting import pretty_unit, subscripted
from moyai.report.html import notice_items, render_html
from moyai.report.language import in_the_language
from moyai.report.pdf import render_pdf
from moyai.report.word import render_docx
from moyai.report.writer import compose_document

_SVG_TEXT = re.compile(r"<(?:text|title|tspan)\b[^>]*>([^<]+)<")
_KEYS = frozenset((
    "key", "group", "anchor", "style", "dash", "tone", "severity", "units", "language", "status", "unit",
    "file", "judgement", "links", "x", "y", "svg_class",
))  # fmt: skip


def pairs(english: Any, japanese: Any, name: str = "") -> Iterator[tuple[str, str]]:
    """Yield every text of a document with that at the same place of the other."""
    if callable(english) or callable(japanese):  # pictures that are drawn when they are asked for
        english, japanese = (one() if callable(one) else one for one in (english, japanese))
    if isinstance(english, str):
        if english.startswith("<svg"):
            yield from zip(_SVG_TEXT.findall(english), _SVG_TEXT.findall(japanese), strict=True)
        elif name not in _KEYS:
            yield english, japanese
    elif isinstance(english, NoticeBlock):
        with spoken_in("ja"):
            second = notice_items(japanese)
        for one, two in zip(notice_items(english), second, strict=True):
            yield from zip(one[1:], two[1:], strict=True)
    elif isinstance(english, Listing):
        yield english.title, japanese.title
    elif isinstance(english, Table) and english.key == "provenance":
        yield from pairs(english.columns[0], japanese.columns[0])  # commands and versions are data
    elif isinstance(english, dict):
        for key, value in english.items():
            yield from pairs(value, japanese[key], "" if key in ("name", "names", "label") else "key")
    elif is_dataclass(english):
        for entry in fields(english):
            own = ("title", "provenance") if isinstance(english, Document) else ("scene_3d",)
            if entry.name not in own:
                yield from pairs(getattr(english, entry.name), getattr(japanese, entry.name), entry.name)
    elif isinstance(english, list | tuple):
        assert len(english) == len(japanese)
        for one, two in zip(english, japanese, strict=True):
            yield from pairs(one, two, name)


def compared(result: Result, file: str = "") -> tuple[list[str], int]:
    """Return the English words left in the report of a result in Japanese, with the texts they stand in, and its texts.

    Words of the case file, or of that of a study, are the reader's own. Every number has to stand in both languages.
    """
    return compared_document(compose_document(result, language="ja"), words_of(result, file))


def words_of(result: Result, file: str = "") -> set[str]:
    """Return the words of the case file of a result, and of the file of a study, as they stand and at the beginning."""
    text = f"{file}\n{result.tree.attrs.get('case_text', '')}"
    words = latin_words(text.replace("_", " ").replace(":", " "))
    return {*words, *(word[:1].upper() + word[1:] for word in words)}


def compared_document(document: Document, own: Collection[str] = ()) -> tuple[list[str], int]:
    """Return the English words left in a document in Japanese, with the texts they stand in, and its texts."""
    with spoken_in("ja"):
        shown = in_the_language(document)
    left, count = [], 0
    for english, japanese in pairs(document, shown):
        count += 1
        assert numbers(unescape(english)) == numbers(unescape(japanese)), f"{english}\n{japanese}"
        words = [word for word in latin_words(unescape(japanese)) if word not in own]
        if words:
            left.append(f"{', '.join(words)}: {english} -> {japanese}")
    return left, count


def drawn_without_boxes(document: Document, most: int = 3) -> int:
    """Draw figures of a report in Japanese; a letter that the fonts do not have is an error."""
    figures = [block for block in document.blocks() if isinstance(block, Figure)][:most]
    with spoken_in("ja"), warnings.catch_warnings():
        warnings.simplefilter("error")
        for figure in figures:
            assert draw_figure(in_the_language(figure), image_format="png").startswith(b"\x89PNG")
    return len(figures)


def without_boxes(document: Document) -> dict[str, set[str]]:
    """Return the letters of page, PDF and Word that no font of theirs has; a letter that no figure has is an error.

    One figure of each make is drawn, for the PDF; the letters of all are looked up in the faces of figures. Word has an
    empty picture in the place of each, and the first rows of each table: it is the faces of its styles that are looked
    at there, and the page holds the letters of all rows.
    """
    drawn: dict[Any, bytes] = {}

    def draw_once(figure: Figure) -> bytes:
        assert letters_missing_in_figure(figure) == set(), figure.title
        make = _make_of(figure)
        if make not in drawn:
            drawn[make] = draw_figure(figure)
        return drawn[make]

    with warnings.catch_warnings():
        warnings.simplefilter("error")
        with patch("moyai.report.pdf.draw_figure", draw_once):
            pdf = render_pdf(document)
        empty = {"draw_figure": lambda *_, **__: _EMPTY_PICTURE, "_rasterised": lambda _: _EMPTY_PICTURE}
        with patch.multiple("moyai.report.word", **empty):
            word = render_docx(_with_first_rows(document))
    return {"page": missing_in_page(render_html(document)), "PDF": missing_in_pdf(pdf), "Word": missing_in_word(word)}


def _make_of(figure: Figure) -> tuple[Any, ...]:
    """Return what decides by which ways a figure is drawn."""
    styles = frozenset((one.style, one.dash, one.faint, bool(one.belongs_to)) for one in figure.series)
    marks = frozenset((one.x is None, one.y is None) for one in figure.marks if one.known)
    panels = tuple((one.limits is None, one.from_zero) for one in figure.panels)
    return styles, marks, panels, bool(figure.categories), figure.window is None, figure.abscissae[0].log


def letters_missing_in_figure(figure: Figure) -> set[str]:
    """Return the letters of a figure on paper that no face of figures has."""
    named = [*figure.abscissae[:1], *figure.panels]
    texts = [one.label for one in (*named, *figure.series, *figure.marks)]
    texts += [pretty_unit(one.unit) for one in named] + list(figure.categories)
    return set("".join(map(subscripted, texts))) - _letters_of_figures() - {"\n"}


@cache
def _letters_of_figures() -> frozenset[str]:
    faces = (font_manager.get_font(font_manager.findfont(family)) for family in matplotlib_families())
    return frozenset(chr(code) for face in faces for code in face.get_charmap())


#: A PNG of one point.
_EMPTY_PICTURE = base64.b64decode(
    "iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAYAAAAfFcSJAAAADUlEQVR42mP8z8BQDwAEhQGAhKmMIQAAAABJRU5ErkJggg=="
)


def _with_first_rows(item: Any, most: int = 8) -> Any:
    """Return a document, or a part of it, with no more than the first rows of its tables."""
    match item:
        case tuple():
            return tuple(_with_first_rows(one, most) for one in item)
        case Document():
            return replace(item, sections=_with_first_rows(item.sections, most))
        case Chapter() | Option():
            return replace(item, blocks=_with_first_rows(item.blocks, most))
        case Choice():
            return replace(item, options=_with_first_rows(item.options, most))
        case Table():
            columns = (replace(one, values=one.values[:most], links=one.links[:most]) for one in item.columns)
            return replace(item, columns=tuple(columns))
    return item


def wide(text: str) -> set[str]:
    """Return the letters of a text for which a Japanese font is needed."""
    return {letter for letter in text if ord(letter) > 0x2E7F}


def missing_in_page(page: str) -> set[str]:
    """Return the Japanese letters of a page that are not in the font embedded in it."""
    data = re.search(r"data:font/woff;base64,([A-Za-z0-9+/=]+)", page)
    assert data, "the page brings no font"
    known = TTFont(io.BytesIO(base64.b64decode(data[1]))).getBestCmap()
    return {letter for letter in wide(page) if ord(letter) not in known}


_ESCAPES = {b"n": b"\n", b"r": b"\r", b"t": b"\t", b"b": b"\b", b"f": b"\f"}


def _unescaped(found: re.Match[bytes]) -> bytes:
    """Return the byte that an escape of a PDF string stands for."""
    code = found[1]
    return bytes([int(code, 8)]) if code.isdigit() else _ESCAPES.get(code, code)


def missing_in_pdf(pdf: bytes) -> set[str]:
    """Return the fonts of a PDF of which glyph 0, the empty box, is drawn."""
    boxes, texts = set(), 0
    for found in re.finditer(rb"stream\r?\n(.*?)\r?\nendstream", pdf, re.DOTALL):
        try:
            stream = zlib.decompress(found[1])
        except zlib.error:
            continue
        for font, shown in re.findall(rb"/(f\d+) [\d.]+ Tf(.*?)\bET\b", stream, re.DOTALL):
            for text in re.findall(rb"\(((?:\\.|[^\\()])*)\)", shown, re.DOTALL):
                codes = re.sub(rb"\\([0-7]{3}|.)", _unescaped, text, flags=re.DOTALL)
                texts += 1
                if any(codes[at : at + 2] == b"\0\0" for at in range(0, len(codes), 2)):
                    boxes.add(f"glyph 0 of {font.decode()}")
    assert texts, "the PDF holds no text"
    return boxes


def missing_in_word(word: bytes) -> set[str]:
    """Return the Japanese letters of a Word report that IPAex Gothic has not, and faces that are not Japanese."""
    file = packaged_font()
    assert file is not None
    known = TTFont(file).getBestCmap()
    with zipfile.ZipFile(io.BytesIO(word)) as parts:
        text = "".join(parts.read(name).decode("utf-8") for name in parts.namelist() if name.endswith("document.xml"))
        faces = re.findall(r'w:eastAsia="([^"]+)"', parts.read("word/styles.xml").decode("utf-8") + text)
    shown = wide(unescape("".join(re.findall(r"<w:t[^>]*>([^<]*)<", text))))
    assert shown, "the Word report holds no Japanese"
    strange = {face for face in faces if face not in JAPANESE and not re.fullmatch("[a-z]{2}-[A-Z]{2}", face)}
    return {letter for letter in shown if ord(letter) not in known} | strange
