"""How long what floats drifts to its place in waves and current: that way is left out, or the run is too short."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from moyai.core.arrays import Array, BoolArray, IntArray
from moyai.core.validity import Notice
from moyai.core.wording import spoken_time
from moyai.structures.network.model import NetworkProblem
from moyai.structures.network.runs import RunPlan

if TYPE_CHECKING:
    import xarray as xr

#: Parts that a record is cut into, at most, and that a word on its drift needs.
PARTS, LEAST_PARTS = 24, 6
#: Change of a mean place that still counts as standing, over the largest offset, and over the scatter of the means.
STANDING, SCATTER = 0.02, 3.0
#: The same change from the first to the last fifth of a random record, in which means move by chance.
STANDING_IN_A_SEA = 0.1
#: Parts of a random record, and standard errors of the mean over realisations above which its change is no chance: a
#: false alarm in forty leaves a number "at least".
PARTS_IN_A_SEA, NO_CHANCE = 5, 2.0
#: Way from the first to the last of the means over the way along them all, above which they move on and do not swing.
STRAIGHT = 0.8
#: Change of the highest tension in a steady current that still counts as the same, over the highest of all.
PULLING = 0.02
#: The rule of a beginning in which something drifts to its place.
DRIFTED = "until what floats has drifted to its place"
#: Largest offset below which nothing is said of its drift, over the size of the network.
SMALL = 1e-3


@dataclass(frozen=True)
class Drift:
    """What a record shows of the way to the mean place of its points."""

    #: Time since the start from which the mean places stand, half the record at most [s].
    until: float = 0.0
    #: Point that still moves at the end.
    point: str = ""
    #: How far its mean place went [m], and in what time [s].
    moved: float = 0.0
    within: float = 0.0

    def words(self) -> str:
        """Say what still moves; empty where nothing does."""
        if not self.point:
            return ""
        return f"the mean place of '{self.point}' still moves, {self.moved:.2g} m in {spoken_time(self.within)}"

    def notices(self) -> list[Notice]:
        """Warn of a run that ends on the way."""
        if not self.point:
            return []
        return [
            Notice(
                "still-drifting", f"{self.words()}: tensions, pulls and offsets are those of the way there",
                severity="warning", remedy="a longer duration, or the start 'rest_in_current'",
            )
        ]  # fmt: skip


def drift_of(
    time: Array, place: Array, origin: Array, led: BoolArray, *, period: float, skip: float, irregular: bool,
    names: list[str], pull: Array | None = None,
) -> Drift:  # fmt: skip
    """Return how long the mean places of some points move, and whether they still do at the end.

    Means are taken over whole periods. They stand from where they stay within two hundredths of the largest offset of
    all points about their mean over the last quarter, or within three times the scatter of the second half. Where
    points that are led somewhere do not stand, nothing does.

    Parameters
    ----------
    time : ndarray, shape (rows,)
        [s].
    place : ndarray, shape (rows, points, 3)
        [m].
    origin : ndarray, shape (points, 3)
        Places in still water, from which offsets count [m].
    led : ndarray of bool, shape (points,)
        Whether a motion of the case leads the point.
    period : float
        Of the waves or motions [s]; NaN without.
    skip : float
        Beginning that does not count in any case [s].
    irregular : bool
        Whether the means move by chance.
    names : list of str
        Of the points.
    pull : ndarray, shape (rows, lines), optional
        Highest tensions since the row before, where nothing but a steady current pulls [N]: what swings when a line
        comes taut is of the way too.
    """
    known = np.asarray(np.isfinite(place).all(axis=(0, 2)))
    if not known.any() or time.size < 3:
        return Drift()
    scale = float(np.linalg.norm(place - origin, axis=2)[:, known].max())
    means, ends = _means(time, place, period, 0.0)
    if len(means) < LEAST_PARTS or scale <= SMALL * float(np.ptp(place[:, known], axis=(0, 1)).max()):
        return Drift()
    last, half = means[-max(len(means) // 4, 1) :].mean(axis=0), means[len(means) // 2 :]
    scatter = np.linalg.norm(half.std(axis=0), axis=1)
    away = np.linalg.norm(means - last, axis=2) > np.maximum(STANDING * scale, SCATTER * scatter)
    if np.any(np.linalg.norm(np.ptp(half, axis=0), axis=1)[led & known] > STANDING * scale):
        return Drift()
    swings = np.zeros(len(means), dtype=bool) if pull is None or not pull.size else _swinging(time, pull, period)
    moving = np.flatnonzero(away[:, known].any(axis=1) | swings)
    until = float(ends[moving[-1]] - time[0]) if moving.size else 0.0
    until = min(until, 0.5 * float(time[-1] - time[0]))
    own = [name for name, one in zip(names, known, strict=True) if one]
    return Drift(until, *_still_moving(time, place[:, known], own, scale, period, max(skip, until), irregular))


def _swinging(time: Array, pull: Array, period: float) -> BoolArray:
    """Return in which parts the highest tension of a line is not that of the last quarter."""
    edges = _edges(time, period, 0.0, PARTS)
    highest = np.array([pull[a:b].max(axis=0) for a, b in pairwise(edges)])
    last = highest[-max(len(highest) // 4, 1) :].mean(axis=0)
    return np.asarray((np.abs(highest - last) > PULLING * highest.max()).any(axis=1))


def _means(time: Array, place: Array, period: float, after: float, parts: int = PARTS) -> tuple[Array, Array]:
    """Return means over parts of whole periods, counted back from the end, and the last time of each."""
    edges = _edges(time, period, after, parts)
    found = [place[a:b].mean(axis=0) for a, b in pairwise(edges)]
    return np.array(found).reshape(len(found), *place.shape[1:]), time[edges[1:] - 1]


def _edges(time: Array, period: float, after: float, parts: int) -> IntArray:
    first = int(np.searchsorted(time, time[0] + after))
    rows = time.size - first
    length = rows / parts
    if math.isfinite(period) and period > 0.0:
        of_period = period * (time.size - 1) / float(time[-1] - time[0])
        length = of_period * max(1.0, math.floor(length / of_period + 1e-6))
    count = int(rows / length + 1e-9) if length >= 1.0 else 0
    return time.size - np.round(length * np.arange(count, -1, -1)).astype(np.int64)


def _still_moving(
    time: Array, place: Array, names: list[str], scale: float, period: float, after: float, irregular: bool
) -> tuple[str, float, float]:
    """Return the point whose mean moves on one way through all that counts, how far in its last part, and its time."""
    parts = PARTS_IN_A_SEA if irregular else 4
    means, ends = _means(time, place, period, after, parts)
    if len(means) < parts:
        return "", 0.0, 0.0
    means = means[-parts:]
    steps = np.diff(means, axis=0)
    whole = means[-1] - means[0]
    onwards = (np.einsum("kpa,pa->kp", steps, whole) > 0.0).all(axis=0)
    onwards &= np.linalg.norm(whole, axis=1) >= STRAIGHT * np.linalg.norm(steps, axis=2).sum(axis=0)
    size = np.linalg.norm(whole if irregular else steps[-1], axis=1)
    size = np.where(onwards & (size > (STANDING_IN_A_SEA if irregular else STANDING) * scale), size, 0.0)
    if not size.any():
        return "", 0.0, 0.0
    most = int(np.argmax(size))
    return names[most], float(np.linalg.norm(steps[-1][most])), float(ends[-1] - ends[-2])


def drift_of_all(way: Array, excursion: Array, names: list[str], led: BoolArray, duration: float) -> Drift:
    """Return what realisations of a sea show together of the way of their points: one alone moves to and fro by chance.

    A point is on its way where the distance of its mean place from that in still water grows, on average over the
    realisations, from the first fifth of the record to the last by more than a tenth of the largest excursion and by
    more than two standard errors.

    Parameters
    ----------
    way : ndarray, shape (realisations, parts, points)
        That distance [m].
    excursion : ndarray, shape (realisations, points)
        Largest distance [m].
    names : list of str
        Of the points.
    led : ndarray of bool, shape (points,)
        Whether a motion of the case leads the point.
    duration : float
        Of what counts [s].
    """
    sound = np.isfinite(way).all(axis=(1, 2)) & np.isfinite(excursion).all(axis=1)
    if np.count_nonzero(sound) < 2 or led.all():
        return Drift()
    change = (way[:, -1] - way[:, 0])[sound]
    mean, error = change.mean(axis=0), change.std(axis=0, ddof=1) / math.sqrt(len(change))
    scale = float(excursion[sound].max())
    size = np.where(~led & (mean > np.maximum(STANDING_IN_A_SEA * scale, NO_CHANCE * error)), mean, 0.0)
    if not size.any():
        return Drift()
    most, steps = int(np.argmax(size)), way.shape[1] - 1
    return Drift(0.0, names[most], float(mean[most]) / steps, duration / way.shape[1])


def unsettled(groups: Mapping[str, xr.Dataset], level: str, run: str) -> str:
    """Say what of a run still moves on its way to its place; empty where nothing does."""
    series = groups.get(f"/{level}/time/{run}")
    return "" if series is None else str(series.attrs.get("unsettled", ""))


def led_points(problem: NetworkProblem, names: list[str]) -> BoolArray:
    """Return which points a motion of the case leads."""
    driven = {point.name for point in problem.points if point.kind == "driven"}
    return np.array([name in driven for name in names], dtype=bool)


def settled(problem: NetworkProblem, plan: RunPlan, series: xr.Dataset, origin: Array | None) -> tuple[RunPlan, Drift]:
    """Return the plan with the way to the mean place left out, where the case leaves that to the program, and the rest.

    Currents that change, lines that part and motions that lead away have no place to stand at. What waves
    alone move little by little counts in an irregular sea, whose means move by chance.

    Parameters
    ----------
    problem, plan
    series : xarray.Dataset
        Of the whole run, with the rows of an earlier one that it continues from.
    origin : ndarray, shape (points, 3), or None
        Places of the points in still water [m]; where the run begins when left out.
    """
    if problem.current_field is not None or problem.failures or not series.sizes["point"]:
        return plan, Drift()
    names, place = [str(name) for name in series["point"].values], series["point_position"].values
    pull = None
    if plan.waves is None and not problem.motions and "line_tension_peak_since_row" in series:
        pull = np.nan_to_num(series["line_tension_peak_since_row"].values)
    found = drift_of(
        series["time"].values, place, place[0] if origin is None else origin, led_points(problem, names),
        period=plan.period, skip=plan.skip, irregular=plan.irregular, names=names, pull=pull,
    )  # fmt: skip
    away = problem.environment.current is not None and problem.start != "rest_in_current"
    drifts = away or (plan.waves is not None and not plan.irregular)
    if drifts and problem.settings.skip is None and found.until > plan.skip:
        plan = replace(plan, skip=found.until, skip_rule=DRIFTED)
    return plan, found
