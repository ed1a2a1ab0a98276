"""The numbers of the first page of a floating breakwater: which model governs each, its band, its place.

The hierarchy, from the one that governs down: time domain with lines in motion; time domain with lines at rest at every
instant, while the largest tension stays under five times the mean; frequency domain, first order and slow drift, in the
same range. What is out of its range never governs: the number is then said to be not known (docs/answer/breakwater.md).
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from moyai.core.headline import Band, Headline, all_judged, unfavourable
from moyai.core.wording import kilonewton
from moyai.series.realisations import ALONE, alone, seeds, storms
from moyai.structures.breakwater.largest_motion import LargestOfPeriods
from moyai.structures.breakwater.lines.headlines import (
    AT_REST,
    FIRST_ORDER,
    FREQUENCY,
    IN_MOTION,
    STILL,
    WITHOUT_DRIFT,
    LinePeak,
    anchor_headlines,
    drift_left_out,
    governing_group,
    line_headlines,
    line_peaks,
    place,
    seas_of,
    storm_words,
    tension_at_rest,
)

if TYPE_CHECKING:
    import xarray as xr


STEADY = "wind and current at rest, mean drift of the frequency domain"
DAMPING_ALONE = "the band of damping alone, without waves round the ends or over the deck"
ONE_DAMPING = "one damping without a band, without waves round the ends or over the deck"
_SWAY, _ROLL = 0, 2
MUCH_OVERTOPPING = 0.05  # share of waves over the deck from which linear transmission is qualified


def headlines(groups: Mapping[str, xr.Dataset]) -> tuple[Headline, ...]:
    """Return the headlines of a breakwater.

    Parameters
    ----------
    groups : mapping of str to Dataset
        What was run, by path: ``/<level>/statics``, ``/<level>/frequency/<sea>``, ``/<level>/time/<sea>``.
    """
    levels = [path[1:] for path in groups if path.count("/") == 1 and "water_depth" in groups[path].attrs]
    peaks = [peak for level in levels for peak in line_peaks(groups, level)]
    found: list[Headline] = []
    if peaks:
        found += line_headlines(peaks) + anchor_headlines(groups, levels, peaks)
    else:
        found += tension_at_rest(groups, levels)
    found += _transmission(groups, levels) + _motion_headlines(groups, levels)
    found += _steady_load(groups, levels)
    return (*found, *_rest_headlines(groups, levels), *([_not_judged()] if peaks else []))


@dataclass(frozen=True, eq=False)
class _Passed:
    """The transmission of one sea, or of one of its periods, at one water level."""

    item: Headline
    sea: str
    irregular: bool
    data: xr.Dataset
    row: int | None
    in_time: float


def _transmission(groups: Mapping[str, xr.Dataset], levels: list[str]) -> list[Headline]:
    """Return the largest transmission: of irregular seas where there are any, by the consistent frequency domain.

    Behind it stand, not shown, that of every sea for criteria at a named one, and the one whose upper end is the
    largest of all: a limit without a sea holds in every sea and period.
    """
    found = [one for level in levels for sea in seas_of(groups, level) for one in _passed(groups, level, sea)]
    if not found:
        return []
    chosen = max(found, key=lambda one: (one.irregular, one.item.value))
    value, where = chosen.item.value, chosen.item.where
    detail = "energy-weighted" if chosen.irregular else "largest over the periods"
    detail += "; " + _outside_the_band(groups, where, chosen.data, chosen.row)
    if math.isfinite(chosen.in_time):
        detail += f"; {chosen.in_time:.3g} with the motions of the time domain"
    highest = max((one.item for one in found), key=lambda item: item.value)
    if highest.value > value:
        detail += f"; up to {highest.value:.3g} in regular waves: {highest.where}"
    if "overtopping_share" in chosen.data and (over := float(chosen.data["overtopping_share"])) > MUCH_OVERTOPPING:
        detail += f"; without the water that up to {100.0 * over:.0f} % of the waves bring over the deck"
    shown = replace(chosen.item, detail=detail)
    widest = max((one.item for one in found), key=unfavourable)
    behind = [replace(widest, shown=False)] if unfavourable(widest) > unfavourable(shown) else []
    seas = dict.fromkeys(one.sea for one in found)
    largest = (max((one.item for one in found if one.sea == sea), key=unfavourable) for sea in seas)
    named = [replace(item, sea=sea, shown=False) for sea, item in zip(seas, largest, strict=True)]
    return [shown, *behind, *named]


def _passed(groups: Mapping[str, xr.Dataset], level: str, sea: str) -> Iterator[_Passed]:
    data = groups.get(f"/{level}/frequency/{sea}")
    if data is None or "transmission_coefficient" not in data:
        return
    values = np.atleast_1d(data.variables["transmission_coefficient"].values)
    regular = "period" in data.dims
    time: Mapping[Any, Any] = {} if regular else groups.get(f"/{level}/time/{sea}", {})
    in_time = float(time["transmission_coefficient"]) if "transmission_coefficient" in time else math.nan
    # every period: one near a resonance has the wider band
    for row in np.flatnonzero(np.isfinite(values)):
        period, at = (float(data.variables["period"].values[row]), int(row)) if regular else (math.nan, None)
        band = _damping_band(data, at)
        ground = DAMPING_ALONE if band is not None and band.high > band.low else ONE_DAMPING
        item = Headline(
            "transmission", "Wave transmission K_T of a long structure", float(values[row]), "1",
            place(level, sea, period), FIRST_ORDER if regular else FREQUENCY, band=band, judged_on=ground,
        )  # fmt: skip
        yield _Passed(item, sea, not regular, data, at, in_time)


def _damping_band(data: xr.Dataset, row: int | None) -> Band | None:
    """Return how far the transmission moves over what is uncertain in damping, where the sea carries it."""
    if "transmission_coefficient_low" not in data or "transmission_coefficient_high" not in data:
        return None
    ends = [data.variables[f"transmission_coefficient_{end}"].values for end in ("low", "high")]
    low, high = (float(item if row is None else item[row]) for item in ends)
    if not math.isfinite(low + high):
        return None
    return Band(low, high, f"covers damping alone: {data.attrs.get('damping_band', 'damping')}")


def _outside_the_band(groups: Mapping[str, xr.Dataset], where: str, data: xr.Dataset, row: int | None) -> str:
    """Say what the band of the transmission does not cover: the ends of the unit, and what other formulas give."""
    level = where.split(", ")[0]
    waves, statics = groups.get(f"/{level}/rao"), groups.get(f"/{level}/statics")
    if waves is None or statics is None or "transmission_macagno" not in waves:
        return "ends of the unit are not covered"
    if row is not None:
        omega = 2.0 * math.pi / float(data.variables["period"].values[row])
    else:
        omega = float(data.variables["omega"].values[int(np.nanargmax(data.variables["wave_spectrum"].values))])
    known = waves.variables["omega"].values

    def at(name: str) -> float:
        return float(np.interp(omega, known, waves.variables[name].values))

    share = float(statics["unit_length"]) / at("wavelength")
    return (
        f"fixed hulls at T = {2.0 * math.pi / omega:.2g} s: Macagno {at('transmission_macagno'):.2g}, Wiegel "
        f"{at('transmission_wiegel'):.2g}; not covered: waves round the ends of a unit of {share:.2g} wavelengths"
    )


def _steady_load(groups: Mapping[str, xr.Dataset], levels: list[str]) -> list[Headline]:
    """Return the largest steady load in sway with its parts: wind, current, mean drift of the waves."""
    found: list[Headline] = []
    for level in levels:
        statics = groups.get(f"/{level}/statics")
        if statics is None or "steady_force_of_wind" not in statics:
            continue
        parts = [float(statics.variables[f"steady_force_of_{name}"].values[0]) for name in ("wind", "current")]
        drifts = [(level, 0.0, STILL)]
        for sea in seas_of(groups, level):
            data = groups.get(f"/{level}/frequency/{sea}")
            if data is None or "mean_drift_force" not in data:
                continue
            values = np.atleast_1d(data.variables["mean_drift_force"].values)
            if np.isfinite(values).any():
                row = int(np.nanargmax(np.abs(values)))
                period = float(data.variables["period"].values[row]) if "period" in data.dims else math.nan
                drifts.append((place(level, sea, period), float(values[row]), STEADY))
        for where, drift, model in drifts:
            words = (
                f"wind {kilonewton(parts[0])}, current {kilonewton(parts[1])}, mean drift of waves {kilonewton(drift)}"
            )
            found.append(
                Headline("steady_load", "Steady load in sway", sum(parts) + drift, "N", where, model, detail=words)
            )
    found = [max(found, key=lambda item: abs(item.value))] if found else []
    return [item for item in found if item.value]


def _not_judged() -> Headline:
    return Headline(
        "not_judged", "Not judged", math.nan, "1", text="one line lost, corrosion and wear, fatigue",
        detail=(
            "'lines_lost' of a study runs the structure with each line lost, 'assess' of a study judges corrosion and "
            "fatigue; connectors between units and the holding of an anchor in its soil are not computed"
        ),
    )  # fmt: skip


def _motion_headlines(groups: Mapping[str, xr.Dataset], levels: list[str]) -> list[Headline]:
    """Return the largest sway from rest and the significant roll."""
    offsets: list[Headline] = []
    rolls: list[Headline] = []
    for level in levels:
        for sea in seas_of(groups, level):
            chosen = governing_group(groups, level, sea)
            frequency = groups.get(f"/{level}/frequency/{sea}")
            if chosen is not None and "period" in chosen[1].dims:
                largest = LargestOfPeriods(*chosen, frequency, groups.get(f"/{level}/statics"), place(level, sea))
                offsets += largest.offset()
                rolls += largest.roll()
            elif chosen is not None:
                offsets += _offset(*chosen, level, sea, frequency)
                rolls += _roll(*chosen, level, sea, frequency)
    found = [*all_judged(offsets), *all_judged(rolls)]
    if not found and (rest := _steady_offset(groups, levels)) is not None:
        found = [rest]
    return found


def _offset(domain: str, data: xr.Dataset, level: str, sea: str, frequency: xr.Dataset | None) -> list[Headline]:
    mean = np.atleast_2d(data.variables["mean_offset"].values)[:, 0] if "mean_offset" in data else np.array([math.nan])
    model = _motion_model(domain, data)
    band, bound = None, alone(np.zeros(0))
    if "largest_offset_by_dof" in data:
        value = float(data.variables["largest_offset_by_dof"].values[0])
        scatter = np.asarray(data.variables["largest_offset_by_dof_of_realisation"].values[:, 0], dtype=float)
        band, bound = _with_lines_in_motion(value, seeds(scatter), data, _SWAY), alone(scatter)
        within = float(data.attrs.get("duration", math.nan))
        detail = f"largest in {storm_words(within)}; " if math.isfinite(within) else ""
        detail += "; ".join(filter(None, (ALONE if bound else "", _motion_words(data, _SWAY), _slow_words(frequency))))
    elif "largest_offset" in data:
        value = float(data["largest_offset"])
        band = storms(value, abs(float(mean[0])), _peak_factor(data, 0))
        detail = _slow_words(data)
    else:
        return []
    if drift_left_out(data):
        bound, detail = "at least", "; ".join(filter(None, (detail, WITHOUT_DRIFT)))
    words = "; ".join(part for part in (f"mean {mean[0]:.3g} m", detail) if part)
    return [
        Headline("offset", "Largest offset in sway", value, "m", place(level, sea), model, band, bound, detail=words)
    ]


def _peak_factor(data: xr.Dataset, mode: int) -> float:
    """Return the most probable largest motion over its standard deviation; NaN in time, where it is not known."""
    if "most_probable_maximum_motion" not in data:
        return math.nan
    deviation = 0.25 * float(data.variables["significant_motion"].values[mode])
    return (
        float(data.variables["most_probable_maximum_motion"].values[mode]) / deviation if deviation > 0.0 else math.nan
    )


def _in_motion(data: xr.Dataset, mode: int) -> tuple[float, float] | None:
    """Return the largest motion in the events rerun, lines in motion and at rest; ``None`` without events."""
    if "event_offset" not in data:
        return None
    moving, still = (data.variables[name].values[mode] for name in ("event_offset", "event_offset_lines_at_rest"))
    return float(moving), float(still)


def _with_lines_in_motion(value: float, band: Band | None, data: xr.Dataset, mode: int) -> Band | None:
    """Return a band with what lines in motion add to a motion with lines at rest in the same events."""
    pair = _in_motion(data, mode)
    if pair is None or not pair[0] > pair[1]:
        return band
    return (band or Band(value, value, "lines in motion in the events rerun")).scaled(1.0, pair[0] / pair[1])


def _motion_words(data: xr.Dataset, mode: int) -> str:
    pair = _in_motion(data, mode)
    if pair is None:
        return ""
    moving, still = (f"{motion:.3g} m" if mode == _SWAY else f"{math.degrees(motion):.3g}\u00b0" for motion in pair)
    return f"in the events rerun with lines in motion {moving}, with lines at rest {still}"


def _motion_model(domain: str, data: xr.Dataset) -> str:
    """Return the model of motions in a sea; where events alone were rerun in motion, motions are of lines at rest."""
    if domain != "time":
        return FREQUENCY
    whole = "events_in_motion" not in data and "lines_in_motion" in data
    return IN_MOTION if whole and bool((data.variables["lines_in_motion"].values == 1.0).any()) else AT_REST


def _slow_words(frequency: xr.Dataset | None) -> str:
    """Say what rules the slow drift: period, damping, and what half and twice the damping do."""
    if frequency is None or "slow_motion_deviation" not in frequency:
        return ""
    slow = float(frequency.variables["slow_motion_deviation"].values[0])
    low = float(frequency["slow_sway_deviation_double_damping"])
    high = float(frequency["slow_sway_deviation_half_damping"])
    ratio, period = float(frequency["slow_sway_damping_ratio"]), float(frequency["slow_sway_period"])
    return (
        f"slow sway of {period:.3g} s, damping {100.0 * ratio:.2g} % of critical there, standard deviation "
        f"{slow:.2g} m ({low:.2g} to {high:.2g} m with twice and half the damping)"
    )


def _roll(domain: str, data: xr.Dataset, level: str, sea: str, frequency: xr.Dataset | None) -> list[Headline]:
    """Return the largest roll of a sea: mean over realisations, or the most probable one of the frequency domain."""
    name = "largest_offset_by_dof" if "largest_offset_by_dof" in data else "most_probable_maximum_motion"
    if name not in data or "significant_motion" not in data:
        return []
    value, significant = float(data.variables[name].values[2]), float(data.variables["significant_motion"].values[2])
    each = f"{name}_of_realisation"
    scatter = np.asarray(data.variables[each].values[:, 2], dtype=float) if each in data else np.zeros(0)
    band = seeds(scatter) if scatter.size else storms(value, 0.0, _peak_factor(data, _ROLL))
    band = _with_lines_in_motion(value, band, data, _ROLL)
    if frequency is not None and "significant_motion_low" in frequency:
        # the frequency domain gives by how much damping moves roll; the time domain is run at its nominal value
        own = float(frequency.variables["significant_motion"].values[2])
        low, high = (float(frequency.variables[f"significant_motion_{end}"].values[2]) / own for end in ("low", "high"))
        if math.isfinite(low + high):
            of = str(frequency.attrs.get("damping_band", "damping"))
            given = band or Band(value, value, "")
            of = "; ".join(filter(None, (given.of, of)))
            band = replace(given.scaled(low, high), of=of, decides=given.judged is None)
    double = f"significant double amplitude {math.degrees(significant):.3g}\u00b0"
    detail = "; ".join(filter(None, ("amplitude", _motion_words(data, _ROLL), double)))
    model = _motion_model(domain, data)
    return [
        Headline("roll", "Largest roll", value, "rad", place(level, sea), model, band, alone(scatter), detail=detail)
    ]


def _steady_offset(groups: Mapping[str, xr.Dataset], levels: list[str]) -> Headline | None:
    known = [
        (float(groups[f"/{level}/statics"]["steady_offset"].values[0]), level)
        for level in levels
        if "steady_offset" in groups.get(f"/{level}/statics", {})
    ]
    if not known:
        return None
    value, level = max(known, key=lambda item: abs(item[0]))
    return Headline("mean_offset", "Offset under wind and current", value, "m", level, STILL)


def _rest_headlines(groups: Mapping[str, xr.Dataset], levels: list[str]) -> list[Headline]:
    """Return freeboard, overtopping and stability at their worst water level."""
    out: list[Headline] = []
    statics = {level: groups[f"/{level}/statics"] for level in levels if f"/{level}/statics" in groups}
    if not statics:
        return out

    def least(name: str) -> tuple[float, str]:
        return min((float(data[name]), level) for level, data in statics.items())

    freeboard, level = least("freeboard")
    out.append(
        Headline("freeboard", "Freeboard", freeboard, "m", level, STILL,
                 detail=f"draught {float(statics[level]['draught']):.3g} m", without_waves=True)
    )  # fmt: skip
    shares = [
        (float(data["overtopping_share"]), place(name, sea))
        for name in levels
        for sea in seas_of(groups, name)
        if (data := groups.get(f"/{name}/frequency/{sea}")) is not None and "overtopping_share" in data
    ]
    if shares:
        share, where = max(shares)
        out.append(
            Headline("overtopping", "Waves that pass the deck edge", share, "1", where, FREQUENCY,
                     detail="estimate: incident wave, once or doubled as at a wall, against the moving deck edge; "
                            "radiated waves not counted")
        )  # fmt: skip
    height, level = least("metacentric_height")
    out.append(Headline("metacentric_height", "Metacentric height GM", height, "m", level, STILL, without_waves=True))
    return out


__all__ = ["LinePeak", "governing_group", "headlines", "line_peaks", "place", "seas_of"]
