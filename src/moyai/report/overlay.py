"""Curves and points of another source over the figures of a report: other results, and measured points of the case."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import Literal

import numpy as np

from moyai.core.arrays import Array
from moyai.core.errors import InputError
from moyai.core.results import Result
from moyai.core.units import parse_unit
from moyai.core.validity import Notice
from moyai.core.vocabulary import MEASURED_GROUP
from moyai.report.document import Block, Chapter, Choice, Document, Figure, NoticeBlock, Panel, Series

_DASHES: tuple[Literal["dash", "dot", "dashdot"], ...] = ("dash", "dot", "dashdot")
_POINT_TONE = 7
_NO_UNIT = ("", "1", "-")


@dataclass(frozen=True)
class Pair:
    """A series of this report and the one of the same name of another result, in one unit."""

    #: Title of the figure.
    figure: str
    #: Series with its panel.
    label: str
    #: Unit of the values.
    unit: str
    #: Abscissa of this report.
    x: Array
    #: Values of this report.
    here: Array
    #: Abscissa of the other result.
    x_there: Array
    #: Values of the other result.
    there: Array


def unit_factor(given: str, wanted: str) -> float:
    """Return the factor that turns values of one unit into another.

    Raises
    ------
    InputError
        When the units are of different dimension.
    """
    if given == wanted or (given in _NO_UNIT and wanted in _NO_UNIT):
        return 1.0
    # Hundredths are a number without unit; the table of units of case files does not hold them
    first, second = (
        (Fraction(1, 100), None) if unit == "%" else (Fraction(1), None if unit in _NO_UNIT else parse_unit(unit))
        for unit in (given, wanted)
    )
    dimensions = [None if unit is None else unit.dimension for _, unit in (first, second)]
    if dimensions[0] != dimensions[1]:
        raise InputError(f"'{given}' cannot be shown in '{wanted}'", path="unit")
    if first[1] is None or second[1] is None:
        return float(first[0] / second[0])
    return first[1].to_si(Fraction(1)) / second[1].to_si(Fraction(1))


def with_figures(document: Document, change: Callable[[Figure], Figure]) -> Document:
    """Return a document with every figure changed, those within choices too."""

    def changed(block: Block) -> Block:
        if isinstance(block, Figure):
            return change(block)
        if isinstance(block, Choice):
            return replace(
                block,
                options=tuple(replace(option, blocks=tuple(map(changed, option.blocks))) for option in block.options),
            )
        return block

    return replace(
        document,
        sections=tuple(replace(section, blocks=tuple(map(changed, section.blocks))) for section in document.sections),
    )


def figures_of(document: Document) -> dict[str, Figure]:
    """Return the figures of a document by their key, the first of each."""
    found: dict[str, Figure] = {}
    for block in document.blocks():
        if isinstance(block, Figure):
            found.setdefault(block.key, block)
    return found


def lay_over(
    document: Document, other: Document, name: str, number: int = 0, *, faint: bool = False
) -> tuple[Document, tuple[Pair, ...]]:
    """Lay the series of another report over every figure that both have.

    Parameters
    ----------
    document, other : Document
        Figures are the same by their key, panels by their words; values are turned into the unit of ``document``.
    name : str
        Name of the other result in the legends.
    number : int
        Which of several others it is; chooses the dash.
    faint : bool
        Whether its series are drawn faint.

    Returns
    -------
    Document
    tuple of Pair
        Series that both have, in the order of the figures.
    """
    others = figures_of(other)
    pairs: list[Pair] = []

    def change(figure: Figure) -> Figure:
        match = others.get(figure.key)
        if match is None:
            return figure
        added = []
        for item in match.series:
            moved = _moved(item, match, figure)
            if moved is None:
                continue
            own = next((one for one in figure.series if (one.label, one.panel) == (moved.label, moved.panel)), None)
            if own is not None:
                pairs.append(_pair(figure, own, moved))
            dash = _DASHES[number % len(_DASHES)] if item.dash == "solid" else _DASHES[(number + 1) % len(_DASHES)]
            added.append(replace(moved, label=f"{item.label} ({name})", dash=dash, faint=item.faint or faint))
        if not added:
            return figure
        caption = f"{figure.caption} Laid over: {name}.".strip()
        return replace(figure, series=(*figure.series, *added), caption=caption)

    return with_figures(document, change), tuple(pairs)


def _moved(item: Series, source: Figure, target: Figure) -> Series | None:
    """Return a series of another figure in the axes of this one; None where it has no place there."""
    panel = source.panels[item.panel]
    index = next((number for number, own in enumerate(target.panels) if own.label == panel.label), None)
    if index is None:
        return None
    try:
        y = np.asarray(item.y, dtype=float) * unit_factor(panel.unit, target.panels[index].unit)
        x = _along(item, source, target)
    except InputError:
        return None
    if item.style == "bar":
        places = {name: number for number, name in enumerate(source.categories)}
        # Bars stand by the names below them, which the other result may have in another order or not at all
        y = np.array([y[places[name]] if name in places else math.nan for name in target.categories])
        return replace(item, y=y, panel=index) if target.categories else None
    return replace(item, x=x, y=y, panel=index) if target.abscissae[0].key in x else None


def _along(item: Series, source: Figure, target: Figure) -> dict[str, Array]:
    units = {axis.key: axis.unit for axis in source.abscissae}
    return {
        axis.key: np.asarray(item.x[axis.key], dtype=float) * unit_factor(units[axis.key], axis.unit)
        for axis in target.abscissae
        if axis.key in item.x and axis.key in units
    }


def _pair(figure: Figure, own: Series, moved: Series) -> Pair:
    panel: Panel = figure.panels[own.panel]
    words = own.label if own.label == panel.label or len(figure.panels) == 1 else f"{panel.label}: {own.label}"
    empty = np.arange(len(own.y), dtype=float)
    key = figure.abscissae[0].key if figure.abscissae else ""
    bars = own.style == "bar"
    return Pair(
        figure.title,
        words,
        panel.unit,
        empty if bars else np.asarray(own.x.get(key, empty), dtype=float),
        np.asarray(own.y, dtype=float),
        empty if bars else np.asarray(moved.x[key], dtype=float),
        np.asarray(moved.y, dtype=float),
    )


def with_measured_points(document: Document, result: Result) -> Document:
    """Lay the measured points of the case over the figures that they name.

    What has no place becomes a notice on the first page that says which figures there are.
    """
    sets = list(_measured_sets(result))
    faults: list[Notice] = []
    for attributes, x, y in sets:
        wanted = str(attributes["figure"])
        keys = places(wanted, figures_of(document))
        if not keys:
            faults.append(_unknown(wanted, str(attributes["file"]), figures_of(document)))
            continue
        try:
            document = with_figures(
                document,
                lambda figure, at=keys, own=attributes, x=x, y=y: (  # type: ignore[misc]
                    _with_points(figure, own, x, y) if figure.key in at else figure
                ),
            )
        except InputError as error:
            faults.append(
                Notice("measured-points", f"points of {attributes['file']}, figure '{wanted}': {error.fault}")
            )
    if not faults:
        return document
    first, *rest = document.sections
    first = Chapter(first.key, first.title, (*first.blocks, NoticeBlock(tuple(faults))))
    return replace(document, sections=(first, *rest))


def misplaced_points(document: Document) -> tuple[str, ...]:
    """Return what :func:`with_measured_points` could not lay over a figure, a line each."""
    return tuple(
        "; ".join(filter(None, (notice.message, notice.remedy)))
        for block in document.blocks()
        if isinstance(block, NoticeBlock)
        for notice in block.notices
        if notice.code == "measured-points"
    )


def places(wanted: str, figures: Iterable[str]) -> tuple[str, ...]:
    """Return the figures that a name means: the one of that key, or all whose key ends with it."""
    keys, name = tuple(figures), wanted.casefold()
    whole = tuple(key for key in keys if key.casefold() == name)
    return whole or tuple(key for key in keys if key.casefold().endswith(f"-{name}"))


def _measured_sets(result: Result) -> Iterable[tuple[Mapping[str, object], Array, Array]]:
    group = result.tree.children.get(MEASURED_GROUP.strip("/"))
    for child in () if group is None else group.children.values():
        yield (
            {str(key): value for key, value in child.attrs.items()},
            np.asarray(child["x"].values, dtype=float),
            np.asarray(child["y"].values, dtype=float),
        )


def _unknown(wanted: str, file: str, figures: Mapping[str, Figure]) -> Notice:
    known = ", ".join(key for key, figure in figures.items() if not figure.categories) or "none"
    return Notice(
        "measured-points",
        f"there is no figure '{wanted}' in this report for the points of {file}",
        remedy=f"figures: {known}",
    )


def _with_points(figure: Figure, attributes: Mapping[str, object], x: Array, y: Array) -> Figure:
    if figure.categories:
        raise InputError("a figure of bars takes no points", path="figure")
    index = int(str(attributes["panel"])) - 1
    if not 0 <= index < len(figure.panels):
        raise InputError(f"there is no panel {index + 1}", path="panel", allowed=f"1 to {len(figure.panels)}")
    axis, panel = figure.abscissae[0], figure.panels[index]
    units = str(attributes["x_unit"]), str(attributes["y_unit"])
    # Numbers without a unit are those of the axes
    x = x * (unit_factor(units[0], axis.unit) if units[0] else 1.0)
    y = y * (unit_factor(units[1], panel.unit) if units[1] else 1.0)
    points = Series(str(attributes["label"]), {axis.key: x}, y, index, _POINT_TONE, "points")
    return replace(figure, series=(*figure.series, points))
