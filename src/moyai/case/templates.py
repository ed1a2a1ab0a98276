"""Commented case files to start from: one for every kind of structure, and for the files of other commands."""

from __future__ import annotations

from moyai.case.faults import did_you_mean
from moyai.core.errors import InputError
from moyai.core.kinds import structure_kind, structure_kinds, templates


def template(name: str) -> str:
    """Return the commented case file of a kind of structure, or the file of another command.

    Raises
    ------
    InputError
        For an unknown kind, or one of another package that cannot be loaded.
    """
    known = templates()
    if name not in known:
        if name in structure_kinds():
            structure_kind(name)  # says why it has no template
        raise InputError(
            f"there is no structure '{name}'",
            path="KIND",
            allowed=", ".join(known),
            remedy=did_you_mean(name, tuple(known)),
        )
    return known[name].template(name)
