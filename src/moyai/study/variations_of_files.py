"""Variations that stand in files: tables, scatter diagrams, contours, spectra."""

from __future__ import annotations

import math
from typing import Any

from moyai.case.paths import resolve, value_of
from moyai.core.errors import InputError
from moyai.study import schema
from moyai.study.axes import Axis, Point, StudyBase
from moyai.study.contour import contour_seas
from moyai.study.rows_of_files import column_of, read_rows
from moyai.study.scatter import read_scatter

_OF_THE_SEA = ("name", "heading_deg", "from_bearing_deg", "spreading", "seed", "duration")


def table(given: schema.TableOfCases, ground: StudyBase) -> tuple[Axis, ...]:
    """Return the axis of cases from the rows of a CSV file."""
    file = ground.folder / given.file
    rows = read_rows(file)
    wanted = dict.fromkeys((*given.columns, *given.units))
    heads = {column: column_of(rows, column, file, "table.columns") for column in wanted}
    points = []
    for number, row in enumerate(rows, start=2):
        entries = []
        for column, path in given.columns.items():
            heading, own = heads[column]
            text = (row[heading] or "").strip()
            if not text:
                raise InputError(f"{file.name}, row {number}: column '{column}' is empty", path="table.file")
            unit = given.units.get(column, own)
            entries.append((path, f"{text} {unit}" if unit else _scalar(text)))
        points.append(Point(str(number - 1), tuple(entries)))
    return (Axis(given.name, tuple(points)),)


def _scalar(text: str) -> Any:
    from moyai.case.yaml_reader import core_scalar

    return core_scalar(text)


def scatter(given: schema.Scatter, ground: StudyBase) -> tuple[Axis, ...]:
    """Return the axis of the sea states of a scatter diagram with their probabilities."""
    cells = read_scatter(ground.folder / given.file, counts=given.counts)
    points = tuple(
        Point(
            f"Hs {cell.significant_height:g} m, T {cell.period:g} s",
            ((given.significant_height, cell.significant_height), (given.period, cell.period)),
            probability=cell.probability,
        )
        for cell in cells
    )
    return (Axis(given.name, points),)


def contour(given: schema.ContourKeys, ground: StudyBase) -> tuple[Axis, ...]:
    """Return the axis of the sea states round an environmental contour."""
    points = tuple(
        Point(
            f"Hs {height:.3g} m, T {period:.3g} s",
            ((given.significant_height, float(height)), (given.period, float(period))),
        )
        for height, period in zip(*contour_seas(given, ground.folder))
    )
    return (Axis(given.name, points),)


def spectra(given: schema.SpectraOfFile, ground: StudyBase) -> tuple[Axis, ...]:
    """Return the axis of the spectra of a file, one case a time."""
    from moyai.sea.spectrum_archives import read_archive

    file = ground.folder / given.file
    archive = read_archive(file)
    if given.place >= len(archive.place):
        raise InputError(
            f"{given.file} has no place {given.place}", path="place", allowed=f"0 to {len(archive.place) - 1}"
        )
    places = resolve(ground.base, given.sea)
    sea = value_of(ground.base, places[0])
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
        block = {
            **kept,
            "kind": "spectrum_file",
            "file": ground.named_by_the_base(given.file),
            "record": record,
            "place": given.place,
        }
        if given.direction:
            bearing = float(archive.direction[record, given.place])
            if not math.isfinite(bearing):
                raise InputError(f"{given.file} gives no direction for record {record}", path="direction")
            block.pop("heading_deg", None)
            block["from_bearing_deg"] = round(bearing, 3)
        points.append(Point(archive.time[record], ((given.sea, block),)))
    return (Axis(given.name, tuple(points)),)
