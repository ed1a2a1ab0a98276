"""Sphinx extension: the pages of the five papers in both languages, and a table of how they stand.

A page is kept while no source of the package is newer. MOYAI_DOCS_QUICK=1 computes fewer waves and coarser curves.
"""

from __future__ import annotations

import json
import os
from pathlib import Path
from typing import Any

from computed_ahead import ahead
from docutils import nodes
from docutils.statemachine import StringList
from kept_runs import kept_paper
from sphinx.application import Sphinx
from sphinx.util import logging
from sphinx.util.docutils import SphinxDirective

COUNTS = ("equations", "figures drawn", "statements", "agree", "differ", "open")
#: Heads of the table by the language of the page, in the words of the papers' own pages.
HEADS = {
    "en": ("paper", *COUNTS),
    "ja": ("論文", "式", "描いた図", "記述", "一致", "相違", "未定"),
}


def compute(name: str, root: Path) -> dict[str, Any]:
    """Return the counts of a paper, its authors in Japanese; its pages stand in ``papers`` and ``ja/papers`` then."""
    import moyai

    folder = root / "papers" / name

    counts = folder / "counts.json"
    newest = max(
        path.stat().st_mtime for kind in ("*.py", "*.yaml") for path in Path(moyai.__file__).parent.rglob(kind)
    )
    if counts.exists() and counts.stat().st_mtime > newest:
        return dict(json.loads(counts.read_text(encoding="utf-8")))
    from moyai.language import said, spoken_in
    from moyai.reproduce import as_result
    from moyai.reproduce.page import write

    logging.getLogger(__name__).info(f"computing the page of {name}")
    folder.mkdir(parents=True, exist_ok=True)
    found = kept_paper(name, quick=os.environ.get("MOYAI_DOCS_QUICK") == "1")
    result = as_result(found)
    write(found, result, folder)
    japanese = root / "ja" / "papers" / name
    japanese.mkdir(parents=True, exist_ok=True)
    with spoken_in("ja"):
        write(found, result, japanese)
        authors = said(found.paper.authors)
    values = {
        "authors": authors,
        "equations": len(found.paper.equations),
        "figures drawn": sum(one.drawn is not None for one in found.figures),
        "statements": len(found.rows),
        "agree": found.count("agrees"),
        "differ": found.count("differs"),
        "open": found.count("open"),
    }
    counts.write_text(json.dumps(values), encoding="utf-8")
    return values


class ReproducedPapers(SphinxDirective):
    """A table of the papers, each with a link to its page."""

    has_content = False

    def run(self) -> list[nodes.Node]:
        """Return the table."""
        from moyai.reproduce import papers

        language = "ja" if self.env.docname.startswith("ja/") else "en"
        root = Path(self.env.app.outdir)
        lines = [".. list-table::", "   :header-rows: 1", ""]
        lines += [f"   {' ' if number else '*'} - {head}" for number, head in enumerate(HEADS[language])]
        for paper in papers():
            values = ahead(compute, paper.key, root)
            authors = values["authors"] if language == "ja" else paper.authors
            link = f':raw-html:`<a href="papers/{paper.key}/report.html">{authors} ({paper.year})</a>`'
            lines += [f"   * - {link}", *(f"     - {values[head]}" for head in COUNTS)]
        text = [".. role:: raw-html(raw)", "   :format: html", "", *lines]
        container = nodes.container()
        self.state.nested_parse(StringList(text, source="papers"), 0, container)
        return container.children


def setup(app: Sphinx) -> dict[str, bool]:
    """Register the directive."""
    app.add_directive("reproduced-papers", ReproducedPapers)
    return {"parallel_read_safe": False}
