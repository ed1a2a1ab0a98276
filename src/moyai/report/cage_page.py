"""Compose the report of a net cage, by its model."""

from __future__ import annotations

from importlib import import_module

from moyai.core.results import Result
from moyai.report.document import Document

#: Attribute ``cage_model`` of the result: who composes its pages
PAGES = {
    "rigid": "moyai.report.cage_rigid_page:compose",
    "flexible": "moyai.report.cage_flexible_page:compose",
}


def compose(result: Result) -> Document:
    """Compose the report of a net cage.

    Parameters
    ----------
    result : Result
        With the layout of ``docs/result_layout.md``; whatever is absent is left out.

    Returns
    -------
    Document
    """
    model = str(result.tree.attrs.get("cage_model", ""))
    module, name = PAGES.get(model, "moyai.report.general_page:compose").split(":")
    document: Document = getattr(import_module(module), name)(result)
    return document
