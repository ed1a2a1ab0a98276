"""Wave spectra as wave models and buoys write them: SWAN, WAVEWATCH III, NDBC.

Every reader gives the same: times, places, frequencies, frequency spectra, and mean directions where the file gives
them. Format descriptions: SWAN user manual, appendix on spectral files; WAVEWATCH III user manual, point output; NDBC
web data guide. Checked against files of all three. Other formats are left to the library wavespectra
(:mod:`moyai.sea.spectrum_wavespectra`) where it is installed.
"""

from __future__ import annotations

import math
import re
from datetime import UTC, datetime
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from moyai.core.arrays import Array
from moyai.core.errors import InputError
from moyai.core.foreign_files import open_netcdf, reads
from moyai.sea.direction_widths import direction_widths
from moyai.sea.spectrum_archive import SpectrumArchive, mean_direction
from moyai.sea.spectrum_wavespectra import NETCDF_KINDS, archive_of, kind_of, read_with_wavespectra

if TYPE_CHECKING:
    import xarray as xr


@reads("a file of spectra")
def read_archive(path: str | Path) -> SpectrumArchive:
    """Read a file of spectra; its format is found from its content.

    Parameters
    ----------
    path : path-like
        SWAN spectral file (1-D or 2-D), WAVEWATCH III point spectra (NetCDF or text), NDBC spectral density (recent
        ``data_spec`` and yearly files); anything else goes to wavespectra, if it is installed.

    Raises
    ------
    InputError
        When the file is absent or of another kind, with what was found.
    """
    file = Path(path)
    if not file.is_file():
        raise InputError(f"no such file: {file}", parameter="file")
    head = file.read_bytes()[:200]
    if head[:3] == b"CDF" or head[:4] == b"\x89HDF":
        return _netcdf(file)
    if kind_of(file):
        return read_with_wavespectra(file)
    try:
        text = file.read_text(encoding="utf-8-sig")
    except UnicodeDecodeError:
        text = file.read_text(encoding="latin-1")
    first = text.lstrip()[:60]
    if first.upper().startswith("SWAN"):
        return _swan(text, file)
    if "WAVEWATCH III SPECTRA" in first:
        return _ww3_text(text, file)
    if re.match(r"#?YY", first):
        return _ndbc(text, file)
    try:
        return read_with_wavespectra(file)
    except InputError as error:
        raise InputError(
            f"{file.name} is no file of spectra that is known here (it starts with {first[:30]!r})",
            parameter="file",
            allowed="SWAN, WAVEWATCH III or NDBC; a table of two columns goes without 'record'",
            remedy="; ".join(part for part in (error.fault.message, error.fault.remedy) if part),
        ) from None


class _Lines:
    """The lines of a file, read one after the other, with their numbers for messages."""

    def __init__(self, text: str, file: Path) -> None:
        self.lines, self.file, self.at = text.splitlines(), file, 0

    def more(self) -> bool:
        while self.at < len(self.lines) and not self.lines[self.at].strip():
            self.at += 1
        return self.at < len(self.lines)

    def next(self) -> str:
        if not self.more():
            raise self.fault("the file ends too early")
        self.at += 1
        return self.lines[self.at - 1]

    def numbers(self, count: int) -> Array:
        """Return the next numbers, over as many lines as they take."""
        found: list[float] = []
        while len(found) < count:
            line = self.next()
            try:
                found += [float(word) for word in line.replace("D", "E").split()]
            except ValueError:
                raise self.fault(f"expected numbers, found {line.strip()[:40]!r}") from None
        return np.array(found[:count])

    def whole(self) -> int:
        word = (self.next().split() or [""])[0]
        try:
            return int(word)
        except ValueError:
            raise self.fault(f"expected a whole number, found {word!r}") from None

    def fault(self, message: str) -> InputError:
        return InputError(f"{self.file.name}, line {self.at}: {message}", parameter="file")


def _swan(text: str, file: Path) -> SpectrumArchive:
    lines = _Lines("\n".join(line for line in text.splitlines() if not line.startswith("$")), file)
    lines.next()
    timed, places, frequency, directions, nautical = False, ["point"], np.zeros(0), np.zeros(0), True
    exception, energy_unit, columns = -99.0, 1.0, 1
    times: list[str] = []
    density: list[list[Array]] = []
    mean: list[list[float]] = []
    energy: list[list[Array | None]] = []
    while lines.more():
        line = lines.next()
        word = line.split()[0].upper()
        if word == "TIME":
            timed = True
            lines.whole()
        elif word in ("LONLAT", "LOCATIONS"):
            places = [" ".join(lines.next().split()[:2]) for _ in range(lines.whole())]
        elif word in ("AFREQ", "RFREQ"):
            frequency = lines.numbers(lines.whole())
        elif word in ("NDIR", "CDIR"):
            nautical = word == "NDIR"
            directions = lines.numbers(lines.whole())
        elif word == "QUANT":
            columns = lines.whole()
            names = []
            for number in range(columns):
                names.append(lines.next().split()[0])
                unit = lines.next().split()[0]
                value = float(lines.next().split()[0])
                if number == 0:
                    exception = value
                    # Energy density in J/m2/Hz is that of sea water as SWAN assumes it
                    energy_unit = 1.0 / (1025.0 * 9.81) if unit.startswith("J") else 1.0
            if names[0] not in ("VaDens", "EnDens"):
                raise lines.fault(f"the first quantity is {names[0]}, not a density")
        elif timed and re.match(r"\d{8}\.\d{4,6}", line.strip()):
            stamp = line.split()[0]
            times.append(f"{stamp[:4]}-{stamp[4:6]}-{stamp[6:8]}T{stamp[9:11]}:{stamp[11:13]}")
            density.append([])
            mean.append([])
            energy.append([])
        elif word in ("FACTOR", "ZERO", "NODATA", "LOCATION"):
            if not timed and not times:
                times, density, mean, energy = ["stationary"], [[]], [[]], [[]]
            values, from_where, whole = _swan_block(
                word, lines, frequency, directions, nautical, exception, energy_unit, columns
            )
            density[-1].append(values)
            mean[-1].append(from_where)
            energy[-1].append(whole)
        else:
            raise lines.fault(f"unknown key {word!r}")
    if not frequency.size or not density:
        raise lines.fault("no frequencies or no spectra")
    if any(len(row) != len(places) for row in density):
        raise lines.fault("a time holds other than one block a place")
    turned = directions.size > 1 and columns == 1
    return SpectrumArchive(
        "swan", tuple(times), tuple(places), frequency, np.array(density), np.array(mean, dtype=float),
        _came_from(directions, nautical) if turned else None, np.array(energy, dtype=float) if turned else None,
    )  # fmt: skip


def _came_from(directions: Array, nautical: bool) -> Array:
    """Return where waves come from; Cartesian directions are where they go, counter-clockwise from east."""
    return directions if nautical else np.asarray((270.0 - directions) % 360.0)


def _swan_block(
    word: str, lines: _Lines, frequency: Array, directions: Array, nautical: bool, exception: float, unit: float,
    columns: int,
) -> tuple[Array, float, Array]:  # fmt: skip
    """Return the frequency spectrum of one block, its mean direction (coming from, from north) and its energy."""
    count = frequency.size
    if word in ("NODATA", "ZERO"):
        value = math.nan if word == "NODATA" else 0.0
        return np.full(count, value), math.nan, np.full((count, directions.size), value)
    if word == "LOCATION":
        table = lines.numbers(count * columns).reshape(count, columns)
        values = np.where(table[:, 0] == exception, 0.0, table[:, 0]) * unit
        mean = float(table[int(np.argmax(values)), 1]) % 360.0 if columns > 1 else math.nan
        return values, mean, np.zeros((count, directions.size))
    factor = float(lines.next().split()[0])
    raw = lines.numbers(count * directions.size).reshape(count, directions.size)
    spread = np.where(raw == exception, 0.0, raw) * factor * unit
    widths = direction_widths(directions) if directions.size > 1 else np.ones(1)
    whole = spread * widths
    return spread @ widths, mean_direction(whole, _came_from(directions, nautical), frequency), whole


def _ww3_text(text: str, file: Path) -> SpectrumArchive:
    lines = _Lines(text, file)
    heading = re.search(r"'\s+(\d+)\s+(\d+)\s+(\d+)", lines.next())
    if heading is None:
        raise lines.fault("the heading lacks the numbers of frequencies, directions and points")
    count, turns, points = (int(item) for item in heading.groups())
    frequency, directions = lines.numbers(count), lines.numbers(turns)
    widths = np.radians(direction_widths(np.degrees(directions)))
    times: list[str] = []
    places: list[str] = []
    came_from = (np.degrees(directions) + 180.0) % 360.0
    density: list[list[Array]] = []
    energy: list[list[Array]] = []
    mean: list[list[float]] = []
    while lines.more():
        stamp = lines.next().split()
        times.append(f"{stamp[0][:4]}-{stamp[0][4:6]}-{stamp[0][6:8]}T{stamp[1][:2]}:{stamp[1][2:4]}")
        density.append([])
        energy.append([])
        mean.append([])
        for _ in range(points):
            name = lines.next().split("'")[1].strip()
            if len(places) < points:
                places.append(name)
            # Fortran order: frequency runs first; values per radian and hertz
            spread = lines.numbers(count * turns).reshape(turns, count).T
            density[-1].append(spread @ widths)
            energy[-1].append(spread * widths)
            # Like in its NetCDF files, directions are where the waves go, clockwise from north (here in radians)
            mean[-1].append(mean_direction(spread * widths, came_from, frequency))
    return SpectrumArchive(
        "ww3", tuple(times), tuple(places), frequency, np.array(density), np.array(mean), came_from, np.array(energy)
    )


def _netcdf(file: Path) -> SpectrumArchive:
    """Read a NetCDF file by what it holds: readers of other programs read each other's files, with wrong units."""
    with open_netcdf(file, "a file of spectra") as data:
        if {"freq", "efth"} <= {str(name) for name in data.variables}:
            return archive_of(data, "wavespectra")
        if not {"frequency", "direction", "efth"} <= {str(name) for name in data.variables}:
            held = [str(name) for name in data.variables]
            kind = next((kind for name, kind in NETCDF_KINDS.items() if name in held), "")
            if not kind:
                raise InputError(
                    f"{file.name} holds no spectra that are known here", parameter="file",
                    allowed="efth of WAVEWATCH III or wavespectra, d2fd of ERA5, density of SWAN, AC of WWM; it holds "
                    + ", ".join(held[:6]),
                )  # fmt: skip
            return read_with_wavespectra(file, kind)
        return _ww3_netcdf(data)


def _ww3_netcdf(data: xr.Dataset) -> SpectrumArchive:
    frequency = np.asarray(data["frequency"].values, dtype=float)
    directions = np.asarray(data["direction"].values, dtype=float)
    name = "station" if "station" in data["efth"].dims else None
    dims = ["time", *([name] if name else []), "frequency", "direction"]
    spread = np.asarray(data["efth"].transpose(*dims).values, dtype=float)
    if name is None:
        spread = spread[:, None]
    times = tuple(str(value)[:16] for value in data["time"].values)
    widths = direction_widths(directions)
    if "deg" not in str(data["efth"].attrs.get("units", "")):
        widths = np.radians(widths)
    # In WAVEWATCH III's point files the directions are where the waves go, clockwise from north
    came_from = (directions + 180.0) % 360.0
    mean = np.array(
        [[mean_direction(np.nan_to_num(one) * widths, came_from, frequency) for one in row] for row in spread]
    )
    places = tuple(f"station {number + 1}" for number in range(spread.shape[1]))
    return SpectrumArchive("ww3", times, places, frequency, spread @ widths, mean, came_from, spread * widths)


#: Numbers in front of frequencies in brackets; a number starts where none continues, else a long one is read again from
#: each of its digits.
_BEFORE_BRACKETS = re.compile(r"(?<![\d.])([\d.]+)\s+\(")


#: What the headings of NDBC's other files begin with, and what they hold.
_NO_DENSITY = {
    r"\b(WDIR|WSPD|WVHT|WTMP|PRES|BAR|WSPM|GSP|GDR|GST|DEPTH|HEIGHT)\b": "meteorological observations",
    r"\balpha[12]_\d": "mean directions",
    r"\br[12]_\d": "moments of the directions",
}


def _ndbc(text: str, file: Path) -> SpectrumArchive:
    rows = [line for line in text.splitlines() if line.strip()]
    # A number and an underscore behind alpha and r: mean directions and their first two moments
    what = next((words for pattern, words in _NO_DENSITY.items() if re.search(pattern, rows[0], re.IGNORECASE)), "")
    if what:
        raise InputError(
            f"{file.name} holds {what} of NDBC, no spectra",
            parameter="file",
            allowed="NDBC's spectral wave density (swden, data_spec or the yearly file NNNNNwYYYY)",
            remedy="fetch the station's spectral wave density",
        )
    paired = "(" in rows[1] if len(rows) > 1 else False
    times, density = [], []
    if paired:
        frequency = np.array([float(item) for item in re.findall(r"\(([\d.]+)\)", rows[1])])
        for number, row in enumerate(rows[1:], start=2):
            values = [float(item) for item in _BEFORE_BRACKETS.findall(row)]
            if len(values) != frequency.size:
                raise InputError(
                    f"{file.name}, line {number}: {len(values)} values, not {frequency.size}", parameter="file"
                )
            times.append(_stamp(row.split()[:5], f"{file.name}, line {number}"))
            # 999 stands for missing
            density.append([math.nan if value >= 999.0 else value for value in values])
    else:
        header = rows[0].lstrip("#").split()
        leading = 5 if "mm" in header[:6] else 4
        frequency = np.array([_number(item, f"{file.name}, line 1") for item in header[leading:]])
        for number, row in enumerate(rows[1:], start=2):
            words = row.split()
            if words[0].startswith("#"):
                continue
            if len(words) != len(header):
                raise InputError(
                    f"{file.name}, line {number}: {len(words)} values, not {len(header)}", parameter="file"
                )
            where = f"{file.name}, line {number}"
            times.append(_stamp([*words[:leading], "00"][:5], where))
            values = [_number(item, where) for item in words[leading:]]
            density.append([math.nan if value >= 999.0 else value for value in values])
    order = np.argsort(times)
    table = np.array(density)[order][:, None, :]
    direction = _ndbc_direction(file, len(times), order)
    place = re.match(r"\w+?(?=[.w])", file.name)
    return SpectrumArchive(
        "ndbc", tuple(times[i] for i in order), (place[0] if place else "buoy",), frequency, table, direction
    )


def _ndbc_direction(file: Path, count: int, order: NDArray[np.intp]) -> Array:
    """Return the mean directions of the energy, from the files of first moments that lie next to the densities."""
    companions = [file.with_suffix(suffix) for suffix in (".swdir", ".swr1")]
    nothing = np.full((count, 1), math.nan)
    if file.suffix != ".data_spec" or not all(other.is_file() for other in companions):
        return nothing

    def table(path: Path) -> Array:
        rows = [line for line in path.read_text(encoding="latin-1").splitlines()[1:] if line.strip()]
        return np.array([[float(item) for item in _BEFORE_BRACKETS.findall(row)] for row in rows])

    density, angle, first = table(file), table(companions[0]), table(companions[1])
    if not density.shape == angle.shape == first.shape:
        return nothing
    good = (density < 999.0) & (angle < 999.0) & (first < 999.0)
    weight = np.where(good, density * first, 0.0)
    mean = np.degrees(
        np.arctan2((weight * np.sin(np.radians(angle))).sum(axis=1), (weight * np.cos(np.radians(angle))).sum(axis=1))
    )
    return np.asarray((mean % 360.0)[order][:, None])


def _number(word: str, place: str) -> float:
    try:
        return float(word)
    except ValueError:
        raise InputError(f"{place}: {word[:40]!r} is not a number", parameter="file") from None


def _stamp(words: list[str], place: str) -> str:
    """Return ISO 8601 of year, month, day, hour and minute; years of two digits are of the last century."""
    try:
        year, month, day, hour, minute = map(int, words)
        moment = datetime(year if year > 100 else 1900 + year, month, day, hour, minute, tzinfo=UTC)
    except ValueError:
        shown = " ".join(words)[:40]
        raise InputError(f"{place}: {shown!r} is no year, month, day, hour, minute", parameter="file") from None
    return moment.strftime("%Y-%m-%dT%H:%M")
