"""Read columns of text files by the chunk: any delimiter, encoding, headings, decimal sign.

Faults name the file, the line and the column.
"""

from __future__ import annotations

import codecs
import difflib
import re
import unicodedata
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from moyai.core.errors import InputError
from moyai.core.foreign_files import reads
from moyai.records.reading.sources import LoggerSource

_UNIT = re.compile(r"^(?P<name>.*?)\s*[\[\(](?P<unit>[^\[\]\(\)]*)[\]\)]\s*$")
_ENCODINGS = ("utf-8-sig", "cp932")
_SAMPLE = 65536
SURPLUS_REMEDY = (
    "name every column; where the comma is the decimal sign, write decimal points or semicolons between the columns"
)
"""What to do about a row with more cells than there are headings."""


@dataclass(frozen=True, eq=False)
class RawChunk:
    """Consecutive rows of some columns."""

    #: Arrays of numbers, or of text for stamps, by the key they were asked for.
    columns: dict[str | int, NDArray[Any]]
    #: Number of rows before these in the file.
    first: int

    def __len__(self) -> int:
        return len(next(iter(self.columns.values())))


def plain_name(text: str) -> str:
    """Return a heading with full-width forms made plain and outer spaces gone."""
    return unicodedata.normalize("NFKC", text).replace("\ufeff", "").strip()


def split_heading(text: str) -> tuple[str, str]:
    """Return name and unit of a heading such as ``Hs [m]`` or ``波高（cm）``; the unit is empty where there is none."""
    plain = plain_name(text)
    match = _UNIT.match(plain)
    return (match["name"].strip(), match["unit"].strip()) if match and match["name"].strip() else (plain, "")


def find_encoding(path: Path, wanted: str) -> str:
    """Return the encoding of a text file.

    Raises
    ------
    InputError
        When the encoding is not known to Python, or none of those tried fits.
    """
    if wanted != "auto":
        try:
            return codecs.lookup(wanted).name
        except LookupError:
            raise InputError(
                f"unknown encoding '{wanted}'",
                parameter="encoding",
                allowed="for instance utf-8, cp932, shift_jis, utf-16",
            ) from None
    raw = _bytes(path, 4_000_000)
    if raw.startswith((codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)):
        return "utf-16"
    for name in _ENCODINGS:
        try:
            codecs.getincrementaldecoder(name)().decode(raw, final=False)
        except UnicodeDecodeError:
            continue
        return name
    raise InputError(
        f"{path.name} is neither UTF-8 nor Shift-JIS",
        parameter="encoding",
        remedy="give 'encoding', for instance euc_jp or latin-1",
    )


def _bytes(path: Path, most: int) -> bytes:
    try:
        with path.open("rb") as stream:
            raw = stream.read(most)
    except OSError as error:
        raise InputError(f"{path} cannot be read: {error.strerror or error}", parameter="file") from None
    if not raw.strip():
        raise InputError(f"{path.name} is empty", parameter="file")
    return raw


@dataclass(frozen=True)
class TextLayout:
    """How a text file is laid out."""

    #: As Python names it.
    encoding: str
    #: As pandas names it.
    delimiter: str
    #: Empty where the file has none.
    headings: tuple[str, ...]
    #: Lines before the first sample.
    skipped: int
    #: Number of columns, without empty ones at the end.
    width: int


@reads("a table")
def find_layout(path: Path, source: LoggerSource) -> TextLayout:
    """Find out encoding, delimiter, headings and the first line of samples."""
    encoding = find_encoding(path, source.encoding)
    try:
        with path.open(encoding=encoding, newline=None) as stream:
            lines: list[str] = []
            while len(lines) < max(source.header_row, source.first_row, 0) + 60:
                line = stream.readline(_SAMPLE)
                if not line:
                    break
                lines.append(line.rstrip("\r\n"))
    except UnicodeDecodeError as error:
        raise InputError(
            f"{path.name} is not {encoding}: byte {error.start} of the first lines does not fit",
            parameter="encoding",
            remedy="try cp932 (Shift-JIS), utf-8 or latin-1",
        ) from None

    def is_text(line: str) -> bool:
        return bool(line.strip()) and not (source.comment and line.lstrip().startswith(source.comment))

    if source.header_row >= 0:
        header = source.header_row
    else:
        header = next((number for number, line in enumerate(lines, 1) if is_text(line)), 0)
    first = source.first_row or header + 1
    body = [line for line in lines[first - 1 :] if is_text(line)]
    heading = lines[header - 1] if 0 < header <= len(lines) else ""
    if not body:
        raise InputError(f"{path.name} has no samples from line {first} on", parameter="file")
    delimiter = source.delimiter
    if delimiter == "auto":
        delimiter = _sniff(body, source.decimal, heading)
    elif delimiter == "whitespace":
        delimiter = r"\s+"
    headings: tuple[str, ...] = ()
    if header:
        if header > len(lines):
            raise InputError(f"{path.name} has no line {header}", parameter="header_row")
        headings = tuple(cell.strip().strip('"') for cell in _heading_cells(heading, delimiter))
    cells = _cells(body[0], delimiter)
    while len(cells) > max(len(headings), 1) and not cells[-1].strip():
        cells.pop()
    return TextLayout(encoding, delimiter, headings, first - 1, len(cells))


def _refuse_surplus(path: Path, source: LoggerSource, layout: TextLayout) -> None:
    """Refuse rows that hold more cells than there are headings: a cell would be read under the wrong one."""
    if layout.headings and layout.width > len(layout.headings):
        line = _line_of(path, layout, source.comment, 0)
        raise InputError(
            f"{path.name} line {line} has {layout.width} cells for {len(layout.headings)} headings",
            parameter="file",
            remedy=SURPLUS_REMEDY,
        )


def _heading_cells(line: str, delimiter: str) -> list[str]:
    """Return the cells of the headings; between spaces a unit in brackets belongs to the name before it."""
    if delimiter == r"\s+":
        return re.split(r"\s+(?![\[\(（])", line.strip())
    return _cells(line, delimiter)


def _cells(line: str, delimiter: str) -> list[str]:
    import csv
    import io

    if delimiter == r"\s+":
        return line.split()
    return next(csv.reader(io.StringIO(line), delimiter=delimiter), [])


def _sniff(lines: Sequence[str], decimal: str, heading: str) -> str:
    """Return the delimiter that cuts most lines into the same, largest number of cells.

    One that cuts the headings into as many goes before: commas may be decimal signs.
    """
    best, most, best_fits = r"\s+", 1, False
    for mark in ("\t", ";", ",", "|"):
        if mark == decimal:
            continue
        counts = sorted(line.count(mark) for line in lines)
        usual = counts[(len(counts) - 1) // 2]
        fits = bool(heading) and heading.count(mark) == usual > 0
        if counts.count(usual) > 0.5 * len(counts) - 1e-9 and (fits, usual + 1) > (best_fits, most):
            best, most, best_fits = mark, usual + 1, fits
    return best


def place_of(column: str | int, headings: Sequence[str], width: int, file: str) -> int:
    """Return the place (from 0) of a column asked for by name or by number from 1.

    Raises
    ------
    InputError
        With the headings there are and the one that was probably meant.
    """
    if isinstance(column, int):
        if 1 <= column <= width:
            return column - 1
        raise InputError(f"{file} has no column {column}", parameter="column", allowed=f"1 to {width}")
    wanted = plain_name(column)
    plain = [plain_name(heading) for heading in headings]
    bare = [split_heading(heading)[0] for heading in headings]
    for names in (plain, bare):
        places = [place for place, name in enumerate(names) if name == wanted]
        if len(places) == 1:
            return places[0]
        if len(places) > 1:
            raise InputError(
                f"{file} has the column '{column}' {len(places)} times", parameter="column", remedy="give its number"
            )
    near = difflib.get_close_matches(wanted, [*plain, *bare], n=1, cutoff=0.6)
    raise InputError(
        f"{file} has no column '{column}'",
        parameter="column",
        allowed=", ".join(f"'{name}'" for name in plain) or f"numbers 1 to {width}: the file has no headings",
        remedy=f"did you mean '{near[0]}'?" if near else "",
    )


@reads("a table")
def read_text(
    path: Path, source: LoggerSource, wanted: Sequence[str | int], stamps: Sequence[str | int], rows: int
) -> Iterator[RawChunk]:
    """Yield chunks of at most ``rows`` rows of the columns ``wanted`` (numbers) and ``stamps`` (text).

    Raises
    ------
    InputError
        With file, line and column of what is not a number.
    """
    import pandas as pd

    layout = find_layout(path, source)
    places: dict[str | int, int] = {}
    for column in (*stamps, *wanted):
        places[column] = place_of(column, layout.headings, layout.width, path.name)
    if source.first_row == 0 or not all(isinstance(column, int) for column in places):
        _refuse_surplus(path, source, layout)
    beyond = next((column for column, place in places.items() if place >= layout.width), None)
    if beyond is not None:
        line = _line_of(path, layout, source.comment, 0)
        raise InputError(
            f"{path.name} line {line} has {layout.width} cells for {len(layout.headings)} headings, and none for the "
            f"column '{beyond}'",
            parameter="file",
            remedy="check the headings and the delimiter",
        )
    kinds: dict[int, Any] = {places[column]: str for column in stamps}
    first = 0
    try:
        # All columns are parsed: with a choice of columns pandas overlooks rows that are too long
        with pd.read_csv(
            path,
            sep=layout.delimiter,
            header=None,
            index_col=False,
            dtype=kinds,
            skiprows=layout.skipped,
            encoding=layout.encoding,
            decimal=source.decimal,
            comment=source.comment or None,
            skipinitialspace=True,
            chunksize=rows,
            low_memory=False,
        ) as reader:
            for frame in reader:
                columns: dict[str | int, NDArray[Any]] = {}
                for column in wanted:
                    columns[column] = _numbers(frame[places[column]], path, source, layout, column, first)
                for column in stamps:
                    columns[column] = frame[places[column]].to_numpy(dtype=object)
                yield RawChunk(columns, first)
                first += len(frame)
    except pd.errors.EmptyDataError:
        raise InputError(f"{path.name} has no samples", parameter="file") from None
    except pd.errors.ParserError as error:
        words, remedy = _parser_words(str(error))
        raise InputError(f"{path.name}: {words}", parameter="file", remedy=remedy) from None
    except UnicodeDecodeError as error:
        raise InputError(
            f"{path.name} is not {layout.encoding}: {error.reason}",
            parameter="encoding",
            remedy="try cp932 (Shift-JIS), utf-8 or latin-1",
        ) from None


def _parser_words(text: str) -> tuple[str, str]:
    """Return what pandas says of a row that is too long in our words, with its remedy."""
    match = re.search(r"Expected (\d+) fields in line (\d+), saw (\d+)", text)
    if match:
        return f"line {int(match[2])} has {match[3]} cells, the lines before {match[1]}", SURPLUS_REMEDY
    return text.strip(), ""


def _numbers(
    series: Any, path: Path, source: LoggerSource, layout: TextLayout, column: str | int, first: int
) -> NDArray[np.float64]:
    """Return a column as numbers, or say which line is none."""
    import pandas as pd

    if series.dtype != object and not pd.api.types.is_string_dtype(series.dtype):
        if series.dtype == bool:
            series = series.astype(float)
        return np.asarray(series.to_numpy(dtype=np.float64, na_value=np.nan))
    text = series.astype("object")
    plain = text.map(lambda cell: plain_name(cell).replace(source.decimal, ".") if isinstance(cell, str) else cell)
    numbers = pd.to_numeric(plain, errors="coerce")
    signs = {
        plain_name(sign).replace(source.decimal, ".")
        for entry in source.columns
        if entry.column == column
        for sign in entry.missing
        if isinstance(sign, str)
    }
    bad = numbers.isna() & ~text.isna() & (plain != "") & ~plain.isin(signs)
    if bad.any():
        row = int(np.flatnonzero(bad.to_numpy())[0])
        line = _line_of(path, layout, source.comment, first + row)
        remedy = "name the signs that mean 'no value' under 'missing', or check 'decimal' and 'first_row'"
        if column in source.time.columns:
            remedy = "dates need 'time.format': iso, or a pattern such as '%Y/%m/%d %H:%M:%S'"
        elif source.decimal == "." and re.fullmatch(r"\s*[-+]?\d+,\d+\s*", str(text.iloc[row])):
            remedy = "give 'decimal: \",\"' where a comma is the decimal sign"
        shown = layout.headings[place_of(column, layout.headings, layout.width, path.name)] if layout.headings else ""
        raise InputError(
            f"{path.name} line {line}, column '{shown or column}': '{str(text.iloc[row])[:40]}' is not a number",
            parameter=str(column),
            remedy=remedy,
        )
    return np.asarray(numbers.to_numpy(dtype=np.float64))


def _line_of(path: Path, layout: TextLayout, comment: str, row: int) -> int:
    """Return the line (from 1) of a row of samples, comments and empty lines counted."""
    seen = -1
    with path.open(encoding=layout.encoding, errors="replace") as stream:
        for number, line in enumerate(stream, 1):
            if number <= layout.skipped or not line.strip() or (comment and line.lstrip().startswith(comment)):
                continue
            seen += 1
            if seen == row:
                return number
    return layout.skipped + row + 1


def line_of_row(path: Path, source: LoggerSource, row: int) -> int:
    """Return the line of a text file (from 1) that holds sample ``row`` (from 0)."""
    layout = find_layout(path, source)
    return _line_of(path, layout, source.comment, row)


def stated_unit(path: Path, source: LoggerSource, column: str | int) -> str:
    """Return the unit that the heading of a column states, empty where it states none."""
    layout = find_layout(path, source)
    if not layout.headings and isinstance(column, int):
        return ""
    place = place_of(column, layout.headings, layout.width, path.name)
    return split_heading(layout.headings[place])[1] if place < len(layout.headings) else ""
