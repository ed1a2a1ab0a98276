"""Peaks of the whole span where it is not asked for and an upright plate only bounds them [eq:curtain-hierarchy].

Every event is run on a coarse mesh; those that lead a component, or may lead it by what a finer mesh may add, are run
again on a finer one, those without chance on a third where the coarse one gives more by a fifth. Irregular seas are run
with several realisations, since the snaps of a motion that never repeats are chance: the larger of the means on the
meshes that resolve the event counts. Waves that lead are run in half the current too, in which the skirt hangs deeper,
with one realisation, with more where that may be judged higher than the waves in the current of the case.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

from moyai.core.errors import InputError
from moyai.core.progress import Progress
from moyai.core.validity import IdentityCheck, Notice
from moyai.sea.states import IrregularSea, SeaState
from moyai.structures.curtain.analyses.dynamic import DynamicAnswer, SpanLoad, through
from moyai.structures.curtain.analyses.event_peaks import (
    COMPONENTS,
    MESH_CHANGE,
    EventSample,
    event_variables,
    governing_peaks,
    highest_judged,
    leading_end,
    mesh_notices,
    open_peaks,
    reach_of_periods,
)
from moyai.structures.curtain.assembly import LevelCurtain
from moyai.structures.curtain.dynamic.checks import crumples, run_checks, run_notices
from moyai.structures.curtain.dynamic.groups import run_dataset, run_frames
from moyai.structures.curtain.dynamic.model import CurtainSpan, Mesh
from moyai.structures.curtain.dynamic.plans import Plan, plans_of
from moyai.structures.curtain.dynamic.span import span_of
from moyai.structures.curtain.hierarchy import CYCLES, IMPACT, hierarchy, role_of
from moyai.structures.curtain.model import CurtainSettings
from moyai.structures.curtain.variables import labelled

if TYPE_CHECKING:
    import xarray as xr

#: Part of the realisations of an irregular sea that the finer mesh is run with, three at least
_FINE_REALISATIONS = 0.6
#: Part of the current of the case that waves are run in as well.
_WEAKER_CURRENT = 0.5


def peaks_wanted(unit: LevelCurtain, settings: CurtainSettings) -> bool:
    """Return whether an upright plate was asked for and is only a bound, and the whole span was not asked for."""
    given, asked = settings.dynamic, set(settings.analyses)
    if given is None or not given.by_default or "dynamic" in asked or unit.curtain.skirt.length >= unit.water.depth:
        return False
    roles = hierarchy(unit, settings)
    return any(role_of(roles, model) == "bound" for model in (IMPACT, CYCLES))


def span_peaks(
    unit: LevelCurtain, settings: CurtainSettings, seas: tuple[SeaState, ...], progress: Progress
) -> DynamicAnswer | None:
    """Return the runs of the whole span that give the peaks, ``None`` where the case does not say enough for them.

    Parameters
    ----------
    unit : LevelCurtain
    settings : Settings
        Seas are run where ``waves`` is asked for, the snap in the current where ``impact`` is.
    seas : tuple of SeaState
    progress : Progress

    Notes
    -----
    Where one run stops or crumples none of them counts, and the bounds stay.
    """
    given = settings.dynamic
    assert given is not None
    try:
        span = span_of(unit, given)
        plans = plans_of(unit, settings, seas if "waves" in settings.analyses else (), span)
    except InputError:
        return None
    fine, coarse = (
        given.mesh,
        replace(given.mesh, along=_two_thirds(given.mesh.along), down=_two_thirds(given.mesh.down)),
    )
    drawn = {plan.name: ((0, plan),) for plan in plans} | _realisations(unit, settings, seas, span)
    found = _Runs(unit, settings, span, progress, sum(map(len, drawn.values())) + 2 * len(COMPONENTS))
    for plan in plans:
        if not found.event(drawn[plan.name], coarse):
            return found.stopped(plan)
    by_name = {plan.name: plan for plan in plans}
    while (event := found.unresolved(given.mesh)) is not None:
        name, mesh = event
        words = f", {mesh.along} by {mesh.down} cells"
        count = _fine_count(drawn[name])
        if not found.event(drawn[name][:count], mesh, words):
            return found.stopped(by_name[name])
    if unit.surface_speed > 0.0 and "waves" in settings.analyses:
        there = replace(unit, surface_speed=_WEAKER_CURRENT * unit.surface_speed)
        ends = [leading_end(found.samples, component) for component in COMPONENTS]
        leading = {event for event, _ in [*governing_peaks(found.samples).values(), *filter(None, ends)]}
        alone = plans_of(there, replace(settings, analyses=("waves",)), seas, span)
        weaker = {plan.name: ((0, plan),) for plan in alone} | _realisations(there, settings, seas, span)
        for name, several in weaker.items():
            if name in leading and not found.weaker(several, fine, f"{name}, current {there.surface_speed:.3g} m/s"):
                return found.stopped(several[0][1])
    return found.answer()


def _fine_count(drawn: Sequence[tuple[int, Plan]]) -> int:
    """Return how many realisations of an event the finer mesh is run with."""
    return max(3, math.ceil(_FINE_REALISATIONS * len(drawn)))


def _two_thirds(cells: int) -> int:
    return -(-2 * cells // 3)


def _four_thirds(cells: int) -> int:
    return -(-4 * cells // 3)


def _realisations(
    unit: LevelCurtain, settings: CurtainSettings, seas: tuple[SeaState, ...], span: CurtainSpan
) -> dict[str, tuple[tuple[int, Plan], ...]]:
    """Return the realisations of every irregular sea with their seeds, by the name of its run."""
    if "waves" not in settings.analyses:
        return {}
    alone = replace(settings, analyses=("waves",))
    return {
        sea.name: tuple(
            (seed, plans_of(unit, alone, (replace(sea, seed=seed),), span)[0])
            for seed in range(sea.seed, sea.seed + settings.waves.realisations)
        )
        for sea in seas
        if isinstance(sea, IrregularSea)
    }


class _Runs:
    """Runs that were made, with all that is kept of them."""

    def __init__(
        self, unit: LevelCurtain, settings: CurtainSettings, span: CurtainSpan, progress: Progress, expected: int
    ) -> None:
        self.unit, self.settings, self.span, self.progress, self.expected = unit, settings, span, progress, expected
        self.samples: list[EventSample] = []
        self.rows: dict[str, Mapping[str, float]] = {}
        self.groups: dict[str, xr.Dataset] = {}
        self.checks: list[IdentityCheck] = []
        self.notices: list[Notice] = []

    def event(self, drawn: Sequence[tuple[int, Plan]], mesh: Mesh, suffix: str = "", like: str = "") -> bool:
        """Run an event on a mesh with the realisations of its sea; return whether it can be counted."""
        name = drawn[0][1].name + suffix
        several = len(drawn) > 1
        return all(
            self._add(plan, mesh, name, seed, f"{name}, seed {seed}" if several else name, like) for seed, plan in drawn
        )

    def weaker(self, drawn: Sequence[tuple[int, Plan]], mesh: Mesh, name: str) -> bool:
        """Run an event in a weaker current, under a name of its own; return whether it can be counted.

        One realisation has the scatter and the growth with the cells of the event in the current of the case; where it
        may be judged highest by them, more are run.
        """
        like, drawn = drawn[0][1].name, [(seed, replace(plan, name=name)) for seed, plan in drawn]
        if not self.event(drawn[:1], mesh, like=like):
            return False
        leads = any((top := leading_end(self.samples, part)) is not None and top[0] == name for part in COMPONENTS)
        more = drawn[1 : _fine_count(drawn)] if leads else []
        return not more or self.event(more, mesh, like=like)

    def _add(self, plan: Plan, mesh: Mesh, name: str, seed: int, words: str, like: str) -> bool:
        """Make a run; keep the series of the first realisation, of the others the peaks."""
        given = self.settings.dynamic
        assert given is not None
        place = f"dynamic, {words}"
        done = len(self.samples)
        self.progress(place, done, max(self.expected, done + 1))
        event = plan.name
        plan, run, reported = through(self.span, mesh, plan, self.progress, place)
        self.progress(place, 1, 1)
        if run.history.status == "interrupted":
            raise KeyboardInterrupt
        if crumples(run):
            return False
        plan = replace(plan, name=name)
        data, row = run_dataset(run, given, None, plan)
        peaks = {component: row[key] for component, key in COMPONENTS.items()}
        reach = {component: reach_of_periods(data, component) for component in peaks if plan.regular}
        self.samples.append(EventSample(event, name, (mesh.along, mesh.down), seed, peaks, like, reach))
        self.checks.extend(run_checks(run, place))
        if name not in self.rows:
            self.rows[name] = row
            self.groups[name], self.groups[f"{name}/frames"] = data, run_frames(run, plan)
            self.notices.extend([*reported, *run_notices(run, place, plan.period, plan.regular)])
        return True

    def unresolved(self, fine: Mesh) -> tuple[str, Mesh] | None:
        """Return an event that leads a component and the mesh that it has still to be run on, None where none is left.

        Every one that leads by its value, or by the end to which it may grow, is run on ``fine``; one without chance
        that leads by its value on a finer one where the coarsest gives more beyond the change allowed: of realisations
        a few tell no mesh from chance.
        """
        finest = replace(fine, along=_four_thirds(fine.along), down=_four_thirds(fine.down))
        leading = list(governing_peaks(self.samples).values())
        ends = [leading_end(self.samples, component) for component in COMPONENTS]
        for event, _ in [*leading, *(top for top in ends if top is not None)]:
            if not self._known(event, fine):
                return event, fine
        for event, peak in leading:
            chance = any(item.seed for item in self.samples if item.event == event)
            apart = peak.change > MESH_CHANGE and not peak.finer_is_more
            if apart and not chance and not self._known(event, finest):
                return event, finest
        return None

    def _known(self, event: str, mesh: Mesh) -> bool:
        return any(item.event == event and item.mesh == (mesh.along, mesh.down) for item in self.samples)

    def stopped(self, plan: Plan) -> DynamicAnswer:
        """Return that nothing counts, and why."""
        text = f"{plan.name}: the run of the whole span had to stop, or its cloth crumpled: the bounds of a plate stay"
        said = Notice("span-peaks", text, remedy="add 'dynamic' to 'analyses' with more cells or more viscosity")
        return DynamicAnswer({}, (), (said,), {})

    def answer(self) -> DynamicAnswer:
        """Return groups, checks, notices and the highest tensions."""
        import xarray as xr

        names = list(self.rows)
        table = {key: ("run", [row[key] for row in self.rows.values()]) for key in self.rows[names[0]]}
        event_of = {item.run: item.event for item in self.samples}
        run_of = ("run", [event_of[name] for name in names])
        peaks, coords = event_variables(self.samples)
        self.groups[""] = labelled(xr.Dataset({**table, "run_of": run_of, **peaks}, coords={"run": names, **coords}))
        found = governing_peaks(self.samples)
        behind = open_peaks(self.samples)
        # another event with a smaller mean may be judged higher, or be open where this one is known
        loads = {
            name: SpanLoad(peak.value, peak.run, peak.at_least, highest_judged(self.samples, name), name in behind)
            for name, (_, peak) in found.items()
        }
        notices = (*self.notices, *mesh_notices(found, behind))
        return DynamicAnswer(self.groups, tuple(self.checks), notices, loads)


__all__ = ["peaks_wanted", "span_peaks"]
