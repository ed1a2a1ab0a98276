"""Dotted paths into a case file: ``waves[design storm].significant_height``, ``lines[*].segments[0].length``."""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

from moyai.case.faults import did_you_mean
from moyai.case.yaml_reader import KeyPath, dotted
from moyai.core.errors import InputError

EVERY = "*"

_STEP = re.compile(r"\s*(?:\.?(?P<key>[^.\[\]]+)|\[(?P<entry>[^\[\]]*)\])")


@dataclass(frozen=True)
class Step:
    """One step of a path."""

    #: Key of a block, or number, name or ``*`` of the entries of a list.
    word: str
    #: Whether it stood in brackets, which only the entries of a list may do.
    in_brackets: bool


def split_path(text: str) -> tuple[Step, ...]:
    """Return the steps of a path.

    Raises
    ------
    InputError
        When the text is no path.
    """
    steps = []
    position = 0
    while position < len(text):
        found = _STEP.match(text, position)
        word = "" if found is None else (found["key"] or found["entry"] or "").strip()
        if found is None or not word:
            raise InputError(
                f"'{text}' is no path into a case file",
                path=text,
                allowed="keys joined by dots, entries of a list in brackets: lines[0].segments[0].length",
            )
        steps.append(Step(word, found["entry"] is not None))
        position = found.end()
    if not steps:
        raise InputError("the path is empty", allowed="for instance waves[0].height")
    return tuple(steps)


def resolve(data: Any, text: str) -> tuple[KeyPath, ...]:
    """Return every place of a case that a path means.

    Parameters
    ----------
    data : object
        Content of the case file as it was read.
    text : str
        The path. An entry of a list is given by its number (from 0), its ``name``, or ``*`` for all. The last may be
        one that the case leaves at its default; everything above it must be there.

    Returns
    -------
    tuple of tuple
        Places as the YAML reader writes them.

    Raises
    ------
    InputError
        When the case has no such place, with the nearest that it has.
    """
    places: list[KeyPath] = [()]
    steps = split_path(text)
    for number, step in enumerate(steps):
        last = number == len(steps) - 1
        places = [further for place in places for further in _follow(data, place, step, text, last)]
    return tuple(places)


def value_of(data: Any, place: KeyPath) -> Any:
    """Return the value at a place; ``None`` where the case leaves it at its default."""
    for item in place:
        if isinstance(data, dict):
            data = data.get(item)
        else:
            data = data[item]
    return data


def assign(data: Any, place: KeyPath, value: Any) -> None:
    """Put a value at a place of ``data``."""
    block = value_of(data, place[:-1])
    block[place[-1]] = value


def remove(data: Any, place: KeyPath) -> None:
    """Take a key or an entry out of ``data``."""
    block = value_of(data, place[:-1])
    if isinstance(block, dict):
        block.pop(place[-1], None)
    else:
        del block[place[-1]]


def _follow(data: Any, place: KeyPath, step: Step, text: str, last: bool) -> list[KeyPath]:
    block = value_of(data, place)
    if isinstance(block, list):
        return [(*place, index) for index in _entries(block, step, place, text)]
    if not isinstance(block, dict):
        where = dotted(place) or "the case"
        raise InputError(f"there is nothing below '{where}'", path=text, remedy="end the path there")
    if step.in_brackets or step.word not in block:
        # A list of one may stand in the file as a block
        if (step.in_brackets and step.word in ("0", EVERY)) or str(block.get("name", "")) == step.word:
            if step.in_brackets and {"from", "to"} <= block.keys():
                where = dotted(place)
                said = f"'{where}' is a range from ... to, which has no entries"
                raise InputError(said, path=text, remedy=f"replace it as a whole: '{where}'")
            return [place]
        if not last or step.in_brackets:
            raise _absent(step.word, block, place, text)
    return [(*place, step.word)]


def _entries(block: list[Any], step: Step, place: KeyPath, text: str) -> list[int]:
    if step.word == EVERY:
        return list(range(len(block)))
    if re.fullmatch(r"\d+", step.word):
        index = int(step.word)
        if index >= len(block):
            count = len(block)
            raise InputError(
                f"'{dotted(place)}' has {count} entr{'y' if count == 1 else 'ies'}, so there is no [{index}]",
                path=text,
                allowed=f"0 to {count - 1}",
            )
        return [index]
    names = [str(entry.get("name", "")) if isinstance(entry, dict) else "" for entry in block]
    found = [index for index, name in enumerate(names) if name == step.word]
    if not found:
        raise _absent(step.word, [name for name in names if name], place, text, "entry")
    return found


def _absent(word: str, known: Iterable[str], place: KeyPath, text: str, what: str = "key") -> InputError:
    names = [str(name) for name in known]
    listed = ", ".join(names[:12]) or "none"
    where = f"in '{dotted(place)}'" if place else "in the case"
    return InputError(
        f"there is no {what} '{word}' {where}; it has {listed}", path=text, remedy=did_you_mean(word, names)
    )
