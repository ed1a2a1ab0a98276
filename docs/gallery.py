"""Sphinx extension: every example case with its drawing, the first numbers of its page and its command.

A picture is kept while neither the package nor the case is newer. MOYAI_DOCS_QUICK=1 takes the equilibrium alone;
otherwise each case is run as it stands and its report stands behind the picture.
"""

from __future__ import annotations

import base64
import json
import os
from html import escape
from pathlib import Path
from typing import Any

from docutils import nodes
from sphinx.application import Sphinx
from sphinx.util import logging
from sphinx.util.docutils import SphinxDirective

ROOT = Path(__file__).parent.parent
HEADLINES = 3
#: Kinds without an equilibrium: run as they stand, or with what is shortest
WITHOUT_STATICS = ("member",)
STYLE = """
<style>
.gallery{display:grid;grid-template-columns:repeat(auto-fill,minmax(19rem,1fr));gap:1rem;padding:0}
.gallery article{border:1px solid var(--color-background-border,#ccc);border-radius:6px;padding:.8rem;min-width:0}
.gallery h3{margin:.5rem 0 .3rem;font-size:1rem}
.gallery img{width:100%;background:#fff;max-height:15rem;object-fit:contain}
.gallery p,.gallery dl{margin:.3rem 0;font-size:.85rem}.gallery dt{font-weight:400}
.gallery dd{margin:0 0 .2rem;font-weight:600}
.gallery code{font-size:.75rem;overflow-wrap:anywhere}
</style>
"""


def cases() -> list[Path]:
    """Return the example files that are cases, those of single structures first."""
    import moyai
    from moyai.core.errors import CaseError

    found = []
    for path in sorted((ROOT / "examples").rglob("*.yaml")):
        try:
            moyai.load_case(path)
        except CaseError:
            continue  # files of studies and records, and the case of a package that is not installed here
        found.append(path)
    return found


def words_of(path: Path) -> str:
    """Return the comment at the head of a case file."""
    lines = []
    for line in path.read_text(encoding="utf-8").splitlines():
        if not line.startswith("#"):
            break
        lines.append(line.lstrip("# ").strip())
    return " ".join(line for line in lines if line and not line.startswith("moyai "))


def card(path: Path, folder: Path, *, quick: bool) -> dict[str, Any]:
    """Return what the card of a case shows; its report stands in the folder where it was run as a whole."""
    import moyai

    kept = folder / "card.json"
    newest = max(one.stat().st_mtime for one in (path, *Path(moyai.__file__).parent.rglob("*.py")))
    if kept.exists() and kept.stat().st_mtime > newest:
        return dict(json.loads(kept.read_text(encoding="utf-8")))
    from moyai.report.document import Animation, Drawing, KeyFigures

    logging.getLogger(__name__).info(f"running {path.relative_to(ROOT).as_posix()}")
    folder.mkdir(parents=True, exist_ok=True)
    case = moyai.load_case(path)
    if quick and case.kind not in WITHOUT_STATICS:
        case = case.replace("analyses", ["statics"])
    result = moyai.run(case)
    if not quick:
        moyai.write_report(result, folder)
    blocks = moyai.report.compose_document(result).blocks()
    pictures = [one.fixed_svg if isinstance(one, Drawing) else one.still
                for one in blocks if isinstance(one, Drawing | Animation)]  # fmt: skip
    numbers = next((one.items for one in blocks if isinstance(one, KeyFigures)), ())
    found = {
        "title": case.title,
        "picture": next((one for one in pictures if one), ""),
        "numbers": [(one.label, one.text) for one in numbers[:HEADLINES]],
        "report": "" if quick else "report.html",
    }
    kept.write_text(json.dumps(found), encoding="utf-8")
    return found


class Gallery(SphinxDirective):
    """The cards of all cases."""

    has_content = False

    def run(self) -> list[nodes.Node]:
        """Return the cards as HTML."""
        quick = os.environ.get("MOYAI_DOCS_QUICK") == "1"
        root = Path(self.env.app.outdir) / "gallery"
        cards = []
        for path in cases():
            name = path.relative_to(ROOT / "examples").with_suffix("").as_posix().replace("/", "-")
            shown = card(path, root / name, quick=quick)
            coded = base64.b64encode(shown["picture"].encode()).decode()
            title = escape(shown["title"])
            picture = f'<img alt="{title}" src="data:image/svg+xml;base64,{coded}">' if coded else ""
            if shown["report"]:
                picture = f'<a href="gallery/{name}/{shown["report"]}">{picture or "report"}</a>'
            numbers = "".join(f"<dt>{escape(label)}</dt><dd>{escape(value)}</dd>" for label, value in shown["numbers"])
            command = f"moyai run {path.relative_to(ROOT).as_posix()}"
            cards.append(
                f"<article>{picture}<h3>{title}</h3><p>{escape(words_of(path))}</p><dl>{numbers}</dl>"
                f"<code>{escape(command)}</code></article>"
            )
        note = "<p>Here the equilibrium alone was computed.</p>" if quick else "<p>A picture opens the report.</p>"
        return [nodes.raw("", STYLE + note + f'<div class="gallery">{"".join(cards)}</div>', format="html")]


def setup(app: Sphinx) -> dict[str, bool]:
    """Register the directive."""
    app.add_directive("example-gallery", Gallery)
    return {"parallel_read_safe": False}
