"""Compose the report of a rigid cage: motions and tensions first, then what they rest on."""

from __future__ import annotations

from moyai.core.results import Result
from moyai.report.document import Document
from moyai.report.general_page import compose as compose_general


def compose(result: Result) -> Document:
    """Compose the report of a rigid cage."""
    return compose_general(result)
