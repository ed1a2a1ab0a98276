"""The load table: every component's load split into steady, wave, impact and governing, with its utilisation."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from operator import attrgetter
from types import MappingProxyType
from typing import TYPE_CHECKING

from moyai.core.errors import InputError
from moyai.core.validity import Notice
from moyai.structures.curtain.analyses.anchor import rope_model, steady_tension
from moyai.structures.curtain.analyses.dynamic import SpanLoad
from moyai.structures.curtain.analyses.impact import ImpactAnswer
from moyai.structures.curtain.analyses.weaker_currents import weaker_cycles, weaker_impacts
from moyai.structures.curtain.assembly import LevelCurtain
from moyai.structures.curtain.governing import WEAKER, governing_load, model_of
from moyai.structures.curtain.hierarchy import CREST, CYCLES, IMPACT, ModelRole, Role, hierarchy, role_of
from moyai.structures.curtain.limits.loads import impact_load
from moyai.structures.curtain.limits.utilisation import AddedLoads, Strength
from moyai.structures.curtain.model import COMPONENTS, CurtainSettings
from moyai.structures.curtain.seas.loads import DragCurve, increase, on_lines
from moyai.structures.curtain.seas.squared_velocity import squared_velocity
from moyai.structures.curtain.seas.states import DesignWave
from moyai.structures.curtain.statics.hanging import CurtainStatics, tight_line
from moyai.structures.curtain.statics.steady_load import drag_factors
from moyai.structures.curtain.variables import labelled

if TYPE_CHECKING:
    import xarray as xr

#: Roles of an upright plate in weaker currents.
_PLATES: tuple[Role, ...] = ("governs", "bound")
#: Highest tension of components in runs of the whole span [N, N/m], and the run in which each stands.
DynamicLoads = Mapping[str, SpanLoad]
NOT_MOVED: DynamicLoads = MappingProxyType({})
_UNITS = {"skirt": "N/m", "float": "N/m"}
_FIELDS = {
    "upper cable": "upper_cable",
    "lower cable": "lower_cable",
    "skirt": "sheet",
    "joint": "line_load",
    "float": "anchor_line",
    "anchor line": "anchor_line",
    "anchor": "anchor_line",
}


@dataclass(frozen=True)
class _Added:
    """Loads that one source adds, with its name for each component that it loads."""

    loads: AddedLoads
    source: str
    #: At the end at which they are judged.
    high: AddedLoads


_NOTHING = _Added(AddedLoads(), "", AddedLoads())


def loads_dataset(
    unit: LevelCurtain,
    settings: CurtainSettings,
    waves: tuple[DesignWave, ...],
    oscillator: tuple[tuple[str, float, float], ...],
    answer: ImpactAnswer | None,
    proportions: ImpactAnswer | None,
    curve: DragCurve,
    moved: DynamicLoads = NOT_MOVED,
    roles: tuple[ModelRole, ...] = (),
    weaker_waves: xr.Dataset | None = None,
) -> tuple[xr.Dataset, tuple[Notice, ...]]:
    """Return the group ``loads`` and its notices.

    Parameters
    ----------
    unit : LevelCurtain
    settings : Settings
    waves : tuple of DesignWave
        All waves of the case.
    oscillator : tuple of (str, float, float)
        Sea state, largest sum of the cable tensions in it [N] and the end at which that is judged, where slack and taut
        cycles were run.
    answer : ImpactAnswer or None
        None where the impact was not asked for.
    proportions : ImpactAnswer or None
        By which the tension of slack and taut cycles goes to the components; None where they were not run.
    curve : DragCurve
        Loads at rest, up to :func:`moyai.structures.curtain.analyses.limits.fastest_water`.
    moved : mapping
        Highest tension of a component in runs of the whole span [N, N/m] and the run in which it stands.
    roles : tuple of ModelRole
        What each model counts for; the hierarchy of the case when left out.
    weaker_waves : Dataset, optional
        Slack and taut cycles in weaker currents.
    """
    statics = unit.statics if unit.surface_speed > 0.0 else None
    roles = roles or hierarchy(unit, settings)
    sources, notices = _wave_sources(unit, settings, waves, statics, oscillator, proportions, curve)
    force, most = _line_force(unit)
    pretension = unit.hanging.pretension
    ends = (1.0, 1.0) if answer is None else answer.uncertainty
    struck = [AddedLoads()] * 3
    if answer is not None:
        whole = impact_load(unit, answer, settings).of_tension(answer.design_tension)
        struck = [on_lines(whole.times(share), at, pretension) for share, at in zip((1.0, *ends), (force, force, most))]
    name = "" if answer is None else f"impact, model {answer.design_model}"
    rows, sure = [], {}
    governing = [item for item in sources if role_of(roles, model_of(item.source)) == "governs"]
    for component in COMPONENTS:
        steady = _steady(unit, component)
        field = _FIELDS[component]
        best = max(sources, key=lambda item: getattr(item.loads, field), default=_NOTHING)
        factor = _factor(unit, component)
        wave, hits = factor * getattr(best.loads, field), [factor * getattr(hit, field) for hit in struck]
        if component == "skirt" and proportions is not None and impact_load(unit, proportions, settings).skirt is None:
            hits = [math.nan] * 3
        row = _row(unit, component, steady, wave, (hits[0], hits[1], hits[2]), best.source, name)
        alike = role_of(roles, model_of(best.source))
        counted = (alike, "governs")
        highs = [getattr(one.high, field) for one in sources if role_of(roles, model_of(one.source)) in counted]
        row["wave_high"] = max([wave, *(factor * high for high in highs)])
        # what another model makes of waves may be judged at a higher end
        others = [item for item in sources if model_of(item.source) != model_of(best.source)]
        second = max(others, key=lambda item: getattr(item.loads, field), default=_NOTHING)
        more = factor * getattr(second.loads, field)
        if row["wave_source"] and more > 0.0 and role_of(roles, model_of(second.source)) == "governs":
            row |= {"second_wave_load": more, "second_wave_source": second.source}
        rows.append(row)
        best = max(governing, key=lambda item: getattr(item.high, field), default=_NOTHING)
        alone = _row(unit, component, steady, factor * getattr(best.loads, field), (0.0, 0.0, 0.0), best.source, "")
        sure[component] = alone | {"wave_high": factor * getattr(best.high, field)}
    weaker, bounds = (
        _weaker_rows(unit, settings, answer, proportions, weaker_waves, upright=governs) for governs in (True, False)
    )
    return _table(unit, rows, moved, roles, weaker, bounds, sure), tuple(notices)


def dynamic_loads_dataset(unit: LevelCurtain, moved: DynamicLoads) -> xr.Dataset:
    """Return the group ``loads`` where runs of the whole span are all there is."""
    none = math.nan
    rows = [_row(unit, component, (none,) * 3, none, (none,) * 3, "", "") for component in COMPONENTS]
    return _table(unit, rows, moved, ())


def _weaker_rows(
    unit: LevelCurtain,
    settings: CurtainSettings,
    answer: ImpactAnswer | None,
    proportions: ImpactAnswer | None,
    waves: xr.Dataset | None,
    *,
    upright: bool,
) -> dict[str, list[dict[str, float | str]]]:
    """Return by component the rows of impact and waves in weaker currents that are highest, by value or by end.

    Those in which an upright plate governs, or those in which it is a bound.
    """
    every = [] if answer is None else list(weaker_impacts(unit, settings, answer))
    if proportions is not None and waves is not None:
        every.extend(weaker_cycles(unit, settings, proportions, waves))
    found = [one for one in every if one.upright == upright]
    rows: dict[str, list[dict[str, float | str]]] = {}
    for component in COMPONENTS if found else ():
        known = [one for one in found if component != "float" and (component != "skirt" or one.sheet)]
        factor, field = _factor(unit, component), attrgetter(_FIELDS[component])
        ends = {
            id(top): top
            for end in ("value", "high")
            for top in sorted(known, key=lambda one: field(getattr(one, end)) + field(one.still))[-1:]
        }
        for weaker in ends.values():
            force, most = _line_force(weaker.unit)
            pretension = unit.hanging.pretension
            loads = zip((weaker.value, weaker.low, weaker.high), (force, force, most), strict=True)
            value, low, high = (factor * field(on_lines(load, at, pretension)) for load, at in loads)
            steady = _steady(weaker.unit, component)
            row = _row(unit, component, steady, 0.0, (value, low, high), "", weaker.source)
            rows.setdefault(component, []).append(row)
    return rows


def _table(
    unit: LevelCurtain, rows: list[dict[str, float | str]], moved: DynamicLoads, roles: tuple[ModelRole, ...],
    weaker: Mapping[str, list[dict[str, float | str]]] = MappingProxyType({}),
    bounds: Mapping[str, list[dict[str, float | str]]] = MappingProxyType({}),
    sure: Mapping[str, dict[str, float | str]] = MappingProxyType({}),
) -> xr.Dataset:  # fmt: skip
    """Return the table; ``sure`` are the rows of models that govern alone, known next to a bound."""
    import xarray as xr

    decided = [_decided(unit, row, moved, roles) for row in rows]
    plate, bound = (tuple(ModelRole(model, role, "", "") for model in (IMPACT, CYCLES)) for role in _PLATES)
    for number, row in enumerate(decided):
        name = str(row["component"])
        slower = [_decided(unit, other, NOT_MOVED, plate) for other in weaker.get(name, [])]
        if slower and row["load_bound"] == "at most" and name in sure:
            alone = _decided(unit, sure[name], NOT_MOVED, roles)
            slower.append(alone | {"impact_source": alone["wave_source"] or "in the current alone"})
        most = [_decided(unit, other, NOT_MOVED, bound) for other in bounds.get(name, [])]
        decided[number] = _with_bound(_with_weaker(row, slower), slower, most)
    rows = _with_joint(unit, decided, frozenset(name for name, span in moved.items() if span.open))
    columns = {key: [row[key] for row in rows] for key in rows[0]}
    known = [row for row in rows if math.isfinite(row["factored_utilisation"])]  # type: ignore[arg-type]
    governing = max(known, key=lambda row: float(row["factored_utilisation"]), default=None)
    data = xr.Dataset(
        {key: ("component", values) for key, values in columns.items() if key != "component"},
        coords={"component": list(COMPONENTS)},
        attrs={"governing_component": "" if governing is None else str(governing["component"])},
    )
    return labelled(data)


def _with_weaker(row: dict[str, float | str], weaker: Sequence[dict[str, float | str]]) -> dict[str, float | str]:
    """Return a row with what weaker currents make of its load: the largest value governs, the highest end is judged.

    What is made in the current of the case is kept next to it, for all of it is judged.
    """
    largest = max(weaker, key=lambda one: float(one["governing_load"]), default=row)
    highest = max(weaker, key=lambda one: float(one["governing_high"]), default=row)
    bound = row["load_bound"] == "at most"
    # a value below a bound: the bound proves nothing that it passes, the value does
    counts = bool(weaker) and (bound or float(highest["governing_high"]) > float(row["governing_high"]))
    row = row | {
        "case_load": row["governing_load"], "case_high": row["governing_high"], "case_governing": row["governing"],
        "case_bound": row["load_bound"], "governing_source": "",
        "weaker_load": highest["governing_load"] if counts else math.nan,
        "weaker_high": highest["governing_high"] if counts else math.nan,
        "weaker_source": highest["impact_source"] if counts else "",
    }  # fmt: skip
    if largest is row or not float(largest["governing_load"]) > float(row["governing_load"]):
        return row
    names = ("governing_load", "governing_high", "load_bound", "factored_utilisation", "factored_utilisation_high")
    return row | {name: largest[name] for name in names} | {
        "governing": WEAKER, "governing_source": largest["impact_source"]
    }  # fmt: skip


def _with_bound(
    row: dict[str, float | str], weaker: Sequence[dict[str, float | str]], bounds: Sequence[dict[str, float | str]]
) -> dict[str, float | str]:
    """Return a row with what a plate that is a bound makes of a drift of the waves, where that is the most.

    What is known in weaker currents is kept next to it.
    """
    most = max(bounds, key=lambda one: float(one["governing_high"]), default=None)
    if most is None or not float(most["governing_high"]) > float(row["governing_high"]):
        return row
    known = max(weaker, key=lambda one: float(one["governing_high"]), default=None)
    if known is not None:
        row = row | {
            "weaker_load": known["governing_load"], "weaker_high": known["governing_high"],
            "weaker_source": known["impact_source"],
        }  # fmt: skip
    names = ("governing_load", "governing_high", "load_bound", "factored_utilisation", "factored_utilisation_high")
    return row | {name: most[name] for name in names} | {"governing": WEAKER, "governing_source": most["impact_source"]}


def _decided(
    unit: LevelCurtain, row: dict[str, float | str], moved: DynamicLoads, roles: tuple[ModelRole, ...]
) -> dict[str, float | str]:
    """Return a row with the load of the moving span, the load that governs and its utilisation."""
    component = str(row["component"])
    span = moved.get("anchor line" if component == "anchor" else component, SpanLoad(math.nan, ""))
    factor, run = _factor(unit, component) if component == "anchor" else 1.0, span.run
    load = factor * span.load
    row = row | {"dynamic_load": load, "dynamic_source": run if math.isfinite(load) else ""}
    row |= governing_load(row, roles)
    if span.at_least and row["governing"] == "dynamic":
        row |= {"load_bound": "at least"}
    governing, steady, high = (float(row[key]) for key in ("governing_load", "steady_load", "steady_high"))
    # the upper end of the steady load is added to what waves add; with a moving span it counts where it alone is more
    above = governing - steady + high
    if row["governing"] in ("steady and impact", "steady and wave"):
        # the larger of the values is shown; the other one may reach higher
        ends = {IMPACT: row["impact_high"], model_of(str(row["wave_source"])): row["wave_high"]}
        leads = model_of(str(row["impact_source" if row["governing"] == "steady and impact" else "wave_source"]))
        above = max(
            [above]
            + [high + float(end) for model, end in ends.items() if model == leads or role_of(roles, model) == "governs"]
        )
    if row["governing"] == "dynamic":
        above = max(one for one in (governing, high, factor * span.judged) if math.isfinite(one))
    if row["load_bound"] == "at most":
        # a bound stands at the upper end of all that it varies with
        governing = above
    row |= {"governing_load": governing, "governing_high": above}
    judged = math.isfinite(float(row["capacity"])) and math.isfinite(governing)
    strength = _strength(unit, component)
    return row | {
        "factored_utilisation": strength.utilisation(governing) if judged else math.nan,
        "factored_utilisation_high": strength.utilisation(above) if judged else math.nan,
    }


def _with_joint(
    unit: LevelCurtain, rows: list[dict[str, float | str]], open_lines: frozenset[str] = frozenset()
) -> list[dict[str, float | str]]:
    """Return the rows with the joint loaded by no more than the load line in which it lies [eq:curtain-joint-load].

    As a bound it takes the upper end of what the cables vary with. Where the whole span was run and the joint has but a
    drag that has no snap of its own, the line is its bound, or nothing where the line is known from below alone, or
    is one of ``open_lines``, of which a run that does not lead may come to more.
    """
    cables = [row for row in rows if row["component"] in ("upper cable", "lower cable")]
    strength = _strength(unit, "joint")
    for row in rows:
        if row["component"] != "joint":
            continue
        if any(cable.get("case_governing", cable["governing"]) == "dynamic" for cable in cables) and _without_snap(row):
            alone = any(cable["load_bound"] == "at least" or cable["component"] in open_lines for cable in cables)
            row["governing_load"] = row["governing_high"] = math.nan if alone else math.inf
            row["load_bound"] = "" if alone else "at most"
        for load, end, used in (
            ("steady_low", "steady_low", ""), ("steady_load", "steady_load", ""), ("steady_high", "steady_high", ""),
            ("governing_load", "governing_high", "factored_utilisation"),
            ("governing_high", "governing_high", "factored_utilisation_high"),
        ):  # fmt: skip
            known = [float(cable[end]) for cable in cables if math.isfinite(float(cable[end]))]
            if end == "governing_high":
                known = [_highest_end(cable) for cable in cables if _highest_end(cable) > 0.0]
            if not known or not float(row[load]) > sum(known):
                continue
            row[load] = sum(known)
            if load == "governing_load":
                row["load_bound"] = row["load_bound"] or "at most"
            if used and math.isfinite(float(row["capacity"])):
                row[used] = strength.utilisation(sum(known))
        most = sum(_highest_end(cable) for cable in cables)
        if most > 0.0 and "weaker_high" in row:
            row |= {name: min(float(row[name]), most) for name in ("weaker_load", "weaker_high")}
    return rows


def _highest_end(row: Mapping[str, float | str]) -> float:
    """Return the highest end of a load in any current; 0 where none is known."""
    ends = [float(row.get(name, math.nan)) for name in ("governing_high", "case_high", "weaker_high")]
    return max((end for end in ends if math.isfinite(end)), default=0.0)


def _without_snap(row: dict[str, float | str]) -> bool:
    """Whether the load of a row has no snap in waves: that of the current, an impact in it, drag under a crest."""
    what = str(row.get("case_governing", row["governing"])).rpartition(" ")[2]
    return what in ("steady", "impact") or (what == "wave" and model_of(str(row["wave_source"])) == CREST)


def _wave_sources(
    unit: LevelCurtain,
    settings: CurtainSettings,
    waves: tuple[DesignWave, ...],
    statics: CurtainStatics | None,
    oscillator: tuple[tuple[str, float, float], ...],
    proportions: ImpactAnswer | None,
    curve: DragCurve,
) -> tuple[list[_Added], list[Notice]]:
    """Return what each wave adds by each model; a plate pulls at its anchor lines too."""
    sources: list[_Added] = []
    notices: list[Notice] = []
    anchor = settings.anchor_loads
    rule, ratio = settings.direction
    strong = 1.0 if unit.nominal else drag_factors(unit.hanging.drag)[1]
    (force, most), pretension = _line_force(unit), unit.hanging.pretension
    speeds = []
    for wave in waves:
        acting = wave.effective_height(rule, ratio)
        square = squared_velocity(acting, wave.period, unit.normal_speed, unit.depth, unit.water)
        speeds.append(math.sqrt(float(square)))
    for wave, speed in zip(waves, speeds):
        try:
            whole = curve.at(speed)
        except InputError as error:
            text = f"{unit.name}, {wave.name}: the drag under the crest is left out: {error.fault.message}"
            notices.append(Notice("curtain-wave-drag", text, speed, remedy="give more toe weight"))
            continue
        more = whole if statics is None else increase(whole, statics)
        # a load goes with the drag coefficient
        value, high = on_lines(more, force, pretension), on_lines(more.times(strong), most, pretension)
        sources.append(_Added(value, f"drag under the crest, {wave.name}", high))
    if anchor is not None and unit.curtain.anchors is not None and "anchor_loads" in settings.analyses:
        model, pull = rope_model(unit, anchor), steady_tension(unit, anchor)
        for wave in waves:
            acting = wave.effective_height(rule, ratio)
            moving = model.float_speed(acting, wave.period, unit.normal_speed, unit.water)
            rise = float(model.fluctuating_tension(moving, pull))
            lifted = AddedLoads(anchor_line=rise)
            sources.append(_Added(lifted, f"energy model, {wave.name}", lifted))
    if proportions is not None:
        turned = impact_load(unit, proportions, settings)
        for name, *ends in oscillator:
            found = [turned.of_tension(tension) for tension in ends]
            more, end = (whole if statics is None else increase(whole, statics) for whole in found)
            value, high = on_lines(more, force, pretension), on_lines(end, most, pretension)
            sources.append(_Added(value, f"slack and taut cycles, {name}", high))
    return sources, notices


def _factor(unit: LevelCurtain, component: str) -> float:
    """Return what turns the load of a field into that of a component."""
    slope = unit.hanging.anchor_slope
    return {
        "joint": unit.curtain.joint_distance,
        "float": math.sin(slope) / unit.curtain.span,
        "anchor": math.cos(slope),
    }.get(component, 1.0)


#: Quantity of the steady state that loads a component
_STEADY = {
    "upper cable": "upper_tension",
    "lower cable": "lower_tension",
    "skirt": "sheet_tension",
    "joint": "line_load",
    "float": "float_load",
    "anchor line": "anchor_tension",
    "anchor": "anchor_horizontal_tension",
}


def _line_force(unit: LevelCurtain) -> tuple[float, float]:
    """Return the force of the current along an anchor line [N] and the upper end of its band, 0 without a current."""
    if unit.surface_speed == 0.0:
        return 0.0, 0.0
    steady, name = unit.steady, _STEADY["anchor line"]
    return steady.governing.quantity(name), steady.band(name)[1]


def _steady(unit: LevelCurtain, component: str) -> tuple[float, float, float]:
    """Return the steady load of a component with the lower and upper end of its band."""
    skirt = unit.curtain.skirt
    pulled = 0.0
    if component in ("anchor line", "anchor"):
        pulled = unit.hanging.pretension * (_factor(unit, "anchor") if component == "anchor" else 1.0)
    lightest, heaviest = unit.curtain.toe_range
    floats = [unit.slack_float_load(factor) for factor in (1.0, min(lightest, 1.0), max(heaviest, 1.0))]
    if unit.surface_speed == 0.0:
        if component == "float":
            return floats[0], floats[1], floats[2]
        hangs = skirt.toe_load + max(skirt.submerged_weight, 0.0) * skirt.length if component == "skirt" else 0.0
        return (max(hangs, pulled),) * 3
    steady, name = unit.steady, _STEADY[component]
    per = unit.curtain.joint_distance if component == "joint" else 1.0
    ends = [per * steady.governing.quantity(name), *(per * end for end in steady.band(name))]
    if component == "float":
        # the current carries part of the weight of a skirt that flares; slack water comes twice a tide
        ends = [max(value, other) for value, other in zip(ends, floats, strict=True)]
    given, low, high = (tight_line(value, pulled) for value in ends)
    return given, low, high


def _strength(unit: LevelCurtain, component: str) -> Strength:
    known = unit.curtain.strengths
    if component == "float":
        share = 1.0 - known.least_reserve
        return Strength(unit.curtain.floats.buoyancy, 1.0 / share)
    return {
        "upper cable": known.upper_cable,
        "lower cable": known.lower_cable,
        "skirt": known.sheet,
        "joint": known.joint,
        "anchor line": known.anchor_line,
        "anchor": known.anchor,
    }[component]


def _row(
    unit: LevelCurtain,
    component: str,
    band: tuple[float, float, float],
    wave: float,
    impact: tuple[float, float, float],
    source: str,
    struck: str,
) -> dict[str, float | str]:
    strength = _strength(unit, component)
    steady, low, high = band
    hit, hit_low, hit_high = impact
    judged = math.isfinite(strength.capacity)
    there = not (component in ("anchor line", "anchor") and unit.curtain.anchors is None) and not (
        component == "lower cable" and unit.curtain.lower_stiffness == 0.0
    )
    return {
        "component": component,
        "steady_load": steady if there else math.nan,
        "steady_low": low if there else math.nan,
        "steady_high": high if there else math.nan,
        "wave_load": wave if there else math.nan,
        "wave_high": wave if there else math.nan,
        "impact_load": hit if there else math.nan,
        "impact_low": hit_low if there else math.nan,
        "impact_high": hit_high if there else math.nan,
        "capacity": strength.capacity if judged and there else math.nan,
        "safety_factor": strength.safety_factor if judged and there else math.nan,
        "load_unit": _UNITS.get(component, "N"),
        "wave_source": source if there and wave > 0.0 else "",
        "second_wave_load": math.nan,
        "second_wave_source": "",
        "impact_source": struck if there and hit > 0.0 else "",
    }
