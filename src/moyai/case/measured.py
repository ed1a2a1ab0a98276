"""Measured points that a case shows with its results: a CSV with names and units in its header, or of x and y alone."""

from __future__ import annotations

import csv
import math
import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from fractions import Fraction
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from moyai.case.yaml_text import decode
from moyai.core.arrays import Array
from moyai.core.errors import CaseError, InputError
from moyai.core.foreign_files import reads
from moyai.core.quantities import QuantityKind, check_unit
from moyai.core.stand_ins import find_stand_ins
from moyai.core.units import Unit, parse_unit
from moyai.core.vocabulary import MEASURED_GROUP
from moyai.core.wording import counted

if TYPE_CHECKING:
    from moyai.case.schema_measured import MeasuredPointsKeys
    from moyai.core.results import Result

_HEADING = re.compile(r"^\s*(?P<name>.*?)\s*(?:\[(?P<unit>[^\]]*)\])?\s*$")
_NAME = re.compile(r"[A-Za-z]\w*")


@reads("a table of points")
def read_points(
    path: Path, columns: Mapping[str, str], key: str, kinds: Mapping[str, QuantityKind] | None = None
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
        if unit is not None and name in (kinds or {}):
            check_unit(unit, ((kinds or {})[name],), f"{path.name}, column '{name}'", key)
    if len(rows) == 1:
        raise InputError(f"{path.name} has a header and no rows", path=key)
    table: dict[str, list[float]] = {name: [] for name in names}
    for line, cells in rows[1:]:
        if len(cells) != len(names):
            raise InputError(f"{path.name} line {line} has {len(cells)} cells, its header {len(names)}", path=key)
        for (name, unit), cell in zip(headings, cells):
            table[name].append(_number(cell, unit, f"{path.name} line {line}, column '{name}'", key))
    for name, unit in headings:
        if name in (kinds or {}):
            _refuse_stand_ins(
                np.array(table[name]) / (1.0 if unit is None else unit.to_si(Fraction(1))), name, rows, path, key
            )
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


@dataclass(frozen=True)
class Pairs:
    """Points of two columns as they stand in a file; units empty where the file gives none."""

    x: tuple[float, ...]
    y: tuple[float, ...]
    x_unit: str = ""
    y_unit: str = ""


@reads("a table of points")
def read_pairs(path: Path, key: str) -> Pairs:
    """Read a CSV of two columns, x and y, with or without a header.

    Parameters
    ----------
    path : Path
        Lines that begin with ``#`` are skipped; a header names the columns, with units in brackets.
    key : str
        Path of the key in the case file, for messages.

    Raises
    ------
    InputError
        With the row of what cannot be read.
    """
    rows = _rows(path, key)
    units = ["", ""]
    if rows and not all(_is_number(cell) for cell in rows[0][1]):
        found = [_heading(cell, path, key)[1] for cell in rows[0][1]]
        units = ["" if unit is None else unit.symbol for unit in found]
        rows = rows[1:]
    if not rows:
        raise InputError(f"{path.name} holds no points", path=key, allowed="two columns, x and y")
    points: list[tuple[float, float]] = []
    for line, cells in rows:
        if len(cells) != 2:
            raise InputError(
                f"{path.name} line {line} has {len(cells)} cells", path=key, allowed="two columns, x and y"
            )
        x, y = (_number(cell, None, f"{path.name} line {line}", key) for cell in cells)
        if math.isfinite(x) and math.isfinite(y):
            points.append((x, y))
    if not points:
        raise InputError(f"{path.name} holds no points", path=key, allowed="two columns, x and y")
    first, second = zip(*points, strict=True)
    return Pairs(first, second, units[0], units[1] if len(units) > 1 else "")


def measured_sets(model: Any) -> Iterator[tuple[int, MeasuredPointsKeys]]:
    """Yield the sets of points of a case that are laid over figures, with their place in its list."""
    given = getattr(model, "measured", None)
    yield from enumerate(given if isinstance(given, tuple) else ())


def with_measured(result: Result, model: Any, folder: Path) -> Result:
    """Return a result that carries the sets of measured points of its case.

    Parameters
    ----------
    result : Result
    model : Block
        Content of the case.
    folder : Path
        Folder that file names refer to.

    Raises
    ------
    InputError
        When a file has changed or become unreadable since the case was checked.
    """
    sets = list(measured_sets(model))
    if not sets:
        return result
    import xarray as xr

    tree = result.tree.copy()
    for index, points in sets:
        pairs = read_pairs(folder / points.file, f"measured[{index}].file")
        tree[f"{MEASURED_GROUP}/{index + 1}".lstrip("/")] = xr.DataTree(
            xr.Dataset(
                {"x": ("point", np.array(pairs.x)), "y": ("point", np.array(pairs.y))},
                attrs={
                    "file": points.file,
                    "figure": points.figure,
                    "panel": points.panel,
                    "label": points.label or Path(points.file).stem,
                    "x_unit": pairs.x_unit,
                    "y_unit": pairs.y_unit,
                },
            )
        )
    return replace(result, tree=tree)


def _is_number(cell: str) -> bool:
    try:
        float(cell or "nan")
    except ValueError:
        return False
    return True


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
    return [(number, [cell.strip() for cell in _cells(line, delimiter)]) for number, line in kept]


def _cells(line: str, delimiter: str) -> list[str]:
    # the reader costs ten times as much a line, and is needed for quotes alone
    return next(csv.reader([line], delimiter=delimiter)) if '"' in line else line.split(delimiter)


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


def _refuse_stand_ins(values: Array, name: str, rows: list[tuple[int, list[str]]], path: Path, key: str) -> None:
    """Refuse numbers that mean 'no value' by their look: one of them spoils every fit to a record."""
    for sign, count, row in find_stand_ins(np.round(values, 9)):
        raise InputError(
            f"{path.name}, column '{name}' holds {counted(count, 'value')} of {sign:g} far outside of all others, the "
            f"first in line {rows[row + 1][0]}",
            path=key,
            remedy="if it means 'no value', take these rows off the ends, or put values between their neighbours",
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
    return value if unit is None or unit.is_si else unit.to_si(Fraction(cell))
