"""Formulas as MathML, so that the pages show them without scripts and without a network."""

from __future__ import annotations

import re
from importlib.util import find_spec
from pathlib import Path
from typing import Any

from docutils import nodes
from latex2mathml.converter import convert
from sphinx.application import Sphinx
from sphinx.util.math import get_node_equation_number

_FUNCTION = re.compile(
    r"(?<!<msup>)(?<!<msub>)<mi>((?:arc|a?r)?(?:sin|cos|tan|cot|sinh|cosh|tanh|coth)|log|ln|exp|arg)</mi>"
)
_SIGN = re.compile(r'<mo( stretchy="false")?>(?=(?:&#x0007C;|&#x0002F;)<)')  # bars and strokes stand close
_GAP = r'<mrow><mi>\1</mi><mspace width="0.17em"/></mrow>'


def mathml(text: str, display: str = "inline") -> str:
    """Return a formula of TeX as MathML, with a thin gap behind the names of functions and none next to bars."""
    return _SIGN.sub(r'<mo\1 lspace="0" rspace="0">', _FUNCTION.sub(_GAP, convert(text, display=display)))


def font_folder() -> str:
    """Return the folder of the letters of formulas (STIX Two Math), copied next to the pages."""
    found = find_spec("ziamath")
    if found is None or found.origin is None:
        raise ImportError("the pages need ziamath, whose letters of formulas they carry: pip install '.[docs]'")
    return str(Path(found.origin).parent / "fonts")


def _inline(self: Any, node: nodes.math) -> None:
    self.body.append(self.starttag(node, "span", "", CLASS="math notranslate"))
    self.body.append(f"{mathml(node.astext())}</span>")
    raise nodes.SkipNode


def _display(self: Any, node: nodes.math_block) -> None:
    self.body.append(self.starttag(node, "div", CLASS="math notranslate"))
    if node.get("number"):
        self.body.append(f'<span class="eqno">({get_node_equation_number(self, node)})')
        self.add_permalink_ref(node, "Link to this equation")
        self.body.append("</span>")
    for part in filter(None, node.astext().split("\n\n")):
        rows = r"\\" in part and r"\begin" not in part
        shown = mathml(rf"\begin{{split}}{part}\end{{split}}" if rows else part, display="block")
        self.body.append(f'<div class="formula">{shown}</div>')
    self.body.append("</div>\n")
    raise nodes.SkipNode


def setup(app: Sphinx) -> dict[str, bool]:
    """Register the renderer under the name ``mathml``."""
    app.add_html_math_renderer("mathml", (_inline, None), (_display, None))
    return {"parallel_read_safe": True, "parallel_write_safe": True}
