"""From the files of a logger to records in SI, by the chunk: units, missing values, instants, the clock's error.

Memory stays bounded by the length of a chunk, so that weeks at 10 Hz pass through.
"""

from __future__ import annotations

import contextlib
import math
import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from moyai.core.arrays import Array
from moyai.core.errors import InputError
from moyai.core.quantities import TIME, check_unit
from moyai.core.stand_ins import find_stand_ins
from moyai.core.units import Unit, parse_unit
from moyai.core.validity import Notice
from moyai.core.wording import counted
from moyai.records.reading import arrays as read_arrays
from moyai.records.reading.doubts import stand_in_notice
from moyai.records.reading.record import Record, concatenate, instant_text
from moyai.records.reading.sources import SECONDS_PER, ColumnSource, LoggerSource
from moyai.records.reading.text import RawChunk, line_of_row, read_text, stated_unit

CHUNK_ROWS = 131_072
"""Rows read at a time: 10 MB for ten channels."""

_DAYS_1970 = {"datenum": 719529.0, "excel": 25569.0}
"""1970-01-01 in the days of MATLAB (from year 0) and of spreadsheets (from 1899-12-30)."""


def si_symbol(unit: Unit) -> str:
    """Return the SI symbol of a unit's dimension: ``N`` for tf, ``m/s`` for kn, ``rad`` for deg."""
    found = unit.dimension
    for symbol in ("m", "s", "kg", "N", "Pa", "rad", "m/s", "m/s2", "rad/s", "N/m", "N m", "m2", "m3", "kg/m3", "Hz"):
        candidate = parse_unit(symbol)
        if candidate.dimension == found and (symbol != "Hz" or unit.symbol == "Hz"):
            return symbol
    upper, lower = [], []
    exponents = {"m": found.length, "kg": found.mass, "s": found.time, "rad": found.angle}
    for symbol, exponent in exponents.items():
        text = symbol + (str(abs(exponent)) if abs(exponent) > 1 else "")
        if exponent > 0:
            upper.append(text)
        elif exponent < 0:
            lower.append(text)
    text = " ".join(upper) or ("1" if lower else "")
    return text + ("/" + (lower[0] if len(lower) == 1 else f"({' '.join(lower)})") if lower else "")


def read_record(source: LoggerSource, *, start: float = -math.inf, end: float = math.inf) -> Record:
    """Read a logger whole; see :func:`read_chunks` for long ones.

    Parameters
    ----------
    source : LoggerSource
        Files, columns and clock.
    start, end : float
        Part to keep [s].

    Returns
    -------
    Record
        Times and channels in SI units.

    Raises
    ------
    InputError
        With file, row and column of what is wrong.

    Examples
    --------
    >>> from pathlib import Path
    >>> from tempfile import mkdtemp
    >>> from moyai.records import ColumnSource, LoggerSource, TimeSource, read_record
    >>> file = Path(mkdtemp()) / "logger.csv"
    >>> _ = file.write_text("t [s],level [cm]\\n0.0,10.0\\n0.5,-20.0\\n", encoding="utf-8")
    >>> record = read_record(LoggerSource("gauge", (file,), (ColumnSource("level", "level"),), TimeSource(("t",))))
    >>> record.units, record.values[:, 0].tolist()
    (('m',), [0.1, -0.2])
    """
    return concatenate(chunk.between(start, end) for chunk in read_chunks(source))


def read_chunks(source: LoggerSource, rows: int = CHUNK_ROWS) -> Iterator[Record]:
    """Yield the record of a logger in chunks of at most ``rows`` rows, in SI and on the corrected clock.

    Parameters
    ----------
    source : LoggerSource
    rows : int
        Rows of a chunk.

    Yields
    ------
    Record

    Raises
    ------
    InputError
        With file, row and column of what is wrong: no number, time that does not increase, unknown unit, a column
        without any value.
    """
    names = tuple(column.name for column in source.columns)
    clock = _LoggerClock(source)
    holds_value = np.zeros(len(names), dtype=bool)
    seen, reported = 0, set[tuple[Path, str]]()
    for path in source.files:
        if not path.is_file():
            raise InputError(f"no such file: {path}", parameter="files")
        units = _units_of(path, source)
        clock.open(path)
        for raw in _raw(path, source, rows):
            values = np.column_stack(
                [
                    _values(raw.columns[column.column], column, unit[0], source.decimal)
                    for column, unit in zip(source.columns, units)
                ]
            )
            time, kept, notices = clock.instants(raw)
            for column in source.columns:
                if (path, column.name) not in reported and (doubts := _stand_ins(raw, column, path, source)):
                    reported.add((path, column.name))
                    notices = (*notices, *doubts)
            holds_value |= np.isfinite(values).any(axis=0)
            seen += len(raw)
            values = values if kept is None else values[kept]
            if time.size:
                symbols = tuple(unit[1] for unit in units)
                yield Record(time, values, names, symbols, clock.dated, path.name, notices=notices)
    if seen and not holds_value.all():
        column = source.columns[int(np.argmin(holds_value))]
        raise InputError(
            f"{_file_names(source)}, column '{column.column}' holds no value at all in {seen} rows",
            parameter=f"channels.{column.name}",
            remedy="check the column, and the signs of 'missing'",
        )


def _stand_ins(raw: RawChunk, column: ColumnSource, path: Path, source: LoggerSource) -> tuple[Notice, ...]:
    """Return notices of numbers in a column that seem to mean 'no value' and are not named so."""
    found = find_stand_ins(_without_signs(raw.columns[column.column], column, source.decimal))
    return tuple(
        stand_in_notice(
            f"{path.name}, column '{column.column}'",
            sign,
            count,
            row_of_sample(path, source, raw.first + row),
            "name it under 'missing'",
        )
        for sign, count, row in found
    )


def row_of_sample(path: Path, source: LoggerSource, row: int) -> str:
    """Return where sample ``row`` (from 0) stands in a file: its line in a text, else its row."""
    if source.format_of(path) == "csv":
        return f"line {line_of_row(path, source, row)}"
    return f"row {row + 1}"


def _file_names(source: LoggerSource) -> str:
    first = source.files[0].name
    return first if len(source.files) == 1 else f"{first} and {len(source.files) - 1} more"


def _raw(path: Path, source: LoggerSource, rows: int) -> Iterator[RawChunk]:
    form = source.format_of(path)
    wanted = [column.column for column in source.columns]
    stamps = list(source.time.columns)
    if form == "csv":
        if source.time.form == "number":
            yield from read_text(path, source, [*wanted, *stamps], [], rows)
        else:
            yield from read_text(path, source, wanted, stamps, rows)
        return
    for column in (*wanted, *stamps):
        if not isinstance(column, str):
            raise InputError(
                f"{path.name}: columns of {form} files have names", parameter="column", remedy="write the name"
            )
    names = list(dict.fromkeys(str(column) for column in (*wanted, *stamps)))
    readers = {"mat": read_arrays.read_mat, "netcdf": read_arrays.read_netcdf, "parquet": read_arrays.read_parquet}
    yield from readers[form](path, names, rows)


def _stated_units(path: Path, source: LoggerSource, columns: Sequence[str | int]) -> list[str]:
    """Return the units that a file states for columns, empty where it states none."""
    form = source.format_of(path)
    if form == "netcdf":
        return read_arrays.netcdf_units(path, [str(column) for column in columns])
    if form == "csv":
        return [stated_unit(path, source, column) for column in columns]
    if form == "parquet":
        return [read_arrays.parquet_unit(path, str(column)) for column in columns]
    return [""] * len(columns)


def _units_of(path: Path, source: LoggerSource) -> list[tuple[Unit, str]]:
    """Return the units of all columns and their SI symbols."""
    form, columns = source.format_of(path), source.columns
    stated = _stated_units(path, source, [column.column for column in columns])
    return [_unit_of(path, form, column, unit) for column, unit in zip(columns, stated, strict=True)]


def _seconds_of(path: Path, source: LoggerSource) -> float:
    """Return the seconds in a unit of the time: of the configuration or of the heading, which must agree."""
    time = source.time
    if time.unit == "1":
        return 1.0
    stated = _stated_units(path, source, time.columns[:1])[0]
    own = known_unit(stated) if stated not in ("", "1", "-") else None
    place = f"{path.name}, column '{time.columns[0]}'"
    if own is not None:
        check_unit(own, (TIME,), place, "time.unit")
        if time.unit and own.to_si(Fraction(1)) != SECONDS_PER.get(time.unit, 86400.0):
            raise InputError(
                f"{place} states the unit [{stated}] and the configuration says '{time.unit}'",
                parameter="time.unit",
                remedy="leave the unit of the time out, or correct the heading if it is wrong",
            )
        return own.to_si(Fraction(1))
    if stated not in ("", "1", "-") and not time.unit:
        raise InputError(
            f"{place} states the unit [{stated}], which is not understood",
            parameter="time.unit",
            allowed="s, ms, us, ns, min, h, d",
            remedy="give the unit of the time, or correct the heading",
        )
    return SECONDS_PER.get(time.unit or "s", 86400.0)


def _unit_of(path: Path, form: str, column: ColumnSource, stated: str) -> tuple[Unit, str]:
    """Return the unit of a column and its SI symbol; what the file states and the configuration says must agree."""
    place = f"{path.name}, column '{column.column}'"
    own = known_unit(stated) if stated else None
    if column.unit:
        try:
            unit = parse_unit(column.unit) if column.unit != "1" else parse_unit("%") ** 0
        except InputError as error:
            raise InputError(f"{place}: {error.fault.message}", parameter="unit", remedy=error.fault.remedy) from None
        check_unit(unit, column.kinds, place, f"channels.{column.name}.unit")
        if own is not None and (own.factor, own.pi_power, own.dimension) != (
            unit.factor,
            unit.pi_power,
            unit.dimension,
        ):
            raise InputError(
                f"{place} states the unit [{stated}] and the configuration says '{column.unit}'",
                parameter="unit",
                remedy="leave 'unit' out, or rename the column if its heading is wrong",
            )
        return unit, si_symbol(unit)
    if own is None:
        if form == "mat":  # which states no units: is the variable there at all?
            read_arrays.check_mat(path, str(column.column))
        reported = f"states the unit [{stated}], which is not understood" if stated else "states no unit"
        raise InputError(f"{place} {reported}", parameter=f"channels.{column.name}.unit", remedy="give 'unit'")
    check_unit(own, column.kinds, place, f"channels.{column.name}.unit")
    return own, si_symbol(own)


_SPELLINGS = {
    "m": ("meter", "metre", "meters", "metres"), "deg": ("degree", "degrees"), "N m": ("Nm",),
    "s": ("sec", "secs", "second", "seconds", "秒"), "ms": ("msec", "millisecond", "milliseconds", "ミリ秒"),
    "min": ("minute", "minutes", "分"), "h": ("hr", "hrs", "hour", "hours", "時間"), "d": ("day", "days", "日"),
}  # fmt: skip


def _spelled(unit: str) -> str:
    """Return ``m s-1`` of CF files and ``degrees`` in our spelling."""
    return next((ours for ours, words in _SPELLINGS.items() if unit.strip() in words), unit.strip())


def known_unit(stated: str) -> Unit | None:
    """Return the unit that a heading states, dimensionless for ``-`` and ``1``; ``None`` where it is not understood."""
    return _parsed(_spelled(stated))


def _parsed(unit: str) -> Unit | None:
    try:
        return parse_unit("%") ** 0 if unit in ("1", "-") else parse_unit(unit)
    except InputError:
        return None


def _without_signs(raw: NDArray[Any], column: ColumnSource, decimal: str) -> Array:
    """Return a column as the file has it, NaN where a sign means 'no value'."""
    values = np.asarray(raw, dtype=np.float64)
    for sign in column.missing:
        with contextlib.suppress(ValueError):  # a word, which the reader of texts has left out
            number = float(sign.replace(decimal, ".") if isinstance(sign, str) else sign)
            values = np.where(np.isclose(values, number, rtol=1e-6, atol=1e-9), np.nan, values)
    return np.where(np.isfinite(values), values, np.nan)


def _values(raw: NDArray[Any], column: ColumnSource, unit: Unit, decimal: str) -> Array:
    values = _without_signs(raw, column, decimal)
    factor = unit.to_si(Fraction(1))
    if column.scale == 1.0 and column.offset == 0.0:
        return values if factor == 1.0 else values * factor
    return (values * column.scale + column.offset) * factor


class _LoggerClock:
    """Turns the stamps of chunk after chunk into instants, and remembers where the last one was."""

    def __init__(self, source: LoggerSource) -> None:
        self.source = source
        self.time = source.time
        self.dated = source.time.dated
        self.last = -math.inf
        self.count = 0
        self.anchor = math.nan
        self.anchor_count = 0
        self.reference = source.clock.reference
        self.path = source.files[0]
        self.file_has_epoch = False
        self.seconds = 1.0

    def open(self, path: Path) -> None:
        """Begin a file."""
        self.path = path
        form = self.source.format_of(path)
        if not self.time.columns or self.time.form != "number":
            return
        column = str(self.time.columns[0])
        if form == "netcdf":
            self.file_has_epoch = " since " in read_arrays.netcdf_units(path, [column])[0]
        elif form == "parquet":
            self.file_has_epoch, zone = read_arrays.parquet_stamps(path, column)
            if zone and self.time.utc_offset != 0.0:
                raise InputError(
                    f"{path.name}, column '{column}' has a time zone ({zone})",
                    parameter="time.utc_offset",
                    remedy="leave 'utc_offset' out: it would count twice",
                )
        if not self.file_has_epoch:
            self.seconds = _seconds_of(path, self.source)
        self.dated = self.dated or self.file_has_epoch

    def instants(self, raw: RawChunk) -> tuple[Array, NDArray[np.bool_] | None, tuple[Notice, ...]]:
        """Return the instants of a chunk, the rows that are kept (None: all) and notices."""
        source, rows = self.time, len(raw)
        if source.columns:
            stamps = self._stamps(raw)
            bad = ~np.isfinite(stamps)
            if bad.any():
                row = int(np.argmax(bad))
                raise InputError(f"{self._place(raw, row)}: there is no time", parameter="time")
            time = self._spread(stamps) if source.rate > 0.0 else stamps
        else:
            start = source.start if math.isfinite(source.start) else 0.0
            time = start + (self.count + np.arange(rows)) / source.rate
        self.count += rows
        time, kept, notices = self._in_order(time, raw)
        return self._corrected(time), kept, notices

    def _stamps(self, raw: RawChunk) -> Array:
        source = self.time
        columns = [raw.columns[column] for column in source.columns]
        if source.form == "number":
            seconds = np.asarray(columns[0], dtype=np.float64)
            if self.file_has_epoch:
                return seconds - source.utc_offset
            if source.unit in _DAYS_1970:
                return (seconds - _DAYS_1970[source.unit]) * 86400.0 - source.utc_offset
            start = source.start if math.isfinite(source.start) else 0.0
            return start + seconds * self.seconds
        return self._dates(columns, raw) - source.utc_offset

    def _dates(self, columns: list[NDArray[Any]], raw: RawChunk) -> Array:
        import pandas as pd

        text = pd.Series(columns[0], dtype="object").astype(str)
        for further in columns[1:]:
            text = text + " " + pd.Series(further, dtype="object").astype(str)
        form = "ISO8601" if self.time.form == "iso" else self.time.form
        zoned = self.time.form == "iso" or "%z" in self.time.form
        own_zone = re.search(r":[\d.,]+\s*(Z|[+-]\d\d:?(\d\d)?)\s*$", text.iloc[0]) if zoned and len(text) else None
        if self.time.utc_offset != 0.0 and own_zone is not None:
            raise InputError(
                f"{self._place(raw, 0)}: '{text.iloc[0][:40]}' states its own offset from UTC ({own_zone[1]})",
                parameter="time.utc_offset",
                remedy="leave 'utc_offset' out: it would count twice",
            )
        try:
            found = pd.to_datetime(text, format=form, utc=True)
        except (ValueError, TypeError):
            each = pd.to_datetime(text, format=form, utc=True, errors="coerce")
            row = int(np.argmax(each.isna().to_numpy())) if each.isna().any() else 0
            raise InputError(
                f"{self._place(raw, row)}: '{text.iloc[row][:40]}' does not fit the time format '{self.time.form}'",
                parameter="time.format",
                remedy="for instance '%Y/%m/%d %H:%M:%S.%f' or iso",
            ) from None
        return np.asarray(found.dt.tz_localize(None).to_numpy("datetime64[ns]").astype(np.int64) * 1e-9)

    def _spread(self, stamps: Array) -> Array:
        """Count samples at the rate from the first stamp on, anew after every gap; equation [eq:records-spread]."""
        rate = self.time.rate
        steps = np.diff(stamps)
        positive = steps[steps > 0.0]
        resolution = float(np.min(positive)) if positive.size else 1.0
        slack = max(resolution, 1.0 / rate) * 1.5
        time = np.empty_like(stamps)
        if math.isnan(self.anchor):
            self.anchor, self.anchor_count = float(stamps[0]), 0
        begin = 0
        while begin < stamps.size:
            counted = self.anchor + (self.anchor_count + np.arange(stamps.size - begin)) / rate
            off = np.abs(stamps[begin:] - counted) > slack
            stop = begin + int(np.argmax(off)) if off.any() else stamps.size
            time[begin:stop] = counted[: stop - begin]
            self.anchor_count += stop - begin
            if stop < stamps.size:
                # A backward stamp stays as it is: the order of time is judged later
                self.anchor, self.anchor_count = float(stamps[stop]), 0
                if stop == begin:
                    time[stop] = stamps[stop]
                    self.anchor_count, stop = 1, stop + 1
            begin = stop
        return time

    def _in_order(self, time: Array, raw: RawChunk) -> tuple[Array, NDArray[np.bool_] | None, tuple[Notice, ...]]:
        before = np.concatenate([[self.last], time[:-1]])
        if not (time <= before).any():
            self.last = float(time[-1])
            return time, None, ()
        highest = np.maximum.accumulate(before)
        late = time <= highest
        row = int(np.argmax(late))
        reported = (
            f"{self._place(raw, row)}: the time {instant_text(time[row], self.dated)} does not come after "
            f"{instant_text(highest[row], self.dated)}"
        )
        if self.time.order == "strict":
            remedy = "sort or cut the file, or give 'order: drop' to leave such rows out"
            if time[row] == highest[row] and not self.time.rate > 0.0:
                remedy = "give 'rate' where the logger rounds its stamps, for instance to whole seconds, or " + remedy
            raise InputError(reported, parameter="time", remedy=remedy)
        kept = ~late
        if kept.any():
            self.last = float(time[kept][-1])
        count = int(late.sum())
        notice = Notice(
            "time-order", f"{counted(count, 'row')} left out: {reported}", float(count), 0.0, remedy="check the logger"
        )
        return time[kept], kept, (notice,)

    def _corrected(self, time: Array) -> Array:
        """Return the instants of a true clock [eq:records-clock]."""
        clock = self.source.clock
        if (clock.offset == 0.0 and clock.drift == 0.0) or not time.size:
            return time
        if math.isnan(self.reference):
            self.reference = float(time[0])
        return time + clock.offset + clock.drift * (time - self.reference)

    def _place(self, raw: RawChunk, row: int) -> str:
        return f"{self.path.name} {row_of_sample(self.path, self.source, raw.first + row)}"


@dataclass(frozen=True)
class RecordBlock:
    """Number of a block of time and the record in it."""

    index: int
    record: Record


def blocks(chunks: Iterator[Record], origin: float, length: float) -> Iterator[RecordBlock]:
    """Cut a stream of chunks into blocks ``origin + i length`` [s]; blocks without a sample are left out.

    Parameters
    ----------
    chunks : iterator of Record
    origin, length : float
        Start of block 0 and the length of a block [s].
    """
    waiting: list[Record] = []
    current: int | None = None
    for chunk in chunks:
        # A sample that stands on the border by rounding belongs to the later block
        numbers = np.floor((chunk.time - origin) / length + 1e-9).astype(np.int64)
        borders = np.flatnonzero(np.diff(numbers)) + 1
        for first, last in zip([0, *borders.tolist()], [*borders.tolist(), len(chunk)]):
            index = int(numbers[first])
            if current is not None and index != current and waiting:
                yield RecordBlock(current, concatenate(waiting))
                waiting = []
            current = index
            waiting.append(chunk.rows(slice(first, last)))
    if waiting and current is not None:
        yield RecordBlock(current, concatenate(waiting))


def aligned(streams: list[Iterator[RecordBlock]]) -> Iterator[tuple[int, list[Record | None]]]:
    """Yield the blocks of several loggers side by side; ``None`` where a logger has no sample in a block."""
    heads: list[RecordBlock | None] = [next(stream, None) for stream in streams]
    while any(head is not None for head in heads):
        index = min(head.index for head in heads if head is not None)
        row: list[Record | None] = []
        for place, head in enumerate(heads):
            if head is not None and head.index == index:
                row.append(head.record)
                heads[place] = next(streams[place], None)
            else:
                row.append(None)
        yield index, row
