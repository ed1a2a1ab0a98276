"""Sphinx extension: every example with its drawing, the first numbers of its page and its command.

Cases are run as they stand and studies and records too, and the report stands behind the picture. MOYAI_DOCS_QUICK=1
takes the equilibrium of cases alone and draws the base of a study. A card is kept while neither the package nor the
example is newer.
"""

from __future__ import annotations

import base64
import contextlib
import json
import os
import re
from html import escape
from pathlib import Path
from typing import Any

from computed_ahead import ahead
from docutils import nodes
from kept_runs import kept_run
from report_pictures import SPAR, measured, spar_at_work, spar_installed
from sphinx.application import Sphinx
from sphinx.util import logging
from sphinx.util.docutils import SphinxDirective

ROOT = Path(__file__).parent.parent
HEADLINES = 3
REPORTS = "<p>A picture opens the report.</p>"
#: Kinds without an equilibrium: run as they stand, or with what is shortest
WITHOUT_STATICS = ("member", "spar")
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


#: Records that an example makes: what `moyai measure` is given, by file.
RECORDS = {"nets/nets.yaml": "nets", "curtain/flume/snaps.yaml": "snaps"}


def examples() -> list[Path]:
    """Return every file of the examples that is run, those of the papers too, whose folders are links."""
    files = (Path(folder) / name for folder, _, names in os.walk(ROOT / "examples", followlinks=True) for name in names)
    return sorted(path for path in files if path.suffix == ".yaml")


def command_of(path: Path) -> str:
    """Return the command that runs an example."""
    name = path.relative_to(ROOT).as_posix()
    kind = RECORDS.get(path.relative_to(ROOT / "examples").as_posix())
    if kind is not None:
        return f"moyai measure {kind} {name}"
    if SPAR in path.parents:
        return "moyai new spar -o spar.yaml; moyai run spar.yaml"
    return f"moyai study {name}" if is_study(path) else f"moyai run {name}"


def folder_of(path: Path, root: Path) -> Path:
    """Return where the card and the report of an example stand below the folder of the pages."""
    return root / "gallery" / path.relative_to(ROOT / "examples").with_suffix("").as_posix().replace("/", "-")


def is_study(path: Path) -> bool:
    """Return whether a file is that of a study."""
    return re.search(r"(?m)^study:", path.read_text(encoding="utf-8")) is not None


def words_of(path: Path) -> str:
    """Return the comment at the head of a case file."""
    lines = []
    for line in path.read_text(encoding="utf-8").splitlines():
        if not line.startswith("#"):
            break
        lines.append(line.lstrip("# ").strip())
    return " ".join(line for line in lines if line and not line.startswith("moyai "))


def card(path: Path, folder: Path, *, quick: bool) -> dict[str, Any]:
    """Return what the card of an example shows; its report stands in the folder where it was run as a whole."""
    import moyai

    kept = folder / "card.json"
    newest = max(one.stat().st_mtime for one in (path, *Path(moyai.__file__).parent.rglob("*.py")))
    if kept.exists() and kept.stat().st_mtime > newest:
        return dict(json.loads(kept.read_text(encoding="utf-8")))
    logging.getLogger(__name__).info(f"running {path.relative_to(ROOT).as_posix()}")
    folder.mkdir(parents=True, exist_ok=True)
    with spar_installed() if SPAR in path.parents else contextlib.nullcontext():
        make_card(path, folder, quick=quick)
    return dict(json.loads(kept.read_text(encoding="utf-8")))


def make_card(path: Path, folder: Path, *, quick: bool) -> None:
    """Run an example and write its card."""
    import moyai
    from moyai.cli.main import app

    name = path.relative_to(ROOT / "examples").as_posix()
    title, numbers, whole = "", None, not quick
    if name in RECORDS:
        result, whole = measured(RECORDS[name], str(Path(name).parent), Path(name).name)(), True
    elif is_study(path):
        from moyai.study.plan import case_at, load_study

        plan = load_study(path)
        title, numbers = plan.title, [("cases", str(len(plan.cases)))]
        if quick:
            result = at_rest(case_at(plan, plan.cases[0]))
        else:
            app(["study", str(path), "-o", str(folder), "--quiet"], standalone_mode=False)
            result = moyai.read_result(folder / "study.nc")
    else:
        case = moyai.load_case(path)
        title = case.title
        result = at_rest(case) if quick else kept_run(case)
    if whole and not is_study(path):
        moyai.write_report(result, folder)
    heading, picture, found = first_things(result)
    if SPAR in path.parents:
        picture = spar_at_work()
    content = {
        "title": title or heading,
        "picture": picture,
        "numbers": numbers if numbers is not None else found,
        "report": "report.html" if whole else "",
    }
    (folder / "card.json").write_text(json.dumps(content), encoding="utf-8")


def at_rest(case: Any) -> Any:
    """Return the equilibrium of a case, or its whole run where it has none."""
    return kept_run(case if case.kind in WITHOUT_STATICS else case.replace("analyses", ["statics"]))


def first_things(result: Any) -> tuple[str, str, list[tuple[str, str]]]:
    """Return the title of a report, its first drawing, else its first figure, and its first numbers."""
    import moyai
    from moyai.report.document import Animation, Drawing, Figure, KeyFigures
    from moyai.report.figures_static import draw_figure

    document = moyai.report.compose_document(result)
    blocks = list(document.blocks())
    drawn = [one.fixed_svg if isinstance(one, Drawing) else one.still
             for one in blocks if isinstance(one, Drawing | Animation)]  # fmt: skip
    picture = next((one for one in drawn if one), "")
    if not picture:
        picture = next((draw_figure(one).decode("utf-8") for one in blocks if isinstance(one, Figure)), "")
    numbers = next((one.items for one in blocks if isinstance(one, KeyFigures)), ())
    shown = [
        (one.label, one.text) for one in numbers if re.search(r"\d", one.text)
    ]  # not the line on what is not judged
    return document.title, picture, shown[:HEADLINES]


class Gallery(SphinxDirective):
    """The cards of all cases."""

    has_content = False

    def run(self) -> list[nodes.Node]:
        """Return the cards as HTML."""
        quick = os.environ.get("MOYAI_DOCS_QUICK") == "1"
        root = Path(self.env.app.outdir)
        cards = []
        for path in examples():
            folder = folder_of(path, root)
            shown = ahead(card, path, folder, quick=quick)
            coded = base64.b64encode(shown["picture"].encode()).decode()
            title = escape(shown["title"])
            picture = f'<img alt="{title}" src="data:image/svg+xml;base64,{coded}">' if coded else ""
            if shown["report"]:
                picture = f'<a href="gallery/{folder.name}/{shown["report"]}">{picture or "report"}</a>'
            numbers = "".join(f"<dt>{escape(label)}</dt><dd>{escape(value)}</dd>" for label, value in shown["numbers"])
            command = command_of(path)
            cards.append(
                f"<article>{picture}<h3>{title}</h3><p>{escape(words_of(path))}</p><dl>{numbers}</dl>"
                f"<code>{escape(command)}</code></article>"
            )
        note = "<p>Here the equilibrium alone was computed; of studies the base is drawn.</p>" if quick else REPORTS
        return [nodes.raw("", STYLE + note + f'<div class="gallery">{"".join(cards)}</div>', format="html")]


def setup(app: Sphinx) -> dict[str, bool]:
    """Register the directive."""
    app.add_directive("example-gallery", Gallery)
    return {"parallel_read_safe": False}
