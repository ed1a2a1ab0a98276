"""Measured spectra: the checks of a table and the reading of a text file."""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from moyai.core.arrays import Array
from moyai.core.errors import InputError
from moyai.core.foreign_files import reads


def spectrum_table(
    frequency: ArrayLike,
    density: ArrayLike,
    *,
    what: str,
    unit: str,
    rows: Sequence[int] | None = None,
    path: str = "",
) -> tuple[Array, Array]:
    """Return copies of a spectrum's columns, or raise one error that names the first faulty row.

    Parameters
    ----------
    frequency, density : array_like
        Columns of the table.
    what, unit : str
        Name and unit of the frequency, for the message.
    rows : sequence of int, optional
        Row numbers of the source; by default 1, 2, ...
    path : str
        Where the table comes from.

    Raises
    ------
    InputError
        When the table is empty, the columns differ in length, a value is NaN or infinite or negative, or the
        frequencies do not increase.
    """
    f = np.array(frequency, dtype=np.float64)
    s = np.array(density, dtype=np.float64)
    where = path or "spectrum"
    if f.ndim != 1 or s.ndim != 1 or f.size != s.size:
        raise InputError(
            f"the spectrum has {what} of shape {f.shape} and density of shape {s.shape}",
            parameter=where,
            allowed="two columns of equal length",
        )
    if f.size < 2:
        found = "is empty" if f.size == 0 else "has one row only"
        raise InputError(f"the spectrum {found}", parameter=where, allowed="at least two rows")
    numbers = range(1, f.size + 1) if rows is None else rows
    falling = np.concatenate([[False], np.diff(f) <= 0.0])
    tests = (
        (~np.isfinite(f), f, f"{what} is not a number", "finite"),
        (~np.isfinite(s), s, "density is not a number", "finite"),
        (f < 0.0, f, f"{what} is negative", f"at least 0 {unit}"),
        (s < 0.0, s, "density is negative", "at least 0"),
        ((f == 0.0) & (s > 0.0), s, f"density at {what} 0", "0: the mean level is not a wave"),
        (falling, f, f"{what} does not increase", "strictly increasing"),
    )
    faults = [(int(np.argmax(mask)), value, text, allowed) for mask, value, text, allowed in tests if mask.any()]
    if faults:
        place, value, text, allowed = min(faults, key=lambda fault: fault[0])
        total = int(np.count_nonzero(np.logical_or.reduce([mask for mask, *_ in tests])))
        more = f" ({total} faulty rows in all)" if total > 1 else ""
        raise InputError(
            f"row {numbers[place]}: {text}: {value[place]:g}{more}",
            parameter=where,
            allowed=allowed,
            remedy="sort the rows by frequency" if "increase" in text else "",
        )
    if not (s > 0.0).any():
        raise InputError(
            "the spectrum has no energy: every density is 0", parameter=where, allowed="some density above 0"
        )
    return f, s


def _split(line: str) -> list[str]:
    for separator in (";", "\t", ","):
        if separator in line:
            return [item.strip().strip('"') for item in line.split(separator)]
    return line.split()


def _number(text: str) -> float | None:
    try:
        return float(text)
    except ValueError:
        return None


def _column(wanted: int | str, header: list[str] | None, width: int, file: Path) -> int:
    if isinstance(wanted, str):
        names = header or []
        if wanted not in names:
            shown = ", ".join(names) if names else "none: the file has no header"
            raise InputError(f"no column {wanted!r}", parameter=str(file), allowed=f"columns {shown}")
        return names.index(wanted)
    if not 1 <= wanted <= width:
        raise InputError(f"no column {wanted}", parameter=str(file), allowed=f"1 to {width}")
    return wanted - 1


@reads("a table of a spectrum")
def read_spectrum_file(
    path: Any, frequency_column: int | str, density_column: int | str
) -> tuple[list[float], list[float], list[int]]:
    """Read two columns of a text file; see :func:`moyai.sea.spectra.from_file`.

    Returns
    -------
    frequency, density, rows : list
        The columns as they stand and the line number of each row.

    Raises
    ------
    InputError
        When the file is absent or unreadable, a named column is missing, or an entry is not a number.
    """
    file = Path(path)
    try:
        text = file.read_text(encoding="utf-8-sig")
    except (OSError, UnicodeDecodeError) as error:
        reason = getattr(error, "strerror", None) or "it is not a text file"
        raise InputError(f"cannot read the spectrum {file}: {reason}", parameter=str(file)) from error
    header: list[str] | None = None
    columns: tuple[int, int] | None = None
    frequency: list[float] = []
    density: list[float] = []
    rows: list[int] = []
    for row, line in enumerate(text.splitlines(), 1):
        if not line.strip() or line.lstrip()[0] in "#%":
            continue
        items = _split(line.strip())
        if columns is None:
            if header is None and all(_number(item) is None for item in items):
                header = items
                continue
            columns = (
                _column(frequency_column, header, len(items), file),
                _column(density_column, header, len(items), file),
            )
        values = [_number(items[place]) if place < len(items) else None for place in columns]
        if values[0] is None or values[1] is None:
            raise InputError(
                f"row {row}: {line.strip()[:60]!r} does not hold a frequency and a density",
                parameter=str(file),
                allowed="numbers with a decimal point, frequency [Hz] and density [m2/Hz]",
            )
        frequency.append(math.nan if values[0] is None else values[0])
        density.append(math.nan if values[1] is None else values[1])
        rows.append(row)
    return frequency, density, rows
