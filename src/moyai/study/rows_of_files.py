"""Rows and columns of the tables that a study or a fit names."""

from __future__ import annotations

import csv
import re
from pathlib import Path

from moyai.core.errors import InputError
from moyai.core.foreign_files import reads
from moyai.records.reading.text import SURPLUS_REMEDY

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
    kept = [
        (number, line)
        for number, line in enumerate(text.splitlines(), 1)
        if line.strip() and not line.lstrip().startswith("#")
    ]
    if not kept:
        raise InputError(f"{file} is empty", path="file")
    lines = [line for _, line in kept]
    delimiter = max(",;\t", key=lines[0].count)
    reader = csv.DictReader(lines, delimiter=delimiter, restkey="")
    rows = []
    for row in reader:
        surplus = row.pop("", None)
        if isinstance(surplus, list) and any(cell.strip() for cell in surplus):
            width, line = len(reader.fieldnames or ()), kept[reader.line_num - 1][0]
            raise InputError(
                f"{file.name} line {line} has {width + len(surplus)} cells for {width} headings",
                path="file",
                remedy=SURPLUS_REMEDY,
            )
        rows.append({str(key).strip(): value for key, value in row.items()})
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
