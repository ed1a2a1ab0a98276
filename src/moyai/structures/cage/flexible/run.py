"""Run a flexible cage: every water level, its rest in each current, every sea, and the uncertainty of the peaks."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace
from functools import partial

import numpy as np

from moyai.core.collected import Collected
from moyai.core.errors import ConvergenceError, InputError
from moyai.core.headline import SEAS_LEFT_OUT
from moyai.core.progress import Progress, silent
from moyai.core.remembered import Remembered, key_of_objects
from moyai.core.results import Result
from moyai.core.validity import Notice
from moyai.flexible.flow import Current
from moyai.flexible.result import State
from moyai.sea.irregular import components_of_run
from moyai.sea.states import IrregularSea
from moyai.sea.water import Water
from moyai.structures.cage.conditions import height_notices
from moyai.structures.cage.flexible.build import build_cage
from moyai.structures.cage.flexible.checks import (
    design_speed,
    problem_notices,
    rest_checks,
    rest_notices,
    run_checks,
    run_notices,
    settling_notices,
)
from moyai.structures.cage.flexible.equilibrium import CageEquilibrium, solve_cage_equilibrium
from moyai.structures.cage.flexible.law_runs import GoverningWaves, WaveCase, laws_in_wave
from moyai.structures.cage.flexible.laws import choice_of, laws_dataset
from moyai.structures.cage.flexible.model import FlexibleCage
from moyai.structures.cage.flexible.parts import CageNetwork
from moyai.structures.cage.flexible.problem import FlexibleCageProblem
from moyai.structures.cage.flexible.sensitivity import REST, mesh_dataset, rest_mesh_dataset, sensitivity_dataset
from moyai.structures.cage.flexible.statics import cage_dataset, statics_dataset
from moyai.structures.cage.flexible.time import CageRun, Settling, run_cage, time_dataset
from moyai.structures.cage.flexible.two_meshes import run_on_two_meshes
from moyai.structures.cage.flexible.variables import VOCABULARY
from moyai.structures.cage.flexible.wake import ScaledCurrent
from moyai.structures.cage.headlines import flexible_headlines
from moyai.structures.cage.rigid.model import RigidCageWaves
from moyai.structures.cage.rigid.waves import COMPONENTS, RigidCageWave, theory_limit, wave_of

# The last rests of this process in still water and in the current of the site, from which those of a draft go on
_NEAR: dict[tuple[str, bool], tuple[State, ...]] = {}
_MOST_NEAR = 6
# What cases share that differ in their currents and seas alone
_BUILT: Remembered[CageNetwork] = Remembered(4)
_STILL: Remembered[CageEquilibrium] = Remembered(4)


def run(problem: FlexibleCageProblem, progress: Progress = silent) -> Result:
    """Run all analyses of a flexible cage.

    Parameters
    ----------
    problem : FlexibleCageProblem
    progress : Progress
        KeyboardInterrupt ends the run with what there is and the status ``interrupted``.

    Returns
    -------
    Result
        Groups as in docs/result_layout.md.

    Raises
    ------
    InputError, ConvergenceError
        For a cage that does not float or does not come to rest.
    """
    collected = Collected()
    collected.take(_steps(problem, collected, progress))
    return _result(problem, collected)


def surface_current(current: Current | None) -> tuple[float, float]:
    """Return speed and heading of a current at the surface [m/s], [rad]."""
    if current is None:
        return 0.0, 0.0
    east, north = (float(value) for value in np.asarray(current.velocity(np.zeros(1)))[0])
    return math.hypot(east, north), math.atan2(north, east) if east or north else 0.0


_AUTOMATIC = "use 'theory: automatic' of regular waves, which takes the stream function here"


def waves_of(
    problem: FlexibleCageProblem, sea: RigidCageWaves | IrregularSea, water: Water
) -> tuple[RigidCageWave, ...]:
    """Return every wave of a sea state at a water depth, on the current of the site."""
    current = problem.environment.current
    profile = None if current is None else current.in_depth(water.depth)
    mean = np.zeros(2) if profile is None else np.asarray(profile.depth_mean(-water.depth, 0.0))
    if isinstance(sea, RigidCageWaves):
        along = float(mean @ [math.cos(sea.heading), math.sin(sea.heading)])
        return tuple(
            wave_of(sea.theory, height, period, sea.heading, water, along, problem.settings.periods)
            for height, period in sea.waves()
        )
    period = float(sea.spectrum.peak_period)
    parts = components_of_run(sea, water, (float(mean[0]), float(mean[1])), COMPONENTS)
    number = float(np.interp(2.0 * math.pi / period, np.sort(parts.omega), parts.wave_number[np.argsort(parts.omega)]))
    height = float(sea.spectrum.significant_height)
    return (RigidCageWave("sea", parts, height, period, 2.0 * math.pi / number, sea.duration, False, sea.seed),)


def _steps(problem: FlexibleCageProblem, collected: Collected, progress: Progress) -> Iterator[None]:
    import xarray as xr

    levels = problem.environment.water_levels
    worst = GoverningWaves()
    waved = bool(problem.seas) and bool({"time", "sensitivity"} & set(problem.settings.analyses))
    collected.notices.extend(problem_notices(problem))
    for index, (name, level) in enumerate(levels):
        progress("water levels", index, len(levels))
        model = problem.at_level(level)
        key = key_of_objects(model, problem.settings.nominal)
        built = _BUILT.of(key, partial(build_cage, model))
        root = f"/{name}"
        current = problem.environment.current
        profile = None if current is None else current.in_depth(model.water.depth)
        speed, heading = surface_current(profile)
        collected.groups[root] = xr.Dataset(
            attrs={"water_level": level, "water_depth": model.water.depth, "current": speed, "heading": heading}
        )
        collected.groups[f"{root}/cage"] = cage_dataset(model, built)
        rest: CageEquilibrium | None = None
        laws_wanted = speed > 0.0 and problem.settings.other_laws
        if "statics" in problem.settings.analyses:
            rests: list[CageEquilibrium] = []
            speeds = _speeds(problem, speed)
            for number, value in enumerate(speeds):
                progress("equilibrium in the current", number, len(speeds))
                flow = ScaledCurrent(profile, value / speed) if profile is not None and value > 0.0 else None
                place = (name, value == speed)
                near = _NEAR.get(place, ()) if problem.settings.nominal else ()
                start = rests[-1].state if rests else None
                solve = partial(solve_cage_equilibrium, model, built, flow, start=start, near=near)
                found = _STILL.of(key, solve) if value == 0.0 else solve()
                if value in (0.0, speed):
                    _NEAR[place] = (found.state, *_NEAR.get(place, ())[: _MOST_NEAR - 1])
                rests.append(found)
                if not problem.settings.nominal or number == len(speeds) - 1:
                    collected.groups[f"{root}/statics"] = statics_dataset(model, speeds[: number + 1], heading, rests)
                yield
            progress("equilibrium in the current", len(speeds), len(speeds))
            statics = collected.groups[f"{root}/statics"]
            collected.checks.extend(rest_checks(name, statics))
            collected.notices.extend(rest_notices(name, model, statics, speed))
            close = [rest for rest, value in zip(rests, speeds, strict=True) if abs(value - speed) < 1e-9]
            rest = close[0] if close else None
            if rest is not None and laws_wanted:
                collected.groups[f"{root}/laws"] = laws_dataset(model, rest, rests[0], speed, heading, progress)
                yield
                if not waved:
                    # a sea that is run checks the mesh itself
                    collected.groups[f"{root}/sensitivity/{REST}"] = rest_mesh_dataset(model, rest)
                    yield
        if waved:
            if rest is None:
                rest = solve_cage_equilibrium(model, built, profile)
                if laws_wanted and "time" in problem.settings.analyses:
                    # numbers of a sea carry what the laws change, also where the current alone is not asked for
                    calm = _STILL.of(key, partial(solve_cage_equilibrium, model, built, None))
                    collected.groups[f"{root}/laws"] = laws_dataset(model, rest, calm, speed, heading, progress)
                    yield
            for sea in problem.seas:
                yield from _sea_steps(problem, model, rest, sea, collected, root, worst, progress)
    if problem.settings.other_laws:
        yield from _law_steps(problem, worst, collected, progress)
    progress("water levels", len(levels), len(levels))


def _speeds(problem: FlexibleCageProblem, speed: float) -> list[float]:
    """Return still water, the speeds asked for and that of the site, rising [m/s]."""
    return sorted({0.0, *problem.settings.current_speeds, speed})


def _sea_steps(
    problem: FlexibleCageProblem,
    model: FlexibleCage,
    rest: CageEquilibrium,
    sea: RigidCageWaves | IrregularSea,
    collected: Collected,
    root: str,
    worst: GoverningWaves,
    progress: Progress,
) -> Iterator[None]:
    waves = waves_of(problem, sea, model.water)
    governing: tuple[float, WaveCase] | None = None
    other: CageRun | BaseException | None = None
    meshes = "sensitivity" not in problem.settings.analyses
    for number, wave in enumerate(waves):
        progress(f"time, {sea.name}", number, len(waves))
        label = f"wave {number + 1}" if wave.regular else "sea"
        if "time" in problem.settings.analyses:
            if meshes and wave.regular and len(waves) == 1:
                found, other = run_on_two_meshes(model, rest, wave, problem.settings, progress)
            else:
                enough = Settling(rest, wave, problem.settings)
                found = run_cage(model, rest, wave, problem.settings, enough=enough, progress=progress)
            series = time_dataset(model, found, problem.settings)
            collected.groups[f"{root}/time/{sea.name}/{label}"] = series
            collected.checks.extend(run_checks(sea.name, found))
            collected.notices.extend(run_notices(sea.name, found, problem.settings))
            if found.history.status == "converged":
                collected.notices.extend(settling_notices(sea.name, series))
            if found.history.status == "interrupted":
                raise KeyboardInterrupt
            if found.history.status == "not_converged":
                collected.failures.append(f"{sea.name}, {wave.name}: {found.history.message}")
            collected.notices.extend(height_notices(sea.name, series))
            collected.notices.extend(theory_limit(wave, _AUTOMATIC))
            used = float(series["utilisation"].max()) if "utilisation" in series else 0.0
            if found.history.status == "converged":
                case = WaveCase(root, sea.name, label, model, found)
                worst.add(case, series)
                if governing is None or used > governing[0]:
                    governing = used, case
            yield
        if "sensitivity" in problem.settings.analyses and number == 0:
            collected.groups[f"{root}/sensitivity/{sea.name}"] = sensitivity_dataset(
                model, rest, replace(wave, duration=min(wave.duration, 6.0 * wave.period)), problem.settings, progress
            )
            yield
    if governing is not None and meshes:
        try:
            changed, coarse = mesh_dataset(model, governing[1].run, problem.settings, progress, other)
        except (ConvergenceError, InputError) as error:
            words = f"{sea.name}: the coarser mesh that is run to check the mesh fails: {error.fault.message}"
            collected.notices.append(Notice("mesh-not-checked", words, severity="warning"))
        else:
            collected.groups[f"{root}/sensitivity/{sea.name}"] = changed
            worst.keep(governing[1], coarse)
        yield
    progress(f"time, {sea.name}", len(waves), len(waves))


def _law_steps(
    problem: FlexibleCageProblem, worst: GoverningWaves, collected: Collected, progress: Progress
) -> Iterator[None]:
    """Run the governing waves of all numbers under the lowest and the highest valid law of nets."""
    speed = design_speed(problem)
    for case in worst.cases:
        if not choice_of(case.model, speed).others:
            return
        laws, drags = collected.groups.get(f"{case.root}/laws"), None
        if laws is not None:
            names, values = (laws.variables[name].values for name in ("law", "law_drag"))
            drags = {str(name): float(drag) for name, drag in zip(names, values, strict=True)}
        found, missing = laws_in_wave(case, speed, problem.settings, worst.coarse_of(case), drags, progress)
        collected.groups[case.path] = found
        if missing:
            words = f"{case.sea}, {case.run.wave.name}: the run under other laws of nets fails ({', '.join(missing)})"
            remedy = "run the case under the other laws of the net too"
            collected.notices.append(Notice("laws-not-run", words, severity="warning", remedy=remedy))
        yield


def _result(problem: FlexibleCageProblem, collected: Collected) -> Result:
    attributes = {
        "title": problem.title,
        "structure": "cage",
        "cage_model": "flexible",
        "case_hash": problem.case_hash,
        "case_text": problem.case_text,
    }
    checked = any("/sensitivity/" in path for path in collected.groups)
    waved = any("/time/" in path for path in collected.groups)
    return collected.close(
        VOCABULARY,
        attributes,
        [sea.seed for sea in problem.seas if isinstance(sea, IrregularSea)],
        fulfilled="all identities hold" + ("; mesh not checked" if waved and not checked else ""),
        headlines=flexible_headlines(problem, collected.groups),
        criteria=problem.criteria,
        left_out=SEAS_LEFT_OUT if problem.seas and "time" not in problem.settings.analyses else "",
    )
