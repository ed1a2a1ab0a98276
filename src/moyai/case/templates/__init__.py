"""Commented case files to start from, one for every kind of structure."""

from __future__ import annotations

from importlib.resources import files

from moyai.case.faults import did_you_mean
from moyai.case.schema import STRUCTURE_KINDS
from moyai.core.errors import InputError


def template(kind: str) -> str:
    """Return the commented case file of a kind of structure.

    Raises
    ------
    InputError
        For an unknown kind.
    """
    if kind not in STRUCTURE_KINDS:
        raise InputError(
            f"there is no structure '{kind}'",
            path="KIND",
            allowed=", ".join(STRUCTURE_KINDS),
            remedy=did_you_mean(kind, STRUCTURE_KINDS),
        )
    return (files(__package__) / f"{kind}.yaml").read_text(encoding="utf-8")
