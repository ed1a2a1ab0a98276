"""The sentences of the page in the language in force: found in its scripts and its HTML, where ``say`` shows them."""

from __future__ import annotations

import json
import re
from functools import cache
from importlib import resources

from moyai.language import spoken_language
from moyai.language.catalogue import page_catalogue

_SAID = re.compile(r'\bsay\(("(?:[^"\\]|\\.)*")')
_MARKED = re.compile(r"\{\{([A-Z][^{}]*|[a-z]+ …)\}\}")


@cache
def sentences() -> tuple[str, ...]:
    """Return what the scripts and the HTML of the page say, in English, with places ``{0}``."""
    found: dict[str, None] = {}
    for file in sorted((resources.files("moyai.app") / "assets").iterdir(), key=lambda file: file.name):
        if not file.name.endswith((".js", ".html")) or file.name == "codemirror.js":
            continue
        text = file.read_text(encoding="utf-8")
        found |= dict.fromkeys(json.loads(one) for one in _SAID.findall(text))
        found |= dict.fromkeys(_MARKED.findall(text))
    return tuple(found)


def page_words() -> dict[str, str]:
    """Return every sentence of the page in the language in force, by its English; what is not known stays English."""
    known = page_catalogue(spoken_language())
    return {text: known.get(text, text) for text in sentences()}


def marked(html: str) -> str:
    """Return the HTML of the page with its marked sentences in the language in force."""
    words = page_words()
    return _MARKED.sub(lambda match: words[match[1]], html)
