"""From the variations of a study file to axes: named points, each with what it changes in the base case."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

from moyai.case.paths import resolve
from moyai.core.errors import InputError
from moyai.core.quantities import parse_quantity
from moyai.study import schema
from moyai.study.axes import Axis, Point, StudyBase
from moyai.study.lost_lines import lines_lost
from moyai.study.variations_of_files import contour, scatter, spectra, table


def axes_of(variation: schema.VariationKeys, ground: StudyBase) -> tuple[Axis, ...]:
    """Return the axes that one variation gives; whether the case has their paths is not looked at.

    Parameters
    ----------
    variation : Variation
        As read.
    ground : Ground
        The base case and where files stand.

    Raises
    ------
    InputError
        With what is wrong; ``path`` names the key below the variation.
    """
    for kind, build in _BUILDERS.items():
        given = getattr(variation, kind)
        if given is not None and given is not False:
            return build(given, ground)
    return ()


def wrong_paths(axes: tuple[Axis, ...], base: Any) -> list[InputError]:
    """Return what is wrong with paths that the base case does not have, each path once."""
    points = [point for axis in axes for point in axis.points]
    named = [path for point in points for path in (*dict(point.assignments), *point.removals)]
    found = []
    for path in dict.fromkeys(named):
        try:
            resolve(base, path)
        except InputError as error:
            found.append(error)
    return found


def _grid(given: Mapping[str, Any], ground: StudyBase) -> tuple[Axis, ...]:
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
    if first > last:
        raise InputError(
            f"the range at '{path}' runs backwards: 'from' {values.first} is not below 'to' {values.last}",
            path=path,
            remedy=f"write from: {values.last}, to: {values.first}",
        )
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


def _list(given: schema.ListOfCases, ground: StudyBase) -> tuple[Axis, ...]:
    return (
        Axis(given.name, tuple(Point(entry.label, tuple(entry.set.items()), entry.remove) for entry in given.cases)),
    )


def _return_periods(given: schema.ReturnPeriods, ground: StudyBase) -> tuple[Axis, ...]:
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


def _sample(given: schema.SampleKeys, ground: StudyBase) -> tuple[Axis, ...]:
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


def _seeds(given: schema.Seeds, ground: StudyBase) -> tuple[Axis, ...]:
    seeds = range(given.first, given.first + given.count)
    return (Axis(given.name, tuple(Point(str(seed), ((given.path, seed),)) for seed in seeds)),)


def _text(value: Any) -> str:
    return f"{value:g}" if isinstance(value, float) else str(value)


_BUILDERS: dict[str, Callable[[Any, StudyBase], tuple[Axis, ...]]] = {
    "grid": _grid,
    "list": _list,
    "table": table,
    "return_periods": _return_periods,
    "scatter": scatter,
    "contour": contour,
    "spectra": spectra,
    "sample": _sample,
    "seeds": _seeds,
    "lines_lost": lines_lost,
}
