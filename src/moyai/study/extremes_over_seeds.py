"""Extremes of a study: maxima of the seeds, or the peaks of their series, and what is expected beyond them."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from moyai.core.arrays import Array
from moyai.core.errors import ConvergenceError, InputError
from moyai.core.results import Result
from moyai.core.validity import Notice
from moyai.series.acer import acer_interval, exceedance_rates, fit_tail
from moyai.series.extremes import check_fit, fit, maximum_interval
from moyai.series.peaks import PeakKind, interval_of_kinds, most_probable_of_kinds
from moyai.study import schema
from moyai.study.responses import Wanted, split_response
from moyai.study.tensions import response as response_of

if TYPE_CHECKING:
    import xarray as xr


_LEAST = 5
_PARETO_SHARE = 0.1
#: Peaks whose largest is wanted over those that were found, above which an interval by rates is too narrow
_FAR = 2.0
_FEW_SNAPS = 10
_NAMES = ("design_value", "lower", "upper", "most_probable_maximum", "location", "scale", "shape")


@dataclass(frozen=True)
class _FoundValues:
    """What one place of the study gives; NaN where the family has no such parameter."""

    design_value: float
    lower: float
    upper: float
    most_probable_maximum: float
    location: float = math.nan
    scale: float = math.nan
    shape: float = math.nan
    notices: tuple[Notice, ...] = ()


def fault_of(wanted: schema.ExtremesOfSeeds) -> str:
    """Return what is wrong with the settings, empty when nothing is."""
    if wanted.share is not None and wanted.family in ("gumbel", "acer"):
        return f"'share' has no meaning for {wanted.family}"
    if wanted.snaps_apart and wanted.family in ("gumbel", "acer"):
        return f"'snaps_apart' needs peaks with a distribution: weibull or generalised_pareto, not {wanted.family}"
    return ""


def wanted_of(wanted: schema.ExtremesOfSeeds) -> tuple[Wanted, ...]:
    """Return what every case must keep for the extremes: nothing more for maxima, the peaks of a series otherwise."""
    if wanted.family == "gumbel":
        return ()
    group, name, _ = split_response(wanted.response)
    variable = f"{group}/{name}" if group else name
    kinds = ("snap_peaks", "other_peaks") if wanted.snaps_apart else ("peaks",)
    return tuple(Wanted(variable, reduce) for reduce in (*kinds, "mean_in_time"))


def extremes(axes: tuple[str, ...], result: Result, wanted: schema.ExtremesOfSeeds) -> tuple[xr.Dataset, list[Notice]]:
    """Return the extremes of a response over the repetitions, at every place of the other axes.

    Parameters
    ----------
    axes : tuple of str
        Of the study.
    result : Result
        As gathered from all cases.
    wanted : ExtremesOfSeeds

    Raises
    ------
    InputError
        When the response or the axis is not there, or there are too few values.
    """
    import xarray as xr

    if wanted.family == "gumbel":
        response = response_of(result, wanted.response)
        require_axis(response, wanted.over, axes)
        moved = response.transpose(..., wanted.over)
        coordinates, places = moved.isel({wanted.over: 0}, drop=True), np.ndindex(*moved.shape[:-1])
        found = {place: _of_maxima(moved.values[place], wanted) for place in places}
    else:
        coordinates, kinds, means = _gathered(axes, result, wanted)
        found = {}
        for place in np.ndindex(*coordinates.shape):
            rows = [[row[np.isfinite(row)] for row in kind[place]] for kind in kinds]
            known = np.isfinite(means[place])
            found[place] = _of_peaks(rows, float(means[place][known].mean()), wanted) if known.any() else None
    table = {name: np.full(coordinates.shape, math.nan) for name in _NAMES}
    notices: dict[str, Notice] = {}
    for place, one in found.items():
        if one is None:
            continue
        for name in _NAMES:
            table[name][place] = getattr(one, name)
        for notice in one.notices:
            notices.setdefault(notice.code, replace(notice, message=f"{wanted.response}: {notice.message}"))
    units = coordinates.attrs.get("units", "1")
    words = _words(wanted)
    data = {
        name: (coordinates.dims, table[name], {"units": "1" if name == "shape" else units, "long_name": words[name]})
        for name in _NAMES
    }
    coords = {name: coordinates.coords[name] for name in coordinates.dims if name in coordinates.coords}
    out = xr.Dataset(data, coords=coords)
    family = wanted.family + (", snaps apart" if wanted.snaps_apart else "")
    out.attrs.update({"response": wanted.response, "over": wanted.over, "family": family})
    return out, list(notices.values())


def _words(wanted: schema.ExtremesOfSeeds) -> dict[str, str]:
    length = "" if wanted.times == 1.0 else f" of {wanted.times:g} sea states"
    percent = f"{100 * wanted.confidence:g} %"
    return {
        "design_value": f"level that the maximum{length} stays below with probability {wanted.probability:g}",
        "lower": f"lower end of its {percent} interval",
        "upper": f"upper end of its {percent} interval",
        "most_probable_maximum": f"most probable maximum{length}",
        "location": "location of the fitted distribution (mode, lower end or threshold)",
        "scale": "scale of the fitted distribution",
        "shape": "shape of the fitted distribution",
    }


def require_axis(array: xr.DataArray, name: str, axes: tuple[str, ...]) -> None:
    """Require that a response runs along an axis of the study.

    Raises
    ------
    InputError
        When it does not.
    """
    if name not in array.dims:
        raise InputError(f"the study has no axis '{name}'", path="assess", allowed=", ".join(axes))


def _of_maxima(values: Array, wanted: schema.ExtremesOfSeeds) -> _FoundValues | None:
    data = values[np.isfinite(values)]
    if data.size == 0:
        return None
    if data.size < _LEAST:
        raise InputError(
            f"{data.size} maxima of '{wanted.response}' are too few for a gumbel fit",
            path="assess.extremes",
            allowed=f"at least {_LEAST}",
            remedy=f"run more points along '{wanted.over}'",
        )
    if np.ptp(data) <= 1e-12 * np.max(np.abs(data)):
        # The response does not depend on the seed here (slack line, no waves): its value is the answer
        one = float(data[0])
        return _FoundValues(one, one, one, one, one, 0.0)
    fitted = fit(data, "gumbel")
    interval = maximum_interval(
        fitted, wanted.times, seed=wanted.seed, probability=wanted.probability, confidence=wanted.confidence,
        repetitions=200,
    )  # fmt: skip
    mode = fitted.location + fitted.scale * math.log(wanted.times)
    return _FoundValues(
        interval.value, interval.lower, interval.upper, mode, fitted.location, fitted.scale, math.nan,
        check_fit(fitted, data),
    )  # fmt: skip


def _gathered(
    axes: tuple[str, ...], result: Result, wanted: schema.ExtremesOfSeeds
) -> tuple[xr.DataArray, list[Array], Array]:
    """Return a stand-in for the places, the peaks of every kind (..., seed, peak), and the means (..., seed)."""
    items = wanted_of(wanted)
    _, _, labels = split_response(wanted.response)
    written = f"[{','.join(f'{dim}={label}' for dim, label in labels)}]" if labels else ""
    mean = response_of(result, items[-1].name + written)
    require_axis(mean, wanted.over, axes)
    mean = mean.transpose(..., wanted.over)
    kinds = []
    for item in items[:-1]:
        peaks = response_of(result, item.name + written)
        along = next(str(dim) for dim in peaks.dims if dim not in mean.dims)
        kinds.append(peaks.transpose(*mean.dims, along).values)
    return mean.isel({wanted.over: 0}, drop=True), kinds, mean.values


def _of_peaks(rows: list[list[Array]], mean: float, wanted: schema.ExtremesOfSeeds) -> _FoundValues:
    seas = max(1, max(len(kind) for kind in rows))
    if wanted.family == "acer":
        return _of_rates(rows[0], seas, wanted)
    notices: list[Notice] = []
    pooled = [np.concatenate(kind) if kind else np.empty(0) for kind in rows]
    if len(pooled) == 2:
        snaps, others = pooled
        if 0 < snaps.size < _FEW_SNAPS or 0 < others.size < _FEW_SNAPS:
            few = "snap" if snaps.size < others.size else "other"
            message = f"{min(snaps.size, others.size)} {few} peaks are too few for a separate fit: taken together"
            notices.append(Notice("extremes-few-snaps", message, remedy="run more seeds"))
            pooled = [np.concatenate(pooled)]
        else:
            pooled = [kind for kind in pooled if kind.size]
    if not pooled or sum(kind.size for kind in pooled) < _LEAST:
        return _FoundValues(math.nan, math.nan, math.nan, math.nan)
    if all(np.ptp(kind) <= 1e-12 * np.max(np.abs(kind)) for kind in pooled):
        one = max(float(kind[0]) for kind in pooled)
        return _FoundValues(one, one, one, one, one, 0.0, math.nan, tuple(notices))
    kinds = []
    for kind in pooled:
        lower_end, threshold = _lower_ends(kind, mean, wanted)
        if wanted.family == "weibull":
            fitted = fit(kind, "weibull", location=lower_end, threshold=threshold)
        else:
            fitted = fit(kind, "generalised_pareto", location=lower_end)
        kinds.append(PeakKind(fitted, wanted.times * fitted.count / seas))
        notices += check_fit(fitted, kind)
    try:
        if len(kinds) == 1 and wanted.family == "generalised_pareto":
            interval = maximum_interval(
                kinds[0].fitted, kinds[0].count, seed=wanted.seed, probability=wanted.probability,
                confidence=wanted.confidence, values=pooled[0],
            )  # fmt: skip
        else:
            interval = interval_of_kinds(kinds, wanted.probability, seed=wanted.seed, confidence=wanted.confidence)
        mode = most_probable_of_kinds(kinds)
    except ConvergenceError as error:
        raise InputError(error.fault.message, path="assess.extremes", remedy="run more seeds") from None
    main = max(kinds, key=lambda one: one.fitted.level(1e-3)).fitted
    return _FoundValues(
        interval.value, interval.lower, interval.upper, mode, main.location, main.scale, main.shape, tuple(notices)
    )


def _lower_ends(peaks: Array, mean: float, wanted: schema.ExtremesOfSeeds) -> tuple[float, float | None]:
    """Return the lower end of the distribution, and the threshold above which a Weibull is fitted."""
    least = float(peaks.min()) - 1e-9 * float(np.ptp(peaks))
    base = min(mean, least)
    part = wanted.share or (1.0 if wanted.family == "weibull" else _PARETO_SHARE)
    # Never fewer than twenty peaks, as long as there are as many
    part = min(max(part, 20.0 / peaks.size), 1.0)
    threshold = float(np.quantile(peaks, 1.0 - part)) if part < 1.0 else least
    if wanted.family == "weibull":
        return base, threshold if part < 1.0 else None
    return threshold, None


def _of_rates(rows: list[Array], seas: int, wanted: schema.ExtremesOfSeeds) -> _FoundValues:
    total = sum(row.size for row in rows)
    if total < 20:
        return _FoundValues(math.nan, math.nan, math.nan, math.nan)
    rates = exceedance_rates([row for row in rows if row.size >= wanted.order], order=wanted.order)
    tail = fit_tail(rates)
    count = wanted.times * total / seas
    interval = acer_interval(tail, count, wanted.probability, confidence=wanted.confidence)
    mode = tail.most_probable_maximum(count)
    return _FoundValues(
        interval.value, interval.lower, interval.upper, mode, tail.b, math.nan, math.nan, _far_beyond(count, total)
    )


def _far_beyond(count: float, total: int) -> tuple[Notice, ...]:
    """Return a notice where the largest of more peaks is wanted than were found: intervals hold too little there."""
    if count <= _FAR * total:
        return ()
    message = (
        f"the largest of {count:.4g} peaks is wanted and {total} peaks were found; so far beyond them the interval is "
        "too narrow"
    )
    return (Notice("extremes-far", message, count / total, _FAR, remedy="run more seeds"),)
