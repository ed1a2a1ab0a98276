"""Directions as people at sea say them: degrees clockwise from north, and the names of the compass."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike

from moyai.core.arrays import Array
from moyai.report.document import Column, Table

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
