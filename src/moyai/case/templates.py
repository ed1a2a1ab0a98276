"""Commented case files to start from: one for every kind of structure, and for the files of other commands."""

from __future__ import annotations

from moyai.case.faults import did_you_mean
from moyai.core.errors import InputError
from moyai.core.kinds import Kind, structure_kind, structure_kinds, templates


def kinds_of_files() -> tuple[tuple[str, str], ...]:
    """Return the name of every template and what its file is for, in a line."""
    return tuple((name, _first_comment(kind.template(name))) for name, kind in templates().items())


def _first_comment(text: str) -> str:
    line = text.splitlines()[0].lstrip("# ")
    return line.split(". ")[0].rstrip(".")


def template(name: str) -> str:
    """Return the commented case file of a kind of structure, or the file of another command.

    Raises
    ------
    InputError
        For an unknown kind, or one of another package that cannot be loaded.
    """
    return kind_of_file(name).template(name)


def kind_of_file(name: str) -> Kind:
    """Return who reads a file of this name, a case of a structure or the file of another command.

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
            f"there is no file of kind '{name}'",
            path="KIND",
            allowed=", ".join(known),
            remedy=did_you_mean(name, tuple(known)),
        )
    return known[name]
