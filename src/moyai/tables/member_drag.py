"""Drag coefficients of members (data/member_drag.csv holds the numbers and their sources)."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from moyai.core.options import checks_words
from moyai.tables.reader import Record, read_table

_FILE = "member_drag.csv"


@dataclass(frozen=True)
class DragEntry:
    """One row."""

    #: C_D [-]; NaN where the table gives none.
    drag: float
    #: C_M [-]; NaN where the table gives none.
    inertia: float
    #: Least Reynolds number of its measurements.
    reynolds_low: float
    #: Largest Reynolds number of its measurements.
    reynolds_high: float
    #: Whether the value was read in the source named; otherwise check before design use.
    confirmed: bool
    #: Letter of the source in the notes of the file.
    source: str


def _entry(record: Record) -> DragEntry:
    return DragEntry(
        drag=float(record["drag"]),
        inertia=float(record["inertia"]) if record["inertia"] else math.nan,
        reynolds_low=float(record["reynolds_low"]) if record["reynolds_low"] else 0.0,
        reynolds_high=float(record["reynolds_high"]) if record["reynolds_high"] else math.inf,
        confirmed=record["confirmed"] == "true",
        source=record["source"],
    )


def _rows(table: str) -> list[Record]:
    return [record for record in read_table(_FILE) if record["table"] == table]


@checks_words
def api_circle(*, rough: bool) -> DragEntry:
    """Return the values of API RP 2A for circular members in storm waves."""
    return _entry(_rows("api")[1 if rough else 0])


def steady_circle() -> DragEntry:
    """Return the drag of a smooth circle in steady subcritical flow."""
    return _entry(_rows("steady_circle")[0])


def steady_rectangle(aspect: float) -> DragEntry:
    """Return the drag of a sharp rectangle in steady flow.

    Parameters
    ----------
    aspect : float
        Side along the flow over the side across it [-]; end values are kept outside the table.
    """
    rows = _rows("steady_rectangle")
    first = _entry(rows[0])
    along = np.log([float(record["abscissa"]) for record in rows])
    drag = float(np.interp(math.log(aspect), along, [float(record["drag"]) for record in rows]))
    return DragEntry(drag, math.nan, first.reynolds_low, first.reynolds_high, first.confirmed, first.source)
