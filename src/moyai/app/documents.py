"""Open cases: their text, what came before it, what is pinned. All of it lives here, so that a reload loses nothing."""

from __future__ import annotations

import contextlib
import secrets
import time
from pathlib import Path
from typing import Any

from moyai.app.folder import CASE_ENDINGS, Folder
from moyai.app.messages import Pin
from moyai.case.templates import template
from moyai.case.yaml_text import decode, encode_like
from moyai.core.errors import InputError, MoyaiError
from moyai.core.files import write_whole
from moyai.language.comments import with_comments

_STEPS = 200
_LARGEST = 2_000_000
_PAUSE = 2.0
"""Seconds after which a further change of the same kind is a step of its own."""


class OpenCase:
    """A case that is open in the page.

    Parameters
    ----------
    key : str
        Part of its address.
    name : str
        File relative to the chosen folder; where it would be saved if it was never.
    text : str
        As it is now.
    saved : str, optional
        As the file has it; None where there is no file.

    Attributes
    ----------
    turn : int
        How often the text was changed.
    standing : {"same", "gone", "changed"}
        How the file stands to ``saved`` since another program was at work.
    pins : tuple of Pin
        States that are drawn faint under this one.
    earlier : list of str
        What undo goes back to.
    """

    def __init__(self, key: str, name: str, text: str, saved: str | None = None) -> None:
        self.key = key
        self.name = name
        self.text = text
        self.saved = saved
        self.standing = "same"
        self.turn = 0
        self.pins: tuple[Pin, ...] = ()
        self.earlier: list[str] = []
        self.changed: tuple[str, float] = ("", 0.0)

    def change(self, text: str, gesture: str) -> None:
        """Take another text; changes of one gesture are undone together.

        Parameters
        ----------
        text : str
        gesture : str
            What changes it: a slider, typing.
        """
        if text == self.text:
            return
        before, when = self.changed
        now = time.monotonic()
        if before != gesture or now - when > _PAUSE or not self.earlier:
            self.earlier = [*self.earlier[-_STEPS:], self.text]
        self.changed = (gesture, now)
        self.text = text
        self.turn += 1

    def undo(self) -> None:
        """Go back one step, if there is one."""
        if self.earlier:
            self.text = self.earlier.pop()
            self.turn += 1
        self.changed = ("", 0.0)

    @property
    def unsaved(self) -> bool:
        """Whether the file does not hold this text."""
        return self.text != self.saved or self.standing != "same"

    def record(self) -> dict[str, Any]:
        """Return what the page needs to show it."""
        return {
            "id": self.key,
            "name": self.name,
            "text": self.text,
            "unsaved": self.unsaved,
            "file": self.standing,
            "pins": [{"id": pin.key, "name": pin.name} for pin in self.pins],
            "can_undo": bool(self.earlier),
        }


class Documents:
    """All open cases.

    Parameters
    ----------
    folder : Folder
    """

    def __init__(self, folder: Folder) -> None:
        self._folder = folder
        self._open: dict[str, OpenCase] = {}

    def __getitem__(self, key: str) -> OpenCase:
        return self._open[key]

    def recent(self) -> list[dict[str, Any]]:
        """Return the open cases, the last opened first."""
        return [{"id": one.key, "file": one.name} for one in reversed(self._open.values())]

    def open_template(self, name: str) -> OpenCase:
        """Open the template of a kind, its comments in the language in force, under a name that no file has."""
        return self.open_text(name, with_comments(template(name)))

    def open_text(self, stem: str, text: str) -> OpenCase:
        """Open a text under a name that no file and no open case has; ``stem`` may lead through folders."""
        taken = {one.name for one in self._open.values()}
        file, count = f"{stem}.yaml", 2
        while file in taken or (self._folder.root / file).exists():
            file, count = f"{stem}_{count}.yaml", count + 1
        return self._added(OpenCase(_key(), file, text))

    def open_file(self, name: str) -> OpenCase:
        """Open a case file of the folder; one that is open already as it is now.

        Raises
        ------
        InputError
            When it is outside the folder or no case file.
        CaseError
            When it is no text.
        """
        path = self._folder.inside(name)
        name = path.relative_to(self._folder.root).as_posix()
        known = next((one for one in self._open.values() if one.name == name), None)
        if known is not None:
            return self._added(self._open.pop(known.key))
        if path.suffix not in CASE_ENDINGS or not path.is_file() or path.stat().st_size > _LARGEST:
            raise InputError(f"{name!r} is no case file", path="file", allowed="files .yaml and .yml up to 2 MB")
        text = decode(path.read_bytes(), name)
        return self._added(OpenCase(_key(), name, text, saved=text))

    def look(self, document: OpenCase) -> OpenCase:
        """Take what another program has written to the file of a case that has no changes of its own."""
        if document.saved is None:
            return document
        written = self._written(document.name)
        if written is not None and document.text == document.saved:
            document.change(written, "file")
            document.saved = written
        document.standing = "gone" if written is None else "same" if written == document.saved else "changed"
        return document

    def settle(self, document: OpenCase, take: bool) -> None:
        """Take the text that another program has written, or keep that of the page, which Save then writes over it."""
        written = self._written(document.name)
        if take and written is not None:
            document.change(written, "file")
        document.saved, document.standing = written, "same"

    def save(self, document: OpenCase, name: str = "") -> None:
        """Write a case to its file as that was written, or to another of the folder that does not exist yet.

        Raises
        ------
        InputError
            When the name is outside the folder, no case file, or another's.
        """
        path, own = self._folder.inside(name or document.name), self._folder.inside(document.name)
        file = path.relative_to(self._folder.root).as_posix()
        if path.suffix not in CASE_ENDINGS:
            raise InputError(f"{file!r} is no name of a case file", path="file", remedy="give it the ending .yaml")
        if path.exists() and (document.saved is None or path != own):
            raise InputError(f"{file!r} exists", path="file", remedy="choose another name")
        if path.exists() and self._written(file) not in (document.saved, document.text):
            raise InputError(f"{file!r} was changed by another program", path="file", remedy="choose another name")
        write_whole(path, encode_like(document.text, own.read_bytes() if own.is_file() else b""))
        document.name, document.saved, document.standing = file, document.text, "same"

    def _written(self, name: str) -> str | None:
        """Return the text of a file as it stands there, None where it cannot be read."""
        with contextlib.suppress(OSError, MoyaiError):
            path = self._folder.inside(name)
            if path.is_file() and path.stat().st_size <= _LARGEST:
                return decode(path.read_bytes(), name)
        return None

    def _added(self, document: OpenCase) -> OpenCase:
        self._open[document.key] = document
        return document


def _key() -> str:
    return secrets.token_hex(6)


def stem_of(name: str) -> str:
    """Return the name of a file without folders and ending."""
    return Path(name).stem or "case"
