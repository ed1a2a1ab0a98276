"""A reader's own digitised points over a figure: reading, and bias and scatter of every curve against them."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from moyai.core.arrays import Array
from moyai.core.errors import InputError
from moyai.report.document import Figure, Series

LABEL = "points laid over"


@dataclass(frozen=True)
class Points:
    """Points of one figure, in the units of its axes."""

    #: Number of the figure.
    figure: str
    #: Name of the file.
    source: str
    x: Array
    y: Array


@dataclass(frozen=True)
class Agreement:
    """How one curve stands against the points."""

    curve: str
    #: Points within the reach of the curve.
    count: int
    #: Mean of curve less point, in the unit of the ordinate.
    bias: float
    #: Standard deviation of curve less point.
    scatter: float
    #: Root mean square of curve less point over that of the points.
    relative: float


def read_points(option: str, known: tuple[str, ...]) -> Points:
    """Read the points of one ``--points FIG=file.csv``.

    Parameters
    ----------
    option : str
    known : tuple of str
        Numbers of the figures of the paper that take points.

    Raises
    ------
    InputError
        For an unknown figure, a file that is absent, or one that is no two columns of numbers.
    """
    number, sign, name = option.partition("=")
    number = number.strip().lower()
    if not sign or not name.strip():
        raise InputError(f"'{option}' has no '='", path="--points", allowed="FIG=file.csv, FIG " + ", ".join(known))
    if number not in known:
        raise InputError(f"no figure '{number}' takes points", path="--points", allowed=", ".join(known))
    path = Path(name.strip())
    try:
        text = path.read_text(encoding="utf-8-sig")
    except OSError as error:
        raise InputError(
            f"{path} cannot be read: {error.strerror or error}", path="--points", allowed="a text file of x and y"
        ) from None
    except UnicodeDecodeError:
        raise InputError(f"{path} is no text", path="--points", allowed="a text file of x and y") from None
    return _parsed(text, number, path)


def _parsed(text: str, number: str, path: Path) -> Points:
    rows: list[tuple[float, float]] = []
    heading_allowed = True
    for count, line in enumerate(text.splitlines(), start=1):
        content = line.split("#")[0].strip()
        if not content:
            continue
        cells = [cell for cell in re.split(r"[,;\s]+", content) if cell]
        try:
            values = [float(cell) for cell in cells[:2]]
        except ValueError:
            if heading_allowed and not rows:
                heading_allowed = False
                continue
            values = []
        if len(values) < 2 or not all(map(math.isfinite, values)):
            raise InputError(
                f"{path}, line {count}: '{content[:40]}' is no pair of numbers",
                path="--points",
                allowed="two columns, x and y in the units of the axes, decimal points",
            )
        rows.append((values[0], values[1]))
    if not rows:
        raise InputError(f"{path} holds no points", path="--points", allowed="two columns, x and y")
    x, y = np.array(rows, dtype=float).T
    return Points(number, path.name, x, y)


def laid_over(figure: Figure, points: Points) -> Figure:
    """Return the figure with the points on it."""
    first = figure.abscissae[0]
    marks = Series(f"{LABEL}: {points.source}", {first.key: points.x}, points.y, 0, 7, "points")
    # A series must know every way to plot; the points know the first alone
    series = tuple(replace(item, x={first.key: item.x[first.key]}) for item in figure.series)
    return replace(figure, abscissae=(first,), series=(*series, marks))


def agreements(figure: Figure, points: Points) -> tuple[Agreement, ...]:
    """Return bias and scatter of every curve of a figure against the points; none where all curves are loops.

    Raises
    ------
    InputError
        When no point lies within the reach of any curve.
    """
    key = figure.abscissae[0].key
    found, reach = [], []
    for series in figure.series:
        known = np.isfinite(series.x[key]) & np.isfinite(series.y)
        x, y = series.x[key][known], series.y[known]
        # Scattered points and loops have no value at a place; they are drawn and not compared
        if series.style == "bar" or x.size < 2 or not np.all(np.diff(x) > 0.0):
            continue
        reach.append(x)
        inside = (points.x >= x[0]) & (points.x <= x[-1])
        if not inside.any():
            continue
        difference = np.interp(points.x[inside], x, y) - points.y[inside]
        size = math.sqrt(float(np.mean(points.y[inside] ** 2)))
        found.append(
            Agreement(
                series.label,
                int(inside.sum()),
                float(difference.mean()),
                float(difference.std(ddof=1)) if inside.sum() > 1 else math.nan,
                math.sqrt(float(np.mean(difference**2))) / size if size > 0.0 else math.nan,
            )
        )
    if reach and not found:
        low, high = min(item.min() for item in reach), max(item.max() for item in reach)
        raise InputError(
            f"no point of {points.source} lies under a curve of figure {points.figure}",
            path="--points",
            allowed=f"x from {low:.4g} to {high:.4g}",
        )
    return tuple(found)
