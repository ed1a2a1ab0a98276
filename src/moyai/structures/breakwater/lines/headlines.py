"""The numbers of the first page that lines and anchors give: what governs, what is not known, what they need."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from moyai.core.arrays import Array
from moyai.core.headline import Band, Bound, Headline, all_judged, saying_what_is_open, unfavourable
from moyai.core.wording import kilonewton
from moyai.design.anchor_needs import anchor_need, judged_end, sinker_weight
from moyai.series.intervals import student_quantile
from moyai.series.realisations import ALONE, alone, seeds, storm_ends, storms
from moyai.structures.breakwater.responses import SNAP_RATIO
from moyai.structures.breakwater.time.lines import TWICE_THE_BARS

if TYPE_CHECKING:
    import xarray as xr


IN_MOTION = "time domain, lines in motion"
AT_REST = "time domain, lines at rest at every instant"
FREQUENCY = "frequency domain, waves and slow drift"
FIRST_ORDER = "frequency domain, regular waves"
STILL = "at rest, no waves run"
#: What is said of a line whose tension is known and whose strength is not, next to lines that have one.
NO_STRENGTH = "breaking load not given of"
#: Label and unit of the numbers of a line.
_LINE_NUMBERS = {
    "line_tension": ("Largest line tension", "N"),
    "line_utilisation": ("Utilisation of the breaking load", "1"),
}
STORM_DURATION = 10800.0  # [s], for which the largest values of a sea state are usually asked


@dataclass(frozen=True)
class LinePeak:
    """Largest tension of one kind of line in one sea at one water level, by the model that governs there; SI units.

    ``known`` is false where the model is out of its range and no better one was run. ``bound`` is what the reruns of
    events leave open in each realisation (the largest tension itself where they leave nothing open).
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
    bound: Array
    duration: float = math.nan
    #: Whether the slow drift of an irregular sea is not in it.
    without_drift: bool = False
    #: Most probable largest over standard deviation of a tension of the frequency domain; NaN in time.
    factor: float = math.nan
    #: Uplift and horizontal pull at the ends of storms alike, of the frequency domain; empty in time.
    vertical_of_storms: Array = field(default_factory=lambda: np.zeros(0))
    horizontal_of_storms: Array = field(default_factory=lambda: np.zeros(0))
    #: Change of the tension with twice the bars, of lines in motion that go slack; NaN where there is none.
    finer: float = math.nan
    #: Whether it is a line of segments, which has a strength; a spring has none.
    chain: bool = True

    def band(self, value: float, scatter: Array, bound: Array | None = None, mean: float = 0.0) -> Band | None:
        """Return the band of a number of this line: of realisations, in the frequency domain of storms alike."""
        return self._on_finer(seeds(scatter, bound) if scatter.size else storms(value, mean, self.factor), value)

    def _on_finer(self, band: Band | None, value: float) -> Band | None:
        """Return a band that reaches as far as shorter bars move the tension, either way it goes."""
        if math.isnan(self.finer) or self.finer == 0.0:
            return band
        band = band or Band(value, value, "", decides=False, judged=(value, value))
        words = f"twice the bars change it by {100.0 * self.finer:+.2g} %, and their change extrapolated"
        # of bars that are halved again and again each changes half as much as the one before
        less, more = 1.0 + 2.0 * min(self.finer, 0.0), 1.0 + 2.0 * max(self.finer, 0.0)
        return replace(band.scaled(max(less, 0.0), more), of="; ".join(filter(None, (band.of, words))))

    @property
    def pull_band(self) -> Band | None:
        """The band of the horizontal pull on the anchor."""
        found = self._on_finer(seeds(self.horizontal_scatter), self.horizontal)
        return found or storm_ends(self.horizontal, self.horizontal_of_storms)

    @property
    def uplift_band(self) -> Band | None:
        """The band of the uplift, which may begin at the tension at which the line is judged."""
        found = self._on_finer(seeds(np.maximum(self.vertical_scatter, 0.0)), max(self.vertical, 0.0))
        found = found or storm_ends(max(self.vertical, 0.0), np.maximum(self.vertical_of_storms, 0.0))
        return found if found is not None and found.high > 0.0 else None

    @property
    def judged_uplift(self) -> float:
        """Uplift that an anchor is bought for [N]."""
        return judged_end(self.vertical, self.uplift_band)

    @property
    def proves(self) -> Bound:
        """``at least`` where one realisation, or a sea without its slow drift, leaves the number open upwards."""
        return "at least" if self.without_drift else alone(self.scatter)

    @property
    def analysis(self) -> str:
        """What design codes call the analysis."""
        return "dynamic" if self.model == IN_MOTION else "quasi_static"

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


def seas_of(groups: Mapping[str, xr.Dataset], level: str) -> tuple[str, ...]:
    """Return the sea states that were run at a water level."""
    heads = (f"/{level}/frequency/", f"/{level}/time/")
    names = [path.removeprefix(head) for path in groups for head in heads if path.startswith(head)]
    return tuple(dict.fromkeys(name for name in names if "/" not in name))


def governing_group(groups: Mapping[str, xr.Dataset], level: str, sea: str) -> tuple[str, xr.Dataset] | None:
    """Return the domain and numbers that govern a sea: the time domain where it came to an end."""
    time, frequency = groups.get(f"/{level}/time/{sea}"), groups.get(f"/{level}/frequency/{sea}")
    if time is not None and time.attrs.get("status") == "converged" and "line_tension_maximum" in time:
        return "time", time
    return None if frequency is None else ("frequency", frequency)


#: What is said of a number of an irregular sea without its slow drift.
WITHOUT_DRIFT = "the slow drift of the sea is not in it and adds to it, on chains several times over"


def drift_left_out(data: xr.Dataset) -> bool:
    """Return whether a group of an irregular sea was computed without its slow drift."""
    return "period" not in data.dims and str(data.attrs.get("drift", "newman")) != "newman"


def line_peaks(groups: Mapping[str, xr.Dataset], level: str) -> list[LinePeak]:
    """Return the largest tension of every kind of line at a water level, in every sea, of every regular wave."""
    found: list[LinePeak] = []
    statics = groups.get(f"/{level}/statics")
    for sea in seas_of(groups, level):
        chosen = governing_group(groups, level, sea)
        if (
            chosen is None
            or statics is None
            or "breaking_load" not in statics
            or "line_tension_maximum" not in chosen[1]
        ):
            continue
        domain, data = chosen
        for number, line in enumerate(data.variables["line"].values):
            chain = bool(np.isfinite(statics.variables["unstretched_length"].values[number]))
            load = float(statics.variables["breaking_load"].values[number])
            table = np.atleast_2d(data.variables["line_tension_maximum"].values)[:, number]
            found += [
                _line_peak(domain, data, (level, sea, str(line)), (int(row), number), load, chain)
                for row in np.flatnonzero(np.isfinite(table))
            ]
    return found


def _line_peak(
    domain: str, data: xr.Dataset, names: tuple[str, str, str], at: tuple[int, int], load: float, chain: bool
) -> LinePeak:
    """Return a peak: ``names`` are level, sea and line, ``at`` the row of the period and the number of the line."""
    (level, sea, line), (row, number) = names, at

    def of(name: str) -> float:
        return float(np.atleast_2d(data.variables[name].values)[row, number]) if name in data else math.nan

    regular = "period" in data.dims
    moving = of("lines_in_motion") == 1.0

    def scatter_of(name: str) -> Array:
        name = f"{name}_of_realisation"
        return np.asarray(data.variables[name].values[:, number], dtype=float) if name in data else np.zeros(0)

    def ends_of(side: str) -> Array:
        name = f"anchor_{side}_tension_of_storms"
        return np.asarray(data.variables[name].values[number], dtype=float) if name in data else np.full(3, np.nan)

    scatter = scatter_of("line_tension_maximum")
    model = (FIRST_ORDER if regular else FREQUENCY) if domain == "frequency" else (IN_MOTION if moving else AT_REST)
    mean = of("line_tension_mean")
    deviation = 0.25 * of("significant_tension")
    factor = (of("most_probable_maximum_tension") - mean) / deviation if deviation > 0.0 else math.nan
    tension = of("line_tension_maximum")
    highest = float(np.nanmax(scatter)) if scatter.size else tension
    # A spring is linear at any tension; a chain at rest at every instant says nothing beyond the range
    known = moving or not chain or highest <= SNAP_RATIO * mean
    period = float(data.variables["period"].values[row]) if regular else math.nan
    return LinePeak(
        level, sea, line, period, tension, mean, load,
        of("anchor_vertical_tension_maximum"), of("anchor_horizontal_tension_maximum"), of("least_grounded_length"),
        model, known, scatter, scatter_of("anchor_vertical_tension_maximum"),
        scatter_of("anchor_horizontal_tension_maximum"),
        scatter_of("line_tension_bound") if moving else scatter, float(data.attrs.get("duration", math.nan)),
        drift_left_out(data), factor, ends_of("vertical"), ends_of("horizontal"), of(TWICE_THE_BARS), chain,
    )  # fmt: skip


def line_headlines(peaks: list[LinePeak]) -> list[Headline]:
    """Return the largest tension and its share of the breaking load, and what else is judged of lines.

    Where the highest is not known it stands on the page; the others are judged, as one of them may break a limit.
    """
    highest = max(peaks, key=lambda peak: peak.rank)
    also = _other_level(highest, peaks)
    known = [peak for peak in peaks if peak.known]
    tensions = saying_what_is_open(all_judged(_tension(peak, also if peak is highest else "") for peak in known))
    # Codes ask another factor of each analysis: the highest of the other one is judged too
    strong = [peak for peak in known if peak.breaking_load > 0.0]
    same = all_judged(_utilisation(peak) for peak in strong if peak.analysis == highest.analysis)
    others = all_judged(_utilisation(peak) for peak in strong if peak.analysis != highest.analysis)
    hidden = [replace(item, shown=False) for item in others]
    shown: list[Headline] = []
    if not highest.known:
        shown = [
            _line_number(name, highest, detail=_beyond(highest), text="not known", analysis=highest.analysis)
            for name in _LINE_NUMBERS
        ]
        hidden = [replace(item, shown=False) for item in (*tensions, *same, *others)]
        tensions, same = [], []
    elif not highest.breaking_load > 0.0:
        shown = [_line_number("line_utilisation", highest, detail="breaking load not given in the case")]
    unknown = [
        _line_number(name, peak, text=f"{peak.where}: not known, {_beyond(peak)}", shown=False, analysis=peak.analysis)
        for peak in _farthest_beyond(peaks)
        for name in _LINE_NUMBERS
        if highest.known or (peak.level, peak.sea, peak.line) != (highest.level, highest.sea, highest.line)
    ]
    bare = ", ".join(dict.fromkeys(peak.line for peak in peaks if peak.chain and not peak.breaking_load > 0.0))
    if bare and strong:
        text = f"{NO_STRENGTH} {bare}"
        unknown.append(replace(_line_number("line_utilisation", highest, text=text, shown=False), where="", model=""))
    return [*tensions, *same, *shown, *hidden, *unknown]


def _line_number(name: str, peak: LinePeak, **words: Any) -> Headline:
    """Return a number of a line that is not known, with what is said of it."""
    label, unit = _LINE_NUMBERS[name]
    return Headline(name, label, math.nan, unit, peak.where, peak.model, **words)


def _tension(peak: LinePeak, also: str) -> Headline:
    chance = _mean_of(peak.scatter, peak.duration)
    left_out = WITHOUT_DRIFT if peak.without_drift else ""
    return Headline(
        "line_tension", "Largest line tension", peak.tension, "N", peak.where, peak.model,
        band=peak.band(peak.tension, peak.scatter, peak.bound, peak.mean), bound=peak.proves,
        detail="; ".join(filter(None, (chance, left_out, _open(peak), also))), analysis=peak.analysis,
    )  # fmt: skip


def _farthest_beyond(peaks: list[LinePeak]) -> list[LinePeak]:
    """Return of every line in every sea the period that is farthest beyond its range, of those that are not known."""
    found: dict[tuple[str, str, str], LinePeak] = {}
    for peak in sorted((one for one in peaks if not one.known), key=lambda one: one.tension / max(one.mean, 1e-300)):
        found[peak.level, peak.sea, peak.line] = peak
    return list(found.values())


def _utilisation(peak: LinePeak) -> Headline:
    load = peak.breaking_load
    return Headline(
        "line_utilisation", "Utilisation of the breaking load", peak.utilisation, "1", peak.where, peak.model,
        band=peak.band(peak.utilisation, peak.scatter / load, peak.bound / load, peak.mean / load), bound=peak.proves,
        detail=f"breaking load {kilonewton(load)}, no corrosion or wear taken off", mean=peak.mean / load,
        analysis=peak.analysis,
    )  # fmt: skip


def _beyond(peak: LinePeak) -> str:
    ratio = peak.tension / peak.mean if peak.mean > 0.0 else math.inf
    if ratio < SNAP_RATIO and peak.scatter.size > 1:
        most = float(peak.scatter.max()) / peak.mean
        return (
            f"lines at rest give {kilonewton(peak.tension)}, {ratio:.1f} times the mean, in one realisation "
            f"{most:.1f} times, beyond their range of {SNAP_RATIO:g}; run the time domain with lines in motion"
        )
    return (
        f"lines at rest give {kilonewton(peak.tension)}, {ratio:.1f} times the mean, beyond their range of "
        f"{SNAP_RATIO:g}; run the time domain with lines in motion"
    )


def _open(peak: LinePeak) -> str:
    """Say what the reruns of events leave open."""
    if not peak.bound.size:
        return ""
    raised = kilonewton(float(peak.bound.mean()))
    if raised == kilonewton(float(peak.scatter.mean())):
        return ""
    return f"events that were not rerun could raise the mean to {raised}; judged at the end of the interval round that"


def _other_level(highest: LinePeak, peaks: list[LinePeak]) -> str:
    """Say which water levels give the same within the scatter of the realisations."""
    if highest.scatter.size < 2:
        return ""
    alike: dict[str, float] = {}
    for peak in peaks:
        if peak.level == highest.level or peak.sea != highest.sea or peak.scatter.size < 2 or not peak.known:
            continue
        # the skewness of both goes out of their difference
        spread = math.hypot(
            *(student_quantile(0.9, one.size - 1) * _standard_error(one) for one in (highest.scatter, peak.scatter))
        )
        if highest.tension - peak.tension < spread:
            alike[peak.level] = max(peak.tension, alike.get(peak.level, 0.0))
    if not alike:
        return ""
    words = ", ".join(f"{level} ({kilonewton(value)})" for level, value in alike.items())
    return f"not distinguished from {words} by so few realisations"


def anchor_headlines(groups: Mapping[str, xr.Dataset], levels: list[str], peaks: list[LinePeak]) -> list[Headline]:
    """Return what an anchor must hold: of the line that pulls hardest, and the uplift wherever it is highest.

    Where one of them is not known the others are judged all the same.
    """
    pulled = [peak for peak in peaks if math.isfinite(peak.horizontal)]
    if not pulled:
        return []
    known = [peak for peak in pulled if peak.known]
    # where no anchor is lifted, the line that leaves least on the bed comes nearest to it
    lifted = max(pulled, key=lambda peak: (max(peak.vertical, 0.0), peak.judged_uplift, -peak.grounded))
    hardest = max(pulled, key=lambda peak: peak.horizontal + max(peak.vertical, 0.0))
    pulls = saying_what_is_open(all_judged(_pull(peak) for peak in known))
    lifts = [_uplift(peak) for peak in known if peak is not lifted]
    if not (hardest.known and lifted.known):
        worst = lifted if hardest.known else hardest
        shown = [
            Headline(name, label, math.nan, "N", worst.where, worst.model, detail="the largest tension is not known",
                     text="not known")
            for name, label in (
                ("anchor_capacity_required", "Holding capacity that an anchor needs"),
                ("anchor_vertical_tension", "Uplift at an anchor"),
            )
        ]  # fmt: skip
        hidden = [replace(item, shown=False) for item in (*pulls, *all_judged(map(_uplift, known)))]
        return [*shown, *hidden, *_unknown_anchors(pulled, worst)]
    # a sinker is bought for the end at which criteria are judged, not for the mean of a few realisations
    weight, heaviest = max(((_sinker(peak), peak) for peak in known), key=lambda pair: pair[0])
    needed = all_judged(_capacity(peak, weight, heaviest, len(known) < len(pulled)) for peak in known)
    capacities = saying_what_is_open(needed)
    none = lifted.judged_uplift <= 0.0
    least = min(peak.grounded for peak in pulled)
    kept = f"{least:.3g} m of line stays on the bed" if least > 0.0 else "the line leaves the bed"
    said = "; ".join(part for part in (kept if none else "", _bare_lines(groups, levels)) if part)
    uplift = replace(_uplift(lifted), detail=said)
    others = [
        replace(item, shown=False)
        for item in all_judged(lifts)
        if unfavourable(item) > unfavourable(uplift) or item.bound != uplift.bound
    ]
    return [*capacities, *pulls, uplift, *others, *_unknown_anchors(pulled, None)]


def _pull(peak: LinePeak) -> Headline:
    return Headline(
        "anchor_horizontal_tension", "Horizontal pull on an anchor", peak.horizontal, "N", peak.where, peak.model,
        band=peak.pull_band, bound=peak.proves,
    )  # fmt: skip


def _uplift(peak: LinePeak) -> Headline:
    none = peak.judged_uplift <= 0.0
    return Headline(
        "anchor_vertical_tension", "Uplift at an anchor", max(peak.vertical, 0.0), "N", peak.where, peak.model,
        band=None if none else peak.uplift_band,
        text="none" if none else "", bound=peak.proves,
    )  # fmt: skip


def _unknown_anchors(pulled: list[LinePeak], shown: LinePeak | None) -> list[Headline]:
    """Return, not shown, the loads of anchors that are not known, without the uplift of the line that is shown."""
    names = {
        "anchor_vertical_tension": "Uplift at an anchor",
        "anchor_horizontal_tension": "Horizontal pull on an anchor",
    }
    own = None if shown is None else (shown.level, shown.sea, shown.line)
    return [
        Headline(name, label, math.nan, "N", peak.where, peak.model, text=f"{peak.where}: not known, {_beyond(peak)}",
                 shown=False)
        for peak in _farthest_beyond(pulled)
        for name, label in names.items()
        if name != "anchor_vertical_tension" or (peak.level, peak.sea, peak.line) != own
    ]  # fmt: skip


def _capacity(peak: LinePeak, weight: float, heaviest: LinePeak, more: bool) -> Headline:
    """Return the holding capacity that the anchor of a line needs; ``more`` where another one is not known."""
    need = anchor_need(peak.judged_uplift, peak.grounded, weight, "" if heaviest.line == peak.line else heaviest.line)
    value = need.factor * peak.horizontal
    return Headline(
        "anchor_capacity_required", "Horizontal holding capacity that an anchor needs", value, "N",
        f"{peak.where}, {need.factor:g} times its pull", peak.model,
        band=None if peak.pull_band is None else peak.pull_band.scaled(need.factor),
        bound="at least" if more else peak.proves,
        detail=need.words,
    )  # fmt: skip


def _sinker(peak: LinePeak) -> float:
    return sinker_weight(judged_end(peak.horizontal, peak.pull_band), peak.judged_uplift)


def _bare_lines(groups: Mapping[str, xr.Dataset], levels: list[str]) -> str:
    """Say which lines have nothing on the bed at rest."""
    found = []
    for level in levels:
        statics = groups.get(f"/{level}/statics")
        if statics is None or "grounded_length" not in statics:
            continue
        chains = np.isfinite(statics.variables["unstretched_length"].values)
        if bool(np.any((statics.variables["grounded_length"].values <= 0.0) & chains)):
            found.append(level)
    return f"no line on the bed at rest at {', '.join(found)}" if found else ""


def tension_at_rest(groups: Mapping[str, xr.Dataset], levels: list[str]) -> list[Headline]:
    best: tuple[float, str, float] | None = None
    for level in levels:
        statics = groups.get(f"/{level}/statics")
        if statics is None or "fairlead_tension" not in statics or not statics["fairlead_tension"].size:
            continue
        pulls = statics.variables["fairlead_tension"].values
        at = int(np.nanargmax(pulls))
        if best is None or pulls[at] > best[0]:
            best = float(pulls[at]), f"{level}, line {statics['line'].values[at]}", float(statics.breaking_load[at])
    if best is None:
        return []
    out = [Headline("line_tension", "Line tension at rest", best[0], "N", best[1], STILL)]
    if best[2] > 0.0:
        out.append(Headline("line_utilisation", "Utilisation of the breaking load at rest", best[0] / best[2], "1",
                            best[1], STILL, detail=f"breaking load {kilonewton(best[2])}"))  # fmt: skip
    return out


def _standard_error(scatter: Array) -> float:
    return float(np.std(scatter, ddof=1)) / math.sqrt(scatter.size)


def _mean_of(scatter: Array, duration: float) -> str:
    if scatter.size < 2:
        return ALONE if scatter.size else ""
    share = 100.0 * _standard_error(scatter) / float(scatter.mean())
    within = f" in {storm_words(duration)}" if math.isfinite(duration) else ""
    return f"mean of the largest{within} of {scatter.size} realisations, its standard error {share:.2g} %"


def storm_words(duration: float) -> str:
    """Return the duration [s] that a largest value belongs to, with a word where it is short for a storm."""
    hours = duration >= 3600.0
    text = f"{duration / 3600.0:.3g} h" if hours else f"{duration / 60.0:.3g} min"
    return text if duration >= STORM_DURATION else f"{text} (a storm of {STORM_DURATION / 3600.0:g} h has higher ones)"
