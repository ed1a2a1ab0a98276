"""What page, server and the process of the drafts say to each other."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

VERSION = 1
"""Version of the messages between server and page (docs/tutorial/app.md)."""
END = b""
"""Follows the last answer to a wish."""
STALE = b'{"version":1,"message":"stale"}\n'


@dataclass(frozen=True)
class Pin:
    """A state of a case that is kept to compare with."""

    key: str
    name: str
    text: str


@dataclass(frozen=True)
class Wish:
    """What is asked of the process of the drafts."""

    #: The case.
    text: str
    #: Where the case stands, or would stand.
    file: Path
    #: Folder out of which no file is read.
    root: Path
    #: Numbers to put at paths, in the unit as written.
    edits: Mapping[str, str] = field(default_factory=dict)
    #: States that are drawn faint under this one.
    pins: tuple[Pin, ...] = ()
    #: Sections and figures of the report that are on the screen: the first draft has them.
    shown: tuple[str, ...] = ()
    #: Water level that is chosen there.
    level: str = ""


def message(kind: str, /, **content: Any) -> bytes:
    """Return a message to the page as a line of JSON."""
    from moyai.report.encoding import page_json

    return page_json({"version": VERSION, "message": kind, **content}).encode() + b"\n"
