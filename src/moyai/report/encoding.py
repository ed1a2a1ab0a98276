"""Turn figures, tables and scenes into text: JSON for the page, CSV for spreadsheets."""

from __future__ import annotations

import base64
import csv
import io
import json
import math
import re
from collections.abc import Iterable, Sequence
from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from moyai.core.arrays import Array
from moyai.core.options import checks_words
from moyai.language import said
from moyai.report.document import Cell, Column, Figure, Series, Table
from moyai.report.formatting import DisplayUnit, axis_label, display_unit, plain_number

QUANTA = {8: 254, 16: 65000}  # steps over the range of a column
SHORT_ARRAY = 48  # up to this length numbers are written out, beyond it as packed single precision


def slug(*parts: str) -> str:
    """Return a name that is safe in file names and as an HTML id; letters of every script are kept.

    Parameters
    ----------
    *parts : str
        Joined by hyphens.

    Returns
    -------
    str
    """
    joined = "-".join(re.sub(r"[^\w.]+", "-", part, flags=re.UNICODE).strip("-.").lower() for part in parts)
    return joined or "item"


def unique_slugs(keys: Iterable[str]) -> list[str]:
    """Return a safe name for every key, a repeated one with its number: the names of the CSV files of tables."""
    names: list[str] = []
    for key in keys:
        base, count = slug(key), 2
        name = base
        while name in names:
            name, count = f"{base}-{count}", count + 1
        names.append(name)
    return names


def encode_array(values: ArrayLike) -> list[float | None] | dict[str, str]:
    """Encode numbers for the page: a short list with ``null`` for NaN, or ``{"f4": base64}``.

    Parameters
    ----------
    values : array_like
        One-dimensional.

    Returns
    -------
    list or dict
    """
    array = np.asarray(values, dtype=float).ravel()
    if array.size <= SHORT_ARRAY:
        return [float(f"{value:.7g}") if math.isfinite(value) else None for value in array]
    return {"f4": base64.b64encode(array.astype("<f4").tobytes()).decode("ascii")}


@checks_words
def encode_quantised(values: NDArray[np.float64], bits: Literal[8, 16] = 16) -> dict[str, Any]:
    """Encode a matrix as small integers per column, with offset and step of each column.

    Parameters
    ----------
    values : ndarray, shape (frames, columns)
        Finite numbers.
    bits : {8, 16}

    Returns
    -------
    dict
        ``{"i1" or "i2": base64 row by row, "columns": n, "offset": [...], "step": [...]}``; the error is half a step.
    """
    low, high = values.min(axis=0), values.max(axis=0)
    offset = 0.5 * (low + high)
    most = QUANTA[bits] // 2
    step = np.maximum(high - low, 1e-300) / QUANTA[bits]
    integers = np.clip(np.rint((values - offset) / step), -most, most).astype("<i2" if bits == 16 else "i1")
    return {
        "i2" if bits == 16 else "i1": base64.b64encode(integers.tobytes()).decode("ascii"),
        "columns": int(values.shape[1]),
        "offset": [float(f"{value:.9g}") for value in offset],
        "step": [float(f"{value:.9g}") for value in step],
    }


def page_json(data: Any) -> str:
    """Return JSON that may stand inside a ``<script>`` element: no ``<``, ``>``, ``&`` or line separators."""
    text = json.dumps(data, ensure_ascii=False, allow_nan=False, separators=(",", ":"))
    for character in "<>&\u2028\u2029":
        text = text.replace(character, f"\\u{ord(character):04x}")
    return text


def figure_specification(figure: Figure) -> dict[str, Any]:
    """Return the JSON-ready form of a figure; equal arrays are stored once.

    Parameters
    ----------
    figure : Figure

    Returns
    -------
    dict
    """
    pool: list[Any] = []
    known: dict[bytes, int] = {}

    def store(values: ArrayLike) -> int:
        array = np.ascontiguousarray(np.asarray(values, dtype=float).ravel())
        mark = array.tobytes()
        if mark not in known:
            known[mark] = len(pool)
            pool.append(encode_array(array))
        return known[mark]

    series = [
        {
            "label": item.label,
            "x": {key: store(values) for key, values in item.x.items()},
            "y": store(item.y),
            "panel": item.panel,
            "tone": item.tone,
            "style": item.style,
            "dash": item.dash,
            "faint": item.faint,
            "belongs_to": item.belongs_to,
        }
        for item in figure.series
    ]
    return {
        "key": figure.key,
        "title": figure.title,
        "abscissae": [{"key": a.key, "label": a.label, "unit": a.unit, "log": a.log} for a in figure.abscissae],
        "panels": [
            {"label": p.label, "unit": p.unit, "limits": p.limits, "from_zero": p.from_zero} for p in figure.panels
        ],
        "series": series,
        "arrays": pool,
        "marks": [{"label": m.label, "x": m.x, "y": m.y, "panel": m.panel} for m in figure.marks if m.known],
        "window": figure.window,
        "slider": figure.slider,
        "categories": list(figure.categories),
        "height": figure.height,
        "csv": figure_csv(figure) if figure.categories else None,
    }


def _same_abscissa(first: Series, second: Series) -> bool:
    return first.x.keys() == second.x.keys() and all(
        np.array_equal(first.x[key], second.x[key], equal_nan=True) for key in first.x
    )


def figure_columns(figure: Figure) -> list[tuple[str, Sequence[Cell] | Array]]:
    """Return the data of a figure as columns: series over one abscissa share its columns, others follow side by side.

    Parameters
    ----------
    figure : Figure

    Returns
    -------
    list of (str, sequence)
        Heading with its unit, and numbers (texts below the bars of a bar chart); columns may differ in length.
    """
    if figure.categories:
        bars: list[tuple[str, Sequence[Cell] | Array]] = [("", figure.categories)]
        return bars + [(axis_label(item.label, figure.panels[item.panel].unit), item.y) for item in figure.series]
    groups: list[list[Series]] = []
    for item in figure.series:
        for group in groups:
            if _same_abscissa(group[0], item):
                group.append(item)
                break
        else:
            groups.append([item])
    columns: list[tuple[str, Sequence[Cell] | Array]] = []
    for group in groups:
        for abscissa in figure.abscissae:
            if abscissa.key in group[0].x:
                columns.append((axis_label(abscissa.label, abscissa.unit), group[0].x[abscissa.key]))
        for item in group:
            panel = figure.panels[item.panel]
            name = (
                item.label if len(figure.panels) == 1 or item.label == panel.label else f"{panel.label}: {item.label}"
            )
            columns.append((axis_label(name, panel.unit), item.y))
    return columns


def figure_csv(figure: Figure) -> str:
    """Return the data of a figure as CSV, as :func:`figure_columns` has them.

    Parameters
    ----------
    figure : Figure

    Returns
    -------
    str
        Header row with units, then numbers; empty cells where nothing is known.
    """
    return _columns_to_csv(
        [[name, *(_csv_cell(value, 1.0) for value in values)] for name, values in figure_columns(figure)]
    )


def _columns_to_csv(columns: Sequence[Sequence[str]]) -> str:
    stream = io.StringIO()
    writer = csv.writer(stream, lineterminator="\n")
    for row in range(max((len(column) for column in columns), default=0)):
        writer.writerow([_harmless(column[row]) if row < len(column) else "" for column in columns])
    return stream.getvalue()


def _harmless(text: str) -> str:
    """Keep a spreadsheet from taking a text for a formula."""
    negative_number = re.fullmatch(r"-(inf|[\d.]+(e[+-]?\d+)?)", text)
    if text.startswith(("=", "+", "-", "@", "\t", "\r")) and not negative_number:
        return "'" + text
    return text


def column_unit(column: Column) -> DisplayUnit:
    """Return the unit in which a column is shown and written."""
    if column.fixed or any(isinstance(value, str) for value in column.values):
        return DisplayUnit("" if column.unit in {"1", "-"} else column.unit)
    numbers = [float(value) for value in column.values if value is not None and not isinstance(value, bool)]
    return display_unit(column.unit, [*numbers, column.like] if numbers else None)


def _csv_cell(value: Cell, factor: float) -> str:
    if value is None:
        return ""
    if isinstance(value, str):
        return value
    if isinstance(value, bool | np.bool_):
        return said("yes" if value else "no")
    return plain_number(float(value) * factor)


def scaled_cell(value: Cell, factor: float) -> Cell:
    """Return a cell in the unit shown: numbers times a factor, without a tail of rounding; texts and truth as is."""
    if factor == 1.0 or value is None or isinstance(value, str | bool | np.bool_):
        return value
    return float(f"{float(value) * factor:.15g}")


def table_csv(table: Table) -> str:
    """Return a table as CSV with units in the header row.

    Parameters
    ----------
    table : Table

    Returns
    -------
    str
    """
    columns = []
    for column in table.columns:
        unit = column_unit(column)
        columns.append(
            [axis_label(column.label, unit.name), *(_csv_cell(value, unit.factor) for value in column.values)]
        )
    return _columns_to_csv(columns)
