"""The comments of a file that ``moyai new`` prints, in the language in force; its keys and values stay as they are."""

from __future__ import annotations

import re
from collections.abc import Iterator

from moyai.language.current import said, spoken_language

_COMMENT = re.compile(r"^([^#\n]*?)([ \t]*)#([ \t]*)(\S.*?)$", re.MULTILINE)
# a key or a command that is commented out, with or without a comment of its own
_CODE = re.compile(r"^(- |\{)|^[a-z_][\w.]*:( |$)|^moyai |^yaml-language-server")
# keys with values behind a key: what may stand in its place
_KEYS = re.compile(r"^[a-z_]\w*: [\[{]")


def with_comments(text: str) -> str:
    """Return a commented YAML text with its comments translated line by line.

    Parameters
    ----------
    text : str
    """
    if spoken_language() == "en":
        return text
    return _COMMENT.sub(_translated, text)


def comments(text: str) -> Iterator[str]:
    """Give the comments of a YAML text that are sentences or words, as they are translated one by one.

    Parameters
    ----------
    text : str
    """
    for match in _COMMENT.finditer(text):
        yield from _parts(match.group(4), alone=not match.group(1).strip())


def _parts(comment: str, alone: bool) -> Iterator[str]:
    _, mark, remark = comment.partition("  #")
    if mark:
        yield remark.strip()
    elif not (alone and _CODE.match(comment)) and not _KEYS.match(comment):
        yield comment
    elif comment.startswith("moyai ") and (words := _command(comment)[2]):
        yield words


def _translated(match: re.Match[str]) -> str:
    before, gap, space, comment = match.groups()
    code, mark, remark = comment.partition("  #")
    if mark:
        comment = f"{code}  #{_spaced(remark)}"
    elif (before.strip() or not _CODE.match(comment)) and not _KEYS.match(comment):
        comment = said(comment)
    elif comment.startswith("moyai "):
        command, gap_within, words = _command(comment)
        comment = command + gap_within + said(words)
    return f"{before}{gap}#{space}{comment}"


def _spaced(remark: str) -> str:
    words = remark.strip()
    return remark[: len(remark) - len(remark.lstrip())] + said(words)


def _command(comment: str) -> tuple[str, str, str]:
    found = re.match(r"(.*?)(\s{2,})(.*)", comment)
    return (found[1], found[2], found[3]) if found else (comment, "", "")
