"""From the variations of a study file to axes: named points, each with what it changes in the base case."""

from __future__ import annotations

import csv
import itertools
import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from moyai.core.errors import InputError
from moyai.core.quantities import parse_quantity
from moyai.core.units import Dimension
from moyai.study import schema
from moyai.study.paths import resolve, value_of
from moyai.study.scatter import read_scatter

Assignments = tuple[tuple[str, Any], ...]


@dataclass(frozen=True)
class Point:
    """One place on an axis.

    Parameters
    ----------
    label : str
        What stands in tables.
    assignments : tuple of (str, object)
        Path and value of everything that changes.
    removals : tuple of str
        Paths that are left out.
    probability : float
        Weight of the point, NaN where it has none.
    """

    label: str
    assignments: Assignments = ()
    removals: tuple[str, ...] = ()
    probability: float = math.nan


@dataclass(frozen=True)
class Axis:
    """One axis of a study.

    Parameters
    ----------
    name : str
        Name of the dimension.
    points : tuple of Point
        Where it was varied to.
    lost_line : bool
        Its points are the intact structure and lost lines.
    """

    name: str
    points: tuple[Point, ...]
    lost_line: bool = False

    def coordinates(self) -> dict[str, tuple[list[Any], str]]:
        """Return values and SI unit by path (text where they are not all numbers of one kind)."""
        paths = [path for path, _ in self.points[0].assignments]
        found = {}
        for path in paths:
            values = [dict(point.assignments).get(path) for point in self.points]
            found[path] = _numbers(values)
        return found


def axes_of(variation: schema.Variation, base: Any, folder: Path) -> tuple[Axis, ...]:
    """Return the axes that one variation gives.

    Parameters
    ----------
    variation : Variation
        As read.
    base : object
        Content of the base case.
    folder : Path
        From which the study file names other files.

    Raises
    ------
    InputError
        With what is wrong; ``path`` names the key below the variation.
    """
    for kind, build in _BUILDERS.items():
        given = getattr(variation, kind)
        if given is not None and given is not False:
            axes = build(given, base, folder)
            points = [point for axis in axes for point in axis.points]
            named = [path for point in points for path in (*dict(point.assignments), *point.removals)]
            for path in dict.fromkeys(named):
                resolve(base, path)
            return axes
    return ()


def _numbers(values: Sequence[Any]) -> tuple[list[Any], str]:
    """Return quantities as numbers in their common SI unit, anything else as text."""
    quantities = []
    for value in values:
        if isinstance(value, bool) or not isinstance(value, (int, float, str)):
            return [str(value) for value in values], ""
        try:
            quantities.append(parse_quantity(value if isinstance(value, str) else repr(value)))
        except InputError:
            return [str(value) for value in values], ""
    dimension = quantities[0].unit.dimension
    if any(quantity.unit.dimension != dimension for quantity in quantities):
        return [str(value) for value in values], ""
    return [quantity.si for quantity in quantities], si_symbol(dimension)


def si_symbol(dimension: Dimension) -> str:
    """Return the SI unit of a dimension: its own name where it has one, else metres, kilograms and seconds."""
    named = {Dimension(1, 1, -2): "N", Dimension(-1, 1, -2): "Pa", Dimension(0, 1, -2): "N/m"}
    if dimension in named:
        return named[dimension]
    bases = (("kg", dimension.mass), ("m", dimension.length), ("rad", dimension.angle), ("s", dimension.time))
    return " ".join(base if power == 1 else f"{base}{power}" for base, power in bases if power)


def _grid(given: Mapping[str, Any], base: Any, folder: Path) -> tuple[Axis, ...]:
    axes = []
    names = _short_names(list(given))
    for path, values in given.items():
        listed = _spread(values, path) if isinstance(values, schema.Spread) else values
        points = tuple(Point(_text(value), ((path, value),)) for value in listed)
        axes.append(Axis(names[path], points))
    return tuple(axes)


def _short_names(paths: list[str]) -> dict[str, str]:
    """Return the last key of every path, or the whole path where two end alike."""
    last = [path.split(".")[-1] for path in paths]
    return {path: short if last.count(short) == 1 else path for path, short in zip(paths, last)}


def _spread(values: schema.Spread, path: str) -> tuple[Any, ...]:
    first, last, unit = common_unit(values.first, values.last, path)
    numbers = values.spread(first, last, values.count)
    if all(isinstance(end, int) for end in (values.first, values.last)) and all(one.is_integer() for one in numbers):
        # Whole numbers stay whole: the case may ask for them (seeds, numbers of lines)
        return tuple(int(one) for one in numbers)
    return tuple(f"{number!r} {unit}" if unit else number for number in numbers)


def common_unit(first: Any, last: Any, path: str) -> tuple[float, float, str]:
    """Return two values as numbers in the unit of the first."""
    if all(isinstance(value, (int, float)) and not isinstance(value, bool) for value in (first, last)):
        return float(first), float(last), ""
    try:
        one, two = parse_quantity(str(first)), parse_quantity(str(last))
    except InputError as error:
        raise InputError(
            f"{error.fault.message} at '{path}'", path=path, remedy="give two quantities, such as 1 m and 3 m"
        ) from None
    if one.unit.dimension != two.unit.dimension:
        raise InputError(f"{first} and {last} at '{path}' are not of one kind", path=path)
    if one.unit.symbol == "" and two.unit.symbol == "":
        return float(one.number), float(two.number), ""
    return float(one.number), float(one.unit.from_si(two.unit.to_si(two.number))), one.unit.symbol


def _list(given: schema.ListOfCases, base: Any, folder: Path) -> tuple[Axis, ...]:
    return (
        Axis(given.name, tuple(Point(entry.label, tuple(entry.set.items()), entry.remove) for entry in given.cases)),
    )


def _table(given: schema.TableOfCases, base: Any, folder: Path) -> tuple[Axis, ...]:
    file = folder / given.file
    rows = read_rows(file)
    known = list(rows[0])
    for column in (*given.columns, *given.units):
        if column not in known:
            raise InputError(f"{file.name} has no column '{column}'", path="table.columns", allowed=", ".join(known))
    points = []
    for number, row in enumerate(rows, start=2):
        entries = []
        for column, path in given.columns.items():
            text = (row[column] or "").strip()
            if not text:
                raise InputError(f"{file.name}, row {number}: column '{column}' is empty", path="table.file")
            unit = given.units.get(column, "")
            entries.append((path, f"{text} {unit}" if unit else _scalar(text)))
        points.append(Point(str(number - 1), tuple(entries)))
    return (Axis(given.name, tuple(points)),)


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


def _scalar(text: str) -> Any:
    from moyai.case.yaml_reader import core_scalar

    return core_scalar(text)


def _return_periods(given: schema.ReturnPeriods, base: Any, folder: Path) -> tuple[Axis, ...]:
    pairs = given.pairs
    if pairs == "automatic":
        waves = sorted(given.waves, key=_years)
        current = sorted(given.current, key=_years)
        rarest = waves[-1]
        lower_current = _below(current, _years(rarest))
        lower_waves = _below(waves, _years(current[-1]))
        pairs = tuple(dict.fromkeys([(rarest, lower_current), (lower_waves, current[-1])]))
    points = []
    for wave, flow in pairs:
        for word, known, what in ((wave, given.waves, "waves"), (flow, given.current, "current")):
            if word not in known:
                raise InputError(
                    f"no {what} of return period '{word}' are given",
                    path="return_periods.pairs",
                    allowed=", ".join(known),
                )
        entries = (*given.waves[wave].items(), *given.current[flow].items())
        points.append(Point(f"waves {wave}, current {flow}", entries))
    return (Axis(given.name, tuple(points)),)


def _below(labels: list[str], years: float) -> str:
    """Return the rarest of the labels that is more frequent than ``years``, or the most frequent one."""
    less = [label for label in labels if _years(label) < years]
    return less[-1] if less else labels[0]


def _years(label: str) -> float:
    digits = "".join(character for character in label if character.isdigit() or character == ".")
    try:
        return float(digits)
    except ValueError:
        raise InputError(
            f"'{label}' is no return period", path="return_periods", allowed="years, such as '10 yr' or 10"
        ) from None


def _scatter(given: schema.Scatter, base: Any, folder: Path) -> tuple[Axis, ...]:
    cells = read_scatter(folder / given.file, counts=given.counts)
    points = tuple(
        Point(
            f"Hs {cell.significant_height:g} m, T {cell.period:g} s",
            ((given.significant_height, cell.significant_height), (given.period, cell.period)),
            probability=cell.probability,
        )
        for cell in cells
    )
    return (Axis(given.name, points),)


def _contour(given: schema.Contour, base: Any, folder: Path) -> tuple[Axis, ...]:
    from moyai.study.contour import contour_seas

    points = tuple(
        Point(
            f"Hs {height:.3g} m, T {period:.3g} s",
            ((given.significant_height, float(height)), (given.period, float(period))),
        )
        for height, period in zip(*contour_seas(given, folder))
    )
    return (Axis(given.name, points),)


def _spectra(given: schema.SpectraOfFile, base: Any, folder: Path) -> tuple[Axis, ...]:
    from moyai.sea.spectrum_archives import read_archive

    file = folder / given.file
    archive = read_archive(file)
    if given.place >= len(archive.place):
        raise InputError(
            f"{given.file} has no place {given.place}", path="place", allowed=f"0 to {len(archive.place) - 1}"
        )
    places = resolve(base, given.sea)
    sea = value_of(base, places[0])
    if not isinstance(sea, dict):
        raise InputError(f"'{given.sea}' is no sea state", path=given.sea, allowed="for instance waves[0]")
    kept = {key: value for key, value in sea.items() if key in _OF_THE_SEA}
    points = []
    height = archive.significant_height()
    for record in given.records or range(len(archive.time)):
        if record >= len(archive.time):
            raise InputError(f"there is no record {record}", path="records", allowed=f"0 to {len(archive.time) - 1}")
        if not height[record, given.place] > 0.0:
            raise InputError(
                f"record {record} ({archive.time[record]}) of {given.file} holds no energy",
                path="records",
                remedy="list the records that are wanted under 'records'",
            )
        block = {**kept, "kind": "spectrum_file", "file": str(file.resolve()), "record": record, "place": given.place}
        if given.direction:
            bearing = float(archive.direction[record, given.place])
            if not math.isfinite(bearing):
                raise InputError(f"{given.file} tells no direction for record {record}", path="direction")
            block.pop("heading_deg", None)
            block["from_bearing_deg"] = round(bearing, 3)
        points.append(Point(archive.time[record], ((given.sea, block),)))
    return (Axis(given.name, tuple(points)),)


_OF_THE_SEA = ("name", "heading_deg", "from_bearing_deg", "spreading", "seed", "duration")


def _sample(given: schema.Sample, base: Any, folder: Path) -> tuple[Axis, ...]:
    from scipy.stats import qmc

    dimension = len(given.variables)
    if given.method == "sobol":
        exponent = (given.count - 1).bit_length()
        unit = qmc.Sobol(dimension, scramble=True, seed=given.seed).random_base2(exponent)[: given.count]
    else:
        unit = qmc.LatinHypercube(dimension, seed=given.seed).random(given.count)
    columns = []
    for column, (path, spread) in enumerate(given.variables.items()):
        columns.append([(path, value) for value in _draw(spread, unit[:, column], path)])
    points = tuple(Point(str(number + 1), tuple(entries)) for number, entries in enumerate(zip(*columns)))
    return (Axis(given.name, points),)


def _draw(spread: schema.Distribution, quantile: np.ndarray, path: str) -> list[Any]:
    from scipy.special import ndtri

    if spread.uniform is not None:
        first, last, unit = common_unit(*spread.uniform, path)
        if last <= first:
            raise InputError(f"the range at '{path}' is empty", path=path, remedy="give the smaller value first")
        numbers = first + (last - first) * quantile
    elif spread.normal is not None:
        mean, deviation, unit = common_unit(*spread.normal, path)
        numbers = mean + _positive(deviation, path) * ndtri(quantile)
    else:
        assert spread.lognormal is not None
        mean, deviation, unit = common_unit(*spread.lognormal, path)
        if mean <= 0.0:
            raise InputError(f"a lognormal value at '{path}' needs a mean above zero", path=path)
        variance = math.log1p((_positive(deviation, path) / mean) ** 2)
        numbers = np.exp(math.log(mean) - variance / 2 + math.sqrt(variance) * ndtri(quantile))
    return [f"{float(number)!r} {unit}" if unit else float(number) for number in numbers]


def _positive(deviation: float, path: str) -> float:
    if deviation <= 0.0:
        raise InputError(f"the standard deviation at '{path}' is not above zero", path=path)
    return deviation


def _seeds(given: schema.Seeds, base: Any, folder: Path) -> tuple[Axis, ...]:
    seeds = range(given.first, given.first + given.count)
    return (Axis(given.name, tuple(Point(str(seed), ((given.path, seed),)) for seed in seeds)),)


def _lines_lost(given: schema.LinesLost | bool, base: Any, folder: Path) -> tuple[Axis, ...]:
    settings = schema.LinesLost() if given is True else given
    assert isinstance(settings, schema.LinesLost)
    path, lines = _place_of_lines(settings.path, base)
    if isinstance(lines, dict) and not all(isinstance(value, dict) for value in lines.values()):
        # A list of one may stand in the file as a block
        raise InputError("the only line of the structure cannot be lost", path="lines_lost")
    if not isinstance(lines, (list, dict)) or not lines:
        raise InputError(
            f"the case has no list '{settings.path}' of which one could be lost",
            path="lines_lost",
            allowed=", ".join(_lists(base)) or "no list of blocks is in this case",
            remedy="name the list under 'path', or write the losses as a 'list' of cases with 'set' and 'remove'",
        )
    points = [Point("intact")] if settings.intact else []
    if isinstance(lines, dict):
        entries = [(str(key), f"{path}.{key}", line) for key, line in lines.items()]
    else:
        entries = [(_name_of(line, index), f"{path}[{index}]", line) for index, line in enumerate(lines)]
    for name, where, line in entries:
        count = line.get("count", 1) if isinstance(line, dict) else 1
        if isinstance(count, int) and count > 1:
            points.append(Point(f"one of {name}", ((f"{where}.count", count - 1),)))
        elif len(lines) > 1:
            points.append(Point(name, removals=(where,)))
        else:
            raise InputError("the only line of the structure cannot be lost", path="lines_lost")
    return (Axis(settings.name, tuple(points), lost_line=True),)


def _name_of(line: Any, index: int) -> str:
    return str(line.get("name", index)) if isinstance(line, dict) else str(index)


def _place_of_lines(path: str, base: Any) -> tuple[str, Any]:
    """Return where the lines stand, and the lines; where the path is the usual one, wherever the case has 'lines'."""
    try:
        lines = value_of(base, resolve(base, path)[0])
    except InputError:
        lines = None
    if lines is None and path == schema.LinesLost().path:
        found = [place for place in _lists(base) if place.rpartition(".")[2] == path]
        if len(found) == 1:
            return found[0], value_of(base, resolve(base, found[0])[0])
    return path, lines


def _lists(data: Any, place: str = "") -> list[str]:
    """Return the paths of all lists, or blocks of named entries, of which one could be lost."""
    found: list[str] = []
    for key, value in data.items() if isinstance(data, dict) else ():
        where = f"{place}.{key}" if place else str(key)
        entries = value if isinstance(value, list) else list(value.values()) if isinstance(value, dict) else []
        if key not in ("waves", "site") and len(entries) > 1 and all(isinstance(item, dict) for item in entries):
            found.append(where)
        found += _lists(value, where)
    return found


def _text(value: Any) -> str:
    return f"{value:g}" if isinstance(value, float) else str(value)


_BUILDERS: dict[str, Callable[[Any, Any, Path], tuple[Axis, ...]]] = {
    "grid": _grid,
    "list": _list,
    "table": _table,
    "return_periods": _return_periods,
    "scatter": _scatter,
    "contour": _contour,
    "spectra": _spectra,
    "sample": _sample,
    "seeds": _seeds,
    "lines_lost": _lines_lost,
}


@dataclass(frozen=True)
class Combination:
    """One case of the product of all axes.

    Parameters
    ----------
    index : int
        Its number, from 0, the last axis running fastest.
    labels : tuple of str
        Its place on every axis.
    assignments, removals : tuple
        What it changes in the base case, in the order of the axes.
    """

    index: int
    labels: tuple[str, ...]
    assignments: Assignments = ()
    removals: tuple[str, ...] = ()
    options: Assignments = ()

    # Options are what a search inside the case asks for, such as the limit of a trade-off; they start with '@'


def combinations(axes: Sequence[Axis]) -> tuple[Combination, ...]:
    """Return the product of all axes."""
    found = []
    for index, points in enumerate(itertools.product(*(axis.points for axis in axes))):
        found.append(
            Combination(
                index,
                tuple(point.label for point in points),
                tuple(entry for point in points for entry in point.assignments if not entry[0].startswith("@")),
                tuple(path for point in points for path in point.removals),
                tuple(entry for point in points for entry in point.assignments if entry[0].startswith("@")),
            )
        )
    return tuple(found)
