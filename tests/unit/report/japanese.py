"""Holds a report in Japanese against the same in English."""

from __future__ import annotations

import re
import warnings
from collections.abc import Collection, Iterator
from dataclasses import fields, is_dataclass
from html import unescape
from typing import Any

from moyai.core.results import Result
from moyai.language import spoken_in
from moyai.language.words import latin_words, numbers
from moyai.report.document import Document, Figure, Listing, NoticeBlock, Table
from moyai.report.figures_static import draw_figure
from moyai.report.html import notice_items
from moyai.report.language import in_the_language
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


def compared(result: Result) -> tuple[list[str], int]:
    """Return the English words left in the report of a result in Japanese, with the texts they stand in, and its texts.

    Words of the case file are the reader's own. Every number has to stand in both languages.
    """
    own = set(latin_words(str(result.tree.attrs.get("case_text", "")).replace("_", " ").replace(":", " ")))
    return compared_document(compose_document(result, language="ja"), own)


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


def drawn_without_boxes(result: Result, most: int = 3) -> int:
    """Draw figures of a report in Japanese; a letter that the fonts do not have is an error."""
    document = compose_document(result, language="ja")
    figures = [block for block in document.blocks() if isinstance(block, Figure)][:most]
    with spoken_in("ja"), warnings.catch_warnings():
        warnings.simplefilter("error")
        for figure in figures:
            assert draw_figure(in_the_language(figure), image_format="png").startswith(b"\x89PNG")
    return len(figures)
