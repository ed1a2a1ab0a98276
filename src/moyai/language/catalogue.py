"""Catalogues: message files (PO) of gettext, a folder a language, read as pairs of templates."""

from __future__ import annotations

import json
import re
from collections.abc import Iterator
from functools import cache
from importlib import resources

LANGUAGES = ("en", "ja")
"""Languages that texts can be shown in; English is that of the source."""
_PLACE = re.compile(r"\{(\d+)\}")


@cache
def catalogue(language: str) -> dict[str, str]:
    """Return the messages of a language by their English template; empty for English.

    Parameters
    ----------
    language : str
        One of :data:`LANGUAGES`.
    """
    return _messages(language, "")


@cache
def page_catalogue(language: str) -> dict[str, str]:
    """Return the words of the page of ``moyai app``: buttons and heads, which are looked up as a whole and never in
    parts of other texts.

    Parameters
    ----------
    language : str
        One of :data:`LANGUAGES`.
    """
    return _messages(language, "page")


def _messages(language: str, folder: str) -> dict[str, str]:
    if language == "en":
        return {}
    place = resources.files("moyai.language").joinpath(language, folder)
    files = (file for file in place.iterdir() if file.name.endswith(".po"))
    texts = (file.read_text(encoding="utf-8") for file in sorted(files, key=lambda file: file.name))
    return {source: target for text in texts for source, target in entries(text) if source and target}


def entries(text: str) -> Iterator[tuple[str, str]]:
    """Give the messages of a PO file with their translations, the head (an empty message) included.

    Parameters
    ----------
    text : str
        Without contexts and plural forms, which the catalogues do not have.
    """
    source = ""
    parts: list[str] = []
    for line in [*text.splitlines(), 'msgid ""']:
        keyword, quote, rest = line.partition('"')
        if line.startswith("#") or not quote:
            continue
        words = str(json.loads(quote + rest))  # the escapes of PO files are those of JSON
        if keyword.startswith("msgid"):
            if parts:
                yield source, "".join(parts[1:])
            source, parts = words, []
        elif keyword.startswith("msgstr"):
            parts = ["", words]
        elif parts:
            parts.append(words)
        else:
            source += words


def literals(template: str) -> tuple[tuple[str, ...], tuple[int, ...]]:
    """Return the fixed parts of a template and the numbers of the places between them.

    Parameters
    ----------
    template : str
        Such as ``tension of line {0}: {1}``.

    Returns
    -------
    tuple of str
        One more than there are places; empty where two places touch or one stands at an end.
    tuple of int
    """
    pieces = _PLACE.split(template)
    return tuple(pieces[::2]), tuple(int(number) for number in pieces[1::2])
