"""What can be opened: templates of each kind, case files of the folder, the five papers, open cases."""

from __future__ import annotations

from functools import cache
from typing import Any

from moyai.app.documents import Documents
from moyai.app.folder import Folder
from moyai.core.kinds import structure_kind, structure_kinds
from moyai.language import said

_SHOWN = {"nakamura": "breakwater", "tabata": "curtain", "arai": "member", "sawaragi": "curtain", "matsubara": "cage"}
"""Structure that is drawn on the card of a paper."""
_NAMES = {"units": "Row of units"}
"""Names of templates that say more than their key."""


@cache
def _templates() -> list[dict[str, str]]:
    from moyai.case.templates import kinds_of_files

    words = dict(kinds_of_files())
    return [
        {
            "template": name,
            "kind": kind,
            "title": words[name],
            "name": _NAMES.get(name, name.replace("_", " ").capitalize()),
        }
        for kind in structure_kinds()
        for name, _ in structure_kind(kind).templates
        if name in words
    ]


@cache
def _papers() -> list[dict[str, str]]:
    from moyai.reproduce import papers

    return [
        {
            "paper": one.key,
            "kind": _SHOWN.get(one.key, ""),
            "title": one.title,
            "authors": one.authors,
            "year": str(one.year),
            "line": one.line,
        }
        for one in papers()
    ]


def gallery(folder: Folder, documents: Documents) -> dict[str, Any]:
    """Return the cards of the first page, in the language in force.

    Parameters
    ----------
    folder : Folder
    documents : Documents
    """
    return {
        "folder": str(folder.root),
        "templates": [{**one, "name": said(one["name"]), "title": said(one["title"])} for one in _templates()],
        "files": folder.case_files(),
        "papers": [{**one, **{key: said(one[key]) for key in ("authors", "year", "line")}} for one in _papers()],
        "recent": documents.recent(),
    }
