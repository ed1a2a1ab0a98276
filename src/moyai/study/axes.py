"""Axes of a study: named points, each with what it changes in the base case, and the product of them."""

from __future__ import annotations

import copy
import itertools
import math
import os
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from moyai.case.paths import assign, remove, resolve
from moyai.case.yaml_reader import CaseDocument
from moyai.core.errors import InputError
from moyai.core.quantities import parse_quantity
from moyai.core.units import Dimension

Assignments = tuple[tuple[str, Any], ...]


@dataclass(frozen=True)
class StudyBase:
    """On what the variations of a study stand."""

    #: Content of the base case.
    base: Any
    #: From which the study file names other files.
    folder: Path
    #: From which the base case names other files.
    base_folder: Path

    def named_by_the_base(self, file: str) -> str:
        """Return how the base case would name a file that the study file names.

        Relative names stay relative, so that a study that was moved with all its files is the same study.
        """
        if Path(file).is_absolute():
            return file
        try:
            return Path(os.path.relpath((self.folder / file).resolve(), self.base_folder.resolve())).as_posix()
        except ValueError:
            # Two drives of Windows
            return str((self.folder / file).resolve())


@dataclass(frozen=True)
class Point:
    """One place on an axis."""

    #: What stands in tables.
    label: str
    #: Path and value of everything that changes.
    assignments: Assignments = ()
    #: Paths that are left out.
    removals: tuple[str, ...] = ()
    #: Weight of the point, NaN where it has none.
    probability: float = math.nan


@dataclass(frozen=True)
class Axis:
    """One axis of a study."""

    #: Name of the dimension.
    name: str
    #: Where it was varied to.
    points: tuple[Point, ...]
    #: Its points are the intact structure and lost lines.
    lost_line: bool = False

    def coordinates(self) -> dict[str, tuple[list[Any], str]]:
        """Return values and SI unit by path (text where they are not all numbers of one kind)."""
        paths = [path for path, _ in self.points[0].assignments]
        found = {}
        for path in paths:
            values = [dict(point.assignments).get(path) for point in self.points]
            found[path] = _numbers(values)
        return found


@dataclass(frozen=True)
class Combination:
    """One case of the product of all axes."""

    #: Its number, from 0, the last axis running fastest.
    index: int
    #: Its place on every axis.
    labels: tuple[str, ...]
    #: What it sets in the base case, in the order of the axes.
    assignments: Assignments = ()
    #: What it removes from the base case, in the order of the axes.
    removals: tuple[str, ...] = ()
    options: Assignments = ()

    # Options are what a search inside the case requires, such as the limit of a trade-off; they start with '@'


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


def varied(base: CaseDocument, combination: Combination) -> CaseDocument:
    """Return the base case with what a combination changes; places in the file stay those of the base case."""
    data = copy.deepcopy(base.data)
    for path, value in combination.assignments:
        for place in resolve(data, path):
            assign(data, place, copy.deepcopy(value))
    places = [place for path in combination.removals for place in resolve(data, path)]
    # Later entries of a list first, so that the numbers of the others stay
    for place in sorted(places, key=lambda place: [str(item).zfill(9) for item in place], reverse=True):
        remove(data, place)
    return replace(base, data=data)


def without(axes: Sequence[Axis], paths: Sequence[str]) -> tuple[Axis, ...]:
    """Return axes that leave some paths of the case alone."""

    def point(one: Point) -> Point:
        kept = tuple(entry for entry in one.assignments if entry[0] not in paths)
        return replace(one, assignments=kept, removals=tuple(path for path in one.removals if path not in paths))

    return tuple(replace(axis, points=tuple(point(one) for one in axis.points)) for axis in axes)


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
