"""Life of the lines over the sea states of a study, each line by the endurance curve of its kind."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from moyai.core.errors import InputError
from moyai.core.results import Result
from moyai.core.validity import Notice
from moyai.core.vocabulary import LINE_TENSION_MEAN
from moyai.design.long_term import YEAR
from moyai.study import schema
from moyai.study.definition import Study
from moyai.study.tensions import breaking_loads
from moyai.study.tensions import response as response_of
from moyai.tables.design_codes import EnduranceData, endurance_data

if TYPE_CHECKING:
    import xarray as xr

EVERY = "*"


def curves_of(wanted: schema.Fatigue) -> dict[str, EnduranceData]:
    """Return the endurance curve of every line; under ``*`` that of all others.

    Raises
    ------
    InputError
        For an unknown curve, or a curve in stresses without the diameter of its line.
    """
    named = {EVERY: wanted.curve} if isinstance(wanted.curve, str) else wanted.curve
    if not named:
        raise InputError("no line has an endurance curve", path="curve", remedy="name one under 'curve'")
    curves = {line: endurance_data(name) for line, name in named.items()}
    for line, curve in curves.items():
        if curve.unit != "1" and not wanted.diameter:
            of = "the lines" if line == EVERY else line
            remedy = f"give the 'diameter' of {of}, or choose a curve in ratios to the breaking load"
            raise InputError(f"'{curve.name}' takes stresses", path="diameter", remedy=remedy)
    return curves


def fatigue(study: Study, result: Result, wanted: schema.Fatigue) -> tuple[xr.Dataset, list[Notice]]:
    """Return the life of every line over the sea states; [eq:fatigue-miner] summed by their probabilities.

    Parameters
    ----------
    study : Study
    result : Result
        As gathered from all cases.
    wanted : Fatigue

    Raises
    ------
    InputError
        When a line, its curve, its strength or the axis of the sea states is missing.
    """
    import xarray as xr

    axis = next((one for one in study.axes if one.name == wanted.over), None)
    if axis is None:
        known = ", ".join(one.name for one in study.axes)
        raise InputError(f"the study has no axis '{wanted.over}'", path="assess.fatigue", allowed=known)
    share = np.array([point.probability for point in axis.points])
    if not np.isfinite(share).all():
        raise InputError(f"the points of '{wanted.over}' have no probabilities", path="assess.fatigue")
    curves = curves_of(wanted)
    first = response_of(result, _sums(wanted, next(iter(curves.values()))))
    if "line" not in first.dims:
        raise InputError(f"'{wanted.response}' is no series of lines", path="assess.fatigue.response")
    lines = [str(one) for one in first.coords["line"].values]
    for given in (*curves, *wanted.diameter):
        if given != EVERY and given not in lines:
            raise InputError(f"there is no line '{given}'", path="assess.fatigue", allowed=", ".join(lines))
    lacking = [line for line in lines if line not in curves and EVERY not in curves]
    if lacking:
        remedy = "name one, or one for all others under '*'"
        raise InputError(f"no endurance curve for {', '.join(lacking)}", path="assess.fatigue.curve", remedy=remedy)
    weights = xr.DataArray(share, dims=[wanted.over])
    lives, ranges = [], []
    for line in lines:
        curve = curves.get(line) or curves[EVERY]
        sums, reference, capacity = _of_line(result, wanted, line, curve)
        rate = ((sums / reference**curve.exponent / capacity) * weights).sum(wanted.over, skipna=False)
        mean_sums = (sums * weights).sum(wanted.over, skipna=False)
        repeated = [one.name for one in study.axes if one.name in rate.dims and one.name == "seed"]
        if repeated:
            rate, mean_sums = rate.mean(repeated, skipna=False), mean_sums.mean(repeated, skipna=False)
        with np.errstate(divide="ignore"):
            lives.append(1.0 / (rate * YEAR * wanted.safety_factor))
        cycles = wanted.equivalent_cycles or math.nan
        # [eq:fatigue-equivalent] in the unit of the tension
        ranges.append((mean_sums * YEAR / cycles) ** (1.0 / curve.exponent))
    index = xr.IndexVariable("line", lines)
    life = xr.concat(lives, index).transpose(..., "line")
    words = ", ".join(dict.fromkeys(curve.name for curve in curves.values()))
    attributes = {"units": "year", "long_name": f"life by {words}, safety factor {wanted.safety_factor:g}"}
    coords = {str(dim): life.coords[dim] for dim in life.dims if dim in life.coords}
    data = {"life": (life.dims, life.values, attributes)}
    if wanted.equivalent_cycles is not None:
        reported = f"constant range of the same damage in {wanted.equivalent_cycles:g} cycles a year"
        units = response_of(result, _sums(wanted, next(iter(curves.values())))).attrs.get("units", "1").split("^")[0]
        values = xr.concat(ranges, index).transpose(..., "line").values
        data["equivalent_range"] = (life.dims, values, {"units": units, "long_name": reported})
    out = xr.Dataset(data, coords=coords)
    out.attrs.update({"response": wanted.response, "curve": words})
    return out, _notices(curves, wanted)


def _sums(wanted: schema.Fatigue, curve: EnduranceData) -> str:
    return f"{wanted.response}_rainflow_{curve.exponent:g}"


def _of_line(
    result: Result, wanted: schema.Fatigue, line: str, curve: EnduranceData
) -> tuple[xr.DataArray, xr.DataArray | float, xr.DataArray | float]:
    """Return the damage sums of a line, what its ranges are divided by, and the capacity of its curve."""
    sums = response_of(result, _sums(wanted, curve)).sel(line=line, drop=True)
    if curve.unit != "1":
        if line not in wanted.diameter:
            raise InputError(f"the diameter of {line} is not known", path="assess.fatigue.diameter", remedy="give it")
        bars = 2.0 if "chain" in curve.name else 1.0
        return sums, bars * math.pi / 4.0 * wanted.diameter[line] ** 2 * 1e6, curve.capacity
    level = wanted.response.split("/")[0]
    strengths = breaking_loads(result, level)
    if strengths is None:
        raise InputError("the breaking loads of the lines are not known", path="assess.fatigue")
    breaking = strengths.sel(line=line, drop=True)
    if not curve.mean_term:
        return sums, breaking, curve.capacity
    mean = response_of(result, wanted.response.rsplit("/", 2)[0] + f"/{LINE_TENSION_MEAN.name}").sel(
        line=line, drop=True
    )
    return sums, breaking, curve.capacity * 10.0 ** (-curve.mean_term * mean / breaking)


def _notices(curves: dict[str, EnduranceData], wanted: schema.Fatigue) -> list[Notice]:
    found = {}
    for curve in curves.values():
        if not (curve.confirmed or wanted.confirmed):
            message = f"the endurance curve '{curve.name}' was not compared with the standard itself"
            remedy = "compare it with your copy and give 'confirmed: true'"
            found[curve.name] = Notice("curve-unconfirmed", message, remedy=remedy, source=curve.source)
    return list(found.values())
