"""Sphinx extension: lines of Japanese joined without the blank that a browser shows where a line of the source ends."""

from __future__ import annotations

import re

from sphinx.application import Sphinx

_WIDE = "[\u3000-\u30ff\u3400-\u9fff\uff00-\uffef]"
_NO_TEXT = re.compile(r"^\s*(?:[-*+] |\d+\. |#|\||>|```|:::|!\[|\$\$|\(.*\)=$|:\w+:)")


def joined(text: str) -> str:
    """Return Markdown in which a line that ends in Japanese goes on with one that begins so; code and tables stay.

    Parameters
    ----------
    text : str
    """
    out: list[str] = []
    fence = ""
    for line in text.split("\n"):
        mark = re.match(r"\s*(```+|\$\$)", line)
        begins = not fence and mark is not None
        goes_on = (
            out
            and not fence
            and not begins
            and re.match(rf"\s*{_WIDE}", line)
            and re.search(rf"{_WIDE}$", out[-1])
            and not re.match(r"\s*(?:#|\|)", out[-1])
            and not _NO_TEXT.match(line)
        )
        if goes_on:
            out[-1] += line.lstrip()
        else:
            out.append(line)
        if mark is not None:
            fence = "" if fence else mark[1]
    return "\n".join(out)


def _read(app: Sphinx, name: str, source: list[str]) -> None:
    if name.startswith("ja/"):
        source[0] = joined(source[0])


def setup(app: Sphinx) -> dict[str, bool]:
    """Join the lines of Japanese pages as they are read."""
    app.connect("source-read", _read)
    return {"parallel_read_safe": True}
