"""Change one number of a case in its text: comments, order, spaces and the unit stay as they were written.

The reader knows line and column of every value, so that only the characters of the number change; the text is read
again after the change, and the change is refused unless it is the only difference.
"""

from __future__ import annotations

import copy
import re
from dataclasses import dataclass
from typing import Any

from moyai.case.paths import assign, resolve, value_of
from moyai.case.yaml_reader import CaseDocument, core_scalar, parse_yaml
from moyai.core.errors import InputError

_TOKEN = re.compile(
    r"(?P<quote>['\"]?)(?P<number>[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?)"
    r"(?P<space>[ \t]*)(?P<unit>(?![-+\d.])[^\s,\]}#:'\"\[{][^,\]}#'\"\[{\r\n:]*?)?(?P=quote)"
    r"(?=[ \t]*(?:[,\]}]|[ \t]#|\r?\n|\r?\Z))"
)


@dataclass(frozen=True)
class Written:
    """A number as it stands in a text."""

    #: In the unit as written.
    value: float
    unit: str
    #: First character of the digits.
    start: int
    #: Character behind the digits.
    end: int


def number_at(document: CaseDocument, path: str) -> Written | None:
    """Return the number that stands at a path, ``None`` where there is none or it cannot be changed alone.

    Parameters
    ----------
    document : Document
    path : str
        Keys joined by dots, entries of a list by number or name in brackets.
    """
    try:
        places = resolve(document.data, path)
    except InputError:
        return None
    if len(places) != 1 or (place := document.values.get(tuple(places[0]))) is None:
        return None
    lines = document.text.splitlines(keepends=True)
    if place.line > len(lines):
        return None
    before = sum(map(len, lines[: place.line - 1]))
    found = _TOKEN.match(document.text, before + place.column - 1)
    if found is None:
        return None
    value = value_of(document.data, places[0])
    if isinstance(value, bool) or isinstance(value, str) != bool(found["unit"] or found["quote"]):
        return None
    return Written(float(found["number"]), (found["unit"] or "").strip(), *found.span("number"))


def with_number(document: CaseDocument, path: str, number: str) -> CaseDocument:
    """Return the document with another number at a path, in the unit as written.

    Parameters
    ----------
    document : Document
    path : str
    number : str
        Digits as they are to stand in the text.

    Raises
    ------
    InputError
        When there is no number, or the text holds it in a way that others share (an anchor).
    """
    value = core_scalar(number)
    if isinstance(value, bool) or not isinstance(value, int | float) or not abs(value) < 1e300:
        raise InputError(f"{number!r} is no number", path=path)
    found = number_at(document, path)
    if found is None:
        raise InputError("there is no number that can be changed here", path=path, remedy="change it in the text")
    text = document.text[: found.start] + number + document.text[found.end :]
    changed = parse_yaml(text, document.file)
    if changed.data != _assigned(document, path, number, found):
        raise InputError("other places share this number", path=path, remedy="change it in the text")
    return changed


def _assigned(document: CaseDocument, path: str, number: str, found: Written) -> Any:
    data = copy.deepcopy(document.data)
    place = resolve(data, path)[0]
    old = value_of(data, place)
    digits = document.text[found.start : found.end]
    new = old.replace(digits, number, 1) if isinstance(old, str) else core_scalar(number)
    assign(data, place, new)
    return data
