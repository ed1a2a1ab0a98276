"""Commented case files to start from: one for every kind of structure, and for the files of other commands."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from moyai.case.faults import did_you_mean
from moyai.core.errors import InputError
from moyai.core.kinds import Kind, further_files, structure_kind, structure_kinds, templates

# Keys that files of several kinds have
_COMMON = ("moyai", "title", "site", "density", "gravity")


def kinds_of_files() -> tuple[tuple[str, str], ...]:
    """Return the name of every template and what its file is for, in a line."""
    return tuple((name, _first_comment(kind.template(name))) for name, kind in templates().items())


def _first_comment(text: str) -> str:
    line = text.splitlines()[0].lstrip("# ")
    return line.split(". ")[0].rstrip(".")


def template(name: str) -> str:
    """Return the commented case file of a kind of structure, or the file of another command.

    Parameters
    ----------
    name : str
        Kind of structure, for instance ``breakwater``, or name of another command's file, for instance ``study``.

    Returns
    -------
    str
        Text of a YAML file that runs as it stands.

    Raises
    ------
    InputError
        For an unknown kind, or one of another package that cannot be loaded.

    Examples
    --------
    >>> from moyai.case import template
    >>> "kind: member" in template("member")
    True
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


def next_command(name: str, file: object) -> str:
    """Return the command that reads a file of this kind."""
    if name == "study":
        return f"moyai study {file} --check"
    if name == "fit":
        return f"moyai fit {file}"
    if name == "forces":
        return f"moyai measure forces RECORD.csv --config {file}"
    return f"moyai measure {name} {file}" if name in further_files() else f"moyai check {file}"


def kind_by_keys(content: Mapping[str, Any]) -> str | None:
    """Return the kind of a file that is no case of a structure: it knows three of four of its own keys.

    Parameters
    ----------
    content : mapping
        The keys of the file.

    Returns
    -------
    str or None
        Name as ``moyai new`` takes it; ``None`` when no kind knows enough of the keys.
    """
    own = [key for key in content if key not in _COMMON]
    known = {name: _share(own, kind.file_schema(name).key_names()) for name, kind in further_files().items()}
    best = max(known, key=lambda name: known[name])
    return best if known[best] >= 0.75 else None


def _share(keys: list[str], known: tuple[str, ...]) -> float:
    return sum(key in known for key in keys) / max(len(keys), 1)
