"""The chosen folder: no path leads out of it, neither by climbing nor through symbolic links."""

from __future__ import annotations

import contextlib
import re
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from moyai.case.reader import named_files
from moyai.case.yaml_reader import CaseDocument, KeyPath
from moyai.core.errors import CaseError, InputError

CASE_ENDINGS = (".yaml", ".yml")
_FILE_KEYS = (("file",), ("path",))
_MOST_FILES = 200
_DEEPEST = 4
_KIND = re.compile(r"^structure:(?:.|\n)*?\bkind:\s*(\w+)", re.MULTILINE)
_JOB = re.compile(r"^(study|fit):", re.MULTILINE)
_JOB_TITLE = re.compile(r"^\s+title:\s*(.+?)\s*(?:#.*)?$", re.MULTILINE)
_TITLE = re.compile(r"^title:\s*(.+?)\s*(?:#.*)?$", re.MULTILINE)


@dataclass(frozen=True)
class Folder:
    """A folder whose files the app may read and write."""

    #: Absolute, links resolved.
    root: Path
    #: Where results are put; within ``root`` unless the user named another on the command line.
    output: Path

    def inside(self, name: str) -> Path:
        """Return the file of a name relative to the folder.

        Raises
        ------
        InputError
            When the name leads out of the folder.
        """
        return within(self.root, self.root / name, name)

    def case_files(self) -> list[dict[str, str]]:
        """Return the case, study and fit files of the folder: name, kind and title, the newest first."""
        found: list[tuple[float, dict[str, str]]] = []
        for path in self._candidates():
            with contextlib.suppress(OSError):  # gone meanwhile, or not for us to read
                text = path.read_text(encoding="utf-8", errors="replace")[:20_000]
                kind = _KIND.search(text) or _JOB.search(text)
                if kind is None:
                    continue
                title = (_TITLE if kind.re is _KIND else _JOB_TITLE).search(text)
                name = path.relative_to(self.root).as_posix()
                record = {"file": name, "kind": kind[1], "title": title[1].strip("'\"") if title else name}
                found.append((path.stat().st_mtime, record))
        return [record for _, record in sorted(found, key=lambda item: -item[0])]

    def _candidates(self) -> list[Path]:
        found: list[Path] = []
        waiting = [(self.root, 0)]
        while waiting and len(found) < _MOST_FILES:
            folder, depth = waiting.pop(0)
            with contextlib.suppress(OSError):
                for entry in sorted(folder.iterdir()):
                    if entry.is_symlink() or entry.name.startswith(".") or entry == self.output:
                        continue
                    if entry.is_dir() and depth < _DEEPEST:
                        waiting.append((entry, depth + 1))
                    elif entry.suffix in CASE_ENDINGS and entry.is_file() and entry.stat().st_size < 1_000_000:
                        found.append(entry)
        return found[:_MOST_FILES]


def within(root: Path, path: Path, shown: str) -> Path:
    """Return a path with its links resolved.

    Raises
    ------
    InputError
        When it is outside ``root`` or cannot be a path.
    """
    try:
        target = path.resolve()
    except (OSError, ValueError, RuntimeError):
        raise InputError(f"{shown!r} is no path", path="file") from None
    if not target.is_relative_to(root):
        raise InputError(
            f"{shown!r} is outside the folder of the app",
            path="file",
            allowed=f"files in {root}",
            remedy="start 'moyai app' with a folder that holds it",
        )
    return target


def refuse_foreign_files(root: Path, folder: Path, document: CaseDocument) -> None:
    """Refuse a case that names files outside the chosen folder.

    Parameters
    ----------
    root : Path
        The chosen folder, links resolved.
    folder : Path
        Folder of the case.
    document : Document
        The case.

    Raises
    ------
    CaseError
        With the line of the first name.
    """
    for name in sorted(named_files(document.data)):
        try:
            target = within(root, folder / name, name)
            for member in target.rglob("*") if target.is_dir() else ():
                within(root, member, f"{name}/{member.name}")
        except InputError as error:
            named = (path for path in document.values if path[-1:] in _FILE_KEYS and _at(document, path) == name)
            fault = error.fault
            raise CaseError(
                [document.fault(next(named, ()), fault.message, allowed=fault.allowed, remedy=fault.remedy)]
            ) from None


def _at(document: CaseDocument, path: KeyPath) -> Any:
    found = document.data
    with contextlib.suppress(KeyError, IndexError, TypeError):
        for step in path:
            found = found[step]
    return found
