"""Sphinx extension: drawings and figures of reports, run with the documentation, in the language of the page.

``{report-picture}`` takes ``:of:``, one of :data:`RUNS`, and ``:show:``, the key of a drawing or figure of its report.
A run is kept while neither the package nor its page is newer.
"""

from __future__ import annotations

import contextlib
import importlib.metadata
import io
import json
import os
import re
import runpy
import shutil
import sys
import tempfile
from collections.abc import Callable, Iterator
from html import escape
from pathlib import Path
from typing import Any, ClassVar
from unittest import mock

from computed_ahead import ahead
from docutils import nodes
from docutils.parsers.rst import directives
from kept_runs import kept_run
from sphinx.application import Sphinx
from sphinx.util import logging
from sphinx.util.docutils import SphinxDirective

DOCS = Path(__file__).parent
ROOT = DOCS.parent
SPAR = ROOT / "examples" / "new_structure"
#: One short run of regular waves in place of the storms of a template.
SWELL = {"name": "swell", "kind": "regular", "height": "1 m", "periods": [6.0], "heading_deg": 0}
FLUME = {"name": "periods", "kind": "regular", "height": "3 cm", "periods": [1.0, 1.2, 1.5], "heading_deg": 0}


def code_blocks(page: Path, kind: str) -> list[str]:
    """Return the blocks of a page that are of one kind."""
    return re.findall(rf"^```{kind}\n(.*?)^```$", page.read_text(encoding="utf-8"), re.DOTALL | re.MULTILINE)


def written_in(page: str, **changes: Any) -> Callable[[], Any]:
    """Return how to run the first case file that a tutorial shows, with changes."""

    def run() -> Any:
        import moyai

        case = moyai.load_case(code_blocks(DOCS / "tutorial" / f"{page}.md", "yaml")[0])
        return _changed(case, changes)

    return run


def standing_at(name: str, **changes: Any) -> Callable[[], Any]:
    """Return how to run an example, or the template of a kind, with changes."""

    def run() -> Any:
        import moyai

        case = moyai.load_case(ROOT / "examples" / name if name.endswith(".yaml") else moyai.template(name))
        return _changed(case, changes)

    return run


def _changed(case: Any, changes: dict[str, Any]) -> Any:
    for path, value in changes.items():
        case = case.replace(path, value)
    return kept_run(case)


def measured(kind: str, folder: str, file: str) -> Callable[[], Any]:
    """Return how to make the records of an example and measure them, in a folder that is removed again."""

    def run() -> Any:
        import moyai
        from moyai.cli.main import app

        with elsewhere() as place:
            shutil.copytree(ROOT / "examples" / folder, place / "example")
            with contextlib.redirect_stdout(io.StringIO()), contextlib.redirect_stderr(io.StringIO()):
                # as Python does for a script: its folder stands first in the path
                here = str(place / "example")
                with mock.patch.object(sys, "argv", ["make_records.py"]), mock.patch("sys.path", [here, *sys.path]):
                    runpy.run_path(f"{here}/make_records.py", run_name="__main__")
                code = app(["measure", kind, str(place / "example" / file), "-o", "out"], standalone_mode=False)
            if code:
                raise RuntimeError(f"moyai measure {kind} of the example ends with {code}")
            return moyai.read_result(place / "out" / "results.nc")

    return run


def survey() -> Any:
    """Run the Python blocks of the tutorial of records and return the result that they write."""
    import moyai

    page = DOCS / "tutorial" / "records_to_model.md"
    with elsewhere() as place, contextlib.redirect_stdout(io.StringIO()):
        (place / "storm.yaml").write_text(code_blocks(page, "yaml")[0], encoding="utf-8")
        scope: dict[str, Any] = {}
        for block in code_blocks(page, "python")[:2]:
            exec(compile(block, page.name, "exec"), scope)
        return moyai.read_result(place / "results.nc")


@contextlib.contextmanager
def spar_installed() -> Iterator[None]:
    """Let moyai find the structure of the tutorial that adds one, as if it were installed."""
    from moyai.core import kinds

    def forget() -> None:
        for found in (kinds._foreign, kinds.structure_kind, kinds.kind_of_result):
            found.cache_clear()

    if any(entry.name == "spar" for entry in importlib.metadata.entry_points(group="moyai.structures")):
        yield
        return
    before = list(sys.path)
    with tempfile.TemporaryDirectory() as name:
        record = Path(name) / "moyai_spar-1.0.dist-info"
        record.mkdir()
        (record / "METADATA").write_text("Metadata-Version: 2.1\nName: moyai_spar\nVersion: 1.0\n", encoding="utf-8")
        points = "[moyai.structures]\nspar = moyai_spar:KIND\n"
        (record / "entry_points.txt").write_text(points, encoding="utf-8")
        sys.path[:0] = [name, str(SPAR)]
        forget()
        try:
            yield
        finally:
            sys.path[:] = before
            forget()


def spar_at_work() -> str:
    """Return the spar of the template with its chain in the current, to scale, as SVG; its report draws nothing."""
    import moyai
    from moyai.case.builder import build
    from moyai.mooring import Line, line_shape

    problem = build(moyai.load_case(SPAR / "moyai_spar" / "template.yaml"))
    from moyai_spar.model import equilibrium

    level = max(height for _, height in problem.water_levels)
    state, depth = equilibrium(problem, level), problem.water.depth + level
    anchor, keel = (0.0, 0.0, -depth), (state.offset, 0.0, -state.draught)
    chain = line_shape(Line("chain", anchor, keel, (problem.chain,)), keel, depth).points
    left, top, width = 4.0, problem.height, state.offset + 8.0
    places = " ".join(f"{x + left:.3f},{top - z:.3f}" for x, _, z in chain)
    spar = (
        f'<rect x="{state.offset + left - 0.5 * problem.diameter:.3f}" y="{top + state.draught - problem.height:.3f}" '
        f'width="{problem.diameter}" height="{problem.height}" fill="#8a9aa8" stroke="#33414d" stroke-width=".08"/>'
    )
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width:.2f} {top + depth + 1.5:.2f}" role="img">'
        '<rect width="100%" height="100%" fill="#f7fafc"/>'
        f'<rect y="{top}" width="100%" height="{depth}" fill="#cfe3f1"/>'
        f'<rect y="{top + depth}" width="100%" height="2" fill="#d9cdb8"/>{spar}'
        f'<polyline points="{places}" fill="none" stroke="#7a3b1d" stroke-width=".15"/></svg>'
    )


@contextlib.contextmanager
def elsewhere() -> Iterator[Path]:
    """Work in a folder that is removed again."""
    before = Path.cwd()
    with tempfile.TemporaryDirectory() as name:
        os.chdir(name)
        try:
            yield Path(name)
        finally:
            os.chdir(before)


RUNS: dict[str, Callable[[], Any]] = {
    "first_breakwater": written_in("first_breakwater", analyses=["statics", "mooring", "frequency"]),
    "first_curtain": written_in("first_curtain", analyses=["statics"]),
    "flexible_cage": standing_at("cage/flume_cage.yaml", analyses=["statics"]),
    "rigid_cage": standing_at("rigid_cage", waves=FLUME),
    "submerged_member": standing_at("member", waves=SWELL),
    "network": written_in("network"),
    "in_python": standing_at("network"),
    "records_to_model": survey,
    "towed_nets": measured("nets", "nets", "nets.yaml"),
}
#: The structure of another package, whose report has no pictures, in the words of both languages.
SPAR_WORDS = {
    "en": "The spar of the template in its current at HWL, to scale",
    "ja": "ひな形のスパー型ブイ：流れの中、HWL、縮尺どおり",
}


def pictures_of(result: Any, language: str) -> dict[str, tuple[str, str]]:
    """Return the pictures of the report of a result as title and SVG by their keys."""
    import moyai
    from moyai.language import spoken_in
    from moyai.report.document import Animation, Drawing, Figure
    from moyai.report.figures_static import draw_figure
    from moyai.report.language import in_the_language

    found: dict[str, tuple[str, str]] = {}
    with spoken_in(language):
        document = in_the_language(moyai.report.compose_document(result, language=language))
        for block in document.blocks():
            if isinstance(block, Figure):
                svg = draw_figure(block).decode("utf-8")
            elif isinstance(block, Drawing):
                svg = block.fixed_svg
            elif isinstance(block, Animation):
                svg = block.still
            else:
                continue
            if svg:
                found.setdefault(block.key, (block.title, svg))
    return found


def kept_pictures(name: str, folder: Path) -> dict[str, dict[str, Any]]:
    """Return the pictures of a run in both languages; they stand in the folder then."""
    import moyai

    kept = folder / f"{name}.json"
    sources = [Path(__file__), *DOCS.glob(f"tutorial/{name}.md"), *Path(moyai.__file__).parent.rglob("*.py")]
    if not kept.exists() or kept.stat().st_mtime <= max(one.stat().st_mtime for one in sources):
        logging.getLogger(__name__).info(f"drawing the pictures of {name}")
        if name == "add_a_structure":
            with spar_installed():
                svg = spar_at_work()
            found = {language: {"spar": (words, svg)} for language, words in SPAR_WORDS.items()}
        else:
            result = RUNS[name]()
            found = {language: pictures_of(result, language) for language in ("en", "ja")}
        folder.mkdir(parents=True, exist_ok=True)
        kept.write_text(json.dumps(found, ensure_ascii=False), encoding="utf-8")
    return dict(json.loads(kept.read_text(encoding="utf-8")))


class ReportPicture(SphinxDirective):
    """One drawing or figure of a report; its words are those of the report."""

    has_content = False
    option_spec: ClassVar[dict[str, Any]] = {"of": directives.unchanged_required, "show": directives.unchanged_required}

    def run(self) -> list[nodes.Node]:
        """Return the picture as HTML."""
        name, key = self.options["of"], self.options["show"]
        if name not in RUNS and name != "add_a_structure":
            raise self.error(f"no run {name}: {', '.join(RUNS)}")
        language = "ja" if self.env.docname.startswith("ja/") else "en"
        outdir = Path(self.env.app.outdir)
        pictures = ahead(kept_pictures, name, outdir / "pictures")[language]
        if key not in pictures:
            raise self.error(f"no picture {key} of {name}: {', '.join(pictures)}")
        title, svg = pictures[key]
        file = outdir / "_images" / f"{name}-{key}-{language}.svg"
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(svg, encoding="utf-8")
        up = "../" * self.env.docname.count("/")
        html = (
            f'<figure class="report"><img alt="{escape(title)}" src="{up}_images/{file.name}">'
            f"<figcaption>{escape(title)}</figcaption></figure>"
        )
        return [nodes.raw("", html, format="html")]


def setup(app: Sphinx) -> dict[str, bool]:
    """Register the directive."""
    app.add_directive("report-picture", ReportPicture)
    return {"parallel_read_safe": False}
