"""Pinned states of a case: kept with a name, run once, drawn faint under the live one."""

from __future__ import annotations

import hashlib
import secrets
from collections.abc import Callable, Iterable
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from moyai.app.folder import refuse_foreign_files
from moyai.app.messages import Pin, Wish
from moyai.app.stages import stages_of
from moyai.case.reader import case_of
from moyai.case.yaml_reader import CaseDocument, parse_yaml
from moyai.core.errors import InputError, MoyaiError
from moyai.core.progress import Progress

if TYPE_CHECKING:
    from moyai.core.results import Result
    from moyai.report.differences import Other

MOST = 6
_LONGEST = 40

Run = Callable[..., "Result"]


def with_pin(pins: tuple[Pin, ...], name: str, text: str) -> tuple[Pin, ...]:
    """Return the pins of a case with one more, under a name that no other has.

    Raises
    ------
    InputError
        Where there are :data:`MOST` already.
    """
    if len(pins) >= MOST:
        raise InputError(f"{len(pins)} states are pinned", path="pin", allowed=f"at most {MOST}", remedy="unpin one")
    return (*pins, Pin(secrets.token_hex(4), _free(name, pins), text))


def renamed(pins: tuple[Pin, ...], key: str, name: str) -> tuple[Pin, ...]:
    """Return the pins with another name of one of them."""
    rest = [pin for pin in pins if pin.key != key]
    return tuple(replace(pin, name=_free(name, rest)) if pin.key == key else pin for pin in pins)


def _free(name: str, pins: Iterable[Pin]) -> str:
    plain = " ".join(name.split())[:_LONGEST] or "1"
    taken, count, free = {pin.name for pin in pins}, 1, plain
    while free in taken:
        count += 1
        free = f"{plain} #{count}"
    return free


class Pinned:
    """The results of pinned states, each run once with the analyses that it is shown with.

    Parameters
    ----------
    run : callable
        As of :class:`moyai.app.draft.Drafts`.
    keep : Path
        Folder of coefficients.
    """

    def __init__(self, run: Run, keep: Path) -> None:
        self._run = run
        self._keep = keep
        self._known: dict[str, Other | None] = {}

    def of(self, pins: Iterable[Pin], wish: Wish, shown: CaseDocument, progress: Progress | None) -> list[Other]:
        """Return the results of pins, those that cannot be run left out.

        Parameters
        ----------
        pins : iterable of Pin
        wish : Wish
        shown : Document
            With the analyses of the report under which they are drawn.
        progress : Progress or None
            None leaves out what would have to be run: a first draft does not wait for it.
        """
        found = []
        for pin in pins:
            mark = hashlib.sha256(repr((pin.text, wish.file, shown.data["analyses"])).encode()).hexdigest()
            if mark not in self._known and progress is not None:
                while len(self._known) > 3 * MOST:
                    self._known.pop(next(iter(self._known)))
                self._known[mark] = self._made(pin, wish, shown, progress)
            other = self._known.get(mark)
            if other is not None:
                found.append(replace(other, name=pin.name))
        return found

    def _made(self, pin: Pin, wish: Wish, shown: CaseDocument, progress: Progress) -> Other | None:
        from moyai.report.differences import Other
        from moyai.report.writer import compose_document

        try:
            document = parse_yaml(pin.text, wish.file.name)
            refuse_foreign_files(wish.root, wish.file.parent, document)
            kind = case_of(document, wish.file).kind
            data: dict[str, Any] = stages_of(document, kind)[-1].data
            data = {**data, "analyses": shown.data["analyses"]}
            result = self._run(case_of(replace(document, data=data), wish.file), progress, keep=self._keep)
        except MoyaiError:
            return None
        return Other(pin.name, result, compose_document(result))
