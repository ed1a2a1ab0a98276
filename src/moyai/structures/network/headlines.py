"""The numbers of a network's first page: the highest tension with its numerical band, anchors, offset, modes.

How the answer is made: docs/answer/network.md.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

import numpy as np

from moyai.core.arrays import Array
from moyai.core.headline import Band, Bound, Headline, all_judged, governing, unfavourable
from moyai.core.wording import spoken
from moyai.structures.network.at_rest import (
    FINER,
    MESH_MOVES,
    MESH_UNCHECKED,
    rest_headlines,
    unsettled_mesh,
    with_mesh_of_rest,
)
from moyai.structures.network.chance import (
    MORE_SEEDS,
    ONE_BY_ONE,
    ONE_SEED,
    SNAPS_OF_ONE_SEED,
    chance_of,
    irregular,
    length_of,
    of_pull,
    of_record,
    of_seeds,
    one_seed_of_snaps,
    scatter_of,
    with_chance,
    with_seeds,
)
from moyai.structures.network.held_headlines import held_headlines
from moyai.structures.network.mesh_band import REMEDY, UNCHECKED, mesh_and_step, numerical_band
from moyai.structures.network.mode_headlines import mode_headlines
from moyai.structures.network.model import NetworkProblem
from moyai.structures.network.refinement import LANDING
from moyai.structures.network.rest_mesh import COARSE, band_at_rest
from moyai.structures.network.settling import unsettled
from moyai.structures.network.single_anchor import single_anchors
from moyai.structures.network.start_headlines import start_headlines
from moyai.structures.network.summary import LOADS_AGAIN

if TYPE_CHECKING:
    import xarray as xr

#: Highest tension over that at the ends of its line above which both are reported.
INSIDE = 1.2
#: What is said of a pull that no run which checks the mesh looked at.
PROPORTION, PULL_UNCHECKED = "mesh and step: in proportion", "mesh and step of the pull itself not checked"
DYNAMIC, REST = "run through time", "at rest"
_NOT_JUDGED = Headline(
    "not_judged", "Not judged", math.nan, "1", text="one line lost, wear and fatigue, shackles, soil of the anchors",
    condition=True,
)  # fmt: skip
_OTHER_DIRECTIONS = replace(
    _NOT_JUDGED, text=f"{_NOT_JUDGED.text}, other directions of current and waves, other drag coefficients",
    detail="lines perpendicular to current and waves may carry several times the load of lines along them: run both "
        "headings; no band covers drag coefficients, with which loads go where drag leads: run their upper end",
)  # fmt: skip
#: What is said of a line without a breaking load next to lines that have one.
NO_STRENGTH = "breaking load not given of"


@dataclass(frozen=True, eq=False)
class _Peak:
    """The highest tension of all runs, or at rest where nothing was run."""

    value: float
    line: str
    level: str
    run: str
    time: float
    model: str
    #: Highest tensions of the realisations of its sea, whose mean is the value; of none where there is one run.
    scatter: Array = field(default_factory=lambda: np.zeros(0))
    #: One of line, part and net: what ``line`` names.
    kind: str = "line"


def headlines_of(problem: NetworkProblem, groups: Mapping[str, xr.Dataset]) -> tuple[Headline, ...]:
    """Return the first page's numbers of a network.

    Parameters
    ----------
    problem : NetworkProblem
    groups : mapping of str to xarray.Dataset
        What was run, by its place in the result.
    """
    # a run of which nothing counts does not hand its number to the rest
    timed = any(_levels(groups, "dynamic"))
    peaks = list(_peaks(groups)) if timed else list(_rest_peaks(groups))
    widths = _net_widths(groups)
    nets = [one for one in peaks if one.line in widths]
    every, peaks = peaks, [one for one in peaks if one.line not in widths]
    peak = max(peaks, key=lambda item: item.value, default=None)
    items: list[Headline] = []
    if peak is not None:
        items += _tension(problem, groups, peak)
        # a smaller tension with a wider band may pass a limit that the highest one keeps
        each = [_tension(problem, groups, one)[0] for one in peaks]
        others, first = all_judged(each)[1:], items[0]
        items += [one for one in others if unfavourable(one) > unfavourable(first) or one.bound != first.bound]
        items += _failing(each, [one for one in items if one.name == first.name])
        items += start_headlines(groups, peak.value)
        items += _utilisation(problem, groups, [*peaks, *(_part_peaks(groups, timed))])
    items += _net_tension(problem, groups, nets, widths)
    items += _anchor(groups, every) if timed else rest_headlines(groups, single_anchors(problem), REST)
    items += held_headlines(problem, groups, DYNAMIC if timed else REST)
    items += _offsets(groups, single_anchors(problem))
    items += mode_headlines(groups)
    around = problem.environment
    loaded = around.sea_states or around.current is not None or problem.current_field is not None
    left = [_OTHER_DIRECTIONS if loaded else _NOT_JUDGED] if problem.lines and every else []
    shown = [item for item in items if item.shown][:8]
    return (*(item for item in items if item in shown or not item.shown), *left)


def _net_widths(groups: Mapping[str, xr.Dataset]) -> dict[str, float]:
    """Return the width of netting that a bar stands for, by net whose bars gather twines [m]."""
    found: dict[str, float] = {}
    for _, network in _levels(groups, "network"):
        if "net_strip" in network:
            pairs = zip(network["net"].values, network["net_strip"].values, strict=True)
            found |= {str(name): float(width) for name, width in pairs if math.isfinite(width)}
    return found


def _net_tension(
    problem: NetworkProblem, groups: Mapping[str, xr.Dataset], peaks: list[_Peak], widths: Mapping[str, float]
) -> list[Headline]:
    """Return the highest tension of nets whose bars gather twines, over the width of netting that carries it.

    That of a bar is as much as the mesh makes it: a limit in newton says nothing of it.
    """
    items = []
    for peak in peaks:
        band, said, bound = _band(groups, peak)
        width, doubtful = widths[peak.line], _unchecked(said)
        strip = f"{spoken(peak.value, 'N', 3)} in a strip of {width:.3g} m, which one bar of the model gathers"
        items.append(
            Headline(
                "net_tension", "highest tension of a net over its width", peak.value / width, "N/m",
                _where(groups, peak), peak.model, None if band is None else band.scaled(1.0 / width), bound,
                detail="; ".join(filter(None, (strip, *said))), part=peak.line, bound_by=doubtful,
            )
        )  # fmt: skip
    asked = {criterion.headline for criterion in problem.criteria}
    found = all_judged(items)
    if found and "line_tension" in asked and "net_tension" not in asked:
        text = "tension of nets is per metre of width, greatest_net_tension limits it"
        found.append(Headline("line_tension", "highest tension", math.nan, "1", text=text, shown=False))
    return found


def _levels(groups: Mapping[str, xr.Dataset], part: str) -> Iterator[tuple[str, xr.Dataset]]:
    for path, group in groups.items():
        pieces = path.strip("/").split("/")
        if len(pieces) == 2 and pieces[1] == part:
            yield pieces[0], group


def _peaks(groups: Mapping[str, xr.Dataset]) -> Iterator[_Peak]:
    """Yield the highest tension of every line and net in every run."""
    for level, summary in _levels(groups, "dynamic"):
        for run in (str(name) for name in summary["run"].values):
            for line in (str(name) for name in summary["line"].values) if "line_tension_maximum" in summary else ():
                value, time = (
                    float(summary[key].sel(run=run, line=line)) for key in ("line_tension_maximum", "peak_time")
                )
                if math.isfinite(value):
                    yield _peak_of(summary, ("line", line), (level, run), value, time)
            series = groups.get(f"/{level}/time/{run}")
            if series is None or "net_tension" not in series:
                continue
            late = series.isel(time=series["time"].values >= series["time"].values[0] + series.attrs["skip"])
            for net in (str(name) for name in series["net"].values):
                record = late["net_tension"].sel(net=net).values
                if record.size and np.isfinite(record).any():
                    at = int(np.nanargmax(record))
                    time = float(late["time"].values[at])
                    yield _peak_of(summary, ("net", net), (level, run), float(record[at]), time)


def _peak_of(summary: xr.Dataset, of: tuple[str, str], at: tuple[str, str], value: float, time: float) -> _Peak:
    """Return the highest tension of a line or net in a run: the mean over the realisations of its sea, if there are."""
    kind, name = of
    scatter = scatter_of(summary, f"{kind}_tension_maximum_of_realisation", at[1], **{kind: name})
    if scatter.size:
        value, time = float(scatter.mean()), math.nan
    return _Peak(value, name, *at, time, DYNAMIC, scatter, kind)


def _part_peaks(groups: Mapping[str, xr.Dataset], timed: bool) -> Iterator[_Peak]:
    """Yield the highest tension of every part of lines whose parts differ in strength, in every run or at rest."""
    for level, found in _levels(groups, "dynamic" if timed else "statics"):
        if "part_tension_maximum" not in found:
            continue
        axis = "run" if timed else "condition"
        for run in (str(name) for name in found[axis].values):
            for part in (str(name) for name in found["part"].values):
                here = found.sel({axis: run, "part": part})
                value = float(here["part_tension_maximum"])
                if not math.isfinite(value):
                    continue
                if timed:
                    yield _peak_of(found, ("part", part), (level, run), value, float(here["part_peak_time"]))
                else:
                    yield _Peak(value, part, level, run, math.nan, REST, kind="part")


def _rest_peaks(groups: Mapping[str, xr.Dataset]) -> Iterator[_Peak]:
    """Yield the highest tension of every line and net at rest."""
    for level, rest in _levels(groups, "statics"):
        for kind in ("line", "net"):
            if f"{kind}_tension_maximum" not in rest:
                continue
            for condition in (str(name) for name in rest["condition"].values):
                for name in (str(name) for name in rest[kind].values):
                    value = float(rest[f"{kind}_tension_maximum"].sel({"condition": condition, kind: name}))
                    if math.isfinite(value):
                        yield _Peak(value, name, level, condition, math.nan, REST, kind=kind)


def _where(groups: Mapping[str, xr.Dataset], peak: _Peak) -> str:
    time = f"t = {peak.time:.2f} s" if math.isfinite(peak.time) else ""
    return _place(groups, peak.level, peak.line, peak.run, time)


def _place(groups: Mapping[str, xr.Dataset], level: str, *words: str) -> str:
    """Return where a number is found, with the water level where there are several."""
    several = len({level for level, _ in _levels(groups, "network")}) > 1
    return ", ".join(part for part in (*words, level if several else "") if part)


def _tension(problem: NetworkProblem, groups: Mapping[str, xr.Dataset], peak: _Peak) -> list[Headline]:
    """Return the highest tension, with that at the ends of its line where that is less."""
    where = _where(groups, peak)
    band, details, bound = _band(groups, peak)
    if peak.model == REST:
        return [
            Headline(
                "line_tension", "highest tension at rest", peak.value, "N", where, REST, band, bound,
                detail="; ".join(details), part=peak.line, bound_by=_unchecked(details),
            )
        ]  # fmt: skip
    summary = groups[f"/{peak.level}/dynamic"].sel(run=peak.run)
    series = groups[f"/{peak.level}/time/{peak.run}"].attrs
    model = f"{DYNAMIC}, {series['theory']}" if math.isfinite(float(series["wave_height"])) else DYNAMIC
    items = [
        Headline(
            "line_tension", "highest tension", peak.value, "N", where, model, band, bound,
            detail="; ".join(part for part in details if part), part=peak.line, bound_by=_unchecked(details),
        )
    ]  # fmt: skip
    if "start_peak" in summary and peak.line in summary["line"].values:
        ends = [float(summary[key].sel(line=peak.line)) for key in ("start_peak", "end_peak")]
        if float(summary["line_tension_maximum"].sel(line=peak.line)) > INSIDE * max(ends):
            at = "start" if ends[0] >= ends[1] else "end"
            items.append(
                Headline(
                    "end_tension", "highest at the ends of its line", max(ends), "N", f"{peak.line}, its {at}", DYNAMIC,
                    detail="the highest tension is inside the line",
                )
            )  # fmt: skip
    return items


def _utilisation(problem: NetworkProblem, groups: Mapping[str, xr.Dataset], peaks: list[_Peak]) -> list[Headline]:
    """Return the highest tension over the breaking load, each line with its own band."""
    breaking, types = problem.strengths, _types_of_parts(problem)
    items, bare = [], [name for line in problem.lines for name in line.without_strength]
    for item in peaks:
        load = breaking.get(item.line)
        if load is None:
            continue
        band, said, bound = _band(groups, item)
        doubtful = _unchecked(said)
        one = Headline(
            "line_utilisation", "highest tension over breaking load", item.value / load, "1",
            _place(groups, item.level, item.line, item.run), item.model,
            None if band is None else band.scaled(1.0 / load), bound, mean=_mean(groups, item, load),
            detail="; ".join(
                filter(None, (types.get(item.line, ""), f"breaking load {load / 1e3:.4g} kN, without a safety factor",
                              doubtful))
            ),
            part=item.line, bound_by=doubtful,
        )  # fmt: skip
        items.append(one)
    found = all_judged(items)
    found += _failing(items, found)
    if found and bare:
        # one that is not known stays open beside those that keep the limit
        label, text = "highest tension over breaking load", f"{NO_STRENGTH} {', '.join(bare)}"
        found.append(Headline("line_utilisation", label, math.nan, "1", text=text, shown=False))
        found[0] = replace(found[0], detail=f"{found[0].detail}; {text}")
    return found


def _types_of_parts(problem: NetworkProblem) -> dict[str, str]:
    """Return words for the parts of lines whose parts differ in strength: of what type, and what they carry."""
    return {
        name: f"{part.bar_type.name}, its own highest tension"
        for line in problem.lines
        for number, part in enumerate(line.parts, start=1)
        if (name := f"{line.name} part {number}") in line.strengths
    }  # fmt: skip


def _failing(items: list[Headline], found: list[Headline]) -> list[Headline]:
    """Return of each other line or anchor the worst, for the one who strengthens that which decides."""
    known, more = {(one.part, one.where) for one in found if one.role != "weighed"}, []
    for part in dict.fromkeys(one.part for one in items):
        worst = max(governing(one for one in items if one.part == part), key=unfavourable, default=None)
        if worst is not None and (part, worst.where) not in known:
            more.append(replace(worst, shown=False, role="failing"))
    return more


def _unchecked(said: list[str]) -> str:
    """Return of what is said of a tension why it is a bound and what helps, empty where mesh and seed are enough."""
    helps = (REMEDY, FINER, SNAPS_OF_ONE_SEED, MORE_SEEDS, ONE_BY_ONE)
    words = [one for one in said if one.startswith((UNCHECKED, MESH_UNCHECKED, MESH_MOVES)) or one in helps]
    return "; ".join(words) if any(one in helps for one in words) else ""


def _mean(groups: Mapping[str, xr.Dataset], peak: _Peak, load: float) -> float | None:
    """Return the mean tension of a line over time, over its breaking load; at rest it is the tension."""
    if peak.model == REST:
        return peak.value / load
    summary = groups.get(f"/{peak.level}/dynamic")
    key = f"{peak.kind}_tension_mean"
    if summary is None or key not in summary:
        return None
    found = float(summary[key].sel({"run": peak.run, peak.kind: peak.line})) / load
    return found if math.isfinite(found) else None


def _band(groups: Mapping[str, xr.Dataset], peak: _Peak) -> tuple[Band | None, list[str], Bound]:
    """Return what mesh, step and the chance of one seed do to a tension, what is to be said of it, and what it proves.

    A record too short to show its chance, or one seed in which a line snaps, can break a limit and cannot keep one.
    """
    if peak.model == REST:
        band, settled = _rest_band(groups, peak)
        return band, [] if settled else unsettled_mesh(band), "" if settled else "at least"
    summary = groups[f"/{peak.level}/dynamic"].sel(run=peak.run)
    band, details, unproven = numerical_band(summary, peak.run, peak.line, peak.value, bool(peak.scatter.size))
    band = with_seeds(peak.value, band, peak.scatter)
    found, words = (None, []) if peak.scatter.size else of_record(groups, peak.level, peak.run, peak.line)
    details += words
    open_end, why = _left_open(groups, peak.level, peak.run, peak.scatter)
    chaos = one_seed_of_snaps(groups, peak.level, peak.run, peak.scatter)
    open_end, why = ("at least", [*why, *chaos]) if chaos else (open_end, why)
    details += why
    if found is None:
        alone = not peak.scatter.size and irregular(groups, peak.level, peak.run)
        return band, [*details, *([ONE_SEED] if alone else [])], "at least" if alone else open_end or unproven
    of_sea = irregular(groups, peak.level, peak.run)
    return with_chance(peak.value, band, found, of_sea), details, open_end or unproven


def _left_open(groups: Mapping[str, xr.Dataset], level: str, run: str, scatter: Array) -> tuple[Bound, list[str]]:
    """Return what a run proves that is too short, or still on its way to its place, and what is to be said of it."""
    moving = unsettled(groups, level, run)
    length, bound = length_of(groups, level, run, scatter)
    return "at least" if moving else bound, [words for words in (length, moving) if words]


def mesh_checked(groups: Mapping[str, xr.Dataset]) -> bool:
    """Whether the mesh of every run through time was checked, or of the rest where nothing was run."""
    runs = [summary for _, summary in _levels(groups, "dynamic")]
    if runs:
        return all("sensitivity_peak" in run and np.isfinite(run["sensitivity_peak"].values).all() for run in runs)
    return all(_rest_band(groups, peak)[1] for peak in _rest_peaks(groups))


def _rest_band(groups: Mapping[str, xr.Dataset], peak: _Peak) -> tuple[Band | None, bool]:
    """Return the band of a tension at rest, and whether finer meshes settle it."""
    rest, network = (groups[f"/{peak.level}/{part}"] for part in ("statics", "network"))
    return band_at_rest(rest, network, f"{peak.kind}_tension_of_mesh", peak.run, **{peak.kind: peak.line})


def _anchor(groups: Mapping[str, xr.Dataset], peaks: list[_Peak]) -> list[Headline]:
    """Return the largest pull on a fixed point with its parts and its own band."""
    found = []
    for level, summary in _levels(groups, "dynamic"):
        network = groups[f"/{level}/network"]
        fixed = [str(n) for n, kind in zip(network["point"].values, network["point_kind"].values) if kind == "fixed"]
        if "point_load_maximum" not in summary:
            continue
        for run in (str(name) for name in summary["run"].values):
            mine = [peak for peak in peaks if (peak.level, peak.run) == (level, run)]
            most = max(mine, key=lambda peak: peak.value, default=None)
            for point in fixed:
                row = summary.sel(run=run, point=point)
                value = float(row["point_load_maximum"])
                if not math.isfinite(value):
                    continue
                parts = [float(row["point_horizontal_load_maximum"]), float(row["point_upward_load_maximum"])]
                each = "point_load_maximum_of_realisation"
                scatter = scatter_of(summary, each, run, point=point, measure="size")
                own, bound = _band_of_pull(groups, (level, run, point), value, most, scatter)
                if scatter.size:
                    value, *parts = (
                        float(scatter_of(summary, each, run, point=point, measure=measure).mean())
                        for measure in ("size", "horizontal", "upwards")
                    )
                said = f"horizontal {parts[0] / 1e3:.3g} kN, upwards {parts[1] / 1e3:.3g} kN, each at its own largest"
                if not parts[1] > 0.0:
                    said = f"horizontal {parts[0] / 1e3:.3g} kN at its largest, never upwards"
                open_end, why = _left_open(groups, level, run, scatter)
                chaos = one_seed_of_snaps(groups, level, run, scatter)
                open_end, doubtful = "at least" if chaos else open_end, ""
                if bound == "at least":
                    words = [UNCHECKED, REMEDY] if most is None else _band(groups, most)[1]
                    doubtful = _unchecked(words)
                    if not doubtful and own is not None and own.of.startswith(PROPORTION):
                        doubtful = PULL_UNCHECKED
                doubtful = "; ".join(dict.fromkeys(filter(None, [doubtful, *chaos])))
                bound, said = open_end or bound, "; ".join(dict.fromkeys(filter(None, [said, *why, doubtful])))
                one = Headline(
                    "point_load", "largest pull on a fixed point", value, "N", _place(groups, level, point, run),
                    DYNAMIC, own, bound, detail=said, part=point, bound_by=doubtful,
                )  # fmt: skip
                found.append(one)
    kept = all_judged(found)
    return [*kept, *_failing(found, kept)]


def _band_of_pull(
    groups: Mapping[str, xr.Dataset],
    at: tuple[str, str, str],
    value: float,
    most: _Peak | None,
    scatter: Array | None = None,
) -> tuple[Band | None, Bound]:
    """Return what mesh, step and chance do to the pull on a fixed point: ``at`` level, run and name.

    Where the runs that check the mesh did not find it, the mesh moves it as it moves the highest tension.
    """
    level, run, point = at
    summary = groups[f"/{level}/dynamic"].sel(run=run)
    mesh: Band | None = None
    unproven: Bound = "at least"
    if most is not None:
        mesh, _, unproven = numerical_band(summary, run, most.line, most.value, bool(most.scatter.size))
    finer = [value, *(float(summary[key].sel(point=point)) if key in summary else math.nan for key in LOADS_AGAIN)]
    own: Band | None = None
    if all(map(math.isfinite, finer[1:3])):
        own, unproven = mesh_and_step(value, finer, bool(summary.attrs.get("finer_nets"))), ""
        if mesh is not None and most is not None and most.value > 0.0 and _coarse(groups, level, most.line):
            # where a coarse line meets the bed hangs on its nodes: twice of them may change the pull little by chance
            ends = [value * end / most.value for end in (mesh.low, mesh.high)]
            words = f"{own.of}; as the tension of {most.line}, whose segments are few"
            own = Band(min(own.low, *ends), max(own.high, *ends), words)
    elif mesh is not None and most is not None and most.value > 0.0:
        low, high = (value * end / most.value for end in (mesh.low, mesh.high))
        own = Band(low, high, f"mesh and step: in proportion to the tension of {most.line}")
        if LANDING in str(summary.attrs.get(f"doubt {run}", "")):
            # segments that land move a pull by another part than the highest tension
            unproven = "at least"
    if scatter is not None and scatter.size:
        mean = float(scatter.mean())
        return with_seeds(mean, None if own is None else own.scaled(mean / value), scatter), unproven
    series = groups.get(f"/{level}/time/{run}")
    if series is None:
        return own, unproven
    of_sea = irregular(groups, level, run)
    chance, of_what = of_pull(groups, level, run, series, point)
    if chance is None:
        return own, "at least" if of_sea else unproven
    wider = with_chance(value, own, chance, of_sea)
    return replace(wider, of="; ".join(filter(None, (wider.of, of_what)))), unproven


def _coarse(groups: Mapping[str, xr.Dataset], level: str, line: str) -> bool:
    """Whether a line has few segments."""
    network = groups.get(f"/{level}/network")
    if network is None or "line_segments" not in network or line not in network["line"].values:
        return False
    return int(network["line_segments"].sel(line=line)) <= COARSE


def _offsets(groups: Mapping[str, xr.Dataset], anchors: Mapping[str, str]) -> list[Headline]:
    """Return the largest offset of bodies, buoys and weights, and the largest lean of bodies.

    On one anchor alone the place in still water is where the case draws it: the distance from the anchor counts.
    """
    offsets, leans = [], []
    still = "from its place in still water"
    for level, summary in _levels(groups, "dynamic"):
        network = groups.get(f"/{level}/network")
        for run in summary["run"].values:
            if "point_excursion" in summary and network is not None:
                for point, kind in zip(network["point"].values, network["point_kind"].values):
                    if kind not in ("fixed", "driven"):
                        value = float(summary["point_excursion"].sel(run=run, point=point))
                        at = (level, str(run), str(point), "point")
                        found = _offset(groups, at, value, f"{still}, heave included", 3, anchors)
                        offsets.append(
                            with_mesh_of_rest(found, groups, level, "point", str(point), anchors.get(str(point)))
                        )
            for solid in summary["solid"].values if "largest_offset" in summary else ():
                value, lean = (
                    float(summary[name].sel(run=run, solid=solid)) for name in ("largest_offset", "highest_lean")
                )
                at = (level, str(run), str(solid), "solid")
                found = _offset(groups, at, value, still, 2, anchors)
                offsets.append(with_mesh_of_rest(found, groups, level, "solid", str(solid), anchors.get(str(solid))))
                where = _place(groups, level, str(solid), str(run))
                leans.append(_moved("lean", lean, where, still, groups, level, str(run), None))
    return [
        item
        for kept in (offsets, leans)
        for item in all_judged(one for one in kept if math.isfinite(one.value))
    ]  # fmt: skip


def _offset(
    groups: Mapping[str, xr.Dataset], at: tuple[str, str, str, str], value: float, said: str, axes: int,
    anchors: Mapping[str, str],
) -> Headline:  # fmt: skip
    """Return the offset of a point or body: ``at`` level, run, name and kind."""
    level, run, name, kind = at
    away = _away(groups, level, run, name, kind, axes)
    swinging = _swinging(groups, level, run, name, kind, anchors)
    value, said, away = swinging or (value, said, away)
    scatter = np.zeros(0)
    if kind == "point":
        of = "point_excursion" if swinging is None else "distance_from_anchor"
        scatter = scatter_of(groups[f"/{level}/dynamic"], f"{of}_of_realisation", run, point=name)
    if scatter.size:
        value = float(scatter.mean())
        found = _moved("offset", value, _place(groups, level, name, run), said, groups, level, run, None)
        open_end, why = _left_open(groups, level, run, scatter)
        return replace(found, band=with_seeds(value, None, scatter), bound=open_end, detail="; ".join([said, *why]))
    return _moved("offset", value, _place(groups, level, name, run), said, groups, level, run, away)


def _swinging(
    groups: Mapping[str, xr.Dataset], level: str, run: str, name: str, kind: str, anchors: Mapping[str, str]
) -> tuple[float, str, Array] | None:
    """Return the largest horizontal distance from the only anchor, its words and series; None with more anchors."""
    anchor, series = anchors.get(name), groups.get(f"/{level}/time/{run}")
    if anchor is None or series is None or f"{kind}_position" not in series:
        return None
    if "point_position" not in series or anchor not in series["point"].values:
        return None
    place = series[f"{kind}_position"].sel({kind: name}).values - series["point_position"].sel(point=anchor).values
    away = np.asarray(np.linalg.norm(place[:, :2], axis=1))
    counted = away[series["time"].values >= series["time"].values[0] + series.attrs["skip"]]
    if not counted.size:
        return None
    return float(counted.max()), f"horizontal distance from its only anchor '{anchor}', round which it swings", away


def _moved(
    name: str, value: float, where: str, detail: str, groups: Mapping[str, xr.Dataset], level: str, run: str,
    away: Array | None,
) -> Headline:  # fmt: skip
    """Return an offset or lean with the chance of its seed or of a motion that does not repeat.

    Of an irregular sea it is a bound where that is not known.
    """
    label, unit = {"offset": ("largest offset of a body or buoy", "m"), "lean": ("largest lean", "rad")}[name]
    series = groups.get(f"/{level}/time/{run}")
    band: Band | None = None
    bound: Bound = ""
    open_end, why = _left_open(groups, level, run, np.zeros(0))
    detail = "; ".join([detail, *why])
    of_sea = irregular(groups, level, run)
    found = None if series is None or away is None else chance_of(series, away, as_tension=True)
    if found is not None:
        low, high = found.range
        band = Band(max(min(value, low), 0.0), max(value, high), of_seeds(found, of_sea))
    elif of_sea:
        bound, detail = "at least", f"{detail}; {ONE_SEED}"
    return Headline(name, label, value, unit, where, DYNAMIC, band, bound or open_end, detail=detail)


def _away(groups: Mapping[str, xr.Dataset], level: str, run: str, name: str, kind: str, axes: int) -> Array | None:
    """Return the distance of a point or body from its place in still water over a run; None where it is not known."""
    series, summary = groups.get(f"/{level}/time/{run}"), groups[f"/{level}/dynamic"]
    origin = "still_place" if kind == "point" else "still_place_of_solid"
    if series is None or origin not in summary or f"{kind}_position" not in series:
        return None
    place = series[f"{kind}_position"].sel({kind: name}).values - summary[origin].sel({kind: name}).values
    return np.asarray(np.linalg.norm(place[:, :axes], axis=1))
