"""Currents of MoorDyn that change with time: a profile over the height (Currents 2), a grid in space (Currents 5)."""

from __future__ import annotations

import math
from itertools import pairwise
from pathlib import Path
from typing import Literal

import numpy as np

from moyai.core.errors import InputError
from moyai.core.options import checks_words
from moyai.interop.textfiles import parse_number, read_lines
from moyai.sea.current_field import CurrentField

#: Names that MoorDyn gives the files, next to the deck, by the form of what is in them.
FIELD_FILES: dict[str, str] = {"profile": "current_profile_dynamic.txt", "grid": "current_profile_4d.txt"}
#: Most velocities of a grid
MOST = 20_000_000


@checks_words
def read_current_field(path: str | Path, form: Literal["profile", "grid", "steady"]) -> CurrentField:
    """Read a current that changes with time.

    Parameters
    ----------
    path : path
    form : {"profile", "grid", "steady"}
        ``profile``: four lines that are passed over, a line of heights, a line that is passed over, then rows of time
        and velocities along x at all heights, maybe those along y, maybe those along z. ``grid``: a line of four
        numbers of points, a line for each of x, y, z and time, then rows of x, y, z, time and three velocities.
        ``steady``: three lines that are passed over, then rows of height and three velocities, at all times.

    Raises
    ------
    InputError
        A row of another form, with its line.
    """
    place = Path(path)
    lines = read_lines(place)
    if form == "steady":
        return _steady(place.name, lines)
    return _profile(place.name, lines) if form == "profile" else _grid(place.name, lines)


def _numbers(name: str, number: int, text: str) -> list[float]:
    values = [parse_number(word) for word in text.replace(",", " ").split()]
    found = [value for value in values if value is not None and math.isfinite(value)]
    if len(found) != len(values):
        raise InputError(f"{name}:{number}: a row is not all numbers", path="Currents")
    return found


def _steady(name: str, lines: list[str]) -> CurrentField:
    rows = [row for number, text in enumerate(lines[3:], start=4) if (row := _numbers(name, number, text))]
    if not rows or any(len(row) != 4 for row in rows) or any(b[0] <= a[0] for a, b in pairwise(rows)):
        raise InputError(f"{name}: rows are not rising heights and three velocities", path="Currents")
    table = np.array(rows)
    return CurrentField(np.zeros(1), np.zeros(1), np.zeros(1), table[:, 0], table[None, None, None, :, 1:])


def _profile(name: str, lines: list[str]) -> CurrentField:
    if len(lines) < 7:
        raise InputError(f"{name} has {len(lines)} lines", path="Currents", allowed="a line of heights, then rows")
    heights = _numbers(name, 5, lines[4])
    count = len(heights)
    rows = []
    for number, text in enumerate(lines[6:], start=7):
        row = _numbers(name, number, text)
        if not row:
            continue
        if not count or len(row) not in (1 + count, 1 + 2 * count, 1 + 3 * count):
            raise InputError(
                f"{name}:{number}: {len(row)} numbers", path="Currents",
                allowed=f"time and {count}, {2 * count} or {3 * count} velocities at the heights of line 5",
            )  # fmt: skip
        rows.append(row + [0.0] * (1 + 3 * count - len(row)))
    table = np.array(rows)
    if not rows or np.any(np.diff(table[:, 0]) <= 0.0) or np.any(np.diff(heights) <= 0.0):
        raise InputError(f"{name}: times or heights do not rise", path="Currents")
    velocity = table[:, 1:].reshape(len(table), 3, count).transpose(0, 2, 1)
    return CurrentField(table[:, 0], np.zeros(1), np.zeros(1), np.array(heights), velocity[:, None, None])


def _grid(name: str, lines: list[str]) -> CurrentField:
    kept = [(number, row) for number, text in enumerate(lines, start=1) if (row := _numbers(name, number, text))]
    counts = [int(value) for value in kept[0][1]] if kept else []
    if len(counts) != 4 or min(counts) < 1 or len(kept) < 5 or math.prod(counts) > MOST:
        raise InputError(f"{name}: the first line is not four numbers of points", path="Currents")
    axes = []
    for (number, row), count in zip(kept[1:5], counts):
        if len(row) != count or np.any(np.diff(row) <= 0.0):
            raise InputError(f"{name}:{number}: expected {count} rising places or times", path="Currents")
        axes.append(np.array(row))
    x, y, z, time = axes
    velocity = np.full((len(time), len(x), len(y), len(z), 3), np.nan)
    for number, row in kept[5:]:
        if len(row) != 7:
            raise InputError(f"{name}:{number}: {len(row)} numbers", path="Currents", allowed="x, y, z, time, velocity")
        index = [int(np.argmin(np.abs(axis - value))) for axis, value in zip(axes, row)]
        if any(abs(axis[i] - value) > 1e-6 * max(1.0, abs(value)) for axis, i, value in zip(axes, index, row)):
            raise InputError(f"{name}:{number}: the row is at no point of the grid", path="Currents")
        velocity[index[3], index[0], index[1], index[2]] = row[4:]
    missing = int(np.isnan(velocity[..., 0]).sum())
    if missing:
        raise InputError(f"{name}: {missing} points of the grid have no velocity", path="Currents")
    return CurrentField(time, x, y, z, velocity)
