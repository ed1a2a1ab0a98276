"""Highest tensions of events on two meshes: what counts, what it varies with, and whether the mesh carries it."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from moyai.core.arrays import Array
from moyai.core.validity import Notice
from moyai.core.wording import spoken
from moyai.series.intervals import reach_of_mean

if TYPE_CHECKING:
    import xarray as xr

#: Components of the whole span and their columns in the table of runs
COMPONENTS: Mapping[str, str] = {
    "upper cable": "upper_peak",
    "lower cable": "lower_peak",
    "skirt": "skirt_peak",
    "anchor line": "anchor_peak",
}
#: Change of a tension from one mesh to the other, over the larger, beyond which the mesh does not carry it [-]
MESH_CHANGE = 0.2


#: What the growth of a tension with the cells is continued to, over the cells of the finest mesh: some 0.2 m, the
#: spacing of eyelets, within which seams bear and not the sheet; and its steepest power, that near a point load.
SMALLER, STEEPEST = 4.0, 1.0


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


@dataclass(frozen=True)
class EventPeak:
    """Highest tension of a component in an event."""

    #: Larger of the means over the realisations on each mesh that resolves the event [N, N/m].
    value: float
    #: ``low``, ``high``: Lowest and highest of all runs.
    low: float
    #: See ``low``.
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
    #: Judged end as the change from mesh to mesh goes on: of the skirt to cells :data:`SMALLER` times smaller, of
    #: cables and lines at first order [N, N/m].
    ceiling: float = math.nan

    @property
    def at_least(self) -> bool:
        """Whether smaller cells or other realisations would give more: the value is a bound from below."""
        return self.alone or (self.change > MESH_CHANGE and self.finer_is_more)


def event_peak(samples: Sequence[EventSample], event: str, component: str) -> EventPeak | None:
    """Return the highest tension of a component in an event; None where it bears none.

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
    found = EventPeak(
        mean[counting], float(every.min()), float(every.max()), judged,
        by_mesh[counting][0].run, alone=own.size == 1 and by_mesh[counting][0].seed != 0,
    )  # fmt: skip
    if len(meshes) < 2:
        return found
    first, last = means[0], means[-1]
    grown = SMALLER ** min(_growth(meshes, means), STEEPEST) if component == "skirt" else _of_resultant(meshes, means)
    return EventPeak(
        found.value, found.low, found.high, found.judged, found.run,
        1.0 - min(first, last) / max(first, last), last > first, (first, last), found.alone,
        math.nan if found.alone else found.judged * grown,
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


def ceiling_of(table: xr.Dataset, component: str) -> float:
    """Return the highest end that the growth with the cells leads to over all events; NaN where a mesh is missing."""
    if "event_peak_ceiling" not in table:
        return math.nan
    ends = table["event_peak_ceiling"].sel(span_component=component).values
    bears = table["event_peak"].sel(span_component=component).values > 0.0
    known = np.where(np.isnan(ends), table["event_peak_judged"].sel(span_component=component).values, ends)
    return float(known[bears].max()) if bears.any() else math.nan


def mesh_notices(found: Mapping[str, tuple[str, EventPeak]]) -> tuple[Notice, ...]:
    """Return a warning for components whose governing tension moves with the mesh beyond :data:`MESH_CHANGE`."""
    apart = {name: item for name, item in found.items() if item[1].change > MESH_CHANGE}
    if not apart:
        return ()
    units = {"skirt": "N/m"}
    said = "; ".join(
        f"{name} in '{event}' {spoken(peak.means[0], units.get(name, 'N'), 3)} on the coarser mesh, "
        f"{spoken(peak.means[1], units.get(name, 'N'), 3)} on the finer"
        + (", so that the number is a bound from below" if peak.at_least else ", and the larger counts")
        for name, (event, peak) in apart.items()
    )
    return (
        Notice(
            "span-mesh",
            f"peaks of the whole span move with the mesh, in the realisations that both have: {said}",
            max(peak.change for _, peak in apart.values()),
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
    "mesh_notices",
]
