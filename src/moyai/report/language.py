"""A document in the language of its reader: its texts translated, its data, keys and the reader's own words kept."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from dataclasses import fields, is_dataclass, replace
from functools import partial, wraps
from html import escape, unescape
from typing import Any, TypeVar

from moyai.language import said, spoken_in, spoken_language
from moyai.report.document import (
    Abscissa,
    Animation,
    Badge,
    Chapter,
    Choice,
    Column,
    Distance,
    Document,
    Drawing,
    Figure,
    KeyFigure,
    Listing,
    Mark,
    Option,
    Panel,
    Paragraph,
    Series,
    Table,
    Words,
)
from moyai.report.systems import displayed_in, words_in_system

_T = TypeVar("_T")
_R = TypeVar("_R")
_TEXTS: dict[type, tuple[str, ...]] = {
    Document: ("subtitle", "message"),
    Chapter: ("title",),
    Badge: ("label", "word", "message"),
    Figure: ("title", "caption", "hint"),
    Abscissa: ("label",),
    Panel: ("label",),
    Series: ("label", "belongs_to"),
    Mark: ("label",),
    Table: ("title", "note"),
    Column: ("label",),
    KeyFigure: ("label", "text", "detail"),
    Paragraph: ("text",),
    Listing: ("title",),
    Drawing: ("title", "caption"),
    Words: ("text",),
    Distance: ("text",),
    Animation: ("title", "caption"),
    Choice: ("label",),
    Option: ("label",),
}
"""Texts of each record that a person reads. The title of a report is the user's own; notices are read in English first,
for their places, and translated by :func:`moyai.report.html.notice_items`."""
_OF_LINKS = {"open": "open the report"}
"""What a word means in a cell that leads somewhere; elsewhere a statement is open."""
_SCENE_TEXTS = ("name", "names", "label", "title", "words")
_SVG_TEXT = re.compile(r"(<(?:text|title|tspan)\b[^>]*>)([^<]+)(?=<)")


def with_label(label: str, text: str) -> str:
    """Return ``label: text``, both in the language in force, with the colon of that language."""
    mark = "：" if spoken_language() == "ja" else ": "
    return f"{label}{mark}{text}" if label else text


def stop() -> str:
    """Return the full stop between two sentences in the language in force."""
    return "。" if spoken_language() == "ja" else ". "


def for_its_reader(render: Callable[..., _R]) -> Callable[..., _R]:
    """Return a function of a document that shows it in the units and in the language that the document names."""

    @wraps(render)
    def rendered(document: Document, *arguments: Any, **options: Any) -> _R:
        with displayed_in(document.units), spoken_in(document.language):
            return render(in_the_language(document), *arguments, **options)

    return rendered


def in_the_language(item: _T) -> _T:
    """Return a document or a part of it with its texts in the language in force.

    Parameters
    ----------
    item : dataclass
        :class:`~moyai.report.document.Document` or what it holds.
    """
    if spoken_language() == "en":
        return item
    found: _T = _changed(item, said, _translated)
    return found


def with_words_in_system(document: Document) -> Document:
    """Return a document whose texts have their forces in the system of units that is shown; the case stays.

    Parameters
    ----------
    document : Document
        Its badges and governing numbers have them already.
    """
    found: Document = _changed(document, words_in_system, lambda item: item)
    return found


def _translated(item: Any) -> Any:
    """Return what is more than texts: cells that lead somewhere, and animations."""
    if isinstance(item, Column) and item.links:
        return replace(item, values=[_OF_LINKS.get(value, value) for value in item.values])  # type: ignore[arg-type]
    if isinstance(item, Animation):
        return replace(item, scene=_scene(item.scene), picture=partial(_still, item.picture, spoken_language()))
    return item


def _changed(item: Any, change: Callable[[str], str], further: Callable[[Any], Any]) -> Any:
    if isinstance(item, tuple):
        return tuple(_changed(entry, change, further) for entry in item)
    if not is_dataclass(item) or isinstance(item, type):
        return item
    item = further(item)
    changes: dict[str, Any] = {name: change(getattr(item, name)) for name in _TEXTS.get(type(item), ())}
    for entry in fields(item):
        value = getattr(item, entry.name)
        if entry.name not in changes and isinstance(value, tuple) and value and is_dataclass(value[0]):
            changes[entry.name] = _changed(value, change, further)
    if isinstance(item, Column):
        changes["values"] = [change(value) if isinstance(value, str) else value for value in item.values]
    elif isinstance(item, Figure):
        changes["categories"] = tuple(map(change, item.categories))
    elif isinstance(item, Drawing):
        changes |= {"svg": _svg(item.svg, change), "fixed_svg": _svg(item.fixed_svg, change)}
    return replace(item, **changes)


def _still(picture: str | Callable[[], str], language: str) -> str:
    with spoken_in(language):
        return _svg(picture if isinstance(picture, str) else picture(), said)


def _svg(text: str, change: Callable[[str], str]) -> str:
    return _SVG_TEXT.sub(lambda match: match[1] + escape(change(unescape(match[2])), quote=False), text)


def _named(value: Any) -> Any:
    if isinstance(value, list | tuple):
        return [_named(entry) for entry in value]
    return said(value) if isinstance(value, str) else _scene(value)


def _scene(value: Any) -> Any:
    """Return a scene with its names and labels translated, wherever they stand."""
    if isinstance(value, Mapping):
        return {key: _named(entry) if key in _SCENE_TEXTS else _scene(entry) for key, entry in value.items()}
    return [_scene(entry) for entry in value] if isinstance(value, list | tuple) else value
