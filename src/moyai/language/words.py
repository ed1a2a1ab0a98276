"""Which letters of a text are words of a language, and which are symbols, units, names and keys."""

from __future__ import annotations

import re
from collections import Counter
from functools import cache
from importlib import resources
from unicodedata import east_asian_width

_TOKEN = re.compile(r"[^\s\[\](){}（）「」、。；：,;:=<>≤≥×·・|\"“”]+")
_WORD = re.compile(r"(?<![A-Za-z])[A-Za-zÀ-ɏ]+(?:['-][A-Za-z]+)*(?![A-Za-z])")
_SHORT = frozenset(("of", "in", "at", "by", "to", "on", "or", "is", "as", "it", "no", "up", "if", "be", "do", "we"))
"""Words of two letters that are no symbols."""
_JAPANESE = re.compile("[\u3040-\u30ff\u4e00-\u9fff]")
_CODE = re.compile(r"[_/\\]|\w\.\w|^--?\w|^\.|\d|\w\(\)|[A-Z]{2,}|^[A-Za-z]\w?$|^[a-z]+[A-Z]|@")


@cache
def kept_words() -> frozenset[str]:
    """Return the words of ``latin.txt``, which stay in Latin letters: units, names, symbols."""
    text = (resources.files("moyai.language") / "latin.txt").read_text(encoding="utf-8")
    return frozenset(word for line in text.splitlines() if not line.startswith("#") for word in line.split())


def latin_words(text: str) -> list[str]:
    """Return the words of a text in Latin letters that are neither symbols nor units, names, keys or file names.

    Parameters
    ----------
    text : str
    """
    if _JAPANESE.search(text):  # a plain colon stands in code alone: `dynamic: false`
        text = re.sub(r"\b[A-Za-z_]+: [A-Za-z_]+", " ", text)
    found, kept = [], kept_words()
    quoted = re.sub(r"\[?eq:[\w-]+\]?|'[^'\s]+'|'\w+: \w+'|`[^`]*`|moyai measure [a-z]+", " ", text)  # as typed
    for token in _TOKEN.findall(quoted):
        plain = token.strip("'.!?")
        if token.isascii() and plain.lower() not in _SHORT and _CODE.search(plain):
            continue
        for word in _WORD.findall(token):
            if len(word) > 1 and word not in kept and not word.isupper():
                found.append(word)
    return found


def numbers(text: str) -> Counter[str]:
    """Return the numbers of a text, digit by digit as they stand there, with how often each stands there."""
    return Counter(re.findall(r"\d+(?:[.,]\d+)*", text))


def breadth(text: str) -> int:
    """Return the room that a text takes on a line, in Latin letters: a letter of Japanese counts as two.

    Parameters
    ----------
    text : str
    """
    return sum(2 if east_asian_width(letter) in "WF" else 1 for letter in text)
