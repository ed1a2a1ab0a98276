"""Measured points that a case shows beside its results: a CSV with names and units in its header."""

from __future__ import annotations

import csv
import io
import math
import re
from collections.abc import Mapping
from fractions import Fraction
from pathlib import Path

from moyai.case.yaml_text import decode
from moyai.core.errors import CaseError, InputError
from moyai.core.quantities import Kind
from moyai.core.units import Unit, parse_unit

_HEADING = re.compile(r"^\s*(?P<name>.*?)\s*(?:\[(?P<unit>[^\]]*)\])?\s*$")
_NAME = re.compile(r"[A-Za-z]\w*")


def read_points(
    path: Path, columns: Mapping[str, str], key: str, kinds: Mapping[str, Kind] | None = None
) -> dict[str, tuple[float, ...]]:
    """Read the columns of a CSV in SI units.

    Parameters
    ----------
    path : Path
        Lines that begin with ``#`` are skipped; the first other line names the columns, with units in brackets:
        ``period [s], sway [mm]``. Empty cells become NaN.
    columns : mapping
        Names of columns in the file and what they are called in the results; empty takes all as they are named.
    key : str
        Path of the key in the case file, for messages.
    kinds : mapping, optional
        What the columns of these names in the file must be; one without a unit is taken as SI.

    Raises
    ------
    InputError
        With the row and the column of what cannot be read.
    """
    rows = _rows(path, key)
    if not rows:
        raise InputError(f"{path.name} holds no table", path=key, remedy="the first line names the columns")
    headings = [_heading(cell, path, key) for cell in rows[0][1]]
    names = [name for name, _ in headings]
    if len(set(names)) < len(names):
        twice = next(name for name in names if names.count(name) > 1)
        raise InputError(f"{path.name} has the column '{twice}' twice", path=key)
    missing = [name for name in columns if name not in names]
    if missing:
        raise InputError(f"{path.name} has no column '{missing[0]}'", path=key, allowed=", ".join(names))
    for name, unit in headings:
        _check_kind(name, unit, (kinds or {}).get(name), path, key)
    if len(rows) == 1:
        raise InputError(f"{path.name} has a header and no rows", path=key)
    table: dict[str, list[float]] = {name: [] for name in names}
    for line, cells in rows[1:]:
        if len(cells) != len(names):
            raise InputError(f"{path.name} line {line} has {len(cells)} cells, its header {len(names)}", path=key)
        for (name, unit), cell in zip(headings, cells):
            table[name].append(_number(cell, unit, f"{path.name} line {line}, column '{name}'", key))
    wanted = dict(columns) or {name: name for name in names}
    bad = next((target for target in wanted.values() if not _NAME.fullmatch(target)), None)
    if bad is not None:
        raise InputError(
            f"the column '{bad}' cannot be named so in the results",
            path=key,
            allowed="letters, digits and underscores",
            remedy="rename it under 'columns'",
        )
    return {target: tuple(table[name]) for name, target in wanted.items()}


def _rows(path: Path, key: str) -> list[tuple[int, list[str]]]:
    try:
        text = decode(path.read_bytes(), path.name)
    except CaseError as error:
        fault = error.faults[0]
        raise InputError(f"{path.name}: {fault.message}", path=key, remedy=fault.remedy) from None
    except OSError as error:
        raise InputError(f"{path} cannot be read: {error.strerror or error}", path=key) from None
    lines = [(number, line) for number, line in enumerate(text.split("\n"), 1)]
    kept = [(number, line) for number, line in lines if line.strip() and not line.lstrip().startswith("#")]
    if not kept:
        return []
    header = kept[0][1]
    delimiter = next((mark for mark in (";", "\t", ",") if mark in header), ",")
    return [
        (number, [cell.strip() for cell in next(csv.reader(io.StringIO(line), delimiter=delimiter))])
        for number, line in kept
    ]


def _heading(cell: str, path: Path, key: str) -> tuple[str, Unit | None]:
    match = _HEADING.match(cell)
    name, unit = (match["name"], match["unit"]) if match else (cell, None)
    if not name:
        raise InputError(f"{path.name}: a column has no name", path=key)
    if unit is None or unit.strip() in ("", "-", "1"):
        return name, None
    try:
        return name, parse_unit(unit)
    except InputError as error:
        raise InputError(
            f"{path.name}, column '{name}': {error.fault.message}", path=key, remedy=error.fault.remedy
        ) from None


def _check_kind(name: str, unit: Unit | None, kind: Kind | None, path: Path, key: str) -> None:
    if kind is None or unit is None or unit.dimension == kind.dimension:
        return
    raise InputError(
        f"{path.name}, column '{name}': '{unit.symbol}' is no unit of {kind.name}",
        path=key,
        allowed=f"for instance {kind.unit}",
    )


def _number(cell: str, unit: Unit | None, place: str, key: str) -> float:
    if not cell:
        return math.nan
    try:
        value = float(cell)
    except ValueError:
        raise InputError(f"{place}: '{cell[:40]}' is not a number", path=key) from None
    if not math.isfinite(value):
        raise InputError(f"{place}: {cell[:40]} is not a finite number", path=key, remedy="leave the cell empty")
    return value if unit is None else unit.to_si(Fraction(cell))
