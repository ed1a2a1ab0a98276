"""Scatter diagrams: how often which sea state comes, as a list or as a matrix."""

from __future__ import annotations

import csv
import math
from dataclasses import dataclass
from pathlib import Path

from moyai.core.errors import InputError
from moyai.core.foreign_files import reads

_TOLERANCE = 1e-3


@dataclass(frozen=True)
class SeaState:
    """One cell of a scatter diagram."""

    #: [m]
    significant_height: float
    #: The period by which the diagram is sorted [s].
    period: float
    #: Share of the time.
    probability: float


@reads("a scatter diagram", named="scatter.file")
def read_scatter(file: Path, *, counts: bool = False) -> tuple[SeaState, ...]:
    """Read a scatter diagram from CSV.

    Either three columns with a header (``significant_height, period, probability``), or a matrix: periods [s] in the
    first row from the second cell on, significant heights [m] in the first column. Empty cells and zeros are left out.

    Parameters
    ----------
    file : Path
    counts : bool
        The cells are numbers of sea states, to be divided by their sum; otherwise they are probabilities that
        must sum to one within 0.1 %.

    Raises
    ------
    InputError
        With file, row and column.
    """
    rows = _rows(file)
    cells = _listed(rows, file) if len(rows[0]) == 3 and not _is_number(rows[0][1]) else _matrix(rows, file)
    cells = [cell for cell in cells if cell.probability > 0.0]
    total = math.fsum(cell.probability for cell in cells)
    if not cells:
        raise InputError(f"{file.name}: the scatter diagram is empty (no cell above zero)", path="scatter.file")
    if not counts and abs(total - 1.0) > _TOLERANCE:
        raise InputError(
            f"{file.name}: the probabilities sum to {total:.6g}, not to 1",
            path="scatter.file",
            remedy="correct the diagram, or give 'counts: true' if the cells are numbers of sea states",
        )
    return tuple(SeaState(cell.significant_height, cell.period, cell.probability / total) for cell in cells)


def _rows(file: Path) -> list[list[str]]:
    try:
        text = file.read_text(encoding="utf-8-sig")
    except FileNotFoundError:
        raise InputError(f"no such file: {file}", path="scatter.file") from None
    except (OSError, UnicodeDecodeError) as error:
        raise InputError(f"{file} cannot be read: {error}", path="scatter.file", remedy="save it as UTF-8") from None
    lines = [line for line in text.splitlines() if line.strip() and not line.lstrip().startswith("#")]
    if len(lines) < 2:
        raise InputError(f"{file.name}: the scatter diagram is empty", path="scatter.file")
    delimiter = max(",;\t", key=lines[0].count)
    return [[cell.strip() for cell in row] for row in csv.reader(lines, delimiter=delimiter)]


def _is_number(text: str) -> bool:
    try:
        float(text)
    except ValueError:
        return False
    return True


def _number(text: str, file: Path, row: int, column: int) -> float:
    try:
        value = float(text) if text else 0.0
    except ValueError:
        value = math.nan
    if not math.isfinite(value) or value < 0.0:
        raise InputError(
            f"{file.name}, row {row}, column {column}: '{text}' is no number of zero or more", path="scatter.file"
        )
    return value


def _listed(rows: list[list[str]], file: Path) -> list[SeaState]:
    cells = []
    for number, row in enumerate(rows[1:], start=2):
        if len(row) < 3:
            raise InputError(f"{file.name}, row {number}: three columns are needed", path="scatter.file")
        cells.append(SeaState(*(_number(row[column], file, number, column + 1) for column in range(3))))
    return cells


def _matrix(rows: list[list[str]], file: Path) -> list[SeaState]:
    periods = [_number(text, file, 1, column) for column, text in enumerate(rows[0][1:], start=2)]
    cells = []
    for number, row in enumerate(rows[1:], start=2):
        height = _number(row[0], file, number, 1)
        for column, text in enumerate(row[1:], start=2):
            if column - 2 >= len(periods):
                raise InputError(f"{file.name}, row {number}: more cells than periods", path="scatter.file")
            value = _number(text, file, number, column)
            cells.append(SeaState(height, periods[column - 2], value))
    return cells
