"""The dynamic analysis of a curtain case: every sea state, or the snap in the current alone, on the whole span."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, NamedTuple

from moyai.core.progress import Progress
from moyai.core.validity import IdentityCheck, Notice
from moyai.sea.states import SeaState
from moyai.structures.curtain.analyses.event_peaks import COMPONENTS
from moyai.structures.curtain.analyses.impact import impact_of
from moyai.structures.curtain.assembly import LevelCurtain
from moyai.structures.curtain.dynamic.checks import crumples, run_checks, run_notices, still_rises
from moyai.structures.curtain.dynamic.groups import run_dataset, run_frames
from moyai.structures.curtain.dynamic.model import CurtainSpan, Mesh
from moyai.structures.curtain.dynamic.peak_uncertainty import PeakUncertainties, span_uncertainty
from moyai.structures.curtain.dynamic.plans import Plan, plans_of
from moyai.structures.curtain.dynamic.runs import DynamicRun, run_span
from moyai.structures.curtain.dynamic.span import span_of
from moyai.structures.curtain.impact.cable import edge_impact, peak_by_energy
from moyai.structures.curtain.model import CurtainSettings
from moyai.structures.curtain.variables import labelled

if TYPE_CHECKING:
    import xarray as xr

#: Over the skirt's length, to either side of a section: what waves fold more finely than this turns no added mass.
_NORMAL_REACH = 1.0 / 3.0
#: Times that the run of a snap is doubled while its highest tension stands late, and the growth that ends it.
_LONGER, _SAME = 4, 0.01


class SpanLoad(NamedTuple):
    """Highest tension of a component, the run in which it stands, whether smaller cells give more, and what is judged.

    Tensions in N, N/m; what is judged is the upper end of the interval of the mean, the tension itself without one.
    ``open`` states that some run, this one or another, leaves the component open upwards.
    """

    load: float
    run: str
    at_least: bool = False
    judged: float = math.nan
    open: bool = False


@dataclass(frozen=True)
class DynamicAnswer:
    """Groups of one run, what must be reported, its checks, the highest tensions, and whether the user stopped it."""

    groups: dict[str, xr.Dataset]
    checks: tuple[IdentityCheck, ...]
    notices: tuple[Notice, ...]
    loads: Mapping[str, SpanLoad]
    interrupted: bool = False


def dynamic_answer(
    unit: LevelCurtain, settings: CurtainSettings, seas: tuple[SeaState, ...], progress: Progress
) -> DynamicAnswer:
    """Run the span of a level through every sea state, or through the snap in its current.

    Raises
    ------
    InputError
        As :func:`span_of`, and where there is neither a sea nor a current.
    """
    import xarray as xr

    given = settings.dynamic
    assert given is not None
    span = span_of(unit, given)
    groups: dict[str, xr.Dataset] = {}
    checks: list[IdentityCheck] = []
    notices: list[Notice] = []
    rows: list[dict[str, float]] = []
    plans = plans_of(unit, settings, seas, span)
    interrupted = False
    for number, plan in enumerate(plans):
        progress(f"dynamic, {plan.name}", number, len(plans))
        place = f"dynamic, {plan.name}"
        plan, run, reported = through(span, given.mesh, plan, progress, place)
        progress(place, 1, 1)
        notices.extend(reported)
        uncertainty: PeakUncertainties | None = None
        interrupted = run.history.status == "interrupted"
        if run.history.status == "not_converged":
            notices.append(
                Notice("dynamic-stopped", f"{place}: {run.history.message}; its last instants are no motion of the "
                       "curtain, and no peak of it is given", math.nan, math.nan, "error",
                       "take a finer mesh or more viscosity", "guard on the energy of the run")
            )  # fmt: skip
        elif given.sensitivity and not interrupted:
            try:
                uncertainty = span_uncertainty(run, progress=progress, **plan.arguments)
                notices.extend(uncertainty.notices(place))
            except KeyboardInterrupt:
                interrupted = True
        checks.extend(run_checks(run, place))
        data, row = run_dataset(run, given, uncertainty, plan)
        groups[plan.name] = data
        groups[f"{plan.name}/frames"] = run_frames(run, plan)
        rows.append(row)
        notices.extend(run_notices(run, place, plan.period, plan.regular))
        if interrupted:
            end = float(run.history.time[-1])
            notices.append(
                Notice("dynamic-interrupted", f"{place}: stopped by the user, the run reaches {end:.4g} s of "
                       f"{float(plan.arguments['duration']):.4g} s", math.nan, math.nan, "warning")
            )  # fmt: skip
            break
    else:
        progress("dynamic", len(plans), len(plans))
    table = {key: ("run", [row[key] for row in rows]) for key in rows[0]}
    groups[""] = labelled(xr.Dataset(table, coords={"run": [plan.name for plan in plans[: len(rows)]]}))
    models = _models(unit, settings)
    if models is not None:
        groups[""] = groups[""].merge(models)
    return DynamicAnswer(groups, tuple(checks), tuple(notices), peaks_of_runs(plans, rows), interrupted)


def peaks_of_runs(plans: Sequence[Plan], rows: Sequence[Mapping[str, float]]) -> dict[str, SpanLoad]:
    """Return the highest tension of each component over the runs, and the run in which it stands.

    A run through an irregular sea is one realisation about one crest: a bound from below.
    """
    found: dict[str, SpanLoad] = {}
    for component, key in COMPONENTS.items():
        known = [
            SpanLoad(row[key], plan.name, plan.random) for row, plan in zip(rows, plans, strict=False) if row[key] > 0.0
        ]
        if known:
            found[component] = max(known)._replace(open=any(item.at_least for item in known))
    return found


def through(
    span: CurtainSpan, mesh: Mesh, plan: Plan, progress: Progress, place: str
) -> tuple[Plan, DynamicRun, tuple[Notice, ...]]:
    """Run a plan, a snap until it is past its peak.

    In waves folds of the cloth do not turn the normals of sections; a snap has none at first and takes the normals
    between neighbours. What stops, or feeds viscosity more than the span ever holds, is run again with steadier
    normals, in the end with those of the just-taut span.
    """
    wide = replace(mesh, normal_reach=mesh.normal_reach or _NORMAL_REACH * span.skirt_length)
    held = replace(wide, turning=False)
    trials = [mesh, wide, held] if plan.arguments["flow"].waves is None else [wide, held]
    first: tuple[Plan, DynamicRun] | None = None
    for trial in trials:
        plan_run = _until_peak(span, trial, plan, progress)
        if first is None:
            first = plan_run
        if not crumples(plan_run[1]):
            return *plan_run, _steadied(first[1], plan_run[1], place)
    assert first is not None
    return *first, ()


def _until_peak(span: CurtainSpan, mesh: Mesh, plan: Plan, progress: Progress) -> tuple[Plan, DynamicRun]:
    run = run_span(span, mesh, progress=progress, **plan.arguments)
    for _ in range(_LONGER if plan.open else 0):
        if run.history.status != "converged" or not still_rises(run):
            break
        before = run.peak("both")[0]
        plan = replace(plan, arguments={**plan.arguments, "duration": 2.0 * plan.arguments["duration"]})
        run = run_span(span, mesh, progress=progress, **plan.arguments)
        if run.peak("both")[0] <= (1.0 + _SAME) * before:
            # it has come to its steady tension
            break
    return plan, run


def _steadied(first: DynamicRun, run: DynamicRun, place: str) -> tuple[Notice, ...]:
    """Tell that a run was made again with steadier normals of its sections."""
    if run is first:
        return ()
    way = (
        "taken over a third of the skirt's length to either side"
        if run.built.mesh.turning
        else "held as in the just-taut span, whose high peaks lay within a seventh of the others where both ran, weak "
        "ones within a half"
    )
    end = float(first.history.time[-1])
    why = f"the run stopped at {end:.4g} s"
    if first.history.status == "converged":
        gained, taken = run_checks(first, "")
        why = (
            f"{100 * gained.value:.3g} % of the energy that went through the span is an error of the energy balance"
            if taken.passed
            else f"viscosity took {taken.value:.3g} times per period the largest energy of the span"
        )
    return (
        Notice(
            "dynamic-turning",
            f"{place}: the cloth gathers, and {why}; it is made again with normals of the added mass {way}",
            math.nan, math.nan, "warning", "take another mesh, or more viscosity", "guard on the energy of the run",
        ),
    )  # fmt: skip


def _models(unit: LevelCurtain, settings: CurtainSettings) -> xr.Dataset | None:
    """Return the peaks of models A and A2 at the start speed, to compare the dynamic peak with."""
    import xarray as xr

    speed = settings.impact.start_speed or unit.normal_speed
    if not speed > 0.0 or unit.curtain.length <= unit.curtain.span:
        return None
    impact = impact_of(unit, settings.impact, speed)
    names = ["A", "A2"]
    peaks = [peak_by_energy(impact).tension, edge_impact(impact, finite_depth=True).simultaneous_peak]
    return labelled(xr.Dataset({"dynamic_model_tension": ("dynamic_model", peaks)}, coords={"dynamic_model": names}))


__all__ = ["DynamicAnswer", "SpanLoad", "dynamic_answer", "peaks_of_runs", "through"]
