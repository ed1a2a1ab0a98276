"""Run a silt curtain: every water level, the analyses that the case names."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Self

from moyai.core.collected import Collected
from moyai.core.progress import Progress, silent
from moyai.core.results import Result
from moyai.core.validity import Notice
from moyai.sea.states import RegularSea
from moyai.structures.curtain.analyses.anchor import anchor_checks, anchor_dataset, anchor_notices
from moyai.structures.curtain.analyses.dynamic import DynamicAnswer, dynamic_answer
from moyai.structures.curtain.analyses.impact import ImpactAnswer, impact_checks, impact_notices, solve_impact
from moyai.structures.curtain.analyses.impact_groups import impact_groups
from moyai.structures.curtain.analyses.limits import fastest_water, limits_dataset
from moyai.structures.curtain.analyses.loads import NOT_MOVED, dynamic_loads_dataset, loads_dataset
from moyai.structures.curtain.analyses.record import record_dataset, record_ratios
from moyai.structures.curtain.analyses.rose import rose_dataset
from moyai.structures.curtain.analyses.span_peaks import peaks_wanted, span_peaks
from moyai.structures.curtain.analyses.statics import require_current, statics_checks, statics_groups, statics_notices
from moyai.structures.curtain.analyses.waves import still_flows, wave_answer, with_strong_drag
from moyai.structures.curtain.analyses.weaker_currents import weaker_waves
from moyai.structures.curtain.assembly import LevelCurtain, assemble
from moyai.structures.curtain.headlines import curtain_headlines
from moyai.structures.curtain.hierarchy import CYCLES, hierarchy, hierarchy_dataset, role_of
from moyai.structures.curtain.limit_headlines import weaker_currents
from moyai.structures.curtain.model import CurtainProblem
from moyai.structures.curtain.seas.cycles_of_sea import SeaCycles
from moyai.structures.curtain.seas.loads import drag_curve
from moyai.structures.curtain.seas.states import DesignWave, design_waves, longest_sea, significant_height
from moyai.structures.curtain.snaps.flow import SkirtFlow
from moyai.structures.curtain.variables import VOCABULARY

if TYPE_CHECKING:
    import xarray as xr


class _Collected(Collected):
    """What a run has so far, and the water level of every notice."""

    def __init__(self) -> None:
        super().__init__()
        self.level_of: list[str] = []

    def name_level(self, level: str) -> None:
        """Note that the notices since the last call belong to a water level (empty: to the whole run)."""
        self.level_of.extend([level] * (len(self.notices) - len(self.level_of)))

    def join(self, other: Self) -> None:
        """Take over what a part of the run has gathered."""
        other.name_level("")
        super().join(other)
        self.level_of.extend(other.level_of)


def run(problem: CurtainProblem, progress: Progress = silent) -> Result:
    """Run all analyses of a curtain case.

    Parameters
    ----------
    problem : CurtainProblem
    progress : Progress
        Called after every step; KeyboardInterrupt ends the run with what there is and the status ``interrupted``.

    Returns
    -------
    Result
        Groups as in docs/result_layout.md.

    Raises
    ------
    InputError
        When the case is impossible: a skirt on the bed that may not lie there, a curtain without equilibrium, an
        impact of a curtain that is never slack.
    """
    collected = _Collected()
    collected.take(_steps(problem, collected, progress))
    return _result(problem, collected)


def _steps(problem: CurtainProblem, collected: _Collected, progress: Progress) -> Iterator[None]:
    levels = problem.environment.water_levels
    # every level is assembled before any long work starts, so that an impossible one is reported at once
    units = [assemble(problem, name, level) for name, level in levels]
    if problem.record is not None:
        collected.groups["/record"] = record_dataset(problem.record)
        collected.notices.extend(problem.record.notices)
        collected.name_level("")

    def of_level(unit: LevelCurtain) -> Callable[[_Collected, Progress], Iterator[None]]:
        def steps(own: _Collected, heard: Progress) -> Iterator[None]:
            for _ in _level_steps(problem, unit, own, heard):
                own.name_level(unit.name)
                yield

        return steps

    yield from collected.take_together([of_level(unit) for unit in units], progress, "water levels")


def _level_steps(
    problem: CurtainProblem, unit: LevelCurtain, collected: _Collected, progress: Progress
) -> Iterator[None]:
    settings, seas = problem.settings, problem.environment.sea_states
    root = f"/{unit.name}"
    waves: tuple[DesignWave, ...] = tuple(wave for sea in seas for wave in design_waves(sea, unit.curtain.normal))
    highest = max((significant_height(sea) for sea in seas), default=0.0)
    roles = hierarchy(unit, settings)
    collected.groups[root] = _header(unit)
    collected.groups[f"{root}/models"] = hierarchy_dataset(roles)
    plate: list[int] = []
    if "statics" in settings.analyses:
        require_current(unit)
        collected.groups.update({f"{root}/{name}": data for name, data in statics_groups(unit, highest).items()})
        collected.checks.extend(statics_checks(unit))
        collected.notices.extend(statics_notices(unit, highest))
        yield
    answer: ImpactAnswer | None = None
    if "impact" in settings.analyses:
        progress(f"impact, {unit.name}", 0, 1)
        answer = solve_impact(unit, settings.impact)
        groups = impact_groups(unit, settings.impact, answer)
        if problem.record is not None:
            ratios, reported = record_ratios(problem.record, answer)
            groups["impact"] = groups["impact"].merge(ratios)
            collected.notices.extend(reported)
        collected.groups.update({f"{root}/{name}": data for name, data in groups.items()})
        collected.checks.extend(impact_checks(unit, answer))
        plate.extend(_numbered(collected, impact_notices(unit, settings.impact, answer)))
        progress(f"impact, {unit.name}", 1, 1)
        yield
    oscillator: list[tuple[str, float, float]] = []
    strong: dict[str, float] = {}
    flows: dict[str, tuple[SkirtFlow, ...]] = {}
    if "waves" in settings.analyses:
        flows = {sea.name: still_flows(unit, settings.waves, sea) for sea in seas}
        for sea in seas:
            found = wave_answer(unit, settings, sea, progress, flows[sea.name])
            if not unit.nominal:
                found = with_strong_drag(unit, settings, sea, found, flows[sea.name])
            for name, data in found.groups.items():
                collected.groups[f"{root}/waves/{sea.name}" + (f"/{name}" if name else "")] = data
            plate.extend(_numbered(collected, found.notices))
            cycles = SeaCycles.of(found.groups[""])
            strong[sea.name] = cycles.of_strong_drag
            # a bound is the upper end of what it varies with: a mean bounds nothing
            bounds = role_of(roles, CYCLES) == "bound"
            top = max(found.highest_tension, cycles.judged) if bounds else found.maximum_tension
            oscillator.append((sea.name, top, max(top, cycles.judged)))
            yield
    if "anchor_loads" in settings.analyses and settings.anchor_loads is not None and waves:
        loads = anchor_dataset(unit, settings.anchor_loads, settings.limits, waves)
        collected.groups[f"{root}/anchor_loads"] = loads
        collected.checks.extend(anchor_checks(unit, loads))
        collected.notices.extend(anchor_notices(unit, settings.anchor_loads, waves))
        yield
    weaker = weaker_waves(unit, settings, seas, progress, strong, flows) if "waves" in settings.analyses else None
    if weaker is not None:
        collected.groups[f"{root}/weaker_currents"] = weaker
        yield
    moved: DynamicAnswer | None = None
    if "dynamic" in settings.analyses and settings.dynamic is not None:
        moved = dynamic_answer(unit, settings, seas, progress)
    elif peaks_wanted(unit, settings):
        moved = span_peaks(unit, settings, seas, progress)
        if moved is not None and moved.loads:
            roles = hierarchy(unit, replace(settings, analyses=(*settings.analyses, "dynamic")))
            collected.groups[f"{root}/models"] = hierarchy_dataset(roles)
    if moved is not None:
        collected.groups.update(
            {f"{root}/dynamic" + (f"/{name}" if name else ""): data for name, data in moved.groups.items()}
        )
        if moved.loads:
            # what limits a model that only stands for comparison limits no number of the first page
            for number in plate:
                collected.notices[number] = _lowered(collected.notices[number])
        collected.checks.extend(moved.checks)
        collected.notices.extend(moved.notices)
        if moved.interrupted:
            raise KeyboardInterrupt
        yield
    tensions = NOT_MOVED if moved is None else moved.loads
    if not {"statics", "impact", "waves", "anchor_loads", "limits"} & set(settings.analyses):
        collected.groups[f"{root}/loads"] = dynamic_loads_dataset(unit, tensions)
        yield
        return
    curve = drag_curve(unit, fastest_water(unit, settings, waves))
    proportions = answer
    if proportions is None and "waves" in settings.analyses:
        # snaps in waves load the components in the proportions of an impact at the current's speed
        proportions = solve_impact(unit, settings.impact, unit.normal_speed or 1.0)
    table, notices = loads_dataset(
        unit, settings, waves, tuple(oscillator), answer, proportions, curve, tensions, roles, weaker
    )
    collected.groups[f"{root}/loads"] = table
    collected.notices.extend(notices)
    yield
    if "limits" in settings.analyses:
        lost = _lost_depth(collected.groups.get(f"{root}/statics"), unit.depth)
        collected.groups[f"{root}/limits"] = limits_dataset(
            unit, settings, proportions, curve, progress, lost, longest_sea(seas), max(strong.values(), default=1.0)
        )
        yield
        if settings.limits.rose_step is not None:
            collected.groups[f"{root}/limits/rose"] = rose_dataset(unit, settings, seas, progress)
            yield


def _numbered(collected: _Collected, notices: Sequence[Notice]) -> range:
    """Collect notices; return their places."""
    first = len(collected.notices)
    collected.notices.extend(notices)
    return range(first, len(collected.notices))


#: Before what limits a model that only stands for comparison.
_COMPARED = "upright plate, for comparison"


def _lowered(notice: Notice) -> Notice:
    if notice.severity != "warning":
        return notice
    return replace(notice, severity="information", message=f"{_COMPARED}: {notice.message}")


def _header(unit: LevelCurtain) -> xr.Dataset:
    import xarray as xr

    toe = unit.curtain.toe
    resting = unit.surface_speed > 0.0 and unit.rests_on_bed
    return xr.Dataset(
        attrs={
            "water_level": unit.level,
            "water_depth": unit.water.depth,
            "surface_speed": unit.surface_speed,
            "normal_heading": unit.curtain.normal,
            "anchor_slope": unit.hanging.anchor_slope,
            "toe": "on the bed" if resting else toe,
        }
    )


def _lost_depth(statics: xr.Dataset | None, depth: float) -> float:
    """Return the depth lost at the lower end of its band over the depth lost; 1 where there is no band or no loss."""
    if statics is None or "steady_effective_depth_low" not in statics:
        return 1.0
    low, value = (float(statics[f"steady_effective_depth{end}"]) for end in ("_low", ""))
    return (depth - low) / (depth - value) if low < value < depth else 1.0


_NOT_MOVED = "snaps in the seas of the case were not run, which needs 'waves' or 'dynamic' in 'analyses'"


def _result(problem: CurtainProblem, collected: _Collected) -> Result:
    attributes = {
        "structure": "curtain",
        "title": problem.title,
        "case_hash": problem.case_hash,
        "case_text": problem.case_text,
    }
    levels = [name for name, _ in problem.environment.water_levels]
    found = curtain_headlines(collected.groups, levels, problem.criteria)
    # an impact, and the whole span that is run by default for it, are those of the current alone
    in_seas = bool({"waves", "dynamic"} & set(problem.settings.analyses))
    more = weaker_currents(collected.groups, found) if problem.criteria else ()
    # floats are asked to float where they were looked at
    named = {item.name for item in found}
    asked = [
        item
        for item in problem.criteria
        if not (item.assumed and item.headline == "float_reserve") or item.headline in named
    ]
    fulfilled = "all identities hold" if collected.checks else "done; these analyses have no identity to hold"
    if any(notice.code == "span-mesh" for notice in collected.notices):
        fulfilled += "; peaks of the whole span change with the mesh, see the warning"
    return collected.close(
        VOCABULARY,
        attributes,
        [sea.seed for sea in problem.environment.sea_states if not isinstance(sea, RegularSea)],
        notices=_placed(collected, len(levels)),
        headlines=found,
        fulfilled=fulfilled,
        criteria=(*asked, *more),
        left_out=_NOT_MOVED if problem.environment.sea_states and not in_seas else "",
    )


def _placed(collected: _Collected, levels: int) -> list[Notice]:
    """Say at which water level a notice holds, where it does not hold at all of them."""
    collected.name_level("")
    holding: dict[str, set[str]] = {}
    for notice, level in zip(collected.notices, collected.level_of):
        holding.setdefault(notice.message, set()).add(level)
    placed = []
    for notice, level in zip(collected.notices, collected.level_of):
        alone = level and levels > 1 and len(holding[notice.message]) < levels
        said = notice.message.startswith(f"{level}:") or notice.message.startswith(f"{level},")
        placed.append(replace(notice, message=f"{level}: {notice.message}") if alone and not said else notice)
    return placed


__all__ = ["run"]
