"""What the checks of a case find: faults that stop it, warnings that go on, each with its place in the file."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import replace

from moyai.case.yaml_reader import CaseDocument, KeyPath, dotted
from moyai.core.errors import Fault, InputError

_STEP = re.compile(r"([^.\[\]]+)|\[(\d+)\]")

#: Where parameters of calls stand in the case file of any structure: the longest beginning that is named here counts.
KEYS = {
    "water_depth": "site.water_depth",
    "water_levels": "site.water_levels",
    "waves.heading": "waves.heading_deg",
    "current.heading": "current.heading_deg",
}


class Findings:
    """Collects faults and warnings on one document."""

    def __init__(self, document: CaseDocument, keys: Mapping[str, str] | None = None) -> None:
        self.document = document
        self.keys = {**KEYS, **(keys or {})}
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
        """Record an error that a call of physics raised, at the key that its parameter came from."""
        fault = error.fault
        path = self.path_of(fault.path) or default
        self.fault(path, fault.message, allowed=fault.allowed, remedy=fault.remedy)

    def located(self, error: InputError) -> InputError:
        """Return the error with the key that its parameter came from and the place of that key in the file."""
        path = self.path_of(error.fault.path)
        if not path:
            return error
        place = self.document.place(path)
        file, line, column = self.document.file, place.line, place.column
        return error.of(replace(error.fault, path=dotted(path), file=file, line=line, column=column))

    def path_of(self, text: str) -> KeyPath:
        """Return the place of a parameter (``lines.north.anchor``) or key (``lines[0].segments``) in this document.

        Empty where the case has no such place. The last step may be a key that the case leaves out.
        """
        written = self._key_of(text)
        path: list[str | int] = []
        for name, number in _STEP.findall(written):
            path.append(int(number) if number else self._entry(tuple(path), name))
        if path[:1] == ["waves"] and len(path) > 1 and ("waves", 0) not in self.document.values:
            # A single sea state stands in the file without its list
            path = [path[0], *path[2:]] if isinstance(path[1], int) else path
        if len(path) > 2 and tuple(path[:-1]) not in self.document.values:
            # Names may hold dots, and a list may stand in the file as one block
            return self._longest(written)
        return tuple(path) if path and (path[0],) in self.document.values else ()

    def _key_of(self, parameter: str) -> str:
        """Return the dotted key of a parameter; itself where :attr:`keys` does not name it."""
        head, tail = parameter, ""
        while head and head not in self.keys:
            head, _, last = head.rpartition(".")
            tail = f".{last}{tail}"
        return self.keys[head] + tail if head else parameter

    def _entry(self, path: KeyPath, name: str) -> str | int:
        """Return the number of the entry of a list that has a name; the name itself where there is no such list."""
        if (*path, 0) not in self.document.values:
            return name
        block = self.document.data
        for step in path:
            block = block[step]
        names = [entry.get("name") if isinstance(entry, dict) else None for entry in block]
        return names.index(name) if name in names else name

    def _longest(self, text: str) -> KeyPath:
        """Return the longest path of the document that a dotted text begins with."""
        best: KeyPath = ()
        for path in self.document.values:
            words = dotted(path)
            if len(path) > len(best) and (text == words or text.startswith((f"{words}.", f"{words}["))):
                best = path
        return best


def duplicates(names: Sequence[str]) -> list[int]:
    """Return the indices of names that an earlier one has already."""
    return [index for index, name in enumerate(names) if name in names[:index]]
