"""Rows and columns of the tables that a study or a fit names."""

from __future__ import annotations

import csv
import re
from pathlib import Path

from moyai.core.errors import InputError
from moyai.core.foreign_files import reads

_HEADING = re.compile(r"(.*?)\s*\[([^\]]*)\]")


@reads("a table")
def read_rows(file: Path) -> list[dict[str, str]]:
    """Return the rows of a CSV file by column.

    Raises
    ------
    InputError
        When the file is absent, empty, or no text.
    """
    try:
        text = file.read_text(encoding="utf-8-sig")
    except FileNotFoundError:
        raise InputError(f"no such file: {file}", path="file") from None
    except (OSError, UnicodeDecodeError) as error:
        raise InputError(f"{file} cannot be read: {error}", path="file", remedy="save it as UTF-8") from None
    lines = [line for line in text.splitlines() if line.strip() and not line.lstrip().startswith("#")]
    if not lines:
        raise InputError(f"{file} is empty", path="file")
    delimiter = max(",;\t", key=lines[0].count)
    rows = [
        {str(key).strip(): value for key, value in row.items() if key is not None}
        for row in csv.DictReader(lines, delimiter=delimiter)
    ]
    if not rows:
        raise InputError(f"{file} has a header but no rows", path="file")
    return rows


def column_of(rows: list[dict[str, str]], column: str, file: Path, path: str = "") -> tuple[str, str]:
    """Return heading and unit of a column, which is named with or without the unit of its heading: ``T`` of ``T [s]``.

    Raises
    ------
    InputError
        When no heading has that name, or more than one.
    """
    found = [(heading, _HEADING.fullmatch(heading)) for heading in rows[0]]
    named = [pair for pair in found if pair[0] == column] or [
        pair for pair in found if pair[1] and pair[1][1] == column
    ]
    if len(named) != 1:
        said = "more than one column" if named else "no column"
        raise InputError(f"{file.name} has {said} '{column}'", path=path, allowed=", ".join(rows[0]))
    heading, match = named[0]
    unit = "" if match is None else match[2].strip()
    return heading, "" if unit in ("-", "1") else unit
