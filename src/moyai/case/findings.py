"""What the checks of a case find: faults that stop it, warnings that go on, each with its place in the file."""

from __future__ import annotations

import re
from collections.abc import Sequence

from moyai.case.yaml_reader import Document, KeyPath
from moyai.core.errors import Fault, InputError

_STEP = re.compile(r"([^.\[\]]+)|\[(\d+)\]")


class Findings:
    """Collects faults and warnings on one document."""

    def __init__(self, document: Document) -> None:
        self.document = document
        self.faults: list[Fault] = []
        self.warnings: list[Fault] = []

    def fault(self, path: KeyPath, message: str, *, allowed: str = "", remedy: str = "") -> None:
        """Record what stops the case."""
        self.faults.append(self.document.fault(path, message, allowed=allowed, remedy=remedy))

    def warn(self, path: KeyPath, message: str, *, allowed: str = "", remedy: str = "") -> None:
        """Record what is odd but allowed."""
        self.warnings.append(self.document.fault(path, message, allowed=allowed, remedy=remedy))

    def sound(self, *keys: str) -> bool:
        """Whether no fault was found under any of these keys of the root."""
        return not any(_STEP.findall(fault.path)[0][0] in keys for fault in self.faults if fault.path)

    def raised(self, error: InputError, default: KeyPath) -> None:
        """Record an error that another room raised, at the path that it names."""
        fault = error.fault
        path = self.path_of(fault.path) or default
        self.fault(path, fault.message, allowed=fault.allowed, remedy=fault.remedy)

    def path_of(self, text: str) -> KeyPath:
        """Return ``lines[0].segments`` as a path of this document, empty where the case has no such place."""
        path: list[str | int] = []
        for name, number in _STEP.findall(text):
            path.append(int(number) if number else name)
        if path[:1] == ["waves"] and len(path) > 1 and ("waves", 0) not in self.document.values:
            # A single sea state stands in the file without its list
            path = [path[0], *path[2:]] if isinstance(path[1], int) else path
        return tuple(path) if path and (path[0],) in self.document.values else ()


def duplicates(names: Sequence[str]) -> list[int]:
    """Return the indices of names that an earlier one has already."""
    return [index for index, name in enumerate(names) if name in names[:index]]
