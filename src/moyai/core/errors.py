"""Errors that a user can act on: where, what, the allowed range, how to correct it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Self


@dataclass(frozen=True)
class Fault:
    """One fault of an input, worded for the person who wrote it."""

    #: What is wrong, with the value that was found.
    message: str
    #: Dotted path of the key (``structure.section.beam``) or the name of the parameter of the call.
    path: str = ""
    #: The allowed range or form, empty when the message says it.
    allowed: str = ""
    #: How to correct it, for instance ``did you mean 'draught'?``.
    remedy: str = ""
    #: Name of the file; empty where there is none.
    file: str = ""
    #: Line in the file, 1-based; 0 where there is none.
    line: int = 0
    #: Column in the line, 1-based; 0 where there is none.
    column: int = 0

    def __str__(self) -> str:
        place = ""
        if self.file:
            place = f"{self.file}:{self.line}:{self.column}: " if self.line else f"{self.file}: "
        parts = [self.message]
        if self.allowed:
            parts.append(f"allowed: {self.allowed}")
        if self.remedy:
            parts.append(self.remedy)
        return place + (f"{self.path}: " if self.path else "") + "; ".join(parts)


class MoyaiError(Exception):
    """Base of all errors raised on purpose: one clear message, no traceback needed.

    Parameters
    ----------
    message, allowed, remedy : str
        As in :class:`Fault`.
    parameter : str
        What a call of physics names: its own parameter, with further names behind dots (``skirt.length``). Where a case
        file stands behind the call, :mod:`moyai.case.findings` finds the key that the parameter came from.
    path : str
        What a reader of files or a command names: a key, a column or an option.
    """

    def __init__(
        self, message: str, *, parameter: str = "", path: str = "", allowed: str = "", remedy: str = ""
    ) -> None:
        self.fault = Fault(message=message, path=path or parameter, allowed=allowed, remedy=remedy)
        super().__init__(str(self.fault))

    def at(self, path: str) -> Self:
        """Return the error with another key or parameter.

        Parameters
        ----------
        path : str
            Key of the file, or parameter of the call.
        """
        return self.of(replace(self.fault, path=path))

    @classmethod
    def of(cls, fault: Fault) -> Self:
        """Return the error of a fault, with its place in a file.

        Parameters
        ----------
        fault : Fault
            What is wrong, and where.
        """
        error = cls(fault.message)
        error.fault, error.args = fault, (str(fault),)
        return error


class InputError(MoyaiError, ValueError):
    """An argument or an entry of a case is outside what is physically or formally allowed."""


class ConvergenceError(MoyaiError, RuntimeError):
    """A solver did not reach its tolerance; the message holds the residual and what to try."""


class CaseError(MoyaiError):
    """All errors of one case file at once."""

    def __init__(self, faults: Sequence[Fault]) -> None:
        self.faults = tuple(faults)
        count = len(self.faults)
        super().__init__(f"{count} fault{'s' if count != 1 else ''}")
        self.args = ("\n".join(str(fault) for fault in self.faults),)


def system_words(error: OSError) -> str:
    """Return what the system refused, without its number."""
    return f"{error.filename}: {error.strerror}" if error.filename else str(error.strerror or error)
