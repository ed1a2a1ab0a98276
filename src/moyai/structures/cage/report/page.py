"""Compose the report of a net cage, by its model."""

from __future__ import annotations

from moyai.core.results import Result
from moyai.report.document import Document


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
    if result.held.attrs["cage_model"] == "rigid":
        from moyai.structures.cage.report.rigid_page import compose as compose_rigid

        return compose_rigid(result)
    from moyai.structures.cage.report.flexible_page import compose as compose_flexible

    return compose_flexible(result)
