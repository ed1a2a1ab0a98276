"""Relations between the statistics of the blocks: tension against height, current and direction, type against type."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np

from moyai.core.arrays import Array
from moyai.core.errors import InputError
from moyai.records.survey.model import Survey
from moyai.series.regressions import (
    Estimate,
    Regression,
    correlation,
    fit_by_direction,
    fit_cosine,
    fit_line,
    fit_power,
    type_ratio,
)

if TYPE_CHECKING:
    import xarray as xr

FEWEST = 8
"""Blocks that a fit needs."""

_Row = tuple[str, str, str, float, float, float, float, float, float]


def fit_relations(survey: Survey, groups: Mapping[str, xr.Dataset]) -> xr.Dataset | None:
    """Fit every relation that the blocks determine.

    Parameters
    ----------
    survey : Survey
    groups : mapping
        ``waves``, ``tensions``, ``current``, ``directions`` as far as there are.

    Returns
    -------
    Dataset or None
        Along ``fit``: relation, what it was fitted to, parameter, value, standard error, 95 % bounds, R^2, number of
        blocks.
    """
    import xarray as xr

    rows: list[_Row] = []
    if "waves" in groups:
        waves = groups["waves"]
        for place, gauge in enumerate(waves["gauge"].values):
            third, highest = _of(waves, "third_height", place), _of(waves, "maximum_height", place)
            _add(
                rows, "Hmax against H1/3", str(gauge), third, highest, lambda x, y: fit_line(x, y, through_origin=True)
            )
    if "tensions" in groups and "tenth" in groups["tensions"]:
        rows.extend(_tension_rows(survey, groups))
    if not rows:
        return None
    columns = list(zip(*rows, strict=True))
    names = ("relation", "of", "parameter", "value", "error", "low", "high", "determination", "count")
    data = {
        name: ("fit", np.array(column, dtype=object if place < 3 else float))
        for place, (name, column) in enumerate(zip(names, columns, strict=True))
    }
    out = xr.Dataset(data)
    out["count"].attrs["long_name"] = "blocks"
    return out


def _of(dataset: xr.Dataset, name: str, place: int | None = None) -> Array:
    values = np.asarray(dataset[name].values, dtype=float)
    return values if place is None else values[:, place]


def _tension_rows(survey: Survey, groups: Mapping[str, xr.Dataset]) -> list[_Row]:
    rows: list[_Row] = []
    tensions, waves = groups["tensions"], groups["waves"]
    lines = [str(name) for name in tensions["line"].values]
    gauge = survey.waves.index(survey.wave_of_tensions)
    third, period = _of(waves, "third_height", gauge), _of(waves, "third_period", gauge)
    angle = np.full(third.size, math.nan)
    if "directions" in groups and math.isfinite(survey.normal_heading):
        away = _of(groups["directions"], "mean_heading") - survey.normal_heading
        # Waves from behind count as from the front
        angle = np.arccos(np.minimum(np.abs(np.cos(away)), 1.0))
    current = np.full(third.size, math.nan)
    if "current" in groups and "current_normal" in groups["current"]:
        current = _of(groups["current"], "current_normal")
    members: dict[str, list[int]] = {}
    for place, entry in enumerate(survey.tensions):
        members.setdefault(entry.group, []).append(place)
    subjects = [(line, [place]) for place, line in enumerate(lines)]
    subjects += [(f"mean of {group}", places) for group, places in members.items() if len(places) > 1]
    means: dict[str, dict[str, Array]] = {}
    for name, places in subjects:
        steady, maximum, tenth = (
            np.mean([_of(tensions, key, place) for place in places], axis=0) for key in ("steady", "maximum", "tenth")
        )
        means[name] = {"steady": steady, "tenth": tenth}
        _add(rows, "T1/10 against H1/3", name, third, tenth, lambda x, y: fit_line(x, y, through_origin=True))
        _add(rows, "T1/10 against a power of H1/3", name, third, tenth, fit_power)
        _add(rows, "Tmax against T1/10", name, tenth, maximum, lambda x, y: fit_line(x, y, through_origin=True))
        _add_number(rows, "steady tension with U_x: correlation", name, current, steady)
        _add(rows, "T1/10 over H1/3 against cos^n of the angle", name, angle, tenth / third, fit_cosine)
        rows.extend(_class_rows(name, third, tenth, angle))
        if survey.load_measure is not None:
            speed = np.where(np.isfinite(current), current, 0.0)
            turned = np.where(np.isfinite(angle), angle, 0.0)
            known = np.isfinite(third) & np.isfinite(period) & (period > 0.0)
            squared = np.full(third.size, math.nan)
            squared[known] = survey.load_measure(third[known], period[known], turned[known], speed[known])
            _add(rows, "Tmax against u2", name, squared, maximum, lambda x, y: fit_line(x, y, through_origin=True))
    rows.extend(_type_rows(members, lines, means))
    return rows


DIRECTION_CLASSES = (0.0, 20.0, 40.0, 60.0, 90.0)
"""Borders of the classes of angles from the normal [deg]."""


def _class_rows(of: str, third: Array, tenth: Array, angle: Array) -> list[_Row]:
    """Return by how much each class of directions leaves the common line of tension and height."""
    known = np.isfinite(third) & np.isfinite(tenth) & np.isfinite(angle)
    if np.count_nonzero(known) < FEWEST:
        return []
    try:
        _, classes = fit_by_direction(third[known], tenth[known], angle[known], np.radians(DIRECTION_CLASSES))
    except InputError:
        return []
    return [
        _row(
            f"T1/10 off the common line, {math.degrees(entry.low):.0f} to {math.degrees(entry.high):.0f} deg",
            of,
            "share of the mean load",
            entry.departure,
            math.nan,
            entry.count,
        )
        for entry in classes
        if entry.departure is not None
    ]


def _type_rows(
    members: Mapping[str, Sequence[int]], lines: Sequence[str], means: Mapping[str, Mapping[str, Array]]
) -> list[_Row]:
    """Return every type against the first."""
    rows: list[_Row] = []
    names = {group: f"mean of {group}" if len(places) > 1 else lines[places[0]] for group, places in members.items()}
    groups = list(names)
    for group in groups[1:]:
        for key, words in (("tenth", "T1/10"), ("steady", "steady tension")):
            one, two = means[names[groups[0]]][key], means[names[group]][key]
            known = np.isfinite(one) & np.isfinite(two)
            if np.count_nonzero(known) < FEWEST:
                continue
            try:
                _, ratio = type_ratio(one[known], two[known])
            except InputError:
                continue
            subject = f"{group} over {groups[0]}"
            rows.append(_row(f"ratio of the mean {words}", subject, "ratio", ratio, math.nan, int(known.sum())))
    return rows


def _add(rows: list[_Row], relation: str, of: str, x: Array, y: Array, fit: object) -> None:
    known = np.isfinite(x) & np.isfinite(y)
    if np.count_nonzero(known) < FEWEST:
        return
    try:
        found: Regression = fit(x[known], y[known])  # type: ignore[operator]
    except InputError:
        return
    for name, estimate in found.parameters.items():
        rows.append(_row(relation, of, name, estimate, found.determination, int(known.sum())))


def _add_number(rows: list[_Row], relation: str, of: str, x: Array, y: Array) -> None:
    known = np.isfinite(x) & np.isfinite(y)
    if np.count_nonzero(known) < FEWEST:
        return
    try:
        found = correlation(x[known], y[known])
    except InputError:
        return
    rows.append(_row(relation, of, "r", found, math.nan, int(known.sum())))


def _row(relation: str, of: str, name: str, estimate: Estimate, determination: float, count: int) -> _Row:
    numbers = (estimate.value, estimate.error, estimate.low, estimate.high, determination, float(count))
    return (relation, of, name, *numbers)
