"""Commented case files to start from, one for every kind of structure."""

from __future__ import annotations

from importlib.resources import files

from moyai.case.faults import did_you_mean
from moyai.case.schema import STRUCTURE_KINDS
from moyai.core.errors import InputError

FURTHER = ("rigid_cage", "nets", "records", "study")
"""Further models of a structure and files of other commands that have a template too."""


def template(kind: str) -> str:
    """Return the commented case file of a kind of structure, or the file of another command.

    Raises
    ------
    InputError
        For an unknown kind.
    """
    kinds = (*STRUCTURE_KINDS, *FURTHER)
    if kind not in kinds:
        raise InputError(
            f"there is no structure '{kind}'",
            path="KIND",
            allowed=", ".join(kinds),
            remedy=did_you_mean(kind, kinds),
        )
    return (files(__package__) / f"{kind}.yaml").read_text(encoding="utf-8")
