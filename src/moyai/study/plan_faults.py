"""What may be wrong with a study file beyond its schema, and where in the file it stands."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

from moyai.case.paths import resolve
from moyai.case.reader import case_of
from moyai.case.yaml_reader import CaseDocument, KeyPath, dotted
from moyai.core.errors import CaseError, Fault, InputError
from moyai.study import schema
from moyai.study.axes import Assignments, Axis, Combination, varied
from moyai.study.variations import common_unit


def check_kind(document: CaseDocument) -> None:
    """Refuse a file that is a case or a fit with one sentence."""
    data = document.data
    if isinstance(data, dict) and "study" not in data:
        if "structure" in data:
            remedy = "'moyai run FILE' runs a case; a study names it as 'base' (docs: study file)"
            raise CaseError([document.fault((), "this is a case, not a study", remedy=remedy)])
        if "fit" in data:
            raise CaseError([document.fault((), "this is a fit, not a study", remedy="'moyai fit FILE' runs it")])


def unknown_keys(axes: tuple[Axis, ...], base: CaseDocument, base_path: Path) -> list[Fault]:
    """Return the faults of keys that the case does not have, each path of the axes tried once on its own.

    Reported together with paths that lead nowhere, so that all slips of one kind are corrected in one go.
    """
    found: list[Fault] = []
    seen: set[str] = set()
    for point in (point for axis in axes for point in axis.points):
        entries = tuple(entry for entry in point.assignments if entry[0] not in seen and not entry[0].startswith("@"))
        seen |= {path for path, _ in entries}
        if not entries:
            continue
        found += faults_at(base, base_path, entries)
    return found


def faults_at(base: CaseDocument, base_path: Path, entries: Assignments) -> list[Fault]:
    """Return the faults of the case with these values, of those that are for one of their paths."""
    places = {dotted(place): path for path, _ in entries for place in resolve(base.data, path)}
    try:
        case_of(varied(base, Combination(-1, (), entries)), base_path)
    except CaseError as error:
        return [replace(fault, path=places[fault.path]) for fault in error.faults if fault.path in places]
    return []


def check_search(
    document: CaseDocument, base: CaseDocument, base_path: Path, search: schema.LimitSearch | schema.Optimisation | None
) -> None:
    """Check the paths and ranges of a search."""
    if search is None:
        return
    if isinstance(search, schema.LimitSearch):
        ranges = {search.path: (search.first, search.last)}
        where: KeyPath = ("study", "limit", "path")
    else:
        ranges, where = dict(search.variables), ("study", "optimise", "variables")
    faults = []
    for path, (low, high) in ranges.items():
        place = where if where[-1] == "path" else (*where, path)
        try:
            resolve(base.data, path)
            first, last, _ = common_unit(low, high, path)
            if not first < last:
                raise InputError(f"the range at '{path}' is empty", remedy="give the smaller value first")
        except InputError as error:
            faults.append(document.fault(place, error.fault.message, remedy=error.fault.remedy, of_key=True))
            continue
        ends = [{one.message: one for one in faults_at(base, base_path, ((path, end),))} for end in (low, high)]
        # A search takes what the case refuses for outside: what it refuses at both ends alike is no search
        for message in [message for message in ends[0] if message in ends[1]][:1]:
            remedy = ends[0][message].remedy
            faults.append(document.fault(place, f"'{path}': {message}", remedy=remedy, of_key=True))
    if faults:
        raise CaseError(faults)


def place_of(document: CaseDocument, where: KeyPath, path: str) -> KeyPath:
    """Return the place in the study file that is for ``path``, or the variation as a whole."""
    named = [place for place in document.keys if place[: len(where)] == where and path and str(place[-1]) == path]
    if named:
        return named[0]
    values = [
        place for place in document.values if place[: len(where)] == where and _value(document.data, place) == path
    ]
    if path and values:
        return values[0]
    first = [place for place in document.keys if place[: len(where)] == where and len(place) == len(where) + 1]
    return first[0] if first else where


def _value(data: Any, place: KeyPath) -> Any:
    for item in place:
        data = data[item]
    return data


def check_names(document: CaseDocument, axes: list[Axis]) -> None:
    names = [axis.name for axis in axes]
    twice = sorted({name for name in names if names.count(name) > 1})
    if twice:
        message = f"two axes are called '{twice[0]}'"
        remedy = "give them different names with 'name'"
        raise CaseError([document.fault(("study", "variations"), message, remedy=remedy)])
    paths: dict[str, str] = {}
    for axis in axes:
        for path in {path for point in axis.points for path, _ in point.assignments}:
            if path in paths:
                message = f"'{path}' is varied by both '{paths[path]}' and '{axis.name}'"
                raise CaseError([document.fault(("study", "variations"), message, remedy="vary it once")])
            paths[path] = axis.name
