"""The first page's numbers of a curtain at rest: steady load of a span, depth, clearance, reserve of the floats."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from moyai.core.headline import Band, Headline, governing
from moyai.core.wording import spoken
from moyai.structures.curtain.hierarchy import STATICS

if TYPE_CHECKING:
    import xarray as xr

Groups = Mapping[str, "xr.Dataset"]
_TOE = "weight of the toe at slack water"
#: Steady load of the floats at the ends of its band.
_ENDS = ("steady_low", "steady_load", "steady_high")


def kilo(value: float, unit: str = "N") -> str:
    return spoken(value, unit, 3)


def statics_band(statics: xr.Dataset, name: str) -> Band | None:
    """Return the band of a number at rest: that of the governing steady load, else that of the drag."""
    ends = [f"steady_{name}_low", f"steady_{name}_high"]
    if all(end in statics for end in ends):
        low, high = (float(statics[end]) for end in ends)
        words = "drag, weights, flow under the toe, friction and end restraint of the skirt"
        return Band(low, high, words) if low < high else None
    if name not in statics:
        return None
    values = statics[name].values
    known = values[np.isfinite(values)]
    return Band(float(known.min()), float(known.max()), "range of the drag coefficient") if known.size > 1 else None


def at_rest(statics: xr.Dataset, name: str) -> float:
    """Return a number at rest, of the governing steady load where there is one."""
    if f"steady_{name}" in statics:
        return float(statics[f"steady_{name}"])
    if name not in statics:
        return math.nan
    values = statics[name]
    return float(values.sel(drag_case="given")) if "drag_case" in values.dims else float(values)


def steady_headlines(groups: Groups, levels: Sequence[str]) -> Iterator[Headline]:
    """Return the steady load of one span in the current, with its range."""
    found = []
    for level in levels:
        statics = groups.get(f"/{level}/statics")
        if statics is None:
            continue
        name = "span_load" if "steady_span_load" in statics else "anchor_horizontal_tension"
        value = at_rest(statics, name)
        line = at_rest(statics, "line_load" if "steady_line_load" in statics else "section_load")
        if math.isfinite(value):
            found.append(
                Headline(
                    "steady_load", "Steady load of one span", value, "N", where=level, model=STATICS,
                    band=statics_band(statics, name),
                    detail=f"{kilo(line, 'N/m')} where the curtain faces the current",
                )
            )  # fmt: skip
    yield from governing(found)


#: What waves do to a number of the current, which they leave out.
_IN_WAVES = {
    "effective_depth": "without waves, which lift the skirt for part of their period",
    "toe_clearance": "under still water, in the trough of a wave less",
}


def depth_headlines(groups: Groups, levels: Sequence[str]) -> Iterator[Headline]:
    wanted: tuple[tuple[str, str, str, str], ...] = (
        ("effective_depth", "Effective depth", "effective_depth", "m"),
        ("toe_clearance", "Clearance of the toe from the bed", "toe_gap", "m"),
        ("float_reserve", "Reserve of the floats, share of their buoyancy", "float_reserve_ratio", "1"),
    )
    for name, label, key, unit in wanted:
        found = []
        for level in levels:
            statics = groups.get(f"/{level}/statics")
            if statics is None and name == "float_reserve":
                found += _floats_of_loads(groups, level, name, label)
            value = math.nan if statics is None else at_rest(statics, key)
            if statics is None or not math.isfinite(value):
                continue
            band, detail = statics_band(statics, key), _other_models(name, statics, value)
            slack = _at_slack(statics, key)
            if slack is not None and slack.value < value:
                # a curtain hangs lower and heavier at slack water than in its current
                detail = f"at slack water; {_plain(value, unit)} in the current" + (f", {detail}" if detail else "")
            if slack is not None:
                value, band = _with_slack(value, band, slack)
            in_waves = any(path.startswith((f"/{level}/waves/", f"/{level}/dynamic")) for path in groups)
            if in_waves and name in _IN_WAVES:
                detail = "; ".join(filter(None, (detail, _IN_WAVES[name])))
            found.append(
                Headline(
                    name, label, value, unit, where=level, model=STATICS, band=band, detail=detail, without_waves=True
                )
            )
        yield from governing(found, "at least")


def _floats_of_loads(groups: Groups, level: str, name: str, label: str) -> list[Headline]:
    """Return the reserve of the floats by the table of loads, where no statics were asked for."""
    loads, whole = groups.get(f"/{level}/loads"), groups.get(f"/{level}")
    if loads is None or whole is None:
        return []
    row = loads.sel(component="float")
    high, value, low = (1.0 - float(row[end]) / float(row["capacity"]) for end in _ENDS)
    if not math.isfinite(value):
        return []
    flows = float(whole.attrs["surface_speed"]) > 0.0
    band = Band(low, high, _TOE if not flows else f"drag and {_TOE}") if low < high else None
    detail = "the less of that in the current and at slack water" if flows else "at slack water"
    return [Headline(name, label, value, "1", where=level, model=STATICS, band=band, detail=detail, without_waves=True)]


class _Slack(NamedTuple):
    """A number at slack water with its ends over the weight of the toe."""

    value: float
    low: float
    high: float


def _at_slack(statics: xr.Dataset, key: str) -> _Slack | None:
    """Return a number at slack water; None where the case does not give it."""
    value = float(statics[f"slack_{key}"]) if f"slack_{key}" in statics else math.nan
    if math.isnan(value):
        return None
    # a clearance has no ends, and results of older versions have none
    low, high = (float(statics.get(f"slack_{key}{end}", value)) for end in ("_low", "_high"))
    return _Slack(value, low, high)


def _with_slack(value: float, band: Band | None, slack: _Slack) -> tuple[float, Band | None]:
    """Return the less of a number in the current and at slack water, with the less of both their lower ends."""
    low, of = (value, "") if band is None else (band.low, band.of)
    if slack.low < low:
        low, of = slack.low, "; ".join(filter(None, ("" if slack.value < value else of, _TOE)))
    if slack.value < value:
        return slack.value, Band(low, slack.high, of or _TOE) if low < slack.high else None
    high = value if band is None else band.high
    return value, Band(low, high, of) if low < high else None


def _plain(value: float, unit: str) -> str:
    return f"{value:.3g}" if unit == "1" else f"{value:.3g} {unit}"


def _other_models(name: str, statics: xr.Dataset, value: float) -> str:
    """Return the one more fact that a depth needs."""
    if name == "effective_depth":
        share = f"{100.0 * value / float(statics['skirt_length']):.0f} % of the skirt"
        causes = statics["steady_cause"].values if "steady_cause" in statics.coords else ()
        if any("no shape" in str(cause) for cause in causes):
            # pressure normal to the sheet everywhere turns a light skirt over
            share += "; the lower end leaves out the other load law, which has no shape in this current"
        return share
    if name == "toe_clearance":
        speed, ratio = at_rest(statics, "toe_speed"), at_rest(statics, "toe_speed_ratio")
        if math.isfinite(speed) and math.isfinite(ratio):
            return f"{speed:.3g} m/s under the toe, {ratio:.3g} times the current there"
        return ""
    drowning = float(statics["drowning_speed"])
    return (
        f"they submerge at {drowning:.3g} m/s, their own drag counted, searched up to 10 m/s"
        if math.isfinite(drowning)
        else "no current in the range searched, up to 10 m/s, submerges them"
    )
