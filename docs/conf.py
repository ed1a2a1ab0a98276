"""Sphinx configuration: `sphinx-build -W docs docs/_build/html` works offline, warnings are errors; so do the pages."""

from __future__ import annotations

import importlib
import importlib.metadata
import logging
import pkgutil
import re
import sys
from pathlib import Path
from typing import Any, ClassVar

from docutils import nodes
from docutils.statemachine import StringList
from sphinx.application import Sphinx
from sphinx.util.docutils import SphinxDirective

project = "moyai"
author = "The moyai authors"
copyright = "The moyai authors, Apache-2.0"
version = release = importlib.metadata.version("moyai")

sys.path.insert(0, str(Path(__file__).parent))
from mathml import font_folder  # noqa: E402 - next to this file

logging.getLogger("fontTools").setLevel(
    logging.WARNING
)  # else a line for each table that a subset of a font leaves out

extensions = [
    "computed_ahead",
    "gallery",
    "moving_picture",
    "report_pictures",
    "reproduced_papers",
    "held_by_tests",
    "japanese_lines",
    "links_checked",
    "measured_speed",
    "validation_results",
    "myst_parser",
    "sphinx.ext.autodoc",
    "sphinx.ext.napoleon",
    "mathml",
]
myst_enable_extensions = ["dollarmath", "amsmath", "deflist"]
myst_heading_anchors = 3
math_number_all = True
exclude_patterns = ["_build"]
html_theme = "furo"
html_title = "moyai"
html_static_path = ["_static", font_folder()]
html_css_files = ["site.css"]
html_math_renderer = "mathml"
nitpicky = False

autodoc_member_order = "bysource"
autodoc_typehints = "none"
autodoc_use_type_comments = False
autodoc_default_options = {"members": True, "undoc-members": False, "show-inheritance": False}
napoleon_numpy_docstring = True
napoleon_google_docstring = False
napoleon_use_rtype = False
# Docstrings are plain text for the reader of the code, with bars and stars of formulas, and not checked as markup;
# the pages of the documentation are MyST and are checked
suppress_warnings = ["docutils", "autodoc", "ref.footnote", "ref.python", "ref.ref", "ref.doc"]


class PublicModules(SphinxDirective):
    """Document every public module of a package and below it: no page is edited when a module comes or goes.

    Packages that have a page of their own are left to it.
    """

    required_arguments = 1
    has_content = False
    option_spec: ClassVar[dict[str, Any]] = {}

    def run(self) -> list[nodes.Node]:
        """Return one automodule for each module."""
        package = importlib.import_module(self.arguments[0])
        own = {f"moyai.{path.stem.replace('_', '.')}" for path in (Path(__file__).parent / "reference").glob("*.rst")}
        names = [package.__name__]
        waiting = [package]
        while waiting:
            inside = waiting.pop()
            for module in pkgutil.iter_modules(inside.__path__, f"{inside.__name__}."):
                if module.name.rsplit(".", 1)[1].startswith("_") or module.name in own:
                    continue
                names.append(module.name)
                if module.ispkg:
                    waiting.append(importlib.import_module(module.name))
        lines = []
        for name in sorted(names):
            lines += [f".. rubric:: {name}", "", f".. automodule:: {name}", "   :no-index:", ""]
        container = nodes.container()
        self.state.nested_parse(StringList(lines, source="modules"), 0, container)
        return container.children


_CODE = re.compile(r"(`+[^`]*`+_*)")
_SIGNS = re.compile(r"\||\*(?=[a-z_.]+[,)])")


def plain_signs(app: Sphinx, what: str, name: str, thing: Any, options: Any, lines: list[str]) -> None:
    """Let bars and stars of formulas in docstrings stand as they are: they would be read as markup."""
    for number, line in enumerate(lines):
        parts = _CODE.split(line)
        parts[::2] = [_SIGNS.sub(r"\\\g<0>", part) for part in parts[::2]]
        lines[number] = "".join(parts)


def setup(app: Sphinx) -> None:
    """Register the directive and what is done to docstrings."""
    app.connect("autodoc-process-docstring", plain_signs, priority=600)
    app.add_directive("public-modules", PublicModules)
