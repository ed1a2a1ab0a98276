"""Directions as people at sea say them: degrees clockwise from north, and the names of the compass."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from moyai.core.arrays import Array
from moyai.report.document import Column, KeyFigure, Table
from moyai.report.formatting import format_quantity

NAMES = ["N", "NNE", "NE", "ENE", "E", "ESE", "SE", "SSE", "S", "SSW", "SW", "WSW", "W", "WNW", "NW", "NNW"]


def come_from(heading: ArrayLike, x_axis_bearing: float) -> Array:
    """Return the bearing that something comes from [deg].

    Parameters
    ----------
    heading : array_like
        Direction of travel from +x, counter-clockwise [rad].
    x_axis_bearing : float
        Bearing that +x points to, clockwise from north [deg].
    """
    return np.asarray(np.mod(x_axis_bearing - np.degrees(np.asarray(heading, dtype=float)) + 180.0, 360.0))


def name_of(bearing: float) -> str:
    """Return the name of a bearing [deg] in sixteen points, for instance ``SSW``; empty for NaN."""
    return NAMES[round(bearing / 22.5) % 16] if np.isfinite(bearing) else ""


def with_bearings(table: Table, bearings: Mapping[str, Array], word: str) -> Table:
    """Return a table with a column of degrees and one of names for each bearing.

    Parameters
    ----------
    table : Table
    bearings : mapping of str to ndarray
        By what has them [deg].
    word : str
        ``from`` or ``towards``.
    """
    columns = list(table.columns)
    for what, values in bearings.items():
        columns.append(Column(f"{what} {word}, bearing", list(values), "deg", digits=4))
        columns.append(Column(f"{what} {word}", [name_of(float(value)) for value in values]))
    return replace(table, columns=tuple(columns))


def heading_figures(tree: Any, start: Array, text: Callable[[float], str]) -> list[KeyFigure]:
    """Return where the largest waves travel to, and the strongest current, where they were asked for.

    Parameters
    ----------
    tree : xarray.DataTree
        Of a survey.
    start : ndarray
        Of the blocks.
    text : callable
        Instant in words.
    """
    bearing = float(tree.attrs.get("x_axis_bearing_deg", math.nan))

    def values(group: str, name: str) -> Array:
        return np.asarray(tree[group][name].values, dtype=float)

    def towards(heading: float) -> str:
        if not math.isfinite(bearing):
            return "from +x"
        to = float(np.mod(come_from(heading, bearing) + 180.0, 360.0))
        return f"from +x, bearing {to:.3g} deg ({name_of(to)})"

    items = []
    if "directions" in tree.children and "mean_heading" in tree["directions"]:
        heading, spread = (values("directions", name) for name in ("mean_heading", "spread"))
        height = values("waves", "third_height") if "waves" in tree.children else np.zeros((len(heading), 1))
        rank = np.where(np.isfinite(heading), np.nan_to_num(height).max(axis=1), -1.0)
        row = int(np.argmax(rank))
        if rank[row] >= 0.0:
            detail = f"{towards(heading[row])}; spread {np.degrees(spread[row]):.3g} deg; {text(start[row])}"
            items.append(KeyFigure("the largest waves travel towards", f"{np.degrees(heading[row]):.3g} deg", detail))
    if "current" in tree.children:
        speed, heading = (values("current", name) for name in ("current_speed", "current_heading"))
        if np.isfinite(speed).any():
            row = int(np.nanargmax(speed))
            detail = f"towards {np.degrees(heading[row]):.3g} deg {towards(heading[row])}; {text(start[row])}"
            items.append(KeyFigure("strongest mean current", format_quantity(float(speed[row]), "m/s"), detail))
    return items
