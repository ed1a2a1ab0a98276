"""Run a floating breakwater: every water level, every sea state, the analyses that the case names."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from moyai.core.collected import Collected
from moyai.core.headline import SEAS_LEFT_OUT
from moyai.core.progress import Progress, silent
from moyai.core.remembered import Remembered, key_of_objects
from moyai.core.results import Result
from moyai.core.store import DatasetStore
from moyai.core.validity import IdentityCheck, Notice
from moyai.floating.checks import roll_notices
from moyai.structures.breakwater.assembly import FloatingUnit, assemble
from moyai.structures.breakwater.checks import check_problem, check_unit, drift_check
from moyai.structures.breakwater.frequency import irregular as frequency_irregular
from moyai.structures.breakwater.frequency import regular as frequency_regular
from moyai.structures.breakwater.frequency.model import FrequencyModel, FrequencyResult, make_model
from moyai.structures.breakwater.headlines import headlines
from moyai.structures.breakwater.hydrodynamics import (
    CoefficientsOf,
    UnitHydrodynamics,
    headings_of,
    oblique_frequencies,
    operator_frequencies,
    section_frequencies,
    solve_unit,
    spectrum_band,
)
from moyai.structures.breakwater.loads import steady_forces
from moyai.structures.breakwater.model import BreakwaterProblem, RegularSea
from moyai.structures.breakwater.screening import check_screening
from moyai.structures.breakwater.sensitivity import sensitivity_datasets
from moyai.structures.breakwater.statics import mooring_dataset, moving_shapes, statics_dataset
from moyai.structures.breakwater.variables import VOCABULARY
from moyai.structures.breakwater.viscous_damping import viscous_notices

if TYPE_CHECKING:
    import xarray as xr


MOST_SHARED = 48  # heading and range of frequencies of a scatter diagram make so many
# What the cases of a study share that differ in their irregular seas alone
_HYDRODYNAMICS: Remembered[UnitHydrodynamics] = Remembered(MOST_SHARED)
_STATICS: Remembered[tuple[xr.Dataset, tuple[Notice, ...]]] = Remembered(MOST_SHARED)
_MODELS: Remembered[FrequencyModel] = Remembered(MOST_SHARED)
_DRIFT_CHECKS: Remembered[tuple[IdentityCheck, ...]] = Remembered(MOST_SHARED)
_REGULAR: Remembered[FrequencyResult] = Remembered(MOST_SHARED)


@dataclass(frozen=True)
class _Sources:
    """Where coefficients may come from next to the solver."""

    coefficients: CoefficientsOf | None
    store: DatasetStore | None


def run(
    problem: BreakwaterProblem,
    progress: Progress = silent,
    *,
    coefficients: CoefficientsOf | None = None,
    notices: tuple[Notice, ...] = (),
    store: DatasetStore | None = None,
) -> Result:
    """Run all analyses of a breakwater case.

    Parameters
    ----------
    problem : BreakwaterProblem
    progress : Progress
        Called after every step; KeyboardInterrupt ends the run with what there is and the status ``interrupted``.
    coefficients : callable or None
        Planar coefficients per metre of the unit from a 3-D program in place of the section.
    notices : tuple of Notice
        What speaks against them.
    store : DatasetStore or None
        Where coefficients that took long are kept and looked for.

    Returns
    -------
    Result
        Groups as in docs/result_layout.md.

    Raises
    ------
    InputError
        When the case is impossible: the body sinks, reaches the bed, a line cannot reach.
    """
    collected = Collected()
    collected.notices.extend((*check_problem(problem), *notices))
    steps = _steps(problem, collected, _Sources(coefficients, store), progress)
    collected.take(steps)
    return _result(problem, collected)


def _steps(problem: BreakwaterProblem, collected: Collected, sources: _Sources, progress: Progress) -> Iterator[None]:
    analyses = problem.analyses
    levels = problem.environment.water_levels
    # Every level is assembled before any long work starts, so that an impossible one is reported at once
    chosen = [(name, level) for name, level in levels if problem.only_level in ("", name)]
    units = [assemble(problem, name, level) for name, level in chosen]

    def of_level(unit: FloatingUnit) -> Callable[[Collected, Progress], Iterator[None]]:
        return lambda own, heard: _level_steps(problem, unit, own, sources, heard, analyses)

    yield from collected.take_together([of_level(unit) for unit in units], progress, "water levels")


def _level_steps(
    problem: BreakwaterProblem,
    unit: FloatingUnit,
    collected: Collected,
    sources: _Sources,
    progress: Progress,
    analyses: tuple[str, ...],
) -> Iterator[None]:
    root = f"/{unit.name}"
    collected.groups[root] = _level_header(unit)
    collected.notices.extend((*unit.notices, *check_unit(unit)))
    wind, current = steady_forces(unit, problem.environment)
    steady = wind + current
    dynamic = "frequency" in analyses or "time" in analyses
    hydro: UnitHydrodynamics | None = None
    shared = None if sources.coefficients is not None else _key_without_irregular_seas(problem, unit)
    if dynamic or "statics" in analyses:
        hydro = _HYDRODYNAMICS.of(
            shared,
            lambda: solve_unit(
                unit, problem, coefficients=sources.coefficients, store=sources.store, progress=progress
            ),
        )
        collected.groups[f"{root}/hydrodynamics"] = hydro.per_metre
        if hydro.oblique_per_metre is not None:
            collected.groups[f"{root}/hydrodynamics_oblique"] = hydro.oblique_per_metre.copy()
        collected.checks.extend(replace(check, name=f"{unit.name}: {check.name}") for check in hydro.checks)
        collected.notices.extend(hydro.notices)
        yield
    if "statics" in analyses or dynamic:
        data, notices = _STATICS.of(shared, lambda: statics_dataset(unit, hydro, wind, current))
        collected.groups[f"{root}/statics"] = data
        collected.notices.extend(notices)
        yield
    if "mooring" in analyses and unit.lines:
        collected.groups[f"{root}/mooring"] = mooring_dataset(unit, problem.settings.offsets())
        yield
    if not dynamic or hydro is None:
        return
    settings, found = problem.settings, hydro
    led = (settings.time.lines, problem.environment.current) if settings.line_restoring == "equivalent" else None
    model = _MODELS.of(shared, lambda: make_model(unit, found, steady, settings.drift, led_lines=led))
    yield from _frequency_steps(problem, model, collected, root, shared, progress)
    if "time" in analyses:
        yield from _time_steps(problem, model, collected, root, progress)


def _frequency_steps(
    problem: BreakwaterProblem,
    model: FrequencyModel,
    collected: Collected,
    root: str,
    shared: str | None,
    progress: Progress,
) -> Iterator[None]:
    unit, hydro = model.unit, model.hydro
    seas = problem.environment.sea_states
    main = float(seas[0].heading) if seas else 0.0
    if problem.operators:
        found = frequency_regular.operators(model, operator_frequencies(unit, problem), main, seas)
        collected.groups[f"{root}/rao"] = found.dataset
        collected.checks.extend(found.checks)
        collected.notices.extend((*found.notices, *check_screening(unit.water.depth, unit.draught)))
    if not problem.nominal:
        key = None if shared is None else key_of_objects(shared, main)
        collected.checks.extend(_DRIFT_CHECKS.of(key, lambda: drift_check(model, main)))
    collected.notices.extend(viscous_notices(unit))
    yield
    for sea in seas:
        if isinstance(sea, RegularSea):
            answer = _regular_sea(model, sea, shared, progress)
        else:
            answer = frequency_irregular.irregular_sea(model, sea, spectrum_band(sea), progress)
        collected.groups[f"{root}/frequency/{sea.name}"] = answer.dataset
        collected.checks.extend(answer.checks)
        collected.notices.extend(answer.notices)
        if answer.dataset.attrs["status"] != "converged":
            collected.failures.append(f"not settled: {unit.name}/frequency/{sea.name}")
        yield
    groups, notices = sensitivity_datasets(problem, unit, hydro, model)
    collected.notices.extend(notices)
    collected.groups.update({f"{root}/sensitivity/{name}": data for name, data in groups.items()})
    yield


def _regular_sea(model: FrequencyModel, sea: RegularSea, shared: str | None, progress: Progress) -> FrequencyResult:
    """Return the answer to regular waves: that of the case before where only its irregular seas were others."""
    key = None if shared is None else key_of_objects(shared, sea)
    return _REGULAR.of(key, lambda: frequency_regular.regular_sea(model, sea, progress))


def _key_without_irregular_seas(problem: BreakwaterProblem, unit: FloatingUnit) -> str:
    """Return a key of all that coefficients, statics and the model depend on, and regular waves but for themselves.

    Of the seas that is the frequencies and headings that they add to those of the coefficients.
    """
    regular = tuple(replace(sea, height=1.0) for sea in problem.environment.sea_states if isinstance(sea, RegularSea))
    environment = replace(problem.environment, sea_states=())
    rest = (problem.breakwater, environment, problem.settings, problem.nominal)
    solved = (section_frequencies(unit, problem), oblique_frequencies(unit, problem), headings_of(problem))
    return key_of_objects(rest, unit.name, unit.level, regular, *solved)


def _time_steps(
    problem: BreakwaterProblem, model: FrequencyModel, collected: Collected, root: str, progress: Progress
) -> Iterator[None]:
    from moyai.structures.breakwater.memory_model import unit_memory
    from moyai.structures.breakwater.time import irregular as time_irregular
    from moyai.structures.breakwater.time import regular as time_regular

    unit = model.unit
    memory = unit_memory(model, convolution=problem.settings.time.memory == "convolution")
    collected.checks.extend(memory.checks)
    collected.notices.extend(memory.notices)
    collected.groups[f"{root}/memory"] = memory.dataset
    histories: list[xr.Dataset] = []
    current = problem.environment.current
    yield
    for sea in problem.environment.sea_states:
        frequency = collected.groups[f"{root}/frequency/{sea.name}"]
        if isinstance(sea, RegularSea):
            answer = time_regular.regular_sea(model, memory, sea, frequency, problem.settings.time, progress, current)
        else:
            answer = time_irregular.irregular_sea(
                model, memory, sea, frequency, problem.settings.time, progress, current
            )
        collected.groups[f"{root}/time/{sea.name}"] = answer.dataset
        for one in answer.runs:
            collected.groups[f"{root}/time/{sea.name}/{one.name}"] = one.dataset(unit)
            if one.lines is not None:
                collected.groups[f"{root}/time/{sea.name}/{one.name}/contacts"] = one.lines.snap_table(unit)
                collected.checks.extend(
                    replace(check, name=f"{check.name} ({sea.name}, {one.name})") for check in one.lines.checks
                )
        collected.checks.extend(answer.checks)
        collected.notices.extend(answer.notices)
        histories.extend(collected.groups[f"{root}/time/{sea.name}/{one.name}"] for one in answer.runs)
        shapes = moving_shapes(unit, histories)
        if shapes is not None:
            statics = collected.groups[f"{root}/statics"].drop_vars(("line_shape_x", "line_shape_z"), errors="ignore")
            collected.groups[f"{root}/statics"] = statics.drop_vars(("shift_x", "shift_z"), errors="ignore").merge(
                shapes
            )
        if answer.status == "interrupted":
            raise KeyboardInterrupt
        if answer.status != "converged":
            collected.failures.append(f"not settled: {unit.name}/time/{sea.name}")
        yield


def _level_header(unit: FloatingUnit) -> xr.Dataset:
    import xarray as xr

    return xr.Dataset(attrs={"water_level": unit.level, "water_depth": unit.water.depth})


def _result(problem: BreakwaterProblem, collected: Collected) -> Result:
    import xarray as xr

    if problem.measured is not None:
        columns = problem.measured.columns
        collected.groups["/measured"] = xr.Dataset(
            {name: ("point", np.asarray(values)) for name, values in columns.items()},
            attrs={"file": problem.measured.file},
        )
    attributes = {
        "structure": "breakwater",
        "title": problem.title,
        "case_hash": problem.case_hash,
        "case_text": problem.case_text,
    }
    seeds = [sea.seed for sea in problem.environment.sea_states if not isinstance(sea, RegularSea)]
    found = headlines(collected.groups)
    for item in (item for item in found if item.name == "roll" and item.shown):
        rest = collected.groups[f"/{item.where.split(', ')[0]}/statics"]
        sizes = {name: float(rest[name]) for name in ("freeboard", "draught", "beam")}
        collected.notices.extend(roll_notices(item.value, where=item.where, **sizes))
    return collected.close(
        VOCABULARY,
        attributes,
        seeds,
        fulfilled="all identities hold and all iterations converged",
        headlines=found,
        criteria=problem.criteria,
        left_out=SEAS_LEFT_OUT
        if problem.environment.sea_states and not {"frequency", "time"} & set(problem.analyses)
        else "",
    )


__all__ = ["run"]
