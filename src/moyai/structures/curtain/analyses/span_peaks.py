"""Peaks of the whole span where it is not asked for and an upright plate only bounds them [eq:curtain-hierarchy].

Every run is made on a coarse mesh; those that lead a component are made again on a finer one. Both stand in the tables
and the larger counts, since the motion is chaotic and neither mesh is the better sample of its highest tension.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

from moyai.core.errors import InputError
from moyai.core.progress import Progress
from moyai.core.validity import IdentityCheck, Notice
from moyai.core.wording import spoken
from moyai.sea.states import SeaState
from moyai.structures.curtain.analyses.dynamic import DynamicAnswer, peaks_of_runs, through
from moyai.structures.curtain.assembly import LevelCurtain
from moyai.structures.curtain.dynamic.checks import crumples, run_checks, run_notices
from moyai.structures.curtain.dynamic.groups import run_dataset, run_frames
from moyai.structures.curtain.dynamic.model import CurtainSpan, Mesh
from moyai.structures.curtain.dynamic.plans import Plan, plans_of
from moyai.structures.curtain.dynamic.span import span_of
from moyai.structures.curtain.hierarchy import CYCLES, IMPACT, hierarchy, role_of
from moyai.structures.curtain.model import Settings
from moyai.structures.curtain.variables import labelled

if TYPE_CHECKING:
    import xarray as xr

#: Change of a governing tension from one mesh to the other, over the larger, that is reported
_MESH_CHANGE = 0.2
_PEAKS = ("upper_peak", "lower_peak", "anchor_peak", "skirt_peak")


def peaks_wanted(unit: LevelCurtain, settings: Settings) -> bool:
    """Return whether an upright plate was asked for and is only a bound, and the whole span was not asked for."""
    given, asked = settings.dynamic, set(settings.analyses)
    if given is None or not given.by_default or "dynamic" in asked or unit.curtain.skirt.length >= unit.water.depth:
        return False
    roles = hierarchy(unit, settings)
    return any(role_of(roles, model) == "bound" for model in (IMPACT, CYCLES))


def span_peaks(
    unit: LevelCurtain, settings: Settings, seas: tuple[SeaState, ...], progress: Progress
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
    found = _Runs(unit, settings, span, progress, len(plans) + len(_PEAKS))
    for plan in plans:
        if not found.add(plan, coarse, plan.name):
            return found.stopped(plan)
    for plan in _leading(plans, found.rows):
        if not found.add(replace(plan, name=f"{plan.name}, {fine.along} by {fine.down} cells"), fine, plan.name):
            return found.stopped(plan)
    return found.answer()


def _two_thirds(cells: int) -> int:
    return -(-2 * cells // 3)


def _leading(plans: list[Plan], rows: list[Mapping[str, float]]) -> list[Plan]:
    """Return the runs in which a component has its highest tension."""
    first = {max(range(len(rows)), key=lambda n: rows[n][key]) for key in _PEAKS if any(row[key] > 0.0 for row in rows)}
    return [plan for number, plan in enumerate(plans) if number in first]


class _Runs:
    """Runs that were made, with all that is kept of them."""

    def __init__(
        self, unit: LevelCurtain, settings: Settings, span: CurtainSpan, progress: Progress, expected: int
    ) -> None:
        self.unit, self.settings, self.span, self.progress, self.expected = unit, settings, span, progress, expected
        self.plans: list[Plan] = []
        self.rows: list[Mapping[str, float]] = []
        self.groups: dict[str, xr.Dataset] = {}
        self.checks: list[IdentityCheck] = []
        self.notices: list[Notice] = []
        self.base: list[str] = []

    def add(self, plan: Plan, mesh: Mesh, base: str) -> bool:
        """Make a run; return whether it can be counted."""
        given = self.settings.dynamic
        assert given is not None
        place = f"dynamic, {plan.name}"
        self.progress(place, len(self.plans), max(self.expected, len(self.plans) + 1))
        plan, run, told = through(self.span, mesh, plan, self.progress, place)
        if run.history.status == "interrupted":
            raise KeyboardInterrupt
        if crumples(run):
            return False
        data, row = run_dataset(run, given, None, plan)
        self.groups[plan.name], self.groups[f"{plan.name}/frames"] = data, run_frames(run, plan)
        self.plans.append(plan)
        self.rows.append(row)
        self.base.append(base)
        self.checks.extend(run_checks(run, place))
        self.notices.extend([*told, *run_notices(run, place, plan.period, plan.regular)])
        return True

    def stopped(self, plan: Plan) -> DynamicAnswer:
        """Return that nothing counts, and why."""
        text = f"{plan.name}: the run of the whole span had to stop, or its cloth crumpled: the bounds of a plate stay"
        told = Notice("span-peaks", text, remedy="add 'dynamic' to 'analyses' with more cells or more viscosity")
        return DynamicAnswer({}, (), (told,), {})

    def answer(self) -> DynamicAnswer:
        """Return groups, checks, notices and the highest tensions."""
        import xarray as xr

        table = {key: ("run", [row[key] for row in self.rows]) for key in self.rows[0]}
        names = [plan.name for plan in self.plans]
        self.groups[""] = labelled(xr.Dataset({**table, "run_of": ("run", self.base)}, coords={"run": names}))
        loads = peaks_of_runs(self.plans, self.rows)
        notices = [*self.notices, *mesh_notices(table["upper_peak"][1], self.base, "upper cable")]
        return DynamicAnswer(self.groups, tuple(self.checks), tuple(notices), loads)


def mesh_notices(peaks: Sequence[float], base: Sequence[str], component: str) -> tuple[Notice, ...]:
    """Return the warning that the highest tension of a component hangs on the mesh.

    Parameters
    ----------
    peaks : sequence of float
        Of each run [N].
    base : sequence of str
        What each run is of: the same for both meshes.
    component : str
    """
    leading = base[max(range(len(peaks)), key=lambda number: peaks[number])]
    both = [peak for peak, one in zip(peaks, base, strict=True) if one == leading]
    change = 1.0 - min(both) / max(both) if max(both) > 0.0 else 0.0
    if not change > _MESH_CHANGE:
        return ()
    return (
        Notice(
            "span-mesh",
            f"{component}, {leading}: {spoken(min(both), 'N', 3)} on one mesh, {spoken(max(both), 'N', 3)} on the "
            "other; the motion is chaotic, and the larger is the highest of two samples, not a converged value",
            change,
            _MESH_CHANGE,
            remedy="take the bound of the upright plate, or run 'dynamic' with more cells and several seeds",
            source="eq:curtain-hierarchy",
        ),
    )


__all__ = ["peaks_wanted", "span_peaks"]
