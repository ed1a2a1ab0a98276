"""Highest tensions of events on two meshes: what counts, what it varies with, and whether the mesh carries it."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from moyai.core.arrays import Array
from moyai.core.validity import Notice
from moyai.core.wording import spoken
from moyai.series.block_maxima import PERIODS, maximum_of
from moyai.series.intervals import reach_of_mean, student_quantile

if TYPE_CHECKING:
    import xarray as xr

#: Components of the whole span and their columns in the table of runs
COMPONENTS: Mapping[str, str] = {
    "upper cable": "upper_peak",
    "lower cable": "lower_peak",
    "skirt": "skirt_peak",
    "anchor line": "anchor_line_tension_maximum",
}
#: Change of a tension from one mesh to the other, over the larger, beyond which the mesh does not carry it [-]
MESH_CHANGE = 0.2
#: Part by which the highest values of periods may differ where a motion in regular waves repeats [-]
REPEATING = 0.05

#: What the growth of a tension with the cells is continued to, over the cells of the finest mesh: some 0.2 m, the
#: spacing of eyelets, within which seams carry and not the sheet; and its steepest power, that near a point load.
SMALLER, STEEPEST = 4.0, 1.0
#: What a tension may grow by from the coarsest mesh of the default runs to the next: in ordinary curtains up to 1.7 for
#: cables and lines and 2.9 for sheets, both in the snap of a release.
COARSE_GROWTH: Mapping[str, float] = {"upper cable": 2.0, "lower cable": 2.0, "skirt": 3.0, "anchor line": 2.0}


@dataclass(frozen=True)
class EventSample:
    """One run of an event, on a mesh and with a realisation of its sea."""

    #: What is run: a sea, a period of regular waves, the snap.
    event: str
    #: Name of the run whose series are kept of this event and mesh.
    run: str
    #: Cells along and down.
    mesh: tuple[int, int]
    #: Of the sea; 0 where there is no chance in it.
    seed: int
    #: Highest tension by component [N, N/m].
    peaks: Mapping[str, float]
    #: Event whose scatter over realisations and growth with the cells are this one's, where it is not run as often.
    like: str = ""
    #: By component: largest of as many periods in 95 of 100 records, over the highest found [-]; 1 where they repeat.
    reach: Mapping[str, float] = field(default_factory=dict)


@dataclass(frozen=True)
class EventPeak:
    """Highest tension of a component in an event."""

    #: Larger of the means over the realisations on each mesh that resolves the event [N, N/m].
    value: float
    #: Lowest of all runs [N, N/m].
    low: float
    #: Highest of all runs [N, N/m].
    high: float
    #: Highest upper end of the one-sided 95 % intervals of the means; the value where there is one realisation.
    judged: float
    #: Run of which series are kept, of the mesh that counts.
    run: str
    #: From one mesh to the other with the same realisations, over the larger mean; 0 with one mesh.
    change: float = 0.0
    #: Whether the finer mesh gives the larger mean.
    finer_is_more: bool = False
    #: Of both meshes with the same realisations, the coarser first; empty with one mesh.
    means: tuple[float, ...] = ()
    #: Whether it is of one realisation of a random sea.
    alone: bool = False
    #: Judged end as the change from mesh to mesh continues: of the skirt to cells :data:`SMALLER` times smaller, of
    #: cables and lines at first order [N, N/m]; infinite where one realisation leaves it open, NaN with one mesh.
    ceiling: float = math.nan

    @property
    def at_least(self) -> bool:
        """Whether smaller cells or other realisations would give more: the value is a bound from below."""
        return self.alone or (self.change > MESH_CHANGE and self.finer_is_more)

    @property
    def end(self) -> float:
        """Where it is judged: of a bound from below where its growth continues to."""
        return self.ceiling if self.at_least else self.judged

    @property
    def open(self) -> str:
        """What leaves it open upwards: ``one realisation``, ``mesh``, or nothing."""
        return ("one realisation" if self.alone else "mesh") if self.at_least else ""


def event_peak(samples: Sequence[EventSample], event: str, component: str) -> EventPeak | None:
    """Return the highest tension of a component in an event; None where it carries none.

    Parameters
    ----------
    samples : sequence of Sample
    event, component : str

    Notes
    -----
    Of three meshes the coarsest is left out where the two finer ones differ less than it does from the next.
    """
    mine = [item for item in samples if item.event == event and item.peaks[component] > 0.0]
    meshes = sorted({item.mesh for item in mine})
    if not meshes:
        return None
    by_mesh = {mesh: [item for item in mine if item.mesh == mesh] for mesh in meshes}
    means = _shared_means(by_mesh, component)
    if len(meshes) == 3 and abs(means[2] - means[1]) < abs(means[1] - means[0]):
        # the two finer meshes come nearer to each other: the coarsest does not resolve the event
        del by_mesh[meshes[0]]
        meshes, means = meshes[1:], means[1:]
        mine = [item for item in mine if item.mesh in by_mesh]
    mean = {mesh: float(np.mean(_peaks(items, component))) for mesh, items in by_mesh.items()}
    counting = max(meshes, key=lambda mesh: mean[mesh])
    every, own = _peaks(mine, component), _peaks(by_mesh[counting], component)
    # the sea is the same on every mesh: most realisations tell how far they scatter
    most = _peaks(max(by_mesh.values(), key=len), component)
    # the interval of a mesh with the smaller mean and fewer realisations may reach higher
    judged = max(mean[mesh] + reach_of_mean(_peaks(items, component), alike=most) for mesh, items in by_mesh.items())
    judged = max([judged, *(item.peaks[component] * item.reach.get(component, 1.0) for item in mine)])
    found = EventPeak(
        mean[counting], float(every.min()), float(every.max()), judged,
        by_mesh[counting][0].run, alone=own.size == 1 and by_mesh[counting][0].seed != 0,
    )  # fmt: skip
    like = event_peak(samples, mine[0].like, component) if mine[0].like else None
    if like is not None:
        return _alike(found, like, own, [item for item in samples if item.event == mine[0].like], component)
    if len(meshes) < 2:
        return replace(found, ceiling=math.inf if found.alone else math.nan)
    first, last = means[0], means[-1]
    grown = SMALLER ** min(_growth(meshes, means), STEEPEST) if component == "skirt" else _of_resultant(meshes, means)
    return EventPeak(
        found.value, found.low, found.high, found.judged, found.run,
        1.0 - min(first, last) / max(first, last), last > first, (first, last), found.alone,
        math.inf if found.alone else found.judged * grown,
    )  # fmt: skip


def _alike(found: EventPeak, like: EventPeak, own: Array, runs: Sequence[EventSample], component: str) -> EventPeak:
    """Return a peak with the scatter and the growth of another event, which was run more often and on more meshes.

    One realisation lies at most so far below the mean as Student's value gives for the scatter of the others, which
    are as many as there are on the mesh that has most.
    """
    by_mesh: dict[tuple[int, int], list[EventSample]] = {}
    for item in runs:
        by_mesh.setdefault(item.mesh, []).append(item)
    others = _peaks(max(by_mesh.values(), key=len), component)
    reach = reach_of_mean(own, alike=others)
    if own.size == 1 and others.size > 1:
        reach = student_quantile(0.9, others.size - 1) * float(np.std(others, ddof=1) / others.mean() * own[0])
    judged = max(found.judged, found.value + reach)
    return replace(
        found, judged=judged, alone=found.alone and others.size < 2, change=like.change,
        finer_is_more=like.finer_is_more, ceiling=judged * like.ceiling / like.judged,
    )  # fmt: skip


def _of_resultant(meshes: Sequence[tuple[int, int]], means: Sequence[float]) -> float:
    """Return what the change between the two finest meshes, gone on with at first order, makes of a mean, at least 1.

    The tension of a cable or line is a resultant: it has a limit, where the stress of a sheet has none at a point.
    """
    (coarse, fine), (first, last) = meshes[-2:], means[-2:]
    ratio = max(fine[0] / coarse[0], fine[1] / coarse[1])
    return max(1.0, 1.0 + (last - first) / (last * (ratio - 1.0)))


def _growth(meshes: Sequence[tuple[int, int]], means: Sequence[float]) -> float:
    """Return the steepest power of the cells along by which the mean grows from mesh to mesh, at least 0."""
    steps = zip(meshes, meshes[1:], means, means[1:], strict=False)
    # meshes of few cells may differ in one direction alone
    return max(
        0.0,
        *(math.log(b / a) / math.log(max(fine[0] / coarse[0], fine[1] / coarse[1])) for coarse, fine, a, b in steps),
    )


def _shared_means(by_mesh: Mapping[tuple[int, int], Sequence[EventSample]], component: str) -> list[float]:
    """Return the mean on each mesh over the realisations that all of them have."""
    shared = set.intersection(*({item.seed for item in items} for items in by_mesh.values()))
    return [
        float(np.mean(_peaks([item for item in items if item.seed in shared], component))) for items in by_mesh.values()
    ]


def reach_of_periods(run: xr.Dataset, component: str) -> float:
    """Return the largest tension of as many periods in 95 of 100 records, over the highest found; 1 where they repeat.

    Parameters
    ----------
    run : Dataset
        A run in regular waves, of which the periods that count are taken as blocks of a record.
    component : str
    """
    period = float(run.attrs["period"])
    time = run["time"].values
    late = time >= float(run.attrs["counted_from"])
    reach = 1.0
    for row, line in enumerate(run["line"].values):
        if not str(line).startswith(component) or not late.any():
            continue
        values = run["line_tension_peak_since_row"].values[row][late]
        count = max(int((time[late][-1] - time[late][0]) / period + 1e-9), 1)
        highest = [float(part.max()) for part in np.array_split(values, count)]
        # blocks of one period each: their largest values are those of the chaotic motion, not of a sea
        found = maximum_of(time[late], values, period / PERIODS)
        if found is not None and max(highest) > 0.0 and min(highest) < (1.0 - REPEATING) * max(highest):
            reach = max(reach, found.range[1] / float(values.max()))
    return reach


def _peaks(samples: Sequence[EventSample], component: str) -> Array:
    return np.array([item.peaks[component] for item in samples])


def governing_peaks(samples: Sequence[EventSample]) -> dict[str, tuple[str, EventPeak]]:
    """Return of each component the event with its highest tension, and that tension."""
    events = list(dict.fromkeys(item.event for item in samples))
    found: dict[str, tuple[str, EventPeak]] = {}
    for component in COMPONENTS:
        known = [(event, peak) for event in events if (peak := event_peak(samples, event, component)) is not None]
        if known:
            found[component] = max(known, key=lambda item: item[1].value)
    return found


def leading_end(samples: Sequence[EventSample], component: str) -> tuple[str, EventPeak] | None:
    """Return the event of a component that is judged highest, each at its own end; None where none carries it.

    An event on the coarsest of several meshes alone has :data:`COARSE_GROWTH` of its judged value as its end.
    """
    ends = [
        (unresolved_end(samples, event, peak, component), event, peak)
        for event in dict.fromkeys(item.event for item in samples)
        if (peak := event_peak(samples, event, component)) is not None
    ]
    return max(ends, key=lambda item: item[0])[1:] if ends else None


def unresolved_end(samples: Sequence[EventSample], event: str, peak: EventPeak, component: str) -> float:
    """Return the end of a peak; on the coarsest mesh alone what its growth to the next may come to.

    An irregular sea grows with the cells as another one did, means over realisations of the same cloth, and by
    :data:`MESH_CHANGE` more; a snap and regular waves as far as any did.
    """
    mine = [item for item in samples if item.event == event]
    coarse = min(item.mesh for item in samples)
    if mine[0].like or any(item.mesh != coarse for item in mine) or not math.isfinite(peak.end):
        return peak.end
    growth = COARSE_GROWTH[component]
    if any(item.seed for item in mine):
        seas = dict.fromkeys(item.event for item in samples if item.seed)
        known = [other for sea in seas if (other := event_peak(samples, sea, component)) is not None and other.means]
        grown = max((other.means[-1] / other.means[0] for other in known), default=growth)
        growth = min(growth, max(grown, 1.0) / (1.0 - MESH_CHANGE))
    return peak.end * growth


def open_peaks(samples: Sequence[EventSample]) -> dict[str, tuple[str, EventPeak]]:
    """Return of each component the bound from below with the highest end, where no known event is judged as high."""
    found: dict[str, tuple[str, EventPeak]] = {}
    events = list(dict.fromkeys(item.event for item in samples))
    for component in COMPONENTS:
        known = [(event, peak) for event in events if (peak := event_peak(samples, event, component)) is not None]
        bounds = [item for item in known if item[1].at_least]
        highest = max((peak.judged for _, peak in known if not peak.at_least), default=-math.inf)
        worst = max(bounds, key=lambda item: item[1].end, default=None)
        if worst is not None and worst[1].end > highest:
            found[component] = worst
    return found


def highest_judged(samples: Sequence[EventSample], component: str) -> float:
    """Return the highest value over the events at which a component is judged."""
    events = dict.fromkeys(item.event for item in samples)
    return max(peak.judged for event in events if (peak := event_peak(samples, event, component)) is not None)


def event_variables(samples: Sequence[EventSample]) -> tuple[dict[str, Any], dict[str, Any]]:
    """Return variables and coordinates of the peaks: of every event, and of every run."""
    events = list(dict.fromkeys(item.event for item in samples))
    names = list(COMPONENTS)
    peaks = [[event_peak(samples, event, component) for component in names] for event in events]
    data: dict[str, Any] = {
        f"event_peak{suffix}": (
            ("event", "span_component"),
            [[np.nan if one is None else getattr(one, field) for one in row] for row in peaks],
        )
        for suffix, field in (("", "value"), ("_low", "low"), ("_high", "high"), ("_judged", "judged"),
                              ("_ceiling", "ceiling"),
                              ("_mesh_change", "change"))
    }  # fmt: skip
    data["event_peak_open"] = (
        ("event", "span_component"),
        [["" if one is None else one.open for one in row] for row in peaks],
    )
    data["event_realisations"] = ("event", [len({s.seed for s in samples if s.event == event}) for event in events])
    data["sample_peak"] = (("sample", "span_component"), [[item.peaks[name] for name in names] for item in samples])
    for name, values in (
        ("sample_event", [item.event for item in samples]),
        ("sample_cells", [f"{item.mesh[0]} by {item.mesh[1]}" for item in samples]),
        ("sample_seed", [item.seed for item in samples]),
    ):
        data[name] = ("sample", values)
    return data, {"event": events, "span_component": names}


def event_band(table: xr.Dataset, event: str, component: str) -> tuple[float, float, float, float, int]:
    """Return value, low, high, judged value and realisations of an event's peak, read from the table of runs."""
    row = table.sel(event=event, span_component=component)
    value, low, high, judged = (float(row[f"event_peak{end}"]) for end in ("", "_low", "_high", "_judged"))
    return value, low, high, judged, int(table["event_realisations"].sel(event=event))


def ceiling_of(table: xr.Dataset, event: str, component: str) -> float:
    """Return the end to which the growth of an event with the cells continues, or that of a known one that is higher.

    NaN where a mesh is missing; another event that is open has an end of its own.
    """
    if "event_peak_ceiling" not in table:
        return math.nan
    ceiling = float(table["event_peak_ceiling"].sel(event=event, span_component=component))
    still = open_events(table, component)
    names = [str(name) for name in table["event"].values if str(name) not in (event, *still)]
    known = [event_band(table, name, component)[3] for name in names]
    return ceiling if math.isnan(ceiling) else max([ceiling, *(end for end in known if math.isfinite(end))])


def open_events(table: xr.Dataset, component: str) -> list[str]:
    """Return the events that leave a component open upwards, read from the table of runs."""
    if "event_peak_open" not in table:
        return []
    words = table["event_peak_open"].sel(span_component=component)
    return [str(event) for event in table["event"].values if str(words.sel(event=event).values)]


def mesh_notices(
    found: Mapping[str, tuple[str, EventPeak]], behind: Mapping[str, tuple[str, EventPeak]] | None = None
) -> tuple[Notice, ...]:
    """Return a warning for components whose governing tension moves with the mesh beyond :data:`MESH_CHANGE`.

    ``behind`` are those that a smaller tension leaves open, as :func:`open_peaks` gives them.
    """
    every = [*found.items(), *(item for item in (behind or {}).items() if found.get(item[0]) != item[1])]
    apart = [(name, *item) for name, item in every if item[1].change > MESH_CHANGE and item[1].means]
    if not apart:
        return ()
    units = {"skirt": "N/m"}
    said = "; ".join(
        f"{name} in '{event}' {spoken(peak.means[0], units.get(name, 'N'), 3)} on the coarser mesh, "
        f"{spoken(peak.means[1], units.get(name, 'N'), 3)} on the finer"
        + (", so that the number is a bound from below" if peak.at_least else ", and the larger is used")
        for name, event, peak in apart
    )
    return (
        Notice(
            "span-mesh",
            f"peaks of the whole span move with the mesh, in the realisations that both have: {said}",
            max(peak.change for _, _, peak in apart),
            MESH_CHANGE,
            remedy="run 'dynamic' with more cells, or design with the bound of the upright plate",
            source="eq:curtain-hierarchy",
        ),
    )


__all__ = [
    "COMPONENTS",
    "MESH_CHANGE",
    "EventPeak",
    "EventSample",
    "event_band",
    "event_peak",
    "event_variables",
    "governing_peaks",
    "highest_judged",
    "leading_end",
    "mesh_notices",
    "open_events",
    "open_peaks",
    "reach_of_periods",
    "unresolved_end",
]
