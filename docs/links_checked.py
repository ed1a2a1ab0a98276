"""Sphinx extension: no page of the site has a link to a file or a place that is not there.

Sphinx knows the links that it made itself; this reads the finished pages, so those of the gallery, of the papers and of
reports too. Addresses of other sites are left alone: the build works offline.
"""

from __future__ import annotations

import re
from functools import cache
from pathlib import Path
from urllib.parse import unquote

from sphinx.application import Sphinx
from sphinx.errors import ExtensionError

_SCRIPT = re.compile(r"<(script|style)\b.*?</\1>", re.DOTALL)
_LINK = re.compile(r'<[^>]*?\s(?:href|src)="([^"]*)"')
_PLACE = re.compile(r'\s(?:id|name)="([^"]+)"')
_ELSEWHERE = re.compile(r"[a-z]+:|//")


def dead_links(folder: Path) -> list[str]:
    """Return the links of the pages in a folder that lead nowhere, each with its page."""

    @cache
    def places(page: Path) -> set[str]:
        return set(_PLACE.findall(page.read_text(encoding="utf-8")))

    found = []
    for page in sorted(folder.rglob("*.html")):
        text = _SCRIPT.sub("", page.read_text(encoding="utf-8"))
        for link in sorted(set(_LINK.findall(text))):
            if _ELSEWHERE.match(link):
                continue
            name, _, place = link.partition("#")
            target = (page.parent / unquote(name.partition("?")[0])).resolve() if name else page
            if target.is_dir():
                target /= "index.html"
            lost = place and target.suffix == ".html" and target.exists() and unquote(place) not in places(target)
            if not target.exists() or lost:
                found.append(f"{page.relative_to(folder)}: {link}")
    return found


def check(app: Sphinx, exception: Exception | None) -> None:
    """End the build where a link is dead."""
    if exception is None and app.builder.format == "html":
        found = dead_links(Path(app.outdir))
        if found:
            raise ExtensionError("dead links:\n" + "\n".join(found))


def setup(app: Sphinx) -> dict[str, bool]:
    """Look at the pages when they are written."""
    app.connect("build-finished", check)
    return {"parallel_read_safe": True}
