"""What is known about a logger's files: where the columns are, their units, the clock."""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

from moyai.core.errors import InputError
from moyai.core.options import checks_words
from moyai.core.quantities import QuantityKind

Format = Literal["auto", "csv", "mat", "netcdf", "parquet"]
TimeUnit = Literal["", "1", "s", "ms", "us", "ns", "min", "h", "d", "datenum", "excel"]

SECONDS_PER = {"s": 1.0, "ms": 1e-3, "us": 1e-6, "ns": 1e-9, "min": 60.0, "h": 3600.0, "d": 86400.0}
ENDINGS = {
    ".csv": "csv", ".txt": "csv", ".dat": "csv", ".tsv": "csv", ".asc": "csv", ".raw": "csv", ".wad": "csv",
    ".mat": "mat", ".nc": "netcdf", ".nc4": "netcdf", ".cdf": "netcdf", ".parquet": "parquet", ".pq": "parquet",
}  # fmt: skip
#: How instants may be written, in words.
FORMS = "number, iso, or a pattern such as '%Y/%m/%d %H:%M:%S'"


def is_form(text: object) -> bool:
    """Whether a text says how instants are written."""
    return text in ("number", "iso") or (isinstance(text, str) and "%" in text)


@dataclass(frozen=True)
class ColumnSource:
    """One column of a file and what it becomes.

    Examples
    --------
    >>> from moyai.records import ColumnSource
    >>> level = ColumnSource("h [cm]", "level", unit="cm", missing=(-99.9, "****"))
    >>> level.name, level.unit
    ('level', 'cm')
    """

    #: Heading in the file (with or without its unit), a variable (``vel[0,3]`` for an entry of its other dimensions),
    #: or a number counted from 1.
    column: str | int
    #: Name of the channel.
    name: str
    #: Unit in the file; empty takes the one that the file states.
    unit: str = ""
    #: Factor, applied before the unit: ``value * scale + offset``.
    scale: float = 1.0
    #: Added after the factor, before the unit.
    offset: float = 0.0
    #: Numbers and words that mean "no value"; a word that is a number (``"-99"``) is read as that number too.
    missing: tuple[float | str, ...] = ()
    #: What the column may be, by its unit; empty for anything.
    kinds: tuple[QuantityKind, ...] = ()

    def __post_init__(self) -> None:
        if isinstance(self.missing, (str, float, int)):
            raise InputError(
                f"'{self.missing}' is one sign, not a list of signs",
                parameter="missing",
                remedy=f"give ({self.missing!r},)",
            )


@checks_words
@dataclass(frozen=True)
class TimeSource:
    """Where the time comes from.

    Examples
    --------
    >>> from moyai.records import TimeSource
    >>> TimeSource(columns=("date", "time"), form="%Y/%m/%d %H:%M:%S").dated
    True
    >>> TimeSource(rate=20.0).dated                                      # no stamps: samples are counted
    False
    """

    #: Column of the time, or two: date and time of day. Empty where the file has none and ``rate`` counts.
    columns: tuple[str | int, ...] = ()
    #: ``number``, ``iso``, or a pattern such as ``%Y/%m/%d %H:%M:%S.%f``.
    form: str = "number"
    #: Unit of a number: seconds and its relatives, or MATLAB's ``datenum``, or ``excel``: days of a spreadsheet. Empty
    #: takes the one that the file states, seconds where it states none; ``1`` takes numbers as they stand.
    unit: TimeUnit = ""
    #: Instant added to numbers [s since 1970 UTC], NaN for a logger's own clock.
    start: float = math.nan
    #: Sampling rate [Hz], NaN where the stamps alone count. With stamps to the whole second, samples are spread evenly
    #: at this rate and the stamps are used to find gaps.
    rate: float = math.nan
    #: Local time minus UTC [s].
    utc_offset: float = 0.0
    #: Instants that do not increase are an error, or are left out and reported.
    order: Literal["strict", "drop"] = "strict"

    def __post_init__(self) -> None:
        if not is_form(self.form):
            raise InputError(f"'{self.form}' is not a known word", parameter="form", allowed=FORMS)
        if not self.columns and not self.rate > 0.0:
            raise InputError("neither a time column nor a rate", parameter="time", remedy="give 'column' or 'rate'")

    @property
    def dated(self) -> bool:
        """Whether the instants are dates."""
        return self.form != "number" or self.unit in ("datenum", "excel") or math.isfinite(self.start)


@dataclass(frozen=True)
class ClockCorrection:
    """Error of a logger's clock; equation [eq:records-clock]."""

    #: Seconds to add at ``reference``.
    offset: float = 0.0
    #: Seconds to add per second of the logger after that.
    drift: float = 0.0
    #: Instant of the logger at which the offset was found [s]; NaN takes the first sample.
    reference: float = math.nan


@checks_words
@dataclass(frozen=True)
class LoggerSource:
    """All that is needed to read one logger.

    Examples
    --------
    >>> from pathlib import Path
    >>> from moyai.records import ColumnSource, LoggerSource, TimeSource
    >>> columns = (ColumnSource("h [cm]", "level", unit="cm"),)
    >>> gauge = LoggerSource("gauge", (Path("gauge.csv"),), columns, TimeSource(columns=("t",)))
    >>> gauge.format_of(Path("gauge.csv"))
    'csv'
    """

    name: str
    #: In the order of time.
    files: tuple[Path, ...]
    columns: tuple[ColumnSource, ...]
    time: TimeSource
    clock: ClockCorrection = ClockCorrection()
    #: ``auto`` goes by the ending.
    format: Format = "auto"
    #: ``auto`` tries UTF-8, UTF-16 with its mark, Shift-JIS as Windows writes it (cp932), in this order.
    encoding: str = "auto"
    #: ``auto``, ``whitespace``, or the character.
    delimiter: str = "auto"
    #: Decimal sign.
    decimal: str = "."
    #: Line of the headings, counted from 1; 0 where there is none; -1: the first line that is not a comment.
    header_row: int = -1
    #: Line of the first sample; 0: the line after the headings.
    first_row: int = 0
    #: Sign that opens a comment, empty for none.
    comment: str = "#"

    def __post_init__(self) -> None:
        if not self.columns:
            raise InputError(f"logger '{self.name}' has no channels", parameter="channels")
        names = [column.name for column in self.columns]
        twice = [name for name in names if names.count(name) > 1]
        if twice:
            raise InputError(f"logger '{self.name}' has the channel '{twice[0]}' twice", parameter="channels")
        if not self.files:
            raise InputError(f"logger '{self.name}' has no files", parameter="files")

    def format_of(self, path: Path) -> str:
        """Return the format of one file.

        Parameters
        ----------
        path : Path
            Of the file; only its ending counts.

        Raises
        ------
        InputError
            When the ending says nothing.
        """
        if self.format != "auto":
            return self.format
        found = ENDINGS.get(path.suffix.lower())
        if found is None:
            raise InputError(
                f"{path.name}: the ending '{path.suffix}' is of no known format",
                parameter="format",
                allowed="csv, mat, netcdf, parquet",
                remedy="give 'format'",
            )
        return found
