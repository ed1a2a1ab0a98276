"""The numbers of the first page of a floating breakwater: which model governs each, its band, its place.

The hierarchy, from the one that governs down: time domain with lines in motion; time domain with lines at rest at every
instant, while the largest tension stays under five times the mean; frequency domain, first order and slow drift, in the
same range. What is out of its range never governs: the number is then said to be not known (docs/answer/breakwater.md).
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from moyai.core.headline import Band, Headline
from moyai.mooring.anchors import gravity_anchor_weight
from moyai.series.intervals import student_quantile
from moyai.structures.breakwater.responses import SNAP_RATIO
from moyai.tables.design_codes import anchor_factor, holding_data

if TYPE_CHECKING:
    import xarray as xr

Array = NDArray[np.float64]

IN_MOTION = "time domain, lines in motion"
AT_REST = "time domain, lines at rest at every instant"
FREQUENCY = "frequency domain, waves and slow drift"
FIRST_ORDER = "frequency domain, regular waves"
STILL = "at rest, no waves run"
MUCH_OVERTOPPING = 0.05  # share of waves over the deck from which linear transmission is qualified
SINKER = ("concrete", "sand")  # for which the weight of a sinker is shown


@dataclass(frozen=True)
class LinePeak:
    """Largest tension of one kind of line in one sea at one water level, by the model that governs there; SI units.

    ``known`` is false where the model is out of its range and no better one was run.
    """

    level: str
    sea: str
    line: str
    period: float
    tension: float
    mean: float
    breaking_load: float
    vertical: float
    horizontal: float
    grounded: float
    model: str
    known: bool
    scatter: Array
    vertical_scatter: Array
    horizontal_scatter: Array

    @property
    def utilisation(self) -> float:
        """Tension over breaking load, NaN where that is not given."""
        return self.tension / self.breaking_load if self.breaking_load > 0.0 else math.nan

    @property
    def rank(self) -> float:
        """What governs: utilisation, or tension where no breaking load is given."""
        return self.utilisation if math.isfinite(self.utilisation) else self.tension * 1e-12

    @property
    def where(self) -> str:
        """Water level, sea, period and line in words."""
        return f"{place(self.level, self.sea, self.period)}, line {self.line}"


def place(level: str, sea: str, period: float = math.nan) -> str:
    """Return water level, sea state and wave period in words."""
    return f"{level}, {sea}" + (f", T = {period:.3g} s" if math.isfinite(period) else "")


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
        found += _line_headlines(peaks) + _anchor_headlines(groups, levels, peaks)
    else:
        found += _lines_at_rest(groups, levels)
    found += _transmission(groups, levels) + _motion_headlines(groups, levels)
    return (*found, *_rest_headlines(groups, levels))


def seas_of(groups: Mapping[str, xr.Dataset], level: str) -> tuple[str, ...]:
    """Return the sea states that were run at a water level."""
    heads = (f"/{level}/frequency/", f"/{level}/time/")
    names = [path.removeprefix(head) for path in groups for head in heads if path.startswith(head)]
    return tuple(dict.fromkeys(name for name in names if "/" not in name))


def governing_group(groups: Mapping[str, xr.Dataset], level: str, sea: str) -> tuple[str, xr.Dataset] | None:
    """Return the domain and numbers that govern a sea: the time domain where it came to an end."""
    time, frequency = groups.get(f"/{level}/time/{sea}"), groups.get(f"/{level}/frequency/{sea}")
    if time is not None and time.attrs.get("status") == "converged" and "maximum_tension" in time:
        return "time", time
    return None if frequency is None else ("frequency", frequency)


def line_peaks(groups: Mapping[str, xr.Dataset], level: str) -> list[LinePeak]:
    """Return the largest tension of every kind of line in every sea at a water level."""
    found: list[LinePeak] = []
    statics = groups.get(f"/{level}/statics")
    for sea in seas_of(groups, level):
        chosen = governing_group(groups, level, sea)
        if chosen is None or statics is None or "breaking_load" not in statics or "maximum_tension" not in chosen[1]:
            continue
        domain, data = chosen
        for number, line in enumerate(data["line"].values):
            chain = bool(np.isfinite(statics["unstretched_length"].values[number]))
            load = float(statics["breaking_load"].values[number])
            peak = _line_peak(domain, data, level, sea, str(line), number, load, chain)
            if peak is not None:
                found.append(peak)
    return found


def _line_peak(
    domain: str, data: xr.Dataset, level: str, sea: str, line: str, number: int, load: float, chain: bool
) -> LinePeak | None:
    table = np.atleast_2d(data["maximum_tension"].values)[:, number]
    if not np.isfinite(table).any():
        return None
    row = int(np.nanargmax(table))

    def of(name: str) -> float:
        return float(np.atleast_2d(data[name].values)[row, number]) if name in data else math.nan

    regular = "period" in data.dims
    moving = of("lines_in_motion") == 1.0

    def scatter_of(name: str) -> Array:
        name = f"{name}_of_realisation"
        return np.asarray(data[name].values[:, number], dtype=float) if name in data else np.zeros(0)

    scatter = scatter_of("maximum_tension")
    model = (FIRST_ORDER if regular else FREQUENCY) if domain == "frequency" else (IN_MOTION if moving else AT_REST)
    mean = of("mean_tension")
    highest = float(np.nanmax(scatter)) if scatter.size else float(table[row])
    # A spring is linear at any tension; a chain at rest at every instant says nothing beyond the range
    known = moving or not chain or highest <= SNAP_RATIO * mean
    return LinePeak(
        level, sea, line, float(data["period"].values[row]) if regular else math.nan, float(table[row]), mean, load,
        of("maximum_anchor_vertical_tension"), of("maximum_anchor_horizontal_tension"), of("least_grounded_length"),
        model, known, scatter, scatter_of("maximum_anchor_vertical_tension"),
        scatter_of("maximum_anchor_horizontal_tension"),
    )  # fmt: skip


def _line_headlines(peaks: list[LinePeak]) -> list[Headline]:
    highest = max(peaks, key=lambda peak: peak.rank)
    if not highest.known:
        ratio = highest.tension / highest.mean if highest.mean > 0.0 else math.inf
        detail = (
            f"lines at rest give {_kilonewton(highest.tension)}, {ratio:.1f} times the mean, beyond their range of "
            f"{SNAP_RATIO:g}; run the time domain with lines in motion"
        )
        return [
            Headline(name, label, math.nan, unit, highest.where, highest.model, detail=detail, text="not known")
            for name, label, unit in (
                ("line_tension", "Largest line tension", "N"),
                ("line_utilisation", "Utilisation of the breaking load", "1"),
            )
        ]
    tension = Headline(
        "line_tension", "Largest line tension", highest.tension, "N", highest.where, highest.model,
        band=_seeds(highest.scatter), detail=_mean_of(highest.scatter),
    )  # fmt: skip
    load = highest.breaking_load
    if not load > 0.0:
        return [
            tension,
            Headline("line_utilisation", "Utilisation of the breaking load", math.nan, "1", highest.where,
                     highest.model, detail="breaking load not given in the case"),
        ]  # fmt: skip
    share = Headline(
        "line_utilisation", "Utilisation of the breaking load", highest.utilisation, "1", highest.where, highest.model,
        band=_seeds(highest.scatter / load),
        detail=f"breaking load {_kilonewton(load)}",
    )  # fmt: skip
    return [tension, share]


def _anchor_headlines(groups: Mapping[str, xr.Dataset], levels: list[str], peaks: list[LinePeak]) -> list[Headline]:
    """Return what an anchor must hold: of the line that pulls hardest, and the uplift wherever it is highest."""
    pulled = [peak for peak in peaks if math.isfinite(peak.horizontal)]
    if not pulled:
        return []
    bare = _bare_lines(groups, levels)
    lifted = max(pulled, key=lambda peak: peak.vertical)
    hardest = max(pulled, key=lambda peak: peak.horizontal + max(peak.vertical, 0.0))
    if not (hardest.known and lifted.known):
        text = "not known"
        detail = "the largest tension is not known"
        return [
            Headline(name, label, math.nan, "N", hardest.where, hardest.model, detail=detail, text=text)
            for name, label in (
                ("anchor_capacity_required", "Holding capacity that an anchor needs"),
                ("anchor_uplift", "Uplift at an anchor"),
            )
        ]
    drag, level_factor = anchor_factor("drag_anchor", "horizontal"), anchor_factor("gravity_anchor", "horizontal")
    up_factor, friction = anchor_factor("gravity_anchor", "vertical"), holding_data("sinker", *SINKER)
    weight = gravity_anchor_weight(
        hardest.horizontal, hardest.vertical, friction.value, level_factor.value, up_factor.value
    )
    lies = hardest.grounded > 0.0 and hardest.vertical <= 0.0
    bed = f"{hardest.grounded:.3g} m of line left on the bed" if lies else "no line left on the bed"
    fit = "" if hardest.vertical <= 0.0 else ": not for a drag anchor"
    capacity = Headline(
        "anchor_capacity_required", "Horizontal holding capacity that an anchor needs",
        drag.value * hardest.horizontal, "N", hardest.where, hardest.model,
        band=_seeds(drag.value * hardest.horizontal_scatter),
        detail=(
            f"{drag.value:g} times the pull of one line ({drag.source}, {_confirmed(drag.confirmed)}); {bed} at the "
            f"peak{fit}; or a concrete sinker of {_kilonewton(weight)} in water (friction {friction.value:g} on "
            f"{SINKER[1]}, factors {level_factor.value:g} and {up_factor.value:g})"
        ),
    )  # fmt: skip
    pull = Headline(
        "anchor_horizontal_load", "Horizontal pull on an anchor", hardest.horizontal, "N", hardest.where, hardest.model,
        band=_seeds(hardest.horizontal_scatter),
    )  # fmt: skip
    none = lifted.vertical <= 0.0
    least = min(peak.grounded for peak in pulled)
    kept = f"{least:.3g} m of line stays on the bed" if least > 0.0 else "the line leaves the bed"
    said = "; ".join(part for part in (kept if none else "", bare) if part)
    uplift = Headline(
        "anchor_uplift", "Uplift at an anchor", max(lifted.vertical, 0.0), "N", lifted.where, lifted.model,
        band=None if none else _seeds(np.maximum(lifted.vertical_scatter, 0.0)), detail=said,
        text="none" if none else "",
    )  # fmt: skip
    return [capacity, pull, uplift]


def _bare_lines(groups: Mapping[str, xr.Dataset], levels: list[str]) -> str:
    """Say which lines have nothing on the bed at rest."""
    found = []
    for level in levels:
        statics = groups.get(f"/{level}/statics")
        if statics is None or "grounded_length" not in statics:
            continue
        chains = np.isfinite(statics["unstretched_length"].values)
        if bool(np.any((statics["grounded_length"].values <= 0.0) & chains)):
            found.append(level)
    return f"no line on the bed at rest at {', '.join(found)}" if found else ""


def _lines_at_rest(groups: Mapping[str, xr.Dataset], levels: list[str]) -> list[Headline]:
    best: tuple[float, str, float] | None = None
    for level in levels:
        statics = groups.get(f"/{level}/statics")
        if statics is None or "fairlead_tension" not in statics or not statics["fairlead_tension"].size:
            continue
        pulls = statics["fairlead_tension"].values
        at = int(np.nanargmax(pulls))
        if best is None or pulls[at] > best[0]:
            best = float(pulls[at]), f"{level}, line {statics['line'].values[at]}", float(statics.breaking_load[at])
    if best is None:
        return []
    out = [Headline("line_tension", "Line tension at rest", best[0], "N", best[1], STILL)]
    if best[2] > 0.0:
        out.append(Headline("line_utilisation", "Utilisation of the breaking load at rest", best[0] / best[2], "1",
                            best[1], STILL, detail=f"breaking load {_kilonewton(best[2])}"))  # fmt: skip
    return out


def _transmission(groups: Mapping[str, xr.Dataset], levels: list[str]) -> list[Headline]:
    """Return the largest transmission: of irregular seas where there are any, by the consistent frequency domain."""
    rows: list[tuple[bool, float, str, xr.Dataset, int | None, float]] = []
    for level in levels:
        for sea in seas_of(groups, level):
            data = groups.get(f"/{level}/frequency/{sea}")
            if data is None or "transmission_coefficient" not in data:
                continue
            values = np.atleast_1d(data["transmission_coefficient"].values)
            if not np.isfinite(values).any():
                continue
            row = int(np.nanargmax(values))
            regular = "period" in data.dims
            period = float(data["period"].values[row]) if regular else math.nan
            time = groups.get(f"/{level}/time/{sea}")
            other = math.nan
            if time is not None and "transmission_coefficient" in time and not regular:
                other = float(time["transmission_coefficient"])
            rows.append(
                (not regular, float(values[row]), place(level, sea, period), data, row if regular else None, other)
            )
    if not rows:
        return []
    irregular, value, where, data, at, other = max(rows, key=lambda item: item[:2])
    detail = "energy-weighted" if irregular else "largest over the periods"
    if math.isfinite(other):
        detail += f"; {other:.3g} with the motions of the time domain"
    highest = max(rows, key=lambda item: item[1])
    if highest[1] > value:
        detail += f"; up to {highest[1]:.3g} in regular waves: {highest[2]}"
    if "overtopping_share" in data and (over := float(data["overtopping_share"])) > MUCH_OVERTOPPING:
        detail += f"; without the water that up to {100.0 * over:.0f} % of the waves bring over the deck"
    return [
        Headline("transmission", "Wave transmission K_T", value, "1", where,
                 FREQUENCY if irregular else FIRST_ORDER, band=_damping_band(data, at), detail=detail)
    ]  # fmt: skip


def _damping_band(data: xr.Dataset, row: int | None) -> Band | None:
    """Return how far the transmission moves over what is uncertain in damping, where the sea carries it."""
    if "transmission_coefficient_low" not in data or "transmission_coefficient_high" not in data:
        return None
    ends = [data[f"transmission_coefficient_{end}"].values for end in ("low", "high")]
    low, high = (float(item if row is None else item[row]) for item in ends)
    return Band(low, high, str(data.attrs.get("damping_band", "damping"))) if math.isfinite(low + high) else None


def _motion_headlines(groups: Mapping[str, xr.Dataset], levels: list[str]) -> list[Headline]:
    """Return the largest sway from rest and the significant roll."""
    offsets: list[Headline] = []
    rolls: list[Headline] = []
    for level in levels:
        for sea in seas_of(groups, level):
            chosen = governing_group(groups, level, sea)
            if chosen is not None:
                offsets += _offset(*chosen, level, sea, groups.get(f"/{level}/frequency/{sea}"))
                rolls += _roll(*chosen, level, sea, groups.get(f"/{level}/frequency/{sea}"))
    found = [max(items, key=lambda item: abs(item.value)) for items in (offsets, rolls) if items]
    if not found and (rest := _steady_offset(groups, levels)) is not None:
        found = [rest]
    return found


def _offset(domain: str, data: xr.Dataset, level: str, sea: str, frequency: xr.Dataset | None) -> list[Headline]:
    mean = np.atleast_2d(data["mean_offset"].values)[:, 0] if "mean_offset" in data else np.array([math.nan])
    model = AT_REST if domain == "time" else FREQUENCY
    band, period, detail = None, math.nan, ""
    if "maximum_excursion" in data:
        value, row = float(data["maximum_excursion"].values[0]), 0
        scatter = np.asarray(data["maximum_excursion_of_realisation"].values[:, 0], dtype=float)
        band = _seeds(scatter)
        detail = _slow_words(frequency)
    elif "largest_offset" in data:
        value, row = float(data["largest_offset"]), 0
        detail = _slow_words(data)
    elif "period" in data.dims:
        if domain == "time" and "maximum_motion" in data:
            table = data["maximum_motion"].values[:, 0]
        else:
            table, model = np.abs(mean) + data["motion_amplitude"].values[:, 0], FIRST_ORDER
        if not np.isfinite(table).any():
            return []
        row = int(np.nanargmax(table))
        value, period = float(table[row]), float(data["period"].values[row])
    else:
        return []
    words = "; ".join(part for part in (f"mean {mean[min(row, len(mean) - 1)]:.3g} m", detail) if part)
    return [
        Headline("offset", "Largest offset in sway", value, "m", place(level, sea, period), model, band, detail=words)
    ]


def _slow_words(frequency: xr.Dataset | None) -> str:
    """Say what rules the slow drift: period, damping, and what half and twice the damping do."""
    if frequency is None or "slow_motion_deviation" not in frequency:
        return ""
    slow = float(frequency["slow_motion_deviation"].values[0])
    low = float(frequency["slow_sway_deviation_double_damping"])
    high = float(frequency["slow_sway_deviation_half_damping"])
    ratio, period = float(frequency["slow_sway_damping_ratio"]), float(frequency["slow_sway_period"])
    return (
        f"slow sway of {period:.3g} s, damping {100.0 * ratio:.2g} % of critical there, standard deviation "
        f"{slow:.2g} m ({low:.2g} to {high:.2g} m with twice and half the damping)"
    )


def _roll(domain: str, data: xr.Dataset, level: str, sea: str, frequency: xr.Dataset | None) -> list[Headline]:
    band = None
    model = AT_REST if domain == "time" else FREQUENCY
    if "significant_motion" in data:
        value = float(data["significant_motion"].values[2])
        label, period = "Significant roll (double amplitude)", math.nan
        if frequency is not None and "significant_motion_low" in frequency:
            # the frequency domain tells by how much damping moves roll; the time domain is run at its nominal value
            ratio = value / float(frequency["significant_motion"].values[2])
            low, high = (ratio * float(frequency[f"significant_motion_{end}"].values[2]) for end in ("low", "high"))
            if math.isfinite(low + high):
                band = Band(low, high, str(frequency.attrs.get("damping_band", "damping")))
    elif "motion_amplitude" in data and np.isfinite(data["motion_amplitude"].values[:, 2]).any():
        table = data["motion_amplitude"].values[:, 2]
        row = int(np.nanargmax(table))
        value, label, period = float(table[row]), "Roll amplitude", float(data["period"].values[row])
    else:
        return []
    return [Headline("roll", label, value, "rad", place(level, sea, period), model, band)]


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
                 detail=f"draught {float(statics[level]['draught']):.3g} m")
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
            Headline("overtopping", "Waves that pass the deck edge", share, "1", where, FREQUENCY, bound="at most",
                     detail="incident wave doubled, as at a wall")
        )  # fmt: skip
    height, level = least("metacentric_height")
    out.append(Headline("metacentric_height", "Metacentric height GM", height, "m", level, STILL))
    return out


def _seeds(scatter: Array) -> Band | None:
    """Return the band of realisations: they scatter about their mean, which is the number.

    Criteria are judged at the end of the one-sided 95 % interval of that mean (Student), since few realisations leave
    it uncertain.
    """
    if scatter.size < 2 or not np.isfinite(scatter).all():
        return None
    mean, reach = float(scatter.mean()), student_quantile(0.9, scatter.size - 1) * _standard_error(scatter)
    of = f"{scatter.size} realisations; criteria at the 95 % end of their mean"
    ends = (mean - reach, mean + reach)
    return Band(float(scatter.min()), float(scatter.max()), of, decides=False, judged=ends)


def _standard_error(scatter: Array) -> float:
    return float(np.std(scatter, ddof=1)) / math.sqrt(scatter.size)


def _mean_of(scatter: Array) -> str:
    if scatter.size < 2:
        return ""
    share = 100.0 * _standard_error(scatter) / float(scatter.mean())
    return f"mean of the largest of {scatter.size} realisations, its standard error {share:.2g} %"


def _kilonewton(force: float) -> str:
    if abs(force) < 1e3:
        return f"{force:.3g} N"
    return f"{1e-3 * force:.0f} kN" if abs(force) >= 1e5 else f"{1e-3 * force:.3g} kN"


def _confirmed(value: bool) -> str:
    return "confirmed" if value else "not confirmed against it"


__all__ = ["LinePeak", "governing_group", "headlines", "line_peaks", "place", "seas_of"]
