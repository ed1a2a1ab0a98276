"""The numbers of the first page of a curtain, each from the model that governs it, the most used component first."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from moyai.core.headline import Band, Bound, Criterion, Headline, also_judged, judge, saying_what_is_open, unfavourable
from moyai.structures.curtain.analyses.event_peaks import (
    COMPONENTS,
    ceiling_of,
    event_band,
    open_events,
    reach_of_periods,
)
from moyai.structures.curtain.governing import WEAKER, model_of
from moyai.structures.curtain.hierarchy import CYCLES, SPAN, STATICS
from moyai.structures.curtain.limit_headlines import REMEDY, limit_headlines
from moyai.structures.curtain.seas.anchor_energy import ENERGY_FACTORS
from moyai.structures.curtain.seas.cycles_of_sea import SeaCycles
from moyai.structures.curtain.steady_headlines import (
    Groups,
    at_rest,
    depth_headlines,
    kilo,
    statics_band,
    steady_headlines,
)

if TYPE_CHECKING:
    import xarray as xr

#: Headlines of loads: name, words, components of which the most loaded one counts, in the order of the page
_LOADS = (
    ("cable_tension", "cable", ("upper cable", "lower cable")),
    ("anchor_tension", "anchor line", ("anchor line",)),
)
#: Headlines of utilisations: load over strength, the safety factor left to the criterion
_USED = (
    ("cable_utilisation", "Cables, load over strength", ("upper cable", "lower cable")),
    ("anchor_line_utilisation", "Anchor lines, load over strength", ("anchor line",)),
    ("anchor_utilisation", "Anchors, load over holding force", ("anchor",)),
    ("joint_utilisation", "Joints, load over strength", ("joint",)),
    ("fabric_utilisation", "Sheet, load over strength", ("skirt",)),
)
#: Number of the statics that is the steady load of a component
_STEADY_NAMES = {
    "upper cable": "upper_tension", "lower cable": "lower_tension", "skirt": "sheet_tension",
    "anchor line": "anchor_tension", "anchor": "anchor_horizontal_tension",
}  # fmt: skip
_NOT_JUDGED = Headline(
    "not_judged", "Not judged", math.nan, "1", text="wear and fatigue, one line lost, seams and eyelets, scour",
    detail="ageing, fouling and fatigue of the sheet and its ropes, a curtain with one anchor line lost, stress at "
    "seams and eyelets, the holding of an anchor in its soil, and what the water under the toe does to the bed are not "
    "computed",
)  # fmt: skip
#: Key for more realisations.
_MORE = "settings.waves.realisations"
#: Groups that a level has where waves were run.
_IN_WAVES = ("waves", "dynamic", "weaker_currents")
_WEAKER = (
    "waves in currents weaker than that of the case are computed at half of it alone, where the whole span is run by "
    "default"
)
_MISSING = "the chord of the impact and a skirt that stretches, or 'dynamic' in 'analyses'"


@dataclass(frozen=True)
class _Load:
    """The governing load of a component at a level."""

    level: str
    component: str
    row: xr.Dataset
    band: Band | None
    #: What another run than that of the row makes of its values.
    other: Mapping[str, float | str] = field(default_factory=dict)

    def number(self, name: str) -> float:
        """A number of the row; NaN for one that results of older versions do not have."""
        if name in self.other:
            return float(self.other[name])
        return float(self.row.variables[name].values) if name in self.row.variables else math.nan

    def words(self, name: str) -> str:
        """Words of the row; empty likewise."""
        if name in self.other:
            return str(self.other[name])
        return str(self.row.variables[name].values) if name in self.row.variables else ""

    @property
    def value(self) -> float:
        """The load."""
        return self.number("governing_load")

    def use_of(self, load: float) -> float:
        """Utilisation by another load of the component [N, N/m]; NaN without a strength."""
        return self.number("safety_factor") * load / self.number("capacity")

    @property
    def used(self) -> float:
        """Load over strength; NaN without a strength."""
        return self.value / self.number("capacity")

    @property
    def holds(self) -> bool:
        """Whether the load keeps its strength with the safety factor, at the end at which criteria are judged."""
        high = self.value
        if self.band is not None:
            high = max(high, self.band.high) if self.band.decides else max(high, *(self.band.judged or ()))
        # a bound from below proves strength only where its band continues beyond it, as criteria are judged
        known = self.bound != "at least" or (self.band is not None and self.band.beyond_bound)
        return known and high * self.number("safety_factor") <= self.number("capacity")

    @property
    def bound(self) -> Bound:
        words = self.words("load_bound")
        return "at most" if words == "at most" else "at least" if words else ""

    @property
    def model(self) -> str:
        how = self.words("governing")
        if how == "dynamic":
            return SPAN
        what = how.rpartition(" ")[2]
        other = "" if what == "steady" else model_of(self.words(f"{what}_source"))
        return f"{STATICS} with {other}" if other else STATICS

    @property
    def source(self) -> str:
        """What the load comes from: sea, run or impact."""
        how = self.words("governing").rpartition(" ")[2]
        return self.words(f"{how}_source") if how in ("wave", "impact", "weaker", "dynamic") else "in the current alone"


def curtain_headlines(
    groups: Groups, levels: Sequence[str], criteria: Sequence[Criterion] = ()
) -> tuple[Headline, ...]:
    """Return the headlines of a run: those that fail, the most used component with its load, the others, the bounds.

    Parameters
    ----------
    groups : mapping
        Datasets of the run by their path, as docs/result_layout.md has them; what is absent gives no headline.
    levels : sequence of str
        Water levels; of each number the least favourable one counts and is named.
    criteria : sequence of Criterion
        That decide the order.
    """
    loads = [load for level in levels for load in _loads_of(groups, level)]
    # by use of the strength with its safety factor; what is only a bound does not govern and stands behind the values
    ranked = sorted(_used(loads), key=lambda item: (math.isnan(item[1].value), item[1].bound != "", -item[0]))
    used = [headline for _, headline in ranked]
    found = [
        *_tensions(loads, groups),
        *used,
        *steady_headlines(groups, levels),
        *depth_headlines(groups, levels),
        *limit_headlines(groups, levels, lambda level: _span_holds(loads, level)),
    ]
    if used:
        found.append(_not_judged(groups))
    if used and not math.isnan(used[0].value):
        # the load behind the most used component stands next to it
        first = used[0]
        behind = "anchor_tension" if first.name.startswith("anchor") else "cable_tension"
        found.sort(key=lambda item: (item.name != first.name, item.name != behind))
    failing = _failing(found, criteria)
    # what fails, then what decides, then what is only bounded or not known
    return tuple(sorted(found, key=lambda item: (item.name not in failing, item.bound != "" or math.isnan(item.value))))


def _failing(found: Sequence[Headline], criteria: Sequence[Criterion]) -> set[str]:
    """Return the names of the headlines that fail a criterion."""
    judged = judge(found, criteria, computed=True).judgements
    return {item.criterion.headline for item in judged if item.outcome == "does not hold"}


def _loads_of(groups: Groups, level: str) -> Iterator[_Load]:
    """Yield the governing load of every component, and other runs and models of waves that may be judged higher."""
    table = groups.get(f"/{level}/loads")
    if table is None:
        return
    for number, component in enumerate(table["component"].values):
        load = _Load(level, str(component), table.isel(component=number), None)
        if load.words("governing") == WEAKER:
            # the load in the weaker current, and below that of the case with all that is judged with it
            yield from (replace(one, band=_band(groups, one)) for one in _in_weaker(load, "governing"))
            load = replace(load, other={
                "governing": load.words("case_governing"), "governing_load": load.number("case_load"),
                "governing_high": load.number("case_high"), "load_bound": load.words("case_bound"),
                "factored_utilisation": load.use_of(load.number("case_load")),
            })  # fmt: skip
        if math.isfinite(load.value):
            yield replace(load, band=_band(groups, load))
            for other in (*_other_runs(groups, load), *_other_waves(load), *_in_weaker(load)):
                yield replace(other, band=_band(groups, other))


def _other_waves(load: _Load) -> Iterator[_Load]:
    """Yield the loads in waves by the models that do not lead: their own ends may be the higher ones."""
    names = {"steady and wave": ("second_wave",), "steady and impact": ("wave", "second_wave")}
    # next to a bound they would stand as values that are less than what may come
    for name in () if load.bound else names.get(load.words("governing"), ()):
        adds = load.number(f"{name}_load")
        if not adds > 0.0:
            continue
        whole = load.number("steady_load") + adds
        more = load.number("steady_high") - load.number("steady_load")
        yield replace(load, other={
            "governing": "steady and wave", "wave_load": adds, "wave_source": load.words(f"{name}_source"),
            "governing_load": whole, "governing_high": whole + (more if math.isfinite(more) else 0.0), "load_bound": "",
            "factored_utilisation": load.use_of(whole),
        })  # fmt: skip


def _in_weaker(load: _Load, which: str = "weaker") -> Iterator[_Load]:
    """Yield the load in a weaker current whose end is the highest, or the largest one, which governs."""
    value = load.number(f"{which}_load")
    if math.isfinite(value):
        yield replace(load, other={
            "governing": "steady and weaker", "governing_load": value, "governing_high": load.number(f"{which}_high"),
            "weaker_source": load.words(f"{which}_source"),
            # what is known in weaker currents stands next to a bound as a value
            "load_bound": load.words("load_bound") if which == "governing" else "",
            "factored_utilisation": load.use_of(value),
        })  # fmt: skip


def _other_runs(groups: Groups, load: _Load) -> Iterator[_Load]:
    """Yield the loads of a component in the runs of the whole span that do not lead.

    Of default runs the band of the one that leads holds the known ones, so that those that are open are left.
    """
    table = groups.get(f"/{load.level}/dynamic")
    key = COMPONENTS.get(_line(load))
    if table is None or key is None or "run" not in table.dims:
        return
    leads = load.words("dynamic_source") if load.words("governing") == "dynamic" else ""
    anchored = load.component == "anchor"
    slope = float(groups[f"/{load.level}"].attrs.get("anchor_slope", 0.0)) if anchored else 0.0
    for run, value, bound in _runs_of(groups, load.level, table, _line(load), key, leads):
        tension = math.cos(slope) * value
        if run == leads or not tension > 0.0:
            continue
        yield replace(load, other={
            "governing": "dynamic", "governing_load": tension, "governing_high": tension, "dynamic_load": tension,
            "dynamic_source": run, "load_bound": bound, "factored_utilisation": load.use_of(tension),
        })  # fmt: skip


def _runs_of(
    groups: Groups, level: str, table: xr.Dataset, line: str, key: str, leads: str
) -> Iterator[tuple[str, float, str]]:
    """Yield run, highest tension of a line and ``at least`` where more may come, of runs asked for or of events."""
    runs = [str(name) for name in table["run"].values]
    if "run_of" not in table:
        for run, value in zip(runs, table[key].values, strict=True):
            data = groups.get(f"/{level}/dynamic/{run}")
            random = data is not None and bool(data.attrs.get("random", 0))
            yield run, float(value), "at least" if random else ""
        return
    of = dict(zip(map(str, table["run_of"].values), runs, strict=True))
    own = str(table["run_of"].sel(run=leads).values) if leads else ""
    still = set(open_events(table, line))
    for event, run in of.items():
        if event != own and (event in still or not leads):
            value = event_band(table, event, line)[0]
            yield run, value, "at least" if event in still else ""


def _line(load: _Load) -> str:
    """Return the component of the whole span that carries a load: that of an anchor is its line, turned."""
    return "anchor line" if load.component == "anchor" else load.component


def _at_rest_words(load: _Load, groups: Groups) -> str:
    """Return the steady part of a load, called a pretension where it is that and no load of the current."""
    steady = load.number("steady_load")
    if not math.isfinite(steady):
        return ""
    statics = groups.get(f"/{load.level}/statics")
    name = _STEADY_NAMES.get(load.component, "")
    current = math.nan if statics is None else at_rest(statics, name)
    if load.component.startswith("anchor") and steady > current * (1.0 + 1e-9):
        return f"steady {kilo(steady)}: the pretension, and the part of the line in the {kilo(current)} of the current"
    return f"steady {kilo(steady)}"


def _bounded_by(load: _Load) -> str:
    """Return the bound of an upright plate next to the value of the whole span."""
    if load.words("governing") != "dynamic":
        return ""
    steady, more = load.number("steady_load"), [load.number(name) for name in ("wave_load", "impact_load")]
    bound = steady + max((one for one in more if math.isfinite(one)), default=0.0)
    if not bound > load.number("governing_load"):
        return ""
    return f"by an upright plate {kilo(bound)}, a bound without its band"


def _one(load: _Load, groups: Groups) -> str:
    """Say that the whole span was asked for, which runs one realisation of an irregular sea."""
    table = groups.get(f"/{load.level}/dynamic")
    if load.model != SPAN or load.bound != "at least" or table is None or "run_of" in table:
        return ""
    return "one realisation: leave 'dynamic' out of 'analyses' for several"


def _tensions(loads: Sequence[_Load], groups: Groups) -> Iterator[Headline]:
    for name, words, components in _LOADS:
        label = "Largest tension of a cable" if words == "cable" else "Largest tension of an anchor line"
        mine = sorted((one for one in loads if one.component in components), key=lambda one: one.value, reverse=True)
        found = [_tension(name, label, load, groups) for load in mine]
        if not found:
            continue
        shown = found[0]
        if not shown.bound:
            # of values the one that is judged worst is shown; what is open is judged with it
            shown = max((item for item in found if not item.bound), key=_end)
        behind = also_judged(shown, (item for item in found if item is not shown))
        yield from saying_what_is_open([shown, *behind])


def _tension(name: str, label: str, load: _Load, groups: Groups) -> Headline:
    """Return the tension of a component at a level."""
    detail = "; ".join(part for part in (_at_rest_words(load, groups), _bounded_by(load), _one(load, groups)) if part)
    return Headline(
        name, label, load.value, "N",
        where=f"{load.component}, {load.source}: {load.level}",
        model=load.model, band=load.band, bound=load.bound,
        detail="; ".join(part for part in (detail, REMEDY if load.bound == "at most" else "") if part),
    )  # fmt: skip


def _used(loads: Sequence[_Load]) -> Iterator[tuple[float, Headline]]:
    """Return each load over its strength, with its utilisation, the safety factor included.

    Of each kind the component and level that is judged worst is shown, the most used where that one is a bound; what
    may be worse, what is not known, and what a weaker current proves where only a bound is known, are judged with it.
    """
    for name, label, components in _USED:
        known = [one for one in loads if one.component in components and math.isfinite(one.used)]
        each = [(one, _used_headline(name, label, one)) for one in known]
        if not each:
            continue
        # what is judged worst is shown; where that is no number to design with, the most used component
        rated = [pair for pair in each if not pair[1].bound and math.isfinite(pair[1].value)]
        top = max(each, key=lambda pair: pair[0].number("factored_utilisation"))
        shown, first = max(rated, key=lambda pair: _end(pair[1])) if rated and top in rated else top
        yield shown.number("factored_utilisation"), first
        others = [
            headline if math.isfinite(headline.value) else replace(headline, text=f"not known at {one.level}")
            for one, headline in each
            if one is not shown
        ]
        for other in also_judged(first, others):
            yield shown.number("factored_utilisation"), other


def _end(item: Headline) -> float:
    """Return the end of a number that is judged, minus infinity where it is not known."""
    return unfavourable(item) if math.isfinite(item.value) else -math.inf


def _used_headline(name: str, label: str, load: _Load) -> Headline:
    strength = load.number("capacity")
    unit = load.words("load_unit")
    of = f"{kilo(load.value, unit)} of {kilo(strength, unit)}"
    factor = load.number("safety_factor")
    of += f", utilisation {factor * load.used:.3g} with the factor {factor:.3g}"
    where = f"{load.component}, {load.source}: {load.level}"
    if load.bound == "at least" and load.model != SPAN:
        # what only waits for its snap is no number to design with
        said = f"{of} without its snap, which needs {_MISSING}"
        return Headline(name, label, math.nan, "1", where=where, model=load.model, detail=said, text="not known")
    band = load.band
    band = None if band is None else band.scaled(1.0 / strength)
    return Headline(name, label, load.used, "1", where=where, model=load.model, band=band, bound=load.bound, detail=of)


def _band(groups: Groups, load: _Load) -> Band | None:
    """Return what the governing load of a component varies with: mesh, realisations, or the drag coefficient.

    A bound is given at the upper end of what it varies with and has no band.
    """
    if load.bound == "at most":
        return None
    how, value = load.words("governing"), load.number("governing_load")
    if how == "dynamic":
        return _moving_band(groups, load, value)
    if how == "steady and wave" and load.words("wave_source").startswith("energy model"):
        return _energy_band(groups, load)
    if how == "steady and wave":
        return _wave_band(groups, load)
    if how == "steady":
        return _steady_band(groups, load)
    if how == "steady and impact":
        return _impact_band(groups, load)
    if how == "steady and weaker":
        high = load.number("governing_high")
        of = "what adds in the weaker current, and the steady part there"
        if load.model.endswith(CYCLES):
            of = "judged end of the cycles in the weaker current, and the steady part there"
        return Band(value, high, of)
    return None


def _impact_band(groups: Groups, load: _Load) -> Band | None:
    """Return what the bands of the steady part and of the impact make of their sum."""
    steady, reached = _steady_band(groups, load), load.number("governing_high")
    low, high = (load.number(f"impact_{end}") + load.number(f"steady_{end}") for end in ("low", "high"))
    if not (math.isfinite(low) and math.isfinite(high)):
        return None
    high = max(high, reached if math.isfinite(reached) else high)
    of = "impact: the models used for design, start speed over drag and place of release"
    value = load.value
    of += "" if steady is None else f"; steady part: {steady.of}"
    return Band(min(low, value), max(high, value), of)


def _moving_band(groups: Groups, load: _Load, value: float) -> Band | None:
    """Return the change with mesh and step of the run, where these runs were made, else the scatter of its periods."""
    table = groups.get(f"/{load.level}/dynamic")
    if table is not None and "run_of" in table:
        return _mesh_band(table, load, value)
    run = groups.get(f"/{load.level}/dynamic/{load.words('dynamic_source')}")
    if run is None or "line_tension_maximum" not in run:
        return None
    line = _line(load)
    mine = [row for row, name in enumerate(run["line"].values) if str(name).startswith(line)]
    if not mine:
        return None
    row = max(mine, key=lambda number: float(run["line_tension_maximum"].values[number]))
    factor = value / float(run["line_tension_maximum"].values[row])
    others = [factor * float(run[name].values[row]) for name in ("line_half_mesh", "line_half_step")]
    known = [other for other in others if math.isfinite(other)]
    reach = reach_of_periods(run, line) if run.attrs.get("regular") else 1.0
    if known:
        return Band(min(value, *known), max(reach * value, *known), "with half the cells and with half the step")
    if not run.attrs.get("regular"):
        return None
    peaks = factor * _period_peaks(run, row)
    if peaks.size < 2:
        return None
    of = f"{peaks.size} periods, mean to highest"
    if reach > 1.0:
        of = f"{peaks.size} periods that do not repeat, mean to the highest of 95 of 100 records"
    return Band(float(peaks.mean()), reach * value, of, decides=reach > 1.0)


def _mesh_band(table: xr.Dataset, load: _Load, value: float) -> Band | None:
    """Return the peaks of an event on its meshes and over the realisations of its sea, with those of other events."""
    event = str(table["run_of"].sel(run=load.words("dynamic_source")).values)
    component = _line(load)
    whole, low, high, judged, count = event_band(table, event, component)
    # another event with a smaller mean may reach higher; one that is open is judged as a load of its own
    still = open_events(table, component)
    others = [
        event_band(table, str(name), component) for name in table["event"].values if str(name) not in (event, *still)
    ]
    known = [item for item in others if math.isfinite(item[0])]
    high, judged = max([high, *(item[2] for item in known)]), max([judged, *(item[3] for item in known)])
    ceiling = ceiling_of(table, event, component) if load.bound == "at least" else math.nan
    if not low < max(high, judged) and math.isnan(ceiling):
        return None
    factor = value / whole
    low, high = factor * low, max(factor * high, value)
    if math.isfinite(ceiling):
        end = kilo(factor * ceiling, load.words("load_unit"))
        how = "to cells four times smaller" if component == "skirt" else "at first order"
        of = f"meshes and events; judged at {end}, the growth from mesh to mesh continued {how}"
        more = "settings.dynamic.cells_along and cells_down"
        return Band(low, high, of, decides=False, judged=(low, factor * ceiling), beyond_bound=True, more=more)
    if count < 2:
        high = max(high, factor * judged)
        return Band(low, high, "meshes and events, the larger is used; drag at its value")
    of = f"{count} realisations and two meshes; drag at its value; judged at the 95 % end of the larger mean"
    ends = (low, factor * judged)
    return Band(low, high, of, decides=False, judged=ends, realisations=count, more=_MORE)


def _energy_band(groups: Groups, load: _Load) -> Band | None:
    """Return what the energy factor makes of a load of the anchor line: 0.2 fitted the field, 0.5 the flume.

    The wave part solves T^2 + 2 T T_0 = M m_B K u^2, so that a factor on M is one on T^2 + 2 T T_0 [eq:curtain-energy].
    """
    table = groups.get(f"/{load.level}/anchor_loads")
    if table is None:
        return None
    given, held = float(table["energy_factor"]), float(table["pretension"])
    whole, steady, wave = (load.number(name) for name in ("governing_load", "steady_load", "wave_load"))
    slope = (
        math.cos(float(groups[f"/{load.level}"].attrs.get("anchor_slope", 0.0))) if load.component == "anchor" else 1
    )
    rise = wave / slope
    energy = rise * (rise + 2.0 * held)
    ends = [steady + slope * (math.hypot(held, math.sqrt(energy * m / given)) - held) for m in ENERGY_FACTORS]
    # upper end of the steady part, and of what else governs
    more, reached = load.number("steady_high") - steady, load.number("governing_high")
    high = max(whole, *ends) + (more if math.isfinite(more) else 0.0)
    of = "energy factor 0.2 (field) to 0.5 (flume)"
    return Band(min(whole, *ends), max(high, reached if math.isfinite(reached) else 0.0), of)


def _period_peaks(run: xr.Dataset, row: int) -> NDArray[np.float64]:
    """Return the highest tension of a line in each period that counts [N]."""
    time, period = run["time"].values, float(run.attrs["period"])
    number = np.floor((time - float(run.attrs["counted_from"])) / period * (1.0 + 1e-9)).astype(int)
    count = round((float(time[-1]) - float(run.attrs["counted_from"])) / period)
    values = run["line_tension_peak_since_row"].values[row]
    return np.array([values[number == one].max() for one in range(count) if np.any(number == one)])


def _wave_band(groups: Groups, load: _Load) -> Band | None:
    """Return what a load in waves varies with: the realisations or periods of the sea, and its steady part.

    Criteria are judged at the end of the one-sided 95 % interval of the mean of the realisations and at the
    upper end of the steady part, or of the impact where that reaches higher.
    """
    whole, steady = load.number("governing_load"), load.number("steady_load")
    less, more = steady - load.number("steady_low"), load.number("steady_high") - steady
    less, more = (gap if math.isfinite(gap) else 0.0 for gap in (less, more))
    reached = load.number("governing_high")
    upper = max(whole + more, reached if math.isfinite(reached) else 0.0)
    kind, _, sea = load.words("wave_source").partition(", ")
    table = groups.get(f"/{load.level}/waves/{sea}")
    part = "steady part: drag, weights, flow under the toe, friction and end restraint of the skirt"
    if kind != "slack and taut cycles" or table is None:
        return Band(whole - less, upper, part) if upper > whole else None
    own = SeaCycles.of(table)
    if not own.top > 0.0:
        return None
    # the cycles give the whole of a component's load in proportion to the sum of the cables
    seas = [SeaCycles.of(data) for path, data in groups.items() if _is_cycles(path, data, load.level)]
    worst = max(seas, key=lambda one: one.judged)
    high = max(one.high for one in seas)
    if own.low == high == worst.judged == own.top:
        return Band(whole - less, upper, part) if upper > whole else None
    words = ", ".join(dict.fromkeys((own.words, worst.words)))
    if worst.of_strong_drag > 1.0:
        words += ", drag coefficient at the upper end of its range"
    return Band(
        whole * own.low / own.top - less, max(whole * high / own.top + more, upper),
        f"{words}; {part}; judged at the 95 % end of the mean", decides=False,
        judged=(whole * (1.0 - own.reach / own.top) - less, max(whole * worst.judged / own.top + more, upper)),
        realisations=worst.count, more=_MORE, settled=max(whole * worst.top / own.top + more, upper),
    )  # fmt: skip


def _not_judged(groups: Groups) -> Headline:
    """Return what is not judged; a sea pulls harder than regular waves as high as its highest."""
    parts = {part: [data for path, data in groups.items() if path.split("/")[2:3] == [part]] for part in _IN_WAVES}
    kinds = {data.attrs.get("kind") for data in parts["waves"]}
    text, detail = _NOT_JUDGED.text, _NOT_JUDGED.detail
    flows = any(float(data.attrs.get("surface_speed", 0.0)) > 0.0 for data in groups.values())
    if flows and any(parts.values()) and not parts["weaker_currents"]:
        text, detail = f"{text}, waves in weaker currents", f"{detail}; {_WEAKER}"
    if "regular" in kinds and "irregular" not in kinds:
        text += ", irregular seas"
    return replace(_NOT_JUDGED, text=text, detail=detail)


def _is_cycles(path: str, data: xr.Dataset, level: str) -> bool:
    return path.startswith(f"/{level}/waves/") and path.count("/") == 3 and "both_cables_tension_maximum" in data


def _steady_band(groups: Groups, load: _Load) -> Band | None:
    statics = groups.get(f"/{load.level}/statics")
    if statics is None:
        return None
    if load.component == "joint":
        # the load of a stretch of the curtain goes with the load per length
        band, value = statics_band(statics, "line_load"), at_rest(statics, "line_load")
        return None if band is None or not value > 0.0 else band.scaled(load.number("steady_load") / value)
    band = statics_band(statics, _STEADY_NAMES.get(load.component, ""))
    if band is not None and load.component.startswith("anchor"):
        # a pretension carries part of it
        band = replace(band, low=load.number("steady_low"), high=load.number("steady_high"))
    return band


def _span_holds(loads: Sequence[_Load], level: str) -> bool:
    """Return whether the whole span was run at a level and everything holds with its safety factor in its seas."""
    mine = [one for one in loads if one.level == level and math.isfinite(one.used)]
    return any(one.model == SPAN for one in mine) and all(one.holds for one in mine)


__all__ = ["curtain_headlines"]
