"""What all cases say together: lines and anchors against codes, extremes over seeds, return levels over a scatter.

Works on the dataset of the study, whatever the structure: lines are found by the common names of their
largest and mean tension and breaking load, or where the study file says that their tensions stand.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from moyai.core.errors import InputError
from moyai.core.results import Result
from moyai.core.validity import Notice
from moyai.core.vocabulary import FACTORED_UTILISATION
from moyai.design.codes import DesignCode, LineLoad, check_confirmation, check_line, design_code
from moyai.design.long_term import return_level
from moyai.mooring.anchors import DragAnchor, Sinker, check_drag_anchor, check_sinker
from moyai.series.extremes import fit
from moyai.study import schema
from moyai.study.definition import Study
from moyai.study.extremes_over_seeds import extremes, require_axis
from moyai.study.fatigue_of_lines import fatigue
from moyai.study.tensions import Tensions, has, tensions, variable
from moyai.study.tensions import response as response_of
from moyai.tables.design_codes import CodeRule, holding_data

if TYPE_CHECKING:
    import xarray as xr

_WAVES = 1000.0
"""Waves of a sea state whose most probable maximum alone is known, unless the study file says how many."""


def assess(study: Study, result: Result, wanted: schema.Assessment | None) -> Result:
    """Add what the study requires to its result.

    Parameters
    ----------
    study : Study
    result : Result
        As gathered from all cases.
    wanted : Assessment or None

    Returns
    -------
    Result
        With the groups ``/assessment/...`` and the notices that come with them.

    Notes
    -----
    What cannot be assessed (a response, an axis or a line that is not there) becomes a notice of severity ``error``.
    """
    if wanted is None:
        return result
    import xarray as xr

    groups: dict[str, xr.Dataset] = {node.path: node.to_dataset(inherit=False) for node in result.tree.subtree}
    notices: list[Notice] = []
    parts: list[tuple[str, Callable[[], tuple[xr.Dataset, list[Notice]]]]] = []
    if (lines := wanted.lines) is not None:
        parts.append(("lines", lambda: _lines(study, lines, tensions(study, result, wanted.tensions))))
    if wanted.anchors:
        parts.append(("anchors", lambda: _anchors(study, wanted.anchors, tensions(study, result, wanted.tensions))))
    for number, one in enumerate(wanted.extremes):
        parts.append((f"extremes {number + 1}", lambda one=one: extremes(_names(study), result, one)))  # type: ignore[misc]
    for number, other in enumerate(wanted.long_term):
        parts.append((f"long term {number + 1}", lambda other=other: _long_term(study, result, other)))  # type: ignore[misc]
    for number, tired in enumerate(wanted.fatigue):
        parts.append((f"fatigue {number + 1}", lambda tired=tired: fatigue(study, result, tired)))  # type: ignore[misc]
    for name, compute in parts:
        try:
            groups[f"/assessment/{name}"], said = compute()
            notices += said
        except InputError as error:
            # The cases have run; what cannot be made of them is reported, and the rest is kept
            message = f"{name} could not be assessed: {error.fault.message}"
            allowed = f"allowed: {error.fault.allowed}" if error.fault.allowed else ""
            remedy = "; ".join(part for part in (allowed, error.fault.remedy) if part)
            notices.append(Notice("assessment-failed", message, severity="error", remedy=remedy))
    attributes = dict(result.tree.attrs)
    tree = xr.DataTree.from_dict(groups)
    tree.attrs.update(attributes)
    return replace(result, tree=tree).with_notices(*notices)


def _names(study: Study) -> tuple[str, ...]:
    return tuple(axis.name for axis in study.axes)


def _codes(wanted: schema.LineChecks) -> list[DesignCode]:
    codes = []
    for one in wanted.codes:
        factors: dict[Literal["intact", "one_lost"], float | None] = {
            "intact": one.safety_factor_intact,
            "one_lost": one.safety_factor_one_lost,
        }
        own = [
            CodeRule(one.name, "own", condition, "any", "any", "any", "safety_factor", value, True, "study file")
            for condition, value in factors.items()
            if value is not None
        ]
        confirmed = [one.name] if one.confirmed else []
        codes.append(
            design_code(one.name, analysis=one.analysis, consequence=one.consequence, confirmed=confirmed, own=own)
        )
    return codes


def _lines(study: Study, wanted: schema.LineChecks, found: list[Tensions]) -> tuple[xr.Dataset, list[Notice]]:
    import xarray as xr

    codes = _codes(wanted)
    dims = [axis.name for axis in study.axes]
    lost = _lost_labels(study)
    lines = [str(one) for one in found[0].maximum.coords["line"].values]
    for given in (*wanted.component, *wanted.diameter):
        if given not in lines:
            raise InputError(f"there is no line '{given}'", path="assess.lines", allowed=", ".join(lines))
    shape = (len(codes), len(found), *study.shape, len(lines))
    utilisation = np.full(shape, math.nan)
    notices = [notice for code in codes for notice in check_confirmation(code)]
    skipped: set[str] = set()
    for c, code in enumerate(codes):
        for t, item in enumerate(found):
            maximum, mean, breaking = (
                one.transpose(*dims, "line").values for one in (item.maximum, item.mean, item.breaking)
            )
            for place in np.ndindex(*study.shape):
                label = "" if lost is None else lost[1][place[lost[0]]]
                for number, line in enumerate(lines):
                    load = LineLoad(
                        line,
                        float(maximum[(*place, number)]),
                        float(mean[(*place, number)]),
                        float(breaking[(*place, number)]),
                        wanted.component.get(line, "chain"),
                        label,
                    )
                    if not math.isfinite(load.maximum_tension):
                        continue
                    try:
                        outcome = check_line(
                            load, code, corrosion=1e-3 * wanted.corrosion_rate * wanted.life,
                            diameter=wanted.diameter.get(line, math.nan),
                        )  # fmt: skip
                    except InputError as error:
                        if not label:
                            raise
                        # Codes without a damaged condition are silent on it
                        skipped.add(f"{code.name}: {error.fault.message}")
                        continue
                    utilisation[(c, t, *place, number)] = outcome.utilisation
    notices += [Notice("code-silent", f"not checked: {message}", severity="information") for message in sorted(skipped)]
    unknown = [line for number, line in enumerate(lines) if np.isnan(utilisation[..., number]).all()]
    if unknown:
        message = f"no utilisation for {', '.join(unknown)}: the breaking load is not known"
        notices.append(Notice("breaking-load-unknown", message, remedy="give 'breaking_load' to the line"))
    worst = float(np.nanmax(utilisation)) if np.isfinite(utilisation).any() else math.nan
    if worst > 1.0:
        notices.append(
            Notice(
                "lines-fail",
                f"the largest utilisation of a line is {worst:.2f} (limit 1)",
                worst,
                1.0,
                "error",
                remedy="see the governing cases",
            )
        )
    attributes = {"units": "1", "long_name": "utilisation of the line under the code"}
    coordinates: dict[str, Any] = {
        "code": [code.name for code in codes],
        "sea": [item.group for item in found],
        "line": lines,
        "confirmed": ("code", [float(all(rule.confirmed for rule in code.rules)) for code in codes], {"units": "1"}),
    }
    data = {FACTORED_UTILISATION.name: (("code", "sea", *dims, "line"), utilisation, attributes)}
    return xr.Dataset(data, coords=coordinates), notices


def _lost_labels(study: Study) -> tuple[int, list[str]] | None:
    """Return the axis of lost lines and the name of what is lost at each of its points ('' when intact)."""
    for place, axis in enumerate(study.axes):
        if axis.lost_line:
            return place, ["" if point.label == "intact" else point.label for point in axis.points]
    return None


def _anchors(
    study: Study, wanted: dict[str, schema.AnchorOfLine], found: list[Tensions]
) -> tuple[xr.Dataset, list[Notice]]:
    import xarray as xr

    pulls = [item for item in found if item.uplift is not None]
    if not pulls:
        raise InputError("no case gives the pull at the anchors", path="assess.anchors")
    dims = [axis.name for axis in study.axes]
    lines = [str(one) for one in pulls[0].maximum.coords["line"].values]
    for line in wanted:
        if line not in lines:
            raise InputError(f"there is no line '{line}'", path="assess.anchors", allowed=", ".join(lines))
    values = np.full((len(pulls), *study.shape, len(wanted)), math.nan)
    notices: dict[str, Notice] = {}
    for n, (line, given) in enumerate(wanted.items()):
        coefficient, sure, source = given.coefficient, True, "user"
        if coefficient is None:
            data = holding_data(given.kind, given.name, given.bed)
            coefficient, sure, source = data.value, data.confirmed, data.source
        if not sure:
            message = f"the holding of {given.name} on {given.bed} ({coefficient:g}) was not compared with its source"
            notices[message] = Notice("anchor-unconfirmed", message, remedy="give 'coefficient'", source=source)
        for t, item in enumerate(pulls):
            assert item.uplift is not None
            pull = item.maximum.sel(line=line).transpose(*dims).values
            up = item.uplift.sel(line=line).transpose(*dims).values
            for place in np.ndindex(*study.shape):
                total, vertical = float(pull[place]), max(float(up[place]), 0.0)
                if not math.isfinite(total):
                    continue
                # The tension at the fairlead is no less than that at the anchor: on the safe side
                horizontal = math.sqrt(max(total**2 - vertical**2, 0.0))
                if given.kind == "sinker":
                    outcome = check_sinker(Sinker(given.weight, coefficient, given.safety_factor), horizontal, vertical)
                else:
                    anchor = DragAnchor(given.weight, coefficient, given.safety_factor)
                    outcome = check_drag_anchor(anchor, horizontal, vertical)
                values[(t, *place, n)] = outcome.utilisation
                for notice in outcome.notices:
                    known = notices.get(line)
                    if known is None or notice.value > known.value:
                        notices[line] = replace(notice, message=f"{line}: {notice.message}")
    worst = float(np.nanmax(values)) if np.isfinite(values).any() else math.nan
    if worst > 1.0:
        notices["worst"] = Notice(
            "anchors-fail", f"the largest utilisation of an anchor is {worst:.2f} (limit 1)", worst, 1.0, "error"
        )
    attributes = {"units": "1", "long_name": "utilisation of the anchor"}
    coordinates = {"sea": [item.group for item in pulls], "line": list(wanted)}
    table = {FACTORED_UTILISATION.name: (("sea", *dims, "line"), values, attributes)}
    return xr.Dataset(table, coords=coordinates), list(notices.values())


def _long_term(study: Study, result: Result, wanted: schema.LongTerm) -> tuple[xr.Dataset, list[Notice]]:
    import xarray as xr

    response = response_of(result, wanted.response)
    require_axis(response, wanted.over, _names(study))
    axis = next(one for one in study.axes if one.name == wanted.over)
    share = np.array([point.probability for point in axis.points])
    if not np.isfinite(share).all():
        raise InputError(
            f"the points of '{wanted.over}' have no probabilities",
            path="assess.long_term",
            remedy="use a scatter diagram",
        )
    inner = (wanted.over, wanted.seeds) if wanted.seeds else (wanted.over,)
    if wanted.seeds:
        require_axis(response, wanted.seeds, _names(study))
    moved = response.transpose(..., *inner)
    outer = moved.shape[: moved.ndim - len(inner)]
    levels = np.full((*outer, len(wanted.years)), math.nan)
    for place in np.ndindex(*outer):
        table = moved.values[place]
        if not np.isfinite(table).all():
            continue
        waves = wanted.waves or _WAVES
        short = [_short_term(row if wanted.seeds else float(row), waves) for row in table]
        largest = float(np.max(table))
        for number, years in enumerate(wanted.years):
            levels[(*place, number)] = return_level(
                years, share, short, wanted.duration, (1e-6 * largest, 50.0 * largest)
            )
    dims = moved.dims[: len(outer)]
    attributes = {"units": response.attrs.get("units", "1"), "long_name": f"return level of {wanted.response}"}
    coords: dict[str, Any] = {str(name): moved.coords[name] for name in dims if name in moved.coords}
    coords["return_period"] = ("return_period", list(map(float, wanted.years)), {"units": "year"})
    out = xr.Dataset({"return_level": ((*dims, "return_period"), levels, attributes)}, coords=coords)
    out.attrs.update({"response": wanted.response, "over": wanted.over})
    if wanted.seeds:
        return out, []
    message = (
        f"'{wanted.response}' is taken as the most probable maximum of each sea state, of Rayleigh peaks in "
        f"{wanted.waves or _WAVES:g} waves"
    )
    return out, [
        Notice(
            "long-term-rayleigh",
            message,
            severity="information",
            remedy="give the number of 'waves', or run seeds and name their axis",
        )
    ]


def _short_term(maxima: Any, waves: float) -> Callable[[np.ndarray], np.ndarray]:
    """Return the exceedance of a sea state's maximum: Gumbel of its seeds, or Rayleigh peaks of a known mode.

    The mode ``m`` of the maximum of ``N`` Rayleigh peaks is the level that one of them exceeds, so that any level
    ``x`` is exceeded by ``N^(1 - (x/m)^2)`` of them in the mean [eq:extremes-weibull].
    """
    from moyai.series.extremes import ExtremeFit

    data = np.atleast_1d(np.asarray(maxima, dtype=float))
    if data.size == 1:
        mode = max(float(data[0]), 1e-300)

        def exceeds(level: np.ndarray) -> np.ndarray:
            peaks = np.exp(math.log(waves) * (1.0 - (np.asarray(level, dtype=float) / mode) ** 2))
            return np.asarray(-np.expm1(-peaks))

        return exceeds
    if np.ptp(data) <= 1e-12 * np.max(np.abs(data)):
        fitted = ExtremeFit("gumbel", float(data[0]), 1e-6 * max(abs(float(data[0])), 1e-300), 0.0, data.size, math.nan)
    else:
        fitted = fit(data, "gumbel")
    return fitted.exceedance


def governing(study: Study, result: Result, most: int) -> list[tuple[str, int, float]]:
    """Return the governing case of every component: name, number of the case, utilisation (or the watched response).

    Parameters
    ----------
    study : Study
    result : Result
        With its assessment.
    most : int
        Number of different cases at most.
    """
    found: list[tuple[str, int, float]] = []
    for group, what in (("lines", "line"), ("anchors", "anchor of")):
        if not has(result, f"/assessment/{group}", FACTORED_UTILISATION.name):
            continue
        table = variable(result, f"/assessment/{group}", FACTORED_UTILISATION.name)
        dims = [axis.name for axis in study.axes]
        for line in table.coords["line"].values:
            one = table.sel(line=line)
            values = one.transpose(*dims, ...).values.reshape(len(study.cases), -1)
            if np.isfinite(values).any():
                flat = np.where(np.isfinite(values), values, -math.inf).max(axis=1)
                index = int(np.argmax(flat))
                found.append((f"{what} {line}", index, float(flat[index])))
    if not found and study.watch:
        try:
            response = response_of(result, study.watch)
        except InputError:
            return []
        found = _largest_of(study, response)
    found.sort(key=lambda item: -item[2])
    kept: list[tuple[str, int, float]] = []
    for item in found:
        if len({one[1] for one in kept} | {item[1]}) <= most:
            kept.append(item)
    return kept


def _largest_of(study: Study, response: xr.DataArray) -> list[tuple[str, int, float]]:
    """Return the case of the largest value of the watched response; one for each label where it has one dimension."""
    dims = [axis.name for axis in study.axes]
    rest = [dim for dim in response.dims if dim not in dims]
    labelled = len(rest) == 1 and rest[0] in response.coords and response.coords[rest[0]].dtype.kind in "OUT"
    words = [f"{study.watch}[{rest[0]}={label}]" for label in response.coords[rest[0]].values] if labelled else []
    values = response.transpose(*dims, ...).values.reshape(len(study.cases), -1)
    columns = values.T if words else values.max(axis=1, initial=-math.inf, where=np.isfinite(values))[None]
    found = []
    for word, column in zip(words or [study.watch], columns):
        flat = np.where(np.isfinite(column), column, -math.inf)
        index = int(np.argmax(flat))
        if math.isfinite(flat[index]):
            found.append((word, index, float(flat[index])))
    return found


def utilised(result: Result) -> bool:
    """Whether lines or anchors were compared with something: their utilisations govern then."""
    return any(has(result, f"/assessment/{group}", FACTORED_UTILISATION.name) for group in ("lines", "anchors"))
