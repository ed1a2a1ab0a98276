"""The structure with all its lines, and with each of them lost."""

from __future__ import annotations

from typing import Any

from moyai.case.paths import resolve, value_of
from moyai.core.errors import InputError
from moyai.study import schema
from moyai.study.axes import Axis, Point, StudyBase


def lines_lost(given: schema.LinesLost | bool, ground: StudyBase) -> tuple[Axis, ...]:
    """Return the axis of the intact structure and one line less of every group."""
    settings = schema.LinesLost() if given is True else given
    assert isinstance(settings, schema.LinesLost)
    path, lines = _place_of_lines(settings.path, ground.base)
    if isinstance(lines, dict) and not all(isinstance(value, dict) for value in lines.values()):
        # A list of one may stand in the file as a block
        raise InputError("the only line of the structure cannot be lost", path="lines_lost")
    if not isinstance(lines, (list, dict)) or not lines:
        raise InputError(
            f"the case has no list '{settings.path}' of which one could be lost",
            path="lines_lost",
            allowed=", ".join(_lists(ground.base)) or "no list of blocks is in this case",
            remedy="name the list under 'path', or write the losses as a 'list' of cases with 'set' and 'remove'",
        )
    points = [Point("intact")] if settings.intact else []
    if isinstance(lines, dict):
        entries = [(str(key), f"{path}.{key}", line) for key, line in lines.items()]
    else:
        entries = [(_name_of(line, index), f"{path}[{index}]", line) for index, line in enumerate(lines)]
    for name, where, line in entries:
        count = line.get("count", 1) if isinstance(line, dict) else 1
        if isinstance(count, int) and count > 1:
            points.append(Point(f"one of {name}", ((f"{where}.count", count - 1),)))
        elif len(lines) > 1:
            points.append(Point(name, removals=(where,)))
        else:
            raise InputError("the only line of the structure cannot be lost", path="lines_lost")
    return (Axis(settings.name, tuple(points), lost_line=True),)


def _name_of(line: Any, index: int) -> str:
    return str(line.get("name", index)) if isinstance(line, dict) else str(index)


def _place_of_lines(path: str, base: Any) -> tuple[str, Any]:
    """Return where the lines stand, and the lines; where the path is the usual one, wherever the case has 'lines'."""
    try:
        lines = value_of(base, resolve(base, path)[0])
    except InputError:
        lines = None
    if lines is None and path == schema.LinesLost().path:
        found = [place for place in _lists(base) if place.rpartition(".")[2] == path]
        if len(found) == 1:
            return found[0], value_of(base, resolve(base, found[0])[0])
    return path, lines


def _lists(data: Any, place: str = "") -> list[str]:
    """Return the paths of all lists, or blocks of named entries, of which one could be lost."""
    found: list[str] = []
    for key, value in data.items() if isinstance(data, dict) else ():
        where = f"{place}.{key}" if place else str(key)
        entries = value if isinstance(value, list) else list(value.values()) if isinstance(value, dict) else []
        if key not in ("waves", "site") and len(entries) > 1 and all(isinstance(item, dict) for item in entries):
            found.append(where)
        found += _lists(value, where)
    return found
