"""The cases of a study while it runs: a table of those that have ended, and the text of any of them."""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from moyai.case.paths import resolve
from moyai.case.reader import written
from moyai.case.text_changes import with_key, with_scalar, without_key
from moyai.case.yaml_reader import CaseDocument, parse_yaml, read_yaml
from moyai.core.errors import InputError
from moyai.core.files import write_whole
from moyai.language import said
from moyai.study.ledger import NAME, read_records

if TYPE_CHECKING:
    from moyai.study.definition import Study

PLAN = "cases.json"
_ROWS = 500
_COLUMNS = 6
_ASKED = ("utilisation", "maximum", "motion", "transmission", "tension", "offset", "reduction")
"""Words of the responses that are shown before others."""


def write_cases(plan: Study, block: Mapping[str, Any], folder: Path) -> None:
    """Write what makes each case of a study next to its results.

    Parameters
    ----------
    plan : Study
    block : mapping
        ``study`` of the file.
    folder : Path
        Of the results.
    """
    cases = [
        {"labels": list(case.labels), "set": [list(pair) for pair in case.assignments], "remove": list(case.removals)}
        for case in plan.cases
    ]
    record = {
        "base": str(plan.base_path.resolve()),
        "axes": [axis.name for axis in plan.axes],
        "shared": [list(pair) for pair in block.get("set", {}).items()],
        "cases": cases,
    }
    write_whole(folder / PLAN, json.dumps(record, default=str).encode())


def table_of(folder: Path) -> dict[str, Any]:
    """Return the cases of a study so far: columns and rows, one a case that ended; none where it has not begun."""

    plan = _plan(folder) if (folder / PLAN).is_file() else {"axes": [], "cases": []}
    path = folder / NAME
    latest = {record.index: record for record in read_records(path)} if path.is_file() else {}
    records = [latest[index] for index in sorted(latest)]
    chosen = _most_varying([_numbers(record.values) for record in records])
    rows = [
        {
            "case": record.index,
            "labels": plan["cases"][record.index]["labels"] if record.index < len(plan["cases"]) else [],
            "status": said(record.status.replace("_", " ")),
            "message": said(record.message),
            "values": [_numbers(record.values).get(name) for name in chosen],
        }
        for record in records[:_ROWS]
    ]
    known = {name: item for record in records[:1] for name, item in record.values.items()}
    heads = [_head(name, known.get(name, {})) for name in chosen]
    ended, total = len(records), len(plan["cases"])
    gathered = (folder / "study.nc").is_file()
    axes = [said(axis.removesuffix("_deg").replace("_", " ")) for axis in plan["axes"]]
    return {"axes": axes, "columns": heads, "rows": rows, "ended": ended, "total": total, "gathered": gathered}


def _head(name: str, item: Mapping[str, Any]) -> dict[str, str]:
    """Return the name of a response, what it is in words with the group that it is from, and its unit."""
    group, _, last = name.rpartition("/")
    words = str(item.get("long_name") or last.replace("_", " "))
    place = ", ".join(part for part in group.split("/") if part)
    unit = str(item.get("units", "1"))
    return {"name": name, "words": said(f"{words} ({place})" if place else words), "unit": "" if unit == "1" else unit}


def _plan(folder: Path) -> dict[str, Any]:
    path = folder / PLAN
    if not path.is_file():
        raise KeyError(PLAN)
    return dict(json.loads(path.read_text(encoding="utf-8")))


def _numbers(values: Mapping[str, Any]) -> dict[str, float]:
    """Return one number a response: itself, or the largest over its labels."""
    found = {}
    for name, item in values.items():
        held = item.get("values")
        flat = [held] if not isinstance(held, list) else list(_flat(held))
        numbers = [one for one in flat if isinstance(one, int | float) and not isinstance(one, bool) and one == one]
        if numbers and len(item.get("dims", ())) <= 1:
            found[name] = max(numbers, key=abs)
    return found


def _flat(held: list[Any]) -> Any:
    for item in held:
        if isinstance(item, list):
            yield from _flat(item)
        else:
            yield item


def _most_varying(rows: list[dict[str, float]]) -> list[str]:
    """Return the responses that differ most between the cases, relative to their size; what designs ask for first."""

    def spread(name: str) -> float:
        numbers = [row[name] for row in rows if name in row and abs(row[name]) < 1e300]
        size = max(map(abs, numbers), default=0.0)
        return (max(numbers) - min(numbers)) / size if size else 0.0

    names = list(dict.fromkeys(name for row in rows for name in row))
    asked = {name: any(word in name for word in _ASKED) for name in names}
    return sorted(names, key=lambda name: (not asked[name] or not spread(name), -min(spread(name), 1.0)))[:_COLUMNS]


def case_text(folder: Path, root: Path, index: int) -> tuple[str, Path]:
    """Return the text of a case of a study and its base case; comments of the base stay where its values can be set.

    Raises
    ------
    KeyError
        When there is no such case.
    InputError
        When the base case is outside the folder.
    """
    plan = _plan(folder)
    if not 0 <= index < len(plan["cases"]):
        raise KeyError(index)
    base = Path(plan["base"])
    if not base.is_relative_to(root):
        raise InputError("the base case is outside the folder of the app", path="study.base")
    document = read_yaml(base)
    one = plan["cases"][index]
    for path, value in (*plan["shared"], *one["set"]):
        for place in resolve(document.data, path):
            document = _put(document, place, value)
    removals = [place for path in one["remove"] for place in resolve(document.data, path)]
    for place in sorted(removals, key=lambda place: [str(item).zfill(9) for item in place], reverse=True):
        document = without_key(document, place)
    return document.text, base


def _put(document: CaseDocument, place: Any, value: Any) -> CaseDocument:
    """Return the document with a value at a place: in place where it can be, else with the key written anew."""
    from moyai.case.paths import assign

    words = value if isinstance(value, str) else json.dumps(value)
    here: Any = document.data
    for step in place[:-1]:
        here = here[step]
    try:
        if isinstance(here, dict) and place[-1] not in here:
            return with_key(document, place, value)
        if not isinstance(value, dict | list):
            return with_scalar(document, place, words, as_text=isinstance(value, str))
        if isinstance(here, dict) and len(here) > 1:
            return with_key(without_key(document, place), place, value)
    except InputError:
        pass
    data = json.loads(json.dumps(document.data))
    assign(data, place, value)
    return parse_yaml(written(data), document.file)
