"""Compare every number of a case with its plausible range, alone and over other numbers of the case.

The ranges stand in one table, ``tables/data/plausible_ranges.csv``. Single keys are judged first; a ratio one of whose
keys was reported of already says nothing more. What a default gives is not judged: only what is in the file.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

from moyai.case.faults import value_at
from moyai.case.findings import Findings
from moyai.case.plausible_sizes import derived_sizes
from moyai.case.schema_types import Block
from moyai.case.yaml_reader import CaseDocument, KeyPath
from moyai.core.errors import InputError
from moyai.core.quantities import parse_quantity
from moyai.tables.plausible_ranges import Factor, PlausibleRange, plausible_ranges, range_sources

#: Slips that are looked for where a number is out of its usual range: thousands, hundreds, millions
_SLIPS = (1e-3, 1e3, 1e-2, 1e2, 1e-6, 1e6)
#: A number that follows from more keys is written without them
_MOST_KEYS = 5


@dataclass(frozen=True)
class CheckedNumber:
    """A number of a case."""

    #: In the unit of plain numbers.
    value: float
    #: Its path in the file; ``None`` for a default and for what follows from other keys.
    place: KeyPath | None = None
    #: Keys of the model that a derived number follows from.
    of: tuple[KeyPath, ...] = ()


@dataclass(frozen=True)
class Odd:
    """A quantity outside of its usual range."""

    row: PlausibleRange
    paths: list[KeyPath]
    entries: list[CheckedNumber]
    value: float


def check_plausibility(model: Block, findings: Findings) -> None:
    """Record what is impossible as a fault and what is unusual as a warning, with range and source.

    A case that says ``plausibility: warn`` is only warned.
    """
    numbers = {path: CheckedNumber(value, place_of(path, findings.document)) for path, value in _numbers(model, ())}
    kind = str(model.structure.kind)  # type: ignore[attr-defined]
    for path, (value, of) in derived_sizes(model).items():
        numbers[path] = CheckedNumber(value, None, of)
    ends: dict[str | int, list[KeyPath]] = {}
    for path in numbers:
        last = next((step for step in reversed(path) if isinstance(step, str)), "")
        ends.setdefault(last, []).append(path)
    odd: list[Odd] = []
    for row in plausible_ranges(kind):
        last = row.factors[0].steps[-1]
        for first in list(numbers) if last == "*" else ends.get(last, ()):
            captured = _matched(first, row.factors[0].steps)
            found = None if captured is None else _odd(row, first, captured, numbers)
            if found is not None:
                odd.append(found)
    # Kinds of ratio: a slip in two lines alike is no slip in what both are compared with
    ratios = {(one.row.quantity, key) for one in odd if len(one.paths) > 1 for key in _keys(one)}
    shared = Counter(key for _, key in ratios)
    reported: dict[KeyPath, bool] = {}
    for one in odd:
        _tell(one, shared, reported, numbers, findings, lenient=getattr(model, "plausibility", "") == "warn")
    _tell_radians(numbers, reported, findings)


def place_of(path: KeyPath, document: CaseDocument) -> KeyPath | None:
    """Return a path of the model as a path of the file, ``None`` where the file does not hold it.

    A single block may stand for a list of one.
    """
    found: list[str | int] = []
    for step in path:
        if (*found, step) in document.values:
            found.append(step)
        elif not (isinstance(step, int) and step == 0 and tuple(found) in document.values):
            return None
    return tuple(found)


def _numbers(value: Any, path: KeyPath) -> Iterator[tuple[KeyPath, float]]:
    if isinstance(value, Block):
        for name, field in type(value).model_fields.items():
            yield from _numbers(getattr(value, name), (*path, field.alias or name))
    elif isinstance(value, dict):
        for name, item in value.items():
            yield from _numbers(item, (*path, name))
    elif isinstance(value, (tuple, list)):
        for index, item in enumerate(value):
            yield from _numbers(item, (*path, index))
    elif isinstance(value, (int, float)) and not isinstance(value, bool):
        yield path, float(value)


@lru_cache(maxsize=16384)
def _matched(path: KeyPath, steps: tuple[str, ...]) -> tuple[str | int, ...] | None:
    """Return what the stars of a pattern stand for in a path, ``None`` where it does not fit."""
    if "**" in steps:
        cut = steps.index("**")
        head, tail = steps[:cut], steps[cut + 1 :]
        if len(path) < len(head) + len(tail) or _matched(path[: len(head)], head) is None:
            return None
        return _matched(path[len(path) - len(tail) :], tail)
    if len(path) != len(steps):
        return None
    captured: list[str | int] = []
    for step, wanted in zip(path, steps):
        if wanted == "*" and step != "count":  # how many values a range has is no value of it
            captured.append(step)
        elif str(step) != wanted:
            return None
    return tuple(captured)


def _path_of(factor: Factor, first: KeyPath, captured: tuple[str | int, ...]) -> KeyPath:
    """Return the path of a further factor of a quantity whose first key was found."""
    if factor.relative:
        end = len(first)
        while isinstance(first[end - 1], int):
            end -= 1
        return (*first[: end - 1], *factor.steps)
    stars = iter(captured)
    return tuple(next(stars) if step == "*" else step for step in factor.steps)


def _odd(
    row: PlausibleRange, first: KeyPath, captured: tuple[str | int, ...], numbers: dict[KeyPath, CheckedNumber]
) -> Odd | None:
    """Return the quantity of a row where it leaves its usual range; ``None`` where it keeps it or is not there."""
    paths = [first, *(_path_of(factor, first, captured) for factor in row.factors[1:])]
    entries: list[CheckedNumber] = []
    value = 1.0
    for factor, path in zip(row.factors, paths):
        entry = numbers.get(path)
        if entry is None or not math.isfinite(entry.value) or entry.value == 0.0:
            return None
        try:
            value *= abs(entry.value) ** factor.power
        except OverflowError:
            return None
        entries.append(entry)
    return None if row.usual[0] <= value <= row.usual[1] else Odd(row, paths, entries, value)


def _keys(odd: Odd) -> set[KeyPath]:
    """Return the keys that a quantity follows from, without those of the site: many quantities share these."""
    keys = {key for path, entry in zip(odd.paths, odd.entries) for key in (entry.of or (path,))}
    return {key for key in keys if key[0] != "site"}


def _tell(
    odd: Odd,
    shared: Counter[KeyPath],
    reported: dict[KeyPath, bool],
    numbers: dict[KeyPath, CheckedNumber],
    findings: Findings,
    *,
    lenient: bool,
) -> None:
    """Record an odd quantity, unless one of its keys was reported.

    Parameters
    ----------
    odd : Odd
    shared : Counter
        How many kinds of odd ratios a key stands in.
    reported : dict of tuple to bool
        Keys that were reported, and whether as impossible; what is impossible is said of one that was only unusual.
    numbers : dict of tuple to Entry
    findings : Findings
    lenient : bool
        Whether impossible numbers are warnings as well.
    """
    row, paths, entries, value = odd.row, odd.paths, odd.entries, odd.value
    possible = row.possible[0] * (1.0 - 1e-9) <= value <= row.possible[1] * (1.0 + 1e-9)
    before = [
        grave
        for bad, grave in reported.items()
        if any(path[: len(bad)] == bad for path in paths) or any(_overlap(bad, k) for e in entries for k in e.of)
    ]
    if any(before) or (before and possible):
        return
    blamed = _blamed(odd, shared, reported, findings.document)
    if blamed is None:
        return
    reported[blamed[0]] = not possible
    number = f"{value:.3g}{' ' + row.unit if row.unit else ''}"
    message = f"the {row.what} is {number}"
    if len(paths) > 1 or paths[0] != blamed[0]:
        message += f" ({_written(paths, entries, numbers, findings.document)})"
    message += ", which is unusual" if possible else ", which is impossible"
    power = next(factor.power for factor, path in zip(row.factors, paths) if path == blamed[0]) if blamed[2] else 0
    record = findings.warn if possible or lenient else findings.fault
    record(blamed[1], message, allowed=_allowed(row, possible), remedy=_remedy(row, value, power, blamed[1], findings))


def _overlap(one: KeyPath, other: KeyPath) -> bool:
    """Whether one of two paths leads through the other."""
    shorter = min(len(one), len(other))
    return one[:shorter] == other[:shorter]


def _blamed(
    odd: Odd, shared: Counter[KeyPath], reported: dict[KeyPath, bool], document: CaseDocument
) -> tuple[KeyPath, KeyPath, bool] | None:
    """Return path in the model and place in the file of the number to report, and whether it is a factor itself.

    That is the first key of the quantity; another one where it was reported before, or where it stands in more odd
    ratios than the first, whose own value no slip of a unit explains.
    """
    first = odd.entries[0]
    if first.place is None and not first.of:
        return None  # a default: nobody wrote it
    own = [(path, entry.place, True) for path, entry in zip(odd.paths, odd.entries) if entry.place is not None]
    through = [(path, place, False) for entry in odd.entries for path in entry.of
               if (place := place_of(path, document)) is not None]  # fmt: skip
    choices = [*own, *through] if first.place is not None else through
    known = [choice for choice in choices if choice[0] in reported]
    if known or not choices:
        return known[0] if known else None
    return max(choices, key=lambda choice: shared[choice[0]]) if _near(odd.row, odd.value) else choices[0]


def _written(
    paths: list[KeyPath], entries: list[CheckedNumber], numbers: dict[KeyPath, CheckedNumber], document: CaseDocument
) -> str:
    """Return the numbers of a ratio as the file writes them."""
    said = []
    for path, entry in zip(paths, entries):
        if entry.of and (len(entry.of) > 1 or entry.of[0] not in numbers):
            said.append(f"{str(path[-1]).removeprefix('@').replace('_', ' ')} {entry.value:.4g}")
        of = entry.of if len(entry.of) <= _MOST_KEYS else ()
        for place in [entry.place] if entry.place else [place_of(key, document) for key in of]:
            if place is None:
                continue
            data = value_at(document.data, place)
            if data is not None and not isinstance(data, (dict, list)):
                name = ".".join(str(step) for step in place if isinstance(step, str))
                said.append(f"{name} {data}")
    return ", ".join(dict.fromkeys(said)) or "from other keys"


def _between(limits: tuple[float, float], unit: str) -> str:
    low, high = limits
    end = f" {unit}" if unit else ""
    if low <= 0.0:
        return f"at most {high:.4g}{end}"
    return f"at least {low:.4g}{end}" if math.isinf(high) else f"{low:.4g} to {high:.4g}{end}"


def _allowed(row: PlausibleRange, possible: bool) -> str:
    source = range_sources().get(row.source, row.source)
    usual = f"usually {_between(row.usual, row.unit)}"
    if possible:
        return f"{usual} (source: {source})"
    return f"{_between(row.possible, row.unit)}, {usual} (source: {source})"


def _near(row: PlausibleRange, value: float) -> bool:
    """Whether a value lies too near to its usual range for a slip of a unit."""
    return 0.1 * row.usual[0] <= value <= 10.0 * row.usual[1]


def _remedy(row: PlausibleRange, value: float, power: int, place: KeyPath, findings: Findings) -> str:
    """Return what was probably meant: the same number in another unit."""
    written: Any = value_at(findings.document.data, place)
    unit, plain = "", isinstance(written, (int, float)) and not isinstance(written, bool)
    if isinstance(written, str):
        try:
            quantity = parse_quantity(written)
        except InputError:
            return "check it"
        number, unit = float(quantity.number), quantity.unit.symbol
        plain = not unit
    elif plain:
        number = float(written)
    else:
        return "check it"
    for slip in () if _near(row, value) else _SLIPS:
        if power and row.usual[0] <= value * slip**power <= row.usual[1]:
            meant = f"{number * slip:.6g}{' ' + unit if unit else ''}"
            if plain and row.unit:
                millimetres = f"'{number:g} mm'" if row.unit == "m" and slip == 1e-3 else ""
                return (
                    f"a number without unit is read in {row.unit}: give the unit; did you mean {millimetres or meant}?"
                )
            return f"check the number and its unit: {meant} would be usual"
    return "check the number and its unit"


def _tell_radians(numbers: dict[KeyPath, CheckedNumber], reported: dict[KeyPath, bool], findings: Findings) -> None:
    """Warn of an angle in degrees whose decimals are those of a round angle in radians: 0.7854, 1.5708."""
    for path, entry in numbers.items():
        if entry.place is None or path in reported or not str(path[-1]).endswith("_deg"):
            continue
        decimals = len(repr(entry.value).partition(".")[2])
        step = 5 if decimals > 2 else 15
        degrees = step * round(math.degrees(abs(entry.value)) / step)
        exact = math.radians(degrees)
        if decimals < 2 or not 0 < degrees <= 360 or abs(abs(entry.value) - exact) > 0.6 * 10.0**-decimals:
            continue
        turned = int(math.copysign(degrees, entry.value))
        findings.warn(
            entry.place,
            f"the angle is {entry.value:g} degrees, which are the digits of {turned} degrees in radians",
            allowed="degrees",
            remedy=f"write {turned}, or '{entry.value:g} rad'",
        )
